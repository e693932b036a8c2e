// Letters as outlines: the module that reads fonts, loaded when a scene has text.
//
// Turns characters into outlines of prisms, the font's unit being 1. Knows nothing of where files may be read.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_FONT_H
#define SCENE_FONT_H

#include "base/arena.h"
#include "scene/font_module.h"
#include "scene/numbers.h"

typedef enum FontResult {
    FONT_OK,
    FONT_NO_MODULE, // it is missing, or there is no room for it
    FONT_NONE,      // the file holds no font that can be used
    FONT_NO_MEMORY
} FontResult;

typedef struct Font {
    const FontModule *module;
    FontFace *face;
    double unit; // one of the font's lengths, where the font's size is 1
} Font;

// A letter at its origin, on the line v = 0.
typedef struct FontLetter {
    uint32_t index;
    double advance, bearing; // from its origin to the next letter's, and to its own left edge; the font's size is 1
    double low[2], high[2];  // as in FontGlyph
    Numbers outline;         // with no piece: it is not seen
    bool is_cut;             // it has more pieces than an outline may have
} FontLetter;

// Opens a font of a file, for font_close. On another result nothing is open, and `why` says in one line what is wrong.
// Of characters as FontModule has it.
FontResult font_open(Font *font, const char *path, bool is_unicode, char *why, size_t size) RT_MUST_CHECK;
void font_close(Font *font);

// The letter of a character; its outline lives as long as the arena. FONT_OK or FONT_NO_MEMORY.
FontResult font_letter(Font *font, uint32_t character, Arena *arena, FontLetter *letter) RT_MUST_CHECK;

// How much farther apart than `advance` says two letters stand, by their `index`; less than 0: nearer.
double font_kerning(Font *font, uint32_t left, uint32_t right);

#endif
