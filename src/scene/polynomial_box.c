// The box of a surface that is closed: of an ellipsoid by its form; of another one where the terms of its order are
// positive everywhere, so that far out nothing else matters.
//
// What holds all along a box of places is known by its corners, where no coordinate changes its sign in it: there each
// term is least at one corner and greatest at the opposite one. Where that does not tell, the box is cut, up to a
// budget of terms; what is not known then counts as no box.
//
// SPDX-License-Identifier: MIT
#include "scene/polynomial.h"

#include <math.h>

#include "math/extreme.h"

// The box of an ellipsoid whose inside is within: with f = p·Q p + 2 b·p + c, the middle m is -Q⁻¹ b, and the surface
// reaches sqrt(-f(m) (Q⁻¹)_ii) from it along an axis. Q is positive if its leading minors are. What rounding may do is
// far below the share of 2^-20 that is added, where no minor is smaller than 2^-6 of its terms: elsewhere there is no
// box.
static bool ellipsoid_box(const double *c, Vec3 *low, Vec3 *high)
{
    const double share = 0x1p-6;
    double xx = c[0], xy = 0.5 * c[1], xz = 0.5 * c[2], yy = c[4], yz = 0.5 * c[5], zz = c[7];
    Vec3 b = {0.5 * c[3], 0.5 * c[6], 0.5 * c[8]};
    double minors[3] = {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy};
    if (!(xx > 0.0 && yy > 0.0 && zz > 0.0 && minors[0] > share * yy * zz && minors[1] > share * xx * zz &&
          minors[2] > share * xx * yy)) {
        return false;
    }
    double xy_minor = xz * yz - xy * zz, xz_minor = xy * yz - xz * yy, yz_minor = xy * xz - yz * xx;
    double whole = xx * minors[0] + xy * xy_minor + xz * xz_minor;
    if (!(whole > share * xx * yy * zz)) {
        return false;
    }
    Vec3 middle = {-(minors[0] * b.x + xy_minor * b.y + xz_minor * b.z) / whole,
                   -(xy_minor * b.x + minors[1] * b.y + yz_minor * b.z) / whole,
                   -(xz_minor * b.x + yz_minor * b.y + minors[2] * b.z) / whole};
    double depth = -(vec3_dot(b, middle) + c[9]), size = fabs(c[9]) + fabs(vec3_dot(b, middle));
    if (!(depth > 0x1p-8 * size)) {
        return false;
    }
    const double slack = 1.0 + 0x1p-20;
    Vec3 half = {slack * sqrt(depth * minors[0] / whole), slack * sqrt(depth * minors[1] / whole),
                 slack * sqrt(depth * minors[2] / whole)};
    half = vec3_add(half, vec3(0x1p-20 * fabs(middle.x), 0x1p-20 * fabs(middle.y), 0x1p-20 * fabs(middle.z)));
    *low = vec3_sub(middle, half);
    *high = vec3_add(middle, half);
    return vec3_is_finite(*low) && vec3_is_finite(*high);
}

// ---- other surfaces

enum { ORDER_MOST = 8, FORM_DEPTH = 6, SLAB_DEPTH = 10, CUTS_MOST = 5, TURNS_MOST = 3, TERMS_BUDGET = 100000 };

typedef struct Bounding {
    const double *list;
    unsigned least_degree; // of the terms that count
    int budget;            // of terms
} Bounding;

// A box of places: low..high by sizes of coordinates, which all have one sign.
typedef struct Cell {
    double low[3], high[3], sign[3];
} Cell;

// The least that the terms may sum up to in a cell, less what rounding may do.
static double cell_least(Bounding *of, const Cell *cell)
{
    unsigned order = polynomial_order(of->list);
    const double *c = polynomial_terms(of->list);
    double powers[3][2][ORDER_MOST + 1], sum = 0.0, size = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        powers[axis][0][0] = powers[axis][1][0] = 1.0;
        for (unsigned i = 1; i <= order; i++) {
            powers[axis][0][i] = powers[axis][0][i - 1] * cell->low[axis];
            powers[axis][1][i] = powers[axis][1][i - 1] * cell->high[axis];
        }
    }
    of->budget -= (int)polynomial_count(order);
    for (unsigned i = order + 1; i-- > 0;) {
        for (unsigned j = order - i + 1; j-- > 0;) {
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                double own = *c++;
                if (own == 0.0 || i + j + k < of->least_degree) {
                    continue;
                }
                own *= (i % 2 ? cell->sign[0] : 1.0) * (j % 2 ? cell->sign[1] : 1.0) * (k % 2 ? cell->sign[2] : 1.0);
                int end = own < 0.0;
                double term = own * (powers[0][end][i] * powers[1][end][j] * powers[2][end][k]);
                sum += term;
                size += fabs(own) * (powers[0][1][i] * powers[1][1][j] * powers[2][1][k]);
            }
        }
    }
    return sum - 0x1p-40 * size;
}

// Whether the terms are above 0 all over a cell; *least is made no more than what they are there. `share` is how much
// of what they are in the middle a bound must have, as long as cells may be cut, `depth` times.
static bool cell_is_positive(Bounding *of, const Cell *cell, int depth, double share, double *least)
{
    double bound = cell_least(of, cell), wanted = 0.0;
    if (share > 0.0 || !(bound > 0.0)) {
        Cell middle = *cell;
        for (int axis = 0; axis < 3; axis++) {
            middle.low[axis] = middle.high[axis] = 0.5 * (cell->low[axis] + cell->high[axis]);
        }
        double value = cell_least(of, &middle);
        if (!(value > 0.0)) {
            return false;
        }
        wanted = share * value;
    }
    if (bound > 0.0 && (bound >= wanted || depth == 0)) {
        *least = less_of(*least, bound);
        return true;
    }
    if (depth == 0 || of->budget < 0) {
        return false;
    }
    Cell halves[2] = {*cell, *cell};
    int widest = 0;
    for (int axis = 1; axis < 3; axis++) {
        bool is_wider = cell->high[axis] - cell->low[axis] > cell->high[widest] - cell->low[widest];
        widest = is_wider ? axis : widest;
    }
    halves[0].high[widest] = halves[1].low[widest] = 0.5 * (cell->low[widest] + cell->high[widest]);
    return cell_is_positive(of, &halves[0], depth - 1, share, least) &&
           cell_is_positive(of, &halves[1], depth - 1, share, least);
}

// Whether the terms of the order are above 0 on the cube of size 1, and how much at the least. They are the same at
// opposite places.
static bool leading_least(Bounding *of, double *least)
{
    *least = (double)INFINITY;
    for (int face = 0; face < 3; face++) {
        for (int signs = 0; signs < 4; signs++) {
            Cell cell = {{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}};
            cell.low[face] = 1.0;
            cell.sign[(face + 1) % 3] = signs & 1 ? -1.0 : 1.0;
            cell.sign[(face + 2) % 3] = signs & 2 ? -1.0 : 1.0;
            if (!cell_is_positive(of, &cell, FORM_DEPTH, 0.25, least)) {
                return false;
            }
        }
    }
    return true;
}

// How far out, as a power of two, the terms of the order are more than all others together.
static bool farthest(const double *list, double least, double *reach)
{
    enum { EXPONENT_MOST = 100 };
    unsigned order = polynomial_order(list);
    const double *sizes = polynomial_sizes(list);
    bool is_known = false;
    for (int exponent = EXPONENT_MOST; exponent >= -EXPONENT_MOST; exponent--) {
        double sum = 0.0;
        for (unsigned k = 0; k < order; k++) {
            sum += ldexp(sizes[k], exponent * ((int)k - (int)order));
        }
        if (!(sum * (1.0 + 0x1p-40) < least)) {
            break;
        }
        *reach = ldexp(1.0, exponent);
        is_known = true;
    }
    return is_known && *reach > ldexp(1.0, -EXPONENT_MOST);
}

// Whether all between two corners is outside.
static bool box_is_outside(Bounding *of, const double low[3], const double high[3])
{
    double least = (double)INFINITY;
    for (int signs = 0; signs < 8; signs++) {
        Cell cell;
        bool is_there = true;
        for (int axis = 0; axis < 3; axis++) {
            bool is_below = signs >> axis & 1;
            double from = is_below ? -high[axis] : low[axis], to = is_below ? -low[axis] : high[axis];
            is_there = is_there && to > 0.0;
            cell.low[axis] = greater_of(from, 0.0);
            cell.high[axis] = to;
            cell.sign[axis] = is_below ? -1.0 : 1.0;
        }
        if (is_there && !cell_is_positive(of, &cell, SLAB_DEPTH, 0.0, &least)) {
            return false;
        }
    }
    return true;
}

// Cuts such a share off a side, if that is outside.
static bool side_cut(Bounding *of, int side, double share, double low[3], double high[3])
{
    int axis = side / 2;
    bool is_high = side & 1;
    double from[3] = {low[0], low[1], low[2]}, to[3] = {high[0], high[1], high[2]};
    double width = share * (high[axis] - low[axis]);
    double cut = is_high ? high[axis] - width : low[axis] + width;
    *(is_high ? &from[axis] : &to[axis]) = cut;
    if (!box_is_outside(of, from, to)) {
        return false;
    }
    *(is_high ? &high[axis] : &low[axis]) = cut;
    return true;
}

// Cuts off pieces of a box that are outside, the larger ones first.
static void box_shrink(Bounding *of, double low[3], double high[3])
{
    double share = 0.4;
    for (int i = 0; i < CUTS_MOST; i++, share *= 0.5) {
        for (int side = 0; side < 6; side++) {
            for (int turn = 0; turn < TURNS_MOST && of->budget > 0 && side_cut(of, side, share, low, high);) {
                turn++;
            }
        }
    }
}

static bool closed_box(const double *list, Vec3 *low, Vec3 *high)
{
    unsigned order = polynomial_order(list);
    Bounding of = {list, order, TERMS_BUDGET};
    double least, reach, from[3], to[3];
    if (order % 2 != 0 || order > ORDER_MOST || !leading_least(&of, &least) || !farthest(list, least, &reach)) {
        return false;
    }
    for (int axis = 0; axis < 3; axis++) {
        from[axis] = -reach;
        to[axis] = reach;
    }
    of.least_degree = 0;
    box_shrink(&of, from, to);
    double slack = 0x1p-20 * reach;
    *low = vec3(from[0] - slack, from[1] - slack, from[2] - slack);
    *high = vec3(to[0] + slack, to[1] + slack, to[2] + slack);
    return true;
}

bool polynomial_box(const double *list, Vec3 *low, Vec3 *high)
{
    return polynomial_order(list) == 2 ? ellipsoid_box(polynomial_terms(list), low, high) : closed_box(list, low, high);
}
