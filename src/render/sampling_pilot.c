// What a picture of one ray a pixel is worth, where, from a few pixels that get more.
//
// A ray through the middle of a pixel is off by little where light is even, and by much where an edge goes through.
// Pixels are sorted by how far they are from a straight line between their neighbours, near and pooled. In each square
// of pixels one, chosen by chance, starts with samples of its own; how far those are from the middles tells what each
// sort is off by in the mean, without regard to why. docs/sampling.md, "Adaptive sampling".
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/sampling.h"

enum {
    PROBE_SQUARE = 4,  // a pixel of each square of so many by so many
    SORT_MIDDLE = 24,  // the sort of a square of 1
    PROBES_LEAST = 12, // of a sort, or of sorts that are taken together
};

// The square of how far the pixels of a row are from the mean of the two beside them, or of those above and below,
// whichever is more.
static void bends(const Film *film, int y, double *squares)
{
    const size_t step = 3 * (size_t)film->width;
    const float *row = &film->rgb[(size_t)y * step];
    bool has_rows = y > 0 && y < film->height - 1;
    for (int x = 0; x < film->width; x++) {
        const float *middle = row + 3 * (size_t)x;
        float across = 0.0f, down = 0.0f;
        for (int i = 0; i < 3 && x > 0 && x < film->width - 1; i++) {
            float apart = middle[i] - 0.5f * (middle[i - 3] + middle[i + 3]);
            across += apart * apart;
        }
        for (int i = 0; i < 3 && has_rows; i++) {
            float apart = middle[i] - 0.5f * (*(middle + i - step) + *(middle + i + step));
            down += apart * apart;
        }
        squares[x] = (double)(across > down ? across : down);
    }
}

// By its exponent.
static inline uint16_t sort_of(float square)
{
    union { float value; uint32_t bits; } number = {.value = square};
    int sort = ((int)(number.bits >> 23) - 127) / 2 + SORT_MIDDLE;
    return (uint16_t)(sort < 0 ? 0 : sort >= PILOT_SORTS ? PILOT_SORTS - 1 : sort);
}

// Marks them.
static void probes_choose(const Film *film, uint64_t seed, uint16_t *buckets)
{
    int first_x = film->left - film->left % PROBE_SQUARE, first_y = film->top - film->top % PROBE_SQUARE;
    for (int top = first_y - film->top; top < film->height; top += PROBE_SQUARE) {
        for (int left = first_x - film->left; left < film->width; left += PROBE_SQUARE) {
            uint32_t chosen = sampler_pixel_seed(~seed, (uint32_t)(film->left + left), (uint32_t)(film->top + top));
            int x = left + (int)(chosen % PROBE_SQUARE), y = top + (int)(chosen / PROBE_SQUARE % PROBE_SQUARE);
            if (x >= 0 && x < film->width && y >= 0 && y < film->height) {
                buckets[(size_t)y * (size_t)film->width + (size_t)x] |= PILOT_PROBE;
            }
        }
    }
}

void pilot_sort(const Film *film, uint64_t seed, uint16_t *buckets, double *memory)
{
    Near near = near_begin(memory, film->width, film->height);
    for (int y = 0; y <= film->height; y++) {
        if (y < film->height) {
            bends(film, y, near.values);
        }
        near_give(&near, y);
        if (y > 0) {
            near_take(&near, y - 1);
            for (int x = 0; x < film->width; x++) {
                uint16_t sort = sort_of((float)near.values[x]);
                buckets[(size_t)(y - 1) * (size_t)film->width + (size_t)x] = sort;
            }
        }
    }
    probes_choose(film, seed, buckets);
}

// What the probes of a sort were off by: the square of the distance of the middle from the mean of the samples, less
// what the latter are off by themselves, at the most.
typedef struct Sort {
    double count, sum, squares;
} Sort;

static void sort_add(Sort *sort, const Sort *more)
{
    sort->count += more->count;
    sort->sum += more->sum;
    sort->squares += more->squares;
}

static void sorts_gather(const Film *film, const uint16_t *buckets, Sort sorts[PILOT_SORTS])
{
    const double own = 1.0 / 7.0; // of `outer`: RATIO_MOST less one
    size_t pixels = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < pixels; i++) {
        if (buckets[i] & PILOT_PROBE) {
            const PixelRecord *record = &film->records[i];
            double off = record->fresh - own * record->outer;
            sort_add(&sorts[buckets[i] & ~PILOT_PROBE], &(Sort){1.0, off, off * off});
        }
    }
}

// Sorts of few probes go with their neighbours, from the most uneven down.
static void sorts_judge(const Sort sorts[PILOT_SORTS], double mean[PILOT_SORTS], double variance[PILOT_SORTS])
{
    for (int end = PILOT_SORTS; end > 0;) {
        Sort sum = {0.0, 0.0, 0.0};
        int begin = end;
        while (begin > 0 && sum.count < PROBES_LEAST) {
            sort_add(&sum, &sorts[--begin]);
        }
        double value = sum.count > 0.0 ? fmax(sum.sum / sum.count, 0.0) : 0.0;
        double spread = sum.count > 1.0 ? (sum.squares / sum.count - value * value) / (sum.count - 1.0) : 0.0;
        for (int i = begin; i < end; i++) {
            mean[i] = value;
            variance[i] = value > 0.0 ? spread / (value * value) : 0.0;
        }
        end = begin;
    }
}

void pilot_judge(Estimate *estimate, Film *film, const uint16_t *buckets)
{
    size_t pixels = (size_t)film->width * (size_t)film->height;
    Sort sorts[PILOT_SORTS] = {{0.0, 0.0, 0.0}};
    double mean[PILOT_SORTS];
    LevelSums *started = &estimate->levels[estimate_level(START_SAMPLES)];
    sorts_gather(film, buckets, sorts);
    sorts_judge(sorts, mean, estimate->sort_variance);
    for (size_t i = 0; i < pixels; i++) {
        PixelRecord *record = &film->records[i];
        if (buckets[i] & PILOT_PROBE) {
            started->outer += record->outer;
            started->inner += record->inner;
        } else {
            record->outer = record->inner = (float)mean[buckets[i]];
            record->fresh = buckets[i];
        }
    }
}
