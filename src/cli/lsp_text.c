// Counting of lines and characters, and a search for declarations by their words.
//
// SPDX-License-Identifier: MIT
#include "cli/lsp_text.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "cli/lsp_json.h"

// Bytes of a character of UTF-8 by its first one; a stray byte is one.
static size_t character_bytes(const char *at)
{
    unsigned char first = (unsigned char)*at;
    size_t wanted = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1, size = 1;
    while (size < wanted && ((unsigned char)at[size] & 0xC0) == 0x80) {
        size++;
    }
    return size;
}

static const char *line_begin(const char *text, unsigned long long line)
{
    for (; line > 0; line--) {
        const char *newline = strchr(text, '\n');
        if (!newline) {
            return text + strlen(text);
        }
        text = newline + 1;
    }
    return text;
}

const char *text_at(const char *text, Position position)
{
    const char *at = line_begin(text, (unsigned long long)position.line);
    for (int units = 0; units < position.character && *at && *at != '\n';) {
        size_t size = character_bytes(at);
        units += size == 4 ? 2 : 1;
        at += size;
    }
    return at;
}

static Position text_position(const char *text, const char *at)
{
    Position position = {0, 0};
    const char *begin = text;
    for (const char *newline; (newline = memchr(begin, '\n', (size_t)(at - begin))) != NULL; begin = newline + 1) {
        position.line++;
    }
    while (begin < at) {
        size_t size = character_bytes(begin);
        position.character += size == 4 ? 2 : 1;
        begin += size;
    }
    return position;
}

const char *text_of_column(const char *text, unsigned long long line, unsigned long long column)
{
    const char *at = line_begin(text, line > 0 ? line - 1 : 0);
    for (; column > 1 && *at && *at != '\n'; column--) {
        at += character_bytes(at);
    }
    return at;
}

static bool is_part(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

Word text_word(const char *text, const char *at)
{
    const char *begin = at, *end = at;
    while (begin > text && is_part(begin[-1])) {
        begin--;
    }
    while (is_part(*end)) {
        end++;
    }
    return (Word){begin, isdigit((unsigned char)*begin) ? 0 : (size_t)(end - begin)};
}

// Behind the directive of this name that the `#` begins; NULL: it is another one.
static const char *behind_directive(const char *at, const char *name)
{
    size_t length = strlen(name);
    at += 1 + strspn(at + 1, " \t");
    return strncmp(at, name, length) == 0 && !is_part(at[length]) ? at + length + strspn(at + length, " \t\r\n") : NULL;
}

Word text_next_declared(const char *from)
{
    static const char *const directives[] = {"declare", "local", "macro"};
    for (const char *at = strchr(from, '#'); at; at = strchr(at + 1, '#')) {
        for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
            const char *name = behind_directive(at, directives[i]);
            Word word = name ? text_word(name, name) : (Word){at, 0};
            if (word.length > 0) {
                return word;
            }
        }
    }
    return (Word){NULL, 0};
}

Word text_find_declared(const char *text, Word name, const char *before)
{
    Word found = {NULL, 0};
    for (Word next = text_next_declared(text); next.length > 0; next = text_next_declared(next.begin)) {
        bool is_it = next.length == name.length && memcmp(next.begin, name.begin, name.length) == 0;
        if (is_it && (!found.begin || next.begin <= before)) {
            found = next;
        }
    }
    return found;
}

Word text_next_include(const char *from)
{
    for (const char *at = strchr(from, '#'); at; at = strchr(at + 1, '#')) {
        const char *name = behind_directive(at, "include");
        if (name && *name == '"') {
            return (Word){name + 1, strcspn(name + 1, "\"\n")};
        }
    }
    return (Word){NULL, 0};
}

void text_write_range(FILE *out, const char *text, const char *begin, const char *end)
{
    Position first = text_position(text, begin), last = text_position(text, end);
    fprintf(out, "{\"start\":{\"line\":%d,\"character\":%d},\"end\":{\"line\":%d,\"character\":%d}}", first.line,
            first.character, last.line, last.character);
}

char *text_path_of_uri(const char *uri)
{
    static const char scheme[] = "file://";
    if (strncmp(uri, scheme, sizeof scheme - 1) != 0) {
        return NULL;
    }
    char *path = strdup(uri + sizeof scheme - 1), *to = path;
    for (const char *at = path; at && *at; at++) {
        char digits[3] = {at[0] == '%' ? at[1] : 'x', at[0] == '%' && at[1] ? at[2] : 'x', '\0'};
        if (isxdigit((unsigned char)digits[0]) && isxdigit((unsigned char)digits[1])) {
            *to++ = (char)strtol(digits, NULL, 16);
            at += 2;
        } else {
            *to++ = *at;
        }
    }
    if (path) {
        *to = '\0';
    }
    return path;
}

void text_write_uri(FILE *out, const char *path)
{
    fputs("\"file://", out);
    for (; *path; path++) {
        if (isalnum((unsigned char)*path) || strchr("/-._~", *path)) {
            putc(*path, out);
        } else {
            fprintf(out, "%%%02X", (unsigned)(unsigned char)*path);
        }
    }
    putc('"', out);
}
