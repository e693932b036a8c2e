// Affine transforms: makes, composes, inverts and applies them, and tells which ones keep a sphere a sphere.
//
// Rotations by multiples of 90 degrees have exact entries, and sines are computed here rather than by libm, whose
// last bit differs between machines. Powers of two pass through every function without changing any other bit, so
// that a scene scaled by 2^k has its transforms scaled exactly. Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#include "math/transform.h"

#include <float.h>
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"

// u, the relative error of one rounded operation.
#define UNIT_ROUNDOFF (DBL_EPSILON / 2)

typedef struct SineCosine {
    double sine, cosine;
} SineCosine;

// The Taylor series. For |x| <= pi/4 the first term left out is below 2^-62 of the sum.
static double sine_series(double x)
{
    static const double inverse_factorials[] = {1.0 / 355687428096000.0, -1.0 / 1307674368000.0, 1.0 / 6227020800.0,
                                                -1.0 / 39916800.0,       1.0 / 362880.0,         -1.0 / 5040.0,
                                                1.0 / 120.0,             -1.0 / 6.0};
    double sum = 0.0;
    for (unsigned i = 0; i < RT_COUNT_OF(inverse_factorials); i++) {
        sum = (sum + inverse_factorials[i]) * (x * x);
    }
    return x + x * sum;
}

static double cosine_series(double x)
{
    static const double inverse_factorials[] = {-1.0 / 6402373705728000.0, 1.0 / 20922789888000.0, -1.0 / 87178291200.0,
                                                1.0 / 479001600.0,         -1.0 / 3628800.0,       1.0 / 40320.0,
                                                -1.0 / 720.0,              1.0 / 24.0,             -1.0 / 2.0};
    double sum = 0.0;
    for (unsigned i = 0; i < RT_COUNT_OF(inverse_factorials); i++) {
        sum = (sum + inverse_factorials[i]) * (x * x);
    }
    return 1.0 + sum;
}

// The reduction to -45..45 degrees is exact: fmod and remainder are, and so is the quadrant.
static SineCosine sine_cosine_deg(double degrees)
{
    const double radians_per_degree = 0x1.1df46a2529d39p-6; // pi / 180
    double turn = fmod(degrees, 360.0);
    double rest = remainder(turn, 90.0);
    int quadrant = (int)((turn - rest) / 90.0) & 3;
    double sine = sine_series(rest * radians_per_degree);
    double cosine = cosine_series(rest * radians_per_degree);
    switch (quadrant) {
    case 0: return (SineCosine){sine, cosine};
    case 1: return (SineCosine){cosine, -sine};
    case 2: return (SineCosine){-sine, -cosine};
    default: return (SineCosine){-cosine, sine};
    }
}

Transform transform_identity(void)
{
    return (Transform){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
}

Transform transform_translate(Vec3 by)
{
    return (Transform){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {by.x, by.y, by.z}}};
}

Transform transform_scale(Vec3 by)
{
    return (Transform){{{by.x, 0, 0}, {0, by.y, 0}, {0, 0, by.z}, {0, 0, 0}}};
}

Transform transform_rotate(Vec3 degrees)
{
    if (!vec3_is_finite(degrees)) {
        return (Transform){{{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}, {0, 0, 0}}};
    }
    SineCosine x = sine_cosine_deg(degrees.x);
    SineCosine y = sine_cosine_deg(degrees.y);
    SineCosine z = sine_cosine_deg(degrees.z);
    Transform about_x = {{{1, 0, 0}, {0, x.cosine, x.sine}, {0, -x.sine, x.cosine}, {0, 0, 0}}};
    Transform about_y = {{{y.cosine, 0, -y.sine}, {0, 1, 0}, {y.sine, 0, y.cosine}, {0, 0, 0}}};
    Transform about_z = {{{z.cosine, z.sine, 0}, {-z.sine, z.cosine, 0}, {0, 0, 1}, {0, 0, 0}}};
    return transform_compose(transform_compose(about_x, about_y), about_z);
}

// Most objects are not moved.
bool transform_is_identity(const Transform *transform)
{
    static const Transform identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
    return memcmp(transform, &identity, sizeof identity) == 0;
}

Transform transform_compose(Transform first, Transform second)
{
    Transform both;
    if (transform_is_identity(&second) && transform_is_identity(&first)) {
        return first;
    }
    for (int row = 0; row < 4; row++) {
        Vec3 image = vec3(first.m[row][0], first.m[row][1], first.m[row][2]);
        image = row < 3 ? transform_direction(&second, image) : transform_point(&second, image);
        both.m[row][0] = image.x;
        both.m[row][1] = image.y;
        both.m[row][2] = image.z;
    }
    return both;
}

static Vec3 transform_row(const Transform *transform, int row)
{
    return vec3(transform->m[row][0], transform->m[row][1], transform->m[row][2]);
}

// The exponent that brings the greatest entry to 1/2..1; 0 for a row of zeros.
static int row_exponent(Vec3 row)
{
    int exponent;
    frexp(vec3_max_abs(row), &exponent);
    return exponent;
}

// The exponent of a positive number as frexp has it.
static int exponent_of(double x)
{
    int exponent;
    frexp(x, &exponent);
    return exponent;
}

// Whether the linear part only scales, by positive numbers, and its zeros are positive.
static bool is_plain_scale(const Transform *transform)
{
    static const double zeros[3];
    const double(*m)[3] = transform->m;
    return m[0][0] > 0.0 && m[1][1] > 0.0 && m[2][2] > 0.0 && memcmp(&m[0][1], zeros, sizeof zeros) == 0 &&
           memcmp(&m[1][2], zeros, sizeof zeros) == 0;
}

// What the cofactors below come to for those, without the products by 0: the same to the last bit.
static void invert_plain_scale(const Transform *transform, Transform *inverse)
{
    double entries[3], scaled[3];
    int exponents[3];
    for (int i = 0; i < 3; i++) {
        exponents[i] = exponent_of(transform->m[i][i]);
        scaled[i] = vec3_ldexp(vec3(transform->m[i][i], 0.0, 0.0), -exponents[i]).x;
    }
    double determinant = scaled[0] * (scaled[1] * scaled[2]);
    for (int i = 0; i < 3; i++) {
        double cofactor = scaled[(i + 1) % 3] * scaled[(i + 2) % 3];
        entries[i] = vec3_ldexp(vec3(cofactor / determinant, 0.0, 0.0), -exponents[i]).x;
    }
    *inverse = transform_scale(vec3(entries[0], entries[1], entries[2]));
}

// By cofactors, of rows scaled to about 1 so that the determinant neither over- nor underflows. A determinant below
// its own rounding error is a singular matrix: a triple product is off by at most (2 + 1 + 3) u times the same sum
// with all terms positive (Higham, Accuracy and Stability of Numerical Algorithms, 3.1).
static bool invert_linear(const Transform *transform, Transform *inverse)
{
    Vec3 rows[3];
    int exponents[3];
    for (int i = 0; i < 3; i++) {
        rows[i] = transform_row(transform, i);
        if (!vec3_is_finite(rows[i])) {
            return false;
        }
        exponents[i] = row_exponent(rows[i]);
        rows[i] = vec3_ldexp(rows[i], -exponents[i]);
    }
    Vec3 columns[3] = {vec3_cross(rows[1], rows[2]), vec3_cross(rows[2], rows[0]), vec3_cross(rows[0], rows[1])};
    double determinant = vec3_dot(rows[0], columns[0]);
    Vec3 p = rows[1];
    Vec3 q = rows[2];
    Vec3 magnitude = vec3(fabs(p.y * q.z) + fabs(p.z * q.y), fabs(p.z * q.x) + fabs(p.x * q.z),
                          fabs(p.x * q.y) + fabs(p.y * q.x));
    Vec3 first = vec3(fabs(rows[0].x), fabs(rows[0].y), fabs(rows[0].z));
    double uncertainty = 6.0 * UNIT_ROUNDOFF * vec3_dot(first, magnitude);
    if (!(fabs(determinant) > uncertainty)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        Vec3 column = vec3(columns[i].x / determinant, columns[i].y / determinant, columns[i].z / determinant);
        column = vec3_ldexp(column, -exponents[i]);
        inverse->m[0][i] = column.x;
        inverse->m[1][i] = column.y;
        inverse->m[2][i] = column.z;
        inverse->m[3][i] = 0.0;
    }
    return true;
}

bool transform_invert(const Transform *transform, Transform *inverse)
{
    Transform result;
    if (is_plain_scale(transform) && transform_is_finite(transform)) {
        invert_plain_scale(transform, &result);
    } else if (!invert_linear(transform, &result)) {
        return false;
    }
    Vec3 origin = vec3_neg(transform_direction(&result, transform_row(transform, 3)));
    result.m[3][0] = origin.x;
    result.m[3][1] = origin.y;
    result.m[3][2] = origin.z;
    if (!transform_is_finite(&result)) {
        return false;
    }
    *inverse = result;
    return true;
}

bool transform_is_finite(const Transform *transform)
{
    double nothing = 0.0; // as long as all is finite
    for (int row = 0; row < 4; row++) {
        const double *m = transform->m[row];
        nothing += (m[0] - m[0]) + (m[1] - m[1]) + (m[2] - m[2]);
    }
    return nothing == 0.0;
}

// Of numbers; fmax is a call.
static double greater(double a, double b)
{
    return a > b ? a : b;
}

static double middle_of_three(double a, double b, double c)
{
    return fmax(fmin(a, b), fmin(fmax(a, b), c));
}

// Each entry of a rotation is off by at most 2 u, and a composition adds 3 u of |row| |column| (Higham, 3.1): 5 u a
// step for an entry, hence 2 sqrt(3) 5 u < 18 u of s² for the product of two rows. Eight steps are allowed for; a shape
// beyond that is still drawn, as an ellipsoid.
bool transform_is_similarity(const Transform *transform, double *factor)
{
    const double tolerance = 8 * 18 * UNIT_ROUNDOFF;
    double greatest = 0.0, least = INFINITY;
    if (!transform_is_finite(transform)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        const double *m = transform->m[i];
        double size = greater(fabs(m[0]), greater(fabs(m[1]), fabs(m[2])));
        greatest = greater(greatest, size);
        least = size < least ? size : least;
    }
    // The greatest entries of rows of one length differ by no more than sqrt(3).
    if (greatest >= 1.75 * least) {
        return false;
    }
    int exponent;
    frexp(greatest, &exponent);
    Vec3 rows[3];
    for (int i = 0; i < 3; i++) {
        rows[i] = vec3_ldexp(transform_row(transform, i), -exponent);
    }
    double lengths[3] = {vec3_length(rows[0]), vec3_length(rows[1]), vec3_length(rows[2])};
    double length = middle_of_three(lengths[0], lengths[1], lengths[2]);
    double square = length * length;
    for (int i = 0; i < 3; i++) {
        double product = vec3_dot(rows[i], rows[(i + 1) % 3]);
        if (!(fabs(lengths[i] * lengths[i] - square) <= tolerance * square && fabs(product) <= tolerance * square)) {
            return false;
        }
    }
    *factor = ldexp(length, exponent);
    return true;
}
