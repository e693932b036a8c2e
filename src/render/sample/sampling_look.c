// What small shapes would bring to the picture that no sample of a pixel has met.
//
// A pixel is drawn, in proportion to what such shapes may be to it, and two rays are aimed at random places of each of
// them. With a the shape's share of the pixel, L its light and v the pixel's value, which holds nothing of it, the
// pixel is off by the sum of a (L - v): known, and not by chance any more. Two rays, independent of each other, give
// the square of it without a bias. What hides a shape, or looks like it, is in L. docs/sampling.md, "What no sample
// met".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "render/records/camera.h"
#include "render/records/linear.h"
#include "render/sample/alpha.h"
#include "render/sample/sampling.h"
#include "render/sample/sampling_outline.h"
#include "render/sample/scratch.h"

// A pick for so many samples, within limits, so that its rays are few beside those of the picture; no more than so many
// of each pixel, and where pixels are few more, up to LOOK_LEAST: of one highlight 8 tell its light to a third only.
// Each pixel gets LOOK_EACH as long as that takes no more than a pick for LOOK_SAMPLES_EACH.
enum { LOOK_LEAST = 96, LOOK_SAMPLES = 96, LOOK_SAMPLES_EACH = 48, LOOK_EACH = 6, LOOK_EACH_OF_FEW = 32 };

// Columns of a shape in a pixel that are drawn for a ray; more where a lens moves it, mostly beside the pixel.
enum { AIM_COLUMNS = 4, AIM_COLUMNS_LENS = 8 };

// Places of a lamp that are drawn, of which one is taken where it is seen.
enum { AIM_PLACES = 32 };

// What the squares of areas are known to.
static const double AREA_ERROR = 0.0125;

// So that looks draw other numbers than samples and corners.
static const uint32_t LOOK_SEED = UINT32_C(0x7f4a7c15);

static inline bool bit_is_set(const uint64_t *set, uint32_t place)
{
    return set[place / 64] >> (place % 64) & 1;
}

// The same while others may set bits.
static inline bool is_set_now(const uint64_t *set, uint32_t place)
{
    return __atomic_load_n(&set[place / 64], __ATOMIC_RELAXED) >> (place % 64) & 1;
}

static uint32_t place_of(const Small *small, const SmallEntry *entry)
{
    return small_place(small, entry->shape);
}

// Which shapes have been met, in whatever pixel.
static void find_met(Small *small)
{
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        uint32_t begin = small->first[pixel], open = small->open[pixel];
        for (uint32_t i = begin; i < small->first[pixel + 1]; i++) {
            uint32_t place = place_of(small, &small->entries[i]);
            uint64_t bit = UINT64_C(1) << (place % 64);
            small->met[place / 64] |= i - begin < open ? 0 : bit;
        }
    }
}

// What a pixel is taken to be off by for shapes that none of its samples met.
static double open_error(const Small *small, size_t pixel)
{
    const SmallEntry *entries = &small->entries[small->first[pixel]];
    double sum = 0.0;
    for (int i = 0; i < small->open[pixel]; i++) {
        double contrast = entries[i].contrast >= 0.0f ? (double)entries[i].contrast : small->contrast;
        sum += (double)entries[i].share * sqrt(contrast);
    }
    return sum;
}

// How many looks each pixel gets when nothing is known of their contrasts: as many in a part of the picture as in the
// whole, so that the errors of parts add up; 0: pixels are too many for that. Where they are few, by steps.
static int looks_each(double count, double samples)
{
    int each = LOOK_EACH_OF_FEW * count <= LOOK_LEAST ? LOOK_EACH_OF_FEW
               : 2 * LOOK_EACH * count <= LOOK_LEAST  ? 2 * LOOK_EACH
                                                      : LOOK_EACH;
    double most = fmax(samples / LOOK_SAMPLES_EACH, LOOK_LEAST);
    return each * count <= fmin(most, LOOK_MOST) ? each : 0;
}

int look_draw(Looks *looks, const Round *round, double samples)
{
    Small *small = round->small;
    double count = 0.0, sum = 0.0, reached = 0.0, most = fmin(fmax(samples / LOOK_SAMPLES, LOOK_LEAST), LOOK_MOST);
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        double error = small->open[pixel] > 0 ? open_error(small, pixel) : 0.0;
        count += small->open[pixel] > 0;
        sum += error * error;
    }
    looks->count = 0;
    looks->pass++;
    int each = sum > 0.0 ? 0 : looks_each(count, samples);
    most = fmin(most, fmax(LOOK_EACH * count, fmin(LOOK_EACH_OF_FEW * count, LOOK_LEAST)));
    most = each > 0 ? each * count : floor(most);
    looks->sees_all = 2.0 * count <= most;
    find_met(small);
    double even = sum > 0.0 ? 0.5 / count : 1.0 / count, step = 1.0 / most;
    double chance = sample_unit(sampler_pixel_seed(~round->sampling->seed, LOOK_SEED, looks->pass));
    double next = step * (each > 0 ? 0.5 : chance);
    for (uint32_t k = 0; count > 0.0 && k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        if (small->open[pixel] > 0) {
            double error = open_error(small, pixel), share = even + (sum > 0.0 ? 0.5 * error * error / sum : 0.0);
            reached += share;
            for (uint32_t number = 0; next < reached && looks->count < LOOK_MOST; next += step, number++) {
                looks->picks[looks->count++] = (LookPick){.pixel = pixel, .number = number, .weight = 1.0 / share};
            }
        }
    }
    return looks->count;
}

// ---- rays

// Pairs of rays to the same shape, side by side.
typedef struct LookBatch {
    KernelPlaces places;
    Vec3 lens[KERNEL_RAYS];
    SampleStream streams[KERNEL_RAYS];
    Rgb light[KERNEL_RAYS];
    double clear[KERNEL_RAYS], weights[KERNEL_RAYS];
    LookPick *picks[KERNEL_RAYS];
    SmallEntry *entries[KERNEL_RAYS];
    bool is_lamp[KERNEL_RAYS];
    int count;
    bool draws;
    RenderScratch *scratch;
} LookBatch;

static double next_number(uint32_t *seed)
{
    *seed = sample_hash_add(*seed, LOOK_SEED);
    return sample_unit(*seed);
}

// Where a ray to a shape goes: a point of the picture, and of the lens.
typedef struct Aim {
    double x, y, area; // the density of such points is one over it
    SamplePoint lens;
} Aim;

// By how much the point of the lens moves a shape.
static void lens_shift(const PreparedCamera *camera, const Footprint *at, SamplePoint lens, double shift[2])
{
    Vec3 aside = vec3_sub(camera_lens_point(camera, lens), camera->location);
    shift[0] = shift[1] = 0.0;
    for (int k = 0; k < 2; k++) {
        Vec3 axis = k == 0 ? camera->lens_right : camera->lens_up;
        double along = vec3_dot(aside, axis) / vec3_length_squared(axis);
        shift[0] += along * at->lens[k][0];
        shift[1] += along * at->lens[k][1];
    }
}

// The ellipse as rows are drawn, or as columns are, which stand for rows then.
static Outline footprint_outline(const Footprint *at, const double shift[2], bool is_turned)
{
    double x = at->x + shift[0], y = at->y + shift[1], slope = at->xy / (is_turned ? at->xx : at->yy);
    return is_turned ? (Outline){y, x, slope, sqrt(fmax(at->yy - slope * at->xy, 0.0)), 1.0 / at->xx}
                     : (Outline){x, y, slope, sqrt(fmax(at->xx - slope * at->xy, 0.0)), 1.0 / at->yy};
}

// A column of what the pixel's filter reaches of the ellipse, in one of `count` even parts of its width: its ends, and
// the density by which it was drawn. False when there is none.
static bool column_draw(const Footprint *at, const double shift[2], const double pixel[2], double reach, double part,
                        double column[3], double *area)
{
    Outline rows = footprint_outline(at, shift, false), columns = footprint_outline(at, shift, true);
    OutlineColumns all = outline_columns(&rows, pixel[1] - reach, pixel[1] + reach);
    double left = fmax(all.left, pixel[0] - reach), right = fmin(all.right, pixel[0] + reach);
    column[0] = left + part * (right - left);
    if (!(right > left) || !outline_row(&columns, column[0], &column[1], &column[2])) {
        return false;
    }
    column[1] = fmax(column[1], pixel[1] - reach);
    column[2] = fmin(column[2], pixel[1] + reach);
    *area = (right - left) * (column[2] - column[1]);
    return *area > 0.0;
}

// A point of an ellipse that is in the pixel as a whole, drawn evenly: nothing is left to chance but the light.
static bool aim_draw_whole(const Footprint *at, const double pixel[2], double reach, uint32_t *seed, Aim *aim)
{
    const double turn = 6.283185307179586;
    if (fabs(at->x - pixel[0]) + sqrt(at->xx) > reach || fabs(at->y - pixel[1]) + sqrt(at->yy) > reach) {
        return false;
    }
    double radius = sqrt(next_number(seed)), angle = turn * next_number(seed);
    double a = radius * cos(angle), b = radius * sin(angle), slant = at->xy / sqrt(at->xx);
    aim->x = at->x + sqrt(at->xx) * a;
    aim->y = at->y + slant * a + sqrt(fmax(at->yy - slant * slant, 0.0)) * b;
    aim->area = at->area;
    return true;
}

// A point of the part of a shape's ellipse that is in the pixel. Of a shape that is in several, points of the whole
// would be in this one seldom, and both of a pair hardly ever. Some columns, as the lens moves the ellipse, are drawn,
// of which one is taken by the areas that they stand for; the mean of these is that of the part. False when none meets
// the pixel.
static bool aim_draw(const LookBatch *batch, const Small *small, const Footprint *at, const double pixel[2],
                     uint32_t *seed, Aim *aim)
{
    const PreparedCamera *camera = &small->prepared->camera;
    int columns = batch->places.lens ? AIM_COLUMNS_LENS : AIM_COLUMNS;
    double reach = filter_radius(small->filter), chosen[3] = {0.0}, sum = 0.0;
    if (!batch->places.lens && aim_draw_whole(at, pixel, reach, seed, aim)) {
        return true;
    }
    for (int i = 0; i < columns; i++) {
        double shift[2] = {0.0, 0.0}, column[3], area;
        SamplePoint lens = {0.0, 0.0};
        if (batch->places.lens) {
            lens.x = next_number(seed);
            lens.y = next_number(seed);
            lens_shift(camera, at, lens, shift);
        }
        double part = (i + next_number(seed)) / columns;
        if (column_draw(at, shift, pixel, reach, part, column, &area)) {
            sum += area;
            if (next_number(seed) * sum < area) {
                memcpy(chosen, column, sizeof chosen);
                aim->lens = lens;
            }
        }
    }
    if (!(sum > 0.0)) {
        return false;
    }
    aim->x = chosen[0];
    aim->y = chosen[1] + next_number(seed) * (chosen[2] - chosen[1]);
    aim->area = sum / columns;
    return true;
}

// A ray to a place of what the pixel has of the shape. Of a lamp, to a place where it is seen, of some that are drawn:
// their share of those is that of the lamp that is seen.
static void batch_aim(LookBatch *batch, const Small *small, const Footprint *at, size_t pixel, uint32_t seed)
{
    const Film *film = small->film;
    const PreparedCamera *camera = &small->prepared->camera;
    bool is_lamp = small_is_lamp(small->prepared, &at->extent);
    int i = batch->count, places = is_lamp ? AIM_PLACES : 1;
    double middle[2] = {(double)(pixel % (size_t)film->width), (double)(pixel / (size_t)film->width)}, sum = 0.0;
    for (int k = 0; k < places; k++) {
        Aim aim = {at->x, at->y, 0.0, {0.5, 0.5}};
        Vec3 before = batch->lens[i];
        double u = batch->places.u[i], v = batch->places.v[i];
        bool is_in = aim_draw(batch, small, at, middle, &seed, &aim);
        Ray ray;
        if (batch->places.lens) {
            batch->lens[i] = camera_lens_point(camera, aim.lens);
        }
        batch->places.u[i] = film_u(film, 0, aim.x);
        batch->places.v[i] = film_v(film, 0, aim.y);
        (void)camera_place_ray(camera, &batch->places, i, &ray);
        // Where shapes that were not met lie behind each other, each counts for its part.
        double own = 0.0;
        if (is_in && small_is_met(small, at->extent.shape, ray)) {
            own = aim.area * small->norm * small_weight(small, aim.x - middle[0], aim.y - middle[1]) /
                  small_count_open(small, pixel, ray);
        }
        sum += fabs(own);
        if (k == 0 || (own != 0.0 && next_number(&seed) * sum < fabs(own))) {
            batch->weights[i] = own;
        } else { // the place before stays
            batch->lens[i] = before;
            batch->places.u[i] = u;
            batch->places.v[i] = v;
        }
    }
    batch->weights[i] = copysign(sum / places, batch->weights[i]);
    batch->is_lamp[i] = is_lamp;
    batch->streams[i] = (SampleStream){.kind = SAMPLER_RANDOM, .seed = seed, .count = 1, .pair = 2};
    batch->count++;
}

// What the pair of rays from `i` on says of their shape.
static void pair_judge(const Round *round, const LookBatch *batch, int i)
{
    Small *small = round->small;
    LookPick *pick = batch->picks[i];
    SmallEntry *entry = batch->entries[i];
    const float *value = &small->film->rgb[3 * pick->pixel];
    Rgb own = rgb(value[0], value[1], value[2]), apart[2], slope = rgb_grey(1.0);
    bool is_linear = !linear_is_needed(&small->prepared->scene->settings), has_one = false;
    slope = is_linear ? slope : linear_slope(&small->prepared->scene->settings, value);
    for (int k = 0; k < 2; k++) {
        apart[k] = rgb_mul(slope, rgb_add_scaled(batch->light[i + k], -1.0, own));
        pick->sums[k] = rgb_add_scaled(pick->sums[k], batch->weights[i + k], apart[k]);
        if (batch->weights[i + k] != 0.0) {
            Ray ray;
            has_one = true;
            (void)camera_place_ray(&small->prepared->camera, &batch->places, i + k, &ray);
            uint32_t place = place_of(small, entry);
            if (!is_set_now(small->seen, place) && small_is_shown(small, entry->shape, ray)) {
                __atomic_fetch_or(&small->seen[place / 64], UINT64_C(1) << (place % 64), __ATOMIC_RELAXED);
            }
        }
    }
    Rgb square = rgb_mul(apart[0], apart[1]);
    bool has_both = batch->weights[i] != 0.0 && batch->weights[i + 1] != 0.0;
    double mean = batch->is_lamp[i] && !has_both ? 0.0 : (square.red + square.green + square.blue) / 3.0;
    float contrast = (float)fmax(mean, 0.0);
    if (has_one || batch->is_lamp[i]) { // a lamp that is hidden here brings nothing
        entry->contrast = entry->contrast >= 0.0f ? 0.5f * (entry->contrast + contrast) : contrast;
    }
}

static void batch_flush(const Round *round, LookBatch *batch, RenderStatistics *counted)
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
    const KernelCall call = {&batch->places, wanted, batch->draws ? batch->streams : NULL, batch->light, batch->scratch,
                             counted};
    alpha_trace(round->prepared, &call, batch->clear);
    for (int i = 0; i < batch->count; i += 2) {
        pair_judge(round, batch, i);
    }
    batch->count = 0;
}

static void pick_add(const Round *round, LookBatch *batch, LookPick *pick, uint32_t seed, RenderStatistics *counted)
{
    Small *small = round->small;
    for (int j = 0; j < small->open[pick->pixel]; j++) {
        SmallEntry *entry = &small->entries[small->first[pick->pixel] + (uint32_t)j];
        Footprint at = small_footprint(small, entry->shape);
        uint32_t own = sample_hash_add(seed, (uint32_t)j);
        for (uint32_t k = 0; k < 2; k++) {
            batch->picks[batch->count] = pick;
            batch->entries[batch->count] = entry;
            batch_aim(batch, small, &at, pick->pixel, sample_hash_add(own, k));
        }
        if (batch->count == KERNEL_RAYS) {
            batch_flush(round, batch, counted);
        }
    }
}

void look_trace(const Round *round, Looks *looks, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    const Prepared *p = round->prepared;
    const Film *film = round->film;
    LookBatch batch = {.scratch = scratch};
    batch.places.lens = p->camera.lens_radius > 0.0 ? batch.lens : NULL;
    batch.draws = round->draws_more;
    for (int i = 0; i < looks->count; i++) {
        LookPick *pick = &looks->picks[i];
        int x = (int)(pick->pixel % (size_t)film->width), y = (int)(pick->pixel / (size_t)film->width);
        if (x >= tile.left && x < tile.right && y >= tile.top && y < tile.bottom) {
            uint32_t seed =
                sampler_pixel_seed(round->sampling->seed, (uint32_t)(film->left + x), (uint32_t)(film->top + y));
            seed = sample_hash_add(sample_hash_add(seed, looks->pass), pick->number);
            pick_add(round, &batch, pick, seed, counted);
        }
    }
    batch_flush(round, &batch, counted);
}

// ---- what they say

static inline bool is_spot(const SmallEntry *entry)
{
    return shape_kind(entry->shape) == SMALL_IS_SPOT;
}

// Of the area that was looked at, by kind, how much was shown.
static void shown_parts(const Looks *looks, const Small *small, double part[SMALL_KINDS])
{
    double shown[SMALL_KINDS] = {0.0}, all[SMALL_KINDS] = {0.0};
    for (int i = 0; i < looks->count; i++) {
        const LookPick *pick = &looks->picks[i];
        for (int j = 0; j < small->open[pick->pixel]; j++) {
            const SmallEntry *entry = &small->entries[small->first[pick->pixel] + (uint32_t)j];
            double weighted = pick->weight * (double)entry->share;
            all[is_spot(entry)] += weighted;
            shown[is_spot(entry)] += bit_is_set(small->seen, place_of(small, entry)) ? weighted : 0.0;
        }
    }
    for (int kind = 0; kind < SMALL_KINDS; kind++) {
        part[kind] = looks->sees_all ? 1.0 : all[kind] > 0.0 ? shown[kind] / all[kind] : 0.0;
    }
}

// What no sample met and a look showed. Where not all were looked at, as much of the others as of those.
static void count_unmet(Looks *looks, Small *small)
{
    double part[SMALL_KINDS];
    shown_parts(looks, small, part);
    for (int kind = 0; kind < SMALL_KINDS; kind++) {
        looks->unmet[kind] = (UnmetShapes){0.0, 0.0};
    }
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        for (uint32_t i = small->first[pixel]; i < small->first[pixel] + small->open[pixel]; i++) {
            uint32_t place = place_of(small, &small->entries[i]);
            UnmetShapes *unmet = &looks->unmet[is_spot(&small->entries[i])];
            if (bit_is_set(small->met, place) || (looks->sees_all && !bit_is_set(small->seen, place))) {
                continue;
            }
            unmet->count += bit_is_set(small->counted, place) ? 0.0 : 1.0;
            unmet->area += (double)small->entries[i].share;
            small->counted[place / 64] |= UINT64_C(1) << (place % 64);
        }
    }
    memset(small->counted, 0, small->words * sizeof *small->counted);
    for (int kind = 0; kind < SMALL_KINDS; kind++) {
        looks->unmet[kind].count = round(part[kind] * looks->unmet[kind].count);
        looks->unmet[kind].area *= part[kind];
    }
}

void look_judge(Looks *looks, const Round *round)
{
    double sum = 0.0, squares = 0.0, count = looks->count;
    for (int i = 0; i < looks->count; i++) {
        const LookPick *pick = &looks->picks[i];
        Rgb product = rgb_mul(pick->sums[0], pick->sums[1]);
        double term = pick->weight * (product.red + product.green + product.blue) / 3.0;
        sum += term;
        squares += term * term;
    }
    double mean = sum / count;
    looks->square = fmax(mean, 0.0);
    looks->variance = fmax(squares / count - mean * mean, 0.0) / (count - 1.0);
    small_set_law(round->small);
    count_unmet(looks, round->small);
}

// sqrt(a + b) and the ends of its interval, of two independent parts.
void look_tell(const Looks *looks, double pixels, SamplingError *error)
{
    double own = error->rmse * error->rmse, more = looks->square / pixels, all = own + more;
    double by_own = own * error_relative(error);
    double by_looks = hypot(sqrt(looks->variance), AREA_ERROR * looks->square) / pixels;
    for (int kind = 0; kind < SMALL_KINDS; kind++) {
        error->unmet[kind] = looks->unmet[kind];
    }
    error->unmet_is_all = looks->sees_all;
    if (all > 0.0) {
        error->rmse = sqrt(all);
        error_set_interval(error, hypot(by_own, by_looks) / all);
    }
}

void look_show(const Looks *looks, const Small *small, Film *film, const SamplingError *error)
{
    double sum = 0.0, scale = (exp2(-2.0 * error->slope) - 1.0) / (error->pixel_scale * error->pixel_scale);
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        double own = small->open[pixel] > 0 ? open_error(small, pixel) : 0.0;
        sum += own * own;
    }
    scale *= sum > 0.0 ? looks->square / sum : 0.0; // all together as they were found
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        if (small->open[pixel] > 0) {
            double own = open_error(small, pixel);
            film->records[pixel].outer += (float)(scale * own * own);
        }
    }
}
