// Random scenes as numbers, as text of the language, and as calls with arrays: double or single, strided, backwards.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_BUILD_SCENES_H
#define UNIT_BUILD_SCENES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rtlang/rtlang.h"
#include "unit/random.h"

enum { WIDTH = 64, HEIGHT = 48, SHAPES_MOST = 60 };

// ---- messages

typedef struct Told {
    char texts[4096];
} Told;

static void keep_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    Told *told = client;
    size_t length = strlen(told->texts);
    snprintf(told->texts + length, sizeof told->texts - length, "%s", diagnostic->text);
}

static rt_session *session_open(Told *told)
{
    rt_callbacks callbacks = {.client = told, .diagnostic = keep_diagnostic};
    rt_session *session = rt_session_new(told ? &callbacks : NULL);
    if (told) {
        told->texts[0] = '\0';
    }
    if (!session || rt_set_size(session, WIDTH, HEIGHT)) {
        abort();
    }
    return session;
}

static bool says(Told *told, const char *text)
{
    bool is_said = strcmp(told->texts, text) == 0;
    if (!is_said) {
        printf("# said: %s# not:  %s", told->texts, text);
    }
    told->texts[0] = '\0';
    return is_said;
}

// ---- a random scene, as numbers and as text

typedef struct Numbers {
    size_t spheres, rods, triangles;
    int color_numbers;
    bool has_cones, is_smooth, is_single, is_packed;
    double centers[SHAPES_MOST][3], radii[SHAPES_MOST], colors[SHAPES_MOST][5];
    double rods_at[SHAPES_MOST][8]; // base, cap, radii
    double corners[SHAPES_MOST][9], normals[SHAPES_MOST][9];
    rt_camera camera;
    rt_light lights[2];
    double background[4];
    const char *finish;
} Numbers;

static double among(Random *random, double low, double high, bool is_single)
{
    double number = random_between(random, low, high);
    return is_single ? (double)(float)number : number;
}

static void fill(Random *random, double *numbers, size_t count, double low, double high, bool is_single)
{
    for (size_t i = 0; i < count; i++) {
        numbers[i] = among(random, low, high, is_single);
    }
}

static void numbers_make(Numbers *n, Random *random)
{
    static const char *const finishes[] = {NULL, "phong 0.7 ambient 0.2", "reflection 0.3 specular 0.4 roughness 0.02",
                                           "diffuse 0.8 brilliance 1.5"};
    static const int color_numbers[] = {3, 3, 4, 5};
    *n = (Numbers){.spheres = random_below(random, SHAPES_MOST + 1)};
    n->rods = random_below(random, 8);
    n->triangles = random_below(random, 8);
    n->color_numbers = color_numbers[random_below(random, 4)];
    n->has_cones = random_below(random, 2);
    n->is_smooth = random_below(random, 2);
    n->is_single = random_below(random, 2);
    n->finish = finishes[random_below(random, 4)];
    bool s = n->is_single;
    fill(random, n->centers[0], 3 * SHAPES_MOST, -3.0, 3.0, s);
    fill(random, n->radii, SHAPES_MOST, 0.05, 0.6, s);
    fill(random, n->colors[0], 5 * SHAPES_MOST, 0.0, 0.5, s);
    fill(random, n->rods_at[0], 8 * SHAPES_MOST, 0.1, 2.0, s);
    fill(random, n->corners[0], 9 * SHAPES_MOST, -2.0, 2.0, s);
    fill(random, n->normals[0], 9 * SHAPES_MOST, -0.2, 0.2, s);
    for (size_t i = 0; i < SHAPES_MOST; i++) { // normals near that of the triangle, all on one side
        const double *c = n->corners[i];
        double a[3], b[3];
        for (int k = 0; k < 3; k++) {
            a[k] = c[3 + k] - c[k];
            b[k] = c[6 + k] - c[k];
        }
        for (int k = 0; k < 9; k++) {
            int x = (k + 1) % 3, y = (k + 2) % 3;
            double normal = a[x] * b[y] - a[y] * b[x];
            n->normals[i][k] = s ? (double)(float)(normal + 0.01 * n->normals[i][k]) : normal + 0.01 * n->normals[i][k];
        }
    }
    n->camera = (rt_camera){.location = {0.0, 1.5, -9.0}, .look_at = {0.1, 0.2, 0.3}, .angle = 45.0};
    n->camera.location[0] = among(random, -2.0, 2.0, s);
    n->camera.right_handed = (int)random_below(random, 2);
    n->lights[0] = (rt_light){.position = {-4.0, 6.0, -7.0}, .color = {0.9, 0.8, 0.7}};
    n->lights[1] = (rt_light){.position = {5.0, 3.0, -6.0}, .color = {0.3, 0.4, 0.5}, .parallel = 1,
                              .point_at = {0.0, 0.5, 0.0}, .shadowless = (int)random_below(random, 2)};
    fill(random, n->background, 3, 0.0, 0.4, s);
}

static char *write_look(char *at, const Numbers *n, size_t i)
{
    static const char *const words[] = {"rgb", "rgbt", "rgbft"};
    at += sprintf(at, " pigment { %s <", words[n->color_numbers - 3]);
    for (int k = 0; k < n->color_numbers; k++) {
        at += sprintf(at, "%s%.17g", k > 0 ? ", " : "", n->colors[i][k]);
    }
    return at + sprintf(at, "> } finish { %s } }\n", n->finish ? n->finish : "");
}

static char *write_vector(char *at, const char *before, const double *v)
{
    return at + sprintf(at, "%s<%.17g, %.17g, %.17g>", before, v[0], v[1], v[2]);
}

static char *write_triangle(char *at, const Numbers *n, size_t i)
{
    at += sprintf(at, n->is_smooth ? "smooth_triangle {" : "triangle {");
    for (int k = 0; k < 3; k++) {
        at = write_vector(at, k > 0 ? ", " : " ", &n->corners[i][3 * k]);
        at = n->is_smooth ? write_vector(at, ", ", &n->normals[i][3 * k]) : at;
    }
    return write_look(at, n, i);
}

static char *write_view(char *at, const Numbers *n)
{
    const rt_camera *c = &n->camera;
    at = write_vector(at, "camera { location ", c->location);
    at += sprintf(at, " right %.17g*x up y angle %.17g", (c->right_handed ? -1.0 : 1.0) * WIDTH / HEIGHT, c->angle);
    at = write_vector(at, " look_at ", c->look_at);
    at = write_vector(at, " }\nlight_source { ", n->lights[0].position);
    at = write_vector(at, ", rgb ", n->lights[0].color);
    at = write_vector(at, " }\nlight_source { ", n->lights[1].position);
    at = write_vector(at, ", rgb ", n->lights[1].color);
    at = write_vector(at, " parallel point_at ", n->lights[1].point_at);
    at = write_vector(at + sprintf(at, "%s }\n", n->lights[1].shadowless ? " shadowless" : ""), "background { rgb ",
                      n->background);
    return at + sprintf(at, " }\n");
}

static void write_text(const Numbers *n, char *at)
{
    at += sprintf(at, "#version 3.7;\nglobal_settings { assumed_gamma 1 }\n");
    at = write_view(at, n);
    for (size_t i = 0; i < n->spheres; i++) {
        at = write_vector(at, "sphere { ", n->centers[i]);
        at = write_look(at + sprintf(at, ", %.17g", n->radii[i]), n, i);
    }
    for (size_t i = 0; i < n->rods; i++) {
        const double *rod = n->rods_at[i];
        at = write_vector(at, n->has_cones ? "cone { " : "cylinder { ", rod);
        at += n->has_cones ? sprintf(at, ", %.17g", rod[6] / 4) : 0;
        at = write_vector(at, ", ", rod + 3);
        at = write_look(at + sprintf(at, ", %.17g", rod[n->has_cones ? 7 : 6] / 4), n, i);
    }
    for (size_t i = 0; i < n->triangles; i++) {
        at = write_triangle(at, n, i);
    }
}

// ---- the same as arrays: double or float, one array a thing or all in one, forwards or backwards

typedef struct Arrays {
    void *blocks[16];
    size_t count;
} Arrays;

static rt_array array_of(Arrays *made, Random *random, const Numbers *n, const double *numbers, size_t each,
                         size_t from_each, size_t count)
{
    size_t gap = random_below(random, 3), size = n->is_single ? sizeof(float) : sizeof(double), step = 1 + gap;
    bool is_backward = random_below(random, 2);
    char *block = calloc(count * from_each * step + 1, size);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < from_each; k++) {
            size_t row = is_backward ? count - 1 - i : i;
            double number = numbers[i * each + k];
            float narrow = (float)number;
            memcpy(block + (row * from_each + k) * step * size, n->is_single ? (void *)&narrow : (void *)&number, size);
        }
    }
    made->blocks[made->count++] = block;
    ptrdiff_t stride = (ptrdiff_t)(from_each * step * size);
    return (rt_array){block + (is_backward && count > 0 ? (ptrdiff_t)(count - 1) * stride : 0),
                      n->is_single ? RT_FLOAT32 : RT_FLOAT64, is_backward ? -stride : stride, (ptrdiff_t)(step * size)};
}

static rt_look look_of(Arrays *made, Random *random, const Numbers *n, size_t count)
{
    return (rt_look){array_of(made, random, n, n->colors[0], 5, (size_t)n->color_numbers, count), n->color_numbers,
                     n->finish};
}

static rt_status add_view(rt_session *session, const Numbers *n)
{
    rt_status status = rt_set_camera(session, &n->camera);
    status = status ? status : rt_add_light(session, &n->lights[0]);
    status = status ? status : rt_add_light(session, &n->lights[1]);
    return status ? status : rt_set_background(session, n->background);
}

static rt_status add_spheres(rt_session *session, Random *random, const Numbers *n, size_t *group)
{
    Arrays made = {.count = 0};
    rt_spheres spheres = {.count = n->spheres,
                          .centers = array_of(&made, random, n, n->centers[0], 3, 3, n->spheres),
                          .radii = array_of(&made, random, n, n->radii, 1, 1, n->spheres),
                          .look = look_of(&made, random, n, n->spheres)};
    rt_status status = rt_add_spheres(session, &spheres, group);
    for (size_t i = 0; i < made.count; i++) {
        free(made.blocks[i]);
    }
    return status;
}

static rt_status add_others(rt_session *session, Random *random, const Numbers *n)
{
    Arrays made = {.count = 0};
    double quarters[SHAPES_MOST][2];
    for (size_t i = 0; i < n->rods; i++) {
        quarters[i][0] = n->rods_at[i][6] / 4;
        quarters[i][1] = n->rods_at[i][7] / 4;
    }
    rt_rods rods = {.count = n->rods,
                    .bases = array_of(&made, random, n, n->rods_at[0], 8, 3, n->rods),
                    .caps = array_of(&made, random, n, n->rods_at[0] + 3, 8, 3, n->rods),
                    .base_radii = array_of(&made, random, n, quarters[0], 2, 1, n->rods),
                    .look = look_of(&made, random, n, n->rods)};
    rt_triangles triangles = {.count = n->triangles,
                              .corners = array_of(&made, random, n, n->corners[0], 9, 9, n->triangles),
                              .look = look_of(&made, random, n, n->triangles)};
    if (n->has_cones) {
        rods.cap_radii = array_of(&made, random, n, quarters[0] + 1, 2, 1, n->rods);
    }
    if (n->is_smooth) {
        triangles.normals = array_of(&made, random, n, n->normals[0], 9, 9, n->triangles);
    }
    rt_status status = rt_add_rods(session, &rods);
    status = status ? status : rt_add_triangles(session, &triangles);
    for (size_t i = 0; i < made.count; i++) {
        free(made.blocks[i]);
    }
    return status;
}

static rt_status add_shapes(rt_session *session, Random *random, const Numbers *n, size_t *group)
{
    rt_status status = add_spheres(session, random, n, group);
    return status ? status : add_others(session, random, n);
}

#endif
