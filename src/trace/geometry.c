// Scene shapes prepared for rays: scaled and put into arrays of their kind; the spheres by trace/spheres.h.
//
// Everything is computed from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
// greater by k gives the same Geometry bit for bit.
//
// SPDX-License-Identifier: MIT
#include "trace/geometry.h"

#include <math.h>
#include <stdlib.h>

#include "scene/primitive_reach.h"
#include "trace/elsewhere.h"
#include "trace/kept.h"

static bool planes_init(Geometry *geometry, const Scene *scene, int exponent)
{
    size_t count = scene->planes.count;
    if (count == 0) {
        return true;
    }
    geometry->planes = malloc(count * sizeof(*geometry->planes));
    if (!geometry->planes) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const Plane *from = &scene->planes.items[i];
        geometry->planes[i] = (PlaneEntry){
            .shape = {from->normal, ldexp(from->distance, -exponent)},
            .info = {from->material, from->order},
        };
    }
    geometry->plane_count = (uint32_t)count;
    return true;
}

// ---- balls that equal spheres

static SphereData primitive_ball(const PreparedPrimitive *primitive)
{
    return sphere_data_make(primitive->centre, fabs(primitive->to_world.m[0][0]));
}

static int place_compare(Vec3 a, Vec3 b)
{
    return a.x != b.x ? (a.x > b.x) - (a.x < b.x) : a.y != b.y ? (a.y > b.y) - (a.y < b.y) : (a.z > b.z) - (a.z < b.z);
}

static int primitive_compare(const void *a, const void *b)
{
    return place_compare((*(PreparedPrimitive *const *)a)->centre, (*(PreparedPrimitive *const *)b)->centre);
}

// The first of `balls`, in order of their centres, that is not before a place.
static size_t first_from(PreparedPrimitive *const *balls, size_t count, Vec3 place)
{
    size_t low = 0;
    while (count > 0) {
        size_t half = count / 2;
        bool is_less = place_compare(balls[low + half]->centre, place) < 0;
        low += is_less ? half + 1 : 0;
        count = is_less ? count - half - 1 : half;
    }
    return low;
}

// Tells balls among the primitives which sphere they equal, so that the two are one surface. Every sphere is looked up
// among the balls, which are few.
static bool coincident_init(Geometry *geometry)
{
    ShapeTable *shapes = &geometry->shapes;
    const SphereTable *spheres = &geometry->spheres;
    PreparedPrimitive **balls = malloc((shapes->primitive_count + 1) * sizeof *balls);
    size_t count = 0;
    for (uint32_t i = 0; balls && i < shapes->primitive_count; i++) {
        PreparedPrimitive *primitive = &shapes->primitives[i];
        primitive->twin = SLOT_NONE;
        if (primitive->kind == PRIMITIVE_SPHERE && primitive_map_is_round(primitive->to_world.m)) {
            balls[count++] = primitive;
        }
    }
    if (count > 0) {
        qsort(balls, count, sizeof(PreparedPrimitive *), primitive_compare);
    }
    for (uint32_t slot = 0; count > 0 && slot < spheres->block_count * SPHERE_BLOCK; slot++) {
        SphereData sphere = sphere_table_ball(spheres, slot);
        for (size_t i = first_from(balls, count, sphere.centre); i < count; i++) {
            SphereData ball = primitive_ball(balls[i]);
            if (!vec3_equal(ball.centre, sphere.centre)) {
                break;
            }
            bool is_first = balls[i]->twin == SLOT_NONE ||
                            spheres->info[slot].order < spheres->info[balls[i]->twin].order;
            balls[i]->twin = sphere_data_equal(&ball, &sphere) && is_first ? slot : balls[i]->twin;
        }
    }
    free(balls);
    return balls != NULL;
}

const char *geometry_isa(size_t i)
{
    const SphereKernels *kernels;
    for (size_t at = 0; (kernels = sphere_kernels_at(at)); at++) {
        if (kernels->is_supported() && i-- == 0) {
            return kernels->name;
        }
    }
    return NULL;
}

static void find_features(Geometry *geometry)
{
    uint32_t loose = geometry->spheres.loose_count;
    geometry->features = geometry->spheres.count > loose ? TRACE_SPHERE_BVH : loose > 0 ? TRACE_SPHERES : 0u;
    geometry->features |= geometry->plane_count > 0 ? (unsigned)TRACE_PLANES : 0;
    geometry->features |= geometry->shapes.primitive_count > 0 ? (unsigned)TRACE_PRIMITIVES : 0;
}

Geometry *geometry_new_with(const Scene *scene, int exponent, const GeometryOptions *options)
{
    Geometry *geometry = calloc(1, sizeof(*geometry));
    if (!geometry) {
        return NULL;
    }
    geometry->kernels = sphere_kernels_choose(options->isa);
    if (!geometry->kernels ||
        !sphere_table_init(&geometry->spheres, scene, exponent, options->threads, options->spent,
                           options->is_shared ? geometry_share_blocks(options->threads) : 0, options->cancel) ||
        !planes_init(geometry, scene, exponent) ||
        !shapes_init(&geometry->shapes, scene, exponent, options->threads, options->cancel) ||
        !coincident_init(geometry)) {
        geometry_free(geometry);
        return NULL;
    }
    find_features(geometry);
    if (options->is_shared && !geometry_share(geometry, scene, options->threads)) {
        geometry_free(geometry);
        return NULL;
    }
    return geometry;
}

Geometry *geometry_new(const Scene *scene, int exponent)
{
    return geometry_new_with(scene, exponent, &(GeometryOptions){.threads = 1});
}

void geometry_free(Geometry *geometry)
{
    if (geometry) {
        elsewhere_free(geometry->elsewhere);
        sphere_table_fini(&geometry->spheres);
        free(geometry->planes);
        shapes_fini(&geometry->shapes);
        free(geometry);
    }
}

// ---- a geometry that is kept

void geometry_kept_change(GeometryKept *kept, size_t begin, size_t end)
{
    SphereRange *all = &kept->changed;
    bool is_first = all->begin == all->end;
    all->begin = is_first || begin < all->begin ? begin : all->begin;
    all->end = is_first || end > all->end ? end : all->end;
}

// What brings it up to date.
typedef struct Follow {
    const Scene *scene;
    int exponent, threads;
    double rays;
    const atomic_bool *cancel;
    bool is_elsewhere;         // all places and lengths are others
    bool is_built, is_changed; // a tree is a new one; any shape is
} Follow;

// The spheres as they are now: by the tree that there is, or by a new one.
static bool kept_take_spheres(GeometryKept *kept, Follow *follow)
{
    SphereTable *spheres = &kept->geometry->spheres;
    size_t count = follow->scene->spheres.count;
    SphereRange changed = follow->is_elsewhere ? (SphereRange){0, count} : kept->changed;
    bool has_more = kept->spheres != count;
    if (!has_more && changed.begin == changed.end) {
        return true;
    }
    follow->is_changed = true;
    const SphereMoves moves = {changed, follow->rays, follow->threads};
    if (!has_more && sphere_table_refit(spheres, &kept->refit, follow->scene, follow->exponent, &moves)) {
        kept->refits++;
        return true;
    }
    follow->is_built = true;
    kept->refit.in_root = 0.0;
    kept->refit.fits = 0;
    sphere_table_fini(spheres);
    return sphere_table_init(spheres, follow->scene, follow->exponent, follow->threads, NULL, 0, follow->cancel);
}

// The rest as it is now.
static bool kept_take_others(GeometryKept *kept, Follow *follow)
{
    Geometry *geometry = kept->geometry;
    const Scene *scene = follow->scene;
    if (follow->is_elsewhere || kept->planes != scene->planes.count) {
        free(geometry->planes);
        geometry->planes = NULL;
        if (!planes_init(geometry, scene, follow->exponent)) {
            return false;
        }
    }
    if ((follow->is_elsewhere && kept->parts > 0) || kept->parts != scene->primitives.count) {
        follow->is_built = follow->is_changed = true;
        shapes_fini(&geometry->shapes);
        return shapes_init(&geometry->shapes, scene, follow->exponent, follow->threads, follow->cancel);
    }
    return true;
}

static bool kept_follow(GeometryKept *kept, const Scene *scene, int exponent, const GeometryOptions *options)
{
    Follow follow = {.scene = scene,
                     .exponent = exponent,
                     .threads = options->threads,
                     .rays = options->rays,
                     .cancel = options->cancel,
                     .is_elsewhere = kept->is_elsewhere || kept->exponent != exponent};
    bool is_done = kept_take_spheres(kept, &follow) && kept_take_others(kept, &follow) &&
                   (!follow.is_changed || coincident_init(kept->geometry));
    kept->geometry->kernels = sphere_kernels_choose(options->isa);
    if (!is_done || !kept->geometry->kernels) {
        geometry_kept_fini(kept);
        return false;
    }
    find_features(kept->geometry);
    kept->builds += follow.is_built;
    return true;
}

Geometry *geometry_kept_take(GeometryKept *kept, const Scene *scene, int exponent, const GeometryOptions *options)
{
    if (!kept->geometry) {
        kept->geometry = geometry_new_with(scene, exponent, options);
        kept->builds++;
        kept->refit = (SphereRefit){0};
    } else if (!kept_follow(kept, scene, exponent, options)) {
        return NULL;
    }
    kept->exponent = exponent;
    kept->spheres = scene->spheres.count;
    kept->planes = scene->planes.count;
    kept->parts = scene->primitives.count;
    kept->changed = (SphereRange){0, 0};
    kept->is_elsewhere = false;
    return kept->geometry;
}

void geometry_kept_fini(GeometryKept *kept)
{
    geometry_free(kept->geometry);
    kept->geometry = NULL;
}

// ---- what it holds

unsigned geometry_features(const Geometry *geometry)
{
    return geometry->features;
}

size_t geometry_bytes(const Geometry *geometry)
{
    const SphereTable *spheres = &geometry->spheres;
    return sizeof(*geometry) + spheres->block_count * (sizeof(SphereBlock) + SPHERE_BLOCK * sizeof(ShapeInfo)) +
           spheres->bvh.node_count * sizeof(BvhNode) + geometry->plane_count * sizeof(PlaneEntry) +
           shapes_bytes(&geometry->shapes);
}

void geometry_set_abandon(Geometry *geometry, const Abandon *abandon)
{
    geometry->spheres.abandon = geometry->shapes.abandon = geometry->shapes.isosurfaces.abandon = abandon;
}

const char *geometry_isa_name(const Geometry *geometry)
{
    return geometry->kernels->name;
}

bool geometry_is_flat(const Geometry *geometry, ShapeId shape)
{
    return shape_is_on_primitive(shape) && primitive_is_flat(table_primitive(&geometry->shapes, shape));
}

bool geometry_flat_normal(const Geometry *geometry, ShapeId shape, Vec3 *normal)
{
    bool is_flat = geometry_is_flat(geometry, shape);
    if (is_flat) {
        const PreparedPrimitive *primitive = table_primitive(&geometry->shapes, shape);
        Vec3 own = primitive_is_mesh(primitive) ? mesh_plane(primitive, shape) : vec3(0.0, 0.0, 1.0);
        *normal = vec3_normalize(linear_normal(&primitive->to_object, own));
    }
    return is_flat;
}

bool geometry_is_convex(const Geometry *geometry, ShapeId shape)
{
    return shape == SHAPE_NONE || !shape_is_on_primitive(shape) ||
           primitive_is_convex(table_primitive(&geometry->shapes, shape));
}
