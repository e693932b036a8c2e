// The boundary between the library and the module that wraps libjpeg, which is loaded only when a scene has a JPEG.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_JPEG_MODULE_H
#define IMAGE_JPEG_MODULE_H

#include <stdio.h>

#include "image/image.h"
#include "image/picture_file.h"

// Raised with each change of the structures below; a module of another version is passed over.
#define JPEG_MODULE_VERSION 2u
#define JPEG_MODULE_FILE "rtlang_jpeg.so"
#define JPEG_MODULE_SYMBOL "rtlang_jpeg_module"

typedef struct JpegModule {
    unsigned version; // stays the first member
    // Reads the picture of the stream, as picture_file_read does; on failure its samples may have been allocated, by
    // `allocate`, which is picture_file_allocate. Sets file->is_damaged where libjpeg filled in for what it could not
    // decode.
    ImageStatus (*read)(FILE *stream, const PictureLimit *limit,
                        ImageStatus (*allocate)(PictureFile *file, const PictureLimit *limit), PictureFile *file,
                        ImageError *error);
} JpegModule;

// The module's one symbol.
extern __attribute__((visibility("default"))) const JpegModule rtlang_jpeg_module;

#endif
