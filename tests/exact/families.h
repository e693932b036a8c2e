// Families of hard scenes, drawn at random: eyes close above large balls, telescopes, shells, slits, lights at
// surfaces, chains of mirrors, any exponents, lengths that no double holds together.
//
// SPDX-License-Identifier: MIT
#ifndef EXACT_FAMILIES_H
#define EXACT_FAMILIES_H

#include "exact/reference.h"
#include "math/random.h"

typedef struct Family {
    const char *name;
    void (*draw)(Random *random, ExactScene *scene);
} Family;

extern const Family families[];
extern const int family_count;

#endif
