// The boundary between the library and the module that wraps FreeType, which is loaded only when a scene has text.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_FONT_MODULE_H
#define SCENE_FONT_MODULE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Raised with each change of the structures below; a module of another version is passed over.
#define FONT_MODULE_VERSION 2u
#define FONT_MODULE_FILE "rtlang_font.so"
#define FONT_MODULE_SYMBOL "rtlang_font_module"

typedef struct FontFace FontFace;

// Lengths are in the font's units, of which so many are 1.
typedef struct FontGlyph {
    uint32_t index;
    double advance, bearing; // from one glyph to the next, and from its origin to its left edge
    double low[2], high[2];  // the box of all its points, and of what the font says of it; 0 of a blank
} FontGlyph;

// A piece of an outline: a Bézier curve of degree 3 from points[0..1] to points[6..7]. False: no more is wanted.
typedef bool (*FontPen)(void *client, const double points[8]);

typedef struct FontModule {
    unsigned version; // stays the first member
    // A TrueType font, or the first one of a collection; NULL where there is none, and `why` in a few words, or empty
    // when out of memory. Characters are Unicode's, or else the numbers that its table for the Macintosh has, where it
    // has one.
    FontFace *(*open)(const char *path, bool is_unicode, double *units, char *why, size_t size);
    void (*close)(FontFace *face);
    // Whether memory ran out since it was opened, so that letters and kerning may be wrong.
    bool (*is_out_of_memory)(const FontFace *face);
    // What stands for a character; that of none, where the font has not this one.
    bool (*glyph)(FontFace *face, uint32_t character, FontGlyph *glyph);
    // How much nearer to each other two glyphs stand, less than 0, or farther.
    double (*kerning)(FontFace *face, uint32_t left, uint32_t right);
    // Draws the curves of the glyph that was asked for last, one after the other, each closed.
    bool (*draw)(FontFace *face, FontPen pen, void *client);
} FontModule;

// The module's one symbol.
extern __attribute__((visibility("default"))) const FontModule rtlang_font_module;

#endif
