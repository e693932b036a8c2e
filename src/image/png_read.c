// A PNG stream to samples of 8 or 16 bits as they are stored, with its palette and what it says of its gamma.
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

#include "image/png_fault.h"

enum { PASSES_MAX = 7 };

typedef struct PngReader {
    FILE *stream;
    const PictureLimit *limit;
    PictureFile *file;
    ImageError *error;
    png_structp png;
    png_infop info;
    ImageStatus status;
} PngReader;

static void on_read(png_structp png, png_bytep data, size_t length)
{
    const PngReader *reader = png_get_io_ptr(png);

    if (fread(data, 1, length, reader->stream) != length) {
        png_error(png, "the file ends too soon");
    }
}

// Asks for whole bytes, 16 bits in the order of this machine. Grey of less than 8 bits is widened, places in a palette
// are not, and a colour that is to be transparent stays as it is.
static void form_choose(const PngReader *reader)
{
    if (png_get_color_type(reader->png, reader->info) == PNG_COLOR_TYPE_PALETTE) {
        png_set_packing(reader->png);
    } else {
        png_set_expand_gray_1_2_4_to_8(reader->png);
    }
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    png_set_swap(reader->png);
#endif
}

static void palette_take(const PngReader *reader)
{
    PictureFile *file = reader->file;
    png_colorp colours;
    png_bytep alphas = NULL;
    int count = 0, alpha_count = 0;

    file->has_key = png_get_valid(reader->png, reader->info, PNG_INFO_tRNS) != 0;
    if (png_get_PLTE(reader->png, reader->info, &colours, &count) == 0 ||
        png_get_color_type(reader->png, reader->info) != PNG_COLOR_TYPE_PALETTE) {
        return;
    }
    if (file->has_key && png_get_tRNS(reader->png, reader->info, &alphas, &alpha_count, NULL) == 0) {
        alpha_count = 0;
    }
    file->has_key = false;
    file->palette_count = count;
    for (int i = 0; i < count; i++) {
        uint8_t alpha = i < alpha_count ? alphas[i] : UINT8_MAX;
        memcpy(file->palette[i], (uint8_t[]){colours[i].red, colours[i].green, colours[i].blue, alpha}, 4);
    }
}

// The chunk sRGB goes before gAMA, as the format's definition has it.
static void gamma_take(const PngReader *reader)
{
    int intent;
    double exponent;

    if (png_get_sRGB(reader->png, reader->info, &intent) != 0) {
        reader->file->has_gamma = true;
    } else if (png_get_gAMA(reader->png, reader->info, &exponent) != 0 && exponent > 0.0) {
        reader->file->has_gamma = true;
        reader->file->gamma = 1.0 / exponent;
    }
}

// Whether there may be room for the picture, asked before the library takes memory for its rows.
static bool size_take(PngReader *reader)
{
    PictureFile *file = reader->file;
    uint32_t width = png_get_image_width(reader->png, reader->info);
    uint32_t height = png_get_image_height(reader->png, reader->info);

    if (width > INT32_MAX || height > INT32_MAX) {
        reader->status = IMAGE_TOO_LARGE;
        return false;
    }
    file->width = (int)width;
    file->height = (int)height;
    uint64_t pixels = (uint64_t)width * height; // below 2^62
    uint64_t depth_bytes = png_get_bit_depth(reader->png, reader->info) == 16 ? 2 : 1;
    uint64_t bytes = png_get_channels(reader->png, reader->info) * depth_bytes; // of a pixel, at least
    bool has_room = pixels <= reader->limit->pixels && pixels <= reader->limit->bytes / bytes;
    reader->status = has_room ? reader->status : IMAGE_TOO_LARGE;
    return has_room;
}

static bool memory_take(PngReader *reader)
{
    PictureFile *file = reader->file;

    file->channels = png_get_channels(reader->png, reader->info);
    file->depth = png_get_bit_depth(reader->png, reader->info) == 16 ? IMAGE_DEPTH_16 : IMAGE_DEPTH_8;
    reader->status = picture_file_allocate(file, reader->limit);
    return reader->status == IMAGE_OK;
}

static bool is_cancelled(const PictureLimit *limit)
{
    return limit->cancel && atomic_load_explicit(limit->cancel, memory_order_relaxed);
}

// No local variable is live across the jump.
static void read_guarded(PngReader *reader)
{
    if (setjmp(png_jmpbuf(reader->png)) != 0) {
        reader->status = IMAGE_NOT_A_PICTURE;
        return;
    }
    png_read_info(reader->png, reader->info);
    if (!size_take(reader)) {
        return;
    }
    reader->file->bits = png_get_bit_depth(reader->png, reader->info);
    form_choose(reader);
    (void)png_set_interlace_handling(reader->png);
    png_read_update_info(reader->png, reader->info);
    palette_take(reader);
    gamma_take(reader);
    if (!memory_take(reader)) {
        return;
    }
    reader->status = IMAGE_IO; // until it is whole
    for (int pass = png_get_interlace_type(reader->png, reader->info) == PNG_INTERLACE_NONE ? PASSES_MAX - 1 : 0;
         pass < PASSES_MAX; pass++) {
        for (int y = 0; y < reader->file->height; y++) {
            if (is_cancelled(reader->limit)) {
                return;
            }
            png_bytep rows = reader->file->samples;
            png_read_row(reader->png, rows + (size_t)y * png_get_rowbytes(reader->png, reader->info), NULL);
        }
    }
    png_read_end(reader->png, NULL);
    reader->status = IMAGE_OK;
}

ImageStatus png_read(FILE *stream, const PictureLimit *limit, PictureFile *file, ImageError *error)
{
    PngReader reader = {.stream = stream, .limit = limit, .file = file, .error = error};

    reader.status = IMAGE_NO_MEMORY;
    reader.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, error, png_fault_error, png_fault_warning, error,
                                          png_fault_malloc, png_fault_free);
    reader.info = reader.png ? png_create_info_struct(reader.png) : NULL;
    if (reader.info) {
        png_set_read_fn(reader.png, &reader, on_read);
        png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_benign_errors(reader.png, 1); // what is wrong beside the pixels
        read_guarded(&reader);
    }
    png_destroy_read_struct(&reader.png, &reader.info, NULL);
    return error->no_memory ? IMAGE_NO_MEMORY : reader.status;
}
