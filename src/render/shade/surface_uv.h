// The surface coordinates at a point that a ray met, for the textures that ask for some.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SURFACE_UV_H
#define RENDER_SHADE_SURFACE_UV_H

#include "render/records/prepared.h"
#include "trace/surface_map.h"

// Put into *room; NULL where the texture asks for none.
static inline const Vec3 *shade_uv(const Prepared *p, uint32_t texture, ShapeId shape, Vec3 point, Vec3 *room)
{
    if (!texture_is_on_surface(&p->textures, texture)) {
        return NULL;
    }
    *room = geometry_uv(p->geometry, p->scene, shape, point, vec3_scale(p->textures.scale, point));
    return room;
}

#endif
