// Escape of many points: compiled once for each instruction set, with ISA_NAME the name of the table.
//
// A step of one point waits for the one before it, so points go side by side, each by the operations that pattern.c has
// for a single one.
//
// SPDX-License-Identifier: MIT
#include "render/surface/escape_kernel.h"

#include "base/isa.h"
#include "trace/simd.h"

enum { STEPS_UNASKED = 8 }; // between looks whether a point is left

static void shares(const EscapePoints *points, int steps, double *shares)
{
    for (int from = 0; from < ESCAPE_ABREAST; from += DOUBLES) {
        Doubles x = doubles_load(points->x + from), y = doubles_load(points->y + from);
        const Doubles c_x = doubles_load(points->c_x + from), c_y = doubles_load(points->c_y + from);
        const Doubles far = doubles_splat(4.0), two = doubles_splat(2.0);
        DoublesMask stays = ~(DoublesMask){0}, count = {0};
        for (int i = 0; i < steps; i++) {
            Doubles next = x * x - y * y + c_x;
            y = two * x * y + c_y;
            x = next;
            stays &= ~(x * x + y * y > far);
            count -= stays;
            if (i % STEPS_UNASKED == 0 && doubles_gt(doubles_splat(0.0), (Doubles)(stays & (DoublesMask)-far)) == 0) {
                break;
            }
        }
        for (int k = 0; k < DOUBLES; k++) {
            shares[from + k] = (double)count[k] / steps;
        }
    }
}

extern const EscapeKernel ISA_NAMED(escape_kernel_);
const EscapeKernel ISA_NAMED(escape_kernel_) = {ISA_TEXT, isa_is_supported, shares};
