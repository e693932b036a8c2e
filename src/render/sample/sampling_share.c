// Strata of pixels that outlines of spheres cross: see sampling_share.h.
//
// First each outline is put into the pixels that it crosses, and hides what is farther in those that it covers; then
// each pixel takes what is nearest of what it has seen. Which stratum is too small to be weighted by its share goes by
// that share and the number of samples, never by where these fell, which would bend the mean.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_share.h"

#include <stdlib.h>

#include "base/cleared.h"
#include "base/pages.h"
#include "render/sample/sampling_batch.h"
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

// The nearest outlines that cross a pixel.
typedef struct Crossed {
    int count;
    Candidate candidates[OUTLINES_ROUGH];
} Crossed;

typedef struct Builder {
    const Prepared *prepared;
    const Film *film;
    OutlineView view;
    float *cover;     // of each pixel: the least distance of what covers it all
    uint32_t *first;  // of each pixel: 0, or one more than where in `crossed` it is; then as Share has it
    Crossed *crossed; // of pixels that some outline crosses
    uint32_t crossed_count;
    size_t crossed_capacity;
    Share *share;
    uint32_t used; // strata
} Builder;

// ---- which outlines cross a pixel

static bool is_nearer(Candidate a, Candidate b)
{
    return a.distance < b.distance || (a.distance == b.distance && a.place < b.place);
}

// The pixel's, which is made if it has none; NULL when out of memory.
static Crossed *crossed_of(Builder *builder, size_t pixel)
{
    if (builder->first[pixel] == 0) {
        if (builder->crossed_count == builder->crossed_capacity) {
            size_t capacity = 2 * builder->crossed_capacity + 1024;
            Crossed *crossed =
                pages_grow(builder->crossed, builder->crossed_capacity * sizeof *crossed, capacity * sizeof *crossed);
            if (!crossed) {
                return NULL;
            }
            builder->crossed = crossed;
            builder->crossed_capacity = capacity;
        }
        builder->crossed[builder->crossed_count++].count = 0;
        builder->first[pixel] = builder->crossed_count;
    }
    return &builder->crossed[builder->first[pixel] - 1];
}

// Keeps the nearest ones; false when out of memory.
static bool candidate_add(Builder *builder, size_t pixel, Candidate candidate)
{
    Crossed *crossed = crossed_of(builder, pixel);
    if (!crossed) {
        return false;
    }
    Candidate *list = crossed->candidates;
    int i = crossed->count;
    if (i == OUTLINES_ROUGH) {
        if (!is_nearer(candidate, list[--i])) {
            return true;
        }
    } else {
        crossed->count++;
    }
    for (; i > 0 && is_nearer(candidate, list[i - 1]); i--) {
        list[i] = list[i - 1];
    }
    list[i] = candidate;
    return true;
}

// False when out of memory.
static bool outline_put(Builder *builder, const Outline *outline, Candidate candidate)
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
            } else if (!candidate_add(builder, pixel, candidate)) {
                return false;
            }
        }
    }
    return true;
}

static bool builder_begin(Builder *builder)
{
    size_t pixels = (size_t)builder->film->width * (size_t)builder->film->height;
    builder->cover = pages_grow(NULL, 0, pixels * sizeof *builder->cover);
    builder->first = cleared_new(pixels + 1, sizeof *builder->first);
    if (!builder->cover || !builder->first) {
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

// False when out of memory; leaves `first` as NULL where there are no outlines.
static bool builder_put_all(Builder *builder)
{
    uint32_t places = extent_count(builder->prepared->geometry);
    for (uint32_t place = 0; place < places; place++) {
        Outline outline;
        double distance;
        if (sphere_outline(builder, place, &outline, &distance)) {
            if ((!builder->first && !builder_begin(builder)) ||
                !outline_put(builder, &outline, (Candidate){(float)distance, place})) {
                return false;
            }
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
        ShareStratum *strata = pages_grow(share->strata, builder->used * sizeof *strata, capacity * sizeof *strata);
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

static bool pixel_take(Builder *builder, size_t pixel, const Crossed *crossed)
{
    const Film *film = builder->film;
    double x = film->left + (double)(pixel % (size_t)film->width),
           y = film->top + (double)(pixel / (size_t)film->width);
    double areas[OUTLINES_MOST + 1], distance;
    Outline outlines[OUTLINES_ROUGH];
    int count = 0;
    for (int i = 0; i < crossed->count; i++) {
        Candidate candidate = crossed->candidates[i];
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
    Share *share = builder->share;
    uint32_t *first = builder->first;
    share->pixels = malloc((builder->crossed_count + 1) * sizeof *share->pixels);
    bool has_memory = share->pixels;
    for (size_t pixel = 0; has_memory && pixel < pixels; pixel++) {
        const Crossed *crossed = first[pixel] > 0 ? &builder->crossed[first[pixel] - 1] : NULL;
        first[pixel] = builder->used;
        has_memory = !crossed || pixel_take(builder, pixel, crossed);
        if (builder->used > first[pixel]) {
            share->pixels[share->pixel_count++] = (uint32_t)pixel;
        }
    }
    first[pixels] = builder->used;
    share->contrasts = has_memory ? cleared_new(builder->used + 1, sizeof *share->contrasts) : NULL;
    return share->contrasts;
}

void share_free(Share *share)
{
    if (share) {
        free(share->first);
        free(share->pixels);
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
    if (is_known && *has_memory && builder.first) {
        builder.share = calloc(1, sizeof *builder.share);
        *has_memory = builder.share && builder_take_all(&builder);
    }
    free(builder.cover);
    free(builder.crossed);
    if (!*has_memory || builder.used == 0) {
        free(builder.first);
        share_free(builder.share);
        return NULL;
    }
    builder.share->first = builder.first;
    return builder.share;
}

uint64_t share_bytes(int width, int height, uint64_t shapes)
{
    enum { STRATA_EACH = 2 }; // of a pixel, more than most have
    uint64_t pixels = (uint64_t)width * (uint64_t)height, most = 4 * shapes * ((uint64_t)width + (uint64_t)height);
    uint64_t crossed =
        sizeof(Crossed) + sizeof(uint32_t) + STRATA_EACH * (sizeof(ShareStratum) + sizeof(ShareContrast));
    return pixels * (sizeof(float) + sizeof(uint32_t)) + (most < pixels ? most : pixels) * crossed;
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

enum { PART_FIRST, PART_SECOND, PART_BEFORE, PARTS };

// Strata of a pixel, some of which are taken as one.
typedef struct Group {
    double area;
    uint32_t strata; // a bit for each
} Group;

static void group_add(Group *group, const Group *more)
{
    group->area += more->area;
    group->strata |= more->strata;
}

// Puts strata in which too few samples are expected into one, and that with the least of the others, if it must be.
static int groups_join(Group *groups, int count, double samples)
{
    Group rest = {0.0, 0};
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

// Samples of a group: how many, and their sum.
typedef struct GroupPart {
    double taken;
    Rgb sum;
} GroupPart;

static inline void group_part_add(GroupPart *part, double taken, Rgb sum)
{
    part->taken += taken;
    part->sum = rgb_add(part->sum, sum);
}

// The samples of a pixel by group, of each part of them; PART_BEFORE where it has such.
typedef struct GroupSums {
    int count;
    Group groups[STRATA_MOST];
    GroupPart parts[PARTS][STRATA_MOST];
} GroupSums;

static inline void stratum_add(const ShareSums *sums, int stratum, int group, bool has_before, GroupSums *by_group)
{
    for (int half = 0; half < 2; half++) {
        group_part_add(&by_group->parts[half][group], sums->taken[half][stratum], sums->sum[half][stratum]);
    }
    if (has_before) {
        const ShareStratum *own = &sums->strata[stratum];
        group_part_add(&by_group->parts[PART_BEFORE][group], own->taken,
                       rgb_scale(own->taken, rgb(own->mean[0], own->mean[1], own->mean[2])));
    }
}

// Strata are joined as for all samples of the pixel, so that halves differ as those of the picture's value do.
static void group_sums(const ShareSums *sums, bool has_before, GroupSums *by_group)
{
    double samples = 0.0;
    for (int i = 0; i < sums->count; i++) {
        samples += (has_before ? sums->strata[i].taken : 0) + sums->taken[0][i] + sums->taken[1][i];
        by_group->groups[i] = (Group){sums->strata[i].area, 1u << i};
    }
    by_group->count = groups_join(by_group->groups, sums->count, samples);
    for (int group = 0; group < by_group->count; group++) {
        for (int part = 0; part < PARTS; part++) {
            by_group->parts[part][group] = (GroupPart){0.0, rgb_grey(0.0)};
        }
        for (uint32_t left = by_group->groups[group].strata; left; left &= left - 1) {
            stratum_add(sums, __builtin_ctz(left), group, has_before, by_group);
        }
    }
}

// Of some parts, from `first` to `last`.
static inline GroupPart part_of(const GroupSums *by_group, int first, int last, int group)
{
    GroupPart part = by_group->parts[first][group];
    for (int i = first + 1; i <= last; i++) {
        group_part_add(&part, by_group->parts[i][group].taken, by_group->parts[i][group].sum);
    }
    return part;
}

// The mean where a group has no sample: all are one.
static Rgb plain_mean(const GroupSums *by_group, int first, int last, Rgb *between)
{
    GroupPart all = {0.0, rgb_grey(0.0)};
    for (int i = 0; i < by_group->count; i++) {
        GroupPart part = part_of(by_group, first, last, i);
        group_part_add(&all, part.taken, part.sum);
    }
    Rgb mean = rgb_scale(1.0 / all.taken, all.sum);
    if (between) {
        *between = rgb_mul(mean, mean);
    }
    return mean;
}

// The mean of some parts of a pixel's samples, of which there is one at least, from `first` to `last`. Where a group
// has none all are one. `between`: NULL, or where the mean square of the groups' means goes. Inline: it is what strata
// cost, and each caller's parts make a copy of their own.
RT_ALWAYS_INLINE Rgb mean_of(const GroupSums *by_group, int first, int last, Rgb *between)
{
    double all = 0.0, taken[STRATA_MOST];
    Rgb own[STRATA_MOST], mean = rgb_grey(0.0);
    for (int i = 0; i < by_group->count; i++) {
        GroupPart part = part_of(by_group, first, last, i);
        if (!(part.taken > 0.0)) {
            return plain_mean(by_group, first, last, between);
        }
        own[i] = rgb_scale(1.0 / part.taken, part.sum);
        taken[i] = part.taken;
        all += part.taken;
        mean = rgb_add_scaled(mean, by_group->groups[i].area, own[i]);
    }
    if (between) {
        *between = rgb_grey(0.0);
        for (int i = 0; i < by_group->count; i++) {
            *between = rgb_add_scaled(*between, taken[i] / all, rgb_mul(own[i], own[i]));
        }
    }
    return mean;
}

Rgb share_mean(const ShareSums *sums)
{
    GroupSums by_group;
    group_sums(sums, false, &by_group);
    return mean_of(&by_group, PART_FIRST, PART_SECOND, NULL);
}

void share_close(ShareSums *sums, bool has_before, bool is_judged, bool has_between, ShareMeans *means)
{
    GroupSums by_group;
    Rgb *between = has_between ? &means->between : NULL;
    uint32_t second = 0;
    for (int i = 0; i < sums->count; i++) {
        second += sums->taken[1][i];
    }
    group_sums(sums, has_before, &by_group);
    *means = (ShareMeans){.before = rgb_grey(0.0)};
    means->all = mean_of(&by_group, PART_FIRST, has_before ? PART_BEFORE : PART_SECOND, has_before ? NULL : between);
    if (is_judged) {
        means->before = has_before ? mean_of(&by_group, PART_BEFORE, PART_BEFORE, NULL) : means->before;
        means->fresh = has_before ? mean_of(&by_group, PART_FIRST, PART_SECOND, between) : means->all;
        means->halves[0] = mean_of(&by_group, PART_FIRST, PART_FIRST, NULL);
        means->halves[1] = second > 0 ? mean_of(&by_group, PART_SECOND, PART_SECOND, NULL) : rgb_grey(0.0);
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

// What slivers have of a pixel: strata that are too small for so many samples.
static double sliver_area(const Share *share, size_t pixel, double count)
{
    double sum = 0.0;
    for (uint32_t i = share->first[pixel]; i < share->first[pixel + 1]; i++) {
        double area = share->strata[i].area;
        sum += area * count < EXPECTED_LEAST ? area : 0.0;
    }
    return sum;
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
        const uint32_t *first = &round->share->first[(size_t)row * (size_t)film->width];
        for (int column = left; column <= right; column++) {
            if (first[column + 1] > first[column]) {
                square += (double)round->share->contrasts[first[column]].square;
                weight += (double)round->share->contrasts[first[column]].weight;
            }
        }
    }
    return weight > 0.0 ? square / weight : of_all;
}

// Most pixels of most rounds are as they were.
static inline void contrast_renew(const Round *round, size_t pixel, ShareContrast *contrast)
{
    uint32_t samples = round->film->records[pixel].count;
    if (contrast->samples != samples) {
        double weight, square = pixel_contrast(round, pixel, &weight);
        *contrast = (ShareContrast){.square = (float)square,
                                    .weight = (float)weight,
                                    .sliver = (float)sliver_area(round->share, pixel, samples),
                                    .samples = samples};
    }
}

// From now on only those of the pixels are known that tell of the error.
static void pixels_keep_judged(const Round *round, Share *share)
{
    size_t width = (size_t)round->film->width;
    share->pixel_count = 0;
    for (Tile block = {0}; round_next_judged(round, &block);) {
        bool has_any = tile_has_entries(share->first, round->film->width, block);
        for (int y = block.top; has_any && y < block.bottom; y++) {
            size_t row = (size_t)y * width;
            for (size_t pixel = row + (size_t)block.left; pixel < row + (size_t)block.right; pixel++) {
                share->pixels[share->pixel_count] = (uint32_t)pixel;
                share->pixel_count += share_has(share, pixel);
            }
        }
    }
}

void share_set_contrasts(const Round *round)
{
    Share *share = round->share;
    uint32_t width = (uint32_t)round->film->width;
    double square = 0.0, weight = 0.0;
    if (round->counts_some) {
        pixels_keep_judged(round, share);
    }
    for (uint32_t i = 0; i < share->pixel_count; i++) {
        uint32_t pixel = share->pixels[i];
        ShareContrast *contrast = &share->contrasts[share->first[pixel]];
        contrast_renew(round, pixel, contrast);
        square += (double)contrast->square;
        weight += (double)contrast->weight;
    }
    double of_all = weight > 0.0 ? square / weight : 0.0;
    for (uint32_t i = 0; i < share->pixel_count; i++) {
        uint32_t pixel = share->pixels[i];
        ShareContrast *contrast = &share->contrasts[share->first[pixel]];
        if (contrast->sliver > 0.0f) {
            contrast->around = (float)contrast_around(round, (int)(pixel % width), (int)(pixel / width), of_all);
        }
    }
}
