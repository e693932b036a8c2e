// A piece is asked by the values that the line's form has at its control points, which are the Bernstein coefficients of
// the form along it: where all have one sign there is no root; else the piece is cut where the form has its extrema, and
// each part on which it changes its sign has one root. Signs at the ends of pieces decide how many there are, so that the
// number is even whatever rounding does in between.
//
// SPDX-License-Identifier: MIT
#include "scene/outline.h"

#include <math.h>

enum { ROOTS_MOST = 3, STEPS_MOST = 100, NEAREST_STEPS = 3 };

// ---- cubics in Bernstein form

static double cubic_at(const double f[4], double s)
{
    double r = 1.0 - s;
    return ((f[0] * r + 3.0 * s * f[1]) * r + 3.0 * s * s * f[2]) * r + s * s * s * f[3];
}

// A third of the derivative.
static double cubic_slope(const double f[4], double s)
{
    double r = 1.0 - s;
    return ((f[1] - f[0]) * r + 2.0 * s * (f[2] - f[1])) * r + s * s * (f[3] - f[2]);
}

// The root between two places where the signs differ; `is_low_below`: it is below 0 at the first.
static double cubic_root(const double f[4], double low, double high, bool is_low_below)
{
    double at_low = cubic_at(f, low), at_high = cubic_at(f, high);
    double s = low + (high - low) * (at_low / (at_low - at_high));
    s = s > low && s < high ? s : 0.5 * (low + high);
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double value = cubic_at(f, s), next = s - value / (3.0 * cubic_slope(f, s));
        *((value < 0.0) == is_low_below ? &low : &high) = s;
        if (value == 0.0 || fabs(next - s) <= 0x1p-53 * s) {
            return s;
        }
        s = next > low && next < high ? next : 0.5 * (low + high);
    }
    return s;
}

// The extrema within (0, 1), in order.
static unsigned cubic_extrema(const double f[4], double at[2])
{
    double a = f[1] - f[0], b = f[2] - f[1], c = f[3] - f[2]; // (1-s)² a + 2 s (1-s) b + s² c
    double square = (a - b) - (b - c), half = a - b, discriminant = half * half - square * a;
    unsigned count = 0;
    if (!(discriminant > 0.0)) {
        return 0;
    }
    double q = half + copysign(sqrt(discriminant), half), roots[2] = {q / square, a / q};
    for (unsigned i = 0; i < 2; i++) {
        if (roots[i] > 0.0 && roots[i] < 1.0) {
            at[count++] = roots[i];
        }
    }
    if (count == 2 && at[0] > at[1]) {
        double first = at[1];
        at[1] = at[0];
        at[0] = first;
    }
    return count;
}

static unsigned cubic_roots(const double f[4], double roots[ROOTS_MOST])
{
    bool is_below = f[0] < 0.0, is_below_end = f[3] < 0.0;
    if (is_below == is_below_end && (f[1] < 0.0) == is_below && (f[2] < 0.0) == is_below) {
        return 0;
    }
    double ends[4], from = 0.0;
    unsigned extrema = cubic_extrema(f, ends), count = 0;
    ends[extrema] = 1.0;
    for (unsigned i = 0; i <= extrema; i++) {
        bool is_below_next = i == extrema ? is_below_end : cubic_at(f, ends[i]) < 0.0;
        if (is_below != is_below_next) {
            roots[count++] = cubic_root(f, from, ends[i], is_below);
        }
        is_below = is_below_next;
        from = ends[i];
    }
    return count;
}

// ---- pieces

static OutlinePoint piece_at(const double *piece, unsigned degree, double s)
{
    if (degree == 1) {
        return (OutlinePoint){piece[0] + s * (piece[2] - piece[0]), piece[1] + s * (piece[3] - piece[1])};
    }
    const double u[4] = {piece[0], piece[2], piece[4], piece[6]}, v[4] = {piece[1], piece[3], piece[5], piece[7]};
    return (OutlinePoint){cubic_at(u, s), cubic_at(v, s)};
}

static unsigned piece_cross(const double *piece, unsigned degree, double a, double b, double c, double roots[ROOTS_MOST])
{
    double f[4];
    for (unsigned i = 0; i <= degree; i++) {
        f[i] = a * piece[2 * i] + c * piece[2 * i + 1] + b;
    }
    if (degree > 1) {
        return cubic_roots(f, roots);
    }
    if ((f[0] < 0.0) == (f[1] < 0.0)) {
        return 0;
    }
    roots[0] = f[0] / (f[0] - f[1]);
    return 1;
}

uint32_t outline_cross(const Numbers *list, double a, double b, double c, OutlinePoint *points)
{
    unsigned degree = outline_degree(list);
    uint32_t pieces = outline_piece_count(list), count = 0;
    for (uint32_t i = 0; i < pieces; i++) {
        const double *piece = outline_piece(list, i);
        double roots[ROOTS_MOST];
        unsigned found = piece_cross(piece, degree, a, b, c, roots);
        for (unsigned k = 0; k < found; k++) {
            points[count++] = piece_at(piece, degree, roots[k]);
        }
    }
    return count;
}

bool outline_holds(const Numbers *list, OutlinePoint p)
{
    unsigned degree = outline_degree(list);
    uint32_t pieces = outline_piece_count(list);
    bool is_inside = false;
    for (uint32_t i = 0; i < pieces; i++) {
        const double *piece = outline_piece(list, i);
        double roots[ROOTS_MOST];
        unsigned found = piece_cross(piece, degree, 0.0, -p.v, 1.0, roots);
        for (unsigned k = 0; k < found; k++) {
            is_inside = is_inside != (piece_at(piece, degree, roots[k]).u > p.u);
        }
    }
    return is_inside;
}

// ---- the nearest point

static double distance2(OutlinePoint a, OutlinePoint b)
{
    double u = a.u - b.u, v = a.v - b.v;
    return u * u + v * v;
}

// No more than the distance from a piece, squared: that from the box of its control points.
static double piece_distance2(const double *piece, unsigned degree, OutlinePoint p)
{
    double low[2] = {piece[0], piece[1]}, high[2] = {piece[0], piece[1]}, q[2] = {p.u, p.v}, sum = 0.0;
    for (unsigned i = 2; i < 2 * (degree + 1); i++) {
        low[i & 1] = piece[i] < low[i & 1] ? piece[i] : low[i & 1];
        high[i & 1] = piece[i] > high[i & 1] ? piece[i] : high[i & 1];
    }
    for (unsigned axis = 0; axis < 2; axis++) {
        double beyond = q[axis] < low[axis] ? low[axis] - q[axis] : q[axis] > high[axis] ? q[axis] - high[axis] : 0.0;
        sum += beyond * beyond;
    }
    return sum;
}

static OutlinePoint piece_along(const double *piece, unsigned degree, double s)
{
    const unsigned end = 2 * degree;
    OutlinePoint chord = {piece[end] - piece[0], piece[end + 1] - piece[1]};
    if (degree == 1) {
        return chord;
    }
    const double u[4] = {piece[0], piece[2], piece[4], piece[6]}, v[4] = {piece[1], piece[3], piece[5], piece[7]};
    OutlinePoint along = {cubic_slope(u, s), cubic_slope(v, s)};
    return along.u == 0.0 && along.v == 0.0 ? chord : along;
}

static double clamped(double s)
{
    return s > 0.0 ? s < 1.0 ? s : 1.0 : 0.0; // NaN: 0
}

// The parameter of the piece's nearest point, where the point lies nearly on it: then a point of the piece that has one
// coordinate with it is near.
static double piece_nearest(const double *piece, unsigned degree, OutlinePoint p)
{
    if (degree == 1) {
        OutlinePoint along = piece_along(piece, degree, 0.0);
        double square = along.u * along.u + along.v * along.v;
        return clamped(((p.u - piece[0]) * along.u + (p.v - piece[1]) * along.v) / square);
    }
    const double u[4] = {piece[0] - p.u, piece[2] - p.u, piece[4] - p.u, piece[6] - p.u};
    const double v[4] = {piece[1] - p.v, piece[3] - p.v, piece[5] - p.v, piece[7] - p.v};
    double candidates[2 + 2 * ROOTS_MOST] = {0.0, 1.0};
    unsigned count = 2;
    count += cubic_roots(u, candidates + count);
    count += cubic_roots(v, candidates + count);
    double s = 0.0, least = (double)INFINITY;
    for (unsigned i = 0; i < count; i++) {
        double from = distance2(piece_at(piece, degree, candidates[i]), p);
        s = from < least ? candidates[i] : s;
        least = from < least ? from : least;
    }
    for (int i = 0; i < NEAREST_STEPS; i++) { // Gauss and Newton
        OutlinePoint at = piece_at(piece, degree, s), along = piece_along(piece, degree, s);
        double square = 3.0 * (along.u * along.u + along.v * along.v);
        double next = clamped(s + ((p.u - at.u) * along.u + (p.v - at.v) * along.v) / square);
        double from = distance2(piece_at(piece, degree, next), p);
        if (!(from < least)) {
            break;
        }
        s = next;
        least = from;
    }
    return s;
}

OutlinePoint outline_nearest(const Numbers *list, OutlinePoint p, OutlinePoint *along)
{
    unsigned degree = outline_degree(list);
    uint32_t pieces = outline_piece_count(list);
    double least = (double)INFINITY;
    OutlinePoint nearest = p;
    *along = (OutlinePoint){1.0, 0.0};
    for (uint32_t i = 0; i < pieces; i++) {
        const double *piece = outline_piece(list, i);
        if (!(piece_distance2(piece, degree, p) < least)) {
            continue;
        }
        double s = piece_nearest(piece, degree, p);
        OutlinePoint at = piece_at(piece, degree, s);
        double from = distance2(at, p);
        if (from < least) {
            least = from;
            nearest = at;
            *along = piece_along(piece, degree, s);
        }
    }
    return nearest;
}

// ---- extent

void outline_bounds(const Numbers *list, OutlinePoint *low, OutlinePoint *high)
{
    *low = (OutlinePoint){(double)INFINITY, (double)INFINITY};
    *high = (OutlinePoint){-(double)INFINITY, -(double)INFINITY};
    for (size_t i = OUTLINE_HEAD; i + 1 < list->count; i += 2) {
        double u = list->items[i], v = list->items[i + 1];
        *low = (OutlinePoint){fmin(low->u, u), fmin(low->v, v)};
        *high = (OutlinePoint){fmax(high->u, u), fmax(high->v, v)};
    }
}

static void extent_take(OutlinePoint p, OutlinePoint *low, OutlinePoint *high)
{
    *low = (OutlinePoint){fmin(low->u, p.u), fmin(low->v, p.v)};
    *high = (OutlinePoint){fmax(high->u, p.u), fmax(high->v, p.v)};
}

void outline_extent(const Numbers *list, OutlinePoint *low, OutlinePoint *high)
{
    unsigned degree = outline_degree(list);
    *low = (OutlinePoint){(double)INFINITY, (double)INFINITY};
    *high = (OutlinePoint){-(double)INFINITY, -(double)INFINITY};
    for (uint32_t i = 0; i < outline_piece_count(list); i++) {
        const double *piece = outline_piece(list, i);
        extent_take(piece_at(piece, degree, 0.0), low, high);
        extent_take((OutlinePoint){piece[2 * degree], piece[2 * degree + 1]}, low, high);
        for (unsigned axis = 0; degree > 1 && axis < 2; axis++) {
            const double f[4] = {piece[axis], piece[2 + axis], piece[4 + axis], piece[6 + axis]};
            double at[2];
            unsigned count = cubic_extrema(f, at);
            for (unsigned k = 0; k < count; k++) {
                extent_take(piece_at(piece, degree, at[k]), low, high);
            }
        }
    }
}

double outline_support(const Numbers *list, OutlinePoint n)
{
    double most = -(double)INFINITY;
    for (size_t i = OUTLINE_HEAD; i + 1 < list->count; i += 2) {
        most = fmax(most, list->items[i] * n.u + list->items[i + 1] * n.v);
    }
    return most;
}
