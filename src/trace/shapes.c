// What primitives and composites answer whichever instruction set the tree of them is walked with.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes.h"

void primitive_offer(const ShapeTable *table, const Ray *ray, const PrimitiveRoot *root, RootSpan span, Foremost *first)
{
    const PreparedPrimitive *primitive = &table->primitives[root->index];
    double t = root->t;
    if (!(t > 0.0 && t < (double)INFINITY && foremost_admits(first, span))) {
        return;
    }
    bool inside = root->leaves != primitive->flips;
    if (primitive->traits & TRAIT_SHEET) {
        Vec3 point, normal;
        primitive_surface(primitive, ray, t, root->side, &point, &normal);
        inside = vec3_dot(normal, ray->direction) > 0.0;
    }
    foremost_offer(first, t, span, primitive_shape(root->index, root->side), inside, primitive->order);
}

uint32_t table_face_primitive(const ShapeTable *table, ShapeId face)
{
    uint32_t low = 0, high = table->mesh_solid_count, index = shape_index(face);
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(table->primitives[table->mesh_solids[middle]].mesh.first_face <= index ? &low : &high) = middle;
    }
    return table->mesh_solids[low];
}

void face_offer(const ShapeTable *table, ShapeId shape, const Ray *ray, double t, RootSpan span, Foremost *first)
{
    if (!(t > 0.0 && t < (double)INFINITY && foremost_admits(first, span))) {
        return;
    }
    const PreparedPrimitive *primitive = table_primitive(table, shape);
    Vec3 point, normal;
    mesh_surface(primitive, ray, shape_index(shape) - primitive->mesh.first_face, &point, &normal);
    bool inside = (vec3_dot(normal, ray->direction) > 0.0) != primitive->flips;
    foremost_offer(first, t, span, shape, inside, primitive->order);
}

MaterialIndex shapes_material(const ShapeTable *table, ShapeId shape)
{
    const PreparedPrimitive *primitive = table_primitive(table, shape);
    return primitive_is_mesh(primitive) ? mesh_material(primitive, shape_index(shape) - primitive->mesh.first_face)
                                        : primitive->material;
}

double shapes_error(const ShapeTable *table, const Ray *ray, const Ray *object, double t, ShapeId shape)
{
    const PreparedPrimitive *primitive = table_primitive(table, shape);
    return primitive_is_mesh(primitive)
               ? mesh_crossing_error(primitive, ray, object, t, shape_index(shape) - primitive->mesh.first_face)
               : primitive_crossing_error(primitive, ray, object, t, primitive_side(shape));
}

double shapes_start_error(const ShapeTable *table, const Ray *ray, RayStart start)
{
    Ray object = primitive_ray(table_primitive(table, start.shape), ray);
    return shapes_error(table, ray, &object, 0.0, start.shape);
}

Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit)
{
    const PreparedPrimitive *primitive = table_primitive(table, hit->shape);
    Surface surface = {.material = primitive->material, .order = primitive->order, .body = primitive->body};
    if (primitive_is_mesh(primitive)) {
        uint32_t face = shape_index(hit->shape) - primitive->mesh.first_face;
        surface.material = mesh_material(primitive, face);
        mesh_surface(primitive, ray, face, &surface.point, &surface.normal);
    } else {
        primitive_surface(primitive, ray, hit->t, primitive_side(hit->shape), &surface.point, &surface.normal);
        bool leaves = hit->inside != primitive->flips;
        if ((primitive->traits & TRAIT_TURNS) && (vec3_dot(surface.normal, ray->direction) > 0.0) != leaves) {
            surface.normal = vec3_neg(surface.normal);
        }
    }
    if (primitive->flips) {
        surface.normal = vec3_neg(surface.normal);
    }
    return surface;
}
