// Parts of each kind behind one interface: a switch over kinds, each case a shape's own header.
//
// SPDX-License-Identifier: MIT
#include "trace/solid.h"

#include <float.h>
#include <string.h>

#include "math/extreme.h"
#include "trace/box.h"
#include "trace/cone.h"
#include "trace/flat.h"
#include "trace/plane.h"
#include "trace/sphere.h"

// Of the unit sphere; the roots are those of trace/sphere.h, both of them.
static bool ball_interval(const Ray *object, uint8_t left_side, RayInterval *interval)
{
    SphereRay ray = sphere_ray_make(object->origin, object->direction);
    Vec3 f = ray.origin;
    double t_middle = -vec3_dot(f, ray.direction_over_length2);
    *interval = (RayInterval){-(double)INFINITY, 2.0 * t_middle, 0, 0};
    if (left_side == 0) {
        return interval->leave > 0.0;
    }
    Vec3 l = vec3_add_scaled(f, t_middle, ray.direction);
    double discriminant = 1.0 - vec3_length_squared(l);
    if (!(discriminant >= 0.0)) {
        return false;
    }
    double sum = t_middle + copysign(sqrt(discriminant * ray.inverse_square), t_middle);
    double product = (vec3_length_squared(f) - 1.0) * ray.inverse_square;
    interval->enter = t_middle > 0.0 ? product / sum : sum;
    interval->leave = t_middle > 0.0 ? sum : product / sum;
    return interval->enter <= interval->leave;
}

// The half space below a plane; a ray that leaves it inward never comes back.
static bool plane_interval(const Solid *solid, const Ray *ray, uint8_t left_side, RayInterval *interval)
{
    PlaneShape plane = {solid->data[0], solid->data[1].x};
    double rise = vec3_dot(plane.normal, ray->direction);
    *interval = INTERVAL_ALL;
    if (left_side == 0) {
        return true;
    }
    if (rise == 0.0) {
        return vec3_dot(plane.normal, ray->origin) <= plane.distance;
    }
    double t = plane_root(&plane, ray->origin, ray->direction);
    *(rise > 0.0 ? &interval->leave : &interval->enter) = t;
    *(rise > 0.0 ? &interval->leave_side : &interval->enter_side) = 0;
    return !isnan(t);
}

bool solid_interval(const Solid *solid, const Ray *object, uint8_t left_side, RayInterval *interval)
{
    switch (solid->kind) {
    case PART_BALL:
        return ball_interval(object, left_side, interval);
    case PART_PLANE:
        return plane_interval(solid, object, left_side, interval);
    case PART_BOX:
        return box_interval(solid->data[0], solid->data[1], object->origin, object->direction, left_side, interval);
    case PART_CONE:
        return cone_interval(solid->data[0].x, object->origin, object->direction, left_side, interval);
    case PART_DISC:
    case PART_TRIANGLE:
    case PART_SMOOTH_TRIANGLE: break; // flat
    }
    return false;
}

bool solid_flat_root(const Solid *solid, const Ray *object, double *t)
{
    double x, y;
    return flat_root(object->origin, object->direction, t, &x, &y) &&
           (solid->kind == PART_DISC ? disc_has(solid->data[0].x, x, y) : triangle_has(x, y));
}

// Where the normals at the corners cancel, that of the first.
static Vec3 smooth_normal(const Solid *solid, Vec3 point)
{
    Vec3 n = vec3_scale(1.0 - point.x - point.y, solid->data[0]);
    n = vec3_add_scaled(vec3_add_scaled(n, point.x, solid->data[1]), point.y, solid->data[2]);
    return vec3_equal(n, vec3(0.0, 0.0, 0.0)) ? solid->data[0] : n;
}

static Vec3 object_normal(const Solid *solid, Vec3 point, uint8_t side)
{
    switch (solid->kind) {
    case PART_BALL: return point;
    case PART_PLANE: return solid->data[0];
    case PART_BOX: return box_normal(side);
    case PART_CONE: return cone_normal(solid->data[0].x, point, side);
    case PART_SMOOTH_TRIANGLE: return smooth_normal(solid, point);
    case PART_DISC:
    case PART_TRIANGLE: break;
    }
    return vec3(0.0, 0.0, 1.0);
}

static Vec3 object_point(const Solid *solid, Vec3 point, uint8_t side)
{
    switch (solid->kind) {
    case PART_BALL: return vec3_normalize(point);
    case PART_BOX: return box_point(solid->data[0], solid->data[1], point, side);
    case PART_CONE: return cone_point(solid->data[0].x, point, side);
    case PART_PLANE: break; // has no space of its own
    case PART_DISC:
    case PART_TRIANGLE:
    case PART_SMOOTH_TRIANGLE: return vec3(point.x, point.y, 0.0);
    }
    return point;
}

static double fixed_size(const Solid *solid, int axis)
{
    const double *low = &solid->data[0].x, *high = &solid->data[1].x;
    return solid->kind == PART_BOX ? greater_of(fabs(low[axis]), fabs(high[axis])) : 1.0;
}

static double extent_of(const Solid *solid)
{
    double product = 1.0, sum = 0.0;
    for (int row = 0; row < 3; row++) {
        const double *m = solid->to_world.m[row];
        double length = hypot(hypot(m[0], m[1]), m[2]);
        product *= length;
        sum += length * fixed_size(solid, row);
    }
    // How far the rows are from right angles, which is what an inverse magnifies rounding by: Hadamard's ratio.
    const double(*m)[3] = solid->to_object.m;
    Vec3 x = vec3(m[0][0], m[0][1], m[0][2]), y = vec3(m[1][0], m[1][1], m[1][2]), z = vec3(m[2][0], m[2][1], m[2][2]);
    return product * fabs(vec3_dot(x, vec3_cross(y, z))) * sum;
}

void solid_measure(Solid *solid)
{
    double *columns = &solid->columns.x;
    bool is_alone = true; // every entry in its column
    for (int axis = 0; axis < 3; axis++) {
        double square = 0.0;
        solid->entries[axis] = 0;
        for (int from = 0; from < 3; from++) {
            double entry = solid->to_object.m[from][axis];
            square += entry * entry;
            solid->entries[axis] |= (uint8_t)((entry != 0.0) << from);
        }
        columns[axis] = sqrt(square);
        is_alone = is_alone && (solid->entries[axis] & (solid->entries[axis] - 1)) == 0;
    }
    solid->extent = is_alone ? 0.0 : extent_of(solid); // asked for where a column has more
    solid->spread = solid->extent + vec3_sum_abs(solid->centre);
}

// |n|·R for a normal n of the solid's space, R being per coordinate of that space the sum of the magnitudes of all
// terms that make the coordinate of p(t), and of those of its centre and its points, which are rounded, too. An entry
// of the map's inverse that is 0, or alone in its column, has only its own rounding; others have that of the whole
// column.
static double normal_reach(const Solid *solid, Vec3 n, const Ray *ray, double t)
{
    Vec3 o = ray->origin, d = ray->direction, centre = solid->centre;
    const double terms[3] = {fabs(o.x) + fabs(centre.x) + fabs(t * d.x), fabs(o.y) + fabs(centre.y) + fabs(t * d.y),
                             fabs(o.z) + fabs(centre.z) + fabs(t * d.z)};
    const double normal[3] = {fabs(n.x), fabs(n.y), fabs(n.z)}, *columns = &solid->columns.x;
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        unsigned entries = solid->entries[axis];
        double reach;
        if (normal[axis] == 0.0) {
            continue;
        }
        if ((entries & (entries - 1)) == 0) {
            reach = terms[entries >> 1];
        } else {
            double square = (entries & 1 ? terms[0] * terms[0] : 0.0) + (entries & 2 ? terms[1] * terms[1] : 0.0) +
                            (entries & 4 ? terms[2] * terms[2] : 0.0);
            reach = sqrt(square) + solid->extent;
        }
        sum += normal[axis] * (fixed_size(solid, axis) + columns[axis] * reach);
    }
    return sum;
}

double solid_crossing_error(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side)
{
    if (solid->kind == PART_PLANE) {
        PlaneShape plane = {solid->data[0], solid->data[1].x};
        return plane_crossing_error(&plane, *ray, t);
    }
    Vec3 n = solid->kind == PART_BOX    ? box_normal(side)
             : solid->kind == PART_CONE ? cone_gradient(solid->data[0].x, ray_at(*object, t), side)
                                        : object_normal(solid, ray_at(*object, t), side);
    double reach = normal_reach(solid, n, ray, t);
    return TRANSFORM_ROUNDING * reach / fabs(vec3_dot(n, object->direction));
}

// Each R of normal_reach is at most the sum of all terms, which is as long as `span`, and the map's spread. What both
// round is far below the thousandth that is added.
double solid_crossing_bound(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side, double span)
{
    const double rounding = 1.001 * TRANSFORM_ROUNDING;
    if (solid->kind == PART_PLANE) {
        return rounding * (span + fabs(solid->data[1].x)) / fabs(vec3_dot(solid->data[0], ray->direction));
    }
    const double *columns = &solid->columns.x, *d = &object->direction.x, reach = span + solid->spread;
    if (solid->kind == PART_BOX || (solid->kind == PART_CONE && side != CONE_ROUND)) {
        int axis = solid->kind == PART_BOX ? side / 2 : 2;
        return rounding * (fixed_size(solid, axis) + columns[axis] * reach) / fabs(d[axis]);
    }
    Vec3 point = ray_at(*object, t);
    Vec3 n = solid->kind == PART_CONE ? cone_gradient(solid->data[0].x, point, side) : object_normal(solid, point, side);
    double sum = vec3_sum_abs(n) + (fabs(n.x) * columns[0] + fabs(n.y) * columns[1] + fabs(n.z) * columns[2]) * reach;
    return rounding * sum / fabs(vec3_dot(n, object->direction));
}

double solid_ball_error(const Solid *ball, const Ray *ray, const Ray *object, double t)
{
    double interval =
        2.0 * fabs(vec3_dot(object->origin, object->direction) / vec3_length_squared(object->direction) + t);
    return less_of(solid_crossing_error(ball, ray, object, t, 0), interval);
}

double solid_end_error(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side, double length)
{
    double error = isinf(t) ? 0.0 : solid_crossing_error(solid, ray, object, t, side);
    return error < length ? error : length;
}

double solid_interval_error(const Solid *solid, const Ray *ray, const Ray *object, const RayInterval *interval,
                            bool leaves)
{
    double length = interval->leave - interval->enter;
    return leaves ? solid_end_error(solid, ray, object, interval->leave, interval->leave_side, length)
                  : solid_end_error(solid, ray, object, interval->enter, interval->enter_side, length);
}

void solid_surface(const Solid *solid, const Ray *ray, double t, uint8_t side, Vec3 *point, Vec3 *normal)
{
    if (solid->kind == PART_PLANE) {
        PlaneShape plane = {solid->data[0], solid->data[1].x};
        *point = plane_point(&plane, *ray, t);
        *normal = plane.normal;
        return;
    }
    Ray object = solid_ray(solid, ray);
    Vec3 own = object_point(solid, ray_at(object, t), side);
    *point = vec3_add(solid->centre, linear_direction(&solid->to_world, own));
    *normal = vec3_normalize(linear_normal(&solid->to_object, object_normal(solid, own, side)));
}

bool solid_equal(const Solid *a, const Solid *b)
{
    return a->kind == b->kind && vec3_equal(a->centre, b->centre) &&
           memcmp(&a->to_object, &b->to_object, sizeof a->to_object) == 0 &&
           memcmp(a->data, b->data, sizeof a->data) == 0;
}
