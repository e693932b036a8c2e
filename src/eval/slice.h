// The part of a scene's text that its camera, its lights, its settings and its last shapes depend on, for animations: what
// else there is need not be read again for another frame.
//
// Decides by words alone, and always for more: what has a name of what is needed in it, in whatever sense, is needed.
// Nothing is evaluated. Since shapes count in their order, all statements that make any are in the slice from the first on
// that is.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_SLICE_H
#define EVAL_SLICE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "base/text.h"

// A text that belongs to a statement: its own, or one of a file that it included.
typedef struct SliceText {
    size_t statement; // in order
    const char *text;
    size_t length;
} SliceText;

typedef enum SliceResult { SLICE_MADE, SLICE_NONE, SLICE_NO_MEMORY } SliceResult;

// `texts` are in the order of their statements, of which each has its own text first; those after it are not repeated in the
// slice. `varying` are the names that differ from frame to frame, the last NULL. `shapes`: how many the scene
// had when each statement began, and in the end. *kept: how many of them the slice does not make again; *at: where in it what
// makes the others begins, its end if nothing does. SLICE_NONE: the whole text may depend on them.
SliceResult slice_make(const SliceText *texts, size_t count, const uint32_t *shapes, const char *const *varying,
                       TextBuffer *out, uint32_t *kept, size_t *at) RT_MUST_CHECK;

#endif
