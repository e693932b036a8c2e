// The instances of the inner loop, and the choice among them.
//
// SPDX-License-Identifier: MIT
#include "render/kernel.h"

#include "render/camera.h"
#include "render/prepared.h"
#include "render/shade.h"

enum { BEAM = TILE_ROW }; // camera rays of BEAM x BEAM pixels are traced together

// Where the pixels of a beam are on the screen, as camera_ray wants to know it; where the beam is cut off, its last ones
// stand for the missing ones.
typedef struct BeamPlaces {
    _Alignas(64) double u[TILE_RAYS];
    double v[TILE_RAYS];
} BeamPlaces;

RT_ALWAYS_INLINE void beam_places(Tile tile, const Film *film, BeamPlaces *places)
{
    double across[BEAM], down[BEAM];
    for (int i = 0; i < BEAM; i++) {
        int x = tile.left + i < tile.right ? tile.left + i : tile.right - 1;
        int y = tile.top + i < tile.bottom ? tile.top + i : tile.bottom - 1;
        across[i] = (x + 0.5) / film->width - 0.5;
        down[i] = (y + 0.5) / film->height - 0.5;
    }
    for (int i = 0; i < TILE_RAYS; i++) {
        places->u[i] = across[i % BEAM];
        places->v[i] = down[i / BEAM];
    }
}

RT_ALWAYS_INLINE void beam_closest(const Prepared *p, unsigned features, const BeamPlaces *places, Ray rays[TILE_RAYS],
                                   Hit hits[TILE_RAYS])
{
    const PreparedCamera *camera = &p->camera;
    if (camera->type == CAMERA_PERSPECTIVE) {
        TileView view = {camera->location, camera->direction, camera->right, camera->up};
        geometry_closest_view(p->geometry, features, &view, places->u, places->v, rays, hits);
        return;
    }
    for (int i = 0; i < TILE_RAYS; i++) {
        rays[i] = camera_ray(camera, places->u[i], places->v[i]);
    }
    geometry_closest_tile(p->geometry, features, rays, hits);
}

// The pixels of one beam that are left < right, top < bottom.
RT_ALWAYS_INLINE void trace_beam(const Prepared *p, unsigned features, Tile tile, Film *film,
                                 RenderStatistics *statistics)
{
    Ray rays[TILE_RAYS];
    Hit hits[TILE_RAYS];
    BeamPlaces places;
    beam_places(tile, film, &places);
    beam_closest(p, features, &places, rays, hits);
    for (int y = tile.top; y < tile.bottom; y++) {
        float *pixel = &film->rgb[3 * ((size_t)y * (size_t)film->width + (size_t)tile.left)];
        for (int x = tile.left; x < tile.right; x++, pixel += 3) {
            int i = (y - tile.top) * BEAM + (x - tile.left);
            Rgb light = shade_ray(p, features, rays[i], &hits[i], statistics);
            statistics->camera_rays++;
            pixel[0] = (float)light.red;
            pixel[1] = (float)light.green;
            pixel[2] = (float)light.blue;
        }
    }
}

RT_ALWAYS_INLINE void trace_tile(const Prepared *p, unsigned features, Tile tile, Film *film,
                                 RenderStatistics *statistics)
{
    RenderStatistics counted = {0};
    for (int top = tile.top; top < tile.bottom; top += BEAM) {
        for (int left = tile.left; left < tile.right; left += BEAM) {
            Tile beam = {left, top, left + BEAM < tile.right ? left + BEAM : tile.right,
                         top + BEAM < tile.bottom ? top + BEAM : tile.bottom};
            trace_beam(p, features, beam, film, &counted);
        }
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
    X(any_any, "everything", GEOMETRY_ANY,                                                                             \
      SHADING_ANY | RENDER_EXPONENT | RENDER_TEXTURES | RENDER_INTERIORS | RENDER_LIGHTS)

#define DEFINE_KERNEL(name, text, geometry, shading)                                                                   \
    static void trace_##name(const Prepared *p, Tile tile, Film *film, RenderStatistics *statistics)                   \
    {                                                                                                                  \
        trace_tile(p, (unsigned)(geometry) | (unsigned)(shading), tile, film, statistics);                             \
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
