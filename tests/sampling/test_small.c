// What is smaller than a pixel: the error told holds it, whether samples have met it or not, and runs to a goal look
// for it. With `long` as argument: with many seeds. The places of single balls are integrated here, by their own
// geometry.
//
// SPDX-License-Identifier: MIT
#include "sampling/scenes.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 48, HEIGHT = 36, SPARK_WIDTH = 24, SPARK_HEIGHT = 18 };

static bool is_long;
static Random drawn_by;

static double unit(void)
{
    return random_below(&drawn_by, 1u << 30) * 0x1p-30;
}

static bool holds(const Picture *picture, const Picture *reference)
{
    double error = picture_rmse(picture, reference);
    return error >= picture->error.low && error <= picture->error.high;
}

// ---- 600 balls

static void test_dust(void)
{
    static const double samples[] = {4.0, 16.0, 64.0, 256.0};
    rt_sampling halton = {.sampler = "halton", .samples = is_long ? 16384 : 2048, .seed = 987654321, .no_estimate = 1};
    Picture *reference = picture_make(&scene_dust, WIDTH, HEIGHT, &halton, 2);
    int seeds = is_long ? 100 : 24, met = 0;
    for (int i = 0; i < (is_long ? 4 : 2); i++) {
        for (int is_adaptive = 0; is_adaptive < 2; is_adaptive++) {
            int held = 0;
            for (int seed = 0; seed < seeds; seed++) {
                rt_sampling sampling = {
                    .samples = samples[i], .adaptive = is_adaptive, .seed = random_below(&drawn_by, 1u << 30)};
                Picture *picture = picture_make(&scene_dust, WIDTH, HEIGHT, &sampling, 2);
                held += holds(picture, reference);
                picture_free(picture);
            }
            tap_ok(held >= (is_long ? 90 : least_held(seeds)),
                   "600 balls, %.0f samples%s: the interval holds the error in %d of %d runs", samples[i],
                   is_adaptive ? ", adaptive" : "", held, seeds);
        }
    }
    for (int seed = 0; seed < 20; seed++) {
        rt_sampling sampling = {.target_error = 0.005, .seed = random_below(&drawn_by, 1u << 30)};
        Picture *picture = picture_make(&scene_dust, WIDTH, HEIGHT, &sampling, 2);
        met += picture_rmse(picture, reference) <= 0.005;
        picture_free(picture);
    }
    tap_ok(met >= least_held(20), "600 balls: a target of 0.005 is met in %d of 20 runs", met);
    picture_free(reference);
}

// ---- one bright ball

typedef struct Spark {
    double x, y, z, radius;
} Spark;

// Whether the ball is seen from the origin along x, y, 1.
static bool spark_is_met(const Spark *spark, double x, double y)
{
    double cx = spark->y - spark->z * y, cy = spark->z * x - spark->x, cz = spark->x * y - spark->y * x;
    return cx * cx + cy * cy + cz * cz <= spark->radius * spark->radius * (x * x + y * y + 1.0);
}

// The shares of pixels that the ball is, by points of a fine grid around it.
static void spark_shares(const Spark *spark, double *shares)
{
    enum { FINE = 500 };
    double reach = 1.3 * spark->radius / spark->z, middle_x = spark->x / spark->z, middle_y = spark->y / spark->z;
    double area = 4.0 * reach * reach / (FINE * FINE) * (3.0 / 4.0 * SPARK_WIDTH) * SPARK_HEIGHT;
    memset(shares, 0, SPARK_WIDTH * SPARK_HEIGHT * sizeof *shares);
    for (int i = 0; i < FINE * FINE; i++) {
        double x = middle_x + reach * (2.0 * (i % FINE + 0.5) / FINE - 1.0);
        double y = middle_y + reach * (2.0 * (i / FINE + 0.5) / FINE - 1.0);
        int column = (int)floor((x * 3.0 / 4.0 + 0.5) * SPARK_WIDTH), row = (int)floor((0.5 - y) * SPARK_HEIGHT);
        if (column >= 0 && column < SPARK_WIDTH && row >= 0 && row < SPARK_HEIGHT && spark_is_met(spark, x, y)) {
            shares[row * SPARK_WIDTH + column] += area;
        }
    }
}

static const char spark_scene[] =
    SCENE_HEAD "camera { location 0 direction z right x*4/3 up y } background { rgb 0.1 }\n"
               "light_source { <0,0,-9> rgb 0.001 } sphere { <%.17g,%.17g,%.17g>, %.17g pigment { rgb 1 }\n"
               "finish { ambient %g diffuse 0 } }\n%s";

// A ball of so many pixels, somewhere.
static Spark spark_draw(double least, double most)
{
    double area = least * pow(most / least, unit()), z = 3.0 + 5.0 * unit();
    return (Spark){.x = z * (unit() - 0.5),
                   .y = 0.8 * z * (unit() - 0.5),
                   .z = z,
                   .radius = z / SPARK_HEIGHT * sqrt(area / 3.14159265358979)};
}

typedef struct SparkCount {
    int runs, held, told, known; // of those: it is said whether the ball was met; as it was, with its area
    double width;                // the sum of the logarithms of the intervals' upper ends over their lower ones
} SparkCount;

static void spark_run(const Spark *spark, double samples, bool is_adaptive, SparkCount *count)
{
    char text[1024];
    double bright = 21.0, area = 0.0;
    snprintf(text, sizeof text, spark_scene, spark->x, spark->y, spark->z, spark->radius, bright, "");
    SamplingScene scene = {"spark", text};
    rt_sampling sampling = {.samples = samples, .adaptive = is_adaptive, .seed = random_below(&drawn_by, 1u << 30)};
    Picture *picture = picture_make(&scene, SPARK_WIDTH, SPARK_HEIGHT, &sampling, 1);
    Picture reference = {.width = SPARK_WIDTH, .height = SPARK_HEIGHT, .rgb = malloc(SPARK_WIDTH * SPARK_HEIGHT * 12)};
    bool is_met = false;
    static double shares[SPARK_WIDTH * SPARK_HEIGHT];
    spark_shares(spark, shares);
    for (int i = 0; i < SPARK_WIDTH * SPARK_HEIGHT; i++) {
        double share = shares[i];
        area += share;
        for (int c = 0; c < 3; c++) {
            reference.rgb[3 * i + c] = (float)(0.1 + share * (bright - 0.1));
            is_met = is_met || picture->rgb[3 * i + c] > 0.1001f;
        }
    }
    count->runs++;
    count->held += holds(picture, &reference);
    count->width += log(picture->error.high / picture->error.low);
    count->told += picture->error.unmet_shapes == (is_met ? 0.0 : 1.0);
    count->known += is_met || fabs(picture->error.unmet_shape_area - area) < 0.02 * area;
    free(reference.rgb);
    picture_free(picture);
}

static void test_spark(void)
{
    int seeds = is_long ? 200 : 60;
    for (int is_adaptive = 0; is_adaptive < 2; is_adaptive++) {
        for (double samples = 4.0; samples <= 16.0; samples *= 4.0) {
            SparkCount count = {0};
            for (int i = 0; i < seeds; i++) {
                Spark spark = spark_draw(0.003, 0.09);
                spark_run(&spark, samples, is_adaptive, &count);
            }
            tap_ok(count.held >= (is_long ? 180 : least_held(seeds)),
                   "one bright ball, %.0f samples%s: the interval holds the error in %d of %d runs", samples,
                   is_adaptive ? ", adaptive" : "", count.held, seeds);
            tap_ok(count.told == seeds && count.known == seeds,
                   "and it is told whether a sample has met it in %d, with its area in %d of them", count.told,
                   count.known);
        }
    }
    // Behind something opaque it is not to be seen; behind glass it is.
    static const char *const before[] = {"", "sphere { <0.2,0.1,2>, 0.3 pigment { rgb 0.5 } }",
                                         "sphere { <0.2,0.1,2>, 0.3 pigment { rgbt <0.5,0.5,0.5,0.5> } }"};
    for (int i = 0; i < 3; i++) {
        char text[1024];
        Spark spark = {0.5, 0.25, 5.0, 0.0004};
        snprintf(text, sizeof text, spark_scene, spark.x, spark.y, spark.z, spark.radius, 21.0, before[i]);
        SamplingScene scene = {"hidden spark", text};
        rt_sampling sampling = {.samples = 4.0};
        Picture *picture = picture_make(&scene, SPARK_WIDTH, SPARK_HEIGHT, &sampling, 1);
        tap_ok(picture->error.unmet_shapes == (i == 1 ? 0.0 : 1.0), "%s: %.0f shapes that could be seen were not met",
               i == 0 ? "a ball before nothing" : i == 1 ? "behind an opaque ball" : "behind a clear ball",
               picture->error.unmet_shapes);
        picture_free(picture);
    }
}

// A ball of some pixels is in the corners of some, which no sample may have met beside others that have.
static void test_corners(void)
{
    int seeds = is_long ? 400 : 80;
    SparkCount count = {0};
    for (int i = 0; i < seeds; i++) {
        Spark spark = spark_draw(2.0, 6.0);
        spark_run(&spark, 4.0, false, &count);
    }
    double width = exp(count.width / seeds);
    tap_ok(count.held >= least_held(seeds) && width < 2.3,
           "a bright ball of some pixels: the interval holds the error in %d of %d runs, its ends are %.2f times apart "
           "in the mean", count.held, seeds, width);
}

// ---- other shapes, and highlights

static void test_others(void)
{
    static const SamplingScene *const scenes[] = {&scene_crumbs,      &scene_glint,        &scene_floor_glint,
                                                  &scene_blurred_dust, &scene_flat_dust, &scene_glints};
    static const rt_sampling runs[] = {{.samples = 4},
                                       {.samples = 16, .adaptive = 1},
                                       {.samples = 16, .adaptive = 1, .filter = "gaussian"}};
    int seeds = is_long ? 100 : 8;
    for (size_t i = 0; i < RT_COUNT_OF(scenes); i++) {
        int held = 0, all = 0;
        for (size_t j = 0; j < RT_COUNT_OF(runs); j++) {
            rt_sampling halton = {.sampler = "halton",
                                  .samples = is_long ? 16384 : 2048,
                                  .seed = 9,
                                  .filter = runs[j].filter,
                                  .no_estimate = 1};
            Picture *reference = picture_make(scenes[i], WIDTH, HEIGHT, &halton, 2);
            int own = 0;
            for (int seed = 0; seed < seeds; seed++) {
                rt_sampling sampling = runs[j];
                sampling.seed = random_below(&drawn_by, 1u << 30);
                Picture *picture = picture_make(scenes[i], WIDTH, HEIGHT, &sampling, 2);
                own += holds(picture, reference);
                all++;
                picture_free(picture);
            }
            printf("# %s, run %zu: the interval holds the error in %d of %d\n", scenes[i]->name, j + 1, own, seeds);
            held += own;
            picture_free(reference);
        }
        tap_ok(held >= (is_long ? (int)ceil(0.9 * all) : least_held(all)), "%s: the interval holds the error in %d of %d runs",
               scenes[i]->name, held, all);
    }
}

// The area where a highlight has e^-4 of what it is at its brightest, as it is told where no sample met it, against a
// picture of many pixels in each of the run's.
static void test_highlight_areas(void)
{
    enum { FINE = 24, TRIES = 60 };
    static const char *const scenes[][2] = {
        {"phong of a floor", "light_source { <-2,5,9> rgb 1 } plane { y, -1 finish { phong 1 phong_size 100000 } %s }"},
        {"specular of a floor",
         "light_source { <-2,5,9> rgb 1 } plane { y, -1 finish { specular 1 roughness 4e-6 } %s }"},
        {"phong of a ball", "light_source { <-8,4,1> rgb 1 } sphere { 0, 2 finish { phong 1 phong_size 3000 } %s }"},
        {"specular of a ball",
         "light_source { <-8,4,1> rgb 1 } sphere { 0, 2 finish { specular 1 roughness 1e-4 } %s }"},
        {"phong of a stretched ball",
         "light_source { <-8,4,1> rgb 1 } sphere { 0, 1 scale <2,1.5,1> finish { phong 1 phong_size 3000 } %s }"},
        {"specular of a bumpy floor", "light_source { <-2,5,9> rgb 1 } plane { y, -1 finish { specular 1 roughness 4e-6 } "
                                      "normal { gradient x 0.2 sine_wave scale 40 translate -0.1 } %s }"}};
    for (size_t i = 0; i < RT_COUNT_OF(scenes); i++) {
        char text[1024], body[512];
        snprintf(body, sizeof body, scenes[i][1], "pigment { rgb 0 }");
        snprintf(text, sizeof text, SCENE_HEAD SCENE_CAMERA "#default { finish { ambient 0 diffuse 0 } } %s\n", body);
        SamplingScene scene = {scenes[i][0], text};
        rt_sampling single = {0};
        Picture *fine = picture_make(&scene, FINE * WIDTH, FINE * HEIGHT, &single, 2);
        float peak = 0.0f;
        double area = 0.0, told = 0.0;
        for (int k = 0; k < fine->width * fine->height; k++) {
            peak = fine->rgb[3 * k] > peak ? fine->rgb[3 * k] : peak;
        }
        for (int k = 0; k < fine->width * fine->height; k++) {
            area += fine->rgb[3 * k] > exp(-4.0) * (double)peak ? 1.0 / (FINE * FINE) : 0.0;
        }
        for (unsigned seed = 0; seed < TRIES && told == 0.0; seed++) {
            rt_sampling sampling = {.samples = 2, .seed = seed};
            Picture *picture = picture_make(&scene, WIDTH, HEIGHT, &sampling, 1);
            told = picture->error.unmet_highlights == 1.0 ? picture->error.unmet_highlight_area : 0.0;
            picture_free(picture);
        }
        tap_ok(fabs(told - area) < 0.1 * area, "%s: %.4f pixels are told to be met by no sample, %.4f are there",
               scenes[i][0], told, area);
        picture_free(fine);
    }
}

// Figures do not depend on who has met what first.
static void test_same(void)
{
    static const SamplingScene *const scenes[] = {&scene_dust, &scene_glint, &scene_glints, &scene_blurred_dust};
    for (size_t i = 0; i < RT_COUNT_OF(scenes); i++) {
        for (int is_adaptive = 0; is_adaptive < 2; is_adaptive++) {
            rt_sampling sampling = {.samples = 5, .adaptive = is_adaptive, .seed = 3};
            Picture *one = picture_make(scenes[i], 130, 70, &sampling, 1);
            Picture *other = picture_make(scenes[i], 130, 70, &sampling, 5);
            const rt_error *a = &one->error, *b = &other->error;
            tap_ok(memcmp(one->rgb, other->rgb, 130 * 70 * 3 * sizeof(float)) == 0 && a->rmse == b->rmse &&
                       a->low == b->low && a->high == b->high && a->unmet_shapes == b->unmet_shapes &&
                       a->unmet_shape_area == b->unmet_shape_area && a->unmet_highlights == b->unmet_highlights &&
                       a->missed_error == b->missed_error,
                   "%s%s: the same picture and figures with 1 and 5 threads, %.0f shapes and %.0f highlights unmet",
                   scenes[i]->name, is_adaptive ? ", adaptive" : "", a->unmet_shapes, a->unmet_highlights);
            picture_free(one);
            picture_free(other);
        }
    }
}

int main(int argc, char **argv)
{
    drawn_by = (Random){random_seed(NULL)};
    is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    test_same();
    test_spark();
    test_corners();
    test_dust();
    test_others();
    test_highlight_areas();
    return tap_done();
}
