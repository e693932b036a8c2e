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

uint32_t table_face_solid(const ShapeTable *table, ShapeId face)
{
    uint32_t low = 0, high = table->mesh_solid_count, index = shape_index(face);
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(table->solids[table->mesh_solids[middle]].mesh.first_face <= index ? &low : &high) = middle;
    }
    return table->mesh_solids[low];
}

void face_offer(const ShapeTable *table, ShapeId shape, const Ray *ray, double t, RootSpan span, Foremost *first)
{
    if (!(t > 0.0 && t < (double)INFINITY && foremost_admits(first, span))) {
        return;
    }
    const Solid *solid = table_solid(table, shape);
    Vec3 point, normal;
    mesh_surface(solid, ray, shape_index(shape) - solid->mesh.first_face, &point, &normal);
    bool inside = (vec3_dot(normal, ray->direction) > 0.0) != solid->flips;
    foremost_offer(first, t, span, shape, inside, solid->order);
}

MaterialIndex shapes_material(const ShapeTable *table, ShapeId shape)
{
    const Solid *solid = table_solid(table, shape);
    return solid_is_mesh(solid) ? mesh_material(solid, shape_index(shape) - solid->mesh.first_face) : solid->material;
}

double shapes_error(const ShapeTable *table, const Ray *ray, const Ray *object, double t, ShapeId shape)
{
    const Solid *solid = table_solid(table, shape);
    return solid_is_mesh(solid)
               ? mesh_crossing_error(solid, ray, object, t, shape_index(shape) - solid->mesh.first_face)
               : solid_crossing_error(solid, ray, object, t, part_side(shape));
}

double shapes_start_error(const ShapeTable *table, const Ray *ray, RayStart start)
{
    Ray object = solid_ray(table_solid(table, start.shape), ray);
    return shapes_error(table, ray, &object, 0.0, start.shape);
}

Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit)
{
    const Solid *solid = table_solid(table, hit->shape);
    Surface surface = {.material = solid->material, .order = solid->order, .body = solid->body};
    if (solid_is_mesh(solid)) {
        uint32_t face = shape_index(hit->shape) - solid->mesh.first_face;
        surface.material = mesh_material(solid, face);
        mesh_surface(solid, ray, face, &surface.point, &surface.normal);
    } else {
        solid_surface(solid, ray, hit->t, part_side(hit->shape), &surface.point, &surface.normal);
        bool leaves = hit->inside != solid->flips;
        if ((solid->traits & SOLID_TURNS) && (vec3_dot(surface.normal, ray->direction) > 0.0) != leaves) {
            surface.normal = vec3_neg(surface.normal);
        }
    }
    if (solid->flips) {
        surface.normal = vec3_neg(surface.normal);
    }
    return surface;
}
