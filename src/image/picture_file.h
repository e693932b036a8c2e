// A picture file as it is stored: samples of the file's own depth, a palette if it has one, and what it says of itself.
//
// Nothing is converted, so that a large picture takes no more memory than it must. image/image.h widens this to floats.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PICTURE_FILE_H
#define IMAGE_PICTURE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "image/image.h"

#ifdef __cplusplus
typedef struct PictureFlag PictureFlag; // C++ has another; it does not look at it
#else
#include <stdatomic.h>
typedef atomic_bool PictureFlag;
#endif

enum { PICTURE_PALETTE_MAX = 256 };

typedef struct PictureFile {
    int width, height;
    int channels; // 1 to 4: grey, grey+alpha, rgb, rgb+alpha; 1 with a palette
    ImageDepth depth;
    int bits;          // of a sample in the file; less than 8 are widened to 8, but not those of a palette
    void *samples;     // width * height * channels, row 0 the top one, in the machine's byte order; owned
    int palette_count; // 0: no palette. Places beyond it are black
    uint8_t palette[PICTURE_PALETTE_MAX][4]; // red, green, blue, alpha
    bool has_gamma;     // the file says how its values are encoded:
    double gamma;       // light = value ^ gamma; 0: sRGB
    bool is_associated; // colours are multiplied with alpha
    bool is_damaged;    // parts of it could not be decoded and are filled in
    bool has_key;       // a grey or colour that shall be transparent; it is not made so
} PictureFile;

typedef struct PictureLimit {
    uint64_t pixels, bytes; // of the picture; of its samples
    const PictureFlag *cancel; // reading gives up, as if it had failed, when this is set; NULL: never
} PictureLimit;

// Room for the samples of a picture whose size is set, checked before memory is allocated.
ImageStatus picture_file_allocate(PictureFile *file, const PictureLimit *limit) RT_MUST_CHECK;
void picture_file_fini(PictureFile *file); // releases the samples

// Reads a file that must be of the format: one of `png jpeg tga ppm pgm tiff exr hdr`, or NULL for any that can be
// read. IMAGE_NOT_A_PICTURE when it is of another one. On failure nothing is left to release; width and height then say
// what the file claims, or 0.
ImageStatus picture_file_read(const char *path, const char *format, const PictureLimit *limit, PictureFile *file,
                              ImageError *error) RT_MUST_CHECK;

// The same for a path in which nothing is a link, as realpath gives it; a link that is there by now is an error.
ImageStatus picture_file_read_real(const char *real, const char *format, const PictureLimit *limit, PictureFile *file,
                                   ImageError *error) RT_MUST_CHECK;

// What of that the file's first bytes say: IMAGE_OK when it can be opened and may be of the format.
ImageStatus picture_file_begins(const char *real, const char *format, ImageError *error) RT_MUST_CHECK;

#endif
