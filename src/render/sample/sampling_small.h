// Shapes of no more than a few pixels: which pixels they are in, and which of them the samples have met there.
//
// A pixel's corners, and few samples, may all pass by a thing that lies within it. Where that is a shape with a known
// extent its place in the picture is known before a ray is traced, so such pixels are sampled and judged by what they
// hold, not only by what was seen. Private to src/render; docs/sampling.md, "What no sample met".
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_SMALL_H
#define RENDER_SAMPLE_SAMPLING_SMALL_H

#include <math.h>

#include "render/records/film.h"
#include "render/records/options.h"
#include "render/records/prepared.h"
#include "render/sample/sample.h"
#include "trace/extent.h"

// A small shape in a pixel.
typedef struct SmallEntry {
    ShapeId shape;
    float share;    // how much of the pixel it is, were nothing before it
    float contrast; // the mean square of its light less the pixel's; < 0: not known
} SmallEntry;

// How many of a pixel's are followed: the largest. More lie behind each other.
enum { SMALL_MOST = 16 };

// A narrow highlight: an ellipse on its shape, sampling_spot.c.
typedef struct SmallSpot {
    ShapeId owner;
    Vec3 centre, axes[2];
} SmallSpot;

// Of the ShapeId of a spot, which is its number.
#define SMALL_IS_SPOT ((ShapeKind)3)

typedef struct Small {
    const Prepared *prepared;
    const Film *film;
    FilterKind filter;
    SmallSpot *spots;
    uint32_t spot_count, glint_count; // of the first, those of glints_find
    uint32_t *first; // of each pixel's entries; one more for the end
    uint32_t *pixels; // that have any, from the first on
    uint32_t pixel_count;
    SmallEntry *entries;
    uint8_t *open;   // so many of a pixel's entries, its first ones, were met by none of its samples
    float (*law)[2]; // of each pixel that has entries, see small_variance
    // A bit for each place of an extent, and for each spot after these: met by a sample; shown by a look; for counting.
    uint64_t *met, *seen, *counted;
    size_t words;    // of each set
    double contrast; // of an entry of which it is not known
    double norm;     // one over the square of the filter's integral
} Small;

// What small shapes are in a film. NULL when there are none; sets *has_memory to false when out of memory. Nothing is
// known of wide cameras.
Small *small_new(const Prepared *prepared, const RenderOptions *options, const Film *film, bool *has_memory);
void small_free(Small *small);

static inline bool small_has(const Small *small, size_t pixel)
{
    return small && small->first[pixel + 1] > small->first[pixel];
}

static inline int small_open(const Small *small, size_t pixel)
{
    return small ? small->open[pixel] : 0;
}

// A sample of the pixel is traced along the ray. By one thread at a time for each pixel.
void small_meet(Small *small, size_t pixel, Ray ray);

// How many of the pixel's shapes that none of its samples has met the ray meets.
int small_count_open(const Small *small, size_t pixel, Ray ray);

// When contrasts have become known: what small_variance says.
void small_set_law(Small *small);

// The variance of the mean of so many samples that a pixel's small shapes bring, if it has any: c² a (1 - a) / n as
// long as samples come one by one, and that of an edge from where each may be expected to be met.
static inline double small_variance(const Small *small, size_t pixel, double count)
{
    double few = (double)small->law[pixel][0] / count, many = (double)small->law[pixel][1] / (count * sqrt(count));
    return few < many ? few : many;
}

// Where a shape lies in the picture: an ellipse around x, y, in pixels of the film, whose points are
// x + xx^(1/2) cos t, ...: the image of the unit disc under a root of its matrix.
typedef struct Footprint {
    Extent extent;
    double x, y;          // 0, 0 is the middle of the first pixel
    double xx, xy, yy;    // the matrix of the shape itself,
    double wide_xx, wide_xy, wide_yy; // and that of all that it may reach through a lens
    double area;          // of the first, in pixels
    double lens[2][2];    // by how much the two axes of a lens move it
} Footprint;

// Whether a shape glows brighter than white.
bool small_is_lamp(const Prepared *prepared, const Extent *extent);

// Whether a ray crosses an entry's shape, which may be a spot; of a lamp, sees it.
bool small_is_met(const Small *small, ShapeId shape, Ray ray);

// Whether a ray that crosses it shows it: it may, where what is before it lets light through.
bool small_is_shown(const Small *small, ShapeId shape, Ray ray);

// As extent_place.
uint32_t small_place(const Small *small, ShapeId shape);

// Whether a spot is narrow enough to be listed.
typedef bool SpotIsNarrow(const void *view, const SmallSpot *spot);

// sampling_spot.c: lists the highlights that is_narrow; `is_candidate` says of a sphere whether one that falls off when
// the mirrored way is so `turned` may be. False when out of memory.
bool spots_find(Small *small, bool (*is_candidate)(const void *view, const Extent *extent, double turned),
                SpotIsNarrow *is_narrow, const void *view);

// The finish of a surface that shines alike at all its points; NULL for others, and where it is bumpy.
const PreparedFinish *spot_finish(const Prepared *p, MaterialIndex material);

// Whether a light has highlights that may be narrow; the direction to it, of unit length, and how far it is; and whether
// it reaches a point of a surface, as far as opaque shapes decide. `plane`: the normal of the surface if it is a plane,
// else NULL.
bool spot_has_light(const PreparedLight *light);
Vec3 spot_to_light(const PreparedLight *light, Vec3 point, double *distance);
bool spot_is_lit(const Prepared *p, const PreparedLight *light, ShapeId shape, const Vec3 *plane, Vec3 point,
                 Vec3 normal);

// False when out of memory.
bool spot_add(Small *small, const SmallSpot *spot);

// sampling_glint.c: lists narrow highlights of other surfaces, as far as they are found from the pixels. False when out
// of memory.
bool glints_find(Small *small, const RenderOptions *options, SpotIsNarrow *is_narrow, const void *view);

// The footprint of an entry's shape.
Footprint small_footprint(const Small *small, ShapeId shape);

// The share of the pixel's light that a point beside its middle has, for each pixel of area.
double small_weight(const Small *small, double x, double y);

#endif
