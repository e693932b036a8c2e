// The pixels of a PNG file: rows in strips that are encoded, filtered and compressed side by side and joined to
// one zlib stream (RFC 1950). The stream does not depend on the number of threads.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_STRIPS_H
#define IMAGE_PNG_STRIPS_H

#include <stdbool.h>
#include <stddef.h>

#include "image/encode.h"
#include "image/image.h"

typedef struct PngStrips PngStrips;

// A new one for the picture, or NULL when out of memory. Image and encoder must live as long.
PngStrips *png_strips_new(const Image *image, const Encoder *encoder);
void png_strips_free(PngStrips *strips);

// How many strips the picture has.
int png_strips_count(const PngStrips *strips);

// Makes strips until there are no more to begin, or nobody wants them: for all threads but the one that asks for pieces.
void png_strips_work(PngStrips *strips);

// The next piece of the stream, which lives until the next call; makes strips while that one is not there. False at the
// end, or when out of memory (*failed).
bool png_strips_piece(PngStrips *strips, const unsigned char **bytes, size_t *size, bool *failed);

// No further piece will be asked for.
void png_strips_stop(PngStrips *strips);

#endif
