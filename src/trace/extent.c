// How far single shapes reach, whether a line crosses one, and which shape a camera ray meets first.
//
// Serves those who look at shapes from outside (render/sample/sampling_small.c). Knows nothing of pixels.
//
// SPDX-License-Identifier: MIT
#include "trace/extent.h"

#include <math.h>

#include "trace/query_surface.h"

uint32_t extent_count(const Geometry *g)
{
    return g->spheres.block_count * SPHERE_BLOCK + g->shapes.primitive_count;
}

static bool primitive_extent_of(const PreparedPrimitive *primitive, Extent *extent)
{
    Vec3 axes[3], middle = {0.0, 0.0, 0.0};
    if (prepared_is_endless(primitive) || primitive->composite != NODE_NONE || (primitive->flags & PRIMITIVE_INVERSE) ||
        (primitive->hidden & HIDDEN_CAMERA) || primitive_is_mesh(primitive)) {
        return false;
    }
    prepared_classes[primitive->kind].axes(primitive, axes, &middle);
    extent->centre = vec3_add(primitive->centre, linear_direction(&primitive->to_world, middle));
    for (int i = 0; i < 3; i++) {
        extent->axes[i] = linear_direction(&primitive->to_world, axes[i]);
    }
    return true;
}

bool extent_get(const Geometry *g, uint32_t i, Extent *extent)
{
    uint32_t slots = g->spheres.block_count * SPHERE_BLOCK;
    if (i >= slots) {
        extent->is_ball = false;
        extent->shape = shape_id(SHAPE_PRIMITIVE, (i - slots) << PRIMITIVE_SIDE_BITS);
        extent->material = g->shapes.primitives[i - slots].material;
        return primitive_extent_of(&g->shapes.primitives[i - slots], extent);
    }
    SphereData ball = sphere_table_ball(&g->spheres, i);
    double radius = sqrt(ball.radius_squared);
    *extent = (Extent){.shape = shape_id(SHAPE_SPHERE, i),
                       .is_ball = true,
                       .material = g->spheres.info[i].material,
                       .centre = ball.centre,
                       .axes = {vec3(radius, 0.0, 0.0), vec3(0.0, radius, 0.0), vec3(0.0, 0.0, radius)}};
    return radius >= 0.0; // not NaN, of an empty slot
}

uint32_t extent_place(const Geometry *g, ShapeId shape)
{
    bool is_part = shape_is_on_primitive(shape);
    return is_part ? g->spheres.block_count * SPHERE_BLOCK + table_primitive_index(&g->shapes, shape)
                   : shape_index(shape);
}

void extent_of(const Geometry *g, ShapeId shape, Extent *extent)
{
    (void)extent_get(g, extent_place(g, shape), extent);
}

bool extent_is_crossed(const Geometry *g, ShapeId shape, Ray ray)
{
    if (shape_kind(shape) == SHAPE_SPHERE) {
        SphereData ball = sphere_table_ball(&g->spheres, shape_index(shape));
        Vec3 offset = vec3_sub(ball.centre, ray.origin);
        return vec3_length_squared(vec3_cross(offset, ray.direction)) <= ball.radius_squared &&
               vec3_dot(offset, ray.direction) > 0.0;
    }
    const PreparedPrimitive *primitive = table_primitive(&g->shapes, shape);
    Ray object = primitive_ray(primitive, &ray);
    double t;
    if (primitive_is_mesh(primitive)) {
        return mesh_is_crossed(primitive, &object);
    }
    if (primitive_is_flat(primitive)) {
        return primitive_flat_root(primitive, &object, &t) && t > 0.0;
    }
    RayInterval intervals[primitive->interval_most];
    unsigned count = primitive_intervals(primitive, &object, LEFT_NONE, intervals);
    return count > 0 && intervals[count - 1].leave > 0.0;
}

bool extent_plane(const Geometry *g, uint32_t number, ShapeId *shape, Vec3 *point, Vec3 *normal,
                  MaterialIndex *material)
{
    if (number >= g->plane_count) {
        return false;
    }
    const PlaneEntry *plane = &g->planes[number];
    *shape = shape_id(SHAPE_PLANE, number);
    *normal = plane->shape.normal;
    *point = vec3_scale(plane->shape.distance, plane->shape.normal);
    *material = plane->info.material;
    return true;
}

bool extent_is_dark(const Geometry *g, ShapeId shape, const Vec3 *normal, Ray ray, double distance)
{
    RayStart start = {shape, normal && vec3_dot(*normal, ray.direction) < 0.0, HIDDEN_SHADOW};
    return geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, distance);
}

static bool is_same(const Geometry *g, ShapeId a, ShapeId b)
{
    bool is_part = shape_is_on_primitive(a) && shape_is_on_primitive(b);
    return is_part ? table_primitive_index(&g->shapes, a) == table_primitive_index(&g->shapes, b) : a == b;
}

bool extent_first(const Geometry *g, Ray ray, Hit *hit, Surface *surface)
{
    if (!geometry_closest(g, TRACE_ALL_FEATURES, ray, RAY_START_CAMERA, (double)INFINITY, hit)) {
        return false;
    }
    *surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, *hit);
    return true;
}

ExtentSight extent_sight(const Geometry *g, ShapeId shape, Ray ray, MaterialIndex *before)
{
    Hit hit;
    Surface surface;
    if (!extent_first(g, ray, &hit, &surface)) {
        return EXTENT_MISSED;
    }
    *before = surface.material;
    return is_same(g, hit.shape, shape) ? EXTENT_SEEN : EXTENT_BEHIND;
}
