// Tests of what needs no file: transfer functions, quantisation, comparison.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdint.h>

#include "base/attributes.h"
#include "image/encode.h"
#include "image/image.h"
#include "unit/image_forms.h"
#include "unit/tap.h"

// The codes stored by POV-Ray 3.7.0.10 for the same values, and the ends of the range.
static void test_codes(void)
{
    static const struct {
        const char *name;
        const ImageEncoding *encoding;
        float value;
        unsigned code;
    } cases[] = {
        {"srgb 8, .5", &srgb_8, 0.5f, 188},
        {"srgb 8, .25", &srgb_8, 0.25f, 137},
        {"srgb 8, .02", &srgb_8, 0.02f, 39},
        {"srgb 16, .5", &srgb_16, 0.5f, 48192},
        {"srgb 16, .25", &srgb_16, 0.25f, 35199},
        {"srgb 16, .02", &srgb_16, 0.02f, 9942},
        {"srgb 16, .5 ^ 2.2", &srgb_16, 0.217637640824031f, 33021},
        {"srgb 8, .5 ^ 2.2", &srgb_8, 0.217637640824031f, 128},
        {"srgb 16, .02 ^ 2.2", &srgb_16, 0.00018291010195069f, 155},
        {"linear 16, .5", &linear_16, 0.5f, 32768},
        {"linear 8, .5", &linear_8, 0.5f, 128},
        {"power 16, .5", &power_16, 0.5f, 47824}, // 65535 * .5 ^ (1 / 2.2) = 47823.6
        {"as it is, .5", &as_is_8, 0.5f, 128},
        {"rounds half up in single precision", &linear_16, 0x1.c0p-16f, 2}, // 1.74997
        {"over the range", &srgb_16, 1.3f, 65535},
        {"under the range", &srgb_16, -0.4f, 0},
        {"infinity", &srgb_8, INFINITY, 255},
        {"minus infinity", &srgb_8, -INFINITY, 0},
        {"not a number", &srgb_16, NAN, 0},
        {"one", &power_16, 1.0f, 65535},
        {"a denormal", &power_8, 0x1p-149f, 0},
    };

    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        unsigned code = encode_code(cases[i].encoding, cases[i].value);
        tap_ok(code == cases[i].code, "code of %s: %u, want %u", cases[i].name, code, cases[i].code);
    }
}

// A half way case in single precision is not one in double: (k + .5) / 65535 is rounded twice.
static void test_rounding(void)
{
    int wrong = 0;

    for (unsigned k = 0; k < 65535; k++) {
        float value = (float)((k + 0.5) / 65535.0);
        float scaled = (float)((double)value * 65535.0);
        wrong += encode_code(&linear_16, value) != (unsigned)floorf(scaled + 0.5f);
    }
    tap_ok(wrong == 0, "half way codes are rounded in single precision: %d differ", wrong);
}

// The tables of the 8 bit encoder against the formula: at random and on both sides of each step.
static void test_tables(void)
{
    static const ImageEncoding *const encodings[] = {&srgb_8, &linear_8, &power_8, &as_is_8};
    static const ImageEncoding steep = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_POWER, .gamma = 0.1, .threads = 1};
    static Encoder encoder;
    uint32_t state = 12345;

    for (size_t e = 0; e <= RT_COUNT_OF(encodings); e++) {
        const ImageEncoding *encoding = e < RT_COUNT_OF(encodings) ? encodings[e] : &steep;
        int wrong = 0;

        encoder_init(&encoder, encoding, 3);
        for (int i = 0; i < 60000; i++) {
            float x = random_unit(&state);
            float step = encoder.threshold[next_random(&state) & 255];
            float values[3] = {x * x * 1.01f, step, nextafterf(step, -1.0f)};
            uint8_t samples[3];

            encoder_run(&encoder, values, 1, samples);
            for (int c = 0; c < 3; c++) {
                wrong += samples[c] != encode_code(encoding, values[c]);
            }
        }
        tap_ok(wrong == 0, "8 bit tables %zu equal the formula: %d differ", e, wrong);
    }
}

static void test_compare(void)
{
    static const double thresholds[IMAGE_THRESHOLDS] = {0.0, 0.25, 0.25 + 1.0 / 64.0};
    Image a, b;
    ImageDifference difference;

    if (!tap_ok(image_init(&a, 100, 100, 3) && image_init(&b, 100, 100, 4), "compare: pictures")) {
        return;
    }
    tap_ok(image_compare(&a, &b, thresholds, &difference) && difference.max == 0.0 && difference.rmse == 0.0 &&
               difference.psnr == HUGE_VAL && difference.p999 == 0.0 && difference.pixels_beyond[0] == 0 &&
               difference.pixels == 10000,
           "equal pictures do not differ");
    for (size_t i = 0; i < 11; i++) { // eleven pixels of a value each: one more than a thousandth
        b.values[4 * (100 * i + i) + i % 3] = 0.25f + (float)i / 64.0f;
    }
    b.values[4 * 5000 + 3] = 1.0f; // alpha is not compared
    tap_ok(image_compare(&a, &b, thresholds, &difference), "compare");
    tap_ok(difference.max == 0.25 + 10.0 / 64.0, "greatest difference: %g", difference.max);
    tap_ok(difference.pixels_beyond[0] == 11 && difference.pixels_beyond[1] == 10 && difference.pixels_beyond[2] == 9,
           "pixels beyond: those above a threshold, not at it");
    tap_ok(difference.p999 == 0.25, "the percentile is the 9990th of 10000 pixels: %g", difference.p999);
    tap_ok(fabs(difference.rmse - sqrt(1.211181640625 / 30000.0)) < 1e-15, "rmse: %.17g", difference.rmse);
    tap_ok(fabs(difference.psnr + 20.0 * log10(difference.rmse)) < 1e-12, "psnr: %g", difference.psnr);
    b.values[0] = NAN;
    tap_ok(image_compare(&a, &b, thresholds, &difference) && difference.max == HUGE_VAL &&
               difference.pixels_beyond[1] == 11,
           "not a number differs from any");
    a.values[0] = NAN;
    tap_ok(image_compare(&a, &b, thresholds, &difference) && difference.max < 1.0, "but not from itself");
    a.height = 99;
    tap_ok(!image_compare(&a, &b, thresholds, &difference), "sizes must be equal");
    a.height = 100;
    image_fini(&a);
    image_fini(&b);
}

int main(void)
{
    test_codes();
    test_rounding();
    test_tables();
    test_compare();
    return tap_done();
}
