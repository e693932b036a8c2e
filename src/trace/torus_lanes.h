// Some rays against a torus, in the torus's own space: part of spheres_kernel.c.
//
// What torus.c says of the line holds here: h is convex, concave between two places, and convex again. From outside
// Newton's steps come to the first root of a convex piece without passing it, or to where h rises; in the concave one
// there is a root if h is negative at its end, and the steps begin there. A sign counts only if it is certain for a
// line that is off by what rounding does to it, and the last step is one in double words of the line as it is given:
// what a step leaves is below 2^-64 of t. All other rays (grazing ones, along the axis, near it, from within) are not
// certain: they are asked by themselves, by torus_intervals.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_TORUS_LANES_H
#define TRACE_TORUS_LANES_H

#include "trace/double_words.h"
#include "trace/simd.h"
#include "trace/torus.h"

enum { TORUS_STEPS_MOST = 12 };

// The lines p + s u, of unit length but for rounding, from about their points nearest to 0; s = (t - t_near) / step.
typedef struct TorusLanes {
    Doubles t_near, step, square, along;
    Doubles across2, s_axis, least2; // rho² = across2 (s - s_axis)² + least2
    Doubles y, rise;                 // of p and u
    Doubles turn3;                   // the cube of rho where h'' is 0
    Doubles unit;                    // far above what rounding moves a line by
    double major, minor;
} TorusLanes;

// h at a place, half of h', and what surely is more than h may be off.
typedef struct TorusPlace {
    Doubles rho, height, slope, room;
} TorusPlace;

RT_ALWAYS_INLINE void torus_lanes_set(TorusLanes *line, double major, double minor, const Doubles f[3],
                                      const Doubles d[3])
{
    Doubles square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    Doubles p[3], u[3];
    line->major = major;
    line->minor = minor;
    line->t_near = -(f[0] * d[0] + f[1] * d[1] + f[2] * d[2]) / square;
    line->step = 1.0 / doubles_sqrt(square);
    for (int axis = 0; axis < 3; axis++) {
        p[axis] = f[axis] + line->t_near * d[axis];
        u[axis] = line->step * d[axis];
    }
    line->square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    line->along = p[0] * u[0] + p[1] * u[1] + p[2] * u[2];
    line->across2 = u[0] * u[0] + u[2] * u[2];
    Doubles moment = p[0] * u[2] - p[2] * u[0];
    line->s_axis = -(p[0] * u[0] + p[2] * u[2]) / line->across2;
    line->least2 = moment * moment / line->across2;
    line->y = p[1];
    line->rise = u[1];
    line->turn3 = major * line->across2 * line->least2 / line->square;
    line->unit = 0x1p-38 * (1.0 + doubles_abs(f[0]) + doubles_abs(f[1]) + doubles_abs(f[2]));
}

RT_ALWAYS_INLINE TorusPlace torus_lanes_at(const TorusLanes *line, Doubles s)
{
    Doubles x = s - line->s_axis, rho = doubles_sqrt(line->across2 * x * x + line->least2);
    Doubles from = rho - line->major, y = line->y + s * line->rise;
    return (TorusPlace){.rho = rho,
                        .height = (from * from - line->minor * line->minor) + y * y,
                        .slope = line->square * s + line->along - line->major * (line->across2 * x / rho),
                        .room = line->unit * (doubles_abs(from) + doubles_abs(y) + line->unit)};
}

// Where a line is near enough to meet the torus; the lines that are not are missed.
RT_ALWAYS_INLINE DoublesMask torus_lanes_near(const TorusLanes *line, Doubles *low, Doubles *high)
{
    double outer = line->major + line->minor;
    Doubles unit = line->unit, least2 = line->y * line->y + line->across2 * line->s_axis * line->s_axis + line->least2;
    Doubles half2 = outer * outer + unit - least2, most = line->minor + unit;
    DoublesMask is_met = half2 > 0.0;
    Doubles half = doubles_sqrt(doubles_choose(is_met, half2, doubles_splat(0.0))) + unit;
    Doubles size = doubles_abs(line->rise), level = doubles_choose(size > 0x1p-60, line->rise, doubles_splat(0x1p-60));
    Doubles first = (-most - line->y) / level, second = (most - line->y) / level;
    *low = doubles_max(-half, doubles_min(first, second) - unit);
    *high = doubles_min(half, doubles_max(first, second) + unit);
    return is_met & (*low < *high);
}

// The positive cube roots of numbers from 0 to 2 or so, to seven digits.
RT_ALWAYS_INLINE Doubles doubles_cube_root(Doubles a)
{
    typedef uint64_t Bits __attribute__((vector_size(8 * DOUBLES)));
    Bits bits = (Bits)a, third = bits >> 2;
    third += third >> 2;
    third += third >> 4;
    third += third >> 8;
    third += third >> 16;
    Doubles root = (Doubles)(third + UINT64_C(0x2a9f789300000000));
    for (int i = 0; i < 3; i++) {
        root = (2.0 * root + a / (root * root)) * (1.0 / 3.0);
    }
    return root;
}

// Where Newton's steps of some lines are, and the lines that take part: `found` and `passed`, which have come to an
// end, `doubtful`, which will not.
typedef struct TorusSteps {
    Doubles s;
    DoublesMask open, found, passed, doubtful;
} TorusSteps;

// `forward`: in a convex piece, from its outside; it ends at `end` or, where `turns`, where h'' is 0.
RT_ALWAYS_INLINE void torus_lanes_step(const TorusLanes *line, Doubles end, DoublesMask turns, DoublesMask forward,
                                       TorusSteps *steps)
{
    for (int i = 0; i < TORUS_STEPS_MOST && doubles_mask_bits(steps->open); i++) {
        TorusPlace place = torus_lanes_at(line, steps->s);
        Doubles next = steps->s - place.height / (2.0 * place.slope), change = doubles_abs(next - steps->s);
        Doubles x = next - line->s_axis, rho2 = line->across2 * x * x + line->least2;
        DoublesMask falls = place.slope<-line->unit, rises = place.slope> line->unit;
        DoublesMask is_done = falls & (change < 0x1p-21);
        DoublesMask turned = turns & ((x > 0.0) | (rho2 * doubles_sqrt(rho2) < line->turn3));
        DoublesMask is_past = forward & (rises | (falls & ((next > end) | turned)));
        DoublesMask is_bad =
            (place.rho < 0x1p-8) | (~falls & ~is_past) | (is_past & ~is_done & (place.height < place.room));
        steps->doubtful |= steps->open & is_bad;
        steps->found |= steps->open & is_done & ~is_bad;
        steps->passed |= steps->open & is_past & ~is_done & ~is_bad;
        steps->s = doubles_choose(steps->open & falls, next, steps->s);
        steps->open &= ~(is_bad | is_done | is_past);
    }
    steps->doubtful |= steps->open;
    steps->open = (DoublesMask){0};
}

// Behind where the first convex piece ends, or where a start lies in the concave one: from the end of that.
RT_ALWAYS_INLINE void torus_lanes_turn(const TorusLanes *line, Doubles high, DoublesMask asked, DoublesMask *missed,
                                       TorusSteps *steps)
{
    Doubles turn = doubles_cube_root(line->turn3), reach2 = turn * turn - line->least2;
    reach2 = doubles_choose(reach2 > 0.0, reach2, doubles_splat(0.0));
    Doubles s = line->s_axis + doubles_sqrt(reach2 / line->across2);
    TorusPlace place = torus_lanes_at(line, s);
    DoublesMask is_out = place.height > 0x1p8 * place.room, is_in = place.height < -0x1p8 * place.room;
    DoublesMask is_beyond = s > high;
    *missed |= asked & is_beyond;
    steps->s = doubles_choose(asked, s, steps->s);
    steps->doubtful |= asked & ~is_beyond & ~is_out & ~is_in;
    steps->open = asked & ~is_beyond & (is_out | is_in);
    torus_lanes_step(line, high, (DoublesMask){0}, is_out, steps);
}

// The last step, in double words. Returns where what it leaves is small enough; n·d there, n as long as the tube is
// thick.
RT_ALWAYS_INLINE DoublesMask torus_lanes_refine(const TorusLanes *line, const Doubles f[3], const Doubles d[3],
                                                Doubles s, Doubles *root, Doubles *along)
{
    const Doubles zero = doubles_splat(0.0), one = doubles_splat(1.0);
    TorusPlace place = torus_lanes_at(line, s);
    DoubleWords t = two_sums(line->t_near, s * line->step);
    DoubleWords x = double_words_along(f[0], d[0], t), y = double_words_along(f[1], d[1], t);
    DoubleWords z = double_words_along(f[2], d[2], t);
    DoubleWords rho = double_words_sqrt(double_words_add(double_words_square(x), double_words_square(z)));
    DoubleWords from = double_words_add(rho, (DoubleWords){doubles_splat(-line->major), zero});
    DoubleWords sum = double_words_add(double_words_square(from), double_words_square(y));
    Doubles minor = doubles_splat(line->minor), minor2 = minor * minor;
    DoubleWords height = double_words_add(sum, (DoubleWords){-minor2, -doubles_product_error(minor, minor, minor2)});
    Doubles slope = doubles_abs(place.slope);
    Doubles change = height.hi / (2.0 * place.slope / line->step), size = doubles_abs(change / line->step);
    t = double_words_add(t, (DoubleWords){-change, zero});
    *root = t.hi;
    *along = slope / line->step;
    Doubles bend =
        doubles_abs(line->square - line->major * line->across2 * line->least2 / (place.rho * place.rho * place.rho));
    Doubles most = 0x1p-64 * doubles_min(doubles_abs(t.hi) / line->step, one) * slope, turn = bend * size;
    return (size < 0x1p-30) & (place.rho >= 0x1p-8) & (turn < 0x1p-10 * slope) & (turn * size < most) &
           (line->unit * size < most);
}

// What is known of some rays: those that may meet the torus ahead, those of which it is certain, and their first roots
// with n·d there, n as long as the tube is thick.
typedef struct TorusFirst {
    unsigned possible, certain;
    Doubles root, along;
} TorusFirst;

// `starts`: all start on the torus and leave it. False when all of `asked` are missed; nothing else is set then. Of a
// torus that goes through itself nothing is certain.
RT_ALWAYS_INLINE bool torus_lanes_first(double major, double minor, bool starts, const Doubles f[3], const Doubles d[3],
                                        unsigned asked, TorusFirst *first)
{
    TorusLanes line;
    Doubles low, high;
    const DoublesMask none = {0};
    if (minor > major) {
        *first = (TorusFirst){asked, 0, doubles_splat(0.0), doubles_splat(1.0)};
        return true;
    }
    torus_lanes_set(&line, major, minor, f, d);
    Doubles start = -line.t_near / line.step;
    DoublesMask doubtful = ~(line.across2 >= 0x1p-16); // along the axis s_axis and least2 may be far off
    DoublesMask is_near = (torus_lanes_near(&line, &low, &high) & ~(high < start - line.unit)) | doubtful;
    if (!(asked & doubles_mask_bits(is_near))) {
        return false;
    }
    low = starts ? start : low;
    TorusPlace place = torus_lanes_at(&line, low);
    DoublesMask is_concave = place.rho * place.rho * place.rho < line.turn3;
    DoublesMask turns = (low < line.s_axis) & (line.least2 * line.least2 * line.least2 < line.turn3 * line.turn3);
    TorusSteps steps = {low, none, none, none, none};
    if (starts) { // h is 0; the slope says which way it goes
        doubtful |= ~(place.slope > line.unit) | (place.rho < 0x1p-8);
        steps.passed = is_near & ~doubtful & ~is_concave;
    } else {
        doubtful |= ~((place.height > place.room) & (low > start + line.unit));
        steps.open = is_near & ~doubtful & ~is_concave;
        torus_lanes_step(&line, high, turns, ~none, &steps);
    }
    DoublesMask to_turn = is_near & ~doubtful & ((steps.passed & turns) | is_concave);
    DoublesMask missed = ~is_near | (steps.passed & ~turns);
    if (doubles_mask_bits(to_turn)) {
        steps.passed = none;
        torus_lanes_turn(&line, high, to_turn, &missed, &steps);
        missed |= steps.passed;
    }
    first->possible = asked & ~doubles_mask_bits(missed);
    if (!first->possible) {
        return false;
    }
    first->certain =
        doubles_mask_bits(steps.found & torus_lanes_refine(&line, f, d, steps.s, &first->root, &first->along));
    return true;
}

#endif
