// The boxes that min_extent and max_extent tell of.
//
// A box is POV-Ray's, as measured: a corner and lengths in single precision. A sphere that was only moved, turned and
// scaled evenly has its own box; of any other shape, or after any other transform, the corners of a box in the shape's
// own space are turned. The box of a union or intersection is made of those of its members, and each transform of it
// turns that box again; that of a text is the one of its letters side by side. What clips or bounds an object gives its
// box instead where that is smaller. Knows nothing of what is drawn.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"

typedef struct Extent {
    float corner[3], lengths[3];
} Extent;

// Half the side of a box without bounds, and the length from which a union or intersection is without bounds.
static const double boundless = 1e10, group_length_max = 1e6;

// How near to an axis the normal of a plane in an intersection counts as along it; 1e-12 does and 1e-9 does not.
static const double plane_axis_slack = 1e-10;

// How near to z an axis counts as z, by its cosine; 6e-11 does and 2e-10 does not.
static const double frame_axis_slack = 1e-10;

// How far the box of a triangle stands off it.
static const double triangle_distance = 1e-10;

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
        Vec3 point =
            vec3(corner & 1 ? upper(extent, 0) : extent->corner[0], corner & 2 ? upper(extent, 1) : extent->corner[1],
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

static Extent sphere_extent(const SphereDesc *sphere)
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

// ---- shapes with a space of their own

// The turn that takes z to `axis` by the shortest way, half a turn about x where that is not unique; then to `origin`.
Transform extent_frame(Vec3 axis, double across, double along, Vec3 origin)
{
    Vec3 w = vec3_normalize(axis);
    Vec3 u = vec3(1.0, 0.0, 0.0), v = vec3(0.0, 1.0, 0.0);
    if (1.0 - fabs(w.z) < frame_axis_slack) {
        w = vec3(0.0, 0.0, copysign(1.0, w.z));
        v.y = w.z;
    } else {
        double turn = 1.0 / (1.0 + w.z);
        u = vec3(1.0 - w.x * w.x * turn, -w.x * w.y * turn, -w.x);
        v = vec3(u.y, 1.0 - w.y * w.y * turn, -w.y);
    }
    u = vec3_scale(across, u);
    v = vec3_scale(across, v);
    w = vec3_scale(along, w);
    return (Transform){{{u.x, u.y, u.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}, {origin.x, origin.y, origin.z}}};
}

static Extent turned_from(const Extent *own, Transform frame, const Transform *transform)
{
    Transform whole = transform_compose(frame, *transform);
    return turned(own, &whole);
}

static Extent corners_extent(const Vec3 corners[3], const Transform *transform)
{
    Vec3 low = transform_point(transform, corners[0]), high = low;
    for (int i = 1; i < 3; i++) {
        Vec3 corner = transform_point(transform, corners[i]);
        low = vec3_least(low, corner);
        high = vec3_greatest(high, corner);
    }
    const double off = triangle_distance;
    return extent_of((double[]){low.x - off, low.y - off, low.z - off},
                     (double[]){high.x + off, high.y + off, high.z + off});
}

static Extent corners_of(const OwnBox *box)
{
    return extent_of((double[]){box->low.x, box->low.y, box->low.z},
                     (double[]){box->high.x, box->high.y, box->high.z});
}

// By all transforms of the shape at once.
static Extent shape_extent(SchemaKind kind, const void *object, const Transform *transform)
{
    const ShapeClass *shape = shape_class(kind);
    if (shape->corners_at) {
        return corners_extent((const Vec3 *)(const void *)((const char *)object + shape->corners_at), transform);
    }
    OwnBox box;
    bool has_frame = shape->box(object, &box);
    if (isinf(box.high.x)) {
        return extent_boundless();
    }
    Extent own = corners_of(&box);
    return has_frame ? turned_from(&own, box.frame, transform) : turned(&own, transform);
}

// Whether it has an extent by the table.
static bool has_extent(SchemaKind kind)
{
    return shape_class(kind)->corners_at || shape_class(kind)->box;
}

// ---- groups

static Extent object_extent(SchemaKind kind, const void *object);

static bool is_long(const double least[3], const double greatest[3])
{
    bool is = false;
    for (unsigned i = 0; i < 3; i++) {
        is = is || !(greatest[i] - least[i] <= group_length_max && greatest[i] >= least[i]);
    }
    return is;
}

static Extent members_extent(const UnionDesc *group)
{
    double least[3] = {INFINITY, INFINITY, INFINITY}, greatest[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (const UnionMember *member = group->members; member != NULL; member = member->next) {
        Extent extent = object_extent(member->kind, member->object);
        for (unsigned i = 0; i < 3; i++) {
            least[i] = fmin(least[i], extent.corner[i]);
            greatest[i] = fmax(greatest[i], upper(&extent, i));
        }
    }
    return is_long(least, greatest) ? extent_boundless() : extent_of(least, greatest);
}

// A plane along an axis bounds an intersection on one side.
static void plane_narrows(const PlaneDesc *plane, bool is_inverse, double least[3], double greatest[3])
{
    Transform inverse;
    if (!transform_invert(&plane->part.transform, &inverse)) {
        return;
    }
    Vec3 normal = transform_normal(&inverse, vec3_normalize(plane->normal));
    Vec3 point = transform_point(&plane->part.transform, vec3_scale(plane->distance, vec3_normalize(plane->normal)));
    normal = vec3_scale(is_inverse ? -1.0 : 1.0, vec3_normalize(normal));
    const double n[3] = {normal.x, normal.y, normal.z}, p[3] = {point.x, point.y, point.z};
    for (unsigned i = 0; i < 3; i++) {
        if (n[i] > 1.0 - plane_axis_slack && fabs(n[(i + 1) % 3]) + fabs(n[(i + 2) % 3]) < plane_axis_slack) {
            greatest[i] = fmin(greatest[i], p[i]);
        } else if (-n[i] > 1.0 - plane_axis_slack && fabs(n[(i + 1) % 3]) + fabs(n[(i + 2) % 3]) < plane_axis_slack) {
            least[i] = fmax(least[i], p[i]);
        }
    }
}

// Members that are inside out bound nothing, and so do those that a difference takes away.
static Extent common_extent(const UnionDesc *group, bool is_difference)
{
    double least[3] = {-boundless, -boundless, -boundless}, greatest[3] = {boundless, boundless, boundless};
    for (const UnionMember *member = group->members; member != NULL; member = member->next) {
        bool is_inverse =
            ((const ObjectPart *)member->object)->is_inverse != (is_difference && member != group->members);
        if (member->kind == KIND_PLANE) {
            plane_narrows(member->object, is_inverse, least, greatest);
        } else if (!is_inverse) {
            Extent extent = object_extent(member->kind, member->object);
            for (unsigned i = 0; i < 3; i++) {
                least[i] = fmax(least[i], extent.corner[i]);
                greatest[i] = fmin(greatest[i], upper(&extent, i));
            }
        }
    }
    return is_long(least, greatest) ? extent_boundless() : extent_of(least, greatest);
}

// The steps are linked newest first; a scene has few on one union.
static Extent stepped(SchemaKind kind, const UnionDesc *group, const UnionStep *step)
{
    if (step == NULL && group->box != NULL) {
        Extent own = corners_of(group->box);
        return turned(&own, &group->box->frame);
    }
    if (step == NULL) {
        return kind == KIND_UNION || kind == KIND_MERGE ? members_extent(group)
                                                        : common_extent(group, kind == KIND_DIFFERENCE);
    }
    Extent before = stepped(kind, group, step->earlier);
    return is_boundless(&before) ? before : turned(&before, &step->transform);
}

// ---- what clips and bounds

static double volume(const Extent *extent)
{
    return (double)extent->lengths[0] * (double)extent->lengths[1] * (double)extent->lengths[2];
}

// Of an object of clipped_by or bounded_by, which was moved after it was complete.
static Extent moved_extent(const Clip *clip)
{
    const ObjectPart *part = clip->object;
    Transform whole = transform_compose(part->transform, clip->transform);
    double factor;
    if (has_extent(clip->kind)) {
        return shape_extent(clip->kind, clip->object, &whole);
    }
    if (clip->kind == KIND_SPHERE) {
        SphereDesc sphere = *(const SphereDesc *)clip->object;
        const Transform before = sphere.part.transform;
        sphere.part.transform = whole;
        if (sphere.rigid == NULL && !transform_is_similarity(&clip->transform, &factor)) {
            sphere.rigid = &before;
        }
        return sphere_extent(&sphere);
    }
    Extent own = object_extent(clip->kind, clip->object);
    return is_boundless(&own) ? own : turned(&own, &clip->transform);
}

// The box of what clips, where it is smaller.
static void narrow(Extent *extent, const Clip *clips)
{
    double least[3] = {-boundless, -boundless, -boundless}, greatest[3] = {boundless, boundless, boundless};
    for (const Clip *clip = clips; clip != NULL; clip = clip->next) {
        Extent own = ((const ObjectPart *)clip->object)->is_inverse ? extent_boundless() : moved_extent(clip);
        for (unsigned i = 0; i < 3; i++) {
            least[i] = fmax(least[i], own.corner[i]);
            greatest[i] = fmin(greatest[i], upper(&own, i));
        }
    }
    Extent common = extent_of(least, greatest);
    if (clips != NULL && volume(&common) < volume(extent)) {
        *extent = common;
    }
}

// Recursive: object_members keeps trees from growing deeper than the limit.
static Extent object_extent(SchemaKind kind, const void *object)
{
    const ObjectPart *part = object;
    Extent extent = kind == KIND_LIGHT_SOURCE || kind == KIND_PLANE ? extent_boundless()
                    : kind == KIND_SPHERE                           ? sphere_extent(object)
                    : has_extent(kind)                              ? shape_extent(kind, object, &part->transform)
                                       : stepped(kind, object, ((const UnionDesc *)object)->steps);
    narrow(&extent, part->clips);
    narrow(&extent, part->bounds);
    return extent;
}

static bool is_endless(SchemaKind kind, const void *object)
{
    OwnBox box = {.high = {0.0, 0.0, 0.0}};
    bool has_box = shape_class(kind)->box != NULL;
    if (has_box) {
        (void)shape_class(kind)->box(object, &box);
    }
    return kind == KIND_PLANE || isinf(box.high.x);
}

bool extent_reaches_out(SchemaKind kind, const void *object, bool is_member)
{
    const ObjectPart *part = object;
    if (kind == KIND_LIGHT_SOURCE) {
        return false;
    }
    // A member that has no end may leave the whole without one.
    // What cuts a union leaves the surfaces that its members have in one another, but one surface of the cut for all.
    bool does = kind == KIND_DISC || kind == KIND_UNION || kind == KIND_MESH || kind == KIND_MESH2 ||
                kind == KIND_HEIGHT_FIELD || kind == KIND_BICUBIC_PATCH || part->clips || part->is_inverse ||
                (is_member && is_endless(kind, object));
    const UnionMember *member = object_is_group(kind) ? ((const UnionDesc *)object)->members : NULL;
    for (; member && !does; member = member->next) {
        does = extent_reaches_out(member->kind, member->object, true);
    }
    return does;
}

bool extent_box(const BoxOwner *owner, Vec3 *low, Vec3 *high)
{
    const ObjectPart *part = owner->object;
    Clip placed = {.object = owner->object, .kind = owner->kind, .transform = owner->outer};
    bool is_plain = owner->kind != KIND_PLANE && !part->clips && !part->bounds && !transform_is_identity(&owner->outer);
    Extent extent = is_plain ? moved_extent(&placed) : object_extent(owner->kind, owner->object);
    extent = is_plain || is_boundless(&extent) ? extent : turned(&extent, &owner->outer);
    *low = vec3(extent.corner[0], extent.corner[1], extent.corner[2]);
    *high = vec3(upper(&extent, 0), upper(&extent, 1), upper(&extent, 2));
    return is_boundless(&extent);
}

bool extent_object(Eval *ev, const AstNode *node, Value *object)
{
    const AstNode *name = node->a;
    if (!block_is_name(name)) {
        return eval_fault(ev, DIAG_E0264, name->span, "`%s` needs the name of an object", eval_text(ev, node->symbol));
    }
    if (!eval_expression(ev, name, object)) {
        return false;
    }
    if (object->kind == VALUE_BLOCK && object->block == KIND_UNSUPPORTED) {
        block_unsupported_name(ev, object->record, name->span);
        return false;
    }
    return (object->kind == VALUE_BLOCK && schema_kind((SchemaKind)object->block)->is_object) ||
           eval_fault(ev, DIAG_E0264, name->span, "expected the name of an object, found %s", value_describe(object));
}

bool builtin_extent(Eval *ev, const AstNode *node, Value *value)
{
    Value object;
    if (!extent_object(ev, node, &object)) {
        return false;
    }
    Extent extent = object_extent((SchemaKind)object.block, object.record);
    *value = (Value){.kind = VALUE_VECTOR, .components = 3};
    for (unsigned i = 0; i < 3; i++) {
        value->v[i] = node->symbol == W_min_extent ? extent.corner[i] : (float)upper(&extent, i);
    }
    return true;
}

// ---- what the boxes need of transforms

bool extent_is_stretched(SchemaKind kind, const void *object)
{
    const UnionStep *step = object_is_group(kind) ? ((const UnionDesc *)object)->steps : NULL;
    while (step && step->keeps_spheres) {
        step = step->earlier;
    }
    return step || (kind == KIND_SPHERE && ((const SphereDesc *)object)->rigid);
}

static bool note_sphere(Block *block)
{
    SphereDesc *sphere = &block->record->sphere;
    if (sphere->rigid == NULL) {
        sphere->rigid = arena_copy(block->arena, &sphere->part.transform, sizeof sphere->part.transform);
    }
    return sphere->rigid != NULL;
}

static bool note_union(Block *block, const Transform *transform, bool keeps_spheres)
{
    UnionStep *step = arena_alloc(block->arena, sizeof *step);
    if (step != NULL) {
        *step = (UnionStep){*transform, keeps_spheres, block->record->group.steps};
        block->record->group.steps = step;
    }
    return step != NULL;
}

bool extent_note(Block *block, const Transform *transform, bool keeps_spheres, Span span)
{
    bool fine = object_is_group(block->is)                   ? note_union(block, transform, keeps_spheres)
                : block->is == KIND_SPHERE && !keeps_spheres ? note_sphere(block)
                                                             : true;
    return fine || eval_no_memory(block->ev, span);
}
