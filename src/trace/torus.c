// The crossings of a line and a torus, without a polynomial of degree 4.
//
// With rho the distance from the axis, side 0 is where h = (rho - R)² + y² - r² is 0, and side 1, if r > R, where that
// with -R for R is. Along the line h is a square's polynomial minus 2 R rho, and rho is convex: h'' = 0 only where rho is
// cbrt(R D), D being the square of the line's distance from the axis times that of its slope to it. So h is convex, then
// concave between two places that are known, then convex again; each piece has at most two roots, which the signs at its
// ends and at its one extremum distinguish, and no root is lost.
//
// h as a difference of lengths is good to some u of the distance from the tube's middle, so that thin tubes cost no
// digits, where the coefficients of a quartic lose as many as r² has beside R². A sign that this does not decide, and
// the last step of each root, are taken in double words of the line as it is given: a distance between line and surface
// of 2^-96 (|o| + 1) decides, but where the line passes the axis nearer than that, at the tips of side 1; there 2^-50.
//
// SPDX-License-Identifier: MIT
#include "trace/torus.h"

#include "math/extreme.h"
#include "trace/double_word.h"

enum { ROOTS_MOST = 4, STEPS_MOST = 120 };

// Room around what surely holds all crossings: far above what rounding does to the line, which is seen from near 0.
static const double MARGIN = 0x1p-44;

// The line p + s u, of unit length but for rounding, from its point nearest to 0; s = (t - t_near) / step. h of a side.
typedef struct TorusLine {
    const Ray *ray;
    double t_near, step;
    Vec3 p, u;
    double square, along;             // u·u and p·u
    double across2, s_axis, least2;   // rho² = across2 (s - s_axis)² + least2
    double major;                     // less than 0 for side 1
    DoubleWord minor2;                // the square of the tube's radius
} TorusLine;

// In order.
typedef struct TorusRoots {
    double s[ROOTS_MOST + 1];
    unsigned count;
} TorusRoots;

static DoubleWord coordinate(double o, double d, DoubleWord t)
{
    DoubleWord product = two_product(d, t.hi);
    return double_word_add(two_sum(product.hi, product.lo + d * t.lo), (DoubleWord){o, 0.0});
}

// What p says of the line.
static void line_set_from(TorusLine *line, Vec3 p)
{
    line->p = p;
    line->along = vec3_dot(p, line->u);
    double moment = p.x * line->u.z - p.z * line->u.x;
    bool is_along_axis = !(line->across2 > 0.0);
    line->s_axis = is_along_axis ? 0.0 : -(p.x * line->u.x + p.z * line->u.z) / line->across2;
    line->least2 = is_along_axis ? p.x * p.x + p.z * p.z : moment * moment / line->across2;
}

// All but what p says.
static void line_set(TorusLine *line, const Ray *ray)
{
    Vec3 o = ray->origin, d = ray->direction;
    double square = vec3_length_squared(d);
    line->ray = ray;
    line->t_near = -vec3_dot(o, d) / square;
    line->step = 1.0 / sqrt(square);
    line->u = vec3_scale(line->step, d);
    line->square = vec3_length_squared(line->u);
    double across2 = line->u.x * line->u.x + line->u.z * line->u.z;
    line->across2 = across2 > 0x1p-200 ? across2 : 0.0; // 0: it is along the axis
}

// p to the last bit.
static void line_place(TorusLine *line)
{
    Vec3 o = line->ray->origin, d = line->ray->direction;
    DoubleWord t = {line->t_near, 0.0};
    line_set_from(line, vec3(coordinate(o.x, d.x, t).hi, coordinate(o.y, d.y, t).hi, coordinate(o.z, d.z, t).hi));
}

static double rho_at(const TorusLine *line, double s)
{
    double x = s - line->s_axis;
    return sqrt(line->across2 * x * x + line->least2);
}

// h'/2. On the axis, where rho has none, its slope before it or behind it.
static double slope_at(const TorusLine *line, double s, bool is_behind)
{
    double rho = rho_at(line, s), root = sqrt(line->across2);
    double rise = rho > 0.0 ? line->across2 * (s - line->s_axis) / rho : is_behind ? root : -root;
    return line->square * s + line->along - line->major * rise;
}

// h''/2.
static double bend_at(const TorusLine *line, double s)
{
    double rho = rho_at(line, s);
    return line->square - line->major * (line->across2 * line->least2) / (rho * rho * rho);
}

// Whether a step of Newton's from s, of so great a change, leaves less than `most`: half of h'' / h' times its square,
// where that is a small part of it and h'' is about the same on its way, and what rounding does to h'. `slope` is
// slope_at's.
static bool step_leaves_less(const TorusLine *line, double s, double slope, double change, double most)
{
    change = fabs(change);
    slope = fabs(slope);
    if (!(change < 0x1p-10 * rho_at(line, s) && 0x1p-48 * change < most * slope)) {
        return false;
    }
    double turn = fabs(bend_at(line, s)) * change;
    return turn < 0x1p-10 * slope && turn * change < most * slope;
}

// t, and h as double words.
static DoubleWord t_at(const TorusLine *line, double s)
{
    return two_sum(line->t_near, s * line->step);
}

static DoubleWord exact_height(const TorusLine *line, DoubleWord t)
{
    Vec3 o = line->ray->origin, d = line->ray->direction;
    DoubleWord x = coordinate(o.x, d.x, t), y = coordinate(o.y, d.y, t), z = coordinate(o.z, d.z, t);
    DoubleWord rho = double_word_sqrt(double_word_add(double_word_mul(x, x), double_word_mul(z, z)));
    DoubleWord from = double_word_add(rho, (DoubleWord){-line->major, 0.0});
    DoubleWord square = double_word_add(double_word_mul(from, from), double_word_mul(y, y));
    return double_word_sub(square, line->minor2);
}

// h, whose sign is right.
static double height_at(const TorusLine *line, double s)
{
    double x = line->p.x + s * line->u.x, y = line->p.y + s * line->u.y, z = line->p.z + s * line->u.z;
    double from = sqrt(x * x + z * z) - line->major;
    double height = (from * from - line->minor2.hi) + y * y;
    double size = fabs(from) + fabs(y) + MARGIN;
    if (fabs(height) > 0x1p-47 * size) {
        return height;
    }
    DoubleWord exact = exact_height(line, t_at(line, s));
    return exact.hi;
}

// Where h' is 0 between two places where its signs differ; `rises`: it grows from one to the other.
static double extremum(const TorusLine *line, double low, double high, bool rises)
{
    double s = 0.5 * (low + high);
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double slope = slope_at(line, s, true), next = s - slope / bend_at(line, s);
        if (slope == 0.0) {
            return s;
        }
        *((slope < 0.0) == rises ? &low : &high) = s;
        bool is_done = fabs(next - s) <= 0x1p-53 * fabs(s);
        if (is_done) {
            return s;
        }
        s = next > low && next < high ? next : 0.5 * (low + high);
    }
    return s;
}

// The root of h between two places where its signs differ; `falls`: it is positive at the first. `guess`: where it may
// be.
static double root_between(const TorusLine *line, double low, double high, bool falls, double guess)
{
    double s = guess > low && guess < high ? guess : 0.5 * (low + high);
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double height = height_at(line, s), slope = 2.0 * slope_at(line, s, true), next = s - height / slope;
        if (height == 0.0) {
            return s;
        }
        *((height > 0.0) == falls ? &low : &high) = s;
        double change = fabs(next - s);
        bool is_near = change <= 0x1p-17 && next > low && next < high;
        if (is_near && step_leaves_less(line, s, 0.5 * slope, change, 0x1p-40)) {
            return next; // root_refine's first step does what is left
        }
        bool is_done = change <= 0x1p-51 * (fabs(s) + 0x1p-30);
        if (is_done) {
            return s;
        }
        s = next > low && next < high ? next : 0.5 * (low + high);
    }
    return s;
}

// A part of the line on which h is convex or concave, and whether h is positive at its ends.
typedef struct Piece {
    double low, high;
    bool is_convex, is_out_low, is_out_high;
    bool has_start; // at `low` h is 0 and continues in the way of is_out_low
} Piece;

static void piece_roots(const TorusLine *line, const Piece *piece, TorusRoots *roots)
{
    bool is_out = piece->is_out_low;
    if (is_out != piece->is_out_high) {
        roots->s[roots->count++] = root_between(line, piece->low, piece->high, is_out, piece->low);
        return;
    }
    if (is_out != piece->is_convex || piece->has_start || !(piece->low < piece->high)) {
        return; // its extremum is no nearer to 0 than its ends are
    }
    bool rises_low = slope_at(line, piece->low, true) > 0.0, rises_high = slope_at(line, piece->high, false) > 0.0;
    if (rises_low == rises_high || rises_low == piece->is_convex) {
        return;
    }
    double middle = extremum(line, piece->low, piece->high, piece->is_convex);
    double height = height_at(line, middle);
    if (height != 0.0 && (height > 0.0) != is_out) {
        double way = sqrt(greater_of(-height / bend_at(line, middle), 0.0)); // as far as the curvature says
        roots->s[roots->count++] = root_between(line, piece->low, middle, is_out, middle - way);
        roots->s[roots->count++] = root_between(line, middle, piece->high, !is_out, middle + way);
    }
}

// All roots of h from `low` to `high`, where it is positive, and at `low`, too, but for a ray that starts there and goes
// in.
static void find_roots(const TorusLine *line, double low, double high, bool has_start, bool starts_inside,
                       TorusRoots *roots)
{
    double turn = cbrt(line->major * line->across2 * line->least2 / line->square), reach2 = turn * turn - line->least2;
    double places[4] = {low, high, high, high};
    unsigned pieces = 1;
    roots->count = 0;
    if (line->across2 > 0.0 && line->major > 0.0 && reach2 >= 0.0) {
        double reach = sqrt(reach2 / line->across2);
        places[1] = less_of(greater_of(line->s_axis - reach, low), high);
        places[2] = less_of(greater_of(line->s_axis + reach, low), high);
        pieces = 3;
    }
    bool is_out = !(has_start && starts_inside);
    for (unsigned i = 0; i < pieces; i++) {
        double end = places[i + 1];
        bool is_last = i + 1 == pieces, is_empty = !(places[i] < end);
        bool is_out_end = is_last || end >= high ? true : is_empty ? is_out : height_at(line, end) > 0.0;
        Piece piece = {places[i], end, i != 1, is_out, is_out_end, has_start && places[i] == low};
        if (!is_empty) {
            piece_roots(line, &piece, roots);
            is_out = is_out_end;
        }
    }
}

// The root to the last bit that the line as it is given has: one step or two in double words.
static double root_refine(const TorusLine *line, double s)
{
    DoubleWord t = t_at(line, s);
    double slope = slope_at(line, s, true), slope_t = 2.0 * slope / line->step;
    for (int i = 0; i < 2; i++) {
        double change = exact_height(line, t).hi / slope_t;
        if (!(fabs(change) < 0x1p-30 * line->step)) {
            break; // a double root, or nearly one: as good as it was
        }
        t = double_word_add(t, (DoubleWord){-change, 0.0});
        if (step_leaves_less(line, s, slope, change / line->step, 0x1p-80 * less_of(fabs(t.hi) / line->step, 1.0))) {
            break;
        }
    }
    return t.hi;
}

// Where the line is near enough for the side: within a ball about 0 and, of side 0, between two planes and between two
// cylinders. `margin` is how far off p may be.
static bool line_is_near(const TorusLine *line, double minor, double margin, double *low, double *high)
{
    bool is_outer = line->major > 0.0;
    double ball2 = is_outer ? (line->major + minor) * (line->major + minor) : minor * minor - line->major * line->major;
    double half2 = ball2 + margin - vec3_length_squared(line->p);
    if (!(half2 > 0.0)) {
        return false;
    }
    double half = sqrt(half2) + margin, y = line->p.y, v = line->u.y, most = minor + margin;
    *low = -half;
    *high = half;
    if (!is_outer) {
        return true;
    }
    if (fabs(v) > 0x1p-60) {
        double first = (-most - y) / v, second = (most - y) / v;
        *low = greater_of(*low, less_of(first, second) - margin);
        *high = less_of(*high, greater_of(first, second) + margin);
    } else if (fabs(y) > most + margin) {
        return false;
    }
    if (!(*low < *high)) {
        return false;
    }
    double nearest = less_of(greater_of(line->s_axis, *low), *high);
    double farthest = greater_of(rho_at(line, *low), rho_at(line, *high));
    return rho_at(line, nearest) <= line->major + minor + margin && farthest >= line->major - minor - margin;
}

// The same of a line whose p is as doubles give it, for the outer side, which holds the inner one. Most lines that ask
// are nowhere near.
static bool line_may_be_near(TorusLine *line, double minor)
{
    Vec3 o = line->ray->origin;
    double low, high;
    line_set_from(line, vec3_add(o, vec3_scale(line->t_near, line->ray->direction)));
    bool is_steep = line->across2 < 0x1p-16; // s_axis and least2 may be far off
    return is_steep || line_is_near(line, minor, MARGIN + 0x1p-38 * (1.0 + vec3_max_abs(o)), &low, &high);
}

// A ray that starts on the side: the tube is as thick as it is there, so that the start is on it. Whether the ray is
// inside of it behind its start: as it is said, but where the slope is against that by rounding; then the bend decides.
static bool line_start(TorusLine *line, bool inward, double *s)
{
    DoubleWord zero = {0.0, 0.0};
    line->minor2 = double_word_add(line->minor2, exact_height(line, zero));
    *s = -line->t_near / line->step;
    bool falls = slope_at(line, *s, true) < 0.0, bends = bend_at(line, *s) < 0.0;
    return inward ? falls || bends : falls && bends;
}

static unsigned side_intervals(TorusLine *line, double minor, uint8_t side, SideLeft left, RayInterval *intervals)
{
    double low, high, start = 0.0;
    bool has_start = left.side == side, starts_inside = false;
    TorusRoots roots;
    unsigned count = 0;
    line->minor2 = two_product(minor, minor);
    if (has_start) { // into the tube is out of side 1
        starts_inside = line_start(line, left.inward == (side == TORUS_OUTER), &start);
    }
    if (!line_is_near(line, has_start ? sqrt(line->minor2.hi) : minor, MARGIN, &low, &high)) {
        return 0;
    }
    low = has_start ? start : low;
    if (!(low < high) || (has_start && side == TORUS_INNER && !starts_inside)) {
        return 0;
    }
    find_roots(line, low, high, has_start, starts_inside, &roots);
    bool is_inside = has_start && starts_inside;
    RayInterval interval = {-(double)INFINITY, 0.0, side, side};
    for (unsigned i = 0; i < roots.count && count < TORUS_INTERVALS; i++) {
        double t = root_refine(line, roots.s[i]);
        *(is_inside ? &interval.leave : &interval.enter) = t;
        if (is_inside) {
            intervals[count++] = interval;
        }
        is_inside = !is_inside;
    }
    return count;
}

unsigned torus_intervals(double major, double minor, const Ray *ray, SideLeft left,
                         RayInterval intervals[TORUS_INTERVALS])
{
    TorusLine line;
    line_set(&line, ray);
    line.major = major;
    if (left.side == SIDE_NONE && !line_may_be_near(&line, minor)) {
        return 0;
    }
    line_place(&line);
    unsigned count = side_intervals(&line, minor, TORUS_OUTER, left, intervals);
    if (minor > major && count < TORUS_INTERVALS) { // a line that crosses side 0 four times does not cross side 1
        line.major = -major;
        count += side_intervals(&line, minor, TORUS_INNER, left, intervals + count);
    }
    return count;
}

// ---- surfaces

Vec3 torus_gradient(double major, Vec3 point, uint8_t side)
{
    double rho = sqrt(point.x * point.x + point.z * point.z);
    if (!(rho > 0.0)) {
        return vec3(0.0, side == TORUS_OUTER ? point.y : -point.y, 0.0);
    }
    double factor = side == TORUS_OUTER ? (rho - major) / rho : -(rho + major) / rho;
    return vec3(factor * point.x, side == TORUS_OUTER ? point.y : -point.y, factor * point.z);
}

Vec3 torus_normal(double major, Vec3 point, uint8_t side)
{
    Vec3 n = torus_gradient(major, point, side);
    double length = sqrt(vec3_length_squared(n));
    return length > 0.0 ? vec3_scale(1.0 / length, n) : vec3(0.0, 1.0, 0.0);
}

Vec3 torus_point(double major, double minor, Vec3 point, uint8_t side)
{
    double rho = sqrt(point.x * point.x + point.z * point.z), ring = side == TORUS_OUTER ? major : -major;
    double from = rho - ring, length = sqrt(from * from + point.y * point.y);
    if (!(rho > 0.0 && length > 0.0)) {
        return point;
    }
    double factor = (ring + from * (minor / length)) / rho;
    return vec3(factor * point.x, point.y * (minor / length), factor * point.z);
}
