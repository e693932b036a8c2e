// Characters of strings: codes from 0 to 65535, as POV-Ray's are.
//
// A string keeps them in UTF-8, surrogates too; a byte that is no UTF-8 is a character by itself. What text of a scene
// means depends on the settings' `charset`. Owns nothing.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_CHARACTERS_H
#define EVAL_CHARACTERS_H

#include "eval/values/values.h"

// Whether text is UTF-8: `charset utf8`, or a mark at its begin and no `charset`.
bool characters_are_utf8(const Eval *ev);

// The code of the character at `text`, which is before `end`, and how many bytes it takes.
unsigned character_at(const char *text, const char *end, size_t *bytes);
size_t characters_count(const char *text, size_t length);
// Where character number `index` begins; `length` for the one behind the last.
size_t characters_offset(const char *text, size_t length, size_t index);

// The string that text of a scene or of a data file stands for. False when a fault was reported.
bool characters_of_text(Eval *ev, const char *text, size_t length, Span span, Value *value) RT_MUST_CHECK;

#endif
