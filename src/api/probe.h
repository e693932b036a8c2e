// The tracer as the evaluator sees it, for `trace`.
//
// SPDX-License-Identifier: MIT
#ifndef API_PROBE_H
#define API_PROBE_H

#include "eval/eval.h"

extern const EvalTracer probe_tracer;

#endif
