// Did-you-mean: a bounded edit distance in a narrow band, so that a name of another length costs next to nothing.
//
// SPDX-License-Identifier: MIT
#include "base/suggest.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/attributes.h"

// Costs in quarters of an edit.
enum {
    EDIT = 4,
    SLIP = 3, // a swap of two neighbours, a letter doubled or a double one halved, a key beside the right one
    CASE = 2, // the whole name, however many letters
    BAND = 3, // the most edits that are ever accepted, and so the farthest from the diagonal
    ROW = 2 * BAND + 1,
    PART = 4, // the least length of a word that stands for a longer one: `light` for `light_source`
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

// Keys that touch on the keyboard that most have, QWERTY.
static bool is_beside(char a, char b)
{
    static const char *const rows[] = {"1234567890", "qwertyuiop", "asdfghjkl", "zxcvbnm"};
    int row_a = -1, row_b = -1, column_a = 0, column_b = 0;
    for (int row = 0; row < (int)RT_COUNT_OF(rows); row++) {
        const char *at_a = strchr(rows[row], fold(a)), *at_b = strchr(rows[row], fold(b));
        row_a = at_a ? row : row_a;
        column_a = at_a ? (int)(at_a - rows[row]) : column_a;
        row_b = at_b ? row : row_b;
        column_b = at_b ? (int)(at_b - rows[row]) : column_b;
    }
    if (row_a < 0 || row_b < 0) {
        return false;
    }
    // A row stands half a key to the right of the one above it.
    int down = row_b - row_a, right = column_b - column_a;
    return down == 0 ? abs(right) == 1 : abs(down) == 1 && (right == 0 || right == -down);
}

static unsigned least(unsigned a, unsigned b)
{
    return a < b ? a : b;
}

// A name, and whether capitals count in it.
typedef struct Name {
    const char *text;
    size_t length;
    bool is_folded;
} Name;

// What it costs that character i of a name is there and not in the other one.
static unsigned extra_cost(const Name *name, size_t i)
{
    return i > 0 && same(name->text[i], name->text[i - 1], name->is_folded) ? SLIP : EDIT;
}

static unsigned other_cost(char a, char b, bool is_folded)
{
    return same(a, b, is_folded) ? 0 : is_beside(a, b) ? SLIP : EDIT;
}

// The restricted Damerau-Levenshtein distance (F. Damerau, CACM 7(3), 1964; V. Levenshtein, 1966) of two texts, or more
// than `bound` if it is more. Row i holds the cells |i - j| <= BAND at column j - i + BAND.
static unsigned edit_distance(const Name *one, const Name *other, unsigned bound)
{
    const char *a = one->text, *b = other->text;
    size_t a_length = one->length, b_length = other->length;
    bool is_folded = one->is_folded;
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
            if (i == 0 && j == 0) {
                cost = 0;
            } else if (i == 0) {
                cost = row[k - 1] + extra_cost(other, j - 1);
            } else {
                cost = k + 1 < ROW ? least(cost, up[k + 1] + extra_cost(one, i - 1)) : cost;
                cost = k > 0 && j > 0 ? least(cost, row[k - 1] + extra_cost(other, j - 1)) : cost;
                cost = j > 0 ? least(cost, up[k] + other_cost(a[i - 1], b[j - 1], is_folded)) : cost;
                if (i > 1 && j > 1 && same(a[i - 1], b[j - 2], is_folded) && same(a[i - 2], b[j - 1], is_folded)) {
                    cost = least(cost, upper[k] + SLIP);
                }
            }
            row[k] = cost;
            row_least = least(row_least, cost);
        }
        if (row_least > bound && row_least_before + SLIP > bound) {
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
    if (wanted_length >= PART && !suggest->best && strncmp(candidate, suggest->wanted, wanted_length) == 0 &&
        candidate[wanted_length] == '_') {
        suggest->best = candidate; // at the highest cost that is accepted
        return;
    }
    size_t reach = bound / SLIP < BAND ? bound / SLIP : BAND;
    size_t length = strnlen(candidate, wanted_length + reach + 1);
    if (length > wanted_length + reach || length + reach < wanted_length || length == 0) {
        return;
    }
    Name wanted = {suggest->wanted, wanted_length, true}, offered = {candidate, length, true};
    unsigned folded = edit_distance(&wanted, &offered, bound);
    if (folded > bound) {
        return;
    }
    wanted.is_folded = offered.is_folded = false;
    unsigned exact = edit_distance(&wanted, &offered, folded);
    unsigned cost = exact > folded ? folded + CASE : folded;
    if (exact != 0 && cost <= bound) {
        suggest->best = candidate;
        suggest->best_cost = cost;
    }
}

void suggest_offer_folder(Suggest *suggest, Arena *arena, const char *folder)
{
    DIR *directory = opendir(folder);
    if (directory == NULL) {
        return;
    }
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        char *name = arena_copy_text(arena, entry->d_name, strlen(entry->d_name));
        if (name != NULL && name[0] != '.') {
            suggest_offer(suggest, name);
        }
    }
    closedir(directory);
}
