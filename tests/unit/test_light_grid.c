// The grids of area lights: that each light is asked for at most once, and what comes out, which is compared with the
// definition written down as it stands: the mean of four quarters, or of four corners.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "render/shade/light_grid.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { GRID_MAX = 1024 };

// What each light sends, and whether it was asked for, by the grid and by the definition.
typedef struct Lights {
    LightArea area;
    Rgb arriving;
    Rgb *shares;
    unsigned char *asked, *wanted;
    int twice;
} Lights;

static Rgb send(Lights *lights, int i, int j)
{
    size_t at = (size_t)j * (size_t)lights->area.size1 + (size_t)i;
    lights->wanted[at] = 1;
    return lights->shares[at];
}

static bool is_apart(Rgb arriving, Rgb a, Rgb b)
{
    return fabs(arriving.red * (a.red - b.red)) + fabs(arriving.green * (a.green - b.green)) +
               fabs(arriving.blue * (a.blue - b.blue)) > 0.1;
}

// The mean of a part by its definition. Quarters of one row or column are not gone into twice: they are the same.
static Rgb defined(Lights *lights, int left, int right, int top, int bottom, int level)
{
    Rgb c[4] = {send(lights, left, top), send(lights, right, top), send(lights, left, bottom),
                send(lights, right, bottom)};
    bool is_whole = right - left <= 1 && bottom - top <= 1;
    if (!is_whole && lights->area.is_adaptive && level >= lights->area.adaptive) {
        is_whole = true;
        for (int a = 0; a < 4; a++) {
            for (int b = a + 1; b < 4; b++) {
                bool is_side = a + b != 3; // not across
                is_whole = is_whole && !(is_side && is_apart(lights->arriving, c[a], c[b]));
            }
        }
    }
    for (int k = 0; k < 4 && !is_whole; k++) {
        int l = k & 1 ? (left + right + 1) / 2 : left, r = k & 1 ? right : (left + right) / 2;
        int t = k & 2 ? (top + bottom + 1) / 2 : top, b = k & 2 ? bottom : (top + bottom) / 2;
        bool is_known = ((k & 1) && left == right) || ((k & 2) && top == bottom);
        c[k] = is_known ? c[(k & 1) && left == right ? k - 1 : k - 2] : defined(lights, l, r, t, b, level + 1);
    }
    return rgb_scale(0.25, rgb_add(rgb_add(c[0], c[1]), rgb_add(c[2], c[3])));
}

static Rgb asked(Lights *lights)
{
    static LightGrid grid;
    light_grid_begin(&grid, &lights->area);
    for (; grid.asked_count > 0; light_grid_next(&grid, lights->arriving)) {
        for (int k = 0; k < grid.asked_count; k++) {
            LightAsked *light = &grid.asked[k];
            size_t at = (size_t)light->j * (size_t)lights->area.size1 + (size_t)light->i;
            lights->twice += lights->asked[at];
            lights->asked[at] = 1;
            light->share = lights->shares[at];
        }
    }
    return grid.sum;
}

// Light by chance: black and white by a straight edge, or a disc, or anyhow; or any colours.
static void draw_shares(Lights *lights, Random *random)
{
    unsigned kind = random_below(random, 5);
    double x = random_between(random, 0, lights->area.size1), y = random_between(random, 0, lights->area.size2);
    double along = random_between(random, -1, 1), radius = random_between(random, 0, lights->area.size1);
    for (int j = 0; j < lights->area.size2; j++) {
        for (int i = 0; i < lights->area.size1; i++) {
            bool is_lit = kind == 0   ? along * (i - x) + (1 - fabs(along)) * (j - y) > 0
                          : kind == 1 ? hypot(i - x, j - y) > radius
                          : kind == 2 ? random_below(random, 2)
                                      : i % 7 != 0;
            Rgb share = rgb_grey(is_lit);
            if (kind == 4) {
                Vec3 drawn = random_vec3(random, 0, 1);
                share = rgb(drawn.x, drawn.y, is_lit);
            }
            lights->shares[j * lights->area.size1 + i] = share;
        }
    }
}

typedef struct Faults {
    int sums, twice, wanted;
} Faults;

static void try_grid(Lights *lights, Random *random, int size1, int size2, int adaptive, Faults *faults)
{
    size_t count = (size_t)size1 * (size_t)size2;
    lights->area = (LightArea){.size1 = size1, .size2 = size2, .adaptive = adaptive, .is_adaptive = adaptive >= 0};
    lights->arriving = random_below(random, 3) ? rgb_grey(1.0) : rgb(random_between(random, 0, 0.5), 0.04, 0.0);
    memset(lights->asked, 0, count);
    memset(lights->wanted, 0, count);
    lights->twice = 0;
    draw_shares(lights, random);
    Rgb sum = asked(lights), mean = defined(lights, 0, size1 - 1, 0, size2 - 1, 0);
    double apart = rgb_max_abs(rgb_add_scaled(sum, -1.0, mean));
    faults->sums += !(apart <= 1e-13);
    faults->twice += lights->twice > 0;
    faults->wanted += memcmp(lights->asked, lights->wanted, count) != 0;
}

static void report(const char *name, Faults faults)
{
    tap_ok(faults.sums == 0, "%s: sums are those of the definition (%d are not)", name, faults.sums);
    tap_ok(faults.twice == 0, "%s: no light is asked for twice (in %d one is)", name, faults.twice);
    tap_ok(faults.wanted == 0, "%s: those are asked for that the definition wants (in %d others)", name, faults.wanted);
}

int main(int argc, char **argv)
{
    Random random = {random_seed(argc > 1 ? argv[1] : NULL)};
    size_t count = (size_t)GRID_MAX * GRID_MAX;
    Lights lights = {.shares = malloc(count * sizeof *lights.shares), .asked = malloc(count), .wanted = malloc(count)};
    Faults small = {0}, large = {0};
    if (!lights.shares || !lights.asked || !lights.wanted) {
        return 1;
    }
    for (int size1 = 1; size1 <= 18; size1++) {
        for (int size2 = 1; size2 <= 18; size2++) {
            for (int i = 0; i < 30; i++) {
                try_grid(&lights, &random, size1, size2, i % 6 - 1, &small);
            }
        }
    }
    report("grids up to 18 by 18", small);
    static const int sizes[][2] = {{1024, 1024}, {1024, 1}, {1, 1024}, {1024, 2}, {1000, 777}, {3, 1023}, {100, 100}};
    for (size_t i = 0; i < RT_COUNT_OF(sizes); i++) {
        for (int adaptive = -1; adaptive < 7; adaptive += 2) {
            try_grid(&lights, &random, sizes[i][0], sizes[i][1], adaptive, &large);
        }
    }
    report("grids up to 1024 by 1024", large);
    free(lights.shares);
    free(lights.asked);
    free(lights.wanted);
    return tap_done();
}
