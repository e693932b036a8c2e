// The body of a function becomes a tree of nodes that compute.
//
// Names that are no parameters are taken as the text is read, as POV-Ray takes them: where directives and macros stand
// in the body, it has been read token by token (paste_function), and each name knows what it stood for then. A body that
// holds what rtlang has not makes a function that is a fault where it is called.
//
// Numbers that follow one another in a chain of operators of one rank are joined as POV-Ray joins them, and these are
// not always the values of ordinary arithmetic: docs/language.md, "Functions of your own", has the rule.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/suggest.h"
#include "scene/description.h"
#include "eval/run/callable.h"

enum { CALL_HEIGHT = 8 }; // of native recursion, see eval_deepen

typedef FunctionBody Compiler;

typedef FunctionNode *(*CompileFn)(Compiler *compiler, const AstNode *node);

static FunctionNode *compile(Compiler *compiler, const AstNode *node);

// ---- nodes

static FunctionNode *new_node(Compiler *compiler, const AstNode *at, FunctionNodeFn run)
{
    FunctionNode *node = arena_alloc(&compiler->ev->program, sizeof *node);
    if (node == NULL) {
        eval_no_memory(compiler->ev, at->span);
        return NULL;
    }
    *node = (FunctionNode){.run = run, .height = 1, .size = 1};
    return node;
}

static FunctionNode *number_node(Compiler *compiler, const AstNode *at, double number)
{
    FunctionNode *node = new_node(compiler, at, function_run_number);
    if (node != NULL) {
        node->number = number;
        node->is_constant = true;
    }
    return node;
}

// Arguments are linked by `next`. NULL in, NULL out.
static FunctionNode *with_arguments(FunctionNode *node, FunctionNode *first)
{
    if (node == NULL) {
        return NULL;
    }
    node->arguments = first;
    node->is_constant = true;
    for (const FunctionNode *argument = first; argument != NULL; argument = argument->next) {
        node->height = argument->height >= node->height ? argument->height + 1 : node->height;
        node->size += argument->size;
        node->count++;
        node->is_constant = node->is_constant && argument->is_constant;
    }
    return node;
}

// A number that stands without parentheses, or what such numbers alone make.
static bool is_bare_number(const FunctionNode *made, const AstNode *node)
{
    return made->run == function_run_number && made->is_constant && !(node->flags & AST_IN_PARENTHESES);
}

static FunctionNode *fault_body(Compiler *compiler, const AstNode *node, const char *what, const char *advice)
{
    Eval *ev = compiler->ev;
    if (eval_report(ev, DIAG_E0261, node->span, "%s cannot stand in the body of a function", what) && advice != NULL) {
        diag_suggest(ev->options.diags, "%s", advice);
    }
    return NULL;
}

static FunctionNode *fault_word(Compiler *compiler, const AstNode *node, const char *advice)
{
    Eval *ev = compiler->ev;
    if (eval_report(ev, DIAG_E0261, node->span, "`%s` cannot stand in the body of a function",
                    eval_text(ev, node->symbol)) &&
        advice != NULL) {
        diag_suggest(ev->options.diags, "%s", advice);
    }
    return NULL;
}

// ---- names

// u is another name of x, and v of y.
Symbol function_slot_name(Symbol symbol)
{
    return symbol == W_u ? W_x : symbol == W_v ? W_y : symbol;
}

const Value *function_meaning(const Eval *ev, const AstNode *name)
{
    return name->flags & AST_KNOWN ? name->known : scope_find(ev, name->symbol);
}

static bool find_slot(const Compiler *compiler, Symbol symbol, unsigned *slot)
{
    for (unsigned i = compiler->count; i-- > 0;) {
        if (compiler->names[i] == function_slot_name(symbol)) {
            *slot = i;
            return true;
        }
    }
    return false;
}

static FunctionNode *slot_node(Compiler *compiler, const AstNode *at, unsigned slot)
{
    FunctionNode *node = new_node(compiler, at, function_run_slot);
    if (node != NULL) {
        node->slot = slot;
    }
    return node;
}

// The parameters are offered before all else.
static void fault_undeclared(Compiler *compiler, const AstNode *node)
{
    Eval *ev = compiler->ev;
    Suggest suggest;
    if (ev->include_is_missing || !eval_report(ev, DIAG_E0201, node->span, "`%s` is neither a parameter nor declared",
                                               eval_text(ev, node->symbol))) {
        return;
    }
    suggest_begin(&suggest, eval_text(ev, node->symbol));
    for (unsigned i = 0; i < compiler->count; i++) {
        suggest_offer(&suggest, eval_text(ev, compiler->names[i]));
    }
    if (suggest.best == NULL) {
        suggest = scope_nearest(ev, node);
    }
    if (suggest.best != NULL) {
        diag_did_you_mean(ev->options.diags, node->span, suggest.best);
    }
}

static FunctionNode *constant_value(Compiler *compiler, const AstNode *node, const Value *value)
{
    if (value->kind == VALUE_NONE) {
        return NULL;
    }
    if (value->kind != VALUE_NUMBER) {
        return fault_body(compiler, node, value_describe(value),
                          value_is_tuple(value) ? "declare the component that is needed as a number first" : NULL);
    }
    return number_node(compiler, node, value->number);
}

static FunctionNode *compile_name(Compiler *compiler, const AstNode *node)
{
    unsigned slot;
    const Value *found = function_meaning(compiler->ev, node);
    bool is_own = found == NULL || !(node->flags & AST_KNOWN);
    // What a directive in the body has declared hides a parameter of that name.
    if (is_own && find_slot(compiler, node->symbol, &slot)) {
        return slot_node(compiler, node, slot);
    }
    if (found == NULL) {
        fault_undeclared(compiler, node);
        return NULL;
    }
    return constant_value(compiler, node, found);
}

static FunctionNode *compile_constant(Compiler *compiler, const AstNode *node)
{
    unsigned slot;
    Value value;
    if (find_slot(compiler, node->symbol, &slot)) {
        return slot_node(compiler, node, slot);
    }
    if (node->symbol == W_pi || node->symbol == W_clock) {
        return builtin_constant(compiler->ev, node, &value) ? constant_value(compiler, node, &value) : NULL;
    }
    Symbol name = function_slot_name(node->symbol);
    if (name == W_x || name == W_y || name == W_z) {
        FunctionNode *zero = number_node(compiler, node, 0.0); // as POV-Ray: a coordinate that is no parameter is zero
        if (zero != NULL) {
            zero->is_constant = false;
        }
        return zero;
    }
    return fault_word(compiler, node, "write its number, or declare it under another name");
}

static FunctionNode *compile_element(Compiler *compiler, const AstNode *node)
{
    Value value;
    return eval_expression(compiler->ev, node, &value) ? constant_value(compiler, node, &value) : NULL;
}

// ---- operators

static FunctionNode *compile_number(Compiler *compiler, const AstNode *node)
{
    return number_node(compiler, node, node->number);
}

static FunctionNode *compile_unary(Compiler *compiler, const AstNode *node)
{
    if (node->op == AST_OP_NOT) {
        return fault_body(compiler, node, "`!`", "write `(… = 0)`");
    }
    if (node->a->kind == AST_UNARY && !(node->a->flags & AST_IN_PARENTHESES)) {
        return fault_body(compiler, node, "a second sign", "put the value with its sign in parentheses");
    }
    FunctionNode *operand = compile(compiler, node->a);
    if (operand == NULL) {
        return NULL;
    }
    if (is_bare_number(operand, node->a)) {
        operand->number = node->op == AST_OP_NEG ? 0.0 - operand->number : operand->number; // -0 is 0, as in POV-Ray
        return operand;
    }
    return with_arguments(new_node(compiler, node, function_operator((AstOp)node->op)), operand);
}

static FunctionNode *join(Compiler *compiler, const AstNode *at, AstOp op, FunctionNode *left, FunctionNode *right)
{
    if (left == NULL || right == NULL) {
        return NULL;
    }
    left->next = right;
    return with_arguments(new_node(compiler, at, function_operator(op)), left);
}

static bool is_logic(const AstNode *node)
{
    return node->kind == AST_BINARY && (node->op == AST_OP_AND || node->op == AST_OP_OR);
}

// Elsewhere `&` and `|` are of one rank and taken from the left; here `&` comes first. *sum is what `|` has joined so
// far, or NULL, *last what `&` has joined since.
static bool split_logic(Compiler *compiler, const AstNode *node, FunctionNode **sum, FunctionNode **last)
{
    if (is_logic(node->a) && !(node->a->flags & AST_IN_PARENTHESES)) {
        if (!split_logic(compiler, node->a, sum, last)) {
            return false;
        }
    } else {
        *sum = NULL;
        *last = compile(compiler, node->a);
    }
    FunctionNode *right = compile(compiler, node->b);
    if (*last == NULL || right == NULL) {
        return false;
    }
    if (node->op == AST_OP_AND) {
        *last = join(compiler, node, AST_OP_AND, *last, right);
        return *last != NULL;
    }
    *sum = *sum == NULL ? *last : join(compiler, node, AST_OP_OR, *sum, *last);
    *last = right;
    return *sum != NULL;
}

// A chain of operators of one rank, read from the left: a - 3 * 2 + 10 is one of three parts.
typedef struct Chain {
    FunctionNode *before; // what its parts have made so far, without `number`; NULL: nothing
    FunctionNode *number; // that bare numbers have made, and that the next one may join; NULL: the last part is none
    AstOp op;             // between the two
    const AstNode *at;    // of that operator; NULL: `number` is the first part
    bool has_variable;    // among its parts
} Chain;

static int rank_of(AstOp op)
{
    return op == AST_OP_ADD || op == AST_OP_SUB ? 1 : op == AST_OP_MUL || op == AST_OP_DIV ? 2 : 0;
}

static double of_numbers(AstOp op, double left, double right)
{
    FunctionNode second = {.run = function_run_number, .number = right};
    FunctionNode first = {.run = function_run_number, .number = left, .next = &second};
    FunctionNode both = {.arguments = &first};
    return function_operator(op)(&both, NULL);
}

static bool end_number(Compiler *compiler, Chain *chain)
{
    FunctionNode *number = chain->number;
    chain->number = NULL;
    if (number == NULL) {
        return true;
    }
    number->number += 0.0; // -0 is 0, as in POV-Ray
    if (chain->at == NULL) {
        chain->before = number;
        return true;
    }
    if (chain->op == AST_OP_DIV) {
        if (number->number == 0.0) {
            return eval_fault(compiler->ev, DIAG_E0350, chain->at->b->span, "a function cannot divide by 0");
        }
        number->number = 1.0 / number->number;
        chain->op = AST_OP_MUL;
    }
    chain->before = join(compiler, chain->at, chain->op, chain->before, number);
    return chain->before != NULL;
}

// `at` is the operator before the part, or NULL.
static bool add_number(Compiler *compiler, Chain *chain, const AstNode *at, const AstNode *part, FunctionNode *made)
{
    AstOp op = at == NULL ? AST_OP_ADD : (AstOp)at->op;
    bool joins = chain->number != NULL && !compiler->keeps_numbers && !(chain->has_variable && rank_of(op) == 2);
    if (joins) {
        if (op == AST_OP_DIV && made->number == 0.0) {
            return eval_fault(compiler->ev, DIAG_E0350, part->span, "a function cannot divide by 0");
        }
        chain->number->number = of_numbers(op, chain->number->number, made->number);
        return true;
    }
    if (!end_number(compiler, chain)) {
        return false;
    }
    bool is_result = part->kind == AST_BINARY || (part->kind == AST_UNARY && part->op == AST_OP_NEG);
    if (op == AST_OP_SUB && !is_result) {
        made->number = -made->number;
        op = AST_OP_ADD;
    }
    chain->number = made;
    chain->op = op;
    chain->at = at;
    return true;
}

static bool add_primitive(Compiler *compiler, Chain *chain, const AstNode *at, const AstNode *part)
{
    FunctionNode *made = compile(compiler, part);
    if (made == NULL) {
        return false;
    }
    if (is_bare_number(made, part)) {
        return add_number(compiler, chain, at, part, made);
    }
    if (!end_number(compiler, chain)) {
        return false;
    }
    chain->has_variable = chain->has_variable || !made->is_constant;
    chain->before = at == NULL ? made : join(compiler, at, (AstOp)at->op, chain->before, made);
    return chain->before != NULL;
}

static bool read_chain(Compiler *compiler, const AstNode *node, Chain *chain)
{
    const AstNode *left = node->a;
    bool goes_on = left->kind == AST_BINARY && !(left->flags & AST_IN_PARENTHESES) && !is_logic(left) &&
                   rank_of((AstOp)left->op) == rank_of((AstOp)node->op);
    if (!goes_on) {
        return add_primitive(compiler, chain, NULL, left) && add_primitive(compiler, chain, node, node->b);
    }
    if (!eval_deepen(compiler->ev, 1, left->span)) {
        return false;
    }
    bool fine = read_chain(compiler, left, chain);
    eval_shallow(compiler->ev, 1);
    return fine && add_primitive(compiler, chain, node, node->b);
}

static FunctionNode *compile_binary(Compiler *compiler, const AstNode *node)
{
    if (is_logic(node)) {
        FunctionNode *sum = NULL, *last = NULL;
        if (!split_logic(compiler, node, &sum, &last)) {
            return NULL;
        }
        return sum == NULL ? last : join(compiler, node, AST_OP_OR, sum, last);
    }
    Chain chain = {0};
    return read_chain(compiler, node, &chain) && end_number(compiler, &chain) ? chain.before : NULL;
}

static FunctionNode *compile_conditional(Compiler *compiler, const AstNode *node)
{
    return fault_body(compiler, node, "`? :`", "use `select(A, B, C)`: B for A < 0, else C");
}

// ---- arguments and calls

static bool has_commas(Compiler *compiler, const AstNode *arguments)
{
    for (const AstNode *argument = arguments; argument != NULL; argument = argument->next) {
        if (argument->flags & AST_WITHOUT_COMMA) {
            return eval_fault(compiler->ev, DIAG_E0261, argument->span,
                              "in the body of a function a comma must stand before this argument");
        }
    }
    return true;
}

// In those behind the first `joining` no numbers are joined.
static FunctionNode *compile_arguments(Compiler *compiler, const AstNode *arguments, FunctionNode *node,
                                       unsigned joining)
{
    FunctionNode *first = NULL, **end = &first;
    bool keeps_numbers = compiler->keeps_numbers;
    if (node == NULL || !has_commas(compiler, arguments)) {
        return NULL;
    }
    for (const AstNode *argument = arguments; argument != NULL; argument = argument->next) {
        compiler->keeps_numbers = keeps_numbers || joining == 0;
        joining -= joining > 0;
        *end = compile(compiler, argument);
        compiler->keeps_numbers = keeps_numbers;
        if (*end == NULL) {
            return NULL;
        }
        end = &(*end)->next;
    }
    return with_arguments(node, first);
}

// A sum or a product with a variable of its own: sum(I, From, To, Term).
static FunctionNode *compile_sequence(Compiler *compiler, const AstNode *node)
{
    Eval *ev = compiler->ev;
    const AstNode *name = node->a;
    FunctionNode *made = new_node(compiler, node, node->symbol == W_sum ? function_run_sum : function_run_product);
    if (node->count != 4 || name->kind != AST_NAME || function_meaning(ev, name) != NULL) {
        eval_fault(ev, DIAG_E0261, node->span, "`%s` takes a new name, two bounds and a term",
                   eval_text(ev, node->symbol));
        return NULL;
    }
    if (compiler->count == FUNCTION_SLOTS_MAX) {
        eval_fault(ev, DIAG_E0260, name->span, "a function has at most %d parameters and variables of sums",
                   FUNCTION_SLOTS_MAX);
        return NULL;
    }
    unsigned slot = compiler->count;
    compiler->names[compiler->count++] = name->symbol;
    FunctionNode *sequence = compile_arguments(compiler, name->next, made, 0);
    compiler->count--;
    if (sequence != NULL) {
        sequence->slot = slot;
        sequence->is_constant = false;
    }
    return sequence;
}

static FunctionNode *compile_builtin(Compiler *compiler, const AstNode *node)
{
    FunctionNode made = {.height = 1, .size = 1};
    unsigned least, greatest;
    if (node->symbol == W_sum || node->symbol == W_prod) {
        return compile_sequence(compiler, node);
    }
    if (node->symbol == W_internal) {
        return fault_body(compiler, node, "`internal` beside other things",
                          "declare a function of it alone, and call that");
    }
    if (!function_builtin((Word)node->symbol, &made, &least, &greatest)) {
        return fault_word(compiler, node, "only functions of numbers without memory can");
    }
    if (node->count < least || node->count > greatest) {
        eval_fault(compiler->ev, DIAG_E0203, node->span, "`%s` takes %s%u argument%s here, and %u %s given",
                   eval_text(compiler->ev, node->symbol), least == greatest ? "" : "at least ", least,
                   least == 1 ? "" : "s", (unsigned)node->count, node->count == 1 ? "is" : "are");
        return NULL;
    }
    FunctionNode *kept = new_node(compiler, node, NULL);
    if (kept != NULL) {
        *kept = made;
    }
    return compile_arguments(compiler, node->a, kept, node->symbol == W_pow ? 2 : 1);
}

// Two more than vectors have elsewhere.
static bool component_of(const Eval *ev, const Function *function, Symbol name, unsigned *component)
{
    const char *word = eval_text(ev, name);
    if (function->kind == FUNCTION_PIGMENT && strcmp(word, "hf") == 0) {
        *component = COMPONENT_HEIGHT;
        return true;
    }
    return value_component(strcmp(word, "grey") == 0 ? W_gray : name, function_width(function), component);
}

static FunctionNode *call_node(Compiler *compiler, const AstNode *call, const Function *function, const AstNode *member)
{
    Eval *ev = compiler->ev;
    unsigned component = 0;
    if (function->kind == FUNCTION_UNSUPPORTED) {
        compiler->unsupported = function->word;
        return number_node(compiler, call, 0.0);
    }
    if (!call_ends_well(ev, call)) {
        return NULL;
    }
    if (call->count != function->parameter_count) {
        call_fault_count(ev, call, "function", function->parameter_count);
        return NULL;
    }
    bool is_vector = function_width(function) > 1;
    if (is_vector && member == NULL) {
        return fault_body(compiler, call, "a vector", "take one component of it, as in `F(x, y, z).x`");
    }
    if (!is_vector && member != NULL) {
        return fault_body(compiler, member, "a component of a number", NULL);
    }
    if (member != NULL && !component_of(ev, function, member->symbol, &component)) {
        eval_fault(ev, DIAG_E0204, member->span, "a vector of %u has no component `%s`", function_width(function),
                   eval_text(ev, member->symbol));
        return NULL;
    }
    FunctionNode *node = new_node(compiler, call, function_run_call);
    node = compile_arguments(compiler, call->a, node, 1);
    if (node != NULL) {
        node->function = function;
        node->slot = component;
        node->height += CALL_HEIGHT + (function->kind == FUNCTION_NUMBER ? function->body->height : 0);
    }
    return node;
}

// `member` is the node of `.x` around the call, or NULL.
static FunctionNode *compile_call_in(Compiler *compiler, const AstNode *node, const AstNode *member)
{
    const Value *callee = call_callee(compiler->ev, node);
    if (callee != NULL && callee->kind == VALUE_FUNCTION) {
        return call_node(compiler, node, callee->function, member);
    }
    if (callee != NULL && callee->kind == VALUE_SPLINE) {
        return fault_body(compiler, node, "a spline",
                          "declare a `function { spline { … } }` and take a component of it");
    }
    if (call_is_of_element(node)) {
        return callee == NULL ? NULL : constant_value(compiler, node, callee);
    }
    call_fault_callee(compiler->ev, node, callee);
    return NULL;
}

static FunctionNode *compile_call(Compiler *compiler, const AstNode *node)
{
    return compile_call_in(compiler, node, NULL);
}

static FunctionNode *compile_member(Compiler *compiler, const AstNode *node)
{
    const AstNode *base = node->a;
    const Value *callee = base->kind == AST_CALL ? call_callee(compiler->ev, base) : NULL;
    if (callee == NULL || callee->kind != VALUE_FUNCTION) {
        return fault_body(compiler, node, "a component",
                          "only calls of functions of a transform or spline have components here");
    }
    return compile_call_in(compiler, base, node);
}

// ---- the table

static FunctionNode *compile(Compiler *compiler, const AstNode *node)
{
    static const CompileFn compilers[AST_KIND_COUNT] = {
        [AST_NUMBER] = compile_number,   [AST_NAME] = compile_name,       [AST_CONSTANT] = compile_constant,
        [AST_UNARY] = compile_unary,     [AST_BINARY] = compile_binary,   [AST_CONDITIONAL] = compile_conditional,
        [AST_CALL] = compile_call,       [AST_BUILTIN] = compile_builtin, [AST_INDEX] = compile_element,
        [AST_MEMBER] = compile_member,
    };
    CompileFn compiles = compilers[node->kind];
    if (compiles == NULL) {
        bool has_word = node->kind == AST_WORD || node->kind == AST_BLOCK;
        return has_word ? fault_word(compiler, node, NULL)
                        : fault_body(compiler, node, node->kind == AST_VECTOR ? "a vector" : "a string", NULL);
    }
    if (!eval_deepen(compiler->ev, 1, node->span)) {
        return NULL;
    }
    FunctionNode *made = compiles(compiler, node);
    eval_shallow(compiler->ev, 1);
    return made;
}

const FunctionNode *function_compile(FunctionBody *body, const AstNode *node)
{
    body->ev->inner++;
    const FunctionNode *made = compile(body, node);
    body->ev->inner--;
    return made;
}
