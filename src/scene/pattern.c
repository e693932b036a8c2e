// The patterns' table.
//
// Turns types into words; owns constant data only. How a pattern is computed is the renderer's.
//
// SPDX-License-Identifier: MIT
#include "scene/pattern.h"

static const PatternInfo patterns[PATTERN_COUNT] = {
    [PATTERN_NONE] = {.word = ""},
    [PATTERN_CHECKER] = {.word = "checker", .form = PATTERN_OF_BLOCKS, .blocks = 2},
    [PATTERN_HEXAGON] = {.word = "hexagon", .form = PATTERN_OF_BLOCKS, .blocks = 3},
    [PATTERN_BRICK] = {.word = "brick", .form = PATTERN_OF_BLOCKS, .blocks = 2},
    [PATTERN_GRADIENT] = {.word = "gradient", .has_direction = true},
    [PATTERN_RADIAL] = {.word = "radial"},
    [PATTERN_ONION] = {.word = "onion"},
    [PATTERN_LEOPARD] = {.word = "leopard"},
    [PATTERN_SPHERICAL] = {.word = "spherical"},
    [PATTERN_PLANAR] = {.word = "planar"},
    [PATTERN_BOXED] = {.word = "boxed"},
    [PATTERN_CYLINDRICAL] = {.word = "cylindrical"},
    [PATTERN_BOZO] = {.word = "bozo", .uses_noise = true},
    [PATTERN_BUMPS] = {.word = "bumps", .uses_noise = true, .is_special_normal = true},
    [PATTERN_SPOTTED] = {.word = "spotted", .uses_noise = true},
    [PATTERN_GRANITE] = {.word = "granite", .uses_noise = true},
    [PATTERN_AGATE] = {.word = "agate", .uses_noise = true},
    [PATTERN_MARBLE] = {.word = "marble", .has_own_turbulence = true, .wave = WAVE_TRIANGLE},
    [PATTERN_WOOD] = {.word = "wood", .has_own_turbulence = true, .wave = WAVE_TRIANGLE},
    [PATTERN_WRINKLES] = {.word = "wrinkles", .uses_noise = true, .is_special_normal = true},
    [PATTERN_DENTS] = {.word = "dents", .uses_noise = true, .is_special_normal = true},
    [PATTERN_RIPPLES] = {.word = "ripples", .uses_noise = true, .is_special_normal = true},
    [PATTERN_WAVES] = {.word = "waves", .uses_noise = true, .is_special_normal = true},
    [PATTERN_IMAGE_MAP] = {.word = "image_map", .form = PATTERN_OF_COLOURS},
    [PATTERN_CELLS] = {.word = "cells", .uses_noise = true},
    [PATTERN_CRACKLE] = {.word = "crackle", .uses_noise = true},
    [PATTERN_SPIRAL1] = {.word = "spiral1", .has_count = true, .wave = WAVE_TRIANGLE},
    [PATTERN_SPIRAL2] = {.word = "spiral2", .has_count = true, .wave = WAVE_TRIANGLE},
    [PATTERN_FUNCTION] = {.word = "function"},
    [PATTERN_PIGMENT] = {.word = "pigment_pattern"},
    [PATTERN_SLOPE] = {.word = "slope", .is_of_surface = true},
    [PATTERN_AOI] = {.word = "aoi", .is_of_surface = true},
    [PATTERN_IMAGE_PATTERN] = {.word = "image_pattern"},
    [PATTERN_BUMP_MAP] = {.word = "bump_map", .is_special_normal = true},
    [PATTERN_MATERIAL_MAP] = {.word = "material_map", .form = PATTERN_OF_BLOCKS},
    [PATTERN_DENSITY_FILE] = {.word = "density_file"},
    [PATTERN_MANDEL] = {.word = "mandel", .has_count = true},
    [PATTERN_JULIA] = {.word = "julia", .has_direction = true, .has_count = true},
    [PATTERN_QUILTED] = {.word = "quilted", .is_special_normal = true},
    [PATTERN_OBJECT] = {.word = "object", .form = PATTERN_OF_BLOCKS, .blocks = 2},
    [PATTERN_AVERAGE] = {.word = "average", .form = PATTERN_OF_ALL},
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
