// The texture of a face with other textures at its corners: an average whose Pattern.count is PATTERN_CORNERS. In the
// space of its pattern x and y are the weights of the second and the third corner.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_CORNERS_H
#define SCENE_CORNERS_H

#include "scene/scene.h"

enum { PATTERN_CORNERS = 3 };

static inline bool texture_is_of_corners(const Texture *texture)
{
    return texture->pattern.type == PATTERN_AVERAGE && texture->pattern.count == PATTERN_CORNERS;
}

#endif
