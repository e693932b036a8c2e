// The one allocation of a thread that renders. Most of its pages are never touched: they are there for scenes that nest as
// deep as rays are followed.
//
// SPDX-License-Identifier: MIT
#include "render/sample/scratch.h"

#include <stdlib.h>

RenderScratch *scratch_new(void)
{
    RenderScratch *scratch = aligned_alloc(_Alignof(RenderScratch), sizeof *scratch);
    if (scratch) {
        medium_table_init(&scratch->rays.media, scratch->nodes);
    }
    return scratch;
}

void scratch_free(RenderScratch *scratch)
{
    free(scratch);
}
