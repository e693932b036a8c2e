// Filters, sampled through tables of their inverse integrals.
//
// Between the steps of a table the density is even: of a filter's weight less than 1 in 4096 lies a little beside where
// it should. Weights that put that right would make noise of even light.
//
// SPDX-License-Identifier: MIT
#include "render/points/filter.h"

#include <math.h>
#include <stddef.h>

const char *filter_name(FilterKind kind)
{
    static const char *const names[] = {
        [FILTER_BOX] = "box", [FILTER_TENT] = "tent", [FILTER_GAUSSIAN] = "gaussian", [FILTER_MITCHELL] = "mitchell"};
    return kind < FILTER_COUNT ? names[kind] : NULL;
}

double filter_radius(FilterKind kind)
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

static double sample_axis(const Filter *filter, double at, double *weight)
{
    double place = at * FILTER_STEPS;
    int step = (int)place;
    double low = filter->inverse[step], high = filter->inverse[step + 1];
    double x = low + (place - step) * (high - low);
    *weight *= filter_value(filter->kind, x) < 0.0 ? -filter->weight : filter->weight;
    return x;
}

enum { FINE = 16 * FILTER_STEPS };

// The integral of the filter's size is taken in fine steps by the middle rule.
static void fill_inverse(Filter *filter)
{
    double radius = filter_radius(filter->kind), step = 2.0 * radius / FINE, size = 0.0, reached = 0.0;
    for (int i = 0; i < FINE; i++) {
        size += fabs(filter_value(filter->kind, (i + 0.5) * step - radius));
    }
    int next = 0;
    for (int i = 0; i < FINE; i++) {
        double part = fabs(filter_value(filter->kind, (i + 0.5) * step - radius)) / size;
        for (; next < FILTER_STEPS && reached + part > (double)next / FILTER_STEPS; next++) {
            double within = ((double)next / FILTER_STEPS - reached) / part;
            filter->inverse[next] = (i + fmax(within, 0.0)) * step - radius;
        }
        reached += part;
    }
    for (; next <= FILTER_STEPS; next++) {
        filter->inverse[next] = radius;
    }
}

// So that weights of both signs have the mean 1.
static double weight_of_signs(const Filter *filter)
{
    double sum = 0.0;
    for (int i = 0; i < FINE; i++) {
        double weight = 1.0;
        (void)sample_axis(filter, (i + 0.5) / FINE, &weight);
        sum += weight;
    }
    return FINE / sum;
}

void filter_init(Filter *filter, FilterKind kind)
{
    *filter = (Filter){.kind = kind, .weight = 1.0};
    if (kind != FILTER_BOX) {
        fill_inverse(filter);
        filter->weight = weight_of_signs(filter);
    }
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
