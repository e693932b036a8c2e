// Tests of base/intern.h: one symbol a text, dense numbers, budgets.
//
// SPDX-License-Identifier: MIT
#include <stdint.h>
#include <string.h>

#include "base/intern.h"
#include "unit/tap.h"

enum { NAMES = 200000 };

static void test_small(void)
{
    InternTable *table = intern_new(SIZE_MAX);
    if (!tap_ok(table != NULL, "a table")) {
        return;
    }
    tap_ok(intern_count(table) == 1, "an empty table counts SYMBOL_NONE only");
    Symbol sphere = intern_text(table, "sphere", 6);
    tap_ok(sphere == 1, "symbols start at 1");
    tap_ok(intern_text(table, "spheres", 6) == sphere, "the same bytes are the same symbol");
    tap_ok(intern_text(table, "spheres", 7) == 2, "a longer text is another symbol");
    tap_ok(intern_text(table, "Sphere", 6) == 3, "case matters");
    tap_ok(intern_find(table, "plane", 5) == SYMBOL_NONE && intern_count(table) == 4, "find makes nothing");
    tap_ok(intern_find(table, "sphere", 6) == sphere, "find finds");
    Symbol empty = intern_text(table, "", 0);
    tap_ok(empty == 4 && intern_text(table, NULL, 0) == empty, "the empty text has a symbol of its own");
    Symbol zeros = intern_text(table, "a\0b", 3);
    tap_ok(zeros != intern_text(table, "a\0c", 3) && intern_length(table, zeros) == 3, "texts may hold zeros");
    tap_ok(memcmp(intern_get(table, zeros), "a\0b", 4) == 0, "and keep them");
    tap_ok(strcmp(intern_get(table, SYMBOL_NONE), "") == 0, "SYMBOL_NONE reads as nothing");
    tap_ok(intern_length(table, SYMBOL_NONE) == 0, "and has no length");
    tap_ok(strcmp(intern_get(table, 12345), "") == 0, "a number that is no symbol reads as nothing");
    intern_free(table);
    intern_free(NULL);
}

static void test_many(void)
{
    InternTable *table = intern_new(SIZE_MAX);
    bool is_dense = table != NULL, is_found = true;
    const char *first = NULL;
    char name[32];
    for (unsigned i = 0; table && i < NAMES; i++) {
        int length = snprintf(name, sizeof(name), "Atom_%u", i);
        is_dense = is_dense && intern_text(table, name, (size_t)length) == i + 1;
        first = i == 0 ? intern_get(table, 1) : first;
    }
    for (unsigned i = 0; table && i < NAMES; i++) {
        int length = snprintf(name, sizeof(name), "Atom_%u", i);
        is_found = is_found && intern_find(table, name, (size_t)length) == i + 1 &&
                   strcmp(intern_get(table, i + 1), name) == 0 && intern_length(table, i + 1) == (size_t)length;
    }
    tap_ok(is_dense, "symbols are dense, in order of first appearance");
    tap_ok(is_found, "each of %d names is found again", NAMES);
    tap_ok(table && first == intern_get(table, 1), "a text does not move when the table grows");
    tap_ok(table && intern_count(table) == NAMES + 1, "count is one more than the greatest symbol");
    intern_free(table);
}

static void test_budget(void)
{
    InternTable *table = intern_new(8);
    if (!tap_ok(table != NULL, "a table with a budget of 8 bytes")) {
        return;
    }
    tap_ok(intern_text(table, "12345678", 8) == SYMBOL_NONE, "8 bytes and their zero are too many");
    tap_ok(intern_text(table, "abc", 3) == 1 && intern_text(table, "def", 3) == 2, "two of 3 fit");
    tap_ok(intern_text(table, "", 0) == SYMBOL_NONE, "then it is full");
    tap_ok(intern_text(table, "abc", 3) == 1, "known texts are still found");
    tap_ok(intern_count(table) == 3, "a refused text has no symbol");
    intern_free(table);
}

int main(void)
{
    test_small();
    test_many();
    test_budget();
    return tap_done();
}
