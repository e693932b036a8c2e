// Rays that all end at or about one point against parts that stand alone and composites: part of spheres_kernel.c.
//
// They walk the tree together, as in spheres_group.h. A ball is tested against a vector of them at a time; what is not
// decided with a margin, and all other shapes, are asked ray by ray, so the answers are those of single rays.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_GROUP_H
#define TRACE_SHAPES_GROUP_H

#include "trace/ball_lanes.h"
#include "trace/shapes_walk.h"
#include "trace/spheres_group.h"

enum { GROUP_ITEMS = 8 }; // for each ray

typedef struct ShapeGroup {
    const ShapeTable *table;
    RayStart start; // of all of them, outward
    const Solid *left;
    double far; // of any origin from 0
    double start_error[TILE_RAYS]; // as in ShapeQuery
    _Alignas(64) double passed[TILE_RAYS]; // of balls, at most: see passed_error; -INFINITY: nothing
} ShapeGroup;

// How much of balls the rays have passed where they start, at most.
static void group_set_passed(ShapeGroup *from, const RayGroup *group)
{
    bool is_on_ball = from->left && from->left->kind == PART_SPHERE;
    bool is_round = is_on_ball || (!from->left && shape_kind(from->start.shape) == SHAPE_SPHERE);
    from->far = vec3_length(group->end) + group->farthest;
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        doubles_store(&from->passed[at], doubles_splat(is_round ? 0.0 : -(double)INFINITY));
    }
    if (is_on_ball) {
        LaneBall left;
        lane_ball_set(&left, from->left, from->far);
        for (unsigned at = 0; at < group->whole; at += DOUBLES) {
            Doubles f[3], d[3];
            lane_ball_ray(&left, group->origin, group->direction, at, f, d);
            doubles_store(&from->passed[at], left.slack.fixed / doubles_abs(lanes_dot(f, d)));
        }
    }
}

// What one vector of rays meets of a ball: what is before a ray's end, or is not, with a margin.
typedef struct BallMet {
    unsigned met, open;
} BallMet;

RT_ALWAYS_INLINE BallMet group_ball_lanes(const ShapeGroup *from, const RayGroup *group, const LaneBall *ball,
                                          const ItemBox *box, unsigned at, unsigned asked)
{
    BallLanes lanes;
    Doubles f[3], d[3];
    lane_ball_ray(ball, group->origin, group->direction, at, f, d);
    if (!ball_lanes_test(f, d, &ball->slack, asked, &lanes)) {
        return (BallMet){0, 0};
    }
    // The ends have a margin that is greater than way_end's.
    Doubles end = doubles_load(&group->distance[at]), passed = doubles_load(&from->passed[at]);
    unsigned behind = doubles_gt(lanes.root - lanes.bound, end * (1.0 + 0x1p-40));
    unsigned before = doubles_gt(end * (1.0 - 0x1p-40), lanes.root + lanes.bound);
    unsigned met = lanes.possible & lanes.certain & before & doubles_gt(lanes.root, lanes.bound + passed);
    if (met) {
        Doubles origin[3], direction[3], enter;
        lanes_load(group->origin, at, origin);
        lanes_load(group->direction, at, direction);
        met &= box_lanes_enter(&from->table->tree, box, origin, direction, &enter);
        met &= doubles_gt(end * (1.0 - 0x1p-40), enter);
    }
    return (BallMet){met, lanes.possible & ~met & ~(lanes.certain & behind)};
}

// Whether an item, whose box may be NULL, is before the end of a ray.
static bool group_ray_meets(const ShapeGroup *from, const RayGroup *group, unsigned i, ShapeItem item,
                            const ItemBox *box)
{
    Ray ray = {lane_get(group->origin, i), lane_get(group->direction, i)};
    double end = group->distance[i];
    ShapeQuery q;
    query_start(&q, from->table, &ray, from->start, from->start_error[i], true);
    q.box = box;
    Foremost first = foremost_start(&(Hit){end, SHAPE_NONE, false}, 0, end);
    item_closest(&q, item, &first);
    return first.hit.shape != SHAPE_NONE;
}

// The rays that a ball is in the way of, with those that are `occluded`; sets those that `may` be, to be asked one by
// one.
static uint64_t group_ball(const ShapeGroup *from, const RayGroup *group, const Solid *solid, const ItemBox *box,
                           uint64_t occluded, uint64_t *may)
{
    LaneBall ball;
    *may = 0;
    if ((solid->hidden & from->start.use) || (solid == from->left && !solid->flips)) {
        return occluded;
    }
    lane_ball_set(&ball, solid, from->far);
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        unsigned asked = ~occluded >> at & ((1u << DOUBLES) - 1);
        if (asked) {
            BallMet own = group_ball_lanes(from, group, &ball, box, at, asked);
            occluded |= (uint64_t)own.met << at;
            *may |= (uint64_t)own.open << at;
        }
    }
    return occluded;
}

// What is in a leaf; see GroupLeaf.
static uint64_t group_item(const void *context, const RayGroup *group, const RayCone *cone, uint32_t leaf,
                           uint64_t occluded)
{
    const ShapeGroup *from = context;
    const ShapeTable *table = from->table;
    uint32_t at = bvh_leaf_first(leaf);
    ShapeItem item = table->items[table->unbounded_count + at];
    uint64_t may = ~occluded;
    (void)cone;
    if (item & ITEM_SPHERE) {
        occluded = group_ball(from, group, &table->solids[item_index(item)], &table->boxes[at], occluded, &may);
    }
    for (; may; may &= may - 1) {
        unsigned i = (unsigned)__builtin_ctzll(may);
        occluded |= (uint64_t)group_ray_meets(from, group, i, item, &table->boxes[at]) << i;
    }
    return occluded;
}

// Those of the group that something is before; false when they cannot be traced together.
static bool shape_group_occluded(ShapeGroup *from, const RayGroup *group, uint64_t *occluded)
{
    const ShapeTable *table = from->table;
    const GroupTree tree = {&table->tree, NULL, group_item, from, GROUP_ITEMS};
    uint64_t none = group_none(group);
    group_set_passed(from, group);
    *occluded = none;
    for (uint32_t item = 0; item < table->unbounded_count; item++) {
        for (uint64_t open = ~*occluded; open; open &= open - 1) {
            unsigned i = (unsigned)__builtin_ctzll(open);
            *occluded |= (uint64_t)group_ray_meets(from, group, i, table->items[item], NULL) << i;
        }
    }
    if (table->bounded_count > 0 && ~*occluded && !group_tree(&tree, group, NULL, occluded)) {
        return false;
    }
    *occluded &= ~none;
    return true;
}

static uint64_t shapes_occluded_surfaces(const ShapeTable *table, const TileSurfaces *from, const SurfaceRays *rays,
                                         const double start_error[TILE_RAYS], uint64_t asked, uint64_t *left)
{
    RayGroup group;
    ShapeGroup own;
    uint64_t all = 0;
    own.table = table;
    *left = asked & surfaces_inward(from, rays);
    for (uint64_t rest = asked & ~*left; rest;) {
        ShapeId shape = from->shape[__builtin_ctzll(rest)];
        uint64_t members = rest & surfaces_alike(from, shape), occluded;
        unsigned count = 0;
        rest &= ~members;
        own.start = (RayStart){shape, false, HIDDEN_SHADOW};
        own.left = starts_on_part(own.start) ? table_solid(table, shape) : NULL;
        for (uint64_t each = members; each; each &= each - 1) {
            own.start_error[count++] = start_error[__builtin_ctzll(each)];
        }
        if (count < GROUP_LEAST || !group_gather(from, rays, members, &group) ||
            !shape_group_occluded(&own, &group, &occluded)) {
            *left |= members;
        } else {
            all |= group_spread(occluded, members);
        }
    }
    return all;
}

#endif
