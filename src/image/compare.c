// How two pictures differ. All sums are doubles in the order of the pixels: the numbers are the same everywhere.
//
// The percentile is selected, not estimated: by two counting passes over the bits of the differences, without sorting.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

enum { DIGITS = 1 << 16 };

// A difference that is no number is as great as can be; equal values, infinite ones too, do not differ.
static double value_difference(float a, float b)
{
    double difference;

    if (a == b || (isnan(a) && isnan(b))) {
        return 0.0;
    }
    difference = fabs((double)a - (double)b);
    return isnan(difference) ? HUGE_VAL : difference;
}

// Grey stands for three equal channels.
static float pixel_channel(const Image *image, size_t pixel, int channel)
{
    int stored = image->channels < 3 ? 0 : channel;

    return image->values[pixel * (size_t)image->channels + (size_t)stored];
}

static uint32_t bits_of(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

// The digit in whose count the rank falls; *rank becomes the rank within it.
static uint32_t digit_at_rank(const size_t *counts, size_t *rank)
{
    uint32_t digit = 0;

    while (*rank >= counts[digit]) {
        *rank -= counts[digit];
        digit++;
    }
    return digit;
}

// The value at `rank`, from 0, of values not below zero: these are ordered as their bits. `counts` is room for DIGITS.
static float select_rank(const float *values, size_t count, size_t rank, size_t *counts)
{
    uint32_t high, bits;
    float value;

    memset(counts, 0, DIGITS * sizeof *counts);
    for (size_t i = 0; i < count; i++) {
        counts[bits_of(values[i]) >> 16]++;
    }
    high = digit_at_rank(counts, &rank);
    memset(counts, 0, DIGITS * sizeof *counts);
    for (size_t i = 0; i < count; i++) {
        bits = bits_of(values[i]);
        if (bits >> 16 == high) {
            counts[bits & 0xffff]++;
        }
    }
    bits = high << 16 | digit_at_rank(counts, &rank);
    memcpy(&value, &bits, sizeof value);
    return value;
}

double image_pixel_difference(const Image *a, const Image *b, size_t pixel)
{
    double most = 0.0;

    for (int c = 0; c < 3; c++) {
        most = fmax(most, value_difference(pixel_channel(a, pixel, c), pixel_channel(b, pixel, c)));
    }
    return most;
}

// Fills everything but p999, and the greatest difference of each pixel.
static void compare_pixels(const Image *a, const Image *b, const double *thresholds, ImageDifference *difference,
                           float *greatest)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;
    double squares = 0.0;

    *difference = (ImageDifference){.pixels = pixels};
    for (size_t i = 0; i < pixels; i++) {
        double most = image_pixel_difference(a, b, i);

        for (int c = 0; c < 3; c++) {
            double d = value_difference(pixel_channel(a, i, c), pixel_channel(b, i, c));
            squares += d * d;
        }
        greatest[i] = (float)most;
        difference->max = fmax(difference->max, most);
        for (int k = 0; k < IMAGE_THRESHOLDS; k++) {
            difference->pixels_beyond[k] += most > thresholds[k] ? 1 : 0;
        }
    }
    difference->rmse = sqrt(squares / (3.0 * (double)pixels));
    difference->psnr = squares > 0.0 ? -20.0 * log10(difference->rmse) : HUGE_VAL;
}

bool image_compare(const Image *a, const Image *b, const double thresholds[IMAGE_THRESHOLDS],
                   ImageDifference *difference)
{
    size_t pixels = (size_t)a->width * (size_t)a->height;
    float *greatest;
    size_t *counts;
    bool fine = false;

    if (a->width != b->width || a->height != b->height || pixels == 0) {
        return false;
    }
    greatest = malloc(pixels * sizeof *greatest);
    counts = malloc(DIGITS * sizeof *counts);
    if (greatest && counts) {
        compare_pixels(a, b, thresholds, difference, greatest);
        // Nearest rank: the least value that at least 99.9 % of the pixels do not exceed.
        difference->p999 = (double)select_rank(greatest, pixels, (pixels * 999 + 999) / 1000 - 1, counts);
        fine = true;
    }
    free(greatest);
    free(counts);
    return fine;
}
