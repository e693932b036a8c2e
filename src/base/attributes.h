// Compiler attributes under short names, and the guards that the numerics rely on.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_ATTRIBUTES_H
#define BASE_ATTRIBUTES_H

#ifdef __FAST_MATH__
#error "rtlang's error bounds do not hold under -ffast-math"
#endif

#define RT_MUST_CHECK                  __attribute__((warn_unused_result))
#define RT_PRINTF(format_at, first_at) __attribute__((format(printf, format_at, first_at)))
#define RT_ALWAYS_INLINE               static inline __attribute__((always_inline))
#define RT_SELDOM                      static __attribute__((noinline, cold, unused))
#define RT_LIKELY(condition)           __builtin_expect(!!(condition), 1)
#define RT_UNLIKELY(condition)         __builtin_expect(!!(condition), 0)
#define RT_COUNT_OF(array)             (sizeof(array) / sizeof((array)[0]))

#endif
