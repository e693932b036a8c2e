// Formulas and warps as `.scn` text.
//
// A formula is written as the expression that gives the same steps; what it calls, and the patterns and pigments that
// it asks, are functions that are declared before. Knows only what it writes of the language.
//
// SPDX-License-Identifier: MIT
#include "scene/dump.h"

#include <stdlib.h>

#include "scene/isosurface.h"
#include "scene/parametric.h"

static const char *const infix[FORMULA_OPS] = {
    [FORMULA_ADD] = "+", [FORMULA_SUB] = "-", [FORMULA_MUL] = "*", [FORMULA_DIV] = "/",
    [FORMULA_EQ] = "=",  [FORMULA_NE] = "!=", [FORMULA_LT] = "<",  [FORMULA_LE] = "<=",
    [FORMULA_GT] = ">",  [FORMULA_GE] = ">=", [FORMULA_AND] = "&", [FORMULA_OR] = "|",
};

static const char *const words[FORMULA_OPS] = {
    [FORMULA_ATAN2] = "atan2",     [FORMULA_POW] = "pow",         [FORMULA_MOD] = "mod",
    [FORMULA_QUOTIENT] = "div",    [FORMULA_MIN] = "min",         [FORMULA_MAX] = "max",
    [FORMULA_NEG] = "-",           [FORMULA_ABS] = "abs",         [FORMULA_SIN] = "sin",
    [FORMULA_COS] = "cos",         [FORMULA_TAN] = "tan",         [FORMULA_ASIN] = "asin",
    [FORMULA_ACOS] = "acos",       [FORMULA_ATAN] = "atan",       [FORMULA_SINH] = "sinh",
    [FORMULA_COSH] = "cosh",       [FORMULA_TANH] = "tanh",       [FORMULA_ASINH] = "asinh",
    [FORMULA_ACOSH] = "acosh",     [FORMULA_ATANH] = "atanh",     [FORMULA_EXP] = "exp",
    [FORMULA_LN] = "ln",           [FORMULA_LOG] = "log",         [FORMULA_SQRT] = "sqrt",
    [FORMULA_FLOOR] = "floor",     [FORMULA_CEIL] = "ceil",       [FORMULA_INT] = "int",
    [FORMULA_DEGREES] = "degrees", [FORMULA_RADIANS] = "radians", [FORMULA_SELECT3] = "select",
    [FORMULA_SELECT4] = "select",
};

// The arguments of functions: those of a pattern's own have the first three.
static const char *const slot_words[] = {"x", "y", "z"};

// Where formulas are written from.
typedef struct Formulas {
    const Scene *scene;
    const FormulaStep *steps; // the scene's, or an isosurface's own
    bool is_own;
} Formulas;

static Formulas formulas_of(const Scene *scene)
{
    return (Formulas){scene, scene->formula_steps.items, false};
}

typedef struct Writer {
    const Formulas *formulas;
    TextBuffer *out;
    const FormulaStep **steps; // of the formula that is written, in order
    bool is_pattern;           // its arguments are x, y and z
} Writer;

static unsigned takes(const FormulaStep *step)
{
    FormulaOp op = (FormulaOp)step->op;
    return op <= FORMULA_SLOT                                    ? 0
           : op <= FORMULA_MAX                                   ? 2
           : op <= FORMULA_RADIANS                               ? 1
           : op == FORMULA_CALL || op == FORMULA_GIVEN           ? (unsigned)step->number
           : op == FORMULA_SELECT4 || op == FORMULA_NOISE_CHOSEN ? 4
                                                                 : 3;
}

// The place before the first of the steps that give what step `last` does.
static size_t begin_of(const Writer *writer, size_t last)
{
    size_t wanted = 1;
    for (size_t i = last + 1; wanted > 0; i--) {
        wanted = wanted - 1 + takes(writer->steps[i - 1]);
        if (wanted == 0) {
            return i - 1;
        }
    }
    return 0;
}

static void write_value(const Writer *writer, size_t last);

// With an operator between them, or a comma where that is NULL.
static void write_arguments(const Writer *writer, size_t last, const char *operator)
{
    size_t ends[64], end = last, count = takes(writer->steps[last]);
    for (size_t i = count; i-- > 0; end = begin_of(writer, end - 1)) {
        ends[i] = end - 1;
    }
    text_append(writer->out, "(");
    for (size_t i = 0; i < count; i++) {
        if (i > 0) {
            text_printf(writer->out, "%s%s ", operator ? " " : "", operator ? operator : ",");
        }
        write_value(writer, ends[i]);
    }
    text_append(writer->out, ")");
}

static void write_component(const FormulaStep *step, TextBuffer *out)
{
    static const char *const parts[] = {".red", ".green", ".blue", ".filter", ".transmit", ".gray", ".hf"};
    text_append(out, step->op == FORMULA_PIGMENT ? parts[(unsigned)step->number] : "");
}

static void write_value(const Writer *writer, size_t last)
{
    const FormulaStep *step = writer->steps[last];
    TextBuffer *out = writer->out;
    switch ((FormulaOp)step->op) {
    case FORMULA_NUMBER:
        dump_number(out, "", step->number);
        return;
    case FORMULA_SLOT:
        if (writer->is_pattern) {
            text_append(out, slot_words[step->which]);
        } else {
            text_printf(out, "A%lu", (unsigned long)step->which);
        }
        return;
    case FORMULA_CALL:
        text_printf(out, "%s%lu", writer->formulas->is_own ? "J" : "G", (unsigned long)step->which);
        break;
    case FORMULA_PATTERN:
        text_printf(out, "Q%lu", (unsigned long)step->which);
        break;
    case FORMULA_PIGMENT:
        text_printf(out, "R%lu", (unsigned long)step->which);
        break;
    default:
        text_append(out, words[step->op] ? words[step->op] : "");
        break;
    }
    write_arguments(writer, last, infix[step->op]);
    write_component(step, out);
}

static void write_body(const Formulas *formulas, uint32_t first, bool is_pattern, TextBuffer *out)
{
    size_t count = 0;
    for (uint32_t i = first; i != RECORD_NONE; i = formulas->steps[i].next) {
        count++;
    }
    Writer writer = {formulas, out, malloc((count + 1) * sizeof *writer.steps), is_pattern};
    if (!writer.steps) {
        out->failed = true;
        return;
    }
    count = 0;
    for (uint32_t i = first; i != RECORD_NONE; i = formulas->steps[i].next) {
        writer.steps[count++] = &formulas->steps[i];
    }
    write_value(&writer, count - 1);
    free(writer.steps);
}

// Noise, or a given surface, is all that a function does that has it: one of those that POV-Ray has built in.
static bool write_given(const Formulas *formulas, uint32_t first, TextBuffer *out)
{
    const FormulaStep *step = &formulas->steps[first];
    while (step->next != RECORD_NONE) {
        step = &formulas->steps[step->next];
    }
    bool is_noise = step->op == FORMULA_NOISE || step->op == FORMULA_NOISE_CHOSEN;
    if (step->op == FORMULA_GIVEN || is_noise) {
        text_printf(out, "{ internal(%lu) }",
                    step->op == FORMULA_GIVEN   ? (unsigned long)step->which
                    : step->op == FORMULA_NOISE ? 76ul
                                                : 78ul);
        return true;
    }
    return false;
}

// A function that is called; those of the scene's patterns are declared once, by their number.
static void declare_call(const Formulas *formulas, const FormulaStep *step, TextBuffer *out)
{
    const char *end = formulas->is_own ? "\n" : " #end\n", *letter = formulas->is_own ? "J" : "G";
    unsigned long number = (unsigned long)step->which;
    if (formulas->is_own) { // POV-Ray declares no function anew
        text_printf(out, "#ifdef (%s%lu) #undef %s%lu #end\n", letter, number, letter, number);
    } else {
        text_printf(out, "#ifndef (%s%lu) ", letter, number);
    }
    text_printf(out, "#declare %s%lu = function ", letter, number);
    if (write_given(formulas, step->which, out)) {
        text_append(out, end);
        return;
    }
    text_append(out, "(");
    for (unsigned i = 0; i < (unsigned)step->number; i++) {
        text_printf(out, "%sA%u", i > 0 ? ", " : "", i);
    }
    text_append(out, ") { ");
    write_body(formulas, step->which, false, out);
    text_append(out, " }");
    text_append(out, end);
}

// What a formula calls, before it.
static void declare_parts(const Formulas *formulas, uint32_t first, TextBuffer *out)
{
    for (uint32_t i = first; i != RECORD_NONE; i = formulas->steps[i].next) {
        const FormulaStep *step = &formulas->steps[i];
        switch ((FormulaOp)step->op) {
        case FORMULA_CALL:
            declare_parts(formulas, step->which, out);
            declare_call(formulas, step, out);
            break;
        case FORMULA_PATTERN:
            text_printf(out, "#ifndef (Q%lu) #declare Q%lu = function { pattern {\n", (unsigned long)step->which,
                        (unsigned long)step->which);
            dump_pattern(formulas->scene, &formulas->scene->patterns.items[step->which], out);
            text_append(out, "} } #end\n");
            break;
        case FORMULA_PIGMENT:
            text_printf(out, "#ifndef (R%lu) #declare R%lu = function { pigment { P%lu } } #end\n",
                        (unsigned long)step->which, (unsigned long)step->which, (unsigned long)step->which + 1);
            break;
        default:
            break;
        }
    }
}

static void write_function(const Formulas *formulas, uint32_t first, TextBuffer *out)
{
    text_append(out, "function ");
    if (write_given(formulas, first, out)) {
        return;
    }
    text_append(out, "{ ");
    write_body(formulas, first, true, out);
    text_append(out, " }");
}

void dump_formula_parts(const Scene *scene, const Pattern *pattern, TextBuffer *out)
{
    Formulas formulas = formulas_of(scene);
    if (pattern->type == PATTERN_FUNCTION) {
        declare_parts(&formulas, pattern->image, out);
    }
}

void dump_formula(const Scene *scene, const Pattern *pattern, TextBuffer *out)
{
    Formulas formulas = formulas_of(scene);
    text_append(out, "  ");
    write_function(&formulas, pattern->image, out);
}

// ---- isosurfaces and parametric surfaces

static void dump_container(bool is_round, const double a[3], const double b[3], TextBuffer *out)
{
    if (is_round) {
        dump_vector(out, "\n  contained_by { sphere { ", vec3(a[0], a[1], a[2]));
        dump_number(out, ", ", b[0]);
    } else {
        dump_vector(out, "\n  contained_by { box { ", vec3(a[0], a[1], a[2]));
        dump_vector(out, ", ", vec3(b[0], b[1], b[2]));
    }
}

void dump_parametric(const Scene *scene, const Primitive *primitive, TextBuffer *out)
{
    const Parametric *surface = parametric_of(primitive->list.items);
    Formulas formulas = {scene, parametric_steps(primitive->list.items), true};
    text_append(out, "\n");
    for (int axis = 0; axis < 3; axis++) {
        declare_parts(&formulas, (uint32_t)surface->first[axis], out);
    }
    for (int axis = 0; axis < 3; axis++) {
        write_function(&formulas, (uint32_t)surface->first[axis], out);
        text_append(out, "\n  ");
    }
    dump_numbers(out, surface->from, 2);
    text_append(out, ", ");
    dump_numbers(out, surface->to, 2);
    dump_container(surface->is_round != 0.0, surface->low, surface->high, out);
    dump_number(out, " } } accuracy ", surface->accuracy);
    dump_number(out, " max_gradient ", surface->max_gradient);
}

void dump_isosurface(const Scene *scene, const Primitive *primitive, TextBuffer *out)
{
    const Isosurface *surface = isosurface_of(primitive->list.items);
    Formulas formulas = {scene, isosurface_steps(primitive->list.items), true};
    text_append(out, "\n");
    declare_parts(&formulas, (uint32_t)surface->first, out);
    write_function(&formulas, (uint32_t)surface->first, out);
    dump_container(isosurface_is(surface, ISOSURFACE_ROUND), surface->low, surface->high, out);
    dump_number(out, " } } threshold ", surface->threshold);
    dump_number(out, " accuracy ", surface->accuracy);
    dump_number(out, " max_gradient ", surface->max_gradient);
    dump_number(out, " max_trace ", surface->roots_most);
    text_append(out, isosurface_is(surface, ISOSURFACE_OPEN) ? " open" : "");
}

// ---- warps

static void dump_warp(const Warp *warp, TextBuffer *out)
{
    switch ((WarpType)warp->type) {
    case WARP_TURBULENCE:
        dump_vector(out, "  warp { turbulence ", warp->vector);
        dump_number(out, " lambda ", warp->lambda);
        dump_number(out, " omega ", warp->omega);
        text_printf(out, " octaves %lu }\n", (unsigned long)warp->octaves);
        return;
    case WARP_REPEAT:
        dump_vector(out, "  warp { repeat ", warp->vector);
        dump_vector(out, " offset ", warp->offset);
        dump_vector(out, " flip ", warp->flip);
        text_append(out, " }\n");
        return;
    case WARP_BLACK_HOLE:
        dump_vector(out, "  warp { black_hole ", warp->vector);
        dump_number(out, ", ", warp->radius);
        dump_number(out, " strength ", warp->strength);
        dump_number(out, " falloff ", warp->power);
        if (vec3_length_squared(warp->flip) > 0.0) {
            dump_vector(out, " repeat ", warp->flip);
            dump_vector(out, " turbulence ", warp->offset);
        }
        text_append(out, warp->flags & WARP_INVERSE ? " inverse }\n" : " }\n");
        return;
    case WARP_PLANAR:
        dump_vector(out, "  warp { planar ", warp->vector);
        dump_number(out, ", ", warp->radius);
        text_append(out, " }\n");
        return;
    case WARP_CUBIC:
        text_append(out, "  warp { cubic }\n");
        return;
    default:
        break;
    }
    text_append(out, warp->type == WARP_CYLINDRICAL ? "  warp { cylindrical"
                     : warp->type == WARP_SPHERICAL ? "  warp { spherical"
                                                    : "  warp { toroidal");
    dump_vector(out, " orientation ", warp->vector);
    dump_number(out, " dist_exp ", warp->exponent);
    if (warp->type == WARP_TOROIDAL) {
        dump_number(out, " major_radius ", warp->radius);
    }
    text_append(out, " }\n");
}

// The last in the list was said first.
static void dump_from(const Scene *scene, uint32_t index, TextBuffer *out)
{
    const Warp *warp = &scene->warps.items[index];
    if (warp->next != RECORD_NONE) {
        dump_from(scene, warp->next, out);
    }
    dump_matrix(&warp->to_outside, out);
    dump_warp(warp, out);
}

void dump_warps(const Scene *scene, const Pattern *pattern, TextBuffer *out)
{
    if (pattern->warps) {
        dump_from(scene, pattern->warps - 1, out);
    }
}
