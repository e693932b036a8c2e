// How much of what is behind a scene its pixels show: the share that its background's clear part has in a ray.
//
// Beside the light of a kernel, which knows nothing of it: such a picture's mirrors see the whole sky and background, and
// what rays that only went through surfaces see of their clear part is taken off again here and counted. Found by
// pictures; docs/language.md, "Transparency of the picture", has the formulas.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_ALPHA_H
#define RENDER_SAMPLE_ALPHA_H

#include "base/attributes.h"
#include "render/records/kernel.h"
#include "render/records/prepared.h"

// Takes from the light of rays, as the kernel traced them, what is behind the scene, and sets its shares, from 0 to 1.
void alpha_part(const Prepared *p, const KernelCall *call, double *clear);

// Traces by the scene's kernel; with has_alpha the light is what is not behind the scene, and `clear`, of KERNEL_RAYS
// numbers, tells the share that is; else those are left as they are.
static inline void alpha_trace(const Prepared *p, const KernelCall *call, double *clear)
{
    p->kernel->trace(p, call);
    if (p->has_alpha) {
        alpha_part(p, call, clear);
    }
}

#endif
