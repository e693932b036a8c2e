// A run's rounds, looks and audits: tiles of rays are traced, and the pixels' records say what that means.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_run.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "render/sample/tiles.h"

static void forward_progress(void *client, double done)
{
    const Sampling *s = client;
    double now = (double)s->estimate.samples + s->sliced_samples + done * s->round_samples;
    bool is_known = s->all_samples > 0.0, has_time = is_known && s->sample_seconds > 0.0;
    RenderProgress progress = {is_known ? fmin(now / s->all_samples, 1.0) : 0.0, s->error,
                               has_time ? s->later_seconds + (1.0 - done) * s->round_seconds : -1.0};
    s->options->progress(s->options->client, &progress);
}

static void trace_tile(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    Sampling *s = client;
    bool stops = stop_has_choice(s->wanted);
    if (s->traces == TRACES_REPLICAS && stops) {
        stop_trace_replicas(&s->round, &s->audit, tile.left, tile.right, scratch, counted);
    } else if (stops) {
        stop_trace(&s->round, tile, scratch, counted);
    } else if (s->traces == TRACES_REPLICAS) {
        round_trace_replicas(&s->round, &s->audit, tile.left, tile.right, scratch, counted);
    } else if (s->traces == TRACES_LOOKS) {
        look_trace(&s->round, &s->looks, tile, scratch, counted);
    } else if (s->round.is_corners) {
        round_trace_corners(&s->round, tile, scratch, counted);
    } else {
        round_trace(&s->round, tile, scratch, counted);
    }
}

// What trace_tile left; see tile_bytes.h.
static void code_tile(void *client, Tile tile, TileBytes *bytes)
{
    Sampling *s = client;
    if (s->traces == TRACES_REPLICAS) {
        audit_code(&s->audit, tile.left, tile.right, bytes);
    } else if (s->traces == TRACES_LOOKS) {
        look_code(&s->round, &s->looks, tile, bytes);
    } else if (s->round.is_corners) {
        round_code_corners(&s->round, tile, bytes);
    } else {
        round_code(&s->round, tile, bytes);
    }
}

double sampling_seconds(const Sampling *s)
{
    const TileShare *share = s->wanted->time_limit > 0.0 ? s->options->share : NULL;
    double own = clock_seconds();
    return share ? share->seconds(share->client, own) : own;
}

void sampling_find_bias(Sampling *s)
{
    double by_level = (double)s->statistics->cut_by_level, by_weight = (double)s->statistics->cut_by_weight, sum = 0.0;
    if (by_level + by_weight == 0.0) {
        return;
    }
    for (size_t i = 0; i < 3 * (size_t)pixel_count(s); i++) {
        sum += s->film->rgb[i];
    }
    double mean = sum / (3.0 * pixel_count(s)), unit = 0x1p-32 / (double)s->statistics->camera_rays;
    s->error->bias = (by_level + by_weight) * unit * mean;
    s->error->bias_by_level = by_level * unit * mean;
}

bool sampling_trace(Sampling *s)
{
    double start = sampling_seconds(s);
    int more = s->round.is_corners ? 1 : 0; // there are more corners than pixels
    TileWork work = {.client = s,
                     .prepared = s->prepared,
                     .width = s->film->width + more,
                     .height = s->film->height + more,
                     .trace = trace_tile,
                     .progress = s->options->progress ? forward_progress : NULL,
                     .code = code_tile};
    s->result = tiles_run(&work, s->options, s->statistics);
    bool is_whole = s->result == RENDER_OK;
    s->round_end = sampling_seconds(s);
    if (is_whole) {
        s->sample_seconds = (s->round_end - start) / s->round_samples;
    }
    return is_whole;
}

// Whether a round of all pixels is too early to be judged: halves of one sample say little, and no ratio goes by it.
static bool is_early(const Sampling *s)
{
    bool is_last = !s->wanted->is_adaptive && s->round.count >= s->wanted->samples;
    return s->round.count > 0 && s->round.count < START_SAMPLES && !is_last;
}

bool sampling_round(Sampling *s)
{
    bool is_whole = sampling_trace(s);
    if (is_whole) {
        atomic_store(&s->prepared->abandon->keeps, true);
    } else if (!atomic_load(&s->prepared->abandon->keeps)) {
        return false; // rays were left out of what is there
    }
    if (stop_has_choice(s->wanted)) {
        estimate_now(&s->estimate, s->film, &s->round, s->error);
        s->error->is_known = s->error->is_known && !s->wanted->has_no_estimate;
        sampling_find_bias(s);
    } else if (!s->wanted->has_no_estimate && !(is_whole && is_early(s))) {
        estimate_update(&s->estimate, s->film, &s->round, is_whole, s->error);
        sampling_find_bias(s);
    } else {
        s->estimate.samples += (uint64_t)s->round_samples;
        s->error->samples = (double)s->estimate.samples / pixel_count(s);
    }
    return is_whole;
}

// Traces what changes no pixel, so that any ray may be left out; false when it was cancelled.
static bool trace_beside(Sampling *s, Traces traces)
{
    bool keeps = atomic_exchange(&s->prepared->abandon->keeps, false);
    TileWork work = {.client = s,
                     .prepared = s->prepared,
                     .width = s->film->width,
                     .height = s->film->height,
                     .trace = trace_tile,
                     .code = code_tile};
    if (traces == TRACES_REPLICAS) { // a row of picks, which are anywhere
        work.width = s->audit.count;
        work.height = 1;
    }
    s->traces = traces;
    RenderResult result = tiles_run(&work, s->options, &s->audited);
    s->traces = TRACES_ROUND;
    atomic_store(&s->prepared->abandon->keeps, keeps);
    s->result = result == RENDER_NO_MEMORY || result == RENDER_NOT_SHARED ? result : s->result;
    return result == RENDER_OK;
}

bool sampling_has_audit(const SamplingOptions *wanted)
{
    return sampler_is_sequence(wanted->sampler) || stop_has_choice(wanted);
}

bool sampling_look(Sampling *s)
{
    s->looks.count = 0;
    s->looks.square = s->looks.variance = 0.0;
    s->looks.sees_all = true;
    memset(s->looks.unmet, 0, sizeof s->looks.unmet);
    if (!s->round.small || look_draw(&s->looks, &s->round, (double)s->estimate.samples) == 0) {
        return true;
    }
    bool is_whole = trace_beside(s, TRACES_LOOKS);
    if (is_whole) {
        look_judge(&s->looks, &s->round);
    }
    return is_whole;
}

bool sampling_audit(Sampling *s)
{
    if (!s->error->is_known) {
        return true;
    }
    if (!sampling_look(s)) {
        return false;
    }
    if (s->round.share) {
        share_set_contrasts(&s->round);
    }
    if (sampling_has_audit(s->wanted) && audit_draw(&s->audit, &s->estimate, &s->round) > 0) {
        if (!trace_beside(s, TRACES_REPLICAS)) {
            return false;
        }
        audit_judge(&s->audit, &s->estimate, s->error);
    }
    if (s->round.small) {
        look_tell(&s->looks, pixel_count(s), s->error);
    }
    return true;
}

typedef struct Range {
    float low[3], high[3];
    uint32_t samples; // the fewest of a pixel
} Range;

static void range_add(Range *range, const Film *film, Tile part, int step)
{
    for (int y = part.top; y < part.bottom; y += step) {
        for (int x = part.left; x < part.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            const float *value = &film->rgb[3 * pixel];
            uint32_t count = film->records[pixel].count;
            range->samples = count < range->samples ? count : range->samples;
            for (int c = 0; c < 3; c++) {
                range->low[c] = value[c] < range->low[c] ? value[c] : range->low[c];
                range->high[c] = value[c] > range->high[c] ? value[c] : range->high[c];
            }
        }
    }
}

void sampling_find_missed(Sampling *s)
{
    const Film *film = s->film;
    Range range = {{HUGE_VALF, HUGE_VALF, HUGE_VALF}, {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF}, UINT32_MAX};
    for (Tile block = {0}; round_next_judged(&s->round, &block);) {
        // Where some pixels stand for all, one row of a block does for it.
        range_add(&range, film, block, s->round.counts_some ? JUDGED_BLOCK : 1);
    }
    double contrast = 0.0;
    for (int c = 0; c < 3; c++) {
        contrast = fmax(contrast, (double)(range.high[c] - range.low[c]));
    }
    s->error->missed_area = fmin(3.0 / range.samples, 1.0);
    s->error->missed_error = s->error->missed_area * contrast / sqrt(pixel_count(s));
}
