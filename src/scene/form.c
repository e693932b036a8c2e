// Frames are made from the images of x, y, z and the origin; a shape that is the fixed one already, under a matrix, gets
// that matrix bit for bit, so that a scene dump reads back as the same records.
//
// SPDX-License-Identifier: MIT
#include "scene/form.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

double vector_length(Vec3 vector)
{
    int exponent;
    frexp(vec3_max_abs(vector), &exponent);
    Vec3 scaled = vec3_ldexp(vector, -exponent);
    return ldexp(vec3_length(scaled), exponent);
}

// A vector that was divided by its length once has a square that is off by at most 6 u for the three divisions by a
// length that is itself off by 2 u, and 3 u for the sum: such a vector must not change when it is read again.
Vec3 vector_unit(Vec3 vector)
{
    if (vec3_equal(vector, vec3(0.0, 0.0, 0.0)) || fabs(vec3_length_squared(vector) - 1.0) <= 5.0 * DBL_EPSILON) {
        return vector;
    }
    int exponent;
    frexp(vec3_max_abs(vector), &exponent);
    Vec3 scaled = vec3_ldexp(vector, -exponent);
    double length = vec3_length(scaled);
    return vec3(scaled.x / length, scaled.y / length, scaled.z / length);
}

static void set_row(Transform *frame, int row, Vec3 image)
{
    frame->m[row][0] = image.x;
    frame->m[row][1] = image.y;
    frame->m[row][2] = image.z;
}

// Two unit vectors at right angles to the unit vector n and each other; x and y for z (Duff et al., "Building an
// Orthonormal Basis, Revisited", JCGT 6(1), 2017).
static void set_round(Transform *frame, Vec3 n, double radius)
{
    double sign = copysign(1.0, n.z);
    double a = -1.0 / (sign + n.z);
    double b = n.x * n.y * a;
    set_row(frame, 0, vec3_scale(radius, vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x)));
    set_row(frame, 1, vec3_scale(radius, vec3(b, sign + n.y * n.y * a, -n.y)));
}

const char *primitive_make_ball(Primitive *primitive, Vec3 centre, double radius)
{
    if (radius == 0.0) {
        return "a sphere of radius 0 is not drawn";
    }
    primitive->kind = PRIMITIVE_SPHERE;
    primitive->to_world = transform_compose(transform_scale(vec3(radius, radius, radius)), transform_translate(centre));
    return NULL;
}

void primitive_make_box(Primitive *primitive, Vec3 a, Vec3 b)
{
    primitive->kind = PRIMITIVE_BOX;
    primitive->data[0] = vec3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
    primitive->data[1] = vec3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
}

static void make_round(Primitive *primitive, Vec3 base, double base_radius, Vec3 cap, double cap_radius, bool is_open)
{
    bool turns = base_radius < cap_radius; // the greater end is the base
    Vec3 origin = turns ? cap : base;
    Vec3 axis = vec3_sub(turns ? base : cap, origin);
    double radius = turns ? cap_radius : base_radius;
    primitive->kind = PRIMITIVE_CONE;
    primitive->flags = is_open ? PRIMITIVE_OPEN : 0;
    primitive->data[0] = vec3((turns ? base_radius : cap_radius) / radius, 0.0, 0.0);
    set_round(&primitive->to_world, vector_unit(axis), radius);
    set_row(&primitive->to_world, 2, axis);
    set_row(&primitive->to_world, 3, origin);
}

const char *primitive_make_cylinder(Primitive *primitive, Vec3 base, Vec3 cap, double radius, bool is_open)
{
    if (radius == 0.0) {
        return "a cylinder of radius 0 is not drawn";
    }
    make_round(primitive, base, radius, cap, radius, is_open);
    return NULL;
}

const char *primitive_make_cone(Primitive *primitive, Vec3 base, double base_radius, Vec3 cap, double cap_radius,
                                bool is_open)
{
    if (base_radius == 0.0 && cap_radius == 0.0) {
        return "a cone with both radii 0 is not drawn";
    }
    make_round(primitive, base, base_radius, cap, cap_radius, is_open);
    return NULL;
}

const char *primitive_make_disc(Primitive *primitive, Vec3 centre, Vec3 normal, double radius, double hole)
{
    if (radius == 0.0 || hole >= radius || vec3_equal(normal, vec3(0.0, 0.0, 0.0))) {
        return "a disc without a normal, or with a hole as large as itself, is not drawn";
    }
    Vec3 unit = vector_unit(normal);
    primitive->kind = PRIMITIVE_DISC;
    primitive->data[0] = vec3(hole / radius, 0.0, 0.0);
    set_round(&primitive->to_world, unit, radius);
    set_row(&primitive->to_world, 2, vec3_scale(radius, unit));
    set_row(&primitive->to_world, 3, centre);
    return NULL;
}

// The third row stands at right angles to the triangle, as long as the first.
static const char *triangle_map(Primitive *primitive, const Vec3 corners[3])
{
    Vec3 first = vec3_sub(corners[1], corners[0]), second = vec3_sub(corners[2], corners[0]);
    Vec3 normal = vec3_cross(vector_unit(first), vector_unit(second));
    set_row(&primitive->to_world, 0, first);
    set_row(&primitive->to_world, 1, second);
    set_row(&primitive->to_world, 2, vec3_scale(vector_length(first), vector_unit(normal)));
    set_row(&primitive->to_world, 3, corners[0]);
    Transform back;
    return transform_invert(&primitive->to_world, &back) ? NULL
                                                         : "a triangle with its corners on one line is not drawn";
}

const char *primitive_make_triangle(Primitive *primitive, const Vec3 corners[3])
{
    primitive->kind = PRIMITIVE_TRIANGLE;
    return triangle_map(primitive, corners);
}

// A normal n of the shape is M n as the fixed shape sees it, M being the frame.
const char *primitive_make_smooth_triangle(Primitive *primitive, const Vec3 corners[3], const Vec3 normals[3])
{
    primitive->kind = PRIMITIVE_SMOOTH_TRIANGLE;
    const char *why_nothing = triangle_map(primitive, corners);
    int sides = 0;
    for (int i = 0; i < 3 && !why_nothing; i++) {
        double side = vec3_dot(
            normals[i], vec3(primitive->to_world.m[2][0], primitive->to_world.m[2][1], primitive->to_world.m[2][2]));
        sides += (side > 0.0) - (side < 0.0);
        if (vec3_equal(normals[i], vec3(0.0, 0.0, 0.0))) {
            return "a smooth triangle with a normal of 0 is not drawn";
        }
        primitive->data[i] = transform_normal(&primitive->to_world, normals[i]);
    }
    if (!why_nothing && abs(sides) < 3) {
        return "a smooth triangle with a normal along it, or with normals on both sides, is not drawn";
    }
    return why_nothing;
}

// Adding 0 makes -0 a 0, so that a matrix that is written and read again is the same.
static void make_zeros_positive(Transform *transform)
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 3; column++) {
            transform->m[row][column] += 0.0;
        }
    }
}

// The normals' lengths count where they are weighed against each other, in the scene itself. One that is 1 to 12 digits
// is left alone, so that it stays the same when a dump is read; no picture tells.
static void normalise_corners(Primitive *primitive)
{
    for (int i = 0; primitive->kind == PRIMITIVE_SMOOTH_TRIANGLE && i < 3; i++) {
        double length = vector_length(transform_normal(&primitive->to_object, primitive->data[i]));
        if (!(fabs(length - 1.0) < 1e-12)) {
            primitive->data[i] = vec3_scale(1.0 / length, primitive->data[i]);
        }
    }
}

Primitive part_empty(uint64_t source)
{
    return (Primitive){
        .node = NODE_NONE,
        .source = source,
        .to_world = transform_identity(),
        .to_object = transform_identity(),
    };
}

bool part_finish(Primitive *primitive)
{
    make_zeros_positive(&primitive->to_world);
    if (!transform_is_finite(&primitive->to_world) || !transform_invert(&primitive->to_world, &primitive->to_object)) {
        return false;
    }
    normalise_corners(primitive);
    return true;
}
