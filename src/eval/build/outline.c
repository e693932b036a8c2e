// Prisms and polygons: words, numbers and points become an outline (scene/outline.h), in the way of POV-Ray's curves.
//
// A curve begins with the first point after another one is closed, and is closed by the first point that equals its
// own. Of a quadratic curve a point stands before that, of a cubic one another behind the last: they say how steep it
// is there. Points as near as CLOSED are equal, as in POV-Ray. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "eval/build/outline.h"

// Measured.
static const double CLOSED = 5e-11;

// How far a point may be off the plane of the others, as a part of their distances.
static const double FLAT = 1e-6;

static const struct {
    Word word;
    unsigned least; // points
    const char *name;
} curves[] = {
    [CURVE_LINEAR] = {W_linear_spline, 3, "linear"},
    [CURVE_QUADRATIC] = {W_quadratic_spline, 5, "quadratic"},
    [CURVE_CUBIC] = {W_cubic_spline, 6, "cubic"},
    [CURVE_BEZIER] = {W_bezier_spline, 4, "Bézier"},
};

bool outline_is_same(OutlinePoint a, OutlinePoint b)
{
    return fabs(a.u - b.u) < CLOSED && fabs(a.v - b.v) < CLOSED;
}

// a + s (b - c)
static OutlinePoint moved(OutlinePoint a, double s, OutlinePoint b, OutlinePoint c)
{
    return (OutlinePoint){a.u + s * (b.u - c.u), a.v + s * (b.v - c.v)};
}

void outline_pen_piece(OutlinePen *pen, OutlineCurve curve, const OutlinePoint *p, OutlinePoint end)
{
    OutlinePoint piece[4] = {p[0], end}, bend;
    switch (curve) {
    case CURVE_LINEAR:
        break;
    case CURVE_QUADRATIC: // (p2 - p0)/2 is its derivative at p1; as a cubic
        bend = moved(p[1], 0.25, p[2], p[0]);
        piece[0] = p[1];
        piece[1] = moved(p[1], 1.0 / 6.0, p[2], p[0]);
        piece[2] = moved(end, 2.0 / 3.0, bend, end);
        piece[3] = end;
        break;
    case CURVE_CUBIC: // (p2 - p0)/2 and (p3 - p1)/2 are those at its ends
        piece[0] = p[1];
        piece[1] = moved(p[1], 1.0 / 6.0, p[2], p[0]);
        piece[2] = moved(end, -1.0 / 6.0, p[3], p[1]);
        piece[3] = end;
        break;
    case CURVE_BEZIER:
        memcpy(piece, p, 3 * sizeof piece[0]);
        piece[3] = end;
        break;
    }
    outline_add(pen->items, &pen->count, &piece[0].u);
}

const char *outline_curve_name(OutlineCurve curve)
{
    return curves[curve].name;
}

static bool not_closed(Block *block, OutlineCurve curve, Span span)
{
    return block_fault(block, DIAG_E0493, span,
                       "a %s outline of the %s is not closed: its last point must equal its first", curves[curve].name,
                       block_word(block));
}

// Straight pieces; the last outline is closed, with a warning, where it is not.
static bool draw_linear(Block *block, OutlinePen *pen, const OutlinePoint *p, size_t count, Span span)
{
    size_t first = 0;
    for (size_t i = 1; i < count; i++) {
        bool closes = i > first && outline_is_same(p[i], p[first]);
        if (i > first) {
            outline_pen_piece(pen, CURVE_LINEAR, p + i - 1, closes ? p[first] : p[i]);
        }
        first = closes ? i + 1 : first;
        if (!closes && i + 1 == count && i > first) {
            outline_pen_piece(pen, CURVE_LINEAR, p + i, p[first]);
            eval_warn(block->ev, DIAG_W0492, span,
                      "an outline of the %s is not closed: its first point is taken as its last", block_word(block));
        }
    }
    return first + 1 != count ||
           block_fault(block, DIAG_E0492, span, "the last point of the %s begins an outline", block_word(block));
}

static bool draw_bezier(Block *block, OutlinePen *pen, const OutlinePoint *p, size_t count, Span span)
{
    size_t first = 0;
    for (size_t i = 0; i < count; i += 4) {
        bool closes = outline_is_same(p[i + 3], p[first]);
        if (i > first && !outline_is_same(p[i], p[i - 1])) {
            return not_closed(block, CURVE_BEZIER, span);
        }
        OutlinePoint piece[4] = {p[i], p[i + 1], p[i + 2], p[i + 3]};
        if (i > first) {
            piece[0] = p[i - 1];
        }
        outline_pen_piece(pen, CURVE_BEZIER, piece, closes ? p[first] : p[i + 3]);
        first = closes ? i + 4 : first;
    }
    return first == count || not_closed(block, CURVE_BEZIER, span);
}

// Each outline has a point before its first, a cubic one another behind its last.
static bool draw_spline(Block *block, OutlinePen *pen, OutlineCurve curve, const OutlinePoint *p, size_t count,
                        Span span)
{
    size_t first = 1, behind = curve == CURVE_CUBIC ? 1 : 0;
    while (first < count) {
        size_t last = first + 1;
        while (last < count && !outline_is_same(p[last], p[first])) {
            last++;
        }
        if (last + behind >= count) {
            return not_closed(block, curve, span);
        }
        for (size_t i = first; i < last; i++) {
            outline_pen_piece(pen, curve, p + i - 1, i + 1 == last ? p[first] : p[i + 1]);
        }
        first = last + behind + 2;
    }
    return first == count + 1 ||
           block_fault(block, DIAG_E0492, span, "the last point of the %s begins an outline", block_word(block));
}

bool outline_pen_begin(Block *block, OutlinePen *pen, OutlineCurve curve, bool is_conic, size_t pieces, Span span)
{
    size_t most = OUTLINE_HEAD + OUTLINE_PIECE_NUMBERS * pieces;
    *pen = (OutlinePen){arena_alloc_array(block->arena, most, sizeof *pen->items), 0};
    if (!pen->items) {
        return eval_no_memory(block->ev, span);
    }
    outline_begin(pen->items, &pen->count, curve == CURVE_LINEAR ? 1 : 3, is_conic);
    return true;
}

// An outline as it is written.
typedef struct OutlineText {
    OutlineCurve curve;
    bool is_conic;
    const OutlinePoint *points;
    size_t count;
    Span span;
} OutlineText;

static bool make_outline(Block *block, const OutlineText *text, Numbers *outline)
{
    const OutlineCurve curve = text->curve;
    const OutlinePoint *points = text->points;
    size_t count = text->count;
    OutlinePen pen;
    if (!outline_pen_begin(block, &pen, curve, text->is_conic, count + 1, text->span)) {
        return false;
    }
    bool is_drawn = curve == CURVE_LINEAR   ? draw_linear(block, &pen, points, count, text->span)
                    : curve == CURVE_BEZIER ? draw_bezier(block, &pen, points, count, text->span)
                                            : draw_spline(block, &pen, curve, points, count, text->span);
    *outline = (Numbers){pen.items, pen.count};
    return is_drawn;
}

// ---- reading

bool outline_read_count(Block *block, unsigned least, const char *what, size_t *count, Span *span)
{
    double number;
    *span = block->node->span;
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`%s` needs a number here: its number of points",
                           block_word(block));
    }
    if (!cursor_number(&block->cursor, &number, span) || !block_finite(block, number, *span, "number of points")) {
        return false;
    }
    if (!(number >= least)) {
        return block_fault(block, DIAG_E0492, *span, "a %s%s needs at least %u points", what, block_word(block), least);
    }
    if (number > OUTLINE_PIECES_MOST) {
        return block_fault(block, DIAG_E0494, *span, "a %s has at most %d points here", block_word(block),
                           OUTLINE_PIECES_MOST);
    }
    *count = (size_t)number;
    return true;
}

// Whether a point may stand next; else reports how many there are.
static bool is_at_point(Block *block, size_t read, size_t count)
{
    cursor_take_comma(&block->cursor);
    if (cursor_at_value(&block->cursor)) {
        return true;
    }
    return !block->ev->stop && block_fault(block, DIAG_E0492, block_here(block), "`%s` needs %zu points, and has %zu",
                                           block_word(block), count, read);
}

static bool read_point(Block *block, OutlinePoint *point)
{
    Value value;
    const AstNode *item = cursor_peek(&block->cursor);
    Span span = item->span;
    if (!cursor_value(&block->cursor, &value)) {
        return false;
    }
    if (value.kind == VALUE_NUMBER) {
        *point = (OutlinePoint){value.number, value.number};
    } else if (value.kind == VALUE_VECTOR && value.components == 2) {
        *point = (OutlinePoint){value.v[0], value.v[1]};
    } else {
        return block_fault(block, DIAG_E0202, span, "a point of a %s is a vector of 2, not %s", block_word(block),
                           value_describe(&value));
    }
    return (isfinite(point->u) && isfinite(point->v)) ||
           block_fault(block, DIAG_E0340, span, "a point of a %s has a coordinate that is not finite",
                       block_word(block));
}

bool outline_read_points(Block *block, size_t count, Span span, OutlinePoint **points)
{
    *points = arena_alloc_array(block->arena, count, sizeof **points);
    if (!*points) {
        return eval_no_memory(block->ev, span);
    }
    for (size_t i = 0; i < count; i++) {
        if (!is_at_point(block, i, count) || !read_point(block, &(*points)[i])) {
            return false;
        }
    }
    return true;
}

static bool read_height(Block *block, const char *what, double *height)
{
    Span span = block->node->span;
    if (!cursor_at_value(&block->cursor)) {
        return block_fault(block, DIAG_E0253, block_here(block), "`%s` needs a number here: its %s height",
                           block_word(block), what);
    }
    if (!cursor_number(&block->cursor, height, &span) || !block_finite(block, *height, span, what)) {
        return false;
    }
    cursor_take_comma(&block->cursor);
    return true;
}

void outline_read_words(Block *block, OutlineCurve *curve, bool *is_conic)
{
    for (bool is_word = true; is_word;) {
        is_word = false;
        for (unsigned i = 0; i < RT_COUNT_OF(curves); i++) {
            if (cursor_at_word(&block->cursor, curves[i].word)) {
                *curve = (OutlineCurve)i;
                is_word = true;
            }
        }
        bool is_straight = is_conic && cursor_at_word(&block->cursor, W_linear_sweep);
        if (is_straight || (is_conic && cursor_at_word(&block->cursor, W_conic_sweep))) {
            *is_conic = !is_straight;
            is_word = true;
        }
        if (is_word) {
            cursor_skip(&block->cursor);
        }
    }
}

bool prism_body(Block *block)
{
    PrismDesc *prism = &block->record->prism;
    OutlineCurve curve = CURVE_LINEAR;
    bool is_conic = false;
    double heights[2];
    size_t count;
    Span span;
    char what[32];
    outline_read_words(block, &curve, &is_conic);
    snprintf(what, sizeof what, "%s ", curves[curve].name);
    if (!read_height(block, "first", &heights[0]) || !read_height(block, "second", &heights[1]) ||
        !outline_read_count(block, curves[curve].least, what, &count, &span)) {
        return false;
    }
    if (curve == CURVE_BEZIER && count % 4 != 0) {
        return block_fault(block, DIAG_E0492, span,
                           "a Bézier prism has four points for each piece, and %zu is no "
                           "multiple of 4",
                           count);
    }
    OutlinePoint *points;
    if (!outline_read_points(block, count, span, &points)) {
        return false;
    }
    prism->heights[0] = fmin(heights[0], heights[1]);
    prism->heights[1] = fmax(heights[0], heights[1]);
    prism->is_control_bound = curve == CURVE_BEZIER;
    return make_outline(block, &(OutlineText){curve, is_conic, points, count, span}, &prism->outline);
}

// ---- the plane of a polygon

// The point that is farthest from p[0], or from the line from there along `axis`.
static Vec3 farthest(const Vec3 *p, size_t count, const Vec3 *axis)
{
    Vec3 found = {0.0, 0.0, 0.0};
    double most = 0.0;
    for (size_t i = 1; i < count; i++) {
        Vec3 from = vec3_sub(p[i], p[0]);
        from = axis ? vec3_add_scaled(from, -vec3_dot(from, *axis), *axis) : from;
        double length = vector_length(from);
        found = length > most ? from : found;
        most = length > most ? length : most;
    }
    return found;
}

// Its own plane at z = 0; of one at right angles to z x and y are the scene's. A frame of nothing where all lie on a
// line. Its side is that of the first three points that are on no line. Measured.
static bool polygon_frame(Block *block, const Vec3 *p, size_t count, Span span, Transform *frame)
{
    Vec3 farther = farthest(p, count, NULL), x = vector_unit(farther), y = vector_unit(farthest(p, count, &x));
    Vec3 z = vec3_cross(x, y);
    double most = FLAT * vector_length(farther);
    bool is_level = true;
    *frame = transform_translate(vec3(0.0, 0.0, p[0].z));
    for (size_t i = 1; i < count; i++) {
        is_level = is_level && p[i].z == p[0].z;
        if (fabs(vec3_dot(vec3_sub(p[i], p[0]), z)) > most) {
            return block_fault(block, DIAG_E0495, span, "the points of a polygon must lie in one plane");
        }
    }
    if (!is_level || vec3_equal(z, vec3(0.0, 0.0, 0.0))) {
        const Vec3 rows[4] = {x, y, z, p[0]};
        for (int row = 0; row < 4; row++) {
            memcpy(frame->m[row], &rows[row], sizeof frame->m[row]);
        }
    }
    Vec3 side = vec3(0.0, 0.0, 0.0), front = vec3(frame->m[2][0], frame->m[2][1], frame->m[2][2]);
    for (size_t i = 2; i < count && vec3_equal(side, vec3(0.0, 0.0, 0.0)); i++) {
        side = vec3_cross(vector_unit(vec3_sub(p[1], p[0])), vector_unit(vec3_sub(p[i], p[0])));
    }
    for (int axis = 0; axis < 3 && vec3_dot(side, front) < 0.0; axis++) {
        frame->m[2][axis] = -frame->m[2][axis];
    }
    return true;
}

static bool read_vector(Block *block, Vec3 *point)
{
    Span span;
    return cursor_vector3(&block->cursor, point, &span) &&
           (vec3_is_finite(*point) ||
            block_fault(block, DIAG_E0340, span, "a point of a polygon has a coordinate that is not finite"));
}

bool polygon_body(Block *block)
{
    PolygonDesc *polygon = &block->record->polygon;
    size_t count;
    Span span;
    if (!outline_read_count(block, 3, "", &count, &span)) {
        return false;
    }
    Vec3 *corners = arena_alloc_array(block->arena, count, sizeof *corners);
    OutlinePoint *points = arena_alloc_array(block->arena, count, sizeof *points);
    if (!corners || !points) {
        return eval_no_memory(block->ev, span);
    }
    for (size_t i = 0; i < count; i++) {
        if (!is_at_point(block, i, count) || !read_vector(block, &corners[i])) {
            return false;
        }
    }
    if (!polygon_frame(block, corners, count, span, &polygon->frame)) {
        return false;
    }
    Transform back;
    bool has_plane = transform_invert(&polygon->frame, &back);
    for (size_t i = 0; has_plane && i < count; i++) {
        Vec3 own = transform_point(&back, corners[i]);
        points[i] = (OutlinePoint){own.x, own.y};
    }
    return !has_plane || make_outline(block, &(OutlineText){CURVE_LINEAR, false, points, count, span}, &polygon->outline);
}

// ---- shapes

// From the least and greatest coordinates of the outline, those of the prism.
static void prism_extent(const PrismDesc *prism, OutlinePoint low, OutlinePoint high, Vec3 *least, Vec3 *greatest)
{
    bool is_conic = outline_is_conic(&prism->outline);
    double first = is_conic ? prism->heights[0] : 1.0, second = is_conic ? prism->heights[1] : 1.0;
    const Vec3 corners[4] = {vec3(first * low.u, prism->heights[0], first * low.v),
                             vec3(first * high.u, prism->heights[0], first * high.v),
                             vec3(second * low.u, prism->heights[1], second * low.v),
                             vec3(second * high.u, prism->heights[1], second * high.v)};
    *least = *greatest = corners[0];
    for (int i = 1; i < 4; i++) {
        *least = vec3_least(*least, corners[i]);
        *greatest = vec3_greatest(*greatest, corners[i]);
    }
}

// What an outline in the plane z = 0 encloses.
static void flat_form(const Numbers *outline, Primitive *primitive)
{
    OutlinePoint low, high;
    outline_bounds(outline, &low, &high);
    primitive->kind = PRIMITIVE_POLYGON;
    primitive->list = *outline;
    primitive->fixed[0] = vec3(low.u, low.v, 0.0);
    primitive->fixed[1] = vec3(high.u, high.v, 0.0);
}

// Without a height, its ends are one flat shape.
static const char *flat_prism_form(const PrismDesc *prism, Primitive *primitive)
{
    double height = prism->heights[0], size = outline_is_conic(&prism->outline) ? height : 1.0;
    if (prism->is_open || size == 0.0) {
        return prism->is_open ? "an open prism without a height is not drawn" : "the tip of a prism is not drawn";
    }
    flat_form(&prism->outline, primitive);
    // Its coordinates are x and z of the prism.
    primitive->to_world = (Transform){{{size, 0.0, 0.0}, {0.0, 0.0, size}, {0.0, -1.0, 0.0}, {0.0, height, 0.0}}};
    return NULL;
}

const char *prism_form(const void *object, Primitive *primitive)
{
    const PrismDesc *prism = object;
    OutlinePoint low, high;
    if (prism->heights[0] == prism->heights[1]) {
        return flat_prism_form(prism, primitive);
    }
    outline_bounds(&prism->outline, &low, &high);
    primitive->kind = PRIMITIVE_PRISM;
    primitive->flags = prism->is_open ? PRIMITIVE_OPEN : 0;
    primitive->list = prism->outline;
    prism_extent(prism, low, high, &primitive->fixed[0], &primitive->fixed[1]);
    primitive->to_world = transform_identity();
    return NULL;
}

bool prism_holds(const void *object, Vec3 p, bool is_turned)
{
    const PrismDesc *prism = object;
    bool is_conic = outline_is_conic(&prism->outline);
    OutlinePoint seen = is_conic ? (OutlinePoint){p.x / p.y, p.z / p.y} : (OutlinePoint){p.x, p.z};
    bool holds = p.y >= prism->heights[0] && p.y <= prism->heights[1] && outline_holds(&prism->outline, seen);
    return holds != is_turned;
}

// Of all control points, or of the curves.
bool prism_box(const void *object, OwnBox *own)
{
    const PrismDesc *prism = object;
    OutlinePoint low, high;
    (prism->is_control_bound ? outline_bounds : outline_extent)(&prism->outline, &low, &high);
    prism_extent(prism, low, high, &own->low, &own->high);
    return false;
}

const char *polygon_form(const void *object, Primitive *primitive)
{
    const PolygonDesc *polygon = object;
    if (polygon->outline.count == 0) {
        return "a polygon with its points on one line is not drawn";
    }
    flat_form(&polygon->outline, primitive);
    primitive->to_world = polygon->frame;
    return NULL;
}

bool polygon_box(const void *object, OwnBox *own)
{
    static const double thickness = 0.001; // half of what POV-Ray gives it
    const PolygonDesc *polygon = object;
    OutlinePoint low = {0.0, 0.0}, high = {0.0, 0.0};
    if (polygon->outline.count > 0) {
        outline_bounds(&polygon->outline, &low, &high);
    }
    own->low = vec3(low.u, low.v, -thickness);
    own->high = vec3(high.u, high.v, thickness);
    own->frame = polygon->frame;
    return true;
}
