// Did-you-mean: the nearest of many names to a mistyped one.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_SUGGEST_H
#define BASE_SUGGEST_H

#include <stddef.h>

#include "base/arena.h"

// Keeps the best candidate seen so far. Start with suggest_begin, offer every name in scope, read `best`.
typedef struct Suggest {
    const char *wanted;
    size_t wanted_length;
    const char *best;   // NULL while nothing is near enough; not owned
    unsigned best_cost; // in quarters of an edit, see below
} Suggest;

void suggest_begin(Suggest *suggest, const char *wanted);

// Offers a candidate, which must outlive the Suggest. Equal costs keep the first one offered. Near enough is one edit
// for a wanted name of 2 to 4 bytes, two up to 8, three beyond (and no more than three
// bytes in length); the name itself is not a suggestion. What fingers do by
// themselves costs three quarters of an edit: neighbours swapped, a letter doubled or a double one halved, a key beside
// the right one. Capitals cost half an edit for the whole name.
// When nothing is near, a candidate that begins with the wanted name and `_` will do.
void suggest_offer(Suggest *suggest, const char *candidate);

// Offers what is in a folder but hidden; the names are copied into the arena. None where it cannot be read.
void suggest_offer_folder(Suggest *suggest, Arena *arena, const char *folder);

#endif
