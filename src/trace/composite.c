// A ray against a composite: the crossings of all leaves in order, as changes of what the ray is inside of.
//
// At a crossing it is not asked where a point lies: each node counts its children that the ray is inside of, and a
// leaf's crossing changes the counts on its way to the root. Crossings that rounding cannot tell apart happen together:
// what hides a surface is judged on that side of them where it would show, so that coincident faces leave no film
// behind. docs/numerics.md, "Composites", says how near is together.
//
// SPDX-License-Identifier: MIT
#include "trace/shapes.h"

#include <string.h>

typedef struct Crossing {
    double t, error;
    uint32_t solid; // within the assembly
    uint8_t side;
    bool leaves;    // the solid's own inside, not minding PART_INVERSE
    bool is_flat;   // changes nothing
    bool is_hidden; // found before the crossings of its group
} Crossing;

// An assembly while a ray passes through it.
typedef struct Passage {
    const ShapeTable *table;
    const Assembly *assembly;
    const Ray *ray;
    double start_error;    // how far along the ray its start may be off its surface
    double enter;          // where the ray comes to the assembly's box
    double nearest_share;  // no crossing is nearer than this share of its t
    uint32_t *inside;      // for each node
    bool *is_inside;       // for each solid, PART_INVERSE minded
    Crossing *crossings;   // a heap by t, then by number
    uint32_t count;
} Passage;

static const Solid *passage_solid(const Passage *p, uint32_t index)
{
    return &p->table->solids[p->assembly->first_solid + index];
}

static bool node_is_inside(const TreeNode *node, uint32_t inside)
{
    return (inside >= node->needed) != node->is_inverse;
}

// The ray goes into or out of a leaf's set.
static void passage_toggle(Passage *p, uint32_t index)
{
    bool *state = &p->is_inside[index];
    bool enters = *state = !*state;
    uint32_t at = passage_solid(p, index)->node;
    while (at != NODE_NONE) {
        const TreeNode *node = &p->table->nodes[at];
        uint32_t *inside = &p->inside[at - p->assembly->first_node];
        bool before = node_is_inside(node, *inside);
        *inside = enters ? *inside + 1 : *inside - 1;
        if (node_is_inside(node, *inside) == before) {
            return;
        }
        enters = !before;
        at = node->parent;
    }
}

// ---- the heap

static bool crossing_is_before(const Crossing *a, const Crossing *b)
{
    return a->t < b->t || (a->t == b->t && a->solid < b->solid);
}

static void heap_sift(Passage *p, uint32_t at)
{
    Crossing *c = p->crossings;
    for (;;) {
        uint32_t least = at;
        for (uint32_t child = 2 * at + 1; child <= 2 * at + 2 && child < p->count; child++) {
            least = crossing_is_before(&c[child], &c[least]) ? child : least;
        }
        if (least == at) {
            return;
        }
        Crossing moved = c[at];
        c[at] = c[least];
        c[least] = moved;
        at = least;
    }
}

// Takes the first crossing out and puts it where the heap ended; returns its place.
static uint32_t heap_pop(Passage *p)
{
    Crossing first = p->crossings[0];
    p->count--;
    p->crossings[0] = p->crossings[p->count];
    p->crossings[p->count] = first;
    heap_sift(p, 0);
    return p->count;
}

// ---- what crosses the ray

static void passage_add(Passage *p, uint32_t index, double t, double error, uint8_t side, bool leaves, bool is_flat)
{
    double share = t / (t + error);
    p->nearest_share = share < p->nearest_share ? share : p->nearest_share;
    p->crossings[p->count++] = (Crossing){t, error, index, side, leaves, is_flat, false};
}

static void passage_flat(Passage *p, uint32_t index, RayStart start)
{
    const Solid *solid = passage_solid(p, index);
    Ray object = solid_ray(solid, p->ray);
    double t;
    bool is_start = starts_on_part(start) && solid_equal(solid, &p->table->solids[part_index(start.shape)]);
    if (is_start || !solid_flat_root(solid, &object, &t)) {
        return;
    }
    double error = solid_crossing_error(solid, p->ray, &object, t, 0);
    if (t > (starts_beside(p->table, start, solid) ? error + p->start_error : 0.0)) {
        passage_add(p, index, t, error, 0, false, true);
    }
}

// Puts a leaf into the state it has where the ray starts, and adds what the ray crosses of it later. A ray that starts
// on a surface has passed what lies within rounding of its start.
static void passage_solid_begin(Passage *p, uint32_t index, RayStart start, bool is_own)
{
    const Solid *solid = passage_solid(p, index);
    bool is_start = is_own && part_index(start.shape) == p->assembly->first_solid + index;
    bool is_beside = !is_start && (is_own || starts_beside(p->table, start, solid));
    bool inward = start.inward != solid->flips;
    Chord chord;
    Ray object = solid_ray(solid, p->ray);
    if ((is_start && !inward) || !solid_chord(solid, &object, is_start ? part_side(start.shape) : SIDE_NONE, &chord)) {
        return;
    }
    double leave_error = solid_chord_error(solid, p->ray, &object, &chord, true);
    if (!(chord.leave > (is_beside ? leave_error + p->start_error : 0.0))) {
        return;
    }
    double enter_error = solid_chord_error(solid, p->ray, &object, &chord, false);
    if (is_start || !(chord.enter > (is_beside ? enter_error + p->start_error : 0.0))) {
        passage_toggle(p, index);
    } else {
        passage_add(p, index, chord.enter, enter_error, chord.enter_side, false, false);
    }
    if (chord.leave < (double)INFINITY) {
        passage_add(p, index, chord.leave, leave_error, chord.leave_side, true, false);
    }
}

// ---- what is seen

// Whether nothing on the way to the root hides the surface, as far as it can be judged before the crossings of its
// group (is_after = false) or after them. An intersection shows a surface where all others are inside on the inner side
// of it, a merge where none is on the outer side.
static bool crossing_shows(const Passage *p, const Crossing *c, bool is_after)
{
    const Solid *solid = passage_solid(p, c->solid);
    bool leaves = c->leaves != (bool)(solid->flags & PART_INVERSE);
    bool is_child_inside = !c->is_flat && p->is_inside[c->solid];
    uint32_t at = solid->node;
    while (at != NODE_NONE) {
        const TreeNode *node = &p->table->nodes[at];
        uint32_t inside = p->inside[at - p->assembly->first_node];
        uint32_t others = inside - is_child_inside;
        bool is_all = node->op == NODE_INTERSECTION || node->op == NODE_CLIP;
        bool judges_after = is_all ? !leaves : leaves;
        if (judges_after == is_after && ((is_all && others != node->child_count - 1) ||
                                         (node->op == NODE_MERGE && others != 0))) {
            return false;
        }
        is_child_inside = node_is_inside(node, inside);
        leaves = leaves != node->is_inverse;
        at = node->parent;
    }
    return true;
}

static bool crossing_has_surface(const Passage *p, const Crossing *c)
{
    const Solid *solid = passage_solid(p, c->solid);
    return !(solid->flags & PART_UNSEEN) && !((solid->flags & PART_OPEN) && c->side != 0);
}

// Lets the crossings from `begin` to `end` happen, and offers the first of them that is seen. True when one was.
static bool passage_cross(Passage *p, uint32_t begin, uint32_t end, Foremost *first)
{
    for (uint32_t i = begin; i < end; i++) {
        Crossing *c = &p->crossings[i];
        c->is_hidden = !crossing_has_surface(p, c) || !crossing_shows(p, c, false);
    }
    for (uint32_t i = begin; i < end; i++) {
        if (!p->crossings[i].is_flat) {
            passage_toggle(p, p->crossings[i].solid);
        }
    }
    const Crossing *seen = NULL;
    for (uint32_t i = begin; i < end; i++) {
        const Crossing *c = &p->crossings[i];
        if (!c->is_hidden && crossing_shows(p, c, true) && (!seen || c->solid < seen->solid)) {
            seen = c;
        }
    }
    if (seen) {
        solid_offer(p->table, p->assembly->first_solid + seen->solid, p->ray, seen->t,
                    crossing_span(seen->t, seen->error, p->enter), seen->side, seen->leaves, first);
    }
    return seen;
}

void assembly_closest(const ShapeTable *table, const Assembly *assembly, const Ray *ray, RayStart start,
                      double start_error, double enter, Foremost *first)
{
    if (assembly->hidden & start.use) {
        return;
    }
    uint32_t inside[assembly->node_count];
    bool is_inside[assembly->solid_count];
    Crossing crossings[2 * (size_t)assembly->solid_count];
    Passage p = {table, assembly, ray, start_error, enter, 1.0, inside, is_inside, crossings, 0};
    bool is_own =
        starts_on_part(start) && part_index(start.shape) - assembly->first_solid < assembly->solid_count;
    for (uint32_t i = 0; i < assembly->node_count; i++) {
        inside[i] = table->nodes[assembly->first_node + i].idle_inside;
    }
    for (uint32_t i = 0; i < assembly->solid_count; i++) {
        is_inside[i] = passage_solid(&p, i)->flags & PART_INVERSE;
    }
    for (uint32_t i = 0; i < assembly->solid_count; i++) {
        if (solid_is_flat(passage_solid(&p, i))) {
            passage_flat(&p, i, start);
        } else {
            passage_solid_begin(&p, i, start, is_own);
        }
    }
    for (uint32_t i = p.count / 2; i-- > 0;) {
        heap_sift(&p, i);
    }
    // Rounding makes t times the share greater by 3 u.
    while (p.count > 0 && !(p.crossings[0].t * p.nearest_share * (1.0 - 8.0 * 0x1p-53) > first->limit)) {
        uint32_t end = p.count;
        uint32_t begin = heap_pop(&p);
        double until = crossings[begin].t + crossings[begin].error;
        while (p.count > 0 && crossings[0].t - crossings[0].error <= until) {
            begin = heap_pop(&p);
        }
        if (passage_cross(&p, begin, end, first)) {
            return;
        }
    }
}
