// Formulas as patterns: what a function gives at a point, and the grey of a pigment.
//
// Steps that ask a pattern or a pigment go back to the textures. Owns nothing.
//
// SPDX-License-Identifier: MIT
#include "render/surface/formula.h"

#include <math.h>

#include "render/surface/texture.h"

// Where a point is not finite nothing lies there.
static double painted_of(const void *client, const FormulaStep *step, const double *a)
{
    const NoiseSource *source = client;
    Vec3 p = vec3(a[0], a[1], a[2]);
    if (!vec3_is_finite(p)) {
        return (double)NAN;
    }
    if (step->op == FORMULA_PATTERN) {
        return texture_pattern_value(source->table, step->which, p);
    }
    Rgbft colour = texture_pigment(source->table, &(Pigment){.pattern = step->which}, p);
    const double v[5] = {(double)(float)colour.red, (double)(float)colour.green, (double)(float)colour.blue,
                         (double)(float)colour.filter, (double)(float)colour.transmit};
    return formula_component(step, v);
}

void formula_paint(FormulaHost *host, const NoiseSource *source)
{
    host->painted = painted_of;
    host->client = source;
}

void formula_unpaint(FormulaHost *host, const NoiseSource *source)
{
    if (host->client == source) {
        host->painted = NULL;
        host->client = NULL;
    }
}

// What is above 1 begins anew, exactly; other patterns do so after 1.00001. Measured.
double formula_value(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    double numbers[3 + FORMULA_STACK_MOST + 1] = {p.x, p.y, p.z};
    FormulaSource formula = {source->steps, source->noise, source->generator, painted_of, source};
    formula_run(&formula, pattern->image, numbers, numbers + 3);
    return numbers[3] > 1.0 ? fmod(numbers[3], 1.0) : numbers[3];
}

double formula_pigment(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return rgb_luminance(rgbft_rgb(texture_pigment(source->table, &(Pigment){.pattern = pattern->image}, p)));
}

double formula_picture(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return image_value(&source->table->images[pattern->image], p);
}

double formula_density(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return image_density(&source->table->images[pattern->image], pattern->count, p);
}

double formula_material(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    return image_number(&source->table->images[pattern->image], p, (uint32_t)pattern->count);
}
