// Tests of base/suggest.h: a table, and the banded distance against the plain one.
//
// SPDX-License-Identifier: MIT
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"
#include "base/suggest.h"
#include "unit/tap.h"

static void test_table(void)
{
    static const struct {
        const char *wanted, *names[6], *best;
        unsigned cost;
    } cases[] = {
        {"raduis", {"color", "radius", "translate"}, "radius", 3},
        {"colour", {"color", "rotate"}, "color", 4},
        {"RADIUS", {"radius"}, "radius", 2},
        {"Sphere", {"sphere_sweep", "sphere", "Spheres"}, "sphere", 2},
        {"shpere", {"sphere", "shape"}, "sphere", 3},
        {"pnae", {"plane", "pane"}, "pane", 3},
        {"abcd", {"abxy"}, NULL, 0},
        {"abcd", {"abcy"}, "abcy", 4},
        {"abcde", {"abxyz"}, NULL, 0},
        {"abcde", {"abcyz"}, "abcyz", 8},
        {"abcdefghi", {"abcdefxyz"}, "abcdefxyz", 11},
        {"abcdefghi", {"abcdewxyz"}, NULL, 0},
        {"light_sauce", {"light_source", "light_group"}, "light_source", 8},
        {"x", {"y", "z", "xy"}, NULL, 0},
        {"x", {"X"}, "X", 2},
        {"ab", {"cd", "a"}, "a", 4},
        {"ab", {"b", "a"}, "b", 4},
        {"radius", {"radius"}, NULL, 0},
        {"radius", {"radius", "Radius"}, "Radius", 2},
        {"", {"a"}, NULL, 0},
        {"a", {""}, NULL, 0},
        {"sphere", {"superellipsoid", "plane", "box"}, NULL, 0},
        {"Translte", {"translate"}, "translate", 6},
        {"rgbb", {"rgbf", "rgbt", "rgb"}, "rgb", 3},
        {"vcros", {"vcrop", "vcross"}, "vcross", 3},
        {"radiys", {"radials", "radius"}, "radius", 3},
        {"sjn", {"son", "sin"}, "sin", 3},
        {"sun", {"san", "sin"}, "sin", 3},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Suggest suggest;
        suggest_begin(&suggest, cases[i].wanted);
        for (size_t k = 0; k < RT_COUNT_OF(cases[i].names) && cases[i].names[k]; k++) {
            suggest_offer(&suggest, cases[i].names[k]);
        }
        const char *best = suggest.best ? suggest.best : "(none)", *expected = cases[i].best ? cases[i].best : "(none)";
        tap_ok(strcmp(best, expected) == 0 && (!cases[i].best || suggest.best_cost == cases[i].cost),
               "`%s` suggests %s (got %s, cost %u)", cases[i].wanted, expected, best, suggest.best_cost);
    }
}

static unsigned extra(const char *name, size_t i)
{
    return i > 0 && name[i] == name[i - 1] ? 3 : 4;
}

// The whole table: edits 4, swaps and doubled letters 3; no capitals and no neighbouring keys.
static unsigned plain_distance(const char *a, const char *b)
{
    unsigned cells[16][16];
    size_t rows = strlen(a), columns = strlen(b);
    for (size_t i = 0; i <= rows; i++) {
        for (size_t j = 0; j <= columns; j++) {
            unsigned best = i + j == 0 ? 0 : 1000;
            best = i == 0 && j > 0 ? cells[0][j - 1] + extra(b, j - 1) : best;
            best = j == 0 && i > 0 ? cells[i - 1][0] + extra(a, i - 1) : best;
            if (i > 0 && j > 0) {
                unsigned choices[] = {
                    cells[i - 1][j] + extra(a, i - 1), cells[i][j - 1] + extra(b, j - 1),
                    cells[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 4),
                    i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] ? cells[i - 2][j - 2] + 3 : 1000};
                for (size_t k = 0; k < RT_COUNT_OF(choices); k++) {
                    best = choices[k] < best ? choices[k] : best;
                }
            }
            cells[i][j] = best;
        }
    }
    return cells[rows][columns];
}

static void random_name(uint32_t *state, char *name)
{
    *state = *state * 1664525u + 1013904223u;
    size_t length = 2 + (*state >> 16) % 11;
    for (size_t i = 0; i < length; i++) {
        *state = *state * 1664525u + 1013904223u;
        name[i] = (char)('a' + (*state >> 16) % 3);
    }
    name[length] = '\0';
}

static void test_against_plain(void)
{
    uint32_t state = 1;
    int wrong = 0, near = 0;
    for (int i = 0; i < 200000; i++) {
        char wanted[16], candidate[16];
        random_name(&state, wanted);
        random_name(&state, candidate);
        size_t length = strlen(wanted), other = strlen(candidate);
        unsigned bound = length <= 4 ? 4 : length <= 8 ? 8 : 12;
        unsigned cost = plain_distance(wanted, candidate);
        bool is_near = cost > 0 && cost <= bound && length <= other + 3 && other <= length + 3;
        Suggest suggest;
        suggest_begin(&suggest, wanted);
        suggest_offer(&suggest, candidate);
        wrong += (suggest.best != NULL) != is_near || (is_near && suggest.best_cost != cost);
        near += is_near;
    }
    tap_ok(wrong == 0, "costs equal those of the whole table");
    tap_ok(near > 1000, "%d random pairs were near", near);
}

int main(void)
{
    test_table();
    test_against_plain();
    return tap_done();
}
