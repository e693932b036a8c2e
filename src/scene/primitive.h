// The table of kinds of primitives: all that is said of a kind but how rays meet it (trace/prepared_primitive.c).
//
// A row is what makes a kind one; whoever asks about a primitive asks its row. Constant data, shared by all threads.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_PRIMITIVE_H
#define SCENE_PRIMITIVE_H

#include "base/text.h"
#include "scene/scene.h"

// Surfaces whose families have no bit in common coincide nowhere but along lines. A polynomial may be any surface: a
// ball, a cylinder or a torus.
typedef enum SurfaceFamily {
    FAMILY_ROUND = 1,
    FAMILY_STRAIGHT = 2,
    FAMILY_TUBE = 4,
    FAMILY_BLOB = 8,
    FAMILY_ISOSURFACE = 16,
    FAMILY_POLYNOMIAL = 31,
} SurfaceFamily;

enum { FACE_CORNERS_MOST = 16 }; // of a flat face; a round one is the polygon in it

typedef struct PrimitiveClass {
    const char *word;     // what messages call it
    const char *head;     // of the block in a dump, up to what `dump` adds
    SurfaceFamily family;
    PrimitiveKind surface; // the first kind of those whose surfaces are the same when map and numbers are
    uint8_t key_count;    // of data[] that make one surface another
    uint8_t interval_count; // that a line has in it, at most; 0: it is flat and has no inside, but a line meets it once
    bool has_list;        // data[2] is a list of numbers
    bool is_mesh;         // it is made of faces: a line meets it any number of times
    bool is_sized;        // data[0] and data[1] are its bounds; else those are -1 and 1 in each coordinate
    uint32_t (*interval_most)(const Primitive *primitive); // where that depends on its list; NULL: interval_count
    // The greatest p·n over the points of the fixed shape.
    double (*support)(const Primitive *primitive, Vec3 n);
    // Whether a point of the fixed shape's space (of a plane: of the scene) is inside. A disc has all below it inside.
    bool (*holds)(const Primitive *primitive, Vec3 p);         // NULL: nothing is
    void (*dump)(const Primitive *primitive, TextBuffer *out); // NULL: nothing
    // Its flat faces, by number: how many there are, the corners of one (of a plane 0), and the normal out of the shape,
    // in the fixed shape's space; NULL: none.
    uint32_t (*face_count)(const Primitive *primitive);
    uint32_t (*corner_count)(const Primitive *primitive);
    Vec3 (*corner)(const Primitive *primitive, uint32_t number, uint32_t i);
    Vec3 (*face_normal)(uint32_t number);
    // Half of what it is along each coordinate, and where that is, in the fixed shape's space; NULL: 1, and 0.
    void (*measure)(const Primitive *primitive, Vec3 *half, Vec3 *middle);
} PrimitiveClass;

const PrimitiveClass *primitive_class(PrimitiveKind kind);

static inline bool primitive_kind_is_flat(PrimitiveKind kind)
{
    return primitive_class(kind)->interval_count == 0;
}

// Whether it has no inside.
static inline bool primitive_kind_is_sheet(PrimitiveKind kind)
{
    return primitive_kind_is_flat(kind) || !primitive_class(kind)->holds;
}

// How many intervals a line has in the primitive, at most; 0: it is flat.
static inline uint32_t primitive_interval_most(const Primitive *primitive)
{
    const PrimitiveClass *class = primitive_class(primitive->kind);
    return class->interval_most ? class->interval_most(primitive) : class->interval_count;
}

#endif
