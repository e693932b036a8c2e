// The forward tracer against the renderer: the same means on scenes where both follow the same light, from photons that
// are connected to the lens and from those that hit it by themselves; and that threads change nothing. With `long` as
// argument: so many of the latter, on three scenes, that their means are known to 1 %.
//
// SPDX-License-Identifier: MIT
#include "sampling/scenes.h"
#include "unit/tap.h"

#define LENS_CAMERA(aperture)                                                                                          \
    "camera { location <0,2,-7> look_at 0 right x*image_width/image_height angle 50 aperture " aperture                \
    " blur_samples 100 focal_point 0 }\n"

enum { WIDTH = 24, HEIGHT = 18, SEEDS = 8 };

static const SamplingScene forward_scenes[] = {
    {"dull spheres",
     SCENE_HEAD LENS_CAMERA(
         "4") "light_source { <-4,7,-6> rgb <1,0.9,0.8> spotlight point_at 0 radius 20 falloff 20 }\n"
              "plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.8 } }\n"
              "sphere { <-1,0,0>, 1 pigment { rgb <1,0.4,0.2> } finish { ambient 0 diffuse 0.7 } }\n"
              "sphere { <1.2,0,1>, 1 pigment { rgb <0.2,0.4,1> } finish { ambient 0 diffuse 0.9 brilliance 2 } }\n"},
    {"mirror",
     SCENE_HEAD LENS_CAMERA(
         "6") "light_source { <-4,7,-6> rgb 1 spotlight point_at 0 radius 15 falloff 25 }\n"
              "light_source { <5,6,-3> rgb <0.2,0.3,0.5> spotlight point_at 0 radius 15 falloff 25 tightness 10 }\n"
              "plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.8 } }\n"
              "sphere { <-1,0,0>, 1 pigment { rgb 0.5 } finish { ambient 0 diffuse 0.1 reflection 0.3 } }\n"
              "sphere { <1.2,0,1>, 1 pigment { rgb <0.2,0.4,1> } finish { ambient 0 diffuse 0.9 } }\n"},
    {"point light", SCENE_HEAD LENS_CAMERA(
                        "0.2") "light_source { <-1.5,3,-2> rgb <1,0.9,0.8> }\n"
                               "sphere { <0,-40,0>, 39 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.8 } }\n"
                               "sphere { <-1,0,0>, 1 pigment { rgb <1,0.4,0.2> } finish { ambient 0 diffuse 0.7 } }\n"},
    {"spotlight and area light",
     SCENE_HEAD LENS_CAMERA("2") "light_source { <-2,6,-4> rgb 1 spotlight point_at 0 radius 15 falloff 30 "
                                 "fade_distance 6 fade_power 2 }\n"
                                 "light_source { <3,5,-2> rgb 0.4 area_light <2,0,0>, <0,0,2>, 5, 5 jitter }\n"
                                 "plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.8 } }\n"
                                 "sphere { <0,0,0>, 1 pigment { rgb <1,0.4,0.2> } finish { ambient 0 diffuse 0.7 phong "
                                 "0.5 phong_size 10 } }\n"},
};

// The mean of all values; *error is that of the forward picture.
static double mean_of(const SamplingScene *scene, rt_method method, double work, uint64_t seed, int threads,
                      Picture *kept)
{
    Picture picture = {0};
    rt_callbacks callbacks = {NULL, on_diagnostic, NULL, NULL};
    rt_session *session = rt_session_new(&callbacks);
    bool is_forward = method != RT_METHOD_BACKWARD;
    rt_sampling sampling = {.seed = seed, .samples = is_forward ? 0.0 : work};
    if (!session || rt_set_size(session, WIDTH, HEIGHT) || rt_set_sampling(session, &sampling) ||
        rt_set_method(session, method, is_forward ? (uint64_t)work : 0) ||
        rt_load_text(session, scene->name, scene->text, strlen(scene->text)) || rt_render(session, threads)) {
        abort();
    }
    const float *rgb = rt_pixels(session, &picture.width, &picture.height);
    double sum = 0.0;
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        sum += rgb[i] / (WIDTH * HEIGHT * 3.0);
    }
    if (kept) {
        *kept = picture;
        kept->rgb = malloc(sizeof(float) * WIDTH * HEIGHT * 3);
        memcpy(kept->rgb, rgb, sizeof(float) * WIDTH * HEIGHT * 3);
        rt_get_error(session, &kept->error);
    }
    rt_session_free(session);
    return sum;
}

static void test_means(const SamplingScene *scene, rt_method method, double photons, double bar)
{
    double want = mean_of(scene, RT_METHOD_BACKWARD, 1024, 1, 2, NULL), sum = 0.0, squares = 0.0;
    for (uint64_t seed = 0; seed < SEEDS; seed++) {
        double mean = mean_of(scene, method, photons, 10 + seed, 2, NULL) / want;
        sum += mean / SEEDS;
        squares += mean * mean / SEEDS;
    }
    double error = sqrt(fmax(squares - sum * sum, 0.0) / (SEEDS - 1));
    tap_ok(fabs(sum - 1.0) < bar && fabs(sum - 1.0) < fmax(3.0 * error, 1e-3) && 3.0 * error < bar,
           "%s, %s: %.5f of the renderer's mean, standard error %.5f", scene->name,
           method == RT_METHOD_FORWARD ? "forward" : "connected", sum, error);
}

static void test_threads(void)
{
    Picture one, other;
    mean_of(&forward_scenes[1], RT_METHOD_FORWARD_CONNECT, 200000, 3, 1, &one);
    mean_of(&forward_scenes[1], RT_METHOD_FORWARD_CONNECT, 200000, 3, 5, &other);
    tap_ok(memcmp(one.rgb, other.rgb, sizeof(float) * WIDTH * HEIGHT * 3) == 0 && one.error.rmse == other.error.rmse,
           "same picture and error with 1 and 5 threads");
    free(one.rgb);
    free(other.rgb);
}

int main(int argc, char **argv)
{
    bool is_long = argc > 1 && strcmp(argv[1], "long") == 0;
    for (size_t i = 0; i < RT_COUNT_OF(forward_scenes); i++) {
        test_means(&forward_scenes[i], RT_METHOD_FORWARD_CONNECT, 400000, 0.01);
    }
    // Photons that must hit the lens by themselves are few.
    test_means(&forward_scenes[0], RT_METHOD_FORWARD, is_long ? 1e7 : 1.5e6, is_long ? 0.01 : 0.025);
    test_means(&forward_scenes[1], RT_METHOD_FORWARD, is_long ? 1e7 : 1.5e6, is_long ? 0.01 : 0.025);
    if (is_long) {
        test_means(&forward_scenes[3], RT_METHOD_FORWARD, 4e7, 0.01);
    }
    test_threads();
    return tap_done();
}
