// What an instance of the inner loop is made of: included by each kernel_*.c, which lists the instances it holds. They
// stand in several files only because each takes seconds to compile.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_KERNEL_INSTANCE_H
#define RENDER_KERNEL_INSTANCE_H

#include "render/camera.h"
#include "render/kernels.h"
#include "render/prepared.h"
#include "render/shade_tile.h"

_Static_assert((int)KERNEL_RAYS == (int)TILE_RAYS && (int)KERNEL_ROW == (int)TILE_ROW, "a call is a tile of rays");

// The rays of the camera; returns the places at which it sees anything, a bit for each.
RT_ALWAYS_INLINE uint64_t places_rays(const Prepared *p, const KernelPlaces *places, Ray rays[TILE_RAYS])
{
    uint64_t seen = 0;
    for (int i = 0; i < TILE_RAYS; i++) {
        if (places->lens) {
            rays[i] = camera_lens_ray(&p->camera, places->u[i], places->v[i], places->lens[i]);
            seen |= UINT64_C(1) << i;
            continue;
        }
        seen |= (uint64_t)camera_ray(&p->camera, places->u[i], places->v[i], &rays[i]) << i;
    }
    return seen;
}

// The same with what they hit.
RT_ALWAYS_INLINE uint64_t places_closest(const Prepared *p, unsigned features, const TileView *view,
                                         const KernelPlaces *places, Ray rays[TILE_RAYS], Hit hits[TILE_RAYS])
{
    if (!view) {
        uint64_t seen = places_rays(p, places, rays);
        geometry_closest_tile(p->geometry, features, rays, hits);
        return seen;
    }
    SphereTile tile;
    TileHits found;
    geometry_closest_view(p->geometry, features, view, places->u, places->v, &tile, &found);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        SphereRay ray = sphere_tile_ray(&tile, i);
        rays[i] = (Ray){ray.origin, ray.direction};
        hits[i] = (Hit){found.t[i], found.shape[i], found.inside >> i & 1};
    }
    return UINT64_MAX;
}

RT_ALWAYS_INLINE void trace_places(const Prepared *p, unsigned features, const KernelPlaces *places,
                                   SampleStream *streams, uint64_t wanted, Rgb *light, RenderStatistics *statistics)
{
    Ray rays[TILE_RAYS];
    Hit hits[TILE_RAYS];
    const PreparedCamera *camera = &p->camera;
    TileView view = {camera->location, camera->direction, camera->right, camera->up};
    bool has_view = camera->type == CAMERA_PERSPECTIVE && !places->lens;
    if (!(features & ~(unsigned)SHADE_TILE_FEATURES) && has_view) {
        shade_tile(p, features, &view, places, streams, wanted, light, statistics);
        return;
    }
    RenderStatistics counted = *statistics;
    uint64_t seen = places_closest(p, features, has_view ? &view : NULL, places, rays, hits);
    for (uint64_t unseen = wanted & ~seen; unseen; unseen &= unseen - 1) {
        light[__builtin_ctzll(unseen)] = rgb_grey(0.0);
        counted.camera_rays++;
    }
    wanted &= seen;
    for (; wanted; wanted &= wanted - 1) {
        int i = __builtin_ctzll(wanted);
        light[i] = shade_ray(p, features, rays[i], &hits[i], streams ? &streams[i] : NULL, &counted);
        counted.camera_rays++;
    }
    *statistics = counted;
}

// What a kernel may contain: geometry in four steps, shading in four. The kernels are the useful pairs.
#define GEOMETRY_FEW TRACE_SPHERES
#define GEOMETRY_FEW_PLANES (TRACE_SPHERES | TRACE_PLANES)
#define GEOMETRY_MANY (TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_PLANES)
#define GEOMETRY_ANY TRACE_ALL_FEATURES
#define SHADING_PLAIN 0
#define SHADING_SHADOWS (RENDER_SHADOWS | RENDER_HIGHLIGHTS)
#define SHADING_MIRRORS (RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE | RENDER_REFLECTION)
#define SHADING_ANY (SHADING_MIRRORS | RENDER_TRANSPARENCY)

#define DEFINE_KERNEL(name, text, geometry, shading)                                                                   \
    static void trace_##name(const Prepared *p, const KernelPlaces *places, SampleStream *streams, uint64_t wanted,    \
                             Rgb *light, RenderStatistics *statistics)                                                 \
    {                                                                                                                  \
        trace_places(p, (unsigned)(geometry) | (unsigned)(shading), places, streams, wanted, light, statistics);       \
    }
#define LIST_KERNEL(name, text, geometry, shading) {text, (unsigned)(geometry) | (unsigned)(shading), trace_##name},

// Defines the kernels of a list X(name, printed name, geometry, shading), and the list that kernels.h declares.
#define DEFINE_KERNELS(list, KERNELS)                                                                                  \
    KERNELS(DEFINE_KERNEL)                                                                                             \
    static const Kernel rows[] = {KERNELS(LIST_KERNEL)};                                                               \
    const KernelList list = {rows, sizeof rows / sizeof rows[0]};

#endif
