// Literal spheres: the evaluator's part in statements that are read without a tree (grammar/literal.c).
//
// One statement of each kind is evaluated as any other while it is watched; when it gave one plain sphere and no
// message, the next ones of its kind differ in centre, radius and colour only and become scene records at once.
// Whatever may change what such a statement gives changes `state`. Knows nothing of text.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/blocks.h"

// Beyond this a colour is left to the statements that say what is wrong with it.
#define COLOUR_GREATEST 1e30

static Eval *eval_of(void *client)
{
    return ((Splice *)client)->cursor.ev;
}

static size_t message_count(const Eval *ev)
{
    return ev->options.diags->error_count + ev->options.diags->warning_count;
}

static void watch(void *client, const GrammarLiteral *literal)
{
    Eval *ev = eval_of(client);
    ev->literal = (LiteralWatch){
        .is_watching = true,
        .state = ev->literal.state,
        .literal = *literal,
        .shapes = ev->scene->shape_count,
        .spheres = ev->scene->spheres.count,
        .messages = message_count(ev),
    };
}

bool object_is_plain_sphere(const Eval *ev, SchemaKind kind, const Blueprint *record)
{
    const ObjectPart *part = &record->part;
    const TextureBlueprint *texture = part->texture ? part->texture : ev->objects->defaults;
    return kind == KIND_SPHERE && transform_is_identity(&part->transform) &&
                           !part->is_inverse && !part->no_shadow && !part->no_image && !part->no_reflection &&
                           !part->interior && !part->clips && !part->bounds && texture->ior == 0.0;
}

void literal_note(Eval *ev, SchemaKind kind, const Blueprint *record)
{
    ev->literal.is_plain = object_is_plain_sphere(ev, kind, record);
}

// The colour that the text says is the colour that the sphere has.
static bool has_colour(const GrammarLiteral *literal, const Material *material)
{
    const float colour[] = {material->red, material->green, material->blue, material->filter, material->transmit};
    for (unsigned i = 0; i < literal->colours; i++) {
        if (colour[i] != (float)literal->colour[i]) {
            return false;
        }
    }
    return true;
}

static bool is_same(const Sphere *sphere, const GrammarLiteral *literal)
{
    const double *centre = literal->centre;
    return sphere->centre.x == centre[0] && sphere->centre.y == centre[1] && sphere->centre.z == centre[2] &&
           sphere->radius == literal->radius && sphere->source == literal->span.begin;
}

static bool learn(void *client, GrammarLiteralKind *kind)
{
    Eval *ev = eval_of(client);
    const LiteralWatch *watched = &ev->literal;
    const Scene *scene = ev->scene;
    bool is_plain = watched->is_watching && watched->is_plain && !ev->stop &&
                    message_count(ev) == watched->messages &&
                    scene->shape_count == watched->shapes + 1 && scene->spheres.count == watched->spheres + 1;
    ev->literal.is_watching = false;
    if (!is_plain) {
        return false;
    }
    const Sphere *sphere = &scene->spheres.items[watched->spheres];
    if ((sphere->material & MATERIAL_COMPOUND) || !is_same(sphere, &watched->literal)) {
        return false;
    }
    const Material *material = &scene->materials.items[sphere->material];
    *kind = (GrammarLiteralKind){
        material->finish, {material->red, material->green, material->blue, material->filter, material->transmit}};
    return has_colour(&watched->literal, material);
}

static LiteralResult take(void *client, const GrammarLiteral *literal, const GrammarLiteralKind *kind)
{
    Eval *ev = eval_of(client);
    float colour[5];
    memcpy(colour, kind->colour, sizeof colour);
    for (unsigned i = 0; i < literal->colours; i++) {
        if (!(fabs(literal->colour[i]) <= COLOUR_GREATEST)) {
            return LITERAL_LEFT;
        }
        colour[i] = (float)literal->colour[i];
    }
    // A zero is positive, as it is behind any transform.
    Vec3 centre = {literal->centre[0] + 0.0, literal->centre[1] + 0.0, literal->centre[2] + 0.0};
    Material material = {colour[0], colour[1], colour[2], colour[3], colour[4], kind->finish};
    ev->faulty = !sphere_place_plain(ev, centre, literal->radius, &material, literal->span) || ev->faulty;
    return eval_cancelled(ev) ? LITERAL_STOP : LITERAL_TAKEN;
}

void literal_hooks(Eval *ev, GrammarHooks *hooks)
{
    hooks->literal_state = &ev->literal.state;
    hooks->literal_watch = watch;
    hooks->literal_learn = learn;
    hooks->literal = ev->options.no_literals ? NULL : take;
}
