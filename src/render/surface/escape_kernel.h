// How long points stay near 0 under z -> z^2 + c, many at once; compiled once for each instruction set.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_ESCAPE_KERNEL_H
#define RENDER_SURFACE_ESCAPE_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

enum { ESCAPE_ABREAST = 8 }; // points that are taken in one step, or parts of it

// Points and what is added to them.
typedef struct EscapePoints {
    _Alignas(64) double x[ESCAPE_ABREAST], y[ESCAPE_ABREAST], c_x[ESCAPE_ABREAST], c_y[ESCAPE_ABREAST];
} EscapePoints;

typedef struct EscapeKernel {
    const char *name; // of the instruction set
    bool (*is_supported)(void);
    // The share of the steps after which each is farther than 2 from 0, or 1.
    void (*shares)(const EscapePoints *points, int steps, double shares[ESCAPE_ABREAST]);
} EscapeKernel;

// That of an instruction set by name, the processor's best one for NULL.
const EscapeKernel *escape_kernel_choose(const char *isa);

#endif
