// Fields of heights: their vertices, faces and normals.
//
// The cell between four heights is cut from the end of its first edge in x to that in z. A smooth one has at each
// vertex the mean of the normals of the up to four corners there that lie between an edge in x and one in z, each of
// length 1 where a column, a row and one of 65536 heights are 1 each; it is kept in whole 32767ths, cut towards zero.
// Those of a cell's corners, made of length 1 in the scene, are mixed by the place in it. Measured.
//
// SPDX-License-Identifier: MIT
#include "scene/mesh_field.h"

#include <math.h>
#include <stdlib.h>

double mesh_field_faces(double columns, double rows)
{
    return 2.0 * (columns - 1.0) * (rows - 1.0);
}

size_t mesh_field_bytes(uint32_t columns, uint32_t rows, bool is_smooth)
{
    size_t places = (size_t)columns * rows, faces = 2 * (size_t)(columns - 1) * (rows - 1);
    size_t place = sizeof(uint16_t) + 3 * sizeof(float) + (is_smooth ? 3 * sizeof(int16_t) : 0);
    return sizeof(Mesh) + sizeof(MeshField) + places * place + faces * 3 * sizeof(uint32_t);
}

Mesh *mesh_field_new(uint32_t columns, uint32_t rows)
{
    Mesh *mesh = mesh_new();
    MeshField *field = mesh ? calloc(1, sizeof *field) : NULL;
    if (!field) {
        mesh_free(mesh);
        return NULL;
    }
    size_t places = (size_t)columns * rows;
    *field = (MeshField){.columns = columns, .rows = rows, .heights = calloc(places, sizeof *field->heights)};
    mesh->field = field;
    mesh->has_inside = true;
    mesh->inside_vector = vec3(0.0, 1.0, 0.0);
    mesh->vertex_count = (uint32_t)places;
    mesh->face_count = 2 * (columns - 1) * (rows - 1);
    mesh->vertices = malloc(places * sizeof *mesh->vertices);
    mesh->faces = malloc(mesh->face_count * sizeof *mesh->faces);
    if (!field->heights || !mesh->vertices || !mesh->faces) {
        mesh_free(mesh);
        return NULL;
    }
    return mesh;
}

static double height_at(const MeshField *field, uint32_t column, uint32_t row)
{
    return (double)field->heights[(size_t)row * field->columns + column];
}

void mesh_field_build(Mesh *mesh)
{
    const MeshField *field = mesh->field;
    uint32_t columns = field->columns, face = 0;
    for (uint32_t row = 0; row < field->rows; row++) {
        for (uint32_t column = 0; column < columns; column++) {
            float *vertex = mesh->vertices[(size_t)row * columns + column];
            vertex[0] = (float)column;
            vertex[1] = (float)(height_at(field, column, row) / FIELD_HEIGHTS);
            vertex[2] = (float)row;
        }
    }
    for (uint32_t row = 0; row + 1 < field->rows; row++) {
        for (uint32_t column = 0; column + 1 < columns; column++) {
            uint32_t first = row * columns + column;
            uint32_t *lower = mesh->faces[face++], *upper = mesh->faces[face++];
            lower[0] = first;
            lower[1] = upper[2] = first + 1;
            lower[2] = upper[1] = first + columns;
            upper[0] = first + columns + 1;
        }
    }
    mesh_measure(mesh);
}

// ---- normals

// The normal between an edge that rises by `x` along a column's width and one that rises by `z` along a row's.
static Vec3 corner_normal(double x, double z)
{
    return vec3_normalize(vec3(-x, 1.0, -z));
}

static Vec3 vertex_normal(const MeshField *field, uint32_t column, uint32_t row)
{
    double own = height_at(field, column, row);
    Vec3 sum = vec3(0.0, 0.0, 0.0);
    for (int side = 0; side < 4; side++) {
        bool is_left = side & 1, is_near = side & 2;
        if ((is_left ? column == 0 : column + 1 == field->columns) || (is_near ? row == 0 : row + 1 == field->rows)) {
            continue;
        }
        double x = is_left ? own - height_at(field, column - 1, row) : height_at(field, column + 1, row) - own;
        double z = is_near ? own - height_at(field, column, row - 1) : height_at(field, column, row + 1) - own;
        sum = vec3_add(sum, corner_normal(x, z));
    }
    return vec3_normalize(sum);
}

bool mesh_field_smooth(Mesh *mesh)
{
    MeshField *field = mesh->field;
    field->normals = malloc((size_t)field->columns * field->rows * sizeof *field->normals);
    for (uint32_t row = 0; field->normals && row < field->rows; row++) {
        for (uint32_t column = 0; column < field->columns; column++) {
            Vec3 normal = vertex_normal(field, column, row);
            int16_t *kept = field->normals[(size_t)row * field->columns + column];
            kept[0] = (int16_t)(normal.x * INT16_MAX);
            kept[1] = (int16_t)(normal.y * INT16_MAX);
            kept[2] = (int16_t)(normal.z * INT16_MAX);
        }
    }
    return field->normals;
}

// A normal where a column, a row and a height are 1 each, in the field's own space.
static Vec3 own_normal(Vec3 normal)
{
    return vec3(normal.x, normal.y * FIELD_HEIGHTS, normal.z);
}

static Vec3 face_normal(const MeshField *field, uint32_t column, uint32_t row, bool is_upper)
{
    uint32_t x_row = row + is_upper, z_column = column + is_upper;
    return vec3(height_at(field, column, x_row) - height_at(field, column + 1, x_row), 1.0,
                height_at(field, z_column, row) - height_at(field, z_column, row + 1));
}

static double within(double share)
{
    return share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
}

int mesh_field_normals(const MeshField *field, uint32_t face, Vec3 point, Vec3 normals[4], double weights[4])
{
    uint32_t cell = face / 2, column = cell % (field->columns - 1), row = cell / (field->columns - 1);
    if (!field->normals) {
        normals[0] = own_normal(face_normal(field, column, row, face & 1));
        weights[0] = 1.0;
        return 1;
    }
    double x = within(point.x - (double)column);
    double z = within(point.z - (double)row);
    for (uint32_t corner = 0; corner < 4; corner++) {
        uint32_t right = corner & 1, far = corner >> 1;
        const int16_t *kept = field->normals[(size_t)(row + far) * field->columns + column + right];
        normals[corner] = own_normal(vec3((double)kept[0], (double)kept[1], (double)kept[2]));
        weights[corner] = (right ? x : 1.0 - x) * (far ? z : 1.0 - z);
    }
    return 4;
}

// ---- inside

Vec3 mesh_field_size(const MeshField *field)
{
    return vec3((double)(field->columns - 1), 1.0, (double)(field->rows - 1));
}

bool mesh_field_is_over(const MeshField *field, Vec3 point)
{
    Vec3 size = mesh_field_size(field);
    return point.x >= 0.0 && point.x < size.x && point.z >= 0.0 && point.z < size.z;
}

double mesh_field_height(const MeshField *field, Vec3 point)
{
    uint32_t column = (uint32_t)point.x, row = (uint32_t)point.z;
    double x = point.x - (double)column, z = point.z - (double)row;
    bool is_upper = x + z >= 1.0;
    double base = height_at(field, column + is_upper, row + is_upper);
    double along_x = height_at(field, column + !is_upper, row + is_upper);
    double along_z = height_at(field, column + is_upper, row + !is_upper);
    double a = is_upper ? 1.0 - x : x, b = is_upper ? 1.0 - z : z;
    return (base + a * (along_x - base) + b * (along_z - base)) / FIELD_HEIGHTS;
}

bool mesh_field_holds(const MeshField *field, Vec3 point)
{
    return mesh_field_is_over(field, point) && (point.y < field->water || point.y < mesh_field_height(field, point));
}
