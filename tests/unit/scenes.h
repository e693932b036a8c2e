// Scenes to try something on: the files of the source tree that match a pattern, in the order of their names.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_SCENES_H
#define UNIT_SCENES_H

#include <glob.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "unit/tap.h"

// `folder` is where a scene's includes are; `number` counts from 0.
typedef void (*SceneTest)(void *client, const char *folder, const char *path, size_t number);

// Tries each; that there are any is a case of its own. Returns how many there are.
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
            test(client, folder, found.gl_pathv[count], count);
        }
        globfree(&found);
    }
    return count;
}

#endif
