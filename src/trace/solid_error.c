// What rounding does to the crossings of a ray and a part, and the surface at a hit: the same for all kinds, by what
// their table knows.
//
// SPDX-License-Identifier: MIT
#include "trace/solid.h"

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

static double fixed_size(const Solid *solid, int axis)
{
    const double *low = &solid->data[0].x, *high = &solid->data[1].x;
    return (solid->traits & SOLID_SIZED) ? greater_of(fabs(low[axis]), fabs(high[axis])) : 1.0;
}

static double extent_of(const Solid *solid)
{
    double product = 1.0, sum = 0.0;
    for (int row = 0; row < 3; row++) {
        const double *m = solid->to_world.m[row];
        double length = length_of(m[0], m[1], m[2]);
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
RT_ALWAYS_INLINE double normal_reach(const Solid *solid, Vec3 n, const Ray *ray, double t)
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

RT_ALWAYS_INLINE double plane_error(const Solid *solid, const Ray *ray, const Ray *object, double t, Vec3 n)
{
    double reach = normal_reach(solid, n, ray, t);
    return TRANSFORM_ROUNDING * reach / fabs(vec3_dot(n, object->direction));
}

double solid_crossing_error(const Solid *solid, const Ray *ray, const Ray *object, double t, uint8_t side)
{
    if (solid->kind == PART_PLANE) {
        PlaneShape plane = {solid->data[0], solid->data[1].x};
        return plane_crossing_error(&plane, *ray, t);
    }
    return plane_error(solid, ray, object, t, solid_classes[solid->kind].gradient(solid, ray_at(*object, t), side));
}

double solid_plane_error(const Solid *solid, const Ray *ray, const Ray *object, double t, Vec3 n)
{
    return plane_error(solid, ray, object, t, n);
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
    int across = solid_classes[solid->kind].across[side]; // NOLINT(bugprone-signed-char-misuse): less than 0 is meant
    if (across > 0) {
        int axis = across - 1;
        return rounding * (fixed_size(solid, axis) + columns[axis] * reach) / fabs(d[axis]);
    }
    Vec3 n = solid_classes[solid->kind].gradient(solid, ray_at(*object, t), side);
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

// ---- surfaces

void solid_surface(const Solid *solid, const Ray *ray, double t, uint8_t side, Vec3 *point, Vec3 *normal)
{
    if (solid->kind == PART_PLANE) {
        PlaneShape plane = {solid->data[0], solid->data[1].x};
        *point = plane_point(&plane, *ray, t);
        *normal = plane.normal;
        return;
    }
    Ray object = solid_ray(solid, ray);
    Vec3 own = solid_classes[solid->kind].point(solid, ray_at(object, t), side);
    *point = vec3_add(solid->centre, linear_direction(&solid->to_world, own));
    *normal = vec3_normalize(linear_normal(&solid->to_object, solid_classes[solid->kind].normal(solid, own, side)));
}

bool solid_equal(const Solid *a, const Solid *b)
{
    return a->kind == b->kind && vec3_equal(a->centre, b->centre) &&
           memcmp(&a->to_object, &b->to_object, sizeof a->to_object) == 0 &&
           memcmp(a->data, b->data, sizeof a->data) == 0;
}
