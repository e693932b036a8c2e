// Rays of the language's function `trace`: the evaluator's shapes as a geometry, and what a ray meets.
//
// SPDX-License-Identifier: MIT
#include "api/probe.h"

#include <math.h>

#include "trace/query_surface.h"

static void *probe_open(const Scene *shapes)
{
    return geometry_new(shapes, 0);
}

static void probe_close(void *geometry)
{
    geometry_free(geometry);
}

static bool probe_closest(const void *geometry, Vec3 origin, Vec3 direction, const EvalHit *from, EvalHit *met)
{
    Ray ray = {origin, direction};
    RayStart start = RAY_START_FREE;
    Hit hit;
    if (from) {
        start = (RayStart){from->shape, vec3_dot(direction, from->normal) < 0.0, 0};
    }
    if (!geometry_closest(geometry, TRACE_PRIMITIVES, ray, start, (double)INFINITY, &hit)) {
        return false;
    }
    Surface surface = geometry_surface(geometry, TRACE_PRIMITIVES, ray, hit);
    *met = (EvalHit){surface.point, surface.normal, hit.shape, surface.order};
    return true;
}

static size_t probe_bytes(const void *geometry)
{
    return geometry_bytes(geometry);
}

const EvalTracer probe_tracer = {probe_open, probe_closest, probe_bytes, probe_close};
