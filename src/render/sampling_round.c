// One round: samples are gathered into calls of the kernel, their light is summed by pixel and half, and what the
// halves say goes into the pixels' records.
//
// SPDX-License-Identifier: MIT
#include "render/camera.h"
#include "render/linear.h"
#include "render/sampling.h"
#include "render/tiles.h"

enum { TILE_PIXELS = TILE_SIZE * TILE_SIZE };

// Sums over the halves of a pixel's new samples.
typedef struct Halves {
    Rgb sum[2];
} Halves;

// Samples on their way through the kernel.
typedef struct Batch {
    KernelPlaces places;
    Vec3 lens[KERNEL_RAYS];
    SampleStream streams[KERNEL_RAYS];
    double weights[KERNEL_RAYS];
    Rgb *sums[KERNEL_RAYS];
    Rgb light[KERNEL_RAYS];
    int count;
} Batch;

uint32_t round_samples(const Round *round, size_t pixel)
{
    uint32_t count = round->film->records[pixel].count;
    if (!round_has(round, pixel)) {
        return 0;
    }
    return round->count > 0 ? round->count - count : count;
}

static void batch_flush(const Round *round, Batch *batch, RenderStatistics *counted)
{
    const Prepared *p = round->prepared;
    if (batch->count == 0) {
        return;
    }
    for (int i = batch->count; i < KERNEL_RAYS; i++) {
        batch->places.u[i] = batch->places.u[batch->count - 1];
        batch->places.v[i] = batch->places.v[batch->count - 1];
        if (batch->places.lens) {
            batch->lens[i] = batch->lens[batch->count - 1];
        }
    }
    uint64_t wanted = ~UINT64_C(0) >> (KERNEL_RAYS - batch->count);
    p->kernel->trace(p, &batch->places, batch->streams, wanted, batch->light, counted);
    for (int i = 0; i < batch->count; i++) {
        *batch->sums[i] = rgb_add_scaled(*batch->sums[i], batch->weights[i], batch->light[i]);
    }
    batch->count = 0;
}

static void batch_add(const Round *round, Batch *batch, int x, int y, SampleStream stream, Rgb *sum)
{
    const Film *film = round->film;
    int i = batch->count++;
    FilterSample at = filter_sample(&round->filter, sample_next(&stream));
    batch->places.u[i] = film_u(film, x, at.x);
    batch->places.v[i] = film_v(film, y, at.y);
    if (batch->places.lens) {
        batch->lens[i] = camera_lens_point(&round->prepared->camera, sample_next(&stream));
    }
    batch->weights[i] = at.weight;
    batch->streams[i] = stream;
    batch->sums[i] = sum;
}

static void pixel_add(const Round *round, Batch *batch, int x, int y, uint32_t count, Halves *halves,
                      RenderStatistics *counted)
{
    const Film *film = round->film;
    uint32_t before = film->records[(size_t)y * (size_t)film->width + (size_t)x].count;
    SampleStream stream = {
        .kind = round->sampling->sampler,
        .seed = sampler_pixel_seed(round->sampling->seed, (uint32_t)(film->left + x), (uint32_t)(film->top + y)),
        .first = before,
        .count = count};
    for (uint32_t i = 0; i < count; i++) {
        stream.index = before + i;
        batch_add(round, batch, x, y, stream, &halves->sum[i >= (count + 1) / 2]);
        if (batch->count == KERNEL_RAYS) {
            batch_flush(round, batch, counted);
        }
    }
}

// Of two sets of samples, `a` and `b` in number: see PixelRecord. The slope is that of linear light at the pixel.
static inline float square_apart(Rgb difference, Rgb slope, double a, double b)
{
    double red = difference.red * slope.red, green = difference.green * slope.green;
    double blue = difference.blue * slope.blue;
    return (float)(a * b / (3.0 * (a + b) * (a + b)) * (red * red + green * green + blue * blue));
}

static void pixel_finish(const Round *round, size_t pixel, uint32_t count, const Halves *halves)
{
    PixelRecord *record = &round->film->records[pixel];
    float *value = &round->film->rgb[3 * pixel];
    double first = (count + 1) / 2, second = count / 2, before = record->count, now = before + count;
    Rgb mean = rgb_scale(1.0 / count, rgb_add(halves->sum[0], halves->sum[1]));
    Rgb old = rgb(value[0], value[1], value[2]);
    Rgb all = rgb_add(rgb_scale(before / now, old), rgb_scale(count / now, mean));
    value[0] = (float)all.red;
    value[1] = (float)all.green;
    value[2] = (float)all.blue;
    record->count += count;
    if (round->sampling->has_no_estimate) {
        return;
    }
    Rgb slope = linear_slope(&round->prepared->scene->settings, value);
    record->fresh = 0.0f;
    if (second > 0.0) {
        Rgb apart = rgb_add_scaled(rgb_scale(1.0 / first, halves->sum[0]), -1.0 / second, halves->sum[1]);
        record->fresh = square_apart(apart, slope, first, second);
    }
    if (before > 0.0) {
        record->inner = 0.5f * (record->outer + record->fresh);
        record->outer = square_apart(rgb_add_scaled(old, -1.0, mean), slope, before, count);
    } else {
        record->inner = 0.0f;
        record->outer = record->fresh;
    }
}

void round_trace(const Round *round, Tile tile, RenderStatistics *counted)
{
    Halves halves[TILE_PIXELS];
    Batch batch;
    batch.count = 0;
    batch.places.lens = round->prepared->camera.lens_radius > 0.0 ? batch.lens : NULL;
    // Blocks of pixels, so that rays of one call stay near each other.
    for (int i = 0; i < TILE_PIXELS; i++) {
        int block = i / KERNEL_RAYS, blocks = TILE_SIZE / KERNEL_ROW, inside = i % KERNEL_RAYS;
        int x = tile.left + block % blocks * KERNEL_ROW + inside % KERNEL_ROW;
        int y = tile.top + block / blocks * KERNEL_ROW + inside / KERNEL_ROW;
        if (x >= tile.right || y >= tile.bottom) {
            continue;
        }
        uint32_t count = round_samples(round, (size_t)y * (size_t)round->film->width + (size_t)x);
        if (count > 0) {
            Halves *sums = &halves[(y - tile.top) * TILE_SIZE + x - tile.left];
            *sums = (Halves){{rgb_grey(0.0), rgb_grey(0.0)}};
            pixel_add(round, &batch, x, y, count, sums, counted);
        }
    }
    batch_flush(round, &batch, counted);
    for (int y = tile.top; y < tile.bottom; y++) {
        for (int x = tile.left; x < tile.right; x++) {
            size_t pixel = (size_t)y * (size_t)round->film->width + (size_t)x;
            uint32_t count = round_samples(round, pixel);
            if (count > 0) {
                pixel_finish(round, pixel, count, &halves[(y - tile.top) * TILE_SIZE + x - tile.left]);
            }
        }
    }
}
