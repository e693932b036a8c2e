// Queries over parts that stand alone and composites: part of spheres_kernel.c. The tree of their boxes is walked near
// child first.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_WALK_H
#define TRACE_SHAPES_WALK_H

#include "trace/bvh_walk.h"
#include "trace/cone_test.h"
#include "trace/shapes.h"

// What a ray asks of all shapes.
typedef struct ShapeQuery {
    const ShapeTable *table;
    const Ray *ray;
    RayStart start;
    double start_error; // less than 0: not asked for yet
    const Solid *left; // that it starts on; NULL for none
    bool is_any;       // whatever is met before the end of the way will do
    const Solid *bounded; // the ball that is nearest, where its hit's error is only bounded; NULL: no such
} ShapeQuery;

// Most rays meet nothing that it matters for.
static double start_error(ShapeQuery *q)
{
    if (q->start_error < 0.0) {
        q->start_error = shapes_start_error(q->table, q->ray, q->start);
    }
    return q->start_error;
}

// What a ray starts on has been passed up to the error of the start and the root's own, where they may coincide: how
// much of that is the start's. Less than 0 where nothing has been passed.
static double passed_error(ShapeQuery *q, const Solid *solid)
{
    return starts_beside(q->table, q->start, solid) ? start_error(q) : -1.0;
}

static bool is_passed(double t, double error, double passed)
{
    return passed >= 0.0 && !(t > error + passed);
}

static void flat_closest(ShapeQuery *q, uint32_t index, const Ray *object, Nearest *nearest)
{
    const Solid *solid = &q->table->solids[index];
    double t;
    if (!solid_flat_root(solid, object, &t) || !(t > 0.0)) {
        return;
    }
    double error = solid_crossing_error(solid, q->ray, object, t, 0);
    if (!is_passed(t, error, passed_error(q, solid))) {
        solid_offer(q->table, index, q->ray, t, error, 0, false, nearest);
    }
}

// The error of a nearest hit of which only a bound is known.
static void settle_error(ShapeQuery *q, Nearest *nearest)
{
    if (q->bounded) {
        Ray object = solid_ray(q->bounded, q->ray);
        nearest->error = solid_ball_error(q->bounded, q->ray, &object, nearest->hit.t);
        q->bounded = NULL;
    }
}

// A root of a ball, which it may be that the ray has passed: then the other root.
static void ball_offer(ShapeQuery *q, uint32_t index, const Ray *object, const SphereRay *ray, double t, bool leaves,
                       double passed, Nearest *nearest)
{
    const Solid *solid = &q->table->solids[index];
    const Ball unit = UNIT_BALL;
    settle_error(q, nearest);
    double error = solid_ball_error(solid, q->ray, object, t);
    if (is_passed(t, error, passed)) {
        t = leaves ? 0.0 : sphere_root_inward(ray, &unit);
        error = solid_ball_error(solid, q->ray, object, t);
        leaves = true;
        if (is_passed(t, error, passed)) {
            return;
        }
    }
    solid_offer(q->table, index, q->ray, t, error, 0, leaves, nearest);
}

// The rules for spheres (trace/sphere.h) in the ball's own space: the class is certain and the root right to an ulp, for
// the ray as it is rounded there. No error is greater than the chord is long, and a root of sphere_test has 13 bits:
// nearly always that is enough.
static void ball_closest(ShapeQuery *q, uint32_t index, Nearest *nearest)
{
    const Solid *solid = &q->table->solids[index];
    const Ball unit = UNIT_BALL;
    Ray object = solid_ray(solid, q->ray);
    SphereRay ray = sphere_ray_make(object.origin, object.direction);
    bool leaves;
    double t;
    SphereVerdict verdict = sphere_test(&ray, &unit, &t, &leaves);
    if (verdict == SPHERE_MISS) {
        return;
    }
    if (verdict == SPHERE_DOUBTFUL) {
        t = sphere_exact(&ray, &unit, NULL, &leaves);
        if (t > 0.0) {
            ball_offer(q, index, &object, &ray, t, leaves, passed_error(q, solid), nearest);
        }
        return;
    }
    double bound = 2.0 * fabs(t + vec3_dot(ray.origin, ray.dual)) + 0x1p-10 * t;
    if (t - bound > nearest->hit.t + nearest->error) {
        return;
    }
    double passed = passed_error(q, solid);
    bool is_nearest = t + bound < nearest->hit.t - nearest->error && !is_passed(t, bound, passed);
    t = is_nearest && q->is_any ? t : sphere_refine(&ray, &unit, t);
    if (is_nearest) {
        *nearest = (Nearest){{t, part_shape(index, 0), leaves != solid->flips}, solid->order, false, bound};
        q->bounded = solid;
    } else {
        ball_offer(q, index, &object, &ray, t, leaves, passed, nearest);
    }
}

// A ball that the ray goes into where it starts.
static void ball_closest_inward(ShapeQuery *q, uint32_t index, Nearest *nearest)
{
    const Ball unit = UNIT_BALL;
    Ray object = solid_ray(&q->table->solids[index], q->ray);
    SphereRay ray = sphere_ray_make(object.origin, object.direction);
    double t = sphere_root_inward(&ray, &unit);
    if (t > 0.0) {
        ball_offer(q, index, &object, &ray, t, true, -1.0, nearest);
    }
}

static void chord_closest(ShapeQuery *q, uint32_t index, const Ray *object, bool is_start, Nearest *nearest)
{
    const Solid *solid = &q->table->solids[index];
    Chord chord;
    if (!solid_chord(solid, object, is_start ? part_side(q->start.shape) : SIDE_NONE, &chord)) {
        return;
    }
    double passed = is_start ? -1.0 : passed_error(q, solid);
    bool is_open = solid->flags & PART_OPEN;
    if (!is_start && chord.enter > 0.0 && !(is_open && chord.enter_side != 0)) {
        double error = solid_chord_error(solid, q->ray, object, &chord, false);
        if (!is_passed(chord.enter, error, passed)) {
            solid_offer(q->table, index, q->ray, chord.enter, error, chord.enter_side, false, nearest);
            return;
        }
    }
    if (chord.leave > 0.0 && !(is_open && chord.leave_side != 0)) {
        double error = solid_chord_error(solid, q->ray, object, &chord, true);
        if (!is_passed(chord.leave, error, passed)) {
            solid_offer(q->table, index, q->ray, chord.leave, error, chord.leave_side, true, nearest);
        }
    }
}

// A solid alone. Outward from itself, it is not met again: all are convex or flat.
static void solid_closest(ShapeQuery *q, uint32_t index, Nearest *nearest)
{
    const Solid *solid = &q->table->solids[index];
    if (solid->hidden & q->start.use) {
        return;
    }
    bool is_start = q->left && solid_equal(q->left, solid);
    bool inward = q->start.inward != solid->flips;
    if (is_start && (!inward || solid_is_flat(solid))) {
        return;
    }
    if (solid->kind == PART_BALL) {
        (is_start ? ball_closest_inward : ball_closest)(q, index, nearest);
        return;
    }
    Ray object = solid_ray(solid, q->ray);
    settle_error(q, nearest);
    if (solid_is_flat(solid)) {
        flat_closest(q, index, &object, nearest);
    } else {
        chord_closest(q, index, &object, is_start, nearest);
    }
}

static void item_closest(ShapeQuery *q, ShapeItem item, Nearest *nearest)
{
    const ShapeTable *table = q->table;
    if (item < table->solid_count) {
        solid_closest(q, item, nearest);
    } else {
        settle_error(q, nearest);
        assembly_closest(table, &table->assemblies[item - table->solid_count], q->ray, q->start, start_error(q),
                         nearest);
    }
}

// A leaf that begins within rounding of the nearest hit is still looked into, since ties are decided by order of
// declaration.
static void table_closest(ShapeQuery *q, const ShapeBeam *beam, Nearest *nearest)
{
    const ShapeTable *table = q->table;
    BvhWalk walk;
    BvhChild leaf;
    for (uint32_t i = 0; i < table->unbounded_count; i++) {
        item_closest(q, table->items[i], nearest);
        if (q->is_any && nearest->hit.shape != SHAPE_NONE) {
            return;
        }
    }
    if (table->bounded_count == 0 || !bvh_walk_start(&walk, &table->tree, q->ray->origin, q->ray->direction)) {
        return;
    }
    if (beam) {
        walk.nodes = beam->nodes;
        for (walk.waiting = 0; walk.waiting < beam->node_count; walk.waiting++) {
            walk.stack[walk.waiting] = beam->node_count - 1 - walk.waiting; // the nearest last; no distance is known
        }
    }
    const ShapeItem *bounded = table->items + table->unbounded_count;
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest->hit.t + nearest->error), &leaf)) {
        item_closest(q, bounded[bvh_leaf_first(leaf)], nearest);
        if (q->is_any && nearest->hit.shape != SHAPE_NONE) {
            return;
        }
    }
}

// ---- what the rays of a tile may meet

static bool beam_add(ShapeBeam *beam, const BvhNode *from, unsigned child)
{
    unsigned at = beam->count % BVH_WIDTH;
    if (at == 0) {
        if (beam->node_count == SHAPE_BEAM_NODES) {
            return false;
        }
        bvh_node_clear(&beam->nodes[beam->node_count++]);
    }
    BvhNode *node = &beam->nodes[beam->node_count - 1];
    for (int axis = 0; axis < 3; axis++) {
        node->box[axis][0][at] = from->box[axis][0][child];
        node->box[axis][1][at] = from->box[axis][1][child];
    }
    node->child[at] = from->child[child];
    node->present |= 1u << at;
    beam->count++;
    return true;
}

// The leaves of one walk, those of near nodes first.
static bool beam_gather(ShapeBeam *beam, BvhWalk *walk)
{
    while (walk->waiting > 0) {
        const BvhNode *node = &walk->nodes[(BvhChild)walk->stack[--walk->waiting]];
        _Alignas(64) float enters[BVH_WIDTH];
        if (walk->waiting > BVH_STACK - BVH_WIDTH) {
            return false;
        }
        for (unsigned met = bvh_walk_boxes(walk, node, INFINITY, enters); met; met &= met - 1) {
            unsigned i = (unsigned)__builtin_ctz(met);
            if (!(node->child[i] & BVH_LEAF)) {
                bvh_walk_push(walk, 0, bvh_walk_key(enters[i], node->child[i]));
            } else if (!beam_add(beam, node, i)) {
                return false;
            }
        }
    }
    return true;
}

static bool shapes_gather(const ShapeTable *table, const SphereTile *tile, ShapeBeam *beam)
{
    DirectionRange range;
    beam->count = beam->node_count = 0;
    if (table->tree.node_count <= 1) {
        return false;
    }
    direction_range(tile->direction, TILE_RAYS, &range);
    for (unsigned octant = 0; octant < OCTANTS && direction_range_is_narrow(&range); octant++) {
        BvhWalk walk;
        Vec3 least, greatest;
        bool is_too_far;
        if (!direction_octant(&range, octant, &least, &greatest)) {
            continue;
        }
        if (bvh_walk_start_beam(&walk, &table->tree, tile->origin, 0.0, least, greatest, &is_too_far)
                ? !beam_gather(beam, &walk)
                : is_too_far) {
            return false;
        }
    }
    return direction_range_is_narrow(&range);
}

// ---- the whole

static const Solid *solid_left(const ShapeTable *table, RayStart start)
{
    return starts_on_part(start) ? &table->solids[part_index(start.shape)] : NULL;
}

static void shapes_closest(const ShapeTable *table, const ShapeBeam *beam, const Ray *ray, RayStart start,
                           double start_error, Nearest *nearest)
{
    ShapeQuery q = {table, ray, start, start_error, solid_left(table, start), false, NULL};
    table_closest(&q, beam, nearest);
}

static bool shapes_occluded(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, double t_max)
{
    ShapeQuery q = {table, ray, start, start_error, solid_left(table, start), true, NULL};
    Nearest nearest = {.hit = {.t = t_max, .shape = SHAPE_NONE}, .error = way_end_error(t_max)};
    table_closest(&q, NULL, &nearest);
    return nearest.hit.shape != SHAPE_NONE;
}

#endif
