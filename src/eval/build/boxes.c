// What the boxes that POV-Ray puts around objects decide, where it shows.
//
// A sphere of a negative radius has its box inside out, until a transform turns the corners of that box. No ray meets
// it, and nothing is in it. What cuts it with others does not look at its box, but a union or merge that is one object
// is seen in the box of its members, as they were when its block ended. And a ray starts inside of an object only where
// it starts in the object's box. No ray looks at boxes in a scene of few objects. Knows nothing of how shapes are placed.
//
// SPDX-License-Identifier: MIT
#include "eval/build/blocks.h"

// With fewer objects than these no ray looks at boxes.
enum { BOXES_FROM = 3 };

bool box_is_inside_out(SchemaKind kind, const void *object)
{
    return kind == KIND_SPHERE && ((const SphereDesc *)object)->radius < 0.0 && !extent_is_stretched(kind, object);
}

bool box_fault(Eval *ev, Span span)
{
    return eval_fault(ev, DIAG_E0366, span,
                      "a sphere of a negative radius is a member of a union or merge that is one object");
}

// Most transforms of a light turn the box of what it looks like.
bool box_fault_of_look(Eval *ev, Span span)
{
    return eval_fault(ev, DIAG_E0366, span, "a sphere of a negative radius is what a light looks like");
}

bool box_leave_out(Eval *ev, Span span)
{
    ev->inside_out = span;
    eval_warn(ev, DIAG_W0348, span,
              "a sphere of a negative radius is drawn only where it is stretched or cut with others");
    return true;
}

bool box_left_out_rightly(Eval *ev)
{
    uint64_t objects = ev->object_count + ev->scene->spheres.count - ev->slow_spheres;
    return ev->inside_out.end == 0 || objects >= BOXES_FROM ||
           eval_fault(ev, DIAG_E0366, ev->inside_out,
                      "a sphere of a negative radius in a scene of less than %d objects", BOXES_FROM);
}

// Of what fills a shape: from a primitive that its own interior is in, if there is one, else from any that is seen.
static void start_material(const Scene *scene, StartShape *start, size_t first_primitive)
{
    for (size_t i = first_primitive; i < scene->primitives.count && !start->is_filled; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        if (!(primitive->flags & PRIMITIVE_UNSEEN)) {
            start->material = primitive->material;
            start->is_filled = primitive->body == 0;
        }
    }
}

// Boxes are those of the scene as it is written, in whatever unit it is drawn.
static bool scaled_box(const Eval *ev, const BoxOwner *owner, StartShape *start)
{
    if (!ev->options.world) {
        return extent_box(owner, &start->low, &start->high);
    }
    Transform world = world_transform(ev);
    BoxOwner written = {owner->kind, owner->object, transform_compose(owner->outer, world_inverse(ev))};
    bool is_endless = extent_box(&written, &start->low, &start->high);
    start->low = transform_point(&world, start->low);
    start->high = transform_point(&world, start->high);
    return is_endless;
}

// Where a ray may start inside of the shape that was placed last, if that is not all of its inside.
bool box_note_start(Eval *ev, const BoxOwner *owner, size_t first_primitive)
{
    Scene *scene = ev->scene;
    size_t last = scene->composites.count - 1; // wraps where there is none
    StartShape start = {.order = scene->shape_count - 1};
    if (scene->primitives.count == first_primitive) {
        return true;
    }
    start.is_composite = scene->composites.count > 0 && scene->composites.items[last].order == start.order;
    start.index = (uint32_t)(start.is_composite ? last : scene->primitives.count - 1);
    start_material(scene, &start, first_primitive);
    start.is_endless = scaled_box(ev, owner, &start);
    return ARRAY_PUSH(&scene->start_shapes, start) || eval_no_memory(ev, ((const ObjectPart *)owner->object)->span);
}
