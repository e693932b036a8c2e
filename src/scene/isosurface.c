// A function along a line, halved until a piece is short: no piece is looked into where the function cannot reach the
// threshold, as long as `max_gradient` is right.
//
// SPDX-License-Identifier: MIT
#include "scene/isosurface.h"

#include <math.h>

#include "scene/scene.h"

void isosurface_bounds(const Isosurface *surface, Vec3 *low, Vec3 *high)
{
    const double *a = surface->low, *b = surface->high;
    *low = vec3(a[0], a[1], a[2]);
    *high = vec3(b[0], b[1], b[2]);
    if (isosurface_is(surface, ISOSURFACE_ROUND)) {
        Vec3 middle = *low;
        *low = vec3_sub(middle, *high);
        *high = vec3_add(middle, *high);
    }
}

static double value_at(const double *list, const FormulaSource *source, Vec3 p)
{
    const Isosurface *surface = isosurface_of(list);
    double numbers[3 + FORMULA_STACK_MOST + 1];
    numbers[0] = p.x;
    numbers[1] = p.y;
    numbers[2] = p.z;
    formula_run(source, (uint32_t)surface->first, numbers, numbers + 3);
    return numbers[3] - surface->threshold;
}

static FormulaSource source_of(const double *list, const FormulaHost *host)
{
    return formula_source_of(isosurface_steps(list), isosurface_of(list)->generator, host);
}

double isosurface_value(const double *list, const FormulaHost *host, Vec3 p)
{
    FormulaSource source = source_of(list, host);
    return value_at(list, &source, p);
}

static bool container_holds(const Isosurface *surface, Vec3 p)
{
    const double at[3] = {p.x, p.y, p.z};
    if (isosurface_is(surface, ISOSURFACE_ROUND)) {
        Vec3 from = vec3_sub(p, vec3(surface->low[0], surface->low[1], surface->low[2]));
        return vec3_length_squared(from) <= surface->high[0] * surface->high[0];
    }
    bool holds = true;
    for (int axis = 0; axis < 3; axis++) {
        holds = holds && surface->low[axis] <= at[axis] && at[axis] <= surface->high[axis];
    }
    return holds;
}

bool isosurface_holds(const double *list, const FormulaHost *host, Vec3 p)
{
    return container_holds(isosurface_of(list), p) && isosurface_value(list, host, p) <= 0.0;
}

IsosurfaceLine isosurface_line(const double *list, const FormulaHost *host, Ray ray, double length)
{
    const Isosurface *surface = isosurface_of(list);
    return (IsosurfaceLine){.list = list,
                            .source = source_of(list, host),
                            .ray = ray,
                            .step = surface->accuracy / length,
                            .rise = surface->max_gradient * vec3_length(ray.direction)};
}

double isosurface_along(const IsosurfaceLine *line, double t)
{
    return value_at(line->list, &line->source, ray_at(line->ray, t));
}

// A place on a line, and what the function is there, turned so that it comes down.
typedef struct Place {
    double t, f;
} Place;

enum {
    HALVINGS_MOST = 64, // more leave nothing of a double
    ASKED_EVERY = 1024, // so often it checks whether the run was cancelled
};

static Place place_at(const IsosurfaceLine *line, double t, double sign)
{
    return (Place){t, sign * isosurface_along(line, t)};
}

bool isosurface_find(IsosurfaceLine *line, double from, double to, bool up, double *t)
{
    double sign = up ? -1.0 : 1.0;
    Place begin = place_at(line, from, sign), end = place_at(line, to, sign), waiting[HALVINGS_MOST];
    unsigned count = 0;
    for (unsigned asked = 1;; asked++) {
        double length = end.t - begin.t, steep = fabs(begin.f - end.f) / length;
        line->steepest = steep > line->steepest && steep < HUGE_VAL ? steep : line->steepest;
        bool is_left_out = begin.f + end.f >= line->rise * length;
        double middle = begin.t + 0.5 * length;
        bool is_short =
            length < line->step || count == HALVINGS_MOST || !(begin.t < middle && middle < end.t); // between doubles
        if (!is_left_out && !is_short) {
            waiting[count++] = end;
            end = place_at(line, middle, sign);
            continue;
        }
        if (!is_left_out && end.f < 0.0) {
            *t = end.t;
            return true;
        }
        if (count == 0 || (asked % ASKED_EVERY == 0 && line->is_over && line->is_over(line->client))) {
            return false;
        }
        begin = end;
        end = waiting[--count];
    }
}
