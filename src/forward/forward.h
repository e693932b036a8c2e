// The forward tracer of the lecture: photons leave the lights, hit, take colour, scatter and now and then reach the
// film.
//
// Turns a prepared scene into a film the other way round: light goes from each source to a surface, is scattered there
// by the same lighting model that the renderer uses, continues over mirrors, and counts when it passes the lens. The
// variant that connects each hit to the lens asks instead what of its light arrives there. Both have the mean that the
// renderer has, for light that was scattered by one dull surface and by any mirrors after it; glow and background do
// not come from lights and are left out. A study of cost, in a room of its own: nothing of it runs unless it is asked
// for.
//
// SPDX-License-Identifier: MIT
#ifndef FORWARD_FORWARD_H
#define FORWARD_FORWARD_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "render/render.h"

typedef struct ForwardOptions {
    bool connects;
    uint64_t photons; // >= 1
    uint64_t seed;
    int threads;                                 // >= 1
    void (*progress)(void *client, double done); // by one thread at a time; may be NULL
    void *client;
    const atomic_bool *cancel; // may be NULL
} ForwardOptions;

typedef struct ForwardCounts {
    uint64_t emitted, met, arrived; // photons that left a light, met a surface; times that one counted on the film
} ForwardCounts;

// Bytes that it takes beside the film's colours.
uint64_t forward_bytes(int width, int height);

// What of a scene the forward tracer does not know, in words; NULL: nothing.
const char *forward_misfit(const Prepared *prepared, const ForwardOptions *options);

// The scene fits. The same film and error for any number of threads. The error is that of two halves of the photons,
// which are independent.
RenderResult forward_film(const Prepared *prepared, const ForwardOptions *options, Film *film, SamplingError *error,
                          ForwardCounts *counts) RT_MUST_CHECK;

#endif
