// Textures at the corners of a face: POV-Ray weighs them by how near the point is to each, as measured.
//
// They become the entries of a texture of their own, an average whose pattern's space is that of the face: x and y are
// the weights of its second and its third corner there. So they are plain ones: a pattern would have to lie in another
// space. Knows nothing of how meshes are read.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"
#include "scene/corners.h"

static bool is_plain(const TextureDesc *texture)
{
    return texture->part.pattern.type == PATTERN_NONE && texture->pigment.part.pattern.type == PATTERN_NONE &&
           texture->normal.part.pattern.type == PATTERN_NONE && !texture->below;
}

bool mesh_textures_blend(const TextureDesc *const corners[3])
{
    return is_plain(corners[0]) && is_plain(corners[1]) && is_plain(corners[2]);
}

// From the space of the face.
static Transform face_space(const Mesh *mesh, uint32_t face)
{
    Vec3 a = mesh_corner(mesh, face, 0);
    Vec3 first = vec3_sub(mesh_corner(mesh, face, 1), a), second = vec3_sub(mesh_corner(mesh, face, 2), a);
    Vec3 across = vec3_scale(vec3_length(first), vec3_normalize(vec3_cross(first, second)));
    return (Transform){
        {{first.x, first.y, first.z}, {second.x, second.y, second.z}, {across.x, across.y, across.z}, {a.x, a.y, a.z}}};
}

void mesh_blend(const MeshDesc *mesh, const MeshCorners *corners, CornerBlend *blend)
{
    const TextureDesc *plain = schema_kind(KIND_TEXTURE)->defaults;
    blend->texture = *mesh->textures[corners->textures[0]];
    for (int i = 0; i < 3; i++) {
        blend->entries[i] = (PatternEntry){.at = 1.0, .texture = mesh->textures[corners->textures[i]]};
    }
    blend->map = (PatternMap){blend->entries, 3};
    blend->texture.part = plain->part;
    blend->texture.part.pattern.type = PATTERN_AVERAGE;
    blend->texture.part.pattern.count = PATTERN_CORNERS;
    blend->texture.part.map = &blend->map;
    blend->texture.part.transform = face_space(mesh->mesh, corners->face);
}
