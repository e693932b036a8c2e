// How large and how far the things of a scene are.
//
// Serves those who ask whether a program with fixed tolerances can draw the scene. Knows no such program.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SCENE_EXTENT_H
#define SCENE_SCENE_EXTENT_H

#include "scene/scene.h"

// Of the shapes but the planes; a sphere is taken as it is, others as the ball around their box. Where there is none,
// what is least is INFINITY and the rest 0.
typedef struct SceneExtent {
    double eye_offset;  // the greatest coordinate of the camera's place
    double least_size;  // the radius of the smallest
    double reach;       // from the camera to the farthest point of any
    double nearest_far; // from the camera to the nearest point of the one that is farthest so
    double least_angle; // the least radius / distance of its middle from the camera
} SceneExtent;

// Takes the camera to `factor` times its distance, along its direction, from the mean of the shapes' places. A
// perspective one zooms along.
void scene_move_camera(Scene *scene, double factor);

void scene_extent(const Scene *scene, SceneExtent *reach);

// Between what p·direction lies for the points of all shapes but planes. False when there are none.
bool scene_span(const Scene *scene, Vec3 direction, double *low, double *high);

#endif
