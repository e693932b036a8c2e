// A ray against a lathe and a surface of revolution, beside the same crossings in 113 bits: curves that cross
// themselves, touch the axis or lie on both sides of it, lines that are level, nearly level, upright, through the axis;
// and rays that start on the curve. CHECK_LONG=1: a million rays of each kind.
//
// Between two crossings of the oracle that are apart the shape must say inside where the oracle does; or where it does
// for a line that is off by OFF of what the shape is large, or of a surface of revolution for squares of its radius
// that are.
//
// SPDX-License-Identifier: MIT
#include "trace/revolved.h"

#include <stdlib.h>

#include "scene/outline.h"
#include "scene/sor.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { PIECES_MOST = 24, CROSSINGS_MOST = 8 * PIECES_MOST, FORM_MOST = 7, POINTS_MOST = 12 };

typedef __float128 Real;

static const double SIZE = 9.0, OFF = 0x1p-46;

typedef struct Shape {
    double items[OUTLINE_HEAD + OUTLINE_PIECE_NUMBERS * PIECES_MOST + 256];
    Numbers list;
    bool is_sor;
    Vec3 low, high;
} Shape;

typedef struct Crossings {
    Real t[CROSSINGS_MOST];
    int count;
} Crossings;

typedef enum Kind { KIND_ANY, KIND_NEARLY_LEVEL, KIND_LEVEL, KIND_UPRIGHT, KIND_NEARLY_UPRIGHT, KIND_AXIS, KINDS } Kind;

static const char *const kind_names[KINDS] = {"any",     "nearly level",   "level",
                                              "upright", "nearly upright", "through the axis"};

static int whole(Random *random, int low, int high)
{
    return low + (int)(random_bits(random) % (unsigned)(high - low + 1));
}

// Closed curves; few places, so that many lie on lines.
static void random_lathe(Random *random, unsigned degree, int least, double unit, Shape *shape)
{
    size_t count;
    OutlinePoint low, high;
    int pieces = whole(random, 2, 8);
    outline_begin(shape->items, &count, degree, least < 0);
    double u = unit * whole(random, least, 9);
    double start[2] = {u, unit * whole(random, -9, 9)}, piece[8] = {start[0], start[1]};
    for (int i = 0; i < pieces; i++) {
        for (unsigned k = 2; k < 2 * (degree + 1); k++) {
            bool is_end = k >= 2 * degree && i + 1 == pieces;
            piece[k] = is_end ? start[k & 1] : unit * whole(random, k & 1 ? -9 : least, 9);
        }
        if (degree == 3 && random_bits(random) % 4 == 0) {
            outline_straighten(piece);
        }
        outline_add(shape->items, &count, piece);
        piece[0] = piece[2 * degree];
        piece[1] = piece[2 * degree + 1];
    }
    shape->list = (Numbers){shape->items, count};
    shape->is_sor = false;
    outline_bounds(&shape->list, &low, &high);
    double radius = fmax(fabs(low.u), fabs(high.u));
    shape->low = vec3(-radius, low.v, -radius);
    shape->high = vec3(radius, high.v, radius);
}

static void random_sor(Random *random, double unit, Shape *shape)
{
    int points = whole(random, 4, POINTS_MOST), height = -9;
    shape->items[0] = points;
    for (int i = 0; i < points; i++) {
        shape->items[1 + 2 * i] = unit * whole(random, 0, 9);
        shape->items[2 + 2 * i] = unit * height;
        height += whole(random, 1, 3);
    }
    sor_complete(shape->items);
    shape->list = (Numbers){shape->items, sor_list_count((uint32_t)points)};
    shape->is_sor = true;
    double radius = sor_radius_most(&shape->list);
    shape->low = vec3(-radius, sor_height(&shape->list, 0), -radius);
    shape->high = vec3(radius, sor_height(&shape->list, sor_stretch_count(&shape->list)), radius);
}

static Ray random_ray(Random *random, Kind kind, double unit)
{
    Ray ray;
    do {
        double x = whole(random, -12, 12), y = whole(random, -12, 12), z = whole(random, -12, 12);
        double a = whole(random, -6, 6), b = whole(random, -6, 6), c = whole(random, -6, 6);
        ray.origin = vec3_scale(unit, vec3(x, y, z));
        ray.direction = vec3(a, b, c);
        if (kind == KIND_NEARLY_LEVEL || kind == KIND_LEVEL) {
            ray.direction.y = kind == KIND_LEVEL ? 0.0 : b * ldexp(1.0, -whole(random, 5, 40));
        } else if (kind == KIND_UPRIGHT || kind == KIND_NEARLY_UPRIGHT) {
            double slant = kind == KIND_UPRIGHT ? 0.0 : ldexp(1.0, -whole(random, 5, 40));
            ray.direction = vec3(a * slant, 1.0, c * slant);
        } else if (kind == KIND_AXIS) {
            ray.direction = vec3_sub(vec3(0.0, unit * b, 0.0), ray.origin);
        }
    } while (vec3_equal(ray.direction, vec3(0.0, 0.0, 0.0)));
    return ray;
}

static unsigned intervals_of(const Shape *shape, const Ray *ray, SideLeft left, RayInterval *intervals)
{
    return (shape->is_sor ? sor_intervals : lathe_intervals)(&shape->list, shape->low, shape->high, ray, left,
                                                             intervals);
}

// ---- the oracle: the square of the radius, and the height, as polynomials along each piece

typedef struct Piece {
    unsigned square_degree, v_degree;
    Real square[FORM_MOST], v[4];
} Piece;

static Real choose(unsigned n, unsigned k)
{
    Real product = 1;
    for (unsigned i = 0; i < k; i++) {
        product = product * (n - i) / (i + 1);
    }
    return product;
}

// The product of two polynomials in Bernstein's form.
static void times(const Real *a, unsigned m, const Real *b, unsigned n, Real *to)
{
    for (unsigned k = 0; k <= m + n; k++) {
        to[k] = 0;
        for (unsigned i = k > n ? k - n : 0; i <= m && i <= k; i++) {
            to[k] += choose(m, i) * choose(n, k - i) / choose(m + n, k) * a[i] * b[k - i];
        }
    }
}

static Real at(const Real *b, unsigned degree, Real s)
{
    Real c[FORM_MOST];
    for (unsigned i = 0; i <= degree; i++) {
        c[i] = b[i];
    }
    for (unsigned n = degree; n > 0; n--) {
        for (unsigned i = 0; i < n; i++) {
            c[i] += s * (c[i + 1] - c[i]);
        }
    }
    return c[0];
}

// By halves, until a part has one change of sign or none.
static void roots_of(const Real *b, unsigned degree, Real low, Real high, int depth, Real *roots, int *count)
{
    int changes = 0;
    for (unsigned i = 0; i < degree; i++) {
        changes += (b[i] > 0) != (b[i + 1] > 0);
    }
    bool differs = (b[0] > 0) != (b[degree] > 0);
    if (changes == 0 || (depth == 0 && !differs)) {
        return;
    }
    if (changes == 1 || depth == 0) {
        Real from = 0, to = 1;
        for (int i = 0; i < 110; i++) {
            Real middle = (from + to) / 2;
            *((at(b, degree, middle) > 0) == (b[0] > 0) ? &from : &to) = middle;
        }
        roots[(*count)++] = low + (high - low) * from;
        return;
    }
    Real left[FORM_MOST], right[FORM_MOST], middle = (low + high) / 2;
    for (unsigned i = 0; i <= degree; i++) {
        right[i] = b[i];
    }
    for (unsigned n = 0; n <= degree; n++) {
        left[n] = right[0];
        for (unsigned i = 0; n < degree && i < degree - n; i++) {
            right[i] = (right[i] + right[i + 1]) / 2;
        }
    }
    roots_of(left, degree, low, middle, depth - 1, roots, count);
    roots_of(right, degree, middle, high, depth - 1, roots, count);
}

static Real root_of(Real x)
{
    Real r = x > 0 ? (Real)sqrt((double)x) : 0;
    for (int i = 0; i < 3 && r > 0; i++) {
        r = (r + x / r) / 2;
    }
    return r;
}

// Both halves of a level line lie at one height: where a piece comes through it, at both ends of the chord.
static void cross_level(const Piece *piece, const Ray *ray, Crossings *crossings)
{
    Real v[FORM_MOST], roots[FORM_MOST], dx = ray->direction.x, dz = ray->direction.z, ox = ray->origin.x;
    Real oz = ray->origin.z, a = dx * dx + dz * dz, b = ox * dx + oz * dz, moment = ox * dz - oz * dx;
    int count = 0;
    for (unsigned i = 0; i <= piece->v_degree; i++) {
        v[i] = piece->v[i] - (Real)ray->origin.y;
    }
    for (unsigned i = 0; i <= piece->v_degree; i++) { // as the shape has it: at the height is above
        v[i] = v[i] == 0 ? (Real)1e-33 * (Real)(fabs(ray->origin.y) + 1e-300) : v[i];
    }
    roots_of(v, piece->v_degree, 0, 1, 100, roots, &count);
    for (int i = 0; i < count; i++) {
        Real rest = (at(piece->square, piece->square_degree, roots[i]) - moment * moment / a) / a;
        if (rest > 0) {
            crossings->t[crossings->count++] = -b / a - root_of(rest);
            crossings->t[crossings->count++] = -b / a + root_of(rest);
        }
    }
}

// (dy u)² = (x dy + dx (v - y))² + (z dy + dz (v - y))²
static void cross(const Piece *piece, const Ray *ray, Crossings *crossings)
{
    Real form[FORM_MOST], x[4], z[4], x2[FORM_MOST], z2[FORM_MOST], roots[FORM_MOST], dy = ray->direction.y;
    unsigned n = piece->v_degree, degree = piece->square_degree > 2 * n ? piece->square_degree : 2 * n;
    int count = 0;
    if (dy == 0) {
        cross_level(piece, ray, crossings);
        return;
    }
    for (unsigned i = 0; i <= n; i++) {
        Real rise = piece->v[i] - (Real)ray->origin.y;
        x[i] = (Real)ray->origin.x * dy + (Real)ray->direction.x * rise;
        z[i] = (Real)ray->origin.z * dy + (Real)ray->direction.z * rise;
    }
    times(x, n, x, n, x2);
    times(z, n, z, n, z2);
    for (unsigned i = 0; i <= 2 * n; i++) {
        x2[i] += z2[i];
    }
    if (2 * n < degree) { // of a sor
        const Real ones[2] = {1, 1};
        times(x2, 2 * n, ones, degree - 2 * n, z2);
        for (unsigned i = 0; i <= degree; i++) {
            x2[i] = z2[i];
        }
    }
    for (unsigned i = 0; i <= degree; i++) {
        form[i] = dy * dy * piece->square[i] - x2[i];
    }
    roots_of(form, degree, 0, 1, 100, roots, &count);
    for (int i = 0; i < count; i++) {
        crossings->t[crossings->count++] = (at(piece->v, n, roots[i]) - (Real)ray->origin.y) / dy;
    }
}

static void lathe_piece(const Shape *shape, uint32_t i, Piece *piece)
{
    const double *p = outline_piece(&shape->list, i);
    unsigned degree = outline_degree(&shape->list);
    bool is_straight = degree == 1 || p[PIECE_DEGREE - PIECE_POINTS] <= 1.0;
    unsigned n = is_straight ? 1 : 3;
    Real u[4];
    for (unsigned k = 0; k <= n; k++) {
        unsigned from = is_straight ? 2 * degree * k : 2 * k;
        u[k] = p[from];
        piece->v[k] = p[from + 1];
    }
    piece->v_degree = n;
    piece->square_degree = 2 * n;
    times(u, n, u, n, piece->square);
}

static void sor_end(const Shape *shape, uint32_t place, uint32_t stretch, unsigned k, const Ray *ray,
                    Crossings *crossings)
{
    if (ray->direction.y != 0.0) {
        Real t = ((Real)sor_height(&shape->list, place) - (Real)ray->origin.y) / (Real)ray->direction.y;
        Real x = (Real)ray->origin.x + t * (Real)ray->direction.x, z = (Real)ray->origin.z + t * (Real)ray->direction.z;
        if (x * x + z * z < (Real)sor_squares(&shape->list, stretch)[k]) {
            crossings->t[crossings->count++] = t;
        }
    }
}

static int order(const void *a, const void *b)
{
    Real x = *(const Real *)a, y = *(const Real *)b;
    return (x > y) - (x < y);
}

static void oracle(const Shape *shape, const Ray *ray, Crossings *crossings)
{
    crossings->count = 0;
    if (!shape->is_sor) {
        for (uint32_t i = 0; i < outline_piece_count(&shape->list); i++) {
            Piece piece;
            lathe_piece(shape, i, &piece);
            cross(&piece, ray, crossings);
        }
    } else {
        uint32_t count = sor_stretch_count(&shape->list);
        sor_end(shape, 0, 0, 0, ray, crossings);
        sor_end(shape, count, count - 1, 3, ray, crossings);
        for (uint32_t i = 0; i < count; i++) {
            const double *f = sor_squares(&shape->list, i);
            Piece piece = {
                3, 1, {f[0], f[1], f[2], f[3]}, {sor_height(&shape->list, i), sor_height(&shape->list, i + 1)}};
            cross(&piece, ray, crossings);
        }
    }
    qsort(crossings->t, (size_t)crossings->count, sizeof crossings->t[0], order);
}

// ---- comparing

static bool says_inside(const RayInterval *intervals, unsigned count, double t)
{
    bool is_inside = false;
    for (unsigned i = 0; i < count; i++) {
        is_inside = is_inside || (intervals[i].enter < t && t < intervals[i].leave);
    }
    return is_inside;
}

static bool oracle_says(const Shape *shape, const Ray *ray, double t)
{
    Crossings crossings;
    bool is_inside = false;
    oracle(shape, ray, &crossings);
    for (int i = 0; i < crossings.count && crossings.t[i] < (Real)t; i++) {
        is_inside = !is_inside;
    }
    return is_inside;
}

// Whether a line or a shape that is a little off says so.
static bool is_excused(const Shape *shape, const Ray *ray, double t, bool is_inside, double unit)
{
    const double off = OFF * SIZE * unit;
    const Vec3 moves[6] = {{off, 0, 0}, {-off, 0, 0}, {0, off, 0}, {0, -off, 0}, {0, 0, off}, {0, 0, -off}};
    bool is_found = false;
    for (int i = 0; i < 6; i++) {
        Ray moved = {vec3_add(ray->origin, moves[i]), ray->direction};
        is_found = is_found || oracle_says(shape, &moved, t) == is_inside;
    }
    for (int i = 0; i < 2 && shape->is_sor && !is_found; i++) {
        Shape other = *shape;
        other.list.items = other.items;
        for (uint32_t k = 0; k < 4 * sor_stretch_count(&other.list); k++) {
            other.items[1 + 2 * sor_point_count(&other.list) + k] += (i ? 1.0 : -1.0) * OFF * SIZE * SIZE * unit * unit;
        }
        is_found = oracle_says(&other, ray, t) == is_inside;
    }
    return is_found;
}

// How many gaps behind `from` are wrong. A gap is as wide as `width` in the shape, and no narrower in t.
static int compare(const Shape *shape, const Ray *ray, const RayInterval *intervals, unsigned count, double from,
                   double unit, int *gaps)
{
    Crossings exact;
    int wrong = 0;
    double least = 1e-6 * unit / vec3_length(ray->direction);
    oracle(shape, ray, &exact);
    for (int i = 0; i <= exact.count; i++) {
        double low = i > 0 ? (double)exact.t[i - 1] : (double)(exact.count ? exact.t[0] : 0) - 4.0 * least;
        double high = i < exact.count ? (double)exact.t[i] : low + 4.0 * least, t = low + 0.46 * (high - low);
        bool is_inside = says_inside(intervals, count, t);
        if (low < from || !(high - low > least)) {
            continue;
        }
        (*gaps)++;
        wrong += is_inside != (i % 2 == 1) && !is_excused(shape, ray, t, is_inside, unit);
    }
    return wrong;
}

static int rays_of_family(void)
{
    return getenv("CHECK_LONG") ? 1000000 : 1500;
}

static bool in_order(const RayInterval *intervals, unsigned count)
{
    bool is_fine = true;
    for (unsigned i = 0; i < count; i++) {
        is_fine = is_fine && intervals[i].enter <= intervals[i].leave &&
                  (i == 0 || intervals[i - 1].leave <= intervals[i].enter);
    }
    return is_fine;
}

typedef enum Maker { MAKE_LINES, MAKE_CURVES, MAKE_MIRRORED, MAKE_SOR, MAKERS } Maker;

static const char *const maker_names[MAKERS] = {"straight lathe", "curved lathe", "lathe on both sides", "sor"};

static void make(Random *random, Maker maker, double unit, Shape *shape)
{
    if (maker == MAKE_SOR) {
        random_sor(random, unit, shape);
    } else {
        random_lathe(random, maker == MAKE_LINES ? 1 : 3, maker == MAKE_MIRRORED ? -9 : 0, unit, shape);
    }
}

static void test_lines(Maker maker, Kind kind, double unit)
{
    Random random = {(uint64_t)maker * 16 + (uint64_t)kind};
    int rays = rays_of_family() / (unit == 1.0 ? 1 : 4), wrong = 0, gaps = 0, disordered = 0;
    for (int i = 0; i < rays; i++) {
        Shape shape;
        RayInterval intervals[CROSSINGS_MOST];
        make(&random, maker, unit, &shape);
        Ray ray = random_ray(&random, kind, unit);
        unsigned count = intervals_of(&shape, &ray, LEFT_NONE, intervals);
        disordered += !in_order(intervals, count);
        wrong += compare(&shape, &ray, intervals, count, -(double)INFINITY, unit, &gaps);
    }
    tap_ok(gaps > rays / 4 && wrong == 0 && disordered == 0,
           "%s, %s, unit %g: inside where the oracle is (%d of %d gaps are not, %d not in order)", maker_names[maker],
           kind_names[kind], unit, wrong, gaps, disordered);
}

// From a point of the curve, as a hit gives it, in any direction.
static void test_starts(Maker maker)
{
    Random random = {100 + (uint64_t)maker};
    int rays = rays_of_family(), wrong = 0, gaps = 0, starts = 0;
    for (int i = 0; i < rays; i++) {
        Shape shape;
        Crossings exact;
        RayInterval intervals[CROSSINGS_MOST];
        make(&random, maker, 1.0, &shape);
        Ray ray = random_ray(&random, KIND_ANY, 1.0);
        unsigned count = intervals_of(&shape, &ray, LEFT_NONE, intervals);
        if (count == 0 || intervals[0].enter_side != REVOLVED_CURVE) {
            continue;
        }
        Vec3 on = ray_at(ray, intervals[0].enter), n;
        on = maker == MAKE_SOR ? sor_point(&shape.list, on, 0) : lathe_point(&shape.list, on, 0);
        n = maker == MAKE_SOR ? sor_gradient(&shape.list, on, 0) : lathe_gradient(&shape.list, on, 0);
        n = vec3_dot(n, ray.direction) > 0.0 ? vec3_neg(n) : n; // it was entered
        Ray next = {on, random_direction(&random)};
        double rise = vec3_dot(vec3_normalize(n), next.direction);
        if (!(fabs(rise) > 1e-2) || !(hypot(on.x, on.z) > 1e-2)) {
            continue;
        }
        count = intervals_of(&shape, &next, (SideLeft){REVOLVED_CURVE, rise < 0.0}, intervals);
        oracle(&shape, &next, &exact);
        bool is_apart = true; // from corners and other crossings
        int near = 0;
        for (int k = 0; k < exact.count; k++) {
            near += fabs((double)exact.t[k]) < 1e-10;
            is_apart = is_apart && !(fabs((double)exact.t[k]) > 1e-10 && fabs((double)exact.t[k]) < 1e-4);
        }
        int behind = 0;
        for (int k = 0; k < exact.count; k++) {
            behind += (double)exact.t[k] > 1e-4;
        }
        if (!is_apart || near != 1 || (behind % 2 == 1) != (rise < 0.0)) {
            continue; // a corner: the normal is another piece's
        }
        starts++;
        wrong += compare(&shape, &next, intervals, count, 1e-6, 1.0, &gaps);
    }
    tap_ok(starts > rays / 25 && wrong == 0, "%s: rays from the curve (%d of %d gaps are wrong, %d starts)",
           maker_names[maker], wrong, gaps, starts);
}

// Where a point is inside a level line through it is, too.
static void test_points(Maker maker)
{
    Random random = {200 + (uint64_t)maker};
    int differ = 0;
    for (int i = 0; i < 20000; i++) {
        Shape shape;
        RayInterval intervals[CROSSINGS_MOST];
        make(&random, maker, 1.0, &shape);
        double x = random_between(&random, 0.0, 10.0), y = random_between(&random, -10.0, 10.0);
        Ray along = {vec3(x, y, 0.0), vec3(0.0, 0.0, 1.0)};
        unsigned count = intervals_of(&shape, &along, LEFT_NONE, intervals);
        bool holds = maker == MAKE_SOR ? sor_holds(&shape.list, x * x, y) : outline_holds_turned(&shape.list, x, y);
        differ += holds != says_inside(intervals, count, 0.0);
    }
    tap_ok(differ == 0, "%s: a point is inside where a line through it is (%d are not)", maker_names[maker], differ);
}

int main(void)
{
    for (int maker = 0; maker < MAKERS; maker++) {
        for (int kind = 0; kind < KINDS; kind++) {
            test_lines((Maker)maker, (Kind)kind, 1.0);
        }
        test_lines((Maker)maker, KIND_ANY, 0x1p-40);
        test_lines((Maker)maker, KIND_ANY, 0x1p40);
        test_starts((Maker)maker);
        test_points((Maker)maker);
    }
    return tap_done();
}
