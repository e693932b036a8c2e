// Surface coordinates of each kind of shape, one small function for each, from points in the shape's own space.
//
// SPDX-License-Identifier: MIT
#include "trace/surface_map.h"

#include <math.h>

#include "trace/geometry.h"
#include "trace/mesh.h"
#include "trace/parametric.h"
#include "trace/revolved.h"

static const double two_pi = 6.28318530717958647693;

static Vec3 uv(double u, double v)
{
    return vec3(u, v, 0.0);
}

// The share of a turn about y, from +x by +z, from 0 to 1.
static double turn_of(Vec3 p)
{
    double turn = p.x == 0.0 && p.z == 0.0 ? 0.0 : atan2(p.z, p.x) / two_pi;
    return turn < 0.0 ? turn + 1.0 : turn;
}

static Vec3 of_sphere(Vec3 p)
{
    double length = vec3_length(p), sine = length > 0.0 ? p.y / length : 0.0;
    return uv(turn_of(p), 0.5 + 2.0 * asin(fmax(-1.0, fmin(sine, 1.0))) / two_pi);
}

static Vec3 of_torus(const PreparedPrimitive *torus, Vec3 p)
{
    double turn = 0.5 - (p.x == 0.0 && p.z == 0.0 ? 0.0 : atan2(p.z, p.x) / two_pi);
    return uv(turn, 0.5 + atan2(p.y, hypot(p.x, p.z) - torus->data[0].x) / two_pi);
}

// A box unfolded: four sides in a row, lids above and below the second one; a square is 1/4 wide and 1/3 high.
static Vec3 of_box(const PreparedPrimitive *box, Vec3 p, uint8_t side)
{
    Vec3 low = box->data[0], size = vec3_sub(box->data[1], low);
    double x = size.x > 0.0 ? (p.x - low.x) / size.x : 0.0, y = size.y > 0.0 ? (p.y - low.y) / size.y : 0.0;
    double z = size.z > 0.0 ? (p.z - low.z) / size.z : 0.0, v = (1.0 + y) / 3.0;
    switch (side) {
    case 0: return uv(z / 4.0, v);
    case 1: return uv((3.0 - z) / 4.0, v);
    case 2: return uv((1.0 + x) / 4.0, z / 3.0);
    case 3: return uv((1.0 + x) / 4.0, (3.0 - z) / 3.0);
    case 4: return uv((4.0 - x) / 4.0, v);
    default: return uv((1.0 + x) / 4.0, v);
    }
}

static Vec3 of_parametric(const PreparedPrimitive *primitive, Vec3 point, Vec3 direction)
{
    double pair[2];
    parametric_uv(primitive, point, direction, pair);
    return uv(pair[0], pair[1]);
}

static Vec3 of_part(const PreparedPrimitive *primitive, Vec3 point, Vec3 direction, uint8_t side, Vec3 place)
{
    Vec3 own = linear_direction(&primitive->to_object, vec3_sub(point, primitive->centre));
    switch ((PrimitiveKind)primitive->kind) {
    case PRIMITIVE_SPHERE:
    case PRIMITIVE_OVUS:
        return of_sphere(own);
    case PRIMITIVE_PARAMETRIC:
        return of_parametric(primitive, point, direction);
    case PRIMITIVE_BOX:
        return of_box(primitive, own, side);
    case PRIMITIVE_TORUS:
        return of_torus(primitive, own);
    case PRIMITIVE_LATHE:
        return uv(turn_of(own), lathe_along(&primitive->list, own));
    case PRIMITIVE_SOR:
        return uv(turn_of(own), sor_along(&primitive->list, own, side));
    default: return place;
    }
}

// The weights of a face's corners at a point of it, in the plane of two axes where it is greatest.
static void weigh(const Mesh *mesh, uint32_t face, Vec3 p, double weights[3])
{
    Vec3 a = mesh_corner(mesh, face, 0);
    Vec3 first = vec3_sub(mesh_corner(mesh, face, 1), a), second = vec3_sub(mesh_corner(mesh, face, 2), a);
    Vec3 across = vec3_cross(first, second), from = vec3_sub(p, a);
    double length2 = vec3_length_squared(across);
    weights[1] = length2 > 0.0 ? vec3_dot(vec3_cross(from, second), across) / length2 : 0.0;
    weights[2] = length2 > 0.0 ? vec3_dot(vec3_cross(first, from), across) / length2 : 0.0;
    weights[0] = 1.0 - weights[1] - weights[2];
}

static Vec3 of_face(const PreparedPrimitive *primitive, uint32_t face, Vec3 point)
{
    const Mesh *mesh = primitive->mesh.table->mesh;
    double weights[3], sum[2] = {0.0, 0.0};
    if (!mesh->uvs) {
        return uv(0.0, 0.0);
    }
    weigh(mesh, face, linear_direction(&primitive->to_object, vec3_sub(point, primitive->centre)), weights);
    for (int i = 0; i < 3; i++) {
        const float *corner = mesh->uvs[mesh->face_uvs[face][i]];
        sum[0] += weights[i] * (double)corner[0];
        sum[1] += weights[i] * (double)corner[1];
    }
    mesh_uv_settle(mesh, sum);
    return uv(sum[0], sum[1]);
}

Vec3 geometry_uv(const Geometry *geometry, const Scene *scene, ShapeId shape, Vec3 point, Vec3 direction, Vec3 place)
{
    const ShapeTable *table = &geometry->shapes;
    Vec3 text = vec3_scale(1.0 / scene->text_unit, vec3_sub(place, scene->text_origin));
    text.z = 0.0;
    switch (shape_kind(shape)) {
    case SHAPE_PRIMITIVE:
        return of_part(&table->primitives[primitive_index(shape)], point, direction, primitive_side(shape), text);
    case SHAPE_FACE: {
        const PreparedPrimitive *primitive = &table->primitives[table_face_primitive(table, shape)];
        return primitive->mesh.table->mesh->field
                   ? text
                   : of_face(primitive, shape_index(shape) - primitive->mesh.first_face, point);
    }
    default: return text; // a sphere with such a texture is a part
    }
}
