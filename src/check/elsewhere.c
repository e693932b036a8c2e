// Puts a scene elsewhere by writing what rtlang made of it as text, draws that with POV-Ray, and compares.
//
// Owns two files of the folder that it is given while it runs.
//
// SPDX-License-Identifier: MIT
#include "check/elsewhere.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check/load.h"
#include "check/povray_run.h"

// How much larger it is, how far beside its place, and how many pixels the picture is to the right and down.
typedef struct Place {
    double scale, beside, right, down;
} Place;

// Where the scene is; a thousand times as large; then its picture moved, in directions that are spread evenly, and every
// other time the scene put into one of those sizes or beside its place as well. Powers of two change no other bit. The
// lengths that POV-Ray takes for nothing are about 1e-3 and less, those that it takes for endless 1e7 and more.
static Place place_number(int i)
{
    static const double scales[] = {0x1p10, 0x1p6, 0x1p14};
    const double golden_angle = 2.399963229728653;

    if (i < 2) {
        return (Place){i == 0 ? 1.0 : 0x1p10, 0.0, 0.0, 0.0};
    }
    return (Place){i % 4 == 1 ? scales[i / 4 % 3] : 1.0, i % 4 == 3 ? 1.0 + 0.1 * i : 0.0,
                   1e-6 * cos(golden_angle * i), 1e-6 * sin(golden_angle * i)};
}

typedef struct Comparison {
    const Image *ours, *theirs;   // of the scene where it is
    const Image *unmoved, *other; // POV-Ray's of what rtlang made of it: where it is, and put elsewhere
} Comparison;

static rt_status place_load(rt_session *session, const ElsewhereJob *job, const Place *place)
{
    World world = world_beside(place->scale, place->beside);
    rt_status status = scene_load(session, job->options, job->include_paths, job->scene, &world);

    return status == RT_OK && (place->right != 0.0 || place->down != 0.0)
               ? rt_move_picture(session, place->right, place->down)
               : status;
}

static bool place_write(const ElsewhereJob *job, const Place *place, const char *path)
{
    static const rt_callbacks silent = {0};
    rt_session *session = rt_session_new(&silent);
    const char *text;
    FILE *out = NULL;

    if (session != NULL && place_load(session, job, place) == RT_OK && rt_dump_scene(session, &text) == RT_OK) {
        out = fopen(path, "wb");
    }
    bool is_written = out != NULL && fputs(text, out) != EOF;
    is_written = out != NULL && fclose(out) == 0 && is_written;
    rt_session_free(session);
    return is_written;
}

// The scene's own folder comes first: files that the scene names stand there.
static bool place_draw(const ElsewhereJob *job, const char *scene, const char *picture, Image *image)
{
    const Options *options = job->options;
    char log[PATH_MAX], detail[256];
    char *folder = realpath(job->scene, NULL);
    char **paths = calloc((size_t)job->include_path_count + 1, sizeof *paths);
    ImageError error;

    if (paths == NULL || folder == NULL) {
        free(folder);
        free(paths);
        return false;
    }
    *strrchr(folder, '/') = '\0';
    paths[0] = folder;
    for (int i = 0; i < job->include_path_count; i++) {
        paths[i + 1] = job->include_paths[i];
    }
    snprintf(log, sizeof log, "%s/elsewhere.log", job->folder);
    PovrayJob run = {.program = job->povray,
                     .scene = scene,
                     .output = picture,
                     .log = log,
                     .include_paths = paths,
                     .include_path_count = job->include_path_count + 1,
                     .width = options->width,
                     .height = options->height,
                     .threads = options->threads};
    bool is_drawn = povray_run(&run, detail, sizeof detail) &&
                    image_read(picture, (uint64_t)options->width * (uint64_t)options->height, image, &error) == IMAGE_OK;
    unlink(log);
    free(folder);
    free(paths);
    return is_drawn && image->width == options->width && image->height == options->height;
}

// Whether POV-Ray does not agree with itself in a pixel as little as with rtlang: elsewhere it draws what rtlang draws;
// or its pictures before and after a move of a millionth of a pixel are half as far apart as it is from rtlang's.
static bool is_unsure(const ElsewhereJob *job, const Comparison *pictures, const Place *place, size_t pixel)
{
    double apart = image_pixel_difference(pictures->ours, pictures->theirs, pixel);
    bool is_only_moved = place->scale == 1.0 && place->beside == 0.0 && pictures->unmoved->values != NULL;

    return image_pixel_difference(pictures->ours, pictures->other, pixel) <= job->threshold ||
           (is_only_moved && 2.0 * image_pixel_difference(pictures->unmoved, pictures->other, pixel) >= apart);
}

// Marks pixels that are beyond the threshold and not marked yet; returns how many.
static uint64_t mark(const ElsewhereJob *job, const Comparison *pictures, const Place *place, bool *marked)
{
    uint64_t count = 0;

    for (size_t i = 0; i < (size_t)pictures->ours->width * (size_t)pictures->ours->height; i++) {
        if (!marked[i] && image_pixel_difference(pictures->ours, pictures->theirs, i) > job->threshold &&
            is_unsure(job, pictures, place, i)) {
            marked[i] = true;
            count++;
        }
    }
    return count;
}

uint64_t elsewhere_count(const ElsewhereJob *job, const Image *ours, const Image *theirs)
{
    char scene[PATH_MAX], picture[PATH_MAX];
    bool *marked = calloc((size_t)ours->width * (size_t)ours->height, sizeof *marked);
    Image unmoved = {0};
    uint64_t count = 0;

    snprintf(scene, sizeof scene, "%s/elsewhere.pov", job->folder);
    snprintf(picture, sizeof picture, "%s/elsewhere.png", job->folder);
    for (int i = 0; marked != NULL && i < job->options->elsewhere; i++) {
        Place place = place_number(i);
        Image other = {0};
        Comparison pictures = {ours, theirs, &unmoved, &other};
        if (place_write(job, &place, scene) && place_draw(job, scene, picture, &other)) {
            count += mark(job, &pictures, &place, marked);
        }
        if (i == 0) {
            unmoved = other;
        } else {
            image_fini(&other);
        }
    }
    image_fini(&unmoved);
    unlink(scene);
    unlink(picture);
    free(marked);
    return count;
}
