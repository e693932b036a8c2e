// Limits: how an exhausted memory is told, and numbers of bytes for people.
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

bool limits_report_memory(DiagSink *sink, Span span, const MemoryBudget *budget, const char *doing)
{
    char limit[LIMITS_BYTES_TEXT];
    if (budget == NULL || !budget->refused) {
        return diag_report(sink, DIAG_E0602, span, "out of memory while %s", doing);
    }
    limits_bytes_text(budget->limit, limit);
    bool kept = diag_report(sink, DIAG_E0607, span, "%s takes more than %s of memory", doing, limit);
    if (kept) {
        diag_suggest(sink, "`--max-memory` allows more");
    }
    return kept;
}
