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

#include "base/parallel.h"

enum {
    BIN_MOST = 16,
    SHORT_MOST = RANGE_SPARE,
    SAMPLES = (SHORT_MOST + 1) / 2, // a range of more than SHORT_MOST is binned by about so many of its refs
    MOVE_BLOCK = 64,           // refs that are looked at before some are moved
    TURNS = 2,                 // places where boxes are summed up
    VERY_LONG = 1 << 16,       // a range of more refs is moved by pieces, several at once when there are threads
    PIECES = 8,
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

// A long range is measured by pieces, which are joined in their order.
typedef struct Measuring {
    const BvhRef *refs;
    uint32_t begin, piece; // refs of a piece
    Sum sums[PIECES];
} Measuring;

static Sum refs_sum(const BvhRef *refs, uint32_t begin, uint32_t end)
{
    Sum sum = EMPTY_SUM;
    for (uint32_t i = begin; i < end; i++) {
        sum_add(&sum, &refs[i]);
    }
    return sum;
}

static void measure_piece(void *client, size_t begin, size_t end)
{
    Measuring *measuring = client;
    uint32_t first = measuring->begin + (uint32_t)begin;
    measuring->sums[begin / measuring->piece] = refs_sum(measuring->refs, first, first + (uint32_t)(end - begin));
}

Range range_measure(const BvhRef *refs, Range range, int threads)
{
    uint32_t count = range_count(&range);
    Measuring measuring = {.refs = refs, .begin = range.begin, .piece = count / PIECES + 1};
    for (int i = 0; i < PIECES; i++) {
        measuring.sums[i] = EMPTY_SUM;
    }
    parallel_share(count > VERY_LONG ? threads : 1, count, measuring.piece, measure_piece, &measuring);
    for (int i = 1; i < PIECES; i++) {
        sum_join(&measuring.sums[0], &measuring.sums[i]);
    }
    range.box = measuring.sums[0].box;
    range.centres = measuring.sums[0].centres;
    return range;
}

// A part of a range that is cut.
static Range range_part(const Range *range, const Sum *sum, uint32_t begin, uint32_t end)
{
    return (Range){sum->box, sum->centres, begin, end, range->depth + 1, range->leaf_bits};
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
    // Whatever the numbers, it is one of them.
    float place = (centre - binning->low) * binning->bins_per_unit;
    return place < (float)binning->count ? (place > 0.0f ? (int)place : 0) : binning->count - 1;
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
static inline float side_cost(const Box *box, uint32_t count, unsigned leaf_bits)
{
    uint32_t leaves = (count + (1u << leaf_bits) - 1) >> leaf_bits;
    return count ? (float)leaves * box_half_area(box) : INFINITY;
}

// The cheapest place to cut: the first bin of the right side.
static int bins_cut(const Bin *bins, int bin_count, unsigned leaf_bits)
{
    float right_cost[BIN_MOST];
    Box box = EMPTY_BOX;
    uint32_t count = 0;
    for (int i = bin_count - 1; i > 0; i--) {
        box_join(&box, &bins[i].sum.box);
        count += bins[i].count;
        right_cost[i] = side_cost(&box, count, leaf_bits);
    }
    box = EMPTY_BOX;
    count = 0;
    float best = INFINITY;
    int cut = 0;
    for (int i = 1; i < bin_count; i++) {
        box_join(&box, &bins[i - 1].sum.box);
        count += bins[i - 1].count;
        float cost = side_cost(&box, count, leaf_bits) + right_cost[i];
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
static uint32_t short_move(BvhRef *refs, uint32_t count, const uint8_t *bin_of, int cut, BvhRef right[RANGE_SPARE])
{
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
static bool short_split(BvhRef *refs, const Range *range, const Binning *binning, BvhRef spare[RANGE_SPARE], Range *left,
                        Range *right)
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
    int cut = bins_cut(bins, binning->count, range->leaf_bits);
    if (cut == 0) {
        return false;
    }
    Sum sums[2] = {bins_sum(bins, 0, cut), bins_sum(bins, cut, binning->count)};
    uint32_t middle = range->begin + short_move(first, count, bin_of, cut, spare);
    *left = range_part(range, &sums[0], range->begin, middle);
    *right = range_part(range, &sums[1], middle, range->end);
    return true;
}

// ---- moving refs, and measuring them while they are moved

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

// Two stretches of refs, of which the left parts are to come first: `begin` to `front_end`, then from `back_begin` to
// `end`. They are the same, or apart. `begin` and `end` go towards each other over what is done.
typedef struct Stretch {
    uint32_t begin, front_end, back_begin, end;
} Stretch;

// Whether there is a block left at either end.
static inline bool has_blocks(const Stretch *s)
{
    return s->front_end <= s->back_begin
               ? s->front_end - s->begin >= MOVE_BLOCK && s->end - s->back_begin >= MOVE_BLOCK
               : s->end - s->begin > 2 * MOVE_BLOCK;
}

// Refs on the wrong side are noted for a block at either end, then changed in pairs (Edelkamp and Weiss,
// "BlockQuicksort", 2016). What is left at one end is less than a block, and perhaps one that has been begun; refs of
// which are measured again, which changes nothing.
static void move_blocks(Mover *mover, Stretch *stretch)
{
    uint8_t wrong_left[MOVE_BLOCK], wrong_right[MOVE_BLOCK];
    uint32_t lefts = 0, rights = 0, left = 0, right = 0; // noted, and the first of them not changed yet
    Stretch s = *stretch;
    while (has_blocks(&s)) {
        if (left == lefts) {
            left = lefts = 0;
            for (uint32_t i = 0; i < MOVE_BLOCK; i++) {
                wrong_left[lefts] = (uint8_t)i;
                lefts += mover_side(mover, &mover->refs[s.begin + i], i);
            }
        }
        if (right == rights) {
            right = rights = 0;
            for (uint32_t i = 0; i < MOVE_BLOCK; i++) {
                wrong_right[rights] = (uint8_t)i;
                rights += 1 - mover_side(mover, &mover->refs[s.end - 1 - i], i);
            }
        }
        for (; left < lefts && right < rights; left++, right++) {
            refs_swap(&mover->refs[s.begin + wrong_left[left]], &mover->refs[s.end - 1 - wrong_right[right]]);
        }
        s.begin += left == lefts ? MOVE_BLOCK : 0;
        s.end -= right == rights ? MOVE_BLOCK : 0;
    }
    *stretch = s;
}

// Moves the refs from begin to end; returns where the right ones begin.
static uint32_t move_run(Mover *mover, uint32_t begin, uint32_t end)
{
    Stretch s = {begin, end, begin, end};
    move_blocks(mover, &s);
    while (s.begin < s.end) {
        if (mover_side(mover, &mover->refs[s.begin], 0) == 0) {
            s.begin++;
        } else {
            refs_swap(&mover->refs[s.begin], &mover->refs[--s.end]);
        }
    }
    return s.begin;
}

static Mover mover_new(BvhRef *refs, int axis, float edge)
{
    Mover mover = {.refs = refs, .axis = axis, .edge = edge};
    for (int turn = 0; turn < TURNS; turn++) {
        mover.sums[turn][0] = mover.sums[turn][1] = EMPTY_SUM;
    }
    return mover;
}

// All in the first place.
static void mover_sum_up(Mover *mover)
{
    for (int turn = 1; turn < TURNS; turn++) {
        sum_join(&mover->sums[0][0], &mover->sums[turn][0]);
        sum_join(&mover->sums[0][1], &mover->sums[turn][1]);
    }
}

// ---- very long ranges: by pieces, of two stretches each, one before the middle that is expected and one behind it

typedef struct Piece {
    uint32_t begin[2], middle[2], end[2]; // of both stretches; the right refs of each begin at its middle
    Sum sums[2];                          // of left and right
} Piece;

typedef struct Pieces {
    BvhRef *refs;
    int axis;
    float edge;
    Piece items[PIECES];
} Pieces;

static void pieces_cut(Pieces *pieces, const Range *range, uint32_t expected)
{
    uint32_t ends[3] = {range->begin, expected, range->end};
    for (unsigned i = 0; i < PIECES; i++) {
        for (unsigned side = 0; side < 2; side++) {
            uint64_t length = ends[side + 1] - ends[side];
            pieces->items[i].begin[side] = ends[side] + (uint32_t)(length * i / PIECES);
            pieces->items[i].end[side] = ends[side] + (uint32_t)(length * (i + 1) / PIECES);
        }
    }
}

static void move_piece(void *client, size_t begin, size_t end)
{
    Pieces *pieces = client;
    for (size_t i = begin; i < end; i++) {
        Piece *piece = &pieces->items[i];
        Mover mover = mover_new(pieces->refs, pieces->axis, pieces->edge);
        Stretch s = {piece->begin[0], piece->end[0], piece->begin[1], piece->end[1]};
        move_blocks(&mover, &s);
        piece->middle[0] = move_run(&mover, s.begin, s.front_end);
        piece->middle[1] = move_run(&mover, s.back_begin, s.end);
        mover_sum_up(&mover);
        memcpy(piece->sums, mover.sums[0], sizeof piece->sums);
    }
}

// Refs that stand on the wrong side of the middle, one after the other through all stretches.
typedef struct Wrong {
    const Pieces *pieces;
    unsigned stretch; // the next one
    uint32_t at, end; // what is left of the last one
} Wrong;

// The next right ref before the middle, or the next left one behind it; there must be one.
static BvhRef *wrong_next(Wrong *wrong, uint32_t middle, bool is_right)
{
    while (wrong->at >= wrong->end) {
        const Piece *piece = &wrong->pieces->items[wrong->stretch % PIECES];
        unsigned side = wrong->stretch++ / PIECES;
        uint32_t begin = is_right ? piece->middle[side] : piece->begin[side];
        uint32_t end = is_right ? piece->end[side] : piece->middle[side];
        wrong->at = is_right || begin > middle ? begin : middle;
        wrong->end = is_right && end > middle ? middle : end;
    }
    return &wrong->pieces->refs[wrong->at++];
}

// Changes the right refs before the middle with the left ones behind it: few, as far as the sample was right.
static uint32_t pieces_join(const Pieces *pieces, uint32_t begin)
{
    uint32_t middle = begin, count = 0;
    for (unsigned i = 0; i < 2 * PIECES; i++) {
        const Piece *piece = &pieces->items[i % PIECES];
        middle += piece->middle[i / PIECES] - piece->begin[i / PIECES];
    }
    for (unsigned i = 0; i < 2 * PIECES; i++) {
        const Piece *piece = &pieces->items[i % PIECES];
        uint32_t first = piece->middle[i / PIECES], end = piece->end[i / PIECES];
        count += first < middle ? (end < middle ? end : middle) - first : 0;
    }
    Wrong rights = {.pieces = pieces}, lefts = {.pieces = pieces};
    for (; count > 0; count--) {
        refs_swap(wrong_next(&rights, middle, true), wrong_next(&lefts, middle, false));
    }
    return middle;
}

// Moves the refs of a very long range, of which so many are expected to be left ones; returns where the right ones begin.
static uint32_t move_pieces(Mover *mover, const Range *range, uint32_t expected, int threads)
{
    Pieces pieces = {.refs = mover->refs, .axis = mover->axis, .edge = mover->edge};
    pieces_cut(&pieces, range, range->begin + expected);
    parallel_share(threads, PIECES, 1, move_piece, &pieces);
    for (int i = 0; i < PIECES; i++) {
        sum_join(&mover->sums[0][0], &pieces.items[i].sums[0]);
        sum_join(&mover->sums[0][1], &pieces.items[i].sums[1]);
    }
    return pieces_join(&pieces, range->begin);
}

// ---- long ranges

// How many refs of a range are in the bins before the cut, as far as the sample tells.
static uint32_t bins_expect(const Bin *bins, const Binning *binning, int cut, uint32_t count)
{
    uint64_t lefts = 0, all = 0;
    for (int i = 0; i < binning->count; i++) {
        lefts += i < cut ? bins[i].count : 0;
        all += bins[i].count;
    }
    return (uint32_t)(count * lefts / all);
}

// Some refs are binned; all are measured while they are moved. False when it cannot be cut so.
static bool long_split(BvhRef *refs, const Range *range, const Binning *binning, int threads, Range *left,
                       Range *right)
{
    Bin bins[BIN_MOST];
    bins_clear(bins, binning);
    uint32_t stride = range_count(range) / SAMPLES;
    for (uint32_t i = range->begin; i < range->end; i += stride) {
        bin_add(&bins[binning_bin(binning, ref_centre(&refs[i], binning->axis))], &refs[i]);
    }
    int cut = bins_cut(bins, binning->count, range->leaf_bits);
    if (cut == 0) {
        return false;
    }
    float edge = binning->low + (float)cut / binning->bins_per_unit;
    Mover mover = mover_new(refs, binning->axis, edge);
    uint32_t middle = range_count(range) > VERY_LONG
                          ? move_pieces(&mover, range, bins_expect(bins, binning, cut, range_count(range)), threads)
                          : move_run(&mover, range->begin, range->end);
    mover_sum_up(&mover);
    if (middle == range->begin || middle == range->end) {
        return false; // bins were too narrow for their edges
    }
    const Sum *sums = mover.sums[0];
    *left = range_part(range, &sums[0], range->begin, middle);
    *right = range_part(range, &sums[1], middle, range->end);
    return true;
}

// ---- both

// Between two bins, where they tell the refs apart and the heuristic has not gone too deep.
static bool cut_between_bins(BvhRef *refs, const Range *range, int threads, BvhRef spare[RANGE_SPARE], Range *left,
                             Range *right)
{
    Binning binning;
    if (range->depth >= BVH_SAH_DEPTH_MOST || !binning_init(&binning, range)) {
        return false;
    }
    return range_count(range) <= SHORT_MOST ? short_split(refs, range, &binning, spare, left, right)
                                            : long_split(refs, range, &binning, threads, left, right);
}

void range_split(BvhRef *refs, const Range *range, int threads, BvhRef spare[RANGE_SPARE], Range *left, Range *right)
{
    if (cut_between_bins(refs, range, threads, spare, left, right)) {
        return;
    }
    // In half by full leaves.
    uint32_t leaves = ((range_count(range) - 1) >> range->leaf_bits) + 1;
    uint32_t middle = range->begin + (leaves / 2 << range->leaf_bits);
    const Sum empty = EMPTY_SUM;
    *left = range_measure(refs, range_part(range, &empty, range->begin, middle), threads);
    *right = range_measure(refs, range_part(range, &empty, middle, range->end), threads);
}
