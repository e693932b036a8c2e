// From the scene's working space to linear light.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_LINEAR_H
#define RENDER_RECORDS_LINEAR_H

#include <math.h>
#include <stddef.h>

#include "base/attributes.h"
#include "math/colour.h"
#include "math/float_power.h"
#include "scene/scene.h"

// Whether values of the film are not linear light as they stand. Legacy files stay as they are.
static inline bool linear_is_needed(const Settings *settings)
{
    return settings->gamma_model == GAMMA_POWER || settings->gamma_model == GAMMA_SRGB;
}

static inline double linear_value(const Settings *settings, double value)
{
    value = fmax(value, 0.0);
    return settings->gamma_model == GAMMA_SRGB ? rgb_srgb_decode(value) : pow(value, settings->assumed_gamma);
}

// The same, of many values in place.
static inline void linear_floats(const Settings *settings, float *values, size_t count)
{
    if (settings->gamma_model != GAMMA_SRGB) {
        float_power_all(settings->assumed_gamma, values, count);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = (float)linear_value(settings, values[i]);
    }
}

// Back again, for light that is not below 0.
static inline double linear_inverse(const Settings *settings, double light)
{
    return settings->gamma_model == GAMMA_SRGB    ? rgb_srgb_encode(light)
           : settings->gamma_model == GAMMA_POWER ? pow(light, 1.0 / settings->assumed_gamma)
                                                  : light;
}

// How fast linear light changes with the values of a pixel.
static inline Rgb linear_slope(const Settings *settings, const float value[3])
{
    const double step = 0x1p-10; // of a value: the curve is smooth
    double slope[3];
    if (!linear_is_needed(settings)) {
        return rgb_grey(1.0);
    }
    for (int i = 0; i < 3; i++) {
        double low = fmax(value[i] - step, 0.0);
        slope[i] = (linear_value(settings, low + 2.0 * step) - linear_value(settings, low)) / (2.0 * step);
    }
    return rgb(slope[0], slope[1], slope[2]);
}

#endif
