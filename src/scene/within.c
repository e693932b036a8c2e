// A primitive is tested in its own space, a composite by its tree, from the root down.
//
// SPDX-License-Identifier: MIT
#include "scene/within.h"

#include <stdlib.h>
#include <string.h>

#include "scene/primitive.h"

static Vec3 own_point(const Primitive *primitive, Vec3 point)
{
    const double *origin = primitive->to_world.m[3];
    if (primitive->kind ==
        PRIMITIVE_PLANE) { // a scene that is put near the origin has only the linear primitive of to_object
        return point;
    }
    return transform_direction(&primitive->to_object, vec3_sub(point, vec3(origin[0], origin[1], origin[2])));
}

bool within_part(const Primitive *primitive, Vec3 point)
{
    Vec3 p = own_point(primitive, point);
    const PrimitiveClass *class = primitive_class(primitive->kind);
    if (!class->holds) {
        return false;
    }
    bool is_inside = class->holds(primitive, p);
    return is_inside != ((primitive->flags & PRIMITIVE_INVERSE) != 0);
}

// The same for a pattern, where a point may lie on a surface: a ball, turned inside out or not, has not its own, and so
// have closed ends of cylinders and cones; both sides of a plane have it. Measured.
static bool pattern_has(const Primitive *primitive, Vec3 point)
{
    Vec3 p = own_point(primitive, point);
    bool is_inverse = (primitive->flags & PRIMITIVE_INVERSE) != 0;
    if (primitive->kind == PRIMITIVE_SPHERE && is_inverse) {
        return vec3_dot(p, p) > 1.0;
    }
    if (primitive->kind == PRIMITIVE_PLANE) {
        double beyond = vec3_dot(p, primitive->data[0]) - primitive->data[1].x;
        return (is_inverse ? -beyond : beyond) < WITHIN_PLANE;
    }
    bool is_at_end =
        primitive->kind == PRIMITIVE_CONE && !(primitive->flags & PRIMITIVE_OPEN) && (p.z == 0.0 || p.z == 1.0);
    return is_at_end ? is_inverse : within_part(primitive, point);
}

// Where a tree is being read: the next node and part, and the ends of both.
typedef struct TreeCursor {
    const Scene *scene;
    uint32_t node, node_end, part;
    uint32_t start_clips;
    bool is_pattern;
} TreeCursor;

static bool within_node(TreeCursor *at, Vec3 point);

// A node stands before what is in it: of a node and a part with as many parts before them the node is the first.
static bool within_child(TreeCursor *at, Vec3 point)
{
    bool is_node = at->node < at->node_end && at->scene->nodes.items[at->node].first_primitive <= at->part;
    if (is_node) {
        return within_node(at, point);
    }
    const Primitive *primitive = &at->scene->primitives.items[at->part++];
    return at->is_pattern ? pattern_has(primitive, point) : within_part(primitive, point);
}

// Recursive, as deep as objects are in one another. All children are read, so that the cursor is behind them.
static bool within_node(TreeCursor *at, Vec3 point)
{
    const Node *node = &at->scene->nodes.items[at->node++];
    bool needs_all = node->op == NODE_INTERSECTION || node->op == NODE_CLIP;
    bool is_root_clip = node->op == NODE_CLIP && node->parent == NODE_NONE;
    bool is_inside = needs_all;
    for (uint32_t i = 0; i < node->child_count; i++) {
        bool is_bound = at->node < at->node_end && at->scene->nodes.items[at->node].op == NODE_BOUND &&
                        at->scene->nodes.items[at->node].first_primitive <= at->part;
        bool is_in_child = within_child(at, point);
        if ((!is_root_clip || i < at->start_clips) && !is_bound) {
            is_inside = needs_all ? is_inside && is_in_child : is_inside || is_in_child;
        }
    }
    return is_inside != node->is_inverse;
}

bool within_composite(const Scene *scene, const Composite *composite, Vec3 point)
{
    TreeCursor at = {
        .scene = scene,
        .node = composite->first_node,
        .node_end = composite->first_node + composite->node_count,
        .part = composite->first_primitive,
        .start_clips = composite->start_clips,
    };
    return within_node(&at, point);
}

bool within_inside(const Scene *inside, Vec3 point)
{
    TreeCursor at = {.scene = inside, .node_end = (uint32_t)inside->nodes.count, .is_pattern = true};
    return within_node(&at, point);
}

// ---- insides of objects that are patterns

static bool primitives_are_alike(const Primitive *a, const Primitive *b)
{
    const PrimitiveClass *class = primitive_class(a->kind);
    if (a->kind != b->kind || a->flags != b->flags || a->node != b->node ||
        memcmp(&a->to_world, &b->to_world, sizeof a->to_world) != 0) {
        return false;
    }
    if (class->is_mesh) {
        return a->mesh.mesh == b->mesh.mesh;
    }
    return class->has_list ? memcmp(a->fixed, b->fixed, sizeof a->fixed) == 0 && a->list.count == b->list.count &&
                                 memcmp(a->list.items, b->list.items, a->list.count * sizeof *a->list.items) == 0
                           : memcmp(a->data, b->data, sizeof a->data) == 0;
}

static bool nodes_are_alike(const Node *a, const Node *b)
{
    return a->op == b->op && a->is_inverse == b->is_inverse && a->parent == b->parent &&
           a->child_count == b->child_count && a->first_primitive == b->first_primitive;
}

static bool insides_are_alike(const Scene *a, const Scene *b)
{
    bool are_alike = a->nodes.count == b->nodes.count && a->primitives.count == b->primitives.count;
    for (size_t i = 0; are_alike && i < a->nodes.count; i++) {
        are_alike = nodes_are_alike(&a->nodes.items[i], &b->nodes.items[i]);
    }
    for (size_t i = 0; are_alike && i < a->primitives.count; i++) {
        are_alike = primitives_are_alike(&a->primitives.items[i], &b->primitives.items[i]);
    }
    return are_alike;
}

bool scene_add_inside(Scene *scene, Scene *inside, uint32_t *index)
{
    size_t count = scene->insides.count;
    for (*index = 0; *index < count && !insides_are_alike(scene->insides.items[*index], inside); ++*index) {
    }
    if (*index == count && ARRAY_PUSH(&scene->insides, inside)) {
        scene->inside_bytes += sizeof *inside + scene_bytes(inside);
        return true;
    }
    scene_fini(inside);
    free(inside);
    return *index < count;
}
