// LDR-FLIP against what follows from the paper's formulas without a program: plain pictures, single points, symmetries.
// tests/system/check_report.py compares it with a second, direct evaluation.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "image/image.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 64, HEIGHT = 48 };

static bool picture_plain(Image *image, int width, int height, const double colour[3])
{
    if (!image_init(image, width, height, 3)) {
        return false;
    }
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        for (int c = 0; c < 3; c++) {
            image->values[3 * i + (size_t)c] = (float)colour[c];
        }
    }
    return true;
}

// NAN when it could not be computed.
static double flip_of(const Image *a, const Image *b)
{
    double mean = NAN;

    return image_flip(a, b, &mean) ? mean : NAN;
}

// Where all is of one colour nothing is blurred and there are no edges: what is left is the difference of two colours.
// Between black and white L* differs by 100, and 100^0.7 = 25.119. Green and blue are 203.27 apart, so that the
// greatest difference is 203.27^0.7 = 41.275 and the knee is at 16.510: 0.95 + 0.05 (25.119 - 16.510) / (41.275 -
// 16.510).
static void test_plain(void)
{
    static const struct {
        const char *name;
        double a[3], b[3], expected;
    } cases[] = {
        {"black and black", {0, 0, 0}, {0, 0, 0}, 0.0},
        {"white and white", {1, 1, 1}, {1, 1, 1}, 0.0},
        {"black and white", {0, 0, 0}, {1, 1, 1}, 0.9673805159055},
        {"black and grey", {0, 0, 0}, {0.5, 0.5, 0.5}, 0.9585434209132},
        {"red and yellow", {1, 0, 0}, {1, 1, 0}, 0.9771510835129},
        {"green and blue, the greatest difference", {0, 1, 0}, {0, 0, 1}, 1.0},
        {"white and more than white", {1, 1, 1}, {7, 1, INFINITY}, 0.0},
        {"black and less than black", {0, 0, 0}, {-1, NAN, -INFINITY}, 0.0},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Image a = {0}, b = {0};
        bool made = picture_plain(&a, WIDTH, HEIGHT, cases[i].a) && picture_plain(&b, WIDTH, HEIGHT, cases[i].b);
        double found = made ? flip_of(&a, &b) : NAN;
        tap_ok(fabs(found - cases[i].expected) < 1e-7, "%s: %.12g", cases[i].name, found);
        image_fini(&a);
        image_fini(&b);
    }
}

static void picture_random(Image *image, uint64_t seed)
{
    Random random = {seed};

    for (size_t i = 0; i < 3 * (size_t)image->width * (size_t)image->height; i++) {
        image->values[i] = (float)random_between(&random, 0.0, 1.0);
    }
}

static void picture_transpose(const Image *from, Image *to)
{
    for (int y = 0; y < from->height; y++) {
        for (int x = 0; x < from->width; x++) {
            for (int c = 0; c < 3; c++) {
                to->values[3 * (x * from->height + y) + c] = from->values[3 * (y * from->width + x) + c];
            }
        }
    }
}

static void test_symmetry(void)
{
    static const double black[3] = {0, 0, 0};
    Image a = {0}, b = {0}, turned_a = {0}, turned_b = {0};
    double there;

    if (tap_ok(picture_plain(&a, WIDTH, HEIGHT, black) && picture_plain(&b, WIDTH, HEIGHT, black) &&
                   picture_plain(&turned_a, HEIGHT, WIDTH, black) && picture_plain(&turned_b, HEIGHT, WIDTH, black),
               "pictures")) {
        picture_random(&a, 1);
        picture_random(&b, 2);
        picture_transpose(&a, &turned_a);
        picture_transpose(&b, &turned_b);
        there = flip_of(&a, &b);
        tap_ok(there > 0.0 && there < 1.0, "two pictures of noise: %.12g", there);
        tap_ok(there == flip_of(&b, &a), "the order of the pictures does not matter");
        tap_ok(fabs(there - flip_of(&turned_a, &turned_b)) < 1e-12, "nor do rows and columns");
        tap_ok(flip_of(&a, &a) == 0.0, "a picture does not differ from itself");
        tap_ok(isnan(flip_of(&a, &turned_a)), "sizes must be equal");
    }
    image_fini(&a);
    image_fini(&b);
    image_fini(&turned_a);
    image_fini(&turned_b);
}

// What a green dot adds up to does not depend on where it is.
static void test_dot(void)
{
    static const double black[3] = {0, 0, 0};
    Image plain = {0}, dot = {0};
    size_t places[] = {20 * WIDTH + 20, 27 * WIDTH + 43};
    double found[2];

    if (tap_ok(picture_plain(&plain, WIDTH, HEIGHT, black) && picture_plain(&dot, WIDTH, HEIGHT, black), "pictures")) {
        for (int k = 0; k < 2; k++) {
            dot.values[3 * places[k] + 1] = 1.0f;
            found[k] = flip_of(&plain, &dot);
            dot.values[3 * places[k] + 1] = 0.0f;
        }
        // It reaches 10 pixels far, across and down, and at most 1 in each.
        tap_ok(found[0] > 0.0 && found[0] * WIDTH * HEIGHT < 441.0, "a dot is seen around itself: %.12g", found[0]);
        tap_ok(fabs(found[0] - found[1]) < 1e-12, "and as much elsewhere");
    }
    image_fini(&plain);
    image_fini(&dot);
}

int main(void)
{
    test_plain();
    test_symmetry();
    test_dot();
    return tap_done();
}
