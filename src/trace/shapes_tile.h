// A tile of camera rays against primitives that stand alone and composites: part of spheres_kernel.c.
//
// The tile walks the tree once, as a beam. Solids whose kind has a test in lanes are asked a vector of rays at a time,
// and what is not decided with a margin is decided ray by ray, so hits are those of single rays. First a ball is asked
// which rays may meet it: seen from their one origin it is a cone, with a margin far above rounding, so that none is
// left out; other primitives are asked which rows of rays they touch. All other shapes are gathered, and walked by each
// ray.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_TILE_H
#define TRACE_SHAPES_TILE_H

#include "trace/cone_test.h"
#include "trace/mesh_lanes.h"
#include "trace/shapes_walk.h"
#include "trace/primitive_lanes_surface.h"
#include "trace/tile_planes.h"

enum { SOLID_NONE = UINT32_MAX };

// A tile on its way.
typedef struct ShapesTile {
    const ShapeTable *table;
    const SphereTile *tile;
    TileForemost *first;
    TileHits *hits;                // the same's
    uint64_t bounded, approximate; // the rays of whose first hit's span only a bound is known; whose root is a ball's
                                   // and approximate
    uint64_t walking;              // the rays that the tree is walked for, or all
    double far;                    // of the rays' origin from 0
    double limit;                  // up to where something may yet be the first of some ray
    _Alignas(64) double enter[TILE_RAYS];  // bounded_enter of a ShapeQuery
    _Alignas(64) int64_t shape[TILE_RAYS]; // of the hits, as wide as their roots
    TilePlanes planes;
    ShapeBeam others; // what has no test in lanes
} ShapesTile;

// A line with the direction d from the origin of a tile meets a ball only if d·Q d >= -margin, for the ball's quadric
// as seen from there. With f the origin in the ball's space, M the map to that, c = |f|² - 1 and f, M d as they are
// rounded, sphere_test misses where (f·M d)² - c |M d|² < -2 SPHERE_ROUNDING (|f|² + 1) |M d|². Taking M into Q and
// adding up costs less than 64 u (|f|² + 1) |M|² |d|² more, |M|² being the sum of the squares of its entries.
typedef struct BallView {
    double xx, xy, xz, yy, yz, zz, margin;
} BallView;

static void ball_view(const PreparedPrimitive *ball, Vec3 f, BallView *view)
{
    const double(*m)[3] = ball->to_object.m;
    Vec3 x = vec3(m[0][0], m[0][1], m[0][2]), y = vec3(m[1][0], m[1][1], m[1][2]), z = vec3(m[2][0], m[2][1], m[2][2]);
    double f_squared = vec3_length_squared(f), c = f_squared - 1.0;
    double fx = vec3_dot(f, x), fy = vec3_dot(f, y), fz = vec3_dot(f, z);
    double size = vec3_length_squared(x) + vec3_length_squared(y) + vec3_length_squared(z);
    *view = (BallView){
        .xx = fx * fx - c * vec3_length_squared(x),
        .xy = 2.0 * (fx * fy - c * vec3_dot(x, y)),
        .xz = 2.0 * (fx * fz - c * vec3_dot(x, z)),
        .yy = fy * fy - c * vec3_length_squared(y),
        .yz = 2.0 * (fy * fz - c * vec3_dot(y, z)),
        .zz = fz * fz - c * vec3_length_squared(z),
        .margin = 0x1p-40 * (f_squared + 1.0) * size,
    };
}

// The rays that may meet it, a bit for each.
static uint64_t ball_view_rays(const BallView *view, const SphereTile *tile)
{
    uint64_t missed = 0;
    if (!(view->margin > 0x1p-900 && view->margin < 0x1p900)) {
        return ~missed; // something over- or underflowed
    }
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        Doubles x = doubles_load(&tile->direction[0][i]);
        Doubles y = doubles_load(&tile->direction[1][i]);
        Doubles z = doubles_load(&tile->direction[2][i]);
        Doubles form =
            x * (view->xx * x + view->xy * y + view->xz * z) + y * (view->yy * y + view->yz * z) + view->zz * z * z;
        missed |= (uint64_t)doubles_ge(doubles_splat(-view->margin), form) << i;
    }
    return ~missed;
}

static void lane_bits_set(uint64_t *all, unsigned at, unsigned bits, unsigned values)
{
    *all = (*all & ~((uint64_t)bits << at)) | (uint64_t)(bits & values) << at;
}

// A ray of the tile and the first that it has met, taken out of it and put back.
static void tile_ray_take(ShapesTile *of, unsigned i, Ray *ray, ShapeQuery *q, Foremost *first)
{
    ShapeId met = (ShapeId)of->shape[i];
    const TileForemost *all = of->first;
    const PreparedPrimitive *part =
        met != SHAPE_NONE && shape_is_on_primitive(met) ? table_primitive(of->table, met) : NULL;
    *ray = (Ray){of->tile->origin, lane_get(of->tile->direction, i)};
    query_start(q, of->table, ray, RAY_START_CAMERA, 0.0, false);
    q->bounded = of->bounded >> i & 1 ? part : NULL;
    q->bounded_enter = of->enter[i];
    if (of->approximate >> i & 1) {
        of->hits->t[i] = ball_refine(part, ray, of->hits->t[i]);
        lane_bits_set(&of->approximate, i, 1, 0);
    }
    *first = (Foremost){.hit = {of->hits->t[i], met, of->hits->inside >> i & 1},
                        .order = part ? part->order : all->order[i],
                        .is_torn = all->torn >> i & 1,
                        .from = all->from[i],
                        .limit = all->limit[i],
                        .beaten = all->beaten[i],
                        .end = way_end((double)INFINITY)};
}

static void tile_ray_put(ShapesTile *of, unsigned i, const ShapeQuery *q, const Foremost *first)
{
    TileHits *hits = of->hits;
    lane_bits_set(&of->bounded, i, 1, q->bounded != NULL);
    lane_bits_set(&hits->met, i, 1, first->hit.shape != SHAPE_NONE);
    lane_bits_set(&hits->inside, i, 1, first->hit.inside);
    lane_bits_set(&of->first->torn, i, 1, first->is_torn);
    hits->t[i] = first->hit.t;
    of->shape[i] = first->hit.shape;
    of->enter[i] = q->bounded ? q->bounded_enter : 0.0;
    of->first->from[i] = first->from;
    of->first->limit[i] = first->limit;
    of->first->beaten[i] = first->beaten;
}

// Brings the hit of a ray up to date with a primitive, in its box, or with all items that have no test in lanes.
static void tile_ray(ShapesTile *of, unsigned i, uint32_t index, const ItemBox *box, const ShapeBeam *beam)
{
    Ray ray;
    ShapeQuery q;
    Foremost first;
    tile_ray_take(of, i, &ray, &q, &first);
    if (index != SOLID_NONE) {
        q.box = box;
        primitive_closest(&q, index, &first);
    } else {
        table_closest(&q, beam, &first);
    }
    tile_ray_put(of, i, &q, &first);
}

// A solid as seen from the tile's origin.
typedef struct TilePrimitive {
    LanePrimitive solid;
    const ItemBox *box;
    Vec3s f; // the origin in its space
} TilePrimitive;

// Makes some rays' roots the first ones.
RT_ALWAYS_INLINE void tile_take_lanes(ShapesTile *of, const PreparedPrimitive *primitive, PrimitiveKind kind,
                                      unsigned at, unsigned nearest, const PrimitiveLanes *lanes)
{
    DoublesMask *shape = (DoublesMask *)&of->shape[at];
    bool is_mesh = primitive_is_mesh(primitive); // `side` is all of the shape then
    ShapeId own = is_mesh ? 0 : primitive_shape((uint32_t)(primitive - of->table->primitives), 0);
    DoublesMask met = ((DoublesMask){0} + own) | lanes->side;
    bool flips = primitive->flips && (is_mesh || !primitive_is_flat(primitive));
    doubles_store(&of->hits->t[at], doubles_choose_bits(nearest, lanes->root, doubles_load(&of->hits->t[at])));
    *shape = (DoublesMask)doubles_choose_bits(nearest, (Doubles)met, (Doubles)*shape);
    lane_bits_set(&of->hits->met, at, nearest, ~0u);
    lane_bits_set(&of->bounded, at, nearest, ~0u);
    lane_bits_set(&of->approximate, at, nearest, kind == PRIMITIVE_SPHERE ? ~0u : 0);
    lane_bits_set(&of->first->torn, at, nearest, 0);
    lane_bits_set(&of->hits->inside, at, nearest, flips ? ~lanes->leaves : lanes->leaves);
}

// Brings the hits of a vector of rays up to date with what they meet of a primitive. What is nearest, or is not, with a
// margin is done at once.
RT_ALWAYS_INLINE void tile_lanes_offer(ShapesTile *of, const TilePrimitive *own, PrimitiveKind kind, unsigned at,
                                       const PrimitiveLanes *lanes)
{
    const PreparedPrimitive *primitive = own->solid.solid;
    Vec3s world = vec3s_load(of->tile->direction, at);
    TileForemost *all = of->first;
    Doubles from = doubles_load(&all->from[at]);
    Doubles limit = doubles_load(&all->limit[at]), beaten = doubles_load(&all->beaten[at]);
    unsigned nearest = 0;
    unsigned other = lanes->possible & ~(lanes->certain & doubles_gt(lanes->root - lanes->bound, limit));
    if (other & lanes->certain) {
        Vec3s origin = vec3s_splat(of->tile->origin);
        Doubles enter, to = lanes->root + lanes->bound, begin = lanes->root - lanes->bound;
        nearest = other & lanes->certain & box_lanes_enter(&of->table->tree, own->box, origin, world, &enter);
        to = doubles_choose(to < enter, enter, to);
        begin = doubles_choose(begin < enter, enter, begin);
        nearest &= doubles_gt(from, to) & doubles_gt(beaten, to) & doubles_gt(limit, to);
        doubles_store(&all->from[at], doubles_choose_bits(nearest, begin, from));
        doubles_store(&all->limit[at], doubles_choose_bits(nearest, to, limit));
        doubles_store(&of->enter[at], doubles_choose_bits(nearest, enter, doubles_load(&of->enter[at])));
    }
    if (nearest) {
        tile_take_lanes(of, primitive, kind, at, nearest, lanes);
    }
    for (other &= ~nearest; RT_UNLIKELY(other); other &= other - 1) {
        tile_ray(of, at + (unsigned)__builtin_ctz(other), (uint32_t)(primitive - of->table->primitives), own->box,
                 NULL);
    }
}

// A vector of rays against a primitive: what primitive_closest does to each.
RT_ALWAYS_INLINE void tile_primitive_lanes(ShapesTile *of, const TilePrimitive *own, PrimitiveKind kind, unsigned at,
                                           unsigned asked)
{
    PrimitiveLanes lanes;
    Vec3s world = vec3s_load(of->tile->direction, at);
    RayLanes rays = {own->f, linears_direction(&own->solid.to_object, world), world};
    if (primitive_lanes(&own->solid, kind, &rays, asked, &lanes)) {
        tile_lanes_offer(of, own, kind, at, &lanes);
    }
}

// What a vector of rays meets of a mesh, and from which side.
static void tile_mesh_met(const ShapesTile *of, const PreparedPrimitive *primitive, const MeshLanes *mesh, unsigned at,
                          PrimitiveLanes *lanes)
{
    lanes->leaves = 0;
    for (unsigned rest = lanes->possible & lanes->certain; rest; rest &= rest - 1) {
        unsigned i = (unsigned)__builtin_ctz(rest);
        uint32_t face = (uint32_t)mesh->face[i];
        Ray ray = {of->tile->origin, lane_get(of->tile->direction, at + i)}, object = primitive_ray(primitive, &ray);
        lanes->side[i] = shape_id(SHAPE_FACE, primitive->mesh.first_face + face);
        lanes->leaves |= (unsigned)mesh_is_left(primitive, &ray, &object, face) << i;
    }
}

// A vector of rays against a mesh, in whose space they begin at `origin`. False when they had better go one by one.
static __attribute__((noinline)) bool tile_mesh_lanes(ShapesTile *of, const TilePrimitive *own, Vec3 origin,
                                                      unsigned at, unsigned asked)
{
    const PreparedPrimitive *primitive = own->solid.solid;
    MeshLanes mesh;
    BvhWalk walk;
    bool is_apart = true, is_walked = false;
    PrimitiveLanes lanes = {asked, 0, 0, {0}, {0}, {0}};
    DoublesMask is_asked = doubles_bits_mask(asked);
    Vec3 one = lane_get(of->tile->direction, at + (unsigned)__builtin_ctz(asked));
    Vec3s world = vec3s_choose(is_asked, vec3s_load(of->tile->direction, at), vec3s_splat(one));
    mesh.is_any = false;
    if (mesh_lanes_set(&mesh, primitive->mesh.table, own->f, linears_direction(&own->solid.to_object, world))) {
        is_walked = mesh_lanes_start(&mesh, origin, 0.0, &walk, &is_apart);
    }
    if (is_walked) {
        Doubles limit = doubles_load(&of->first->limit[at]) * mesh.length * MESH_BEYOND;
        mesh.nearest = doubles_choose(is_asked, limit, doubles_splat(-1.0));
        is_apart = !mesh_lanes_walk(&mesh, &walk, doubles_greatest(mesh.nearest));
    }
    if (!is_apart) {
        lanes.certain = ~doubles_mask_bits(mesh.unsure);
        lanes.possible &= doubles_mask_bits((mesh.face != (int64_t)MESH_NO_FACE) | mesh.unsure);
        lanes.root = mesh.t / mesh.length;
        lanes.bound = MESH_ERROR_MOST * lanes.root;
        tile_mesh_met(of, primitive, &mesh, at, &lanes);
    }
    if (lanes.possible) {
        tile_lanes_offer(of, own, PRIMITIVE_MESH, at, &lanes);
    }
    return !is_apart;
}

// The rays for which something may yet be the first that is no nearer than that.
static uint64_t tile_open_rays(const TileForemost *first, double nearest)
{
    uint64_t open = 0;
    for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
        open |= (uint64_t)doubles_ge(doubles_load(&first->limit[i]), doubles_splat(nearest)) << i;
    }
    return open;
}

// `may` are the rays that are asked.
RT_ALWAYS_INLINE void tile_primitive_kind(ShapesTile *of, const PreparedPrimitive *primitive, PrimitiveKind kind,
                                          const ItemBox *box, uint64_t may)
{
    Vec3 offset = vec3_sub(of->tile->origin, primitive->centre), f = linear_direction(&primitive->to_object, offset);
    if (kind == PRIMITIVE_SPHERE) {
        BallView view;
        ball_view(primitive, f, &view);
        may &= ball_view_rays(&view, of->tile);
    } else {
        may &= rows_rays(primitive_rows(&of->planes, of->tile, primitive, kind, vec3_neg(offset)));
    }
    if (!may) {
        return;
    }
    TilePrimitive own = {.box = box, .f = vec3s_splat(f)};
    lane_primitive_set(&own.solid, primitive, of->far);
    for (unsigned at = 0; at < TILE_RAYS; at += DOUBLES) {
        unsigned asked = may >> at & ((1u << DOUBLES) - 1);
        if (asked) {
            tile_primitive_lanes(of, &own, kind, at, asked);
        }
    }
}

static void tile_mesh(ShapesTile *of, const PreparedPrimitive *primitive, const ItemBox *box, uint64_t may)
{
    Vec3 origin = linear_direction(&primitive->to_object, vec3_sub(of->tile->origin, primitive->centre));
    TilePrimitive own = {.box = box, .f = vec3s_splat(origin)};
    lane_primitive_set(&own.solid, primitive, of->far);
    bool go_together = true;
    for (unsigned at = 0; at < TILE_RAYS && go_together; at += DOUBLES) {
        unsigned asked = may >> at & LANES_ALL;
        go_together = !asked || tile_mesh_lanes(of, &own, origin, at, asked);
        may &= ~((uint64_t)LANES_ALL << at);
    }
    for (; may; may &= may - 1) {
        tile_ray(of, (unsigned)__builtin_ctzll(may), (uint32_t)(primitive - of->table->primitives), box, NULL);
    }
}

// A quadric is asked by the rays that may meet it.
static void tile_quadric(ShapesTile *of, const PreparedPrimitive *primitive, const ItemBox *box, uint64_t may)
{
    Vec3 own = linear_direction(&primitive->to_object, vec3_sub(of->tile->origin, primitive->centre));
    Linears to_object = linears_splat(&primitive->to_object);
    for (unsigned at = 0; at < TILE_RAYS; at += DOUBLES) {
        Vec3s d = linears_direction(&to_object, vec3s_load(of->tile->direction, at));
        unsigned asked = may >> at & quadric_lanes_possible(primitive, vec3s_splat(own), d) & ((1u << DOUBLES) - 1);
        for (; asked; asked &= asked - 1) {
            tile_ray(of, at + (unsigned)__builtin_ctz(asked), (uint32_t)(primitive - of->table->primitives), box, NULL);
        }
    }
}

// No ray meets the box, if there is one, before `nearest`.
static void tile_primitive(ShapesTile *of, const PreparedPrimitive *primitive, const ItemBox *box, double nearest)
{
    uint64_t may = tile_open_rays(of->first, nearest) & of->walking;
    if ((primitive->hidden & HIDDEN_CAMERA) || !may) {
        return;
    }
    if (primitive_is_quadric(primitive)) {
        tile_quadric(of, primitive, box, may);
        return;
    }
    if (primitive_is_mesh(primitive)) {
        tile_mesh(of, primitive, box, may);
        return;
    }
    switch (primitive->kind) {
    case PRIMITIVE_SPHERE:
        tile_primitive_kind(of, primitive, PRIMITIVE_SPHERE, box, may);
        break;
    case PRIMITIVE_BOX:
        tile_primitive_kind(of, primitive, PRIMITIVE_BOX, box, may);
        break;
    case PRIMITIVE_CONE:
        tile_primitive_kind(of, primitive, PRIMITIVE_CONE, box, may);
        break;
    case PRIMITIVE_DISC:
        tile_primitive_kind(of, primitive, PRIMITIVE_DISC, box, may);
        break;
    case PRIMITIVE_TRIANGLE:
        tile_primitive_kind(of, primitive, PRIMITIVE_TRIANGLE, box, may);
        break;
    case PRIMITIVE_TORUS:
        tile_primitive_kind(of, primitive, PRIMITIVE_TORUS, box, may);
        break;
    case PRIMITIVE_POLYNOMIAL:
        tile_primitive_kind(of, primitive, PRIMITIVE_POLYNOMIAL, box, may);
        break;
    case PRIMITIVE_BLOB:
        tile_primitive_kind(of, primitive, PRIMITIVE_BLOB, box, may);
        break;
    case PRIMITIVE_PRISM:
        tile_primitive_kind(of, primitive, PRIMITIVE_PRISM, box, may);
        break;
    default:
        tile_primitive_kind(of, primitive, PRIMITIVE_SMOOTH_TRIANGLE, box, may);
    }
}

// Up to where something may yet be the first of some ray.
static double tile_limit(const TileForemost *first)
{
    Doubles last = doubles_load(first->limit);
    for (unsigned i = DOUBLES; i < TILE_RAYS; i += DOUBLES) {
        last = doubles_max(doubles_load(&first->limit[i]), last);
    }
    return doubles_greatest(last);
}

static bool beam_add(ShapeBeam *beam, const BvhNode *from, unsigned child)
{
    unsigned at = beam->count % BVH_WIDTH;
    if (at == 0) {
        if (beam->node_count == SHAPE_BEAM_NODES) {
            return false;
        }
        bvh_node_clear(&beam->nodes[beam->node_count++]);
    }
    BvhNode *node = &beam->nodes[beam->node_count - 1];
    for (int axis = 0; axis < 3; axis++) {
        node->box[axis][0][at] = from->box[axis][0][child];
        node->box[axis][1][at] = from->box[axis][1][child];
    }
    node->child[at] = from->child[child];
    node->present |= 1u << at;
    beam->count++;
    return true;
}

// Fetches a primitive, which has to wait, into the cache.
RT_ALWAYS_INLINE void tile_expect(const ShapesTile *of, bool is_solid, ShapeItem item)
{
    const char *from = (const char *)&of->table->primitives[item_index(item)];
    if (is_solid) {
#pragma GCC unroll 8
        for (size_t line = 0; line < sizeof(PreparedPrimitive); line += 64) {
            __builtin_prefetch(from + line);
        }
    }
}

// One walk, near things first: asks the primitives that have lanes, and gathers what else there is. False when that is
// too much.
static bool tile_walk(ShapesTile *of, BvhWalk *walk)
{
    const ShapeItem *items = of->table->items + of->table->unbounded_count;
    while (walk->waiting > 0) {
        float limit = bvh_walk_limit(walk, of->limit);
        uint64_t key = walk->stack[--walk->waiting];
        BvhChild child = (BvhChild)key;
        if (key > bvh_walk_key(limit, UINT32_MAX)) {
            continue;
        }
        if (child & BVH_LEAF) {
            uint32_t at = bvh_leaf_first(child);
            double nearest = bvh_walk_parameter(walk, key);
            tile_primitive(of, &of->table->primitives[item_index(items[at])], &of->table->boxes[at], nearest);
            of->limit = !~of->hits->met ? tile_limit(of->first) : of->limit;
            continue;
        }
        const BvhNode *node = &walk->nodes[child];
        _Alignas(64) float enters[BVH_WIDTH];
        unsigned bottom = walk->waiting;
        for (unsigned met = bvh_walk_boxes(walk, node, limit, enters); met; met &= met - 1) {
            unsigned i = (unsigned)__builtin_ctz(met);
            bool is_leaf = node->child[i] & BVH_LEAF;
            ShapeItem item = is_leaf ? items[bvh_leaf_first(node->child[i])] : 0;
            if (!is_leaf || (item & ITEM_LANES)) {
                tile_expect(of, is_leaf, item);
                bvh_walk_push(walk, bottom, bvh_walk_key(enters[i], node->child[i]));
            } else if (!beam_add(&of->others, node, i)) {
                return false;
            }
        }
    }
    return true;
}

// The rays of an octant; what has no sign is in both.
static uint64_t tile_octant_rays(const SphereTile *tile, unsigned octant)
{
    const Doubles zero = doubles_splat(0.0);
    uint64_t other = 0;
    for (int axis = 0; axis < 3; axis++) {
        for (unsigned i = 0; i < TILE_RAYS; i += DOUBLES) {
            Doubles d = doubles_load(&tile->direction[axis][i]);
            other |= (uint64_t)(octant >> axis & 1 ? doubles_gt(d, zero) : doubles_gt(zero, d)) << i;
        }
    }
    return ~other;
}

// A walk for each octant into which there are rays. False when the tile cannot walk the tree, or had better not.
static bool tile_tree(ShapesTile *of)
{
    DirectionRange range;
    of->others.count = of->others.node_count = 0;
    if (of->table->tree.node_count == 0) {
        return of->table->bounded_count == 0;
    }
    direction_range(of->tile->direction, TILE_RAYS, &range);
    for (unsigned octant = 0; octant < OCTANTS && direction_range_is_narrow(&range); octant++) {
        BvhWalk walk;
        Vec3 least, greatest;
        bool is_too_far;
        if (!direction_octant(&range, octant, &least, &greatest)) {
            continue;
        }
        of->walking = tile_octant_rays(of->tile, octant);
        if (bvh_walk_start_beam(&walk, &of->table->tree, of->tile->origin, 0.0, least, greatest, &is_too_far)
                ? !tile_walk(of, &walk)
                : is_too_far) {
            return false;
        }
    }
    return direction_range_is_narrow(&range);
}

// Refines what is approximate, a vector at a time.
static void tile_refine_roots(ShapesTile *of)
{
    const PreparedPrimitive *primitives = of->table->primitives;
    Vec3 eye = of->tile->origin;
    for (unsigned at = 0; at < TILE_RAYS; at += DOUBLES) {
        unsigned approximate = of->approximate >> at & ((1u << DOUBLES) - 1);
        if (!approximate) {
            continue;
        }
        Doubles before = doubles_load(&of->hits->t[at]), root = before;
        DoublesMask shape = *(const DoublesMask *)&of->shape[at], is_approximate = doubles_bits_mask(approximate);
        shape = (is_approximate & shape) | (~is_approximate & shape[__builtin_ctz(approximate)]);
        unsigned certain =
            balls_refine(primitives, parts_index(shape), vec3s_splat(eye), vec3s_load(of->tile->direction, at), &root);
        doubles_store(&of->hits->t[at], doubles_choose(is_approximate, root, before));
        for (approximate &= ~certain; RT_UNLIKELY(approximate); approximate &= approximate - 1) {
            unsigned i = (unsigned)__builtin_ctz(approximate);
            Ray ray = {eye, lane_get(of->tile->direction, at + i)};
            of->hits->t[at + i] =
                ball_refine(&primitives[primitive_index((ShapeId)of->shape[at + i])], &ray, before[i]);
        }
    }
}

// Asks the items without a box that have a test in lanes. Whether there are others.
static bool tile_unbounded(ShapesTile *of)
{
    bool are_all = true;
    of->walking = ~UINT64_C(0);
    for (uint32_t i = 0; i < of->table->unbounded_count; i++) {
        ShapeItem item = of->table->items[i];
        if (item & ITEM_LANES) {
            tile_primitive(of, &of->table->primitives[item_index(item)], NULL, 0.0);
        } else {
            are_all = false;
        }
    }
    return !are_all;
}

static void shapes_closest_tile(const ShapeTable *table, const SphereTile *tile, TileForemost *first)
{
    ShapesTile of; // not cleared as a whole
    of.table = table;
    of.tile = tile;
    of.first = first;
    of.hits = first->hits;
    of.bounded = of.approximate = 0;
    of.planes.has_planes = of.planes.has_rows = false;
    of.far = vec3_length(tile->origin);
    of.limit = ~of.hits->met ? (double)INFINITY : tile_limit(first);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        of.shape[i] = of.hits->shape[i];
        of.enter[i] = 0.0;
    }
    bool is_walked = tile_tree(&of);
    bool are_left = !is_walked || tile_unbounded(&of) || of.others.count > 0;
    for (unsigned i = 0; i < TILE_RAYS && are_left; i++) {
        tile_ray(&of, i, SOLID_NONE, NULL, is_walked ? &of.others : NULL);
    }
    tile_refine_roots(&of);
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        of.hits->shape[i] = (ShapeId)of.shape[i];
    }
}

#endif
