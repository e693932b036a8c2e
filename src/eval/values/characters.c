// What bytes of a scene's strings are as characters.
//
// Measured of POV-Ray 3.7. Knows nothing of the functions of strings.
//
// SPDX-License-Identifier: MIT
#include "eval/values/characters.h"

#include "base/utf8.h"
enum { CODE_UNKNOWN = 0xFFFD }; // in the place of those above 65535

// Of two or three bytes; 0 when they are no such character.
static size_t wide_length(const unsigned char *at, size_t room)
{
    size_t length = at[0] >= 0xC2 && at[0] <= 0xDF ? 2 : (at[0] & 0xF0) == 0xE0 ? 3 : 0;
    if (length == 0 || length > room || (at[1] & 0xC0) != 0x80 || (at[0] == 0xE0 && at[1] < 0xA0) ||
        (length == 3 && (at[2] & 0xC0) != 0x80)) {
        return 0;
    }
    return length;
}

unsigned character_at(const char *text, const char *end, size_t *bytes)
{
    const unsigned char *at = (const unsigned char *)text;
    size_t length = at[0] < 0x80 ? 1 : wide_length(at, (size_t)(end - text));
    *bytes = length > 0 ? length : 1;
    switch (length) {
    case 2: return (at[0] & 0x1Fu) << 6 | (at[1] & 0x3Fu);
    case 3: return (at[0] & 0x0Fu) << 12 | (at[1] & 0x3Fu) << 6 | (at[2] & 0x3Fu);
    default: return at[0];
    }
}

size_t characters_offset(const char *text, size_t length, size_t index)
{
    const char *at = text, *end = text + length;
    size_t bytes;
    for (; index > 0 && at < end; index--) {
        (void)character_at(at, end, &bytes);
        at += bytes;
    }
    return (size_t)(at - text);
}

size_t characters_count(const char *text, size_t length)
{
    const char *end = text + length;
    size_t count = 0, bytes;
    for (const char *at = text; at < end; at += bytes) {
        (void)character_at(at, end, &bytes);
        count++;
    }
    return count;
}

// ---- text of a scene

typedef struct Decoder {
    Eval *ev;
    Span span;
    TextBuffer out;
    bool has_blanks; // in the place of what is no ASCII
} Decoder;

bool characters_are_utf8(const Eval *ev)
{
    return ev->charset == CHARSET_UTF8 || (ev->charset == CHARSET_UNSAID && ev->has_mark);
}

// The length of a character of UTF-8, of any plane; 0: it is none.
static size_t decode_utf8(Decoder *decoder, const char *at, const char *end)
{
    size_t length = utf8_length(at, end), bytes;
    if (length == 0) {
        eval_fault(decoder->ev, DIAG_E0304, decoder->span,
                   "with `charset utf8` a string is UTF-8, and the byte 0x%02X is not", (unsigned)(unsigned char)*at);
    } else {
        text_append_utf8(&decoder->out, length == 4 ? CODE_UNKNOWN : character_at(at, end, &bytes));
    }
    return length;
}

// One byte or character that stands in the text itself.
static size_t decode_raw(Decoder *decoder, const char *at, const char *end)
{
    Eval *ev = decoder->ev;
    unsigned byte = (unsigned char)*at;
    if (byte < 0x80) {
        text_append_char(&decoder->out, *at);
        return 1;
    }
    if (characters_are_utf8(ev)) {
        return decode_utf8(decoder, at, end);
    }
    if (ev->charset == CHARSET_SYS) {
        eval_fault(ev, DIAG_E0304, decoder->span, "with `charset sys` a string holds ASCII only");
        return 0;
    }
    decoder->has_blanks = decoder->has_blanks || ev->version >= 3.5;
    text_append_utf8(&decoder->out, ev->version < 3.5 ? byte : ' ');
    return 1;
}

static bool decode(Decoder *decoder, const char *at, const char *end)
{
    while (at < end) {
        size_t bytes = 0;
        if (*at != TEXT_MARK || at + 1 == end) {
            bytes = decode_raw(decoder, at, end);
        } else if (at[1] == TEXT_MARK) {
            bytes = decode_raw(decoder, at, end);
            bytes += bytes > 0 ? 1 : 0;
        } else {
            text_append_utf8(&decoder->out, character_at(at + 1, end, &bytes));
            bytes++;
        }
        if (bytes == 0) {
            return false;
        }
        at += bytes;
    }
    return true;
}

bool characters_of_text(Eval *ev, const char *text, size_t length, Span span, Value *value)
{
    *value = (Value){.kind = VALUE_STRING, .text = text, .length = length};
    size_t plain = 0;
    while (plain < length && (unsigned char)text[plain] < 0x80) {
        plain++;
    }
    if (plain == length) {
        return true;
    }
    Decoder decoder = {.ev = ev, .span = span};
    text_init(&decoder.out);
    bool fine = decode(&decoder, text, text + length);
    if (fine && decoder.has_blanks) {
        eval_warn(ev, DIAG_W0307, span, "what is no ASCII in this string has become blanks");
    }
    if (fine) {
        value->length = decoder.out.length;
        value->text = decoder.out.failed ? NULL : arena_copy_text(&ev->scratch, text_get(&decoder.out), value->length);
        fine = value->text != NULL || eval_no_memory(ev, span);
    }
    text_fini(&decoder.out);
    return fine;
}
