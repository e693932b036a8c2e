// Shapes: a description's numbers and a transform become a fixed shape under an affine map (scene.h, PartKind).
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
    switch (kind) {
    case KIND_PLANE: return !vec3_equal(record->plane.normal, vec3(0.0, 0.0, 0.0));
    case KIND_CYLINDER:
        record->cylinder.radius = fabs(record->cylinder.radius);
        return !vec3_equal(record->cylinder.base, record->cylinder.cap);
    case KIND_CONE: return !vec3_equal(record->cone.base, record->cone.cap);
    case KIND_DISC:
        record->disc.radius = fabs(record->disc.radius);
        record->disc.hole = fabs(record->disc.hole);
        return true;
    default: return true;
    }
}

bool plane_close(Block *block)
{
    return block->is != KIND_PLANE || shape_settle(KIND_PLANE, block->record) ||
           block_fault(block, DIAG_E0342, block->node->span, "the normal of a plane cannot be <0, 0, 0>");
}

bool cylinder_close(Block *block)
{
    return block->is != KIND_CYLINDER || shape_settle(KIND_CYLINDER, block->record) ||
           block_fault(block, DIAG_E0361, block->node->span, "the ends of a cylinder cannot be one point");
}

bool disc_close(Block *block)
{
    return block->is != KIND_DISC || shape_settle(KIND_DISC, block->record);
}

bool cone_close(Block *block)
{
    return block->is != KIND_CONE || shape_settle(KIND_CONE, block->record) ||
           block_fault(block, DIAG_E0361, block->node->span, "the ends of a cone cannot be one point");
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

// Each returns why the shape has no extent; NULL: it has one.
static const char *sphere_form(const void *object, Part *part)
{
    const SphereDesc *sphere = object;
    return part_make_ball(part, sphere->centre, fabs(sphere->radius));
}

static const char *box_form(const void *object, Part *part)
{
    const BoxDesc *box = object;
    part_make_box(part, box->corner, box->other_corner);
    return NULL;
}

static const char *cylinder_form(const void *object, Part *part)
{
    const CylinderDesc *c = object;
    return part_make_cylinder(part, c->base, c->cap, c->radius, c->is_open);
}

static const char *cone_form(const void *object, Part *part)
{
    const ConeDesc *c = object;
    return part_make_cone(part, c->base, c->base_radius, c->cap, c->cap_radius, c->is_open);
}

static const char *disc_form(const void *object, Part *part)
{
    const DiscDesc *disc = object;
    return part_make_disc(part, disc->centre, disc->normal, disc->radius, disc->hole);
}

static const char *triangle_form(const void *object, Part *part)
{
    const TriangleDesc *triangle = object;
    return part_make_triangle(part, triangle->corners);
}

static const char *smooth_triangle_form(const void *object, Part *part)
{
    const SmoothTriangleDesc *triangle = object;
    return part_make_smooth_triangle(part, triangle->corners, triangle->normals);
}

typedef const char *(*ShapeForm)(const void *object, Part *part);

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
static ShapeResult plane_form(const PlaneDesc *plane, const Transform *transform, Part *part)
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
    part->kind = PART_PLANE;
    part->data[0] = unit;
    part->data[1] = vec3(distance, 0.0, 0.0);
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

ShapeResult shape_form(SchemaKind kind, const void *object, const Transform *transform, bool is_stretched, Part *part,
                       const char **why_nothing)
{
    *part = part_empty(((const ObjectPart *)object)->span.begin);
    if (kind == KIND_PLANE) {
        return plane_form(object, transform, part);
    }
    *why_nothing = forms[kind](object, part);
    if (*why_nothing) {
        return SHAPE_NOTHING;
    }
    bool is_sphere = kind == KIND_SPHERE && !is_stretched;
    part->to_world = kind == KIND_BOX ? *transform
                     : is_sphere      ? sphere_to_world(object, &part->to_world, transform)
                                      : transform_compose(part->to_world, *transform);
    return part_finish(part) ? SHAPE_MADE : SHAPE_FAULT;
}

ShapeResult shape_make(Eval *ev, SchemaKind kind, const void *object, const Transform *transform, bool is_stretched,
                       Part *part)
{
    const ObjectPart *common = object;
    const char *why_nothing;
    ShapeResult result = shape_form(kind, object, transform, is_stretched, part, &why_nothing);
    if (result == SHAPE_NOTHING) {
        eval_warn(ev, DIAG_W0348, common->span, "%s", why_nothing);
    } else if (result == SHAPE_FAULT) {
        shape_flattened(ev, common);
    }
    return result;
}
