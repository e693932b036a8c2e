// The line's image in the outline's plane is a line a u + b + c v = 0, of which each crossing of the outline is a
// crossing of the wall. Their number is even whatever rounding does, so what lies between them is inside by turns.
//
// In a prism that grows with the height a point is seen at <x, z> / y: the line's image is that of the plane through it
// and the origin, both ends of the line are seen at one point, and where the height is 0 it is nowhere, which is
// outside.
//
// A ray that starts on the wall: how many crossings lie before it says whether its own is among them, which then is the
// first.
//
// SPDX-License-Identifier: MIT
#include "trace/prism.h"

#include "math/extreme.h"
#include "trace/crossings.h"

// The crossings of the wall in order, and whether the line is inside before the first and behind the last.
typedef struct WallCrossings {
    Crossing *at;
    uint32_t count;
    bool is_inside;
} WallCrossings;

// The line's image, turned so that where it runs along an edge or through a corner these are on the side of it that
// outline_holds has them on for its points.
static OutlineLine line_of(const Ray *ray)
{
    Vec3 o = ray->origin, d = ray->direction;
    OutlineLine line = {-d.z, d.z * o.x - d.x * o.z, d.x, OUTLINE_ALL};
    if (line.c < 0.0 || (line.c == 0.0 && line.a > 0.0)) {
        line.a = -line.a;
        line.b = -line.b;
        line.c = -line.c;
    }
    return line;
}

static void wall_take(const Ray *ray, double square, const OutlinePoint *points, WallCrossings *wall)
{
    Vec3 o = ray->origin, d = ray->direction;
    for (uint32_t i = 0; i < wall->count; i++) {
        double t = ((points[i].u - o.x) * d.x + (points[i].v - o.z) * d.z) / square;
        wall->at[i] = (Crossing){t, PRISM_WALL};
    }
}

static void cross_straight(const Numbers *outline, const Ray *ray, OutlinePoint *points, WallCrossings *wall)
{
    Vec3 o = ray->origin, d = ray->direction;
    double square = d.x * d.x + d.z * d.z;
    if (square == 0.0) { // along the wall
        wall->is_inside = outline_holds(outline, (OutlinePoint){o.x, o.z});
        return;
    }
    OutlineLine line = line_of(ray);
    wall->count = outline_cross(outline, &line, points, NULL);
    wall_take(ray, square, points, wall);
}

// The same of what lies between the ends alone: most of the outline is not asked then. False: the crossings there do
// not fit to what is inside at both ends, as they may not where one of them is at an end but for rounding.
static bool cross_between(const Numbers *outline, const Ray *ray, const RayInterval *slab, OutlinePoint *points,
                          WallCrossings *wall)
{
    Vec3 o = ray->origin, d = ray->direction, first = ray_at(*ray, slab->enter), last = ray_at(*ray, slab->leave);
    double square = d.x * d.x + d.z * d.z;
    OutlineLine line = line_of(ray);
    line.low = (OutlinePoint){less_of(first.x, last.x), less_of(first.z, last.z)};
    line.high = (OutlinePoint){greater_of(first.x, last.x), greater_of(first.z, last.z)};
    wall->is_inside = outline_holds(outline, (OutlinePoint){first.x, first.z});
    wall->count = 0;
    OutlineAnswer answer = OUTLINE_FAR;
    uint32_t found = square > 0.0 ? outline_cross(outline, &line, points, &answer) : 0;
    if (answer == OUTLINE_DOUBTFUL) {
        return false;
    }
    double room = 0x1p-30 * (fabs(slab->enter) + fabs(slab->leave)); // of an end, where a point may be on either side
    for (uint32_t i = 0; i < found; i++) {
        double t = ((points[i].u - o.x) * d.x + (points[i].v - o.z) * d.z) / square;
        if (fabs(t - slab->enter) <= room || fabs(t - slab->leave) <= room) {
            return false;
        }
        wall->at[wall->count] = (Crossing){t, PRISM_WALL};
        wall->count += t > slab->enter && t < slab->leave;
    }
    bool is_inside_end = wall->is_inside != (bool)(wall->count & 1);
    return answer == OUTLINE_FAR || is_inside_end == outline_holds(outline, (OutlinePoint){last.x, last.z});
}

// The same of a ray that starts on the wall, of what is behind its start up to where it is beyond the ends. False: more
// than its own crossing is where it starts, or what it crosses does not fit to what is inside where it ends.
static bool cross_behind(const Numbers *outline, const Ray *ray, double leave, bool inward, OutlinePoint *points,
                         WallCrossings *wall)
{
    Vec3 o = ray->origin, d = ray->direction, last = ray_at(*ray, leave);
    double square = d.x * d.x + d.z * d.z, size = greater_of(fabs(o.x), fabs(o.z)), room = 0x1p-30 * leave;
    double aside = 0x1p-40 * size; // the start may be off the wall by rounding
    OutlineLine line = line_of(ray);
    line.low = (OutlinePoint){less_of(o.x, last.x) - aside, less_of(o.z, last.z) - aside};
    line.high = (OutlinePoint){greater_of(o.x, last.x) + aside, greater_of(o.z, last.z) + aside};
    OutlineAnswer answer = OUTLINE_FAR;
    uint32_t found = square > 0.0 ? outline_cross(outline, &line, points, &answer) : 0, own = 0;
    wall->count = 0;
    wall->is_inside = inward;
    for (uint32_t i = 0; i < found; i++) {
        double t = ((points[i].u - o.x) * d.x + (points[i].v - o.z) * d.z) / square;
        if (fabs(t - leave) <= room) {
            return false;
        }
        own += fabs(t) <= room;
        wall->at[wall->count] = (Crossing){t, PRISM_WALL};
        wall->count += t > room && t < leave;
    }
    bool is_inside_end = inward != (bool)(wall->count & 1);
    return own == 1 && answer == OUTLINE_NEAR &&
           is_inside_end == outline_holds(outline, (OutlinePoint){last.x, last.z});
}

static void cross_conic(const Numbers *outline, const Ray *ray, OutlinePoint *points, WallCrossings *wall)
{
    Vec3 o = ray->origin, d = ray->direction, n = vec3_cross(o, d);
    if (vec3_equal(n, vec3(0.0, 0.0, 0.0))) { // through the tip
        wall->is_inside = d.y != 0.0 && outline_holds(outline, (OutlinePoint){d.x / d.y, d.z / d.y});
        return;
    }
    OutlineLine line = {n.x, n.y, n.z, OUTLINE_ALL};
    wall->count = outline_cross(outline, &line, points, NULL);
    double t_tip = -o.y / d.y;
    for (uint32_t i = 0; i < wall->count; i++) {
        double u = points[i].u, v = points[i].v;
        double from_x = u * o.y - o.x, from_z = v * o.y - o.z, by_x = d.x - u * d.y, by_z = d.z - v * d.y;
        double from2 = from_x * from_x + from_z * from_z, by2 = by_x * by_x + by_z * by_z;
        double along = from_x * by_x + from_z * by_z; // the longer one of the two has the direction of both
        double t = by2 >= from2 ? along / by2 : from2 / along;
        t = isnan(t) ? (double)INFINITY : t; // it never comes to its end
        wall->at[i] = (Crossing){t, PRISM_WALL};
        wall->is_inside = wall->is_inside != (d.y != 0.0 && t > t_tip);
    }
}

// Whether all between the ends is beyond one side of the bounds.
static bool passes(Vec3 low, Vec3 high, const Ray *ray, const RayInterval *slab)
{
    Vec3 first = ray_at(*ray, slab->enter), last = ray_at(*ray, slab->leave);
    return greater_of(first.x, last.x) < low.x || less_of(first.x, last.x) > high.x ||
           greater_of(first.z, last.z) < low.z || less_of(first.z, last.z) > high.z;
}

unsigned prism_intervals(const Numbers *outline, Vec3 low, Vec3 high, const Ray *ray, SideLeft left,
                         RayInterval *intervals)
{
    RayInterval slab = INTERVAL_ALL;
    unsigned count = 0;
    bool is_gone = (left.side == PRISM_LOW || left.side == PRISM_HIGH) && !left.inward; // beyond its ends
    if (is_gone ||
        !interval_slab(ray->origin.y, ray->direction.y, (Slab){low.y, high.y, PRISM_LOW}, left.side, &slab)) {
        return 0;
    }
    if (left.side == PRISM_WALL) { // between its ends
        slab.enter = -(double)INFINITY;
        slab.enter_side = SIDE_NONE;
    }
    bool is_conic = outline_is_conic(outline), has_ends = !isinf(slab.enter) && !isinf(slab.leave);
    bool is_between = !is_conic && has_ends && left.side != PRISM_WALL;
    if (has_ends && passes(low, high, ray, &slab)) {
        return 0;
    }
    uint32_t most = outline_crossings_most(outline);
    Crossing at[most];
    OutlinePoint points[most];
    WallCrossings wall = {.at = at};
    bool is_start = left.side == PRISM_WALL,
         is_behind = is_start && !is_conic && slab.leave > 0.0 && !isinf(slab.leave);
    is_behind = is_behind && cross_behind(outline, ray, slab.leave, left.inward, points, &wall);
    if (!is_behind && (!is_between || !cross_between(outline, ray, &slab, points, &wall))) {
        wall.is_inside = false;
        wall.count = 0;
        (is_conic ? cross_conic : cross_straight)(outline, ray, points, &wall);
    }
    crossings_sort(at, wall.count);
    is_start = is_start && !is_behind && wall.count > 0;
    bool is_inside = is_start ? left.inward : wall.is_inside;
    RayInterval own = INTERVAL_ALL;
    uint32_t first = is_start ? crossings_first_behind(at, wall.count, wall.is_inside, &is_inside) : 0;
    for (uint32_t i = first; i <= wall.count; i++) {
        bool is_end = i == wall.count;
        if (is_inside) {
            own.leave = is_end ? (double)INFINITY : at[i].t;
            own.leave_side = is_end ? SIDE_NONE : PRISM_WALL;
            RayInterval both = own;
            interval_meet(&both, &slab);
            if (both.enter < both.leave) {
                intervals[count++] = both;
            }
        }
        is_inside = !is_inside;
        own.enter = is_end ? (double)INFINITY : at[i].t;
        own.enter_side = PRISM_WALL;
    }
    return count;
}

// ---- surfaces

// Where a point is seen in the outline's plane.
static OutlinePoint outline_image(const Numbers *outline, Vec3 point)
{
    return outline_is_conic(outline) && point.y != 0.0 ? (OutlinePoint){point.x / point.y, point.z / point.y}
                                                       : (OutlinePoint){point.x, point.z};
}

Vec3 prism_gradient(const Numbers *outline, Vec3 point, uint8_t side)
{
    if (side != PRISM_WALL) {
        return vec3(0.0, side == PRISM_LOW ? -1.0 : 1.0, 0.0);
    }
    OutlinePoint along, at = outline_nearest(outline, outline_image(outline, point), &along, NULL);
    Vec3 n = vec3(along.v, 0.0, -along.u);
    n.y = outline_is_conic(outline) ? -(n.x * at.u + n.z * at.v) : 0.0;
    return point.y < 0.0 && outline_is_conic(outline) ? vec3_neg(n) : n;
}

Vec3 prism_point(const Numbers *outline, double low, double high, Vec3 point, uint8_t side)
{
    if (side != PRISM_WALL) {
        return vec3(point.x, side == PRISM_LOW ? low : high, point.z);
    }
    OutlinePoint along, at = outline_nearest(outline, outline_image(outline, point), &along, NULL);
    double size = outline_is_conic(outline) && point.y != 0.0 ? point.y : 1.0;
    return vec3(size * at.u, point.y, size * at.v);
}
