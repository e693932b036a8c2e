// Where some rays come into a blob, in its own space: part of curve_lanes.h.
//
// From where the first field begins a ray goes ahead by steps over which the sum of the fields stays below the
// threshold for certain: its slope is known, and no component bends it up by more than a number that is known for the
// stretch ahead. A component that a line does not come to adds nothing to any sum, so it does not matter which others a
// vector of rays comes to. Steps end at the root, where slope and bends show that it is one by itself; or where the
// components ahead cannot come up to the threshold any more. All else (grazing rays, from within) is left undecided.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_BLOB_LANES_H
#define TRACE_BLOB_LANES_H

#include "scene/blob.h"
#include "trace/line_lanes.h"

#include "trace/lane_doubles.h"
#include "trace/blob_walk.inc"

enum { BLOB_NEAR_MOST = 20, BLOB_STEPS_MOST = 24 };

// What some lines are in the space of a component: its field is strength (1 - d²)² between `enter` and `leave`, with
// 1 - d² = depth - square (t - middle)², less the square of how far the line is beyond an end of a rod along it.
typedef struct BlobNear {
    const BlobComponent *component;
    Doubles square, middle, depth, enter, leave; // depth: 0 where it is not met
    Doubles steep;                               // the square of the direction
    Doubles z, rise;                             // of a rod
} BlobNear;

typedef struct BlobLanes {
    BlobNear near[BLOB_NEAR_MOST];
    unsigned count;
    Doubles threshold;
    Doubles first, last;      // the least `enter` and the greatest `leave`
    Doubles room, slope_room; // the sum of the fields, and its slope, are known to so much
    Doubles bends;            // no second derivative is greater by size
    DoublesMask is_told;
} BlobLanes;

// ---- the components that are near

// Takes what of the lines is within 1 of a place on a rod's axis into what is near the rod.
RT_ALWAYS_INLINE void blob_lanes_end(BlobNear *near, const Doubles o[3], const Doubles d[3], double height,
                                     DoublesMask *is_met)
{
    const Doubles zero = doubles_splat(0.0);
    const Doubles from[3] = {o[0], o[1], o[2] - height};
    Doubles middle = -(from[0] * d[0] + from[1] * d[1] + from[2] * d[2]) / near->steep, least2 = zero;
    for (int axis = 0; axis < 3; axis++) {
        Doubles at = from[axis] + middle * d[axis];
        least2 += at * at;
    }
    DoublesMask is_there = least2 < 1.0;
    Doubles half = doubles_sqrt(doubles_choose(is_there, 1.0 - least2, zero) / near->steep);
    near->enter = doubles_choose(is_there, doubles_min(near->enter, middle - half), near->enter);
    near->leave = doubles_choose(is_there, doubles_max(near->leave, middle + half), near->leave);
    *is_met |= is_there;
}

// What of the lines is near a rod: within the cylinder, which they are in between `enter` and `leave` where they meet
// it, between its ends, and within the balls there. No more than that, which is within the component's box: whether a
// line is near does not depend on which boxes others come to.
RT_ALWAYS_INLINE void blob_lanes_rod(BlobNear *near, const Doubles o[3], const Doubles d[3], DoublesMask *is_met)
{
    const Doubles far = doubles_splat((double)INFINITY);
    const double height = near->component->height;
    Doubles rise = doubles_choose(doubles_abs(d[2]) > 0x1p-400, d[2], doubles_splat(0x1p-400));
    Doubles first = (0.0 - o[2]) / rise, second = (height - o[2]) / rise;
    near->z = o[2];
    near->rise = d[2];
    near->steep += d[2] * d[2];
    near->enter = doubles_max(near->enter, doubles_min(first, second));
    near->leave = doubles_min(near->leave, doubles_max(first, second));
    *is_met &= near->enter < near->leave;
    near->enter = doubles_choose(*is_met, near->enter, far);
    near->leave = doubles_choose(*is_met, near->leave, -far);
    blob_lanes_end(near, o, d, 0.0, is_met);
    blob_lanes_end(near, o, d, height, is_met);
}

// What a component adds to what is known of all; false when no line comes to it.
RT_ALWAYS_INLINE bool blob_lanes_add(const BlobComponent *component, const Doubles f[3], const Doubles d[3],
                                     BlobLanes *blob)
{
    const double(*m)[3] = component->to_own;
    const Doubles zero = doubles_splat(0.0), far = doubles_splat((double)INFINITY);
    const bool is_rod = component->is_rod != 0.0;
    Doubles own[3], along[3], least2 = zero, dot = zero, square = zero, size = zero, most = zero;
    BlobNear *near = &blob->near[blob->count];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        own[axis] = f[0] * m[0][axis] + f[1] * m[1][axis] + f[2] * m[2][axis] + m[3][axis];
        along[axis] = d[0] * m[0][axis] + d[1] * m[1][axis] + d[2] * m[2][axis];
        size = doubles_max(size, doubles_abs(own[axis]));
        most = doubles_max(most, doubles_abs(along[axis]));
    }
    for (int axis = 0; axis < (is_rod ? 2 : 3); axis++) {
        dot += own[axis] * along[axis];
        square += along[axis] * along[axis];
    }
    DoublesMask has_middle = square > 0.0;
    near->component = component;
    near->square = square;
    near->middle = doubles_choose(has_middle, -dot / square, zero);
    for (int axis = 0; axis < (is_rod ? 2 : 3); axis++) {
        Doubles at = own[axis] + near->middle * along[axis];
        least2 += at * at;
    }
    Doubles depth = 1.0 - least2;
    DoublesMask is_met = depth > 0.0;
    Doubles half = doubles_choose(has_middle, doubles_sqrt(doubles_choose(is_met, depth, zero) / square), far);
    near->enter = near->middle - half;
    near->leave = near->middle + half;
    near->steep = square;
    if (is_rod) {
        blob_lanes_rod(near, own, along, &is_met);
        size += most * doubles_max(doubles_abs(near->enter), doubles_abs(near->leave));
    }
    is_met &= near->leave > 0.0;
    if (!doubles_mask_bits(is_met)) {
        return false;
    }
    size += 1.0 + doubles_abs(near->middle) * most;
    Doubles weight = doubles_choose(is_met, fabs(component->strength) * size, zero);
    near->depth = doubles_choose(is_met, depth, zero);
    near->enter = doubles_choose(is_met, near->enter, far);
    near->leave = doubles_choose(is_met, near->leave, -far);
    blob->first = doubles_min(blob->first, near->enter);
    blob->last = doubles_max(blob->last, near->leave);
    blob->room += weight;
    blob->slope_room += weight * doubles_sqrt(near->steep);
    blob->bends += doubles_choose(is_met, 8.0 * fabs(component->strength) * near->steep, zero);
    return true;
}

// False: more components are near than there is room for.
RT_ALWAYS_INLINE bool blob_lanes_gather(const Blob *own, const Doubles f[3], const Doubles d[3], unsigned asked,
                                        BlobLanes *blob)
{
    BlobWalks walk; // not cleared
    blob_walks_start(&walk, own, f, d);
    for (const BlobNode *node; (node = blob_walks_next(&walk, asked)) != NULL;) {
        for (uint32_t i = (uint32_t)node->begin; i < (uint32_t)node->end; i++) {
            if (blob->count == BLOB_NEAR_MOST) {
                return false;
            }
            blob->count += blob_lanes_add(&own->components[i], f, d, blob);
        }
    }
    return true;
}

// ---- the sum at a place

// By the point itself: `value` the sum of the fields less the threshold; what of that rounding may make is `error`.
typedef struct BlobPoint {
    Doubles value, slope, error;
    Doubles gradient; // it is no longer
} BlobPoint;

RT_ALWAYS_INLINE void blob_point_add(const BlobComponent *component, const Doubles p[3], const Doubles d[3],
                                     DoublesMask is_there, BlobPoint *point)
{
    const double(*m)[3] = component->to_own;
    const Doubles zero = doubles_splat(0.0);
    Doubles inner = doubles_splat(1.0), slope = zero;
    double square = 0.0, rows = 0.0, far = 0.0;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        double x = m[0][axis], y = m[1][axis], z = m[2][axis], row = fabs(x) + fabs(y) + fabs(z);
        Doubles own = p[0] * x + p[1] * y + p[2] * z + m[3][axis], along = d[0] * x + d[1] * y + d[2] * z;
        if (axis == 2) {
            own -= doubles_max(zero, doubles_min(own, doubles_splat(component->height)));
        }
        inner -= own * own;
        slope += own * along;
        square += x * x + y * y + z * z;
        rows += row * row;
        far += m[3][axis] * m[3][axis];
    }
    inner = doubles_choose(is_there, doubles_max(inner, zero), zero);
    Doubles share = inner * component->strength, size = doubles_abs(share);
    Doubles reach = doubles_max(doubles_max(doubles_abs(p[0]), doubles_abs(p[1])), doubles_abs(p[2]));
    point->value += share * inner;
    point->slope += -4.0 * share * slope;
    point->gradient += 4.0 * sqrt(square) * size;
    point->error += size * (sqrt(rows) * reach + (sqrt(far) + component->height + 3.0));
}

// Each coordinate of a component's space is off by less than 4 u of the sizes of what it is made of: where 1 - d² is
// above 0, that by 8 u of their length and 3 u, the field by 2 (1 - d²) strength times that, and a sum of so many by
// 25 u of itself. The point's coordinates are off by 2 u of |o| + |t d|, which the gradient is asked about.
RT_ALWAYS_INLINE BlobPoint blob_lanes_point(const BlobLanes *blob, const Doubles f[3], const Doubles d[3], Doubles t)
{
    const Doubles zero = doubles_splat(0.0);
    BlobPoint point = {zero, zero, zero, zero};
    Doubles p[3], far = zero;
    for (int axis = 0; axis < 3; axis++) {
        Doubles step = t * d[axis];
        p[axis] = f[axis] + step;
        far = doubles_max(far, doubles_abs(f[axis]) + doubles_abs(step));
    }
    for (unsigned i = 0; i < blob->count; i++) {
        const BlobNear *near = &blob->near[i];
        DoublesMask is_there = (near->enter <= t) & (near->leave >= t);
        if (doubles_mask_bits(is_there)) {
            blob_point_add(near->component, p, d, is_there, &point);
        }
    }
    point.error = 0x1p-49 * point.error + 0x1p-51 * far * point.gradient;
    return point;
}

// ---- steps

// At a place of each line: the sum of the fields and its slope; what bends it up at most over `window` from there; and
// what the sum of the fields is at most from there on.
typedef struct BlobPlace {
    Doubles value, slope, bend, rest;
} BlobPlace;

RT_ALWAYS_INLINE void blob_near_at(const BlobNear *near, Doubles t, Doubles window, BlobPlace *place)
{
    const Doubles zero = doubles_splat(0.0);
    const double strength = near->component->strength;
    const bool is_rod = near->component->is_rod != 0.0;
    Doubles u = t - near->middle, turn = near->square * u, inner = near->depth - turn * u;
    if (is_rod) {
        Doubles z = near->z + t * near->rise;
        z -= doubles_max(zero, doubles_min(z, doubles_splat(near->component->height)));
        inner -= z * z;
        turn += z * near->rise;
    }
    inner = doubles_max(inner, zero);
    Doubles share = strength * inner, bend;
    place->value += share * inner;
    place->slope -= share * turn;
    DoublesMask is_ahead = (near->leave > t) & (near->enter < t + window);
    if (strength < 0.0) {
        bend = -strength * near->steep;
    } else if (is_rod) {
        bend = 2.0 * strength * near->steep;
        place->rest += doubles_choose(near->leave > t, strength * near->depth * near->depth, zero);
    } else {
        Doubles most = doubles_max(doubles_abs(u), doubles_abs(u + window));
        Doubles peak = doubles_choose(u < zero, near->depth, inner);
        bend = strength * near->square * (3.0 * doubles_min(near->square * most * most, near->depth) - near->depth);
        place->rest += strength * peak * peak;
    }
    place->bend += doubles_choose(is_ahead, bend, zero);
}

RT_ALWAYS_INLINE BlobPlace blob_lanes_at(const BlobLanes *blob, Doubles t, Doubles window)
{
    const Doubles zero = doubles_splat(0.0);
    BlobPlace place = {zero, zero, zero, zero};
    for (unsigned i = 0; i < blob->count; i++) {
        blob_near_at(&blob->near[i], t, window, &place);
    }
    place.slope *= 4.0;
    place.bend *= 4.0;
    return place;
}

// How far a parabola of value -c, slope b and second derivative a stays below 0, at most `window`.
RT_ALWAYS_INLINE Doubles blob_lanes_stride(Doubles c, Doubles b, Doubles a, Doubles window)
{
    const Doubles zero = doubles_splat(0.0);
    Doubles inner = b * b + 2.0 * a * c;
    DoublesMask has_root = inner >= 0.0, rises = b > 0.0;
    Doubles root = doubles_sqrt(doubles_choose(has_root, inner, zero));
    has_root &= rises | (a > 0.0);
    Doubles stride = doubles_choose(rises, 2.0 * c, root - b) / doubles_choose(rises, b + root, a);
    return doubles_choose(has_root, doubles_min(doubles_choose(has_root, stride, zero), window), window);
}

typedef struct BlobSteps {
    Doubles t;
    DoublesMask found, missed;
} BlobSteps;

RT_ALWAYS_INLINE void blob_lanes_go(const BlobLanes *blob, bool starts, unsigned asked, BlobSteps *steps)
{
    const Doubles zero = doubles_splat(0.0);
    DoublesMask open = doubles_bits_mask(asked) & blob->is_told & ~steps->missed;
    Doubles window = 1.0 / doubles_sqrt(blob->bends);
    DoublesMask is_start = (DoublesMask){0} - (int64_t)starts;
    for (int i = 0; i < BLOB_STEPS_MOST && doubles_mask_bits(open); i++) {
        BlobPlace place = blob_lanes_at(blob, steps->t, window);
        Doubles below = blob->threshold - place.value - blob->room, slope = place.slope + blob->slope_room;
        open &= ~is_start | (slope < 0.0); // on the surface the slope says which way it goes
        DoublesMask is_over = (place.rest * (1.0 + 0x1p-30) + blob->room < blob->threshold) | (steps->t > blob->last);
        Doubles rise = place.slope - blob->slope_room, apart = doubles_max(below, zero) + 2.0 * blob->room;
        DoublesMask is_root = ~is_start & (rise > 2.0 * blob->slope_room) & (below > -4.0 * blob->room) & // not inside
                              (blob->bends * apart < 0x1p-20 * rise * rise);
        steps->missed |= open & is_over;
        steps->found |= open & ~is_over & is_root;
        open &= ~is_over & ~is_root & ((below > 0.0) | is_start);
        Doubles bend = place.bend + 0x1p-20 * doubles_abs(place.bend);
        Doubles away = -slope / doubles_max(bend, 0x1p-20 * blob->bends);
        Doubles stride =
            doubles_choose(is_start, doubles_min(away, window), blob_lanes_stride(below, slope, bend, window));
        steps->t = doubles_choose(open, steps->t + stride, steps->t);
        window = 2.0 * stride;
        is_start = (DoublesMask){0};
    }
}

// ---- the whole

// Two of Newton's steps by the points themselves. Returns where what rounding does is as little as blob.c wants it.
RT_ALWAYS_INLINE DoublesMask blob_lanes_refine(const BlobLanes *blob, const Doubles f[3], const Doubles d[3],
                                               Doubles threshold_error, Doubles t, CurveFirst *found)
{
    Doubles length = doubles_max(doubles_max(doubles_abs(d[0]), doubles_abs(d[1])), doubles_abs(d[2]));
    Doubles far = doubles_max(doubles_max(doubles_abs(f[0]), doubles_abs(f[1])), doubles_abs(f[2]));
    DoublesMask is_good = (DoublesMask){0} - 1;
    for (int i = 0; i < 2; i++) {
        BlobPoint point = blob_lanes_point(blob, f, d, t);
        Doubles change = (point.value - blob->threshold) / point.slope;
        is_good &= (point.slope > 0.0) & (blob->bends * doubles_abs(change) < 0x1p-10 * point.slope);
        is_good &= (point.error + threshold_error) * length <= 0x1p-44 * (far + doubles_abs(t) * length) * point.slope;
        t -= change;
        found->along = point.slope / point.gradient;
    }
    found->root = t;
    return is_good;
}

// `starts`: all start on the blob and leave it. False when all of `asked` are missed; nothing else is set then.
static __attribute__((noinline)) bool blob_lanes_first(const double *list, bool starts, const Doubles *f,
                                                       const Doubles *d, unsigned asked, CurveFirst *found)
{
    const Doubles zero = doubles_splat(0.0), far = doubles_splat((double)INFINITY);
    const Blob own = blob_of(list);
    BlobLanes blob; // not cleared
    Doubles threshold_error = zero;
    blob.count = 0;
    blob.first = far;
    blob.last = -far;
    blob.room = blob.slope_room = blob.bends = zero;
    if (!blob_lanes_gather(&own, f, d, asked, &blob)) {
        *found = (CurveFirst){asked, 0, zero, zero};
        return true;
    }
    if (blob.count == 0) {
        return false;
    }
    blob.threshold = doubles_splat(own.threshold);
    if (starts) {
        BlobPoint point = blob_lanes_point(&blob, f, d, zero);
        blob.threshold = point.value;
        threshold_error = point.error;
    }
    blob.room = 0x1p-45 * blob.room + threshold_error + 0x1p-50 * doubles_abs(blob.threshold);
    blob.slope_room *= 0x1p-42;
    BlobSteps steps = {doubles_max(blob.first, zero), {0}, ~(blob.last > 0.0)};
    blob.is_told = (blob.room < 0x1p-20 * blob.threshold) & (blob.bends > 0x1p-900) & (blob.bends < 0x1p900);
    steps.t = starts ? zero : doubles_choose(steps.missed, zero, steps.t);
    blob_lanes_go(&blob, starts, asked, &steps);
    found->possible = asked & ~doubles_mask_bits(steps.missed);
    if (!found->possible) {
        return false;
    }
    DoublesMask is_good = blob_lanes_refine(&blob, f, d, threshold_error, steps.t, found);
    found->certain = doubles_mask_bits(steps.found & is_good & (found->root > 0.0));
    return true;
}

#endif
