// UTF-8: where characters end.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_UTF8_H
#define BASE_UTF8_H

#include <stdbool.h>
#include <stddef.h>

// The length in bytes of the well-formed character (Unicode 15, table 3-7) at `text`, which lies before `end`; 0 where
// the bytes are not well formed.
static inline size_t utf8_length(const char *text, const char *end)
{
    const unsigned char *at = (const unsigned char *)text;
    size_t room = (size_t)(end - text);
    if (at[0] < 0x80) {
        return 1;
    }
    size_t length = at[0] < 0xC2 || at[0] > 0xF4 ? 0 : at[0] < 0xE0 ? 2 : at[0] < 0xF0 ? 3 : 4;
    if (length == 0 || length > room) {
        return 0;
    }
    unsigned low = at[0] == 0xE0 ? 0xA0 : at[0] == 0xF0 ? 0x90 : 0x80;
    unsigned high = at[0] == 0xED ? 0x9F : at[0] == 0xF4 ? 0x8F : 0xBF;
    if (at[1] < low || at[1] > high) {
        return 0;
    }
    for (size_t i = 2; i < length; i++) {
        if ((at[i] & 0xC0) != 0x80) {
            return 0;
        }
    }
    return length;
}

// The same, 0 also for control characters.
static inline size_t utf8_visible(const char *text, const char *end)
{
    const unsigned char *at = (const unsigned char *)text;
    size_t length = utf8_length(text, end);
    bool is_control = length == 1 ? at[0] < 0x20 || at[0] == 0x7F : length == 2 && at[0] == 0xC2 && at[1] < 0xA0;
    return is_control ? 0 : length;
}

#endif
