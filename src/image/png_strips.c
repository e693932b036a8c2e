// Strips of rows to pieces of a zlib stream. A piece ends at a byte, by an empty block (zlib's Z_SYNC_FLUSH), and
// refers to nothing before it, so pieces can be made in any order; what remains is to combine their checksums.
//
// Runs alone (zlib's Z_RLE) and the Sub filter are the measured optimum of time against size for renderings: level 1 of
// zlib takes up to half as long again, and makes files that are no smaller.
//
// SPDX-License-Identifier: MIT
#include "image/png_strips.h"

#include <pthread.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>


enum {
    STRIP_BYTES = 63 * 1024, // before it is packed: less than zlib has room for, which else moves its tables each 32 KiB
    BATCH = 128,             // strips in memory at a time
    DEFLATE_LEVEL = 1,
    DEFLATE_MEMORY = 8,
    DEFLATE_RAW_WINDOW = -15, // of 32 KiB, without a header of its own
    FILTER_SUB = 1,
};

static const unsigned char stream_header[2] = {0x78, 0x01}; // deflate, 32 KiB, fastest (RFC 1950, section 2.2)

typedef struct Strip {
    unsigned char *packed; // NULL: it is not made yet
    size_t packed_size, raw_size;
    unsigned long checksum; // Adler-32 of what was packed
} Strip;

struct PngStrips {
    const Image *image;
    const Encoder *encoder;
    size_t sample_bytes, row_bytes;
    int rows, count;       // of a strip; strips of the picture
    pthread_mutex_t lock;  // of what stands below
    pthread_cond_t change; // of it
    int begun, given;      // strips that were begun; pieces that were given, of which the first is the stream's header
    bool failed, stopped;
    unsigned long checksum; // of all strips that were given
    unsigned char trailer[4];
    Strip strips[BATCH]; // each in the place of the one BATCH before it, which was given
};

static int strip_rows(const PngStrips *strips, int index)
{
    int left = strips->image->height - index * strips->rows;
    return left < strips->rows ? left : strips->rows;
}

PngStrips *png_strips_new(const Image *image, const Encoder *encoder)
{
    PngStrips *strips = calloc(1, sizeof *strips);
    if (strips) {
        strips->image = image;
        strips->encoder = encoder;
        strips->sample_bytes = encode_sample_bytes(encoder->encoding.depth);
        strips->row_bytes = (size_t)image->width * (size_t)image->channels * strips->sample_bytes;
        size_t rows = STRIP_BYTES / (strips->row_bytes + 1);
        strips->rows = rows < 1 ? 1 : rows < (size_t)image->height ? (int)rows : image->height;
        strips->count = (image->height - 1) / strips->rows + 1;
        strips->checksum = adler32(0, NULL, 0);
        pthread_mutex_init(&strips->lock, NULL);
        pthread_cond_init(&strips->change, NULL);
    }
    return strips;
}

void png_strips_free(PngStrips *strips)
{
    if (strips) {
        for (int i = 0; i < BATCH; i++) {
            free(strips->strips[i].packed);
        }
        pthread_cond_destroy(&strips->change);
        pthread_mutex_destroy(&strips->lock);
        free(strips);
    }
}

int png_strips_count(const PngStrips *strips)
{
    return strips->count;
}

// Samples have the most significant byte first (PNG, third edition, section 7.1).
static void row_swap(unsigned char *row, size_t bytes)
{
    uint16_t probe = 1;
    unsigned char first;
    memcpy(&first, &probe, 1);
    for (size_t i = 0; first == 1 && i < bytes; i += 2) {
        unsigned char low = row[i];
        row[i] = row[i + 1];
        row[i + 1] = low;
    }
}

// The bytes of `a` less those of `b`, each by itself.
static uint64_t bytes_less(uint64_t a, uint64_t b)
{
    const uint64_t high = UINT64_C(0x8080808080808080);
    return ((a | high) - (b & ~high)) ^ ((a ^ ~b) & high);
}

// Each byte less the one of the pixel to the left (section 9.2).
static void row_filter(const unsigned char *row, size_t bytes, size_t pixel_bytes, unsigned char *filtered)
{
    size_t i = pixel_bytes;
    filtered[0] = FILTER_SUB;
    memcpy(filtered + 1, row, pixel_bytes);
    for (; i + sizeof(uint64_t) <= bytes; i += sizeof(uint64_t)) {
        uint64_t here, left;
        memcpy(&here, row + i, sizeof here);
        memcpy(&left, row + i - pixel_bytes, sizeof left);
        here = bytes_less(here, left);
        memcpy(filtered + i + 1, &here, sizeof here);
    }
    for (; i < bytes; i++) {
        filtered[i + 1] = (unsigned char)(row[i] - row[i - pixel_bytes]);
    }
}

// `row` holds one row.
static void strip_fill(const PngStrips *strips, int index, unsigned char *row, unsigned char *filtered)
{
    const Image *image = strips->image;
    size_t row_values = (size_t)image->width * (size_t)image->channels;
    for (int y = 0; y < strip_rows(strips, index); y++) {
        size_t at = (size_t)index * (size_t)strips->rows + (size_t)y;
        encoder_run(strips->encoder, image->values + at * row_values, (size_t)image->width, row);
        if (strips->sample_bytes == 2) {
            row_swap(row, strips->row_bytes);
        }
        row_filter(row, strips->row_bytes, (size_t)image->channels * strips->sample_bytes,
                   filtered + (size_t)y * (strips->row_bytes + 1));
    }
}

static bool strip_pack(Strip *strip, unsigned char *raw, bool is_last)
{
    z_stream stream = {0};
    if (deflateInit2(&stream, DEFLATE_LEVEL, Z_DEFLATED, DEFLATE_RAW_WINDOW, DEFLATE_MEMORY, Z_RLE) != Z_OK) {
        return false;
    }
    size_t room = deflateBound(&stream, strip->raw_size) + 16;
    strip->packed = malloc(room);
    stream.next_in = raw;
    stream.avail_in = (uInt)strip->raw_size;
    stream.next_out = strip->packed;
    stream.avail_out = (uInt)room;
    bool fine = strip->packed && deflate(&stream, is_last ? Z_FINISH : Z_SYNC_FLUSH) >= Z_OK && stream.avail_in == 0;
    strip->packed_size = room - stream.avail_out;
    deflateEnd(&stream);
    return fine;
}

static bool strip_make(const PngStrips *strips, int index, Strip *strip)
{
    strip->raw_size = (size_t)strip_rows(strips, index) * (strips->row_bytes + 1);
    unsigned char *row = malloc(strips->row_bytes + strip->raw_size);
    if (!row) {
        return false;
    }
    unsigned char *raw = row + strips->row_bytes;
    strip_fill(strips, index, row, raw);
    strip->checksum = adler32_z(adler32(0, NULL, 0), raw, strip->raw_size);
    bool fine = strip_pack(strip, raw, index + 1 == strips->count);
    free(row);
    return fine;
}

static bool has_ended(const PngStrips *strips)
{
    return strips->failed || strips->stopped || strips->begun == strips->count;
}

static bool may_begin(const PngStrips *strips)
{
    int kept = strips->given > 1 ? strips->given - 2 : 0; // the strip that was given last
    return !has_ended(strips) && strips->begun < kept + BATCH;
}

// Makes the next strip. The lock is held before and after.
static void strips_make_next(PngStrips *strips)
{
    int index = strips->begun++;
    Strip made = {0};
    pthread_mutex_unlock(&strips->lock);
    bool fine = strip_make(strips, index, &made);
    pthread_mutex_lock(&strips->lock);
    strips->strips[index % BATCH] = made;
    strips->failed |= !fine;
    pthread_cond_broadcast(&strips->change);
}

void png_strips_work(PngStrips *strips)
{
    pthread_mutex_lock(&strips->lock);
    while (!has_ended(strips)) {
        if (may_begin(strips)) {
            strips_make_next(strips);
        } else {
            pthread_cond_wait(&strips->change, &strips->lock);
        }
    }
    pthread_mutex_unlock(&strips->lock);
}

void png_strips_stop(PngStrips *strips)
{
    pthread_mutex_lock(&strips->lock);
    strips->stopped = true;
    pthread_cond_broadcast(&strips->change);
    pthread_mutex_unlock(&strips->lock);
}

// Waits for a strip, and makes others meanwhile. False when out of memory.
static bool strips_await(PngStrips *strips, int index)
{
    while (!strips->failed && !strips->strips[index % BATCH].packed) {
        if (may_begin(strips)) {
            strips_make_next(strips);
        } else {
            pthread_cond_wait(&strips->change, &strips->lock);
        }
    }
    return !strips->failed;
}

// The strip before was given and is not needed any more.
static void strips_forget(PngStrips *strips, int index)
{
    Strip *before = &strips->strips[(index + BATCH - 1) % BATCH];
    if (index > 0) {
        free(before->packed);
        *before = (Strip){0};
    }
}

// A strip, in order. The lock is held.
static bool strips_give(PngStrips *strips, int index, const unsigned char **bytes, size_t *size)
{
    const Strip *strip = &strips->strips[index % BATCH];
    strips_forget(strips, index);
    strips->given++;
    pthread_cond_broadcast(&strips->change);
    if (!strips_await(strips, index)) {
        return false;
    }
    strips->checksum = adler32_combine(strips->checksum, strip->checksum, (z_off_t)strip->raw_size);
    *bytes = strip->packed;
    *size = strip->packed_size;
    return true;
}

bool png_strips_piece(PngStrips *strips, const unsigned char **bytes, size_t *size, bool *failed)
{
    int index = strips->given - 1; // the stream's header comes before the first strip
    bool has_more = true;
    pthread_mutex_lock(&strips->lock);
    if (index >= 0 && index < strips->count) {
        has_more = strips_give(strips, index, bytes, size);
    } else if (index < 0) {
        strips->given++;
        *bytes = stream_header;
        *size = sizeof stream_header;
    } else if (index == strips->count) {
        strips->given++;
        for (int i = 0; i < 4; i++) {
            strips->trailer[i] = (unsigned char)(strips->checksum >> (24 - 8 * i));
        }
        *bytes = strips->trailer;
        *size = sizeof strips->trailer;
    } else {
        has_more = false;
    }
    *failed = strips->failed;
    pthread_mutex_unlock(&strips->lock);
    return has_more;
}
