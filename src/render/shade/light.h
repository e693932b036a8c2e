// Lights that are more than a point: how strong they are at a place, and where the lights of an area stand.
//
// Turns a prepared light and a point into a share of its light and into the places of shadow rays. Knows neither
// surfaces nor rays. The formulas of strength and of the disc are those of the manual or were found by pictures; see
// docs/language.md, "Lighting model".
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_LIGHT_H
#define RENDER_SHADE_LIGHT_H

#include <stdint.h>
#include <string.h>

#include "base/attributes.h"
#include "math/extreme.h"
#include "render/points/sampler.h"
#include "render/records/prepared.h"
#include "render/shade/power.h"

// From 0 at `none` to 1 at `full` and beyond, smooth at both ends.
RT_ALWAYS_INLINE double light_rise(double at, double none, double full)
{
    double x = (at - none) / (full - none);
    return x * x * (3.0 - 2.0 * x);
}

// A spotlight by the cosine of the angle to its axis.
RT_ALWAYS_INLINE double light_spot(const PreparedLight *light, double cosine)
{
    if (!(cosine > 0.0)) {
        return 0.0;
    }
    double core = light->tightness != 0.0 ? shade_power(cosine, light->tightness) : 1.0;
    return cosine > light->radius    ? core
           : cosine > light->falloff ? core * light_rise(cosine, light->falloff, light->radius)
                                     : 0.0;
}

// A cylinder of light by the distances from its axis and along it.
RT_ALWAYS_INLINE double light_cylinder(const PreparedLight *light, double across, double along)
{
    if (!(along > 0.0) || !(across < light->falloff)) {
        return 0.0;
    }
    double core = light->tightness != 0.0 ? shade_power(1.0 - across / light->falloff, light->tightness) : 1.0;
    return across > light->radius ? core * light_rise(across, light->falloff, light->radius) : core;
}

// What the light's colour is multiplied with at a point from which it is `offset` away, at `distance` along its rays.
RT_ALWAYS_INLINE double light_strength(const PreparedLight *light, Vec3 offset, double distance)
{
    double strength = 1.0;
    if (light->type == LIGHT_SPOT) {
        strength = light_spot(light, vec3_dot(offset, light->towards) / distance);
    } else if (light->type == LIGHT_CYLINDER) {
        strength = light_cylinder(light, vec3_length(vec3_sub(offset, vec3_scale(distance, light->towards))), distance);
    }
    if (light->fade_power > 0.0) {
        strength *= 2.0 / (1.0 + shade_power(fabs(distance) / light->fade_distance, light->fade_power));
    }
    return strength;
}

// ---- area lights

// splitmix64: G. Steele et al., "Fast splittable pseudorandom number generators", OOPSLA 2014.
RT_ALWAYS_INLINE uint64_t light_mix(uint64_t state)
{
    state += UINT64_C(0x9e3779b97f4a7c15);
    state = (state ^ (state >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    state = (state ^ (state >> 27)) * UINT64_C(0x94d049bb133111eb);
    return state ^ (state >> 31);
}

// A number in [-1/2, 1/2).
RT_ALWAYS_INLINE double light_random(uint64_t state)
{
    return (double)(light_mix(state) >> 11) * 0x1p-53 - 0.5;
}

// What a point of prepared space, and so the pixel it is seen in, is to `jitter`: the same for any number of threads.
RT_ALWAYS_INLINE uint64_t light_key(const PreparedLight *light, Vec3 point, int i, int j)
{
    uint64_t bits[3];
    memcpy(bits, (double[]){point.x, point.y, point.z}, sizeof bits);
    uint64_t key = light_mix(light->seed ^ (light->number << 42 | (uint64_t)i << 21 | (uint64_t)j));
    for (int axis = 0; axis < 3; axis++) {
        key = light_mix(key ^ bits[axis]);
    }
    return key;
}

// The axes of an area that faces a point: one lies across z, or across y where the point is nearly along z. Measured.
RT_ALWAYS_INLINE void light_area_face(const PreparedLight *light, Vec3 point, Vec3 *axis1, Vec3 *axis2)
{
    Vec3 away = vec3_normalize(vec3_sub(point, light->position));
    bool is_along = 1.0 - fabs(away.z) < 0.01;
    Vec3 across = vec3_normalize(vec3_cross(vec3(0.0, is_along ? 1.0 : 0.0, is_along ? 0.0 : 1.0), away));
    double length = vec3_length(light->area.axis1);
    *axis1 = vec3_scale(length, across);
    *axis2 = vec3_scale(length, vec3_cross(across, away));
}

// A place of an area from its middle; u and v along its axes, from -1/2 to 1/2. The square is turned into a disc by
// moving each light along its ray from the middle until it has the distance that the side of its square has.
RT_ALWAYS_INLINE Vec3 light_area_place(const PreparedLight *light, Vec3 point, double u, double v)
{
    const LightArea *area = &light->area;
    Vec3 axis1 = area->axis1, axis2 = area->axis2;
    const double aside = 0.001; // of the square's side: POV-Ray's disc is not quite in the middle; measured
    if (area->circular) {
        u += aside;
        v += aside;
    }
    if (area->circular && (u != 0.0 || v != 0.0)) {
        double side = greater_of(fabs(u), fabs(v));
        double shrink = side / sqrt(u * u + v * v);
        u *= shrink;
        v *= shrink;
    }
    if (area->is_oriented) {
        light_area_face(light, point, &axis1, &axis2);
    }
    return vec3_add(vec3_scale(u, axis1), vec3_scale(v, axis2));
}

// Where light (i, j) of an area stands.
RT_ALWAYS_INLINE Vec3 light_area_offset(const PreparedLight *light, Vec3 point, int i, int j)
{
    const LightArea *area = &light->area;
    double u = area->size1 > 1 ? (double)i / (area->size1 - 1) - 0.5 : 0.0;
    double v = area->size2 > 1 ? (double)j / (area->size2 - 1) - 0.5 : 0.0;
    if (area->jitter) {
        uint64_t key = light_key(light, point, i, j);
        u += area->size1 > 1 ? light_random(key) / (area->size1 - 1) : 0.0;
        v += area->size2 > 1 ? light_random(~key) / (area->size2 - 1) : 0.0;
    }
    return light_area_place(light, point, u, v);
}

// One of a row's lights, each as often as it counts in the whole grid, which is halved until no light is between its
// ends; with `jitter`, a place within half a step of it. Rises with `at`, which is below 1.
RT_ALWAYS_INLINE double light_row_sample(int size, bool jitter, double at)
{
    int low = 0;
    if (size == 1) {
        return 0.0;
    }
    for (int span = size - 1; span > 0; span /= 2) {
        bool is_upper = at >= 0.5;
        low += is_upper ? span - span / 2 : 0;
        at = 2.0 * at - is_upper;
    }
    return (low + (jitter ? at - 0.5 : 0.0)) / (size - 1) - 0.5;
}

// One of an area's lights by chance, for a point; what it lets see is in the mean what the grid, not adaptive, lets see.
RT_ALWAYS_INLINE Vec3 light_area_sample(const PreparedLight *light, Vec3 point, SamplePoint at)
{
    const LightArea *area = &light->area;
    return light_area_place(light, point, light_row_sample(area->size1, area->jitter, at.x),
                            light_row_sample(area->size2, area->jitter, at.y));
}

#endif
