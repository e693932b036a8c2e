// The tree of boxes: built over spheres in place, walked near child first.
//
// Every step is bounded: the depth (ranges are halved when the heuristic has gone deep enough or cannot separate its
// spheres), the two stacks, and the time of a build, n log n for any input, a million coincident spheres among them.
//
// SPDX-License-Identifier: MIT
#include "trace/bvh.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BIN_MOST = 16, CACHE_LINE_BYTES = 64 };

// Time to visit a node in units of the time to test a sphere, measured; only the ratio matters.
static const float NODE_COST = 1.5f;

// Four floats at a time; x, y and z are used.
typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Int4 __attribute__((vector_size(16)));

typedef struct Box {
    Float4 low, high;
} Box;

// A sphere while the tree is built: its box and its number.
typedef struct BuildRef {
    Box box;
    uint32_t index;
} BuildRef;

// A range of refs that has to become child `side` of node `parent`.
typedef struct BuildTask {
    uint32_t begin, end;
    uint32_t parent;
    uint16_t side, depth;
} BuildTask;

typedef struct Builder {
    BuildRef *refs;
    BvhNode *nodes;
    uint32_t node_count;
    uint32_t first; // number of the first sphere in the new order
} Builder;

typedef struct Bin {
    Box box;
    uint32_t count;
} Bin;

typedef struct Split {
    float cost; // of the children, in sphere tests times half the area of the range's box
    int axis;
    int bin; // the first bin of the right side
} Split;

static const Box EMPTY_BOX = {{INFINITY, INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, -INFINITY, 0}};

// a where the mask is set, else b
static inline Float4 float4_select(Int4 mask, Float4 a, Float4 b)
{
    return (Float4)((mask & (Int4)a) | (~mask & (Int4)b));
}

static inline Float4 float4_min(Float4 a, Float4 b)
{
    return float4_select(a < b, a, b);
}

static inline Float4 float4_max(Float4 a, Float4 b)
{
    return float4_select(a > b, a, b);
}

static inline void box_join(Box *box, const Box *other)
{
    box->low = float4_min(other->low, box->low);
    box->high = float4_max(other->high, box->high);
}

static float box_half_area(const Box *box)
{
    Float4 size = box->high - box->low;
    return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

// Twice the middle of a box.
static inline Float4 box_centre(const Box *box)
{
    return box->low + box->high;
}

// Rounded outward: a conversion to float is off by at most 2^-24 of the value.
static float float_below(double x)
{
    return (float)(x - fabs(x) * 0x1p-23);
}

static float float_above(double x)
{
    return (float)(x + fabs(x) * 0x1p-23);
}

// Maps box centres to bins along each axis.
typedef struct Binning {
    Float4 low, bins_per_unit; // 0 for an axis along which the centres do not differ
    int count;
} Binning;

// The bins of a box, one for each axis.
static inline Int4 binning_bins(const Binning *binning, const Box *box)
{
    const Int4 last = {binning->count - 1, binning->count - 1, binning->count - 1, 0};
    Int4 bins = __builtin_convertvector((box_centre(box) - binning->low) * binning->bins_per_unit, Int4);
    Int4 within = bins < last;
    return (within & bins) | (~within & last);
}

// False when all centres are the same.
static bool binning_init(Binning *binning, const BuildRef *refs, uint32_t begin, uint32_t end)
{
    Box centres = EMPTY_BOX;
    for (uint32_t i = begin; i < end; i++) {
        Float4 centre = box_centre(&refs[i].box);
        box_join(&centres, &(Box){centre, centre});
    }
    // Half of all ranges are short; for them the bins themselves would be most of the work.
    binning->count = end - begin >= 64 ? BIN_MOST : end - begin >= 16 ? BIN_MOST / 2 : BIN_MOST / 4;
    binning->low = centres.low;
    binning->bins_per_unit = (Float4){0, 0, 0, 0};
    bool differ = false;
    for (int axis = 0; axis < 3; axis++) {
        float bins_per_unit = (float)binning->count / (centres.high[axis] - centres.low[axis]);
        if (bins_per_unit < INFINITY) {
            binning->bins_per_unit[axis] = bins_per_unit;
            differ = true;
        }
    }
    return differ;
}

// The cheapest place to cut along one axis, if it is cheaper than *best.
static void split_axis(const Bin *bins, int bin_count, int axis, Split *best)
{
    float right_cost[BIN_MOST];
    Box box = EMPTY_BOX;
    uint32_t count = 0;
    for (int i = bin_count - 1; i > 0; i--) {
        box_join(&box, &bins[i].box);
        count += bins[i].count;
        right_cost[i] = count ? (float)count * box_half_area(&box) : INFINITY;
    }
    box = EMPTY_BOX;
    count = 0;
    for (int i = 1; i < bin_count; i++) {
        box_join(&box, &bins[i - 1].box);
        count += bins[i - 1].count;
        float cost = count ? (float)count * box_half_area(&box) + right_cost[i] : INFINITY;
        if (cost < best->cost) {
            *best = (Split){cost, axis, i};
        }
    }
}

// The best split of a range; its cost stays infinite when there is none.
static Split split_find(const BuildRef *refs, uint32_t begin, uint32_t end, const Binning *binning)
{
    Bin bins[3][BIN_MOST];
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < binning->count; i++) {
            bins[axis][i] = (Bin){EMPTY_BOX, 0};
        }
    }
    for (uint32_t i = begin; i < end; i++) {
        Int4 places = binning_bins(binning, &refs[i].box);
        for (int axis = 0; axis < 3; axis++) {
            Bin *bin = &bins[axis][places[axis]];
            box_join(&bin->box, &refs[i].box);
            bin->count++;
        }
    }
    Split best = {INFINITY, 0, 0};
    for (int axis = 0; axis < 3; axis++) {
        split_axis(bins[axis], binning->count, axis, &best);
    }
    return best;
}

// Puts the refs left of the split first; returns where the right side begins.
static uint32_t split_apply(BuildRef *refs, uint32_t begin, uint32_t end, const Binning *binning, const Split *split)
{
    uint32_t left = begin;
    uint32_t right = end;
    while (left < right) {
        if (binning_bins(binning, &refs[left].box)[split->axis] < split->bin) {
            left++;
        } else {
            BuildRef moved = refs[left];
            refs[left] = refs[--right];
            refs[right] = moved;
        }
    }
    return left;
}

// Where to cut the range in two, or `begin` when it is to be a leaf.
static uint32_t range_cut(BuildRef *refs, const BuildTask *task, const Box *box)
{
    uint32_t count = task->end - task->begin;
    if (count == 1) {
        return task->begin;
    }
    Binning binning;
    if (task->depth < BVH_SAH_DEPTH_MOST && binning_init(&binning, refs, task->begin, task->end)) {
        Split split = split_find(refs, task->begin, task->end, &binning);
        float area = box_half_area(box);
        if (count <= BVH_LEAF_MOST && !(split.cost + NODE_COST * area < (float)count * area)) {
            return task->begin;
        }
        if (split.cost < INFINITY) {
            return split_apply(refs, task->begin, task->end, &binning, &split);
        }
    }
    return count <= BVH_LEAF_MOST ? task->begin : task->begin + count / 2;
}

static void node_set_child(BvhNode *node, int side, const Box *box, uint32_t first, uint32_t count)
{
    for (int axis = 0; axis < 3; axis++) {
        node->box[axis][0][side] = box->low[axis];
        node->box[axis][1][side] = box->high[axis];
    }
    node->first[side] = first;
    node->count[side] = count;
}

// Depth first, with the ranges still to do on a stack of its own: at most one waits at each level.
static void builder_run(Builder *builder, uint32_t count)
{
    BuildTask stack[BVH_DEPTH_MOST + 1];
    unsigned waiting = 0;
    builder->node_count = 1;
    stack[waiting++] = (BuildTask){0, count, 0, 0, 0};
    while (waiting > 0) {
        BuildTask task = stack[--waiting];
        Box box = EMPTY_BOX;
        for (uint32_t i = task.begin; i < task.end; i++) {
            box_join(&box, &builder->refs[i].box);
        }
        uint32_t cut = range_cut(builder->refs, &task, &box);
        if (cut == task.begin) {
            node_set_child(&builder->nodes[task.parent], task.side, &box, builder->first + task.begin,
                           task.end - task.begin);
            continue;
        }
        uint32_t node = 0;
        if (task.depth > 0) {
            node = builder->node_count++;
            node_set_child(&builder->nodes[task.parent], task.side, &box, node, 0);
        }
        uint16_t depth = (uint16_t)(task.depth + 1);
        stack[waiting++] = (BuildTask){cut, task.end, node, 1, depth};
        stack[waiting++] = (BuildTask){task.begin, cut, node, 0, depth};
    }
}

// Chooses the tree's coordinates: the box of the centres in the middle, the root box within -1..1. The half size is
// that of the centres plus the greatest radius, so that it also holds spheres too small to show beside their
// coordinates.
static void bvh_place(Bvh *bvh, const Ball *balls, uint32_t count)
{
    Vec3 low = balls[0].centre;
    Vec3 high = balls[0].centre;
    double radius_squared = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        Vec3 c = balls[i].centre;
        low = vec3(fmin(low.x, c.x), fmin(low.y, c.y), fmin(low.z, c.z));
        high = vec3(fmax(high.x, c.x), fmax(high.y, c.y), fmax(high.z, c.z));
        radius_squared = fmax(radius_squared, balls[i].radius_squared);
    }
    double radius = sqrt(radius_squared);
    Vec3 half = vec3_sub(vec3_scale(0.5, high), vec3_scale(0.5, low));
    half = vec3_add(half, vec3(radius, radius, radius));
    int exponent;
    frexp(vec3_max_abs(half), &exponent);
    exponent = exponent < DBL_MIN_EXP ? DBL_MIN_EXP : exponent; // so that the scale is finite
    bvh->centre = vec3_add(vec3_scale(0.5, high), vec3_scale(0.5, low));
    bvh->scale = ldexp(1.0, -exponent);
    bvh->half = vec3_scale(bvh->scale, half);
}

static BuildRef build_ref(const Bvh *bvh, const Ball *ball, uint32_t index)
{
    Vec3 c = vec3_scale(bvh->scale, vec3_sub(ball->centre, bvh->centre));
    double r = bvh->scale * sqrt(ball->radius_squared);
    return (BuildRef){{{float_below(c.x - r), float_below(c.y - r), float_below(c.z - r), 0},
                       {float_above(c.x + r), float_above(c.y + r), float_above(c.z + r), 0}},
                      index};
}

bool bvh_init(Bvh *bvh, const Ball *balls, uint32_t count, uint32_t first, uint32_t *order)
{
    *bvh = (Bvh){0};
    assert(count > BVH_LEAF_MOST); // so that the root has two children
    // A tree of n leaves has n - 1 inner nodes; what is not used is given back below.
    size_t room = (size_t)count * sizeof(BvhNode);
    Builder builder = {.refs = malloc((size_t)count * sizeof(BuildRef)),
                       .nodes = aligned_alloc(CACHE_LINE_BYTES, room),
                       .first = first};
    if (!builder.refs || !builder.nodes) {
        free(builder.refs);
        free(builder.nodes);
        return false;
    }
    bvh_place(bvh, balls, count);
    for (uint32_t i = 0; i < count; i++) {
        builder.refs[i] = build_ref(bvh, &balls[i], i);
    }
    builder_run(&builder, count);
    for (uint32_t i = 0; i < count; i++) {
        order[i] = builder.refs[i].index;
    }
    free(builder.refs);
    size_t used = (size_t)builder.node_count * sizeof(BvhNode);
    BvhNode *nodes = aligned_alloc(CACHE_LINE_BYTES, used);
    if (nodes) {
        memcpy(nodes, builder.nodes, used);
        free(builder.nodes);
        builder.nodes = nodes;
    }
    bvh->nodes = builder.nodes;
    bvh->node_count = builder.node_count;
    return true;
}

void bvh_fini(Bvh *bvh)
{
    free(bvh->nodes);
    *bvh = (Bvh){0};
}

// Two doubles at a time: the two children of a node.
typedef float Float2 __attribute__((vector_size(8)));
typedef double Double2 __attribute__((vector_size(16)));
typedef int64_t Long2 __attribute__((vector_size(16)));

RT_ALWAYS_INLINE Double2 double2_load(const float *from)
{
    Float2 two;
    memcpy(&two, from, sizeof(two));
    return __builtin_convertvector(two, Double2);
}

// a where the mask is set, else b
RT_ALWAYS_INLINE Double2 double2_select(Long2 mask, Double2 a, Double2 b)
{
    return (Double2)((mask & (Long2)a) | (~mask & (Long2)b));
}

// A ray as the slab test wants it: parameter of a box plane = (plane - origin[axis][side]) * inverse[axis].
typedef struct SlabRay {
    double origin[3][2]; // axis; for low, for high planes
    double inverse[3];
    int near_side[3]; // 0 when the ray meets the low plane of an axis first
} SlabRay;

// Moves the low planes down and the high planes up by `pad`, so that no rounding anywhere makes a box miss what the
// sphere test meets (the problem of Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013, solved once a ray instead of once
// a box, and with the sphere test's own error included). Let D be the greatest distance along an axis from the origin
// to a point of the root box; all lengths below are in units of u D, to first order:
//   22  the point at the computed t lies off the sphere: | |P|² - r² | <= 8 u (r² + Σ|P_i|(|f_i| + |t d_i|)), hence
//       ||P| - r| <= 8 u (r + |f|), with r <= D and |f| <= sqrt(3) D
//    3  centre ± radius in tree coordinates, in double (the step to float is rounded outward by itself)
//    1  the ray's origin in tree coordinates
//    4  origin ± pad, plane - origin, 1 / direction, and their product
// which makes 30. False when the ray cannot meet the tree.
static bool slab_ray_init(SlabRay *slab, const Bvh *bvh, const SphereRay *ray)
{
    const double pad_units = 32.0 * (DBL_EPSILON / 2);
    Vec3 o = vec3_scale(bvh->scale, vec3_sub(ray->origin, bvh->centre));
    Vec3 d = vec3_scale(bvh->scale, ray->direction);
    double reach = fmax(fabs(o.x) + bvh->half.x, fmax(fabs(o.y) + bvh->half.y, fabs(o.z) + bvh->half.z));
    double pad = pad_units * reach;
    double origin[3] = {o.x, o.y, o.z};
    double direction[3] = {d.x, d.y, d.z};
    for (int axis = 0; axis < 3; axis++) {
        slab->origin[axis][0] = origin[axis] + pad;
        slab->origin[axis][1] = origin[axis] - pad;
        slab->inverse[axis] = 1.0 / direction[axis];
        slab->near_side[axis] = slab->inverse[axis] < 0.0;
    }
    return reach < (double)INFINITY && sphere_ray_is_usable(ray);
}

// Where the ray enters the boxes of both children, not before 0; NaN when it misses one up to t_max. A zero component
// of the direction makes infinite parameters, which are right, and NaN where a padded plane goes exactly through the
// origin; comparisons pass over a NaN, so the box then counts as met.
RT_ALWAYS_INLINE Double2 slab_enter(const SlabRay *slab, const BvhNode *node, double t_max)
{
    Double2 enter = {0.0, 0.0};
    Double2 leave = {t_max, t_max};
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        int side = slab->near_side[axis];
        Double2 t_near = (double2_load(node->box[axis][side]) - slab->origin[axis][side]) * slab->inverse[axis];
        Double2 t_far = (double2_load(node->box[axis][!side]) - slab->origin[axis][!side]) * slab->inverse[axis];
        enter = double2_select(t_near > enter, t_near, enter);
        leave = double2_select(t_far < leave, t_far, leave);
    }
    return double2_select(enter <= leave, enter, (Double2){NAN, NAN});
}

// One walk for both queries; `any` is constant, so each is compiled with its own half only. A box that begins exactly
// at the nearest hit is still entered, since equal distances are decided by order of declaration.
RT_ALWAYS_INLINE bool bvh_walk(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start,
                               bool any, Nearest *nearest)
{
    typedef struct Waiting {
        uint32_t node;
        double enter;
    } Waiting;
    Waiting stack[BVH_DEPTH_MOST];
    unsigned waiting = 0;
    SlabRay slab;
    if (!slab_ray_init(&slab, bvh, ray)) {
        return false;
    }
    uint32_t at = 0;
    for (;;) {
        const BvhNode *node = &bvh->nodes[at];
        double t_max = nearest->hit.t + SPHERE_ROOT_SLACK * nearest->hit.t;
        Double2 enter = slab_enter(&slab, node, t_max);
        int first = enter[1] < enter[0];
        uint32_t next = UINT32_MAX;
        for (int turn = 0; turn < 2; turn++) {
            int child = turn ^ first;
            if (!(enter[child] <= t_max)) {
                continue;
            }
            if (node->count[child] == 0) {
                if (next == UINT32_MAX) {
                    next = node->first[child];
                } else {
                    stack[waiting++] = (Waiting){node->first[child], enter[child]};
                }
                continue;
            }
            for (uint32_t i = node->first[child]; i < node->first[child] + node->count[child]; i++) {
                if (!any) {
                    ball_closest(table, i, ray, start, nearest);
                } else if (ball_occludes(table, i, ray, start, nearest->hit.t)) {
                    return true;
                }
            }
        }
        while (next == UINT32_MAX && waiting > 0) {
            Waiting from = stack[--waiting];
            next = from.enter <= nearest->hit.t + SPHERE_ROOT_SLACK * nearest->hit.t ? from.node : UINT32_MAX;
        }
        if (next == UINT32_MAX) {
            return false;
        }
        at = next;
    }
}

void bvh_closest(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, Nearest *nearest)
{
    (void)bvh_walk(bvh, table, ray, start, false, nearest);
}

bool bvh_occluded(const Bvh *bvh, const BallTable *table, const SphereRay *ray, const Ball *start, double t_max)
{
    Nearest nearest = {{t_max, SHAPE_NONE, false}, 0, false};
    return bvh_walk(bvh, table, ray, start, true, &nearest);
}
