// What primitives are called, and how far each reaches in a direction as the affine image of its fixed shape.
//
// SPDX-License-Identifier: MIT
#include "scene/primitive_reach.h"

#include <float.h>
#include <math.h>

#include "scene/polynomial.h"
#include "scene/primitive.h"

bool primitive_map_is_diagonal(const double (*r)[3])
{
    return r[0][1] == 0.0 && r[0][2] == 0.0 && r[1][0] == 0.0 && r[1][2] == 0.0 && r[2][0] == 0.0 && r[2][1] == 0.0;
}

bool primitive_map_is_round(const double (*r)[3])
{
    return primitive_map_is_diagonal(r) && fabs(r[0][0]) == fabs(r[1][1]) && fabs(r[1][1]) == fabs(r[2][2]);
}

const char *primitive_name(const Primitive *primitive)
{
    bool is_stretched = primitive->kind == PRIMITIVE_SPHERE && !primitive_map_is_round(primitive->to_world.m);
    return is_stretched ? "stretched sphere" : primitive_class(primitive->kind)->word;
}

bool primitive_is_endless(const Primitive *primitive)
{
    return primitive->kind == PRIMITIVE_PLANE ||
           (primitive->kind == PRIMITIVE_POLYNOMIAL && !polynomial_is_bounded(primitive->list.items));
}

// The direction as the fixed shape sees it: p·n with p = q M + o is q·(M n) + o·n.
typedef struct ObjectDirection {
    Vec3 direction;
    double offset;
} ObjectDirection;

static ObjectDirection object_direction(const Primitive *primitive, Vec3 n)
{
    const double(*m)[3] = primitive->to_world.m;
    return (ObjectDirection){
        vec3(m[0][0] * n.x + m[0][1] * n.y + m[0][2] * n.z, m[1][0] * n.x + m[1][1] * n.y + m[1][2] * n.z,
             m[2][0] * n.x + m[2][1] * n.y + m[2][2] * n.z),
        m[3][0] * n.x + m[3][1] * n.y + m[3][2] * n.z,
    };
}

double primitive_support(const Primitive *primitive, Vec3 direction)
{
    if (primitive->kind == PRIMITIVE_PLANE) {
        bool is_own = vec3_equal(direction, primitive->data[0]);
        return is_own ? primitive->data[1].x : (double)INFINITY;
    }
    ObjectDirection object = object_direction(primitive, direction);
    return primitive_class(primitive->kind)->support(primitive, object.direction) + object.offset;
}

void primitive_span(const Primitive *primitive, Vec3 direction, double *low, double *high)
{
    if (primitive->kind != PRIMITIVE_SPHERE) {
        *low = -primitive_support(primitive, vec3_neg(direction));
        *high = primitive_support(primitive, direction);
        return;
    }
    ObjectDirection object = object_direction(primitive, direction);
    double half = primitive_class(primitive->kind)->support(primitive, object.direction);
    *low = object.offset - half;
    *high = object.offset + half;
}

double primitive_reach(const Primitive *primitive, Vec3 direction)
{
    double sum = 0.0;
    const double n[3] = {fabs(direction.x), fabs(direction.y), fabs(direction.z)};
    const Vec3 *low = &primitive->data[0];
    const Vec3 *high = &primitive->data[1];
    double sizes[4] = {1.0, 1.0, 1.0, 1.0};
    if (primitive_class(primitive->kind)->is_sized) {
        sizes[0] = fmax(fabs(low->x), fabs(high->x));
        sizes[1] = fmax(fabs(low->y), fabs(high->y));
        sizes[2] = fmax(fabs(low->z), fabs(high->z));
    }
    for (int row = 0; row < 4; row++) {
        const double *m = primitive->to_world.m[row];
        sum += sizes[row] * (fabs(m[0]) * n[0] + fabs(m[1]) * n[1] + fabs(m[2]) * n[2]);
    }
    return sum;
}

// Whether all of `inner` has p·n < limit. A support is off by at most 12 u of its reach: 5 u for the dot products of
// object_direction, 3 u for the root or the sums over them, 2 u for the offset's, and 2 u to spare.
static bool is_below(const Primitive *inner, Vec3 n, double limit, double limit_error)
{
    double error = 12.0 * (DBL_EPSILON / 2) * primitive_reach(inner, n) + limit_error;
    return primitive_support(inner, n) + error < limit;
}

// What a matrix stretches lengths by, at most; of a similarity what it stretches all by.
static double greatest_stretch(const double (*m)[3])
{
    double greatest = 0.0;
    for (int i = 0; i < 3; i++) {
        double sum = 0.0;
        for (int k = 0; k < 3; k++) {
            sum += fabs(m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2]);
        }
        greatest = fmax(greatest, sum);
    }
    return sqrt(greatest);
}

// Whether a ball lies within another, or is the same but for rounding, by the way between their centres and their radii
// in the other's space.
static bool ball_holds_ball(const Primitive *outer, const Primitive *inner)
{
    const double *centre = inner->to_world.m[3];
    Transform both = transform_compose(inner->to_world, outer->to_object);
    Vec3 way = transform_point(&outer->to_object, vec3(centre[0], centre[1], centre[2]));
    double error = 64.0 * (DBL_EPSILON / 2) *
                   (1.0 + primitive_reach(inner, vec3(1.0, 1.0, 1.0)) * greatest_stretch(outer->to_object.m));
    return vec3_length(way) + greatest_stretch(both.m) <= 1.0 + error;
}

// Whether the box of `inner` along the axes of `outer`, a ball or cylinder, lies within it: its corners do.
static bool round_holds(const Primitive *outer, const Primitive *inner)
{
    const double(*m)[3] = outer->to_object.m;
    double far[3], low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        Vec3 n = vec3(m[0][axis], m[1][axis], m[2][axis]);
        double error = 16.0 * (DBL_EPSILON / 2) * (primitive_reach(inner, n) + fabs(m[3][axis]));
        primitive_span(inner, n, &low[axis], &high[axis]);
        low[axis] += m[3][axis] - error;
        high[axis] += m[3][axis] + error;
        far[axis] = fmax(fabs(low[axis]), fabs(high[axis]));
    }
    double square = far[0] * far[0] + far[1] * far[1];
    return outer->kind == PRIMITIVE_SPHERE
               ? (inner->kind == PRIMITIVE_SPHERE && ball_holds_ball(outer, inner)) || square + far[2] * far[2] < 1.0
               : square < 1.0 && low[2] > 0.0 && high[2] < 1.0;
}

bool primitive_contains(const Primitive *outer, const Primitive *inner)
{
    if ((outer->flags & PRIMITIVE_INVERSE) || primitive_is_endless(inner)) {
        return false;
    }
    if (outer->kind == PRIMITIVE_PLANE) {
        return is_below(inner, outer->data[0], outer->data[1].x, 0.0);
    }
    bool is_cylinder = outer->kind == PRIMITIVE_CONE && outer->data[0].x == 1.0 && !(outer->flags & PRIMITIVE_OPEN);
    if (outer->kind == PRIMITIVE_SPHERE || is_cylinder) {
        return round_holds(outer, inner);
    }
    if (outer->kind != PRIMITIVE_BOX) {
        return false;
    }
    // A face of the box is q·axis = corner in its own space: p·n + o·axis = corner with n a column of to_object.
    const double(*m)[3] = outer->to_object.m;
    for (int axis = 0; axis < 3; axis++) {
        Vec3 n = vec3(m[0][axis], m[1][axis], m[2][axis]);
        double low = axis == 0 ? outer->data[0].x : axis == 1 ? outer->data[0].y : outer->data[0].z;
        double high = axis == 0 ? outer->data[1].x : axis == 1 ? outer->data[1].y : outer->data[1].z;
        double error = 4.0 * (DBL_EPSILON / 2) * (fabs(m[3][axis]) + fmax(fabs(low), fabs(high)));
        if (!is_below(inner, n, high - m[3][axis], error) || !is_below(inner, vec3_neg(n), m[3][axis] - low, error)) {
            return false;
        }
    }
    return true;
}
