// What a texture sees of a point that a ray met, with the surface coordinates there where it asks for some.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SHADE_SURFACE_UV_H
#define RENDER_SHADE_SURFACE_UV_H

#include "render/shade/shade_light.h"
#include "trace/surface_map.h"

// Put into *room; NULL where the texture asks for none. The ray came in that direction.
static inline const Vec3 *shade_uv(const Prepared *p, uint32_t texture, ShapeId shape, Vec3 point, Vec3 direction,
                                   Vec3 *room)
{
    if (!texture_is_on_surface(&p->textures, texture)) {
        return NULL;
    }
    *room = geometry_uv(p->geometry, p->scene, shape, point, direction, vec3_scale(p->textures.scale, point));
    return room;
}

// Of a surface that is shaded. *room is for the coordinates; what is returned points into both.
static inline TextureSight shade_sight(const Prepared *p, uint32_t texture, const ShadingPoint *at, Vec3 *room)
{
    const Vec3 *uv = shade_uv(p, texture, at->shape, at->point, at->direction, room);
    return (TextureSight){at->point, uv, &at->normal, &at->direction, false};
}

#endif
