// A scene's spheres as their table wants them: scaled, and with what a hit leads to.
//
// For those who make the table (trace/spheres.c) and who bring it up to date (trace/spheres_refit.c), which so give the
// same bits.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERE_RECORDS_H
#define TRACE_SPHERE_RECORDS_H

#include <math.h>

#include "trace/spheres.h"

enum { SPHERES_AHEAD = 24 }; // that are asked for before they are needed

typedef struct SphereRecords {
    const Scene *scene;
    double scale[2]; // lengths are multiplied by both
} SphereRecords;

// In two steps, each of which is in range for any exponent that a double can have.
static inline SphereRecords sphere_records(const Scene *scene, int exponent)
{
    return (SphereRecords){scene, {ldexp(1.0, -(exponent / 2)), ldexp(1.0, -(exponent - exponent / 2))}};
}

static inline double sphere_records_length(const SphereRecords *records, double length)
{
    return length * records->scale[0] * records->scale[1];
}

static inline SphereData sphere_records_ball(const SphereRecords *records, size_t number)
{
    const Sphere *sphere = &records->scene->spheres.items[number];
    Vec3 c = sphere->centre;
    return sphere_data_make(vec3(sphere_records_length(records, c.x), sphere_records_length(records, c.y),
                                 sphere_records_length(records, c.z)),
                            sphere_records_length(records, sphere->radius));
}

static inline ShapeInfo sphere_records_info(const SphereRecords *records, uint32_t number)
{
    const Scene *scene = records->scene;
    const SphereRun *first = scene->sphere_runs.items;
    uint32_t order = scene->sphere_runs.count == 1 ? first->order + number : scene_sphere_order(scene, number);
    return (ShapeInfo){scene->spheres.items[number].material, order};
}

// The other way round.
static inline uint32_t sphere_records_number(const SphereRecords *records, uint32_t order)
{
    const Scene *scene = records->scene;
    const SphereRun *first = scene->sphere_runs.items;
    return scene->sphere_runs.count == 1 ? order - first->order : scene_sphere_at(scene, order);
}

// Asks for a sphere before it is needed.
static inline void sphere_records_fetch(const SphereRecords *records, uint32_t number)
{
    const Sphere *sphere = &records->scene->spheres.items[number];
    __builtin_prefetch(sphere);
    __builtin_prefetch((const char *)(sphere + 1) - 1); // it may lie across two lines
}

static inline void sphere_block_put(SphereBlock *block, uint32_t at, const SphereData *ball)
{
    block->x[at] = ball->centre.x;
    block->y[at] = ball->centre.y;
    block->z[at] = ball->centre.z;
    block->radius_squared[at] = ball->radius_squared;
}

// How far few spheres reach, and the least of them.
void sphere_table_measure(SphereTable *table);

#endif
