// The planes of a film that say what surface is seen: one ray through the middle of each pixel, apart from its light.
//
// The light's kernels know nothing of it, so a picture without planes costs what it did, and the planes of a sampled
// picture, of any precision and method are those of a plain one.
//
// SPDX-License-Identifier: MIT
#include "render/inspect/planes.h"

#include "render/records/camera.h"
#include "render/sample/tiles.h"
#include "render/shade/shade.h"
#include "render/shade/surface_uv.h"

typedef struct PlanesWork {
    const Prepared *prepared;
    Film *film;
} PlanesWork;

typedef struct AlbedoSum {
    const Prepared *prepared;
    Rgb albedo;
} AlbedoSum;

static Rgb add_albedo(void *client, const TextureLayer *layer)
{
    AlbedoSum *sum = client;
    double share = layer->part * texture_pigment_opaque(sum->prepared->is_old, layer->pigment);
    sum->albedo = rgb_add(sum->albedo, rgb_mul(rgb_scale(share, layer->above), rgbft_rgb(layer->pigment)));
    return rgb_grey(1.0);
}

static Rgb albedo_of(const Prepared *p, const Surface *surface, ShapeId shape, Vec3 normal, Vec3 direction)
{
    AlbedoSum sum = {p, rgb_grey(0.0)};
    if (surface->material & MATERIAL_COMPOUND) {
        uint32_t texture = p->compounds[surface->material & ~MATERIAL_COMPOUND].texture;
        Vec3 room;
        const Vec3 *uv = shade_uv(p, texture, shape, surface->point, direction, &room);
        TextureSight sight = {surface->point, uv, &normal, &direction, false};
        texture_walk(&p->textures, texture, sight, 0.0, add_albedo, &sum);
    } else {
        TextureLayer layer = {.pigment = material_pigment(&p->materials[surface->material]),
                              .part = 1.0,
                              .above = rgb_grey(1.0)};
        (void)add_albedo(&sum, &layer);
    }
    return sum.albedo;
}

static void put_three(void *plane, size_t pixel, double a, double b, double c)
{
    float *values = (float *)plane + 3 * pixel;
    values[0] = (float)a;
    values[1] = (float)b;
    values[2] = (float)c;
}

static void put_surface(const Prepared *p, const Film *film, size_t pixel, Ray ray, Hit hit)
{
    void *const *planes = film->planes;
    Surface surface = shade_surface_met(p, TRACE_ALL_FEATURES | RENDER_TEXTURES, ray, hit);
    if (planes[FILM_DEPTH]) {
        ((float *)planes[FILM_DEPTH])[pixel] = (float)(hit.t * vec3_length(ray.direction) * p->textures.scale);
    }
    Vec3 seen = hit.inside ? vec3_neg(surface.normal) : surface.normal;
    if (planes[FILM_NORMAL]) {
        put_three(planes[FILM_NORMAL], pixel, seen.x, seen.y, seen.z);
    }
    if (planes[FILM_OBJECT]) {
        ((uint32_t *)planes[FILM_OBJECT])[pixel] = surface.order + 1;
    }
    if (planes[FILM_ALBEDO]) {
        Rgb albedo = albedo_of(p, &surface, hit.shape, seen, ray.direction);
        put_three(planes[FILM_ALBEDO], pixel, albedo.red, albedo.green, albedo.blue);
    }
}

static void planes_tile(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    (void)scratch, (void)counted;
    const PlanesWork *work = client;
    const Prepared *p = work->prepared;
    const Film *film = work->film;
    for (int y = tile.top; y < tile.bottom; y++) {
        for (int x = tile.left; x < tile.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            Ray ray;
            Hit hit;
            if (camera_ray(&p->camera, film_u(film, x, 0.0), film_v(film, y, 0.0), &ray) &&
                geometry_closest(p->geometry, TRACE_ALL_FEATURES, ray, RAY_START_CAMERA, (double)INFINITY, &hit)) {
                put_surface(p, film, pixel, ray, hit);
            } else if (film->planes[FILM_DEPTH]) {
                ((float *)film->planes[FILM_DEPTH])[pixel] = INFINITY;
            }
        }
    }
}

static void code_tile(void *client, Tile tile, TileBytes *bytes)
{
    const PlanesWork *work = client;
    for (int i = 0; i < FILM_PLANES; i++) {
        if ((FILM_SURFACE_PLANES >> i & 1) && work->film->planes[i]) {
            size_t pixel = (size_t)film_plane_channels((FilmPlane)i) * sizeof(float);
            tile_bytes_plane(bytes, work->film->planes[i], pixel, work->film->width, tile);
        }
    }
}

RenderResult render_surface_planes(const Prepared *prepared, const RenderOptions *options, Film *film)
{
    PlanesWork planes = {prepared, film};
    TileWork work = {.client = &planes,
                     .prepared = prepared,
                     .width = film->width,
                     .height = film->height,
                     .trace = planes_tile,
                     .code = code_tile,
                     .is_last = true};
    RenderStatistics unused = {0};
    return tiles_run(&work, options, &unused);
}
