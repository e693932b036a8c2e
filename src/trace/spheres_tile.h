// A tile of camera rays against the spheres: part of spheres_kernel.c.
//
// The tile walks the tree once, as a beam. What its leaves hold is narrowed by planes through the origin of the rays:
// blocks to the spheres that the planes of the tile's rows and columns touch, those to the rows whose planes they touch
// before all rays of the row have met something, and only there rays are tested, a row at a time. Planes carry a margin
// far above their rounding; the test of a ray is sphere_test's (trace/sphere.inc), so hits are those of single rays.
// Roots are refined at the end, some at once.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_TILE_H
#define TRACE_SPHERES_TILE_H

#include "trace/bvh_walk.h"
#include "trace/cone_test.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/sphere_rays.h"
#include "trace/tile_planes.h"

// A tile on its way: its rays, planes through them, and what they have met so far.
typedef struct TileBeam {
    const SphereTable *table;
    const SphereTile *tile;
    TileHits *hits;
    uint64_t approximate; // the rays whose roots are to be refined yet
    double limit;   // up to where a root may yet be the nearest of some ray
    bool has_news;  // hits came nearer
    TilePlanes planes;
    _Alignas(64) double row_limit[ROWS]; // as `limit`, of each row
    _Alignas(64) int64_t shape[TILE_RAYS]; // of the hits, as wide as their roots
} TileBeam;

// Some of a tile's rays.
RT_ALWAYS_INLINE SphereRays sphere_tile_rays(const SphereTile *tile, unsigned at)
{
    return (SphereRays){vec3s_splat(tile->origin), vec3s_load(tile->direction, at),
                        vec3s_load(tile->direction_over_length2, at), doubles_load(&tile->inverse_square[at])};
}

static bool view_tile(const TileView *view, const double u[TILE_RAYS], const double v[TILE_RAYS], SphereTile *tile)
{
    const Vec3s origin = vec3s_splat(view->origin), begin = vec3s_splat(view->direction);
    const Vec3s right = vec3s_splat(view->right), up = vec3s_splat(view->up);
    Doubles least = doubles_splat((double)INFINITY);
    Doubles greatest = doubles_splat(0.0);
    tile->origin = view->origin;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        Vec3s aside = vec3s_sub(vec3s_scale(doubles_load(&u[i]), right), vec3s_scale(doubles_load(&v[i]), up));
        SphereRays rays = sphere_rays_make(origin, vec3s_normalize(vec3s_add(begin, aside)));
        vec3s_store(tile->direction, i, rays.direction);
        vec3s_store(tile->direction_over_length2, i, rays.direction_over_length2);
        doubles_store(&tile->inverse_square[i], rays.inverse_square);
        least = doubles_min(rays.inverse_square, least);
        greatest = doubles_max(rays.inverse_square, greatest);
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

// Bit i is set where spheres at f from the origin do not touch a plane: where the middle of a ray's way through a sphere
// is no farther from the origin than |f|, f is no farther from the plane than |f| spread + radius.
RT_ALWAYS_INLINE unsigned planes_apart(Vec3s f, Vec3s normal, Doubles reach)
{
    return doubles_ge(doubles_abs(vec3s_dot(f, normal)), reach);
}

// What a block's spheres are to the origin of a tile.
typedef struct BlockView {
    _Alignas(64) double f[3][SPHERE_BLOCK]; // origin - centre
    double f_squared[SPHERE_BLOCK], distance[SPHERE_BLOCK], radius[SPHERE_BLOCK];
    double nearest[SPHERE_BLOCK]; // no root is less
} BlockView;

// The spheres of a block that the tile touches before all its rays have met something, a bit for each; 0 leaves `view`
// as it was.
RT_ALWAYS_INLINE unsigned block_view(const TileBeam *beam, const SphereBlock *block, BlockView *view)
{
    enum { PARTS = SPHERE_BLOCK / DOUBLES };
    unsigned touched = 0;
    const Vec3s origin = vec3s_splat(beam->tile->origin), along = vec3s_splat(beam->planes.along.normal);
    const Vec3s across = vec3s_splat(beam->planes.across.normal);
    Vec3s f[PARTS];
    Doubles f_squared[PARTS], distance[PARTS], radius[PARTS], nearest[PARTS];
#pragma GCC unroll 4
    for (int i = 0; i < PARTS; i++) {
        int at = i * DOUBLES;
        Balls balls = balls_load(block, (uint32_t)at);
        f[i] = vec3s_sub(origin, balls.centre);
        f_squared[i] = vec3s_length_squared(f[i]);
        distance[i] = doubles_sqrt(f_squared[i]);
        radius[i] = doubles_sqrt(balls.radius_squared);
        nearest[i] = doubles_min(distance[i] * (1.0 - 2.0 * CONE_MARGIN) - radius[i], doubles_splat(DBL_MAX));
        unsigned apart = planes_apart(f[i], along, distance[i] * beam->planes.along.spread + radius[i]) |
                         planes_apart(f[i], across, distance[i] * beam->planes.across.spread + radius[i]) |
                         doubles_ge(nearest[i], doubles_splat(beam->limit));
        touched |= (doubles_ge(balls.radius_squared, doubles_splat(0.0)) & ~apart) << at;
    }
#pragma GCC unroll 4
    for (int i = 0; touched && i < PARTS; i++) {
        int at = i * DOUBLES;
        vec3s_store(view->f, at, f[i]);
        doubles_store(&view->f_squared[at], f_squared[i]);
        doubles_store(&view->distance[at], distance[i]);
        doubles_store(&view->radius[at], radius[i]);
        doubles_store(&view->nearest[at], nearest[i]);
    }
    return touched;
}

// What a sphere is to all rays of the tile.
typedef struct TileSphere {
    SphereData ball;
    uint32_t slot;
    Vec3 f;
    double f_squared, distance, radius;
    double nearest; // no root is less
    double c, rounding, uncertainty;
} TileSphere;

// What sphere_test says of a row of rays, but for those that met the sphere so much nearer than what they met before that
// no root need be refined: they are done.
typedef struct RowHits {
    _Alignas(64) double t[TILE_ROW]; // approximate roots
    unsigned nearest;                // done
    unsigned other;                  // met about where something was met before, or uncertain
    unsigned uncertain;
} RowHits;

// The rows that a sphere touches before all their rays have met something.
static unsigned beam_rows(TileBeam *beam, const TileSphere *sphere)
{
    const Vec3s f = vec3s_splat(sphere->f);
    unsigned apart = 0;
    if (!beam->planes.has_rows) {
        tile_set_rows(&beam->planes, beam->tile);
    }
    for (int i = 0; i < ROWS; i += DOUBLES) {
        Vec3s normal = vec3s_load(beam->planes.row_normal, i);
        Doubles reach = sphere->distance * doubles_load(&beam->planes.row_spread[i]) + sphere->radius;
        apart |= (planes_apart(f, normal, reach) | doubles_ge(doubles_splat(sphere->nearest), doubles_load(&beam->row_limit[i])))
                 << i;
    }
    return ~apart & ((1u << ROWS) - 1);
}

static void row_test(const TileSphere *sphere, TileBeam *beam, unsigned begin, RowHits *row)
{
    const SphereTile *tile = beam->tile;
    const Vec3s f = vec3s_splat(sphere->f);
    const Doubles radius_squared = doubles_splat(sphere->ball.radius_squared), c = doubles_splat(sphere->c);
    row->nearest = row->other = row->uncertain = 0;
    for (unsigned i = 0; i < TILE_ROW; i += DOUBLES) {
        unsigned at = begin + i;
        SphereRays rays = sphere_tile_rays(tile, at);
        Doubles t_middle, discriminant = spheres_discriminant(&rays, f, radius_squared, &t_middle);
        Doubles before = doubles_load(&beam->hits->t[at]);
        Doubles last = before + SPHERE_ROOT_SLACK * before;
        // No root is nearer than this, with a margin far above what rounding does to it.
        Doubles earliest = t_middle - sphere->radius * (1.0 + 2.0 * CONE_MARGIN);
        unsigned possible =
            doubles_ge(discriminant, doubles_splat(sphere->rounding)) & doubles_ge(last, earliest);
        if (!possible) {
            continue;
        }
        Doubles root = spheres_root(t_middle, discriminant, c, rays.inverse_square);
        unsigned ahead = doubles_ge(t_middle, doubles_splat(0.0));
        possible &= sphere->c >= sphere->uncertainty ? ahead : ~0u;
        unsigned certain =
            fabs(sphere->c) >= sphere->uncertainty ? doubles_ge(discriminant, doubles_splat(sphere->uncertainty)) : 0;
        // 1 - slack is exact, so this is nearest_offer_sphere's t < before - slack, which fails where t is infinite.
        unsigned nearest = possible & certain & ~doubles_ge(root, before * (1.0 - SPHERE_ROOT_SLACK)) &
                           ~doubles_ge(doubles_splat(0.0), root);
        unsigned other = possible & ~nearest & (~certain | doubles_ge(last, root));
        DoublesMask *shape = (DoublesMask *)&beam->shape[at];
        doubles_store(&beam->hits->t[at], doubles_choose_bits(nearest, root, before));
        *shape = (DoublesMask)doubles_choose_bits(
            nearest, (Doubles)((DoublesMask){0} + shape_id(SHAPE_SPHERE, sphere->slot)), (Doubles)*shape);
        row->nearest |= nearest << i;
        if (RT_UNLIKELY(other)) {
            doubles_store(&row->t[i], root);
            row->other |= other << i;
            row->uncertain |= (other & ~certain) << i;
        }
    }
}

// A hit that may not be the nearest of its ray.
RT_SELDOM void beam_offer(TileBeam *beam, const TileSphere *sphere, unsigned i, double t, bool is_uncertain)
{
    TileHits *hits = beam->hits;
    uint64_t bit = UINT64_C(1) << i;
    SphereRay ray = sphere_tile_ray(beam->tile, i);
    ShapeId before = (ShapeId)beam->shape[i];
    Nearest nearest = {{hits->t[i], before, hits->inside & bit},
                       before == SHAPE_NONE ? 0 : beam->table->info[shape_index(before)].order,
                       beam->approximate & bit};
    SphereRoot root = {sphere->slot, sphere->ball, t, sphere->c < 0.0, !is_uncertain};
    if (RT_UNLIKELY(is_uncertain)) {
        root.t = sphere_exact(&ray, &sphere->ball, NULL, &root.inside);
    }
    nearest_offer_sphere(beam->table, &ray, &root, &nearest);
    tile_hit_set(hits, i, &nearest.hit);
    beam->shape[i] = nearest.hit.shape;
    beam->has_news = true;
    beam->approximate = (beam->approximate & ~bit) | (nearest.is_approximate ? bit : 0);
}

// Up to where a root may yet be the nearest of some ray of a row.
static double row_limit(const TileHits *hits, unsigned begin)
{
    Doubles last = doubles_load(&hits->t[begin]);
    for (unsigned i = DOUBLES; i < TILE_ROW; i += DOUBLES) {
        last = doubles_max(last, doubles_load(&hits->t[begin + i]));
    }
    return nearest_limit(doubles_greatest(last));
}

// One sphere against the rays of a row.
static void beam_row(TileBeam *beam, const TileSphere *sphere, unsigned begin)
{
    RowHits row;
    TileHits *hits = beam->hits;
    row_test(sphere, beam, begin, &row);
    if (!(row.nearest | row.other)) {
        return;
    }
    uint64_t nearest = (uint64_t)row.nearest << begin;
    hits->inside = sphere->c < 0.0 ? hits->inside | nearest : hits->inside & ~nearest;
    hits->met |= nearest;
    beam->approximate |= nearest;
    for (; RT_UNLIKELY(row.other); row.other &= row.other - 1) {
        unsigned i = (unsigned)__builtin_ctz(row.other);
        beam_offer(beam, sphere, begin + i, row.t[i], row.uncertain >> i & 1);
    }
    beam->row_limit[begin / TILE_ROW] = row_limit(hits, begin);
    beam->has_news = true;
}

// One sphere against the rays of the tile whose rows it touches.
static void beam_sphere(TileBeam *beam, uint32_t block, unsigned at, const BlockView *view)
{
    TileSphere sphere = {.slot = block * SPHERE_BLOCK + at};
    sphere.ball = sphere_table_ball(beam->table, sphere.slot);
    sphere.f = vec3(view->f[0][at], view->f[1][at], view->f[2][at]);
    sphere.f_squared = view->f_squared[at];
    sphere.distance = view->distance[at];
    sphere.radius = view->radius[at];
    sphere.nearest = view->nearest[at];
    unsigned rows = beam_rows(beam, &sphere);
    double sum = sphere.f_squared + sphere.ball.radius_squared;
    sphere.c = sphere.f_squared - sphere.ball.radius_squared;
    sphere.rounding = -SPHERE_ROUNDING * sum;
    sphere.uncertainty = SPHERE_UNCERTAINTY * sum;
    for (; rows; rows &= rows - 1) {
        beam_row(beam, &sphere, (unsigned)__builtin_ctz(rows) * TILE_ROW);
    }
}

// Up to where a root may yet be the nearest of some ray.
static double beam_limit(const TileBeam *beam)
{
    Doubles last = doubles_load(beam->row_limit);
    for (int i = DOUBLES; i < ROWS; i += DOUBLES) {
        last = doubles_max(last, doubles_load(&beam->row_limit[i]));
    }
    return doubles_greatest(last);
}

// True when hits came nearer.
static bool beam_block(TileBeam *beam, uint32_t block)
{
    BlockView view;
    if (!beam->planes.has_planes) {
        tile_set_planes(&beam->planes, beam->tile);
    }
    beam->has_news = false;
    unsigned touched = block_view(beam, &beam->table->blocks[block], &view);
    for (; touched; touched &= touched - 1) {
        beam_sphere(beam, block, (unsigned)__builtin_ctz(touched), &view);
    }
    beam->limit = beam->has_news ? beam_limit(beam) : beam->limit;
    return beam->has_news;
}

// One root that is right only in double words.
RT_SELDOM void beam_refine_exact(const TileBeam *beam, unsigned i)
{
    SphereRay ray = sphere_tile_ray(beam->tile, i);
    SphereData ball = sphere_table_ball(beam->table, shape_index((ShapeId)beam->shape[i]));
    bool inside;
    beam->hits->t[i] = sphere_exact(&ray, &ball, NULL, &inside);
}

// Makes the roots right that are approximate, a vector at a time.
static void beam_refine(const TileBeam *beam)
{
    const SphereTile *tile = beam->tile;
    for (unsigned at = 0; at < TILE_RAYS; at += DOUBLES) {
        unsigned approximate = (unsigned)(beam->approximate >> at) & ((1u << DOUBLES) - 1);
        if (!approximate) {
            continue;
        }
        const SphereRays rays = sphere_tile_rays(tile, at);
        DoublesMask shape = *(const DoublesMask *)&beam->shape[at], is_approximate = doubles_bits_mask(approximate);
        Balls balls =
            balls_gather(beam->table, (is_approximate & shape) | (~is_approximate & shape[__builtin_ctz(approximate)]));
        Doubles before = doubles_load(&beam->hits->t[at]), root = before;
        unsigned certain = spheres_step(&rays, &balls, &root);
        doubles_store(&beam->hits->t[at], doubles_choose(is_approximate, root, before));
        for (approximate &= ~certain; RT_UNLIKELY(approximate); approximate &= approximate - 1) {
            beam_refine_exact(beam, at + (unsigned)__builtin_ctz(approximate));
        }
    }
}

// What one walk meets, of directions in an octant.
static void beam_walk(TileBeam *beam, BvhWalk *walk)
{
    BvhChild leaf;
    walk->leaves = (const char *)beam->table->blocks;
    float limit = bvh_walk_limit(walk, beam->limit);
    const Abandon *abandon = beam->table->abandon; // 64 rays may meet 10^6 spheres each
    while (bvh_walk_next(walk, limit, &leaf) && !(abandon && trace_is_abandoned(abandon))) {
        if (beam_block(beam, leaf & ~BVH_LEAF)) {
            limit = bvh_walk_limit(walk, beam->limit);
        }
    }
}

// The spheres of the tree: a walk for each octant into which there are rays, mostly one. False when the tile cannot
// walk it.
static bool beam_tree(TileBeam *beam)
{
    DirectionRange range;
    direction_range(beam->tile->direction, TILE_RAYS, &range);
    if (!direction_range_is_narrow(&range)) {
        return false;
    }
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
    TileBeam beam; // not cleared as a whole
    beam.table = table;
    beam.tile = tile;
    beam.hits = hits;
    beam.approximate = 0;
    beam.limit = (double)INFINITY;
    beam.planes.has_planes = beam.planes.has_rows = beam.has_news = false;
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        hits->t[i] = (double)INFINITY;
        beam.shape[i] = SHAPE_NONE;
    }
    for (unsigned row = 0; row < ROWS; row++) {
        beam.row_limit[row] = (double)INFINITY;
    }
    hits->met = hits->inside = 0;
    if (table->loose_count > 0) {
        beam_block(&beam, 0);
    }
    if (table->bvh.nodes && !beam_tree(&beam)) {
        return false;
    }
    beam_refine(&beam);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        hits->shape[i] = (ShapeId)beam.shape[i];
    }
    return true;
}

#endif
