// What each piece is to its neighbours: brackets and their other ends, operators, where statements and items begin,
// where blanks stand, and how wide a stretch is in one line.
//
// Works on tokens alone, so it judges as a reader would: `<` opens a vector unless it can only be a relation. A wrong
// judgement costs looks, never a token. Directives and braces may be torn (`#if (A) union { #else merge { #end`); what
// has no other end of its own keeps partner NO_PIECE and is set over several lines.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "ast/words.h"
#include "format/pieces.h"

// What is open at a piece.
typedef struct Open {
    size_t piece;
    size_t head_of; // of a `(`: the directive whose head it is, or NO_PIECE
    size_t segment; // of a #switch: its present case, or NO_PIECE
    bool has_relations;
    bool is_torn;    // of a directive: a brace in it has its other end elsewhere; of a block: begun in such a directive
    unsigned closes; // of a directive: braces in the present branch whose other ends are before it
} Open;

typedef struct Reader {
    Pieces *pieces;
    ARRAY(Open) open;
    size_t at;    // the present piece
    size_t head;  // the piece that ended the head of a directive last
    size_t fopen; // the last #fopen: its words belong together
} Reader;

static Piece *piece_at(Reader *reader, size_t at)
{
    return &reader->pieces->pieces.items[at];
}

static Piece *before(Reader *reader)
{
    return reader->at > 0 ? piece_at(reader, reader->at - 1) : NULL;
}

static Open *innermost(Reader *reader)
{
    return reader->open.count > 0 ? &reader->open.items[reader->open.count - 1] : NULL;
}

static bool is_mark(const Reader *reader, const Piece *piece, char mark)
{
    return piece && piece->end - piece->begin == 1 && piece_mark(reader->pieces, piece) == mark;
}

static PieceRole open_role(Reader *reader, const Open *open)
{
    return open ? (PieceRole)piece_at(reader, open->piece)->role : PIECE_PLAIN;
}

static WordClass class_of(const Piece *piece)
{
    return piece && piece->kind == GRAMMAR_TOKEN_WORD ? word_class(piece->symbol) : WORD_DIRECTIVE;
}

static bool is_after_head(const Reader *reader)
{
    return reader->at > 0 && reader->head == reader->at - 1;
}

// Whether a value may end with the piece before.
static bool follows_operand(Reader *reader)
{
    const Piece *last = before(reader);
    if (!last || is_after_head(reader)) {
        return false;
    }
    switch ((GrammarTokenKind)last->kind) {
    case GRAMMAR_TOKEN_NUMBER:
    case GRAMMAR_TOKEN_STRING:
        return true;
    case GRAMMAR_TOKEN_WORD:
        return class_of(last) == WORD_IDENTIFIER || class_of(last) == WORD_CONSTANT ||
               (reader->at > 1 && is_mark(reader, piece_at(reader, reader->at - 2), '.'));
    default:
        return last->role == PIECE_CLOSES || last->role == PIECE_CLOSES_BLOCK || last->role == PIECE_CLOSES_GROUP;
    }
}

// ---- Brackets and directives.

static void push(Reader *reader, PieceRole role, bool has_relations)
{
    Open open = {reader->at, NO_PIECE, NO_PIECE, has_relations, false, 0};
    piece_at(reader, reader->at)->role = (uint8_t)role;
    reader->pieces->no_memory |= !ARRAY_PUSH(&reader->open, open);
}

static void join(Reader *reader, size_t first, size_t last)
{
    piece_at(reader, first)->partner = last;
    piece_at(reader, last)->partner = first;
}

static bool is_vector_function(const Piece *piece)
{
    static const Word words[] = {W_vlength, W_vdot, W_vcross, W_vnormalize, W_vrotate, W_vaxis_rotate, W_vturbulence};
    for (size_t i = 0; i < RT_COUNT_OF(words); i++) {
        if (class_of(piece) == WORD_BUILTIN && piece->symbol == (Symbol)words[i]) {
            return true;
        }
    }
    return false;
}

static bool has_head(const Piece *piece)
{
    return piece && piece->kind == GRAMMAR_TOKEN_DIRECTIVE &&
           (piece->role == PIECE_OPENS_GROUP || piece->role == PIECE_MIDDLE || piece->role == PIECE_CASE);
}

static void open_parenthesis(Reader *reader)
{
    const Piece *last = before(reader);
    size_t head = NO_PIECE;
    if (has_head(last)) {
        head = reader->at - 1;
    } else if (reader->at > 1 && class_of(last) == WORD_IDENTIFIER && has_head(piece_at(reader, reader->at - 2)) &&
               piece_at(reader, reader->at - 2)->symbol == W_macro) {
        head = reader->at - 2;
    }
    bool is_call = class_of(last) == WORD_IDENTIFIER || is_vector_function(last);
    push(reader, PIECE_OPENS, !is_call);
    if (!reader->pieces->no_memory) {
        innermost(reader)->head_of = head;
    }
}

static void open_block(Reader *reader)
{
    const Piece *last = before(reader);
    bool is_function = class_of(last) == WORD_FUNCTION;
    if (is_mark(reader, last, ')') && last->partner != NO_PIECE && last->partner > 0) {
        is_function = class_of(piece_at(reader, last->partner - 1)) == WORD_FUNCTION;
    }
    push(reader, PIECE_OPENS_BLOCK, is_function);
}

// Closes the innermost bracket that `mark` opens, and what is left open in it, but nothing beyond a block or directive.
static void close_bracket(Reader *reader, char mark)
{
    piece_at(reader, reader->at)->role = PIECE_CLOSES;
    for (size_t i = reader->open.count; i > 0; i--) {
        Open open = reader->open.items[i - 1];
        if (open_role(reader, &open) != PIECE_OPENS) {
            return;
        }
        if (is_mark(reader, piece_at(reader, open.piece), mark)) {
            join(reader, open.piece, reader->at);
            reader->open.count = i - 1;
            reader->head = open.head_of != NO_PIECE ? reader->at : reader->head;
            return;
        }
    }
}

static void close_block(Reader *reader)
{
    piece_at(reader, reader->at)->role = PIECE_CLOSES_BLOCK;
    while (open_role(reader, innermost(reader)) == PIECE_OPENS) {
        reader->open.count--;
    }
    Open *open = innermost(reader);
    if (open_role(reader, open) == PIECE_OPENS_BLOCK) {
        if (!open->is_torn) {
            join(reader, open->piece, reader->at);
        }
        reader->open.count--;
    } else if (open) {
        open->is_torn = true;
        open->closes++;
    }
}

// The innermost directive that is open, or NULL; torn if something in it is open.
static Open *find_group(Reader *reader)
{
    for (size_t i = reader->open.count; i > 0; i--) {
        Open *open = &reader->open.items[i - 1];
        if (open_role(reader, open) == PIECE_OPENS_GROUP) {
            open->is_torn |= i < reader->open.count;
            return open;
        }
    }
    return NULL;
}

static void end_segment(Reader *reader, Open *group)
{
    if (group->segment != NO_PIECE && !group->is_torn) {
        piece_at(reader, group->segment)->partner = reader->at - 1;
    }
    group->segment = NO_PIECE;
}

static void middle_of_group(Reader *reader, Symbol word)
{
    Open *group = find_group(reader);
    bool is_switch = group && piece_at(reader, group->piece)->symbol == W_switch;
    bool is_case = word == W_case || word == W_range || (word == W_else && is_switch);
    piece_at(reader, reader->at)->role = is_case ? PIECE_CASE : PIECE_MIDDLE;
    if (group) {
        reader->open.count = (size_t)(group - reader->open.items) + 1;
        end_segment(reader, group);
        group->segment = is_case ? reader->at : NO_PIECE;
        group->closes = 0;
    }
    reader->head = word == W_else ? reader->at : reader->head;
}

static void end_of_group(Reader *reader)
{
    Open *group = find_group(reader);
    piece_at(reader, reader->at)->role = PIECE_CLOSES_GROUP;
    if (!group) {
        return;
    }
    end_segment(reader, group);
    if (!group->is_torn) {
        join(reader, group->piece, reader->at);
    }
    // Blocks that a branch has opened stay open behind it; the other brackets do not, nor those that it has closed.
    size_t at = (size_t)(group - reader->open.items), kept = at;
    for (unsigned i = group->closes; i > 0 && kept > 0; i--) {
        kept -= open_role(reader, &reader->open.items[kept - 1]) == PIECE_OPENS_BLOCK;
    }
    for (size_t i = at + 1; i < reader->open.count; i++) {
        if (open_role(reader, &reader->open.items[i]) == PIECE_OPENS_BLOCK) {
            reader->open.items[kept] = reader->open.items[i];
            reader->open.items[kept++].is_torn = true;
        }
    }
    reader->open.count = kept;
}

static void read_directive(Reader *reader)
{
    Piece *piece = piece_at(reader, reader->at);
    switch (piece->symbol) {
    case W_if:
    case W_ifdef:
    case W_ifndef:
    case W_while:
    case W_for:
    case W_switch:
    case W_macro:
        push(reader, PIECE_OPENS_GROUP, false);
        break;
    case W_elseif:
    case W_else:
    case W_case:
    case W_range:
        middle_of_group(reader, piece->symbol);
        break;
    case W_end:
        end_of_group(reader);
        break;
    case W_fopen:
        reader->fopen = reader->at;
        break;
    default:
        break;
    }
}

static void read_mark(Reader *reader)
{
    Piece *piece = piece_at(reader, reader->at);
    char mark = piece->end - piece->begin == 1 ? piece_mark(reader->pieces, piece) : '=';
    Open *open = innermost(reader);
    bool after_operand = follows_operand(reader);
    switch (mark) {
    case '(':
        open_parenthesis(reader);
        break;
    case '[':
        push(reader, PIECE_OPENS, false);
        break;
    case '<':
        if (after_operand && open && open->has_relations) {
            piece->role = PIECE_OPERATOR;
        } else {
            push(reader, PIECE_OPENS, false);
        }
        break;
    case '{':
        open_block(reader);
        break;
    case ')':
    case ']':
        close_bracket(reader, mark == ')' ? '(' : '[');
        break;
    case '>':
        if (open && is_mark(reader, piece_at(reader, open->piece), '<')) {
            close_bracket(reader, '<');
        } else {
            piece->role = PIECE_OPERATOR;
        }
        break;
    case '}':
        close_block(reader);
        break;
    case '!':
        piece->role = PIECE_PREFIX;
        break;
    case '+':
    case '-':
        piece->role = after_operand ? PIECE_OPERATOR : PIECE_PREFIX;
        break;
    default:
        piece->role = strchr(",;.", mark) ? PIECE_PLAIN : PIECE_OPERATOR;
        break;
    }
}

// ---- Where things begin.

// A word that continues with what the word before has begun: `diffuse albedo 0.5`.
static bool continues_word(Symbol symbol)
{
    return symbol == W_albedo || symbol == W_append || symbol == W_df3 || symbol == W_utf8 || symbol == W_sqr;
}

static bool begins_item(Reader *reader, const Piece *piece, bool after_operand)
{
    const Piece *last = before(reader);
    if (!last || piece->after_head) {
        return true;
    }
    bool is_opener = piece->role == PIECE_OPENS || piece->role == PIECE_OPENS_BLOCK || piece->role == PIECE_OPENS_GROUP;
    const Open *open = reader->open.count > is_opener ? &reader->open.items[reader->open.count - 1 - is_opener] : NULL;
    if (piece->is_attached || open_role(reader, open) == PIECE_OPENS) {
        return false;
    }
    if (is_mark(reader, last, ';') || last->role == PIECE_CLOSES_BLOCK || last->role == PIECE_CLOSES_GROUP ||
        (last->kind == GRAMMAR_TOKEN_DIRECTIVE && last->symbol == W_break)) {
        return true;
    }
    WordClass class = class_of(last);
    bool after_flag = class == WORD_PLAIN || class == WORD_TEXTURE;
    if (piece->kind == GRAMMAR_TOKEN_DIRECTIVE) {
        return after_operand || after_flag;
    }
    if (is_mark(reader, piece, '[')) {
        return piece->space && after_operand;
    }
    switch (class_of(piece)) {
    case WORD_IDENTIFIER:
        return after_operand && (reader->fopen == NO_PIECE || reader->at - reader->fopen > 3);
    case WORD_PLAIN:
    case WORD_TEXTURE:
    case WORD_FUNCTION:
        return (after_operand || after_flag) && !continues_word(piece->symbol);
    default:
        return false;
    }
}

static bool is_index(Reader *reader, const Piece *last)
{
    if (is_mark(reader, last, ']')) {
        return last->partner != NO_PIECE && !piece_at(reader, last->partner)->space;
    }
    return class_of(last) == WORD_IDENTIFIER || class_of(last) == WORD_ARRAY;
}

// Whether the two would be read as other tokens without a blank between them.
static bool must_part(const Reader *reader, const Piece *last, const Piece *piece)
{
    const char *text = reader->pieces->text;
    char end = text[last->end - 1], begin = text[piece->begin];
    bool is_word = last->kind == GRAMMAR_TOKEN_WORD || last->kind == GRAMMAR_TOKEN_DIRECTIVE;
    bool meets_letter = piece->kind == GRAMMAR_TOKEN_WORD || piece->kind == GRAMMAR_TOKEN_NUMBER ||
                        (piece->kind == GRAMMAR_TOKEN_DIRECTIVE && begin != '#');
    if (last->kind == GRAMMAR_TOKEN_NUMBER) {
        return meets_letter || begin == '.' || begin == '+' || begin == '-';
    }
    return (is_word && meets_letter) || (end == '.' && piece->kind == GRAMMAR_TOKEN_NUMBER) ||
           (strchr("<>!", end) && begin == '=') || (end == '/' && (begin == '/' || begin == '*'));
}

static bool wants_space(Reader *reader, const Piece *piece)
{
    const Piece *last = before(reader);
    if (!last) {
        return false;
    }
    if (must_part(reader, last, piece)) {
        return true;
    }
    if (last->role == PIECE_OPENS || last->role == PIECE_PREFIX || is_mark(reader, last, '.')) {
        return false;
    }
    if (piece->role == PIECE_CLOSES || is_mark(reader, piece, ',') || is_mark(reader, piece, ';') ||
        is_mark(reader, piece, '.')) {
        return false;
    }
    if (is_mark(reader, piece, '(')) {
        WordClass class = class_of(last);
        return is_after_head(reader) ||
               !(class == WORD_IDENTIFIER || class == WORD_BUILTIN || class == WORD_FUNCTION || last->symbol == W_sqr);
    }
    return !is_mark(reader, piece, '[') || !is_index(reader, last);
}

static bool may_break(Reader *reader, const Piece *piece)
{
    static const char operators[] = "+-&|?:";
    char mark = piece_mark(reader->pieces, piece);
    return is_mark(reader, before(reader), ',') ||
           (piece->role == PIECE_OPERATOR && mark != '\0' && strchr(operators, mark));
}

// ---- Widths and line breaks.

static bool has_newline(const Pieces *pieces, size_t begin, size_t end)
{
    return memchr(pieces->text + begin, '\n', end - begin) != NULL;
}

static void measure(Reader *reader, Piece *piece)
{
    const Pieces *pieces = reader->pieces;
    const Piece *last = before(reader);
    bool breaks = has_newline(pieces, piece->begin, piece->end) && piece->kind == GRAMMAR_TOKEN_STRING;
    bool on_new_line = piece->newlines > 0;
    piece->width = last ? last->width : 0;
    for (uint32_t i = 0; i < piece->comment_count; i++) {
        const Comment *comment = &pieces->comments.items[piece->comment + i];
        breaks |= comment->newlines > 0 || comment->is_line || has_newline(pieces, comment->begin, comment->end);
        on_new_line |= comment->newlines > 0 || comment->is_line;
        piece->width += 1 + pieces_columns(pieces, comment->begin, comment->end);
    }
    breaks |= piece->after_head && on_new_line;
    piece->forced = (last ? last->forced : 0) + breaks;
    piece->width += (piece->space || piece->comment_count > 0) + pieces_columns(pieces, piece->begin, piece->end);
}

static void read_piece(Reader *reader)
{
    Piece *piece = piece_at(reader, reader->at);
    bool after_operand = follows_operand(reader);
    piece->after_head = is_after_head(reader) || (before(reader) && before(reader)->role == PIECE_OPENS_BLOCK);
    size_t depth = reader->open.count;
    if (piece->kind == GRAMMAR_TOKEN_DIRECTIVE) {
        read_directive(reader);
    } else if (piece->kind == GRAMMAR_TOKEN_MARK) {
        read_mark(reader);
    }
    piece->depth = (uint32_t)(reader->open.count < depth ? reader->open.count : depth);
    piece->is_attached = piece->role == PIECE_CLOSES || piece->role == PIECE_OPERATOR || is_mark(reader, piece, ',') ||
                         is_mark(reader, piece, ';') || is_mark(reader, piece, '.');
    piece->space = wants_space(reader, piece);
    piece->is_item = begins_item(reader, piece, after_operand);
    piece->is_break = may_break(reader, piece);
    measure(reader, piece);
}

bool pieces_find_roles(Pieces *pieces)
{
    Reader reader = {.pieces = pieces, .head = NO_PIECE, .fopen = NO_PIECE};
    for (; reader.at < pieces->pieces.count && !pieces->no_memory && !pieces_are_cancelled(pieces); reader.at++) {
        read_piece(&reader);
    }
    ARRAY_FREE(&reader.open);
    return !pieces->no_memory && !pieces_are_cancelled(pieces);
}
