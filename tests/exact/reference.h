// A picture in exact arithmetic, near enough: spheres, planes, point lights, highlights and mirrors, with MPFR.
//
// Written from POV-Ray's manual, for tests only: it knows nothing of the program under test but the numbers of a scene,
// and shares no line with it. Numbers have as many bits as the family wants, so that rounding is far below anything
// that a double can show; a ray that leaves a surface passes by what is nearer than half of these bits.
//
// SPDX-License-Identifier: MIT
#ifndef EXACT_REFERENCE_H
#define EXACT_REFERENCE_H

#include <stdbool.h>

enum { SHAPES_MOST = 64, LIGHTS_MOST = 4, BOUNCES_MOST = 14 };

// A sphere, or a plane through all points p with p[axis] = distance.
typedef struct ExactShape {
    bool is_plane;
    int axis;
    double centre[3], radius, distance;
    double rgb[3], mirror, phong;
} ExactShape;

typedef struct ExactLight {
    double position[3], rgb[3];
} ExactLight;

// In directions of direction + u right + v up; all other finishes are those of the constants below.
typedef struct ExactScene {
    double location[3], direction[3], right[3], up[3];
    ExactShape shapes[SHAPES_MOST];
    ExactLight lights[LIGHTS_MOST];
    int shape_count, light_count;
    int bits;
} ExactScene;

#define EXACT_AMBIENT    0.1
#define EXACT_DIFFUSE    0.7
#define EXACT_PHONG_SIZE 20.0

// To be called before the others, and after them.
void exact_begin(void);
void exact_end(void);

// The colour that is seen through a place of the screen.
void exact_colour(const ExactScene *scene, double u, double v, double rgb[3]);

#endif
