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

static bool is_constant(const AstNode *colour)
{
    bool is_fine = colour->kind == AST_NUMBER || colour->kind == AST_VECTOR;
    for (const AstNode *part = colour->kind == AST_VECTOR ? colour->a : NULL; part && is_fine; part = part->next) {
        is_fine = part->kind == AST_NUMBER;
    }
    return is_fine;
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
    repeat->colour = repeat->colour && is_constant(repeat->colour) ? NULL : repeat->colour; // the material has it
    repeat->is_quick = quick_is_flat(repeat->centre) && quick_is_flat(repeat->radius) &&
                       (!repeat->colour || quick_is_flat(repeat->colour));
}

// What a turn gives: where the sphere is, how large, and of which colour.
typedef struct Turn {
    double centre[3], radius, colour[3];
} Turn;

static bool is_finite(const double *three)
{
    return isfinite(three[0]) && isfinite(three[1]) && isfinite(three[2]);
}


// A vector of three numbers, or, where `takes_number`, one for all.
static bool take_three(Eval *ev, const AstNode *node, bool takes_number, double *three)
{
    Value value;
    if (!eval_expression(ev, node, &value)) {
        return false;
    }
    if (takes_number && value.kind == VALUE_NUMBER) {
        three[0] = three[1] = three[2] = value.number;
        return true;
    }
    if (value.kind != VALUE_VECTOR || value.components != 3) {
        return false;
    }
    memcpy(three, value.v, 3 * sizeof *three);
    return true;
}

static bool is_fine_radius(double radius)
{
    return radius > 0.0 && isfinite(radius);
}

static bool is_fine_colour(const double *colour)
{
    return fabs(colour[0]) <= COLOUR_USUAL && fabs(colour[1]) <= COLOUR_USUAL && fabs(colour[2]) <= COLOUR_USUAL;
}

// Nothing is worked out after what is not fine: the statement itself is to tell first what is wrong with that.
static bool take_values(Eval *ev, const Repeat *repeat, Turn *turn)
{
    Value value;
    if (!take_three(ev, repeat->centre, false, turn->centre) || !is_finite(turn->centre) ||
        !eval_expression(ev, repeat->radius, &value) || value.kind != VALUE_NUMBER || !is_fine_radius(value.number)) {
        return false;
    }
    turn->radius = value.number;
    return !repeat->colour || (take_three(ev, repeat->colour, true, turn->colour) && is_fine_colour(turn->colour));
}

static bool take_usually(Eval *ev, const Repeat *repeat, Turn *turn)
{
    ArenaMark mark = scratch_mark(ev);
    bool is_taken = take_values(ev, repeat, turn);
    scratch_rewind(ev, mark);
    return is_taken;
}

// The states of all random numbers.
typedef struct Streams {
    size_t count;
    uint32_t states[REPEAT_STREAMS];
} Streams;

static void streams_keep(const Eval *ev, Streams *kept)
{
    kept->count = ev->streams.count;
    for (size_t i = 0; i < kept->count; i++) {
        kept->states[i] = ev->streams.items[i];
    }
}

static void streams_take_back(Eval *ev, const Streams *kept)
{
    ev->streams.count = kept->count;
    for (size_t i = 0; i < kept->count; i++) {
        ev->streams.items[i] = kept->states[i];
    }
}

static bool take_quickly(Eval *ev, const Repeat *repeat, Turn *turn)
{
    return quick_three_of(ev, repeat->centre, true, turn->centre) == 3 && is_finite(turn->centre) &&
           quick_number_of(ev, repeat->radius, true, &turn->radius) && is_fine_radius(turn->radius) &&
           (!repeat->colour ||
            (quick_three_of(ev, repeat->colour, true, turn->colour) && is_fine_colour(turn->colour)));
}

static bool take(Eval *ev, Repeat *repeat, const Streams *kept, Turn *turn)
{
    if (repeat->is_quick && quick_has_room(ev)) {
        if (take_quickly(ev, repeat, turn)) {
            return true;
        }
        streams_take_back(ev, kept);
        repeat->is_quick = false; // what is refused once is refused again, most likely
    }
    return take_usually(ev, repeat, turn);
}

bool repeat_place(Eval *ev, const AstNode *sphere, bool *is_fine)
{
    Repeat *repeat = place_of(ev, sphere);
    Streams kept;
    Turn turn;
    if (ev->streams.count > REPEAT_STREAMS) {
        return false;
    }
    streams_keep(ev, &kept);
    if (!take(ev, repeat, &kept, &turn)) {
        repeat->is_known = false;
        streams_take_back(ev, &kept);
        return false;
    }
    Material material = repeat->material;
    if (repeat->colour) {
        material.red = (float)turn.colour[0];
        material.green = (float)turn.colour[1];
        material.blue = (float)turn.colour[2];
    }
    // A zero is positive, as it is behind any transform.
    Vec3 at = {turn.centre[0] + 0.0, turn.centre[1] + 0.0, turn.centre[2] + 0.0};
    *is_fine = sphere_place_plain(ev, at, turn.radius, &material, sphere->span);
    return true;
}

// ---- turns of loops

// Whether a loop's body is nothing but spheres and what gives names their values.
static bool is_simple(const AstNode *body)
{
    for (const AstNode *item = body; item; item = item->next) {
        bool is_sphere = item->kind == AST_BLOCK && item->symbol == W_sphere;
        if (!is_sphere && item->kind != AST_READ && item->kind != AST_DECLARE) {
            return false;
        }
    }
    return true;
}

// False: nothing was done, or the evaluation stops.
static bool run_item(Cursor *cursor, const AstNode *item)
{
    Eval *ev = cursor->ev;
    if (item->kind != AST_BLOCK) {
        return directive_run(cursor, item);
    }
    const Repeat *repeat = place_of(ev, item);
    bool is_known = repeat->node == item && repeat->begin == item->span.begin && repeat->state == ev->literal.state &&
                    repeat->is_known;
    bool is_fine;
    if (!is_known || !repeat_place(ev, item, &is_fine)) {
        return false;
    }
    ev->has_stray = false;
    ev->faulty = ev->faulty || !is_fine;
    return true;
}

void repeat_turns(Cursor *cursor)
{
    Eval *ev = cursor->ev;
    CursorFrame *frame = cursor->frame;
    bool is_loop = frame && (frame->kind == FRAME_WHILE || frame->kind == FRAME_FOR) && !frame->next && !frame->stream;
    const AstNode *body = !is_loop ? NULL : frame->kind == FRAME_WHILE ? frame->node->b : frame->node->c;
    if (!body || ev->options.no_literals || !is_simple(body)) {
        return;
    }
    while (!ev->stop) {
        if (!loop_continues(ev, frame)) {
            cursor_pop(cursor);
            return;
        }
        for (const AstNode *item = body; item; item = item->next) {
            frame->next = item->next;
            if (ev->stop || !run_item(cursor, item)) {
                frame->next = item;
                return;
            }
        }
    }
}
