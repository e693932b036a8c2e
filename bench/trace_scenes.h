// The scenes of trace_rays, for us and for Embree: many shapes of one kind, at random places in a cube of side 2.
//
// SPDX-License-Identifier: MIT
#ifndef BENCH_TRACE_SCENES_H
#define BENCH_TRACE_SCENES_H

#include <stdlib.h>

#include "scene/form.h"
#include "scene/scene.h"
#include "study/optional.h"
#include "unit/random.h"

#ifdef WITH_EMBREE
#include <embree3/rtcore.h>
#endif

typedef enum Kind { SPHERES, CYLINDERS, CONES, BOXES, TRIANGLES, KINDS } Kind;
static const char *const kind_names[KINDS] = {"spheres", "cylinders", "cones", "boxes", "triangles"};

static Vec3 random_vector(Random *random, double most)
{
    return vec3(random_between(random, -most, most), random_between(random, -most, most),
                random_between(random, -most, most));
}

// A shape about as large as a ball of that radius.
static bool add_shape(Scene *scene, Kind kind, Random *random, Vec3 centre, double radius)
{
    Primitive shape = part_empty(0);
    const char *fault = NULL;
    Vec3 half = random_vector(random, radius);
    if (kind == CYLINDERS) {
        fault = primitive_make_cylinder(&shape, vec3_sub(centre, half), vec3_add(centre, half), radius / 4, false);
    } else if (kind == CONES) {
        fault =
            primitive_make_cone(&shape, vec3_sub(centre, half), radius / 2, vec3_add(centre, half), radius / 4, false);
    } else if (kind == BOXES) {
        primitive_make_box(&shape, vec3_sub(centre, half), vec3_add(centre, half));
    } else {
        Vec3 corners[3] = {vec3_add(centre, half)};
        corners[1] = vec3_add(centre, random_vector(random, radius));
        corners[2] = vec3_add(centre, random_vector(random, radius));
        fault = primitive_make_triangle(&shape, corners);
    }
    return !fault && part_finish(&shape) && scene_add_primitive(scene, &shape);
}

static void make_scene(Scene *scene, Kind kind, uint32_t count)
{
    Random random = {1};
    double radius = 0.6 / cbrt(count);
    for (uint32_t i = 0; i < count; i++) {
        Vec3 centre = random_vector(&random, 1);
        centre = count == 1 ? vec3(0, 0, 0) : centre;
        double own = radius * random_between(&random, 0.5, 1);
        if (!(kind == SPHERES ? scene_add_sphere(scene, centre, own, 0, 0)
                              : add_shape(scene, kind, &random, centre, own))) {
            exit(1);
        }
    }
}

#ifdef WITH_EMBREE

static RTCGeometry embree_spheres(RTCDevice device, const Scene *scene)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *spheres = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float),
                                             scene->spheres.count);
    for (size_t i = 0; i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        spheres[4 * i] = (float)sphere->centre.x;
        spheres[4 * i + 1] = (float)sphere->centre.y;
        spheres[4 * i + 2] = (float)sphere->centre.z;
        spheres[4 * i + 3] = (float)sphere->radius;
    }
    return geometry;
}

static void put_corner(float *to, const Primitive *shape, Vec3 place)
{
    Vec3 corner = transform_point(&shape->to_world, place);
    to[0] = (float)corner.x;
    to[1] = (float)corner.y;
    to[2] = (float)corner.z;
}

// A piece from the base to the cap of each.
static RTCGeometry embree_cones(RTCDevice device, const Scene *scene)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE);
    size_t count = scene->primitives.count;
    float *ends =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 2 * count);
    uint32_t *first =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, sizeof(uint32_t), count);
    for (size_t i = 0; i < count; i++) {
        const Primitive *shape = &scene->primitives.items[i];
        const double *across = shape->to_world.m[0];
        double radius = vec3_length(vec3(across[0], across[1], across[2]));
        put_corner(ends + 8 * i, shape, vec3(0, 0, 0));
        put_corner(ends + 8 * i + 4, shape, vec3(0, 0, 1));
        ends[8 * i + 3] = (float)radius;
        ends[8 * i + 7] = (float)(radius * shape->data[0].x);
        first[i] = (uint32_t)(2 * i);
    }
    return geometry;
}

static RTCGeometry embree_triangles(RTCDevice device, const Scene *scene, bool are_boxes)
{
    // Of a box corner b is at the high end of axis a where bit a of b is set.
    static const uint32_t box[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                        {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    size_t count = scene->primitives.count, faces = are_boxes ? 12 : 1, corners = are_boxes ? 8 : 3;
    float *places = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                            corners * count);
    uint32_t *numbers = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), faces * count);
    for (size_t i = 0; i < count; i++) {
        const Primitive *shape = &scene->primitives.items[i];
        for (size_t k = 0; k < corners; k++) {
            const Vec3 *ends = shape->data;
            Vec3 of_box = vec3(ends[k & 1].x, ends[k >> 1 & 1].y, ends[k >> 2 & 1].z);
            put_corner(places + 3 * (corners * i + k), shape, are_boxes ? of_box : vec3(k == 1, k == 2, 0));
        }
        for (size_t k = 0; k < 3 * faces; k++) {
            numbers[3 * faces * i + k] = (uint32_t)(corners * i) + (are_boxes ? box[k / 3][k % 3] : (uint32_t)k);
        }
    }
    return geometry;
}

static RTCScene embree_build(RTCDevice device, const Scene *scene, Kind kind)
{
    RTCScene out = rtcNewScene(device);
    RTCGeometry geometry = kind == SPHERES                      ? embree_spheres(device, scene)
                           : kind == CYLINDERS || kind == CONES ? embree_cones(device, scene)
                                                                : embree_triangles(device, scene, kind == BOXES);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(out, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(out);
    return out;
}

#endif

#endif
