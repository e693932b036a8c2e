// trace and inside: what a ray or a point finds of a declared object.
//
// Turns an object into its shapes, which the tracer holds (EvalTracer), and keeps that for the next time. As POV-Ray
// does it, all surfaces of the shapes are met one after the other, and the first one counts that the groups and clips
// around its shape leave there. Knows nothing of materials.
//
// SPDX-License-Identifier: MIT
#include "eval/build/probe.h"

#include <math.h>

#include "eval/build/blocks.h"

// Surfaces nearer than this are not met, of whatever shape and size. Measured.
static const double nearest_hit = 1e-4;

// An object on the way from the one that is traced to a shape.
typedef struct ProbeNode ProbeNode;
struct ProbeNode {
    const ProbeNode *around;   // NULL: it is the one that is traced
    const UnionMember *member; // of that
    const void *object;
    SchemaKind kind;
    bool is_turned;  // inside out, with all around it
    bool was_turned; // if only to be turned back
    bool is_moved, is_stretched;
    Transform to_outer; // from the world to the space that the object's own transform leads to
};

struct Probe {
    void *geometry;
    Scene shapes; // parts only, in the order of `leaves`
    ARRAY(const ProbeNode *) leaves;
};

// ---- points

static bool shape_holds(SchemaKind kind, const void *object, Vec3 p, bool is_turned)
{
    const ShapeClass *shape = shape_class(kind);
    return shape->holds && shape->holds(object, p, is_turned);
}

static bool holds(SchemaKind kind, const void *object, Vec3 point, bool is_turned);

static bool clips_hold(const Clip *clip, Vec3 point)
{
    for (; clip != NULL; clip = clip->next) {
        Transform back;
        if (!transform_invert(&clip->transform, &back) ||
            !holds(clip->kind, clip->object, transform_point(&back, point), false)) {
            return false;
        }
    }
    return true;
}

static bool group_holds(SchemaKind kind, const UnionDesc *group, Vec3 point, bool is_turned)
{
    bool needs_all = (kind == KIND_INTERSECTION || kind == KIND_DIFFERENCE) != is_turned;
    for (const UnionMember *member = group->members; member != NULL; member = member->next) {
        bool is_taken_away = kind == KIND_DIFFERENCE && member != group->members;
        if (member->kind != KIND_LIGHT_SOURCE &&
            holds(member->kind, member->object, point, is_turned != is_taken_away) != needs_all) {
            return !needs_all;
        }
    }
    return needs_all;
}

// Whether a point is inside of an object, or, `is_turned`, of the object turned inside out; its clips stay as they are.
static bool holds(SchemaKind kind, const void *object, Vec3 point, bool is_turned)
{
    const ObjectPart *part = object;
    Transform back;
    if (!clips_hold(part->clips, point) || !transform_invert(&part->transform, &back)) {
        return false;
    }
    Vec3 own = transform_point(&back, point);
    is_turned = is_turned != part->is_inverse;
    return object_is_group(kind) ? group_holds(kind, object, own, is_turned)
                                 : shape_holds(kind, object, own, is_turned);
}

static bool is_solid(SchemaKind kind, const void *object)
{
    const UnionMember *member = object_is_group(kind) ? ((const UnionDesc *)object)->members : NULL;
    const ShapeClass *shape = shape_class(kind);
    bool is_none = !object_is_group(kind) && (!shape->holds || (shape->has_inside && !shape->has_inside(object)));
    for (; member != NULL && !is_none; member = member->next) {
        is_none = !is_solid(member->kind, member->object);
    }
    return !is_none;
}

bool builtin_inside(Eval *ev, const AstNode *node, Value *value)
{
    Value object;
    Vec3 point;
    if (!extent_object(ev, node, &object) || !eval_vector3(ev, node->a->next, &point)) {
        return false;
    }
    if (!is_solid((SchemaKind)object.block, object.record)) {
        return eval_fault(ev, DIAG_E0264, node->a->span, "`inside` needs an object without triangles and lights");
    }
    *value = value_of_number(holds((SchemaKind)object.block, object.record, point, false) ? 1.0 : 0.0);
    return true;
}

// ---- rays

static bool add_leaf(Eval *ev, Probe *probe, const ProbeNode *node, const Transform *inner)
{
    Primitive primitive;
    switch (shape_make(ev, node->kind, node->object, inner, false, &primitive)) {
    case SHAPE_NOTHING: return true;
    case SHAPE_FAULT: return false;
    case SHAPE_MADE: break;
    }
    bool is_kept = scene_add_primitive(&probe->shapes, &primitive) && ARRAY_PUSH(&probe->leaves, node);
    return is_kept || eval_no_memory(ev, ((const ObjectPart *)node->object)->span);
}

static const UnionMember *members_of(const ProbeNode *group)
{
    return ((const UnionDesc *)group->object)->members;
}

static bool is_taken_away(const ProbeNode *group, const UnionMember *member)
{
    return group != NULL && group->kind == KIND_DIFFERENCE && member != members_of(group);
}

// The object of `own`, of which kind, object, member and what is around are set. Recursive: object_members keeps trees
// from growing deeper than the limit.
static bool add_object(Eval *ev, Probe *probe, ProbeNode own, const Transform *outer)
{
    const ObjectPart *part = own.object;
    const ProbeNode *around = own.around;
    if (own.kind == KIND_LIGHT_SOURCE) {
        return true;
    }
    ProbeNode *node = arena_alloc(&ev->program, sizeof *node);
    if (node == NULL) {
        return eval_no_memory(ev, part->span);
    }
    *node = own;
    bool is_taken = is_taken_away(around, own.member);
    node->is_turned = (around != NULL && around->is_turned) != (part->is_inverse != is_taken);
    node->was_turned = (around != NULL && around->was_turned) || part->was_turned || is_taken;
    if (!transform_invert(outer, &node->to_outer)) {
        return shape_flattened(ev, part);
    }
    Transform inner = transform_compose(part->transform, *outer);
    node->is_moved = !transform_is_identity(&inner);
    node->is_stretched = (around != NULL && around->is_stretched) || extent_is_stretched(own.kind, own.object);
    if (!object_is_group(own.kind)) {
        return add_leaf(ev, probe, node, &inner);
    }
    for (const UnionMember *each = members_of(node); each != NULL; each = each->next) {
        const ProbeNode inside = {.around = node, .member = each, .object = each->object, .kind = each->kind};
        if (!add_object(ev, probe, inside, &inner)) {
            return false;
        }
    }
    return true;
}

// Whether a group leaves the surface of a member at a point. One that is turned inside out is what its members are that
// are turned so, all of them where it was any; and a union that once was has lost what is inside of it. Measured.
static bool group_leaves(const ProbeNode *group, const UnionMember *member, Vec3 point)
{
    bool is_cut = (group->kind == KIND_INTERSECTION || group->kind == KIND_DIFFERENCE) != group->is_turned;
    if (group->kind == KIND_UNION && !group->was_turned) {
        return true;
    }
    for (const UnionMember *other = members_of(group); other != NULL; other = other->next) {
        bool is_turned = group->is_turned != is_taken_away(group, other);
        bool is_asked = other != member && other->kind != KIND_LIGHT_SOURCE;
        if (is_asked && holds(other->kind, other->object, point, is_turned) != is_cut) {
            return false;
        }
    }
    return true;
}

// Whether all that is around a shape leaves its surface at a point.
static bool is_left(const ProbeNode *node, Vec3 point)
{
    for (; node != NULL; node = node->around) {
        Vec3 p = transform_point(&node->to_outer, point);
        if (!clips_hold(((const ObjectPart *)node->object)->clips, p) ||
            (node->around != NULL && !group_leaves(node->around, node->member, p))) {
            return false;
        }
    }
    return true;
}

static Probe *find_probe(Eval *ev, const Value *object, Span span)
{
    const char *key = (const char *)&object->record;
    ev->probed = ev->probed != NULL ? ev->probed : intern_new(SIZE_MAX);
    Symbol number = ev->probed != NULL ? intern_find(ev->probed, key, sizeof object->record) : SYMBOL_NONE;
    Probe *probe;
    if (number != SYMBOL_NONE) {
        probe = ev->probes.items[number - 1];
        return probe->geometry != NULL ? probe : NULL; // what is wrong has been reported
    }
    probe = arena_alloc(&ev->program, sizeof *probe);
    if (probe == NULL || ev->probed == NULL || !ARRAY_RESERVE(&ev->probes, ev->probes.count + 1) ||
        intern_text(ev->probed, key, sizeof object->record) == SYMBOL_NONE) {
        eval_no_memory(ev, span);
        return NULL;
    }
    *probe = (Probe){0};
    ev->probes.items[ev->probes.count++] = probe;
    scene_init(&probe->shapes);
    Transform world = transform_identity();
    const ProbeNode whole = {.object = object->record, .kind = (SchemaKind)object->block};
    if (!add_object(ev, probe, whole, &world)) {
        return NULL;
    }
    probe->geometry = ev->options.tracer->open(&probe->shapes);
    if (probe->geometry == NULL) {
        eval_no_memory(ev, span);
        return NULL;
    }
    ev->opened_bytes += OPENED_BYTES + scene_bytes(&probe->shapes) + ev->options.tracer->bytes(probe->geometry);
    return memory_suffices(ev, span) ? probe : NULL;
}

void probes_fini(Eval *ev)
{
    for (size_t i = 0; i < ev->probes.count; i++) {
        Probe *probe = ev->probes.items[i];
        if (probe->geometry != NULL) {
            ev->options.tracer->close(probe->geometry);
        }
        scene_fini(&probe->shapes);
        ARRAY_FREE(&probe->leaves);
    }
    ARRAY_FREE(&ev->probes);
    intern_free(ev->probed);
}

// A negative radius turns the normals of a sphere round, until a transform is taken that need not keep it one.
static bool is_sphere_turned(const ProbeNode *leaf)
{
    return leaf->kind == KIND_SPHERE && ((const SphereDesc *)leaf->object)->radius < 0.0 && !leaf->is_stretched;
}

// The first surface that counts, and its shape; false: none.
static bool meet(const Eval *ev, const Probe *probe, Vec3 origin, Vec3 direction, EvalHit *hit, const ProbeNode **on)
{
    EvalHit from;
    const ProbeNode *passed = NULL; // a parametric surface, of which a ray meets one point
    bool is_met = ev->options.tracer->closest(probe->geometry, origin, direction, NULL, hit);
    while (is_met) {
        const ProbeNode *leaf = probe->leaves.items[hit->part];
        bool is_far = vec3_dot(vec3_sub(hit->point, origin), direction) > nearest_hit;
        if (is_far && leaf != passed && is_left(leaf, hit->point)) {
            if (leaf->kind == KIND_TRIANGLE) {
                hit->normal = vec3_sub(vec3(0.0, 0.0, 0.0), hit->normal); // POV-Ray has it on the other side
            }
            hit->normal = leaf->is_turned != is_sphere_turned(leaf) ? vec3_neg(hit->normal) : hit->normal;
            *on = leaf;
            return true;
        }
        passed = leaf->kind == KIND_PARAMETRIC ? leaf : passed;
        from = *hit;
        is_met = ev->options.tracer->closest(probe->geometry, from.point, direction, &from, hit);
    }
    return false;
}

// The variable that takes the normal, as the last argument; NULL after a fault.
static Value *find_variable(Eval *ev, const AstNode *node)
{
    Value *variable = NULL;
    ValueArray *array;
    bool is_there = true;
    if (node->kind == AST_INDEX) {
        is_there = array_locate(ev, node, &variable, &array);
    } else if (node->kind == AST_NAME) {
        variable = scope_find(ev, node->symbol);
    }
    if (is_there && (variable == NULL || variable->kind != VALUE_VECTOR || variable->components != 3)) {
        eval_fault(ev, DIAG_E0264, node->span, "the normal needs the name of a vector of 3");
        return NULL;
    }
    return is_there ? variable : NULL;
}

static void set_vector(Value *value, Vec3 vector)
{
    *value = (Value){.kind = VALUE_VECTOR, .components = 3, .v = {vector.x, vector.y, vector.z}};
}

bool builtin_trace(Eval *ev, const AstNode *node, Value *value)
{
    Value object, *normal = NULL;
    Vec3 origin, direction;
    const AstNode *second = node->a->next, *last = second->next->next;
    if (ev->options.tracer == NULL) {
        return eval_fault(ev, DIAG_E0210, node->span, "`%s` is not supported", eval_text(ev, node->symbol));
    }
    if (!extent_object(ev, node, &object) || !eval_vector3(ev, second, &origin) ||
        !eval_vector3(ev, second->next, &direction) ||
        (last != NULL && (normal = find_variable(ev, last)) == NULL)) {
        return false;
    }
    const Probe *probe = find_probe(ev, &object, node->span);
    if (probe == NULL) {
        return false;
    }
    EvalHit hit;
    const ProbeNode *leaf = NULL;
    if (!(vec3_length(direction) > 0.0) || probe->leaves.count == 0 ||
        !meet(ev, probe, origin, vec3_normalize(direction), &hit, &leaf)) {
        hit = (EvalHit){0};
        leaf = NULL;
    }
    // Where POV-Ray has it depends on what each single transform did to the corners.
    if (normal != NULL && leaf != NULL && leaf->kind == KIND_TRIANGLE && leaf->is_moved) {
        return eval_fault(ev, DIAG_E0210, last->span, "the normal of a triangle that was moved is not supported");
    }
    if (normal != NULL) {
        Symbol name = normal->name;
        set_vector(normal, hit.normal);
        normal->name = name;
    }
    set_vector(value, hit.point);
    return true;
}
