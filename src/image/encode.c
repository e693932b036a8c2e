// Transfer functions and quantisation; the rounding is the one measured on POV-Ray 3.7.0.10: half up, in single
// precision.
//
// SPDX-License-Identifier: MIT
#include "image/encode.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/attributes.h"
#include "math/colour.h"

static const ImageEncoding stored_as_is = {.depth = IMAGE_DEPTH_16, .already_encoded = true};

static uint32_t float_bits(float value)
{
    uint32_t bits;

    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static float float_from_bits(uint32_t bits)
{
    float value;

    memcpy(&value, &bits, sizeof value);
    return value;
}

static float code_max(ImageDepth depth)
{
    return depth == IMAGE_DEPTH_8 ? 255.0f : 65535.0f;
}

// IEC 61966-2-1:1999, section 5.2.
static double srgb_from_linear(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

// The transfer function alone, for 0 <= linear <= 1.
static double encode_transfer(const ImageEncoding *encoding, double linear)
{
    if (encoding->already_encoded) {
        return linear;
    }
    if (encoding->transfer == IMAGE_TRANSFER_SRGB) {
        return srgb_from_linear(linear);
    }
    return encoding->gamma == 1.0 ? linear : pow(linear, 1.0 / encoding->gamma);
}

unsigned encode_code(const ImageEncoding *encoding, float linear)
{
    float max = code_max(encoding->depth);
    float scaled;

    if (!(linear > 0.0f)) { // also NaN
        return 0;
    }
    if (linear >= 1.0f) {
        return (unsigned)max;
    }
    scaled = (float)(encode_transfer(encoding, (double)linear) * (double)max);
    return (unsigned)(scaled + 0.5f);
}

// Linear light whose code is about so much, as bits.
static uint32_t threshold_guess(const ImageEncoding *encoding, unsigned code)
{
    double value = ((double)code - 0.5) / (double)code_max(encoding->depth);
    if (value <= 0.0) {
        return 0;
    }
    if (!encoding->already_encoded) {
        value = encoding->transfer == IMAGE_TRANSFER_SRGB ? rgb_srgb_decode(value) : pow(value, encoding->gamma);
    }
    return float_bits((float)value);
}

// The least float from `low` up to 1, as bits, whose code is at least `code`: floats are ordered as their bits. It is
// looked for farther and farther from where it should be, then between.
static uint32_t threshold_find(const ImageEncoding *encoding, unsigned code, uint32_t low)
{
    uint32_t high = float_bits(1.0f), middle = threshold_guess(encoding, code);

    middle = middle < low ? low : middle >= high ? high - 1 : middle;
    for (uint32_t step = 16; low < high; step *= 4) {
        if (encode_code(encoding, float_from_bits(middle)) >= code) {
            high = middle;
            middle = high - low > step ? high - step : low + (high - low) / 2;
        } else {
            low = middle + 1;
            middle = high - low > step ? low + step : low + (high - low) / 2;
        }
    }
    return low;
}

// A picture has far more samples than there are codes: with tables no sample costs a power function.
static void encoder_build_tables(Encoder *encoder)
{
    uint32_t bits = 0;
    unsigned code = 0;

    for (unsigned k = 0; k < ENCODE_CODES_8; k++) {
        bits = threshold_find(&encoder->encoding, k, bits);
        encoder->threshold[k] = float_from_bits(bits);
    }
    encoder->threshold[ENCODE_CODES_8] = (float)INFINITY;
    encoder->steps = 0;
    for (uint32_t b = 0; b < ENCODE_BUCKETS; b++) {
        unsigned before = code;
        for (float value = float_from_bits(b << 16); value >= encoder->threshold[code + 1];) {
            code++;
        }
        encoder->bucket[b] = (uint8_t)code;
        encoder->steps = code - before > encoder->steps ? code - before : encoder->steps;
    }
}

void encoder_init(Encoder *encoder, const ImageEncoding *encoding, int channels)
{
    encoder->encoding = *encoding;
    encoder->channels = channels;
    if (encoding->depth == IMAGE_DEPTH_8) {
        encoder_build_tables(encoder);
    }
}

size_t encode_sample_bytes(ImageDepth depth)
{
    static const size_t bytes[] = {
        [IMAGE_DEPTH_8] = sizeof(uint8_t), [IMAGE_DEPTH_16] = sizeof(uint16_t), [IMAGE_DEPTH_FLOAT] = sizeof(float)};

    return bytes[depth];
}

// Without branches: they would be taken at random.
RT_ALWAYS_INLINE uint8_t encode_8(const Encoder *encoder, unsigned steps, float value)
{
    unsigned code;

    value = value > 0.0f ? value : 0.0f; // also NaN
    value = value < 1.0f ? value : 1.0f;
    code = encoder->bucket[float_bits(value) >> 16];
    for (unsigned i = 0; i < steps; i++) {
        code += value >= encoder->threshold[code + 1];
    }
    return (uint8_t)code;
}

// Values that are looked at together: whole pixels of 1, 2, 3 or 4 channels.
enum { CHUNK = 24 };

typedef uint64_t Bits __attribute__((vector_size(16)));

// Where the bits of eight values are not those of the pixel before.
RT_ALWAYS_INLINE Bits bits_apart(const float *values, size_t channels)
{
    Bits here[2], before[2];
    memcpy(here, values, sizeof here);
    memcpy(before, values - channels, sizeof before);
    return (here[0] ^ before[0]) | (here[1] ^ before[1]);
}

// Whether the values of a chunk are those of the pixel before it.
RT_ALWAYS_INLINE bool is_chunk_even(const float *values, size_t channels)
{
    Bits apart = bits_apart(values, channels) | bits_apart(values + 8, channels) | bits_apart(values + 16, channels);
    return (apart[0] | apart[1]) == 0;
}

RT_ALWAYS_INLINE void run_8_steps(const Encoder *encoder, unsigned steps, const float *values, size_t count,
                                  uint8_t *samples)
{
    for (size_t i = 0; i < count; i++) {
        samples[i] = encode_8(encoder, steps, values[i]);
    }
}

static void chunk_8(const Encoder *encoder, const float *values, size_t count, uint8_t *samples)
{
    if (encoder->steps == 1) { // as for sRGB
        run_8_steps(encoder, 1, values, count, samples);
    } else {
        run_8_steps(encoder, encoder->steps, values, count, samples);
    }
}

// Backgrounds are even: what is as the pixel before it has its code.
static void run_8(const Encoder *encoder, const float *values, size_t count, uint8_t *samples)
{
    size_t channels = (size_t)encoder->channels, i = 0;
    bool was_even = false;
    for (; i + CHUNK <= count; i += CHUNK) {
        bool is_even = i > 0 && is_chunk_even(values + i, channels);
        if (!is_even) {
            chunk_8(encoder, values + i, CHUNK, samples + i);
        } else if (was_even) {
            memcpy(samples + i, samples + i - CHUNK, CHUNK);
        } else {
            for (size_t k = i; k < i + CHUNK; k++) {
                samples[k] = samples[k - channels];
            }
        }
        was_even = is_even;
    }
    chunk_8(encoder, values + i, count - i, samples + i);
}

static void run_16(const Encoder *encoder, const float *values, size_t count, uint16_t *samples)
{
    for (size_t i = 0; i < count; i++) {
        samples[i] = (uint16_t)encode_code(&encoder->encoding, values[i]);
    }
}

static void run_float(const float *values, size_t count, float *samples)
{
    for (size_t i = 0; i < count; i++) {
        samples[i] = isnan(values[i]) ? 0.0f : values[i];
    }
}

// Writes the alpha channel over again: it is a share of area and not light, and is stored linear (PNG, third edition,
// section 12.2, "Alpha channel").
static void run_alpha(const Encoder *encoder, const float *values, size_t pixels, void *samples)
{
    ImageEncoding plain = stored_as_is;
    size_t step = (size_t)encoder->channels;

    plain.depth = encoder->encoding.depth;
    for (size_t i = step - 1; i < pixels * step; i += step) {
        unsigned code = encode_code(&plain, values[i]);
        if (plain.depth == IMAGE_DEPTH_8) {
            ((uint8_t *)samples)[i] = (uint8_t)code;
        } else {
            ((uint16_t *)samples)[i] = (uint16_t)code;
        }
    }
}

void encoder_run(const Encoder *encoder, const float *values, size_t pixels, void *samples)
{
    size_t count = pixels * (size_t)encoder->channels;
    bool has_alpha = encoder->channels == 2 || encoder->channels == 4;

    if (encoder->encoding.depth == IMAGE_DEPTH_FLOAT) {
        run_float(values, count, samples);
        return;
    }
    if (encoder->encoding.depth == IMAGE_DEPTH_8) {
        run_8(encoder, values, count, samples);
    } else {
        run_16(encoder, values, count, samples);
    }
    if (has_alpha) {
        run_alpha(encoder, values, pixels, samples);
    }
}
