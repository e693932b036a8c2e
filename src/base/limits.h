// Limits: how far one scene may go before a located message stops it. All are passed in, so that each stage can be
// called with its own; the defaults are chosen to be far beyond real scenes and well inside the machine.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_LIMITS_H
#define BASE_LIMITS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/diag.h"

enum {
    TRACE_LEVEL_MAX = 256,     // the language's own limit of max_trace_level
    LIMIT_DEPTH_MAX = 1000,    // greatest `ast_depth`: what the stack of a thread bears
    LIMIT_INCLUDE_DEPTH = 31,  // POV-Ray refuses 32
    LIMIT_CALL_DEPTH = 98,     // POV-Ray refuses 99
};

typedef struct Limits {
    unsigned ast_depth;     // nesting of expressions and blocks
    unsigned include_depth; // nesting of #include
    unsigned call_depth;    // nesting of macro calls
    uint64_t steps;         // loop turns and calls, by how long their text is, and work on strings, all together
    uint64_t message_bytes; // text of #debug and its like, all together
    size_t string_bytes;    // of one string
    uint64_t objects;       // shapes in the scene
    uint64_t text_bytes;    // bytes of scene text and data files, all together
    size_t memory_bytes;    // what is read, declared and prepared, together
    size_t memory_per_text; // more of it for each byte of the scene's text
    size_t memory_most;     // the same and the picture: no more than this
} Limits;

#define LIMITS_DEFAULT                                                                                                 \
    ((Limits){                                                                                                         \
        .ast_depth = LIMIT_DEPTH_MAX,                                                                                  \
        .include_depth = LIMIT_INCLUDE_DEPTH,                                                                          \
        .call_depth = LIMIT_CALL_DEPTH,                                                                                \
        .steps = 30u * 1000 * 1000,                                                                                    \
        .message_bytes = 16u << 20,                                                                                    \
        .string_bytes = 64u << 20,                                                                                     \
        .objects = 1000u * 1000 * 1000,                                                                                \
        .text_bytes = (uint64_t)64 << 30,                                                                              \
        .memory_bytes = (size_t)1 << 30,                                                                               \
        .memory_per_text = 16,                                                                                         \
        .memory_most = (size_t)8 << 30,                                                                                \
    })

// What a scene of so much text may take, so that a short text cannot fill a machine and a long one is read whole.
size_t limits_memory(const Limits *limits, uint64_t text_bytes);

// Reports at the span that memory is exhausted while doing something ("reading the scene"): the system's, E0602, or
// what the budget allows, E0607. True when the record was kept.
bool limits_report_memory(DiagSink *sink, Span span, const MemoryBudget *budget, const char *doing);

// Bytes for people: "512 bytes", "1.5 MiB".
enum { LIMITS_BYTES_TEXT = 32 };
void limits_bytes_text(uint64_t bytes, char text[LIMITS_BYTES_TEXT]);

#endif
