// The first face of a mesh that a ray meets: part of spheres_kernel.c.
//
// The face with the least t, and of those the first, is offered, if the ray has not passed it; for a shadow whichever
// comes first.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_MESH_WALK_H
#define TRACE_MESH_WALK_H

// How far a face may be behind the limit at which it still counts, see MESH_ERROR_MOST.
#define MESH_BEYOND (1.0 + 2.0 * MESH_ERROR_MOST)

static bool face_is_passed(ShapeQuery *q, const Solid *solid, const Ray *object, double t, uint32_t face, double passed)
{
    return passed >= 0.0 && is_passed(t, mesh_crossing_error(solid, q->ray, object, t, face), passed);
}

static void face_found(ShapeQuery *q, const Solid *solid, const Ray *object, double t, uint32_t face, Foremost *first)
{
    double enter;
    if (item_enters(q, &enter)) {
        RootSpan span = crossing_span(t, mesh_crossing_error(solid, q->ray, object, t, face), enter);
        face_offer(q->table, shape_id(SHAPE_FACE, solid->mesh.first_face + face), q->ray, t, span, first);
    }
}

static __attribute__((noinline)) void mesh_closest(ShapeQuery *q, uint32_t index, Foremost *first)
{
    const Solid *solid = &q->table->solids[index];
    const MeshTable *table = solid->mesh.table;
    uint32_t left = q->start.shape != SHAPE_NONE && shape_kind(q->start.shape) == SHAPE_FACE
                        ? shape_index(q->start.shape) - solid->mesh.first_face
                        : MESH_NO_FACE;
    Ray object = solid_ray(solid, q->ray);
    double passed = passed_error(q, solid);
    MeshQuery query;
    BvhWalk walk;
    BvhChild leaf;
    span_refine(q, first);
    mesh_query_make(&query, &object);
    double nearest = first->limit * query.length * MESH_BEYOND;
    uint32_t found = MESH_NO_FACE;
    if (!bvh_walk_start(&walk, &table->tree, query.ray.origin, query.ray.direction)) {
        return;
    }
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest), &leaf)) {
        uint32_t begin = bvh_leaf_first(leaf), end = begin + bvh_leaf_count(leaf);
        for (uint32_t i = begin; i < end; i++) {
            MeshPoint at;
            uint32_t face = table->faces[i];
            if (!mesh_ray_crosses(&query.shear, table->mesh, face, &at) || !(at.t > 0.0) || face == left ||
                !(at.t < nearest || (at.t == nearest && face < found)) ||
                face_is_passed(q, solid, &object, at.t / query.length, face, passed)) {
                continue;
            }
            if (q->is_any) {
                face_found(q, solid, &object, at.t / query.length, face, first);
                if (first->hit.shape != SHAPE_NONE) {
                    return;
                }
                continue;
            }
            nearest = at.t;
            found = face;
        }
    }
    if (found != MESH_NO_FACE) {
        face_found(q, solid, &object, nearest / query.length, found, first);
    }
}

#endif
