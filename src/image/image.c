// Pictures in memory, and the way of each to the writer or reader that knows its format.
//
// It owns the decision by the file name's ending; it must not know what any format looks like.
//
// SPDX-License-Identifier: MIT
#include "image/image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "image/atomic_file.h"
#include "image/encode.h"
#include "image/exr_write.h"
#include "image/image_error.h"
#include "image/module.h"
#include "image/picture_file.h"
#include "image/plain_write.h"
#include "image/png_write.h"

enum { ENDING_MAX = 8 };

typedef struct RowSource {
    const Image *image;
    Encoder encoder;
} RowSource;

bool image_init(Image *image, int width, int height, int channels)
{
    size_t row = (size_t)width * (size_t)channels; // at most 2^33: no overflow

    *image = (Image){.width = width, .height = height, .channels = channels};
    image->values = calloc(row * sizeof *image->values, (size_t)height);
    return image->values != NULL;
}

void image_fini(Image *image)
{
    free(image->values);
    *image = (Image){0};
}

// The ending in lower case, without its dot; false when there is none that could name a format.
static bool path_ending(const char *path, char ending[static ENDING_MAX + 1])
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t length = dot ? strlen(dot + 1) : 0;

    if (dot == name || length == 0 || length > ENDING_MAX) {
        return false;
    }
    for (size_t i = 0; i <= length; i++) {
        char c = dot[1 + i];
        bool is_upper = c >= 'A' && c <= 'Z';
        ending[i] = is_upper ? (char)(c - 'A' + 'a') : c;
    }
    return true;
}

bool image_path_is_stdout(const char *path)
{
    return path[0] == '-' && (path[1] == '\0' || (path[1] == '.' && !strchr(path, '/')));
}

// What atomic_file.h calls it.
static const char *file_path(const char *path)
{
    return image_path_is_stdout(path) ? "-" : path;
}

static bool is_open_exr(const char *ending)
{
    return strcmp(ending, "exr") == 0 || strcmp(ending, "sxr") == 0 || strcmp(ending, "mxr") == 0;
}

// Finds the format. *module is NULL for what needs none.
static ImageStatus format_find(const char *path, ImageDepth depth, char ending[static ENDING_MAX + 1],
                               const OiioModule **module, ImageError *error)
{
    *module = NULL;
    image_error_clear(error);
    if (strcmp(path, "-") == 0) {
        strcpy(ending, "png");
    } else if (!path_ending(path, ending)) {
        return IMAGE_UNKNOWN_FORMAT;
    }
    if (strcmp(ending, "png") == 0) {
        return depth == IMAGE_DEPTH_FLOAT ? IMAGE_BAD_DEPTH : IMAGE_OK;
    }
    if (is_open_exr(ending)) {
        return depth == IMAGE_DEPTH_FLOAT ? IMAGE_OK : IMAGE_BAD_DEPTH;
    }
    if (plain_has_format(ending)) {
        return plain_has_depth(ending, depth) ? IMAGE_OK : IMAGE_BAD_DEPTH;
    }
    ImageStatus status = module_load_oiio(module, error);
    return status == IMAGE_OK ? (*module)->check(ending, depth, error) : status;
}

// Whether the path's ending is one of these.
static bool path_ends_with(const char *path, const char *const *endings, size_t count)
{
    char ending[ENDING_MAX + 1];

    if (path_ending(path, ending)) {
        for (size_t i = 0; i < count; i++) {
            if (strcmp(ending, endings[i]) == 0) {
                return true;
            }
        }
    }
    return false;
}

ImageDepth image_path_depth(const char *path)
{
    static const char *const float_only[] = {"exr", "sxr", "mxr", "hdr", "rgbe"};

    return path_ends_with(path, float_only, RT_COUNT_OF(float_only)) ? IMAGE_DEPTH_FLOAT : IMAGE_DEPTH_8;
}

bool image_path_names_channels(const char *path)
{
    char ending[ENDING_MAX + 1];

    return path_ending(path, ending) && is_open_exr(ending);
}

bool image_path_has_alpha(const char *path)
{
    static const char *const straight[] = {"png", "tga"};

    return strcmp(path, "-") == 0 || path_ends_with(path, straight, RT_COUNT_OF(straight)) ||
           image_path_names_channels(path);
}

ImageStatus image_check_path(const char *path, ImageDepth depth, ImageError *error)
{
    char ending[ENDING_MAX + 1];
    const OiioModule *module;
    ImageStatus status = format_find(path, depth, ending, &module, error);

    if (status != IMAGE_OK) {
        return status;
    }
    return atomic_file_check(file_path(path), error) ? IMAGE_OK : IMAGE_IO;
}

// The picture's own channels and more, floats and counts of 4 bytes each.
static void channels_fetch(const RowSource *source, size_t first, size_t pixels, unsigned char *samples)
{
    const Image *image = source->image;
    const ImageEncoding *encoding = &source->encoder.encoding;
    size_t own = (size_t)image->channels, all = own + (size_t)encoding->more_count;

    for (size_t i = 0; i < pixels; i++) {
        unsigned char *pixel = samples + i * all * sizeof(float);
        encoder_run(&source->encoder, image->values + (first + i) * own, 1, pixel);
        for (int c = 0; c < encoding->more_count; c++) {
            const ImageChannel *channel = &encoding->more[c];
            const unsigned char *from = channel->first;
            memcpy(pixel + (own + (size_t)c) * sizeof(float), from + (first + i) * (size_t)channel->step * sizeof(float),
                   sizeof(float));
        }
    }
}

static void rows_fetch(const void *client, int first_row, int row_count, void *samples)
{
    const RowSource *source = client;
    const Image *image = source->image;
    size_t width = (size_t)image->width;
    const float *values = image->values + (size_t)first_row * width * (size_t)image->channels;

    if (source->encoder.encoding.more_count > 0) {
        channels_fetch(source, (size_t)first_row * width, width * (size_t)row_count, samples);
        return;
    }
    encoder_run(&source->encoder, values, width * (size_t)row_count, samples);
}

static ImageStatus bytes_put(const void *client, const void *bytes, size_t length, ImageError *error)
{
    return atomic_file_write(client, bytes, length, error) ? IMAGE_OK : IMAGE_IO;
}

// Bytes that are written to memory.
typedef ARRAY(unsigned char) ByteArray;

static bool file_put(void *client, const void *bytes, size_t length, ImageError *error)
{
    return atomic_file_write(client, bytes, length, error);
}

static bool memory_put(void *client, const void *bytes, size_t length, ImageError *error)
{
    ByteArray *out = client;

    if (!ARRAY_RESERVE(out, out->count + length)) {
        snprintf(error->detail, sizeof error->detail, "out of memory");
        return false;
    }
    memcpy(out->items + out->count, bytes, length);
    out->count += length;
    return true;
}

ImageStatus image_encode_png(const Image *image, const ImageEncoding *encoding, unsigned char **bytes, size_t *size,
                             ImageError *error)
{
    ByteArray out = {0};
    Encoder *encoder = malloc(sizeof *encoder);
    ImageStatus status = IMAGE_NO_MEMORY;

    if (encoder) {
        encoder_init(encoder, encoding, image->channels);
        status = png_write(image, encoder, (PngSink){&out, memory_put}, error);
        free(encoder);
    }
    if (status != IMAGE_OK) {
        ARRAY_FREE(&out);
        return status == IMAGE_IO ? IMAGE_NO_MEMORY : status;
    }
    *bytes = out.items;
    *size = out.count;
    return IMAGE_OK;
}

bool image_samples(const Image *image, const ImageEncoding *encoding, void *samples)
{
    Encoder *encoder = malloc(sizeof *encoder);

    if (encoder) {
        encoder_init(encoder, encoding, image->channels);
        encoder_run(encoder, image->values, (size_t)image->width * (size_t)image->height, samples);
        free(encoder);
    }
    return encoder != NULL;
}

// NULL for OpenEXR, which needs no module.
static ImageStatus write_by_module(const OiioModule *module, const char *ending, const RowSource *source,
                                   const AtomicFile *file, ImageError *error)
{
    OiioPicture picture = {
        .ending = ending,
        .width = source->image->width,
        .height = source->image->height,
        .channels = source->image->channels,
        .depth = source->encoder.encoding.depth,
        .notes = source->encoder.encoding.notes,
        .note_count = source->encoder.encoding.note_count,
        .more = source->encoder.encoding.more,
        .more_count = source->encoder.encoding.more_count,
        .client = source,
        .fetch = rows_fetch,
    };

    OiioSink sink = {.client = file, .put = bytes_put};

    return module ? module->write(&picture, &sink, error) : exr_write(&picture, &sink, error);
}

ImageStatus image_write(const Image *image, const ImageEncoding *encoding, const char *path, ImageError *error)
{
    char ending[ENDING_MAX + 1];
    const OiioModule *module;
    AtomicFile file;
    RowSource *source;
    ImageStatus status = format_find(path, encoding->depth, ending, &module, error);

    if (status != IMAGE_OK) {
        return status;
    }
    source = malloc(sizeof *source);
    if (!source) {
        return IMAGE_NO_MEMORY;
    }
    source->image = image;
    encoder_init(&source->encoder, encoding, image->channels);
    if (!atomic_file_open(&file, file_path(path), error)) {
        status = IMAGE_IO;
    } else {
        status = module || is_open_exr(ending) ? write_by_module(module, ending, source, &file, error)
                 : strcmp(ending, "png") == 0 ? png_write(image, &source->encoder, (PngSink){&file, file_put}, error)
                                              : plain_write(ending, image, &source->encoder, &file, error);
        if (status != IMAGE_OK) {
            atomic_file_abandon(&file);
        } else if (!atomic_file_commit(&file, error)) {
            status = IMAGE_IO;
        }
    }
    free(source);
    return status;
}

// ---- reading

static float sample_at(const PictureFile *file, size_t i)
{
    switch (file->depth) {
    case IMAGE_DEPTH_8: return (float)((const uint8_t *)file->samples)[i] / 255.0f;
    case IMAGE_DEPTH_16: return (float)((const uint16_t *)file->samples)[i] / 65535.0f;
    case IMAGE_DEPTH_FLOAT: break;
    }
    return ((const float *)file->samples)[i];
}

static void values_widen(const PictureFile *file, Image *image)
{
    size_t pixels = (size_t)file->width * (size_t)file->height;
    const uint8_t *places = file->samples;

    for (size_t i = 0; file->palette_count == 0 && i < pixels * (size_t)file->channels; i++) {
        image->values[i] = sample_at(file, i);
    }
    for (size_t i = 0; file->palette_count > 0 && i < pixels; i++) {
        for (int c = 0; c < image->channels; c++) {
            image->values[i * (size_t)image->channels + (size_t)c] = (float)file->palette[places[i]][c] / 255.0f;
        }
    }
}

static bool palette_is_opaque(const PictureFile *file)
{
    for (int i = 0; i < file->palette_count; i++) {
        if (file->palette[i][3] != UINT8_MAX) {
            return false;
        }
    }
    return true;
}

ImageStatus image_read(const char *path, uint64_t pixel_limit, Image *image, ImageError *error)
{
    PictureLimit limit = {.pixels = pixel_limit, .bytes = UINT64_MAX};
    PictureFile file;
    ImageStatus status = picture_file_read(path, NULL, &limit, &file, error);

    *image = (Image){0};
    if (status != IMAGE_OK) {
        return status;
    }
    int channels = file.palette_count == 0 ? file.channels : palette_is_opaque(&file) ? 3 : 4;
    if (image_init(image, file.width, file.height, channels)) {
        values_widen(&file, image);
    } else {
        status = IMAGE_NO_MEMORY;
    }
    picture_file_fini(&file);
    return status;
}
