// PPM after netpbm's ppm(5) and pgm(5), Targa after Truevision's "TGA File Format Specification", version 2.0.
//
// SPDX-License-Identifier: MIT
#include "image/plain_write.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum { TARGA_HEADER = 18, TARGA_TRUE_COLOUR = 2, TARGA_GREY = 3, TARGA_FROM_TOP = 0x20, ROWS_AT_ONCE = 64 };

static bool is_targa(const char *ending)
{
    return strcmp(ending, "tga") == 0;
}

bool plain_has_format(const char *ending)
{
    return is_targa(ending) || strcmp(ending, "ppm") == 0;
}

bool plain_has_depth(const char *ending, ImageDepth depth)
{
    return depth == IMAGE_DEPTH_8 || (depth == IMAGE_DEPTH_16 && !is_targa(ending));
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

ImageStatus plain_write(const char *ending, const Image *image, const Encoder *encoder, const AtomicFile *file,
                        ImageError *error)
{
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
