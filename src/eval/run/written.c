// #fopen for write and append, #write and #fclose of these: values become text, or bytes, of a file.
//
// A scene writes only below the folders that were allowed, all links resolved. What it writes counts as what it says.
// Owns the files that are open for writing. Knows nothing of how they are read.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "eval/run/run.h"
#include "eval/run/scope.h"
#include "eval/values/characters.h"

struct WrittenFile {
    WrittenFile *next;
    FILE *file;
    Span span;   // where it was opened
    char path[]; // as the scene gave it
};

// ---- opening and closing

static bool fault_write(Eval *ev, const char *path, Span span)
{
    int reason = errno;
    return eval_fault(ev, DIAG_E0505, span, "cannot write `%s`: %s", path,
                      reason == EINVAL ? "it is no regular file" : strerror(reason));
}

static FILE *open_place(Eval *ev, const char *name, bool appends, Span span)
{
    char real[PATH_MAX];
    if (!file_may_write(ev, name, span, real)) {
        return NULL;
    }
    int descriptor = source_create_real(real, appends);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, appends ? "ab" : "wb") : NULL;
    if (file == NULL) {
        fault_write(ev, name, span);
    }
    return file;
}

bool written_open(Eval *ev, const AstNode *name_node, bool appends, Span span, WrittenFile **written)
{
    Value name;
    if (!eval_string(ev, name_node, &name)) {
        return false;
    }
    FILE *file = open_place(ev, name.text, appends, name_node->span);
    if (file == NULL) {
        return false;
    }
    size_t length = strlen(name.text);
    *written = malloc(sizeof **written + length + 1);
    if (*written == NULL) {
        fclose(file);
        return eval_no_memory(ev, span);
    }
    **written = (WrittenFile){.next = ev->written_files, .file = file, .span = span};
    memcpy((*written)->path, name.text, length + 1);
    ev->written_files = *written;
    return true;
}

void written_close(Eval *ev, WrittenFile *written)
{
    WrittenFile **link = &ev->written_files;
    while (*link != written) {
        link = &(*link)->next;
    }
    *link = written->next;
    bool has_failed = ferror(written->file) != 0;
    if (fclose(written->file) != 0 || has_failed) {
        fault_write(ev, written->path, written->span);
    }
    free(written);
}

void written_files_close(Eval *ev)
{
    while (ev->written_files != NULL) {
        written_close(ev, ev->written_files);
    }
}

// ---- values as bytes

// Whole numbers of so many bytes, the least one first or last; what is beyond them is the nearest that they hold.
// Measured.
typedef struct NumberForm {
    Word word;
    bool is_signed, is_big;
    unsigned bytes;
} NumberForm;

static const NumberForm forms[] = {
    {W_uint8, false, false, 1},   {W_sint8, true, false, 1},    {W_uint16le, false, false, 2},
    {W_uint16be, false, true, 2}, {W_sint16le, true, false, 2}, {W_sint16be, true, true, 2},
    {W_sint32le, true, false, 4}, {W_sint32be, true, true, 4},
};

static const NumberForm *form_of(const AstNode *node)
{
    for (size_t i = 0; i < RT_COUNT_OF(forms); i++) {
        if (node->symbol == (Symbol)forms[i].word) {
            return &forms[i];
        }
    }
    return NULL;
}

static void put_whole(FILE *file, const NumberForm *form, double number)
{
    double span = ldexp(1.0, (int)(8 * form->bytes)), low = form->is_signed ? -span / 2.0 : 0.0;
    number = fmin(fmax(floor(number + 0.5), low), low + span - 1.0);
    uint64_t bits = (uint64_t)(int64_t)number;
    for (unsigned i = 0; i < form->bytes; i++) {
        unsigned byte = form->is_big ? form->bytes - 1 - i : i;
        putc((int)(bits >> (8 * byte) & 0xff), file);
    }
}

// Other characters than ASCII become blanks, as in POV-Ray.
static void put_text(FILE *file, const Value *value)
{
    const char *end = value->text + value->length;
    size_t bytes;
    for (const char *at = value->text; at < end; at += bytes) {
        unsigned code = character_at(at, end, &bytes);
        putc(code >= 0x80 || code == 0 ? ' ' : (int)code, file);
    }
}

static void put_value(FILE *file, const Value *value, const NumberForm *form)
{
    double v[5];
    if (value->kind == VALUE_STRING) {
        put_text(file, value);
        return;
    }
    bool is_vector = value->kind == VALUE_VECTOR;
    unsigned count = is_vector ? value_components(value, v) : 1;
    v[0] = is_vector ? v[0] : value->number;
    for (unsigned i = 0; i < count; i++) {
        if (form != NULL) {
            put_whole(file, form, v[i]);
        } else {
            fprintf(file, "%s%g", !is_vector ? "" : i == 0 ? "<" : ",", v[i]);
        }
    }
    if (is_vector && form == NULL) {
        fputs("> ", file);
    }
}

// ---- #write

static bool write_value(Eval *ev, const AstNode *node, const NumberForm *form, WrittenFile *written)
{
    enum { MOST_BYTES_OF_NUMBERS = 80 };
    Value value;
    if (!eval_expression(ev, node, &value)) {
        return false;
    }
    bool is_text = value.kind == VALUE_STRING, is_number = value.kind == VALUE_NUMBER || value.kind == VALUE_VECTOR;
    if (!is_number && (!is_text || form != NULL)) {
        const char *wanted = form != NULL ? "a number or a vector" : "a number, a vector or a string";
        return value.kind != VALUE_NONE &&
               eval_fault(ev, DIAG_E0202, node->span, "expected %s, found %s", wanted, value_describe(&value));
    }
    if (!message_count_bytes(ev, is_text ? value.length : MOST_BYTES_OF_NUMBERS, node->span)) {
        return false;
    }
    put_value(written->file, &value, form);
    return !ferror(written->file) || fault_write(ev, written->path, node->span);
}

void written_write(Eval *ev, const AstNode *values, WrittenFile *written)
{
    const NumberForm *form = NULL;
    for (const AstNode *node = values; node != NULL && !ev->stop; node = node->next) {
        if (node->kind == AST_WORD) {
            form = form_of(node);
            if (form == NULL) {
                eval_fault(ev, DIAG_E0106, node->span, "`%s` is no form in which a number is written",
                           eval_text(ev, node->symbol));
                return;
            }
        } else if (write_value(ev, node, form, written)) {
            form = NULL;
        } else {
            ev->faulty = true;
            return;
        }
    }
}
