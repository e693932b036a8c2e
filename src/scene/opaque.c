// Textures that surely let no light through, and surfaces that surely look alike.
//
// Owns nothing. Knows nothing of shapes.
//
// SPDX-License-Identifier: MIT
#include "scene/opaque.h"

#include <string.h>

static bool pigment_is_opaque(const Scene *scene, const Pigment *pigment)
{
    if (pigment->pattern == RECORD_NONE) {
        return pigment->filter == 0.0F && pigment->transmit == 0.0F;
    }
    const PatternedPigment *pattern = &scene->patterns.items[pigment->pattern];
    bool is_opaque = pattern->pattern.type != PATTERN_IMAGE_MAP; // a picture may have an alpha channel
    for (uint32_t at = pattern->entries; is_opaque && at != RECORD_NONE;) {
        const PigmentEntry *entry = &scene->pigment_entries.items[at];
        is_opaque = pigment_is_opaque(scene, &entry->pigment);
        at = entry->next;
    }
    return is_opaque;
}

static bool texture_is_opaque(const Scene *scene, uint32_t number)
{
    bool is_opaque = false;
    for (uint32_t at = number; !is_opaque && at != RECORD_NONE;) {
        const Texture *texture = &scene->textures.items[at];
        bool is_plain = texture->pattern.type == PATTERN_NONE;
        is_opaque = !is_plain || pigment_is_opaque(scene, &texture->pigment);
        for (uint32_t one = is_plain ? RECORD_NONE : texture->entries; is_opaque && one != RECORD_NONE;) {
            const TextureEntry *entry = &scene->texture_entries.items[one];
            is_opaque = texture_is_opaque(scene, entry->texture);
            one = entry->next;
        }
        at = texture->below;
    }
    return is_opaque;
}

bool scene_material_is_opaque(const Scene *scene, MaterialIndex index)
{
    if (index & MATERIAL_COMPOUND) {
        const Compound *compound = &scene->compounds.items[index & ~MATERIAL_COMPOUND];
        return texture_is_opaque(scene, compound->texture) &&
               (compound->inner == RECORD_NONE || scene_material_is_opaque(scene, compound->inner));
    }
    const Material *material = &scene->materials.items[index];
    return material->filter == 0.0F && material->transmit == 0.0F;
}

bool scene_materials_are_alike(const Scene *scene, MaterialIndex a, MaterialIndex b)
{
    if (a == b || (a | b) & MATERIAL_COMPOUND) {
        return a == b; // what is made of textures is kept once
    }
    return memcmp(&scene->materials.items[a], &scene->materials.items[b], sizeof(Material)) == 0;
}
