// The film: a picture while it is traced, its light in the scene's working space and the planes that it keeps beside.
//
// Owns what it points to. Knows nothing of scenes, rays and threads.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_FILM_H
#define RENDER_RECORDS_FILM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"

// What a pixel's samples say of its error, in linear light, as mean squares over its three values. Each is the square
// of how far two sets of samples are apart, times the product of their shares: if sets were independent, the variance
// of the mean of both.
typedef struct PixelRecord {
    uint32_t count; // samples taken; 0: nothing is known
    float outer;    // the two halves of all samples
    float inner;    // the mean over the halves of each: of its own halves
    float fresh;    // the halves of the half that was taken last
    float spread;   // the samples themselves, from their mean
} PixelRecord;

// What a film may keep of each pixel beside its light. The first belongs to the light, over all rays of the pixel; the
// others are of the first surface that the ray through the pixel's middle meets (without a lens and samples: a mean of
// depths or of numbers of objects is none), in the scene's lengths.
typedef enum FilmPlane {
    FILM_BACKGROUND, // the share of what is behind the scene, which is not in the light: 1 - alpha
    FILM_DEPTH,      // distance from the ray's start; infinity where it meets nothing
    FILM_NORMAL,     // x, y, z: unit normal without bumps, on the side that is seen; 0 where nothing is
    FILM_OBJECT,     // a uint32_t: the object's place in the order of declaration, from 1; 0: nothing
    FILM_ALBEDO,     // red, green, blue: the colour of the pigment as far as it is opaque, through the layers above
    FILM_PLANES,
} FilmPlane;
enum { FILM_SURFACE_PLANES = 1u << FILM_DEPTH | 1u << FILM_NORMAL | 1u << FILM_OBJECT | 1u << FILM_ALBEDO };

// The numbers of a pixel in a plane, of 4 bytes each.
static inline int film_plane_channels(FilmPlane plane)
{
    return plane == FILM_NORMAL || plane == FILM_ALBEDO ? 3 : 1;
}

// A picture in the scene's working space, or a part of one: rows from the top, pixels from the left, red green blue
// each.
typedef struct Film {
    int width, height;
    int left, top, whole_width, whole_height; // where it lies in the whole picture, and how large that is
    float *rgb;                               // width * height * 3; owned
    void *planes[FILM_PLANES];                // width * height of each that is wanted, else NULL; owned
    PixelRecord *records;                     // width * height, after sampling; else NULL; owned
} Film;

// With planes of the bits 1 << FilmPlane. False when out of memory; cleared to 0.
bool film_init(Film *film, int width, int height, unsigned planes) RT_MUST_CHECK;
void film_fini(Film *film);

// NULL where that plane is not wanted.
static inline float *film_background(const Film *film)
{
    return film->planes[FILM_BACKGROUND];
}

// Makes the film a part of a greater picture; it is the same pixels then as there. The part lies within.
void film_put(Film *film, int left, int top, int whole_width, int whole_height);

// Where in the whole picture a place beside the middle of a column or row of the film is: u and v of
// render/records/camera.h.
static inline double film_u(const Film *film, int x, double aside)
{
    return (film->left + x + 0.5 + aside) / film->whole_width - 0.5;
}

static inline double film_v(const Film *film, int y, double aside)
{
    return (film->top + y + 0.5 + aside) / film->whole_height - 0.5;
}

// The bytes of a film and of what is needed beside it.
uint64_t film_bytes(int width, int height, bool is_sampled, unsigned planes);

#endif
