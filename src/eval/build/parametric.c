// Parametric surfaces: three functions and a rectangle become the list of a part (scene/parametric.h).
//
// Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "eval/build/painted.h"
#include "eval/values/function.h"
#include "scene/parametric.h"

static const char *const coordinates[3] = {"x", "y", "z"}, *const corner = "a corner of the rectangle of u and v";

// `function { … }`, as it stands: without parameters, and not of a pattern and the like.
static bool read_function(Block *block, const char *what, const Function **function)
{
    const AstNode *item = cursor_peek(&block->cursor);
    Value value;
    if (!item || item->kind != AST_FUNCTION) {
        return block_fault(block, DIAG_E0253, block_here(block), "`parametric` needs `function { … }` here: its %s",
                           what);
    }
    bool has_comma = block->cursor.has_comma;
    cursor_skip(&block->cursor);
    if (item->a) {
        return block_fault(block, DIAG_E0254, item->span,
                           "a function of a parametric surface names no parameters: they "
                           "are u and v");
    }
    if (has_comma) {
        return block_fault(block, DIAG_E0259, item->span, "no comma may stand before this function");
    }
    bool is_plain = item->b && !(item->b->kind == AST_BUILTIN && item->b->symbol == W_internal);
    if (!eval_rvalue(block->ev, item, &value)) {
        return false;
    }
    if (!is_plain || value.kind != VALUE_FUNCTION || value.function->kind != FUNCTION_NUMBER) {
        return block_fault(block, DIAG_E0254, item->span,
                           "a function of a parametric surface is an expression of u and v");
    }
    *function = value.function;
    return true;
}

// Behind a fault: nothing is said of the other functions.
static bool pass_functions(Block *block)
{
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_FUNCTION) {
        cursor_skip(&block->cursor);
    }
    return false;
}

static bool make_list(Block *block, const Scene *scene, Parametric *head, Numbers *list)
{
    size_t steps = scene->formula_steps.count, count = PARAMETRIC_HEAD + PARAMETRIC_STEP * steps;
    double *numbers = arena_alloc_array(block->arena, count, sizeof *numbers);
    if (!numbers) {
        return eval_no_memory(block->ev, block->node->span);
    }
    head->step_count = (double)steps;
    head->generator = eval_noise_generator(block->ev);
    memcpy(numbers, head, sizeof *head);
    memcpy(numbers + PARAMETRIC_HEAD, scene->formula_steps.items, steps * sizeof(FormulaStep));
    *list = (Numbers){numbers, count};
    return true;
}

static bool make(Block *block, Parametric *head, PaintedList *painted)
{
    const Function *const *functions = block->record->parametric.functions;
    ShapeFormula *formula = &block->record->parametric.formula;
    const FormulaBlock in = {block->kind, block->node->span};
    Scene scene;
    bool is_made = true;
    scene_init(&scene);
    for (int axis = 0; axis < 3 && is_made; axis++) {
        uint32_t first;
        is_made = formula_make(block->ev, &scene, functions[axis], in, &first, painted);
        head->first[axis] = first;
    }
    is_made = is_made && make_list(block, &scene, head, &formula->list) &&
              shape_formula_host(block, formula, PARAMETRIC_HEAD, painted);
    scene_fini(&scene);
    return is_made;
}

bool parametric_body(Block *block)
{
    ParametricDesc *desc = &block->record->parametric;
    double a[2], b[2];
    for (int axis = 0; axis < 3; axis++) {
        if (!read_function(block, coordinates[axis], &desc->functions[axis])) {
            return pass_functions(block);
        }
        if (axis < 2) {
            cursor_take_comma(&block->cursor);
        }
    }
    if (!block_pair(block, corner, a)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    if (!block_pair(block, corner, b)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        desc->from[i] = fmin(a[i], b[i]);
        desc->to[i] = fmax(a[i], b[i]);
    }
    return true;
}

// How deep, and of which coordinates: what POV-Ray computes before it needs it.
bool parametric_precompute_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const Word words[3] = {W_x, W_y, W_z};
    double depth;
    Span span = item->span;
    (void)property;
    if (!cursor_number(&block->cursor, &depth, &span)) {
        block->has_fault = true;
        return false;
    }
    if (!(depth >= 1.0 && depth < 21.0)) {
        return block_fault(block, DIAG_E0341, span, "the depth of `precompute` is from 1 to 20, not %g", depth);
    }
    for (int axis = 0; axis < 3; axis++) {
        cursor_take_comma(&block->cursor);
        const AstNode *next = cursor_peek(&block->cursor);
        if (next && next->kind == AST_CONSTANT && next->symbol == words[axis]) {
            cursor_skip(&block->cursor);
        }
    }
    return true;
}

static bool check_size(Block *block, const Parametric *head)
{
    double size = fmax(head->to[0] - head->from[0], head->to[1] - head->from[1]);
    Vec3 low, high;
    parametric_bounds(head, &low, &high);
    if (!isfinite(vec3_max_abs(low)) || !isfinite(vec3_max_abs(high))) {
        return block_fault(block, DIAG_E0341, block->node->span, "what contains a parametric surface must be finite");
    }
    return size <= PARAMETRIC_PIECES_MOST * head->accuracy ||
           block_fault(block, DIAG_E0485, block->node->span,
                       "`accuracy` %g is less than 2^-24 of the rectangle of u and v, which is %g long", head->accuracy,
                       size);
}

bool parametric_close(Block *block)
{
    const ParametricDesc *desc = &block->record->parametric;
    if (block->has_unsupported || block->has_fault) {
        return true;
    }
    Parametric head = {.from = {desc->from[0], desc->from[1]},
                       .to = {desc->to[0], desc->to[1]},
                       .accuracy = desc->accuracy,
                       .max_gradient = desc->max_gradient,
                       .is_round = desc->container.is_ball};
    container_set(&desc->container, head.low, head.high);
    if (!check_size(block, &head)) {
        return false;
    }
    PaintedList painted = {0};
    bool is_made = make(block, &head, &painted);
    ARRAY_FREE(&painted);
    if (!is_made) {
        block->has_unsupported = eval_leaves_out(block->ev);
    }
    return is_made || block->has_unsupported;
}

bool parametric_place(Eval *ev, const void *object, Primitive *primitive)
{
    const ParametricDesc *desc = object;
    return shape_formula_place(ev, &desc->formula, PARAMETRIC_HEAD, desc->part.span, primitive);
}

const char *parametric_form(const void *object, Primitive *primitive)
{
    const ParametricDesc *desc = object;
    const Parametric *surface = parametric_of(desc->formula.list.items);
    primitive->kind = PRIMITIVE_PARAMETRIC;
    parametric_bounds(surface, &primitive->fixed[0], &primitive->fixed[1]);
    primitive->list = desc->formula.list;
    primitive->host = desc->formula.host;
    bool is_flat = primitive->fixed[0].x == primitive->fixed[1].x || primitive->fixed[0].y == primitive->fixed[1].y ||
                   primitive->fixed[0].z == primitive->fixed[1].z;
    return is_flat ? "a parametric surface in a flat box is not drawn" : NULL;
}

bool parametric_box(const void *object, OwnBox *own)
{
    parametric_bounds(parametric_of(((const ParametricDesc *)object)->formula.list.items), &own->low, &own->high);
    return false;
}
