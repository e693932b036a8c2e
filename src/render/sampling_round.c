// One round: samples are gathered into calls of the kernel, their light is summed by pixel and half, and what the
// halves say goes into the pixels' records.
//
// SPDX-License-Identifier: MIT
#include "render/camera.h"
#include "render/linear.h"
#include "render/sampling.h"
#include "render/tiles.h"

enum { TILE_PIXELS = TILE_SIZE * TILE_SIZE };

// So that rays through middles draw other numbers than the samples of their pixel.
static const uint32_t MIDDLE_SEED = UINT32_C(0x9e3779b9);

// Sums over the halves of a pixel's new samples; over their quarters where the pixel starts.
typedef struct Parts {
    Rgb sum[START_SAMPLES];
} Parts;

// Samples on their way through the kernel.
typedef struct Batch {
    KernelPlaces places;
    Vec3 lens[KERNEL_RAYS];
    SampleStream streams[KERNEL_RAYS];
    double weights[KERNEL_RAYS];
    Rgb *sums[KERNEL_RAYS];
    Rgb light[KERNEL_RAYS];
    int count;
    bool draws; // whether anything but the place in the pixel is drawn from the streams
} Batch;

// A pixel that takes part.
typedef struct Chosen {
    int x, y;
    size_t index;
    uint32_t count; // samples that it gets
} Chosen;

uint32_t round_samples(const Round *round, size_t pixel)
{
    uint32_t count = round->film->records[pixel].count;
    if (!round_has(round, pixel)) {
        return 0;
    }
    return round->count > 0 ? round->count - count : round_starts(round, count) ? START_SAMPLES : count;
}

static void batch_init(Batch *batch, const Prepared *p)
{
    bool has_lens = p->camera.lens_radius > 0.0;
    batch->count = 0;
    batch->places.lens = has_lens ? batch->lens : NULL;
    batch->draws = has_lens || (p->kernel->features & RENDER_LIGHTS);
}

static void batch_trace(const Round *round, Batch *batch, uint64_t wanted, RenderStatistics *counted)
{
    const Prepared *p = round->prepared;
    p->kernel->trace(p, &batch->places, batch->draws ? batch->streams : NULL, wanted, batch->light, counted);
}

static void batch_flush(const Round *round, Batch *batch, RenderStatistics *counted)
{
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
    batch_trace(round, batch, wanted, counted);
    for (int i = 0; i < batch->count; i++) {
        *batch->sums[i] = rgb_add_scaled(*batch->sums[i], batch->weights[i], batch->light[i]);
    }
    batch->count = 0;
}

// Some samples of a pixel, for one sum, or for a sum each; there is room for them. `stream` is that of the first.
static void batch_add(const Round *round, Batch *batch, const Chosen *pixel, const SampleStream *stream,
                      uint32_t count, Rgb *sum, bool has_sums)
{
    const Film *film = round->film;
    SamplePoint places[KERNEL_RAYS];
    bool is_box = round->filter.kind == FILTER_BOX;
    sample_places(stream, count, places);
    for (uint32_t j = 0; j < count; j++) {
        int i = batch->count++;
        FilterSample at = {places[j].x - 0.5, places[j].y - 0.5, 1.0};
        at = is_box ? at : filter_sample(&round->filter, places[j]);
        batch->places.u[i] = film_u(film, pixel->x, at.x);
        batch->places.v[i] = film_v(film, pixel->y, at.y);
        batch->weights[i] = at.weight;
        batch->sums[i] = has_sums ? sum + j : sum;
        if (!batch->draws) {
            continue;
        }
        batch->streams[i] = *stream;
        batch->streams[i].index += j;
        batch->streams[i].pair++;
        if (batch->places.lens) {
            batch->lens[i] = camera_lens_point(&round->prepared->camera, sample_next(&batch->streams[i]));
        }
    }
}

static uint32_t pixel_seed(const Round *round, int x, int y)
{
    const Film *film = round->film;
    return sampler_pixel_seed(round->sampling->seed, (uint32_t)(film->left + x), (uint32_t)(film->top + y));
}

static void pixel_add(const Round *round, Batch *batch, const Chosen *pixel, Parts *parts, RenderStatistics *counted)
{
    uint32_t had = round->film->records[pixel->index].count, count = pixel->count;
    bool starts = round_starts(round, had);
    uint32_t before = starts ? 0 : had;
    SampleStream stream = {
        .kind = round->sampling->sampler,
        .seed = pixel_seed(round, pixel->x, pixel->y),
        .first = before,
        .count = count};
    for (uint32_t i = 0; i < count;) {
        uint32_t half = (count + 1) / 2, room = (uint32_t)(KERNEL_RAYS - batch->count);
        uint32_t part = starts ? i : i >= half, end = !starts && i < half ? half : count;
        uint32_t some = end - i < room ? end - i : room;
        stream.index = before + i;
        batch_add(round, batch, pixel, &stream, some, &parts->sum[part], starts);
        if (batch->count == KERNEL_RAYS) {
            batch_flush(round, batch, counted);
        }
        i += some;
    }
}

// Of two sets of samples, `a` and `b` in number: see PixelRecord. The slope is that of linear light at the pixel.
static inline float square_apart(Rgb difference, Rgb slope, double a, double b)
{
    double red = difference.red * slope.red, green = difference.green * slope.green;
    double blue = difference.blue * slope.blue;
    return (float)(a * b / (3.0 * (a + b) * (a + b)) * (red * red + green * green + blue * blue));
}

static void value_put(float *value, Rgb light)
{
    value[0] = (float)light.red;
    value[1] = (float)light.green;
    value[2] = (float)light.blue;
}

// A pixel that had the ray through its middle only, which is left out of its mean. How far the two are apart is kept
// for sampling_pilot.c.
static void pixel_start(const Round *round, size_t pixel, const Parts *parts)
{
    PixelRecord *record = &round->film->records[pixel];
    float *value = &round->film->rgb[3 * pixel];
    const Rgb *sum = parts->sum;
    Rgb middle = rgb(value[0], value[1], value[2]);
    Rgb halves[2] = {rgb_scale(0.5, rgb_add(sum[0], sum[1])), rgb_scale(0.5, rgb_add(sum[2], sum[3]))};
    Rgb mean = rgb_scale(0.5, rgb_add(halves[0], halves[1]));
    value_put(value, mean);
    Rgb slope = linear_slope(&round->prepared->scene->settings, value);
    float first = square_apart(rgb_add_scaled(sum[0], -1.0, sum[1]), slope, 1.0, 1.0);
    float second = square_apart(rgb_add_scaled(sum[2], -1.0, sum[3]), slope, 1.0, 1.0);
    *record = (PixelRecord){
        .count = START_SAMPLES,
        .outer = square_apart(rgb_add_scaled(halves[0], -1.0, halves[1]), slope, 2.0, 2.0),
        .inner = 0.5f * (first + second),
        .fresh = round->is_pilot ? 4.0f * square_apart(rgb_add_scaled(middle, -1.0, mean), slope, 1.0, 1.0) : second};
}

static void pixel_finish(const Round *round, size_t pixel, uint32_t count, const Parts *parts)
{
    PixelRecord *record = &round->film->records[pixel];
    float *value = &round->film->rgb[3 * pixel];
    double first = (count + 1) / 2, second = count / 2, before = record->count, now = before + count;
    if (round_starts(round, record->count)) {
        pixel_start(round, pixel, parts);
        return;
    }
    Rgb mean = rgb_scale(1.0 / count, rgb_add(parts->sum[0], parts->sum[1]));
    Rgb old = rgb(value[0], value[1], value[2]);
    Rgb all = rgb_add(rgb_scale(before / now, old), rgb_scale(count / now, mean));
    value_put(value, all);
    record->count += count;
    if (round->sampling->has_no_estimate) {
        return;
    }
    Rgb slope = linear_slope(&round->prepared->scene->settings, value);
    record->fresh = 0.0f;
    if (second > 0.0) {
        Rgb apart = rgb_add_scaled(rgb_scale(1.0 / first, parts->sum[0]), -1.0 / second, parts->sum[1]);
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

// The pixels of a block that take part.
static Chosen *block_choose(const Round *round, Tile block, Chosen *chosen)
{
    for (int y = block.top; y < block.bottom; y++) {
        size_t begin = (size_t)y * (size_t)round->film->width;
        for (int x = block.left; x < block.right; x++) {
            uint32_t count = round_samples(round, begin + (size_t)x);
            if (count > 0) {
                *chosen++ = (Chosen){x, y, begin + (size_t)x, count};
            }
        }
    }
    return chosen;
}

void round_trace(const Round *round, Tile tile, RenderStatistics *counted)
{
    Chosen chosen[TILE_PIXELS], *end = chosen;
    Parts parts[TILE_PIXELS];
    Batch batch;
    batch_init(&batch, round->prepared);
    // Blocks of pixels, so that rays of one call stay near each other.
    for (int top = tile.top; top < tile.bottom; top += KERNEL_ROW) {
        for (int left = tile.left; left < tile.right; left += KERNEL_ROW) {
            Tile block = {left, top, left + KERNEL_ROW < tile.right ? left + KERNEL_ROW : tile.right,
                          top + KERNEL_ROW < tile.bottom ? top + KERNEL_ROW : tile.bottom};
            end = block_choose(round, block, end);
        }
    }
    for (const Chosen *pixel = chosen; pixel < end; pixel++) {
        Parts *sums = &parts[pixel - chosen];
        *sums = (Parts){{rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0), rgb_grey(0.0)}};
        pixel_add(round, &batch, pixel, sums, counted);
    }
    batch_flush(round, &batch, counted);
    for (const Chosen *pixel = chosen; pixel < end; pixel++) {
        pixel_finish(round, pixel->index, pixel->count, &parts[pixel - chosen]);
    }
}

// The middles of a block of pixels; where it is cut off, its last ones are traced again.
static void block_middles(const Round *round, Tile block, Batch *batch, RenderStatistics *counted)
{
    const Film *film = round->film;
    for (int i = 0; i < KERNEL_RAYS; i++) {
        int x = block.left + i % KERNEL_ROW, y = block.top + i / KERNEL_ROW;
        x = x < block.right ? x : block.right - 1;
        y = y < block.bottom ? y : block.bottom - 1;
        batch->places.u[i] = film_u(film, x, 0.0);
        batch->places.v[i] = film_v(film, y, 0.0);
        if (batch->draws) {
            batch->streams[i] = (SampleStream){.kind = round->sampling->sampler,
                                               .seed = pixel_seed(round, x, y) ^ MIDDLE_SEED,
                                               .count = 1,
                                               .pair = 1};
        }
        if (batch->places.lens) {
            batch->lens[i] = camera_lens_point(&round->prepared->camera, sample_next(&batch->streams[i]));
        }
    }
    uint64_t wanted = 0;
    for (int row = 0; row < block.bottom - block.top; row++) {
        wanted |= (UINT64_C(0xff) >> (KERNEL_ROW - (block.right - block.left))) << (row * KERNEL_ROW);
    }
    batch_trace(round, batch, wanted, counted);
    for (; wanted; wanted &= wanted - 1) {
        int i = __builtin_ctzll(wanted);
        size_t y = (size_t)(block.top + i / KERNEL_ROW), x = (size_t)(block.left + i % KERNEL_ROW);
        size_t pixel = y * (size_t)film->width + x;
        value_put(&film->rgb[3 * pixel], batch->light[i]);
        film->records[pixel] = (PixelRecord){.count = 1};
    }
}

void round_trace_middles(const Round *round, Tile tile, RenderStatistics *counted)
{
    Batch batch;
    batch_init(&batch, round->prepared);
    for (int top = tile.top; top < tile.bottom; top += KERNEL_ROW) {
        for (int left = tile.left; left < tile.right; left += KERNEL_ROW) {
            Tile block = {left, top, left + KERNEL_ROW < tile.right ? left + KERNEL_ROW : tile.right,
                          top + KERNEL_ROW < tile.bottom ? top + KERNEL_ROW : tile.bottom};
            block_middles(round, block, &batch, counted);
        }
    }
}
