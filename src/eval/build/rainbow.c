// Rainbows: what stands in the braces becomes a Rainbow.
//
// They are kept in the program's memory and become records when the whole scene is read, behind the sky, for their
// colours are a pigment. Measured on POV-Ray 3.7. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

bool rainbow_map_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    (void)property;
    block_defaults(block->ev, KIND_COLOUR_MAP, &record);
    if (!block_read(block->ev, item, KIND_COLOUR_MAP, block->arena, &record, &is)) {
        return false;
    }
    block->record->rainbow.map = arena_copy(block->arena, &record.map, sizeof record.map);
    return block->record->rainbow.map || eval_no_memory(block->ev, item->span);
}

bool rainbow_close(Block *block)
{
    const RainbowDesc *rainbow = &block->record->rainbow;
    Span span = block->node->span;
    Vec3 direction = vector_unit(rainbow->direction), up = vector_unit(rainbow->up);
    if (!rainbow->has_direction) {
        return block->has_unsupported || block_fault(block, DIAG_E0253, span, "a rainbow needs a `direction`");
    }
    if (!(vec3_length_squared(direction) > 0.0)) {
        return block_fault(block, DIAG_E0342, span, "the direction of a rainbow cannot be <0, 0, 0>");
    }
    if (!(vec3_length_squared(vec3_cross(up, direction)) > 0.0)) {
        return block_fault(block, DIAG_E0342, span, "`up` of a rainbow cannot be along its direction");
    }
    return rainbow->falloff_angle <= rainbow->arc_angle ||
           block_fault(block, DIAG_E0341, span, "`falloff_angle` must not be greater than `arc_angle`");
}

bool rainbow_keep(Eval *ev, const RainbowDesc *rainbow, Span span)
{
    ObjectState *objects = ev->objects;
    KeptRainbow kept = {*rainbow, span, NULL};
    if (!rainbow->map || rainbow->distance == 0.0 || rainbow->width == 0.0) {
        return true; // nothing of it is seen
    }
    KeptRainbow *last = arena_copy(&ev->program, &kept, sizeof kept);
    if (!last) {
        return eval_no_memory(ev, span);
    }
    *(objects->last_rainbow ? &objects->last_rainbow->next : &objects->rainbows) = last;
    objects->last_rainbow = last;
    return true;
}

static bool place(Eval *ev, const KeptRainbow *kept)
{
    const RainbowDesc *from = &kept->desc;
    Transform identity = transform_identity();
    PigmentDesc pigment = *(const PigmentDesc *)schema_kind(KIND_PIGMENT)->defaults;
    Pigment colours;
    pigment.part.pattern.type = PATTERN_GRADIENT;
    pigment.part.pattern.vector = vec3(1.0, 0.0, 0.0);
    pigment.part.pattern.frequency = 0.0;
    pigment.part.map = from->map;
    if (!eval_step(ev, kept->span) || !pigment_place(ev, ev->scene, &pigment, &identity, kept->span, &colours)) {
        return false;
    }
    Vec3 direction = vector_unit(from->direction), across = vector_unit(vec3_cross(from->up, direction));
    Rainbow record = {.direction = from->direction,
                      .up = from->up,
                      .ahead = direction,
                      .top = vec3_cross(direction, across),
                      .across = across,
                      .angle = from->angle,
                      .width = from->width,
                      .arc = from->arc_angle / 2.0,
                      .falloff = from->falloff_angle / 2.0,
                      .distance = from->distance * world_scale(ev),
                      .jitter = from->jitter,
                      .pattern = colours.pattern,
                      .span = kept->span};
    return scene_add_rainbow(ev->scene, &record) || eval_no_memory(ev, kept->span);
}

bool rainbows_finish(Eval *ev)
{
    bool is_fine = true;
    for (const KeptRainbow *kept = ev->objects->rainbows; is_fine && !ev->stop && kept; kept = kept->next) {
        is_fine = place(ev, kept);
    }
    return is_fine;
}
