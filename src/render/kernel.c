// The choice among the kernels that kernel_*.c hold.
//
// SPDX-License-Identifier: MIT
#include "render/kernels.h"

#include "base/attributes.h"

const Kernel *kernel_choose(unsigned features)
{
    // Those with few features first.
    const KernelList *const lists[] = {&kernels_few, &kernels_many, &kernels_rays, &kernels_any};
    const Kernel *best = &kernels_any.kernels[kernels_any.count - 1];
    for (size_t i = 0; i < RT_COUNT_OF(lists); i++) {
        for (size_t j = 0; j < lists[i]->count; j++) {
            const Kernel *kernel = &lists[i]->kernels[j];
            bool covers = (features & ~kernel->features) == 0;
            if (covers && __builtin_popcount(kernel->features) < __builtin_popcount(best->features)) {
                best = kernel;
            }
        }
    }
    return best;
}
