// The tree of a field of heights, of its grid alone: a leaf is a cell, and a node's children are those of a block of
// two by four or four by two.
//
// No heuristic is asked: the cells of a field lie side by side, so blocks that are about square hold what rays pass
// through together. The root comes first, then one level after the other, row by row. Of a part of the field that is
// narrower than a block, blocks are one or two wide and the longer.
//
// SPDX-License-Identifier: MIT
#include "trace/mesh_field_tree.h"

// Nodes of one level, the size of whose blocks is given in those of the level below, or in cells.
typedef struct Level {
    uint32_t columns, rows;
    uint32_t across, along;
    uint32_t first; // its first node
} Level;

static uint32_t parts(uint32_t whole, uint32_t size)
{
    return whole / size + (whole % size > 0);
}

// The level over so many columns and rows, whose blocks are wider than long if `is_wide`.
static Level level_over(uint32_t columns, uint32_t rows, bool is_wide)
{
    uint32_t across = columns < 4 ? (columns == 1 ? 1 : 2) : rows < 4 ? (rows == 1 ? 8 : 4) : is_wide ? 2 : 4;
    uint32_t along = BVH_WIDTH / across;
    return (Level){parts(columns, across), parts(rows, along), across, along, 0};
}

// All levels, the lowest one first; returns how many.
static uint32_t levels_make(const MeshField *field, Level levels[BVH_DEPTH_MOST], uint32_t *node_count)
{
    uint32_t count = 0, columns = field->columns - 1, rows = field->rows - 1;
    double width = 1.0, length = 1.0;
    do {
        Level *own = &levels[count++];
        *own = level_over(columns, rows, width > length);
        columns = own->columns;
        rows = own->rows;
        width *= own->across;
        length *= own->along;
    } while (columns > 1 || rows > 1);
    *node_count = 0;
    for (uint32_t i = count; i > 0; i--) {
        levels[i - 1].first = *node_count;
        *node_count += levels[i - 1].columns * levels[i - 1].rows;
    }
    return count;
}

static void child_set(BvhNode *node, const BvhRef *box, BvhChild child)
{
    unsigned at = (unsigned)__builtin_popcount(node->present);
    for (int axis = 0; axis < 3; axis++) {
        node->box[axis][0][at] = box->low[axis];
        node->box[axis][1][at] = box->high[axis];
    }
    node->child[at] = child;
    node->present |= 1u << at;
}

static BvhRef cell_box(const Bvh *tree, const Mesh *mesh, uint32_t column, uint32_t row)
{
    size_t first = (size_t)row * mesh->field->columns + column;
    Vec3 near = mesh_vector(mesh->vertices[first]), right = mesh_vector(mesh->vertices[first + 1]);
    first += mesh->field->columns;
    Vec3 left = mesh_vector(mesh->vertices[first]), far = mesh_vector(mesh->vertices[first + 1]);
    return bvh_ref(tree, vec3_least(vec3_least(near, right), vec3_least(left, far)),
                   vec3_greatest(vec3_greatest(near, right), vec3_greatest(left, far)), 0);
}

// Of all children.
static BvhRef node_box(const BvhNode *node)
{
    BvhRef box = {{0}, {0}};
    for (int axis = 0; axis < 3; axis++) {
        box.low[axis] = INFINITY;
        box.high[axis] = -INFINITY;
        for (int i = 0; i < BVH_WIDTH; i++) {
            float low = node->box[axis][0][i], high = node->box[axis][1][i];
            box.low[axis] = low < box.low[axis] ? low : box.low[axis];
            box.high[axis] = high > box.high[axis] ? high : box.high[axis];
        }
    }
    return box;
}

static void node_make(const Bvh *tree, const Mesh *mesh, const Level *level, uint32_t column, uint32_t row)
{
    BvhNode *node = &tree->nodes[level->first + row * level->columns + column];
    bool is_lowest = level->first + level->columns * level->rows == tree->node_count;
    const Level *below = is_lowest ? NULL : level - 1;
    uint32_t columns = below ? below->columns : mesh->field->columns - 1;
    uint32_t rows = below ? below->rows : mesh->field->rows - 1;
    bvh_node_clear(node);
    for (uint32_t y = row * level->along; y < rows && y < (row + 1) * level->along; y++) {
        for (uint32_t x = column * level->across; x < columns && x < (column + 1) * level->across; x++) {
            uint32_t own = y * columns + x;
            BvhRef box = below ? node_box(&tree->nodes[below->first + own]) : cell_box(tree, mesh, x, y);
            child_set(node, &box, below ? below->first + own : bvh_leaf(2 * own, 2));
        }
    }
}

bool mesh_field_tree_build(Bvh *tree, const Mesh *mesh, const atomic_bool *cancel)
{
    Level levels[BVH_DEPTH_MOST];
    uint32_t node_count, level_count = levels_make(mesh->field, levels, &node_count);
    if (!pages_take(&tree->pages, node_count * sizeof(BvhNode))) {
        return false;
    }
    tree->nodes = tree->pages.memory;
    tree->node_count = node_count;
    for (uint32_t i = 0; i < level_count; i++) {
        for (uint32_t row = 0; row < levels[i].rows; row++) {
            if (cancel && atomic_load_explicit(cancel, memory_order_relaxed)) {
                bvh_fini(tree);
                return false;
            }
            for (uint32_t column = 0; column < levels[i].columns; column++) {
                node_make(tree, mesh, &levels[i], column, row);
            }
        }
    }
    return true;
}
