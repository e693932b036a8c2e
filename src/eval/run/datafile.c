// #fopen, #read and #fclose: numbers, vectors and strings of a data file become the values of names.
//
// Owns the files that are open for reading. Knows nothing of what stands in them: that is data_text.c; nor of where they
// are: files.c; nor of how they are written: written.c.
//
// SPDX-License-Identifier: MIT
#include "eval/run/data_text.h"

#include <stdlib.h>

#include "eval/run/scope.h"

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

// The next value and the comma behind it, where both are written in the most usual way and at hand, and the name is a
// number or vector already. False: nothing was done.
static bool read_quickly(Eval *ev, const AstNode *target, DataFile *file)
{
    Binding *binding = target->kind == AST_NAME ? scope_binding(ev, target->symbol) : NULL;
    if (binding == NULL || binding->array != NULL || !is_readable_into(binding->variable)) {
        return false;
    }
    Value value;
    if (!data_read_plainly(file, &value)) {
        return false;
    }
    binding->is_used = true;
    Value *known = binding->variable;
    value_set_number(known, value.number); // the first component, too
    if (value.kind == VALUE_VECTOR) {
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
        if (!find_place(ev, target, &place) || (!*is_end && !data_read_value(ev, file, &value))) {
            return false;
        }
        if (value.kind == VALUE_NONE) {
            *is_end = true;
            *missed = *missed == NULL ? target : *missed;
        } else if (!give(ev, &place, &value) || !data_read_comma(ev, file, is_end)) {
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
