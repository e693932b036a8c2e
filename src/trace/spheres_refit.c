// Spheres into their slots, boxes of leaves, then boxes of nodes from the leaves up.
//
// Leaves are brought up to date by all threads, a run of nodes each; the rest is a thirtieth of the work. Sums are
// added in the order of nodes, so that whether a tree stays does not depend on the threads.
//
// SPDX-License-Identifier: MIT
#include "trace/spheres_refit.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "trace/sphere_records.h"

enum {
    CHUNK = 16384,     // spheres that a thread measures at a time
    NODES_CHUNK = 256, // nodes whose leaves a thread takes at a time
    THINGS_SAMPLED = 1024,
    PATIENCE_MOST = 16,
};
#define GROWTH_MOST 0.3

// A tree is built again when its boxes have grown by so much, beside the spheres in them or beside the whole. Rays then
// take about as much longer; a new tree costs a sphere about what a ray costs, three times what it costs to be made to
// fit.
static double growth_most(size_t spheres, double rays)
{
    double share = rays > 0.0 ? 0.6 * (double)spheres / rays : GROWTH_MOST;
    return 1.0 + (share < GROWTH_MOST ? share : GROWTH_MOST);
}

typedef struct Refit {
    SphereTable *table;
    SphereRecords records;
    SphereRange moved;
    bool is_whole; // all boxes are made again, in coordinates of their own
    atomic_bool has_failed;
    uint8_t *has_changed; // of each node: one of its boxes
} Refit;

// ---- where they are

typedef struct Bounds {
    Vec3 low, high;
    bool is_usable;
} Bounds;

typedef struct Measure {
    const Refit *refit;
    Bounds *bounds; // of each chunk
} Measure;

static void bounds_add(Bounds *bounds, const SphereRecords *records, size_t begin, size_t end)
{
    for (size_t i = begin; i < end; i++) {
        SphereData ball = sphere_records_ball(records, i);
        bounds->is_usable = bounds->is_usable && sphere_data_is_usable(&ball);
        double r = sqrt(ball.radius_squared);
        Vec3 radius = vec3(r, r, r);
        bounds->low = vec3_least(bounds->low, vec3_sub(ball.centre, radius));
        bounds->high = vec3_greatest(bounds->high, vec3_add(ball.centre, radius));
    }
}

// Loose spheres, which are in their order, are no part of the tree.
static void measure_work(void *client, size_t begin, size_t end)
{
    const Measure *measure = client;
    const Refit *refit = measure->refit;
    const SphereTable *table = refit->table;
    size_t first = refit->moved.begin, from = first + begin;
    Bounds bounds = {{(double)INFINITY, (double)INFINITY, (double)INFINITY},
                     {-(double)INFINITY, -(double)INFINITY, -(double)INFINITY},
                     true};
    for (uint32_t i = 0; i < table->loose_count; i++) {
        size_t loose = sphere_records_number(&refit->records, table->info[i].order);
        if (loose >= from && loose < first + end) {
            bounds_add(&bounds, &refit->records, from, loose);
            from = loose + 1;
        }
    }
    bounds_add(&bounds, &refit->records, from, first + end);
    measure->bounds[begin / CHUNK] = bounds;
}

// The box around what has moved; false when something is beyond all numbers, or out of memory.
static bool measure_moved(const Refit *refit, int threads, Bounds *out)
{
    size_t count = refit->moved.end - refit->moved.begin, chunks = (count + CHUNK - 1) / CHUNK;
    Measure work = {refit, malloc(chunks * sizeof *work.bounds)};
    if (!work.bounds) {
        return false;
    }
    parallel_share(threads, count, CHUNK, measure_work, &work);
    *out = work.bounds[0];
    for (size_t i = 1; i < chunks; i++) {
        out->low = vec3_least(out->low, work.bounds[i].low);
        out->high = vec3_greatest(out->high, work.bounds[i].high);
        out->is_usable = out->is_usable && work.bounds[i].is_usable;
    }
    free(work.bounds);
    return out->is_usable;
}

static bool is_in_root(const Bvh *bvh, const Bounds *bounds)
{
    Vec3 low = vec3_scale(bvh->scale, vec3_sub(bounds->low, bvh->centre));
    Vec3 high = vec3_scale(bvh->scale, vec3_sub(bounds->high, bvh->centre));
    Vec3 half = bvh->half;
    return low.x >= -half.x && low.y >= -half.y && low.z >= -half.z && high.x <= half.x && high.y <= half.y &&
           high.z <= half.z;
}

// Coordinates for the tree that all spheres lie in: those that there are, as long as the moved ones stay in its box.
static bool refit_place(Refit *refit, int threads)
{
    Bvh *bvh = &refit->table->bvh;
    size_t count = refit->records.scene->spheres.count;
    Bounds bounds;
    if (!measure_moved(refit, threads, &bounds)) {
        return false;
    }
    refit->is_whole = refit->moved.begin == 0 && refit->moved.end == count;
    if (!refit->is_whole && !is_in_root(bvh, &bounds)) {
        refit->is_whole = true;
        refit->moved = (SphereRange){0, count};
        if (!measure_moved(refit, threads, &bounds)) {
            return false;
        }
    }
    if (refit->is_whole) {
        Bvh placed;
        bvh_place(&placed, bounds.low, bounds.high);
        bvh->centre = placed.centre;
        bvh->scale = placed.scale;
        bvh->half = placed.half;
    }
    return true;
}

// ---- leaves

static inline bool is_empty(const SphereBlock *block, uint32_t at)
{
    return isnan(block->radius_squared[at]);
}

// Takes the moved spheres of a block; false when there are none. The blocks from `end` on are another thread's.
static bool block_take(Refit *refit, uint32_t number, uint32_t end)
{
    SphereBlock *block = &refit->table->blocks[number];
    ShapeInfo *info = &refit->table->info[number * SPHERE_BLOCK];
    const SphereRecords *records = &refit->records;
    bool has_any = false;
    for (uint32_t at = 0; at < SPHERE_BLOCK && !is_empty(block, at); at++) {
        uint32_t sphere = sphere_records_number(records, info[at].order);
        if (sphere < refit->moved.begin || sphere >= refit->moved.end) {
            continue;
        }
        if (refit->is_whole && number + SPHERES_AHEAD / SPHERE_BLOCK < end) {
            uint32_t ahead = sphere_records_number(records, info[at + SPHERES_AHEAD].order);
            sphere_records_fetch(records, ahead < records->scene->spheres.count ? ahead : sphere);
        }
        SphereData ball = sphere_records_ball(records, sphere);
        if (!sphere_data_is_usable(&ball)) {
            atomic_store(&refit->has_failed, true);
            break;
        }
        sphere_block_put(block, at, &ball);
        info[at] = sphere_records_info(records, sphere);
        has_any = true;
    }
    return has_any;
}

// The box of a leaf, as the boxes of its spheres are where a tree is built.
static void block_box(const Bvh *bvh, const SphereBlock *block, BvhNode *node, int child)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t at = 0; at < SPHERE_BLOCK && !is_empty(block, at); at++) {
        double r = sqrt(block->radius_squared[at]);
        Vec3 centre = vec3(block->x[at], block->y[at], block->z[at]), radius = vec3(r, r, r);
        BvhRef ref = bvh_ref(bvh, vec3_sub(centre, radius), vec3_add(centre, radius), 0);
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = ref.low[axis] < low[axis] ? ref.low[axis] : low[axis];
            high[axis] = ref.high[axis] > high[axis] ? ref.high[axis] : high[axis];
        }
    }
    for (int axis = 0; axis < 3; axis++) {
        node->box[axis][0][child] = low[axis];
        node->box[axis][1][child] = high[axis];
    }
}

// The blocks of the leaves of some nodes end before this one.
static uint32_t blocks_end(const Bvh *bvh, size_t begin, size_t end)
{
    for (size_t i = end * BVH_WIDTH; i-- > begin * BVH_WIDTH;) {
        BvhChild leaf = bvh->nodes[i / BVH_WIDTH].child[i % BVH_WIDTH];
        if (leaf & BVH_LEAF) {
            return (leaf & ~BVH_LEAF) + 1;
        }
    }
    return 0;
}

static void leaves_work(void *client, size_t begin, size_t end)
{
    Refit *refit = client;
    const Bvh *bvh = &refit->table->bvh;
    uint32_t blocks = blocks_end(bvh, begin, end);
    for (size_t i = begin; i < end; i++) {
        BvhNode *node = &bvh->nodes[i];
        bool has_changed = false;
        for (int child = 0; child < BVH_WIDTH; child++) {
            BvhChild leaf = node->child[child];
            if ((leaf & BVH_LEAF) && block_take(refit, leaf & ~BVH_LEAF, blocks)) {
                block_box(bvh, &refit->table->blocks[leaf & ~BVH_LEAF], node, child);
                has_changed = true;
            }
        }
        refit->has_changed[i] = has_changed;
    }
}

// ---- nodes, from the last to the first: children come behind their parents

static void node_join(BvhNode *node, int child, const BvhNode *below)
{
    for (int axis = 0; axis < 3; axis++) {
        float low = INFINITY, high = -INFINITY;
        for (int i = 0; i < BVH_WIDTH; i++) {
            low = below->box[axis][0][i] < low ? below->box[axis][0][i] : low;
            high = below->box[axis][1][i] > high ? below->box[axis][1][i] : high;
        }
        node->box[axis][0][child] = low;
        node->box[axis][1][child] = high;
    }
}

static void refit_nodes(Refit *refit)
{
    const Bvh *bvh = &refit->table->bvh;
    for (uint32_t i = bvh->node_count; i-- > 0;) {
        BvhNode *node = &bvh->nodes[i];
        for (int child = 0; child < BVH_WIDTH; child++) {
            BvhChild below = node->child[child];
            if (!(below & BVH_LEAF) && below != BVH_CHILD_NONE && refit->has_changed[below]) {
                node_join(node, child, &bvh->nodes[below]);
                refit->has_changed[i] = 1;
            }
        }
    }
}

// ---- what the tree costs rays

typedef struct Areas {
    const Bvh *bvh;
    double *sums; // of each chunk of nodes
} Areas;

// Of the boxes of all children; empty ones count nothing.
static double node_areas(const BvhNode *node)
{
    float sum[BVH_WIDTH];
    for (int child = 0; child < BVH_WIDTH; child++) {
        float x = node->box[0][1][child] - node->box[0][0][child];
        float y = node->box[1][1][child] - node->box[1][0][child];
        float z = node->box[2][1][child] - node->box[2][0][child];
        sum[child] = x >= 0.0f ? x * y + y * z + z * x : 0.0f;
    }
    return ((double)sum[0] + sum[1] + sum[2] + sum[3]) + ((double)sum[4] + sum[5] + sum[6] + sum[7]);
}

static void areas_work(void *client, size_t begin, size_t end)
{
    const Areas *areas = client;
    double sum = 0.0;
    for (size_t i = begin; i < end; i++) {
        sum += node_areas(&areas->bvh->nodes[i]);
    }
    areas->sums[begin / NODES_CHUNK] = sum;
}

static double root_area(const Bvh *bvh)
{
    BvhNode whole;
    bvh_node_clear(&whole);
    node_join(&whole, 0, &bvh->nodes[0]);
    return node_areas(&whole);
}

// Of the boxes of spheres, about: some of them tell.
static double things_area(const SphereTable *table)
{
    uint32_t slots = table->block_count * SPHERE_BLOCK, stride = slots / THINGS_SAMPLED + 1, count = 0;
    double sum = 0.0;
    for (uint32_t slot = 0; slot < slots; slot += stride) {
        double square = table->blocks[slot / SPHERE_BLOCK].radius_squared[slot % SPHERE_BLOCK];
        if (!isnan(square)) {
            sum += square;
            count++;
        }
    }
    return sum / count * 12.0 * table->count * table->bvh.scale * table->bvh.scale;
}

// False when out of memory.
static bool measure_areas(const SphereTable *table, int threads, SphereRefit *out)
{
    const Bvh *bvh = &table->bvh;
    Areas areas = {bvh, malloc((bvh->node_count / NODES_CHUNK + 1) * sizeof *areas.sums)};
    if (!areas.sums) {
        return false;
    }
    parallel_share(threads, bvh->node_count, NODES_CHUNK, areas_work, &areas);
    double sum = 0.0;
    for (size_t i = 0; i * NODES_CHUNK < bvh->node_count; i++) {
        sum += areas.sums[i];
    }
    free(areas.sums);
    out->in_things = sum / things_area(table);
    out->in_root = sum / root_area(bvh);
    return true;
}

// Whether the boxes of a tree are still about as small as those of a new one would be: beside the spheres, and beside
// the whole, one of which follows when everything goes apart or together.
static bool is_good(const SphereRefit *built, const SphereRefit *now, double growth)
{
    return now->in_things <= growth * built->in_things && now->in_root <= growth * built->in_root;
}

// ---- the whole

static bool refit_tree(Refit *refit, SphereRefit *state, double growth, int threads)
{
    const Bvh *bvh = &refit->table->bvh;
    SphereRefit now;
    if ((state->in_root == 0.0 && !measure_areas(refit->table, threads, state)) || !refit_place(refit, threads)) {
        return false;
    }
    refit->has_changed = malloc(bvh->node_count);
    if (refit->table->loose_count > 0) {
        (void)block_take(refit, 0, 0);
    }
    if (refit->has_changed) {
        parallel_share(threads, bvh->node_count, NODES_CHUNK, leaves_work, refit);
        refit_nodes(refit);
    }
    bool is_done = refit->has_changed != NULL && !atomic_load(&refit->has_failed);
    free(refit->has_changed);
    return is_done && measure_areas(refit->table, threads, &now) && is_good(state, &now, growth);
}

bool sphere_table_refit(SphereTable *table, SphereRefit *state, const Scene *scene, int exponent,
                        const SphereMoves *moves)
{
    Refit refit = {.table = table, .records = sphere_records(scene, exponent), .moved = moves->range};
    if (table->count != scene->spheres.count || table->bvh.node_count == 0) {
        return false; // some are left out, or all are loose
    }
    if (state->skip > 0) {
        state->skip--;
        return false;
    }
    bool is_done = refit_tree(&refit, state, growth_most(table->count, moves->rays), moves->threads);
    if (is_done) {
        sphere_table_measure(table);
        state->fits++;
        state->patience = 0;
        return true;
    }
    if (state->fits > 0) {
        return false; // it was worth it
    }
    state->patience = state->patience == 0 ? 1 : state->patience < PATIENCE_MOST ? 2 * state->patience : PATIENCE_MOST;
    state->skip = state->patience;
    return false;
}
