// Patterns and pigments as the evaluator sees them, for functions made of them.
//
// SPDX-License-Identifier: MIT
#ifndef API_PAINTER_H
#define API_PAINTER_H

#include "eval/eval.h"

extern const EvalPainter painter;

#endif
