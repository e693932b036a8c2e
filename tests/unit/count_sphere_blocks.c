// For tests/system/check_instructions.py: the vector loop over blocks of spheres as the tracer has it, and the same
// loop with the textbook's test, so that callgrind can count the instructions of each.
//
// The tracer's file itself is compiled in here, for one instruction set. Prints how many spheres each loop says are
// met, and how many tests doubles alone could not decide.
//
// SPDX-License-Identifier: MIT
#define ISA_NAME counted
#include "trace/spheres_kernel.c"

#include <stdio.h>

#include "unit/random.h"

enum { BLOCKS = 25, RAYS = 2000 };

double count_textbook(const SphereBlock *blocks, const Ray *ray, int *met) __attribute__((noinline));
double count_certified(const SphereBlock *blocks, const Ray *ray, int *met, int *doubtful) __attribute__((noinline));

// b² - 4ac eight times over: the nearest root in front, infinite where there is none.
RT_ALWAYS_INLINE bool textbook_block(const SphereBlock *block, const Ray *ray, double a, double limit, BlockHits *hits)
{
    Doubles b[HALVES], discriminant[HALVES];
    unsigned possible = 0;
#pragma GCC unroll 4
    for (int i = 0; i < HALVES; i++) {
        Doubles fx = ray->origin.x - doubles_load(&block->x[i * DOUBLES]);
        Doubles fy = ray->origin.y - doubles_load(&block->y[i * DOUBLES]);
        Doubles fz = ray->origin.z - doubles_load(&block->z[i * DOUBLES]);
        b[i] = 2.0 * (fx * ray->direction.x + fy * ray->direction.y + fz * ray->direction.z);
        Doubles c = fx * fx + fy * fy + fz * fz - doubles_load(&block->radius_squared[i * DOUBLES]);
        discriminant[i] = b[i] * b[i] - 4.0 * a * c;
        possible |= doubles_ge(discriminant[i], doubles_splat(0.0)) << (i * DOUBLES);
    }
    if (!possible) {
        return false;
    }
    unsigned ahead = 0;
#pragma GCC unroll 4
    for (int i = 0; i < HALVES; i++) {
        Doubles root = doubles_sqrt(discriminant[i]);
        Doubles first = (-b[i] - root) / (2.0 * a), second = (-b[i] + root) / (2.0 * a);
        Doubles t = doubles_if_negative(first, second, first);
        doubles_store(&hits->t[i * DOUBLES], t);
        ahead |= (doubles_ge(t, doubles_splat(0.0)) & doubles_ge(doubles_splat(limit), t)) << (i * DOUBLES);
    }
    hits->met = possible & ahead;
    return hits->met != 0;
}

double count_textbook(const SphereBlock *blocks, const Ray *ray, int *met)
{
    double nearest = (double)INFINITY, a = vec3_length_squared(ray->direction);
    for (int i = 0; i < BLOCKS; i++) {
        BlockHits hits;
        if (textbook_block(&blocks[i], ray, a, nearest, &hits)) {
            for (; hits.met; hits.met &= hits.met - 1) {
                nearest = fmin(nearest, hits.t[__builtin_ctz(hits.met)]);
                ++*met;
            }
        }
    }
    return nearest;
}

double count_certified(const SphereBlock *blocks, const Ray *ray, int *met, int *doubtful)
{
    double nearest = (double)INFINITY;
    SphereRay sphere_ray = sphere_ray_make(ray->origin, ray->direction);
    for (int i = 0; i < BLOCKS; i++) {
        BlockHits hits;
        if (block_test(&blocks[i], &sphere_ray, ~0u, nearest, &hits)) {
            *doubtful += __builtin_popcount(hits.uncertain);
            for (; hits.met; hits.met &= hits.met - 1) {
                nearest = fmin(nearest, hits.t[__builtin_ctz(hits.met)]);
                ++*met;
            }
        }
    }
    return nearest;
}

int main(void)
{
    static SphereBlock blocks[BLOCKS];
    Random random = {5};
    int met[2] = {0, 0}, doubtful = 0, differ = 0;
    for (int i = 0; i < BLOCKS * SPHERE_BLOCK; i++) {
        SphereBlock *block = &blocks[i / SPHERE_BLOCK];
        double away = random_between(&random, 0, 10);
        Vec3 centre = vec3_scale(away, random_direction(&random));
        double radius = random_between(&random, 0.1, 1);
        block->x[i % SPHERE_BLOCK] = centre.x;
        block->y[i % SPHERE_BLOCK] = centre.y;
        block->z[i % SPHERE_BLOCK] = centre.z;
        block->radius_squared[i % SPHERE_BLOCK] = radius * radius;
    }
    for (int i = 0; i < RAYS; i++) {
        Ray ray = {vec3_scale(15, random_direction(&random)), {0, 0, 0}};
        Vec3 aim = vec3_scale(8, random_direction(&random));
        ray.direction = vec3_normalize(vec3_sub(aim, ray.origin));
        double textbook = count_textbook(blocks, &ray, &met[0]),
               ours = count_certified(blocks, &ray, &met[1], &doubtful);
        differ += isfinite(textbook) != isfinite(ours);
    }
    printf("%d %d %d\n", met[0], met[1] + differ, doubtful);
    return 0;
}
