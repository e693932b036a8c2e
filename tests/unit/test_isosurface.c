// A line in isosurfaces of random waves: what is found and left out, beside the function itself in small steps; the
// same at sizes that are powers of two, bit for bit; and functions that are no number, or of a gradient that is too
// low.
//
// SPDX-License-Identifier: MIT
#include "scene/isosurface.h"

#include <stdlib.h>
#include <string.h>

#include "scene/form.h"
#include "scene/scene.h"
#include "trace/query.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WAVES = 3, STEPS = 9 * WAVES, LIST = ISOSURFACE_HEAD + ISOSURFACE_STEP * STEPS, PIECES = 20000 };

// Σ a sin(b x_i + c), whose gradient is at most Σ |a b|.
typedef struct Waves {
    double a[WAVES], b[WAVES], c[WAVES];
    unsigned axis[WAVES];
} Waves;

static long double waves_at(const Waves *w, const Ray *ray, long double t)
{
    const long double p[3] = {ray->origin.x + t * ray->direction.x, ray->origin.y + t * ray->direction.y,
                              ray->origin.z + t * ray->direction.z};
    long double sum = 0.0L;
    for (int i = 0; i < WAVES; i++) {
        sum += w->a[i] * sinl(w->b[i] * p[w->axis[i]] + w->c[i]);
    }
    return sum;
}

static Waves random_waves(Random *random)
{
    Waves w;
    for (int i = 0; i < WAVES; i++) {
        w.a[i] = random_between(random, -1.0, 1.0);
        w.b[i] = random_between(random, -6.0, 6.0);
        w.c[i] = random_between(random, -3.0, 3.0);
        w.axis[i] = random_below(random, 3);
    }
    return w;
}

static void make_list(const Waves *w, double accuracy, double share, double list[LIST])
{
    FormulaStep steps[STEPS];
    Isosurface head = {.accuracy = accuracy, .roots_most = 1, .generator = 1, .low = {-1, -1, -1}, .high = {1, 1, 1}};
    unsigned count = 0;
    memset(steps, 0, sizeof steps);
    for (int i = 0; i < WAVES; i++) {
        const FormulaStep own[] = {{.op = FORMULA_SLOT, .which = w->axis[i]},
                                   {.op = FORMULA_NUMBER, .number = w->b[i]},
                                   {.op = FORMULA_MUL},
                                   {.op = FORMULA_NUMBER, .number = w->c[i]},
                                   {.op = FORMULA_ADD},
                                   {.op = FORMULA_SIN},
                                   {.op = FORMULA_NUMBER, .number = w->a[i]},
                                   {.op = FORMULA_MUL}};
        memcpy(&steps[count], own, sizeof own);
        count += 8;
        if (i > 0) {
            steps[count++] = (FormulaStep){.op = FORMULA_ADD};
        }
        head.max_gradient += share * fabs(w->a[i] * w->b[i]);
    }
    for (unsigned i = 0; i < count; i++) {
        steps[i].next = i + 1 < count ? i + 1 : RECORD_NONE;
    }
    head.step_count = count;
    memcpy(list, &head, sizeof head);
    memcpy(list + ISOSURFACE_HEAD, steps, count * sizeof *steps);
}

// Whether the function stays on the other side for longer than `accuracy` before `to`.
static bool has_missed(const Waves *w, const Ray *ray, double to, double accuracy, bool up)
{
    double since = -1.0;
    for (int i = 1; i <= PIECES; i++) {
        double t = to * i / PIECES;
        bool is_over = (waves_at(w, ray, t) < 0.0L) != up;
        since = !is_over ? -1.0 : since < 0.0 ? t : since;
        if (is_over && t - since > accuracy * 1.01) {
            return true;
        }
    }
    return false;
}

static void test_lines(uint64_t seed)
{
    Random random = {seed};
    int wrong = 0, missed = 0, found = 0, none = 0, rays = getenv("CHECK_LONG") ? 5000 : 150;
    for (int i = 0; i < rays; i++) {
        double list[LIST], length = random_between(&random, 0.5, 3.0), accuracy = random_between(&random, 0.001, 0.02),
                           t;
        Waves w = random_waves(&random);
        make_list(&w, accuracy, 1.0, list);
        Vec3 origin = random_vec3(&random, -1.0, 1.0);
        Ray ray = {origin, vec3_normalize(random_vec3(&random, -1.0, 1.0))};
        IsosurfaceLine line = isosurface_line(list, NULL, ray, 1.0);
        bool up = isosurface_along(&line, 0.0) < 0.0;
        if (!isosurface_find(&line, 0.0, length, up, &t)) {
            missed += has_missed(&w, &ray, length, accuracy, up);
            none++;
            continue;
        }
        found++;
        wrong += (waves_at(&w, &ray, t) < 0.0L) == up || t > length;
        missed += t > accuracy && has_missed(&w, &ray, t - accuracy, accuracy, up);
        wrong += line.steepest > line.rise * (1.0 + 1e-9);
    }
    tap_ok(wrong == 0 && found > rays / 4, "where a surface is found the function has changed its sign (%d of %d)",
           wrong, found);
    tap_ok(missed == 0 && none > rays / 20, "no surface is passed over that is thicker than the accuracy (%d of %d)",
           missed, found + none);
}

static double hit_of(const double *list, uint64_t count, double size, int exponent, Ray ray)
{
    Scene scene;
    Hit hit = {.t = -1.0};
    Primitive primitive = part_empty(0);
    scene_init(&scene);
    primitive.kind = PRIMITIVE_ISOSURFACE;
    primitive.fixed[0] = vec3(-1.0, -1.0, -1.0);
    primitive.fixed[1] = vec3(1.0, 1.0, 1.0);
    primitive.list = (Numbers){list, count};
    primitive.to_world =
        transform_compose(transform_rotate(vec3(10.0, 20.0, 30.0)), transform_scale(vec3(size, size, size)));
    Geometry *geometry =
        part_finish(&primitive) && scene_add_primitive(&scene, &primitive) ? geometry_new(&scene, exponent) : NULL;
    if (!geometry || !geometry_closest(geometry, TRACE_PRIMITIVES, ray, RAY_START_FREE, (double)INFINITY, &hit)) {
        hit.t = -1.0;
    }
    geometry_free(geometry);
    scene_fini(&scene);
    return hit.t;
}

static void test_sizes(uint64_t seed)
{
    Random random = {seed};
    int different = 0, hits = 0;
    for (int i = 0; i < 100; i++) {
        double list[LIST], large[LIST], accuracy = random_between(&random, 0.001, 0.01);
        int k = (int)random_below(&random, 61) - 30, exponent = (int)random_below(&random, 9) - 4;
        Waves w = random_waves(&random);
        make_list(&w, accuracy, 1.0, list);
        make_list(&w, ldexp(accuracy, k), 1.0, large);
        uint64_t count = ISOSURFACE_HEAD + ISOSURFACE_STEP * (uint64_t)list[1];
        Vec3 from = vec3_scale(4.0, vec3_normalize(random_vec3(&random, -1.0, 1.0)));
        Vec3 towards = vec3_normalize(vec3_sub(random_vec3(&random, -0.7, 0.7), from));
        double one = hit_of(list, count, 1.0, 0, (Ray){from, towards});
        double other = hit_of(large, count, ldexp(1.0, k), exponent, (Ray){vec3_ldexp(from, k - exponent), towards});
        different += one < 0.0 ? other >= 0.0 : ldexp(other, exponent - k) != one;
        hits += one >= 0.0;
    }
    tap_ok(different == 0 && hits > 30, "the same at any size, but for powers of two (%d of %d are not)", different,
           hits);
}

static void test_no_numbers(void)
{
    double list[LIST], t;
    Waves w = {.a = {NAN, 1.0, 1.0}, .b = {1.0, 1.0, 1.0}};
    make_list(&w, 0.01, 1.0, list);
    IsosurfaceLine line = isosurface_line(list, NULL, (Ray){{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 1.0);
    tap_ok(!isosurface_find(&line, 0.0, 2.0, false, &t), "where the function is no number there is no surface");
    tap_ok(!isosurface_holds(list, NULL, vec3(0.0, 0.0, 0.0)), "and no inside");
    Waves plain = {.a = {1.0, 0.0, 0.0}, .b = {1.0, 1.0, 1.0}};
    make_list(&plain, 1e-300, 1.0, list);
    line = isosurface_line(list, NULL, (Ray){{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}, 1.0);
    tap_ok(isosurface_find(&line, 0.0, 2.0, false, &t) && fabs(t - 1.0) < 1e-15, "no accuracy is too fine to end");
    make_list(&plain, 0.001, 1e-9, list);
    line = isosurface_line(list, NULL, (Ray){{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}, 1.0);
    tap_ok(isosurface_find(&line, 0.0, 2.0, false, &t) && t > 1.0, "a gradient that is too low finds less, and ends");
    tap_ok(line.steepest > line.rise, "and is seen to be too low");
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    test_lines(seed);
    test_sizes(seed);
    test_no_numbers();
    return tap_done();
}
