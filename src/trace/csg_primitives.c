// The tree of a composite's primitives, where they are many.
//
// SPDX-License-Identifier: MIT
#include "trace/csg_primitives.h"

#include <stdlib.h>

#include "trace/bvh_walk.h"

// What a composite's boxes are taken from, see csg_parts_init.
typedef struct Boxes {
    const ShapeTable *table;
    const CsgTree *csg;
    const Bounds *surfaces, *nodes;
} Boxes;

// Whether a primitive is a leaf, and its box: that of its surface, or, where it has none, of its node if that is below
// the root: outside of it nobody asks whether a ray is inside of the primitive.
static bool leaf_box(const Boxes *of, uint32_t index, Bounds *box)
{
    const PreparedPrimitive *primitive = &of->table->primitives[of->csg->first_primitive + index];
    *box = of->surfaces[of->csg->first_primitive + index];
    if (!bounds_are_finite(*box) && primitive->node != of->csg->first_node) {
        *box = of->nodes[primitive->node];
    }
    return !primitive->decides && !primitive->bounds && !primitive_is_mesh(primitive) && bounds_are_finite(*box);
}

// Places the leaves' boxes and builds the tree of them; `refs` has room for all.
static bool build(const Boxes *of, CsgPrimitives *parts, BvhRef *refs, int threads, const atomic_bool *cancel)
{
    const CsgTree *csg = of->csg;
    Bounds all = BOUNDS_NONE, own;
    uint32_t count = 0;
    for (uint32_t i = 0; i < csg->primitive_count; i++) {
        if (leaf_box(of, i, &own)) {
            all = bounds_join(all, own);
        } else {
            parts->loose[parts->loose_count++] = i;
        }
    }
    bvh_place(&parts->tree, all.low, all.high);
    for (uint32_t i = 0; i < csg->primitive_count; i++) {
        if (leaf_box(of, i, &own)) {
            refs[count++] = bvh_ref(&parts->tree, own.low, own.high, i);
            parts->are_leaves_unseen = parts->are_leaves_unseen && i >= csg->seen_count;
        }
    }
    parts->leaf_count = count;
    bool done = bvh_build(&parts->tree, refs, count, BVH_LEAF_ONE, threads, cancel);
    for (uint32_t i = 0; done && i < count; i++) {
        parts->leaves[i] = bvh_ref_index(&refs[i]);
    }
    return done;
}

// The node that joins all leaves and nothing else, where these only clip and are simple.
static uint32_t joined_by(const ShapeTable *table, const CsgTree *csg)
{
    const CsgPrimitives *parts = csg->parts;
    uint32_t at = table->primitives[csg->first_primitive + parts->leaves[0]].node;
    const TreeNode *node = &table->nodes[at];
    bool is_joined = parts->are_leaves_unseen && (node->op == NODE_UNION || node->op == NODE_MERGE) &&
                     node->child_count == parts->leaf_count;
    for (uint32_t i = 0; i < parts->leaf_count && is_joined; i++) {
        const PreparedPrimitive *primitive = &table->primitives[csg->first_primitive + parts->leaves[i]];
        is_joined = primitive->node == at && primitive_is_convex(primitive) && !primitive_is_flat(primitive) &&
                    !(primitive->flags & PRIMITIVE_INVERSE);
    }
    return is_joined ? at : NODE_NONE;
}

bool csg_parts_init(const ShapeTable *table, CsgTree *csg, const Bounds *surfaces, const Bounds *nodes, int threads,
                    const atomic_bool *cancel)
{
    const Boxes of = {table, csg, surfaces, nodes};
    uint32_t count = 0;
    for (uint32_t i = 0; i < csg->primitive_count; i++) {
        Bounds box;
        count += leaf_box(&of, i, &box);
    }
    if (csg->is_plain || count < CSG_PRIMITIVES_LEAST) {
        return true;
    }
    Pages pages = {0};
    CsgPrimitives *parts = csg->parts = calloc(1, sizeof *parts);
    uint32_t *numbers = malloc(csg->primitive_count * sizeof *numbers);
    if (!parts || !numbers || !pages_take(&pages, count * sizeof(BvhRef))) {
        free(numbers);
        return false;
    }
    parts->leaves = numbers;
    parts->loose = numbers + count;
    parts->are_leaves_unseen = true;
    bool done = build(&of, parts, pages.memory, threads, cancel);
    parts->joined = done ? joined_by(table, csg) : NODE_NONE;
    pages_give(&pages);
    return done;
}

void csg_parts_fini(CsgTree *csg)
{
    if (csg->parts) {
        bvh_fini(&csg->parts->tree);
        free(csg->parts->leaves);
        free(csg->parts);
    }
}

size_t csg_parts_bytes(const CsgTree *csg)
{
    const CsgPrimitives *parts = csg->parts;
    return !parts ? 0
                  : sizeof *parts + csg->primitive_count * sizeof *parts->leaves +
                        parts->tree.node_count * sizeof *parts->tree.nodes;
}

void csg_parts_along(const CsgPrimitives *parts, const Ray *ray, double until, uint64_t *met)
{
    BvhWalk walk;
    BvhChild leaf;
    if (!bvh_walk_start(&walk, &parts->tree, ray->origin, ray->direction)) {
        return;
    }
    float limit = bvh_walk_limit(&walk, until);
    while (bvh_walk_next(&walk, limit, &leaf)) {
        uint32_t part = parts->leaves[bvh_leaf_first(leaf)];
        met[part / 64] |= UINT64_C(1) << part % 64;
    }
}

void csg_parts_at(const CsgPrimitives *parts, const Ray *ray, double from, double to, CsgPrimitiveFn ask, void *client)
{
    BvhWalk walk;
    BvhChild leaf;
    if (!bvh_walk_start(&walk, &parts->tree, ray_at(*ray, from), ray->direction)) {
        return;
    }
    float limit = bvh_walk_limit(&walk, to - from);
    while (bvh_walk_next(&walk, limit, &leaf) && !ask(client, parts->leaves[bvh_leaf_first(leaf)])) {
    }
}
