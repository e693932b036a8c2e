// Scenes to try something on: the files of the source tree that match a pattern, in the order of their names.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_SCENES_H
#define UNIT_SCENES_H

#include <glob.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "unit/tap.h"

// `folder` is where a scene's includes are; `number` counts from 0.
typedef void (*SceneTest)(void *client, const char *folder, const char *path, size_t number);

static bool scene_file_is_in(const char *folder, const char *name)
{
    char path[8192];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, R_OK) == 0;
}

// Whether a scene wants a file of POV-Ray's that is not on this machine: a font, or an include file that is neither
// beside the scene nor in `folder`.
static bool scene_lacks_files(const char *path, const char *folder)
{
    char line[4096], beside[4096], name[256];
    FILE *text = fopen(path, "r");
    glob_t found;
    bool is_named = false;
    snprintf(beside, sizeof beside, "%s", path);
    *strrchr(beside, '/') = '\0';
    while (text && !is_named && fgets(line, sizeof line, text)) {
        const char *at = strstr(line, "#include");
        bool includes = at && sscanf(at, "#include \"%255[^\"]\"", name) == 1;
        is_named =
            strstr(line, ".ttf") || (includes && !scene_file_is_in(beside, name) && !scene_file_is_in(folder, name));
    }
    if (text) {
        fclose(text);
    }
    bool is_there = !is_named || glob("/usr/share/povray*/include/functions.inc", 0, NULL, &found) == 0;
    if (is_named && is_there) {
        globfree(&found);
    }
    return !is_there;
}

// Tries each, but for those that lack POV-Ray's files; that there are any is a case of its own. Returns how many there
// are.
__attribute__((unused)) static size_t scenes_try(const char *pattern, SceneTest test, void *client)
{
    const char *top = getenv("top_srcdir");
    char path[4096], folder[4096];
    size_t count = 0;
    glob_t found;
    snprintf(path, sizeof path, "%s/%s", top ? top : ".", pattern);
    snprintf(folder, sizeof folder, "%s/share/rtlang", top ? top : ".");
    if (tap_ok(glob(path, 0, NULL, &found) == 0, "there are scenes %s", pattern)) {
        for (; count < found.gl_pathc; count++) {
            if (scene_lacks_files(found.gl_pathv[count], folder)) {
                tap_skip(found.gl_pathv[count], "POV-Ray's include files are not installed");
            } else {
                test(client, folder, found.gl_pathv[count], count);
            }
        }
        globfree(&found);
    }
    return count;
}

#endif
