// Camera rays: from the eye through screenCenter + x screenU + y screenV.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_CAMERA_H
#define RENDER_CAMERA_H

#include "base/attributes.h"
#include "math/ray.h"
#include "render/prepared.h"

// The ray of a point of the picture: u from -1/2 (left) to 1/2 (right), v from -1/2 (top) to 1/2 (bottom).
RT_ALWAYS_INLINE Ray camera_ray(const PreparedCamera *camera, double u, double v)
{
    Vec3 across = vec3_sub(vec3_scale(u, camera->right), vec3_scale(v, camera->up));
    if (camera->type == CAMERA_ORTHOGRAPHIC) {
        return (Ray){vec3_add(camera->location, across), camera->direction};
    }
    return (Ray){camera->location, vec3_normalize(vec3_add(camera->direction, across))};
}

#endif
