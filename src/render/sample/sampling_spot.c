// Highlights narrower than a pixel and a half: where they are, and how far they reach.
//
// A highlight is brightest where the normal halves the angle between the directions to the eye and to the light: on a
// sphere that place is found by bisection (Alhazen's problem), on a plane by the eye's mirror image. Over a length s on
// the surface the mirrored direction turns from that to the light by s (2 / R + (1 / E + 1 / L) cos i), with R the
// radius, E and L the distances of eye and light and i the angle of incidence, and across that by s (2 / R cos i +
// 1 / E + 1 / L). `phong` falls as cos^p of that angle, by e^-4 at sqrt(8 / p). `specular` goes by the angle between
// the normal and the middle of both directions, which turns half as much, and across by s (1 / R + (1 / E + 1 / L) /
// (2 cos i)), since the sum of two directions is 2 cos i long. Spots are listed and looked at as small shapes are.
// Other surfaces' highlights are searched for: sampling_glint.c. docs/sampling.md, "What no sample met".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "render/sample/sampling_small.h"
#include "render/shade/light.h"

enum {
    BISECTIONS = 40,
    SPOTS_MOST = 1 << (SHAPE_INDEX_BITS - 2), // more are left out
};

// What may have highlights.
typedef struct Shiny {
    ShapeId shape;
    bool is_ball;
    Vec3 centre, normal; // of a plane: a point of it, and its side
    double radius;       // infinite for a plane
    MaterialIndex material;
    const PreparedFinish *finish;
} Shiny;

typedef struct Ends {
    const PreparedCamera *camera;
    const PreparedLight *light;
} Ends;

// The finish of a surface that shines alike at all its points; NULL for others, and where it is bumpy.
const PreparedFinish *spot_finish(const Prepared *p, MaterialIndex material)
{
    const PreparedFinish *finish = NULL;
    if (!(material & MATERIAL_COMPOUND)) {
        finish = &p->finishes[p->materials[material].finish];
    } else {
        const Texture *texture = texture_single(&p->textures, p->compounds[material & ~MATERIAL_COMPOUND].texture);
        finish = texture && texture->normal == RECORD_NONE ? &p->finishes[texture->finish] : NULL;
    }
    return finish && finish->shines ? finish : NULL;
}

// The way from a point to the eye or to the light, of unit length, and how long it is.
static Vec3 way_to_eye(const Ends *ends, Vec3 point, double *distance)
{
    Vec3 way = vec3_sub(ends->camera->location, point);
    *distance = ends->camera->type == CAMERA_ORTHOGRAPHIC ? (double)INFINITY : vec3_length(way);
    return isinf(*distance) ? vec3_neg(ends->camera->direction) : vec3_scale(1.0 / *distance, way);
}

Vec3 spot_to_light(const PreparedLight *light, Vec3 point, double *distance)
{
    Vec3 way = vec3_sub(light->position, point);
    *distance = light->parallel ? (double)INFINITY : vec3_length(way);
    return isinf(*distance) ? light->towards : vec3_scale(1.0 / *distance, way);
}

// The normal where a ball mirrors the light to the eye. False where either is inside of it.
static bool ball_normal(const Ends *ends, const Shiny *shiny, Vec3 *normal)
{
    double eye, light, low = 0.0, high = 1.0;
    Vec3 to_eye = way_to_eye(ends, shiny->centre, &eye), to_light = spot_to_light(ends->light, shiny->centre, &light);
    *normal = to_eye;
    Vec3 across = vec3_add_scaled(to_light, -vec3_dot(to_eye, to_light), to_eye);
    double sine = vec3_length(across), angle = atan2(sine, vec3_dot(to_eye, to_light));
    for (int i = 0; sine > 0.0 && i < BISECTIONS; i++) {
        double unused, middle = 0.5 * (low + high);
        *normal = vec3_add_scaled(vec3_scale(cos(middle * angle), to_eye), sin(middle * angle) / sine, across);
        Vec3 point = vec3_add_scaled(shiny->centre, shiny->radius, *normal);
        bool is_before =
            vec3_dot(spot_to_light(ends->light, point, &unused), *normal) < vec3_dot(way_to_eye(ends, point, &unused), *normal);
        low = is_before ? middle : low;
        high = is_before ? high : middle;
    }
    return eye > shiny->radius && light > shiny->radius;
}

// Where a plane does so. False where eye and light are on two sides of it.
static bool plane_point(const Ends *ends, const Shiny *shiny, Vec3 *point, Vec3 *normal)
{
    double unused;
    Vec3 eye = ends->camera->location, light = ends->light->position;
    double above_eye = vec3_dot(vec3_sub(eye, shiny->centre), shiny->normal);
    double above_light = vec3_dot(vec3_sub(light, shiny->centre), shiny->normal);
    bool is_flat = ends->camera->type == CAMERA_ORTHOGRAPHIC;
    *normal = above_eye > 0.0 ? shiny->normal : vec3_neg(shiny->normal);
    if (is_flat && ends->light->parallel) {
        return false; // all of it or nothing
    }
    if (is_flat || ends->light->parallel) { // along the one way that is known, mirrored, from the other's place
        Vec3 way = is_flat ? way_to_eye(ends, light, &unused) : spot_to_light(ends->light, eye, &unused);
        Vec3 from = is_flat ? light : eye, mirrored = vec3_reflect(way, shiny->normal);
        double above = is_flat ? above_light : above_eye, fall = -vec3_dot(mirrored, shiny->normal);
        *point = vec3_add_scaled(from, above / fall, mirrored);
        return above / fall > 0.0;
    }
    Vec3 mirrored = vec3_add_scaled(eye, -2.0 * above_eye, shiny->normal);
    *point = vec3_add_scaled(mirrored, above_eye / (above_eye + above_light), vec3_sub(light, mirrored));
    return above_eye * above_light > 0.0;
}

bool spot_has_light(const PreparedLight *light)
{
    return !light->shadowless;
}

bool spot_is_lit(const Prepared *p, const PreparedLight *light, ShapeId shape, const Vec3 *plane, Vec3 point,
                 Vec3 normal)
{
    double distance;
    Vec3 towards = spot_to_light(light, point, &distance), offset = vec3_sub(light->position, point);
    double along = light->parallel ? vec3_dot(offset, towards) : distance;
    return vec3_dot(towards, normal) > 0.0 && light_strength(light, offset, along) > 0.0 &&
           ((p->features & RENDER_TRANSPARENCY) || light->area.size1 > 0 || !(along > 0.0) ||
            !extent_is_dark(p->geometry, shape, plane, (Ray){point, towards}, along));
}

// The spot that falls to e^-4 where the mirrored direction is turned by `turned`, or, if it is one of `specular`, the
// middle of both directions by half of that.
static bool spot_make(const Ends *ends, const Shiny *shiny, Vec3 point, Vec3 normal, double turned, bool is_specular,
                      SmallSpot *spot)
{
    double eye, light;
    Vec3 to_eye = way_to_eye(ends, point, &eye);
    (void)spot_to_light(ends->light, point, &light);
    double cosine = vec3_dot(to_eye, normal), near = 1.0 / eye + 1.0 / light;
    Vec3 along = vec3_add_scaled(to_eye, -cosine, normal);
    double length = vec3_length(along);
    along = length > 0x1p-20
                ? vec3_scale(1.0 / length, along)
                : vec3_normalize(vec3_cross(normal, fabs(normal.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    double in_plane = turned / (2.0 / shiny->radius + near * cosine);
    double aside = turned * (is_specular ? cosine : 1.0) / (2.0 * cosine / shiny->radius + near);
    spot->owner = shiny->shape;
    spot->centre = point;
    spot->axes[0] = vec3_scale(in_plane, along);
    spot->axes[1] = vec3_scale(aside, vec3_cross(normal, along));
    return cosine > 0.0 && isfinite(in_plane) && isfinite(aside);
}

bool spot_add(Small *small, const SmallSpot *spot)
{
    if (small->spot_count == SPOTS_MOST) {
        return true;
    }
    if ((small->spot_count & (small->spot_count - 1)) == 0) { // a power of 2: full
        size_t room = small->spot_count > 0 ? 2 * (size_t)small->spot_count : 1;
        SmallSpot *spots = realloc(small->spots, room * sizeof *spots);
        if (!spots) {
            return false;
        }
        small->spots = spots;
    }
    small->spots[small->spot_count++] = *spot;
    return true;
}

// False when out of memory.
static bool shiny_find(Small *small, const Shiny *shiny, SpotIsNarrow *is_narrow,
                       const void *view)
{
    const Prepared *p = small->prepared;
    const PreparedFinish *finish = shiny->finish;
    const double turned[2] = {finish->phong > 0.0 ? sqrt(8.0 / finish->phong_size) : (double)INFINITY,
                              finish->specular > 0.0 ? 2.0 * sqrt(8.0 / finish->shininess) : (double)INFINITY};
    for (size_t i = 0; i < p->light_count; i++) {
        Ends ends = {&p->camera, &p->lights[i]};
        Vec3 point, normal;
        if (!spot_has_light(ends.light) ||
            !(shiny->is_ball ? ball_normal(&ends, shiny, &normal) : plane_point(&ends, shiny, &point, &normal))) {
            continue;
        }
        point = shiny->is_ball ? vec3_add_scaled(shiny->centre, shiny->radius, normal) : point;
        for (int k = 0; k < 2; k++) {
            SmallSpot spot;
            if (turned[k] < 1.0 && spot_make(&ends, shiny, point, normal, turned[k], k == 1, &spot) &&
                is_narrow(view, &spot) && spot_is_lit(p, ends.light, shiny->shape, shiny->is_ball ? NULL : &shiny->normal, point, normal) && !spot_add(small, &spot)) {
                return false;
            }
        }
    }
    return true;
}

bool spots_find(Small *small, bool (*is_candidate)(const void *view, const Extent *extent, double turned),
                SpotIsNarrow *is_narrow, const void *view)
{
    const Prepared *p = small->prepared;
    Shiny shiny;
    bool any_shines = false;
    for (size_t i = 0; i < p->finish_count; i++) {
        any_shines = any_shines || p->finishes[i].shines;
    }
    if (!any_shines) {
        return true;
    }
    for (uint32_t i = 0, count = extent_count(p->geometry); i < count; i++) {
        Extent extent;
        if (!extent_get(p->geometry, i, &extent) || !extent.is_ball ||
            !(shiny.finish = spot_finish(p, extent.material))) {
            continue;
        }
        double sharpest = fmax(shiny.finish->phong > 0.0 ? shiny.finish->phong_size : 0.0,
                               shiny.finish->specular > 0.0 ? 0.25 * shiny.finish->shininess : 0.0);
        shiny.shape = extent.shape;
        shiny.is_ball = true;
        shiny.centre = extent.centre;
        shiny.radius = extent.axes[0].x;
        if (is_candidate(view, &extent, sqrt(8.0 / sharpest)) && !shiny_find(small, &shiny, is_narrow, view)) {
            return false;
        }
    }
    for (uint32_t i = 0; extent_plane(p->geometry, i, &shiny.shape, &shiny.centre, &shiny.normal, &shiny.material);
         i++) {
        shiny.is_ball = false;
        shiny.radius = (double)INFINITY;
        if ((shiny.finish = spot_finish(p, shiny.material)) && !shiny_find(small, &shiny, is_narrow, view)) {
            return false;
        }
    }
    return true;
}
