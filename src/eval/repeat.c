// Spheres that a loop or a macro places again and again: their three expressions are worked out, nothing else.
//
// A statement `sphere { CENTRE, RADIUS pigment { rgb COLOUR } finish { … } }` in which all but these is fixed is
// evaluated like any other twice; when the second time gave one plain sphere and no message, the next ones differ in
// centre, radius and colour only. A value that is not of the usual kind takes all back, random numbers too, and the
// statement goes the usual way: so there is one meaning only. Knows nothing of text.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/blocks.h"

// Beyond this a colour is left to the statements that say what is wrong with it.
#define COLOUR_GREATEST 1e30

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

// The expression of `pigment { rgb … }`; NULL: something else.
static const AstNode *colour_of(const AstNode *pigment)
{
    const AstNode *word = pigment->a;
    if (word && word->kind == AST_WORD && (word->symbol == W_color || word->symbol == W_colour)) {
        word = word->next;
    }
    const AstNode *colour = word && word->kind == AST_WORD && word->symbol == W_rgb ? word->next : NULL;
    return colour && !colour->next && is_plain(colour) ? colour : NULL;
}

static bool is_fixed(const AstNode *finish)
{
    for (const AstNode *node = finish->a; node; node = node->next) {
        if (node->kind != AST_NUMBER && (node->kind != AST_WORD || word_class(node->symbol) != WORD_PLAIN)) {
            return false;
        }
    }
    return true;
}

// Finds the expressions of a statement. False: it is of another form.
static bool take_apart(const AstNode *sphere, Repeat *repeat)
{
    repeat->centre = sphere->a;
    repeat->radius = sphere->a ? sphere->a->next : NULL;
    repeat->colour = NULL;
    if (!repeat->radius || !is_plain(repeat->centre) || !is_plain(repeat->radius)) {
        return false;
    }
    for (const AstNode *item = repeat->radius->next; item; item = item->next) {
        bool is_pigment = item->kind == AST_BLOCK && item->symbol == W_pigment && !repeat->colour;
        if (is_pigment && (repeat->colour = colour_of(item)) != NULL) {
            continue;
        }
        if (item->kind != AST_BLOCK || item->symbol != W_finish || !is_fixed(item)) {
            return false;
        }
    }
    return true;
}

static Repeat *place_of(Eval *ev, const AstNode *sphere)
{
    return &ev->repeats[(sphere->span.begin ^ sphere->span.begin >> 7) % REPEATS];
}

static size_t message_count(const Eval *ev)
{
    return ev->options.diags->error_count + ev->options.diags->warning_count;
}

RepeatStep repeat_step(Eval *ev, const AstNode *sphere)
{
    Repeat *repeat = place_of(ev, sphere);
    if (repeat->node != sphere || repeat->begin != sphere->span.begin || repeat->state != ev->literal.state) {
        *repeat = (Repeat){.node = sphere, .begin = sphere->span.begin, .state = ev->literal.state};
        return REPEAT_NONE;
    }
    if (!repeat->is_tried) {
        repeat->is_tried = true;
        repeat->spheres = ev->scene->spheres.count;
        repeat->shapes = ev->scene->shape_count;
        repeat->messages = message_count(ev);
        return !ev->options.world && take_apart(sphere, repeat) ? REPEAT_WATCH : REPEAT_NONE;
    }
    return repeat->is_known ? REPEAT_KNOWN : REPEAT_NONE;
}

void repeat_learn(Eval *ev, const AstNode *sphere, bool is_plain_object)
{
    Repeat *repeat = place_of(ev, sphere);
    const Scene *scene = ev->scene;
    if (!is_plain_object || ev->stop || repeat->node != sphere || message_count(ev) != repeat->messages ||
        scene->shape_count != repeat->shapes + 1 || scene->spheres.count != repeat->spheres + 1) {
        return;
    }
    MaterialIndex material = scene->spheres.items[repeat->spheres].material;
    repeat->is_known = !(material & MATERIAL_COMPOUND);
    repeat->material = repeat->is_known ? scene->materials.items[material] : repeat->material;
}

// A vector of three finite numbers, or, where `takes_number`, one for all.
static bool take_three(Eval *ev, const AstNode *node, bool takes_number, double *three)
{
    Value value;
    if (!eval_expression(ev, node, &value)) {
        return false;
    }
    if (takes_number && value.kind == VALUE_NUMBER) {
        three[0] = three[1] = three[2] = value.number;
    } else if (value.kind == VALUE_VECTOR && value.components == 3) {
        memcpy(three, value.v, 3 * sizeof *three);
    } else {
        return false;
    }
    return isfinite(three[0]) && isfinite(three[1]) && isfinite(three[2]);
}

static bool take_values(Eval *ev, const Repeat *repeat, double *centre, double *radius, Material *material)
{
    Value value;
    double colour[3];
    if (!take_three(ev, repeat->centre, false, centre) || !eval_expression(ev, repeat->radius, &value) ||
        value.kind != VALUE_NUMBER || !(value.number > 0.0) || !isfinite(value.number)) {
        return false;
    }
    *radius = value.number;
    *material = repeat->material;
    if (repeat->colour) {
        if (!take_three(ev, repeat->colour, true, colour) || !(fabs(colour[0]) <= COLOUR_GREATEST) ||
            !(fabs(colour[1]) <= COLOUR_GREATEST) || !(fabs(colour[2]) <= COLOUR_GREATEST)) {
            return false;
        }
        material->red = (float)colour[0];
        material->green = (float)colour[1];
        material->blue = (float)colour[2];
    }
    return true;
}

bool repeat_place(Eval *ev, const AstNode *sphere, bool *is_fine)
{
    Repeat repeat = *place_of(ev, sphere); // an expression places nothing
    uint32_t streams[REPEAT_STREAMS];
    size_t stream_count = ev->streams.count;
    double centre[3], radius;
    Material material;
    if (stream_count > REPEAT_STREAMS) {
        return false;
    }
    if (stream_count > 0) {
        memcpy(streams, ev->streams.items, stream_count * sizeof *streams);
    }
    ArenaMark mark = arena_mark(&ev->scratch);
    bool is_taken = take_values(ev, &repeat, centre, &radius, &material);
    arena_rewind(&ev->scratch, mark);
    if (!is_taken) {
        place_of(ev, sphere)->is_known = false;
        ev->streams.count = stream_count;
        if (stream_count > 0) {
            memcpy(ev->streams.items, streams, stream_count * sizeof *streams);
        }
        return false;
    }
    // A zero is positive, as it is behind any transform.
    Vec3 at = {centre[0] + 0.0, centre[1] + 0.0, centre[2] + 0.0};
    *is_fine = sphere_place_plain(ev, at, radius, &material, sphere->span);
    return true;
}
