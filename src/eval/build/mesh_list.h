// Reads one list in braces of a mesh2, `word { count, item, item, … }`, item by item: vectors and numbers, whether the
// grammar made nodes of them or packed them without. Knows nothing of what the items mean.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_MESH_LIST_H
#define EVAL_MESH_LIST_H

#include "ast/pack.h"
#include "eval/build/blocks.h"

// A list while it is read; from mesh_list_open to mesh_list_close. Refers to the nodes of the list, owns nothing.
typedef struct MeshList {
    Eval *ev;
    const AstNode *node;
    Cursor cursor;
    const char *word;
    uint32_t wanted;       // how many items the text says there are
    const AstNode *packed; // the pack that is being read; NULL: none
    uint32_t at;           // its next item
    const double *numbers; // of that item
    Span span;             // of the last item that was not packed
} MeshList;

// Of all these, false: a fault is reported, and the list is to be closed.

// Begins a list, and reads how many items it says it has: 1 to MESH_FACES_MOST.
bool mesh_list_open(MeshList *list, Block *block, const AstNode *node) RT_MUST_CHECK;
// What mesh_list_next and mesh_list_number say below, where no item of a pack is left.
bool mesh_list_next_item(MeshList *list, uint32_t number, unsigned least, double v[3]);
bool mesh_list_number_item(MeshList *list, double *number, bool *is_there);
// Reports that the list has only `number` items; false.
bool mesh_list_ends_early(MeshList *list, uint32_t number);
// Where the last item stands. Reads a pack's text once more: for messages.
Span mesh_list_span(const MeshList *list);
// Ends a list. is_fine: all went well so far; then items beyond the count are a fault. Returns whether all went well.
bool mesh_list_close(MeshList *list, bool is_fine) RT_MUST_CHECK;

// The next item, of which `number` are read, as three numbers: those of a vector, or one number that stands for all.
// Missing coordinates are 0. `least`: how many coordinates a vector has at least; 2: v[2] means nothing, else 3.
RT_ALWAYS_INLINE bool mesh_list_next(MeshList *list, uint32_t number, unsigned least, double v[3])
{
    if (RT_UNLIKELY(!list->packed || list->at == list->packed->count)) {
        return mesh_list_next_item(list, number, least, v);
    }
    unsigned width = list->packed->pack->widths[list->at];
    v[0] = list->numbers[0];
    v[1] = width > 1 ? list->numbers[1] : v[0];
    v[2] = width > 2 ? list->numbers[2] : width > 1 ? 0.0 : v[0];
    list->numbers += width;
    list->at++;
    return true;
}

// A number that may follow a vector. *is_there: whether it does; then *number is set.
RT_ALWAYS_INLINE bool mesh_list_number(MeshList *list, double *number, bool *is_there)
{
    *is_there = false;
    if (RT_UNLIKELY(!list->packed || list->at == list->packed->count)) {
        return mesh_list_number_item(list, number, is_there);
    }
    if (list->packed->pack->widths[list->at] == 1) {
        *number = *list->numbers++;
        list->at++;
        *is_there = true;
    }
    return true;
}

#endif
