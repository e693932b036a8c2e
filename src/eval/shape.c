// Shapes: a blueprint's numbers and a transform become a fixed shape under an affine map (scene.h, PartKind).
//
// A shape that is the fixed one already, under a matrix, gets that matrix bit for bit, so that a scene dump reads back
// as the same records. Knows nothing of composites and textures.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/blocks.h"

// ---- closing braces; an identifier may have made it any object

bool plane_close(Block *block)
{
    if (block->is == KIND_PLANE && vec3_equal(block->record->plane.normal, vec3(0.0, 0.0, 0.0))) {
        return block_fault(block, DIAG_E0342, block->node->span, "the normal of a plane cannot be <0, 0, 0>");
    }
    return true;
}

bool cylinder_close(Block *block)
{
    CylinderBlueprint *cylinder = &block->record->cylinder;
    if (block->is != KIND_CYLINDER) {
        return true;
    }
    cylinder->radius = fabs(cylinder->radius);
    return !vec3_equal(cylinder->base, cylinder->cap) ||
           block_fault(block, DIAG_E0361, block->node->span, "the ends of a cylinder cannot be one point");
}

bool disc_close(Block *block)
{
    if (block->is == KIND_DISC) {
        block->record->disc.radius = fabs(block->record->disc.radius);
        block->record->disc.hole = fabs(block->record->disc.hole);
    }
    return true;
}

bool cone_close(Block *block)
{
    if (block->is == KIND_CONE && vec3_equal(block->record->cone.base, block->record->cone.cap)) {
        return block_fault(block, DIAG_E0361, block->node->span, "the ends of a cone cannot be one point");
    }
    return true;
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

// The tail of a form: a shape without extent is told of, and is nothing.
static ShapeResult formed(Eval *ev, Span span, const char *why_nothing)
{
    if (why_nothing) {
        eval_warn(ev, DIAG_W0348, span, "%s", why_nothing);
        return SHAPE_NOTHING;
    }
    return SHAPE_MADE;
}

static ShapeResult sphere_form(Eval *ev, const void *object, Part *part)
{
    const SphereBlueprint *sphere = object;
    return formed(ev, sphere->part.span, part_make_ball(part, sphere->centre, fabs(sphere->radius)));
}

static ShapeResult box_form(Eval *ev, const void *object, Part *part)
{
    const BoxBlueprint *box = object;
    part_make_box(part, box->corner, box->other_corner);
    return formed(ev, box->part.span, NULL);
}

static ShapeResult cylinder_form(Eval *ev, const void *object, Part *part)
{
    const CylinderBlueprint *c = object;
    return formed(ev, c->part.span, part_make_cylinder(part, c->base, c->cap, c->radius, c->is_open));
}

static ShapeResult cone_form(Eval *ev, const void *object, Part *part)
{
    const ConeBlueprint *c = object;
    return formed(ev, c->part.span, part_make_cone(part, c->base, c->base_radius, c->cap, c->cap_radius, c->is_open));
}

static ShapeResult disc_form(Eval *ev, const void *object, Part *part)
{
    const DiscBlueprint *disc = object;
    return formed(ev, disc->part.span, part_make_disc(part, disc->centre, disc->normal, disc->radius, disc->hole));
}

static ShapeResult triangle_form(Eval *ev, const void *object, Part *part)
{
    const TriangleBlueprint *triangle = object;
    return formed(ev, triangle->part.span, part_make_triangle(part, triangle->corners));
}

static ShapeResult smooth_triangle_form(Eval *ev, const void *object, Part *part)
{
    const SmoothTriangleBlueprint *triangle = object;
    return formed(ev, triangle->part.span, part_make_smooth_triangle(part, triangle->corners, triangle->normals));
}

typedef ShapeResult (*ShapeForm)(Eval *ev, const void *object, Part *part);

static const ShapeForm forms[KIND_COUNT] = {
    [KIND_SPHERE] = sphere_form,     [KIND_BOX] = box_form,
    [KIND_CYLINDER] = cylinder_form, [KIND_CONE] = cone_form,
    [KIND_DISC] = disc_form,         [KIND_TRIANGLE] = triangle_form,
    [KIND_SMOOTH_TRIANGLE] = smooth_triangle_form,
};

// ---- with the transforms

bool shape_flattened(Eval *ev, const ObjectPart *part)
{
    return eval_fault(ev, DIAG_E0345, part->span, "the transforms leave a flat or infinite shape");
}

// The image of n·p = d under p' = p M + t is n'·p' = d' with n' = M^-1 n (as a row vector n M^-T) and d' = d + n'·t.
static ShapeResult plane_make(Eval *ev, const PlaneBlueprint *plane, const Transform *transform, Part *part)
{
    Transform back;
    if (!transform_invert(transform, &back)) {
        shape_flattened(ev, &plane->part);
        return SHAPE_FAULT;
    }
    Vec3 normal = transform_normal(&back, vector_unit(plane->normal));
    Vec3 origin = vec3(transform->m[3][0], transform->m[3][1], transform->m[3][2]);
    double length = vector_length(normal);
    Vec3 unit = vector_unit(normal);
    // A length of 1 to rounding was left alone by vector_unit, so it does not divide the distance either.
    double distance = (vec3_equal(unit, normal) ? plane->distance : plane->distance / length) + vec3_dot(unit, origin);
    if (!vec3_is_finite(unit) || !isfinite(distance) || vec3_equal(unit, vec3(0.0, 0.0, 0.0))) {
        shape_flattened(ev, &plane->part);
        return SHAPE_FAULT;
    }
    part->kind = PART_PLANE;
    part->data[0] = unit;
    part->data[1] = vec3(distance, 0.0, 0.0);
    return SHAPE_MADE;
}

// A sphere that is still one has no turn, so that it is the same surface, bit for bit, as a plain sphere of this text.
static Transform sphere_to_world(const SphereBlueprint *sphere, const Transform *ball, const Transform *transform)
{
    double radius;
    if (!sphere_image_radius(fabs(sphere->radius), transform, &radius)) {
        return transform_compose(*ball, *transform);
    }
    return transform_compose(transform_scale(vec3(radius, radius, radius)),
                             transform_translate(transform_point(transform, sphere->centre)));
}

// What is left of a part when its to_world is known.
static ShapeResult shape_finish(Eval *ev, const ObjectPart *common, Part *part)
{
    if (!part_finish(part)) {
        shape_flattened(ev, common);
        return SHAPE_FAULT;
    }
    return SHAPE_MADE;
}

ShapeResult shape_make_stretched(Eval *ev, const SphereBlueprint *sphere, const Transform *transform, Part *part)
{
    *part = part_empty(sphere->part.span.begin);
    ShapeResult result = sphere_form(ev, sphere, part);
    if (result == SHAPE_MADE) {
        part->to_world = transform_compose(part->to_world, *transform);
        result = shape_finish(ev, &sphere->part, part);
    }
    return result;
}

ShapeResult shape_make(Eval *ev, SchemaKind kind, const void *object, const Transform *transform, Part *part)
{
    *part = part_empty(((const ObjectPart *)object)->span.begin);
    if (kind == KIND_PLANE) {
        return plane_make(ev, object, transform, part);
    }
    ShapeResult result = forms[kind](ev, object, part);
    if (result != SHAPE_MADE) {
        return result;
    }
    part->to_world = kind == KIND_BOX      ? *transform
                     : kind == KIND_SPHERE ? sphere_to_world(object, &part->to_world, transform)
                                           : transform_compose(part->to_world, *transform);
    return shape_finish(ev, object, part);
}
