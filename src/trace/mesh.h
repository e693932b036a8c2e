// Meshes made ready for rays: a tree over the faces of each, which all primitives that have it share.
//
// A ray is taken into the mesh's own space, where faces are asked by scene/mesh_ray.h. The walk of the tree for
// pictures is in shapes_walk.h; composites ask for one crossing after the other. A ray that starts on a face leaves
// that face out, by its number. Knows nothing of materials but where they stand.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_MESH_H
#define TRACE_MESH_H

#include "scene/mesh_ray.h"
#include "trace/bvh.h"
#include "trace/prepared_primitive.h"

struct MeshTable {
    const Mesh *mesh; // not owned
    Bvh tree;
    uint32_t *faces; // in the tree's order
    Pages face_pages;
};

// Of a valid mesh, which must live as long; NULL when out of memory or cancelled.
MeshTable *mesh_table_new(const Mesh *mesh, int threads, const atomic_bool *cancel) RT_MUST_CHECK;
void mesh_table_free(MeshTable *table);
size_t mesh_table_bytes(const MeshTable *table);

// How far the t of a crossing with a face may be off by rounding; docs/numerics.md has the bound.
double mesh_crossing_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                           uint32_t face);

// Where the ray hit a face, and the normal that light sees.
void mesh_surface(const PreparedPrimitive *primitive, const Ray *ray, uint32_t face, Vec3 *point, Vec3 *normal);

// Whether the ray, which is `object` in the primitive's own space, goes along the normal that light sees where it hit a
// face: as mesh_surface has it.
bool mesh_is_left(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, uint32_t face);

// Along the normal of a face's plane, in the primitive's own space; `shape` is of the face.
Vec3 mesh_plane(const PreparedPrimitive *primitive, uint32_t shape_index);

static inline MaterialIndex mesh_material(const PreparedPrimitive *primitive, uint32_t face)
{
    const uint32_t *textures = primitive->mesh.table->mesh->face_textures;
    return textures && textures[face] ? primitive->mesh.materials[textures[face] - 1] : primitive->material;
}

// A ray in a mesh's space, of unit length as trees want it: t there is t of the ray times `length`.
typedef struct MeshQuery {
    Ray ray;
    double length;
    MeshRay shear;
} MeshQuery;

static inline void mesh_query_make(MeshQuery *query, const Ray *object)
{
    query->length = vec3_length(object->direction);
    query->ray = (Ray){object->origin, vec3_scale(1.0 / query->length, object->direction)};
    query->shear = mesh_ray_make(&query->ray);
}

enum {
    MESH_CROSSINGS = 6, // of a mesh that a ray keeps in a composite: the next, and those that come with it
    MESH_NO_FACE = UINT32_MAX,
    MESH_SIDE = UINT32_MAX - 1, // in a face's place: a side of what lies below a field of heights, or its water
};

// No error of a crossing is taken for more than this share of its t, so that what lies behind a limit by more does not
// matter.
#define MESH_ERROR_MOST 0x1p-11

// Where a ray stands in a mesh: behind crossing (t, face).
typedef struct MeshCursor {
    MeshQuery query;
    double t; // of the query
    uint32_t face;
    bool is_inside;
    bool is_left; // of a field of heights: nothing more is below or above it
    int leave_axis;
    double leave; // there: where the ray leaves that, in t of its own, across `leave_axis`
    double water; // there: where it will come through water, infinite: nowhere
} MeshCursor;

// Moves the cursor to the next crossing behind it, by t, then by number; t of the ray. False: there is none.
bool mesh_next(const PreparedPrimitive *primitive, MeshCursor *cursor, double *t);

// The crossings that are behind the cursor, but those of which `is_past` says that the ray has passed them: how many,
// and the least and the greatest t of the ray among them.
typedef struct MeshAhead {
    uint32_t count;
    double first, last;
} MeshAhead;
typedef bool (*MeshIsPast)(const void *client, double t, uint32_t face); // t of the ray
MeshAhead mesh_ahead(const PreparedPrimitive *primitive, const MeshCursor *cursor, MeshIsPast is_past,
                     const void *client);

// Of a field of heights: whether its surface is not below the water where a ray in its space crosses a face at t. What
// is below is none. A face of which no corner is below shows whatever rounding makes of t.
static inline bool mesh_shows(const MeshTable *table, const Ray *object, double t, uint32_t face)
{
    const Mesh *mesh = table->mesh;
    if (!mesh->field) {
        return true;
    }
    double water = mesh->field->water, low = (double)INFINITY;
    for (int i = 0; i < 3; i++) {
        double height = (double)mesh->vertices[mesh->faces[face][i]][1];
        low = height < low ? height : low;
    }
    return low >= water || object->origin.y + t * object->direction.y >= water;
}

// Whether a ray meets any face.
bool mesh_is_crossed(const PreparedPrimitive *primitive, const Ray *object);

#endif
