// Figures of docs/sampling.md that no test judges, which bench/sampling.py puts there.
//
//     measure goals                      how many more samples runs to a goal take than such an error does in the mean
//     measure edges [SCENE]              what strata at spheres' edges bring, and what they cost
//
// The linker puts __wrap_share_new in the place of share_new (tests/local.mk), so that a run may do without strata.
//
// SPDX-License-Identifier: MIT
#include "sampling/grid.h"
#include "sampling/scenes.h"

typedef struct Share Share;
typedef struct Prepared Prepared;
typedef struct Film Film;

Share *__real_share_new(const Prepared *prepared, const Film *film, bool *has_memory);
Share *__wrap_share_new(const Prepared *prepared, const Film *film, bool *has_memory);

static bool is_plain;

Share *__wrap_share_new(const Prepared *prepared, const Film *film, bool *has_memory)
{
    if (is_plain) {
        *has_memory = true;
        return NULL;
    }
    return __real_share_new(prepared, film, has_memory);
}

// Runs of one kind: their errors' root mean square, and processor time.
typedef struct Runs {
    double error, seconds;
} Runs;

static void runs_add(Runs *runs, const SamplingScene *scene, const Picture *reference, const rt_sampling *sampling,
                     int seeds)
{
    clock_t start = clock();
    Picture *picture = picture_make_as(scene, reference->width, reference->height, sampling, 1, false);
    runs->seconds += (double)(clock() - start) / CLOCKS_PER_SEC;
    double error = picture_rmse(picture, reference);
    runs->error = sqrt(runs->error * runs->error + error * error / seeds);
    picture_free(picture);
}

static double error_of(const SamplingScene *scene, const Picture *reference, double samples, bool is_adaptive,
                       int seeds)
{
    Runs runs = {0.0, 0.0};
    for (int i = 0; i < seeds; i++) {
        rt_sampling sampling = {.samples = samples, .adaptive = is_adaptive, .seed = 1u + (unsigned)i};
        runs_add(&runs, scene, reference, &sampling, seeds);
    }
    return runs.error;
}

// ---- goals

enum { GOAL_SEEDS = 20, LADDER_SEEDS = 20, GOAL_WIDTH = 48, GOAL_HEIGHT = 36 };

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The samples a pixel of adaptive runs whose error is that in the mean: between two rungs of a ladder, in logarithms.
static double samples_of(const SamplingScene *scene, const Picture *reference, double error)
{
    double below = 2.0, at_below = error_of(scene, reference, below, true, LADDER_SEEDS);
    double above = below, at_above = at_below;
    while (at_above > error) {
        below = above;
        at_below = at_above;
        above *= sqrt(2.0);
        at_above = error_of(scene, reference, above, true, LADDER_SEEDS);
    }
    return above == below ? above : below * pow(above / below, log(at_below / error) / log(at_below / at_above));
}

static void measure_goals(void)
{
    static const struct {
        const SamplingScene *scene;
        double targets[2];
    } rows[] = {{&scene_balls, {0.02, 0.006}}, {&scene_soft, {0.012, 0.004}},   {&scene_mirrors, {0.02, 0.008}},
                {&scene_glass, {0.02, 0.006}}, {&scene_checker, {0.05, 0.018}}, {&scene_lens, {0.02, 0.007}}};
    enum { ROWS = RT_COUNT_OF(rows), ALL = 2 * ROWS * GOAL_SEEDS };
    static double times[ALL];
    int count = 0;
    for (int i = 0; i < ROWS; i++) {
        rt_sampling halton = {.sampler = "halton", .samples = 8192, .seed = 987654321};
        Picture *reference = grid_knows(rows[i].scene)
                                 ? grid_picture(rows[i].scene, GOAL_WIDTH, GOAL_HEIGHT, NULL, 0.1 * rows[i].targets[1])
                                 : picture_make_as(rows[i].scene, GOAL_WIDTH, GOAL_HEIGHT, &halton, 1, false);
        for (int j = 0; j < 2; j++) {
            double needed = samples_of(rows[i].scene, reference, rows[i].targets[j]), sum = 0.0;
            for (int seed = 0; seed < GOAL_SEEDS; seed++) {
                rt_sampling sampling = {.target_error = rows[i].targets[j], .seed = 5000u + (unsigned)seed};
                Picture *picture = picture_make_as(rows[i].scene, GOAL_WIDTH, GOAL_HEIGHT, &sampling, 1, false);
                sum += picture->error.samples / GOAL_SEEDS;
                times[count++] = picture->error.samples / needed;
                picture_free(picture);
            }
            printf("# %s, %.3f: %.1f samples, %.1f needed\n", rows[i].scene->name, rows[i].targets[j], sum, needed);
            fflush(stdout);
        }
        picture_free(reference);
    }
    qsort(times, (size_t)count, sizeof times[0], by_size);
    printf("median %.2f, nine in ten %.2f, most %.2f, of %d runs\n", times[count / 2], times[count * 9 / 10],
           times[count - 1], count);
}

// ---- edges

enum { EDGE_WIDTH = 160, EDGE_HEIGHT = 120, EDGE_SEEDS = 4 };

static const SamplingScene scene_many = {"5000 balls", SCENE_HEAD SCENE_CAMERA
                                         "light_source { <-8,12,-10> rgb 1 } background { rgb <0.1,0.2,0.4> }\n"
                                         "#declare S = seed(8);\n"
                                         "#for (I, 1, 5000) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>,\n"
                                         "0.03+0.06*rand(S) pigment { rgb <rand(S),rand(S),rand(S)> }\n"
                                         "finish { ambient 0.1 diffuse 0.8 } } #end\n"};

// With strata and without in turns, so that a busy machine slows both. Time to equal error goes by the slope that runs
// without have from a quarter of the samples on.
static void edge_row(const SamplingScene *scene, const Picture *reference, double samples, bool is_adaptive)
{
    Runs runs[2] = {{0.0, 0.0}, {0.0, 0.0}};
    for (int i = 0; i < 2 * EDGE_SEEDS; i++) {
        rt_sampling sampling = {.samples = samples, .adaptive = is_adaptive, .seed = 1u + (unsigned)i / 2};
        is_plain = i % 2 == 0;
        runs_add(&runs[i % 2], scene, reference, &sampling, EDGE_SEEDS);
    }
    is_plain = true;
    double before = error_of(scene, reference, 0.25 * samples, is_adaptive, EDGE_SEEDS);
    double slope = log(before / runs[0].error) / log(4.0), cost = runs[1].seconds / runs[0].seconds;
    printf("| %s, %.0f%s | %.2g | %.2g | %.2f | %.2f |\n", scene->name, samples, is_adaptive ? " adaptive" : "",
           runs[0].error, runs[1].error, cost, cost * pow(runs[1].error / runs[0].error, 1.0 / slope));
    fflush(stdout);
}

static void measure_edges(const char *name)
{
    static const SamplingScene *const scenes[] = {&scene_balls, &scene_many, &scene_mirrors};
    static const double samples[] = {16.0, 64.0};
    for (size_t i = 0; i < RT_COUNT_OF(scenes); i++) {
        if (name && strcmp(name, scenes[i]->name) != 0) {
            continue;
        }
        Picture *reference =
            grid_picture(scenes[i], EDGE_WIDTH, EDGE_HEIGHT, NULL, scenes[i] == &scene_balls ? 5e-5 : 2e-4);
        printf("# %s: the reference is off by %.2g\n", scenes[i]->name, reference->error.rmse);
        for (int k = 0; k < 4; k++) {
            edge_row(scenes[i], reference, samples[k % 2], k >= 2);
        }
        picture_free(reference);
    }
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "goals") == 0) {
        measure_goals();
    } else if (argc >= 2 && strcmp(argv[1], "edges") == 0) {
        measure_edges(argv[2]);
    } else {
        fprintf(stderr, "usage: measure goals | edges [SCENE]\n");
        return 2;
    }
    return 0;
}
