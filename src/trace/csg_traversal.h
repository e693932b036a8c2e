// A CSG tree while a ray passes through it: the ray and the tree's leaves become crossings in order of t, and a count,
// for each node, of the children that the ray is inside of.
//
// csg.c decides by them what is seen. Owns nothing: the arrays are those of the one query that runs, csg_closest's.
// Knows nothing of what hides a surface.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_TRAVERSAL_H
#define TRACE_CSG_TRAVERSAL_H

#include "math/extreme.h"
#include "scene/mesh_field.h"
#include "trace/csg_primitives.h"

typedef struct Crossing {
    double t;
    double error;   // how far t may be off by rounding; before has_error how much it is at most
    double bound;   // of that, if has_bound
    uint32_t solid; // within the CSG tree
    uint32_t face;  // of a mesh, MESH_NO_FACE else
    uint8_t side;
    bool leaves;               // the primitive's own inside, not minding PRIMITIVE_INVERSE
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
    uint32_t *missed;                   // likewise, its bounds that the ray does not meet; NULL: there are none
    uint64_t *met;                      // a bit for each leaf that was asked, where primitives have a tree
    double reached;                     // leaves whose boxes are entered behind that have not been asked yet
    bool
        *is_inside; // for each primitive, PRIMITIVE_INVERSE minded; while crossings are found: if the ray starts inside
    Ray *objects;   // the ray in each primitive's space, but for planes
    Crossing *crossings;    // a heap by t, then by number
    RayInterval *intervals; // of the primitive that is asked
    uint32_t count;
    MeshCursor *cursors;                // of its meshes
    bool is_over;                       // nothing more of it can be seen
    double decided_from, decided_until; // where the ray may be inside of all that are needed, as far as it is known
} CsgTraversal;

static const PreparedPrimitive *traversal_primitive(const CsgTraversal *p, uint32_t index)
{
    return &p->table->primitives[p->csg->first_primitive + index];
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
        if (node_is_inside(node, *inside) == before || node->op == NODE_BOUND) {
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
    traversal_count(p, traversal_primitive(p, index)->node, p->is_inside[index]);
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
        c->error = primitive_end_error(traversal_primitive(p, c->solid), p->ray, &p->objects[c->solid], c->t, c->side,
                                       c->error);
        c->has_error = true;
    }
    return c->error;
}

static void crossing_offer(const CsgTraversal *p, Crossing *c, Foremost *first)
{
    const PrimitiveRoot root = {p->csg->first_primitive + c->solid, c->side, c->leaves, c->t};
    primitive_offer(p->table, p->ray, &root, crossing_span(c->t, crossing_error(p, c), p->enter), first);
}

static double end_bound(const CsgTraversal *p, uint32_t index, double t, uint8_t side)
{
    double span = p->origin_size + fabs(t) * p->direction_size;
    return primitive_crossing_bound(traversal_primitive(p, index), p->ray, &p->objects[index], t, side, span);
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

// Adds a crossing with a side of a primitive, whose surface it has where that can be seen.
static void traversal_add(CsgTraversal *p, Crossing crossing)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, crossing.solid);
    crossing.face = MESH_NO_FACE;
    crossing.has_surface =
        !(primitive->flags & PRIMITIVE_UNSEEN) && !primitive_side_is_unseen(primitive, crossing.side);
    p->first_surface = crossing.has_surface && crossing.t < p->first_surface ? crossing.t : p->first_surface;
    p->crossings[p->count++] = crossing;
}

static void traversal_flat(CsgTraversal *p, uint32_t index, RayStart start)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    Ray *object = &p->objects[index];
    double t;
    bool is_start = starts_on_primitive(start) && primitive_equal(primitive, table_primitive(p->table, start.shape));
    *object = primitive_ray(primitive, p->ray);
    if (is_start || !primitive_flat_root(primitive, object, &t) || !(t > 0.0)) {
        return;
    }
    if (!starts_beside(p->table, start, primitive) ||
        t > primitive_crossing_error(primitive, p->ray, object, t, 0) + p->start_error) {
        traversal_add(p, (Crossing){.t = t, .error = (double)INFINITY, .solid = index, .is_film = true});
    }
}

// The ray is inside of a primitive that is needed nowhere but from `enter` to `leave`. Where one of them is left before
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
           !(t > primitive_end_error(traversal_primitive(p, index), p->ray, &p->objects[index], t, side, length) +
                     p->start_error);
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
    bool is_film = primitive_is_film(traversal_primitive(p, index), interval->leave_side);
    bool is_inside = (is_start && primitive_is_convex(traversal_primitive(p, index))) ||
                     traversal_is_past(p, index, interval->enter, interval->enter_side, room, is_beside);
    if (!is_inside) {
        traversal_add(p, (Crossing){.t = interval->enter,
                                    .error = room,
                                    .solid = index,
                                    .side = interval->enter_side,
                                    .leaves = is_film,
                                    .is_film = is_film});
    }
    if (interval->leave < (double)INFINITY) {
        traversal_add(p, (Crossing){.t = interval->leave,
                                    .error = room,
                                    .solid = index,
                                    .side = interval->leave_side,
                                    .leaves = !is_film,
                                    .is_film = is_film});
    }
    return is_inside && !is_film;
}

// ---- meshes: a line may cross one any number of times, so the next crossing of each is known, and no more

// Whether the ray has passed a crossing with a face.
static bool face_is_past(const CsgTraversal *p, uint32_t index, double t, uint32_t face)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    bool is_left = p->start.shape != SHAPE_NONE && shape_kind(p->start.shape) == SHAPE_FACE &&
                   shape_index(p->start.shape) == primitive->mesh.first_face + face;
    return is_left || (starts_beside(p->table, p->start, primitive) &&
                       !(t > mesh_crossing_error(primitive, p->ray, &p->objects[index], t, face) + p->start_error));
}

// A mesh of a traversal, for mesh_ahead.
typedef struct TraversalMesh {
    const CsgTraversal *p;
    uint32_t index;
} TraversalMesh;

static bool mesh_is_past(const void *client, double t, uint32_t face)
{
    const TraversalMesh *mesh = client;
    const PreparedPrimitive *primitive = traversal_primitive(mesh->p, mesh->index);
    return !mesh_shows(primitive->mesh.table, &mesh->p->objects[mesh->index], t, face) ||
           face_is_past(mesh->p, mesh->index, t, face);
}

// The next crossing behind the cursor that the ray has not passed. False: there is none.
static bool traversal_find_face(CsgTraversal *p, uint32_t index, double *t)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    MeshCursor *cursor = &p->cursors[primitive->mesh.cursor];
    while (mesh_next(primitive, cursor, t)) {
        if (mesh_shows(primitive->mesh.table, &p->objects[index], *t, cursor->face) &&
            !face_is_past(p, index, *t, cursor->face)) {
            return true;
        }
    }
    return false;
}

// A crossing of a mesh with a face, or with a side of a field of heights, where `error` is how far t may be off.
static void traversal_add_face(CsgTraversal *p, uint32_t index, double t, uint32_t face, double error)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    MeshCursor *cursor = &p->cursors[primitive->mesh.cursor];
    bool is_film = primitive_is_flat(primitive);
    traversal_add(p, (Crossing){.t = t,
                                .error = (double)INFINITY,
                                .solid = index,
                                .leaves = !is_film && cursor->is_inside,
                                .is_film = is_film});
    Crossing *added = &p->crossings[p->count - 1];
    added->face = face;
    added->error = added->bound = error;
    added->has_error = added->has_bound = true;
    added->has_surface = added->has_surface && face != MESH_SIDE;
    cursor->is_inside = !cursor->is_inside;
}

static double traversal_side_error(const CsgTraversal *p, uint32_t index, double t, int axis)
{
    Vec3 normal = vec3(axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0);
    return primitive_plane_error(traversal_primitive(p, index), p->ray, &p->objects[index], t, normal);
}

// Adds where a ray comes through a side or the water of a field of heights.
static void traversal_add_side(CsgTraversal *p, uint32_t index, double t, int axis)
{
    traversal_add_face(p, index, t, MESH_SIDE, traversal_side_error(p, index, t, axis));
}

static void traversal_next_face(CsgTraversal *p, uint32_t index)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    MeshCursor *cursor = &p->cursors[primitive->mesh.cursor], before = *cursor;
    bool is_field = primitive->mesh.table->mesh->field;
    double t;
    if (cursor->is_left) {
        return;
    }
    bool is_found = traversal_find_face(p, index, &t);
    if (is_field && cursor->water < (is_found ? t : (double)INFINITY)) {
        *cursor = before;
        cursor->water = (double)INFINITY;
        traversal_add_side(p, index, before.water, 1);
    } else if (is_found) {
        traversal_add_face(p, index, t, cursor->face,
                           mesh_crossing_error(primitive, p->ray, &p->objects[index], t, cursor->face));
    } else if (is_field) {
        cursor->is_left = true;
        if (cursor->is_inside && !isinf(cursor->leave)) {
            traversal_add_side(p, index, cursor->leave, cursor->leave_axis);
        }
    }
}

// ---- fields of heights: what is below one, between its four sides, is inside

// Where the ray is over or below a field: from `enter` to `leave`, across the axes x (0) or z (2).
typedef struct FieldWay {
    double enter, leave;
    int enter_axis, leave_axis;
} FieldWay;

static void way_narrow(FieldWay *way, double size, double origin, double direction, int axis)
{
    if (direction == 0.0) {
        way->leave = origin >= 0.0 && origin < size ? way->leave : -(double)INFINITY;
        return;
    }
    double a = (0.0 - origin) / direction, b = (size - origin) / direction;
    double enter = a < b ? a : b, leave = a < b ? b : a;
    way->enter_axis = enter > way->enter ? axis : way->enter_axis;
    way->leave_axis = leave < way->leave ? axis : way->leave_axis;
    way->enter = enter > way->enter ? enter : way->enter;
    way->leave = leave < way->leave ? leave : way->leave;
}

static FieldWay field_way(const MeshField *field, const Ray *object)
{
    Vec3 size = mesh_field_size(field);
    FieldWay way = {-(double)INFINITY, (double)INFINITY, 0, 0};
    way_narrow(&way, size.x, object->origin.x, object->direction.x, 0);
    way_narrow(&way, size.z, object->origin.z, object->direction.z, 2);
    return way;
}

// Whether a ray is below the field at the beginning of its way. It is known in the middle of the way to the first
// crossing, or behind the last one, if that is longer: each crossing changes it.
static bool way_begins_below(const MeshField *field, const Ray *object, double enter, double leave,
                             const MeshAhead *ahead)
{
    double first = ahead->count > 0 ? ahead->first : leave, last = ahead->count > 0 ? ahead->last : enter;
    bool is_odd = ahead->count % 2 == 1;
    if (isinf(leave)) { // straight up or down
        return (object->direction.y < 0.0) != is_odd;
    }
    if (leave - last > first - enter) {
        double t = last + (leave - last) / 2.0;
        return mesh_field_holds(field, vec3_add_scaled(object->origin, t, object->direction)) != is_odd;
    }
    return mesh_field_holds(field, vec3_add_scaled(object->origin, enter + (first - enter) / 2.0, object->direction));
}

static bool side_is_past(const CsgTraversal *p, uint32_t index, double t, int axis)
{
    return !(t > 0.0) || (starts_beside(p->table, p->start, traversal_primitive(p, index)) &&
                          !(t > traversal_side_error(p, index, t, axis) + p->start_error));
}

// Where a ray comes through water on its way; infinite: nowhere, or it has passed that.
static double field_water(const CsgTraversal *p, uint32_t index, double enter, double leave)
{
    const MeshField *field = traversal_primitive(p, index)->mesh.table->mesh->field;
    const Ray *object = &p->objects[index];
    double t = (field->water - object->origin.y) / object->direction.y;
    Vec3 point = vec3_add_scaled(object->origin, t, object->direction);
    bool is_met =
        t > enter && t < leave && mesh_field_is_over(field, point) && mesh_field_height(field, point) < field->water;
    return is_met && !side_is_past(p, index, t, 1) ? t : (double)INFINITY;
}

// Sets where the ray leaves; whether it starts inside; and adds where it comes inside through a side.
static void traversal_field_begin(CsgTraversal *p, uint32_t index, MeshAhead *ahead)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    const Ray *object = &p->objects[index];
    MeshCursor *cursor = &p->cursors[primitive->mesh.cursor];
    FieldWay way = field_way(primitive->mesh.table->mesh->field, object);
    cursor->leave = way.leave;
    cursor->leave_axis = way.leave_axis;
    cursor->is_left = !(way.leave > way.enter) || side_is_past(p, index, way.leave, way.leave_axis);
    if (cursor->is_left) {
        return;
    }
    bool is_entered = side_is_past(p, index, way.enter, way.enter_axis);
    way.enter = is_entered ? 0.0 : way.enter;
    cursor->water = field_water(p, index, way.enter, way.leave);
    if (cursor->water < (double)INFINITY) {
        *ahead =
            (MeshAhead){ahead->count + 1, less_of(ahead->first, cursor->water), greater_of(ahead->last, cursor->water)};
    }
    bool is_below = way_begins_below(primitive->mesh.table->mesh->field, object, way.enter, way.leave, ahead);
    p->is_inside[index] = cursor->is_inside = is_entered && is_below;
    if (!is_entered && is_below) {
        traversal_add_side(p, index, way.enter, way.enter_axis);
    } else {
        traversal_next_face(p, index);
    }
}

// The ray starts inside if the number of crossings that are left is odd.
static void traversal_mesh_begin(CsgTraversal *p, uint32_t index)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    MeshCursor *cursor = &p->cursors[primitive->mesh.cursor];
    p->objects[index] = primitive_ray(primitive, p->ray);
    *cursor = (MeshCursor){.face = MESH_NO_FACE};
    mesh_query_make(&cursor->query, &p->objects[index]);
    MeshAhead ahead = {0, 0.0, 0.0};
    if (!primitive_is_flat(primitive)) {
        ahead = mesh_ahead(primitive, cursor, mesh_is_past, &(TraversalMesh){p, index});
    }
    if (primitive->mesh.table->mesh->field) {
        traversal_field_begin(p, index, &ahead);
        return;
    }
    cursor->is_inside = p->is_inside[index] = ahead.count % 2 == 1;
    traversal_next_face(p, index);
}

// Puts a leaf into the state it has where the ray starts, and adds what the ray crosses of it later.
RT_ALWAYS_INLINE void traversal_primitive_begin(CsgTraversal *p, uint32_t index, RayStart start, bool is_own)
{
    const PreparedPrimitive *primitive = traversal_primitive(p, index);
    bool is_start = is_own && table_primitive_index(p->table, start.shape) == p->csg->first_primitive + index;
    bool is_beside = !is_start && (is_own || starts_beside(p->table, start, primitive));
    bool inward = start.inward != primitive->flips;
    RayInterval *intervals = p->intervals;
    unsigned count = 0;
    const Ray *object = p->ray;
    if (primitive->kind != PRIMITIVE_PLANE) {
        p->objects[index] = primitive_ray(primitive, p->ray);
        object = &p->objects[index];
    }
    if (primitive_is_convex(primitive) ? !is_start || inward : !shapes_are_abandoned(p->table)) {
        SideLeft left = {is_start ? primitive_side(start.shape) : SIDE_NONE, inward};
        count = primitive_is_convex(primitive)
                    ? primitive_intervals(primitive, object, left, intervals)
                    : primitive_intervals_within(primitive, object, left, p->decided_from, p->decided_until, intervals);
    }
    bool is_met = false, is_inside = false;
    double enter = (double)INFINITY, leave = 0.0; // of all intervals, which films among them leave out of order
    for (unsigned i = 0; i < count; i++) {
        const RayInterval *interval = &intervals[i];
        double room =
            primitive_is_convex(primitive) ? interval->leave - interval->enter : interval_room(intervals, count, i);
        if ((primitive->is_needed && interval->leave < p->decided_from) || // whether it is past or not
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
    if (primitive->is_needed && is_met) {
        traversal_decide(p, enter, leave);
    }
    p->is_over = p->is_over || (primitive->is_needed && !is_met);
}

#endif
