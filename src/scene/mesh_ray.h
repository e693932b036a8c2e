// A ray against the faces of a mesh: each line is in exactly one of two faces that share an edge.
//
// The corners are sheared so that the ray runs along z through the origin (S. Woop, C. Benthin, I. Wald, "Watertight
// Ray/Triangle Intersection", JCGT 2(1), 2013). A sheared corner depends on itself and the ray alone, so faces that
// share it see the same one, and an edge function changes its sign, bit for bit, when its ends change places. Its sign
// is certain: two products that round to different numbers are in that order, and where they round to the same the rest
// of them decides, which is exact. Where a line goes through an edge or a corner, it counts as beside it by an
// infinitesimal (e, e^2), the same for all faces (H. Edelsbrunner, E. Mücke, "Simulation of Simplicity", ACM TOG 9(1),
// 1990). So the faces around a corner share the line among them without a gap and without an overlap, and a line
// crosses a closed mesh as often inward as outward.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_MESH_RAY_H
#define SCENE_MESH_RAY_H

#include <math.h>

#include "math/ray.h"
#include "scene/mesh.h"

typedef struct MeshRay {
    double origin[3];                 // in the order of the axes x, y, z below
    double shear_x, shear_y, inverse; // inverse: of the direction along z
    uint8_t x, y, z;                  // axes; the direction is greatest along z
} MeshRay;

// The point where a ray meets a face: weights of the corners that sum up to 1, none below 0.
typedef struct MeshPoint {
    double t, weights[3];
} MeshPoint;

static inline MeshRay mesh_ray_make(const Ray *ray)
{
    const double o[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double d[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    double sizes[3] = {fabs(d[0]), fabs(d[1]), fabs(d[2])};
    uint8_t z = sizes[0] >= sizes[1] ? (sizes[0] >= sizes[2] ? 0 : 2) : (sizes[1] >= sizes[2] ? 1 : 2);
    uint8_t x = (uint8_t)((z + 1) % 3), y = (uint8_t)((z + 2) % 3);
    return (MeshRay){{o[x], o[y], o[z]}, d[x] / d[z], d[y] / d[z], 1.0 / d[z], x, y, z};
}

// Of the products a b and c d, which round to the same number, whether the first is greater (1), or less (-1).
static __attribute__((noinline, unused)) int mesh_rest_sign(double a, double b, double c, double d)
{
    double rest = fma(a, b, -(a * b)) - fma(c, d, -(c * d));
    return (rest > 0.0) - (rest < 0.0);
}

// The side of the edge from p to q that the line is on; 0 where the edge is a point.
RT_ALWAYS_INLINE int mesh_edge_sign(const double p[3], const double q[3], double *edge)
{
    double first = p[0] * q[1], second = p[1] * q[0];
    *edge = first - second;
    if (RT_LIKELY(*edge != 0.0)) {
        return *edge > 0.0 ? 1 : -1;
    }
    int sign = mesh_rest_sign(p[0], q[1], p[1], q[0]);
    if (sign != 0) {
        return sign;
    }
    return p[1] != q[1] ? (p[1] > q[1] ? 1 : -1) : (q[0] > p[0]) - (q[0] < p[0]);
}

RT_ALWAYS_INLINE void mesh_shear(const MeshRay *ray, const float v[3], double p[3])
{
    double z = (double)v[ray->z] - ray->origin[2];
    p[0] = ((double)v[ray->x] - ray->origin[0]) - ray->shear_x * z;
    p[1] = ((double)v[ray->y] - ray->origin[1]) - ray->shear_y * z;
    p[2] = z;
}

// Weights and t of edge functions that have one sign. What is on the edge only has weights of 0: then the first
// corner's.
static inline void mesh_point_set(const MeshRay *ray, const double corners[3][3], const double edges[3],
                                  MeshPoint *point)
{
    const double *a = corners[0], *b = corners[1], *c = corners[2];
    double sum = edges[0] + edges[1] + edges[2];
    double low = fmin(a[2], fmin(b[2], c[2])), high = fmax(a[2], fmax(b[2], c[2]));
    bool is_nothing = !(fabs(sum) > 0.0);
    point->weights[0] = is_nothing ? 1.0 : edges[0] / sum;
    point->weights[1] = is_nothing ? 0.0 : edges[1] / sum;
    point->weights[2] = is_nothing ? 0.0 : edges[2] / sum;
    double z = point->weights[0] * a[2] + point->weights[1] * b[2] + point->weights[2] * c[2];
    point->t = fmax(low, fmin(z, high)) * ray->inverse;
}

// Where the line crosses a face.
RT_ALWAYS_INLINE bool mesh_ray_crosses(const MeshRay *ray, const Mesh *mesh, uint32_t face, MeshPoint *point)
{
    double p[3][3], edges[3];
    const uint32_t *corners = mesh->faces[face];
    mesh_shear(ray, mesh->vertices[corners[0]], p[0]);
    mesh_shear(ray, mesh->vertices[corners[1]], p[1]);
    mesh_shear(ray, mesh->vertices[corners[2]], p[2]);
    int side = mesh_edge_sign(p[2], p[1], &edges[0]);
    if (side == 0 || mesh_edge_sign(p[0], p[2], &edges[1]) != side || mesh_edge_sign(p[1], p[0], &edges[2]) != side) {
        return false;
    }
    mesh_point_set(ray, p, edges, point);
    return true;
}

#endif
