// A scene loaded through rtlang's public header, as rtcheck's options say.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_LOAD_H
#define CHECK_LOAD_H

#include "check/options.h"
#include "rtlang/rtlang.h"

// Where a scene is put: p' = scale p + shift.
typedef struct World {
    double scale; // > 0
    double shift[3];
} World;

// Beside where it is, by `step` times a way whose three lengths are no simple numbers.
static inline World world_beside(double scale, double step)
{
    return (World){scale, {0.6180339887 * step, -0.7548776662 * step, 0.5698402910 * step}};
}

// The folders of the options, then those that rtlang searches by itself, all absolute: POV-Ray runs in another folder,
// and does not know rtlang's include files. NULL when one is not there, which is said. To be released as below.
char **include_paths_find(const Options *options, int *count);
void include_paths_free(char **paths, int count);

// Sets a new session's size, folders (options->include_path_count, absolute) and clock, and loads the scene. `world`
// NULL: it stays where it is.
rt_status scene_load(rt_session *session, const Options *options, char *const *include_paths, const char *scene,
                     const World *world);

#endif
