// Looks at each axis by itself, then moves all places along those that gain.
//
// SPDX-License-Identifier: MIT
#include "scene/recentre.h"

#include <math.h>

enum { GAIN_LEAST = 16 }; // four bits; below, a scene stays as it is written

typedef struct Axis {
    double origin;
    double greatest, left; // coordinates before and after
    bool is_exact;
} Axis;

// The error of a rounded difference (Møller, Knuth) is 0 where it is exact.
static void axis_add(Axis *axis, double coordinate)
{
    double difference = coordinate - axis->origin;
    double part = difference - coordinate;
    double error = (coordinate - (difference - part)) + (-axis->origin - part);
    axis->is_exact = axis->is_exact && error == 0.0;
    axis->greatest = fmax(axis->greatest, fabs(coordinate));
    axis->left = fmax(axis->left, fabs(difference));
}

static double coordinate_of(const Vec3 *place, int axis)
{
    return axis == 0 ? place->x : axis == 1 ? place->y : place->z;
}

// A plane that is at right angles to the axis moves as a point does; one that is slanted to it keeps it from moving.
static void axis_add_plane(Axis *axis, int number, const Vec3 *normal, double distance)
{
    double along = coordinate_of(normal, number);
    if (fabs(along) == 1.0) {
        axis_add(axis, along * distance);
    } else if (along != 0.0) {
        axis->is_exact = false;
    }
}

static void axis_add_spheres(Axis *axis, const Scene *scene, int number)
{
    for (size_t i = 0; axis->is_exact && i < scene->spheres.count; i++) {
        axis_add(axis, coordinate_of(&scene->spheres.items[i].centre, number));
    }
}

// `spheres`: what decides of them, where not all are here; or NULL.
static bool axis_gains(const Scene *scene, int number, const RecentreAxis *spheres)
{
    double origin = coordinate_of(&scene->camera.location, number);
    Axis axis = {origin, fabs(origin), 0.0, origin != 0.0};
    if (spheres) {
        axis.greatest = fmax(axis.greatest, spheres->greatest);
        axis.left = spheres->left;
        axis.is_exact = axis.is_exact && spheres->is_exact;
    } else {
        axis_add_spheres(&axis, scene, number);
    }
    for (size_t i = 0; axis.is_exact && i < scene->lights.count; i++) {
        const Light *light = &scene->lights.items[i];
        axis_add(&axis, coordinate_of(&light->position, number));
        if (light->type != LIGHT_POINT) {
            axis_add(&axis, coordinate_of(&light->point_at, number));
        }
    }
    for (size_t i = 0; axis.is_exact && i < scene->planes.count; i++) {
        axis_add_plane(&axis, number, &scene->planes.items[i].normal, scene->planes.items[i].distance);
    }
    for (size_t i = 0; axis.is_exact && i < scene->primitives.count; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (primitive->kind == PRIMITIVE_PLANE) {
            axis_add_plane(&axis, number, &primitive->data[0], primitive->data[1].x);
        } else {
            axis_add(&axis, primitive->to_world.m[3][number]);
        }
    }
    return axis.is_exact && axis.left * GAIN_LEAST <= axis.greatest;
}

static void move_row(double row[3], Vec3 by)
{
    row[0] += by.x;
    row[1] += by.y;
    row[2] += by.z;
}

// All that has a place. The inverses of transforms are asked for their linear parts only, once a scene is made.
static void move(Scene *scene, Vec3 by)
{
    scene->camera.location = vec3_add(scene->camera.location, by);
    for (size_t i = 0; i < scene->lights.count; i++) {
        Light *light = &scene->lights.items[i];
        light->position = vec3_add(light->position, by);
        if (light->type != LIGHT_POINT) {
            light->point_at = vec3_add(light->point_at, by);
        }
    }
    scene_spheres_change(scene);
    for (size_t i = 0; i < scene->spheres.count; i++) {
        scene->spheres.items[i].centre = vec3_add(scene->spheres.items[i].centre, by);
    }
    for (size_t i = 0; i < scene->planes.count; i++) {
        scene->planes.items[i].distance += vec3_dot(scene->planes.items[i].normal, by);
    }
    for (size_t i = 0; i < scene->primitives.count; i++) {
        Primitive *primitive = &scene->primitives.items[i];
        if (primitive->kind == PRIMITIVE_PLANE) {
            primitive->data[1].x += vec3_dot(primitive->data[0], by);
        } else {
            move_row(primitive->to_world.m[3], by);
        }
    }
    for (size_t i = 0; i < scene->start_shapes.count; i++) {
        StartShape *shape = &scene->start_shapes.items[i];
        shape->low = vec3_add(shape->low, by);
        shape->high = vec3_add(shape->high, by);
    }
}

// Whether the noise of a finish depends on where in the scene a place is.
static bool has_places(const Scene *scene)
{
    bool found = false;
    for (size_t i = 0; !found && i < scene->finishes.count; i++) {
        found = scene->finishes.items[i].irid > 0.0 && scene->finishes.items[i].irid_turbulence != 0.0;
    }
    return found;
}

void scene_recentre_measure(const Scene *scene, RecentreAxis axes[3])
{
    for (int number = 0; number < 3; number++) {
        double origin = coordinate_of(&scene->camera.location, number);
        Axis axis = {origin, 0.0, 0.0, origin != 0.0};
        axis_add_spheres(&axis, scene, number);
        axes[number] = (RecentreAxis){axis.greatest, axis.left, axis.is_exact};
    }
}

void scene_recentre_join(RecentreAxis axes[3], const RecentreAxis more[3])
{
    for (int number = 0; number < 3; number++) {
        axes[number].greatest = fmax(axes[number].greatest, more[number].greatest);
        axes[number].left = fmax(axes[number].left, more[number].left);
        axes[number].is_exact = axes[number].is_exact && more[number].is_exact;
    }
}

static Vec3 recentre(Scene *scene, const RecentreAxis *spheres)
{
    Vec3 origin = {0.0, 0.0, 0.0};
    if (scene->compounds.count > 0 || scene->fogs.count > 0 || has_places(scene)) {
        return origin;
    }
    origin.x = axis_gains(scene, 0, spheres ? &spheres[0] : NULL) ? scene->camera.location.x : 0.0;
    origin.y = axis_gains(scene, 1, spheres ? &spheres[1] : NULL) ? scene->camera.location.y : 0.0;
    origin.z = axis_gains(scene, 2, spheres ? &spheres[2] : NULL) ? scene->camera.location.z : 0.0;
    if (!vec3_equal(origin, vec3(0.0, 0.0, 0.0))) {
        move(scene, vec3_neg(origin));
    }
    return origin;
}

Vec3 scene_recentre(Scene *scene)
{
    return recentre(scene, NULL);
}

Vec3 scene_recentre_share(Scene *scene, const RecentreAxis spheres[3])
{
    return recentre(scene, spheres);
}

void scene_move_back(Scene *scene, Vec3 origin)
{
    if (!vec3_equal(origin, vec3(0.0, 0.0, 0.0))) {
        move(scene, origin);
    }
}
