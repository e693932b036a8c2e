// OpenEXR files: one part in lines of single-precision channels, compressed by zlib, with channels of any names.
//
// Knows nothing of paths and of what its channels mean.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_EXR_WRITE_H
#define IMAGE_EXR_WRITE_H

#include "image/oiio_module.h"

// Writes the picture, of samples of 4 bytes each, to the sink.
ImageStatus exr_write(const OiioPicture *picture, const OiioSink *sink, ImageError *error) RT_MUST_CHECK;

#endif
