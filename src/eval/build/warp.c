// Warps: how space is bent on the way to a pattern.
//
// What stands in `warp { }` becomes a WarpDesc in front of those before it, which keeps the transform that was said
// since then; the pattern's own transform begins anew. Knows nothing of how a point is bent.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"

enum { WARPS_MOST = 100 }; // of one pattern

static bool read_vector(Block *block, const char *word, size_t at, Span span)
{
    const SchemaProperty vector = {word, TYPE_VECTOR, ACTION_NONE, .at = (uint16_t)at};
    return block_value(block, &vector, span);
}

static bool read_number(Block *block, const char *word, size_t at, Span span)
{
    const SchemaProperty number = {word, TYPE_NUMBER, ACTION_NONE, .at = (uint16_t)at};
    return block_value(block, &number, span);
}

static bool at_value(Block *block)
{
    const AstNode *next = cursor_peek(&block->cursor);
    return next && next->kind != AST_WORD && cursor_at_value(&block->cursor);
}

// Of a plane its normal and distance may follow.
static bool read_plane(Block *block, Span span)
{
    block->record->warp.warp.radius = 0.0;
    if (!at_value(block)) {
        return true;
    }
    if (!read_vector(block, "planar", offsetof(WarpDesc, warp.vector), span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    return !at_value(block) || read_number(block, "planar", offsetof(WarpDesc, warp.radius), span);
}

static bool read_repeat(Block *block, Span span)
{
    const Vec3 *along = &block->record->warp.warp.vector;
    if (!read_vector(block, "repeat", offsetof(WarpDesc, warp.vector), span)) {
        return false;
    }
    int axes = (along->x != 0.0) + (along->y != 0.0) + (along->z != 0.0);
    return axes == 1 || block_fault(block, DIAG_E0342, span, "`repeat` wants a vector along x, y or z");
}

static bool read_hole(Block *block, Span span)
{
    if (!read_vector(block, "black_hole", offsetof(WarpDesc, warp.vector), span)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    return read_number(block, "black_hole", offsetof(WarpDesc, warp.radius), span);
}

// A black hole where it is repeated, and by how much its places there are off.
static bool read_of_hole(Block *block, WarpType type, Span span)
{
    return type == WARP_REPEAT ? read_vector(block, "repeat", offsetof(WarpDesc, warp.flip), span)
                               : read_vector(block, "turbulence", offsetof(WarpDesc, warp.offset), span);
}

static bool type_of_word(Symbol word, WarpType *type)
{
    switch ((Word)word) {
    case W_turbulence:
        *type = WARP_TURBULENCE;
        return true;
    case W_repeat:
        *type = WARP_REPEAT;
        return true;
    case W_black_hole:
        *type = WARP_BLACK_HOLE;
        return true;
    case W_planar:
        *type = WARP_PLANAR;
        return true;
    case W_cylindrical:
        *type = WARP_CYLINDRICAL;
        return true;
    case W_spherical:
        *type = WARP_SPHERICAL;
        return true;
    case W_toroidal:
        *type = WARP_TOROIDAL;
        return true;
    case W_cubic:
        *type = WARP_CUBIC;
        return true;
    default:
        return false;
    }
}

// The warps that each word belongs to, beside those that are warps themselves.
static unsigned warps_of_word(Symbol word)
{
    enum { MAPPINGS = 1 << WARP_CYLINDRICAL | 1 << WARP_SPHERICAL | 1 << WARP_TOROIDAL };
    switch ((Word)word) {
    case W_octaves:
    case W_lambda:
    case W_omega:
        return 1 << WARP_TURBULENCE;
    case W_offset:
    case W_flip:
        return 1 << WARP_REPEAT;
    case W_repeat:
    case W_turbulence:
    case W_strength:
    case W_falloff:
    case W_inverse:
        return 1 << WARP_BLACK_HOLE;
    case W_orientation:
    case W_dist_exp:
        return MAPPINGS;
    case W_major_radius:
        return 1 << WARP_TOROIDAL;
    default:
        return 0;
    }
}

bool warp_allows(Block *block, const SchemaProperty *property, const AstNode *item)
{
    WarpType type;
    if (block->items == 0) {
        return type_of_word(item->symbol, &type) ||
               block_fault(block, DIAG_E0256, item->span,
                           "`%s` cannot begin a warp: its kind stands first, such as "
                           "`turbulence`",
                           property->word);
    }
    return warps_of_word(item->symbol) & 1u << block->record->warp.warp.type ||
           block_fault(block, DIAG_E0256, item->span, "`%s` does not belong to this kind of warp", property->word);
}

bool warp_type_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Warp *warp = &block->record->warp.warp;
    WarpType type;
    if (!type_of_word(item->symbol, &type)) {
        if (item->symbol == W_flip) {
            return read_vector(block, property->word, offsetof(WarpDesc, warp.flip), item->span);
        }
        warp->flags |= WARP_INVERSE;
        return true;
    }
    if (block->items > 1) {
        return read_of_hole(block, type, item->span);
    }
    warp->type = type;
    switch (type) {
    case WARP_TURBULENCE:
        return read_vector(block, property->word, offsetof(WarpDesc, warp.vector), item->span);
    case WARP_REPEAT:
        return read_repeat(block, item->span);
    case WARP_BLACK_HOLE:
        return read_hole(block, item->span);
    case WARP_PLANAR:
        return read_plane(block, item->span);
    default:
        return true;
    }
}

// Along one axis: the hole lies wholly in its slice of space, and what is too narrow for it grows, as in POV-Ray.
// Measured.
static double width_for_hole(double *middle, double radius, double width, double aside)
{
    if (width == 0.0) {
        return 0.0;
    }
    *middle = fmax(*middle, radius);
    return fmax(*middle + radius + aside, width);
}

// What is not greater than 0 repeats nothing.
static void close_hole(Block *block)
{
    Warp *warp = &block->record->warp.warp;
    Vec3 *middle = &warp->vector, *aside = &warp->offset;
    Vec3 said = {fmax(warp->flip.x, 0.0), fmax(warp->flip.y, 0.0), fmax(warp->flip.z, 0.0)};
    Vec3 width = {width_for_hole(&middle->x, warp->radius, said.x, aside->x),
                  width_for_hole(&middle->y, warp->radius, said.y, aside->y),
                  width_for_hole(&middle->z, warp->radius, said.z, aside->z)};
    if (width.x > said.x || width.y > said.y || width.z > said.z) {
        eval_warn(block->ev, DIAG_W0341, block->node->span,
                  "`repeat` should be at least <%g, %g, %g>, so that the hole is within it", width.x, width.y, width.z);
    }
    warp->flip = width;
    if (!(vec3_length_squared(width) > 0.0)) {
        *aside = (Vec3){0.0, 0.0, 0.0};
    }
}

bool warp_close(Block *block)
{
    const Warp *warp = &block->record->warp.warp;
    if (block->items == 0) {
        return block->has_unsupported || block_fault(block, DIAG_E0253, block->node->span,
                                                     "`warp` needs the word of a warp, such as `turbulence`");
    }
    if (warp->type == WARP_BLACK_HOLE) {
        close_hole(block);
    }
    return warp->type < WARP_PLANAR || vec3_length_squared(warp->vector) > 0.0 ||
           block_fault(block, DIAG_E0342, block->node->span, "the orientation of a warp cannot be <0, 0, 0>");
}

bool warp_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    PatternPart *part = &block->record->patterned;
    Desc record;
    SchemaKind is;
    (void)property;
    block_defaults(block->ev, KIND_WARP, &record);
    if (!block_read(block->ev, item, KIND_WARP, block->arena, &record, &is)) {
        return false;
    }
    WarpDesc *warp = &record.warp;
    warp->warp.to_outside = part->transform;
    warp->before = part->warps;
    warp->count = part->warps ? part->warps->count + 1 : 1;
    if (warp->count > WARPS_MOST) {
        return block_fault(block, DIAG_E0291, item->span, "a pattern has at most %d warps", (int)WARPS_MOST);
    }
    part->warps = arena_copy(block->arena, warp, sizeof *warp);
    part->transform = transform_identity();
    return part->warps || eval_no_memory(block->ev, item->span);
}

bool warps_place(Eval *ev, Scene *scene, const WarpDesc *last, Span span, uint32_t *first)
{
    const WarpDesc *all[WARPS_MOST];
    unsigned count = 0;
    uint32_t next = RECORD_NONE;
    for (const WarpDesc *warp = last; warp; warp = warp->before) {
        all[count++] = warp;
    }
    while (count-- > 0) {
        Warp record = all[count]->warp;
        Transform back;
        record.next = next;
        if (!transform_is_finite(&record.to_outside) || !transform_invert(&record.to_outside, &back)) {
            return eval_fault(ev, DIAG_E0345, span, "the transforms leave a flat or infinite pattern");
        }
        if (!scene_add_warp(scene, &record, &next)) {
            return eval_no_memory(ev, span);
        }
    }
    *first = next == RECORD_NONE ? 0 : next + 1;
    return true;
}
