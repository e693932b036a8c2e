// One pass over all shapes. A planet is as far as its ground is, a small ball far away as far as its middle.
//
// SPDX-License-Identifier: MIT
#include "scene/scene_extent.h"

#include <math.h>

#include "scene/primitive_reach.h"

// Where squares would not fit, too.
static double length_of(Vec3 a)
{
    return hypot(hypot(a.x, a.y), a.z);
}

static void reach_add(SceneExtent *reach, Vec3 eye, Vec3 centre, double radius)
{
    double distance = length_of(vec3_sub(centre, eye));

    reach->least_size = fmin(reach->least_size, radius);
    reach->least_angle = fmin(reach->least_angle, radius / distance);
    reach->reach = fmax(reach->reach, distance + radius);
    reach->nearest_far = fmax(reach->nearest_far, distance - radius);
}

// The ball around the box around a primitive; what is endless has none.
static void reach_add_part(SceneExtent *reach, Vec3 eye, const Primitive *primitive)
{
    static const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double middle[3], half[3];

    if (primitive_is_endless(primitive)) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        double high = primitive_support(primitive, axes[i]), low = -primitive_support(primitive, vec3_neg(axes[i]));
        middle[i] = 0.5 * (high + low);
        half[i] = 0.5 * (high - low);
    }
    reach_add(reach, eye, vec3(middle[0], middle[1], middle[2]), length_of(vec3(half[0], half[1], half[2])));
}

void scene_extent(const Scene *scene, SceneExtent *reach)
{
    Vec3 eye = scene->camera.location;

    *reach = (SceneExtent){.least_size = (double)INFINITY, .least_angle = (double)INFINITY};
    reach->eye_offset = vec3_max_abs(eye);
    for (size_t i = 0; i < scene->spheres.count; i++) {
        reach_add(reach, eye, scene->spheres.items[i].centre, scene->spheres.items[i].radius);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        reach_add_part(reach, eye, &scene->primitives.items[i]);
    }
}

bool scene_span(const Scene *scene, Vec3 direction, double *low, double *high)
{
    double length = length_of(direction);
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (size_t i = 0; i < scene->spheres.count; i++) {
        const Sphere *sphere = &scene->spheres.items[i];
        double middle = vec3_dot(sphere->centre, direction), aside = sphere->radius * length;
        *low = fmin(*low, middle - aside);
        *high = fmax(*high, middle + aside);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (!primitive_is_endless(primitive)) {
            double least, most;
            primitive_span(primitive, direction, &least, &most);
            *low = fmin(*low, least);
            *high = fmax(*high, most);
        }
    }
    return *low <= *high;
}

static void mean_add(Vec3 *sum, size_t *count, Vec3 place)
{
    *sum = vec3_add(*sum, place);
    ++*count;
}

static Vec3 transform_place(const Transform *to_world)
{
    return vec3(to_world->m[3][0], to_world->m[3][1], to_world->m[3][2]);
}

void scene_move_camera(Scene *scene, double factor)
{
    Camera *camera = &scene->camera;
    Vec3 sum = {0, 0, 0}, direction = vec3_scale(1.0 / length_of(camera->direction), camera->direction);
    size_t count = 0;

    for (size_t i = 0; i < scene->spheres.count; i++) {
        mean_add(&sum, &count, scene->spheres.items[i].centre);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        if (scene->primitives.items[i].kind != PRIMITIVE_PLANE) {
            mean_add(&sum, &count, transform_place(&scene->primitives.items[i].to_world));
        }
    }
    Vec3 middle = count > 0 ? vec3_scale(1.0 / (double)count, sum) : vec3_add(camera->location, direction);
    double distance = fabs(vec3_dot(vec3_sub(middle, camera->location), direction));
    camera->location = vec3_add_scaled(camera->location, (1.0 - factor) * distance, direction);
    if (camera->type == CAMERA_PERSPECTIVE) {
        camera->direction = vec3_scale(factor, camera->direction);
    }
}
