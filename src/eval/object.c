// Objects: blocks of shapes become immutable trees, and trees become scene records.
//
// Placing a tree composes the transforms on the way down, gives untextured shapes the texture of the nearest union or
// of #default, and adds one record for each shape and light. A top-level object lives on the stack and in scratch memory.
// Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/blocks.h"

bool plane_close(Block *block)
{
    // Named: any object may have been the pattern.
    if (block->is == KIND_PLANE && vec3_equal(block->record->plane.normal, vec3(0.0, 0.0, 0.0))) {
        return block_fault(block, DIAG_E0342, block->node->span, "the normal of a plane cannot be <0, 0, 0>");
    }
    return true;
}

// ---- members of unions and objects

typedef struct MemberList {
    UnionMember **end;
    uint32_t count, depth;
} MemberList;

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
    if (kind == KIND_UNION) {
        uint32_t depth = ((const UnionBlueprint *)object)->depth;
        list->depth = depth > list->depth ? depth : list->depth;
    }
    return true;
}

static bool add_block_member(Block *block, MemberList *list, const AstNode *item)
{
    Blueprint record;
    SchemaKind is;
    SchemaKind kind = block_kind(block->ev, item);
    block_defaults(block->ev, kind, &record);
    if (!block_read(block->ev, item, kind, block->arena, &record, &is)) {
        return false;
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
        block->has_unsupported = true;
        return true;
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
        block->has_unsupported = true;
        return true;
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
    UnionBlueprint *group = &block->record->group;
    UnionMember *first = NULL;
    MemberList list = {.end = &first};
    bool is_fine = true;
    bool is_member = true;
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor))) {
        bool is_read = read_member(block, &list, item, &is_member);
        if (!is_member) {
            break;
        }
        is_fine = is_read && is_fine;
        cursor_skip(&block->cursor);
    }
    group->members = first;
    group->count = list.count;
    group->depth = list.depth + 1;
    if (group->depth > block->ev->options.limits->ast_depth) {
        return block_fault(block, DIAG_E0601, block->node->span, "unions are nested more than %u deep",
                           block->ev->options.limits->ast_depth);
    }
    return is_fine;
}

bool union_close(Block *block)
{
    if (!block->has_name && !block->has_unsupported && block->record->group.count < 2) {
        eval_warn(block->ev, DIAG_W0407, block->node->span, "a union should have at least two objects");
    }
    return true;
}

bool object_body(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    SchemaKind kind = item ? block_kind(block->ev, item) : KIND_NONE;
    if (item && is_foreign_kind(block->ev, item)) {
        block_unsupported(block->ev, eval_text(block->ev, item->symbol), item->span, KIND_NONE);
        block->has_unsupported = true;
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

// ---- placing

typedef struct Placement {
    Transform outer;
    const TextureBlueprint *texture; // of the nearest object around that has one, else #default's
    Transform texture_outer;         // of the texture
    const InteriorBlueprint *interior; // of the nearest one that has one, or NULL
} Placement;

static bool flattened(Eval *ev, const ObjectPart *part)
{
    return eval_fault(ev, DIAG_E0345, part->span, "the transforms leave a flat or infinite shape");
}

// Adding 0 makes -0 a 0, so that a matrix that is written and read again is the same.
static void make_zeros_positive(Transform *transform)
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 3; column++) {
            transform->m[row][column] += 0.0;
        }
    }
}

static bool place_sphere(Eval *ev, const SphereBlueprint *sphere, const Transform *transform, MaterialIndex material)
{
    double radius = sphere->radius;
    double factor;
    uint64_t source = sphere->part.span.begin;
    Vec3 size = vec3(radius, radius, radius);
    Transform whole = transform_compose(transform_compose(transform_scale(size), transform_translate(sphere->centre)),
                                        *transform);
    bool is_similar = transform_is_similarity(transform, &factor);
    double image = is_similar ? radius * factor : 0.0;
    if (is_similar || transform_is_similarity(&whole, &image)) {
        Vec3 centre = transform_point(transform, sphere->centre);
        if (!vec3_is_finite(centre) || !isfinite(image) || !(image > 0.0)) {
            return flattened(ev, &sphere->part);
        }
        return scene_add_sphere(ev->scene, centre, image, material, source) || eval_no_memory(ev, sphere->part.span);
    }
    Transform back;
    make_zeros_positive(&whole);
    if (!transform_is_finite(&whole) || !transform_invert(&whole, &back)) {
        return flattened(ev, &sphere->part);
    }
    return scene_add_ellipsoid(ev->scene, &whole, &back, material, source) || eval_no_memory(ev, sphere->part.span);
}

// The image of n·p = d under p' = p M + t is n'·p' = d' with n' = M^-1 n (as a row vector n M^-T) and d' = d + n'·t.
static bool place_plane(Eval *ev, const PlaneBlueprint *plane, const Transform *transform, MaterialIndex material)
{
    Transform back;
    if (!transform_invert(transform, &back)) {
        return flattened(ev, &plane->part);
    }
    Vec3 normal = transform_normal(&back, vector_unit(plane->normal));
    Vec3 origin = vec3(transform->m[3][0], transform->m[3][1], transform->m[3][2]);
    double length = vector_length(normal);
    Vec3 unit = vector_unit(normal);
    // A length of 1 to rounding was left alone by vector_unit, so it does not divide the distance either.
    double distance = (vec3_equal(unit, normal) ? plane->distance : plane->distance / length) + vec3_dot(unit, origin);
    if (!vec3_is_finite(unit) || !isfinite(distance) || vec3_equal(unit, vec3(0.0, 0.0, 0.0))) {
        return flattened(ev, &plane->part);
    }
    return scene_add_plane(ev->scene, unit, distance, material, plane->part.span.begin) ||
           eval_no_memory(ev, plane->part.span);
}

static bool place_shape(Eval *ev, SchemaKind kind, const void *object, const Placement *placement)
{
    const ObjectPart *part = object;
    MaterialIndex index;
    if (eval_cancelled(ev)) {
        return false;
    }
    if (ev->scene->shape_count >= ev->options.limits->objects) {
        if (eval_report(ev, DIAG_E0490, part->span, "more than %llu shapes in the scene",
                        (unsigned long long)ev->options.limits->objects)) {
            diag_suggest(ev->options.diags, "`--max-objects` allows more");
        }
        ev->stop = true; // only now: nothing is reported after it
        return false;
    }
    if (ev->memory.used + scene_bytes(ev->scene) > ev->memory.limit) {
        ev->memory.refused = true;
        return eval_no_memory(ev, part->span);
    }
    if (!material_place(ev, placement->texture, &placement->texture_outer, placement->interior, part->span, &index)) {
        return false;
    }
    return kind == KIND_SPHERE ? place_sphere(ev, object, &placement->outer, index)
                               : place_plane(ev, object, &placement->outer, index);
}

// Recursive: object_members keeps trees from growing deeper than the limit.
static bool place(Eval *ev, SchemaKind kind, const void *object, const Placement *outer)
{
    if (kind == KIND_LIGHT_SOURCE) {
        return light_place(ev, object, &outer->outer);
    }
    const ObjectPart *part = object;
    Placement inner = {
        .outer = transform_compose(part->transform, outer->outer),
        .texture = part->texture ? part->texture : outer->texture,
        .texture_outer = part->texture ? outer->outer : outer->texture_outer,
        .interior = part->interior ? part->interior : outer->interior,
    };
    if (kind == KIND_SPHERE && ((const SphereBlueprint *)object)->radius == 0.0) {
        eval_warn(ev, DIAG_W0348, part->span, "a sphere of radius 0 is not drawn");
        return true;
    }
    if (kind != KIND_UNION) {
        return place_shape(ev, kind, object, &inner);
    }
    bool is_fine = true;
    for (const UnionMember *member = ((const UnionBlueprint *)object)->members; member && !ev->stop;
         member = member->next) {
        is_fine = place(ev, member->kind, member->object, &inner) && is_fine;
    }
    return is_fine;
}

static bool place_object(Eval *ev, SchemaKind kind, const void *object)
{
    Transform identity = transform_identity();
    Placement world = {identity, ev->objects->defaults, identity, NULL};
    return place(ev, kind, object, &world);
}

// ---- statements and right-hand sides

static bool place_record(Eval *ev, const AstNode *item, SchemaKind is, const Blueprint *record)
{
    switch (is) {
    case KIND_CAMERA: return camera_place(ev, &record->camera, item->span);
    case KIND_BACKGROUND:
    case KIND_GLOBAL_SETTINGS: return settings_place(ev, is, record);
    default: return place_object(ev, is, record);
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
    if (value.kind != VALUE_BLOCK || !schema_kind((SchemaKind)value.block)->is_object) {
        return eval_fault(ev, DIAG_E0258, item->span, "expected an object or a directive, found %s",
                          value_describe(&value));
    }
    return place_object(ev, (SchemaKind)value.block, value.record);
}

static bool may_be_statement(SchemaKind kind)
{
    return schema_kind(kind)->is_object || kind == KIND_CAMERA || kind == KIND_BACKGROUND ||
           kind == KIND_GLOBAL_SETTINGS;
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
    if (!may_be_statement(kind)) {
        return eval_fault(ev, DIAG_E0256, item->span, "expected an object or a directive here");
    }
    ArenaMark mark = arena_mark(&ev->scratch);
    Blueprint record;
    SchemaKind is;
    block_defaults(ev, kind, &record);
    bool is_fine = block_read(ev, item, kind, &ev->scratch, &record, &is) && place_record(ev, item, is, &record);
    arena_rewind(&ev->scratch, mark);
    return is_fine;
}

static bool keep(Eval *ev, Span span, SchemaKind kind, const void *record, Value *value)
{
    const void *kept = arena_copy(&ev->program, record, schema_kind(kind)->size);
    *value = (Value){.kind = VALUE_BLOCK, .block = (uint16_t)kind, .record = kept};
    return kept || eval_no_memory(ev, span);
}

static bool read_declared(Eval *ev, const AstNode *block, SchemaKind kind, Value *value)
{
    ObjectState *objects = ev->objects;
    bool was_deferring = objects->is_deferring;
    bool had_deferred = objects->has_deferred;
    UnsupportedBlueprint outer = objects->deferred;
    objects->is_deferring = true;
    objects->has_deferred = false;
    Blueprint record;
    SchemaKind is;
    block_defaults(ev, kind, &record);
    bool is_read = block_read(ev, block, kind, &ev->program, &record, &is);
    if (objects->has_deferred) {
        record.unsupported = objects->deferred;
        is = KIND_UNSUPPORTED;
    }
    bool is_kept = is_read && keep(ev, block->span, is, &record, value);
    objects->is_deferring = was_deferring;
    objects->has_deferred = had_deferred;
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
        UnsupportedBlueprint what = {block->span, eval_text(ev, block->symbol), KIND_NONE};
        return keep(ev, block->span, KIND_UNSUPPORTED, &what, value);
    }
    if (!schema_kind(kind)->is_declarable) {
        return eval_fault(ev, DIAG_E0256, block->span, "`%s` cannot be declared", schema_kind(kind)->word);
    }
    return read_declared(ev, block, kind, value);
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
        if (kind != KIND_REFLECTION) {
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
