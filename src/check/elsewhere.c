// Has POV-Ray draw a scene with its cameras turned by a billionth of a pixel, and what rtlang wrote of it in other
// sizes.
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

#include "check/camera_text.h"
#include "check/load.h"
#include "peer/povray_run.h"

// How much larger it is, and how far beside its place.
typedef struct Place {
    double scale, beside;
} Place;

// In turn as it is, in other sizes, and beside its place; `i` from 0. Powers of two change no other bit. The lengths
// that POV-Ray takes for nothing are about 1e-3 and less, those that it takes for endless 1e7 and more.
static Place place_number(int i)
{
    static const double scales[] = {0x1p10, 0x1p6, 0x1p14};

    return (Place){i % 2 == 1 ? scales[i / 2 % 3] : 1.0, i % 2 == 0 ? 0.2 * i : 0.0};
}

// A turn of the cameras by 5e-12, about a billionth of a pixel, in directions that are spread evenly: far more than
// rounding is, and far less than what can be seen.
static bool turned_write(const ElsewhereJob *job, int i, const char *path)
{
    const double golden_angle = 2.399963229728653, degrees = 3e-10;
    char words[128];

    snprintf(words, sizeof words, "rotate <%.9g, %.9g, %.9g>", degrees * cos(golden_angle * i),
             degrees * sin(golden_angle * i), 0.3 * degrees);
    return camera_text_write(job->scene, words, path);
}

// POV-Ray's pictures of the scene itself, and of what rtlang made of it.
typedef struct Comparison {
    const Image *ours, *theirs;   // of the scene as it is
    const Image *written, *other; // of what rtlang wrote of it, as it is, or NULL; and of what was changed
} Comparison;

static bool place_write(const ElsewhereJob *job, const Place *place, const char *path)
{
    static const rt_callbacks silent = {0};
    rt_session *session = rt_session_new(&silent);
    const char *text;
    FILE *out = NULL;
    World world = world_beside(place->scale, place->beside);

    if (session && scene_load(session, job->options, job->include_paths, job->scene, &world) == RT_OK &&
        rt_dump_scene(session, &text) == RT_OK) {
        out = fopen(path, "wb");
    }
    bool is_written = out && fputs(text, out) != EOF;
    is_written = out && fclose(out) == 0 && is_written;
    rt_session_free(session);
    return is_written;
}

// The scene's own folder comes first: files that the scene names stand there.
static bool draw(const ElsewhereJob *job, const char *scene, const char *picture, Image *image)
{
    const Options *options = job->options;
    char log[PATH_MAX], detail[256];
    char *folder = realpath(job->scene, NULL);
    char **paths = calloc((size_t)job->include_path_count + 1, sizeof *paths);
    ImageError error;

    if (!paths || !folder) {
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
                     .clock = options->clock_given ? &options->clock : NULL,
                     .threads = options->threads};
    bool is_drawn =
        povray_run(&run, detail, sizeof detail) &&
        image_read(picture, (uint64_t)options->width * (uint64_t)options->height, image, &error) == IMAGE_OK;
    unlink(log);
    free(folder);
    free(paths);
    return is_drawn && image->width == options->width && image->height == options->height;
}

// Whether POV-Ray agrees with itself in a pixel no better than with rtlang. What it makes of the scene with the cameras
// turned says so when it is rtlang's, or half as far from its first picture as that is. What it makes of rtlang's text
// says so only where that text, as it is, gives the same as the scene: elsewhere rtlang may have misread the scene.
static bool is_unsure(const ElsewhereJob *job, const Comparison *pictures, size_t pixel)
{
    bool is_ours = image_pixel_difference(pictures->ours, pictures->other, pixel) <= job->threshold;

    if (pictures->written) {
        return is_ours && image_pixel_difference(pictures->theirs, pictures->written, pixel) <= job->threshold;
    }
    return is_ours || 2.0 * image_pixel_difference(pictures->theirs, pictures->other, pixel) >=
                          image_pixel_difference(pictures->ours, pictures->theirs, pixel);
}

static size_t pixel_count(const ElsewhereJob *job)
{
    return (size_t)job->options->width * (size_t)job->options->height;
}

static uint64_t count_apart(const ElsewhereJob *job, const Image *one, const Image *other)
{
    uint64_t count = 0;

    for (size_t i = 0; i < pixel_count(job); i++) {
        count += image_pixel_difference(one, other, i) > job->threshold;
    }
    return count;
}

// Marks pixels that are beyond the threshold and not marked yet; returns how many.
static uint64_t mark(const ElsewhereJob *job, const Comparison *pictures, bool *marked)
{
    uint64_t count = 0;

    for (size_t i = 0; i < pixel_count(job); i++) {
        if (!marked[i] && image_pixel_difference(pictures->ours, pictures->theirs, i) > job->threshold &&
            is_unsure(job, pictures, i)) {
            marked[i] = true;
            count++;
        }
    }
    return count;
}

// The greatest number of pixels that may be excused.
static uint64_t most_excused(const ElsewhereJob *job)
{
    return pixel_count(job) / 1000;
}

// The files and pictures of one count.
typedef struct Count {
    char scene[PATH_MAX], picture[PATH_MAX];
    Image written;
    bool is_witness; // what rtlang wrote gives the scene's own picture, in all but as many pixels as may be excused
    bool *marked;
} Count;

static void files_name(const ElsewhereJob *job, Count *count)
{
    snprintf(count->scene, sizeof count->scene, "%s/elsewhere.pov", job->folder);
    snprintf(count->picture, sizeof count->picture, "%s/elsewhere.png", job->folder);
}

// One more picture of the scene with its cameras turned.
static uint64_t count_turned(const ElsewhereJob *job, Count *count, const Image *ours, const Image *theirs, int i)
{
    Image other = {0};
    Comparison pictures = {ours, theirs, NULL, &other};
    uint64_t more = 0;

    if (turned_write(job, i, count->scene) && draw(job, count->scene, count->picture, &other)) {
        more = mark(job, &pictures, count->marked);
    }
    image_fini(&other);
    return more;
}

// One more of what rtlang wrote; the first is what the others are judged by.
static uint64_t count_written(const ElsewhereJob *job, Count *count, const Image *ours, const Image *theirs, int i)
{
    Place place = place_number(i);
    Image other = {0};
    Comparison pictures = {ours, theirs, &count->written, &other};
    uint64_t more = 0;

    if ((i > 0 && !count->is_witness) || !place_write(job, &place, count->scene) ||
        !draw(job, count->scene, count->picture, &other)) {
        return 0;
    }
    if (i == 0) {
        count->written = other;
        count->is_witness = count_apart(job, theirs, &count->written) <= most_excused(job);
        return 0;
    }
    more = mark(job, &pictures, count->marked);
    image_fini(&other);
    return more;
}

// POV-Ray's picture of what rtlang wrote of the scene, in a place.
static bool draw_there(const ElsewhereJob *job, const Count *count, Place place, Image *image)
{
    return place_write(job, &place, count->scene) && draw(job, count->scene, count->picture, image);
}

// Pixels in which ours is not that of the larger scene, or in which what rtlang wrote says nothing: see is_unsure.
static int64_t count_unlike(const ElsewhereJob *job, const Comparison *pictures)
{
    int64_t count = 0;

    for (size_t i = 0; i < pixel_count(job); i++) {
        bool is_apart = image_pixel_difference(pictures->ours, pictures->theirs, i) > job->threshold;
        bool is_ours = image_pixel_difference(pictures->ours, pictures->other, i) <= job->threshold;
        count += is_apart ? !is_unsure(job, pictures, i) : !is_ours;
    }
    return count;
}

int64_t elsewhere_larger(const ElsewhereJob *job, const Image *ours, const Image *theirs)
{
    static const double scales[] = {0x1p6, 0x1p10, 0x1p14};
    int64_t least = -1;
    Count count = {.marked = NULL};

    files_name(job, &count);
    count.is_witness = draw_there(job, &count, (Place){1.0, 0.0}, &count.written) &&
                       count_apart(job, theirs, &count.written) <= most_excused(job);
    for (int i = 0; count.is_witness && least != 0 && i < 3; i++) {
        Image larger = {0};
        Comparison pictures = {ours, theirs, &count.written, &larger};
        if (draw_there(job, &count, (Place){scales[i], 0.0}, &larger)) {
            int64_t unlike = count_unlike(job, &pictures);
            least = least < 0 || unlike < least ? unlike : least;
        }
        image_fini(&larger);
    }
    image_fini(&count.written);
    unlink(count.scene);
    unlink(count.picture);
    return least;
}

uint64_t elsewhere_count(const ElsewhereJob *job, const Image *ours, const Image *theirs)
{
    Count count = {.marked = calloc(pixel_count(job), sizeof *count.marked)};
    uint64_t most = most_excused(job), apart = count_apart(job, ours, theirs), found = 0;
    bool may_suffice = (double)apart - (double)most <= job->options->ties * (double)pixel_count(job);

    files_name(job, &count);
    for (int i = 0; count.marked && may_suffice && found < apart && i < job->options->elsewhere; i++) {
        found += i % 2 == 0 ? count_turned(job, &count, ours, theirs, i / 2)
                            : count_written(job, &count, ours, theirs, i / 2);
    }
    image_fini(&count.written);
    unlink(count.scene);
    unlink(count.picture);
    free(count.marked);
    return found < most ? found : most;
}
