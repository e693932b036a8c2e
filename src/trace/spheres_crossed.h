// All crossings of rays to a light with few spheres and a plane, found from the rays' starts: part of spheres_kernel.c.
//
// A walk from one crossing to the next, each found from the one before (render/shade/shade_light.h), meets the same
// surfaces in the same order wherever that is certain: every crossing of a line, and the place of its end, is
// distinguished from the next by more than all that rounding does on a walk's way. What is not so certain is left to be
// walked.
//
// Each start of the walk's rays is off the line by less than 2^-50 W, where no coordinate is beyond W, and there are
// fewer than 2^7 of them: by less than 2^-43 W in all. That, and rounding here, change r² - |l|² and |f|² - r² by less
// than 2^-41 W², and, those being beyond CROSSED_UNCERTAINTY W², roots by less than 2^-41 W² / (2 sqrt(2^-30) W) =
// 2^-27 W.
//
// SPDX-License-Identifier: MIT
#ifndef TRACE_SPHERES_CROSSED_H
#define TRACE_SPHERES_CROSSED_H

#include "trace/plane.h"
#include "trace/simd.h"
#include "trace/spheres.h"
#include "trace/spheres_secondary.h"

#define CROSSED_UNCERTAINTY 0x1p-30 // of W², for r² - |l|² and |f|² - r²
#define CROSSED_APART 0x1p-25 // of W, for two roots
#define CROSSED_GRAZE 0x1p-14 // of W: how far from the middle both roots are at most where it is grazed

// Crossings by their roots, which rise or fall.
typedef struct CrossedList {
    int count;
    double t[SPHERES_FEW_MOST + 1];
    ShapeId shape[SPHERES_FEW_MOST + 1];
} CrossedList;

// Lines, some at once.
typedef struct CrossedLines {
    SphereRays rays;
    Doubles end;
    Doubles uncertainty, apart, graze; // what the names above stand for
    DoublesMask inward;          // into what they start on
} CrossedLines;

// A vector of rays.
typedef struct CrossedVector {
    CrossedLines lines;
    DoublesMask is_open;                     // not certain
    CrossedList into[DOUBLES], out[DOUBLES]; // the roots of the first rise, those of the second fall
} CrossedVector;

// Lines and spheres, one of each.
typedef struct CrossedPairs {
    DoublesMask into, out, is_open; // where the line goes in before its end, and out; where that is not certain
    Doubles near_side, far_side;
} CrossedPairs;

// Beyond every coordinate of spheres and plane. 0: some sphere is so small beside that, that little would be certain.
static double crossed_reach(const SphereTable *table, const PlaneShape *plane)
{
    double reach = fmax(table->reach, plane ? fabs(plane->distance) : 0.0);
    return table->radius_least >= 0x1p-9 * reach && reach < 0x1p200 && reach > 0x1p-200 ? reach : 0.0;
}

// What is computed of origin, direction and end, where no other coordinate is beyond `reach`.
RT_ALWAYS_INLINE void crossed_lines_begin(CrossedLines *v, double reach)
{
    const Vec3s o = v->rays.origin;
    Doubles beyond = doubles_splat(reach) + doubles_abs(o.x) + doubles_abs(o.y) + doubles_abs(o.z);
    v->uncertainty = CROSSED_UNCERTAINTY * beyond * beyond;
    v->apart = CROSSED_APART * (beyond + doubles_abs(v->end));
    v->graze = CROSSED_GRAZE * beyond;
}

// Those that may be asked for at all.
RT_ALWAYS_INLINE DoublesMask crossed_lines_usable(const CrossedLines *v)
{
    return (v->rays.inverse_square > 0.5) & (v->rays.inverse_square < 2.0) & (v->end > v->apart);
}

static void crossed_load(CrossedVector *v, const TileSurfaces *from, const SurfaceRays *rays, int at, double reach)
{
    v->lines.rays = sphere_rays_make(vec3s_load(from->point, at), vec3s_load(rays->towards, at));
    Doubles cosine = vec3s_dot(vec3s_load(from->outward, at), v->lines.rays.direction);
    v->lines.end = doubles_load(&rays->distance[at]);
    crossed_lines_begin(&v->lines, reach);
    v->lines.inward = cosine < 0.0;
    v->is_open = ~(crossed_lines_usable(&v->lines) & (doubles_abs(cosine) > 0x1p-40));
    for (int i = 0; i < DOUBLES; i++) {
        v->into[i].count = v->out[i].count = 0;
    }
}

// Adds a crossing where it belongs.
RT_ALWAYS_INLINE void crossed_insert(CrossedList *list, bool rises, double t, ShapeId shape)
{
    int place = list->count++;
    for (; place > 0 && (rises ? list->t[place - 1] > t : list->t[place - 1] < t); place--) {
        list->t[place] = list->t[place - 1];
        list->shape[place] = list->shape[place - 1];
    }
    list->t[place] = t;
    list->shape[place] = shape;
}

// To the lists of some rays.
RT_ALWAYS_INLINE void crossed_add(CrossedList *lists, bool rises, unsigned rays, Doubles roots, ShapeId shape)
{
    _Alignas(64) double t[DOUBLES];
    doubles_store(t, roots);
    for (; rays; rays &= rays - 1) {
        unsigned i = (unsigned)__builtin_ctz(rays);
        crossed_insert(&lists[i], rises, t[i], shape);
    }
}

// Of roots that are met, those before the line's end.
RT_ALWAYS_INLINE DoublesMask crossed_before(const CrossedLines *v, DoublesMask met, Doubles root, DoublesMask *is_open)
{
    DoublesMask before = root < v->end - v->apart;
    *is_open |= met & ~before & ~(root > v->end + v->apart);
    return met & before;
}

// Those of `own` start on the sphere. False when none of `asked` has anything to do with it.
RT_ALWAYS_INLINE bool crossed_pairs(const CrossedLines *v, const Balls *ball, DoublesMask own, unsigned asked,
                                    CrossedPairs *pairs)
{
    Vec3s f = vec3s_sub(v->rays.origin, ball->centre);
    Doubles t_middle, discriminant = spheres_discriminant(&v->rays, f, ball->radius_squared, &t_middle);
    Doubles c = vec3s_length_squared(f) - ball->radius_squared;
    Doubles half = doubles_sqrt(doubles_abs(discriminant) * v->rays.inverse_square);
    pairs->near_side = t_middle - half;
    // What it starts outside of and goes away from, or reaches after its end, is not met.
    DoublesMask passed = ((c > v->uncertainty) & ((t_middle < 0.0) | (pairs->near_side > v->end + v->graze))) |
                         ~(discriminant > -v->uncertainty);
    DoublesMask possible = ~own & ~passed, goes_out = possible | (own & v->inward);
    if (!(doubles_mask_bits(goes_out) & asked)) {
        return false;
    }
    pairs->far_side = doubles_choose(own, 2.0 * t_middle, t_middle + half);
    pairs->is_open = possible & ~((discriminant > v->uncertainty) & (doubles_abs(c) > v->uncertainty));
    pairs->into = crossed_before(v, possible & (c > 0.0), pairs->near_side, &pairs->is_open);
    pairs->out = crossed_before(v, goes_out, pairs->far_side, &pairs->is_open);
    return true;
}

// One sphere; the rays of `starts` start on it.
RT_ALWAYS_INLINE void crossed_sphere(CrossedVector *v, const SphereData *ball, ShapeId shape, unsigned starts,
                                     unsigned asked)
{
    const Balls balls = {vec3s_splat(ball->centre), doubles_splat(ball->radius_squared)};
    DoublesMask own = starts ? doubles_bits_mask(starts) : (DoublesMask){0};
    CrossedPairs pairs;
    if (crossed_pairs(&v->lines, &balls, own, asked, &pairs)) {
        v->is_open |= pairs.is_open;
        unsigned open = ~doubles_mask_bits(v->is_open) & asked;
        crossed_add(v->into, true, doubles_mask_bits(pairs.into) & open, pairs.near_side, shape);
        crossed_add(v->out, false, doubles_mask_bits(pairs.out) & open, pairs.far_side, shape);
    }
}

// Lines and a plane; those of `own` start on it. Where they run along it, only its distance may say that it is not met.
RT_ALWAYS_INLINE DoublesMask crossed_plane(const CrossedLines *v, const PlaneShape *plane, DoublesMask own,
                                           Doubles *root, DoublesMask *is_open)
{
    Vec3s n = vec3s_splat(plane->normal);
    Doubles along = vec3s_dot(n, v->rays.direction);
    Doubles height = plane->distance - vec3s_dot(n, v->rays.origin);
    *root = height / along;
    DoublesMask ahead = ~own & ~((*root < -v->apart) | (doubles_abs(height) > 2.0 * v->end));
    *is_open |= ahead & ~((*root > v->apart) & (doubles_abs(along) > CROSSED_GRAZE));
    return crossed_before(v, ahead, *root, is_open);
}

// Both lists of a ray in one; false when two crossings are not distinguished.
static bool crossed_merge(const CrossedList *into, const CrossedList *out, double apart, ShapeId *shapes)
{
    int in = 0, left = out->count;
    double last = 0.0;
    for (int k = 0; k < into->count + out->count; k++) {
        bool is_into = in < into->count && (left == 0 || into->t[in] < out->t[left - 1]);
        double t = is_into ? into->t[in] : out->t[left - 1];
        shapes[k] = is_into ? into->shape[in] : out->shape[left - 1];
        if (!(t - last > apart)) {
            return false;
        }
        in += is_into;
        left -= !is_into;
        last = t;
    }
    return true;
}

// The rays of a vector for which the crossings are known.
static unsigned crossed_end(const CrossedVector *v, unsigned asked, int at, TileCrossings *crossings)
{
    unsigned known = 0;
    for (unsigned open = ~doubles_mask_bits(v->is_open) & asked; open; open &= open - 1) {
        unsigned i = (unsigned)__builtin_ctz(open);
        crossings->count[(unsigned)at + i] = (uint8_t)(v->into[i].count + v->out[i].count);
        known |= (unsigned)crossed_merge(&v->into[i], &v->out[i], v->lines.apart[i], crossings->shape[(unsigned)at + i]) << i;
    }
    return known;
}

static uint64_t spheres_crossed(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape,
                                const TileSurfaces *from, const SurfaceRays *rays, uint64_t asked,
                                TileCrossings *crossings)
{
    const unsigned all = (1u << DOUBLES) - 1;
    uint64_t starts[SPHERES_FEW_MOST] = {0}, on_plane = 0, known = 0;
    double reach = crossed_reach(table, plane);
    if (reach == 0.0) {
        return 0;
    }
    for (int i = 0; i < from->count; i++) {
        bool is_sphere = shape_kind(from->shape[i]) == SHAPE_SPHERE;
        *(is_sphere ? &starts[shape_index(from->shape[i])] : &on_plane) |= UINT64_C(1) << i;
    }
    for (int at = 0; at < from->count; at += DOUBLES) {
        unsigned own = (unsigned)(asked >> at) & all;
        CrossedVector v;
        if (!own) {
            continue;
        }
        crossed_load(&v, from, rays, at, reach);
        for (uint32_t i = 0; i < few_slots(table); i++) {
            SphereData ball = sphere_table_ball(table, i);
            if (!isnan(ball.radius_squared)) {
                crossed_sphere(&v, &ball, shape_id(SHAPE_SPHERE, i), (unsigned)(starts[i] >> at) & all, own);
            }
        }
        if (plane) {
            Doubles root;
            DoublesMask met = crossed_plane(&v.lines, plane, doubles_bits_mask(on_plane >> at & all), &root, &v.is_open);
            crossed_add(v.into, true, doubles_mask_bits(met & ~v.is_open) & own, root, plane_shape);
        }
        known |= (uint64_t)crossed_end(&v, own, at, crossings) << at;
    }
    return known;
}

// One ray against a vector of spheres at once. By itself, for what comes after it is not of vectors: GCC 12 leaves their
// upper halves in use there, and all code of narrower ones after it is slow. False: something is not certain.
static __attribute__((noinline)) bool ray_crossed_lists(const SphereTable *table, const PlaneShape *plane,
                                                        ShapeId plane_shape, const Ray *ray, RayStart start,
                                                        double t_max, CrossedList *into, CrossedList *out,
                                                        double *apart)
{
    const unsigned all = (1u << DOUBLES) - 1;
    double reach = crossed_reach(table, plane);
    bool on_sphere = start.shape != SHAPE_NONE && shape_kind(start.shape) == SHAPE_SPHERE;
    uint32_t slot = on_sphere ? shape_index(start.shape) : SLOT_NONE;
    CrossedPairs pairs;
    if (reach == 0.0) {
        return false;
    }
    CrossedLines v = {.rays = sphere_rays_make(vec3s_splat(ray->origin), vec3s_splat(ray->direction)),
                      .end = doubles_splat(t_max)};
    crossed_lines_begin(&v, reach);
    v.inward = (DoublesMask){0} - (int64_t)start.inward;
    if (!(doubles_mask_bits(crossed_lines_usable(&v)) & 1)) {
        return false;
    }
    into->count = out->count = 0;
    for (uint32_t at = 0; at < few_slots(table); at += DOUBLES) {
        const SphereBlock *block = &table->blocks[at / SPHERE_BLOCK];
        uint32_t i = at % SPHERE_BLOCK;
        const Balls balls = balls_load(block, i);
        DoublesMask own = slot - at < DOUBLES ? doubles_bits_mask(1u << (slot - at)) : (DoublesMask){0};
        if (!crossed_pairs(&v, &balls, own, all, &pairs)) {
            continue;
        }
        if (doubles_mask_bits(pairs.is_open)) {
            return false;
        }
        for (unsigned met = doubles_mask_bits(pairs.into); met; met &= met - 1) {
            unsigned k = (unsigned)__builtin_ctz(met);
            crossed_insert(into, true, pairs.near_side[k], shape_id(SHAPE_SPHERE, at + k));
        }
        for (unsigned met = doubles_mask_bits(pairs.out); met; met &= met - 1) {
            unsigned k = (unsigned)__builtin_ctz(met);
            crossed_insert(out, false, pairs.far_side[k], shape_id(SHAPE_SPHERE, at + k));
        }
    }
    if (plane) {
        Doubles root;
        DoublesMask is_open = {0}, own = (DoublesMask){0} - (int64_t)(start.shape == plane_shape);
        DoublesMask met = crossed_plane(&v, plane, own, &root, &is_open);
        if (doubles_mask_bits(is_open)) {
            return false;
        }
        if (doubles_mask_bits(met)) {
            crossed_insert(into, true, root[0], plane_shape);
        }
    }
    *apart = v.apart[0];
    return true;
}

// All that is crossed by one ray.
static bool ray_crossed(const SphereTable *table, const PlaneShape *plane, ShapeId plane_shape, const Ray *ray,
                        RayStart start, double t_max, RayCrossings *crossings)
{
    CrossedList into, out;
    double apart;
    if (!ray_crossed_lists(table, plane, plane_shape, ray, start, t_max, &into, &out, &apart)) {
        return false;
    }
    crossings->count = into.count + out.count;
    return crossed_merge(&into, &out, apart, crossings->shape);
}

#endif
