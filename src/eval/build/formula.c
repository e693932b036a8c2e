// Functions as the renderer sees them: the tree of a function's body becomes the steps of a formula.
//
// A function that is called becomes a formula of its own, made once; what patterns and pigments it asks become records
// of the same scene. What the renderer has not is reported by name. Knows nothing of how a step is done.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"
#include "eval/build/painted.h"
#include "eval/values/function.h"
#include "math/given_surface.h"

// A function that has been made already.
typedef struct Made {
    const Function *function;
    unsigned component; // that it gives, of a spline or transform
    uint32_t first;     // of its steps
    unsigned steps;     // in all, those of calls counted in; at most FORMULA_STEPS_MOST + 1
    unsigned room;      // on the stack, not counting its arguments
} Made;

typedef ARRAY(FormulaStep) Steps;

typedef struct Maker {
    Eval *ev;
    Scene *scene;
    SchemaKind kind; // of the block that the function stands in
    Span span;
    PaintedList *painted; // NULL: patterns are the scene's
    ARRAY(Made) made;
} Maker;

// A body while it is made.
typedef struct Making {
    Maker *maker;
    Steps steps;
    unsigned used, room; // numbers on the stack now, and at most
    unsigned cost;
} Making;

static bool make(Maker *maker, const Function *function, unsigned component, Made *made);

static bool unsupported(Maker *maker, const char *what)
{
    block_unsupported(maker->ev, what, maker->span, maker->kind);
    maker->ev->faulty = true;
    return false;
}

// A step that takes so many numbers and puts one.
static bool emit(Making *body, FormulaStep step, unsigned takes)
{
    body->used = body->used - takes + 1;
    body->room = body->used > body->room ? body->used : body->room;
    body->cost++;
    return ARRAY_PUSH(&body->steps, step) || eval_no_memory(body->maker->ev, body->maker->span);
}

static bool emit_node(Making *body, const FunctionNode *node);

static bool emit_arguments(Making *body, const FunctionNode *node, unsigned *count)
{
    *count = 0;
    for (const FunctionNode *argument = node->arguments; argument != NULL; argument = argument->next, ++*count) {
        if (!emit_node(body, argument)) {
            return false;
        }
    }
    return true;
}

// ---- operators and built-in functions

static bool operator_of(const FunctionNode *node, FormulaOp *op)
{
    static const struct {
        AstOp from;
        FormulaOp to;
    } operators[] = {
        {AST_OP_ADD, FORMULA_ADD}, {AST_OP_SUB, FORMULA_SUB}, {AST_OP_MUL, FORMULA_MUL}, {AST_OP_DIV, FORMULA_DIV},
        {AST_OP_EQ, FORMULA_EQ},   {AST_OP_NE, FORMULA_NE},   {AST_OP_LT, FORMULA_LT},   {AST_OP_LE, FORMULA_LE},
        {AST_OP_GT, FORMULA_GT},   {AST_OP_GE, FORMULA_GE},   {AST_OP_AND, FORMULA_AND}, {AST_OP_OR, FORMULA_OR},
        {AST_OP_NEG, FORMULA_NEG},
    };
    for (size_t i = 0; i < RT_COUNT_OF(operators); i++) {
        if (node->run == function_operator(operators[i].from)) {
            *op = operators[i].to;
            return true;
        }
    }
    return false;
}

static FormulaOp builtin_of(Word word)
{
    static const struct {
        Word word;
        FormulaOp op;
    } builtins[] = {
        {W_abs, FORMULA_ABS},         {W_sin, FORMULA_SIN},         {W_cos, FORMULA_COS},     {W_tan, FORMULA_TAN},
        {W_asin, FORMULA_ASIN},       {W_acos, FORMULA_ACOS},       {W_atan, FORMULA_ATAN},   {W_sinh, FORMULA_SINH},
        {W_cosh, FORMULA_COSH},       {W_tanh, FORMULA_TANH},       {W_asinh, FORMULA_ASINH}, {W_acosh, FORMULA_ACOSH},
        {W_atanh, FORMULA_ATANH},     {W_exp, FORMULA_EXP},         {W_ln, FORMULA_LN},       {W_log, FORMULA_LOG},
        {W_sqrt, FORMULA_SQRT},       {W_floor, FORMULA_FLOOR},     {W_ceil, FORMULA_CEIL},   {W_int, FORMULA_INT},
        {W_degrees, FORMULA_DEGREES}, {W_radians, FORMULA_RADIANS}, {W_atan2, FORMULA_ATAN2}, {W_pow, FORMULA_POW},
        {W_mod, FORMULA_MOD},         {W_div, FORMULA_QUOTIENT},    {W_min, FORMULA_MIN},     {W_max, FORMULA_MAX},
        {W_select, FORMULA_SELECT3},
    };
    for (size_t i = 0; i < RT_COUNT_OF(builtins); i++) {
        if (builtins[i].word == word) {
            return builtins[i].op;
        }
    }
    return FORMULA_OPS;
}

// The least and the greatest of more than two numbers are those of two, again and again.
static bool emit_extreme(Making *body, const FunctionNode *node, FormulaOp op)
{
    const FunctionNode *argument = node->arguments;
    if (!emit_node(body, argument)) {
        return false;
    }
    while ((argument = argument->next) != NULL) {
        if (!emit_node(body, argument) || !emit(body, (FormulaStep){.op = op}, 2)) {
            return false;
        }
    }
    return true;
}

static bool emit_builtin(Making *body, const FunctionNode *node)
{
    unsigned count;
    FormulaOp op = builtin_of((Word)node->slot);
    if (op == FORMULA_OPS) {
        return unsupported(body->maker, eval_text(body->maker->ev, (Symbol)node->slot));
    }
    if (op == FORMULA_MIN || op == FORMULA_MAX) {
        return emit_extreme(body, node, op);
    }
    if (!emit_arguments(body, node, &count)) {
        return false;
    }
    return emit(body, (FormulaStep){.op = op == FORMULA_SELECT3 && count == 4 ? FORMULA_SELECT4 : op}, count);
}

// ---- calls

static bool emit_painted(Making *body, const FunctionNode *node)
{
    const Function *function = node->function;
    Maker *maker = body->maker;
    Pigment pigment;
    if (!painted_place(maker->ev, maker->scene, function->painted, maker->span, &pigment)) {
        return false;
    }
    FormulaStep step = {.op = function->kind == FUNCTION_PATTERN ? FORMULA_PATTERN : FORMULA_PIGMENT,
                        .which = pigment.pattern,
                        .number = node->slot};
    if (pigment.pattern == RECORD_NONE) { // of one colour
        return unsupported(maker, "pigment");
    }
    if (maker->painted) {
        step.which = (uint32_t)maker->painted->count;
        if (!ARRAY_PUSH(maker->painted, function->painted)) {
            return eval_no_memory(maker->ev, maker->span);
        }
    }
    return emit(body, step, 3);
}

static bool emit_call(Making *body, const FunctionNode *node)
{
    const Function *function = node->function;
    unsigned count;
    Made made;
    if (!emit_arguments(body, node, &count)) {
        return false;
    }
    if (function->painted != NULL) {
        return emit_painted(body, node);
    }
    if (function->kind == FUNCTION_UNSUPPORTED) {
        return unsupported(body->maker, function->word);
    }
    if (!make(body->maker, function, function->kind == FUNCTION_NUMBER ? 0 : node->slot, &made)) {
        return false;
    }
    body->cost += made.steps;
    body->room = body->used + made.room > body->room ? body->used + made.room : body->room;
    return emit(body, (FormulaStep){.op = FORMULA_CALL, .which = made.first, .number = count}, count);
}

// The distance from the origin, less the fourth argument for a sphere.
static bool emit_distance(Making *body, bool is_sphere)
{
    for (unsigned slot = 0; slot < 3; slot++) {
        if (!emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = slot}, 0) ||
            !emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = slot}, 0) ||
            !emit(body, (FormulaStep){.op = FORMULA_MUL}, 2) ||
            (slot > 0 && !emit(body, (FormulaStep){.op = FORMULA_ADD}, 2))) {
            return false;
        }
    }
    return emit(body, (FormulaStep){.op = FORMULA_SQRT}, 1) &&
           (!is_sphere || (emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = 3}, 0) &&
                           emit(body, (FormulaStep){.op = FORMULA_SUB}, 2)));
}

// What functions.inc gives.
static bool emit_given(Making *body, const FunctionNode *node)
{
    enum { R = 57, SPHERE = 61, NOISE = 76, NOISE_CHOSEN = 78 };
    bool is_chosen = node->number == NOISE_CHOSEN;
    if (node->number == R || node->number == SPHERE) {
        return emit_distance(body, node->number == SPHERE);
    }
    unsigned given = given_surface_arguments((unsigned)node->number);
    if (node->number != NOISE && !is_chosen && given == 0) {
        return unsupported(body->maker, "internal");
    }
    unsigned count = given > 0 ? given : is_chosen ? 4 : 3;
    for (unsigned slot = 0; slot < count; slot++) {
        if (!emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = slot}, 0)) {
            return false;
        }
    }
    if (given > 0) {
        return emit(body, (FormulaStep){.op = FORMULA_GIVEN, .which = (uint32_t)node->number, .number = given}, given);
    }
    return emit(body, (FormulaStep){.op = is_chosen ? FORMULA_NOISE_CHOSEN : FORMULA_NOISE}, count);
}

static bool emit_node(Making *body, const FunctionNode *node)
{
    FormulaOp op;
    unsigned count;
    if (!eval_step(body->maker->ev, body->maker->span)) {
        return false;
    }
    if (node->run == function_run_number) {
        return emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = node->number}, 0);
    }
    if (node->run == function_run_slot) {
        return emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = node->slot}, 0);
    }
    if (node->run == function_run_call) {
        return emit_call(body, node);
    }
    if (node->run == function_run_sum || node->run == function_run_product) {
        return unsupported(body->maker, node->run == function_run_sum ? "sum" : "prod");
    }
    if (node->run == function_operator(AST_OP_PLUS)) {
        return emit_node(body, node->arguments);
    }
    if (operator_of(node, &op)) {
        return emit_arguments(body, node, &count) && emit(body, (FormulaStep){.op = op}, count);
    }
    return node->slot == W_internal ? emit_given(body, node) : emit_builtin(body, node);
}

// ---- splines and transforms

// A sum of powers of t - from, `sums` being what stands before them, lowest first.
static bool emit_powers(Making *body, double from, const double sums[static 4])
{
    bool fine = emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = sums[3]}, 0);
    for (unsigned power = 3; power-- > 0;) {
        fine = fine && emit(body, (FormulaStep){.op = FORMULA_SLOT}, 0) &&
               emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = from}, 0) &&
               emit(body, (FormulaStep){.op = FORMULA_SUB}, 2) && emit(body, (FormulaStep){.op = FORMULA_MUL}, 2) &&
               emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = sums[power]}, 0) &&
               emit(body, (FormulaStep){.op = FORMULA_ADD}, 2);
    }
    return fine;
}

// Between two points each curve is a polynomial of the third degree at most, which four of its values determine: by
// divided differences (I. Newton), around the first of the places.
static bool emit_piece(Making *body, const Spline *spline, unsigned component, unsigned before)
{
    double start = spline->points[before].t, width = spline->points[before + 1].t - start;
    double places[4], sums[4], v[5];
    for (unsigned i = 0; i < 4; i++) {
        places[i] = start + width * (2 * i + 1) / 8.0;
        spline_at(spline, spline->type, places[i], v);
        sums[i] = v[component];
    }
    for (unsigned order = 1; order < 4; order++) {
        for (unsigned i = 3; i >= order; i--) {
            sums[i] = (sums[i] - sums[i - 1]) / (places[i] - places[i - order]);
        }
    }
    for (unsigned order = 2; order > 0; order--) { // from differences at the places to powers around the first
        for (unsigned i = order; i < 3; i++) {
            sums[i] += sums[i + 1] * (places[0] - places[order]);
        }
    }
    return emit_powers(body, places[0], sums);
}

// What lies from one of a spline's points on up to another, and beyond the first and the last of all: halved again and
// again.
static bool emit_pieces(Making *body, const Spline *spline, unsigned component, unsigned first, unsigned end)
{
    double v[5];
    if (first == end) {
        bool is_first = first == 0;
        if (!is_first && first < spline->count) {
            return emit_piece(body, spline, component, first - 1);
        }
        spline_at(spline, spline->type, spline->points[is_first ? 0 : first - 1].t, v);
        return emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = v[component]}, 0);
    }
    unsigned middle = first + (end - first) / 2;
    return emit(body, (FormulaStep){.op = FORMULA_SLOT}, 0) &&
           emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = spline->points[middle].t}, 0) &&
           emit(body, (FormulaStep){.op = FORMULA_SUB}, 2) && emit_pieces(body, spline, component, first, middle) &&
           emit_pieces(body, spline, component, middle + 1, end) && emit(body, (FormulaStep){.op = FORMULA_SELECT3}, 3);
}

static bool emit_transform(Making *body, const Transform *transform, unsigned component)
{
    bool fine = emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = transform->m[3][component]}, 0);
    for (unsigned slot = 0; slot < 3; slot++) {
        fine = fine && emit(body, (FormulaStep){.op = FORMULA_SLOT, .which = slot}, 0) &&
               emit(body, (FormulaStep){.op = FORMULA_NUMBER, .number = transform->m[slot][component]}, 0) &&
               emit(body, (FormulaStep){.op = FORMULA_MUL}, 2) && emit(body, (FormulaStep){.op = FORMULA_ADD}, 2);
    }
    return fine;
}

// ---- functions

static bool emit_function(Making *body, const Function *function, unsigned component)
{
    switch (function->kind) {
    case FUNCTION_SPLINE:
        return emit_pieces(body, function->spline, component, 0, function->spline->count);
    case FUNCTION_TRANSFORM:
        return emit_transform(body, &function->transform, component);
    default:
        return emit_node(body, function->body);
    }
}

static bool add_steps(Maker *maker, const Steps *steps, uint32_t *first)
{
    *first = RECORD_NONE;
    for (size_t i = steps->count; i-- > 0;) {
        FormulaStep step = steps->items[i];
        step.next = *first;
        if (!scene_add_formula_step(maker->scene, &step, first)) {
            return eval_no_memory(maker->ev, maker->span);
        }
    }
    return true;
}

static bool make_body(Maker *maker, const Function *function, unsigned component, Made *made)
{
    Making body = {.maker = maker};
    bool fine = emit_function(&body, function, component) && add_steps(maker, &body.steps, &made->first);
    ARRAY_FREE(&body.steps);
    made->function = function;
    made->component = component;
    made->steps = body.cost < FORMULA_STEPS_MOST ? body.cost : FORMULA_STEPS_MOST + 1;
    made->room = body.room;
    if (fine && made->steps > FORMULA_STEPS_MOST) {
        return eval_fault(maker->ev, DIAG_E0606, maker->span, "a function that takes more than %d steps",
                          (int)FORMULA_STEPS_MOST);
    }
    if (fine && made->room > FORMULA_STACK_MOST) {
        return eval_fault(maker->ev, DIAG_E0606, maker->span, "a function that holds more than %d numbers at a time",
                          (int)FORMULA_STACK_MOST);
    }
    return fine;
}

static bool make(Maker *maker, const Function *function, unsigned component, Made *made)
{
    for (size_t i = 0; i < maker->made.count; i++) {
        if (maker->made.items[i].function == function && maker->made.items[i].component == component) {
            *made = maker->made.items[i];
            return true;
        }
    }
    return make_body(maker, function, component, made) &&
           (ARRAY_PUSH(&maker->made, *made) || eval_no_memory(maker->ev, maker->span));
}

// A function that is made of a pattern or pigment is called by one that is not.
static bool make_outer(Maker *maker, const Function *function, Made *made)
{
    FunctionNode slots[3] = {{.run = function_run_slot, .next = &slots[1], .slot = 0},
                             {.run = function_run_slot, .next = &slots[2], .slot = 1},
                             {.run = function_run_slot, .slot = 2}};
    FunctionNode call = {.run = function_run_call, .arguments = slots, .function = function, .slot = 0};
    if (function->kind == FUNCTION_SPLINE || function->kind == FUNCTION_TRANSFORM) { // of several numbers
        return unsupported(maker, function->kind == FUNCTION_SPLINE ? "spline" : "transform");
    }
    Function outer = {.kind = FUNCTION_NUMBER, .parameter_count = 3, .body = &call};
    return function->kind == FUNCTION_NUMBER ? make(maker, function, 0, made) : make_body(maker, &outer, 0, made);
}

bool formula_make(Eval *ev, Scene *scene, const Function *function, FormulaBlock in, uint32_t *first,
                  PaintedList *painted)
{
    Maker maker = {.ev = ev, .scene = scene, .kind = in.kind, .span = in.span, .painted = painted};
    Made made = {.first = RECORD_NONE};
    unsigned height = function->body ? function->body->height : 1;
    if (!eval_deepen(ev, height, in.span)) {
        return false;
    }
    bool fine = make_outer(&maker, function, &made);
    eval_shallow(ev, height);
    ARRAY_FREE(&maker.made);
    *first = made.first;
    return fine;
}

bool formula_place(Eval *ev, Scene *scene, const Function *function, Span span, uint32_t *first)
{
    return formula_make(ev, scene, function, (FormulaBlock){KIND_PATTERN, span}, first, NULL);
}
