// For tests/system/check_instructions.py: a loop over spheres with the textbook's test, and the same with ours, so that
// callgrind can count the instructions of each. Prints how many rays hit, and how many tests doubles alone could not
// decide.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>

#include "trace/sphere.h"
#include "unit/random.h"

enum { SPHERES = 200, RAYS = 2000 };

// What both loops are called with.
typedef struct Counted {
    int hits, doubtful;
} Counted;

double count_textbook(const SphereData *balls, Ray ray) __attribute__((noinline));
double count_certified(const SphereData *balls, Ray ray, int *doubtful) __attribute__((noinline));

// a t² + b t + c = 0 by b² - 4ac, as lectures have it.
double count_textbook(const SphereData *balls, Ray ray)
{
    double nearest = (double)INFINITY;
    double a = vec3_dot(ray.direction, ray.direction);
    for (int i = 0; i < SPHERES; i++) {
        Vec3 f = vec3_sub(ray.origin, balls[i].centre);
        double b = 2.0 * vec3_dot(f, ray.direction);
        double c = vec3_dot(f, f) - balls[i].radius_squared;
        double discriminant = b * b - 4.0 * a * c;
        if (discriminant < 0.0) {
            continue;
        }
        double root = sqrt(discriminant);
        double t = (-b - root) / (2.0 * a);
        t = t > 0.0 ? t : (-b + root) / (2.0 * a);
        nearest = t > 0.0 && t < nearest ? t : nearest;
    }
    return nearest;
}

double count_certified(const SphereData *balls, Ray ray, int *doubtful)
{
    double nearest = (double)INFINITY;
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    for (int i = 0; i < SPHERES; i++) {
        double t;
        bool inside;
        SphereVerdict verdict = sphere_test(&sphere_ray, &balls[i], &t, &inside);
        if (verdict == SPHERE_MISS) {
            continue;
        }
        if (verdict == SPHERE_UNCERTAIN) {
            ++*doubtful;
            t = sphere_exact(&sphere_ray, &balls[i], NULL, &inside);
        }
        nearest = t > 0.0 && t < nearest ? t : nearest;
    }
    return nearest;
}

int main(void)
{
    Random random = {5};
    SphereData balls[SPHERES];
    Counted textbook = {0}, certified = {0};
    for (int i = 0; i < SPHERES; i++) {
        double away = random_between(&random, 0, 10);
        Vec3 centre = vec3_scale(away, random_direction(&random));
        balls[i] = sphere_data_make(centre, random_between(&random, 0.1, 1));
    }
    for (int i = 0; i < RAYS; i++) {
        Ray ray = {vec3_scale(15, random_direction(&random)), {0, 0, 0}};
        Vec3 aim = vec3_scale(8, random_direction(&random));
        ray.direction = vec3_normalize(vec3_sub(aim, ray.origin));
        textbook.hits += isfinite(count_textbook(balls, ray));
        certified.hits += isfinite(count_certified(balls, ray, &certified.doubtful));
    }
    printf("%d %d %d\n", textbook.hits, certified.hits, certified.doubtful);
    return 0;
}
