// The patterns' table.
//
// Turns types into words; owns constant data only. How a pattern is worked out is the renderer's.
//
// SPDX-License-Identifier: MIT
#include "scene/pattern.h"

static const PatternInfo patterns[PATTERN_COUNT] = {
    [PATTERN_NONE] = {"", 0, false},
    [PATTERN_CHECKER] = {"checker", 2, false},
    [PATTERN_HEXAGON] = {"hexagon", 3, false},
    [PATTERN_BRICK] = {"brick", 2, false},
    [PATTERN_GRADIENT] = {"gradient", 0, true},
    [PATTERN_RADIAL] = {"radial", 0, false},
    [PATTERN_ONION] = {"onion", 0, false},
    [PATTERN_LEOPARD] = {"leopard", 0, false},
    [PATTERN_SPHERICAL] = {"spherical", 0, false},
    [PATTERN_PLANAR] = {"planar", 0, false},
    [PATTERN_BOXED] = {"boxed", 0, false},
    [PATTERN_CYLINDRICAL] = {"cylindrical", 0, false},
};

static const char *const waves[] = {
    [WAVE_RAMP] = "ramp_wave",       [WAVE_TRIANGLE] = "triangle_wave", [WAVE_SINE] = "sine_wave",
    [WAVE_SCALLOP] = "scallop_wave", [WAVE_CUBIC] = "cubic_wave",       [WAVE_POLY] = "poly_wave",
};

const PatternInfo *pattern_info(PatternType type)
{
    return &patterns[type];
}

const char *pattern_wave_word(WaveType wave)
{
    return waves[wave];
}
