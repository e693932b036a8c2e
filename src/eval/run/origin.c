// Where a name that is not declared may come from: the include files at hand that declare it.
//
// Looks through the text of the files in the include folders, then through the list of what POV-Ray's own files
// declare, when a fault is reported and not before. Owns nothing; knows nothing of scopes.
//
// SPDX-License-Identifier: MIT
#include <dirent.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "eval/run/run.h"

enum { BYTES_MOST = 1 << 20 };

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

// A `#declare` or `#macro` with the name behind it; in a longer comment it counts as well.
static bool declares(const char *text, const char *name, const char *directive)
{
    size_t length = strlen(name);
    for (const char *next = text, *at; (at = strstr(next, directive)) != NULL;) {
        next = at + strlen(directive);
        const char *word = next;
        while (is_blank(*word)) {
            word++;
        }
        bool is_name = word > next && strncmp(word, name, length) == 0 && !is_name_byte(word[length]);
        if (is_name && !is_in_comment(text, at)) {
            return true;
        }
    }
    return false;
}

static bool file_declares(const char *folder, const char *file, const char *name, char *text)
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
    return declares(text, name, "#declare") || declares(text, name, "#macro");
}

// The first such file of a folder, in the order of names, whatever the order of the folder.
static bool look_in(const char *folder, const char *name, char *text, char found[NAME_MAX + 1])
{
    DIR *directory = opendir(folder);
    found[0] = '\0';
    for (const struct dirent *entry; directory != NULL && (entry = readdir(directory)) != NULL;) {
        const char *ending = strrchr(entry->d_name, '.');
        bool is_wanted = ending != NULL && strcmp(ending, ".inc") == 0 && strlen(entry->d_name) <= NAME_MAX &&
                         (found[0] == '\0' || strcmp(entry->d_name, found) < 0);
        if (is_wanted && file_declares(folder, entry->d_name, name, text)) {
            memcpy(found, entry->d_name, strlen(entry->d_name) + 1);
        }
    }
    if (directory != NULL) {
        closedir(directory);
    }
    return found[0] != '\0';
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

bool name_find_include(const Eval *ev, const char *name, char *file)
{
    char *text = malloc(BYTES_MOST);
    bool is_found = false;
    const char *folder;
    for (size_t i = 0; text != NULL && !is_found && (folder = file_folder(ev, i)) != NULL; i++) {
        is_found = look_in(folder, name, text, file);
    }
    free(text);
    return is_found || look_in_standard(name, file);
}
