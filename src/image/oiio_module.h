// The C boundary between the library and the module that wraps OpenImageIO, which is loaded only when a run needs it.
//
// Neither side throws through it. The module holds no state and writes to no path: a file's bytes go to a sink.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_OIIO_MODULE_H
#define IMAGE_OIIO_MODULE_H

#include <stddef.h>
#include <stdint.h>

#include "image/image.h"
#include "image/picture_file.h"

// Raised with each change of the structures below; a module of another version is passed over.
#define OIIO_MODULE_VERSION 5u
#define OIIO_MODULE_FILE "rtlang_oiio.so"
#define OIIO_MODULE_SYMBOL "rtlang_oiio_module"

// A picture to be written: rows are fetched from above downward, a few at a time.
typedef struct OiioPicture {
    const char *ending; // of the file name, without the dot; names the format
    int width, height;
    int channels; // grey, rgb or with alpha; in `samples` those of `more` follow
    ImageDepth depth;
    const ImageNote *notes;
    size_t note_count;
    const ImageChannel *more; // their names and kinds; then the depth is IMAGE_DEPTH_FLOAT
    int more_count;
    const void *client;
    void (*fetch)(const void *client, int first_row, int row_count, void *samples); // packed, in the machine's order
} OiioPicture;

// Where a file's bytes go, all at once, after the picture has been encoded.
typedef struct OiioSink {
    const void *client;
    ImageStatus (*put)(const void *client, const void *bytes, size_t length, ImageError *error);
} OiioSink;

typedef struct OiioModule {
    unsigned version; // stays the first member
    // Whether the format can be written, and at this depth.
    ImageStatus (*check)(const char *ending, ImageDepth depth, ImageError *error);
    ImageStatus (*write)(const OiioPicture *picture, const OiioSink *sink, ImageError *error);
    // Reads a file of the format that OpenImageIO calls so, or of any (NULL), in its own depth, or in the least above.
    // The size is judged before memory is taken by `allocate`, which is picture_file_allocate.
    ImageStatus (*read)(const char *path, const char *format, const PictureLimit *limit,
                        ImageStatus (*allocate)(PictureFile *file, const PictureLimit *limit), PictureFile *file,
                        ImageError *error);
} OiioModule;

#ifdef __cplusplus
extern "C" {
#endif

// The module's one symbol.
extern __attribute__((visibility("default"))) const OiioModule rtlang_oiio_module;

#ifdef __cplusplus
}
#endif

#endif
