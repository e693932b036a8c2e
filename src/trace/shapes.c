// What parts and composites answer whichever instruction set the tree of them is walked with.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes.h"

void solid_offer(const ShapeTable *table, uint32_t index, const Ray *ray, double t, RootSpan span, uint8_t side,
                 bool leaves, Foremost *first)
{
    const Solid *solid = &table->solids[index];
    if (!(t > 0.0 && t < (double)INFINITY && foremost_admits(first, span))) {
        return;
    }
    bool inside = leaves != solid->flips;
    if (solid_is_flat(solid)) {
        Vec3 point, normal;
        solid_surface(solid, ray, t, side, &point, &normal);
        inside = vec3_dot(normal, ray->direction) > 0.0;
    }
    foremost_offer(first, t, span, part_shape(index, side), inside, solid->order);
}

double shapes_start_error(const ShapeTable *table, const Ray *ray, RayStart start)
{
    const Solid *solid = &table->solids[part_index(start.shape)];
    Ray object = solid_ray(solid, ray);
    return solid_crossing_error(solid, ray, &object, 0.0, part_side(start.shape));
}

Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit)
{
    const Solid *solid = &table->solids[part_index(hit->shape)];
    Surface surface = {.material = solid->material, .order = solid->order, .body = solid->body};
    solid_surface(solid, ray, hit->t, part_side(hit->shape), &surface.point, &surface.normal);
    bool leaves = hit->inside != solid->flips;
    if ((solid->traits & SOLID_TURNS) && (vec3_dot(surface.normal, ray->direction) > 0.0) != leaves) {
        surface.normal = vec3_neg(surface.normal);
    }
    if (solid->flips) {
        surface.normal = vec3_neg(surface.normal);
    }
    return surface;
}
