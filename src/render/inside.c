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
static void put_below(Inside *inside, InsideEntry entry)
{
    uint32_t place = 0;
    while (entry.interior != RECORD_NONE && place < inside->count && inside->entries[place].interior == RECORD_NONE) {
        place++;
    }
    if (inside->count < INSIDE_MAX) {
        for (uint32_t i = inside->count++; i > place; i--) {
            inside->entries[i] = inside->entries[i - 1];
        }
        inside->entries[place] = entry;
    }
}

static bool holds(const Inside *inside, uint64_t body)
{
    for (uint32_t i = 0; i < inside->count; i++) {
        if (inside->entries[i].body == body) {
            return true;
        }
    }
    return false;
}

// What is left along one way from the point, put below what is known already.
static void walk(const Prepared *prepared, Ray ray, Inside *inside)
{
    RayStart start = RAY_START_FREE;
    Inside entered = {.count = 0};
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
        if (!hit.inside) {
            inside_enter(&entered, body, interior, is_solid);
        } else if (holds(&entered, body)) {
            (void)inside_leave(&entered, body);
        } else if ((interior != RECORD_NONE || is_solid) && !holds(inside, body)) {
            // Other shapes change nothing here: rays that start inside of them are in empty space.
            put_below(inside, (InsideEntry){body, interior, is_solid});
        }
    }
}

// Both ways, for an endless shape is left on one of them only. Each member of a union counts here, even where they are
// one. Measured.
void prepared_inside(const Prepared *prepared, Vec3 point, Inside *inside)
{
    inside->count = 0;
    if (prepared->scene->interiors.count > 0 || prepared->scene->fogs.count > 0) {
        walk(prepared, (Ray){point, odd_direction}, inside);
        walk(prepared, (Ray){point, vec3_neg(odd_direction)}, inside);
        for (uint32_t i = 0; i < inside->count; i++) {
            uint64_t *body = &inside->entries[i].body;
            *body = scene_shape_is_key(*body) ? scene_body_key(prepared->scene, (uint32_t)*body, 0) : *body;
        }
    }
}
