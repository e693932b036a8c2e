// Pictures laid over surfaces: the colour that a picture has at a point in its own space.
//
// Projections, edges and interpolations are those that were measured of the reference, docs/language.md, "Pictures".
// Refers to the scene, whose pictures must be loaded and which must outlive it. Read-only once made.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_IMAGE_H
#define RENDER_SURFACE_IMAGE_H

#include <stdbool.h>

#include "base/attributes.h"
#include "math/colour.h"
#include "math/vec3.h"
#include "scene/scene.h"

typedef struct PreparedImage {
    const Picture *picture;
    ImageMap map;
    PictureColour *palette;  // with what the map says of its places; owned, NULL without one
    double filter, transmit; // of every pixel of a picture without a palette, besides what its alpha says
} PreparedImage;

// One for each of the scene's image maps; NULL when out of memory.
PreparedImage *images_new(const Scene *scene) RT_MUST_CHECK;
void images_free(PreparedImage *images, size_t count);

// Whether light may come through somewhere, but for single points that a projection does not reach.
bool image_is_transparent(const PreparedImage *image);

Rgbft image_colour(const PreparedImage *image, Vec3 point);

// Of a picture that tells numbers: what it tells, 0 where there is none; the number of one of `count` textures; and what
// its heights, `amount` times as high, make of a normal.
double image_value(const PreparedImage *image, Vec3 point);
uint32_t image_number(const PreparedImage *image, Vec3 point, uint32_t count);
Vec3 image_bumped(const PreparedImage *image, double amount, Vec3 point, Vec3 normal);

// Of values that fill the cube from 0 to 1, 0 elsewhere; `how` is Pattern.count.
double image_density(const PreparedImage *image, int how, Vec3 point);

#endif
