// What rounding does to the crossings of a ray and a primitive, and the surface at a hit: the same for all kinds, by
// what their table knows.
//
// SPDX-License-Identifier: MIT
#include "trace/prepared_primitive.h"

#include <string.h>

#include "math/extreme.h"
#include "math/length.h"
#include "trace/plane.h"

double interval_room(const RayInterval *intervals, unsigned count, unsigned i)
{
    double room = intervals[i].leave - intervals[i].enter;
    for (unsigned other = 0; other < count; other++) {
        double apart = other < i   ? intervals[i].enter - intervals[other].leave
                       : other > i ? intervals[other].enter - intervals[i].leave
                                   : room;
        room = apart >= 0.0 && apart < room ? apart : room; // less than 0: a film lies within
    }
    return room;
}

// ---- errors

static double fixed_size(const PreparedPrimitive *primitive, int axis)
{
    const double *low = &primitive->data[0].x, *high = &primitive->data[1].x;
    return (primitive->traits & TRAIT_SIZED) ? greater_of(fabs(low[axis]), fabs(high[axis])) : 1.0;
}

static double extent_of(const PreparedPrimitive *primitive)
{
    double product = 1.0, sum = 0.0;
    for (int row = 0; row < 3; row++) {
        const double *m = primitive->to_world.m[row];
        double length = length_of(m[0], m[1], m[2]);
        product *= length;
        sum += length * fixed_size(primitive, row);
    }
    // How far the rows are from right angles, which is what an inverse magnifies rounding by: Hadamard's ratio.
    const double(*m)[3] = primitive->to_object.m;
    Vec3 x = vec3(m[0][0], m[0][1], m[0][2]), y = vec3(m[1][0], m[1][1], m[1][2]), z = vec3(m[2][0], m[2][1], m[2][2]);
    return product * fabs(vec3_dot(x, vec3_cross(y, z))) * sum;
}

void primitive_measure(PreparedPrimitive *primitive)
{
    double *columns = &primitive->columns.x;
    bool is_alone = true; // every entry in its column
    for (int axis = 0; axis < 3; axis++) {
        double square = 0.0;
        primitive->entries[axis] = 0;
        for (int from = 0; from < 3; from++) {
            double entry = primitive->to_object.m[from][axis];
            square += entry * entry;
            primitive->entries[axis] |= (uint8_t)((entry != 0.0) << from);
        }
        columns[axis] = sqrt(square);
        is_alone = is_alone && (primitive->entries[axis] & (primitive->entries[axis] - 1)) == 0;
    }
    primitive->extent = is_alone ? 0.0 : extent_of(primitive); // asked for where a column has more
    primitive->spread = primitive->extent + vec3_sum_abs(primitive->centre);
}

// |n|·R for a normal n of the primitive's space, R being per coordinate of that space the sum of the magnitudes of all
// terms that make the coordinate of p(t), and of those of its centre and its points, which are rounded, too. An entry
// of the map's inverse that is 0, or alone in its column, has only its own rounding; others have that of the whole
// column.
RT_ALWAYS_INLINE double normal_reach(const PreparedPrimitive *primitive, Vec3 n, const Ray *ray, double t)
{
    Vec3 o = ray->origin, d = ray->direction, centre = primitive->centre;
    const double terms[3] = {fabs(o.x) + fabs(centre.x) + fabs(t * d.x), fabs(o.y) + fabs(centre.y) + fabs(t * d.y),
                             fabs(o.z) + fabs(centre.z) + fabs(t * d.z)};
    const double normal[3] = {fabs(n.x), fabs(n.y), fabs(n.z)}, *columns = &primitive->columns.x;
    double sum = 0.0;
    for (int axis = 0; axis < 3; axis++) {
        unsigned entries = primitive->entries[axis];
        double reach;
        if (normal[axis] == 0.0) {
            continue;
        }
        if ((entries & (entries - 1)) == 0) {
            reach = terms[entries >> 1];
        } else {
            double square = (entries & 1 ? terms[0] * terms[0] : 0.0) + (entries & 2 ? terms[1] * terms[1] : 0.0) +
                            (entries & 4 ? terms[2] * terms[2] : 0.0);
            reach = sqrt(square) + primitive->extent;
        }
        sum += normal[axis] * (fixed_size(primitive, axis) + columns[axis] * reach);
    }
    return sum;
}

RT_ALWAYS_INLINE double plane_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                                    Vec3 n)
{
    double reach = normal_reach(primitive, n, ray, t);
    return TRANSFORM_ROUNDING * reach / fabs(vec3_dot(n, object->direction));
}

double primitive_crossing_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                                uint8_t side)
{
    if (primitive->kind == PRIMITIVE_PLANE) {
        PlaneShape plane = {primitive->data[0], primitive->data[1].x};
        return plane_crossing_error(&plane, ray->origin, ray->direction, t);
    }
    if (prepared_classes[primitive->kind].met) {
        return 0.0;
    }
    return plane_error(primitive, ray, object, t,
                       prepared_classes[primitive->kind].gradient(primitive, ray_at(*object, t), side));
}

double primitive_plane_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t, Vec3 n)
{
    return plane_error(primitive, ray, object, t, n);
}

// Each R of normal_reach is at most the sum of all terms, which is as long as `span`, and the map's spread. What both
// round is far below the thousandth that is added.
double primitive_crossing_bound(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                                uint8_t side, double span)
{
    const double rounding = 1.001 * TRANSFORM_ROUNDING;
    if (primitive->kind == PRIMITIVE_PLANE) {
        return rounding * (span + fabs(primitive->data[1].x)) / fabs(vec3_dot(primitive->data[0], ray->direction));
    }
    const double *columns = &primitive->columns.x, *d = &object->direction.x, reach = span + primitive->spread;
    if (prepared_classes[primitive->kind].met) {
        return 0.0;
    }
    int across =
        prepared_classes[primitive->kind].across[side]; // NOLINT(bugprone-signed-char-misuse): less than 0 is meant
    if (across > 0) {
        int axis = across - 1;
        return rounding * (fixed_size(primitive, axis) + columns[axis] * reach) / fabs(d[axis]);
    }
    Vec3 n = prepared_classes[primitive->kind].gradient(primitive, ray_at(*object, t), side);
    double sum = vec3_sum_abs(n) + (fabs(n.x) * columns[0] + fabs(n.y) * columns[1] + fabs(n.z) * columns[2]) * reach;
    return rounding * sum / fabs(vec3_dot(n, object->direction));
}

double primitive_ball_error(const PreparedPrimitive *ball, const Ray *ray, const Ray *object, double t)
{
    double interval =
        2.0 * fabs(vec3_dot(object->origin, object->direction) / vec3_length_squared(object->direction) + t);
    return less_of(primitive_crossing_error(ball, ray, object, t, 0), interval);
}

double primitive_end_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                           uint8_t side, double length)
{
    double error = isinf(t) ? 0.0 : primitive_crossing_error(primitive, ray, object, t, side);
    return error < length ? error : length;
}

// ---- surfaces

void primitive_surface(const PreparedPrimitive *primitive, const Ray *ray, double t, uint8_t side, Vec3 *point,
                       Vec3 *normal)
{
    if (primitive->kind == PRIMITIVE_PLANE) {
        PlaneShape plane = {primitive->data[0], primitive->data[1].x};
        *point = plane_point(&plane, *ray, t);
        *normal = plane.normal;
        return;
    }
    Ray object = primitive_ray(primitive, ray);
    Vec3 own = prepared_classes[primitive->kind].point(primitive, ray_at(object, t), side);
    *point = vec3_add(primitive->centre, linear_direction(&primitive->to_world, own));
    const PreparedClass *class = &prepared_classes[primitive->kind];
    Vec3 across = class->met ? class->met(primitive, &object, t) : class->normal(primitive, own, side);
    *normal = vec3_normalize(linear_normal(&primitive->to_object, across));
}

bool primitive_equal(const PreparedPrimitive *a, const PreparedPrimitive *b)
{
    return a->kind == b->kind && vec3_equal(a->centre, b->centre) &&
           memcmp(&a->to_object, &b->to_object, sizeof a->to_object) == 0 &&
           memcmp(a->data, b->data, sizeof a->data) == 0;
}
