// What a picture of one ray a pixel is worth, where, from a few pixels that get more.
//
// Turns the light at the corners of pixels into pixels: by parabolas through the corners, which are off by little where
// light is even, and by much where an edge goes through. Pixels are sorted by how much more their corners differ than
// those around. In each square of pixels one, chosen by chance, starts with samples of its own; how far those are from
// what the corners gave tells what each sort is off by in the mean, without regard to why. docs/sampling.md, "Adaptive
// sampling".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "render/sample/sampling.h"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

enum {
    PROBE_SQUARE = 4,  // a pixel of each square of so many by so many;
    PROBE_SQUARE_LARGE = 8, // of a picture of
    PIXELS_LARGE = 65536, // or more, where those are enough to tell what a sort is off by
    SORT_MIDDLE = 24,  // the sort of a square of 1
    PROBES_LEAST = 12, // of a sort, or of sorts that are taken together
};

typedef float Float4 __attribute__((vector_size(16)));
typedef int32_t Int4 __attribute__((vector_size(16)));

// Of four places in a row, of which the two in the middle are corners of a pixel, for the three colours what the mean
// along that side of the pixel is over that of its ends, where light is even: by a parabola; halved. The last is by how
// much its ends differ more than those of the sides before and after, squared; beyond the picture there is no jump.
typedef Float4 PixelSide;
enum { JUMPS = 3 };

static inline Float4 pick(Int4 which, Float4 a, Float4 b)
{
    return (Float4)((which & (Int4)a) | (~which & (Int4)b));
}

static inline Float4 least(Float4 a, Float4 b)
{
#ifdef __SSE2__
    return (Float4)_mm_min_ps((__m128)a, (__m128)b);
#else
    return pick(a < b, a, b);
#endif
}

static inline Float4 most(Float4 a, Float4 b)
{
#ifdef __SSE2__
    return (Float4)_mm_max_ps((__m128)a, (__m128)b);
#else
    return pick(a > b, a, b);
#endif
}

// A corner's colours; the fourth is of what follows in memory.
static inline Float4 corner_at(const float *corner)
{
    Float4 colours;
    memcpy(&colours, corner, sizeof colours);
    return colours;
}

// The side from a corner to the next, which is `step` away.
static inline PixelSide side_make(const float *corner, ptrdiff_t step, bool has_before, bool has_after)
{
    const Float4 none = {0.0f};
    Float4 here = corner_at(corner), there = corner_at(corner + step), own = there - here;
    Float4 next = has_after ? corner_at(corner + 2 * step) - there : none;
    Float4 last = has_before ? here - corner_at(corner - step) : next;
    next = has_after ? next : last;
    Float4 a = last - own, b = own - next;
    PixelSide side = pick(a > none, most(least(a, b), none), least(most(a, b), none)) / 24.0f;
    Float4 jumps = own - most(least(last, own), least(most(last, own), next));
    jumps *= jumps;
    side[JUMPS] = jumps[0] + jumps[1] + jumps[2];
    return side;
}

// The pixels of a row, from their corners. Pixels side by side have a side in common; `above` are the sides of the row
// before, and then those of this one.
static void row_make(const Round *round, int y, PixelSide *above)
{
    const Film *film = round->film;
    const ptrdiff_t down = 3 * ((ptrdiff_t)film->width + 1);
    const float *corner = &round->corners[(size_t)down * (size_t)y];
    PixelRecord *record = &film->records[(size_t)y * (size_t)film->width];
    float *value = &film->rgb[3 * (size_t)y * (size_t)film->width];
    bool has_above = y > 0, has_below = y < film->height - 1;
    PixelSide left = side_make(corner, down, has_above, has_below);
    for (int x = 0; x < film->width; x++, corner += 3, value += 3, record++) {
        bool is_first = x == 0, is_last = x == film->width - 1;
        if (y == 0) {
            above[x] = side_make(corner, 3, !is_first, !is_last);
        }
        PixelSide below = side_make(corner + down, 3, !is_first, !is_last);
        PixelSide right = side_make(corner + 3, down, has_above, has_below), sides = above[x] + below + left + right;
        Float4 corners =
            corner_at(corner) + corner_at(corner + 3) + corner_at(corner + down) + corner_at(corner + down + 3);
        Float4 mean = 0.25f * corners + sides;
        memcpy(value, &mean, 3 * sizeof *value);
        *record = (PixelRecord){.count = 1, .inner = sides[JUMPS]};
        above[x] = below;
        left = right;
    }
}

// By its exponent.
static inline uint16_t sort_of(float square)
{
    union {
        float value;
        uint32_t bits;
    } number = {.value = square};
    int sort = ((int)(number.bits >> 23) - 127) / 2 + SORT_MIDDLE;
    return (uint16_t)(sort < 0 ? 0 : sort >= CORNER_PASS_SORTS ? CORNER_PASS_SORTS - 1 : sort);
}

// Marks them, and counts them.
static uint32_t probes_choose(const Film *film, uint64_t seed, uint16_t *buckets)
{
    double size = (double)film->whole_width * film->whole_height;
    uint32_t count = 0, square = size < PIXELS_LARGE ? PROBE_SQUARE : PROBE_SQUARE_LARGE;
    int step = (int)square, first_x = film->left - film->left % step, first_y = film->top - film->top % step;
    for (int top = first_y - film->top; top < film->height; top += step) {
        for (int left = first_x - film->left; left < film->width; left += step) {
            uint32_t chosen = sampler_pixel_seed(~seed, (uint32_t)(film->left + left), (uint32_t)(film->top + top));
            int x = left + (int)(chosen % square), y = top + (int)(chosen / square % square);
            if (x >= 0 && x < film->width && y >= 0 && y < film->height) {
                buckets[(size_t)y * (size_t)film->width + (size_t)x] |= CORNER_PASS_PROBE;
                count++;
            }
        }
    }
    return count;
}

// Few pixels may be much more uneven than all others, as around a bright lamp, and by chance none of them chosen: then
// those that are less uneven would say what they are off by. So the most uneven sorts get more probes, chosen by chance
// within each, as far as the pixels chosen so far are not doubled. Marks them, and counts them.
static uint32_t sorts_fill(const Film *film, uint64_t seed, uint16_t *buckets, uint32_t chosen)
{
    double pixels[CORNER_PASS_SORTS] = {0.0}, probes[CORNER_PASS_SORTS] = {0.0}, part[CORNER_PASS_SORTS], left = chosen;
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; i++) {
        pixels[buckets[i] & ~CORNER_PASS_PROBE]++;
        probes[buckets[i] & ~CORNER_PASS_PROBE] += (buckets[i] & CORNER_PASS_PROBE) != 0;
    }
    for (int sort = CORNER_PASS_SORTS - 1; sort >= 0; sort--) {
        double others = pixels[sort] - probes[sort];
        double more = fmin(fmin(fmax(PROBES_LEAST - probes[sort], 0.0), others), left);
        part[sort] = others > 0.0 ? more / others : 0.0;
        left -= more;
    }
    uint32_t added = 0;
    for (size_t i = 0; i < count; i++) {
        if ((buckets[i] & CORNER_PASS_PROBE) || !(part[buckets[i]] > 0.0)) {
            continue;
        }
        uint32_t x = (uint32_t)(film->left + (int)(i % (size_t)film->width)),
                 y = (uint32_t)(film->top + (int)(i / (size_t)film->width));
        if (sample_unit(sample_hash_add(sampler_pixel_seed(~seed, x, y), CORNER_PASS_PROBE)) < part[buckets[i]]) {
            buckets[i] |= CORNER_PASS_PROBE;
            added++;
        }
    }
    return added;
}

// Pixels that hold small shapes are not left to their corners. Marks them, and counts those that were not chosen yet.
static uint32_t small_choose(const Round *round, uint16_t *buckets)
{
    size_t pixels = (size_t)round->film->width * (size_t)round->film->height;
    uint32_t count = 0;
    for (size_t i = 0; round->small && i < pixels; i++) {
        if (small_has(round->small, i)) {
            count += !(buckets[i] & CORNER_PASS_PROBE);
            buckets[i] |= CORNER_PASS_PROBE | CORNER_PASS_SMALL;
        }
    }
    return count;
}

uint32_t corner_pass_sort(const Round *round, uint16_t *buckets, double *memory)
{
    const double of_near = 1.0 / 64.0;
    const Film *film = round->film;
    Near near = near_begin(memory, film->width, film->height);
    _Static_assert(sizeof(PixelSide) <= (ALLOCATION_ROWS - NEAR_ROWS) * sizeof(double), "a row of them has room");
    PixelSide *above = (PixelSide *)(memory + (ptrdiff_t)NEAR_ROWS * film->width); // of a row
    for (int y = 0; y <= film->height; y++) {
        size_t begin = (size_t)y * (size_t)film->width;
        if (y < film->height) {
            row_make(round, y, above);
        }
        for (int x = 0; y < film->height && x < film->width; x++) {
            near.values[x] = (double)film->records[begin + (size_t)x].inner;
        }
        near_give(&near, y);
        if (y > 0) {
            near_take(&near, y - 1);
            begin -= (size_t)film->width;
            for (int x = 0; x < film->width; x++) {
                size_t pixel = begin + (size_t)x;
                buckets[pixel] = sort_of(film->records[pixel].inner + (float)(of_near * near.values[x]));
            }
        }
    }
    uint32_t probes = probes_choose(film, round->sampling->seed, buckets);
    probes += sorts_fill(film, round->sampling->seed, buckets, probes);
    return probes + small_choose(round, buckets);
}

// What the probes of a sort were off by: the square of the distance of what the corners gave from the mean of the
// samples, less what the latter are off by themselves, at the most.
typedef struct Sort {
    double count, sum, squares;
} Sort;

static void sort_add(Sort *sort, const Sort *more)
{
    sort->count += more->count;
    sort->sum += more->sum;
    sort->squares += more->squares;
}

static void sorts_gather(const Film *film, const uint16_t *buckets, Sort sorts[CORNER_PASS_SORTS])
{
    const double own = 1.0 / 7.0; // of `outer`: RATIO_MOST less one
    size_t pixels = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < pixels; i++) {
        if ((buckets[i] & CORNER_PASS_PROBE) && !(buckets[i] & CORNER_PASS_SMALL)) {
            const PixelRecord *record = &film->records[i];
            double off = record->fresh - own * record->outer;
            sort_add(&sorts[buckets[i] & ~CORNER_PASS_PROBE], &(Sort){1.0, off, off * off});
        }
    }
}

// Sorts of few probes go with their neighbours, from the most uneven down; before a sort of many probes, which may have
// most of the pixels, they go with those above, and do not spoil it.
static void sorts_judge(const Sort sorts[CORNER_PASS_SORTS], double mean[CORNER_PASS_SORTS],
                        double variance[CORNER_PASS_SORTS])
{
    Sort last = {0.0, 0.0, 0.0};
    for (int end = CORNER_PASS_SORTS; end > 0;) {
        Sort sum = sorts[end - 1];
        int begin = end - 1;
        while (begin > 0 && sum.count < PROBES_LEAST && sorts[begin - 1].count < PROBES_LEAST) {
            sort_add(&sum, &sorts[--begin]);
        }
        if (sum.count < PROBES_LEAST) {
            sort_add(&sum, &last);
        }
        last = sum;
        double value = sum.count > 0.0 ? fmax(sum.sum / sum.count, 0.0) : 0.0;
        double spread = sum.count > 1.0 ? (sum.squares / sum.count - value * value) / (sum.count - 1.0) : 0.0;
        for (int i = begin; i < end; i++) {
            mean[i] = value;
            variance[i] = value > 0.0 ? spread / (value * value) : 0.0;
        }
        end = begin;
    }
}

void corner_pass_judge(Estimate *estimate, Film *film, const uint16_t *buckets)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    Sort sorts[CORNER_PASS_SORTS] = {{0.0, 0.0, 0.0}};
    double *mean = estimate->sort_mean;
    LevelSums *started = &estimate->levels[estimate_level(START_SAMPLES)];
    sorts_gather(film, buckets, sorts);
    sorts_judge(sorts, mean, estimate->sort_variance);
    for (size_t i = 0; i < pixels; i++) {
        PixelRecord *record = &film->records[i];
        if (buckets[i] & CORNER_PASS_PROBE) {
            started->outer += record->outer;
            started->inner += record->inner;
            started->squares += (double)record->outer * record->outer;
        } else {
            record->outer = record->inner = (float)mean[buckets[i]];
            record->fresh = buckets[i];
        }
    }
}
