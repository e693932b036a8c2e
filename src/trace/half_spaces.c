// How far a polyhedron reaches along the axes.
//
// A plane e·p = b has all of it on one side when e is a sum of the half spaces' normals, none counted less than 0, and
// b the same sum of their distances: the direction_over_length2 of a linear program. Three of them are enough; they are
// found by the direction_over_length2 simplex method (C. E. Lemke, Naval Research Logistics Quarterly 1, 1954). However
// it came about, the sum is then checked by itself, and what rounding makes of it is less than the box is larger than
// it need be.
//
// SPDX-License-Identifier: MIT
#include "trace/half_spaces.h"

#include <math.h>
#include <stddef.h>

enum { BASIS = 3 };

typedef struct Basis {
    HalfSpace space[BASIS];
    double weight[BASIS]; // not less than 0: what each counts in e
    bool is_far[BASIS];   // no half space of the polyhedron, but one far away to begin with
    Vec3 towards[BASIS];  // v·towards[k] is what k counts in v
    Vec3 corner;          // where the three planes meet
} Basis;

// False when the three normals lie in a plane, or nearly so.
static bool basis_measure(Basis *basis)
{
    const HalfSpace *s = basis->space;
    double volume = vec3_dot(s[0].normal, vec3_cross(s[1].normal, s[2].normal));
    basis->corner = vec3(0.0, 0.0, 0.0);
    for (int k = 0; k < BASIS; k++) {
        Vec3 across = vec3_cross(s[(k + 1) % BASIS].normal, s[(k + 2) % BASIS].normal);
        basis->towards[k] = vec3_scale(1.0 / volume, across);
        basis->corner = vec3_add_scaled(basis->corner, s[k].distance, basis->towards[k]);
    }
    return fabs(volume) > 0x1p-30;
}

// Takes a half space that the corner is outside of in place of one of the three. False when nothing is in common.
static bool basis_take(Basis *basis, const HalfSpace *taken)
{
    double counts[BASIS], least = (double)INFINITY;
    int out = -1;
    for (int k = 0; k < BASIS; k++) {
        counts[k] = vec3_dot(taken->normal, basis->towards[k]);
        double ratio = basis->weight[k] / counts[k];
        if (counts[k] > 0x1p-40 && (ratio < least || (ratio == least && basis->is_far[k]))) {
            least = ratio;
            out = k;
        }
    }
    if (out < 0) {
        return false;
    }
    for (int k = 0; k < BASIS; k++) {
        basis->weight[k] = k == out ? least : fmax(basis->weight[k] - least * counts[k], 0.0);
    }
    basis->space[out] = *taken;
    basis->is_far[out] = false;
    return true;
}

// Some half spaces; what is farther out than `far` does not matter.
typedef struct Polyhedron {
    const HalfSpace *spaces;
    uint32_t count;
    double far;
} Polyhedron;

// The half space that the corner is farthest outside of; NULL when it is nearly within all.
static const HalfSpace *find_outside(const Basis *basis, const Polyhedron *polyhedron)
{
    const HalfSpace *found = NULL;
    double slack = 0x1p-40 * polyhedron->far;
    for (uint32_t i = 0; i < polyhedron->count; i++) {
        const HalfSpace *space = &polyhedron->spaces[i];
        double out = vec3_dot(space->normal, basis->corner) - space->distance;
        if (out > slack) {
            slack = out;
            found = space;
        }
    }
    return found;
}

// What the weights prove: p·e <= *reach + the 2^-34th of *size and of |p|.
static bool basis_proves(const Basis *basis, Vec3 e, double *reach, double *size)
{
    double sum = 0.0;
    *reach = *size = 0.0;
    for (int k = 0; k < BASIS; k++) {
        double weight = basis->is_far[k] ? 0.0 : basis->weight[k];
        e = vec3_add_scaled(e, -weight, basis->space[k].normal);
        *reach += weight * basis->space[k].distance;
        *size += weight * fabs(basis->space[k].distance);
        sum += weight;
    }
    return sum <= 0x1p12 && vec3_sum_abs(e) <= 0x1p-36; // rounding adds less than 2^-38 to each
}

static bool find_reach(const Polyhedron *polyhedron, int axis, double sign, double *reach, double *size)
{
    const uint32_t steps_most = 64; // a polyhedron of hundreds of faces takes about ten
    Vec3 e = vec3(axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0);
    Basis basis = {.is_far = {true, true, true}};
    for (int k = 0; k < BASIS; k++) {
        basis.space[k] =
            (HalfSpace){vec3(k == 0 ? sign : 0.0, k == 1 ? sign : 0.0, k == 2 ? sign : 0.0), polyhedron->far};
        basis.weight[k] = k == axis;
    }
    for (uint32_t step = 0; step < steps_most; step++) {
        if (!basis_measure(&basis)) {
            return false;
        }
        const HalfSpace *outside = find_outside(&basis, polyhedron);
        if (!outside) {
            break; // later steps would but move the box a little inward
        }
        if (!basis_take(&basis, outside)) {
            return false;
        }
    }
    return basis_proves(&basis, e, reach, size);
}

bool half_spaces_bounds(const HalfSpace *spaces, uint32_t count, Bounds *bounds)
{
    double farthest = 0.0, high[3], low[3], most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        farthest = fmax(farthest, fabs(spaces[i].distance));
    }
    if (count < 4 || !(farthest > 0x1p-900 && farthest < 0x1p900)) {
        return false;
    }
    const Polyhedron polyhedron = {spaces, count, 0x1p20 * farthest};
    for (int axis = 0; axis < 3; axis++) {
        double above, below;
        if (!find_reach(&polyhedron, axis, 1.0, &high[axis], &above) ||
            !find_reach(&polyhedron, axis, -1.0, &low[axis], &below)) {
            return false;
        }
        most = fmax(most, fmax(above, below));
    }
    Vec3 margin = vec3_scale(0x1p-30 * most, vec3(1.0, 1.0, 1.0));
    *bounds =
        (Bounds){vec3_sub(vec3(-low[0], -low[1], -low[2]), margin), vec3_add(vec3(high[0], high[1], high[2]), margin)};
    return true;
}
