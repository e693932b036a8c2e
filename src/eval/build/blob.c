// Blobs: what stands in their braces becomes a list of components (scene/blob.h).
//
// Knows nothing of composites, textures and rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "scene/corners.h"

// POV-Ray's tolerance. Measured.
static const double field_tolerance = 1e-6;

// A ray keeps some 600 bytes for each on its stack.
enum { COMPONENTS_MOST = 4000 };

static bool add_member(Block *block, bool is_rod, const BlobPartDesc *part, Span span)
{
    BlobDesc *blob = &block->record->blob;
    if (is_rod && vec3_equal(part->base, part->cap)) {
        return block_fault(block, DIAG_E0361, span, "the ends of a cylinder cannot be one point");
    }
    if (blob->count == COMPONENTS_MOST) {
        return block_fault(block, DIAG_E0490, span, "a blob has at most %d components: make several of it",
                           (int)COMPONENTS_MOST);
    }
    BlobMember *member = arena_alloc(block->arena, sizeof *member);
    if (!member) {
        return eval_no_memory(block->ev, span);
    }
    member->earlier = blob->members;
    if (!blob_component(&member->component, is_rod, part->base, part->cap, part->radius, part->strength,
                        &part->part.transform)) {
        return block_fault(block, DIAG_E0345, span, "the transforms leave a flat or infinite component");
    }
    member->texture = part->part.texture;
    blob->texture_count += member->texture != NULL;
    blob->members = member;
    blob->count++;
    return true;
}

// `component` strength, radius, centre
static bool read_component(Block *block, Span word)
{
    BlobPartDesc part = *(const BlobPartDesc *)schema_kind(KIND_BLOB_BALL)->defaults;
    Span span = word;
    if (!cursor_number(&block->cursor, &part.strength, &span)) {
        block->has_fault = true;
        return false;
    }
    cursor_take_comma(&block->cursor);
    if (!cursor_number(&block->cursor, &part.radius, &span)) {
        block->has_fault = true;
        return false;
    }
    if (!(part.radius > 0.0)) {
        return block_fault(block, DIAG_E0341, span, "`radius` must be greater than 0, not %g", part.radius);
    }
    cursor_take_comma(&block->cursor);
    if (!cursor_vector3(&block->cursor, &part.base, &span)) {
        block->has_fault = true;
        return false;
    }
    return block_finite(block, part.strength + part.radius + vec3_sum_abs(part.base), span, "component") &&
           add_member(block, false, &part, word);
}

bool blob_part_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    if (item->kind != AST_BLOCK) {
        return read_component(block, item->span);
    }
    SchemaKind kind = item->symbol == W_sphere ? KIND_BLOB_BALL : KIND_BLOB_ROD, is;
    Desc inner;
    block_defaults(block->ev, kind, &inner);
    return block_read(block->ev, item, kind, block->arena, &inner, &is) &&
           add_member(block, kind == KIND_BLOB_ROD, &inner.blob_part, item->span);
}

// Textures are numbered in the order in which the list has its components, so that a dump that is read has the same.
static bool number_textures(Block *block, const TextureDesc **textures)
{
    BlobDesc *blob = &block->record->blob;
    Blob made = blob_of(blob->list.items);
    const TextureDesc **sorted = arena_alloc_array(block->arena, (size_t)blob->texture_count + 1, sizeof *sorted);
    if (!sorted) {
        return eval_no_memory(block->ev, block->node->span);
    }
    uint32_t count = 0;
    for (uint32_t i = 0; i < made.component_count; i++) {
        BlobComponent *component = (BlobComponent *)&made.components[i]; // still the list of this function's caller
        if (component->texture > 0.0) {
            sorted[count++] = textures[(size_t)component->texture - 1];
            component->texture = count;
        }
    }
    blob->textures = sorted;
    return true;
}

bool blob_close(Block *block)
{
    BlobDesc *blob = &block->record->blob;
    if (blob->count == 0) {
        return true;
    }
    BlobComponent *components = arena_alloc_array(block->arena, blob->count, sizeof *components);
    double *list = arena_alloc_array(block->arena, blob_list_most(blob->count), sizeof *list);
    if (!components || !list) {
        return eval_no_memory(block->ev, block->node->span);
    }
    const TextureDesc **textures = arena_alloc_array(block->arena, (size_t)blob->texture_count + 1, sizeof *textures);
    if (!textures) {
        return eval_no_memory(block->ev, block->node->span);
    }
    uint32_t at = blob->count, texture = 0;
    for (const BlobMember *member = blob->members; member; member = member->earlier) {
        components[--at] = member->component;
        if (member->texture) {
            textures[texture++] = member->texture;
            components[at].texture = texture;
        }
    }
    blob->list = blob_make(blob->threshold, components, blob->count, list);
    return number_textures(block, textures);
}

bool blob_blend(Eval *ev, const BlobDesc *blob, const TextureDesc *own, const Transform *outer, TextureDesc *blend)
{
    const TextureDesc *plain = schema_kind(KIND_TEXTURE)->defaults;
    Span span = blob->part.span;
    PatternEntry *entries = arena_alloc_array(&ev->program, (size_t)blob->texture_count + 1, sizeof *entries);
    PatternMap *map = arena_alloc(&ev->program, sizeof *map);
    TextureDesc *first = arena_copy(&ev->program, own, sizeof *first);
    Numbers list = blob->list;
    if (!entries || !map || !first || !numbers_keep(&ev->scene->numbers, &list) ||
        !ARRAY_PUSH(&ev->scene->blobs, list)) {
        return eval_no_memory(ev, span);
    }
    texture_transform(first, outer);
    for (uint32_t i = 0; i <= blob->texture_count; i++) {
        entries[i] = (PatternEntry){.at = 1.0, .texture = i == 0 ? first : blob->textures[i - 1]};
    }
    *map = (PatternMap){entries, blob->texture_count + 1};
    *blend = *own;
    blend->below = NULL;
    blend->part = plain->part;
    blend->part.pattern.type = PATTERN_AVERAGE;
    blend->part.pattern.count = PATTERN_FIELDS;
    blend->part.pattern.image = (uint32_t)(ev->scene->blobs.count - 1);
    blend->part.map = map;
    return true;
}

const char *blob_form(const void *object, Primitive *primitive)
{
    const BlobDesc *blob = object;
    if (blob->count == 0) {
        return "a blob without components is not drawn";
    }
    const BlobNode *root = blob_of(blob->list.items).nodes;
    primitive->kind = PRIMITIVE_BLOB;
    primitive->fixed[0] = vec3(root->low[0], root->low[1], root->low[2]);
    primitive->fixed[1] = vec3(root->high[0], root->high[1], root->high[2]);
    primitive->list = blob->list;
    return blob->threshold > blob_of(blob->list.items).greatest
               ? "a blob whose strengths together are less than its threshold is not drawn"
               : NULL;
}

bool blob_holds(const void *object, Vec3 point, bool is_turned)
{
    const BlobDesc *blob = object;
    return (blob->count > 0 && blob_field(blob->list.items, point) > blob->threshold - field_tolerance) != is_turned;
}

static void box_join(OwnBox *own, Vec3 middle, double half)
{
    Vec3 reach = {half, half, half};
    own->low = vec3_least(own->low, vec3_sub(middle, reach));
    own->high = vec3_greatest(own->high, vec3_add(middle, reach));
}

// A ball's box is its own, or, where it is stretched, a cube as large as its map may stretch a coordinate; a rod's is
// made of those of its ends and of a ball around its middle. Those of a negative strength are left out. Measured.
bool blob_box(const void *object, OwnBox *own)
{
    const BlobDesc *blob = object;
    own->low = vec3(INFINITY, INFINITY, INFINITY);
    own->high = vec3_neg(own->low);
    for (const BlobMember *member = blob->members; member; member = member->earlier) {
        const BlobComponent *component = &member->component;
        const double(*m)[3] = component->to_world;
        double stretch = 0.0, length = vec3_length(vec3(m[0][0], m[0][1], m[0][2])), factor;
        Transform map;
        memcpy(map.m, m, sizeof map.m);
        for (int axis = 0; axis < 3; axis++) {
            stretch = fmax(stretch, fabs(m[0][axis]) + fabs(m[1][axis]) + fabs(m[2][axis]));
        }
        Vec3 base = {m[3][0], m[3][1], m[3][2]}, rise = vec3_scale(component->height, vec3(m[2][0], m[2][1], m[2][2]));
        if (component->strength < 0.0) {
            continue;
        }
        if (component->is_rod != 0.0) {
            box_join(own, base, length);
            box_join(own, vec3_add(base, rise), length);
            box_join(own, vec3_add_scaled(base, 0.5, rise), stretch * hypot(1.0, 0.5 * component->height));
        } else {
            box_join(own, base, transform_is_similarity(&map, &factor) ? length : stretch);
        }
    }
    return false;
}
