// #fopen, #read and #fclose: numbers, vectors and strings of a data file become the values of names.
//
// A file is read in blocks and each value once, from the block into the variable. Owns the files that are open for
// reading. Knows nothing of where files are: that is files.c; nor of how they are written: written.c.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/plain.h"
#include "eval/values/characters.h"
#include "eval/run/scope.h"

enum {
    BLOCK_BYTES = 64 << 10,
    WORK_OF_A_BYTE = 2,              // of a comment, say
    LONGEST_VALUE = 255,             // characters of a number or a string, as in scenes
    LOOK_AHEAD = LONGEST_VALUE + 33, // at hand wherever a number begins
};

struct DataFile {
    DataFile *next;
    Source *source;
    const char *at, *end; // what was read and not yet used; a zero follows
    uint64_t end_offset;  // global offset of `end`
    bool ended;           // nothing follows `end`
    TextBuffer text;      // of the string that was read last
    char block[BLOCK_BYTES + 1];
};

// ---- bytes

// Reads on, keeping what is not used yet. A file that cannot be read any further ends there, with a message.
static void fill(Eval *ev, DataFile *file)
{
    size_t kept = (size_t)(file->end - file->at);
    memmove(file->block, file->at, kept);
    file->at = file->block;
    ptrdiff_t got = source_read(file->source, file->block + kept, BLOCK_BYTES - kept);
    Span here = {file->end_offset, file->end_offset};
    if (got > 0 && !eval_work(ev, WORK_OF_A_BYTE * (size_t)got, here)) {
        got = 0;
    } else if (got < 0 && errno == ECANCELED) {
        ev->stop = true;
    } else if (got < 0) {
        eval_fault(ev, DIAG_E0502, here, "cannot read any further: %s", strerror(errno));
    }
    file->ended = got <= 0;
    file->end = file->block + kept + (got > 0 ? got : 0);
    file->end_offset += got > 0 ? (uint64_t)got : 0;
    file->block[file->end - file->block] = '\0';
}

static inline void look_ahead(Eval *ev, DataFile *file, size_t bytes)
{
    while (RT_UNLIKELY((size_t)(file->end - file->at) < bytes) && !file->ended) {
        fill(ev, file);
    }
}

static Span span_of(const DataFile *file, const char *begin, const char *end)
{
    return (Span){file->end_offset - (uint64_t)(file->end - begin), file->end_offset - (uint64_t)(file->end - end)};
}

static Span span_here(const DataFile *file)
{
    return span_of(file, file->at, file->at < file->end ? file->at + 1 : file->at);
}

static bool is_blank(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r') || c == '\x1a';
}

static void skip_line(Eval *ev, DataFile *file)
{
    for (;;) {
        const char *newline = memchr(file->at, '\n', (size_t)(file->end - file->at));
        if (newline != NULL || file->ended) {
            file->at = newline != NULL ? newline : file->end;
            return;
        }
        file->at = file->end;
        fill(ev, file);
    }
}

// Comments nest, as in scenes.
static bool skip_comment(Eval *ev, DataFile *file)
{
    Span begin = span_of(file, file->at, file->at + 2);
    for (unsigned depth = 0;;) {
        look_ahead(ev, file, 2);
        if (file->end - file->at < 2) {
            return eval_fault(ev, DIAG_E0103, begin, "this comment has no end `*/`");
        }
        bool opens = file->at[0] == '/' && file->at[1] == '*', closes = file->at[0] == '*' && file->at[1] == '/';
        depth = opens ? depth + 1 : closes ? depth - 1 : depth;
        file->at += opens || closes ? 2 : 1;
        if (depth == 0) {
            return true;
        }
    }
}

// To what is neither blank nor comment: its first character, 0 at the end. False after a fault.
static bool next_character(Eval *ev, DataFile *file, char *c)
{
    for (;;) {
        while (is_blank(*file->at)) {
            file->at++;
        }
        if (RT_UNLIKELY((size_t)(file->end - file->at) < LOOK_AHEAD) && !file->ended) {
            fill(ev, file);
            continue;
        }
        *c = *file->at;
        if (RT_LIKELY(*c != '/' || (file->at[1] != '/' && file->at[1] != '*'))) {
            break;
        }
        if (file->at[1] == '/') {
            skip_line(ev, file);
        } else if (!skip_comment(ev, file)) {
            return false;
        }
    }
    return !ev->stop && (*c != '\0' || file->at == file->end ||
                         eval_fault(ev, DIAG_E0509, span_here(file), "byte 0x00 has no meaning in a data file"));
}

// ---- values

static bool fault_unexpected(Eval *ev, const DataFile *file, const char *wanted)
{
    char c = *file->at;
    bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    if (file->at == file->end) {
        return eval_fault(ev, DIAG_E0509, span_here(file), "expected %s, found the end of the file", wanted);
    }
    if (!eval_report(ev, DIAG_E0509, span_here(file), "expected %s here", wanted)) {
        return false;
    }
    if (is_letter || c == '(') {
        diag_suggest(ev->options.diags, "a data file holds values, not names or expressions");
    } else if (c == '#') {
        diag_suggest(ev->options.diags, "a data file holds values, not directives");
    }
    return false;
}

// A number at hand, without its sign.
static bool read_digits(Eval *ev, DataFile *file, double *number)
{
    size_t used = 0;
    const char *begin = file->at;
    NumberResult result = number_scan(begin, (size_t)(file->end - begin), number, &used);
    if (RT_UNLIKELY(result == NUMBER_MALFORMED)) {
        return fault_unexpected(ev, file, "a number");
    }
    file->at += used;
    Span span = span_of(file, begin, file->at);
    if (RT_UNLIKELY(used > LONGEST_VALUE)) {
        return eval_fault(ev, DIAG_E0509, span, "a number of more than %d characters", LONGEST_VALUE);
    }
    if (RT_UNLIKELY(*file->at == '.')) {
        return eval_fault(ev, DIAG_E0509, span_here(file), "a number has one decimal point");
    }
    return RT_LIKELY(result == NUMBER_OK) ||
           eval_fault(ev, DIAG_E0104, span, "`%.*s` is beyond the greatest number, about 1.8e308",
                      used < 40 ? (int)used : 40, begin);
}

static bool read_number(Eval *ev, DataFile *file, char first, double *number)
{
    bool is_signed = first == '-' || first == '+';
    file->at += is_signed;
    if (is_signed && !next_character(ev, file, &(char){0})) {
        return false;
    }
    if (!read_digits(ev, file, number)) {
        return false;
    }
    *number = first == '-' ? -*number : *number;
    return true;
}

static bool read_vector(Eval *ev, DataFile *file, Value *value)
{
    char c;
    unsigned count = 0;
    Span begin = span_here(file);
    file->at++;
    do {
        double number;
        if (!next_character(ev, file, &c) || !read_number(ev, file, c, &number) || !next_character(ev, file, &c)) {
            return false;
        }
        if (count == 5) {
            return eval_fault(ev, DIAG_E0509, begin, "a vector has at most 5 components");
        }
        value->v[count++] = number;
        if (c == ',') {
            file->at++;
            if (!next_character(ev, file, &c)) {
                return false;
            }
        }
    } while (c != '>');
    file->at++;
    value->kind = VALUE_VECTOR;
    value->components = (uint8_t)count;
    return count >= 2 || eval_fault(ev, DIAG_E0509, begin, "a vector has at least 2 components");
}

// Appends what stands at a backslash.
static bool read_escape(Eval *ev, DataFile *file)
{
    size_t used = text_append_escape(&file->text, file->at, (size_t)(file->end - file->at));
    if (used == 0) {
        return eval_fault(ev, DIAG_E0101, span_of(file, file->at, file->at + 1),
                          "this escape means nothing in a string; a backslash is written `\\\\`");
    }
    file->at += used;
    return true;
}

static bool read_string(Eval *ev, DataFile *file, Value *value)
{
    Span begin = span_here(file);
    text_clear(&file->text);
    for (file->at++;;) {
        look_ahead(ev, file, LOOK_AHEAD);
        if (file->at == file->end) {
            return eval_fault(ev, DIAG_E0102, begin, "this string has no closing `\"`");
        }
        if (*file->at == '"') {
            break;
        }
        if (*file->at != '\\') {
            if (*file->at == TEXT_MARK) {
                text_append_char(&file->text, TEXT_MARK);
            }
            text_append_char(&file->text, *file->at++);
        } else if (!read_escape(ev, file)) {
            return false;
        }
        if (file->text.length > LONGEST_VALUE) {
            return eval_fault(ev, DIAG_E0509, begin, "a string of more than %d characters", LONGEST_VALUE);
        }
    }
    file->at++;
    if (file->text.failed) {
        return eval_no_memory(ev, begin);
    }
    return characters_of_text(ev, text_get(&file->text), file->text.length, begin, value);
}

// The next value, VALUE_NONE at the end. False after a fault.
static bool read_value(Eval *ev, DataFile *file, Value *value)
{
    char c;
    *value = (Value){.kind = VALUE_NONE};
    if (!next_character(ev, file, &c)) {
        return false;
    }
    if (RT_LIKELY((c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+')) {
        value->kind = VALUE_NUMBER;
        return read_number(ev, file, c, &value->number);
    }
    return c == '\0'  ? true
           : c == '<' ? read_vector(ev, file, value)
           : c == '"' ? read_string(ev, file, value)
                      : fault_unexpected(ev, file, "a number, a vector or a string");
}

// What follows a value is a comma or the end. POV-Ray passes over whatever stands there, a value too.
static bool read_comma(Eval *ev, DataFile *file, bool *is_end)
{
    char c;
    if (!next_character(ev, file, &c)) {
        return false;
    }
    *is_end = c == '\0';
    if (RT_LIKELY(c == ',')) {
        file->at++;
    } else if (c != '\0') {
        if (eval_report(ev, DIAG_E0510, span_here(file), "expected a `,` between this value and the one before")) {
            diag_suggest(ev->options.diags, "write a `,` after each value, at the ends of lines too");
        }
        return false;
    }
    return true;
}

// ---- #fopen and #fclose

static bool data_open(Eval *ev, const AstNode *node, DataFile **opened)
{
    Source *source;
    if (!file_open(ev, node->b, FILE_DATA, &source)) {
        return false;
    }
    DataFile *file = malloc(sizeof *file);
    if (file == NULL) {
        source_close(source);
        return eval_no_memory(ev, node->span);
    }
    *file = (DataFile){.next = ev->data_files, .source = source, .end_offset = source_base(source)};
    file->at = file->end = file->block;
    text_init(&file->text);
    *opened = ev->data_files = file;
    return true;
}

static void run_open(Eval *ev, const AstNode *node)
{
    Value value = {.kind = VALUE_FILE};
    bool reads = node->symbol == W_read, appends = node->symbol == W_append;
    if (!reads && !appends && node->symbol != W_write) {
        eval_fault(ev, DIAG_E0106, node->span,
                   "`#fopen` wants `read`, `write` or `append` after the file's name, found `%s`",
                   eval_text(ev, node->symbol));
        return;
    }
    const Value *known = scope_find(ev, node->a->symbol);
    if (known != NULL && known->kind != VALUE_NONE) {
        eval_fault(ev, DIAG_E0268, node->a->span, "`%s` is %s already and cannot name a file",
                   eval_text(ev, node->a->symbol), value_describe(known));
        return;
    }
    bool is_open =
        reads ? data_open(ev, node, &value.file) : written_open(ev, node->b, appends, node->span, &value.written);
    if (!is_open) {
        ev->file_is_missing = true;
        return;
    }
    ev->faulty = !scope_declare(ev, node->a->symbol, false, &value, node->a->span) || ev->faulty;
}

static void file_free(DataFile *file)
{
    source_close(file->source);
    text_fini(&file->text);
    free(file);
}

static void close_file(Eval *ev, Symbol name, DataFile *file)
{
    DataFile **link = &ev->data_files;
    while (*link != file) {
        link = &(*link)->next;
    }
    *link = file->next;
    file_free(file);
    scope_undef(ev, name);
}

void data_files_fini(Eval *ev)
{
    while (ev->data_files != NULL) {
        DataFile *file = ev->data_files;
        ev->data_files = file->next;
        file_free(file);
    }
}

// What is not open is closed already, as in POV-Ray.
static void run_close(Eval *ev, const AstNode *node)
{
    const Value *found = scope_find(ev, node->a->symbol);
    if (found == NULL || found->kind != VALUE_FILE) {
        return;
    }
    if (found->file != NULL) {
        close_file(ev, node->a->symbol, found->file);
    } else {
        written_close(ev, found->written);
        scope_undef(ev, node->a->symbol);
    }
}

// ---- #read

// Where a value goes: a name, or an element of an array.
typedef struct Place {
    const AstNode *target;
    Value *element; // NULL: the name
    ValueArray *array;
} Place;

static bool is_readable_into(const Value *value)
{
    return value->kind == VALUE_NUMBER || value->kind == VALUE_STRING ||
           (value->kind == VALUE_VECTOR && value->components == 3); // as in POV-Ray
}

static bool fault_target(Eval *ev, const AstNode *target, const Value *value)
{
    bool is_empty = value->kind == VALUE_NONE;
    if (eval_report(ev, DIAG_E0270, target->span, "`#read` cannot read into %s",
                    is_empty ? "an element without a value" : value_describe(value)) &&
        is_empty) {
        diag_suggest(ev->options.diags, "give the elements of the array their first values where it is declared");
    }
    return false;
}

// A name may be undeclared. What has a value may get one of any other kind that a file can hold.
static bool find_place(Eval *ev, const AstNode *target, Place *place)
{
    *place = (Place){.target = target};
    if (target->kind == AST_NAME) {
        const Value *known = scope_find(ev, target->symbol);
        return known == NULL || known->kind == VALUE_NONE || is_readable_into(known) ||
               fault_target(ev, target, known);
    }
    if (target->kind != AST_INDEX) {
        return eval_fault(ev, DIAG_E0270, target->span, "`#read` wants names, or elements of arrays, to read into");
    }
    return array_locate(ev, target, &place->element, &place->array) &&
           (is_readable_into(place->element) || fault_target(ev, target, place->element));
}

static bool give(Eval *ev, const Place *place, const Value *value)
{
    const AstNode *target = place->target;
    return place->element == NULL ? scope_declare(ev, target->symbol, false, value, target->span)
                                  : array_assign(ev, place->array, place->element, value, target->span);
}

// A number that is written in the most usual way, and all around it; NULL: anything else.
static const char *read_plainly(const char *at, const char *end, double *number)
{
    at = plain_read_number(at, end, number);
    while (at != NULL && is_blank(*at)) {
        at++;
    }
    return at;
}

static const char *read_three_plainly(const char *at, const char *end, double *three)
{
    for (unsigned i = 0; i < 3; i++) {
        do {
            at++; // a `<`, a comma, a blank
        } while (is_blank(*at));
        at = read_plainly(at, end, &three[i]);
        if (at == NULL || *at != (i < 2 ? ',' : '>')) {
            return NULL;
        }
    }
    do {
        at++;
    } while (is_blank(*at));
    return at;
}

// The next value and the comma behind it, where both are written in the most usual way and at hand, and the name is a
// number or vector already. False: nothing was done.
static bool read_quickly(Eval *ev, const AstNode *target, DataFile *file)
{
    Binding *binding = target->kind == AST_NAME ? scope_binding(ev, target->symbol) : NULL;
    if (binding == NULL || binding->array != NULL || !is_readable_into(binding->variable)) {
        return false;
    }
    Value value;
    const char *at = file->at;
    while (is_blank(*at)) {
        at++;
    }
    if ((size_t)(file->end - at) < LOOK_AHEAD) {
        return false;
    }
    bool is_vector = *at == '<';
    at = is_vector ? read_three_plainly(at, file->end, value.v) : read_plainly(at, file->end, &value.number);
    if (at == NULL || *at != ',') {
        return false;
    }
    file->at = at + 1;
    binding->is_used = true;
    Value *known = binding->variable;
    value_set_number(known, value.number); // the first component, too
    if (is_vector) {
        known->kind = VALUE_VECTOR;
        known->components = 3;
        known->v[1] = value.v[1];
        known->v[2] = value.v[2];
    }
    return true;
}

// The first target that is left to the usual way; NULL: none.
static const AstNode *read_most(Eval *ev, const AstNode *targets, DataFile *file)
{
    while (targets != NULL && read_quickly(ev, targets, file)) {
        targets = targets->next;
    }
    return targets;
}

// Reads one value for each target; *missed is the first that got none. False after a fault.
static bool read_all(Eval *ev, const AstNode *targets, DataFile *file, bool *is_end, const AstNode **missed)
{
    for (const AstNode *target = targets; target != NULL; target = target->next) {
        Place place;
        Value value = {.kind = VALUE_NONE};
        if (!find_place(ev, target, &place) || (!*is_end && !read_value(ev, file, &value))) {
            return false;
        }
        if (value.kind == VALUE_NONE) {
            *is_end = true;
            *missed = *missed == NULL ? target : *missed;
        } else if (!give(ev, &place, &value) || !read_comma(ev, file, is_end)) {
            return false;
        }
    }
    return !ev->stop;
}

static void fault_not_open(Eval *ev, const AstNode *name, const Value *found)
{
    if (found != NULL && found->kind == VALUE_FILE) {
        eval_fault(ev, DIAG_E0267, name->span, "`%s` is open for %s only", eval_text(ev, name->symbol),
                   found->file != NULL ? "reading" : "writing");
        return;
    }
    bool is_told = found == NULL ? ev->file_is_missing : found->kind == VALUE_NONE;
    if (!is_told && eval_report(ev, DIAG_E0267, name->span, "`%s` is not an open file", eval_text(ev, name->symbol))) {
        diag_suggest(ev->options.diags, "the end of a file closes it: read while `defined(%s)`",
                     eval_text(ev, name->symbol));
    }
}

// After a fault the names that got nothing are kept without a value, so that their uses are not reported as well.
static void forget_targets(Eval *ev, const AstNode *targets)
{
    for (const AstNode *target = targets; target != NULL; target = target->next) {
        if (target->kind == AST_NAME && scope_find(ev, target->symbol) == NULL &&
            !scope_declare(ev, target->symbol, false, &(Value){.kind = VALUE_NONE}, target->span)) {
            ev->stop = true; // no memory even for that
        }
    }
    ev->faulty = true;
}

static void run_read(Eval *ev, const AstNode *node)
{
    const AstNode *name = node->a;
    const Value *found = scope_find(ev, name->symbol);
    if (found == NULL || found->kind != VALUE_FILE || found->file == NULL) {
        fault_not_open(ev, name, found);
        forget_targets(ev, node->b);
        return;
    }
    DataFile *file = found->file;
    const AstNode *left = ev->options.no_literals ? node->b : read_most(ev, node->b, file);
    if (left == NULL) {
        return;
    }
    DiagFrame frame;
    bool is_end = false;
    const AstNode *missed = NULL;
    eval_frame_enter(ev, &frame, "read from", eval_text(ev, name->symbol), node->span);
    bool fine = read_all(ev, left, file, &is_end, &missed);
    eval_frame_leave(ev);
    if (fine && missed != NULL && missed != node->b) {
        eval_warn(ev, DIAG_W0501, missed->span, "the file ends before a value for this; what it was it stays");
    }
    if (!fine) {
        forget_targets(ev, node->b);
    }
    if (is_end || !fine) { // after a fault too, so that a loop ends
        close_file(ev, name->symbol, file);
    }
}

static void run_write(Eval *ev, const AstNode *node)
{
    const AstNode *name = node->a;
    const Value *found = scope_find(ev, name->symbol);
    if (found != NULL && found->kind == VALUE_FILE && found->written != NULL) {
        written_write(ev, node->b, found->written);
    } else {
        fault_not_open(ev, name, found);
        ev->faulty = true;
    }
}

void data_file_run(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    switch (node->kind) {
    case AST_FOPEN: run_open(ev, node); break;
    case AST_FCLOSE: run_close(ev, node); break;
    case AST_READ: run_read(ev, node); break;
    default: run_write(ev, node); break;
    }
}
