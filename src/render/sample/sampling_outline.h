// Outlines of spheres in the picture, and the exact shares that they have of a pixel.
//
// Private to src/render; docs/sampling.md, "Edges of spheres".
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_SAMPLE_SAMPLING_OUTLINE_H
#define RENDER_SAMPLE_SAMPLING_OUTLINE_H

#include <math.h>
#include <stdbool.h>

#include "math/vec3.h"
#include "render/records/prepared.h"

// An ellipse. Its row at `down` below its middle has its own middle at x + slope * down and reaches
// half_row * sqrt(1 - narrowing * down²) to both sides of that.
typedef struct Outline {
    double x, y; // in pixels, to the right and down
    double slope, half_row, narrowing;
} Outline;

// What goes from the camera's space to pixels of the whole picture.
typedef struct OutlineView {
    const PreparedCamera *camera;
    double width, height;
    Vec3 across, down, ahead; // of a point seen from the camera: multiples of right, -up and direction
    Vec3 column, row;         // by how much a ray's point, or its origin, moves from pixel to pixel
} OutlineView;

// False where outlines are no ellipses in the picture: with a lens, or a camera that is wider than a perspective one.
bool outline_view_init(OutlineView *view, const PreparedCamera *camera, int width, int height);

// The outline of a sphere, in pixels of the whole picture, where 0, 0 is the middle of the first. `*distance` says
// which of two spheres that are apart is before the other where their outlines overlap: the one with less. False where
// the sphere is not before the camera as a whole, or its outline is no ellipse, or too large or small to be of use.
bool outline_of(const OutlineView *view, Vec3 centre, double radius_squared, Outline *outline, double *distance);

// From where to where a row goes; false: nowhere.
static inline bool outline_row(const Outline *outline, double y, double *left, double *right)
{
    double down = y - outline->y, part = 1.0 - outline->narrowing * (down * down);
    if (!(part > 0.0)) {
        return false;
    }
    double middle = outline->x + outline->slope * down, half = outline->half_row * sqrt(part);
    *left = middle - half;
    *right = middle + half;
    return true;
}

static inline bool outline_has(const Outline *outline, double x, double y)
{
    double down = y - outline->y, across = x - outline->x - outline->slope * down;
    return across * across <= outline->half_row * outline->half_row * (1.0 - outline->narrowing * (down * down));
}

// Half the height and half the width of the whole.
static inline double outline_half_height(const Outline *outline)
{
    return sqrt(1.0 / outline->narrowing);
}

static inline double outline_half_width(const Outline *outline)
{
    return sqrt(outline->half_row * outline->half_row + outline->slope * outline->slope / outline->narrowing);
}

// Columns between two heights: those that an outline reaches, and those that it covers all the way; left is beyond
// right where there are none.
typedef struct OutlineColumns {
    double left, right, inner_left, inner_right;
} OutlineColumns;

OutlineColumns outline_columns(const Outline *outline, double top, double bottom);

enum { OUTLINES_MOST = 4, OUTLINES_ROUGH = 8 };

// Shares of the square of one pixel around 0, 0: those of each outline that are in none before it, then that of the
// rest. Exact but for rounding and for crossings that are found where edges are 1e-5 of a pixel apart; OUTLINES_MOST outlines at most.
void outline_areas(const Outline *outlines, int count, double *areas);

// The same from a few rows, of OUTLINES_ROUGH outlines at most.
void outline_areas_roughly(const Outline *outlines, int count, double *areas);

#endif
