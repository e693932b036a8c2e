// Sets the pieces of a text in lines.
//
// Walks the pieces once. A block or a directive with a body is a frame: set in one line if the source began it so and
// it fits, else with its items on lines of their own. Decides on nothing but the pieces, so that its own output, read
// again, is laid out the same.
//
// SPDX-License-Identifier: MIT
#include "format/format.h"

#include "ast/words.h"
#include "format/pieces.h"

enum {
    LINE_COLUMNS = 100,
    LEVEL_COLUMNS = 4,
    LEVEL_MAX = 25, // deeper lines begin no farther right, so that no text grows with the square of its depth
};

typedef struct Frame {
    PieceRole role;   // PIECE_OPENS_BLOCK, PIECE_OPENS_GROUP, PIECE_CASE; PIECE_PLAIN of the whole text
    unsigned level;   // of the line that begins it
    unsigned content; // of its items
    uint32_t depth;   // of pieces that stand directly in it
    bool is_flat;
    unsigned closes;  // of a directive: braces in the present branch whose other ends are before it
} Frame;

typedef struct Layout {
    const Pieces *pieces;
    TextBuffer *out;
    ARRAY(Frame) frames;
    size_t column;
    unsigned level;   // of the present line
    bool at_start;    // nothing stands in the present line
    bool after_head;  // the line before begins a block or body: no empty line follows
    bool must_break;  // a comment wants the next piece on a new line
    bool is_led;      // the present line begins with comments and has nothing else
    bool no_memory;
} Layout;

static Frame *innermost(Layout *layout)
{
    return &layout->frames.items[layout->frames.count - 1];
}

static const Piece *piece_at(const Layout *layout, size_t at)
{
    return &layout->pieces->pieces.items[at];
}

// ---- Writing.

static void break_line(Layout *layout, unsigned level, bool wants_empty)
{
    bool is_first = layout->out->length == 0;
    if (!layout->at_start) {
        text_append_char(layout->out, '\n');
        layout->at_start = true;
    }
    if (wants_empty && !layout->after_head && !is_first) {
        text_append_char(layout->out, '\n');
    }
    layout->level = level;
}

static void begin_word(Layout *layout, bool space)
{
    if (layout->at_start) {
        unsigned level = layout->level < LEVEL_MAX ? layout->level : LEVEL_MAX;
        for (layout->column = 0; layout->column < (size_t)level * LEVEL_COLUMNS; layout->column++) {
            text_append_char(layout->out, ' ');
        }
        layout->at_start = false;
        layout->after_head = false;
    } else if (space) {
        text_append_char(layout->out, ' ');
        layout->column++;
    }
}

// Moves the column over a stretch of the source, in which lines may end.
static void pass(Layout *layout, size_t begin, size_t end)
{
    for (size_t i = end; i > begin; i--) {
        if (layout->pieces->text[i - 1] == '\n') {
            layout->column = 0;
            begin = i;
        }
    }
    layout->column += pieces_columns(layout->pieces, begin, end);
}

static void write_comment_text(Layout *layout, const Comment *comment)
{
    const char *text = layout->pieces->text;
    for (size_t i = comment->begin; i < comment->end; i++) {
        bool is_line_end = text[i] == '\r' && i + 1 < comment->end && text[i + 1] == '\n';
        if (!is_line_end) {
            text_append_char(layout->out, text[i]);
        }
    }
    pass(layout, comment->begin, comment->end);
}

// ---- Levels.

// Of a line that is begun within an item.
static unsigned continued(Layout *layout)
{
    return innermost(layout)->content + 1;
}

static bool is_end(const Piece *piece)
{
    return piece->kind == GRAMMAR_TOKEN_END;
}

// Of a comment on a line of its own before the piece.
static unsigned comment_level(Layout *layout, const Piece *piece)
{
    const Frame *frame = innermost(layout);
    switch ((PieceRole)piece->role) {
    case PIECE_CASE:
        return frame->role == PIECE_CASE ? frame->level : frame->content;
    case PIECE_CLOSES_BLOCK:
    case PIECE_CLOSES_GROUP:
    case PIECE_MIDDLE:
    case PIECE_OPENS_BLOCK:
        return frame->content;
    default:
        return piece->is_item || is_end(piece) ? frame->content : continued(layout);
    }
}

static void write_comments(Layout *layout, const Piece *piece)
{
    layout->must_break = layout->is_led = false;
    for (uint32_t i = 0; i < piece->comment_count; i++) {
        const Comment *comment = &layout->pieces->comments.items[piece->comment + i];
        bool is_own = comment->newlines > 0 || layout->out->length == 0;
        layout->is_led |= is_own;
        if (is_own) {
            break_line(layout, comment_level(layout, piece), comment->newlines > 1);
        }
        begin_word(layout, true);
        write_comment_text(layout, comment);
        layout->must_break = comment->is_line || (piece->newlines > 0 && is_own);
    }
}

// ---- Frames.

static size_t tail_width(const Layout *layout, size_t last)
{
    size_t next = last + 1;
    while (next < layout->pieces->pieces.count && !piece_at(layout, next)->space && !piece_at(layout, next)->is_item &&
           piece_at(layout, next)->comment_count == 0 && !is_end(piece_at(layout, next))) {
        next++;
    }
    return piece_at(layout, next - 1)->width - piece_at(layout, last)->width;
}

// Whether what the piece opens stands in one line when the piece itself ends at `column`.
static bool fits(Layout *layout, size_t at, size_t column)
{
    const Piece *piece = piece_at(layout, at);
    if (innermost(layout)->is_flat) {
        return true;
    }
    if (piece->partner == NO_PIECE || piece->partner < at || piece_at(layout, piece->partner)->forced > piece->forced) {
        return false;
    }
    size_t width = piece_at(layout, piece->partner)->width - piece->width;
    return column + width <= LINE_COLUMNS && column + width + tail_width(layout, piece->partner) <= LINE_COLUMNS;
}

static void push_frame(Layout *layout, size_t at)
{
    const Piece *piece = piece_at(layout, at);
    Frame frame = {
        .role = (PieceRole)piece->role,
        .level = layout->level,
        .content = layout->level + 1,
        .depth = piece->depth + (piece->role != PIECE_CASE),
        .is_flat = fits(layout, at, layout->column),
    };
    layout->no_memory |= !ARRAY_PUSH(&layout->frames, frame);
}

static size_t find_group(const Layout *layout)
{
    size_t i = layout->frames.count - 1;
    while (i > 0 && layout->frames.items[i].role != PIECE_OPENS_GROUP) {
        i--;
    }
    return i; // 0, the whole text, when there is none
}

static void pop_block(Layout *layout)
{
    Frame *frame = innermost(layout);
    if (frame->role == PIECE_OPENS_BLOCK) {
        layout->frames.count--;
    } else if (frame->role != PIECE_PLAIN) {
        layout->frames.items[find_group(layout)].closes++;
    }
}

// Blocks that a branch opened continue behind the directive, one level less deep; those that it closed are gone.
static void pop_group(Layout *layout, size_t group)
{
    if (group == 0) {
        return;
    }
    size_t kept = group;
    for (unsigned i = layout->frames.items[group].closes;
         i > 0 && layout->frames.items[kept - 1].role == PIECE_OPENS_BLOCK; i--) {
        kept--;
    }
    for (size_t i = group + 1; i < layout->frames.count; i++) {
        Frame frame = layout->frames.items[i];
        if (frame.role == PIECE_OPENS_BLOCK) {
            frame.level--;
            frame.content--;
            layout->frames.items[kept++] = frame;
        }
    }
    layout->frames.count = kept;
}

// ---- Line breaks.

// Whether the stretch up to the next place where the line might be broken is too long for the line.
static bool overflows(const Layout *layout, size_t at)
{
    const Piece *piece = piece_at(layout, at), *last = piece;
    size_t room = LINE_COLUMNS - (layout->column < LINE_COLUMNS ? layout->column : LINE_COLUMNS);
    size_t before = at > 0 ? piece_at(layout, at - 1)->width : 0;
    for (size_t next = at + 1; last->width - before <= room; next++) {
        const Piece *piece_next = piece_at(layout, next);
        if (is_end(piece_next) || piece_next->is_item || last->role == PIECE_OPENS_BLOCK ||
            piece_next->forced > last->forced || (piece_next->is_break && piece_next->depth <= piece->depth) ||
            (piece_next->depth < piece->depth && piece_next->space)) {
            return false;
        }
        last = piece_next;
    }
    return true;
}

// In the frame's own list, not in brackets: lines are broken after commas where the source breaks them.
static bool follows_comma(Layout *layout, size_t at)
{
    return at > 0 && piece_mark(layout->pieces, piece_at(layout, at - 1)) == ',' &&
           innermost(layout)->role == PIECE_OPENS_BLOCK && piece_at(layout, at)->depth == innermost(layout)->depth;
}

static bool wants_line(Layout *layout, size_t at, unsigned *level)
{
    const Piece *piece = piece_at(layout, at);
    const Frame *frame = innermost(layout);
    *level = piece->is_item || piece->role == PIECE_OPENS_BLOCK || follows_comma(layout, at) ? frame->content
                                                                                             : continued(layout);
    if (layout->must_break) {
        return true;
    }
    if (frame->is_flat) {
        return false;
    }
    if (piece->is_item || (follows_comma(layout, at) && piece->newlines > 0)) {
        return true;
    }
    if (piece->role == PIECE_OPENS_GROUP) {
        size_t width = piece->width - (at > 0 ? piece_at(layout, at - 1)->width : 0);
        return !fits(layout, at, layout->column + width);
    }
    return piece->is_break && !layout->at_start && overflows(layout, at);
}

// Of what ends a frame or a part of one: the frame's own line, or none if it is flat.
static bool wants_end_line(Layout *layout, const Piece *piece, unsigned *level)
{
    const Frame *frame = innermost(layout);
    if (piece->role == PIECE_CLOSES_BLOCK) {
        *level = frame->role == PIECE_OPENS_BLOCK ? frame->level : frame->content;
    } else {
        size_t group = find_group(layout);
        if (piece->role != PIECE_CLOSES_GROUP && group > 0) {
            layout->frames.count = group + 1; // a case is over, and what is torn
            layout->frames.items[group].closes = 0;
        }
        frame = group > 0 ? &layout->frames.items[group] : innermost(layout);
        *level = piece->role == PIECE_CASE || group == 0 ? frame->content : frame->level;
    }
    return layout->must_break || !frame->is_flat;
}

static void set_piece(Layout *layout, size_t at)
{
    const Piece *piece = piece_at(layout, at);
    write_comments(layout, piece);
    bool is_closer = piece->role == PIECE_CLOSES_BLOCK || piece->role == PIECE_CLOSES_GROUP ||
                     piece->role == PIECE_MIDDLE || piece->role == PIECE_CASE;
    unsigned level = 0;
    if (is_closer ? wants_end_line(layout, piece, &level) : wants_line(layout, at, &level)) {
        bool is_separate = piece->is_item || follows_comma(layout, at) || piece->role == PIECE_CASE;
        bool wants_empty = piece->newlines > 1 && is_separate && (!is_closer || piece->role == PIECE_CASE);
        // A comment without a line end before the piece stays in its line.
        if (!layout->is_led || layout->must_break || piece->newlines > 0) {
            break_line(layout, level, wants_empty);
        }
    }
    begin_word(layout, piece->space || piece->comment_count > 0);
    size_t from = layout->out->length;
    piece_write(layout->pieces, piece, layout->out);
    if (piece->kind == GRAMMAR_TOKEN_DIRECTIVE) {
        layout->column += layout->out->length - from;
    } else {
        pass(layout, piece->begin, piece->end);
    }
}

static void set_frames(Layout *layout, size_t at)
{
    const Piece *piece = piece_at(layout, at);
    switch ((PieceRole)piece->role) {
    case PIECE_OPENS_BLOCK:
    case PIECE_OPENS_GROUP:
    case PIECE_CASE:
        push_frame(layout, at);
        break;
    case PIECE_CLOSES_BLOCK:
        pop_block(layout);
        break;
    case PIECE_CLOSES_GROUP:
        pop_group(layout, find_group(layout));
        break;
    default:
        break;
    }
    layout->after_head = piece_at(layout, at + 1)->after_head;
}

static bool set_lines(const Pieces *pieces, TextBuffer *out)
{
    Layout layout = {.pieces = pieces, .out = out, .at_start = true};
    Frame whole = {.role = PIECE_PLAIN};
    layout.no_memory = !ARRAY_PUSH(&layout.frames, whole);
    for (size_t i = 0; !layout.no_memory && !pieces_are_cancelled(pieces); i++) {
        const Piece *piece = piece_at(&layout, i);
        if (is_end(piece)) {
            write_comments(&layout, piece);
            break;
        }
        set_piece(&layout, i);
        set_frames(&layout, i);
    }
    if (!layout.no_memory && !layout.at_start) {
        text_append_char(out, '\n');
    }
    bool fine = !layout.no_memory && !out->failed && !pieces_are_cancelled(pieces);
    ARRAY_FREE(&layout.frames);
    return fine;
}

bool format_source(const GrammarContext *context, Source *source, const char *text, size_t length,
                   const atomic_bool *cancel, TextBuffer *out)
{
    Pieces pieces = {.text = text, .length = length, .cancel = cancel};
    bool clean = pieces_read(&pieces, context, source);
    bool fine = clean && pieces_find_roles(&pieces) && set_lines(&pieces, out);
    if (!fine && !pieces_are_cancelled(&pieces) && (clean || pieces.no_memory)) {
        diag_report(context->diags, DIAG_E0602, SPAN_NONE, "out of memory laying out the text");
    }
    pieces_free(&pieces);
    return fine;
}
