// Long runs of literal spheres, read piece by piece on all threads, if only one.
//
// The source's text is cut into pieces, one for each thread. A piece begins where the first statement `sphere {` stands,
// and each is read as if all before it were fine; then the pieces' spheres are handed to the evaluator in order, up to
// the first that is not what it was taken for. What comes of it is what comes of reading them one by one: where a
// piece before did not end where the next one began, or something else than a literal stands, the rest is read again.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE // memmem
#endif
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "grammar/literal.h"
#include "base/plain.h"

enum {
    PIECE_BYTES = 1 << 20,
    PIECE_BYTES_ALONE = 256 << 10, // of one thread: text and spheres stay in its cache
    READERS_MOST = 64,
    MISSES_FEW = 32,      // so many statements in a row that are of no form: from then on few are taken apart
    STATEMENT_LEAST = 16, // bytes; `sphere{<0,0,0>,1}` has 17
};

typedef struct Piece {
    char *text; // of `bytes` + LITERAL_STATEMENT_LONGEST + 1
    GrammarLiteral *literals; // their spans are within the text
    size_t count, changes;    // see GrammarLiterals
    size_t begin, end; // of the first statement and after the last, in the text
    bool is_read;      // else nothing of it is known
} Piece;

typedef struct Readers {
    const GrammarState *state;
    uint64_t position; // of the first piece in the source
    uint64_t size;     // of the source
    size_t bytes;      // of a piece
    int count;         // pieces that there is room for, or text
    Piece pieces[READERS_MOST];
} Readers;

static const char *find_statement(const char *at, const char *end)
{
    static const char word[] = "sphere";
    for (; (at = memmem(at, (size_t)(end - at), word, sizeof word - 1)) != NULL; at++) {
        if (*plain_skip_blanks(at + sizeof word - 1) == '{') {
            return at;
        }
    }
    return end;
}

// Statements of the form of the last one of their pattern are read by that.
typedef struct Forms {
    LiteralForm items[LITERAL_PATTERNS];
    unsigned last;   // the one used last
    unsigned misses; // statements in a row that were of no such form
} Forms;

// Reads the statement that begins here; NULL: it is no literal that can be taken.
static const char *read_statement(const Readers *readers, Forms *forms, const char *at, const char *end,
                                  GrammarLiteral *literal)
{
    LiteralPattern *const *patterns = readers->state->literals;
    LiteralForm *form = &forms->items[forms->last];
    bool is_due = form->odd > LITERAL_ODD_MOST; // whatever the digits of this one are
    const char *text, *after = literal_form_read(form, at, end, literal);
    if (RT_LIKELY(after != NULL)) {
        forms->misses = 0;
        if (RT_UNLIKELY(is_due)) {
            literal_form_learn(form, form->pattern, at, end);
        }
        return after;
    }
    unsigned which;
    GrammarMoves moves;
    after = literal_read(patterns, at, end, literal, &moves, &which, &text);
    if (after == NULL || !patterns[which]->is_used || patterns[which]->has_moves) {
        return NULL;
    }
    // Where numbers are set in columns no form lasts.
    if (++forms->misses < MISSES_FEW || forms->misses % MISSES_FEW == 0) {
        literal_form_learn(&forms->items[which], patterns[which], at, end);
    }
    forms->last = which;
    return after;
}

// Reads the statements that begin in a piece. Counted apart, since pieces lie side by side and each has its own thread.
static void piece_scan(const Readers *readers, Piece *piece, size_t length, size_t limit, bool is_first)
{
    const char *end = piece->text + length, *at = plain_skip_blanks(piece->text);
    at = is_first ? at : find_statement(at, end);
    Forms forms = {.last = 0};
    GrammarLiteral *literal = piece->literals;
    size_t changes = 0;
    piece->begin = (size_t)(at - piece->text);
    while (at < piece->text + limit) {
        const char *after = read_statement(readers, &forms, at, end, literal);
        if (after == NULL) {
            break;
        }
        literal->span = (Span){(uint64_t)(at - piece->text), (uint64_t)(after - piece->text)};
        bool is_like = literal > piece->literals && memcmp(&literal->kind, &literal[-1].kind, sizeof literal->kind) == 0;
        changes += !is_like;
        literal++;
        at = plain_skip_blanks(after);
    }
    piece->count = (size_t)(literal - piece->literals);
    piece->changes = changes;
    piece->end = (size_t)(at - piece->text);
}

static void readers_work(void *client, size_t begin, size_t end)
{
    Readers *readers = client;
    for (size_t i = begin; i < end; i++) {
        Piece *piece = &readers->pieces[i];
        uint64_t position = readers->position + i * readers->bytes;
        uint64_t left = readers->size - position;
        size_t wanted = readers->bytes + LITERAL_STATEMENT_LONGEST;
        size_t length = left < wanted ? (size_t)left : wanted;
        piece->is_read = source_read_at(readers->state->source, position, piece->text, length);
        if (piece->is_read) {
            piece->text[length] = '\0';
            piece_scan(readers, piece, length, readers->bytes < length ? readers->bytes : length, i == 0);
        }
    }
}

static void readers_free(Readers *readers)
{
    for (int i = 0; i < READERS_MOST; i++) {
        free(readers->pieces[i].text);
        free(readers->pieces[i].literals);
    }
    free(readers);
}

static Readers *readers_new(const GrammarState *state, size_t bytes, int count)
{
    Readers *readers = calloc(1, sizeof *readers);
    if (readers == NULL) {
        return NULL;
    }
    readers->state = state;
    readers->bytes = bytes;
    readers->count = count;
    for (int i = 0; i < readers->count; i++) {
        readers->pieces[i].text = malloc(bytes + LITERAL_STATEMENT_LONGEST + 1);
        readers->pieces[i].literals = malloc((bytes / STATEMENT_LEAST + 2) * sizeof(GrammarLiteral));
        if (readers->pieces[i].text == NULL || readers->pieces[i].literals == NULL) {
            readers_free(readers);
            return NULL;
        }
    }
    return readers;
}

// Hands a piece's spheres over one by one. False when what follows the last one taken is something else.
static bool piece_take(GrammarState *state, const Piece *piece, uint64_t base)
{
    static const GrammarMoves no_moves;
    const GrammarHooks *hooks = state->context->hooks;
    for (size_t i = 0; i < piece->count; i++) {
        GrammarLiteral *literal = &piece->literals[i];
        literal->span.begin += base;
        literal->span.end += base;
        LiteralResult result = hooks->literal(hooks->client, literal, &no_moves);
        if (result == LITERAL_LEFT) {
            return false;
        }
        literal_set_previous(state, literal->span.end);
        if (result == LITERAL_STOP) {
            state->client_ended = state->ended = true;
            return false;
        }
    }
    state->offset = base + piece->end;
    return true;
}

// The pieces up to the first that did not begin where the one before ended; *is_whole: these are all, and the last one
// ended where it was cut.
static int pieces_fitting(const Readers *readers, bool *is_whole)
{
    int count = 0;
    *is_whole = true;
    while (*is_whole && count < readers->count && readers->pieces[count].is_read) {
        const Piece *piece = &readers->pieces[count];
        if (count > 0 && piece->begin + readers->bytes != readers->pieces[count - 1].end) {
            break;
        }
        *is_whole = piece->end >= readers->bytes;
        count++;
    }
    *is_whole = *is_whole && count == readers->count;
    return count;
}

static bool pieces_take_together(GrammarState *state, const Readers *readers, int count, uint64_t start)
{
    const GrammarHooks *hooks = state->context->hooks;
    GrammarLiterals lists[READERS_MOST];
    uint64_t end = 0;
    size_t kept = 0, spheres = 0;
    for (int i = 0; i < count; i++) {
        const Piece *piece = &readers->pieces[i];
        uint64_t base = start + (uint64_t)i * readers->bytes;
        if (piece->count > 0) {
            lists[kept++] = (GrammarLiterals){piece->literals, piece->count, piece->changes, base};
            end = base + piece->literals[piece->count - 1].span.end;
            spheres += piece->count;
        }
    }
    if (kept == 0) {
        return false;
    }
    double left = (double)(source_extent(state->source).end - end);
    if (!hooks->literals(hooks->client, lists, kept, (size_t)((double)spheres * left / (double)(end - start)))) {
        return false;
    }
    literal_set_previous(state, end);
    state->offset = start + (uint64_t)(count - 1) * readers->bytes + readers->pieces[count - 1].end;
    return true;
}

// How many whole pieces are left from a position on, up to `most`.
static int pieces_left(uint64_t size, uint64_t position, size_t bytes, int most)
{
    uint64_t left = (size - position) / bytes;
    return left < (uint64_t)most ? (int)left : most;
}

// One round of all threads. False when there is something else, or too little is left.
static bool read_round(GrammarState *state, Readers *readers)
{
    uint64_t start = state->offset;
    readers->position = start - source_base(state->source);
    readers->count = pieces_left(readers->size, readers->position, readers->bytes, readers->count);
    if (readers->count == 0) {
        return false;
    }
    parallel_share(readers->count, (size_t)readers->count, 1, readers_work, readers);
    bool is_whole;
    int count = pieces_fitting(readers, &is_whole);
    if (count > 0 && pieces_take_together(state, readers, count, start)) {
        return is_whole;
    }
    for (int i = 0; i < count; i++) {
        if (!piece_take(state, &readers->pieces[i], start + (uint64_t)i * readers->bytes)) {
            return false;
        }
    }
    return is_whole;
}

bool grammar_literals_read_many(GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    uint64_t base = source_base(state->source), before = state->offset;
    int threads = hooks->literal_threads < READERS_MOST ? hooks->literal_threads : READERS_MOST;
    threads = threads < 1 ? 1 : threads;
    size_t bytes = hooks->literal_piece > 0 ? hooks->literal_piece : threads > 1 ? PIECE_BYTES : PIECE_BYTES_ALONE;
    uint64_t size = source_extent(state->source).end - base;
    int count = pieces_left(size, before - base, bytes, threads);
    Readers *readers = count == 0 ? NULL : readers_new(state, bytes, count);
    if (readers == NULL) {
        return false; // they are read one by one
    }
    readers->size = size;
    while (read_round(state, readers)) {
    }
    readers_free(readers);
    bool has_moved = state->offset != before;
    if (has_moved) { // else the scanner goes on with what it holds, and the source behind that
        source_seek(state->source, state->offset - base);
    }
    return has_moved;
}
