// Functions of patterns and pigments: `function { pattern { … } }` and `function { pigment { … } }`.
//
// Turns the block into records of a scene of its own, which the painter (EvalPainter) is given when the function is
// called first. Refers to the evaluator's noise. Knows nothing of how a pattern is computed.
//
// SPDX-License-Identifier: MIT
#include "eval/build/painted.h"

#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"

struct Painted {
    Scene scene;
    PigmentDesc desc;
    Pigment pigment;
    bool is_pattern;
    bool is_tried;
    void *opened; // NULL: not yet, or there was a fault
};

static Painted *painted_new(Eval *ev, const Value *value, Span span)
{
    PigmentDesc pigment = {0};
    Transform world = transform_identity();
    Painted *painted = arena_alloc(&ev->program, sizeof *painted);
    if (painted == NULL || !ARRAY_PUSH(&ev->painted, painted)) {
        eval_no_memory(ev, span);
        return NULL;
    }
    *painted = (Painted){.is_pattern = value->block == KIND_PATTERN};
    scene_init(&painted->scene);
    if (painted->is_pattern) {
        pigment.part = *(const PatternPart *)value->record;
    } else {
        pigment = *(const PigmentDesc *)value->record;
    }
    painted->desc = pigment;
    return pigment_place(ev, &painted->scene, &pigment, &world, span, &painted->pigment) ? painted : NULL;
}

bool painted_create(Eval *ev, const AstNode *block, Painted **painted, const char **unsupported)
{
    SchemaKind kind = block_kind(ev, block);
    Desc record;
    Value value;
    memcpy(&record, schema_kind(kind)->defaults, schema_kind(kind)->size); // those of #default are not asked. Measured.
    if (!block_read_declared(ev, block, kind, &record, &value)) {
        return false;
    }
    if (value.block == KIND_UNSUPPORTED) {
        *unsupported = ((const UnsupportedDesc *)value.record)->word;
        return true;
    }
    *painted = painted_new(ev, &value, block->span);
    return *painted != NULL;
}

static bool has_pictures(Eval *ev, Scene *scene, Span span)
{
    if (scene->pictures.count == 0) {
        return true;
    }
    if (ev->options.load_pictures == NULL) {
        return eval_fault(ev, DIAG_E0210, span, "a function of an `image_map` is not supported");
    }
    if (!ev->options.load_pictures(ev->options.client, scene)) {
        ev->stop = true;
        return false;
    }
    return memory_has(ev, scene_bytes(scene)) || eval_no_memory(ev, span);
}

static void painted_open(Eval *ev, Painted *painted, Span span)
{
    const Noise *noise = eval_noise(ev, span);
    painted->is_tried = true;
    if (ev->options.painter == NULL) {
        eval_fault(ev, DIAG_E0210, span, "functions of patterns and pigments are not supported");
        return;
    }
    if (noise == NULL || !has_pictures(ev, &painted->scene, span)) {
        return;
    }
    painted->opened = ev->options.painter->open(&painted->scene, noise);
    if (painted->opened == NULL) {
        eval_no_memory(ev, span);
        return;
    }
    ev->opened_bytes += OPENED_BYTES + scene_bytes(&painted->scene) + ev->options.painter->bytes(painted->opened);
    if (!memory_suffices(ev, span)) {
        ev->options.painter->close(painted->opened);
        painted->opened = NULL;
    }
}

bool painted_at(Eval *ev, Painted *painted, const double point[3], Span span, double v[5])
{
    const EvalPainter *painter = ev->options.painter;
    Vec3 p = vec3(point[0], point[1], point[2]);
    if (!eval_step(ev, span)) {
        return false;
    }
    if (!painted->is_tried) {
        painted_open(ev, painted, span);
    }
    if (painted->opened == NULL) {
        return false;
    }
    if (!vec3_is_finite(p)) {
        v[0] = v[1] = v[2] = v[3] = v[4] = (double)NAN; // nothing lies there
        return true;
    }
    NoiseGenerator generator = eval_noise_generator(ev);
    if (painted->is_pattern) {
        v[0] = painter->value(painted->opened, &painted->pigment, generator, p);
        return true;
    }
    Rgbft colour = painter->colour(painted->opened, &painted->pigment, generator, p);
    v[0] = (double)(float)colour.red;
    v[1] = (double)(float)colour.green;
    v[2] = (double)(float)colour.blue;
    v[3] = (double)(float)colour.filter;
    v[4] = (double)(float)colour.transmit;
    return true;
}

bool painted_place(Eval *ev, Scene *scene, const Painted *painted, Span span, Pigment *pigment)
{
    Transform identity = transform_identity();
    return pigment_place(ev, scene, &painted->desc, &identity, span, pigment);
}

void painted_fini(Eval *ev)
{
    for (size_t i = 0; i < ev->painted.count; i++) {
        Painted *painted = ev->painted.items[i];
        if (painted->opened != NULL) {
            ev->options.painter->close(painted->opened);
        }
        scene_fini(&painted->scene);
    }
    ARRAY_FREE(&ev->painted);
}
