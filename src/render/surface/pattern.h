// Patterns at a point: the value of one that varies, the block of one that fills space with blocks.
//
// Points are in the pattern's own space. The formulas are those of the scene language's manual, with what it leaves
// open measured; docs/language.md, "Patterns". Knows nothing of colours.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_PATTERN_H
#define RENDER_SURFACE_PATTERN_H

#include "base/attributes.h"
#include "math/noise.h"
#include "math/vec3.h"
#include "math/transform.h"
#include "render/surface/escape_kernel.h"
#include "scene/formula.h"
#include "scene/pattern.h"
#include "scene/warp.h"

// Whether a pattern's value depends on noise.
bool pattern_needs_noise(const Pattern *pattern);
// Whether it needs sources of waves, too.
bool pattern_needs_waves(const Pattern *pattern);

// What a scene's patterns take their noise from.
typedef struct NoiseSource {
    const Noise *noise;       // NULL when no pattern of the scene needs noise
    NoiseGenerator generator; // of patterns that say nothing else
    const WaveSource *waves;  // NULL when no pattern of the scene has waves
    unsigned wave_count;
    const EscapeKernel *escape;
    // What patterns are made of that others lie behind: the scene's records, and the textures themselves.
    const Warp *warps;
    const Transform *warp_back; // of each warp, into the space behind it
    const FormulaStep *steps;
    struct Scene *const *insides;
    const struct TextureTable *table;
    const struct Facing *facing; // of a surface; NULL where there is none
} NoiseSource;

// The point in the space around a pattern's transform: surface coordinates where it has those.
static inline Vec3 texture_space(const Pattern *pattern, Vec3 outer, const Vec3 *uv)
{
    return RT_UNLIKELY(pattern->flags & PATTERN_ON_SURFACE) && uv ? *uv : outer;
}

// The point at which a pattern is looked at: moved, if it has turbulence that is no part of its formula.
Vec3 pattern_moved(const Pattern *pattern, const NoiseSource *source, Vec3 point);

// After turbulence, frequency, phase and wave; of blocks the number of the kind that is there, if nothing is said of
// frequency and wave.
double pattern_value(const Pattern *pattern, const NoiseSource *source, Vec3 point);

// The same at a point that is moved already.
double pattern_value_moved(const Pattern *pattern, const NoiseSource *source, Vec3 moved);

// Whether pattern_values_moved takes less time than one point after another.
bool pattern_goes_abreast(const Pattern *pattern);

// pattern_value_moved of each point.
void pattern_values_moved(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *moved,
                          double *values);

#endif
