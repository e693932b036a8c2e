// Sampled pictures through the public interface: error against samples, goals and what is predicted of them, and that
// nothing depends on threads or on the estimate. With `long` as argument: all seeds, scenes and sizes. No clock decides.
// test_intervals holds the error told against the true one.
//
// SPDX-License-Identifier: MIT
#include "sampling/scenes.h"
#include "unit/tap.h"

enum { WIDTH = 48, HEIGHT = 36, THREADS = 2, SCENES = 5, SAMPLERS = 5 };

static bool is_long;

static Picture *reference_make(const SamplingScene *scene, int samples)
{
    rt_sampling sampling = {.sampler = "halton", .samples = samples, .seed = 987654321};
    return picture_make(scene, WIDTH, HEIGHT, &sampling, THREADS);
}

// Root mean square over some seeds.
static double error_of(const SamplingScene *scene, const char *sampler, int samples, int seeds,
                       const Picture *reference)
{
    double sum = 0.0;
    for (int seed = 0; seed < seeds; seed++) {
        rt_sampling sampling = {.sampler = sampler, .samples = samples, .seed = 1000u + (unsigned)seed};
        Picture *picture = picture_make(scene, WIDTH, HEIGHT, &sampling, THREADS);
        double error = picture_rmse(picture, reference);
        sum += error * error / seeds;
        picture_free(picture);
    }
    return sqrt(sum);
}

typedef struct Fit {
    int count;
    double x, y, xx, xy;
} Fit;

static void fit_add(Fit *fit, double x, double y)
{
    fit->count++;
    fit->x += x;
    fit->y += y;
    fit->xx += x * x;
    fit->xy += x * y;
}

static double fit_slope(const Fit *fit)
{
    return (fit->count * fit->xy - fit->x * fit->y) / (fit->count * fit->xx - fit->x * fit->x);
}

static double slope_of(const SamplingScene *scene, const char *sampler, int most, int seeds, const Picture *reference)
{
    Fit fit = {0};
    for (int samples = 4; samples <= most; samples *= 2) {
        fit_add(&fit, log(samples), log(error_of(scene, sampler, samples, seeds, reference)));
    }
    return fit_slope(&fit);
}

static void test_slopes(void)
{
    int seeds = is_long ? 8 : 2, most = is_long ? 256 : 64;
    Picture *balls = reference_make(&scene_balls, is_long ? 16384 : 1024);
    double slope = slope_of(&scene_balls, NULL, most, seeds, balls);
    tap_ok(slope <= -0.70, "hard edges: slope %.3f, at most -0.70", slope);
    double ratio = error_of(&scene_balls, NULL, 64, seeds, balls) / error_of(&scene_balls, "random", 64, seeds, balls);
    tap_ok(ratio <= 0.35, "hard edges: %.3f of random's error at 64 samples, at most 0.35", ratio);
    picture_free(balls);
    Picture *soft = reference_make(&scene_soft, is_long ? 16384 : 1024);
    slope = slope_of(&scene_soft, NULL, most, seeds, soft);
    tap_ok(slope <= -0.55, "area light: slope %.3f, at most -0.55", slope);
    static const char *const others[] = {"halton", "jittered", "random"};
    for (size_t i = 0; is_long && i < RT_COUNT_OF(others); i++) {
        double other = slope_of(&scene_soft, others[i], most, seeds, soft);
        tap_ok(other <= -0.40, "area light, %s: slope %.3f", others[i], other);
    }
    picture_free(soft);
}

// Adaptive runs against alike ones: samples for equal error, from the line through the errors of the latter.
static void test_adaptive(void)
{
    enum { COUNT = 64 };
    int seeds = is_long ? 8 : 1, width = 2 * WIDTH, height = 2 * HEIGHT;
    rt_sampling halton = {.sampler = "halton", .samples = is_long ? 8192 : 512, .seed = 77};
    Picture *reference = picture_make(&scene_balls, width, height, &halton, THREADS);
    double error[3] = {0.0}, samples = 0.0;
    for (int i = 0; i < 3 * seeds; i++) {
        rt_sampling sampling = {
            .samples = i % 3 == 1 ? COUNT / 2 : COUNT, .adaptive = i % 3 == 2, .seed = 2000u + (unsigned)i};
        Picture *picture = picture_make(&scene_balls, width, height, &sampling, THREADS);
        error[i % 3] += picture_rmse(picture, reference) * picture_rmse(picture, reference) / seeds;
        samples += i % 3 == 2 ? picture->error.samples / seeds : 0.0;
        picture_free(picture);
    }
    double slope = log(error[0] / error[1]) / log(4.0); // of the square root, by the factor of two
    double share = samples / (COUNT * pow(error[2] / error[0], 0.5 / slope));
    tap_ok(share <= 0.75, "adaptive: equal error with %.2f of the samples, at most 0.75", share);
    picture_free(reference);
}

// Where light is even one ray a pixel is enough, and it is known that it is.
static void test_even(void)
{
    enum { SEEDS = 10 };
    rt_sampling halton = {.sampler = "halton", .samples = 1024, .seed = 77}, alike = {.samples = 4};
    Picture *reference = picture_make(&scene_even, 2 * WIDTH, 2 * HEIGHT, &halton, THREADS);
    Picture *four = picture_make(&scene_even, 2 * WIDTH, 2 * HEIGHT, &alike, THREADS);
    double samples = 0.0, square = 0.0;
    int held = 0;
    for (int seed = 0; seed < SEEDS; seed++) {
        rt_sampling sampling = {.samples = 2.0, .adaptive = 1, .seed = 6000u + (unsigned)seed};
        Picture *picture = picture_make(&scene_even, 2 * WIDTH, 2 * HEIGHT, &sampling, THREADS);
        double error = picture_rmse(picture, reference);
        held += error >= picture->error.low && error <= picture->error.high;
        samples += picture->error.samples / SEEDS;
        square += error * error / SEEDS;
        picture_free(picture);
    }
    double share = sqrt(square) / picture_rmse(four, reference);
    tap_ok(samples < 3.0 && share < 0.5, "even light: %.2f samples a pixel have %.2f of the error of four alike",
           samples, share);
    tap_ok(held >= 8, "even light: the interval holds the error in %d of %d runs", held, SEEDS);
    picture_free(reference);
    picture_free(four);
}

// Each round looks at all pixels, so none is nearly empty.
static void test_rounds(void)
{
    rt_sampling sampling = {.samples = 24.0, .adaptive = 1, .seed = 8};
    Picture *picture = picture_make(&scene_soft, WIDTH, HEIGHT, &sampling, 1);
    double least = HUGE_VAL;
    int rounds = 0;
    for (size_t i = 1; i < picture->reports; i++) {
        double grown = picture->report_samples[i] / picture->report_samples[i - 1];
        rounds += grown > 1.0;
        least = grown > 1.0 && grown < least ? grown : least;
    }
    tap_ok(rounds >= 5 && least >= 1.12, "soft shadow: %d rounds, of which the least adds %.0f %% to the samples", rounds,
           100.0 * (least - 1.0));
    picture_free(picture);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

// Values and how far they are from 1.
typedef struct Ratios {
    double value[2000], off[2000];
    int count;
} Ratios;

static void ratios_add(Ratios *ratios, double ratio)
{
    ratios->value[ratios->count] = ratio;
    ratios->off[ratios->count++] = fabs(ratio - 1.0);
}

static double ratios_quantile(double values[2000], const Ratios *ratios, double part)
{
    qsort(values, (size_t)ratios->count, sizeof values[0], by_size);
    return ratios->count > 0 ? values[(int)(part * ratios->count)] : 1.0;
}

// Goals: how often they are met, and how near the first prediction after a tenth of the samples comes.
static void test_targets(void)
{
    static Ratios predicted;
    int seeds = is_long ? 100 : 20, scenes = is_long ? SCENES : 2, all = 0, met = 0;
    const double targets[] = {0.008, 0.004};
    for (int i = 0; i < scenes; i++) {
        Picture *reference = reference_make(sampling_scenes[i], is_long ? 16384 : 1024);
        for (int j = 0; j < 2; j++) {
            double target = targets[j] * (sampling_scenes[i] == &scene_checker ? 3.0 : 1.0);
            for (int seed = 0; seed < seeds; seed++) {
                rt_sampling sampling = {.target_error = target, .seed = 4000u + 200u * (unsigned)j + (unsigned)seed};
                Picture *picture = picture_make(sampling_scenes[i], WIDTH, HEIGHT, &sampling, 1);
                met += picture_rmse(picture, reference) <= target;
                all++;
                double samples = picture_predicted(picture);
                if (samples > 0.0) {
                    ratios_add(&predicted, samples / picture->error.samples);
                }
                picture_free(picture);
            }
        }
        picture_free(reference);
    }
    tap_ok(met >= 0.95 * all, "--target-error is met in %d of %d runs, at least 95 %%", met, all);
    double median = ratios_quantile(predicted.off, &predicted, 0.5);
    // The law of a run's first samples does not know how much more is won once strata have samples enough, of which the two
    // scenes of a short run have more than others.
    tap_ok(median <= (is_long ? 0.35 : 0.45),
           "the samples to the goal are predicted within %.0f %% in the median of %d", 100.0 * median, predicted.count);
}

// Runs of very different lengths, on scenes of every kind, most of them never looked at when the prediction was made:
// from the corner pass alone, which is all that there is after a tenth of a short run, and from rounds.
static void test_prediction(void)
{
    static const struct {
        const SamplingScene *scene;
        double targets[2];
    } runs[] = {{&scene_balls, {0.02, 0.005}}, {&scene_soft, {0.012, 0.003}},   {&scene_mirrors, {0.02, 0.006}},
                {&scene_glass, {0.02, 0.005}}, {&scene_checker, {0.05, 0.014}}, {&scene_lens, {0.02, 0.005}},
                {&scene_noise, {0.02, 0.005}}, {&scene_rods, {0.02, 0.006}}};
    static Ratios ratios[2];
    enum { SEEDS = 20 };
    for (size_t i = 0; i < RT_COUNT_OF(runs); i++) {
        for (int j = 0; j < 2; j++) {
            double samples = 0.0, predicted = 0.0;
            for (int seed = 0; seed < SEEDS; seed++) {
                rt_sampling sampling = {.target_error = runs[i].targets[j], .seed = 8000u + (unsigned)seed};
                Picture *picture = picture_make(runs[i].scene, 2 * WIDTH, 2 * HEIGHT, &sampling, 1);
                ratios_add(&ratios[j], picture_predicted(picture) / picture->error.samples);
                samples += picture->error.samples / SEEDS;
                predicted += picture_predicted(picture) / SEEDS;
                picture_free(picture);
            }
            printf("# %s, error %.3f: %.1f samples, predicted %.1f\n", runs[i].scene->name, runs[i].targets[j], samples,
                   predicted);
        }
    }
    for (int j = 0; j < 2; j++) {
        double off = ratios_quantile(ratios[j].off, &ratios[j], 0.5);
        double most = ratios_quantile(ratios[j].off, &ratios[j], 0.9);
        double middle = ratios_quantile(ratios[j].value, &ratios[j], 0.5);
        // Audits, which end a run at its goal, come by chance.
        tap_ok(off <= 0.25 && most <= 0.55 && middle >= 0.85 && middle <= 1.15,
               "%s runs: samples are predicted within %.0f %% in the median of %d, nine in ten within %.0f %%; %.2f of "
               "the real ones in the middle",
               j == 0 ? "short" : "long", 100.0 * off, ratios[j].count, 100.0 * most, middle);
    }
}

// The same by the clock, which decides nothing: how near the time comes that is told after the first tenth of a run.
static void tell_times(void)
{
    enum { SEEDS = 10, TARGETS = 2 };
    static const double targets[] = {0.004, 0.0012};
    static Ratios all;
    double shortest = HUGE_VAL, seconds = 0.0;
    for (int i = 0; i < SCENES; i++) {
        static Ratios own;
        own.count = 0;
        for (int j = 0; j < SEEDS * TARGETS; j++) {
            double target = targets[j % TARGETS] * (sampling_scenes[i] == &scene_checker ? 4.0 : 1.0);
            rt_sampling sampling = {.target_error = target, .seed = 5000u + (unsigned)j};
            Picture *picture = picture_make(sampling_scenes[i], 6 * WIDTH, 6 * HEIGHT, &sampling, 1);
            size_t k = 0;
            while (k + 1 < picture->reports && picture->report_at[k] < 0.1 * picture->seconds) {
                k++;
            }
            double predicted = picture->report_at[k] + picture->report_left[k];
            ratios_add(&own, predicted / picture->seconds);
            ratios_add(&all, predicted / picture->seconds);
            shortest = fmin(shortest, picture->seconds);
            seconds += picture->seconds;
            picture_free(picture);
        }
        printf(
            "# %s: the time to the goal is predicted within %.0f %% in the median of %d runs, %.2f of the real one\n",
            sampling_scenes[i]->name, 100.0 * ratios_quantile(own.off, &own, 0.5), own.count,
            ratios_quantile(own.value, &own, 0.5));
    }
    printf("# the time to the goal is predicted within %.0f %% in the median of %d runs, nine in ten within %.0f %%; "
           "runs take %.2f s and more, %.2f s in the mean\n",
           100.0 * ratios_quantile(all.off, &all, 0.5), all.count, 100.0 * ratios_quantile(all.off, &all, 0.9),
           shortest, seconds / all.count);
}

static bool same_pictures(const Picture *a, const Picture *b)
{
    return memcmp(a->rgb, b->rgb, (size_t)a->width * (size_t)a->height * 3 * sizeof *a->rgb) == 0;
}

static bool same_errors(const rt_error *a, const rt_error *b)
{
    return a->rmse == b->rmse && a->low == b->low && a->high == b->high && a->samples == b->samples &&
           a->slope == b->slope && a->bias == b->bias;
}

static void test_same(void)
{
    static const rt_sampling runs[] = {{.samples = 20},
                                       {.samples = 30.5, .adaptive = 1},
                                       {.target_error = 0.01},
                                       {.samples = 9, .sampler = "jittered"},
                                       {.samples = 8, .filter = "mitchell"}};
    for (size_t i = 0; i < RT_COUNT_OF(runs); i++) {
        Picture *one = picture_make(&scene_mirrors, 100, 70, &runs[i], 1);
        Picture *other = picture_make(&scene_mirrors, 100, 70, &runs[i], 5);
        tap_ok(same_pictures(one, other) && same_errors(&one->error, &other->error),
               "run %zu: same picture and same figures with 1 and 5 threads", i + 1);
        picture_free(one);
        picture_free(other);
    }
    rt_sampling with = {.samples = 24}, without = {.samples = 24, .no_estimate = 1};
    Picture *one = picture_make(&scene_soft, 100, 70, &with, 2),
            *other = picture_make(&scene_soft, 100, 70, &without, 2);
    tap_ok(same_pictures(one, other) && !other->error.known, "same picture without the estimate");
    picture_free(one);
    picture_free(other);
    rt_sampling none = {0}, single = {.samples = 1};
    one = picture_make(&scene_soft, 100, 70, &none, 2);
    other = picture_make(&scene_soft, 100, 70, &single, 2);
    tap_ok(same_pictures(one, other), "one sample is the ray through the middle");
    picture_free(one);
    picture_free(other);
    // A run that ended is made again by its number of samples.
    rt_sampling goal = {.target_error = 0.01, .seed = 5};
    one = picture_make_as(&scene_mirrors, 64, 48, &goal, 2, false);
    other = picture_make(&scene_mirrors, 64, 48, &goal, 2);
    tap_ok(same_pictures(one, other) && same_errors(&one->error, &other->error),
           "a run to a goal is the same when nobody asks how far it is");
    picture_free(other);
    rt_sampling again = {.samples = one->error.samples, .adaptive = 1, .seed = 5};
    other = picture_make(&scene_mirrors, 64, 48, &again, 2);
    tap_ok(same_pictures(one, other) && same_errors(&one->error, &other->error),
           "a run to a goal is made again by --adaptive and its samples");
    picture_free(one);
    picture_free(other);
}

// Area lights are sampled to the same picture as their grids make: against one ray for each of 256 parts of a pixel.
static void test_area_grid(void)
{
    enum { PARTS = 16, SMALL_WIDTH = 32, SMALL_HEIGHT = 24 };
    static const SamplingScene grid = {
        "grid", SCENE_HEAD SCENE_CAMERA
        "light_source { <-3,6,-3> rgb 1 area_light <4,0,0>, <0,0,4>, 4, 7 circular }\n"
        "plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.9 } }\n"
        "sphere { <0,0.5,0>, 1 pigment { rgb <1,0.5,0.3> } finish { ambient 0.1 diffuse 0.7 } }\n"};
    rt_sampling sampling = {.samples = 1024}, none = {0};
    Picture *fine = picture_make(&grid, SMALL_WIDTH * PARTS, SMALL_HEIGHT * PARTS, &none, 2);
    Picture *sampled = picture_make(&grid, SMALL_WIDTH, SMALL_HEIGHT, &sampling, 2);
    double sum = 0.0;
    for (int i = 0; i < SMALL_WIDTH * SMALL_HEIGHT * 3; i++) {
        int x = i / 3 % SMALL_WIDTH * PARTS, y = i / 3 / SMALL_WIDTH * PARTS;
        double mean = 0.0;
        for (int part = 0; part < PARTS * PARTS; part++) {
            mean += fine->rgb[3 * ((y + part / PARTS) * fine->width + x + part % PARTS) + i % 3];
        }
        mean = mean / (PARTS * PARTS) - sampled->rgb[i];
        sum += mean * mean;
    }
    double rmse = sqrt(sum / (SMALL_WIDTH * SMALL_HEIGHT * 3));
    tap_ok(rmse < 0.002, "a sampled area light makes the picture of its grid: rmse %.5f", rmse);
    picture_free(fine);
    picture_free(sampled);
}

int main(int argc, char **argv)
{
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    test_same();
    test_area_grid();
    test_slopes();
    test_adaptive();
    test_rounds();
    test_even();
    test_targets();
    test_prediction();
    if (is_long) {
        tell_times();
    }
    return tap_done();
}
