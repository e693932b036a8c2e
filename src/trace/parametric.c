// The line is asked as it is, and again for the normal: pieces of a surface are not kept in hits.
//
// SPDX-License-Identifier: MIT
#include "trace/parametric.h"

static bool is_abandoned(const void *client)
{
    return trace_is_abandoned(client);
}

static ParametricLine line_of(const PreparedPrimitive *primitive, const Ray *object)
{
    const IsosurfaceWorld *world = primitive->isosurface.world;
    return (ParametricLine){.list = primitive->isosurface.list,
                            .host = primitive->isosurface.host,
                            .ray = *object,
                            .length =
                                world->scale * vec3_length(linear_direction(&primitive->to_world, object->direction)),
                            .is_over = world->abandon ? is_abandoned : NULL,
                            .client = world->abandon};
}

unsigned parametric_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                              RayInterval *intervals)
{
    ParametricLine line = line_of(primitive, object);
    ParametricHit hit;
    (void)left; // it does not find what it starts on
    if (!parametric_find(&line, &hit)) {
        return 0;
    }
    intervals[0] = (RayInterval){hit.t, hit.t, PARAMETRIC_SIDE, PARAMETRIC_SIDE};
    return 1;
}

Vec3 parametric_met(const PreparedPrimitive *primitive, const Ray *object, double t)
{
    ParametricLine line = line_of(primitive, object);
    ParametricHit hit;
    Vec3 across = {0.0, 0.0, 0.0};
    if (parametric_find(&line, &hit) || parametric_find_at(&line, t, &hit)) {
        across = parametric_across(line.list, line.host, hit.u, hit.v);
    }
    double size = vec3_max_abs(across);
    return size > 0.0 ? vec3_scale(ldexp(1.0, -ilogb(size)), across) : vec3_scale(-1.0, object->direction);
}

void parametric_uv(const PreparedPrimitive *primitive, Vec3 point, Vec3 direction, double uv[2])
{
    Ray ray = {point, direction}, object = primitive_ray(primitive, &ray);
    ParametricLine line = line_of(primitive, &object);
    ParametricHit hit = {0.0, 0.0, 0.0};
    (void)parametric_find_at(&line, 0.0, &hit);
    uv[0] = hit.u;
    uv[1] = hit.v;
}
