// A recursive walk over the text that checks it, and walks to single members.
//
// SPDX-License-Identifier: MIT
#include "cli/lsp_json.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH_MOST = 100 };

static const char *skip_blanks(const char *at, const char *end)
{
    while (at < end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) {
        at++;
    }
    return at;
}

// Behind a text that begins at `at`; NULL: it does not end.
static const char *skip_text(const char *at, const char *end)
{
    for (at++; at < end && *at != '"'; at++) {
        if ((unsigned char)*at < 0x20 || (*at == '\\' && ++at == end)) {
            return NULL;
        }
    }
    return at < end ? at + 1 : NULL;
}

static const char *skip_plain(const char *at, const char *end)
{
    const char *begin = at;
    while (at < end && (strchr("+-.", *at) || (*at >= '0' && *at <= '9') || (*at >= 'a' && *at <= 'z') || *at == 'E')) {
        at++;
    }
    return at > begin ? at : NULL;
}

// Behind a value; NULL: it is none.
static const char *skip_value(const char *at, const char *end, unsigned depth)
{
    if (at >= end || depth == 0 || *at == '\0') {
        return NULL;
    }
    if (*at == '"') {
        return skip_text(at, end);
    }
    if (*at != '{' && *at != '[') {
        return skip_plain(at, end);
    }
    char close = *at == '{' ? '}' : ']';
    at = skip_blanks(at + 1, end);
    for (bool is_first = true; at < end && *at != close; is_first = false) {
        if (!is_first && *at++ != ',') {
            return NULL;
        }
        at = skip_blanks(at, end);
        if (close == '}') {
            at = at < end && *at == '"' ? skip_text(at, end) : NULL;
            at = at ? skip_blanks(at, end) : end;
            if (at >= end || *at++ != ':') {
                return NULL;
            }
            at = skip_blanks(at, end);
        }
        at = skip_value(at, end, depth - 1);
        if (!at) {
            return NULL;
        }
        at = skip_blanks(at, end);
    }
    return at < end ? at + 1 : NULL;
}

Json json_whole(const char *text, size_t length)
{
    const char *end = text + length, *begin = skip_blanks(text, end), *behind = skip_value(begin, end, DEPTH_MOST);
    return behind && skip_blanks(behind, end) == end ? (Json){begin, behind} : (Json){NULL, NULL};
}

static Json last_element(Json array)
{
    Json found = {NULL, NULL};
    const char *at = skip_blanks(array.begin + 1, array.end);
    while (at < array.end && *at != ']') {
        found = (Json){at, skip_value(at, array.end, DEPTH_MOST)};
        at = skip_blanks(found.end, array.end);
        at = *at == ',' ? skip_blanks(at + 1, array.end) : at;
    }
    return found;
}

static Json member(Json object, const char *name, size_t length)
{
    const char *at = skip_blanks(object.begin + 1, object.end);
    while (at < object.end && *at != '}') {
        const char *behind = skip_text(at, object.end);
        bool is_it = (size_t)(behind - at) == length + 2 && memcmp(at + 1, name, length) == 0;
        at = skip_blanks(skip_blanks(behind, object.end) + 1, object.end);
        Json found = {at, skip_value(at, object.end, DEPTH_MOST)};
        if (is_it) {
            return found;
        }
        at = skip_blanks(found.end, object.end);
        at = *at == ',' ? skip_blanks(at + 1, object.end) : at;
    }
    return (Json){NULL, NULL};
}

Json json_at(Json value, const char *path)
{
    while (value.begin && *path) {
        size_t length = strcspn(path, ".");
        bool is_last = length == 1 && *path == '$';
        if (*value.begin != (is_last ? '[' : '{')) {
            return (Json){NULL, NULL};
        }
        value = is_last ? last_element(value) : member(value, path, length);
        path += length + (path[length] == '.');
    }
    return value;
}

// Four hexadecimal digits; -1: they are none.
static int take_unit(const char *at, const char *end)
{
    int unit = 0;
    for (int i = 0; i < 4; i++) {
        const char *digits = "0123456789abcdef", *found;
        if (at + i >= end) {
            return -1;
        }
        char c = at[i] >= 'A' && at[i] <= 'F' ? (char)(at[i] + 'a' - 'A') : at[i];
        found = c ? strchr(digits, c) : NULL;
        if (!found) {
            return -1;
        }
        unit = unit * 16 + (int)(found - digits);
    }
    return unit;
}

static char *put_utf8(char *to, uint32_t c)
{
    if (c < 0x80) {
        *to++ = (char)c;
    } else if (c < 0x800) {
        *to++ = (char)(0xC0 | c >> 6);
        *to++ = (char)(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        *to++ = (char)(0xE0 | c >> 12);
        *to++ = (char)(0x80 | (c >> 6 & 0x3F));
        *to++ = (char)(0x80 | (c & 0x3F));
    } else {
        *to++ = (char)(0xF0 | c >> 18);
        *to++ = (char)(0x80 | (c >> 12 & 0x3F));
        *to++ = (char)(0x80 | (c >> 6 & 0x3F));
        *to++ = (char)(0x80 | (c & 0x3F));
    }
    return to;
}

// What stands behind `\u`, with the second half of a pair; half a pair alone is U+FFFD.
static const char *take_escape(const char *at, const char *end, char **to)
{
    int unit = take_unit(at, end), other = -1;
    if (unit < 0) {
        *to = put_utf8(*to, 0xFFFD);
        return at;
    }
    at += 4;
    if (unit >= 0xD800 && unit < 0xDC00 && at + 6 <= end && at[0] == '\\' && at[1] == 'u') {
        other = take_unit(at + 2, end);
    }
    if (other >= 0xDC00 && other < 0xE000) {
        *to = put_utf8(*to, 0x10000 + ((uint32_t)(unit - 0xD800) << 10) + (uint32_t)(other - 0xDC00));
        return at + 6;
    }
    *to = put_utf8(*to, (unit >= 0xD800 && unit < 0xE000) || unit == 0 ? 0xFFFD : (uint32_t)unit);
    return at;
}

char *json_take_text(Json value)
{
    static const char letters[] = "bfnrt", meant[] = "\b\f\n\r\t";
    if (!value.begin || *value.begin != '"') {
        return NULL;
    }
    char *text = malloc((size_t)(value.end - value.begin) + 2), *to = text;
    const char *at = value.begin + 1, *end = value.end - 1;
    while (text && at < end) {
        if (*at != '\\') {
            *to++ = *at++;
            continue;
        }
        const char *found = strchr(letters, at[1]);
        if (at[1] == 'u') {
            at = take_escape(at + 2, end, &to);
        } else {
            *to++ = found ? meant[found - letters] : at[1];
            at += 2;
        }
    }
    if (text) {
        *to = '\0';
    }
    return text;
}

int json_take_count(Json value)
{
    char *end;
    long number = value.begin && *value.begin >= '0' && *value.begin <= '9' ? strtol(value.begin, &end, 10) : -1;
    return number >= 0 && number <= INT32_MAX && end == value.end ? (int)number : -1;
}
