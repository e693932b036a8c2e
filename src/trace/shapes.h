// The other shapes of a Geometry: primitives that stand alone and composites, in a tree of their boxes.
//
// The tree is walked by a function for each query in the table of kernels (trace/spheres.h): a kernel of a scene that
// has none of these holds a call it never reaches, or no call at all. Knows nothing of spheres and planes that are kept
// in arrays of their own.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SHAPES_H
#define TRACE_SHAPES_H

#include "scene/outline.h"
#include "trace/bvh.h"
#include "trace/mesh.h"
#include "trace/prepared_primitive.h"
#include "trace/spheres.h"
#include "trace/trace.h"

static inline ShapeId primitive_shape(uint32_t index, uint8_t side)
{
    return shape_id(SHAPE_PRIMITIVE, index << PRIMITIVE_SIDE_BITS | side);
}

static inline uint32_t primitive_index(ShapeId shape)
{
    return shape_index(shape) >> PRIMITIVE_SIDE_BITS;
}

static inline uint8_t primitive_side(ShapeId shape)
{
    return shape & ((1u << PRIMITIVE_SIDE_BITS) - 1);
}

static inline bool starts_on_primitive(RayStart start)
{
    return start.shape != SHAPE_NONE && shape_is_on_primitive(start.shape);
}

// A node of a composite's tree; see scene.h.
typedef struct TreeNode {
    NodeOp op;
    bool is_inverse;
    uint32_t parent;      // of the geometry; NODE_NONE: the root
    uint32_t child_count; // but for bounds
    uint32_t needed;      // it is inside (before is_inverse) when so many children are
    uint32_t idle_inside; // children that a line is inside of when it crosses no leaf
} TreeNode;

enum { CSG_PLAIN_MOST = 8 };

typedef struct CsgPrimitives CsgPrimitives; // csg_primitives.h

typedef struct CsgTree {
    uint32_t first_node, node_count;
    uint32_t first_primitive, primitive_count;
    uint32_t crossing_count; // of one ray, at most
    uint32_t interval_most;  // of one of its primitives
    uint8_t hidden;
    bool is_plain;  // all of a few convex primitives in one node
    bool is_meet;   // what convex primitives, any number of them, have in common
    bool is_convex : 1;   // its primitives are
    bool has_bounds : 1;  // some of its nodes are, beside such as are asked before all else
    bool asks_bounds : 1; // some are asked before all else, and no others are
    uint32_t order;
    uint32_t seen_count; // its primitives from there on only clip others
    uint32_t mesh_count;
    CsgPrimitives *parts; // of many; NULL: they are few; owned
} CsgTree;

// What stands for itself: a primitive, or a CSG tree when the number is not below primitive_count, or behind those a
// cluster of such items; of a primitive that has a test in lanes with a bit that tells it, so that nobody need look at
// it. One without a box has the bit only if it is a quadric.
typedef uint32_t ShapeItem;
#define ITEM_LANES 0x80000000u

static inline uint32_t item_index(ShapeItem item)
{
    return item & ~ITEM_LANES;
}

// Whether some rays are tested against primitives of that kind at once (trace/primitive_lanes.h).
static inline bool kind_has_lanes(PrimitiveKind kind)
{
    const unsigned kinds = 1u << PRIMITIVE_SPHERE | 1u << PRIMITIVE_BOX | 1u << PRIMITIVE_CONE | 1u << PRIMITIVE_DISC |
                           1u << PRIMITIVE_TRIANGLE | 1u << PRIMITIVE_SMOOTH_TRIANGLE | 1u << PRIMITIVE_TORUS |
                           1u << PRIMITIVE_POLYNOMIAL | 1u << PRIMITIVE_BLOB | 1u << PRIMITIVE_PRISM;
    return kinds >> kind & 1;
}

// Whether points and normals on them are computed for some rays at once, too (trace/shapes_surface.h).
static inline bool kind_has_surface_lanes(PrimitiveKind kind)
{
    const unsigned others = 1u << PRIMITIVE_POLYNOMIAL | 1u << PRIMITIVE_BLOB | 1u << PRIMITIVE_PRISM;
    return kind_has_lanes(kind) && !(others >> kind & 1);
}

// Whether that is so by trace/curve_lanes.h, and then of which primitives of the kind: tori that do not go through
// themselves, closed surfaces of order 4, and blobs.
static inline bool kind_is_curve(PrimitiveKind kind)
{
    return kind == PRIMITIVE_TORUS || kind == PRIMITIVE_POLYNOMIAL || kind == PRIMITIVE_BLOB;
}

static inline bool primitive_is_curve(const PreparedPrimitive *primitive)
{
    switch (primitive->kind) {
    case PRIMITIVE_TORUS: return primitive->data[0].y <= primitive->data[0].x;
    case PRIMITIVE_POLYNOMIAL:
        return !prepared_is_endless(primitive) && polynomial_order(primitive->list.items) == 4;
    default: return primitive->kind == PRIMITIVE_BLOB;
    }
}

// Of quadrics the test in lanes tells which rays miss them, and no more.
static inline bool primitive_is_quadric(const PreparedPrimitive *primitive)
{
    return primitive->kind == PRIMITIVE_POLYNOMIAL && polynomial_order(primitive->list.items) == 2;
}

static inline bool primitive_has_lanes(const PreparedPrimitive *primitive)
{
    PrimitiveKind kind = (PrimitiveKind)primitive->kind;
    if (primitive_is_mesh(primitive)) {
        return true;
    }
    if (kind == PRIMITIVE_PRISM) { // with ends, and walls along one axis
        return !(primitive->flags & PRIMITIVE_OPEN) && !outline_is_conic(&primitive->list);
    }
    return kind_is_curve(kind) ? primitive_is_curve(primitive) || primitive_is_quadric(primitive)
                               : kind_has_lanes(kind);
}

// The box of an item as its leaf has it: in the tree's coordinates, rounded outward.
typedef struct ItemBox {
    float low[3], high[3];
} ItemBox;

// Items that stand together, far from all others for their size, with a tree of their own.
typedef struct ShapeCluster {
    Bvh tree;
    const ShapeItem *items; // of the table, in the tree's order
    const ItemBox *boxes;
} ShapeCluster;

struct ShapeTable {
    const Abandon *abandon; // NULL: no ray is left untraced; not owned
    IsosurfaceWorld isosurfaces; // which primitives refer to
    PreparedPrimitive *primitives;
    Pages primitive_pages; // which they are in; owned
    uint32_t primitive_count;
    TreeNode *nodes;
    CsgTree *csg_trees;
    uint32_t node_count, csg_count;
    ShapeItem *items; // unbounded ones first, then those of the tree in its order
    ItemBox *boxes;   // of those of the tree, in its order
    Pages item_pages, box_pages;
    uint32_t unbounded_count, bounded_count;
    Bvh tree; // of the bounded ones; its leaves are runs of their items
    MeshTable **meshes;      // the different ones; owned
    uint32_t *mesh_solids;   // the primitives that are meshes, in their order, which is that of their faces' numbers
    uint32_t mesh_count, mesh_solid_count;
    ShapeCluster *clusters; // NULL: none; owned
    uint32_t cluster_count, clustered_count; // how many items they have, which stand behind the others
};

// The solid that a shape is on which is on a primitive.
uint32_t table_face_primitive(const ShapeTable *table, ShapeId face);
static inline uint32_t table_primitive_index(const ShapeTable *table, ShapeId shape)
{
    return RT_LIKELY(shape_kind(shape) == SHAPE_PRIMITIVE) ? primitive_index(shape)
                                                           : table_face_primitive(table, shape);
}

static inline const PreparedPrimitive *table_primitive(const ShapeTable *table, ShapeId shape)
{
    return &table->primitives[table_primitive_index(table, shape)];
}

// Takes over the scene's primitives and composites, lengths multiplied by 2^-exponent. False when out of memory; the
// table may then be given to shapes_fini.
bool shapes_init(ShapeTable *table, const Scene *scene, int exponent, int threads,
                 const atomic_bool *cancel) RT_MUST_CHECK;
void shapes_fini(ShapeTable *table);
size_t shapes_bytes(const ShapeTable *table);

// Whether what is found of a ray does not count any more.
static inline bool shapes_are_abandoned(const ShapeTable *table)
{
    return table->abandon && trace_is_abandoned(table->abandon);
}

// Whether a ray starts on another surface that a primitive's own may coincide with but for rounding: their families
// have a bit in common. Such a ray has passed what lies within rounding of its start.
static inline bool starts_beside(const ShapeTable *table, RayStart start, const PreparedPrimitive *primitive)
{
    if (start.shape == SHAPE_NONE) {
        return false;
    }
    ShapeKind kind = shape_kind(start.shape);
    uint8_t family = kind == SHAPE_PRIMITIVE ? table->primitives[primitive_index(start.shape)].family
                     : kind == SHAPE_SPHERE  ? FAMILY_ROUND
                                             : FAMILY_STRAIGHT;
    return (family & primitive->family) != 0;
}

// The material of a shape on a primitive.
MaterialIndex shapes_material(const ShapeTable *table, ShapeId shape);

// How far a crossing's t may be off by rounding, `object` being the ray in the space of the shape's solid.
double shapes_error(const ShapeTable *table, const Ray *ray, const Ray *object, double t, ShapeId shape);

// How far along the ray its start may be off the primitive that it starts on.
double shapes_start_error(const ShapeTable *table, const Ray *ray, RayStart start);

// Where the ray hit. The normal points out of what the primitive is in.
Surface shapes_surface(const ShapeTable *table, const Ray *ray, const Hit *hit);

// A ray as a CSG tree is asked by it.
typedef struct CsgRay {
    const Ray *ray;
    RayStart start;
    double start_error;
    double enter; // no crossing lies before, but for rounding
} CsgRay;

// csg.c: offers the nearest crossing of a CSG tree that is seen.
void csg_closest(const ShapeTable *table, const CsgTree *csg, const CsgRay *asked, Foremost *first);

// Where a crossing may be that is off by no more than `error`, and not before `enter`, but for rounding.
RT_ALWAYS_INLINE RootSpan crossing_span(double t, double error, double enter)
{
    RootSpan span = root_span(t, error);
    return (RootSpan){span.from < enter ? enter : span.from, span.to < enter ? enter : span.to};
}

// A crossing of a side of a primitive, into it or out of it.
typedef struct PrimitiveRoot {
    uint32_t index; // of the primitive in the table
    uint8_t side;
    bool leaves;
    double t;
} PrimitiveRoot;

void primitive_offer(const ShapeTable *table, const Ray *ray, const PrimitiveRoot *root, RootSpan span,
                     Foremost *first);

// The same of a face of a mesh, `shape`.
void face_offer(const ShapeTable *table, ShapeId shape, const Ray *ray, double t, RootSpan span, Foremost *first);

#endif
