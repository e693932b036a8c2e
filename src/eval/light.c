// Lights: a light_source block becomes a Light.
//
// A transform moves what stands before it, point_at included; what is said later is taken as it is. Measured on
// POV-Ray 3.7. Knows nothing of shading.
//
// SPDX-License-Identifier: MIT
#include "eval/blocks.h"

bool light_point_at_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    static const SchemaProperty vector = {"point_at", TYPE_VECTOR, ACTION_NONE,
                                          .at = offsetof(LightBlueprint, point_at)};
    (void)property;
    if (!block->record->light.parallel && !block->has_fault) {
        return block_fault(block, DIAG_E0256, item->span, "`point_at` needs `parallel` before it");
    }
    return block_value(block, &vector, item->span);
}

void light_transform(LightBlueprint *light, const Transform *transform)
{
    light->position = transform_point(transform, light->position);
    light->point_at = transform_point(transform, light->point_at);
}

bool light_place(Eval *ev, const LightBlueprint *light, const Transform *outer)
{
    LightBlueprint moved = *light;
    light_transform(&moved, outer);
    Light record = {
        .type = light->parallel ? LIGHT_PARALLEL : LIGHT_POINT,
        .shadowless = light->shadowless,
        .position = moved.position,
        .point_at = moved.point_at,
        .colour = rgbft_rgb(light->colour),
        .span = light->part.span,
    };
    if (!vec3_is_finite(record.position) || !vec3_is_finite(record.point_at)) {
        return eval_fault(ev, DIAG_E0340, light->part.span, "the light leaves the range of numbers");
    }
    return scene_add_light(ev->scene, &record) || eval_no_memory(ev, light->part.span);
}
