// The reference path: the same picture in another precision, for study.
//
// One kernel (render/reference/reference_kernel.h) written over a real type and compiled for float, double and
// float128, beside the kernels that trace pictures, which are tuned for double. It has no tree, no vectors and no
// double words, tests every shape for every ray, and covers spheres, planes, lights of one point or direction, and all
// finishes and interiors; the rest is refused by study_covers. Left out of builds with --disable-study.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_REFERENCE_REFERENCE_H
#define RENDER_REFERENCE_REFERENCE_H

#include "base/diag.h"
#include "render/records/options.h"

typedef enum StudyPrecision { STUDY_FLOAT, STUDY_DOUBLE, STUDY_QUAD, STUDY_PRECISIONS } StudyPrecision;

// False, with a fault at each kind of thing, when the scene has what the reference path has not.
bool study_covers(const Prepared *prepared, DiagSink *diags) RT_MUST_CHECK;

// From now on the prepared scene is traced by the reference kernel: render_film samples and tells errors as ever. The
// scene must be covered. What max_trace_level and adc_bailout cut is not counted.
void study_take(Prepared *prepared, StudyPrecision precision);

#endif
