// Isosurfaces: the function and the numbers in their braces become the list of a part (scene/isosurface.h).
//
// Looks along some lines for how much the function changes, and reports a `max_gradient` that is too low for it, as
// POV-Ray does it after the picture. Knows nothing of composites, textures and rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "eval/build/painted.h"
#include "eval/values/function.h"
#include "scene/isosurface.h"

// Lines that are looked along, and what a function's steps are at least divided by to have fewer.
enum { LINES_MOST = 256, STEPS_OF_LINES = 4096 };

// Pieces that a line in the container may fall into. POV-Ray has no end there, and a ray of more takes seconds.
static const double pieces_most = 0x1p24;

bool shape_function_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Value value;
    (void)property;
    if (!eval_rvalue(block->ev, item, &value)) {
        return false;
    }
    block->record->isosurface.function = value.function;
    return true;
}

// ---- the container

bool container_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    ContainerDesc *container = &block->record->container;
    SchemaKind kind = item->symbol == W_sphere ? KIND_CONTAINER_BALL : KIND_CONTAINER_BOX, is;
    Desc inner;
    (void)property;
    if (container->is_given) {
        return block_fault(block, DIAG_E0254, item->span, "`contained_by` takes one sphere or box");
    }
    block_defaults(block->ev, kind, &inner);
    if (!block_read(block->ev, item, kind, block->arena, &inner, &is)) {
        return false;
    }
    *container = inner.container;
    container->is_ball = kind == KIND_CONTAINER_BALL;
    container->is_given = true;
    return true;
}

bool contained_by_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    SchemaKind is;
    Desc inner;
    block_defaults(block->ev, KIND_CONTAINED_BY, &inner);
    if (!block_read(block->ev, item, KIND_CONTAINED_BY, block->arena, &inner, &is)) {
        return false;
    }
    if (!inner.container.is_given) {
        return block_fault(block, DIAG_E0253, item->span, "`contained_by` needs a sphere or box in its braces");
    }
    (void)property;
    *(block->kind == KIND_PARAMETRIC ? &block->record->parametric.container : &block->record->isosurface.container) =
        inner.container;
    return true;
}

bool isosurface_evaluate_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    IsosurfaceDesc *desc = &block->record->isosurface;
    Span span = item->span;
    (void)property;
    if (item->symbol == W_all_intersections) {
        desc->roots_most = ISOSURFACE_ROOTS_MOST;
        return true;
    }
    for (int i = 0; i < 3; i++) {
        if (!cursor_number(&block->cursor, &desc->evaluate[i], &span)) {
            block->has_fault = true;
            return false;
        }
        if (!(desc->evaluate[i] > 0.0) || !isfinite(desc->evaluate[i])) {
            return block_fault(block, DIAG_E0341, span,
                               "each of the numbers of `evaluate` must be greater than 0, not %g", desc->evaluate[i]);
        }
        if (i < 2) {
            cursor_take_comma(&block->cursor);
        }
    }
    return true;
}

// ---- the list

static double gradient_of(const IsosurfaceDesc *desc)
{
    const double *evaluate = desc->evaluate;
    return evaluate[0] > 0.0 ? evaluate[0] * evaluate[1] * evaluate[1] : desc->max_gradient;
}

void container_set(const ContainerDesc *container, double to_low[3], double to_high[3])
{
    Vec3 radius = {container->radius, container->radius, container->radius};
    Vec3 low = container->is_ball ? container->low : vec3_least(container->low, container->high);
    Vec3 high = container->is_ball ? radius : vec3_greatest(container->low, container->high);
    memcpy(to_low, &low, sizeof low);
    memcpy(to_high, &high, sizeof high);
}

static bool make_list(Block *block, const Scene *scene, uint32_t first, Numbers *list)
{
    const IsosurfaceDesc *desc = &block->record->isosurface;
    size_t steps = scene->formula_steps.count;
    double *numbers = arena_alloc_array(block->arena, ISOSURFACE_HEAD + ISOSURFACE_STEP * steps, sizeof *numbers);
    if (!numbers) {
        return eval_no_memory(block->ev, block->node->span);
    }
    int roots = desc->roots_most < ISOSURFACE_ROOTS_MOST ? desc->roots_most : ISOSURFACE_ROOTS_MOST;
    unsigned flags =
        (desc->is_open ? (unsigned)ISOSURFACE_OPEN : 0) | (desc->container.is_ball ? (unsigned)ISOSURFACE_ROUND : 0);
    Isosurface head = {.first = first,
                       .step_count = (double)steps,
                       .threshold = desc->threshold,
                       .accuracy = desc->accuracy,
                       .max_gradient = gradient_of(desc),
                       .flags = flags,
                       .roots_most = roots,
                       .generator = eval_noise_generator(block->ev)};
    container_set(&desc->container, head.low, head.high);
    memcpy(numbers, &head, sizeof head);
    memcpy(numbers + ISOSURFACE_HEAD, scene->formula_steps.items, steps * sizeof(FormulaStep));
    *list = (Numbers){numbers, ISOSURFACE_HEAD + ISOSURFACE_STEP * steps};
    return true;
}

// ---- how much the function changes

// Points that fill a cube evenly: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
static double spread(unsigned i, double step)
{
    double at = 0.5 + i * step;
    return at - floor(at);
}

// A line through the container's box, whose parameter is from 0 to its length.
static Ray line_through(Vec3 low, Vec3 high, unsigned i, double *length)
{
    const double steps[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
    double a[3], b[3], l[3] = {low.x, low.y, low.z}, h[3] = {high.x, high.y, high.z};
    unsigned across = i % 3;
    for (unsigned axis = 0, next = 0; axis < 3; axis++) {
        bool is_across = axis == across;
        a[axis] = is_across ? l[axis] : l[axis] + (h[axis] - l[axis]) * spread(i, steps[next]);
        b[axis] = is_across ? h[axis] : l[axis] + (h[axis] - l[axis]) * spread(i, steps[next + 2]);
        next += is_across ? 0 : 1;
    }
    Vec3 begin = vec3(a[0], a[1], a[2]), way = vec3_sub(vec3(b[0], b[1], b[2]), begin);
    *length = vec3_length(way);
    return (Ray){begin, vec3_scale(1.0 / *length, way)};
}

// A line between two points of a ball's surface.
static Ray line_through_ball(Vec3 middle, double radius, unsigned i, double *length)
{
    const double steps[4] = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087, 0.5385972572236101};
    Vec3 ends[2];
    for (unsigned k = 0; k < 2; k++) {
        double z = 2.0 * spread(i, steps[2 * k]) - 1.0, angle = 2.0 * M_PI * spread(i, steps[2 * k + 1]);
        double across = sqrt(fmax(1.0 - z * z, 0.0));
        ends[k] = vec3_add_scaled(middle, radius, vec3(across * cos(angle), across * sin(angle), z));
    }
    Vec3 way = vec3_sub(ends[1], ends[0]);
    *length = vec3_length(way);
    return (Ray){ends[0], vec3_scale(1.0 / *length, way)};
}

static double steepest(const IsosurfaceDesc *desc)
{
    const Isosurface *surface = isosurface_of(desc->formula.list.items);
    unsigned lines = (unsigned)fmin(LINES_MOST, 1.0 + LINES_MOST * (STEPS_OF_LINES / fmax(surface->step_count, 1.0)));
    double most = 0.0, length, t;
    Vec3 low, high;
    isosurface_bounds(surface, &low, &high);
    for (unsigned i = 0; i < lines; i++) {
        Ray ray = isosurface_is(surface, ISOSURFACE_ROUND)
                      ? line_through_ball(vec3_scale(0.5, vec3_add(low, high)), surface->high[0], i, &length)
                      : line_through(low, high, i, &length);
        IsosurfaceLine line = isosurface_line(desc->formula.list.items, desc->formula.host, ray, 1.0);
        line.step = fmax(line.step, length / 1024.0);
        bool up = isosurface_along(&line, 0.0) < 0.0;
        (void)isosurface_find(&line, 0.0, length, up, &t);
        most = fmax(most, line.steepest);
    }
    return most;
}

static bool check_gradient(Block *block)
{
    const IsosurfaceDesc *desc = &block->record->isosurface;
    double found = steepest(desc), said = isosurface_of(desc->formula.list.items)->max_gradient;
    if (found > 1.001 * said) { // less shows nowhere
        eval_warn(
            block->ev, DIAG_W0485, block->node->span,
            "the function changes by %.4g over a length of 1, and `max_gradient` is %.4g: the surface may have holes",
            found, said);
    }
    return eval_step(block->ev, block->node->span);
}

static bool check_pieces(Block *block)
{
    const IsosurfaceDesc *desc = &block->record->isosurface;
    Vec3 low, high;
    isosurface_bounds(isosurface_of(desc->formula.list.items), &low, &high);
    double across = vec3_length(vec3_sub(high, low));
    if (!isfinite(across)) {
        return block_fault(block, DIAG_E0341, block->node->span, "what contains an isosurface must be finite");
    }
    return across <= pieces_most * desc->accuracy ||
           block_fault(block, DIAG_E0485, block->node->span,
                       "`accuracy` %g is less than 2^-24 of what contains the isosurface, which is %g across",
                       desc->accuracy, across);
}

static bool make(Block *block, PaintedList *painted)
{
    IsosurfaceDesc *desc = &block->record->isosurface;
    Scene scene;
    uint32_t first;
    scene_init(&scene);
    const FormulaBlock in = {block->kind, block->node->span};
    bool is_made = formula_make(block->ev, &scene, desc->function, in, &first, painted) &&
                   make_list(block, &scene, first, &desc->formula.list) &&
                   shape_formula_host(block, &desc->formula, ISOSURFACE_HEAD, painted);
    scene_fini(&scene);
    return is_made;
}

bool isosurface_close(Block *block)
{
    PaintedList painted = {0};
    if (block->has_unsupported) {
        return true;
    }
    if (!block->record->isosurface.function) {
        return block_fault(block, DIAG_E0253, block->node->span, "`isosurface` needs a function");
    }
    bool is_made = make(block, &painted);
    ARRAY_FREE(&painted);
    if (!is_made) {
        block->has_unsupported = eval_leaves_out(block->ev);
        return block->has_unsupported;
    }
    return check_pieces(block) && check_gradient(block);
}

// ---- the shape

bool isosurface_place(Eval *ev, const void *object, Primitive *primitive)
{
    const IsosurfaceDesc *desc = object;
    return shape_formula_place(ev, &desc->formula, ISOSURFACE_HEAD, desc->part.span, primitive);
}

const char *isosurface_form(const void *object, Primitive *primitive)
{
    const IsosurfaceDesc *desc = object;
    primitive->kind = PRIMITIVE_ISOSURFACE;
    isosurface_bounds(isosurface_of(desc->formula.list.items), &primitive->fixed[0], &primitive->fixed[1]);
    primitive->list = desc->formula.list;
    primitive->host = desc->formula.host;
    bool is_flat = primitive->fixed[0].x == primitive->fixed[1].x || primitive->fixed[0].y == primitive->fixed[1].y ||
                   primitive->fixed[0].z == primitive->fixed[1].z;
    return is_flat ? "an isosurface in a flat box is not drawn" : NULL;
}

bool isosurface_has(const void *object, Vec3 point, bool is_turned)
{
    const IsosurfaceDesc *desc = object;
    return isosurface_holds(desc->formula.list.items, desc->formula.host, point) != is_turned;
}

bool isosurface_box(const void *object, OwnBox *own)
{
    isosurface_bounds(isosurface_of(((const IsosurfaceDesc *)object)->formula.list.items), &own->low, &own->high);
    return false;
}
