// SPDX-License-Identifier: MIT
#include "exact/families.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/attributes.h"

// ---- what scenes are made of

static double between(Random *random, double low, double high)
{
    return random_between(random, low, high);
}

static double power(Random *random, double low, double high)
{
    return pow(10.0, between(random, low, high));
}

static ExactShape *shape(Random *random, ExactScene *scene)
{
    ExactShape *own = &scene->shapes[scene->shape_count++];
    *own = (ExactShape){.mirror = between(random, 0, 1) < 0.4 ? 0.4 : 0.0};
    own->phong = between(random, 0, 1) < 0.5 ? 0.4 : 0.0;
    for (int i = 0; i < 3; i++) {
        own->rgb[i] = between(random, 0.3, 1.0);
    }
    return own;
}

static ExactShape *ball(Random *random, ExactScene *scene, double x, double y, double z, double radius)
{
    ExactShape *own = shape(random, scene);
    own->centre[0] = x;
    own->centre[1] = y;
    own->centre[2] = z;
    own->radius = radius;
    return own;
}

static ExactShape *floor_at(Random *random, ExactScene *scene, double height)
{
    ExactShape *own = shape(random, scene);
    own->is_plane = true;
    own->axis = 1;
    own->distance = height;
    return own;
}

static void light(ExactScene *scene, double x, double y, double z, double strength)
{
    scene->lights[scene->light_count++] = (ExactLight){{x, y, z}, {strength, strength, strength}};
}

// A few, or so many that they are in a tree.
static int few_or_many(Random *random)
{
    return between(random, 0, 1) < 0.6 ? 6 : 30;
}

// An eye that looks along z, with a screen so wide at distance 1.
static void eye(ExactScene *scene, double x, double y, double z, double width)
{
    *scene = (ExactScene){.location = {x, y, z}, .direction = {0, 0, 1}, .bits = 320};
    scene->right[0] = scene->up[1] = width;
}

// The same, turned so that it looks down by a slope.
static void look_down(ExactScene *scene, double slope)
{
    scene->direction[1] = -slope;
}

static void balls_about(Random *random, ExactScene *scene, int count, double spread, double z)
{
    for (int i = 0; i < count; i++) {
        Vec3 at = random_vec3(random, -spread, spread);
        double radius = between(random, 0.1, 0.45) * spread;
        ball(random, scene, at.x, at.y, z + at.z, radius);
    }
}

// ---- families

static void ordinary(Random *random, ExactScene *scene)
{
    eye(scene, 0, 0, -6, 1);
    balls_about(random, scene, 6, 2, 0);
    floor_at(random, scene, -2);
    light(scene, 5, 8, -9, 0.7);
    light(scene, -7, 6, -5, 0.4);
}

static void many(Random *random, ExactScene *scene)
{
    eye(scene, 0, 0, -6, 1);
    for (int i = 0; i < 40; i++) {
        Vec3 at = random_vec3(random, -3, 3);
        double radius = between(random, 0.1, 0.6);
        ball(random, scene, at.x, at.y, at.z + 1, radius);
    }
    light(scene, 5, 8, -9, 0.7);
}

// A ball whose top is at the origin, and balls of some spacings of its radius about there.
static void large_ball(Random *random, ExactScene *scene)
{
    double radius = power(random, 3, 14), spacing = nextafter(radius, HUGE_VAL) - radius;
    double size = spacing * power(random, 0.5, 3);
    eye(scene, 0, 3 * size, -6 * size, 1.2);
    look_down(scene, 0.4);
    ball(random, scene, 0, -radius, 0, radius)->mirror = 0.4;
    for (int i = few_or_many(random); i > 0; i--) {
        double own = size * between(random, 0.3, 0.8);
        double x = size * between(random, -2, 2);
        double above = size * between(random, 0, 1);
        double z = size * between(random, -2, 3);
        ball(random, scene, x, own + above, z, own);
    }
    light(scene, 5 * size, 8 * size, -6 * size, 0.8);
}

// The same with the eye anywhere above, low or high, and balls that are not so small.
static void eye_low(Random *random, ExactScene *scene)
{
    double radius = power(random, 2, 10), height = radius * power(random, -9, -1);
    eye(scene, 0, height, 0, 1.5);
    look_down(scene, between(random, 0, 0.3));
    ball(random, scene, 0, -radius, 0, radius)->mirror = 0.4;
    for (int i = few_or_many(random); i > 0; i--) {
        double z = height * between(random, 2, 12), own = height * between(random, 0.2, 0.8);
        ball(random, scene, z * between(random, -0.5, 0.5), own, z, own);
    }
    light(scene, 3 * height, 9 * height, 2 * height, 0.8);
}

// Small things next to a light, and what they throw shadows on is very far away.
static void far_receiver(Random *random, ExactScene *scene)
{
    double distance = power(random, 9, 16);
    double x = between(random, 1, 3);
    double y = between(random, -2, 2);
    eye(scene, x, y, -2, 2.5);
    ExactShape *wall = shape(random, scene);
    *wall = (ExactShape){.is_plane = true, .axis = 2, .distance = distance, .rgb = {1, 0.9, 0.8}};
    Vec3 lamp = random_vec3(random, -1, 1);
    light(scene, lamp.x, lamp.y, lamp.z, 0.9);
    for (int i = few_or_many(random); i > 0; i--) {
        Vec3 at = random_vec3(random, -3, 3);
        double z = between(random, 1.5, 4);
        double radius = between(random, 0.1, 0.8);
        ball(random, scene, at.x, at.y, z, radius);
    }
}

static void shells(Random *random, ExactScene *scene)
{
    eye(scene, 0, 0, -6, 0.8);
    for (int i = few_or_many(random) / 2; i > 0; i--) {
        double x = between(random, -2, 2), y = between(random, -2, 2), z = between(random, 0, 2);
        double r = between(random, 0.4, 1);
        double gap = power(random, -16, -9), inner = r - gap * r;
        bool is_inner_first = between(random, 0, 1) < 0.5;
        ball(random, scene, x, y, z, is_inner_first ? inner : r);
        ball(random, scene, x, y, z, is_inner_first ? r : inner);
    }
    light(scene, 5, 8, -9, 0.8);
}

// Shells from inside: the eye and the light are in them.
static void shells_within(Random *random, ExactScene *scene)
{
    eye(scene, 0.1, 0.2, 0, 1.5);
    for (int i = 0; i < 3; i++) {
        ball(random, scene, 0.3, 0.1, 0.2, 4.0 + power(random, -15, -9));
    }
    balls_about(random, scene, 3, 0.5, 2);
    light(scene, 0.5, 1.5, -0.5, 0.8);
}

static void telescope(Random *random, ExactScene *scene)
{
    double away = power(random, 3, 11);
    eye(scene, 0, 0, -away, 5 / away);
    balls_about(random, scene, few_or_many(random), 2, 0);
    light(scene, 5, 8, -9, 0.7);
}

// Light that falls between balls that all but touch.
static void slits(Random *random, ExactScene *scene)
{
    double gap = power(random, -9, -3);
    eye(scene, 0, 1.5 * gap, -4 * gap, 1.5);
    look_down(scene, 0.3);
    floor_at(random, scene, -gap);
    ball(random, scene, -1 - 0.5 * gap, 0.3 * gap, 0, 1);
    ball(random, scene, 1 + 0.5 * gap, 0, 0.5 * gap, 1);
    light(scene, 0.2 * gap, 3 * gap, between(random, -1, 3) * gap, 0.8);
    light(scene, 0, 30, 0.1, 0.4);
}

static void light_at_surface(Random *random, ExactScene *scene)
{
    double height = power(random, -12, -2), x = between(random, -0.5, 0.5), z = between(random, -1, 0);
    eye(scene, 0, 1, -4, 1);
    look_down(scene, 0.3);
    floor_at(random, scene, 0);
    ball(random, scene, x, 1, z, 1)->mirror = 0.0;
    light(scene, x, 2 + height, z, 0.5);
    light(scene, x + 2, height, z - 1, 0.5);
    balls_about(random, scene, 3, 1.5, 1);
}

static void mirror_chain(Random *random, ExactScene *scene)
{
    double gap = power(random, -3, 0);
    eye(scene, 0.2, 0.3, -4, 0.8);
    ball(random, scene, -1 - gap, 0, 0, 1)->mirror = 0.4;
    ball(random, scene, 1 + gap, 0, 0, 1)->mirror = 0.4;
    ball(random, scene, 0, -1.8, 0.3, 1)->mirror = 0.4;
    floor_at(random, scene, -2.5);
    light(scene, 3, 6, -5, 0.8);
}

static void closed_mirror(Random *random, ExactScene *scene)
{
    eye(scene, 0.3, 0.1, -1.5, 1.2);
    ball(random, scene, 0, 0, 0, between(random, 3, 5))->mirror = 0.4;
    balls_about(random, scene, 3, 0.7, 1);
    light(scene, 0.5, 1.2, -1, 0.6);
}

static void parallel_mirrors(Random *random, ExactScene *scene)
{
    double gap = power(random, -6, 1);
    eye(scene, 0, 0, -2 * gap, 1.5);
    floor_at(random, scene, -gap)->mirror = 0.4;
    floor_at(random, scene, gap)->mirror = 0.4;
    balls_about(random, scene, 4, gap, 2 * gap);
    light(scene, 0.1 * gap, 0.9 * gap, -gap, 0.8);
}

static void moved(Random *random, ExactScene *scene)
{
    double by[3];
    ordinary(random, scene);
    scene->shapes[6].axis = 1;
    for (int i = 0; i < 3; i++) {
        by[i] = power(random, 2, 6);
        scene->location[i] += by[i];
    }
    for (int k = 0; k < scene->shape_count; k++) {
        for (int i = 0; i < 3; i++) {
            scene->shapes[k].centre[i] += by[i];
        }
        scene->shapes[k].distance += by[1];
    }
    for (int k = 0; k < scene->light_count; k++) {
        for (int i = 0; i < 3; i++) {
            scene->lights[k].position[i] += by[i];
        }
    }
}

static void scale_all(ExactScene *scene, double by)
{
    for (int i = 0; i < 3; i++) {
        scene->location[i] *= by;
        for (int k = 0; k < scene->shape_count; k++) {
            scene->shapes[k].centre[i] *= by;
        }
        for (int k = 0; k < scene->light_count; k++) {
            scene->lights[k].position[i] *= by;
        }
    }
    for (int k = 0; k < scene->shape_count; k++) {
        scene->shapes[k].radius *= by;
        scene->shapes[k].distance *= by;
    }
}

static void scaled(Random *random, ExactScene *scene)
{
    ordinary(random, scene);
    scale_all(scene, power(random, -290, 290));
}

// A ball in each of many powers of ten, all of about one size as the eye sees them.
static void any_exponents(Random *random, ExactScene *scene)
{
    double span = between(random, 5, 120);
    eye(scene, 0, 0, 0, 1.2);
    scene->bits = 1700;
    for (int i = few_or_many(random); i > 0; i--) {
        double away = power(random, -span, span);
        double x = away * between(random, -0.6, 0.6);
        double y = away * between(random, -0.6, 0.6);
        double radius = away * between(random, 0.05, 0.25);
        ball(random, scene, x, y, away, radius);
    }
    double away = power(random, -span, span);
    double x = between(random, -1, 1) * away;
    double y = between(random, 0, 1) * away;
    double z = -between(random, 0, 1) * away;
    light(scene, x, y, z, 0.8);
}

// An ordinary scene with what cannot be held beside it.
static void extremes(Random *random, ExactScene *scene)
{
    ordinary(random, scene);
    scene->bits = 2600;
    bool is_small = between(random, 0, 1) < 0.5;
    double x = is_small ? between(random, -1, 1) : power(random, 260, 300);
    double y = is_small ? between(random, -1, 1) : power(random, 260, 300);
    double radius = is_small ? power(random, -315, -260) : power(random, -5, 200);
    ball(random, scene, x, y, is_small ? -3 : 1, radius);
}

static void tangent(Random *random, ExactScene *scene)
{
    eye(scene, 0, 1, -5, 1);
    look_down(scene, 0.15);
    floor_at(random, scene, 0);
    for (int i = 0; i < 5; i++) {
        double r = between(random, 0.3, 0.9);
        double x = between(random, -2, 2);
        double z = between(random, -1, 3);
        ball(random, scene, x, r, z, r);
        ball(random, scene, 0, 0, 0, r);
        ExactShape *upper = &scene->shapes[scene->shape_count - 1], *lower = upper - 1;
        upper->centre[0] = lower->centre[0];
        upper->centre[1] = 3 * r;
        upper->centre[2] = lower->centre[2];
    }
    light(scene, 5, 8, -9, 0.8);
}

static void grazing_light(Random *random, ExactScene *scene)
{
    double height = power(random, -7, -1);
    eye(scene, 0, 1, -4, 1);
    look_down(scene, 0.3);
    floor_at(random, scene, 0);
    for (int i = 0; i < 6; i++) {
        double r = height * between(random, 0.3, 3);
        double x = between(random, -2, 2);
        double z = between(random, -1, 3);
        ball(random, scene, x, r, z, r);
    }
    light(scene, -9, height, 0.5, 0.8);
}

static void planet(Random *random, ExactScene *scene)
{
    double radius = power(random, 5, 8);
    eye(scene, 0, 2, -9, 1);
    ball(random, scene, 0, -radius, 0, radius);
    balls_about(random, scene, few_or_many(random), 2, 2);
    light(scene, 3e10, 1e11, -5e10, 0.8);
}

static void inside_ball(Random *random, ExactScene *scene)
{
    double radius = power(random, 1, 9);
    eye(scene, 0, 0, -3, 1);
    ball(random, scene, 0, radius - 3, 0, radius)->mirror = 0.4;
    balls_about(random, scene, 5, 1.5, 0);
    light(scene, 2, 3, -4, 0.8);
}

// Balls aside of the eye's axis whose distances differ by little.
static void ties(Random *random, ExactScene *scene)
{
    double r = between(random, 0.5, 2);
    eye(scene, 0, 0, -6, 0.8);
    for (int i = 0; i < 10; i++) {
        double aside = power(random, -16, -6);
        Vec3 at = vec3_scale(aside, random_vec3(random, -1, 1));
        ball(random, scene, at.x, at.y, at.z, r * (1 + 0.3 * aside));
    }
    light(scene, 5, 8, -9, 0.8);
}

const Family families[] = {
    {"ordinary", ordinary},
    {"a tree of 40 balls", many},
    {"balls of some spacings of a large ball's radius on it", large_ball},
    {"an eye close above a large ball", eye_low},
    {"shadows on what is very far from the light", far_receiver},
    {"shells", shells},
    {"shells from within", shells_within},
    {"balls that nearly coincide", ties},
    {"telescopes", telescope},
    {"slits", slits},
    {"lights at surfaces", light_at_surface},
    {"light that grazes a floor", grazing_light},
    {"chains of mirrors", mirror_chain},
    {"a closed mirror", closed_mirror},
    {"parallel mirrors", parallel_mirrors},
    {"inside of a large mirror", inside_ball},
    {"balls that touch", tangent},
    {"a planet and its sun", planet},
    {"far from the origin", moved},
    {"scaled by 1e-290 to 1e290", scaled},
    {"any exponents", any_exponents},
    {"lengths that no double holds together", extremes},
};
const int family_count = RT_COUNT_OF(families);
