// Patterns at many points at once beside the same points one by one, to the last bit, on every instruction set.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "render/surface/pattern.h"
#include "trace/trace.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { MOST = 64 };

// Mostly where points stay for long; some far away, at 0, or nowhere.
static Vec3 any_point(Random *random)
{
    static const double odd[] = {0.0, -0.0, -2.0, 2.0, 1e200, -1e308, INFINITY, NAN};
    double x = random_between(random, -2.1, 0.8);
    double y = random_between(random, -1.3, 1.3);
    unsigned which = random_below(random, 64);
    return which < RT_COUNT_OF(odd) ? vec3(odd[which], y, 0.0) : vec3(x, y, 3.0);
}

static int differences(const Pattern *pattern, const NoiseSource *source, unsigned count, Random *random)
{
    Vec3 points[MOST] = {{0.0, 0.0, 0.0}};
    double values[MOST];
    int different = 0;
    for (unsigned i = 0; i < count; i++) {
        points[i] = any_point(random);
    }
    pattern_values_moved(pattern, source, count, points, values);
    for (unsigned i = 0; i < count; i++) {
        double own = pattern_value_moved(pattern, source, points[i]);
        different += memcmp(&own, &values[i], sizeof own) != 0;
    }
    return different;
}

static void test_escapes(PatternType type, const char *name)
{
    for (size_t isa = 0; geometry_isa(isa); isa++) {
        Random random = {random_seed(NULL)};
        NoiseSource source = {.escape = escape_kernel_choose(geometry_isa(isa))};
        int different = strcmp(source.escape->name, geometry_isa(isa)) != 0;
        for (int turn = 0; turn < 500; turn++) {
            Pattern pattern = {.type = (uint8_t)type,
                               .frequency = turn % 3,
                               .count = (turn % 7) * (turn % 7) * 5 + 1,
                               .power = 2,
                               .exterior = 1,
                               .interior_factor = 1.0};
            pattern.vector.x = random_between(&random, -1.2, 0.4);
            pattern.vector.y = random_between(&random, -0.8, 0.8);
            different += differences(&pattern, &source, 1 + random_below(&random, MOST), &random);
        }
        tap_ok(different == 0, "%s abreast by %s is what it is point by point (%d differ)", name, geometry_isa(isa),
               different);
    }
}

static void test_noise(PatternType type, const char *name)
{
    static Noise noise;
    for (size_t isa = 0; geometry_isa(isa); isa++) {
        Random random = {random_seed(NULL)};
        noise_init(&noise, geometry_isa(isa));
        NoiseSource source = {.noise = &noise, .generator = NOISE_CORRECTED};
        int different = 0;
        for (int turn = 0; turn < 500; turn++) {
            Pattern pattern = {.type = (uint8_t)type, .frequency = turn % 3, .generator = turn % 4};
            different += differences(&pattern, &source, 1 + random_below(&random, MOST), &random);
        }
        tap_ok(different == 0, "%s abreast by %s is what it is point by point (%d differ)", name, geometry_isa(isa),
               different);
    }
}

int main(void)
{
    tap_ok(
        pattern_goes_abreast(&(Pattern){.type = PATTERN_MANDEL, .power = 2, .exterior = 1, .interior_factor = 1.0}) &&
            pattern_goes_abreast(
                &(Pattern){.type = PATTERN_JULIA, .power = 2, .exterior = 1, .interior_factor = 1.0}) &&
            pattern_goes_abreast(&(Pattern){.type = PATTERN_BUMPS}) &&
            !pattern_goes_abreast(&(Pattern){.type = PATTERN_GRADIENT}),
        "patterns of many steps and of noise go abreast");
    test_escapes(PATTERN_MANDEL, "mandel");
    test_escapes(PATTERN_JULIA, "julia");
    test_noise(PATTERN_BOZO, "bozo");
    test_noise(PATTERN_BUMPS, "bumps");
    return tap_done();
}
