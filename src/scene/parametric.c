// A rectangle of u and v halved again and again: no piece is looked into whose box, as `max_gradient` makes it of the
// functions at the corners, the line misses, or comes to only behind what has been found.
//
// SPDX-License-Identifier: MIT
#include "scene/parametric.h"

#include <math.h>

#include "math/extreme.h"
#include "scene/scene.h"

enum {
    HALVINGS_MOST = 56, // of both sides together; more are not asked for
    ASKED_EVERY = 1024, // so often it checks whether the run was cancelled
};

// Of POV-Ray, measured: how far behind the container, and behind the start, the first point lies at least, in lengths
// of `accuracy` and in the scene's; and what of a direction, as long as 1 in the scene, counts as none.
static const double past_container = 4.0, past_start = 1e-4, no_direction = 1e-10;

typedef struct Span1 {
    double low, high;
} Span1;

// A piece of the rectangle: the functions at its corners, those of the least u first, and between which bounds they
// are.
typedef struct Piece {
    double u[2], v[2];
    double corners[3][4];
    Span1 bounds[3];
} Piece;

typedef struct Search {
    const Parametric *surface;
    FormulaSource source;
    Vec3 origin, direction;
    double slope;          // of the functions
    double short_way;      // `accuracy` along the line
    double nearest, known; // hits are behind the one; the other is what a hit is to be at, NAN: any
    ParametricHit found;
    bool has_found;
} Search;

void parametric_bounds(const Parametric *surface, Vec3 *low, Vec3 *high)
{
    const double *a = surface->low, *b = surface->high;
    *low = vec3(a[0], a[1], a[2]);
    *high = vec3(b[0], b[1], b[2]);
    if (surface->is_round != 0.0) {
        Vec3 middle = *low;
        *low = vec3_sub(middle, *high);
        *high = vec3_add(middle, *high);
    }
}

static FormulaSource source_of(const double *list, const FormulaHost *host)
{
    return formula_source_of(parametric_steps(list), parametric_of(list)->generator, host);
}

static double value_of(const FormulaSource *source, const Parametric *surface, int axis, double u, double v)
{
    double numbers[3 + FORMULA_STACK_MOST + 1] = {u, v, 0.0};
    formula_run(source, (uint32_t)surface->first[axis], numbers, numbers + 3);
    return numbers[3];
}

Vec3 parametric_across(const double *list, const FormulaHost *host, double u, double v)
{
    FormulaSource source = source_of(list, host);
    const Parametric *surface = parametric_of(list);
    double step = surface->accuracy, along_u[3], along_v[3];
    for (int axis = 0; axis < 3; axis++) {
        double at = value_of(&source, surface, axis, u, v);
        along_u[axis] = value_of(&source, surface, axis, u + step, v) - at;
        along_v[axis] = value_of(&source, surface, axis, u, v + step) - at;
    }
    Vec3 one = {along_u[0], along_u[1], along_u[2]}, other = {along_v[0], along_v[1], along_v[2]};
    double sizes[2] = {vec3_max_abs(one), vec3_max_abs(other)};
    if (!(sizes[0] > 0.0 && sizes[0] < HUGE_VAL && sizes[1] > 0.0 && sizes[1] < HUGE_VAL)) {
        return vec3(0.0, 0.0, 0.0);
    }
    return vec3_cross(vec3_ldexp(one, -ilogb(sizes[0])), vec3_ldexp(other, -ilogb(sizes[1])));
}

// ---- bounds

// Along a side of a length, between what bounds the function at its two ends.
static Span1 bounds_between(Span1 a, Span1 b, double rise)
{
    double low = 0.5 * (a.low + b.low - rise), high = 0.5 * (a.high + b.high + rise);
    return (Span1){less_of(less_of(a.low, b.low), low), greater_of(greater_of(a.high, b.high), high)};
}

static Span1 bounds_of(const Search *search, const Piece *piece, const double f[4])
{
    double along_u = search->slope * (piece->u[1] - piece->u[0]), along_v = search->slope * (piece->v[1] - piece->v[0]);
    Span1 first = bounds_between((Span1){f[0], f[0]}, (Span1){f[1], f[1]}, along_v);
    Span1 second = bounds_between((Span1){f[2], f[2]}, (Span1){f[3], f[3]}, along_v);
    return bounds_between(first, second, along_u);
}

static double value_at(const Search *search, int axis, double u, double v)
{
    return value_of(&search->source, search->surface, axis, u, v);
}

static Piece whole(const Search *search)
{
    const Parametric *surface = search->surface;
    Piece piece = {{surface->from[0], surface->to[0]}, {surface->from[1], surface->to[1]}, {{0.0}}, {{0.0, 0.0}}};
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < 4; i++) {
            piece.corners[axis][i] = value_at(search, axis, piece.u[i / 2], piece.v[i % 2]);
        }
        piece.bounds[axis] = bounds_of(search, &piece, piece.corners[axis]);
    }
    return piece;
}

// The half of a piece that is left in it, and the other one. False: it cannot be halved.
static bool halve(const Search *search, Piece *piece, Piece *other)
{
    bool is_of_u = piece->u[1] - piece->u[0] >= piece->v[1] - piece->v[0];
    double *side = is_of_u ? piece->u : piece->v, middle = 0.5 * (side[0] + side[1]);
    if (!(side[0] < middle && middle < side[1])) {
        return false;
    }
    *other = *piece;
    side[1] = middle;
    (is_of_u ? other->u : other->v)[0] = middle;
    for (int axis = 0; axis < 3; axis++) {
        double *f = piece->corners[axis], *g = other->corners[axis];
        double low =
            is_of_u ? value_at(search, axis, middle, piece->v[0]) : value_at(search, axis, piece->u[0], middle);
        double high =
            is_of_u ? value_at(search, axis, middle, piece->v[1]) : value_at(search, axis, piece->u[1], middle);
        f[is_of_u ? 2 : 1] = g[0] = low;
        f[3] = g[is_of_u ? 1 : 2] = high;
        piece->bounds[axis] = bounds_of(search, piece, f);
        other->bounds[axis] = bounds_of(search, other, g);
    }
    return true;
}

// ---- a line

// What of a line is in the box of a piece. That lies `accuracy` below the bounds.
typedef struct Way {
    double enter, leave;
    double met;    // where it comes to the last pair of sides, in the order of x, y and z, that it goes across
    double widest; // the longest way between two sides
} Way;

static bool box_of(const Search *search, const Piece *piece, Way *way)
{
    const double *o = &search->origin.x, *d = &search->direction.x, down = search->surface->accuracy;
    *way = (Way){-HUGE_VAL, HUGE_VAL, (double)NAN, 0.0};
    for (int axis = 0; axis < 3; axis++) {
        double low = piece->bounds[axis].low - down, high = piece->bounds[axis].high - down;
        if (d[axis] == 0.0) {
            if (o[axis] < low || o[axis] > high) {
                return false;
            }
            continue;
        }
        double a = (low - o[axis]) / d[axis], b = (high - o[axis]) / d[axis];
        way->met = less_of(a, b);
        way->enter = greater_of(way->enter, way->met);
        way->leave = less_of(way->leave, greater_of(a, b));
        way->widest = greater_of(way->widest, fabs(b - a));
    }
    return way->enter <= way->leave;
}

static bool ball_interval(const Parametric *surface, const Search *search, double *enter, double *leave)
{
    double inverse = 1.0 / surface->high[0];
    Vec3 middle = {surface->low[0], surface->low[1], surface->low[2]};
    Vec3 o = vec3_scale(inverse, vec3_sub(search->origin, middle)), d = vec3_scale(inverse, search->direction);
    double square = vec3_length_squared(d), at = -vec3_dot(o, d) / square;
    double depth = 1.0 - vec3_length_squared(vec3_add_scaled(o, at, d)), half = sqrt(depth / square);
    *enter = at - half; // not less than 0 where the line starts in it, as in POV-Ray
    *leave = at + half;
    return depth >= 0.0;
}

static bool box_interval(const Parametric *surface, const Search *search, double *enter, double *leave)
{
    const double *o = &search->origin.x, *d = &search->direction.x;
    *enter = 0.0;
    *leave = HUGE_VAL;
    for (int axis = 0; axis < 3; axis++) {
        if (d[axis] == 0.0) {
            if (o[axis] < surface->low[axis] || o[axis] > surface->high[axis]) {
                return false;
            }
            continue;
        }
        double a = (surface->low[axis] - o[axis]) / d[axis], b = (surface->high[axis] - o[axis]) / d[axis];
        *enter = greater_of(*enter, less_of(a, b));
        *leave = less_of(*leave, greater_of(a, b));
    }
    return *enter <= *leave;
}

// The piece is as small as they become. What is at one t as another one, or known, is not better.
static void take(Search *search, const Piece *piece, double met)
{
    bool is_known = !isnan(search->known);
    double off = fabs(met - search->known);
    if (is_known ? off < search->nearest : met > search->nearest && met < search->found.t) {
        search->found = (ParametricHit){met, piece->u[0], piece->v[0]};
        search->nearest = is_known ? off : search->nearest;
        search->has_found = true;
    }
}

// Whether a piece is to be looked into.
static bool may_hold(const Search *search, const Way *way)
{
    if (!isnan(search->known)) {
        return way->leave >= search->known - search->nearest && way->met <= search->known + search->nearest;
    }
    return way->leave >= search->nearest && way->enter < search->found.t;
}

static void search_pieces(Search *search, const ParametricLine *line)
{
    Piece waiting[HALVINGS_MOST], piece = whole(search);
    unsigned count = 0;
    for (unsigned asked = 1;; asked++) {
        Way way;
        bool is_in = box_of(search, &piece, &way) && may_hold(search, &way);
        double size = greater_of(piece.u[1] - piece.u[0], piece.v[1] - piece.v[0]);
        bool is_small = size < search->surface->accuracy || way.widest < search->short_way || count == HALVINGS_MOST;
        if (is_in && !is_small && halve(search, &piece, &waiting[count])) {
            count++;
            continue;
        }
        if (is_in) {
            take(search, &piece, way.met);
        }
        if (count == 0 || (asked % ASKED_EVERY == 0 && line->is_over && line->is_over(line->client))) {
            return;
        }
        piece = waiting[--count];
    }
}

static Search search_of(const ParametricLine *line)
{
    const Parametric *surface = parametric_of(line->list);
    Search search = {.surface = surface,
                     .source = source_of(line->list, line->host),
                     .origin = line->ray.origin,
                     .direction = line->ray.direction,
                     .slope = surface->max_gradient,
                     .short_way = surface->accuracy / line->length};
    double *d = &search.direction.x, none = no_direction * line->length;
    for (int axis = 0; axis < 3; axis++) {
        d[axis] = fabs(d[axis]) <= none ? 0.0 : d[axis];
    }
    return search;
}

bool parametric_find(const ParametricLine *line, ParametricHit *hit)
{
    Search search = search_of(line);
    const Parametric *surface = search.surface;
    double enter, leave;
    if (!(surface->is_round != 0.0 ? ball_interval : box_interval)(surface, &search, &enter, &leave) ||
        !(leave > 0.0)) {
        return false;
    }
    search.nearest = enter + past_container * search.short_way;
    search.found.t = leave;
    search.known = (double)NAN;
    search_pieces(&search, line);
    *hit = search.found;
    return search.has_found && hit->t * line->length > past_start;
}

bool parametric_find_at(const ParametricLine *line, double t, ParametricHit *hit)
{
    Search search = search_of(line);
    search.known = t;
    search.nearest = search.short_way;
    search_pieces(&search, line);
    *hit = search.found;
    return search.has_found;
}
