// Lights: a light_source block becomes a Light.
//
// A transform moves what stands before it, point_at included; what is said later is taken as it is. Measured on
// POV-Ray 3.7. Knows nothing of shading.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "eval/build/blocks.h"

enum { AREA_SIZE_MAX = 1024 }; // rows, and lights in each

static bool has_cone(const LightDesc *light)
{
    return light->spotlight || light->cylinder;
}

// The last of the three words counts; what a shadowless light was before is forgotten, but the direction of its rays.
static void forget_cone(LightDesc *light)
{
    light->parallel |= light->cylinder;
    light->spotlight = light->cylinder = false;
}

bool light_shadowless_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    (void)property;
    (void)item;
    forget_cone(&block->record->light);
    block->record->light.shadowless = true;
    return true;
}

bool light_type_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    LightDesc *light = &block->record->light;
    if (has_cone(light)) {
        return block_fault(block, DIAG_E0293, item->span, "a light is one `spotlight` or one `cylinder`");
    }
    light->shadowless = false;
    light->cylinder = property->word[0] == 'c';
    light->spotlight = !light->cylinder;
    light->radius = light->cylinder ? 0.75 : 30.0;
    light->falloff = light->cylinder ? 1.0 : 45.0;
    return true;
}

bool light_cone_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    SchemaProperty number = {property->word, TYPE_NUMBER, ACTION_NONE, .at = property->at};
    if (!has_cone(&block->record->light) && !block->has_fault) {
        return block_fault(block, DIAG_E0256, item->span, "`%s` needs `spotlight` or `cylinder` before it",
                           property->word);
    }
    return block_value(block, &number, item->span);
}

bool light_point_at_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty vector = {"point_at", TYPE_VECTOR, ACTION_NONE, .at = offsetof(LightDesc, point_at)};
    const LightDesc *light = &block->record->light;
    (void)property;
    if (!light->parallel && !has_cone(light) && !block->has_fault) {
        return block_fault(block, DIAG_E0256, item->span,
                           "`point_at` needs `parallel`, `spotlight` or `cylinder` before it");
    }
    return block_value(block, &vector, item->span);
}

bool light_area_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty values[] = {
        {"area_light", TYPE_VECTOR, ACTION_NONE, .at = offsetof(LightDesc, area.axis1)},
        {"area_light", TYPE_VECTOR, ACTION_NONE, .at = offsetof(LightDesc, area.axis2)},
        {"area_light", TYPE_INTEGER, ACTION_NONE, .at = offsetof(LightDesc, area.size1),
         .range = {RANGE_FAULT, false, 1.0, AREA_SIZE_MAX}},
        {"area_light", TYPE_INTEGER, ACTION_NONE, .at = offsetof(LightDesc, area.size2),
         .range = {RANGE_FAULT, false, 1.0, AREA_SIZE_MAX}},
    };
    (void)property;
    for (size_t i = 0; i < RT_COUNT_OF(values); i++) {
        if (!block_value(block, &values[i], item->span)) {
            return false;
        }
        if (i + 1 < RT_COUNT_OF(values)) {
            cursor_take_comma(&block->cursor);
        }
    }
    return true;
}

// The object is put where the light is at this word, before what else its braces say; later transforms move both.
bool light_look_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    LightDesc *light = &block->record->light;
    Desc record;
    SchemaKind is = KIND_NONE;
    (void)property;
    if (light->look) {
        return block_fault(block, DIAG_E0256, item->span, "a light looks like one object only");
    }
    Transform place = transform_translate(light->position);
    block_defaults(block->ev, KIND_LOOKS_LIKE, &record);
    if (!block_read_moved(block->ev, item, KIND_LOOKS_LIKE, (BlockRoom){block->arena, &place}, &record, &is)) {
        return false;
    }
    if (!schema_kind(is)->is_object) {
        block->has_unsupported = true; // and was reported
        return true;
    }
    UnionMember look = {NULL, arena_copy(block->arena, &record, schema_kind(is)->size), is};
    light->look = look.object ? arena_copy(block->arena, &look, sizeof look) : NULL;
    light->look_transform = transform_identity();
    light->look_depth = object_depth(is, &record) + 1;
    if (!light->look) {
        return eval_no_memory(block->ev, item->span);
    }
    return light->look_depth <= block->ev->options.limits->ast_depth ||
           block_fault(block, DIAG_E0601, item->span, "objects are nested more than %u deep",
                       block->ev->options.limits->ast_depth);
}

// A light that turns is a disc, whatever was said. Its axes may be made equal only when all transforms are known.
static void check_oriented(Block *block, LightArea *area)
{
    if (!area->circular) {
        eval_warn(block->ev, DIAG_W0349, block->node->span, "`orient` makes this light `circular`");
        area->circular = true;
    }
    if (!numbers_equal(vec3_length(area->axis2) / vec3_length(area->axis1), 1.0)) {
        eval_warn(block->ev, DIAG_W0349, block->node->span,
                  "with `orient` both axes get the length of the first of `area_light`, %g", vec3_length(area->axis1));
    }
}

// POV-Ray refuses a circular light of one row.
bool light_close(Block *block)
{
    const LightDesc *light = &block->record->light;
    LightArea *area = &block->record->light.area;
    bool is_area = area->size1 > 0 || area->size2 > 0;
    area->is_oriented &= is_area || area->circular; // it turns nothing
    if (light->lights_by_area && is_area) {
        block_unsupported(block->ev, "area_illumination", block->node->span, KIND_LIGHT_SOURCE);
        block->has_unsupported = true;
    }
    bool is_line = area->size1 < 2 || area->size2 < 2;
    if (area->is_oriented && !is_line) {
        check_oriented(block, area);
    }
    return !(area->circular || area->is_oriented) || !is_line ||
           block_fault(block, DIAG_E0294, block->node->span,
                       "`%s` needs an `area_light` of at least two rows and two columns",
                       area->circular ? "circular" : "orient");
}

void light_transform(LightDesc *light, const Transform *transform)
{
    light->position = transform_point(transform, light->position);
    light->point_at = transform_point(transform, light->point_at);
    light->area.axis1 = transform_direction(transform, light->area.axis1);
    light->area.axis2 = transform_direction(transform, light->area.axis2);
    light->look_transform = transform_compose(light->look_transform, *transform);
}

static LightType light_type(const LightDesc *light)
{
    // The rays of a parallel spotlight are all as on its axis.
    return light->cylinder    ? LIGHT_CYLINDER
           : light->parallel  ? LIGHT_PARALLEL
           : light->spotlight ? LIGHT_SPOT
                              : LIGHT_POINT;
}

bool light_place(Eval *ev, const LightDesc *light, const Transform *outer, uint32_t group)
{
    LightDesc moved = *light;
    light_transform(&moved, outer);
    bool fades = light->fade_distance > 0.0 && light->fade_power > 0.0;
    double length = light->cylinder ? world_scale(ev) : 1.0; // a spotlight's are angles
    Light record = {
        .type = light_type(light),
        .group = group,
        .shadowless = light->shadowless,
        .is_attenuated = light->is_attenuated,
        .position = moved.position,
        .point_at = moved.point_at,
        .colour = rgbft_rgb(light->colour),
        .radius = light->radius * length,
        .falloff = light->falloff * length,
        .tightness = light->tightness,
        .fade_distance = fades ? light->fade_distance * world_scale(ev) : 0.0,
        .fade_power = fades ? light->fade_power : 0.0,
        .area = moved.area,
        .span = light->part.span,
    };
    // Lengths that are equal but for the rounding of two lengths, a quotient and a product stay, so that a light that
    // was written with its axes is read as the same one.
    double side = vec3_length(record.area.axis2), wanted = vec3_length(record.area.axis1);
    if (record.area.is_oriented && side > 0.0 && fabs(side - wanted) > 8.0 * DBL_EPSILON * wanted) {
        record.area.axis2 = vec3_scale(wanted / side, record.area.axis2);
    }
    if (!vec3_is_finite(record.position) || !vec3_is_finite(record.point_at) || !vec3_is_finite(record.area.axis1) ||
        !vec3_is_finite(record.area.axis2)) {
        return eval_fault(ev, DIAG_E0340, light->part.span, "the light leaves the range of numbers");
    }
    return (scene_add_light(ev->scene, &record) || eval_no_memory(ev, light->part.span)) &&
           memory_suffices(ev, light->part.span);
}
