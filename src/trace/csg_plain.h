// One node of a few convex leaves, or of any number that have something in common: where no crossings come together,
// what is seen follows from the leaves' intervals alone, and most rays end there. Included by csg.c only, which does
// what is left.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CSG_PLAIN_H
#define TRACE_CSG_PLAIN_H

#include "trace/csg_traversal.h"

// The crossings of such a tree by leaf: of each it has two at most. What is missing lies behind the start, or nowhere.
typedef struct PlainEnds {
    Crossing *enter[CSG_PLAIN_MOST], *leave[CSG_PLAIN_MOST];
} PlainEnds;

static bool plain_is_inverse(const CsgTraversal *p, uint32_t index)
{
    return traversal_primitive(p, index)->flags & PRIMITIVE_INVERSE;
}

// The crossing at which the ray comes out of all that it starts in.
static Crossing *plain_first_out(const CsgTraversal *p, const PlainEnds *ends)
{
    Crossing *first = NULL;
    for (uint32_t i = 0; i < p->csg->primitive_count; i++) {
        Crossing *out = plain_is_inverse(p, i) ? ends->enter[i] : ends->leave[i];
        first = out && (!first || out->t < first->t) ? out : first;
    }
    return first;
}

// The crossing at which the ray has come into all of them: it is in all that decide from the last of their ends on, and
// behind that each leaf that is cut out of them may be left later. NULL when it never is.
static Crossing *plain_last_in(const CsgTraversal *p, const PlainEnds *ends)
{
    Crossing *last = NULL;
    for (uint32_t i = 0; i < p->csg->primitive_count; i++) {
        Crossing *in = plain_is_inverse(p, i) ? NULL : ends->enter[i];
        last = in && (!last || in->t > last->t) ? in : last;
    }
    for (uint32_t i = 0; i < p->csg->primitive_count;) {
        double from = last ? last->t : 0.0;
        bool is_cut = plain_is_inverse(p, i) && (p->is_inside[i] || (ends->enter[i] && ends->enter[i]->t < from)) &&
                      (!ends->leave[i] || ends->leave[i]->t > from);
        if (is_cut && (!ends->leave[i] || ends->leave[i]->t > p->decided_until)) {
            return NULL;
        }
        last = is_cut ? ends->leave[i] : last;
        i = is_cut ? 0 : i + 1; // what was no cut before may be one there
    }
    return last;
}

// Whether each crossing up to `until` happens by itself: the next one is apart from it.
static bool plain_are_apart(CsgTraversal *p, double until)
{
    Crossing *order[2 * CSG_PLAIN_MOST];
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *own = &p->crossings[i];
        uint32_t at = i;
        for (; at > 0 && crossing_is_before(own, order[at - 1]); at--) {
            order[at] = order[at - 1];
        }
        order[at] = own;
    }
    for (uint32_t i = 0; i + 1 < p->count && order[i]->t <= until; i++) {
        if (!crossing_is_apart(p, order[i], order[i + 1])) {
            return false;
        }
    }
    return true;
}

// What traversal_cross finds where no crossing comes with others, by intervals. False where some come together up to
// what is seen, or to where nothing more can be, or where what would be seen has no surface: nothing was decided.
static bool plain_closest(CsgTraversal *p, Foremost *first)
{
    PlainEnds ends = {{NULL}, {NULL}};
    bool starts_inside = true;
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *c = &p->crossings[i];
        *(c->leaves ? &ends.leave[c->solid] : &ends.enter[c->solid]) = c;
    }
    for (uint32_t i = 0; i < p->csg->primitive_count; i++) {
        starts_inside = starts_inside && p->is_inside[i] != plain_is_inverse(p, i);
    }
    Crossing *seen = starts_inside ? plain_first_out(p, &ends) : plain_last_in(p, &ends);
    bool is_seen = seen && seen->t <= p->decided_until;
    if ((is_seen && !seen->has_surface) || !plain_are_apart(p, is_seen ? seen->t : p->decided_until)) {
        return false;
    }
    if (is_seen) {
        crossing_offer(p, seen, first);
    }
    return true;
}

// What convex primitives have in common is seen at the last of their ends or, from within, at the first where one is
// left. Whatever comes before that shows nothing. False where another crossing comes together with it, or where it has
// no surface: nothing was decided.
static bool meet_closest(CsgTraversal *p, Foremost *first)
{
    bool starts_inside = true;
    Crossing *seen = NULL;
    for (uint32_t i = 0; i < p->csg->primitive_count; i++) {
        starts_inside = starts_inside && p->is_inside[i];
    }
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *c = &p->crossings[i];
        bool is_better = !seen || (starts_inside ? c->t < seen->t : c->t > seen->t);
        seen = c->leaves == starts_inside && is_better ? c : seen;
    }
    if (!seen) {
        return true; // it is never left
    }
    if (!seen->has_surface || !(seen->t <= p->decided_until)) {
        return false;
    }
    for (uint32_t i = 0; i < p->count; i++) {
        Crossing *c = &p->crossings[i];
        bool is_before = crossing_is_before(c, seen);
        if (c != seen && !crossing_is_apart(p, is_before ? c : seen, is_before ? seen : c)) {
            return false;
        }
    }
    crossing_offer(p, seen, first);
    return true;
}

#endif
