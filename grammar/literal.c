// Literal spheres: statements of nothing but numbers, read without tokens, a parser or a tree.
//
// Turns `sphere { <n, n, n>, n … }` at the top level of a file into calls of the evaluator's `literal`, as long as what
// follows the radius is text that was seen before: a statement that is like none before is parsed like any other, and
// when the evaluator says what it has become, its text is kept as a pattern, with gaps where the numbers of its
// pigment and of its transforms stand. All that is not sure to be read alike is left to the scanner.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "grammar/literal.h"
#include "base/plain.h"

enum {
    MISSES_MOST = 64,     // so many texts in a row that no statement repeats: from then on few are kept
};

// `count` numbers with commas between them and blanks around.
static const char *read_numbers(const char *at, const char *end, unsigned count, double *numbers)
{
    for (unsigned i = 0; i < count; i++) {
        if (i > 0) {
            if (*at != ',') {
                return NULL;
            }
            at++;
        }
        at = plain_read_number(plain_skip_blanks(at), end, &numbers[i]);
        if (at == NULL) {
            return NULL;
        }
        at = plain_skip_blanks(at);
    }
    return at;
}

// `sphere { <n, n, n>, n`, or one number for all three; NULL: something else.
static const char *read_head(const char *at, const char *end, GrammarLiteral *literal)
{
    static const char word[] = "sphere";
    if ((size_t)(end - at) < sizeof word || memcmp(at, word, sizeof word - 1) != 0) {
        return NULL;
    }
    at = plain_skip_blanks(at + sizeof word - 1);
    if (*at != '{') {
        return NULL;
    }
    at = plain_skip_blanks(at + 1);
    if (*at == '<') {
        at = read_numbers(at + 1, end, 3, literal->centre);
        at = at != NULL && *at == '>' ? plain_skip_blanks(at + 1) : NULL;
    } else {
        at = read_numbers(at, end, 1, literal->centre);
        literal->centre[1] = literal->centre[2] = literal->centre[0];
    }
    return at != NULL && *at == ',' ? plain_read_number(plain_skip_blanks(at + 1), end, &literal->radius) : NULL;
}

// ---- patterns

static bool is_colour(Symbol word)
{
    return word == W_rgb || word == W_rgbf || word == W_rgbt || word == W_rgbft;
}

static bool is_move(Symbol word)
{
    return word == W_translate || word == W_rotate || word == W_scale || word == W_matrix;
}

// The numbers of a pigment, put in the order red, green, blue, filter, transmit.
static void set_colour(double *colour, Word word, GrammarLiteral *literal)
{
    if (word == W_rgbt) {
        colour[4] = colour[3];
        colour[3] = 0.0;
    }
    literal->colours = word == W_rgb ? 3 : 5;
    for (unsigned i = 0; i < literal->colours; i++) {
        literal->kind.colour[i] = (float)colour[i];
    }
}

static const char *read_part(const LiteralPart *part, const char *at, const char *end, GrammarLiteral *literal,
                             GrammarMoves *moves)
{
    if (is_colour(part->word)) {
        double colour[5] = {0};
        at = read_numbers(at, end, part->count, colour);
        set_colour(colour, part->word, literal);
        return at;
    }
    GrammarMove *move = &moves->items[moves->count++];
    move->word = part->word;
    move->count = part->count;
    return part->count > 1 ? read_numbers(at, end, part->count, move->numbers)
                           : plain_read_number(at, end, move->numbers);
}

static const char *match(const LiteralPattern *pattern, const char *at, const char *end, GrammarLiteral *literal,
                         GrammarMoves *moves)
{
    const char *text = pattern->text;
    literal->kind = pattern->kind;
    literal->colours = 0;
    moves->count = 0;
    for (unsigned i = 0; i < pattern->part_count; i++) {
        const LiteralPart *part = &pattern->parts[i];
        if ((size_t)(end - at) <= part->before || memcmp(at, text, part->before) != 0) {
            return NULL;
        }
        text += part->before;
        at = read_part(part, at + part->before, end, literal, moves);
        if (at == NULL) {
            return NULL;
        }
    }
    return (size_t)(end - at) > pattern->after && memcmp(at, text, pattern->after) == 0 ? at + pattern->after : NULL;
}

// ---- finding the numbers of a text

typedef struct Gap {
    const char *begin, *end; // of the numbers
    Word word;
    unsigned count;
} Gap;

// Those of a text in their order; `colour` is the number of the pigment's, or `count`.
typedef struct Gaps {
    Gap items[LITERAL_PARTS];
    unsigned count, colour;
    bool is_full; // there are more transforms
} Gaps;

// `}`, after `rgb <…>` perhaps with a filter and a transmit before it.
static bool ends_colour(const char *at, const char *end, Word word)
{
    static const char filter[] = "filter ", transmit[] = "transmit ";
    double number;
    for (unsigned i = 0; word == W_rgb && i < 2 && at != NULL && *at != '}'; i++) {
        size_t length = strncmp(at, filter, sizeof filter - 1) == 0       ? sizeof filter - 1
                        : strncmp(at, transmit, sizeof transmit - 1) == 0 ? sizeof transmit - 1
                                                                          : 0;
        at = length > 0 ? plain_read_number(plain_skip_blanks(at + length), end, &number) : NULL;
        at = at != NULL ? plain_skip_blanks(at) : NULL;
    }
    return at != NULL && *at == '}';
}

// The numbers of the only pigment, if they are all that is said of its colour.
static void find_colour(const char *at, const char *end, Symbol word, Gaps *gaps)
{
    unsigned count = word == W_rgb ? 3 : word == W_rgbft ? 5 : 4;
    double numbers[5];
    at = plain_skip_blanks(at);
    if (!is_colour(word) || *at != '<' || gaps->colour < gaps->count) {
        return;
    }
    const char *after = read_numbers(at + 1, end, count, numbers);
    if (after != NULL && *after == '>' && ends_colour(plain_skip_blanks(after + 1), end, (Word)word)) {
        gaps->colour = gaps->count;
        gaps->items[gaps->count++] = (Gap){at + 1, after, (Word)word, count};
    }
}

// Those of a transform, which no operator follows. One that is written otherwise is no gap: the evaluator sees that the
// sphere was moved by more than it is told of.
static void find_move(const char *at, const char *end, Symbol word, Gaps *gaps)
{
    double numbers[12];
    at = plain_skip_blanks(at);
    bool is_vector = *at == '<';
    unsigned count = !is_vector ? 1 : word == W_matrix ? 12 : 3;
    at += is_vector;
    const char *after = is_vector ? read_numbers(at, end, count, numbers) : plain_read_number(at, end, numbers);
    const char *next = after != NULL && (!is_vector || *after == '>') ? plain_skip_blanks(after + is_vector) : NULL;
    if (next == NULL || (*next != '}' && !plain_is_letter(*next))) {
        return;
    }
    gaps->is_full = gaps->is_full || gaps->count - (gaps->colour < gaps->count) == GRAMMAR_MOVES_MOST;
    if (!gaps->is_full) {
        gaps->colour += gaps->colour == gaps->count;
        gaps->items[gaps->count++] = (Gap){at, after, (Word)word, count};
    }
}

static void forget_colour(Gaps *gaps)
{
    if (gaps->colour < gaps->count) {
        gaps->count--;
        memmove(&gaps->items[gaps->colour], &gaps->items[gaps->colour + 1],
                (gaps->count - gaps->colour) * sizeof *gaps->items);
    }
}

// Where the words of a text are known to be words of the language, its braces pair up, and all else is numbers and
// commas: its end, after the brace that closes the sphere.
static const char *survey(const GrammarState *state, const char *at, const char *end, Gaps *gaps)
{
    unsigned depth = 1, pigments = 0;
    bool begins_pigment = false, is_after_number = true; // the radius
    const char *limit = end - at > LITERAL_TEXT_LONGEST ? at + LITERAL_TEXT_LONGEST : end;
    *gaps = (Gaps){0};
    while (at < limit && depth > 0) {
        const char *begin = at;
        if (plain_is_letter(*at)) {
            while (plain_is_letter(*at) || plain_is_digit(*at)) {
                at++;
            }
            Symbol word = intern_find(state->context->names, begin, (size_t)(at - begin));
            if (word == SYMBOL_NONE || word >= WORD_COUNT || word_class(word) == WORD_DIRECTIVE) {
                return NULL;
            }
            pigments += word == W_pigment;
            if (begins_pigment) {
                find_colour(at, end, word, gaps);
            } else if (depth == 1 && is_move(word)) {
                find_move(at, end, word, gaps);
            }
            begins_pigment = word == W_pigment || (begins_pigment && (word == W_color || word == W_colour));
            is_after_number = false;
        } else if (plain_is_digit(*at) || *at == '.' || (*at == '-' && !is_after_number)) {
            double number;
            at = plain_read_number(at, end, &number);
            if (at == NULL) {
                return NULL;
            }
            is_after_number = true;
        } else if (strchr("{}<>, \n\t\r", *at) != NULL && *at != '\0') {
            depth += (*at == '{') - (unsigned)(*at == '}');
            is_after_number = is_after_number && strchr("{<,", *at) == NULL;
            at++;
        } else {
            return NULL;
        }
    }
    if (pigments != 1) {
        forget_colour(gaps);
    }
    return depth == 0 && !gaps->is_full ? at : NULL;
}

static LiteralPattern *new_pattern(const char *text, const char *end, const Gaps *gaps)
{
    LiteralPattern *pattern = malloc(sizeof *pattern);
    char *copy = malloc((size_t)(end - text));
    if (pattern == NULL || copy == NULL) {
        free(pattern);
        free(copy);
        return NULL;
    }
    *pattern = (LiteralPattern){.text = copy, .part_count = gaps->count};
    for (unsigned i = 0; i < gaps->count; i++) {
        const Gap *gap = &gaps->items[i];
        size_t before = (size_t)(gap->begin - text);
        pattern->parts[i] = (LiteralPart){before, gap->word, gap->count};
        pattern->has_moves = pattern->has_moves || is_move(gap->word);
        memcpy(copy, text, before);
        copy += before;
        text = gap->end;
    }
    pattern->after = (size_t)(end - text);
    memcpy(copy, text, pattern->after);
    return pattern;
}

static void pattern_free(LiteralPattern *pattern)
{
    if (pattern != NULL) {
        free(pattern->text);
        free(pattern);
    }
}

void grammar_literals_forget(GrammarState *state)
{
    for (unsigned i = 0; i < LITERAL_PATTERNS; i++) {
        pattern_free(state->literals[i]);
        state->literals[i] = NULL;
    }
    state->learning = NULL;
}

// Keeps the text of a statement that begins here, which is parsed as any other, to see what becomes of it.
static void begin_learning(GrammarState *state, const char *begin, const char *text, const char *end,
                           const GrammarLiteral *literal)
{
    Gaps gaps;
    if (++state->literal_misses > MISSES_MOST && state->literal_misses % MISSES_MOST != 0) {
        return;
    }
    const char *after = survey(state, text, end, &gaps);
    LiteralPattern *pattern = after != NULL ? new_pattern(text, after, &gaps) : NULL;
    GrammarLiteral copy = *literal;
    GrammarMoves moves;
    if (pattern == NULL || match(pattern, text, end, &copy, &moves) != after) {
        pattern_free(pattern);
        return;
    }
    pattern_free(state->literals[LITERAL_PATTERNS - 1]);
    memmove(state->literals + 1, state->literals, (LITERAL_PATTERNS - 1) * sizeof *state->literals);
    state->literals[0] = state->learning = pattern;
    state->learning_end = state->offset + (uint64_t)(after - begin);
    copy.span = (Span){state->offset, state->learning_end};
    const GrammarHooks *hooks = state->context->hooks;
    hooks->literal_watch(hooks->client, &copy, &moves);
}

static void end_learning(GrammarState *state)
{
    const GrammarHooks *hooks = state->context->hooks;
    LiteralPattern *pattern = state->learning;
    state->learning = NULL;
    // Nothing but blanks was read since.
    pattern->is_used = hooks->literal_learn(hooks->client, &pattern->kind) && state->offset == state->learning_end;
}

const char *literal_read(LiteralPattern *const *patterns, const char *at, const char *end, GrammarLiteral *literal,
                         GrammarMoves *moves, unsigned *which, const char **text)
{
    *text = read_head(at, end, literal);
    *which = LITERAL_PATTERNS;
    if (*text == NULL || !(literal->radius > 0.0)) {
        *text = NULL;
        return NULL;
    }
    for (unsigned i = 0; i < LITERAL_PATTERNS && patterns[i] != NULL; i++) {
        const char *after = match(patterns[i], *text, end, literal, moves);
        if (after != NULL) {
            *which = i;
            return after;
        }
    }
    return NULL;
}

void literal_set_previous(GrammarState *state, uint64_t end)
{
    state->previous = (Token){.kind = '}', .span = {end - 1, end}};
    state->last_read = '}';
    state->offset = end;
}

static const LiteralPattern *move_to_front(GrammarState *state, unsigned which)
{
    LiteralPattern *pattern = state->literals[which];
    memmove(state->literals + 1, state->literals, which * sizeof *state->literals);
    return state->literals[0] = pattern;
}

const char *grammar_literals_read(GrammarState *state, const char *at, const char *end)
{
    const GrammarHooks *hooks = state->context->hooks;
    if (state->learning != NULL) {
        end_learning(state);
    }
    if (*hooks->literal_state != state->literal_state) {
        grammar_literals_forget(state);
        state->literal_state = *hooks->literal_state;
    }
    size_t taken = 0;
    while (!state->ended) {
        GrammarLiteral literal;
        GrammarMoves moves;
        unsigned which;
        const char *begin = plain_skip_blanks(at), *text;
        const char *after = literal_read(state->literals, begin, end, &literal, &moves, &which, &text);
        if (text == NULL) {
            break;
        }
        uint64_t offset = state->offset + (uint64_t)(begin - at);
        if (after == NULL) {
            state->offset = offset; // nothing before it but blanks, which are passed over
            begin_learning(state, begin, text, end, &literal);
            at = begin;
            break;
        }
        const LiteralPattern *pattern = move_to_front(state, which);
        if (!pattern->is_used) {
            break;
        }
        state->literal_misses = 0;
        literal.span = (Span){offset, offset + (uint64_t)(after - begin)};
        LiteralResult result = hooks->literal(hooks->client, &literal, &moves);
        if (result == LITERAL_LEFT) {
            break;
        }
        at = after;
        literal_set_previous(state, literal.span.end);
        taken += !pattern->has_moves;
        if (result == LITERAL_STOP) {
            state->client_ended = state->ended = true;
        }
    }
    // Nearly all of a buffer was taken: there are perhaps many more.
    state->many_literals = taken >= LITERALS_MANY && !state->ended && state->learning == NULL &&
                           end - at < LITERAL_STATEMENT_LONGEST;
    return at;
}
