// The words of pictures' formats, and what a loaded picture holds.
//
// Owns what was read, once it is handed over. How it is read is not known here.
//
// SPDX-License-Identifier: MIT
#include "scene/picture.h"

#include <stdlib.h>

#include "base/attributes.h"

static const char *const words[] = {
    [PICTURE_PNG] = "png", [PICTURE_JPEG] = "jpeg", [PICTURE_TGA] = "tga", [PICTURE_PPM] = "ppm",
    [PICTURE_PGM] = "pgm", [PICTURE_TIFF] = "tiff", [PICTURE_EXR] = "exr", [PICTURE_HDR] = "hdr",
    [PICTURE_DF3] = "df3",
};

static const size_t sample_bytes[] = {[PICTURE_DEPTH_8] = 1, [PICTURE_DEPTH_16] = 2, [PICTURE_DEPTH_FLOAT] = 4};

_Static_assert(RT_COUNT_OF(words) == PICTURE_FORMATS, "a word for each format");

const char *picture_format_word(PictureFormat format)
{
    return words[format];
}

size_t picture_bytes(const Picture *picture)
{
    size_t samples = (size_t)picture->width * (size_t)picture->height * (size_t)picture->channels;
    size_t codes = picture->depth == PICTURE_DEPTH_8 ? 256 : 65536;
    return (picture->samples ? samples * sample_bytes[picture->depth] : 0) +
           (picture->decoded ? codes * sizeof *picture->decoded : 0) +
           (picture->palette ? PICTURE_PALETTE * sizeof *picture->palette : 0);
}

void picture_fini(Picture *picture)
{
    free(picture->samples);
    free(picture->decoded);
    free(picture->palette);
    picture->samples = NULL;
    picture->decoded = NULL;
    picture->palette = NULL;
}
