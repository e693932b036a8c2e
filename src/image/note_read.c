// Walks over the chunks of a PNG file (PNG 1.2, 3.2) or the attributes of an EXR header up to the requested one.
//
// SPDX-License-Identifier: MIT
#include "image/note_read.h"

#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { NAME_MOST = 256, TEXT_MOST = 1 << 20 };

static const unsigned char png_magic[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
static const unsigned char exr_magic[4] = {0x76, 0x2F, 0x31, 0x01};

static bool take(FILE *file, void *bytes, size_t size)
{
    return fread(bytes, 1, size, file) == size;
}

static bool skip(FILE *file, uint32_t size)
{
    return fseek(file, (long)size, SEEK_CUR) == 0;
}

// A text that ends with a zero byte; false when it is longer than a name may be.
static bool take_name(FILE *file, char name[NAME_MOST])
{
    for (size_t i = 0; i < NAME_MOST; i++) {
        int c = getc(file);
        if (c == EOF) {
            return false;
        }
        name[i] = (char)c;
        if (c == 0) {
            return true;
        }
    }
    return false;
}

static NoteResult take_text(FILE *file, uint32_t size, TextBuffer *out)
{
    char block[4096];
    for (size_t part; size > 0; size -= (uint32_t)part) {
        part = size < sizeof block ? size : sizeof block;
        if (!take(file, block, part)) {
            return NOTE_NO_PICTURE;
        }
        text_append_n(out, block, part);
    }
    return NOTE_FOUND;
}

static NoteResult read_png(FILE *file, const char *name, TextBuffer *out)
{
    unsigned char head[8];
    size_t name_size = strlen(name) + 1;
    char found[NAME_MOST];
    while (take(file, head, sizeof head)) {
        uint32_t size = (uint32_t)head[0] << 24 | (uint32_t)head[1] << 16 | (uint32_t)head[2] << 8 | head[3];
        bool is_text = memcmp(head + 4, "tEXt", 4) == 0 && size >= name_size && size <= TEXT_MOST &&
                       name_size <= sizeof found;
        if (memcmp(head + 4, "IEND", 4) == 0) {
            return NOTE_NONE;
        }
        if (is_text && !take(file, found, name_size)) {
            return NOTE_NO_PICTURE;
        }
        if (is_text && memcmp(found, name, name_size) == 0) {
            return take_text(file, size - (uint32_t)name_size, out);
        }
        if (size > INT32_MAX || !skip(file, size - (is_text ? (uint32_t)name_size : 0) + 4)) {
            return NOTE_NO_PICTURE;
        }
    }
    return NOTE_NO_PICTURE;
}

// OpenEXR's file layout: after magic and version each attribute is its name, its type, its size and its value, and an
// empty name ends them.
static NoteResult read_exr(FILE *file, const char *name, TextBuffer *out)
{
    char found[NAME_MOST], type[NAME_MOST];
    unsigned char version[4], number[4];
    if (!take(file, version, sizeof version)) {
        return NOTE_NO_PICTURE;
    }
    while (take_name(file, found) && found[0]) {
        if (!take_name(file, type) || !take(file, number, sizeof number)) {
            return NOTE_NO_PICTURE;
        }
        uint32_t size = (uint32_t)number[3] << 24 | (uint32_t)number[2] << 16 | (uint32_t)number[1] << 8 | number[0];
        if (strcmp(found, name) == 0 && strcmp(type, "string") == 0 && size <= TEXT_MOST) {
            return take_text(file, size, out);
        }
        if (size > INT32_MAX || !skip(file, size)) {
            return NOTE_NO_PICTURE;
        }
    }
    return feof(file) || ferror(file) ? NOTE_NO_PICTURE : NOTE_NONE;
}

NoteResult note_read(const char *path, const char *name, TextBuffer *out)
{
    unsigned char magic[sizeof png_magic] = {0};
    FILE *file = fopen(path, "rbe");
    if (!file) {
        return NOTE_NO_FILE;
    }
    NoteResult result = NOTE_NO_PICTURE;
    if (take(file, magic, sizeof exr_magic)) {
        if (memcmp(magic, exr_magic, sizeof exr_magic) == 0) {
            result = read_exr(file, name, out);
        } else if (take(file, magic + sizeof exr_magic, sizeof magic - sizeof exr_magic) &&
                   memcmp(magic, png_magic, sizeof magic) == 0) {
            result = read_png(file, name, out);
        }
    }
    fclose(file);
    return result;
}
