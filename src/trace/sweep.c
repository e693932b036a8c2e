// Segments one after the other, each near one by its polynomials; what they cover is put together.
//
// Where F has roots is decided by doubles or double words (trace/roots.h). Where an interval ends is found about the
// middle of the s that have a ball on the line, so that coefficients are as large as the ball is and not as the
// segment. What is missed or wrong of those s makes an end wrong by its square, for there the end is an extremum; and
// every ball that is tried covers what it says.
//
// SPDX-License-Identifier: MIT
#include "trace/sweep.h"

#include <string.h>

#include "math/extreme.h"
#include "scene/sweep.h"
#include "trace/crossings.h"
#include "trace/roots.h"

enum {
    FORM_DEGREE = 2 * SWEEP_DEGREE,      // of F
    PLACES_DEGREE = 2 * FORM_DEGREE - 2, // of 4 F a'² - F'²
};

typedef struct Line {
    Ray ray;              // its direction is between 1 and 4 long, by a power of two
    Vec3 near;            // the point of the line that is nearest to 0, but for rounding
    double t_near;        // where that is
    double square, scale; // |d|²; its parameter times `scale` is that of the ray as it came
    double inverse[3], margin, start;
} Line;

// A segment seen along a line; terms of s^0, s^1, …
typedef struct Seen {
    const Line *line;
    const SweepBall *terms;
    unsigned degree;
    Vec3 cross[SWEEP_DEGREE + 1]; // (m - o) × d
    double along[SWEEP_DEGREE + 1], radius[SWEEP_DEGREE + 1];
} Seen;

typedef struct Covered {
    Crossing *ends; // pairs, in order and apart
    uint32_t count;
} Covered;

// ---- the line

static Line line_of(const Ray *ray)
{
    Line line = {.scale = ldexp(1.0, -ilogb(vec3_max_abs(ray->direction)))};
    Vec3 d = vec3_scale(line.scale, ray->direction);
    line.ray = (Ray){ray->origin, d};
    line.square = vec3_length_squared(d);
    line.t_near = -vec3_dot(ray->origin, d) / line.square;
    line.near = vec3_add_scaled(ray->origin, line.t_near, d);
    line.inverse[0] = 1.0 / copysign(greater_of(fabs(d.x), 0x1p-900), d.x);
    line.inverse[1] = 1.0 / copysign(greater_of(fabs(d.y), 0x1p-900), d.y);
    line.inverse[2] = 1.0 / copysign(greater_of(fabs(d.z), 0x1p-900), d.z);
    line.margin = 0x1p-48 * (vec3_sum_abs(ray->origin) + fabs(line.t_near) * vec3_sum_abs(d));
    line.start = -2.0 * line.margin - line.t_near;
    return line;
}

// Whether the line comes near to a box, not only behind its start.
static bool is_near(const Line *line, const SweepBox *box)
{
    const double *low = &box->low.x, *high = &box->high.x, *o = &line->near.x;
    double from = line->start, to = (double)INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        double a = (low[axis] - line->margin - o[axis]) * line->inverse[axis];
        double b = (high[axis] + line->margin - o[axis]) * line->inverse[axis];
        from = greater_of(from, less_of(a, b));
        to = less_of(to, greater_of(a, b));
    }
    return from <= to;
}

// ---- F

static void see(Seen *seen)
{
    const Line *line = seen->line;
    for (unsigned i = 0; i <= seen->degree; i++) {
        Vec3 m = i == 0 ? vec3_sub(seen->terms[0].middle, line->near) : seen->terms[i].middle;
        seen->cross[i] = vec3_cross(m, line->ray.direction);
        seen->along[i] = vec3_dot(m, line->ray.direction);
        seen->radius[i] = seen->terms[i].radius;
    }
}

static void form_of(const Seen *seen, double *f)
{
    for (unsigned i = 0; i <= 2 * seen->degree; i++) {
        f[i] = 0.0;
    }
    for (unsigned i = 0; i <= seen->degree; i++) {
        for (unsigned j = i; j <= seen->degree; j++) {
            double term =
                seen->line->square * seen->radius[i] * seen->radius[j] - vec3_dot(seen->cross[i], seen->cross[j]);
            f[i + j] += i == j ? term : 2.0 * term;
        }
    }
}

static void exact_cross(const Seen *seen, unsigned i, DoubleWord cross[3])
{
    const double *m = &seen->terms[i].middle.x, *o = &seen->line->ray.origin.x, *d = &seen->line->ray.direction.x;
    DoubleWord from[3];
    for (int axis = 0; axis < 3; axis++) {
        from[axis] = i == 0 ? two_sum(m[axis], -o[axis]) : (DoubleWord){m[axis], 0.0};
    }
    for (int axis = 0; axis < 3; axis++) {
        int next = (axis + 1) % 3, last = (axis + 2) % 3;
        cross[axis] = double_word_sub(double_word_scale(from[next], d[last]), double_word_scale(from[last], d[next]));
    }
}

// What the root finder asks for.
static void refine(Polynomial *polynomial, const void *owner)
{
    const Seen *seen = owner;
    const double *d = &seen->line->ray.direction.x;
    DoubleWord cross[SWEEP_DEGREE + 1][3], square = {0.0, 0.0}, sum[FORM_DEGREE + 1] = {{0.0, 0.0}};
    for (int axis = 0; axis < 3; axis++) {
        square = double_word_add(square, two_product(d[axis], d[axis]));
    }
    for (unsigned i = 0; i <= seen->degree; i++) {
        exact_cross(seen, i, cross[i]);
    }
    for (unsigned i = 0; i <= seen->degree; i++) {
        for (unsigned j = 0; j <= seen->degree; j++) {
            DoubleWord term = double_word_mul(square, two_product(seen->radius[i], seen->radius[j]));
            for (int axis = 0; axis < 3; axis++) {
                term = double_word_sub(term, double_word_mul(cross[i][axis], cross[j][axis]));
            }
            sum[i + j] = double_word_add(sum[i + j], term);
        }
    }
    for (unsigned i = 0; i <= polynomial->degree; i++) {
        polynomial->exact[i] = sum[i];
    }
}

// A coordinate of a cross product is off by 4 u of |m| |d|, the first by as much of |o| + |t d| + |m|; the rest of F by
// 20 u of its terms.
static void set_errors(const Seen *seen, Polynomial *p)
{
    double size[SWEEP_DEGREE + 1], off[SWEEP_DEGREE + 1], reach = 0x1p48 * seen->line->margin;
    double length = vec3_sum_abs(seen->line->ray.direction);
    unsigned degree = seen->degree;
    for (unsigned i = 0; i <= degree; i++) {
        double terms = vec3_sum_abs(seen->terms[i].middle) + (i == 0 ? reach : 0.0);
        off[i] = 0x1p-49 * terms * length;
        size[i] = vec3_sum_abs(seen->cross[i]);
    }
    for (unsigned i = 0; i <= 2 * degree; i++) {
        p->errors[i] = p->sizes[i] = 0.0;
    }
    for (unsigned i = 0; i <= degree; i++) {
        for (unsigned j = i; j <= degree; j++) {
            double balls = fabs(seen->line->square * seen->radius[i] * seen->radius[j]), times = i == j ? 1.0 : 2.0;
            p->errors[i + j] +=
                times * (off[i] * size[j] + size[i] * off[j] + off[i] * off[j] + 0x1p-47 * (size[i] * size[j] + balls));
            p->sizes[i + j] += times * (0x1p98 * (off[i] * off[j]) + balls);
        }
    }
}

// Of Bernstein's coefficients of F on [-1/2, 1/2], which F lies between: 1: all are greater than 0, -1: less, 0:
// neither.
static int sign_of_all(const double *f, const double *errors, unsigned degree)
{
    double power = 1.0, c[FORM_DEGREE + 1] = {0.0}, error = 0.0, even[4], odd[4];
    for (unsigned i = 0; i <= degree; i++) {
        c[i] = power * f[i];
        error += 4.0 * power * errors[i];
        power *= 0.5;
    }
    unsigned last = degree == 2 ? 1 : 3;
    if (degree == 2) {
        even[0] = c[0] + c[2];
        even[1] = c[0] - c[2];
        odd[0] = c[1];
    } else {
        even[0] = c[0] + c[2] + c[4] + c[6];
        even[1] = c[0] + (c[2] - c[4]) / 3.0 - c[6];
        even[2] = c[0] - (c[2] + c[4]) / 15.0 + c[6];
        even[3] = c[0] - (c[2] - c[4]) / 5.0 - c[6];
        odd[0] = c[1] + c[3] + c[5];
        odd[1] = (c[1] - c[5]) / 1.5;
        odd[2] = (c[1] + c[5]) / 3.0 - c[3] / 5.0;
    }
    odd[last] = 0.0;
    bool above = true, below = true;
    for (unsigned i = 0; i <= last; i++) {
        double off = fabs(odd[i]);
        above = above && even[i] - off > error;
        below = below && even[i] + off < -error;
    }
    return above ? 1 : below ? -1 : 0;
}

// ---- what balls that follow one another cover

static void add_interval(Covered *covered, double from, double to)
{
    Crossing *ends = covered->ends;
    uint32_t first = 0, count = covered->count;
    while (first < count && ends[first + 1].t < from) {
        first += 2;
    }
    uint32_t last = first; // behind those that it meets
    while (last < count && ends[last].t <= to) {
        from = less_of(from, ends[last].t);
        to = greater_of(to, ends[last + 1].t);
        last += 2;
    }
    uint32_t rest = count - last;
    memmove(ends + first + 2, ends + last, rest * sizeof *ends);
    ends[first] = (Crossing){from, 0};
    ends[first + 1] = (Crossing){to, 0};
    covered->count = first + 2 + rest;
}

// As a polynomial of x, s = middle + half x.
static void move_terms(double *terms, unsigned degree, double middle, double half)
{
    double power = 1.0;
    for (unsigned i = 0; i <= degree; i++) {
        for (unsigned k = degree; k-- > i;) {
            terms[k] += middle * terms[k + 1];
        }
    }
    for (unsigned i = 1; i <= degree; i++) {
        power *= half;
        terms[i] *= power;
    }
}

static void move_seen(Seen *seen, double middle, double half)
{
    double cross[3][SWEEP_DEGREE + 1];
    for (unsigned i = 0; i <= seen->degree; i++) {
        cross[0][i] = seen->cross[i].x;
        cross[1][i] = seen->cross[i].y;
        cross[2][i] = seen->cross[i].z;
    }
    for (int axis = 0; axis < 3; axis++) {
        move_terms(cross[axis], seen->degree, middle, half);
    }
    for (unsigned i = 0; i <= seen->degree; i++) {
        seen->cross[i] = vec3(cross[0][i], cross[1][i], cross[2][i]);
    }
    move_terms(seen->along, seen->degree, middle, half);
    move_terms(seen->radius, seen->degree, middle, half);
}

// 4 F a'² - F'².
static void set_places(const Seen *seen, Polynomial *p)
{
    double f[FORM_DEGREE + 1], rise[SWEEP_DEGREE], squares[2 * SWEEP_DEGREE - 1] = {0.0}, sizes[PLACES_DEGREE + 1];
    unsigned degree = seen->degree, form = 2 * degree;
    form_of(seen, f);
    p->degree = form + 2 * (degree - 1);
    p->refine = NULL;
    p->value = NULL;
    for (unsigned i = 0; i <= p->degree; i++) {
        p->terms[i] = sizes[i] = 0.0;
    }
    for (unsigned i = 0; i < degree; i++) {
        rise[i] = (i + 1.0) * seen->along[i + 1];
    }
    for (unsigned i = 0; i < degree; i++) {
        for (unsigned j = 0; j < degree; j++) {
            squares[i + j] += 4.0 * rise[i] * rise[j];
        }
    }
    for (unsigned i = 0; i <= form; i++) {
        for (unsigned j = 0; j <= 2 * (degree - 1); j++) {
            double term = f[i] * squares[j];
            p->terms[i + j] += term;
            sizes[i + j] += fabs(term);
        }
    }
    for (unsigned i = 1; i <= form; i++) {
        for (unsigned j = 1; j <= form; j++) {
            double term = (double)(i * j) * f[i] * f[j];
            p->terms[i + j - 2] -= term;
            sizes[i + j - 2] += fabs(term);
        }
    }
    for (unsigned i = 0; i <= p->degree; i++) {
        p->sizes[i] = sizes[i];
        p->errors[i] = 0x1p-47 * sizes[i];
    }
}

// The part of the line in the ball at x.
static void try_ball(const Seen *seen, double x, double *low, double *high)
{
    unsigned i = seen->degree;
    Vec3 cross = seen->cross[i];
    double along = seen->along[i], radius = seen->radius[i];
    while (i-- > 0) {
        cross = vec3_add_scaled(seen->cross[i], x, cross);
        along = seen->along[i] + x * along;
        radius = seen->radius[i] + x * radius;
    }
    double half = sqrt(greater_of(seen->line->square * radius * radius - vec3_length_squared(cross), 0.0));
    *low = less_of(*low, along - half);
    *high = greater_of(*high, along + half);
}

// All balls from one s to another have some of the line.
static void cover(const Seen *whole, double from, double to, Covered *covered)
{
    Polynomial p;
    Seen seen = *whole;
    double places[2 * PLACES_DEGREE], low = (double)INFINITY, high = -(double)INFINITY;
    const Line *line = seen.line;
    move_seen(&seen, 0.5 * (from + to), 0.5 * (to - from));
    set_places(&seen, &p);
    unsigned count = roots_and_turns(&p, -1.0, 1.0, places);
    try_ball(&seen, -1.0, &low, &high);
    try_ball(&seen, 1.0, &low, &high);
    for (unsigned i = 0; i < count; i++) {
        try_ball(&seen, places[i], &low, &high);
    }
    add_interval(covered, (line->t_near + low / line->square) * line->scale,
                 (line->t_near + high / line->square) * line->scale);
}

static void segment_cover(const Line *line, const SweepSegment *segment, unsigned degree, Covered *covered)
{
    Polynomial p;
    Seen seen = {.line = line, .terms = segment->terms, .degree = degree};
    double roots[FORM_DEGREE], from = -0.5;
    int sign;
    see(&seen);
    form_of(&seen, p.terms);
    set_errors(&seen, &p);
    int all = sign_of_all(p.terms, p.errors, 2 * degree);
    if (all != 0) {
        if (all > 0) {
            cover(&seen, -0.5, 0.5, covered);
        }
        return;
    }
    p.degree = 2 * degree;
    p.refine = refine;
    p.value = NULL;
    p.owner = &seen;
    roots_start(&p);
    unsigned count = roots_find(&p, -0.5, 0.5, roots, &sign);
    bool is_covering = sign > 0;
    for (unsigned i = 0; i <= count; i++) {
        double to = i < count ? roots[i] : 0.5;
        if (is_covering) {
            cover(&seen, from, to, covered);
        }
        is_covering = !is_covering;
        from = to;
    }
}

unsigned sweep_intervals(const double *list, const Ray *ray, SideLeft left, RayInterval *intervals)
{
    Sweep sweep = sweep_of(list);
    Line line = line_of(ray);
    Crossing ends[2 * SWEEP_PIECES_MOST * sweep.segment_count];
    Covered covered = {ends, 0};
    for (uint32_t i = 0; i < sweep.segment_count; i++) {
        if (i % SWEEP_GROUP == 0 && !is_near(&line, &sweep.groups[i / SWEEP_GROUP])) {
            i += SWEEP_GROUP - 1;
        } else if (is_near(&line, &sweep.segments[i].box)) {
            segment_cover(&line, &sweep.segments[i], sweep.degree, &covered);
        }
    }
    return crossings_intervals(covered.ends, covered.count, left, intervals);
}

// ---- surfaces

Vec3 sweep_gradient(const double *list, Vec3 point)
{
    Sweep sweep = sweep_of(list);
    SweepBall ball;
    sweep_nearest(&sweep, point, &ball);
    Vec3 from = vec3_sub(point, ball.middle);
    return vec3_equal(from, vec3(0.0, 0.0, 0.0)) ? vec3(1.0, 0.0, 0.0) : vec3_scale(1.0 / vec3_max_abs(from), from);
}

Vec3 sweep_point(const double *list, Vec3 point)
{
    Sweep sweep = sweep_of(list);
    SweepBall ball;
    sweep_nearest(&sweep, point, &ball);
    Vec3 from = vec3_sub(point, ball.middle);
    double distance = sqrt(vec3_length_squared(from));
    return distance > 0.0 ? vec3_add_scaled(ball.middle, fabs(ball.radius) / distance, from) : point;
}
