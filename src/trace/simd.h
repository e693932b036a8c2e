// Vectors of the native width, and the dozen things that GCC's vector types cannot say.
//
// A file that includes this is compiled once for each instruction set; what it computes must not depend on the width.
// The shims for x86-64 are single instructions, the others plain C that compilers make into such.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SIMD_H
#define TRACE_SIMD_H

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"

#ifdef __SSE2__
#include <immintrin.h>
#endif

#if defined(__AVX__)
enum { FLOATS = 8 };
#else
enum { FLOATS = 4 };
#endif

#if defined(__AVX512F__)
enum { DOUBLES = 8 };
#elif defined(__AVX__)
enum { DOUBLES = 4 };
#else
enum { DOUBLES = 2 };
#endif

typedef float Floats __attribute__((vector_size(4 * FLOATS)));
typedef double Doubles __attribute__((vector_size(8 * DOUBLES)));
typedef int32_t FloatsMask __attribute__((vector_size(4 * FLOATS)));
typedef int64_t DoublesMask __attribute__((vector_size(8 * DOUBLES)));

// Aligned to the vector's size.
RT_ALWAYS_INLINE Floats floats_load(const float *from)
{
    return *(const Floats *)from;
}

RT_ALWAYS_INLINE void floats_store(float *to, Floats a)
{
    *(Floats *)to = a;
}

RT_ALWAYS_INLINE Doubles doubles_load(const double *from)
{
    return *(const Doubles *)from;
}

RT_ALWAYS_INLINE void doubles_store(double *to, Doubles a)
{
    *(Doubles *)to = a;
}

// What is so many bytes after `from`, for each component.
RT_ALWAYS_INLINE Doubles doubles_gather(const double *from, DoublesMask bytes)
{
#if defined(__AVX512F__)
    return _mm512_i64gather_pd((__m512i)bytes, from, 1);
#elif defined(__AVX2__)
    return _mm256_i64gather_pd(from, (__m256i)bytes, 1);
#else
    Doubles gathered = {0};
    for (int i = 0; i < DOUBLES; i++) {
        double own;
        memcpy(&own, (const char *)from + bytes[i], sizeof(own));
        gathered[i] = own;
    }
    return gathered;
#endif
}

RT_ALWAYS_INLINE Floats floats_splat(float a)
{
    return a - (Floats){0};
}

RT_ALWAYS_INLINE Doubles doubles_splat(double a)
{
    return a - (Doubles){0};
}

// No component is NaN.
RT_ALWAYS_INLINE Floats floats_min(Floats a, Floats b)
{
#if defined(__AVX__)
    return _mm256_min_ps(a, b);
#elif defined(__SSE2__)
    return _mm_min_ps(a, b);
#else
    FloatsMask less = a < b;
    return (Floats)((less & (FloatsMask)a) | (~less & (FloatsMask)b));
#endif
}

RT_ALWAYS_INLINE Floats floats_max(Floats a, Floats b)
{
#if defined(__AVX__)
    return _mm256_max_ps(a, b);
#elif defined(__SSE2__)
    return _mm_max_ps(a, b);
#else
    FloatsMask more = a > b;
    return (Floats)((more & (FloatsMask)a) | (~more & (FloatsMask)b));
#endif
}

// (a - from) * by, or, where that takes one instruction and FLOATS_ARE_FUSED, a * by - from with one rounding.
#if defined(__FMA__)
enum { FLOATS_ARE_FUSED = 1 };
#else
enum { FLOATS_ARE_FUSED = 0 };
#endif

RT_ALWAYS_INLINE Floats floats_slab(Floats a, Floats from, Floats by)
{
#if defined(__FMA__)
    return _mm256_fmsub_ps(a, by, from);
#else
    return (a - from) * by;
#endif
}

// Bit i is set where a[i] <= b[i].
RT_ALWAYS_INLINE unsigned floats_le(Floats a, Floats b)
{
#if defined(__AVX512VL__)
    return _mm256_cmp_ps_mask(a, b, _CMP_LE_OQ);
#elif defined(__AVX__)
    return (unsigned)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ));
#elif defined(__SSE2__)
    return (unsigned)_mm_movemask_ps(_mm_cmple_ps(a, b));
#else
    unsigned bits = 0;
    for (int i = 0; i < FLOATS; i++) {
        bits |= (unsigned)(a[i] <= b[i]) << i;
    }
    return bits;
#endif
}

// Bit i is set where a[i] = b, of as many as FLOATS.
RT_ALWAYS_INLINE unsigned ints_equal(const uint32_t *a, uint32_t b)
{
#if defined(__AVX__)
    FloatsMask equal = *(const FloatsMask *)a == (FloatsMask){0} + (int32_t)b;
    return (unsigned)_mm256_movemask_ps((__m256)equal);
#else
    unsigned bits = 0;
    for (int i = 0; i < FLOATS; i++) {
        bits |= (unsigned)(a[i] == b) << i;
    }
    return bits;
#endif
}

// Bit i is set where a[i] >= b[i]; a NaN is not.
RT_ALWAYS_INLINE unsigned doubles_ge(Doubles a, Doubles b)
{
#if defined(__AVX512F__)
    return _mm512_cmp_pd_mask(a, b, _CMP_GE_OQ);
#elif defined(__AVX__)
    return (unsigned)_mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_GE_OQ));
#elif defined(__SSE2__)
    return (unsigned)_mm_movemask_pd(_mm_cmpge_pd(a, b));
#else
    unsigned bits = 0;
    for (int i = 0; i < DOUBLES; i++) {
        bits |= (unsigned)(a[i] >= b[i]) << i;
    }
    return bits;
#endif
}

// Bit i is set where a[i] > b[i]; a NaN is not.
RT_ALWAYS_INLINE unsigned doubles_gt(Doubles a, Doubles b)
{
    return doubles_ge(a, b) & ~doubles_ge(b, a);
}

RT_ALWAYS_INLINE Doubles doubles_sqrt(Doubles a)
{
#if defined(__AVX512F__)
    return _mm512_sqrt_pd(a);
#elif defined(__AVX__)
    return _mm256_sqrt_pd(a);
#elif defined(__SSE2__)
    return _mm_sqrt_pd(a);
#else
    for (int i = 0; i < DOUBLES; i++) {
        a[i] = sqrt(a[i]);
    }
    return a;
#endif
}

// No component is NaN.
RT_ALWAYS_INLINE Doubles doubles_min(Doubles a, Doubles b)
{
#if defined(__AVX512F__)
    return _mm512_min_pd(a, b);
#elif defined(__AVX__)
    return _mm256_min_pd(a, b);
#elif defined(__SSE2__)
    return _mm_min_pd(a, b);
#else
    DoublesMask less = a < b;
    return (Doubles)((less & (DoublesMask)a) | (~less & (DoublesMask)b));
#endif
}

RT_ALWAYS_INLINE Doubles doubles_max(Doubles a, Doubles b)
{
#if defined(__AVX512F__)
    return _mm512_max_pd(a, b);
#elif defined(__AVX__)
    return _mm256_max_pd(a, b);
#elif defined(__SSE2__)
    return _mm_max_pd(a, b);
#else
    return -doubles_min(-a, -b);
#endif
}

// The least component; none is NaN.
RT_ALWAYS_INLINE double doubles_least(Doubles a)
{
#if defined(__AVX512F__)
    a = doubles_min(a, __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3));
    a = doubles_min(a, __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5));
    a = doubles_min(a, __builtin_shufflevector(a, a, 1, 0, 3, 2, 5, 4, 7, 6));
    return a[0];
#else
    double least = a[0];
    for (int i = 1; i < DOUBLES; i++) {
        least = a[i] < least ? a[i] : least;
    }
    return least;
#endif
}

RT_ALWAYS_INLINE double doubles_greatest(Doubles a)
{
    return -doubles_least(-a);
}

// Bit i is set where mask[i] is, each being 0 or -1.
RT_ALWAYS_INLINE unsigned doubles_mask_bits(DoublesMask mask)
{
#if defined(__AVX512DQ__)
    return _mm512_movepi64_mask((__m512i)mask);
#elif defined(__AVX__) && !defined(__AVX512F__)
    return (unsigned)_mm256_movemask_pd((__m256d)mask);
#elif defined(__SSE2__) && !defined(__AVX__)
    return (unsigned)_mm_movemask_pd((__m128d)mask);
#else
    unsigned bits = 0;
    for (int i = 0; i < DOUBLES; i++) {
        bits |= (unsigned)(mask[i] & 1) << i;
    }
    return bits;
#endif
}

// The bits as a mask, as many as a vector has components.
RT_ALWAYS_INLINE DoublesMask doubles_bits_mask(uint64_t bits)
{
    DoublesMask own = {0};
    for (int k = 0; k < DOUBLES; k++) {
        own[k] = 1 << k;
    }
    return (((DoublesMask){0} + (int64_t)bits) & own) != 0;
}

RT_ALWAYS_INLINE Doubles doubles_abs(Doubles a)
{
    return (Doubles)((DoublesMask)a & INT64_MAX);
}

// The size of a with the sign of b.
RT_ALWAYS_INLINE Doubles doubles_copysign(Doubles a, Doubles b)
{
    return (Doubles)(((DoublesMask)a & INT64_MAX) | ((DoublesMask)b & INT64_MIN));
}

#if defined(__FMA__) || defined(__ARM_FEATURE_FMA)
// a b - c of each, with one rounding.
RT_ALWAYS_INLINE Doubles doubles_fused(Doubles a, Doubles b, Doubles c)
{
#if defined(__AVX512F__)
    return _mm512_fmsub_pd(a, b, c);
#elif defined(__FMA__)
    return _mm256_fmsub_pd(a, b, c);
#else
    for (int i = 0; i < DOUBLES; i++) {
        a[i] = __builtin_fma(a[i], b[i], -c[i]);
    }
    return a;
#endif
}
#endif

// a where the mask is set, else b.
RT_ALWAYS_INLINE Doubles doubles_choose(DoublesMask mask, Doubles a, Doubles b)
{
    return (Doubles)((mask & (DoublesMask)a) | (~mask & (DoublesMask)b));
}

// a where the bit is set, else b.
RT_ALWAYS_INLINE Doubles doubles_choose_bits(unsigned bits, Doubles a, Doubles b)
{
#if defined(__AVX512F__)
    return _mm512_mask_blend_pd((__mmask8)bits, b, a);
#else
    return doubles_choose(doubles_bits_mask(bits), a, b);
#endif
}

// a where x < 0 or NaN with its sign bit set, else b.
RT_ALWAYS_INLINE Doubles doubles_if_negative(Doubles x, Doubles a, Doubles b)
{
    DoublesMask negative = (DoublesMask)x >> 63;
    return (Doubles)((negative & (DoublesMask)a) | (~negative & (DoublesMask)b));
}

#endif
