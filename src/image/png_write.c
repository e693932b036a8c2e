// Encoded rows to a PNG stream. Level 1 and the Sub filter: the measured optimum of time against size for renderings.
//
// libpng reports errors by longjmp; the only function that it may return into is write_guarded, which owns nothing.
//
// SPDX-License-Identifier: MIT
#include "image/png_write.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

#include "image/image_error.h"

enum { DEFLATE_LEVEL = 1, CHUNK_BYTES = 1 << 16, SRGB_GAMMA = 45455 };

typedef struct PngWriter {
    const Image *image;
    const Encoder *encoder;
    const AtomicFile *file;
    ImageError *error;
    png_structp png;
    png_infop info;
    unsigned char *row;
} PngWriter;

static void on_error(png_structp png, png_const_charp message)
{
    ImageError *error = png_get_error_ptr(png);

    if (error->detail[0] == '\0') { // else the system's own message stands there
        image_error_set(error, "%s", message);
    }
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep data, size_t length)
{
    const PngWriter *writer = png_get_io_ptr(png);

    if (!atomic_file_write(writer->file, data, length, writer->error)) {
        png_error(png, "write error");
    }
}

static void on_flush(png_structp png)
{
    (void)png;
}

static void header_write(const PngWriter *writer)
{
    static const int colour_types[] = {[1] = PNG_COLOR_TYPE_GRAY,
                                       [2] = PNG_COLOR_TYPE_GRAY_ALPHA,
                                       [3] = PNG_COLOR_TYPE_RGB,
                                       [4] = PNG_COLOR_TYPE_RGB_ALPHA};
    const Image *image = writer->image;
    const ImageEncoding *encoding = &writer->encoder->encoding;
    int bits = encoding->depth == IMAGE_DEPTH_8 ? 8 : 16;

    png_set_user_limits(writer->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(writer->png, writer->info, (png_uint_32)image->width, (png_uint_32)image->height, bits,
                 colour_types[image->channels], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (encoding->transfer == IMAGE_TRANSFER_SRGB) {
        png_set_sRGB(writer->png, writer->info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_gAMA_fixed(writer->png, writer->info, SRGB_GAMMA);
    } else {
        png_set_gAMA_fixed(writer->png, writer->info, (png_fixed_point)lround(100000.0 / encoding->gamma));
    }
    png_set_compression_level(writer->png, DEFLATE_LEVEL);
    png_set_compression_buffer_size(writer->png, CHUNK_BYTES);
    png_set_filter(writer->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_write_info(writer->png, writer->info);
}

static void rows_write(const PngWriter *writer)
{
    const Image *image = writer->image;
    size_t row_values = (size_t)image->width * (size_t)image->channels;

    for (int y = 0; y < image->height; y++) {
        encoder_run(writer->encoder, image->values + (size_t)y * row_values, (size_t)image->width, writer->row);
        png_write_row(writer->png, writer->row);
    }
}

// No local variable is live across the jump. False: the error is recorded.
static bool write_guarded(const PngWriter *writer)
{
    if (setjmp(png_jmpbuf(writer->png)) != 0) {
        return false;
    }
    header_write(writer);
#if __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    if (writer->encoder->encoding.depth == IMAGE_DEPTH_16) {
        png_set_swap(writer->png);
    }
#endif
    rows_write(writer);
    png_write_end(writer->png, NULL);
    return true;
}

ImageStatus png_write(const Image *image, const Encoder *encoder, const AtomicFile *file, ImageError *error)
{
    PngWriter writer = {.image = image, .encoder = encoder, .file = file, .error = error};
    size_t sample_bytes = encode_sample_bytes(encoder->encoding.depth);
    ImageStatus status = IMAGE_NO_MEMORY;

    writer.row = malloc((size_t)image->width * (size_t)image->channels * sample_bytes);
    writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, error, on_error, on_warning);
    writer.info = writer.png != NULL ? png_create_info_struct(writer.png) : NULL;
    if (writer.row != NULL && writer.info != NULL) {
        png_set_write_fn(writer.png, &writer, on_write, on_flush);
        status = write_guarded(&writer) ? IMAGE_OK : IMAGE_IO;
    }
    png_destroy_write_struct(&writer.png, &writer.info);
    free(writer.row);
    return status;
}
