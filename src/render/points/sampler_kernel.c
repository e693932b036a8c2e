// Sobol points, some at once: compiled once for each instruction set, with ISA_NAME the name of the table.
//
// Shifts, products and sums are those of single words, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#include <stdbool.h>
#include <string.h>

#include "base/isa.h"
#include "render/points/sampler_many.h"
#include "render/points/sobol.h"

#ifdef __AVX2__
enum { WORDS = 8 };
#else
enum { WORDS = 4 };
#endif
enum { PART = 4 };
_Static_assert((int)WORDS <= (int)SAMPLE_WORDS_MOST, "there is room for a step");

typedef uint32_t Words __attribute__((vector_size(4 * WORDS)));
typedef int32_t PartWords __attribute__((vector_size(4 * PART)));
typedef double PartNumbers __attribute__((vector_size(8 * PART)));

RT_ALWAYS_INLINE Words words_reverse_bits(Words x)
{
    x = x >> 16 | x << 16;
    x = (x >> 8 & UINT32_C(0x00ff00ff)) | (x & UINT32_C(0x00ff00ff)) << 8;
    x = (x >> 4 & UINT32_C(0x0f0f0f0f)) | (x & UINT32_C(0x0f0f0f0f)) << 4;
    x = (x >> 2 & UINT32_C(0x33333333)) | (x & UINT32_C(0x33333333)) << 2;
    return (x >> 1 & UINT32_C(0x55555555)) | (x & UINT32_C(0x55555555)) << 1;
}

RT_ALWAYS_INLINE Words words_scramble_reversed(Words x, Words seed)
{
    PERMUTE_UPWARD(x, seed);
    return words_reverse_bits(x);
}

// As sample_unit: there are instructions for words with a sign only.
RT_ALWAYS_INLINE void put_units(double *to, Words words)
{
    words ^= UINT32_C(0x80000000);
    for (int i = 0; i < WORDS; i += PART) {
        PartWords part;
        memcpy(&part, (const char *)&words + sizeof part * (size_t)(i / PART), sizeof part);
        PartNumbers units = (__builtin_convertvector(part, PartNumbers) + 0x1p31) * 0x1p-32;
        memcpy(to + i, &units, sizeof units);
    }
}

RT_ALWAYS_INLINE Words words_hash(Words x)
{
    SAMPLE_HASH(x);
    return x;
}

RT_ALWAYS_INLINE Words words_hash_add(Words seed, Words value)
{
    return words_hash(seed ^ (words_hash(value) + UINT32_C(0x9e3779b9) + (seed << 6) + (seed >> 2)));
}

RT_ALWAYS_INLINE Words words_load(const uint32_t *from)
{
    Words words;
    memcpy(&words, from, sizeof words);
    return words;
}

// sobol_point of each; `has_seconds` when some pairs are odd.
RT_ALWAYS_INLINE void points_of(bool has_seconds, const uint32_t *seeds, const uint32_t *pairs, const uint32_t *indices,
                                uint32_t count, double *x, double *y)
{
    const Words none = {0};
    for (uint32_t i = 0; i < count; i += WORDS) {
        Words stream_seed = words_load(seeds + i), pair = words_load(pairs + i), index = words_load(indices + i);
        Words seed = words_hash_add(stream_seed, pair);
        Words order = has_seconds ? words_hash_add(stream_seed, pair & ~UINT32_C(1)) : seed;
        Words shuffled = words_scramble_reversed(words_reverse_bits(index), order);
        if (has_seconds) {
            Words low = none, is_second = none - (pair & 1);
            OTHER_ORDER(shuffled, low);
            shuffled = (is_second & ((shuffled & UINT32_MAX << OTHER_ORDER_BITS) ^ low)) | (~is_second & shuffled);
        }
        put_units(x + i, words_scramble_reversed(shuffled, words_hash_add(seed, none + 1)));
        PASCAL_TRIANGLE(shuffled);
        put_units(y + i, words_scramble_reversed(shuffled, words_hash_add(seed, none + 2)));
    }
}

static void points(const uint32_t *seeds, const uint32_t *pairs, const uint32_t *indices, uint32_t count, double *x,
                   double *y)
{
    uint32_t all = 0;
    for (uint32_t i = 0; i < count; i++) {
        all |= pairs[i];
    }
    if (all & 1) {
        points_of(true, seeds, pairs, indices, count, x, y);
    } else {
        points_of(false, seeds, pairs, indices, count, x, y);
    }
}

extern const SobolKernel ISA_NAMED(sobol_kernel_);
const SobolKernel ISA_NAMED(sobol_kernel_) = {ISA_TEXT, points};
