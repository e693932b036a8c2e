// The rows of the table of primitives that lists of numbers, arrays or formulas make, and what each row's functions say.
//
// SPDX-License-Identifier: MIT
#include "scene/primitive_rows.h"

#include <math.h>

#include "scene/blob.h"
#include "scene/isosurface.h"
#include "scene/julia.h"
#include "scene/dump.h"
#include "scene/primitive_reach.h"
#include "scene/polynomial.h"
#include "scene/outline.h"
#include "scene/sor.h"
#include "scene/superellipsoid.h"
#include "scene/sweep.h"

static bool is_between(double low, double value, double high)
{
    return low <= value && value <= high;
}

// ---- polynomial

static double polynomial_support(const Primitive *primitive, Vec3 n)
{
    return primitive_is_endless(primitive) ? (double)INFINITY : primitive_box_support(primitive, n);
}

static bool polynomial_holds(const Primitive *primitive, Vec3 p)
{
    return polynomial_value(primitive->list.items, p) < 0.0;
}

static void polynomial_dump(const Primitive *primitive, TextBuffer *out)
{
    unsigned order = polynomial_order(primitive->list.items);
    text_printf(out, "%u, ", order);
    dump_numbers(out, polynomial_terms(primitive->list.items), polynomial_count(order));
}

static uint32_t polynomial_interval_most(const Primitive *primitive)
{
    return polynomial_order(primitive->list.items) / 2 + 1;
}

// Of one that is endless nothing is known but the map.
static void polynomial_measure(const Primitive *primitive, Vec3 *half, Vec3 *middle)
{
    if (primitive_is_endless(primitive)) {
        *half = vec3(1.0, 1.0, 1.0);
        *middle = vec3(0.0, 0.0, 0.0);
    } else {
        primitive_box_measure(primitive, half, middle);
    }
}

// ---- blob

static bool blob_holds(const Primitive *primitive, Vec3 p)
{
    return blob_field(primitive->list.items, p) > primitive->list.items[0];
}

// Alone it is asked for the first few only.
static uint32_t blob_part_intervals(const Primitive *primitive)
{
    return primitive->node == NODE_NONE ? 4 : blob_interval_most(primitive->list.items);
}

// ---- isosurface

static bool surface_holds(const Primitive *primitive, Vec3 p)
{
    return isosurface_holds(primitive->list.items, primitive->host, p);
}

// Alone it is asked for the first surface only.
static uint32_t isosurface_intervals(const Primitive *primitive)
{
    return primitive->node == NODE_NONE ? 2 : ISOSURFACE_ROOTS_MOST + 1;
}

// ---- prism and polygon

static double prism_support(const Primitive *primitive, Vec3 n)
{
    double low = primitive->fixed[0].y, high = primitive->fixed[1].y;
    OutlinePoint across = {n.x, n.z};
    if (!outline_is_conic(&primitive->list)) {
        return outline_support(&primitive->list, across) + fmax(low * n.y, high * n.y);
    }
    OutlinePoint at_low = {low * n.x, low * n.z}, at_high = {high * n.x, high * n.z};
    return fmax(outline_support(&primitive->list, at_low) + low * n.y,
                outline_support(&primitive->list, at_high) + high * n.y);
}

static bool prism_holds(const Primitive *primitive, Vec3 p)
{
    bool is_conic = outline_is_conic(&primitive->list);
    OutlinePoint seen = is_conic ? (OutlinePoint){p.x / p.y, p.z / p.y} : (OutlinePoint){p.x, p.z};
    return is_between(primitive->fixed[0].y, p.y, primitive->fixed[1].y) && outline_holds(&primitive->list, seen);
}

static uint32_t outline_intervals(const Primitive *primitive)
{
    return outline_crossings_most(&primitive->list) / 2 + 2;
}

// Of straight pieces the first point of each curve, which then ends with it; of others all control points.
static void outline_dump(const Primitive *primitive, TextBuffer *out)
{
    unsigned degree = outline_degree(&primitive->list), first = 0;
    uint32_t pieces = outline_piece_count(&primitive->list), count = 4 * pieces;
    for (int pass = degree == 1 ? 0 : 1; pass < 2; pass++) {
        bool begins = true;
        count = pass ? count : 0;
        if (pass) {
            text_printf(out, "%u", count);
        }
        for (uint32_t i = 0; i < pieces; i++) {
            const double *piece = outline_piece(&primitive->list, i), *end = piece + 2 * degree;
            first = begins ? i : first;
            const double *start = outline_piece(&primitive->list, first);
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

static void prism_dump(const Primitive *primitive, TextBuffer *out)
{
    text_append(out, outline_degree(&primitive->list) == 1 ? "linear_spline " : "bezier_spline ");
    text_append(out, outline_is_conic(&primitive->list) ? "conic_sweep " : "");
    dump_number(out, "", primitive->fixed[0].y);
    dump_number(out, ", ", primitive->fixed[1].y);
    text_append(out, ", ");
    outline_dump(primitive, out);
}

// One with curves was a prism without a height, and is written as that.
static void polygon_dump(const Primitive *primitive, TextBuffer *out)
{
    bool is_curved = outline_degree(&primitive->list) > 1;
    text_append(out, is_curved ? "prism { bezier_spline 0, 0, " : "polygon { ");
    outline_dump(primitive, out);
    text_append(out, is_curved ? " rotate -90*x" : "");
}

static double polygon_support(const Primitive *primitive, Vec3 n)
{
    return outline_support(&primitive->list, (OutlinePoint){n.x, n.y});
}

// ---- lathe

static double lathe_support(const Primitive *primitive, Vec3 n)
{
    double round = hypot(n.x, n.z), right = outline_support(&primitive->list, (OutlinePoint){round, n.y});
    bool is_mirrored = primitive->list.items[OUTLINE_MIRRORED] != 0.0;
    return is_mirrored ? fmax(right, outline_support(&primitive->list, (OutlinePoint){-round, n.y})) : right;
}

static bool lathe_holds(const Primitive *primitive, Vec3 p)
{
    return outline_holds_turned(&primitive->list, hypot(p.x, p.z), p.y);
}

static uint32_t lathe_intervals(const Primitive *primitive)
{
    return lathe_crossings_most(&primitive->list) / 2 + 1;
}

// What is not seen is made anew when it is read.
static void lathe_dump(const Primitive *primitive, TextBuffer *out)
{
    unsigned degree = outline_degree(&primitive->list);
    uint32_t pieces = outline_piece_count(&primitive->list), seen = 0;
    while (seen < pieces && outline_piece(&primitive->list, seen)[PIECE_DEGREE - PIECE_POINTS] != 0.0) {
        seen++;
    }
    text_append(out, degree == 1 ? "linear_spline " : "bezier_spline ");
    text_printf(out, "%u", degree == 1 ? seen + 1 : 4 * seen);
    for (uint32_t i = 0; i < seen; i++) {
        for (unsigned k = degree == 1 && i > 0 ? 1 : 0; k <= degree; k++) {
            text_append(out, ", ");
            dump_numbers(out, outline_piece(&primitive->list, i) + 2 * k, 2);
        }
    }
}

// ---- surface of revolution

// The discs of its ends, the cylinders about its stretches.
static double sor_support(const Primitive *primitive, Vec3 n)
{
    double round = hypot(n.x, n.z), most = -(double)INFINITY;
    for (uint32_t i = 0; i < sor_stretch_count(&primitive->list); i++) {
        const double *f = sor_squares(&primitive->list, i);
        double square = fmax(fmax(f[0], f[1]), fmax(f[2], f[3]));
        double y = fmax(sor_height(&primitive->list, i) * n.y, sor_height(&primitive->list, i + 1) * n.y);
        most = square >= 0.0 ? fmax(most, round * sqrt(square) + y) : most;
    }
    return most;
}

static bool sor_part_holds(const Primitive *primitive, Vec3 p)
{
    return sor_holds(&primitive->list, p.x * p.x + p.z * p.z, p.y);
}

static uint32_t sor_intervals(const Primitive *primitive)
{
    return sor_crossings_most(&primitive->list) / 2 + 1;
}

static void sor_dump(const Primitive *primitive, TextBuffer *out)
{
    uint32_t count = sor_point_count(&primitive->list);
    text_printf(out, "%u", count);
    for (uint32_t i = 0; i < count; i++) {
        text_append(out, ", ");
        dump_numbers(out, sor_point_at(&primitive->list, i), 2);
    }
}

// ---- superellipsoid

static double superellipsoid_support(const Primitive *primitive, Vec3 n)
{
    (void)primitive;
    return fabs(n.x) + fabs(n.y) + fabs(n.z);
}

static bool superellipsoid_holds(const Primitive *primitive, Vec3 p)
{
    return superellipsoid_size(primitive->data[0], p) < 1.0;
}

static void superellipsoid_dump(const Primitive *primitive, TextBuffer *out)
{
    dump_numbers(out, &primitive->data[0].x, 2);
}

// ---- sphere sweep

static bool sweep_holds(const Primitive *primitive, Vec3 p)
{
    Sweep sweep = sweep_of(primitive->list.items);
    SweepBall ball;
    return sweep_nearest(&sweep, p, &ball) < 0.0;
}

static uint32_t sweep_interval_most(const Primitive *primitive)
{
    return SWEEP_PIECES_MOST * sweep_of(primitive->list.items).segment_count + 1;
}

static void sweep_dump(const Primitive *primitive, TextBuffer *out)
{
    static const char *const words[] = {
        [SWEEP_LINEAR] = "linear_spline", [SWEEP_B_SPLINE] = "b_spline", [SWEEP_CUBIC] = "cubic_spline"};
    Sweep sweep = sweep_of(primitive->list.items);
    text_printf(out, "%s %u", words[sweep.curve], sweep.ball_count);
    for (uint32_t i = 0; i < sweep.ball_count; i++) {
        dump_vector(out, ", ", sweep.balls[i].middle);
        dump_number(out, ", ", sweep.balls[i].radius);
    }
}

// ---- Julia fractal

static bool julia_part_holds(const Primitive *primitive, Vec3 p)
{
    double reach;
    return julia_holds(julia_of(primitive->list.items), p, &reach);
}

// Alone it is asked for the first surface only.
static uint32_t julia_part_intervals(const Primitive *primitive)
{
    return primitive->node == NODE_NONE ? 2 : JULIA_INTERVALS_MOST + 2;
}

static void julia_dump(const Primitive *primitive, TextBuffer *out)
{
    const Julia *julia = julia_of(primitive->list.items);
    dump_numbers(out, julia->p, 4);
    text_append(out, julia->power > 2.0 ? " quaternion cube" : " quaternion sqr");
    dump_number(out, " max_iteration ", julia->step_count);
    dump_number(out, " precision ", julia->precision);
    text_append(out, " slice ");
    dump_numbers(out, julia->slice, 4);
    dump_number(out, ", ", julia->distance);
}

// ---- meshes: they reach as far as their boxes

static bool solid_mesh_holds(const Primitive *primitive, Vec3 p)
{
    return mesh_holds(primitive->mesh.mesh, p);
}

// What is below a field of heights is inside, however deep; but what it clips is in POV-Ray's box of it.
static double solid_mesh_support(const Primitive *primitive, Vec3 n)
{
    bool is_cut = primitive->node != NODE_NONE && !(primitive->flags & PRIMITIVE_UNSEEN);
    bool is_endless = primitive->mesh.mesh->field && is_cut && n.y < 0.0;
    return is_endless ? (double)INFINITY : primitive_box_support(primitive, n);
}

// ---- the rows

const PrimitiveClass primitive_class_polynomial = {
    .word = "polynomial",
    .head = "poly { ",
    .family = FAMILY_POLYNOMIAL,
    .surface = PRIMITIVE_POLYNOMIAL,
    .key_count = 3,
    .interval_count = 2,
    .has_list = true,
    .is_sized = true,
    .interval_most = polynomial_interval_most,
    .support = polynomial_support,
    .holds = polynomial_holds,
    .dump = polynomial_dump,
    .measure = polynomial_measure,
};

const PrimitiveClass primitive_class_blob = {
    .word = "blob",
    .head = "blob { ",
    .family = FAMILY_BLOB,
    .surface = PRIMITIVE_BLOB,
    .key_count = 3,
    .interval_count = 2,
    .has_list = true,
    .is_sized = true,
    .interval_most = blob_part_intervals,
    .support = primitive_box_support,
    .holds = blob_holds,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_prism = {
    .word = "prism",
    .head = "prism { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_PRISM,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = outline_intervals,
    .has_list = true,
    .is_sized = true,
    .support = prism_support,
    .holds = prism_holds,
    .dump = prism_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_polygon = {
    .word = "polygon",
    .head = "", // polygon_dump has it
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_POLYGON,
    .key_count = 3,
    .has_list = true,
    .is_sized = true,
    .support = polygon_support,
    .dump = polygon_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_lathe = {
    .word = "lathe",
    .head = "lathe { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_LATHE,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = lathe_intervals,
    .has_list = true,
    .is_sized = true,
    .support = lathe_support,
    .holds = lathe_holds,
    .dump = lathe_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_sor = {
    .word = "sor",
    .head = "sor { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_SOR,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = sor_intervals,
    .has_list = true,
    .is_sized = true,
    .support = sor_support,
    .holds = sor_part_holds,
    .dump = sor_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_superellipsoid = {
    .word = "superellipsoid",
    .head = "superellipsoid { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_SUPERELLIPSOID,
    .key_count = 1,
    .interval_count = SUPERELLIPSOID_INTERVALS,
    .support = superellipsoid_support,
    .holds = superellipsoid_holds,
    .dump = superellipsoid_dump,
};

const PrimitiveClass primitive_class_sweep = {
    .word = "sphere sweep",
    .head = "sphere_sweep { ",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_SWEEP,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = sweep_interval_most,
    .has_list = true,
    .is_sized = true,
    .support = primitive_box_support,
    .holds = sweep_holds,
    .dump = sweep_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_julia = {
    .word = "Julia fractal",
    .head = "julia_fractal { ",
    .family = FAMILY_ISOSURFACE,
    .surface = PRIMITIVE_JULIA,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = julia_part_intervals,
    .has_list = true,
    .is_sized = true,
    .support = primitive_box_support,
    .holds = julia_part_holds,
    .dump = julia_dump,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_isosurface = {
    .word = "isosurface",
    .head = "isosurface {",
    .family = FAMILY_ISOSURFACE,
    .surface = PRIMITIVE_ISOSURFACE,
    .key_count = 3,
    .interval_count = 2,
    .interval_most = isosurface_intervals,
    .has_list = true,
    .is_sized = true,
    .support = primitive_box_support,
    .holds = surface_holds,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_parametric = {
    .word = "parametric surface",
    .head = "parametric {",
    .family = FAMILY_ISOSURFACE,
    .surface = PRIMITIVE_PARAMETRIC,
    .key_count = 3,
    .interval_count = 2,
    .has_list = true,
    .is_sized = true,
    .support = primitive_box_support,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_mesh = {
    .word = "mesh",
    .head = "",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_MESH,
    .key_count = 1,
    .is_mesh = true,
    .is_sized = true,
    .support = primitive_box_support,
    .measure = primitive_box_measure,
};

const PrimitiveClass primitive_class_mesh_solid = {
    .word = "mesh",
    .head = "",
    .family = FAMILY_STRAIGHT,
    .surface = PRIMITIVE_MESH,
    .key_count = 1,
    .interval_count = 2,
    .is_mesh = true,
    .is_sized = true,
    .support = solid_mesh_support,
    .holds = solid_mesh_holds,
    .measure = primitive_box_measure,
};
