// A JPEG stream to samples of 8 bits, grey or red, green and blue.
//
// OpenImageIO reads JPEG too, by the same library, but takes 0.3 s to load. libjpeg reports errors by
// longjmp; the only function that it may return into is read_guarded, which owns nothing. Refused like by POV-Ray are
// pictures stored as inks and files that end too soon; damage within a file, which it draws, is a warning.
//
// SPDX-License-Identifier: MIT
#include "image/jpeg_module.h"

#include <setjmp.h>
#include <stdlib.h>

#include <jerror.h>
#include <jpeglib.h>

#include "image/image_error.h"

typedef struct JpegReader {
    struct jpeg_error_mgr faults; // first, as libjpeg hands its address back
    jmp_buf jump;
    struct jpeg_decompress_struct decoder;
    const PictureLimit *limit;
    ImageStatus (*allocate)(PictureFile *, const PictureLimit *);
    PictureFile *file;
    ImageError *error;
    ImageStatus status;
} JpegReader;

static void on_fault(j_common_ptr decoder)
{
    JpegReader *reader = (JpegReader *)decoder->err;
    char text[JMSG_LENGTH_MAX];

    decoder->err->format_message(decoder, text);
    image_error_set(reader->error, "%s", text);
    longjmp(reader->jump, 1);
}

// Below 0 is a warning of damaged data, for which libjpeg fills in something; above are traces of what it does.
static void on_message(j_common_ptr decoder, int level)
{
    JpegReader *reader = (JpegReader *)decoder->err;

    if (level < 0 && decoder->err->msg_code == JWRN_JPEG_EOF) {
        on_fault(decoder);
    }
    reader->file->is_damaged = reader->file->is_damaged || level < 0;
}

static bool memory_take(JpegReader *reader)
{
    PictureFile *file = reader->file;

    file->width = (int)reader->decoder.output_width; // at most 65535, as the height
    file->height = (int)reader->decoder.output_height;
    file->channels = reader->decoder.output_components;
    file->depth = IMAGE_DEPTH_8;
    file->bits = reader->decoder.data_precision;
    reader->status = reader->allocate(file, reader->limit);
    return reader->status == IMAGE_OK;
}

// No local variable is live across the jump.
static void read_guarded(JpegReader *reader, FILE *stream)
{
    struct jpeg_decompress_struct *decoder = &reader->decoder;

    if (setjmp(reader->jump) != 0) {
        reader->status = IMAGE_NOT_A_PICTURE;
        return;
    }
    jpeg_create_decompress(decoder);
    jpeg_stdio_src(decoder, stream);
    (void)jpeg_read_header(decoder, TRUE);
    if (decoder->jpeg_color_space == JCS_CMYK || decoder->jpeg_color_space == JCS_YCCK) {
        image_error_set(reader->error, "it holds four inks (CMYK); save it as red, green and blue");
        reader->status = IMAGE_NOT_A_PICTURE;
        return;
    }
    jpeg_calc_output_dimensions(decoder);
    if (!memory_take(reader)) {
        return;
    }
    (void)jpeg_start_decompress(decoder);
    while (decoder->output_scanline < decoder->output_height) {
        JSAMPROW row = (JSAMPROW)reader->file->samples +
                       (size_t)decoder->output_scanline * decoder->output_width * (size_t)decoder->output_components;
        (void)jpeg_read_scanlines(decoder, &row, 1);
    }
    (void)jpeg_finish_decompress(decoder);
}

static ImageStatus jpeg_read(FILE *stream, const PictureLimit *limit,
                             ImageStatus (*allocate)(PictureFile *, const PictureLimit *), PictureFile *file,
                             ImageError *error)
{
    JpegReader reader = {.limit = limit, .allocate = allocate, .file = file, .error = error};

    reader.decoder.err = jpeg_std_error(&reader.faults);
    reader.faults.error_exit = on_fault;
    reader.faults.emit_message = on_message;
    read_guarded(&reader, stream);
    jpeg_destroy_decompress(&reader.decoder);
    return reader.status;
}

const JpegModule rtlang_jpeg_module = {JPEG_MODULE_VERSION, jpeg_read};
