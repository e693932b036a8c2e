// The hashing and the products of matrices that Sobol points are made of: of one word, or of each of some.
//
// For sampler.c and sampler_kernel.c, which make the same points one by one and many at once.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_POINTS_SOBOL_H
#define RENDER_POINTS_SOBOL_H

#include <stdint.h>

#include "base/attributes.h"

// Chosen for its even bits by C. Wellons, "Prospecting for hash functions", 2018 (lowbias32).
#define SAMPLE_HASH(x)                                                                                                 \
    do {                                                                                                               \
        (x) = ((x) ^ ((x) >> 16)) * UINT32_C(0x7feb352d);                                                              \
        (x) = ((x) ^ ((x) >> 15)) * UINT32_C(0x846ca68b);                                                              \
        (x) ^= (x) >> 16;                                                                                              \
    } while (0)

static inline uint32_t sample_hash(uint32_t x)
{
    SAMPLE_HASH(x);
    return x;
}

RT_ALWAYS_INLINE uint32_t sample_hash_add(uint32_t seed, uint32_t value)
{
    return sample_hash(seed ^ (sample_hash(value) + UINT32_C(0x9e3779b9) + (seed << 6) + (seed >> 2)));
}

static inline double sample_unit(uint32_t bits)
{
    return bits * 0x1p-32;
}

static inline uint32_t reverse_bits(uint32_t x)
{
    x = __builtin_bswap32(x);
    x = (x >> 4 & UINT32_C(0x0f0f0f0f)) | (x & UINT32_C(0x0f0f0f0f)) << 4;
    x = (x >> 2 & UINT32_C(0x33333333)) | (x & UINT32_C(0x33333333)) << 2;
    return (x >> 1 & UINT32_C(0x55555555)) | (x & UINT32_C(0x55555555)) << 1;
}

// A permutation in which each bit depends on those below it only: Laine and Karras, with Burley's constants. Of one
// word, or of each of some.
#define PERMUTE_UPWARD(x, seed)                                                                                        \
    do {                                                                                                               \
        (x) += (seed);                                                                                                 \
        (x) ^= (x) * UINT32_C(0x6c50b47c);                                                                             \
        (x) ^= (x) * UINT32_C(0xb82f1e52);                                                                             \
        (x) ^= (x) * UINT32_C(0xc7afe638);                                                                             \
        (x) ^= (x) * UINT32_C(0x8d22f6e6);                                                                             \
    } while (0)

// The other product of matrices that Sobol's numbers need; see sobol_reversed.
#define PASCAL_TRIANGLE(x)                                                                                             \
    do {                                                                                                               \
        (x) ^= (x) >> 16;                                                                                              \
        (x) ^= (x) >> 8 & UINT32_C(0x00ff00ff);                                                                        \
        (x) ^= (x) >> 4 & UINT32_C(0x0f0f0f0f);                                                                        \
        (x) ^= (x) >> 2 & UINT32_C(0x33333333);                                                                        \
        (x) ^= (x) >> 1 & UINT32_C(0x55555555);                                                                        \
    } while (0)

// The other order's matrix, column by column: adds those of the index' low bits to `low`.
enum { OTHER_ORDER_BITS = 14 };
#define OTHER_ORDER(index, low)                                                                                        \
    do {                                                                                                               \
        static const uint16_t other_columns[OTHER_ORDER_BITS] = {0x0001, 0x0003, 0x0004, 0x000d, 0x0016,               \
                                                                 0x002e, 0x004b, 0x00f1, 0x01af, 0x03ec,               \
                                                                 0x0779, 0x0b1e, 0x1858, 0x20ff};                      \
        for (int other_bit = 0; other_bit < OTHER_ORDER_BITS; other_bit++) {                                           \
            (low) ^= (0 - ((index) >> other_bit & 1)) & (uint32_t)other_columns[other_bit];                            \
        }                                                                                                              \
    } while (0)

#endif
