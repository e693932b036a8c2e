// SPDX-License-Identifier: MIT
#include "scene/room.h"

void scene_report_full(const Limits *limits, DiagSink *diags, Span span)
{
    if (diag_report(diags, DIAG_E0490, span, "more than %llu shapes in the scene",
                    (unsigned long long)limits->objects)) {
        diag_suggest(diags, "`--max-objects` allows more");
    }
}
