// The lists of kernels, one for each kernel_*.c, and the choice among them; private to what stands beside it.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_KERNELS_H
#define RENDER_KERNELS_H

#include <stddef.h>

#include "render/records/kernel.h"

typedef struct KernelList {
    const Kernel *kernels;
    size_t count;
} KernelList;

extern const KernelList kernels_few;  // few spheres, perhaps planes, by tiles: no tree
extern const KernelList kernels_many; // trees of spheres, by tiles
extern const KernelList kernels_rays; // spheres and planes, ray by ray
extern const KernelList kernels_any;  // every shape; the last one does all there is

// The kernel with the fewest features that has all of these; the last one has all there are.
const Kernel *kernel_choose(unsigned features);

#endif
