// PNG files made of strips: the same bytes for any number of threads, and libpng reads back what was encoded.
//
// SPDX-License-Identifier: MIT
#include "image/image.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/encode.h"
#include "image/png_strips.h"
#include "unit/random.h"
#include "unit/tap.h"

typedef struct Bytes {
    char *items;
    size_t count;
} Bytes;

static Bytes file_bytes(const char *path)
{
    Bytes bytes = {malloc(1 << 24), 0};
    FILE *file = fopen(path, "rb");
    if (file && bytes.items) {
        bytes.count = fread(bytes.items, 1, 1 << 24, file);
        fclose(file);
    }
    return bytes;
}

static bool write_with(const Image *image, ImageEncoding encoding, int threads, const char *path)
{
    ImageError error;
    encoding.threads = threads;
    return image_write(image, &encoding, path, &error) == IMAGE_OK;
}

// Every sample is the code of its value.
static bool reads_back(const Image *image, const ImageEncoding *encoding, const char *path)
{
    const ImageEncoding plain = {.depth = encoding->depth, .already_encoded = true};
    double most = encoding->depth == IMAGE_DEPTH_8 ? 255.0 : 65535.0;
    Image read = {0};
    ImageError error;
    bool fine = image_read(path, UINT64_MAX, &read, &error) == IMAGE_OK && read.width == image->width &&
                read.height == image->height && read.channels == image->channels;
    for (size_t i = 0; fine && i < (size_t)image->width * (size_t)image->height * (size_t)image->channels; i++) {
        bool is_alpha = image->channels % 2 == 0 && (int)(i % (size_t)image->channels) == image->channels - 1;
        unsigned code = encode_code(is_alpha ? &plain : encoding, image->values[i]);
        fine = (unsigned)((double)read.values[i] * most + 0.5) == code;
    }
    image_fini(&read);
    return fine;
}

// Stretches of even pixels, some of them long, between others.
static void fill(Image *image, Random *random)
{
    size_t channels = (size_t)image->channels, count = (size_t)image->width * (size_t)image->height * channels;
    size_t left = 0;
    for (size_t i = 0; i < count; i++) {
        if (i % channels == 0) {
            left = left > 0 ? left - 1 : random_below(random, 2) ? 0 : random_below(random, 60);
        }
        bool is_same = left > 0 && i >= channels;
        image->values[i] = is_same ? image->values[i - channels] : (float)random_between(random, -0.1, 1.1);
    }
}

static void check_size(int width, int height, int channels, ImageDepth depth)
{
    const ImageEncoding encoding = {.depth = depth, .transfer = IMAGE_TRANSFER_SRGB};
    Random random = {(uint64_t)(width * height + channels)};
    char path[] = "/tmp/rtlang-strips-XXXXXX.png";
    Image image;
    int file = mkstemps(path, 4);
    bool fine = file >= 0 && image_init(&image, width, height, channels);
    if (fine) {
        fill(&image, &random);
    }
    fine = fine && write_with(&image, encoding, 1, path);
    Bytes one = file_bytes(path);
    fine = fine && write_with(&image, encoding, 5, path);
    Bytes five = file_bytes(path);
    tap_ok(fine && one.count > 0 && one.count == five.count && memcmp(one.items, five.items, one.count) == 0,
           "%d x %d, %d channels: one thread and five", width, height, channels);
    tap_ok(fine && reads_back(&image, &encoding, path), "%d x %d, %d channels: read back", width, height, channels);
    free(one.items);
    free(five.items);
    image_fini(&image);
    close(file);
    unlink(path);
}

static void *work(void *strips)
{
    png_strips_work(strips);
    return NULL;
}

// All pieces, one after the other. With a thread that may run ahead after the first of them is given.
static Bytes stream_of(const Image *image, const Encoder *encoder, bool has_thread)
{
    Bytes stream = {malloc(1 << 24), 0};
    PngStrips *strips = png_strips_new(image, encoder);
    pthread_t thread;
    const unsigned char *piece;
    size_t size;
    bool failed = false;
    for (int i = 0; png_strips_piece(strips, &piece, &size, &failed); i++) {
        if (has_thread && i == 1) {
            pthread_create(&thread, NULL, work, strips);
            usleep(200000); // it is as far ahead as it may be
        }
        memcpy(stream.items + stream.count, piece, size);
        stream.count += size;
    }
    png_strips_stop(strips);
    if (has_thread) {
        pthread_join(thread, NULL);
    }
    png_strips_free(strips);
    return stream;
}

// A piece stays until the next one is asked for, however many more are made meanwhile.
static void check_ahead(void)
{
    const ImageEncoding encoding = {.depth = IMAGE_DEPTH_8, .already_encoded = true};
    static Encoder encoder;
    Random random = {7};
    Image image;
    if (image_init(&image, 14000, 400, 3)) { // a strip is a row
        fill(&image, &random);
    }
    encoder_init(&encoder, &encoding, 3);
    alarm(60);
    Bytes alone = stream_of(&image, &encoder, false), ahead = stream_of(&image, &encoder, true);
    alarm(0);
    tap_ok(alone.count == ahead.count && memcmp(alone.items, ahead.items, alone.count) == 0, "a thread that runs ahead");
    free(alone.items);
    free(ahead.items);
    image_fini(&image);
}

int main(void)
{
    check_ahead();
    check_size(1, 1, 1, IMAGE_DEPTH_8);
    check_size(3, 64, 3, IMAGE_DEPTH_8);
    check_size(65, 65, 3, IMAGE_DEPTH_16);
    check_size(17, 200, 4, IMAGE_DEPTH_8);
    check_size(3001, 70, 3, IMAGE_DEPTH_8);
    check_size(1501, 33, 1, IMAGE_DEPTH_8);
    check_size(22000, 3, 3, IMAGE_DEPTH_8); // a row is more than a strip should be
    check_size(2100, 1000, 2, IMAGE_DEPTH_16); // more strips than are made at a time
    return tap_done();
}
