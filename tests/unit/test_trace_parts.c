// Rays by the tile among stretched spheres, boxes, cones and other parts: what they meet, the surfaces there and what is
// before a light are those of single rays, bit for bit, with any instruction set.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "scene/blob.h"
#include "scene/outline.h"
#include "scene/polynomial.h"
#include "unit/tap.h"
#include "unit/trace_scenes.h"

// What a scene is drawn from.
typedef struct Family {
    const char *name;
    int balls, others, spheres, planes, composites;
    double size, spread; // of a part; of where they are
    bool is_tied;        // some are equal, or nearly, or lie in one another
    unsigned kinds;      // of the others, a bit for each PrimitiveKind; 0: all of `simple`
} Family;

#define QUADRICS (1u << 31) // its polynomials are

enum { SIMPLE = 5 }; // so many of these have the families that name none
static const PrimitiveKind simple[] = {
    PRIMITIVE_BOX,   PRIMITIVE_CONE,      PRIMITIVE_DISC, PRIMITIVE_TRIANGLE, PRIMITIVE_SMOOTH_TRIANGLE,
    PRIMITIVE_TORUS, PRIMITIVE_POLYNOMIAL, PRIMITIVE_BLOB, PRIMITIVE_PRISM};

static const Family kinds[] = {
    {"a few balls", 6, 0, 0, 0, 0, 1.0, 2.0, false, 0},
    {"balls", 400, 0, 0, 0, 0, 0.2, 3.0, false, 0},
    {"thin balls far away", 300, 0, 0, 0, 0, 2e-3, 0.5, false, 0},
    {"balls and a plane", 200, 0, 0, 1, 0, 0.2, 3.0, false, 0},
    {"balls and spheres", 150, 0, 150, 0, 0, 0.2, 3.0, false, 0},
    {"balls and other shapes", 150, 150, 0, 0, 20, 0.2, 3.0, false, 0},
    {"all kinds", 150, 80, 100, 2, 10, 0.2, 3.0, false, 0},
    {"balls in one another", 150, 0, 10, 0, 0, 0.3, 2.0, true, 0},
    {"cones", 0, 300, 0, 0, 0, 0.2, 3.0, false, 1u << PRIMITIVE_CONE},
    {"boxes", 0, 300, 0, 0, 0, 0.2, 3.0, false, 1u << PRIMITIVE_BOX},
    {"discs and triangles", 0, 400, 0, 0, 0, 0.3, 3.0, false, 1u << PRIMITIVE_DISC | 1u << PRIMITIVE_TRIANGLE},
    {"smooth triangles", 0, 400, 0, 0, 0, 0.3, 3.0, false, 1u << PRIMITIVE_SMOOTH_TRIANGLE},
    {"thin cones far away, and spheres", 0, 300, 50, 0, 0, 2e-3, 0.5, false, 1u << PRIMITIVE_CONE},
    {"cones in one another", 0, 150, 10, 1, 0, 0.3, 2.0, true, 1u << PRIMITIVE_CONE},
    {"boxes in one another", 0, 150, 0, 1, 0, 0.3, 2.0, true, 1u << PRIMITIVE_BOX},
    {"flat ones in one another", 0, 200, 0, 1, 0, 0.5, 2.0, true, 1u << PRIMITIVE_DISC | 1u << PRIMITIVE_TRIANGLE},
    {"all in one another", 50, 150, 10, 1, 5, 0.3, 2.0, true, 0},
    {"tori", 0, 300, 0, 0, 0, 0.3, 3.0, false, 1u << PRIMITIVE_TORUS},
    {"closed quartics", 0, 300, 0, 0, 0, 0.3, 3.0, false, 1u << PRIMITIVE_POLYNOMIAL},
    {"blobs", 0, 300, 0, 0, 0, 0.3, 3.0, false, 1u << PRIMITIVE_BLOB},
    {"blobs in one another", 0, 100, 0, 0, 0, 0.5, 2.0, true, 1u << PRIMITIVE_BLOB},
    {"prisms", 0, 300, 0, 0, 0, 0.5, 3.0, false, 1u << PRIMITIVE_PRISM},
    {"prisms and boxes in one another", 0, 100, 0, 0, 0, 0.5, 2.0, true, 1u << PRIMITIVE_PRISM | 1u << PRIMITIVE_BOX},
    {"tori, closed quartics and cones", 0, 300, 20, 1, 5, 0.3, 3.0, false,
     1u << PRIMITIVE_TORUS | 1u << PRIMITIVE_POLYNOMIAL | 1u << PRIMITIVE_CONE},
    {"tori in one another", 0, 100, 0, 0, 0, 0.5, 2.0, true, 1u << PRIMITIVE_TORUS},
    {"closed quartics in one another", 0, 100, 0, 0, 0, 0.5, 2.0, true, 1u << PRIMITIVE_POLYNOMIAL},
    {"quadrics", 0, 8, 0, 0, 0, 0.1, 3.0, false, QUADRICS | 1u << PRIMITIVE_POLYNOMIAL},
    {"thin quadrics far away, and boxes", 0, 6, 0, 0, 3, 2e-3, 0.5, false,
     QUADRICS | 1u << PRIMITIVE_POLYNOMIAL | 1u << PRIMITIVE_BOX},
    {"quadrics in one another", 0, 20, 0, 1, 0, 0.3, 2.0, true, QUADRICS | 1u << PRIMITIVE_POLYNOMIAL},
};

// A closed quartic: a torus, a rounded cube, one of some bumps, or two drops that meet.
static void set_quartic(Random *random, Primitive *primitive)
{
    enum { COUNT = POLYNOMIAL_HEAD + 5 + 35, XXXX = 0, XXYY = 4, XXZZ = 7, XX = 9, YYYY = 20, YYZZ = 23, YY = 25, ZZZZ = 30, ZZ = 32 };
    static double lists[4][COUNT];
    double(*list)[COUNT] = &lists[random_bits(random) % 4], *c = &(*list)[POLYNOMIAL_HEAD + 5];
    if (c[34] == 0.0) {
        c[XXXX] = c[YYYY] = c[ZZZZ] = 1.0;
        if (list == &lists[0]) {
            c[XXYY] = c[XXZZ] = c[YYZZ] = 2.0;
            c[XX] = c[YY] = -2.0 * (0.36 + 0.04);
            c[ZZ] = 2.0 * (0.36 - 0.04);
            c[34] = (0.36 - 0.04) * (0.36 - 0.04);
        } else if (list == &lists[1]) {
            c[34] = -0.5;
        } else {
            c[XX] = c[YY] = c[ZZ] = -0.7;
            c[3] = 0.1;
            c[34] = list == &lists[2] ? 0.2 : 0.35;
        }
        (*list)[0] = 4;
        polynomial_complete(*list);
    }
    polynomial_part(&(Numbers){*list, COUNT}, primitive);
}

// A blob of some balls and rods, some of them negative; of more components than lanes keep, too.
static void set_blob(Random *random, Primitive *primitive)
{
    enum { FEW = 6, MANY = 60, NUMBERS = BLOB_HEAD + (2 * BLOB_NODE + BLOB_COMPONENT) * MANY };
    static double lists[4][NUMBERS];
    static Numbers blobs[4];
    uint64_t own = random_bits(random) % 4;
    if (!blobs[own].items) {
        BlobComponent components[MANY];
        uint32_t count = 0, most = own == 3 ? MANY : FEW;
        const Transform as_it_is = transform_identity();
        while (count < most) {
            Vec3 base = random_point(random, 0.5), cap = random_point(random, 0.5);
            bool is_rod = own > 0 && count % 3 == 1;
            double strength = own == 2 && count % 5 == 4 ? -0.5 : random_between(random, 0.5, 1.5);
            count += blob_component(&components[count], is_rod, base, cap, 0.5, strength, &as_it_is);
        }
        blobs[own] = blob_make(own == 3 ? 4.0 : 0.4, components, count, lists[own]);
    }
    const BlobNode *root = blob_of(blobs[own].items).nodes;
    primitive->kind = PRIMITIVE_BLOB;
    primitive->fixed[0] = vec3(root->low[0], root->low[1], root->low[2]);
    primitive->fixed[1] = vec3(root->high[0], root->high[1], root->high[2]);
    primitive->list = blobs[own];
}

// A prism over a star with a hole, of straight pieces, of curved ones, or growing with the height.
static void set_prism(Random *random, Primitive *primitive)
{
    enum { CORNERS = 10, NUMBERS = OUTLINE_HEAD + OUTLINE_PIECE_NUMBERS * 2 * CORNERS };
    static double lists[3][NUMBERS];
    static Numbers outlines[3];
    uint64_t own = random_bits(random) % 3;
    OutlinePoint low, high;
    if (!outlines[own].items) {
        size_t count;
        outline_begin(lists[own], &count, own == 1 ? 3 : 1, own == 2);
        for (int i = 0; i < 2 * CORNERS; i++) {
            double piece[8], turn = 6.283185307179586 / CORNERS;
            for (int k = 0; k < 4; k++) {
                int corner = k < 2 ? i % CORNERS : (i + 1) % CORNERS; // controls beyond the corners make it wavy
                double size = (i < CORNERS ? 1.0 : 0.3) * (corner % 2 ? 0.6 : 1.0) * (k == 1 || k == 2 ? 1.2 : 1.0);
                double *point = own == 1 ? &piece[2 * k] : &piece[k / 2 * 2];
                if (own == 1 || k % 3 == 0) {
                    point[0] = size * cos(turn * corner);
                    point[1] = size * sin(turn * corner);
                }
            }
            outline_add(lists[own], &count, piece);
        }
        outlines[own] = (Numbers){lists[own], count};
    }
    outline_bounds(&outlines[own], &low, &high);
    primitive->kind = PRIMITIVE_PRISM;
    primitive->fixed[0] = vec3(low.u, own == 2 ? 0.2 : -0.3, low.v);
    primitive->fixed[1] = vec3(high.u, own == 2 ? 1.0 : 0.3, high.v);
    primitive->list = outlines[own];
}

// A quadric: an ellipsoid, a cylinder, a cone, a hyperboloid, a paraboloid, or one that lies across the axes.
static void set_quadric(Random *random, Primitive *primitive)
{
    enum { KINDS = 6, TERMS = 10, COUNT = POLYNOMIAL_HEAD + 3 + TERMS };
    static const double terms[KINDS][TERMS] = {
        {1, 0, 0, 0.2, 2, 0, 0, 1.5, 0.1, -1}, {1, 0, 0, 0, 0, 0, 0, 1, 0, -1},
        {1, 0, 0, 0, -1, 0, 0, 1, 0, 0},       {1, 0, 0, 0, -1, 0, 0, 1, 0.2, -0.5},
        {1, 0, 0, 0, 0, 0, -1, 1, 0, 0},       {1, 0.5, -0.2, 0, -0.3, 1.1, 0.3, 0.4, 0, -0.6}};
    static double lists[KINDS][COUNT];
    unsigned which = (unsigned)(random_bits(random) % KINDS);
    double *list = lists[which];
    memcpy(list + POLYNOMIAL_HEAD + 3, terms[which], sizeof terms[which]);
    list[0] = 2;
    polynomial_complete(list);
    polynomial_part(&(Numbers){list, COUNT}, primitive);
}

static Primitive part_at(Random *random, PrimitiveKind kind, double size, Vec3 at, bool has_quadrics)
{
    Primitive primitive = random_primitive(random, kind, size);
    if (kind == PRIMITIVE_POLYNOMIAL) {
        (has_quadrics ? set_quadric : set_quartic)(random, &primitive);
    } else if (kind == PRIMITIVE_BLOB) {
        set_blob(random, &primitive);
    } else if (kind == PRIMITIVE_PRISM) {
        set_prism(random, &primitive);
    }
    primitive.to_world = transform_compose(primitive.to_world, transform_translate(at));
    if (!transform_invert(&primitive.to_world, &primitive.to_object)) {
        abort();
    }
    return primitive;
}

// What a ball and a box have in common.
static void add_composite(Scene *scene, Random *random, const Family *family)
{
    uint32_t root;
    Vec3 at = random_point(random, family->spread);
    Primitive ball = part_at(random, PRIMITIVE_SPHERE, family->size, at, false),
              box = part_at(random, PRIMITIVE_BOX, family->size, at, false);
    if (!scene_begin_composite(scene, 0, 0) || !scene_add_node(scene, NODE_INTERSECTION, false, NODE_NONE, 0, &root)) {
        abort();
    }
    ball.node = box.node = root;
    if (!scene_add_leaf(scene, &ball) || !scene_add_leaf(scene, &box)) {
        abort();
    }
    scene_end_composite(scene);
}

// Another solid: anywhere, or, in a family of ties, where the last one is or next to that.
static Primitive random_solid(Random *random, const Family *family, PrimitiveKind kind, const Primitive *last)
{
    double size = family->size * exp(random_between(random, -1, 0.5));
    Primitive primitive = part_at(random, kind, size, random_point(random, family->spread), family->kinds & QUADRICS);
    uint64_t bits = random_bits(random);
    bool has_inside = kind == PRIMITIVE_SPHERE || kind == PRIMITIVE_BOX || kind == PRIMITIVE_CONE ||
                      kind == PRIMITIVE_TORUS || kind == PRIMITIVE_POLYNOMIAL || kind == PRIMITIVE_BLOB || kind == PRIMITIVE_PRISM;
    if (kind == PRIMITIVE_SMOOTH_TRIANGLE) {
        for (int i = 0; i < 3; i++) {
            primitive.data[i] = random_direction(random);
        }
    }
    if (family->is_tied && last && bits % 2) {
        double apart = bits >> 4 & 1 ? 0x1p-30 : 0x1p-52;
        primitive.to_world = last->to_world;
        if (primitive.kind == last->kind) {
            memcpy(primitive.data, last->data, sizeof primitive.data);
        }
        for (int row = 0; bits % 4 == 1 && row < 3; row++) {
            for (int column = 0; column < 3; column++) {
                primitive.to_world.m[row][column] *= 1.0 + apart * (double)(bits >> 8 & 7);
            }
        }
    }
    primitive.hidden = bits >> 16 & 15 ? 0 : bits >> 20 & 7;
    primitive.hidden = primitive.hidden == 7 ? 0 : primitive.hidden;
    primitive.flags = bits >> 24 & 511 || !has_inside ? 0 : PRIMITIVE_INVERSE;
    primitive.flags |= kind == PRIMITIVE_CONE && !(bits >> 36 & 7) ? PRIMITIVE_OPEN : 0;
    if (!transform_invert(&primitive.to_world, &primitive.to_object)) {
        abort();
    }
    return primitive;
}

static PrimitiveKind random_kind(Random *random, const Family *family)
{
    for (;;) {
        PrimitiveKind kind = simple[random_bits(random) % (family->kinds ? RT_COUNT_OF(simple) : SIMPLE)];
        if (!family->kinds || family->kinds >> kind & 1) {
            return kind;
        }
    }
}

static void draw_scene(Random *random, const Family *family, Scene *scene)
{
    Primitive last;
    scene_init(scene);
    for (int i = 0; i < family->spheres; i++) {
        Vec3 centre = random_point(random, family->spread);
        add_sphere(scene, centre, family->size * exp(random_between(random, -1, 1)));
    }
    for (int i = 0; i < family->planes; i++) {
        Vec3 normal = random_direction(random);
        add_plane(scene, normal, random_between(random, -1, 1) * family->spread);
    }
    for (int i = 0; i < family->balls + family->others; i++) {
        PrimitiveKind kind = i < family->balls ? PRIMITIVE_SPHERE : random_kind(random, family);
        last = random_solid(random, family, kind, i ? &last : NULL);
        add_primitive(scene, &last);
    }
    for (int i = 0; i < family->composites; i++) {
        add_composite(scene, random, family);
    }
}

typedef struct Found {
    int hits, surfaces, shadows; // that differ
    int met, parts, dark, lit, together;
} Found;

static void hits_try(const Geometry *g, unsigned features, const SphereTile *tile, const TileHits *hits, Found *found)
{
    for (unsigned i = 0; i < TILE_RAYS; i++) {
        SphereRay ray = sphere_tile_ray(tile, i);
        Hit hit;
        bool is_met = geometry_closest(g, features, (Ray){ray.origin, ray.direction}, RAY_START_CAMERA,
                                       (double)INFINITY, &hit);
        found->met += is_met;
        found->parts += is_met && shape_kind(hit.shape) == SHAPE_PRIMITIVE;
        found->hits += is_met != (hits->met >> i & 1) ||
                       (is_met && (memcmp(&hit.t, &hits->t[i], sizeof hit.t) != 0 || hit.shape != hits->shape[i] ||
                                   hit.inside != (hits->inside >> i & 1)));
    }
}

static bool surface_differs(const Geometry *g, Ray ray, const TileHits *hits, const TileSurfaces *surfaces,
                            const MaterialIndex *material, int i)
{
    unsigned from = surfaces->ray[i];
    Surface surface =
        geometry_surface(g, TRACE_ALL_FEATURES, ray, (Hit){hits->t[from], hits->shape[from], hits->inside >> from & 1});
    Vec3 point = tile_surface_point(surfaces, i), outward = tile_surface_outward(surfaces, i);
    return memcmp(&point, &surface.point, sizeof point) != 0 ||
           memcmp(&outward, &surface.normal, sizeof outward) != 0 || surface.material != material[i] || surfaces->shape[i] != hits->shape[from];
}

// From surfaces to a light, or to places next to it.
static void shadows_try(const Geometry *g, unsigned features, const TileSurfaces *from, Vec3 light, double aside,
                        uint64_t asked, Random *random, Found *found)
{
    SurfaceRays rays = {.end = light, .end_radius = aside};
    asked &= ~UINT64_C(0) >> (TILE_RAYS - from->count);
    for (int i = 0; i < from->count; i++) {
        Vec3 way = random_direction(random);
        Vec3 end = vec3_add_scaled(light, random_between(random, 0, aside), way);
        Vec3 offset = vec3_sub(end, tile_surface_point(from, i));
        rays.distance[i] = vec3_length(offset);
        lane_set(rays.towards, (unsigned)i, vec3_scale(1.0 / rays.distance[i], offset));
    }
    uint64_t occluded = geometry_occluded_surfaces(g, features, from, &rays, true, asked), left;
    double start_error[TILE_RAYS];
    for (int i = 0; i < TILE_RAYS; i++) {
        start_error[i] = -1.0;
    }
    uint64_t on_parts = 0;
    for (int i = 0; i < from->count; i++) {
        on_parts |= asked & (uint64_t)shape_is_on_primitive(from->shape[i]) << i;
    }
    g->kernels->shapes_occluded_surfaces(&g->shapes, from, &rays, start_error, on_parts, &left);
    found->together += __builtin_popcountll(on_parts & ~left);
    found->shadows += (occluded & ~asked) != 0;
    for (; asked; asked &= asked - 1) {
        int i = __builtin_ctzll(asked);
        Ray ray = {tile_surface_point(from, i), lane_get(rays.towards, (unsigned)i)};
        RayStart start = {from->shape[i], vec3_dot(tile_surface_outward(from, i), ray.direction) < 0.0, HIDDEN_SHADOW};
        bool is_dark = geometry_occluded(g, features, ray, start, rays.distance[i]);
        found->shadows += is_dark != (occluded >> i & 1);
        found->dark += is_dark;
        found->lit += !is_dark;
    }
}

// Surfaces of the tile's rays, and of others that continue from there.
static void surfaces_try(const Geometry *g, unsigned features, const SphereTile *tile, const TileHits *hits,
                         Random *random, TileSurfaces *surfaces, Found *found)
{
    MaterialIndex material[TILE_RAYS];
    geometry_tile_surfaces(g, features, tile, hits, hits->met, surfaces, material);
    SecondaryRays secondary = {.count = 0};
    for (int i = 0; i < surfaces->count; i++) {
        SphereRay own = sphere_tile_ray(tile, surfaces->ray[i]);
        found->surfaces += surface_differs(g, (Ray){own.origin, own.direction}, hits, surfaces, material, i);
        Vec3 direction = random_direction(random);
        secondary_ray_add(&secondary, tile_surface_point(surfaces, i), direction, surfaces->shape[i],
                          vec3_dot(tile_surface_outward(surfaces, i), direction) < 0.0);
    }
    TileHits beyond;
    TileSurfaces there;
    geometry_closest_secondary(g, features, HIDDEN_MIRROR, &secondary, &beyond);
    if (beyond.met) {
        geometry_secondary_surfaces(g, features, &secondary, &beyond, &there, material);
        for (int i = 0; i < there.count; i++) {
            found->surfaces += surface_differs(g, secondary_ray(&secondary, there.ray[i]), &beyond, &there, material, i);
        }
    }
}

// A tile of rays towards a primitive's middle, or, all of them nearly one, along its edge.
static void aim(Random *random, const Family *family, const Primitive *primitive, Vec3 eye, SphereTile *tile)
{
    const double *centre = primitive->to_world.m[3];
    Vec3 towards = vec3_sub(vec3(centre[0], centre[1], centre[2]), eye);
    double step = family->size / vec3_length(towards) * pow(10.0, random_between(random, -2, 0));
    Vec3 f = transform_point(&primitive->to_object, eye);
    double sine = 1.0 / vec3_length(f);
    if (random_bits(random) % 3 == 0 && sine < 1.0) {
        Vec3 inward = vec3_normalize(vec3_neg(f)), aside = random_perpendicular(random, inward);
        Vec3 along = vec3_add_scaled(vec3_scale(sqrt(1.0 - sine * sine), inward), sine, aside);
        towards = transform_direction(&primitive->to_world, along);
        step = pow(10.0, random_between(random, -17, -6));
    }
    tile_of(random, eye, vec3_normalize(towards), step, tile);
}

static void test_family(uint64_t seed, const Family *family)
{
    Random random = {seed};
    Found found = {0};
    for (int turn = 0; turn < 120; turn++) {
        Scene scene;
        draw_scene(&random, family, &scene);
        Geometry *g = prepare(&scene, 0);
        const unsigned features = TRACE_ALL_FEATURES; // as the kernel of scenes with parts has it
        SphereTile tile;
        double away = family->spread * (turn % 3 ? 4.0 : turn % 2 ? 300.0 : 0.5);
        Vec3 eye = vec3_scale(away, random_direction(&random));
        aim(&random, family, &scene.primitives.items[random_bits(&random) % scene.primitives.count], eye, &tile);
        Vec3 way = random_direction(&random);
        Vec3 light = vec3_scale(family->spread * pow(10.0, random_between(&random, -1, 2)), way);
        double aside = turn % 4 ? 0.0 : family->spread * pow(10.0, random_between(&random, -3, 0));
        uint64_t same = random_bits(&random), asked = random_bits(&random);
        asked |= random_bits(&random);
        for (size_t isa = 0; geometry_isa(isa); isa++) {
            TileHits hits;
            TileSurfaces surfaces;
            Random own = {same};
            g->kernels = sphere_kernels_choose(geometry_isa(isa));
            query_tile_closest(g, features, &tile, true, &hits);
            hits_try(g, features, &tile, &hits, &found);
            if (hits.met) {
                surfaces_try(g, features, &tile, &hits, &own, &surfaces, &found);
                shadows_try(g, features, &surfaces, light, aside, asked, &own, &found);
            }
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(found.hits == 0 && found.parts > 1000,
           "%s: a tile's hits are those of single rays (%d of %d not, %d on parts)", family->name, found.hits, found.met, found.parts);
    tap_ok(found.surfaces == 0, "%s: surfaces too (%d not)", family->name, found.surfaces);
    tap_ok(found.shadows == 0 && found.dark > 100 && found.lit > 100 && found.together > 300,
           "%s: shadows too (%d of %d dark and %d lit differ; %d traced together)", family->name, found.shadows,
           found.dark, found.lit, found.together);
}

// The first end ahead of what a primitive's own class says of a ray that is not asked by lanes; INFINITY: none.
static double class_root(const PreparedPrimitive *primitive, const Ray *ray)
{
    RayInterval intervals[primitive->interval_most + 1];
    Ray object = primitive_ray(primitive, ray);
    double root = (double)INFINITY;
    unsigned count = primitive_intervals(primitive, &object, LEFT_NONE, intervals);
    for (unsigned i = 0; i < count; i++) {
        root = intervals[i].enter > 0.0 && intervals[i].enter < root ? intervals[i].enter : root;
        root = intervals[i].leave > 0.0 && intervals[i].leave < root ? intervals[i].leave : root;
    }
    return root;
}

// A ray that touches a surface, but for up to a thousandth of its size and down to rounding.
static Ray grazing_ray(Random *random, const Surface *surface, double away)
{
    double size = pow(10.0, random_between(random, -17, -3));
    double aside = random_bits(random) % 2 ? size : -size;
    Vec3 along = random_perpendicular(random, surface->normal);
    Vec3 at = vec3_add_scaled(surface->point, aside, surface->normal);
    return (Ray){vec3_add_scaled(at, -away, along), along};
}

// What lanes tell of a torus, quartic or blob is what its own class says, of rays to it and about it, every second of which
// grazes it.
static void test_told(uint64_t seed, PrimitiveKind kind, double most)
{
    Random random = {seed};
    int met = 0, missed = 0, wrong = 0;
    double worst = 0.0;
    for (int turn = 0; turn < 300; turn++) {
        Scene scene;
        scene_init(&scene);
        Primitive primitive = part_at(&random, kind, 1.0, random_point(&random, 3.0), false);
        add_primitive(&scene, &primitive);
        Geometry *g = prepare(&scene, 0);
        for (int i = 0; i < 200; i++) {
            double away = pow(10.0, random_between(&random, -1, 3));
            Vec3 middle = random_point(&random, 1.0);
            Vec3 eye = vec3_add_scaled(middle, away, random_direction(&random));
            Vec3 at = transform_point(&primitive.to_world, random_point(&random, 1.1));
            Ray ray = {eye, vec3_normalize(vec3_sub(at, eye))};
            Hit hit;
            if (i % 2 && closest(g, ray, RAY_START_CAMERA, (double)INFINITY, &hit)) {
                Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
                ray = grazing_ray(&random, &surface, away);
            }
            double expected = class_root(&g->shapes.primitives[0], &ray);
            bool is_met = closest(g, ray, RAY_START_CAMERA, (double)INFINITY, &hit);
            met += is_met;
            missed += !is_met;
            wrong += is_met != isfinite(expected);
            double off = is_met ? fabs(hit.t - expected) / (away + 4.0) : 0.0;
            worst = off > worst ? off : worst;
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(wrong == 0 && worst <= most && met > 5000 && missed > 5000,
           "%s: what is told of rays at once is what their class says (%d met, %d missed, %d wrong, off by %.2g)",
           kind == PRIMITIVE_TORUS  ? "tori"
           : kind == PRIMITIVE_BLOB ? "blobs"
                                    : "closed quartics",
           met, missed, wrong, worst);
}

// Of two equal solids one is inverse. A ray that leaves the surface outward has left both.
static void test_inverse_twin(uint64_t seed, PrimitiveKind kind)
{
    Random random = {seed};
    int met = 0, again = 0;
    for (int turn = 0; turn < 100; turn++) {
        Scene scene;
        scene_init(&scene);
        Primitive primitive = part_at(&random, kind, 1.0, random_point(&random, 3.0), false);
        add_primitive(&scene, &primitive);
        primitive.flags = PRIMITIVE_INVERSE;
        add_primitive(&scene, &primitive);
        Geometry *g = prepare(&scene, 0);
        const double *middle = primitive.to_world.m[3];
        Vec3 towards = vec3_neg(random_direction(&random)), centre = vec3(middle[0], middle[1], middle[2]);
        Ray ray = {vec3_add_scaled(centre, -9.0, towards), towards};
        Hit hit, other;
        if (closest(g, ray, RAY_START_CAMERA, (double)INFINITY, &hit) && !hit.inside) { // or it is in them
            Surface surface = geometry_surface(g, TRACE_ALL_FEATURES, ray, hit);
            Ray back = {surface.point, vec3_neg(towards)};
            RayStart start = {hit.shape, vec3_dot(surface.normal, back.direction) < 0.0, 0};
            met++;
            again += closest(g, back, start, (double)INFINITY, &other);
        }
        geometry_free(g);
        scene_fini(&scene);
    }
    tap_ok(met > 50 && again == 0, "%s with an inverse twin: %d of %d rays that leave meet it again",
           kind == PRIMITIVE_BOX ? "boxes" : kind == PRIMITIVE_CONE ? "cones" : "balls", again, met);
}

int main(void)
{
    uint64_t seed = random_seed(NULL);
    test_inverse_twin(seed, PRIMITIVE_SPHERE);
    test_inverse_twin(seed, PRIMITIVE_BOX);
    test_inverse_twin(seed, PRIMITIVE_CONE);
    test_told(seed, PRIMITIVE_TORUS, 0x1p-52);
    test_told(seed, PRIMITIVE_POLYNOMIAL, 0x1p-44);
    test_told(seed, PRIMITIVE_BLOB, 0x1p-43);
    for (size_t i = 0; i < RT_COUNT_OF(kinds); i++) {
        test_family(seed + i, &kinds[i]);
    }
    return tap_done();
}
