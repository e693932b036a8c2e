// A CSG tree while a ray passes through it: the ray and the tree's leaves become crossings in order of t, and a count, for
// each node, of the children that the ray is inside of.
//
// csg.c decides by them what is seen. Owns nothing: the arrays are those of the one query that runs, csg_closest's. Knows
// nothing of what hides a surface.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_TRAVERSAL_H
#define TRACE_CSG_TRAVERSAL_H

#include "math/extreme.h"
#include "trace/csg_parts.h"

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
    double decided_from, decided_until; // where the ray may be inside of all that are needed, as far as it is known
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

// The ray is inside of a solid that is needed nowhere but from `enter` to `leave`. Where one of them is left before
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

// The ray starts inside if the number of crossings that are left is odd.
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
    double enter = (double)INFINITY, leave = 0.0; // of all intervals, which films among them leave out of order
    for (unsigned i = 0; i < count; i++) {
        const RayInterval *interval = &intervals[i];
        double room = solid_is_convex(solid) ? interval->leave - interval->enter : interval_room(intervals, count, i);
        if ((solid->is_needed && interval->leave < p->decided_from) || // whether it is past or not
            traversal_is_past(p, index, interval->leave, interval->leave_side, room, is_beside)) {
            continue;
        }
        bool starts_inside = traversal_interval(p, index, interval, room, is_start, is_beside);
        enter = starts_inside ? 0.0 : less_of(enter, interval->enter);
        leave = greater_of(leave, interval->leave);
        is_inside = is_inside || starts_inside;
        is_met = true;
    }
    p->is_inside[index] = is_inside;
    if (solid->is_needed && is_met) {
        traversal_decide(p, enter, leave);
    }
    p->is_over = p->is_over || (solid->is_needed && !is_met);
}

#endif
