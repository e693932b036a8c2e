// The canonical layout of a scene: text in, the same tokens and comments out, laid out in one way.
//
// It works on tokens and the comments between them, never on syntax, so any text whose tokens read has a layout: macro
// bodies, blocks that are split by directives, constructs that rtlang does not have. The rules stand in
// docs/language.md, "Layout". Layout of a layout is the same text, byte for byte.
//
// SPDX-License-Identifier: MIT
#ifndef FORMAT_FORMAT_H
#define FORMAT_FORMAT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/text.h"
#include "grammar/grammar.h"

// Appends the layout of `source`, whose bytes are `text`, to `out`. False when the text is faulty or memory ran out,
// which is reported, or when `cancel` has become true; what `out` then holds means nothing.
bool format_source(const GrammarContext *context, Source *source, const char *text, size_t length,
                   const atomic_bool *cancel, TextBuffer *out) RT_MUST_CHECK;

#endif
