// Means over a pixel and its neighbours, a row at a time.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling.h"

enum { KEPT = 3 }; // rows

Near near_begin(double *memory, int width, int height)
{
    return (Near){.values = memory, .widened = memory + width, .width = width, .height = height};
}

static double *widened_row(const Near *near, int y)
{
    int row = y < 0 ? 0 : y >= near->height ? near->height - 1 : y;
    return near->widened + (ptrdiff_t)(row % KEPT) * near->width;
}

void near_give(Near *near, int y)
{
    const double *values = near->values;
    double *widened = widened_row(near, y);
    int last = near->width - 1;
    if (y >= near->height) {
        return;
    }
    for (int x = 1; x < last; x++) {
        widened[x] = values[x - 1] + 2.0 * values[x] + values[x + 1];
    }
    widened[0] = 3.0 * values[0] + values[last > 0 ? 1 : 0];
    widened[last] = 3.0 * values[last] + values[last > 0 ? last - 1 : 0];
}

void near_take(Near *near, int y)
{
    const double *above = widened_row(near, y - 1), *row = widened_row(near, y), *below = widened_row(near, y + 1);
    for (int x = 0; x < near->width; x++) {
        near->values[x] = (above[x] + 2.0 * row[x] + below[x]) / 16.0;
    }
}
