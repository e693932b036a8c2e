// Shapes: a blueprint's numbers and a transform become a fixed shape under an affine map (scene.h, PartKind).
//
// A shape that is the fixed one already, under a matrix, gets that matrix bit for bit, so that a scene dump reads back
// as the same records. Knows nothing of composites and textures.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

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

// ---- frames: the images of x, y, z and the origin

static void set_row(Transform *frame, int row, Vec3 image)
{
    frame->m[row][0] = image.x;
    frame->m[row][1] = image.y;
    frame->m[row][2] = image.z;
}

// Two unit vectors at right angles to the unit vector n and each other; x and y for z (Duff et al., "Building an
// Orthonormal Basis, Revisited", JCGT 6(1), 2017).
static void set_round(Transform *frame, Vec3 n, double radius)
{
    double sign = copysign(1.0, n.z);
    double a = -1.0 / (sign + n.z);
    double b = n.x * n.y * a;
    set_row(frame, 0, vec3_scale(radius, vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x)));
    set_row(frame, 1, vec3_scale(radius, vec3(b, sign + n.y * n.y * a, -n.y)));
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

static ShapeResult nothing(Eval *ev, Span span, const char *why)
{
    eval_warn(ev, DIAG_W0348, span, "%s", why);
    return SHAPE_NOTHING;
}

static ShapeResult sphere_form(Eval *ev, const void *object, Part *part)
{
    const SphereBlueprint *sphere = object;
    if (sphere->radius == 0.0) {
        return nothing(ev, sphere->part.span, "a sphere of radius 0 is not drawn");
    }
    Vec3 size = vec3(sphere->radius, sphere->radius, sphere->radius);
    part->kind = PART_BALL;
    part->to_world = transform_compose(transform_scale(size), transform_translate(sphere->centre));
    return SHAPE_MADE;
}

static ShapeResult box_form(Eval *ev, const void *object, Part *part)
{
    const BoxBlueprint *box = object;
    Vec3 a = box->corner, b = box->other_corner;
    (void)ev;
    part->kind = PART_BOX;
    part->data[0] = vec3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
    part->data[1] = vec3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
    return SHAPE_MADE;
}

static ShapeResult round_form(Part *part, Vec3 base, double base_radius, Vec3 cap, double cap_radius, bool is_open)
{
    bool turns = base_radius < cap_radius; // the greater end is the base
    Vec3 origin = turns ? cap : base;
    Vec3 axis = vec3_sub(turns ? base : cap, origin);
    double radius = turns ? cap_radius : base_radius;
    part->kind = PART_CONE;
    part->flags = is_open ? PART_OPEN : 0;
    part->data[0] = vec3((turns ? base_radius : cap_radius) / radius, 0.0, 0.0);
    set_round(&part->to_world, vector_unit(axis), radius);
    set_row(&part->to_world, 2, axis);
    set_row(&part->to_world, 3, origin);
    return SHAPE_MADE;
}

static ShapeResult cylinder_form(Eval *ev, const void *object, Part *part)
{
    const CylinderBlueprint *c = object;
    return c->radius == 0.0 ? nothing(ev, c->part.span, "a cylinder of radius 0 is not drawn")
                            : round_form(part, c->base, c->radius, c->cap, c->radius, c->is_open);
}

static ShapeResult cone_form(Eval *ev, const void *object, Part *part)
{
    const ConeBlueprint *c = object;
    return c->base_radius == 0.0 && c->cap_radius == 0.0
               ? nothing(ev, c->part.span, "a cone with both radii 0 is not drawn")
               : round_form(part, c->base, c->base_radius, c->cap, c->cap_radius, c->is_open);
}

static ShapeResult disc_form(Eval *ev, const void *object, Part *part)
{
    const DiscBlueprint *disc = object;
    if (disc->radius == 0.0 || disc->hole >= disc->radius || vec3_equal(disc->normal, vec3(0.0, 0.0, 0.0))) {
        return nothing(ev, disc->part.span, "a disc without a normal, or with a hole as large as itself, is not drawn");
    }
    Vec3 unit = vector_unit(disc->normal);
    part->kind = PART_DISC;
    part->data[0] = vec3(disc->hole / disc->radius, 0.0, 0.0);
    set_round(&part->to_world, unit, disc->radius);
    set_row(&part->to_world, 2, vec3_scale(disc->radius, unit));
    set_row(&part->to_world, 3, disc->centre);
    return SHAPE_MADE;
}

// The third row stands at right angles to the triangle, as long as the first.
static ShapeResult triangle_map(Eval *ev, const Vec3 corners[3], Span span, Part *part)
{
    Vec3 first = vec3_sub(corners[1], corners[0]), second = vec3_sub(corners[2], corners[0]);
    Vec3 normal = vec3_cross(vector_unit(first), vector_unit(second));
    set_row(&part->to_world, 0, first);
    set_row(&part->to_world, 1, second);
    set_row(&part->to_world, 2, vec3_scale(vector_length(first), vector_unit(normal)));
    set_row(&part->to_world, 3, corners[0]);
    Transform back;
    return transform_invert(&part->to_world, &back)
               ? SHAPE_MADE
               : nothing(ev, span, "a triangle with its corners on one line is not drawn");
}

static ShapeResult triangle_form(Eval *ev, const void *object, Part *part)
{
    const TriangleBlueprint *triangle = object;
    part->kind = PART_TRIANGLE;
    return triangle_map(ev, triangle->corners, triangle->part.span, part);
}

// A normal n of the shape is M n as the fixed shape sees it, M being the frame.
static ShapeResult smooth_triangle_form(Eval *ev, const void *object, Part *part)
{
    const SmoothTriangleBlueprint *triangle = object;
    part->kind = PART_SMOOTH_TRIANGLE;
    ShapeResult result = triangle_map(ev, triangle->corners, triangle->part.span, part);
    int sides = 0;
    for (int i = 0; i < 3 && result == SHAPE_MADE; i++) {
        double side = vec3_dot(triangle->normals[i], vec3(part->to_world.m[2][0], part->to_world.m[2][1],
                                                          part->to_world.m[2][2]));
        sides += (side > 0.0) - (side < 0.0);
        if (vec3_equal(triangle->normals[i], vec3(0.0, 0.0, 0.0))) {
            return nothing(ev, triangle->part.span, "a smooth triangle with a normal of 0 is not drawn");
        }
        part->data[i] = transform_normal(&part->to_world, triangle->normals[i]);
    }
    if (result == SHAPE_MADE && abs(sides) < 3) {
        return nothing(ev, triangle->part.span,
                       "a smooth triangle with a normal along it, or with normals on both sides, is not drawn");
    }
    return result;
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

// Adding 0 makes -0 a 0, so that a matrix that is written and read again is the same.
static void make_zeros_positive(Transform *transform)
{
    for (int row = 0; row < 4; row++) {
        for (int column = 0; column < 3; column++) {
            transform->m[row][column] += 0.0;
        }
    }
}

// The normals' lengths count where they are weighed against each other, in the scene itself. One that is 1 to 12 digits
// is left alone, so that it stays the same when a dump is read; no picture tells.
static void normalise_corners(Part *part)
{
    for (int i = 0; part->kind == PART_SMOOTH_TRIANGLE && i < 3; i++) {
        double length = vector_length(transform_normal(&part->to_object, part->data[i]));
        if (!(fabs(length - 1.0) < 1e-12)) {
            part->data[i] = vec3_scale(1.0 / length, part->data[i]);
        }
    }
}

// A sphere that is still one has no turn, so that it is the same surface, bit for bit, as a plain sphere of this text.
static Transform sphere_to_world(const SphereBlueprint *sphere, const Transform *ball, const Transform *transform)
{
    double radius;
    if (!sphere_image_radius(sphere->radius, transform, &radius)) {
        return transform_compose(*ball, *transform);
    }
    Transform round = transform_scale(vec3(radius, radius, radius));
    set_row(&round, 3, transform_point(transform, sphere->centre));
    return round;
}

static Part part_of(const ObjectPart *common)
{
    return (Part){
        .node = NODE_NONE,
        .source = common->span.begin,
        .to_world = transform_identity(),
        .to_object = transform_identity(),
    };
}

// What is left of a part when its to_world is known.
static ShapeResult part_finish(Eval *ev, const ObjectPart *common, Part *part)
{
    make_zeros_positive(&part->to_world);
    if (!transform_is_finite(&part->to_world) || !transform_invert(&part->to_world, &part->to_object)) {
        shape_flattened(ev, common);
        return SHAPE_FAULT;
    }
    normalise_corners(part);
    return SHAPE_MADE;
}

ShapeResult shape_make_stretched(Eval *ev, const SphereBlueprint *sphere, const Transform *transform, Part *part)
{
    *part = part_of(&sphere->part);
    ShapeResult result = sphere_form(ev, sphere, part);
    if (result == SHAPE_MADE) {
        part->to_world = transform_compose(part->to_world, *transform);
        result = part_finish(ev, &sphere->part, part);
    }
    return result;
}

ShapeResult shape_make(Eval *ev, SchemaKind kind, const void *object, const Transform *transform, Part *part)
{
    *part = part_of(object);
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
    return part_finish(ev, object, part);
}
