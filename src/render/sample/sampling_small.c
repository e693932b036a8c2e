// Where shapes of few pixels lie in the picture: see sampling_small.h.
//
// Over so few pixels a camera's map is as good as affine, so a shape's ellipsoid becomes an ellipse by the map's slope
// at its middle. Shapes are looked at twice: to count those of each pixel, and to list them.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_small.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/cleared.h"
#include "base/pages.h"
#include "render/records/camera.h"
#include "scene/opaque.h"

// Up to how many pixels across a shape is small. Of one of 3 pixels, corners that all pass by it leave no more than the
// cap over a side of a pixel: 1 / (12 r) of a pixel for the radius r, 0.06; and the next pixel's corners see it.
static const double SMALL_WIDTH = 3.0;

// The same of highlights, which have no edge: a wider one is met by a corner at least. One that is longer than wide is
// small if its area is no more than that of a round one, up to a length along which it may bend.
static const double SPOT_WIDTH = 1.5, SPOT_LENGTH = 4.0;

// The same of lamps, shapes that glow brighter than white: a sliver of one, that something before it leaves, is worth as
// much as all else.
static const double LAMP_WIDTH = 6.0;

enum { STRIPS = 16, FILL_ROOT = 4, FILTER_SUM = 512 };

typedef struct View {
    const Small *small;
    Vec3 across, down, ahead; // what goes from a point, seen from the camera, to multiples of right, -up and direction
    double least_slope;       // no length makes less of the picture's width, at depth 1
    double ends[STRIPS + 1], chords[STRIPS]; // of strips of a unit disc, whose areas are right
} View;

// Without its strips. False where the camera's vectors span nothing.
static bool view_init(View *view, const Small *small)
{
    const PreparedCamera *camera = &small->prepared->camera;
    Vec3 down = vec3_neg(camera->up);
    Vec3 of_right = vec3_cross(down, camera->direction), of_down = vec3_cross(camera->direction, camera->right);
    Vec3 of_ahead = vec3_cross(camera->right, down);
    double size = vec3_dot(camera->right, of_right);
    *view = (View){small, vec3_scale(1.0 / size, of_right), vec3_scale(1.0 / size, of_down),
                   vec3_scale(1.0 / size, of_ahead), 0.0, {0.0}, {0.0}};
    view->least_slope = camera->type == CAMERA_ORTHOGRAPHIC
                            ? vec3_length(view->across)
                            : vec3_length(vec3_cross(view->across, view->ahead)) / vec3_length(view->ahead);
    return camera->type <= CAMERA_ORTHOGRAPHIC && vec3_is_finite(view->across) && vec3_is_finite(view->down) &&
           vec3_is_finite(view->ahead);
}

static void view_set_strips(View *view)
{
    const double step = 3.14159265358979323846 / STRIPS;
    for (int i = 0; i <= STRIPS; i++) {
        view->ends[i] = -cos(i * step);
    }
    for (int i = 0; i < STRIPS; i++) { // the area between the angles, over the height
        double area = 0.5 * (step - 0.5 * (sin(2.0 * (i + 1) * step) - sin(2.0 * i * step)));
        view->chords[i] = area / (view->ends[i + 1] - view->ends[i]);
    }
}

static double filter_norm(FilterKind filter)
{
    double sum = 0.0, radius = filter_radius(filter);
    for (int i = 0; i < FILTER_SUM; i++) {
        sum += filter_value(filter, radius * ((2 * i + 1.0) / FILTER_SUM - 1.0));
    }
    sum *= 2.0 * radius / FILTER_SUM;
    return 1.0 / (sum * sum);
}

static double ellipse_area(double xx, double xy, double yy)
{
    const double pi = 3.14159265358979323846;
    return pi * sqrt(fmax(xx * yy - xy * xy, 0.0));
}

bool small_is_lamp(const Prepared *p, const Extent *extent)
{
    if (shape_kind(extent->shape) == SMALL_IS_SPOT || (extent->material & MATERIAL_COMPOUND)) {
        return false;
    }
    const Material *material = &p->materials[extent->material];
    Rgb glow = rgb_mul(rgb((double)material->red, (double)material->green, (double)material->blue),
                       p->finishes[material->finish].glow);
    return rgb_max(glow) > 1.0;
}

// What the lens adds to the ellipse.
static void footprint_widen(const View *view, double depth, Footprint *at)
{
    const PreparedCamera *camera = &view->small->prepared->camera;
    const Film *film = view->small->film;
    const Vec3 axes[2] = {camera->lens_right, camera->lens_up};
    double apart = 1.0 / camera->focal_scale - 1.0 / depth;
    for (int i = 0; i < 2; i++) {
        double x = at->lens[i][0] = apart * film->whole_width * vec3_dot(view->across, axes[i]);
        double y = at->lens[i][1] = apart * film->whole_height * vec3_dot(view->down, axes[i]);
        at->wide_xx += x * x;
        at->wide_xy += x * y;
        at->wide_yy += y * y;
    }
}

// False when the shape is not small or not before the camera; at->extent is set.
static bool footprint_make(const View *view, Footprint *at)
{
    const PreparedCamera *camera = &view->small->prepared->camera;
    const Film *film = view->small->film;
    bool is_flat = camera->type == CAMERA_ORTHOGRAPHIC;
    Vec3 offset = vec3_sub(at->extent.centre, camera->location);
    double ahead = vec3_dot(view->ahead, offset), depth = is_flat ? 1.0 : ahead;
    const double pi = 3.14159265358979323846;
    bool is_spot = shape_kind(at->extent.shape) == SMALL_IS_SPOT;
    bool is_sphere = at->extent.is_ball && shape_kind(at->extent.shape) == SHAPE_SPHERE;
    double least = is_sphere ? 2.0 * at->extent.axes[0].x * view->least_slope * film->whole_width : 0.0;
    if (!(ahead > 0.0) || least > LAMP_WIDTH * depth) {
        return false; // that most are not small costs little
    }
    double wide = small_is_lamp(view->small->prepared, &at->extent) ? LAMP_WIDTH : SMALL_WIDTH;
    double size = is_spot ? SPOT_LENGTH : wide, most = size * depth;
    if (least > most) {
        return false;
    }
    double u = vec3_dot(view->across, offset) / depth, v = vec3_dot(view->down, offset) / depth;
    Vec3 to_x = is_flat ? view->across : vec3_add_scaled(view->across, -u, view->ahead);
    Vec3 to_y = is_flat ? view->down : vec3_add_scaled(view->down, -v, view->ahead);
    double width = film->whole_width / depth, height = film->whole_height / depth;
    at->x = (u + 0.5) * film->whole_width - film->left - 0.5;
    at->y = (v + 0.5) * film->whole_height - film->top - 0.5;
    at->xx = at->xy = at->yy = 0.0;
    for (int i = 0; i < 3; i++) {
        double x = width * vec3_dot(to_x, at->extent.axes[i]), y = height * vec3_dot(to_y, at->extent.axes[i]);
        at->xx += x * x;
        at->xy += x * y;
        at->yy += y * y;
    }
    at->wide_xx = at->xx;
    at->wide_xy = at->xy;
    at->wide_yy = at->yy;
    memset(at->lens, 0, sizeof at->lens);
    if (camera->lens_radius > 0.0) {
        footprint_widen(view, depth, at);
    }
    most = 0.25 * size * size;
    at->area = ellipse_area(at->xx, at->xy, at->yy);
    double round = 0.25 * pi * (is_spot ? SPOT_WIDTH * SPOT_WIDTH : size * size);
    return at->wide_xx <= most && at->wide_yy <= most && at->area > 0.0 && at->area <= round;
}

static void small_extent(const Small *small, ShapeId shape, Extent *extent)
{
    if (shape_kind(shape) == SMALL_IS_SPOT) {
        const SmallSpot *spot = &small->spots[shape_index(shape)];
        *extent =
            (Extent){.shape = shape, .is_ball = true, .centre = spot->centre, .axes = {spot->axes[0], spot->axes[1]}};
    } else {
        extent_of(small->prepared->geometry, shape, extent);
    }
}

static bool spot_is_crossed(const SmallSpot *spot, Ray ray)
{
    Vec3 normal = vec3_cross(spot->axes[0], spot->axes[1]), offset = vec3_sub(spot->centre, ray.origin);
    double way = vec3_dot(offset, normal) / vec3_dot(ray.direction, normal);
    Vec3 aside = vec3_sub(vec3_scale(way, ray.direction), offset);
    double x = vec3_dot(aside, spot->axes[0]) / vec3_length_squared(spot->axes[0]);
    double y = vec3_dot(aside, spot->axes[1]) / vec3_length_squared(spot->axes[1]);
    return way > 0.0 && x * x + y * y <= 1.0;
}

bool small_is_shown(const Small *small, ShapeId shape, Ray ray)
{
    const Prepared *p = small->prepared;
    bool is_spot = shape_kind(shape) == SMALL_IS_SPOT;
    MaterialIndex before;
    ExtentSight sight =
        extent_sight(p->geometry, is_spot ? small->spots[shape_index(shape)].owner : shape, ray, &before);
    return sight == EXTENT_SEEN || (sight == EXTENT_BEHIND && !scene_material_is_opaque(p->scene, before));
}

bool small_is_met(const Small *small, ShapeId shape, Ray ray)
{
    Extent extent;
    if (shape_kind(shape) == SMALL_IS_SPOT) {
        return spot_is_crossed(&small->spots[shape_index(shape)], ray);
    }
    if (!extent_is_crossed(small->prepared->geometry, shape, ray)) {
        return false;
    }
    small_extent(small, shape, &extent);
    return !small_is_lamp(small->prepared, &extent) || small_is_shown(small, shape, ray);
}

uint32_t small_place(const Small *small, ShapeId shape)
{
    const Geometry *geometry = small->prepared->geometry;
    return shape_kind(shape) == SMALL_IS_SPOT ? extent_count(geometry) + shape_index(shape)
                                              : extent_place(geometry, shape);
}

Footprint small_footprint(const Small *small, ShapeId shape)
{
    View view;
    Footprint at;
    (void)view_init(&view, small);
    small_extent(small, shape, &at.extent);
    (void)footprint_make(&view, &at);
    return at;
}

double small_weight(const Small *small, double x, double y)
{
    return filter_value(small->filter, x) * filter_value(small->filter, y);
}

// How much of the ellipse around it a shape is that is no ball: by rays.
static double fill_of(const View *view, const Footprint *at)
{
    const PreparedCamera *camera = &view->small->prepared->camera;
    const Film *film = view->small->film;
    int crossed = 0;
    double x_axis = sqrt(at->xx), slant = at->xy / x_axis, y_axis = sqrt(fmax(at->yy - slant * slant, 0.0));
    for (int i = 0; i < FILL_ROOT * FILL_ROOT; i++) {
        Ray ray;
        double radius = sqrt((i / FILL_ROOT + 0.5) / FILL_ROOT), angle = 1.5707963 * (i % FILL_ROOT + radius);
        double a = radius * cos(angle), b = radius * sin(angle);
        double u = film_u(film, 0, at->x + x_axis * a), v = film_v(film, 0, at->y + slant * a + y_axis * b);
        (void)camera_ray(camera, u, v, &ray);
        crossed += extent_is_crossed(view->small->prepared->geometry, at->extent.shape, ray);
    }
    return (crossed + 0.5) / (FILL_ROOT * FILL_ROOT + 0.5);
}

// What is in a row of pixels of strips of the ellipse, which end at even steps of the angle along it.
typedef struct RowStrips {
    int y, count;
    double left[STRIPS], right[STRIPS], height[STRIPS];
    double row[STRIPS]; // their middles, down the picture
} RowStrips;

static void row_strips(const View *view, const Footprint *at, int y, RowStrips *strips)
{
    double radius = filter_radius(view->small->filter), half = sqrt(at->wide_yy);
    double slope = at->wide_xy / at->wide_yy, across = sqrt(fmax(at->wide_xx - slope * at->wide_xy, 0.0));
    strips->y = y;
    strips->count = 0;
    for (int i = 0; i < STRIPS; i++) {
        double top = at->y + half * view->ends[i], bottom = at->y + half * view->ends[i + 1];
        top = top > y - radius ? top : y - radius;
        bottom = bottom < y + radius ? bottom : y + radius;
        if (bottom > top) {
            double row = 0.5 * (top + bottom), middle = at->x + slope * (row - at->y), chord = across * view->chords[i];
            int next = strips->count++;
            strips->left[next] = middle - chord;
            strips->right[next] = middle + chord;
            strips->height[next] = bottom - top;
            strips->row[next] = row;
        }
    }
}

// The share of a pixel of the row that the ellipse has: what of its strips is between the pixel's sides, as the filter
// weights it.
static double share_of(const View *view, const Footprint *at, const RowStrips *strips, int x)
{
    double radius = filter_radius(view->small->filter), sum = 0.0;
    bool is_box = view->small->filter == FILTER_BOX;
    for (int i = 0; i < strips->count; i++) {
        double left = strips->left[i] > x - radius ? strips->left[i] : x - radius;
        double right = strips->right[i] < x + radius ? strips->right[i] : x + radius;
        if (right > left) {
            sum += strips->height[i] * (right - left) *
                   (is_box ? 1.0 : small_weight(view->small, 0.5 * (left + right) - x, strips->row[i] - strips->y));
        }
    }
    double wide = ellipse_area(at->wide_xx, at->wide_xy, at->wide_yy);
    return fabs(sum) * view->small->norm * fmin(at->area / wide, 1.0);
}

// ---- the list

static void entry_add(Small *small, size_t pixel, ShapeId shape, double share)
{
    SmallEntry *entries = &small->entries[small->first[pixel]], entry = {shape, (float)share, -1.0f};
    int most = (int)(small->first[pixel + 1] - small->first[pixel]), least = 0;
    if (small->open[pixel] < most) {
        entries[small->open[pixel]++] = entry;
        return;
    }
    for (int i = 1; i < most; i++) {
        least = entries[i].share < entries[least].share ? i : least;
    }
    if (entries[least].share < entry.share) {
        entries[least] = entry;
    }
}

// Counts the shape for the pixels that it is in, or, when there are entries, lists it there.
static void footprint_put(const View *view, const Footprint *at, Small *small)
{
    const Film *film = small->film;
    double radius = filter_radius(small->filter), fill = -1.0;
    double across = sqrt(at->wide_xx) + radius, down = sqrt(at->wide_yy) + radius;
    if (!(at->x > -across && at->x < film->width - 1.0 + across && at->y > -down &&
          at->y < film->height - 1.0 + down)) {
        return;
    }
    int left = (int)fmax(ceil(at->x - across), 0.0), right = (int)fmin(floor(at->x + across), film->width - 1.0);
    int top = (int)fmax(ceil(at->y - down), 0.0), bottom = (int)fmin(floor(at->y + down), film->height - 1.0);
    for (int y = top; y <= bottom; y++) {
        RowStrips strips;
        row_strips(view, at, y, &strips);
        for (int x = left; x <= right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            double share = share_of(view, at, &strips, x);
            if (!((float)share > 0.0f)) {
                continue;
            }
            if (small->entries) {
                fill = fill >= 0.0 ? fill : at->extent.is_ball ? 1.0 : fill_of(view, at);
                entry_add(small, pixel, at->extent.shape, share * fill);
            } else if (small->open[pixel] < SMALL_MOST) {
                small->open[pixel]++;
            }
        }
    }
}

// ---- highlights

// Whether a highlight on a sphere may be narrow; it is no more than by this much when the eye is far off.
static bool spot_is_candidate(const void *client, const Extent *extent, double turned)
{
    Footprint at = {.extent = *extent};
    at.extent.shape = shape_id(SMALL_IS_SPOT, 0);
    for (int i = 0; i < 3; i++) {
        at.extent.axes[i] = vec3_scale(0.25 * turned, extent->axes[i]);
    }
    return footprint_make(client, &at);
}

static bool spot_is_narrow(const void *client, const SmallSpot *spot)
{
    Footprint at = {.extent = {.shape = shape_id(SMALL_IS_SPOT, 0),
                               .centre = spot->centre,
                               .axes = {spot->axes[0], spot->axes[1]}}};
    return footprint_make(client, &at);
}

// ---- lists

static bool lists_begin(Small *small)
{
    size_t pixels = (size_t)small->film->width * (size_t)small->film->height;
    small->words = (extent_count(small->prepared->geometry) + (size_t)small->spot_count + 63) / 64;
    small->norm = filter_norm(small->filter);
    small->open = cleared_new(pixels, sizeof *small->open);
    small->first = pages_grow(NULL, 0, (pixels + 1) * sizeof *small->first);
    small->pixels = pages_grow(NULL, 0, (pixels + 1) * sizeof *small->pixels);
    small->law = pages_grow(NULL, 0, pixels * sizeof *small->law);
    small->met = calloc(3 * small->words, sizeof *small->met);
    small->seen = small->met ? small->met + small->words : NULL;
    small->counted = small->met ? small->seen + small->words : NULL;
    return small->first && small->open && small->pixels && small->law && small->met;
}

// False when out of memory; leaves first as NULL where nothing is small.
static bool lists_pass(const View *view, Small *small)
{
    const Geometry *geometry = small->prepared->geometry;
    uint32_t shapes = extent_count(geometry);
    for (uint32_t i = 0; i < shapes + small->spot_count; i++) {
        Footprint at;
        bool has_extent = true;
        if (i < shapes) {
            has_extent = extent_get(geometry, i, &at.extent);
        } else {
            small_extent(small, shape_id(SMALL_IS_SPOT, i - shapes), &at.extent);
        }
        if (has_extent && footprint_make(view, &at)) {
            if (!small->first && !lists_begin(small)) {
                return false;
            }
            footprint_put(view, &at, small);
        }
    }
    return true;
}

// Where each pixel's entries are. Most have none, and go by eights.
static void firsts_set(Small *small, size_t pixels)
{
    uint32_t sum = 0, count = 0, *first = small->first; // a film's pixels have SMALL_MOST entries each at most
    const uint8_t *open = small->open;
    for (size_t i = 0; i < pixels;) {
        uint64_t eight = 1;
        if (i + sizeof eight <= pixels) {
            memcpy(&eight, &open[i], sizeof eight);
        }
        if (eight == 0) {
            for (size_t j = 0; j < sizeof eight; j++) {
                first[i + j] = sum;
            }
            i += sizeof eight;
        } else {
            first[i] = sum;
            sum += open[i];
            small->pixels[count] = (uint32_t)i;
            count += open[i++] > 0;
        }
    }
    first[pixels] = sum;
    small->pixel_count = count;
}

// From counts to empty lists.
static bool lists_open(Small *small)
{
    size_t pixels = (size_t)small->film->width * (size_t)small->film->height;
    firsts_set(small, pixels);
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        small->open[small->pixels[k]] = 0;
        small->law[small->pixels[k]][0] = small->law[small->pixels[k]][1] = 0.0f;
    }
    small->entries = malloc((small->first[pixels] + (size_t)1) * sizeof *small->entries);
    return small->entries != NULL;
}

void small_free(Small *small)
{
    if (small) {
        free(small->spots);
        free(small->first);
        free(small->pixels);
        free(small->entries);
        free(small->open);
        free(small->law);
        free(small->met);
        free(small);
    }
}

uint64_t small_bytes(int width, int height, uint64_t shapes)
{
    enum { PIXELS_EACH = 8 }; // of a small shape, more than most have
    uint64_t pixels = (uint64_t)width * (uint64_t)height, most = shapes * PIXELS_EACH;
    uint64_t pixel = 2 * sizeof(uint32_t) + sizeof(uint8_t) + 2 * sizeof(float);
    return pixels * pixel + (most < pixels * SMALL_MOST ? most : pixels * SMALL_MOST) * sizeof(SmallEntry);
}

Small *small_new(const Prepared *prepared, const RenderOptions *options, const Film *film, bool *has_memory)
{
    View view;
    Small *small = calloc(1, sizeof *small);
    *has_memory = small != NULL;
    if (!small) {
        return NULL;
    }
    small->prepared = prepared;
    small->film = film;
    small->filter = options->sampling->filter;
    bool is_known = view_init(&view, small) && (uint64_t)film->width * (uint64_t)film->height < UINT32_MAX / SMALL_MOST;
    view_set_strips(&view);
    *has_memory = !is_known || (spots_find(small, spot_is_candidate, spot_is_narrow, &view) &&
                                glints_find(small, options, spot_is_narrow, &view) && lists_pass(&view, small));
    if (*has_memory && small->first) {
        *has_memory = lists_open(small) && lists_pass(&view, small);
        if (*has_memory && small->first[(size_t)film->width * (size_t)film->height] > 0) {
            return small;
        }
    }
    small_free(small);
    return NULL;
}

void small_meet(Small *small, size_t pixel, Ray ray)
{
    SmallEntry *entries = &small->entries[small->first[pixel]];
    for (int i = 0; i < small->open[pixel];) {
        if (small_is_met(small, entries[i].shape, ray)) {
            int last = --small->open[pixel];
            SmallEntry met = entries[i];
            entries[i] = entries[last];
            entries[last] = met;
        } else {
            i++;
        }
    }
}

int small_count_open(const Small *small, size_t pixel, Ray ray)
{
    const SmallEntry *entries = &small->entries[small->first[pixel]];
    int count = 0;
    for (int i = 0; i < small->open[pixel]; i++) {
        count += small_is_met(small, entries[i].shape, ray);
    }
    return count;
}

// Of those that are not known, the mean of those that are.
static double mean_contrast(const Small *small, uint32_t count)
{
    double sum = 0.0, weight = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const SmallEntry *entry = &small->entries[i];
        if (entry->contrast >= 0.0f) {
            sum += (double)entry->share * (double)entry->contrast;
            weight += (double)entry->share;
        }
    }
    return weight > 0.0 ? sum / weight : 0.0;
}

void small_set_law(Small *small)
{
    size_t all = (size_t)small->film->width * (size_t)small->film->height;
    double mean = small->contrast = mean_contrast(small, small->first[all]);
    for (uint32_t k = 0; k < small->pixel_count; k++) {
        uint32_t pixel = small->pixels[k];
        double few = 0.0, many = 0.0;
        for (uint32_t i = small->first[pixel]; i < small->first[pixel + 1]; i++) {
            const SmallEntry *entry = &small->entries[i];
            double contrast = entry->contrast >= 0.0f ? (double)entry->contrast : mean;
            double share = fmin((double)entry->share, 1.0);
            few += contrast * share * (1.0 - share);
            many += contrast * sqrt(fmin(share, 1.0 - share));
        }
        small->law[pixel][0] = (float)few;
        small->law[pixel][1] = (float)many;
    }
}
