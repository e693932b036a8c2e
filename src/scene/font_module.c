// TrueType fonts to outlines, by FreeType.
//
// SPDX-License-Identifier: MIT
#include "scene/font_module.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_FONT_FORMATS_H
#include FT_SYSTEM_H
#include FT_TRUETYPE_TABLES_H
#include FT_TRUETYPE_TAGS_H

struct FontFace {
    struct FT_MemoryRec_ memory;
    bool is_out_of_memory;
    FT_Library library;
    FT_Face face;
};

typedef struct Walk {
    FontPen pen;
    void *client;
    double start[2], at[2];
    bool is_open;
} Walk;

// ---- memory of FreeType, so that a want of it is known from all else that may be wrong with a font

static void *take(FT_Memory memory, long size)
{
    FontFace *font = memory->user;
    void *block = malloc((size_t)size);
    font->is_out_of_memory = font->is_out_of_memory || !block;
    return block;
}

static void give_back(FT_Memory memory, void *block)
{
    (void)memory;
    free(block);
}

static void *take_more(FT_Memory memory, long old_size, long size, void *block)
{
    FontFace *font = memory->user;
    void *moved = realloc(block, (size_t)size);
    (void)old_size;
    font->is_out_of_memory = font->is_out_of_memory || !moved;
    return moved;
}

static bool font_is_out_of_memory(const FontFace *font)
{
    return font->is_out_of_memory;
}

// ---- opening and closing

static void font_close(FontFace *font)
{
    if (font) {
        FT_Done_Face(font->face);       // NULL is accepted
        FT_Done_Library(font->library); // likewise
        free(font);
    }
}

static FontFace *refuse(FontFace *font, const char *text, char *why, size_t size)
{
    snprintf(why, size, "%s", font && !font->is_out_of_memory ? text : "");
    font_close(font);
    return NULL;
}

// A font that has no Unicode has what it had on the Macintosh, or letters of its own.
static void choose_characters(FT_Face face)
{
    for (int i = 0; !face->charmap && i < face->num_charmaps; i++) {
        FT_Set_Charmap(face, face->charmaps[i]);
    }
}

static FontFace *font_open(const char *path, double *units, char *why, size_t size)
{
    FontFace *font = calloc(1, sizeof *font);
    if (!font) {
        return refuse(font, "", why, size);
    }
    font->memory = (struct FT_MemoryRec_){font, take, give_back, take_more};
    if (FT_New_Library(&font->memory, &font->library)) {
        return refuse(font, "FreeType cannot be used", why, size);
    }
    FT_Add_Default_Modules(font->library);
    if (FT_New_Face(font->library, path, 0, &font->face)) {
        return refuse(font, "it is no font", why, size);
    }
    const char *format = FT_Get_Font_Format(font->face);
    if (!format || strcmp(format, "TrueType") != 0 || !FT_IS_SCALABLE(font->face) || font->face->units_per_EM == 0) {
        return refuse(font, "it is no TrueType font", why, size);
    }
    choose_characters(font->face);
    *units = font->face->units_per_EM;
    return font;
}

// The left side bearing as the table has it, which may differ from where the outline begins.
static double table_bearing(FT_Face face, uint32_t index)
{
    const TT_HoriHeader *header = FT_Get_Sfnt_Table(face, FT_SFNT_HHEA);
    FT_Byte bytes[2];
    FT_ULong size = sizeof bytes, count = header ? header->number_Of_HMetrics : 0;
    FT_ULong offset = index < count ? 4 * (FT_ULong)index + 2 : 4 * count + 2 * (index - count);
    if (count == 0 || FT_Load_Sfnt_Table(face, TTAG_hmtx, (FT_Long)offset, bytes, &size)) {
        return (double)face->glyph->metrics.horiBearingX;
    }
    return (double)(int16_t)(uint16_t)(bytes[0] << 8 | bytes[1]);
}

static bool font_glyph(FontFace *font, uint32_t character, FontGlyph *glyph)
{
    FT_Face face = font->face;
    glyph->index = FT_Get_Char_Index(face, character);
    if (FT_Load_Glyph(face, glyph->index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP)) {
        return false;
    }
    glyph->advance = (double)face->glyph->advance.x;
    glyph->bearing = table_bearing(face, glyph->index);
    return face->glyph->format == FT_GLYPH_FORMAT_OUTLINE;
}

static double font_kerning(FontFace *font, uint32_t left, uint32_t right)
{
    FT_Vector kerning;
    return FT_Get_Kerning(font->face, left, right, FT_KERNING_UNSCALED, &kerning) ? 0.0 : (double)kerning.x;
}

// ---- outlines: FreeType doubles the coordinates, so that what it puts in the middle of two is no half of a unit

static double unit_of(FT_Pos twice)
{
    return 0.5 * (double)twice;
}

static int draw_piece(Walk *walk, double x1, double y1, double x2, double y2, double x3, double y3)
{
    const double points[8] = {walk->at[0], walk->at[1], x1, y1, x2, y2, x3, y3};
    walk->at[0] = x3;
    walk->at[1] = y3;
    return walk->pen(walk->client, points) ? 0 : 1;
}

static int draw_line(Walk *walk, double x, double y)
{
    double dx = (x - walk->at[0]) / 3.0, dy = (y - walk->at[1]) / 3.0;
    return draw_piece(walk, walk->at[0] + dx, walk->at[1] + dy, x - dx, y - dy, x, y);
}

static int end_curve(Walk *walk)
{
    bool is_closed = !walk->is_open || (walk->at[0] == walk->start[0] && walk->at[1] == walk->start[1]);
    walk->is_open = false;
    return is_closed ? 0 : draw_line(walk, walk->start[0], walk->start[1]);
}

static int move_to(const FT_Vector *to, void *client)
{
    Walk *walk = client;
    int result = end_curve(walk);
    walk->start[0] = walk->at[0] = unit_of(to->x);
    walk->start[1] = walk->at[1] = unit_of(to->y);
    walk->is_open = true;
    return result;
}

static int line_to(const FT_Vector *to, void *client)
{
    Walk *walk = client;
    bool moves = walk->at[0] != unit_of(to->x) || walk->at[1] != unit_of(to->y);
    return moves ? draw_line(walk, unit_of(to->x), unit_of(to->y)) : 0;
}

static int conic_to(const FT_Vector *control, const FT_Vector *to, void *client)
{
    Walk *walk = client;
    double x = unit_of(control->x), y = unit_of(control->y), x3 = unit_of(to->x), y3 = unit_of(to->y);
    return draw_piece(walk, walk->at[0] + 2.0 / 3.0 * (x - walk->at[0]), walk->at[1] + 2.0 / 3.0 * (y - walk->at[1]),
                      x3 + 2.0 / 3.0 * (x - x3), y3 + 2.0 / 3.0 * (y - y3), x3, y3);
}

static int cubic_to(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *client)
{
    return draw_piece(client, unit_of(first->x), unit_of(first->y), unit_of(second->x), unit_of(second->y),
                      unit_of(to->x), unit_of(to->y));
}

static bool font_draw(FontFace *font, FontPen pen, void *client)
{
    static const FT_Outline_Funcs functions = {move_to, line_to, conic_to, cubic_to, 1, 0};
    Walk walk = {.pen = pen, .client = client};
    return FT_Outline_Decompose(&font->face->glyph->outline, &functions, &walk) == 0 && end_curve(&walk) == 0;
}

const FontModule rtlang_font_module = {
    .version = FONT_MODULE_VERSION,
    .open = font_open,
    .close = font_close,
    .is_out_of_memory = font_is_out_of_memory,
    .glyph = font_glyph,
    .kerning = font_kerning,
    .draw = font_draw,
};
