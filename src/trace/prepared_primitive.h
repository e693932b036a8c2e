// A ray against any primitive: prepared primitives, their intervals, and surfaces at a hit. What is known of each kind
// stands in one table, PreparedClass.
//
// The ray is taken into the primitive's own space, where its parameter means the same; its direction is not of unit
// length there. Knows nothing of composites.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_PREPARED_PRIMITIVE_H
#define TRACE_PREPARED_PRIMITIVE_H

#include "math/ray.h"
#include "math/transform.h"
#include "scene/polynomial.h"
#include "scene/primitive.h"
#include "scene/scene.h"
#include "trace/ray_interval.h"
#include "trace/sphere.h"
#include "trace/trace.h"

typedef enum PrimitiveTrait {
    TRAIT_FLAT = 1,   // it has no inside
    TRAIT_CONVEX = 2, // a ray that leaves it outward does not meet it again; nor does one that leaves a flat one
    TRAIT_SIZED = 4,  // as in PrimitiveClass
    TRAIT_MESH = 8,   // it is asked by trace/mesh.h
    TRAIT_TURNS = 16, // as in PreparedClass
    TRAIT_SHEET = 32, // it has no inside, flat or not: which side is met its normal tells
} PrimitiveTrait;

typedef struct MeshTable MeshTable;

// What isosurfaces of one geometry have in common.
typedef struct IsosurfaceWorld {
    double scale;           // of prepared lengths in those of the scene's text
    const Abandon *abandon; // NULL: no ray is left untraced; not owned
} IsosurfaceWorld;

// What an isosurface, a parametric surface or a Julia fractal has in the place of fixed[] and a list.
typedef struct PreparedIsosurface {
    Vec3 low, high;
    const double *list;
    const IsosurfaceWorld *world;
    const FormulaHost *host; // as of a primitive
} PreparedIsosurface;

// What a mesh has in the place of numbers.
typedef struct PreparedMesh {
    Vec3 low, high;
    const MeshTable *table;
    const MaterialIndex *materials; // of the faces' textures
    uint32_t first_face;            // the number of its first one, as a ShapeId has it
    uint32_t cursor;                // in a composite: its place among the meshes
} PreparedMesh;
// How much worse roots of polynomials are than others, as a factor of TRANSFORM_ROUNDING: by 2^-44 of |o| + |t d|.
#define POLYNOMIAL_ROUNDING 12.0

// A primitive as the tracer wants it. The map is kept as a centre and two linear parts, so that no digits are lost far
// from the origin.
typedef struct PreparedPrimitive {
    uint8_t kind, family;  // PrimitiveKind, SurfaceFamily
    uint8_t traits;        // PrimitiveTrait bits
    uint8_t films;         // a bit for each side that is seen and bounds nothing, within the shape
    uint8_t flags, hidden; // of the composite, if it is in one
    bool flips : 1;        // the outside of what the primitive is in is this primitive's inside
    bool is_needed : 1;    // outside of it nothing is seen of the composite
    bool decides : 1;      // likewise, and a line is inside of it once
    bool bounds : 1;       // it is in a NODE_BOUND
    uint32_t node;         // of the geometry; NODE_NONE alone
    uint32_t composite;    // NODE_NONE alone
    uint32_t twin;         // of a ball: the slot of a sphere that equals it, SLOT_NONE if there is none
    MaterialIndex material;
    uint32_t order, body;
    Vec3 centre;
    double extent, spread;      // primitive_measure; extent: 0 where no column has more than one entry
    Vec3 columns;               // lengths of the columns of to_object
    uint8_t entries[3];         // of each column: a bit for each that is not 0
    uint8_t unseen;             // a bit for each side that bounds the inside and is not seen
    uint32_t interval_most;     // of a line, at most; 0: it is flat
    Linear to_object, to_world; // what tests need stands before what surfaces need
    union {
        Vec3 data[3];
        struct { // as of a primitive; the list is the scene's
            Vec3 fixed[2];
            Numbers list;
        };
        PreparedMesh mesh;
        PreparedIsosurface isosurface;
    };
} PreparedPrimitive;

RT_ALWAYS_INLINE bool primitive_is_flat(const PreparedPrimitive *primitive)
{
    return primitive->traits & TRAIT_FLAT;
}

static inline bool prepared_is_endless(const PreparedPrimitive *primitive)
{
    return primitive->kind == PRIMITIVE_PLANE ||
           (primitive->kind == PRIMITIVE_POLYNOMIAL && !polynomial_is_bounded(primitive->list.items));
}

static inline bool primitive_is_mesh(const PreparedPrimitive *primitive)
{
    return primitive->traits & TRAIT_MESH;
}

// How rays meet a kind of primitive; its numbers are those of the primitive, its points in the primitive's own space.
typedef struct PreparedClass {
    // What of the line is inside, in order; returns how many intervals. What is met at the ends is the shape's surface.
    unsigned (*intervals)(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, RayInterval *intervals);
    // The same as far as anybody asks: see polynomial_intervals_within. NULL: nothing is gained.
    unsigned (*intervals_within)(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, double low,
                                 double high, RayInterval *intervals);
    // Of a flat one instead: where it is met.
    bool (*root)(const PreparedPrimitive *primitive, const Ray *object, double *t);
    Vec3 (*normal)(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);
    // A vector along the surface's normal, of any length.
    Vec3 (*gradient)(const PreparedPrimitive *primitive, Vec3 point, uint8_t side);
    Vec3 (*point)(const PreparedPrimitive *primitive, Vec3 point, uint8_t side); // one near the side, put onto it
    // Of a kind without an inside that is not flat, in the place of normal and gradient: a vector along the normal where
    // the line meets it at t. What is met is as near as it is said to be.
    Vec3 (*met)(const PreparedPrimitive *primitive, const Ray *object, double t);
    // The axes of an ellipsoid around it, about *middle.
    void (*axes)(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle);
    bool turns;                // its normals may point in as well as out: which way a ray crosses it tells
    uint8_t films, unseen;     // as of a primitive
    int8_t across[SIDES_MOST]; // of each side: 1 + the axis that it lies across, 0 if it is not flat or across none
} PreparedClass;

extern const PreparedClass prepared_classes[PRIMITIVE_KINDS];

// SIDE_NONE, where an interval has no end, is none.
static inline bool primitive_is_film(const PreparedPrimitive *primitive, uint8_t side)
{
    return primitive->films >> (side & 31) & 1;
}

static inline bool primitive_side_is_unseen(const PreparedPrimitive *primitive, uint8_t side)
{
    return primitive->unseen >> (side & 31) & 1;
}

static inline bool primitive_is_convex(const PreparedPrimitive *primitive)
{
    return primitive->traits & TRAIT_CONVEX;
}

// The ray in the primitive's own space; for a plane as it is.
RT_ALWAYS_INLINE Ray primitive_ray(const PreparedPrimitive *primitive, const Ray *ray)
{
    if (primitive->kind == PRIMITIVE_PLANE) {
        return *ray;
    }
    return (Ray){linear_direction(&primitive->to_object, vec3_sub(ray->origin, primitive->centre)),
                 linear_direction(&primitive->to_object, ray->direction)};
}

// What of the line is inside of a primitive that is not flat, or within its films; `object` is the ray in its space.
// How many intervals, at most as many as the primitive says.
static inline unsigned primitive_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                           RayInterval *intervals)
{
    return prepared_classes[primitive->kind].intervals(primitive, object, left, intervals);
}

static inline unsigned primitive_intervals_within(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                                  double low, double high, RayInterval *intervals)
{
    const PreparedClass *class = &prepared_classes[primitive->kind];
    return class->intervals_within ? class->intervals_within(primitive, object, left, low, high, intervals)
                                   : class->intervals(primitive, object, left, intervals);
}

// How much the ends of an interval may be off at most: it is no longer, and its neighbours are no nearer.
double interval_room(const RayInterval *intervals, unsigned count, unsigned i);

// Where the line meets a flat primitive.
static inline bool primitive_flat_root(const PreparedPrimitive *primitive, const Ray *object, double *t)
{
    return prepared_classes[primitive->kind].root(primitive, object, t);
}

// What the bounds of rounding want of the map: its columns, and as `extent` the sum of the lengths that it gives to the
// fixed shape, more where it makes angles narrow: what its own rounding, and its inverse's, are beside. `spread` is
// that and the sum of the coordinates of the centre.
void primitive_measure(PreparedPrimitive *primitive);

// How far a crossing's t may be off by rounding; docs/numerics.md has the bound. Infinite along the surface.
double primitive_crossing_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                                uint8_t side);

// The same of a plane of any normal in the primitive's own space.
double primitive_plane_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t, Vec3 n);

// What is at least that, for less work; `span` is |o| + t |d| of the ray, each |v| the sum of its coordinates' sizes.
// It may be NaN.
double primitive_crossing_bound(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                                uint8_t side, double span);

// The same for a ball, whose crossing is not off by more than its interval is long.
double primitive_ball_error(const PreparedPrimitive *ball, const Ray *ray, const Ray *object, double t);

// The same for an end of an interval. Where the ray grazes a round side the bound has no bounds, but a crossing is not
// off by more than `length`, interval_room. 0 for an end that is infinite.
double primitive_end_error(const PreparedPrimitive *primitive, const Ray *ray, const Ray *object, double t,
                           uint8_t side, double length);

// The point of a hit put back onto the side, and the primitive's own outward unit normal there.
void primitive_surface(const PreparedPrimitive *primitive, const Ray *ray, double t, uint8_t side, Vec3 *point,
                       Vec3 *normal);

// True when two primitives are the same surface, declared twice.
bool primitive_equal(const PreparedPrimitive *a, const PreparedPrimitive *b);

#endif
