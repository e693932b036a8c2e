// Placing: an object and all that is in it become scene records.
//
// Transforms are composed on the way down, untextured shapes take the texture of the nearest object around them or of
// #default. The members of a union stand for themselves; a sphere or plane with nothing special about it becomes the
// plainest record there is, any other shape a part, and what cuts shapes with one another a composite. Knows nothing of
// rays.
//
// SPDX-License-Identifier: MIT
#include "eval/build/place.h"

#include <math.h>

#include "scene/isosurface.h"
#include "scene/outline.h"
#include "scene/primitive_reach.h"
#include "scene/primitive.h"
#include "scene/room.h"

static bool place(Eval *ev, SchemaKind kind, const void *object, const Placement *outer);

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

bool place_may_add(Eval *ev, Span span)
{
    return may_add_one(ev, span) && memory_suffices(ev, span);
}

bool placement_asks_uv(const Placement *at)
{
    return texture_asks_uv(at->texture) || (at->inner && texture_asks_uv(at->inner));
}

uint8_t place_hidden(const ObjectPart *part)
{
    return (uint8_t)((part->no_image ? HIDDEN_CAMERA : 0) | (part->no_shadow ? HIDDEN_SHADOW : 0) |
                     (part->no_reflection ? HIDDEN_MIRROR : 0));
}

// A texture with what is seen of it from inside.
static bool place_both_sides(Eval *ev, const TextureDesc *texture, const Transform *outer, const Placement *at,
                             Span span, MaterialIndex *material)
{
    MaterialIndex inner = RECORD_NONE;
    MaterialSides sides = {at->interior, texture, at->is_hollow, at->is_double, at->light_group, RECORD_NONE};
    if (at->inner && !material_place(ev, at->inner, &at->inner_outer, &sides, span, &inner)) {
        return false;
    }
    sides.inner = inner;
    ev->clear_count += !texture_hides_all(texture) || (at->inner && !texture_hides_all(at->inner));
    return material_place(ev, texture, outer, &sides, span, material);
}

static bool place_plain_material(Eval *ev, const Placement *at, uint32_t inner_body, Span span, MaterialIndex *material)
{
    if (!place_both_sides(ev, at->texture, &at->texture_outer, at, span, material)) {
        return false;
    }
    if (at->body != RECORD_NONE && !inner_body && *material & MATERIAL_COMPOUND) {
        uint32_t *interior = &ev->scene->bodies.items[at->body].interior;
        *interior = *interior == RECORD_NONE ? ev->scene->compounds.items[*material & ~MATERIAL_COMPOUND].interior
                                             : *interior;
    }
    return true;
}

// A blob may have textures of its components.
bool place_material(Eval *ev, const void *object, const Primitive *primitive, const Placement *at, uint32_t inner_body,
                    MaterialIndex *material)
{
    Span span = ((const ObjectPart *)object)->span;
    TextureDesc blend;
    Placement inner = *at;
    // In POV-Ray their inner side depends on the way of their points, that of a triangle on each single transform, too.
    bool has_no_sides = primitive->kind == PRIMITIVE_TRIANGLE || primitive->kind == PRIMITIVE_PRISM ||
                        primitive->kind == PRIMITIVE_LATHE;
    if (at->inner && has_no_sides) {
        return eval_fault(ev, DIAG_E0251, span,
                          "`interior_texture` of a flat triangle, prism, text or lathe is not supported by rtlang: a "
                          "`mesh` may have one");
    }
    if (primitive->kind == PRIMITIVE_BLOB && ((const BlobDesc *)object)->texture_count > 0) {
        if (!blob_blend(ev, object, at->texture, &at->texture_outer, &blend)) {
            return false;
        }
        inner.texture = &blend;
        inner.inner = NULL; // is not shown then. Measured.
        inner.texture_outer = at->outer;
    }
    return place_plain_material(ev, &inner, inner_body, span, material);
}

bool place_is_hollow(SchemaKind kind, const void *object)
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
    *is_round = !placement_asks_uv(inner) && sphere_image_radius(fabs(sphere->radius), transform, &image);
    if (!*is_round || !place_may_add(ev, span) || !place_plain_material(ev, inner, 0, span, &material)) {
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

bool primitive_place_plain(Eval *ev, Primitive *primitive, const Material *material, Span span)
{
    return place_may_add(ev, span) && ((scene_add_material_record(ev->scene, material, &primitive->material) &&
                                        scene_add_primitive(ev->scene, primitive)) ||
                                       eval_no_memory(ev, span));
}

bool place_face_materials(Eval *ev, const MeshDesc *mesh, const Placement *at, Primitive *primitive)
{
    Scene *scene = ev->scene;
    Span span = mesh->part.span;
    primitive->mesh.materials = scene->face_materials.count;
    for (uint32_t i = 0; i < primitive->mesh.mesh->texture_count; i++) { // a patch's has none
        MaterialIndex material;
        CornerBlend blend;
        const TextureDesc *texture = i < mesh->single_count ? mesh->singles[i] : &blend.texture;
        if (i >= mesh->single_count) {
            mesh_blend(mesh, &mesh->corners[i - mesh->single_count], &blend);
        }
        if (!place_both_sides(ev, texture, &at->outer, at, span, &material)) {
            return false;
        }
        if (!ARRAY_PUSH(&scene->face_materials, material)) {
            return eval_no_memory(ev, span);
        }
    }
    return memory_suffices(ev, span);
}

static bool place_single(Eval *ev, const ObjectPart *common, bool is_plain, const Placement *inner,
                         const Primitive *primitive)
{
    MaterialIndex material;
    Scene *scene = ev->scene;
    Span span = common->span;
    bool is_added;
    if (!place_may_add(ev, span) || !place_material(ev, common, primitive, inner, 0, &material)) {
        return false;
    }
    if (is_plain && primitive->kind == PRIMITIVE_PLANE) {
        is_added = scene_add_plane(scene, primitive->data[0], primitive->data[1].x, material, primitive->source);
    } else {
        Primitive alone = *primitive;
        alone.material = material;
        alone.hidden = inner->hidden;
        alone.flags |= common->is_inverse ? PRIMITIVE_INVERSE : 0;
        if (primitive_class(primitive->kind)->is_mesh &&
            !place_face_materials(ev, (const MeshDesc *)common, inner, &alone)) {
            return false;
        }
        if (!shape_place_functions(ev, common, &alone)) {
            return false;
        }
        is_added = scene_add_primitive(scene, &alone);
    }
    return is_added || eval_no_memory(ev, span);
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
    Primitive shape;
    bool is_stretched = may_be_round && !inner->clips; // it was found not to be round, or has a turn that is seen
    is_stretched |= kind == KIND_SPHERE && placement_asks_uv(inner);
    ShapeResult result = shape_make(ev, kind, object, &inner->outer, is_stretched, &shape);
    if (result != SHAPE_MADE) {
        return result == SHAPE_NOTHING;
    }
    if (place_clips_matter(ev, inner->clips, common->is_inverse ? NULL : &shape)) {
        return place_composite(ev, kind, object, outer, inner);
    }
    if (may_be_round && inner->clips) {
        is_placed = place_sphere(ev, object, inner, &is_round);
    }
    return is_round ? is_placed : place_single(ev, common, is_plain, inner, &shape);
}

// Whether a ray may leave a shape that was placed where nothing is seen: at ends that are open, or at what closes a
// lathe's curve.
static bool has_gaps(const Scene *scene, size_t first_primitive)
{
    bool does = false;
    for (size_t i = first_primitive; i < scene->primitives.count && !does; i++) {
        const Primitive *primitive = &scene->primitives.items[i];
        const Numbers *list = &primitive->list;
        does = (primitive->flags & PRIMITIVE_OPEN) ||
               (primitive->kind == PRIMITIVE_LATHE && outline_seen_count(list) < outline_piece_count(list)) ||
               (primitive->kind == PRIMITIVE_ISOSURFACE && isosurface_is(isosurface_of(list->items), ISOSURFACE_OPEN));
    }
    return does;
}

// A shape, or a group that is cut.
static bool place_one(Eval *ev, SchemaKind kind, const void *object, const Placement *outer, const Placement *inner)
{
    size_t first_primitive = ev->scene->primitives.count;
    bool is_placed = object_is_group(kind) ? place_composite(ev, kind, object, outer, inner)
                                           : place_shape(ev, kind, object, outer, inner);
    if (!is_placed || (!place_is_clipped(inner->clips) && !extent_reaches_out(kind, object, false) &&
                       !has_gaps(ev->scene, first_primitive))) {
        return is_placed;
    }
    BoxOwner own = {kind, object, outer->outer};
    return box_note_start(ev, inner->whole ? inner->whole : &own, first_primitive);
}

// What a light looks like: an object by itself, but for the texture and interior of what is around.
static bool place_look(Eval *ev, const LightDesc *light, const Placement *outer)
{
    if (!light->look || place_is_clipped(outer->clips)) {
        return place_has_no_look(ev, light);
    }
    Placement own = {
        .outer = transform_compose(light->look_transform, outer->outer),
        .texture = light->part.texture ? light->part.texture : outer->texture,
        .texture_outer = light->part.texture ? outer->outer : outer->texture_outer,
        .inner = outer->inner,
        .inner_outer = outer->inner_outer,
        .light_group = outer->light_group,
        .is_double = outer->is_double,
        .says_double = outer->says_double,
        .interior = outer->interior,
        .body = outer->body,
        .is_look = true,
        .hidden = outer->hidden | (outer->is_hidden_fixed ? 0 : place_hidden(&light->part)) | HIDDEN_SHADOW,
    };
    return place(ev, light->look->kind, light->look->object, &own);
}

// In POV-Ray a group within another takes the outer one's word on global lights, and its lights depending on how it was
// written.
static bool begin_light_group(Eval *ev, const UnionDesc *group, const Placement *outer, Placement *inner)
{
    LightGroup record = {.first = ev->scene->shape_count, .has_others = group->global_lights};
    if (outer->light_group != 0) {
        return eval_fault(ev, DIAG_E0251, group->part.span, "a light group within another is not supported by rtlang");
    }
    inner->light_group = (uint32_t)ev->scene->light_groups.count + 1;
    inner->takes_lights = true;
    return ARRAY_PUSH(&ev->scene->light_groups, record) || eval_no_memory(ev, group->part.span);
}

static void end_light_group(Scene *scene, bool is_open)
{
    if (is_open) {
        scene->light_groups.items[scene->light_groups.count - 1].end = scene->shape_count;
    }
}

// Recursive: object_members and light_look_action keep trees from growing deeper than the limit.
static bool place(Eval *ev, SchemaKind kind, const void *object, const Placement *outer)
{
    bool is_counted = !outer->whole && !outer->is_look;
    if (kind == KIND_LIGHT_SOURCE) {
        ev->object_count += is_counted;
        return light_place(ev, object, &outer->outer, outer->takes_lights ? outer->light_group : 0) &&
               place_look(ev, object, outer);
    }
    const ObjectPart *part = object;
    ClipChain own = {outer->clips, part->clips, &outer->outer, !outer->whole, false}, bound;
    BoxOwner whole = {kind, object, outer->outer};
    Placement inner = {
        .outer = transform_compose(part->transform, outer->outer),
        .texture = part->texture ? part->texture : outer->texture,
        .texture_outer = part->texture ? outer->outer : outer->texture_outer,
        .inner = part->inner ? part->inner : outer->inner,
        .inner_outer = part->inner ? outer->outer : outer->inner_outer,
        .light_group = outer->light_group,
        .is_double = outer->says_double ? outer->is_double : part->is_double,
        .says_double = outer->says_double || part->says_double,
        .interior = part->interior ? part->interior : outer->interior,
        .body = outer->body,
        .clips = place_bounds(ev, kind, object, outer, outer->whole, part->clips ? &own : outer->clips, &bound),
        .is_inner = true,
        .is_look = outer->is_look,
        .is_stretched = outer->is_stretched || extent_is_stretched(kind, object),
        .is_hollow = outer->is_inner ? outer->is_hollow : place_is_hollow(kind, object),
        .hidden = outer->hidden | (outer->is_hidden_fixed ? 0 : place_hidden(part)),
        .is_hidden_fixed = outer->is_hidden_fixed || !part->split_union || part->clips || part->bounds,
    };
    bool is_union = kind == KIND_UNION && !part->was_turned;
    bool is_lit_apart = is_union && ((const UnionDesc *)object)->is_light_group;
    if (is_lit_apart && !begin_light_group(ev, object, outer, &inner)) {
        return false;
    }
    inner.whole = outer->whole || !is_union || !inner.is_hidden_fixed ? outer->whole : &whole;
    ev->object_count += is_counted && (!is_union || inner.whole);
    bool is_body = is_union ? part->interior || outer->body == RECORD_NONE : part->interior && outer->body != RECORD_NONE;
    if (!is_body) {
        bool is_placed = is_union ? place_members(ev, object, &inner) : place_one(ev, kind, object, outer, &inner);
        end_light_group(ev->scene, is_lit_apart);
        return is_placed;
    }
    uint64_t clear_count = ev->clear_count;
    if (!scene_begin_body(ev->scene, outer->body, &inner.body)) {
        return eval_no_memory(ev, part->span);
    }
    bool is_placed = is_union ? place_members(ev, object, &inner) : place_one(ev, kind, object, outer, &inner);
    scene_end_body(ev->scene, inner.body, ev->clear_count != clear_count);
    end_light_group(ev->scene, is_lit_apart);
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
