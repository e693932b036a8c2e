// The range of numbers that a scene lives in: the exact scale that it is traced at, and warnings about what is beyond.
//
// Turns the lengths of scene records into one exponent, and into located warnings that say what will be seen of shapes
// whose numbers the tracer cannot hold up. docs/numerics.md has the range and why it is so. Changes nothing.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_RANGE_H
#define SCENE_RANGE_H

#include "base/attributes.h"
#include "scene/scene.h"

enum { SPHERE_RUN = 16384 }; // spheres that a thread looks at on end

// Scaled lengths: the squares of radii from 2^RANGE_LEAST to below 2^RANGE_END, and of coordinates below 2^RANGE_END,
// are held with all their bits.
enum { RANGE_LEAST = -480, RANGE_END = 511 };

// Seen from the camera, the greatest distance in radii at which a sphere's outline is a hundredth of its radius: 0.01 /
// u, rounded down to a power of two.
#define RANGE_RADII 0x1p46

// Totals over all spheres, by one look at each that has not been looked at yet.
void scene_survey_spheres(const Scene *scene, int threads, SphereSurvey *survey);
// The same, and the scene keeps it, until spheres are changed.
void scene_keep_survey(Scene *scene, int threads);
bool scene_has_material(const Scene *scene, MaterialIndex index);

// What a scene is scaled by, and the size of its least shape, which is INFINITY where none has a size.
typedef struct SceneScale {
    int exponent;
    double least_size; // unscaled
} SceneScale;

// The exponent puts the scene's lengths in the middle of the range of double: scaled by 2^-exponent, squares of the
// greatest and the least are as far from overflow as from underflow. Where they span more than that range, it is the
// one that the most of the scene has, as if what cannot be held beside it, which scene_warn_of_range reports, were not
// there; the camera always counts. A scene times 2^k has an exponent greater by k, so both become the same numbers.
// (The direction and screen of a perspective camera have no length that matters.)
SceneScale scene_scale(const Scene *scene, int threads);

// Whether all lengths of a scene fit one scale, of spheres that are surveyed elsewhere, too.
bool scene_range_is_held(const Scene *scene, const SphereSurvey *spheres);

// Warns of shapes that are lost beside their coordinates, beyond the range of squares, or too far for their size, and
// of lights and cameras beyond the range. One pass.
void scene_warn_of_range(const Scene *scene, const SphereSurvey *survey, DiagSink *diags);

// Whether that may report anything of some of the spheres that are surveyed.
bool scene_range_reports(const Scene *scene, const SphereSurvey *survey, const SphereSurvey *some);

// Warns of equal shapes that some ray could see both of. Linear in the number of shapes. False when out of memory.
bool scene_warn_of_coincident(const Scene *scene, DiagSink *diags, int threads) RT_MUST_CHECK;

// Whether that takes two parts for equal.
bool scene_primitives_coincide(const Primitive *a, const Primitive *b);

#endif
