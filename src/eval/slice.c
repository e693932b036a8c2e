// A backward slice over the words of statements: from the statements that are needed to those that write their names.
//
// SPDX-License-Identifier: MIT
#include "eval/slice.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/intern.h"

// What is known of a name.
typedef struct Name {
    size_t stamp;        // 1 + the last statement that mentions it
    size_t macro;        // 1 + the statement that defines it as a macro; 0: none does
    bool varies;         // it may differ from frame to frame
    bool is_needed;
} Name;

typedef struct Statement {
    size_t first, count;        // in Slice.mentions
    size_t first_written, written_count;
    bool declares;              // with #declare, which a macro may do to what it was given
    bool varies, is_needed;
    bool has_chance;            // it calls rand
    bool has_state;             // it changes what statements without its names depend on
    size_t reached;             // the last search that came here
} Statement;

typedef struct Slice {
    InternTable *words;
    ARRAY(Name) names; // by symbol
    ARRAY(Statement) statements;
    ARRAY(Symbol) mentions;
    ARRAY(Symbol) written;
    ARRAY(size_t) bodies; // of the macros that a statement may call, see find_bodies
    size_t searches;
    bool reads_files, no_memory;
} Slice;

// ---- words

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static size_t word_end(const char *text, size_t length, size_t at)
{
    while (at < length && (is_letter(text[at]) || is_digit(text[at]))) {
        at++;
    }
    return at;
}

static Symbol take_name(Slice *slice, const char *text, size_t length)
{
    Symbol symbol = intern_text(slice->words, text, length);
    while (symbol != SYMBOL_NONE && slice->names.count <= symbol) {
        if (!ARRAY_PUSH(&slice->names, (Name){0})) {
            symbol = SYMBOL_NONE;
        }
    }
    slice->no_memory = slice->no_memory || symbol == SYMBOL_NONE;
    return symbol;
}

static bool is_word(const char *text, size_t length, const char *word)
{
    return strlen(word) == length && memcmp(text, word, length) == 0;
}

static bool is_one_of(const char *text, size_t length, const char *const *words)
{
    while (*words && !is_word(text, length, *words)) {
        words++;
    }
    return *words != NULL;
}

static void mention(Slice *slice, const char *text, size_t length)
{
    static const char *const views[] = {"camera", "light_source", "background", "global_settings", NULL};
    Statement *statement = &slice->statements.items[slice->statements.count - 1];
    Symbol symbol = take_name(slice, text, length);
    if (symbol == SYMBOL_NONE || slice->names.items[symbol].stamp == slice->statements.count) {
        return;
    }
    slice->names.items[symbol].stamp = slice->statements.count;
    statement->count++;
    statement->is_needed = statement->is_needed || is_one_of(text, length, views);
    statement->has_chance = statement->has_chance || is_word(text, length, "rand");
    statement->has_state = statement->has_state || is_word(text, length, "global_settings");
    slice->no_memory = !ARRAY_PUSH(&slice->mentions, symbol) || slice->no_memory;
}

// What stands behind the word of a directive; the name that it writes, if any, begins at the place that is returned.
static size_t skip_to_name(const char *text, size_t length, size_t at)
{
    while (at < length && (text[at] == ' ' || text[at] == '\t' || text[at] == '\r' || text[at] == '\n' || text[at] == '(')) {
        at++;
    }
    return at;
}

static void take_directive(Slice *slice, const char *word, size_t word_length, const char *name, size_t name_length)
{
    static const char *const writers[] = {"declare", "local", "undef", "macro", "for", NULL};
    static const char *const files[] = {"fopen", "fclose", "read", "write", NULL};
    static const char *const states[] = {"default", "version", NULL};
    Statement *statement = &slice->statements.items[slice->statements.count - 1];
    statement->declares = statement->declares || is_word(word, word_length, "declare");
    statement->has_state = statement->has_state || is_one_of(word, word_length, states);
    statement->is_needed = statement->is_needed || statement->has_state;
    slice->reads_files = slice->reads_files || is_one_of(word, word_length, files);
    if (name_length == 0 || !is_one_of(word, word_length, writers)) {
        return;
    }
    Symbol symbol = take_name(slice, name, name_length);
    statement->written_count++;
    slice->no_memory = !ARRAY_PUSH(&slice->written, symbol) || slice->no_memory;
    if (symbol != SYMBOL_NONE && is_word(word, word_length, "macro")) {
        slice->names.items[symbol].macro = slice->statements.count;
    }
}

// The end of a comment or a string that begins at `at`; `at` when none does.
static size_t skip_silent(const char *text, size_t length, size_t at)
{
    size_t end = at;
    if (text[at] == '"') {
        for (end = at + 1; end < length && text[end] != '"'; end++) {
            end += text[end] == '\\';
        }
        return end + 1;
    }
    if (text[at] == '/' && at + 1 < length && text[at + 1] == '/') {
        const char *newline = memchr(text + at, '\n', length - at);
        return newline ? (size_t)(newline - text) : length;
    }
    if (text[at] == '/' && at + 1 < length && text[at + 1] == '*') {
        // Comments nest; what stands behind an inner one is then taken for words, which only adds some.
        for (end = at + 2; end + 1 < length && (text[end] != '*' || text[end + 1] != '/'); end++) {
        }
        return end + 2;
    }
    return end;
}

static void take_text(Slice *slice, const char *text, size_t length)
{
    for (size_t at = 0; at < length;) {
        size_t silent = skip_silent(text, length, at), end = word_end(text, length, at);
        if (silent > at) {
            at = silent;
        } else if (text[at] == '#') {
            size_t word = skip_to_name(text, length, at + 1), after = word_end(text, length, word);
            size_t name = skip_to_name(text, length, after), name_end = word_end(text, length, name);
            take_directive(slice, text + word, after - word, text + name, name_end - name);
            at = after > at ? after : at + 1;
        } else if (end > at) {
            if (is_letter(text[at])) {
                mention(slice, text + at, end - at);
            }
            at = end;
        } else {
            at++;
        }
    }
}

static void take_texts(Slice *slice, const SliceText *texts, size_t count)
{
    for (size_t i = 0; i < count && !slice->no_memory; i++) {
        if (i == 0 || texts[i].statement != texts[i - 1].statement) {
            Statement statement = {.first = slice->mentions.count, .first_written = slice->written.count};
            slice->no_memory = !ARRAY_PUSH(&slice->statements, statement);
        }
        if (!slice->no_memory) {
            take_text(slice, texts[i].text, texts[i].length);
        }
    }
}

// ---- what follows from what

typedef bool (*NameTest)(const Name *name);

static bool name_varies(const Name *name)
{
    return name->varies;
}

static bool name_is_needed(const Name *name)
{
    return name->is_needed;
}

static bool mentions_one(const Slice *slice, const Statement *statement, NameTest test)
{
    for (size_t i = 0; i < statement->count; i++) {
        if (test(&slice->names.items[slice->mentions.items[statement->first + i]])) {
            return true;
        }
    }
    return false;
}

// Collects the statements that define the macros which a statement may call, those that they call, and so on.
static void find_bodies(Slice *slice, const Statement *from)
{
    size_t search = ++slice->searches;
    slice->bodies.count = 0;
    for (size_t next = 0; from; from = next < slice->bodies.count ? &slice->statements.items[slice->bodies.items[next++]] : NULL) {
        for (size_t i = 0; i < from->count; i++) {
            size_t macro = slice->names.items[slice->mentions.items[from->first + i]].macro;
            Statement *body = macro ? &slice->statements.items[macro - 1] : NULL;
            if (body && body->reached != search) {
                body->reached = search;
                slice->no_memory = !ARRAY_PUSH(&slice->bodies, macro - 1) || slice->no_memory;
            }
        }
    }
}

static bool writes_itself(const Slice *slice, const Statement *statement, NameTest test)
{
    for (size_t i = 0; i < statement->written_count; i++) {
        if (test(&slice->names.items[slice->written.items[statement->first_written + i]])) {
            return true;
        }
    }
    return false;
}

// Whether it writes a name of that kind, itself or by a macro: the names that the macro's text writes, and if it declares,
// any that the statement mentions, since it may have been given them.
static bool writes_one(Slice *slice, const Statement *statement, NameTest test)
{
    bool declares = false;
    find_bodies(slice, statement);
    for (size_t i = 0; i < slice->bodies.count; i++) {
        const Statement *body = &slice->statements.items[slice->bodies.items[i]];
        declares = declares || body->declares;
        if (writes_itself(slice, body, test)) {
            return true;
        }
    }
    return writes_itself(slice, statement, test) || (declares && mentions_one(slice, statement, test));
}

static bool mark(bool *flag)
{
    bool is_new = !*flag;
    *flag = true;
    return is_new;
}

static bool mark_all(Slice *slice, const Symbol *symbols, size_t count)
{
    bool is_more = false;
    for (size_t i = 0; i < count; i++) {
        is_more = mark(&slice->names.items[symbols[i]].varies) || is_more;
    }
    return is_more;
}

// Marks all that a statement may write as varying; true when one did not before.
static bool spread(Slice *slice, const Statement *statement)
{
    bool is_more = mark_all(slice, slice->written.items + statement->first_written, statement->written_count);
    bool declares = false;
    find_bodies(slice, statement);
    for (size_t i = 0; i < slice->bodies.count; i++) {
        const Statement *body = &slice->statements.items[slice->bodies.items[i]];
        declares = declares || body->declares;
        is_more = mark_all(slice, slice->written.items + body->first_written, body->written_count) || is_more;
    }
    return (declares && mark_all(slice, slice->mentions.items + statement->first, statement->count)) || is_more;
}

static void find_varying(Slice *slice)
{
    for (bool is_more = true; is_more;) {
        is_more = false;
        for (size_t i = 0; i < slice->statements.count; i++) {
            Statement *statement = &slice->statements.items[i];
            if (!statement->varies && mentions_one(slice, statement, name_varies)) {
                statement->varies = statement->is_needed = is_more = true;
            }
            is_more = (statement->varies && spread(slice, statement)) || is_more;
        }
    }
}

static void find_needed(Slice *slice)
{
    for (bool is_more = true; is_more;) {
        is_more = false;
        for (size_t i = 0; i < slice->statements.count; i++) {
            const Statement *statement = &slice->statements.items[i];
            for (size_t k = 0; statement->is_needed && k < statement->count; k++) {
                slice->names.items[slice->mentions.items[statement->first + k]].is_needed = true;
            }
        }
        for (size_t i = 0; i < slice->statements.count; i++) {
            Statement *statement = &slice->statements.items[i];
            if (!statement->is_needed && writes_one(slice, statement, name_is_needed)) {
                statement->is_needed = is_more = true;
            }
        }
    }
}

// The first statement of the slice that makes shapes; their number: none does.
static size_t first_shape(const Slice *slice, const uint32_t *shapes)
{
    size_t first = 0;
    while (first < slice->statements.count &&
           (!slice->statements.items[first].is_needed || shapes[first + 1] == shapes[first])) {
        first++;
    }
    return first;
}

// Adds all that make shapes behind the first in the slice that does, and what these need, which may be an earlier one.
static size_t find_shapes(Slice *slice, const uint32_t *shapes)
{
    find_needed(slice);
    size_t first = first_shape(slice, shapes);
    for (bool is_more = true; is_more; first = first_shape(slice, shapes)) {
        is_more = false;
        for (size_t i = first; i < slice->statements.count; i++) {
            is_more = (shapes[i + 1] > shapes[i] && mark(&slice->statements.items[i].is_needed)) || is_more;
        }
        find_needed(slice);
    }
    return first;
}

// What the statements that are left out depend on without naming it differs from frame to frame.
static bool varies_state(const Slice *slice)
{
    for (size_t i = 0; i < slice->statements.count; i++) {
        if (slice->statements.items[i].varies && slice->statements.items[i].has_state) {
            return true;
        }
    }
    return false;
}

// Streams of random numbers continue from call to call, whoever calls.
static bool shares_chance(const Slice *slice)
{
    bool in_slice = false, outside = false;
    for (size_t i = 0; i < slice->statements.count; i++) {
        const Statement *statement = &slice->statements.items[i];
        in_slice = in_slice || (statement->has_chance && statement->is_needed);
        outside = outside || (statement->has_chance && !statement->is_needed);
    }
    return in_slice && outside;
}

SliceResult slice_make(const SliceText *texts, size_t count, const uint32_t *shapes, const char *const *varying,
                       TextBuffer *out, uint32_t *kept, size_t *at)
{
    Slice slice = {.words = intern_new(SIZE_MAX)};
    size_t first = SIZE_MAX;
    slice.no_memory = !slice.words;
    for (; !slice.no_memory && *varying; varying++) {
        Symbol symbol = take_name(&slice, *varying, strlen(*varying));
        if (symbol != SYMBOL_NONE) {
            slice.names.items[symbol].varies = true;
        }
    }
    take_texts(&slice, texts, slice.no_memory ? 0 : count);
    bool is_made = !slice.no_memory && !slice.reads_files;
    if (is_made) {
        find_varying(&slice);
        first = find_shapes(&slice, shapes);
        *kept = shapes[first];
        is_made = !shares_chance(&slice) && !varies_state(&slice) && !slice.no_memory;
    }
    size_t statement = 0;
    *at = SIZE_MAX;
    for (size_t i = 0; is_made && i < count; i++) {
        bool is_own = i == 0 || texts[i].statement != texts[i - 1].statement;
        if (is_own && statement == first) {
            *at = out->length;
        }
        if (is_own && slice.statements.items[statement++].is_needed) {
            text_append_n(out, texts[i].text, texts[i].length);
            text_append_char(out, '\n');
        }
    }
    *at = *at < out->length ? *at : out->length;
    bool no_memory = slice.no_memory || out->failed;
    if (slice.words) {
        intern_free(slice.words);
    }
    ARRAY_FREE(&slice.names);
    ARRAY_FREE(&slice.statements);
    ARRAY_FREE(&slice.mentions);
    ARRAY_FREE(&slice.written);
    ARRAY_FREE(&slice.bodies);
    return no_memory ? SLICE_NO_MEMORY : is_made ? SLICE_MADE : SLICE_NONE;
}
