// The scenes that sampling is measured on, and what is needed to render them through the public interface.
//
// SPDX-License-Identifier: MIT
#ifndef SAMPLING_SCENES_H
#define SAMPLING_SCENES_H

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"

#define SCENE_HEAD   "#version 3.7; global_settings { assumed_gamma 1 }\n"
#define SCENE_CAMERA "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 }\n"

#define SCENE_SUN    "light_source { <-8,12,-10> rgb 1 } background { rgb <0.2,0.3,0.5> }\n"

typedef struct SamplingScene {
    const char *name, *text;
} SamplingScene;

// Some hundred spheres: hard edges everywhere.
static const SamplingScene scene_balls = {
    "balls",
    SCENE_HEAD SCENE_CAMERA "light_source { <-8,12,-10> rgb 1 } background { rgb <0.1,0.2,0.4> }\n"
                            "#declare S = seed(7);\n"
                            "#for (I, 1, 300) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.1+0.25*rand(S)\n"
                            "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8 } } #end\n"};

// A plane in the half shadow of an area light.
static const SamplingScene scene_soft = {
    "soft shadow",
    SCENE_HEAD SCENE_CAMERA "light_source { <-3,6,-3> rgb 1 area_light <4,0,0>, <0,0,4>, 9, 9 jitter }\n"
                            "plane { y, -1 pigment { rgb 0.8 } finish { ambient 0 diffuse 0.9 } }\n"
                            "sphere { <0,0.5,0>, 1 pigment { rgb <1,0.5,0.3> } finish { ambient 0.1 diffuse 0.7 } }\n"
                            "sphere { <2,0,1>, 0.8 pigment { rgb <0.3,0.5,1> } finish { ambient 0.1 diffuse 0.7 } }\n"};

static const SamplingScene scene_mirrors = {
    "mirrors", SCENE_HEAD SCENE_CAMERA
    "global_settings { max_trace_level 8 } light_source { <-8,12,-10> rgb 1 } background { rgb <0.2,0.3,0.5> }\n"
    "plane { y, -1.5 pigment { checker rgb 1 rgb 0.2 } finish { ambient 0.1 diffuse 0.6 reflection 0.2 } }\n"
    "#for (I, -2, 2) sphere { <I*1.6, 0, I*I*0.5>, 0.75 pigment { rgb <0.8,0.6,0.4> }\n"
    "finish { ambient 0.05 diffuse 0.3 reflection 0.6 phong 0.8 phong_size 60 } } #end\n"};

// Fine squares up to the horizon.
static const SamplingScene scene_checker = {
    "checker", SCENE_HEAD SCENE_CAMERA
    "light_source { <-8,12,-10> rgb 1 }\n"
    "plane { y, -1 pigment { checker rgb 1 rgb 0 scale 0.3 } finish { ambient 0.4 diffuse 0.5 } }\n"
    "plane { -z, -60 pigment { gradient y scale 3 } finish { ambient 0.7 } }\n"};

static const SamplingScene scene_glass = {
    "glass", SCENE_HEAD SCENE_CAMERA
    "global_settings { max_trace_level 10 } light_source { <-8,12,-10> rgb 1 }\n"
    "background { rgb <0.4,0.5,0.7> } plane { y, -1.5 pigment { checker rgb 0.9 rgb <0.2,0.3,0.2> } }\n"
    "#for (I, -1, 1) sphere { <I*2, 0, 0>, 0.9 pigment { rgbf <0.95,0.9,1,0.9> }\n"
    "finish { ambient 0 diffuse 0.1 phong 0.5 } interior { ior 1.4 } } #end\n"};

// A wide lens before a patterned plane: everything is blurred, samples draw four numbers.
__attribute__((unused)) static const SamplingScene scene_lens = {
    "lens", SCENE_HEAD
    "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 aperture 0.8 blur_samples 50\n"
    "focal_point <0,0,-1> } light_source { <-8,12,-10> rgb 1 } background { rgb <0.2,0.3,0.5> }\n"
    "plane { y, -1 pigment { gradient x color_map { [0 rgb 0.2] [1 rgb <0.9,0.8,0.6>] } scale 0.7 } }\n"
    "#for (I, -2, 2) sphere { <I*1.5, 0, I*1.5>, 0.8 pigment { rgb <0.8,0.4,0.3> } finish { phong 0.6 } } #end\n"};

// Smooth detail as large as pixels: noise in colours and normals.
__attribute__((unused)) static const SamplingScene scene_noise = {
    "noise", SCENE_HEAD SCENE_CAMERA
    "light_source { <-8,12,-10> rgb 1 } background { rgb <0.2,0.3,0.5> }\n"
    "plane { y, -1.5 pigment { bozo turbulence 0.5 color_map { [0 rgb 0.1] [0.6 rgb <0.9,0.7,0.4>] [1 rgb 1] }\n"
    "scale 0.4 } } sphere { 0, 1.4 pigment { rgb <0.9,0.5,0.3> } normal { bumps 0.5 scale 0.15 }\n"
    "finish { ambient 0.1 diffuse 0.6 phong 0.8 phong_size 40 } }\n"};

// Thin things, each in few pixels, and their shadows.
__attribute__((unused)) static const SamplingScene scene_rods = {
    "rods",
    SCENE_HEAD SCENE_CAMERA "light_source { <-8,12,-10> rgb 1 } plane { y, -2 pigment { rgb 0.8 } }\n"
                            "#declare S = seed(11);\n"
                            "#macro Place() <rand(S)*8-4, rand(S)*4-2, rand(S)*6-3> #end\n"
                            "#for (I, 1, 60) cylinder { Place(), Place(), 0.03\n"
                            "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.2 diffuse 0.7 } } #end\n"};

// Balls of a third of a pixel and less.
__attribute__((unused)) static const SamplingScene scene_dust = {
    "dust", SCENE_HEAD SCENE_CAMERA SCENE_SUN
    "#declare S = seed(3);\n"
    "#for (I, 1, 600) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*4-2>, 0.0175+0.035*rand(S)\n"
    "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.3 diffuse 0.7 } } #end\n"};

__attribute__((unused)) static const SamplingScene scene_marble = {
    "marble", SCENE_HEAD SCENE_CAMERA SCENE_SUN
    "plane { y, -1.5 pigment { marble turbulence 0.8 scale 0.15\n"
    "color_map { [0 rgb 0] [0.5 rgb 1] [1 rgb <0.8,0.2,0.1>] } } }\n"};

__attribute__((unused)) static const SamplingScene scene_cut = {
    "cut boxes", SCENE_HEAD SCENE_CAMERA SCENE_SUN
    "#for (I,-2,2) difference { box { <-0.7,-0.7,-0.7>+x*I*1.7, <0.7,0.7,0.7>+x*I*1.7 }\n"
    "sphere { <0.3,0.3,-0.4>+x*I*1.7, 0.7 } cylinder { <I*1.7,-2,0>, <I*1.7,2,0.1>, 0.25 }\n"
    "pigment { rgb <0.9,0.6,0.3> } finish { phong 0.7 } rotate <10*I,20*I,0> } #end\n"
    "plane { y, -2 pigment { checker rgb 1 rgb 0.3 } }\n"};

// Thin lines of a texture.
__attribute__((unused)) static const SamplingScene scene_lines = {
    "lines", SCENE_HEAD SCENE_CAMERA SCENE_SUN
    "plane { z, 2 pigment { gradient x color_map { [0 rgb 1] [0.93 rgb 1] [0.93 rgb 0] [1 rgb 0] }\n"
    "scale 0.5 rotate z*23 } finish { ambient 1 diffuse 0 } }\n"};

// One thing is much brighter than all else.
__attribute__((unused)) static const SamplingScene scene_lamp = {
    "lamp", SCENE_HEAD SCENE_CAMERA
    "light_source { <-8,12,-10> rgb 1 } sphere { 0, 1.5 pigment { rgb 0.6 } }\n"
    "sphere { <2.5,1,0>, 0.4 pigment { rgb 1 } finish { ambient 8 } }\n"};

__attribute__((unused)) static const SamplingScene scene_glints = {
    "glints", SCENE_HEAD SCENE_CAMERA SCENE_SUN
    "sphere { 0, 2 pigment { rgb 0.3 } finish { phong 3 phong_size 4000 } normal { bumps 0.3 scale 0.2 } }\n"
    "plane { y, -2 pigment { rgb 0.6 } }\n"};

// An area light's highlights are those of its middle, one of them half in a pixel that its corners pass by.
__attribute__((unused)) static const SamplingScene scene_area_glints = {
    "mirrors under an area light", SCENE_HEAD
    "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 } background { rgb <0.2,0.3,0.5> }\n"
    "light_source { <-5,7,-6> rgb 1 area_light <3,0,0>, <0,0,3>, 5, 7 jitter }\n"
    "#declare S = seed(2227); #macro R() rand(S) #end\n"
    "#for (I, 1, 9) sphere { <R()*7-3.5, R()*5-2.5, R()*6-3>, 0.3+0.6*R() pigment { rgb R() }\n"
    "finish { reflection 0.6 phong 2 phong_size 300 } } #end\n"};

__attribute__((unused)) static const SamplingScene scene_lens_balls = {
    "lens before balls", SCENE_HEAD
    "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 aperture 0.4 blur_samples 50\n"
    "focal_point <0,0,2> } " SCENE_SUN "#declare S = seed(17);\n"
    "#for (I, 1, 80) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*10-6>, 0.1+0.3*rand(S)\n"
    "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8 phong 1 } } #end\n"};

// Shapes of other kinds that are smaller than a pixel, and highlights.
__attribute__((unused)) static const SamplingScene scene_crumbs = {
    "crumbs", SCENE_HEAD SCENE_CAMERA SCENE_SUN "#declare S = seed(33);\n"
    "#macro P() <rand(S)*8-4, rand(S)*6-3, rand(S)*4-2> #end #macro C() pigment { rgb <rand(S),rand(S),rand(S)> }\n"
    "finish { ambient 0.5 diffuse 0.7 } #end\n"
    "#for (I, 1, 100) box { -0.03, 0.03 rotate <rand(S)*90,rand(S)*90,0> translate P() C() }\n"
    "sphere { 0, 0.03 scale <0.4,1.5,1> translate P() C() }\n"
    "triangle { <-0.05,0,0>, <0.05,0,0>, <0,0.07,0> translate P() C() }\n"
    "cone { 0, 0.05, <0,0.1,0>, 0.02 translate P() C() } disc { 0, <1,1,-2>, 0.05, 0.02 translate P() C() } #end\n"};

__attribute__((unused)) static const SamplingScene scene_glint = {
    "glint", SCENE_HEAD SCENE_CAMERA
    "light_source { <-8,12,-10> rgb 200 } background { rgb 0.2 } sphere { 0, 2 pigment { rgb 0.001 }\n"
    "finish { ambient 0.1 phong 1 phong_size 5000 diffuse 0.001 } }\n"};

__attribute__((unused)) static const SamplingScene scene_floor_glint = {
    "glint of a floor", SCENE_HEAD SCENE_CAMERA
    "light_source { <-2,5,9> rgb 200 } background { rgb 0.2 } plane { y, -1 pigment { checker rgb 0.001 rgb 0.002 }\n"
    "finish { ambient 0.1 specular 1 roughness 5e-6 diffuse 0.001 } }\n"};

__attribute__((unused)) static const SamplingScene scene_blurred_dust = {
    "dust before a lens", SCENE_HEAD
    "camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 aperture 0.1 blur_samples 50\n"
    "focal_point <0,0,0> } " SCENE_SUN "#declare S = seed(5);\n"
    "#for (I, 1, 150) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*10-5>, 0.005+0.03*rand(S)\n"
    "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 2 } } #end\n"};

__attribute__((unused)) static const SamplingScene scene_flat_dust = {
    "orthographic dust", SCENE_HEAD
    "camera { orthographic location <1,3,-9> look_at 0 right 8*x up 6*y } " SCENE_SUN "#declare S = seed(6);\n"
    "#for (I, 1, 150) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*10-5>, 0.005+0.03*rand(S)\n"
    "pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 2 } } #end\n"};

// Even light almost everywhere.
__attribute__((unused)) static const SamplingScene scene_even = {
    "even light",
    SCENE_HEAD SCENE_CAMERA "light_source { <-8,12,-10> rgb 1 }\n"
                            "sphere { <0,0.5,0>, 1 pigment { rgb <1,0.5,0.3> } finish { ambient 0.1 diffuse 0.7 } }\n"
                            "sphere { <2,0,1>, 0.8 pigment { rgb <0.3,0.5,1> } finish { ambient 0.1 diffuse 0.7 } }\n"};

__attribute__((unused)) static const SamplingScene *const sampling_scenes[] = {
    &scene_balls, &scene_soft, &scene_mirrors, &scene_checker, &scene_glass};

// Of all kinds, for what is told of the error; the first five above are among them.
__attribute__((unused)) static const SamplingScene *const error_scenes[] = {
    &scene_balls, &scene_soft,   &scene_mirrors, &scene_checker, &scene_glass, &scene_lens, &scene_noise, &scene_rods,
    &scene_even,  &scene_marble, &scene_cut,     &scene_lamp,    &scene_glints, &scene_lens_balls, &scene_dust,
    &scene_lines, &scene_crumbs, &scene_glint,   &scene_floor_glint, &scene_blurred_dust, &scene_flat_dust};
enum { ERROR_SCENES = RT_COUNT_OF(error_scenes) };

typedef struct Picture {
    int width, height;
    float *rgb;
    rt_error error;
    double seconds; // by the clock
    size_t reports;
    double report_samples[4096], report_done[4096]; // before the round on its way; done of the run, as predicted
    double report_at[4096], report_left[4096];      // seconds since the run began, and predicted to be left
} Picture;

typedef struct Running {
    rt_session *session;
    Picture *picture;
    double start;
} Running;

static inline double clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

__attribute__((unused)) static void on_progress(void *client, double done)
{
    Running *running = client;
    rt_error error;
    rt_get_error(running->session, &error);
    Picture *picture = running->picture;
    if (done > 0.0 && picture->reports < 4096 && error.known) {
        picture->report_at[picture->reports] = clock_seconds() - running->start;
        picture->report_left[picture->reports] = error.seconds_left;
        picture->report_samples[picture->reports] = error.samples;
        picture->report_done[picture->reports++] = done;
    }
}

// Samples of the whole run as they were predicted when a tenth of them had been taken; 0: no word then. With one thread
// reports come at equal steps of a round: two tell what was done when it began.
__attribute__((unused)) static double picture_predicted(const Picture *picture)
{
    size_t k = 0;
    while (k < picture->reports && picture->report_samples[k] < 0.1 * picture->error.samples) {
        k++;
    }
    if (k + 1 >= picture->reports) {
        return 0.0;
    }
    bool is_one = picture->report_samples[k + 1] == picture->report_samples[k];
    double begin = is_one ? 2.0 * picture->report_done[k] - picture->report_done[k + 1] : picture->report_done[k];
    return picture->report_samples[k] / begin;
}

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    (void)client;
    fputs(diagnostic->text, stderr);
}

// Aborts on failure: the scenes are right.
__attribute__((unused)) static Picture *picture_make_as(const SamplingScene *scene, int width, int height,
                                                        const rt_sampling *sampling, int threads, bool has_progress)
{
    Picture *picture = calloc(1, sizeof *picture);
    Running running = {.picture = picture};
    rt_callbacks callbacks = {&running, on_diagnostic, NULL, has_progress ? on_progress : NULL};
    rt_session *session = running.session = rt_session_new(&callbacks);
    if (!picture || !session || rt_set_size(session, width, height) || rt_set_sampling(session, sampling) ||
        rt_load_text(session, scene->name, scene->text, strlen(scene->text))) {
        abort();
    }
    running.start = clock_seconds();
    if (rt_render(session, threads)) {
        abort();
    }
    picture->seconds = clock_seconds() - running.start;
    const float *rgb = rt_pixels(session, &picture->width, &picture->height);
    size_t bytes = (size_t)width * (size_t)height * 3 * sizeof *rgb;
    picture->rgb = malloc(bytes);
    memcpy(picture->rgb, rgb, bytes);
    rt_get_error(session, &picture->error);
    rt_session_free(session);
    return picture;
}

__attribute__((unused)) static Picture *picture_make(const SamplingScene *scene, int width, int height,
                                                     const rt_sampling *sampling, int threads)
{
    return picture_make_as(scene, width, height, sampling, threads, true);
}

__attribute__((unused)) static void picture_free(Picture *picture)
{
    free(picture->rgb);
    free(picture);
}

__attribute__((unused)) static double picture_rmse(const Picture *a, const Picture *b)
{
    size_t count = (size_t)a->width * (size_t)a->height * 3;
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        sum += ((double)a->rgb[i] - b->rgb[i]) * ((double)a->rgb[i] - b->rgb[i]);
    }
    return sqrt(sum / (double)count);
}

// How many of some runs hold at the least, when nine in ten do: fewer come by chance once in 10^4 times. Runs have fresh
// seeds, so that a bar nearer to the share itself would fail by chance.
__attribute__((unused)) static int least_held(int runs)
{
    const double share = 0.9;
    int held = runs;
    double chance = pow(share, runs), more = 0.0; // of so many, and of more
    while (held > 0 && 1.0 - more - chance > 1e-4) {
        more += chance;
        chance *= held * (1.0 - share) / ((runs - held + 1) * share);
        held--;
    }
    return held;
}

#endif
