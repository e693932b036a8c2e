// Where a name that is not declared may come from: the include files at hand that declare it.
//
// Looks through the text of the files in the include folders, then through the list of what POV-Ray's own files
// declare, when a fault is reported and not before. Owns the list of what the first declare; knows nothing of scopes.
//
// SPDX-License-Identifier: MIT
#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "eval/run/run.h"

enum {
    BYTES_MOST = 1 << 20,  // of a file
    NAMES_MOST = 16 << 20, // bytes of names that are kept
};

static bool is_name_byte(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

// Behind a `//` in its line.
static bool is_in_comment(const char *text, const char *at)
{
    bool is_behind = false;
    for (; at > text && at[-1] != '\n' && !is_behind; at--) {
        is_behind = at[-1] == '/' && at[0] == '/';
    }
    return is_behind;
}

// What the files at hand declare, each looked through once.
struct Origins {
    InternTable *names;
    ARRAY(Symbol) files; // by the symbol of a name: that of the file that declares it first, or SYMBOL_NONE
};

static bool note_name(Origins *origins, const char *name, size_t length, Symbol file)
{
    Symbol symbol = intern_text(origins->names, name, length);
    while (symbol != SYMBOL_NONE && origins->files.count <= symbol) {
        if (!ARRAY_PUSH(&origins->files, SYMBOL_NONE)) {
            return false;
        }
    }
    if (symbol != SYMBOL_NONE && origins->files.items[symbol] == SYMBOL_NONE) {
        origins->files.items[symbol] = file;
    }
    return symbol != SYMBOL_NONE;
}

// Behind the word of a directive that declares, else NULL.
static const char *behind_directive(const char *hash)
{
    static const char *const directives[] = {"#declare", "#macro"};
    for (size_t i = 0; i < RT_COUNT_OF(directives); i++) {
        size_t length = strlen(directives[i]);
        if (strncmp(hash, directives[i], length) == 0) {
            return hash + length;
        }
    }
    return NULL;
}

// Each name behind a `#declare` or `#macro`; in a longer comment it counts as well.
static void note_names(Origins *origins, const char *text, Symbol file)
{
    for (const char *at = strchr(text, '#'); at != NULL; at = strchr(at + 1, '#')) {
        const char *behind = behind_directive(at), *word = behind;
        while (word != NULL && is_blank(*word)) {
            word++;
        }
        const char *end = word;
        while (end != NULL && is_name_byte(*end)) {
            end++;
        }
        if (behind != NULL && word > behind && end > word && !is_in_comment(text, at) &&
            !note_name(origins, word, (size_t)(end - word), file)) {
            return;
        }
    }
}

static void note_file(Origins *origins, const char *folder, const char *file, char *text)
{
    TextBuffer path;
    text_init(&path);
    text_printf(&path, "%s/%s", folder, file);
    FILE *stream = path.failed ? NULL : fopen(text_get(&path), "rb");
    size_t length = stream != NULL ? fread(text, 1, BYTES_MOST - 1, stream) : 0;
    text[length] = '\0';
    if (stream != NULL) {
        (void)fclose(stream);
    }
    text_fini(&path);
    Symbol symbol = intern_text(origins->names, file, strlen(file));
    if (symbol != SYMBOL_NONE) {
        note_names(origins, text, symbol);
    }
}

static int is_include(const struct dirent *entry)
{
    const char *ending = strrchr(entry->d_name, '.');
    return ending != NULL && strcmp(ending, ".inc") == 0 && strlen(entry->d_name) <= NAME_MAX;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

// In the order of names, whatever the order of the folder.
static void note_folder(Origins *origins, const char *folder, char *text)
{
    struct dirent **entries = NULL;
    int count = scandir(folder, &entries, is_include, by_name);
    for (int i = 0; i < count; i++) {
        note_file(origins, folder, entries[i]->d_name, text);
        free(entries[i]);
    }
    free(entries);
}

void origins_fini(Eval *ev)
{
    if (ev->origins != NULL) {
        intern_free(ev->origins->names);
        ARRAY_FREE(&ev->origins->files);
        free(ev->origins);
    }
}

// NULL when out of memory.
static const Origins *origins_of(Eval *ev)
{
    char *text = ev->origins == NULL ? malloc(BYTES_MOST) : NULL;
    Origins *origins = text != NULL ? calloc(1, sizeof *origins) : NULL;
    if (origins != NULL && (origins->names = intern_new(NAMES_MOST)) != NULL) {
        const char *folder;
        for (size_t i = 0; (folder = file_folder(ev, i)) != NULL; i++) {
            note_folder(origins, folder, text);
        }
        ev->origins = origins;
    } else {
        free(origins);
    }
    free(text);
    return ev->origins;
}

// The first file at hand that declares the name, NULL when there is none.
static const char *look_at_hand(Eval *ev, const char *name)
{
    const Origins *origins = origins_of(ev);
    Symbol symbol = origins != NULL ? intern_find(origins->names, name, strlen(name)) : SYMBOL_NONE;
    Symbol file = symbol != SYMBOL_NONE && symbol < origins->files.count ? origins->files.items[symbol] : SYMBOL_NONE;
    return file != SYMBOL_NONE ? intern_get(origins->names, file) : NULL;
}

typedef struct Standard {
    const char *file, *names;
} Standard;

static const Standard standard[] = {
#define STANDARD(file, names) {file, names},
#include "eval/run/standard_names.def"
#undef STANDARD
};

const char *name_standard_file(size_t i)
{
    return i < RT_COUNT_OF(standard) ? standard[i].file : NULL;
}

static bool lists(const char *names, const char *name)
{
    size_t length = strlen(name);
    for (const char *at = strstr(names, name); at != NULL; at = strstr(at + 1, name)) {
        if ((at == names || at[-1] == ' ') && at[length] == ' ') {
            return true;
        }
    }
    return false;
}

// One of the files that come with POV-Ray, when none of the files at hand is meant.
static bool look_in_standard(const char *name, char *file)
{
    for (size_t i = 0; i < RT_COUNT_OF(standard); i++) {
        if (lists(standard[i].names, name)) {
            memcpy(file, standard[i].file, strlen(standard[i].file) + 1);
            return true;
        }
    }
    return false;
}

bool name_find_include(Eval *ev, const char *name, char *file)
{
    const char *found = look_at_hand(ev, name);
    if (found != NULL) {
        memcpy(file, found, strlen(found) + 1);
    }
    return found != NULL || look_in_standard(name, file);
}
