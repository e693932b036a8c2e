// Edges of spheres: pixels whose strata are weighted by their exact shares have the mean of plain samples, and less of
// an error. Runs of 7 samples a pixel weight nothing, so the mean of many is the reference. With `long` as argument: of
// more.
//
// SPDX-License-Identifier: MIT
#include "sampling/scenes.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { WIDTH = 48, HEIGHT = 36, VALUES = WIDTH * HEIGHT * 3, PLAIN = 7 };

// Bright balls before a dark plane, dark ones before a bright one: what bends a mean bends it to one side.
static const SamplingScene scenes[] = {
    {"bright balls", SCENE_HEAD SCENE_CAMERA
     "light_source { <-8,12,-10> rgb 1 } #declare S = seed(5);\n"
     "#for (I, 1, 150) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.05+0.4*rand(S)*rand(S)\n"
     "pigment { rgb 1 } finish { ambient 1 diffuse 0.3 } } #end\n"},
    {"dark balls that cut each other", SCENE_HEAD SCENE_CAMERA
     "light_source { <-8,12,-10> rgb 1 } background { rgb 1 } #declare S = seed(6);\n"
     "#for (I, 1, 300) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*2-1>, 0.05+0.6*rand(S)*rand(S)\n"
     "pigment { rgb rand(S)*0.3 } finish { phong 0.5 } } #end\n"},
    {"orthographic, glass and mirrors",
     SCENE_HEAD "camera { orthographic location <0,2,-9> look_at 0 right 9*x up 6.75*y }\n"
                "light_source { <-8,12,-10> rgb 1 } background { rgb <0.2,0.3,0.5> } #declare S = seed(7);\n"
                "plane { y, -2 pigment { checker rgb 1 rgb 0.2 } }\n"
                "#for (I, 1, 60) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.1+0.4*rand(S)\n"
                "pigment { rgbf <rand(S),rand(S),1,0.8*mod(I,2)> } finish { reflection 0.4*mod(I,3) } interior { ior "
                "1.4 } } #end\n"}};

// Means of many runs.
typedef struct Many {
    double mean[VALUES], square[VALUES]; // of values; of their variances
    double level, level_variance;        // of the mean over the picture
    double variance;                     // of a run, over the picture
    int count;
} Many;

static void many_make(Many *many, const SamplingScene *scene, int samples, int count, unsigned seed)
{
    double squares = 0.0;
    memset(many, 0, sizeof *many);
    many->count = count;
    for (int i = 0; i < count; i++) {
        rt_sampling sampling = {.samples = samples, .seed = seed + (unsigned)i, .no_estimate = 1};
        Picture *picture = picture_make(scene, WIDTH, HEIGHT, &sampling, 2);
        double level = 0.0;
        for (int j = 0; j < VALUES; j++) {
            double value = (double)picture->rgb[j];
            many->mean[j] += value / count;
            many->square[j] += value * value / count;
            level += value / VALUES;
        }
        many->level += level / count;
        squares += level * level / count;
        picture_free(picture);
    }
    many->level_variance = (squares - many->level * many->level) / (count - 1);
    for (int j = 0; j < VALUES; j++) {
        many->variance += (many->square[j] - many->mean[j] * many->mean[j]) * count / (count - 1.0) / VALUES;
    }
}

// Of the mean square of what a run's samples are off by, the share that no more runs would take away.
static void test_mean(const SamplingScene *scene, int samples, int count, const Many *plain, unsigned seed)
{
    Many *many = malloc(sizeof *many);
    double apart = 0.0;
    many_make(many, scene, samples, count, seed);
    for (int j = 0; j < VALUES; j++) {
        apart += (many->mean[j] - plain->mean[j]) * (many->mean[j] - plain->mean[j]) / VALUES;
    }
    double z = (many->level - plain->level) / sqrt(many->level_variance + plain->level_variance);
    double chance = many->variance / many->count + plain->variance / plain->count;
    double bias = (apart - chance) / many->variance;
    tap_ok(fabs(z) < 4.0, "%s: the level of %d runs of %d samples has z = %.1f", scene->name, count, samples, z);
    // With 61 samples that is little, and the mean of plain ones as far off.
    tap_ok(bias < (samples < 20 ? 0.03 : 0.3),
           "%s: of the mean square error of %d samples %.2f %% is in the mean of all runs", scene->name, samples,
           100.0 * bias);
    free(many);
}

// A lens of no width keeps samples from being weighted.
static void test_gain(unsigned seed)
{
    static const SamplingScene lens = {
        "balls before a lens of no width", SCENE_HEAD
        "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 aperture 1e-9\n"
        "blur_samples 50 focal_point 0 } light_source { <-8,12,-10> rgb 1 } background { rgb <0.1,0.2,0.4> }\n"
        "#declare S = seed(7);\n"
        "#for (I, 1, 300) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.1+0.25*rand(S)\n"
        "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8 } } #end\n"};
    static const struct {
        int samples;
        double bar;
    } rows[] = {{16, 0.85}, {64, 0.75}};
    Many *with = malloc(sizeof *with), *without = malloc(sizeof *without);
    for (size_t i = 0; i < RT_COUNT_OF(rows); i++) {
        many_make(with, &scene_balls, rows[i].samples, 8, seed);
        many_make(without, &lens, rows[i].samples, 8, seed);
        double ratio = sqrt(with->variance / without->variance);
        tap_ok(ratio <= rows[i].bar, "300 balls, %d samples: the error is %.2f of that of plain samples",
               rows[i].samples, ratio);
    }
    free(with);
    free(without);
}

int main(int argc, char **argv)
{
    Random drawn_by = {random_seed(NULL)};
    bool is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    Many *plain = malloc(sizeof *plain);
    for (size_t i = 0; i < RT_COUNT_OF(scenes); i++) {
        unsigned seed = random_below(&drawn_by, 1u << 29);
        many_make(plain, &scenes[i], PLAIN, is_long ? 2000 : 800, seed);
        test_mean(&scenes[i], 8, is_long ? 400 : 40, plain, seed + (1u << 29));
        test_mean(&scenes[i], 16, is_long ? 400 : 40, plain, seed + (1u << 29));
        test_mean(&scenes[i], 61, is_long ? 400 : 20, plain, seed + (1u << 29));
    }
    free(plain);
    test_gain(random_below(&drawn_by, 1u << 29));
    return tap_done();
}
