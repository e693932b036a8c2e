// What is said of items that do not fit into a block: unknown words and the nearest that would fit, words that POV-Ray
// has and rtlang has not, and which faults only follow from a syntax fault.
//
// Reports; changes nothing but the block's marks of what was reported. Knows nothing of values.
//
// SPDX-License-Identifier: MIT
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "eval/build/blocks.h"

const char *block_word(const Block *block)
{
    return schema_kind(block->kind)->word;
}

// What is missing or misplaced in a block of which a part was not understood, or a call was at fault, may have been
// there.
static bool follows_from_other(const Block *block, DiagCode code)
{
    bool may_follow = code == DIAG_E0253 || code == DIAG_E0254 || code == DIAG_E0256;
    return may_follow && (block->cursor.is_lossy || eval_follows_syntax(block->ev, block->node->span));
}

bool block_fault(Block *block, DiagCode code, Span span, const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    block->has_fault = true;
    return follows_from_other(block, code) ? false : eval_fault(block->ev, code, span, "%s", message);
}

// ---- the nearest word

static Suggest nearest_property(const Block *block, const AstNode *item)
{
    Suggest suggest;
    const SchemaProperty *property;
    suggest_begin(&suggest, eval_text(block->ev, item->symbol));
    for (size_t i = 0; (property = schema_property(block->kind, i)); i++) {
        suggest_offer(&suggest, property->word);
    }
    return suggest;
}

bool block_is_misspelt(const Block *block, const AstNode *item)
{
    if (item->kind != AST_NAME || item->flags & AST_KNOWN || scope_find(block->ev, item->symbol)) {
        return false;
    }
    Suggest property = nearest_property(block, item);
    if (!property.best) {
        return false;
    }
    Suggest name = scope_nearest(block->ev, item);
    char file[NAME_MAX + 1];
    return (!name.best || property.best_cost <= name.best_cost) &&
           !name_find_include(block->ev, eval_text(block->ev, item->symbol), file);
}

const AstNode *block_leading_name(const Block *block, const AstNode *item)
{
    const AstNode *first = item;
    while (first->kind == AST_BINARY && !(first->flags & (AST_KNOWN | AST_IN_PARENTHESES))) {
        first = first->a;
    }
    bool is_declared = first->flags & AST_KNOWN ? first->known != NULL : scope_find(block->ev, first->symbol) != NULL;
    return first->kind == AST_NAME && !is_declared ? first : item;
}

static Suggest nearest_kind(const Eval *ev, const AstNode *item, SchemaKind *nearest)
{
    Suggest suggest;
    suggest_begin(&suggest, eval_text(ev, item->symbol));
    *nearest = KIND_NONE;
    for (int kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        const char *best = suggest.best;
        suggest_offer(&suggest, schema_kind((SchemaKind)kind)->word);
        *nearest = suggest.best != best ? (SchemaKind)kind : *nearest;
    }
    return suggest;
}

bool block_is_misspelt_object(const Eval *ev, const AstNode *item)
{
    SchemaKind kind;
    if (item->kind != AST_BLOCK || item->symbol < WORD_COUNT) {
        return false;
    }
    nearest_kind(ev, item, &kind);
    return schema_kind(kind)->is_object;
}

void block_unknown(Eval *ev, const AstNode *item)
{
    const char *word = eval_text(ev, item->symbol);
    if (item->symbol < WORD_COUNT) {
        block_unsupported(ev, word, item->span, KIND_NONE);
        return;
    }
    SchemaKind kind;
    Suggest suggest = nearest_kind(ev, item, &kind);
    Span word_span = eval_word_span(ev, item);
    if (eval_report(ev, DIAG_E0250, word_span, "unknown kind of block `%s`", word) && suggest.best) {
        diag_did_you_mean(ev->options.diags, word_span, suggest.best);
    }
}

// A word of the language that is a property of one or two other kinds.
static bool suggest_place(const Block *block, const AstNode *item)
{
    const char *kinds[2];
    size_t count = 0;
    for (size_t kind = 0; item->symbol < WORD_COUNT && kind < KIND_COUNT; kind++) {
        if (block->ev->objects->properties[kind][item->symbol] != 0) {
            if (count == RT_COUNT_OF(kinds)) {
                return false;
            }
            kinds[count++] = schema_kind((SchemaKind)kind)->word;
        }
    }
    if (count > 0) {
        diag_suggest(block->ev->options.diags, "it belongs in `%s`%s%s%s", kinds[0], count > 1 ? " or `" : "",
                     count > 1 ? kinds[1] : "", count > 1 ? "`" : "");
    }
    return count > 0;
}

void block_unknown_property(Block *block, const AstNode *item)
{
    const char *word = eval_text(block->ev, item->symbol);
    Suggest suggest = nearest_property(block, item);
    block->has_fault = true;
    Span word_span = eval_word_span(block->ev, item);
    if (eval_report(block->ev, DIAG_E0250, word_span, "unknown property `%s` in %s", word,
                    block_word(block)) &&
        !suggest_place(block, item) && suggest.best) {
        diag_did_you_mean(block->ev->options.diags, word_span, suggest.best);
    }
}

// ---- what stands in the wrong place

void block_refuse_colour(Block *block, const AstNode *item)
{
    bool may_be_missing = block->has_fault; // it may have its place in what was reported
    block->has_fault = true;
    bool takes_pigment = block->ev->objects->properties[block->kind][W_pigment] != 0;
    if (!may_be_missing && !eval_follows_syntax(block->ev, block->node->span) &&
        eval_report(block->ev, DIAG_E0254, item->span, "no colour is expected here in %s", block_word(block)) &&
        takes_pigment) {
        diag_suggest(block->ev->options.diags, "a colour belongs in `pigment { }`");
    }
}

bool block_begins_with_macro(const Block *block, const AstNode *item)
{
    while (item->kind == AST_BINARY && !(item->flags & AST_IN_PARENTHESES)) {
        item = item->a;
    }
    bool is_call = item->kind == AST_CALL && !item->b && !(item->flags & AST_IN_PARENTHESES);
    const Value *found = is_call ? scope_find(block->ev, item->symbol) : NULL;
    return found && found->kind == VALUE_MACRO;
}

bool block_begins_like_colour(Block *block, const AstNode *item)
{
    while (item->kind == AST_BINARY) {
        item = item->a;
    }
    if (item->kind == AST_WORD) {
        return true;
    }
    Value value;
    if (!block_is_name(item)) {
        return false;
    }
    block->ev->at_colour = true;
    bool is_like = !eval_expression(block->ev, item, &value) || value.kind == VALUE_COLOUR;
    block->ev->at_colour = false;
    return is_like;
}

// A colour directly in a shape is for pictures of the lowest quality, and says nothing here, as in POV-Ray.
bool block_is_idle_colour(Block *block, const AstNode *item)
{
    bool takes_pigment = block->ev->objects->properties[block->kind][W_pigment] != 0;
    const AstNode *name = block_leading_name(block, item);
    bool is_declared = name->flags & AST_KNOWN ? name->known != NULL : scope_find(block->ev, name->symbol) != NULL;
    if (block_is_name(name) && !(name->kind == AST_NAME && is_declared)) {
        return false;
    }
    return takes_pigment && schema_kind(block->kind)->is_object && !block->has_fault &&
           cursor_at_value(&block->cursor) && !block_is_misspelt(block, item) && block_begins_like_colour(block, item);
}

bool block_pass_colour(Block *block)
{
    Rgbft colour;
    Span span;
    if (!cursor_colour(&block->cursor, &colour, &span)) {
        block->has_fault = true;
        return false;
    }
    if (eval_report(block->ev, DIAG_W0405, span, "a colour directly in %s is not used", block_word(block))) {
        diag_suggest(block->ev->options.diags, "a colour belongs in `pigment { }`");
    }
    return true;
}

bool block_is_capital(const Block *block, const AstNode *name)
{
    char first = *eval_text(block->ev, name->symbol);
    return first >= 'A' && first <= 'Z';
}

// ---- what rtlang has not

bool block_is_lacking(const Block *block, Symbol symbol)
{
    static const struct {
        SchemaKind kind;
        Word word;
    } table[] = {
        {KIND_PIGMENT, W_object},  {KIND_PIGMENT, W_interior}, {KIND_PIGMENT, W_exponent},
        {KIND_NORMAL, W_object},   {KIND_NORMAL, W_interior},  {KIND_NORMAL, W_exponent},
        {KIND_PATTERN, W_object},  {KIND_PATTERN, W_interior}, {KIND_PATTERN, W_exponent},
    };
    for (size_t i = 0; i < RT_COUNT_OF(table); i++) {
        if (table[i].kind == block->kind && (Symbol)table[i].word == symbol) {
            return true;
        }
    }
    return false;
}

static const SchemaUnsupported *find_entry(const Eval *ev, Symbol symbol)
{
    unsigned place = symbol < WORD_COUNT ? ev->objects->advice[symbol] : 0;
    return place ? schema_unsupported(place - 1) : NULL;
}

static const char *lacks_text(const UnsupportedDesc *what, const SchemaUnsupported *entry)
{
    return entry && entry->lacks         ? entry->lacks
           : what->owner == KIND_NONE    ? "the shape"
           : what->owner == KIND_CAMERA  ? "its way to see: it is that of a perspective camera"
                                         : "what it would change";
}

// Lenient: the picture is drawn without it, and a warning says so, reported where it stands, since one use may lack several words.
static bool tell_left_out(Eval *ev, const UnsupportedDesc *what, const SchemaUnsupported *entry, Span use)
{
    TextBuffer *list = ev->options.left_out;
    const char *in = what->owner == KIND_NONE ? "" : " in ";
    const char *owner = what->owner == KIND_NONE ? "" : schema_kind(what->owner)->word;
    if (list) {
        text_printf(list, "%s%s%s%s", list->length > 0 ? ", " : "", what->word, in, owner);
    }
    if (!eval_report(ev, DIAG_W0409, what->span, "`%s`%s%s is left out: the picture lacks %s", what->word, in, owner,
                     lacks_text(what, entry))) {
        return false;
    }
    if (use.begin != what->span.begin) {
        diag_note(ev->options.diags, use, "it is used here");
    }
    return true;
}

static bool tell_fault(Eval *ev, const UnsupportedDesc *what, Symbol symbol, Span use)
{
    if (what->owner == KIND_NONE) {
        return eval_report(ev, DIAG_E0252, use, "`%s` is not supported", what->word);
    }
    if (what->owner == KIND_TEXTURE && symbol == W_texture) {
        return eval_report(ev, DIAG_E0251, use,
                           "a texture over another one is not supported by rtlang if it lets light through");
    }
    return eval_report(ev, DIAG_E0251, use, "`%s` is not supported in %s by rtlang", what->word,
                       schema_kind(what->owner)->word);
}

static void tell_unsupported(Eval *ev, const UnsupportedDesc *what, Span use)
{
    ObjectState *objects = ev->objects;
    bool is_lenient = ev->options.is_lenient;
    Symbol symbol = intern_find(ev->options.names, what->word, strlen(what->word));
    if (symbol < WORD_COUNT) {
        if (objects->is_told[symbol]) {
            return;
        }
        objects->is_told[symbol] = true;
    }
    const SchemaUnsupported *entry = find_entry(ev, symbol);
    if (!(is_lenient ? tell_left_out(ev, what, entry, use) : tell_fault(ev, what, symbol, use))) {
        return;
    }
    if (use.begin != what->span.begin && !is_lenient) {
        diag_note(ev->options.diags, what->span, "it stands here");
    }
    if (entry && entry->instead) {
        diag_suggest(ev->options.diags, "%s", entry->instead);
    } else if (entry && entry->lacks && !is_lenient) {
        diag_suggest(ev->options.diags, "`--lenient` draws without it; the picture then lacks %s", entry->lacks);
    }
}

static bool is_deferred(const UnsupportedDesc *list, const UnsupportedDesc *what)
{
    while (list && (strcmp(list->word, what->word) != 0 || list->owner != what->owner)) {
        list = list->next;
    }
    return list != NULL;
}

// The first word alone is a fault; what is left out is reported of each.
void block_unsupported_name(Eval *ev, const UnsupportedDesc *what, Span use)
{
    ObjectState *objects = ev->objects;
    if (!objects->is_deferring) {
        tell_unsupported(ev, what, use);
    } else if (!objects->deferred || (ev->options.is_lenient && !is_deferred(objects->deferred, what))) {
        UnsupportedDesc one = *what;
        one.next = objects->deferred;
        const UnsupportedDesc *kept = arena_copy(&ev->program, &one, sizeof one);
        if (kept) {
            objects->deferred = kept;
        } else {
            (void)eval_no_memory(ev, use);
        }
    }
}

bool block_join_lacks(Eval *ev, Value *value, const Value *other, Span span)
{
    for (const UnsupportedDesc *what = other->lacks; what; what = what->next) {
        UnsupportedDesc one = *what;
        one.next = value->lacks;
        value->lacks = arena_copy(&ev->program, &one, sizeof one);
        if (!value->lacks) {
            return eval_no_memory(ev, span);
        }
    }
    return true;
}

void block_tell_lacks(Eval *ev, const Value *value, Span use)
{
    for (const UnsupportedDesc *what = value->lacks; what; what = what->next) {
        block_unsupported_name(ev, what, use);
    }
}

void block_unsupported(Eval *ev, const char *word, Span span, SchemaKind owner)
{
    UnsupportedDesc what = {span, word, owner, NULL};
    block_unsupported_name(ev, &what, span);
}
