// Queries over parts that stand alone and composites: part of spheres_kernel.c. The tree of their boxes is walked near
// child first.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_WALK_H
#define TRACE_SHAPES_WALK_H

#include "trace/bvh_walk.h"
#include "trace/shapes.h"

// What a ray asks of all shapes.
typedef struct ShapeQuery {
    const ShapeTable *table;
    const Ray *ray;
    RayStart start;
    double start_error;
    const Solid *left; // that it starts on; NULL for none
    bool is_any;       // whatever is met before the end of the way will do
    const Solid *bounded; // the ball that is nearest, where its hit's error is only bounded; NULL: no such
} ShapeQuery;

// What a ray starts on has been passed up to the error of the start and the root's own, where they may coincide: how
// much of that is the start's. Less than 0 where nothing has been passed.
static double passed_error(const ShapeQuery *q, const Solid *solid)
{
    return starts_beside(q->table, q->start, solid) ? q->start_error : -1.0;
}

static bool is_passed(double t, double error, double passed)
{
    return passed >= 0.0 && !(t > error + passed);
}

static void flat_closest(const ShapeQuery *q, uint32_t index, const Ray *object, Nearest *nearest)
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
    double passed = passed_error(q, solid);
    if (verdict == SPHERE_DOUBTFUL) {
        t = sphere_exact(&ray, &unit, NULL, &leaves);
        if (t > 0.0) {
            ball_offer(q, index, &object, &ray, t, leaves, passed, nearest);
        }
        return;
    }
    double bound = 2.0 * fabs(t + vec3_dot(ray.origin, ray.dual)) + 0x1p-10 * t;
    if (t - bound > nearest->hit.t + nearest->error) {
        return;
    }
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

static void chord_closest(const ShapeQuery *q, uint32_t index, const Ray *object, bool is_start, Nearest *nearest)
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
        assembly_closest(table, &table->assemblies[item - table->solid_count], q->ray, q->start, q->start_error, nearest);
    }
}

// A leaf that begins within rounding of the nearest hit is still looked into, since ties are decided by order of
// declaration.
static void table_closest(ShapeQuery *q, Nearest *nearest)
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
    const ShapeItem *bounded = table->items + table->unbounded_count;
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest->hit.t + nearest->error), &leaf)) {
        item_closest(q, bounded[bvh_leaf_first(leaf)], nearest);
        if (q->is_any && nearest->hit.shape != SHAPE_NONE) {
            return;
        }
    }
}

static const Solid *solid_left(const ShapeTable *table, RayStart start)
{
    return starts_on_part(start) ? &table->solids[part_index(start.shape)] : NULL;
}

static void shapes_closest(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, Nearest *nearest)
{
    ShapeQuery q = {table, ray, start, start_error, solid_left(table, start), false, NULL};
    table_closest(&q, nearest);
}

static bool shapes_occluded(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, double t_max)
{
    ShapeQuery q = {table, ray, start, start_error, solid_left(table, start), true, NULL};
    Nearest nearest = {.hit = {.t = t_max, .shape = SHAPE_NONE}, .error = way_end_error(t_max)};
    table_closest(&q, &nearest);
    return nearest.hit.shape != SHAPE_NONE;
}

#endif
