// Reading PNG with libpng.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_READ_H
#define IMAGE_PNG_READ_H

#include <stdio.h>

#include "base/attributes.h"
#include "image/picture_file.h"

// Reads the picture of the stream, as picture_file_read does; on failure its samples may have been allocated.
ImageStatus png_read(FILE *stream, const PictureLimit *limit, PictureFile *file, ImageError *error) RT_MUST_CHECK;

#endif
