// The patterns' table.
//
// Turns types into words; owns constant data only. How a pattern is worked out is the renderer's.
//
// SPDX-License-Identifier: MIT
#include "scene/pattern.h"

static const PatternInfo patterns[PATTERN_COUNT] = {
    [PATTERN_NONE] = {""},
    [PATTERN_CHECKER] = {"checker", PATTERN_OF_BLOCKS, .blocks = 2},
    [PATTERN_HEXAGON] = {"hexagon", PATTERN_OF_BLOCKS, .blocks = 3},
    [PATTERN_BRICK] = {"brick", PATTERN_OF_BLOCKS, .blocks = 2},
    [PATTERN_GRADIENT] = {"gradient", .has_direction = true},
    [PATTERN_RADIAL] = {"radial"},
    [PATTERN_ONION] = {"onion"},
    [PATTERN_LEOPARD] = {"leopard"},
    [PATTERN_SPHERICAL] = {"spherical"},
    [PATTERN_PLANAR] = {"planar"},
    [PATTERN_BOXED] = {"boxed"},
    [PATTERN_CYLINDRICAL] = {"cylindrical"},
    [PATTERN_BOZO] = {"bozo", .uses_noise = true},
    [PATTERN_BUMPS] = {"bumps", .uses_noise = true, .is_special_normal = true},
    [PATTERN_SPOTTED] = {"spotted", .uses_noise = true},
    [PATTERN_GRANITE] = {"granite", .uses_noise = true},
    [PATTERN_AGATE] = {"agate", .uses_noise = true},
    [PATTERN_MARBLE] = {"marble", .has_own_turbulence = true, .wave = WAVE_TRIANGLE},
    [PATTERN_WOOD] = {"wood", .has_own_turbulence = true, .wave = WAVE_TRIANGLE},
    [PATTERN_WRINKLES] = {"wrinkles", .uses_noise = true, .is_special_normal = true},
    [PATTERN_DENTS] = {"dents", .uses_noise = true, .is_special_normal = true},
    [PATTERN_RIPPLES] = {"ripples", .uses_noise = true, .is_special_normal = true},
    [PATTERN_WAVES] = {"waves", .uses_noise = true, .is_special_normal = true},
    [PATTERN_IMAGE_MAP] = {"image_map", PATTERN_OF_COLOURS},
    [PATTERN_CELLS] = {"cells", .uses_noise = true},
    [PATTERN_CRACKLE] = {"crackle", .uses_noise = true},
    [PATTERN_SPIRAL1] = {"spiral1", .has_count = true, .wave = WAVE_TRIANGLE},
    [PATTERN_MANDEL] = {"mandel", .has_count = true},
    [PATTERN_JULIA] = {"julia", .has_direction = true, .has_count = true},
    [PATTERN_QUILTED] = {"quilted", .is_special_normal = true},
    [PATTERN_AVERAGE] = {"average", PATTERN_OF_ALL},
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
