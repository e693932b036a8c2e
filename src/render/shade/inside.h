// What the surfaces of what a ray is inside of do to it: bending, total reflection, Fresnel's share, fading.
//
// All measured beside POV-Ray; the formulas are Snell's and Fresnel's, as in any textbook of optics.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_INSIDE_H
#define RENDER_SHADE_INSIDE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/colour.h"
#include "math/vec3.h"
#include "render/records/prepared.h"
#include "scene/scene.h"

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

// What a ray that starts at a point of prepared space is inside of, the outermost first.
void prepared_inside(const Prepared *prepared, Vec3 point, MediumList *list);

// The same of a camera ray, as all that a table holds.
MediumStack prepared_start(const Prepared *prepared, Vec3 origin, MediumTable *table);

#endif
