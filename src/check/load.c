// What is set before a scene is read, and reading it.
//
// SPDX-License-Identifier: MIT
#include "check/load.h"

#include "check/say.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void include_paths_free(char **paths, int count)
{
    for (int i = 0; paths && i < count; i++) {
        free(paths[i]);
    }
    free(paths);
}

char **include_paths_find(const Options *options, int *count)
{
    rt_session *session = rt_session_new(NULL);
    const char *folder = NULL;
    rt_status status = session ? RT_OK : RT_FAULT_LIMIT;
    int most = 0;

    for (int i = 0; status == RT_OK && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, options->include_paths[i]);
    }
    while (status == RT_OK && rt_include_path(session, (size_t)most)) {
        most++;
    }
    char **paths = status == RT_OK ? calloc((size_t)most + 1, sizeof *paths) : NULL;
    *count = 0;
    for (int i = 0; paths && i < most; i++) {
        folder = rt_include_path(session, (size_t)i);
        paths[*count] = realpath(folder, NULL);
        if (paths[*count]) {
            (*count)++;
        } else if (i < options->include_path_count) {
            say(options, "%s: %s", folder, strerror(errno));
            include_paths_free(paths, *count);
            paths = NULL;
        }
    }
    rt_session_free(session);
    return paths;
}

rt_status scene_load(rt_session *session, const Options *options, char *const *include_paths, const char *scene,
                     const World *world)
{
    rt_status status = rt_set_size(session, options->width, options->height);

    for (int i = 0; status == RT_OK && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, include_paths[i]);
    }
    for (int i = 0; status == RT_OK && i < options->write_folder_count; i++) {
        status = rt_allow_write(session, options->write_folders[i]);
    }
    if (status == RT_OK && options->clock_given) {
        status = rt_set_clock(session, options->clock);
    }
    if (status == RT_OK && world) {
        status = rt_set_world(session, world->scale, world->shift);
    }
    return status == RT_OK ? rt_load_file(session, scene) : status;
}
