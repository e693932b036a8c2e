// What is set before a scene is read, and reading it.
//
// SPDX-License-Identifier: MIT
#include "check/load.h"

#include <stddef.h>

rt_status scene_load(rt_session *session, const Options *options, char *const *include_paths, const char *scene,
                     const World *world)
{
    rt_status status = rt_set_size(session, options->width, options->height);

    for (int i = 0; status == RT_OK && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, include_paths[i]);
    }
    if (status == RT_OK && options->clock_given) {
        status = rt_set_clock(session, options->clock);
    }
    if (status == RT_OK && world != NULL) {
        status = rt_set_world(session, world->scale, world->shift);
    }
    return status == RT_OK ? rt_load_file(session, scene) : status;
}
