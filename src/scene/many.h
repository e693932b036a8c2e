// Many plain spheres of one material, one after the other.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_MANY_H
#define SCENE_MANY_H

#include "scene/scene.h"

// So many more take the material that was asked for last: as that many calls of scene_add_material_record, each of which
// would find it there.
static inline void scene_repeat_material(Scene *scene, size_t times)
{
    scene->material_index.found += scene->material_index.is_given_up ? 0 : times;
}

// As scene_add_material_record, of one that is not the one that was asked for last.
static inline bool scene_add_other_material(Scene *scene, const Material *material, MaterialIndex *index)
{
    size_t count = scene->materials.count;
    if (!scene->material_index.is_given_up || count >= scene->materials.capacity || count >= MATERIAL_COMPOUND) {
        return scene_add_material_record(scene, material, index);
    }
    scene->materials.items[count] = *material;
    scene->materials.count++;
    *index = scene->material_index.last = (MaterialIndex)count;
    return true;
}

#endif
