// Textures at a point, worked out by walking the scene's records.
//
// A pattern along another one lies in that one's space, so a point is moved step by step on the way in. Owns the inverse transforms. The records nest no deeper than the language lets them, so recursion is bounded.
//
// SPDX-License-Identifier: MIT
#include "render/texture.h"

#include <math.h>
#include <stdlib.h>

#include "render/pattern.h"

static Transform way_back(const Transform *to_world)
{
    Transform back = transform_identity();
    return transform_invert(to_world, &back) ? back : transform_identity(); // the evaluator saw that there is one
}

bool texture_table_init(TextureTable *table, const Scene *scene, int exponent)
{
    *table = (TextureTable){.scene = scene, .scale = ldexp(1.0, exponent)};
    table->to_pattern = malloc((scene->patterns.count + 1) * sizeof *table->to_pattern);
    table->texture_to_pattern = malloc((scene->textures.count + 1) * sizeof *table->texture_to_pattern);
    if (!table->to_pattern || !table->texture_to_pattern) {
        texture_table_fini(table);
        return false;
    }
    for (size_t i = 0; i < scene->patterns.count; i++) {
        table->to_pattern[i] = way_back(&scene->patterns.items[i].to_world);
    }
    for (size_t i = 0; i < scene->textures.count; i++) {
        table->texture_to_pattern[i] = way_back(&scene->textures.items[i].to_world);
    }
    return true;
}

void texture_table_fini(TextureTable *table)
{
    free(table->to_pattern);
    free(table->texture_to_pattern);
    *table = (TextureTable){0};
}

// ---- pigments

static Rgbft blend(Rgbft a, double share, Rgbft b)
{
    double rest = 1.0 - share;
    return (Rgbft){rest * a.red + share * b.red, rest * a.green + share * b.green, rest * a.blue + share * b.blue,
                   rest * a.filter + share * b.filter, rest * a.transmit + share * b.transmit};
}

// Where a value stands in a list: at `low`, or the share of `high` that is mixed in.
typedef struct Place {
    uint32_t low, high;
    double share;
} Place;

#define FIND_PLACE(items, first, value, place)                                                                         \
    do {                                                                                                               \
        uint32_t at = (first);                                                                                         \
        *(place) = (Place){at, at, 0.0};                                                                               \
        while ((items)[at].next != RECORD_NONE && (value) >= (items)[(items)[at].next].at) {                           \
            at = (items)[at].next;                                                                                     \
        }                                                                                                              \
        *(place) = (Place){at, at, 0.0};                                                                               \
        if ((value) > (items)[at].at && (items)[at].next != RECORD_NONE) {                                             \
            uint32_t next = (items)[at].next;                                                                          \
            *(place) = (Place){at, next, ((value) - (items)[at].at) / ((items)[next].at - (items)[at].at)};            \
        }                                                                                                              \
    } while (0)

static uint32_t nth_pigment(const PigmentEntry *entries, uint32_t first, unsigned n)
{
    for (; n > 0 && entries[first].next != RECORD_NONE; n--) {
        first = entries[first].next;
    }
    return first;
}

static Rgbft patterned(const TextureTable *table, uint32_t index, Vec3 outer)
{
    const PatternedPigment *record = &table->scene->patterns.items[index];
    const PigmentEntry *entries = table->scene->pigment_entries.items;
    Vec3 point = transform_point(&table->to_pattern[index], outer);
    if (pattern_info((PatternType)record->pattern.type)->blocks) {
        uint32_t entry = nth_pigment(entries, record->entries, pattern_block(&record->pattern, point));
        return texture_pigment(table, &entries[entry].pigment, point);
    }
    Place place;
    double value = pattern_value(&record->pattern, point);
    FIND_PLACE(entries, record->entries, value, &place);
    Rgbft low = texture_pigment(table, &entries[place.low].pigment, point);
    return place.share > 0.0 ? blend(low, place.share, texture_pigment(table, &entries[place.high].pigment, point))
                             : low;
}

Rgbft texture_pigment(const TextureTable *table, const Pigment *pigment, Vec3 point)
{
    return pigment->pattern == RECORD_NONE ? pigment_colour(pigment) : patterned(table, pigment->pattern, point);
}

// ---- textures

typedef struct Walk {
    const TextureTable *table;
    TextureVisit visit;
    void *client;
} Walk;

static Rgb walk_layers(const Walk *walk, uint32_t index, Vec3 point, Rgb share);

static uint32_t nth_texture(const TextureEntry *entries, uint32_t first, unsigned n)
{
    for (; n > 0 && entries[first].next != RECORD_NONE; n--) {
        first = entries[first].next;
    }
    return first;
}

static Rgb walk_pattern(const Walk *walk, uint32_t index, Vec3 outer, Rgb share)
{
    const Texture *texture = &walk->table->scene->textures.items[index];
    const TextureEntry *entries = walk->table->scene->texture_entries.items;
    Vec3 point = transform_point(&walk->table->texture_to_pattern[index], outer);
    if (pattern_info((PatternType)texture->pattern.type)->blocks) {
        uint32_t entry = nth_texture(entries, texture->entries, pattern_block(&texture->pattern, point));
        return walk_layers(walk, entries[entry].texture, point, share);
    }
    Place place;
    double value = pattern_value(&texture->pattern, point);
    FIND_PLACE(entries, texture->entries, value, &place);
    if (!(place.share > 0.0)) {
        return walk_layers(walk, entries[place.low].texture, point, share);
    }
    Rgb low = walk_layers(walk, entries[place.low].texture, point, rgb_scale(1.0 - place.share, share));
    Rgb high = walk_layers(walk, entries[place.high].texture, point, rgb_scale(place.share, share));
    return rgb_add(low, high);
}

static Rgb walk_layers(const Walk *walk, uint32_t index, Vec3 point, Rgb share)
{
    for (; index != RECORD_NONE && !rgb_is_black(share); index = walk->table->scene->textures.items[index].below) {
        const Texture *texture = &walk->table->scene->textures.items[index];
        if (texture->pattern.type != PATTERN_NONE) {
            return walk_pattern(walk, index, point, share);
        }
        TextureLayer layer = {texture_pigment(walk->table, &texture->pigment, point), texture->finish, share};
        walk->visit(walk->client, &layer);
        Rgb through = rgb_add(rgb_scale(layer.pigment.filter, rgbft_rgb(layer.pigment)),
                              rgb_grey(layer.pigment.transmit));
        share = rgb_mul(share, through);
    }
    return share;
}

Rgb texture_walk(const TextureTable *table, uint32_t texture, Vec3 point, TextureVisit visit, void *client)
{
    Walk walk = {table, visit, client};
    return walk_layers(&walk, texture, vec3_scale(table->scale, point), rgb_grey(1.0));
}
