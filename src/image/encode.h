// Rows of linear light to rows of samples as files hold them: transfer function, clamping, quantisation.
//
// It knows nothing of files. An encoder is built once for a picture and is then constant.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_ENCODE_H
#define IMAGE_ENCODE_H

#include <stddef.h>
#include <stdint.h>

#include "image/image.h"

enum {
    ENCODE_CODES_8 = 256,
    ENCODE_BUCKETS = 0x3f81, // the floats from 0 to 1, by the upper half of their bits
};

typedef struct Encoder {
    ImageEncoding encoding;
    int channels;
    // 8 bit only: code k begins at threshold[k], one that never begins stands last. A float of bucket b has the code
    // bucket[b] or one of the next `steps`.
    float threshold[ENCODE_CODES_8 + 1];
    unsigned steps;
    uint8_t bucket[ENCODE_BUCKETS];
} Encoder;

void encoder_init(Encoder *encoder, const ImageEncoding *encoding, int channels);

// Encodes `pixels` pixels into samples of encode_sample_bytes each, in the machine's byte order. Alpha gets no
// transfer. NaN becomes 0.
void encoder_run(const Encoder *encoder, const float *values, size_t pixels, void *samples);

size_t encode_sample_bytes(ImageDepth depth);

// The integer code of a value of linear light at 8 or 16 bit. NaN counts as 0.
unsigned encode_code(const ImageEncoding *encoding, float linear);

#endif
