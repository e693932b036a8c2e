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
