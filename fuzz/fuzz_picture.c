// Any bytes are a picture file that is read, as it is stored and as numbers, or refused.
//
// A fuzzer hardly finds the checksums of a PNG, so that most of its files would be refused before anything is looked
// at: they are put right first, unless the size is a multiple of eight.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "fuzz/fuzz_samples.h"
#include "image/image.h"
#include "image/picture_file.h"

// CRC-32 of PNG's specification, bit by bit.
static uint32_t checksum(const uint8_t *data, size_t size)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
        }
    }
    return ~crc;
}

static uint32_t big_endian(const uint8_t *data)
{
    return (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
}

// Chunks: length, four letters, content, checksum of the latter two.
static void mend_png(uint8_t *data, size_t size)
{
    size_t at = 8, length;
    for (; at + 12 <= size && (length = big_endian(data + at)) <= size - at - 12; at += length + 12) {
        uint32_t crc = checksum(data + at + 4, length + 4);
        for (int i = 0; i < 4; i++) {
            data[at + 8 + length + (size_t)i] = (uint8_t)(crc >> (24 - 8 * i));
        }
    }
}

static int mended_file(const uint8_t *data, size_t size, char path[FUZZ_PATH])
{
    uint8_t *copy = malloc(size + 1);
    int fd = -1;
    if (copy) {
        memcpy(copy, data, size);
        if (size > 8 && size % 8 != 0 && memcmp(copy, "\x89PNG", 4) == 0) {
            mend_png(copy, size);
        }
        fd = fuzz_file(copy, size, path);
    }
    free(copy);
    return fd;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { PIXELS = 1 << 15 };
    char path[FUZZ_PATH];
    int fd = mended_file(data, size, path);
    PictureFile file = {0};
    Image image = {0};
    ImageError error = {{0}, false};
    PictureLimit limit = {PIXELS, PIXELS * 8, NULL};
    if (fd < 0) {
        return 0;
    }
    if (picture_file_read(path, NULL, &limit, &file, &error) == IMAGE_OK) {
        fuzz_look_at(&file);
        picture_file_fini(&file);
    } else {
        FUZZ_HOLDS(file.samples == NULL);
    }
    if (image_read(path, PIXELS, &image, &error) == IMAGE_OK) {
        image_fini(&image);
    }
    close(fd);
    return 0;
}
