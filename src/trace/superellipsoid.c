// A function of t that is below 0 inside is taken apart until a part has one root at most: its slope is the difference
// of two that each grow or each fall all along, so that those at the ends of a part bound it, and it has no root where
// its value is farther from 0 than it can fall, one or none where its slope has one sign. Where rounding alone is left,
// signs at the ends decide.
//
// With p, q >= 1 the shape is convex and N (scene/superellipsoid.h) is a convex function of t: Newton's steps from
// outside come to its root from one side, or to where it rises again, and then there is none. With p, q <= 1 N is
// concave as long as no coordinate changes its sign. Else |x|^p + |y|^p and (1 - |z|^q)^(p/q) are there, both convex or
// both concave, and the function is their difference.
//
// N is good to some u, so that a line that passes the surface by more than a few of these is not met, and one that is
// as deep below it is.
//
// SPDX-License-Identifier: MIT
#include "trace/superellipsoid.h"

#include "math/extreme.h"
#include "scene/superellipsoid.h"
#include "trace/crossings.h"

// PLACES_MOST: what a line is asked at, at most; exponents that are no shapes any more ask for more.
enum {
    STEPS_MOST = 100,
    DEPTH_MOST = 60,
    PLACES_MOST = 2000,
    CROSSINGS_MOST = 2 * SUPERELLIPSOID_INTERVALS,
    WHOLE_MOST = 64
};

// Powers above this are the same.
static const double POWER_MOST = 1e300;

// What is beyond it is outside.
static const double REACH = 1.0625;

typedef enum Way { WAY_CONVEX, WAY_CONCAVE, WAY_MIXED } Way;

typedef struct Line {
    Vec3 exponents, o, d; // seen from a point near 0
    Vec3 rise;            // how the sizes of the coordinates change, in the part that is looked at
    double t_base, p, q;
    double start; // of a ray that starts on the surface: how far that is from 0, in lengths of the direction; else 0
    unsigned p_times, q_times; // both as whole numbers, 0 where one of them is none, or a great one
    Way way;
    Crossing crossings[CROSSINGS_MOST];
    uint32_t count, places;
} Line;

// The function at a place, and the two slopes whose difference is its own.
typedef struct Place {
    double t, value, slope, other;
} Place;

// Infinite slopes of what does not change are none.
static double slope_of(double by, double rise)
{
    return rise == 0.0 ? 0.0 : by * rise;
}

static Place size_at(const Line *line, double t)
{
    Vec3 by, at = vec3_add_scaled(line->o, t, line->d), rise = line->rise;
    at = vec3(fabs(at.x), fabs(at.y), fabs(at.z));
    double size = superellipsoid_size_and_gradient(line->exponents, at, &by);
    return (Place){t, size - 1.0, slope_of(by.x, rise.x) + slope_of(by.y, rise.y) + slope_of(by.z, rise.z), 0.0};
}

// The power with an exponent that is less by 1.
static double power_less(double base, double exponent, double power)
{
    return base > 0.0 ? power / base : pow(base, exponent - 1.0);
}

static Place place_at(const Line *line, double t)
{
    if (line->way != WAY_MIXED) {
        return size_at(line, t);
    }
    Vec3 at = vec3_add_scaled(line->o, t, line->d), rise = line->rise;
    double p = line->p, q = line->q, x = fabs(at.x), y = fabs(at.y), z = less_of(fabs(at.z), 1.0);
    double rest = z > 0.0 ? -expm1(q * log(z)) : 1.0, other = pow(rest, p / q), of_x = pow(x, p), of_y = pow(y, p);
    double by_z = -p * power_less(rest, p / q, other) * pow(z, q - 1.0);
    double slope = slope_of(p * power_less(x, p, of_x), rise.x) + slope_of(p * power_less(y, p, of_y), rise.y);
    return (Place){t, (of_x + of_y) - other, slope, slope_of(by_z, rise.z)};
}

static void cross_at(Line *line, double t)
{
    if (line->count < CROSSINGS_MOST) {
        line->crossings[line->count++] = (Crossing){line->t_base + t, 0};
    }
}

// Where the sign changes, once. The root of a start on the surface is as small as rounding left it: what its place may
// be off by is of the start's size.
static double root_between(const Line *line, Place first, Place last)
{
    double low = first.t, high = last.t, t = 0.5 * (low + high), before = high - low;
    bool is_low_inside = first.value < 0.0;
    for (int i = 0; i < STEPS_MOST && low < t && t < high; i++) {
        Place place = place_at(line, t);
        double next = t - place.value / (place.slope - place.other), change = fabs(next - t);
        *((place.value < 0.0) == is_low_inside ? &low : &high) = t;
        if (place.value == 0.0 || change <= 0x1p-53 * (fabs(t) + line->start)) {
            return t;
        }
        bool is_slow = !(next > low && next < high) || !(2.0 * change < before);
        before = is_slow ? high - low : change;
        t = is_slow ? 0.5 * (low + high) : next;
    }
    return t;
}

// Whether the function keeps its sign between two places where it is the same, its slope being between two bounds.
static bool stays(Place first, Place last, double least, double most)
{
    double sign = first.value < 0.0 ? -1.0 : 1.0, a = sign * first.value, b = sign * last.value,
           width = last.t - first.t;
    double fall = sign > 0.0 ? -least : most, rise = sign > 0.0 ? most : -least; // how fast it comes and goes
    if (!(fall > 0.0) || !(rise > 0.0)) {
        return fall <= 0.0 || rise <= 0.0;
    }
    // Down from a, and down to b from the other end: they meet above 0 or below it.
    double s = (a - b + rise * width) / (fall + rise);
    return a - fall * s > 0.0;
}

static void find_between(Line *line, Place first, Place last, unsigned depth)
{
    double least = less_of(first.slope, last.slope) - greater_of(first.other, last.other);
    double most = greater_of(first.slope, last.slope) - less_of(first.other, last.other);
    bool changes = (first.value < 0.0) != (last.value < 0.0), is_ordered = least > 0.0 || most < 0.0;
    double middle = 0.5 * (first.t + last.t);
    if (!changes && (is_ordered || stays(first, last, least, most))) {
        return;
    }
    bool is_last = depth == DEPTH_MOST || ++line->places > PLACES_MOST || !(first.t < middle && middle < last.t);
    if (changes && (is_ordered || is_last)) {
        cross_at(line, is_last ? middle : root_between(line, first, last));
    } else if (!is_last) {
        Place between = place_at(line, middle);
        find_between(line, first, between, depth + 1);
        find_between(line, between, last, depth + 1);
    }
}

// ---- convex ones

// Whole powers by multiplication.
static double whole_power(double x, unsigned n)
{
    double power = 1.0;
    for (; n > 0; n >>= 1) {
        power = n & 1 ? power * x : power;
        x *= x;
    }
    return power;
}

// The same function to the power of q, which takes one call of pow where exponents are whole, and none where they are
// the same, and its slope along the line. It is convex, too.
static double power_at(const Line *line, double t, double *slope)
{
    Vec3 at = vec3_add_scaled(line->o, t, line->d), d = line->d;
    double x = fabs(at.x), y = fabs(at.y), z = fabs(at.z);
    double by_x = whole_power(x, line->p_times - 1), by_y = whole_power(y, line->p_times - 1);
    double by_z = whole_power(z, line->q_times - 1), across = by_x * x + by_y * y;
    double by_across = line->p_times == line->q_times ? 1.0 : pow(across, line->q / line->p - 1.0);
    *slope =
        line->q * (by_across * (copysign(by_x, at.x) * d.x + copysign(by_y, at.y) * d.y) + copysign(by_z, at.z) * d.z);
    return by_across * across + by_z * z - 1.0;
}

// A place next to the root that is met first from outside, or to where there is none; nearer to it than `t`, and
// outside but for rounding, as Newton's steps are.
static double place_before(const Line *line, double t, double end, double way)
{
    for (int i = 0; i < STEPS_MOST && line->p_times > 0; i++) {
        double slope, value = power_at(line, t, &slope), step = value / (-way * slope);
        if (!(value > 0x1p-30) || !(way * slope < 0.0) || !(step <= way * (end - t))) {
            break;
        }
        t += way * step;
    }
    return t;
}

// The root that is met first from outside; false: there is none. `t` is outside; `way` is 1 or -1.
static bool first_root(const Line *line, double t, double end, double way, double *root)
{
    t = place_before(line, t, end, way);
    for (int i = 0; i < STEPS_MOST; i++) {
        Vec3 gradient;
        double size =
            superellipsoid_size_and_gradient(line->exponents, vec3_add_scaled(line->o, t, line->d), &gradient);
        double value = size - 1.0, slope = way * vec3_dot(gradient, line->d), step = value / -slope;
        if (value <= 0.0) {
            *root = t;
            return true;
        }
        if (!(slope < 0.0) || !(step <= way * (end - t))) {
            return false;
        }
        if (step <= 0x1p-44 * fabs(t)) { // what is left is what rounding of the size does
            *root = t + way * step;
            return true;
        }
        t += way * step;
    }
    *root = t;
    return true;
}

static unsigned convex_interval(const Line *line, double low, double high, SideLeft left, RayInterval *interval)
{
    *interval = (RayInterval){-(double)INFINITY, 0.0, 0, 0};
    bool is_start = left.side != SIDE_NONE;
    if (is_start && !left.inward) {
        return 0;
    }
    if (!is_start) {
        if (!first_root(line, low, high, 1.0, &interval->enter)) {
            return 0;
        }
        low = interval->enter;
        interval->enter += line->t_base;
    }
    bool is_met = first_root(line, high, is_start ? 0.0 : low, -1.0, &interval->leave);
    interval->leave = is_met ? interval->leave + line->t_base : is_start ? 0.0 : interval->enter;
    return interval->leave > (is_start ? 0.0 : interval->enter) ? 1 : 0;
}

// ---- any

static void line_set(Line *line, Vec3 exponents, const Ray *ray, bool is_start)
{
    Vec3 o = ray->origin, d = ray->direction;
    line->exponents = exponents;
    line->p = less_of(2.0 / exponents.x, POWER_MOST);
    line->q = less_of(2.0 / exponents.y, POWER_MOST);
    line->t_base = is_start ? 0.0 : -vec3_dot(o, d) / vec3_length_squared(d);
    line->o = is_start ? o : vec3_add_scaled(o, line->t_base, d);
    line->d = d;
    line->start = is_start ? vec3_max_abs(o) / vec3_max_abs(d) : 0.0;
    line->way = line->p >= 1.0 && line->q >= 1.0   ? WAY_CONVEX
                : line->p <= 1.0 && line->q <= 1.0 ? WAY_CONCAVE
                                                   : WAY_MIXED;
    bool are_whole =
        line->p == floor(line->p) && line->q == floor(line->q) && line->p <= WHOLE_MOST && line->q <= WHOLE_MOST;
    line->p_times = are_whole ? (unsigned)line->p : 0;
    line->q_times = are_whole ? (unsigned)line->q : 0;
    line->count = line->places = 0;
}

// What of the line lies within the reach; of WAY_MIXED |z| is no more than 1.
static bool line_clip(const Line *line, double *low, double *high)
{
    const double *o = &line->o.x, *d = &line->d.x;
    *low = -(double)INFINITY;
    *high = (double)INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double reach = axis == 2 && line->way == WAY_MIXED ? 1.0 : REACH;
        if (d[axis] == 0.0) {
            if (!(fabs(o[axis]) < reach)) {
                return false;
            }
            continue;
        }
        double first = (-reach - o[axis]) / d[axis], last = (reach - o[axis]) / d[axis];
        *low = greater_of(*low, less_of(first, last));
        *high = less_of(*high, greater_of(first, last));
    }
    return *low < *high;
}

static Vec3 rise_at(const Line *line, double t)
{
    Vec3 at = vec3_add_scaled(line->o, t, line->d), d = line->d;
    return vec3(at.x < 0.0 ? -d.x : d.x, at.y < 0.0 ? -d.y : d.y, at.z < 0.0 ? -d.z : d.z);
}

// Sums of coordinates' sizes that are no more than 1 inside, by which powers are less than 1.
static void sums_at(const Line *line, double t, double sums[3])
{
    Vec3 at = vec3_add_scaled(line->o, t, line->d);
    double x = fabs(at.x), y = fabs(at.y), z = line->q <= 1.0 ? fabs(at.z) : 0.0;
    bool is_joined = line->p <= 1.0;
    sums[0] = is_joined ? x + y + z : x + z;
    sums[1] = is_joined ? 0.0 : y + z;
    sums[2] = line->q <= 1.0 ? 0.0 : fabs(at.z);
}

// Whether all between two places is outside, where no coordinate changes its sign: each sum is linear there.
static bool is_beyond(const Line *line, double from, double to)
{
    double first[3], last[3];
    const double most = 1.0 + 0x1p-40;
    bool is_out = false;
    sums_at(line, from, first);
    sums_at(line, to, last);
    for (int i = 0; i < 3; i++) {
        is_out = is_out || (first[i] > most && last[i] > most);
    }
    return is_out;
}

// The function has slopes of which each grows or falls all along only as long as no coordinate changes its sign.
static void find_all(Line *line, double low, double high)
{
    double ends[5] = {low};
    const double *o = &line->o.x, *d = &line->d.x;
    unsigned count = 1;
    for (int axis = 0; axis < 3; axis++) {
        double t = -o[axis] / d[axis];
        unsigned at = count;
        if (!(t > low && t < high)) {
            continue;
        }
        for (; at > 1 && ends[at - 1] > t; at--) {
            ends[at] = ends[at - 1];
        }
        ends[at] = t;
        count++;
    }
    ends[count] = high;
    for (unsigned i = 1; i <= count; i++) {
        if (is_beyond(line, ends[i - 1], ends[i])) {
            continue;
        }
        line->rise = rise_at(line, 0.5 * (ends[i - 1] + ends[i]));
        Place first = place_at(line, ends[i - 1]), last = place_at(line, ends[i]);
        if (i == 1 && first.value < 0.0) {
            cross_at(line, low); // but for rounding it is outside there
        }
        find_between(line, first, last, 0);
        if (i == count && last.value < 0.0) {
            cross_at(line, high);
        }
    }
}

unsigned superellipsoid_intervals(Vec3 exponents, const Ray *ray, SideLeft left, RayInterval *intervals)
{
    Line line;
    double low, high;
    line_set(&line, exponents, ray, left.side != SIDE_NONE);
    if (!line_clip(&line, &low, &high)) {
        return 0;
    }
    if (line.way == WAY_CONVEX) {
        return convex_interval(&line, low, high, left, intervals);
    }
    find_all(&line, low, high);
    return crossings_intervals(line.crossings, line.count & ~1u, left, intervals);
}

// ---- surfaces

// Where an edge makes it infinite, that coordinate alone counts.
Vec3 superellipsoid_gradient(Vec3 exponents, Vec3 point)
{
    Vec3 n;
    superellipsoid_size_and_gradient(exponents, point, &n);
    double most = vec3_max_abs(n);
    if (isinf(most)) {
        return vec3(isinf(n.x) ? copysign(1.0, n.x) : 0.0, isinf(n.y) ? copysign(1.0, n.y) : 0.0,
                    isinf(n.z) ? copysign(1.0, n.z) : 0.0);
    }
    return most > 0.0 && !isnan(n.x + n.y + n.z) ? vec3_scale(1.0 / most, n) : vec3(1.0, 0.0, 0.0);
}

Vec3 superellipsoid_point(Vec3 exponents, Vec3 point)
{
    double size = superellipsoid_size(exponents, point);
    return size > 0.0 && isfinite(size) ? vec3_scale(1.0 / size, point) : point;
}
