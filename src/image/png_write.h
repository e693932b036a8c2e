// PNG files by libpng: fast settings, rows encoded one at a time, no copy of the picture.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_WRITE_H
#define IMAGE_PNG_WRITE_H

#include "image/atomic_file.h"
#include "image/encode.h"
#include "image/image.h"

// Writes to the open file; 8 or 16 bit. The chunks tell the transfer function, also for already encoded values.
ImageStatus png_write(const Image *image, const Encoder *encoder, const AtomicFile *file,
                      ImageError *error) RT_MUST_CHECK;

#endif
