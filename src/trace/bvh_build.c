// Builds the tree of boxes, on several threads when it is large.
//
// Every step is bounded: the depth (ranges are halved when the heuristic has gone deep enough or cannot separate its
// things), and the time, n log n for any input, a million coincident boxes among them. The first node's range is cut by
// all threads together; then they take whole ranges from a common stack. In the end the nodes are moved into depth-first
// order, in place, so that the tree does not show who built what.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "trace/bvh_split.h"

enum {
    SUPPLY_NODES = 64,
    // A range this small is built by one thread; a whole tree this small on one alone.
    TASK_REFS_LEAST = 4096,
    BUILDERS_MOST = 16,
    TASKS_MOST = 4096, // ranges that wait; what does not fit is built at once
};

typedef struct Task {
    Range range;
    BvhChild *place; // where the number of its node goes
} Task;

// The nodes that a thread may make next; apart from those of the others.
typedef struct Supply {
    uint32_t next, end;
    char line_of_cache[56];
} Supply;

typedef struct Builder {
    BvhRef *refs;
    BvhNode *nodes;
    const atomic_bool *cancel; // what is left is then made as nodes without children; NULL: never
    Supply supplies[BUILDERS_MOST];
    atomic_uint next_node; // the first that is in no supply
    pthread_mutex_t lock; // of all below
    pthread_cond_t changed;
    Task tasks[TASKS_MOST];
    unsigned waiting, busy; // tasks; threads that have one
    BvhRef spares[BUILDERS_MOST][RANGE_SPARE]; // room of each thread, too large for its stack
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

// ---- nodes

// How many nodes a tree may have. A node that is not full has leaves only, so that one with k nodes below it has 8 - k
// leaves, and all but the root hold more things than a leaf: by induction n things have at most (n - 2) / 7 nodes, or the
// root, where leaves hold eight. Leaves of one thing: F full nodes and E others have 8 F + 2 E children or more, of which
// F + E - 1 are nodes and the rest n leaves, so 7 F + E < n, and E is at most n / 2: at most 4 n / 7 nodes. What is left
// of each thread's supply comes to that.
static size_t nodes_most(uint32_t count, unsigned leaf_bits, int builders)
{
    size_t nodes = leaf_bits == BVH_LEAF_EIGHT ? count / 7 : (size_t)count * 4 / 7;
    return 1 + nodes + (size_t)builders * SUPPLY_NODES;
}

// The number of a new node, for now.
static BvhChild builder_node(Builder *builder, int thread)
{
    Supply *supply = &builder->supplies[thread];
    if (supply->next == supply->end) {
        supply->next = atomic_fetch_add(&builder->next_node, SUPPLY_NODES);
        supply->end = supply->next + SUPPLY_NODES;
    }
    return supply->next++;
}

static bool is_cancelled(const Builder *builder)
{
    return builder->cancel && atomic_load_explicit(builder->cancel, memory_order_relaxed);
}

// Splits the child of the largest box, again and again, until there are eight or all are leaves.
static int node_split(Builder *builder, const Range *range, int threads, BvhRef spare[RANGE_SPARE],
                      Range children[BVH_WIDTH])
{
    int count = 1;
    children[0] = *range;
    while (count < BVH_WIDTH && !is_cancelled(builder)) {
        int largest = -1;
        float largest_area = -1.0f;
        for (int i = 0; i < count; i++) {
            float area = box_half_area(&children[i].box);
            if (!range_is_leaf(&children[i]) && !(area <= largest_area)) {
                largest = i;
                largest_area = area;
            }
        }
        if (largest < 0) {
            break;
        }
        Range parent = children[largest];
        range_split(builder->refs, &parent, threads, spare, &children[largest], &children[count++]);
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
static void builder_make(Builder *builder, int thread, int splitters, const Task *task)
{
    BvhChild number = builder_node(builder, thread);
    BvhNode *node = &builder->nodes[number];
    *task->place = number;
    bvh_node_clear(node);
    Range children[BVH_WIDTH];
    int count = node_split(builder, &task->range, splitters, builder->spares[thread], children);
    if (is_cancelled(builder)) {
        return;
    }
    node->present = (1u << count) - 1;
    for (int i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            node->box[axis][0][i] = children[i].box.low[axis];
            node->box[axis][1][i] = children[i].box.high[axis];
        }
        Task below = {children[i], &node->child[i]};
        if (range_is_leaf(&children[i])) {
            node->child[i] = bvh_leaf(children[i].begin, range_count(&children[i]));
        } else if (range_count(&children[i]) <= TASK_REFS_LEAST || !builder_push(builder, &below)) {
            builder_make(builder, thread, 1, &below);
        }
    }
}

static void builder_work(void *client, int thread)
{
    Builder *builder = client;
    pthread_mutex_lock(&builder->lock);
    while (builder->waiting > 0 || builder->busy > 0) {
        if (builder->waiting == 0) {
            pthread_cond_wait(&builder->changed, &builder->lock);
            continue;
        }
        Task task = builder->tasks[--builder->waiting];
        builder->busy++;
        pthread_mutex_unlock(&builder->lock);
        builder_make(builder, thread, 1, &task);
        pthread_mutex_lock(&builder->lock);
        builder->busy--;
    }
    pthread_cond_broadcast(&builder->changed);
    pthread_mutex_unlock(&builder->lock);
}

// ---- the order of nodes

// Numbers a node and all below it, depth first; `from`: which node goes to each place.
static void number_nodes(Bvh *bvh, uint32_t *from, BvhChild node)
{
    from[bvh->node_count++] = node;
    for (int i = 0; i < BVH_WIDTH; i++) {
        BvhChild *place = &bvh->nodes[node].child[i], child = *place;
        if (!(child & BVH_LEAF) && child != BVH_CHILD_NONE) {
            *place = bvh->node_count;
            number_nodes(bvh, from, child);
        }
    }
}

// Moves each node to its place. What stood in a place that is done has gone where the node for that place came from.
static void move_nodes(const Bvh *bvh, const uint32_t *from)
{
    for (uint32_t to = 0; to < bvh->node_count; to++) {
        uint32_t at = from[to];
        while (at < to) {
            at = from[at];
        }
        if (at != to) {
            BvhNode kept = bvh->nodes[to];
            bvh->nodes[to] = bvh->nodes[at];
            bvh->nodes[at] = kept;
        }
    }
}

// Depth first, with nothing between them.
static bool order_nodes(Bvh *bvh, uint32_t made, BvhChild root)
{
    uint32_t *from = malloc(made * sizeof *from);
    if (from) {
        number_nodes(bvh, from, root);
        move_nodes(bvh, from);
        pages_trim(&bvh->pages, bvh->node_count * sizeof(BvhNode));
    }
    free(from);
    return from != NULL;
}

// ---- the whole

static void builder_run(Builder *builder, uint32_t count, unsigned leaf_bits, int threads, BvhChild *root)
{
    Range whole = {.end = count, .leaf_bits = leaf_bits};
    Task task = {range_measure(builder->refs, whole, threads), root};
    builder_make(builder, 0, threads, &task);
    parallel_run(threads, builder_work, builder);
}

bool bvh_build(Bvh *bvh, BvhRef *refs, uint32_t count, BvhLeafBits leaf_bits, int threads, const atomic_bool *cancel)
{
    Builder *builder = malloc(sizeof *builder);
    int builders = count <= 4 * TASK_REFS_LEAST ? 1 : threads < BUILDERS_MOST ? threads : BUILDERS_MOST;
    if (!builder || !pages_take(&bvh->pages, nodes_most(count, leaf_bits, builders) * sizeof(BvhNode))) {
        free(builder);
        return false;
    }
    BvhChild root;
    memset(builder, 0, offsetof(Builder, spares)); // which are written before they are read
    builder->refs = refs;
    builder->cancel = cancel;
    builder->nodes = bvh->nodes = bvh->pages.memory;
    bvh->node_count = 0;
    pthread_mutex_init(&builder->lock, NULL);
    pthread_cond_init(&builder->changed, NULL);
    builder_run(builder, count, leaf_bits, builders, &root);
    bool done = !is_cancelled(builder) && order_nodes(bvh, atomic_load(&builder->next_node), root);
    pthread_cond_destroy(&builder->changed);
    pthread_mutex_destroy(&builder->lock);
    free(builder);
    if (!done) {
        bvh_fini(bvh);
    }
    return done;
}

void bvh_fini(Bvh *bvh)
{
    pages_give(&bvh->pages);
    *bvh = (Bvh){0};
}
