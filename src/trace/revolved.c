// A line is seen by its distance from y and its height: a hyperbola about its point nearest to y, of which both halves
// are where A = dy w and where A = -dy w. There w² = u² - L, L being the square of the line's least distance from y,
// and A is dy times how far a point of height v is along the line's shadow on y = 0. Along a piece of the curve
//
//     q = dy² (u² - L) - A²
//
// is a polynomial whose sign says whether the piece is between the halves or beyond them. Of each part of a piece the
// Bernstein coefficients of q are made of those of u and v, so that their errors are those of a curve that is off by a
// few u of its size: where their signs change once there is one root, where they do not, there is none. Where the line
// is nearly level both halves are nearly one, and q has two roots that no halving takes apart; there A and dy w are
// compared, of which one grows more than the other all along the part. Else the part is halved, to where all of q is
// below its own rounding. Whether a point is between the halves is known from its own q alone, so that two pieces that
// meet there say the same, and the number of crossings of closed curves is even whatever rounding does.
//
// SPDX-License-Identifier: MIT
#include "trace/revolved.h"

#include "math/extreme.h"
#include "scene/outline.h"
#include "scene/sor.h"
#include "trace/crossings.h"

enum { FORM_MOST = 7, DEPTH_MOST = 60, STEPS_MOST = 100 };

// Of the terms of q, below which it is 0.
static const double FLAT = 0x1p-50;

// Room around bounds: far above what rounding does to the line, which is seen from near 0.
static const double MARGIN = 0x1p-40;

typedef enum ArcKind { ARC_LINE, ARC_CUBIC, ARC_SQUARE } ArcKind;

// A piece of the curve, or a part of one, by Bernstein coefficients. Of ARC_SQUARE u is the radius squared, of degree
// 3, and v is straight.
typedef struct Arc {
    ArcKind kind;
    double u[4], v[4];
} Arc;

typedef struct Turn {
    double t_base;        // of the point that the line is seen from
    double y, dy, across; // its height; the direction's part along y, and the length of what is left
    double along;         // how far it is along the line's shadow from that shadow's point nearest to 0
    double least2;        // L
    double size, pad;     // of the shape; room
    uint8_t side;         // of the piece that is asked
    Crossing *crossings;
    uint32_t count;
} Turn;

// ---- a line

static void turn_set(Turn *turn, const Ray *ray, Vec3 low, Vec3 high, bool is_start)
{
    Vec3 o = ray->origin, d = ray->direction;
    turn->t_base = is_start ? 0.0 : -vec3_dot(o, d) / vec3_length_squared(d);
    o = is_start ? o : vec3_add_scaled(o, turn->t_base, d);
    double across = sqrt(d.x * d.x + d.z * d.z), x = across > 0.0 ? d.x / across : 1.0;
    double z = across > 0.0 ? d.z / across : 0.0, moment = o.x * z - o.z * x;
    turn->y = o.y;
    turn->dy = d.y;
    turn->across = across;
    turn->along = o.x * x + o.z * z;
    turn->least2 = moment * moment;
    turn->size = greater_of(high.x, greater_of(fabs(low.y), fabs(high.y)));
    turn->pad = MARGIN * (turn->size + vec3_max_abs(ray->origin));
    turn->count = 0;
}

// A at a height.
static inline double turn_along(const Turn *turn, double v)
{
    return turn->along * turn->dy + turn->across * (v - turn->y);
}

// Whether the line is nowhere between two radii and two heights.
static bool turn_passes(const Turn *turn, double inner, double outer, double low, double high)
{
    double pad = turn->pad, dy2 = turn->dy * turn->dy, first = turn_along(turn, low - pad);
    double last = turn_along(turn, high + pad), base = dy2 * turn->least2;
    double most = greater_of(fabs(first), fabs(last));
    double least = (first < 0.0) != (last < 0.0) ? 0.0 : less_of(fabs(first), fabs(last));
    inner = inner > pad ? inner - pad : 0.0;
    outer += pad;
    bool is_level = dy2 == 0.0 && (first < 0.0) == (last < 0.0) && turn->across > 0.0;
    return is_level || base + most * most < dy2 * (inner * inner) || base + least * least > dy2 * (outer * outer) ||
           turn->least2 > outer * outer;
}

// The line about the axis; false when it passes the whole shape by.
static bool turn_begin(Turn *turn, const Ray *ray, Vec3 low, Vec3 high, SideLeft left)
{
    turn_set(turn, ray, low, high, left.side != SIDE_NONE);
    return !turn_passes(turn, 0.0, high.x, low.y, high.y);
}

// ---- a part of a piece

// The value of a cubic, and how it changes.
static inline double cubic_at(const double f[4], double s, double *slope)
{
    double a = f[0] + s * (f[1] - f[0]), b = f[1] + s * (f[2] - f[1]), c = f[2] + s * (f[3] - f[2]);
    double first = a + s * (b - a), last = b + s * (c - b);
    *slope = 3.0 * (last - first);
    return first + s * (last - first);
}

static inline double line_at(const double f[2], double s, double *slope)
{
    *slope = f[1] - f[0];
    return f[0] + s * *slope;
}

// A point of a part: the square of its radius, its height, and how half of the square and the height change.
typedef struct ArcPoint {
    double square, v, rise, climb;
} ArcPoint;

static ArcPoint arc_at(const Arc *arc, double s)
{
    ArcPoint p;
    double slope, u = arc->kind == ARC_LINE ? line_at(arc->u, s, &slope) : cubic_at(arc->u, s, &slope);
    p.v = arc->kind == ARC_CUBIC ? cubic_at(arc->v, s, &p.climb) : line_at(arc->v, s, &p.climb);
    p.square = arc->kind == ARC_SQUARE ? u : u * u;
    p.rise = arc->kind == ARC_SQUARE ? 0.5 * slope : u * slope;
    return p;
}

static void halve(const double f[4], unsigned degree, double first[4], double last[4])
{
    if (degree == 1) {
        double middle = 0.5 * (f[0] + f[1]);
        first[0] = f[0];
        first[1] = last[0] = middle;
        last[1] = f[1];
        return;
    }
    double a = 0.5 * (f[0] + f[1]), b = 0.5 * (f[1] + f[2]), c = 0.5 * (f[2] + f[3]);
    first[0] = f[0];
    first[1] = a;
    first[2] = 0.5 * (a + b);
    last[2] = c;
    last[1] = 0.5 * (b + c);
    last[3] = f[3];
    first[3] = last[0] = 0.5 * (first[2] + last[1]);
}

static void arc_halve(const Arc *arc, Arc *first, Arc *last)
{
    first->kind = last->kind = arc->kind;
    halve(arc->u, arc->kind == ARC_LINE ? 1 : 3, first->u, last->u);
    halve(arc->v, arc->kind == ARC_CUBIC ? 3 : 1, first->v, last->v);
}

static void square_of_cubic(const double p[4], double square[FORM_MOST])
{
    square[0] = p[0] * p[0];
    square[1] = p[0] * p[1];
    square[2] = 0.2 * (3.0 * p[1] * p[1] + 2.0 * p[0] * p[2]);
    square[3] = 0.1 * (9.0 * p[1] * p[2] + p[0] * p[3]);
    square[4] = 0.2 * (3.0 * p[2] * p[2] + 2.0 * p[1] * p[3]);
    square[5] = p[2] * p[3];
    square[6] = p[3] * p[3];
}

static void square_of_line(const double p[4], double square[FORM_MOST])
{
    square[0] = p[0] * p[0];
    square[1] = p[0] * p[1];
    square[2] = p[1] * p[1];
}

// The coefficients of q, how many there are, and the greatest of its terms. `a` is room for those of A.
static unsigned arc_form(const Turn *turn, const Arc *arc, double a[4], double q[FORM_MOST], double *most)
{
    double squares[FORM_MOST], along[FORM_MOST], dy2 = turn->dy * turn->dy, greatest = 0.0;
    unsigned count = arc->kind == ARC_LINE ? 3 : arc->kind == ARC_CUBIC ? 7 : 4;
    for (unsigned i = 0; i < (arc->kind == ARC_CUBIC ? 4u : 2u); i++) {
        a[i] = turn_along(turn, arc->v[i]);
    }
    if (arc->kind == ARC_CUBIC) {
        square_of_cubic(arc->u, squares);
        square_of_cubic(a, along);
    } else if (arc->kind == ARC_LINE) {
        square_of_line(arc->u, squares);
        square_of_line(a, along);
    } else {
        for (unsigned i = 0; i < 4; i++) {
            squares[i] = arc->u[i];
        }
        along[0] = a[0] * a[0];
        along[3] = a[1] * a[1];
        along[1] = (along[0] + 2.0 * a[0] * a[1]) / 3.0;
        along[2] = (along[3] + 2.0 * a[0] * a[1]) / 3.0;
    }
    for (unsigned i = 0; i < count; i++) {
        q[i] = dy2 * (squares[i] - turn->least2) - along[i];
        greatest = greater_of(greatest, dy2 * fabs(squares[i]) + fabs(along[i]));
    }
    *most = greatest + dy2 * turn->least2;
    return count;
}

// ---- where a point is beside the two halves of the line

typedef struct Place {
    bool is_above_plus, is_above_minus; // of A = |dy| w, and of A = -|dy| w
    bool is_near;                       // it is no farther from y than the line is: then both are A >= 0
} Place;

static Place place_of(const Turn *turn, double square, double a, double q)
{
    bool is_between = q > 0.0;
    return (Place){!is_between && a >= 0.0, is_between || a >= 0.0, square <= turn->least2};
}

// ---- roots

typedef enum Half { HALF_EITHER, HALF_PLUS, HALF_MINUS } Half; // q, A - |dy| w, A + |dy| w

static double value_at(const Turn *turn, const Arc *arc, Half half, double s, double *slope)
{
    ArcPoint p = arc_at(arc, s);
    double a = turn_along(turn, p.v), dy2 = turn->dy * turn->dy;
    if (half == HALF_EITHER) {
        *slope = 2.0 * (dy2 * p.rise - turn->across * p.climb * a);
        return dy2 * (p.square - turn->least2) - a * a;
    }
    double w = sqrt(greater_of(p.square - turn->least2, 0.0));
    double dy = half == HALF_PLUS ? fabs(turn->dy) : -fabs(turn->dy);
    *slope = turn->across * p.climb - dy * p.rise / w;
    return a - dy * w;
}

// Between 0 and 1, where the signs differ, from `s` on; `is_low_below`: it is below 0, or for q not above it, at 0. A step
// of 2^-44 leaves what rounding of the values does, which no more steps make less: signs that go by that would only have
// the part halved down to there once more.
static double root_between(const Turn *turn, const Arc *arc, Half half, bool is_low_below, double s)
{
    double low = 0.0, high = 1.0, before = 1.0;
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double slope, value = value_at(turn, arc, half, s, &slope), next = s - value / slope, change = fabs(next - s);
        bool is_below = half == HALF_EITHER ? value <= 0.0 : value < 0.0;
        *(is_below == is_low_below ? &low : &high) = s;
        if (value == 0.0 || change <= 0x1p-44 * s) {
            return next > low && next < high ? next : s;
        }
        bool is_slow = !(next > low && next < high) || !(2.0 * change < before);
        before = is_slow ? high - low : change;
        s = is_slow ? 0.5 * (low + high) : next;
    }
    return s;
}

// Where the line is at a point of the curve: by its height, or by how far it is from y, as is less uncertain.
static void cross_at(Turn *turn, const Arc *arc, double s, Half half)
{
    ArcPoint p = arc_at(arc, s);
    double dy = turn->dy, w = sqrt(greater_of(p.square - turn->least2, 0.0)), a = turn_along(turn, p.v);
    bool is_plus = half == HALF_EITHER ? a >= 0.0 : half == HALF_PLUS;
    double size =
        arc->kind == ARC_SQUARE ? turn->size : sqrt(p.square); // what w is uncertain by, times w / size of the shape
    bool by_radius = fabs(dy) * size < w * turn->across;
    double shadow = is_plus != (dy < 0.0) ? w : -w;
    double t = by_radius ? (shadow - turn->along) / turn->across : (p.v - turn->y) / dy;
    turn->crossings[turn->count++] = (Crossing){turn->t_base + t, turn->side};
}

static void span_of(const double *p, unsigned count, double *least, double *most)
{
    *least = *most = p[0];
    for (unsigned i = 1; i < count; i++) {
        *least = less_of(*least, p[i]);
        *most = greater_of(*most, p[i]);
    }
}

// Whether, all along a part, A grows more than dy w does, or the other way round.
static bool is_ordered(const Turn *turn, const Arc *arc)
{
    unsigned u_count = arc->kind == ARC_LINE ? 2 : 4, v_count = arc->kind == ARC_CUBIC ? 4 : 2;
    double low, high, steps[3], u_step[2], v_step[2], rise[2];
    span_of(arc->u, u_count, &low, &high);
    if (arc->kind != ARC_SQUARE && low < 0.0) {
        double least = high < 0.0 ? -high : 0.0;
        high = greater_of(-low, high);
        low = least;
    }
    bool is_square = arc->kind == ARC_SQUARE;
    double inner2 = (is_square ? low : low * low) - turn->least2,
           outer2 = (is_square ? high : high * high) - turn->least2;
    if (!(inner2 > 0.0)) {
        return false;
    }
    for (unsigned i = 0; i + 1 < u_count; i++) {
        steps[i] = arc->u[i + 1] - arc->u[i];
    }
    span_of(steps, u_count - 1, &u_step[0], &u_step[1]);
    for (unsigned i = 0; i + 1 < v_count; i++) {
        steps[i] = arc->v[i + 1] - arc->v[i];
    }
    span_of(steps, v_count - 1, &v_step[0], &v_step[1]);
    double u_degree = u_count - 1.0, v_degree = v_count - 1.0, scale = u_degree * (is_square ? 0.5 : 1.0);
    rise[0] = scale * greater_of(fabs(u_step[0]), fabs(u_step[1])) * (is_square ? 1.0 : high); // u u', most and least
    rise[1] = u_step[0] > 0.0 || u_step[1] < 0.0
                  ? scale * less_of(fabs(u_step[0]), fabs(u_step[1])) * (is_square ? 1.0 : low)
                  : 0.0;
    double climb_most = v_degree * greater_of(fabs(v_step[0]), fabs(v_step[1])) * turn->across;
    double climb_least =
        v_step[0] > 0.0 || v_step[1] < 0.0 ? v_degree * less_of(fabs(v_step[0]), fabs(v_step[1])) * turn->across : 0.0;
    double dy = fabs(turn->dy);
    return climb_least * sqrt(inner2) > dy * rise[0] || dy * rise[1] > climb_most * sqrt(outer2);
}

static void take_ends(Turn *turn, const Arc *arc, Place first, Place last)
{
    bool plus = first.is_above_plus != last.is_above_plus, minus = first.is_above_minus != last.is_above_minus;
    if (plus && minus && (first.is_near || last.is_near)) {
        return;
    }
    if (plus) {
        cross_at(turn, arc, 0.5, HALF_PLUS);
    }
    if (minus) {
        cross_at(turn, arc, 0.5, HALF_MINUS);
    }
}

// Of a level line, which q does not tell from a curve that only comes to its height: whether a part may come through
// it.
static bool passes_height(const Arc *arc, const double a[4])
{
    bool passes = false;
    for (unsigned i = 1; i < (arc->kind == ARC_CUBIC ? 4u : 2u); i++) {
        passes = passes || (a[i] >= 0.0) != (a[0] >= 0.0);
    }
    return passes;
}

// Whether all of a part is nearer to y than the line is.
static bool is_nearer(const Turn *turn, const Arc *arc)
{
    double low, high;
    span_of(arc->u, arc->kind == ARC_LINE ? 2 : 4, &low, &high);
    double most = greater_of(fabs(low), fabs(high));
    return (arc->kind == ARC_SQUARE ? high : most * most) <= turn->least2;
}

static void arc_cross(Turn *turn, const Arc *arc, unsigned depth)
{
    double a[4], q[FORM_MOST], most, greatest = 0.0;
    unsigned count = arc_form(turn, arc, a, q, &most), changes = 0, last_change = 0;
    for (unsigned i = 0; i + 1 < count; i++) {
        bool is_change = (q[i] > 0.0) != (q[i + 1] > 0.0);
        changes += is_change;
        last_change = is_change ? i : last_change;
        greatest = greater_of(greatest, fabs(q[i]));
    }
    greatest = greater_of(greatest, fabs(q[count - 1]));
    bool is_level = turn->dy * turn->dy == 0.0;
    if (changes == 0 && (!is_level || !passes_height(arc, a))) {
        return;
    }
    if (is_level && is_nearer(turn, arc)) {
        return;
    }
    if (changes == 1) {
        double step = 1.0 / (count - 1.0), from = q[last_change], part = from / (from - q[last_change + 1]);
        double start = (last_change + part) * step; // where the coefficients' own line is 0
        cross_at(turn, arc, root_between(turn, arc, HALF_EITHER, !(q[0] > 0.0), start), HALF_EITHER);
        return;
    }
    bool is_last = depth == DEPTH_MOST || greatest <= FLAT * most, is_apart = is_ordered(turn, arc);
    if (is_last || is_apart) {
        unsigned u_last = arc->kind == ARC_LINE ? 1 : 3, v_last = arc->kind == ARC_CUBIC ? 3 : 1;
        bool is_square = arc->kind == ARC_SQUARE;
        double square = is_square ? arc->u[0] : arc->u[0] * arc->u[0];
        double last_square = is_square ? arc->u[3] : arc->u[u_last] * arc->u[u_last];
        Place first = place_of(turn, square, a[0], q[0]), last = place_of(turn, last_square, a[v_last], q[count - 1]);
        if (!is_apart) {
            take_ends(turn, arc, first, last);
            return;
        }
        if (first.is_above_plus != last.is_above_plus) {
            cross_at(turn, arc, root_between(turn, arc, HALF_PLUS, !first.is_above_plus, 0.5), HALF_PLUS);
        }
        if (first.is_above_minus != last.is_above_minus) {
            cross_at(turn, arc, root_between(turn, arc, HALF_MINUS, !first.is_above_minus, 0.5), HALF_MINUS);
        }
        return;
    }
    Arc first, last;
    arc_halve(arc, &first, &last);
    arc_cross(turn, &first, depth + 1);
    arc_cross(turn, &last, depth + 1);
}

// ---- lathes

// Whether a box of control points is passed.
static bool passes_box(const Turn *turn, const double *box)
{
    double low = box[PIECE_LOW], high = box[PIECE_HIGH];
    double inner = low > 0.0 ? low : high < 0.0 ? -high : 0.0, outer = greater_of(fabs(low), fabs(high));
    return turn_passes(turn, inner, outer, box[PIECE_LOW + 1], box[PIECE_HIGH + 1]);
}

static void arc_of(const double *piece, unsigned degree, Arc *arc)
{
    const double *p = piece + PIECE_POINTS;
    bool is_straight = piece[PIECE_DEGREE] <= 1.0;
    arc->kind = is_straight ? ARC_LINE : ARC_CUBIC;
    for (unsigned i = 0; i < (is_straight ? 2u : 4u); i++) {
        unsigned at = is_straight ? 2 * degree * i : 2 * i;
        arc->u[i] = p[at];
        arc->v[i] = p[at + 1];
    }
}

unsigned lathe_intervals(const Numbers *outline, Vec3 low, Vec3 high, const Ray *ray, SideLeft left,
                         RayInterval *intervals)
{
    Turn turn;
    if (!turn_begin(&turn, ray, low, high, left)) {
        return 0;
    }
    Crossing crossings[lathe_crossings_most(outline)];
    unsigned degree = outline_degree(outline);
    uint32_t stride = outline_stride(outline), pieces = outline_piece_count(outline);
    turn.crossings = crossings;
    for (uint32_t i = 0; i < pieces; i++) {
        const double *piece = outline_place(outline, stride, i);
        if (i % OUTLINE_GROUP == 0 && passes_box(&turn, piece - OUTLINE_BOX)) {
            i += OUTLINE_GROUP - 1;
            continue;
        }
        if (!passes_box(&turn, piece)) {
            Arc arc;
            arc_of(piece, degree, &arc);
            turn.side = piece[PIECE_DEGREE] == 0.0 ? REVOLVED_LOW : REVOLVED_CURVE;
            arc_cross(&turn, &arc, 0);
        }
    }
    return crossings_intervals(turn.crossings, turn.count, left, intervals);
}

// The nearest point of the curve in the plane of a point, and a vector along it.
static OutlinePoint lathe_nearest(const Numbers *outline, double radius, double y, OutlinePoint *along, double *place)
{
    double other_place = 0.0;
    OutlinePoint other_along, at = outline_nearest(outline, (OutlinePoint){radius, y}, along, place);
    if (outline->items[OUTLINE_MIRRORED] == 0.0) {
        return at;
    }
    OutlinePoint other = outline_nearest(outline, (OutlinePoint){-radius, y}, &other_along, &other_place);
    if (hypot(other.u + radius, other.v - y) < hypot(at.u - radius, at.v - y)) {
        *along = (OutlinePoint){-other_along.u, other_along.v};
        at = (OutlinePoint){-other.u, other.v};
        if (place) {
            *place = other_place;
        }
    }
    return at;
}

Vec3 lathe_gradient(const Numbers *outline, Vec3 point, uint8_t side)
{
    OutlinePoint along;
    double radius = hypot(point.x, point.z);
    (void)side;
    lathe_nearest(outline, radius, point.y, &along, NULL);
    if (!(radius > 0.0)) {
        return along.u != 0.0 ? vec3(0.0, -along.u, 0.0) : vec3(0.0, 1.0, 0.0);
    }
    return vec3(along.v * (point.x / radius), -along.u, along.v * (point.z / radius));
}

Vec3 lathe_point(const Numbers *outline, Vec3 point, uint8_t side)
{
    OutlinePoint along;
    double radius = hypot(point.x, point.z);
    if (side != REVOLVED_CURVE) {
        return point;
    }
    OutlinePoint at = lathe_nearest(outline, radius, point.y, &along, NULL);
    double factor = radius > 0.0 ? at.u / radius : 0.0;
    return vec3(factor * point.x, at.v, factor * point.z);
}

// A piece of the curve is as much of the way as any other. Measured.
double lathe_along(const Numbers *outline, Vec3 point)
{
    OutlinePoint along;
    double place;
    lathe_nearest(outline, hypot(point.x, point.z), point.y, &along, &place);
    return place / outline_seen_count(outline);
}

// ---- surfaces of revolution

// The disc at an end is crossed where the line is within its edge, which q says.
static void cross_end(Turn *turn, double square, double y, uint8_t side)
{
    double a = turn_along(turn, y), q = turn->dy * turn->dy * (square - turn->least2) - a * a;
    if (q > 0.0) {
        turn->crossings[turn->count++] = (Crossing){turn->t_base + (y - turn->y) / turn->dy, side};
    }
}

// Between which heights the line is near enough.
static void turn_heights(const Turn *turn, double radius, double *low, double *high)
{
    *low = -(double)INFINITY;
    *high = (double)INFINITY;
    if (turn->across > fabs(turn->dy)) {
        double slope = turn->dy / turn->across, reach = radius + turn->pad, rest = fabs(slope) * turn->pad + turn->pad;
        double first = turn->y + (-reach - turn->along) * slope, last = turn->y + (reach - turn->along) * slope;
        *low = less_of(first, last) - rest;
        *high = greater_of(first, last) + rest;
    }
}

unsigned sor_intervals(const Numbers *list, Vec3 low, Vec3 high, const Ray *ray, SideLeft left, RayInterval *intervals)
{
    Turn turn;
    if (!turn_begin(&turn, ray, low, high, left)) {
        return 0;
    }
    Crossing crossings[sor_crossings_most(list)];
    uint32_t count = sor_stretch_count(list);
    double from, to;
    turn.crossings = crossings;
    turn_heights(&turn, high.x, &from, &to);
    cross_end(&turn, sor_squares(list, 0)[0], low.y, REVOLVED_LOW);
    turn.side = REVOLVED_CURVE;
    for (uint32_t i = sor_stretch_of(list, from); i < count && sor_height(list, i) <= to; i++) {
        const double *f = sor_squares(list, i);
        double outer2 = greater_of(greater_of(f[0], f[1]), greater_of(f[2], f[3]));
        double bottom = sor_height(list, i), top = sor_height(list, i + 1);
        if (outer2 > 0.0 && !turn_passes(&turn, 0.0, sqrt(outer2), bottom, top)) {
            Arc arc = {ARC_SQUARE, {f[0], f[1], f[2], f[3]}, {bottom, top}};
            arc_cross(&turn, &arc, 0);
        }
    }
    cross_end(&turn, sor_squares(list, count - 1)[3], high.y, REVOLVED_HIGH);
    return crossings_intervals(turn.crossings, turn.count, left, intervals);
}

Vec3 sor_gradient(const Numbers *list, Vec3 point, uint8_t side)
{
    double slope;
    if (side != REVOLVED_CURVE) {
        return vec3(0.0, side == REVOLVED_LOW ? -1.0 : 1.0, 0.0);
    }
    sor_square(list, sor_stretch_of(list, point.y), point.y, &slope);
    bool is_flat = point.x == 0.0 && point.z == 0.0 && slope == 0.0;
    return vec3(2.0 * point.x, is_flat ? 1.0 : -slope, 2.0 * point.z);
}

Vec3 sor_point(const Numbers *list, Vec3 point, uint8_t side)
{
    double slope;
    uint32_t count = sor_stretch_count(list);
    if (side != REVOLVED_CURVE) {
        return vec3(point.x, sor_height(list, side == REVOLVED_LOW ? 0 : count), point.z);
    }
    double square = sor_square(list, sor_stretch_of(list, point.y), point.y, &slope);
    double off = (point.x * point.x + point.z * point.z) - square;
    Vec3 n = vec3(2.0 * point.x, -slope, 2.0 * point.z);
    double length2 = vec3_length_squared(n);
    return length2 > 0.0 ? vec3_add_scaled(point, -off / length2, n) : point;
}

// So is a stretch; the ends have discs of their own, which begin in the middle of the lower one and end in that of the
// upper one. Measured.
double sor_along(const Numbers *list, Vec3 point, uint8_t side)
{
    uint32_t count = sor_stretch_count(list), i = sor_stretch_of(list, point.y);
    double radius = hypot(point.x, point.z), edge = sor_squares(list, 0)[0];
    if (side == REVOLVED_LOW) {
        return edge > 0.0 ? radius / sqrt(edge) : 0.0;
    }
    edge = sor_squares(list, count - 1)[3];
    if (side == REVOLVED_HIGH) {
        return edge > 0.0 ? 1.0 - radius / sqrt(edge) : 1.0;
    }
    double from = sor_height(list, i), to = sor_height(list, i + 1);
    return (i + (point.y - from) / (to - from)) / count;
}
