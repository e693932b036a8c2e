// A line through a container is walked from one end to the other, root by root, as POV-Ray does it.
//
// Where the ray starts within the container and not clearly outside of the surface, it is asked only from five times
// `accuracy` on, and so it is behind each root: that is what keeps a ray from meeting what it has just left. Measured;
// docs/language.md, "Isosurfaces". What would be seen only behind the container where the ray came in through it, and
// roots that `max_trace` leaves out, bound the inside and are not seen.
//
// SPDX-License-Identifier: MIT
#include "trace/isosurface.h"

#include "trace/box.h"

// In lengths of `accuracy`: how far from a root it is looked for the next, and how near the function may come to the
// threshold at a start, times what `max_gradient` lets it change on that way.
static const double past_root = 5.0, near_start = 4.0;

typedef struct Walk {
    IsosurfaceLine line;
    const Isosurface *surface;
    RayInterval container;
    IntervalWalk found;
    unsigned seen;
    bool is_alone, is_over;
    bool is_within; // the ray starts in the container
} Walk;

// ---- the container

static bool ball_interval(const Isosurface *surface, const Ray *ray, uint8_t left, RayInterval *interval)
{
    double inverse = 1.0 / surface->high[0];
    Vec3 middle = {surface->low[0], surface->low[1], surface->low[2]};
    Ray own = {vec3_scale(inverse, vec3_sub(ray->origin, middle)), vec3_scale(inverse, ray->direction)};
    double at, half;
    if (!ball_line(&own, 1.0, &at, &half)) {
        return false;
    }
    *interval = (RayInterval){at - half, at + half, ISOSURFACE_BALL, ISOSURFACE_BALL};
    if (left == ISOSURFACE_BALL) {
        *interval = (RayInterval){-(double)INFINITY, 2.0 * at, SIDE_NONE, ISOSURFACE_BALL};
    }
    return true;
}

// What of the line is in the container; a ray that leaves it through its own side is not in it any more.
static bool container_interval(const PreparedPrimitive *primitive, const Ray *ray, SideLeft left, RayInterval *interval)
{
    const Isosurface *surface = isosurface_of(primitive->isosurface.list);
    bool is_on = left.side >= ISOSURFACE_BALL && left.side != SIDE_NONE;
    if (is_on && !left.inward) {
        return false;
    }
    if (isosurface_is(surface, ISOSURFACE_ROUND)) {
        return ball_interval(surface, ray, left.side, interval);
    }
    uint8_t side = is_on ? (uint8_t)(left.side - ISOSURFACE_BOX) : SIDE_NONE;
    if (!box_interval(primitive->isosurface.low, primitive->isosurface.high, ray->origin, ray->direction, side,
                      interval)) {
        return false;
    }
    interval->enter_side = (uint8_t)(interval->enter_side + ISOSURFACE_BOX);
    interval->leave_side = (uint8_t)(interval->leave_side + ISOSURFACE_BOX);
    return true;
}

// ---- roots in order

static void cross(Walk *walk, double t, uint8_t side)
{
    interval_walk_cross(&walk->found, t, side);
    walk->seen += side != ISOSURFACE_UNSEEN;
    walk->is_over = walk->is_alone && side != ISOSURFACE_UNSEEN;
}

static uint8_t cap(const Walk *walk, uint8_t side)
{
    return isosurface_is(walk->surface, ISOSURFACE_OPEN) ? ISOSURFACE_UNSEEN : side;
}

// Where it is looked for the first root.
static double start(Walk *walk)
{
    double at = walk->is_within ? 0.0 : walk->container.enter, f = isosurface_along(&walk->line, at);
    if (!walk->is_within) {
        if (f < 0.0) {
            cross(walk, at, cap(walk, walk->container.enter_side));
        }
        return at;
    }
    if (f < near_start * walk->surface->accuracy * walk->surface->max_gradient) {
        at += past_root * walk->line.step;
        walk->found.is_inside = isosurface_along(&walk->line, at) < 0.0;
    }
    return at;
}

static void walk_roots(Walk *walk)
{
    double at = start(walk), to = walk->container.leave, t;
    bool is_long = to - at >= walk->line.step, has_end = is_long && walk->is_within; // whether its end is seen
    for (unsigned i = 0; i < 2 * ISOSURFACE_ROOTS_MOST && is_long && at < to && !walk->is_over; i++) {
        if (!isosurface_find(&walk->line, at, to, walk->found.is_inside, &t)) {
            break;
        }
        cross(walk, t, walk->seen < walk->surface->roots_most ? ISOSURFACE_SIDE : ISOSURFACE_UNSEEN);
        at = t + past_root * walk->line.step;
    }
    if (walk->is_over && walk->found.is_inside) { // it ends somewhere behind
        interval_walk_stay(&walk->found);
    } else if (walk->found.is_inside) {
        cross(walk, to, has_end ? cap(walk, walk->container.leave_side) : ISOSURFACE_UNSEEN);
    }
}

static bool is_abandoned(const void *client)
{
    return trace_is_abandoned(client);
}

unsigned isosurface_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                              RayInterval *intervals)
{
    Walk walk = {.surface = isosurface_of(primitive->isosurface.list),
                 .found = {.open = INTERVAL_ALL, .intervals = intervals}};
    if (!container_interval(primitive, object, left, &walk.container) || !(walk.container.leave > 0.0)) {
        return 0;
    }
    const IsosurfaceWorld *world = primitive->isosurface.world;
    double length = world->scale * vec3_length(linear_direction(&primitive->to_world, object->direction));
    walk.line = isosurface_line(primitive->isosurface.list, primitive->isosurface.host, *object, length);
    walk.line.is_over = world->abandon ? is_abandoned : NULL;
    walk.line.client = world->abandon;
    walk.is_within = !(walk.container.enter > 0.0);
    if (!walk.is_within && walk.container.leave - walk.container.enter < walk.line.step) {
        return 0; // as in POV-Ray
    }
    walk.is_alone = primitive->node == NODE_NONE;
    walk_roots(&walk);
    return walk.found.count;
}

// ---- surfaces

// As POV-Ray has it: by what the function is `accuracy` further along each axis.
static Vec3 difference(const PreparedPrimitive *primitive, Vec3 p)
{
    const double *list = primitive->isosurface.list;
    const FormulaHost *host = primitive->isosurface.host;
    double step = isosurface_of(list)->accuracy, f = isosurface_value(list, host, p);
    Vec3 n = {isosurface_value(list, host, vec3(p.x + step, p.y, p.z)) - f,
              isosurface_value(list, host, vec3(p.x, p.y + step, p.z)) - f,
              isosurface_value(list, host, vec3(p.x, p.y, p.z + step)) - f};
    double size = vec3_max_abs(n);
    return size > 0.0 && size <= 0x1p1000 ? vec3_normalize(vec3_scale(ldexp(1.0, -ilogb(size)), n))
                                          : vec3(1.0, 0.0, 0.0);
}

Vec3 isosurface_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    const Isosurface *surface = isosurface_of(primitive->isosurface.list);
    if (side == ISOSURFACE_SIDE) {
        return difference(primitive, point);
    }
    if (side == ISOSURFACE_UNSEEN) {
        return vec3(1.0, 0.0, 0.0);
    }
    if (isosurface_is(surface, ISOSURFACE_ROUND)) {
        return vec3_normalize(vec3_sub(point, vec3(surface->low[0], surface->low[1], surface->low[2])));
    }
    return box_normal((uint8_t)(side - ISOSURFACE_BOX));
}

Vec3 isosurface_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    const Isosurface *surface = isosurface_of(primitive->isosurface.list);
    if (side < ISOSURFACE_BALL) {
        return point;
    }
    if (isosurface_is(surface, ISOSURFACE_ROUND)) {
        Vec3 middle = {surface->low[0], surface->low[1], surface->low[2]};
        return vec3_add_scaled(middle, surface->high[0], vec3_normalize(vec3_sub(point, middle)));
    }
    return box_point(primitive->isosurface.low, primitive->isosurface.high, point, (uint8_t)(side - ISOSURFACE_BOX));
}
