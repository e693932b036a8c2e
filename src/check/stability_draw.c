// A scene becomes a session, the session a picture or, for POV-Ray, the text of the scene where it was put.
//
// SPDX-License-Identifier: MIT
#include "check/stability_draw.h"

#include <stdlib.h>
#include <string.h>

#include "peer/povray_run.h"

// NULL when the scene cannot be read.
static rt_session *motion_open(const MotionPicture *picture)
{
    const Options *options = picture->options;
    const StudyScene *scene = picture->scene;
    const Motion *motion = picture->motion;
    rt_session *session = rt_session_new(NULL);
    rt_status status = session ? rt_set_size(session, picture->width, picture->height) : RT_FAULT_LIMIT;
    for (int i = 0; !status && i < options->include_path_count; i++) {
        status = rt_add_include_path(session, options->include_paths[i]);
    }
    status = status ? status : rt_set_world(session, motion->scale, motion->shift);
    status = status ? status : rt_set_precision(session, motion->precision);
    status = status          ? status
             : scene->text   ? rt_load_text(session, scene->name, scene->text, strlen(scene->text))
                             : rt_load_file(session, scene->name);
    status = status || motion->camera == 1.0 ? status : rt_move_camera(session, motion->camera);
    if (status) {
        rt_session_free(session);
        return NULL;
    }
    return session;
}

bool motion_draw(const MotionPicture *picture, float *values)
{
    rt_session *session = motion_open(picture);
    bool is_drawn = session && rt_render(session, picture->options->threads) == RT_OK;
    if (is_drawn) {
        int width, height;
        const float *pixels = rt_pixels(session, &width, &height);
        memcpy(values, pixels, 3 * (size_t)width * (size_t)height * sizeof *values);
    }
    rt_session_free(session);
    return is_drawn;
}

bool motion_image(const MotionPicture *picture, Image *image)
{
    int width = picture->width, height = picture->height;
    *image = (Image){width, height, 3, malloc(3 * (size_t)width * (size_t)height * sizeof(float))};
    if (image->values && motion_draw(picture, image->values)) {
        return true;
    }
    image_fini(image);
    return false;
}

// The scene where it was put, as text for POV-Ray. The size of the picture is in it where the scene asks for it.
static bool write_scene(const MotionPicture *picture, const char *path)
{
    const char *text;
    rt_session *session = motion_open(picture);
    FILE *out = session && rt_dump_scene(session, &text) == RT_OK ? fopen(path, "wb") : NULL;
    bool is_written = out && fputs(text, out) != EOF;
    is_written = out && fclose(out) == 0 && is_written;
    rt_session_free(session);
    return is_written;
}

bool motion_povray(const MotionPicture *picture, const char *povray, const char *folder, Image *image)
{
    int width = picture->width, height = picture->height;
    char path[4096], output[4096], log[4096], detail[256];
    snprintf(path, sizeof path, "%s/stability.pov", folder);
    snprintf(output, sizeof output, "%s/stability.png", folder);
    snprintf(log, sizeof log, "%s/stability.log", folder);
    *image = (Image){0};
    if (!write_scene(picture, path)) {
        return false;
    }
    PovrayJob job = {.program = povray,
                     .scene = path,
                     .output = output,
                     .log = log,
                     .width = width,
                     .height = height,
                     .threads = picture->options->threads};
    ImageError error;
    bool is_drawn = povray_run(&job, detail, sizeof detail) &&
                    image_read(output, (uint64_t)width * (uint64_t)height, image, &error) == IMAGE_OK;
    if (is_drawn && image->width == width && image->height == height && image->channels == 3) {
        return true;
    }
    if (is_drawn) {
        image_fini(image);
    }
    *image = (Image){0};
    return false;
}
