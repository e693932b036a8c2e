// The tracer's geometry: scene shapes prepared for rays, and what a ray meets.
//
// Turns Scene records into an immutable Geometry (built once, then const and shared by threads). The queries themselves
// are inline, in trace/query.h and query_surface.h, so that a kernel contains only the shapes its scene has. Knows
// nothing of light, colour or pixels.
//
// Self-hits: a secondary ray says which shape it starts on and to which side it leaves. Outward, that shape is skipped,
// which is exact because each shape is convex or flat; inward, a sphere is met again at t = -2 (P·d)/(d·d). There is no
// tolerance anywhere.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_TRACE_H
#define TRACE_TRACE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/attributes.h"
#include "math/ray.h"
#include "math/vec3.h"
#include "scene/scene.h"

// What a scene's geometry has; a query is given these as a constant and leaves out the rest.
typedef enum TraceFeature {
    TRACE_SPHERES = 1 << 0,    // a few spheres, tested one after the other
    TRACE_SPHERE_BVH = 1 << 1, // many spheres, in a tree (then TRACE_SPHERES is not set)
    TRACE_PLANES = 1 << 2,
    TRACE_PRIMITIVES = 1 << 3, // any other shape, stretched spheres among them
    TRACE_ALL_FEATURES = (1 << 4) - 1,
} TraceFeature;

// A shape of a Geometry: its kind in the top two bits, its index in the Geometry's array below. A primitive's index is
// followed by the side of it that was met, in PRIMITIVE_SIDE_BITS. Of a mesh a face is a shape: those of all primitives
// that are meshes are counted one after the other.
typedef uint32_t ShapeId;
enum { SHAPE_INDEX_BITS = 30, PRIMITIVE_SIDE_BITS = 3 };
typedef enum ShapeKind { SHAPE_SPHERE, SHAPE_PLANE, SHAPE_PRIMITIVE, SHAPE_FACE } ShapeKind;
#define SHAPE_NONE UINT32_MAX
#define NO_BLOCKER UINT32_MAX // see geometry_occluded_again

static inline ShapeId shape_id(ShapeKind kind, uint32_t index)
{
    return (uint32_t)kind << SHAPE_INDEX_BITS | index;
}

static inline ShapeKind shape_kind(ShapeId id)
{
    return (ShapeKind)(id >> SHAPE_INDEX_BITS);
}

// Whether it is on a primitive; not of SHAPE_NONE.
static inline bool shape_is_on_primitive(ShapeId id)
{
    return shape_kind(id) >= SHAPE_PRIMITIVE;
}

static inline uint32_t shape_index(ShapeId id)
{
    return id & ((1u << SHAPE_INDEX_BITS) - 1);
}

// Where a ray starts: free in space (SHAPE_NONE), or on a shape, leaving to its outer side or into it; and what it is
// for.
typedef struct RayStart {
    ShapeId shape;
    bool inward;
    uint8_t use; // the HiddenFrom bit that makes a primitive invisible to it; 0: it sees all
} RayStart;

#define RAY_START_FREE   ((RayStart){SHAPE_NONE, false, 0})
#define RAY_START_CAMERA ((RayStart){SHAPE_NONE, false, HIDDEN_CAMERA})

typedef struct Hit {
    double t;      // in units of the ray's direction; > 0
    ShapeId shape;
    bool inside;   // the shape was met from its inside (a plane: from the side its normal points away from)
} Hit;

// The surface at a hit.
typedef struct Surface {
    Vec3 point;
    Vec3 normal; // unit, outward, whatever side was hit
    MaterialIndex material;
    uint32_t order; // of the shape, in the order of declaration
    uint32_t body;  // of a leaf of a composite: Primitive.body, else 0
} Surface;

typedef struct Geometry Geometry;

// Whether rays may be left untraced, since nothing of the picture will be kept.
typedef struct Abandon {
    const atomic_bool *cancel; // turns true when the run is to end; may be NULL
    atomic_bool keeps;         // what is done is a picture already: a tile in work is finished
} Abandon;

static inline bool trace_is_abandoned(const Abandon *abandon)
{
    return abandon->cancel && atomic_load_explicit(abandon->cancel, memory_order_relaxed) &&
           !atomic_load_explicit(&abandon->keeps, memory_order_relaxed);
}

typedef struct GeometryKept GeometryKept; // trace/kept.h

typedef struct GeometryOptions {
    int threads;     // >= 1, for building; the result does not depend on it
    const char *isa; // name of the instruction set to use; NULL for the best that this processor has
    Scene *spent;    // the scene itself, when nobody asks for its spheres later: they are freed as soon as the geometry
                     // has what it needs, and their list is empty then; NULL: they stay
    bool is_shared;  // other processes have the rest of the spheres (trace/elsewhere.h); not with `kept`
    bool has_clear;  // is_shared: one of all their spheres lets light through
    double rays;     // that it is made for, about, if it is kept
    const atomic_bool *cancel; // building is given up, as if memory had run out, when it is set; NULL: never
    GeometryKept *kept; // for prepared_new: what is taken from there, or put there and lives on; NULL: nothing
} GeometryOptions;

// Names of the instruction sets that this processor has and that were built, from plain to best; NULL past the end.
const char *geometry_isa(size_t i);

// Builds the geometry of a valid scene with every length multiplied by 2^-exponent, which is exact. Spheres are kept in
// an order of the tree's own. NULL when out of memory (or when options->isa is none of geometry_isa).
Geometry *geometry_new_with(const Scene *scene, int exponent, const GeometryOptions *options) RT_MUST_CHECK;

// The same on one thread with the best instruction set.
Geometry *geometry_new(const Scene *scene, int exponent) RT_MUST_CHECK;
void geometry_free(Geometry *geometry);

// The TraceFeature bits that this geometry needs.
unsigned geometry_features(const Geometry *geometry);

// The name of the instruction set that it is traced with.
const char *geometry_isa_name(const Geometry *geometry);

// From now on rays need not meet what takes long (composites of many primitives, tiles of many spheres) once this says
// so; NULL: they always do.
void geometry_set_abandon(Geometry *geometry, const Abandon *abandon);

// A point of a surface.
typedef struct SurfaceSpot {
    Vec3 point;
    Vec3 outward; // unit normal
    ShapeId shape;
} SurfaceSpot;

// True when nothing is before any place of a ball, looked at from a surface. May be false where that is so.
bool geometry_sees_ball(const Geometry *geometry, const SurfaceSpot *from, Vec3 centre, double radius);

// True for a disc or triangle, which nothing is inside of.
bool geometry_is_flat(const Geometry *geometry, ShapeId shape);

// The unit normal that a disc or triangle has as it lies, on either side; false for other shapes.
bool geometry_flat_normal(const Geometry *geometry, ShapeId shape, Vec3 *normal);

// Whether a ray that leaves it outward never meets it again.
bool geometry_is_convex(const Geometry *geometry, ShapeId shape);

// Bytes held.
size_t geometry_bytes(const Geometry *geometry);

#endif
