// Noise: what POV-Ray's f_noise_generator and vturbulence give at the same points, and what must hold everywhere.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"
#include "math/noise.h"
#include "trace/trace.h"
#include "unit/random.h"
#include "unit/tap.h"

static bool near(Vec3 a, Vec3 b)
{
    return vec3_max_abs(vec3_sub(a, b)) <= 1e-14;
}

// A point, its three noises, its vector, and a sum of four vectors with lambda 3 and omega 3/4, as POV-Ray prints them.
static const struct {
    Vec3 p, values, vector, sum;
} cases[] = {
    {{0, 0, 0},
     {0.056580499999999978, 0.29832243930790991, 0.51135430537303594},
     {-0.44341950000000002, 0.36100549999999998, -0.45971600000000001},
     {-1.2124751953124999, 0.98712441406249996, -1.2570359375000002}},
    {{0.5, 0.5, 0.5},
     {0.41346047124999996, 0.47314217026615513, 0.67210384355265762},
     {-0.086539528750000039, -0.19951749374999994, 0.073615243750000031},
     {0.086309199453124957, -0.18042866601562491, 0.02221229394531252}},
    {{-0.25, 3.75, -7.125},
     {0.21727328747653962, 0.377038736485316, 0.35095539740799897},
     {-0.28272671252346043, 0.13264149579000473, 0.072679884476089487},
     {-0.14492242209667058, 0.16796157906189113, -0.24222966881506369}},
    {{100.3, -20.7, 4095.5},
     {0.54080478892960127, 0.53552252542543666, 0.53081233235111724},
     {0.040804788929601252, -0.35760155397760046, 0.20092713349887925},
     {0.088640421213385473, -0.033112682267620111, 0.47872186585983145}},
    {{-12345.678, 0.001, 9999.999},
     {0.44659686934309417, 0.48937422772589423, 0.59199257688469775},
     {-0.053403130656905842, 0.11185008419585171, 0.071049871916036789},
     {-0.39198372337780091, -0.10484657620933244, -0.15177148139974445}},
    {{3, -4, 5},
     {0.88657950000000008, 0.70490228005208999, 0.49879441608529024},
     {0.38657950000000002, -0.1349735, -0.15871650000000001},
     {0.52008182031250005, 0.19990410156249999, -0.53492810156249992}},
    {{-4.762, 5.977, 42.421},
     {0.50075689851131922, 0.5159048332253191, 0.27553370889491613},
     {0.00075689851131927001, 0.080777159189317771, -0.34202355656846023},
     {-0.097340136500068619, -0.16245627947189867, -0.23493042094317942}},
    {{-3.435, 0.784, 8.738},
     {0.3210131684141001, 0.42785632092868708, 0.16102093688261032},
     {-0.17898683158589984, -0.24236374344964756, 0.046269081910089389},
     {0.36442549399562313, -0.38724014356305658, -0.098890753738400783}},
    {{-31.534, 1.191, 12.988},
     {0.20623902462976962, 0.37163353861041593, 0.46090158430129136},
     {-0.29376097537023044, 0.086944004830284166, 0.4691171123839567},
     {-0.1373420853615864, 0.42419171685542395, 0.41517976491782227}},
    {{29.298, -40.588, -19.66},
     {0.21558945648129146, 0.3762139020723973, 0.56736931210923514},
     {-0.28441054351870854, -0.27431961518817677, 0.20203871391571876},
     {-0.56510810748165552, 0.032364872880817241, 0.062552308652425392}},
    {{-40.933, 30.964, 19.344},
     {0.60198678909654979, 0.56549288428645739, 0.68028535272647006},
     {0.10198678909654985, -0.38476218082088309, 0.40907084562207424},
     {0.14341811469430349, -0.48101759941072386, 0.44873687366203674}},
    {{-45.812, 48.219, 46.476},
     {0.11341517522945843, 0.32616323574687001, 0.3730283102284046},
     {-0.38658482477054157, -0.097110249921219097, -0.50856335281423148},
     {-0.52611400013046195, -0.12156925846882875, -0.61082873396193116}},
};

static void test_values(const Noise *noise)
{
    static const Octaves octaves = {3.0, 0.75, 4};
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Vec3 p = cases[i].p;
        Vec3 values = vec3(noise_value(noise, NOISE_ORIGINAL, p), noise_value(noise, NOISE_CORRECTED, p),
                           noise_value(noise, NOISE_PERLIN, p));
        tap_ok(near(values, cases[i].values), "numbers of the three generators at point %zu", i);
        tap_ok(near(noise_vector(noise, p), cases[i].vector), "the vector at point %zu", i);
        tap_ok(near(noise_vector_sum(noise, &octaves, p), cases[i].sum), "four octaves of it at point %zu", i);
    }
}

// Whole periods change nothing but the last bits of the fractions; tiny steps change little; far points are fine.
static void test_everywhere(const Noise *noise)
{
    Random random = {4};
    int outside = 0, odd_period = 0, jumps = 0;
    for (int turn = 0; turn < 20000; turn++) {
        double away = random_between(&random, 0, 3000);
        Vec3 p = vec3_scale(away, random_direction(&random));
        for (int generator = NOISE_ORIGINAL; generator <= NOISE_PERLIN; generator++) {
            NoiseGenerator which = (NoiseGenerator)generator;
            double value = noise_value(noise, which, p);
            double next = noise_value(noise, which, vec3_add(p, vec3(4096.0, -8192.0, 4096.0)));
            double beside = noise_value(noise, which, vec3_add(p, vec3(1e-6, 1e-6, -1e-6)));
            outside += !(value >= 0.0 && value <= 1.0);
            odd_period += fabs(next - value) > 1e-7;
            jumps += fabs(beside - value) > 1e-5;
        }
    }
    tap_ok(outside == 0, "noise is from 0 to 1 (%d are not)", outside);
    tap_ok(odd_period == 0, "noise has period 4096 (%d differ)", odd_period);
    tap_ok(jumps == 0, "noise is smooth (%d jumps)", jumps);
    static const double far[] = {1e9, -1e15, 1e300, -1e308};
    int wild = 0;
    for (size_t i = 0; i < RT_COUNT_OF(far); i++) {
        for (int generator = NOISE_ORIGINAL; generator <= NOISE_PERLIN; generator++) {
            double value = noise_value(noise, (NoiseGenerator)generator, vec3(far[i], 0.5, -far[i]));
            wild += !(value >= 0.0 && value <= 1.0);
        }
    }
    tap_ok(wild == 0, "noise far away is from 0 to 1, too (%d are not)", wild);
}

// What one set of kernels gives at a point, all of it: numbers, a vector, and sums of four octaves.
enum { NUMBERS = 9 };

static void everything(const Noise *noise, NoiseGenerator which, Vec3 p, double numbers[NUMBERS])
{
    const Octaves octaves = {2.1, 0.6, 4};
    Vec3 vector = noise_vector(noise, p), sum = noise_vector_sum(noise, &octaves, p);
    const double all[NUMBERS] = {noise_value(noise, which, p), noise_spread(noise, which, p),
                                 noise_sum(noise, which, &octaves, p), vector.x, vector.y, vector.z,
                                 sum.x, sum.y, sum.z};
    memcpy(numbers, all, sizeof all);
}

// Some whole, some beyond what a number of 32 bits holds, of any sign.
static Vec3 any_point(Random *random)
{
    double away = exp2(random_between(random, -4, 40));
    Vec3 p = vec3_scale(away, random_direction(random));
    return random_below(random, 8) == 0 ? vec3(floor(p.x), -floor(p.y), p.z) : p;
}

static void test_instruction_sets(Noise *noise, Noise *plain)
{
    Random random = {random_seed(NULL)};
    noise_init(plain, "plain");
    for (size_t i = 0; geometry_isa(i); i++) {
        noise_init(noise, geometry_isa(i));
        int different = 0;
        for (int turn = 0; turn < 20000; turn++) {
            double own[NUMBERS], others[NUMBERS];
            Vec3 p = any_point(&random);
            NoiseGenerator which = (NoiseGenerator)(NOISE_ORIGINAL + turn % 3);
            everything(noise, which, p, own);
            everything(plain, which, p, others);
            different += memcmp(own, others, sizeof own) != 0;
        }
        tap_ok(different == 0, "noise by %s has the bits of plain (%d differ)", geometry_isa(i), different);
    }
}

static bool same(Vec3 a, Vec3 b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

// Octave by octave, by the functions of a single point.
static bool sums_are_of_single_points(const Noise *noise, NoiseGenerator which, const Octaves *octaves, Vec3 p)
{
    double sum = noise_spread(noise, which, p), scale = octaves->lambda, weight = octaves->omega;
    Vec3 vectors = noise_vector(noise, p);
    for (unsigned i = 1; i < octaves->count; i++) {
        double value = noise_value(noise, which, vec3_scale(scale, p));
        sum += weight * (which == NOISE_ORIGINAL ? value : 2.0 * value - 0.5);
        vectors = vec3_add_scaled(vectors, weight, noise_vector(noise, vec3_scale(scale, p)));
        scale *= octaves->lambda;
        weight *= octaves->omega;
    }
    return noise_sum(noise, which, octaves, p) == sum && same(noise_vector_sum(noise, octaves, p), vectors);
}

// Rows of points and of octaves have the bits of single points, on all instruction sets.
static void test_rows(Noise *noise)
{
    enum { MOST = 11 };
    Random random = {random_seed(NULL)};
    for (size_t i = 0; geometry_isa(i); i++) {
        noise_init(noise, geometry_isa(i));
        int odd_points = 0, odd_sums = 0;
        for (int turn = 0; turn < 5000; turn++) {
            Vec3 points[MOST], vectors[MOST];
            double spreads[MOST];
            unsigned count = 1 + (unsigned)turn % MOST;
            NoiseGenerator which = (NoiseGenerator)(NOISE_ORIGINAL + turn % 3);
            for (unsigned n = 0; n < count; n++) {
                points[n] = any_point(&random);
            }
            noise_spreads(noise, which, count, points, spreads);
            noise_vectors(noise, count, points, vectors);
            for (unsigned n = 0; n < count; n++) {
                odd_points += spreads[n] != noise_spread(noise, which, points[n]) ||
                              !same(vectors[n], noise_vector(noise, points[n]));
            }
            Octaves octaves = {.lambda = random_between(&random, 1.0, 3.0), .count = count};
            octaves.omega = random_between(&random, 0.1, 1.0);
            odd_sums += !sums_are_of_single_points(noise, which, &octaves, points[0]);
        }
        tap_ok(odd_points == 0, "rows of points by %s have the bits of single ones (%d differ)", geometry_isa(i),
               odd_points);
        tap_ok(odd_sums == 0, "sums by %s have the bits of single octaves (%d differ)", geometry_isa(i), odd_sums);
    }
}

// Fractions that a double holds exactly even beyond 2^30, where floors take another way: a period changes no bit.
static void test_far_periods(const Noise *noise)
{
    Random random = {random_seed(NULL)};
    int different = 0;
    for (int turn = 0; turn < 2000; turn++) {
        double coordinates[3];
        for (int axis = 0; axis < 3; axis++) {
            coordinates[axis] = 0x1p-10 * random_below(&random, 1u << 22);
        }
        Vec3 p = vec3(coordinates[0], coordinates[1], coordinates[2]);
        double near_by[NUMBERS], far[NUMBERS];
        for (int away = 0; away < 2; away++) {
            double periods = (away ? 0x1p20 : 0x1p10) + random_below(&random, 1000);
            double sign = random_below(&random, 2) ? 1.0 : -1.0;
            everything(noise, NOISE_ORIGINAL, p, near_by);
            everything(noise, NOISE_ORIGINAL, vec3_add(p, vec3(4096.0 * periods * sign, 0.0, -4096.0 * periods)), far);
            different += near_by[0] != far[0] || near_by[3] != far[3] || near_by[4] != far[4] || near_by[5] != far[5];
        }
    }
    tap_ok(different == 0, "whole periods change no bit of exact fractions (%d differ)", different);
}

int main(void)
{
    Noise *noise = malloc(sizeof *noise), *plain = malloc(sizeof *plain);
    if (tap_ok(noise && plain, "memory for the tables")) {
        noise_init(noise, NULL);
        test_values(noise);
        test_everywhere(noise);
        test_far_periods(noise);
        test_instruction_sets(noise, plain);
        test_rows(noise);
    }
    free(noise);
    free(plain);
    return tap_done();
}
