// Pictures: the braces of `image_map`, from the name of a file to the scene's record of how it is laid.
//
// A file must be there when it is named, as in POV-Ray, but is read only when something is seen that uses it, and not
// here. What its values are worth is settled by the gamma that is in force where it is named. Knows nothing of samples.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"

static const char *const endings[PICTURE_FORMATS][3] = {
    [PICTURE_PNG] = {".png"},  [PICTURE_JPEG] = {".jpg", ".jpeg"}, [PICTURE_TGA] = {".tga"}, [PICTURE_PPM] = {".ppm"},
    [PICTURE_PGM] = {".pgm"},  [PICTURE_TIFF] = {".tif", ".tiff"}, [PICTURE_EXR] = {".exr"}, [PICTURE_HDR] = {".hdr"},
    [PICTURE_DF3] = {".df3"},
};

// What is no colour is as the file has it, whatever its type, unless it is said how it is encoded.
static void take_as_it_is(ImageDesc *image)
{
    PictureSource *source = &image->source;
    if (source->encoding == PICTURE_GAMMA_UNSAID) {
        source->encoding = PICTURE_GAMMA_POWER;
        source->gamma = 1.0;
    }
    source->space = GAMMA_LINEAR;
    source->space_gamma = 0.0;
    source->is_modern = true;
}

const ImageDesc *image_read_numbers(Block *block, const AstNode *item, PatternType type)
{
    static const struct {
        SchemaKind kind;
        PictureUse use;
    } pictures[PATTERN_COUNT] = {[PATTERN_IMAGE_PATTERN] = {KIND_IMAGE_PATTERN, PICTURE_GREY},
                                 [PATTERN_BUMP_MAP] = {KIND_BUMP_MAP, PICTURE_GREY},
                                 [PATTERN_MATERIAL_MAP] = {KIND_MATERIAL_MAP, PICTURE_RED}};
    Desc record;
    SchemaKind is;
    block_defaults(block->ev, pictures[type].kind, &record);
    if (!block_read(block->ev, item, pictures[type].kind, block->arena, &record, &is)) {
        return NULL;
    }
    record.image.map.use = record.image.uses_alpha   ? PICTURE_ALPHA
                           : record.image.uses_index ? PICTURE_INDEX
                                                     : pictures[type].use;
    take_as_it_is(&record.image);
    const ImageDesc *image = arena_copy(block->arena, &record.image, sizeof record.image);
    if (!image) {
        (void)eval_no_memory(block->ev, item->span);
    }
    return image;
}

bool image_map_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    (void)property;
    block_defaults(block->ev, KIND_IMAGE_MAP, &record);
    if (!block_read(block->ev, item, KIND_IMAGE_MAP, block->arena, &record, &is)) {
        return false;
    }
    PatternPart *part = &block->record->patterned;
    part->pattern.type = PATTERN_IMAGE_MAP;
    part->map = NULL;
    part->image = arena_copy(block->arena, &record.image, sizeof record.image);
    return part->image || eval_no_memory(block->ev, item->span);
}

// `df3`, the name of a file and, in a normal, an amount.
bool density_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    PatternPart *part = &block->record->patterned;
    ImageDesc image = {.shades = NULL};
    if (!pattern_may_begin(block, property, item)) {
        return false;
    }
    if (!cursor_at_word(&block->cursor, W_df3)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`density_file` needs `df3` and the name of a file");
    }
    cursor_skip(&block->cursor);
    if (!image_read_source(block, PICTURE_DF3, &image.source, &image.span) ||
        !pattern_begin(block, PATTERN_DENSITY_FILE, item)) {
        return false;
    }
    take_as_it_is(&image);
    part->image = arena_copy(block->arena, &image, sizeof image);
    return part->image ? pattern_read_amount(block) : eval_no_memory(block->ev, item->span);
}

// ---- the file

// What is said right after the name; there is no place for it further on.
static bool read_encoding(Block *block, PictureSource *source)
{
    Span word;
    double truth;
    for (;;) {
        bool is_gamma = cursor_at_word(&block->cursor, W_gamma);
        if (!is_gamma && !cursor_at_word(&block->cursor, W_premultiplied)) {
            return true;
        }
        word = cursor_peek(&block->cursor)->span;
        cursor_skip(&block->cursor);
        if (is_gamma) {
            GammaModel model = GAMMA_NONE;
            source->gamma = 0.0;
            if (!settings_read_gamma(block, "gamma", word, &model, &source->gamma)) {
                return false;
            }
            source->encoding = model == GAMMA_SRGB ? PICTURE_GAMMA_SRGB : PICTURE_GAMMA_POWER;
        } else if (!cursor_number(&block->cursor, &truth, &word)) {
            return false;
        } else {
            source->alpha = truth != 0.0 ? PICTURE_ALPHA_ASSOCIATED : PICTURE_ALPHA_STRAIGHT;
        }
    }
}

// The format whose files end so; PICTURE_FORMATS for none. A name without an ending means PNG.
static PictureFormat format_of_name(const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(slash ? slash : name, '.');
    unsigned format = PICTURE_PNG;
    while (dot && format < PICTURE_FORMATS &&
           (format == PICTURE_DF3 ||
            (strcmp(endings[format][0], dot) != 0 && (!endings[format][1] || strcmp(endings[format][1], dot) != 0)))) {
        format++;
    }
    return (PictureFormat)format;
}

bool image_read_source(Block *block, PictureFormat format, PictureSource *source, Span *span)
{
    const Settings *settings = &block->ev->scene->settings;
    const AstNode *item = cursor_peek(&block->cursor);
    Value name;
    if (!item || item->kind == AST_WORD || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, item ? item->span : block->node->span,
                           "the name of an image file is expected here");
    }
    bool is_string = eval_string(block->ev, item, &name);
    cursor_skip(&block->cursor);
    if (!is_string) {
        return false;
    }
    format = format == PICTURE_FORMATS ? format_of_name(name.text) : format;
    if (format == PICTURE_FORMATS) {
        return block_fault(block, DIAG_E0511, item->span,
                           "the ending of `%s` does not tell what type of picture it is: put `png`, `jpeg` or the like "
                           "before it",
                           name.text);
    }
    source->format = format;
    source->path = file_find(block->ev, item, name.text, FILE_IMAGE, endings[format], &source->real);
    source->is_modern = eval_knows_37(block->ev);
    source->space = settings->gamma_model == GAMMA_NONE && source->is_modern ? GAMMA_LINEAR : settings->gamma_model;
    source->space_gamma = settings->gamma_model == GAMMA_POWER ? settings->assumed_gamma : 0.0;
    *span = item->span;
    return source->path && (format == PICTURE_DF3 || read_encoding(block, source));
}

static bool read_file(Block *block, PictureFormat format)
{
    ImageDesc *image = &block->record->image;
    return image_read_source(block, format, &image->source, &image->span);
}

PictureFormat image_format(const char *word)
{
    unsigned format = 0;
    while (format < PICTURE_FORMATS &&
           (format == PICTURE_DF3 || strcmp(picture_format_word((PictureFormat)format), word) != 0)) {
        format++;
    }
    return (PictureFormat)format;
}

// A file name without a type.
bool image_body(Block *block)
{
    const AstNode *item = cursor_peek(&block->cursor);
    return !item || item->kind == AST_WORD || item->kind == AST_BLOCK || !cursor_at_value(&block->cursor) ||
           (read_file(block, PICTURE_FORMATS) && (block->items++, true));
}

// ---- how it is laid

// A number that is cut towards zero and must be in a list that a negative one ends.
static bool read_choice(Block *block, const char *word, Span span, const int *choices, const char *text,
                        uint32_t *chosen)
{
    double number;
    const AstNode *item = cursor_peek(&block->cursor);
    Span place = item ? item->span : span;
    if (!item || !cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, span, "`%s` needs a number after it", word);
    }
    if (!cursor_number(&block->cursor, &number, &place)) {
        return false;
    }
    for (size_t i = 0; choices[i] >= 0; i++) {
        if (trunc(number) == choices[i]) {
            *chosen = (uint32_t)choices[i];
            return true;
        }
    }
    return block_fault(block, DIAG_E0341, place, "`%s` must be %s, not %g", word, text, number);
}

static bool add_shade(Block *block, const PictureShade *shade, Span span)
{
    ImageDesc *image = &block->record->image;
    PictureShade *shades = arena_alloc(block->arena, (image->shade_count + 1) * sizeof *shades);
    if (!shades) {
        return eval_no_memory(block->ev, span);
    }
    if (image->shade_count) {
        memcpy(shades, image->shades, image->shade_count * sizeof *shades);
    }
    shades[image->shade_count++] = *shade;
    image->shades = shades;
    return true;
}

// `filter all 0.5` or `filter 3, 0.5`.
static bool shade_action(Block *block, const SchemaProperty *property, Span word)
{
    PictureShade shade = {.place = SHADE_ALL, .is_filter = strcmp(property->word, "filter") == 0, .source = word.begin};
    double place = 0.0;
    Span span = word;
    if (cursor_at_word(&block->cursor, W_all)) {
        cursor_skip(&block->cursor);
    } else if (!cursor_number(&block->cursor, &place, &span)) {
        return false;
    } else if (!(trunc(place) >= 0.0 && trunc(place) < PICTURE_PALETTE)) {
        return block_fault(block, DIAG_E0341, span, "a palette has places from 0 to %d, not %g", PICTURE_PALETTE - 1,
                           place);
    } else {
        shade.place = (uint32_t)place;
    }
    cursor_take_comma(&block->cursor);
    if (!cursor_number(&block->cursor, &shade.amount, &span) ||
        !block_finite(block, shade.amount, span, property->word)) {
        return false;
    }
    return block->record->image.shade_count < PICTURE_PALETTE * 4
               ? add_shade(block, &shade, word)
               : block_fault(block, DIAG_E0291, word, "an image map has at most %d of `filter` and `transmit`",
                             PICTURE_PALETTE * 4);
}

bool image_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const int projections[] = {PROJECTION_PLANAR, PROJECTION_SPHERICAL, PROJECTION_CYLINDRICAL, PROJECTION_TORUS,
                                      -1};
    static const int interpolations[] = {INTERPOLATION_BILINEAR, INTERPOLATION_BICUBIC, INTERPOLATION_DISTANCE, -1};
    ImageMap *map = &block->record->image.map;
    switch ((Word)item->symbol) {
    case W_map_type:
        return read_choice(block, property->word, item->span, projections, "0, 1, 2 or 5", &map->projection);
    case W_interpolate:
        return read_choice(block, property->word, item->span, interpolations, "2, 3 or 4", &map->interpolation);
    case W_filter:
    case W_transmit: return shade_action(block, property, item->span);
    case W_gamma:
    case W_premultiplied:
        return block_fault(block, DIAG_E0256, item->span, "`%s` must stand right after the name of the file",
                           property->word);
    default: return read_file(block, image_format(property->word));
    }
}

bool image_close(Block *block)
{
    ImageDesc *image = &block->record->image;
    image->map.is_once = image->is_once;
    block->is_lost = !image->source.path;
    bool lacks_textures = block->kind == KIND_MATERIAL_MAP && image->texture_count == 0;
    if (lacks_textures && image->source.path && !block->has_unsupported) {
        return block_fault(block, DIAG_E0253, block->node->span, "`material_map` needs a texture after the picture");
    }
    return image->source.path || block->has_unsupported ||
           block_fault(block, DIAG_E0253, block->node->span, "`%s` needs the name of an image file", block_word(block));
}

bool image_place(Eval *ev, Scene *scene, const ImageDesc *image, uint32_t *index)
{
    ImageMap map = image->map;
    map.shades = RECORD_NONE;
    for (size_t i = image->shade_count; i-- > 0;) {
        PictureShade shade = image->shades[i];
        shade.next = map.shades;
        if (!scene_add_picture_shade(scene, &shade, &map.shades)) {
            return eval_no_memory(ev, image->span);
        }
    }
    return (scene_add_picture(scene, &image->source, image->span, &map.picture) &&
            scene_add_image_map(scene, &map, index)) ||
           eval_no_memory(ev, image->span);
}
