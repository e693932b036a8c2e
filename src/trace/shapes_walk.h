// Queries over primitives that stand alone and composites: part of spheres_kernel.c. The tree of their boxes is walked
// near child first.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_WALK_H
#define TRACE_SHAPES_WALK_H

#include "trace/bvh_walk.h"
#include "trace/shapes_query.h"
#include "trace/primitive_lanes.h"

// ---- one primitive

static void flat_closest(ShapeQuery *q, uint32_t index, const Ray *object, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    double t;
    if (!primitive_flat_root(primitive, object, &t) || !(t > 0.0)) {
        return;
    }
    double error = primitive_crossing_error(primitive, q->ray, object, t, 0);
    if (!is_passed(t, error, passed_error(q, primitive))) {
        root_offer(q, &(PrimitiveRoot){index, 0, false, t}, error, first);
    }
}

// ---- a curve, whose first root the test in lanes finds; see curve_lanes.h

// The same for one ray: whether it is found, and then where it is; `along` as in CurveFirst. *is_missed: for certain.
static __attribute__((noinline)) bool curve_first(const PreparedPrimitive *primitive, const Ray *object, double *t,
                                                  double *along, bool *is_missed)
{
    Vec3 o = object->origin, v = object->direction;
    const Doubles f[3] = {doubles_splat(o.x), doubles_splat(o.y), doubles_splat(o.z)};
    const Doubles d[3] = {doubles_splat(v.x), doubles_splat(v.y), doubles_splat(v.z)};
    CurveFirst first = {0}; // gcc at -O1 does not see that what is missed is not read
    switch (primitive->kind) {
    case PRIMITIVE_TORUS:
        *is_missed = !curve_lanes_first(primitive, PRIMITIVE_TORUS, false, f, d, 1, &first);
        break;
    case PRIMITIVE_BLOB:
        *is_missed = !curve_lanes_first(primitive, PRIMITIVE_BLOB, false, f, d, 1, &first);
        break;
    default: *is_missed = !curve_lanes_first(primitive, PRIMITIVE_POLYNOMIAL, false, f, d, 1, &first);
    }
    if (*is_missed || !(first.certain & 1)) {
        return false;
    }
    *t = first.root[0];
    *along = first.along[0];
    return true;
}

// All intervals, with the root that the test in lanes finds in its place.
static unsigned curve_intervals(const PreparedPrimitive *primitive, const Ray *object, RayInterval *intervals)
{
    double t, along;
    bool is_missed;
    unsigned count = primitive_intervals(primitive, object, LEFT_NONE, intervals), nearest = 0;
    if (count > 0 && curve_first(primitive, object, &t, &along, &is_missed)) {
        for (unsigned i = 1; i < count; i++) {
            nearest = fabs(intervals[i].enter - t) < fabs(intervals[nearest].enter - t) ? i : nearest;
        }
        intervals[nearest].enter = t;
    }
    return count;
}

static double several_error(const ShapeQuery *q, const PreparedPrimitive *primitive, const Ray *object, double t,
                            uint8_t side)
{
    RayInterval intervals[primitive->interval_most];
    unsigned count = primitive_is_curve(primitive) ? curve_intervals(primitive, object, intervals)
                                                   : primitive_intervals(primitive, object, LEFT_NONE, intervals);
    unsigned i = 0;
    while (i + 1 < count && intervals[i].enter != t) {
        i++;
    }
    double room = count > 0 ? interval_room(intervals, count, i) : (double)INFINITY;
    return primitive_end_error(primitive, q->ray, object, t, side, room);
}

// The error of a first hit of which only a bound is known. What is not a ball the ray does not start on.
static double bounded_error(const ShapeQuery *q, const Ray *object, const Hit *hit)
{
    const PreparedPrimitive *primitive = q->bounded;
    RayInterval interval;
    if (primitive->kind == PRIMITIVE_SPHERE) {
        return primitive_ball_error(primitive, q->ray, object, hit->t);
    }
    if (primitive_is_mesh(primitive)) {
        return mesh_crossing_error(primitive, q->ray, object, hit->t,
                                   shape_index(hit->shape) - primitive->mesh.first_face);
    }
    if (primitive_is_flat(primitive)) {
        return primitive_crossing_error(primitive, q->ray, object, hit->t, 0);
    }
    if (!primitive_is_convex(primitive)) {
        return several_error(q, primitive, object, hit->t, primitive_side(hit->shape));
    }
    (void)primitive_intervals(primitive, object, LEFT_NONE, &interval);
    return primitive_end_error(primitive, q->ray, object, hit->t, primitive_side(hit->shape),
                               interval.leave - interval.enter);
}

static void span_refine(ShapeQuery *q, Foremost *first)
{
    if (q->bounded) {
        Ray object = primitive_ray(q->bounded, q->ray);
        double error = bounded_error(q, &object, &first->hit);
        RootSpan span = crossing_span(first->hit.t, error, q->bounded_enter);
        first->from = span.from;
        first->limit = span.to;
        q->bounded = NULL;
    }
}

// Refines an approximate root of a ball.
static double ball_refine(const PreparedPrimitive *primitive, const Ray *world, double t)
{
    const SphereData unit = UNIT_SPHERE;
    Ray object = primitive_ray(primitive, world);
    SphereRay ray = sphere_ray_make(object.origin, object.direction);
    return sphere_refine(&ray, &unit, t);
}

// A root of a ball, which it may be that the ray has passed: then the other root.
static void ball_offer(ShapeQuery *q, const Ray *object, const SphereRay *ray, PrimitiveRoot root, double passed,
                       Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[root.index];
    const SphereData unit = UNIT_SPHERE;
    span_refine(q, first);
    double error = primitive_ball_error(primitive, q->ray, object, root.t);
    if (is_passed(root.t, error, passed)) {
        root.t = root.leaves ? 0.0 : sphere_root_inward(ray, &unit);
        error = primitive_ball_error(primitive, q->ray, object, root.t);
        root.leaves = true;
        if (is_passed(root.t, error, passed)) {
            return;
        }
    }
    root_offer(q, &root, error, first);
}

// Whether a root in t ± bound is the first for certain, of an item whose box the ray enters there.
static bool span_is_first(double t, double bound, double enter, const Foremost *first)
{
    double to = t + bound < enter ? enter : t + bound;
    return to < first->from && to < first->beaten && to < first->limit;
}

// Takes a hit with a primitive, in t ± bound, as the first; its span is computed when somebody asks.
static void span_take(ShapeQuery *q, const PreparedPrimitive *primitive, Hit hit, double bound, double enter,
                      Foremost *first)
{
    first->hit = hit;
    first->order = primitive->order;
    first->is_torn = false;
    first->from = hit.t - bound < enter ? enter : hit.t - bound;
    first->limit = hit.t + bound < enter ? enter : hit.t + bound;
    q->bounded = primitive;
    q->bounded_enter = enter;
}

// Takes a primitive, whose root is in t ± bound, as the first where that is certain. True when it was.
static bool primitive_is_first(ShapeQuery *q, PrimitiveRoot root, double bound, double enter, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[root.index];
    Hit hit = {root.t, primitive_shape(root.index, 0), root.leaves != primitive->flips};
    if (!span_is_first(root.t, bound, enter, first)) {
        return false;
    }
    span_take(q, primitive, hit, bound, enter, first);
    return true;
}

// The rules for spheres (trace/sphere.h) in the ball's own space: the class is certain and the root right to an ulp,
// for the ray as it is rounded there. No error is greater than the interval is long, and a root of sphere_test has 13
// bits: nearly always that is enough.
static void ball_closest(ShapeQuery *q, uint32_t index, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    const SphereData unit = UNIT_SPHERE;
    Ray object = primitive_ray(primitive, q->ray);
    SphereRay ray = sphere_ray_make(object.origin, object.direction);
    bool leaves;
    double t, enter;
    SphereVerdict verdict = sphere_test(&ray, &unit, &t, &leaves);
    if (verdict == SPHERE_MISS) {
        return;
    }
    if (verdict == SPHERE_UNCERTAIN) {
        t = sphere_exact(&ray, &unit, NULL, &leaves);
        if (t > 0.0) {
            ball_offer(q, &object, &ray, (PrimitiveRoot){index, 0, leaves, t}, passed_error(q, primitive), first);
        }
        return;
    }
    double bound = 2.0 * fabs(t + vec3_dot(ray.origin, ray.direction_over_length2)) + 0x1p-10 * t;
    if (t - bound > first->limit || !item_enters(q, &enter) || enter > first->limit) {
        return;
    }
    double passed = passed_error(q, primitive);
    PrimitiveRoot root = {index, 0, leaves, q->is_any ? t : sphere_refine(&ray, &unit, t)}; // near the ends of the range the bound is not that of t
    if (!is_passed(root.t, bound, passed) && primitive_is_first(q, root, bound, enter, first)) {
        return;
    }
    root.t = q->is_any ? sphere_refine(&ray, &unit, t) : root.t;
    ball_offer(q, &object, &ray, root, passed, first);
}

// A curve that the ray does not start on. False: several_closest is to be asked.
static bool curve_closest(ShapeQuery *q, uint32_t index, const Ray *object, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    double t, along, enter;
    bool is_missed;
    if (!curve_first(primitive, object, &t, &along, &is_missed)) {
        return is_missed;
    }
    LaneSlack slack = lane_slack(primitive, vec3_length(q->ray->origin));
    double bound = (slack.fixed + slack.slope * t) / along;
    if (t - bound > first->limit || !item_enters(q, &enter) || enter > first->limit) {
        return true;
    }
    return !is_passed(t, bound, passed_error(q, primitive)) &&
           primitive_is_first(q, (PrimitiveRoot){index, 0, false, t}, bound, enter, first);
}

// A ball that the ray goes into where it starts.
static void ball_closest_inward(ShapeQuery *q, uint32_t index, Foremost *first)
{
    const SphereData unit = UNIT_SPHERE;
    Ray object = primitive_ray(&q->table->primitives[index], q->ray);
    SphereRay ray = sphere_ray_make(object.origin, object.direction);
    double t = sphere_root_inward(&ray, &unit);
    if (t > 0.0) {
        ball_offer(q, &object, &ray, (PrimitiveRoot){index, 0, true, t}, -1.0, first);
    }
}

// Whether a root of the item that is asked, which is no farther than `to`, is met for certain before the way's end.
static bool end_is_met(ShapeQuery *q, double to, const Foremost *first)
{
    double enter;
    if (!(to < first->from && to < first->beaten && to < first->limit) || !item_enters(q, &enter)) {
        return false;
    }
    return enter < first->from && enter < first->beaten && enter < first->limit;
}

// An end of an interval that is no more off than `room`. False: the ray has passed it, or it has no surface.
RT_ALWAYS_INLINE bool end_offer(ShapeQuery *q, const Ray *object, PrimitiveRoot root, double room, double passed,
                                Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[root.index];
    if (!(root.t > 0.0) || primitive_side_is_unseen(primitive, root.side)) {
        return false;
    }
    if (!root.leaves && q->is_any && passed < 0.0 && end_is_met(q, root.t + 2.0 * room, first)) {
        first->hit.shape = primitive_shape(root.index, root.side); // whatever its error is
        return true;
    }
    double error = primitive_end_error(primitive, q->ray, object, root.t, root.side, room);
    if (is_passed(root.t, error, passed)) {
        return false;
    }
    root_offer(q, &root, error, first);
    return true;
}

// An interval of a primitive's.
typedef struct PrimitiveInterval {
    uint32_t index;
    RayInterval ends;
    double room;   // no end is more off
    bool is_film;  // it is left where others are entered, and the other way round
    bool is_start; // the ray starts in it, at its beginning
} PrimitiveInterval;

// The first end of an interval that the ray has not passed; where it starts on the primitive, what it starts in it
// leaves.
RT_ALWAYS_INLINE void interval_offer(ShapeQuery *q, const Ray *object, const PrimitiveInterval *own, double passed,
                                     Foremost *first)
{
    const PrimitiveRoot enter = {own->index, own->ends.enter_side, own->is_film, own->ends.enter};
    const PrimitiveRoot leave = {own->index, own->ends.leave_side, !own->is_film, own->ends.leave};
    if (enter.t - 2.0 * own->room > first->limit ||
        (!own->is_start && end_offer(q, object, enter, own->room, passed, first))) {
        return;
    }
    (void)end_offer(q, object, leave, own->room, passed, first);
}

// A primitive that is not convex.
static __attribute__((noinline)) void several_closest(ShapeQuery *q, uint32_t index, const Ray *object, SideLeft left,
                                                      Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    RayInterval intervals[primitive->interval_most];
    if (shapes_are_abandoned(q->table)) {
        return; // a line through a polynomial takes up to a millisecond
    }
    bool by_lanes = left.side == SIDE_NONE && primitive_is_curve(primitive);
    unsigned count = by_lanes ? curve_intervals(primitive, object, intervals)
                             : primitive_intervals(primitive, object, left, intervals);
    if (count == 0) {
        return;
    }
    double passed = left.side != SIDE_NONE ? -1.0 : passed_error(q, primitive);
    for (unsigned i = 0; i < count; i++) {
        PrimitiveInterval own = {index, intervals[i], interval_room(intervals, count, i),
                                 primitive_is_film(primitive, intervals[i].leave_side), false};
        interval_offer(q, object, &own, passed, first);
    }
}

RT_ALWAYS_INLINE void convex_closest(ShapeQuery *q, uint32_t index, const Ray *object, SideLeft left, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    RayInterval interval;
    if (primitive_intervals(primitive, object, left, &interval) == 0) {
        return;
    }
    bool is_start = left.side != SIDE_NONE;
    double passed = is_start ? -1.0 : passed_error(q, primitive);
    const PrimitiveInterval own = {index, interval, interval.leave - interval.enter, false, is_start};
    interval_offer(q, object, &own, passed, first);
}

// ---- a mesh: the face with the least t, and of those the first, is offered, if the ray has not passed it; for a
// shadow whichever comes first

// How far a face may be behind the limit at which it still counts, see MESH_ERROR_MOST.
#define MESH_BEYOND (1.0 + 2.0 * MESH_ERROR_MOST)

// The faces of a mesh on a ray's way.
typedef struct MeshWay {
    const PreparedPrimitive *primitive;
    Ray object;
    MeshQuery query;
    double enter;    // of the mesh's box
    bool has_passed; // what lies within rounding of the ray's start
} MeshWay;

static bool face_is_passed(ShapeQuery *q, const MeshWay *way, double t, uint32_t face)
{
    return way->has_passed && !(t > MESH_ERROR_MOST * t + start_error(q)) &&
           is_passed(t, mesh_crossing_error(way->primitive, q->ray, &way->object, t, face), start_error(q));
}

static void face_found(ShapeQuery *q, const MeshWay *way, double t, uint32_t face, Foremost *first)
{
    const PreparedPrimitive *primitive = way->primitive;
    ShapeId shape = shape_id(SHAPE_FACE, primitive->mesh.first_face + face);
    double most = MESH_ERROR_MOST * t;
    bool is_first = span_is_first(t, most, way->enter, first);
    if (is_first && q->is_any) {
        first->hit.shape = shape;
    } else if (is_first) {
        bool leaves = mesh_is_left(primitive, q->ray, &way->object, face);
        span_take(q, primitive, (Hit){t, shape, leaves != primitive->flips}, most, way->enter, first);
    } else {
        span_refine(q, first);
        double error = mesh_crossing_error(primitive, q->ray, &way->object, t, face);
        face_offer(q->table, shape, q->ray, t, crossing_span(t, error, way->enter), first);
    }
}

static __attribute__((noinline)) void mesh_closest(ShapeQuery *q, uint32_t index, Foremost *first)
{
    MeshWay way;
    const PreparedPrimitive *primitive = way.primitive = &q->table->primitives[index];
    const MeshTable *table = primitive->mesh.table;
    uint32_t left = q->start.shape != SHAPE_NONE && shape_kind(q->start.shape) == SHAPE_FACE
                        ? shape_index(q->start.shape) - primitive->mesh.first_face
                        : MESH_NO_FACE;
    BvhWalk walk;
    BvhChild leaf;
    if (!item_enters(q, &way.enter) || way.enter > first->limit) {
        return;
    }
    way.object = primitive_ray(primitive, q->ray);
    way.has_passed = starts_beside(q->table, q->start, primitive);
    mesh_query_make(&way.query, &way.object);
    const MeshQuery *query = &way.query;
    double nearest = first->limit * query->length * MESH_BEYOND;
    uint32_t found = MESH_NO_FACE;
    if (!bvh_walk_start(&walk, &table->tree, query->ray.origin, query->ray.direction)) {
        return;
    }
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest), &leaf)) {
        uint32_t begin = bvh_leaf_first(leaf), end = begin + bvh_leaf_count(leaf);
        for (uint32_t i = begin; i < end; i++) {
            MeshPoint at;
            uint32_t face = table->faces[i];
            if (!mesh_ray_crosses(&query->shear, table->mesh, face, &at) || !(at.t > 0.0) || face == left ||
                !(at.t < nearest || (at.t == nearest && face < found)) || !mesh_shows(table, &query->ray, at.t, face) ||
                face_is_passed(q, &way, at.t / query->length, face)) {
                continue;
            }
            if (q->is_any) {
                face_found(q, &way, at.t / query->length, face, first);
                if (first->hit.shape != SHAPE_NONE) {
                    return;
                }
                continue;
            }
            nearest = at.t;
            found = face;
        }
    }
    if (found != MESH_NO_FACE) {
        face_found(q, &way, nearest / query->length, found, first);
    }
}

// ---- any primitive

// A primitive alone. Outward from itself, one that is convex or flat is not met again.
static void primitive_closest(ShapeQuery *q, uint32_t index, Foremost *first)
{
    const PreparedPrimitive *primitive = &q->table->primitives[index];
    if (primitive->hidden & q->start.use) {
        return;
    }
    if (RT_UNLIKELY(primitive_is_mesh(primitive))) {
        mesh_closest(q, index, first);
        return;
    }
    bool is_start = q->left && primitive_equal(q->left, primitive);
    bool inward = is_start && q->start.inward != q->left->flips; // of the body, whose twin may be inverse
    if (is_start && ((!inward && primitive_is_convex(primitive)) || primitive_is_flat(primitive))) {
        return;
    }
    if (primitive->kind == PRIMITIVE_SPHERE) {
        (is_start ? ball_closest_inward : ball_closest)(q, index, first);
        return;
    }
    Ray object = primitive_ray(primitive, q->ray);
    if (!is_start && primitive_is_curve(primitive) && curve_closest(q, index, &object, first)) {
        return;
    }
    span_refine(q, first);
    if (primitive_is_flat(primitive)) {
        flat_closest(q, index, &object, first);
    } else {
        SideLeft left = {is_start ? primitive_side(q->start.shape) : SIDE_NONE, inward};
        if (RT_LIKELY(primitive_is_convex(primitive))) {
            convex_closest(q, index, &object, left, first);
        } else {
            several_closest(q, index, &object, left, first);
        }
    }
}

// The items of a cluster, in its own tree. Whoever is asked later has the query as it was.
static void cluster_closest(ShapeQuery *q, const ShapeCluster *cluster, Foremost *first);

static void item_closest(ShapeQuery *q, ShapeItem item, Foremost *first)
{
    const ShapeTable *table = q->table;
    uint32_t index = item_index(item);
    double enter;
    if (index < table->primitive_count) {
        primitive_closest(q, index, first);
    } else if (shapes_are_abandoned(table)) {
        return; // one ray may cross 10^5 primitives
    } else if (RT_UNLIKELY(index - table->primitive_count >= table->csg_count)) {
        cluster_closest(q, &table->clusters[index - table->primitive_count - table->csg_count], first);
    } else if (item_enters(q, &enter) && enter <= first->limit) {
        span_refine(q, first);
        const CsgRay asked = {q->ray, q->start, start_error(q), enter};
        csg_closest(table, &table->csg_trees[index - table->primitive_count], &asked, first);
    }
}

static __attribute__((noinline)) void cluster_closest(ShapeQuery *q, const ShapeCluster *cluster, Foremost *first)
{
    BvhWalk walk;
    BvhChild leaf;
    const ItemBox *box = q->box;
    BoxLine line = q->line;
    if (!bvh_walk_start(&walk, &cluster->tree, q->ray->origin, q->ray->direction)) {
        return;
    }
    q->tree = &cluster->tree;
    q->line.is_set = false;
    while (!(q->is_any && first->hit.shape != SHAPE_NONE) &&
           bvh_walk_next(&walk, bvh_walk_limit(&walk, first->limit), &leaf)) {
        uint32_t at = bvh_leaf_first(leaf);
        q->box = &cluster->boxes[at];
        item_closest(q, cluster->items[at], first);
    }
    q->tree = &q->table->tree;
    q->box = box;
    q->line = line;
}

// Leaves of the tree that the rays of a tile may meet, in nodes of their own, near ones first.
enum { SHAPE_BEAM_NODES = 32 };
typedef struct ShapeBeam {
    uint32_t count, node_count;
    BvhNode nodes[SHAPE_BEAM_NODES];
} ShapeBeam;

// All items, or, where there is a beam, those without a test in lanes: of those of the tree the beam's.
// A leaf is looked into up to the limit, where rounding cannot tell whether what it holds is the first.
static void table_closest(ShapeQuery *q, const ShapeBeam *beam, Foremost *first)
{
    const ShapeTable *table = q->table;
    BvhWalk walk;
    BvhChild leaf;
    for (uint32_t i = 0; i < table->unbounded_count; i++) {
        if ((beam && (table->items[i] & ITEM_LANES)) || i == q->known) {
            continue;
        }
        q->at = i;
        item_closest(q, table->items[i], first);
        if (q->is_any && first->hit.shape != SHAPE_NONE) {
            return;
        }
    }
    if (table->bounded_count == 1 && q->known != table->unbounded_count) { // its box is asked anyway
        q->at = table->unbounded_count;
        q->box = table->boxes;
        item_closest(q, table->items[q->at], first);
        return;
    }
    if (table->bounded_count <= 1 || !bvh_walk_start(&walk, &table->tree, q->ray->origin, q->ray->direction)) {
        return;
    }
    if (beam) {
        walk.nodes = beam->nodes;
        for (walk.waiting = 0; walk.waiting < beam->node_count; walk.waiting++) {
            walk.stack[walk.waiting] = beam->node_count - 1 - walk.waiting; // the nearest last; no distance is known
        }
    }
    const ShapeItem *bounded = table->items + table->unbounded_count;
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, first->limit), &leaf)) {
        uint32_t at = bvh_leaf_first(leaf);
        q->at = table->unbounded_count + at;
        if (q->at == q->known) {
            continue;
        }
        q->box = &table->boxes[at];
        item_closest(q, bounded[at], first);
        if (q->is_any && first->hit.shape != SHAPE_NONE) {
            return;
        }
    }
}

// ---- the whole

static void query_start(ShapeQuery *q, const ShapeTable *table, const Ray *ray, RayStart start, double start_error,
                        bool is_any)
{
    q->table = table;
    q->ray = ray;
    q->start = start;
    q->start_error = start_error;
    q->left = starts_on_primitive(start) ? table_primitive(table, start.shape) : NULL;
    q->is_any = is_any;
    q->known = NO_BLOCKER;
    q->bounded = NULL;
    q->box = NULL;
    q->tree = &table->tree;
    q->line.is_set = false;
}

static void shapes_closest(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, Foremost *first)
{
    ShapeQuery q; // its line is not cleared
    query_start(&q, table, ray, start, start_error, false);
    table_closest(&q, NULL, first);
}

static bool shapes_occluded(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, double t_max,
                            uint32_t *blocker)
{
    ShapeQuery q;
    query_start(&q, table, ray, start, start_error, true);
    q.known = *blocker;
    Foremost first = foremost_start(&(Hit){t_max, SHAPE_NONE, false}, 0, t_max);
    table_closest(&q, NULL, &first);
    *blocker = first.hit.shape != SHAPE_NONE ? q.at : *blocker;
    return first.hit.shape != SHAPE_NONE;
}

static bool shape_blocks(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, double t_max,
                         uint32_t blocker)
{
    ShapeQuery q;
    query_start(&q, table, ray, start, start_error, true);
    Foremost first = foremost_start(&(Hit){t_max, SHAPE_NONE, false}, 0, t_max);
    q.box = blocker < table->unbounded_count ? NULL : &table->boxes[blocker - table->unbounded_count];
    item_closest(&q, table->items[blocker], &first);
    return first.hit.shape != SHAPE_NONE;
}

#endif
