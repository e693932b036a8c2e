// Splines: curves through points that are given at numbers.
//
// Turns a number into the point of the curve there. The curves are POV-Ray's, as measured: see each formula. Knows
// nothing of how a spline is written or called.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/values/function.h"

static const struct {
    Word word;
    SplineType type;
} types[] = {
    {W_linear_spline, SPLINE_LINEAR},
    {W_quadratic_spline, SPLINE_QUADRATIC},
    {W_cubic_spline, SPLINE_CUBIC},
    {W_natural_spline, SPLINE_NATURAL},
};

bool spline_type(Word word, SplineType *type)
{
    for (size_t i = 0; i < RT_COUNT_OF(types); i++) {
        if (types[i].word == word) {
            *type = types[i].type;
            return true;
        }
    }
    return false;
}

// The curves are rounded as POV-Ray rounds them, which chaotic scenes show: the order of operations is the one that gives
// all bits of some 4000 values.

// The second derivatives of the curve of third order that is twice continuously differentiable and straight at its
// ends: a tridiagonal system for each component, by elimination. `pivots` has room for as many as there are points.
void spline_bend(SplinePoint *points, unsigned count, double *pivots)
{
    for (unsigned c = 0; c < 5; c++) {
        points[0].bend[c] = points[count - 1].bend[c] = 0.0;
        for (unsigned i = 1; i + 1 < count; i++) {
            SplinePoint *p = &points[i];
            double before = p->t - p[-1].t, after = p[1].t - p->t;
            pivots[i] = 2.0 * (before + after);
            p->bend[c] = 6.0 * ((p[1].v[c] - p->v[c]) / after - (p->v[c] - p[-1].v[c]) / before);
            if (i > 1) {
                pivots[i] -= before * before / pivots[i - 1];
                p->bend[c] -= before * p[-1].bend[c] / pivots[i - 1];
            }
        }
        for (unsigned i = count - 1; i-- > 1;) {
            SplinePoint *p = &points[i];
            p->bend[c] = (p->bend[c] - (p[1].t - p->t) * p[1].bend[c]) / pivots[i];
        }
    }
}

static double linear_at(const SplinePoint *p, unsigned c, double t)
{
    return (p[1].v[c] - p[0].v[c]) * (t - p[0].t) / (p[1].t - p[0].t) + p[0].v[c];
}

// The parabola through three points, its coefficients by Cramer's rule.
static double parabola_at(const SplinePoint *p, unsigned c, double t)
{
    double t0 = p[0].t, t1 = p[1].t, t2 = p[2].t, v0 = p[0].v[c], v1 = p[1].v[c], v2 = p[2].v[c];
    double determinant = (t0 - t1) * (t0 - t2) * (t2 - t1);
    double square = t2 * v0 - t1 * v0 + t0 * v1 - t2 * v1 - t0 * v2 + t1 * v2;
    double slope = t1 * t1 * v0 - t2 * t2 * v0 - t0 * t0 * v1 + t2 * t2 * v1 + t0 * t0 * v2 - t1 * t1 * v2;
    double constant = t1 * t2 * t2 * v0 - t1 * t1 * t2 * v0 + t0 * t0 * t2 * v1 - t0 * t2 * t2 * v1 -
                      t0 * t0 * t1 * v2 + t0 * t1 * t1 * v2;
    return (square / determinant * t + slope / determinant) * t + constant / determinant;
}

// Hermite's curve between p[1] and p[2]; at each the slope is the mean of the slopes of the chords on both sides.
static double cubic_at(const SplinePoint *p, unsigned c, double t)
{
    double length = p[2].t - p[1].t, share = (t - p[1].t) / length;
    double before = (p[1].v[c] - p[0].v[c]) / (p[1].t - p[0].t);
    double chord = (p[2].v[c] - p[1].v[c]) / length;
    double after = (p[3].v[c] - p[2].v[c]) / (p[3].t - p[2].t);
    double square = share * share, cube = square * share;
    return (2.0 * share * share * share - 3.0 * share * share + 1.0) * p[1].v[c] +
           (3.0 * share * share - 2.0 * share * share * share) * p[2].v[c] +
           (before + chord) / 2.0 * length * (cube - 2.0 * share * share + share) +
           (chord + after) / 2.0 * length * (cube - square);
}

static double natural_at(const SplinePoint *p, unsigned c, double t)
{
    double length = p[1].t - p[0].t, from = t - p[0].t, here = p[0].bend[c], next = p[1].bend[c];
    double slope = (p[1].v[c] - p[0].v[c]) / length - length / 6.0 * (next + 2.0 * here);
    return p[0].v[c] + from * (slope + from * (here / 2.0 + from * (next - here) / (6.0 * length)));
}

typedef struct Curve {
    double (*at)(const SplinePoint *p, unsigned component, double t);
    unsigned before, after; // points that it needs beyond the ends of an interval
    unsigned least;         // points; with fewer it is straight
    bool shifts;            // at the first interval it takes the points from there on
} Curve;

static const Curve curves[] = {
    [SPLINE_LINEAR] = {linear_at, 0, 0, 2, false},
    [SPLINE_QUADRATIC] = {parabola_at, 1, 0, 3, true},
    [SPLINE_CUBIC] = {cubic_at, 1, 1, 3, false},
    [SPLINE_NATURAL] = {natural_at, 0, 0, 2, false},
};

// The last point before t, of a spline that t lies in.
static unsigned find_interval(const Spline *spline, double t)
{
    unsigned low = 0, high = spline->count - 1;
    while (high - low > 1) {
        unsigned middle = low + (high - low) / 2;
        if (spline->points[middle].t < t) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// POV-Ray's cubic spline of two points: halfway between them, wherever it is asked for.
static bool is_mean(const Spline *spline, SplineType type)
{
    return type == SPLINE_CUBIC && spline->count == 2;
}

void spline_at(const Spline *spline, SplineType type, double t, double v[5])
{
    if (is_mean(spline, type)) {
        for (unsigned c = 0; c < 5; c++) {
            v[c] = (spline->points[0].v[c] + spline->points[1].v[c]) / 2.0;
        }
        return;
    }
    const Curve *curve = spline->count < curves[type].least ? &curves[SPLINE_LINEAR] : &curves[type];
    unsigned first = curve->shifts ? 0 : curve->before, last = spline->count - 1 - curve->after;
    const SplinePoint *points = spline->points;
    // Not a number stays where the curve begins.
    if (!(t > points[first].t) || t >= points[last].t) {
        memcpy(v, points[t >= points[last].t ? last : first].v, 5 * sizeof *v);
        return;
    }
    unsigned interval = find_interval(spline, t);
    unsigned from = interval >= curve->before ? interval - curve->before : 0;
    for (unsigned c = 0; c < 5; c++) {
        v[c] = c < spline->components ? curve->at(points + from, c, t) : 0.0;
    }
}
