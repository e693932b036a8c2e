// Scene shapes prepared for rays: scaled and put into arrays of their kind; the spheres by trace/spheres.h.
//
// Everything is worked out from the scaled lengths alone, so that a scene scaled by 2^k and prepared with an exponent
// greater by k gives the same Geometry bit for bit.
//
// SPDX-License-Identifier: MIT
#include "trace/geometry.h"

#include <math.h>
#include <stdlib.h>

static Vec3 vec3_ldexp(Vec3 a, int exponent)
{
    return vec3(ldexp(a.x, exponent), ldexp(a.y, exponent), ldexp(a.z, exponent));
}

// The linear part only, with every entry times 2^exponent.
static Transform linear_ldexp(const Transform *transform, int exponent)
{
    Transform linear = {0};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++) {
            linear.m[row][column] = ldexp(transform->m[row][column], exponent);
        }
    }
    return linear;
}

static bool ellipsoids_init(Geometry *geometry, const Scene *scene, int exponent)
{
    size_t count = scene->ellipsoids.count;
    if (count == 0) {
        return true;
    }
    geometry->ellipsoids = malloc(count * sizeof(*geometry->ellipsoids));
    if (!geometry->ellipsoids) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        const Ellipsoid *from = &scene->ellipsoids.items[i];
        const double *origin = from->to_world.m[3];
        geometry->ellipsoids[i] = (EllipsoidEntry){
            .shape = {.centre = vec3_ldexp(vec3(origin[0], origin[1], origin[2]), -exponent),
                      .to_world = linear_ldexp(&from->to_world, -exponent),
                      .to_object = linear_ldexp(&from->to_object, exponent)},
            .info = {from->material, from->order},
        };
    }
    geometry->ellipsoid_count = (uint32_t)count;
    geometry->features |= TRACE_ELLIPSOIDS;
    return true;
}

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
    geometry->features |= TRACE_PLANES;
    return true;
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

Geometry *geometry_new_with(const Scene *scene, int exponent, const GeometryOptions *options)
{
    Geometry *geometry = calloc(1, sizeof(*geometry));
    if (!geometry) {
        return NULL;
    }
    geometry->kernels = sphere_kernels_choose(options->isa);
    if (!geometry->kernels || !sphere_table_init(&geometry->spheres, scene, exponent, options->threads) ||
        !ellipsoids_init(geometry, scene, exponent) || !planes_init(geometry, scene, exponent) ||
        !shapes_init(&geometry->shapes, scene, exponent, options->threads)) {
        geometry_free(geometry);
        return NULL;
    }
    uint32_t loose = geometry->spheres.loose_count;
    geometry->features |= geometry->spheres.count > loose ? TRACE_SPHERE_BVH : loose > 0 ? TRACE_SPHERES : 0u;
    geometry->features |= scene->parts.count > 0 ? (unsigned)TRACE_PARTS : 0;
    return geometry;
}

Geometry *geometry_new(const Scene *scene, int exponent)
{
    return geometry_new_with(scene, exponent, &(GeometryOptions){.threads = 1});
}

void geometry_free(Geometry *geometry)
{
    if (geometry) {
        sphere_table_fini(&geometry->spheres);
        free(geometry->ellipsoids);
        free(geometry->planes);
        shapes_fini(&geometry->shapes);
        free(geometry);
    }
}

unsigned geometry_features(const Geometry *geometry)
{
    return geometry->features;
}

size_t geometry_bytes(const Geometry *geometry)
{
    const SphereTable *spheres = &geometry->spheres;
    return sizeof(*geometry) + spheres->block_count * (sizeof(SphereBlock) + SPHERE_BLOCK * sizeof(ShapeInfo)) +
           spheres->bvh.node_count * sizeof(BvhNode) + geometry->ellipsoid_count * sizeof(EllipsoidEntry) +
           geometry->plane_count * sizeof(PlaneEntry) + shapes_bytes(&geometry->shapes);
}

bool geometry_is_flat(const Geometry *geometry, ShapeId shape)
{
    return shape_kind(shape) == SHAPE_PART && geometry->shapes.solids[part_index(shape)].kind >= PART_DISC;
}
