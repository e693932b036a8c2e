// Pictures that a scene lays over its surfaces: which file, how its values are meant, and how it is laid.
//
// A source says what is to be read and how; the picture beside it holds what was read, which is nothing until the
// scene's pictures are loaded. Sources, maps and shades are plain data without padding, so that equal ones are kept
// once.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PICTURE_H
#define SCENE_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/source.h"

typedef enum PictureFormat {
    PICTURE_PNG,
    PICTURE_JPEG,
    PICTURE_TGA,
    PICTURE_PPM,
    PICTURE_PGM,
    PICTURE_TIFF,
    PICTURE_EXR,
    PICTURE_HDR,
    PICTURE_DF3, // no picture: values that fill a cube
    PICTURE_FORMATS
} PictureFormat;

// How a file's values are encoded.
typedef enum PictureGamma {
    PICTURE_GAMMA_UNSAID, // as the file says, or its format
    PICTURE_GAMMA_POWER,  // light = value ^ gamma
    PICTURE_GAMMA_SRGB,
} PictureGamma;

typedef enum PictureAlpha { PICTURE_ALPHA_UNSAID, PICTURE_ALPHA_STRAIGHT, PICTURE_ALPHA_ASSOCIATED } PictureAlpha;

typedef struct PictureSource {
    const char *path;  // interned: equal texts are one address. Belongs to the names of the program
    const char *real;  // the path with all links resolved, which was judged; interned
    uint32_t format;   // PictureFormat
    uint32_t encoding; // PictureGamma
    double gamma;      // PICTURE_GAMMA_POWER, else 0
    uint32_t alpha;    // PictureAlpha
    // The working space where the file was named, which its values are brought to: those of pictures do not change when
    // the space is only given later.
    uint32_t space;     // GammaModel
    double space_gamma; // GAMMA_POWER
    uint64_t is_modern; // language version 3.7 or later there
} PictureSource;

typedef struct PictureColour {
    float red, green, blue, filter, transmit;
} PictureColour;

typedef enum PictureDepth { PICTURE_DEPTH_8, PICTURE_DEPTH_16, PICTURE_DEPTH_FLOAT } PictureDepth;

enum { PICTURE_PALETTE = 256 };

// Row 0 is the top one; of a cube y is 0 in row 0 of each layer. A place in a palette, or 1 to 4 channels: grey, grey and alpha, rgb, rgb and alpha.
typedef struct Picture {
    Span span; // where the file is named first
    int width, height, channels;
    int layers; // of a cube, which lie one below the other: a part of the height each; else 0
    PictureDepth depth;
    void *samples;          // NULL: not loaded; owned
    float *decoded;         // the colour, in the working space, of each code of 8 or 16 bits; owned, NULL for float
    uint32_t places;        // in the palette; 0: there is none
    PictureColour *palette; // PICTURE_PALETTE of them, black beyond `places`; owned
    bool is_associated;     // colours are multiplied with alpha
} Picture;

typedef enum Projection {
    PROJECTION_PLANAR = 0,
    PROJECTION_SPHERICAL = 1,
    PROJECTION_CYLINDRICAL = 2,
    PROJECTION_TORUS = 5
} Projection;

typedef enum Interpolation {
    INTERPOLATION_NONE = 0,
    INTERPOLATION_BILINEAR = 2,
    INTERPOLATION_BICUBIC = 3,
    INTERPOLATION_DISTANCE = 4,
} Interpolation;

// What a picture tells: its colours, or one number of each pixel.
typedef enum PictureUse {
    PICTURE_COLOURS,
    PICTURE_GREY,  // of colours
    PICTURE_ALPHA, // what comes through; without alpha the first channel
    PICTURE_INDEX, // the place in the palette over 255, else grey
    PICTURE_RED,   // likewise, else red
} PictureUse;

// How a picture is laid; the numbers are the language's.
typedef struct ImageMap {
    uint32_t picture; // of Scene.picture_sources and Scene.pictures
    uint32_t projection, interpolation;
    uint32_t is_once;
    uint32_t shades; // the first of Scene.picture_shades, or RECORD_NONE
    uint32_t use;    // PictureUse
} ImageMap;

#define SHADE_ALL UINT32_MAX

// `filter` or `transmit`, in the order in which they are written.
typedef struct PictureShade {
    double amount;
    uint32_t place;     // of the palette, or SHADE_ALL
    uint32_t is_filter; // else transmit
    uint64_t source;    // offset of the text
    uint32_t next;      // or RECORD_NONE
    uint32_t unused;
} PictureShade;

// The word of the language, "png".
const char *picture_format_word(PictureFormat format);

// Bytes of what was read.
size_t picture_bytes(const Picture *picture);
void picture_fini(Picture *picture);

#endif
