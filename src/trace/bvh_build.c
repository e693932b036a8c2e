// Builds the tree of boxes, on several threads when it is large.
//
// Every step is bounded: the depth (ranges are halved when the heuristic has gone deep enough or cannot separate its
// things), and the time, n log n for any input, a million coincident boxes among them. Threads take whole ranges from a
// common stack and make nodes in pools of their own; in the end the nodes are numbered in depth-first order, so that
// the tree does not show who built what.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "base/parallel.h"
#include "trace/bvh_split.h"

enum {
    POOL_CHUNK_NODES = 256,
    // A range this small is built by one thread; a whole tree this small on one alone.
    TASK_REFS_LEAST = 4096,
    BUILDERS_MOST = 16,
    TASKS_MOST = 4096, // ranges that wait; what does not fit is built at once
};

typedef struct Task {
    Range range;
    BvhChild *place; // where the number of its node goes
} Task;

typedef struct Pool {
    BvhNode **chunks;
    uint32_t count, room; // nodes made; chunks there is room for
} Pool;

typedef struct Builder {
    BvhRef *refs;
    Pool pools[BUILDERS_MOST];
    pthread_mutex_t lock; // of all below
    pthread_cond_t changed;
    Task tasks[TASKS_MOST];
    unsigned waiting, busy; // tasks; threads that have one
    bool failed;
} Builder;

// ---- coordinates

void bvh_place(Bvh *bvh, Vec3 low, Vec3 high)
{
    Vec3 half = vec3_sub(vec3_scale(0.5, high), vec3_scale(0.5, low));
    int exponent;
    frexp(vec3_max_abs(half), &exponent);
    exponent = exponent < DBL_MIN_EXP ? DBL_MIN_EXP : exponent; // so that the scale is finite
    *bvh = (Bvh){.centre = vec3_add(vec3_scale(0.5, high), vec3_scale(0.5, low)), .scale = ldexp(1.0, -exponent)};
    bvh->half = vec3_scale(bvh->scale, half);
}

// Rounded outward: a conversion to float is off by at most 2^-24 of the value.
static inline float float_below(double x)
{
    return (float)(x - fabs(x) * 0x1p-23);
}

static inline float float_above(double x)
{
    return (float)(x + fabs(x) * 0x1p-23);
}

BvhRef bvh_ref(const Bvh *bvh, Vec3 low, Vec3 high, uint32_t index)
{
    Vec3 a = vec3_scale(bvh->scale, vec3_sub(low, bvh->centre));
    Vec3 b = vec3_scale(bvh->scale, vec3_sub(high, bvh->centre));
    uint32_t bits[2] = {0x3f800000u | (index & 0x7fffffu), 0x3f800000u | index >> 23};
    float parts[2];
    memcpy(parts, bits, sizeof(parts));
    return (BvhRef){{float_below(a.x), float_below(a.y), float_below(a.z), parts[0]},
                    {float_above(b.x), float_above(b.y), float_above(b.z), parts[1]}};
}

uint32_t bvh_ref_index(const BvhRef *ref)
{
    const float parts[2] = {ref->low[3], ref->high[3]};
    uint32_t bits[2];
    memcpy(bits, parts, sizeof(bits));
    return (bits[0] & 0x7fffffu) | (bits[1] & 0x1ffu) << 23;
}

// ---- nodes

// A new node of the pool and its number for now, thread and place; NULL when out of memory.
static BvhNode *pool_node(Pool *pool, int thread, BvhChild *number)
{
    uint32_t chunk = pool->count / POOL_CHUNK_NODES;
    if (chunk == pool->room) {
        uint32_t room = pool->room ? 2 * pool->room : 16;
        BvhNode **chunks = realloc(pool->chunks, room * sizeof(*chunks));
        if (!chunks) {
            return NULL;
        }
        pool->chunks = chunks;
        pool->room = room;
    }
    if (pool->count % POOL_CHUNK_NODES == 0) {
        pool->chunks[chunk] = aligned_alloc(_Alignof(BvhNode), POOL_CHUNK_NODES * sizeof(BvhNode));
        if (!pool->chunks[chunk]) {
            return NULL;
        }
    }
    *number = (uint32_t)thread << 26 | pool->count;
    return &pool->chunks[chunk][pool->count++ % POOL_CHUNK_NODES];
}

static const BvhNode *builder_node(const Builder *builder, BvhChild number)
{
    uint32_t place = number & ((1u << 26) - 1);
    return &builder->pools[number >> 26].chunks[place / POOL_CHUNK_NODES][place % POOL_CHUNK_NODES];
}

static void node_clear(BvhNode *node)
{
    for (int child = 0; child < BVH_WIDTH; child++) {
        for (int axis = 0; axis < 3; axis++) {
            node->box[axis][0][child] = INFINITY;
            node->box[axis][1][child] = -INFINITY;
        }
        node->child[child] = BVH_CHILD_NONE;
        node->unused[child] = 0;
    }
}

// Splits the child of the largest box, again and again, until there are eight or all are leaves.
static int node_split(BvhRef *refs, const Range *range, Range children[BVH_WIDTH])
{
    int count = 1;
    children[0] = *range;
    while (count < BVH_WIDTH) {
        int largest = -1;
        float largest_area = -1.0f;
        for (int i = 0; i < count; i++) {
            float area = box_half_area(&children[i].box);
            if (range_count(&children[i]) > BVH_LEAF_MOST && !(area <= largest_area)) {
                largest = i;
                largest_area = area;
            }
        }
        if (largest < 0) {
            break;
        }
        Range parent = children[largest];
        range_split(refs, &parent, &children[largest], &children[count++]);
    }
    return count;
}

// Leaves a range for whichever thread is free; false when too many wait already.
static bool builder_push(Builder *builder, const Task *task)
{
    pthread_mutex_lock(&builder->lock);
    bool fits = builder->waiting < TASKS_MOST;
    if (fits) {
        builder->tasks[builder->waiting++] = *task;
        pthread_cond_signal(&builder->changed);
    }
    pthread_mutex_unlock(&builder->lock);
    return fits;
}

// Makes the node of a range and all below it; large ranges are left for whichever thread is free. The recursion is no
// deeper than the tree.
static bool builder_make(Builder *builder, int thread, const Task *task)
{
    BvhNode *node = pool_node(&builder->pools[thread], thread, task->place);
    if (!node) {
        return false;
    }
    node_clear(node);
    Range children[BVH_WIDTH];
    int count = node_split(builder->refs, &task->range, children);
    bool done = true;
    for (int i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            node->box[axis][0][i] = children[i].box.low[axis];
            node->box[axis][1][i] = children[i].box.high[axis];
        }
        uint32_t refs = range_count(&children[i]);
        Task below = {children[i], &node->child[i]};
        if (refs <= BVH_LEAF_MOST) {
            node->child[i] = bvh_leaf(children[i].begin, refs);
        } else if (refs <= TASK_REFS_LEAST || !builder_push(builder, &below)) {
            done = done && builder_make(builder, thread, &below);
        }
    }
    return done;
}

static void builder_work(void *client, int thread)
{
    Builder *builder = client;
    pthread_mutex_lock(&builder->lock);
    while (!builder->failed && (builder->waiting > 0 || builder->busy > 0)) {
        if (builder->waiting == 0) {
            pthread_cond_wait(&builder->changed, &builder->lock);
            continue;
        }
        Task task = builder->tasks[--builder->waiting];
        builder->busy++;
        pthread_mutex_unlock(&builder->lock);
        bool done = builder_make(builder, thread, &task);
        pthread_mutex_lock(&builder->lock);
        builder->busy--;
        builder->failed = builder->failed || !done;
    }
    pthread_cond_broadcast(&builder->changed);
    pthread_mutex_unlock(&builder->lock);
}

// Copies a node and all below it, depth first.
static void builder_copy(const Builder *builder, Bvh *bvh, BvhChild from)
{
    BvhNode *node = &bvh->nodes[bvh->node_count++];
    *node = *builder_node(builder, from);
    for (int i = 0; i < BVH_WIDTH; i++) {
        BvhChild child = node->child[i];
        if (!(child & BVH_LEAF) && child != BVH_CHILD_NONE) {
            node->child[i] = bvh->node_count;
            builder_copy(builder, bvh, child);
        }
    }
}

static void builder_fini(Builder *builder)
{
    for (int i = 0; i < BUILDERS_MOST; i++) {
        Pool *pool = &builder->pools[i];
        for (uint32_t chunk = 0; chunk * POOL_CHUNK_NODES < pool->count; chunk++) {
            free(pool->chunks[chunk]);
        }
        free(pool->chunks);
    }
    pthread_cond_destroy(&builder->changed);
    pthread_mutex_destroy(&builder->lock);
    free(builder);
}

bool bvh_build(Bvh *bvh, BvhRef *refs, uint32_t count, int threads)
{
    Builder *builder = calloc(1, sizeof(*builder));
    if (!builder) {
        return false;
    }
    builder->refs = refs;
    pthread_mutex_init(&builder->lock, NULL);
    pthread_cond_init(&builder->changed, NULL);
    BvhChild root = 0;
    builder->tasks[builder->waiting++] = (Task){range_measure(refs, 0, count, 0), &root};
    int builders = threads < BUILDERS_MOST ? threads : BUILDERS_MOST;
    parallel_run(count > 4 * TASK_REFS_LEAST ? builders : 1, builder_work, builder);
    size_t node_count = 0;
    for (int i = 0; i < BUILDERS_MOST; i++) {
        node_count += builder->pools[i].count;
    }
    BvhNode *nodes = builder->failed ? NULL : aligned_alloc(_Alignof(BvhNode), node_count * sizeof(BvhNode));
    pages_prefer_huge(nodes, node_count * sizeof(BvhNode));
    if (nodes) {
        bvh->nodes = nodes;
        bvh->node_count = 0;
        builder_copy(builder, bvh, root);
    }
    builder_fini(builder);
    return nodes != NULL;
}

void bvh_fini(Bvh *bvh)
{
    free(bvh->nodes);
    *bvh = (Bvh){0};
}
