// Objects: blocks of shapes become immutable trees, which are kept or placed.
//
// A top-level object lives on the stack and in scratch memory, a declared one in the program's. Knows nothing of how a
// tree becomes scene records.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/build/painted.h"
#include "eval/build/plan.h"
#include "eval/build/probe.h"

// ---- members of unions and objects

bool object_is_group(SchemaKind kind)
{
    return kind >= KIND_UNION && kind <= KIND_DIFFERENCE;
}

typedef struct MemberList {
    UnionMember **end;
    uint32_t count, depth;
} MemberList;

uint32_t object_depth(SchemaKind kind, const void *object)
{
    return object_is_group(kind)       ? ((const UnionDesc *)object)->depth
           : kind == KIND_LIGHT_SOURCE ? ((const LightDesc *)object)->look_depth
                                       : 0;
}

static bool add_member(Block *block, MemberList *list, SchemaKind kind, const void *object)
{
    UnionMember *member = arena_alloc(block->arena, sizeof *member);
    if (!member) {
        return eval_no_memory(block->ev, block->node->span);
    }
    *member = (UnionMember){.object = object, .kind = kind};
    *list->end = member;
    list->end = &member->next;
    list->count++;
    uint32_t depth = object_depth(kind, object);
    list->depth = depth > list->depth ? depth : list->depth;
    return true;
}

// A member that is not there. What is cut with it is lost with it.
static bool leave_out(Block *block)
{
    block->has_unsupported = true;
    block->is_lost = block->kind == KIND_INTERSECTION || block->kind == KIND_DIFFERENCE || block->is_lost;
    return !block->ev->options.is_lenient || eval_leaves_out(block->ev);
}

static bool add_block_member(Block *block, MemberList *list, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    SchemaKind kind = block_kind(block->ev, item);
    block_defaults(block->ev, kind, &record);
    if (!block_read(block->ev, item, kind, block->arena, &record, &is)) {
        return leave_out(block);
    }
    void *kept = arena_copy(block->arena, &record, schema_kind(is)->size);
    if (!kept) {
        return eval_no_memory(block->ev, item->span);
    }
    return add_member(block, list, is, kept);
}

static bool add_named_member(Block *block, MemberList *list, const AstNode *item)
{
    Value value;
    if (!eval_expression(block->ev, item, &value)) {
        return false;
    }
    if (value.kind == VALUE_BLOCK && value.block == KIND_UNSUPPORTED) {
        block_unsupported_name(block->ev, value.record, item->span);
        return leave_out(block);
    }
    if (value.kind == VALUE_BLOCK) {
        block_tell_lacks(block->ev, &value, item->span);
    }
    if (value.kind != VALUE_BLOCK || !schema_kind((SchemaKind)value.block)->is_object) {
        return block_fault(block, DIAG_E0258, item->span, "expected an object, found %s", value_describe(&value));
    }
    return add_member(block, list, (SchemaKind)value.block, value.record);
}

// A kind of block that POV-Ray has and rtlang has not.
static bool is_foreign_kind(const Eval *ev, const AstNode *item)
{
    unsigned place = item->kind == AST_BLOCK && item->symbol < WORD_COUNT ? ev->objects->advice[item->symbol] : 0;
    return place && schema_unsupported(place - 1)->is_kind;
}

// One member; *is_member turns false at the first item that is none.
static bool read_member(Block *block, MemberList *list, const AstNode *item, bool *is_member)
{
    *is_member = !block_is_misspelt(block, item);
    if (!*is_member) {
        return true;
    }
    if (block_is_name(item)) {
        return add_named_member(block, list, item);
    }
    if (is_foreign_kind(block->ev, item)) {
        block_unsupported(block->ev, eval_text(block->ev, item->symbol), item->span, KIND_NONE);
        return leave_out(block);
    }
    if (block_is_misspelt_object(block->ev, item)) {
        block_unknown(block->ev, item);
        return false;
    }
    *is_member = schema_kind(block_kind(block->ev, item))->is_object;
    return !*is_member || add_block_member(block, list, item);
}

bool object_members(Block *block)
{
    UnionDesc *group = &block->record->group;
    UnionMember *first = NULL;
    MemberList list = {.end = &first};
    bool is_fine = true;
    bool is_member = true;
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor))) {
        bool has_comma = block->cursor.has_comma;
        bool is_read = read_member(block, &list, item, &is_member);
        if (!is_member) {
            break;
        }
        block->cursor.has_comma = has_comma;
        is_read = cursor_lacks_comma(&block->cursor, block_word(block)) && is_read;
        is_fine = is_read && is_fine;
        cursor_skip(&block->cursor);
    }
    group->members = first;
    group->count = list.count;
    group->depth = list.depth + 1;
    if (group->depth > block->ev->options.limits->ast_depth) {
        return block_fault(block, DIAG_E0601, block->node->span, "objects are nested more than %u deep",
                           block->ev->options.limits->ast_depth);
    }
    return is_fine;
}

bool object_read_one(Block *block, const void **object, SchemaKind *kind)
{
    UnionMember *first = NULL;
    MemberList list = {.end = &first};
    const AstNode *item = cursor_peek(&block->cursor);
    bool is_member = false;
    if (item && !read_member(block, &list, item, &is_member)) {
        return false;
    }
    if (!is_member) {
        return block_fault(block, DIAG_E0253, block_here(block), "`object` needs an object, or the name of one, first");
    }
    cursor_skip(&block->cursor);
    *object = first ? first->object : NULL;
    *kind = first ? first->kind : KIND_NONE;
    return true;
}

bool union_close(Block *block)
{
    // After a fault, here or before, what is missing may be missing because of it.
    bool has_faults = block->ev->options.diags->error_count > block->ev->errors_before;
    if (!block->has_name && !block->has_unsupported && !has_faults && block->record->group.count < 2) {
        bool begins_with_vowel = block->kind == KIND_INTERSECTION;
        eval_warn(block->ev, DIAG_W0407, block->node->span, "%s %s should have at least two objects",
                  begins_with_vowel ? "an" : "a", schema_kind(block->kind)->word);
    }
    return true;
}

bool light_group_close(Block *block)
{
    block->is = KIND_UNION;
    return true;
}

bool object_body(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    SchemaKind kind = item ? block_kind(block->ev, item) : KIND_NONE;
    if (item && is_foreign_kind(block->ev, item)) {
        block_unsupported(block->ev, eval_text(block->ev, item->symbol), item->span, KIND_NONE);
        block->has_unsupported = block->is_lost = true;
        cursor_skip(&block->cursor);
        return true;
    }
    if (!schema_kind(kind)->is_object) {
        return block_fault(block, DIAG_E0253, item ? item->span : block->node->span,
                           "`object` needs an object, or the name of one, first");
    }
    block_defaults(block->ev, kind, block->record);
    bool is_read = block_read(block->ev, item, kind, block->arena, block->record, &block->is);
    cursor_skip(&block->cursor);
    return is_read;
}

// ---- statements and right-hand sides

static bool place_record(Eval *ev, const AstNode *item, SchemaKind is, const Desc *record)
{
    switch (is) {
    case KIND_CAMERA: return camera_place(ev, &record->camera, item->span);
    case KIND_SKY_SPHERE: return sky_place(ev, &record->sky, item->span);
    case KIND_FOG: return fog_place(ev, &record->fog, item->span);
    case KIND_RAINBOW: return rainbow_keep(ev, &record->rainbow, item->span);
    case KIND_BACKGROUND:
    case KIND_GLOBAL_SETTINGS: return settings_place(ev, is, record);
    default: return object_place(ev, is, record);
    }
}

static bool place_name(Eval *ev, const AstNode *item)
{
    Value value;
    if (!eval_expression(ev, item, &value)) {
        return false;
    }
    if (value.kind == VALUE_BLOCK && value.block == KIND_UNSUPPORTED) {
        block_unsupported_name(ev, value.record, item->span);
        return false;
    }
    if (value.kind == VALUE_BLOCK) {
        block_tell_lacks(ev, &value, item->span);
    }
    if (value.kind != VALUE_BLOCK || !schema_kind((SchemaKind)value.block)->is_object) {
        return eval_fault(ev, DIAG_E0258, item->span, "expected an object or a directive, found %s",
                          value_describe(&value));
    }
    return object_place(ev, (SchemaKind)value.block, value.record);
}

bool object_is_statement(SchemaKind kind)
{
    return schema_kind(kind)->is_object || kind == KIND_CAMERA || kind == KIND_BACKGROUND ||
           kind == KIND_SKY_SPHERE || kind == KIND_FOG || kind == KIND_RAINBOW || kind == KIND_GLOBAL_SETTINGS;
}

static bool begins_statement(const Eval *ev, const AstNode *item)
{
    bool has_word = (item->kind == AST_BLOCK || item->kind == AST_WORD) && item->symbol < WORD_COUNT;
    return has_word && object_is_statement((SchemaKind)ev->objects->kinds[item->symbol]);
}

bool object_takes_braces(const Eval *ev, Symbol word)
{
    if (word >= WORD_COUNT) {
        return false;
    }
    unsigned advice = ev->objects->advice[word];
    return ev->objects->kinds[word] != KIND_NONE || (advice && schema_unsupported(advice - 1)->is_kind);
}

bool eval_place(Eval *ev, const AstNode *item)
{
    if (block_is_name(item)) {
        return place_name(ev, item);
    }
    SchemaKind kind = block_kind(ev, item);
    if (kind == KIND_NONE && item->kind == AST_BLOCK) {
        block_unknown(ev, item);
        return false;
    }
    if (!object_is_statement(kind)) {
        return eval_fault(ev, DIAG_E0256, item->span, "expected an object or a directive here");
    }
    PlanTrial trial = {.plan = NULL};
    bool is_fine;
    if (plan_is_for(kind) && !ev->options.no_literals && plan_begin(ev, item, kind, &trial, &is_fine)) {
        return is_fine;
    }
    ArenaMark mark = scratch_mark(ev);
    bool is_kept = kind == KIND_SKY_SPHERE || kind == KIND_RAINBOW; // until the end
    Arena *arena = is_kept ? &ev->program : &ev->scratch;
    Desc record;
    SchemaKind is;
    block_defaults(ev, kind, &record);
    is_fine = block_read(ev, item, kind, arena, &record, &is);
    if (trial.plan && is_fine) {
        plan_note(ev, &trial, is, &record);
    }
    is_fine = is_fine && place_record(ev, item, is, &record);
    if (trial.plan && is_fine) {
        plan_try(ev, &trial, item);
    }
    scratch_rewind(ev, mark);
    return is_fine;
}

static bool keep(Eval *ev, Span span, SchemaKind kind, const void *record, Value *value)
{
    const void *kept = arena_copy(&ev->program, record, schema_kind(kind)->size);
    *value = (Value){.kind = VALUE_BLOCK, .block = (uint16_t)kind, .record = kept};
    return kept || eval_no_memory(ev, span);
}

// A lenient evaluation keeps what there is of it; where that is nothing, what it would need.
bool block_read_declared(Eval *ev, const AstNode *block, SchemaKind kind, Desc *record, Value *value)
{
    ObjectState *objects = ev->objects;
    bool was_deferring = objects->is_deferring;
    const UnsupportedDesc *outer = objects->deferred;
    objects->is_deferring = true;
    objects->deferred = NULL;
    SchemaKind is;
    bool is_read = block_read(ev, block, kind, &ev->program, record, &is);
    const UnsupportedDesc *deferred = objects->deferred;
    bool is_lost = deferred && (ev->options.is_lenient ? !is_read && eval_leaves_out(ev) : is_read);
    bool is_kept = is_lost ? keep(ev, block->span, KIND_UNSUPPORTED, deferred, value)
                           : is_read && keep(ev, block->span, is, record, value);
    if (is_kept && !is_lost) {
        value->lacks = deferred;
    }
    objects->is_deferring = was_deferring;
    objects->deferred = outer;
    return is_kept;
}

bool eval_block(Eval *ev, const AstNode *block, Value *value)
{
    SchemaKind kind = block_kind(ev, block);
    if (kind == KIND_NONE && block->symbol >= WORD_COUNT) {
        block_unknown(ev, block);
        return false;
    }
    if (kind == KIND_NONE) {
        UnsupportedDesc what = {block->span, eval_text(ev, block->symbol), KIND_NONE, NULL};
        return keep(ev, block->span, KIND_UNSUPPORTED, &what, value);
    }
    if (!schema_kind(kind)->is_declarable) {
        return eval_fault(ev, DIAG_E0256, block->span, "`%s` cannot be declared", schema_kind(kind)->word);
    }
    Desc record;
    block_defaults(ev, kind, &record);
    return block_read_declared(ev, block, kind, &record, value);
}

// ---- the state

static Symbol word_symbol(const Eval *ev, const char *word)
{
    Symbol symbol = intern_find(ev->options.names, word, strlen(word));
    return symbol < WORD_COUNT ? symbol : SYMBOL_NONE;
}

static void index_words(Eval *ev)
{
    ObjectState *objects = ev->objects;
    for (size_t kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        const SchemaProperty *property;
        if (kind != KIND_CLIPPED_BY && kind != KIND_BOUNDED_BY && kind != KIND_LOOKS_LIKE && kind != KIND_REFLECTION &&
            kind != KIND_BLOB_BALL && kind != KIND_BLOB_ROD && kind != KIND_CONTAINED_BY &&
            kind != KIND_CONTAINER_BALL && kind != KIND_CONTAINER_BOX) {
            objects->kinds[word_symbol(ev, schema_kind((SchemaKind)kind)->word)] = (uint8_t)kind;
        }
        for (size_t i = 0; (property = schema_property((SchemaKind)kind, i)); i++) {
            objects->properties[kind][word_symbol(ev, property->word)] = (uint8_t)(i + 1);
        }
    }
    objects->kinds[W_colour_map] = KIND_COLOUR_MAP; // another spelling
    const SchemaUnsupported *entry;
    for (size_t i = 0; (entry = schema_unsupported(i)); i++) {
        objects->advice[word_symbol(ev, entry->word)] = (uint8_t)(i + 1);
    }
    objects->kinds[SYMBOL_NONE] = KIND_NONE;
}

bool objects_init(Eval *ev)
{
    ObjectState *objects = arena_alloc(&ev->program, sizeof *objects);
    if (!objects) {
        return eval_no_memory(ev, SPAN_NONE);
    }
    memset(objects, 0, sizeof *objects);
    ev->objects = objects;
    objects->defaults = schema_kind(KIND_TEXTURE)->defaults;
    index_words(ev);
    return true;
}

void objects_fini(Eval *ev)
{
    ev->objects = NULL; // its memory is the program arena's
}

const EvalBuilder builder_of_scene = {
    .place = eval_place,
    .block = eval_block,
    .texture_layers = eval_texture_layers,
    .texture_layer = eval_texture_layer,
    .set_default = eval_default,
    .is_statement = begins_statement,
    .takes_braces = object_takes_braces,
    .trace = builtin_trace,
    .inside = builtin_inside,
    .extent = builtin_extent,
    .painted_create = painted_create,
    .painted_at = painted_at,
    .plan_hooks = plan_hooks,
    .plan_watch_call = plan_watch_call,
    .plan_turns = plan_turns,
};
