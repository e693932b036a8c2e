// Pictures at a point: from space to the plane of the picture, from there to pixels, and between them.
//
// Owns the palettes that differ from the pictures' own. Colours of pictures that are multiplied with alpha stay so
// until they are mixed.
//
// SPDX-License-Identifier: MIT
#include "render/surface/image.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

// ---- preparing

static void shade_palette(PreparedImage *image, const PictureShade *shade)
{
    uint32_t first = shade->place == SHADE_ALL ? 0 : shade->place;
    uint32_t end = shade->place == SHADE_ALL ? PICTURE_PALETTE : shade->place + 1;
    for (uint32_t i = first; i < end; i++) {
        *(shade->is_filter ? &image->palette[i].filter : &image->palette[i].transmit) = (float)shade->amount;
    }
}

static bool prepare(PreparedImage *image, const Scene *scene, const ImageMap *map)
{
    *image = (PreparedImage){.picture = &scene->pictures.items[map->picture], .map = *map};
    if (image->picture->palette) {
        image->palette = malloc(PICTURE_PALETTE * sizeof *image->palette);
        if (!image->palette) {
            return false;
        }
        memcpy(image->palette, image->picture->palette, PICTURE_PALETTE * sizeof *image->palette);
    }
    for (uint32_t i = map->shades; i != RECORD_NONE; i = scene->picture_shades.items[i].next) {
        const PictureShade *shade = &scene->picture_shades.items[i];
        if (image->palette) {
            shade_palette(image, shade);
        } else {
            *(shade->is_filter ? &image->filter : &image->transmit) = shade->amount;
        }
    }
    return true;
}

PreparedImage *images_new(const Scene *scene)
{
    size_t count = scene->image_maps.count;
    PreparedImage *images = calloc(count + 1, sizeof *images);
    for (size_t i = 0; images && i < count; i++) {
        if (!prepare(&images[i], scene, &scene->image_maps.items[i])) {
            images_free(images, count);
            return NULL;
        }
    }
    return images;
}

void images_free(PreparedImage *images, size_t count)
{
    for (size_t i = 0; images && i < count; i++) {
        free(images[i].palette);
    }
    free(images);
}

bool image_is_transparent(const PreparedImage *image)
{
    if (image->map.is_once || image->filter != 0.0 || image->transmit != 0.0 || image->picture->channels % 2 == 0) {
        return true;
    }
    for (int i = 0; image->palette && i < PICTURE_PALETTE; i++) {
        if (image->palette[i].filter != 0.0F || image->palette[i].transmit != 0.0F) {
            return true;
        }
    }
    return false;
}

// ---- from space to the picture

// Where in the picture a point is: from the left and from below, the whole picture being 1.
typedef struct Spot {
    double across, up;
} Spot;

static double whole_away(double x)
{
    double rest = fmod(x, 1.0);
    return rest < 0.0 ? rest + 1.0 : rest;
}

static bool is_beyond(double x)
{
    return !(x >= 0.0 && x <= 1.0);
}

// Around the y axis, from +x by +z. By the cosine, so that points just before a whole turn, which rounding brings there
// and back, are at its end.
static double around(double x, double z)
{
    double distance = sqrt(x * x + z * z);
    double turn = distance > 0.0 ? acos(fmax(fmin(x / distance, 1.0), -1.0)) : 0.0;
    return (z < 0.0 ? 2.0 * pi - turn : turn) / (2.0 * pi);
}

// False: there is no picture at the point.
static bool project(const ImageMap *map, Vec3 p, Spot *spot)
{
    double length, distance;
    switch ((Projection)map->projection) {
    case PROJECTION_PLANAR:
        *spot = (Spot){whole_away(p.x), whole_away(p.y)};
        return !map->is_once || !(is_beyond(p.x) || is_beyond(p.y));
    case PROJECTION_SPHERICAL:
        length = vec3_length(p);
        *spot = (Spot){around(p.x, p.z), 0.5 + asin(fmax(fmin(p.y / length, 1.0), -1.0)) / pi};
        return length > 0.0;
    case PROJECTION_CYLINDRICAL:
        *spot = (Spot){around(p.x, p.z), whole_away(p.y)};
        return (p.x != 0.0 || p.z != 0.0) && !(map->is_once && is_beyond(p.y));
    case PROJECTION_TORUS:
        distance = sqrt(p.x * p.x + p.z * p.z);
        *spot = (Spot){around(p.x, p.z), 0.5 + atan2(p.y, distance - 1.0) / (2.0 * pi)};
        return distance > 0.0;
    }
    return false;
}

// ---- pixels

enum { PARTS = 5 }; // red, green, blue, filter, transmit

static int wrapped(int place, int count)
{
    int rest = place % count;
    return rest < 0 ? rest + count : rest;
}

static int pressed(int place, int count)
{
    return place < 0 ? 0 : place >= count ? count - 1 : place;
}

// The code or value of a sample as a colour, and as alpha.
static double sample_colour(const Picture *picture, size_t i)
{
    switch (picture->depth) {
    case PICTURE_DEPTH_8:
        return picture->decoded[((const uint8_t *)picture->samples)[i]];
    case PICTURE_DEPTH_16:
        return picture->decoded[((const uint16_t *)picture->samples)[i]];
    case PICTURE_DEPTH_FLOAT:
        break;
    }
    return ((const float *)picture->samples)[i];
}

static double sample_alpha(const Picture *picture, size_t i)
{
    switch (picture->depth) {
    case PICTURE_DEPTH_8:
        return ((const uint8_t *)picture->samples)[i] / 255.0;
    case PICTURE_DEPTH_16:
        return ((const uint16_t *)picture->samples)[i] / 65535.0;
    case PICTURE_DEPTH_FLOAT:
        break;
    }
    return ((const float *)picture->samples)[i];
}

static void pixel_colours(const PreparedImage *image, size_t pixel, double parts[static PARTS])
{
    const Picture *picture = image->picture;
    if (image->palette) {
        const PictureColour *colour = &image->palette[((const uint8_t *)picture->samples)[pixel]];
        parts[0] = colour->red;
        parts[1] = colour->green;
        parts[2] = colour->blue;
        parts[3] = colour->filter;
        parts[4] = colour->transmit;
        return;
    }
    size_t channels = (size_t)picture->channels, first = pixel * channels;
    bool is_grey = channels < 3;
    for (size_t c = 0; c < 3; c++) {
        parts[c] = sample_colour(picture, first + (is_grey ? 0 : c));
    }
    parts[3] = 0.0;
    parts[4] = channels % 2 == 0 ? 1.0 - sample_alpha(picture, first + channels - 1) : 0.0;
}

static double grey_of(const Picture *picture, const double parts[static PARTS])
{
    bool is_grey = picture->channels < 3 && !picture->palette;
    return is_grey ? parts[0] : rgb_luminance((Rgb){parts[0], parts[1], parts[2]});
}

// The one number that a pixel tells.
static double pixel_told(const PreparedImage *image, size_t pixel, const double parts[static PARTS])
{
    const Picture *picture = image->picture;
    bool has_alpha = picture->palette || picture->channels % 2 == 0, has_red = picture->channels >= 3;
    switch ((PictureUse)image->map.use) {
    case PICTURE_ALPHA:
        return has_alpha ? parts[4] : has_red ? parts[0] : grey_of(picture, parts);
    case PICTURE_INDEX:
    case PICTURE_RED:
        if (picture->palette) {
            double place = ((const uint8_t *)picture->samples)[pixel];
            return image->map.use == PICTURE_INDEX ? place : place / 255.0;
        }
        return has_red && image->map.use == PICTURE_RED ? parts[0] : grey_of(picture, parts);
    default:
        return grey_of(picture, parts);
    }
}

// Column and row, from above, may be beyond the edges: a picture that is seen once continues as it ends, another begins
// anew.
static void pixel_get(const PreparedImage *image, int column, int row, double parts[static PARTS])
{
    const Picture *picture = image->picture;
    bool is_once = image->map.is_once;
    column = is_once ? pressed(column, picture->width) : wrapped(column, picture->width);
    row = is_once ? pressed(row, picture->height) : wrapped(row, picture->height);
    size_t pixel = (size_t)row * (size_t)picture->width + (size_t)column;
    pixel_colours(image, pixel, parts);
    if (RT_UNLIKELY(image->map.use != PICTURE_COLOURS)) {
        parts[0] = pixel_told(image, pixel, parts);
    }
}

// Of columns and of rows of pixels.
typedef struct Weights {
    double across[4], up[4];
    int count;
} Weights;

// The sum of pixels from (column, row) to the right and upward, as many as there are weights.
static void mix(const PreparedImage *image, int column, int row, const Weights *weights, double sum[static PARTS])
{
    for (int j = 0; j < weights->count; j++) {
        for (int i = 0; i < weights->count; i++) {
            double parts[PARTS];
            pixel_get(image, column + i, row - j, parts);
            for (int c = 0; c < PARTS; c++) {
                sum[c] += weights->across[i] * weights->up[j] * parts[c];
            }
        }
    }
}

// Each of the four pixels weighs as much as its distance's square is small.
static void mix_by_distance(const PreparedImage *image, int column, int row, double x, double y,
                            double sum[static PARTS])
{
    double weights = 0.0;
    for (int j = 0; j < 2; j++) {
        for (int i = 0; i < 2; i++) {
            double dx = x - i, dy = y - j, square = dx * dx + dy * dy, parts[PARTS];
            pixel_get(image, column + i, row - j, parts);
            if (square == 0.0) {
                memcpy(sum, parts, sizeof parts);
                return;
            }
            for (int c = 0; c < PARTS; c++) {
                sum[c] += parts[c] / square;
            }
            weights += 1.0 / square;
        }
    }
    for (int c = 0; c < PARTS; c++) {
        sum[c] /= weights;
    }
}

// Weights of the pixels at -1, 0, 1 and 2 for a place x from 0 to 1: E. Catmull, R. Rom, "A class of local
// interpolating splines", 1974.
static void spline_weights(double x, double weights[static 4])
{
    double x2 = x * x, x3 = x2 * x;
    weights[0] = -0.5 * x3 + x2 - 0.5 * x;
    weights[1] = 1.5 * x3 - 2.5 * x2 + 1.0;
    weights[2] = -1.5 * x3 + 2.0 * x2 + 0.5 * x;
    weights[3] = 0.5 * x3 - 0.5 * x2;
}

// A place between the middles of pixels, from the left and from below.
static void interpolate(const PreparedImage *image, double left, double below, double sum[static PARTS])
{
    double x_whole = floor(left), y_whole = floor(below), x = left - x_whole, y = below - y_whole;
    int column = (int)x_whole, row = image->picture->height - 1 - (int)y_whole;
    Weights weights = {{1.0 - x, x}, {1.0 - y, y}, 2};
    memset(sum, 0, PARTS * sizeof *sum);
    switch ((Interpolation)image->map.interpolation) {
    case INTERPOLATION_NONE:
        break;
    case INTERPOLATION_BILINEAR:
        mix(image, column, row, &weights, sum);
        break;
    case INTERPOLATION_BICUBIC:
        spline_weights(x, weights.across);
        spline_weights(y, weights.up);
        weights.count = 4;
        mix(image, column - 1, row + 1, &weights, sum);
        break;
    case INTERPOLATION_DISTANCE:
        mix_by_distance(image, column, row, x, y, sum);
        break;
    }
}

static Rgbft colour_of(const PreparedImage *image, const double parts[static PARTS])
{
    double alpha = 1.0 - parts[4];
    double share = !image->picture->is_associated ? 1.0 : alpha != 0.0 ? 1.0 / alpha : 0.0;
    return (Rgbft){share * parts[0], share * parts[1], share * parts[2], parts[3] + image->filter,
                   parts[4] + image->transmit};
}

// Pixels reach this much further right and up, in parts of one, so that rounding does not show at their edges.
static const double reach = 1e-10;

// From the left and from below, in pixels; false where there is no picture.
static bool find_place(const PreparedImage *image, Vec3 point, double *left, double *below)
{
    const Picture *picture = image->picture;
    Spot spot;
    if (!project(&image->map, point, &spot)) {
        return false;
    }
    *left = spot.across * picture->width + reach;
    *below = spot.up * picture->height + reach;
    bool is_place = *left >= 0.0 && *below >= 0.0; // and no NaN, of a point that is not finite
    return is_place && (!image->map.is_once || !(*left >= picture->width || *below >= picture->height));
}

static void parts_at(const PreparedImage *image, double left, double below, double parts[static PARTS])
{
    if (image->map.interpolation == INTERPOLATION_NONE) {
        pixel_get(image, (int)floor(left), image->picture->height - 1 - (int)floor(below), parts);
    } else {
        interpolate(image, left - 0.5, below - 0.5, parts);
    }
}

Rgbft image_colour(const PreparedImage *image, Vec3 point)
{
    static const Rgbft nothing = {1.0, 1.0, 1.0, 0.0, 1.0};
    double left, below, parts[PARTS];
    if (!find_place(image, point, &left, &below)) {
        return nothing;
    }
    parts_at(image, left, below, parts);
    return colour_of(image, parts);
}

double image_value(const PreparedImage *image, Vec3 point)
{
    double left, below, parts[PARTS];
    if (!find_place(image, point, &left, &below)) {
        return 0.0;
    }
    parts_at(image, left, below, parts);
    return parts[0];
}

// A number beyond the last texture begins anew, but for the first one that is beyond, which is the last. Measured.
uint32_t image_number(const PreparedImage *image, Vec3 point, uint32_t count)
{
    float number = (float)image_value(image, point) * 255.0F;
    uint32_t index = number > 0.0F ? (uint32_t)fminf(number, 65535.0F) : 0;
    return index > count ? index % count : index == count ? count - 1 : index;
}

// Beyond the edges it begins anew, where it is there once, too. Measured.
static double height_at(const PreparedImage *image, double left, double below)
{
    double parts[PARTS], width = image->picture->width, height = image->picture->height;
    left += left < 0.0 ? width : left >= width ? -width : 0.0;
    below += below < 0.0 ? height : 0.0;
    parts_at(image, left, below, parts);
    return parts[0];
}

// A normal that leans by less than this from y stands upright. Measured.
static const double upright_least = 1e-10;

// The slope of a triangle with one corner at the place and two in the row below, to its left and its right, laid out on
// the normal's plane by what is upright there. Measured.
Vec3 image_bumped(const PreparedImage *image, double amount, Vec3 point, Vec3 normal)
{
    double left, below, length = vec3_length(normal);
    if (!find_place(image, point, &left, &below) || !(length > 0.0)) {
        return normal;
    }
    double own = height_at(image, left, below);
    double first = height_at(image, left - 1.0, below - 1.0), last = height_at(image, left + 1.0, below - 1.0);
    Vec3 n = vec3_scale(1.0 / length, normal), across = vec3(-n.z, 0.0, n.x);
    double across_length = vec3_length(across);
    across = across_length > upright_least ? vec3_scale(1.0 / across_length, across) : vec3(1.0, 0.0, 0.0);
    Vec3 bumped = vec3_add_scaled(n, -amount * (last - first) / 2.0, across);
    return vec3_add_scaled(bumped, -amount * ((first + last) / 2.0 - own), vec3_cross(n, across));
}

// ---- cubes

// Values begin anew beyond the last one. One before the first is what POV-Ray finds there: its places are whole numbers
// of 64 bits without a sign. Measured.
static size_t value_place(int64_t place, size_t count)
{
    return (size_t)((uint64_t)place % count);
}

// Where along one side of a cube of `count` values: the first of the values that count there, and their weights.
static unsigned side_weights(double share, size_t count, int how, int64_t *first, double weights[static 4])
{
    double at = share * (double)count, whole = floor(at), x = at - whole;
    *first = (int64_t)whole - (how == 2 ? 1 : 0);
    weights[0] = how == 0 ? 1.0 : 1.0 - x;
    weights[1] = x;
    if (how == 2) {
        spline_weights(x, weights);
    }
    return how == 2 ? 4 : how == 1 ? 2 : 1;
}

double image_density(const PreparedImage *image, int how, Vec3 p)
{
    const Picture *cube = image->picture;
    size_t columns = (size_t)cube->width, layers = (size_t)cube->layers, rows = (size_t)cube->height / layers;
    int64_t first[3];
    double across[4], up[4], deep[4], sum = 0.0;
    if (!(p.x >= 0.0 && p.x < 1.0 && p.y >= 0.0 && p.y < 1.0 && p.z >= 0.0 && p.z < 1.0)) {
        return 0.0;
    }
    unsigned count = side_weights(p.x, columns, how, &first[0], across);
    (void)side_weights(p.y, rows, how, &first[1], up);
    (void)side_weights(p.z, layers, how, &first[2], deep);
    for (unsigned k = 0; k < count; k++) {
        size_t layer = value_place(first[2] + k, layers) * rows;
        for (unsigned j = 0; j < count; j++) {
            size_t row = (layer + value_place(first[1] + j, rows)) * columns;
            for (unsigned i = 0; i < count; i++) {
                double value = sample_colour(cube, row + value_place(first[0] + i, columns));
                sum += deep[k] * up[j] * across[i] * value;
            }
        }
    }
    return sum;
}
