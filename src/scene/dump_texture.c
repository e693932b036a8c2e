// Patterned pigments and textures as `.scn` text.
//
// A record stands after the ones it refers to, for that is the order in which they were added. Knows only what it
// writes of the language.
//
// SPDX-License-Identifier: MIT
#include "scene/dump.h"

void dump_matrix(const Transform *transform, TextBuffer *out)
{
    text_append(out, "  matrix ");
    dump_numbers(out, &transform->m[0][0], 12);
    text_append(out, "\n");
}

// What `pigment { }` holds, or an entry of a map.
static void dump_pigment_items(const Pigment *pigment, TextBuffer *out)
{
    if (pigment->pattern == RECORD_NONE) {
        dump_rgbft(out, "", pigment_colour(pigment));
    } else {
        text_printf(out, "P%lu", (unsigned long)pigment->pattern + 1);
    }
}

// Only where they are not what they are without being said, so that patterns without noise stay short.
static void dump_noise_modifiers(const Pattern *pattern, TextBuffer *out)
{
    bool is_turbulent = vec3_max_abs(pattern->turbulence) > 0.0 || pattern->type == PATTERN_AGATE;
    if (is_turbulent) {
        dump_vector(out, "  turbulence ", pattern->turbulence);
        dump_number(out, " lambda ", pattern->lambda);
        dump_number(out, " omega ", pattern->omega);
        text_printf(out, " octaves %d\n", (int)pattern->octaves);
    }
    if (pattern->type == PATTERN_AGATE) {
        dump_number(out, "  agate_turb ", pattern->agate_turb);
        text_append(out, "\n");
    }
    if (pattern->type == PATTERN_CRACKLE) {
        dump_vector(out, "  form ", pattern->form);
        dump_number(out, " metric ", pattern->metric);
        dump_number(out, " offset ", pattern->offset);
        text_append(out, pattern->flags & PATTERN_SOLID ? " solid\n" : "\n");
    }
    if (pattern->generator != 0) {
        text_printf(out, "  noise_generator %d\n", (int)pattern->generator);
    }
}

// Of fractals: what is returned for points that leave, and for those that stay.
static void dump_told(const Pattern *pattern, TextBuffer *out)
{
    text_printf(out, "  exterior %d", (int)pattern->exterior);
    dump_number(out, ", ", pattern->exterior_factor);
    text_printf(out, " interior %d", (int)pattern->interior);
    dump_number(out, ", ", pattern->interior_factor);
    text_append(out, "\n");
}

static void dump_modifiers(const Pattern *pattern, TextBuffer *out)
{
    if (pattern->type == PATTERN_BRICK) {
        dump_vector(out, "  brick_size ", pattern->vector);
        dump_number(out, " mortar ", pattern->mortar);
        text_append(out, "\n");
    }
    dump_noise_modifiers(pattern, out);
    if (pattern->type == PATTERN_QUILTED) {
        dump_number(out, "  control0 ", pattern->vector.x);
        dump_number(out, " control1 ", pattern->vector.y);
        text_append(out, "\n");
    }
    if (pattern->power > 2) {
        text_printf(out, "  exponent %d\n", (int)pattern->power);
    }
    bool is_fractal = pattern->type == PATTERN_MANDEL || pattern->type == PATTERN_JULIA;
    if (is_fractal && (pattern->exterior != 1 || pattern->exterior_factor != 1.0 || pattern->interior != 0 ||
                       pattern->interior_factor != 1.0)) {
        dump_told(pattern, out);
    }
    dump_number(out, "  frequency ", pattern->frequency);
    dump_number(out, " phase ", pattern->phase);
    text_printf(out, " %s", pattern_wave_word((WaveType)pattern->wave));
    if (pattern->wave == WAVE_POLY) {
        dump_number(out, " ", pattern->exponent);
    }
    text_append(out, "\n");
}

// In a string a backslash and a quote need one before them.
static void dump_string(TextBuffer *out, const char *text)
{
    text_append(out, "\"");
    for (; *text; text++) {
        text_printf(out, "%s%c", *text == '\\' || *text == '"' ? "\\" : "", *text);
    }
    text_append(out, "\"");
}

static void dump_source(const PictureSource *source, TextBuffer *out)
{
    text_printf(out, " {\n    %s ", picture_format_word((PictureFormat)source->format));
    dump_string(out, source->path);
    if (source->encoding == PICTURE_GAMMA_POWER) {
        dump_number(out, " gamma ", source->gamma);
    } else if (source->encoding == PICTURE_GAMMA_SRGB) {
        text_append(out, " gamma srgb");
    }
    if (source->alpha != PICTURE_ALPHA_UNSAID) {
        text_printf(out, " premultiplied %s", source->alpha == PICTURE_ALPHA_ASSOCIATED ? "on" : "off");
    }
}

// A picture and how it is laid, up to the closing brace.
static void dump_picture(const Scene *scene, const Pattern *pattern, TextBuffer *out)
{
    const ImageMap *map = &scene->image_maps.items[pattern->image];
    text_printf(out, "  %s", pattern_info((PatternType)pattern->type)->word);
    dump_source(&scene->picture_sources.items[map->picture], out);
    text_printf(out, " map_type %lu%s%s%s", (unsigned long)map->projection, map->is_once ? " once" : "",
                map->use == PICTURE_ALPHA ? " use_alpha" : "", map->use == PICTURE_INDEX ? " use_index" : "");
    if (map->interpolation != INTERPOLATION_NONE) {
        text_printf(out, " interpolate %lu", (unsigned long)map->interpolation);
    }
    for (uint32_t i = map->shades; i != RECORD_NONE; i = scene->picture_shades.items[i].next) {
        const PictureShade *shade = &scene->picture_shades.items[i];
        text_printf(out, "\n    %s ", shade->is_filter ? "filter" : "transmit");
        if (shade->place == SHADE_ALL) {
            text_append(out, "all");
        } else {
            text_printf(out, "%lu,", (unsigned long)shade->place);
        }
        dump_number(out, " ", shade->amount);
    }
}

static void dump_surface_word(const Pattern *pattern, TextBuffer *out)
{
    text_append(out, pattern->flags & PATTERN_ON_SURFACE ? "  uv_mapping\n" : "");
}

static void dump_range(double low, double high, TextBuffer *out)
{
    if (low != high) {
        dump_number(out, ", ", low);
        dump_number(out, ", ", high);
    }
}

static void dump_slope(const Pattern *pattern, TextBuffer *out)
{
    dump_vector(out, pattern->flags & PATTERN_TO_POINT ? " { point_at " : " { ", pattern->vector);
    dump_range(pattern->metric, pattern->offset, out);
    if (vec3_max_abs(pattern->form) > 0.0) {
        dump_vector(out, " altitude ", pattern->form);
        dump_range(pattern->exterior_factor, pattern->interior_factor, out);
    }
    text_append(out, " }");
}

static void dump_pattern_word(const Scene *scene, const Pattern *pattern, TextBuffer *out)
{
    dump_surface_word(pattern, out);
    if (pattern->type == PATTERN_FUNCTION) {
        dump_formula(scene, pattern, out);
        return;
    }
    if (pattern_is_picture(pattern->type)) {
        dump_picture(scene, pattern, out);
        text_append(out, pattern->type == PATTERN_MATERIAL_MAP ? "" : " }");
        return;
    }
    const PatternInfo *info = pattern_info((PatternType)pattern->type);
    if (pattern->magnet) {
        text_printf(out, "  magnet %d", (int)pattern->magnet);
    }
    text_printf(out, pattern->magnet ? " %s" : "  %s", info->word);
    if (info->has_direction && info->has_count) { // a point of the plane
        text_append(out, " ");
        dump_numbers(out, (double[]){pattern->vector.x, pattern->vector.y}, 2);
    } else if (info->has_direction) {
        dump_vector(out, " ", pattern->vector);
    }
    if (pattern->type == PATTERN_SLOPE) {
        dump_slope(pattern, out);
    }
    if (info->has_count) {
        text_printf(out, info->has_direction ? ", %d" : " %d", (int)pattern->count);
    }
    if (pattern->type == PATTERN_OBJECT) {
        text_append(out, " {\n");
        dump_inside(scene->insides.items[pattern->image], out);
    }
    if (pattern->type == PATTERN_PIGMENT) {
        text_printf(out, " { P%lu }", (unsigned long)pattern->image + 1);
    }
}

// Of what has blocks behind it within its braces.
static const char *end_of_blocks(const Pattern *pattern)
{
    return pattern->type == PATTERN_OBJECT ? " }\n" : "\n";
}

static void dump_place(const Scene *scene, const Pattern *pattern, const Transform *to_world, TextBuffer *out)
{
    dump_warps(scene, pattern, out);
    dump_matrix(to_world, out);
}

void dump_pattern(const Scene *scene, const PatternedPigment *record, TextBuffer *out)
{
    dump_pattern_word(scene, &record->pattern, out);
    text_append(out, end_of_blocks(&record->pattern));
    dump_modifiers(&record->pattern, out);
    dump_place(scene, &record->pattern, &record->to_world, out);
}

static void dump_image_map(const Scene *scene, const PatternedPigment *record, size_t number, TextBuffer *out)
{
    text_printf(out, "#declare P%zu = pigment {\n", number);
    dump_pattern_word(scene, &record->pattern, out);
    text_append(out, "\n");
    dump_modifiers(&record->pattern, out);
    dump_place(scene, &record->pattern, &record->to_world, out);
    text_append(out, "}\n");
}

static void dump_pigment(const Scene *scene, const PatternedPigment *record, size_t number, TextBuffer *out)
{
    bool has_blocks = pattern_info((PatternType)record->pattern.type)->blocks > 0;
    dump_formula_parts(scene, &record->pattern, out);
    text_printf(out, "#declare P%zu = pigment {\n", number);
    dump_pattern_word(scene, &record->pattern, out);
    text_append(out, has_blocks ? "" : "\n  pigment_map {");
    for (uint32_t i = record->entries; i != RECORD_NONE; i = scene->pigment_entries.items[i].next) {
        const PigmentEntry *entry = &scene->pigment_entries.items[i];
        if (has_blocks) {
            text_append(out, " pigment { ");
        } else {
            dump_number(out, " [", entry->at);
            text_append(out, " ");
        }
        dump_pigment_items(&entry->pigment, out);
        text_append(out, has_blocks ? " }" : "]");
    }
    text_append(out, has_blocks ? end_of_blocks(&record->pattern) : " }\n");
    dump_modifiers(&record->pattern, out);
    dump_place(scene, &record->pattern, &record->to_world, out);
    text_append(out, "}\n");
}

static void dump_normal_entries(const Scene *scene, const Normal *record, TextBuffer *out)
{
    bool has_blocks = pattern_info((PatternType)record->pattern.type)->blocks > 0;
    text_append(out, has_blocks ? "" : "  normal_map {");
    for (uint32_t i = record->entries; i != RECORD_NONE; i = scene->normal_entries.items[i].next) {
        const NormalEntry *entry = &scene->normal_entries.items[i];
        if (!has_blocks) {
            dump_number(out, " [", entry->at);
        }
        text_printf(out, has_blocks ? " normal { N%lu }" : " N%lu]", (unsigned long)entry->normal + 1);
    }
    text_append(out, has_blocks ? end_of_blocks(&record->pattern) : " }\n");
}

static void dump_slopes(const Scene *scene, uint32_t first, TextBuffer *out)
{
    text_append(out, "  slope_map {");
    for (uint32_t i = first; i != RECORD_NONE; i = scene->slope_entries.items[i].next) {
        const SlopeEntry *entry = &scene->slope_entries.items[i];
        dump_number(out, " [", entry->at);
        dump_number(out, " <", entry->height);
        dump_number(out, ", ", entry->slope);
        text_append(out, ">]");
    }
    text_append(out, " }\n");
}

static void dump_normal(const Scene *scene, const Normal *record, size_t number, TextBuffer *out)
{
    bool has_blocks = pattern_info((PatternType)record->pattern.type)->blocks > 0;
    dump_formula_parts(scene, &record->pattern, out);
    text_printf(out, "#declare N%zu = normal {\n", number);
    dump_pattern_word(scene, &record->pattern, out);
    if (record->entries == RECORD_NONE || !has_blocks) {
        text_append(out, end_of_blocks(&record->pattern));
    }
    if (record->entries != RECORD_NONE) {
        dump_normal_entries(scene, record, out);
    }
    if (record->slopes != RECORD_NONE) {
        dump_slopes(scene, record->slopes, out);
    }
    dump_number(out, "  bump_size ", record->amount);
    dump_number(out, " accuracy ", record->accuracy);
    text_append(out, record->flags & NORMAL_KEEPS_LENGTH ? " no_bump_scale\n" : "\n");
    dump_modifiers(&record->pattern, out);
    dump_place(scene, &record->pattern, &record->to_world, out);
    text_append(out, "}\n");
}

static void dump_layer(const Texture *record, size_t number, TextBuffer *out)
{
    text_printf(out, "#declare T%zu =", number);
    if (record->below != RECORD_NONE) {
        text_printf(out, " texture { T%lu }", (unsigned long)record->below + 1);
    }
    text_append(out, " texture { pigment { ");
    dump_pigment_items(&record->pigment, out);
    if (record->normal != RECORD_NONE) {
        text_printf(out, " } normal { N%lu", (unsigned long)record->normal + 1);
    }
    text_printf(out, " } finish { F%lu } }\n", (unsigned long)record->finish + 1);
}

static void dump_texture_pattern(const Scene *scene, const Texture *record, size_t number, TextBuffer *out)
{
    bool is_numbered = record->pattern.type == PATTERN_MATERIAL_MAP;
    bool has_blocks = is_numbered || pattern_info((PatternType)record->pattern.type)->blocks > 0;
    dump_formula_parts(scene, &record->pattern, out);
    text_printf(out, "#declare T%zu = texture {\n", number);
    dump_pattern_word(scene, &record->pattern, out);
    text_append(out, has_blocks ? "" : "\n  texture_map {");
    for (uint32_t i = record->entries; i != RECORD_NONE; i = scene->texture_entries.items[i].next) {
        const TextureEntry *entry = &scene->texture_entries.items[i];
        if (!has_blocks) {
            dump_number(out, " [", entry->at);
        }
        text_printf(out, has_blocks ? " texture { T%lu }" : " T%lu]", (unsigned long)entry->texture + 1);
    }
    text_append(out, has_blocks && !is_numbered ? end_of_blocks(&record->pattern) : " }\n");
    if (!is_numbered) {
        dump_modifiers(&record->pattern, out);
    }
    dump_place(scene, &record->pattern, &record->to_world, out);
    text_append(out, "}\n");
}

static void dump_interior(const Interior *interior, size_t number, TextBuffer *out)
{
    text_printf(out, "#declare I%zu = interior {", number);
    dump_number(out, " ior ", interior->ior);
    dump_number(out, " fade_distance ", interior->fade_distance);
    dump_number(out, " fade_power ", interior->fade_power);
    dump_rgb(out, " fade_color ", interior->fade_colour);
    if (interior->caustics != 0.0) {
        dump_number(out, " caustics ", interior->caustics);
    }
    text_append(out, " }\n");
}

void dump_textures(const Scene *scene, TextBuffer *out)
{
    for (size_t i = 0; i < scene->interiors.count; i++) {
        dump_interior(&scene->interiors.items[i], i + 1, out);
    }
    for (size_t i = 0; i < scene->patterns.count; i++) {
        const PatternedPigment *record = &scene->patterns.items[i];
        bool is_picture = record->pattern.type == PATTERN_IMAGE_MAP;
        (is_picture ? dump_image_map : dump_pigment)(scene, record, i + 1, out);
    }
    for (size_t i = 0; i < scene->normals.count; i++) {
        dump_normal(scene, &scene->normals.items[i], i + 1, out);
    }
    for (size_t i = 0; i < scene->textures.count; i++) {
        const Texture *record = &scene->textures.items[i];
        if (record->pattern.type == PATTERN_NONE) {
            dump_layer(record, i + 1, out);
        } else {
            dump_texture_pattern(scene, record, i + 1, out);
        }
    }
}

void dump_sky(const Scene *scene, TextBuffer *out)
{
    if (scene->sky.count == 0) {
        return;
    }
    text_append(out, "sky_sphere {\n");
    for (size_t i = scene->sky.count; i-- > 0;) {
        text_append(out, "  pigment { ");
        dump_pigment_items(&scene->sky.items[i], out);
        text_append(out, " }\n");
    }
    dump_rgb(out, "  emission ", scene->sky_emission);
    text_append(out, "\n}\n");
}
