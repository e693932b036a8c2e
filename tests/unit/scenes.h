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

#include "unit/tap.h"

// `folder` is where a scene's includes are; `number` counts from 0.
typedef void (*SceneTest)(void *client, const char *folder, const char *path, size_t number);

// Whether a scene names a file of POV-Ray's that is not on this machine.
static bool scene_lacks_files(const char *path)
{
    static const char *const named[] = {"functions.inc", ".ttf"};
    char line[4096];
    FILE *text = fopen(path, "r");
    glob_t found;
    bool is_named = false;
    while (text && !is_named && fgets(line, sizeof line, text)) {
        for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
            is_named = is_named || strstr(line, named[i]);
        }
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

// Tries each, but for those that lack POV-Ray's files; that there are any is a case of its own. Returns how many there are.
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
            if (scene_lacks_files(found.gl_pathv[count])) {
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
