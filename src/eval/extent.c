// The boxes that min_extent and max_extent tell of.
//
// A box is POV-Ray's, as measured: a corner and lengths in single precision. A sphere that was only moved, turned and
// scaled evenly has its own box; any other transform turns the corners of the box that it had before. A union's box is
// that of its members, and each transform of the union turns that box again. Knows nothing of what is drawn.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/blocks.h"

typedef struct Extent {
    float corner[3], lengths[3];
} Extent;

// Half the side of a box without bounds, and the length from which a union is without bounds.
static const double boundless = 1e10, union_length_max = 1e6;

static Extent extent_of(const double least[3], const double greatest[3])
{
    Extent extent;
    for (unsigned i = 0; i < 3; i++) {
        extent.corner[i] = (float)least[i];
        extent.lengths[i] = (float)(greatest[i] - least[i]);
    }
    return extent;
}

static Extent extent_boundless(void)
{
    return extent_of((double[]){-boundless, -boundless, -boundless}, (double[]){boundless, boundless, boundless});
}

static double upper(const Extent *extent, unsigned i)
{
    return (double)extent->corner[i] + (double)extent->lengths[i];
}

static Extent turned(const Extent *extent, const Transform *transform)
{
    double least[3] = {boundless, boundless, boundless}, greatest[3] = {-boundless, -boundless, -boundless};
    for (unsigned corner = 0; corner < 8; corner++) {
        Vec3 point = vec3(corner & 1 ? upper(extent, 0) : extent->corner[0],
                          corner & 2 ? upper(extent, 1) : extent->corner[1],
                          corner & 4 ? upper(extent, 2) : extent->corner[2]);
        Vec3 image = transform_point(transform, point);
        const double v[3] = {image.x, image.y, image.z};
        for (unsigned i = 0; i < 3; i++) {
            least[i] = fmax(fmin(least[i], v[i]), -boundless);
            greatest[i] = fmin(fmax(greatest[i], v[i]), boundless);
        }
    }
    return extent_of(least, greatest);
}

static bool is_boundless(const Extent *extent)
{
    return extent->lengths[0] >= 2.0 * boundless && extent->lengths[1] >= 2.0 * boundless;
}

static Extent sphere_extent(const SphereBlueprint *sphere)
{
    const Transform *own = sphere->rigid != NULL ? sphere->rigid : &sphere->part.transform;
    Vec3 centre = transform_point(own, sphere->centre);
    double factor = vec3_length(vec3(own->m[0][0], own->m[0][1], own->m[0][2]));
    double radius = sphere->radius * factor;
    Extent extent = extent_of((double[]){centre.x - radius, centre.y - radius, centre.z - radius},
                              (double[]){centre.x + radius, centre.y + radius, centre.z + radius});
    for (unsigned i = 0; i < 3; i++) {
        extent.lengths[i] = (float)(2.0 * radius);
    }
    Transform inverse;
    if (sphere->rigid == NULL || !transform_invert(sphere->rigid, &inverse)) {
        return extent;
    }
    Transform rest = transform_compose(inverse, sphere->part.transform);
    return turned(&extent, &rest);
}

static Extent object_extent(SchemaKind kind, const void *object);

static Extent members_extent(const UnionBlueprint *group)
{
    double least[3] = {INFINITY, INFINITY, INFINITY}, greatest[3] = {-INFINITY, -INFINITY, -INFINITY};
    bool is_long = group->members == NULL;
    for (const UnionMember *member = group->members; member != NULL; member = member->next) {
        Extent extent = object_extent(member->kind, member->object);
        for (unsigned i = 0; i < 3; i++) {
            least[i] = fmin(least[i], extent.corner[i]);
            greatest[i] = fmax(greatest[i], upper(&extent, i));
            is_long = is_long || greatest[i] - least[i] > union_length_max;
        }
    }
    return is_long ? extent_boundless() : extent_of(least, greatest);
}

// The steps are linked newest first; a scene has few on one union.
static Extent stepped(const UnionBlueprint *group, const UnionStep *step)
{
    if (step == NULL) {
        return members_extent(group);
    }
    Extent before = stepped(group, step->earlier);
    return is_boundless(&before) ? before : turned(&before, &step->transform);
}

// Recursive: object_members keeps trees from growing deeper than the limit.
static Extent object_extent(SchemaKind kind, const void *object)
{
    switch (kind) {
    case KIND_SPHERE: return sphere_extent(object);
    case KIND_UNION: return stepped(object, ((const UnionBlueprint *)object)->steps);
    default: return extent_boundless();
    }
}

// POV-Ray's boxes of other shapes, and of what is clipped, are not known.
static bool has_known_extent(SchemaKind kind, const void *object)
{
    const ObjectPart *part = object;
    if (kind == KIND_LIGHT_SOURCE || kind == KIND_PLANE) {
        return true;
    }
    if ((kind != KIND_SPHERE && kind != KIND_UNION) || part->clips || part->bounds || part->is_inverse) {
        return false;
    }
    const UnionMember *member = kind == KIND_UNION ? ((const UnionBlueprint *)object)->members : NULL;
    while (member && has_known_extent(member->kind, member->object)) {
        member = member->next;
    }
    return !member;
}

bool builtin_extent(Eval *ev, const AstNode *node, Value *value)
{
    Value object;
    const AstNode *name = node->a;
    if (!block_is_name(name)) {
        return eval_fault(ev, DIAG_E0264, name->span, "`%s` needs the name of an object", eval_text(ev, node->symbol));
    }
    if (!eval_expression(ev, name, &object)) {
        return false;
    }
    if (object.kind == VALUE_BLOCK && object.block == KIND_UNSUPPORTED) {
        block_unsupported_name(ev, object.record, name->span);
        return false;
    }
    if (object.kind != VALUE_BLOCK || !schema_kind((SchemaKind)object.block)->is_object) {
        return eval_fault(ev, DIAG_E0264, name->span, "expected the name of an object, found %s",
                          value_describe(&object));
    }
    if (!has_known_extent((SchemaKind)object.block, object.record)) {
        return eval_fault(ev, DIAG_E0285, name->span,
                          "the extent of objects other than spheres, planes and their unions is not supported");
    }
    Extent extent = object_extent((SchemaKind)object.block, object.record);
    *value = (Value){.kind = VALUE_VECTOR, .components = 3};
    for (unsigned i = 0; i < 3; i++) {
        value->v[i] = node->symbol == W_min_extent ? extent.corner[i] : (float)upper(&extent, i);
    }
    return true;
}

// ---- what the boxes need of transforms

static bool note_sphere(Block *block)
{
    SphereBlueprint *sphere = &block->record->sphere;
    if (sphere->rigid == NULL) {
        sphere->rigid = arena_copy(block->arena, &sphere->part.transform, sizeof sphere->part.transform);
    }
    return sphere->rigid != NULL;
}

static bool note_union(Block *block, const Transform *transform)
{
    UnionStep *step = arena_alloc(block->arena, sizeof *step);
    if (step != NULL) {
        *step = (UnionStep){.transform = *transform, .earlier = block->record->group.steps};
        block->record->group.steps = step;
    }
    return step != NULL;
}

bool extent_note(Block *block, const Transform *transform, bool keeps_spheres, Span span)
{
    bool fine = block->is == KIND_UNION                      ? note_union(block, transform)
                : block->is == KIND_SPHERE && !keeps_spheres ? note_sphere(block)
                                                             : true;
    return fine || eval_no_memory(block->ev, span);
}
