// Reading PNG with libpng.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_READ_H
#define IMAGE_PNG_READ_H

#include <stdio.h>

#include "base/attributes.h"
#include "image/image.h"

// Whether the stream begins as PNG does; it stands at its beginning before and after.
bool png_is_there(FILE *stream) RT_MUST_CHECK;

// Reads the picture of the stream, as image_read does.
ImageStatus png_read(FILE *stream, uint64_t pixel_limit, Image *image, ImageError *error) RT_MUST_CHECK;

#endif
