// A df3 stream to samples: three sizes of 16 bits, then a whole number for each place, x by x, row by row, layer by
// layer, all with the high byte first. How many bytes a number has, 1, 2 or 4, the file's length says.
//
// Layers lie one below the other, as if they were one picture. Numbers of 32 bits become floats from 0 to 1, in place.
//
// SPDX-License-Identifier: MIT
#include "image/df3_read.h"

#include <limits.h>
#include <string.h>

#include "image/image_error.h"

enum { HEADER_BYTES = 6 };

static uint32_t high_first(const uint8_t *bytes, unsigned count)
{
    uint32_t number = 0;

    for (unsigned i = 0; i < count; i++) {
        number = number << 8 | bytes[i];
    }
    return number;
}

// Sets sizes and depth by the head and the length of the stream, and leaves that behind its head.
static ImageStatus head_read(FILE *stream, PictureFile *file, unsigned *bytes, ImageError *error)
{
    uint8_t head[HEADER_BYTES];
    long length;

    if (fread(head, 1, sizeof head, stream) != sizeof head) {
        image_error_set(error, "the file ends too soon");
        return IMAGE_NOT_A_PICTURE;
    }
    uint32_t width = high_first(head, 2), rows = high_first(head + 2, 2), layers = high_first(head + 4, 2);
    uint64_t height = (uint64_t)rows * layers, values = height * width;
    if (fseek(stream, 0, SEEK_END) != 0 || (length = ftell(stream)) < 0 || fseek(stream, HEADER_BYTES, SEEK_SET) != 0) {
        image_error_set(error, "its length cannot be found out");
        return IMAGE_IO;
    }
    *bytes = 1;
    while (*bytes < 4 && *bytes * values + HEADER_BYTES != (uint64_t)length) {
        *bytes *= 2;
    }
    if (values == 0 || height > INT_MAX || *bytes * values + HEADER_BYTES != (uint64_t)length) {
        image_error_set(error, "it has %ld bytes, and not 6 and then 1, 2 or 4 for each of %lu x %lu x %lu values",
                        length, (unsigned long)width, (unsigned long)rows, (unsigned long)layers);
        return IMAGE_NOT_A_PICTURE;
    }
    file->width = (int)width;
    file->height = (int)height;
    file->layers = (int)layers;
    file->channels = 1;
    file->bits = (int)(*bytes * 8);
    file->depth = *bytes == 1 ? IMAGE_DEPTH_8 : *bytes == 2 ? IMAGE_DEPTH_16 : IMAGE_DEPTH_FLOAT;
    return IMAGE_OK;
}

static void turn_over(void *samples, size_t count, unsigned bytes)
{
    uint8_t *at = samples;

    for (size_t i = 0; bytes > 1 && i < count; i++, at += bytes) {
        uint32_t number = high_first(at, bytes);
        uint16_t narrow = (uint16_t)number;
        float share = (float)(number / 4294967295.0);

        if (bytes == 2) {
            memcpy(at, &narrow, sizeof narrow);
        } else {
            memcpy(at, &share, sizeof share);
        }
    }
}

ImageStatus df3_read(FILE *stream, const PictureLimit *limit, PictureFile *file, ImageError *error)
{
    unsigned bytes;
    ImageStatus status = head_read(stream, file, &bytes, error);

    if (status == IMAGE_OK) {
        status = picture_file_allocate(file, limit);
    }
    if (status != IMAGE_OK) {
        return status;
    }
    size_t count = (size_t)file->width * (size_t)file->height;
    if (fread(file->samples, bytes, count, stream) != count) {
        image_error_set(error, "the file ends too soon");
        return IMAGE_IO;
    }
    turn_over(file->samples, count, bytes);
    return IMAGE_OK;
}
