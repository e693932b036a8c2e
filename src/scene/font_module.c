// TrueType fonts to outlines, by FreeType.
//
// SPDX-License-Identifier: MIT
#include "scene/font_module.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_FONT_FORMATS_H
#include FT_SYSTEM_H
#include FT_TRUETYPE_IDS_H
#include FT_TRUETYPE_TABLES_H
#include FT_TRUETYPE_TAGS_H

struct FontFace {
    struct FT_MemoryRec_ memory;
    bool is_out_of_memory;
    FT_Library library;
    FT_Face face;
};

typedef struct Walk {
    const FT_Outline *outline;
    FontPen pen;
    void *client;
    int contour; // -1: none yet
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

// FreeType chooses Unicode where there is that. Of what is left the first is as good as any.
static void choose_characters(FT_Face face, bool is_unicode)
{
    for (int i = 0; !is_unicode && i < face->num_charmaps; i++) {
        if (face->charmaps[i]->platform_id == TT_PLATFORM_MACINTOSH) {
            FT_Set_Charmap(face, face->charmaps[i]);
        }
    }
    for (int i = 0; !face->charmap && i < face->num_charmaps; i++) {
        FT_Set_Charmap(face, face->charmaps[i]);
    }
}

static FontFace *font_open(const char *path, bool is_unicode, double *units, char *why, size_t size)
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
    choose_characters(font->face, is_unicode);
    *units = font->face->units_per_EM;
    return font;
}

// ---- what the font's tables say, which may be something else than its outlines

// Big-endian bytes of a table; false: there are not so many.
static bool table_read(FT_Face face, FT_ULong table, FT_ULong offset, FT_Byte *bytes, FT_ULong count)
{
    FT_ULong size = count;
    return FT_Load_Sfnt_Table(face, table, (FT_Long)offset, bytes, &size) == 0;
}

static int16_t int16_at(const FT_Byte *bytes)
{
    return (int16_t)(uint16_t)(bytes[0] << 8 | bytes[1]);
}

// Where the outline begins, where there is no table.
static FT_Pos table_bearing(FT_Face face, uint32_t index)
{
    const TT_HoriHeader *header = FT_Get_Sfnt_Table(face, FT_SFNT_HHEA);
    FT_Byte bytes[2];
    FT_ULong count = header ? header->number_Of_HMetrics : 0;
    FT_ULong offset = index < count ? 4 * (FT_ULong)index + 2 : 4 * count + 2 * (index - count);
    if (count == 0 || !table_read(face, TTAG_hmtx, offset, bytes, sizeof bytes)) {
        return face->glyph->metrics.horiBearingX;
    }
    return int16_at(bytes);
}

// The head of a glyph; false where it has none.
static bool table_head(FT_Face face, uint32_t index, FT_Byte bytes[10])
{
    const TT_Header *header = FT_Get_Sfnt_Table(face, FT_SFNT_HEAD);
    FT_ULong width = header && header->Index_To_Loc_Format ? 4 : 2, offset = 0;
    if (!header || !table_read(face, TTAG_loca, width * index, bytes, width)) {
        return false;
    }
    for (FT_ULong i = 0; i < width; i++) {
        offset = offset << 8 | bytes[i];
    }
    return table_read(face, TTAG_glyf, width == 2 ? 2 * offset : offset, bytes, 10);
}

// As POV-Ray has it. Measured: where a letter reaches left of its box by the table, also by a point that only bends a
// curve ("u" of cyrvetic.ttf, "*" and "@" of timrom.ttf), it stands as far to the right; of one that is combined
// (letters with accents, in most fonts) the table's box holds the origin. Its box is that of all points and of the
// table, which may be more ("j" of timrom.ttf).
static void place_at_bearing(FT_Face face, FT_Pos left, FontGlyph *glyph)
{
    FT_Byte head[10] = {0};
    FT_BBox points, given = {0};
    FT_Outline *outline = &face->glyph->outline;
    FT_Outline_Get_CBox(outline, &points);
    bool has_head = table_head(face, glyph->index, head);
    FT_Pos begin = has_head ? int16_at(head + 2) : left;
    FT_Pos moved = left - begin; // by FreeType
    if (has_head && int16_at(head) > 0) {
        given = (FT_BBox){begin, int16_at(head + 4), int16_at(head + 6), int16_at(head + 8)};
    } else if (has_head && begin < 0) {
        given.xMin = begin;
    }
    FT_Pos right = left - (points.xMin - moved < given.xMin ? points.xMin - moved : given.xMin);
    FT_Outline_Translate(outline, right - moved, 0);
    glyph->low[0] = (double)left;
    glyph->low[1] = fmin((double)points.yMin, (double)given.yMin);
    glyph->high[0] = (double)right + fmax((double)(points.xMax - moved), (double)given.xMax);
    glyph->high[1] = fmax((double)points.yMax, (double)given.yMax);
}

enum { TAG_ENDS_OFF = FT_CURVE_TAG_TOUCH_X }; // which only hinting needs

static bool point_is_off(const FT_Outline *outline, int point)
{
    return FT_CURVE_TAG(outline->tags[point]) == FT_CURVE_TAG_CONIC;
}

// As POV-Ray has it: a curve that begins beside its line begins with a point on it. One that ends there, too, closes
// halfway between the two, and then straight. Measured ("#" and ":" of stmary10.ttf).
static void begin_on_curves(FT_Outline *outline)
{
    for (int i = 0; i < outline->n_contours; i++) {
        int first = i == 0 ? 0 : outline->contours[i - 1] + 1, last = outline->contours[i];
        if (first < last && last < outline->n_points && point_is_off(outline, first)) {
            int tag = FT_CURVE_TAG_ON | (point_is_off(outline, last) ? (int)TAG_ENDS_OFF : 0);
            outline->tags[first] = (char)tag;
        }
    }
}

static bool font_glyph(FontFace *font, uint32_t character, FontGlyph *glyph)
{
    FT_Face face = font->face;
    glyph->index = FT_Get_Char_Index(face, character);
    if (FT_Load_Glyph(face, glyph->index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP)) {
        return false;
    }
    glyph->advance = (double)face->glyph->advance.x;
    FT_Pos left = table_bearing(face, glyph->index);
    glyph->bearing = (double)left;
    if (face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
        return false;
    }
    if (face->glyph->outline.n_points > 0) {
        place_at_bearing(face, left, glyph);
        begin_on_curves(&face->glyph->outline);
    }
    return true;
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

// A place of an outline.
typedef struct Place {
    double x, y;
} Place;

static int draw_piece(Walk *walk, Place first, Place second, Place end)
{
    const double points[8] = {walk->at[0], walk->at[1], first.x, first.y, second.x, second.y, end.x, end.y};
    walk->at[0] = end.x;
    walk->at[1] = end.y;
    return walk->pen(walk->client, points) ? 0 : 1;
}

static int draw_line(Walk *walk, double x, double y)
{
    double dx = (x - walk->at[0]) / 3.0, dy = (y - walk->at[1]) / 3.0;
    return draw_piece(walk, (Place){walk->at[0] + dx, walk->at[1] + dy}, (Place){x - dx, y - dy}, (Place){x, y});
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
    walk->contour++;
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

// Whether a curve to the start comes from the last point, which is off the curve as the first one was.
static bool closes_halfway(const Walk *walk, const FT_Vector *control, double x3, double y3)
{
    const FT_Outline *outline = walk->outline;
    int first = walk->contour == 0 ? 0 : outline->contours[walk->contour - 1] + 1;
    const FT_Vector *last = &outline->points[outline->contours[walk->contour]];
    return (outline->tags[first] & TAG_ENDS_OFF) && x3 == walk->start[0] && y3 == walk->start[1] &&
           control->x == 2 * last->x && control->y == 2 * last->y;
}

static int conic_to(const FT_Vector *control, const FT_Vector *to, void *client)
{
    Walk *walk = client;
    double x = unit_of(control->x), y = unit_of(control->y), x3 = unit_of(to->x), y3 = unit_of(to->y);
    if (closes_halfway(walk, control, x3, y3)) {
        x3 = 0.5 * (x + x3);
        y3 = 0.5 * (y + y3);
    }
    Place first = {walk->at[0] + 2.0 / 3.0 * (x - walk->at[0]), walk->at[1] + 2.0 / 3.0 * (y - walk->at[1])};
    Place second = {x3 + 2.0 / 3.0 * (x - x3), y3 + 2.0 / 3.0 * (y - y3)};
    return draw_piece(walk, first, second, (Place){x3, y3});
}

static int cubic_to(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *client)
{
    return draw_piece(client, (Place){unit_of(first->x), unit_of(first->y)},
                      (Place){unit_of(second->x), unit_of(second->y)}, (Place){unit_of(to->x), unit_of(to->y)});
}

static bool font_draw(FontFace *font, FontPen pen, void *client)
{
    static const FT_Outline_Funcs functions = {move_to, line_to, conic_to, cubic_to, 1, 0};
    FT_Outline *outline = &font->face->glyph->outline;
    Walk walk = {.outline = outline, .pen = pen, .client = client, .contour = -1};
    return FT_Outline_Decompose(outline, &functions, &walk) == 0 && end_curve(&walk) == 0;
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
