// PPM after netpbm's ppm(5) and pgm(5), Targa after Truevision's "TGA File Format Specification", version 2.0, Y4M after
// mjpegtools' yuv4mpeg(5), its colours after ITU-R BT.601.
//
// SPDX-License-Identifier: MIT
#include "image/plain_write.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum { TARGA_HEADER = 18, TARGA_TRUE_COLOUR = 2, TARGA_GREY = 3, TARGA_FROM_TOP = 0x20, ROWS_AT_ONCE = 64 };
enum { FILM_PLANES = 3, FILM_RATE = 25 };

static bool is_targa(const char *ending)
{
    return strcmp(ending, "tga") == 0;
}

static bool is_ppm(const char *ending)
{
    return strcmp(ending, "ppm") == 0;
}

bool plain_has_format(const char *ending)
{
    return is_targa(ending) || is_ppm(ending) || strcmp(ending, "y4m") == 0;
}

bool plain_has_depth(const char *ending, ImageDepth depth)
{
    return depth == IMAGE_DEPTH_8 || (depth == IMAGE_DEPTH_16 && is_ppm(ending));
}

// A comment a note; a picture of one channel is a PGM, whatever its name.
static bool put_ppm_header(const Image *image, const ImageEncoding *encoding, const AtomicFile *file, ImageError *error)
{
    TextBuffer text;
    text_init(&text);
    text_printf(&text, "P%c\n", image->channels < 3 ? '5' : '6');
    for (size_t i = 0; i < encoding->note_count; i++) {
        if (!encoding->notes[i].is_of_origin) {
            text_printf(&text, "# %s: %s\n", encoding->notes[i].name, encoding->notes[i].text);
        }
    }
    text_printf(&text, "%d %d\n%d\n", image->width, image->height, encoding->depth == IMAGE_DEPTH_8 ? 255 : 65535);
    bool fine = !text.failed && atomic_file_write(file, text_get(&text), text.length, error);
    text_fini(&text);
    return fine;
}

static bool put_targa_header(const Image *image, const AtomicFile *file, ImageError *error)
{
    unsigned char header[TARGA_HEADER] = {
        [2] = image->channels < 3 ? TARGA_GREY : TARGA_TRUE_COLOUR,
        [12] = (unsigned char)image->width,
        [13] = (unsigned char)(image->width >> 8),
        [14] = (unsigned char)image->height,
        [15] = (unsigned char)(image->height >> 8),
        [16] = (unsigned char)(8 * image->channels),
        [17] = TARGA_FROM_TOP | (image->channels == 4 ? 8 : 0), // bits of alpha
    };
    return atomic_file_write(file, header, sizeof header, error);
}

// Targa has blue first.
static void swap_red_and_blue(unsigned char *samples, size_t pixels, size_t channels)
{
    for (size_t i = 0; channels >= 3 && i < pixels * channels; i += channels) {
        unsigned char red = samples[i];
        samples[i] = samples[i + 2];
        samples[i + 2] = red;
    }
}

// PPM has the high byte first.
static void put_high_byte_first(unsigned char *samples, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint16_t code;
        memcpy(&code, samples + 2 * i, sizeof code);
        samples[2 * i] = (unsigned char)(code >> 8);
        samples[2 * i + 1] = (unsigned char)code;
    }
}

// (numerator / denominator + offset) rounded, of a sum that is not negative.
static unsigned char rounded(int numerator, int denominator, int offset)
{
    return (unsigned char)((numerator + offset * denominator + denominator / 2) / denominator);
}

// Codes of red, green and blue to luma of 16..235 and differences of colour of 16..240, one plane each.
static void put_planes(const unsigned char *samples, size_t pixels, int channels, size_t plane, unsigned char *out)
{
    int green = channels >= 3 ? 1 : 0, blue = channels >= 3 ? 2 : 0;
    for (size_t i = 0; i < pixels; i++) {
        const unsigned char *code = samples + i * (size_t)channels;
        int r = code[0], g = code[green], b = code[blue];
        out[i] = rounded(219 * (299 * r + 587 * g + 114 * b), 255 * 1000, 16);
        out[plane + i] = rounded(224 * (886 * b - 299 * r - 587 * g), 255 * 2 * 886, 128);
        out[2 * plane + i] = rounded(224 * (701 * r - 587 * g - 114 * b), 255 * 2 * 701, 128);
    }
}

// A frame of a film: colours at full resolution, since any size can have them.
static ImageStatus write_frame(const Image *image, const Encoder *encoder, const AtomicFile *file, ImageError *error)
{
    size_t width = (size_t)image->width, plane = width * (size_t)image->height;
    unsigned char *planes = malloc(plane * FILM_PLANES), *samples = malloc(width * (size_t)image->channels);
    char header[128];
    int length = snprintf(header, sizeof header, "YUV4MPEG2 W%d H%d F%d:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n", image->width,
                          image->height, FILM_RATE);
    bool is_enough = planes && samples;
    for (size_t y = 0; is_enough && y < (size_t)image->height; y++) {
        encoder_run(encoder, image->values + y * width * (size_t)image->channels, width, samples);
        put_planes(samples, width, image->channels, plane, planes + y * width);
    }
    bool fine = is_enough && (encoder->encoding.continues || atomic_file_write(file, header, (size_t)length, error)) &&
                atomic_file_write(file, "FRAME\n", 6, error) &&
                atomic_file_write(file, planes, plane * FILM_PLANES, error);
    free(planes);
    free(samples);
    return fine ? IMAGE_OK : is_enough ? IMAGE_IO : IMAGE_NO_MEMORY;
}

ImageStatus plain_write(const char *ending, const Image *image, const Encoder *encoder, const AtomicFile *file,
                        ImageError *error)
{
    if (!is_targa(ending) && !is_ppm(ending)) {
        return write_frame(image, encoder, file, error);
    }
    bool targa = is_targa(ending);
    size_t channels = (size_t)image->channels, width = (size_t)image->width;
    size_t row = width * channels * encode_sample_bytes(encoder->encoding.depth);
    unsigned char *samples = malloc(row * ROWS_AT_ONCE);
    if (!samples) {
        return IMAGE_NO_MEMORY;
    }
    bool fine = targa ? put_targa_header(image, file, error) : put_ppm_header(image, &encoder->encoding, file, error);
    for (int y = 0; fine && y < image->height; y += ROWS_AT_ONCE) {
        size_t rows = (size_t)(image->height - y < ROWS_AT_ONCE ? image->height - y : ROWS_AT_ONCE);
        encoder_run(encoder, image->values + (size_t)y * width * channels, rows * width, samples);
        if (targa) {
            swap_red_and_blue(samples, rows * width, channels);
        } else if (encoder->encoding.depth == IMAGE_DEPTH_16) {
            put_high_byte_first(samples, rows * width * channels);
        }
        fine = atomic_file_write(file, samples, rows * row, error);
    }
    free(samples);
    return fine ? IMAGE_OK : IMAGE_IO;
}
