// Horner's scheme in three variables, and the box of an ellipsoid.
//
// SPDX-License-Identifier: MIT
#include "scene/polynomial.h"

#include <math.h>

#include "base/attributes.h"

double polynomial_value(const double *list, Vec3 p)
{
    unsigned order = polynomial_order(list);
    const double *c = polynomial_terms(list);
    double value = 0.0;
    for (unsigned i = order + 1; i-- > 0;) {
        double row = 0.0;
        for (unsigned j = order - i + 1; j-- > 0;) {
            double line = 0.0;
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                line = line * p.z + *c++;
            }
            row = row * p.y + line;
        }
        value = value * p.x + row;
    }
    return value;
}

RT_ALWAYS_INLINE Vec3 gradient_of(const double *list, unsigned order, Vec3 p)
{
    const double *c = polynomial_terms(list);
    double value = 0.0;
    Vec3 gradient = {0.0, 0.0, 0.0};
#pragma GCC unroll 3
    for (unsigned i = order + 1; i-- > 0;) {
        double row = 0.0, row_y = 0.0, row_z = 0.0;
#pragma GCC unroll 3
        for (unsigned j = order - i + 1; j-- > 0;) {
            double line = 0.0, line_z = 0.0;
#pragma GCC unroll 3
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                line_z = line_z * p.z + line;
                line = line * p.z + *c++;
            }
            row_y = row_y * p.y + row;
            row_z = row_z * p.y + line_z;
            row = row * p.y + line;
        }
        gradient.x = gradient.x * p.x + value;
        gradient.y = gradient.y * p.x + row_y;
        gradient.z = gradient.z * p.x + row_z;
        value = value * p.x + row;
    }
    return gradient;
}

// Quadrics are the most by far: their loops are unrolled.
Vec3 polynomial_gradient(const double *list, Vec3 p)
{
    return polynomial_order(list) == 2 ? gradient_of(list, 2, p) : gradient_of(list, polynomial_order(list), p);
}

static void set_sizes(unsigned order, double *list)
{
    double *sizes = list + 2;
    const double *c = list + 2 + order + 1;
    for (unsigned degree = 0; degree <= order; degree++) {
        sizes[degree] = 0.0;
    }
    for (unsigned i = order + 1; i-- > 0;) {
        for (unsigned j = order - i + 1; j-- > 0;) {
            for (unsigned k = order - i - j + 1; k-- > 0;) {
                sizes[i + j + k] += fabs(*c++);
            }
        }
    }
}

// The box of an ellipsoid whose inside is within: with f = p·Q p + 2 b·p + c, the middle m is -Q⁻¹ b, and the surface
// reaches sqrt(-f(m) (Q⁻¹)_ii) from it along an axis. Q is positive if its leading minors are. What rounding may do is
// far below the share of 2^-20 that is added, where no minor is smaller than 2^-6 of its terms: elsewhere there is no
// box.
static bool ellipsoid_box(const double *c, Vec3 *low, Vec3 *high)
{
    const double share = 0x1p-6;
    double xx = c[0], xy = 0.5 * c[1], xz = 0.5 * c[2], yy = c[4], yz = 0.5 * c[5], zz = c[7];
    Vec3 b = {0.5 * c[3], 0.5 * c[6], 0.5 * c[8]};
    double minors[3] = {yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy};
    if (!(xx > 0.0 && yy > 0.0 && zz > 0.0 && minors[0] > share * yy * zz && minors[1] > share * xx * zz &&
          minors[2] > share * xx * yy)) {
        return false;
    }
    double xy_minor = xz * yz - xy * zz, xz_minor = xy * yz - xz * yy, yz_minor = xy * xz - yz * xx;
    double whole = xx * minors[0] + xy * xy_minor + xz * xz_minor;
    if (!(whole > share * xx * yy * zz)) {
        return false;
    }
    Vec3 middle = {-(minors[0] * b.x + xy_minor * b.y + xz_minor * b.z) / whole,
                   -(xy_minor * b.x + minors[1] * b.y + yz_minor * b.z) / whole,
                   -(xz_minor * b.x + yz_minor * b.y + minors[2] * b.z) / whole};
    double depth = -(vec3_dot(b, middle) + c[9]), size = fabs(c[9]) + fabs(vec3_dot(b, middle));
    if (!(depth > 0x1p-8 * size)) {
        return false;
    }
    const double slack = 1.0 + 0x1p-20;
    Vec3 half = {slack * sqrt(depth * minors[0] / whole), slack * sqrt(depth * minors[1] / whole),
                 slack * sqrt(depth * minors[2] / whole)};
    half = vec3_add(half, vec3(0x1p-20 * fabs(middle.x), 0x1p-20 * fabs(middle.y), 0x1p-20 * fabs(middle.z)));
    *low = vec3_sub(middle, half);
    *high = vec3_add(middle, half);
    return vec3_is_finite(*low) && vec3_is_finite(*high);
}

bool polynomial_box(const double *list, Vec3 *low, Vec3 *high)
{
    return polynomial_order(list) == 2 && ellipsoid_box(polynomial_terms(list), low, high);
}

void polynomial_complete(double *list)
{
    Vec3 low, high;
    set_sizes(polynomial_order(list), list);
    list[1] = polynomial_box(list, &low, &high);
}

void polynomial_part(const Numbers *list, Part *part)
{
    part->kind = PART_POLYNOMIAL;
    part->fixed[0] = part->fixed[1] = vec3(0.0, 0.0, 0.0);
    part->list = *list;
    if (polynomial_is_bounded(list->items)) {
        (void)polynomial_box(list->items, &part->fixed[0], &part->fixed[1]);
    }
}

bool polynomial_is_constant(const double *list)
{
    const double *sizes = polynomial_sizes(list);
    for (unsigned degree = 1; degree <= polynomial_order(list); degree++) {
        if (sizes[degree] != 0.0) {
            return false;
        }
    }
    return true;
}
