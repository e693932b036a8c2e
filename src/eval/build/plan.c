// Plans: made of a statement's nodes, and followed.
//
// Knows nothing of text.
//
// SPDX-License-Identifier: MIT
#include "eval/build/plan.h"

#include <float.h>
#include <math.h>
#include <string.h>

bool plan_is_for(SchemaKind kind)
{
    return kind >= KIND_SPHERE && kind <= KIND_SMOOTH_TRIANGLE && kind != KIND_PLANE;
}

// ---- nodes to inputs

typedef struct Compiler {
    GrammarPlan *plan;
    GrammarSlot *slots; // NULL: inputs are expressions
    unsigned count;
    unsigned pigments;
} Compiler;

// What has no effect but random numbers, and stands for itself.
static bool is_plain(const AstNode *node)
{
    bool is_fine = !(node->flags & (AST_KNOWN | AST_PASTES));
    switch ((AstKind)node->kind) {
    case AST_NUMBER:
    case AST_NAME:
    case AST_CONSTANT: return is_fine;
    case AST_UNARY:
    case AST_MEMBER: return is_fine && is_plain(node->a);
    case AST_BINARY:
    case AST_INDEX: return is_fine && is_plain(node->a) && is_plain(node->b);
    case AST_VECTOR:
    case AST_BUILTIN:
        for (const AstNode *part = node->a; part && is_fine; part = part->next) {
            is_fine = is_plain(part);
        }
        return is_fine;
    default: return false;
    }
}

// What is the same each time.
static bool is_constant(const AstNode *node)
{
    bool is_fine = !(node->flags & (AST_KNOWN | AST_PASTES));
    switch ((AstKind)node->kind) {
    case AST_NUMBER:
    case AST_WORD: return is_fine;
    case AST_UNARY: return is_fine && is_constant(node->a);
    case AST_VECTOR:
    case AST_BLOCK:
        for (const AstNode *part = node->a; part && is_fine; part = part->next) {
            is_fine = is_constant(part);
        }
        return is_fine;
    default: return false;
    }
}

// The slot that a number stands in; `count`: none.
static unsigned slot_of(const Compiler *compiler, const AstNode *node)
{
    unsigned i = 0;
    bool is_number = node->kind == AST_NUMBER ||
                     (node->kind == AST_UNARY && node->op == AST_OP_NEG && node->a->kind == AST_NUMBER);
    while (i < compiler->count && (compiler->slots[i].span.begin != node->span.begin ||
                                   compiler->slots[i].span.end != node->span.end)) {
        i++;
    }
    return is_number ? i : compiler->count;
}

// How many numbers in slots a node is, and the first; 0: something else.
static unsigned slots_of(const Compiler *compiler, const AstNode *node, unsigned *first)
{
    const AstNode *part = node->kind == AST_VECTOR ? node->a : node;
    unsigned width = 0, count = node->kind == AST_VECTOR ? node->count : 1;
    *first = slot_of(compiler, part);
    for (; width < count; width++, part = part->next) {
        if (*first + width >= compiler->count || slot_of(compiler, part) != *first + width) {
            return 0;
        }
    }
    return width;
}

static bool is_move(Symbol word)
{
    return word == W_translate || word == W_rotate || word == W_scale || word == W_matrix;
}

// What needs no report between these bounds.
static void set_bounds(PlanInput *input, SchemaKind kind)
{
    const SchemaRange *range = input->argument ? &input->argument->range : NULL;
    bool is_colour = !input->argument && !is_move(input->word);
    input->high = is_colour ? COLOUR_USUAL : DBL_MAX;
    input->low = -input->high;
    if (range && range->policy != RANGE_ANY) {
        input->low = range->low_is_open ? nextafter(range->low, INFINITY) : range->low;
        input->high = range->high < DBL_MAX ? range->high : DBL_MAX;
    }
    if (kind == KIND_SPHERE && input->is_number) {
        input->low = nextafter(0.0, INFINITY); // others are drawn in some places only
    }
}

// `wanted` numbers, or one for all where they are three.
static bool add_input(Compiler *compiler, const AstNode *node, const SchemaProperty *argument, Symbol word, unsigned wanted)
{
    GrammarPlan *plan = compiler->plan;
    PlanInput input = {.argument = argument, .word = word, .first = (uint8_t)plan->number_count};
    input.is_number = argument && argument->type == TYPE_NUMBER;
    set_bounds(&input, plan->kind);
    if (plan->input_count == PLAN_INPUTS_MOST || plan->number_count + wanted > PLAN_NUMBERS_MOST) {
        return false;
    }
    if (!compiler->slots) {
        input.node = node;
        plan->is_quick = plan->is_quick && quick_is_flat(node);
        if (!is_plain(node) || (wanted != 1 && wanted != 3)) {
            return false;
        }
    } else {
        unsigned first, width = slots_of(compiler, node, &first);
        if (width != wanted && (width != 1 || wanted != 3)) {
            return false;
        }
        input.slot = (uint8_t)first;
        input.width = (uint8_t)width;
        for (unsigned i = 0; i < width; i++) {
            compiler->slots[first + i].is_used = true;
        }
    }
    plan->inputs[plan->input_count++] = input;
    plan->number_count += wanted;
    return true;
}

static bool is_value(const AstNode *node)
{
    return node && node->kind <= AST_MEMBER;
}

// How many numbers a colour word takes; 0: it is none.
static unsigned colour_width(Symbol word)
{
    return word == W_rgb ? 3 : word == W_rgbf || word == W_rgbt ? 4 : word == W_rgbft ? 5 : 0;
}

// Behind a colour `rgb`: nothing, or a filter and a transmit that stay as they are.
static bool is_tail(const AstNode *node, Symbol word)
{
    for (; node && word == W_rgb; node = node->next->next) {
        bool is_share = node->kind == AST_WORD && (node->symbol == W_filter || node->symbol == W_transmit);
        if (!is_share || !node->next || node->next->kind != AST_NUMBER) {
            return false;
        }
    }
    return !node;
}

// A pigment of nothing but a colour has an input, others stay as they are.
static bool add_pigment(Compiler *compiler, const AstNode *pigment)
{
    const AstNode *word = pigment->a;
    if (word && word->kind == AST_WORD && (word->symbol == W_color || word->symbol == W_colour)) {
        word = word->next;
    }
    unsigned width = word && word->kind == AST_WORD ? colour_width(word->symbol) : 0;
    bool is_colour = width > 0 && is_value(word->next) && is_tail(word->next->next, word->symbol);
    bool is_input = is_colour && (compiler->slots || !is_constant(word->next)) &&
                    add_input(compiler, word->next, NULL, word->symbol, width);
    compiler->plan->has_colour = compiler->plan->has_colour || is_input;
    return compiler->pigments++ == 0 && (is_input || compiler->slots || is_constant(pigment));
}

static bool add_items(Compiler *compiler, const AstNode *item, bool is_texture)
{
    for (; item; item = item->next) {
        bool is_block = item->kind == AST_BLOCK, is_fine;
        if (is_block && item->symbol == W_pigment) {
            is_fine = add_pigment(compiler, item);
        } else if (is_block && item->symbol == W_texture && !is_texture) {
            is_fine = add_items(compiler, item->a, true);
        } else if (item->kind == AST_WORD && is_move(item->symbol) && !is_texture) {
            unsigned width = item->symbol == W_matrix ? 12 : 3;
            is_fine = is_value(item->next) && add_input(compiler, item->next, NULL, item->symbol, width);
            compiler->plan->has_moves = true;
            item = is_fine ? item->next : item;
        } else {
            is_fine = compiler->slots || is_constant(item);
        }
        if (!is_fine) {
            return false;
        }
    }
    return true;
}

static const AstNode *add_arguments(Compiler *compiler, const AstNode *item, SchemaKind kind)
{
    const SchemaList *arguments = &schema_kind(kind)->arguments;
    for (size_t i = 0; i < arguments->count; i++) {
        const SchemaProperty *argument = &arguments->items[i];
        bool is_vector = argument->type == TYPE_VECTOR, is_there = is_value(item);
        if (!is_there && argument->is_optional) {
            break;
        }
        if (!is_there || !add_input(compiler, item, argument, SYMBOL_NONE, is_vector ? 3 : 1)) {
            return NULL;
        }
        item = item->next;
    }
    return item;
}

// Slots are counted among those that are used from now on.
static void number_slots(Compiler *compiler)
{
    GrammarPlan *plan = compiler->plan;
    for (unsigned i = 0; i < plan->input_count; i++) {
        unsigned used = 0;
        for (unsigned k = 0; k < plan->inputs[i].slot; k++) {
            used += compiler->slots[k].is_used;
        }
        plan->inputs[i].slot = (uint8_t)used;
    }
}

// A sphere at its place needs no steps that know more.
static void settle_sphere(const Eval *ev, GrammarPlan *plan)
{
    const PlanInput *inputs = plan->inputs;
    plan->is_at_place = plan->kind == KIND_SPHERE && !plan->has_moves && !ev->options.world;
    plan->is_direct = plan->is_at_place && !inputs[0].node && inputs[0].width == 3 &&
                      (!plan->has_colour || inputs[2].width == colour_width(inputs[2].word));
}

bool plan_compile(Eval *ev, const AstNode *item, SchemaKind kind, GrammarSlot *slots, unsigned count, GrammarPlan *plan)
{
    Compiler compiler = {.plan = plan, .slots = slots, .count = count};
    plan->kind = kind;
    plan->input_count = plan->number_count = 0;
    plan->has_moves = plan->has_colour = false;
    plan->is_quick = true;
    plan->call = NULL;
    for (unsigned i = 0; i < count; i++) {
        slots[i].is_used = false;
    }
    const AstNode *rest = item->a ? add_arguments(&compiler, item->a, kind) : NULL;
    if (!rest || !add_items(&compiler, rest, false)) {
        return false;
    }
    if (slots) {
        number_slots(&compiler);
    }
    settle_sphere(ev, plan);
    return true;
}

// ---- numbers

// As value_vector3 and value_number take them, of what has no more to it.
static unsigned usual_value(Eval *ev, const AstNode *node, bool is_number, double *to)
{
    ArenaMark mark = scratch_mark(ev);
    Value value;
    unsigned width = 0;
    if (eval_expression(ev, node, &value)) {
        width = value.kind == VALUE_NUMBER ? 1 : value.kind == VALUE_VECTOR && value.components == 3 ? 3 : 0;
    }
    for (unsigned i = 0; i < (is_number ? 1 : 3) && width > 0; i++) {
        to[i] = width == 1 ? value.number : value.v[i];
    }
    scratch_rewind(ev, mark);
    return width;
}

static inline bool is_between(const PlanInput *input, double number)
{
    return number >= input->low && number <= input->high;
}

// Numbers that are wanted where one stands for three are three.
static inline bool are_usual(const PlanInput *input, const double *numbers, unsigned width)
{
    bool is_fine = is_between(input, numbers[0]) && is_between(input, numbers[1]) && is_between(input, numbers[2]);
    for (unsigned i = 3; i < width; i++) {
        is_fine = is_fine && is_between(input, numbers[i]);
    }
    return is_fine;
}

bool plan_fetch_slots(const GrammarPlan *plan, const double *slots, PlanNumbers *numbers)
{
    bool is_fine = true;
    for (unsigned i = 0; i < plan->input_count; i++) {
        const PlanInput *input = &plan->inputs[i];
        const double *from = slots + input->slot;
        double *to = numbers->items + input->first;
        unsigned width = numbers->width[i] = input->width;
        for (unsigned k = 0; k < width; k++) {
            to[k] = from[k];
        }
        if (width == 1 && !input->is_number) {
            to[1] = to[2] = to[0];
        }
        is_fine = is_fine && (input->is_number ? is_between(input, *to) : are_usual(input, to, width));
    }
    return is_fine;
}

// Nothing is evaluated after what is not as usual: the statement itself is to say first what is wrong with that.
RT_ALWAYS_INLINE bool fetch(Eval *ev, const GrammarPlan *plan, bool is_quick, PlanNumbers *numbers)
{
    const PlanInput *input = plan->inputs, *end = input + plan->input_count;
    for (uint8_t *width = numbers->width; input < end; input++, width++) {
        double *to = numbers->items + input->first;
        if (input->is_number) {
            *width = is_quick ? quick_number_of(ev, input->node, true, to)
                              : usual_value(ev, input->node, true, to) == 1;
            if (*width == 0 || !is_between(input, *to)) {
                return false;
            }
        } else {
            *width = (uint8_t)(is_quick ? quick_three_of(ev, input->node, true, to)
                                        : usual_value(ev, input->node, false, to));
            if (*width == 0 || !are_usual(input, to, 3)) {
                return false;
            }
        }
    }
    return true;
}

bool plan_fetch(Eval *ev, GrammarPlan *plan, PlanNumbers *numbers, PlanStreams *kept)
{
    plan_streams_keep(ev, kept);
    if (plan->is_quick && quick_has_room(ev)) {
        if (fetch(ev, plan, true, numbers)) {
            return true;
        }
        plan_streams_take_back(ev, kept);
        plan->is_quick = false; // what is refused once is refused again, most likely
    }
    if (fetch(ev, plan, false, numbers)) {
        return true;
    }
    plan_streams_take_back(ev, kept);
    return false;
}

void plan_streams_keep(const Eval *ev, PlanStreams *kept)
{
    kept->count = ev->streams.count;
    for (size_t i = 0; i < kept->count && i < PLAN_STREAMS_MOST; i++) {
        kept->states[i] = ev->streams.items[i];
    }
}

void plan_streams_take_back(Eval *ev, const PlanStreams *kept)
{
    ev->streams.count = kept->count;
    for (size_t i = 0; i < kept->count; i++) {
        ev->streams.items[i] = kept->states[i];
    }
}

// ---- records

static void set_argument(Desc *record, const SchemaProperty *argument, const double *numbers)
{
    Vec3 vector = argument->type == TYPE_VECTOR ? vec3(numbers[0], numbers[1], numbers[2]) : vec3(numbers[0], 0.0, 0.0);
    memcpy((char *)record + argument->at, &vector, argument->type == TYPE_VECTOR ? sizeof vector : sizeof *numbers);
}

static bool compose(const PlanInput *input, const double *numbers, unsigned width, Transform *whole)
{
    Transform transform;
    if (!transform_of_numbers(input->word, numbers, width, &transform)) {
        return false;
    }
    *whole = transform_compose(*whole, transform);
    return true;
}

static bool make_sphere(const SphereDesc *sphere, const Transform *whole, PlanMade *made)
{
    made->is_sphere = sphere_image_radius(sphere->radius, whole, &made->radius);
    made->centre = transform_point(whole, sphere->centre);
    return !made->is_sphere || (vec3_is_finite(made->centre) && isfinite(made->radius) && made->radius > 0.0);
}

bool plan_make(const Eval *ev, const GrammarPlan *plan, const PlanNumbers *numbers, Span span, PlanMade *made)
{
    Desc record;
    Transform whole = transform_identity();
    made->material = plan->material;
    if (plan->is_at_place) {
        plan_make_at_place(plan, numbers, made);
        return true;
    }
    memcpy(&record, &plan->record, schema_kind(plan->kind)->size);
    record.part.span = span;
    for (unsigned i = 0; i < plan->input_count; i++) {
        const PlanInput *input = &plan->inputs[i];
        const double *from = numbers->items + input->first;
        if (input->argument) {
            set_argument(&record, input->argument, from);
        } else if (!is_move(input->word)) {
            plan_set_colour(&made->material, input->word, from);
        } else if (!compose(input, from, numbers->width[i], &whole)) {
            return false;
        }
    }
    if (plan->has_moves && !transform_is_finite(&whole)) {
        return false;
    }
    if (ev->options.world) {
        whole = transform_compose(whole, world_transform(ev));
    }
    bool is_stretched = plan->kind == KIND_SPHERE;
    if (is_stretched && !make_sphere(&record.sphere, &whole, made)) {
        return false;
    }
    const char *why_nothing;
    made->is_sphere = is_stretched && made->is_sphere;
    return made->is_sphere || (shape_settle(plan->kind, &record) &&
                               shape_form(plan->kind, &record, &whole, is_stretched, &made->part, &why_nothing) == SHAPE_MADE);
}

bool plan_add(Eval *ev, PlanMade *made, Span span)
{
    return made->is_sphere ? sphere_place_plain(ev, made->centre, made->radius, &made->material, span)
                           : primitive_place_plain(ev, &made->part, &made->material, span);
}
