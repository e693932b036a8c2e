// The schema: every kind of block and every property, in one table.
//
// The table drives the evaluation of blocks, "unknown property", range checks and the reference in docs/language.md.
// A property is one line of schema.c; a new shape is a few lines there, a description and a function that places it.
// Words are text here; the evaluator looks them up once. Constant data, shared by all threads.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SCHEMA_H
#define SCENE_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/text.h"

typedef enum SchemaKind {
    KIND_NONE,
    KIND_CAMERA,
    KIND_LIGHT_SOURCE,
    KIND_SPHERE,
    KIND_PLANE,
    KIND_BOX,
    KIND_CYLINDER,
    KIND_CONE,
    KIND_DISC,
    KIND_TORUS,
    KIND_QUADRIC,
    KIND_CUBIC,
    KIND_QUARTIC,
    KIND_POLY,
    KIND_POLYNOMIAL,
    KIND_OVUS,
    KIND_BLOB,
    KIND_ISOSURFACE,
    KIND_PARAMETRIC,
    KIND_PRISM,
    KIND_POLYGON,
    KIND_TEXT,
    KIND_LATHE,
    KIND_SOR,
    KIND_SUPERELLIPSOID,
    KIND_SPHERE_SWEEP,
    KIND_JULIA_FRACTAL,
    KIND_TRIANGLE,
    KIND_SMOOTH_TRIANGLE,
    KIND_MESH,
    KIND_MESH2,
    KIND_HEIGHT_FIELD,
    KIND_BICUBIC_PATCH,
    KIND_UNION,
    KIND_MERGE,
    KIND_INTERSECTION,
    KIND_DIFFERENCE,
    KIND_LIGHT_GROUP,
    KIND_OBJECT,
    KIND_BACKGROUND,
    KIND_SKY_SPHERE,
    KIND_FOG,
    KIND_RAINBOW,
    KIND_GLOBAL_SETTINGS,
    KIND_TEXTURE,
    KIND_PIGMENT,
    KIND_NORMAL,
    KIND_FINISH,
    KIND_COLOUR_MAP,
    KIND_PIGMENT_MAP,
    KIND_TEXTURE_MAP,
    KIND_IMAGE_MAP,
    KIND_IMAGE_PATTERN,
    KIND_BUMP_MAP,
    KIND_MATERIAL_MAP,
    KIND_NORMAL_MAP,
    KIND_SLOPE_MAP,
    KIND_INTERIOR,
    KIND_MATERIAL,
    KIND_CLIPPED_BY, // braces of an object's properties; read as objects
    KIND_BOUNDED_BY,
    KIND_LOOKS_LIKE,
    KIND_BLOB_BALL, // the braces of a blob's `sphere` and `cylinder`
    KIND_BLOB_ROD,
    KIND_CONTAINED_BY, // the braces of `contained_by`, and of what stands in them
    KIND_CONTAINER_BALL,
    KIND_CONTAINER_BOX,
    KIND_REFLECTION, // the braces of `reflection`; written into a finish
    KIND_TRANSFORM,
    KIND_WARP,
    KIND_SLOPE,       // the braces of the pattern `slope`
    KIND_IRID,        // the braces of `irid`; written into a finish
    KIND_PATTERN,     // of a function
    KIND_UNSUPPORTED, // declared, but of a kind or with a property that rtlang has not
    KIND_COUNT
} SchemaKind;

typedef enum SchemaType {
    TYPE_FLAG,            // bool: the word alone makes it true
    TYPE_SWITCH,          // bool: the word, or the word and a truth value
    TYPE_NUMBER,          // double
    TYPE_OPTIONAL_NUMBER, // double: `bare` when the word stands alone
    TYPE_SHARE,           // double, and a bool at `given`: `albedo` stood before it
    TYPE_SHARE_PAIR,      // two doubles in a row, the second optional; else like TYPE_SHARE
    TYPE_INTEGER,         // int: a number, cut towards zero
    TYPE_VECTOR,          // Vec3
    TYPE_NUMBERS,         // Numbers: `<…>` of any length
    TYPE_COLOUR,          // Rgbft
    TYPE_RGB,             // Rgb: a colour whose filter and transmit do not count
    TYPE_BLOCK,           // braces; `action` says what they are for
    TYPE_ACTION,          // read by the code that `action` names
} SchemaType;

typedef enum SchemaAction {
    ACTION_NONE,
    ACTION_TRANSLATE,
    ACTION_ROTATE,
    ACTION_SCALE,
    ACTION_MATRIX,
    ACTION_TRANSFORM,
    ACTION_TEXTURE,
    ACTION_INNER_TEXTURE,
    ACTION_PIGMENT,
    ACTION_NORMAL,
    ACTION_FINISH,
    ACTION_PATTERN,
    ACTION_WAVE,
    ACTION_PATTERN_SOLID,
    ACTION_MAP,
    ACTION_IMAGE_MAP, // its braces
    ACTION_IMAGE,     // what stands in them
    ACTION_INTERIOR,
    ACTION_MATERIAL,
    ACTION_REFLECTION,
    ACTION_BLOB_PART,
    ACTION_SHAPE_FUNCTION,
    ACTION_CONTAINED_BY,
    ACTION_CONTAINER,
    ACTION_EVALUATE,
    ACTION_PRECOMPUTE,
    ACTION_JULIA,
    ACTION_FRACTAL,
    ACTION_CLIP,
    ACTION_INVERSE,
    ACTION_ANGLE,
    ACTION_LOOK_AT,
    ACTION_BLUR_SAMPLES,
    ACTION_POINT_AT,
    ACTION_LIGHT_TYPE,
    ACTION_CONE,
    ACTION_SHADOWLESS,
    ACTION_LOOKS_LIKE,
    ACTION_AREA_LIGHT,
    ACTION_ASSUMED_GAMMA,
    ACTION_SKY_LAYER,
    ACTION_WARP,
    ACTION_TILES,
    ACTION_INSIDE,
    ACTION_WARP_TYPE,
    ACTION_SLOPE,      // the pattern
    ACTION_SLOPE_ITEM, // what stands in its braces
    ACTION_FUNCTION,
    ACTION_IRID,
    ACTION_CYLINDER,
    ACTION_CAMERA_NORMAL,
    ACTION_RAINBOW_MAP,
    ACTION_CHARSET,
    ACTION_NOISE_GENERATOR,
    ACTION_SURFACE,
    ACTION_PICTURE,      // `image_pattern` and the like
    ACTION_DENSITY,      // `density_file`
    ACTION_MAP_MATERIAL, // a texture of a material_map
    ACTION_COUNT
} SchemaAction;

typedef enum SchemaPolicy {
    RANGE_ANY,   // every finite number
    RANGE_FAULT, // outside is an error
    RANGE_WARN,  // outside is reported and used
    RANGE_CLAMP, // outside is reported and the nearest end is used
    RANGE_RAISE, // below is reported and the low end is used, above is an error
} SchemaPolicy;

typedef struct SchemaRange {
    SchemaPolicy policy;
    bool low_is_open; // low itself is outside
    double low, high;
} SchemaRange;

typedef struct SchemaProperty {
    const char *word; // of an argument: its name in messages and in the reference
    SchemaType type;
    SchemaAction action;
    uint16_t at;       // offset of the value in the description
    uint16_t given;    // offset of a bool that turns true; 0: none
    bool is_optional;  // an argument that may be left out
    bool is_first;     // stands before every other item of the block
    bool is_leading;   // stands before every other item that does not
    bool is_anywhere;  // an optional argument that may also stand among the properties, again and again
    double bare;       // TYPE_OPTIONAL_NUMBER without a number
    SchemaRange range; // of numbers
    const char *doc;   // one line
} SchemaProperty;

typedef struct SchemaList {
    const SchemaProperty *items;
    size_t count;
} SchemaList;

enum { SCHEMA_GROUPS = 3 };

typedef struct SchemaBlock {
    const char *word;
    const char *inside;   // the word of the block that it stands in, where another kind has its word; else NULL
    const char *what;     // messages call it, "a sphere"; NULL: it is never a value
    size_t size;          // of the description
    const void *defaults; // a description as it is before anything is said
    bool is_object;       // may stand in a union and as an object
    bool is_declarable;   // may stand on the right of a #declare
    bool is_fixed;        // after an identifier only transforms may follow
    SchemaList arguments; // in order, before the properties
    SchemaList groups[SCHEMA_GROUPS]; // properties of its own, then shared ones; transforms are the last
    const char *doc;
} SchemaBlock;

// A word that POV-Ray has and rtlang has not, what to do instead (NULL: nothing near), and what a picture lacks that is
// drawn without it (NULL: the shape of a kind, else what the word would change).
typedef struct SchemaUnsupported {
    const char *word;
    bool is_kind; // a block of its own
    const char *instead;
    const char *lacks;
} SchemaUnsupported;

// The entry of a kind, never NULL.
const SchemaBlock *schema_kind(SchemaKind kind);

// The property at `index`, counted over all groups of the kind; NULL at the end.
const SchemaProperty *schema_property(SchemaKind kind, size_t index);

// What a type wants, for messages: "a number".
const char *schema_type_need(SchemaType type);

// True when the property belongs to the kind's transforms.
bool schema_is_transform(const SchemaProperty *property);

// The entry at `index`; NULL at the end. Words of no entry and no kind are unsupported as well, without advice.
const SchemaUnsupported *schema_unsupported(size_t index);

// The whole schema as Markdown tables, for docs/language.md.
void schema_write_reference(TextBuffer *out);

#endif
