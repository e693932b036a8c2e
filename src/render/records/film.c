// The film: storage of a picture while it is traced.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>

#include "base/cleared.h"
#include "render/records/film.h"

bool film_init(Film *film, int width, int height, unsigned planes)
{
    size_t pixels = (size_t)width * (size_t)height;
    *film = (Film){.width = width, .height = height, .whole_width = width, .whole_height = height};
    film->rgb = cleared_new(pixels, 3 * sizeof(float));
    bool is_whole = film->rgb != NULL;
    for (int i = 0; i < FILM_PLANES; i++) {
        if (planes >> i & 1) {
            film->planes[i] = cleared_new(pixels, (size_t)film_plane_channels((FilmPlane)i) * sizeof(float));
            is_whole = is_whole && film->planes[i];
        }
    }
    return is_whole;
}

void film_put(Film *film, int left, int top, int whole_width, int whole_height)
{
    film->left = left;
    film->top = top;
    film->whole_width = whole_width;
    film->whole_height = whole_height;
}

void film_fini(Film *film)
{
    free(film->rgb);
    free(film->records);
    for (int i = 0; i < FILM_PLANES; i++) {
        free(film->planes[i]);
    }
    *film = (Film){0};
}

uint64_t film_bytes(int width, int height, bool is_sampled, unsigned planes)
{
    uint64_t chosen = sizeof(uint16_t) + 3 * sizeof(float); // a bucket and a corner for each pixel, in sampling.c
    uint64_t pixel = 3 * sizeof(float) + (is_sampled ? sizeof(PixelRecord) + chosen : 0);
    for (int i = 0; i < FILM_PLANES; i++) {
        pixel += (planes >> i & 1) * (unsigned)film_plane_channels((FilmPlane)i) * sizeof(float);
    }
    uint64_t rows = is_sampled ? 4 * sizeof(double) + 3 * sizeof(float) : 0; // of sampling_near.c; the last corners
    return (uint64_t)width * ((uint64_t)height * pixel + rows);
}
