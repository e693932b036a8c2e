// PNG files by libpng: fast settings, rows encoded one at a time, no copy of the picture.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_WRITE_H
#define IMAGE_PNG_WRITE_H

#include "image/encode.h"
#include "image/image.h"

// Where the bytes go: false when they cannot be taken, with the reason in the error.
typedef struct PngSink {
    void *client;
    bool (*put)(void *client, const void *bytes, size_t length, ImageError *error);
} PngSink;

// Writes a file; 8 or 16 bit. The chunks tell the transfer function, also for already encoded values.
ImageStatus png_write(const Image *image, const Encoder *encoder, PngSink sink, ImageError *error) RT_MUST_CHECK;

#endif
