// The window: the part of a text that is being read, for all who read it.
//
// Turns a source, or a text in memory, into one run of bytes from the reader's offset on. Whoever can read plain text at
// once (quick.c, template.c) reads it there and moves the offset; the scanner gets copies of short pieces of it, so that
// it can be sent to another place without knowing of its insides. Owns the bytes.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/magic.h"
#include "grammar/lexer.h"
#include "grammar/parser.h"

enum {
    BLOCK = 256 * 1024 - 1,    // bytes that are read at a time
    PIECE_LEAST = 128,         // of the scanner's pieces: it may be sent elsewhere soon …
    PIECE_MOST = 16 * 1024,    // … or not
    LONGEST_TOKEN = 64 * 1024, // bytes of one name or number; the text is given up beyond
};

// No text has them.
static const bool strange[256] = {
    ['\0' ... '\b'] = true, [0x0e ... 0x19] = true, [0x1b ... 0x1f] = true, [0x7f] = true,
};

// A text has no zeros and no control characters; the first block tells a picture or a program from a scene. Of such a
// file no line is shown.
static bool block_is_text(GrammarState *state, const char *block, size_t length)
{
    Span whole = SPAN_WHOLE(state->offset);
    const Magic *magic = magic_of_text(block, length);
    size_t i = 0;
    while (magic == NULL && i < length && !strange[(unsigned char)block[i]]) {
        i++;
    }
    if (magic == NULL && i < length) {
        magic = magic_of_bytes(block, length);
        if (magic == NULL) {
            grammar_fault(state, DIAG_E0108, whole, "byte %zu is 0x%02x: this is not the text of a scene", i + 1,
                          (unsigned char)block[i]);
            return false;
        }
    }
    size_t kept = state->context->diags->count;
    if (magic != NULL) {
        grammar_fault(state, DIAG_E0108, whole, "this is %s, not a scene", magic->kind);
    }
    if (state->context->diags->count > kept && magic->help != NULL) {
        diag_suggest(state->context->diags, "%s", magic->help);
    }
    return magic == NULL;
}

// Reads on behind what is there; -1: errno says why not.
static ptrdiff_t read_more(GrammarState *state, char *buffer)
{
    if (state->source != NULL) {
        return source_read(state->source, buffer, BLOCK);
    }
    size_t length = state->text_length < BLOCK ? state->text_length : BLOCK;
    memcpy(buffer, state->text, length);
    state->text += length;
    state->text_length -= length;
    return (ptrdiff_t)length;
}

// One more block; what stands before `offset` is dropped.
static void fill(GrammarState *state)
{
    Window *window = &state->window;
    size_t passed = window->text != NULL ? (size_t)(state->offset - window->begin) : 0;
    size_t kept = window->length - passed, wanted = kept + BLOCK + WINDOW_PADDING;
    if (passed > 0) {
        memmove(window->text, window->text + passed, kept);
    }
    if (wanted > window->room) {
        char *text = realloc(window->text, wanted);
        if (text == NULL) {
            longjmp(state->escape, 1);
        }
        window->text = text;
        window->room = wanted;
    }
    ptrdiff_t more = read_more(state, window->text + kept);
    window->begin = state->offset;
    window->length = kept + (more > 0 ? (size_t)more : 0);
    window->is_last = more <= 0;
    window->fault = more < 0 ? errno : 0;
    memset(window->text + window->length, 0, WINDOW_PADDING);
    if (state->source != NULL && !window->is_checked && more >= 0) {
        window->is_checked = true;
        state->ended = !block_is_text(state, window->text, window->length) || state->ended;
    }
}

const char *grammar_window(GrammarState *state, const char **end)
{
    Window *window = &state->window;
    if (RT_UNLIKELY(window->begin + window->length < state->offset + WINDOW_AHEAD && !window->is_last)) {
        fill(state);
    }
    *end = window->text + window->length;
    return window->text + (state->offset - window->begin);
}

void grammar_window_rewind(GrammarState *state)
{
    state->window.given = state->offset;
    state->window.piece = PIECE_LEAST;
}

void grammar_window_restart(GrammarState *state)
{
    Window *window = &state->window;
    window->begin = state->offset;
    window->length = 0;
    window->is_last = false;
    grammar_window_rewind(state);
}

void grammar_scan_seek(GrammarState *state, uint64_t offset)
{
    source_seek(state->source, offset - source_base(state->source));
    state->offset = offset;
    state->held_count = 0;
    state->has_moved = true;
    grammar_window_restart(state);
}

static void report_unreadable_source(GrammarState *state)
{
    if (state->window.fault != ECANCELED) {
        grammar_fault(state, DIAG_E0502, (Span){state->offset, state->offset}, "cannot read any further: %s",
                      strerror(state->window.fault));
    }
    state->faulty = state->ended = true;
}

size_t grammar_window_give(GrammarState *state, char *buffer, size_t size, size_t pending)
{
    Window *window = &state->window;
    if (state->ended) {
        return 0;
    }
    if (pending > LONGEST_TOKEN) {
        state->ended = true; // the scanner reports it
        return 0;
    }
    if (window->given == window->begin + window->length && !window->is_last) {
        fill(state);
    }
    size_t left = (size_t)(window->begin + window->length - window->given);
    if (left == 0 && window->fault != 0) {
        report_unreadable_source(state);
    }
    size_t length = left < window->piece ? left : window->piece;
    length = state->ended ? 0 : length < size ? length : size;
    memcpy(buffer, window->text + (window->given - window->begin), length);
    window->given += length;
    window->piece = window->piece < PIECE_MOST ? 2 * window->piece : PIECE_MOST;
    return length;
}

// ---- those who read it at once

bool grammar_scan_quick(GrammarState *state, Token *token)
{
    const char *end, *at = grammar_window(state, &end);
    bool is_read = !state->ended && grammar_quick_read(state, at, end, token) != NULL;
    state->has_moved = state->has_moved || is_read;
    return is_read;
}

void grammar_scan_apart(GrammarState *state)
{
    Token *token = &state->current;
    if (token->kind != TOKEN_VECTOR && token->kind != TOKEN_ITEMS) {
        return;
    }
    token->kind = token->kind == TOKEN_VECTOR ? '<' : '{';
    token->symbol = SYMBOL_NONE;
    token->span.end = state->offset = token->span.begin + 1;
    state->last_read = token->kind;
    state->has_moved = true;
}
