// Queries over parts that stand alone and composites; the tree of their boxes is walked near child first.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes.h"

#include "trace/bvh_walk.h"

void solid_offer(const ShapeTable *table, uint32_t index, const Ray *ray, double t, uint8_t side, bool leaves,
                 Nearest *nearest)
{
    const Solid *solid = &table->solids[index];
    if (!(t > 0.0 && t <= nearest->hit.t)) {
        return;
    }
    bool inside = leaves != solid->flips;
    if (solid_is_flat(solid)) {
        Vec3 point, normal;
        solid_surface(solid, ray, t, side, &point, &normal);
        inside = vec3_dot(normal, ray->direction) > 0.0;
    }
    nearest_offer(nearest, t, part_shape(index, side), inside, solid->order);
}

static bool starts_on(const ShapeTable *table, RayStart start, const Solid *solid)
{
    return starts_on_part(start) && solid_equal(&table->solids[part_index(start.shape)], solid);
}

// A solid alone. Outward from itself, it is not met again: all are convex or flat.
static void solid_closest(const ShapeTable *table, uint32_t index, const Ray *ray, RayStart start, Nearest *nearest)
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
    if (solid_is_flat(solid)) {
        double t;
        if (solid_flat_root(solid, &object, &t)) {
            solid_offer(table, index, ray, t, 0, false, nearest);
        }
        return;
    }
    Chord chord;
    if (!solid_chord(solid, &object, is_start ? part_side(start.shape) : SIDE_NONE, &chord)) {
        return;
    }
    bool is_open = solid->flags & PART_OPEN;
    if (!is_start && chord.enter > 0.0 && !(is_open && chord.enter_side != 0)) {
        solid_offer(table, index, ray, chord.enter, chord.enter_side, false, nearest);
    } else if (!(is_open && chord.leave_side != 0)) {
        solid_offer(table, index, ray, chord.leave, chord.leave_side, true, nearest);
    }
}

static void item_closest(const ShapeTable *table, ShapeItem item, const Ray *ray, RayStart start, Nearest *nearest)
{
    if (item < table->solid_count) {
        solid_closest(table, item, ray, start, nearest);
    } else {
        assembly_closest(table, &table->assemblies[item - table->solid_count], ray, start, nearest);
    }
}

// A leaf that begins exactly at the nearest hit is still looked into, since ties are decided by order of declaration.
static void table_closest(const ShapeTable *table, const Ray *ray, RayStart start, bool any, Nearest *nearest)
{
    BvhWalk walk;
    BvhChild leaf;
    for (uint32_t i = 0; i < table->unbounded_count; i++) {
        item_closest(table, table->items[i], ray, start, nearest);
        if (any && nearest->hit.shape != SHAPE_NONE) {
            return;
        }
    }
    if (table->bounded_count == 0 || !bvh_walk_start(&walk, &table->tree, ray->origin, ray->direction)) {
        return;
    }
    const ShapeItem *bounded = table->items + table->unbounded_count;
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest->hit.t), &leaf)) {
        uint32_t first = bvh_leaf_first(leaf);
        for (uint32_t i = first; i < first + bvh_leaf_count(leaf); i++) {
            item_closest(table, bounded[i], ray, start, nearest);
            if (any && nearest->hit.shape != SHAPE_NONE) {
                return;
            }
        }
    }
}

void shapes_closest(const ShapeTable *table, const Ray *ray, RayStart start, Nearest *nearest)
{
    table_closest(table, ray, start, false, nearest);
}

bool shapes_occluded(const ShapeTable *table, const Ray *ray, RayStart start, double t_max)
{
    Nearest nearest = {.hit = {.t = t_max, .shape = SHAPE_NONE}};
    table_closest(table, ray, start, true, &nearest);
    return nearest.hit.shape != SHAPE_NONE;
}

Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit)
{
    const Solid *solid = &table->solids[part_index(hit->shape)];
    Surface surface = {.material = solid->material, .order = solid->order};
    solid_surface(solid, ray, hit->t, part_side(hit->shape), &surface.point, &surface.normal);
    if (solid->flips) {
        surface.normal = vec3_neg(surface.normal);
    }
    return surface;
}
