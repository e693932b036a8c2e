// Tables of functions that are compiled once for each instruction set, and how they are named.
//
// A file of such functions is compiled with ISA_NAME the name of the set: plain, v2, v3 or v4. Its table is named
// ISA_NAMED(prefix), and ISA_LIST(Type, prefix, list) makes a list of all of them, from plain to best, whether this
// processor has them or not.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_ISA_H
#define BASE_ISA_H

#include <stdbool.h>

#define ISA_TEXT_(name)       #name
#define ISA_TEXT_OF_(name)    ISA_TEXT_(name)
#define ISA_JOINED_(a, b)     a##b
#define ISA_JOINED_OF_(a, b)  ISA_JOINED_(a, b)

// Of the file that is being compiled: the set's name as text, and a name that ends with it.
#define ISA_TEXT          ISA_TEXT_OF_(ISA_NAME)
#define ISA_NAMED(prefix) ISA_JOINED_OF_(prefix, ISA_NAME)

// Whether this processor has what the compiler was allowed to use in this file. Asked feature by feature: clang before 17
// does not know the levels by their names. Processors with these have the rest of their level, too.
static inline bool isa_is_supported(void)
{
#ifdef __SSE4_2__
    if (!__builtin_cpu_supports("sse4.2") || !__builtin_cpu_supports("popcnt")) {
        return false;
    }
#endif
#ifdef __AVX2__
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2") || !__builtin_cpu_supports("fma")) {
        return false;
    }
#endif
#ifdef __AVX512VL__
    if (!__builtin_cpu_supports("avx512bw") || !__builtin_cpu_supports("avx512cd") ||
        !__builtin_cpu_supports("avx512dq") || !__builtin_cpu_supports("avx512vl")) {
        return false;
    }
#endif
    return true;
}

#ifdef __x86_64__
#define ISA_LIST(Type, prefix, list)                                                                                   \
    extern const Type prefix##plain, prefix##v2, prefix##v3, prefix##v4;                                               \
    static const Type *const list[] = {&prefix##plain, &prefix##v2, &prefix##v3, &prefix##v4}
#else
#define ISA_LIST(Type, prefix, list)                                                                                   \
    extern const Type prefix##plain;                                                                                   \
    static const Type *const list[] = {&prefix##plain}
#endif

#endif
