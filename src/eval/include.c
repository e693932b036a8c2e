// #include: finds the file, reads it, and hands its items to the cursor that came to the directive.
//
// At the top level text is evaluated item by item while it is read; inside a block all its items are read first. Files
// are looked for in the current folder and then in the include paths, never beside the including file, as in POV-Ray.
//
// SPDX-License-Identifier: MIT
#include <dirent.h>
#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "base/suggest.h"
#include "eval/internal.h"

// What is looked for under a name that is not found: POV-Ray adds an ending to a name that has none.
static const char *const endings[] = {"", ".inc"};

typedef struct Search {
    const char *name;
    TextBuffer path; // the file that was found
} Search;

static bool is_absolute(const char *name)
{
    return name[0] == '/';
}

static bool has_ending(const char *name)
{
    const char *slash = strrchr(name, '/');
    return strchr(slash != NULL ? slash : name, '.') != NULL;
}

static bool exists(TextBuffer *path, const char *folder, const char *name, const char *ending)
{
    text_clear(path);
    if (folder[0] != '\0') {
        text_printf(path, "%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/");
    }
    text_printf(path, "%s%s", name, ending);
    return !path->failed && access(text_get(path), F_OK) == 0;
}

static bool find(const Eval *ev, Search *search)
{
    size_t folders = is_absolute(search->name) ? 0 : ev->options.include_path_count;
    size_t kinds = has_ending(search->name) ? 1 : RT_COUNT_OF(endings);
    for (size_t kind = 0; kind < kinds; kind++) {
        if (exists(&search->path, "", search->name, endings[kind])) {
            return true;
        }
        for (size_t i = 0; i < folders; i++) {
            if (exists(&search->path, ev->options.include_paths[i], search->name, endings[kind])) {
                return true;
            }
        }
    }
    return false;
}

bool include_exists(const Eval *ev, const Value *name)
{
    Search search = {.name = name->text};
    text_init(&search.path);
    bool is_found = find(ev, &search);
    text_fini(&search.path);
    return is_found;
}

// ---- a file that is not found

static void offer_folder(Eval *ev, Suggest *suggest, const char *folder)
{
    DIR *directory = opendir(folder);
    if (directory == NULL) {
        return;
    }
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        char *name = arena_copy_text(&ev->scratch, entry->d_name, strlen(entry->d_name));
        if (name != NULL && name[0] != '.') {
            suggest_offer(suggest, name);
        }
    }
    closedir(directory);
}

// The name stands in the text as it is when it is one string.
static void suggest_near_name(Eval *ev, const char *name, const AstNode *node)
{
    Suggest suggest;
    ArenaMark mark = arena_mark(&ev->scratch);
    suggest_begin(&suggest, name);
    offer_folder(ev, &suggest, ".");
    for (size_t i = 0; i < ev->options.include_path_count; i++) {
        offer_folder(ev, &suggest, ev->options.include_paths[i]);
    }
    if (suggest.best != NULL) {
        diag_suggest(ev->options.diags, "did you mean `%s`?", suggest.best);
        if (node->kind == AST_STRING) {
            diag_replace(ev->options.diags, node->span, "\"%s\"", suggest.best);
        }
    }
    arena_rewind(&ev->scratch, mark);
}

static void note_folders(Eval *ev)
{
    TextBuffer list;
    text_init(&list);
    text_append(&list, "searched in the current folder");
    for (size_t i = 0; i < ev->options.include_path_count; i++) {
        text_printf(&list, ", `%s`", ev->options.include_paths[i]);
    }
    diag_note(ev->options.diags, SPAN_NONE, "%s", text_get(&list));
    text_fini(&list);
}

// The folder of the file in which the directive stands, if the wanted file is there.
static bool suggest_own_folder(Eval *ev, Search *search, Span span)
{
    SourceLocation location;
    bool is_there = false;
    if (is_absolute(search->name) || !source_locate(ev->options.sources, span, &location)) {
        return false;
    }
    const char *slash = strrchr(location.name, '/');
    if (slash != NULL) {
        char *folder = arena_copy_text(&ev->scratch, location.name, (size_t)(slash - location.name));
        is_there = folder != NULL && exists(&search->path, folder, search->name, "");
        if (is_there) {
            diag_suggest(ev->options.diags, "it stands beside this file, where nothing is searched: add `-I %s`",
                         folder);
        }
    }
    return is_there;
}

static void report_missing(Eval *ev, Search *search, const AstNode *node)
{
    Span span = node->span;
    ev->include_is_missing = true;
    if (eval_report(ev, DIAG_E0501, span, "include file `%s` not found", search->name)) {
        note_folders(ev);
        if (!suggest_own_folder(ev, search, span)) {
            suggest_near_name(ev, search->name, node);
        }
    }
}

// ---- opening

static void report_result(Eval *ev, SourceResult result, const char *path, int error_number, Span span)
{
    switch (result) {
    case SOURCE_OK: break;
    case SOURCE_NOT_FOUND: eval_fault(ev, DIAG_E0501, span, "include file `%s` not found", path); break;
    case SOURCE_NOT_READABLE:
        eval_fault(ev, DIAG_E0502, span, "cannot read `%s`: %s", path, strerror(error_number));
        break;
    case SOURCE_IS_DIRECTORY: eval_fault(ev, DIAG_E0503, span, "`%s` is a directory, not a scene", path); break;
    case SOURCE_TOO_LARGE:
        eval_fault(ev, DIAG_E0504, span, "with `%s` the scene is larger than %llu bytes", path,
                   (unsigned long long)ev->options.limits->text_bytes);
        ev->stop = true;
        break;
    case SOURCE_NO_MEMORY: eval_no_memory(ev, span); break;
    }
}

static bool open_found(Eval *ev, const char *path, Span span, Source **source)
{
    int error_number = 0;
    uint64_t read = source_bytes_read(ev->options.sources);
    uint64_t limit = ev->options.limits->text_bytes;
    SourceResult result = source_open_file(ev->options.sources, path, limit > read ? limit - read : 0, source,
                                           &error_number);
    report_result(ev, result, path, error_number, span);
    return result == SOURCE_OK;
}

static bool open_named(Eval *ev, const AstNode *node, Source **source)
{
    Value name;
    if (!eval_string(ev, node->a, &name)) {
        return false;
    }
    Search search = {.name = name.text};
    text_init(&search.path);
    bool is_found = find(ev, &search);
    if (search.path.failed) {
        eval_no_memory(ev, node->a->span);
    } else if (!is_found) {
        report_missing(ev, &search, node->a);
    } else {
        is_found = open_found(ev, text_get(&search.path), node->a->span, source);
    }
    text_fini(&search.path);
    return is_found && !ev->stop;
}

// ---- reading

static bool take_item(void *client, const AstNode *item)
{
    Eval *ev = client;
    eval_item(ev, item);
    return !ev->stop;
}

static bool enter(Eval *ev, DiagFrame *frame, const Source *source, Span span)
{
    if (!scope_push(ev, span)) {
        return false;
    }
    ev->include_depth++;
    eval_frame_enter(ev, frame, "included", source_name(source), span);
    return true;
}

// At the top level: item by item.
static void stream(Eval *ev, Source *source, const GrammarContext *context, Span span)
{
    DiagFrame frame;
    if (!enter(ev, &frame, source, span)) {
        return;
    }
    // What it finds stands in the diagnostics, which decide in the end.
    bool is_whole = grammar_parse(context, source, take_item, ev);
    ev->faulty = ev->faulty || !is_whole;
    scope_pop(ev);
    eval_frame_leave(ev);
    ev->include_depth--;
}

// A text with items that directives tear apart: read again, item by item.
static void splice_again(Cursor *cursor, CursorFrame *frame, const Source *source, const GrammarContext *context)
{
    Eval *ev = cursor->ev;
    GrammarText *text = grammar_text_again(context, source_extent(source));
    frame->next = NULL;
    if (text == NULL || !cursor_push_text(cursor, frame, text, text, false)) {
        ev->faulty = true;
    }
}

// Inside a block: all items, kept until the block is closed.
static void splice(Cursor *cursor, Source *source, const GrammarContext *context, Span span)
{
    Eval *ev = cursor->ev;
    AstList items = {0};
    if (!cursor->included) {
        cursor->included = true;
        cursor->mark = arena_mark(&ev->parse);
    }
    CursorFrame *frame = cursor_push(cursor, FRAME_ITEMS, NULL, NULL);
    if (frame == NULL || !enter(ev, &frame->diag, source, span)) {
        return;
    }
    frame->kind = FRAME_INCLUDE;
    bool is_torn = false;
    bool is_whole = grammar_parse_all(context, source, &items, &is_torn);
    frame->next = items.first;
    if (is_torn) {
        splice_again(cursor, frame, source, context);
    } else {
        ev->faulty = ev->faulty || !is_whole;
    }
}

static Source *open_included(Eval *ev, const AstNode *node)
{
    Source *source = NULL;
    if (ev->include_depth >= ev->options.limits->include_depth) {
        eval_fault(ev, DIAG_E0603, node->a->span, "includes nest deeper than %u levels: does a file include itself?",
                   ev->options.limits->include_depth);
        ev->stop = true;
        return NULL;
    }
    return open_named(ev, node, &source) ? source : NULL;
}

Source *include_enter(Eval *ev, CursorFrame *frame, const AstNode *node)
{
    Source *source = open_included(ev, node);
    if (source == NULL) {
        return NULL;
    }
    if (!enter(ev, &frame->diag, source, node->span)) {
        source_close(source);
        return NULL;
    }
    frame->kind = FRAME_INCLUDE;
    return source;
}

void include_run(Cursor *cursor, const AstNode *node)
{
    Eval *ev = cursor->ev;
    Source *source = open_included(ev, node);
    if (source == NULL) {
        return;
    }
    Splice reading;
    splice_init(&reading, ev);
    if (cursor->top) {
        stream(ev, source, &reading.context, node->span);
    } else {
        splice(cursor, source, &reading.context, node->span);
    }
    splice_fini(&reading);
    source_close(source);
}
