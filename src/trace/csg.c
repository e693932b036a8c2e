// A ray against a composite: the crossings of all leaves in order, as changes of what the ray is inside of.
//
// At a crossing it is not asked where a point lies: each node counts its children that the ray is inside of, and a
// leaf's crossing changes the counts on its way to the root. Crossings that rounding cannot tell apart happen together:
// what hides a surface is judged on that side of them where it would show, so that coincident faces leave no film
// behind. docs/numerics.md, "Composites", says how near is together.
//
// csg_traversal.h finds the crossings, csg_plain.h knows a shorter way for trees of one node.
//
// SPDX-License-Identifier: MIT
#include "trace/csg_plain.h"

#include <string.h>

// ---- what is seen

// Whether nothing on the way to the root hides the surface, as far as it can be judged before the crossings of its
// group (is_after = false) or after them. An intersection shows a surface where all others are inside on the inner side
// of it, a merge where none is on the outer side.
static bool crossing_shows(const CsgTraversal *p, const Crossing *c, bool is_after)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, c->solid);
    bool leaves = c->leaves != (bool)(primitive->flags & PRIMITIVE_INVERSE);
    bool is_child_inside = !primitive_is_flat(primitive) && p->is_inside[c->solid];
    uint32_t at = primitive->node;
    while (at != NODE_NONE) {
        const TreeNode *node = &p->table->nodes[at];
        uint32_t inside = p->inside[at - p->csg->first_node];
        uint32_t others = inside - is_child_inside;
        if (p->missed && p->missed[at - p->csg->first_node] > 0) {
            return false;
        }
        bool is_all = node->op == NODE_INTERSECTION || node->op == NODE_CLIP;
        bool judges_after = is_all ? !leaves : leaves;
        if (judges_after == is_after &&
            ((is_all && others != node->child_count - 1) || (node->op == NODE_MERGE && others != 0))) {
            return false;
        }
        is_child_inside = node_is_inside(node, inside);
        leaves = leaves != node->is_inverse;
        at = node->parent;
    }
    return true;
}

// Lets the crossings from `begin` to `end` happen, and offers the first of them that is seen. True when one was.
RT_ALWAYS_INLINE bool traversal_cross(CsgTraversal *p, uint32_t begin, uint32_t end, Foremost *first)
{
    for (uint32_t i = begin; i < end; i++) {
        Crossing *c = &p->crossings[i];
        c->is_hidden = !c->has_surface || !crossing_shows(p, c, false);
    }
    for (uint32_t i = begin; i < end; i++) {
        const Crossing *c = &p->crossings[i];
        if (!c->is_film) {
            traversal_toggle(p, c->solid);
            p->is_over = p->is_over || (c->leaves && traversal_primitive(p, c->solid)->decides);
        }
    }
    Crossing *seen = NULL;
    for (uint32_t i = begin; i < end; i++) {
        Crossing *c = &p->crossings[i];
        if (!c->is_hidden && crossing_shows(p, c, true) && (!seen || c->solid < seen->solid)) {
            seen = c;
        }
    }
    if (seen && seen->face != MESH_NO_FACE) {
        uint32_t face = traversal_primitive(p, seen->solid)->mesh.first_face + seen->face;
        face_offer(p->table, shape_id(SHAPE_FACE, face), p->ray, seen->t,
                   crossing_span(seen->t, crossing_error(p, seen), p->enter), first);
    } else if (seen) {
        crossing_offer(p, seen, first);
    }
    return seen;
}

static void traversal_set_state(CsgTraversal *p, uint32_t index)
{
    bool is_inside = p->is_inside[index];
    p->is_inside[index] = traversal_primitive(p, index)->flags & PRIMITIVE_INVERSE;
    if (is_inside) {
        traversal_toggle(p, index);
    }
}

// Puts all leaves into the states that they have where the ray starts, but for those in a tree, which have theirs when
// they are asked: nobody looks at the others.
RT_ALWAYS_INLINE void traversal_set_states(CsgTraversal *p)
{
    const CsgTree *csg = p->csg;
    for (uint32_t i = 0; i < csg->node_count; i++) {
        p->inside[i] = p->table->nodes[csg->first_node + i].idle_inside;
    }
    for (uint32_t i = 0; i < csg->primitive_count && !csg->parts; i++) {
        traversal_set_state(p, i);
    }
    for (uint32_t i = 0; csg->parts && i < csg->parts->loose_count; i++) {
        traversal_set_state(p, csg->parts->loose[i]);
    }
}

// Puts the crossings into order.
static void traversal_order(CsgTraversal *p)
{
    for (uint32_t i = p->count / 2; i-- > 0;) {
        heap_sift(p, i);
    }
}

// The node above a primitive that bounds the one around it.
static uint32_t bound_above(const CsgTraversal *p, const PreparedPrimitive *primitive)
{
    uint32_t at = primitive->node;
    while (p->table->nodes[at].op != NODE_BOUND) {
        at = p->table->nodes[at].parent;
    }
    return at;
}

// The ray has met a bound if it is inside of it.
static void bound_judge(CsgTraversal *p, uint32_t at, bool *is_met)
{
    const TreeNode *node = &p->table->nodes[at];
    uint32_t own = at - p->csg->first_node, around = node->parent - p->csg->first_node;
    if (!is_met[own] && node_is_inside(node, p->inside[own])) {
        is_met[own] = true;
        p->missed[around]--;
    }
}

// Finds out which bounds the ray meets on its way, as POV-Ray asks them: what lies outside of them is seen, too, by a
// ray that meets them anywhere. Their crossings are left out then.
static void traversal_bound(CsgTraversal *p)
{
    const CsgTree *csg = p->csg;
    bool is_met[csg->node_count];
    memset(is_met, 0, sizeof is_met);
    memset(p->missed, 0, csg->node_count * sizeof *p->missed);
    for (uint32_t i = 0; i < csg->node_count; i++) {
        const TreeNode *node = &p->table->nodes[csg->first_node + i];
        if (node->op == NODE_BOUND) {
            p->missed[node->parent - csg->first_node]++;
            bound_judge(p, csg->first_node + i, is_met);
        }
    }
    uint32_t count = p->count;
    traversal_order(p);
    while (p->count > 0) {
        const Crossing *c = &p->crossings[heap_pop(p)];
        if (traversal_primitive(p, c->solid)->bounds && !c->is_film) {
            traversal_toggle(p, c->solid);
            bound_judge(p, bound_above(p, traversal_primitive(p, c->solid)), is_met);
        }
    }
    for (uint32_t i = 0; i < count; i++) {
        if (!traversal_primitive(p, p->crossings[i].solid)->bounds) {
            p->crossings[p->count++] = p->crossings[i];
        }
    }
}

// Whether no crossing with a surface may lie at the limit or before it, as all that are left are at `t` or behind it.
// Those before it are asked about errors by nobody.
static bool traversal_is_beyond(CsgTraversal *p, double t, double limit)
{
    if (!(t > limit) || (p->csg->mesh_count > 0 && !(t > limit * (1.0 + 2.0 * MESH_ERROR_MOST)))) {
        return false;
    }
    if (p->greatest_bound < 0.0) {
        p->greatest_bound = 0.0;
        for (uint32_t i = 0; i < p->count; i++) {
            double bound = p->crossings[i].has_surface ? crossing_bound(p, &p->crossings[i]) : 0.0;
            p->greatest_bound = bound <= p->greatest_bound ? p->greatest_bound
                                : isnan(bound)             ? (double)INFINITY
                                                           : bound;
        }
    }
    if (t * (t / (t + p->greatest_bound)) * (1.0 - 16.0 * 0x1p-53) > limit) {
        return true; // the others' shares are no less than that of the nearest with the greatest of all
    }
    if (p->nearest_share == 0.0) {
        p->nearest_share = 1.0;
        for (uint32_t i = 0; i < p->count; i++) {
            Crossing *c = &p->crossings[i];
            double share = c->has_surface ? c->t / (c->t + crossing_error(p, c)) : 1.0;
            p->nearest_share = share < p->nearest_share ? share : p->nearest_share;
        }
    }
    return t * p->nearest_share * (1.0 - 8.0 * 0x1p-53) > limit; // rounding makes it greater by 3 u
}

// Whether the ray starts on one of the primitives.
RT_ALWAYS_INLINE bool traversal_is_own(const CsgTraversal *p, RayStart start)
{
    return starts_on_primitive(start) &&
           table_primitive_index(p->table, start.shape) - p->csg->first_primitive < p->csg->primitive_count;
}

// What bounds all that is seen is asked before all else, and then no more. False: the ray never comes inside of it.
// Bounds are among the primitives that are not seen.
static __attribute__((noinline)) bool traversal_meets_bounds(CsgTraversal *p, RayStart start)
{
    const CsgTree *csg = p->csg;
    for (uint32_t i = csg->seen_count; i < csg->primitive_count; i++) {
        if (!traversal_primitive(p, i)->bounds) {
            continue;
        }
        traversal_primitive_begin(p, i, start, traversal_is_own(p, start));
        if (!p->is_inside[i] && p->count == 0) {
            return false;
        }
        p->is_inside[i] = true;
        p->count = 0;
    }
    return true;
}

RT_ALWAYS_INLINE void traversal_ask(CsgTraversal *p, uint32_t index, RayStart start, bool has_meshes)
{
    if (p->csg->asks_bounds && traversal_primitive(p, index)->bounds) {
        return; // the ray has met it
    }
    bool is_own = traversal_is_own(p, start);
    p->is_inside[index] = false;
    if (has_meshes && primitive_is_mesh(traversal_primitive(p, index))) {
        traversal_mesh_begin(p, index);
    } else if (primitive_is_flat(traversal_primitive(p, index))) {
        traversal_flat(p, index, start);
    } else {
        traversal_primitive_begin(p, index, start, is_own);
    }
}

// When all that can be seen has been asked: mostly it turns out that nothing is before the limit, whatever clips it.
static void traversal_judge_seen(CsgTraversal *p, double limit)
{
    p->is_over = p->is_over || isinf(p->first_surface) || traversal_is_beyond(p, p->first_surface, limit);
}

// Where some primitives are not convex, the others, which cost less, are asked first: mostly those that are needed are
// missed.
static void traversal_begin_convex(CsgTraversal *p, RayStart start, double limit, bool has_meshes)
{
    for (int turn = 0; turn < 2; turn++) {
        for (uint32_t i = 0; i < p->csg->primitive_count && !p->is_over; i++) {
            if (primitive_is_convex(traversal_primitive(p, i)) == (turn == 0)) {
                traversal_ask(p, i, start, has_meshes);
            }
        }
    }
    traversal_judge_seen(p, limit);
}

// Finds the crossings.
RT_ALWAYS_INLINE void traversal_begin(CsgTraversal *p, RayStart start, double limit, bool has_meshes)
{
    if (!p->csg->is_convex) {
        traversal_begin_convex(p, start, limit, has_meshes);
        return;
    }
    for (uint32_t i = 0; i < p->csg->primitive_count && !p->is_over; i++) {
        traversal_ask(p, i, start, false);
        if (i + 1 == p->csg->seen_count) {
            traversal_judge_seen(p, limit);
        }
    }
}

// ---- many primitives, with a tree

static uint32_t csg_words(const CsgTree *csg)
{
    return (csg->primitive_count - 1) / 64 + 1;
}

// How far leaves are asked first: mostly the first surface of the loose primitives is seen, and what lies behind it
// matters to nobody. Without one they are asked all at once.
static double traversal_first_reach(CsgTraversal *p)
{
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *c = &p->crossings[i];
        double until = c->t + 2.0 * crossing_bound(p, c);
        if (c->has_surface && c->t == p->first_surface && until < (double)INFINITY) {
            return until;
        }
    }
    return (double)INFINITY;
}

// Asks the loose primitives, all that are seen perhaps among them.
static void traversal_begin_loose(CsgTraversal *p, RayStart start, double limit)
{
    const CsgPrimitives *parts = p->csg->parts;
    for (uint32_t i = 0; i < parts->loose_count && !p->is_over; i++) {
        traversal_ask(p, parts->loose[i], start, p->csg->mesh_count > 0);
    }
    if (!p->is_over && parts->are_leaves_unseen) {
        traversal_judge_seen(p, limit);
    }
    memset(p->met, 0, csg_words(p->csg) * sizeof *p->met);
    p->reached = p->is_over ? 0.0 : traversal_first_reach(p);
}

// Asks all leaves whose boxes are entered up to a place, but for those that were asked before.
static void traversal_reach(CsgTraversal *p, RayStart start, double until)
{
    uint32_t words = csg_words(p->csg);
    uint64_t met[words];
    memset(met, 0, sizeof met);
    csg_parts_along(p->csg->parts, p->ray, until, met);
    for (uint32_t word = 0; word < words; word++) {
        for (uint64_t rest = met[word] & ~p->met[word]; rest && !p->is_over; rest &= rest - 1) {
            uint32_t index = 64 * word + (uint32_t)__builtin_ctzll(rest);
            traversal_ask(p, index, start, false); // no mesh is in the tree
            traversal_set_state(p, index);
        }
        p->met[word] |= met[word];
    }
    p->reached = until;
    p->greatest_bound = -1.0;
    p->nearest_share = 0.0;
}

// ---- many primitives that only clip, joined by one node

// Whether the ray is inside of one of them all the way along some crossings.
typedef struct Joined {
    CsgTraversal *p;
    double from, to;
    bool is_inside, is_uncertain;
} Joined;

static bool joined_ask(void *client, uint32_t index)
{
    Joined *of = client;
    CsgTraversal *p = of->p;
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    RayInterval interval; // it is convex
    p->objects[index] = primitive_ray(primitive, p->ray);
    if (primitive_intervals(primitive, &p->objects[index], LEFT_NONE, &interval) == 0) {
        return false;
    }
    double enter_bound = end_bound(p, index, interval.enter, interval.enter_side);
    double leave_bound = end_bound(p, index, interval.leave, interval.leave_side);
    of->is_inside = interval.enter + enter_bound < of->from && interval.leave - leave_bound > of->to;
    bool is_apart = interval.leave + leave_bound < of->from || interval.enter - enter_bound > of->to;
    of->is_uncertain = of->is_uncertain || !(of->is_inside || is_apart);
    return of->is_inside;
}

static void joined_set(CsgTraversal *p, bool is_inside)
{
    uint32_t at = p->csg->parts->joined;
    if ((p->inside[at - p->csg->first_node] > 0) != is_inside) {
        traversal_count(p, at, is_inside);
    }
}

// Puts the node that joins them into its state where the ray has crossings, without asking more of them than one that
// the ray is inside of. False where rounding may decide.
static bool joined_settle(CsgTraversal *p, uint32_t begin, uint32_t end)
{
    Joined of = {p, (double)INFINITY, -(double)INFINITY, false, false};
    bool is_bounded = true;
    for (uint32_t i = begin; i < end; i++) {
        Crossing *c = &p->crossings[i];
        double bound = 2.0 * crossing_bound(p, c);
        is_bounded = is_bounded && bound < c->t;
        of.from = c->t - bound < of.from ? c->t - bound : of.from;
        of.to = c->t + bound > of.to ? c->t + bound : of.to;
    }
    if (!is_bounded || !(of.from > 2.0 * p->start_error)) {
        return false;
    }
    csg_parts_at(p->csg->parts, p->ray, of.from, of.to, joined_ask, &of);
    joined_set(p, of.is_inside);
    return of.is_inside || !of.is_uncertain;
}

// The crossings that were taken last are put back, and all leaves asked.
static void joined_give_up(CsgTraversal *p, RayStart start, uint32_t end)
{
    joined_set(p, false);
    p->count = end;
    traversal_reach(p, start, (double)INFINITY);
    traversal_order(p);
}

// Leaves out two crossings of one mesh that change nothing together, of those behind the first that was taken: where
// there is no room others of the mesh are there.
static bool traversal_cancel(CsgTraversal *p, uint32_t begin, uint32_t *end)
{
    Crossing *c = p->crossings;
    for (uint32_t i = begin + 1; i < *end; i++) {
        for (uint32_t k = i + 1; c[i].face != MESH_NO_FACE && k < *end; k++) {
            if (c[i].solid == c[k].solid && (c[i].is_film || c[i].leaves != c[k].leaves)) {
                memmove(&c[k], &c[k + 1], (*end - k - 1) * sizeof *c);
                memmove(&c[i], &c[i + 1], (*end - i - 2) * sizeof *c);
                *end -= 2;
                return true;
            }
        }
    }
    return false;
}

// In the place of a face's crossing, which was taken out of the heap and stands first among those from *begin to *end,
// the next one of the mesh comes into the heap. False: there is no room for one more.
static bool traversal_refill(CsgTraversal *p, uint32_t *begin, uint32_t *end)
{
    uint32_t index = p->crossings[*begin].solid;
    if (p->crossings[*begin].face == MESH_NO_FACE) {
        return true;
    }
    if (*end == p->csg->crossing_count && !traversal_cancel(p, *begin, end)) {
        return false;
    }
    Crossing *taken = &p->crossings[*begin];
    uint32_t before = p->count, taken_count = *end - *begin;
    memmove(taken + 1, taken, taken_count * sizeof *taken);
    traversal_next_face(p, index);
    if (p->count == before) { // no hole stays among those that were taken
        memmove(taken, taken + 1, taken_count * sizeof *taken);
        return true;
    }
    double bound = taken->bound;
    p->greatest_bound = p->greatest_bound >= 0.0 && bound > p->greatest_bound ? bound : p->greatest_bound;
    heap_push(p);
    ++*begin;
    ++*end;
    return true;
}

// Lets the crossings happen in order, those that come together at once, until one is seen or none can be any more.
RT_ALWAYS_INLINE void traversal_follow(CsgTraversal *p, RayStart start, bool asks_joined, bool has_meshes,
                                       Foremost *first)
{
    while (!p->is_over) {
        if (p->reached < (p->count > 0 ? p->crossings[0].t : (double)INFINITY)) { // not where that is NaN
            traversal_reach(p, start, (double)INFINITY);
            traversal_order(p);
            continue;
        }
        if (p->count == 0 || traversal_is_beyond(p, p->crossings[0].t, first->limit)) {
            return;
        }
        uint32_t end = p->count;
        uint32_t begin = heap_pop(p);
        Crossing earliest = p->crossings[begin];
        bool has_room = !has_meshes || traversal_refill(p, &begin, &end);
        while (has_room && p->count > 0 && !crossing_is_apart(p, &earliest, &p->crossings[0])) {
            begin = heap_pop(p);
            has_room = !has_meshes || traversal_refill(p, &begin, &end);
        }
        if (asks_joined && !joined_settle(p, begin, end)) {
            asks_joined = false;
            joined_give_up(p, start, end);
        } else if (traversal_cross(p, begin, end, first)) {
            return;
        }
    }
}

// Written once, for composites with meshes and for others.
RT_ALWAYS_INLINE void closest(const ShapeTable *table, const CsgTree *csg, const CsgRay *asked, bool has_meshes,
                              Foremost *first)
{
    const RayStart start = asked->start;
    uint32_t inside[csg->node_count], missed[csg->has_bounds ? csg->node_count : 1];
    bool is_inside[csg->primitive_count];
    Crossing crossings[csg->crossing_count];
    RayInterval intervals[csg->interval_most];
    Ray objects[csg->primitive_count];
    MeshCursor cursors[has_meshes ? csg->mesh_count : 1];
    CsgTraversal p = {.table = table,
                      .csg = csg,
                      .ray = asked->ray,
                      .start = start,
                      .start_error = asked->start_error,
                      .enter = asked->enter,
                      .origin_size = vec3_sum_abs(asked->ray->origin),
                      .direction_size = vec3_sum_abs(asked->ray->direction),
                      .first_surface = (double)INFINITY,
                      .greatest_bound = -1.0,
                      .inside = inside,
                      .missed = csg->has_bounds ? missed : NULL,
                      .is_inside = is_inside,
                      .objects = objects,
                      .crossings = crossings,
                      .intervals = intervals,
                      .cursors = cursors,
                      .reached = (double)INFINITY,
                      .decided_until = (double)INFINITY};
    uint64_t met[csg->parts ? csg_words(csg) : 1];
    p.met = met;
    if (csg->asks_bounds && !traversal_meets_bounds(&p, start)) {
        return;
    }
    if (csg->parts) {
        traversal_begin_loose(&p, start, first->limit);
    } else {
        traversal_begin(&p, start, first->limit, has_meshes);
    }
    if (p.is_over) {
        return;
    }
    if (csg->is_meet ? !csg->parts && meet_closest(&p, first) : csg->is_plain && plain_closest(&p, first)) {
        return;
    }
    traversal_set_states(&p);
    if (RT_UNLIKELY(csg->has_bounds)) {
        traversal_bound(&p);
    }
    bool asks_joined = csg->parts && csg->parts->joined != NODE_NONE;
    if (asks_joined) {
        p.reached = (double)INFINITY;
    } else if (csg->parts) {
        traversal_reach(&p, start, p.reached);
    }
    traversal_order(&p);
    traversal_follow(&p, start, asks_joined, has_meshes, first);
}

static __attribute__((noinline)) void closest_of_meshes(const ShapeTable *table, const CsgTree *csg,
                                                        const CsgRay *asked, Foremost *first)
{
    closest(table, csg, asked, true, first);
}

void csg_closest(const ShapeTable *table, const CsgTree *csg, const CsgRay *asked, Foremost *first)
{
    if (csg->hidden & asked->start.use) {
        return;
    }
    if (RT_UNLIKELY(csg->mesh_count > 0)) {
        closest_of_meshes(table, csg, asked, first);
    } else {
        closest(table, csg, asked, false, first);
    }
}
