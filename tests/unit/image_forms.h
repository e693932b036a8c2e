// Encodings that the tests of pictures use, and values to encode.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_IMAGE_FORMS_H
#define UNIT_IMAGE_FORMS_H

#include <stdint.h>

#include "image/image.h"

static const ImageEncoding srgb_8 = {IMAGE_DEPTH_8, IMAGE_TRANSFER_SRGB, 0.0, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding srgb_16 = {IMAGE_DEPTH_16, IMAGE_TRANSFER_SRGB, 0.0, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding linear_8 = {IMAGE_DEPTH_8, IMAGE_TRANSFER_POWER, 1.0, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding linear_16 = {IMAGE_DEPTH_16, IMAGE_TRANSFER_POWER, 1.0, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding power_8 = {IMAGE_DEPTH_8, IMAGE_TRANSFER_POWER, 2.2, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding power_16 = {IMAGE_DEPTH_16, IMAGE_TRANSFER_POWER, 2.2, false, 1, NULL, 0, NULL, 0};
static const ImageEncoding as_is_8 = {IMAGE_DEPTH_8, IMAGE_TRANSFER_SRGB, 0.0, true, 1, NULL, 0, NULL, 0};

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
