// Files that a scene reads: where they are looked for, whether they may be read, and opening them.
//
// A name is looked for in the current folder, then in the include paths, then in the library path, never beside the
// including file, as in POV-Ray. What is found must lie, all links resolved, below the scene's folder, one of these
// paths or a folder that was allowed: a scene that somebody else wrote cannot look around. Owns the resolved folders.
// Knows nothing of what is in the files.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/suggest.h"
#include "eval/run/run.h"

enum { LINKS_MOST = 40 }; // as many as the kernel follows

struct FileState {
    ARRAY(char *) roots; // real paths of the folders that may be read; the first of them may be written to
    size_t written;      // so many of them
    TextBuffer checked;  // the path that was found readable last
    TextBuffer real;     // the same, all links resolved
};

// How files of each use are called, and what is looked for under a name that is not found.
static const struct {
    const char *what;
    const char *ending; // POV-Ray adds it to a name that has none; NULL: it adds none
} uses[] = {
    [FILE_INCLUDE] = {"include file", ".inc"},
    [FILE_DATA] = {"data file", NULL},
    [FILE_IMAGE] = {"image file", NULL},
    [FILE_FONT] = {"font", NULL},
};

typedef struct Search {
    const char *name;
    TextBuffer path; // the file that was found
    bool failed;     // memory ran out for the path of one that may be there
} Search;

// ---- folders that may be read

static bool add_root(FileState *files, const char *folder)
{
    char *real = realpath(folder, NULL);
    if (real == NULL) {
        return errno != ENOMEM; // what is not there holds no files
    }
    if (!ARRAY_PUSH(&files->roots, real)) {
        free(real);
        return false;
    }
    return true;
}

static bool add_folder_of(FileState *files, const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash == NULL ? strdup(".") : strndup(path, (size_t)(slash - path) + 1);
    bool fine = folder != NULL && add_root(files, folder);
    free(folder);
    return fine;
}

bool files_init(Eval *ev, const Source *scene)
{
    const EvalOptions *options = &ev->options;
    FileState *files = ev->files = calloc(1, sizeof *files);
    if (files == NULL) {
        return false;
    }
    text_init(&files->checked);
    text_init(&files->real);
    bool fine = true;
    for (size_t i = 0; fine && i < options->write_folder_count; i++) {
        fine = add_root(files, options->write_folders[i]);
    }
    files->written = files->roots.count;
    fine = fine && add_folder_of(files, source_name(scene));
    for (size_t i = 0; fine && i < options->include_path_count; i++) {
        fine = add_root(files, options->include_paths[i]);
    }
    for (size_t i = 0; fine && i < options->read_folder_count; i++) {
        fine = add_root(files, options->read_folders[i]);
    }
    return fine;
}

void files_fini(Eval *ev)
{
    FileState *files = ev->files;
    if (files == NULL) {
        return;
    }
    for (size_t i = 0; i < files->roots.count; i++) {
        free(files->roots.items[i]);
    }
    ARRAY_FREE(&files->roots);
    text_fini(&files->checked);
    text_fini(&files->real);
    free(files);
    ev->files = NULL;
}

const char *file_folder(const Eval *ev, size_t i)
{
    size_t given = ev->options.include_path_count;
    Library *library = ev->options.library;
    if (i < given) {
        return ev->options.include_paths[i];
    }
    bool is_there = library != NULL && library_fill(library) && i - given < library->folders.count;
    return is_there ? library->folders.items[i - given] : NULL;
}

static bool lies_below(const char *path, const char *root)
{
    size_t length = strlen(root);
    length -= length > 0 && root[length - 1] == '/'; // the root of all
    return strncmp(path, root, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

// The length of a path without its last part and what stands before that: 0 for a path of one part.
static size_t parent_length(const char *path, size_t length)
{
    while (length > 0 && path[length - 1] != '/') {
        length--;
    }
    while (length > 0 && path[length - 1] == '/') {
        length--;
    }
    return length;
}

// The longest beginning of a path that is there, resolved, or else, as *is_link, what the link says that leads to
// nowhere. *length is that of the beginning. The caller frees it.
static char *beginning_of(char *path, size_t *length, bool *is_link)
{
    char target[PATH_MAX];
    for (*length = strlen(path);; *length = parent_length(path, *length)) {
        char after = path[*length];
        path[*length] = '\0';
        char *real = realpath(*length > 0 ? path : path[0] == '\0' && after == '/' ? "/" : ".", NULL);
        ptrdiff_t linked = real == NULL && *length > 0 ? readlink(path, target, sizeof target - 1) : -1;
        path[*length] = after;
        *is_link = linked > 0;
        if (real != NULL || linked > 0) {
            return real != NULL ? real : strndup(target, (size_t)linked);
        }
        if (*length == 0) {
            return NULL;
        }
    }
}

// Where a path leads, whether a file is there or not: the real path of the longest beginning that is there, and the
// rest as it is written. Links to nowhere are followed, too. The caller frees it; NULL: out of memory, or no end of
// links.
static char *place_of(const char *path)
{
    char *name = strdup(path);
    for (unsigned links = 0; name != NULL && links <= LINKS_MOST; links++) {
        size_t length;
        bool is_link;
        TextBuffer joined;
        char *beginning = beginning_of(name, &length, &is_link);
        const char *rest = name + length;
        size_t folder = length; // of the link
        while (folder > 0 && name[folder - 1] != '/') {
            folder--;
        }
        text_init(&joined);
        if (beginning != NULL) {
            bool is_top = strcmp(beginning, "/") == 0;
            text_append_n(&joined, name, is_link && beginning[0] != '/' ? folder : 0);
            text_append(&joined, is_top ? "" : beginning);
            text_printf(&joined, "%s%s", rest[0] == '\0' || rest[0] == '/' ? "" : "/", rest);
        }
        free(name);
        free(beginning);
        name = beginning != NULL && !joined.failed ? strdup(text_get(&joined)) : NULL;
        text_fini(&joined);
        if (name != NULL && !is_link) {
            return name;
        }
    }
    free(name);
    return NULL;
}

// The folder of a path as it is written, or the one that it leads to when it is a link.
static void folder_to_allow(const char *path, const char *real, char *folder, size_t size)
{
    const char *slash = strrchr(path, '/'), *real_slash = strrchr(real, '/');
    size_t real_length = real_slash > real ? (size_t)(real_slash - real) : 1;
    int length = slash == NULL || slash == path ? 1 : (int)(slash - path);
    snprintf(folder, size, "%.*s", length, slash == NULL ? "." : path);
    char *place = place_of(folder);
    if (place == NULL || strlen(place) != real_length || strncmp(place, real, real_length) != 0) {
        snprintf(folder, size, "%.*s", (int)real_length, real);
    }
    free(place);
}

// Whether a file is one that a standard folder names, whatever that leads to: the packages that install POV-Ray's fonts
// put them elsewhere, and links to them there.
static bool is_standard(const Eval *ev, const char *path)
{
    const char *folder, *slash = strrchr(path, '/');
    for (size_t i = ev->options.include_path_count; slash && (folder = file_folder(ev, i)) != NULL; i++) {
        if ((size_t)(slash - path) == strlen(folder) && strncmp(path, folder, strlen(folder)) == 0) {
            return true;
        }
    }
    return false;
}

static bool is_allowed(const Eval *ev, const char *real)
{
    const char *folder;
    for (size_t i = 0; i < ev->files->roots.count; i++) {
        if (lies_below(real, ev->files->roots.items[i])) {
            return true;
        }
    }
    for (size_t i = ev->options.include_path_count; (folder = file_folder(ev, i)) != NULL; i++) {
        if (lies_below(real, folder)) {
            return true;
        }
    }
    return false;
}

// Says of a file that is there and of one that is not the same: whether there is one is not the scene's to know.
static bool fault_outside(Eval *ev, const char *path, const char *real, Span span)
{
    char folder[PATH_MAX];
    if (eval_report(ev, DIAG_E0508, span, "`%s` lies outside the folders that this scene may read", path)) {
        diag_note(ev->options.diags, SPAN_NONE,
                  "a scene reads below its own folder, the `-I` folders, those of the "
                  "standard include files and what `--allow-read` names, all links "
                  "resolved");
        folder_to_allow(path, real, folder, sizeof folder);
        diag_suggest(ev->options.diags, "pass `--allow-read %s` to allow it", folder);
    }
    return false;
}

// Reports a name that leads to no file, and out of the folders that may be read. A name that stays in the current
// folder is more likely mistyped.
static bool is_outside(Eval *ev, const char *name, Span span)
{
    char *place = place_of(name), *current = realpath(".", NULL);
    bool is_out = place != NULL && current != NULL && !lies_below(place, current) && !is_allowed(ev, place) &&
                  !fault_outside(ev, name, place, span);
    free(place);
    free(current);
    return is_out;
}

// A file that exists. The answer for a path holds until another is asked for, so that a file that is included a
// million times is looked up once.
static bool may_read(Eval *ev, const char *path, FileUse use, Span span)
{
    FileState *files = ev->files;
    if (files->checked.length > 0 && strcmp(text_get(&files->checked), path) == 0) {
        return true;
    }
    char *real = realpath(path, NULL);
    if (real == NULL) {
        return errno == ENOMEM ? eval_no_memory(ev, span)
                               : eval_fault(ev, DIAG_E0502, span, "cannot read `%s`: %s", path, strerror(errno));
    }
    bool is_below =
        is_allowed(ev, real) || (use == FILE_FONT && is_standard(ev, path)) || fault_outside(ev, path, real, span);
    text_clear(&files->checked);
    text_clear(&files->real);
    if (is_below) {
        text_append(&files->checked, use == FILE_FONT ? "" : path); // what a font may be, others may not
        text_append(&files->real, real);
    }
    free(real);
    bool has_memory = !files->checked.failed && !files->real.failed;
    return is_below && (has_memory || eval_no_memory(ev, span));
}

// Looking for a file and opening it takes as long as so many bytes of strings: 200 steps, 15 microseconds.
enum { WORK_OF_A_FILE = 200 * 256 };

// The name is looked through for each folder; it may be as long as a string.
static bool take_work(Eval *ev, const char *name, Span span)
{
    enum { WORK_OF_A_LETTER = 64 };
    return eval_work(ev, WORK_OF_A_FILE + WORK_OF_A_LETTER * strlen(name), span);
}

bool file_may_write(Eval *ev, const char *name, Span span, char *real)
{
    const FileState *files = ev->files;
    char folder[PATH_MAX], *place;
    bool is_below = false;
    if (!take_work(ev, name, span)) {
        return false;
    }
    place = place_of(name);
    for (size_t i = 0; place != NULL && i < files->written; i++) {
        is_below = is_below || lies_below(place, files->roots.items[i]);
    }
    bool fits = place != NULL && snprintf(real, PATH_MAX, "%s", place) < PATH_MAX;
    if (!fits) {
        eval_fault(ev, DIAG_E0505, span, "cannot write `%s`: %s", name, strerror(ENAMETOOLONG));
    } else if (!is_below && eval_report(ev, DIAG_E0269, span, "this scene may not write `%s`", name)) {
        folder_to_allow(name, place, folder, sizeof folder);
        diag_suggest(ev->options.diags, "pass `--allow-write %s` to allow it", folder);
    }
    free(place);
    return fits && is_below;
}

// ---- looking

static bool is_absolute(const char *name)
{
    return name[0] == '/';
}

static bool has_ending(const char *name)
{
    const char *slash = strrchr(name, '/');
    return strchr(slash != NULL ? slash : name, '.') != NULL;
}

static bool exists(Search *search, const char *folder, const char *ending)
{
    TextBuffer *path = &search->path;
    text_clear(path);
    if (folder[0] != '\0') {
        text_printf(path, "%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/");
    }
    text_printf(path, "%s%s", search->name, ending);
    search->failed = search->failed || path->failed;
    return !path->failed && access(text_get(path), F_OK) == 0;
}

static bool find_with(const Eval *ev, Search *search, const char *ending)
{
    const char *folder;
    if (exists(search, "", ending)) {
        return true;
    }
    for (size_t i = 0; !is_absolute(search->name) && (folder = file_folder(ev, i)) != NULL; i++) {
        if (exists(search, folder, ending)) {
            return true;
        }
    }
    return false;
}

static bool find(const Eval *ev, Search *search, const char *ending)
{
    return find_with(ev, search, "") || (ending != NULL && !has_ending(search->name) && find_with(ev, search, ending));
}

// Memory ran out, so that a file may not have been found.
static bool search_failed(const Eval *ev, const Search *search)
{
    return search->failed || (ev->options.library != NULL && ev->options.library->failed);
}

bool file_is_there(Eval *ev, const Value *name, Span span, bool *is_there)
{
    if (!take_work(ev, name->text, span)) {
        return false;
    }
    Search search = {.name = name->text};
    text_init(&search.path);
    *is_there = find(ev, &search, NULL);
    bool fine = search_failed(ev, &search) ? eval_no_memory(ev, span)
                : *is_there                ? may_read(ev, text_get(&search.path), FILE_INCLUDE, span)
                                           : !is_outside(ev, search.name, span);
    text_fini(&search.path);
    return fine;
}

// ---- a file that is not found

// The name stands in the text as it is when it is one string.
static void suggest_near_name(Eval *ev, const char *name, const AstNode *node)
{
    Suggest suggest;
    const char *folder;
    suggest_begin(&suggest, name);
    for (size_t i = 0; name_standard_file(i) != NULL; i++) {
        suggest_offer(&suggest, name_standard_file(i));
    }
    ArenaMark mark = arena_mark(&ev->scratch);
    suggest_offer_folder(&suggest, &ev->scratch, ".");
    for (size_t i = 0; (folder = file_folder(ev, i)) != NULL; i++) {
        suggest_offer_folder(&suggest, &ev->scratch, folder);
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
    const char *folder;
    text_init(&list);
    text_append(&list, "searched in the current folder");
    for (size_t i = 0; (folder = file_folder(ev, i)) != NULL; i++) {
        text_printf(&list, ", `%s`", folder);
    }
    ev->options.diags->out_of_memory |= list.failed;
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
        is_there = folder != NULL && exists(search, folder, "");
        if (is_there) {
            diag_suggest(ev->options.diags, "it stands beside this file, where nothing is searched: add `-I %s`",
                         folder);
        }
    }
    return is_there;
}

static void report_missing(Eval *ev, Search *search, FileUse use, const AstNode *node)
{
    Span span = node->span;
    ev->include_is_missing = ev->include_is_missing || use == FILE_INCLUDE;
    if (is_outside(ev, search->name, span)) {
        return;
    }
    if (eval_report(ev, DIAG_E0501, span, "%s `%s` not found", uses[use].what, search->name)) {
        if (!is_absolute(search->name)) {
            note_folders(ev);
        }
        if (suggest_own_folder(ev, search, span)) {
            return;
        }
        if (use == FILE_INCLUDE && library_is_standard(search->name)) {
            diag_suggest(ev->options.diags, "it is one of POV-Ray's include files: install them (on Debian: apt-get "
                                            "install povray-includes), or give their folder with `-I`");
        } else {
            suggest_near_name(ev, search->name, node);
        }
    }
}

// ---- opening

static void report_result(Eval *ev, SourceResult result, const char *path, FileUse use, int error_number, Span span)
{
    switch (result) {
    case SOURCE_OK:
        break;
    case SOURCE_CANCELLED:
        ev->stop = true;
        break;
    case SOURCE_NOT_FOUND:
        eval_fault(ev, DIAG_E0501, span, "%s `%s` not found", uses[use].what, path);
        break;
    case SOURCE_NOT_READABLE:
        eval_fault(ev, DIAG_E0502, span, "cannot read `%s`: %s", path, strerror(error_number));
        break;
    case SOURCE_IS_DIRECTORY:
        eval_fault(ev, DIAG_E0503, span, "`%s` is a directory, not a file", path);
        break;
    case SOURCE_NOT_A_FILE:
        eval_fault(ev, DIAG_E0502, span, "cannot read `%s`: it is a pipe or a device, not a file", path);
        break;
    case SOURCE_TOO_LARGE:
        if (eval_report(ev, DIAG_E0504, span, "with `%s` the scene reads more than %llu bytes of text", path,
                        (unsigned long long)ev->options.limits->text_bytes)) {
            diag_suggest(ev->options.diags, "`--max-text` allows more");
        }
        ev->stop = true;
        break;
    case SOURCE_TOO_MUCH: // files are not kept, but for those that the kernel makes while they are read
    case SOURCE_NO_MEMORY:
        eval_no_memory(ev, span);
        break;
    }
}

// Opens what may_read has just found readable.
static bool open_found(Eval *ev, const char *path, FileUse use, Span span, Source **source)
{
    int error_number = 0;
    uint64_t read = source_bytes_read(ev->options.sources);
    uint64_t limit = ev->options.limits->text_bytes;
    SourceResult result = source_open_real(ev->options.sources, text_get(&ev->files->real), path,
                                           limit > read ? limit - read : 0, source, &error_number);
    report_result(ev, result, path, use, error_number, span);
    return result == SOURCE_OK;
}

bool file_open(Eval *ev, const AstNode *name_node, FileUse use, Source **source)
{
    Value name;
    if (!eval_string(ev, name_node, &name) || !take_work(ev, name.text, name_node->span)) {
        return false;
    }
    Search search = {.name = name.text};
    text_init(&search.path);
    bool is_found = find(ev, &search, uses[use].ending);
    if (search_failed(ev, &search)) {
        eval_no_memory(ev, name_node->span);
    } else if (!is_found) {
        report_missing(ev, &search, use, name_node);
    } else {
        is_found = may_read(ev, text_get(&search.path), use, name_node->span) &&
                   open_found(ev, text_get(&search.path), use, name_node->span, source);
        ev->include_is_missing = ev->include_is_missing || (!is_found && use == FILE_INCLUDE);
    }
    text_fini(&search.path);
    return is_found && !ev->stop;
}

// A text that is kept as long as the names are; NULL when out of memory.
static const char *keep_text(Eval *ev, const TextBuffer *text)
{
    Symbol symbol = intern_text(ev->options.names, text_get(text), text->length);
    return symbol != SYMBOL_NONE ? eval_text(ev, symbol) : NULL;
}

const char *file_find(Eval *ev, const AstNode *name_node, const char *text, FileUse use, const char *const *endings,
                      const char **real)
{
    if (!take_work(ev, text, name_node->span)) {
        return NULL;
    }
    Search search = {.name = text};
    text_init(&search.path);
    bool is_found = find(ev, &search, NULL);
    for (; !is_found && *endings != NULL && !has_ending(text); endings++) {
        is_found = find(ev, &search, *endings);
    }
    const char *path = NULL;
    if (search_failed(ev, &search)) {
        eval_no_memory(ev, name_node->span);
    } else if (!is_found) {
        report_missing(ev, &search, use, name_node);
    } else if (may_read(ev, text_get(&search.path), use, name_node->span)) {
        *real = keep_text(ev, &ev->files->real);
        path = *real ? keep_text(ev, &search.path) : NULL;
        if (path == NULL) {
            eval_no_memory(ev, name_node->span);
        }
    }
    text_fini(&search.path);
    return path;
}
