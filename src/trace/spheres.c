// The table of spheres made from a scene, and the choice of its kernels.
//
// Everything is worked out from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
// greater by k gives the same table bit for bit.
//
// SPDX-License-Identifier: MIT
#include "trace/spheres.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/isa.h"
#include "base/pages.h"
#include "base/parallel.h"

enum {
    LOOSE_SPHERES_MOST = SPHERE_BLOCK, // a scene with no more than these has no tree
    RADIUS_SAMPLES = 255,              // radii that the median is taken of
    // A sphere this many times larger than the median is kept out of the tree. A planet under a million grains would
    // otherwise make every box on its way to the root as large as itself.
    LARGE_RADIUS_RATIO = 32,
    CHUNK = 16384,      // spheres that a thread takes at a time
    NODES_CHUNK = 256,  // nodes whose leaves a thread fills at a time
    AHEAD = 24,         // spheres that are asked for before they are needed
};

// ---- kernels

ISA_LIST(SphereKernels, sphere_kernels_, kernels);

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

// What a chunk of the scene's spheres holds: those for the tree, and those that are large.
typedef struct Chunk {
    Vec3 low, high;        // of the centres of both kinds
    double radius_squared; // the greatest of those for the tree
    uint32_t count, large; // usable ones; large ones among them
    uint32_t first;        // where its refs begin
} Chunk;

typedef struct Maker {
    SphereTable *table;
    const Scene *scene;
    double scale[2]; // lengths are multiplied by both
    double limit;    // spheres whose radius squared is above are large, and loose
    Chunk *chunks;
    BvhRef *refs;           // of the spheres for the tree, while it is built
    uint32_t *numbers;      // of the spheres in the tree's order
    uint32_t tree_count;    // of those
    uint32_t *first_blocks; // of each chunk of nodes
    uint32_t loose[LOOSE_SPHERES_MOST];
} Maker;

static double maker_length(const Maker *maker, double length)
{
    return length * maker->scale[0] * maker->scale[1];
}

static inline Ball maker_ball(const Maker *maker, size_t number)
{
    const Sphere *sphere = &maker->scene->spheres.items[number];
    Vec3 c = sphere->centre;
    return ball_make(vec3(maker_length(maker, c.x), maker_length(maker, c.y), maker_length(maker, c.z)),
                     maker_length(maker, sphere->radius));
}

static size_t chunk_count(const Maker *maker)
{
    return (maker->scene->spheres.count + CHUNK - 1) / CHUNK;
}

static size_t chunk_end(const Maker *maker, size_t chunk)
{
    size_t end = (chunk + 1) * CHUNK;
    return end < maker->scene->spheres.count ? end : maker->scene->spheres.count;
}

static int double_compare(const void *a, const void *b)
{
    double x = *(const double *)a;
    double y = *(const double *)b;
    return (x > y) - (x < y);
}

// The square of the radius above which a sphere is large.
static double large_radius_squared(const Maker *maker)
{
    double samples[RADIUS_SAMPLES];
    size_t count = maker->scene->spheres.count;
    size_t sample_count = 0;
    for (size_t i = 0; i < RADIUS_SAMPLES && i < count; i++) {
        double square = maker_ball(maker, i * count / (count < RADIUS_SAMPLES ? count : RADIUS_SAMPLES)).radius_squared;
        if (!isnan(square)) {
            samples[sample_count++] = square;
        }
    }
    qsort(samples, sample_count, sizeof(samples[0]), double_compare);
    return sample_count ? samples[sample_count / 2] * (LARGE_RADIUS_RATIO * LARGE_RADIUS_RATIO) : (double)INFINITY;
}

static void measure_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    Chunk chunk = {.low = {(double)INFINITY, (double)INFINITY, (double)INFINITY},
                   .high = {-(double)INFINITY, -(double)INFINITY, -(double)INFINITY}};
    for (size_t i = begin; i < end; i++) {
        Ball ball = maker_ball(maker, i);
        if (!ball_is_usable(&ball)) {
            continue;
        }
        Vec3 c = ball.centre;
        chunk.count++;
        if (ball.radius_squared > maker->limit) {
            chunk.large++;
            continue;
        }
        chunk.low = vec3_least(chunk.low, c);
        chunk.high = vec3_greatest(chunk.high, c);
        chunk.radius_squared = ball.radius_squared > chunk.radius_squared ? ball.radius_squared : chunk.radius_squared;
    }
    maker->chunks[begin / CHUNK] = chunk;
}

// Threads for work on all spheres of the scene, by chunks.
static void maker_share(Maker *maker, int threads, void (*work)(void *client, size_t begin, size_t end))
{
    parallel_share(threads, maker->scene->spheres.count, CHUNK, work, maker);
}

// Counts usable and large spheres; what is large is loose if there are few of them.
static void maker_measure(Maker *maker, int threads)
{
    maker->limit = large_radius_squared(maker);
    for (;;) {
        uint32_t count = 0;
        uint32_t large = 0;
        maker_share(maker, threads, measure_work);
        for (size_t i = 0; i < chunk_count(maker); i++) {
            maker->chunks[i].first = count - large;
            count += maker->chunks[i].count;
            large += maker->chunks[i].large;
        }
        maker->table->count = count;
        maker->table->loose_count = large;
        if (large <= LOOSE_SPHERES_MOST && (count > LOOSE_SPHERES_MOST || large == count)) {
            return;
        }
        maker->limit = count <= LOOSE_SPHERES_MOST ? -1.0 : (double)INFINITY; // all are loose, or none is
    }
}

static void maker_place(Maker *maker)
{
    Chunk all = maker->chunks[0];
    for (size_t i = 1; i < chunk_count(maker); i++) {
        const Chunk *chunk = &maker->chunks[i];
        all.low = vec3_least(all.low, chunk->low);
        all.high = vec3_greatest(all.high, chunk->high);
        all.radius_squared = chunk->radius_squared > all.radius_squared ? chunk->radius_squared : all.radius_squared;
    }
    // The greatest radius all around also holds spheres too small to show beside their coordinates.
    double radius = sqrt(all.radius_squared);
    Vec3 margin = vec3(radius, radius, radius);
    bvh_place(&maker->table->bvh, vec3_sub(all.low, margin), vec3_add(all.high, margin));
}

static void refs_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    BvhRef *ref = maker->refs + maker->chunks[begin / CHUNK].first;
    for (size_t i = begin; i < end; i++) {
        Ball ball = maker_ball(maker, i);
        if (ball_is_usable(&ball) && ball.radius_squared <= maker->limit) {
            double r = sqrt(ball.radius_squared);
            Vec3 radius = vec3(r, r, r);
            *ref++ = bvh_ref(&maker->table->bvh, vec3_sub(ball.centre, radius), vec3_add(ball.centre, radius),
                             (uint32_t)i);
        }
    }
}

static void maker_list_loose(Maker *maker)
{
    uint32_t count = 0;
    for (size_t chunk = 0; chunk < chunk_count(maker); chunk++) {
        for (size_t i = chunk * CHUNK; maker->chunks[chunk].large > 0 && i < chunk_end(maker, chunk); i++) {
            Ball ball = maker_ball(maker, i);
            if (ball_is_usable(&ball) && ball.radius_squared > maker->limit) {
                maker->loose[count++] = (uint32_t)i;
            }
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

// Leaves follow each other as their nodes do, but the scene's spheres stand anywhere.
static inline void fetch_ahead(const Maker *maker, uint32_t place)
{
    if (place < maker->tree_count) {
        const Sphere *sphere = &maker->scene->spheres.items[maker->numbers[place]];
        __builtin_prefetch(sphere);
        __builtin_prefetch(sphere + 1); // it may lie across two lines
    }
}

// Turns the leaves of a chunk of nodes into blocks.
static void blocks_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    Bvh *bvh = &maker->table->bvh;
    uint32_t block = maker->first_blocks[begin / NODES_CHUNK];
    for (size_t i = begin; i < end; i++) {
        for (int child = 0; child < BVH_WIDTH; child++) {
            BvhChild leaf = bvh->nodes[i].child[child];
            if (!(leaf & BVH_LEAF)) {
                continue;
            }
            uint32_t count = bvh_leaf_count(leaf), first = bvh_leaf_first(leaf);
            for (uint32_t at = 0; at < count; at++) {
                fetch_ahead(maker, first + at + AHEAD);
                slot_fill(maker, block * SPHERE_BLOCK + at, maker->numbers[first + at]);
            }
            slots_clear(maker, block, count);
            bvh->nodes[i].child[child] = BVH_LEAF | block++;
        }
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
    pages_prefer_huge(table->blocks, table->block_count * sizeof(SphereBlock));
    pages_prefer_huge(table->info, slots * sizeof(*table->info));
    return table->blocks && table->info;
}

static void numbers_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    for (size_t i = begin; i < end; i++) {
        maker->numbers[i] = bvh_ref_index(&maker->refs[i]);
    }
}

// Keeps of the refs the numbers only, since the blocks take as much memory as the boxes do.
static bool maker_keep_numbers(Maker *maker, int threads)
{
    maker->numbers = malloc(maker->tree_count * sizeof *maker->numbers);
    if (maker->numbers) {
        parallel_share(threads, maker->tree_count, CHUNK, numbers_work, maker);
    }
    free(maker->refs);
    maker->refs = NULL;
    return maker->numbers != NULL;
}

// The tree over all but the loose spheres.
static bool maker_plant(Maker *maker, uint32_t count, int threads)
{
    maker->tree_count = count;
    maker->refs = malloc(count * sizeof(*maker->refs));
    pages_prefer_huge(maker->refs, count * sizeof(*maker->refs));
    if (!maker->refs) {
        return false;
    }
    maker_place(maker);
    maker_share(maker, threads, refs_work);
    return bvh_build(&maker->table->bvh, maker->refs, count, threads) && maker_keep_numbers(maker, threads) &&
           maker_count_blocks(maker);
}

static bool maker_make(Maker *maker, int threads)
{
    SphereTable *table = maker->table;
    maker_measure(maker, threads);
    uint32_t count = table->count - table->loose_count;
    table->block_count = table->loose_count > 0;
    if (count > 0 && !maker_plant(maker, count, threads)) {
        return false;
    }
    if (table->block_count == 0) {
        return true;
    }
    if (!table_reserve(table)) {
        return false;
    }
    if (table->loose_count > 0) {
        maker_list_loose(maker);
        for (uint32_t i = 0; i < table->loose_count; i++) {
            slot_fill(maker, i, maker->loose[i]);
        }
        slots_clear(maker, 0, table->loose_count);
    }
    parallel_share(threads, table->bvh.node_count, NODES_CHUNK, blocks_work, maker);
    return true;
}

bool sphere_table_init(SphereTable *table, const Scene *scene, int exponent, int threads)
{
    *table = (SphereTable){0};
    if (scene->spheres.count == 0) {
        return true;
    }
    // In two steps, each of which is in range for any exponent that a double can have.
    Maker maker = {.table = table,
                   .scene = scene,
                   .scale = {ldexp(1.0, -(exponent / 2)), ldexp(1.0, -(exponent - exponent / 2))}};
    maker.chunks = malloc(chunk_count(&maker) * sizeof(*maker.chunks));
    bool done = maker.chunks && maker_make(&maker, threads);
    free(maker.chunks);
    free(maker.refs);
    free(maker.numbers);
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
