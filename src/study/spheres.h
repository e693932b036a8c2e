// What formulas for a ray and a sphere do to families of hard rays: the textbook's beside the tracer's.
//
// Turns a family and a number of cases into counts and greatest errors against exact arithmetic (study/oracle.h).
// Prints nothing and knows nothing of pictures.
//
// SPDX-License-Identifier: MIT
#ifndef STUDY_SPHERES_H
#define STUDY_SPHERES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"

typedef enum StudyFormula { FORMULA_TEXTBOOK, FORMULA_OURS, FORMULAS } StudyFormula;

// "textbook", "rtlang"
const char *study_formula_name(StudyFormula formula);

typedef struct SphereRow {
    const char *family;
    uint64_t cases;
    uint64_t doubtful; // of ours: cases that double words decided
    struct {
        double backward;                         // greatest, in u; of hits of the right class
        double ulps;                             // greatest error of t
        uint64_t wrong, inexcusable, not_finite; // classes; hits whose t is infinite or no number
    } of[FORMULAS];
} SphereRow;

size_t study_family_count(void);

// False when out of memory.
bool study_family(size_t family, uint64_t cases, uint64_t seed, SphereRow *row) RT_MUST_CHECK;

// The greatest errors at a distance of so many radii.
typedef struct DistancePoint {
    double distance; // in radii
    double backward[FORMULAS], ulps[FORMULAS];
} DistancePoint;

enum { DISTANCE_POINTS = 29 };

bool study_distances(uint64_t cases, uint64_t seed, DistancePoint points[DISTANCE_POINTS]) RT_MUST_CHECK;

// Numbers that are no numbers: hits whose t is not finite, of all combinations of NaN, infinity, 0 and others.
void study_malformed(uint64_t *cases, uint64_t not_finite[FORMULAS]);

// How a ray that starts on a surface is kept from meeting it again.
typedef enum SecondaryRule { RULE_NONE, RULE_FIXED, RULE_IDENTITY, RULES } SecondaryRule;

// "no tolerance", "t > 0.001", "rtlang: id and side"
const char *study_rule_name(SecondaryRule rule);

typedef struct SecondaryRow {
    double scale;   // of the scene
    uint64_t cases; // of each kind
    uint64_t false_shadows[RULES], wrong_exits[RULES], missed_contacts[RULES];
} SecondaryRow;

void study_secondary(double scale, uint64_t cases, uint64_t seed, SecondaryRow *row);

// ---- stiff

// Two unit mirrors with a gap: bounces along their common axis until the path is off it by 1e-3.
typedef struct MirrorRow {
    double gap, growth; // of an error at each bounce, by theory
    int bounces[3];     // in float, double, quad
    double theory[3];
} MirrorRow;

void study_mirrors(double gap, MirrorRow *row);

// A unit sphere and one within it, smaller by `gap` and a quarter of that aside: rays for which the inner one comes
// first, and those for which both have the same t.
typedef struct ShellRow {
    double gap;
    uint64_t cases, wrong[FORMULAS], ties[FORMULAS];
} ShellRow;

void study_shells(double gap, uint64_t cases, uint64_t seed, ShellRow *row);

// Total reflection near its threshold: of k = 1 - eta² (1 - cos²) the sign decides. Cases of the wrong class, the
// greatest |k| of them in u, and the greatest error of the bent ray's cosine, in u / cos².
typedef struct TotalRow {
    uint64_t cases, wrong;
    double greatest_wrong, cosine_error;
} TotalRow;

void study_total_reflection(uint64_t cases, uint64_t seed, TotalRow *row);

#endif
