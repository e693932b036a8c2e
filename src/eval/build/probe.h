// What trace and inside share with the rest of the evaluator.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_PROBE_H
#define EVAL_PROBE_H

#include "eval/run/run.h"

typedef struct Probe Probe;

bool builtin_trace(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
bool builtin_inside(Eval *ev, const AstNode *node, Value *value) RT_MUST_CHECK;
void probes_fini(Eval *ev);

#endif
