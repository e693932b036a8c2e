// SPDX-License-Identifier: MIT
#include "render/shade/tile_pigments.h"

#include "render/surface/texture.h"

_Static_assert((int)TEXTURE_ABREAST >= (int)TILE_RAYS, "a tile's surfaces go together");

static const Pigment *pigment_abreast(const Prepared *p, MaterialIndex material)
{
    if (!(material & MATERIAL_COMPOUND)) {
        return NULL;
    }
    const Texture *texture = texture_single(&p->textures, p->compounds[material & ~MATERIAL_COMPOUND].texture);
    return texture && texture_goes_abreast(&p->textures, &texture->pigment) ? &texture->pigment : NULL;
}

void tile_pigments(const Prepared *p, const TileSurfaces *surfaces, const MaterialIndex material[TILE_RAYS],
                   TilePigments *pigments)
{
    pigments->known = 0;
    for (int first = 0; first < surfaces->count; first++) {
        const Pigment *pigment = pigments->known >> first & 1 ? NULL : pigment_abreast(p, material[first]);
        if (!pigment) {
            continue;
        }
        Vec3 points[TILE_RAYS];
        Rgbft colours[TILE_RAYS];
        int which[TILE_RAYS], count = 0;
        for (int i = first; i < surfaces->count; i++) {
            if (material[i] == material[first]) {
                points[count] = vec3_scale(p->textures.scale, tile_surface_point(surfaces, i));
                which[count++] = i;
            }
        }
        texture_pigments(&p->textures, pigment, (unsigned)count, points, colours);
        for (int k = 0; k < count; k++) {
            pigments->colour[which[k]] = colours[k];
            pigments->known |= UINT64_C(1) << which[k];
        }
    }
}
