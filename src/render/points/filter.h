// Reconstruction filters: how the light of a pixel is weighted over the points around its middle.
//
// Turns a point of the unit square into a place and a weight. A pixel's samples are spread as its filter says, each
// counts for the same (or, where a filter is negative, for the opposite): M. Ernst et al., "Filter importance
// sampling", RT 2006. So a pixel needs no other pixel's samples, and errors of pixels are independent.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_POINTS_FILTER_H
#define RENDER_POINTS_FILTER_H

#include "render/points/sampler.h"

typedef enum FilterKind {
    FILTER_BOX,      // the pixel's square
    FILTER_TENT,     // falls linearly to 0 at distance 1
    FILTER_GAUSSIAN, // exp(-2 x²) less its value at 1.5, where it ends
    FILTER_MITCHELL, // B = C = 1/3, to distance 2; D. Mitchell and A. Netravali, SIGGRAPH 1988
    FILTER_COUNT,
} FilterKind;

// "box", …; NULL for FILTER_COUNT.
const char *filter_name(FilterKind kind);

enum { FILTER_STEPS = 4096 };

// A filter prepared: the inverse of the integral of its size along one axis.
typedef struct Filter {
    FilterKind kind;
    double inverse[FILTER_STEPS + 1]; // place for each step of the integral; not of the box
    double weight;                    // of a sample along one axis, but for its sign; 1 where none is negative
} Filter;

void filter_init(Filter *filter, FilterKind kind);

typedef struct FilterSample {
    double x, y;   // from the pixel's middle, in pixels
    double weight; // of mean 1; 1 where the filter is positive, so that even light stays even
} FilterSample;

FilterSample filter_sample(const Filter *filter, SamplePoint at);

// How far it reaches along one axis, in pixels.
double filter_radius(FilterKind kind);

// The filter itself along one axis, not scaled.
double filter_value(FilterKind kind, double x);

#endif
