// Packs: a run of numbers and vectors of numbers in a list of a mesh, as one node without nodes for each.
//
// SPDX-License-Identifier: MIT
#ifndef AST_PACK_H
#define AST_PACK_H

#include <stdint.h>

// Of an AST_PACKED, which has `count` items.
typedef struct AstPack {
    uint32_t number_count;
    const uint8_t *widths; // of each item: how many numbers it has; 1: it is a number
    const double *numbers; // of all, one after the other
} AstPack;

#endif
