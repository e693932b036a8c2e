// Did-you-mean: a bounded edit distance in a narrow band, so that a name of another length costs next to nothing.
//
// SPDX-License-Identifier: MIT
#include "base/suggest.h"

#include <stdbool.h>
#include <string.h>

// Costs in quarters of an edit.
enum {
    EDIT = 4,
    SWAP = 3, // of two neighbours
    CASE = 2, // the whole name, however many letters
    BAND = 3, // the most edits that are ever accepted, and so the farthest from the diagonal
    ROW = 2 * BAND + 1,
    FAR = 1000
};

static char fold(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static bool same(char a, char b, bool is_folded)
{
    return a == b || (is_folded && fold(a) == fold(b));
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

// The restricted Damerau-Levenshtein distance (F. Damerau, CACM 7(3), 1964; V. Levenshtein, 1966) of two texts, or more
// than `bound` if it is more. Row i holds the cells |i - j| <= BAND at column j - i + BAND.
static unsigned edit_distance(const char *a, size_t a_length, const char *b, size_t b_length, bool is_folded,
                              unsigned bound)
{
    unsigned rows[3][ROW];
    unsigned row_least_before = 0;
    for (size_t i = 0; i <= a_length; i++) {
        unsigned *row = rows[i % 3];
        const unsigned *up = rows[(i + 2) % 3], *upper = rows[(i + 1) % 3];
        unsigned row_least = FAR;
        for (size_t k = 0; k < ROW; k++) {
            unsigned cost = FAR;
            size_t j = i + k - BAND;
            if (i + k < BAND || j > b_length) {
                row[k] = FAR;
                continue;
            }
            if (i == 0) {
                cost = (unsigned)j * EDIT;
            } else {
                cost = k + 1 < ROW ? least(cost, up[k + 1] + EDIT) : cost;
                cost = k > 0 ? least(cost, row[k - 1] + EDIT) : cost;
                cost = j > 0 ? least(cost, up[k] + (same(a[i - 1], b[j - 1], is_folded) ? 0 : EDIT)) : cost;
                if (i > 1 && j > 1 && same(a[i - 1], b[j - 2], is_folded) && same(a[i - 2], b[j - 1], is_folded)) {
                    cost = least(cost, upper[k] + SWAP);
                }
            }
            row[k] = cost;
            row_least = least(row_least, cost);
        }
        if (row_least > bound && row_least_before + SWAP > bound) {
            return bound + 1;
        }
        row_least_before = row_least;
    }
    return rows[a_length % 3][b_length + BAND - a_length];
}

// How far a name may be: a short one has too many neighbours. One letter may only differ in case.
static unsigned cost_bound(size_t length)
{
    return length <= 1 ? CASE : length <= 4 ? EDIT : length <= 8 ? 2 * EDIT : BAND * EDIT;
}

void suggest_begin(Suggest *suggest, const char *wanted)
{
    *suggest = (Suggest){.wanted = wanted, .wanted_length = strlen(wanted)};
    suggest->best_cost = cost_bound(suggest->wanted_length) + 1;
}

void suggest_offer(Suggest *suggest, const char *candidate)
{
    size_t wanted_length = suggest->wanted_length;
    unsigned bound = suggest->best_cost - 1;
    size_t reach = bound / EDIT;
    size_t length = strnlen(candidate, wanted_length + reach + 1);
    if (length > wanted_length + reach || length + reach < wanted_length || length == 0) {
        return;
    }
    unsigned folded = edit_distance(suggest->wanted, wanted_length, candidate, length, true, bound);
    if (folded > bound) {
        return;
    }
    unsigned exact = edit_distance(suggest->wanted, wanted_length, candidate, length, false, folded);
    unsigned cost = exact > folded ? folded + CASE : folded;
    if (exact != 0 && cost <= bound) {
        suggest->best = candidate;
        suggest->best_cost = cost;
    }
}
