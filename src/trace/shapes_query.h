// What one ray asks of primitives that stand alone and composites, the boxes of these, and what a ray has passed where
// it starts: part of spheres_kernel.c.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_QUERY_H
#define TRACE_SHAPES_QUERY_H

#include <float.h>

#include "trace/shapes.h"

// The ray's line in the coordinates of the tree, as the boxes of items want it.
typedef struct BoxLine {
    bool is_set;
    double low_from[3], high_from[3]; // planes are met at (plane - from) * inverse
    double inverse[3], unscale;
} BoxLine;

// What a ray asks of all shapes.
typedef struct ShapeQuery {
    const ShapeTable *table;
    const Ray *ray;
    RayStart start;
    double start_error; // less than 0: not asked for yet
    const PreparedPrimitive *left; // that it starts on; NULL for none
    bool is_any;       // whatever is met before the end of the way will do
    const PreparedPrimitive
        *bounded;         // the primitive that is the first, where its hit's span is only bounded; NULL: no such
    double bounded_enter; // where the ray enters its box
    uint32_t at;          // of the item that was asked last among all
    uint32_t known;       // of one that the ray does not meet; NO_BLOCKER: none is known
    const ItemBox *box;   // of the item that is asked; NULL: it has none
    const Bvh *tree;      // that the box is in
    BoxLine line;
} ShapeQuery;

// ---- the boxes of items

static void line_set(ShapeQuery *q)
{
    const Bvh *tree = q->tree;
    BoxLine *line = &q->line;
    Vec3 o = vec3_scale(tree->scale, vec3_sub(q->ray->origin, tree->centre));
    const double origin[3] = {o.x, o.y, o.z}, d[3] = {q->ray->direction.x, q->ray->direction.y, q->ray->direction.z};
    double reach = fabs(o.x) + fabs(o.y) + fabs(o.z) + (tree->half.x + tree->half.y + tree->half.z);
    double pad = 12.0 * (DBL_EPSILON / 2) * reach;
    for (int axis = 0; axis < 3; axis++) {
        line->low_from[axis] = origin[axis] + pad;
        line->high_from[axis] = origin[axis] - pad;
        line->inverse[axis] = 1.0 / copysign(fabs(d[axis]) > 0x1p-60 ? fabs(d[axis]) : 0x1p-60, d[axis]);
    }
    line->unscale = 1.0 / tree->scale;
    line->is_set = true;
}

// Whether the ray meets the item's box, and where it enters it. Which leaves a walk comes to depends on how each
// instruction set rounds floats, and on what was met before; so that no answer does, an item counts only if this says
// so, and not before `enter`. In doubles the planes, moved outward by 12 u D, may be off by 5 u D: there is always more
// of the box than rounding of the ray's origin takes away, and always less than of the walk's, which moves them by
// 32 u D and more (see bvh_walk_start). So each item that counts with a root up to some limit is in a leaf that is
// visited with that limit.
static bool item_enters(ShapeQuery *q, double *enter)
{
    *enter = 0.0;
    if (!q->box) {
        return true;
    }
    if (!q->line.is_set) {
        line_set(q);
    }
    const BoxLine *line = &q->line;
    double in = 0.0, out = (double)INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double low = (q->box->low[axis] - line->low_from[axis]) * line->inverse[axis];
        double high = (q->box->high[axis] - line->high_from[axis]) * line->inverse[axis];
        double near = low < high ? low : high, far = low < high ? high : low;
        in = in < near ? near : in;
        out = far < out ? far : out;
    }
    *enter = in * line->unscale;
    return in <= out;
}

// ---- errors

// Most rays meet nothing that it matters for.
static double start_error(ShapeQuery *q)
{
    if (q->start_error < 0.0) {
        q->start_error = shapes_start_error(q->table, q->ray, q->start);
    }
    return q->start_error;
}

// What a ray starts on has been passed up to the error of the start and the root's own, where they may coincide: how
// much of that is the start's. Less than 0 where nothing has been passed.
static double passed_error(ShapeQuery *q, const PreparedPrimitive *primitive)
{
    return starts_beside(q->table, q->start, primitive) ? start_error(q) : -1.0;
}

static bool is_passed(double t, double error, double passed)
{
    return passed >= 0.0 && !(t > error + passed);
}

// Offers a root of the item that is asked.
static void root_offer(ShapeQuery *q, const PrimitiveRoot *root, double error, Foremost *first)
{
    double enter;
    if (item_enters(q, &enter)) {
        primitive_offer(q->table, q->ray, root, crossing_span(root->t, error, enter), first);
    }
}

#endif
