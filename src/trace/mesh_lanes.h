// The faces of a mesh that some rays cross which all come from one point, or go to one: part of spheres_kernel.c.
//
// They walk the mesh's tree together, as a beam from that point, and a face is asked by all of them at once, by the
// operations of scene/mesh_ray.h in their order. Where an edge function is 0 the ray is asked by itself. Where faces are
// so small that neighbours meet others, rays are sooner done one by one: a walk that has asked too many gives up.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_MESH_LANES_H
#define TRACE_MESH_LANES_H

#include "trace/bvh_walk.h"
#include "trace/mesh.h"
#include "trace/vec3s.h"

// MeshQuery of some rays that go along one axis most, and what they have found.
typedef struct MeshLanes {
    const MeshTable *table;
    bool is_any;                       // whatever is met first will do
    Vec3s origin;
    Doubles from[3];                   // the same in the order of the axes
    Doubles direction[3], length;      // of unit length; what it was
    Doubles shear_x, shear_y, inverse; // as in MeshRay
    uint8_t x, y, z;
    Doubles nearest, t; // of the query: what matters lies before; of what is found
    DoublesMask face;   // MESH_NO_FACE: none
    DoublesMask left;   // that they start on
    DoublesMask unsure;
} MeshLanes;

enum {
    LANES_ALL = (1u << DOUBLES) - 1,
    MESH_LANES_FACES = 8 * DOUBLES, // that a walk asks at most
};

// Those of which a component, of two others, is the greatest: as mesh_ray_make chooses.
RT_ALWAYS_INLINE unsigned mesh_lanes_axis(const Doubles d[3])
{
    Doubles x = doubles_abs(d[0]), y = doubles_abs(d[1]), z = doubles_abs(d[2]);
    unsigned over = doubles_mask_bits(x >= y), first = doubles_mask_bits((x >= y) & (x >= z));
    unsigned second = ~over & doubles_mask_bits(y >= z), all = LANES_ALL;
    return (first & all) == all ? 0 : (second & all) == all ? 1 : ((first | second) & all) == 0 ? 2 : 3;
}

// False when they do not go along one axis most. All is in the mesh's space; those that are not asked are like others.
RT_ALWAYS_INLINE bool mesh_lanes_set(MeshLanes *of, const MeshTable *table, Vec3s origin, Vec3s direction)
{
    const Doubles o[3] = {origin.x, origin.y, origin.z};
    of->table = table;
    of->origin = origin;
    of->length = vec3s_length(direction);
    Vec3s unit = vec3s_scale(1.0 / of->length, direction);
    of->direction[0] = unit.x;
    of->direction[1] = unit.y;
    of->direction[2] = unit.z;
    unsigned z = mesh_lanes_axis(of->direction);
    if (z > 2) {
        return false;
    }
    of->z = (uint8_t)z;
    of->x = (uint8_t)((z + 1) % 3);
    of->y = (uint8_t)((z + 2) % 3);
    of->from[0] = o[of->x];
    of->from[1] = o[of->y];
    of->from[2] = o[of->z];
    of->shear_x = of->direction[of->x] / of->direction[z];
    of->shear_y = of->direction[of->y] / of->direction[z];
    of->inverse = 1.0 / of->direction[z];
    of->unsure = (DoublesMask){0};
    of->face = of->left = of->unsure + (int64_t)MESH_NO_FACE;
    of->t = doubles_splat(0.0);
    return true;
}

// Those of some that cross a face whose surface is not below the water of a field.
static DoublesMask mesh_lanes_show(const MeshLanes *of, uint32_t face, Doubles t, DoublesMask met)
{
    for (unsigned i = 0; i < DOUBLES; i++) {
        Ray ray = {vec3(of->origin.x[i], of->origin.y[i], of->origin.z[i]),
                   vec3(of->direction[0][i], of->direction[1][i], of->direction[2][i])};
        met[i] = met[i] && mesh_shows(of->table, &ray, t[i], face) ? -1 : 0;
    }
    return met;
}

// Takes the face as that of those that cross it before what they have found. True when there are any.
RT_ALWAYS_INLINE bool mesh_lanes_face(MeshLanes *of, uint32_t face)
{
    const Mesh *mesh = of->table->mesh;
    Doubles p[3][2], depth[3];
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const float *v = mesh->vertices[mesh->faces[face][k]];
        depth[k] = (double)v[of->z] - of->from[2];
        p[k][0] = ((double)v[of->x] - of->from[0]) - of->shear_x * depth[k];
        p[k][1] = ((double)v[of->y] - of->from[1]) - of->shear_y * depth[k];
    }
    Doubles first = p[2][0] * p[1][1] - p[2][1] * p[1][0], second = p[0][0] * p[2][1] - p[0][1] * p[2][0];
    Doubles third = p[1][0] * p[0][1] - p[1][1] * p[0][0];
    DoublesMask above = (first > 0.0) | (second > 0.0) | (third > 0.0);
    DoublesMask below = (first < 0.0) | (second < 0.0) | (third < 0.0);
    DoublesMask within = ((first > 0.0) & (second > 0.0) & (third > 0.0)) |
                         ((first < 0.0) & (second < 0.0) & (third < 0.0));
    of->unsure |= ~within & ~(above & below);
    if (!(doubles_mask_bits(within) & LANES_ALL)) {
        return false;
    }
    Doubles sum = first + second + third;
    Doubles z = first / sum * depth[0] + second / sum * depth[1] + third / sum * depth[2];
    Doubles low = doubles_min(depth[0], doubles_min(depth[1], depth[2]));
    Doubles high = doubles_max(depth[0], doubles_max(depth[1], depth[2]));
    Doubles t = doubles_max(low, doubles_min(z, high)) * of->inverse;
    within &= (t > 0.0) & ((t < of->nearest) | ((t == of->nearest) & ((int64_t)face < of->face))) &
              (of->left != (int64_t)face);
    if (mesh->field && mesh->field->water > 0.0) {
        within = mesh_lanes_show(of, face, t, within);
    }
    of->t = doubles_choose(within, t, of->t);
    of->nearest = doubles_choose(within, of->is_any ? doubles_splat(-1.0) : t, of->nearest);
    of->face = (within & (int64_t)face) | (~within & of->face);
    return doubles_mask_bits(within) & LANES_ALL;
}

// Between which sizes the components of the directions from the walk's point are. False where they have both signs along
// an axis.
RT_ALWAYS_INLINE bool mesh_lanes_range(const MeshLanes *of, Vec3 *least, Vec3 *greatest)
{
    double *low = &least->x, *high = &greatest->x;
    for (int axis = 0; axis < 3; axis++) {
        Doubles d = of->direction[axis], size = doubles_abs(d);
        unsigned down = doubles_mask_bits(d < 0.0) & LANES_ALL, up = doubles_mask_bits(d > 0.0) & LANES_ALL;
        if (down && up) {
            return false;
        }
        double sign = (down != 0) != of->is_any ? -1.0 : 1.0; // or the rays go to that point
        low[axis] = sign * doubles_least(size);
        high[axis] = sign * doubles_greatest(size);
    }
    return true;
}

// A walk as the beam from a point, past which no ray goes by more than `radius`. False when there is nothing to walk, or
// when they cannot walk together.
RT_ALWAYS_INLINE bool mesh_lanes_start(const MeshLanes *of, Vec3 point, double radius, BvhWalk *walk, bool *is_apart)
{
    Vec3 least, greatest;
    *is_apart = !mesh_lanes_range(of, &least, &greatest);
    if (*is_apart) {
        return false;
    }
    return bvh_walk_start_beam(walk, &of->table->tree, point, radius, least, greatest, is_apart);
}

// Finds the faces of those rays of which `nearest` is above 0, before that. None is farther than `reach` from the walk's
// point. False when it gives up.
RT_ALWAYS_INLINE bool mesh_lanes_walk(MeshLanes *of, BvhWalk *walk, double reach)
{
    BvhChild leaf;
    uint32_t asked = 0;
    while (bvh_walk_next(walk, bvh_walk_limit(walk, reach), &leaf)) {
        uint32_t begin = bvh_leaf_first(leaf), end = begin + bvh_leaf_count(leaf);
        bool is_met = false;
        asked += end - begin;
        if (asked > MESH_LANES_FACES) {
            return false;
        }
        for (uint32_t i = begin; i < end; i++) {
            is_met |= mesh_lanes_face(of, of->table->faces[i]);
        }
        if (is_met) {
            double last = doubles_greatest(of->nearest);
            if (last < 0.0) {
                return true;
            }
            reach = of->is_any ? reach : last;
        }
    }
    return true;
}

#endif
