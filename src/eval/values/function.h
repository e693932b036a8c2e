// Functions and splines as values.
//
//   function_run.c   what each node of a body computes               function_given.c what `internal(n)` stands for
//   spline.c         the curve of a spline
//
// Text becomes one of them by the files of run/callable.h.
//
// A function's body is a language of its own: numbers only, names of numbers taken at the declaration, exact
// comparisons, `&` before `|`. Everything lives in the program arena and never changes.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_VALUES_FUNCTION_H
#define EVAL_VALUES_FUNCTION_H

#include "eval/values/values.h"
#include "math/transform.h"

// ---- splines

typedef enum SplineType { SPLINE_LINEAR, SPLINE_QUADRATIC, SPLINE_CUBIC, SPLINE_NATURAL } SplineType;

typedef struct SplinePoint {
    double t;
    double v[5];
    double bend[5]; // second derivatives of the natural spline through all points
} SplinePoint;

struct Spline {
    SplineType type;
    unsigned components; // of the widest point, 2 to 5
    unsigned count;      // at least 1
    const SplinePoint *points; // t rises strictly
};

// The type that a word names; false when it names none.
bool spline_type(Word word, SplineType *type);
// Fills in the second derivatives of points in rising order; `pivots` is room for as many numbers.
void spline_bend(SplinePoint *points, unsigned count, double *pivots);
// The point at t, or the nearest valid one outside of the spline's range.
void spline_at(const Spline *spline, SplineType type, double t, double v[5]);

// ---- functions

enum { FUNCTION_SLOTS_MAX = 56 }; // parameters and variables of sums at one place, as in POV-Ray

typedef enum FunctionKind {
    FUNCTION_NUMBER,
    FUNCTION_TRANSFORM,
    FUNCTION_SPLINE,
    FUNCTION_PATTERN,
    FUNCTION_PIGMENT,
    FUNCTION_UNSUPPORTED,
} FunctionKind;

typedef struct FunctionNode FunctionNode;

// One call that is running. A scalar: one number is computed at a time.
typedef struct FunctionRun {
    Eval *ev;
    Span span;                         // of the call in the scene, for messages
    double slots[FUNCTION_SLOTS_MAX];  // parameters, then variables of sums
} FunctionRun;

typedef double (*FunctionNodeFn)(const FunctionNode *node, FunctionRun *run);

struct FunctionNode {
    FunctionNodeFn run;
    const FunctionNode *arguments; // linked by `next`
    FunctionNode *next;
    union {
        double number;
        double (*of_one)(double);
        double (*of_two)(double, double);
        const Function *function; // that is called
    };
    unsigned slot;   // of a parameter or of a sum's variable; the component of a vector function
    unsigned count;  // of arguments
    unsigned height; // of the tree below and including this node, calls counted in
    unsigned size;   // of that tree: its nodes
    bool is_constant; // no parameter, sum or product below it; see function_body.c
};

struct Function {
    FunctionKind kind;
    unsigned parameter_count;
    Span span;                // of its declaration
    const char *word;         // FUNCTION_UNSUPPORTED: what it is made of
    const FunctionNode *body; // FUNCTION_NUMBER
    const Spline *spline;     // FUNCTION_SPLINE
    Transform transform;      // FUNCTION_TRANSFORM
    Painted *painted;  // FUNCTION_PATTERN, FUNCTION_PIGMENT
};

// The node of a built-in function; false when a function's body may not hold the word. `least` and `greatest` are the
// numbers of arguments.
bool function_builtin(Word word, FunctionNode *node, unsigned *least, unsigned *greatest);
// The node of an operator between numbers.
FunctionNodeFn function_operator(AstOp op);
double function_run_number(const FunctionNode *node, FunctionRun *run);
double function_run_slot(const FunctionNode *node, FunctionRun *run);
double function_run_call(const FunctionNode *node, FunctionRun *run);
double function_run_sum(const FunctionNode *node, FunctionRun *run);
double function_run_product(const FunctionNode *node, FunctionRun *run);

// Makes a function of what `internal(n)` stands for, or one that is a fault where it is called. False when a fault was
// reported.
bool function_given(Eval *ev, const AstNode *internal, Function *function) RT_MUST_CHECK;

// Works a function that is supported out for as many arguments as it has parameters: one number, or the components of
// a vector, whose count is returned. 0 when evaluation must stop.
unsigned function_apply(Eval *ev, const Function *function, const double *arguments, Span span, double v[5]);
// How many components function_apply gives.
unsigned function_width(const Function *function);

#endif
