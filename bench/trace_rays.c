// Rays against many shapes of a kind: ours and Embree's, in turn, on the same rays and one core, and the time to build.
//
// Usage: trace_rays [spheres|cylinders|cones|boxes|triangles|COUNT ...]. Prints a line of JSON for each count, of the
// kind that was named last: millions of rays a second of each, and the ratios of the medians. Embree works in float, we
// in double; it is given the rays rounded. It has no boxes, which it is given as twelve triangles each; cylinders and
// cones it has as curves of one straight piece. Without Embree (Debian: libembree-dev) only our own figures are
// printed. Timing belongs to bench, never to a test.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/trace_scenes.h"
#include "trace/query_surface.h"

// Packets and tiles are timed in portions that lie in the processor's cache, where a renderer has just made them.
enum { PORTION = 2048 };
enum { WIDTH = 1920, HEIGHT = 1080, RAYS = WIDTH * HEIGHT, TURNS = 7, BUILD_TURNS = 5 };

static const Vec3 eye = {0, 0, -3.2};
static const Vec3 light = {6, 8, -10};

typedef struct RaySet {
    Ray *rays;
    RayStart *starts;
    double *ends;
    size_t count;
} RaySet;

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time); // one thread of ours; the machine may be shared
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static void *need(size_t bytes)
{
    void *memory = aligned_alloc(64, (bytes + 63) / 64 * 64);
    if (!memory) {
        fputs("trace_rays: out of memory\n", stderr);
        exit(1);
    }
    return memory;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return values[count / 2];
}

// ---- what is traced: the scenes of generate.py, and three sets of rays

// A query with the features that the geometry has, as constants.
#define ASK(g, query, ...)                                                                                             \
    (query_has_primitives(g, TRACE_PRIMITIVES) ? query(g, TRACE_ALL_FEATURES, __VA_ARGS__)                            \
                                               : query(g, TRACE_SPHERES | TRACE_SPHERE_BVH, __VA_ARGS__))

static RaySet ray_set(size_t count)
{
    return (RaySet){need(count * sizeof(Ray)), need(count * sizeof(RayStart)), need(count * sizeof(double)), 0};
}

static void ray_set_add(RaySet *set, Ray ray, RayStart start, double end)
{
    set->rays[set->count] = ray;
    set->starts[set->count] = start;
    set->ends[set->count++] = end;
}

// Camera rays in tiles of 8 x 8.
static void make_camera_rays(RaySet *set)
{
    for (int i = 0; i < RAYS; i++) {
        int tile = i / 64, x = tile % (WIDTH / 8) * 8 + i % 8, y = tile / (WIDTH / 8) * 8 + i / 8 % 8;
        Vec3 towards = vec3(((x + 0.5) / WIDTH - 0.5) * 16 / 9, 0.5 - (y + 0.5) / HEIGHT, 1);
        ray_set_add(set, (Ray){eye, vec3_normalize(towards)}, RAY_START_FREE, (double)INFINITY);
    }
}

static void make_secondary_rays(const Geometry *g, const RaySet *camera, RaySet *reflected, RaySet *shadow)
{
    for (size_t i = 0; i < camera->count; i++) {
        Hit hit;
        if (!geometry_closest(g, TRACE_ALL_FEATURES, camera->rays[i], RAY_START_FREE, (double)INFINITY, &hit)) {
            continue;
        }
        Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, camera->rays[i], hit);
        RayStart start = {.shape = hit.shape, .inward = hit.inside};
        surface.normal = hit.inside ? vec3_neg(surface.normal) : surface.normal;
        Vec3 mirrored = vec3_normalize(vec3_reflect(camera->rays[i].direction, surface.normal));
        ray_set_add(reflected, (Ray){surface.point, mirrored}, start, (double)INFINITY);
        Vec3 towards = vec3_sub(light, surface.point);
        if (vec3_dot(towards, surface.normal) > 0) {
            double distance = vec3_length(towards);
            ray_set_add(shadow, (Ray){surface.point, vec3_scale(1 / distance, towards)}, start, distance);
        }
    }
}

// ---- ours

static double time_closest(const Geometry *g, const RaySet *set, size_t *hits)
{
    double start = now();
    *hits = 0;
    for (size_t i = 0; i < set->count; i++) {
        Hit hit;
        *hits += ASK(g, geometry_closest, set->rays[i], set->starts[i], set->ends[i], &hit);
    }
    return now() - start;
}

// What a renderer's tiles hold, laid out before the clock starts, as Embree's packets are: camera rays, what they met,
// and from there the rays to the light.
typedef struct TileSet {
    SphereTile *tiles;
    TileSurfaces *surfaces;
    SurfaceRays *shadows;
    uint64_t *asked;
    size_t count;
} TileSet;

static void make_tile_shadows(const Geometry *g, TileSet *set, size_t at)
{
    TileHits hits;
    MaterialIndex material[TILE_RAYS];
    TileSurfaces *surfaces = &set->surfaces[at];
    SurfaceRays *rays = &set->shadows[at];
    set->asked[at] = 0;
    surfaces->count = 0;
    ASK(g, query_tile_closest, &set->tiles[at], true, &hits);
    if (hits.met) {
        ASK(g, geometry_tile_surfaces, &set->tiles[at], &hits, hits.met, surfaces, material);
    }
    rays->end = light;
    rays->end_radius = 0;
    for (int i = 0; i < surfaces->count; i++) {
        Vec3 offset = vec3_sub(light, tile_surface_point(surfaces, i));
        rays->distance[i] = vec3_length(offset);
        Vec3 towards = vec3_scale(1 / rays->distance[i], offset);
        rays->towards[0][i] = towards.x;
        rays->towards[1][i] = towards.y;
        rays->towards[2][i] = towards.z;
        bool is_outward = vec3_dot(offset, tile_surface_outward(surfaces, i)) > 0;
        set->asked[at] |= (uint64_t)(is_outward != (surfaces->inside >> i & 1)) << i;
    }
}

static TileSet make_tiles(const Geometry *g, const RaySet *camera)
{
    size_t count = camera->count / TILE_RAYS;
    TileSet set = {need(count * sizeof *set.tiles), need(count * sizeof *set.surfaces), need(count * sizeof *set.shadows),
                   need(count * sizeof *set.asked), count};
    for (size_t at = 0; at < count; at++) {
        set.tiles[at].origin = eye;
        for (unsigned i = 0; i < TILE_RAYS; i++) {
            SphereRay ray = sphere_ray_make(eye, camera->rays[at * TILE_RAYS + i].direction);
            sphere_tile_set(&set.tiles[at], i, &ray);
        }
        make_tile_shadows(g, &set, at);
    }
    return set;
}

static void free_tiles(TileSet *set)
{
    free(set->tiles);
    free(set->surfaces);
    free(set->shadows);
    free(set->asked);
}

// Copies a portion of things to `to`; returns how many they are.
static size_t portion_copy(void *to, const void *from, size_t at, size_t count, size_t portion, size_t size)
{
    size_t end = at + portion < count ? at + portion : count;
    memcpy(to, (const char *)from + at * size, (end - at) * size);
    return end - at;
}

static double time_tiles(const Geometry *g, const TileSet *set, size_t *hits)
{
    enum { TILES = PORTION / TILE_RAYS };
    static SphereTile tiles[TILES];
    double seconds = 0;
    *hits = 0;
    for (size_t at = 0; at < set->count; at += TILES) {
        size_t count = portion_copy(tiles, set->tiles, at, set->count, TILES, sizeof *tiles);
        double start = now();
        for (size_t i = 0; i < count; i++) {
            TileHits found;
            ASK(g, query_tile_closest, &tiles[i], true, &found);
            *hits += (size_t)__builtin_popcountll(found.met);
        }
        seconds += now() - start;
    }
    return seconds;
}

static double time_groups(const Geometry *g, const TileSet *set, size_t *hits)
{
    enum { TILES = PORTION / TILE_RAYS };
    static TileSurfaces surfaces[TILES];
    static SurfaceRays shadows[TILES];
    double seconds = 0;
    *hits = 0;
    for (size_t at = 0; at < set->count; at += TILES) {
        portion_copy(surfaces, set->surfaces, at, set->count, TILES, sizeof *surfaces);
        size_t count = portion_copy(shadows, set->shadows, at, set->count, TILES, sizeof *shadows);
        double start = now();
        for (size_t i = 0; i < count; i++) {
            uint64_t asked = set->asked[at + i];
            uint64_t dark = asked ? ASK(g, geometry_occluded_surfaces, &surfaces[i], &shadows[i], true, asked) : 0;
            *hits += (size_t)__builtin_popcountll(dark);
        }
        seconds += now() - start;
    }
    return seconds;
}

static double time_occluded(const Geometry *g, const RaySet *set, size_t *hits)
{
    double start = now();
    *hits = 0;
    for (size_t i = 0; i < set->count; i++) {
        *hits += ASK(g, geometry_occluded, set->rays[i], set->starts[i], set->ends[i]);
    }
    return now() - start;
}

static double time_build(const Scene *scene, int threads)
{
    double start = now();
    Geometry *g = geometry_new_with(scene, 0, &(GeometryOptions){.threads = threads});
    double seconds = now() - start;
    geometry_free(g);
    return seconds;
}

// ---- Embree

#ifdef WITH_EMBREE

static double embree_time_build(RTCDevice device, const Scene *scene, Kind kind)
{
    double start = now();
    RTCScene built = embree_build(device, scene, kind);
    double seconds = now() - start;
    rtcReleaseScene(built);
    return seconds;
}

// A ray that starts on a sphere begins a little later, since Embree has no other way to leave it.
static struct RTCRay embree_ray(const RaySet *set, size_t i)
{
    Ray ray = set->rays[i];
    bool is_free = set->starts[i].shape == SHAPE_NONE;
    return (struct RTCRay){.org_x = (float)ray.origin.x, .org_y = (float)ray.origin.y, .org_z = (float)ray.origin.z,
                           .tnear = is_free ? 0.0f : 1e-5f, .dir_x = (float)ray.direction.x,
                           .dir_y = (float)ray.direction.y, .dir_z = (float)ray.direction.z,
                           .tfar = (float)set->ends[i], .mask = UINT32_MAX};
}

static double embree_time_closest(RTCScene scene, const RaySet *set, bool coherent, size_t *hits)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    double start = now();
    *hits = 0;
    for (size_t i = 0; i < set->count; i++) {
        struct RTCRayHit ray = {.ray = embree_ray(set, i), .hit.geomID = RTC_INVALID_GEOMETRY_ID};
        rtcIntersect1(scene, &context, &ray);
        *hits += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return now() - start;
}

static double embree_time_occluded(RTCScene scene, const RaySet *set, size_t *hits)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    double start = now();
    *hits = 0;
    for (size_t i = 0; i < set->count; i++) {
        struct RTCRay ray = embree_ray(set, i);
        rtcOccluded1(scene, &context, &ray);
        *hits += ray.tfar < 0;
    }
    return now() - start;
}

// Packets: rays are laid out before the clock starts, as a renderer that uses them would have made them.
#define PACKETS(WIDTH_OF)                                                                                              \
    static double embree_time_packets##WIDTH_OF(RTCScene scene, const RaySet *set, bool any, size_t *hits)             \
    {                                                                                                                  \
        struct RTCIntersectContext context;                                                                           \
        rtcInitIntersectContext(&context);                                                                            \
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;                                                          \
        size_t count = set->count / WIDTH_OF;                                                                          \
        struct RTCRayHit##WIDTH_OF *packets = need(count * sizeof(*packets));                                          \
        for (size_t i = 0; i < count * WIDTH_OF; i++) {                                                                \
            struct RTCRayHit##WIDTH_OF *p = &packets[i / WIDTH_OF];                                                    \
            size_t k = i % WIDTH_OF;                                                                                   \
            struct RTCRay ray = embree_ray(set, i);                                                                    \
            p->ray.org_x[k] = ray.org_x, p->ray.org_y[k] = ray.org_y, p->ray.org_z[k] = ray.org_z;                     \
            p->ray.dir_x[k] = ray.dir_x, p->ray.dir_y[k] = ray.dir_y, p->ray.dir_z[k] = ray.dir_z;                     \
            p->ray.tnear[k] = ray.tnear, p->ray.tfar[k] = ray.tfar, p->ray.mask[k] = ray.mask;                         \
            p->ray.time[k] = 0, p->ray.id[k] = 0, p->ray.flags[k] = 0;                                                 \
            p->hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;                                                                \
        }                                                                                                              \
        _Alignas(64) int valid[WIDTH_OF];                                                                              \
        for (int k = 0; k < WIDTH_OF; k++) {                                                                           \
            valid[k] = -1;                                                                                             \
        }                                                                                                              \
        static struct RTCRayHit##WIDTH_OF some[PORTION / WIDTH_OF];                                                    \
        double seconds = 0;                                                                                            \
        *hits = 0;                                                                                                     \
        for (size_t at = 0; at < count; at += PORTION / WIDTH_OF) {                                                    \
            size_t portion = portion_copy(some, packets, at, count, PORTION / WIDTH_OF, sizeof *some);                 \
            double start = now();                                                                                      \
            for (size_t i = 0; i < portion; i++) {                                                                     \
                if (any) {                                                                                             \
                    rtcOccluded##WIDTH_OF(valid, scene, &context, &some[i].ray);                                       \
                } else {                                                                                               \
                    rtcIntersect##WIDTH_OF(valid, scene, &context, &some[i]);                                          \
                }                                                                                                      \
            }                                                                                                          \
            seconds += now() - start;                                                                                  \
            for (size_t i = 0; i < portion * WIDTH_OF; i++) {                                                          \
                *hits += any ? some[i / WIDTH_OF].ray.tfar[i % WIDTH_OF] < 0                                           \
                             : some[i / WIDTH_OF].hit.geomID[i % WIDTH_OF] != RTC_INVALID_GEOMETRY_ID;                 \
            }                                                                                                          \
        }                                                                                                              \
        free(packets);                                                                                                 \
        return seconds;                                                                                                \
    }
PACKETS(4)
PACKETS(8)
PACKETS(16)

#endif

// ---- side by side

enum { OURS, EMBREE, SIDES };
enum { CAMERA, REFLECTED, SHADOW, TILE, LIGHT, BUILD, MEASURES };
static const char *const measure_names[MEASURES] = {"camera", "reflected", "shadow", "tile", "light", "build"};

typedef struct Bench {
    Kind kind;
    Scene scene;
    Geometry *geometry;
    RaySet camera, reflected, shadow;
    TileSet tiles;
    double seconds[SIDES][MEASURES][TURNS];
    size_t hits[SIDES][MEASURES];
} Bench;

static void measure_ours(Bench *b, int turn)
{
    b->seconds[OURS][CAMERA][turn] = time_closest(b->geometry, &b->camera, &b->hits[OURS][CAMERA]);
    b->seconds[OURS][REFLECTED][turn] = time_closest(b->geometry, &b->reflected, &b->hits[OURS][REFLECTED]);
    b->seconds[OURS][SHADOW][turn] = time_occluded(b->geometry, &b->shadow, &b->hits[OURS][SHADOW]);
    b->seconds[OURS][TILE][turn] = time_tiles(b->geometry, &b->tiles, &b->hits[OURS][TILE]);
    b->seconds[OURS][LIGHT][turn] = time_groups(b->geometry, &b->tiles, &b->hits[OURS][LIGHT]);
    b->seconds[OURS][BUILD][turn] = time_build(&b->scene, 1);
}

#ifdef WITH_EMBREE
static double least(double a, double b)
{
    return a < b ? a : b;
}

static void measure_embree(Bench *b, RTCDevice device, RTCScene scene, int turn)
{
    size_t *hits = b->hits[EMBREE];
    b->seconds[EMBREE][CAMERA][turn] = embree_time_closest(scene, &b->camera, false, &hits[CAMERA]);
    b->seconds[EMBREE][REFLECTED][turn] = embree_time_closest(scene, &b->reflected, false, &hits[REFLECTED]);
    b->seconds[EMBREE][SHADOW][turn] = embree_time_occluded(scene, &b->shadow, &hits[SHADOW]);
    double best = embree_time_packets4(scene, &b->camera, false, &hits[TILE]);
    best = least(best, embree_time_packets8(scene, &b->camera, false, &hits[TILE]));
    best = least(best, embree_time_packets16(scene, &b->camera, false, &hits[TILE]));
    b->seconds[EMBREE][TILE][turn] = best;
    b->seconds[EMBREE][LIGHT][turn] = embree_time_packets8(scene, &b->shadow, true, &hits[LIGHT]);
    b->seconds[EMBREE][BUILD][turn] = embree_time_build(device, &b->scene, b->kind);
}
#endif

static void report(Bench *b, uint32_t count)
{
    const double work[MEASURES] = {(double)b->camera.count, (double)b->reflected.count, (double)b->shadow.count,
                                   (double)b->camera.count, (double)b->shadow.count, (double)count};
    printf("{\"%s\": %u, \"isa\": \"%s\", \"bytes_each\": %.1f", kind_names[b->kind], count,
           b->geometry->kernels->name, (double)geometry_bytes(b->geometry) / count);
    for (int m = 0; m < MEASURES; m++) {
        double ours = median(b->seconds[OURS][m], TURNS), embree = median(b->seconds[EMBREE][m], TURNS);
        if (ours > 0) {
            printf(", \"%s\": {\"ours\": %.2f", measure_names[m], 1e-6 * work[m] / ours);
            if (embree > 0) {
                printf(", \"embree\": %.2f, \"ratio\": %.2f, \"hits\": [%zu, %zu]", 1e-6 * work[m] / embree,
                       embree / ours, b->hits[OURS][m], b->hits[EMBREE][m]);
            }
            putchar('}');
        }
    }
    puts("}");
    fflush(stdout);
}

static void bench(Kind kind, uint32_t count)
{
    static Bench b;
    b.kind = kind;
    scene_init(&b.scene);
    make_scene(&b.scene, kind, count);
    b.geometry = geometry_new(&b.scene, 0);
    b.camera = ray_set(RAYS);
    b.reflected = ray_set(RAYS);
    b.shadow = ray_set(RAYS);
    make_camera_rays(&b.camera);
    make_secondary_rays(b.geometry, &b.camera, &b.reflected, &b.shadow);
    b.tiles = make_tiles(b.geometry, &b.camera);
#ifdef WITH_EMBREE
    RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    RTCScene scene = embree_build(device, &b.scene, kind);
#endif
    for (int turn = 0; turn < TURNS; turn++) {
        measure_ours(&b, turn);
#ifdef WITH_EMBREE
        measure_embree(&b, device, scene, turn);
#endif
    }
    report(&b, count);
#ifdef WITH_EMBREE
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
#endif
    geometry_free(b.geometry);
    free_tiles(&b.tiles);
    RaySet *sets[] = {&b.camera, &b.reflected, &b.shadow};
    for (size_t i = 0; i < RT_COUNT_OF(sets); i++) {
        free(sets[i]->rays);
        free(sets[i]->starts);
        free(sets[i]->ends);
    }
    scene_fini(&b.scene);
}

int main(int argc, char **argv)
{
    static const uint32_t usual[] = {1000, 100000, 1000000};
    Kind kind = SPHERES;
    for (int i = 1; i < argc; i++) {
        Kind named = SPHERES;
        while (named < KINDS && strcmp(argv[i], kind_names[named]) != 0) {
            named++;
        }
        if (named < KINDS) {
            kind = named;
        } else {
            bench(kind, (uint32_t)strtoul(argv[i], NULL, 10));
        }
    }
    for (size_t i = 0; argc == 1 && i < RT_COUNT_OF(usual); i++) {
        bench(SPHERES, usual[i]);
    }
    return 0;
}
