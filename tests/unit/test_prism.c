// A ray against a prism, beside the same crossings in whole numbers or in numbers of more digits: outlines of straight
// and of curved pieces that cross themselves, with corners on the line, lines along edges and through tips; and rays
// that start on the wall. CHECK_LONG=1: a million rays of each kind.
//
// Corners and rays of the straight ones are whole numbers times a power of two, so that on which side of a line a
// corner lies is known exactly. Between two crossings of the oracle the prism must say inside where the oracle does.
//
// SPDX-License-Identifier: MIT
#include "trace/prism.h"

#include <stdlib.h>

#include "unit/random.h"
#include "unit/tap.h"

enum { PIECES_MOST = 24, CROSSINGS_MOST = 3 * PIECES_MOST };

typedef long double Real;

typedef struct Outline {
    double items[OUTLINE_HEAD + OUTLINE_PIECE_NUMBERS * PIECES_MOST];
    Numbers list;
} Outline;

typedef struct Crossings {
    Real t[CROSSINGS_MOST];
    int count;
    bool is_inside_end; // behind the last and before the first
} Crossings;

static int whole(Random *random, int most)
{
    return (int)(random_bits(random) % (unsigned)(2 * most + 1)) - most;
}

// One closed curve or two, of corners that are whole numbers times `unit`; few corners, so that many lie on lines.
static void random_outline(Random *random, unsigned degree, bool is_conic, double unit, Outline *outline)
{
    size_t count;
    unsigned curves = 1 + (unsigned)(random_bits(random) % 2);
    outline_begin(outline->items, &count, degree, is_conic);
    for (unsigned curve = 0; curve < curves; curve++) {
        unsigned pieces = 2 + (unsigned)(random_bits(random) % 8);
        double u = unit * whole(random, 9);
        double start[2] = {u, unit * whole(random, 9)}, piece[8] = {start[0], start[1]};
        for (unsigned i = 0; i < pieces; i++) {
            for (unsigned k = 2; k < 2 * (degree + 1); k++) {
                bool is_end = k >= 2 * degree && i + 1 == pieces;
                piece[k] = is_end ? start[k & 1] : unit * whole(random, 9);
            }
            if (degree == 3 && random_bits(random) % 4 == 0) {
                outline_straighten(piece);
            }
            outline_add(outline->items, &count, piece);
            piece[0] = piece[2 * degree];
            piece[1] = piece[2 * degree + 1];
        }
    }
    outline->list = (Numbers){outline->items, count};
}

static Vec3 whole_vec3(Random *random, int most)
{
    Vec3 v;
    v.x = whole(random, most);
    v.y = whole(random, most);
    v.z = whole(random, most);
    return v;
}

static Ray random_ray(Random *random, double unit)
{
    Ray ray;
    do {
        ray.origin = vec3_scale(unit, whole_vec3(random, 12));
        ray.direction = whole_vec3(random, 6);
    } while (ray.direction.x == 0.0 && ray.direction.z == 0.0);
    return ray;
}

// As a part has it: its bounds are those of the outline at both heights.
static unsigned intervals_of(const Numbers *list, double low, double high, const Ray *ray, SideLeft left,
                             RayInterval *intervals)
{
    OutlinePoint least, most;
    outline_bounds(list, &least, &most);
    double first = outline_is_conic(list) ? low : 1.0, second = outline_is_conic(list) ? high : 1.0;
    Vec3 a = vec3(first * least.u, low, first * least.v), b = vec3(first * most.u, low, first * most.v);
    Vec3 c = vec3(second * least.u, high, second * least.v), d = vec3(second * most.u, high, second * most.v);
    return prism_intervals(list, vec3_least(vec3_least(a, b), vec3_least(c, d)),
                           vec3_greatest(vec3_greatest(a, b), vec3_greatest(c, d)), ray, left, intervals);
}

// ---- the oracle

static Real form(const Real line[3], const double *point)
{
    return line[0] * (Real)point[0] + line[1] + line[2] * (Real)point[1];
}

static Real bezier(const Real f[4], unsigned degree, Real s)
{
    Real r = 1 - s;
    return degree == 1 ? r * f[0] + s * f[1]
                       : r * r * r * f[0] + 3 * r * r * s * f[1] + 3 * r * s * s * f[2] + s * s * s * f[3];
}

// Cuts the piece until a part has one change of sign or none; by halves, so that nothing is solved.
static void cut(const Real f[4], unsigned degree, Real low, Real high, int depth, Real *roots, int *count)
{
    int changes = 0;
    for (unsigned i = 0; i < degree; i++) {
        changes += (f[i] < 0) != (f[i + 1] < 0);
    }
    bool changes_sign = (f[0] < 0) != (f[degree] < 0);
    if (changes == 0 || depth == 0) {
        if (changes_sign) {
            roots[(*count)++] = (low + high) / 2;
        }
        return;
    }
    if (degree == 1) {
        roots[(*count)++] = low + (high - low) * (f[0] / (f[0] - f[1]));
        return;
    }
    Real a = (f[0] + f[1]) / 2, b = (f[1] + f[2]) / 2, c = (f[2] + f[3]) / 2, ab = (a + b) / 2, bc = (b + c) / 2;
    Real middle = (ab + bc) / 2;
    const Real first[4] = {f[0], a, ab, middle}, second[4] = {middle, bc, c, f[3]};
    cut(first, degree, low, (low + high) / 2, depth - 1, roots, count);
    cut(second, degree, (low + high) / 2, high, depth - 1, roots, count);
}

static int real_order(const void *a, const void *b)
{
    Real x = *(const Real *)a, y = *(const Real *)b;
    return (x > y) - (x < y);
}

static Real crossing_t(const Ray *ray, bool is_conic, Real u, Real v)
{
    Real ox = ray->origin.x, oy = ray->origin.y, oz = ray->origin.z;
    Real dx = ray->direction.x, dy = ray->direction.y, dz = ray->direction.z;
    if (!is_conic) {
        return ((u - ox) * dx + (v - oz) * dz) / (dx * dx + dz * dz);
    }
    Real by_x = dx - u * dy, by_z = dz - v * dy, from_x = u * oy - ox, from_z = v * oy - oz;
    Real from2 = from_x * from_x + from_z * from_z, by2 = by_x * by_x + by_z * by_z,
         along = from_x * by_x + from_z * by_z;
    return by2 >= from2 ? along / by2 : from2 / along;
}

static void oracle(const Outline *outline, const Ray *ray, Crossings *out)
{
    bool is_conic = outline_is_conic(&outline->list);
    unsigned stored = outline_degree(&outline->list);
    Real ox = ray->origin.x, oy = ray->origin.y, oz = ray->origin.z;
    Real dx = ray->direction.x, dy = ray->direction.y, dz = ray->direction.z;
    Real turn = dx < 0 || (dx == 0 && dz < 0) ? -1 : 1; // what lies on the line is on one side of it
    const Real straight[3] = {turn * -dz, turn * (dz * ox - dx * oz), turn * dx};
    const Real conic[3] = {oy * dz - oz * dy, oz * dx - ox * dz, ox * dy - oy * dx};
    out->count = 0;
    out->is_inside_end = false;
    for (uint32_t i = 0; i < outline_piece_count(&outline->list); i++) {
        const double *piece = outline_piece(&outline->list, i);
        Real f[4], u[4], v[4], roots[3 * 64];
        int count = 0;
        unsigned degree = stored == 3 && outline_is_straight(piece) ? 1 : stored, step = 2 * stored / degree;
        for (unsigned k = 0; k <= degree; k++) {
            f[k] = form(is_conic ? conic : straight, piece + step * k);
            u[k] = piece[step * k];
            v[k] = piece[step * k + 1];
        }
        cut(f, degree, 0, 1, 58, roots, &count);
        for (int k = 0; k < count; k++) {
            Real t = crossing_t(ray, is_conic, bezier(u, degree, roots[k]), bezier(v, degree, roots[k]));
            out->t[out->count++] = t;
            out->is_inside_end = out->is_inside_end != (is_conic && dy != 0 && t > -oy / dy);
        }
    }
    qsort(out->t, (size_t)out->count, sizeof out->t[0], real_order);
}

// ---- the comparison

static bool says_inside(const RayInterval *intervals, unsigned count, double t)
{
    for (unsigned i = 0; i < count; i++) {
        if (intervals[i].enter <= t && t <= intervals[i].leave) {
            return true;
        }
    }
    return false;
}

// In how many gaps between crossings behind `from` the two differ. Gaps that rounding may close are left out.
static int compare(const Crossings *exact, const Ray *ray, double low, double high, const RayInterval *intervals,
                   unsigned count, double from, int *gaps)
{
    bool is_inside = exact->is_inside_end;
    int wrong = 0;
    for (int i = 0; i <= exact->count; i++) {
        Real begin = i > 0 ? exact->t[i - 1] : (exact->count ? exact->t[0] : 0) - 1;
        Real end = i < exact->count ? exact->t[i] : (exact->count ? exact->t[exact->count - 1] : 0) + 1;
        begin = begin < (Real)from ? (Real)from : begin;
        double middle = (double)((begin + end) / 2), size = fabs(middle) + 1.0;
        double y = ray->origin.y + middle * ray->direction.y, room = 1e-9 * (fabs(ray->origin.y) + fabs(y));
        bool is_near_end = fabs(y - low) <= room || fabs(y - high) <= room;
        if (end - begin > (Real)(1e-9 * size) && !is_near_end) {
            bool expected = is_inside && y > low && y < high;
            wrong += says_inside(intervals, count, middle) != expected;
            ++*gaps;
        }
        is_inside = !is_inside;
    }
    return wrong;
}

static bool in_order(const RayInterval *intervals, unsigned count)
{
    for (unsigned i = 0; i < count; i++) {
        if (!(intervals[i].enter < intervals[i].leave) || (i > 0 && intervals[i].enter < intervals[i - 1].leave)) {
            return false;
        }
    }
    return true;
}

// Whether the oracle knows where it is: the line is not through the tip, and is not parallel to it where the wall is.
static bool is_known(const Outline *outline, const Ray *ray, const Crossings *exact)
{
    bool is_known =
        !outline_is_conic(&outline->list) || !vec3_equal(vec3_cross(ray->origin, ray->direction), vec3(0.0, 0.0, 0.0));
    for (int i = 0; i < exact->count; i++) {
        is_known = is_known && fabs((double)exact->t[i]) < 1e9;
    }
    return is_known;
}

// Whether a start is by itself: no other piece is near it.
static bool is_apart(const Crossings *exact)
{
    int near = 0;
    for (int i = 0; i < exact->count; i++) {
        near += fabs((double)exact->t[i]) < 1e-3;
    }
    return near <= 1;
}

static int rays_of_family(void)
{
    return getenv("CHECK_LONG") ? 1000 * 1000 : 20 * 1000;
}

static void test_lines(const char *name, unsigned degree, bool is_conic, double unit)
{
    Random random = {degree + (is_conic ? 10 : 0)};
    int rays = rays_of_family(), wrong = 0, gaps = 0, disordered = 0, odd = 0;
    for (int i = 0; i < rays; i++) {
        Outline outline;
        Crossings exact;
        double scale = is_conic ? 1.0 : unit;
        random_outline(&random, degree, is_conic, scale, &outline);
        Ray ray = random_ray(&random, scale);
        double low = scale * -3.25, high = scale * (i % 3 ? 4.25 : -1.25);
        uint32_t most = outline_crossings_most(&outline.list);
        RayInterval intervals[CROSSINGS_MOST];
        unsigned count = intervals_of(&outline.list, low, high, &ray, LEFT_NONE, intervals);
        oracle(&outline, &ray, &exact);
        Ray unscaled = {vec3_scale(1.0 / scale, ray.origin), ray.direction};
        for (int k = 0; k < exact.count; k++) {
            exact.t[k] /= (Real)scale;
        }
        for (unsigned k = 0; k < count; k++) {
            intervals[k].enter /= scale;
            intervals[k].leave /= scale;
        }
        if (!is_known(&outline, &unscaled, &exact)) {
            continue;
        }
        odd += exact.count % 2 || count > most / 2 + 2;
        disordered += !in_order(intervals, count);
        wrong += compare(&exact, &unscaled, low / scale, high / scale, intervals, count, -(double)INFINITY, &gaps);
    }
    tap_ok(gaps > rays && wrong == 0, "%s: inside where the oracle is (%d of %d gaps are not)", name, wrong, gaps);
    tap_ok(odd == 0 && disordered == 0, "%s: an even number of crossings, in order (%d, %d are not)", name, odd,
           disordered);
}

static bool is_at_corner(const Outline *outline, Vec3 on)
{
    bool is_conic = outline_is_conic(&outline->list), is_near = false;
    double size = is_conic ? on.y : 1.0;
    for (uint32_t i = 0; i < outline_piece_count(&outline->list); i++) {
        const double *corner = outline_piece(&outline->list, i);
        is_near = is_near || (fabs(corner[0] * size - on.x) < 1e-3 && fabs(corner[1] * size - on.z) < 1e-3);
    }
    return is_near;
}

// From a point of the wall, as a hit gives it, in any direction: behind the start all is as the oracle has it.
static void test_starts(const char *name, unsigned degree, bool is_conic)
{
    Random random = {degree + (is_conic ? 20 : 30)};
    int rays = rays_of_family(), wrong = 0, gaps = 0, starts = 0;
    for (int i = 0; i < rays; i++) {
        Outline outline;
        Crossings exact;
        double low = -3.25, high = 4.25;
        RayInterval intervals[CROSSINGS_MOST];
        random_outline(&random, degree, is_conic, 1.0, &outline);
        Ray ray = random_ray(&random, 1.0);
        unsigned count = intervals_of(&outline.list, low, high, &ray, LEFT_NONE, intervals);
        if (count == 0 || intervals[0].enter_side != PRISM_WALL || isinf(intervals[0].enter)) {
            continue;
        }
        Vec3 on = prism_point(&outline.list, low, high, ray_at(ray, intervals[0].enter), PRISM_WALL);
        Vec3 n = prism_gradient(&outline.list, on, PRISM_WALL);
        n = vec3_dot(n, ray.direction) > 0.0 ? vec3_neg(n) : n; // it was entered
        Ray next = {on, random_direction(&random)};
        double rise = vec3_dot(vec3_normalize(n), next.direction);
        if (fabs(rise) < 1e-3 || fabs(on.y) < 1e-2) {
            continue;
        }
        count = intervals_of(&outline.list, low, high, &next, (SideLeft){PRISM_WALL, rise < 0.0}, intervals);
        oracle(&outline, &next, &exact);
        if (!is_known(&outline, &next, &exact) || !is_apart(&exact) || is_at_corner(&outline, on)) {
            continue;
        }
        starts++;
        wrong += compare(&exact, &next, low, high, intervals, count, 1e-6, &gaps);
    }
    tap_ok(starts > rays / 10 && wrong == 0, "%s: rays from the wall (%d of %d gaps are wrong, %d starts)", name, wrong,
           gaps, starts);
}

// Between corners, on edges, outside: by the same rule as a line's crossings, with each edge belonging to one side.
static void test_points(void)
{
    Random random = {5};
    int differ = 0;
    for (int i = 0; i < 20000; i++) {
        Outline outline;
        RayInterval intervals[CROSSINGS_MOST];
        random_outline(&random, i % 2 ? 3 : 1, false, 1.0, &outline);
        OutlinePoint p;
        p.u = random_between(&random, -10.0, 10.0);
        p.v = random_between(&random, -10.0, 10.0);
        Ray along = {vec3(p.u, 0.5, p.v), vec3(0.0, 0.0, 1.0)};
        unsigned count = intervals_of(&outline.list, 0.0, 1.0, &along, LEFT_NONE, intervals);
        differ += outline_holds(&outline.list, p) != says_inside(intervals, count, 0.0);
    }
    tap_ok(differ == 0, "a point is inside where a line through it is (%d are not)", differ);
}

int main(void)
{
    test_lines("straight", 1, false, 1.0);
    test_lines("straight, 2^-40", 1, false, 0x1p-40);
    test_lines("straight, 2^40", 1, false, 0x1p40);
    test_lines("curved", 3, false, 1.0);
    test_lines("curved, 2^-40", 3, false, 0x1p-40);
    test_lines("curved, 2^40", 3, false, 0x1p40);
    test_lines("straight, conic", 1, true, 1.0);
    test_lines("curved, conic", 3, true, 1.0);
    test_starts("straight", 1, false);
    test_starts("curved", 3, false);
    test_starts("straight, conic", 1, true);
    test_starts("curved, conic", 3, true);
    test_points();
    return tap_done();
}
