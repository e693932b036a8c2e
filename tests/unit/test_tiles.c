// Rays by the tile: surfaces and shadows are those of single rays, bit for bit.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/kernels.h"
#include "render/records/prepared.h"
#include "render/render.h"
#include "render/shade/tile_light.h"
#include "unit/random.h"
#include "unit/tap.h"
#include "unit/trace_scenes.h"

// Whether a surface is not what a single ray finds.
static bool surface_differs(const Geometry *g, Ray ray, Hit hit, const TileSurfaces *surfaces,
                            const MaterialIndex *material, int i)
{
    Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
    Vec3 point = tile_surface_point(surfaces, i), outward = tile_surface_outward(surfaces, i);
    return memcmp(&point, &surface.point, sizeof point) != 0 || memcmp(&outward, &surface.normal, sizeof outward) != 0 ||
           surface.material != material[i] || surfaces->shape[i] != hit.shape ||
           (surfaces->inside >> i & 1) != hit.inside;
}

static int surfaces_differing(const Geometry *g, const SphereTile *tile, const TileHits *hits,
                              const TileSurfaces *surfaces, const MaterialIndex *material)
{
    int different = 0;
    for (int i = 0; i < surfaces->count; i++) {
        unsigned ray = surfaces->ray[i];
        SphereRay own = sphere_tile_ray(tile, ray);
        Hit hit = {hits->t[ray], hits->shape[ray], hits->inside >> ray & 1};
        different += surface_differs(g, (Ray){own.origin, own.direction}, hit, surfaces, material, i);
    }
    return different;
}

typedef struct Shadows {
    int different, dark, lit, together;
} Shadows;

// `near`: rays longer than this whose light is nearer to the middle than they are start at the light
// (render/shade/far_light.c), since next to it they are off by more than what may stand there.
static void shadows_try(const Geometry *g, unsigned features, const TileSurfaces *from, Vec3 light, double aside,
                        double near, uint64_t asked, Random *random, Shadows *found)
{
    SurfaceRays rays = {.end = light, .end_radius = aside};
    for (int i = 0; i < from->count; i++) {
        double away = random_between(random, 0, aside);
        Vec3 end = vec3_add_scaled(light, away, random_direction(random));
        Vec3 offset = vec3_sub(aside > 0.0 ? end : light, tile_surface_point(from, i));
        rays.distance[i] = vec3_length(offset);
        bool is_far = rays.distance[i] > near && vec3_max_abs(tile_surface_point(from, i)) > vec3_max_abs(light);
        asked &= ~((uint64_t)is_far << i);
        Vec3 towards = vec3_scale(1.0 / rays.distance[i], offset);
        rays.towards[0][i] = towards.x;
        rays.towards[1][i] = towards.y;
        rays.towards[2][i] = towards.z;
    }
    asked &= ~UINT64_C(0) >> (TILE_RAYS - from->count);
    uint64_t occluded = geometry_occluded_surfaces(g, features, from, &rays, true, asked);
    uint64_t left;
    g->kernels->occluded_surfaces(&g->spheres, from, &rays, asked, &left);
    found->different += (occluded & ~asked) != 0;
    found->together += __builtin_popcountll(asked & ~left);
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        Vec3 direction = {rays.towards[0][i], rays.towards[1][i], rays.towards[2][i]};
        RayStart start = {from->shape[i], vec3_dot(tile_surface_outward(from, i), direction) < 0.0, HIDDEN_SHADOW};
        bool is_dark =
            geometry_occluded(g, features, (Ray){tile_surface_point(from, i), direction}, start, rays.distance[i]);
        found->different += is_dark != (occluded >> i & 1);
        found->dark += is_dark;
        found->lit += !is_dark;
    }
}

// The rays whose hits differ from what single rays meet, or the surfaces there.
static int secondary_differing(const Geometry *g, unsigned features, SecondaryRays *rays, int *met)
{
    TileHits hits;
    TileSurfaces surfaces;
    MaterialIndex material[TILE_RAYS];
    int different = 0;
    geometry_closest_secondary(g, features, HIDDEN_MIRROR, rays, &hits);
    for (int i = 0; i < rays->count; i++) {
        RayStart start = {rays->start[i], rays->inward >> i & 1, HIDDEN_MIRROR};
        Hit hit;
        bool is_met = geometry_closest(g, features, secondary_ray(rays, (unsigned)i), start, (double)INFINITY, &hit);
        different += is_met != (hits.met >> i & 1) ||
                     (is_met && (hit.t != hits.t[i] || hit.shape != hits.shape[i] || hit.inside != (hits.inside >> i & 1)));
        *met += is_met;
    }
    if (hits.met) {
        geometry_secondary_surfaces(g, features, rays, &hits, &surfaces, material);
        for (int i = 0; i < surfaces.count; i++) {
            unsigned ray = surfaces.ray[i];
            Hit hit = {hits.t[ray], hits.shape[ray], hits.inside >> ray & 1};
            different += surface_differs(g, secondary_ray(rays, ray), hit, &surfaces, material, i);
        }
    }
    return different;
}

// A direction in which a ray from a point grazes a sphere, but for rounding.
static Vec3 grazing(Random *random, Vec3 point, const SphereData *ball)
{
    Vec3 offset = vec3_sub(ball->centre, point);
    double distance = vec3_length(offset), sine = sqrt(ball->radius_squared) / distance;
    if (!(sine < 1.0)) {
        return random_direction(random);
    }
    Vec3 towards = vec3_normalize(offset), aside = random_perpendicular(random, towards);
    return vec3_normalize(vec3_add_scaled(vec3_scale(sqrt(1.0 - sine * sine), towards), sine, aside));
}

// Rays that continue from surfaces: anywhere, in or out, or along other spheres.
static int secondary_try(const Geometry *g, unsigned features, const TileSurfaces *from, Random *random, int *met,
                         int *together)
{
    SecondaryRays rays = {.count = 0};
    for (int i = 0; i < from->count; i++) {
        Vec3 point = tile_surface_point(from, i), direction = random_direction(random);
        if (random_bits(random) % 4 == 0) {
            SphereData ball = sphere_table_ball(&g->spheres, (uint32_t)(random_bits(random) % g->spheres.count));
            direction = grazing(random, point, &ball);
        }
        secondary_ray_add(&rays, point, direction, from->shape[i],
                          vec3_dot(tile_surface_outward(from, i), direction) < 0.0);
    }
    int different = secondary_differing(g, features, &rays, met);
    if (query_is_few(g, features)) {
        TileHits hits;
        const PlaneShape *plane = g->plane_count == 1 ? &g->planes[0].shape : NULL;
        *together += __builtin_popcountll(
            g->kernels->closest_secondary(&g->spheres, plane, shape_id(SHAPE_PLANE, 0), &rays, &hits));
    }
    return different;
}

// The walk from one crossing to the next: whether it meets other shapes than were told.
static bool crossings_differ(const Geometry *g, unsigned features, Ray ray, RayStart start, double t_max, int told,
                             const ShapeId *shapes)
{
    Hit hit;
    int count = 0;
    for (; geometry_closest(g, features, ray, start, t_max, &hit); count++) {
        if (count >= told || shapes[count] != hit.shape) {
            return true;
        }
        ray.origin = geometry_surface(g, features, ray, hit).point;
        t_max -= hit.t;
        start = (RayStart){hit.shape, !hit.inside, HIDDEN_SHADOW};
    }
    return count != told;
}

typedef struct Crossed {
    int different, told, told_singly, asked, shapes;
} Crossed;

// Ways from surfaces to a place nearby: on and off spheres, along them, or anywhere.
static void crossed_try(const Geometry *g, unsigned features, const TileSurfaces *from, Random *random, Crossed *found)
{
    static TileCrossings crossings;
    SurfaceRays rays;
    for (int i = 0; i < from->count; i++) {
        Vec3 point = tile_surface_point(from, i), direction = random_direction(random);
        SphereData ball = sphere_table_ball(&g->spheres, (uint32_t)(random_bits(random) % g->spheres.count));
        double distance = sqrt(ball.radius_squared) * pow(10.0, random_between(random, -1, 2));
        if (sphere_data_is_usable(&ball) && random_bits(random) % 4 == 0) {
            direction = grazing(random, point, &ball);
        }
        if (sphere_data_is_usable(&ball) && random_bits(random) % 8 == 0) { // it ends on a sphere
            Vec3 end = vec3_add_scaled(ball.centre, sqrt(ball.radius_squared), random_direction(random));
            distance = vec3_length(vec3_sub(end, point));
            direction = vec3_scale(1.0 / distance, vec3_sub(end, point));
        }
        lane_set(rays.towards, (unsigned)i, direction);
        rays.distance[i] = distance;
    }
    uint64_t asked = random_bits(random);
    asked |= random_bits(random);
    asked &= ~UINT64_C(0) >> (TILE_RAYS - from->count);
    uint64_t told = geometry_crossed(g, features, from, &rays, asked, &crossings);
    found->asked += __builtin_popcountll(asked);
    found->told += __builtin_popcountll(told);
    found->different += (told & ~asked) != 0;
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        RayCrossings single;
        double end = rays.distance[i];
        Ray ray = {tile_surface_point(from, i), lane_get(rays.towards, (unsigned)i)};
        RayStart start = {from->shape[i], vec3_dot(tile_surface_outward(from, i), ray.direction) < 0.0, HIDDEN_SHADOW};
        if (told >> i & 1) {
            found->different +=
                crossings_differ(g, features, ray, start, end, crossings.count[i], crossings.shape[i]);
            found->shapes += crossings.count[i];
        }
        if (geometry_ray_crossed(g, features, ray, start, end, &single)) {
            found->different += crossings_differ(g, features, ray, start, end, single.count, single.shape);
            found->told_singly++;
        }
    }
}

// Shells within one another, about touching or equal ones, others beside them, and a plane.
static void crossed_scene(Random *random, Scene *scene)
{
    int count = 2 + (int)(random_bits(random) % 28);
    Vec3 aside = random_point(random, random_bits(random) % 8 ? 0.0 : 1e4);
    scene_init(scene);
    for (int i = 0; i < count; i++) {
        Vec3 centre = random_bits(random) % 2 ? (Vec3){0.0, 0.0, 0.0} : random_point(random, 3);
        double radius = random_bits(random) % 40 ? random_between(random, 0.1, 2) : 1.0;
        add_sphere(scene, vec3_add(centre, aside), radius + (random_bits(random) % 3 ? 0.0 : 1e-9));
    }
    if (random_bits(random) % 2) {
        Vec3 normal = random_direction(random);
        add_plane(scene, normal, vec3_dot(normal, aside) + random_between(random, -2, 2));
    }
}

static void test_crossed(uint64_t seed)
{
    Random random = {seed};
    Crossed found = {0};
    for (int turn = 0; turn < 300; turn++) {
        Scene scene;
        crossed_scene(&random, &scene);
        Geometry *g = prepare(&scene, 0);
        unsigned features = geometry_features(g);
        SphereTile tile;
        Vec3 at = scene.spheres.items[random_bits(&random) % scene.spheres.count].centre;
        Vec3 eye = vec3_add(at, random_point(&random, 5));
        tile_of(&random, eye, vec3_normalize(vec3_sub(at, eye)), 0.05, &tile);
        uint64_t same = random_bits(&random);
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            TileHits hits;
            TileSurfaces surfaces;
            MaterialIndex material[TILE_RAYS];
            Random own = {same};
            g->kernels = sphere_kernels_choose(geometry_isa(isa));
            query_tile_closest(g, features, &tile, true, &hits);
            if (hits.met) {
                geometry_tile_surfaces(g, features, &tile, &hits, hits.met, &surfaces, material);
                crossed_try(g, features, &surfaces, &own, &found);
            }
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(found.different == 0 && found.told > found.asked / 8 && found.told_singly >= found.told &&
               found.shapes > found.told / 2,
           "what lies on a way is what a walk meets: %d of %d differ (%d asked for, %d crossings)", found.different,
           found.told, found.asked, found.shapes);
}

// From within shells that lie next to one another, or on one another, in any order.
static void test_secondary_ties(uint64_t seed)
{
    int different = 0, met = 0;
    Random random = {seed};
    for (int turn = 0; turn < 100; turn++) {
        Scene scene;
        scene_init(&scene);
        for (int i = 0; i < 7; i++) {
            double radius = 2.0 + (double)(random_bits(&random) % 4) * (turn % 2 ? 1e-15 : 1e-5);
            add_sphere(&scene, (Vec3){0.0, 0.0, 0.0}, radius);
        }
        Geometry *g = prepare(&scene, 0);
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            SecondaryRays rays = {.count = 0};
            g->kernels = sphere_kernels_choose(geometry_isa(isa));
            for (int i = 0; i < 61; i++) {
                Vec3 origin = random_point(&random, 1);
                secondary_ray_add(&rays, origin, random_direction(&random), SHAPE_NONE, false);
            }
            different += secondary_differing(g, geometry_features(g), &rays, &met);
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(different == 0 && met > 6000,
           "rays that continue meet the first of shells about equally near: %d of %d do not", different, met);
}

// As prepared_new has it of the least size.
static double near_of(const Scene *scene)
{
    double least = (double)INFINITY;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        least = fmin(least, scene->spheres.items[i].radius);
    }
    return 0x1p26 * least;
}

// A light anywhere: among the spheres, near a surface, or far away.
static Vec3 light_place(Random *random, const TraceFamily *family, const TileSurfaces *surfaces)
{
    uint64_t bits = random_bits(random);
    Vec3 middle = bits & 1 ? family->middle : tile_surface_point(surfaces, 0);
    double size = family->size * pow(10.0, bits & 2 ? random_between(random, -6, 0) : random_between(random, 0, 9));
    return vec3_add(middle, random_point(random, size));
}

static void test_geometry(uint64_t seed, size_t number, int count, int planes)
{
    const TraceFamily *family = &families[number];
    Random random = {seed + number};
    Scene scene;
    scene_init(&scene);
    family->make(&scene, &random, count);
    for (int i = 0; i < planes; i++) {
        Vec3 normal = random_direction(&random);
        add_plane(&scene, normal, random_between(&random, -1, 1) * family->size);
    }
    Geometry *g = prepare(&scene, 0);
    unsigned features = geometry_features(g);
    int surfaces_different = 0, met = 0, secondary_different = 0, secondary_met = 0, together = 0;
    Shadows shadows = {0};
    Crossed crossed = {0};
    for (int turn = 0; turn < 200; turn++) {
        SphereTile tile;
        Vec3 eye = vec3_add(family->middle, random_point(&random, 2 * family->size));
        Vec3 at = scene.spheres.items[random_bits(&random) % scene.spheres.count].centre;
        tile_of(&random, eye, vec3_normalize(vec3_sub(at, eye)), pow(10, random_between(&random, -6, -1)), &tile);
        uint64_t asked = random_bits(&random);
        asked |= random_bits(&random);
        uint64_t light_seed = random_bits(&random);
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            TileHits hits;
            TileSurfaces surfaces;
            MaterialIndex material[TILE_RAYS];
            g->kernels = sphere_kernels_choose(geometry_isa(isa));
            query_tile_closest(g, features, &tile, true, &hits);
            met += __builtin_popcountll(hits.met);
            if (hits.met & asked) {
                Random same = {light_seed};
                geometry_tile_surfaces(g, features, &tile, &hits, hits.met & asked, &surfaces, material);
                surfaces_different += surfaces_differing(g, &tile, &hits, &surfaces, material);
                Vec3 light = light_place(&same, family, &surfaces);
                double aside = turn % 2 ? family->size * pow(10.0, random_between(&same, -3, 0)) : 0.0;
                shadows_try(g, features, &surfaces, light, aside, near_of(&scene), asked, &same, &shadows);
                secondary_different += secondary_try(g, features, &surfaces, &same, &secondary_met, &together);
                crossed_try(g, features, &surfaces, &same, &crossed);
            }
        }
    }
    tap_ok(surfaces_different == 0 && met > 1000, "%s, %d, %d planes: surfaces are those of single rays (%d of %d not)",
           family->name, count, planes, surfaces_different, met);
    tap_ok(shadows.different == 0 && shadows.dark + shadows.lit > 500,
           "%s, %d, %d planes: shadows too (%d of %d dark and %d lit differ; %d traced together)", family->name, count,
           planes, shadows.different, shadows.dark, shadows.lit, shadows.together);
    bool may_together = query_is_few(g, features);
    tap_ok(secondary_different == 0 && secondary_met > 100 && (together > 1000) == may_together,
           "%s, %d, %d planes: rays that continue meet what single rays do (%d of %d not; %d traced together)",
           family->name, count, planes, secondary_different, secondary_met, together);
    tap_ok(crossed.different == 0 && (crossed.told == 0 || may_together),
           "%s, %d, %d planes: what lies on ways to a place, too (%d of %d not; %d asked for)", family->name, count, planes,
           crossed.different, crossed.told, crossed.asked);
    geometry_free(g);
    scene_fini(&scene);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    for (size_t family = 0; family < RT_COUNT_OF(families); family++) {
        test_geometry(seed, family, 8, (int)family % 3);
        test_geometry(seed, family, 3000, (int)(family + 1) % 3);
    }
    test_geometry(seed, 0, 25, 1);
    test_crossed(seed);
    test_secondary_ties(seed);
    return tap_done();
}
