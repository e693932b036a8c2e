// Patterns: the words that spread a pigment or a texture over space. What lies along them is pattern_map.c.
//
// Writes into the PatternPart at the start of a pigment's or texture's description. Knows nothing of how a pattern is
// computed.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "eval/build/blocks.h"

// The patterns that alone know a word, as messages name them; NULL for what all know.
static const char *owners_of(Symbol word, const Pattern *pattern, bool *is_one)
{
    PatternType type = (PatternType)pattern->type;
    bool is_fractal = type == PATTERN_MANDEL || type == PATTERN_JULIA;
    switch ((Word)word) {
    case W_form:
    case W_metric:
    case W_offset:
    case W_solid:
        *is_one = type == PATTERN_CRACKLE;
        return "`crackle`";
    case W_control0:
    case W_control1:
        *is_one = type == PATTERN_QUILTED;
        return "`quilted`";
    case W_agate_turb:
        *is_one = type == PATTERN_AGATE;
        return "`agate`";
    case W_mortar:
    case W_brick_size:
        *is_one = type == PATTERN_BRICK;
        return "`brick`";
    case W_exterior:
    case W_interior:
        *is_one = is_fractal;
        return "`mandel`, `julia` or `magnet`";
    case W_exponent:
        *is_one = is_fractal && pattern->magnet == 0;
        return "`mandel` or `julia`";
    default:
        return NULL;
    }
}

static bool is_of_pattern(const SchemaProperty *property)
{
    switch (property->action) {
    case ACTION_PATTERN:
    case ACTION_SLOPE:
    case ACTION_FUNCTION:
    case ACTION_TILES:
    case ACTION_INSIDE:
    case ACTION_PICTURE:
    case ACTION_WARP:
    case ACTION_PATTERN_SOLID:
    case ACTION_FRACTAL:
    case ACTION_WAVE:
    case ACTION_MAP:
        return true;
    default:
        return property->action == ACTION_NONE && property->at >= offsetof(PatternPart, pattern) &&
               property->at < offsetof(PatternPart, pattern) + sizeof(Pattern);
    }
}

// A texture is a pigment, bumps and a finish, or textures by a pattern, as it begins.
static bool fits_texture(Block *block, const SchemaProperty *property, const AstNode *item)
{
    bool is_word = is_of_pattern(property);
    bool is_part =
        property->action == ACTION_PIGMENT || property->action == ACTION_NORMAL || property->action == ACTION_FINISH;
    bool has_pattern = block->has_name && block->record->patterned.pattern.type != PATTERN_NONE;
    block->is_plain =
        block->is_plain || block->has_name || (!block->is_patterned && (is_part || schema_is_transform(property)));
    block->is_patterned = block->is_patterned || (is_word && !block->is_plain);
    if (is_part && (block->is_patterned || has_pattern)) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` cannot stand in a texture that begins with a pattern",
                           property->word);
    }
    bool has_message = property->action == ACTION_PATTERN || property->action == ACTION_FUNCTION ||
                       property->action == ACTION_SLOPE || property->action == ACTION_TILES ||
                       property->action == ACTION_INSIDE || property->action == ACTION_MAP ||
                       property->action == ACTION_PICTURE; // of its own
    return !is_word || !block->is_plain || has_message ||
           block_fault(block, DIAG_E0256, item->span, "`%s` can stand only in a texture that begins with a pattern",
                       property->word);
}

bool pattern_allows(Block *block, const SchemaProperty *property, const AstNode *item)
{
    if (block->has_unsupported) {
        return true;
    }
    bool is_one = false;
    const char *owners = owners_of(item->symbol, &block->record->patterned.pattern, &is_one);
    if (owners && !is_one && item->kind == AST_WORD && is_of_pattern(property)) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` can stand only beside %s", property->word, owners);
    }
    return block->kind != KIND_TEXTURE || fits_texture(block, property, item);
}

bool pattern_may_follow(Block *block, const SchemaProperty *property, const AstNode *item)
{
    return block->kind != KIND_TEXTURE || !block->has_name ||
           block_fault(block, DIAG_E0256, item->span, "`%s` cannot follow an identifier in %s", property->word,
                       block_word(block));
}

static PatternType type_of(const char *word)
{
    PatternType type = PATTERN_NONE;
    while (strcmp(pattern_info(type)->word, word) != 0) {
        type++;
    }
    return type;
}

// The steps of mandel and julia.
static bool check_count(Block *block, const Pattern *pattern, Span span)
{
    bool has_steps = pattern->type == PATTERN_MANDEL || pattern->type == PATTERN_JULIA;
    if (has_steps && (pattern->count < 1 || pattern->count > PATTERN_STEPS_MOST)) {
        return block_fault(block, DIAG_E0342, span, "`%s` takes 1 to %d steps, not %d",
                           pattern_info((PatternType)pattern->type)->word, (int)PATTERN_STEPS_MOST,
                           (int)pattern->count);
    }
    return true;
}

bool pattern_solid_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    (void)item;
    block->record->patterned.pattern.flags |= PATTERN_SOLID;
    return true;
}

bool pattern_read_amount(Block *block)
{
    static const SchemaProperty amount = {"normal", TYPE_NUMBER, ACTION_NONE, .at = offsetof(NormalDesc, amount)};
    const AstNode *item = cursor_peek(&block->cursor);
    if (block->kind == KIND_NORMAL) {
        cursor_take_comma(&block->cursor);
    }
    const PatternPart *part = &block->record->patterned;
    bool has_normals = part->map && pattern_info((PatternType)part->pattern.type)->blocks;
    if (block->kind != KIND_NORMAL || has_normals || !item || item->kind == AST_WORD ||
        !cursor_at_value(&block->cursor)) {
        return true;
    }
    return block_value(block, &amount, item->span);
}

// What a pattern's words are before they are said: bricks after bricks of #default or of a name stay as they are, the
// others begin anew. Measured.
static void begin_pattern(Pattern *pattern, PatternType type)
{
    if (type == PATTERN_BRICK && pattern->type != PATTERN_BRICK) {
        pattern->vector = vec3(8.0, 3.0, 4.5);
        pattern->mortar = 0.5;
    }
    if (type == PATTERN_QUILTED) {
        pattern->vector = vec3(1.0, 1.0, 0.0);
        pattern->frequency = 0.0; // and with it `phase` does nothing, unless it is said again
    }
    if (type == PATTERN_CRACKLE) {
        pattern->form = vec3(-1.0, 1.0, 0.0);
        pattern->metric = 2.0;
        pattern->offset = 0.0;
        pattern->flags &= ~(uint32_t)PATTERN_SOLID;
    }
    if (type == PATTERN_AGATE) {
        pattern->agate_turb = 1.0;
    }
    bool is_fractal = type == PATTERN_MANDEL || type == PATTERN_JULIA;
    pattern->magnet = 0;
    pattern->power = is_fractal ? 2 : 0;
    pattern->exterior = is_fractal;
    pattern->interior = 0;
    pattern->exterior_factor = pattern->interior_factor = is_fractal ? 1.0 : 0.0;
}

bool pattern_begin(Block *block, PatternType type, const AstNode *item)
{
    Pattern *pattern = &block->record->patterned.pattern;
    const PatternInfo *info = pattern_info(type);
    if (info->is_of_surface && block->kind == KIND_PATTERN) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` cannot stand in a function, which has no surface",
                           info->word);
    }
    begin_pattern(pattern, type);
    pattern->type = type;
    pattern->wave = info->wave != WAVE_RAMP ? info->wave : pattern->wave;
    return true;
}

// The braces of `pigment_pattern`, which hold what those of a pigment do.
static bool read_pigment_pattern(Block *block, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    memcpy(&record, schema_kind(KIND_PIGMENT)->defaults, schema_kind(KIND_PIGMENT)->size);
    if (!block_read(block->ev, item, KIND_PIGMENT, block->arena, &record, &is)) {
        return false;
    }
    block->record->patterned.pigment = arena_copy(block->arena, &record.pigment, sizeof record.pigment);
    return block->record->patterned.pigment || eval_no_memory(block->ev, item->span);
}

// A pattern stands first.
bool pattern_may_begin(Block *block, const SchemaProperty *property, const AstNode *item)
{
    return pattern_may_follow(block, property, item) &&
           ((block->items <= 1 && block->arguments == 0) ||
            block_fault(block, DIAG_E0256, item->span, "`%s` must stand before everything else in %s", property->word,
                        block_word(block)));
}

// The c of julia: two numbers.
static bool read_plane_point(Block *block, const AstNode *item, Vec3 *point)
{
    const AstNode *next = cursor_peek(&block->cursor);
    Value value = {.kind = VALUE_NUMBER};
    if (next && cursor_at_value(&block->cursor) && !cursor_value(&block->cursor, &value)) {
        return false;
    }
    if (value.kind != VALUE_VECTOR || value.components != 2) {
        return block_fault(block, DIAG_E0253, item->span, "`julia` needs a vector of 2 after it");
    }
    *point = vec3(value.v[0], value.v[1], 0.0);
    return true;
}

bool pattern_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    const SchemaProperty direction = {property->word, TYPE_VECTOR, ACTION_NONE,
                                      .at = offsetof(PatternPart, pattern.vector)};
    const SchemaProperty count = {property->word, TYPE_INTEGER, ACTION_NONE,
                                  .at = offsetof(PatternPart, pattern.count)};
    Pattern *pattern = &block->record->patterned.pattern;
    PatternType type = type_of(property->word);
    const PatternInfo *info = pattern_info(type);
    if (!pattern_may_begin(block, property, item)) {
        return false;
    }
    // A list of blocks becomes a map along values: the first at 0, the second at 1. A map of normals is no list.
    // Measured.
    if (block->kind == KIND_NORMAL && info->blocks != 0) {
        block->record->patterned.map = NULL;
    }
    if (!pattern_begin(block, type, item)) {
        return false;
    }
    if (info->blocks) {
        pattern->frequency = 0.0; // the numbers of blocks stay as they are
    }
    bool is_read = !info->has_direction    ? true
                   : type == PATTERN_JULIA ? read_plane_point(block, item, &pattern->vector)
                                           : block_value(block, &direction, item->span);
    if (!is_read) {
        return false;
    }
    if (info->has_direction && info->has_count) {
        cursor_take_comma(&block->cursor);
    }
    if (type == PATTERN_GRADIENT && vec3_length_squared(pattern->vector) == 0.0) {
        return block_fault(block, DIAG_E0342, item->span, "the direction of a gradient cannot be <0, 0, 0>");
    }
    if (info->has_count && (!block_value(block, &count, item->span) || !check_count(block, pattern, item->span))) {
        return false;
    }
    bool has_entries = info->blocks != 0 && block->kind != KIND_PATTERN;
    return (type != PATTERN_PIGMENT || read_pigment_pattern(block, item)) &&
           (!has_entries || pattern_read_blocks(block, type, item->span)) && pattern_read_amount(block);
}

// A picture whose values are a pattern, heights or numbers of textures.
bool pattern_picture_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    PatternPart *part = &block->record->patterned;
    PatternType type = type_of(property->word);
    if (!pattern_may_begin(block, property, item)) {
        return false;
    }
    const ImageDesc *image = image_read_numbers(block, item, type);
    if (!image) {
        return false;
    }
    begin_pattern(&part->pattern, type);
    part->pattern.type = type;
    part->image = image;
    if (type == PATTERN_BUMP_MAP) {
        part->map = NULL;
        block->record->normal.slopes = NULL;
        block->record->normal.amount = isnan(image->bump_size) ? block->record->normal.amount : image->bump_size;
    }
    if (type == PATTERN_MATERIAL_MAP) {
        PatternMap map = {image->textures, image->texture_count};
        part->map = arena_copy(block->arena, &map, sizeof map);
        part->pattern.frequency = 0.0; // numbers stay as they are
        part->pattern.wave = WAVE_RAMP;
        part->pattern.count = (int32_t)image->texture_count;
        block->is_plain = true; // only transforms follow
        return part->map || eval_no_memory(block->ev, item->span);
    }
    return pattern_read_amount(block);
}

// `exterior` and `interior`: what is returned for a point, and times what.
static bool read_told(Block *block, const SchemaProperty *property, Span span)
{
    Pattern *pattern = &block->record->patterned.pattern;
    bool is_exterior = strcmp(property->word, "exterior") == 0;
    SchemaProperty type = {property->word, TYPE_INTEGER, ACTION_NONE, .range = {RANGE_FAULT, false, 0.0, 6.0}};
    SchemaProperty factor = {property->word, TYPE_NUMBER, ACTION_NONE, .at = 0};
    type.at =
        (uint16_t)(is_exterior ? offsetof(PatternPart, pattern.exterior) : offsetof(PatternPart, pattern.interior));
    factor.at = (uint16_t)(is_exterior ? offsetof(PatternPart, pattern.exterior_factor)
                                       : offsetof(PatternPart, pattern.interior_factor));
    if (!block_value(block, &type, span)) {
        return false;
    }
    if (!is_exterior && pattern->interior == 6) {
        block_unsupported(block->ev, "interior 6", span, block->kind);
        return false;
    }
    cursor_take_comma(&block->cursor);
    return block_value(block, &factor, span);
}

// `magnet` 1 or 2 `mandel` or `julia`, or a word that says more of these.
bool pattern_fractal_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    double number;
    Span span = item->span;
    if (strcmp(property->word, "magnet") != 0) {
        return read_told(block, property, item->span);
    }
    if (!cursor_number(&block->cursor, &number, &span)) {
        block->has_fault = true;
        return false;
    }
    if (number != 1.0 && number != 2.0) {
        return block_fault(block, DIAG_E0341, span, "`magnet` must be 1 or 2, not %g", number);
    }
    const AstNode *word = cursor_peek(&block->cursor);
    bool is_mandel = cursor_at_word(&block->cursor, W_mandel);
    if (!is_mandel && !cursor_at_word(&block->cursor, W_julia)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`magnet` needs `mandel` or `julia` here");
    }
    SchemaProperty pattern = {is_mandel ? "mandel" : "julia", TYPE_ACTION, ACTION_PATTERN, .at = 0};
    cursor_skip(&block->cursor);
    if (!pattern_action(block, &pattern, word)) {
        return false;
    }
    block->record->patterned.pattern.magnet = (int)number;
    return true;
}

// A function stands for its pattern.
bool pattern_function_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    PatternPart *part = &block->record->patterned;
    Value value;
    if (!pattern_may_begin(block, property, item) || !eval_rvalue(block->ev, item, &value)) {
        return false;
    }
    begin_pattern(&part->pattern, PATTERN_FUNCTION);
    part->pattern.type = PATTERN_FUNCTION;
    part->function = value.function;
    return pattern_read_amount(block);
}

// The transforms that follow an object in the braces of a pattern.
static bool read_inside_transforms(Block *block, Transform *transform)
{
    Desc record;
    const AstNode *item;
    memcpy(&record, schema_kind(KIND_TRANSFORM)->defaults, schema_kind(KIND_TRANSFORM)->size);
    Block moves = {.ev = block->ev,
                   .node = block->node,
                   .arena = block->arena,
                   .cursor = block->cursor,
                   .record = &record,
                   .kind = KIND_TRANSFORM,
                   .is = KIND_TRANSFORM};
    const SchemaProperty *property;
    bool is_fine = true;
    while (is_fine && (item = cursor_peek(&moves.cursor)) && (property = block_transform_word(&moves, item))) {
        is_fine = cursor_lacks_comma(&moves.cursor, "the pattern `object`");
        cursor_skip(&moves.cursor);
        is_fine = is_fine && transform_action(&moves, property, item);
    }
    block->cursor = moves.cursor;
    *transform = record.transform;
    return is_fine && cursor_lacks_comma(&block->cursor, "the pattern `object`");
}

// An object, how it is moved, and what lies outside and inside of it.
static bool read_inside(Block *block, const AstNode *item)
{
    InsideDesc inside = {.object = NULL};
    SchemaKind kind;
    if (!object_read_one(block, &inside.object, &kind) || !read_inside_transforms(block, &inside.transform)) {
        return false;
    }
    if (!inside.object) {
        block->record->patterned.pattern.type = PATTERN_NONE;
        block->is_lost = true;
        return true;
    }
    inside.kind = (int)kind;
    block->record->patterned.inside = arena_copy(block->arena, &inside, sizeof inside);
    if (!block->record->patterned.inside) {
        return eval_no_memory(block->ev, item->span);
    }
    if (block->kind != KIND_PATTERN && !pattern_read_blocks(block, PATTERN_OBJECT, item->span)) {
        return false;
    }
    const AstNode *rest = cursor_peek(&block->cursor);
    return !rest ||
           block_fault(block, DIAG_E0254, rest->span, "nothing else can stand in the braces of the pattern `object`");
}

bool pattern_inside_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    if (!pattern_may_begin(block, property, item)) {
        return false;
    }
    if (block->kind == KIND_NORMAL) {
        block->record->patterned.map = NULL; // as of other blocks
    }
    if (!pattern_begin(block, PATTERN_OBJECT, item)) {
        return false;
    }
    block->record->patterned.pattern.frequency = 0.0; // 0 and 1 stay as they are
    Cursor behind = block->cursor;
    cursor_open(&block->cursor, block->ev, item->a, item->span);
    bool is_read = read_inside(block, item);
    cursor_close(&block->cursor);
    block->cursor = behind;
    return is_read && pattern_read_amount(block);
}

bool pattern_wave_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty exponent = {"poly_wave", TYPE_NUMBER, ACTION_NONE,
                                            .at = offsetof(PatternPart, pattern.exponent)};
    Pattern *pattern = &block->record->patterned.pattern;
    WaveType wave = WAVE_RAMP;
    while (strcmp(pattern_wave_word(wave), property->word) != 0) {
        wave++;
    }
    pattern->wave = wave;
    const AstNode *next = cursor_peek(&block->cursor);
    bool has_exponent = wave == WAVE_POLY && next && next->kind != AST_WORD && cursor_at_value(&block->cursor);
    return !has_exponent || block_value(block, &exponent, item->span); // else that of #default or of a name stays
}

static bool average_has_weights(Block *block)
{
    const PatternMap *map = block->record->patterned.map;
    double sum = 0.0;
    for (size_t i = 0; map && i < map->count; i++) {
        sum += map->entries[i].at;
    }
    return sum > 0.0 || block_fault(block, DIAG_E0253, block->node->span, "`average` needs a map of weights above 0");
}

// POV-Ray keeps these in single precision.
static bool settle_values(Block *block)
{
    PatternPart *part = &block->record->patterned;
    part->pattern.lambda = number_single(part->pattern.lambda);
    part->pattern.omega = number_single(part->pattern.omega);
    part->pattern.frequency = number_single(part->pattern.frequency);
    part->pattern.phase = number_single(part->pattern.phase);
    part->pattern.exponent = number_single(part->pattern.exponent);
    part->pattern.agate_turb = number_single(part->pattern.agate_turb);
    if (part->pattern.type == PATTERN_QUILTED) {
        part->pattern.vector.x = number_single(part->pattern.vector.x);
        part->pattern.vector.y = number_single(part->pattern.vector.y);
    }
    const Vec3 *size = &part->pattern.vector;
    bool is_flat = size->x == 0.0 || size->y == 0.0 || size->z == 0.0;
    return part->pattern.type != PATTERN_BRICK || !is_flat ||
           block_fault(block, DIAG_E0342, block->node->span, "no component of `brick_size` can be 0");
}

bool normal_close(Block *block)
{
    const PatternPart *part = &block->record->patterned;
    bool lacks_pattern = part->pattern.type == PATTERN_NONE;
    if (block->has_unsupported) {
        block->is_lost = lacks_pattern || block->is_lost;
        return true; // which may have been the pattern
    }
    block->record->normal.span = lacks_pattern ? block->node->span : (Span){0, 0};
    if (lacks_pattern) {
        return true; // not yet
    }
    if (part->pattern.type == PATTERN_AVERAGE && !average_has_weights(block)) {
        return false;
    }
    if (part->pattern.type == PATTERN_QUILTED) {
        block->record->normal.slopes = NULL; // POV-Ray looks at the slopes of other patterns only
    }
    return settle_values(block) && surface_close(block, &block->record->patterned);
}

bool pattern_close(Block *block)
{
    const PatternPart *part = &block->record->patterned;
    if (!settle_values(block)) {
        return false;
    }
    if (block->kind == KIND_TEXTURE && part->pattern.type != PATTERN_NONE && block->record->texture.keeps_length) {
        block_unsupported(block->ev, "no_bump_scale", block->node->span, KIND_TEXTURE_MAP);
        block->has_unsupported = true;
    }
    if (part->pattern.type == PATTERN_AVERAGE && !average_has_weights(block)) {
        return false;
    }
    bool lacks_pattern = block->kind == KIND_PATTERN && part->pattern.type == PATTERN_NONE;
    block->is_lost = lacks_pattern || block->is_lost;
    if (lacks_pattern && !block->has_unsupported) {
        return block_fault(block, DIAG_E0253, block->node->span, "`pattern` needs the word of a pattern");
    }
    if (block->kind == KIND_TEXTURE && part->pattern.type != PATTERN_NONE && !part->map) {
        return block_fault(block, DIAG_E0253, block->node->span, "a pattern of textures needs a `texture_map`");
    }
    if (block->kind != KIND_TEXTURE) {
        return surface_close(block, &block->record->patterned);
    }
    TextureDesc *texture = &block->record->texture;
    return surface_close(block, &texture->part) &&
           (!block->on_surface || texture_put_on_surface(block->ev, block->arena, texture, false, block->node->span));
}
