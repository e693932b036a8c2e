// Points of many samples at once, as sample_next gives them one by one; once for each instruction set.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_POINTS_SAMPLER_MANY_H
#define RENDER_POINTS_SAMPLER_MANY_H

#include "render/points/sampler.h"

enum { SAMPLE_WORDS_MOST = 8 }; // samples that are made in one step

typedef struct SobolKernel {
    const char *name; // of the instruction set, as that of SphereKernels
    // Points of samples of any pixels, in any of their pairs of dimensions. All arrays hold a whole number of steps.
    void (*points)(const uint32_t *seeds, const uint32_t *pairs, const uint32_t *indices, uint32_t count, double *x,
                   double *y);
} SobolKernel;

// That of an instruction set by name; NULL when there is none.
const SobolKernel *sobol_kernel_choose(const char *name);

enum { SAMPLE_STREAMS_MOST = 64 };
_Static_assert(SAMPLE_STREAMS_MOST % SAMPLE_WORDS_MOST == 0, "so many fill steps");

// The next two dimensions of some of the streams, all of one kind: of those that `which` lists, or, where that is NULL,
// of the first; SAMPLE_STREAMS_MOST at most. x and y have room for a whole number of steps.
void sample_next_of(const SobolKernel *kernel, SampleStream *streams, const uint8_t *which, uint32_t count, double *x,
                    double *y);

#endif
