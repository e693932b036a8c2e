// Boxes of composites by contraction: a box that holds what is looked for is made smaller by one primitive after the
// other.
//
// What is seen of an intersection lies in all of its children, so each of them may take of the box what cannot be in
// it; of a union, the box around what the children leave. A plane bounds a coordinate by the others, a quadric the
// roots of a quadratic in one coordinate. Some rounds end in a finite box where the planes lie across the axes of the
// quadrics, which is so in the space of the quadrics themselves if it is anywhere: turned composites are measured
// there.
//
// Coefficients that rounding alone may have made are left out, which moves a surface by at most 2^-14 of the box; so
// much is added, far more than rounding.
//
// SPDX-License-Identifier: MIT
#include "trace/csg_bounds.h"

#include <math.h>

#include "trace/half_spaces.h"

enum { ROUNDS_MOST = 8, ROUNDS_MORE = 2, FRAMES_MOST = 4 };
static const double DROPPED = 0x1p-44, SMALLEST = 0x1p-16, SLACK = 0x1p-10;
static const double ROOTS_OFF = 0x1p-22; // roots that nearly are one may be off by the root of some u

// A space in which a composite is measured.
typedef struct Frame {
    Vec3 centre;
    Linear to_frame, to_world;
} Frame;

// a·p² + cross·<yz, xz, xy> + linear·p + constant, which is no more than 0 inside.
typedef struct Quadric {
    double square[3], cross[3], linear[3], constant;
} Quadric;

static bool is_quadric(const PreparedPrimitive *primitive)
{
    return primitive->kind == PRIMITIVE_POLYNOMIAL && polynomial_order(primitive->list.items) == 2;
}

// ---- boxes

// A composite whose nodes are boxed: `inner` the box of each, `next` room for others.
typedef struct Boxing {
    const ShapeTable *table;
    const CsgTree *csg;
    const Bounds *surfaces; // of each primitive
    Bounds *inner, *next;
} Boxing;

typedef struct Range {
    double low, high;
} Range;

static Range axis_of(const Bounds *box, int axis)
{
    return (Range){(&box->low.x)[axis], (&box->high.x)[axis]};
}

static void axis_meet(Bounds *box, int axis, Range range)
{
    double *low = &(&box->low.x)[axis], *high = &(&box->high.x)[axis];
    *low = range.low > *low ? range.low : *low; // not where it is NaN
    *high = range.high < *high ? range.high : *high;
}

static Range range_times(double factor, Range range)
{
    double a = factor * range.low, b = factor * range.high;
    return factor == 0.0 ? (Range){0.0, 0.0} : a < b ? (Range){a, b} : (Range){b, a};
}

static Range range_plus(Range a, Range b)
{
    return (Range){a.low + b.low, a.high + b.high};
}

// The box of a box's image.
static Bounds box_through(const Linear *map, Vec3 moved, const Bounds *box)
{
    Bounds image;
    for (int to = 0; to < 3; to++) {
        Range sum = {(&moved.x)[to], (&moved.x)[to]};
        for (int from = 0; from < 3; from++) {
            sum = range_plus(sum, range_times(map->m[from][to], axis_of(box, from)));
        }
        (&image.low.x)[to] = sum.low;
        (&image.high.x)[to] = sum.high;
    }
    return image;
}

// ---- primitives

// The half space n·p <= distance.
static void plane_contract(const double n[3], double distance, Bounds *box)
{
    double greatest = fmax(fmax(fabs(n[0]), fabs(n[1])), fabs(n[2]));
    for (int axis = 0; axis < 3; axis++) {
        double rest = distance;
        for (int other = 0; other < 3; other++) {
            double factor = fabs(n[other]) <= DROPPED * greatest ? 0.0 : n[other];
            rest -= other == axis ? 0.0 : range_times(factor, axis_of(box, other)).low;
        }
        if (fabs(n[axis]) > SMALLEST * greatest) {
            double end = rest / n[axis];
            axis_meet(box, axis, n[axis] > 0.0 ? (Range){-(double)INFINITY, end} : (Range){end, (double)INFINITY});
        }
    }
}

// The least of a x² + b x in a range.
static double least_square(double a, double b, Range x)
{
    if (a > 0.0) {
        double at = fmin(fmax(-b / (2.0 * a), x.low), x.high);
        return (a * at + b) * at;
    }
    if (a < 0.0 && (isinf(x.low) || isinf(x.high))) {
        return -(double)INFINITY;
    }
    return a < 0.0 ? fmin((a * x.low + b) * x.low, (a * x.high + b) * x.high) : range_times(b, x).low;
}

static double least_product(double factor, Range x, Range y)
{
    Range a = range_times(factor, x), low = range_times(a.low, y), high = range_times(a.high, y);
    return factor == 0.0 ? 0.0 : fmin(low.low, high.low);
}

// Half of what lies between the roots of a x² + b x + c, a > 0. Where there are none, or rounding says so: 0.
static double half_between(double a, double b, double c)
{
    return sqrt(fmax(b * b - 4.0 * a * c, 0.0)) / (2.0 * a);
}

// What is left of a coordinate where a x² + b x + rest <= 0, for b in a range: right of 0 the least b leaves most, left
// of it the greatest. Where 0 itself is not left, one of the two sides may have nothing.
static Range quadratic_range(double a, Range b, double rest)
{
    Range x = {-(double)INFINITY, (double)INFINITY};
    if (a > 0.0) {
        bool is_left = rest <= 0.0 || b.high > 0.0, is_right = rest <= 0.0 || !is_left || b.low < 0.0;
        double left = is_left ? b.high : b.low, right = is_right ? b.low : b.high;
        x.low = -left / (2.0 * a) - half_between(a, left, rest);
        x.high = -right / (2.0 * a) + half_between(a, right, rest);
        double margin = ROOTS_OFF * fmax(fabs(x.low), fabs(x.high));
        x = (Range){x.low - margin, x.high + margin};
    } else if (a == 0.0 && b.low > 0.0) {
        x.high = fmax(-rest / b.low, -rest / b.high);
    } else if (a == 0.0 && b.high < 0.0) {
        x.low = fmin(-rest / b.low, -rest / b.high);
    }
    return x;
}

static void quadric_contract(const Quadric *q, Bounds *box)
{
    double greatest = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        greatest = fmax(greatest, fmax(fabs(q->square[axis]), fabs(q->cross[axis])));
    }
    for (int axis = 0; axis < 3; axis++) {
        int j = (axis + 1) % 3, k = (axis + 2) % 3;
        Range x_j = axis_of(box, j), x_k = axis_of(box, k);
        double rest = least_square(q->square[j], q->linear[j], x_j) + least_square(q->square[k], q->linear[k], x_k) +
                      least_product(q->cross[axis], x_j, x_k) + q->constant;
        Range b = {q->linear[axis], q->linear[axis]};
        b = range_plus(b, range_plus(range_times(q->cross[k], x_j), range_times(q->cross[j], x_k)));
        bool is_known = isfinite(rest) && isfinite(b.low) && isfinite(b.high);
        if (is_known && (q->square[axis] == 0.0 || q->square[axis] > SMALLEST * greatest)) {
            axis_meet(box, axis, quadratic_range(q->square[axis], b, rest));
        }
    }
}

// What a quadric is in a frame: with p -> p M + m, the form's matrix S becomes M S Mᵀ.
static Quadric quadric_in(const PreparedPrimitive *primitive, const Frame *frame)
{
    const double *c = polynomial_terms(primitive->list.items);
    const double s[3][3] = {
        {c[0], 0.5 * c[1], 0.5 * c[2]}, {0.5 * c[1], c[4], 0.5 * c[5]}, {0.5 * c[2], 0.5 * c[5], c[7]}};
    const Vec3 linear = {c[3], c[6], c[8]};
    Vec3 m = linear_direction(&primitive->to_object, vec3_sub(frame->centre, primitive->centre)), rows[3], along[3];
    for (int i = 0; i < 3; i++) {
        const double *row = frame->to_world.m[i];
        rows[i] = linear_direction(&primitive->to_object, vec3(row[0], row[1], row[2]));
        along[i] = rows_direction(s, rows[i]);
    }
    Quadric q = {.constant = vec3_dot(m, rows_direction(s, m)) + vec3_dot(linear, m) + c[9]};
    double greatest = 0.0;
    for (int i = 0; i < 3; i++) {
        q.square[i] = vec3_dot(rows[i], along[i]);
        q.cross[i] = 2.0 * vec3_dot(rows[(i + 1) % 3], along[(i + 2) % 3]);
        q.linear[i] = 2.0 * vec3_dot(m, along[i]) + vec3_dot(linear, rows[i]);
        greatest = fmax(greatest, fmax(fabs(q.square[i]), fabs(q.cross[i])));
    }
    for (int i = 0; i < 3; i++) {
        q.square[i] = fabs(q.square[i]) <= DROPPED * greatest ? 0.0 : q.square[i];
        q.cross[i] = fabs(q.cross[i]) <= DROPPED * greatest ? 0.0 : q.cross[i];
    }
    return q;
}

static void primitive_contract(const PreparedPrimitive *primitive, const Bounds *surface, const Frame *frame,
                               Bounds *box)
{
    bool is_inverse = primitive->flags & PRIMITIVE_INVERSE;
    if (primitive->kind == PRIMITIVE_PLANE) {
        Vec3 normal = is_inverse ? vec3_neg(primitive->data[0]) : primitive->data[0];
        double distance = is_inverse ? -primitive->data[1].x : primitive->data[1].x, n[3];
        for (int i = 0; i < 3; i++) {
            const double *row = frame->to_world.m[i];
            n[i] = vec3_dot(normal, vec3(row[0], row[1], row[2]));
        }
        plane_contract(n, distance - vec3_dot(normal, frame->centre), box);
    } else if (!is_inverse && bounds_are_finite(*surface)) {
        Vec3 moved = vec3_neg(linear_direction(&frame->to_frame, frame->centre));
        *box = bounds_meet(*box, box_through(&frame->to_frame, moved, surface));
    } else if (!is_inverse && is_quadric(primitive)) {
        Quadric q = quadric_in(primitive, frame);
        quadric_contract(&q, box);
    }
}

// ---- nodes

static void take(const TreeNode *node, Bounds *bounds, const Bounds *child)
{
    bool joins = node->op == NODE_UNION || node->op == NODE_MERGE;
    *bounds = joins ? bounds_join(*bounds, *child) : bounds_meet(*bounds, *child);
}

// Takes from the boxes of all nodes what their children leave. What is seen within a node lies in the box of the one
// around it.
static void contract_nodes(const Boxing *boxing, const Frame *frame)
{
    const ShapeTable *table = boxing->table;
    const CsgTree *csg = boxing->csg;
    Bounds *inner = boxing->inner, *next = boxing->next;
    uint32_t first = csg->first_node, end = first + csg->node_count;
    for (uint32_t i = first; i < end; i++) {
        const TreeNode *node = &table->nodes[i];
        inner[i] = i == first ? inner[i] : bounds_meet(inner[i], inner[node->parent]);
        next[i] = node->op == NODE_UNION || node->op == NODE_MERGE ? BOUNDS_NONE : inner[i];
    }
    for (uint32_t i = csg->first_primitive; i < csg->first_primitive + csg->primitive_count; i++) {
        const PreparedPrimitive *primitive = &table->primitives[i];
        if (primitive->bounds) {
            continue;
        }
        Bounds box = inner[primitive->node];
        primitive_contract(primitive, &boxing->surfaces[i], frame, &box);
        take(&table->nodes[primitive->node], &next[primitive->node], &box);
    }
    for (uint32_t i = end; i-- > first;) {
        const TreeNode *node = &table->nodes[i];
        inner[i] = bounds_meet(inner[i], next[i]);
        if (i > first && node->op != NODE_BOUND) {
            take(&table->nodes[node->parent], &next[node->parent], &inner[node->is_inverse ? node->parent : i]);
        }
    }
}

// More than rounding, and than coefficients that were left out.
static Bounds with_slack(const Bounds *box)
{
    double slack = SLACK * fmax(vec3_max_abs(box->low), vec3_max_abs(box->high));
    Vec3 margin = vec3(slack, slack, slack);
    return (Bounds){vec3_sub(box->low, margin), vec3_add(box->high, margin)};
}

// Makes the box in the scene's space of what is seen smaller, if it can.
static void measure_in(const Boxing *boxing, const Frame *frame, Bounds *bounds)
{
    Bounds *box = &boxing->inner[boxing->csg->first_node];
    for (uint32_t i = 0; i < boxing->csg->node_count; i++) {
        box[i] = BOUNDS_ALL;
    }
    for (int round = 0, more = ROUNDS_MORE; round < ROUNDS_MOST && more > 0; round++) {
        contract_nodes(boxing, frame);
        more -= bounds_are_finite(*box);
    }
    if (!bounds_are_finite(*box) || bounds_are_empty(*box)) {
        return;
    }
    Bounds larger = with_slack(box);
    *bounds = bounds_meet(*bounds, box_through(&frame->to_world, frame->centre, &larger));
}

// In the spaces of its quadrics, until there is a finite box.
static void measure_in_frames(const Boxing *boxing, Bounds *bounds)
{
    const CsgTree *csg = boxing->csg;
    int tried = 0;
    for (uint32_t i = csg->first_primitive; i < csg->first_primitive + csg->primitive_count && tried < FRAMES_MOST;
         i++) {
        const PreparedPrimitive *primitive = &boxing->table->primitives[i];
        if (!bounds_are_finite(*bounds) && is_quadric(primitive) && !bounds_are_finite(boxing->surfaces[i])) {
            Frame frame = {primitive->centre, primitive->to_object, primitive->to_world};
            measure_in(boxing, &frame, bounds);
            tried++;
        }
    }
}

// A box that holds what may be seen of the composite and lies within `bounds`, which holds it, too. `inner` and `next`
// as csg_measure has them; in `inner` what holds all of a node that may matter to what is seen.
static Bounds csg_bounds(const ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds bounds,
                         Bounds *inner, Bounds *next)
{
    const Linear same = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    const Frame frame = {vec3(0.0, 0.0, 0.0), same, same};
    const Boxing boxing = {table, csg, surfaces, inner, next};
    measure_in(&boxing, &frame, &bounds);
    for (uint32_t i = csg->first_node; i < csg->first_node + csg->node_count; i++) {
        bool is_known = bounds_are_finite(bounds) && bounds_are_finite(inner[i]) && !bounds_are_empty(inner[i]);
        inner[i] = is_known ? with_slack(&inner[i]) : BOUNDS_ALL;
    }
    if (bounds_are_finite(bounds)) {
        return bounds;
    }
    measure_in_frames(&boxing, &bounds);
    for (uint32_t i = csg->first_node; i < csg->first_node + csg->node_count; i++) {
        inner[i] = BOUNDS_ALL;
    }
    return bounds;
}

// Nothing is seen of a composite outside of the planes that decide; where they enclose a space, the box of that.
static Bounds csg_planes_bounds(const ShapeTable *table, const CsgTree *csg)
{
    enum { MOST = 64 }; // more than that only make the box smaller
    HalfSpace spaces[MOST];
    Bounds bounds;
    uint32_t count = 0;
    for (uint32_t i = csg->first_primitive; i < csg->first_primitive + csg->primitive_count && count < MOST; i++) {
        const PreparedPrimitive *primitive = &table->primitives[i];
        if (primitive->decides && primitive->kind == PRIMITIVE_PLANE) {
            spaces[count++] = (HalfSpace){primitive->data[0], primitive->data[1].x};
        }
    }
    return half_spaces_bounds(spaces, count, &bounds) ? bounds : BOUNDS_ALL;
}

// What the nodes count of children, from the leaves up, and the box of what is seen: that of the root, of which it does
// not matter whether it is taken from all space, within that of all surfaces. Children stand behind their parents.
Bounds csg_measure(ShapeTable *table, const CsgTree *csg, const Bounds *surfaces, Bounds *inner, Bounds *next)
{
    uint32_t first = csg->first_node;
    Bounds surface = BOUNDS_NONE;
    for (uint32_t i = first; i < first + csg->node_count; i++) {
        const TreeNode *node = &table->nodes[i];
        inner[i] = node->op == NODE_UNION || node->op == NODE_MERGE ? BOUNDS_NONE : BOUNDS_ALL;
    }
    for (uint32_t i = csg->first_primitive; i < csg->first_primitive + csg->primitive_count; i++) {
        TreeNode *node = &table->nodes[table->primitives[i].node];
        bool is_inverse = table->primitives[i].flags & PRIMITIVE_INVERSE;
        Bounds bounds = is_inverse ? BOUNDS_ALL : surfaces[i];
        node->idle_inside += is_inverse;
        if (table->primitives[i].bounds) {
            continue;
        }
        take(node, &inner[table->primitives[i].node], &bounds);
        surface = bounds_join(surface, surfaces[i]);
    }
    for (uint32_t i = first + csg->node_count; i-- > first + 1;) {
        const TreeNode *node = &table->nodes[i];
        TreeNode *parent = &table->nodes[node->parent];
        if (node->op == NODE_BOUND) {
            continue;
        }
        Bounds bounds = node->is_inverse ? BOUNDS_ALL : inner[i];
        parent->idle_inside += (node->idle_inside >= node->needed) != node->is_inverse;
        take(parent, &inner[node->parent], &bounds);
    }
    Bounds bounds = bounds_meet(surface, inner[first]);
    if (!bounds_are_finite(bounds)) {
        bounds = bounds_meet(bounds, csg_planes_bounds(table, csg));
    }
    bool may_be_less = csg->primitive_count > 1 && !bounds_are_finite(surface);
    return may_be_less ? csg_bounds(table, csg, surfaces, bounds, inner, next) : bounds;
}

// ---- the nodes themselves

// The node stays, without children, and no ray is inside of it.
static void node_join(TreeNode *node, TreeNode *parent)
{
    parent->child_count += node->child_count - 1;
    parent->needed += node_is_all(node) ? node->child_count - 1 : 0;
    node->child_count = 0;
    node->needed = UINT32_MAX;
}

void csg_nodes_init(ShapeTable *table, const Scene *scene)
{
    for (uint32_t i = 0; i < table->node_count; i++) {
        const Node *node = &scene->nodes.items[i];
        bool is_any = node->op == NODE_UNION || node->op == NODE_MERGE;
        table->nodes[i] =
            (TreeNode){node->op, node->is_inverse, node->parent, node->child_count, is_any ? 1 : node->child_count, 0};
        if (node->op == NODE_BOUND) { // children stand behind their parents
            table->nodes[node->parent].child_count--;
            table->nodes[node->parent].needed--;
        }
    }
    for (uint32_t i = 0; i < table->node_count; i++) {
        TreeNode *node = &table->nodes[i];
        if (node->parent == NODE_NONE) {
            continue;
        }
        TreeNode *parent = &table->nodes[node->parent];
        node->parent = node_is_joined(parent) ? parent->parent : node->parent;
        parent = &table->nodes[node->parent];
        bool is_same = node->op == parent->op || (node_is_all(node) && node_is_all(parent));
        bool has_bounds = node->child_count != scene->nodes.items[i].child_count;
        if (is_same && node->op != NODE_BOUND && !node->is_inverse && !has_bounds) {
            node_join(node, parent);
        }
    }
}
