// Segments from balls; the nearest ball by the derivative of its power, whose roots lie between those of its own
// derivative.
//
// SPDX-License-Identifier: MIT
#include "scene/sweep.h"

#include <math.h>

enum {
    BALL = sizeof(SweepBall) / sizeof(double),
    BOX = sizeof(SweepBox) / sizeof(double),
    SEGMENT = sizeof(SweepSegment) / sizeof(double),
    STEPS_MOST = 100,
};

static uint32_t segments_of(SweepCurve curve, uint32_t ball_count)
{
    return ball_count - (curve == SWEEP_LINEAR ? 1 : 3);
}

static uint32_t groups_of(uint32_t segment_count)
{
    return (segment_count + SWEEP_GROUP - 1) / SWEEP_GROUP;
}

Sweep sweep_of(const double *list)
{
    Sweep sweep = {.curve = (SweepCurve)list[0], .ball_count = (uint32_t)list[1]};
    sweep.degree = sweep.curve == SWEEP_LINEAR ? 1 : SWEEP_DEGREE;
    sweep.segment_count = segments_of(sweep.curve, sweep.ball_count);
    const double *at = list + SWEEP_HEAD;
    sweep.balls = (const SweepBall *)(const void *)at;
    at += (size_t)BALL * sweep.ball_count;
    sweep.segments = (const SweepSegment *)(const void *)at;
    sweep.groups = (const SweepBox *)(const void *)(at + (size_t)SEGMENT * sweep.segment_count);
    return sweep;
}

size_t sweep_list_count(SweepCurve curve, uint32_t ball_count)
{
    uint32_t segments = segments_of(curve, ball_count);
    return SWEEP_HEAD + (size_t)BALL * ball_count + (size_t)SEGMENT * segments + (size_t)BOX * groups_of(segments);
}

// ---- segments

static SweepBall mixed(const SweepBall *p, double a, double b, double c, double d)
{
    const double share[4] = {a, b, c, d};
    SweepBall sum = {{0.0, 0.0, 0.0}, 0.0};
    for (int i = 0; i < 4; i++) {
        sum.middle = vec3_add_scaled(sum.middle, share[i], p[i].middle);
        sum.radius += share[i] * p[i].radius;
    }
    return sum;
}

static SweepBall times(SweepBall a, double s)
{
    return (SweepBall){vec3_scale(s, a.middle), s * a.radius};
}

// As polynomials about the middle of a segment.
static void set_terms(SweepCurve curve, const SweepBall *p, SweepBall *terms)
{
    for (int i = 0; i <= SWEEP_DEGREE; i++) {
        terms[i] = (SweepBall){{0.0, 0.0, 0.0}, 0.0};
    }
    switch (curve) {
    case SWEEP_LINEAR:
        terms[0] = (SweepBall){vec3_scale(0.5, vec3_add(p[0].middle, p[1].middle)), 0.5 * (p[0].radius + p[1].radius)};
        terms[1] = (SweepBall){vec3_sub(p[1].middle, p[0].middle), p[1].radius - p[0].radius};
        break;
    case SWEEP_B_SPLINE:
        terms[0] = times(mixed(p, 1.0, 23.0, 23.0, 1.0), 1.0 / 48.0);
        terms[1] = times(mixed(p, -1.0, -5.0, 5.0, 1.0), 1.0 / 8.0);
        terms[2] = times(mixed(p, 1.0, -1.0, -1.0, 1.0), 1.0 / 4.0);
        terms[3] = times(mixed(p, -1.0, 3.0, -3.0, 1.0), 1.0 / 6.0);
        break;
    case SWEEP_CUBIC:
    case SWEEP_CURVES:
        terms[0] = times(mixed(p, -1.0, 9.0, 9.0, -1.0), 1.0 / 16.0);
        terms[1] = times(mixed(p, 1.0, -11.0, 11.0, -1.0), 1.0 / 8.0);
        terms[2] = times(mixed(p, 1.0, -1.0, -1.0, 1.0), 1.0 / 4.0);
        terms[3] = times(mixed(p, -1.0, 3.0, -3.0, 1.0), 1.0 / 2.0);
        break;
    }
}

static SweepBox box_of(const SweepBall *ball)
{
    double radius = fabs(ball->radius);
    Vec3 half = {radius, radius, radius};
    return (SweepBox){vec3_sub(ball->middle, half), vec3_add(ball->middle, half)};
}

static SweepBox box_with(SweepBox a, SweepBox b)
{
    return (SweepBox){vec3_least(a.low, b.low), vec3_greatest(a.high, b.high)};
}

// Of the control points, and a little more for what rounding adds.
static SweepBox segment_box(const SweepBall *t, unsigned degree)
{
    SweepBox box;
    if (degree == 1) {
        SweepBall first = mixed(t, 1.0, -0.5, 0.0, 0.0), last = mixed(t, 1.0, 0.5, 0.0, 0.0);
        box = box_with(box_of(&first), box_of(&last));
    } else {
        SweepBall control[4] = {mixed(t, 1.0, -0.5, 0.25, -0.125), mixed(t, 1.0, -1.0 / 6.0, -1.0 / 12.0, 0.125),
                                mixed(t, 1.0, 1.0 / 6.0, -1.0 / 12.0, -0.125), mixed(t, 1.0, 0.5, 0.25, 0.125)};
        box = box_of(&control[0]);
        for (int i = 1; i < 4; i++) {
            box = box_with(box, box_of(&control[i]));
        }
    }
    double margin = 0x1p-46 * fmax(vec3_max_abs(box.low), vec3_max_abs(box.high));
    Vec3 more = {margin, margin, margin};
    return (SweepBox){vec3_sub(box.low, more), vec3_add(box.high, more)};
}

void sweep_complete(double *list, SweepCurve curve, uint32_t ball_count)
{
    list[0] = curve;
    list[1] = ball_count;
    Sweep sweep = sweep_of(list);
    SweepSegment *segments = (SweepSegment *)(void *)(list + SWEEP_HEAD + (size_t)BALL * ball_count);
    SweepBox *groups = (SweepBox *)(void *)((double *)(void *)segments + (size_t)SEGMENT * sweep.segment_count);
    for (uint32_t i = 0; i < sweep.segment_count; i++) {
        set_terms(curve, sweep.balls + i, segments[i].terms);
        segments[i].box = segment_box(segments[i].terms, sweep.degree);
        SweepBox *group = &groups[i / SWEEP_GROUP];
        *group = i % SWEEP_GROUP == 0 ? segments[i].box : box_with(*group, segments[i].box);
    }
}

SweepBox sweep_bounds(const Sweep *sweep)
{
    SweepBox box = sweep->groups[0];
    for (uint32_t i = 1; i < groups_of(sweep->segment_count); i++) {
        box = box_with(box, sweep->groups[i]);
    }
    return box;
}

SweepBox sweep_given_box(const Sweep *sweep)
{
    SweepBox box = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    for (uint32_t i = 0; i < sweep->ball_count; i++) {
        SweepBall ball = sweep->balls[i];
        ball.radius *= sweep->curve == SWEEP_CUBIC ? 2.0 : 1.0;
        box = i == 0 ? box_of(&ball) : box_with(box, box_of(&ball));
    }
    return box;
}

SweepBall sweep_ball(const Sweep *sweep, uint32_t segment, double s)
{
    const SweepBall *terms = sweep->segments[segment].terms;
    SweepBall ball = terms[sweep->degree];
    for (unsigned i = sweep->degree; i-- > 0;) {
        ball.middle = vec3_add_scaled(terms[i].middle, s, ball.middle);
        ball.radius = terms[i].radius + s * ball.radius;
    }
    return ball;
}

// ---- the nearest ball

enum { POWER_DEGREE = 2 * SWEEP_DEGREE };

static double value_at(const double *c, unsigned degree, double s)
{
    double value = c[degree];
    for (unsigned i = degree; i-- > 0;) {
        value = value * s + c[i];
    }
    return value;
}

static double root_between(const double *c, const double *slope, unsigned degree, double low, double high)
{
    bool rises = value_at(c, degree, high) > 0.0;
    double s = 0.5 * (low + high), before = high - low;
    for (int i = 0; i < STEPS_MOST && low < s && s < high; i++) {
        double value = value_at(c, degree, s), next = s - value / value_at(slope, degree - 1, s),
               change = fabs(next - s);
        if (value == 0.0 || change <= 0x1p-54) {
            return s;
        }
        *((value > 0.0) == rises ? &high : &low) = s;
        bool is_slow = !(next > low && next < high) || !(2.0 * change < before);
        before = is_slow ? high - low : change;
        s = is_slow ? 0.5 * (low + high) : next;
    }
    return s;
}

// Places of [-1/2, 1/2] where a polynomial goes through 0, in order. Recursive, as deep as its degree.
static unsigned roots_of(const double *c, unsigned degree, double *roots)
{
    double slope[POWER_DEGREE], turns[POWER_DEGREE];
    if (degree == 0) {
        return 0;
    }
    for (unsigned i = 0; i < degree; i++) {
        slope[i] = (i + 1.0) * c[i + 1];
    }
    unsigned turn_count = roots_of(slope, degree - 1, turns), count = 0;
    double from = -0.5, value = value_at(c, degree, from);
    for (unsigned i = 0; i <= turn_count; i++) {
        double to = i < turn_count ? turns[i] : 0.5, next = value_at(c, degree, to);
        if ((value < 0.0) != (next < 0.0)) {
            roots[count++] = root_between(c, slope, degree, from, to);
        }
        from = to;
        value = next;
    }
    return count;
}

static double power_of(const SweepBall *ball, Vec3 p)
{
    Vec3 from = vec3_sub(ball->middle, p);
    double distance = sqrt(vec3_length_squared(from)), radius = fabs(ball->radius);
    return (distance - radius) * (distance + radius);
}

static void try_place(const Sweep *sweep, uint32_t i, double s, Vec3 p, double *least, SweepBall *nearest)
{
    SweepBall ball = sweep_ball(sweep, i, s);
    double power = power_of(&ball, p);
    if (power < *least) {
        *least = power;
        *nearest = ball;
    }
}

static void segment_nearest(const Sweep *sweep, uint32_t i, Vec3 p, double *least, SweepBall *nearest)
{
    const SweepBall *t = sweep->segments[i].terms;
    double slope[POWER_DEGREE] = {0.0}, roots[POWER_DEGREE];
    unsigned degree = 2 * sweep->degree;
    for (unsigned a = 0; a <= sweep->degree; a++) {
        Vec3 from = a == 0 ? vec3_sub(t[0].middle, p) : t[a].middle;
        for (unsigned b = 1; b <= sweep->degree; b++) {
            slope[a + b - 1] += b * (vec3_dot(from, t[b].middle) - t[a].radius * t[b].radius);
        }
    }
    unsigned count = roots_of(slope, degree - 1, roots);
    try_place(sweep, i, -0.5, p, least, nearest);
    try_place(sweep, i, 0.5, p, least, nearest);
    for (unsigned k = 0; k < count; k++) {
        try_place(sweep, i, roots[k], p, least, nearest);
    }
}

// The square of how far a point is from a box.
static double box_distance2(const SweepBox *box, Vec3 p)
{
    double x = fmax(fmax(box->low.x - p.x, p.x - box->high.x), 0.0);
    double y = fmax(fmax(box->low.y - p.y, p.y - box->high.y), 0.0);
    double z = fmax(fmax(box->low.z - p.z, p.z - box->high.z), 0.0);
    return x * x + y * y + z * z;
}

// A ball in a box that a point is outside of is as far from it as the box at least, and its power no less than that
// squared.
double sweep_nearest(const Sweep *sweep, Vec3 p, SweepBall *ball)
{
    double least = (double)INFINITY;
    *ball = sweep->balls[0];
    for (uint32_t i = 0; i < sweep->segment_count; i++) {
        if (i % SWEEP_GROUP == 0) {
            double far2 = box_distance2(&sweep->groups[i / SWEEP_GROUP], p);
            if (far2 > 0.0 && far2 >= least) {
                i += SWEEP_GROUP - 1;
                continue;
            }
        }
        double far2 = box_distance2(&sweep->segments[i].box, p);
        if (far2 == 0.0 || far2 < least) {
            segment_nearest(sweep, i, p, &least, ball);
        }
    }
    return least;
}
