// A letter is drawn twice, once to count its pieces.
//
// SPDX-License-Identifier: MIT
#include "scene/font.h"

#include <stdio.h>

#include "base/module.h"
#include "scene/outline.h"

FontResult font_open(Font *font, const char *path, bool is_unicode, char *why, size_t size)
{
#ifdef WITH_FREETYPE
    enum { ROOM = 32 << 20 };
    double units = 1.0;
    const void *module = NULL;
    ModuleKind kind = {FONT_MODULE_FILE, FONT_MODULE_SYMBOL, FONT_MODULE_VERSION, ROOM};
    *font = (Font){.module = NULL};
    ModuleResult result = module_load(&kind, &module, why, size);
    if (result != MODULE_OK) {
        return result == MODULE_NO_MEMORY ? FONT_NO_MEMORY : FONT_NO_MODULE;
    }
    font->module = module;
    font->face = font->module->open(path, is_unicode, &units, why, size);
    font->unit = 1.0 / units;
    return font->face ? FONT_OK : why[0] != '\0' ? FONT_NONE : FONT_NO_MEMORY;
#else
    (void)path;
    (void)is_unicode;
    *font = (Font){.module = NULL};
    snprintf(why, size, "this rtlang was built without it");
    return FONT_NO_MODULE;
#endif
}

void font_close(Font *font)
{
    if (font->face) {
        font->module->close(font->face);
        font->face = NULL;
    }
}

double font_kerning(Font *font, uint32_t left, uint32_t right)
{
    return font->unit * font->module->kerning(font->face, left, right);
}

// An outline while it is drawn; without items pieces are counted.
typedef struct Pen {
    double *items;
    size_t pieces, count;
    double unit;
} Pen;

static bool pen_draw(void *client, const double points[8])
{
    Pen *pen = client;
    double own[8];
    for (int i = 0; i < 8; i++) {
        own[i] = pen->unit * points[i];
    }
    if (outline_is_straight(points)) {
        outline_straighten(own);
    }
    if (pen->items) {
        outline_add(pen->items, &pen->count, own);
    }
    return ++pen->pieces <= OUTLINE_PIECES_MOST;
}

FontResult font_letter(Font *font, uint32_t character, Arena *arena, FontLetter *letter)
{
    FontGlyph glyph = {.index = 0};
    Pen pen = {.unit = font->unit};
    *letter = (FontLetter){.index = 0};
    bool has_outline = font->module->glyph(font->face, character, &glyph);
    if (font->module->is_out_of_memory(font->face)) {
        return FONT_NO_MEMORY;
    }
    letter->index = glyph.index;
    letter->advance = font->unit * glyph.advance;
    letter->bearing = font->unit * glyph.bearing;
    for (int i = 0; i < 2; i++) {
        letter->low[i] = font->unit * glyph.low[i];
        letter->high[i] = font->unit * glyph.high[i];
    }
    bool is_drawn = !has_outline || font->module->draw(font->face, pen_draw, &pen);
    letter->is_cut = !is_drawn;
    if (!is_drawn || pen.pieces == 0) {
        return FONT_OK;
    }
    pen.items = arena_alloc_array(arena, OUTLINE_HEAD + OUTLINE_PIECE_NUMBERS * pen.pieces, sizeof *pen.items);
    if (!pen.items) {
        return FONT_NO_MEMORY;
    }
    outline_begin(pen.items, &pen.count, 3, false);
    pen.pieces = 0;
    letter->is_cut = !font->module->draw(font->face, pen_draw, &pen);
    letter->outline = (Numbers){pen.items, pen.count};
    return FONT_OK;
}
