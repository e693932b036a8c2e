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

#endif
