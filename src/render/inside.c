// What a ray that starts at a point is inside of.
//
// Follows a line from the point to where there is nothing more: what it leaves without having entered it is what the
// point is in, the innermost first. One function with all features, for it runs once for each place of the eye.
//
// SPDX-License-Identifier: MIT
#include "render/prepared.h"
#include "trace/query.h"

// Of unit length, and along nothing that people like to build along.
static const Vec3 odd_direction = {0.36, 0.80, 0.48};

// What the line goes on from: the other side of the surface that was hit.
static void go_through(const Prepared *prepared, Ray *ray, RayStart *start, const Hit *hit, uint64_t *body,
                       MaterialIndex *material)
{
    Surface surface = geometry_surface(prepared->geometry, TRACE_ALL_FEATURES, *ray, *hit);
    *body = scene_shape_key(surface.order, surface.body);
    *material = surface.material;
    ray->origin = surface.point;
    *start = (RayStart){hit->shape, !hit->inside, 0};
}

// Below all others with an interior; what has none is below all of those, for it does not count as what the ray is in.
static void put_below(MediumList *list, MediumRegion region)
{
    uint32_t place = 0;
    while (region.interior != RECORD_NONE && place < list->count && list->regions[place].interior == RECORD_NONE) {
        place++;
    }
    if (list->count < MEDIUM_DEPTH_MAX) {
        for (uint32_t i = list->count++; i > place; i--) {
            list->regions[i] = list->regions[i - 1];
        }
        list->regions[place] = region;
    }
}

// The place of a body, or the count when it is not there.
static uint32_t place_of(const MediumList *list, uint64_t body)
{
    uint32_t place = 0;
    while (place < list->count && list->regions[place].body != body) {
        place++;
    }
    return place;
}

static void list_remove(MediumList *list, uint32_t place)
{
    for (list->count--; place < list->count; place++) {
        list->regions[place] = list->regions[place + 1];
    }
}

// What is left along one way from the point, put below what is known already.
static void walk(const Prepared *prepared, Ray ray, MediumList *list)
{
    RayStart start = RAY_START_FREE;
    MediumList entered = {.count = 0};
    Hit hit;
    for (uint64_t passed = 0; passed <= prepared->crossings_max; passed++) {
        uint64_t body;
        MaterialIndex material;
        if (!geometry_closest(prepared->geometry, TRACE_ALL_FEATURES, ray, start, (double)INFINITY, &hit)) {
            return;
        }
        go_through(prepared, &ray, &start, &hit, &body, &material);
        uint32_t interior =
            material & MATERIAL_COMPOUND ? prepared->compounds[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
        bool is_solid = prepared->scene->fogs.count > 0 && !scene_is_hollow(prepared->scene, material) &&
                        !geometry_is_flat(prepared->geometry, hit.shape);
        MediumRegion region = {body, interior, is_solid};
        uint32_t place = place_of(&entered, body);
        if (!hit.inside && entered.count < MEDIUM_DEPTH_MAX) {
            entered.regions[entered.count++] = region;
        } else if (hit.inside && place < entered.count) {
            list_remove(&entered, place);
        } else if (hit.inside && place_of(list, body) == list->count) {
            // Without an interior, too: such a shape is left on the way out, and not entered. Measured.
            put_below(list, region);
        }
    }
}

// Both ways, for an endless shape is left on one of them only. Each member of a union counts here, even where they are
// one. Measured.
void prepared_inside(const Prepared *prepared, Vec3 point, MediumList *list)
{
    list->count = 0;
    if (prepared->scene->interiors.count > 0 || prepared->scene->fogs.count > 0) {
        walk(prepared, (Ray){point, odd_direction}, list);
        walk(prepared, (Ray){point, vec3_neg(odd_direction)}, list);
        for (uint32_t i = 0; i < list->count; i++) {
            uint64_t *body = &list->regions[i].body;
            *body = scene_shape_is_key(*body) ? scene_body_key(prepared->scene, (uint32_t)*body, 0) : *body;
        }
    }
}

MediumStack prepared_start(const Prepared *prepared, Vec3 origin, MediumTable *table)
{
    const PreparedCamera *camera = &prepared->camera;
    MediumList own;
    if (camera->type != CAMERA_ORTHOGRAPHIC && camera->lens_radius == 0.0) {
        return medium_load(table, &prepared->start);
    }
    prepared_inside(prepared, origin, &own);
    return medium_load(table, &own);
}
