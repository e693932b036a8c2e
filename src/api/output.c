// The rendered film becomes a picture file: what is checked of a path before a run, and what is written after it.
//
// Knows which channels a picture has; must not know what formats look like.
//
// SPDX-License-Identifier: MIT
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "api/session.h"
#include "image/image.h"

rt_status session_image_fault(rt_session *session, ImageStatus status, const char *path, const ImageError *error)
{
    static const struct {
        DiagCode code;
        const char *format; // of path and detail
    } faults[] = {
        [IMAGE_NO_MEMORY] = {DIAG_E0602, "out of memory writing %s%s"},
        [IMAGE_UNKNOWN_FORMAT] = {DIAG_E0701, "the ending of %s is that of no picture format%s"},
        [IMAGE_BAD_DEPTH] = {DIAG_E0702, "%s cannot have the wanted depth%s"},
        [IMAGE_NO_MODULE] = {DIAG_E0507, "%s needs OpenImageIO, which cannot be loaded%s"},
        [IMAGE_IO] = {DIAG_E0505, "cannot write %s%s"},
        [IMAGE_NOT_A_PICTURE] = {DIAG_E0505, "cannot write %s%s"},
        [IMAGE_TOO_LARGE] = {DIAG_E0505, "cannot write %s%s"},
    };
    if (status == IMAGE_OK) {
        return session_status(session, true);
    }
    // The system's words begin with the path where the system was asked; again it would say nothing new.
    bool is_stream = image_path_is_stdout(path);
    const char *detail = error->detail, *said = is_stream ? "standard output" : path;
    size_t length = strlen(said);
    if (strncmp(detail, said, length) == 0 && strncmp(detail + length, ": ", 2) == 0) {
        detail += length + 2;
    }
    char more[sizeof error->detail + 2], name[PATH_MAX];
    snprintf(more, sizeof more, "%s%s", detail[0] ? ": " : "", detail);
    snprintf(name, sizeof name, is_stream ? "%s" : "`%s`", is_stream ? "standard output" : path);
    diag_report(&session->diags, faults[status].code, SPAN_NONE, faults[status].format, name, more);
    return session_status(session, false);
}

static bool is_output(const rt_session *session, const char *path, const rt_output *output)
{
    return (!output->error_channel || image_path_names_channels(path)) &&
           (!session->has_alpha || (image_path_has_alpha(path) && !output->error_channel)) &&
           (output->depth == RT_DEPTH_AUTO || output->depth == RT_DEPTH_8 || output->depth == RT_DEPTH_16 ||
            output->depth == RT_DEPTH_FLOAT) &&
           output->file_gamma >= 0.0 && isfinite(output->file_gamma);
}

static ImageDepth output_depth(const rt_output *output, const char *path)
{
    if (output->depth == RT_DEPTH_AUTO) {
        return image_path_depth(path);
    }
    return output->depth == RT_DEPTH_8    ? IMAGE_DEPTH_8
           : output->depth == RT_DEPTH_16 ? IMAGE_DEPTH_16
                                          : IMAGE_DEPTH_FLOAT;
}

rt_status rt_check_output(rt_session *session, const char *path, const rt_output *output)
{
    ImageError error = {""};
    if (!is_output(session, path, output)) {
        return RT_FAULT_USAGE;
    }
    if (!session_memory_suffices(session)) {
        return session_status(session, false);
    }
    return session_image_fault(session, image_check_path(path, output_depth(output, path), &error), path, &error);
}

// A picture of the size that was set, black but for the rendered part, which is given with its three or four channels.
static bool picture_whole(const rt_session *session, const Image *part, Image *image)
{
    size_t channels = (size_t)part->channels;
    if (!image_init(image, session->width, session->height, part->channels)) {
        return false;
    }
    for (size_t i = 3; channels == 4 && i < 4 * (size_t)image->width * (size_t)image->height; i += 4) {
        image->values[i] = 1.0f; // opaque black, as in POV-Ray
    }
    for (size_t y = 0; y < (size_t)part->height; y++) {
        size_t row = ((size_t)session->crop.top + y) * (size_t)image->width + (size_t)session->crop.left;
        size_t length = (size_t)part->width * channels;
        memcpy(image->values + row * channels, part->values + y * length, length * sizeof *image->values);
    }
    return true;
}

// What is written: the film itself, or what is made of it, which is *made, to be released. False when out of memory.
static bool picture(const rt_session *session, const char *path, const rt_output *output, Image *made, Image *image)
{
    bool fine = true;
    *made = (Image){0};
    *image = (Image){session->film.width, session->film.height, 3, session->film.rgb};
    if (output->error_channel) {
        fine = session_picture_with_error(session, made);
    } else if (session->has_alpha) {
        fine = session_picture_with_alpha(session, image_path_names_channels(path), made);
    }
    if (fine && output->whole && session->crop.width) {
        Image part = made->values ? *made : *image;
        Image fourth = *made;
        fine = picture_whole(session, &part, made);
        image_fini(&fourth);
    }
    *image = made->values ? *made : *image;
    return fine;
}

rt_status rt_write(rt_session *session, const char *path, const rt_output *output)
{
    if (!session->rendered || !is_output(session, path, output) ||
        (output->error_channel && !session_has_pixel_errors(session))) {
        return RT_FAULT_USAGE;
    }
    double start = session_clock();
    ImageError error = {""};
    Image made, image;
    if (!picture(session, path, output, &made, &image)) {
        image_fini(&made);
        return session_image_fault(session, IMAGE_NO_MEMORY, path, &error);
    }
    SessionNotes notes;
    session_make_notes(session, &notes);
    ImageEncoding encoding = {
        .notes = notes.items,
        .note_count = notes.count,
        .depth = output_depth(output, path),
        .transfer = output->file_gamma > 0.0 ? IMAGE_TRANSFER_POWER : IMAGE_TRANSFER_SRGB,
        .gamma = output->file_gamma,
        .already_encoded = session->scene.settings.gamma_model == GAMMA_NONE,
        .threads = session->threads,
        .fourth = output->error_channel ? "error" : NULL,
    };
    ImageStatus status = image_write(&image, &encoding, path, &error);
    image_fini(&made);
    session->write_seconds = session_clock() - start;
    return session_image_fault(session, status, path, &error);
}
