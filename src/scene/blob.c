// The list of a blob: its components sorted into a tree by where they are. Sorting what is sorted changes nothing, so
// that a scene that is printed and read again has the same list.
//
// SPDX-License-Identifier: MIT
#include "scene/blob.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/form.h"

size_t blob_list_most(uint32_t component_count)
{
    return BLOB_HEAD + (size_t)BLOB_NODE * 2 * component_count + (size_t)BLOB_COMPONENT * component_count;
}

bool blob_component(BlobComponent *component, bool is_rod, Vec3 base, Vec3 cap, double radius, double strength,
                    const Transform *transform)
{
    Primitive primitive = part_empty(0);
    Vec3 axis = vec3_sub(cap, base);
    const char *why_nothing =
        is_rod
            ? primitive_make_cylinder(&primitive, base, vec3_add_scaled(base, radius, vector_unit(axis)), radius, false)
            : primitive_make_ball(&primitive, base, radius);
    if (is_rod) { // the end was only for the turn
        for (int i = 0; i < 3; i++) {
            const double to[3] = {axis.x, axis.y, axis.z};
            primitive.to_world.m[2][i] = radius * (to[i] / vector_length(axis));
        }
    }
    primitive.to_world = transform_compose(primitive.to_world, *transform);
    if (why_nothing || !part_finish(&primitive)) {
        return false;
    }
    *component = (BlobComponent){is_rod, strength, is_rod ? vector_length(axis) / radius : 0.0, 0.0, {{0}}, {{0}}};
    memcpy(component->to_world, primitive.to_world.m, sizeof component->to_world);
    memcpy(component->to_own, primitive.to_object.m, sizeof component->to_own);
    return true;
}

// ---- the tree

// The box of where a component has a field, a little wider than rounding may make it.
static void component_box(const BlobComponent *component, double low[3], double high[3])
{
    const double(*m)[3] = component->to_world;
    for (int axis = 0; axis < 3; axis++) {
        double half = hypot(hypot(m[0][axis], m[1][axis]), m[2][axis]), rise = component->height * m[2][axis];
        double size = half + fabs(rise) + fabs(m[3][axis]);
        low[axis] = m[3][axis] + fmin(rise, 0.0) - half - 0x1p-44 * size;
        high[axis] = m[3][axis] + fmax(rise, 0.0) + half + 0x1p-44 * size;
    }
}

// Twice its middle along an axis.
static double component_place(const BlobComponent *component, int axis)
{
    return 2.0 * component->to_world[3][axis] + component->height * component->to_world[2][axis];
}

static int place_order(const BlobComponent *a, const BlobComponent *b, int axis)
{
    double x = component_place(a, axis), y = component_place(b, axis);
    return (x > y) - (x < y);
}

// Merges runs, so that equal places stay as they were.
static void sort_along(BlobComponent *components, uint32_t count, int axis, BlobComponent *room)
{
    if (count < 2) {
        return;
    }
    uint32_t half = count / 2, left = 0, right = half;
    sort_along(components, half, axis, room);
    sort_along(components + half, count - half, axis, room);
    for (uint32_t i = 0; i < count; i++) {
        bool is_left = right == count || (left < half && place_order(&components[left], &components[right], axis) <= 0);
        room[i] = components[is_left ? left++ : right++];
    }
    memcpy(components, room, count * sizeof *components);
}

typedef struct Builder {
    BlobComponent *components, *room;
    BlobNode *nodes;
    uint32_t node_count;
} Builder;

static uint32_t build(Builder *builder, uint32_t begin, uint32_t end)
{
    uint32_t at = builder->node_count++;
    BlobNode node = {
        .low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}, .begin = begin, .end = end};
    double least[3] = {INFINITY, INFINITY, INFINITY}, most[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = begin; i < end; i++) {
        double low[3], high[3];
        component_box(&builder->components[i], low, high);
        for (int axis = 0; axis < 3; axis++) {
            double place = component_place(&builder->components[i], axis);
            node.low[axis] = fmin(node.low[axis], low[axis]);
            node.high[axis] = fmax(node.high[axis], high[axis]);
            least[axis] = fmin(least[axis], place);
            most[axis] = fmax(most[axis], place);
        }
    }
    if (end - begin > BLOB_LEAF) {
        int axis = most[1] - least[1] > most[0] - least[0] ? 1 : 0;
        axis = most[2] - least[2] > most[axis] - least[axis] ? 2 : axis;
        sort_along(builder->components + begin, end - begin, axis, builder->room);
        uint32_t middle = begin + (end - begin) / 2;
        build(builder, begin, middle);
        node.second = build(builder, middle, end);
    }
    builder->nodes[at] = node;
    return at;
}

Numbers blob_make(double threshold, BlobComponent *components, uint32_t count, double *list)
{
    BlobComponent *own = (BlobComponent *)(void *)(list + BLOB_HEAD + (size_t)BLOB_NODE * 2 * count);
    double greatest = 0.0;
    // The room to sort in is where the caller had them.
    memcpy(own, components, count * sizeof *own);
    Builder builder = {own, components, (BlobNode *)(void *)(list + BLOB_HEAD), 0};
    build(&builder, 0, count);
    for (uint32_t i = 0; i < count; i++) {
        greatest += fmax(own[i].strength, 0.0);
    }
    list[0] = threshold;
    list[1] = count;
    list[2] = builder.node_count;
    list[3] = greatest;
    memmove(list + BLOB_HEAD + (size_t)BLOB_NODE * builder.node_count, own, count * sizeof *own);
    return (Numbers){list, BLOB_HEAD + (size_t)BLOB_NODE * builder.node_count + (size_t)BLOB_COMPONENT * count};
}

// ---- the field

double blob_distance2(const BlobComponent *component, Vec3 point, Vec3 *own)
{
    const double(*m)[3] = component->to_own;
    double x = point.x * m[0][0] + point.y * m[1][0] + point.z * m[2][0] + m[3][0];
    double y = point.x * m[0][1] + point.y * m[1][1] + point.z * m[2][1] + m[3][1];
    double z = point.x * m[0][2] + point.y * m[1][2] + point.z * m[2][2] + m[3][2];
    z = z <= 0.0 ? z : z < component->height ? 0.0 : z - component->height;
    *own = vec3(x, y, z);
    return x * x + y * y + z * z;
}

double blob_field(const double *list, Vec3 point)
{
    Blob blob = blob_of(list);
    double sum = 0.0;
    for (uint32_t i = 0; i < blob.component_count; i++) {
        Vec3 own;
        double inner = 1.0 - blob_distance2(&blob.components[i], point, &own);
        sum += inner > 0.0 ? blob.components[i].strength * inner * inner : 0.0;
    }
    return sum;
}

// Between two places where components begin or end fields have few extrema; what would be beyond is far behind.
uint32_t blob_interval_most(const double *list)
{
    return 3 * (uint32_t)list[1] + 4;
}
