// The last shapes of a scene: taken away again, and compared, for scenes of which the rest stays as it is.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_TAIL_H
#define SCENE_TAIL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "scene/scene.h"

// Takes away all shapes but the first `count` in the order of declaration. What shapes have in common, as materials, stays.
void scene_keep_shapes(Scene *scene, uint32_t count);

// Whether the shapes from `second` on are those from `first` up to `second` again, wherever in the text they stand.
bool scene_repeats_shapes(const Scene *scene, uint32_t first, uint32_t second) RT_MUST_CHECK;

#endif
