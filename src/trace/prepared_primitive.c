// Parts of each kind behind one interface: a table of kinds, each row a shape's own header.
//
// SPDX-License-Identifier: MIT
#include "trace/prepared_primitive.h"

#include <float.h>
#include <string.h>

#include "math/extreme.h"
#include "trace/blob.h"
#include "trace/box.h"
#include "trace/cone.h"
#include "trace/flat.h"
#include "trace/isosurface.h"
#include "trace/julia.h"
#include "trace/ovus.h"
#include "trace/parametric.h"
#include "trace/plane.h"
#include "trace/polynomial.h"
#include "trace/prism.h"
#include "trace/revolved.h"
#include "trace/sphere.h"
#include "trace/superellipsoid.h"
#include "trace/sweep.h"
#include "trace/torus.h"

static void unit_axes(Vec3 axes[3], double z)
{
    axes[0] = vec3(1.0, 0.0, 0.0);
    axes[1] = vec3(0.0, 1.0, 0.0);
    axes[2] = vec3(0.0, 0.0, z);
}

// ---- ball

// Of the unit sphere; the roots are those of trace/sphere.h, both of them.
static unsigned ball_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                               RayInterval *interval)
{
    (void)primitive;
    SphereRay ray = sphere_ray_make(object->origin, object->direction);
    Vec3 f = ray.origin;
    double t_middle = -vec3_dot(f, ray.direction_over_length2);
    *interval = (RayInterval){-(double)INFINITY, 2.0 * t_middle, 0, 0};
    if (left.side == 0) {
        return interval->leave > 0.0 ? 1u : 0u;
    }
    Vec3 l = vec3_add_scaled(f, t_middle, ray.direction);
    double discriminant = 1.0 - vec3_length_squared(l);
    if (!(discriminant >= 0.0)) {
        return 0;
    }
    double sum = t_middle + copysign(sqrt(discriminant * ray.inverse_square), t_middle);
    double product = (vec3_length_squared(f) - 1.0) * ray.inverse_square;
    interval->enter = t_middle > 0.0 ? product / sum : sum;
    interval->leave = t_middle > 0.0 ? sum : product / sum;
    return interval->enter <= interval->leave ? 1u : 0u;
}

static Vec3 ball_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)side;
    return point;
}

static Vec3 ball_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)side;
    return vec3_normalize(point);
}

static void ball_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)primitive;
    (void)middle;
    unit_axes(axes, 1.0);
}

// ---- plane

// The half space below a plane; a ray that leaves it inward never comes back.
static unsigned plane_intervals(const PreparedPrimitive *primitive, const Ray *ray, SideLeft left,
                                RayInterval *interval)
{
    PlaneShape plane = {primitive->data[0], primitive->data[1].x};
    double rise = vec3_dot(plane.normal, ray->direction);
    *interval = INTERVAL_ALL;
    if (left.side == 0) {
        return 1;
    }
    if (rise == 0.0) {
        return vec3_dot(plane.normal, ray->origin) <= plane.distance ? 1u : 0u;
    }
    double t = plane_root(&plane, ray->origin, ray->direction);
    *(rise > 0.0 ? &interval->leave : &interval->enter) = t;
    *(rise > 0.0 ? &interval->leave_side : &interval->enter_side) = 0;
    return isnan(t) ? 0u : 1u;
}

static Vec3 plane_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)point;
    (void)side;
    return primitive->data[0];
}

static Vec3 same_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)side;
    return point;
}

// ---- box

static unsigned box_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                              RayInterval *interval)
{
    return box_interval(primitive->data[0], primitive->data[1], object->origin, object->direction, left.side, interval)
               ? 1u
               : 0u;
}

static Vec3 box_side_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)point;
    return box_normal(side);
}

static Vec3 box_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return box_point(primitive->data[0], primitive->data[1], point, side);
}

static const double ROOT2 = 0x1.6a09e667f3bcdp+0, ROOT3 = 0x1.bb67ae8584caap+0;

static void box_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    Vec3 half = vec3_scale(0.5 * ROOT3, vec3_sub(primitive->data[1], primitive->data[0]));
    *middle = vec3_scale(0.5, vec3_add(primitive->data[0], primitive->data[1]));
    axes[0] = vec3(half.x, 0.0, 0.0);
    axes[1] = vec3(0.0, half.y, 0.0);
    axes[2] = vec3(0.0, 0.0, half.z);
}

// ---- cone

static unsigned cone_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                               RayInterval *interval)
{
    return cone_interval(primitive->data[0].x, object->origin, object->direction, left.side, interval) ? 1u : 0u;
}

static Vec3 cone_side_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return cone_normal(primitive->data[0].x, point, side);
}

static Vec3 cone_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return cone_gradient(primitive->data[0].x, point, side);
}

static Vec3 cone_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return cone_point(primitive->data[0].x, point, side);
}

// It counts as a cylinder.
static void cone_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)primitive;
    unit_axes(axes, 0.5 * ROOT3);
    *middle = vec3(0.0, 0.0, 0.5);
    axes[0].x = axes[1].y = ROOT3 / ROOT2;
}

// ---- flat ones

static bool disc_root(const PreparedPrimitive *primitive, const Ray *object, double *t)
{
    FlatPlace at = flat_place(object->origin, object->direction);
    *t = at.t;
    return disc_has(primitive->data[0].x, &at);
}

static bool triangle_root(const PreparedPrimitive *primitive, const Ray *object, double *t)
{
    (void)primitive;
    FlatPlace at = flat_place(object->origin, object->direction);
    *t = at.t;
    return triangle_has(&at);
}

static Vec3 flat_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)point;
    (void)side;
    return vec3(0.0, 0.0, 1.0);
}

// Where the normals at the corners cancel, that of the first.
static Vec3 smooth_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    Vec3 n = vec3_scale(1.0 - point.x - point.y, primitive->data[0]);
    n = vec3_add_scaled(vec3_add_scaled(n, point.x, primitive->data[1]), point.y, primitive->data[2]);
    return vec3_equal(n, vec3(0.0, 0.0, 0.0)) ? primitive->data[0] : n;
}

static Vec3 flat_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)primitive;
    (void)side;
    return vec3(point.x, point.y, 0.0);
}

static void disc_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)primitive;
    (void)middle;
    unit_axes(axes, 0.0);
}

// J. Steiner's ellipse.
static void triangle_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)primitive;
    *middle = vec3(1.0 / 3.0, 1.0 / 3.0, 0.0);
    axes[0] = vec3(-1.0 / 3.0, 2.0 / 3.0, 0.0);
    axes[1] = vec3(-1.0 / ROOT3, 0.0, 0.0);
    axes[2] = vec3(0.0, 0.0, 0.0);
}

// ---- torus

static unsigned torus_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                     RayInterval *intervals)
{
    return torus_intervals(primitive->data[0].x, primitive->data[0].y, object, left, intervals);
}

static Vec3 torus_side_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return torus_normal(primitive->data[0].x, point, side);
}

static Vec3 torus_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return torus_gradient(primitive->data[0].x, point, side);
}

static Vec3 torus_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return torus_point(primitive->data[0].x, primitive->data[0].y, point, side);
}

// Through the corners of the rectangle that turns to the cylinder around it.
static void torus_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)middle;
    double width = ROOT2 * (primitive->data[0].x + primitive->data[0].y);
    axes[0] = vec3(width, 0.0, 0.0);
    axes[1] = vec3(0.0, ROOT2 * primitive->data[0].y, 0.0);
    axes[2] = vec3(0.0, 0.0, width);
}

// ---- polynomial

static unsigned polynomial_most(const PreparedPrimitive *primitive)
{
    return primitive_is_convex(primitive) ? 1 : primitive->interval_most;
}

static unsigned polynomial_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                          RayInterval *intervals)
{
    return polynomial_intervals(primitive->list.items, object, left, polynomial_most(primitive), intervals);
}

static unsigned polynomial_side_within(const PreparedPrimitive *primitive, const Ray *object, SideLeft left, double low,
                                       double high, RayInterval *intervals)
{
    return polynomial_intervals_within(primitive->list.items, object, left, (LineRange){low, high},
                                       polynomial_most(primitive), intervals);
}

static Vec3 polynomial_side_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return polynomial_normal(primitive->list.items, point);
}

static Vec3 polynomial_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return polynomial_slope(primitive->list.items, point);
}

// ---- blob

static unsigned blob_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                    RayInterval *intervals)
{
    return blob_intervals(primitive->list.items, primitive->node == NODE_NONE, object, left, intervals);
}

static Vec3 blob_side_normal(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return blob_normal(primitive->list.items, point);
}

// ---- prism and polygon

static unsigned prism_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                     RayInterval *intervals)
{
    return prism_intervals(&primitive->list, primitive->fixed[0], primitive->fixed[1], object, left, intervals);
}

static Vec3 prism_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return prism_gradient(&primitive->list, point, side);
}

static Vec3 prism_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return prism_point(&primitive->list, primitive->fixed[0].y, primitive->fixed[1].y, point, side);
}

static bool polygon_root(const PreparedPrimitive *primitive, const Ray *object, double *t)
{
    FlatPlace at = flat_place(object->origin, object->direction);
    *t = at.t;
    return object->direction.z != 0.0 && outline_holds(&primitive->list, (OutlinePoint){at.x, at.y});
}

// ---- lathe and surface of revolution

static unsigned lathe_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                     RayInterval *intervals)
{
    return lathe_intervals(&primitive->list, primitive->fixed[0], primitive->fixed[1], object, left, intervals);
}

static Vec3 lathe_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return lathe_gradient(&primitive->list, point, side);
}

static Vec3 lathe_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return lathe_point(&primitive->list, point, side);
}

static unsigned sor_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                   RayInterval *intervals)
{
    return sor_intervals(&primitive->list, primitive->fixed[0], primitive->fixed[1], object, left, intervals);
}

static Vec3 sor_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return sor_gradient(&primitive->list, point, side);
}

static Vec3 sor_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    return sor_point(&primitive->list, point, side);
}

// ---- superellipsoid

static unsigned superellipsoid_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                              RayInterval *intervals)
{
    return superellipsoid_intervals(primitive->data[0], object, left, intervals);
}

static Vec3 superellipsoid_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return superellipsoid_gradient(primitive->data[0], point);
}

static Vec3 superellipsoid_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return superellipsoid_point(primitive->data[0], point);
}

static void cube_axes(const PreparedPrimitive *primitive, Vec3 axes[3], Vec3 *middle)
{
    (void)primitive;
    (void)middle;
    for (int i = 0; i < 3; i++) {
        axes[i] = vec3(i == 0 ? ROOT3 : 0.0, i == 1 ? ROOT3 : 0.0, i == 2 ? ROOT3 : 0.0);
    }
}

// ---- sphere sweep

static unsigned sweep_side_intervals(const PreparedPrimitive *primitive, const Ray *object, SideLeft left,
                                     RayInterval *intervals)
{
    return sweep_intervals(primitive->list.items, object, left, intervals);
}

static Vec3 sweep_side_gradient(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return sweep_gradient(primitive->list.items, point);
}

static Vec3 sweep_side_point(const PreparedPrimitive *primitive, Vec3 point, uint8_t side)
{
    (void)side;
    return sweep_point(primitive->list.items, point);
}

// ---- the table

const PreparedClass prepared_classes[PRIMITIVE_KINDS] = {
    [PRIMITIVE_SPHERE] = {.intervals = ball_intervals,
                          .normal = ball_normal,
                          .gradient = ball_normal,
                          .point = ball_point,
                          .axes = ball_axes},
    [PRIMITIVE_PLANE] = {.intervals = plane_intervals,
                         .normal = plane_normal,
                         .gradient = plane_normal,
                         .point = same_point},
    [PRIMITIVE_BOX] = {.intervals = box_intervals,
                       .normal = box_side_normal,
                       .gradient = box_side_normal,
                       .point = box_side_point,
                       .axes = box_axes,
                       .across = {1, 1, 2, 2, 3, 3}},
    [PRIMITIVE_CONE] = {.intervals = cone_intervals,
                        .normal = cone_side_normal,
                        .gradient = cone_side_gradient,
                        .point = cone_side_point,
                        .axes = cone_axes,
                        .across = {0, 3, 3}},
    [PRIMITIVE_DISC] = {.root = disc_root,
                        .normal = flat_normal,
                        .gradient = flat_normal,
                        .point = flat_point,
                        .axes = disc_axes,
                        .across = {3}},
    [PRIMITIVE_TRIANGLE] = {.root = triangle_root,
                            .normal = flat_normal,
                            .gradient = flat_normal,
                            .point = flat_point,
                            .axes = triangle_axes,
                            .across = {3}},
    [PRIMITIVE_SMOOTH_TRIANGLE] = {.root = triangle_root,
                                   .normal = smooth_normal,
                                   .gradient = flat_normal,
                                   .point = flat_point,
                                   .axes = triangle_axes,
                                   .across = {3}},
    [PRIMITIVE_TORUS] = {.intervals = torus_side_intervals,
                         .normal = torus_side_normal,
                         .gradient = torus_side_gradient,
                         .point = torus_side_point,
                         .axes = torus_axes,
                         .films = 1 << TORUS_INNER},
    [PRIMITIVE_POLYNOMIAL] = {.intervals = polynomial_side_intervals,
                              .intervals_within = polynomial_side_within,
                              .normal = polynomial_side_normal,
                              .gradient = polynomial_side_gradient,
                              .point = same_point,
                              .axes = box_axes},
    [PRIMITIVE_BLOB] = {.intervals = blob_side_intervals,
                        .normal = blob_side_normal,
                        .gradient = blob_side_normal,
                        .point = same_point,
                        .axes = box_axes},
    [PRIMITIVE_PRISM] = {.intervals = prism_side_intervals,
                         .normal = prism_side_gradient,
                         .gradient = prism_side_gradient,
                         .point = prism_side_point,
                         .axes = box_axes,
                         .across = {0, 2, 2},
                         .turns = true},
    [PRIMITIVE_POLYGON] = {.root = polygon_root,
                           .normal = flat_normal,
                           .gradient = flat_normal,
                           .point = flat_point,
                           .axes = box_axes,
                           .across = {3}},
    [PRIMITIVE_LATHE] = {.intervals = lathe_side_intervals,
                         .normal = lathe_side_gradient,
                         .gradient = lathe_side_gradient,
                         .point = lathe_side_point,
                         .axes = box_axes,
                         .unseen = (uint8_t)~1,
                         .turns = true},
    [PRIMITIVE_SOR] = {.intervals = sor_side_intervals,
                       .normal = sor_side_gradient,
                       .gradient = sor_side_gradient,
                       .point = sor_side_point,
                       .axes = box_axes,
                       .across = {0, 2, 2}},
    [PRIMITIVE_SUPERELLIPSOID] = {.intervals = superellipsoid_side_intervals,
                                  .normal = superellipsoid_side_gradient,
                                  .gradient = superellipsoid_side_gradient,
                                  .point = superellipsoid_side_point,
                                  .axes = cube_axes},
    [PRIMITIVE_OVUS] = {.intervals = ovus_intervals,
                        .normal = ovus_gradient,
                        .gradient = ovus_gradient,
                        .point = ovus_point,
                        .axes = cube_axes},
    [PRIMITIVE_SWEEP] = {.intervals = sweep_side_intervals,
                         .normal = sweep_side_gradient,
                         .gradient = sweep_side_gradient,
                         .point = sweep_side_point,
                         .axes = box_axes},
    [PRIMITIVE_JULIA] = {.intervals = julia_intervals,
                         .normal = julia_normal,
                         .gradient = julia_normal,
                         .point = same_point,
                         .axes = box_axes,
                         .turns = true},
    [PRIMITIVE_ISOSURFACE] = {.intervals = isosurface_intervals,
                              .normal = isosurface_normal,
                              .gradient = isosurface_normal,
                              .point = isosurface_point,
                              .axes = box_axes,
                              .turns = true,
                              .unseen = 1 << ISOSURFACE_UNSEEN},
    [PRIMITIVE_PARAMETRIC] = {.intervals = parametric_intervals,
                              .met = parametric_met,
                              .point = same_point,
                              .axes = box_axes,
                              .films = 1 << PARAMETRIC_SIDE},
    [PRIMITIVE_MESH] = {.axes = box_axes}, // all else is in trace/mesh.h
    [PRIMITIVE_MESH_SOLID] = {.axes = box_axes},
};
