// Which of several surfaces on a ray is met first, where rounding may put their roots in another order.
//
// A root t that may be off by e has its true place in t / (1 + e/t) .. t + e: relative errors, since a surface far
// behind is known as badly as it is far. Let `limit` be the least upper end of all spans. Whatever begins later is
// behind something, for certain. What begins no later may be the first, or coincide with it, and of these the surface
// that was declared first is seen.
//
// So what is seen depends on the set of roots alone, not on their order, and no root that begins beyond `limit`
// matters, however far `limit` has yet to come down: a tree may leave out whatever it likes of those. One pass finds
// `limit` and mostly the surface with it. It may miss that where a surface gave way to one declared before it that
// turned out to begin too late itself. Then `is_torn` is set, and the same roots are offered once more from that limit:
// it stays as it is, being the least, so every root that begins before it is compared with all others.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_FOREMOST_H
#define TRACE_FOREMOST_H

#include <math.h>

#include "base/attributes.h"
#include "trace/trace.h"

// Where a root may be, but for rounding.
typedef struct RootSpan {
    double from, to;
} RootSpan;

typedef struct Foremost {
    Hit hit; // shape = SHAPE_NONE: none
    uint32_t order;
    bool is_torn;
    double from;   // where hit.t may be at the least; INFINITY: no hit
    double limit;  // the least `to` of all
    double beaten; // the least `from` of those that gave way to one declared before them
    double end;    // of the ray's way: what may lie beyond is not met
} Foremost;

// Up to where a surface is met on a way to t_max for certain. Its length comes from three rounded differences, a sum of
// squares and a root, and its direction is rounded twice more: what its end lies on but for that is not met, so that a
// light on a surface shines.
RT_ALWAYS_INLINE double way_end(double t_max)
{
    return t_max * (1.0 - 8.0 * 0x1p-53);
}

RT_ALWAYS_INLINE RootSpan root_span(double t, double error)
{
    return error > 0.0 ? (RootSpan){t * (t / (t + error)), t + error} : (RootSpan){t, t};
}

// Begins with the nearest of what is known without an error, whose shape may be SHAPE_NONE, on a way to t_max.
RT_ALWAYS_INLINE Foremost foremost_start(const Hit *known, uint32_t order, double t_max)
{
    bool is_met = known->shape != SHAPE_NONE;
    double end = way_end(t_max);
    return (Foremost){.hit = *known,
                      .order = order,
                      .from = is_met ? known->t : (double)INFINITY,
                      .limit = is_met ? known->t : end,
                      .beaten = (double)INFINITY,
                      .end = end};
}

// Begins once more, with the same, after all was offered. It is not torn again, whatever is offered, for `beaten` is no
// number: the limit is the least already, and no error of a span can make this endless.
RT_ALWAYS_INLINE Foremost foremost_restart(const Hit *known, uint32_t order, double t_max, double limit)
{
    Foremost first = foremost_start(known, order, t_max);
    first.limit = limit;
    first.beaten = (double)NAN;
    return first;
}

// Whether a root may be seen.
RT_ALWAYS_INLINE bool foremost_admits(const Foremost *first, RootSpan span)
{
    return span.from <= first->limit && span.to <= first->end;
}

// Offers a root 0 < t < INFINITY.
RT_ALWAYS_INLINE void foremost_offer(Foremost *first, double t, RootSpan span, ShapeId shape, bool inside,
                                     uint32_t order)
{
    if (!foremost_admits(first, span)) {
        return;
    }
    first->limit = span.to < first->limit ? span.to : first->limit;
    if (first->from <= first->limit) {
        bool is_before = order < first->order || (order == first->order && shape < first->hit.shape);
        double beaten = is_before ? first->from : span.from;
        first->beaten = beaten < first->beaten ? beaten : first->beaten;
        if (!is_before) {
            return;
        }
    } else if (first->beaten <= first->limit) {
        first->is_torn = true;
    }
    first->hit = (Hit){t, shape, inside};
    first->order = order;
    first->from = span.from;
}

#endif
