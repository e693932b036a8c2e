// Textures at the corners of a face: POV-Ray weighs them by how near the point is to each, as measured.
//
// Plain colours with one finish become one pigment, c0 + u (c1 - c0) + v (c2 - c0) with u and v the weights of the second
// and the third corner: the mean of c0 + 2 u (c1 - c0) and c0 + 2 v (c2 - c0), each of them a gradient, from 1/4 to 3/4 of
// its way, so that rounding at an edge does not begin it anew. Knows nothing of how meshes are read.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/build/blocks.h"

static bool is_plain(const TextureDesc *texture)
{
    return texture->part.pattern.type == PATTERN_NONE && texture->pigment.part.pattern.type == PATTERN_NONE &&
           texture->normal.part.pattern.type == PATTERN_NONE && !texture->below;
}

static bool have_one_finish(const TextureDesc *one, const TextureDesc *other)
{
    return one->ior == other->ior && memcmp(&one->finish, &other->finish, sizeof one->finish) == 0;
}

bool mesh_textures_are_same(const TextureDesc *one, const TextureDesc *other)
{
    return is_plain(one) && is_plain(other) && have_one_finish(one, other) &&
           memcmp(&one->pigment.colour, &other->pigment.colour, sizeof one->pigment.colour) == 0;
}

bool mesh_textures_blend(const TextureDesc *const corners[3])
{
    return is_plain(corners[0]) && is_plain(corners[1]) && is_plain(corners[2]) &&
           have_one_finish(corners[0], corners[1]) && have_one_finish(corners[0], corners[2]);
}

static double beyond(double from, double to)
{
    return from + 2.0 * (to - from);
}

static Rgbft colour_beyond(Rgbft a, Rgbft b)
{
    return (Rgbft){.red = beyond(a.red, b.red),
                   .green = beyond(a.green, b.green),
                   .blue = beyond(a.blue, b.blue),
                   .filter = beyond(a.filter, b.filter),
                   .transmit = beyond(a.transmit, b.transmit)};
}

// From the space in which u and v go from 1/4 to 3/4 along x and y.
static Transform face_space(const Mesh *mesh, uint32_t face)
{
    Vec3 a = mesh_corner(mesh, face, 0);
    Vec3 first = vec3_sub(mesh_corner(mesh, face, 1), a), second = vec3_sub(mesh_corner(mesh, face, 2), a);
    Vec3 across = vec3_cross(first, second);
    Vec3 across_unit = vec3_scale(vec3_length(first), vec3_normalize(across));
    Vec3 origin = vec3_add_scaled(vec3_add_scaled(a, -0.5, first), -0.5, second);
    return (Transform){{{2.0 * first.x, 2.0 * first.y, 2.0 * first.z},
                        {2.0 * second.x, 2.0 * second.y, 2.0 * second.z},
                        {across_unit.x, across_unit.y, across_unit.z},
                        {origin.x, origin.y, origin.z}}};
}

void mesh_blend(const MeshDesc *mesh, const MeshCorners *corners, CornerBlend *blend)
{
    const PigmentDesc *plain = schema_kind(KIND_PIGMENT)->defaults;
    blend->texture = *mesh->textures[corners->textures[0]];
    Rgbft colour = blend->texture.pigment.colour;
    Vec3 normal = mesh_face_normal(mesh->mesh, corners->face);
    if (vec3_equal(normal, vec3(0.0, 0.0, 0.0))) {
        return; // it is not seen
    }
    for (int i = 0; i < 2; i++) {
        Rgbft other = mesh->textures[corners->textures[i + 1]]->pigment.colour;
        blend->colour_entries[i][0] = (PatternEntry){.at = 0.25, .colour = colour};
        blend->colour_entries[i][1] = (PatternEntry){.at = 0.75, .colour = colour_beyond(colour, other)};
        blend->colours[i] = (PatternMap){blend->colour_entries[i], 2};
        blend->along[i] = *plain;
        blend->along[i].part.pattern.type = PATTERN_GRADIENT;
        blend->along[i].part.pattern.vector = vec3(i == 0, i == 1, 0.0);
        blend->along[i].part.map = &blend->colours[i];
        blend->sum_entries[i] = (PatternEntry){.at = 1.0, .pigment = &blend->along[i]};
    }
    blend->sum = (PatternMap){blend->sum_entries, 2};
    blend->texture.pigment.part = plain->part;
    blend->texture.pigment.part.pattern.type = PATTERN_AVERAGE;
    blend->texture.pigment.part.map = &blend->sum;
    blend->texture.pigment.part.transform = face_space(mesh->mesh, corners->face);
}
