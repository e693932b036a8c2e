// The rendered picture: written as a file, or handed over in memory as numbers or as the bytes of a PNG file.
//
// Owns nothing but the bytes that were asked for last, which the session keeps. Knows nothing of rendering.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "base/clock.h"
#include "image/encode.h"
#include "image/note_read.h"

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
    status = error->no_memory ? IMAGE_NO_MEMORY : status;
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

// `planes`: those that there are, or will be.
static bool is_output(const rt_output *output, const char *path, bool has_alpha, unsigned planes)
{
    return (!output->planes || image_path_names_channels(path)) && !(output->planes & ~planes) &&
           (!has_alpha || image_path_has_alpha(path)) &&
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
    ImageError error = {.no_memory = false};
    if (!is_output(output, path, session->has_alpha, session->planes)) {
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

// The picture with what belongs into a file beside its light and its part, if anything (*own, to be released).
static bool picture_of(const rt_session *session, const rt_output *output, bool is_multiplied, Image *own, Image *image)
{
    bool is_made = true;
    *own = (Image){0};
    *image = (Image){session->film.width, session->film.height, 3, session->film.rgb};
    if (film_background(&session->film)) {
        is_made = session_picture_with_alpha(session, is_multiplied, own);
    }
    if (is_made && output->whole && session->crop.width) {
        Image with_alpha = *own, part = own->values ? *own : *image;
        *own = (Image){0};
        is_made = picture_whole(session, &part, own);
        image_fini(&with_alpha);
    }
    *image = own->values ? *own : *image;
    return is_made;
}

static ImageEncoding encoding_of(const rt_session *session, const rt_output *output, ImageDepth depth,
                                 const SessionNotes *notes)
{
    return (ImageEncoding){
        .notes = notes->items,
        .note_count = notes->count,
        .depth = depth,
        .transfer = output->file_gamma > 0.0 ? IMAGE_TRANSFER_POWER : IMAGE_TRANSFER_SRGB,
        .gamma = output->file_gamma,
        .already_encoded = session->scene.settings.gamma_model == GAMMA_NONE,
        .continues = output->continues,
        .threads = session->threads,
    };
}

rt_status rt_write(rt_session *session, const char *path, const rt_output *output)
{
    if (!session->rendered ||
        !is_output(output, path, film_background(&session->film), session_drawn_planes(session))) {
        return RT_FAULT_USAGE;
    }
    double start = clock_seconds();
    ImageError error = {.no_memory = false};
    Image own = {0}, image;
    PlaneChannels channels;
    SessionNotes notes;
    bool has_notes = session_make_notes(session, &notes);
    ImageEncoding encoding = encoding_of(session, output, output_depth(output, path), &notes);
    bool is_made = plane_channels_make(session, output->planes, output->whole && session->crop.width, &channels) &&
                   picture_of(session, output, image_path_names_channels(path), &own, &image) && has_notes;
    encoding.more = channels.items;
    encoding.more_count = channels.count;
    ImageStatus status = is_made ? image_write(&image, &encoding, path, &error) : IMAGE_NO_MEMORY;
    image_fini(&own);
    plane_channels_fini(&channels);
    session_free_notes(&notes);
    session->write_seconds = clock_seconds() - start;
    return session_image_fault(session, status, path, &error);
}

rt_status rt_read_note(rt_session *session, const char *path, const char *name, const char **text)
{
    text_clear(&session->note);
    NoteResult result = note_read(path, name, &session->note);
    *text = result == NOTE_FOUND ? text_get(&session->note) : NULL;
    if (result == NOTE_NO_FILE) {
        bool is_missing = errno == ENOENT || errno == ENOTDIR;
        diag_report(&session->diags, DIAG_E0502, SPAN_NONE, is_missing ? "`%s` not found%s" : "cannot read `%s`: %s", path,
                    is_missing ? "" : strerror(errno));
        return session_status(session, false);
    }
    if (session->note.failed) {
        return session_no_memory(session);
    }
    return RT_OK;
}

rt_status rt_get_pixels(rt_session *session, const rt_output *output, void *pixels, size_t bytes)
{
    static const char path[] = "picture.png";
    ImageError error = {.no_memory = false};
    Image own, image;
    SessionNotes notes = {.count = 0};
    ImageEncoding encoding = encoding_of(session, output, output_depth(output, path), &notes);
    bool is_whole = output->whole && session->crop.width;
    int width = is_whole ? session->width : session->film.width;
    int height = is_whole ? session->height : session->film.height;
    size_t count = (size_t)width * (size_t)height * (film_background(&session->film) ? 4 : 3);
    if (!session->rendered || !is_output(output, path, film_background(&session->film), 0) ||
        bytes != count * encode_sample_bytes(encoding.depth)) {
        return RT_FAULT_USAGE;
    }
    bool is_made = picture_of(session, output, false, &own, &image) && image_samples(&image, &encoding, pixels);
    image_fini(&own);
    return session_image_fault(session, is_made ? IMAGE_OK : IMAGE_NO_MEMORY, "memory", &error);
}

rt_status rt_set_pixels(rt_session *session, int width, int height, const float *rgb, const float *transparency)
{
    Film *film = &session->film;
    rt_status status = session->loaded && !session->is_built ? RT_FAULT_USAGE : rt_set_size(session, width, height);
    if (status) {
        return status;
    }
    film_fini(film);
    session->rendered = false;
    session->error = (SamplingError){0};
    session->drawn.planes = 0;
    session->threads = render_default_threads();
    session->scene.settings.gamma_model = GAMMA_LINEAR;
    if (!film_init(film, width, height, transparency ? 1u << FILM_BACKGROUND : 0)) {
        film_fini(film);
        return session_image_fault(session, IMAGE_NO_MEMORY, "memory", &(ImageError){.no_memory = false});
    }
    size_t count = (size_t)width * (size_t)height;
    memcpy(film->rgb, rgb, 3 * count * sizeof *rgb);
    if (transparency) {
        memcpy(film_background(film), transparency, count * sizeof *transparency);
    }
    session->rendered = true;
    return RT_OK;
}

rt_status rt_get_png(rt_session *session, const rt_output *output, const unsigned char **bytes, size_t *size)
{
    static const char path[] = "picture.png";
    ImageError error = {.no_memory = false};
    Image own, image;
    SessionNotes notes;
    if (!session->rendered || !is_output(output, path, film_background(&session->film), 0) ||
        output->depth == RT_DEPTH_FLOAT) {
        return RT_FAULT_USAGE;
    }
    free(session->png);
    session->png = NULL;
    bool has_notes = session_make_notes(session, &notes);
    ImageEncoding encoding = encoding_of(session, output, output_depth(output, path), &notes);
    ImageStatus status = picture_of(session, output, false, &own, &image) && has_notes
                             ? image_encode_png(&image, &encoding, &session->png, size, &error)
                             : IMAGE_NO_MEMORY;
    image_fini(&own);
    session_free_notes(&notes);
    *bytes = session->png;
    return session_image_fault(session, status, "memory", &error);
}

const float *rt_transparency(const rt_session *session)
{
    return session->rendered ? film_background(&session->film) : NULL;
}

float *rt_take_pixels(rt_session *session, int *width, int *height)
{
    float *pixels = session->rendered ? session->film.rgb : NULL;
    if (pixels) {
        *width = session->film.width;
        *height = session->film.height;
        session->film.rgb = NULL;
        film_fini(&session->film);
        session->rendered = false;
    }
    return pixels;
}

void rt_free_pixels(float *pixels)
{
    free(pixels);
}

const float *rt_pixels(const rt_session *session, int *width, int *height)
{
    if (!session->rendered) {
        return NULL;
    }
    *width = session->film.width;
    *height = session->film.height;
    return session->film.rgb;
}
