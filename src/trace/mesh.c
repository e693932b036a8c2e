// The trees of meshes, and what a hit is on.
//
// SPDX-License-Identifier: MIT
#include "trace/mesh.h"

#include <float.h>
#include <stdlib.h>

#include "math/extreme.h"
#include "scene/mesh_field.h"
#include "trace/bvh_walk.h"
#include "trace/mesh_field_tree.h"

// ---- the tree

static void refs_init(const MeshTable *table, BvhRef *refs)
{
    const Mesh *mesh = table->mesh;
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        Vec3 a = mesh_corner(mesh, face, 0), b = mesh_corner(mesh, face, 1), c = mesh_corner(mesh, face, 2);
        refs[face] =
            bvh_ref(&table->tree, vec3_least(a, vec3_least(b, c)), vec3_greatest(a, vec3_greatest(b, c)), face);
    }
}

// The tree of faces in any order, which it puts into its own.
static bool tree_of_faces(MeshTable *table, int threads, const atomic_bool *cancel)
{
    uint32_t count = table->mesh->face_count;
    Pages pages = {0};
    if (!pages_take(&pages, count * sizeof(BvhRef))) {
        return false;
    }
    BvhRef *refs = pages.memory;
    refs_init(table, refs);
    bool done = bvh_build(&table->tree, refs, count, BVH_LEAF_EIGHT, threads, cancel);
    for (uint32_t i = 0; done && i < count; i++) {
        table->faces[i] = bvh_ref_index(&refs[i]);
    }
    pages_give(&pages);
    return done;
}

// The tree of a field of heights, whose faces are in order.
static bool tree_of_field(MeshTable *table, const atomic_bool *cancel)
{
    for (uint32_t i = 0; i < table->mesh->face_count; i++) {
        table->faces[i] = i;
    }
    return mesh_field_tree_build(&table->tree, table->mesh, cancel);
}

MeshTable *mesh_table_new(const Mesh *mesh, int threads, const atomic_bool *cancel)
{
    MeshTable *table = calloc(1, sizeof *table);
    if (!table) {
        return NULL;
    }
    table->mesh = mesh;
    bvh_place(&table->tree, mesh->low, mesh->high);
    bool done = pages_take(&table->face_pages, mesh->face_count * sizeof *table->faces);
    table->faces = table->face_pages.memory;
    if (!done || !(mesh->field ? tree_of_field(table, cancel) : tree_of_faces(table, threads, cancel))) {
        mesh_table_free(table);
        return NULL;
    }
    return table;
}

void mesh_table_free(MeshTable *table)
{
    bvh_fini(&table->tree);
    pages_give(&table->face_pages);
    free(table);
}

size_t mesh_table_bytes(const MeshTable *table)
{
    return sizeof *table + table->tree.node_count * sizeof(BvhNode) + table->mesh->face_count * sizeof *table->faces;
}

// ---- at a hit

double mesh_crossing_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                           uint32_t face)
{
    double error =
        primitive_plane_error(primitive, ray, object, t, mesh_face_normal(primitive->mesh.table->mesh, face));
    double most = MESH_ERROR_MOST * fabs(t);
    return t == 0.0 || error < most ? error : most;
}

// A face whose second and third normal are nearer than this to the first is flat: its normals do not count. Measured.
static const double same_normals = 1e-5;

static Vec3 face_normal(const Mesh *mesh, uint32_t face, const MeshPoint *at)
{
    Vec3 own = mesh_face_normal(mesh, face);
    if (!mesh_face_is_smooth(mesh, face)) {
        return own;
    }
    const uint32_t *numbers = mesh->face_normals[face];
    Vec3 first = mesh_vector(mesh->normals[numbers[0]]), n = vec3_scale(at->weights[0], first);
    double apart = 0.0;
    for (int i = 1; i < 3; i++) {
        Vec3 other = mesh_vector(mesh->normals[numbers[i]]);
        apart = greater_of(apart, vec3_length_squared(vec3_sub(other, first)));
        n = vec3_add_scaled(n, at->weights[i], other);
    }
    bool is_flat = apart < same_normals * same_normals || vec3_equal(n, vec3(0.0, 0.0, 0.0));
    return is_flat ? own : n;
}

static Vec3 field_normal(const PreparedPrimitive *primitive, uint32_t face, Vec3 point)
{
    Vec3 normals[4], sum = vec3(0.0, 0.0, 0.0);
    double weights[4];
    int count = mesh_field_normals(primitive->mesh.table->mesh->field, face, point, normals, weights);
    for (int i = 0; i < count; i++) {
        sum = vec3_add_scaled(sum, weights[i], vec3_normalize(linear_normal(&primitive->to_object, normals[i])));
    }
    return vec3_normalize(sum);
}

void mesh_surface(const PreparedPrimitive *primitive, const Ray *ray, uint32_t face, Vec3 *point, Vec3 *normal)
{
    const Mesh *mesh = primitive->mesh.table->mesh;
    MeshQuery query;
    MeshPoint at = {0.0, {1.0, 0.0, 0.0}};
    Ray object = primitive_ray(primitive, ray);
    mesh_query_make(&query, &object);
    (void)mesh_ray_crosses(&query.shear, mesh, face, &at);
    Vec3 own = vec3(0.0, 0.0, 0.0);
    for (int i = 0; i < 3; i++) {
        own = vec3_add_scaled(own, at.weights[i], mesh_corner(mesh, face, i));
    }
    *point = vec3_add(primitive->centre, linear_direction(&primitive->to_world, own));
    *normal = mesh->field ? field_normal(primitive, face, own)
                          : vec3_normalize(linear_normal(&primitive->to_object, face_normal(mesh, face, &at)));
}

// The product of both is the same in both spaces but for rounding.
bool mesh_is_left(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, uint32_t face)
{
    const Mesh *mesh = primitive->mesh.table->mesh;
    Vec3 columns = primitive->columns, point, normal;
    if (mesh->field ? !mesh->field->normals : !mesh_face_is_smooth(mesh, face)) {
        Vec3 own[4];
        double weights[4];
        if (mesh->field) {
            (void)mesh_field_normals(mesh->field, face, vec3(0.0, 0.0, 0.0), own, weights);
        } else {
            own[0] = mesh_face_normal(mesh, face);
        }
        double along = vec3_dot(own[0], object->direction);
        double size = fabs(own[0].x) * columns.x + fabs(own[0].y) * columns.y + fabs(own[0].z) * columns.z;
        if (fabs(along) > 0x1p-40 * size && size > 0x1p-400 && size < 0x1p400) {
            return along > 0.0;
        }
    }
    mesh_surface(primitive, ray, face, &point, &normal);
    return vec3_dot(normal, ray->direction) > 0.0;
}

Vec3 mesh_plane(const PreparedPrimitive *primitive, uint32_t shape_index)
{
    return mesh_face_normal(primitive->mesh.table->mesh, shape_index - primitive->mesh.first_face);
}

// ---- one crossing after the other

static bool is_behind(double t, uint32_t face, double other, uint32_t other_face)
{
    return t > other || (t == other && face > other_face);
}

bool mesh_next(const PreparedPrimitive *primitive, MeshCursor *cursor, double *t)
{
    const MeshTable *table = primitive->mesh.table;
    const MeshQuery *query = &cursor->query;
    BvhWalk walk;
    BvhChild leaf;
    double nearest = (double)INFINITY;
    uint32_t found = MESH_NO_FACE;
    if (!bvh_walk_start(&walk, &table->tree, query->ray.origin, query->ray.direction)) {
        return false;
    }
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, nearest), &leaf)) {
        uint32_t first = bvh_leaf_first(leaf), end = first + bvh_leaf_count(leaf);
        for (uint32_t i = first; i < end; i++) {
            MeshPoint at;
            uint32_t own = table->faces[i];
            if (mesh_ray_crosses(&query->shear, table->mesh, own, &at) &&
                is_behind(at.t, own, cursor->t, cursor->face) && is_behind(nearest, found, at.t, own)) {
                nearest = at.t;
                found = own;
            }
        }
    }
    if (found == MESH_NO_FACE) {
        return false;
    }
    cursor->t = nearest;
    cursor->face = found;
    *t = nearest / query->length;
    return true;
}

MeshAhead mesh_ahead(const PreparedPrimitive *primitive, const MeshCursor *cursor, MeshIsPast is_past,
                     const void *client)
{
    const MeshTable *table = primitive->mesh.table;
    const MeshQuery *query = &cursor->query;
    BvhWalk walk;
    BvhChild leaf;
    MeshAhead ahead = {0, (double)INFINITY, 0.0};
    if (!bvh_walk_start(&walk, &table->tree, query->ray.origin, query->ray.direction)) {
        return ahead;
    }
    while (bvh_walk_next(&walk, bvh_walk_limit(&walk, (double)INFINITY), &leaf)) {
        uint32_t first = bvh_leaf_first(leaf), end = first + bvh_leaf_count(leaf);
        for (uint32_t i = first; i < end; i++) {
            MeshPoint at;
            uint32_t own = table->faces[i];
            if (mesh_ray_crosses(&query->shear, table->mesh, own, &at) &&
                is_behind(at.t, own, cursor->t, cursor->face) && !is_past(client, at.t / query->length, own)) {
                ahead.count++;
                ahead.first = less_of(ahead.first, at.t / query->length);
                ahead.last = greater_of(ahead.last, at.t / query->length);
            }
        }
    }
    return ahead;
}

bool mesh_is_crossed(const PreparedPrimitive *primitive, const Ray *object)
{
    MeshCursor cursor = {.face = MESH_NO_FACE};
    double t;
    mesh_query_make(&cursor.query, object);
    return mesh_next(primitive, &cursor, &t);
}
