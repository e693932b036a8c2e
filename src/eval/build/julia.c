// Julia fractals: a vector and words become the list of a part (scene/julia.h).
//
// Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "scene/julia.h"

// Steps along a line times those of an orbit; a ray of more takes seconds.
static const double work_most = 0x1p24;

// A vector of 4; one of fewer has 0 in the place of the others, a number is all of them.
static bool read_vector(Block *block, const char *what, double *to)
{
    Value value;
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`julia_fractal` needs a vector of 4 here: %s", what);
    }
    Span span = cursor_peek(&block->cursor)->span;
    if (!cursor_value(&block->cursor, &value)) {
        return false;
    }
    unsigned given = value.kind == VALUE_NUMBER ? 4 : value.kind == VALUE_VECTOR ? (unsigned)value.components : 0;
    if (given == 0 || given > 4) {
        return block_fault(block, DIAG_E0202, span, "%s is a vector of 4, not %s", what, value_describe(&value));
    }
    for (unsigned i = 0; i < 4; i++) {
        to[i] = value.kind == VALUE_NUMBER ? value.number : i < given ? value.v[i] : 0.0;
        if (!isfinite(to[i])) {
            return block_fault(block, DIAG_E0340, span, "%s is not finite", what);
        }
    }
    return true;
}

bool julia_body(Block *block)
{
    return read_vector(block, "the parameter", block->record->julia.p);
}

static bool slice_action(Block *block, Span word)
{
    JuliaDesc *desc = &block->record->julia;
    Span span = block_here(block);
    if (!read_vector(block, "the normal of a slice", desc->slice)) {
        return false;
    }
    if (desc->slice[3] == 0.0) {
        return block_fault(block, DIAG_E0342, word, "the fourth number of the normal of a slice cannot be 0");
    }
    cursor_take_comma(&block->cursor);
    return cursor_number(&block->cursor, &desc->distance, &span) &&
           block_finite(block, desc->distance, span, "distance of a slice");
}

bool julia_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    JuliaDesc *desc = &block->record->julia;
    (void)property;
    switch ((Word)item->symbol) {
    case W_quaternion:
        return true;
    case W_sqr:
    case W_cube:
        desc->power = item->symbol == W_cube ? 3 : 2;
        return true;
    default:
        return slice_action(block, item->span);
    }
}

bool julia_close(Block *block)
{
    JuliaDesc *desc = &block->record->julia;
    Span span = block->node->span;
    if (block->has_unsupported) {
        return true;
    }
    if (desc->part.is_inverse) { // measured
        return block_fault(block, DIAG_E0251, span,
                           "POV-Ray passes over `inverse` here: write `object { julia_fractal { … } inverse }`");
    }
    double *list = arena_alloc_array(block->arena, JULIA_NUMBERS, sizeof *list);
    if (!list) {
        return eval_no_memory(block->ev, span);
    }
    Julia julia = {.distance = desc->distance,
                   .power = desc->power,
                   .step_count = desc->step_count,
                   .precision = fmax(desc->precision, 1.0)};
    memcpy(julia.p, desc->p, sizeof julia.p);
    memcpy(julia.slice, desc->slice, sizeof julia.slice);
    julia_complete(&julia);
    memcpy(list, &julia, sizeof julia);
    desc->list = (Numbers){list, JULIA_NUMBERS};
    double work = 2.0 * julia.radius * julia.precision * julia.step_count;
    return work <= work_most || block_fault(block, DIAG_E0485, span,
                                            "`precision` %g and `max_iteration` %d make %.3g steps of a ray, more than "
                                            "2^24",
                                            desc->precision, desc->step_count, work);
}

const char *julia_form(const void *object, Primitive *primitive)
{
    const JuliaDesc *desc = object;
    double radius = julia_of(desc->list.items)->radius;
    primitive->kind = PRIMITIVE_JULIA;
    primitive->list = desc->list;
    primitive->fixed[1] = vec3(radius, radius, radius);
    primitive->fixed[0] = vec3_neg(primitive->fixed[1]);
    return NULL;
}

bool julia_has(const void *object, Vec3 point, bool is_turned)
{
    double reach;
    return julia_holds(julia_of(((const JuliaDesc *)object)->list.items), point, &reach) != is_turned;
}

bool julia_box(const void *object, OwnBox *own)
{
    double radius = julia_of(((const JuliaDesc *)object)->list.items)->radius;
    own->high = vec3(radius, radius, radius);
    own->low = vec3_neg(own->high);
    return false;
}
