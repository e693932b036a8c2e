// Levels of derivatives: level k is the k-th derivative. Where a sign is 0 the place divides nothing.
//
// SPDX-License-Identifier: MIT
#include "trace/roots.h"

#include <string.h>

#include "math/extreme.h"

enum { STEPS_MOST = 200, REFINE_MOST = 8 };

// Where the terms of a level begin.
static unsigned level_at(const Polynomial *p, unsigned level)
{
    return level * (p->degree + 1) - level * (level - 1) / 2;
}

static void set_levels(Polynomial *p)
{
    p->has_levels = true;
    for (unsigned level = 1; level <= p->degree; level++) {
        const double *of = &p->terms[level_at(p, level - 1)];
        double *to = &p->terms[level_at(p, level)];
        for (unsigned i = 0; i + level <= p->degree; i++) {
            to[i] = (double)(i + 1) * of[i + 1];
        }
    }
}

static double horner(const double *terms, unsigned degree, double x)
{
    double value = terms[degree];
    for (unsigned i = degree; i-- > 0;) {
        value = value * x + terms[i];
    }
    return value;
}

static double value_at(const Polynomial *p, unsigned level, double x)
{
    return horner(&p->terms[level_at(p, level)], p->degree - level, x);
}

// i (i - 1) … for `level` factors.
static double falling(unsigned i, unsigned level)
{
    double product = 1.0;
    for (unsigned k = 0; k < level; k++) {
        product *= (double)(i - k);
    }
    return product;
}

// The sum of terms[i] |x|^i, or of its derivative at a level.
static double bound_at(const double *terms, unsigned degree, unsigned level, double x)
{
    double value = 0.0, size = fabs(x);
    for (unsigned i = degree + 1; i-- > level;) {
        value = value * size + terms[i] * falling(i, level);
    }
    return value;
}

static DoubleWord exact_at(const Polynomial *p, unsigned level, double x)
{
    DoubleWord value = double_word_scale(p->exact[p->degree], falling(p->degree, level));
    for (unsigned i = p->degree; i-- > level;) {
        value = double_word_scale(value, x);
        value = double_word_add(value, double_word_scale(p->exact[i], falling(i, level)));
    }
    return value;
}

static void make_exact(Polynomial *p)
{
    if (p->is_exact) {
        return;
    }
    p->refine(p, p->owner);
    p->is_exact = true;
    double rounding = (2.0 * p->degree + 4.0) * 0x1p-53;
    for (unsigned i = 0; i <= p->degree; i++) {
        p->terms[i] = p->exact[i].hi;
        p->errors[i] = rounding * fabs(p->terms[i]) + ROOTS_EXACT_ERROR * p->sizes[i];
    }
    set_levels(p);
}

static int sign_of(double value)
{
    return (value > 0.0) - (value < 0.0);
}

static int sign_exact(Polynomial *p, unsigned level, double x)
{
    make_exact(p);
    double value = value_at(p, level, x), error = bound_at(p->errors, p->degree, level, x);
    if (fabs(value) > error) {
        return sign_of(value);
    }
    value = exact_at(p, level, x).hi;
    return fabs(value) > ROOTS_EXACT_ERROR * bound_at(p->sizes, p->degree, level, x) ? sign_of(value) : 0;
}

static int sign_at(Polynomial *p, unsigned level, double x)
{
    double value = value_at(p, level, x), error = bound_at(p->errors, p->degree, level, x);
    return fabs(value) > error ? sign_of(value) : sign_exact(p, level, x);
}

int roots_sign(Polynomial *p, double x)
{
    return sign_at(p, 0, x);
}

void roots_start(Polynomial *p)
{
    p->is_exact = false;
    while (p->degree > 0 && p->sizes[p->degree] == 0.0) {
        p->degree--;
    }
    while (p->degree > 0 && !(fabs(p->terms[p->degree]) > p->errors[p->degree])) {
        make_exact(p);
        if (fabs(p->terms[p->degree]) > ROOTS_EXACT_ERROR * p->sizes[p->degree]) {
            break;
        }
        p->degree--;
    }
    p->has_levels = false; // those that there are may be of another degree
}

// The exponent of a number, of 0 one below all others, and of what is not finite one above them.
static int exponent_of(double x)
{
    enum { LEAST = -1075, GREATEST = 1024 };
    return x == 0.0 ? LEAST : isfinite(x) ? ilogb(x) : GREATEST;
}

// Fujiwara's bound of all roots, as a power of two; those of derivatives lie within it, too (Gauss, Lucas). What is
// farther than numbers can tell apart is no place.
static double outer_bound(const Polynomial *p)
{
    enum { NONE = -4000, FARTHEST = 1000 };
    int lead = exponent_of(p->terms[p->degree]), most = NONE;
    for (unsigned i = 0; i < p->degree; i++) {
        if (p->terms[i] != 0.0) {
            int below = (int)(p->degree - i), rise = exponent_of(p->terms[i]) + 1 - lead;
            int share = rise > 0 ? (rise + below - 1) / below : rise / below;
            most = share > most ? share : most;
        }
    }
    most = most > FARTHEST ? FARTHEST : most;
    return most == NONE ? 1.0 : ldexp(1.0, most + 2);
}

// The value of a level and its slope; of double words, once there are some.
static double value_and_slope(const Polynomial *p, unsigned level, double x, double *slope)
{
    if (p->is_exact) {
        *slope = exact_at(p, level + 1, x).hi;
        return exact_at(p, level, x).hi;
    }
    const double *terms = &p->terms[level_at(p, level)];
    double value = terms[p->degree - level], rise = 0.0;
    for (unsigned k = p->degree - level; k-- > 0;) {
        rise = rise * x + value;
        value = value * x + terms[k];
    }
    *slope = rise;
    return value;
}

// Where a root between two places may be, as the curvature at one of them says, at which the slope is 0; their middle
// where that is no place between.
static double root_guess(const Polynomial *p, unsigned level, double low, double high, double flat)
{
    double turn = p->degree - level >= 2 ? value_at(p, level + 2, flat) : 0.0;
    double way = sqrt(fmax(-2.0 * value_at(p, level, flat) / turn, 0.0)); // of NaN 0
    double guess = flat == low ? low + way : high - way;
    return guess > low && guess < high ? guess : 0.5 * (low + high);
}

// The place of a sign change between two places, for a sign before it, from a guess; Newton's steps as long as they
// stay between.
static double root_between(const Polynomial *p, unsigned level, double low, double high, int sign, double guess)
{
    double x = guess, before = high - low;
    const double enough = level > 0 ? 0x1p-26 : 0x1p-52; // of x: a step squares what is off, and places only divide
    for (int i = 0; i < STEPS_MOST && low < x && x < high; i++) {
        double slope, value = value_and_slope(p, level, x, &slope);
        if (value == 0.0) {
            return x;
        }
        *((value > 0.0) == (sign > 0) ? &low : &high) = x;
        double next = x - value / slope, change = fabs(next - x);
        if (change <= enough * fabs(x)) {
            return next > low && next < high ? next : x;
        }
        bool is_slow = !(next > low && next < high) || !(2.0 * change < before);
        before = is_slow ? high - low : change;
        x = is_slow ? 0.5 * (low + high) : next;
    }
    return x;
}

// Between which places roots are looked for; an end that stands for one that is infinite has the sign that it has
// there.
typedef struct Range {
    double low, high;
    bool is_low_infinite, is_high_infinite;
} Range;

static int sign_beyond(const Polynomial *p, unsigned level, bool is_low)
{
    bool turns = is_low && (p->degree - level) % 2 != 0;
    return (p->terms[p->degree] > 0.0) != turns ? 1 : -1;
}

// The sign of a level, if doubles are enough to know it. A place of a derivative's where it cannot remains one
// for the next level: what the derivative does so near to 0 changes the polynomial by less than its own error.
static bool sign_is_known(Polynomial *p, unsigned level, double x, int *sign)
{
    if (p->refine && (level == 0 || p->is_exact)) {
        *sign = sign_at(p, level, x);
        return true;
    }
    double value = value_at(p, level, x);
    *sign = sign_of(value);
    return fabs(value) > bound_at(p->errors, p->degree, level, x);
}

typedef struct Places {
    const double *at; // in their order
    unsigned count;
} Places;

// The roots of a level, from places between which it has one at most.
static unsigned level_roots(Polynomial *p, unsigned level, const Range *range, Places between, double *roots,
                            int *first)
{
    unsigned count = 0;
    double from = range->low;
    int sign = 0;
    bool is_known = true;
    if (range->is_low_infinite) {
        sign = sign_beyond(p, level, true);
    } else {
        is_known = sign_is_known(p, level, from, &sign);
    }
    sign = is_known ? sign : 0;
    *first = sign;
    for (unsigned i = 0; i <= between.count; i++) {
        bool is_last = i == between.count;
        double to = is_last ? range->high : between.at[i];
        int next;
        is_known = true;
        if (is_last && range->is_high_infinite) {
            next = sign_beyond(p, level, false);
        } else {
            is_known = sign_is_known(p, level, to, &next);
        }
        if (!is_known) {
            if (!is_last) {
                roots[count++] = to;
            }
            sign = 0;
            from = to;
            continue;
        }
        if (next == 0) {
            continue;
        }
        if (sign == 0) {
            *first = *first == 0 ? next : *first;
        } else if (sign != next) {
            double guess = i > 0 || !is_last ? root_guess(p, level, from, to, i > 0 ? from : to) : 0.5 * (from + to);
            roots[count++] = root_between(p, level, from, to, sign, guess);
        }
        sign = next;
        from = to;
    }
    return count;
}

// Of the level that is a quadratic or a line.
static unsigned lowest_roots(const Polynomial *p, unsigned level, double low, double high, double *roots)
{
    const double *terms = &p->terms[level_at(p, level)];
    unsigned count = 0;
    double first, second;
    if (p->degree - level == 1) {
        first = second = -terms[0] / terms[1];
    } else {
        double half = -0.5 * terms[1], square = half * half - terms[0] * terms[2];
        if (!(square > 0.0)) {
            return 0;
        }
        double sum = half + copysign(sqrt(square), half);
        first = sum / terms[2];
        second = terms[0] / sum;
    }
    if (first > second) {
        double other = first;
        first = second;
        second = other;
    }
    if (first > low && first < high) {
        roots[count++] = first;
    }
    if (second > first && second > low && second < high) {
        roots[count++] = second;
    }
    return count;
}

// The roots of the derivative, in room for as many as the degree.
static unsigned find_turns(Polynomial *p, const Range *range, double *turns)
{
    double places[2][ROOTS_DEGREE_MOST + 1];
    unsigned count = 0, level = p->degree > 2 ? p->degree - 2 : 1, now = 0;
    if (p->degree > 1) {
        count = lowest_roots(p, level, range->low, range->high, places[now]);
        while (--level > 0) {
            int first;
            count = level_roots(p, level, range, (Places){places[now], count}, places[!now], &first);
            now = !now;
        }
    }
    memcpy(turns, places[now], count * sizeof *turns);
    return count;
}

static unsigned find_between(Polynomial *p, const Range *range, double *roots, int *sign)
{
    double turns[ROOTS_DEGREE_MOST + 1];
    unsigned count = find_turns(p, range, turns);
    return level_roots(p, 0, range, (Places){turns, count}, roots, sign);
}

unsigned roots_and_turns(Polynomial *p, double low, double high, double *places)
{
    Range range = {.low = low, .high = high};
    int sign;
    p->is_exact = false;
    while (p->degree > 0 && !(fabs(p->terms[p->degree]) > p->errors[p->degree])) {
        p->degree--;
    }
    if (p->degree == 0) {
        return 0;
    }
    set_levels(p);
    unsigned count = find_turns(p, &range, places);
    return count + level_roots(p, 0, &range, (Places){places, count}, places + count, &sign);
}

// Whether a polynomial of degree 4 has no root, as it is for most lines that pass a surface by: of c4 x⁴ + … + c0 the
// sum of c4 x⁴ + c3 x³ + k c2 x² and (1 - k) c2 x² + c1 x + c0, neither of which is 0 where it has the share k that
// discriminants ask for.
static bool is_clear(const Polynomial *p)
{
    if (p->degree != 4 || p->is_exact) {
        return false;
    }
    const double *c = p->terms, *e = p->errors, sign = c[4] > 0.0 ? 1.0 : -1.0;
    double c4 = sign * c[4] - e[4], c2 = sign * c[2] - e[2], c0 = sign * c[0] - e[0];
    double c3 = fabs(c[3]) + e[3], c1 = fabs(c[1]) + e[1];
    double product = c4 * c2 * c0;
    return c4 > 0.0 && c2 > 0.0 && c0 > 0.0 && product > 0x1p-900 && c3 * c3 * c0 + c1 * c1 * c4 < 3.99 * product;
}

// What double words were wanted for is found once more from better terms.
unsigned roots_find(Polynomial *p, double low, double high, double *roots, int *sign)
{
    Range range = {low, high, isinf(low), isinf(high)};
    if (p->degree == 0) {
        *sign = sign_at(p, 0, 0.0);
        return 0;
    }
    if (range.is_low_infinite && range.is_high_infinite && is_clear(p)) {
        *sign = p->terms[4] > 0.0 ? 1 : -1;
        return 0;
    }
    if (range.is_low_infinite || range.is_high_infinite) {
        double bound = outer_bound(p);
        range.low = !range.is_low_infinite ? low : high < -bound ? 2.0 * high : -bound;
        range.high = !range.is_high_infinite ? high : low > bound ? 2.0 * low : bound;
    }
    bool was_exact = p->is_exact;
    if (!p->has_levels) {
        set_levels(p);
    }
    unsigned count = find_between(p, &range, roots, sign);
    return was_exact == p->is_exact ? count : find_between(p, &range, roots, sign);
}

// Bernstein's coefficients of a polynomial of degree 4 or less on [-high, high], or with `is_half` from 0 on: it lies
// between the least and the greatest of them, and has no more roots than their signs change.
static void bernstein(const Polynomial *p, double high, bool is_half, double b[5], double *error)
{
    double c[5] = {0.0}, power = 1.0;
    *error = 0.0;
    for (unsigned i = 0; i <= p->degree; i++) {
        c[i] = p->terms[i] * power;
        *error += p->errors[i] * power;
        power *= high;
    }
    *error *= 1.0 + 0x1p-20;
    double third = c[2] / 3.0, half_odd = 0.5 * (c[1] - c[3]);
    b[0] = is_half ? c[0] : c[0] - c[1] + c[2] - c[3] + c[4];
    b[1] = is_half ? c[0] + 0.25 * c[1] : c[0] - half_odd - c[4];
    b[2] = is_half ? c[0] + 0.5 * (c[1] + third) : c[0] - third + c[4];
    b[3] = is_half ? c[0] + 0.75 * c[1] + 0.5 * c[2] + 0.25 * c[3] : c[0] + half_odd - c[4];
    b[4] = c[0] + c[1] + c[2] + c[3] + c[4];
}

unsigned roots_find_about(Polynomial *p, double high, bool is_half, double *roots, int *sign)
{
    double b[5], error, low = is_half ? 0.0 : -high;
    if (p->degree <= 4 && !p->is_exact) {
        bernstein(p, high, is_half, b, &error);
        unsigned changes = 0;
        int last = fabs(b[0]) > error ? sign_of(b[0]) : 0;
        bool is_known = last != 0 && fabs(b[4]) > error;
        *sign = last;
        for (unsigned i = 1; is_known && i < 5; i++) {
            int own = fabs(b[i]) > error ? sign_of(b[i]) : 0;
            bool may_be_either = own == 0 && sign_of(b[4]) != last; // then the next change counts
            changes += own != 0 && own != last;
            is_known = own != 0 || may_be_either;
            last = own != 0 ? own : last;
        }
        if (is_known && changes == 0) {
            return 0;
        }
        if (is_known && changes == 1) {
            roots[0] = root_between(p, 0, low, high, *sign, 0.5 * (low + high));
            return 1;
        }
    }
    return roots_find(p, low, high, roots, sign);
}

// The polynomial at a place, from exact terms.
static DoubleWord value_exact(const Polynomial *p, DoubleWord x)
{
    DoubleWord value = p->exact[p->degree];
    for (unsigned k = p->degree; k-- > 0;) {
        value = double_word_add(double_word_mul(value, x), p->exact[k]);
    }
    return value;
}

// A step of Newton's leaves of itself what the bend and errors of the slope make.
bool roots_refine(Polynomial *p, double *root)
{
    bool is_given = p->value && !p->is_exact;
    if (!is_given) {
        make_exact(p);
    }
    if (!p->has_levels) {
        set_levels(p);
    }
    DoubleWord x = {*root, 0.0};
    for (int i = 0; i < REFINE_MOST; i++) {
        DoubleWord value = is_given ? p->value(p->owner, x) : value_exact(p, x);
        double slope = value_at(p, 1, x.hi), change = value.hi / slope;
        double turn = p->degree > 1 ? change * value_at(p, 2, x.hi) : 0.0;
        if (value.hi == 0.0) {
            break;
        }
        if (!(fabs(turn) <= 0.75 * fabs(slope))) {
            return false;
        }
        x = double_word_add(x, (DoubleWord){-change, 0.0});
        double left = fabs(change) * (fabs(turn) + bound_at(p->errors, p->degree, 1, x.hi));
        if (fabs(change) <= 0x1p-70 * fabs(x.hi) || left <= 0x1p-70 * fabs(x.hi) * fabs(slope)) {
            break;
        }
    }
    *root = x.hi;
    return true;
}

unsigned roots_find_exact(Polynomial *p, double low, double high, double *roots, int *sign)
{
    make_exact(p);
    return roots_find(p, low, high, roots, sign);
}
