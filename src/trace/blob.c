// The fields of a blob along a line, and what of their sum is above the threshold.
//
// A component has a field on a stretch of the line, on which its distance squared is a quadratic, seen from where that
// is least; a rod has up to three of them. Between two ends of stretches the sum is of degree 4, and its roots are
// those of trace/roots.h. At the ends themselves a field and its slope are 0, so that it does not matter that they are
// rounded. A ray that starts on the surface has the threshold made such that its start is on it, and leaves that root
// out.
//
// SPDX-License-Identifier: MIT
#include "trace/blob.h"

#include <stdlib.h>

#include "math/extreme.h"
#include "scene/blob.h"
#include "trace/roots.h"

#include "math/lane_double.h"
#include "trace/blob_walk.inc"

enum { FIRST_FEW = 2, DEGREE = 4 };

// A root is as good as the rest of a crossing if it is off by so many u of all that makes its place.
static const double GOOD_ROOT = 0x1p-44;

typedef enum Section { SECTION_BALL, SECTION_ROD, SECTION_TOP } Section;

// Of the line, in which a component has a field: 1 - d² = depth - square (t - middle)².
typedef struct Stretch {
    double from, to;
    double square, middle, depth, strength;
    double size; // |o| + |t d| in the component's space: what rounds its numbers
    const BlobComponent *component;
    Section section;
} Stretch;

typedef struct Line {
    const Ray *ray;
    Stretch *stretches;    // room for three of each component
    const Stretch **order; // by where they begin
    unsigned count;
    bool is_start;
    double threshold, threshold_error; // of a ray that starts on the surface: the field there
    // Of the part of the line that is looked at: its middle or, where the ray starts in it on the surface, its start.
    double base;
    bool is_reduced; // its polynomial is divided by t
    const Stretch **active;
    unsigned active_count;
} Line;

// ---- stretches

// `own`: the ray in the component's space.
static void add_stretch(Line *line, const BlobComponent *component, Section section, const Ray *own, double low,
                        double high)
{
    Vec3 o = own->origin, d = own->direction;
    if (section == SECTION_ROD) {
        o.z = d.z = 0.0;
    } else if (section == SECTION_TOP) {
        o.z -= component->height;
    }
    double square = vec3_length_squared(d), middle = square > 0.0 ? -vec3_dot(o, d) / square : 0.0;
    Vec3 least = vec3_add_scaled(o, middle, d);
    double depth = 1.0 - vec3_length_squared(least), size = vec3_max_abs(o) + fabs(middle) * vec3_max_abs(d);
    if (!(depth > -0x1p-40 * (1.0 + size))) {
        return;
    }
    double half = square > 0.0 ? sqrt(greater_of(depth, 0.0) / square) : (double)INFINITY;
    low = greater_of(low, middle - half);
    high = less_of(high, middle + half);
    if (low < high && high > 0.0) {
        line->stretches[line->count++] =
            (Stretch){low, high, square, middle, depth, component->strength, 1.0 + size, component, section};
    }
}

static void add_component(Line *line, const BlobComponent *component)
{
    const double(*m)[3] = component->to_own;
    Vec3 p = line->ray->origin, v = line->ray->direction;
    Vec3 o = {p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0],
              p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1],
              p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2]};
    Vec3 d = {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
              v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
    const Ray own = {o, d};
    const double far = (double)INFINITY;
    if (component->is_rod == 0.0) {
        add_stretch(line, component, SECTION_BALL, &own, -far, far);
        return;
    }
    double bottom = -o.z / d.z, top = (component->height - o.z) / d.z;
    if (d.z == 0.0) {
        Section section = o.z <= 0.0 ? SECTION_BALL : o.z < component->height ? SECTION_ROD : SECTION_TOP;
        add_stretch(line, component, section, &own, -far, far);
    } else if (d.z > 0.0) {
        add_stretch(line, component, SECTION_BALL, &own, -far, bottom);
        add_stretch(line, component, SECTION_ROD, &own, bottom, top);
        add_stretch(line, component, SECTION_TOP, &own, top, far);
    } else {
        add_stretch(line, component, SECTION_TOP, &own, -far, top);
        add_stretch(line, component, SECTION_ROD, &own, top, bottom);
        add_stretch(line, component, SECTION_BALL, &own, bottom, far);
    }
}

static int stretch_order(const Stretch *x, const Stretch *y)
{
    int by_place = (x->from > y->from) - (x->from < y->from);
    return by_place != 0 ? by_place : (x->component > y->component) - (x->component < y->component);
}

static int order_of(const void *a, const void *b)
{
    return stretch_order(*(const Stretch *const *)a, *(const Stretch *const *)b);
}

static void sort_stretches(Line *line)
{
    enum { FEW = 48 };
    for (unsigned i = 0; i < line->count; i++) {
        line->order[i] = &line->stretches[i];
    }
    if (line->count > FEW) {
        qsort(line->order, line->count, sizeof *line->order, order_of);
        return;
    }
    for (unsigned i = 1; i < line->count; i++) {
        const Stretch *own = line->order[i];
        unsigned at = i;
        for (; at > 0 && stretch_order(own, line->order[at - 1]) < 0; at--) {
            line->order[at] = line->order[at - 1];
        }
        line->order[at] = own;
    }
}

static void find_stretches(Line *line, const Blob *blob)
{
    const Vec3 o = line->ray->origin, d = line->ray->direction;
    const double origin[3] = {o.x, o.y, o.z}, direction[3] = {d.x, d.y, d.z};
    BlobWalk walk; // not cleared
    line->count = 0;
    blob_walk_start(&walk, blob, origin, direction);
    for (const BlobNode *node; (node = blob_walk_next(&walk, 1)) != NULL;) {
        for (uint32_t i = (uint32_t)node->begin; i < (uint32_t)node->end; i++) {
            add_component(line, &blob->components[i]);
        }
    }
}

// ---- the polynomial between two ends of stretches

static DoubleWord exact_dot(const double (*m)[3], int axis, Vec3 v, double plus)
{
    DoubleWord sum = double_word_add(two_product(v.x, m[0][axis]), two_product(v.y, m[1][axis]));
    return double_word_add(double_word_add(sum, two_product(v.z, m[2][axis])), (DoubleWord){plus, 0.0});
}

// 1 - d² of a stretch by t - base.
static void exact_depth(const Stretch *stretch, const Ray *ray, double base, DoubleWord inner[3])
{
    const BlobComponent *component = stretch->component;
    const double(*m)[3] = component->to_own;
    inner[0] = (DoubleWord){-1.0, 0.0};
    inner[1] = inner[2] = (DoubleWord){0.0, 0.0};
    for (int axis = 0; axis < (stretch->section == SECTION_ROD ? 2 : 3); axis++) {
        DoubleWord o = exact_dot(m, axis, ray->origin, m[3][axis]), d = exact_dot(m, axis, ray->direction, 0.0);
        if (axis == 2 && stretch->section == SECTION_TOP) {
            o = double_word_add(o, (DoubleWord){-component->height, 0.0});
        }
        o = double_word_add(o, double_word_scale(d, base));
        inner[0] = double_word_add(inner[0], double_word_mul(o, o));
        inner[1] = double_word_add(inner[1], double_word_scale(double_word_mul(o, d), 2.0));
        inner[2] = double_word_add(inner[2], double_word_mul(d, d));
    }
    for (int i = 0; i < 3; i++) {
        inner[i] = double_word_neg(inner[i]);
    }
}

static void exact_add(const Stretch *stretch, const Ray *ray, double base, DoubleWord sum[DEGREE + 1])
{
    DoubleWord inner[3];
    exact_depth(stretch, ray, base, inner);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            DoubleWord term = double_word_scale(double_word_mul(inner[i], inner[j]), stretch->strength);
            sum[i + j] = double_word_add(sum[i + j], term);
        }
    }
}

// The threshold, or the field where the ray starts.
static DoubleWord exact_threshold(const Line *line)
{
    DoubleWord sum[DEGREE + 1] = {{0.0, 0.0}};
    if (!line->is_start) {
        return (DoubleWord){line->threshold, 0.0};
    }
    for (unsigned k = 0; k < line->count; k++) {
        if (line->stretches[k].from <= 0.0) {
            exact_add(&line->stretches[k], line->ray, 0.0, sum);
        }
    }
    return sum[0];
}

// What the root finder asks for.
static void refine(Polynomial *polynomial, const void *owner)
{
    const Line *line = owner;
    DoubleWord sum[DEGREE + 1] = {{0.0, 0.0}};
    for (unsigned k = 0; k < line->active_count; k++) {
        exact_add(line->active[k], line->ray, line->base, sum);
    }
    sum[0] = double_word_sub(sum[0], exact_threshold(line));
    for (unsigned i = 0; i <= polynomial->degree; i++) {
        polynomial->exact[i] = sum[i + line->is_reduced];
    }
}

static void add_square(double inner0, double inner1, double inner2, double strength, double sum[DEGREE + 1])
{
    sum[0] += strength * (inner0 * inner0);
    sum[1] += strength * (2.0 * inner0 * inner1);
    sum[2] += strength * (inner1 * inner1 + 2.0 * inner0 * inner2);
    sum[3] += strength * (2.0 * inner1 * inner2);
    sum[4] += strength * (inner2 * inner2);
}

// The field less the threshold by t - base. Where a component has a field, 1 - d² is at most 1, and off by 50 u of its
// size: its square by 100 u and some. What Horner's scheme adds is in proportion to the terms themselves.
static void line_polynomial(const Line *line, Polynomial *p)
{
    double terms[DEGREE + 1] = {-line->threshold}, sizes[DEGREE + 1] = {fabs(line->threshold)};
    double term_sizes[DEGREE + 1] = {fabs(line->threshold)}, greatest = 1.0, fixed = 0.0;
    for (unsigned k = 0; k < line->active_count; k++) {
        const Stretch *s = line->active[k];
        double from = line->base - s->middle, turn = -2.0 * s->square * from, fall = s->square * from * from;
        add_square(s->depth - fall, turn, -s->square, s->strength, terms);
        add_square(fabs(s->depth - fall), fabs(turn), s->square, fabs(s->strength), term_sizes);
        add_square(1.0 + fabs(s->depth) + fall, fabs(turn), s->square, fabs(s->strength), sizes);
        fixed += fabs(s->strength) * s->size;
        greatest = greater_of(greatest, s->size);
    }
    double rounding = (16.0 + line->active_count) * 0x1p-53;
    unsigned first = line->is_reduced;
    p->degree = DEGREE - first;
    p->refine = refine;
    p->value = NULL;
    p->owner = line;
    for (unsigned i = 0; i <= p->degree; i++) {
        p->terms[i] = terms[i + first];
        p->sizes[i] = sizes[i + first] * (greatest * greatest);
        p->errors[i] = rounding * term_sizes[i + first] + (first ? 0x1p-47 * greatest * sizes[i + first] : 0.0);
    }
    p->errors[0] += first == 0 ? 0x1p-46 * fixed : 0.0;
    p->errors[0] += first == 0 ? line->threshold_error : 0.0;
    roots_start(p);
}

// ---- crossings in order

// What has been found so far.
typedef struct Found {
    IntervalWalk walk;
    unsigned most;
    bool is_first, is_over; // the first crossing is enough where doubles find it; it is there
} Found;

static bool root_is_good(const Line *line, const Polynomial *p, double s)
{
    double error = 0.0, slope = 0.0, size = fabs(s);
    for (unsigned i = p->degree + 1; i-- > 0;) {
        error = error * size + p->errors[i];
        slope = i > 0 ? slope * s + i * p->terms[i] : slope;
    }
    double length = vec3_max_abs(line->ray->direction);
    return error * length <=
           GOOD_ROOT * (vec3_max_abs(line->ray->origin) + fabs(line->base + s) * length) * fabs(slope);
}

// No field of the active ones is greater than at its middle.
static bool is_below(const Line *line, double low, double high)
{
    double sum = 0.0;
    for (unsigned k = 0; k < line->active_count; k++) {
        const Stretch *s = line->active[k];
        double near = less_of(greater_of(s->middle, low), high) - s->middle;
        double inner = s->depth - s->square * near * near + 0x1p-46 * s->size;
        sum += s->strength > 0.0 && inner > 0.0 ? s->strength * inner * inner : 0.0;
    }
    return sum * (1.0 + 0x1p-40) < line->threshold;
}

static unsigned piece_roots(const Line *line, Polynomial *p, double low, double high, double roots[], int *sign)
{
    unsigned count =
        low == -high ? roots_find_about(p, high, false, roots, sign) : roots_find(p, low, high, roots, sign);
    bool are_good = true, were_exact = p->is_exact;
    for (unsigned i = 0; i < count && !were_exact; i++) {
        if ((p->is_exact || !root_is_good(line, p, roots[i])) && !roots_refine(p, &roots[i])) {
            are_good = false;
        }
    }
    return are_good ? count : roots_find_exact(p, low, high, roots, sign);
}

// Where the ray starts on the surface: whether it is inside behind that, as it is said, but where the slope is against
// that by rounding; then the bend decides.
static bool starts_inside(const Polynomial *p, bool inward)
{
    bool rises = p->terms[0] > 0.0, bends = p->degree > 0 && p->terms[1] > 0.0;
    return inward ? rises || bends : rises && bends;
}

// A part of the line from `low` to `high` in which the same stretches are.
static void take_piece(Line *line, double low, double high, bool inward, Found *found)
{
    bool begins = line->is_start && low == 0.0;
    if (!begins && is_below(line, low, high)) {
        if (found->walk.is_inside) {
            interval_walk_cross(&found->walk, low, 0);
        }
        return;
    }
    Polynomial p;
    double roots[DEGREE];
    int sign;
    line->base = begins ? 0.0 : 0.5 * (low + high);
    line->is_reduced = begins;
    line_polynomial(line, &p);
    double half = 0.5 * (high - low);
    unsigned passed = 0;
    unsigned count = piece_roots(line, &p, begins ? low : -half, begins ? high : half, roots, &sign);
    if (begins) {
        found->walk.is_inside = starts_inside(&p, inward);
        passed = count > 0 && found->walk.is_inside != (sign > 0) ? 1 : 0;
    } else if (sign != 0 && (sign > 0) != found->walk.is_inside) {
        interval_walk_cross(&found->walk, low, 0);
    }
    for (unsigned i = passed; i < count && found->walk.count < found->most; i++) {
        double t = line->base + roots[i];
        interval_walk_cross(&found->walk, t, 0);
        found->is_over = found->is_first && !p.is_exact && t > 0.0;
        if (found->is_over) {
            return;
        }
    }
}

// The stretches that are there behind `from`, of those that begin no later; where the first of them ends, or the next
// begins.
static double set_active(Line *line, double from, unsigned *next)
{
    unsigned kept = 0;
    double to = (double)INFINITY;
    for (unsigned k = 0; k < line->active_count; k++) {
        if (line->active[k]->to > from) {
            line->active[kept++] = line->active[k];
        }
    }
    for (; *next < line->count && line->order[*next]->from <= from; ++*next) {
        if (line->order[*next]->to > from) {
            line->active[kept++] = line->order[*next];
        }
    }
    line->active_count = kept;
    for (unsigned k = 0; k < kept; k++) {
        to = less_of(to, line->active[k]->to);
    }
    return *next < line->count ? less_of(to, line->order[*next]->from) : to;
}

// Whether the ray starts inside, or the threshold such that a start on the surface is on it.
static void set_start(Line *line, Found *found)
{
    Polynomial p;
    line->base = 0.0;
    line->is_reduced = false;
    line_polynomial(line, &p);
    if (line->is_start) {
        line->threshold_error = p.errors[0];
        line->threshold += p.terms[0];
    } else {
        found->walk.is_inside = line->active_count > 0 && roots_sign(&p, 0.0) > 0;
    }
}

static void walk(Line *line, SideLeft left, Found *found)
{
    unsigned next = 0;
    double at = 0.0, to = set_active(line, at, &next);
    set_start(line, found);
    if (line->is_start && line->active_count == 0) {
        return;
    }
    while ((line->active_count > 0 || next < line->count) && found->walk.count < found->most && !found->is_over) {
        if (line->active_count > 0) {
            take_piece(line, at, to, left.inward, found);
        } else if (found->walk.is_inside) {
            interval_walk_cross(&found->walk, at, 0);
        }
        at = to;
        to = set_active(line, at, &next);
    }
    if (found->is_over && found->walk.is_inside) {
        interval_walk_stay(&found->walk); // it ends somewhere behind
    } else if (found->walk.is_inside && found->walk.count < found->most) {
        interval_walk_cross(&found->walk, at, 0);
    }
}

unsigned blob_intervals(const double *list, bool is_first, const Ray *ray, SideLeft left, RayInterval *intervals)
{
    Blob blob = blob_of(list);
    unsigned most = blob_interval_most(list);
    Stretch stretches[3 * blob.component_count];
    Line line = {.ray = ray, .stretches = stretches, .is_start = left.side != SIDE_NONE, .threshold = blob.threshold};
    find_stretches(&line, &blob);
    if (line.count == 0) {
        return 0;
    }
    const Stretch *active[line.count], *order[line.count];
    line.active = active;
    line.order = order;
    sort_stretches(&line);
    Found found = {.walk = {.intervals = intervals, .open = INTERVAL_ALL},
                   .most = is_first ? FIRST_FEW : most,
                   .is_first = is_first};
    walk(&line, left, &found);
    return found.walk.count;
}

// ---- surfaces

Vec3 blob_normal(const double *list, Vec3 point)
{
    Blob blob = blob_of(list);
    uint32_t waiting[BLOB_NODES_DEEP], count = 1;
    const double p[3] = {point.x, point.y, point.z};
    double n[3] = {0.0, 0.0, 0.0};
    waiting[0] = 0;
    while (count > 0) {
        uint32_t at = waiting[--count];
        const BlobNode *node = &blob.nodes[at];
        bool is_near = true;
        for (int axis = 0; axis < 3; axis++) {
            is_near = is_near && node->low[axis] <= p[axis] && p[axis] <= node->high[axis];
        }
        if (is_near && node->end - node->begin > BLOB_LEAF) {
            waiting[count++] = (uint32_t)node->second;
            waiting[count++] = at + 1;
            continue;
        }
        for (uint32_t i = (uint32_t)node->begin; is_near && i < (uint32_t)node->end; i++) {
            const BlobComponent *component = &blob.components[i];
            Vec3 own;
            double inner = 1.0 - blob_distance2(component, point, &own), share = component->strength * inner;
            for (int axis = 0; inner > 0.0 && axis < 3; axis++) {
                const double(*m)[3] = component->to_own;
                n[axis] += share * (m[axis][0] * own.x + m[axis][1] * own.y + m[axis][2] * own.z);
            }
        }
    }
    Vec3 normal = {n[0], n[1], n[2]};
    double size = vec3_max_abs(normal);
    return size > 0.0 && size <= 0x1p1000 ? vec3_normalize(vec3_scale(ldexp(1.0, -ilogb(size)), normal))
                                          : vec3(1.0, 0.0, 0.0);
}
