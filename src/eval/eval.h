// The evaluator: AST items become scene records.
//
// eval_source parses a scene through grammar's facade, one top-level item at a time, runs its directives, computes its
// expressions and adds cameras, lights and shapes to a Scene. The language is pure: only scene text is read, nothing is
// written or run. Faults are recorded where they are found; evaluation continues to find more.
// Knows nothing of rays or pictures.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_EVAL_H
#define EVAL_EVAL_H

#include "eval/state/options.h"

// Evaluates the source into the scene, which is initialised; what it holds already stays. False when a fault was
// reported; the scene then holds what could be made of it.
bool eval_source(const EvalOptions *options, Source *source, Scene *scene) RT_MUST_CHECK;

#endif
