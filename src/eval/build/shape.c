// Shapes: a description's numbers and a transform become a fixed shape under an affine map (scene.h, PrimitiveKind).
//
// A shape that is the fixed one already, under a matrix, gets that matrix bit for bit, so that a scene dump reads back
// as the same records. Knows nothing of composites and textures.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"

// ---- closing braces; an identifier may have made it any object

bool shape_settle(SchemaKind kind, Desc *record)
{
    const ShapeClass *shape = shape_class(kind);
    return !shape->settle || shape->settle(record);
}

bool shape_close(Block *block)
{
    const ShapeClass *shape = shape_class(block->is);
    if (shape->close && block->is == block->kind) {
        return block->has_fault || shape->close(block);
    }
    return block->is != block->kind || shape_settle(block->is, block->record) ||
           block_fault(block, shape->code, block->node->span, "%s", shape->fault);
}

bool sphere_image_radius(double radius, const Transform *transform, double *image)
{
    double factor = 1.0;
    if (transform_is_identity(transform) || transform_is_similarity(transform, &factor)) {
        *image = radius * factor;
        return true;
    }
    Transform whole = transform_compose(transform_scale(vec3(radius, radius, radius)), *transform);
    return transform_is_similarity(&whole, image);
}

// ---- with the transforms

bool shape_flattened(Eval *ev, const ObjectPart *part)
{
    return eval_fault(ev, DIAG_E0345, part->span, "the transforms leave a flat or infinite shape");
}

// The image of n·p = d under p' = p M + t is n'·p' = d' with n' = M^-1 n (as a row vector n M^-T) and d' = d + n'·t.
static ShapeResult plane_form(const PlaneDesc *plane, const Transform *transform, Primitive *primitive)
{
    Transform back;
    if (!transform_invert(transform, &back)) {
        return SHAPE_FAULT;
    }
    Vec3 normal = transform_normal(&back, vector_unit(plane->normal));
    Vec3 origin = vec3(transform->m[3][0], transform->m[3][1], transform->m[3][2]);
    double length = vector_length(normal);
    Vec3 unit = vector_unit(normal);
    // A length of 1 to rounding was left alone by vector_unit, so it does not divide the distance either.
    double distance = (vec3_equal(unit, normal) ? plane->distance : plane->distance / length) + vec3_dot(unit, origin);
    if (!vec3_is_finite(unit) || !isfinite(distance) || vec3_equal(unit, vec3(0.0, 0.0, 0.0))) {
        return SHAPE_FAULT;
    }
    primitive->kind = PRIMITIVE_PLANE;
    primitive->data[0] = unit;
    primitive->data[1] = vec3(distance, 0.0, 0.0);
    return SHAPE_MADE;
}

// A sphere that is still one has no turn, so that it is the same surface, bit for bit, as a plain sphere of this text.
static Transform sphere_to_world(const SphereDesc *sphere, const Transform *ball, const Transform *transform)
{
    double radius;
    if (!sphere_image_radius(fabs(sphere->radius), transform, &radius)) {
        return transform_compose(*ball, *transform);
    }
    return transform_compose(transform_scale(vec3(radius, radius, radius)),
                             transform_translate(transform_point(transform, sphere->centre)));
}

ShapeResult shape_form(SchemaKind kind, const void *object, const Transform *transform, bool is_stretched,
                       Primitive *primitive, const char **why_nothing)
{
    *primitive = part_empty(((const ObjectPart *)object)->span.begin);
    if (kind == KIND_PLANE) {
        return plane_form(object, transform, primitive);
    }
    *why_nothing = shape_class(kind)->form(object, primitive);
    if (*why_nothing) {
        return SHAPE_NOTHING;
    }
    bool is_sphere = kind == KIND_SPHERE && !is_stretched;
    primitive->to_world = kind == KIND_BOX ? *transform
                          : is_sphere      ? sphere_to_world(object, &primitive->to_world, transform)
                                           : transform_compose(primitive->to_world, *transform);
    return part_finish(primitive) ? SHAPE_MADE : SHAPE_FAULT;
}

ShapeResult shape_make(Eval *ev, SchemaKind kind, const void *object, const Transform *transform, bool is_stretched,
                       Primitive *primitive)
{
    const ObjectPart *common = object;
    const char *why_nothing = "a bicubic_patch has no surface: all its triangles are lines";
    ShapeResult result = kind == KIND_BICUBIC_PATCH
                             ? bicubic_make(ev, object, transform, primitive)
                             : shape_form(kind, object, transform, is_stretched, primitive, &why_nothing);
    if (result == SHAPE_NOTHING) {
        eval_warn(ev, DIAG_W0348, common->span, "%s", why_nothing);
    } else if (result == SHAPE_FAULT && kind != KIND_BICUBIC_PATCH) {
        shape_flattened(ev, common);
    }
    return result;
}
