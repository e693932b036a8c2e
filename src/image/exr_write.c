// See exr_write.h. After "OpenEXR File Layout" and "Technical Introduction to OpenEXR" (its ZIP compression): blocks of
// 16 lines, in each the channels of a line one after the other in the order of their names; even bytes before odd ones,
// each as its distance from the one before, and that by zlib.
//
// SPDX-License-Identifier: MIT
#include "image/exr_write.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <zlib.h>

#include "base/array.h"

enum {
    BLOCK_LINES = 16,
    SAMPLE = 4,
    CHANNELS_MOST = 4 + IMAGE_CHANNELS_MORE,
    COMPRESSION_ZIP = 3,
    TYPE_COUNT = 0, // uint32_t
    TYPE_FLOAT = 2,
    LEVEL = 4,
};

typedef struct Channel {
    const char *name;
    int place; // among the samples of a pixel
    bool is_count;
} Channel;

typedef struct Exr {
    const OiioPicture *picture;
    Channel channels[CHANNELS_MOST]; // by name
    int channel_count;
    ARRAY(unsigned char) bytes; // of the file
    bool has_no_memory;
} Exr;

// ---- bytes, the low one first

static void put(Exr *exr, const void *bytes, size_t length)
{
    exr->has_no_memory = exr->has_no_memory || !ARRAY_RESERVE(&exr->bytes, exr->bytes.count + length);
    if (!exr->has_no_memory) {
        memcpy(exr->bytes.items + exr->bytes.count, bytes, length);
        exr->bytes.count += length;
    }
}

static void put_number(Exr *exr, uint64_t number, size_t length)
{
    unsigned char bytes[sizeof number];
    for (size_t i = 0; i < length; i++) {
        bytes[i] = (unsigned char)(number >> 8 * i);
    }
    put(exr, bytes, length);
}

static void put_float(Exr *exr, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    put_number(exr, bits, sizeof bits);
}

static void put_text(Exr *exr, const char *text)
{
    put(exr, text, strlen(text) + 1);
}

// ---- the header

static void begin_attribute(Exr *exr, const char *name, const char *type, size_t length)
{
    put_text(exr, name);
    put_text(exr, type);
    put_number(exr, length, 4);
}

static void put_channels(Exr *exr)
{
    size_t length = 1;
    for (int i = 0; i < exr->channel_count; i++) {
        length += strlen(exr->channels[i].name) + 1 + 16;
    }
    begin_attribute(exr, "channels", "chlist", length);
    for (int i = 0; i < exr->channel_count; i++) {
        put_text(exr, exr->channels[i].name);
        put_number(exr, exr->channels[i].is_count ? TYPE_COUNT : TYPE_FLOAT, 4);
        put_number(exr, 0, 4); // not perceptually linear, and three bytes that are reserved
        put_number(exr, 1, 4); // every pixel has it
        put_number(exr, 1, 4);
    }
    put_number(exr, 0, 1);
}

static void put_window(Exr *exr, const char *name)
{
    begin_attribute(exr, name, "box2i", 16);
    put_number(exr, 0, 8);
    put_number(exr, (uint64_t)exr->picture->width - 1, 4);
    put_number(exr, (uint64_t)exr->picture->height - 1, 4);
}

static void put_header(Exr *exr)
{
    const OiioPicture *picture = exr->picture;
    put_number(exr, 20000630, 4);
    put_number(exr, 2, 4);
    put_channels(exr);
    begin_attribute(exr, "compression", "compression", 1);
    put_number(exr, COMPRESSION_ZIP, 1);
    put_window(exr, "dataWindow");
    put_window(exr, "displayWindow");
    begin_attribute(exr, "lineOrder", "lineOrder", 1);
    put_number(exr, 0, 1); // from above
    begin_attribute(exr, "pixelAspectRatio", "float", 4);
    put_float(exr, 1.0F);
    begin_attribute(exr, "screenWindowCenter", "v2f", 8);
    put_number(exr, 0, 8);
    begin_attribute(exr, "screenWindowWidth", "float", 4);
    put_float(exr, 1.0F);
    for (size_t i = 0; i < picture->note_count; i++) {
        begin_attribute(exr, picture->notes[i].name, "string", strlen(picture->notes[i].text));
        put(exr, picture->notes[i].text, strlen(picture->notes[i].text));
    }
    put_number(exr, 0, 1);
}

// ---- blocks

static int by_name(const void *a, const void *b)
{
    return strcmp(((const Channel *)a)->name, ((const Channel *)b)->name);
}

static void name_channels(Exr *exr)
{
    static const char *const names[][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    const OiioPicture *picture = exr->picture;
    for (int i = 0; i < picture->channels; i++) {
        exr->channels[exr->channel_count++] = (Channel){names[picture->channels - 1][i], i, false};
    }
    for (int i = 0; i < picture->more_count; i++) {
        exr->channels[exr->channel_count] =
            (Channel){picture->more[i].name, picture->channels + i, picture->more[i].is_count};
        exr->channel_count++;
    }
    qsort(exr->channels, (size_t)exr->channel_count, sizeof exr->channels[0], by_name);
}

// A block's bytes as they are without compression.
static void arrange(const Exr *exr, const unsigned char *samples, size_t lines, unsigned char *plain)
{
    size_t width = (size_t)exr->picture->width, count = (size_t)exr->channel_count;
    for (size_t line = 0; line < lines; line++) {
        for (size_t c = 0; c < count; c++) {
            const unsigned char *from = samples + (line * width * count + (size_t)exr->channels[c].place) * SAMPLE;
            for (size_t x = 0; x < width; x++, from += count * SAMPLE, plain += SAMPLE) {
                uint32_t bits;
                memcpy(&bits, from, sizeof bits);
                for (int i = 0; i < SAMPLE; i++) {
                    plain[i] = (unsigned char)(bits >> 8 * i);
                }
            }
        }
    }
}

static void predict(const unsigned char *plain, size_t length, unsigned char *steps)
{
    size_t half = (length + 1) / 2;
    for (size_t i = 0; i < length; i++) {
        steps[i % 2 ? half + i / 2 : i / 2] = plain[i];
    }
    for (size_t i = length; i-- > 1;) {
        steps[i] = (unsigned char)(steps[i] - steps[i - 1] + 128);
    }
}

// Its first line, its length and its bytes; as they are where zlib does not make less of them.
static void put_block(Exr *exr, int top, const unsigned char *plain, unsigned char *steps, unsigned char *packed,
                      size_t length)
{
    uLongf size = compressBound(length);
    predict(plain, length, steps);
    bool is_less = compress2(packed, &size, steps, length, LEVEL) == Z_OK && size < length;
    put_number(exr, (uint64_t)top, 4);
    put_number(exr, is_less ? size : length, 4);
    put(exr, is_less ? packed : plain, is_less ? size : length);
}

static void put_blocks(Exr *exr)
{
    const OiioPicture *picture = exr->picture;
    size_t line = (size_t)picture->width * (size_t)exr->channel_count * SAMPLE, all = line * BLOCK_LINES;
    size_t blocks = ((size_t)picture->height + BLOCK_LINES - 1) / BLOCK_LINES, table = exr->bytes.count;
    unsigned char *room = malloc(3 * all + compressBound(all));
    exr->has_no_memory = exr->has_no_memory || !room;
    for (size_t i = 0; i < blocks; i++) {
        put_number(exr, 0, 8);
    }
    for (size_t i = 0; !exr->has_no_memory && i < blocks; i++) {
        int top = (int)i * BLOCK_LINES,
            lines = picture->height - top < BLOCK_LINES ? picture->height - top : BLOCK_LINES;
        uint64_t place = exr->bytes.count;
        for (size_t k = 0; k < 8; k++) {
            exr->bytes.items[table + 8 * i + k] = (unsigned char)(place >> 8 * k);
        }
        picture->fetch(picture->client, top, lines, room);
        arrange(exr, room, (size_t)lines, room + all);
        put_block(exr, top, room + all, room + 2 * all, room + 3 * all, line * (size_t)lines);
    }
    free(room);
}

ImageStatus exr_write(const OiioPicture *picture, const OiioSink *sink, ImageError *error)
{
    Exr exr = {.picture = picture};
    name_channels(&exr);
    put_header(&exr);
    put_blocks(&exr);
    ImageStatus status =
        exr.has_no_memory ? IMAGE_NO_MEMORY : sink->put(sink->client, exr.bytes.items, exr.bytes.count, error);
    ARRAY_FREE(&exr.bytes);
    return status;
}
