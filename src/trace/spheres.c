// The table of spheres made from a scene, and the choice of its kernels.
//
// Everything is computed from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
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
#include "trace/sphere_records.h"

enum {
    LOOSE_SPHERES_MOST = SPHERE_BLOCK, // a scene with no more than these has no tree
    RADIUS_SAMPLES = 255,              // radii that the median is taken of
    // A sphere this many times larger than the median is kept out of the tree. A planet under a million grains would
    // otherwise make every box on its way to the root as large as itself.
    LARGE_RADIUS_RATIO = 32,
    CHUNK = 16384,      // spheres that a thread takes at a time
    NODES_CHUNK = 256,  // nodes whose leaves a thread fills at a time
    AHEAD = SPHERES_AHEAD,
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
    SphereRecords records; // of the scene
    double limit;    // spheres whose radius squared is above are large, and loose
    Chunk *chunks;
    size_t spare;           // blocks behind those of the table
    Scene *spent;           // the scene, if its spheres may be given up
    BvhRef *refs;           // of the spheres for the tree; in `ref_pages`
    Pages ref_pages;
    uint32_t tree_count;    // of those
    uint32_t *first_blocks; // of each chunk of nodes
    SphereBlock loose;
    const atomic_bool *cancel; // of building the tree
} Maker;

static inline SphereData maker_ball(const Maker *maker, size_t number)
{
    return sphere_records_ball(&maker->records, number);
}

static inline ShapeInfo maker_info(const Maker *maker, uint32_t number)
{
    return sphere_records_info(&maker->records, number);
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
        SphereData ball = maker_ball(maker, i);
        if (!sphere_data_is_usable(&ball)) {
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
        SphereData ball = maker_ball(maker, i);
        if (sphere_data_is_usable(&ball) && ball.radius_squared <= maker->limit) {
            double r = sqrt(ball.radius_squared);
            Vec3 radius = vec3(r, r, r);
            *ref++ = bvh_ref(&maker->table->bvh, vec3_sub(ball.centre, radius), vec3_add(ball.centre, radius),
                             (uint32_t)i);
        }
    }
}

static void block_clear(SphereBlock *block, uint32_t begin)
{
    for (uint32_t at = begin; at < SPHERE_BLOCK; at++) {
        sphere_block_put(block, at, &(SphereData){.radius_squared = (double)NAN});
    }
}

// The first block, if there are loose spheres.
static void maker_take_loose(Maker *maker)
{
    uint32_t count = 0;
    for (size_t chunk = 0; chunk < chunk_count(maker); chunk++) {
        for (size_t i = chunk * CHUNK; maker->chunks[chunk].large > 0 && i < chunk_end(maker, chunk); i++) {
            SphereData ball = maker_ball(maker, i);
            if (sphere_data_is_usable(&ball) && ball.radius_squared > maker->limit) {
                sphere_block_put(&maker->loose, count, &ball);
                maker->table->info[count++] = maker_info(maker, (uint32_t)i);
            }
        }
    }
    block_clear(&maker->loose, count);
    for (uint32_t at = count; count > 0 && at < SPHERE_BLOCK; at++) {
        maker->table->info[at] = (ShapeInfo){0, 0};
    }
}

// ---- from the tree's order to blocks
//
// Leaves follow each other as their nodes do, but the scene's spheres stand anywhere. First each slot learns which sphere
// it holds; then the blocks are filled. Where the scene's spheres are given up, they are put in order in the memory of the
// refs, and are gone before there are blocks: neither way has all three in memory at once.

_Static_assert(sizeof(BvhRef) == sizeof(SphereData), "a ball takes the place of a ref");

// Puts the spheres of a leaf in the place of their refs, and says what their slots hold. The refs from `end` on are
// another thread's.
static void leaf_take(const Maker *maker, uint32_t first, uint32_t count, uint32_t end, ShapeInfo *info)
{
    for (uint32_t at = 0; at < count; at++) {
        uint32_t ahead = first + at + AHEAD;
        if (ahead < end) {
            sphere_records_fetch(&maker->records, bvh_ref_index(&maker->refs[ahead]));
        }
        uint32_t number = bvh_ref_index(&maker->refs[first + at]);
        SphereData ball = maker_ball(maker, number);
        memcpy(&maker->refs[first + at], &ball, sizeof ball);
        info[at] = maker_info(maker, number);
    }
}

static void leaf_number(const Maker *maker, uint32_t first, uint32_t count, uint32_t end, ShapeInfo *info)
{
    (void)end;
    for (uint32_t at = 0; at < count; at++) {
        info[at] = (ShapeInfo){0, bvh_ref_index(&maker->refs[first + at])};
    }
}

// The blocks from `end` on are another thread's.
static void leaf_fill(const Maker *maker, uint32_t first, uint32_t count, uint32_t block, uint32_t end)
{
    SphereBlock *spheres = &maker->table->blocks[block];
    ShapeInfo *info = &maker->table->info[block * SPHERE_BLOCK];
    uint32_t slots = (end - block) * SPHERE_BLOCK;
    for (uint32_t at = 0; at < count; at++) {
        SphereData ball;
        if (maker->refs) {
            memcpy(&ball, &maker->refs[first + at], sizeof ball);
        } else {
            uint32_t number = info[at].order;
            sphere_records_fetch(&maker->records, at + AHEAD < slots ? info[at + AHEAD].order : number);
            ball = maker_ball(maker, number);
            info[at] = maker_info(maker, number);
        }
        sphere_block_put(spheres, at, &ball);
    }
    block_clear(spheres, count);
}

// Behind the refs of some nodes.
static uint32_t refs_end(const Bvh *bvh, size_t begin, size_t end)
{
    for (size_t i = end * BVH_WIDTH; i-- > begin * BVH_WIDTH;) {
        BvhChild leaf = bvh->nodes[i / BVH_WIDTH].child[i % BVH_WIDTH];
        if (leaf & BVH_LEAF) {
            return bvh_leaf_first(leaf) + bvh_leaf_count(leaf);
        }
    }
    return 0;
}

static void slots_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    const Bvh *bvh = &maker->table->bvh;
    uint32_t last = refs_end(bvh, begin, end);
    uint32_t block = maker->first_blocks[begin / NODES_CHUNK];
    for (size_t i = begin * BVH_WIDTH; i < end * BVH_WIDTH; i++) {
        BvhChild leaf = bvh->nodes[i / BVH_WIDTH].child[i % BVH_WIDTH];
        if (leaf & BVH_LEAF) {
            ShapeInfo *info = &maker->table->info[block++ * SPHERE_BLOCK];
            uint32_t count = bvh_leaf_count(leaf);
            (maker->spent ? leaf_take : leaf_number)(maker, bvh_leaf_first(leaf), count, last, info);
            for (uint32_t at = count; at < SPHERE_BLOCK; at++) {
                info[at] = (ShapeInfo){0, 0};
            }
        }
    }
}

static void blocks_work(void *client, size_t begin, size_t end)
{
    const Maker *maker = client;
    Bvh *bvh = &maker->table->bvh;
    uint32_t block = maker->first_blocks[begin / NODES_CHUNK];
    uint32_t last = end < bvh->node_count ? maker->first_blocks[end / NODES_CHUNK] : maker->table->block_count;
    for (size_t i = begin * BVH_WIDTH; i < end * BVH_WIDTH; i++) {
        BvhChild *leaf = &bvh->nodes[i / BVH_WIDTH].child[i % BVH_WIDTH];
        if (*leaf & BVH_LEAF) {
            leaf_fill(maker, bvh_leaf_first(*leaf), bvh_leaf_count(*leaf), block, last);
            *leaf = BVH_LEAF | block++;
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

// The tree over all but the loose spheres.
static bool maker_plant(Maker *maker, uint32_t count, int threads)
{
    maker->tree_count = count;
    if (!pages_take(&maker->ref_pages, count * sizeof(*maker->refs))) {
        return false;
    }
    maker->refs = maker->ref_pages.memory;
    maker_place(maker);
    maker_share(maker, threads, refs_work);
    return bvh_build(&maker->table->bvh, maker->refs, count, BVH_LEAF_EIGHT, threads, maker->cancel) &&
           maker_count_blocks(maker);
}

static bool maker_number_slots(Maker *maker, int threads)
{
    SphereTable *table = maker->table;
    if (!pages_take(&table->info_pages, (size_t)table->block_count * SPHERE_BLOCK * sizeof(*table->info))) {
        return false;
    }
    table->info = table->info_pages.memory;
    maker_take_loose(maker);
    parallel_share(threads, table->bvh.node_count, NODES_CHUNK, slots_work, maker);
    if (maker->spent) {
        ARRAY_FREE(&maker->spent->spheres);
        scene_spheres_change(maker->spent);
    } else {
        pages_give(&maker->ref_pages);
        maker->refs = NULL;
    }
    return true;
}

static bool maker_fill_blocks(Maker *maker, int threads)
{
    SphereTable *table = maker->table;
    if (!pages_take(&table->block_pages, (table->block_count + maker->spare) * sizeof(SphereBlock))) {
        return false;
    }
    table->blocks = table->block_pages.memory;
    if (table->loose_count > 0) {
        table->blocks[0] = maker->loose;
    }
    parallel_share(threads, table->bvh.node_count, NODES_CHUNK, blocks_work, maker);
    return true;
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
    return table->block_count == 0 || (maker_number_slots(maker, threads) && maker_fill_blocks(maker, threads));
}

void sphere_table_measure(SphereTable *table)
{
    table->reach = 0.0;
    table->radius_least = (double)INFINITY;
    for (uint32_t i = 0; sphere_table_is_few(table) && i < table->block_count * SPHERE_BLOCK; i++) {
        SphereData ball = sphere_table_ball(table, i);
        if (!isnan(ball.radius_squared)) {
            Vec3 c = ball.centre;
            double radius = sqrt(ball.radius_squared);
            table->reach = fmax(table->reach, fabs(c.x) + fabs(c.y) + fabs(c.z) + radius);
            table->radius_least = fmin(table->radius_least, radius);
        }
    }
}

bool sphere_table_init(SphereTable *table, const Scene *scene, int exponent, int threads, Scene *spent, size_t spare,
                       const atomic_bool *cancel)
{
    *table = (SphereTable){0};
    if (scene->spheres.count == 0) {
        return true;
    }
    Maker maker = {.table = table,
                   .scene = scene,
                   .spent = spent,
                   .spare = spare,
                   .records = sphere_records(scene, exponent),
                   .cancel = cancel};
    maker.chunks = malloc(chunk_count(&maker) * sizeof(*maker.chunks));
    bool done = maker.chunks && maker_make(&maker, threads);
    free(maker.chunks);
    pages_give(&maker.ref_pages);
    free(maker.first_blocks);
    if (done) {
        sphere_table_measure(table);
    }
    return done;
}

void sphere_table_fini(SphereTable *table)
{
    pages_give(&table->block_pages);
    pages_give(&table->info_pages);
    bvh_fini(&table->bvh);
    *table = (SphereTable){0};
}
