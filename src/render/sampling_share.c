// Strata of pixels that outlines of spheres cross: see sampling_share.h.
//
// First each outline is put into the pixels that it crosses, and hides what is farther in those that it covers; then
// each pixel takes what is nearest of what it has seen. Which stratum is too small to be weighted by its share goes by
// that share and the number of samples, never by where these fell, which would bend the mean.
//
// SPDX-License-Identifier: MIT
#include "render/sampling_share.h"

#include <stdlib.h>

#include "render/sampling_batch.h"
#include "trace/extent.h"

// A stratum is weighted by its share where so many samples are expected in it; with 2 none falls into it once in
// thousands of times.
static const double EXPECTED_LEAST = 2.0;

// Less of a pixel is no stratum: shares are known to so much.
static const double AREA_LEAST = 0x1p-13;

typedef struct Candidate {
    float distance;
    uint32_t place; // of extent_get
} Candidate;

typedef struct Builder {
    const Prepared *prepared;
    const Film *film;
    OutlineView view;
    float *cover;          // of each pixel: the least distance of what covers it all
    uint8_t *counts;       // of each pixel's candidates
    Candidate *candidates; // OUTLINES_ROUGH a pixel
    Share *share;
    uint32_t used; // strata
} Builder;

// ---- which outlines cross a pixel

static bool is_nearer(Candidate a, Candidate b)
{
    return a.distance < b.distance || (a.distance == b.distance && a.place < b.place);
}

// Keeps the nearest ones.
static void candidate_add(Builder *builder, size_t pixel, Candidate candidate)
{
    Candidate *list = &builder->candidates[pixel * OUTLINES_ROUGH];
    int i = builder->counts[pixel];
    if (i == OUTLINES_ROUGH) {
        if (!is_nearer(candidate, list[--i])) {
            return;
        }
    } else {
        builder->counts[pixel]++;
    }
    for (; i > 0 && is_nearer(candidate, list[i - 1]); i--) {
        list[i] = list[i - 1];
    }
    list[i] = candidate;
}

static void outline_put(Builder *builder, const Outline *outline, Candidate candidate)
{
    const Film *film = builder->film;
    double height = outline_half_height(outline);
    double top = fmax(ceil(outline->y - height - 0.5) - film->top, 0.0);
    double bottom = fmin(floor(outline->y + height + 0.5) - film->top, film->height - 1.0);
    for (double row = top; row <= bottom; row++) {
        double y = row + film->top;
        OutlineColumns columns = outline_columns(outline, y - 0.5, y + 0.5);
        double left = fmax(ceil(columns.left - 0.5) - film->left, 0.0);
        double right = fmin(floor(columns.right + 0.5) - film->left, film->width - 1.0);
        for (double column = left; column <= right; column++) {
            size_t pixel = (size_t)row * (size_t)film->width + (size_t)column;
            double x = column + film->left;
            if (x - 0.5 >= columns.inner_left && x + 0.5 <= columns.inner_right) {
                builder->cover[pixel] = fminf(builder->cover[pixel], candidate.distance);
            } else {
                candidate_add(builder, pixel, candidate);
            }
        }
    }
}

static bool builder_begin(Builder *builder)
{
    size_t pixels = (size_t)builder->film->width * (size_t)builder->film->height;
    builder->cover = malloc(pixels * sizeof *builder->cover);
    builder->counts = calloc(pixels, sizeof *builder->counts);
    builder->candidates = malloc(pixels * OUTLINES_ROUGH * sizeof *builder->candidates);
    if (!builder->cover || !builder->counts || !builder->candidates) {
        return false;
    }
    for (size_t i = 0; i < pixels; i++) {
        builder->cover[i] = HUGE_VALF;
    }
    return true;
}

static bool sphere_outline(const Builder *builder, uint32_t place, Outline *outline, double *distance)
{
    Extent extent;
    return extent_get(builder->prepared->geometry, place, &extent) && extent.is_ball &&
           shape_kind(extent.shape) == SHAPE_SPHERE &&
           outline_of(&builder->view, extent.centre, extent.axes[0].x * extent.axes[0].x, outline, distance);
}

// False when out of memory; leaves counts as NULL where there are no outlines.
static bool builder_put_all(Builder *builder)
{
    uint32_t places = extent_count(builder->prepared->geometry);
    for (uint32_t place = 0; place < places; place++) {
        Outline outline;
        double distance;
        if (sphere_outline(builder, place, &outline, &distance)) {
            if (!builder->counts && !builder_begin(builder)) {
                return false;
            }
            outline_put(builder, &outline, (Candidate){(float)distance, place});
        }
    }
    return true;
}

// ---- strata

// Leaves out outlines of which nearly nothing is seen in the pixel, and of more than can be held those with the least.
// Returns how many are left.
static int outlines_choose(Outline *outlines, int count)
{
    double areas[OUTLINES_ROUGH + 1];
    if (count > 1) {
        outline_areas_roughly(outlines, count, areas);
    }
    for (bool is_done = count < 2; !is_done;) {
        int least = 0;
        for (int i = 1; i < count; i++) {
            least = areas[i] < areas[least] ? i : least;
        }
        is_done = count < 2 || (count <= OUTLINES_MOST && areas[least] >= AREA_LEAST);
        for (int i = least; !is_done && i + 1 < count; i++) {
            outlines[i] = outlines[i + 1];
            areas[i] = areas[i + 1];
        }
        count -= !is_done;
    }
    return count;
}

static bool strata_add(Builder *builder, const Outline *outlines, int count, const double *areas)
{
    Share *share = builder->share;
    if (builder->used + (size_t)STRATA_MOST > share->capacity) {
        size_t capacity = 2 * share->capacity + 64 * STRATA_MOST;
        ShareStratum *strata = realloc(share->strata, capacity * sizeof *strata);
        if (!strata) {
            return false;
        }
        share->strata = strata;
        share->capacity = capacity;
    }
    for (int i = 0; i <= count; i++) {
        share->strata[builder->used++] =
            (ShareStratum){.outline = i < count ? outlines[i] : (Outline){0}, .area = areas[i]};
    }
    return true;
}

static bool pixel_take(Builder *builder, size_t pixel)
{
    const Film *film = builder->film;
    double x = film->left + (double)(pixel % (size_t)film->width),
           y = film->top + (double)(pixel / (size_t)film->width);
    double areas[OUTLINES_MOST + 1], distance;
    Outline outlines[OUTLINES_ROUGH];
    int count = 0;
    for (int i = 0; i < builder->counts[pixel]; i++) {
        Candidate candidate = builder->candidates[pixel * OUTLINES_ROUGH + (size_t)i];
        if (candidate.distance < builder->cover[pixel] &&
            sphere_outline(builder, candidate.place, &outlines[count], &distance)) {
            outlines[count].x -= x;
            outlines[count++].y -= y;
        }
    }
    count = outlines_choose(outlines, count);
    outline_areas(outlines, count, areas);
    bool is_whole = count == 0 || (count == 1 && (areas[0] < AREA_LEAST || areas[1] < AREA_LEAST));
    return is_whole || strata_add(builder, outlines, count, areas);
}

static bool builder_take_all(Builder *builder)
{
    size_t pixels = (size_t)builder->film->width * (size_t)builder->film->height;
    builder->share->first = malloc((pixels + 1) * sizeof *builder->share->first);
    builder->share->contrasts = calloc(pixels, sizeof *builder->share->contrasts);
    bool has_memory = builder->share->first && builder->share->contrasts;
    for (size_t pixel = 0; has_memory && pixel < pixels; pixel++) {
        builder->share->first[pixel] = builder->used;
        has_memory = builder->counts[pixel] == 0 || pixel_take(builder, pixel);
    }
    if (has_memory) {
        builder->share->first[pixels] = builder->used;
    }
    return has_memory;
}

void share_free(Share *share)
{
    if (share) {
        free(share->first);
        free(share->contrasts);
        free(share->strata);
        free(share);
    }
}

Share *share_new(const Prepared *prepared, const Film *film, bool *has_memory)
{
    Builder builder = {.prepared = prepared, .film = film};
    bool is_known = !prepared->has_alpha &&
                    outline_view_init(&builder.view, &prepared->camera, film->whole_width, film->whole_height) &&
                    (uint64_t)film->width * (uint64_t)film->height < UINT32_MAX / STRATA_MOST;
    *has_memory = !is_known || builder_put_all(&builder);
    if (is_known && *has_memory && builder.counts) {
        builder.share = calloc(1, sizeof *builder.share);
        *has_memory = builder.share && builder_take_all(&builder);
    }
    free(builder.cover);
    free(builder.counts);
    free(builder.candidates);
    if (!*has_memory || builder.used == 0) {
        share_free(builder.share);
        return NULL;
    }
    return builder.share;
}

uint64_t share_bytes(int width, int height, uint64_t shapes)
{
    enum { STRATA_EACH = 2 }; // of a pixel, more than most have
    uint64_t pixels = (uint64_t)width * (uint64_t)height, most = 4 * shapes * ((uint64_t)width + (uint64_t)height);
    uint64_t pixel = sizeof(float) + sizeof(uint8_t) + OUTLINES_ROUGH * sizeof(Candidate) + sizeof(uint32_t) +
                     sizeof(ShareContrast);
    return pixels * pixel + (most < pixels ? most : pixels) * STRATA_EACH * sizeof(ShareStratum);
}

// ---- sums

void share_add(ShareSums *sums, uint32_t part, const double *x, const double *y, const Rgb *light, int count)
{
    uint32_t half = sums->starts ? part / 2 : part;
    for (int i = 0; i < count; i++) {
        int stratum = 0;
        while (stratum + 1 < sums->count && !outline_has(&sums->strata[stratum].outline, x[i] - 0.5, y[i] - 0.5)) {
            stratum++;
        }
        sums->taken[half][stratum]++;
        sums->sum[half][stratum] = rgb_add(sums->sum[half][stratum], light[i]);
    }
}

// Some samples of a pixel in one stratum, or in several that are taken as one.
typedef struct Group {
    double area, taken;
    Rgb sum;
} Group;

static void group_add(Group *group, const Group *more)
{
    group->area += more->area;
    group->taken += more->taken;
    group->sum = rgb_add(group->sum, more->sum);
}

// Puts strata in which too few samples are expected into one, and that with the least of the others, if it must be.
static int groups_join(Group *groups, int count, double samples)
{
    Group rest = {0.0, 0.0, rgb_grey(0.0)};
    for (int i = 0; i < count;) {
        if (groups[i].area * samples < EXPECTED_LEAST) {
            group_add(&rest, &groups[i]);
            groups[i] = groups[--count];
        } else {
            i++;
        }
    }
    while (rest.area > 0.0 && rest.area * samples < EXPECTED_LEAST && count > 0) {
        int least = 0;
        for (int i = 1; i < count; i++) {
            least = groups[i].area < groups[least].area ? i : least;
        }
        group_add(&rest, &groups[least]);
        groups[least] = groups[--count];
    }
    if (rest.area > 0.0) {
        groups[count++] = rest;
    }
    return count;
}

enum { PART_FIRST = 1, PART_SECOND = 2, PART_BEFORE = 4 };

// The mean of some parts of a pixel's samples, of which there is one at least. Strata are joined as for all `samples`
// of the pixel, so that halves differ as those of the picture's value do. Where one has none all strata are one.
static Rgb mean_of(const ShareSums *sums, int parts, double samples, Rgb *between)
{
    Group groups[STRATA_MOST], all = {0.0, 0.0, rgb_grey(0.0)};
    for (int i = 0; i < sums->count; i++) {
        const ShareStratum *stratum = &sums->strata[i];
        Group *group = &groups[i];
        *group = (Group){stratum->area, 0.0, rgb_grey(0.0)};
        if (parts & PART_BEFORE) {
            group->taken = stratum->taken;
            group->sum = rgb_scale(stratum->taken, rgb(stratum->mean[0], stratum->mean[1], stratum->mean[2]));
        }
        for (int half = 0; half < 2; half++) {
            if (parts & (half == 0 ? PART_FIRST : PART_SECOND)) {
                group->taken += sums->taken[half][i];
                group->sum = rgb_add(group->sum, sums->sum[half][i]);
            }
        }
        group_add(&all, group);
    }
    int count = groups_join(groups, sums->count, samples);
    for (int i = 0; i < count; i++) {
        if (groups[i].taken == 0.0) {
            all.area = 1.0;
            groups[0] = all;
            count = 1;
        }
    }
    Rgb mean = *between = rgb_grey(0.0);
    for (int i = 0; i < count; i++) {
        Rgb own = rgb_scale(1.0 / groups[i].taken, groups[i].sum);
        mean = rgb_add_scaled(mean, groups[i].area, own);
        *between = rgb_add_scaled(*between, groups[i].taken / all.taken, rgb_mul(own, own));
    }
    return mean;
}

Rgb share_mean(const ShareSums *sums)
{
    Rgb between;
    double samples = 0.0;
    for (int i = 0; i < sums->count; i++) {
        samples += sums->taken[0][i] + sums->taken[1][i];
    }
    return mean_of(sums, PART_FIRST | PART_SECOND, samples, &between);
}

void share_close(ShareSums *sums, bool has_before, bool is_judged, ShareMeans *means)
{
    uint32_t second = 0;
    double samples = 0.0;
    Rgb none;
    for (int i = 0; i < sums->count; i++) {
        second += sums->taken[1][i];
        samples += (has_before ? sums->strata[i].taken : 0) + sums->taken[0][i] + sums->taken[1][i];
    }
    *means = (ShareMeans){.before = rgb_grey(0.0)};
    means->all = mean_of(sums, PART_FIRST | PART_SECOND | (has_before ? PART_BEFORE : 0), samples, &means->between);
    if (is_judged) {
        means->before = has_before ? mean_of(sums, PART_BEFORE, samples, &none) : means->before;
        means->fresh = has_before ? mean_of(sums, PART_FIRST | PART_SECOND, samples, &means->between) : means->all;
        means->halves[0] = mean_of(sums, PART_FIRST, samples, &none);
        means->halves[1] = second > 0 ? mean_of(sums, PART_SECOND, samples, &none) : rgb_grey(0.0);
    }
    for (int i = 0; i < sums->count; i++) {
        ShareStratum *stratum = &sums->strata[i];
        double before = has_before ? stratum->taken : 0.0, now = before + sums->taken[0][i] + sums->taken[1][i];
        Rgb sum = rgb_add(sums->sum[0][i], sums->sum[1][i]);
        if (now > before) {
            sum = rgb_add_scaled(sum, before, rgb(stratum->mean[0], stratum->mean[1], stratum->mean[2]));
            stratum->mean[0] = (float)(sum.red / now);
            stratum->mean[1] = (float)(sum.green / now);
            stratum->mean[2] = (float)(sum.blue / now);
            stratum->taken = (uint32_t)now;
        }
    }
}

// ---- what is known of errors

double share_variance(const Share *share, size_t pixel, double count)
{
    double sum = 0.0;
    for (uint32_t i = share->first[pixel]; i < share->first[pixel + 1]; i++) {
        double area = share->strata[i].area;
        sum += area * count < EXPECTED_LEAST ? area : 0.0;
    }
    return (double)share->contrasts[pixel].around * sum / count;
}

// Of the strata that have samples: the mean square of how far they are from their common mean, in linear light, and
// what that would be were all of them off by 1 from each other.
static double pixel_contrast(const Round *round, size_t pixel, double *weight)
{
    const Share *share = round->share;
    double area = 0.0, areas = 0.0;
    Rgb sum = rgb_grey(0.0), squares = rgb_grey(0.0), place;
    for (uint32_t i = share->first[pixel]; i < share->first[pixel + 1]; i++) {
        const ShareStratum *stratum = &share->strata[i];
        if (stratum->taken > 0) {
            Rgb mean = rgb(stratum->mean[0], stratum->mean[1], stratum->mean[2]);
            sum = rgb_add_scaled(sum, stratum->area, mean);
            squares = rgb_add_scaled(squares, stratum->area, rgb_mul(mean, mean));
            area += stratum->area;
            areas += stratum->area * stratum->area;
        }
    }
    *weight = area > 0.0 ? area - areas / area : 0.0;
    Rgb spread = area > 0.0 ? rgb_add_scaled(squares, -1.0 / area, rgb_mul(sum, sum)) : sum;
    const Rgb *slope = slope_at(round, &round->film->rgb[3 * pixel], &place);
    spread = slope ? rgb_mul(spread, rgb_mul(*slope, *slope)) : spread;
    return fmax(spread.red + spread.green + spread.blue, 0.0) / 3.0;
}

// The contrast of a pixel is that of the strata in it and around it: edges of one picture differ in theirs by powers of
// ten, and one's own samples may have met one stratum only. Where none has met two, that of all of the picture's.
static double contrast_around(const Round *round, int x, int y, double of_all)
{
    const Film *film = round->film;
    int left = x > 0 ? x - 1 : x, right = x + 1 < film->width ? x + 1 : x;
    double square = 0.0, weight = 0.0;
    for (int row = y > 0 ? y - 1 : y; row <= y + 1 && row < film->height; row++) {
        const ShareContrast *contrasts = &round->share->contrasts[(size_t)row * (size_t)film->width];
        for (int column = left; column <= right; column++) {
            square += (double)contrasts[column].square;
            weight += (double)contrasts[column].weight;
        }
    }
    return weight > 0.0 ? square / weight : of_all;
}

void share_set_contrasts(const Round *round)
{
    const Film *film = round->film;
    ShareContrast *contrasts = round->share->contrasts;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    double sum = 0.0, weights = 0.0, weight;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        if (share_has(round->share, pixel)) {
            double square = pixel_contrast(round, pixel, &weight);
            contrasts[pixel] = (ShareContrast){.square = (float)square, .weight = (float)weight};
            sum += square;
            weights += weight;
        }
    }
    double of_all = weights > 0.0 ? sum / weights : 0.0;
    for (size_t pixel = 0; pixel < pixels; pixel++) {
        if (share_has(round->share, pixel)) {
            int x = (int)(pixel % (size_t)film->width), y = (int)(pixel / (size_t)film->width);
            contrasts[pixel].around = (float)contrast_around(round, x, y, of_all);
        }
    }
}
