// Finds file, line and column of a byte of a SourceMap, and reads its line again for a message.
//
// Lines are indexed by one checkpoint a block, made up to where a message asks, so that a message costs one block whatever
// the length of the file or of the line.
//
// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/source_map.h"

// The text that a global offset belongs to; the offset one past the last byte is its end.
static Source *source_find(const SourceMap *map, uint64_t offset)
{
    if (offset == 0 || offset >= map->next_base) {
        return NULL;
    }
    size_t low = 0, high = map->sources.count;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (map->sources.items[middle]->base <= offset) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return map->sources.items[low];
}

// Opens the file of a source once more, if the name still leads to it.
static bool source_reopen(SourceMap *map, const Source *source)
{
    struct stat status;
    if (map->again == source && map->again_file != NO_FILE) {
        return true;
    }
    source_file_close(&map->again_file);
    map->again = source;
    map->again_file = open(source->name, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
    if (map->again_file == NO_FILE) {
        return false;
    }
    if (fstat(map->again_file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_dev != source->device ||
        status.st_ino != source->number) {
        source_file_close(&map->again_file);
        return false;
    }
    return true;
}

// Reads exactly `size` bytes of a text from an offset, whether it is open or not.
static bool source_read_again(SourceMap *map, const Source *source, uint64_t offset, char *buffer, size_t size)
{
    if (source->kept) {
        memcpy(buffer, source->kept + offset, size);
        return true;
    }
    if (!source_reopen(map, source)) {
        return false;
    }
    return source_file_read(map->again_file, offset, buffer, size);
}

// One byte of UTF-8. Each byte counts as a character until a well-formed sequence ends, which then counts as one
// (Unicode 15, table 3-7).
static void cursor_step(LineCursor *cursor, unsigned char byte)
{
    cursor->characters++;
    if (cursor->missing > 0 && byte >= cursor->low && byte <= cursor->high) {
        cursor->low = 0x80;
        cursor->high = 0xBF;
        if (--cursor->missing == 0) {
            cursor->characters -= cursor->length - 1u;
        }
        return;
    }
    cursor->missing = byte < 0xC2 || byte > 0xF4 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
    cursor->length = (unsigned char)(cursor->missing + 1);
    cursor->low = byte == 0xE0 ? 0xA0 : byte == 0xF0 ? 0x90 : 0x80;
    cursor->high = byte == 0xED ? 0x9F : byte == 0xF4 ? 0x8F : 0xBF;
}

// Moves the cursor over `size` bytes that begin at `offset`. Characters matter in the last line only.
static void cursor_advance(LineCursor *cursor, const char *bytes, size_t size, uint64_t offset)
{
    size_t line = 0;
    for (const char *at = bytes; (at = memchr(at, '\n', size - (size_t)(at - bytes))); at++) {
        cursor->newlines++;
        line = (size_t)(at - bytes) + 1;
    }
    if (line > 0) {
        cursor->line_start = offset + line;
        cursor->characters = 0;
        cursor->missing = 0;
    }
    for (size_t i = line; i < size; i++) {
        cursor_step(cursor, (unsigned char)bytes[i]);
    }
}

// Makes the checkpoints up to that of the block in which the offset stands.
static bool source_index(SourceMap *map, Source *source, uint64_t offset)
{
    uint64_t block = offset / BLOCK;
    if (!source->lines) {
        source->lines = calloc(1, sizeof(*source->lines));
        if (!source->lines) {
            return false;
        }
    }
    LineIndex *lines = source->lines;
    if (lines->count == 0 && !ARRAY_PUSH(lines, (LineCursor){0})) {
        return false;
    }
    while (lines->count <= block) {
        uint64_t at = (lines->count - 1) * BLOCK;
        LineCursor cursor = lines->items[lines->count - 1];
        if (!source_read_again(map, source, at, map->block, BLOCK)) {
            return false;
        }
        cursor_advance(&cursor, map->block, BLOCK, at);
        if (!ARRAY_PUSH(lines, cursor)) {
            return false;
        }
    }
    return true;
}

static bool is_continuation(char byte)
{
    return ((unsigned char)byte & 0xC0) == 0x80;
}

// A piece of a line within map->window.
typedef struct Piece {
    size_t begin, end, caret; // offsets in the bytes that were read
    bool is_cut_before, is_cut_after;
} Piece;

// Keeps WINDOW bytes around the caret and cuts no character in two.
static void piece_shorten(Piece *piece, const char *bytes)
{
    size_t before = piece->caret - piece->begin, after = piece->end - piece->caret;
    if (before + after <= WINDOW) {
        return;
    }
    size_t keep_before = after >= WINDOW / 2 ? WINDOW / 2 : WINDOW - after;
    if (before > keep_before) {
        piece->begin = piece->caret - keep_before;
        piece->is_cut_before = true;
        for (int i = 0; i < 3 && piece->begin < piece->caret && is_continuation(bytes[piece->begin]); i++) {
            piece->begin++;
        }
        before = piece->caret - piece->begin;
    }
    if (before + after > WINDOW) {
        size_t end = piece->caret + WINDOW - before;
        piece->is_cut_after = true;
        for (int i = 0; i < 3 && end > piece->caret && is_continuation(bytes[end]); i++) {
            end--;
        }
        piece->end = end;
    }
}

// Reads what is shown of the line: all of it, or a window around the offset.
static bool source_read_line(SourceMap *map, const Source *source, uint64_t line_start, uint64_t offset, Span span,
                             SourceLocation *location)
{
    uint64_t begin = offset - line_start > REACH ? offset - REACH : line_start;
    uint64_t end = source->size - offset > REACH ? offset + REACH : source->size;
    char *bytes = map->window + ELLIPSIS;
    if (!source_read_again(map, source, begin, bytes, (size_t)(end - begin))) {
        return false;
    }
    Piece piece = {0, (size_t)(end - begin), (size_t)(offset - begin), begin > line_start, end < source->size};
    char *newline = memchr(bytes + piece.caret, '\n', piece.end - piece.caret);
    if (newline) {
        piece.end = (size_t)(newline - bytes);
        piece.is_cut_after = false;
        if (piece.end > 0 && bytes[piece.end - 1] == '\r') {
            piece.end--;
        }
        piece.caret = piece.caret > piece.end ? piece.end : piece.caret;
    }
    piece_shorten(&piece, bytes);
    uint64_t span_length = span.end > span.begin ? span.end - span.begin : 0;
    size_t room = piece.end - piece.caret;
    size_t caret_length = span_length < room ? (size_t)span_length : room;
    char *text = bytes + piece.begin;
    size_t length = piece.end - piece.begin;
    if (piece.is_cut_after) {
        memcpy(text + length, "...", ELLIPSIS);
        length += ELLIPSIS;
    }
    if (piece.is_cut_before) {
        text -= ELLIPSIS;
        length += ELLIPSIS;
        memcpy(text, "...", ELLIPSIS);
    }
    location->text = text;
    location->text_length = length;
    location->caret_begin = (size_t)(bytes + piece.caret - text);
    location->caret_end = location->caret_begin + caret_length;
    return true;
}

// What messages call a thing of a list. Kept by the map, as all names are: messages are few.
static const char *list_name(SourceMap *map, const Source *source, uint64_t number)
{
    char name[WINDOW];
    int length = snprintf(name, sizeof name, "%.150s[%llu]", source->name, (unsigned long long)number);
    Symbol symbol = intern_text(map->names, name, (size_t)length);
    return symbol != SYMBOL_NONE ? intern_get(map->names, symbol) : source->name;
}

bool source_locate(SourceMap *map, Span span, SourceLocation *location)
{
    *location = (SourceLocation){.text = ""};
    Source *source = source_find(map, span.begin);
    if (!source) {
        return false;
    }
    location->name = source->name;
    if (span.end == 0) {
        return false;
    }
    uint64_t offset = span.begin - source->base;
    if (source->is_list) {
        location->name = list_name(map, source, offset);
        return false;
    }
    location->offset = offset;
    if (!source_index(map, source, offset)) {
        return false;
    }
    uint64_t block = offset / BLOCK;
    LineCursor cursor = source->lines->items[block];
    size_t size = (size_t)(offset - block * BLOCK);
    if (!source_read_again(map, source, block * BLOCK, map->block, size)) {
        return false;
    }
    cursor_advance(&cursor, map->block, size, block * BLOCK);
    if (!source_read_line(map, source, cursor.line_start, offset, span, location)) {
        return false;
    }
    location->line = cursor.newlines + 1;
    location->column = cursor.characters + 1;
    return true;
}

bool source_read_span(SourceMap *map, Span span, char *buffer)
{
    const Source *source = source_find(map, span.begin);
    return source && span.end >= span.begin && span.end <= source->base + source->size &&
           source_read_again(map, source, span.begin - source->base, buffer, (size_t)(span.end - span.begin));
}
