// The rays of wide cameras; see camera.h.
//
// SPDX-License-Identifier: MIT
#include "render/records/camera.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

// a r + b u + c d, with unit vectors along the camera's.
static Vec3 combine(const PreparedCamera *camera, double a, double b, double c)
{
    return vec3_add_scaled(vec3_add_scaled(vec3_scale(a, camera->across), b, camera->upright), c, camera->ahead);
}

static bool fisheye(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    double x = u * camera->width, y = v * camera->height;
    double radius = sqrt(x * x + y * y), polar = radius * camera->angle;
    double across = radius > 0.0 ? sin(polar) / radius : 0.0;
    *direction = combine(camera, across * x, across * y, cos(polar));
    return radius <= 0.5;
}

static bool ultra_wide_angle(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    double x = u * camera->angle, y = v * camera->angle * camera->height / camera->width;
    *direction = combine(camera, sin(x), sin(y), cos(x) * cos(y));
    return true;
}

static bool panoramic(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    Vec3 across = vec3_scale(sin(pi * u), camera->right);
    *direction = vec3_add_scaled(vec3_add_scaled(across, tan(pi * v), camera->up), cos(pi * u), camera->direction);
    return true;
}

// A vector turned about a unit vector (O. Rodrigues, 1840).
static Vec3 turn(Vec3 vector, Vec3 about, double angle)
{
    Vec3 turned = vec3_add_scaled(vec3_scale(cos(angle), vector), sin(angle), vec3_cross(about, vector));
    return vec3_add_scaled(turned, (1.0 - cos(angle)) * vec3_dot(about, vector), about);
}

static bool spherical(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    Vec3 risen = turn(camera->ahead, camera->across, -v * camera->angle_vertical);
    *direction = turn(risen, camera->upright, u * camera->angle);
    return true;
}

typedef bool (*DirectionFunction)(const PreparedCamera *camera, double u, double v, Vec3 *direction);

bool camera_wide_direction(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    static const DirectionFunction functions[CAMERA_TYPES] = {
        [CAMERA_FISHEYE] = fisheye,
        [CAMERA_ULTRA_WIDE_ANGLE] = ultra_wide_angle,
        [CAMERA_PANORAMIC] = panoramic,
        [CAMERA_SPHERICAL] = spherical,
    };
    bool is_seen = functions[camera->type](camera, u, -v, direction);
    double length = vec3_length(*direction);
    if (!(length > 0.0)) { // of vectors that span nothing
        *direction = camera->ahead;
        return false;
    }
    *direction = vec3_scale(1.0 / length, *direction);
    return is_seen;
}
