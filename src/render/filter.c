// Filters, sampled through tables of their inverse integrals.
//
// Between the steps of a table the density is even, so a weight corrects it to the filter's: the mean is exact.
//
// SPDX-License-Identifier: MIT
#include "render/filter.h"

#include <math.h>
#include <stddef.h>

const char *filter_name(FilterKind kind)
{
    static const char *const names[] = {
        [FILTER_BOX] = "box", [FILTER_TENT] = "tent", [FILTER_GAUSSIAN] = "gaussian", [FILTER_MITCHELL] = "mitchell"};
    return kind < FILTER_COUNT ? names[kind] : NULL;
}

static double filter_radius(FilterKind kind)
{
    static const double radii[] = {
        [FILTER_BOX] = 0.5, [FILTER_TENT] = 1.0, [FILTER_GAUSSIAN] = 1.5, [FILTER_MITCHELL] = 2.0};
    return radii[kind];
}

double filter_value(FilterKind kind, double x)
{
    x = fabs(x);
    if (x >= filter_radius(kind)) {
        return 0.0;
    }
    switch (kind) {
    case FILTER_TENT:
        return 1.0 - x;
    case FILTER_GAUSSIAN:
        return exp(-2.0 * x * x) - exp(-2.0 * 1.5 * 1.5);
    case FILTER_MITCHELL:
        return x < 1.0 ? (7.0 * x * x * x - 12.0 * x * x + 16.0 / 3.0) / 6.0
                       : (-7.0 / 3.0 * x * x * x + 12.0 * x * x - 20.0 * x + 32.0 / 3.0) / 6.0;
    case FILTER_BOX:
    case FILTER_COUNT:
        break;
    }
    return 1.0;
}

// The integral is taken in fine steps by the middle rule; what it is off by, the weights put right.
void filter_init(Filter *filter, FilterKind kind)
{
    enum { FINE = 64 * FILTER_STEPS };
    double radius = filter_radius(kind), step = 2.0 * radius / FINE, size = 0.0, sum = 0.0;
    *filter = (Filter){.kind = kind, .scale = 1.0};
    if (kind == FILTER_BOX) {
        return;
    }
    for (int i = 0; i < FINE; i++) {
        double value = filter_value(kind, (i + 0.5) * step - radius);
        size += fabs(value) * step;
        sum += value * step;
    }
    filter->scale = 1.0 / sum;
    double reached = 0.0;
    int next = 0;
    for (int i = 0; i < FINE; i++) {
        for (; next < FILTER_STEPS && reached >= size * next / FILTER_STEPS; next++) {
            filter->inverse[next] = i * step - radius;
        }
        reached += fabs(filter_value(kind, (i + 0.5) * step - radius)) * step;
    }
    filter->inverse[FILTER_STEPS] = radius;
}

static double sample_axis(const Filter *filter, double at, double *weight)
{
    double place = at * FILTER_STEPS;
    int step = (int)place;
    double low = filter->inverse[step], high = filter->inverse[step + 1];
    double x = low + (place - step) * (high - low);
    double value = filter_value(filter->kind, x);
    double density = 1.0 / (FILTER_STEPS * (high - low));
    *weight *= value / density * filter->scale;
    return x;
}

FilterSample filter_sample(const Filter *filter, SamplePoint at)
{
    if (filter->kind == FILTER_BOX) {
        return (FilterSample){at.x - 0.5, at.y - 0.5, 1.0};
    }
    FilterSample sample = {.weight = 1.0};
    sample.x = sample_axis(filter, at.x, &sample.weight);
    sample.y = sample_axis(filter, at.y, &sample.weight);
    return sample;
}
