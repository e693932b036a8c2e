// The rows of the table of primitives, and what each row's functions say; see PartKind in scene.h for the fixed shapes.
//
// SPDX-License-Identifier: MIT
#include "scene/primitive.h"

#include <math.h>

#include "math/length.h"
#include "scene/blob.h"
#include "scene/isosurface.h"
#include "scene/julia.h"
#include "scene/dump.h"
#include "scene/part.h"
#include "scene/polynomial.h"
#include "scene/outline.h"
#include "scene/sor.h"
#include "scene/superellipsoid.h"
#include "scene/sweep.h"

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

static void dump_first(const Part *part, TextBuffer *out)
{
    dump_number(out, "", part->data[0].x);
}

// ---- ball

static double ball_support(const Part *part, Vec3 n)
{
    (void)part;
    return length_of(n.x, n.y, n.z);
}

static bool ball_holds(const Part *part, Vec3 p)
{
    (void)part;
    return vec3_dot(p, p) < 1.0;
}

// ---- plane: part_support knows the only direction in which it ends, and faces.c what has no corners

static double plane_support(const Part *part, Vec3 n)
{
    (void)part;
    (void)n;
    return (double)INFINITY;
}

static bool plane_holds(const Part *part, Vec3 p)
{
    return vec3_dot(p, part->data[0]) < part->data[1].x;
}

static void plane_dump(const Part *part, TextBuffer *out)
{
    dump_vector(out, "", part->data[0]);
    dump_number(out, ", ", part->data[1].x);
}

static uint32_t one_face(const Part *part)
{
    (void)part;
    return 1;
}

static uint32_t no_corners(const Part *part)
{
    (void)part;
    return 0;
}

// ---- box

static double box_support(const Part *part, Vec3 n)
{
    const Vec3 *low = &part->data[0], *high = &part->data[1];
    return fmax(low->x * n.x, high->x * n.x) + fmax(low->y * n.y, high->y * n.y) + fmax(low->z * n.z, high->z * n.z);
}

static bool box_holds(const Part *part, Vec3 p)
{
    const Vec3 *low = &part->data[0], *high = &part->data[1];
    return is_between(low->x, p.x, high->x) && is_between(low->y, p.y, high->y) && is_between(low->z, p.z, high->z);
}

static void box_dump(const Part *part, TextBuffer *out)
{
    dump_vector(out, "", part->data[0]);
    dump_vector(out, ", ", part->data[1]);
}

static uint32_t box_faces(const Part *part)
{
    (void)part;
    return 6;
}

static Vec3 box_corner(const Part *part, uint32_t number, uint32_t i)
{
    const double low[3] = {part->data[0].x, part->data[0].y, part->data[0].z};
    const double high[3] = {part->data[1].x, part->data[1].y, part->data[1].z};
    uint32_t axis = number / 2, second = (axis + 1) % 3, third = (axis + 2) % 3;
    double p[3];
    p[axis] = number % 2 ? high[axis] : low[axis];
    p[second] = i == 1 || i == 2 ? high[second] : low[second];
    p[third] = i >= 2 ? high[third] : low[third];
    return vec3(p[0], p[1], p[2]);
}

static uint32_t four_corners(const Part *part)
{
    (void)part;
    return 4;
}

static Vec3 box_normal(uint32_t number)
{
    double side = number % 2 ? 1.0 : -1.0;
    uint32_t axis = number / 2;
    return vec3(axis == 0 ? side : 0.0, axis == 1 ? side : 0.0, axis == 2 ? side : 0.0);
}

static void box_measure(const Part *part, Vec3 *half, Vec3 *middle)
{
    *half = vec3_scale(0.5, vec3_sub(part->data[1], part->data[0]));
    *middle = vec3_add(vec3_scale(0.5, part->data[0]), vec3_scale(0.5, part->data[1]));
}

// ---- cone

static double cone_support(const Part *part, Vec3 n)
{
    double round = length_of(n.x, n.y, 0.0);
    return fmax(round, part->data[0].x * round + n.z);
}

static bool cone_holds(const Part *part, Vec3 p)
{
    double radius = 1.0 + (part->data[0].x - 1.0) * p.z;
    return is_between(0.0, p.z, 1.0) && p.x * p.x + p.y * p.y < radius * radius;
}

static uint32_t cone_faces(const Part *part)
{
    return part->flags & PART_OPEN ? 0 : part->data[0].x > 0.0 ? 2 : 1;
}

static uint32_t round_corners(const Part *part)
{
    (void)part;
    return FACE_CORNERS_MOST;
}

static Vec3 cone_corner(const Part *part, uint32_t number, uint32_t i)
{
    return round_corner(number, number ? part->data[0].x : 1.0, i);
}

static Vec3 cone_normal(uint32_t number)
{
    return vec3(0.0, 0.0, number ? 1.0 : -1.0);
}

// ---- disc

static double disc_support(const Part *part, Vec3 n)
{
    (void)part;
    return length_of(n.x, n.y, 0.0);
}

static bool disc_holds(const Part *part, Vec3 p)
{
    (void)part;
    return p.z < 0.0;
}

// A ring is taken in pieces.
static uint32_t disc_faces(const Part *part)
{
    return part->data[0].x > 0.0 ? FACE_CORNERS_MOST : 1;
}

// Of one of the pieces of a ring, its inner edge just outside of the hole.
static Vec3 ring_corner(double hole, uint32_t number, uint32_t i)
{
    double angle = 2.0 * M_PI * (number + (i == 1 || i == 2)) / FACE_CORNERS_MOST;
    double radius = i < 2 ? 1.0 : fmin(1.0, hole / cos(M_PI / FACE_CORNERS_MOST));
    return vec3(radius * cos(angle), radius * sin(angle), 0.0);
}

static uint32_t disc_corners(const Part *part)
{
    return part->data[0].x > 0.0 ? 4 : FACE_CORNERS_MOST;
}

static Vec3 disc_corner(const Part *part, uint32_t number, uint32_t i)
{
    return part->data[0].x > 0.0 ? ring_corner(part->data[0].x, number, i) : round_corner(0.0, 1.0, i);
}

static Vec3 flat_normal(uint32_t number)
{
    (void)number;
    return vec3(0.0, 0.0, 1.0);
}

// ---- triangles

static double triangle_support(const Part *part, Vec3 n)
{
    (void)part;
    return fmax(0.0, fmax(n.x, n.y));
}

static uint32_t three_corners(const Part *part)
{
    (void)part;
    return 3;
}

static Vec3 triangle_corner(const Part *part, uint32_t number, uint32_t i)
{
    (void)part;
    (void)number;
    return vec3(i == 1, i == 2, 0.0);
}

static void smooth_triangle_dump(const Part *part, TextBuffer *out)
{
    dump_vector(out, "", part->data[0]);
    dump_vector(out, ", x, ", part->data[1]);
    dump_vector(out, ", y, ", part->data[2]);
}

// ---- torus

static double torus_support(const Part *part, Vec3 n)
{
    double round = hypot(n.x, n.z);
    return part->data[0].x * round + part->data[0].y * hypot(round, n.y);
}

// With its surface, as in POV-Ray; and what the tube goes through itself in, where it does.
static bool torus_holds(const Part *part, Vec3 p)
{
    double from = hypot(p.x, p.z) - part->data[0].x, minor = part->data[0].y;
    return from * from + p.y * p.y <= minor * minor;
}

static void torus_dump(const Part *part, TextBuffer *out)
{
    dump_number(out, "", part->data[0].x);
    dump_number(out, ", ", part->data[0].y);
}

// The tube, somewhere on the ring.
static void torus_measure(const Part *part, Vec3 *half, Vec3 *middle)
{
    *half = vec3(part->data[0].y, part->data[0].y, part->data[0].y);
    *middle = vec3(part->data[0].x, 0.0, 0.0);
}

// ---- polynomial

static double polynomial_support(const Part *part, Vec3 n)
{
    return part_is_endless(part) ? (double)INFINITY : box_support(part, n);
}

static bool polynomial_holds(const Part *part, Vec3 p)
{
    return polynomial_value(part->list.items, p) < 0.0;
}

static void polynomial_dump(const Part *part, TextBuffer *out)
{
    unsigned order = polynomial_order(part->list.items);
    text_printf(out, "%u, ", order);
    dump_numbers(out, polynomial_terms(part->list.items), polynomial_count(order));
}

static uint32_t polynomial_interval_most(const Part *part)
{
    return polynomial_order(part->list.items) / 2 + 1;
}

// Of one that is endless nothing is known but the map.
static void polynomial_measure(const Part *part, Vec3 *half, Vec3 *middle)
{
    if (part_is_endless(part)) {
        *half = vec3(1.0, 1.0, 1.0);
        *middle = vec3(0.0, 0.0, 0.0);
    } else {
        box_measure(part, half, middle);
    }
}

// ---- blob

static bool blob_holds(const Part *part, Vec3 p)
{
    return blob_field(part->list.items, p) > part->list.items[0];
}

// Alone it is asked for the first few only.
static uint32_t blob_part_intervals(const Part *part)
{
    return part->node == NODE_NONE ? 4 : blob_interval_most(part->list.items);
}

// ---- isosurface

static bool surface_holds(const Part *part, Vec3 p)
{
    return isosurface_holds(part->list.items, part->host, p);
}

// Alone it is asked for the first surface only.
static uint32_t isosurface_intervals(const Part *part)
{
    return part->node == NODE_NONE ? 2 : ISOSURFACE_ROOTS_MOST + 1;
}

// ---- prism and polygon

static double prism_support(const Part *part, Vec3 n)
{
    double low = part->fixed[0].y, high = part->fixed[1].y;
    OutlinePoint across = {n.x, n.z};
    if (!outline_is_conic(&part->list)) {
        return outline_support(&part->list, across) + fmax(low * n.y, high * n.y);
    }
    OutlinePoint at_low = {low * n.x, low * n.z}, at_high = {high * n.x, high * n.z};
    return fmax(outline_support(&part->list, at_low) + low * n.y, outline_support(&part->list, at_high) + high * n.y);
}

static bool prism_holds(const Part *part, Vec3 p)
{
    bool is_conic = outline_is_conic(&part->list);
    OutlinePoint seen = is_conic ? (OutlinePoint){p.x / p.y, p.z / p.y} : (OutlinePoint){p.x, p.z};
    return is_between(part->fixed[0].y, p.y, part->fixed[1].y) && outline_holds(&part->list, seen);
}

static uint32_t outline_intervals(const Part *part)
{
    return outline_crossings_most(&part->list) / 2 + 2;
}

// Of straight pieces the first point of each curve, which then ends with it; of others all control points.
static void outline_dump(const Part *part, TextBuffer *out)
{
    unsigned degree = outline_degree(&part->list), first = 0;
    uint32_t pieces = outline_piece_count(&part->list), count = 4 * pieces;
    for (int pass = degree == 1 ? 0 : 1; pass < 2; pass++) {
        bool begins = true;
        count = pass ? count : 0;
        if (pass) {
            text_printf(out, "%u", count);
        }
        for (uint32_t i = 0; i < pieces; i++) {
            const double *piece = outline_piece(&part->list, i), *end = piece + 2 * degree;
            first = begins ? i : first;
            const double *start = outline_piece(&part->list, first);
            for (unsigned k = degree == 1 && !begins ? 1 : 0; k <= degree; k++) {
                count += pass ? 0 : 1;
                if (pass) {
                    text_append(out, ", ");
                    dump_numbers(out, piece + 2 * k, 2);
                }
            }
            begins = end[0] == start[0] && end[1] == start[1];
        }
    }
}

static void prism_dump(const Part *part, TextBuffer *out)
{
    text_append(out, outline_degree(&part->list) == 1 ? "linear_spline " : "bezier_spline ");
    text_append(out, outline_is_conic(&part->list) ? "conic_sweep " : "");
    dump_number(out, "", part->fixed[0].y);
    dump_number(out, ", ", part->fixed[1].y);
    text_append(out, ", ");
    outline_dump(part, out);
}

static double polygon_support(const Part *part, Vec3 n)
{
    return outline_support(&part->list, (OutlinePoint){n.x, n.y});
}

// ---- lathe

static double lathe_support(const Part *part, Vec3 n)
{
    double round = hypot(n.x, n.z), right = outline_support(&part->list, (OutlinePoint){round, n.y});
    bool is_mirrored = part->list.items[OUTLINE_MIRRORED] != 0.0;
    return is_mirrored ? fmax(right, outline_support(&part->list, (OutlinePoint){-round, n.y})) : right;
}

static bool lathe_holds(const Part *part, Vec3 p)
{
    return outline_holds_turned(&part->list, hypot(p.x, p.z), p.y);
}

static uint32_t lathe_intervals(const Part *part)
{
    return lathe_crossings_most(&part->list) / 2 + 1;
}

// What is not seen is made anew when it is read.
static void lathe_dump(const Part *part, TextBuffer *out)
{
    unsigned degree = outline_degree(&part->list);
    uint32_t pieces = outline_piece_count(&part->list), seen = 0;
    while (seen < pieces && outline_piece(&part->list, seen)[PIECE_DEGREE - PIECE_POINTS] != 0.0) {
        seen++;
    }
    text_append(out, degree == 1 ? "linear_spline " : "bezier_spline ");
    text_printf(out, "%u", degree == 1 ? seen + 1 : 4 * seen);
    for (uint32_t i = 0; i < seen; i++) {
        for (unsigned k = degree == 1 && i > 0 ? 1 : 0; k <= degree; k++) {
            text_append(out, ", ");
            dump_numbers(out, outline_piece(&part->list, i) + 2 * k, 2);
        }
    }
}

// ---- surface of revolution

// The discs of its ends, the cylinders about its stretches.
static double sor_support(const Part *part, Vec3 n)
{
    double round = hypot(n.x, n.z), most = -(double)INFINITY;
    for (uint32_t i = 0; i < sor_stretch_count(&part->list); i++) {
        const double *f = sor_squares(&part->list, i);
        double square = fmax(fmax(f[0], f[1]), fmax(f[2], f[3]));
        double y = fmax(sor_height(&part->list, i) * n.y, sor_height(&part->list, i + 1) * n.y);
        most = square >= 0.0 ? fmax(most, round * sqrt(square) + y) : most;
    }
    return most;
}

static bool sor_part_holds(const Part *part, Vec3 p)
{
    return sor_holds(&part->list, p.x * p.x + p.z * p.z, p.y);
}

static uint32_t sor_intervals(const Part *part)
{
    return sor_crossings_most(&part->list) / 2 + 1;
}

static void sor_dump(const Part *part, TextBuffer *out)
{
    uint32_t count = sor_point_count(&part->list);
    text_printf(out, "%u", count);
    for (uint32_t i = 0; i < count; i++) {
        text_append(out, ", ");
        dump_numbers(out, sor_point_at(&part->list, i), 2);
    }
}

// ---- superellipsoid

static double superellipsoid_support(const Part *part, Vec3 n)
{
    (void)part;
    return fabs(n.x) + fabs(n.y) + fabs(n.z);
}

static bool superellipsoid_holds(const Part *part, Vec3 p)
{
    return superellipsoid_size(part->data[0], p) < 1.0;
}

static void superellipsoid_dump(const Part *part, TextBuffer *out)
{
    dump_numbers(out, &part->data[0].x, 2);
}

// ---- sphere sweep

static bool sweep_holds(const Part *part, Vec3 p)
{
    Sweep sweep = sweep_of(part->list.items);
    SweepBall ball;
    return sweep_nearest(&sweep, p, &ball) < 0.0;
}

static uint32_t sweep_interval_most(const Part *part)
{
    return SWEEP_PIECES_MOST * sweep_of(part->list.items).segment_count + 1;
}

static void sweep_dump(const Part *part, TextBuffer *out)
{
    static const char *const words[] = {
        [SWEEP_LINEAR] = "linear_spline", [SWEEP_B_SPLINE] = "b_spline", [SWEEP_CUBIC] = "cubic_spline"};
    Sweep sweep = sweep_of(part->list.items);
    text_printf(out, "%s %u", words[sweep.curve], sweep.ball_count);
    for (uint32_t i = 0; i < sweep.ball_count; i++) {
        dump_vector(out, ", ", sweep.balls[i].middle);
        dump_number(out, ", ", sweep.balls[i].radius);
    }
}

// ---- Julia fractal

static bool julia_part_holds(const Part *part, Vec3 p)
{
    double reach;
    return julia_holds(julia_of(part->list.items), p, &reach);
}

// Alone it is asked for the first surface only.
static uint32_t julia_part_intervals(const Part *part)
{
    return part->node == NODE_NONE ? 2 : JULIA_INTERVALS_MOST + 2;
}

static void julia_dump(const Part *part, TextBuffer *out)
{
    const Julia *julia = julia_of(part->list.items);
    dump_numbers(out, julia->p, 4);
    text_append(out, julia->power > 2.0 ? " quaternion cube" : " quaternion sqr");
    dump_number(out, " max_iteration ", julia->step_count);
    dump_number(out, " precision ", julia->precision);
    text_append(out, " slice ");
    dump_numbers(out, julia->slice, 4);
    dump_number(out, ", ", julia->distance);
}

// ---- meshes: they reach as far as their boxes

static bool solid_mesh_holds(const Part *part, Vec3 p)
{
    return mesh_holds(part->mesh.mesh, p);
}

// What is below a field of heights is inside, however deep; but what it clips is in POV-Ray's box of it.
static double solid_mesh_support(const Part *part, Vec3 n)
{
    bool is_cut = part->node != NODE_NONE && !(part->flags & PART_UNSEEN);
    bool is_endless = part->mesh.mesh->field && is_cut && n.y < 0.0;
    return is_endless ? (double)INFINITY : box_support(part, n);
}

// ---- the table

static const PrimitiveClass classes[] = {
    [PART_SPHERE] = {.word = "sphere",
                     .head = "sphere { 0, 1",
                     .family = FAMILY_ROUND,
                     .surface = PART_SPHERE,
                     .interval_count = 1,
                     .support = ball_support,
                     .holds = ball_holds},
    [PART_PLANE] = {.word = "plane",
                    .head = "plane { ",
                    .family = FAMILY_STRAIGHT,
                    .surface = PART_PLANE,
                    .key_count = 2,
                    .interval_count = 1,
                    .support = plane_support,
                    .holds = plane_holds,
                    .dump = plane_dump,
                    .face_count = one_face,
                    .corner_count = no_corners},
    [PART_BOX] = {.word = "box",
                  .head = "box { ",
                  .family = FAMILY_STRAIGHT,
                  .surface = PART_BOX,
                  .key_count = 2,
                  .interval_count = 1,
                  .is_sized = true,
                  .support = box_support,
                  .holds = box_holds,
                  .dump = box_dump,
                  .face_count = box_faces,
                  .corner_count = four_corners,
                  .corner = box_corner,
                  .face_normal = box_normal,
                  .measure = box_measure},
    [PART_CONE] = {.word = "cylinder or cone",
                   .head = "cone { 0, 1, z, ",
                   .family = FAMILY_STRAIGHT,
                   .surface = PART_CONE,
                   .key_count = 2,
                   .interval_count = 1,
                   .support = cone_support,
                   .holds = cone_holds,
                   .dump = dump_first,
                   .face_count = cone_faces,
                   .corner_count = round_corners,
                   .corner = cone_corner,
                   .face_normal = cone_normal},
    [PART_DISC] = {.word = "disc",
                   .head = "disc { 0, z, 1, ",
                   .family = FAMILY_STRAIGHT,
                   .surface = PART_DISC,
                   .key_count = 2,
                   .support = disc_support,
                   .holds = disc_holds,
                   .dump = dump_first,
                   .face_count = disc_faces,
                   .corner_count = disc_corners,
                   .corner = disc_corner,
                   .face_normal = flat_normal},
    [PART_TRIANGLE] = {.word = "triangle",
                       .head = "triangle { 0, x, y",
                       .family = FAMILY_STRAIGHT,
                       .surface = PART_TRIANGLE,
                       .support = triangle_support,
                       .face_count = one_face,
                       .corner_count = three_corners,
                       .corner = triangle_corner,
                       .face_normal = flat_normal},
    [PART_SMOOTH_TRIANGLE] = {.word = "smooth triangle",
                              .head = "smooth_triangle { 0, ",
                              .family = FAMILY_STRAIGHT,
                              .surface = PART_TRIANGLE,
                              .support = triangle_support,
                              .dump = smooth_triangle_dump,
                              .face_count = one_face,
                              .corner_count = three_corners,
                              .corner = triangle_corner,
                              .face_normal = flat_normal},
    [PART_TORUS] = {.word = "torus",
                    .head = "torus { ",
                    .family = FAMILY_TUBE,
                    .surface = PART_TORUS,
                    .key_count = 1,
                    .interval_count = 2,
                    .support = torus_support,
                    .holds = torus_holds,
                    .dump = torus_dump,
                    .measure = torus_measure},
    [PART_POLYNOMIAL] = {.word = "polynomial",
                         .head = "poly { ",
                         .family = FAMILY_POLYNOMIAL,
                         .surface = PART_POLYNOMIAL,
                         .key_count = 3,
                         .interval_count = 2,
                         .has_list = true,
                         .is_sized = true,
                         .interval_most = polynomial_interval_most,
                         .support = polynomial_support,
                         .holds = polynomial_holds,
                         .dump = polynomial_dump,
                         .measure = polynomial_measure},
    [PART_BLOB] = {.word = "blob",
                   .head = "blob { ",
                   .family = FAMILY_BLOB,
                   .surface = PART_BLOB,
                   .key_count = 3,
                   .interval_count = 2,
                   .has_list = true,
                   .is_sized = true,
                   .interval_most = blob_part_intervals,
                   .support = box_support,
                   .holds = blob_holds,
                   .measure = box_measure},
    [PART_PRISM] = {.word = "prism",
                    .head = "prism { ",
                    .family = FAMILY_STRAIGHT,
                    .surface = PART_PRISM,
                    .key_count = 3,
                    .interval_count = 2,
                    .interval_most = outline_intervals,
                    .has_list = true,
                    .is_sized = true,
                    .support = prism_support,
                    .holds = prism_holds,
                    .dump = prism_dump,
                    .measure = box_measure},
    [PART_POLYGON] = {.word = "polygon",
                      .head = "polygon { ",
                      .family = FAMILY_STRAIGHT,
                      .surface = PART_POLYGON,
                      .key_count = 3,
                      .has_list = true,
                      .is_sized = true,
                      .support = polygon_support,
                      .dump = outline_dump,
                      .measure = box_measure},
    [PART_LATHE] = {.word = "lathe",
                    .head = "lathe { ",
                    .family = FAMILY_STRAIGHT,
                    .surface = PART_LATHE,
                    .key_count = 3,
                    .interval_count = 2,
                    .interval_most = lathe_intervals,
                    .has_list = true,
                    .is_sized = true,
                    .support = lathe_support,
                    .holds = lathe_holds,
                    .dump = lathe_dump,
                    .measure = box_measure},
    [PART_SOR] = {.word = "sor",
                  .head = "sor { ",
                  .family = FAMILY_STRAIGHT,
                  .surface = PART_SOR,
                  .key_count = 3,
                  .interval_count = 2,
                  .interval_most = sor_intervals,
                  .has_list = true,
                  .is_sized = true,
                  .support = sor_support,
                  .holds = sor_part_holds,
                  .dump = sor_dump,
                  .measure = box_measure},
    [PART_SUPERELLIPSOID] = {.word = "superellipsoid",
                             .head = "superellipsoid { ",
                             .family = FAMILY_STRAIGHT,
                             .surface = PART_SUPERELLIPSOID,
                             .key_count = 1,
                             .interval_count = SUPERELLIPSOID_INTERVALS,
                             .support = superellipsoid_support,
                             .holds = superellipsoid_holds,
                             .dump = superellipsoid_dump},
    [PART_SWEEP] = {.word = "sphere sweep",
                    .head = "sphere_sweep { ",
                    .family = FAMILY_STRAIGHT,
                    .surface = PART_SWEEP,
                    .key_count = 3,
                    .interval_count = 2,
                    .interval_most = sweep_interval_most,
                    .has_list = true,
                    .is_sized = true,
                    .support = box_support,
                    .holds = sweep_holds,
                    .dump = sweep_dump,
                    .measure = box_measure},
    [PART_JULIA] = {.word = "Julia fractal",
                    .head = "julia_fractal { ",
                    .family = FAMILY_ISOSURFACE,
                    .surface = PART_JULIA,
                    .key_count = 3,
                    .interval_count = 2,
                    .interval_most = julia_part_intervals,
                    .has_list = true,
                    .is_sized = true,
                    .support = box_support,
                    .holds = julia_part_holds,
                    .dump = julia_dump,
                    .measure = box_measure},
    [PART_ISOSURFACE] = {.word = "isosurface",
                         .head = "isosurface {",
                         .family = FAMILY_ISOSURFACE,
                         .surface = PART_ISOSURFACE,
                         .key_count = 3,
                         .interval_count = 2,
                         .interval_most = isosurface_intervals,
                         .has_list = true,
                         .is_sized = true,
                         .support = box_support,
                         .holds = surface_holds,
                         .measure = box_measure},
    [PART_MESH] = {.word = "mesh",
                   .head = "",
                   .family = FAMILY_STRAIGHT,
                   .surface = PART_MESH,
                   .key_count = 1,
                   .is_mesh = true,
                   .is_sized = true,
                   .support = box_support,
                   .measure = box_measure},
    [PART_MESH_SOLID] = {.word = "mesh",
                         .head = "",
                         .family = FAMILY_STRAIGHT,
                         .surface = PART_MESH,
                         .key_count = 1,
                         .interval_count = 2,
                         .is_mesh = true,
                         .is_sized = true,
                         .support = solid_mesh_support,
                         .holds = solid_mesh_holds,
                               .measure = box_measure},
};

const PrimitiveClass *primitive_class(PartKind kind)
{
    return &classes[kind];
}
