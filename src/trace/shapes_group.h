// Rays that all end at or about one point against primitives that stand alone and composites: part of spheres_kernel.c.
//
// They walk the tree together, as in spheres_group.h. Solids whose kind has a test in lanes are tested against a vector
// of them at a time; what is not decided with a margin, and all other shapes, are asked ray by ray, so the answers are
// those of single rays.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_GROUP_H
#define TRACE_SHAPES_GROUP_H

#include "trace/mesh_lanes.h"
#include "trace/shapes_walk.h"
#include "trace/primitive_lanes.h"
#include "trace/spheres_group.h"

enum { GROUP_ITEMS = 8 }; // for each ray

typedef struct ShapeGroup {
    const ShapeTable *table;
    RayStart start; // of all of them, outward; of faces of a mesh that of the first
    const PreparedPrimitive *left;
    ShapeId shape[TILE_RAYS]; // that they start on
    uint64_t inward;          // of faces: those that do not go outward
    double far;                    // of any origin from 0
    double start_error[TILE_RAYS]; // as in ShapeQuery
    // Of balls, straight primitives and curves, at most: see passed_error; -INFINITY: nothing.
    _Alignas(64) double passed_round[TILE_RAYS];
    double passed_straight[TILE_RAYS];
    double passed_curve[TILE_RAYS];
} ShapeGroup;

// Whether start_along knows it.
static bool start_has_along(const PreparedPrimitive *left, uint8_t side)
{
    return kind_has_surface_lanes((PrimitiveKind)left->kind) || prepared_classes[left->kind].across[side] > 0;
}

// n·d where some rays start on a primitive's side, n being the gradient there.
RT_ALWAYS_INLINE Doubles start_along(const PreparedPrimitive *left, uint8_t side, Vec3s f, Vec3s d)
{
    int across = prepared_classes[left->kind].across[side];
    if (across > 0) {
        return across == 1 ? d.x : across == 2 ? d.y : d.z;
    }
    if (left->kind == PRIMITIVE_TORUS) {
        Doubles rho = doubles_sqrt(f.x * f.x + f.z * f.z);
        double ring = side == TORUS_OUTER ? left->data[0].x : -left->data[0].x;
        return vec3s_dot(f, d) - ring * ((f.x * d.x + f.z * d.z) / rho);
    }
    double slope = left->kind == PRIMITIVE_CONE ? 1.0 - left->data[0].x : 0.0;
    return left->kind == PRIMITIVE_CONE ? f.x * d.x + f.y * d.y + slope * doubles_sqrt(f.x * f.x + f.y * f.y) * d.z
                                        : vec3s_dot(f, d);
}

// How much of primitives of the family that they start on the rays have passed, at most.
static void group_set_passed(ShapeGroup *from, const RayGroup *group)
{
    const PreparedPrimitive *left = from->left;
    uint8_t side = primitive_side(from->start.shape);
    bool is_known = left && kind_has_lanes(left->kind) && start_has_along(left, side);
    bool is_round = left ? (left->family & FAMILY_ROUND) != 0 : shape_kind(from->start.shape) == SHAPE_SPHERE;
    bool is_straight = left ? (left->family & FAMILY_STRAIGHT) != 0 : !is_round;
    bool is_curve = left && kind_is_curve((PrimitiveKind)left->kind);
    LanePrimitive own = {0};
    from->far = vec3_length(group->end) + group->farthest;
    if (is_known) {
        lane_primitive_set(&own, left, from->far);
    }
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        Doubles passed = doubles_splat(left ? (double)INFINITY : 0.0); // not known, or exact
        if (is_known) {
            RayLanes rays = lane_primitive_ray(&own, group->origin, group->direction, at);
            passed = own.slack.fixed / doubles_abs(start_along(left, side, rays.f, rays.d));
        } else if (!left && is_straight) {
            for (unsigned i = 0; i < DOUBLES; i++) {
                passed[i] = from->start_error[at + i < group->count ? at + i : group->count - 1];
            }
        }
        const Doubles nothing = doubles_splat(-(double)INFINITY);
        doubles_store(&from->passed_round[at], is_round ? passed : nothing);
        doubles_store(&from->passed_straight[at], is_straight ? passed : nothing);
        doubles_store(&from->passed_curve[at], is_curve ? passed : nothing);
    }
}

// What one vector of rays meets of a primitive: what is before a ray's end, or is not, with a margin.
typedef struct LanesMet {
    unsigned met, open;
} LanesMet;

// How much of a primitive the rays have passed; of the one that they start on, nothing.
RT_ALWAYS_INLINE Doubles group_passed(const ShapeGroup *from, const PreparedPrimitive *primitive, PrimitiveKind kind,
                                      unsigned at)
{
    if (kind_is_curve(kind)) {
        bool is_passed = from->left && primitive != from->left && primitive->family == from->left->family;
        return is_passed ? doubles_load(&from->passed_curve[at]) : doubles_splat(-(double)INFINITY);
    }
    return doubles_load(&(kind == PRIMITIVE_SPHERE ? from->passed_round : from->passed_straight)[at]);
}

RT_ALWAYS_INLINE LanesMet group_primitive_lanes(const ShapeGroup *from, const RayGroup *group, const LanePrimitive *own,
                                                PrimitiveKind kind, const ItemBox *box, unsigned at, unsigned asked)
{
    PrimitiveLanes lanes;
    RayLanes rays = lane_primitive_ray(own, group->origin, group->direction, at);
    bool is_met = kind_is_curve(kind) && own->solid == from->left ? curve_lanes(own, kind, &rays, true, asked, &lanes)
                                                                  : primitive_lanes(own, kind, &rays, asked, &lanes);
    if (!is_met) {
        return (LanesMet){0, 0};
    }
    // The ends have a margin that is greater than way_end's.
    Doubles end = doubles_load(&group->distance[at]);
    Doubles passed = group_passed(from, own->solid, kind, at);
    unsigned behind = doubles_gt(lanes.root - lanes.bound, end * (1.0 + 0x1p-40));
    unsigned before = doubles_gt(end * (1.0 - 0x1p-40), lanes.root + lanes.bound);
    unsigned met = lanes.possible & lanes.certain & before & doubles_gt(lanes.root, lanes.bound + passed);
    if (met) {
        Doubles enter;
        met &= box_lanes_enter(&from->table->tree, box, vec3s_load(group->origin, at), rays.world, &enter);
        met &= doubles_gt(end * (1.0 - 0x1p-40), enter);
    }
    return (LanesMet){met, lanes.possible & ~met & ~(lanes.certain & behind)};
}

static RayStart group_start(const ShapeGroup *from, unsigned i)
{
    return (RayStart){from->shape[i], from->inward >> i & 1, from->start.use};
}

// Whether an item, whose box may be NULL, is before the end of a ray.
static bool group_ray_meets(const ShapeGroup *from, const RayGroup *group, unsigned i, ShapeItem item,
                            const ItemBox *box)
{
    Ray ray = {lane_get(group->origin, i), lane_get(group->direction, i)};
    double end = group->distance[i];
    ShapeQuery q;
    query_start(&q, from->table, &ray, group_start(from, i), from->start_error[i], true);
    q.box = box;
    Foremost first = foremost_start(&(Hit){end, SHAPE_NONE, false}, 0, end);
    item_closest(&q, item, &first);
    return first.hit.shape != SHAPE_NONE;
}

// The rays that a primitive is in the way of, with those that are `occluded`; sets those that `may` be, to be asked one
// by one.
RT_ALWAYS_INLINE uint64_t group_primitive_kind(const ShapeGroup *from, const RayGroup *group,
                                               const PreparedPrimitive *primitive, PrimitiveKind kind,
                                               const ItemBox *box, uint64_t occluded, uint64_t *may)
{
    LanePrimitive own;
    lane_primitive_set(&own, primitive, from->far);
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        unsigned asked = ~occluded >> at & ((1u << DOUBLES) - 1);
        if (asked) {
            LanesMet found = group_primitive_lanes(from, group, &own, kind, box, at, asked);
            occluded |= (uint64_t)found.met << at;
            *may |= (uint64_t)found.open << at;
        }
    }
    return occluded;
}

// Those of some rays that may meet a quadric.
static uint64_t group_quadric(const ShapeGroup *from, const RayGroup *group, const PreparedPrimitive *primitive,
                              uint64_t occluded)
{
    LanePrimitive own;
    uint64_t may = 0;
    lane_primitive_set(&own, primitive, from->far);
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        RayLanes rays = lane_primitive_ray(&own, group->origin, group->direction, at);
        may |= (uint64_t)(quadric_lanes_possible(primitive, rays.f, rays.d) & ((1u << DOUBLES) - 1)) << at;
    }
    return may & ~occluded;
}

// The faces of a mesh that the rays start on.
static DoublesMask group_left_faces(const ShapeGroup *from, const PreparedPrimitive *mesh, unsigned at)
{
    DoublesMask left = {0};
    for (unsigned i = 0; i < DOUBLES; i++) {
        ShapeId shape = from->shape[at + i];
        bool is_face = shape != SHAPE_NONE && shape_kind(shape) == SHAPE_FACE;
        left[i] = is_face ? shape_index(shape) - mesh->mesh.first_face : MESH_NO_FACE;
    }
    return left;
}

// Those of some rays that have not passed a root, for certain.
static unsigned group_not_passed(const ShapeGroup *from, const RayGroup *group, const PreparedPrimitive *primitive,
                                 const PrimitiveLanes *lanes, unsigned at)
{
    unsigned behind = lanes->possible;
    if (!starts_beside(from->table, from->start, primitive)) {
        return behind;
    }
    for (unsigned rest = behind; rest; rest &= rest - 1) {
        unsigned i = (unsigned)__builtin_ctz(rest);
        Ray ray = {lane_get(group->origin, at + i), lane_get(group->direction, at + i)};
        double error = from->start_error[at + i];
        error = error < 0.0 ? shapes_start_error(from->table, &ray, group_start(from, at + i)) : error;
        behind &= ~((unsigned)!(lanes->root[i] > lanes->bound[i] + error) << i);
    }
    return behind;
}

// A vector of rays against a mesh.
static __attribute__((noinline)) LanesMet group_mesh_lanes(const ShapeGroup *from, const RayGroup *group,
                                                           const LanePrimitive *own, const ItemBox *box, unsigned at,
                                                           unsigned asked)
{
    const PreparedPrimitive *primitive = own->solid;
    RayLanes rays = lane_primitive_ray(own, group->origin, group->direction, at);
    DoublesMask is_asked = doubles_bits_mask(asked);
    unsigned one = (unsigned)__builtin_ctz(asked);
    Vec3s f = vec3s_choose(is_asked, rays.f, vec3s_splat(vec3(rays.f.x[one], rays.f.y[one], rays.f.z[one])));
    Vec3s d = vec3s_choose(is_asked, rays.d, vec3s_splat(vec3(rays.d.x[one], rays.d.y[one], rays.d.z[one])));
    Vec3 point = linear_direction(&primitive->to_object, vec3_sub(group->end, primitive->centre));
    double rounding = 0x1p-44 * (from->far + vec3_length(primitive->centre));
    double radius = vec3_sum_abs(primitive->columns) * (group->end_radius + rounding);
    MeshLanes mesh = {.is_any = true};
    BvhWalk walk;
    bool is_apart;
    if (!mesh_lanes_set(&mesh, primitive->mesh.table, f, d)) {
        return (LanesMet){0, asked};
    }
    if (!mesh_lanes_start(&mesh, point, radius, &walk, &is_apart)) {
        return (LanesMet){0, is_apart ? asked : 0};
    }
    Doubles end = doubles_load(&group->distance[at]), away = vec3s_length(vec3s_sub(f, vec3s_splat(point)));
    mesh.left = group_left_faces(from, primitive, at);
    mesh.nearest = doubles_choose(is_asked, end * mesh.length * MESH_BEYOND, doubles_splat(-1.0));
    if (!mesh_lanes_walk(&mesh, &walk, doubles_greatest(away) * (1.0 + 0x1p-40) + 2.0 * radius)) {
        return (LanesMet){0, asked};
    }
    PrimitiveLanes lanes = {.possible = asked & doubles_mask_bits(mesh.face != (int64_t)MESH_NO_FACE)};
    unsigned open = lanes.possible | (asked & doubles_mask_bits(mesh.unsure)), met = 0;
    if (lanes.possible) {
        Doubles enter, before = end * (1.0 - 0x1p-40);
        lanes.root = mesh.t / mesh.length;
        lanes.bound = MESH_ERROR_MOST * lanes.root;
        met = group_not_passed(from, group, primitive, &lanes, at) & doubles_gt(before, lanes.root + lanes.bound);
        met &= box_lanes_enter(&from->table->tree, box, vec3s_load(group->origin, at), rays.world, &enter);
        met &= doubles_gt(before, enter);
    }
    return (LanesMet){met, open & ~met};
}

// As group_primitive_kind.
static uint64_t group_mesh(const ShapeGroup *from, const RayGroup *group, const PreparedPrimitive *primitive,
                           const ItemBox *box, uint64_t occluded, uint64_t *may)
{
    LanePrimitive own;
    lane_primitive_set(&own, primitive, from->far);
    for (unsigned at = 0; at < group->whole; at += DOUBLES) {
        unsigned asked = ~occluded >> at & LANES_ALL;
        if (asked) {
            LanesMet found = group_mesh_lanes(from, group, &own, box, at, asked);
            occluded |= (uint64_t)found.met << at;
            *may |= (uint64_t)found.open << at;
            if (found.open == asked) { // they give up, and so would others
                *may |= ~occluded & ~UINT64_C(0) << at;
                return occluded;
            }
        }
    }
    return occluded;
}

static uint64_t group_primitive(const ShapeGroup *from, const RayGroup *group, const PreparedPrimitive *primitive,
                                const ItemBox *box, uint64_t occluded, uint64_t *may)
{
    *may = 0;
    if (primitive_is_mesh(primitive) && !(primitive->hidden & from->start.use)) {
        return group_mesh(from, group, primitive, box, occluded, may);
    }
    if ((primitive->hidden & from->start.use) ||
        (primitive == from->left &&
         (primitive_is_flat(primitive) || (!primitive->flips && primitive_is_convex(primitive))))) {
        return occluded;
    }
    if (primitive == from->left && primitive_is_quadric(primitive)) {
        *may = ~occluded; // they go in, or may meet it again
        return occluded;
    }
    if (primitive == from->left && !primitive_is_convex(primitive) &&
        (primitive->flips || primitive->kind == PRIMITIVE_PRISM)) {
        bool is_gone = !primitive->flips && primitive_side(from->start.shape) != PRISM_WALL; // beyond its ends
        *may = is_gone ? 0 : ~occluded;                                                      // they go in, or along
        return occluded;
    }
    if (primitive_is_quadric(primitive)) {
        *may = group_quadric(from, group, primitive, occluded);
        return occluded;
    }
    switch (primitive->kind) {
    case PRIMITIVE_SPHERE:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_SPHERE, box, occluded, may);
    case PRIMITIVE_BOX:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_BOX, box, occluded, may);
    case PRIMITIVE_CONE:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_CONE, box, occluded, may);
    case PRIMITIVE_DISC:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_DISC, box, occluded, may);
    case PRIMITIVE_TORUS:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_TORUS, box, occluded, may);
    case PRIMITIVE_POLYNOMIAL:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_POLYNOMIAL, box, occluded, may);
    case PRIMITIVE_BLOB:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_BLOB, box, occluded, may);
    case PRIMITIVE_PRISM:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_PRISM, box, occluded, may);
    default:
        return group_primitive_kind(from, group, primitive, PRIMITIVE_TRIANGLE, box, occluded, may);
    }
}

// Those that an item is in the way of, whose box may be NULL.
static uint64_t group_item_at(const ShapeGroup *from, const RayGroup *group, ShapeItem item, const ItemBox *box,
                              uint64_t occluded)
{
    uint64_t may = ~occluded;
    if (item & ITEM_LANES) {
        occluded = group_primitive(from, group, &from->table->primitives[item_index(item)], box, occluded, &may);
    }
    for (; may; may &= may - 1) {
        unsigned i = (unsigned)__builtin_ctzll(may);
        occluded |= (uint64_t)group_ray_meets(from, group, i, item, box) << i;
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
    (void)cone;
    return group_item_at(from, group, table->items[table->unbounded_count + at], &table->boxes[at], occluded);
}

// Those of the group that something is before; false when they cannot be traced together.
static bool shape_group_occluded(ShapeGroup *from, const RayGroup *group, uint64_t *occluded)
{
    const ShapeTable *table = from->table;
    const GroupTree tree = {&table->tree, NULL, group_item, from, GROUP_ITEMS};
    uint64_t none = group_none(group);
    group_set_passed(from, group);
    *occluded = none;
    for (uint32_t i = 0; i < table->unbounded_count; i++) {
        *occluded = group_item_at(from, group, table->items[i], NULL, *occluded);
    }
    if (table->bounded_count > 0 && ~*occluded && !group_tree(&tree, group, NULL, occluded)) {
        return false;
    }
    *occluded &= ~none;
    return true;
}

// Those of some surfaces that are on faces of meshes.
static uint64_t surfaces_on_faces(const TileSurfaces *from, uint64_t rest)
{
    uint64_t faces = 0;
    for (; rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        faces |= (uint64_t)(shape_kind(from->shape[i]) == SHAPE_FACE) << i;
    }
    return faces;
}

// Those of some surfaces whose rays may go together with those of one: of its shape, or on faces of its mesh.
static uint64_t surfaces_together(const ShapeTable *table, const TileSurfaces *from, uint64_t rest, ShapeId shape)
{
    if (shape_kind(shape) != SHAPE_FACE) {
        return rest & surfaces_alike(from, shape);
    }
    uint32_t mesh = table_face_primitive(table, shape);
    uint64_t together = 0;
    for (rest = surfaces_on_faces(from, rest); rest; rest &= rest - 1) {
        int i = __builtin_ctzll(rest);
        together |= (uint64_t)(table_face_primitive(table, from->shape[i]) == mesh) << i;
    }
    return together;
}

static uint64_t shapes_occluded_surfaces(const ShapeTable *table, const TileSurfaces *from, const SurfaceRays *rays,
                                         const double start_error[TILE_RAYS], uint64_t asked, uint64_t *left)
{
    RayGroup group;
    ShapeGroup own;
    uint64_t all = 0, inward = surfaces_inward(from, rays);
    own.table = table;
    *left = asked & inward & ~surfaces_on_faces(from, asked & inward);
    for (uint64_t rest = asked & ~*left; rest;) {
        ShapeId shape = from->shape[__builtin_ctzll(rest)];
        uint64_t members = surfaces_together(table, from, rest, shape), occluded;
        unsigned count = 0;
        rest &= ~members;
        own.inward = 0;
        own.start = (RayStart){shape, false, HIDDEN_SHADOW};
        own.left = starts_on_primitive(own.start) ? table_primitive(table, shape) : NULL;
        for (uint64_t each = members; each; each &= each - 1) {
            own.shape[count] = from->shape[__builtin_ctzll(each)];
            own.inward |= (inward >> __builtin_ctzll(each) & 1) << count;
            own.start_error[count++] = start_error[__builtin_ctzll(each)];
        }
        for (unsigned i = count; i % DOUBLES != 0; i++) {
            own.shape[i] = SHAPE_NONE;
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
