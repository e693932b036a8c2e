// One photon: from a light to the film, or not.
//
// SPDX-License-Identifier: MIT
#ifndef FORWARD_PHOTON_H
#define FORWARD_PHOTON_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "math/colour.h"
#include "render/records/film.h"
#include "render/records/prepared.h"

// Where photons arrive: the two halves' sums in whole units, and what a place on the lens and a direction mean.
typedef struct PhotonFilm {
    atomic_int_least64_t *sums[2]; // width * height * 3 each; owned
    const Film *film;              // whose pixels they are
    Vec3 axis;                     // unit, from the lens to what is seen
    double distance;               // of the plane in focus from the lens
    double pixel_area;             // on that plane
    double lens_area;              // 0: a pinhole
} PhotonFilm;

bool photon_film_init(PhotonFilm *arrived, const Prepared *prepared, const Film *film) RT_MUST_CHECK;
void photon_film_fini(PhotonFilm *film);

// What was added up for a value.
double photon_film_value(const PhotonFilm *film, unsigned half, size_t i);

typedef struct Photon {
    uint64_t seed, number;
    unsigned half;
    bool connects;
    unsigned met, arrived; // result: surfaces met by the light itself (0 or 1), times it counted
} Photon;

void photon_trace(const Prepared *prepared, Photon *photon, PhotonFilm *film);

#endif
