// Hints about what the camera sees, for those who ask for all warnings.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_VIEW_H
#define SCENE_VIEW_H

#include "scene/scene.h"

// Reports a camera that sees no shape, one in a sphere that hides everything, and a picture of `width` by `height`
// pixels whose sides are not those of the camera's screen. Says nothing where it is not sure, and costs nothing where
// none of these is requested.
void scene_hint_of_view(const Scene *scene, int width, int height, DiagSink *diags);

// The first sphere that such a camera sees, about; their number where there is none.
size_t scene_first_seen(const Scene *scene);

#endif
