// Closed meshes are watertight: a ray from inside meets one, whatever it is aimed at, and a line crosses it as often
// inward as outward. The rays go through inner points of faces, through edges and through corners, of meshes that are
// regular, so that edges lie along axes, and of ones with slivers; from the middle, from near a corner, and off the
// mesh as it is placed by a map. Tiles of rays, and what is dark of what they meet, are as single rays say, on every
// instruction set.
//
// test_mesh [rays of a mesh [seed]]; 20 000 if nothing is said, 10^7 in all in `make check-long`; a new seed each run.
//
// SPDX-License-Identifier: MIT
#include "trace/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/mesh_field.h"
#include "unit/random.h"
#include "unit/tap.h"
#include "unit/trace_scenes.h"

enum { AROUND = 24, RINGS = 12 };

static void *need(size_t count, size_t size)
{
    void *memory = calloc(count, size);
    if (!memory) {
        abort();
    }
    return memory;
}

static Mesh *empty_mesh(uint32_t vertices, uint32_t faces)
{
    Mesh *mesh = mesh_new();
    if (!mesh) {
        abort();
    }
    mesh->vertex_count = vertices;
    mesh->face_count = faces;
    mesh->vertices = need(vertices, sizeof *mesh->vertices);
    mesh->faces = need(faces, sizeof *mesh->faces);
    return mesh;
}

static void set_face(Mesh *mesh, uint32_t face, uint32_t a, uint32_t b, uint32_t c)
{
    mesh->faces[face][0] = a;
    mesh->faces[face][1] = b;
    mesh->faces[face][2] = c;
}

// A globe, whose corners are moved along their directions by up to `rough`, and which is `flat` along y.
static Mesh *globe(Random *random, double rough, double flat)
{
    Mesh *mesh = empty_mesh((RINGS - 1) * AROUND + 2, 2 * (RINGS - 1) * AROUND);
    uint32_t top = (RINGS - 1) * AROUND, bottom = top + 1, face = 0;
    for (uint32_t i = 0; i + 1 < RINGS; i++) {
        for (uint32_t k = 0; k < AROUND; k++) {
            double a = M_PI * (i + 1) / RINGS, b = 2.0 * M_PI * k / AROUND;
            double r = 1.0 - rough * random_between(random, 0.0, 1.0);
            float *v = mesh->vertices[i * AROUND + k];
            v[0] = (float)(r * sin(a) * cos(b));
            v[1] = (float)(flat * r * cos(a));
            v[2] = (float)(r * sin(a) * sin(b));
        }
    }
    mesh->vertices[top][1] = (float)flat;
    mesh->vertices[bottom][1] = -(float)flat;
    for (uint32_t k = 0; k < AROUND; k++) {
        uint32_t next = (k + 1) % AROUND, last = (RINGS - 2) * AROUND;
        set_face(mesh, face++, top, k, next);
        set_face(mesh, face++, bottom, last + next, last + k);
        for (uint32_t i = 0; i + 2 < RINGS; i++) {
            set_face(mesh, face++, i * AROUND + k, (i + 1) * AROUND + k, (i + 1) * AROUND + next);
            set_face(mesh, face++, i * AROUND + k, (i + 1) * AROUND + next, i * AROUND + next);
        }
    }
    mesh_measure(mesh);
    mesh->inside_vector = vec3(0.1, 1.0, 0.2);
    mesh->has_inside = true;
    return mesh;
}

// A cube of six faces, each of 2 n n triangles: all edges along axes or diagonals.
static Mesh *cube(uint32_t n)
{
    Mesh *mesh = empty_mesh(6 * (n + 1) * (n + 1), 12 * n * n);
    uint32_t vertex = 0, face = 0;
    for (uint32_t side = 0; side < 6; side++) {
        uint32_t first = vertex, axis = side / 2;
        for (uint32_t i = 0; i <= n; i++) {
            for (uint32_t k = 0; k <= n; k++) {
                float *v = mesh->vertices[vertex++];
                v[axis] = side % 2 ? 1.0F : -1.0F;
                v[(axis + 1) % 3] = 2.0F * (float)i / (float)n - 1.0F;
                v[(axis + 2) % 3] = 2.0F * (float)k / (float)n - 1.0F;
            }
        }
        for (uint32_t i = 0; i < n; i++) {
            for (uint32_t k = 0; k < n; k++) {
                uint32_t at = first + i * (n + 1) + k;
                set_face(mesh, face++, at, at + 1, at + n + 2);
                set_face(mesh, face++, at, at + n + 2, at + n + 1);
            }
        }
    }
    mesh_measure(mesh);
    mesh->inside_vector = vec3(1.0, 0.0, 0.0);
    mesh->has_inside = true;
    return mesh;
}

// A place on the mesh: a corner, on an edge, or within a face.
static Vec3 aim_of(Random *random, const Mesh *mesh)
{
    uint32_t face = (uint32_t)random_below(random, mesh->face_count);
    Vec3 a = mesh_corner(mesh, face, 0), b = mesh_corner(mesh, face, 1), c = mesh_corner(mesh, face, 2);
    double u = random_between(random, 0.0, 1.0), v = random_between(random, 0.0, 1.0 - u);
    switch (random_below(random, 4)) {
    case 0:
        return a;
    case 1:
        return vec3_scale(0.5, vec3_add(a, b));
    case 2:
        return vec3_add(vec3_scale(u, a), vec3_scale(1.0 - u, b));
    default:
        return vec3_add(vec3_add(vec3_scale(u, a), vec3_scale(v, b)), vec3_scale(1.0 - u - v, c));
    }
}

static Vec3 eye_of(Random *random, const Mesh *mesh)
{
    switch (random_below(random, 3)) {
    case 0:
        return vec3(0.0, 0.0, 0.0);
    case 1:
        return vec3_scale(0.5, aim_of(random, mesh));
    default: {
        double share = random_between(random, 0.0, 0.6);
        return vec3_scale(share, aim_of(random, mesh));
    }
    }
}

// How often a line crosses the mesh before it begins and after.
static unsigned count_crossings(const Mesh *mesh, const Ray *ray, bool is_after)
{
    MeshRay shear = mesh_ray_make(ray);
    MeshPoint at;
    unsigned count = 0;
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        count += mesh_ray_crosses(&shear, mesh, face, &at) && (at.t > 0.0) == is_after;
    }
    return count;
}

static Geometry *geometry_of(Scene *scene, Mesh *mesh, Transform to_world)
{
    scene_init(scene);
    Primitive primitive = {.kind = PRIMITIVE_MESH, .node = NODE_NONE, .to_world = to_world};
    primitive.mesh = (PrimitiveMesh){mesh->low, mesh->high, mesh, 0};
    if (!scene_add_mesh(scene, mesh) || !transform_invert(&to_world, &primitive.to_object) ||
        !scene_add_primitive(scene, &primitive)) {
        abort();
    }
    return prepare(scene, 0);
}

// Rays from inside, of which each must meet the mesh; and a few lines by all faces.
static void check_closed(const char *name, Mesh *mesh, Transform to_world, uint64_t rays, uint64_t seed)
{
    Random random = {seed};
    Scene scene;
    Geometry *g = geometry_of(&scene, mesh, to_world);
    uint64_t missed = 0, uneven = 0, apart = 0;
    for (uint64_t i = 0; i < rays; i++) {
        Vec3 eye = transform_point(&to_world, eye_of(&random, mesh));
        Vec3 aim = transform_point(&to_world, aim_of(&random, mesh));
        Ray ray = {eye, vec3_normalize(vec3_sub(aim, eye))};
        Hit hit, any;
        bool is_met = closest(g, ray, RAY_START_FREE, (double)INFINITY, &hit);
        missed += !is_met;
        apart += is_met != geometry_occluded(g, TRACE_ALL_FEATURES, ray, RAY_START_FREE, (double)INFINITY);
        if (i % 64 == 0) {
            Vec3 from = eye_of(&random, mesh);
            Ray own = {from, vec3_sub(aim_of(&random, mesh), vec3(0.01, 0.02, 0.0))};
            unsigned before = count_crossings(mesh, &own, false), after = count_crossings(mesh, &own, true);
            uneven += before % 2 != 1 || after % 2 != 1;
        }
        if (is_met && i % 16 == 0) { // on from there: outward nothing more of a globe, whatever edge it is on
            RayStart start = {hit.shape, false, 0};
            Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
            Ray on = {surface.point, ray.direction};
            apart += closest(g, on, start, (double)INFINITY, &any) && any.shape == hit.shape;
        }
    }
    tap_ok(missed == 0, "%s: of %llu rays %llu slip out", name, (unsigned long long)rays, (unsigned long long)missed);
    tap_ok(uneven == 0, "%s: lines are crossed an odd number of times on either side", name);
    tap_ok(apart == 0, "%s: shadows agree, and a face is not met from itself", name);
    geometry_free(g);
    scene_fini(&scene);
}

static void check_points(void)
{
    Random random = {7};
    Mesh *mesh = globe(&random, 0.0, 1.0);
    tap_ok(mesh_holds(mesh, vec3(0.0, 0.0, 0.0)) && mesh_holds(mesh, vec3(0.0, 0.9, 0.0)), "points inside");
    tap_ok(!mesh_holds(mesh, vec3(0.0, -1.1, 0.0)) && !mesh_holds(mesh, vec3(2.0, 0.0, 0.0)), "points outside");
    mesh->has_inside = false;
    tap_ok(!mesh_holds(mesh, vec3(0.0, 0.0, 0.0)), "without an inside nothing is");
    mesh_free(mesh);
}

static Mesh *field_of(Random *random, uint32_t across, uint32_t along)
{
    Mesh *mesh = mesh_field_new(across, along);
    if (!mesh) {
        abort();
    }
    for (uint32_t i = 0; i < across * along; i++) {
        mesh->field->heights[i] = (uint16_t)random_below(random, FIELD_HEIGHTS);
    }
    mesh_field_build(mesh);
    return mesh;
}

// The face that a ray meets first, of all.
static uint32_t first_face(const Mesh *mesh, const Ray *ray)
{
    MeshRay shear = mesh_ray_make(ray);
    MeshPoint at;
    double nearest = (double)INFINITY;
    uint32_t first = MESH_NO_FACE;
    for (uint32_t face = 0; face < mesh->face_count; face++) {
        if (mesh_ray_crosses(&shear, mesh, face, &at) && at.t > 0.0 && at.t < nearest) {
            nearest = at.t;
            first = face;
        }
    }
    return first;
}

// What a ray meets of a field by its tree is what it meets of all its faces, however narrow the field is and wherever
// between its cells the ray goes.
static void check_field_tree(uint32_t across, uint32_t along, uint64_t seed)
{
    Random random = {seed};
    Scene scene;
    Mesh *mesh = field_of(&random, across, along);
    Geometry *g = geometry_of(&scene, mesh, transform_identity());
    Vec3 size = mesh_field_size(mesh->field);
    uint64_t wrong = 0;
    for (int i = 0; i < 3000; i++) {
        Vec3 eye = vec3_mul(size, random_vec3(&random, -0.5, 1.5)),
             aim = vec3_mul(size, random_vec3(&random, 0.0, 1.0));
        if (i % 2 == 0) {
            aim.x = floor(aim.x);
            eye.x = i % 4 == 0 ? aim.x : eye.x;
            aim.z = i % 3 == 0 ? floor(aim.z) : aim.z;
        }
        Ray ray = {eye, vec3_normalize(vec3_sub(aim, eye))};
        Hit hit;
        uint32_t found =
            closest(g, ray, RAY_START_FREE, (double)INFINITY, &hit) ? shape_index(hit.shape) : MESH_NO_FACE;
        wrong += found != first_face(mesh, &ray);
    }
    tap_ok(wrong == 0, "field of %u x %u heights: of 3000 rays %llu do not meet what is first", across, along,
           (unsigned long long)wrong);
    geometry_free(g);
    scene_fini(&scene);
}

static void check_field_trees(Random *random, uint64_t seed)
{
    const uint32_t sizes[][2] = {{2, 2}, {2, 300}, {300, 2}, {3, 60}, {60, 4}, {5, 3}, {9, 9}, {65, 17}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        check_field_tree(sizes[i][0], sizes[i][1], seed + i);
    }
    const uint32_t across = 2 + random_below(random, 40);
    check_field_tree(across, 2 + random_below(random, 40), seed + 20);
}

// Above a field of heights a line straight up crosses no face, below it one.
static void check_field(uint64_t seed)
{
    Random random = {seed};
    uint32_t across = 2 + random_below(&random, 30), along = 2 + random_below(&random, 30);
    Mesh *mesh = field_of(&random, across, along);
    MeshField *field = mesh->field;
    uint64_t wrong = 0;
    for (int i = 0; i < 3000; i++) {
        Vec3 point = vec3_mul(mesh_field_size(field), random_vec3(&random, -0.1, 1.1));
        MeshRay ray = mesh_ray_make(&(Ray){point, vec3(0.0, 1.0, 0.0)});
        bool is_below = false;
        for (uint32_t face = 0; face < mesh->face_count; face++) {
            MeshPoint at;
            is_below = is_below != (mesh_ray_crosses(&ray, mesh, face, &at) && at.t > 0.0);
        }
        double apart = mesh_field_is_over(field, point) ? fabs(mesh_field_height(field, point) - point.y) : 1.0;
        wrong += mesh_holds(mesh, point) != is_below && apart > 1e-12;
    }
    tap_ok(wrong == 0, "field of %u x %u heights: inside is below its faces", field->columns, field->rows);
    field->water = 2.0;
    tap_ok(mesh_holds(mesh, vec3(0.5, 1.9, 0.5)) && !mesh_holds(mesh, vec3(0.5, 2.1, 0.5)), "or below its water");
    tap_ok(!mesh_holds(mesh, vec3(mesh_field_size(field).x, 0.0, 0.5)) && mesh_holds(mesh, vec3(0.0, -9.0, 0.0)),
           "and not beside it");
    mesh_free(mesh);
}

typedef struct TileCount {
    unsigned met, dark, lit, together, wrong;
} TileCount;

// What a tile meets, ray by ray.
static void count_hits(const Geometry *g, const SphereTile *tile, const TileHits *hits, TileCount *count)
{
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        SphereRay ray = sphere_tile_ray(tile, i);
        Hit hit;
        bool is_met = geometry_closest(g, TRACE_ALL_FEATURES, (Ray){ray.origin, ray.direction}, RAY_START_CAMERA,
                                       (double)INFINITY, &hit);
        bool same = is_met == (hits->met >> i & 1) &&
                    (!is_met || (hits->t[i] == hit.t && hits->shape[i] == hit.shape &&
                                 (hits->inside >> i & 1) == hit.inside));
        count->met += is_met;
        count->wrong += !same;
    }
}

// What is dark of surfaces, one by one, by a light that is no larger than `aside`.
static void count_shadows(const Geometry *g, const TileSurfaces *from, Vec3 light, double aside, Random *random,
                          TileCount *count)
{
    SurfaceRays rays = {.end = light, .end_radius = aside};
    uint64_t asked = ~UINT64_C(0) >> (TILE_RAYS - from->count), left;
    double start_error[TILE_RAYS];
    for (int i = 0; i < from->count; i++) {
        double away = random_between(random, 0, aside);
        Vec3 end = vec3_add_scaled(light, away, random_direction(random));
        Vec3 offset = vec3_sub(end, tile_surface_point(from, i));
        rays.distance[i] = vec3_length(offset);
        lane_set(rays.towards, (unsigned)i, vec3_scale(1.0 / rays.distance[i], offset));
        start_error[i] = -1.0;
    }
    uint64_t dark = geometry_occluded_surfaces(g, TRACE_ALL_FEATURES, from, &rays, true, asked);
    (void)g->kernels->shapes_occluded_surfaces(&g->shapes, from, &rays, start_error, asked, &left);
    count->together += (unsigned)__builtin_popcountll(asked & ~left);
    for (int i = 0; i < from->count; i++) {
        Ray ray = {tile_surface_point(from, i), lane_get(rays.towards, (unsigned)i)};
        RayStart start = {from->shape[i], vec3_dot(tile_surface_outward(from, i), ray.direction) < 0.0, HIDDEN_SHADOW};
        bool is_dark = geometry_occluded(g, TRACE_ALL_FEATURES, ray, start, rays.distance[i]);
        count->wrong += is_dark != (dark >> i & 1);
        count->dark += is_dark;
        count->lit += !is_dark;
    }
}

// Tiles that look at places of the mesh, from outside and within, so wide that all rays are nearly one up to all of it.
static void check_tiles(const char *name, Mesh *mesh, Transform to_world, uint64_t seed)
{
    Random random = {seed};
    Scene scene;
    Geometry *g = geometry_of(&scene, mesh, to_world);
    TileCount count = {0};
    for (int turn = 0; turn < 300; turn++) {
        double away = turn % 4 ? 3.0 : 0.5;
        Vec3 middle = vec3_scale(0.5, vec3_add(mesh->low, mesh->high)), size = vec3_sub(mesh->high, mesh->low), way[2];
        for (int i = 0; i < 2; i++) {
            Vec3 own = vec3_scale(away, random_direction(&random));
            own = turn % 8 == 1 ? vec3(0.0, 0.0, -away) : own; // along an axis
            way[i] = transform_point(&to_world, vec3_add(middle, vec3(own.x * size.x, own.y * size.y, own.z * size.z)));
        }
        SphereTile tile;
        Vec3 towards = vec3_normalize(vec3_sub(transform_point(&to_world, aim_of(&random, mesh)), way[0]));
        tile_of(&random, way[0], towards, pow(10.0, random_between(&random, turn % 9 ? -2.5 : -15.0, -0.7)), &tile);
        double aside = turn % 5 ? 0.0 : 0.1 * vec3_length(way[1]);
        uint64_t same = random_bits(&random);
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            Random own = {same};
            TileHits hits;
            TileSurfaces surfaces;
            MaterialIndex material[TILE_RAYS];
            g->kernels = sphere_kernels_choose(geometry_isa(isa));
            query_tile_closest(g, TRACE_ALL_FEATURES, &tile, true, &hits);
            count_hits(g, &tile, &hits, &count);
            if (hits.met) {
                geometry_tile_surfaces(g, TRACE_ALL_FEATURES, &tile, &hits, hits.met, &surfaces, material);
                count_shadows(g, &surfaces, way[1], aside, &own, &count);
            }
        }
    }
    tap_ok(count.wrong == 0 && count.met > 1000 && count.dark > 100 && count.lit > 100 && count.together > 100,
           "%s: tiles are as single rays are (%u of %u hits, %u dark and %u lit are not; %u together)", name, count.wrong,
           count.met, count.dark, count.lit, count.together);
    geometry_free(g);
    scene_fini(&scene);
}

// A rough field of heights, smooth to look at or not, with water or without.
static Mesh *hills(Random *random, bool is_smooth, double water)
{
    Mesh *mesh = field_of(random, 37, 29);
    mesh->field->water = water;
    if (is_smooth && !mesh_field_smooth(mesh)) {
        abort();
    }
    return mesh;
}

static void check_all_tiles(Random *random, uint64_t seed)
{
    Transform none = transform_identity();
    Transform turned =
        transform_compose(transform_rotate(vec3(20.0, 30.0, 40.0)), transform_scale(vec3(3.0, -0.7, 1.0)));
    Transform level = transform_compose(transform_scale(vec3(0.1, 1.0, 0.1)), transform_rotate(vec3(-35.0, 10.0, 0.0)));
    check_tiles("globe", globe(random, 0.3, 1.0), turned, seed + 1);
    check_tiles("cube", cube(7), none, seed + 2);
    check_tiles("field of heights", hills(random, false, 0.0), level, seed + 3);
    check_tiles("smooth field", hills(random, true, 0.0), level, seed + 4);
    check_tiles("field with water", hills(random, false, 0.6), level, seed + 5);
}

int main(int argc, char **argv)
{
    uint64_t rays = argc > 1 ? strtoull(argv[1], NULL, 10) : 20000, seed = random_seed(argc > 2 ? argv[2] : NULL);
    Random random = {seed};
    Transform none = transform_identity();
    Transform turned =
        transform_compose(transform_rotate(vec3(20.0, 30.0, 40.0)), transform_scale(vec3(3.0, -0.7, 1.0)));
    Transform far =
        transform_compose(transform_scale(vec3(1e-3, 1e-3, 1e-3)), transform_translate(vec3(5.0, -3.0, 2.0)));
    check_points();
    check_field(seed + 7);
    check_field(seed + 8);
    check_field_trees(&random, seed + 9);
    check_closed("globe", globe(&random, 0.0, 1.0), none, rays, seed + 1);
    check_closed("rough globe", globe(&random, 0.3, 1.0), none, rays, seed + 2);
    check_closed("flat globe", globe(&random, 0.1, 1e-3), turned, rays, seed + 3);
    check_closed("cube", cube(6), none, rays, seed + 4);
    check_closed("cube that is turned", cube(5), turned, rays, seed + 5);
    check_closed("small globe far away", globe(&random, 0.1, 1.0), far, rays, seed + 6);
    check_all_tiles(&random, seed + 40);
    return tap_done();
}
