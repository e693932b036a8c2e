// Lathes and surfaces of revolution: points become an outline (scene/outline.h) or a list of cubics (scene/sor.h) that
// is turned about y.
//
// The curve of a lathe need not be closed. As for POV-Ray it is then closed, where nothing is seen, by a straight line
// from each of its ends along x to where it is nearest to the axis, and by one along y between them; gaps between
// Bézier pieces likewise. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "eval/build/outline.h"
#include "scene/sor.h"

// A point of a sor and the next but one differ as much in height. Measured.
static const double LEVEL = 1e-10;

// What stands before "lathe" in messages, and the least number of points.
static const unsigned least_points[] = {
    [CURVE_LINEAR] = 2, [CURVE_QUADRATIC] = 3, [CURVE_CUBIC] = 4, [CURVE_BEZIER] = 4};

// ---- lathe

// All but the first and the last point must lie at x >= 0, as for POV-Ray.
static bool radii_are_fine(Block *block, const OutlinePoint *points, size_t count, Span span)
{
    for (size_t i = 1; i + 1 < count; i++) {
        if (points[i].u < 0.0) {
            return block_fault(block, DIAG_E0487, span,
                               "point %zu of the %s is at a radius less than 0: only the first and the last may be",
                               i + 1, block_word(block));
        }
    }
    return true;
}

// The pieces of the curve, each but for those of no length; a point as near to another as CLOSED is that one.
static void draw_curve(OutlinePen *pen, OutlineCurve curve, const OutlinePoint *p, size_t count)
{
    size_t before = curve == CURVE_QUADRATIC || curve == CURVE_CUBIC ? 1 : 0, behind = curve == CURVE_CUBIC ? 1 : 0;
    size_t step = curve == CURVE_BEZIER ? 4 : 1, first = before, last = count - behind - 1;
    for (size_t i = first; i < last; i += step) {
        size_t to = curve == CURVE_BEZIER ? i + 3 : i + 1;
        OutlinePoint piece[4] = {p[i - before], p[i - before + 1], p[i - before + 1], p[i - before + 1]};
        OutlinePoint end = to == last && outline_is_same(p[to], p[first]) ? p[first] : p[to];
        for (size_t k = 2; k < 4 && i - before + k < count; k++) {
            piece[k] = p[i - before + k];
        }
        if (curve == CURVE_BEZIER && i > first && outline_is_same(p[i], p[i - 1])) {
            piece[0] = p[i - 1];
        }
        bool is_point = curve == CURVE_LINEAR && piece[0].u == end.u && piece[0].v == end.v;
        if (!is_point) {
            outline_pen_piece(pen, curve, piece, end);
        }
    }
}

static OutlinePoint piece_end(const Numbers *outline, uint32_t i, bool is_last)
{
    const double *points = outline_piece(outline, i) + (is_last ? 2 * outline_degree(outline) : 0);
    return (OutlinePoint){points[0], points[1]};
}

// From one end of what is drawn to another.
static void close_gap(OutlinePen *pen, OutlinePoint from, OutlinePoint to, double inner)
{
    if (from.u == to.u && from.v == to.v) {
        return;
    }
    const OutlinePoint way[4] = {from, {inner, from.v}, {inner, to.v}, to};
    for (int i = 0; i < 3; i++) {
        outline_add_unseen(pen->items, &pen->count, way[i], way[i + 1]);
    }
}

static void close_curve(OutlinePen *pen, bool is_control_bound)
{
    const Numbers drawn = {pen->items, pen->count};
    uint32_t pieces = outline_piece_count(&drawn);
    OutlinePoint low, high;
    (is_control_bound ? outline_bounds : outline_extent)(&drawn, &low, &high);
    for (uint32_t i = 0; i < pieces; i++) { // an extent has the starts of pieces only, as closed curves need
        low.u = fmin(low.u, piece_end(&drawn, i, true).u);
    }
    double inner = fmax(low.u, 0.0);
    pen->items[OUTLINE_MIRRORED] = low.u < 0.0 ? 1.0 : 0.0;
    for (uint32_t i = 0; i < pieces; i++) {
        close_gap(pen, piece_end(&drawn, i, true), piece_end(&drawn, i + 1 < pieces ? i + 1 : 0, false), inner);
    }
}

bool lathe_body(Block *block)
{
    LatheDesc *lathe = &block->record->lathe;
    OutlineCurve curve = CURVE_LINEAR;
    OutlinePoint *points;
    OutlinePen pen;
    size_t count;
    Span span;
    char what[32];
    outline_read_words(block, &curve, NULL);
    snprintf(what, sizeof what, "%s ", outline_curve_name(curve));
    if (!outline_read_count(block, least_points[curve], what, &count, &span)) {
        return false;
    }
    if (curve == CURVE_BEZIER && count % 4 != 0) {
        return block_fault(block, DIAG_E0492, span,
                           "a Bézier lathe has four points for each piece, and %zu is no multiple of 4", count);
    }
    if (!outline_read_points(block, count, span, &points) || !radii_are_fine(block, points, count, span) ||
        !outline_pen_begin(block, &pen, curve, false, 4 * count, span)) {
        return false;
    }
    draw_curve(&pen, curve, points, count);
    lathe->is_control_bound = curve == CURVE_BEZIER;
    if (pen.count > OUTLINE_HEAD) {
        close_curve(&pen, lathe->is_control_bound);
        lathe->outline = (Numbers){pen.items, pen.count};
    }
    return true;
}

static double greatest_radius(OutlinePoint low, OutlinePoint high)
{
    return fmax(fabs(low.u), fabs(high.u));
}

const char *lathe_form(const void *object, Primitive *primitive)
{
    const LatheDesc *lathe = object;
    OutlinePoint low, high;
    if (lathe->outline.count == 0) {
        return "a lathe of points that are all one is not drawn";
    }
    outline_bounds(&lathe->outline, &low, &high);
    double radius = greatest_radius(low, high);
    if (radius == 0.0) {
        return "a lathe along its axis is not drawn";
    }
    primitive->kind = PRIMITIVE_LATHE;
    primitive->list = lathe->outline;
    primitive->fixed[0] = vec3(-radius, low.v, -radius);
    primitive->fixed[1] = vec3(radius, high.v, radius);
    primitive->to_world = transform_identity();
    return NULL;
}

bool lathe_holds(const void *object, Vec3 p, bool is_turned)
{
    const LatheDesc *lathe = object;
    return (lathe->outline.count > 0 && outline_holds_turned(&lathe->outline, hypot(p.x, p.z), p.y)) != is_turned;
}

// Of all control points, or of the curves.
bool lathe_box(const void *object, OwnBox *own)
{
    const LatheDesc *lathe = object;
    OutlinePoint low = {0.0, 0.0}, high = {0.0, 0.0};
    if (lathe->outline.count > 0) {
        (lathe->is_control_bound ? outline_bounds : outline_extent)(&lathe->outline, &low, &high);
    }
    double radius = greatest_radius(low, high);
    own->low = vec3(-radius, low.v, -radius);
    own->high = vec3(radius, high.v, radius);
    return false;
}

// ---- surface of revolution

// Heights rise, but for those of the first and the last point; no radius is less than 0; no point is as high as the
// next but one.
static bool sor_points_are_fine(Block *block, const OutlinePoint *p, size_t count, Span span)
{
    for (size_t i = 0; i < count; i++) {
        if (p[i].u < 0.0) {
            return block_fault(block, DIAG_E0487, span, "point %zu of the sor has a radius less than 0", i + 1);
        }
        if (i > 1 && i + 1 < count && !(p[i].v > p[i - 1].v)) {
            return block_fault(block, DIAG_E0487, span, "point %zu of the sor must be higher than the one before it",
                               i + 1);
        }
        if (i > 1 && !(fabs(p[i].v - p[i - 2].v) >= LEVEL)) {
            return block_fault(
                block, DIAG_E0487, span,
                "points %zu and %zu of the sor are at one height, so that there is no slope between them", i - 1,
                i + 1);
        }
    }
    return true;
}

bool sor_body(Block *block)
{
    SorDesc *sor = &block->record->sor;
    OutlinePoint *points;
    size_t count;
    Span span;
    if (!outline_read_count(block, SOR_POINTS_LEAST, "", &count, &span) ||
        !outline_read_points(block, count, span, &points) || !sor_points_are_fine(block, points, count, span)) {
        return false;
    }
    uint64_t all = sor_list_count((uint32_t)count);
    double *items = arena_alloc_array(block->arena, all, sizeof *items);
    if (!items) {
        return eval_no_memory(block->ev, span);
    }
    items[0] = (double)count;
    for (size_t i = 0; i < count; i++) {
        items[1 + 2 * i] = points[i].u;
        items[2 + 2 * i] = points[i].v;
    }
    sor_complete(items);
    sor->list = (Numbers){items, all};
    return true;
}

static void sor_extent(const Numbers *list, double radius, Vec3 *low, Vec3 *high)
{
    *low = vec3(-radius, sor_height(list, 0), -radius);
    *high = vec3(radius, sor_height(list, sor_stretch_count(list)), radius);
}

const char *sor_form(const void *object, Primitive *primitive)
{
    const SorDesc *sor = object;
    double radius = sor_radius_most(&sor->list);
    if (radius == 0.0) {
        return "a sor of no radius is not drawn";
    }
    primitive->kind = PRIMITIVE_SOR;
    primitive->flags = sor->is_open ? PRIMITIVE_OPEN : 0;
    primitive->list = sor->list;
    sor_extent(&sor->list, radius, &primitive->fixed[0], &primitive->fixed[1]);
    primitive->to_world = transform_identity();
    return NULL;
}

bool sor_has(const void *object, Vec3 p, bool is_turned)
{
    const SorDesc *sor = object;
    return sor_holds(&sor->list, p.x * p.x + p.z * p.z, p.y) != is_turned;
}

bool sor_box(const void *object, OwnBox *own)
{
    const SorDesc *sor = object;
    sor_extent(&sor->list, sor_radius_extent(&sor->list), &own->low, &own->high);
    return false;
}
