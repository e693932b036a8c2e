// What lies around the scene: a sky_sphere becomes layers of pigments, a fog a Fog.
//
// Of several skies the last one counts, so they are kept and become records when the whole scene is read. Measured on
// POV-Ray 3.7. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#include "base/number.h"
#include "eval/build/blocks.h"

// ---- sky_sphere

bool sky_layer_action(Block *block, const SchemaProperty *property, const AstNode *item)
{
    Desc record;
    SchemaKind is;
    SkySphereDesc *sky = &block->record->sky;
    (void)property;
    record.pigment = *(const PigmentDesc *)schema_kind(KIND_PIGMENT)->defaults; // the sky knows no #default
    if (!block_read(block->ev, item, KIND_PIGMENT, block->arena, &record, &is)) {
        return false;
    }
    SkyLayer layer = {sky->top, record.pigment};
    sky->top = arena_copy(block->arena, &layer, sizeof layer);
    return sky->top || eval_no_memory(block->ev, item->span);
}

bool sky_close(Block *block)
{
    block->is_lost = !block->record->sky.top;
    return block->record->sky.top || block->has_unsupported ||
           block_fault(block, DIAG_E0253, block->node->span, "`sky_sphere` needs a pigment in it");
}

bool sky_place(Eval *ev, const SkySphereDesc *sky, Span span)
{
    ObjectState *objects = ev->objects;
    if (objects->sky) {
        eval_warn(ev, DIAG_W0408, span, "more than one sky_sphere: only the last one counts");
    }
    objects->sky = arena_copy(&ev->program, sky, sizeof *sky);
    objects->sky_span = span;
    return objects->sky || eval_no_memory(ev, span);
}

static bool sky_finish(Eval *ev)
{
    const SkySphereDesc *sky = ev->objects->sky;
    Span span = ev->objects->sky_span;
    if (!sky || ev->stop) {
        return true;
    }
    ev->scene->sky_emission = sky->emission;
    ev->scene->sky_span = span;
    for (const SkyLayer *layer = sky->top; layer; layer = layer->below) {
        Pigment record;
        if (!eval_step(ev, span) || !pigment_place(ev, ev->scene, &layer->pigment, &sky->transform, span, &record)) {
            return false;
        }
        if (!scene_add_sky_layer(ev->scene, &record)) {
            return eval_no_memory(ev, span);
        }
    }
    return true;
}

bool objects_finish(Eval *ev)
{
    return sky_finish(ev) && rainbows_finish(ev) && camera_finish(ev);
}

// ---- fog

bool fog_close(Block *block)
{
    const FogDesc *fog = &block->record->fog;
    Span span = block->node->span;
    if (fog->type != 2 || fog->distance == 0.0) {
        return true;
    }
    if (!(fog->alt > 0.0)) {
        return block_fault(block, DIAG_E0341, span, "`fog_alt` must be greater than 0 in a fog of type 2, not %g",
                           fog->alt);
    }
    return vec3_length_squared(vector_unit(fog->up)) > 0.0 ||
           block_fault(block, DIAG_E0342, span, "`up` of a fog cannot be <0, 0, 0>");
}

bool fog_place(Eval *ev, const FogDesc *fog, Span span)
{
    double scale = world_scale(ev);
    Vec3 shift = ev->options.world ? ev->options.world->shift : vec3(0.0, 0.0, 0.0);
    Fog record = {.is_ground = fog->type == 2, .distance = fog->distance * scale, .colour = fog->colour, .span = span};
    if (record.distance == 0.0) {
        return true;
    }
    // Each of the words makes POV-Ray's fog turbulent, whatever its value. Measured.
    if (fog->is_turbulent && fog->turb_depth != 0.0) {
        record.is_turbulent = true;
        record.turb_depth = number_single(fog->turb_depth);
        record.turbulence = vec3_scale(1.0 / scale, fog->turbulence);
        record.origin = shift;
        record.lambda = number_single(fog->lambda);
        record.omega = number_single(fog->omega);
        record.octaves = fog->octaves;
    }
    if (record.is_ground) {
        record.up = vector_unit(fog->up);
        record.offset = fog->offset * scale + vec3_dot(record.up, shift);
        record.alt = fog->alt * scale;
    }
    return (scene_add_fog(ev->scene, &record) || eval_no_memory(ev, span)) && memory_suffices(ev, span);
}
