// Records of meshes: their memory, their bounds, and which points are inside.
//
// SPDX-License-Identifier: MIT
#include "scene/mesh.h"

#include <math.h>
#include <stdlib.h>

#include "scene/mesh_field.h"
#include "scene/mesh_ray.h"

Mesh *mesh_new(void)
{
    return calloc(1, sizeof(Mesh));
}

void mesh_free(Mesh *mesh)
{
    if (mesh) {
        if (mesh->face_normals != mesh->faces) {
            free(mesh->face_normals);
        }
        if (mesh->face_uvs != mesh->faces) {
            free(mesh->face_uvs);
        }
        free(mesh->uvs);
        free(mesh->uv_corners);
        free(mesh->vertices);
        free(mesh->normals);
        free(mesh->faces);
        free(mesh->face_textures);
        if (mesh->field) {
            free(mesh->field->heights);
            free(mesh->field->normals);
            free(mesh->field);
        }
        free(mesh);
    }
}

size_t mesh_bytes(const Mesh *mesh)
{
    if (mesh->field) {
        return mesh_field_bytes(mesh->field->columns, mesh->field->rows, mesh->field->normals);
    }
    bool has_own = mesh->face_normals && mesh->face_normals != mesh->faces;
    bool has_uvs = mesh->face_uvs && mesh->face_uvs != mesh->faces;
    return sizeof *mesh + mesh->uv_count * sizeof *mesh->uvs + mesh->vertex_count * sizeof *mesh->vertices + mesh->normal_count * sizeof *mesh->normals +
           mesh->face_count * (sizeof *mesh->faces + (has_own ? sizeof *mesh->face_normals : 0) +
                               (has_uvs ? sizeof *mesh->face_uvs : 0) +
                               (mesh->face_textures ? sizeof *mesh->face_textures : 0));
}

void mesh_measure(Mesh *mesh)
{
    mesh->low = mesh->high = mesh_corner(mesh, 0, 0);
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        for (int i = 0; i < 3; i++) {
            Vec3 corner = mesh_corner(mesh, face, i);
            mesh->low = vec3_least(mesh->low, corner);
            mesh->high = vec3_greatest(mesh->high, corner);
        }
    }
}

static bool are_finite(const float (*vectors)[3], uint32_t count)
{
    float nothing = 0.0F; // as long as all is finite
    for (uint32_t i = 0; i < count; i++) {
        nothing += vectors[i][0] * 0.0F + vectors[i][1] * 0.0F + vectors[i][2] * 0.0F;
    }
    return nothing == 0.0F;
}

static bool uvs_are_finite(const Mesh *mesh)
{
    float nothing = 0.0F;
    for (uint32_t i = 0; i < mesh->uv_count; i++) {
        nothing += mesh->uvs[i][0] * 0.0F + mesh->uvs[i][1] * 0.0F;
    }
    return nothing == 0.0F;
}

static bool are_within(const uint32_t index[3], uint32_t count)
{
    return index[0] < count && index[1] < count && index[2] < count;
}

bool mesh_is_valid(const Mesh *mesh)
{
    bool is_valid = mesh->face_count > 0 && mesh->face_count <= MESH_FACES_MOST &&
                    vec3_is_finite(mesh->inside_vector) &&
                    are_finite((const float(*)[3])mesh->vertices, mesh->vertex_count) &&
                    are_finite((const float(*)[3])mesh->normals, mesh->normal_count) && uvs_are_finite(mesh);
    for (uint32_t face = 0; is_valid && face < mesh->face_count; face++) {
        is_valid = are_within(mesh->faces[face], mesh->vertex_count) &&
                   (!mesh_face_is_smooth(mesh, face) || are_within(mesh->face_normals[face], mesh->normal_count)) &&
                   (!mesh->uvs || are_within(mesh->face_uvs[face], mesh->uv_count)) &&
                   (!mesh->face_textures || mesh->face_textures[face] <= mesh->texture_count);
    }
    return is_valid;
}

bool mesh_holds(const Mesh *mesh, Vec3 point)
{
    if (mesh->field) {
        return mesh_field_holds(mesh->field, point);
    }
    bool is_inside = false;
    MeshRay ray = mesh_ray_make(&(Ray){point, mesh->inside_vector});
    for (uint32_t face = 0; mesh->has_inside && face < mesh->face_count; face++) {
        MeshPoint met;
        is_inside = is_inside != (mesh_ray_crosses(&ray, mesh, face, &met) && met.t > 0.0);
    }
    return is_inside;
}
