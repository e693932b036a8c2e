// The table of spheres made from a scene, and the choice of its kernels.
//
// Everything is worked out from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
// greater by k gives the same table bit for bit.
//
// SPDX-License-Identifier: MIT
#include "trace/spheres.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"

enum {
    LOOSE_SPHERES_MOST = SPHERE_BLOCK, // a scene with no more than these has no tree
    RADIUS_SAMPLES = 255,              // radii that the median is taken of
    // A sphere this many times larger than the median is kept out of the tree. A planet under a million grains would
    // otherwise make every box on its way to the root as large as itself.
    LARGE_RADIUS_RATIO = 32,
    REFS_CHUNK = 16384, // spheres that a thread takes at a time
    NODES_CHUNK = 256,  // nodes whose leaves a thread fills at a time
};

// ---- kernels

extern const SphereKernels sphere_kernels_plain;
#ifdef __x86_64__
extern const SphereKernels sphere_kernels_v2, sphere_kernels_v3, sphere_kernels_v4;
static const SphereKernels *const kernels[] = {&sphere_kernels_plain, &sphere_kernels_v2, &sphere_kernels_v3,
                                               &sphere_kernels_v4};
#else
static const SphereKernels *const kernels[] = {&sphere_kernels_plain};
#endif

const SphereKernels *sphere_kernels_at(size_t i)
{
    return i < RT_COUNT_OF(kernels) ? kernels[i] : NULL;
}

const SphereKernels *sphere_kernels_choose(const char *name)
{
    for (size_t i = RT_COUNT_OF(kernels); i-- > 0;) {
        if ((!name || strcmp(name, kernels[i]->name) == 0) && kernels[i]->is_supported()) {
            return kernels[i];
        }
    }
    return NULL;
}

// ---- the table

typedef struct Maker {
    SphereTable *table;
    const Scene *scene;
    double scale[2];   // lengths are multiplied by both
    uint32_t *numbers; // of the usable spheres in the scene, the loose ones first
    BvhRef *refs;      // of the others
    uint32_t *first_blocks; // of each chunk of nodes
    atomic_uint next;       // the first sphere, or chunk of nodes, that no thread has taken yet
} Maker;

static double maker_length(const Maker *maker, double length)
{
    return length * maker->scale[0] * maker->scale[1];
}

static Ball maker_ball(const Maker *maker, uint32_t number)
{
    const Sphere *sphere = &maker->scene->spheres.items[number];
    Vec3 c = sphere->centre;
    return ball_make(vec3(maker_length(maker, c.x), maker_length(maker, c.y), maker_length(maker, c.z)),
                     maker_length(maker, sphere->radius));
}

static int double_compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The square of the radius above which a sphere is large; infinite when there would be too many of them.
static double large_radius_squared(const Maker *maker, uint32_t count)
{
    double samples[RADIUS_SAMPLES];
    uint32_t sample_count = count < RADIUS_SAMPLES ? count : RADIUS_SAMPLES;
    for (uint32_t i = 0; i < sample_count; i++) {
        samples[i] = maker_ball(maker, maker->numbers[(uint64_t)i * count / sample_count]).radius_squared;
    }
    qsort(samples, sample_count, sizeof(samples[0]), double_compare);
    double limit = samples[sample_count / 2] * (LARGE_RADIUS_RATIO * LARGE_RADIUS_RATIO);
    uint32_t large_count = 0;
    for (uint32_t i = 0; i < count && large_count <= LOOSE_SPHERES_MOST; i++) {
        large_count += maker_ball(maker, maker->numbers[i]).radius_squared > limit;
    }
    return large_count <= LOOSE_SPHERES_MOST ? limit : (double)INFINITY;
}

// Lists the spheres that a ray can meet, the loose ones first.
static void maker_gather(Maker *maker)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < maker->scene->spheres.count; i++) {
        Ball ball = maker_ball(maker, i);
        if (ball_is_usable(&ball)) {
            maker->numbers[count++] = i;
        }
    }
    maker->table->count = count;
    if (count <= LOOSE_SPHERES_MOST) {
        maker->table->loose_count = count;
        return;
    }
    double limit = large_radius_squared(maker, count);
    for (uint32_t i = 0; i < count && limit < (double)INFINITY; i++) {
        if (maker_ball(maker, maker->numbers[i]).radius_squared > limit) {
            uint32_t place = maker->table->loose_count++;
            uint32_t number = maker->numbers[i];
            maker->numbers[i] = maker->numbers[place];
            maker->numbers[place] = number;
        }
    }
}

// ---- the tree of the table

static void maker_place(Maker *maker, uint32_t count)
{
    const uint32_t *numbers = maker->numbers + maker->table->loose_count;
    Vec3 low = vec3((double)INFINITY, (double)INFINITY, (double)INFINITY);
    Vec3 high = vec3_neg(low);
    double radius_squared = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        Ball ball = maker_ball(maker, numbers[i]);
        Vec3 c = ball.centre;
        low = vec3(fmin(low.x, c.x), fmin(low.y, c.y), fmin(low.z, c.z));
        high = vec3(fmax(high.x, c.x), fmax(high.y, c.y), fmax(high.z, c.z));
        radius_squared = fmax(radius_squared, ball.radius_squared);
    }
    // The greatest radius all around also holds spheres too small to show beside their coordinates.
    double radius = sqrt(radius_squared);
    Vec3 margin = vec3(radius, radius, radius);
    bvh_place(&maker->table->bvh, vec3_sub(low, margin), vec3_add(high, margin));
}

static void refs_work(void *client, int thread)
{
    Maker *maker = client;
    (void)thread;
    uint32_t loose = maker->table->loose_count;
    uint32_t count = maker->table->count - loose;
    for (uint32_t begin; (begin = atomic_fetch_add(&maker->next, REFS_CHUNK)) < count;) {
        uint32_t end = begin + REFS_CHUNK < count ? begin + REFS_CHUNK : count;
        for (uint32_t i = begin; i < end; i++) {
            uint32_t number = maker->numbers[loose + i];
            Ball ball = maker_ball(maker, number);
            double r = sqrt(ball.radius_squared);
            Vec3 radius = vec3(r, r, r);
            maker->refs[i] = bvh_ref(&maker->table->bvh, vec3_sub(ball.centre, radius),
                                     vec3_add(ball.centre, radius), number);
        }
    }
}

static void slot_fill(const Maker *maker, uint32_t slot, uint32_t number)
{
    SphereBlock *block = &maker->table->blocks[slot / SPHERE_BLOCK];
    uint32_t at = slot % SPHERE_BLOCK;
    Ball ball = maker_ball(maker, number);
    block->x[at] = ball.centre.x;
    block->y[at] = ball.centre.y;
    block->z[at] = ball.centre.z;
    block->radius_squared[at] = ball.radius_squared;
    const Sphere *sphere = &maker->scene->spheres.items[number];
    maker->table->info[slot] = (ShapeInfo){sphere->material, sphere->order};
}

static void slots_clear(const Maker *maker, uint32_t block, uint32_t begin)
{
    SphereBlock *spheres = &maker->table->blocks[block];
    for (uint32_t at = begin; at < SPHERE_BLOCK; at++) {
        spheres->x[at] = spheres->y[at] = spheres->z[at] = 0.0;
        spheres->radius_squared[at] = (double)NAN;
        maker->table->info[block * SPHERE_BLOCK + at] = (ShapeInfo){0, 0};
    }
}

// Turns the leaves of a chunk of nodes into blocks.
static void chunk_fill(const Maker *maker, uint32_t chunk)
{
    Bvh *bvh = &maker->table->bvh;
    uint32_t block = maker->first_blocks[chunk];
    for (uint32_t i = chunk * NODES_CHUNK; i < (chunk + 1) * NODES_CHUNK && i < bvh->node_count; i++) {
        for (int child = 0; child < BVH_WIDTH; child++) {
            BvhChild leaf = bvh->nodes[i].child[child];
            if (!(leaf & BVH_LEAF)) {
                continue;
            }
            uint32_t count = bvh_leaf_count(leaf);
            for (uint32_t at = 0; at < count; at++) {
                slot_fill(maker, block * SPHERE_BLOCK + at, maker->refs[bvh_leaf_first(leaf) + at].index);
            }
            slots_clear(maker, block, count);
            bvh->nodes[i].child[child] = BVH_LEAF | block++;
        }
    }
}

static void blocks_work(void *client, int thread)
{
    Maker *maker = client;
    (void)thread;
    for (uint32_t chunk; (chunk = atomic_fetch_add(&maker->next, 1)) * NODES_CHUNK < maker->table->bvh.node_count;) {
        chunk_fill(maker, chunk);
    }
}

// Counts the leaves and says where the blocks of each chunk of nodes begin.
static bool maker_count_blocks(Maker *maker)
{
    const Bvh *bvh = &maker->table->bvh;
    maker->first_blocks = malloc((bvh->node_count / NODES_CHUNK + 1) * sizeof(*maker->first_blocks));
    if (!maker->first_blocks) {
        return false;
    }
    for (uint32_t i = 0; i < bvh->node_count; i++) {
        if (i % NODES_CHUNK == 0) {
            maker->first_blocks[i / NODES_CHUNK] = maker->table->block_count;
        }
        for (int child = 0; child < BVH_WIDTH; child++) {
            maker->table->block_count += bvh->nodes[i].child[child] >> 31;
        }
    }
    return true;
}

static bool table_reserve(SphereTable *table)
{
    size_t slots = (size_t)table->block_count * SPHERE_BLOCK;
    table->blocks = aligned_alloc(_Alignof(SphereBlock), table->block_count * sizeof(SphereBlock));
    table->info = malloc(slots * sizeof(*table->info));
    return table->blocks && table->info;
}

static bool maker_make(Maker *maker, int threads)
{
    SphereTable *table = maker->table;
    maker_gather(maker);
    uint32_t count = table->count - table->loose_count;
    table->block_count = table->loose_count > 0;
    if (count > 0) {
        maker->refs = malloc(count * sizeof(*maker->refs));
        if (!maker->refs) {
            return false;
        }
        maker_place(maker, count);
        parallel_run(count > REFS_CHUNK ? threads : 1, refs_work, maker);
        if (!bvh_build(&table->bvh, maker->refs, count, threads) || !maker_count_blocks(maker)) {
            return false;
        }
    }
    if (table->block_count > 0 && !table_reserve(table)) {
        return false;
    }
    for (uint32_t i = 0; i < table->loose_count; i++) {
        slot_fill(maker, i, maker->numbers[i]);
    }
    if (table->loose_count > 0) {
        slots_clear(maker, 0, table->loose_count);
    }
    atomic_store(&maker->next, 0);
    parallel_run(count > REFS_CHUNK ? threads : 1, blocks_work, maker);
    return true;
}

bool sphere_table_init(SphereTable *table, const Scene *scene, int exponent, int threads)
{
    *table = (SphereTable){0};
    size_t count = scene->spheres.count;
    if (count == 0) {
        return true;
    }
    // In two steps, each of which is in range for any exponent that a double can have.
    Maker maker = {.table = table,
                   .scene = scene,
                   .scale = {ldexp(1.0, -(exponent / 2)), ldexp(1.0, -(exponent - exponent / 2))},
                   .numbers = malloc(count * sizeof(*maker.numbers))};
    bool done = maker.numbers && maker_make(&maker, threads);
    free(maker.numbers);
    free(maker.refs);
    free(maker.first_blocks);
    return done;
}

void sphere_table_fini(SphereTable *table)
{
    free(table->blocks);
    free(table->info);
    bvh_fini(&table->bvh);
    *table = (SphereTable){0};
}
