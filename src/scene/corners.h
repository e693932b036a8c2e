// Textures that are weighed by where a point is: averages whose Pattern.count says how.
//
// Of a face with other textures at its corners it is PATTERN_CORNERS: in the space of the pattern x and y are the
// weights of the second and the third corner. Of a blob whose components have textures it is PATTERN_FIELDS: the
// pattern's space is the blob's own, and each component of Scene.blobs[image] weighs as much as its field, whatever its
// sign. The first entry is the texture of those that have none, as it lies around the pattern; the others are in it.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_CORNERS_H
#define SCENE_CORNERS_H

#include "scene/scene.h"

enum { PATTERN_CORNERS = 3, PATTERN_FIELDS = 4 };

static inline bool texture_is_of_corners(const Texture *texture)
{
    return texture->pattern.type == PATTERN_AVERAGE && texture->pattern.count == PATTERN_CORNERS;
}

static inline bool texture_is_of_fields(const Texture *texture)
{
    return texture->pattern.type == PATTERN_AVERAGE && texture->pattern.count == PATTERN_FIELDS;
}

#endif
