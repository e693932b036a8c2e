// What a ray that starts at a point is inside of.
//
// Follows a line from the point to where there is nothing more: what it leaves without having entered it is what the
// point is in. Shapes that are clipped, turned inside out or flat are tested by themselves
// (StartShape). One function with all features, for it runs once for each place of the eye.
//
// SPDX-License-Identifier: MIT
#include "render/shade/inside.h"

#include "scene/within.h"
#include "trace/query_surface.h"

// Of unit length, and along nothing that people like to build along.
static const Vec3 odd_direction = {0.36, 0.80, 0.48};

// The surface that was hit; the line continues from its other side.
static Surface go_through(const Prepared *prepared, Ray *ray, RayStart *start, const Hit *hit)
{
    Surface surface = geometry_surface(prepared->geometry, TRACE_ALL_FEATURES, *ray, *hit);
    ray->origin = surface.point;
    *start = (RayStart){hit->shape, !hit->inside, 0};
    return surface;
}

// What a point is in, in POV-Ray's order, as measured: first what has no end, then all else, each in the order of the
// text. The last one counts as what the ray is in, with an interior or without.
typedef struct Found {
    MediumList *list;
    uint64_t ranks[MEDIUM_DEPTH_MAX]; // of its regions, rising
} Found;

static uint64_t rank_of(uint32_t order, bool is_endless)
{
    return (uint64_t)!is_endless << 32 | order;
}

static void put_in(Found *found, MediumRegion region, uint64_t rank)
{
    MediumList *list = found->list;
    if (list->count == MEDIUM_DEPTH_MAX) {
        return;
    }
    uint32_t place = list->count++;
    for (; place > 0 && found->ranks[place - 1] > rank; place--) {
        list->regions[place] = list->regions[place - 1];
        found->ranks[place] = found->ranks[place - 1];
    }
    list->regions[place] = region;
    found->ranks[place] = rank;
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

static MediumRegion region_of(const Prepared *prepared, uint64_t body, MaterialIndex material)
{
    uint32_t interior =
        material & MATERIAL_COMPOUND ? prepared->compounds[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
    return (MediumRegion){body, interior,
                          scene_has_haze(prepared->scene) && !scene_is_hollow(prepared->scene, material)};
}

// Whether a shape is one of Scene.start_shapes.
static bool has_start(const Scene *scene, uint32_t order)
{
    size_t low = 0, high = scene->start_shapes.count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (scene->start_shapes.items[middle].order < order) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < scene->start_shapes.count && scene->start_shapes.items[low].order == order;
}

// What is left along one way from the point, if it is not known already.
static void walk(const Prepared *prepared, Ray ray, Found *found)
{
    RayStart start = RAY_START_FREE;
    MediumList entered = {.count = 0};
    Hit hit;
    for (uint64_t passed = 0; passed <= prepared->crossings_max; passed++) {
        if (!geometry_closest(prepared->geometry, TRACE_ALL_FEATURES, ray, start, (double)INFINITY, &hit)) {
            return;
        }
        Surface surface = go_through(prepared, &ray, &start, &hit);
        const uint64_t body = scene_shape_key(surface.order, surface.body);
        if (geometry_is_flat(prepared->geometry, hit.shape) || has_start(prepared->scene, surface.order)) {
            continue;
        }
        MediumRegion region = region_of(prepared, body, surface.material);
        uint32_t place = place_of(&entered, body);
        if (!hit.inside && entered.count < MEDIUM_DEPTH_MAX) {
            entered.regions[entered.count++] = region;
        } else if (hit.inside && place < entered.count) {
            list_remove(&entered, place);
        } else if (hit.inside && place_of(found->list, body) == found->list->count) {
            // Without an interior, too: such a shape is left on the way out, and not entered. Measured.
            put_in(found, region, rank_of(surface.order, shape_kind(hit.shape) == SHAPE_PLANE));
        }
    }
}

static bool starts_inside(const Scene *scene, const StartShape *shape, Vec3 p)
{
    bool is_in_box = p.x >= shape->low.x && p.x <= shape->high.x && p.y >= shape->low.y && p.y <= shape->high.y &&
                     p.z >= shape->low.z && p.z <= shape->high.z;
    return is_in_box && (shape->is_composite ? within_composite(scene, &scene->composites.items[shape->index], p)
                                             : within_part(&scene->primitives.items[shape->index], p));
}

// Those whose surface does not tell.
static void ask_start_shapes(const Prepared *prepared, Vec3 point, Found *found)
{
    const Scene *scene = prepared->scene;
    Vec3 scene_point = vec3_scale(prepared->length, point);
    for (size_t i = 0; i < scene->start_shapes.count; i++) {
        const StartShape *shape = &scene->start_shapes.items[i];
        if (starts_inside(scene, shape, scene_point)) {
            MediumRegion region = region_of(prepared, scene_shape_key(shape->order, 0), shape->material);
            region.interior = shape->is_filled ? region.interior : RECORD_NONE;
            put_in(found, region, rank_of(shape->order, shape->is_endless));
        }
    }
}

// Both ways, for an endless shape is left on one of them only. Each member of a union counts here, even where they are
// one. Measured.
void prepared_inside(const Prepared *prepared, Vec3 point, MediumList *list)
{
    list->count = 0;
    if (prepared->scene->interiors.count > 0 || scene_has_haze(prepared->scene)) {
        Found found = {.list = list};
        walk(prepared, (Ray){point, odd_direction}, &found);
        walk(prepared, (Ray){point, vec3_neg(odd_direction)}, &found);
        ask_start_shapes(prepared, point, &found);
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
    if (!camera_type_moves(camera->through) && camera->lens_radius == 0.0) {
        return medium_load(table, &prepared->start);
    }
    prepared_inside(prepared, origin, &own);
    return medium_load(table, &own);
}
