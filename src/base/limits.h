// Limits: how far one scene may go before a located message stops it. All are passed in, so that each stage can be
// called with its own; the defaults are chosen to be far beyond real scenes and well inside the machine.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_LIMITS_H
#define BASE_LIMITS_H

#include <stddef.h>
#include <stdint.h>

enum { TRACE_LEVEL_MAX = 256 }; // the language's own limit of max_trace_level

typedef struct Limits {
    unsigned ast_depth;     // nesting of expressions and blocks
    unsigned include_depth; // nesting of #include; POV-Ray refuses 32
    unsigned call_depth;    // nesting of macro calls; POV-Ray refuses 99
    uint64_t steps;         // loop turns and macro calls, all together
    uint64_t objects;       // shapes in the scene
    uint64_t text_bytes;    // bytes of scene text, all files together
    size_t arena_bytes;     // memory of each arena
} Limits;

#define LIMITS_DEFAULT                                                                                                 \
    ((Limits){                                                                                                         \
        .ast_depth = 1000,                                                                                             \
        .include_depth = 31,                                                                                           \
        .call_depth = 98,                                                                                              \
        .steps = 30u * 1000 * 1000,                                                                                    \
        .objects = 1000u * 1000 * 1000,                                                                                \
        .text_bytes = (uint64_t)64 << 30,                                                                              \
        .arena_bytes = (size_t)8 << 30,                                                                                \
    })

#endif
