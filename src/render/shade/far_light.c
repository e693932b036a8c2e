// Shadows on what is very far from a light: whether its light arrives is found from the light's side.
//
// The direction from a point P to a light is rounded to u |P|: next to the light a ray from P is off by that, which may
// be more than what stands there is large. A ray from the light in the opposite direction is off by u s at the distance
// s from it, and by u |P| at P, as P is itself. docs/numerics.md has more. With all features, since it is seldom asked.
//
// SPDX-License-Identifier: MIT
#include "render/shade/shade_light.h"

enum { FEATURES = RENDER_ALL_FEATURES | TRACE_ALL_FEATURES, CROSSINGS_KEPT = 64 };

// A surface between the light and the point.
typedef struct FarCrossing {
    Surface surface;
    Rgb through;
    double way; // from the light
} FarCrossing;

// What they leave of the light, multiplied as on a walk from the point.
static Rgb crossings_share(const Prepared *p, const ShadingPoint *at, const FarCrossing *crossings, int count,
                           double distance)
{
    MediumStack inside = at->before;
    uint32_t kept = at->media ? at->media->count : 0;
    Rgb share = rgb_grey(1.0);
    double before = 0.0;
    for (int i = count; i-- > 0;) {
        double way = distance - crossings[i].way;
        share = rgb_mul(share, crossings[i].through);
        if (at->media) {
            share = rgb_mul(share, shade_shadow_crossed(p, &crossings[i].surface, way - before, at->media, &inside));
            inside = medium_keep(at->media, kept, inside);
        }
        before = way;
    }
    if (at->media) {
        at->media->count = kept;
    }
    return share;
}

// Of a shape that is convex, or flat, the point itself is where the ray meets it from the side that the light is on. Of
// another, which may be met so at several places, light is looked for from the point, whose rays know where they start.
Rgb shade_far_light(const Prepared *p, const ShadingPoint *at, Vec3 end, Vec3 towards, double distance)
{
    FarCrossing crossings[CROSSINGS_KEPT];
    int count = 0;
    bool inward = vec3_dot(at->outward, towards) < 0.0;
    double way = 0.0;
    Ray ray = {end, vec3_neg(towards)};
    RayStart start = {SHAPE_NONE, false, HIDDEN_SHADOW};
    Hit hit;
    if (!geometry_is_convex(p->geometry, at->shape)) {
        return shade_light_through(p, FEATURES, at, (Ray){at->point, towards},
                                   (RayStart){at->shape, inward, HIDDEN_SHADOW}, distance);
    }
    while (way < distance && geometry_closest(p->geometry, FEATURES, ray, start, distance - way, &hit)) {
        if (hit.inside == inward && geometry_is_same(p->geometry, hit.shape, at->shape)) {
            break;
        }
        Surface surface = geometry_surface(p->geometry, FEATURES, ray, hit);
        Rgb through = shade_surface_through(p, FEATURES, &surface, hit.shape, towards);
        if (rgb_is_black(through)) {
            return through;
        }
        if (count == CROSSINGS_KEPT) {
            RayStart near = {at->shape, inward, HIDDEN_SHADOW};
            return shade_light_through(p, FEATURES, at, (Ray){at->point, towards}, near, distance);
        }
        way += hit.t;
        crossings[count++] = (FarCrossing){surface, through, way};
        ray.origin = surface.point;
        start = (RayStart){hit.shape, !hit.inside, HIDDEN_SHADOW};
    }
    return crossings_share(p, at, crossings, count, distance);
}
