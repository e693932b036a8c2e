// Finds rtlang's own include files, POV-Ray's and Open Babel's.
//
// POV-Ray finds its files by the first povray.ini of those that its manual lists ("INI Files" of its Unix
// part, "Using INI Files"); that file's lines `Library_Path=FOLDER` and `+LFOLDER` are read, up to the first
// `[section]`. A povray.ini in the current folder is left out: it would come along with a scene, which could then
// choose what it may read. Knows nothing of scenes.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/library.h"

#include <errno.h>
#include <glob.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/install.h"

#ifndef POVRAY_INCLUDES
#error "the build names the folder of POV-Ray's include files, or none: -DPOVRAY_INCLUDES=\"...\""
#endif

static const char blanks[] = " \t\r\n";

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

// Takes over the path, if it is not NULL for want of memory and not in the list.
static void take(Library *library, char *path)
{
    bool is_new = path != NULL;
    library->failed = library->failed || !path;
    for (size_t i = 0; is_new && i < library->folders.count; i++) {
        is_new = strcmp(library->folders.items[i], path) != 0;
    }
    if (is_new && ARRAY_PUSH(&library->folders, path)) {
        return;
    }
    library->failed = library->failed || is_new;
    free(path);
}

// Adds a folder if it is there.
static void add(Library *library, const char *folder)
{
    if (!is_folder(folder)) {
        return;
    }
    char *real = realpath(folder, NULL);
    if (real || errno == ENOMEM) { // otherwise it has just gone
        take(library, real);
    }
}

// The first place where they are. Where they are in none, messages are to say where they should be.
static void add_own(Library *library)
{
    char folder[PATH_MAX];
    for (unsigned i = 0; i < INSTALL_PLACES && library->folders.count == 0; i++) {
        if (install_place(INSTALL_DATA, i, folder)) {
            add(library, folder);
        }
    }
    bool is_nowhere = library->folders.count == 0;
    for (unsigned i = 0; is_nowhere && i < INSTALL_PLACES; i++) {
        if (install_place(INSTALL_DATA, i, folder)) {
            take(library, strdup(folder));
        }
    }
}

// ---- povray.ini

// Adds the folder that the text begins with: in quotes of either kind, or up to a blank or a comment. Returns what
// follows.
static char *add_value(Library *library, char *text)
{
    bool is_quoted = *text == '"' || *text == '\'';
    char quote[2] = {*text, '\0'};
    text += is_quoted;
    char *end = text + strcspn(text, is_quoted ? quote : " \t\r\n;");
    char after = *end;
    *end = '\0';
    add(library, text);
    *end = after;
    return end + (is_quoted && after != '\0');
}

// `Library_Path = FOLDER`; false when the line is none of these.
static bool add_option(Library *library, char *line)
{
    static const char option[] = "Library_Path";
    char *next = line + sizeof option - 1;
    if (strncasecmp(line, option, sizeof option - 1) != 0) {
        return false;
    }
    next += strspn(next, blanks);
    if (*next == '=') {
        next++;
        next += strspn(next, blanks);
        add_value(library, next);
    }
    return true;
}

// A line of switches.
static void add_switches(Library *library, char *line)
{
    for (char *next = line; *next == '+' || *next == '-'; next += strspn(next, blanks)) {
        bool is_path = next[1] == 'L' || next[1] == 'l';
        next = is_path ? add_value(library, next + 2) : next + strcspn(next, " \t\r\n;");
    }
}

// False when there is no such file.
static bool read_ini(Library *library, const char *path)
{
    FILE *file = fopen(path, "re");
    char *line = NULL;
    size_t size = 0;
    bool is_section = false, has_memory = file || errno != ENOMEM;
    while (!is_section && file && getline(&line, &size, file) >= 0) {
        char *text = line + strspn(line, blanks);
        is_section = *text == '[';
        if (!is_section && !add_option(library, text)) {
            add_switches(library, text);
        }
    }
    // A read that fails for want of memory sets no error of the stream.
    has_memory = has_memory && (!file || is_section || feof(file) || ferror(file));
    library->failed = library->failed || !has_memory;
    free(line);
    if (file) {
        (void)fclose(file);
    }
    return file != NULL;
}

static bool read_ini_at_home(Library *library, const char *name)
{
    const char *home = secure_getenv("HOME");
    char path[PATH_MAX];
    return home && home[0] == '/' && snprintf(path, sizeof path, "%s/%s", home, name) < (int)sizeof path &&
           read_ini(library, path);
}

static void add_from_ini(Library *library)
{
    static const char *const places[] = {"/usr/local/etc/povray/3.7/povray.ini", "/etc/povray/3.7/povray.ini"};
    static const char *const old_places[] = {"/usr/local/etc/povray.ini", "/etc/povray.ini"};
    const char *chosen = secure_getenv("POVINI");
    if (chosen && chosen[0] != '\0') {
        (void)read_ini(library, chosen); // POV-Ray reads no other one then
        return;
    }
    bool is_read = read_ini_at_home(library, ".povray/3.7/povray.ini");
    for (size_t i = 0; !is_read && i < RT_COUNT_OF(places); i++) {
        is_read = read_ini(library, places[i]);
    }
    is_read = is_read || read_ini_at_home(library, ".povrayrc");
    for (size_t i = 0; !is_read && i < RT_COUNT_OF(old_places); i++) {
        is_read = read_ini(library, old_places[i]);
    }
}

// ---- other places

static int is_memory_wanting(const char *path, int error)
{
    (void)path;
    return error == ENOMEM;
}

// Open Babel's scenes include a file that lies with its data, in a folder named by its version.
static void add_open_babel(Library *library)
{
    glob_t found;
    int result = glob("/usr/share/openbabel/*", GLOB_ONLYDIR, is_memory_wanting, &found);
    library->failed = library->failed || result == GLOB_NOSPACE || result == GLOB_ABORTED;
    if (result == 0) {
        for (size_t i = 0; i < found.gl_pathc; i++) {
            add(library, found.gl_pathv[i]);
        }
        globfree(&found);
    }
}

static void add_povray(Library *library)
{
    static const char *const places[] = {
        "/usr/share/povray-3.7/include",   "/usr/local/share/povray-3.7/include", "/usr/share/povray/include",
        "/usr/local/share/povray/include", "/usr/share/povray-3.8/include",       "/usr/local/share/povray-3.8/include",
    };
    add_from_ini(library);
    if (POVRAY_INCLUDES[0] != '\0') {
        add(library, POVRAY_INCLUDES);
    }
    for (size_t i = 0; i < RT_COUNT_OF(places); i++) {
        add(library, places[i]);
    }
    add_open_babel(library);
}

bool library_fill(Library *library)
{
    if (!library->is_filled) {
        library->is_filled = true;
        add_own(library);
        if (!library->has_no_povray) {
            add_povray(library);
        }
    }
    return !library->failed;
}

void library_fini(Library *library)
{
    for (size_t i = 0; i < library->folders.count; i++) {
        free(library->folders.items[i]);
    }
    ARRAY_FREE(&library->folders);
    *library = (Library){0};
}

bool library_is_standard(const char *name)
{
    static const char names[] =
        " arrays chars colors consts debug finish functions glass glass_old golds ior logo makegrass math meshmaker"
        " metals rad_def rand screen shapes shapes2 shapes3 shapes_old shapesq skies stage1 stars stdcam stdinc "
        "stoneold"
        " stones stones1 stones2 strings sunpos textures transforms woodmaps woods ";
    const char *ending = strrchr(name, '.');
    size_t length = ending && strcmp(ending, ".inc") == 0 ? (size_t)(ending - name) : strlen(name);
    char wanted[32];
    return strcspn(name, " ") >= length && length > 0 &&
           snprintf(wanted, sizeof wanted, " %.*s ", (int)length, name) < (int)sizeof wanted &&
           strstr(names, wanted);
}
