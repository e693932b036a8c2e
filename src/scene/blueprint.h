// Blueprints: what the braces of each kind of block say, as plain structs that the schema's offsets lead into.
//
// The evaluator copies a kind's defaults, writes what stands in the block over them and turns the result into scene
// records. A declared block is kept as its blueprint and never changed again. Whatever may be transformed begins with
// its Transform.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_BLUEPRINT_H
#define SCENE_BLUEPRINT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/source.h"
#include "math/colour.h"
#include "math/transform.h"
#include "math/vec3.h"
#include "scene/scene.h"
#include "scene/schema.h"

typedef struct CameraBlueprint {
    Transform transform; // of all transforms so far; identity again once the camera is complete
    Vec3 location, direction, right, up, sky, look_at;
    double angle_deg, angle_vertical_deg;
    bool types[CAMERA_TYPES]; // as written: at most one; else perspective
    bool has_right, has_up, has_look_at, has_angle;
    double aperture, confidence, variance;
    int blur_samples[2]; // the least and the most; the second is 0 where one is given
    Vec3 focal_point;
    bool has_focal_point;
    double focal_distance; // when complete
} CameraBlueprint;

// A picture as it is laid over a surface.
typedef struct ImageBlueprint {
    PictureSource source; // no path: none was named
    ImageMap map;         // its picture and shades are not set
    bool is_once, ignored;
    Span span; // of the file's name
    const PictureShade *shades; // their `next` is not set
    size_t shade_count;
} ImageBlueprint;

// A pattern in space and what lies along it; with PATTERN_NONE, what the pigment or texture around it says.
typedef struct PatternMap PatternMap;
typedef struct PatternPart {
    Transform transform; // from the pattern's space; also moves what lies below a texture
    Pattern pattern;
    const PatternMap *map; // NULL: the pattern's own
    const ImageBlueprint *image; // PATTERN_IMAGE_MAP
} PatternPart;

typedef struct PigmentBlueprint {
    PatternPart part;
    Rgbft colour, quick_colour;
} PigmentBlueprint;

// Bumps; with PATTERN_NONE there are none.
typedef struct NormalBlueprint {
    PatternPart part;         // its map is one of normals
    const PatternMap *slopes; // instead of such a map, or NULL
    double amount, accuracy;
    Span span;                // where one without a pattern was said, which must not be used; else empty
    bool keeps_length; // no_bump_scale
} NormalBlueprint;

typedef struct TextureBlueprint TextureBlueprint;
struct TextureBlueprint {
    PatternPart part; // a pattern of textures
    PigmentBlueprint pigment;
    NormalBlueprint normal;
    bool keeps_length; // no_bump_scale
    Finish finish;
    double ior; // said in the finish, as before version 3.1; 0: not
    const TextureBlueprint *below;
};

typedef struct InteriorBlueprint {
    Interior interior;
} InteriorBlueprint;

// The two together.
typedef struct MaterialBlueprint {
    Transform transform; // of the texture
    const TextureBlueprint *texture;   // NULL: none was given
    const InteriorBlueprint *interior; // likewise
} MaterialBlueprint;

typedef struct PatternEntry {
    double at;
    Rgbft colour;
    const PigmentBlueprint *pigment; // instead of the colour, or NULL
    const TextureBlueprint *texture; // of a map of textures
    const NormalBlueprint *normal;   // of a map of normals
    double height, slope;            // of a slope map
} PatternEntry;

struct PatternMap {
    const PatternEntry *entries; // NULL in the blueprint of a map that has none yet
    size_t count;
};

// One object of a clipped_by or bounded_by, moved by the transforms that came after it.
typedef struct Clip Clip;
struct Clip {
    const Clip *next;
    const void *object; // the blueprint of its kind
    SchemaKind kind;
    Transform transform;
};

// Common to everything that may be an object.
typedef struct ObjectPart {
    Transform transform;
    bool hollow, split_union;
    const InteriorBlueprint *interior; // of its own; NULL: taken over
    bool is_inverse;
    bool was_turned; // inside out, if only to be turned back
    bool no_shadow, no_image, no_reflection;
    bool ignored; // what changes no picture
    const Clip *clips, *bounds; // in order
    const TextureBlueprint *texture; // of its own, as it is moved with the object; NULL: taken over
    Span span;
} ObjectPart;

typedef struct UnionMember UnionMember;

typedef struct LightBlueprint {
    ObjectPart part; // of a declared light that is used, or an object around it; its texture is for `look`
    Vec3 position, point_at;
    Rgbft colour;
    double radius, falloff, tightness, fade_distance, fade_power;
    LightArea area;
    const UnionMember *look;  // the object that is seen in its place, or NULL
    Transform look_transform; // of the object
    uint32_t look_depth;      // of groups and lights in one another
    bool parallel, spotlight, cylinder, shadowless;
    bool is_attenuated; // media_attenuation
    bool is_ignored;    // a word that changes no picture here
} LightBlueprint;

typedef struct SphereBlueprint {
    ObjectPart part;
    Vec3 centre;
    double radius;          // below 0: the sphere has its box inside out
    const Transform *rigid; // the transform before the first that need not keep a sphere; NULL: there is none
} SphereBlueprint;

typedef struct PlaneBlueprint {
    ObjectPart part;
    Vec3 normal;
    double distance;
} PlaneBlueprint;

typedef struct BoxBlueprint {
    ObjectPart part;
    Vec3 corner, other_corner;
} BoxBlueprint;

typedef struct CylinderBlueprint {
    ObjectPart part;
    Vec3 base, cap;
    double radius;
    bool is_open;
} CylinderBlueprint;

typedef struct ConeBlueprint {
    ObjectPart part;
    Vec3 base;
    double base_radius;
    Vec3 cap;
    double cap_radius;
    bool is_open;
} ConeBlueprint;

typedef struct DiscBlueprint {
    ObjectPart part;
    Vec3 centre, normal;
    double radius, hole;
} DiscBlueprint;

typedef struct TriangleBlueprint {
    ObjectPart part;
    Vec3 corners[3];
} TriangleBlueprint;

typedef struct SmoothTriangleBlueprint {
    ObjectPart part;
    Vec3 corners[3], normals[3];
} SmoothTriangleBlueprint;

struct UnionMember {
    UnionMember *next;
    const void *object; // the blueprint of its kind
    SchemaKind kind;
};

// A transform of a union as it was written, for its extent.
typedef struct UnionStep UnionStep;
struct UnionStep {
    Transform transform;
    bool keeps_spheres; // it moves, turns or scales evenly
    const UnionStep *earlier;
};

// A union, merge, intersection or difference; the objects in clipped_by or bounded_by.
typedef struct UnionBlueprint {
    ObjectPart part;
    const UnionStep *steps; // the last one first
    const UnionMember *members;
    uint32_t count;
    uint32_t depth;       // of the unions inside, this one included
    bool is_other_block;  // `clipped_by { bounded_by }` or the other way round
} UnionBlueprint;

typedef struct BackgroundBlueprint {
    Rgbft colour;
} BackgroundBlueprint;

typedef struct SkyLayer SkyLayer;
struct SkyLayer {
    const SkyLayer *below;
    PigmentBlueprint pigment;
};

typedef struct SkySphereBlueprint {
    Transform transform; // of all layers, wherever it stands
    const SkyLayer *top;
    Rgb emission;
} SkySphereBlueprint;

typedef struct FogBlueprint {
    Transform transform; // moves what `up` is so far
    int type;
    double distance, offset, alt;
    Vec3 up;
    Rgbft colour;
    Vec3 turbulence;
    double turbulence_detail; // its lambda, omega or octaves
    double turb_depth;
    const char *turbulent_word; // the first that makes it turbulent, or NULL, and where it stands
    Span turbulent_span;
} FogBlueprint;

typedef struct SettingsBlueprint {
    Rgb ambient_light;
    double adc_bailout;
    int max_trace_level;
    int noise_generator;
    int number_of_waves;
    double ignored; // settings that change no picture here
} SettingsBlueprint;

typedef struct FinishBlueprint {
    Finish finish;
    double ior; // as in TextureBlueprint
    bool is_fresnel;
    // The share was given as an albedo; resolved and false again once the finish is complete.
    bool diffuse_is_albedo, phong_is_albedo, specular_is_albedo;
    bool conserve_energy;
} FinishBlueprint;

typedef struct TransformBlueprint {
    Transform transform;
    bool is_inverse;
} TransformBlueprint;

// A block that POV-Ray has and rtlang has not, declared but not used yet.
typedef struct UnsupportedBlueprint {
    Span span; // of the word
    const char *word;
    SchemaKind owner; // the kind it stands in; KIND_NONE when it is a kind itself
} UnsupportedBlueprint;

// Room for any of them.
typedef union Blueprint {
    Transform transform; // of any that has one
    ObjectPart part;     // of any that is an object
    CameraBlueprint camera;
    LightBlueprint light;
    SphereBlueprint sphere;
    PlaneBlueprint plane;
    BoxBlueprint box;
    CylinderBlueprint cylinder;
    ConeBlueprint cone;
    DiscBlueprint disc;
    TriangleBlueprint triangle;
    SmoothTriangleBlueprint smooth_triangle;
    UnionBlueprint group;
    BackgroundBlueprint background;
    SkySphereBlueprint sky;
    FogBlueprint fog;
    SettingsBlueprint settings;
    PigmentBlueprint pigment;
    FinishBlueprint finish;
    PatternPart patterned; // of a pigment, normal or texture
    NormalBlueprint normal;
    PatternMap map;
    ImageBlueprint image;
    TextureBlueprint texture;
    InteriorBlueprint interior;
    MaterialBlueprint material;
    TransformBlueprint transformation;
    UnsupportedBlueprint unsupported;
} Blueprint;

#endif
