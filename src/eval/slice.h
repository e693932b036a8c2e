// The part of a scene's text that its camera, its lights and its settings depend on, for animations: what else there is
// need not be read again for another frame.
//
// Decides by words alone, and always for more: what has a name of what is needed in it, in whatever sense, is needed.
// Nothing is evaluated. What the slice leaves open is for the caller to check: it must hold no shapes.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_SLICE_H
#define EVAL_SLICE_H

#include <stdbool.h>
#include <stddef.h>

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
// slice. `varying` are the names that differ from frame to frame, the last NULL. SLICE_NONE: the whole text may depend on them.
SliceResult slice_make(const SliceText *texts, size_t count, const char *const *varying, TextBuffer *out) RT_MUST_CHECK;

#endif
