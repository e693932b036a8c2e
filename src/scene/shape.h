// Scene records of shapes: spheres, planes and primitives, what they are cut to, and which of them are one body.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SHAPE_H
#define SCENE_SHAPE_H

#include <stdbool.h>
#include <stdint.h>

#include "math/transform.h"
#include "math/vec3.h"
#include "scene/formula.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/numbers.h"

// A scene may have many millions of them, so that what they have in common is kept in Scene.sphere_runs.
typedef struct Sphere {
    Vec3 centre;
    double radius; // > 0
    MaterialIndex material;
    uint32_t source; // lower half: scene_sphere_source tells all of it
} Sphere;

// Spheres that follow each other in the order of declaration over all shapes, up to the next run.
typedef struct SphereRun {
    uint32_t first, order; // Scene.spheres; its place in the order of declaration
    uint32_t source;       // upper half, of all of them
} SphereRun;

// All points p with p·normal = distance.
typedef struct Plane {
    Vec3 normal; // unit length
    double distance;
    MaterialIndex material;
    uint32_t order;
    uint64_t source;
} Plane;

// A shape of any other kind, or one that not all rays see, alone or as a leaf of a composite. Each but the plane is a
// fixed shape under an affine map:
//   ball            the unit sphere; a sphere stretched by its transforms is one
//   plane           all points p with p·data[0] = data[1].x, in the scene itself; inside is where p·data[0] is less
//   box             from data[0] to data[1], each coordinate of data[0] no greater
//   cone            z from 0 to 1, of radius 1 + (data[0].x - 1) z; a cylinder when data[0].x = 1, which is the greatest
//   disc            z = 0, from radius data[0].x to 1
//   triangle        <0,0,0>, <1,0,0>, <0,1,0>
//   smooth triangle the same, with normals data[0..2] at the corners that are of length 1 in the scene itself
//   torus           all points at distance data[0].y from the circle of radius data[0].x in y = 0; both are > 0, and their
//                   sum is at least 1/2 and at most 1
//   polynomial      where that of the list is 0 (scene/polynomial.h), within the box from fixed[0] to fixed[1] if that
//                   bounds it
//   blob            where the fields of the list are at its threshold (scene/blob.h), within the box from fixed[0] to
//                   fixed[1]
//   prism           an outline in x and z, from y = fixed[0].y to fixed[1].y, one that is conic y times as large;
//                   fixed[] are its bounds, the list is the outline
//   polygon         an outline of straight pieces in x and y, at z = 0
//   isosurface      where the function of the list is at its threshold (scene/isosurface.h), within the box from fixed[0]
//                   to fixed[1]
//   parametric      the points of a rectangle that the functions of the list give (scene/parametric.h), within the box
//                   from fixed[0] to fixed[1]
//   sweep           what the balls of the list cover (scene/sweep.h), within the box from fixed[0] to fixed[1]; no number
//                   of theirs is greater than 1, and one is at least 1/2
//   ovus            an egg (scene/ovus.h), from -1 to 1 in the coordinates that it is greatest in
//   julia           a Julia fractal (scene/julia.h), within the box from fixed[0] to fixed[1]
//   mesh            the triangles of a Mesh within mesh.low and mesh.high; a solid mesh has an inside
typedef enum PrimitiveKind {
    PRIMITIVE_SPHERE,
    PRIMITIVE_PLANE,
    PRIMITIVE_BOX,
    PRIMITIVE_CONE,
    PRIMITIVE_DISC,
    PRIMITIVE_TRIANGLE,
    PRIMITIVE_SMOOTH_TRIANGLE,
    PRIMITIVE_TORUS,
    PRIMITIVE_POLYNOMIAL,
    PRIMITIVE_BLOB,
    PRIMITIVE_PRISM,
    PRIMITIVE_POLYGON,
    PRIMITIVE_LATHE,
    PRIMITIVE_SOR,
    PRIMITIVE_SUPERELLIPSOID,
    PRIMITIVE_OVUS,
    PRIMITIVE_SWEEP,
    PRIMITIVE_JULIA,
    PRIMITIVE_ISOSURFACE,
    PRIMITIVE_PARAMETRIC,
    PRIMITIVE_MESH,
    PRIMITIVE_MESH_SOLID,
    PRIMITIVE_KINDS
} PrimitiveKind;

typedef enum PrimitiveFlag {
    PRIMITIVE_INVERSE = 1, // inside and outside change places
    PRIMITIVE_OPEN = 2,    // of a cone, prism or sor side 0 alone is seen: not the ends
    PRIMITIVE_UNSEEN = 4,  // clips others, has no surface itself
} PrimitiveFlag;

// Rays that pass a shape as if it were not there.
typedef enum HiddenFrom { HIDDEN_CAMERA = 1, HIDDEN_SHADOW = 2, HIDDEN_MIRROR = 4 } HiddenFrom;

// Whether any ray meets both of two shapes that are hidden from the rays of `a` and of `b`.
static inline bool hidden_meet(uint8_t a, uint8_t b)
{
    return (a | b) != (HIDDEN_CAMERA | HIDDEN_SHADOW | HIDDEN_MIRROR);
}

#define NODE_NONE UINT32_MAX

// What a mesh has in the place of numbers. Each of its faces has one of Scene.face_materials from `materials` on, or,
// where it has no texture of its own, the primitive's material.
typedef struct PrimitiveMesh {
    Vec3 low, high;
    const Mesh *mesh; // of Scene.meshes, or of whoever made the primitive
    uint64_t materials;
} PrimitiveMesh;

typedef struct Primitive {
    PrimitiveKind kind;
    uint8_t flags, hidden;  // PrimitiveFlag, HiddenFrom bits; hidden counts only outside of composites
    uint32_t node;          // of the scene, that it is a leaf of; NODE_NONE alone
    MaterialIndex material; // of no meaning when unseen
    uint32_t order;         // of a leaf: the composite's
    uint32_t body;          // of a leaf: 0 that of the composite, else the number of one within it
    uint64_t source;
    Transform to_world, to_object; // inverse of each other
    union {
        Vec3 data[3];
        struct { // of a kind that has a list of numbers (scene/primitive.h): its bounds or more of them, and the list
            Vec3 fixed[2];
            Numbers list;            // the scene's, once the primitive is added: equal lists are at one place
            const FormulaHost *host; // of a shape whose functions ask for noise or patterns; else NULL
        };
        PrimitiveMesh mesh; // of a mesh
    };
} Primitive;

typedef enum NodeOp {
    NODE_UNION,        // inside where some child is; all surfaces are seen
    NODE_MERGE,        // likewise; no surface inside of another child is seen
    NODE_INTERSECTION, // inside where all children are
    NODE_CLIP,         // likewise; all children but the first are unseen, and those that are bounds do not count
    NODE_BOUND,        // in a NODE_CLIP: a ray that does not come inside of its child sees nothing of the node around
} NodeOp;

typedef struct Node {
    NodeOp op;
    bool is_inverse;
    uint32_t parent; // NODE_NONE: the root
    uint32_t child_count;
    uint32_t first_primitive; // primitives that stand before it in the scene
    uint32_t body;            // as of a primitive
    uint64_t source;
} Node;

// A ray keeps a few words for each leaf and node of a composite on its stack, which these bytes are enough for.
enum {
    COMPOSITE_PRIMITIVES_MOST = 100000,
    COMPOSITE_NODES_MOST = 200000,
    COMPOSITE_PRIMITIVE_STACK = 96,
    COMPOSITE_NODE_STACK = 12
};

// A tree of nodes over primitives. Nodes and primitives stand in the order of the text, a node before what is in it.
typedef struct Composite {
    uint32_t first_node, node_count; // the root first
    uint32_t first_primitive, primitive_count;
    uint32_t start_clips; // children of a NODE_CLIP root, from this one on, that do not count where a ray starts
    uint8_t hidden; // HiddenFrom bits
    uint32_t order;
    uint64_t source;
} Composite;

// A primitive or composite of which the surface does not tell whether a ray starts inside: one that is clipped, turned
// inside out, open, a disc, or with a union in it. It does in a box only; what clips all of it does not count. As in
// POV-Ray.
typedef struct StartShape {
    Vec3 low, high; // of the box
    uint32_t order;
    uint32_t index; // of the primitive, or of the composite
    bool is_composite;
    bool is_endless;        // its box is
    bool is_filled;         // with what `material` holds, and not only its members are
    MaterialIndex material; // of a part of it
} StartShape;

// Shapes that are one body, which has one interior: a ray that is inside of one and meets the next leaves the body.
// Bodies that hold others stand before them, and each shape is in the innermost around it; what is in none is a body by
// itself. Only those are kept that some light may go through.
typedef struct Body {
    uint32_t first, end; // order of its first shape and of the one behind its last
    uint32_t around;     // Scene.bodies, or RECORD_NONE
    uint32_t interior;   // of its first own shape: Scene.interiors, or RECORD_NONE
} Body;

#endif
