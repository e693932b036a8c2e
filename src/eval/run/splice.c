// The evaluator's part in splices: names, expressions, conditions and calls are worked out while text is read.
//
// Turns what grammar asks through GrammarHooks into values. A value that was read is kept in the parse arena, beside
// the node that stands for it. Calls and included files that a splice is inside of are frames of a cursor of its own.
// Knows nothing of tokens.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "eval/run/run.h"

struct SpliceStream {
    Splice splice;
    GrammarStream *stream;
    GrammarText *owned;
    ArenaMark mark; // where its items begin
};

// A copy that outlives the scope in which the value stands.
static const Value *keep(Eval *ev, const Value *value, Span span)
{
    Value *kept = arena_alloc(&ev->parse, sizeof *kept);
    if (kept == NULL) {
        eval_no_memory(ev, span);
        return NULL;
    }
    *kept = *value;
    bool has_memory = value->kind == VALUE_STRING || value->kind == VALUE_ARRAY;
    if (has_memory && !value_store(ev, value, &ev->parse, span, kept)) {
        kept->kind = VALUE_NONE;
    }
    kept->name = value->name;
    return kept;
}

static Eval *eval_of(void *client)
{
    Eval *ev = ((Splice *)client)->cursor.ev;
    lint_give_up(ev); // the names in this text are not all seen as items
    return ev;
}

static const void *capture(void *client, Symbol name, Span span)
{
    Eval *ev = eval_of(client);
    const Value *found = scope_find(ev, name);
    if (found == NULL) {
        return NULL;
    }
    Value value = *found;
    value.name = name;
    return keep(ev, &value, span);
}

static bool is_number(void *client, const void *captured)
{
    const Value *value = captured;
    (void)client;
    return value->kind == VALUE_NUMBER || value_is_tuple(value);
}

static bool is_macro(void *client, Symbol name)
{
    const Value *found = scope_find(eval_of(client), name);
    return found != NULL && found->kind == VALUE_MACRO;
}

static bool lacks_index(void *client, const AstNode *element)
{
    unsigned count = 0;
    for (; element->kind == AST_INDEX; element = element->a) {
        count++;
    }
    const Value *found = element->kind == AST_NAME ? scope_find(eval_of(client), element->symbol) : NULL;
    return found != NULL && found->kind == VALUE_ARRAY && count < found->array->dimension_count;
}

static bool takes_braces(void *client, Symbol word)
{
    const Eval *ev = eval_of(client);
    return ev->builder->takes_braces(ev, word);
}

static bool is_unbalanced(void *client, Symbol name)
{
    const Value *found = scope_find(eval_of(client), name);
    return found != NULL && found->kind == VALUE_MACRO && found->macro->is_unbalanced;
}

// A sum that begins with an object is two arguments of a macro, see macro.c.
static bool begins_with_object(const Eval *ev, const AstNode *node)
{
    while (node->kind == AST_BINARY && !(node->flags & AST_IN_PARENTHESES)) {
        node = node->a;
    }
    const Value *value = node->kind != AST_NAME       ? NULL
                         : node->flags & AST_KNOWN ? node->known
                                                   : scope_find(ev, node->symbol);
    return value != NULL && value->kind == VALUE_BLOCK;
}

static void fold(void *client, AstNode *node)
{
    Eval *ev = eval_of(client);
    Value value;
    if (node->kind == AST_BINARY && begins_with_object(ev, node)) {
        return;
    }
    ArenaMark mark = arena_mark(&ev->scratch);
    if (!eval_expression(ev, node, &value)) {
        ev->faulty = true;
        value = (Value){.kind = VALUE_NONE};
    }
    node->known = keep(ev, &value, node->span);
    if (node->known != NULL) {
        ast_flag(node, AST_KNOWN);
    }
    arena_rewind(&ev->scratch, mark);
}

// The first place among expressions where a name was read, or NULL.
static const AstNode *find_name(const AstNode *node, Symbol name)
{
    const AstNode *found = NULL;
    for (; node != NULL && found == NULL; node = node->next) {
        bool is_leaf = node->kind == AST_NUMBER || node->kind == AST_NAME;
        found = node->kind == AST_NAME && node->symbol == name ? node : NULL;
        found = found == NULL && !is_leaf ? find_name(node->a, name) : found;
        found = found == NULL && !is_leaf ? find_name(node->b, name) : found;
        found = found == NULL && !is_leaf && !(node->flags & AST_KNOWN) ? find_name(node->c, name) : found;
    }
    return found;
}

// Its value was worked out before the name is made, which in POV-Ray is the other way round.
static bool uses_hidden(Eval *ev, const AstNode *directive)
{
    const AstNode *target = directive->a;
    bool is_new = directive->kind == AST_DECLARE && directive->op == AST_OP_LOCAL && target->kind == AST_NAME &&
                  scope_is_new(ev, target->symbol, true);
    const AstNode *use = is_new ? find_name(directive->b, target->symbol) : NULL;
    return use != NULL && !name_fault_unset(ev, use);
}

static bool run(void *client, const AstNode *directive, bool within, unsigned scopes)
{
    Splice *splice = client;
    Eval *ev = eval_of(client);
    if (within && directive->kind == AST_DEFAULT) {
        eval_fault(ev, DIAG_E0111, directive->span,
                   "`#default` cannot stand inside an item whose text directives tear apart");
        return false;
    }
    if (uses_hidden(ev, directive)) {
        return false;
    }
    ev->scopes_within = directive->kind == AST_DECLARE ? scopes : 0;
    directive_run(&splice->cursor, directive);
    ev->scopes_within = 0;
    return !ev->stop;
}

static bool decide(void *client, const AstNode *directive, double *subject, bool *holds)
{
    Eval *ev = eval_of(client);
    ArenaMark mark = arena_mark(&ev->scratch);
    bool fine = directive_decide(ev, directive, subject, holds);
    arena_rewind(&ev->scratch, mark);
    ev->faulty = ev->faulty || !fine;
    return fine && !ev->stop;
}

static bool loop_begin(void *client, const AstNode *header, GrammarLoop *loop, bool *holds)
{
    Eval *ev = eval_of(client);
    bool fine = directive_begin_for(ev, header, loop, holds);
    ev->faulty = ev->faulty || !fine;
    return fine && !ev->stop;
}

static bool loop_turn(void *client, const GrammarLoop *loop, bool *holds)
{
    Eval *ev = eval_of(client);
    bool fine = directive_next_for(ev, loop, holds);
    ev->faulty = ev->faulty || !fine;
    return fine && !ev->stop;
}

static bool step(void *client, Span span)
{
    return eval_step(eval_of(client), span);
}

static bool define(void *client, const AstNode *macro, const GrammarText *body)
{
    Eval *ev = eval_of(client);
    macro_define(ev, macro, body);
    return !ev->stop;
}

static const GrammarText *call(void *client, const AstNode *node)
{
    Splice *splice = client;
    Eval *ev = eval_of(client);
    Macro *macro;
    CursorFrame *frame;
    const GrammarText *text;
    if (!macro_find(ev, node, &macro) || (text = macro_text(ev, macro)) == NULL ||
        (frame = cursor_push(&splice->cursor, FRAME_ITEMS, NULL, NULL)) == NULL) {
        ev->faulty = true;
        return NULL;
    }
    if (!macro_enter(ev, node, macro, &frame->diag)) {
        cursor_pop(&splice->cursor);
        ev->faulty = true;
        return NULL;
    }
    frame->kind = FRAME_MACRO;
    return text;
}

static Source *include(void *client, const AstNode *directive)
{
    Splice *splice = client;
    Eval *ev = eval_of(client);
    CursorFrame *frame = cursor_push(&splice->cursor, FRAME_ITEMS, NULL, NULL);
    Source *source = frame != NULL ? include_enter(ev, frame, directive) : NULL;
    if (source == NULL && frame != NULL) {
        cursor_pop(&splice->cursor);
    }
    return source;
}

static void leave(void *client)
{
    Splice *splice = client;
    if (splice->cursor.frame != NULL) {
        cursor_pop(&splice->cursor);
    }
}

static bool is_stopped(void *client)
{
    return eval_of(client)->stop;
}

void splice_init(Splice *splice, Eval *ev)
{
    *splice = (Splice){
        .context = {ev->options.names, &ev->parse, ev->options.diags, ev->options.limits, &splice->hooks,
                    ev->options.no_literals, &ev->has_mark},
        .cursor = {.ev = ev, .top = true},
        .hooks = {.client = splice,
                  .nesting = &ev->splice_nesting,
                  .capture = capture,
                  .is_number = is_number,
                  .is_macro = is_macro,
                  .lacks_index = lacks_index,
                  .takes_braces = takes_braces,
                  .is_unbalanced = is_unbalanced,
                  .has_unbalanced = &ev->has_unbalanced,
                  .fold = fold,
                  .run = run,
                  .decide = decide,
                  .loop_begin = loop_begin,
                  .loop_turn = loop_turn,
                  .step = step,
                  .define = define,
                  .call = call,
                  .include = include,
                  .leave = leave,
                  .is_stopped = is_stopped,
                  .is_top = true},
    };
    ev->builder->plan_hooks(ev, &splice->hooks);
}

void splice_fini(Splice *splice)
{
    cursor_close(&splice->cursor);
}

// ---- items on demand

SpliceStream *splice_stream_open(Eval *ev, const GrammarText *text, GrammarText *owned, bool top, bool is_call)
{
    SpliceStream *stream = malloc(sizeof *stream);
    if (stream == NULL) {
        free(owned);
        return NULL;
    }
    splice_init(&stream->splice, ev);
    stream->splice.cursor.top = stream->splice.hooks.is_top = top;
    stream->owned = owned;
    stream->mark = arena_mark(&ev->parse);
    stream->stream = grammar_stream_open(&stream->splice.context, text, !top && ev->inner > 0, is_call);
    if (stream->stream == NULL) {
        free(owned);
        free(stream);
        return NULL;
    }
    return stream;
}

const AstNode *splice_stream_next(SpliceStream *stream, bool top)
{
    Eval *ev = stream->splice.cursor.ev;
    bool failed = false;
    // At the top level the items before this one are done with.
    if (top) {
        arena_rewind(&ev->parse, stream->mark);
    }
    const AstNode *item = grammar_stream_next(stream->stream, &failed);
    ev->faulty = ev->faulty || failed;
    return item;
}

bool splice_stream_is_cut(const SpliceStream *stream)
{
    return grammar_stream_is_cut(stream->stream);
}

bool splice_stream_ends_in_comma(const SpliceStream *stream)
{
    return grammar_stream_ends_in_comma(stream->stream);
}

void splice_stream_close(SpliceStream *stream)
{
    grammar_stream_close(stream->stream);
    splice_fini(&stream->splice);
    free(stream->owned);
    free(stream);
}
