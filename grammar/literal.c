// Literal spheres: statements of nothing but numbers, read without tokens, a parser or a tree.
//
// Turns `sphere { <n, n, n>, n … }` at the top level of a file into calls of the evaluator's `literal`, as long as what
// follows the radius is text that was seen before: a statement that is like none before is parsed like any other, and
// when the evaluator says what it has become, its text is kept as a pattern, with a gap where the numbers of its
// pigment stand. All that is not sure to be read alike is left to the scanner.
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

// `sphere { <n, n, n>, n`; NULL: something else.
static const char *read_head(const char *at, const char *end, GrammarLiteral *literal)
{
    static const char word[] = "sphere";
    if ((size_t)(end - at) < sizeof word || memcmp(at, word, sizeof word - 1) != 0) {
        return NULL;
    }
    at = plain_skip_blanks(at + sizeof word - 1);
    if (*at != '{' || *(at = plain_skip_blanks(at + 1)) != '<') {
        return NULL;
    }
    at = read_numbers(at + 1, end, 3, literal->centre);
    if (at == NULL || *at != '>' || *(at = plain_skip_blanks(at + 1)) != ',') {
        return NULL;
    }
    return plain_read_number(plain_skip_blanks(at + 1), end, &literal->radius);
}

// ---- patterns

void grammar_literals_forget(GrammarState *state)
{
    for (unsigned i = 0; i < LITERAL_PATTERNS; i++) {
        free(state->literals[i] != NULL ? state->literals[i]->text : NULL);
        free(state->literals[i]);
        state->literals[i] = NULL;
    }
    state->learning = NULL;
}

// The numbers of a pigment, in the order red, green, blue, filter, transmit.
static const char *read_colour(const char *at, const char *end, Word word, GrammarLiteral *literal)
{
    unsigned count = word == W_rgb ? 3 : word == W_rgbft ? 5 : 4;
    double colour[5] = {0};
    at = read_numbers(at, end, count, colour);
    if (word == W_rgbt) {
        colour[4] = colour[3];
        colour[3] = 0.0;
    }
    literal->colours = word == W_rgb ? 3 : 5;
    for (unsigned i = 0; i < literal->colours; i++) {
        literal->kind.colour[i] = (float)colour[i];
    }
    return at;
}

static const char *match(const LiteralPattern *pattern, const char *at, const char *end, GrammarLiteral *literal)
{
    if ((size_t)(end - at) <= pattern->before + pattern->after || memcmp(at, pattern->text, pattern->before) != 0) {
        return NULL;
    }
    at += pattern->before;
    literal->kind = pattern->kind;
    literal->colours = 0;
    if (pattern->word != 0) {
        at = read_colour(at, end, pattern->word, literal);
        if (at == NULL || (size_t)(end - at) <= pattern->after) {
            return NULL;
        }
    }
    return memcmp(at, pattern->text + pattern->before, pattern->after) == 0 ? at + pattern->after : NULL;
}

// Where the words of a text are known to be words of the language, its braces pair up, and all else is numbers and
// commas: its end, after the brace that closes the sphere. *gap: the numbers of the only pigment, if they are all that
// is said of its colour.
typedef struct Gap {
    const char *begin, *end;
    Word word;
} Gap;

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

static void find_gap(const char *at, const char *end, Symbol word, Gap *gap)
{
    GrammarLiteral literal;
    at = plain_skip_blanks(at);
    if ((word != W_rgb && word != W_rgbf && word != W_rgbt && word != W_rgbft) || *at != '<') {
        return;
    }
    const char *after = read_colour(at + 1, end, (Word)word, &literal);
    if (after != NULL && *after == '>' && ends_colour(plain_skip_blanks(after + 1), end, (Word)word)) {
        *gap = (Gap){at + 1, after, (Word)word};
    }
}

static const char *survey(const GrammarState *state, const char *at, const char *end, Gap *gap)
{
    unsigned depth = 1, pigments = 0;
    bool begins_pigment = false, is_after_number = true; // the radius
    const char *limit = end - at > LITERAL_TEXT_LONGEST ? at + LITERAL_TEXT_LONGEST : end;
    *gap = (Gap){0};
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
                find_gap(at, end, word, gap);
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
        *gap = (Gap){0};
    }
    return depth == 0 ? at : NULL;
}

static LiteralPattern *new_pattern(const char *text, const char *end, const Gap *gap)
{
    LiteralPattern *pattern = malloc(sizeof *pattern);
    char *copy = malloc((size_t)(end - text));
    if (pattern == NULL || copy == NULL) {
        free(pattern);
        free(copy);
        return NULL;
    }
    *pattern = (LiteralPattern){.text = copy, .word = gap->word};
    pattern->before = (size_t)((gap->word != 0 ? gap->begin : end) - text);
    pattern->after = (size_t)(gap->word != 0 ? end - gap->end : 0);
    memcpy(copy, text, pattern->before);
    memcpy(copy + pattern->before, end - pattern->after, pattern->after);
    return pattern;
}

// Keeps the text of a statement that begins here, which is parsed as any other, to see what becomes of it.
static void begin_learning(GrammarState *state, const char *begin, const char *text, const char *end,
                           const GrammarLiteral *literal)
{
    Gap gap;
    if (++state->literal_misses > MISSES_MOST && state->literal_misses % MISSES_MOST != 0) {
        return;
    }
    const char *after = survey(state, text, end, &gap);
    LiteralPattern *last = state->literals[LITERAL_PATTERNS - 1];
    LiteralPattern *pattern = after != NULL ? new_pattern(text, after, &gap) : NULL;
    if (pattern == NULL) {
        return;
    }
    if (last != NULL) {
        free(last->text);
        free(last);
    }
    memmove(state->literals + 1, state->literals, (LITERAL_PATTERNS - 1) * sizeof *state->literals);
    state->literals[0] = state->learning = pattern;
    state->learning_end = state->offset + (uint64_t)(after - begin);
    GrammarLiteral copy = *literal;
    copy.span = (Span){state->offset, state->learning_end};
    copy.colours = 0;
    if (gap.word != 0) {
        (void)read_colour(gap.begin, end, gap.word, &copy);
    }
    const GrammarHooks *hooks = state->context->hooks;
    hooks->literal_watch(hooks->client, &copy);
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
                         unsigned *which, const char **text)
{
    *text = read_head(at, end, literal);
    *which = LITERAL_PATTERNS;
    if (*text == NULL || !(literal->radius > 0.0)) {
        *text = NULL;
        return NULL;
    }
    for (unsigned i = 0; i < LITERAL_PATTERNS && patterns[i] != NULL; i++) {
        const char *after = match(patterns[i], *text, end, literal);
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
        unsigned which;
        const char *begin = plain_skip_blanks(at), *text;
        const char *after = literal_read(state->literals, begin, end, &literal, &which, &text);
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
        LiteralResult result = hooks->literal(hooks->client, &literal);
        if (result == LITERAL_LEFT) {
            break;
        }
        at = after;
        literal_set_previous(state, literal.span.end);
        taken++;
        if (result == LITERAL_STOP) {
            state->client_ended = state->ended = true;
        }
    }
    // Nearly all of a buffer was taken: there are perhaps many more.
    state->many_literals = taken >= LITERALS_MANY && !state->ended && state->learning == NULL &&
                           end - at < LITERAL_STATEMENT_LONGEST;
    return at;
}
