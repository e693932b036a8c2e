// Whether a ball is seen whole from a surface: one look instead of a shadow ray for each light of an area.
//
// Every way from the point to a place of the ball lies in a cone around the way to its centre. What a plane parts from
// that cone is before none of them, and neither is the plane that the point lies on, or a sphere that the point lies on
// and the ball outside of. No is also said where that cannot be decided.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "trace/bvh_walk.h"
#include "trace/geometry.h"

// The ways to the ball. `slack` is more than rounding does to any length.
typedef struct BallCone {
    const SurfaceSpot *from;
    Vec3 apex, centre, direction; // direction: of unit length
    double length, radius;
    double sine, cosine; // of the angle between the cone's axis and its side
    double slack;
} BallCone;

// How far a thing reaches from its middle.
typedef struct Extent {
    Vec3 half;     // of a box
    double radius; // of a ball around that; 0: none
} Extent;

// Whether all of a thing is farther along a normal than `from`.
static bool is_beyond(Vec3 normal, double from, Vec3 offset, const Extent *extent)
{
    double reach = fabs(normal.x) * extent->half.x + fabs(normal.y) * extent->half.y + fabs(normal.z) * extent->half.z +
                   extent->radius;
    return vec3_dot(normal, offset) - reach > from;
}

// Whether a plane that touches the cone, or one of those at its ends, parts a thing from it; `offset` is from the apex.
static bool is_aside(const BallCone *cone, Vec3 offset, const Extent *extent, double slack)
{
    double along = vec3_dot(offset, cone->direction);
    Vec3 across = vec3_add_scaled(offset, -along, cone->direction);
    double apart = vec3_length(across);
    if (apart > slack) {
        Vec3 side = vec3_scale(cone->cosine / apart, across);
        if (is_beyond(vec3_add_scaled(side, -cone->sine, cone->direction), slack, offset, extent)) {
            return true;
        }
    }
    return is_beyond(vec3_neg(cone->direction), slack, offset, extent) ||
           is_beyond(cone->direction, cone->length + cone->radius + slack, offset, extent);
}

static bool plane_is_aside(const Geometry *g, const PlaneShape *plane, const BallCone *cone)
{
    ShapeId start = cone->from->shape;
    if (shape_kind(start) == SHAPE_PLANE && plane_equal(plane, &g->planes[shape_index(start)].shape)) {
        return true;
    }
    double slack = cone->slack + 0x1p-30 * fabs(plane->distance);
    double begin = vec3_dot(plane->normal, cone->apex) - plane->distance;
    double end = vec3_dot(plane->normal, cone->centre) - plane->distance;
    return fabs(begin) > slack && fabs(end) > cone->radius + slack && (begin > 0.0) == (end > 0.0);
}

static bool sphere_is_aside(const Geometry *g, const SphereData *ball, const BallCone *cone)
{
    ShapeId start = cone->from->shape;
    Vec3 offset = vec3_sub(ball->centre, cone->apex);
    if (shape_kind(start) == SHAPE_SPHERE) {
        SphereData own = sphere_table_ball(&g->spheres, shape_index(start));
        if (sphere_data_equal(ball, &own)) {
            return cone->length * vec3_dot(cone->from->outward, cone->direction) > cone->radius + cone->slack;
        }
    }
    Extent extent = {.radius = sqrt(ball->radius_squared)};
    return is_aside(cone, offset, &extent, cone->slack + 0x1p-30 * (vec3_length(offset) + extent.radius));
}

static bool spheres_are_aside(const Geometry *g, uint32_t first, uint32_t count, const BallCone *cone)
{
    for (uint32_t slot = first; slot < first + count; slot++) {
        SphereData ball = sphere_table_ball(&g->spheres, slot);
        if (!isnan(ball.radius_squared) && !sphere_is_aside(g, &ball, cone)) {
            return false;
        }
    }
    return true;
}

static bool box_is_aside(const Bvh *tree, const BvhNode *node, int child, const BallCone *cone)
{
    double middle[3], half[3];
    for (int axis = 0; axis < 3; axis++) {
        double low = (double)node->box[axis][0][child], high = (double)node->box[axis][1][child];
        middle[axis] = 0.5 * (low + high) / tree->scale;
        half[axis] = 0.5 * (high - low) / tree->scale;
    }
    Extent extent = {.half = vec3(half[0], half[1], half[2])};
    Vec3 place = vec3_add(tree->centre, vec3(middle[0], middle[1], middle[2]));
    double slack = cone->slack + 0x1p-30 * (vec3_length(tree->centre) + 4.0 / tree->scale);
    return is_aside(cone, vec3_sub(place, cone->apex), &extent, slack);
}

static bool tree_is_aside(const Geometry *g, const Bvh *tree, bool is_of_spheres, const BallCone *cone)
{
    BvhChild waiting[BVH_STACK];
    int count = tree->nodes ? 1 : 0;
    waiting[0] = 0; // the root
    while (count > 0) {
        const BvhNode *node = &tree->nodes[waiting[--count]];
        for (int i = 0; i < BVH_WIDTH; i++) {
            BvhChild child = node->child[i];
            if (child == BVH_CHILD_NONE || box_is_aside(tree, node, i, cone)) {
                continue;
            }
            if (!(child & BVH_LEAF)) {
                waiting[count++] = child;
            } else if (!is_of_spheres ||
                       !spheres_are_aside(g, (child & ~BVH_LEAF) * SPHERE_BLOCK, SPHERE_BLOCK, cone)) {
                return false;
            }
        }
    }
    return true;
}

bool geometry_sees_ball(const Geometry *g, const SurfaceSpot *from, Vec3 centre, double radius)
{
    Vec3 offset = vec3_sub(centre, from->point);
    BallCone cone = {.from = from, .apex = from->point, .centre = centre, .length = vec3_length(offset)};
    cone.slack = 0x1p-30 * (vec3_length(from->point) + vec3_length(centre) + radius);
    cone.radius = radius + cone.slack;
    cone.direction = vec3_scale(1.0 / cone.length, offset);
    cone.sine = cone.radius / cone.length;
    if (!(cone.sine < 1.0) || g->shapes.unbounded_count > 0 || g->elsewhere) {
        return false;
    }
    cone.cosine = sqrt(1.0 - cone.sine * cone.sine);
    for (uint32_t i = 0; i < g->plane_count; i++) {
        if (!plane_is_aside(g, &g->planes[i].shape, &cone)) {
            return false;
        }
    }
    return spheres_are_aside(g, 0, g->spheres.loose_count, &cone) && tree_is_aside(g, &g->spheres.bvh, true, &cone) &&
           tree_is_aside(g, &g->shapes.tree, false, &cone);
}
