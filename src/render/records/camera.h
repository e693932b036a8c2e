// Camera rays: from the eye through screenCenter + x screenU + y screenV.
//
// Cameras that are wider have rays of their own, with u across and v upright, |R| and |U| the lengths of `right` and
// `up`, r, u^ and d unit vectors along `right`, `up` and `direction`, A the angle; all as measured in POV-Ray's
// pictures:
//   fisheye:           at the angle A sqrt((u |R|)² + (v |U|)²) to d, where the root is at most 1/2, turned as
//                      (u |R|, v |U|)
//   ultra wide angle:  sin(u A) r + sin(v A |U| / |R|) u^ + cos(u A) cos(v A |U| / |R|) d
//   panoramic:         sin(pi u) right + tan(pi v) up + cos(pi u) direction
//   omnimax:           as a fisheye, at the angle 1.411269 R - 0.09439 R³ + 0.25674 R⁵, R being the distance from the
//                      middle of a disc of radius 1 that is as wide as the picture, for the lens of N. Max, "Computer
//                      graphics distortion for IMAX and OMNIMAX projection", 1983; what is below is cut (camera.c)
//   cylinder 1:        sin(u A) r + v |U| u^ + cos(u A) d
//   cylinder 2:        u |R| r + sin(v A) u^ + cos(v A) d
//   cylinder 3:        sin(u A) r + cos(u A) d, from v up;   cylinder 4: sin(v A) u^ + cos(v A) d, from u right
//   spherical:         d turned about r by -v times the upright angle, then about u^ by u A, each from y to z, z to x,
//                      x to y
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_CAMERA_H
#define RENDER_RECORDS_CAMERA_H

#include <math.h>

#include "base/attributes.h"
#include "math/ray.h"
#include "render/points/sampler.h"
#include "render/records/prepared.h"

// The ray of a camera that is neither perspective nor orthographic; as camera_ray.
bool camera_wide_ray(const PreparedCamera *camera, double u, double v, Ray *ray);

// The ray of a point of the picture: u from -1/2 (left) to 1/2 (right), v from -1/2 (top) to 1/2 (bottom). False where
// nothing is seen; the ray is one then all the same.
RT_ALWAYS_INLINE bool camera_ray(const PreparedCamera *camera, double u, double v, Ray *ray)
{
    if (camera->type > CAMERA_ORTHOGRAPHIC) {
        return camera_wide_ray(camera, u, v, ray);
    }
    Vec3 across = vec3_sub(vec3_scale(u, camera->right), vec3_scale(v, camera->up));
    *ray = camera->type == CAMERA_ORTHOGRAPHIC
               ? (Ray){vec3_add(camera->location, across), camera->direction}
               : (Ray){camera->location, vec3_normalize(vec3_add(camera->direction, across))};
    return true;
}

// A point of the lens, evenly: P. Shirley and K. Chiu, "A low distortion map between disk and square", 1997.
static inline Vec3 camera_lens_point(const PreparedCamera *camera, SamplePoint at)
{
    const double quarter_turn = 0x1.921fb54442d18p-1; // pi / 4
    double a = 2.0 * at.x - 1.0, b = 2.0 * at.y - 1.0;
    bool is_wide = fabs(a) > fabs(b);
    double radius = is_wide ? a : b;
    double angle = radius == 0.0 ? 0.0 : quarter_turn * (is_wide ? b / a : a / b);
    double across = radius * (is_wide ? cos(angle) : sin(angle)), upward = radius * (is_wide ? sin(angle) : cos(angle));
    return vec3_add(camera->location,
                    vec3_add(vec3_scale(across, camera->lens_right), vec3_scale(upward, camera->lens_up)));
}

// The ray of a point of the picture through a point of the lens.
static inline Ray camera_lens_ray(const PreparedCamera *camera, double u, double v, Vec3 lens)
{
    Vec3 across = vec3_sub(vec3_scale(u, camera->right), vec3_scale(v, camera->up));
    Vec3 ahead = vec3_scale(camera->focal_scale, vec3_add(camera->direction, across));
    return (Ray){lens, vec3_normalize(vec3_sub(ahead, vec3_sub(lens, camera->location)))};
}

// The ray of the i-th of some places; as camera_ray.
RT_ALWAYS_INLINE bool camera_place_ray(const PreparedCamera *camera, const KernelPlaces *places, int i, Ray *ray)
{
    if (places->lens) {
        *ray = camera_lens_ray(camera, places->u[i], places->v[i], places->lens[i]);
        return true;
    }
    return camera_ray(camera, places->u[i], places->v[i], ray);
}

#endif
