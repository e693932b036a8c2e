// What the language says of each kind of shape, a row a kind: when it is one, how it becomes a fixed shape under a map
// (scene.h, PrimitiveKind), which points are inside of it for `inside`, and POV-Ray's box for min_extent and
// max_extent.
//
// Knows nothing of composites, textures and rays.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <string.h>

#include "eval/build/blocks.h"
#include "math/extreme.h"
#include "scene/mesh_field.h"
#include "scene/polynomial.h"
#include "scene/within.h"

// Half of what a disc is thick.
static const double disc_thickness = 0.001;

// ---- sphere and plane: their extents follow rules of their own

static const char *sphere_form(const void *object, Primitive *primitive)
{
    const SphereDesc *sphere = object;
    return primitive_make_ball(primitive, sphere->centre, fabs(sphere->radius));
}

// Nothing is on either side of its surface.
static bool sphere_holds(const void *object, Vec3 p, bool is_turned)
{
    const SphereDesc *sphere = object;
    Vec3 from = vec3_sub(p, sphere->centre);
    double distance2 = vec3_dot(from, from), radius2 = sphere->radius * sphere->radius;
    return is_turned ? distance2 > radius2 : distance2 < radius2;
}

static bool plane_settle(Desc *record)
{
    return !vec3_equal(record->plane.normal, vec3(0.0, 0.0, 0.0));
}

// Both sides have its surface.
static bool plane_holds(const void *object, Vec3 p, bool is_turned)
{
    const PlaneDesc *plane = object;
    double beyond = vec3_dot(vec3_normalize(plane->normal), p) - plane->distance;
    return (is_turned ? -beyond : beyond) < WITHIN_PLANE;
}

// ---- box

static const char *box_form(const void *object, Primitive *primitive)
{
    const BoxDesc *box = object;
    primitive_make_box(primitive, box->corner, box->other_corner);
    return NULL;
}

static bool is_between(double a, double value, double b)
{
    return (a <= value && value <= b) || (b <= value && value <= a);
}

static bool box_holds(const void *object, Vec3 p, bool is_turned)
{
    const BoxDesc *box = object;
    bool holds = is_between(box->corner.x, p.x, box->other_corner.x) &&
                 is_between(box->corner.y, p.y, box->other_corner.y) &&
                 is_between(box->corner.z, p.z, box->other_corner.z);
    return holds != is_turned;
}

static bool box_box(const void *object, OwnBox *own)
{
    const BoxDesc *box = object;
    own->low = vec3_least(box->corner, box->other_corner);
    own->high = vec3_greatest(box->corner, box->other_corner);
    return false;
}

// ---- cylinder and cone

static bool round_holds(Vec3 base, double base_radius, Vec3 cap, double cap_radius, Vec3 p)
{
    Vec3 axis = vec3_sub(cap, base), from = vec3_sub(p, base);
    double height = vec3_dot(from, axis) / vec3_dot(axis, axis);
    double radius = base_radius + height * (cap_radius - base_radius);
    Vec3 across = vec3_sub(from, vec3_scale(height, axis));
    return height > 0.0 && height < 1.0 && vec3_dot(across, across) < radius * radius;
}

// A cone's own space has its tip at 0 and its wide end at z = 1, a cylinder's its cap at 0 and its base at 1.
static bool round_box(Vec3 base, double base_radius, Vec3 cap, double cap_radius, OwnBox *own)
{
    bool is_wide_at_cap = cap_radius > base_radius;
    Vec3 wide = is_wide_at_cap ? cap : base, narrow = is_wide_at_cap ? base : cap;
    double radius = fmax(base_radius, cap_radius);
    double begin = base_radius == cap_radius ? 0.0 : fmin(base_radius, cap_radius) / radius;
    Vec3 axis = vec3_scale(1.0 / (1.0 - begin), vec3_sub(wide, narrow));
    own->low = vec3(-1.0, -1.0, begin);
    own->high = vec3(1.0, 1.0, 1.0);
    own->frame = extent_frame(axis, radius, vec3_length(axis), vec3_sub(wide, axis));
    return true;
}

static bool cylinder_settle(Desc *record)
{
    record->cylinder.radius = fabs(record->cylinder.radius);
    return !vec3_equal(record->cylinder.base, record->cylinder.cap);
}

static const char *cylinder_form(const void *object, Primitive *primitive)
{
    const CylinderDesc *c = object;
    return primitive_make_cylinder(primitive, c->base, c->cap, c->radius, c->is_open);
}

static bool cylinder_holds(const void *object, Vec3 p, bool is_turned)
{
    const CylinderDesc *c = object;
    return round_holds(c->base, c->radius, c->cap, c->radius, p) != is_turned;
}

static bool cylinder_box(const void *object, OwnBox *own)
{
    const CylinderDesc *c = object;
    return round_box(c->base, c->radius, c->cap, c->radius, own);
}

static bool cone_settle(Desc *record)
{
    return !vec3_equal(record->cone.base, record->cone.cap);
}

static const char *cone_form(const void *object, Primitive *primitive)
{
    const ConeDesc *c = object;
    return primitive_make_cone(primitive, c->base, c->base_radius, c->cap, c->cap_radius, c->is_open);
}

static bool cone_holds(const void *object, Vec3 p, bool is_turned)
{
    const ConeDesc *c = object;
    return round_holds(c->base, c->base_radius, c->cap, c->cap_radius, p) != is_turned;
}

static bool cone_box(const void *object, OwnBox *own)
{
    const ConeDesc *c = object;
    return round_box(c->base, c->base_radius, c->cap, c->cap_radius, own);
}

// ---- disc

static bool disc_settle(Desc *record)
{
    record->disc.radius = fabs(record->disc.radius);
    record->disc.hole = fabs(record->disc.hole);
    return true;
}

static const char *disc_form(const void *object, Primitive *primitive)
{
    const DiscDesc *disc = object;
    return primitive_make_disc(primitive, disc->centre, disc->normal, disc->radius, disc->hole);
}

static bool disc_holds(const void *object, Vec3 p, bool is_turned)
{
    const DiscDesc *disc = object;
    return (vec3_dot(disc->normal, vec3_sub(p, disc->centre)) < 0.0) != is_turned;
}

static bool disc_box(const void *object, OwnBox *own)
{
    const DiscDesc *disc = object;
    own->low = vec3(-disc->radius, -disc->radius, -disc_thickness);
    own->high = vec3(disc->radius, disc->radius, disc_thickness);
    own->frame = extent_frame(disc->normal, 1.0, 1.0, disc->centre);
    return true;
}

// ---- torus

// The fixed one is as large as a power of two leaves it, so that it is the same when a dump is read.
static const char *torus_form(const void *object, Primitive *primitive)
{
    const TorusDesc *torus = object;
    int exponent;
    if (torus->minor == 0.0) {
        return "a torus with a minor radius of 0 is not drawn";
    }
    frexp(torus->major + torus->minor, &exponent);
    double size = ldexp(1.0, exponent);
    primitive->kind = PRIMITIVE_TORUS;
    primitive->data[0] = vec3(ldexp(torus->major, -exponent), ldexp(torus->minor, -exponent), 0.0);
    primitive->to_world = transform_scale(vec3(size, size, size));
    return NULL;
}

// With its surface. Measured.
static bool torus_holds(const void *object, Vec3 p, bool is_turned)
{
    const TorusDesc *torus = object;
    double from = hypot(p.x, p.z) - torus->major;
    return (from * from + p.y * p.y <= torus->minor * torus->minor) != is_turned;
}

static bool torus_box(const void *object, OwnBox *own)
{
    const TorusDesc *torus = object;
    own->high = vec3(torus->major + torus->minor, torus->minor, torus->major + torus->minor);
    own->low = vec3_neg(own->high);
    return false;
}

// ---- polynomials

// Those of a quadric, in the order of a poly's.
static void quadric_coefficients(const PolynomialDesc *quadric, double *to)
{
    const Vec3 *squares = &quadric->squares, *products = &quadric->products, *linear = &quadric->linear;
    const double all[] = {squares->x,  products->x, products->y, linear->x, squares->y,
                          products->z, linear->y,   squares->z,  linear->z, quadric->constant};
    memcpy(to, all, sizeof all);
}

static bool endless_box(const void *object, OwnBox *own)
{
    (void)object;
    own->high = vec3(INFINITY, INFINITY, INFINITY);
    own->low = vec3_neg(own->high);
    return false;
}

// How many coefficients stand before that of x^i y^j z^k in the order of a poly's.
static unsigned place_of(unsigned order, const unsigned powers[3])
{
    unsigned x = order - powers[0], y = x - powers[1];
    return x * (x + 1) * (x + 2) / 6 + y * (y + 1) / 2 + y - powers[2];
}

// What stands in one place of a term, a number.
static bool term_number(Block *block, const AstNode *item, double *number)
{
    Value value;
    return eval_expression(block->ev, item, &value) && value_number(block->ev, &value, item->span, number) &&
           block_finite(block, *number, item->span, "xyz");
}

// Powers lose their fractions. Measured.
static bool read_term(Block *block, const AstNode *term, double *coefficients)
{
    unsigned order = (unsigned)block->record->polynomial.order, powers[3], sum = 0, count = 0;
    for (const AstNode *item = term->a; item; item = item->next) {
        double power;
        if (!term_number(block, item, &power)) {
            return false;
        }
        if (!(power > -1.0 && power < order + 1.0 - sum)) {
            return block_fault(block, DIAG_E0480, item->span,
                               "the powers of a term of order %u are at least 0, and %u together at most", order,
                               order);
        }
        powers[count] = (unsigned)(int)power;
        sum += powers[count++];
    }
    return term_number(block, term->b, &coefficients[place_of(order, powers)]);
}

bool polynomial_body(Block *block)
{
    PolynomialDesc *polynomial = &block->record->polynomial;
    if (block->has_fault) { // there may be no order
        return false;
    }
    unsigned count = polynomial_count((unsigned)polynomial->order);
    double *coefficients = arena_alloc_array(block->arena, count, sizeof *coefficients);
    if (!coefficients) {
        return eval_no_memory(block->ev, block->node->span);
    }
    memset(coefficients, 0, count * sizeof *coefficients);
    polynomial->coefficients = (Numbers){coefficients, count};
    cursor_take_comma(&block->cursor);
    const AstNode *item;
    while ((item = cursor_peek(&block->cursor)) && item->kind == AST_TERM) {
        if (!read_term(block, item, coefficients)) {
            block->has_fault = true;
        }
        cursor_skip(&block->cursor);
        cursor_take_comma(&block->cursor);
    }
    return true;
}

static bool polynomial_close(Block *block)
{
    PolynomialDesc *polynomial = &block->record->polynomial;
    unsigned order = (unsigned)polynomial->order, needed = polynomial_count(order);
    bool is_quadric = block->is == KIND_QUADRIC;
    if (!is_quadric && polynomial->coefficients.count != needed) {
        return block_fault(block, DIAG_E0480, block->node->span, "a polynomial of order %u has %u coefficients, not %u",
                           order, needed, (unsigned)polynomial->coefficients.count);
    }
    double *list = arena_alloc_array(block->arena, polynomial_list_count(order), sizeof *list);
    if (!list) {
        return eval_no_memory(block->ev, block->node->span);
    }
    list[0] = order;
    double *to = list + (polynomial_list_count(order) - needed);
    if (is_quadric) {
        quadric_coefficients(polynomial, to);
    } else {
        memcpy(to, polynomial->coefficients.items, needed * sizeof *to);
    }
    polynomial->list = (Numbers){list, polynomial_list_count(order)};
    polynomial_complete(list);
    return true;
}

static const char *polynomial_form(const void *object, Primitive *primitive)
{
    const PolynomialDesc *polynomial = object;
    polynomial_part(&polynomial->list, primitive);
    return polynomial_is_constant(polynomial->list.items) ? "a polynomial that is the same everywhere is not drawn"
                                                          : NULL;
}

// Where the squares have one sign and there are no products; a quadric that is turned has no end. Measured.
static bool quadric_box(const void *object, OwnBox *own)
{
    const PolynomialDesc *q = object;
    Vec3 a = q->squares, b = vec3_scale(-0.5, q->linear);
    double sign = copysign(1.0, a.x);
    Vec3 middle = vec3(b.x / a.x, b.y / a.y, b.z / a.z);
    double depth = sign * (vec3_dot(b, middle) - q->constant);
    Vec3 half = vec3(sqrt(depth / fabs(a.x)), sqrt(depth / fabs(a.y)), sqrt(depth / fabs(a.z)));
    bool is_alike = sign * a.x > 0.0 && sign * a.y > 0.0 && sign * a.z > 0.0;
    if (!is_alike || !vec3_equal(q->products, vec3(0.0, 0.0, 0.0)) || !(depth > 0.0) || !vec3_is_finite(half)) {
        return endless_box(object, own);
    }
    own->low = vec3_sub(middle, half);
    own->high = vec3_add(middle, half);
    return false;
}

// POV-Ray's tolerance of all but quadrics. Measured.
static bool polynomial_holds(const void *object, Vec3 p, bool is_turned)
{
    const PolynomialDesc *polynomial = object;
    return (polynomial_value(polynomial->list.items, p) < 1e-4) != is_turned;
}

static bool quadric_holds(const void *object, Vec3 p, bool is_turned)
{
    const PolynomialDesc *polynomial = object;
    return (polynomial_value(polynomial->list.items, p) <= 0.0) != is_turned;
}

// ---- triangles: their boxes are those of their corners in the scene

static const char *triangle_form(const void *object, Primitive *primitive)
{
    const TriangleDesc *triangle = object;
    return primitive_make_triangle(primitive, triangle->corners);
}

static const char *smooth_triangle_form(const void *object, Primitive *primitive)
{
    const SmoothTriangleDesc *triangle = object;
    return primitive_make_smooth_triangle(primitive, triangle->corners, triangle->normals);
}

// ---- meshes

static const char *mesh_form(const void *object, Primitive *primitive)
{
    const Mesh *mesh = ((const MeshDesc *)object)->mesh;
    primitive->kind = mesh->has_inside ? PRIMITIVE_MESH_SOLID : PRIMITIVE_MESH;
    primitive->mesh = (PrimitiveMesh){mesh->low, mesh->high, mesh, 0};
    return NULL;
}

static bool mesh_has_inside(const void *object)
{
    return ((const MeshDesc *)object)->mesh->has_inside;
}

static bool mesh_has(const void *object, Vec3 p, bool is_turned)
{
    return mesh_has_inside(object) && mesh_holds(((const MeshDesc *)object)->mesh, p) != is_turned;
}

static bool mesh_box(const void *object, OwnBox *own)
{
    const Mesh *mesh = ((const MeshDesc *)object)->mesh;
    own->low = mesh->low;
    own->high = mesh->high;
    return false;
}

// ---- height fields: what is seen of them is above the water

static bool field_box(const void *object, OwnBox *own)
{
    const Mesh *mesh = ((const MeshDesc *)object)->mesh;
    own->low = vec3(0.0, greater_of(mesh->low.y, mesh->field->water), 0.0);
    own->high = vec3(1.0, mesh->high.y, 1.0);
    return false;
}

static bool field_has(const void *object, Vec3 p, bool is_turned)
{
    const Mesh *mesh = ((const MeshDesc *)object)->mesh;
    return mesh_holds(mesh, vec3_mul(mesh_field_size(mesh->field), p)) != is_turned;
}

static const char *field_form(const void *object, Primitive *primitive)
{
    const Mesh *mesh = ((const MeshDesc *)object)->mesh;
    Vec3 size = mesh_field_size(mesh->field);
    OwnBox box;
    (void)field_box(object, &box);
    primitive->kind = PRIMITIVE_MESH_SOLID;
    primitive->to_world = transform_scale(vec3(1.0 / size.x, 1.0, 1.0 / size.z));
    primitive->mesh = (PrimitiveMesh){vec3_mul(size, box.low), vec3_mul(size, box.high), mesh, 0};
    return box.low.y > box.high.y ? "it is all below its water level" : NULL;
}

// ---- the table

static const ShapeClass classes[KIND_COUNT] = {
    [KIND_SPHERE] = {.form = sphere_form, .holds = sphere_holds},
    [KIND_PLANE] = {.settle = plane_settle,
                    .code = DIAG_E0342,
                    .fault = "the normal of a plane cannot be <0, 0, 0>",
                    .holds = plane_holds},
    [KIND_BOX] = {.form = box_form, .holds = box_holds, .box = box_box},
    [KIND_CYLINDER] = {.settle = cylinder_settle,
                       .code = DIAG_E0361,
                       .fault = "the ends of a cylinder cannot be one point",
                       .form = cylinder_form,
                       .holds = cylinder_holds,
                       .box = cylinder_box},
    [KIND_CONE] = {.settle = cone_settle,
                   .code = DIAG_E0361,
                   .fault = "the ends of a cone cannot be one point",
                   .form = cone_form,
                   .holds = cone_holds,
                   .box = cone_box},
    [KIND_DISC] = {.is_flat = true, .settle = disc_settle, .form = disc_form, .holds = disc_holds, .box = disc_box},
    [KIND_TORUS] = {.form = torus_form, .holds = torus_holds, .box = torus_box},
    [KIND_BLOB] = {.close = blob_close, .form = blob_form, .holds = blob_holds, .box = blob_box},
    [KIND_QUADRIC] = {.close = polynomial_close, .form = polynomial_form, .holds = quadric_holds, .box = quadric_box},
    [KIND_CUBIC] = {.close = polynomial_close, .form = polynomial_form, .holds = polynomial_holds, .box = endless_box},
    [KIND_QUARTIC] = {.close = polynomial_close,
                      .form = polynomial_form,
                      .holds = polynomial_holds,
                      .box = endless_box},
    [KIND_POLY] = {.close = polynomial_close, .form = polynomial_form, .holds = polynomial_holds, .box = endless_box},
    [KIND_POLYNOMIAL] = {.close = polynomial_close,
                         .form = polynomial_form,
                         .holds = polynomial_holds,
                         .box = endless_box},
    [KIND_ISOSURFACE] = {.close = isosurface_close,
                         .form = isosurface_form,
                         .holds = isosurface_has,
                         .box = isosurface_box},
    [KIND_OVUS] = {.form = ovus_form, .holds = ovus_has, .box = ovus_box},
    [KIND_PARAMETRIC] = {.is_flat = true, .close = parametric_close, .form = parametric_form, .box = parametric_box},
    [KIND_PRISM] = {.form = prism_form, .holds = prism_holds, .box = prism_box},
    [KIND_LATHE] = {.form = lathe_form, .holds = lathe_holds, .box = lathe_box},
    [KIND_SUPERELLIPSOID] = {.form = superellipsoid_form, .holds = superellipsoid_has, .box = superellipsoid_box},
    [KIND_JULIA_FRACTAL] = {.close = julia_close, .form = julia_form, .holds = julia_has, .box = julia_box},
    [KIND_SPHERE_SWEEP] = {.form = sweep_form, .holds = sweep_has, .box = sweep_box},
    [KIND_SOR] = {.form = sor_form, .holds = sor_has, .box = sor_box},
    [KIND_POLYGON] = {.is_flat = true, .form = polygon_form, .box = polygon_box},
    [KIND_TRIANGLE] = {.is_flat = true, .form = triangle_form, .corners_at = offsetof(TriangleDesc, corners)},
    [KIND_SMOOTH_TRIANGLE] = {.is_flat = true,
                              .form = smooth_triangle_form,
                              .corners_at = offsetof(SmoothTriangleDesc, corners)},
    [KIND_MESH] = {.form = mesh_form, .has_inside = mesh_has_inside, .holds = mesh_has, .box = mesh_box},
    [KIND_MESH2] = {.form = mesh_form, .has_inside = mesh_has_inside, .holds = mesh_has, .box = mesh_box},
    [KIND_BICUBIC_PATCH] = {.is_flat = true, .box = bicubic_box}, // it is made by bicubic_make
    [KIND_HEIGHT_FIELD] = {.form = field_form, .holds = field_has, .box = field_box},
};

const ShapeClass *shape_class(SchemaKind kind)
{
    return &classes[kind];
}

bool shape_is_flat(SchemaKind kind, const void *object)
{
    const ShapeClass *shape = shape_class(kind);
    return shape->has_inside ? !shape->has_inside(object) : shape->is_flat;
}
