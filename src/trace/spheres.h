// The spheres of a Geometry: in blocks of eight, as the vector kernels want them, and the nearest of them to a ray.
//
// A slot is a place in a block; slot / 8 is the block. One or two spheres, in the first block, are tested one by one
// here, inline; more, and those of the tree, by SphereKernels, of which there is one set for each instruction set. All
// give the same bits.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_H
#define TRACE_SPHERES_H

#include "base/attributes.h"
#include "base/pages.h"
#include "scene/scene.h"
#include "trace/bvh.h"
#include "trace/foremost.h"
#include "trace/plane.h"
#include "trace/sphere.h"
#include "trace/trace.h"

enum { SPHERE_BLOCK = BVH_LEAF_MOST };

enum { SLOT_NONE = UINT32_MAX };

// Empty slots have the radius NaN.
typedef struct SphereBlock {
    _Alignas(64) double x[SPHERE_BLOCK];
    double y[SPHERE_BLOCK], z[SPHERE_BLOCK], radius_squared[SPHERE_BLOCK];
} SphereBlock;
_Static_assert(sizeof(SphereBlock) == sizeof(BvhNode), "walks fetch blocks and nodes alike");

// What a hit leads to.
typedef struct ShapeInfo {
    MaterialIndex material;
    uint32_t order; // place in the order of declaration
} ShapeInfo;

typedef struct SphereTable {
    const Abandon *abandon; // NULL: no ray is left untraced; not owned
    SphereBlock *blocks;
    ShapeInfo *info;                // of each slot
    Pages block_pages, info_pages;  // which they are in; owned
    uint32_t block_count;
    uint32_t count;       // spheres
    uint32_t loose_count; // of them not in the tree; slots 0 <= i < loose_count
    Bvh bvh;              // of the others; its leaves are BVH_LEAF | block
    double reach, radius_least; // of few: no coordinate of one is beyond the first
} SphereTable;

// Whether some rays are sooner tested against all spheres together, one after the other, than each in the tree.
enum { SPHERES_FEW_MOST = 4 * SPHERE_BLOCK };

RT_ALWAYS_INLINE bool sphere_table_is_few(const SphereTable *table)
{
    return table->block_count * SPHERE_BLOCK <= SPHERES_FEW_MOST;
}

// The nearest hit so far; starts as t = the end of the ray's interval, shape = SHAPE_NONE. While `is_approximate`,
// hit.t is a sphere's root as sphere_test gives it; nearest_refine makes it right.
typedef struct Nearest {
    Hit hit;
    uint32_t order; // of hit.shape
    bool is_approximate;
} Nearest;

enum { TILE_ROW = 8, TILE_RAYS = 64 };

// Rays from one point, of about unit length, in rows of eight neighbours: an 8 x 8 tile of camera rays.
typedef struct SphereTile {
    Vec3 origin;
    _Alignas(64) double direction[3][TILE_RAYS];
    double direction_over_length2[3][TILE_RAYS], inverse_square[TILE_RAYS]; // as in SphereRay
} SphereTile;

// What the rays of a tile meet.
typedef struct TileHits {
    _Alignas(64) double t[TILE_RAYS]; // INFINITY where nothing is met
    _Alignas(64) ShapeId shape[TILE_RAYS]; // SHAPE_NONE there
    uint64_t met, inside;             // a bit for each ray: it meets something; from the inside
} TileHits;

// Foremost of all rays of a tile, whose ways have no end.
typedef struct TileForemost {
    TileHits *hits;
    uint64_t torn;
    _Alignas(64) double from[TILE_RAYS];
    double limit[TILE_RAYS], beaten[TILE_RAYS];
    uint32_t order[TILE_RAYS]; // of shapes that are no primitives
} TileForemost;

// The surfaces that some rays of a tile have met, one after the other.
typedef struct TileSurfaces {
    int count;
    uint8_t ray[TILE_RAYS]; // which of the tile's
    uint64_t inside;        // a bit for each surface
    _Alignas(64) ShapeId shape[TILE_RAYS];
    // Of the ray, where it met the surface, and of length 1 out of the shape.
    _Alignas(64) double direction[3][TILE_RAYS];
    double point[3][TILE_RAYS], outward[3][TILE_RAYS];
} TileSurfaces;

// Rays from surfaces to a point, or to places no farther than `aside` from it.
typedef struct SurfaceRays {
    Vec3 end;
    double end_radius; // no ray ends farther from `end`
    double farthest;   // no distance is greater
    _Alignas(64) double towards[3][TILE_RAYS]; // of about unit length
    double distance[TILE_RAYS];
} SurfaceRays;

// Rays that continue from surfaces of a tile, each from its own point.
typedef struct SecondaryRays {
    int count;
    uint64_t inward; // a bit for each: into the shape that it starts on
    ShapeId start[TILE_RAYS];
    _Alignas(64) double origin[3][TILE_RAYS];
    double direction[3][TILE_RAYS]; // of about unit length
} SecondaryRays;

// Crossings of a line with few spheres and a plane.
enum { CROSSINGS_MOST = 2 * SPHERES_FEW_MOST + 1 };

// What lies on rays from surfaces to their ends, in the order of a walk from one crossing to the next.
typedef struct TileCrossings {
    uint8_t count[TILE_RAYS];
    ShapeId shape[TILE_RAYS][CROSSINGS_MOST];
} TileCrossings;

typedef struct RayCrossings {
    int count;
    ShapeId shape[CROSSINGS_MOST];
} RayCrossings;

// Rays of one point: towards direction + u right - v up.
typedef struct TileView {
    Vec3 origin, direction, right, up;
} TileView;

typedef struct ShapeTable ShapeTable; // trace/shapes.h

// Brings `nearest` up to date with all spheres, and settles it; returns whether one is met at 0 < t < t_max. Spheres equal
// to that of the slot `start`, which may be SLOT_NONE, are passed over.
typedef struct SphereKernels {
    const char *name;
    bool (*is_supported)(void);
    void (*closest)(const SphereTable *table, const SphereRay *ray, uint32_t start, Nearest *nearest);
    bool (*occluded)(const SphereTable *table, const SphereRay *ray, uint32_t start, double t_max);
    // What each ray of a tile meets. False when the rays are too far apart, or their origin too far away,
    // to be traced together; `hits` mean nothing then.
    bool (*closest_tile)(const SphereTable *table, const SphereTile *tile, TileHits *hits);
    // Fills in point, normal, direction and shape of surfaces whose `count` >= 1 and `ray` are given, and what is after
    // them up to a whole vector. Returns those that are spheres and done; the others' points and normals are open.
    uint64_t (*surfaces)(const SphereTable *table, const SphereTile *tile, const TileHits *hits,
                         TileSurfaces *surfaces);
    // What rays that continue meet of few spheres and of a plane that nothing coincides with (NULL: there is none).
    // Returns those for which that is decided; `hits` mean nothing for the others. Writes what is after the rays up to
    // a whole vector.
    uint64_t (*closest_secondary)(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape,
                                  SecondaryRays *rays, TileHits *hits);
    // `surfaces` for such rays.
    uint64_t (*surfaces_secondary)(const SphereTable *table, const SecondaryRays *rays, const TileHits *hits,
                                   TileSurfaces *surfaces);
    // Of the surfaces `asked` for, those with a sphere, the loose ones too, before the ray's end, as `occluded` would say
    // of each. What does not pay, or cannot be done, for some together is `left` to be asked one by one.
    uint64_t (*occluded_surfaces)(const SphereTable *table, const TileSurfaces *from, const SurfaceRays *rays,
                                  uint64_t asked, uint64_t *left);
    // All that few spheres and such a plane have on the ways of the surfaces `asked` for. Returns those for which that
    // is decided, which may be none.
    uint64_t (*crossed)(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape, const TileSurfaces *from,
                        const SurfaceRays *rays, uint64_t asked, TileCrossings *crossings);
    // The same of one ray: whether it is decided.
    bool (*ray_crossed)(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape, const Ray *ray,
                        RayStart start, double t_max, RayCrossings *crossings);
    // Brings hits up to date with a plane that nothing coincides with. Returns the rays that meet it exactly where they
    // meet something else; these are left as they are.
    uint64_t (*plane_closest)(const PlaneShape *plane, ShapeId shape, const SphereTile *tile, TileHits *hits);
    // Makes a plane the first of those of a tile's rays that have met nothing so far, as foremost_offer does. Returns the
    // rays that are left to that, which are as they were.
    uint64_t (*plane_foremost)(const PlaneShape *plane, ShapeId shape, uint32_t order, const SphereTile *tile,
                               TileForemost *all);
    // The surfaces with that plane before the ray's end; never those of the plane itself.
    uint64_t (*plane_occluded)(const PlaneShape *plane, ShapeId shape, const TileSurfaces *from,
                               const SurfaceRays *rays);
    // The rays of a view at 64 places, with the bits that vec3_normalize and sphere_ray_make give. False when one of
    // them is not usable.
    bool (*view_tile)(const TileView *view, const double u[TILE_RAYS], const double v[TILE_RAYS], SphereTile *tile);
    // Whether it is certain, before the rays are made, that none of them meets a sphere. Never where there is a tree.
    bool (*view_passes)(const SphereTable *table, const TileView *view, const double u[TILE_RAYS],
                        const double v[TILE_RAYS]);
    // Offers what the ray meets of all other shapes. `start_error`: how far along the ray its start may be off the
    // surface that it starts on; less than 0: not known, and that is a primitive.
    void (*shapes_closest)(const ShapeTable *shapes, const Ray *ray, RayStart start, double start_error,
                           Foremost *first);
    // The same for all rays of a tile, of the camera.
    void (*shapes_closest_tile)(const ShapeTable *shapes, const SphereTile *tile, TileForemost *first);
    // True when any of them is met at 0 < t < t_max.
    // In *blocker what was met, if any was; what is there before, unless it is NO_BLOCKER, is known not to be.
    bool (*shapes_occluded)(const ShapeTable *shapes, const Ray *ray, RayStart start, double start_error, double t_max,
                            uint32_t *blocker);
    // The same of that alone.
    bool (*shape_blocks)(const ShapeTable *shapes, const Ray *ray, RayStart start, double start_error, double t_max,
                         uint32_t blocker);
    // Of the surfaces `asked` for, those with any of them before the ray's end, as shapes_occluded would say of each.
    // What does not pay, or cannot be done, for some together is `left`.
    uint64_t (*shapes_occluded_surfaces)(const ShapeTable *shapes, const TileSurfaces *from, const SurfaceRays *rays,
                                         const double start_error[TILE_RAYS], uint64_t asked, uint64_t *left);
    // Fills in point and normal of the surfaces `asked` for whose kind has a test in lanes, as shapes_surface has them, and
    // returns those; `surfaces` of the spheres comes first. Rays are from one point, `apart` = 0, or each from its own, 1.
    uint64_t (*shapes_surfaces)(const ShapeTable *shapes, const double *const origin[3], unsigned apart,
                                const TileHits *hits, uint64_t asked, TileSurfaces *surfaces);
} SphereKernels;

// The kernels of an instruction set by name, or, for NULL, the best that this processor has. NULL when it has not.
const SphereKernels *sphere_kernels_choose(const char *name);

// The kernels in their order from plain to best, whether this processor has them or not; NULL past the end.
const SphereKernels *sphere_kernels_at(size_t i);

// All usable spheres of the scene, lengths times 2^-exponent; `spent` as in GeometryOptions. Behind the blocks there is
// room for `spare` others, which no ray meets. False when out of memory; fini is to be called anyway.
bool sphere_table_init(SphereTable *table, const Scene *scene, int exponent, int threads, Scene *spent, size_t spare,
                       const atomic_bool *cancel) RT_MUST_CHECK;
void sphere_table_fini(SphereTable *table);

// One of the vectors whose components stand apart, and back.
RT_ALWAYS_INLINE void lane_set(double lanes[3][TILE_RAYS], unsigned i, Vec3 a)
{
    lanes[0][i] = a.x;
    lanes[1][i] = a.y;
    lanes[2][i] = a.z;
}

RT_ALWAYS_INLINE Vec3 lane_get(const double lanes[3][TILE_RAYS], unsigned i)
{
    return vec3(lanes[0][i], lanes[1][i], lanes[2][i]);
}

RT_ALWAYS_INLINE void sphere_tile_set(SphereTile *tile, unsigned i, const SphereRay *ray)
{
    lane_set(tile->direction, i, ray->direction);
    lane_set(tile->direction_over_length2, i, ray->direction_over_length2);
    tile->inverse_square[i] = ray->inverse_square;
}

RT_ALWAYS_INLINE SphereRay sphere_tile_ray(const SphereTile *tile, unsigned i)
{
    return (SphereRay){tile->origin, lane_get(tile->direction, i), lane_get(tile->direction_over_length2, i),
                       tile->inverse_square[i]};
}

RT_ALWAYS_INLINE void tile_hit_set(TileHits *hits, unsigned i, const Hit *hit)
{
    uint64_t bit = UINT64_C(1) << i;
    hits->t[i] = hit->t;
    hits->shape[i] = hit->shape;
    hits->met = (hits->met & ~bit) | (hit->shape != SHAPE_NONE ? bit : 0);
    hits->inside = (hits->inside & ~bit) | (hit->inside ? bit : 0);
}

RT_ALWAYS_INLINE Vec3 tile_surface_point(const TileSurfaces *surfaces, int i)
{
    return lane_get(surfaces->point, (unsigned)i);
}

RT_ALWAYS_INLINE Vec3 tile_surface_outward(const TileSurfaces *surfaces, int i)
{
    return lane_get(surfaces->outward, (unsigned)i);
}

RT_ALWAYS_INLINE void tile_surface_set(TileSurfaces *surfaces, int i, Vec3 point, Vec3 outward)
{
    lane_set(surfaces->point, (unsigned)i, point);
    lane_set(surfaces->outward, (unsigned)i, outward);
}

// Adds a ray.
RT_ALWAYS_INLINE void secondary_ray_add(SecondaryRays *rays, Vec3 origin, Vec3 direction, ShapeId start, bool is_inward)
{
    unsigned i = (unsigned)rays->count++;
    rays->start[i] = start;
    rays->inward |= (uint64_t)is_inward << i;
    lane_set(rays->origin, i, origin);
    lane_set(rays->direction, i, direction);
}

RT_ALWAYS_INLINE Ray secondary_ray(const SecondaryRays *rays, unsigned i)
{
    return (Ray){lane_get(rays->origin, i), lane_get(rays->direction, i)};
}

RT_ALWAYS_INLINE SphereData sphere_table_ball(const SphereTable *table, uint32_t slot)
{
    const SphereBlock *block = &table->blocks[slot / SPHERE_BLOCK];
    uint32_t at = slot % SPHERE_BLOCK;
    return (SphereData){{block->x[at], block->y[at], block->z[at]}, block->radius_squared[at]};
}

// Equal distances: the shape that was declared first is seen. Both roots are right to the last rounding.
RT_ALWAYS_INLINE void nearest_offer(Nearest *nearest, double t, ShapeId shape, bool inside, uint32_t order)
{
    if (t > 0.0 && (t < nearest->hit.t ||
                    (t == nearest->hit.t && nearest->hit.shape != SHAPE_NONE && order < nearest->order))) {
        *nearest = (Nearest){{t, shape, inside}, order, false};
    }
}

// Refines an approximate root.
RT_ALWAYS_INLINE void nearest_refine(const SphereTable *table, const SphereRay *ray, Nearest *nearest)
{
    if (nearest->is_approximate) {
        SphereData ball = sphere_table_ball(table, shape_index(nearest->hit.shape));
        nearest->hit.t = sphere_refine(ray, &ball, nearest->hit.t);
        nearest->is_approximate = false;
    }
}

// Up to here a root of sphere_test may yet turn out to be the nearest.
RT_ALWAYS_INLINE double nearest_limit(double t_max)
{
    return t_max + SPHERE_ROOT_SLACK * t_max;
}

// Two refined roots that differ by no more than this share of the greater, four ulps at most, may be in the wrong
// order.
#define SPHERE_TIE 0x1p-51

// A root of a sphere of the table.
typedef struct SphereRoot {
    uint32_t slot;
    SphereData ball;
    double t;
    bool inside;
    bool is_approximate; // sphere_test's
} SphereRoot;

// A sphere that is met about where another one is, which the roots must tell apart once they are refined. Equal roots
// are those of equal spheres, or as good as equal: then the order of declaration decides.
RT_SELDOM void nearest_offer_tie(const SphereTable *table, const SphereRay *ray, const SphereRoot *root,
                                 Nearest *nearest)
{
    const SphereData *ball = &root->ball;
    uint32_t order_own = table->info[root->slot].order;
    nearest_refine(table, ray, nearest);
    double t = root->is_approximate ? sphere_refine(ray, ball, root->t) : root->t;
    bool is_nearer = t < nearest->hit.t;
    if (t > 0.0 && nearest->hit.shape != SHAPE_NONE) {
        SphereData other = sphere_table_ball(table, shape_index(nearest->hit.shape));
        if (fabs(t - nearest->hit.t) <= SPHERE_TIE * nearest->hit.t || vec3_equal(ball->centre, other.centre)) {
            int order = sphere_roots_compare(ray, ball, root->inside, &other, nearest->hit.inside, t);
            is_nearer = order < 0 || (order == 0 && order_own < nearest->order);
        }
    }
    if (t > 0.0 && is_nearer) {
        *nearest = (Nearest){{t, shape_id(SHAPE_SPHERE, root->slot), root->inside}, order_own, false};
    }
}

// A sphere that is met, by sphere_test or by sphere_exact. Roots are refined only where approximate
// ones could be taken in the wrong order, so in the end the same sphere is nearest as if all had been.
RT_ALWAYS_INLINE void nearest_offer_sphere(const SphereTable *table, const SphereRay *ray, const SphereRoot *root,
                                           Nearest *nearest)
{
    double t = root->t;
    double slack = SPHERE_ROOT_SLACK * nearest->hit.t;
    if (!(t > 0.0) || t > nearest->hit.t + slack) {
        return;
    }
    if (RT_LIKELY(t < nearest->hit.t - slack || isinf(nearest->hit.t))) {
        *nearest = (Nearest){{t, shape_id(SHAPE_SPHERE, root->slot), root->inside},
                             table->info[root->slot].order,
                             root->is_approximate};
    } else {
        nearest_offer_tie(table, ray, root, nearest);
    }
}

RT_SELDOM bool sphere_refined_is_before(const SphereRay *ray, const SphereData *ball, double t, double t_max)
{
    return sphere_refine(ray, ball, t) < t_max;
}

// Whether an approximate root is before t_max once it is refined.
RT_ALWAYS_INLINE bool sphere_root_is_before(const SphereRay *ray, const SphereData *ball, double t, double t_max)
{
    double slack = SPHERE_ROOT_SLACK * t_max;
    if (t < t_max - slack || isinf(t_max)) {
        return true;
    }
    return t <= t_max + slack && sphere_refined_is_before(ray, ball, t, t_max);
}

#endif
