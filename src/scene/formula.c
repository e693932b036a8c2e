// Formulas, done step by step on a stack of numbers.
//
// As in the evaluator nothing is checked: the functions are those of C, comparisons are exact, and a number that is not
// finite is passed on. Steps that ask a pattern or a pigment are done by whoever asks for the number. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include "scene/formula.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "math/given_surface.h"
#include "scene/scene.h"

// Where a formula is done: its arguments are `slots`.
typedef struct Place {
    const FormulaSource *source;
    const double *slots;
} Place;

static double of_one(FormulaOp op, double a)
{
    switch (op) {
    case FORMULA_NEG:
        return -a;
    case FORMULA_ABS:
        return fabs(a);
    case FORMULA_SIN:
        return sin(a);
    case FORMULA_COS:
        return cos(a);
    case FORMULA_TAN:
        return tan(a);
    case FORMULA_ASIN:
        return asin(a);
    case FORMULA_ACOS:
        return acos(a);
    case FORMULA_ATAN:
        return atan(a);
    case FORMULA_SINH:
        return sinh(a);
    case FORMULA_COSH:
        return cosh(a);
    case FORMULA_TANH:
        return tanh(a);
    case FORMULA_ASINH:
        return asinh(a);
    case FORMULA_ACOSH:
        return acosh(a);
    case FORMULA_ATANH:
        return atanh(a);
    case FORMULA_EXP:
        return exp(a);
    case FORMULA_LN:
        return log(a);
    case FORMULA_LOG:
        return log10(a);
    case FORMULA_SQRT:
        return sqrt(a);
    case FORMULA_FLOOR:
        return floor(a);
    case FORMULA_CEIL:
        return ceil(a);
    case FORMULA_INT:
        return number_to_int(a);
    case FORMULA_DEGREES:
        return number_degrees(a);
    default:
        return number_radians(a);
    }
}

static double of_two(FormulaOp op, double a, double b)
{
    switch (op) {
    case FORMULA_DIV:
        return a / b;
    case FORMULA_EQ:
        return a == b;
    case FORMULA_NE:
        return a != b;
    case FORMULA_LT:
        return a < b;
    case FORMULA_LE:
        return a <= b;
    case FORMULA_GT:
        return a > b;
    case FORMULA_GE:
        return a >= b;
    case FORMULA_AND:
        return a != 0.0 && b != 0.0;
    case FORMULA_OR:
        return a != 0.0 || b != 0.0;
    case FORMULA_ATAN2:
        return atan2(a, b);
    case FORMULA_POW:
        return pow(a, b);
    case FORMULA_MOD:
        return fmod(a, b);
    case FORMULA_QUOTIENT:
        return number_to_int(a / b);
    case FORMULA_MIN:
        return a <= b ? a : b; // where one is no number, the second, as in the evaluator
    default:
        return b > a ? b : a;
    }
}

static double select_of(const double *a, bool has_four)
{
    return a[0] < 0.0 ? a[1] : !has_four || a[0] == 0.0 ? a[2] : a[3];
}

static double noise_of(const FormulaSource *source, const double *a, NoiseGenerator generator)
{
    return noise_value(source->noise, generator, vec3(a[0], a[1], a[2]));
}

double formula_component(const FormulaStep *step, const double v[5])
{
    switch ((unsigned)step->number) {
    case FORMULA_GRAY:
        return rgb_luminance(rgb(v[0], v[1], v[2]));
    case FORMULA_HEIGHT:
        return (v[0] + v[1] / 255.0) * 0.996093; // the manual's, 2.2.2.5.4 "Pigment Functions"
    default:
        return v[(unsigned)step->number];
    }
}

// A step of more numbers than two, which stand before `top`; they become one, and so many are returned.
static unsigned of_more(const Place *place, const FormulaStep *step, double *top)
{
    switch ((FormulaOp)step->op) {
    case FORMULA_SELECT3:
        top[-3] = select_of(top - 3, false);
        return 3;
    case FORMULA_SELECT4:
        top[-4] = select_of(top - 4, true);
        return 4;
    case FORMULA_NOISE:
        top[-3] = noise_of(place->source, top - 3, place->source->generator);
        return 3;
    case FORMULA_NOISE_CHOSEN:
        top[-4] = noise_of(place->source, top - 4, noise_generator((int)number_to_int(top[-1]) & 3));
        return 4;
    case FORMULA_GIVEN: {
        unsigned count = (unsigned)step->number;
        top[-(int)count] = given_surface(step->which, place->source->noise, top - count);
        return count;
    }
    case FORMULA_CALL: {
        unsigned count = (unsigned)step->number;
        formula_run(place->source, step->which, top - count, top);
        top[-(int)count] = top[0];
        return count;
    }
    default:
        top[-3] = place->source->painted ? place->source->painted(place->source->client, step, top - 3) : (double)NAN;
        return 3;
    }
}

// Of the steps that most formulas are made of, the last number, top[-1], is at hand in `last`.
void formula_run(const FormulaSource *source, uint32_t first, const double *slots, double *top)
{
    const Place place = {source, slots};
    double last = 0.0;
    for (uint32_t i = first; i != RECORD_NONE;) {
        const FormulaStep *step = &source->steps[i];
        FormulaOp op = (FormulaOp)step->op;
        i = step->next;
        switch (op) {
        case FORMULA_NUMBER:
            last = step->number;
            top++;
            break;
        case FORMULA_SLOT:
            last = slots[step->which];
            top++;
            break;
        case FORMULA_ADD:
            last = top[-2] + last;
            top--;
            break;
        case FORMULA_SUB:
            last = top[-2] - last;
            top--;
            break;
        case FORMULA_MUL:
            last = top[-2] * last;
            top--;
            break;
        default:
            if (op <= FORMULA_MAX) {
                last = of_two(op, top[-2], last);
                top--;
            } else if (op <= FORMULA_RADIANS) {
                last = of_one(op, last);
            } else {
                top -= of_more(&place, step, top) - 1;
                last = top[-1];
            }
        }
        top[-1] = last;
    }
}

const FormulaHost *scene_formula_host(Scene *scene)
{
    Noise *noise = scene->formula_host ? NULL : malloc(sizeof *noise);
    if (noise) {
        scene->formula_host = calloc(1, sizeof *scene->formula_host);
    }
    if (!noise || !scene->formula_host) {
        free(noise);
        return scene->formula_host;
    }
    noise_init(noise, NULL);
    scene->formula_host->noise = noise;
    return scene->formula_host;
}
