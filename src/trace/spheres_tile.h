// A tile of camera rays against the spheres: part of spheres_kernel.c.
//
// The tile walks the tree once, as a beam. What its leaves hold is narrowed by cones: blocks to the spheres that the
// tile's cone touches, those to the rows whose cones they touch, and only there rays are tested, a row at a time. Cones
// carry a margin far above their rounding; the test of a ray is sphere_test's, operation by operation, so hits are
// those of single rays. Roots are refined at the end, some at once.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_TILE_H
#define TRACE_SPHERES_TILE_H

#include "trace/bvh_walk.h"
#include "trace/cone_test.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/spheres_refine.h"

enum { ROWS = TILE_RAYS / TILE_ROW };

// A tile on its way: its rays, cones around them, and what they have met so far.
typedef struct TileBeam {
    const SphereTable *table;
    const SphereTile *tile;
    TileHits *hits;
    uint64_t rough; // the rays whose roots are to be refined yet
    RayCone cone;
    bool has_rows; // whether the cones of the rows are known; many tiles meet nothing
    bool has_news; // hits came nearer since the limit was taken
    _Alignas(64) double row_axis[3][ROWS];
    _Alignas(64) double row_spread[ROWS];
} TileBeam;

// A unit vector between two rays.
static Vec3 tile_between(const SphereTile *tile, unsigned a, unsigned b)
{
    return vec3_normalize(vec3_add(lane_get(tile->direction, a), lane_get(tile->direction, b)));
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

static Vec3 view_direction(const TileView *view, double u, double v)
{
    return vec3_add(view->direction, vec3_sub(vec3_scale(u, view->right), vec3_scale(v, view->up)));
}

// All places lie in a rectangle, and of directions to a rectangle those to a corner are farthest from the axis.
static bool view_passes(const SphereTable *table, const TileView *view, const double u[TILE_RAYS],
                        const double v[TILE_RAYS])
{
    double across[2], down[2], greatest = 0.0, sum = 0.0;
    if (table->bvh.nodes || table->loose_count == 0) {
        return false;
    }
    values_range(u, TILE_RAYS, &across[0], &across[1]);
    values_range(v, TILE_RAYS, &down[0], &down[1]);
    double u_middle = 0.5 * (across[0] + across[1]), v_middle = 0.5 * (down[0] + down[1]);
    RayCone cone = {.origin = view->origin, .axis = vec3_normalize(view_direction(view, u_middle, v_middle))};
    for (int i = 0; i < 4; i++) {
        Vec3 corner = vec3_normalize(view_direction(view, across[i & 1], down[i >> 1]));
        double apart = vec3_length_squared(vec3_sub(corner, cone.axis));
        greatest = apart > greatest ? apart : greatest;
        sum += apart;
    }
    cone.spread = sqrt(greatest) + CONE_MARGIN;
    bool is_usable = cone.spread < 0.5 && sum < (double)INFINITY; // and no NaN
    return is_usable && cone_spheres(&cone, &table->blocks[0]) == 0;
}

static void beam_set_rows(TileBeam *beam)
{
    for (unsigned row = 0; row < ROWS; row++) {
        unsigned begin = row * TILE_ROW;
        Vec3 axis = tile_between(beam->tile, begin + TILE_ROW / 2 - 1, begin + TILE_ROW / 2);
        beam->row_spread[row] = cone_spread(beam->tile->direction, begin, begin + TILE_ROW, axis);
        beam->row_axis[0][row] = axis.x;
        beam->row_axis[1][row] = axis.y;
        beam->row_axis[2][row] = axis.z;
    }
    beam->has_rows = true;
}

// The rows whose cones touch a sphere at f from the origin.
static unsigned beam_rows(TileBeam *beam, Vec3 f, double f_squared, double radius)
{
    double distance = sqrt(f_squared);
    unsigned apart = 0; // never where squares overflow
    if (!beam->has_rows) {
        beam_set_rows(beam);
    }
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
    uint32_t slot;
    Vec3 f;
    double c, rounding, doubt;
} TileSphere;

// What sphere_test says of a row of rays.
typedef struct RowHits {
    _Alignas(64) double t[TILE_ROW]; // rough roots
    unsigned nearest;                // met, and so much nearer than what was met before that no root need be refined
    unsigned other;                  // met about where something was met before, or doubtful
    unsigned doubtful;
} RowHits;

static void row_test(const TileSphere *sphere, const TileBeam *beam, unsigned begin, RowHits *row)
{
    const SphereTile *tile = beam->tile;
    row->nearest = row->other = row->doubtful = 0;
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
        Doubles before = doubles_load(&beam->hits->t[at]);
        doubles_store(&row->t[i], root);
        unsigned ahead = doubles_ge(t_middle, doubles_splat(0.0));
        possible &= sphere->c >= sphere->doubt ? ahead : ~0u;
        unsigned certain = fabs(sphere->c) >= sphere->doubt ? doubles_ge(discriminant, doubles_splat(sphere->doubt))
                                                            : 0;
        // 1 - slack is exact, so this is nearest_offer_sphere's t < before - slack, which fails where t is infinite.
        unsigned nearest = possible & certain & ~doubles_ge(root, before * (1.0 - SPHERE_ROOT_SLACK)) &
                           ~doubles_ge(doubles_splat(0.0), root);
        unsigned in_time = doubles_ge(before + SPHERE_ROOT_SLACK * before, root);
        row->nearest |= nearest << i;
        row->other |= (possible & ~nearest & (~certain | in_time)) << i;
        row->doubtful |= (possible & ~certain) << i;
    }
}

// A hit that may not be the nearest of its ray.
static void beam_offer(TileBeam *beam, const TileSphere *sphere, unsigned i, double t, bool is_doubtful)
{
    TileHits *hits = beam->hits;
    uint64_t bit = UINT64_C(1) << i;
    SphereRay ray = sphere_tile_ray(beam->tile, i);
    ShapeId before = hits->shape[i];
    Nearest nearest = {{hits->t[i], before, hits->inside & bit},
                       before == SHAPE_NONE ? 0 : beam->table->info[shape_index(before)].order,
                       beam->rough & bit,
                       0.0};
    bool inside = sphere->c < 0.0;
    if (RT_UNLIKELY(is_doubtful)) {
        t = sphere_exact(&ray, &sphere->ball, &inside);
    }
    nearest_offer_sphere(beam->table, &ray, sphere->slot, &sphere->ball, t, inside, !is_doubtful, &nearest);
    tile_hit_set(hits, i, &nearest.hit);
    beam->has_news = true;
    beam->rough = (beam->rough & ~bit) | (nearest.is_rough ? bit : 0);
}

// One sphere against the rays of the tile whose rows it touches.
static void beam_sphere(TileBeam *beam, uint32_t slot)
{
    TileSphere sphere = {.ball = sphere_table_ball(beam->table, slot), .slot = slot};
    sphere.f = vec3_sub(beam->tile->origin, sphere.ball.centre);
    double f_squared = vec3_length_squared(sphere.f);
    double sum = f_squared + sphere.ball.radius_squared;
    sphere.c = f_squared - sphere.ball.radius_squared;
    sphere.rounding = -SPHERE_ROUNDING * sum;
    sphere.doubt = SPHERE_DOUBT * sum;
    TileHits *hits = beam->hits;
    ShapeId shape = shape_id(SHAPE_SPHERE, slot);
    unsigned rows = beam_rows(beam, sphere.f, f_squared, sqrt(sphere.ball.radius_squared));
    for (; rows; rows &= rows - 1) {
        unsigned begin = (unsigned)__builtin_ctz(rows) * TILE_ROW;
        RowHits row;
        row_test(&sphere, beam, begin, &row);
        uint64_t nearest = (uint64_t)row.nearest << begin;
        hits->inside = sphere.c < 0.0 ? hits->inside | nearest : hits->inside & ~nearest;
        beam->rough |= nearest;
        beam->has_news |= nearest != 0;
        hits->met |= nearest;
        for (; row.nearest; row.nearest &= row.nearest - 1) {
            unsigned i = (unsigned)__builtin_ctz(row.nearest);
            hits->t[begin + i] = row.t[i];
            hits->shape[begin + i] = shape;
        }
        for (; row.other; row.other &= row.other - 1) {
            unsigned i = (unsigned)__builtin_ctz(row.other);
            beam_offer(beam, &sphere, begin + i, row.t[i], row.doubtful >> i & 1);
        }
    }
}

static void beam_block(TileBeam *beam, uint32_t block)
{
    unsigned touched = cone_spheres(&beam->cone, &beam->table->blocks[block]);
    for (; touched; touched &= touched - 1) {
        beam_sphere(beam, block * SPHERE_BLOCK + (unsigned)__builtin_ctz(touched));
    }
}

// Up to where a root may yet be the nearest of some ray.
static double beam_limit(const TileBeam *beam)
{
    Doubles last = doubles_load(beam->hits->t);
    for (int i = DOUBLES; i < TILE_RAYS; i += DOUBLES) {
        last = doubles_max(last, doubles_load(&beam->hits->t[i]));
    }
    return nearest_limit(doubles_greatest(last));
}

// Makes the roots right that are rough, a vector at a time.
static void beam_settle(const TileBeam *beam)
{
    TileHits *hits = beam->hits;
    for (unsigned at = 0; at < TILE_RAYS; at += DOUBLES) {
        unsigned rough = (unsigned)(beam->rough >> at) & ((1u << DOUBLES) - 1);
        if (!rough) {
            continue;
        }
        _Alignas(64) double ball[4][DOUBLES], t[DOUBLES];
        unsigned any = (unsigned)__builtin_ctz(rough);
        for (unsigned i = 0; i < DOUBLES; i++) {
            unsigned from = at + (rough >> i & 1 ? i : any);
            Ball own = sphere_table_ball(beam->table, shape_index(hits->shape[from]));
            ball[0][i] = own.centre.x;
            ball[1][i] = own.centre.y;
            ball[2][i] = own.centre.z;
            ball[3][i] = own.radius_squared;
            t[i] = hits->t[from];
        }
        Doubles root = doubles_load(t);
        const SphereTile *tile = beam->tile;
        const Doubles origin[3] = {doubles_splat(tile->origin.x), doubles_splat(tile->origin.y),
                                   doubles_splat(tile->origin.z)};
        const Doubles direction[3] = {doubles_load(&tile->direction[0][at]), doubles_load(&tile->direction[1][at]),
                                      doubles_load(&tile->direction[2][at])};
        unsigned certain = roots_refine(origin, direction, doubles_load(&tile->inverse_square[at]), ball, &root);
        doubles_store(t, root);
        for (; rough; rough &= rough - 1) {
            unsigned i = (unsigned)__builtin_ctz(rough);
            if (RT_UNLIKELY(!(certain >> i & 1))) {
                SphereRay ray = sphere_tile_ray(beam->tile, at + i);
                Ball own = sphere_table_ball(beam->table, shape_index(hits->shape[at + i]));
                bool inside;
                t[i] = sphere_exact(&ray, &own, &inside);
            }
            hits->t[at + i] = t[i];
        }
    }
}

// What one walk meets, of directions in an octant.
static void beam_walk(TileBeam *beam, BvhWalk *walk)
{
    BvhChild leaf;
    float limit = bvh_walk_limit(walk, beam_limit(beam));
    while (bvh_walk_next(walk, limit, &leaf)) {
        beam->has_news = false;
        beam_block(beam, leaf & ~BVH_LEAF);
        if (beam->has_news) {
            limit = bvh_walk_limit(walk, beam_limit(beam));
        }
    }
}

// The spheres of the tree: a walk for each octant into which there are rays, mostly one. False when the tile cannot
// walk it.
static bool beam_tree(TileBeam *beam)
{
    DirectionRange range;
    direction_range(beam->tile->direction, TILE_RAYS, &range);
    for (unsigned octant = 0; octant < OCTANTS; octant++) {
        BvhWalk walk;
        Vec3 least, greatest;
        bool is_too_far;
        if (!direction_octant(&range, octant, &least, &greatest)) {
            continue;
        }
        if (bvh_walk_start_beam(&walk, &beam->table->bvh, beam->tile->origin, 0.0, least, greatest, &is_too_far)) {
            beam_walk(beam, &walk);
        } else if (is_too_far) {
            return false;
        }
    }
    return true;
}

static bool tile_closest(const SphereTable *table, const SphereTile *tile, TileHits *hits)
{
    enum { MIDDLE = TILE_RAYS / 2 - TILE_ROW / 2 };
    TileBeam beam; // not cleared as a whole: rows are set when they are asked for
    beam.table = table;
    beam.tile = tile;
    beam.hits = hits;
    beam.rough = 0;
    beam.has_rows = beam.has_news = false;
    beam.cone.origin = tile->origin;
    beam.cone.aside = 0.0;
    beam.cone.axis = tile_between(tile, MIDDLE - 1, MIDDLE + TILE_ROW);
    beam.cone.spread = cone_spread(tile->direction, 0, TILE_RAYS, beam.cone.axis);
    if (!(beam.cone.spread < 0.5)) {
        return false;
    }
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        hits->t[i] = (double)INFINITY;
        hits->shape[i] = SHAPE_NONE;
    }
    hits->met = hits->inside = 0;
    if (table->loose_count > 0) {
        beam_block(&beam, 0);
    }
    if (table->bvh.nodes && !beam_tree(&beam)) {
        return false;
    }
    beam_settle(&beam);
    return true;
}

#endif
