// The table of primitives, and the rows of those that a few numbers make: what each row's functions say; see
// PrimitiveKind in shape.h for the fixed shapes.
//
// SPDX-License-Identifier: MIT
#include "scene/primitive.h"

#include <math.h>

#include "math/length.h"
#include "scene/dump.h"
#include "scene/ovus.h"
#include "scene/primitive_rows.h"

static bool is_between(double low, double value, double high)
{
    return low <= value && value <= high;
}

// Of a polygon in the circle of that radius.
static Vec3 round_corner(double z, double radius, uint32_t i)
{
    double angle = 2.0 * M_PI * i / FACE_CORNERS_MOST;
    return vec3(radius * cos(angle), radius * sin(angle), z);
}

static void dump_first(const Primitive *primitive, TextBuffer *out)
{
    dump_number(out, "", primitive->data[0].x);
}

// ---- ball

static double ball_support(const Primitive *primitive, Vec3 n)
{
    (void)primitive;
    return length_of(n.x, n.y, n.z);
}

static bool ball_holds(const Primitive *primitive, Vec3 p)
{
    (void)primitive;
    return vec3_dot(p, p) < 1.0;
}

// ---- plane: primitive_support knows the only direction in which it ends, and faces.c what has no corners

static double plane_support(const Primitive *primitive, Vec3 n)
{
    (void)primitive;
    (void)n;
    return (double)INFINITY;
}

static bool plane_holds(const Primitive *primitive, Vec3 p)
{
    return vec3_dot(p, primitive->data[0]) < primitive->data[1].x;
}

static void plane_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_vector(out, "", primitive->data[0]);
    dump_number(out, ", ", primitive->data[1].x);
}

static uint32_t one_face(const Primitive *primitive)
{
    (void)primitive;
    return 1;
}

static uint32_t no_corners(const Primitive *primitive)
{
    (void)primitive;
    return 0;
}

// ---- box

double primitive_box_support(const Primitive *primitive, Vec3 n)
{
    const Vec3 *low = &primitive->data[0], *high = &primitive->data[1];
    return fmax(low->x * n.x, high->x * n.x) + fmax(low->y * n.y, high->y * n.y) + fmax(low->z * n.z, high->z * n.z);
}

static bool box_holds(const Primitive *primitive, Vec3 p)
{
    const Vec3 *low = &primitive->data[0], *high = &primitive->data[1];
    return is_between(low->x, p.x, high->x) && is_between(low->y, p.y, high->y) && is_between(low->z, p.z, high->z);
}

static void box_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_vector(out, "", primitive->data[0]);
    dump_vector(out, ", ", primitive->data[1]);
}

static uint32_t box_faces(const Primitive *primitive)
{
    (void)primitive;
    return 6;
}

static Vec3 box_corner(const Primitive *primitive, uint32_t number, uint32_t i)
{
    const double low[3] = {primitive->data[0].x, primitive->data[0].y, primitive->data[0].z};
    const double high[3] = {primitive->data[1].x, primitive->data[1].y, primitive->data[1].z};
    uint32_t axis = number / 2, second = (axis + 1) % 3, third = (axis + 2) % 3;
    double p[3];
    p[axis] = number % 2 ? high[axis] : low[axis];
    p[second] = i == 1 || i == 2 ? high[second] : low[second];
    p[third] = i >= 2 ? high[third] : low[third];
    return vec3(p[0], p[1], p[2]);
}

static uint32_t four_corners(const Primitive *primitive)
{
    (void)primitive;
    return 4;
}

static Vec3 box_normal(uint32_t number)
{
    double side = number % 2 ? 1.0 : -1.0;
    uint32_t axis = number / 2;
    return vec3(axis == 0 ? side : 0.0, axis == 1 ? side : 0.0, axis == 2 ? side : 0.0);
}

void primitive_box_measure(const Primitive *primitive, Vec3 *half, Vec3 *middle)
{
    *half = vec3_scale(0.5, vec3_sub(primitive->data[1], primitive->data[0]));
    *middle = vec3_add(vec3_scale(0.5, primitive->data[0]), vec3_scale(0.5, primitive->data[1]));
}

// ---- cone

static double cone_support(const Primitive *primitive, Vec3 n)
{
    double round = length_of(n.x, n.y, 0.0);
    return fmax(round, primitive->data[0].x * round + n.z);
}

static bool cone_holds(const Primitive *primitive, Vec3 p)
{
    double radius = 1.0 + (primitive->data[0].x - 1.0) * p.z;
    return is_between(0.0, p.z, 1.0) && p.x * p.x + p.y * p.y < radius * radius;
}

static uint32_t cone_faces(const Primitive *primitive)
{
    return primitive->flags & PRIMITIVE_OPEN ? 0 : primitive->data[0].x > 0.0 ? 2 : 1;
}

static uint32_t round_corners(const Primitive *primitive)
{
    (void)primitive;
    return FACE_CORNERS_MOST;
}

static Vec3 cone_corner(const Primitive *primitive, uint32_t number, uint32_t i)
{
    return round_corner(number, number ? primitive->data[0].x : 1.0, i);
}

static Vec3 cone_normal(uint32_t number)
{
    return vec3(0.0, 0.0, number ? 1.0 : -1.0);
}

// ---- disc

static double disc_support(const Primitive *primitive, Vec3 n)
{
    (void)primitive;
    return length_of(n.x, n.y, 0.0);
}

static bool disc_holds(const Primitive *primitive, Vec3 p)
{
    (void)primitive;
    return p.z < 0.0;
}

// A ring is taken in pieces.
static uint32_t disc_faces(const Primitive *primitive)
{
    return primitive->data[0].x > 0.0 ? FACE_CORNERS_MOST : 1;
}

// Of one of the pieces of a ring, its inner edge just outside of the hole.
static Vec3 ring_corner(double hole, uint32_t number, uint32_t i)
{
    double angle = 2.0 * M_PI * (number + (i == 1 || i == 2)) / FACE_CORNERS_MOST;
    double radius = i < 2 ? 1.0 : fmin(1.0, hole / cos(M_PI / FACE_CORNERS_MOST));
    return vec3(radius * cos(angle), radius * sin(angle), 0.0);
}

static uint32_t disc_corners(const Primitive *primitive)
{
    return primitive->data[0].x > 0.0 ? 4 : FACE_CORNERS_MOST;
}

static Vec3 disc_corner(const Primitive *primitive, uint32_t number, uint32_t i)
{
    return primitive->data[0].x > 0.0 ? ring_corner(primitive->data[0].x, number, i) : round_corner(0.0, 1.0, i);
}

static Vec3 flat_normal(uint32_t number)
{
    (void)number;
    return vec3(0.0, 0.0, 1.0);
}

// ---- triangles

static double triangle_support(const Primitive *primitive, Vec3 n)
{
    (void)primitive;
    return fmax(0.0, fmax(n.x, n.y));
}

static uint32_t three_corners(const Primitive *primitive)
{
    (void)primitive;
    return 3;
}

static Vec3 triangle_corner(const Primitive *primitive, uint32_t number, uint32_t i)
{
    (void)primitive;
    (void)number;
    return vec3(i == 1, i == 2, 0.0);
}

static void smooth_triangle_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_vector(out, "", primitive->data[0]);
    dump_vector(out, ", x, ", primitive->data[1]);
    dump_vector(out, ", y, ", primitive->data[2]);
}

// ---- torus

static double torus_support(const Primitive *primitive, Vec3 n)
{
    double round = hypot(n.x, n.z);
    return primitive->data[0].x * round + primitive->data[0].y * hypot(round, n.y);
}

// With its surface, as in POV-Ray; and what the tube goes through itself in, where it does.
static bool torus_holds(const Primitive *primitive, Vec3 p)
{
    double from = hypot(p.x, p.z) - primitive->data[0].x, minor = primitive->data[0].y;
    return from * from + p.y * p.y <= minor * minor;
}

static void torus_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_number(out, "", primitive->data[0].x);
    dump_number(out, ", ", primitive->data[0].y);
}

// The tube, somewhere on the ring.
static void torus_measure(const Primitive *primitive, Vec3 *half, Vec3 *middle)
{
    *half = vec3(primitive->data[0].y, primitive->data[0].y, primitive->data[0].y);
    *middle = vec3(primitive->data[0].x, 0.0, 0.0);
}

// ---- ovus

static double egg_support(const Primitive *primitive, Vec3 n)
{
    Ovus ovus = ovus_of(primitive->data);
    return ovus_support(&ovus, n);
}

static bool egg_holds(const Primitive *primitive, Vec3 p)
{
    Ovus ovus = ovus_of(primitive->data);
    Vec3 normal;
    return ovus_distance(&ovus, p, &normal) < 0.0;
}

// Its bottom ball is about the origin in the text, and half of the top radius below it here.
static void egg_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_number(out, "", primitive->data[0].x);
    dump_number(out, ", ", primitive->data[0].y);
    dump_number(out, " translate ", primitive->data[0].z);
    text_append(out, "*y");
}

// ---- the table

static const PrimitiveClass sphere = {
    .word = "sphere",
    .head = "sphere { 0, 1",
    .family = FAMILY_ROUND,
    .surface = PRIMITIVE_SPHERE,
    .interval_count = 1,
    .support = ball_support,
    .holds = ball_holds,
};

static const PrimitiveClass plane = {
    .word = "plane",
    .head = "plane { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_PLANE,
    .key_count = 2,
    .interval_count = 1,
    .support = plane_support,
    .holds = plane_holds,
    .dump = plane_dump,
    .face_count = one_face,
    .corner_count = no_corners,
};

static const PrimitiveClass box = {
    .word = "box",
    .head = "box { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_BOX,
    .key_count = 2,
    .interval_count = 1,
    .is_sized = true,
    .support = primitive_box_support,
    .holds = box_holds,
    .dump = box_dump,
    .face_count = box_faces,
    .corner_count = four_corners,
    .corner = box_corner,
    .face_normal = box_normal,
    .measure = primitive_box_measure,
};

static const PrimitiveClass cone = {
    .word = "cylinder or cone",
    .head = "cone { 0, 1, z, ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_CONE,
    .key_count = 2,
    .interval_count = 1,
    .support = cone_support,
    .holds = cone_holds,
    .dump = dump_first,
    .face_count = cone_faces,
    .corner_count = round_corners,
    .corner = cone_corner,
    .face_normal = cone_normal,
};

static const PrimitiveClass disc = {
    .word = "disc",
    .head = "disc { 0, z, 1, ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_DISC,
    .key_count = 2,
    .support = disc_support,
    .holds = disc_holds,
    .dump = dump_first,
    .face_count = disc_faces,
    .corner_count = disc_corners,
    .corner = disc_corner,
    .face_normal = flat_normal,
};

static const PrimitiveClass triangle = {
    .word = "triangle",
    .head = "triangle { 0, x, y",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_TRIANGLE,
    .support = triangle_support,
    .face_count = one_face,
    .corner_count = three_corners,
    .corner = triangle_corner,
    .face_normal = flat_normal,
};

static const PrimitiveClass smooth_triangle = {
    .word = "smooth triangle",
    .head = "smooth_triangle { 0, ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_TRIANGLE,
    .support = triangle_support,
    .dump = smooth_triangle_dump,
    .face_count = one_face,
    .corner_count = three_corners,
    .corner = triangle_corner,
    .face_normal = flat_normal,
};

static const PrimitiveClass torus = {
    .word = "torus",
    .head = "torus { ",
    .family = FAMILY_TUBE,
    .surface = PRIMITIVE_TORUS,
    .key_count = 1,
    .interval_count = 2,
    .support = torus_support,
    .holds = torus_holds,
    .dump = torus_dump,
    .measure = torus_measure,
};

static const PrimitiveClass egg = {
    .word = "ovus",
    .head = "ovus { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_OVUS,
    .key_count = 3,
    .interval_count = 2,
    .support = egg_support,
    .holds = egg_holds,
    .dump = egg_dump,
};

static const PrimitiveClass *const classes[] = {
    [PRIMITIVE_SPHERE] = &sphere,
    [PRIMITIVE_PLANE] = &plane,
    [PRIMITIVE_BOX] = &box,
    [PRIMITIVE_CONE] = &cone,
    [PRIMITIVE_DISC] = &disc,
    [PRIMITIVE_TRIANGLE] = &triangle,
    [PRIMITIVE_SMOOTH_TRIANGLE] = &smooth_triangle,
    [PRIMITIVE_TORUS] = &torus,
    [PRIMITIVE_POLYNOMIAL] = &primitive_class_polynomial,
    [PRIMITIVE_BLOB] = &primitive_class_blob,
    [PRIMITIVE_PRISM] = &primitive_class_prism,
    [PRIMITIVE_POLYGON] = &primitive_class_polygon,
    [PRIMITIVE_LATHE] = &primitive_class_lathe,
    [PRIMITIVE_SOR] = &primitive_class_sor,
    [PRIMITIVE_SUPERELLIPSOID] = &primitive_class_superellipsoid,
    [PRIMITIVE_OVUS] = &egg,
    [PRIMITIVE_SWEEP] = &primitive_class_sweep,
    [PRIMITIVE_JULIA] = &primitive_class_julia,
    [PRIMITIVE_ISOSURFACE] = &primitive_class_isosurface,
    [PRIMITIVE_PARAMETRIC] = &primitive_class_parametric,
    [PRIMITIVE_MESH] = &primitive_class_mesh,
    [PRIMITIVE_MESH_SOLID] = &primitive_class_mesh_solid,
};

const PrimitiveClass *primitive_class(PrimitiveKind kind)
{
    return classes[kind];
}
