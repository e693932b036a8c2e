// Crackle beside a search of all cubes that may hold one of the three nearest sites, to the last bit.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "render/surface/pattern_noise.h"
#include "unit/random.h"
#include "unit/tap.h"

static void swap(double *a, double *b)
{
    double was = *a;
    *a = *b;
    *b = was;
}

// The distances of the nearest three sites, of 7 x 7 x 7 cubes.
static void search(const Noise *noise, Vec3 p, double offset, double ways[3])
{
    ways[0] = ways[1] = ways[2] = HUGE_VAL;
    for (int i = 0; i < 343; i++) {
        Vec3 corner = vec3(floor(p.x) + i / 49 - 3, floor(p.y) + i / 7 % 7 - 3, floor(p.z) + i % 7 - 3);
        Vec3 apart = vec3_sub(p, noise_site(noise, corner));
        double way = sqrt(apart.x * apart.x + apart.y * apart.y + apart.z * apart.z + offset * offset);
        for (int k = 0; k < 3; k++) {
            if (way < ways[k]) {
                swap(&way, &ways[k]);
            }
        }
    }
}

static void test_search(const Noise *noise, double offset, double size)
{
    Random random = {random_seed(NULL)};
    NoiseSource source = {.noise = noise, .generator = NOISE_CORRECTED};
    int wrong = 0;
    for (int i = 0; i < 20000; i++) {
        double x = random_between(&random, -size, size), y = random_between(&random, -size, size);
        Vec3 p = vec3(x, y, random_between(&random, -size, size));
        double ways[3];
        search(noise, p, offset, ways);
        for (int k = 0; k < 3; k++) {
            Vec3 form = vec3(0.125 * (k == 0), 0.125 * (k == 1), 0.125 * (k == 2));
            Pattern pattern = {.metric = 2.0, .offset = offset, .form = form};
            wrong += pattern_crackle(&pattern, &source, p) != 0.125 * ways[k];
        }
    }
    tap_ok(wrong == 0, "offset %g, %g across: %d of 60000 distances are others", offset, size, wrong);
}

int main(void)
{
    Noise *noise = malloc(sizeof *noise);
    if (tap_ok(noise != NULL, "memory for the tables")) {
        noise_init(noise, NULL);
        test_search(noise, 0.0, 10.0);
        test_search(noise, 0.75, 10.0);
        test_search(noise, -2.0, 1e5);
        test_search(noise, 0.0, 1e10);
    }
    free(noise);
    return tap_done();
}
