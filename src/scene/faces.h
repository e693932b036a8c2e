// Warnings of flat faces that coincide; see scene/faces.c.
//
// Turns the planes and parts of a scene into located warnings. Changes nothing.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_FACES_H
#define SCENE_FACES_H

#include "base/attributes.h"
#include "scene/scene.h"

// Warns of shapes that stand alone and have faces of different materials in one plane, turned to the camera, which
// overlap. About n log n in the number of faces. False when out of memory.
bool scene_warn_of_faces(const Scene *scene, DiagSink *diags) RT_MUST_CHECK;

#endif
