// The samplers. Everything is hashing of 32-bit words; no state, no tables that change.
//
// SPDX-License-Identifier: MIT
#include "render/points/sampler.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/attributes.h"
#include "base/isa.h"
#include "render/points/sampler_many.h"
#include "render/points/sobol.h"

const char *sampler_name(SamplerKind kind)
{
    static const char *const names[] = {[SAMPLER_SOBOL] = "sobol",
                                        [SAMPLER_HALTON] = "halton",
                                        [SAMPLER_JITTERED] = "jittered",
                                        [SAMPLER_GRID] = "grid",
                                        [SAMPLER_RANDOM] = "random"};
    return kind < SAMPLER_COUNT ? names[kind] : NULL;
}

uint32_t sampler_pixel_seed(uint64_t seed, uint32_t x, uint32_t y)
{
    return sample_hash_add(sample_hash_add(sample_hash_add(sample_hash((uint32_t)seed), (uint32_t)(seed >> 32)), x), y);
}

// Owen's scrambling of a fraction of 2^32 whose bits are given in reverse: each bit is flipped by chance that depends
// on the bits above it.
static inline uint32_t owen_scramble_reversed(uint32_t reversed, uint32_t seed)
{
    PERMUTE_UPWARD(reversed, seed);
    return reverse_bits(reversed);
}

// ---- Sobol

// Joe and Kuo's numbers for the first two dimensions are bit reversal and Pascal's triangle modulo 2. The latter is a
// product of five shifts: entry (i, j), C(j, i) mod 2, is 1 where the bits of i are among those of j (Lucas), bit by
// bit. Here the bits of both values are left in reverse, as scrambling wants them.
static inline uint32_t sobol_reversed(uint32_t index, unsigned dimension)
{
    uint32_t x = index;
    if (dimension == 1) {
        PASCAL_TRIANGLE(x);
    }
    return x;
}

uint32_t sobol_value(uint32_t index, unsigned dimension)
{
    return reverse_bits(sobol_reversed(index, dimension));
}

// Another order of the points: the index times a matrix over the field of two numbers, of whose columns only these are
// not those of the identity. It is triangular, so first parts whose number is a power of two are the same points.
// Points in both orders together are spread in four dimensions: of the first 2^m each box of volume 2^(t-m) whose sides
// are powers of two has 2^t, where t is 1 up to m = 4, 2 up to 7 and 3 up to 11. Found by a search, column after
// column, for the fewest boxes that break this.
static uint32_t other_order(uint32_t index)
{
    uint32_t low = 0;
    OTHER_ORDER(index, low);
    return (index & UINT32_MAX << OTHER_ORDER_BITS) ^ low;
}

// The order of the points is shuffled for two pairs at once, and for different ones on its own, which are independent
// then; a first part whose number is a power of two stays a net.
static SamplePoint sobol_point(uint32_t stream_seed, uint32_t pair, uint32_t index)
{
    uint32_t seed = sample_hash_add(stream_seed, pair);
    uint32_t shuffled = owen_scramble_reversed(reverse_bits(index), sample_hash_add(stream_seed, pair & ~UINT32_C(1)));
    if (pair & 1) {
        shuffled = other_order(shuffled);
    }
    return (SamplePoint){sample_unit(owen_scramble_reversed(sobol_reversed(shuffled, 0), sample_hash_add(seed, 1))),
                         sample_unit(owen_scramble_reversed(sobol_reversed(shuffled, 1), sample_hash_add(seed, 2)))};
}

// ---- the others

// The digits of index after the point in reversed order, each shifted by an amount that depends on those before it.
static double halton_value(uint32_t index, uint32_t base, uint32_t seed)
{
    const double enough = 0x1p-32;
    double value = 0.0, place = 1.0 / base;
    for (; place > enough; index /= base, place /= base) {
        uint32_t digit = index % base;
        value += (digit + sample_hash(seed) % base) % base * place;
        seed = sample_hash_add(seed, digit);
    }
    return value;
}

// Each pair shifts digits of its own, but the order is the same in all: pairs after the first use other bases.
static SamplePoint halton_point(uint32_t seed, uint32_t index, uint32_t pair)
{
    static const uint8_t bases[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
    uint32_t first = 2 * pair % RT_COUNT_OF(bases);
    return (SamplePoint){halton_value(index, bases[first], sample_hash_add(seed, 1)),
                         halton_value(index, bases[first + 1], sample_hash_add(seed, 2))};
}

// A permutation of 0 … count - 1: A. Kensler, "Correlated multi-jittered sampling", Pixar 2013; here by walking the
// cycles of a permutation of the next power of two.
static uint32_t permute(uint32_t i, uint32_t count, uint32_t seed)
{
    uint32_t mask = count - 1;
    for (int shift = 1; shift < 32; shift *= 2) {
        mask |= mask >> shift;
    }
    do {
        i = (i + seed) & mask;
        i = i * (sample_hash(seed) | 1) & mask;
        i ^= i >> 3 & mask;
        i = (i * UINT32_C(0x85ebca6b) + sample_hash(seed ^ 1)) & mask;
        i ^= i >> 5 & mask;
        i = i * UINT32_C(0xc2b2ae35) & mask;
    } while (i >= count);
    return i;
}

// Cells in rows as square as may be; where there are more than samples, which ones stay empty is left to chance.
static SamplePoint cell_point(const SampleStream *stream, uint32_t seed)
{
    uint32_t count = stream->count > 0 ? stream->count : 1;
    uint32_t rows = (uint32_t)sqrt((double)count), columns = (count + rows - 1) / rows;
    seed = sample_hash_add(seed, stream->first);
    uint32_t cell = permute(stream->index - stream->first, rows * columns, seed);
    uint32_t chance = stream->kind == SAMPLER_GRID ? seed : sample_hash_add(seed, cell);
    double x = (cell % columns + sample_unit(sample_hash_add(chance, 3))) / columns;
    double y = (cell / columns + sample_unit(sample_hash_add(chance, 4))) / rows;
    return (SamplePoint){fmin(x, 1.0 - 0x1p-32), fmin(y, 1.0 - 0x1p-32)};
}

SamplePoint sample_next(SampleStream *stream)
{
    uint32_t pair = stream->pair++, seed = sample_hash_add(stream->seed, pair);
    switch (stream->kind) {
    case SAMPLER_SOBOL:
        return sobol_point(stream->seed, pair, stream->index);
    case SAMPLER_HALTON:
        return halton_point(seed, stream->index, pair);
    case SAMPLER_JITTERED:
    case SAMPLER_GRID:
        return cell_point(stream, seed);
    case SAMPLER_RANDOM:
    case SAMPLER_COUNT:
        break;
    }
    seed = sample_hash_add(seed, stream->index);
    return (SamplePoint){sample_unit(sample_hash_add(seed, 1)), sample_unit(sample_hash_add(seed, 2))};
}

// ---- many at once

ISA_LIST(SobolKernel, sobol_kernel_, sobol_kernels);

const SobolKernel *sobol_kernel_choose(const char *name)
{
    for (size_t i = 0; i < RT_COUNT_OF(sobol_kernels); i++) {
        if (strcmp(name, sobol_kernels[i]->name) == 0) {
            return sobol_kernels[i];
        }
    }
    return NULL;
}

void sample_next_of(const SobolKernel *kernel, SampleStream *streams, const uint8_t *which, uint32_t count, double *x,
                    double *y)
{
    uint32_t seeds[SAMPLE_STREAMS_MOST], pairs[SAMPLE_STREAMS_MOST], indices[SAMPLE_STREAMS_MOST];
    if (count == 0 || streams[which ? which[0] : 0].kind != SAMPLER_SOBOL) {
        for (uint32_t i = 0; i < count; i++) {
            SamplePoint point = sample_next(&streams[which ? which[i] : i]);
            x[i] = point.x;
            y[i] = point.y;
        }
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        SampleStream *stream = &streams[which ? which[i] : i];
        seeds[i] = stream->seed;
        pairs[i] = stream->pair++;
        indices[i] = stream->index;
    }
    for (uint32_t i = count; i % SAMPLE_WORDS_MOST != 0; i++) {
        seeds[i] = pairs[i] = indices[i] = 0;
    }
    kernel->points(seeds, pairs, indices, count, x, y);
}
