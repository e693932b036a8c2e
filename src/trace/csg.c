// A ray against a composite: the crossings of all leaves in order, as changes of what the ray is inside of.
//
// At a crossing it is not asked where a point lies: each node counts its children that the ray is inside of, and a
// leaf's crossing changes the counts on its way to the root. Crossings that rounding cannot tell apart happen together:
// what hides a surface is judged on that side of them where it would show, so that coincident faces leave no film
// behind. docs/numerics.md, "Composites", says how near is together.
//
// Where a few convex leaves stand in one node and no crossings come together, what is seen follows from their intervals
// alone: most rays end there.
//
// SPDX-License-Identifier: MIT
#include "trace/csg_parts.h"

#include <string.h>

typedef struct Crossing {
    double t;
    double error;   // how far t may be off by rounding; before has_error how much it is at most
    double bound;   // of that, if has_bound
    uint32_t solid; // within the CSG tree
    uint32_t face;  // of a mesh, MESH_NO_FACE else
    uint8_t side;
    bool leaves;               // the solid's own inside, not minding PART_INVERSE
    bool is_film;              // changes nothing: of a flat leaf, or within one
    bool has_surface;          // one that can be seen: that of a shape that clips cannot
    bool is_hidden;            // found before the crossings of its group
    bool has_error, has_bound; // computed when they are asked for first: most crossings are never come to
} Crossing;

// A CSG tree while a ray passes through it.
typedef struct CsgTraversal {
    const ShapeTable *table;
    const CsgTree *csg;
    const Ray *ray;
    RayStart start;
    double start_error;                 // how far along the ray its start may be off its surface
    double enter;                       // where the ray comes to the CSG tree's box
    double origin_size, direction_size; // sums of the ray's coordinates' sizes
    double first_surface;               // the least t of crossings that have a surface
    double nearest_share;               // none of these that is left is nearer than this share of its t; 0: not known
    double greatest_bound;              // of these; less than 0: not known
    uint32_t *inside;                   // for each node
    uint64_t *met;                      // a bit for each leaf that was asked, where parts have a tree
    double reached;                     // leaves whose boxes are entered behind that have not been asked yet
    bool *is_inside;        // for each solid, PART_INVERSE minded; while crossings are found: if the ray starts inside
    Ray *objects;           // the ray in each solid's space, but for planes
    Crossing *crossings;    // a heap by t, then by number
    RayInterval *intervals; // of the solid that is asked
    uint32_t count;
    MeshCursor *cursors;                // of its meshes
    bool is_over;                       // nothing more of it can be seen
    double decided_from, decided_until; // where the ray is inside of all that decide, as far as it is known
} CsgTraversal;

static const Solid *traversal_solid(const CsgTraversal *p, uint32_t index)
{
    return &p->table->solids[p->csg->first_solid + index];
}

static bool node_is_inside(const TreeNode *node, uint32_t inside)
{
    return (inside >= node->needed) != node->is_inverse;
}

// The ray goes into or out of a child of a node.
static void traversal_count(CsgTraversal *p, uint32_t at, bool enters)
{
    while (at != NODE_NONE) {
        const TreeNode *node = &p->table->nodes[at];
        uint32_t *inside = &p->inside[at - p->csg->first_node];
        bool before = node_is_inside(node, *inside);
        *inside = enters ? *inside + 1 : *inside - 1;
        if (node_is_inside(node, *inside) == before) {
            return;
        }
        enters = !before;
        at = node->parent;
    }
}

// The ray goes into or out of a leaf's set.
static void traversal_toggle(CsgTraversal *p, uint32_t index)
{
    p->is_inside[index] = !p->is_inside[index];
    traversal_count(p, traversal_solid(p, index)->node, p->is_inside[index]);
}

// ---- the heap

static bool crossing_is_before(const Crossing *a, const Crossing *b)
{
    return a->t < b->t || (a->t == b->t && a->solid < b->solid);
}

static void heap_sift(CsgTraversal *p, uint32_t at)
{
    Crossing *c = p->crossings;
    for (;;) {
        uint32_t least = at;
        for (uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < p->count; child++) {
            least = crossing_is_before(&c[child], &c[least]) ? child : least;
        }
        if (least == at) {
            return;
        }
        Crossing moved = c[at];
        c[at] = c[least];
        c[least] = moved;
        at = least;
    }
}

// Takes the first crossing out and puts it where the heap ended; returns its place.
static uint32_t heap_pop(CsgTraversal *p)
{
    Crossing first = p->crossings[0];
    p->count--;
    p->crossings[0] = p->crossings[p->count];
    p->crossings[p->count] = first;
    heap_sift(p, 0);
    return p->count;
}

// Puts the crossing that was added last, behind the heap, into it.
static void heap_push(CsgTraversal *p)
{
    Crossing *c = p->crossings;
    for (uint32_t at = p->count - 1; at > 0 && crossing_is_before(&c[at], &c[(at - 1) / 2]); at = (at - 1) / 2) {
        Crossing moved = c[at];
        c[at] = c[(at - 1) / 2];
        c[(at - 1) / 2] = moved;
    }
}

// ---- what crosses the ray

static double crossing_error(const CsgTraversal *p, Crossing *c)
{
    if (!c->has_error) {
        c->error =
            solid_end_error(traversal_solid(p, c->solid), p->ray, &p->objects[c->solid], c->t, c->side, c->error);
        c->has_error = true;
    }
    return c->error;
}

static double end_bound(const CsgTraversal *p, uint32_t index, double t, uint8_t side)
{
    double span = p->origin_size + fabs(t) * p->direction_size;
    return solid_crossing_bound(traversal_solid(p, index), p->ray, &p->objects[index], t, side, span);
}

// At least the error; most questions have the same answer for it. May be NaN.
static double crossing_bound(const CsgTraversal *p, Crossing *c)
{
    if (!c->has_bound) {
        c->bound = end_bound(p, c->solid, c->t, c->side);
        c->has_bound = true;
    }
    return c->bound;
}

// Whether b lies behind a by more than both may be off.
static bool crossing_is_apart(const CsgTraversal *p, Crossing *a, Crossing *b)
{
    return b->t - crossing_bound(p, b) > a->t + crossing_bound(p, a) ||
           b->t - crossing_error(p, b) > a->t + crossing_error(p, a);
}

static void traversal_add(CsgTraversal *p, uint32_t index, double t, double length, uint8_t side, bool leaves,
                          bool is_film)
{
    const Solid *solid = traversal_solid(p, index);
    bool has_surface = !(solid->flags & PART_UNSEEN) && !((solid->flags & PART_OPEN) && side != 0);
    p->first_surface = has_surface && t < p->first_surface ? t : p->first_surface;
    p->crossings[p->count++] = (Crossing){.t = t,
                                          .error = length,
                                          .solid = index,
                                          .face = MESH_NO_FACE,
                                          .side = side,
                                          .leaves = leaves,
                                          .is_film = is_film,
                                          .has_surface = has_surface};
}

static void traversal_flat(CsgTraversal *p, uint32_t index, RayStart start)
{
    const Solid *solid = traversal_solid(p, index);
    Ray *object = &p->objects[index];
    double t;
    bool is_start = starts_on_part(start) && solid_equal(solid, table_solid(p->table, start.shape));
    *object = solid_ray(solid, p->ray);
    if (is_start || !solid_flat_root(solid, object, &t) || !(t > 0.0)) {
        return;
    }
    if (!starts_beside(p->table, start, solid) ||
        t > solid_crossing_error(solid, p->ray, object, t, 0) + p->start_error) {
        traversal_add(p, index, t, (double)INFINITY, 0, false, true);
    }
}

// The ray is inside of a solid that decides from `enter` to `leave` and nowhere else. Where one of them is left before
// another is come to, no surface shows: at each crossing one of the two is outside, before it and after it.
static void traversal_decide(CsgTraversal *p, double enter, double leave)
{
    p->decided_from = enter > p->decided_from ? enter : p->decided_from;
    p->decided_until = leave < p->decided_until ? leave : p->decided_until;
    p->is_over = p->is_over || p->decided_until < p->decided_from;
}

// Whether an end of an interval, t > 0, lies within rounding of the ray's start on a surface: no farther than the error
// and the start's own. What is at least the error is asked first.
static bool end_is_at_start(const CsgTraversal *p, uint32_t index, double t, uint8_t side, double length)
{
    return (isinf(t) || !(t > end_bound(p, index, t, side) + p->start_error)) &&
           !(t >
             solid_end_error(traversal_solid(p, index), p->ray, &p->objects[index], t, side, length) + p->start_error);
}

// Whether the ray has passed an end of an interval. No error is greater than the interval is long.
RT_ALWAYS_INLINE bool traversal_is_past(const CsgTraversal *p, uint32_t index, double t, uint8_t side, double length,
                                        bool is_beside)
{
    return !(t > 0.0) || (is_beside && !(t > length + p->start_error) && end_is_at_start(p, index, t, side, length));
}

// Adds the ends of an interval that the ray crosses later; true when it starts inside of it.
RT_ALWAYS_INLINE bool traversal_interval(CsgTraversal *p, uint32_t index, const RayInterval *interval, double room,
                                         bool is_start, bool is_beside)
{
    bool is_film = solid_is_film(traversal_solid(p, index), interval->leave_side);
    bool is_inside = (is_start && solid_is_convex(traversal_solid(p, index))) ||
                     traversal_is_past(p, index, interval->enter, interval->enter_side, room, is_beside);
    if (!is_inside) {
        traversal_add(p, index, interval->enter, room, interval->enter_side, is_film, is_film);
    }
    if (interval->leave < (double)INFINITY) {
        traversal_add(p, index, interval->leave, room, interval->leave_side, !is_film, is_film);
    }
    return is_inside && !is_film;
}

// ---- meshes: a line may cross one any number of times, so the next crossing of each is known, and no more

// Whether the ray has passed a crossing with a face.
static bool face_is_past(const CsgTraversal *p, uint32_t index, double t, uint32_t face)
{
    const Solid *solid = traversal_solid(p, index);
    bool is_left = p->start.shape != SHAPE_NONE && shape_kind(p->start.shape) == SHAPE_FACE &&
                   shape_index(p->start.shape) == solid->mesh.first_face + face;
    return is_left || (starts_beside(p->table, p->start, solid) &&
                       !(t > mesh_crossing_error(solid, p->ray, &p->objects[index], t, face) + p->start_error));
}

// A mesh of a traversal, for mesh_count.
typedef struct TraversalMesh {
    const CsgTraversal *p;
    uint32_t index;
} TraversalMesh;

static bool mesh_is_past(const void *client, double t, uint32_t face)
{
    const TraversalMesh *mesh = client;
    return face_is_past(mesh->p, mesh->index, t, face);
}

// The next crossing behind the cursor that the ray has not passed. False: there is none.
static bool traversal_find_face(CsgTraversal *p, uint32_t index, double *t)
{
    const Solid *solid = traversal_solid(p, index);
    MeshCursor *cursor = &p->cursors[solid->mesh.cursor];
    while (mesh_next(solid, cursor, t)) {
        if (!face_is_past(p, index, *t, cursor->face)) {
            return true;
        }
    }
    return false;
}

static void traversal_next_face(CsgTraversal *p, uint32_t index)
{
    const Solid *solid = traversal_solid(p, index);
    MeshCursor *cursor = &p->cursors[solid->mesh.cursor];
    double t;
    if (!traversal_find_face(p, index, &t)) {
        return;
    }
    bool is_film = solid_is_flat(solid);
    traversal_add(p, index, t, (double)INFINITY, 0, !is_film && cursor->is_inside, is_film);
    Crossing *added = &p->crossings[p->count - 1];
    added->face = cursor->face;
    added->error = added->bound = mesh_crossing_error(solid, p->ray, &p->objects[index], t, cursor->face);
    added->has_error = added->has_bound = true;
    cursor->is_inside = !cursor->is_inside;
}

// The crossings that are left tell by their number whether the ray starts inside.
static void traversal_mesh_begin(CsgTraversal *p, uint32_t index)
{
    const Solid *solid = traversal_solid(p, index);
    MeshCursor *cursor = &p->cursors[solid->mesh.cursor];
    p->objects[index] = solid_ray(solid, p->ray);
    *cursor = (MeshCursor){.face = MESH_NO_FACE};
    mesh_query_make(&cursor->query, &p->objects[index]);
    bool is_inside =
        !solid_is_flat(solid) && mesh_count(solid, cursor, mesh_is_past, &(TraversalMesh){p, index}) % 2 == 1;
    cursor->is_inside = p->is_inside[index] = is_inside;
    traversal_next_face(p, index);
}

// Puts a leaf into the state it has where the ray starts, and adds what the ray crosses of it later.
RT_ALWAYS_INLINE void traversal_solid_begin(CsgTraversal *p, uint32_t index, RayStart start, bool is_own)
{
    const Solid *solid = traversal_solid(p, index);
    bool is_start = is_own && table_part(p->table, start.shape) == p->csg->first_solid + index;
    bool is_beside = !is_start && (is_own || starts_beside(p->table, start, solid));
    bool inward = start.inward != solid->flips;
    RayInterval *intervals = p->intervals;
    unsigned count = 0;
    const Ray *object = p->ray;
    if (solid->kind != PART_PLANE) {
        p->objects[index] = solid_ray(solid, p->ray);
        object = &p->objects[index];
    }
    if (!is_start || inward || !solid_is_convex(solid)) {
        SideLeft left = {is_start ? part_side(start.shape) : SIDE_NONE, inward};
        count = solid_intervals(solid, object, left, intervals);
    }
    bool is_met = false, is_inside = false;
    for (unsigned i = 0; i < count; i++) {
        const RayInterval *interval = &intervals[i];
        double room = solid_is_convex(solid) ? interval->leave - interval->enter : interval_room(intervals, count, i);
        if ((solid->decides && interval->leave < p->decided_from) || // whether it is past or not
            traversal_is_past(p, index, interval->leave, interval->leave_side, room, is_beside)) {
            continue;
        }
        bool starts_inside = traversal_interval(p, index, interval, room, is_start, is_beside);
        if (solid->decides) {
            traversal_decide(p, starts_inside ? 0.0 : interval->enter, interval->leave);
        }
        is_inside = is_inside || starts_inside;
        is_met = true;
    }
    p->is_inside[index] = is_inside;
    p->is_over = p->is_over || (solid->decides && !is_met);
}

// ---- what is seen

// Whether nothing on the way to the root hides the surface, as far as it can be judged before the crossings of its
// group (is_after = false) or after them. An intersection shows a surface where all others are inside on the inner side
// of it, a merge where none is on the outer side.
static bool crossing_shows(const CsgTraversal *p, const Crossing *c, bool is_after)
{
    const Solid *solid = traversal_solid(p, c->solid);
    bool leaves = c->leaves != (bool)(solid->flags & PART_INVERSE);
    bool is_child_inside = !solid_is_flat(solid) && p->is_inside[c->solid];
    uint32_t at = solid->node;
    while (at != NODE_NONE) {
        const TreeNode *node = &p->table->nodes[at];
        uint32_t inside = p->inside[at - p->csg->first_node];
        uint32_t others = inside - is_child_inside;
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
            p->is_over = p->is_over || (c->leaves && traversal_solid(p, c->solid)->decides);
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
        uint32_t face = traversal_solid(p, seen->solid)->mesh.first_face + seen->face;
        face_offer(p->table, shape_id(SHAPE_FACE, face), p->ray, seen->t,
                   crossing_span(seen->t, crossing_error(p, seen), p->enter), first);
    } else if (seen) {
        solid_offer(p->table, p->csg->first_solid + seen->solid, p->ray, seen->t,
                    crossing_span(seen->t, crossing_error(p, seen), p->enter), seen->side, seen->leaves, first);
    }
    return seen;
}

static void traversal_set_state(CsgTraversal *p, uint32_t index)
{
    bool is_inside = p->is_inside[index];
    p->is_inside[index] = traversal_solid(p, index)->flags & PART_INVERSE;
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
    for (uint32_t i = 0; i < csg->solid_count && !csg->parts; i++) {
        traversal_set_state(p, i);
    }
    for (uint32_t i = 0; csg->parts && i < csg->parts->loose_count; i++) {
        traversal_set_state(p, csg->parts->loose[i]);
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

RT_ALWAYS_INLINE void traversal_ask(CsgTraversal *p, uint32_t index, RayStart start, bool has_meshes)
{
    const CsgTree *csg = p->csg;
    bool is_own = starts_on_part(start) && table_part(p->table, start.shape) - csg->first_solid < csg->solid_count;
    p->is_inside[index] = false;
    if (has_meshes && solid_is_mesh(traversal_solid(p, index))) {
        traversal_mesh_begin(p, index);
    } else if (solid_is_flat(traversal_solid(p, index))) {
        traversal_flat(p, index, start);
    } else {
        traversal_solid_begin(p, index, start, is_own);
    }
}

// When all that can be seen has been asked: mostly it turns out that nothing is before the limit, whatever clips it.
static void traversal_judge_seen(CsgTraversal *p, double limit)
{
    p->is_over = p->is_over || isinf(p->first_surface) || traversal_is_beyond(p, p->first_surface, limit);
}

// Finds the crossings.
RT_ALWAYS_INLINE void traversal_begin(CsgTraversal *p, RayStart start, double limit, bool has_meshes)
{
    for (uint32_t i = 0; i < p->csg->solid_count && !p->is_over; i++) {
        traversal_ask(p, i, start, has_meshes);
        if (i + 1 == p->csg->seen_count) {
            traversal_judge_seen(p, limit);
        }
    }
}

// Puts the crossings into order.
static void traversal_order(CsgTraversal *p)
{
    for (uint32_t i = p->count / 2; i-- > 0;) {
        heap_sift(p, i);
    }
}

// ---- many parts, with a tree

static uint32_t csg_words(const CsgTree *csg)
{
    return (csg->solid_count - 1) / 64 + 1;
}

// How far leaves are asked first: mostly the first surface of the loose parts is seen, and what lies behind it matters
// to nobody. Without one they are asked all at once.
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

// Asks the loose parts, all that are seen perhaps among them.
static void traversal_begin_loose(CsgTraversal *p, RayStart start, double limit)
{
    const CsgParts *parts = p->csg->parts;
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

// ---- many parts that only clip, joined by one node

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
    const Solid *solid = traversal_solid(p, index);
    RayInterval interval; // it is convex
    p->objects[index] = solid_ray(solid, p->ray);
    if (solid_intervals(solid, &p->objects[index], LEFT_NONE, &interval) == 0) {
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

// ---- one node of convex leaves

// The crossings of such a tree by leaf: of each it has two at most. What is missing lies behind the start, or nowhere.
typedef struct PlainEnds {
    Crossing *enter[CSG_PLAIN_MOST], *leave[CSG_PLAIN_MOST];
} PlainEnds;

static bool plain_is_inverse(const CsgTraversal *p, uint32_t index)
{
    return traversal_solid(p, index)->flags & PART_INVERSE;
}

// The crossing at which the ray comes out of all that it starts in.
static Crossing *plain_first_out(const CsgTraversal *p, const PlainEnds *ends)
{
    Crossing *first = NULL;
    for (uint32_t i = 0; i < p->csg->solid_count; i++) {
        Crossing *out = plain_is_inverse(p, i) ? ends->enter[i] : ends->leave[i];
        first = out && (!first || out->t < first->t) ? out : first;
    }
    return first;
}

// The crossing at which the ray has come into all of them: it is in all that decide from the last of their ends on, and
// behind that each leaf that is cut out of them may be left later. NULL when it never is.
static Crossing *plain_last_in(const CsgTraversal *p, const PlainEnds *ends)
{
    Crossing *last = NULL;
    for (uint32_t i = 0; i < p->csg->solid_count; i++) {
        Crossing *in = plain_is_inverse(p, i) ? NULL : ends->enter[i];
        last = in && (!last || in->t > last->t) ? in : last;
    }
    for (uint32_t i = 0; i < p->csg->solid_count;) {
        double from = last ? last->t : 0.0;
        bool is_cut = plain_is_inverse(p, i) && (p->is_inside[i] || (ends->enter[i] && ends->enter[i]->t < from)) &&
                      (!ends->leave[i] || ends->leave[i]->t > from);
        if (is_cut && (!ends->leave[i] || ends->leave[i]->t > p->decided_until)) {
            return NULL;
        }
        last = is_cut ? ends->leave[i] : last;
        i = is_cut ? 0 : i + 1; // what was no cut before may be one there
    }
    return last;
}

// Whether each crossing up to `until` happens by itself: the next one is apart from it.
static bool plain_are_apart(CsgTraversal *p, double until)
{
    Crossing *order[2 * CSG_PLAIN_MOST];
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *own = &p->crossings[i];
        uint32_t at = i;
        for (; at > 0 && crossing_is_before(own, order[at - 1]); at--) {
            order[at] = order[at - 1];
        }
        order[at] = own;
    }
    for (uint32_t i = 0; i + 1 < p->count && order[i]->t <= until; i++) {
        if (!crossing_is_apart(p, order[i], order[i + 1])) {
            return false;
        }
    }
    return true;
}

// What traversal_cross finds where no crossing comes with others, by intervals. False where some come together up to
// what is seen, or to where nothing more can be, or where what would be seen has no surface: nothing was decided.
static bool plain_closest(CsgTraversal *p, Foremost *first)
{
    PlainEnds ends = {{NULL}, {NULL}};
    bool starts_inside = true;
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *c = &p->crossings[i];
        *(c->leaves ? &ends.leave[c->solid] : &ends.enter[c->solid]) = c;
    }
    for (uint32_t i = 0; i < p->csg->solid_count; i++) {
        starts_inside = starts_inside && p->is_inside[i] != plain_is_inverse(p, i);
    }
    Crossing *seen = starts_inside ? plain_first_out(p, &ends) : plain_last_in(p, &ends);
    bool is_seen = seen && seen->t <= p->decided_until;
    if ((is_seen && !seen->has_surface) || !plain_are_apart(p, is_seen ? seen->t : p->decided_until)) {
        return false;
    }
    if (is_seen) {
        solid_offer(p->table, p->csg->first_solid + seen->solid, p->ray, seen->t,
                    crossing_span(seen->t, crossing_error(p, seen), p->enter), seen->side, seen->leaves, first);
    }
    return true;
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

// Written once, for composites with meshes and for others.
RT_ALWAYS_INLINE void closest(const ShapeTable *table, const CsgTree *csg, const Ray *ray, RayStart start,
                              double start_error, double enter, bool has_meshes, Foremost *first)
{
    uint32_t inside[csg->node_count];
    bool is_inside[csg->solid_count];
    Crossing crossings[csg->crossing_count];
    RayInterval intervals[csg->interval_most];
    Ray objects[csg->solid_count];
    MeshCursor cursors[has_meshes ? csg->mesh_count : 1];
    CsgTraversal p = {.table = table,
                      .csg = csg,
                      .ray = ray,
                      .start = start,
                      .start_error = start_error,
                      .enter = enter,
                      .origin_size = vec3_sum_abs(ray->origin),
                      .direction_size = vec3_sum_abs(ray->direction),
                      .first_surface = (double)INFINITY,
                      .greatest_bound = -1.0,
                      .inside = inside,
                      .is_inside = is_inside,
                      .objects = objects,
                      .crossings = crossings,
                      .intervals = intervals,
                      .cursors = cursors,
                      .reached = (double)INFINITY,
                      .decided_until = (double)INFINITY};
    uint64_t met[csg->parts ? csg_words(csg) : 1];
    p.met = met;
    if (csg->parts) {
        traversal_begin_loose(&p, start, first->limit);
    } else {
        traversal_begin(&p, start, first->limit, has_meshes);
    }
    if (p.is_over) {
        return;
    }
    if (csg->is_plain && plain_closest(&p, first)) {
        return;
    }
    traversal_set_states(&p);
    bool asks_joined = csg->parts && csg->parts->joined != NODE_NONE;
    if (asks_joined) {
        p.reached = (double)INFINITY;
    } else if (csg->parts) {
        traversal_reach(&p, start, p.reached);
    }
    traversal_order(&p);
    while (!p.is_over) {
        if (p.reached < (p.count > 0 ? crossings[0].t : (double)INFINITY)) { // not where that is NaN
            traversal_reach(&p, start, (double)INFINITY);
            traversal_order(&p);
            continue;
        }
        if (p.count == 0 || traversal_is_beyond(&p, crossings[0].t, first->limit)) {
            return;
        }
        uint32_t end = p.count;
        uint32_t begin = heap_pop(&p);
        Crossing earliest = crossings[begin];
        bool has_room = !has_meshes || traversal_refill(&p, &begin, &end);
        while (has_room && p.count > 0 && !crossing_is_apart(&p, &earliest, &crossings[0])) {
            begin = heap_pop(&p);
            has_room = !has_meshes || traversal_refill(&p, &begin, &end);
        }
        if (asks_joined && !joined_settle(&p, begin, end)) {
            asks_joined = false;
            joined_give_up(&p, start, end);
        } else if (traversal_cross(&p, begin, end, first)) {
            return;
        }
    }
}

static __attribute__((noinline)) void closest_of_meshes(const ShapeTable *table, const CsgTree *csg, const Ray *ray,
                                                        RayStart start, double start_error, double enter,
                                                        Foremost *first)
{
    closest(table, csg, ray, start, start_error, enter, true, first);
}

void csg_closest(const ShapeTable *table, const CsgTree *csg, const Ray *ray, RayStart start, double start_error,
                 double enter, Foremost *first)
{
    if (csg->hidden & start.use) {
        return;
    }
    if (RT_UNLIKELY(csg->mesh_count > 0)) {
        closest_of_meshes(table, csg, ray, start, start_error, enter, first);
    } else {
        closest(table, csg, ray, start, start_error, enter, false, first);
    }
}
