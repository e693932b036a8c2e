// Blobs: surfaces where a sum of fields is a threshold; inside is where it is more.
//
// The field of a ball is strength (1 - d²)² within distance 1 of its middle, that of a rod the same around a stretch of
// the z axis from 0 to its height (POV-Ray's manual, "Blob"); each under an affine map. A part's list of numbers is:
// the threshold, how many components there are and how many nodes, the nodes of a tree over them, and the components in
// the tree's order.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_BLOB_H
#define SCENE_BLOB_H

#include <stdbool.h>
#include <stdint.h>

#include "math/transform.h"
#include "scene/numbers.h"

// In the list as doubles. `to_world` leads from the component's space to the blob's; to_own back.
typedef struct BlobComponent {
    double is_rod, strength, height;
    double texture; // its own, by number from 1; 0: that of the blob
    double to_world[4][3], to_own[4][3];
} BlobComponent;

// Some components that follow each other, and the box of where they have a field. The children of a node of more than
// BLOB_LEAF of them are the next one, of the first half, and the one numbered `second`; so deep at most.
enum { BLOB_LEAF = 4, BLOB_NODES_DEEP = 64 };
typedef struct BlobNode {
    double low[3], high[3];
    double begin, end, second, unused;
} BlobNode;

typedef struct Blob {
    double threshold, greatest; // of all fields together, at most
    uint32_t component_count, node_count;
    const BlobNode *nodes;
    const BlobComponent *components;
} Blob;

enum {
    BLOB_HEAD = 4,
    BLOB_NODE = sizeof(BlobNode) / sizeof(double),
    BLOB_COMPONENT = sizeof(BlobComponent) / sizeof(double)
};

static inline Blob blob_of(const double *list)
{
    uint32_t count = (uint32_t)list[1], nodes = (uint32_t)list[2];
    return (Blob){list[0],
                  list[3],
                  count,
                  nodes,
                  (const BlobNode *)(const void *)(list + BLOB_HEAD),
                  (const BlobComponent *)(const void *)(list + BLOB_HEAD + (size_t)BLOB_NODE * nodes)};
}

// How many numbers a list of so many components has, at most.
size_t blob_list_most(uint32_t component_count);

// Sets a component from what the scene's text says of it; `transform` leads from where that is said to the blob's
// space. A rod reaches from `base` to `cap`; a ball is at `base`, and `cap` is the same. False: it is flat or infinite.
bool blob_component(BlobComponent *component, bool is_rod, Vec3 base, Vec3 cap, double radius, double strength,
                    const Transform *transform);

// Makes the list of at least one component in `list`, which has room for blob_list_most numbers; what it returns refers
// to that. What `components` hold afterwards means nothing.
Numbers blob_make(double threshold, BlobComponent *components, uint32_t count, double *list);

// The square of the distance, in the component's own space, of a point of the blob's from what the component is around;
// *own is the point in that space.
double blob_distance2(const BlobComponent *component, Vec3 point, Vec3 *own);

// The field at a point of the blob's space.
double blob_field(const double *list, Vec3 point);

// How many intervals a line has in it, at most.
uint32_t blob_interval_most(const double *list);

#endif
