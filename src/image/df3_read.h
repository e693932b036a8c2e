// Reading df3, values that fill a box.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_DF3_READ_H
#define IMAGE_DF3_READ_H

#include <stdio.h>

#include "base/attributes.h"
#include "image/picture_file.h"

// Reads the values of the stream, as picture_file_read does; on failure its samples may have been allocated.
ImageStatus df3_read(FILE *stream, const PictureLimit *limit, PictureFile *file, ImageError *error) RT_MUST_CHECK;

#endif
