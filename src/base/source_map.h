// What a SourceMap and its sources hold, for source.c, which reads them, and source_locate.c, which finds lines in them.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_SOURCE_MAP_H
#define BASE_SOURCE_MAP_H

#include <sys/types.h>

#include "base/arena.h"
#include "base/array.h"
#include "base/intern.h"
#include "base/source.h"

enum {
    BLOCK = 16 << 10,     // bytes between two checkpoints
    WINDOW = 200,         // bytes of a long line that are shown
    REACH = WINDOW + 4,   // bytes read on either side, so that a cut sees the whole character it falls in
    ELLIPSIS = 3,         // "..." where a line was cut
    PIPE_STEP = 64 << 10, // least room for a read from a pipe
    NO_FILE = -1
};

// Where counting stands: all about the bytes before one offset.
typedef struct LineCursor {
    uint64_t newlines;
    uint64_t line_start;           // offset in the text
    uint64_t characters;           // since line_start
    unsigned char missing, length; // continuation bytes that an open UTF-8 sequence still wants, and its length
    unsigned char low, high;       // bounds of the next one
} LineCursor;

typedef ARRAY(LineCursor) LineIndex;

struct Source {
    SourceMap *map;
    uint64_t base, size;
    const char *name;
    char *kept;        // the text, if it cannot be read twice
    uint64_t position; // of source_read
    bool is_list;      // without text
    bool is_again;     // its file was opened before
    bool is_of_scene;  // a scene asked for it by its name, and it is not in the map's digest yet
    LineIndex *lines;  // checkpoint k stands at k * BLOCK; NULL until a message asks
    int file;          // NO_FILE when closed or kept
    dev_t device;      // of the file, with its number: another one of this name is not read in its place
    ino_t number;
};

struct SourceMap {
    Arena arena; // entries
    InternTable *names;
    ARRAY(Source *) sources; // in order of base
    InternTable *files;      // device and number of each
    uint64_t next_base;
    uint64_t bytes; // of texts, each file once
    uint64_t bytes_read;
    const atomic_bool *cancel; // may be NULL
    size_t memory_bytes;       // most that is kept of one text
    bool keeps_digests;
    size_t digest_count;
    Digest digest;
    const Source *again; // whose file is open in again_file
    int again_file;
    char block[BLOCK];
    char window[ELLIPSIS + 2 * REACH + ELLIPSIS];
};

// Reads exactly `size` bytes from a place of an open file.
bool source_file_read(int file, uint64_t position, char *buffer, size_t size);

void source_file_close(int *file);

#endif
