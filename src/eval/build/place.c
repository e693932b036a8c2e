// Placing: an object and all that is in it become scene records.
//
// Transforms are composed on the way down, untextured shapes take the texture of the nearest object around them or of
// #default. The members of a union stand for themselves; a sphere or plane with nothing special about it becomes the
// plainest record there is, any other shape a part, and what cuts shapes with one another a composite. Knows nothing of
// rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "eval/build/blocks.h"
#include "scene/part.h"
#include "scene/primitive.h"
#include "scene/room.h"

// The clips of the unions around an object, the innermost first.
typedef struct ClipChain ClipChain;
struct ClipChain {
    const ClipChain *next;
    const Clip *clips;
    const Transform *outer; // of all around the object that they clip
    bool clips_all;         // and not a member of a union that is one object
};

typedef struct Placement {
    Transform outer;
    const TextureDesc *texture;      // of the nearest object around that has one, else #default's
    Transform texture_outer;         // of the texture
    const InteriorDesc *interior;    // of the nearest one that has one, or NULL
    uint32_t body;                     // Scene.bodies that it is in, or RECORD_NONE
    const ClipChain *clips;
    const BoxOwner *whole; // the outermost union around that is one object, or NULL
    bool is_inner, is_hollow; // inside of another object, whose word on this counts
    bool is_stretched;        // extent_is_stretched, of any object around
    bool is_look;             // of a light
    uint8_t hidden;
    bool is_hidden_fixed; // what members say of no_image and the like does not count
} Placement;

// Where a part of a composite goes.
typedef struct Branch {
    Placement placement;
    uint32_t parent; // node
    uint32_t body;   // Part.body
    bool is_inverse; // one of those that a difference takes away
    bool was_turned; // as of an object: it, or a group around it
    bool is_unseen;
    bool is_in_merge;
    bool is_in_box; // a member of a union or merge of which POV-Ray sees what is in its box
} Branch;

static bool place(Eval *ev, SchemaKind kind, const void *object, const Placement *outer);
static bool grow(Eval *ev, SchemaKind kind, const void *object, const Branch *branch);

bool memory_has(const Eval *ev, size_t bytes)
{
    return scene_memory_has(ev->scene, ev->memory.used + ev->opened_bytes, bytes, ev->memory.limit);
}

bool memory_suffices(Eval *ev, Span span)
{
    if (!memory_has(ev, 0)) {
        ev->memory.refused = true;
        return eval_no_memory(ev, span);
    }
    return true;
}

static bool may_add_one(Eval *ev, Span span)
{
    if (eval_cancelled(ev)) {
        return false;
    }
    if (!scene_has_room(ev->scene, 1, ev->options.limits, ev->options.diags, span)) {
        ev->stop = true; // only now: nothing is reported after it
        return false;
    }
    return true;
}

static bool may_add(Eval *ev, Span span)
{
    return may_add_one(ev, span) && memory_suffices(ev, span);
}

static uint8_t hidden_of(const ObjectPart *part)
{
    return (uint8_t)((part->no_image ? HIDDEN_CAMERA : 0) | (part->no_shadow ? HIDDEN_SHADOW : 0) |
                     (part->no_reflection ? HIDDEN_MIRROR : 0));
}

// What fills the first shape of a body that is filled fills the body. `inner_body` is Part.body of a leaf, else 0.
static bool place_material(Eval *ev, const Placement *at, uint32_t inner_body, Span span, MaterialIndex *material)
{
    if (!material_place(ev, at->texture, &at->texture_outer, at->interior, at->is_hollow, span, material)) {
        return false;
    }
    ev->clear_count += !texture_hides_all(at->texture);
    if (at->body != RECORD_NONE && !inner_body && *material & MATERIAL_COMPOUND) {
        uint32_t *interior = &ev->scene->bodies.items[at->body].interior;
        *interior = *interior == RECORD_NONE ? ev->scene->compounds.items[*material & ~MATERIAL_COMPOUND].interior
                                             : *interior;
    }
    return true;
}

// The same of an object that may be a blob with textures of its components.
static bool place_material_of(Eval *ev, const void *object, const Part *part, const Placement *at, uint32_t inner_body,
                              MaterialIndex *material)
{
    Span span = ((const ObjectPart *)object)->span;
    TextureDesc blend;
    Placement inner = *at;
    if (part->kind == PART_BLOB && ((const BlobDesc *)object)->texture_count > 0) {
        if (!blob_blend(ev, object, at->texture, &at->texture_outer, &blend)) {
            return false;
        }
        inner.texture = &blend;
        inner.texture_outer = at->outer;
    }
    return place_material(ev, &inner, inner_body, span, material);
}

// A group is hollow when it says so or its last member is; `hollow off` does not take back what that one says.
// Measured.
static bool is_hollow(SchemaKind kind, const void *object)
{
    const ObjectPart *part = object;
    while (object_is_group(kind) && !part->hollow) {
        const UnionMember *last = NULL;
        for (const UnionMember *member = ((const UnionDesc *)object)->members; member; member = member->next) {
            last = member->kind != KIND_LIGHT_SOURCE ? member : last;
        }
        if (!last) {
            return false;
        }
        kind = last->kind;
        part = object = last->object;
    }
    return part->hollow;
}

// ---- plain spheres and planes

// A sphere that is one after its transforms too. False in *is_round: it is not.
static bool place_sphere(Eval *ev, const SphereDesc *sphere, const Placement *inner, bool *is_round)
{
    const Transform *transform = &inner->outer;
    double image;
    Span span = sphere->part.span;
    MaterialIndex material;
    // One with surface coordinates keeps its turn.
    *is_round = !texture_asks_uv(inner->texture) && sphere_image_radius(fabs(sphere->radius), transform, &image);
    if (!*is_round || !may_add(ev, span) || !place_material(ev, inner, 0, span, &material)) {
        return !*is_round;
    }
    Vec3 centre = transform_point(transform, sphere->centre);
    if (!vec3_is_finite(centre) || !isfinite(image) || !(image > 0.0)) {
        return shape_flattened(ev, &sphere->part);
    }
    ev->slow_spheres++;
    return scene_add_sphere(ev->scene, centre, image, material, span.begin) || eval_no_memory(ev, span);
}

bool sphere_place_plain(Eval *ev, Vec3 centre, double radius, const Material *material, Span span)
{
    MaterialIndex index;
    const Scene *scene = ev->scene;
    // Nothing else takes memory before one of these lists is full.
    bool takes_memory = scene->spheres.count == scene->spheres.capacity ||
                        scene->sphere_runs.count == scene->sphere_runs.capacity ||
                        scene->materials.count == scene->materials.capacity;
    return may_add_one(ev, span) && (!takes_memory || memory_suffices(ev, span)) &&
           ((scene_add_material_record(ev->scene, material, &index) &&
             scene_add_sphere(ev->scene, centre, radius, index, span.begin)) ||
            eval_no_memory(ev, span));
}

bool part_place_plain(Eval *ev, Part *part, const Material *material, Span span)
{
    return may_add(ev, span) &&
           ((scene_add_material_record(ev->scene, material, &part->material) && scene_add_part(ev->scene, part)) ||
            eval_no_memory(ev, span));
}

// The materials of a mesh's own textures, which move with it.
static bool place_face_materials(Eval *ev, const MeshDesc *mesh, const Placement *at, Part *part)
{
    Scene *scene = ev->scene;
    Span span = mesh->part.span;
    part->mesh.materials = scene->face_materials.count;
    for (uint32_t i = 0; i < part->mesh.mesh->texture_count; i++) { // a patch's has none
        MaterialIndex material;
        CornerBlend blend;
        const TextureDesc *texture = i < mesh->single_count ? mesh->singles[i] : &blend.texture;
        if (i >= mesh->single_count) {
            mesh_blend(mesh, &mesh->corners[i - mesh->single_count], &blend);
        }
        if (!material_place(ev, texture, &at->outer, at->interior, at->is_hollow, span, &material)) {
            return false;
        }
        ev->clear_count += !texture_hides_all(texture);
        if (!ARRAY_PUSH(&scene->face_materials, material)) {
            return eval_no_memory(ev, span);
        }
    }
    return memory_suffices(ev, span);
}

static bool place_single(Eval *ev, const ObjectPart *common, bool is_plain, const Placement *inner, const Part *part)
{
    MaterialIndex material;
    Scene *scene = ev->scene;
    Span span = common->span;
    bool is_added;
    if (!may_add(ev, span) || !place_material_of(ev, common, part, inner, 0, &material)) {
        return false;
    }
    if (is_plain && part->kind == PART_PLANE) {
        is_added = scene_add_plane(scene, part->data[0], part->data[1].x, material, part->source);
    } else {
        Part alone = *part;
        alone.material = material;
        alone.hidden = inner->hidden;
        alone.flags |= common->is_inverse ? PART_INVERSE : 0;
        if (primitive_class(part->kind)->is_mesh &&
            !place_face_materials(ev, (const MeshDesc *)common, inner, &alone)) {
            return false;
        }
        if (part->kind == PART_ISOSURFACE && !isosurface_place(ev, common, &alone)) {
            return false;
        }
        is_added = scene_add_part(scene, &alone);
    }
    return is_added || eval_no_memory(ev, span);
}

// ---- clips

// True when a clip is a box or plane that all of the shape is inside of, so that it clips nothing.
static bool clip_is_idle(Eval *ev, const Clip *clip, const Transform *outer, const Part *shape)
{
    const ObjectPart *common = clip->object;
    Part part;
    if ((clip->kind != KIND_BOX && clip->kind != KIND_PLANE) || common->is_inverse || common->clips) {
        return false;
    }
    Transform whole = transform_compose(transform_compose(common->transform, clip->transform), *outer);
    return shape_make(ev, clip->kind, clip->object, &whole, false, &part) == SHAPE_MADE && part_contains(&part, shape);
}

// Whether anything is left to clip `shape`; NULL for what has no end or is not a single shape.
static bool clips_matter(Eval *ev, const ClipChain *chain, const Part *shape)
{
    for (; chain; chain = chain->next) {
        for (const Clip *clip = chain->clips; clip; clip = clip->next) {
            if (!shape || !clip_is_idle(ev, clip, chain->outer, shape)) {
                return true;
            }
        }
    }
    return false;
}

// ---- composites

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

static bool grow_clips(Eval *ev, const ClipChain *chain, const Part *shape, const Branch *object_branch, uint32_t node)
{
    Scene *scene = ev->scene;
    for (; chain; chain = chain->next) {
        if (chain->clips_all && scene->nodes.items[node].parent == NODE_NONE) {
            scene->composites.items[scene->composites.count - 1].start_clips = scene->nodes.items[node].child_count;
        }
        for (const Clip *clip = chain->clips; clip; clip = clip->next) {
            if (shape && clip_is_idle(ev, clip, chain->outer, shape)) {
                continue;
            }
            Branch branch = *object_branch;
            branch.parent = node;
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

// A sphere of radius 0 is an empty union: nothing is inside of it. With any other shape without extent POV-Ray draws
// nothing of the whole.
static bool grow_nothing(Eval *ev, SchemaKind kind, const ObjectPart *part, const Branch *branch)
{
    uint32_t node;
    if (kind != KIND_SPHERE) {
        return eval_fault(ev, DIAG_E0364, part->span, "a %s without extent cannot be cut with other shapes",
                          schema_kind(kind)->word);
    }
    return add_node(ev, NODE_UNION, part->is_inverse != branch->is_inverse, branch, part->span, &node);
}

// Intervals of a line in all parts of a composite: of a stack of STACK_BYTES they take half.
enum { COMPOSITE_INTERVALS_MOST = 2 * COMPOSITE_PARTS_MOST };

// Whether a ray has room for one more part. Those whose intervals are few are held by their number.
static bool has_stack(const Scene *scene, const Composite *composite, const Part *part)
{
    uint64_t sum = primitive_intervals(part);
    for (size_t i = composite->first_part; sum > 2 && i < scene->parts.count; i++) {
        sum += primitive_intervals(&scene->parts.items[i]);
    }
    return sum <= COMPOSITE_INTERVALS_MOST;
}

static bool grow_leaf(Eval *ev, SchemaKind kind, const void *object, const Branch *branch)
{
    const ObjectPart *common = object;
    const Placement *around = &branch->placement;
    const Composite *composite = &ev->scene->composites.items[ev->scene->composites.count - 1];
    Part part;
    if (branch->is_in_box && box_is_inside_out(kind, object)) {
        return box_fault(ev, common->span);
    }
    if (kind == KIND_BICUBIC_PATCH) {
        return eval_fault(ev, DIAG_E0362, common->span,
                          "a bicubic_patch has no inside, and POV-Ray does not clip it: nothing can be cut with it");
    }
    bool keeps_turn = !branch->is_unseen && kind == KIND_SPHERE && texture_asks_uv(around->texture);
    ShapeResult result = shape_make(ev, kind, object, &around->outer, keeps_turn, &part);
    if (result != SHAPE_MADE) {
        return result == SHAPE_NOTHING && grow_nothing(ev, kind, common, branch);
    }
    // Flat ones may be clipped, which is their first node then.
    const Node *parent = &ev->scene->nodes.items[branch->parent];
    bool is_clipped_alone = parent->op == NODE_CLIP && parent->child_count == 0 && parent->parent == NODE_NONE;
    if (primitive_is_flat(part.kind) && !is_clipped_alone) {
        return eval_fault(ev, DIAG_E0362, common->span, "a %s has no inside, so nothing can be cut with it",
                          primitive_class(primitive_class(part.kind)->surface)->word);
    }
    if (ev->scene->parts.count - composite->first_part >= COMPOSITE_PARTS_MOST) {
        return eval_fault(ev, DIAG_E0363, common->span, "more than %d shapes are cut with one another",
                          COMPOSITE_PARTS_MOST);
    }
    if (part.kind == PART_ISOSURFACE && !isosurface_place(ev, object, &part)) {
        return false;
    }
    if (!has_stack(ev->scene, composite, &part)) {
        return eval_fault(ev, DIAG_E0363, common->span,
                          "a line may cross the shapes that are cut here more than %d times",
                          2 * COMPOSITE_INTERVALS_MOST);
    }
    part.node = branch->parent;
    part.body = branch->body;
    part.flags |= (common->is_inverse != branch->is_inverse ? PART_INVERSE : 0) | (branch->is_unseen ? PART_UNSEEN : 0);
    if (!may_add(ev, common->span) ||
        (!branch->is_unseen && !place_material_of(ev, object, &part, around, branch->body, &part.material)) ||
        (!branch->is_unseen && primitive_class(part.kind)->is_mesh &&
         !place_face_materials(ev, object, around, &part))) {
        return false;
    }
    return scene_add_leaf(ev->scene, &part) || eval_no_memory(ev, common->span);
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
    case KIND_UNION: return grow_members(ev, kind, object, branch, NODE_UNION);
    case KIND_MERGE: return grow_members(ev, kind, object, branch, NODE_MERGE);
    case KIND_INTERSECTION:
    case KIND_DIFFERENCE: return grow_members(ev, kind, object, branch, NODE_INTERSECTION);
    default: return grow_leaf(ev, kind, object, branch);
    }
}

static bool has_no_look(Eval *ev, const LightDesc *light)
{
    return !light->look || eval_fault(ev, DIAG_E0251, light->part.span,
                                      "`looks_like` among shapes that are cut is not supported by rtlang");
}

// Recursive, as `place` is.
static bool grow(Eval *ev, SchemaKind kind, const void *object, const Branch *outer)
{
    if (kind == KIND_LIGHT_SOURCE) {
        return light_place(ev, object, &outer->placement.outer) && has_no_look(ev, object);
    }
    const ObjectPart *part = object;
    Branch branch = *outer;
    if (outer->is_in_merge && hidden_of(part)) {
        return eval_fault(ev, DIAG_E0365, part->span,
                          "a member of a merge that some rays do not see is not supported by rtlang");
    }
    ClipChain own = {outer->placement.clips, part->clips, &outer->placement.outer, !outer->placement.whole};
    const ClipChain *clips = part->clips ? &own : outer->placement.clips;
    branch.placement.clips = NULL;
    branch.placement.outer = transform_compose(part->transform, outer->placement.outer);
    if (part->texture) {
        branch.placement.texture = part->texture;
        branch.placement.texture_outer = outer->placement.outer;
    }
    branch.placement.interior = part->interior ? part->interior : outer->placement.interior;
    if (part->interior && outer->parent != NODE_NONE) {
        branch.body = ++ev->scene->inner_body_count;
    }
    branch.placement.is_inner = true;
    branch.placement.is_hollow = outer->placement.is_inner ? outer->placement.is_hollow : is_hollow(kind, object);
    if (!clips) {
        return grow_object(ev, kind, object, &branch);
    }
    Part shape;
    // A clip is not turned round with what it clips: what is outside of a shape reaches beyond any clip.
    bool is_known = !object_is_group(kind) && kind != KIND_BICUBIC_PATCH && part->is_inverse == branch.is_inverse &&
                    shape_make(ev, kind, object, &branch.placement.outer, false, &shape) == SHAPE_MADE;
    const Part *known = is_known ? &shape : NULL;
    if (!clips_matter(ev, clips, known)) {
        return grow_object(ev, kind, object, &branch);
    }
    uint32_t node;
    if (!add_node(ev, NODE_CLIP, false, &branch, part->span, &node)) {
        return false;
    }
    branch.parent = node;
    return grow_object(ev, kind, object, &branch) && grow_clips(ev, clips, known, &branch, node);
}

static bool place_composite(Eval *ev, SchemaKind kind, const void *object, const Placement *outer,
                            const Placement *inner)
{
    const ObjectPart *part = object;
    Branch root = {.placement = *outer, .parent = NODE_NONE};
    root.placement.body = inner->body;
    if (!may_add(ev, part->span)) {
        return false;
    }
    if (!scene_begin_composite(ev->scene, inner->hidden, part->span.begin)) {
        return eval_no_memory(ev, part->span);
    }
    bool is_grown = grow(ev, kind, object, &root);
    scene_end_composite(ev->scene);
    return is_grown;
}

// ---- anything

static bool place_members(Eval *ev, const UnionDesc *group, const Placement *inner)
{
    bool is_fine = true;
    for (const UnionMember *member = group->members; member && !ev->stop; member = member->next) {
        is_fine = place(ev, member->kind, member->object, inner) && is_fine;
    }
    return is_fine;
}

static bool place_shape(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, const Placement *inner)
{
    const ObjectPart *common = object;
    bool is_plain = !common->is_inverse && !inner->hidden;
    bool may_be_round = kind == KIND_SPHERE && is_plain && ((const SphereDesc *)object)->radius != 0.0;
    bool is_round = false, is_placed = false;
    if (box_is_inside_out(kind, object) && (outer->is_hidden_fixed || outer->is_look || !inner->is_stretched)) {
        return outer->is_look           ? box_fault_of_look(ev, common->span)
               : outer->is_hidden_fixed ? box_fault(ev, common->span)
                                        : box_leave_out(ev, common->span);
    }
    if (may_be_round && !inner->clips) {
        is_placed = place_sphere(ev, object, inner, &is_round);
    }
    if (is_round) {
        return is_placed;
    }
    Part shape;
    bool is_stretched = may_be_round && !inner->clips; // it was found not to be round, or has a turn that is seen
    is_stretched |= kind == KIND_SPHERE && texture_asks_uv(inner->texture);
    ShapeResult result = shape_make(ev, kind, object, &inner->outer, is_stretched, &shape);
    if (result != SHAPE_MADE) {
        return result == SHAPE_NOTHING;
    }
    if (clips_matter(ev, inner->clips, common->is_inverse ? NULL : &shape)) {
        return place_composite(ev, kind, object, outer, inner);
    }
    if (may_be_round && inner->clips) {
        is_placed = place_sphere(ev, object, inner, &is_round);
    }
    return is_round ? is_placed : place_single(ev, common, is_plain, inner, &shape);
}

// A shape, or a group that is cut.
static bool place_one(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, const Placement *inner)
{
    size_t first_part = ev->scene->parts.count;
    bool is_placed = object_is_group(kind) ? place_composite(ev, kind, object, outer, inner)
                                           : place_shape(ev, kind, object, outer, inner);
    if (!is_placed || (!inner->clips && !extent_reaches_out(kind, object, false))) {
        return is_placed;
    }
    BoxOwner own = {kind, object, outer->outer};
    return box_note_start(ev, inner->whole ? inner->whole : &own, first_part);
}

// What a light looks like: an object by itself, but for the texture and interior of what is around.
static bool place_look(Eval *ev, const LightDesc *light, const Placement *outer)
{
    if (!light->look || outer->clips) {
        return has_no_look(ev, light);
    }
    Placement own = {
        .outer = transform_compose(light->look_transform, outer->outer),
        .texture = light->part.texture ? light->part.texture : outer->texture,
        .texture_outer = light->part.texture ? outer->outer : outer->texture_outer,
        .interior = outer->interior,
        .body = outer->body,
        .is_look = true,
        .hidden = outer->hidden | (outer->is_hidden_fixed ? 0 : hidden_of(&light->part)) | HIDDEN_SHADOW,
    };
    return place(ev, light->look->kind, light->look->object, &own);
}

// Recursive: object_members and light_look_action keep trees from growing deeper than the limit.
static bool place(Eval *ev, SchemaKind kind, const void *object, const Placement *outer)
{
    bool is_counted = !outer->whole && !outer->is_look;
    if (kind == KIND_LIGHT_SOURCE) {
        ev->object_count += is_counted;
        return light_place(ev, object, &outer->outer) && place_look(ev, object, outer);
    }
    const ObjectPart *part = object;
    ClipChain own = {outer->clips, part->clips, &outer->outer, !outer->whole};
    BoxOwner whole = {kind, object, outer->outer};
    Placement inner = {
        .outer = transform_compose(part->transform, outer->outer),
        .texture = part->texture ? part->texture : outer->texture,
        .texture_outer = part->texture ? outer->outer : outer->texture_outer,
        .interior = part->interior ? part->interior : outer->interior,
        .body = outer->body,
        .clips = part->clips ? &own : outer->clips,
        .is_inner = true,
        .is_look = outer->is_look,
        .is_stretched = outer->is_stretched || extent_is_stretched(kind, object),
        .is_hollow = outer->is_inner ? outer->is_hollow : is_hollow(kind, object),
        .hidden = outer->hidden | (outer->is_hidden_fixed ? 0 : hidden_of(part)),
        .is_hidden_fixed = outer->is_hidden_fixed || !part->split_union || part->clips || part->bounds,
    };
    bool is_union = kind == KIND_UNION && !part->was_turned;
    inner.whole = outer->whole || !is_union || !inner.is_hidden_fixed ? outer->whole : &whole;
    ev->object_count += is_counted && (!is_union || inner.whole);
    bool is_body = is_union ? part->interior || outer->body == RECORD_NONE : part->interior && outer->body != RECORD_NONE;
    if (!is_body) {
        return is_union ? place_members(ev, object, &inner) : place_one(ev, kind, object, outer, &inner);
    }
    uint64_t clear_count = ev->clear_count;
    if (!scene_begin_body(ev->scene, outer->body, &inner.body)) {
        return eval_no_memory(ev, part->span);
    }
    bool is_placed = is_union ? place_members(ev, object, &inner) : place_one(ev, kind, object, outer, &inner);
    scene_end_body(ev->scene, inner.body, ev->clear_count != clear_count);
    return is_placed;
}

Transform world_transform(const Eval *ev)
{
    const EvalWorld *world = ev->options.world;
    if (!world) {
        return transform_identity();
    }
    Transform scale = transform_scale(vec3(world->scale, world->scale, world->scale));
    return transform_compose(scale, transform_translate(world->shift));
}

Transform world_inverse(const Eval *ev)
{
    const EvalWorld *world = ev->options.world;
    if (!world) {
        return transform_identity();
    }
    double scale = 1.0 / world->scale;
    return transform_compose(transform_translate(vec3_neg(world->shift)), transform_scale(vec3(scale, scale, scale)));
}

void world_note(Eval *ev)
{
    const EvalWorld *world = ev->options.world;
    ev->scene->text_unit = world_scale(ev);
    ev->scene->text_origin = world ? world->shift : vec3(0.0, 0.0, 0.0);
}

double world_scale(const Eval *ev)
{
    return ev->options.world ? ev->options.world->scale : 1.0;
}

bool object_place(Eval *ev, SchemaKind kind, const void *object)
{
    Transform outer = world_transform(ev);
    Placement world = {.outer = outer, .texture = ev->objects->defaults, .texture_outer = outer,
                       .body = RECORD_NONE};
    return place(ev, kind, object, &world);
}
