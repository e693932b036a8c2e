// A scene far from the origin, put near it for as long as it is traced.
//
// Moves the camera's place to the origin along those axes where every difference of coordinates is exact and the
// greatest coordinate becomes much less, so that points on surfaces are rounded to the scene's own size and not to its
// distance from the origin. Exact, so the way back is, too. Scenes whose look depends on places (textures, interiors,
// fog) stay.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_RECENTRE_H
#define SCENE_RECENTRE_H

#include "scene/scene.h"

// What decides of an axis.
typedef struct RecentreAxis {
    double greatest, left; // coordinates before and after
    bool is_exact;
} RecentreAxis;

// Of the spheres of a part of a scene, and of two primitives together.
void scene_recentre_measure(const Scene *scene, RecentreAxis axes[3]);
void scene_recentre_join(RecentreAxis axes[3], const RecentreAxis more[3]);

// As scene_recentre, of a scene whose spheres are those measured, some of which are here.
Vec3 scene_recentre_share(Scene *scene, const RecentreAxis spheres[3]);

// Moves a valid scene; returns what was subtracted from all places, 0 along axes that stay.
Vec3 scene_recentre(Scene *scene);

// The scene as it was before.
void scene_move_back(Scene *scene, Vec3 origin);

#endif
