// Functions of shapes: what their steps ask beside numbers, noise and patterns, where the text is read and in the
// scene.
//
// Knows nothing of what the shapes make of their functions.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "eval/build/painted.h"
#include "math/given_surface.h"

// What the evaluator asks patterns with.
typedef struct Asker {
    FormulaHost host;
    Eval *ev;
    Painted *const *painted;
    Span span;
} Asker;

static double ask(const void *client, const FormulaStep *step, const double *point)
{
    const Asker *asker = client;
    double v[5];
    if (!painted_at(asker->ev, asker->painted[step->which], point, asker->span, v)) {
        return (double)NAN;
    }
    return step->op == FORMULA_PATTERN ? v[0] : formula_component(step, v);
}

static FormulaStep *steps_of(const double *list, size_t head)
{
    return (FormulaStep *)(void *)(list + head);
}

static size_t step_count(const Numbers *list, size_t head)
{
    return (list->count - head) * sizeof(double) / sizeof(FormulaStep);
}

// Whether a step asks for what a host has.
static bool asks_host(const FormulaStep *step)
{
    return step->op == FORMULA_NOISE || step->op == FORMULA_NOISE_CHOSEN || step->op == FORMULA_PATTERN ||
           step->op == FORMULA_PIGMENT || (step->op == FORMULA_GIVEN && given_surface_asks_noise(step->which));
}

bool shape_formula_host(Block *block, ShapeFormula *formula, size_t head, const PaintedList *painted)
{
    Span span = block->node->span;
    bool asks = false;
    for (size_t i = 0; i < step_count(&formula->list, head); i++) {
        asks = asks || asks_host(&steps_of(formula->list.items, head)[i]);
    }
    if (!asks) {
        return true;
    }
    Asker *asker = arena_alloc(block->arena, sizeof *asker);
    const Noise *noise = eval_noise(block->ev, span);
    Painted **copy = arena_copy(block->arena, painted->items, painted->count * sizeof *copy);
    if (!asker || !noise || (!copy && painted->count > 0)) {
        return eval_no_memory(block->ev, span);
    }
    *asker = (Asker){{noise, painted->count > 0 ? ask : NULL, asker}, block->ev, copy, span};
    formula->host = &asker->host;
    formula->painted = copy;
    return true;
}

bool shape_formula_place(Eval *ev, const ShapeFormula *formula, size_t head, Span span, Primitive *primitive)
{
    world_note(ev);
    if (!formula->host) {
        return true;
    }
    primitive->host = scene_formula_host(ev->scene);
    double *list = arena_copy(&ev->program, primitive->list.items, primitive->list.count * sizeof *list);
    if (!primitive->host || !list) {
        return eval_no_memory(ev, span);
    }
    FormulaStep *steps = steps_of(list, head);
    for (size_t i = 0; i < step_count(&primitive->list, head); i++) {
        Pigment pigment;
        if (steps[i].op == FORMULA_PATTERN || steps[i].op == FORMULA_PIGMENT) {
            if (!painted_place(ev, ev->scene, formula->painted[steps[i].which], span, &pigment)) {
                return false;
            }
            steps[i].which = pigment.pattern;
        }
    }
    primitive->list.items = list;
    return true;
}

bool shape_place_functions(Eval *ev, const void *object, Primitive *primitive)
{
    switch (primitive->kind) {
    case PRIMITIVE_ISOSURFACE:
        return isosurface_place(ev, object, primitive);
    case PRIMITIVE_PARAMETRIC:
        return parametric_place(ev, object, primitive);
    default:
        return true;
    }
}
