// What prisms, polygons and what is turned about an axis have in common: points that are read, and curves through them.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_BUILD_OUTLINE_H
#define EVAL_BUILD_OUTLINE_H

#include "eval/build/blocks.h"
#include "scene/outline.h"

typedef enum OutlineCurve { CURVE_LINEAR, CURVE_QUADRATIC, CURVE_CUBIC, CURVE_BEZIER } OutlineCurve;

// An outline while it is made; room for all of it.
typedef struct OutlinePen {
    double *items;
    size_t count;
} OutlinePen;

// Begin an outline of such curves, with room for as many pieces.
bool outline_pen_begin(Block *block, OutlinePen *pen, OutlineCurve curve, bool is_conic, size_t pieces,
                       Span span) RT_MUST_CHECK;

// A piece from p[1] to `end`, or from p[0]; `end` is p[2], or the start of the curve that it closes. Of a quadratic
// curve p[0], and of a cubic one p[3], too, say how steep it is at its ends.
void outline_pen_piece(OutlinePen *pen, OutlineCurve curve, const OutlinePoint *p, OutlinePoint end);

// Whether two points are one, as for POV-Ray.
bool outline_is_same(OutlinePoint a, OutlinePoint b);

// The words for a curve; for a sweep, too, where `is_conic` is not NULL. The last of each kind counts.
void outline_read_words(Block *block, OutlineCurve *curve, bool *is_conic);

// What a curve is called before "prism" or "lathe".
const char *outline_curve_name(OutlineCurve curve);

// The number of points, which stands next, and those, in the block's memory. `what` stands before the shape's word in
// messages; *span is that of the number.
bool outline_read_count(Block *block, unsigned least, const char *what, size_t *count, Span *span) RT_MUST_CHECK;
bool outline_read_points(Block *block, size_t count, Span span, OutlinePoint **points) RT_MUST_CHECK;

#endif
