// One cut of a range: bins, the cheapest place between two of them, and the refs moved to either side.
//
// Nearly all the time of a build is spent here. Refs come in no order, so whatever depends on the side of a ref is
// written without a branch; what is summed up over refs is kept in several places in turn, so that one does not wait for
// the one before.
//
// SPDX-License-Identifier: MIT
#include "trace/bvh_split.h"

#include <math.h>
#include <string.h>

enum {
    BIN_MOST = 16,
    SAMPLES = 512,             // a range of more than SHORT_MOST is binned by about so many of its refs
    SHORT_MOST = 2 * SAMPLES - 1,
    MOVE_BLOCK = 64,           // refs that are looked at before some are moved
    TURNS = 2,                 // places where boxes are summed up
};

typedef int32_t Int4 __attribute__((vector_size(16)));

#define EMPTY {{INFINITY, INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, -INFINITY, 0}}
static const Box EMPTY_BOX = EMPTY;

#ifdef __SSE__
static inline Float4 float4_min(Float4 a, Float4 b)
{
    return __builtin_ia32_minps(a, b);
}

static inline Float4 float4_max(Float4 a, Float4 b)
{
    return __builtin_ia32_maxps(a, b);
}
#else
static inline Float4 float4_min(Float4 a, Float4 b)
{
    Int4 mask = a < b;
    return (Float4)((mask & (Int4)a) | (~mask & (Int4)b));
}

static inline Float4 float4_max(Float4 a, Float4 b)
{
    Int4 mask = a > b;
    return (Float4)((mask & (Int4)a) | (~mask & (Int4)b));
}
#endif

static inline void box_join(Box *box, const Box *other)
{
    box->low = float4_min(other->low, box->low);
    box->high = float4_max(other->high, box->high);
}

static inline Box ref_box(const BvhRef *ref)
{
    Box box;
    memcpy(&box.low, ref->low, sizeof box.low);
    memcpy(&box.high, ref->high, sizeof box.high);
    return box;
}

// What is known of some refs.
typedef struct Sum {
    Box box, centres;
} Sum;

static const Sum EMPTY_SUM = {EMPTY, EMPTY};

static inline void sum_add(Sum *sum, const BvhRef *ref)
{
    Box box = ref_box(ref);
    Float4 centre = box.low + box.high;
    box_join(&sum->box, &box);
    box_join(&sum->centres, &(Box){centre, centre});
}

static inline void sum_join(Sum *sum, const Sum *other)
{
    box_join(&sum->box, &other->box);
    box_join(&sum->centres, &other->centres);
}

Range range_measure(const BvhRef *refs, uint32_t begin, uint32_t end, unsigned depth)
{
    Sum sum = EMPTY_SUM;
    for (uint32_t i = begin; i < end; i++) {
        sum_add(&sum, &refs[i]);
    }
    return (Range){sum.box, sum.centres, begin, end, depth};
}

// ---- bins

// Maps box centres to bins along the axis on which they lie farthest apart. The best of all three axes is seldom
// another one, and costs three times as much to find.
typedef struct Binning {
    int axis, count;
    float low, bins_per_unit;
} Binning;

typedef struct Bin {
    Sum sum;
    uint32_t count;
} Bin;

static inline float ref_centre(const BvhRef *ref, int axis)
{
    return ref->low[axis] + ref->high[axis];
}

static inline int binning_bin(const Binning *binning, float centre)
{
    int bin = (int)((centre - binning->low) * binning->bins_per_unit);
    return bin < binning->count ? bin : binning->count - 1;
}

// False when all centres are the same.
static bool binning_init(Binning *binning, const Range *range)
{
    Float4 extent = range->centres.high - range->centres.low;
    int axis = extent[1] > extent[0];
    axis = extent[2] > extent[axis] ? 2 : axis;
    // Half of all ranges are short; for them the bins themselves would be most of the work.
    int count = range_count(range) >= 16 ? BIN_MOST : BIN_MOST / 2;
    *binning = (Binning){axis, count, range->centres.low[axis], (float)count / extent[axis]};
    return binning->bins_per_unit < INFINITY;
}

static void bins_clear(Bin bins[BIN_MOST], const Binning *binning)
{
    for (int i = 0; i < binning->count; i++) {
        bins[i] = (Bin){EMPTY_SUM, 0};
    }
}

static inline void bin_add(Bin *bin, const BvhRef *ref)
{
    sum_add(&bin->sum, ref);
    bin->count++;
}

// A leaf is tested whole, so cost counts leaves, not things.
static inline float side_cost(const Box *box, uint32_t count)
{
    return count ? (float)((count + BVH_LEAF_MOST - 1) / BVH_LEAF_MOST) * box_half_area(box) : INFINITY;
}

// The cheapest place to cut: the first bin of the right side.
static int bins_cut(const Bin *bins, int bin_count)
{
    float right_cost[BIN_MOST];
    Box box = EMPTY_BOX;
    uint32_t count = 0;
    for (int i = bin_count - 1; i > 0; i--) {
        box_join(&box, &bins[i].sum.box);
        count += bins[i].count;
        right_cost[i] = side_cost(&box, count);
    }
    box = EMPTY_BOX;
    count = 0;
    float best = INFINITY;
    int cut = 0;
    for (int i = 1; i < bin_count; i++) {
        box_join(&box, &bins[i - 1].sum.box);
        count += bins[i - 1].count;
        float cost = side_cost(&box, count) + right_cost[i];
        if (cost < best) {
            best = cost;
            cut = i;
        }
    }
    return cut;
}

// ---- short ranges: every ref is binned, and what the bins know is what both sides are

static Sum bins_sum(const Bin *bins, int begin, int end)
{
    Sum sum = bins[begin].sum;
    for (int i = begin + 1; i < end; i++) {
        sum_join(&sum, &bins[i].sum);
    }
    return sum;
}

// The refs of bins from `cut` on go behind the others, in their order. Returns how many the others are.
static uint32_t short_move(BvhRef *refs, uint32_t count, const uint8_t *bin_of, int cut)
{
    BvhRef right[SHORT_MOST];
    uint32_t lefts = 0, rights = 0;
    for (uint32_t i = 0; i < count; i++) {
        BvhRef ref = refs[i];
        refs[lefts] = ref;
        right[rights] = ref;
        uint32_t is_right = bin_of[i] >= cut;
        lefts += 1 - is_right;
        rights += is_right;
    }
    memcpy(refs + lefts, right, rights * sizeof *right);
    return lefts;
}

// False when it cannot be cut between bins.
static bool short_split(BvhRef *refs, const Range *range, const Binning *binning, Range *left, Range *right)
{
    Bin bins[BIN_MOST];
    uint8_t bin_of[SHORT_MOST];
    uint32_t count = range_count(range);
    BvhRef *first = refs + range->begin;
    bins_clear(bins, binning);
    for (uint32_t i = 0; i < count; i++) {
        int bin = binning_bin(binning, ref_centre(&first[i], binning->axis));
        bin_of[i] = (uint8_t)bin;
        bin_add(&bins[bin], &first[i]);
    }
    int cut = bins_cut(bins, binning->count);
    if (cut == 0) {
        return false;
    }
    Sum sums[2] = {bins_sum(bins, 0, cut), bins_sum(bins, cut, binning->count)};
    uint32_t middle = range->begin + short_move(first, count, bin_of, cut);
    *left = (Range){sums[0].box, sums[0].centres, range->begin, middle, range->depth + 1};
    *right = (Range){sums[1].box, sums[1].centres, middle, range->end, range->depth + 1};
    return true;
}

// ---- long ranges: some refs are binned; all are measured while they are moved

typedef struct Mover {
    BvhRef *refs;
    int axis;
    float edge; // of the right side
    Sum sums[TURNS][2]; // of left and right
} Mover;

static inline uint32_t mover_side(Mover *mover, const BvhRef *ref, uint32_t turn)
{
    uint32_t is_right = ref_centre(ref, mover->axis) >= mover->edge;
    sum_add(&mover->sums[turn % TURNS][is_right], ref);
    return is_right;
}

static inline void refs_swap(BvhRef *a, BvhRef *b)
{
    BvhRef kept = *a;
    *a = *b;
    *b = kept;
}

// Refs on the wrong side are noted for a block at either end, then changed in pairs (Edelkamp and Weiss,
// "BlockQuicksort", 2016). *begin, *end: what is left, less than two blocks and the one that has been begun; refs of
// which are measured again, which changes nothing.
static void move_blocks(Mover *mover, uint32_t *begin, uint32_t *end)
{
    uint8_t wrong_left[MOVE_BLOCK], wrong_right[MOVE_BLOCK];
    uint32_t lefts = 0, rights = 0, left = 0, right = 0; // noted, and the first of them not changed yet
    while (*end - *begin > 2 * MOVE_BLOCK) {
        if (left == lefts) {
            left = lefts = 0;
            for (uint32_t i = 0; i < MOVE_BLOCK; i++) {
                wrong_left[lefts] = (uint8_t)i;
                lefts += mover_side(mover, &mover->refs[*begin + i], i);
            }
        }
        if (right == rights) {
            right = rights = 0;
            for (uint32_t i = 0; i < MOVE_BLOCK; i++) {
                wrong_right[rights] = (uint8_t)i;
                rights += 1 - mover_side(mover, &mover->refs[*end - 1 - i], i);
            }
        }
        for (; left < lefts && right < rights; left++, right++) {
            refs_swap(&mover->refs[*begin + wrong_left[left]], &mover->refs[*end - 1 - wrong_right[right]]);
        }
        *begin += left == lefts ? MOVE_BLOCK : 0;
        *end -= right == rights ? MOVE_BLOCK : 0;
    }
}

// False when it cannot be cut so.
static bool long_split(BvhRef *refs, const Range *range, const Binning *binning, Range *left, Range *right)
{
    Bin bins[BIN_MOST];
    bins_clear(bins, binning);
    uint32_t stride = range_count(range) / SAMPLES;
    for (uint32_t i = range->begin; i < range->end; i += stride) {
        bin_add(&bins[binning_bin(binning, ref_centre(&refs[i], binning->axis))], &refs[i]);
    }
    int cut = bins_cut(bins, binning->count);
    if (cut == 0) {
        return false;
    }
    float edge = binning->low + (float)cut / binning->bins_per_unit;
    Mover mover = {.refs = refs, .axis = binning->axis, .edge = edge};
    for (int turn = 0; turn < TURNS; turn++) {
        mover.sums[turn][0] = mover.sums[turn][1] = EMPTY_SUM;
    }
    uint32_t begin = range->begin, end = range->end;
    move_blocks(&mover, &begin, &end);
    while (begin < end) {
        if (mover_side(&mover, &refs[begin], 0) == 0) {
            begin++;
        } else {
            refs_swap(&refs[begin], &refs[--end]);
        }
    }
    for (int turn = 1; turn < TURNS; turn++) {
        sum_join(&mover.sums[0][0], &mover.sums[turn][0]);
        sum_join(&mover.sums[0][1], &mover.sums[turn][1]);
    }
    if (begin == range->begin || begin == range->end) {
        return false; // bins were too narrow for their edges
    }
    const Sum *sums = mover.sums[0];
    *left = (Range){sums[0].box, sums[0].centres, range->begin, begin, range->depth + 1};
    *right = (Range){sums[1].box, sums[1].centres, begin, range->end, range->depth + 1};
    return true;
}

// ---- both

// Between two bins, where they tell the refs apart and the heuristic has not gone too deep.
static bool cut_between_bins(BvhRef *refs, const Range *range, Range *left, Range *right)
{
    Binning binning;
    if (range->depth >= BVH_SAH_DEPTH_MOST || !binning_init(&binning, range)) {
        return false;
    }
    return range_count(range) <= SHORT_MOST ? short_split(refs, range, &binning, left, right)
                                            : long_split(refs, range, &binning, left, right);
}

void range_split(BvhRef *refs, const Range *range, Range *left, Range *right)
{
    if (cut_between_bins(refs, range, left, right)) {
        return;
    }
    // In half by full leaves.
    uint32_t leaves = (range_count(range) + BVH_LEAF_MOST - 1) / BVH_LEAF_MOST;
    uint32_t middle = range->begin + leaves / 2 * BVH_LEAF_MOST;
    *left = range_measure(refs, range->begin, middle, range->depth + 1);
    *right = range_measure(refs, middle, range->end, range->depth + 1);
}
