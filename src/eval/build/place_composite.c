// Placing what cuts shapes with one another: groups and clipped shapes become composites, trees of nodes over parts.
//
// SPDX-License-Identifier: MIT
#include "eval/build/place.h"

#include <stdlib.h>
#include <string.h>

#include "scene/primitive_reach.h"
#include "scene/primitive.h"

// Where a part of a composite goes.
typedef struct Branch {
    Placement placement;
    uint32_t parent; // node
    uint32_t body;   // Primitive.body
    bool is_inverse; // one of those that a difference takes away
    bool was_turned; // as of an object: it, or a group around it
    bool is_unseen;
    bool is_inside; // of a pattern: only what is inside counts
    bool is_in_merge;
    bool is_in_box; // a member of a union or merge of which POV-Ray sees what is in its box
} Branch;

// ---- clips

// True when a clip is a box or plane that all of the shape is inside of, so that it clips nothing.
static bool clip_is_idle(Eval *ev, const Clip *clip, const Transform *outer, const Primitive *shape)
{
    const ObjectPart *common = clip->object;
    Primitive primitive;
    if ((clip->kind != KIND_BOX && clip->kind != KIND_PLANE) || common->is_inverse || common->clips) {
        return false;
    }
    Transform whole = transform_compose(transform_compose(common->transform, clip->transform), *outer);
    return shape_make(ev, clip->kind, clip->object, &whole, false, &primitive) == SHAPE_MADE &&
           primitive_contains(&primitive, shape);
}

// ---- bounds

// Whether there are triangles, of which a ray that has met one does not tell what else it meets.
static bool has_mesh(SchemaKind kind, const void *object)
{
    const UnionMember *member = object_is_group(kind) ? ((const UnionDesc *)object)->members : NULL;
    bool does = kind == KIND_MESH || kind == KIND_MESH2 || kind == KIND_HEIGHT_FIELD || kind == KIND_BICUBIC_PATCH;
    for (; member && !does; member = member->next) {
        does = has_mesh(member->kind, member->object);
    }
    return does;
}

// Whether all of an object, clips and bounds left away, surely is inside of what bounds it.
static bool bound_holds(Eval *ev, const Primitive *bound, SchemaKind kind, const void *object, const Transform *outer)
{
    const ObjectPart *part = object;
    Transform own = transform_compose(part->transform, *outer);
    Primitive shape;
    if (kind == KIND_LIGHT_SOURCE) {
        return true;
    }
    if (part->is_inverse) {
        return false;
    }
    if (!object_is_group(kind)) {
        return kind != KIND_BICUBIC_PATCH && shape_make(ev, kind, object, &own, false, &shape) == SHAPE_MADE &&
               primitive_contains(bound, &shape);
    }
    bool needs_all = kind == KIND_UNION || kind == KIND_MERGE, does = needs_all;
    const UnionMember *member = ((const UnionDesc *)object)->members;
    for (; member && does == needs_all; member = kind == KIND_DIFFERENCE ? NULL : member->next) {
        does = bound_holds(ev, bound, member->kind, member->object, &own);
    }
    return does;
}

// The shape of a bound, if it can be decided whether it holds others.
static bool bound_make(Eval *ev, const Clip *bound, const Transform *outer, Primitive *primitive)
{
    const ObjectPart *common = bound->object;
    Transform whole = transform_compose(transform_compose(common->transform, bound->transform), *outer);
    if (object_is_group(bound->kind) || bound->kind == KIND_BICUBIC_PATCH || common->is_inverse || common->clips ||
        shape_make(ev, bound->kind, bound->object, &whole, false, primitive) != SHAPE_MADE) {
        return false;
    }
    if (primitive->kind == PRIMITIVE_BOX) { // one that its object touches cuts nothing either
        Vec3 room = vec3_scale(0x1p-40, vec3_sub(primitive->data[1], primitive->data[0]));
        primitive->data[0] = vec3_sub(primitive->data[0], room);
        primitive->data[1] = vec3_add(primitive->data[1], room);
    }
    return true;
}

static bool bound_is_idle(Eval *ev, const Clip *bound, SchemaKind kind, const void *object, const Transform *outer)
{
    Primitive primitive;
    for (const Clip *clip = ((const ObjectPart *)object)->clips; clip; clip = clip->next) {
        if (clip->object == bound->object && memcmp(&clip->transform, &bound->transform, sizeof clip->transform) == 0) {
            return true; // what is seen lies in it
        }
    }
    return bound_make(ev, bound, outer, &primitive) && bound_holds(ev, &primitive, kind, object, outer);
}

// Of one in a chain, for a shape, NULL where it is not known.
static bool link_is_idle(Eval *ev, const ClipChain *chain, const Clip *clip, const Primitive *shape)
{
    Primitive bound;
    if (!chain->is_bound) {
        return shape && clip_is_idle(ev, clip, chain->outer, shape);
    }
    return has_mesh(clip->kind, clip->object) ||
           (shape && bound_make(ev, clip, chain->outer, &bound) && primitive_contains(&bound, shape));
}

// The kinds whose bound POV-Ray keeps where they stand alone; of others it keeps that of members only (by experiment).
static bool keeps_bounds(SchemaKind kind)
{
    return object_is_group(kind) || kind == KIND_CUBIC || kind == KIND_QUARTIC || kind == KIND_POLY ||
           kind == KIND_TEXT;
}

const ClipChain *place_bounds(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, bool is_member,
                              const ClipChain *clips, ClipChain *link)
{
    const ObjectPart *part = object;
    bool is_kept = is_member || keeps_bounds(kind);
    bool matters = false, is_flat = !object_is_group(kind) && (has_mesh(kind, object) || shape_is_flat(kind, object));
    if (is_flat) { // would only be slower
        return place_is_clipped(clips) ? clips : NULL;
    }
    for (const Clip *bound = is_kept ? part->bounds : NULL; bound && !matters; bound = bound->next) {
        matters = !has_mesh(bound->kind, bound->object) && !bound_is_idle(ev, bound, kind, object, &outer->outer);
    }
    *link = (ClipChain){clips, part->bounds, &outer->outer, false, true};
    return matters ? link : clips;
}

bool place_is_clipped(const ClipChain *chain)
{
    for (; chain && chain->is_bound; chain = chain->next) {
    }
    return chain;
}

bool place_clips_matter(Eval *ev, const ClipChain *chain, const Primitive *shape)
{
    for (; chain; chain = chain->next) {
        for (const Clip *clip = chain->clips; clip; clip = clip->next) {
            if (!link_is_idle(ev, chain, clip, shape)) {
                return true;
            }
        }
    }
    return false;
}

// ---- nodes and leaves

static bool add_node(Eval *ev, NodeOp op, bool is_inverse, const Branch *branch, Span span, uint32_t *index)
{
    const Composite *composite = &ev->scene->composites.items[ev->scene->composites.count - 1];
    if (ev->scene->nodes.count - composite->first_node >= COMPOSITE_NODES_MOST) {
        return eval_fault(ev, DIAG_E0363, span, "more than %d groups and empty shapes are cut with one another",
                          COMPOSITE_NODES_MOST);
    }
    if (!scene_add_node(ev->scene, op, is_inverse, branch->parent, span.begin, index)) {
        return eval_no_memory(ev, span);
    }
    ev->scene->nodes.items[*index].body = branch->body;
    return true;
}

static bool grow(Eval *ev, SchemaKind kind, const void *object, const Branch *branch);

static bool grow_clips(Eval *ev, const ClipChain *chain, const Primitive *shape, const Branch *object_branch,
                       uint32_t node)
{
    Scene *scene = ev->scene;
    for (; chain; chain = chain->next) {
        if (chain->clips_all && scene->nodes.items[node].parent == NODE_NONE) {
            scene->composites.items[scene->composites.count - 1].start_clips = scene->nodes.items[node].child_count;
        }
        for (const Clip *clip = chain->clips; clip; clip = clip->next) {
            if (link_is_idle(ev, chain, clip, shape)) {
                continue;
            }
            Branch branch = *object_branch;
            branch.parent = node;
            if (chain->is_bound &&
                !add_node(ev, NODE_BOUND, false, &branch, ((const ObjectPart *)clip->object)->span, &branch.parent)) {
                return false;
            }
            branch.is_inverse = false;
            branch.is_unseen = true;
            branch.placement.clips = NULL;
            branch.placement.outer = transform_compose(clip->transform, *chain->outer);
            if (!grow(ev, clip->kind, clip->object, &branch)) {
                return false;
            }
        }
    }
    return true;
}

// An empty union: nothing is inside of it.
static bool grow_empty(Eval *ev, const ObjectPart *part, const Branch *branch)
{
    uint32_t node;
    return add_node(ev, NODE_UNION, part->is_inverse != branch->is_inverse, branch, part->span, &node);
}

// Whether a shape without extent is an empty part. Of a composite that holds a cylinder or flat shape without extent
// POV-Ray draws nothing at all, and a polynomial that is the same everywhere may have all of space inside.
static bool is_empty_part(SchemaKind kind)
{
    switch (kind) {
    case KIND_CYLINDER:
    case KIND_CONE:
    case KIND_DISC:
    case KIND_TRIANGLE:
    case KIND_SMOOTH_TRIANGLE:
    case KIND_POLYGON:
    case KIND_QUADRIC:
    case KIND_CUBIC:
    case KIND_QUARTIC:
    case KIND_POLY:
        return false;
    default:
        return true;
    }
}

static bool grow_nothing(Eval *ev, SchemaKind kind, const ObjectPart *part, const Branch *branch)
{
    if (!is_empty_part(kind)) {
        return eval_fault(ev, DIAG_E0364, part->span, "a %s without extent cannot be cut with other shapes",
                          schema_kind(kind)->word);
    }
    return grow_empty(ev, part, branch);
}

// Intervals of a line in all parts of a composite: of a stack of STACK_BYTES they take half.
enum { COMPOSITE_INTERVALS_MOST = 2 * COMPOSITE_PRIMITIVES_MOST };

// Whether a ray has room for one more primitive. Those whose intervals are few are held by their number.
static bool has_stack(const Scene *scene, const Composite *composite, const Primitive *primitive)
{
    uint64_t sum = primitive_interval_most(primitive);
    for (size_t i = composite->first_primitive; sum > 2 && i < scene->primitives.count; i++) {
        sum += primitive_interval_most(&scene->primitives.items[i]);
    }
    return sum <= COMPOSITE_INTERVALS_MOST;
}

static bool grow_leaf(Eval *ev, SchemaKind kind, const void *object, const Branch *branch)
{
    const ObjectPart *common = object;
    const Placement *around = &branch->placement;
    const Composite *composite = &ev->scene->composites.items[ev->scene->composites.count - 1];
    Primitive primitive;
    if (branch->is_in_box && box_is_inside_out(kind, object)) {
        return box_fault(ev, common->span);
    }
    if (kind == KIND_BICUBIC_PATCH && branch->is_inside) {
        return grow_empty(ev, common, branch);
    }
    if (kind == KIND_BICUBIC_PATCH) {
        return eval_fault(ev, DIAG_E0362, common->span,
                          "a bicubic_patch has no inside, and POV-Ray does not clip it: nothing can be cut with it");
    }
    bool keeps_turn = !branch->is_unseen && kind == KIND_SPHERE && placement_asks_uv(around);
    ShapeResult result = shape_make(ev, kind, object, &around->outer, keeps_turn, &primitive);
    if (result != SHAPE_MADE) {
        return result == SHAPE_NOTHING && grow_nothing(ev, kind, common, branch);
    }
    // Flat ones may be clipped, which is their first node then.
    const Node *parent = &ev->scene->nodes.items[branch->parent];
    bool is_clipped_alone = parent->op == NODE_CLIP && parent->child_count == 0 && parent->parent == NODE_NONE;
    if (primitive_kind_is_sheet(primitive.kind) && !is_clipped_alone && !branch->is_inside) {
        const char *word = kind == KIND_PRISM ? "prism without a height"
                                              : primitive_class(primitive_class(primitive.kind)->surface)->word;
        return eval_fault(ev, DIAG_E0362, common->span, "a %s has no inside, so nothing can be cut with it", word);
    }
    if (ev->scene->primitives.count - composite->first_primitive >= COMPOSITE_PRIMITIVES_MOST) {
        return eval_fault(ev, DIAG_E0363, common->span, "more than %d shapes are cut with one another",
                          COMPOSITE_PRIMITIVES_MOST);
    }
    if (!shape_place_functions(ev, object, &primitive)) {
        return false;
    }
    if (!has_stack(ev->scene, composite, &primitive)) {
        return eval_fault(ev, DIAG_E0363, common->span,
                          "a line may cross the shapes that are cut here more than %d times",
                          2 * COMPOSITE_INTERVALS_MOST);
    }
    primitive.node = branch->parent;
    primitive.body = branch->body;
    primitive.flags |=
        (common->is_inverse != branch->is_inverse ? PRIMITIVE_INVERSE : 0) | (branch->is_unseen ? PRIMITIVE_UNSEEN : 0);
    if (!place_may_add(ev, common->span) ||
        (!branch->is_unseen && !place_material(ev, object, &primitive, around, branch->body, &primitive.material)) ||
        (!branch->is_unseen && primitive_class(primitive.kind)->is_mesh &&
         !place_face_materials(ev, object, around, &primitive))) {
        return false;
    }
    return scene_add_leaf(ev->scene, &primitive) || eval_no_memory(ev, common->span);
}

static bool grow_members(Eval *ev, SchemaKind kind, const UnionDesc *group, const Branch *outer, NodeOp op)
{
    Branch branch = *outer;
    branch.is_inverse = false;
    branch.is_in_merge = op == NODE_MERGE || (op == NODE_UNION && outer->is_in_merge);
    branch.is_in_box = op != NODE_INTERSECTION && (group->part.is_inverse || !outer->is_inverse);
    branch.was_turned |= outer->is_inverse || group->part.was_turned;
    // A union that was once turned inside out has lost what is inside of it. Measured.
    op = op == NODE_UNION && branch.was_turned ? NODE_MERGE : op;
    if (!add_node(ev, op, group->part.is_inverse != outer->is_inverse, outer, group->part.span, &branch.parent)) {
        return false;
    }
    bool is_fine = true;
    for (const UnionMember *member = group->members; member && !ev->stop; member = member->next) {
        is_fine = grow(ev, member->kind, member->object, &branch) && is_fine;
        branch.is_inverse = kind == KIND_DIFFERENCE;
    }
    Node *node = is_fine ? &ev->scene->nodes.items[branch.parent] : NULL;
    if (node && node->child_count == 0 && op == NODE_MERGE && outer->parent != NODE_NONE) {
        node->op = NODE_UNION; // as what takes the place of a shape that is nothing, so that dumps read back the same
    }
    return is_fine;
}

// The object without the clips around it.
static bool grow_object(Eval *ev, SchemaKind kind, const void *object, const Branch *branch)
{
    switch (kind) {
    case KIND_UNION:
        return grow_members(ev, kind, object, branch, NODE_UNION);
    case KIND_MERGE:
        return grow_members(ev, kind, object, branch, NODE_MERGE);
    case KIND_INTERSECTION:
    case KIND_DIFFERENCE:
        return grow_members(ev, kind, object, branch, NODE_INTERSECTION);
    default:
        return grow_leaf(ev, kind, object, branch);
    }
}

bool place_has_no_look(Eval *ev, const LightDesc *light)
{
    return !light->look || eval_fault(ev, DIAG_E0251, light->part.span,
                                      "`looks_like` among shapes that are cut is not supported by rtlang");
}

static bool has_bounds(const ClipChain *chain)
{
    for (; chain && !chain->is_bound; chain = chain->next) {
    }
    return chain;
}

// The object with what clips and bounds it.
static bool grow_clipped(Eval *ev, SchemaKind kind, const void *object, const ClipChain *clips, const Branch *outer)
{
    const ObjectPart *part = object;
    Branch branch = *outer;
    Primitive shape;
    // A clip is not turned round with what it clips: what is outside of a shape reaches beyond any clip.
    bool is_known = !object_is_group(kind) && kind != KIND_BICUBIC_PATCH && part->is_inverse == branch.is_inverse &&
                    shape_make(ev, kind, object, &branch.placement.outer, false, &shape) == SHAPE_MADE;
    const Primitive *known = is_known ? &shape : NULL;
    if (!place_clips_matter(ev, clips, known)) {
        return grow_object(ev, kind, object, &branch);
    }
    uint32_t node;
    if (!add_node(ev, NODE_CLIP, false, &branch, part->span, &node)) {
        return false;
    }
    branch.parent = node;
    // Alone in a group it keeps what bounds it when it is read again.
    Branch around = branch;
    bool has_own = keeps_bounds(kind) || has_mesh(kind, object) || shape_is_flat(kind, object);
    bool is_wrapped = outer->parent == NODE_NONE && !has_own && has_bounds(clips);
    if (is_wrapped && !add_node(ev, NODE_INTERSECTION, false, &around, part->span, &branch.parent)) {
        return false;
    }
    return grow_object(ev, kind, object, &branch) && grow_clips(ev, clips, known, &around, node);
}

// Recursive, as `place` is.
static bool grow(Eval *ev, SchemaKind kind, const void *object, const Branch *outer)
{
    if (kind == KIND_LIGHT_SOURCE && outer->is_inside) {
        return true;
    }
    if (kind == KIND_LIGHT_SOURCE) {
        return light_place(ev, object, &outer->placement.outer, 0) && place_has_no_look(ev, object);
    }
    const ObjectPart *part = object;
    Branch branch = *outer;
    if (outer->is_in_merge && place_hidden(part)) {
        return eval_fault(ev, DIAG_E0365, part->span,
                          "a member of a merge that some rays do not see is not supported by rtlang");
    }
    if (kind == KIND_UNION && ((const UnionDesc *)object)->is_light_group && !outer->is_inside) {
        return eval_fault(ev, DIAG_E0251, part->span,
                          "a light group among shapes that are cut is not supported by rtlang");
    }
    ClipChain own = {outer->placement.clips, part->clips, &outer->placement.outer, !outer->placement.whole, false},
              bound;
    const ClipChain *clips = part->clips ? &own : outer->placement.clips;
    if (!outer->is_inside) {
        bool is_member = outer->parent != NODE_NONE || outer->placement.whole;
        clips = place_bounds(ev, kind, object, &outer->placement, is_member, clips, &bound);
    }
    branch.placement.clips = NULL;
    branch.placement.outer = transform_compose(part->transform, outer->placement.outer);
    if (part->texture) {
        branch.placement.texture = part->texture;
        branch.placement.texture_outer = outer->placement.outer;
    }
    if (part->inner) {
        branch.placement.inner = part->inner;
        branch.placement.inner_outer = outer->placement.outer;
    }
    branch.placement.is_double = outer->placement.says_double ? outer->placement.is_double : part->is_double;
    branch.placement.says_double = outer->placement.says_double || part->says_double;
    branch.placement.interior = part->interior ? part->interior : outer->placement.interior;
    if (part->interior && outer->parent != NODE_NONE && !outer->is_inside) {
        branch.body = ++ev->scene->inner_body_count;
    }
    branch.placement.is_inner = true;
    branch.placement.is_hollow = outer->placement.is_inner ? outer->placement.is_hollow : place_is_hollow(kind, object);
    return !clips ? grow_object(ev, kind, object, &branch) : grow_clipped(ev, kind, object, clips, &branch);
}

bool place_composite(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, const Placement *inner)
{
    const ObjectPart *part = object;
    Branch root = {.placement = *outer, .parent = NODE_NONE};
    root.placement.body = inner->body;
    if (!place_may_add(ev, part->span)) {
        return false;
    }
    if (!scene_begin_composite(ev->scene, inner->hidden, part->span.begin)) {
        return eval_no_memory(ev, part->span);
    }
    bool is_grown = grow(ev, kind, object, &root);
    scene_end_composite(ev->scene);
    return is_grown;
}

// ---- the inside of an object, as a pattern

static bool grow_inside(Eval *ev, const InsideDesc *inside, Span span)
{
    Branch root = {.placement = {.outer = inside->transform, .body = RECORD_NONE}, .parent = NODE_NONE};
    root.is_unseen = root.is_inside = true;
    if (!scene_begin_composite(ev->scene, 0, span.begin)) {
        return eval_no_memory(ev, span);
    }
    Branch branch = root;
    bool is_grown = add_node(ev, NODE_UNION, false, &root, span, &branch.parent) &&
                    grow(ev, (SchemaKind)inside->kind, inside->object, &branch);
    scene_end_composite(ev->scene);
    return is_grown;
}

// What asks for more than numbers: formulas with noise or patterns, and textures of faces.
static bool inside_is_plain(const Scene *inside)
{
    bool is_plain = !inside->formula_host;
    for (size_t i = 0; is_plain && i < inside->primitives.count; i++) {
        const Primitive *primitive = &inside->primitives.items[i];
        is_plain = !primitive_class(primitive->kind)->is_mesh || !primitive->mesh.mesh->face_textures;
    }
    return is_plain;
}

enum { INSIDES_MOST = 10000 }; // each is compared with all before it

bool inside_place(Eval *ev, Scene *scene, const InsideDesc *inside, Span span, uint32_t *index)
{
    if (scene->insides.count >= INSIDES_MOST) {
        return eval_fault(ev, DIAG_E0291, span, "at most %d different objects can be patterns", (int)INSIDES_MOST);
    }
    Scene *own = malloc(sizeof *own), *around = ev->scene;
    if (!own) {
        return eval_no_memory(ev, span);
    }
    scene_init(own);
    ev->scene = own;
    bool is_fine = grow_inside(ev, inside, span);
    ev->scene = around;
    if (is_fine && !inside_is_plain(own)) {
        is_fine = eval_fault(ev, DIAG_E0251, ((const ObjectPart *)inside->object)->span,
                             "an isosurface of noise or patterns, or a mesh with textures of its own, is not supported "
                             "as a pattern by rtlang");
    }
    if (!is_fine) {
        scene_fini(own);
        free(own);
        return false;
    }
    return (scene_add_inside(scene, own, index) || eval_no_memory(ev, span)) && memory_suffices(ev, span);
}
