// A PNG file: libpng writes its chunks, png_strips.c makes what stands in those of the pixels.
//
// libpng reports errors by longjmp; the only function that it may return into is write_guarded, which owns nothing.
//
// SPDX-License-Identifier: MIT
#include "image/png_write.h"

#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "image/png_fault.h"
#include "image/png_strips.h"

enum { SRGB_GAMMA = 45455, IDAT_MOST = 1 << 30, BUFFER_BYTES = 32768 };

typedef struct PngWriter {
    const Image *image;
    const Encoder *encoder;
    PngSink sink;
    ImageError *error;
    png_structp png;
    png_infop info;
    PngStrips *strips;
    bool no_memory, is_whole;
    size_t held; // bytes that are not written yet: pieces of even pictures are short, and many
    unsigned char buffer[BUFFER_BYTES];
} PngWriter;

static void bytes_write(const PngWriter *writer, const void *bytes, size_t length)
{
    if (!writer->sink.put(writer->sink.client, bytes, length, writer->error)) {
        png_error(writer->png, "write error");
    }
}

static void on_flush(png_structp png)
{
    PngWriter *writer = png_get_io_ptr(png);

    bytes_write(writer, writer->buffer, writer->held);
    writer->held = 0;
}

static void on_write(png_structp png, png_bytep data, size_t length)
{
    PngWriter *writer = png_get_io_ptr(png);

    if (writer->held + length > sizeof writer->buffer) {
        on_flush(png);
    }
    if (length > sizeof writer->buffer) {
        bytes_write(writer, data, length);
    } else {
        memcpy(writer->buffer + writer->held, data, length);
        writer->held += length;
    }
}

// A chunk tEXt (PNG 1.2, 4.2.3): png_set_text would keep a copy, and leaks it where memory ends.
static void note_write(const PngWriter *writer, const char *name, const char *text)
{
    static const png_byte type[] = "tEXt";
    size_t name_size = strlen(name) + 1, length = strlen(text);

    png_write_chunk_start(writer->png, type, (png_uint_32)(name_size + length));
    png_write_chunk_data(writer->png, (png_const_bytep)name, name_size);
    png_write_chunk_data(writer->png, (png_const_bytep)text, length);
    png_write_chunk_end(writer->png);
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
    png_write_info(writer->png, writer->info);
    for (size_t i = 0; i < encoding->note_count; i++) {
        note_write(writer, encoding->notes[i].name, encoding->notes[i].text);
    }
}

static void piece_write(const PngWriter *writer, const unsigned char *bytes, size_t size)
{
    static const png_byte idat[] = "IDAT";

    for (size_t part; size > 0; bytes += part, size -= part) {
        part = size < IDAT_MOST ? size : IDAT_MOST;
        png_write_chunk(writer->png, idat, bytes, part);
    }
}

static void pixels_write(PngWriter *writer)
{
    const unsigned char *bytes;
    size_t size;

    while (png_strips_piece(writer->strips, &bytes, &size, &writer->no_memory)) {
        piece_write(writer, bytes, size);
    }
}

// No local variable is live across the jump. False: the error is recorded.
static bool write_guarded(PngWriter *writer)
{
    static const png_byte iend[] = "IEND";

    if (setjmp(png_jmpbuf(writer->png)) != 0) {
        return false;
    }
    header_write(writer);
    pixels_write(writer);
    png_write_chunk(writer->png, iend, NULL, 0);
    on_flush(writer->png);
    return !writer->no_memory;
}

// The first thread writes what all of them make.
static void thread_run(void *client, int number)
{
    PngWriter *writer = client;

    if (number == 0) {
        writer->is_whole = write_guarded(writer);
        png_strips_stop(writer->strips);
    } else {
        png_strips_work(writer->strips);
    }
}

ImageStatus png_write(const Image *image, const Encoder *encoder, PngSink sink, ImageError *error)
{
    PngWriter *writer = calloc(1, sizeof *writer);
    ImageStatus status = IMAGE_NO_MEMORY;

    if (!writer) {
        return status;
    }
    writer->image = image;
    writer->encoder = encoder;
    writer->sink = sink;
    writer->error = error;
    writer->strips = png_strips_new(image, encoder);
    writer->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, error, png_fault_error, png_fault_warning, error,
                                            png_fault_malloc, png_fault_free);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    if (writer->strips && writer->info) {
        png_set_write_fn(writer->png, writer, on_write, on_flush);
        int strips = png_strips_count(writer->strips), threads = encoder->encoding.threads;
        parallel_run(threads < strips ? threads : strips, thread_run, writer);
        bool no_memory = writer->no_memory || error->no_memory;
        status = no_memory ? IMAGE_NO_MEMORY : writer->is_whole ? IMAGE_OK : IMAGE_IO;
    }
    png_destroy_write_struct(&writer->png, &writer->info);
    png_strips_free(writer->strips);
    free(writer);
    return status;
}
