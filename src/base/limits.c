// Limits: how exhausted memory is reported, and numbers of bytes for people.
//
// Owns nothing and counts nothing: each limit is kept where the thing is counted.
//
// SPDX-License-Identifier: MIT
#include "base/limits.h"

#include <stdio.h>

void limits_bytes_text(uint64_t bytes, char text[LIMITS_BYTES_TEXT])
{
    static const char *const units[] = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
    double number = (double)bytes / 1024.0;
    size_t unit = 0;
    if (bytes < 10000) {
        snprintf(text, LIMITS_BYTES_TEXT, "%u bytes", (unsigned)bytes);
        return;
    }
    for (; number >= 999.5; number /= 1024.0) {
        unit++;
    }
    snprintf(text, LIMITS_BYTES_TEXT, "%.3g %s", number, units[unit]);
}

size_t limits_memory(const Limits *limits, uint64_t text_bytes)
{
    uint64_t room = limits->memory_most > limits->memory_bytes ? limits->memory_most - limits->memory_bytes : 0;
    uint64_t per_text = limits->memory_per_text;
    bool is_all = per_text > 0 && text_bytes > room / per_text;
    return limits->memory_bytes > limits->memory_most ? limits->memory_most
           : is_all                                   ? limits->memory_most
                                                      : limits->memory_bytes + (size_t)(text_bytes * per_text);
}

bool limits_report_memory(DiagSink *sink, Span span, const MemoryBudget *budget, const char *doing)
{
    char limit[LIMITS_BYTES_TEXT];
    if (!budget || !budget->refused) {
        return diag_report(sink, DIAG_E0602, span, "out of memory while %s", doing);
    }
    limits_bytes_text(budget->limit, limit);
    bool kept = diag_report(sink, DIAG_E0607, span, "%s takes more than %s of memory", doing, limit);
    if (kept) {
        diag_suggest(sink, "`--max-memory` allows more");
    }
    return kept;
}
