// The polynomial along a line, and what of it is less than 0.
//
// The line is seen from its point b nearest to 0, in steps that are a power of two of its direction, so that no step is
// rounded; b is, in doubles, and is not in double words. Each coefficient along the line is a sum of terms that each
// come through at most 3 n + 6 operations, and Horner's scheme adds 2 n. A ray that starts on the surface has its
// polynomial made such that it is 0 there: that root is left out by leaving out the last coefficient.
//
// SPDX-License-Identifier: MIT
#include "trace/polynomial.h"

#include <string.h>

#include "math/extreme.h"
#include "scene/polynomial.h"
#include "trace/roots.h"

#define LINE_REAL double
#include "trace/polynomial_line.h"

enum { TERMS_MOST = POLYNOMIAL_ORDER_MOST + 1 };
_Static_assert((int)POLYNOMIAL_ORDER_MOST <= (int)ROOTS_DEGREE_MOST, "the root finder has room");

// A root is as good as the rest of a crossing if it is off by so many u of all that makes its place.
static const double GOOD_ROOT = 0x1p-44;

// How far beyond a range crossings are reported, as a share of its ends: far more than rounding does to it.
static const double WITHIN_MARGIN = 0x1p-20;

typedef struct Line {
    const double *list;
    const Ray *ray;
    double t_base, step; // t = t_base + s step
    Vec3 base, along;    // by s; `along` is exact
    double low, high;    // from where to where roots are asked for; by s
    bool is_start;       // s = 0 is a root, and left out
    unsigned most;       // intervals that there is room for
} Line;

// ---- the coefficients along a line

RT_ALWAYS_INLINE void line_compose(const Line *line, int order, bool skips, double *whole)
{
    const double base[3] = {line->base.x, line->base.y, line->base.z};
    const double along[3] = {line->along.x, line->along.y, line->along.z};
    compose_of(line->list, base, along, order, skips, whole);
}

static void compose(const Line *line, double *whole)
{
    int order = (int)polynomial_order(line->list);
    if (order == 4) {
        line_compose(line, 4, false, whole);
    } else {
        line_compose(line, order, true, whole);
    }
}

static int exact_times_line(DoubleWord *p, int degree, DoubleWord b, double d)
{
    if (degree < 0) {
        return degree;
    }
    p[degree + 1] = double_word_scale(p[degree], d);
    for (int i = degree; i > 0; i--) {
        p[i] = double_word_add(double_word_mul(p[i], b), double_word_scale(p[i - 1], d));
    }
    p[0] = double_word_mul(p[0], b);
    return degree + 1;
}

static int exact_plus(DoubleWord *p, int degree, const DoubleWord *q, int q_degree)
{
    for (int i = 0; i <= q_degree; i++) {
        p[i] = i <= degree ? double_word_add(p[i], q[i]) : q[i];
    }
    return q_degree > degree ? q_degree : degree;
}

static DoubleWord exact_base(double origin, double direction, double t)
{
    DoubleWord product = two_product(direction, t);
    return double_word_add(product, (DoubleWord){origin, 0.0});
}

static DoubleWord exact_place(double origin, double direction, DoubleWord t)
{
    DoubleWord product = two_product(direction, t.hi);
    return double_word_add(two_sum(product.hi, product.lo + direction * t.lo), (DoubleWord){origin, 0.0});
}

// Of Horner's scheme.
static DoubleWord exact_step(DoubleWord value, DoubleWord x, DoubleWord next)
{
    if (value.hi == 0.0) {
        return next;
    }
    value = double_word_mul(value, x);
    return next.hi == 0.0 ? value : double_word_add(value, next);
}

static void exact_compose(const Line *line, DoubleWord *whole)
{
    const Ray *ray = line->ray;
    DoubleWord x = exact_base(ray->origin.x, ray->direction.x, line->t_base);
    DoubleWord y = exact_base(ray->origin.y, ray->direction.y, line->t_base);
    DoubleWord z = exact_base(ray->origin.z, ray->direction.z, line->t_base);
    DoubleWord row[TERMS_MOST], part[TERMS_MOST];
    int order = (int)polynomial_order(line->list), whole_degree = -1;
    const double *c = polynomial_terms(line->list);
    for (int i = order; i >= 0; i--) {
        int row_degree = -1;
        for (int j = order - i; j >= 0; j--) {
            int part_degree = -1;
            for (int k = order - i - j; k >= 0; k--) {
                DoubleWord term = {*c++, 0.0};
                part_degree = exact_times_line(part, part_degree, z, line->along.z);
                part_degree =
                    term.hi != 0.0 || part_degree >= 0 ? exact_plus(part, part_degree, &term, 0) : part_degree;
            }
            row_degree = exact_times_line(row, row_degree, y, line->along.y);
            row_degree = exact_plus(row, row_degree, part, part_degree);
        }
        whole_degree = exact_times_line(whole, whole_degree, x, line->along.x);
        whole_degree = exact_plus(whole, whole_degree, row, row_degree);
    }
    for (int i = whole_degree + 1; i <= order; i++) {
        whole[i] = (DoubleWord){0.0, 0.0};
    }
}

// What the root finder asks for.
static void refine(Polynomial *polynomial, const void *owner)
{
    const Line *line = owner;
    DoubleWord exact[TERMS_MOST];
    exact_compose(line, exact);
    for (unsigned i = 0; i <= polynomial->degree; i++) {
        polynomial->exact[i] = exact[i + line->is_start];
    }
}

// The surface's polynomial at a place of the line: its terms one after the other, of which most are often 0.
static DoubleWord exact_value(const void *owner, DoubleWord s)
{
    const Line *line = owner;
    const Ray *ray = line->ray;
    DoubleWord t = two_sum(line->t_base, line->step * s.hi);
    t = double_word_add(t, (DoubleWord){line->step * s.lo, 0.0});
    DoubleWord x = exact_place(ray->origin.x, ray->direction.x, t), value = {0.0, 0.0};
    DoubleWord y = exact_place(ray->origin.y, ray->direction.y, t);
    DoubleWord z = exact_place(ray->origin.z, ray->direction.z, t);
    int order = (int)polynomial_order(line->list);
    const double *c = polynomial_terms(line->list);
    for (int i = order; i >= 0; i--) {
        DoubleWord row = {0.0, 0.0};
        for (int j = order - i; j >= 0; j--) {
            DoubleWord part = {0.0, 0.0};
            for (int k = order - i - j; k >= 0; k--) {
                part = exact_step(part, z, (DoubleWord){*c++, 0.0});
            }
            row = exact_step(row, y, part);
        }
        value = exact_step(value, x, row);
    }
    return value;
}

// The sizes of the terms of each coefficient along the line, of all of one degree together, with the greatest
// coordinate in the place of each; and how far the coefficients may be off.
RT_ALWAYS_INLINE void errors_of(const Line *line, int order, double *sizes, double *errors)
{
    const double *sums = polynomial_sizes(line->list);
    double origin = vec3_max_abs(line->ray->origin);
    double moved = line->t_base == 0.0 ? 0.0 : 0x1p-52 * (origin + vec3_max_abs(line->base)); // by rounding b
    double base = vec3_max_abs(line->base) + moved, along = vec3_max_abs(line->along);
    int degree = -1;
    UNROLLED
    for (int i = order; i >= 0; i--) {
        degree = times_line(sizes, degree, base, along);
        degree = plus(sizes, degree, &sums[i], 0);
    }
    double rounding = (6.0 * order + 16.0) * 0x1p-53, by_move = moved / along;
    UNROLLED
    for (int i = 0; i <= order; i++) {
        errors[i] = rounding * sizes[i] + (i < order ? by_move * (i + 1) * sizes[i + 1] : 0.0);
    }
}

static void line_polynomial(const Line *line, Polynomial *p)
{
    double whole[TERMS_MOST + 1], sizes[TERMS_MOST + 1], errors[TERMS_MOST + 1];
    unsigned order = polynomial_order(line->list), first = line->is_start;
    compose(line, whole);
    errors_of(line, (int)order, sizes, errors);
    p->degree = order - first;
    p->refine = refine;
    p->value = line->is_start ? NULL : exact_value;
    p->owner = line;
    for (unsigned i = 0; i <= p->degree; i++) {
        p->terms[i] = whole[i + first];
        p->sizes[i] = sizes[i + first];
        p->errors[i] = errors[i + first];
    }
    roots_start(p);
}

// ---- roots

// One over the greatest power of two within a number; ldexp and ilogb are calls.
static double inverse_power(double x)
{
    uint64_t bits, exponent = UINT64_C(0x7ff) << 52, both = UINT64_C(2046) << 52;
    memcpy(&bits, &x, sizeof bits);
    bits &= exponent;
    if (RT_UNLIKELY(bits == 0 || bits >= both)) {
        return ldexp(1.0, -ilogb(x));
    }
    double power;
    bits = both - bits;
    memcpy(&power, &bits, sizeof power);
    return power;
}

// Seen from `t_base`, or where it starts.
RT_ALWAYS_INLINE void line_set(Line *line, const double *list, const Ray *ray, bool is_start, double t_base,
                               unsigned most)
{
    Vec3 o = ray->origin, d = ray->direction;
    line->list = list;
    line->ray = ray;
    line->is_start = is_start;
    line->most = most;
    line->t_base = is_start ? 0.0 : t_base;
    line->step = inverse_power(vec3_max_abs(d));
    line->base = vec3_add_scaled(o, line->t_base, d);
    line->along = vec3_scale(line->step, d);
    line->low = is_start ? 0.0 : -(double)INFINITY;
    line->high = (double)INFINITY;
}

// Whether a root is good to some u of all that makes its place.
RT_ALWAYS_INLINE bool root_is_good(const Line *line, const double *terms, const double *errors, unsigned degree,
                                   double s)
{
    double error = 0.0, slope = 0.0, size = fabs(s);
    for (unsigned i = degree + 1; i-- > 0;) {
        error = error * size + errors[i];
        slope = i > 0 ? slope * s + i * terms[i] : slope;
    }
    return error <= GOOD_ROOT * (vec3_max_abs(line->ray->origin) + size) * fabs(slope);
}

static unsigned line_roots(const Line *line, Polynomial *p, double *roots, int *sign)
{
    bool is_about = isfinite(line->high) && (line->low == 0.0 || line->low == -line->high);
    unsigned count = is_about ? roots_find_about(p, line->high, line->low == 0.0, roots, sign)
                              : roots_find(p, line->low, line->high, roots, sign);
    bool are_good = true, were_exact = p->is_exact, refines = false; // their errors are those of then
    for (unsigned i = 0; i < count && !were_exact; i++) {
        refines = refines || p->is_exact || !root_is_good(line, p->terms, p->errors, p->degree, roots[i]);
        if (refines && !roots_refine(p, &roots[i])) {
            are_good = false;
        }
    }
    return are_good ? count : roots_find_exact(p, line->low, line->high, roots, sign);
}

static unsigned make_intervals(const Line *line, const double *roots, unsigned count, bool is_inside,
                               RayInterval *intervals)
{
    IntervalWalk walk = {.intervals = intervals, .open = INTERVAL_ALL, .is_inside = is_inside};
    for (unsigned i = 0; i < count && walk.count < line->most; i++) {
        interval_walk_cross(&walk, line->t_base + roots[i] * line->step, 0);
    }
    if (walk.is_inside && walk.count < line->most) {
        interval_walk_stay(&walk);
    }
    return walk.count;
}

// Whether the ray is inside behind its start: as it is said, but where the slope is against that by rounding; then the
// bend decides.
static bool starts_inside(const double *terms, unsigned degree, bool inward)
{
    bool falls = terms[0]<0.0, bends = degree> 0 && terms[1] < 0.0;
    return inward ? falls || bends : falls && bends;
}

// ---- quadrics: what the general way finds where doubles tell every sign, for a fifth of its work

// Whether the line surely has no root; *is_inside: all of it is.
RT_ALWAYS_INLINE bool quadric_is_missed(const double *list, const Ray *ray, bool *is_inside)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    double value, rounding;
    double discriminant =
        quadric_discriminant(list, o, d, vec3_max_abs(ray->origin), vec3_max_abs(ray->direction), &value, &rounding);
    *is_inside = value < 0.0;
    return rounding > QUADRIC_ROUNDING_LEAST && discriminant < -rounding;
}

// Newton's steps from a place that is off by rounding only. False when they do not end at once.
static bool quadric_root(const Line *line, const double *terms, const double *errors, unsigned degree, double *root)
{
    enum { STEPS_MOST = 4 };
    double x = *root;
    for (int i = 0; i < STEPS_MOST; i++) {
        double slope = degree == 2 ? terms[2] * x + (terms[2] * x + terms[1]) : terms[1];
        double value = (degree == 2 ? (terms[2] * x + terms[1]) * x : terms[1] * x) + terms[0];
        double next = value == 0.0 ? x : x - value / slope;
        if (fabs(next - x) <= 0x1p-52 * fabs(x)) {
            *root = next;
            return root_is_good(line, terms, errors, degree, next);
        }
        x = next;
    }
    return false;
}

// The two roots, none, or whatever double words say. *sign: of what is before the first.
static bool quadric_roots(const Line *line, double roots[2], unsigned *count, bool *is_inside)
{
    double terms[3], sizes[3], errors[3];
    line_compose(line, 2, false, terms);
    errors_of(line, 2, sizes, errors);
    double middle = -terms[1] / (2.0 * terms[2]), size = fabs(middle);
    double value = (terms[2] * middle + terms[1]) * middle + terms[0];
    if (!(fabs(terms[2]) > errors[2] && fabs(value) > (errors[2] * size + errors[1]) * size + errors[0])) {
        return false;
    }
    *is_inside = terms[2] < 0.0;
    *count = 0;
    if ((value < 0.0) == *is_inside) {
        return true;
    }
    double half = -0.5 * terms[1], square = half * half - terms[0] * terms[2];
    if (!(square > 0.0)) {
        return false;
    }
    double sum = half + copysign(sqrt(square), half), first = sum / terms[2], second = terms[0] / sum;
    roots[0] = first < second ? first : second;
    roots[1] = first < second ? second : first;
    *count = 2;
    return quadric_root(line, terms, errors, 2, &roots[0]) && quadric_root(line, terms, errors, 2, &roots[1]);
}

// Behind a start on the surface: the other root, none, or whatever double words say.
static bool quadric_roots_left(const Line *line, bool inward, double *root, unsigned *count, bool *is_inside)
{
    double terms[3], sizes[3], errors[3];
    line_compose(line, 2, false, terms);
    errors_of(line, 2, sizes, errors);
    if (!(fabs(terms[2]) > errors[2] && fabs(terms[1]) > errors[1])) {
        return false;
    }
    bool falls = terms[1] < 0.0;
    *is_inside = starts_inside(&terms[1], 1, inward);
    *count = falls != (terms[2] < 0.0);
    *root = -terms[1] / terms[2];
    if (*count == 1 && !quadric_root(line, &terms[1], &errors[1], 1, root)) {
        return false;
    }
    *count -= *count == 1 && *is_inside != falls; // the start's own, come twice
    return true;
}

// The general way.
static unsigned line_intervals(const Line *line, bool inward, RayInterval *intervals)
{
    Polynomial p;
    double roots[TERMS_MOST];
    int sign;
    line_polynomial(line, &p);
    unsigned count = line_roots(line, &p, roots, &sign);
    if (!line->is_start || line->low > 0.0) {
        return make_intervals(line, roots, count, sign < 0, intervals);
    }
    bool is_inside = starts_inside(p.terms, p.degree, inward);
    unsigned passed = count > 0 && is_inside != (sign < 0) ? 1 : 0; // the start's own, come twice
    return make_intervals(line, roots + passed, count - passed, is_inside, intervals);
}

unsigned polynomial_intervals(const double *list, const Ray *ray, SideLeft left, unsigned most, RayInterval *intervals)
{
    Line line;
    double roots[2];
    unsigned count;
    bool is_start = left.side != SIDE_NONE, is_inside;
    if (polynomial_order(list) == 2 && !is_start && quadric_is_missed(list, ray, &is_inside)) {
        intervals[0] = INTERVAL_ALL;
        return is_inside;
    }
    line_set(&line, list, ray, is_start, -vec3_dot(ray->origin, ray->direction) / vec3_length_squared(ray->direction),
             most);
    bool is_certain =
        polynomial_order(list) == 2 && (is_start ? quadric_roots_left(&line, left.inward, roots, &count, &is_inside)
                                                 : quadric_roots(&line, roots, &count, &is_inside));
    return is_certain ? make_intervals(&line, roots, count, is_inside, intervals)
                      : line_intervals(&line, left.inward, intervals);
}

unsigned polynomial_intervals_within(const double *list, const Ray *ray, SideLeft left, LineRange range, unsigned most,
                                     RayInterval *intervals)
{
    const double low = range.low, high = range.high;
    Line line;
    bool is_start = left.side != SIDE_NONE;
    double margin = WITHIN_MARGIN * (fabs(low) + fabs(high));
    if (polynomial_order(list) == 2 || !isfinite(margin)) {
        return polynomial_intervals(list, ray, left, most, intervals);
    }
    line_set(&line, list, ray, is_start, 0.5 * (low + high), most);
    line.high = (is_start ? high + margin : 0.5 * (high - low) + margin) / line.step;
    line.low = is_start ? greater_of(0.0, low - margin) / line.step : -line.high;
    return line_intervals(&line, left.inward, intervals);
}

// ---- surfaces

Vec3 polynomial_slope(const double *list, Vec3 point)
{
    Vec3 n = polynomial_gradient(list, point);
    double size = vec3_max_abs(n);
    return size > 0.0 && size <= 0x1p1000 ? vec3_scale(inverse_power(size), n) : vec3(1.0, 0.0, 0.0);
}

Vec3 polynomial_normal(const double *list, Vec3 point)
{
    return vec3_normalize(polynomial_slope(list, point));
}
