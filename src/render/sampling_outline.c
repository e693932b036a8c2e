// Outlines of spheres in the picture: see sampling_outline.h.
//
// A ray along d from the eye meets the sphere of radius r around f where |d x f|² <= r² |d|². With d = d0 + x c + y w,
// d0 through the sphere's middle and so d0 x f = 0, that is a form of second degree in the pixel's x and y, in which
// nothing cancels.
//
// SPDX-License-Identifier: MIT
#include "render/sampling_outline.h"

// Smaller ones are never a stratum, and rounding would be seen in larger ones. In pixels.
static const double OUTLINE_LEAST = 0x1p-5, OUTLINE_MOST = 0x1p24;

// A break that is so near to its place, in pixels, is as good.
static const double ROOT_NEAR = 1e-3;

enum { ROUGH_ROWS = 16, NODES = 4, BREAKS_MOST = 64, ROOT_STEPS = 8 };

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

// ---- areas

// Adds what each outline has of a row of the pixel. What is left of the row are gaps, some of them empty.
static void row_add(const Outline *outlines, int count, double y, double weight, double *areas)
{
    double begin[OUTLINES_ROUGH + 1] = {-0.5}, end[OUTLINES_ROUGH + 1] = {0.5}, left, right;
    int gaps = 1;
    for (int i = 0; i < count; i++) {
        if (!outline_row(&outlines[i], y, &left, &right) || !(left < 0.5) || !(right > -0.5)) {
            continue;
        }
        bool is_parted = false;
        for (int gap = 0; gap < gaps; gap++) {
            double from = left > begin[gap] ? left : begin[gap], to = right < end[gap] ? right : end[gap];
            if (to > from) {
                areas[i] += weight * (to - from);
                is_parted = from > begin[gap] && to < end[gap];
                if (is_parted) { // which ends the search: no other gap is cut
                    begin[gaps] = to;
                    end[gaps] = end[gap];
                    end[gap] = from;
                    break;
                }
                begin[gap] = from > begin[gap] ? begin[gap] : to;
                end[gap] = from > begin[gap] ? from : end[gap];
            }
        }
        gaps += is_parted;
    }
    for (int gap = 0; gap < gaps; gap++) {
        areas[count] += end[gap] > begin[gap] ? weight * (end[gap] - begin[gap]) : 0.0;
    }
}

void outline_areas_roughly(const Outline *outlines, int count, double *areas)
{
    for (int i = 0; i <= count; i++) {
        areas[i] = 0.0;
    }
    for (int i = 0; i < ROUGH_ROWS; i++) {
        row_add(outlines, count, (i + 0.5) / ROUGH_ROWS - 0.5, 1.0 / ROUGH_ROWS, areas);
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
                if (off[0] * off[1] < 0.0) {
                    breaks_add(breaks, edges_cross(edges[i], edges[j], low, high, off));
                }
            }
        }
    }
}

void outline_areas(const Outline *outlines, int count, double *areas)
{
    // Gauss's nodes and weights for 0 to 1. Heights go as 3 t² - 2 t³, so that the roots at the ends are smooth in t.
    static const double nodes[NODES] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                        0.93056815579702629};
    static const double weights[NODES] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                          0.17392742256872693};
    Breaks breaks = {{-0.5, 0.5}, 2};
    for (int i = 0; i <= count; i++) {
        areas[i] = 0.0;
    }
    bool is_small = false;
    for (int i = 0; i < count; i++) {
        breaks_add_outline(&breaks, &outlines[i]);
        is_small = is_small || outlines[i].narrowing > 1.0;
    }
    if (count > 1 || is_small) { // two crossings in one piece are seen as none; the curve of small ones is strong
        breaks_add(&breaks, 0.0);
    }
    if (count > 1) {
        breaks_add_crossings(&breaks, outlines, count);
    }
    for (int piece = 0; piece + 1 < breaks.count; piece++) {
        Edge edges[2 * OUTLINES_MOST];
        double low = breaks.at[piece], size = breaks.at[piece + 1] - low;
        if (edges_find(outlines, count, low + 0.5 * size, edges) == 0) { // all rows are alike
            row_add(outlines, count, low + 0.5 * size, size, areas);
            continue;
        }
        for (int i = 0; i < NODES; i++) {
            double t = nodes[i];
            row_add(outlines, count, low + size * t * t * (3.0 - 2.0 * t), size * weights[i] * 6.0 * t * (1.0 - t),
                    areas);
        }
    }
}
