// The tree of a field of heights.
//
// Its leaves are cells: the two faces of one, by their numbers in the mesh. Knows nothing of rays.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_MESH_FIELD_TREE_H
#define TRACE_MESH_FIELD_TREE_H

#include <stdatomic.h>

#include "scene/mesh.h"
#include "trace/bvh.h"

// Fills a placed tree. False when out of memory, or given up since *cancel (NULL: there is none) is set; it is then
// empty.
bool mesh_field_tree_build(Bvh *tree, const Mesh *mesh, const atomic_bool *cancel) RT_MUST_CHECK;

#endif
