// Long runs of statements like earlier ones, read piece by piece on all threads, if only one.
//
// The source's text is cut into pieces, one for each thread. A piece begins where the first statement of the word that
// they all begin with stands, and each is read as if all before it were fine, to records of the evaluator; then these are
// handed over in order, up to the first piece that did not begin where the one before ended. What comes of it is what
// comes of reading statements one by one: the rest is read again.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE // memmem
#endif
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "base/plain.h"
#include "grammar/statements.h"

enum {
    PIECE_BYTES = 1 << 20,
    PIECE_BYTES_ALONE = 256 << 10, // of one thread: text and statements stay in its cache
    PIECES_SHARED = 16,            // of such, that each of several processes reads between two talks
    READERS_MOST = 64,
    STATEMENT_LEAST = 16, // bytes; `sphere{<0,0,0>,1}` has 17
    WORD_LONGEST = 32,
};

typedef struct Piece {
    char *text;          // of `bytes` + STATEMENT_LONGEST + WINDOW_PADDING
    char *records;
    size_t count;
    uint64_t begin, end; // of the first statement and where the next one begins
    uint64_t last;       // where the last one ends
    bool is_read;        // else nothing of it is known
} Piece;

typedef struct Readers {
    const GrammarState *state;
    char word[WORD_LONGEST]; // that statements begin with
    size_t word_length;
    uint64_t begin, end; // of the first piece and the source
    size_t bytes;        // of a piece
    int count;           // pieces that there is room for, or text
    int first;           // number of the first, where other processes read those before
    GrammarRound *rounds; // of all processes, where there are others
    Piece pieces[READERS_MOST];
} Readers;

static const char *find_statement(const Readers *readers, const char *at, const char *end)
{
    for (; (at = memmem(at, (size_t)(end - at), readers->word, readers->word_length)) != NULL; at++) {
        if (*plain_skip_blanks(at + readers->word_length) == '{') {
            return at;
        }
    }
    return end;
}

// The templates whose statements are handed over together, each thread its own.
typedef struct Templates {
    Template *items[TEMPLATES_MOST]; // the one used last first
    unsigned count;
} Templates;

static void templates_begin(Templates *templates, const StatementReader *reader)
{
    templates->count = 0;
    for (unsigned i = 0; i < TEMPLATES_MOST && reader->templates[i] != NULL; i++) {
        Template *copy = reader->templates[i]->is_batched ? template_copy(reader->templates[i]) : NULL;
        if (copy != NULL) {
            templates->items[templates->count++] = copy;
        }
    }
}

// Where the statement that begins here ends; NULL: it is no such one.
static const char *templates_match(Templates *templates, const char *at, const char *end, double *numbers)
{
    for (unsigned i = 0; i < templates->count; i++) {
        Template *template = templates->items[i];
        const char *after = template_match(template, at, end, numbers);
        if (RT_LIKELY(after != NULL)) {
            templates->items[i] = templates->items[0];
            templates->items[0] = template;
            return after;
        }
    }
    return NULL;
}

// Reads the statements that begin in a piece of text at an offset, up to `limit`.
static void piece_scan(const Readers *readers, Piece *piece, uint64_t offset, size_t length, size_t limit)
{
    const GrammarHooks *hooks = readers->state->context->hooks;
    const char *end = piece->text + length, *at = plain_skip_blanks(piece->text);
    double numbers[GRAMMAR_SLOTS_MOST];
    Templates templates;
    char *record = piece->records;
    templates_begin(&templates, readers->state->statements);
    at = offset == readers->begin ? at : find_statement(readers, at, end);
    piece->begin = piece->last = offset + (uint64_t)(at - piece->text);
    while (at < piece->text + limit) {
        const char *after = templates_match(&templates, at, end, numbers);
        uint64_t begin = offset + (uint64_t)(at - piece->text);
        if (after == NULL || !hooks->plan_prepare(templates.items[0]->plan, numbers, begin, record)) {
            break;
        }
        record += hooks->plan_record_bytes;
        piece->last = offset + (uint64_t)(after - piece->text);
        at = plain_skip_blanks(after);
    }
    piece->count = (size_t)(record - piece->records) / hooks->plan_record_bytes;
    piece->end = offset + (uint64_t)(at - piece->text);
    for (unsigned i = 0; i < templates.count; i++) {
        free(templates.items[i]);
    }
}

static void readers_work(void *client, size_t begin, size_t end)
{
    Readers *readers = client;
    const Source *source = readers->state->source;
    for (size_t i = begin; i < end; i++) {
        Piece *piece = &readers->pieces[i];
        uint64_t offset = readers->begin + ((uint64_t)readers->first + i) * readers->bytes, left = readers->end - offset;
        size_t wanted = readers->bytes + STATEMENT_LONGEST, length = left < wanted ? (size_t)left : wanted;
        piece->is_read = source_read_at(source, offset - source_base(source), piece->text, length);
        if (piece->is_read) {
            memset(piece->text + length, 0, WINDOW_PADDING);
            piece_scan(readers, piece, offset, length, readers->bytes < length ? readers->bytes : length);
        }
    }
}

static void readers_free(Readers *readers)
{
    for (int i = 0; i < READERS_MOST; i++) {
        free(readers->pieces[i].text);
        free(readers->pieces[i].records);
    }
    free(readers->rounds);
    free(readers);
}

static bool set_word(Readers *readers, const char *text)
{
    while (readers->word_length < WORD_LONGEST && plain_is_in_word(text[readers->word_length])) {
        readers->word[readers->word_length] = text[readers->word_length];
        readers->word_length++;
    }
    return readers->word_length < WORD_LONGEST;
}

static Readers *readers_new(const GrammarState *state, size_t bytes, int count)
{
    Readers *readers = calloc(1, sizeof *readers);
    if (readers == NULL || !set_word(readers, state->statements->templates[0]->text)) {
        free(readers);
        return NULL;
    }
    readers->state = state;
    readers->bytes = bytes;
    readers->count = count;
    readers->end = source_extent(state->source).end;
    bool is_fine = true;
    for (int i = 0; i < readers->count; i++) {
        Piece *piece = &readers->pieces[i];
        piece->text = malloc(bytes + STATEMENT_LONGEST + WINDOW_PADDING);
        piece->records = malloc((bytes / STATEMENT_LEAST + 2) * state->context->hooks->plan_record_bytes);
        is_fine = is_fine && piece->text != NULL && piece->records != NULL;
    }
    if (!is_fine) {
        readers_free(readers);
        return NULL;
    }
    return readers;
}

// The pieces up to the first that did not begin where the one before ended; *is_whole: these are all, and the last one
// ended where it was cut.
static int pieces_fitting(const Readers *readers, bool *is_whole)
{
    int count = 0;
    *is_whole = true;
    while (*is_whole && count < readers->count && readers->pieces[count].is_read) {
        const Piece *piece = &readers->pieces[count];
        if (count > 0 && piece->begin != readers->pieces[count - 1].end) {
            break;
        }
        *is_whole = piece->end >= readers->begin + (uint64_t)(readers->first + count + 1) * readers->bytes;
        count++;
    }
    *is_whole = *is_whole && count == readers->count;
    return count;
}

// Hands a piece's records over. False: they are to be read again.
static bool piece_take(GrammarState *state, const Readers *readers, const Piece *piece)
{
    const GrammarHooks *hooks = state->context->hooks;
    if (piece->count > 0) {
        uint64_t left = readers->end - piece->last, done = piece->last - piece->begin;
        double share = hooks->plan_parts > 1 ? 1.0 / hooks->plan_parts : 1.0;
        size_t more = (size_t)(share * (double)piece->count * (double)left / (double)done);
        if (!hooks->plan_keep(hooks->client, piece->records, piece->count, more)) {
            return false;
        }
        statements_pass(state, '}', piece->last);
        state->offset = piece->end;
    }
    return true;
}

// How many whole pieces are left from a position on, up to `most`.
static int pieces_left(uint64_t end, uint64_t offset, size_t bytes, int most)
{
    uint64_t left = (end - offset) / bytes;
    return left < (uint64_t)most ? (int)left : most;
}

// One round of all threads. False when there is something else, or too little is left.
static bool read_round(GrammarState *state, Readers *readers)
{
    readers->begin = state->offset;
    readers->count = pieces_left(readers->end, readers->begin, readers->bytes, readers->count);
    if (readers->count == 0) {
        return false;
    }
    parallel_share(readers->count, (size_t)readers->count, 1, readers_work, readers);
    bool is_whole;
    int count = pieces_fitting(readers, &is_whole);
    for (int i = 0; i < count; i++) {
        if (!piece_take(state, readers, &readers->pieces[i])) {
            return false;
        }
    }
    return is_whole;
}

// ---- several processes, each with pieces of its own

static GrammarRound round_make(const Readers *readers)
{
    GrammarRound round = {.pieces = (uint64_t)readers->count};
    bool is_whole = false;
    int count = readers->count > 0 ? pieces_fitting(readers, &is_whole) : 0;
    round.is_whole = is_whole;
    for (int i = 0; i < count; i++) {
        const Piece *piece = &readers->pieces[i];
        round.begin = i == 0 ? piece->begin : round.begin;
        round.count += piece->count;
        round.last = piece->count > 0 ? piece->last : round.last;
        round.end = piece->end;
    }
    return round;
}

// Takes this process's statements, in as many pieces as it has reported. False: they cannot be kept.
static bool round_take(GrammarState *state, const Readers *readers)
{
    bool is_whole, is_kept = true;
    int count = pieces_fitting(readers, &is_whole);
    for (int i = 0; is_kept && i < count; i++) {
        is_kept = piece_take(state, readers, &readers->pieces[i]);
    }
    return is_kept;
}

// Continues after what all have read, up to the first whose text did not begin where that of the one before ended. False:
// that is not all, or nothing can be done any more.
static bool rounds_take(GrammarState *state, const Readers *readers)
{
    const GrammarHooks *hooks = state->context->hooks;
    uint64_t end = 0;
    bool is_whole = true;
    for (int part = 0; is_whole && part < hooks->plan_parts && readers->rounds[part].pieces > 0; part++) {
        const GrammarRound *round = &readers->rounds[part];
        if (part > 0 && round->begin != end) {
            return false;
        }
        bool is_taken = part == hooks->plan_part ? round_take(state, readers)
                                                 : hooks->plan_pass(hooks->client, round->count);
        if (!is_taken) {
            state->client_ended = state->ended = true; // the others have read on: nothing can be read again
            return false;
        }
        if (round->count > 0) {
            statements_pass(state, '}', round->last);
        }
        state->offset = end = round->end;
        is_whole = round->is_whole;
    }
    return is_whole;
}

static bool read_shared_round(GrammarState *state, Readers *readers)
{
    const GrammarHooks *hooks = state->context->hooks;
    readers->begin = state->offset;
    int all = pieces_left(readers->end, readers->begin, readers->bytes, PIECES_SHARED * hooks->plan_parts);
    readers->first = PIECES_SHARED * hooks->plan_part;
    readers->count = all - readers->first < PIECES_SHARED ? all - readers->first : PIECES_SHARED;
    readers->count = readers->count < 0 ? 0 : readers->count;
    if (all == 0) {
        return false;
    }
    int threads = hooks->plan_threads < 1 ? 1 : hooks->plan_threads;
    parallel_share(threads, (size_t)readers->count, 1, readers_work, readers);
    GrammarRound own = round_make(readers);
    if (!hooks->plan_exchange(hooks->client, &own, readers->rounds)) {
        state->client_ended = state->ended = true;
        return false;
    }
    return rounds_take(state, readers);
}

// As statements_read_many: all processes come to the same end.
static bool read_shared(GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    uint64_t before = state->offset;
    size_t bytes = hooks->plan_piece > 0 ? hooks->plan_piece : PIECE_BYTES_ALONE;
    if (pieces_left(source_extent(state->source).end, before, bytes, 1) == 0) {
        return false;
    }
    Readers *readers = readers_new(state, bytes, PIECES_SHARED);
    if (readers != NULL) {
        readers->rounds = malloc((size_t)hooks->plan_parts * sizeof *readers->rounds);
    }
    if (readers == NULL || readers->rounds == NULL) {
        state->client_ended = state->ended = true; // the others read on
        readers = readers == NULL ? NULL : (readers_free(readers), NULL);
        return false;
    }
    while (read_shared_round(state, readers)) {
    }
    readers_free(readers);
    if (state->offset == before) {
        return false;
    }
    grammar_scan_seek(state, state->offset);
    return true;
}

bool statements_read_many(GrammarState *state)
{
    if (state->context->hooks->plan_parts > 1) {
        return read_shared(state);
    }
    const GrammarHooks *hooks = state->context->hooks;
    uint64_t before = state->offset;
    int threads = hooks->plan_threads < READERS_MOST ? hooks->plan_threads : READERS_MOST;
    threads = threads < 1 ? 1 : threads;
    size_t bytes = hooks->plan_piece > 0 ? hooks->plan_piece : threads > 1 ? PIECE_BYTES : PIECE_BYTES_ALONE;
    int count = pieces_left(source_extent(state->source).end, before, bytes, threads);
    Readers *readers = count == 0 ? NULL : readers_new(state, bytes, count);
    if (readers == NULL) {
        return false; // they are read one by one
    }
    while (read_round(state, readers)) {
    }
    readers_free(readers);
    if (state->offset == before) {
        return false;
    }
    grammar_scan_seek(state, state->offset);
    return true;
}
