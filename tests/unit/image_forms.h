// Encodings that the tests of pictures use, and values to encode.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_IMAGE_FORMS_H
#define UNIT_IMAGE_FORMS_H

#include <stdint.h>

#include "image/image.h"

static const ImageEncoding srgb_8 = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB, .threads = 1};
static const ImageEncoding srgb_16 = {.depth = IMAGE_DEPTH_16, .transfer = IMAGE_TRANSFER_SRGB, .threads = 1};
static const ImageEncoding linear_8 = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_POWER, .gamma = 1.0, .threads = 1};
static const ImageEncoding linear_16 = {.depth = IMAGE_DEPTH_16, .transfer = IMAGE_TRANSFER_POWER, .gamma = 1.0, .threads = 1};
static const ImageEncoding power_8 = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_POWER, .gamma = 2.2, .threads = 1};
static const ImageEncoding power_16 = {.depth = IMAGE_DEPTH_16, .transfer = IMAGE_TRANSFER_POWER, .gamma = 2.2, .threads = 1};
static const ImageEncoding as_is_8 = {.depth = IMAGE_DEPTH_8, .transfer = IMAGE_TRANSFER_SRGB, .already_encoded = true, .threads = 1};

static inline uint32_t next_random(uint32_t *state) // xorshift32: G. Marsaglia, "Xorshift RNGs", 2003
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static inline float random_unit(uint32_t *state)
{
    return (float)(next_random(state) >> 8) * 0x1p-24f;
}

#endif
