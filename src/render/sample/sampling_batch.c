// Samples on their way through the kernel, and into their sums.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_batch.h"

#include "render/records/camera.h"
#include "render/sample/alpha.h"

void batch_init(Batch *batch, const Round *round, RenderScratch *scratch)
{
    const Prepared *p = round->prepared;
    bool has_lens = p->camera.lens_radius > 0.0;
    batch->scratch = scratch;
    batch->count = batch->run_count = 0;
    batch->is_box = round->filter.kind == FILTER_BOX;
    batch->meets = batch->avoids = false;
    batch->keeps_squares = round->sampling->is_adaptive || stop_has_choice(round->sampling);
    batch->places.lens = has_lens ? batch->lens : NULL;
    batch->draws = round->draws_more;
}

void batch_trace(const Round *round, Batch *batch, uint64_t wanted, RenderStatistics *counted)
{
    const KernelCall call = {&batch->places, wanted, batch->draws ? batch->streams : NULL, batch->light, batch->scratch,
                             counted};
    alpha_trace(round->prepared, &call, batch->clear);
}

static void run_add(const Round *round, const Batch *batch, const Run *run, int begin)
{
    SampleSums *parts = run->parts;
    Rgb sum = parts->sum[run->which];
    for (int i = begin; i < run->end; i++) {
        Rgb light = batch->is_box ? batch->light[i] : rgb_scale(batch->weights[i], batch->light[i]);
        sum = rgb_add(sum, light);
        if (batch->keeps_squares) {
            parts->squares = rgb_add(parts->squares, rgb_mul(light, light));
        }
    }
    parts->sum[run->which] = sum;
    if (parts->shares) {
        share_add(parts->shares, run->which, &batch->in_x[begin], &batch->in_y[begin], &batch->light[begin],
                  run->end - begin);
    }
    for (int i = begin; round->prepared->has_alpha && i < run->end; i++) {
        parts->clear += (batch->is_box ? 1.0 : batch->weights[i]) * batch->clear[i];
    }
}

// Where in their pixels, and on the lens, the samples are.
static void batch_place(const Round *round, Batch *batch)
{
    const Film *film = round->film;
    double *x = batch->in_x, *y = batch->in_y;
    sample_next_of(round->prepared->points, batch->streams, NULL, (uint32_t)batch->count, x, y);
    for (int i = 0; i < batch->count; i++) {
        FilterSample at = {x[i] - 0.5, y[i] - 0.5, 1.0};
        if (!batch->is_box) {
            at = filter_sample(&round->filter, (SamplePoint){x[i], y[i]});
            batch->weights[i] = at.weight;
        }
        batch->places.u[i] = film_u(film, batch->x[i], at.x);
        batch->places.v[i] = film_v(film, batch->y[i], at.y);
    }
    double lens_x[KERNEL_RAYS], lens_y[KERNEL_RAYS];
    if (batch->places.lens) {
        sample_next_of(round->prepared->points, batch->streams, NULL, (uint32_t)batch->count, lens_x, lens_y);
    }
    for (int i = 0; batch->places.lens && i < batch->count; i++) {
        batch->lens[i] = camera_lens_point(&round->prepared->camera, (SamplePoint){lens_x[i], lens_y[i]});
    }
}

// Tells small shapes which of them are met.
static void batch_meet(const Round *round, const Batch *batch)
{
    for (int run = 0, i = 0; run < batch->run_count; run++) {
        int end = batch->runs[run].end;
        size_t pixel = (size_t)batch->y[i] * (size_t)round->film->width + (size_t)batch->x[i];
        for (; i < end && small_open(round->small, pixel) > 0; i++) {
            Ray ray;
            if (camera_place_ray(&round->prepared->camera, &batch->places, i, &ray)) {
                small_meet(round->small, pixel, ray);
            }
        }
        i = end;
    }
}

static void batch_avoid(const Round *round, Batch *batch)
{
    for (int i = 0; i < batch->count; i++) {
        size_t pixel = (size_t)batch->y[i] * (size_t)round->film->width + (size_t)batch->x[i];
        Ray ray;
        if (small_open(round->small, pixel) > 0 &&
            camera_place_ray(&round->prepared->camera, &batch->places, i, &ray) &&
            small_count_open(round->small, pixel, ray) > 0) {
            const float *value = &round->film->rgb[3 * pixel];
            batch->light[i] = rgb(value[0], value[1], value[2]);
        }
    }
}

void batch_flush(const Round *round, Batch *batch, RenderStatistics *counted)
{
    if (batch->count == 0) {
        return;
    }
    batch_place(round, batch);
    for (int i = batch->count; i < KERNEL_RAYS; i++) {
        batch->places.u[i] = batch->places.u[batch->count - 1];
        batch->places.v[i] = batch->places.v[batch->count - 1];
        if (batch->places.lens) {
            batch->lens[i] = batch->lens[batch->count - 1];
        }
    }
    if (batch->meets) {
        batch_meet(round, batch);
    }
    uint64_t wanted = ~UINT64_C(0) >> (KERNEL_RAYS - batch->count);
    batch_trace(round, batch, wanted, counted);
    if (batch->avoids) {
        batch_avoid(round, batch);
    }
    int begin = 0;
    for (int i = 0; i < batch->run_count; i++) {
        run_add(round, batch, &batch->runs[i], begin);
        begin = batch->runs[i].end;
    }
    batch->count = batch->run_count = 0;
}
