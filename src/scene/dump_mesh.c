// The printable form of meshes: `mesh2` with its lists, once for all parts that share it.
//
// A mesh whose faces have textures of their own is written where it stands, since they are those of the part. Their
// patterns are in the scene, and a mesh's in its own space: what the part's matrix does to them is taken back.
//
// SPDX-License-Identifier: MIT
#include "base/number.h"
#include "scene/corners.h"
#include "scene/dump.h"

static void dump_floats(const char *word, const float (*vectors)[3], uint32_t count, TextBuffer *out)
{
    text_printf(out, "  %s { %lu", word, (unsigned long)count);
    for (uint32_t i = 0; i < count; i++) {
        text_append(out, i % 4 == 0 ? ",\n    " : ", ");
        dump_numbers(out, (double[]){(double)vectors[i][0], (double)vectors[i][1], (double)vectors[i][2]}, 3);
    }
    text_append(out, " }\n");
}

static void dump_indices(const char *word, const uint32_t (*indices)[3], uint32_t count, TextBuffer *out)
{
    text_printf(out, "  %s { %lu", word, (unsigned long)count);
    for (uint32_t i = 0; i < count; i++) {
        text_printf(out, "%s<%lu, %lu, %lu>", i % 4 == 0 ? ",\n    " : ", ", (unsigned long)indices[i][0],
                    (unsigned long)indices[i][1], (unsigned long)indices[i][2]);
    }
    text_append(out, " }\n");
}

void dump_texture_name(MaterialIndex material, const Scene *scene, TextBuffer *out)
{
    if (material & MATERIAL_COMPOUND) {
        text_printf(out, "T%lu", (unsigned long)scene->compounds.items[material & ~MATERIAL_COMPOUND].texture + 1);
    } else {
        text_printf(out, "M%lu", (unsigned long)material + 1);
    }
}

// The texture of a face's corners that a material is; NULL: it is no such.
static const Texture *corners_of(const Scene *scene, MaterialIndex material)
{
    const Texture *texture = material & MATERIAL_COMPOUND
                                 ? &scene->textures.items[scene->compounds.items[material & ~MATERIAL_COMPOUND].texture]
                                 : NULL;
    return texture && texture_is_of_corners(texture) ? texture : NULL;
}

// How many of a mesh's textures are none of corners: the first ones.
static uint32_t count_single(const Scene *scene, const Primitive *primitive)
{
    uint32_t count = 0;
    while (count < primitive->mesh.mesh->texture_count &&
           !corners_of(scene, scene->face_materials.items[primitive->mesh.materials + count])) {
        count++;
    }
    return count;
}

static void dump_face_texture(const Scene *scene, MaterialIndex material, const Transform *back, TextBuffer *out)
{
    const Texture *corners = corners_of(scene, material);
    if (corners) {
        const TextureEntry *entries = scene->texture_entries.items;
        for (uint32_t at = corners->entries; at != RECORD_NONE; at = entries[at].next) {
            text_printf(out, "    texture { T%lu }\n", (unsigned long)entries[at].texture + 1);
        }
        return;
    }
    text_append(out, "    texture { ");
    dump_texture_name(material, scene, out);
    if ((material & MATERIAL_COMPOUND) && !transform_is_identity(back)) {
        text_append(out, " matrix ");
        dump_numbers(out, &back->m[0][0], 12);
    }
    text_append(out, " }\n");
}

// Behind a face: its texture, or those of its corners.
static void dump_face_number(uint32_t texture, uint32_t single, TextBuffer *out)
{
    if (texture < single) {
        text_printf(out, ", %lu", (unsigned long)texture);
    } else {
        unsigned long first = single + 3 * (texture - single);
        text_printf(out, ", %lu, %lu, %lu", first, first + 1, first + 2);
    }
}

static bool has_flat_face(const Mesh *mesh)
{
    bool has = false;
    for (uint32_t i = 0; i < mesh->face_count && !has; i++) {
        has = !mesh_face_is_smooth(mesh, i);
    }
    return has;
}

static void dump_triangle_texture(const Scene *scene, MaterialIndex material, TextBuffer *out)
{
    const Texture *corners = corners_of(scene, material);
    const TextureEntry *entries = scene->texture_entries.items;
    text_append(out, corners ? " texture_list {" : " texture { ");
    for (uint32_t at = corners ? corners->entries : RECORD_NONE; at != RECORD_NONE; at = entries[at].next) {
        text_printf(out, " T%lu", (unsigned long)entries[at].texture + 1);
    }
    if (!corners) {
        dump_texture_name(material, scene, out);
    }
    text_append(out, " }");
}

// A mesh with flat faces between smooth ones has no form as mesh2.
static void dump_triangles(const Scene *scene, const Primitive *primitive, const Mesh *mesh, TextBuffer *out)
{
    text_append(out, "mesh {\n");
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        bool is_smooth = mesh_face_is_smooth(mesh, face);
        text_append(out, is_smooth ? "  smooth_triangle { " : "  triangle { ");
        for (int i = 0; i < 3; i++) {
            dump_vector(out, i ? ", " : "", mesh_corner(mesh, face, i));
            if (is_smooth) {
                dump_vector(out, ", ", mesh_vector(mesh->normals[mesh->face_normals[face][i]]));
            }
        }
        for (int i = 0; mesh->uvs && i < 3; i++) {
            const float *at = mesh->uvs[mesh->face_uvs[face][i]];
            text_append(out, i ? ", " : " uv_vectors ");
            dump_numbers(out, (double[]){(double)at[0], (double)at[1]}, 2);
        }
        if (primitive && mesh->face_textures && mesh->face_textures[face]) {
            dump_triangle_texture(
                scene, scene->face_materials.items[primitive->mesh.materials + mesh->face_textures[face] - 1], out);
        }
        text_append(out, " }\n");
    }
}

static void dump_faces(const Scene *scene, const Primitive *primitive, const Mesh *mesh, TextBuffer *out)
{
    if (!primitive || !mesh->face_textures) {
        dump_indices("face_indices", (const uint32_t(*)[3])mesh->faces, mesh->face_count, out);
        return;
    }
    uint32_t single = count_single(scene, primitive);
    text_printf(out, "  face_indices { %lu", (unsigned long)mesh->face_count);
    for (uint32_t i = 0; i < mesh->face_count; i++) {
        const uint32_t *face = mesh->faces[i];
        text_printf(out, ",\n    <%lu, %lu, %lu>", (unsigned long)face[0], (unsigned long)face[1],
                    (unsigned long)face[2]);
        if (mesh->face_textures[i]) {
            dump_face_number(mesh->face_textures[i] - 1, single, out);
        }
    }
    text_append(out, " }\n");
}

static void dump_uvs(const Mesh *mesh, TextBuffer *out)
{
    text_printf(out, "  uv_vectors { %lu", (unsigned long)mesh->uv_count);
    for (uint32_t i = 0; i < mesh->uv_count; i++) {
        text_append(out, i % 4 == 0 ? ",\n    " : ", ");
        double uv[2] = {(double)mesh->uvs[i][0], (double)mesh->uvs[i][1]};
        mesh_uv_settle(mesh, uv);
        uv[0] = number_single(uv[0]); // as they are read again
        uv[1] = number_single(uv[1]);
        dump_numbers(out, uv, 2);
    }
    text_append(out, " }\n");
}

static void dump_lists(const Scene *scene, const Primitive *primitive, const Mesh *mesh, TextBuffer *out)
{
    text_append(out, "mesh2 {\n");
    dump_floats("vertex_vectors", (const float(*)[3])mesh->vertices, mesh->vertex_count, out);
    if (mesh->normal_count > 0) {
        dump_floats("normal_vectors", (const float(*)[3])mesh->normals, mesh->normal_count, out);
    }
    if (mesh->uvs) {
        dump_uvs(mesh, out);
    }
    if (primitive && mesh->texture_count > 0) {
        uint32_t single = count_single(scene, primitive);
        text_printf(out, "  texture_list { %lu,\n", (unsigned long)single + 3 * (mesh->texture_count - single));
        for (uint32_t i = 0; i < mesh->texture_count; i++) {
            dump_face_texture(scene, scene->face_materials.items[primitive->mesh.materials + i], &primitive->to_object,
                              out);
        }
        text_append(out, "  }\n");
    }
    dump_faces(scene, primitive, mesh, out);
    if (mesh->uvs && mesh->face_uvs != mesh->faces) {
        dump_indices("uv_indices", (const uint32_t(*)[3])mesh->face_uvs, mesh->face_count, out);
    }
    if (mesh->face_normals && mesh->face_normals != mesh->faces) {
        dump_indices("normal_indices", (const uint32_t(*)[3])mesh->face_normals, mesh->face_count, out);
    }
}

// Heights as a spline through the middles of their steps, row by row as in a picture, and a function that cuts them
// down.
static void dump_heights(const Mesh *mesh, TextBuffer *out)
{
    const MeshField *field = mesh->field;
    text_printf(out, "#declare Heights%lu = function { spline { linear_spline", (unsigned long)mesh->number + 1);
    for (size_t i = 0; i < (size_t)field->columns * field->rows; i++) {
        size_t row = field->rows - 1 - i / field->columns;
        double height = (double)field->heights[row * field->columns + i % field->columns];
        text_printf(out, "%s%zu, ", i == 0 ? " " : i % 4 == 0 ? ",\n  " : ", ", i);
        dump_numbers(out, (double[]){(height + 0.5) / 65535.0, 0.0}, 2);
    }
    text_append(out, " } }\n");
}

static void dump_field(const Mesh *mesh, TextBuffer *out)
{
    const MeshField *field = mesh->field;
    unsigned long columns = field->columns, rows = field->rows;
    text_printf(out,
                "height_field {\n  function %lu, %lu { Heights%lu(floor(x*%lu + 0.5) + floor(y*%lu + 0.5)*%lu).x }\n",
                columns, rows, (unsigned long)mesh->number + 1, columns - 1, rows - 1, columns);
    text_append(out, field->normals ? "  smooth\n" : "");
    dump_number(out, "  water_level ", field->water);
    text_append(out, "\n");
}

static void dump_mesh(const Scene *scene, const Primitive *primitive, const Mesh *mesh, TextBuffer *out)
{
    if (mesh->field) {
        dump_field(mesh, out);
        return;
    }
    bool is_mixed = mesh->face_normals && has_flat_face(mesh);
    if (is_mixed) {
        dump_triangles(scene, primitive, mesh, out);
    } else {
        dump_lists(scene, primitive, mesh, out);
    }
    if (mesh->has_inside) {
        dump_vector(out, "  inside_vector ", mesh->inside_vector);
        text_append(out, "\n");
    }
}

void dump_meshes(const Scene *scene, TextBuffer *out)
{
    for (size_t i = 0; i < scene->meshes.count; i++) {
        const Mesh *mesh = scene->meshes.items[i];
        if (mesh->field) {
            dump_heights(mesh, out);
        }
        if (!mesh->face_textures) {
            text_printf(out, "#declare Mesh%lu = ", (unsigned long)mesh->number + 1);
            dump_mesh(scene, NULL, mesh, out);
            text_append(out, "}\n");
        }
    }
}

void dump_mesh_part(const Scene *scene, const Primitive *primitive, TextBuffer *out)
{
    if (primitive->mesh.mesh->face_textures) {
        dump_mesh(scene, primitive, primitive->mesh.mesh, out);
    } else {
        text_printf(out, "object { Mesh%lu", (unsigned long)primitive->mesh.mesh->number + 1);
    }
}
