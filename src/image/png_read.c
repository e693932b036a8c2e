// A PNG stream to an Image: values of 8 and 16 bits as they are stored, palettes and small depths widened.
//
// OpenImageIO reads PNG too, but through a libpng that prints its errors. libpng reports them by longjmp; the only
// function that it may return into is read_guarded, which owns nothing.
//
// SPDX-License-Identifier: MIT
#include "image/png_read.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "image/image_error.h"

enum { SIGNATURE_BYTES = 8, PASSES_MAX = 7 };

typedef struct PngReader {
    FILE *stream;
    uint64_t pixel_limit;
    Image *image;
    ImageError *error;
    png_structp png;
    png_infop info;
    unsigned char *rows; // the whole picture as it is stored
    ImageStatus status;
} PngReader;

static void on_error(png_structp png, png_const_charp message)
{
    image_error_set(png_get_error_ptr(png), "%s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_read(png_structp png, png_bytep data, size_t length)
{
    const PngReader *reader = png_get_io_ptr(png);

    if (fread(data, 1, length, reader->stream) != length) {
        png_error(png, "the file ends too soon");
    }
}

bool png_is_there(FILE *stream)
{
    unsigned char bytes[SIGNATURE_BYTES];
    bool is_png = fread(bytes, 1, sizeof bytes, stream) == sizeof bytes && png_sig_cmp(bytes, 0, sizeof bytes) == 0;

    rewind(stream);
    return is_png;
}

// Asks for 8 or 16 bits in each of 1 to 4 channels, 16 of them in the order of this machine.
static void form_choose(const PngReader *reader)
{
    png_set_expand(reader->png);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    png_set_swap(reader->png);
#endif
}

static bool memory_take(PngReader *reader)
{
    uint64_t width = png_get_image_width(reader->png, reader->info);
    uint64_t height = png_get_image_height(reader->png, reader->info);

    if (width * height > reader->pixel_limit || width > INT32_MAX || height > INT32_MAX) {
        reader->status = IMAGE_TOO_LARGE;
        return false;
    }
    reader->rows = malloc(png_get_rowbytes(reader->png, reader->info) * (size_t)height);
    reader->status = IMAGE_NO_MEMORY;
    return reader->rows != NULL &&
           image_init(reader->image, (int)width, (int)height, png_get_channels(reader->png, reader->info));
}

static void values_make(const PngReader *reader)
{
    const Image *image = reader->image;
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;

    for (size_t i = 0; i < count; i++) {
        if (png_get_bit_depth(reader->png, reader->info) == 16) {
            uint16_t code;
            memcpy(&code, reader->rows + 2 * i, sizeof code);
            image->values[i] = (float)code / 65535.0f;
        } else {
            image->values[i] = (float)reader->rows[i] / 255.0f;
        }
    }
}

// No local variable is live across the jump.
static void read_guarded(PngReader *reader)
{
    if (setjmp(png_jmpbuf(reader->png)) != 0) {
        reader->status = IMAGE_NOT_A_PICTURE;
        return;
    }
    png_read_info(reader->png, reader->info);
    form_choose(reader);
    (void)png_set_interlace_handling(reader->png);
    png_read_update_info(reader->png, reader->info);
    if (!memory_take(reader)) {
        return;
    }
    for (int pass = png_get_interlace_type(reader->png, reader->info) == PNG_INTERLACE_NONE ? PASSES_MAX - 1 : 0;
         pass < PASSES_MAX; pass++) {
        for (int y = 0; y < reader->image->height; y++) {
            png_read_row(reader->png, reader->rows + (size_t)y * png_get_rowbytes(reader->png, reader->info), NULL);
        }
    }
    png_read_end(reader->png, NULL);
    values_make(reader);
    reader->status = IMAGE_OK;
}

ImageStatus png_read(FILE *stream, uint64_t pixel_limit, Image *image, ImageError *error)
{
    PngReader reader = {.stream = stream, .pixel_limit = pixel_limit, .image = image, .error = error};

    reader.status = IMAGE_NO_MEMORY;
    reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, error, on_error, on_warning);
    reader.info = reader.png != NULL ? png_create_info_struct(reader.png) : NULL;
    if (reader.info != NULL) {
        png_set_read_fn(reader.png, &reader, on_read);
        png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        read_guarded(&reader);
    }
    png_destroy_read_struct(&reader.png, &reader.info, NULL);
    free(reader.rows);
    return reader.status;
}
