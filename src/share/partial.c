// Files of partial results, written and read: see partial.h.
//
// What is read may be anybody's bytes: each length is held to what is left, and each record to its check.
//
// SPDX-License-Identifier: MIT
#include "share/partial.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/digest.h"

static const char magic[] = "rtlang partial result 1\n";

enum { CHECK_BYTES = 8, RECORD_NUMBERS = 3, RECORD_BYTES = 4 * RECORD_NUMBERS + CHECK_BYTES };

// ---- the head

bool partial_head_set(PartialHead *head, PartialField field, const char *value)
{
    char *copy = strdup(value);
    free(head->fields[field]);
    head->fields[field] = copy;
    return copy != NULL;
}

void partial_head_fini(PartialHead *head)
{
    for (int i = 0; i < PARTIAL_FIELDS; i++) {
        free(head->fields[i]);
        head->fields[i] = NULL;
    }
}

PartialField partial_head_differs(const PartialHead *a, const PartialHead *b)
{
    for (int i = 0; i < PARTIAL_RESULTS; i++) {
        if (strcmp(a->fields[i], b->fields[i]) != 0) {
            return (PartialField)i;
        }
    }
    return PARTIAL_RESULTS;
}

const char *partial_difference(PartialField field)
{
    static const char *const texts[PARTIAL_RESULTS] = {[PARTIAL_VERSION] = "the version of rtlang is another one",
                                                       [PARTIAL_SCENE] = "the scene's text is another one",
                                                       [PARTIAL_FILES] = "files that the scene includes are others",
                                                       [PARTIAL_PICTURES] = "pictures that the scene shows are others",
                                                       [PARTIAL_OPTIONS] = "the options are others"};
    return texts[field];
}

bool partial_head_part(const PartialHead *head, int *part, int *parts)
{
    char end;
    return sscanf(head->fields[PARTIAL_PART], "%9d/%9d%c", part, parts, &end) == 2 && *part >= 1 && *part <= *parts;
}

// ---- numbers and checks

static void put_number(unsigned char *to, uint32_t number)
{
    for (int i = 0; i < 4; i++) {
        to[i] = (unsigned char)(number >> (8 * i));
    }
}

static uint32_t get_number(const unsigned char *from)
{
    return from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
}

static void check_of(const unsigned char *numbers, size_t number_bytes, const unsigned char *bytes, size_t length,
                     unsigned char check[CHECK_BYTES])
{
    Digest digest;
    unsigned char all[DIGEST_BYTES];
    digest_init(&digest);
    digest_add(&digest, numbers, number_bytes);
    digest_add(&digest, bytes, length);
    digest_end(&digest, all);
    memcpy(check, all, CHECK_BYTES);
}

// ---- writing

void partial_append_head(TextBuffer *file, const PartialHead *head)
{
    unsigned char number[4], check[CHECK_BYTES];
    size_t begin = file->length;
    text_append(file, magic);
    for (int i = 0; i < PARTIAL_FIELDS; i++) {
        size_t length = strlen(head->fields[i]);
        put_number(number, (uint32_t)length);
        text_append_n(file, (const char *)number, sizeof number);
        text_append_n(file, head->fields[i], length);
    }
    if (!file->failed) {
        check_of((const unsigned char *)file->text + begin, file->length - begin, NULL, 0, check);
        text_append_n(file, (const char *)check, sizeof check);
    }
}

void partial_append(TextBuffer *file, const PartialRecord *record)
{
    unsigned char begin[RECORD_BYTES];
    put_number(begin, record->pass);
    put_number(begin + 4, record->tile);
    put_number(begin + 8, (uint32_t)record->length);
    check_of(begin, 4 * RECORD_NUMBERS, record->bytes, record->length, begin + 4 * RECORD_NUMBERS);
    text_append_n(file, (const char *)begin, sizeof begin);
    text_append_n(file, (const char *)record->bytes, record->length);
}

// ---- reading

typedef struct Input {
    const unsigned char *at;
    size_t left;
} Input;

static const unsigned char *take(Input *input, size_t size)
{
    const unsigned char *bytes = input->at;
    if (size > input->left) {
        return NULL;
    }
    input->at += size;
    input->left -= size;
    return bytes;
}

static PartialResult take_head(Input *input, PartialHead *head)
{
    const unsigned char *begin = input->at, *bytes = take(input, sizeof magic - 1);
    unsigned char check[CHECK_BYTES];
    if (!bytes || memcmp(bytes, magic, sizeof magic - 1) != 0) {
        return PARTIAL_NO_PARTIAL;
    }
    for (int i = 0; i < PARTIAL_FIELDS; i++) {
        const unsigned char *number = take(input, 4), *value = number ? take(input, get_number(number)) : NULL;
        if (!value || memchr(value, '\0', get_number(number))) {
            return PARTIAL_NO_PARTIAL;
        }
        head->fields[i] = strndup((const char *)value, get_number(number));
        if (!head->fields[i]) {
            return PARTIAL_NO_MEMORY;
        }
    }
    check_of(begin, (size_t)(input->at - begin), NULL, 0, check);
    bytes = take(input, sizeof check);
    return bytes && memcmp(bytes, check, sizeof check) == 0 ? PARTIAL_OK : PARTIAL_NO_PARTIAL;
}

static bool take_record(Input *input, PartialRecord *record)
{
    const unsigned char *begin = take(input, RECORD_BYTES);
    unsigned char check[CHECK_BYTES];
    if (!begin) {
        return false;
    }
    *record = (PartialRecord){get_number(begin), get_number(begin + 4), NULL, get_number(begin + 8)};
    record->bytes = take(input, record->length);
    if (!record->bytes) {
        return false;
    }
    check_of(begin, 4 * RECORD_NUMBERS, record->bytes, record->length, check);
    return memcmp(check, begin + 4 * RECORD_NUMBERS, sizeof check) == 0;
}

PartialResult partial_take(Partial *partial, unsigned char *bytes, size_t size)
{
    *partial = (Partial){.bytes = bytes};
    Input input = {bytes, size};
    PartialRecord record;
    PartialResult result = take_head(&input, &partial->head);
    while (result == PARTIAL_OK && input.left > 0 && !partial->is_complete && !partial->is_broken) {
        bool is_whole = take_record(&input, &record), is_end = is_whole && record.tile == PARTIAL_END;
        partial->is_complete = is_end && record.pass == (uint32_t)partial->records.count;
        partial->is_broken = !is_whole || (is_end && !partial->is_complete);
        if (is_whole && !is_end && !ARRAY_PUSH(&partial->records, record)) {
            result = PARTIAL_NO_MEMORY;
        }
    }
    partial->is_broken = partial->is_broken || input.left > 0;
    if (result != PARTIAL_OK) {
        partial_fini(partial);
    }
    return result;
}

static PartialResult read_stream(FILE *stream, unsigned char **bytes, size_t *size)
{
    size_t capacity = 1 << 16, got;
    *size = 0;
    *bytes = malloc(capacity);
    while (*bytes && (got = fread(*bytes + *size, 1, capacity - *size, stream)) > 0) {
        *size += got;
        if (*size == capacity) {
            unsigned char *more = realloc(*bytes, capacity *= 2);
            if (!more) {
                free(*bytes);
            }
            *bytes = more;
        }
    }
    if (!*bytes) {
        return PARTIAL_NO_MEMORY;
    }
    return ferror(stream) ? PARTIAL_NOT_READ : PARTIAL_OK;
}

PartialResult partial_read(Partial *partial, const char *path)
{
    unsigned char *bytes;
    size_t size;
    errno = 0;
    FILE *stream = fopen(path, "rbe");
    if (!stream) {
        return errno == ENOENT ? PARTIAL_NONE : PARTIAL_NOT_READ;
    }
    PartialResult result = read_stream(stream, &bytes, &size);
    int error = errno;
    (void)fclose(stream);
    errno = error;
    if (result != PARTIAL_OK) {
        free(bytes);
        return result;
    }
    return partial_take(partial, bytes, size);
}

void partial_fini(Partial *partial)
{
    partial_head_fini(&partial->head);
    ARRAY_FREE(&partial->records);
    free(partial->bytes);
    partial->bytes = NULL;
}

int partial_record_compare(const void *a, const void *b)
{
    const PartialRecord *one = a, *other = b;
    return one->pass != other->pass   ? (one->pass < other->pass ? -1 : 1)
           : one->tile != other->tile ? (one->tile < other->tile ? -1 : 1)
                                      : 0;
}
