// SourceMap: opens texts, numbers their bytes and reads them; source_locate.c finds file, line and column of a byte again.
//
// Owns an entry of some 70 bytes a text, the names (each once), the texts that cannot be read twice, and one file that
// is open for reading lines again. Knows nothing of messages.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE // O_PATH
#endif
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/real_path.h"
#include "base/source_map.h"

SourceMap *source_map_new(void)
{
    SourceMap *map = calloc(1, sizeof(*map));
    if (!map) {
        return NULL;
    }
    arena_init(&map->arena, SIZE_MAX);
    map->next_base = 1;
    map->memory_bytes = SIZE_MAX;
    map->again_file = NO_FILE;
    map->names = intern_new(SIZE_MAX);
    map->files = intern_new(SIZE_MAX);
    if (!map->names || !map->files) {
        intern_free(map->names);
        intern_free(map->files);
        free(map);
        return NULL;
    }
    return map;
}

void source_map_set_cancel(SourceMap *map, const atomic_bool *cancel)
{
    map->cancel = cancel;
}

uint64_t source_map_bytes(const SourceMap *map)
{
    return map->bytes;
}

void source_map_set_memory(SourceMap *map, size_t bytes)
{
    map->memory_bytes = bytes;
}

static void source_fini(Source *source);

void source_file_close(int *file)
{
    if (*file != NO_FILE) {
        close(*file);
        *file = NO_FILE;
    }
}

void source_map_free(SourceMap *map)
{
    if (!map) {
        return;
    }
    for (size_t i = 0; i < map->sources.count; i++) {
        source_fini(map->sources.items[i]);
    }
    source_file_close(&map->again_file);
    ARRAY_FREE(&map->sources);
    intern_free(map->names);
    intern_free(map->files);
    arena_fini(&map->arena);
    free(map);
}

// Enters a text. On failure the file and the kept text are still the caller's.
static Source *source_add(SourceMap *map, const char *name, int file, char *kept, uint64_t size)
{
    Symbol symbol = intern_text(map->names, name, strlen(name));
    if (symbol == SYMBOL_NONE || !ARRAY_RESERVE(&map->sources, map->sources.count + 1)) {
        return NULL;
    }
    Source *source = arena_alloc(&map->arena, sizeof(*source));
    if (!source) {
        return NULL;
    }
    *source = (Source){.map = map,
                       .base = map->next_base,
                       .size = size,
                       .name = intern_get(map->names, symbol),
                       .kept = kept,
                       .file = file};
    map->next_base += size + 1;
    map->bytes += size + 1;
    map->sources.items[map->sources.count++] = source;
    return source;
}

static bool is_cancelled(const SourceMap *map)
{
    return map->cancel && atomic_load_explicit(map->cancel, memory_order_relaxed);
}

static ptrdiff_t read_retrying(const SourceMap *map, int file, char *buffer, size_t size)
{
    ptrdiff_t got;
    do {
        if (is_cancelled(map)) {
            errno = ECANCELED;
            return -1;
        }
        got = read(file, buffer, size);
    } while (got < 0 && errno == EINTR);
    return got;
}

// Reads a pipe or a device to its end. The text is the caller's to free.
static SourceResult pipe_read(const SourceMap *map, int file, uint64_t limit_bytes, char **text, uint64_t *size)
{
    ARRAY(char) bytes = {0};
    SourceResult result = SOURCE_OK;
    for (;;) {
        if (!ARRAY_RESERVE(&bytes, bytes.count + PIPE_STEP)) {
            result = SOURCE_NO_MEMORY;
            break;
        }
        ptrdiff_t got = read_retrying(map, file, bytes.items + bytes.count, bytes.capacity - bytes.count);
        if (got <= 0) {
            result = got == 0 ? SOURCE_OK : errno == ECANCELED ? SOURCE_CANCELLED : SOURCE_NOT_READABLE;
            break;
        }
        bytes.count += (size_t)got;
        if (bytes.count > limit_bytes || bytes.count > map->memory_bytes) {
            result = bytes.count > limit_bytes ? SOURCE_TOO_LARGE : SOURCE_TOO_MUCH;
            break;
        }
    }
    if (result != SOURCE_OK) {
        int error_number = errno;
        ARRAY_FREE(&bytes);
        errno = error_number;
        return result;
    }
    char *fitted = realloc(bytes.items, bytes.count + 1);
    *text = fitted ? fitted : bytes.items;
    *size = bytes.count;
    return SOURCE_OK;
}

// Remembers the file; what was opened before takes no more memory for its text.
static bool source_know_file(Source *source, const struct stat *status)
{
    char key[sizeof status->st_dev + sizeof status->st_ino];
    SourceMap *map = source->map;
    size_t known = intern_count(map->files);
    memcpy(key, &status->st_dev, sizeof status->st_dev);
    memcpy(key + sizeof status->st_dev, &status->st_ino, sizeof status->st_ino);
    source->device = status->st_dev;
    source->number = status->st_ino;
    if (intern_text(map->files, key, sizeof key) == SYMBOL_NONE) {
        return false;
    }
    source->is_again = intern_count(map->files) == known;
    map->bytes -= source->is_again ? source->size + 1 : 0;
    return true;
}

// Decides by the kind of file whether it can be read again later, and enters it.
static SourceResult source_enter(SourceMap *map, const char *name, int file, uint64_t limit_bytes, Source **source)
{
    struct stat status;
    char *kept = NULL;
    uint64_t size = 0;
    errno = 0;
    if (fstat(file, &status) != 0) {
        return SOURCE_NOT_READABLE;
    }
    if (S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return SOURCE_IS_DIRECTORY;
    }
    // A file of size 0 may be one that the kernel makes while it is read (/proc).
    bool is_seekable = S_ISREG(status.st_mode) && status.st_size > 0;
    if (is_seekable) {
        size = (uint64_t)status.st_size;
        if (size > limit_bytes) {
            return SOURCE_TOO_LARGE;
        }
    } else {
        SourceResult result = pipe_read(map, file, limit_bytes, &kept, &size);
        if (result != SOURCE_OK) {
            return result;
        }
    }
    *source = source_add(map, name, is_seekable ? file : NO_FILE, kept, size);
    if (!*source) {
        free(kept);
        errno = 0;
        return SOURCE_NO_MEMORY;
    }
    return source_know_file(*source, &status) ? SOURCE_OK : SOURCE_NO_MEMORY;
}

// Enters a file that was opened, or says why it was not; closes it unless the source keeps it.
static SourceResult source_opened(SourceMap *map, const char *name, int file, uint64_t limit_bytes, Source **source,
                                  int *error_number)
{
    if (file < 0) {
        *error_number = errno;
        return is_cancelled(map) ? SOURCE_CANCELLED
               : errno == ENOENT || errno == ENOTDIR ? SOURCE_NOT_FOUND : SOURCE_NOT_READABLE;
    }
    SourceResult result = source_enter(map, name, file, limit_bytes, source);
    *error_number = result == SOURCE_OK ? 0 : errno;
    if (!*source || (*source)->file == NO_FILE) {
        close(file);
    }
    return result;
}

SourceResult source_open_file(SourceMap *map, const char *path, uint64_t limit_bytes, Source **source,
                              int *error_number)
{
    *source = NULL;
    *error_number = 0;
    int file;
    do { // opening a pipe waits for its writer
        file = is_cancelled(map) ? NO_FILE : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    } while (file < 0 && errno == EINTR && !is_cancelled(map));
    return source_opened(map, path, file, limit_bytes, source, error_number);
}

SourceResult source_open_real(SourceMap *map, const char *real, const char *name, uint64_t limit_bytes, Source **source,
                              int *error_number)
{
    struct stat status;
    *source = NULL;
    *error_number = 0;
    int file = is_cancelled(map) ? NO_FILE : real_path_open(real, O_RDONLY);
    bool is_known = file >= 0 && fstat(file, &status) == 0;
    if (is_known && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode)) {
        close(file);
        return SOURCE_NOT_A_FILE;
    }
    SourceResult result = source_opened(map, name, file, limit_bytes, source, error_number);
    if (result == SOURCE_OK) {
        (*source)->is_of_scene = true;
    }
    return result;
}

int source_create_real(const char *real, bool appends)
{
    struct stat status;
    int file = real_path_open(real, O_WRONLY | O_CREAT | (appends ? O_APPEND : 0));
    if (file < 0) {
        return NO_FILE;
    }
    bool is_known = fstat(file, &status) == 0, is_file = is_known && S_ISREG(status.st_mode);
    if (is_file && (appends || ftruncate(file, 0) == 0)) {
        return file;
    }
    int error_number = is_known && !is_file ? EINVAL : errno;
    close(file);
    errno = error_number;
    return NO_FILE;
}

SourceResult source_open_stream(SourceMap *map, const char *name, int file, uint64_t limit_bytes, Source **source,
                                int *error_number)
{
    char *kept = NULL;
    uint64_t size = 0;
    *source = NULL;
    errno = 0;
    SourceResult result = pipe_read(map, file, limit_bytes, &kept, &size);
    *error_number = result == SOURCE_OK ? 0 : errno;
    if (result == SOURCE_OK) {
        *source = source_add(map, name, NO_FILE, kept, size);
        if (!*source) {
            free(kept);
            return SOURCE_NO_MEMORY;
        }
    }
    return result;
}

Source *source_open_text(SourceMap *map, const char *name, const char *text, size_t length)
{
    char *kept = length < SIZE_MAX ? malloc(length + 1) : NULL;
    if (!kept) {
        return NULL;
    }
    if (length) {
        memcpy(kept, text, length);
    }
    Source *source = source_add(map, name, NO_FILE, kept, length);
    if (!source) {
        free(kept);
    }
    return source;
}

Source *source_open_list(SourceMap *map, const char *name, uint64_t count)
{
    Source *source = source_add(map, name, NO_FILE, NULL, count);
    if (source) {
        source->is_list = true;
    }
    return source;
}

static void source_fini(Source *source)
{
    source_close(source);
    free(source->kept);
    if (source->lines) {
        ARRAY_FREE(source->lines);
        free(source->lines);
    }
}

void source_drop(Source *source)
{
    SourceMap *map = source->map;
    if (map->sources.count > 0 && map->sources.items[map->sources.count - 1] == source && map->again != source) {
        map->sources.count--;
        map->next_base = source->base;
        map->bytes -= source->is_again ? 0 : source->size + 1;
        source_fini(source);
    }
}

// A file is never read beyond the size it had when it was opened, since the numbers after that belong to other texts.
ptrdiff_t source_read(Source *source, char *buffer, size_t size)
{
    uint64_t left = source->size - source->position;
    size_t wanted = size < left ? size : (size_t)left;
    ptrdiff_t got = (ptrdiff_t)wanted;
    if (wanted == 0) {
        return 0;
    }
    if (source->kept) {
        memcpy(buffer, source->kept + source->position, wanted);
    } else if (source->file == NO_FILE) {
        errno = EBADF;
        return -1;
    } else {
        got = read_retrying(source->map, source->file, buffer, wanted);
    }
    if (got > 0) {
        source->position += (uint64_t)got;
        source->map->bytes_read += (uint64_t)got;
    }
    return got;
}

bool source_file_read(int file, uint64_t position, char *buffer, size_t size)
{
    for (size_t have = 0; have < size;) {
        ptrdiff_t got = pread(file, buffer + have, size - have, (off_t)(position + have));
        if (got == 0 || (got < 0 && errno != EINTR)) {
            return false;
        }
        have += got > 0 ? (size_t)got : 0;
    }
    return true;
}

bool source_read_at(const Source *source, uint64_t position, char *buffer, size_t size)
{
    if (position > source->size || size > source->size - position) {
        return false;
    }
    if (source->kept) {
        memcpy(buffer, source->kept + position, size);
        return true;
    }
    return source->file != NO_FILE && source_file_read(source->file, position, buffer, size);
}

// A file that cannot be moved in is closed, so that reading on fails.
void source_seek(Source *source, uint64_t position)
{
    if (source->file != NO_FILE && lseek(source->file, (off_t)position, SEEK_SET) < 0) {
        source_file_close(&source->file);
    }
    source->map->bytes_read += position - source->position; // modulo 2^64: it may be less than before
    source->position = position;
}

bool source_digest(const Source *source, unsigned char out[DIGEST_BYTES])
{
    Digest digest;
    char *block = source->map->block;
    digest_init(&digest);
    for (uint64_t at = 0; at < source->size; at += BLOCK) {
        size_t part = source->size - at < BLOCK ? (size_t)(source->size - at) : BLOCK;
        if (is_cancelled(source->map) || !source_read_at(source, at, block, part)) {
            return false;
        }
        digest_add(&digest, block, part);
    }
    digest_end(&digest, out);
    return true;
}

void source_map_keep_digests(SourceMap *map)
{
    map->keeps_digests = true;
    map->digest_count = 0;
    digest_init(&map->digest);
}

size_t source_map_digest(const SourceMap *map, unsigned char out[DIGEST_BYTES])
{
    Digest digest = map->digest;
    if (map->digest_count > 0) {
        digest_end(&digest, out);
    }
    return map->digest_count;
}

void source_close(Source *source)
{
    unsigned char digest[DIGEST_BYTES];
    SourceMap *map = source->map;
    if (map->keeps_digests && source->is_of_scene && source_digest(source, digest)) {
        digest_add(&map->digest, digest, sizeof digest);
        map->digest_count++;
    }
    source->is_of_scene = false;
    source_file_close(&source->file);
}

size_t source_map_count(const SourceMap *map)
{
    return map->sources.count;
}

const char *source_map_name(const SourceMap *map, size_t i)
{
    return map->sources.items[i]->name;
}

Span source_map_extent(const SourceMap *map, size_t i)
{
    const Source *source = map->sources.items[i];
    return source->is_list ? SPAN_NONE : source_extent(source);
}

uint64_t source_base(const Source *source)
{
    return source->base;
}

const char *source_name(const Source *source)
{
    return source->name;
}

uint64_t source_bytes_read(const SourceMap *map)
{
    return map->bytes_read;
}

bool source_is_again(const Source *source)
{
    return source->is_again;
}

Span source_extent(const Source *source)
{
    return (Span){source->base, source->base + source->size};
}
