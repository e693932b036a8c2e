// Textures at a point: which pigments and finishes are seen there, and how much of each.
//
// The scene's records with every pattern's way back from prepared space computed. Read-only once made, shared by
// threads. Refers to the scene, which must outlive it. Knows nothing of light.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SURFACE_TEXTURE_H
#define RENDER_SURFACE_TEXTURE_H

#include <stdbool.h>

#include "base/arena.h"
#include "base/attributes.h"
#include "math/colour.h"
#include "math/transform.h"
#include "render/surface/along.h"
#include "render/surface/image.h"
#include "render/surface/pattern.h"
#include "scene/scene.h"

typedef struct TextureTable TextureTable;
struct TextureTable {
    const Scene *scene;
    double scale;      // from prepared lengths to the scene's, a power of two
    Noise *noise;      // its own, or NULL
    WaveSource *waves; // likewise
    NoiseSource source;
    bool goes_abreast;             // texture_goes_abreast of some pigment
    Transform *to_pattern;         // for each of the scene's patterns
    uint8_t *opaque;               // likewise: what texture_is_opaque knows of it
    uint8_t *on_surface;           // for each of its textures: 1 if it asks for surface coordinates; NULL: none does
    Transform *texture_to_pattern; // for each of its textures; unused without a pattern
    PreparedImage *images;         // for each of its image maps
    Transform *normal_to_pattern;  // for each of its normals
    const AlongList *pattern_lists, *texture_lists, *normal_lists, *slope_lists; // for each of these, too
    Arena along;                                                                 // what these refer to
    Transform *warp_back; // for each of its warps
    bool faces;           // some pattern asks how a surface lies
    bool has_sides;       // something looks otherwise from inside
    bool is_lit_apart;    // not all is lit by all lights, or on one side only
    bool is_walked;       // one of these: each texture is
};

// Lengths of the prepared scene are the scene's times 2^-exponent. The noise is referred to; NULL: the table makes what
// it needs, for the instruction set of that name. False when out of memory.
bool texture_table_init(TextureTable *table, const Scene *scene, const Noise *noise, int exponent,
                        const char *isa) RT_MUST_CHECK;
void texture_table_fini(TextureTable *table);
// What it takes of memory beside the pictures and a noise of its own.
size_t texture_table_bytes(const TextureTable *table);

// Whether some picture lets light through.
bool texture_table_has_transparent_image(const TextureTable *table);

// Whether a texture asks for surface coordinates.
static inline bool texture_is_on_surface(const TextureTable *table, uint32_t texture)
{
    return RT_UNLIKELY(table->on_surface != NULL) && table->on_surface[texture];
}

// The colour of a pigment at a point in the scene's lengths; `uv` are the surface coordinates there, which may be NULL
// where it does not ask for any.
Rgbft texture_pigment_on(const TextureTable *table, const Pigment *pigment, Vec3 point, const Vec3 *uv);
static inline Rgbft texture_pigment(const TextureTable *table, const Pigment *pigment, Vec3 point)
{
    return texture_pigment_on(table, pigment, point, NULL);
}
// Whether texture_pigments takes less time for a pigment than one point after another.
bool texture_goes_abreast(const TextureTable *table, const Pigment *pigment);
// The colours of such a pigment at some points, TEXTURE_ABREAST at most.
enum { TEXTURE_ABREAST = 64 };
void texture_pigments(const TextureTable *table, const Pigment *pigment, unsigned count, const Vec3 *points,
                      Rgbft *colours);
// The value of one of the scene's patterns there.
double texture_pattern_value(const TextureTable *table, uint32_t pattern, Vec3 point);

// Whether a pigment lets nothing through, but for single points that a picture's projection does not reach.
bool texture_is_opaque(const TextureTable *table, const Pigment *pigment);

// A point as a pattern of textures sees it.
typedef struct TexturePlace TexturePlace;
struct TexturePlace {
    Vec3 point;
    uint32_t texture;          // the one with the pattern; RECORD_NONE: the scene's own lengths
    const TexturePlace *outer; // the same point in the space around it; NULL: there is none
    const Vec3 *uv;            // the surface coordinates there, as of texture_walk
};

// What a pigment multiplies light with that goes through it.
static inline Rgb texture_pigment_through(Rgbft pigment)
{
    return rgb_add(rgb_scale(pigment.filter, rgbft_rgb(pigment)), rgb_grey(pigment.transmit));
}

// What it keeps: its "opaque share". Before version 3.7 that was what the colour that comes through best leaves.
static inline double texture_pigment_opaque(bool is_old, Rgbft pigment)
{
    double filtered = is_old ? pigment.filter * rgb_max(rgbft_rgb(pigment)) : pigment.filter;
    return 1.0 - filtered - pigment.transmit;
}

// One of the surfaces that are seen at a point.
typedef struct TextureLayer {
    Rgbft pigment;
    FinishIndex finish;
    uint32_t normal; // of the scene's normals, or RECORD_NONE
    bool is_top;     // of its texture: no layer stands above it
    const TexturePlace *place;
    double part; // of the texture in a map, 1 without a map
    Rgb above;   // what the layers above let through
    const TextureTable *table; // which knows how the surface lies
} TextureLayer;

// Returns the share of light, by colour, that continues to what is below, beside what the pigment lets through.
typedef Rgb (*TextureVisit)(void *client, const TextureLayer *layer);

// What all layers let through, by colour, the parts of those textures of a map that let any through, and the greatest
// component of what one of them does.
typedef struct TextureThrough {
    Rgb light;
    double part;
    double weight;
} TextureThrough;

// How a point of a surface is seen: the point, in prepared space; the surface coordinates there, which may be NULL
// unless texture_is_on_surface; the normal, of length 1 and turned to where the ray comes from; the ray's direction.
typedef struct TextureSight {
    Vec3 point;
    const Vec3 *uv, *normal, *direction;
    bool is_shadow; // light goes through
} TextureSight;

// Calls `visit`, unless it is NULL, for each surface seen at a point, from top to bottom. Light that is darker than
// `cut` in grey does not continue to the layer below or out of the last one.
TextureThrough texture_walk(const TextureTable *table, uint32_t texture, TextureSight sight, double cut,
                            TextureVisit visit, void *client);

// A texture that is one layer without bumps, and asks for nothing but the point; NULL where there is more to walk.
static inline const Texture *texture_single(const TextureTable *table, uint32_t index)
{
    const Texture *texture = &table->scene->textures.items[index];
    bool is_single = texture->pattern.type == PATTERN_NONE && texture->below == RECORD_NONE &&
                     texture->normal == RECORD_NONE && !table->is_walked;
    return is_single && !texture_is_on_surface(table, index) ? texture : NULL;
}

// The normal of a layer that has bumps: `normal`, of length 1 and turned to the viewer, as they turn it. Of length 1.
// In normal.c.
Vec3 texture_normal(const TextureLayer *layer, Vec3 normal);
// The same as a pattern of the layer sees it: in the space of the pattern of textures around it, if there is one, and of
// what lies on a surface before its texture was turned. Measured.
Vec3 texture_normal_inside(const TextureLayer *layer, Vec3 normal);
// What one of the scene's normals makes of a direction of length 1 at a point in the scene's lengths.
Vec3 texture_bent(const TextureTable *table, uint32_t normal, Vec3 point, Vec3 direction);

#endif
