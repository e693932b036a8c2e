// Bumps: how patterns turn a surface's normal.
//
// The height is evaluated at the four corners of a tetrahedron around the point; the normal loses their sum, each
// corner's direction weighted with its height. Directions, factors and the order of transforms are measured;
// docs/language.md, "Bumps". A normal in a map sees the normal and the point as they are in the map's space. The
// records nest no deeper than the language lets them, so recursion is bounded.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/surface/normal_special.h"
#include "render/surface/pattern.h"
#include "render/surface/texture.h"

// ---- heights

// A cubic between two entries; slopes are per width of the piece, not per unit of the value.
static double slope_height(const SlopeEntry *entries, const AlongList *list, double value)
{
    AlongPlace place = along_find(list, value);
    const SlopeEntry *low = &entries[place.low], *high = &entries[place.high];
    double t = place.share, t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * low->height + (t3 - 2.0 * t2 + t) * low->slope +
           (3.0 * t2 - 2.0 * t3) * high->height + (t3 - t2) * high->slope;
}

// The sum over the corners, which is 4/3 of accuracy × gradient where the height is even.
static Vec3 lean(const TextureTable *table, uint32_t index, Vec3 point)
{
    const Normal *record = &table->scene->normals.items[index];
    // To nine digits, which far mirrors show: their own small sum leans the normal by the height itself.
    static const Vec3 corners[4] = {
        {0.0, 1.0, 0.0},
        {0.942809041, -0.333333333, 0.0},
        {-0.471404521, -0.333333333, 0.816496581},
        {-0.471404521, -0.333333333, -0.816496581},
    };
    Vec3 sum = vec3(0.0, 0.0, 0.0), places[4];
    double heights[4];
    for (int i = 0; i < 4; i++) {
        places[i] = vec3_add(point, vec3_scale(record->accuracy, corners[i]));
    }
    pattern_values_moved(&record->pattern, &table->source, 4, places, heights);
    for (int i = 0; i < 4; i++) {
        double height = heights[i];
        if (record->slopes != RECORD_NONE) {
            height = slope_height(table->scene->slope_entries.items, &table->slope_lists[index], height);
        }
        sum = vec3_add(sum, vec3_scale(height, corners[i]));
    }
    return sum;
}

// ---- normals

// Where it is evaluated: the point, and the surface coordinates there.
typedef struct NormalPlace {
    Vec3 point;
    const Vec3 *uv;
} NormalPlace;

static Vec3 turned(const TextureTable *table, uint32_t index, NormalPlace outer, Vec3 normal, bool keeps_length);

static Vec3 average(const TextureTable *table, uint32_t first, NormalPlace point, Vec3 normal, bool keeps_length)
{
    const NormalEntry *entries = table->scene->normal_entries.items;
    Vec3 sum = vec3(0.0, 0.0, 0.0);
    double weight = 0.0;
    for (uint32_t i = first; i != RECORD_NONE; i = entries[i].next) {
        sum = vec3_add(sum, vec3_scale(entries[i].at, turned(table, entries[i].normal, point, normal, keeps_length)));
        weight += entries[i].at;
    }
    return vec3_scale(1.0 / weight, sum);
}

// What the entries of a map make of the normal, all in the map's space.
static Vec3 mapped(const TextureTable *table, uint32_t index, NormalPlace point, Vec3 normal, bool keeps_length)
{
    const Normal *record = &table->scene->normals.items[index];
    const NormalEntry *entries = table->scene->normal_entries.items;
    if (record->pattern.type == PATTERN_AVERAGE) {
        return average(table, record->entries, point, normal, keeps_length);
    }
    AlongPlace place =
        along_find(&table->normal_lists[index], pattern_value_moved(&record->pattern, &table->source, point.point));
    Vec3 low = turned(table, entries[place.low].normal, point, normal, keeps_length);
    if (place.share == 0.0) {
        return low;
    }
    Vec3 high = turned(table, entries[place.high].normal, point, normal, keeps_length);
    return vec3_add(vec3_scale(1.0 - place.share, low), vec3_scale(place.share, high));
}

// What a map or blocks make of a normal is of length 1 in the map around them, too; an average is not. Measured.
static bool has_own_length(const Normal *record)
{
    return record->entries != RECORD_NONE && record->pattern.type != PATTERN_AVERAGE;
}

static Vec3 turned(const TextureTable *table, uint32_t index, NormalPlace outer, Vec3 normal, bool keeps_length)
{
    const Normal *record = &table->scene->normals.items[index];
    const Transform *to_pattern = &table->normal_to_pattern[index];
    keeps_length |= record->flags & NORMAL_KEEPS_LENGTH;
    // Turbulence moves the point once, for the corners around it and for the entries of a map as well. Measured.
    Vec3 space = texture_space(&record->pattern, outer.point, outer.uv);
    Vec3 point = pattern_moved(&record->pattern, &table->source, transform_point(to_pattern, space));
    Vec3 inner = transform_normal(&record->to_world, normal);
    inner = keeps_length ? inner : vec3_normalize(inner);
    if (record->entries != RECORD_NONE) {
        inner = mapped(table, index, (NormalPlace){point, outer.uv}, inner, keeps_length);
    } else if (record->pattern.type == PATTERN_BUMP_MAP) {
        inner = image_bumped(&table->images[record->pattern.image], record->amount, point, inner);
    } else if (pattern_info((PatternType)record->pattern.type)->is_special_normal) {
        inner = vec3_add_scaled(inner, record->amount, normal_special(&record->pattern, &table->source, point));
    } else {
        double factor = 0.1 * record->amount / record->accuracy;
        inner = vec3_sub(inner, vec3_scale(factor, lean(table, index, point)));
    }
    inner = transform_normal(to_pattern, inner);
    return keeps_length && !has_own_length(record) ? inner : vec3_normalize(inner);
}

// The normal in the space of a pattern of textures.
static Vec3 into(const TextureTable *table, const TexturePlace *place, Vec3 normal)
{
    if (!place->outer) {
        return normal;
    }
    Vec3 outer = into(table, place->outer, normal);
    return vec3_normalize(transform_normal(&table->scene->textures.items[place->texture].to_world, outer));
}

// Bumps can be as deep as numbers go, or cancel each other.
static Vec3 unit_or(Vec3 result, Vec3 normal)
{
    double length = vec3_length(result);
    return length > 0.0 && isfinite(length) ? vec3_scale(1.0 / length, result) : normal;
}

static NormalPlace place_of(const TextureLayer *layer)
{
    return (NormalPlace){layer->place->point, layer->place->uv};
}

Vec3 texture_normal_inside(const TextureLayer *layer, Vec3 normal)
{
    const Scene *scene = layer->table->scene;
    Vec3 inner = into(layer->table, layer->place, normal);
    uint32_t index = layer->normal;
    if (scene->normals.items[index].flags & NORMAL_IS_TURNED) {
        inner = unit_or(transform_normal(&scene->normals.items[index].to_world, inner), inner);
        index = scene->normal_entries.items[scene->normals.items[index].entries].normal;
    }
    return unit_or(turned(layer->table, index, place_of(layer), inner, false), inner);
}

Vec3 texture_normal(const TextureLayer *layer, Vec3 normal)
{
    const TextureTable *table = layer->table;
    Vec3 result = turned(table, layer->normal, place_of(layer), into(table, layer->place, normal), false);
    for (const TexturePlace *place = layer->place; place->outer; place = place->outer) {
        result = transform_normal(&table->texture_to_pattern[place->texture], result);
    }
    return unit_or(result, normal);
}

Vec3 texture_bent(const TextureTable *table, uint32_t normal, Vec3 point, Vec3 direction)
{
    return unit_or(turned(table, normal, (NormalPlace){point, NULL}, direction, false), direction);
}
