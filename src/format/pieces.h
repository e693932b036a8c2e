// The pieces of a text: its tokens with their comments, what each is to its neighbours, and how wide all is.
//
// Between text and layout: pieces.c cuts the text, roles.c finds out what belongs together, layout.c sets lines.
// Private to src/format.
//
// SPDX-License-Identifier: MIT
#ifndef FORMAT_PIECES_H
#define FORMAT_PIECES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"
#include "base/text.h"
#include "grammar/grammar.h"

typedef struct Comment {
    size_t begin, end; // in the text, without the line end
    bool is_line;      // begins with `//`
    uint8_t newlines;  // before it, since the piece or comment before: 0, 1, or 2 for more
} Comment;

typedef enum PieceRole {
    PIECE_PLAIN,
    PIECE_OPENS,        // ( [ < as brackets
    PIECE_CLOSES,       // ) ] >
    PIECE_OPENS_BLOCK,  // {
    PIECE_CLOSES_BLOCK, // }
    PIECE_OPENS_GROUP,  // a directive that wants an #end
    PIECE_MIDDLE,       // #else, #elseif
    PIECE_CASE,         // #case, #range, and the #else of a #switch
    PIECE_CLOSES_GROUP, // #end
    PIECE_OPERATOR,     // between two operands
    PIECE_PREFIX,       // + - ! before one
} PieceRole;

enum { NO_PIECE = SIZE_MAX };

typedef struct Piece {
    size_t begin, end; // in the text
    size_t comment;    // the first of those before it
    uint32_t comment_count;
    uint8_t newlines; // before it, since the piece or comment before: 0, 1, or 2 for more
    uint8_t kind;     // GrammarTokenKind
    uint8_t role;     // PieceRole
    bool space;       // a blank stands before it in a line
    bool is_item;     // begins a statement, an item of a block, or the body of a directive
    bool after_head;  // the first after a `{`, or after the head of a directive with a body
    bool is_break;    // a long line may be broken before it
    bool is_attached; // belongs to what stands before it: , ; ) . and operators
    Symbol symbol;
    uint32_t depth; // brackets around it, of all kinds
    size_t partner; // of what opens or closes: the other end; of a case: the last piece before the next; or NO_PIECE
    size_t width;   // columns from the text's beginning to its end, if all stood in one line
    size_t forced;  // line breaks up to here that the source asks for
} Piece;

typedef struct Pieces {
    const char *text;
    size_t length;
    uint64_t base;          // the global offset of its first byte
    ARRAY(Piece) pieces;    // the last one is the end of the text
    ARRAY(Comment) comments;
    bool no_memory;
    const atomic_bool *cancel;
} Pieces;

static inline bool pieces_are_cancelled(const Pieces *pieces)
{
    return atomic_load_explicit(pieces->cancel, memory_order_relaxed);
}

// Cuts the text. False when it is faulty, memory ran out or the work was cancelled.
bool pieces_read(Pieces *pieces, const GrammarContext *context, Source *source) RT_MUST_CHECK;
void pieces_free(Pieces *pieces);

// Fills in role, space, items, partners, widths. False when out of memory or cancelled.
bool pieces_find_roles(Pieces *pieces) RT_MUST_CHECK;

// The first character of a mark; '\0' of anything else, and of the marks of two characters `<=`, `>=`, `!=` theirs.
char piece_mark(const Pieces *pieces, const Piece *piece);

// Columns of a stretch of the text: characters, not bytes.
size_t pieces_columns(const Pieces *pieces, size_t begin, size_t end);

// The text of a piece as it is written: of a directive without what stands between `#` and the word.
void piece_write(const Pieces *pieces, const Piece *piece, TextBuffer *out);

#endif
