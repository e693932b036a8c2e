// The text of functions and splines, shared by the files that make, compile and call them.
//
//   function.c       `function (a, b) { … }` and its parameters      function_body.c  the body to a tree of nodes
//   spline_block.c   `spline { … }`                                  callable.c       calls inside expressions
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_RUN_CALLABLE_H
#define EVAL_RUN_CALLABLE_H

#include "eval/run/run.h"
#include "eval/values/function.h"

// ---- bodies

// A body while it is compiled. u and v are called x and y here.
typedef struct FunctionBody {
    Eval *ev;
    Symbol names[FUNCTION_SLOTS_MAX]; // of the slots
    unsigned count;
    const char *unsupported; // what rtlang has not, or NULL
    bool keeps_numbers;      // numbers in a chain of operators are not joined where this is set
} FunctionBody;

Symbol function_slot_name(Symbol symbol);
// What a name of a function's text stood for when it was read; NULL: nothing.
const Value *function_meaning(const Eval *ev, const AstNode *name);
// NULL when a fault was reported.
const FunctionNode *function_compile(FunctionBody *body, const AstNode *node);
// ---- calls

// What a CALL node names: an element of an array or an identifier. NULL when the identifier is not declared, or when a
// fault in the element was reported.
const Value *call_callee(Eval *ev, const AstNode *call);
bool call_is_of_element(const AstNode *call);
// Reports that what an identifier stands for cannot be called; NULL: it is not declared.
void call_fault_callee(Eval *ev, const AstNode *call, const Value *callee);
// False, with a fault, when a comma stands after the last argument.
bool call_ends_well(Eval *ev, const AstNode *call) RT_MUST_CHECK;
// Reports a wrong number of arguments; returns false.
bool call_fault_count(Eval *ev, const AstNode *call, const char *what, unsigned wanted);

#endif
