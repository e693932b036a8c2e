// Pictures as files: encoding, atomic writing, reading, and comparing.
//
// PNG goes through libpng; PPM, Targa and Y4M are written as they are (image/plain_write.c). Everything else goes through
// modules that are loaded on first use: reading JPEG through libjpeg (image/jpeg_module.c), the rest through OpenImageIO
// (image/oiio_module.cpp). A picture is written to a temporary file beside its destination and renamed, so an old
// picture is either kept or wholly replaced. The same picture and encoding give the same bytes.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_IMAGE_H
#define IMAGE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"

// Values are linear light unless the encoding says otherwise; row 0 is the top one.
typedef struct Image {
    int width, height;
    int channels;  // 1 to 4: grey, grey+alpha, rgb, rgb+alpha
    float *values; // width * height * channels; owned
} Image;

bool image_init(Image *image, int width, int height, int channels) RT_MUST_CHECK; // cleared; false: out of memory
void image_fini(Image *image);

typedef enum ImageDepth { IMAGE_DEPTH_8, IMAGE_DEPTH_16, IMAGE_DEPTH_FLOAT } ImageDepth;

typedef enum ImageTransfer {
    IMAGE_TRANSFER_SRGB,  // IEC 61966-2-1
    IMAGE_TRANSFER_POWER, // value ^ (1/gamma); gamma 1 writes linear values
} ImageTransfer;

// A line of text that a file keeps beside its pixels, where its format can: PNG's tEXt, an attribute of EXR.
typedef struct ImageNote {
    const char *name; // 1 to 79 printable characters
    const char *text; // ASCII
    bool is_of_origin; // what the picture was drawn from; formats whose header is text do not have it, for their readers
} ImageNote;

// A channel beside light and alpha: a number of 4 bytes a pixel.
typedef struct ImageChannel {
    const char *name;
    const void *first; // the top left pixel's number; not owned
    int step;          // from a pixel's number to the next one's, in numbers
    bool is_count;     // uint32_t below 2^31, not float
} ImageChannel;

enum { IMAGE_CHANNELS_MORE = 16 }; // that a picture may have beside its first ones

typedef struct ImageEncoding {
    ImageDepth depth;
    ImageTransfer transfer;
    double gamma;      // IMAGE_TRANSFER_POWER only
    bool already_encoded; // values are written as they are; `transfer` only names what the file says of itself
    bool continues;       // of Y4M: a further frame of the film that the same stream holds already
    int threads;          // to use for it, at most; the file does not depend on it
    const ImageNote *notes;
    size_t note_count;
    const ImageChannel *more; // other channels, where image_path_names_channels
    int more_count;           // at most IMAGE_CHANNELS_MORE
} ImageEncoding;

typedef enum ImageStatus {
    IMAGE_OK,
    IMAGE_NO_MEMORY,
    IMAGE_UNKNOWN_FORMAT, // the file name's ending says nothing that can be written
    IMAGE_BAD_DEPTH,      // the format does not have that depth
    IMAGE_NO_MODULE,      // the OpenImageIO module could not be loaded
    IMAGE_IO,             // opening, reading or writing failed
    IMAGE_NOT_A_PICTURE,  // reading: not a picture, truncated, or of an unknown format
    IMAGE_TOO_LARGE,      // reading: more pixels than the limit
} ImageStatus;

typedef struct ImageError {
    char detail[256]; // one line from the system or the library, "" if there is none
    bool no_memory;   // an allocation failed, whatever came of it
} ImageError;

// Whether a path is standard output: `-`, as PNG, or `-.ENDING`, as the format of that ending.
bool image_path_is_stdout(const char *path);

// Whether a path can be written at this depth, asked before a long run: the format by its ending.
ImageStatus image_check_path(const char *path, ImageDepth depth, ImageError *error) RT_MUST_CHECK;

// The depth a path gets when none is requested: float for formats that hold nothing else, such as EXR, else 8 bit.
ImageDepth image_path_depth(const char *path);

// Whether the format that a path's ending names holds channels of any name: EXR.
bool image_path_names_channels(const char *path);

// Whether pictures with alpha can be written to a path: PNG and Targa, which have colours as they are, and EXR, which has them
// multiplied with alpha.
bool image_path_has_alpha(const char *path);

// Writes a picture. Values are clamped to 0..1 for 8 and 16 bit; for float they are written linear and unclamped.
ImageStatus image_write(const Image *image, const ImageEncoding *encoding, const char *path,
                        ImageError *error) RT_MUST_CHECK;

// The bytes of the PNG file that image_write would write, 8 or 16 bit; *bytes is the caller's to free.
ImageStatus image_encode_png(const Image *image, const ImageEncoding *encoding, unsigned char **bytes, size_t *size,
                             ImageError *error) RT_MUST_CHECK;

// Its samples without a file: width * height * channels numbers of 8, 16 or 32 bits, in the machine's byte order. False
// when out of memory.
bool image_samples(const Image *image, const ImageEncoding *encoding, void *samples) RT_MUST_CHECK;

// Reads a picture to values as they are stored, 0..1 for integer formats; no transfer is undone. What begins as PNG
// does is read as PNG, whatever the path's ending.
ImageStatus image_read(const char *path, uint64_t pixel_limit, Image *image, ImageError *error) RT_MUST_CHECK;

enum { IMAGE_THRESHOLDS = 3 };

// How two pictures of equal size differ, over the first three channels.
typedef struct ImageDifference {
    double max;  // greatest |a - b| of any channel
    double rmse;
    double psnr; // in dB, against 1; HUGE_VAL for equal pictures
    double p999; // 99.9th percentile of the pixels' greatest channel difference
    uint64_t pixels_beyond[IMAGE_THRESHOLDS]; // pixels with a channel that differs by more than that threshold
    uint64_t pixels;
} ImageDifference;

// False when sizes differ or memory ran out.
bool image_compare(const Image *a, const Image *b, const double thresholds[IMAGE_THRESHOLDS],
                   ImageDifference *difference) RT_MUST_CHECK;

// The greatest |a - b| of a pixel's first three channels, as image_compare has it.
double image_pixel_difference(const Image *a, const Image *b, size_t pixel);

// The mean of LDR-FLIP over two pictures of equal size that hold linear light, clamped to 0..1: 0 for equal ones, 1 at
// most. Viewed at 67.02 pixels per degree, as from 0.7 m a screen 0.7 m wide with 3840 pixels. Symmetric. False when
// sizes differ or memory ran out: it takes 128 bytes a pixel.
bool image_flip(const Image *a, const Image *b, double *mean) RT_MUST_CHECK;

#endif
