// See dome.h.
//
// SPDX-License-Identifier: MIT
#include "render/shade/dome.h"

#include <math.h>
#include <string.h>

enum { FEATURES = RENDER_ALL_FEATURES | TRACE_ALL_FEATURES };

static const double quarter_turn = 0x1.921fb54442d18p-1; // pi / 4

// Sine and cosine of an angle of at most an eighth of a turn, by their series up to 2^-53: the bits do not depend on a
// machine's functions.
static void turn_of(double angle, double *sine, double *cosine)
{
    double square = angle * angle, s = 0.0, c = 0.0;
    for (int n = 16; n >= 2; n -= 2) {
        c = (1.0 - c) * square / (double)((n - 1) * n);
        s = (1.0 - s) * square / (double)(n * (n + 1));
    }
    *cosine = 1.0 - c;
    *sine = angle * (1.0 - s);
}

// The square onto the unit disc, areas kept in proportion and squares around the middle made circles: P. Shirley and K.
// Chiu, "A low distortion map between disk and square", Journal of Graphics Tools 2(3), 1997. Returns the distance from
// the middle.
static double disc_of(SamplePoint at, double *x, double *y)
{
    double a = 2.0 * at.x - 1.0, b = 2.0 * at.y - 1.0, sine, cosine;
    if (a == 0.0 && b == 0.0) {
        *x = 1.0;
        *y = 0.0;
        return 0.0;
    }
    bool is_across = fabs(a) > fabs(b);
    turn_of(quarter_turn * (is_across ? b / a : a / b), &sine, &cosine);
    double radius = is_across ? a : b;
    double sign = radius < 0.0 ? -1.0 : 1.0;
    *x = sign * (is_across ? cosine : sine);
    *y = sign * (is_across ? sine : cosine);
    return fabs(radius);
}

// Two directions at right angles to a unit normal and to each other: T. Duff et al., "Building an orthonormal basis,
// revisited", JCGT 6(1), 2017.
static void basis_of(Vec3 n, Vec3 *across, Vec3 *along)
{
    double sign = copysign(1.0, n.z), a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    *across = vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *along = vec3(b, sign + n.y * n.y * a, -n.y);
}

// A direction on the side of a unit normal, of a density that goes with its cosine to the power of exponent - 1, for a
// point of the unit square; of unit length. `exponent` is at least 1.
static Vec3 dome_direction(Vec3 normal, double exponent, SamplePoint at)
{
    double x, y, radius = disc_of(at, &x, &y), left = 1.0 - radius * radius;
    double cosine = exponent == 2.0 ? sqrt(left) : pow(left, 1.0 / exponent);
    double aside = exponent == 2.0 ? radius : sqrt(greater_of(1.0 - cosine * cosine, 0.0));
    Vec3 across, along;
    basis_of(normal, &across, &along);
    Vec3 sideways = vec3_add_scaled(vec3_scale(aside * x, across), aside * y, along);
    return vec3_add_scaled(sideways, cosine, normal);
}

// What the surface of a single ray draws from: keyed by its place, as the `jitter` of area lights is.
static SampleStream own_stream(const Prepared *p, Vec3 point, bool is_back)
{
    uint64_t bits[3], key = light_mix(p->seed ^ is_back);
    memcpy(bits, (double[]){point.x, point.y, point.z}, sizeof bits);
    for (int axis = 0; axis < 3; axis++) {
        key = light_mix(key ^ bits[axis]);
    }
    return (SampleStream){.kind = SAMPLER_SOBOL, .seed = (uint32_t)(key >> 32)};
}

// The mean of what gets to the point from the side of a normal, by colour.
static Rgb share_of_side(const Prepared *p, const ShadingPoint *at, Vec3 normal, bool is_back, double exponent,
                         RenderStatistics *statistics)
{
    Rgb sum = rgb_grey(0.0);
    uint32_t blocker = NO_BLOCKER;
    SampleStream own = {.kind = SAMPLER_SOBOL};
    int ways = at->stream ? 1 : DOME_WAYS;
    if (!at->stream) {
        own = own_stream(p, at->point, is_back);
    }
    for (int i = 0; i < ways; i++) {
        own.index = (uint32_t)i;
        own.pair = 0;
        Vec3 towards = dome_direction(normal, exponent, sample_next(at->stream ? at->stream : &own));
        const ShadeWay way = {.towards = towards, .distance = (double)INFINITY};
        sum = rgb_add(sum, shade_visibility(p, FEATURES, at, &way, &blocker, statistics));
    }
    return rgb_scale(1.0 / ways, sum);
}

Rgb dome_light(const Prepared *p, const ShadeMaterial *material, const ShadingPoint *at, RenderStatistics *statistics)
{
    const PreparedFinish *finish = material->finish;
    Rgb sum = rgb_grey(0.0);
    // A brilliance below 0, for which there is no mean, counts as 0.
    double exponent = greater_of(finish->brilliance, 0.0) + 1.0;
    for (int back = 0; back < 2; back++) {
        double amount = back ? finish->diffuse_back : finish->diffuse;
        if (amount > 0.0 && !rgb_is_black(material->opaque)) {
            Vec3 normal = back ? vec3_neg(at->normal) : at->normal;
            Rgb share = share_of_side(p, at, normal, back, exponent, statistics);
            sum = rgb_add_scaled(sum, amount * (2.0 / exponent), rgb_mul(share, material->opaque));
        }
    }
    return rgb_mul(sum, p->dome);
}
