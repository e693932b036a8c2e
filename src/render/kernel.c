// The instances of the inner loop, and the choice among them.
//
// SPDX-License-Identifier: MIT
#include "render/kernel.h"

#include "render/camera.h"
#include "render/prepared.h"
#include "render/shade.h"

_Static_assert((int)KERNEL_RAYS == (int)TILE_RAYS && (int)KERNEL_ROW == (int)TILE_ROW, "a call is a tile of rays");

// Returns the places at which the camera sees anything, a bit for each.
RT_ALWAYS_INLINE uint64_t places_closest(const Prepared *p, unsigned features, const KernelPlaces *places, Ray *rays, Hit *hits)
{
    const PreparedCamera *camera = &p->camera;
    if (camera->type == CAMERA_PERSPECTIVE) {
        TileView view = {camera->location, camera->direction, camera->right, camera->up};
        geometry_closest_view(p->geometry, features, &view, places->u, places->v, rays, hits);
        return UINT64_MAX;
    }
    uint64_t seen = 0;
    for (int i = 0; i < TILE_RAYS; i++) {
        seen |= (uint64_t)camera_ray(camera, places->u[i], places->v[i], &rays[i]) << i;
    }
    geometry_closest_tile(p->geometry, features, rays, hits);
    return seen;
}

RT_ALWAYS_INLINE void trace_places(const Prepared *p, unsigned features, const KernelPlaces *places,
                                   SampleStream *streams, uint64_t wanted, Rgb *light, RenderStatistics *statistics)
{
    Ray rays[TILE_RAYS];
    Hit hits[TILE_RAYS];
    RenderStatistics counted = *statistics;
    uint64_t seen = places_closest(p, features, places, rays, hits);
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

// What a kernel may contain: geometry in four steps, shading in four. The product is the list of kernels.
#define GEOMETRY_FEW TRACE_SPHERES
#define GEOMETRY_FEW_PLANES (TRACE_SPHERES | TRACE_PLANES)
#define GEOMETRY_MANY (TRACE_SPHERE_BVH | TRACE_PLANES)
#define GEOMETRY_ANY TRACE_ALL_FEATURES
#define SHADING_PLAIN 0
#define SHADING_SHADOWS (RENDER_SHADOWS | RENDER_HIGHLIGHTS)
#define SHADING_MIRRORS (RENDER_SHADOWS | RENDER_HIGHLIGHTS | RENDER_BRILLIANCE | RENDER_REFLECTION)
#define SHADING_ANY (SHADING_MIRRORS | RENDER_TRANSPARENCY)

// X(name, printed name, geometry, shading), from few features to many.
#define KERNELS(X)                                                                                                     \
    X(few_plain, "spheres", GEOMETRY_FEW, SHADING_PLAIN)                                                               \
    X(few_shadows, "spheres+shadows", GEOMETRY_FEW, SHADING_SHADOWS)                                                   \
    X(few_planes_plain, "spheres+planes", GEOMETRY_FEW_PLANES, SHADING_PLAIN)                                          \
    X(few_planes_shadows, "spheres+planes+shadows", GEOMETRY_FEW_PLANES, SHADING_SHADOWS)                              \
    X(many_plain, "tree+planes", GEOMETRY_MANY, SHADING_PLAIN)                                                         \
    X(many_shadows, "tree+planes+shadows", GEOMETRY_MANY, SHADING_SHADOWS)                                             \
    X(few_mirrors, "spheres+shadows+mirrors", GEOMETRY_FEW, SHADING_MIRRORS)                                           \
    X(few_planes_mirrors, "spheres+planes+shadows+mirrors", GEOMETRY_FEW_PLANES, SHADING_MIRRORS)                      \
    X(many_mirrors, "tree+planes+shadows+mirrors", GEOMETRY_MANY, SHADING_MIRRORS)                                     \
    X(few_planes_any, "spheres+planes+shadows+mirrors+transparency", GEOMETRY_FEW_PLANES, SHADING_ANY)                 \
    X(many_any, "tree+planes+shadows+mirrors+transparency", GEOMETRY_MANY, SHADING_ANY)                                \
    X(many_textures, "tree+planes+textures", GEOMETRY_MANY, SHADING_ANY | RENDER_TEXTURES)                             \
    X(many_glass, "tree+planes+textures+glass", GEOMETRY_MANY, SHADING_ANY | RENDER_TEXTURES | RENDER_INTERIORS)       \
    X(many_lights, "tree+planes+lights", GEOMETRY_MANY, SHADING_ANY | RENDER_LIGHTS)                                   \
    X(any_shadows, "all shapes+shadows", GEOMETRY_ANY, SHADING_SHADOWS)                                                \
    X(many_sky, "tree+planes+textures+sky", GEOMETRY_MANY, SHADING_ANY | RENDER_TEXTURES | RENDER_SKY)                 \
    X(many_fog, "tree+planes+textures+glass+fog", GEOMETRY_MANY,                                                       \
      SHADING_ANY | RENDER_TEXTURES | RENDER_INTERIORS | RENDER_FOG)                                                   \
    X(any_any, "everything", GEOMETRY_ANY, SHADING_ANY | RENDER_EXPONENT | RENDER_TEXTURES | RENDER_INTERIORS |        \
                                               RENDER_LIGHTS | RENDER_SKY | RENDER_FOG)

#define DEFINE_KERNEL(name, text, geometry, shading)                                                                   \
    static void trace_##name(const Prepared *p, const KernelPlaces *places, SampleStream *streams, uint64_t wanted,    \
                             Rgb *light, RenderStatistics *statistics)                                                 \
    {                                                                                                                  \
        trace_places(p, (unsigned)(geometry) | (unsigned)(shading), places, streams, wanted, light, statistics);       \
    }
KERNELS(DEFINE_KERNEL)

#define KERNEL_ROW(name, text, geometry, shading) {text, (unsigned)(geometry) | (unsigned)(shading), trace_##name},
static const Kernel kernels[] = {KERNELS(KERNEL_ROW)};

const Kernel *kernel_choose(unsigned features)
{
    const Kernel *best = &kernels[RT_COUNT_OF(kernels) - 1];
    for (size_t i = 0; i < RT_COUNT_OF(kernels); i++) {
        bool covers = (features & ~kernels[i].features) == 0;
        if (covers && __builtin_popcount(kernels[i].features) < __builtin_popcount(best->features)) {
            best = &kernels[i];
        }
    }
    return best;
}
