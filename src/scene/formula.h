// Functions as patterns and shapes see them: steps that compute one number of a point.
//
// A formula is a list of steps in the order in which they are done, each known by its first step. A step takes numbers
// from the top of a stack and puts one there. Plain data without padding, kept once where equal.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_FORMULA_H
#define SCENE_FORMULA_H

#include <stdint.h>

#include "math/noise.h"

typedef enum FormulaOp {
    FORMULA_NUMBER, // puts `number`
    FORMULA_SLOT,   // puts argument `which`
    // Of two; comparisons, `and` and `or` give 1 or 0.
    FORMULA_ADD,
    FORMULA_SUB,
    FORMULA_MUL,
    FORMULA_DIV,
    FORMULA_EQ,
    FORMULA_NE,
    FORMULA_LT,
    FORMULA_LE,
    FORMULA_GT,
    FORMULA_GE,
    FORMULA_AND,
    FORMULA_OR,
    FORMULA_ATAN2,
    FORMULA_POW,
    FORMULA_MOD,
    FORMULA_QUOTIENT, // whole
    FORMULA_MIN,
    FORMULA_MAX,
    // Of one.
    FORMULA_NEG,
    FORMULA_ABS,
    FORMULA_SIN,
    FORMULA_COS,
    FORMULA_TAN,
    FORMULA_ASIN,
    FORMULA_ACOS,
    FORMULA_ATAN,
    FORMULA_SINH,
    FORMULA_COSH,
    FORMULA_TANH,
    FORMULA_ASINH,
    FORMULA_ACOSH,
    FORMULA_ATANH,
    FORMULA_EXP,
    FORMULA_LN,
    FORMULA_LOG,
    FORMULA_SQRT,
    FORMULA_FLOOR,
    FORMULA_CEIL,
    FORMULA_INT,
    FORMULA_DEGREES,
    FORMULA_RADIANS,
    // Of more.
    FORMULA_SELECT3,
    FORMULA_SELECT4,
    FORMULA_NOISE,        // of three numbers; of the scene's generator
    FORMULA_NOISE_CHOSEN, // of four, the last one being the generator
    FORMULA_PATTERN,      // the value of Scene.patterns[which] at three numbers
    FORMULA_PIGMENT,      // its colour's component `number`, see FormulaComponent
    FORMULA_GIVEN,        // the surface of functions.inc that `which` says, of `number` arguments
    FORMULA_CALL,         // the formula that begins at `which`, of `number` arguments
    FORMULA_OPS
} FormulaOp;

// Of a colour; 0 to 4 are red to transmit.
enum { FORMULA_GRAY = 5, FORMULA_HEIGHT = 6 };

// Numbers at a time on the stack of one formula and those it calls, and steps in all that one point may take.
enum { FORMULA_STACK_MOST = 240, FORMULA_STEPS_MOST = 100000 };

typedef struct FormulaStep {
    double number;
    uint32_t op; // FormulaOp
    uint32_t which;
    uint32_t next; // the step after it, or RECORD_NONE
    uint32_t unused;
} FormulaStep;

// What FORMULA_PATTERN or FORMULA_PIGMENT gives at a point.
typedef double (*FormulaPainter)(const void *client, const FormulaStep *step, const double *point);

// What formulas are done with.
typedef struct FormulaSource {
    const FormulaStep *steps;
    const Noise *noise;       // NULL where no step asks for it
    NoiseGenerator generator; // of FORMULA_NOISE
    FormulaPainter painted;   // NULL: what is painted is no number
    const void *client;
} FormulaSource;

// What formulas of shapes find their noise and their patterns by.
typedef struct FormulaHost {
    const Noise *noise;     // NULL where no step asks for it
    FormulaPainter painted; // set by whoever can tell; NULL before
    const void *client;
} FormulaHost;

// What a shape's formulas are done with: its own steps and number of a NoiseGenerator, and what its host has, if any.
static inline FormulaSource formula_source_of(const FormulaStep *steps, double generator, const FormulaHost *host)
{
    FormulaSource source = {.steps = steps, .generator = (NoiseGenerator)generator};
    if (host) {
        source.noise = host->noise;
        source.painted = host->painted;
        source.client = host->client;
    }
    return source;
}

// What FORMULA_PIGMENT makes of a colour: red, green, blue, filter and transmit.
double formula_component(const FormulaStep *step, const double v[5]);

// What the formula that begins with a step gives is put at `top`, where there is room for FORMULA_STACK_MOST numbers.
void formula_run(const FormulaSource *source, uint32_t first, const double *slots, double *top);

#endif
