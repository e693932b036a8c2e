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

// A picture that is wider than high shows no more below than can be seen: what is 45 degrees below the middle, where R
// is about 0.5583. Measured.
static bool omnimax(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    const double below = 0.55829;
    bool is_wide = camera->width > camera->height;
    double high = is_wide ? 1.0 + below : 2.0 * camera->height / camera->width;
    double x = u * (is_wide ? high * camera->width / camera->height : 2.0);
    double y = v * high + (is_wide ? (1.0 - below) / 2.0 : 0.0);
    double radius = sqrt(x * x + y * y), square = radius * radius;
    double polar = radius * (1.411269 + square * (-0.09439 + square * 0.25674));
    double across = radius > 0.0 ? sin(polar) / radius : 0.0;
    *direction = combine(camera, across * x, across * y, cos(polar));
    return radius <= 1.0 && across * y >= -cos(polar);
}

static bool cylinder_upright(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    bool is_fixed = camera->type == CAMERA_CYLINDER_1;
    *direction = combine(camera, sin(u * camera->angle), is_fixed ? v * camera->height : 0.0, cos(u * camera->angle));
    return true;
}

static bool cylinder_lying(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    bool is_fixed = camera->type == CAMERA_CYLINDER_2;
    *direction = combine(camera, is_fixed ? u * camera->width : 0.0, sin(v * camera->angle), cos(v * camera->angle));
    return true;
}

// Bumps take the direction for a normal.
static bool bumpy(const PreparedCamera *camera, double u, double v, Vec3 *direction)
{
    Vec3 plain = camera->direction;
    if (camera->through == CAMERA_PERSPECTIVE) {
        plain = vec3_add_scaled(vec3_add_scaled(plain, u, camera->right), v, camera->up);
    }
    *direction = texture_bent(camera->textures, camera->bumps, vec3(u, v, 0.0), vec3_normalize(plain));
    return true;
}

typedef bool (*DirectionFunction)(const PreparedCamera *camera, double u, double v, Vec3 *direction);

// Of a camera that moves.
static Vec3 origin_of(const PreparedCamera *camera, double u, double v)
{
    Vec3 across = vec3_add_scaled(camera->location, u, camera->right);
    return camera->through == CAMERA_CYLINDER_3     ? vec3_add_scaled(camera->location, -v, camera->up)
           : camera->through == CAMERA_CYLINDER_4   ? across
           : camera->through == CAMERA_ORTHOGRAPHIC ? vec3_add_scaled(across, -v, camera->up)
                                                    : camera->location;
}

bool camera_wide_ray(const PreparedCamera *camera, double u, double v, Ray *ray)
{
    Vec3 *direction = &ray->direction;
    ray->origin = origin_of(camera, u, v);
    static const DirectionFunction functions[CAMERA_TYPES] = {
        [CAMERA_FISHEYE] = fisheye,
        [CAMERA_ULTRA_WIDE_ANGLE] = ultra_wide_angle,
        [CAMERA_PANORAMIC] = panoramic,
        [CAMERA_SPHERICAL] = spherical,
        [CAMERA_OMNIMAX] = omnimax,
        [CAMERA_CYLINDER_1] = cylinder_upright,
        [CAMERA_CYLINDER_2] = cylinder_lying,
        [CAMERA_CYLINDER_3] = cylinder_upright,
        [CAMERA_CYLINDER_4] = cylinder_lying,
        [CAMERA_BUMPY] = bumpy,
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
