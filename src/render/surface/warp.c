// Warps, one small function for each, in a table.
//
// Turns a point into another one; owns constant data only. The formulas were fitted to what POV-Ray draws;
// docs/language.md, "Patterns".
//
// SPDX-License-Identifier: MIT
#include "render/surface/warp.h"

#include <math.h>

#include "math/noise.h"

typedef Vec3 (*WarpFunction)(const Warp *warp, const NoiseSource *source, Vec3 p);

static const double two_pi = 6.28318530717958647693;

static Vec3 turbulence(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    Octaves octaves = {warp->lambda, warp->omega, warp->octaves};
    return vec3_add(p, vec3_mul(warp->vector, noise_vector_sum(source->noise, &octaves, p)));
}

// The number of the slice in which a coordinate lies; what is left of it is from 0 to the width.
static double slice(double width, double *along)
{
    double number = floor(*along / width);
    *along -= number * width;
    return number;
}

static double turned(double component, double flip)
{
    return flip != 0.0 ? -component : component;
}

static Vec3 repeat(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)source;
    const Vec3 *width = &warp->vector;
    bool is_x = width->x != 0.0, is_y = !is_x && width->y != 0.0;
    double number = is_x ? slice(width->x, &p.x) : is_y ? slice(width->y, &p.y) : slice(width->z, &p.z);
    if (fmod(number, 2.0) != 0.0) {
        bool is_z = !is_x && !is_y;
        const Vec3 *flip = &warp->flip;
        p.x = is_x && flip->x != 0.0 ? width->x - p.x : turned(p.x, flip->x);
        p.y = is_y && flip->y != 0.0 ? width->y - p.y : turned(p.y, flip->y);
        p.z = is_z && flip->z != 0.0 ? width->z - p.z : turned(p.z, flip->z);
    }
    return vec3_add_scaled(p, number, warp->offset);
}

bool warp_needs_noise(const Warp *warp)
{
    return warp->type == WARP_TURBULENCE || (warp->type == WARP_BLACK_HOLE && vec3_length_squared(warp->offset) > 0.0);
}

// The number of the slice that a coordinate is in.
static double slice_of(double width, double coordinate)
{
    return width > 0.0 ? floor(coordinate / width) : 0.0;
}

// Where the hole is in the part of space that a point is in; by chance, from there, as crackle has its sites. Measured.
static Vec3 hole_middle(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    Vec3 width = warp->flip;
    Vec3 part = vec3(slice_of(width.x, p.x), slice_of(width.y, p.y), slice_of(width.z, p.z));
    Vec3 middle = vec3_add(warp->vector, vec3_mul(part, width));
    static const double largest = 1e15; // parts beyond have no whole numbers to speak of
    bool is_near = fabs(part.x) < largest && fabs(part.y) < largest && fabs(part.z) < largest;
    return !is_near || !warp_needs_noise(warp)
               ? middle
               : vec3_add(middle, vec3_mul(vec3_sub(noise_site(source->noise, part), part), warp->offset));
}

static Vec3 black_hole(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    Vec3 way = vec3_sub(p, hole_middle(warp, source, p));
    double distance = vec3_length(way);
    if (!(distance < warp->radius) || distance == 0.0) {
        return p;
    }
    double pull = fmin(pow((warp->radius - distance) / warp->radius, warp->power) * warp->strength, 1.0);
    return vec3_add_scaled(p, warp->flags & WARP_INVERSE ? -pull : pull, way);
}

// ---- mappings: two coordinates of a surface, and the distance that the third one is

// A vector as the orientation has it: turned where that is along an axis, and sheared elsewhere, as in POV-Ray.
// Measured.
static Vec3 turn_back(const Warp *warp, Vec3 p)
{
    Vec3 to = vec3_normalize(warp->vector);
    return vec3((to.z + to.y) * p.x + to.x * p.z, (to.z + to.x) * p.y - to.y * p.z,
                -to.x * p.x + to.y * p.y + to.z * p.z);
}

static Vec3 planar(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)source;
    return turn_back(warp, vec3(p.x, p.y, warp->radius));
}

// The share of a turn about y from +x to +z, from 0 to 1.
static double turn_of(Vec3 p)
{
    double turn = p.x == 0.0 && p.z == 0.0 ? 0.0 : atan2(p.z, p.x) / two_pi;
    return turn < 0.0 ? turn + 1.0 : turn;
}

static double stretch(const Warp *warp, double distance)
{
    return warp->exponent == 0.0 ? 1.0 : pow(distance, warp->exponent);
}

static Vec3 cylindrical(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)source;
    double radius = sqrt(p.x * p.x + p.z * p.z);
    return turn_back(warp, vec3(turn_of(p) * stretch(warp, radius), p.y, radius));
}

static Vec3 spherical(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)source;
    double radius = vec3_length(p), wide = stretch(warp, radius);
    double height = radius > 0.0 ? 0.5 + 2.0 * asin(p.y / radius) / two_pi : 0.5;
    return turn_back(warp, vec3(turn_of(p) * wide, height * wide, radius));
}

static Vec3 toroidal(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)source;
    double aside = sqrt(p.x * p.x + p.z * p.z) - warp->radius;
    double distance = sqrt(aside * aside + p.y * p.y), wide = stretch(warp, distance);
    double around = distance > 0.0 ? 0.5 + atan2(p.y, aside) / two_pi : 0.5;
    return turn_back(warp, vec3(turn_of(p) * wide, around * wide, distance));
}

// The cube unfolded that a point is seen on from the origin, as a box has it (trace/surface_map.c). Where two faces are
// as far away, the one that is tested first has it; the origin itself, of which POV-Ray makes no number, lies on +x.
static Vec3 cubic(const Warp *warp, const NoiseSource *source, Vec3 p)
{
    (void)warp;
    (void)source;
    double ax = fabs(p.x), ay = fabs(p.y), az = fabs(p.z), far = fmax(ax, fmax(ay, az));
    double half = far > 0.0 ? 0.5 / far : 0.0;
    double x = 0.5 + half * p.x, y = 0.5 + half * p.y, z = 0.5 + half * p.z, v = (1.0 + y) / 3.0;
    if (p.x == far) {
        return vec3((3.0 - z) / 4.0, v, far);
    }
    if (p.y == far) {
        return vec3((1.0 + x) / 4.0, (3.0 - z) / 3.0, far);
    }
    if (p.z == far) {
        return vec3((1.0 + x) / 4.0, v, far);
    }
    if (ax == far) {
        return vec3(z / 4.0, v, far);
    }
    return ay == far ? vec3((1.0 + x) / 4.0, z / 3.0, far) : vec3((4.0 - x) / 4.0, v, far);
}

static const WarpFunction functions[WARP_TYPES] = {
    [WARP_TURBULENCE] = turbulence,   [WARP_REPEAT] = repeat,
    [WARP_BLACK_HOLE] = black_hole,   [WARP_PLANAR] = planar,
    [WARP_CYLINDRICAL] = cylindrical, [WARP_SPHERICAL] = spherical,
    [WARP_TOROIDAL] = toroidal,       [WARP_CUBIC] = cubic,
};

Vec3 warp_point(const Pattern *pattern, const NoiseSource *source, Vec3 point)
{
    for (uint32_t i = pattern->warps - 1; i != UINT32_MAX; i = source->warps[i].next) {
        const Warp *warp = &source->warps[i];
        point = transform_point(&source->warp_back[i], functions[warp->type](warp, source, point));
    }
    return point;
}
