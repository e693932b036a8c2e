// Functions of patterns and pigments: what they share with the rest of the evaluator.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_PAINTED_H
#define EVAL_PAINTED_H

#include "eval/run/run.h"

// A pattern or a pigment that is a function, in the program's memory.
typedef struct Painted Painted;

// Of a `pattern { … }` or `pigment { … }` block; what has a word that is not supported has none and gives the word. False
// when a fault was reported.
bool painted_create(Eval *ev, const AstNode *block, Painted **painted, const char **unsupported) RT_MUST_CHECK;
// The pattern's value, or the five parts of the pigment's colour, at a point. False when evaluation must stop.
bool painted_at(Eval *ev, Painted *painted, const double point[3], Span span, double v[5]) RT_MUST_CHECK;
// The same as a record of a scene.
bool painted_place(Eval *ev, Scene *scene, const Painted *painted, Span span, Pigment *pigment) RT_MUST_CHECK;
void painted_fini(Eval *ev);

#endif
