// LDR-FLIP: how far apart two pictures look to somebody who flips between them.
//
// P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström and M. D. Fairchild, "FLIP: A Difference
// Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3, 2, 2020, doi 10.1145/3406183; the
// sections and equations below are its own. Two pipelines meet: colours as the eye blurs them, and edges and points.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE // M_PI
#endif
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

// The viewer that the paper proposes: 0.7 m before a screen 0.7 m wide with 3840 pixels (section 6).
#define PIXELS_PER_DEGREE (3840.0 * M_PI / 180.0)
// Three standard deviations of the widest filters, sqrt(b / 2) / pi of 0.04 and half of FEATURE_DEGREES, in pixels.
enum { RADIUS = 10, FEATURE_RADIUS = 9, TAPS = 2 * RADIUS + 1 };

// Sums of two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees, for the three opponents (section 4.1.1,
// table 1).
typedef struct Gaussian {
    double a, b;
} Gaussian;

static const Gaussian sensitivities[3][2] = {
    {{1.0, 0.0047}, {0.0, 1e-5}},
    {{1.0, 0.0053}, {0.0, 1e-5}},
    {{34.1, 0.04}, {13.5, 0.025}},
};

#define COLOUR_EXPONENT 0.7   // q_c, section 4.1.3
#define KNEE_PLACE 0.4        // p_c: this share of the greatest colour difference …
#define KNEE_VALUE 0.95       // p_t: … is mapped to this value
#define FEATURE_EXPONENT 0.5  // q_f, section 4.2.2
#define FEATURE_DEGREES 0.082 // w, section 4.2.1: the width of an edge

typedef struct Size {
    int width, height;
} Size;

// What the metric sees of a picture: planes of width * height values.
typedef struct View {
    double *opponents[3]; // blurred
    double *edge, *point; // sizes of gradients of first and second order
} View;

enum { VIEW_PLANES = 5, WORK_PLANES = 3 };

// ---- colours: sRGB's primaries and white D65 (IEC 61966-2-1)

typedef struct Triple {
    double v[3];
} Triple;

static const double to_xyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375},
    {0.2126729, 0.7151522, 0.0721750},
    {0.0193339, 0.1191920, 0.9503041},
};

// The inverse of to_xyz.
static const double from_xyz[3][3] = {
    {3.240454836021408, -1.537138850102575, -0.498531546868481},
    {-0.969266389875654, 1.876010928842491, 0.041556082346674},
    {0.055643419604214, -0.204025854267698, 1.057225162457929},
};

static Triple matrix_times(const double matrix[3][3], Triple a)
{
    Triple product;

    for (int i = 0; i < 3; i++) {
        product.v[i] = matrix[i][0] * a.v[0] + matrix[i][1] * a.v[1] + matrix[i][2] * a.v[2];
    }
    return product;
}

// XYZ over that of white.
static Triple relative_xyz(Triple linear)
{
    Triple xyz = matrix_times(to_xyz, linear);

    for (int i = 0; i < 3; i++) {
        xyz.v[i] /= to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
    }
    return xyz;
}

// Opponent colours that are linear in light, so that blurring them adds light (section 4.1.1).
static Triple opponents_of_linear(Triple linear)
{
    Triple xyz = relative_xyz(linear);

    return (Triple){{116.0 * xyz.v[1] - 16.0, 500.0 * (xyz.v[0] - xyz.v[1]), 200.0 * (xyz.v[1] - xyz.v[2])}};
}

static Triple linear_of_opponents(Triple opponents)
{
    double y = (opponents.v[0] + 16.0) / 116.0;
    Triple xyz = {{y + opponents.v[1] / 500.0, y, y - opponents.v[2] / 200.0}};

    for (int i = 0; i < 3; i++) {
        xyz.v[i] *= to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
    }
    return matrix_times(from_xyz, xyz);
}

// The CIE's function of lightness.
static double lightness_root(double t)
{
    const double delta = 6.0 / 29.0;

    return t > delta * delta * delta ? cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

// L*a*b* with a* and b* weaker where it is dark, as Hunt saw (section 4.1.2).
static Triple hunt_lab(Triple linear)
{
    Triple xyz = relative_xyz(linear);
    double x = lightness_root(xyz.v[0]), y = lightness_root(xyz.v[1]), z = lightness_root(xyz.v[2]);
    double lightness = 116.0 * y - 16.0;

    return (Triple){{lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)}};
}

// HyAB: city blocks between lightnesses, a straight line between hues.
static double hyab(Triple a, Triple b)
{
    return fabs(a.v[0] - b.v[0]) + hypot(a.v[1] - b.v[1], a.v[2] - b.v[2]);
}

// What no pair of colours exceeds: green against blue.
static double greatest_difference(void)
{
    Triple green = hunt_lab((Triple){{0.0, 1.0, 0.0}}), blue = hunt_lab((Triple){{0.0, 0.0, 1.0}});

    return pow(hyab(green, blue), COLOUR_EXPONENT);
}

// Small differences get most of the range (section 4.1.3).
static double redistribute(double difference, double greatest)
{
    double powered = pow(difference, COLOUR_EXPONENT), knee = KNEE_PLACE * greatest;

    if (powered < knee) {
        return KNEE_VALUE / knee * powered;
    }
    return KNEE_VALUE + (powered - knee) / (greatest - knee) * (1.0 - KNEE_VALUE);
}

// ---- filters

static size_t size_pixels(Size size)
{
    return (size_t)size.width * (size_t)size.height;
}

static int clamp_index(int index, int count)
{
    return index < 0 ? 0 : index >= count ? count - 1 : index;
}

// One pass along the rows or the columns; beyond its edge a plane continues as it is there. Adds weight times
// the result to `to`.
static void filter_pass(Size size, const double *from, bool along_rows, const double taps[TAPS], double weight,
                        double *to)
{
    for (int y = 0; y < size.height; y++) {
        for (int x = 0; x < size.width; x++) {
            double sum = 0.0;
            for (int i = -RADIUS; i <= RADIUS; i++) {
                int column = along_rows ? clamp_index(x + i, size.width) : x;
                int row = along_rows ? y : clamp_index(y + i, size.height);
                sum += taps[i + RADIUS] * from[(size_t)row * (size_t)size.width + (size_t)column];
            }
            to[(size_t)y * (size_t)size.width + (size_t)x] += weight * sum;
        }
    }
}

// The product of a filter along the rows and one along the columns, times `weight`.
typedef struct Filter {
    const double *across, *down; // TAPS of each
    double weight;
} Filter;

// What a filter makes of a plane, added to `to`.
static void filter_add(Size size, const double *from, Filter filter, double *spare, double *to)
{
    memset(spare, 0, size_pixels(size) * sizeof *spare);
    filter_pass(size, from, true, filter.across, 1.0, spare);
    filter_pass(size, spare, false, filter.down, filter.weight, to);
}

// Blurs a plane as the eye does. Each Gaussian is separable, their sum is not; all taps together add up to 1.
static void blur(Size size, const Gaussian gaussians[2], const double *from, double *spare, double *to)
{
    double taps[2][TAPS], weights[2], total = 0.0;

    for (int k = 0; k < 2; k++) {
        double sum = 0.0;
        for (int i = -RADIUS; i <= RADIUS; i++) {
            double degrees = (double)i / PIXELS_PER_DEGREE;
            taps[k][i + RADIUS] = exp(-M_PI * M_PI * degrees * degrees / gaussians[k].b);
            sum += taps[k][i + RADIUS];
        }
        weights[k] = gaussians[k].a * sqrt(M_PI / gaussians[k].b);
        total += weights[k] * sum * sum;
    }
    for (int k = 0; k < 2; k++) {
        if (weights[k] > 0.0) {
            filter_add(size, from, (Filter){taps[k], taps[k], weights[k] / total}, spare, to);
        }
    }
}

// Taps above 0 shall add up to 1 and those below 0 to -1.
static void taps_normalise(double taps[TAPS])
{
    double above = 0.0, below = 0.0;

    for (int i = 0; i < TAPS; i++) {
        above += fmax(taps[i], 0.0);
        below -= fmin(taps[i], 0.0);
    }
    for (int i = 0; i < TAPS; i++) {
        taps[i] /= taps[i] > 0.0 ? above : below > 0.0 ? below : 1.0;
    }
}

// A Gaussian and its first and second derivatives, up to a factor (section 4.2.1).
static void feature_taps(double smooth[TAPS], double first[TAPS], double second[TAPS])
{
    const double deviation = 0.5 * FEATURE_DEGREES * PIXELS_PER_DEGREE;

    for (int i = -RADIUS; i <= RADIUS; i++) {
        double x = (double)i / deviation;
        double value = abs(i) <= FEATURE_RADIUS ? exp(-0.5 * x * x) : 0.0;
        smooth[i + RADIUS] = value;
        first[i + RADIUS] = -x * value;
        second[i + RADIUS] = (x * x - 1.0) * value;
    }
    taps_normalise(smooth);
    taps_normalise(first);
    taps_normalise(second);
}

// The length of the gradient of a plane, whose parts are found by `slope` across `smooth`. `work` is three planes.
static void gradient(Size size, const double *from, const double slope[TAPS], const double smooth[TAPS],
                     double *const work[WORK_PLANES], double *to)
{
    size_t pixels = size_pixels(size);

    memset(work[1], 0, pixels * sizeof *work[1]);
    memset(work[2], 0, pixels * sizeof *work[2]);
    filter_add(size, from, (Filter){slope, smooth, 1.0}, work[0], work[1]);
    filter_add(size, from, (Filter){smooth, slope, 1.0}, work[0], work[2]);
    for (size_t i = 0; i < pixels; i++) {
        to[i] = hypot(work[1][i], work[2][i]);
    }
}

// ---- pictures

static Triple pixel_linear(const Image *image, size_t pixel)
{
    const float *stored = image->values + pixel * (size_t)image->channels;
    Triple linear;

    for (int i = 0; i < 3; i++) {
        double value = (double)stored[image->channels < 3 ? 0 : i];
        linear.v[i] = value > 0.0 ? fmin(value, 1.0) : 0.0; // no number counts as 0
    }
    return linear;
}

// Fills a view whose planes are cleared; `raw` and `work` are three planes each.
static void view_fill(const Image *image, double *const raw[3], double *const work[WORK_PLANES], const View *view)
{
    Size size = {image->width, image->height};
    double smooth[TAPS], first[TAPS], second[TAPS];

    for (size_t i = 0; i < size_pixels(size); i++) {
        Triple opponents = opponents_of_linear(pixel_linear(image, i));
        for (int c = 0; c < 3; c++) {
            raw[c][i] = opponents.v[c];
        }
    }
    for (int c = 0; c < 3; c++) {
        blur(size, sensitivities[c], raw[c], work[0], view->opponents[c]);
    }
    feature_taps(smooth, first, second);
    for (size_t i = 0; i < size_pixels(size); i++) {
        raw[0][i] = (raw[0][i] + 16.0) / 116.0; // light alone, 0 to 1
    }
    gradient(size, raw[0], first, smooth, work, view->edge);
    gradient(size, raw[0], second, smooth, work, view->point);
}

static Triple view_lab(const View *view, size_t i)
{
    Triple linear = linear_of_opponents(
        (Triple){{view->opponents[0][i], view->opponents[1][i], view->opponents[2][i]}});

    for (int c = 0; c < 3; c++) {
        linear.v[c] = fmin(fmax(linear.v[c], 0.0), 1.0);
    }
    return hunt_lab(linear);
}

static double pixel_flip(const View *a, const View *b, size_t i, double greatest)
{
    double colour = redistribute(hyab(view_lab(a, i), view_lab(b, i)), greatest);
    double feature = fmax(fabs(a->edge[i] - b->edge[i]), fabs(a->point[i] - b->point[i]));

    return pow(colour, 1.0 - pow(M_SQRT1_2 * feature, FEATURE_EXPONENT)); // section 4.3
}

bool image_flip(const Image *a, const Image *b, double *mean)
{
    enum { ALL = 2 * VIEW_PLANES + 3 + WORK_PLANES };
    Size size = {a->width, a->height};
    size_t pixels = size_pixels(size);
    double *memory, *planes[ALL], greatest = greatest_difference(), sum = 0.0;

    if (a->width != b->width || a->height != b->height || pixels == 0) {
        return false;
    }
    memory = calloc(pixels, ALL * sizeof *memory);
    if (!memory) {
        return false;
    }
    for (int i = 0; i < ALL; i++) {
        planes[i] = memory + (size_t)i * pixels;
    }
    const View view_a = {{planes[0], planes[1], planes[2]}, planes[3], planes[4]};
    const View view_b = {{planes[5], planes[6], planes[7]}, planes[8], planes[9]};
    view_fill(a, planes + 10, planes + 13, &view_a);
    view_fill(b, planes + 10, planes + 13, &view_b);
    for (size_t i = 0; i < pixels; i++) {
        sum += pixel_flip(&view_a, &view_b, i, greatest);
    }
    *mean = sum / (double)pixels;
    free(memory);
    return true;
}
