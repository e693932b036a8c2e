// What a torus is along some rays, in its own space: part of curve_lanes.h.
//
// With rho the distance from the axis, h = (rho - R)² + y² - r², which is convex but between the two places where rho
// is the cube root that torus.c speaks of. Places are known to seven digits: between them and the true ones h is nearly
// straight. Rays are not certain along the axis or next to it, for which s_axis and least2 may be far off.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_TORUS_LANES_H
#define TRACE_TORUS_LANES_H

#include "trace/double_words.h"
#include "trace/line_lanes.h"
#include "trace/torus.h"

// The lines p + s u, of unit length but for rounding, from about their points nearest to 0.
typedef struct TorusLanes {
    Doubles square, along;
    Doubles across2, s_axis, least2; // rho² = across2 (s - s_axis)² + least2
    Doubles y, rise;                 // of p and u
    Doubles unit;                    // far above what rounding moves a line by
    double major, minor;
} TorusLanes;

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

// Where the lines are near enough to meet the torus: within a ball about 0 and between two planes.
RT_ALWAYS_INLINE void torus_lanes_near(const TorusLanes *torus, LineLanes *line)
{
    double outer = torus->major + torus->minor;
    Doubles unit = torus->unit, most = torus->minor + unit;
    Doubles half2 =
        outer * outer + unit - (torus->y * torus->y + torus->across2 * torus->s_axis * torus->s_axis + torus->least2);
    DoublesMask is_met = half2 > 0.0;
    Doubles half = doubles_sqrt(doubles_choose(is_met, half2, doubles_splat(0.0))) + unit;
    Doubles level = doubles_choose(doubles_abs(torus->rise) > 0x1p-60, torus->rise, doubles_splat(0x1p-60));
    Doubles first = (-most - torus->y) / level, second = (most - torus->y) / level;
    line->low = doubles_max(-half, doubles_min(first, second) - unit);
    line->high = doubles_min(half, doubles_max(first, second) + unit);
    line->is_near = is_met & (line->low < line->high);
}

RT_ALWAYS_INLINE void torus_lanes_set(const PreparedPrimitive *primitive, const Doubles f[3], const Doubles d[3],
                                      TorusLanes *torus, LineLanes *line)
{
    Doubles square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], p[3], u[3];
    double major = primitive->data[0].x, minor = primitive->data[0].y;
    line->t_base = -(f[0] * d[0] + f[1] * d[1] + f[2] * d[2]) / square;
    line->step = 1.0 / doubles_sqrt(square);
    for (int axis = 0; axis < 3; axis++) {
        p[axis] = f[axis] + line->t_base * d[axis];
        u[axis] = line->step * d[axis];
    }
    Doubles across2 = u[0] * u[0] + u[2] * u[2], moment = p[0] * u[2] - p[2] * u[0];
    *torus = (TorusLanes){.square = u[0] * u[0] + u[1] * u[1] + u[2] * u[2],
                          .along = p[0] * u[0] + p[1] * u[1] + p[2] * u[2],
                          .across2 = across2,
                          .s_axis = -(p[0] * u[0] + p[2] * u[2]) / across2,
                          .least2 = moment * moment / across2,
                          .y = p[1],
                          .rise = u[1],
                          .unit = 0x1p-38 * (1.0 + doubles_abs(f[0]) + doubles_abs(f[1]) + doubles_abs(f[2])),
                          .major = major,
                          .minor = minor};
    line->unit = torus->unit;
    line->size = 1.0;
    line->is_certain = across2 >= 0x1p-16;
    line->start = -line->t_base / line->step;
    torus_lanes_near(torus, line);
    Doubles turn = doubles_cube_root(major * across2 * torus->least2 / torus->square);
    Doubles reach2 = (turn * turn - torus->least2) / across2;
    line->bends = reach2 > 0.0;
    Doubles reach = doubles_sqrt(doubles_choose(line->bends, reach2, doubles_splat(0.0)));
    line->first = torus->s_axis - reach;
    line->second = torus->s_axis + reach;
}

RT_ALWAYS_INLINE LinePlace torus_lanes_at(const TorusLanes *torus, Doubles s)
{
    Doubles x = s - torus->s_axis, rho = doubles_sqrt(torus->across2 * x * x + torus->least2);
    Doubles from = rho - torus->major, y = torus->y + s * torus->rise;
    return (LinePlace){.value = (from * from - torus->minor * torus->minor) + y * y,
                       .slope = 2.0 * (torus->square * s + torus->along - torus->major * (torus->across2 * x / rho)),
                       .room = torus->unit * (doubles_abs(from) + doubles_abs(y) + torus->unit),
                       .slope_room = 2.0 * torus->unit,
                       .is_certain = rho >= 0x1p-8};
}

// h as double words, of the line as it is given.
RT_ALWAYS_INLINE DoubleWords torus_lanes_height(const TorusLanes *torus, const Doubles f[3], const Doubles d[3],
                                                DoubleWords t)
{
    const Doubles zero = doubles_splat(0.0);
    DoubleWords x = double_words_along(f[0], d[0], t), y = double_words_along(f[1], d[1], t);
    DoubleWords z = double_words_along(f[2], d[2], t);
    DoubleWords rho = double_words_sqrt(double_words_add(double_words_mul(x, x), double_words_mul(z, z)));
    DoubleWords from = double_words_add(rho, (DoubleWords){doubles_splat(-torus->major), zero});
    DoubleWords sum = double_words_add(double_words_mul(from, from), double_words_mul(y, y));
    DoubleWords minor2 = two_products(doubles_splat(torus->minor), doubles_splat(torus->minor));
    return double_words_add(sum, (DoubleWords){-minor2.hi, -minor2.lo});
}

// The last step, in double words. Returns where what it leaves is small enough.
RT_ALWAYS_INLINE DoublesMask torus_lanes_refine(const TorusLanes *torus, const LineLanes *line, const Doubles f[3],
                                                const Doubles d[3], Doubles s, Doubles *root, Doubles *along)
{
    LinePlace place = torus_lanes_at(torus, s);
    DoubleWords t = two_sums(line->t_base, s * line->step), height = torus_lanes_height(torus, f, d, t);
    Doubles slope = place.slope / line->step, change = height.hi / slope;
    Doubles size = doubles_abs(change) / line->step, steep = doubles_abs(place.slope);
    t = double_words_add(t, (DoubleWords){-change, doubles_splat(0.0)});
    *root = t.hi;
    *along = 0.5 * doubles_abs(slope); // the gradient is as long as the tube is thick
    Doubles x = s - torus->s_axis, rho2 = torus->across2 * x * x + torus->least2;
    Doubles bend = torus->square - torus->major * (torus->across2 * torus->least2) / (rho2 * doubles_sqrt(rho2));
    Doubles turn = 2.0 * doubles_abs(bend) * size;
    Doubles most = 0x1p-64 * doubles_min(doubles_abs(t.hi) / line->step, doubles_splat(1.0)) * steep;
    return place.is_certain & (size < 0x1p-30) & (turn < 0x1p-10 * steep) & (turn * size < most) &
           (place.slope_room * size < most);
}

#endif
