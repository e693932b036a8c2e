// Transforms: the language's rotations, exactness where it is promised, inverses, and which ones keep a sphere.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/attributes.h"
#include "math/float_power.h"
#include "math/transform.h"
#include "math/vec3.h"
#include "unit/random.h"
#include "unit/tap.h"

static const double U = DBL_EPSILON / 2;

static bool near(Vec3 a, Vec3 b, double tolerance)
{
    return vec3_max_abs(vec3_sub(a, b)) <= tolerance;
}

// The first three are what POV-Ray's vrotate gives; the next show that quarter turns are exact.
static void test_rotations(void)
{
    static const struct {
        Vec3 from, degrees, to;
        double tolerance;
    } cases[] = {
        {{1, 0, 0}, {0, 0, 30}, {0.86602540378443865, 0.5, 0}, 0x1p-53},
        {{0, 1, 0}, {30, 0, 0}, {0, 0.86602540378443865, 0.5}, 0x1p-53},
        {{1, 2, 3}, {10, 20, 30}, {1.0674253793989865, 2.2890594826206168, 2.7605814142023712}, 0x1p-50},
        {{1, 0, 0}, {0, 0, 90}, {0, 1, 0}, 0},
        {{0, 1, 0}, {90, 0, 0}, {0, 0, 1}, 0},
        {{0, 0, 1}, {0, 90, 0}, {1, 0, 0}, 0},
        {{1, 2, 3}, {180, 0, 0}, {1, -2, -3}, 0},
        {{1, 2, 3}, {0, -90, 0}, {-3, 2, 1}, 0},
        {{1, 2, 3}, {0, 0, 270}, {2, -1, 3}, 0},
        {{1, 2, 3}, {90, 90, 90}, {3, 2, -1}, 0},
        {{1, 2, 3}, {360, -720, 3.6e9}, {1, 2, 3}, 0},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Transform rotation = transform_rotate(cases[i].degrees);
        Vec3 image = transform_point(&rotation, cases[i].from);
        tap_ok(near(image, cases[i].to, cases[i].tolerance), "rotate <%g,%g,%g>: <%.17g,%.17g,%.17g>",
               cases[i].degrees.x, cases[i].degrees.y, cases[i].degrees.z, image.x, image.y, image.z);
    }
}

static void test_sines(void)
{
    double worst = 0.0;
    for (int i = -7200; i <= 7200; i++) {
        double degrees = i * 0.1;
        Transform rotation = transform_rotate(vec3(0, 0, degrees));
        long double radians = (long double)degrees * 3.14159265358979323846264338327950288L / 180.0L;
        worst = fmax(worst, (double)fabsl(rotation.m[0][1] - sinl(radians)));
        worst = fmax(worst, (double)fabsl(rotation.m[0][0] - cosl(radians)));
    }
    // 1 u for the series' last sum, 1 u for what reached it, and the argument's own 2 u times x cos x <= 0.56.
    tap_ok(worst <= 3 * U, "sines are right to %.2f u", worst / U);
}

static void test_composition(void)
{
    Transform scale = transform_scale(vec3(2, 3, 4));
    Transform move = transform_translate(vec3(10, 20, 30));
    Transform scale_first = transform_compose(scale, move);
    Transform move_first = transform_compose(move, scale);
    Vec3 one = vec3(1, 1, 1);
    tap_ok(vec3_equal(transform_point(&scale_first, one), vec3(12, 23, 34)), "scale, then translate");
    tap_ok(vec3_equal(transform_point(&move_first, one), vec3(22, 63, 124)), "translate, then scale");
    tap_ok(vec3_equal(transform_direction(&move_first, one), vec3(2, 3, 4)), "directions are not translated");
}

static Transform random_affine(Random *random, double unit)
{
    Transform t;
    for (int i = 0; i < 12; i++) {
        t.m[i / 3][i % 3] = random_between(random, -unit, unit);
    }
    return t;
}

static void test_inverses(void)
{
    static const double units[] = {1e-120, 1e-3, 1.0, 1e5, 1e120};
    for (size_t i = 0; i < RT_COUNT_OF(units); i++) {
        Random random = {i};
        double worst = 0.0;
        for (int turn = 0; turn < 1000; turn++) {
            Transform there = random_affine(&random, units[i]);
            Transform back;
            if (!transform_invert(&there, &back)) {
                worst = INFINITY;
                continue;
            }
            double condition = 0.0;
            for (int entry = 0; entry < 9; entry++) {
                condition = fmax(condition, fabs(back.m[entry / 3][entry % 3]) * units[i]);
            }
            Transform identity = transform_compose(there, back);
            for (int entry = 0; entry < 9; entry++) {
                double error = fabs(identity.m[entry / 3][entry % 3] - (entry % 4 == 0));
                worst = fmax(worst, error / condition);
            }
        }
        tap_ok(worst < 20 * U, "inverse at scale %g, error %.2f u times the condition", units[i], worst / U);
    }
}

static void test_singular(void)
{
    static const struct {
        const char *name;
        double rows[3][3];
        bool invertible;
    } cases[] = {
        {"zero scale", {{1, 0, 0}, {0, 0, 0}, {0, 0, 1}}, false},
        {"two equal rows", {{1, 2, 3}, {1, 2, 3}, {0, 0, 1}}, false},
        {"rows that depend to rounding", {{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}}, false},
        {"not finite", {{NAN, 0, 0}, {0, 1, 0}, {0, 0, 1}}, false},
        {"inverse not finite", {{1, 0, 0}, {0, 0x1p-1074, 0}, {0, 0, 1}}, false},
        {"a strong shear", {{1, 1e9, 0}, {0, 1, 0}, {0, 0, 1}}, true},
        {"scales far apart", {{1e-150, 0, 0}, {0, 1e150, 0}, {0, 0, 1}}, true},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Transform t = transform_identity();
        memcpy(t.m, cases[i].rows, sizeof(cases[i].rows));
        Transform inverse = transform_identity();
        tap_ok(transform_invert(&t, &inverse) == cases[i].invertible, "%s is %s", cases[i].name,
               cases[i].invertible ? "inverted" : "refused");
    }
}

static void test_power_of_two(void)
{
    Random random = {5};
    int different = 0;
    for (int turn = 0; turn < 1000; turn++) {
        Transform small = random_affine(&random, 1.0);
        Transform large = small;
        for (int i = 0; i < 12; i++) {
            large.m[i / 3][i % 3] = ldexp(small.m[i / 3][i % 3], 300);
        }
        Transform small_inverse;
        Transform large_inverse;
        if (transform_invert(&small, &small_inverse) && transform_invert(&large, &large_inverse)) {
            for (int i = 0; i < 9; i++) {
                different += ldexp(large_inverse.m[i / 3][i % 3], 300) != small_inverse.m[i / 3][i % 3];
            }
        }
    }
    tap_ok(different == 0, "a power of two passes through the inverse, bit for bit");
}

static void test_normals(void)
{
    Random random = {6};
    double worst = 0.0;
    for (int turn = 0; turn < 1000; turn++) {
        Transform there = random_affine(&random, 1.0);
        Transform back;
        if (!transform_invert(&there, &back)) {
            continue;
        }
        Vec3 normal = random_direction(&random);
        Vec3 tangent = random_perpendicular(&random, normal);
        Vec3 image = transform_normal(&back, normal);
        Vec3 image_tangent = transform_direction(&there, tangent);
        worst = fmax(worst, fabs(vec3_dot(image, image_tangent)) / vec3_length(image));
    }
    tap_ok(worst < 1e-13, "normals stay at right angles to their surfaces (%g)", worst);
}

static void test_similarities(void)
{
    static const struct {
        const char *name;
        Vec3 scale, degrees;
        bool similar;
    } cases[] = {
        {"uniform scale", {2.7, 2.7, 2.7}, {0, 0, 0}, true},
        {"reflection", {-2.7, 2.7, 2.7}, {0, 90, 0}, true},
        {"rotation", {1, 1, 1}, {12, 34, 56}, true},
        {"scale and rotation", {1e-100, 1e-100, 1e-100}, {12, 34, 56}, true},
        {"two scales", {1, 1, 1 + 1e-12}, {0, 0, 0}, false},
        {"two scales, rotated", {1, 1, 1 + 1e-12}, {12, 34, 56}, false},
        {"nothing", {0, 0, 0}, {0, 0, 0}, false},
        {"not finite", {NAN, 1, 1}, {0, 0, 0}, false},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Transform t = transform_compose(transform_scale(cases[i].scale), transform_rotate(cases[i].degrees));
        double factor = -1.0;
        bool similar = transform_is_similarity(&t, &factor);
        double expected = fabs(cases[i].scale.x);
        tap_ok(similar == cases[i].similar && (!similar || fabs(factor - expected) <= 4 * U * expected), "%s: %s",
               cases[i].name, similar ? "a sphere stays a sphere" : "an ellipsoid");
        if (similar && vec3_max_abs(cases[i].degrees) == 0.0) {
            tap_ok(factor == expected, "%s: the factor is exact", cases[i].name);
        }
    }
    Transform sheared = transform_identity();
    sheared.m[0][1] = 1e-12;
    double factor;
    tap_ok(!transform_is_similarity(&sheared, &factor), "a shear: an ellipsoid");
    int lost = 0;
    Random random = {9};
    for (int turn = 0; turn < 10000; turn++) {
        Transform chain = transform_identity();
        for (int step = 0; step < 3; step++) {
            double angle = random_between(&random, 0, 360);
            Vec3 degrees = vec3_scale(angle, random_direction(&random));
            chain = transform_compose(chain, transform_rotate(degrees));
        }
        lost += !transform_is_similarity(&chain, &factor);
    }
    tap_ok(lost == 0, "chains of three rotations about three axes keep spheres (%d lost)", lost);
}

// What tables and a series give is what pow gives, rounded, for the exponents of scenes and for odd ones; below 0, 0's.
static void test_float_powers(void)
{
    static const double exponents[] = {2.2, 1.0 / 2.2, 1.8, 1.0, 2.0, 0.5, 4.0, 0.0, -1.0, 7.5, 1.3};
    static const float special[] = {0.0F,          0x1p-149F, 0x1p-25F, 0x1.fffffep-25F, 0x1p-24F,
                                    0x1.fffffep5F, 0x1p6F,    FLT_MAX,  -1.0F,           1.0F};
    enum { COUNT = 300000, SPECIAL = RT_COUNT_OF(special) };
    static float values[COUNT], powers[COUNT];
    Random random = {11};
    for (size_t i = 0; i < RT_COUNT_OF(exponents); i++) {
        int different = 0;
        for (int k = 0; k < COUNT; k++) {
            values[k] = k < SPECIAL ? special[k] : (float)ldexp(random_between(&random, 0.5, 1), k % 36 - 27);
        }
        memcpy(powers, values, sizeof powers);
        float_power_all(exponents[i], powers, COUNT);
        for (int k = 0; k < COUNT; k++) {
            different += powers[k] != (float)pow(fmax((double)values[k], 0.0), exponents[i]);
        }
        tap_ok(different == 0, "powers of %g are those of pow (%d different)", exponents[i], different);
    }
}

int main(void)
{
    test_float_powers();
    test_rotations();
    test_sines();
    test_composition();
    test_inverses();
    test_singular();
    test_power_of_two();
    test_normals();
    test_similarities();
    return tap_done();
}
