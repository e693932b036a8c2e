// Formats that are a header and samples as they are: portable pixmaps (PPM), uncompressed Targa, and films (Y4M).
//
// Programs that call a renderer read these from a pipe, and they cost no library. Knows nothing of paths.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PLAIN_WRITE_H
#define IMAGE_PLAIN_WRITE_H

#include <stdbool.h>

#include "image/atomic_file.h"
#include "image/encode.h"

// Whether a file name's ending, in lower case, is that of one of these formats.
bool plain_has_format(const char *ending);

// Whether that format has samples of this depth: PPM of 8 and 16 bit, the others of 8.
bool plain_has_depth(const char *ending, ImageDepth depth);

// Writes the picture; only Targa has room for alpha. Y4M is one frame of a film, behind the film's header unless the
// encoding continues one. IMAGE_NO_MEMORY or IMAGE_IO when it could not.
ImageStatus plain_write(const char *ending, const Image *image, const Encoder *encoder, const AtomicFile *file,
                        ImageError *error) RT_MUST_CHECK;

#endif
