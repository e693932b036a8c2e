// What an instance of the inner loop is made of: included by each kernel_*.c, which lists the instances it holds. They
// stand in several files only because each takes seconds to compile.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_KERNEL_INSTANCE_H
#define RENDER_KERNEL_INSTANCE_H

#include "render/kernels.h"
#include "render/records/camera.h"
#include "render/records/prepared.h"
#include "render/sample/scratch.h"
#include "render/shade/shade_tile_paths.h"
#include "render/tile_first.h"

_Static_assert((int)KERNEL_RAYS == (int)TILE_RAYS && (int)KERNEL_ROW == (int)TILE_ROW, "a call is a tile of rays");

// The rays of a view, ray by ray but for what they hit, and for the first surfaces that are plain.
RT_ALWAYS_INLINE void trace_view(const Prepared *p, unsigned features, ShadePath path, const TileView *view,
                                 const KernelCall *call)
{
    SphereTile *tile = &call->scratch->tile.rays;
    TileHits found;
    geometry_closest_view(p->geometry, features, view, call->places->u, call->places->v, tile, &found);
    for (uint64_t left = tile_first(p, &found, call); left; left &= left - 1) {
        unsigned i = (unsigned)__builtin_ctzll(left);
        SphereRay ray = sphere_tile_ray(tile, i);
        Hit hit = {found.t[i], found.shape[i], found.inside >> i & 1};
        const CameraRay own = {{ray.origin, ray.direction}, &hit, call->streams ? &call->streams[i] : NULL};
        call->light[i] = shade_ray(p, features, path, &own, &call->scratch->rays, call->statistics);
    }
}

// Rays of other cameras, each by itself.
RT_ALWAYS_INLINE void trace_single(const Prepared *p, unsigned features, ShadePath path, const KernelCall *call)
{
    for (uint64_t left = call->wanted; left; left &= left - 1) {
        int i = __builtin_ctzll(left);
        CameraRay own = {.stream = call->streams ? &call->streams[i] : NULL};
        bool is_seen = camera_place_ray(&p->camera, call->places, i, &own.ray);
        call->light[i] = rgb_grey(0.0);
        if (is_seen) {
            call->light[i] = shade_ray(p, features, path, &own, &call->scratch->rays, call->statistics);
        }
    }
}

RT_ALWAYS_INLINE void trace_places(const Prepared *p, unsigned features, ShadePath path, const KernelCall *asked)
{
    const PreparedCamera *camera = &p->camera;
    TileView view = {camera->location, camera->direction, camera->right, camera->up};
    RenderStatistics counted = *asked->statistics;
    KernelCall call = *asked;
    call.statistics = &counted;
    counted.camera_rays += (uint64_t)__builtin_popcountll(call.wanted);
    bool is_view = camera->type == CAMERA_PERSPECTIVE && !call.places->lens;
    if (shade_tile_may(p, features)) {
        TileShading shading; // not cleared as a whole
        shading.scratch = &call.scratch->tile;
        shading.streams = call.streams;
        shading.light = call.light;
        shading.statistics = &counted;
        shade_tile(p, features, is_view ? &view : NULL, call.places, call.wanted, &shading);
    } else if (is_view) {
        trace_view(p, features, path, &view, &call);
    } else {
        trace_single(p, features, path, &call);
    }
    *asked->statistics = counted;
}

// What a kernel may contain. Measured by instructions, only opaque against clear matters among the kernels of tiles (times
// 1.5); all other features that a scene lacks cost it less than a twentieth together.
#define GEOMETRY_SMALL   (TRACE_SPHERES | TRACE_PLANES)
#define GEOMETRY_BVH     (TRACE_SPHERE_BVH | TRACE_PLANES)
#define GEOMETRY_SPHERES (TRACE_SPHERES | TRACE_SPHERE_BVH | TRACE_PLANES)
#define SHADING_OPAQUE                                                                                                 \
    (RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE | RENDER_REFLECTION | RENDER_PIGMENTS | RENDER_LIGHTS)
#define SHADING_CLEAR (SHADING_OPAQUE | RENDER_TRANSPARENCY)

#define DEFINE_KERNEL(name, text, geometry, shading)                                                                   \
    static __attribute__((noinline)) Rgb path_##name(const Prepared *p, RayStack *stack, SampleStream *stream,         \
                                                     RenderStatistics *statistics)                                     \
    {                                                                                                                  \
        return shade_stack(p, (unsigned)(geometry) | (unsigned)(shading), stack, stream, statistics);                  \
    }                                                                                                                  \
    static void trace_##name(const Prepared *p, const KernelCall *call)                                                \
    {                                                                                                                  \
        trace_places(p, (unsigned)(geometry) | (unsigned)(shading), path_##name, call);                                \
    }
#define LIST_KERNEL(name, text, geometry, shading) {text, (unsigned)(geometry) | (unsigned)(shading), trace_##name},

// Defines the kernels of a list X(name, printed name, geometry, shading), and the list that kernels.h declares.
#define DEFINE_KERNELS(list, KERNELS)                                                                                  \
    KERNELS(DEFINE_KERNEL)                                                                                             \
    static const Kernel rows[] = {KERNELS(LIST_KERNEL)};                                                               \
    const KernelList list = {rows, RT_COUNT_OF(rows)};

#endif
