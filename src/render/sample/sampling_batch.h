// Samples on their way through the kernel: those of several pixels go together, a call of the kernel at a time. Private
// to the files of rounds.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_BATCH_H
#define RENDER_SAMPLE_SAMPLING_BATCH_H

#include "render/records/linear.h"
#include "render/sample/sampling.h"

// Samples of a batch on end that go into one sum.
typedef struct Run {
    SampleSums *parts;
    uint32_t which; // of parts->sum
    int end;
} Run;

// Samples on their way through the kernel.
typedef struct Batch {
    KernelPlaces places;
    Vec3 lens[KERNEL_RAYS];
    SampleStream streams[KERNEL_RAYS];
    int x[KERNEL_RAYS], y[KERNEL_RAYS]; // their pixels
    double in_x[KERNEL_RAYS], in_y[KERNEL_RAYS]; // from 0 to 1: where in these, before any filter
    double weights[KERNEL_RAYS]; // where they are not all 1
    Rgb light[KERNEL_RAYS];
    double clear[KERNEL_RAYS];
    int count;
    Run runs[KERNEL_RAYS];
    int run_count;
    bool draws;   // whether anything but the place in the pixel is drawn from the streams
    bool is_box;  // all weights are 1
    bool meets;   // some samples are of pixels with small shapes that have not been met yet
    bool avoids;  // a sample that crosses a small shape which its pixel has not met counts as the pixel itself
    bool keeps_squares; // of samples
    RenderScratch *scratch;
} Batch;

void batch_init(Batch *batch, const Round *round, RenderScratch *scratch);

// Traces the rays of the batch's places that are wanted, as they stand.
void batch_trace(const Round *round, Batch *batch, uint64_t wanted, RenderStatistics *counted);

// Traces what waits.
void batch_flush(const Round *round, Batch *batch, RenderStatistics *counted);

static inline void batch_begin_run(Batch *batch, SampleSums *parts, uint32_t which, int end)
{
    batch->runs[batch->run_count++] = (Run){parts, which, end};
}

// Puts `count` >= 1 new samples of a pixel, the first of which is number `begin`, into runs.
static inline void batch_add_runs(Batch *batch, const ChosenPixel *pixel, SampleSums *parts, uint32_t begin,
                                  uint32_t count)
{
    uint32_t half = (pixel->count + 1) / 2;
    int first = batch->count;
    if (pixel->starts) {
        for (uint32_t j = 0; j < count; j++) {
            batch_begin_run(batch, parts, begin + j, first + (int)j + 1);
        }
        return;
    }
    if (begin < half) {
        uint32_t before = half - begin < count ? half - begin : count;
        batch_begin_run(batch, parts, 0, first + (int)before);
    }
    if (begin + count > half) {
        batch_begin_run(batch, parts, 1, first + (int)count);
    }
}

// Some samples of a pixel; there is room for them. `stream` is that of the first, which is `begin` among the new ones.
static inline void batch_add(Batch *batch, const ChosenPixel *pixel, const SampleStream *stream, uint32_t begin,
                             uint32_t count, SampleSums *parts)
{
    batch_add_runs(batch, pixel, parts, begin, count);
    for (uint32_t j = 0; j < count; j++) {
        int i = batch->count++;
        batch->streams[i] = *stream;
        batch->streams[i].index += j;
        batch->x[i] = pixel->x;
        batch->y[i] = pixel->y;
    }
}

// The seed of the points of a pixel of the film.
static inline uint32_t pixel_seed(const Round *round, int x, int y)
{
    const Film *film = round->film;
    return sampler_pixel_seed(round->sampling->seed, (uint32_t)(film->left + x), (uint32_t)(film->top + y));
}

// Adds the samples of a pixel, pixel->count of the set that `seed` names, from number `first` on. Inline: as a call it
// costs 1.4 % of a run of 4 samples.
RT_ALWAYS_INLINE void pixel_add_set(const Round *round, Batch *batch, const ChosenPixel *pixel, uint32_t seed,
                                    uint32_t first, SampleSums *parts, RenderStatistics *counted)
{
    uint32_t count = pixel->count;
    SampleStream stream = {.kind = round->sampling->sampler, .seed = seed, .first = first, .count = count};
    for (uint32_t i = 0; i < count;) {
        uint32_t room = (uint32_t)(KERNEL_RAYS - batch->count), some = count - i < room ? count - i : room;
        stream.index = first + i;
        batch_add(batch, pixel, &stream, i, some, parts);
        if (batch->count == KERNEL_RAYS) {
            batch_flush(round, batch, counted);
        }
        i += some;
    }
}

// The next samples of a pixel; of a replica, or where it starts, the first.
RT_ALWAYS_INLINE void pixel_add(const Round *round, Batch *batch, const ChosenPixel *pixel, SampleSums *parts,
                                RenderStatistics *counted)
{
    bool is_new = pixel->starts || pixel->replica > 0;
    uint32_t before = is_new ? 0 : round->film->records[pixel->index].count;
    uint32_t seed = pixel_seed(round, pixel->x, pixel->y);
    pixel_add_set(round, batch, pixel, pixel->replica > 0 ? sample_hash_add(seed, pixel->replica) : seed, before, parts,
                  counted);
}

// ---- what samples say

// What goes from the difference of two sets of samples, `a` and `b` in number, to its square in a PixelRecord.
static inline double apart_factor(double a, double b)
{
    return a * b / (3.0 * (a + b) * (a + b));
}

// The slope is that of linear light at the pixel; NULL: 1.
static inline float square_apart(Rgb difference, const Rgb *slope, double factor)
{
    Rgb d = slope ? rgb_mul(difference, *slope) : difference;
    return (float)(factor * (d.red * d.red + d.green * d.green + d.blue * d.blue));
}

static inline void value_put(float *value, Rgb light)
{
    value[0] = (float)light.red;
    value[1] = (float)light.green;
    value[2] = (float)light.blue;
}

// The slope at a pixel, kept in `place`; NULL where there is none.
static inline const Rgb *slope_at(const Round *round, const float *value, Rgb *place)
{
    const Settings *settings = &round->prepared->scene->settings;
    if (!linear_is_needed(settings)) {
        return NULL;
    }
    *place = linear_slope(settings, value);
    return place;
}

#endif
