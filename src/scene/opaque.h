// What can be said of a surface's look without tracing it.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_OPAQUE_H
#define SCENE_OPAQUE_H

#include "scene/scene.h"

// True when the texture surely lets no light through, at no point.
bool scene_material_is_opaque(const Scene *scene, MaterialIndex index);

// True when two surfaces of these materials surely look the same at the same point.
bool scene_materials_are_alike(const Scene *scene, MaterialIndex a, MaterialIndex b);

#endif
