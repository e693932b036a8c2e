// A primitive is asked in its own space, a composite by its tree, from the root down.
//
// SPDX-License-Identifier: MIT
#include "scene/within.h"

#include "scene/primitive.h"

bool within_part(const Primitive *primitive, Vec3 point)
{
    const double *origin = primitive->to_world.m[3];
    Vec3 p = point;
    if (primitive->kind !=
        PRIMITIVE_PLANE) { // a scene that is put near the origin has only the linear primitive of to_object
        p = transform_direction(&primitive->to_object, vec3_sub(point, vec3(origin[0], origin[1], origin[2])));
    }
    const PrimitiveClass *class = primitive_class(primitive->kind);
    if (!class->holds) {
        return false;
    }
    bool is_inside = class->holds(primitive, p);
    return is_inside != ((primitive->flags & PRIMITIVE_INVERSE) != 0);
}

// Where a tree is being read: the next node and part, and the ends of both.
typedef struct TreeCursor {
    const Scene *scene;
    uint32_t node, node_end, part;
    uint32_t start_clips;
} TreeCursor;

static bool within_node(TreeCursor *at, Vec3 point);

// A node stands before what is in it: of a node and a part with as many parts before them the node is the first.
static bool within_child(TreeCursor *at, Vec3 point)
{
    bool is_node = at->node < at->node_end && at->scene->nodes.items[at->node].first_primitive <= at->part;
    return is_node ? within_node(at, point) : within_part(&at->scene->primitives.items[at->part++], point);
}

// Recursive, as deep as objects are in one another. All children are read, so that the cursor is behind them.
static bool within_node(TreeCursor *at, Vec3 point)
{
    const Node *node = &at->scene->nodes.items[at->node++];
    bool needs_all = node->op == NODE_INTERSECTION || node->op == NODE_CLIP;
    bool is_root_clip = node->op == NODE_CLIP && node->parent == NODE_NONE;
    bool is_inside = needs_all;
    for (uint32_t i = 0; i < node->child_count; i++) {
        bool is_in_child = within_child(at, point);
        if (!is_root_clip || i < at->start_clips) {
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
