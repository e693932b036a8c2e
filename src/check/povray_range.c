// One table of what was measured: the same scene, some ten units in size, at other scales and other places.
//
// SPDX-License-Identifier: MIT
#include "check/povray_range.h"

#include <math.h>
#include <stdio.h>

#include "base/attributes.h"

void povray_range_describe(const rt_range *range, char *words, size_t size)
{
    const struct {
        double value, low, high;
        const char *what;
    } limits[] = {
        {range->eye_offset, 0.0, 1e6, "a camera at"},
        {range->nearest_far, 0.0, 1e6, "a shape at a distance of"},
        {range->reach, range->reach > 0.0 ? 1.0 : 0.0, (double)INFINITY, "nothing farther than"},
        {range->least_size, 1e-3, (double)INFINITY, "a shape of size"},
        {range->least_angle, 1e-5, (double)INFINITY, "a shape whose size over its distance is"},
    };

    words[0] = '\0';
    for (size_t i = 0; i < RT_COUNT_OF(limits); i++) {
        if (limits[i].value < limits[i].low || limits[i].value > limits[i].high) {
            snprintf(words, size, "outside POV-Ray's range: %s %.3g", limits[i].what, limits[i].value);
            return;
        }
    }
}
