// What a ray is inside of, and what its surfaces do to it: bending, total reflection, Fresnel's share, fading.
//
// A ray keeps the bodies it has entered and not left, in that order; what it travels in is the last one, with empty
// space below. All measured beside POV-Ray; the formulas are Snell's and Fresnel's, as in any textbook of optics.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_INSIDE_H
#define RENDER_INSIDE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/colour.h"
#include "math/vec3.h"
#include "scene/scene.h"

enum { INSIDE_MAX = 64 }; // bodies that are entered while a ray is inside of so many are not remembered

typedef struct InsideEntry {
    uint64_t body;     // scene_body_key
    uint32_t interior; // Scene.interiors, or RECORD_NONE for empty space
    bool is_solid;     // of a scene with fog: there is none inside of it
} InsideEntry;

typedef struct Inside {
    uint32_t count;
    InsideEntry entries[INSIDE_MAX];
} Inside;

static inline void inside_copy(Inside *to, const Inside *from)
{
    to->count = from->count;
    for (uint32_t i = 0; i < from->count; i++) {
        to->entries[i] = from->entries[i];
    }
}

static inline void inside_enter(Inside *inside, uint64_t body, uint32_t interior, bool is_solid)
{
    if (inside->count < INSIDE_MAX) {
        inside->entries[inside->count++] = (InsideEntry){body, interior, is_solid};
    }
}

static inline bool inside_is_solid(const Inside *inside)
{
    bool is_solid = false;
    for (uint32_t i = 0; i < inside->count; i++) {
        is_solid |= inside->entries[i].is_solid;
    }
    return is_solid;
}

// The body need not be the one entered last; false when it is not there at all.
static inline bool inside_leave(Inside *inside, uint64_t body)
{
    uint32_t at = inside->count;
    while (at > 0 && inside->entries[at - 1].body != body) {
        at--;
    }
    if (at > 0) {
        for (inside->count--; at - 1 < inside->count; at++) {
            inside->entries[at - 1] = inside->entries[at];
        }
        return true;
    }
    return false;
}

static inline double inside_ior(const Interior *interiors, const Inside *inside)
{
    uint32_t interior = inside->count > 0 ? inside->entries[inside->count - 1].interior : RECORD_NONE;
    return interior == RECORD_NONE ? 1.0 : interiors[interior].ior;
}

// The indices of refraction before and behind a surface as Fresnel's share has them. Of several shapes that a ray is in,
// the one that it leaves counts as what is before. Measured.
static inline void inside_fresnel_sides(const Interior *interiors, const Inside *before, const Inside *behind,
                                        uint32_t interior, bool leaves, double *ior_before, double *ior_behind)
{
    double medium = inside_ior(interiors, before);
    double own = interior == RECORD_NONE ? 1.0 : interiors[interior].ior;
    bool is_nested = leaves && before->count > 1;
    *ior_before = is_nested ? own : medium;
    *ior_behind = is_nested ? medium : inside_ior(interiors, behind);
}

// The direction behind a surface where the index of refraction becomes `ratio` times what it was; false when nothing
// gets through. `direction` and `normal` are of unit length, the normal against the direction.
static inline bool inside_bend(Vec3 direction, Vec3 normal, double ratio, Vec3 *bent)
{
    double eta = 1.0 / ratio;
    double cosine = -vec3_dot(direction, normal);
    double square = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if (!(square >= 0.0)) {
        return false;
    }
    *bent = vec3_normalize(vec3_add_scaled(vec3_scale(eta, direction), eta * cosine - sqrt(square), normal));
    return true;
}

// The share of unpolarised light that a clear surface reflects (Fresnel's equations in the form of R. Cook, K.
// Torrance, "A Reflectance Model for Computer Graphics", ACM TOG 1(1), 1982).
static inline double inside_fresnel(double cosine, double ratio)
{
    double square = ratio * ratio - 1.0 + cosine * cosine;
    if (!(square > 0.0)) {
        return 1.0;
    }
    double g = sqrt(square);
    double first = (g - cosine) / (g + cosine);
    double second = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * first * first * (1.0 + second * second);
}

// What is left of light after a way through an interior, in the scene's lengths.
static inline Rgb inside_fade(const Interior *interior, double way)
{
    double relative = way / interior->fade_distance;
    Rgb colour = interior->fade_colour;
    if (interior->fade_power >= 1000.0) {
        return rgb(exp((colour.red - 1.0) * relative), exp((colour.green - 1.0) * relative),
                   exp((colour.blue - 1.0) * relative));
    }
    double left = 1.0 / (1.0 + pow(relative, interior->fade_power));
    return rgb(colour.red + (1.0 - colour.red) * left, colour.green + (1.0 - colour.green) * left,
               colour.blue + (1.0 - colour.blue) * left);
}

#endif
