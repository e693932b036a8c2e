// A tile of camera rays against the spheres: part of spheres_kernel.c.
//
// The tile walks the tree once, as a beam. What its leaves hold is narrowed by cones: blocks to the spheres that the
// tile's cone touches, those to the rows whose cones they touch, and only there rays are tested, a row at a time. Cones
// carry a margin far above their rounding; the test of a ray is sphere_test's, operation by operation, so hits are
// those of single rays.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_TILE_H
#define TRACE_SPHERES_TILE_H

#include "trace/bvh_walk.h"
#include "trace/simd.h"
#include "trace/spheres.h"

enum { ROWS = TILE_RAYS / TILE_ROW };

// Directions within `spread` of the axis: a sphere that one of them meets is no farther from the axis than
// |centre - origin| spread + radius.
typedef struct TileBeam {
    Vec3 axis;
    double spread;
    _Alignas(64) double row_axis[3][ROWS], row_spread[ROWS];
    _Alignas(64) double limits[TILE_RAYS]; // nearest_limit of each ray
    Vec3 least, greatest;     // components of the directions by size
    bool has_signs;           // each component has one sign in all directions
} TileBeam;

// For the rounding of distances from an axis, which are differences of squares: their error is about 2^-25 |f|.
static const double CONE_MARGIN = 0x1p-20;

static Vec3 tile_direction(const SphereTile *tile, unsigned i)
{
    return vec3(tile->direction[0][i], tile->direction[1][i], tile->direction[2][i]);
}

static bool view_tile(const TileView *view, const double u[TILE_RAYS], const double v[TILE_RAYS], SphereTile *tile)
{
    const double begin[3] = {view->direction.x, view->direction.y, view->direction.z};
    const double right[3] = {view->right.x, view->right.y, view->right.z};
    const double up[3] = {view->up.x, view->up.y, view->up.z};
    Doubles least = doubles_splat((double)INFINITY);
    Doubles greatest = doubles_splat(0.0);
    tile->origin = view->origin;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        Doubles towards[3];
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; axis++) {
            towards[axis] = begin[axis] + (doubles_load(&u[i]) * right[axis] - doubles_load(&v[i]) * up[axis]);
        }
        Doubles shrink =
            1.0 / doubles_sqrt(towards[0] * towards[0] + towards[1] * towards[1] + towards[2] * towards[2]);
        Doubles x = shrink * towards[0], y = shrink * towards[1], z = shrink * towards[2];
        Doubles inverse_square = 1.0 / (x * x + y * y + z * z);
        doubles_store(&tile->direction[0][i], x);
        doubles_store(&tile->direction[1][i], y);
        doubles_store(&tile->direction[2][i], z);
        doubles_store(&tile->dual[0][i], inverse_square * x);
        doubles_store(&tile->dual[1][i], inverse_square * y);
        doubles_store(&tile->dual[2][i], inverse_square * z);
        doubles_store(&tile->inverse_square[i], inverse_square);
        least = doubles_min(inverse_square, least);
        greatest = doubles_max(inverse_square, greatest);
    }
    return doubles_least(least) > 0x1p-100 && doubles_greatest(greatest) < (double)INFINITY;
}

// How far the directions of some rays are from an axis.
RT_ALWAYS_INLINE double cone_spread(const SphereTile *tile, unsigned begin, unsigned end, Vec3 axis)
{
    Doubles greatest = doubles_splat(0.0);
    for (unsigned i = begin; i < end; i += DOUBLES) {
        Doubles x = doubles_load(&tile->direction[0][i]) - axis.x;
        Doubles y = doubles_load(&tile->direction[1][i]) - axis.y;
        Doubles z = doubles_load(&tile->direction[2][i]) - axis.z;
        greatest = doubles_max(greatest, x * x + y * y + z * z);
    }
    return sqrt(doubles_greatest(greatest)) + CONE_MARGIN;
}

// The least and the greatest by size; false when signs differ.
RT_ALWAYS_INLINE bool component_range(const double values[TILE_RAYS], double *least, double *greatest)
{
    Doubles low_values = doubles_load(values);
    Doubles high_values = low_values;
    for (int i = DOUBLES; i < TILE_RAYS; i += DOUBLES) {
        low_values = doubles_min(low_values, doubles_load(&values[i]));
        high_values = doubles_max(high_values, doubles_load(&values[i]));
    }
    double low = doubles_least(low_values);
    double high = doubles_greatest(high_values);
    bool is_negative = high < 0.0;
    *least = is_negative ? high : low;
    *greatest = is_negative ? low : high;
    return low > 0.0 || is_negative;
}

static void beam_init(TileBeam *beam, const SphereTile *tile, const Nearest nearest[TILE_RAYS])
{
    enum { MIDDLE = TILE_RAYS / 2 - TILE_ROW / 2 };
    beam->axis = vec3_normalize(vec3_add(tile_direction(tile, MIDDLE - 1), tile_direction(tile, MIDDLE + TILE_ROW)));
    beam->spread = cone_spread(tile, 0, TILE_RAYS, beam->axis);
    for (unsigned row = 0; row < ROWS; row++) {
        unsigned begin = row * TILE_ROW;
        Vec3 axis = vec3_normalize(
            vec3_add(tile_direction(tile, begin + TILE_ROW / 2 - 1), tile_direction(tile, begin + TILE_ROW / 2)));
        beam->row_spread[row] = cone_spread(tile, begin, begin + TILE_ROW, axis);
        beam->row_axis[0][row] = axis.x;
        beam->row_axis[1][row] = axis.y;
        beam->row_axis[2][row] = axis.z;
    }
    for (int i = 0; i < TILE_RAYS; i++) {
        beam->limits[i] = nearest_limit(nearest[i].hit.t);
    }
    bool x = component_range(tile->direction[0], &beam->least.x, &beam->greatest.x);
    bool y = component_range(tile->direction[1], &beam->least.y, &beam->greatest.y);
    bool z = component_range(tile->direction[2], &beam->least.z, &beam->greatest.z);
    beam->has_signs = x && y && z;
}

// The spheres of a block that the tile's cone touches.
static unsigned beam_spheres(const TileBeam *beam, const SphereTile *tile, const SphereBlock *block)
{
    unsigned touched = 0;
    for (int i = 0; i < SPHERE_BLOCK; i += DOUBLES) {
        Doubles fx = tile->origin.x - doubles_load(&block->x[i]);
        Doubles fy = tile->origin.y - doubles_load(&block->y[i]);
        Doubles fz = tile->origin.z - doubles_load(&block->z[i]);
        Doubles along = fx * beam->axis.x + fy * beam->axis.y + fz * beam->axis.z;
        Doubles f_squared = fx * fx + fy * fy + fz * fz;
        Doubles radius_squared = doubles_load(&block->radius_squared[i]);
        Doubles reach = doubles_sqrt(f_squared) * beam->spread + doubles_sqrt(radius_squared);
        unsigned apart = doubles_ge(f_squared - along * along, reach * reach); // never where squares overflow
        touched |= (doubles_ge(radius_squared, doubles_splat(0.0)) & ~apart) << i;
    }
    return touched;
}

// The rows whose cones touch a sphere at f from the origin.
static unsigned beam_rows(const TileBeam *beam, Vec3 f, double f_squared, double radius)
{
    double distance = sqrt(f_squared);
    unsigned apart = 0; // never where squares overflow
    for (int i = 0; i < ROWS; i += DOUBLES) {
        Doubles along = f.x * doubles_load(&beam->row_axis[0][i]) + f.y * doubles_load(&beam->row_axis[1][i]) +
                        f.z * doubles_load(&beam->row_axis[2][i]);
        Doubles reach = distance * doubles_load(&beam->row_spread[i]) + radius;
        apart |= doubles_ge(f_squared - along * along, reach * reach) << i;
    }
    return ~apart & ((1u << ROWS) - 1);
}

// What a sphere is to all rays of the tile.
typedef struct TileSphere {
    Ball ball;
    Vec3 f;
    double c, rounding, doubt;
} TileSphere;

// sphere_test for a row of rays. The rays that meet the sphere in time, or may.
static unsigned row_test(const TileSphere *sphere, const SphereTile *tile, const TileBeam *beam, unsigned begin,
                         double t[TILE_ROW], unsigned *doubtful)
{
    unsigned met = 0;
    *doubtful = 0;
    for (unsigned i = 0; i < TILE_ROW; i += DOUBLES) {
        unsigned at = begin + i;
        Doubles dx = doubles_load(&tile->direction[0][at]);
        Doubles dy = doubles_load(&tile->direction[1][at]);
        Doubles dz = doubles_load(&tile->direction[2][at]);
        Doubles t_middle = -(sphere->f.x * doubles_load(&tile->dual[0][at]) +
                             sphere->f.y * doubles_load(&tile->dual[1][at]) +
                             sphere->f.z * doubles_load(&tile->dual[2][at]));
        Doubles lx = sphere->f.x + t_middle * dx;
        Doubles ly = sphere->f.y + t_middle * dy;
        Doubles lz = sphere->f.z + t_middle * dz;
        Doubles discriminant = sphere->ball.radius_squared - (lx * lx + ly * ly + lz * lz);
        unsigned possible = doubles_ge(discriminant, doubles_splat(sphere->rounding));
        if (!possible) {
            continue;
        }
        Doubles inverse_square = doubles_load(&tile->inverse_square[at]);
        Doubles far_side = doubles_abs(t_middle) + doubles_sqrt(discriminant * inverse_square);
        Doubles near_side = fabs(sphere->c) * inverse_square / far_side;
        Doubles root = sphere->c > 0.0 ? near_side : doubles_if_negative(t_middle, near_side, far_side);
        doubles_store(&t[i], root);
        unsigned ahead = doubles_ge(t_middle, doubles_splat(0.0));
        possible &= sphere->c >= sphere->doubt ? ahead : ~0u;
        unsigned certain = fabs(sphere->c) >= sphere->doubt
                               ? doubles_ge(discriminant, doubles_splat(sphere->doubt))
                               : 0;
        met |= (possible & (~certain | doubles_ge(doubles_load(&beam->limits[at]), root))) << i;
        *doubtful |= (possible & ~certain) << i;
    }
    return met;
}

// One sphere against the rays of the tile whose rows it touches.
static void tile_sphere(const SphereTable *table, const SphereTile *tile, TileBeam *beam, uint32_t slot,
                        Nearest nearest[TILE_RAYS])
{
    TileSphere sphere = {.ball = sphere_table_ball(table, slot)};
    sphere.f = vec3_sub(tile->origin, sphere.ball.centre);
    double f_squared = vec3_length_squared(sphere.f);
    double sum = f_squared + sphere.ball.radius_squared;
    sphere.c = f_squared - sphere.ball.radius_squared;
    sphere.rounding = -SPHERE_ROUNDING * sum;
    sphere.doubt = SPHERE_DOUBT * sum;
    unsigned rows = beam_rows(beam, sphere.f, f_squared, sqrt(sphere.ball.radius_squared));
    for (; rows; rows &= rows - 1) {
        unsigned begin = (unsigned)__builtin_ctz(rows) * TILE_ROW;
        _Alignas(64) double t[TILE_ROW];
        unsigned doubtful;
        unsigned met = row_test(&sphere, tile, beam, begin, t, &doubtful);
        for (; met; met &= met - 1) {
            unsigned i = (unsigned)__builtin_ctz(met);
            SphereRay ray = sphere_tile_ray(tile, begin + i);
            bool inside = sphere.c < 0.0;
            bool is_rough = !(doubtful >> i & 1);
            if (RT_UNLIKELY(!is_rough)) {
                t[i] = sphere_exact(&ray, &sphere.ball, &inside);
            }
            nearest_offer_sphere(table, &ray, slot, &sphere.ball, t[i], inside, is_rough, &nearest[begin + i]);
            beam->limits[begin + i] = nearest_limit(nearest[begin + i].hit.t);
        }
    }
}

static double beam_limit(const TileBeam *beam)
{
    Doubles limit = doubles_load(beam->limits);
    for (int i = DOUBLES; i < TILE_RAYS; i += DOUBLES) {
        limit = doubles_max(limit, doubles_load(&beam->limits[i]));
    }
    return doubles_greatest(limit);
}

static bool tile_closest(const SphereTable *table, const SphereTile *tile, Nearest nearest[TILE_RAYS])
{
    TileBeam beam;
    BvhWalk walk;
    BvhChild leaf;
    bool is_too_far = false;
    beam_init(&beam, tile, nearest);
    if (!(beam.spread < 0.5) || (table->bvh.nodes && !beam.has_signs)) {
        return false;
    }
    bool walks = bvh_walk_start_beam(&walk, &table->bvh, tile->origin, beam.least, beam.greatest, &is_too_far);
    if (is_too_far && table->bvh.nodes) {
        return false;
    }
    for (uint32_t i = 0; i < table->loose_count; i++) {
        tile_sphere(table, tile, &beam, i, nearest);
    }
    float limit = walks ? bvh_walk_limit(&walk, beam_limit(&beam)) : -1.0f;
    while (walks && bvh_walk_next(&walk, limit, &leaf)) {
        uint32_t block = leaf & ~BVH_LEAF;
        unsigned touched = beam_spheres(&beam, tile, &table->blocks[block]);
        if (!touched) {
            continue;
        }
        for (; touched; touched &= touched - 1) {
            tile_sphere(table, tile, &beam, block * SPHERE_BLOCK + (unsigned)__builtin_ctz(touched), nearest);
        }
        limit = bvh_walk_limit(&walk, beam_limit(&beam));
    }
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        if (nearest[i].is_rough) {
            SphereRay ray = sphere_tile_ray(tile, i);
            nearest_settle(table, &ray, &nearest[i]);
        }
    }
    return true;
}

#endif
