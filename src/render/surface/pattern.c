// Patterns: one small function for each, in a table.
//
// Turns a point into a number; owns constant data only.
//
// SPDX-License-Identifier: MIT
#include "render/surface/pattern.h"

#include <math.h>
#include <string.h>

#include "base/attributes.h"
#include "base/isa.h"
#include "math/rest.h"
#include "render/surface/facing.h"
#include "render/surface/formula.h"
#include "render/surface/normal_special.h"
#include "render/surface/pattern_fractal.h"
#include "render/surface/pattern_noise.h"
#include "render/surface/warp.h"
#include "scene/within.h"

static const double pi = 3.14159265358979323846;

// ---- values

// Begins anew at 1, but not at 0; so does onion.
static double gradient(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)source;
    double along = vec3_dot(pattern->vector, p) / vec3_length(pattern->vector);
    return along > 1.0 ? fraction_of(along) : along;
}

static double radial(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return p.x == 0.0 && p.z == 0.0 ? 0.25 : 0.25 + (atan2(p.x, p.z) + pi) / (2.0 * pi);
}

static double onion(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return fraction_of(vec3_length(p));
}

static double leopard(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    double mean = (sin(p.x) + sin(p.y) + sin(p.z)) / 3.0;
    return mean * mean;
}

static double spherical(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return fmax(1.0 - vec3_length(p), 0.0);
}

static double planar(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return fmax(1.0 - fabs(p.y), 0.0);
}

static double boxed(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return fmax(1.0 - vec3_max_abs(p), 0.0);
}

static double cylindrical(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    return fmax(1.0 - sqrt(p.x * p.x + p.z * p.z), 0.0);
}

static double quilted(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Vec3 turn = normal_special(pattern, source, p);
    return (fabs(turn.x) + fabs(turn.y) + fabs(turn.z)) / 3.0;
}

// ---- blocks: the number of the kind that is there

// What is left of x after whole periods, in [0, period).
static double remainder_of(double x, double period)
{
    return x - period * floor(x / period);
}

// floor of a number that is not too large for it.
static inline int64_t whole_below(double x)
{
    int64_t whole = (int64_t)x;
    return whole - ((double)whole > x);
}

static double checker(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    p = pattern_nudged(p);
    const double most = 0x1p52; // beyond, the sum may be no whole number of 64 bits
    if (fabs(p.x) < most && fabs(p.y) < most && fabs(p.z) < most) {
        return (double)((whole_below(p.x) + whole_below(p.y) + whole_below(p.z)) & 1);
    }
    return remainder_of(floor(p.x) + floor(p.y) + floor(p.z), 2.0);
}

// The middles are at q <3/2, 0, h> + r <0, 0, 2 h>, where h is POV-Ray's sqrt(3)/2, rounded to nine digits, as measured.
// A point belongs to the one that its fractional q, r and s = -q - r round to, the coordinate that was rounded furthest
// being made the sum of the others. What lies on a seam along x is of the upper one.
static double hexagon(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)pattern;
    (void)source;
    double q = p.x / 1.5, row = p.z / (2.0 * 0.866025404), r = row - q / 2.0, s = -q - r;
    double q_whole = floor(q + 0.5), r_whole = floor(r + 0.5), s_whole = floor(s + 0.5);
    double q_off = fabs(q_whole - q);
    if (q_off > fabs(r_whole - r) && q_off > fabs(s_whole - s)) {
        q_whole = -r_whole - s_whole;
    } else {
        r_whole = floor(row - q_whole / 2.0 + 0.5);
    }
    double colour = fmod(2.0 * q_whole + r_whole, 3.0);
    return colour < 0.0 ? colour + 3.0 : fabs(colour); // -0 becomes 0
}

// Mortar (0) fills the end of each period of x, y and z. Odd courses are moved by half a brick in x, even ones in z.
static double brick(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    (void)source;
    p = pattern_nudged(p);
    Vec3 size = pattern->vector;
    bool is_odd = remainder_of(floor(p.y / size.y), 2.0) != 0.0;
    double x = remainder_of(is_odd ? p.x + size.x / 2.0 : p.x, size.x);
    double y = remainder_of(p.y, size.y);
    double z = remainder_of(is_odd ? p.z : p.z + size.z / 2.0, size.z);
    bool is_mortar = x >= size.x - pattern->mortar || y >= size.y - pattern->mortar || z >= size.z - pattern->mortar;
    return is_mortar ? 0.0 : 1.0;
}

static double inside(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return within_inside(source->insides[pattern->image], p) ? 1.0 : 0.0;
}

static const PatternFunction values[PATTERN_COUNT] = {
    [PATTERN_CHECKER] = checker,
    [PATTERN_HEXAGON] = hexagon,
    [PATTERN_BRICK] = brick,
    [PATTERN_GRADIENT] = gradient,
    [PATTERN_RADIAL] = radial,
    [PATTERN_ONION] = onion,
    [PATTERN_LEOPARD] = leopard,
    [PATTERN_SPHERICAL] = spherical,
    [PATTERN_PLANAR] = planar,
    [PATTERN_BOXED] = boxed,
    [PATTERN_CYLINDRICAL] = cylindrical,
    [PATTERN_BOZO] = pattern_noise,
    [PATTERN_BUMPS] = pattern_noise,
    [PATTERN_SPOTTED] = pattern_noise,
    [PATTERN_GRANITE] = pattern_granite,
    [PATTERN_AGATE] = pattern_agate,
    [PATTERN_MARBLE] = pattern_marble,
    [PATTERN_WOOD] = pattern_wood,
    [PATTERN_WRINKLES] = pattern_wrinkles,
    [PATTERN_DENTS] = pattern_dents,
    [PATTERN_RIPPLES] = pattern_ripples,
    [PATTERN_WAVES] = pattern_waves,
    [PATTERN_CELLS] = pattern_cells,
    [PATTERN_CRACKLE] = pattern_crackle,
    [PATTERN_SPIRAL1] = pattern_spiral1,
    [PATTERN_SPIRAL2] = pattern_spiral2,
    [PATTERN_FUNCTION] = formula_value,
    [PATTERN_PIGMENT] = formula_pigment,
    [PATTERN_SLOPE] = facing_slope,
    [PATTERN_AOI] = facing_aoi,
    [PATTERN_IMAGE_PATTERN] = formula_picture,
    [PATTERN_DENSITY_FILE] = formula_density,
    [PATTERN_MATERIAL_MAP] = formula_material,
    [PATTERN_MANDEL] = pattern_fractal,
    [PATTERN_JULIA] = pattern_fractal,
    [PATTERN_QUILTED] = quilted,
    [PATTERN_OBJECT] = inside,
};

static double wave(const Pattern *pattern, double x)
{
    switch ((WaveType)pattern->wave) {
    case WAVE_RAMP:
        return x;
    case WAVE_TRIANGLE:
        x = fraction_of(x);
        return x < 0.5 ? 2.0 * x : 2.0 - 2.0 * x;
    case WAVE_SINE:
        return (1.0 + sin(2.0 * pi * x)) / 2.0;
    case WAVE_SCALLOP:
        return fabs(sin(pi * x));
    case WAVE_CUBIC:
        return x * x * (3.0 - 2.0 * x);
    case WAVE_POLY:
        return pow(x, pattern->exponent);
    }
    return x;
}

static bool has_turbulence(const Pattern *pattern)
{
    return pattern->turbulence.x != 0.0 || pattern->turbulence.y != 0.0 || pattern->turbulence.z != 0.0;
}

bool pattern_needs_noise(const Pattern *pattern)
{
    return pattern_info((PatternType)pattern->type)->uses_noise || has_turbulence(pattern);
}

bool pattern_needs_waves(const Pattern *pattern)
{
    return pattern->type == PATTERN_RIPPLES || pattern->type == PATTERN_WAVES;
}

// Turbulence moves a point last, in the pattern's own space, wherever it was said.
Vec3 pattern_moved(const Pattern *pattern, const NoiseSource *source, Vec3 point)
{
    if (pattern->warps) {
        point = warp_point(pattern, source, point);
    }
    bool is_moved = has_turbulence(pattern) && !pattern_info((PatternType)pattern->type)->has_own_turbulence;
    return is_moved ? pattern_turbulent(pattern, source, point) : point;
}

// What is above 1 begins the map anew. POV-Ray does so after 1.00001, so that 1 itself is still the map's end; measured
// with frequencies up to 10^4. What is below 0 is counted from 1 down.
static double finished(const Pattern *pattern, double x)
{
    if (pattern->frequency != 0.0) {
        x = rest_of(x * pattern->frequency + pattern->phase, 1.00001);
    }
    return wave(pattern, x < 0.0 ? x - floor(x) : x);
}

double pattern_value_moved(const Pattern *pattern, const NoiseSource *source, Vec3 moved)
{
    return finished(pattern, values[pattern->type](pattern, source, moved));
}

double pattern_value(const Pattern *pattern, const NoiseSource *source, Vec3 point)
{
    return pattern_value_moved(pattern, source, pattern_moved(pattern, source, point));
}

// ---- many points at once

ISA_LIST(EscapeKernel, escape_kernel_, escape_kernels);

const EscapeKernel *escape_kernel_choose(const char *isa)
{
    for (size_t i = RT_COUNT_OF(escape_kernels); i-- > 0;) {
        if (isa ? strcmp(isa, escape_kernels[i]->name) == 0 : escape_kernels[i]->is_supported()) {
            return escape_kernels[i];
        }
    }
    return escape_kernels[0];
}

// The last point stands in for those that are missing.
static void escapes(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *p, double *shares)
{
    EscapePoints points;
    double all[ESCAPE_ABREAST];
    for (unsigned i = 0; i < ESCAPE_ABREAST; i++) {
        const Vec3 *own = &p[i < count ? i : count - 1];
        points.x[i] = own->x;
        points.y[i] = own->y;
        points.c_x[i] = pattern->type == PATTERN_MANDEL ? own->x : pattern->vector.x;
        points.c_y[i] = pattern->type == PATTERN_MANDEL ? own->y : pattern->vector.y;
    }
    source->escape->shares(&points, pattern->count, all);
    memcpy(shares, all, count * sizeof *shares);
}

static void many_escapes(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *points,
                         double *shares)
{
    for (unsigned from = 0; from < count; from += ESCAPE_ABREAST) {
        unsigned some = count - from < ESCAPE_ABREAST ? count - from : ESCAPE_ABREAST;
        escapes(pattern, source, some, points + from, shares + from);
    }
}

typedef void (*PatternAbreast)(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *points,
                               double *values);

// Of those that take less time so.
static const PatternAbreast many_values[PATTERN_COUNT] = {
    [PATTERN_BOZO] = pattern_noises,
    [PATTERN_BUMPS] = pattern_noises,
    [PATTERN_SPOTTED] = pattern_noises,
    [PATTERN_MANDEL] = many_escapes,
    [PATTERN_JULIA] = many_escapes,
};

bool pattern_goes_abreast(const Pattern *pattern)
{
    bool is_escape = pattern->type == PATTERN_MANDEL || pattern->type == PATTERN_JULIA;
    return many_values[pattern->type] && (!is_escape || pattern_is_plain_fractal(pattern));
}

void pattern_values_moved(const Pattern *pattern, const NoiseSource *source, unsigned count, const Vec3 *moved,
                          double *shares)
{
    if (!pattern_goes_abreast(pattern)) {
        for (unsigned i = 0; i < count; i++) {
            shares[i] = pattern_value_moved(pattern, source, moved[i]);
        }
        return;
    }
    many_values[pattern->type](pattern, source, count, moved, shares);
    for (unsigned i = 0; i < count; i++) {
        shares[i] = finished(pattern, shares[i]);
    }
}
