// A row a function.
//
// SPDX-License-Identifier: MIT
#include "math/given_surface.h"

#include <math.h>
#include <stddef.h>

#include "base/number.h"
#include "math/given_curve.h"

typedef double (*Surface)(const Noise *noise, const double *a);

// Most are a polynomial times a field strength, turned round and cut at 10.
static double field(double strength, double value)
{
    double v = -strength * value;
    return v > 10.0 ? 10.0 : v < -10.0 ? -10.0 : v;
}

static double beyond(double x, double half)
{
    return fabs(x) > half ? fabs(x) - half : 0.0;
}

static double rounded_box(const Noise *noise, const double *a)
{
    double r = a[3], x = beyond(a[0], a[4] - r), y = beyond(a[1], a[5] - r), z = beyond(a[2], a[6] - r);
    (void)noise;
    return sqrt(x * x + y * y + z * z) - r - 1e-6;
}

static double torus(const Noise *noise, const double *a)
{
    double from = sqrt(a[0] * a[0] + a[2] * a[2]) - a[3];
    (void)noise;
    return sqrt(from * from + a[1] * a[1]) - a[4];
}

static double torus2(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2], major2 = a[4] * a[4], minor2 = a[5] * a[5];
    double sum = x2 + y2 + z2 + major2 - minor2;
    (void)noise;
    return field(a[3], sum * sum - 4.0 * major2 * (x2 + z2));
}

static double ellipsoid(const Noise *noise, const double *a)
{
    double x = a[0] * a[3], y = a[1] * a[4], z = a[2] * a[5];
    (void)noise;
    return sqrt(x * x + y * y + z * z);
}

static double superellipsoid(const Noise *noise, const double *a)
{
    double across = pow(pow(fabs(a[0]), 2.0 / a[3]) + pow(fabs(a[1]), 2.0 / a[3]), a[3] / a[4]);
    (void)noise;
    return 1.0 - pow(across + pow(fabs(a[2]), 2.0 / a[4]), a[4] * 0.5);
}

static double paraboloid(const Noise *noise, const double *a)
{
    (void)noise;
    return field(a[3], a[0] * a[0] - a[1] + a[2] * a[2]);
}

static double heart(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2], z3 = z2 * a[2], in = 2.0 * x2 + y2 + z2 - 1.0;
    (void)noise;
    return field(a[3], in * in * in - 0.1 * x2 * z3 - y2 * z3);
}

static double steiners_roman(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * z2 + y2 * z2 + x2 * y2 + a[0] * a[1] * a[2]);
}

static double quartic_paraboloid(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 + z2 * z2 - a[1]);
}

static double quartic_saddle(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 - z2 * z2 - a[1]);
}

static double cubic_saddle(const Noise *noise, const double *a)
{
    (void)noise;
    return field(a[3], a[0] * a[0] * a[0] - a[1] * a[1] * a[1] - a[2]);
}

static double crossed_trough(const Noise *noise, const double *a)
{
    (void)noise;
    return field(-a[3], a[0] * a[0] * a[2] * a[2] - a[1]);
}

static double cushion(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z = a[2], z2 = z * z, in = x2 - z;
    (void)noise;
    return field(-a[3], z2 * x2 - z2 * z2 - 2.0 * z * x2 + 2.0 * z2 * z + x2 - z2 - in * in - y2 * y2 - 2.0 * x2 * y2 -
                            y2 * z2 + 2.0 * y2 * z + y2);
}

static double mitre(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], 4.0 * x2 * (x2 + y2 + z2) - y2 * (1.0 - y2 - z2));
}

static double devils_curve(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 + 2.0 * x2 * z2 - 0.36 * x2 - y2 * y2 + 0.25 * y2 + z2 * z2);
}

static double kummer_surface(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 + y2 * y2 + z2 * z2 - x2 - y2 - z2 - x2 * y2 - x2 * z2 - y2 * z2 + 1.0);
}

static double bicorn(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double size2 = a[4] * a[4], in = x2 + z2 + 2.0 * a[4] * a[1] - size2;
    (void)noise;
    return field(a[3], in * in - y2 * (size2 - x2 - z2));
}

static double bifolia(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double sum = x2 + y2 + z2;
    (void)noise;
    return field(a[3], sum * sum - a[4] * a[1] * (x2 + z2));
}

static double boy(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double z = a[2], in = 1.0 - z, across = x2 + y2, root2 = 0x1.6a09e667f3bcdp+0;
    double one = 64.0 * in * in * in * z2 * z - 48.0 * in * in * z2 * (3.0 * across + 2.0 * z2);
    double two =
        27.0 * across * across - 24.0 * z2 * across + 36.0 * root2 * a[1] * z * (y2 - 3.0 * x2) + 4.0 * z2 * z2;
    double three =
        -81.0 * across * across - 72.0 * z2 * across + 108.0 * root2 * a[0] * z * (x2 - 3.0 * y2) + 4.0 * z2 * z2;
    (void)noise;
    return field(-a[3], a[4] * (one + 12.0 * in * z * two + (9.0 * across - 2.0 * z2) * three));
}

static double folium(const Noise *noise, const double *a)
{
    double x = a[0], across = a[1] * a[1] + a[2] * a[2];
    (void)noise;
    return field(-a[3], across * (1.0 + (a[5] - 4.0 * a[4]) * x) + (1.0 + a[5]) * x * x);
}

static double spikes_2d(const Noise *noise, const double *a)
{
    (void)noise;
    return a[1] - a[3] * cos(a[4] * a[0]) * cos(a[5] * a[2]) * exp(-a[6] * (a[0] * a[0] + a[2] * a[2]));
}

static double glob(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], y2 + z2 - 0.5 * x2 * x2 * (a[0] + 1.0));
}

static double hunt(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double ball = x2 + y2 + z2 - 13.0, cone = 3.0 * x2 + y2 - 4.0 * z2 - 12.0;
    (void)noise;
    return field(a[3], 4.0 * ball * ball * ball + 27.0 * cone * cone);
}

static double hyperbolic_torus(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double major2 = a[4] * a[4], sum = x2 + y2 - z2 + major2 - a[5] * a[5];
    (void)noise;
    return field(a[3], sum * sum - 4.0 * major2 * (x2 - z2));
}

static double kampyle(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], y2 + z2 - a[5] * a[5] * (x2 * x2 - a[4] * a[4] * x2));
}

static double klein_bottle(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double sum = x2 + y2 + z2, in = sum - 2.0 * a[1] - 1.0;
    (void)noise;
    return field(a[3], (sum + 2.0 * a[1] - 1.0) * (in * in - 8.0 * z2) + 16.0 * a[0] * a[2] * in);
}

static double kummer_surface2(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 + y2 * y2 + z2 * z2 - 1.0 + a[4] * (x2 + y2 + z2) +
                           a[5] * (x2 * y2 + x2 * z2 + y2 * z2) + a[6] * a[0] * a[1] * a[2]);
}

static double lemniscate(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], x2 * x2 - x2 + y2 + z2);
}

static double nodal_cubic(const Noise *noise, const double *a)
{
    double y = a[1], z = a[2];
    (void)noise;
    return field(a[3], y * y * y + z * z * z - 6.0 * y * z);
}

static double odd(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double across = x2 + y2;
    (void)noise;
    return field(-a[3], across - across * across + 2.0 * y2 * a[2] + (x2 - y2) * z2 - z2 * (2.0 - 2.0 * a[2] + z2));
}

static double ovals_of_cassini(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double major2 = a[4] * a[4], sum = x2 + y2 + z2 + major2;
    (void)noise;
    return field(a[3], sum * sum - a[6] * major2 * (x2 + z2) - a[5] * a[5]);
}

static double parabolic_torus(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], major2 = a[4] * a[4], more = major2 - a[5] * a[5];
    double sum = x2 + y2 - a[2];
    (void)noise;
    return field(a[3], sum * sum + more * sum + more * more - 2.0 * major2 * (x2 - a[2]));
}

static double pillow(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(-a[3], x2 * x2 - x2 + y2 * y2 - y2 + z2 * z2 - z2);
}

static double piriform(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(-a[3], x2 * x2 - x2 * a[0] + y2 + z2);
}

static double quartic_cylinder(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double width2 = a[5] * a[5];
    (void)noise;
    return field(a[3], (x2 + z2) * (y2 + width2) - a[4] * a[4] * width2);
}

static double strophoid(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    (void)noise;
    return field(-a[3], (y2 + z2) * (a[0] - a[5]) + a[6] * a[6] * x2 * (a[0] + a[4]));
}

static double torus_gumdrop(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], y2 = a[1] * a[1], z2 = a[2] * a[2];
    double across = y2 + z2;
    (void)noise;
    return field(a[3], 4.0 * (x2 * x2 + across * across) + 17.0 * x2 * across - 20.0 * (x2 + across) + 17.0);
}

static double umbrella(const Noise *noise, const double *a)
{
    (void)noise;
    return field(a[3], a[0] * a[0] - a[1] * a[2] * a[2]);
}

static double witch_of_agnesi(const Noise *noise, const double *a)
{
    double x2 = a[0] * a[0], z2 = a[2] * a[2];
    (void)noise;
    return field(a[3], a[4] * (a[1] - 1.0) + a[1] * (x2 + z2));
}

// From -length / 2 to length / 2, again and again.
static double nearest(double x, double length)
{
    return x - length * floor(x / length + 0.5);
}

// Towards the side of a tile, and along it from its middle.
typedef struct TilePlace {
    double towards, along;
} TilePlace;

static TilePlace hexagon(double x, double y)
{
    const double root3 = 0x1.bb67ae8584caap+0;
    x = fabs(nearest(x, root3));
    y = fabs(nearest(y, 3.0));
    double slope = x / 2.0 + root3 / 2.0 * y;
    return x > slope ? (TilePlace){x, y} : (TilePlace){slope, fabs(root3 / 2.0 * x - y / 2.0)};
}

static TilePlace hexagon_at(const double *a)
{
    const double root3 = 0x1.bb67ae8584caap+0;
    TilePlace one = hexagon(a[0], a[1]), other = hexagon(a[0] - root3 / 2.0, a[1] - 1.5);
    return one.towards < other.towards ? one : other;
}

// The distance from the nearest middle of six-sided tiles, as they have it.
static double hexagons(const Noise *noise, const double *a)
{
    (void)noise;
    return hexagon_at(a).towards;
}

static double hexagons_along(const Noise *noise, const double *a)
{
    (void)noise;
    return hexagon_at(a).along;
}

// F. K. Musgrave's ridged multifractal terrain, in "Texturing and Modeling: A Procedural Approach", with H, lacunarity,
// octaves, offset, gain and a noise generator.
static double ridged_multifractal(const Noise *noise, const double *a)
{
    NoiseGenerator generator = noise_generator((int)number_to_int(a[8]) & 3);
    double x = a[0], y = a[1], z = a[2], frequency = 1.0, sum = 0.0, weight = 1.0;
    int octaves = (int)(a[5] < 1.0 ? 1.0 : a[5] > 64.0 ? 64.0 : a[5]); // the last are below any use
    for (int i = 0; i < octaves; i++) {
        double signal = a[6] - fabs(2.0 * noise_value(noise, generator, vec3(x, y, z)) - 1.0);
        signal *= signal * weight;
        sum += i == 0 ? signal : signal * pow(frequency, -a[3]);
        weight = signal * a[7];
        weight = weight > 1.0 ? 1.0 : weight < 0.0 ? 0.0 : weight;
        x *= a[4];
        y *= a[4];
        z *= a[4];
        frequency *= a[4];
    }
    return sum;
}

// Enneper's, in which POV-Ray's whole numbers make fractions 0; where z is small another one stands below the line.
static double enneper(const Noise *noise, const double *a)
{
    double z = fabs(a[2]) < 0.2 ? 0.2 : a[2], difference = a[0] * a[0] - a[1] * a[1];
    double cube = difference / (2.0 * z) - 2.0 * a[2] * a[2] / 9.0, square = difference / (4.0 * z);
    (void)noise;
    return field(-a[3], cube * cube * cube + 6.0 * square * square);
}

// A torus that is moved, seen in a ball that turns inside out. The last term is POV-Ray's.
static double dupin_cyclide(const Noise *noise, const double *a)
{
    double square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2], ball2 = a[8] * a[8], major2 = a[4] * a[4];
    double x = a[0] * ball2 - a[6] * square, z = a[2] * ball2;
    double less = major2 - a[5] * a[5];
    double sum =
        ball2 * ball2 - 2.0 * ball2 * (a[0] * a[6] + a[1] * a[7]) + square * (a[6] * a[6] + a[7] * a[7] + less);
    (void)noise;
    return field(a[3], sum * sum - 4.0 * major2 * (x * x + z * z) + 8.0 * ball2 * a[7] * less * a[1] * square);
}

// What F. K. Musgrave calls heterogeneous terrain (as above), with H, lacunarity, octaves, offset, T and a noise
// generator: each octave weighs as much as the T-th power of the height below it.
static double hetero_multifractal(const Noise *noise, const double *a)
{
    NoiseGenerator generator = noise_generator((int)number_to_int(a[8]) & 3);
    double frequency = 1.0, sum = 0.0, octaves = fmin(a[5], 64.0), power = trunc(a[7]);
    for (double i = 0.0;; i += 1.0) {
        Vec3 p = {a[0] * frequency, a[1] * frequency, a[2] * frequency};
        double more = (2.0 * noise_value(noise, generator, p) - 1.0 + a[6]) * pow(frequency, -a[3]);
        if (i > 0.0 && i >= octaves) { // the part of an octave that is left
            double part = octaves - trunc(octaves);
            return part != 0.0 ? sum + part * more * sum : sum;
        }
        sum += i > 0.0 && power > 0.0 ? more * pow(sum, power) : more;
        frequency *= a[4];
    }
}

// The mean of octaves of what noise is from the ridge, with lambda, octaves, omega, offset, ridge and a noise
// generator.
static double ridge(const Noise *noise, const double *a)
{
    NoiseGenerator generator = noise_generator((int)number_to_int(a[8]) & 3);
    double frequency = 1.0, weight = 1.0, sum = 0.0, weights = 0.0, octaves = fmin(a[4], 64.0);
    double left = octaves - trunc(octaves), widest = fmax(a[7], 1.0 - a[7]), highest = fmax(a[6], 1.0 - a[6]);
    for (double i = 0.0, whole = fmax(trunc(octaves), 1.0); i < whole || (i == whole && left != 0.0); i += 1.0) {
        double value = noise_value(noise, generator, vec3(a[0] * frequency, a[1] * frequency, a[2] * frequency));
        double share = i < whole ? weight : weight * left;
        sum += share * (fabs(value - a[7]) / widest - a[6]) / highest;
        weights += share;
        weight *= a[5];
        frequency *= a[3];
    }
    return sum / weights;
}

enum { GIVEN_SURFACES = 79 };

typedef struct Row {
    Surface surface;
    unsigned arguments;
} Row;

static const Row rows[GIVEN_SURFACES] = {
    [0] = {given_algebraic1, 8},
    [1] = {given_algebraic2, 8},
    [2] = {given_algebraic3, 8},
    [3] = {given_algebraic4, 8},
    [4] = {bicorn, 5},
    [5] = {bifolia, 5},
    [6] = {given_blob, 8},
    [7] = {given_blob2, 7},
    [8] = {boy, 5},
    [10] = {given_cross_ellipsoids, 7},
    [11] = {crossed_trough, 4},
    [12] = {cubic_saddle, 4},
    [13] = {cushion, 4},
    [14] = {devils_curve, 4},
    [15] = {given_devils_curve, 9},
    [16] = {dupin_cyclide, 9},
    [17] = {ellipsoid, 6},
    [18] = {enneper, 4},
    [19] = {given_flange_cover, 7},
    [20] = {folium, 6},
    [21] = {given_folium, 9},
    [22] = {glob, 4},
    [23] = {heart, 4},
    [25] = {given_helix1, 10},
    [26] = {given_helix2, 10},
    [27] = {hexagons, 4},
    [28] = {hexagons_along, 4},
    [29] = {hetero_multifractal, 9},
    [30] = {hunt, 4},
    [31] = {hyperbolic_torus, 6},
    [32] = {given_isect_ellipsoids, 7},
    [33] = {kampyle, 6},
    [34] = {given_kampyle, 9},
    [35] = {klein_bottle, 4},
    [36] = {kummer_surface, 4},
    [37] = {kummer_surface2, 7},
    [38] = {lemniscate, 4},
    [39] = {given_lemniscate, 9},
    [40] = {given_mesh, 8},
    [41] = {mitre, 4},
    [42] = {nodal_cubic, 4},
    [43] = {odd, 4},
    [44] = {ovals_of_cassini, 7},
    [45] = {paraboloid, 4},
    [46] = {parabolic_torus, 6},
    [48] = {pillow, 4},
    [49] = {piriform, 4},
    [50] = {given_piriform, 10},
    [51] = {given_poly4, 8},
    [52] = {given_polytubes, 9},
    [53] = {given_quantum, 4},
    [54] = {quartic_paraboloid, 4},
    [55] = {quartic_saddle, 4},
    [56] = {quartic_cylinder, 6},
    [58] = {ridge, 9},
    [59] = {ridged_multifractal, 9},
    [60] = {rounded_box, 7},
    [62] = {given_spikes, 8},
    [63] = {spikes_2d, 7},
    [64] = {given_spiral, 9},
    [65] = {steiners_roman, 4},
    [66] = {strophoid, 7},
    [67] = {given_strophoid, 10},
    [68] = {superellipsoid, 5},
    [70] = {torus, 5},
    [71] = {torus2, 6},
    [72] = {torus_gumdrop, 4},
    [73] = {umbrella, 4},
    [74] = {witch_of_agnesi, 5},
    [75] = {given_witch_of_agnesi, 9},
};

unsigned given_surface_arguments(unsigned number)
{
    return number < GIVEN_SURFACES ? rows[number].arguments : 0;
}

bool given_surface_asks_noise(unsigned number)
{
    Surface of = number < GIVEN_SURFACES ? rows[number].surface : NULL;
    return of == ridged_multifractal || of == hetero_multifractal || of == ridge;
}

double given_surface(unsigned number, const Noise *noise, const double *a)
{
    return rows[number].surface(noise, a);
}
