// Warps: how space is bent on the way to a pattern.
//
// What stands in `warp { }` becomes a WarpDesc in front of those before it, which keeps the transform that was said
// since then; the pattern's own transform begins anew. Knows nothing of how a point is bent.
//
// SPDX-License-Identifier: MIT
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

// POV-Ray moves and repeats black holes by chance.
static bool refuse_of_hole(Block *block, const SchemaProperty *property, Span span)
{
    block_unsupported(block->ev, property->word, span, KIND_WARP);
    block->has_unsupported = true;
    return read_vector(block, property->word, offsetof(WarpDesc, warp.offset), span);
}

static bool begin_type(Block *block, WarpType type, Span span, const char *word)
{
    WarpDesc *warp = &block->record->warp;
    for (int other = 0; other < WARP_TYPES; other++) {
        if (warp->types[other] && other != (int)type) {
            return block_fault(block, DIAG_E0256, span, "`%s`: a warp is of one kind", word);
        }
    }
    warp->types[type] = true;
    warp->warp.type = type;
    return true;
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

bool warp_allows(Block *block, const SchemaProperty *property, const AstNode *item)
{
    enum { MAPPINGS = 1 << WARP_CYLINDRICAL | 1 << WARP_SPHERICAL | 1 << WARP_TOROIDAL };
    static const struct {
        Word word;
        unsigned types;
        const char *beside;
    } words[] = {
        {W_octaves, 1 << WARP_TURBULENCE, "`turbulence`"},
        {W_lambda, 1 << WARP_TURBULENCE, "`turbulence`"},
        {W_omega, 1 << WARP_TURBULENCE, "`turbulence`"},
        {W_offset, 1 << WARP_REPEAT, "`repeat`"},
        {W_flip, 1 << WARP_REPEAT, "`repeat`"},
        {W_strength, 1 << WARP_BLACK_HOLE, "`black_hole`"},
        {W_falloff, 1 << WARP_BLACK_HOLE, "`black_hole`"},
        {W_inverse, 1 << WARP_BLACK_HOLE, "`black_hole`"},
        {W_major_radius, 1 << WARP_TOROIDAL, "`toroidal`"},
        {W_orientation, MAPPINGS, "`cylindrical`, `spherical` or `toroidal`"},
        {W_dist_exp, MAPPINGS, "`cylindrical`, `spherical` or `toroidal`"},
    };
    const WarpDesc *warp = &block->record->warp;
    size_t i = 0;
    while (i < RT_COUNT_OF(words) && (Symbol)words[i].word != item->symbol) {
        i++;
    }
    if (i == RT_COUNT_OF(words) || block->has_unsupported || block->has_fault) {
        return true;
    }
    bool fits = warp->types[warp->warp.type] && (words[i].types >> warp->warp.type & 1);
    return fits || block_fault(block, DIAG_E0256, item->span, "`%s` of a warp stands behind %s only", property->word,
                               words[i].beside);
}

bool warp_type_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    WarpDesc *warp = &block->record->warp;
    bool is_hole = warp->types[WARP_BLACK_HOLE];
    WarpType type;
    if (!type_of_word(item->symbol, &type)) {
        if (item->symbol == W_flip) {
            return read_vector(block, property->word, offsetof(WarpDesc, warp.flip), item->span);
        }
        warp->warp.flags |= WARP_INVERSE;
        return true;
    }
    if (is_hole && (type == WARP_REPEAT || type == WARP_TURBULENCE)) {
        return refuse_of_hole(block, property, item->span);
    }
    if (!begin_type(block, type, item->span, property->word)) {
        return false;
    }
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

static bool has_type(const WarpDesc *warp)
{
    for (int type = 0; type < WARP_TYPES; type++) {
        if (warp->types[type]) {
            return true;
        }
    }
    return false;
}

bool warp_close(Block *block)
{
    const WarpDesc *warp = &block->record->warp;
    if (!has_type(warp)) {
        return block->has_unsupported || block_fault(block, DIAG_E0253, block->node->span,
                                                     "`warp` needs the word of a warp, such as `turbulence`");
    }
    if (warp->warp.type == WARP_CUBIC && block->items > 1) {
        return block_fault(block, DIAG_E0256, block->node->span, "nothing else can stand in a warp with `cubic`");
    }
    bool is_mapping = warp->warp.type >= WARP_PLANAR;
    return !is_mapping || vec3_length_squared(warp->warp.vector) > 0.0 ||
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
