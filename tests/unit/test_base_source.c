// Tests of base/source.h: opening, reading, and finding places against a plain count, in files, pipes and strings.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/source.h"
#include "unit/tap.h"

#define NO_LIMIT UINT64_MAX

static char folder[] = "/tmp/rtlang-source-XXXXXX";

typedef struct Path {
    char text[64];
} Path;

static Path path_of(const char *name)
{
    Path path;
    snprintf(path.text, sizeof(path.text), "%s/%s", folder, name);
    return path;
}

static Path file_make(const char *name, const char *bytes, size_t size)
{
    Path path = path_of(name);
    FILE *file = fopen(path.text, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        tap_ok(false, "cannot make %s", path.text);
    }
    return path;
}

static size_t read_all(Source *source, char *buffer, size_t size, size_t step)
{
    size_t have = 0;
    ptrdiff_t got = 1;
    while (got > 0 && have < size) {
        got = source_read(source, buffer + have, size - have < step ? size - have : step);
        have += got > 0 ? (size_t)got : 0;
    }
    return have;
}

static void test_open_failures(void)
{
    SourceMap *map = source_map_new();
    Source *source;
    int error_number;
    Path file = file_make("ten", "0123456789", 10);
    tap_ok(source_open_file(map, path_of("missing").text, NO_LIMIT, &source, &error_number) == SOURCE_NOT_FOUND &&
               !source && error_number == ENOENT,
           "a missing file");
    tap_ok(source_open_file(map, path_of("ten/x").text, NO_LIMIT, &source, &error_number) == SOURCE_NOT_FOUND,
           "a file below a file");
    tap_ok(source_open_file(map, folder, NO_LIMIT, &source, &error_number) == SOURCE_IS_DIRECTORY && !source,
           "a directory");
    tap_ok(source_open_file(map, file.text, 9, &source, &error_number) == SOURCE_TOO_LARGE && !source,
           "over the limit");
    tap_ok(source_open_file(map, "/dev/zero", 100000, &source, &error_number) == SOURCE_TOO_LARGE && !source,
           "an endless device is over any limit");
    Path loop = path_of("loop");
    tap_ok(symlink(loop.text, loop.text) == 0 &&
               source_open_file(map, loop.text, NO_LIMIT, &source, &error_number) == SOURCE_NOT_READABLE &&
               error_number == ELOOP,
           "a link to itself cannot be read");
    Path link = path_of("link"), below = path_of("link/ten");
    char *real = realpath(file.text, NULL), *real_folder = realpath(folder, NULL);
    tap_ok(real != NULL && source_open_real(map, real, "name", 9, &source, &error_number) == SOURCE_TOO_LARGE,
           "a real path is opened");
    tap_ok(real_folder != NULL && symlink(real_folder, link.text) == 0 &&
               source_open_real(map, below.text, "name", NO_LIMIT, &source, &error_number) == SOURCE_NOT_FOUND &&
               error_number == ENOTDIR,
           "a part that has become a link is not followed");
    unlink(link.text);
    tap_ok(symlink(real, link.text) == 0 &&
               source_open_real(map, link.text, "name", NO_LIMIT, &source, &error_number) == SOURCE_NOT_READABLE &&
               error_number == ELOOP,
           "nor is the last one");
    unlink(link.text);
    tap_ok(mkfifo(link.text, 0600) == 0 &&
               source_open_real(map, link.text, "name", NO_LIMIT, &source, &error_number) == SOURCE_NOT_A_FILE,
           "and a pipe is not waited for");
    unlink(link.text);
    free(real);
    free(real_folder);
    source_map_set_memory(map, 1 << 20);
    tap_ok(source_open_file(map, "/dev/zero", NO_LIMIT, &source, &error_number) == SOURCE_TOO_MUCH && !source,
           "what must be kept has a limit of its own");
    tap_ok(source_open_file(map, file.text, 10, &source, &error_number) == SOURCE_OK && source && error_number == 0,
           "as large as the limit is fine");
    tap_ok(source_base(source) == 1, "a failure takes no numbers");
    source_map_free(map);
    unlink(file.text);
    unlink(loop.text);
}

static void test_reading(void)
{
    char buffer[64];
    SourceMap *map = source_map_new();
    Source *first, *empty, *again, *text;
    int error_number;
    Path path = file_make("read", "hello\nworld\n", 12), nothing = file_make("empty", "", 0);
    bool is_open = source_open_file(map, path.text, NO_LIMIT, &first, &error_number) == SOURCE_OK &&
                   source_open_file(map, nothing.text, NO_LIMIT, &empty, &error_number) == SOURCE_OK &&
                   source_open_file(map, path.text, NO_LIMIT, &again, &error_number) == SOURCE_OK;
    text = source_open_text(map, "<text>", "abc", 3);
    if (tap_ok(is_open && text, "four texts")) {
        tap_ok(source_base(first) == 1 && source_base(empty) == 14 && source_base(again) == 15 &&
                   source_base(text) == 28,
               "each text takes its size and one");
        tap_ok(source_name(first) == source_name(again), "a name is stored once");
        tap_ok(read_all(first, buffer, 64, 5) == 12 && memcmp(buffer, "hello\nworld\n", 12) == 0, "a file is read");
        tap_ok(source_read(first, buffer, 64) == 0, "then it is at its end");
        tap_ok(read_all(empty, buffer, 64, 64) == 0, "an empty file");
        tap_ok(read_all(text, buffer, 64, 2) == 3 && memcmp(buffer, "abc", 3) == 0, "a string");
        tap_ok(source_bytes_read(map) == 15, "bytes are counted");
        source_close(again);
        source_close(again);
        tap_ok(source_read(again, buffer, 64) == -1 && errno == EBADF, "a closed file cannot be read");
        FILE *file = fopen(path.text, "ab");
        source_close(first);
        is_open = source_open_file(map, path.text, NO_LIMIT, &first, &error_number) == SOURCE_OK;
        fputs("more", file);
        fclose(file);
        tap_ok(is_open && read_all(first, buffer, 64, 64) == 12, "what is added later is not read");
    }
    source_map_free(map);
    unlink(path.text);
    unlink(nothing.text);
}

static void test_locate_table(void)
{
    static const char text[] = "one\r\n\n\ttw\xC3\xB6 x\n\xE4y\nlast";
    static const struct {
        size_t begin, end;
        uint64_t line, column;
        const char *text;
        size_t caret_begin, caret_end;
    } cases[] = {
        {0, 3, 1, 1, "one", 0, 3},
        {1, 2, 1, 2, "one", 1, 2},
        {2, 9, 1, 3, "one", 2, 3},
        {3, 4, 1, 4, "one", 3, 3},
        {4, 5, 1, 5, "one", 3, 3},
        {5, 6, 2, 1, "", 0, 0},
        {6, 7, 3, 1, "\ttw\xC3\xB6 x", 0, 1},
        {12, 13, 3, 6, "\ttw\xC3\xB6 x", 6, 7},
        {14, 15, 4, 1, "\xE4y", 0, 1},
        {15, 16, 4, 2, "\xE4y", 1, 2},
        {17, 99, 5, 1, "last", 0, 4},
        {21, 21, 5, 5, "last", 4, 4},
    };
    SourceMap *map = source_map_new();
    Path path = file_make("table", text, sizeof(text) - 1);
    Source *sources[2];
    int error_number;
    bool is_open = source_open_file(map, path.text, NO_LIMIT, &sources[0], &error_number) == SOURCE_OK;
    sources[1] = source_open_text(map, "<text>", text, sizeof(text) - 1);
    for (size_t i = 0; is_open && i < 2 * RT_COUNT_OF(cases); i++) {
        const Source *source = sources[i % 2];
        size_t k = i / 2;
        uint64_t base = source_base(source);
        SourceLocation at;
        bool is_found = source_locate(map, (Span){base + cases[k].begin, base + cases[k].end}, &at);
        tap_ok(is_found && strcmp(at.name, source_name(source)) == 0 && at.line == cases[k].line &&
                   at.column == cases[k].column && at.text_length == strlen(cases[k].text) &&
                   memcmp(at.text, cases[k].text, at.text_length) == 0 && at.caret_begin == cases[k].caret_begin &&
                   at.caret_end == cases[k].caret_end,
               "%s %zu is at %ju:%ju", i % 2 ? "string" : "file", cases[k].begin, (uintmax_t)cases[k].line,
               (uintmax_t)cases[k].column);
    }
    SourceLocation at;
    tap_ok(!source_locate(map, SPAN_WHOLE(1), &at) && at.name && at.line == 0, "a text as a whole has a name only");
    tap_ok(!source_locate(map, SPAN_NONE, &at) && !at.name && at.line == 0, "no span, no place");
    tap_ok(!source_locate(map, (Span){45, 45}, &at) && !at.name, "beyond all texts there is no place");
    source_map_free(map);
    unlink(path.text);
}

// A file with short, long and very long lines, some of them UTF-8, some broken.
static char *text_random(size_t size, uint32_t seed)
{
    static const char *const pieces[] = {"a",        " ",    "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\x80",
                                         "\xE2\x82", "\r\n", "\n"};
    char *text = malloc(size + 8);
    size_t length = 0, rare = 8;
    while (text && length < size) {
        seed = seed * 1664525u + 1013904223u;
        size_t pick = (seed >> 16) % 16384;
        if (pick < 4) {
            rare = (size_t[]){8, 60, 700, 16384}[pick]; // the mean length of a line changes on the way
        }
        const char *piece = pieces[pick % rare == 0 ? 7 + pick / rare % 2 : (seed >> 8) % 7];
        memcpy(text + length, piece, strlen(piece));
        length += strlen(piece);
    }
    return text;
}

static bool is_well_formed(const unsigned char *at, size_t room, size_t *length)
{
    *length = at[0] >= 0xF0 ? 4 : at[0] >= 0xE0 ? 3 : at[0] >= 0xC2 ? 2 : 1;
    bool is_whole = *length > 1 && *length <= room;
    for (size_t i = 1; is_whole && i < *length; i++) {
        is_whole = (at[i] & 0xC0) == 0x80;
    }
    return is_whole;
}

static uint64_t plain_column(const char *line, size_t length)
{
    uint64_t column = 1;
    for (size_t i = 0, step; i < length; i += step, column++) {
        step = is_well_formed((const unsigned char *)line + i, length - i, &step) ? step : 1;
    }
    return column;
}

static void test_locate_random(bool is_backward)
{
    enum { SIZE = 300000, STEP = 97 };
    char *text = text_random(SIZE, 3);
    SourceMap *map = source_map_new();
    Path path = file_make("random", text, SIZE);
    Source *source;
    int error_number, wrong = 0, places = 0;
    bool is_open = source_open_file(map, path.text, NO_LIMIT, &source, &error_number) == SOURCE_OK;
    source_close(source);
    for (size_t i = 0; is_open && i <= SIZE; i += STEP, places++) {
        size_t offset = is_backward ? SIZE - i : i;
        uint64_t line = 1;
        size_t start = 0;
        for (size_t k = 0; k < offset; k++) {
            if (text[k] == '\n') {
                line++;
                start = k + 1;
            }
        }
        SourceLocation at;
        bool is_found = source_locate(map, (Span){1 + offset, 1 + offset + 1}, &at);
        bool is_right = is_found && at.line == line && at.column == plain_column(text + start, offset - start) &&
                        at.text_length <= 206 && at.caret_begin <= at.text_length && at.caret_end <= at.text_length;
        if (is_right && offset < SIZE && text[offset] != '\n' && text[offset] != '\r') {
            is_right = at.text[at.caret_begin] == text[offset] && at.caret_end == at.caret_begin + 1;
        }
        wrong += !is_right;
    }
    tap_ok(is_open && wrong == 0, "%d places equal a plain count, going %s", places, is_backward ? "back" : "forth");
    source_map_free(map);
    unlink(path.text);
    free(text);
}

static void test_long_line(void)
{
    enum { SIZE = 100 * 1000 * 1000, MESSAGES = 20000 };
    Path path = path_of("long");
    int file = open(path.text, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    bool is_made = file >= 0 && ftruncate(file, SIZE) == 0 && pwrite(file, "begin", 5, 0) == 5 &&
                   pwrite(file, "middle", 6, SIZE / 2) == 6 && pwrite(file, "end", 3, SIZE - 3) == 3;
    close(file);
    SourceMap *map = source_map_new();
    Source *source;
    int error_number;
    if (!tap_ok(is_made && source_open_file(map, path.text, NO_LIMIT, &source, &error_number) == SOURCE_OK,
                "a line of 100 MB")) {
        source_map_free(map);
        return;
    }
    SourceLocation at;
    tap_ok(source_locate(map, (Span){1 + SIZE / 2, 1 + SIZE / 2 + 6}, &at) && at.line == 1 && at.column == SIZE / 2 + 1,
           "its middle is found");
    tap_ok(at.text_length == 206 && at.caret_begin == 103 && at.caret_end == 109 &&
               memcmp(at.text + 103, "middle", 6) == 0 && memcmp(at.text, "...", 3) == 0 &&
               memcmp(at.text + 203, "...", 3) == 0,
           "200 bytes around it are shown");
    tap_ok(source_locate(map, (Span){1, SIZE}, &at) && at.text_length == 203 && at.caret_begin == 0 &&
               at.caret_end == 200 && memcmp(at.text, "begin", 5) == 0,
           "a span over all of it is clipped to the window");
    tap_ok(source_locate(map, (Span){SIZE - 2, SIZE + 1}, &at) && at.column == SIZE - 2 && at.text_length == 203 &&
               at.caret_begin == 200 && at.caret_end == 203 && memcmp(at.text + 200, "end", 3) == 0,
           "at its end the window stands before the span");
    int found = 0;
    for (int i = 0; i < MESSAGES; i++) {
        uint64_t offset = (uint64_t)i * 7919u * 131u % SIZE;
        found += source_locate(map, (Span){1 + offset, 2 + offset}, &at) && at.column == offset + 1;
    }
    tap_ok(found == MESSAGES, "%d places in it are found one by one", MESSAGES);
    source_map_free(map);
    unlink(path.text);
}

// Sequences that only look like UTF-8 count byte by byte (Unicode 15, table 3-7).
static void test_columns(void)
{
    static const struct {
        const char *line;
        uint64_t column;
    } cases[] = {
        {"\xC3\xA4|", 2},         {"\xC0\x80|", 3},         {"\xC1\xBF|", 3},         {"\xE0\x9F\xBF|", 4},
        {"\xE0\xA0\x80|", 2},     {"\xED\x9F\xBF|", 2},     {"\xED\xA0\x80|", 4},     {"\xF0\x8F\xBF\xBF|", 5},
        {"\xF0\x90\x80\x80|", 2}, {"\xF4\x8F\xBF\xBF|", 2}, {"\xF4\x90\x80\x80|", 5}, {"\xF5\x80\x80\x80|", 5},
        {"\xE2\x82|", 3},         {"\xE2\xC3\xA4|", 3},     {"\x80\x80|", 3},
    };
    SourceMap *map = source_map_new();
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        size_t length = strlen(cases[i].line);
        Source *source = source_open_text(map, "<text>", cases[i].line, length);
        uint64_t offset = source_base(source) + length - 1;
        SourceLocation at;
        tap_ok(source_locate(map, (Span){offset, offset + 1}, &at) && at.column == cases[i].column,
               "sequence %zu puts the bar into column %ju", i, (uintmax_t)cases[i].column);
    }
    source_map_free(map);
}

// Wherever a long line of characters of 3 bytes is cut, whole characters are left.
static void test_cuts(void)
{
    enum { LENGTH = 3000 };
    static char line[LENGTH];
    int broken = 0;
    for (size_t i = 0; i < LENGTH; i++) {
        line[i] = "\xE2\x82\xAC"[i % 3];
    }
    SourceMap *map = source_map_new();
    Source *source = source_open_text(map, "<text>", line, LENGTH);
    for (uint64_t offset = 0; offset <= LENGTH; offset += 3) {
        SourceLocation at;
        bool is_found = source_locate(map, (Span){source_base(source) + offset, source_base(source) + offset}, &at);
        const char *first = at.text, *end = at.text + at.text_length;
        first += is_found && *first == '.' ? 3 : 0;
        end -= is_found && end[-1] == '.' ? 3 : 0;
        broken += !is_found || (end - first) % 3 != 0 || (end - first) < 190 || *first != '\xE2' || end[-1] != '\xAC';
    }
    tap_ok(broken == 0, "no cut goes through a character");
    source_map_free(map);
}

static void test_pipe(void)
{
    enum { SIZE = 200000 };
    char *text = text_random(SIZE, 9), *back = malloc(SIZE + 8);
    Path path = path_of("pipe");
    bool is_made = text && back && mkfifo(path.text, 0600) == 0;
    pid_t child = is_made ? fork() : -1;
    if (child == 0) {
        int file = open(path.text, O_WRONLY);
        for (ssize_t sent = 0, got; sent < SIZE; sent += got) {
            got = write(file, text + sent, (size_t)(SIZE - sent));
            if (got <= 0) {
                _exit(1);
            }
        }
        _exit(0);
    }
    SourceMap *map = source_map_new();
    Source *source = NULL;
    int error_number;
    SourceLocation at;
    tap_ok(child > 0 && source_open_file(map, path.text, NO_LIMIT, &source, &error_number) == SOURCE_OK,
           "a pipe opens");
    unlink(path.text);
    tap_ok(read_all(source, back, SIZE + 8, 5000) == SIZE && memcmp(text, back, SIZE) == 0, "and is read whole");
    source_close(source);
    tap_ok(source_locate(map, (Span){SIZE, SIZE}, &at) && at.line > 1, "and lines in it are found later");
    source_map_free(map);
    free(text);
    free(back);
}

static void test_changed_files(void)
{
    SourceMap *map = source_map_new();
    Source *source;
    int error_number;
    SourceLocation at;
    Path path = file_make("gone", "one\ntwo\n", 8);
    bool is_open = source_open_file(map, path.text, NO_LIMIT, &source, &error_number) == SOURCE_OK;
    source_close(source);
    tap_ok(is_open && truncate(path.text, 2) == 0 && !source_locate(map, (Span){5, 6}, &at) && at.line == 0 &&
               strcmp(at.name, path.text) == 0,
           "a file that became shorter has a name but no line");
    source_map_free(map);
    map = source_map_new();
    is_open = source_open_file(map, path.text, NO_LIMIT, &source, &error_number) == SOURCE_OK;
    unlink(path.text);
    tap_ok(is_open && !source_locate(map, (Span){1, 2}, &at) && at.line == 0 && at.name,
           "neither has one that is gone");
    tap_ok(mkfifo(path.text, 0600) == 0 && !source_locate(map, (Span){1, 2}, &at),
           "a pipe in its place is not waited for");
    unlink(path.text);
    source_map_free(map);
}

static void test_many_includes(void)
{
    enum { TIMES = 100000 };
    SourceMap *map = source_map_new();
    Path path = file_make("often", "sphere { 0, 1 }\n", 16);
    Source *source;
    int error_number, failures = 0;
    char buffer[32];
    SourceLocation at;
    for (int i = 0; i < TIMES; i++) {
        if (source_open_file(map, path.text, NO_LIMIT, &source, &error_number) != SOURCE_OK) {
            failures++;
            break;
        }
        failures += source_read(source, buffer, sizeof(buffer)) != 16;
        source_close(source);
    }
    tap_ok(failures == 0, "one file opens %d times: closing gives the file back", TIMES);
    tap_ok(source_base(source) == 1 + 17u * (TIMES - 1), "each time under numbers of its own");
    tap_ok(source_locate(map, (Span){source_base(source) + 7, source_base(source) + 8}, &at) && at.line == 1 &&
               at.column == 8,
           "the last one is found");
    source_map_free(map);
    unlink(path.text);
}

int main(void)
{
    if (!mkdtemp(folder)) {
        tap_ok(false, "a folder for the test");
        return tap_done();
    }
    test_open_failures();
    test_reading();
    test_locate_table();
    test_locate_random(false);
    test_locate_random(true);
    test_long_line();
    test_columns();
    test_cuts();
    test_pipe();
    test_changed_files();
    test_many_includes();
    rmdir(folder);
    return tap_done();
}
