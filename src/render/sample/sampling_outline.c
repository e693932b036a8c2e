// Outlines of spheres in the picture: see sampling_outline.h.
//
// A ray along d from the eye meets the sphere of radius r around f where |d x f|² <= r² |d|². With d = d0 + x c + y w,
// d0 through the sphere's middle and so d0 x f = 0, that is a form of second degree in the pixel's x and y, in which
// nothing cancels.
//
// SPDX-License-Identifier: MIT
#include "render/sample/sampling_outline.h"

// Smaller ones are never a stratum, and rounding would be seen in larger ones. In pixels.
static const double OUTLINE_LEAST = 0x1p-5, OUTLINE_MOST = 0x1p24;

// A break that is so near to its place, in pixels, is as good.
static const double ROOT_NEAR = 1e-5;

enum { ROUGH_ROWS = 16, BREAKS_MOST = 64, ROOT_STEPS = 32, DIP_STEPS = 32 };

bool outline_view_init(OutlineView *view, const PreparedCamera *camera, int width, int height)
{
    Vec3 down = vec3_neg(camera->up);
    Vec3 of_right = vec3_cross(down, camera->direction), of_down = vec3_cross(camera->direction, camera->right);
    double scale = 1.0 / vec3_dot(camera->right, of_right);
    *view = (OutlineView){.camera = camera,
                          .width = width,
                          .height = height,
                          .across = vec3_scale(scale, of_right),
                          .down = vec3_scale(scale, of_down),
                          .ahead = vec3_scale(scale, vec3_cross(camera->right, down)),
                          .column = vec3_scale(1.0 / width, camera->right),
                          .row = vec3_scale(1.0 / height, down)};
    return camera->type <= CAMERA_ORTHOGRAPHIC && camera->lens_radius == 0.0 && vec3_is_finite(view->across) &&
           vec3_is_finite(view->down) && vec3_is_finite(view->ahead);
}

// The points around the form's own middle where -xx x² - 2 xy x y - yy y² + 2 x_part x + 2 y_part y + inside >= 0.
typedef struct Form {
    double xx, xy, yy, x_part, y_part, inside;
} Form;

static bool outline_of_form(Form form, Outline *outline)
{
    double size = form.xx * form.yy - form.xy * form.xy;
    double x = (form.yy * form.x_part - form.xy * form.y_part) / size;
    double y = (form.xx * form.y_part - form.xy * form.x_part) / size;
    double inside = form.inside + form.x_part * x + form.y_part * y;
    outline->x += x;
    outline->y += y;
    outline->slope = -form.xy / form.xx;
    outline->half_row = sqrt(inside / form.xx);
    outline->narrowing = size / (inside * form.xx);
    double width = outline_half_width(outline), height = outline_half_height(outline);
    return form.xx > 0.0 && size > 0.0 && width >= OUTLINE_LEAST && height >= OUTLINE_LEAST && width <= OUTLINE_MOST &&
           height <= OUTLINE_MOST && fabs(outline->x) <= OUTLINE_MOST && fabs(outline->y) <= OUTLINE_MOST;
}

bool outline_of(const OutlineView *view, Vec3 centre, double radius_squared, Outline *outline, double *distance)
{
    const PreparedCamera *camera = view->camera;
    bool is_flat = camera->type == CAMERA_ORTHOGRAPHIC;
    Vec3 offset = vec3_sub(centre, camera->location);
    double ahead = vec3_dot(view->ahead, offset), depth = is_flat ? 1.0 : ahead;
    double apart = is_flat ? ahead * ahead : vec3_length_squared(offset);
    if (!(ahead > 0.0) || !(apart > radius_squared)) {
        return false;
    }
    *distance = is_flat ? ahead : sqrt(apart - radius_squared);
    outline->x = (vec3_dot(view->across, offset) / depth + 0.5) * view->width - 0.5;
    outline->y = (vec3_dot(view->down, offset) / depth + 0.5) * view->height - 0.5;
    Vec3 line = is_flat ? camera->direction : offset;
    Vec3 column = vec3_cross(view->column, line), row = vec3_cross(view->row, line);
    Form form = {.xx = vec3_length_squared(column),
                 .xy = vec3_dot(column, row),
                 .yy = vec3_length_squared(row),
                 .inside = radius_squared};
    if (!is_flat) { // the rays' lengths differ
        Vec3 middle = vec3_scale(1.0 / ahead, offset);
        form.xx -= radius_squared * vec3_length_squared(view->column);
        form.xy -= radius_squared * vec3_dot(view->column, view->row);
        form.yy -= radius_squared * vec3_length_squared(view->row);
        form.x_part = radius_squared * vec3_dot(middle, view->column);
        form.y_part = radius_squared * vec3_dot(middle, view->row);
        form.inside *= vec3_length_squared(middle);
    }
    return outline_of_form(form, outline);
}

OutlineColumns outline_columns(const Outline *outline, double top, double bottom)
{
    const double none = HUGE_VAL, ends[2] = {top, bottom};
    double width = outline_half_width(outline), height = outline_half_height(outline);
    double lean = width > 0.0 ? outline->slope / (outline->narrowing * width) : 0.0, left[2], right[2];
    OutlineColumns columns = {none, -none, none, -none};
    bool has[2];
    for (int i = 0; i < 2; i++) {
        has[i] = outline_row(outline, ends[i], &left[i], &right[i]);
        if (has[i]) {
            columns.left = fmin(columns.left, left[i]);
            columns.right = fmax(columns.right, right[i]);
        }
        double tip = outline->y + (2 * i - 1) * height, at = outline->x + outline->slope * (2 * i - 1) * height;
        double side = outline->y + (2 * i - 1) * lean, far = outline->x + (2 * i - 1) * width;
        if (tip >= top && tip <= bottom) {
            columns.left = fmin(columns.left, at);
            columns.right = fmax(columns.right, at);
        }
        if (side >= top && side <= bottom) {
            columns.left = fmin(columns.left, far);
            columns.right = fmax(columns.right, far);
        }
    }
    if (has[0] && has[1]) {
        columns.inner_left = fmax(left[0], left[1]);
        columns.inner_right = fmin(right[0], right[1]);
    }
    return columns;
}

// ---- areas

// An end of what an outline has of a row of the pixel, and that summed over the rows of a piece of the pixel's height.
typedef struct RowEnd {
    double at, sum;
} RowEnd;

// What an outline has of a piece's rows, which are all alike in what comes before what. With none, right is left.
typedef struct Row {
    RowEnd left, right;
} Row;

// Adds what each outline has of a piece of the pixel that is as high as `weight`. What is left of the rows are gaps,
// some of them empty.
static void rows_add(const Row *rows, int count, double weight, double *areas)
{
    RowEnd begin[OUTLINES_ROUGH + 1] = {{-0.5, -0.5 * weight}}, end[OUTLINES_ROUGH + 1] = {{0.5, 0.5 * weight}};
    int gaps = 1;
    for (int i = 0; i < count; i++) {
        RowEnd left = rows[i].left, right = rows[i].right;
        if (!(left.at < right.at) || !(left.at < 0.5) || !(right.at > -0.5)) {
            continue;
        }
        bool is_parted = false;
        for (int gap = 0; gap < gaps; gap++) {
            bool is_left_in = left.at > begin[gap].at, is_right_in = right.at < end[gap].at;
            RowEnd from = is_left_in ? left : begin[gap], to = is_right_in ? right : end[gap];
            if (to.at > from.at) {
                areas[i] += to.sum - from.sum;
                is_parted = is_left_in && is_right_in;
                if (is_parted) { // which ends the search: no other gap is cut
                    begin[gaps] = to;
                    end[gaps] = end[gap];
                    end[gap] = from;
                    break;
                }
                begin[gap] = is_left_in ? begin[gap] : to;
                end[gap] = is_left_in ? from : end[gap];
            }
        }
        gaps += is_parted;
    }
    for (int gap = 0; gap < gaps; gap++) {
        areas[count] += end[gap].at > begin[gap].at ? end[gap].sum - begin[gap].sum : 0.0;
    }
}

void outline_areas_roughly(const Outline *outlines, int count, double *areas)
{
    for (int i = 0; i <= count; i++) {
        areas[i] = 0.0;
    }
    for (int i = 0; i < ROUGH_ROWS; i++) {
        Row rows[OUTLINES_ROUGH] = {{{0.0, 0.0}, {0.0, 0.0}}};
        for (int k = 0; k < count; k++) {
            double left, right;
            if (outline_row(&outlines[k], (i + 0.5) / ROUGH_ROWS - 0.5, &left, &right)) {
                rows[k] = (Row){{left, left / ROUGH_ROWS}, {right, right / ROUGH_ROWS}};
            }
        }
        rows_add(rows, count, 1.0 / ROUGH_ROWS, areas);
    }
}

// Heights between which rows' ends are smooth curves in one order.
typedef struct Breaks {
    double at[BREAKS_MOST];
    int count;
} Breaks;

// Keeps the order.
static void breaks_add(Breaks *breaks, double y)
{
    if (!(y > -0.5 && y < 0.5) || breaks->count == BREAKS_MOST) {
        return;
    }
    int i = breaks->count++;
    for (; i > 0 && breaks->at[i - 1] > y; i--) {
        breaks->at[i] = breaks->at[i - 1];
    }
    breaks->at[i] = y;
}

// Where an outline begins and ends, and where it crosses the pixel's sides.
static void breaks_add_outline(Breaks *breaks, const Outline *outline)
{
    double height = outline_half_height(outline), width = outline_half_width(outline);
    double to_y = height / (width * width);
    breaks_add(breaks, outline->y - height);
    breaks_add(breaks, outline->y + height);
    for (double side = -0.5; side < 1.0; side += 1.0) {
        double x = side - outline->x, part = width * width - x * x;
        if (part > 0.0) {
            double middle = outline->slope * height * x, half = outline->half_row * sqrt(part);
            breaks_add(breaks, outline->y + to_y * (middle - half));
            breaks_add(breaks, outline->y + to_y * (middle + half));
        }
    }
}

// An end of an outline's rows.
typedef struct Edge {
    const Outline *outline;
    double side; // -1: the left, 1: the right
} Edge;

// Beyond its first row and its last, those.
static double edge_at(Edge edge, double y)
{
    const Outline *outline = edge.outline;
    double down = y - outline->y, part = 1.0 - outline->narrowing * (down * down);
    return outline->x + outline->slope * down + edge.side * outline->half_row * sqrt(part > 0.0 ? part : 0.0);
}

// Where two edges cross that change sides between two heights, by the Illinois variant of false position (M. Dowell and
// P. Jarratt, BIT 11, 1971). `off`: how far they are from each other there.
static double edges_cross(Edge a, Edge b, double low, double high, const double off[2])
{
    double at[2] = {low, high}, value[2] = {off[0], off[1]}, y = low;
    for (int step = 0, last = -1; step < ROOT_STEPS; step++) {
        y = (at[0] * value[1] - at[1] * value[0]) / (value[1] - value[0]);
        double here = edge_at(a, y) - edge_at(b, y);
        int end = (here < 0.0) == (value[0] < 0.0) ? 0 : 1;
        if (fabs(here) < ROOT_NEAR) {
            break;
        }
        at[end] = y;
        value[end] = here;
        value[1 - end] *= end == last ? 0.5 : 1.0;
        last = end;
    }
    return y;
}

static double edge_slope(Edge edge, double y)
{
    const Outline *outline = edge.outline;
    double down = y - outline->y, part = 1.0 - outline->narrowing * (down * down);
    double curve = outline->half_row * outline->narrowing * down / sqrt(part > 0.0 ? part : 0.0);
    return outline->slope - edge.side * curve;
}

// Where the distance of two edges bends the other way: nowhere if one is a left one and the other a right one, and else
// where w n / (1 - n u²)^1.5 is alike for both, an edge having the second derivative of w (1 - n u²)^0.5. Puts low,
// such heights between and high, in order; returns the number of parts.
static int bends_find(Edge a, Edge b, double low, double high, double at[4])
{
    const Outline *one = a.outline, *other = b.outline;
    int parts = 1;
    at[0] = low;
    if (a.side == b.side) {
        double quotient = one->half_row * one->narrowing / (other->half_row * other->narrowing);
        double k = cbrt(quotient * quotient), of_other = k * other->narrowing;
        double above = low - one->y, above_other = low - other->y;
        double square = one->narrowing - of_other;
        double half = one->narrowing * above - of_other * above_other;
        double rest = one->narrowing * above * above - of_other * above_other * above_other + (k - 1.0);
        double root = half * half - square * rest;
        double sum = -(half + copysign(sqrt(root > 0.0 ? root : 0.0), half));
        double first = low + sum / square, second = low + rest / sum; // not between, where there are none
        double begin = first < second ? first : second, end = first < second ? second : first;
        if (root > 0.0 && begin > low && begin < high) {
            at[parts++] = begin;
        }
        if (root > 0.0 && end > low && end < high) {
            at[parts++] = end;
        }
    }
    at[parts] = high;
    return parts;
}

// Whether two edges that are on the same sides at both ends of a part, in which their distance bends to one side only,
// cross twice between; `*y`: where the first is at the other side. The least distance lies where the tangents at both
// ends of a range meet or higher; the range is cut there, or halved where a tangent is upright or nearly so.
static bool edges_dip(Edge a, Edge b, double low, double high, const double off[2], double *y)
{
    double sign = off[0] + off[1] > 0.0 ? 1.0 : -1.0, at[2] = {low, high};
    double value[2] = {sign * off[0], sign * off[1]}, slope[2];
    for (int i = 0; i < 2; i++) {
        slope[i] = sign * (edge_slope(a, at[i]) - edge_slope(b, at[i]));
    }
    for (int step = 0; step < DIP_STEPS && slope[0] < 0.0 && slope[1] > 0.0; step++) {
        double wide = at[1] - at[0], fall = value[0] - value[1] + wide * slope[1];
        double part = fall / (slope[1] - slope[0]), least = value[0] + part * slope[0];
        bool has_both = part > 0.0 && part < wide;
        if (wide < ROOT_NEAR || (has_both && least > -ROOT_NEAR)) {
            break;
        }
        *y = at[0] + (has_both && step % 2 == 0 ? part : 0.5 * wide);
        double here = sign * (edge_at(a, *y) - edge_at(b, *y)), rise = sign * (edge_slope(a, *y) - edge_slope(b, *y));
        if (here < 0.0) {
            return true;
        }
        int end = rise > 0.0 ? 1 : 0;
        at[end] = *y;
        value[end] = here;
        slope[end] = rise;
    }
    return false;
}

// The edges that are in the pixel at a height; at most two of each outline. Sides of the pixel are breaks, so that an
// edge is in it all the way from one break to the next, or nowhere.
static int edges_find(const Outline *outlines, int count, double y, Edge *edges)
{
    double ends[2];
    int found = 0;
    for (int i = 0; i < count; i++) {
        bool has = outline_row(&outlines[i], y, &ends[0], &ends[1]);
        for (int end = 0; has && end < 2; end++) {
            if (fabs(ends[end]) < 0.5) {
                edges[found++] = (Edge){&outlines[i], 2 * end - 1};
            }
        }
    }
    return found;
}

static void breaks_add_crossing(Breaks *breaks, Edge a, Edge b, double low, double high, const double off[2])
{
    double y;
    if (off[0] * off[1] < 0.0) {
        breaks_add(breaks, edges_cross(a, b, low, high, off));
    } else if (edges_dip(a, b, low, high, off, &y)) {
        double there = edge_at(a, y) - edge_at(b, y);
        breaks_add(breaks, edges_cross(a, b, low, y, (double[2]){off[0], there}));
        breaks_add(breaks, edges_cross(a, b, y, high, (double[2]){there, off[1]}));
    }
}

// Of the edges of two outlines; the same outline's meet at its ends only.
static void breaks_add_pair(Breaks *breaks, Edge a, Edge b, double low, double high, const double off[2])
{
    double at[4], before = off[0];
    int parts = a.outline != b.outline ? bends_find(a, b, low, high, at) : 0;
    for (int i = 0; i < parts; i++) {
        double next = i + 1 < parts ? edge_at(a, at[i + 1]) - edge_at(b, at[i + 1]) : off[1];
        breaks_add_crossing(breaks, a, b, at[i], at[i + 1], (double[2]){before, next});
        before = next;
    }
}

static void breaks_add_crossings(Breaks *breaks, const Outline *outlines, int count)
{
    const Breaks pieces = *breaks;
    for (int piece = 0; piece + 1 < pieces.count; piece++) {
        double low = pieces.at[piece], high = pieces.at[piece + 1];
        double at_low[2 * OUTLINES_MOST], at_high[2 * OUTLINES_MOST];
        Edge edges[2 * OUTLINES_MOST];
        int found = edges_find(outlines, count, 0.5 * (low + high), edges);
        for (int i = 0; found > 1 && i < found; i++) {
            at_low[i] = edge_at(edges[i], low);
            at_high[i] = edge_at(edges[i], high);
            for (int j = 0; j < i; j++) {
                double off[2] = {at_low[i] - at_low[j], at_high[i] - at_high[j]};
                breaks_add_pair(breaks, edges[i], edges[j], low, high, off);
            }
        }
    }
}

// θ - sin θ of the angle whose chord in the circle of radius 1 is so long.
static double segment(double chord)
{
    double angle = 2.0 * asin(chord < 2.0 ? 0.5 * chord : 1.0), square = angle * angle;
    if (angle > 0.5) {
        return angle - sin(angle);
    }
    double series = 1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0));
    return angle * square / 6.0 * (1.0 - square / 20.0 * series);
}

// An edge summed over the heights of a piece: the trapezoid under its chord, and what the curve has beyond that, which
// is a segment of a circle, stretched. Nothing cancels in large outlines, which are nearly straight here.
static double edge_sum(Edge edge, double low, double high)
{
    const Outline *outline = edge.outline;
    double scale = sqrt(outline->narrowing), begin = scale * (low - outline->y), end = scale * (high - outline->y);
    double at_begin = sqrt(fmax(1.0 - begin * begin, 0.0)), at_end = sqrt(fmax(1.0 - end * end, 0.0));
    double along = end - begin, sum = at_begin + at_end;
    double across = sum > 0.0 ? along * (begin + end) / sum : 0.0;
    double curve = 0.5 * segment(sqrt(along * along + across * across)) * outline->half_row / scale;
    return 0.5 * (high - low) * (edge_at(edge, low) + edge_at(edge, high)) + edge.side * curve;
}

// An end in the pixel, or the side of the pixel beyond which it is.
static RowEnd row_end(const Outline *outline, double side, double at, double low, double high)
{
    if (fabs(at) < 0.5) {
        return (RowEnd){at, edge_sum((Edge){outline, side}, low, high)};
    }
    double bound = at < 0.0 ? -0.5 : 0.5;
    return (RowEnd){bound, bound * (high - low)};
}

void outline_areas(const Outline *outlines, int count, double *areas)
{
    Breaks breaks = {{-0.5, 0.5}, 2};
    for (int i = 0; i <= count; i++) {
        areas[i] = 0.0;
    }
    for (int i = 0; i < count; i++) {
        breaks_add_outline(&breaks, &outlines[i]);
    }
    if (count > 1) {
        breaks_add_crossings(&breaks, outlines, count);
    }
    for (int piece = 0; piece + 1 < breaks.count; piece++) {
        double low = breaks.at[piece], high = breaks.at[piece + 1];
        Row rows[OUTLINES_MOST] = {{{0.0, 0.0}, {0.0, 0.0}}};
        for (int i = 0; i < count; i++) {
            double left, right;
            if (outline_row(&outlines[i], 0.5 * (low + high), &left, &right)) {
                rows[i] =
                    (Row){row_end(&outlines[i], -1.0, left, low, high), row_end(&outlines[i], 1.0, right, low, high)};
            }
        }
        rows_add(rows, count, high - low, areas);
    }
}
