// Some rays against a solid of the kinds whose function along a line is convex, concave between two places at most, and
// convex again, and above 0 far out: tori and closed surfaces of order 4. Part of spheres_kernel.c.
//
// From outside Newton's steps come to the first root of a convex piece without passing it, or to where the function
// rises. In the concave piece there is a root if the function is below 0 at its end, and the steps begin there. A sign
// counts only if it is certain whatever rounding has done to the line; a root only if the last steps show that it is
// one by itself. All other rays (grazing ones, from within) are not certain: they are asked one by one, by the solid's
// class.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_CURVE_LANES_H
#define TRACE_CURVE_LANES_H

#include "trace/blob_lanes.h"
#include "trace/quartic_lanes.h"
#include "trace/torus_lanes.h"

enum { CURVE_STEPS_MOST = 14 };

typedef struct CurveLanes {
    PrimitiveKind kind; // a constant of the caller
    LineLanes line;
    TorusLanes torus;
    QuarticLanes quartic;
} CurveLanes;

RT_ALWAYS_INLINE LinePlace curve_lanes_at(const CurveLanes *curve, Doubles s)
{
    return curve->kind == PRIMITIVE_TORUS ? torus_lanes_at(&curve->torus, s) : quartic_lanes_at(&curve->quartic, s);
}

// Where Newton's steps of some lines are: which take part yet, and which have come to a root, past their piece without
// one, or to where nothing is certain.
typedef struct CurveSteps {
    Doubles s;
    DoublesMask open, found, passed, uncertain;
} CurveSteps;

// `forward`: from the outside of a convex piece, which ends at `end`; the others in the concave one, from its end.
RT_ALWAYS_INLINE void curve_lanes_step(const CurveLanes *curve, Doubles end, DoublesMask forward, CurveSteps *steps)
{
    for (int i = 0; i < CURVE_STEPS_MOST && doubles_mask_bits(steps->open); i++) {
        LinePlace place = curve_lanes_at(curve, steps->s);
        Doubles next = steps->s - place.value / place.slope, change = doubles_abs(next - steps->s);
        DoublesMask falls = place.slope<-place.slope_room, rises = place.slope> place.slope_room;
        DoublesMask is_done = falls & (change < 0x1p-21 * curve->line.size);
        DoublesMask is_past = forward & ~is_done & (rises | (falls & (next > end)));
        DoublesMask is_bad = ~place.is_certain | (~falls & ~is_past) | (is_past & ~(place.value > place.room));
        steps->uncertain |= steps->open & is_bad;
        steps->found |= steps->open & is_done & ~is_bad;
        steps->passed |= steps->open & is_past & ~is_bad;
        steps->s = doubles_choose(steps->open & falls, next, steps->s);
        steps->open &= ~(is_bad | is_done | is_past);
    }
    steps->uncertain |= steps->open;
    steps->open = (DoublesMask){0};
}

// Of lines that have no root before the concave piece, or start in it, where they are outside.
RT_ALWAYS_INLINE void curve_lanes_turn(const CurveLanes *curve, DoublesMask asked, CurveSteps *steps)
{
    const LineLanes *line = &curve->line;
    LinePlace place = curve_lanes_at(curve, line->second);
    DoublesMask is_out = place.value > 0x1p8 * place.room, is_in = place.value < -0x1p8 * place.room;
    DoublesMask is_beyond = line->second > line->high; // and outside there
    steps->s = doubles_choose(asked, line->second, steps->s);
    steps->passed |= asked & is_beyond;
    steps->uncertain |= asked & ~is_beyond & ~is_out & ~is_in;
    steps->open = asked & ~is_beyond & (is_out | is_in);
    curve_lanes_step(curve, line->high, is_out, steps);
}

// `starts`: all start on the primitive, which is a curve, and leave it. False when all of `asked` are missed; nothing
// else is set then.
RT_ALWAYS_INLINE bool curve_lanes_first(const PreparedPrimitive *primitive, PrimitiveKind kind, bool starts,
                                        const Doubles f[3], const Doubles d[3], unsigned asked, CurveFirst *found)
{
    CurveLanes curve;
    LineLanes *line = &curve.line;
    if (kind == PRIMITIVE_BLOB) {
        return blob_lanes_first(primitive->list.items, starts, f, d, asked, found);
    }
    const DoublesMask none = {0};
    curve.kind = kind;
    if (kind == PRIMITIVE_TORUS) {
        torus_lanes_set(primitive, f, d, &curve.torus, line);
    } else {
        quartic_lanes_set(primitive, starts, f, d, &curve.quartic, line);
    }
    DoublesMask is_near = (line->is_near & ~(line->high < line->start - line->unit)) | ~line->is_certain;
    if (!(asked & doubles_mask_bits(is_near))) {
        return false;
    }
    Doubles low = starts ? line->start : line->low;
    LinePlace place = curve_lanes_at(&curve, low);
    DoublesMask is_concave = line->bends & (low > line->first) & (low < line->second);
    DoublesMask turns = line->bends & (low <= line->first), uncertain = ~line->is_certain | ~place.is_certain;
    CurveSteps steps = {low, none, none, none, none};
    if (starts) { // the function is 0; the slope says which way it goes
        uncertain |= ~(place.slope > place.slope_room);
        steps.passed = is_near & ~uncertain & ~is_concave;
    } else {
        uncertain |= ~((place.value > place.room) & (low > line->start + line->unit));
        steps.open = is_near & ~uncertain & ~is_concave;
        curve_lanes_step(&curve, doubles_choose(turns, doubles_min(line->first, line->high), line->high), ~none,
                         &steps);
    }
    DoublesMask to_turn = is_near & ~uncertain & ((steps.passed & turns) | is_concave);
    DoublesMask missed = ~is_near | (steps.passed & ~turns);
    if (doubles_mask_bits(to_turn)) {
        steps.passed = none;
        curve_lanes_turn(&curve, to_turn, &steps);
        missed |= steps.passed;
    }
    found->possible = asked & ~doubles_mask_bits(missed);
    if (!found->possible) {
        return false;
    }
    DoublesMask is_root = kind == PRIMITIVE_TORUS
                              ? torus_lanes_refine(&curve.torus, line, f, d, steps.s, &found->root, &found->along)
                              : quartic_lanes_refine(&curve.quartic, line, f, steps.s, &found->root, &found->along);
    found->certain = doubles_mask_bits(steps.found & is_root);
    return true;
}

#endif
