// A piece is tested by the values that the line's form has at its control points, which are the Bernstein coefficients
// of the form along it: where all have one sign there is no root; else the piece is cut where the form has its extrema,
// and each part on which it changes its sign has one root. Signs at the ends of pieces decide how many there are, so
// that the number is even whatever rounding does in between.
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

// The root between two places where the signs differ, from `s` on; at the first of them it is `at_low`. A step of 2^-44
// leaves what rounding of the values does.
static double cubic_root(const double f[4], double low, double high, double at_low, double s)
{
    bool is_low_below = at_low < 0.0;
    s = s > low && s < high ? s : 0.5 * (low + high);
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double value = cubic_at(f, s), next = s - value / (3.0 * cubic_slope(f, s));
        *((value < 0.0) == is_low_below ? &low : &high) = s;
        if (value == 0.0 || fabs(next - s) <= 0x1p-44 * s) {
            return next > low && next < high ? next : s;
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
    bool is_steady = (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0);
    if (is_steady || !(discriminant > 0.0)) {
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

// Where the coefficients' own line is first 0, of those that change their sign.
static double polygon_root(const double f[4])
{
    bool is_below = f[0] < 0.0;
    unsigned i = (f[1] < 0.0) != is_below ? 0 : (f[2] < 0.0) != is_below ? 1 : 2;
    return (i + f[i] / (f[i] - f[i + 1])) / 3.0;
}

static unsigned cubic_roots(const double f[4], double roots[ROOTS_MOST])
{
    bool is_below = f[0] < 0.0;
    if ((f[1] < 0.0) == is_below && (f[2] < 0.0) == is_below && (f[3] < 0.0) == is_below) {
        return 0;
    }
    double ends[4], from = 0.0, at_from = f[0];
    unsigned extrema = cubic_extrema(f, ends), count = 0;
    ends[extrema] = 1.0;
    if (extrema == 0 && (f[0] < 0.0) != (f[3] < 0.0)) {
        roots[0] = cubic_root(f, 0.0, 1.0, f[0], polygon_root(f));
        return 1;
    }
    for (unsigned i = 0; i <= extrema; i++) {
        double at_end = i == extrema ? f[3] : cubic_at(f, ends[i]);
        if ((at_from < 0.0) != (at_end < 0.0)) {
            double start = from + (ends[i] - from) * (at_from / (at_from - at_end));
            roots[count++] = cubic_root(f, from, ends[i], at_from, start);
        }
        at_from = at_end;
        from = ends[i];
    }
    return count;
}

// ---- pieces

// As the list has it.
typedef struct Piece {
    const double *box, *points, *end;
    bool is_straight;
} Piece;

static inline Piece piece_of(const Numbers *list, uint32_t stride, uint32_t i)
{
    const double *at = outline_place(list, stride, i);
    return (Piece){at, at + PIECE_POINTS, at + stride - 2, at[PIECE_DEGREE] <= 1.0};
}

// Whether piece i is the first of a group that, by its box, is passed over with all that follow in it.
typedef bool (*BoxTest)(const double *box, const void *asked);
static inline bool skips_group(const Numbers *list, uint32_t stride, uint32_t *i, BoxTest is_out, const void *asked)
{
    if (*i % OUTLINE_GROUP != 0 || !is_out(outline_place(list, stride, *i) - OUTLINE_BOX, asked)) {
        return false;
    }
    *i += OUTLINE_GROUP - 1;
    return true;
}

static OutlinePoint piece_at(const Piece *piece, double s)
{
    const double *p = piece->points, *end = piece->end;
    if (piece->is_straight) {
        return (OutlinePoint){p[0] + s * (end[0] - p[0]), p[1] + s * (end[1] - p[1])};
    }
    const double u[4] = {p[0], p[2], p[4], p[6]}, v[4] = {p[1], p[3], p[5], p[7]};
    return (OutlinePoint){cubic_at(u, s), cubic_at(v, s)};
}

static unsigned piece_cross(const Piece *piece, double a, double b, double c, double roots[ROOTS_MOST])
{
    const double *p = piece->points, *end = piece->end;
    double first = a * p[0] + c * p[1] + b, last = a * end[0] + c * end[1] + b;
    if (!piece->is_straight) {
        const double f[4] = {first, a * p[2] + c * p[3] + b, a * p[4] + c * p[5] + b, last};
        return cubic_roots(f, roots);
    }
    if ((first < 0.0) == (last < 0.0)) {
        return 0;
    }
    roots[0] = first / (first - last);
    return 1;
}

static inline bool is_beside_line(const double *box, const void *asked)
{
    const OutlineLine *line = asked;
    const double *low = box + PIECE_LOW, *high = box + PIECE_HIGH;
    return low[0] > line->high.u || high[0] < line->low.u || low[1] > line->high.v || high[1] < line->low.v;
}

// Whether the line's form has one sign at all control points of some pieces, however it is rounded there.
static bool is_apart_from_line(const double *box, const void *asked)
{
    const OutlineLine *line = asked;
    const double *low = box + PIECE_LOW, *high = box + PIECE_HIGH;
    double a = fabs(line->a), c = fabs(line->c);
    double twice = line->a * (low[0] + high[0]) + line->c * (low[1] + high[1]) + 2.0 * line->b;
    double reach = a * (high[0] - low[0]) + c * (high[1] - low[1]);
    double size = a * (fabs(low[0]) + fabs(high[0])) + c * (fabs(low[1]) + fabs(high[1])) + 2.0 * fabs(line->b);
    return fabs(twice) > reach + 0x1p-46 * size;
}

// Whether the line passes an end of the piece so near that rounding decides on which side.
static bool passes_end(const Piece *piece, const OutlineLine *line)
{
    const double *ends[2] = {piece->points, piece->end};
    bool passes = false;
    for (int i = 0; i < 2; i++) {
        double u = line->a * ends[i][0], v = line->c * ends[i][1];
        passes = passes || fabs(u + v + line->b) <= 0x1p-46 * (fabs(u) + fabs(v) + fabs(line->b));
    }
    return passes;
}

uint32_t outline_cross(const Numbers *list, const OutlineLine *line, OutlinePoint *points, OutlineAnswer *answer)
{
    uint32_t stride = outline_stride(list), pieces = outline_piece_count(list), count = 0;
    OutlineAnswer found_so_far = OUTLINE_FAR;
    BoxTest is_out = answer ? is_beside_line : is_apart_from_line; // a whole line is beside nothing
    for (uint32_t i = 0; i < pieces; i++) {
        if (skips_group(list, stride, &i, is_out, line)) {
            continue;
        }
        if (is_beside_line(outline_place(list, stride, i), line)) {
            continue;
        }
        Piece piece = piece_of(list, stride, i);
        double roots[ROOTS_MOST];
        if (answer && found_so_far != OUTLINE_DOUBTFUL) {
            found_so_far = passes_end(&piece, line) ? OUTLINE_DOUBTFUL : OUTLINE_NEAR;
        }
        unsigned found = piece_cross(&piece, line->a, line->b, line->c, roots);
        for (unsigned k = 0; k < found; k++) {
            points[count++] = piece_at(&piece, roots[k]);
        }
    }
    if (answer) {
        *answer = found_so_far;
    }
    return count;
}

// Whether no sign changes in the box along the line, or nothing of it is to the right of the point.
static inline bool is_beside_point(const double *box, const void *asked)
{
    const OutlinePoint *p = asked;
    return p->v > box[PIECE_HIGH + 1] || p->v <= box[PIECE_LOW + 1] || p->u >= box[PIECE_HIGH];
}

// By the line along u, of which what is to the right of the point counts.
bool outline_holds(const Numbers *list, OutlinePoint p)
{
    uint32_t stride = outline_stride(list), pieces = outline_piece_count(list);
    bool is_inside = false;
    for (uint32_t i = 0; i < pieces; i++) {
        if (skips_group(list, stride, &i, is_beside_point, &p)) {
            continue;
        }
        if (is_beside_point(outline_place(list, stride, i), &p)) {
            continue;
        }
        Piece piece = piece_of(list, stride, i);
        if (p.u < piece.box[PIECE_LOW]) {
            is_inside = is_inside != ((piece.points[1] < p.v) != (piece.end[1] < p.v));
            continue;
        }
        double roots[ROOTS_MOST];
        unsigned found = piece_cross(&piece, 0.0, -p.v, 1.0, roots);
        for (unsigned k = 0; k < found; k++) {
            is_inside = is_inside != (piece_at(&piece, roots[k]).u > p.u);
        }
    }
    return is_inside;
}

// Each curve is crossed an even number of times, so that what is to the left of -radius is odd where what is to the
// right of it is.
bool outline_holds_turned(const Numbers *list, double radius, double y)
{
    bool is_mirrored = list->items[OUTLINE_MIRRORED] != 0.0;
    return outline_holds(list, (OutlinePoint){radius, y}) !=
           (is_mirrored && outline_holds(list, (OutlinePoint){-radius, y}));
}

// ---- making one

void outline_begin(double *items, size_t *count, unsigned degree, bool is_conic)
{
    items[OUTLINE_DEGREE] = degree;
    items[OUTLINE_CONIC] = is_conic ? 1.0 : 0.0;
    *count = OUTLINE_HEAD;
}

static double third(double from, double to)
{
    return from + (to - from) / 3.0;
}

bool outline_is_straight(const double p[8])
{
    return p[2] == third(p[0], p[6]) && p[3] == third(p[1], p[7]) && p[4] == third(p[6], p[0]) &&
           p[5] == third(p[7], p[1]);
}

void outline_straighten(double p[8])
{
    p[2] = third(p[0], p[6]);
    p[3] = third(p[1], p[7]);
    p[4] = third(p[6], p[0]);
    p[5] = third(p[7], p[1]);
}

void outline_add(double *items, size_t *count, const double *points)
{
    unsigned degree = items[OUTLINE_DEGREE] > 1.0 ? 3 : 1;
    size_t stride = PIECE_POINTS + 2 * (degree + 1), group = OUTLINE_BOX + OUTLINE_GROUP * stride;
    size_t within = (*count - OUTLINE_HEAD) % group;
    double *box = items + *count - within;
    *count += within == 0 ? OUTLINE_BOX : 0;
    double *piece = items + *count;
    bool is_straight = degree == 1 || outline_is_straight(points);
    piece[PIECE_DEGREE] = is_straight ? 1.0 : degree;
    for (unsigned axis = 0; axis < 2; axis++) {
        piece[PIECE_LOW + axis] = piece[PIECE_HIGH + axis] = points[axis];
        box[PIECE_LOW + axis] = within == 0 ? points[axis] : box[PIECE_LOW + axis];
        box[PIECE_HIGH + axis] = within == 0 ? points[axis] : box[PIECE_HIGH + axis];
    }
    for (unsigned i = 0; i < 2 * (degree + 1); i++) {
        unsigned low = PIECE_LOW + (i & 1), high = PIECE_HIGH + (i & 1);
        piece[PIECE_POINTS + i] = points[i];
        piece[low] = fmin(piece[low], points[i]);
        piece[high] = fmax(piece[high], points[i]);
        box[low] = fmin(box[low], points[i]);
        box[high] = fmax(box[high], points[i]);
    }
    *count += stride;
}

void outline_add_unseen(double *items, size_t *count, OutlinePoint from, OutlinePoint to)
{
    bool is_curved = items[OUTLINE_DEGREE] > 1.0;
    double points[8] = {from.u, from.v};
    points[is_curved ? 6 : 2] = to.u;
    points[is_curved ? 7 : 3] = to.v;
    if (is_curved) {
        outline_straighten(points);
    }
    outline_add(items, count, points);
    items[*count - (PIECE_POINTS + (is_curved ? 8u : 4u)) + PIECE_DEGREE] = 0.0;
}

// ---- the nearest point

static double distance2(OutlinePoint a, OutlinePoint b)
{
    double u = a.u - b.u, v = a.v - b.v;
    return u * u + v * v;
}

// A point and what is about it.
typedef struct Place {
    OutlinePoint p;
    double room;
} Place;

static inline bool is_beside_place(const double *box, const void *asked)
{
    const Place *place = asked;
    OutlinePoint p = place->p;
    double room = place->room;
    const double *low = box + PIECE_LOW, *high = box + PIECE_HIGH;
    return low[0] > p.u + room || high[0] < p.u - room || low[1] > p.v + room || high[1] < p.v - room;
}

static OutlinePoint piece_along(const Piece *piece, double s)
{
    const double *p = piece->points, *end = piece->end;
    OutlinePoint chord = {end[0] - p[0], end[1] - p[1]};
    if (piece->is_straight) {
        return chord;
    }
    const double u[4] = {p[0], p[2], p[4], p[6]}, v[4] = {p[1], p[3], p[5], p[7]};
    OutlinePoint along = {cubic_slope(u, s), cubic_slope(v, s)};
    return along.u == 0.0 && along.v == 0.0 ? chord : along;
}

static double clamped(double s)
{
    return s > 0.0 ? s < 1.0 ? s : 1.0 : 0.0; // NaN: 0
}

// The one of some places on a piece that is nearest to a point, if it is nearer than `s` is.
static void nearest_of(const Piece *piece, OutlinePoint p, const double *places, unsigned count, double *s,
                       double *least)
{
    for (unsigned i = 0; i < count; i++) {
        double from = distance2(piece_at(piece, places[i]), p);
        *s = from < *least ? places[i] : *s;
        *least = from < *least ? from : *least;
    }
}

// The parameter of the nearest point of a curved piece, where the point lies nearly on it: then a point of the piece
// that has one coordinate with it is near. That along which the piece is longer goes first, and alone where what it
// finds is as near as rounding.
static double curve_nearest(const Piece *piece, OutlinePoint p)
{
    const double *q = piece->points, *box = piece->box;
    const double u[4] = {q[0] - p.u, q[2] - p.u, q[4] - p.u, q[6] - p.u};
    const double v[4] = {q[1] - p.v, q[3] - p.v, q[5] - p.v, q[7] - p.v};
    const double ends[2] = {0.0, 1.0};
    double width = box[PIECE_HIGH] - box[PIECE_LOW], height = box[PIECE_HIGH + 1] - box[PIECE_LOW + 1];
    double size = fmax(width, height), near = 0x1p-40 * size, rounding = 0x1p-48 * size;
    double roots[ROOTS_MOST], s = 0.0, least = (double)INFINITY;
    bool is_wide = width >= height;
    nearest_of(piece, p, roots, cubic_roots(is_wide ? u : v, roots), &s, &least);
    if (!(least <= near * near)) {
        nearest_of(piece, p, ends, 2, &s, &least);
        nearest_of(piece, p, roots, cubic_roots(is_wide ? v : u, roots), &s, &least);
    }
    for (int i = 0; i < NEAREST_STEPS && !(least <= rounding * rounding); i++) { // Gauss and Newton
        OutlinePoint at = piece_at(piece, s), along = piece_along(piece, s);
        double square = 3.0 * (along.u * along.u + along.v * along.v);
        double next = clamped(s + ((p.u - at.u) * along.u + (p.v - at.v) * along.v) / square);
        double from = distance2(piece_at(piece, next), p);
        if (!(from < least)) {
            break;
        }
        s = next;
        least = from;
    }
    return s;
}

static double piece_nearest(const Piece *piece, OutlinePoint p)
{
    if (!piece->is_straight) {
        return curve_nearest(piece, p);
    }
    OutlinePoint along = piece_along(piece, 0.0);
    double square = along.u * along.u + along.v * along.v;
    return clamped(((p.u - piece->points[0]) * along.u + (p.v - piece->points[1]) * along.v) / square);
}

// How many of the first pieces are seen.
static uint32_t seen_before(const Numbers *list, uint32_t end)
{
    uint32_t stride = outline_stride(list), seen = 0;
    for (uint32_t i = 0; i < end; i++) {
        seen += outline_place(list, stride, i)[PIECE_DEGREE] != 0.0;
    }
    return seen;
}

uint32_t outline_seen_count(const Numbers *list)
{
    return seen_before(list, outline_piece_count(list));
}

OutlinePoint outline_nearest(const Numbers *list, OutlinePoint p, OutlinePoint *along, double *place)
{
    uint32_t stride = outline_stride(list), pieces = outline_piece_count(list);
    double least = (double)INFINITY, nearest_s = 0.0;
    uint32_t nearest_piece = 0;
    OutlinePoint nearest = p;
    *along = (OutlinePoint){1.0, 0.0};
    const Place own = {p, 0x1p-40 * (fabs(p.u) + fabs(p.v))};
    for (int pass = 0; pass < 2; pass++) { // mostly what is near is in a piece's box, and no other box is as near
        Place reached = {p, pass == 0 ? own.room : sqrt(least)};
        if (reached.room < own.room) {
            break; // all that is as near has been asked
        }
        for (uint32_t i = 0; i < pieces; i++) {
            if (skips_group(list, stride, &i, is_beside_place, &reached)) {
                continue;
            }
            const double *box = outline_place(list, stride, i);
            if (is_beside_place(box, &reached) || (pass > 0 && !is_beside_place(box, &own))) {
                continue;
            }
            Piece piece = piece_of(list, stride, i);
            double s = piece_nearest(&piece, p);
            OutlinePoint at = piece_at(&piece, s);
            double from = distance2(at, p);
            if (from < least) {
                least = from;
                nearest = at;
                nearest_s = s;
                nearest_piece = i;
                *along = piece_along(&piece, s);
            }
        }
    }
    if (place) {
        *place = seen_before(list, nearest_piece) + nearest_s;
    }
    return nearest;
}

// ---- extent

static void extent_begin(OutlinePoint *low, OutlinePoint *high)
{
    *low = (OutlinePoint){(double)INFINITY, (double)INFINITY};
    *high = (OutlinePoint){-(double)INFINITY, -(double)INFINITY};
}

static void extent_take(OutlinePoint p, OutlinePoint *low, OutlinePoint *high)
{
    *low = (OutlinePoint){fmin(low->u, p.u), fmin(low->v, p.v)};
    *high = (OutlinePoint){fmax(high->u, p.u), fmax(high->v, p.v)};
}

void outline_bounds(const Numbers *list, OutlinePoint *low, OutlinePoint *high)
{
    uint32_t stride = outline_stride(list), pieces = outline_piece_count(list);
    extent_begin(low, high);
    for (uint32_t i = 0; i < pieces; i++) {
        const double *box = piece_of(list, stride, i).box;
        extent_take((OutlinePoint){box[PIECE_LOW], box[PIECE_LOW + 1]}, low, high);
        extent_take((OutlinePoint){box[PIECE_HIGH], box[PIECE_HIGH + 1]}, low, high);
    }
}

void outline_extent(const Numbers *list, OutlinePoint *low, OutlinePoint *high)
{
    uint32_t stride = outline_stride(list), pieces = outline_piece_count(list);
    extent_begin(low, high);
    for (uint32_t i = 0; i < pieces; i++) {
        Piece piece = piece_of(list, stride, i);
        const double *p = piece.points;
        extent_take((OutlinePoint){p[0], p[1]}, low, high);
        for (unsigned axis = 0; !piece.is_straight && axis < 2; axis++) {
            const double f[4] = {p[axis], p[2 + axis], p[4 + axis], p[6 + axis]};
            double at[2];
            unsigned count = cubic_extrema(f, at);
            for (unsigned k = 0; k < count; k++) {
                extent_take(piece_at(&piece, at[k]), low, high);
            }
        }
    }
}

double outline_support(const Numbers *list, OutlinePoint n)
{
    uint32_t pieces = outline_piece_count(list);
    unsigned points = outline_degree(list) + 1;
    double most = -(double)INFINITY;
    for (uint32_t i = 0; i < pieces; i++) {
        const double *p = outline_piece(list, i);
        for (unsigned k = 0; k < points; k++) {
            most = fmax(most, p[2 * k] * n.u + p[2 * k + 1] * n.v);
        }
    }
    return most;
}
