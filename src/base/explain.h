// Explanations: what is reported at length of each diagnostic code, for the terminal and for docs/diagnostics.md.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_EXPLAIN_H
#define BASE_EXPLAIN_H

#include "base/diag.h"
#include "base/text.h"

// The code that a text such as "E0201" or "e0201" names. False when there is none.
bool explain_find(const char *name, DiagCode *code) RT_MUST_CHECK;

// Code, meaning, severity, exit code, a small wrong example with its correction where there is one, and a paragraph, in
// lines of at most 80 columns where no example is longer.
void explain_write(DiagCode code, TextBuffer *out);

// All codes as Markdown, in groups by their first digit.
void explain_write_reference(TextBuffer *out);

#endif
