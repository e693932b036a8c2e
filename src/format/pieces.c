// Cuts a text into pieces: each token, and the comments and line ends that stand before it.
//
// The scanner says where the tokens are; what lies between them is read here. Owns the two arrays. Knows nothing of
// what belongs together.
//
// SPDX-License-Identifier: MIT
#include "format/pieces.h"

#include <string.h>

// Between tokens.
typedef struct Gap {
    size_t at;
    unsigned newlines; // since the last token or comment
} Gap;

typedef struct Cutter {
    Pieces *pieces;
    size_t end; // of the token before
} Cutter;

static uint8_t at_most_two(unsigned newlines)
{
    return (uint8_t)(newlines > 2 ? 2 : newlines);
}

static size_t line_end(const Pieces *pieces, size_t at, size_t end)
{
    const char *found = memchr(pieces->text + at, '\n', end - at);
    return found ? (size_t)(found - pieces->text) : end;
}

static size_t trimmed(const Pieces *pieces, size_t begin, size_t end)
{
    while (end > begin && strchr(" \t\r\f\v\x1a", pieces->text[end - 1])) {
        end--;
    }
    return end;
}

static size_t block_end(const Pieces *pieces, size_t at, size_t end)
{
    const char *text = pieces->text;
    unsigned depth = 1;
    for (at += 2; at < end && depth > 0; at++) {
        if (at + 1 < end && text[at] == '/' && text[at + 1] == '*') {
            depth++;
            at++;
        } else if (at + 1 < end && text[at] == '*' && text[at + 1] == '/') {
            depth--;
            at++;
        }
    }
    return at;
}

static void add_comment(Pieces *pieces, Gap *gap, size_t end)
{
    bool is_line = pieces->text[gap->at + 1] == '/';
    Comment comment = {gap->at, is_line ? trimmed(pieces, gap->at, end) : end, is_line, at_most_two(gap->newlines)};
    pieces->no_memory |= !ARRAY_PUSH(&pieces->comments, comment);
    *gap = (Gap){end, 0};
}

// Comments and line ends up to `end`.
static void read_gap(Pieces *pieces, Gap *gap, size_t end)
{
    const char *text = pieces->text;
    while (gap->at < end) {
        char c = text[gap->at], next = gap->at + 1 < end ? text[gap->at + 1] : '\0';
        if (c == '/' && next == '/') {
            add_comment(pieces, gap, line_end(pieces, gap->at, end));
        } else if (c == '/' && next == '*') {
            add_comment(pieces, gap, block_end(pieces, gap->at, end));
        } else {
            gap->newlines += c == '\n' || (c == '\r' && next != '\n');
            gap->at++;
        }
    }
}

static size_t word_begin(const Pieces *pieces, size_t end)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz";
    while (end > 0 && pieces->text[end - 1] != '\0' && strchr(letters, pieces->text[end - 1])) {
        end--;
    }
    return end;
}

static bool add_piece(void *client, const GrammarToken *token)
{
    Cutter *cutter = client;
    Pieces *pieces = cutter->pieces;
    Gap gap = {cutter->end, 0};
    Piece piece = {
        .begin = (size_t)(token->span.begin - pieces->base),
        .end = (size_t)(token->span.end - pieces->base),
        .kind = (uint8_t)token->kind,
        .symbol = token->symbol,
        .comment = pieces->comments.count,
        .partner = NO_PIECE,
    };
    // A `#` and its word may have comments between them; they are set before the directive.
    bool is_directive = token->kind == GRAMMAR_TOKEN_DIRECTIVE;
    read_gap(pieces, &gap, is_directive ? word_begin(pieces, piece.end) : piece.begin);
    piece.comment_count = (uint32_t)(pieces->comments.count - piece.comment);
    piece.newlines = at_most_two(gap.newlines);
    cutter->end = piece.end;
    pieces->no_memory |= !ARRAY_PUSH(&pieces->pieces, piece);
    return !pieces->no_memory && !pieces_are_cancelled(pieces);
}

bool pieces_read(Pieces *pieces, const GrammarContext *context, Source *source)
{
    Cutter cutter = {pieces, 0};
    pieces->base = source_base(source);
    return grammar_scan_all(context, source, add_piece, &cutter);
}

void pieces_free(Pieces *pieces)
{
    ARRAY_FREE(&pieces->pieces);
    ARRAY_FREE(&pieces->comments);
}

char piece_mark(const Pieces *pieces, const Piece *piece)
{
    return piece->kind == GRAMMAR_TOKEN_MARK ? pieces->text[piece->begin] : '\0';
}

size_t pieces_columns(const Pieces *pieces, size_t begin, size_t end)
{
    size_t columns = 0;
    for (; begin < end; begin++) {
        columns += ((unsigned char)pieces->text[begin] & 0xc0) != 0x80; // all but the later bytes of a character
    }
    return columns;
}

void piece_write(const Pieces *pieces, const Piece *piece, TextBuffer *out)
{
    size_t begin = piece->begin;
    if (piece->kind == GRAMMAR_TOKEN_DIRECTIVE && pieces->text[begin] == '#') {
        text_append_char(out, '#');
        begin = word_begin(pieces, piece->end);
    }
    text_append_n(out, pieces->text + begin, piece->end - begin);
}
