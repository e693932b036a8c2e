// Queries over parts that stand alone and composites; the tree of their boxes is walked near child first.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes.h"

#include "trace/bvh_walk.h"

void solid_offer(const ShapeTable *table, uint32_t index, const Ray *ray, double t, double error, uint8_t side,
                 bool leaves, Nearest *nearest)
{
    const Solid *solid = &table->solids[index];
    if (!(t > 0.0 && t - error <= nearest->hit.t + nearest->error)) {
        return;
    }
    bool inside = leaves != solid->flips;
    if (solid_is_flat(solid)) {
        Vec3 point, normal;
        solid_surface(solid, ray, t, side, &point, &normal);
        inside = vec3_dot(normal, ray->direction) > 0.0;
    }
    nearest_offer_within(nearest, t, error, part_shape(index, side), inside, solid->order);
}

double shapes_start_error(const ShapeTable *table, const Ray *ray, RayStart start)
{
    const Solid *solid = &table->solids[part_index(start.shape)];
    Ray object = solid_ray(solid, ray);
    return solid_crossing_error(solid, ray, &object, 0.0, part_side(start.shape));
}

static bool starts_on(const ShapeTable *table, RayStart start, const Solid *solid)
{
    return starts_on_part(start) && solid_equal(&table->solids[part_index(start.shape)], solid);
}

// `begin`: a root that is not beyond this and its own error has been passed.
static void flat_closest(const ShapeTable *table, uint32_t index, const Ray *ray, const Ray *object, double begin,
                         Nearest *nearest)
{
    const Solid *solid = &table->solids[index];
    double t;
    if (!solid_flat_root(solid, object, &t) || !(t > 0.0)) {
        return;
    }
    double error = solid_crossing_error(solid, ray, object, t, 0);
    if (begin < 0.0 || t > error + begin) {
        solid_offer(table, index, ray, t, error, 0, false, nearest);
    }
}

// A solid alone. Outward from itself, it is not met again: all are convex or flat.
static void solid_closest(const ShapeTable *table, uint32_t index, const Ray *ray, RayStart start, double start_error,
                          Nearest *nearest)
{
    const Solid *solid = &table->solids[index];
    if (solid->hidden & start.use) {
        return;
    }
    bool is_start = starts_on(table, start, solid);
    bool inward = start.inward != solid->flips;
    if (is_start && (!inward || solid_is_flat(solid))) {
        return;
    }
    Ray object = solid_ray(solid, ray);
    double begin = !is_start && starts_beside(table, start, solid) ? start_error : -1.0;
    if (solid_is_flat(solid)) {
        flat_closest(table, index, ray, &object, begin, nearest);
        return;
    }
    Chord chord;
    if (!solid_chord(solid, &object, is_start ? part_side(start.shape) : SIDE_NONE, &chord)) {
        return;
    }
    bool is_open = solid->flags & PART_OPEN;
    if (!is_start && chord.enter > 0.0 && !(is_open && chord.enter_side != 0)) {
        double error = solid_chord_error(solid, ray, &object, &chord, false);
        if (begin < 0.0 || chord.enter > error + begin) {
            solid_offer(table, index, ray, chord.enter, error, chord.enter_side, false, nearest);
            return;
        }
    }
    if (chord.leave > 0.0 && !(is_open && chord.leave_side != 0)) {
        double error = solid_chord_error(solid, ray, &object, &chord, true);
        if (begin < 0.0 || chord.leave > error + begin) {
            solid_offer(table, index, ray, chord.leave, error, chord.leave_side, true, nearest);
        }
    }
}

static void item_closest(const ShapeTable *table, ShapeItem item, const Ray *ray, RayStart start, double start_error,
                         Nearest *nearest)
{
    if (item < table->solid_count) {
        solid_closest(table, item, ray, start, start_error, nearest);
    } else {
        assembly_closest(table, &table->assemblies[item - table->solid_count], ray, start, start_error, nearest);
    }
}

// A leaf that begins within rounding of the nearest hit is still looked into, since ties are decided by order of
// declaration.
static void table_closest(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, bool any,
                          Nearest *nearest)
{
    BvhWalk walk;
    BvhChild leaf;
    for (uint32_t i = 0; i < table->unbounded_count; i++) {
        item_closest(table, table->items[i], ray, start, start_error, nearest);
        if (any && nearest->hit.shape != SHAPE_NONE) {
            return;
        }
    }
    if (table->bounded_count == 0 || !bvh_walk_start(&walk, &table->tree, ray->origin, ray->direction)) {
        return;
    }
    const ShapeItem *bounded = table->items + table->unbounded_count;
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest->hit.t + nearest->error), &leaf)) {
        uint32_t first = bvh_leaf_first(leaf);
        for (uint32_t i = first; i < first + bvh_leaf_count(leaf); i++) {
            item_closest(table, bounded[i], ray, start, start_error, nearest);
            if (any && nearest->hit.shape != SHAPE_NONE) {
                return;
            }
        }
    }
}

void shapes_closest(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, Nearest *nearest)
{
    table_closest(table, ray, start, start_error, false, nearest);
}

bool shapes_occluded(const ShapeTable *table, const Ray *ray, RayStart start, double start_error, double t_max)
{
    Nearest nearest = {.hit = {.t = t_max, .shape = SHAPE_NONE}, .error = way_end_error(t_max)};
    table_closest(table, ray, start, start_error, true, &nearest);
    return nearest.hit.shape != SHAPE_NONE;
}

Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit)
{
    const Solid *solid = &table->solids[part_index(hit->shape)];
    Surface surface = {.material = solid->material, .order = solid->order, .body = solid->body};
    solid_surface(solid, ray, hit->t, part_side(hit->shape), &surface.point, &surface.normal);
    if (solid->flips) {
        surface.normal = vec3_neg(surface.normal);
    }
    return surface;
}
