// Textures at a point, computed by walking the scene's records.
//
// A pattern along another one lies in that one's space, so a point is moved step by step on the way in. Owns the
// inverse transforms. The records nest no deeper than the language lets them, so recursion is bounded.
//
// SPDX-License-Identifier: MIT
#include "render/surface/texture.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "math/extreme.h"
#include "math/given_surface.h"
#include "render/surface/facing.h"
#include "render/surface/formula.h"
#include "render/surface/warp.h"
#include "scene/blob.h"
#include "scene/corners.h"

static Transform way_back(const Transform *to_world)
{
    Transform back = transform_identity();
    return transform_invert(to_world, &back) ? back : transform_identity(); // the evaluator saw that there is one
}

static bool any_pattern(const Scene *scene, bool (*holds)(const Pattern *pattern))
{
    for (size_t i = 0; i < scene->patterns.count; i++) {
        if (holds(&scene->patterns.items[i].pattern)) {
            return true;
        }
    }
    for (size_t i = 0; i < scene->textures.count; i++) {
        if (holds(&scene->textures.items[i].pattern)) {
            return true;
        }
    }
    for (size_t i = 0; i < scene->normals.count; i++) {
        if (holds(&scene->normals.items[i].pattern)) {
            return true;
        }
    }
    return false;
}

// Whether something looks otherwise from inside.
static bool has_sides(const Scene *scene)
{
    bool has = false;
    for (size_t i = 0; i < scene->compounds.count && !has; i++) {
        has = scene->compounds.items[i].inner != RECORD_NONE;
    }
    return has;
}

static bool is_lit_apart(const Scene *scene)
{
    bool is = scene->light_groups.count > 0;
    for (size_t i = 0; i < scene->compounds.count && !is; i++) {
        is = scene->compounds.items[i].is_double;
    }
    return is;
}

static bool asks_surface(const Pattern *pattern)
{
    return pattern_info((PatternType)pattern->type)->is_of_surface;
}

static bool find_waves(TextureTable *table, const Scene *scene)
{
    unsigned count = (unsigned)scene->settings.number_of_waves;
    if (!any_pattern(scene, pattern_needs_waves)) {
        return true;
    }
    table->waves = malloc(count * sizeof *table->waves);
    if (!table->waves) {
        return false;
    }
    noise_wave_sources(table->source.noise, count, table->waves);
    table->source.waves = table->waves;
    table->source.wave_count = count;
    return true;
}

// Whether something else than a pattern's own turbulence and formula asks for noise.
static bool asks_for_noise(const Scene *scene)
{
    bool found = false;
    for (size_t i = 0; !found && i < scene->warps.count; i++) {
        found = warp_needs_noise(&scene->warps.items[i]);
    }
    for (size_t i = 0; !found && i < scene->formula_steps.count; i++) {
        uint32_t op = scene->formula_steps.items[i].op;
        found = op == FORMULA_NOISE || op == FORMULA_NOISE_CHOSEN ||
                (op == FORMULA_GIVEN && given_surface_asks_noise(scene->formula_steps.items[i].which));
    }
    for (size_t i = 0; !found && i < scene->fogs.count; i++) {
        found = scene->fogs.items[i].is_turbulent;
    }
    for (size_t i = 0; !found && i < scene->finishes.count; i++) {
        found = scene->finishes.items[i].irid > 0.0 && scene->finishes.items[i].irid_turbulence != 0.0;
    }
    return found;
}

static bool find_noise(TextureTable *table, const Scene *scene, const Noise *noise, const char *isa)
{
    if (!any_pattern(scene, pattern_needs_noise) && !asks_for_noise(scene)) {
        return true;
    }
    NoiseGenerator usual = scene->settings.version < 3.5 ? NOISE_ORIGINAL : NOISE_CORRECTED;
    int said = scene->settings.noise_generator;
    if (!noise) {
        table->noise = malloc(sizeof *table->noise);
        if (!table->noise) {
            return false;
        }
        noise_init(table->noise, isa);
        noise = table->noise;
    }
    table->source = (NoiseSource){.noise = noise, .generator = said != 0 ? noise_generator(said) : usual};
    return find_waves(table, scene);
}

enum { OPACITY_UNKNOWN, OPACITY_NONE, OPACITY_WHOLE };

bool texture_is_opaque(const TextureTable *table, const Pigment *pigment)
{
    return pigment->pattern == RECORD_NONE ? pigment->filter == 0.0F && pigment->transmit == 0.0F
                                           : table->opaque[pigment->pattern] == OPACITY_WHOLE;
}

static bool find_opaque(TextureTable *table, const Pigment *pigment)
{
    uint32_t index = pigment->pattern;
    if (index == RECORD_NONE || table->opaque[index] != OPACITY_UNKNOWN) {
        return texture_is_opaque(table, pigment);
    }
    const PatternedPigment *record = &table->scene->patterns.items[index];
    const PigmentEntry *entries = table->scene->pigment_entries.items;
    bool is_image = pattern_info((PatternType)record->pattern.type)->form == PATTERN_OF_COLOURS;
    bool is_opaque = !is_image || !image_is_transparent(&table->images[record->pattern.image]);
    for (uint32_t at = is_image ? RECORD_NONE : record->entries; at != RECORD_NONE; at = entries[at].next) {
        is_opaque = find_opaque(table, &entries[at].pigment) && is_opaque;
    }
    table->opaque[index] = is_opaque ? OPACITY_WHOLE : OPACITY_NONE;
    return is_opaque;
}

// ---- what asks for surface coordinates

// Of each record a byte, 1 if it asks for them. What a record is made of stands before it.
typedef struct Askers {
    const Scene *scene;
    uint8_t *patterns, *normals, *textures;
} Askers;

static bool pigment_asks(const Askers *askers, const PatternedPigment *record)
{
    const PigmentEntry *entries = askers->scene->pigment_entries.items;
    bool asks = record->pattern.flags & PATTERN_ON_SURFACE;
    for (uint32_t at = record->entries; !asks && at != RECORD_NONE; at = entries[at].next) {
        asks = entries[at].pigment.pattern != RECORD_NONE && askers->patterns[entries[at].pigment.pattern];
    }
    return asks;
}

static bool normal_asks(const Askers *askers, const Normal *record)
{
    const NormalEntry *entries = askers->scene->normal_entries.items;
    bool asks = record->pattern.flags & PATTERN_ON_SURFACE;
    for (uint32_t at = record->entries; !asks && at != RECORD_NONE; at = entries[at].next) {
        asks = askers->normals[entries[at].normal];
    }
    return asks;
}

static bool texture_asks(const Askers *askers, const Texture *record)
{
    const TextureEntry *entries = askers->scene->texture_entries.items;
    uint32_t pattern = record->pigment.pattern;
    bool asks = (record->pattern.flags & PATTERN_ON_SURFACE) || (pattern != RECORD_NONE && askers->patterns[pattern]) ||
                (record->normal != RECORD_NONE && askers->normals[record->normal]) ||
                (record->below != RECORD_NONE && askers->textures[record->below]);
    for (uint32_t at = record->entries; !asks && at != RECORD_NONE; at = entries[at].next) {
        asks = askers->textures[entries[at].texture];
    }
    return asks;
}

static bool is_on_surface(const Pattern *pattern)
{
    return pattern->flags & PATTERN_ON_SURFACE;
}

static bool find_on_surface(TextureTable *table)
{
    const Scene *scene = table->scene;
    if (!any_pattern(scene, is_on_surface)) {
        return true;
    }
    Askers askers = {scene, calloc(scene->patterns.count + 1, 1), calloc(scene->normals.count + 1, 1),
                     calloc(scene->textures.count + 1, 1)};
    bool has_memory = askers.patterns && askers.normals && askers.textures;
    for (size_t i = 0; has_memory && i < scene->patterns.count; i++) {
        askers.patterns[i] = pigment_asks(&askers, &scene->patterns.items[i]);
    }
    for (size_t i = 0; has_memory && i < scene->normals.count; i++) {
        askers.normals[i] = normal_asks(&askers, &scene->normals.items[i]);
    }
    for (size_t i = 0; has_memory && i < scene->textures.count; i++) {
        askers.textures[i] = texture_asks(&askers, &scene->textures.items[i]);
    }
    free(askers.patterns);
    free(askers.normals);
    table->on_surface = askers.textures;
    return has_memory;
}

#define ALONG_RECORDS(list, type, member)                                                                              \
    (&(AlongRecords){(list).items, (list).count, sizeof(type), offsetof(type, member)})

static bool find_lists(TextureTable *table, const Scene *scene)
{
    arena_init(&table->along, SIZE_MAX);
    table->pattern_lists = along_lists(&table->along, ALONG_RECORDS(scene->patterns, PatternedPigment, entries),
                                       ALONG_RECORDS(scene->pigment_entries, PigmentEntry, next));
    table->texture_lists = along_lists(&table->along, ALONG_RECORDS(scene->textures, Texture, entries),
                                       ALONG_RECORDS(scene->texture_entries, TextureEntry, next));
    table->normal_lists = along_lists(&table->along, ALONG_RECORDS(scene->normals, Normal, entries),
                                      ALONG_RECORDS(scene->normal_entries, NormalEntry, next));
    table->slope_lists = along_lists(&table->along, ALONG_RECORDS(scene->normals, Normal, slopes),
                                     ALONG_RECORDS(scene->slope_entries, SlopeEntry, next));
    return table->pattern_lists && table->texture_lists && table->normal_lists && table->slope_lists;
}

bool texture_table_init(TextureTable *table, const Scene *scene, const Noise *noise, int exponent, const char *isa)
{
    *table = (TextureTable){.scene = scene, .scale = ldexp(1.0, exponent)};
    table->to_pattern = malloc((scene->patterns.count + 1) * sizeof *table->to_pattern);
    table->opaque = calloc(scene->patterns.count + 1, sizeof *table->opaque);
    table->texture_to_pattern = malloc((scene->textures.count + 1) * sizeof *table->texture_to_pattern);
    table->normal_to_pattern = malloc((scene->normals.count + 1) * sizeof *table->normal_to_pattern);
    table->images = images_new(scene);
    table->warp_back = malloc((scene->warps.count + 1) * sizeof *table->warp_back);
    if (!find_lists(table, scene) || !table->to_pattern || !table->opaque || !table->texture_to_pattern ||
        !table->normal_to_pattern || !table->images || !table->warp_back || !find_noise(table, scene, noise, isa)) {
        texture_table_fini(table);
        return false;
    }
    table->source.escape = escape_kernel_choose(isa);
    table->source.warps = scene->warps.items;
    table->source.warp_back = table->warp_back;
    table->source.steps = scene->formula_steps.items;
    table->source.insides = scene->insides.items;
    table->source.table = table;
    for (size_t i = 0; i < scene->warps.count; i++) {
        table->warp_back[i] = way_back(&scene->warps.items[i].to_outside);
    }
    table->faces = any_pattern(scene, asks_surface);
    table->has_sides = has_sides(scene);
    table->is_lit_apart = is_lit_apart(scene);
    table->is_walked = table->faces || table->has_sides || table->is_lit_apart;
    table->goes_abreast = any_pattern(scene, pattern_goes_abreast);
    for (size_t i = 0; i < scene->patterns.count; i++) {
        table->to_pattern[i] = way_back(&scene->patterns.items[i].to_world);
        find_opaque(table, &(Pigment){.pattern = (uint32_t)i});
    }
    for (size_t i = 0; i < scene->textures.count; i++) {
        table->texture_to_pattern[i] = way_back(&scene->textures.items[i].to_world);
    }
    for (size_t i = 0; i < scene->normals.count; i++) {
        table->normal_to_pattern[i] = way_back(&scene->normals.items[i].to_world);
    }
    if (!find_on_surface(table)) {
        texture_table_fini(table);
        return false;
    }
    if (scene->formula_host) {
        formula_paint(scene->formula_host, &table->source);
    }
    return true;
}

size_t texture_table_bytes(const TextureTable *table)
{
    const Scene *scene = table->scene;
    size_t transforms = scene->patterns.count + scene->textures.count + scene->normals.count + scene->warps.count + 4;
    return sizeof *table + transforms * sizeof(Transform) + scene->patterns.count +
           scene->image_maps.count * sizeof *table->images + table->along.bytes_reserved;
}

void texture_table_fini(TextureTable *table)
{
    if (table->scene && table->scene->formula_host) {
        formula_unpaint(table->scene->formula_host, &table->source);
    }
    free(table->noise);
    free(table->waves);
    free(table->to_pattern);
    free(table->opaque);
    free(table->on_surface);
    free(table->texture_to_pattern);
    free(table->normal_to_pattern);
    free(table->warp_back);
    arena_fini(&table->along);
    images_free(table->images, table->scene ? table->scene->image_maps.count : 0);
    *table = (TextureTable){0};
}

bool texture_table_has_transparent_image(const TextureTable *table)
{
    for (size_t i = 0; i < table->scene->image_maps.count; i++) {
        if (image_is_transparent(&table->images[i])) {
            return true;
        }
    }
    return false;
}

// ---- pigments

// Colours of pigments are mixed in single precision, operation by operation as POV-Ray does it, so that a function of a
// pigment has the same digits.
static double blend_one(double a, double share, double b)
{
    float way = (float)(share * (double)((float)b - (float)a));
    return (double)((float)a + way);
}

static Rgbft blend(Rgbft a, double share, Rgbft b)
{
    return (Rgbft){blend_one(a.red, share, b.red), blend_one(a.green, share, b.green), blend_one(a.blue, share, b.blue),
                   blend_one(a.filter, share, b.filter), blend_one(a.transmit, share, b.transmit)};
}

// All entries at once; their values are weights. In single precision, too.
static Rgbft average(const TextureTable *table, uint32_t first, Vec3 point, const Vec3 *uv)
{
    const PigmentEntry *entries = table->scene->pigment_entries.items;
    float sum[5] = {0.0F, 0.0F, 0.0F, 0.0F, 0.0F}, weights = 0.0F;
    for (uint32_t at = first; at != RECORD_NONE; at = entries[at].next) {
        Rgbft colour = texture_pigment_on(table, &entries[at].pigment, point, uv);
        float weight = (float)entries[at].at;
        weights += weight;
        sum[0] += weight * (float)colour.red;
        sum[1] += weight * (float)colour.green;
        sum[2] += weight * (float)colour.blue;
        sum[3] += weight * (float)colour.filter;
        sum[4] += weight * (float)colour.transmit;
    }
    return (Rgbft){(double)(sum[0] / weights), (double)(sum[1] / weights), (double)(sum[2] / weights),
                   (double)(sum[3] / weights), (double)(sum[4] / weights)};
}

// What a pattern's map has for a value, at a point in its space.
static Rgbft mapped(const TextureTable *table, uint32_t index, Vec3 point, const Vec3 *uv, double value)
{
    const PigmentEntry *entries = table->scene->pigment_entries.items;
    AlongPlace place = along_find(&table->pattern_lists[index], value);
    Rgbft low = texture_pigment_on(table, &entries[place.low].pigment, point, uv);
    return place.share > 0.0
               ? blend(low, place.share, texture_pigment_on(table, &entries[place.high].pigment, point, uv))
               : low;
}

static Rgbft patterned(const TextureTable *table, uint32_t index, Vec3 outer, const Vec3 *uv)
{
    const PatternedPigment *record = &table->scene->patterns.items[index];
    outer = texture_space(&record->pattern, outer, uv);
    // Where turbulence moves a point, the entries of the map see it moved, too.
    Vec3 point = pattern_moved(&record->pattern, &table->source, transform_point(&table->to_pattern[index], outer));
    PatternForm form = pattern_info((PatternType)record->pattern.type)->form;
    if (form == PATTERN_OF_COLOURS) {
        return image_colour(&table->images[record->pattern.image], point);
    }
    if (form == PATTERN_OF_ALL) {
        return average(table, record->entries, point, uv);
    }
    return mapped(table, index, point, uv, pattern_value_moved(&record->pattern, &table->source, point));
}

Rgbft texture_pigment_on(const TextureTable *table, const Pigment *pigment, Vec3 point, const Vec3 *uv)
{
    return pigment->pattern == RECORD_NONE ? pigment_colour(pigment) : patterned(table, pigment->pattern, point, uv);
}

bool texture_goes_abreast(const TextureTable *table, const Pigment *pigment)
{
    return pigment->pattern != RECORD_NONE &&
           pattern_goes_abreast(&table->scene->patterns.items[pigment->pattern].pattern);
}

void texture_pigments(const TextureTable *table, const Pigment *pigment, unsigned count, const Vec3 *points,
                      Rgbft *colours)
{
    const Pattern *pattern = &table->scene->patterns.items[pigment->pattern].pattern;
    const Transform *to_pattern = &table->to_pattern[pigment->pattern];
    Vec3 moved[TEXTURE_ABREAST] = {{0.0, 0.0, 0.0}};
    double values[TEXTURE_ABREAST];
    for (unsigned i = 0; i < count; i++) {
        moved[i] = pattern_moved(pattern, &table->source, transform_point(to_pattern, points[i]));
    }
    pattern_values_moved(pattern, &table->source, count, moved, values);
    for (unsigned i = 0; i < count; i++) {
        colours[i] = mapped(table, pigment->pattern, moved[i], NULL, values[i]);
    }
}

double texture_pattern_value(const TextureTable *table, uint32_t pattern, Vec3 point)
{
    return pattern_value(&table->scene->patterns.items[pattern].pattern, &table->source,
                         transform_point(&table->to_pattern[pattern], point));
}

// ---- textures

typedef struct Walk {
    const TextureTable *table;
    double cut;
    TextureVisit visit;
    void *client;
    TextureThrough through;
    Facing *facing; // of the whole surface; NULL: no pattern asks for it
    Vec3 *seen;     // not NULL then: the normal that the last pigment saw
    bool is_shadow;
} Walk;

static void walk_layers(Walk *walk, uint32_t index, const TexturePlace *place, double part, Rgb above);

// The textures of a face's corners: in their pattern's space x and y are the weights of the second and the third one.
// One that weighs less than light which is worth following is not seen, and nothing comes in its place. Measured.
static void walk_corners(Walk *walk, uint32_t first, const TexturePlace *place, double part, Rgb above)
{
    const TextureEntry *entries = walk->table->scene->texture_entries.items;
    Vec3 p = place->point;
    const double weights[] = {1.0 - p.x - p.y, p.x, p.y};
    uint32_t at = first;
    for (int i = 0; i < 3 && at != RECORD_NONE; i++, at = entries[at].next) {
        if (weights[i] > 0.0 && weights[i] >= walk->cut) {
            walk_layers(walk, entries[at].texture, place, part * weights[i], above);
        }
    }
}

static double field_size(const BlobComponent *component, Vec3 point)
{
    Vec3 own;
    double inner = 1.0 - blob_distance2(component, point, &own);
    return inner > 0.0 ? fabs(component->strength) * inner * inner : 0.0;
}

// Textures of a blob's components, each weighed by its field; what is left out is as at corners. Measured.
static void walk_fields(Walk *walk, const Texture *texture, const TexturePlace *here, double part, Rgb above)
{
    const Scene *scene = walk->table->scene;
    const TextureEntry *entries = scene->texture_entries.items;
    Blob blob = blob_of(scene->blobs.items[texture->pattern.image].items);
    double shares[blob.component_count + 1], sum = 0.0; // there are no more textures than that
    memset(shares, 0, (blob.component_count + 1) * sizeof *shares);
    for (uint32_t i = 0; i < blob.component_count; i++) {
        sum += field_size(&blob.components[i], here->point);
    }
    for (uint32_t i = 0; i < blob.component_count && sum > 0.0; i++) {
        double share = field_size(&blob.components[i], here->point) / sum;
        shares[(size_t)blob.components[i].texture] += share >= walk->cut ? share : 0.0;
    }
    shares[0] = sum > 0.0 ? shares[0] : 1.0;
    uint32_t at = texture->entries;
    for (uint32_t i = 0; at != RECORD_NONE; i++, at = entries[at].next) {
        if (shares[i] > 0.0) {
            walk_layers(walk, entries[at].texture, i == 0 ? here->outer : here, part * shares[i], above);
        }
    }
}

static void walk_average(Walk *walk, uint32_t first, const TexturePlace *place, double part, Rgb above)
{
    const TextureEntry *entries = walk->table->scene->texture_entries.items;
    double weights = 0.0;
    for (uint32_t at = first; at != RECORD_NONE; at = entries[at].next) {
        weights += entries[at].at;
    }
    for (uint32_t at = first; at != RECORD_NONE; at = entries[at].next) {
        if (entries[at].at != 0.0) {
            walk_layers(walk, entries[at].texture, place, part * entries[at].at / weights, above);
        }
    }
}

static double facing_value(const Walk *walk, const Pattern *pattern, Vec3 moved)
{
    Vec3 whole = walk->facing->normal;
    walk->facing->normal = *walk->seen;
    double value = pattern_value_moved(pattern, &walk->table->source, moved);
    walk->facing->normal = whole;
    return value;
}

static void walk_pattern(Walk *walk, uint32_t index, const TexturePlace *outer, double part, Rgb above)
{
    const Texture *texture = &walk->table->scene->textures.items[index];
    const TextureEntry *entries = walk->table->scene->texture_entries.items;
    Vec3 space = texture_space(&texture->pattern, outer->point, outer->uv);
    Vec3 point = transform_point(&walk->table->texture_to_pattern[index], space);
    TexturePlace here = {pattern_moved(&texture->pattern, &walk->table->source, point), index, outer, outer->uv};
    if (texture_is_of_fields(texture)) {
        walk_fields(walk, texture, &here, part, above);
        return;
    }
    if (texture->pattern.type == PATTERN_AVERAGE) {
        (texture_is_of_corners(texture) ? walk_corners : walk_average)(walk, texture->entries, &here, part, above);
        return;
    }
    double value = RT_UNLIKELY(walk->facing) ? facing_value(walk, &texture->pattern, here.point)
                                             : pattern_value_moved(&texture->pattern, &walk->table->source, here.point);
    AlongPlace place = along_find(&walk->table->texture_lists[index], value);
    bool is_turned = walk->facing && place.share > 0.0; // then the order counts
    if (is_turned) {
        walk_layers(walk, entries[place.high].texture, &here, place.share * part, above);
    }
    walk_layers(walk, entries[place.low].texture, &here, (1.0 - place.share) * part, above);
    if (place.share > 0.0 && !is_turned) {
        walk_layers(walk, entries[place.high].texture, &here, place.share * part, above);
    }
}

// A layer's pigment sees the surface as the layer's own bumps turn it, in the space of the map that the layer is in. A
// pattern of textures sees it as the pigment before it did. All else sees it as it is in the scene, and so do pigments in
// shadows. Measured.
static Rgbft facing_pigment(const Walk *walk, const Texture *texture, const TexturePlace *place)
{
    Vec3 whole = walk->facing->normal;
    *walk->seen = whole;
    if (texture->normal != RECORD_NONE && !walk->is_shadow) {
        TextureLayer layer = {.normal = texture->normal, .place = place, .table = walk->table};
        *walk->seen = walk->facing->normal = texture_normal_inside(&layer, whole);
    }
    Rgbft pigment = texture_pigment_on(walk->table, &texture->pigment, place->point, place->uv);
    walk->facing->normal = whole;
    return pigment;
}

static void walk_layers(Walk *walk, uint32_t index, const TexturePlace *place, double part, Rgb above)
{
    for (uint32_t top = index; index != RECORD_NONE; index = walk->table->scene->textures.items[index].below) {
        const Texture *texture = &walk->table->scene->textures.items[index];
        if (texture->pattern.type != PATTERN_NONE) {
            walk_pattern(walk, index, place, part, above); // the lowest one, by the evaluator's rule
            return;
        }
        Rgbft pigment = RT_UNLIKELY(walk->facing)
                            ? facing_pigment(walk, texture, place)
                            : texture_pigment_on(walk->table, &texture->pigment, place->point, place->uv);
        TextureLayer layer = {pigment, texture->finish, texture->normal, index == top,
                              place,   part,            above,           walk->table};
        Rgb left = walk->visit ? walk->visit(walk->client, &layer) : rgb_grey(1.0);
        above = rgb_mul(rgb_mul(above, left), texture_pigment_through(pigment));
        if (rgb_is_black(above) || fabs(rgb_luminance(above)) < walk->cut) {
            return;
        }
    }
    walk->through.light = rgb_add_scaled(walk->through.light, part, above);
    walk->through.part += part;
    walk->through.weight = greater_of(walk->through.weight, rgb_max_abs(above));
}

static TextureThrough walk_from(Walk *walk, uint32_t texture, Vec3 point, const Vec3 *uv)
{
    TexturePlace place = {point, RECORD_NONE, NULL, uv};
    walk_layers(walk, texture, &place, 1.0, rgb_grey(1.0));
    return walk->through;
}

// The same by a table that knows the surface.
static TextureThrough walk_facing(Walk *walk, uint32_t texture, TextureSight sight)
{
    TextureTable table = *walk->table;
    Facing facing = {vec3_scale(table.scale, sight.point), *sight.normal, *sight.direction};
    Vec3 seen = facing.normal;
    table.source.table = &table;
    table.source.facing = &facing;
    walk->table = &table;
    walk->facing = &facing;
    walk->seen = &seen;
    walk->is_shadow = sight.is_shadow;
    return walk_from(walk, texture, facing.point, sight.uv);
}

TextureThrough texture_walk(const TextureTable *table, uint32_t texture, TextureSight sight, double cut,
                            TextureVisit visit, void *client)
{
    Walk walk = {table, cut, visit, client, {rgb_grey(0.0), 0.0, 0.0}, NULL, NULL, false};
    return RT_UNLIKELY(table->faces) ? walk_facing(&walk, texture, sight)
                                     : walk_from(&walk, texture, vec3_scale(table->scale, sight.point), sight.uv);
}
