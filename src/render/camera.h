// Camera rays: from the eye through screenCenter + x screenU + y screenV.
//
// Cameras that are wider have rays of their own, with u across and v upright, |R| and |U| the lengths of `right` and `up`,
// r, u^ and d unit vectors along `right`, `up` and `direction`, A the angle; all measured beside POV-Ray:
//   fisheye:           at the angle A sqrt((u |R|)² + (v |U|)²) to d, where the root is at most 1/2, turned as (u |R|, v |U|)
//   ultra wide angle:  sin(u A) r + sin(v A |U| / |R|) u^ + cos(u A) cos(v A |U| / |R|) d
//   panoramic:         sin(pi u) right + tan(pi v) up + cos(pi u) direction
//   spherical:         d turned about r by -v times the upright angle, then about u^ by u A, each from y to z, z to x, x to y
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_CAMERA_H
#define RENDER_CAMERA_H

#include "base/attributes.h"
#include "math/ray.h"
#include "render/prepared.h"

// The direction of a camera that is neither perspective nor orthographic; as camera_ray.
bool camera_wide_direction(const PreparedCamera *camera, double u, double v, Vec3 *direction);

// The ray of a point of the picture: u from -1/2 (left) to 1/2 (right), v from -1/2 (top) to 1/2 (bottom). False where
// nothing is seen; the ray is one then all the same.
RT_ALWAYS_INLINE bool camera_ray(const PreparedCamera *camera, double u, double v, Ray *ray)
{
    if (camera->type > CAMERA_ORTHOGRAPHIC) {
        ray->origin = camera->location;
        return camera_wide_direction(camera, u, v, &ray->direction);
    }
    Vec3 across = vec3_sub(vec3_scale(u, camera->right), vec3_scale(v, camera->up));
    *ray = camera->type == CAMERA_ORTHOGRAPHIC
               ? (Ray){vec3_add(camera->location, across), camera->direction}
               : (Ray){camera->location, vec3_normalize(vec3_add(camera->direction, across))};
    return true;
}

#endif
