// Planes of the rendered picture: what it holds of each pixel beside light, for a client and for a file.
//
// Owns the table of public planes: their channels, and where their numbers are. Traces nothing.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/session.h"
#include "render/records/linear.h"

enum { PLANE_CHANNELS_MOST = 3 };

typedef struct PlaneRow {
    rt_plane plane;
    FilmPlane kept; // where the film has it; FILM_PLANES: it is made of the film's records
    bool is_count;
    int channels;
    const char *names[PLANE_CHANNELS_MOST];
} PlaneRow;

static const PlaneRow rows[] = {
    {RT_PLANE_ERROR, FILM_PLANES, false, 1, {"error"}},
    {RT_PLANE_SAMPLES, FILM_PLANES, true, 1, {"samples"}},
    {RT_PLANE_DEPTH, FILM_DEPTH, false, 1, {"Z"}},
    {RT_PLANE_NORMAL, FILM_NORMAL, false, 3, {"normal.X", "normal.Y", "normal.Z"}},
    {RT_PLANE_OBJECT, FILM_OBJECT, true, 1, {"object"}},
    {RT_PLANE_ALBEDO, FILM_ALBEDO, false, 3, {"albedo.R", "albedo.G", "albedo.B"}},
};
enum { PLANE_ROWS = RT_COUNT_OF(rows) };

rt_status rt_set_planes(rt_session *session, unsigned planes)
{
    if (planes & ~(unsigned)RT_PLANES_ALL) {
        return RT_FAULT_USAGE;
    }
    session->planes = planes;
    return RT_OK;
}

unsigned session_film_planes(const rt_session *session)
{
    unsigned planes = session->has_alpha ? 1u << FILM_BACKGROUND : 0;
    for (int i = 0; i < PLANE_ROWS; i++) {
        planes |= (session->planes & rows[i].plane) && rows[i].kept < FILM_PLANES ? 1u << rows[i].kept : 0;
    }
    return planes;
}

// Makes the numbers of a plane that the film does not keep as such.
static void make_values(const rt_session *session, rt_plane plane, void *values)
{
    const Film *film = &session->film;
    size_t count = (size_t)film->width * (size_t)film->height;
    for (size_t i = 0; i < count; i++) {
        if (plane == RT_PLANE_ERROR) {
            ((float *)values)[i] = (float)render_pixel_error(film, &session->error, i);
        } else {
            ((uint32_t *)values)[i] = film->records[i].count;
        }
    }
}

unsigned session_drawn_planes(const rt_session *session)
{
    unsigned error = session_has_pixel_errors(session) ? 0 : RT_PLANE_ERROR;
    return session->rendered ? session->drawn.planes & ~error : 0;
}

rt_status rt_get_plane(rt_session *session, rt_plane plane, void *values, size_t bytes)
{
    const Film *film = &session->film;
    for (int i = 0; i < PLANE_ROWS && (session_drawn_planes(session) & plane); i++) {
        size_t size = (size_t)film->width * (size_t)film->height * (size_t)rows[i].channels * sizeof(float);
        if (rows[i].plane == plane && bytes == size) {
            if (rows[i].kept < FILM_PLANES) {
                memcpy(values, film->planes[rows[i].kept], size);
            } else {
                make_values(session, plane, values);
            }
            return RT_OK;
        }
    }
    return RT_FAULT_USAGE;
}

static void *make_room(PlaneChannels *out, size_t numbers)
{
    void *room = calloc(numbers, sizeof(float));
    out->made[out->made_count++] = room;
    return room;
}

// The numbers of a part within those of the whole picture, which are 0 around it, and infinity of depths.
static const void *put_into_whole(const rt_session *session, const PlaneRow *row, const void *part, PlaneChannels *out)
{
    size_t step = (size_t)row->channels, width = (size_t)session->width, count = width * (size_t)session->height;
    float *whole = make_room(out, count * step);
    for (size_t i = 0; whole && row->plane == RT_PLANE_DEPTH && i < count; i++) {
        whole[i] = INFINITY;
    }
    for (size_t y = 0; whole && y < (size_t)session->film.height; y++) {
        size_t length = (size_t)session->film.width * step;
        size_t at = (((size_t)session->crop.top + y) * width + (size_t)session->crop.left) * step;
        memcpy(whole + at, (const float *)part + y * length, length * sizeof *whole);
    }
    return whole;
}

bool plane_channels_make(const rt_session *session, unsigned planes, bool is_whole, PlaneChannels *out)
{
    out->count = out->made_count = 0;
    for (int i = 0; i < PLANE_ROWS; i++) {
        const PlaneRow *row = &rows[i];
        if (!(planes & row->plane)) {
            continue;
        }
        const void *values = row->kept < FILM_PLANES ? session->film.planes[row->kept] : NULL;
        if (row->kept == FILM_PLANES) {
            void *made = make_room(out, (size_t)session->film.width * (size_t)session->film.height);
            if (made) {
                make_values(session, row->plane, made);
            }
            values = made;
        }
        values = values && is_whole ? put_into_whole(session, row, values, out) : values;
        if (!values) {
            return false;
        }
        for (int c = 0; c < row->channels; c++) {
            out->items[out->count++] = (ImageChannel){
                row->names[c], (const unsigned char *)values + (size_t)c * sizeof(float), row->channels, row->is_count};
        }
    }
    return true;
}

void plane_channels_fini(PlaneChannels *channels)
{
    for (int i = 0; i < channels->made_count; i++) {
        free(channels->made[i]);
    }
    channels->made_count = 0;
}
