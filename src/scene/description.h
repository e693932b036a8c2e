// Descs: what the braces of each kind of block say, as plain structs that the schema's offsets lead into.
//
// The evaluator copies a kind's defaults, writes what stands in the block over them and turns the result into scene
// records. A declared block is kept as its description and never changed again. Whatever may be transformed begins with
// its Transform.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_DESCRIPTION_H
#define SCENE_DESCRIPTION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/source.h"
#include "math/colour.h"
#include "math/transform.h"
#include "math/vec3.h"
#include "scene/blob.h"
#include "scene/scene.h"
#include "scene/schema.h"

typedef struct CameraDesc {
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
    const struct NormalDesc *normal; // NULL: no bumps
} CameraDesc;

// A picture as it is laid over a surface.
typedef struct ImageDesc {
    PictureSource source; // no path: none was named
    ImageMap map;         // its picture and shades are not set
    bool is_once, ignored, uses_alpha, uses_index;
    double bump_size;           // NaN: not said
    struct PatternEntry *textures; // of a material_map
    size_t texture_count, texture_room;
    Span span; // of the file's name
    const PictureShade *shades; // their `next` is not set
    size_t shade_count;
} ImageDesc;

// A warp, and the one that was said before it; its record's `to_outside` is the transform since then.
typedef struct WarpDesc WarpDesc;
struct WarpDesc {
    Warp warp; // `next` is not set
    const WarpDesc *before;
    unsigned count; // with those before it
};

// What stands in the braces of the pattern `slope`.
typedef struct SlopeDesc {
    Vec3 direction, altitude; // a point, where is_point
    double low, high, low_altitude, high_altitude; // that become 0 and 1, where they differ
    bool has_direction, is_point;
} SlopeDesc;

// What stands first in the braces of the pattern `object`.
typedef struct InsideDesc {
    Transform transform; // after the object's own
    const void *object;
    int kind; // SchemaKind
} InsideDesc;

// A pattern in space and what lies along it; with PATTERN_NONE, what the pigment or texture around it says.
typedef struct PatternMap PatternMap;
typedef struct PatternPart {
    Transform transform; // from the pattern's space; also moves what lies below a texture
    Pattern pattern;
    const PatternMap *map; // NULL: the pattern's own
    const ImageDesc *image; // PATTERN_IMAGE_MAP
    const struct Function *function; // PATTERN_FUNCTION, of the evaluator
    const struct PigmentDesc *pigment; // PATTERN_PIGMENT
    const InsideDesc *inside;          // PATTERN_OBJECT
    const WarpDesc *warps; // the last one first
    const Transform *on_surface; // from the pattern's space to surface coordinates, which nothing else moves; NULL: it
                                 // lies in space
    bool turns;                  // bumps of it do move: their directions, that is, and not the values given to them
    bool asks_uv;                // it or something along it lies on the surface
} PatternPart;

typedef struct PigmentDesc {
    PatternPart part;
    Rgbft colour, quick_colour;
    bool ignored; // a word that changes no picture here
} PigmentDesc;

// Bumps; with PATTERN_NONE there are none.
typedef struct NormalDesc {
    PatternPart part;         // its map is one of normals
    const PatternMap *slopes; // instead of such a map, or NULL
    double amount, accuracy;
    Span span;                // where one without a pattern was said, which must not be used; else empty
    bool keeps_length; // no_bump_scale
} NormalDesc;

typedef struct TextureDesc TextureDesc;
struct TextureDesc {
    PatternPart part; // a pattern of textures
    PigmentDesc pigment;
    NormalDesc normal;
    bool keeps_length; // no_bump_scale
    Finish finish;
    double ior; // said in the finish, as before version 3.1; 0: not
    const TextureDesc *below;
};

typedef struct InteriorDesc {
    Interior interior;
} InteriorDesc;

// The two together.
typedef struct MaterialDesc {
    Transform transform; // of the texture
    const TextureDesc *texture;   // NULL: none was given
    const TextureDesc *inner;     // likewise: interior_texture
    const InteriorDesc *interior; // likewise
} MaterialDesc;

typedef struct PatternEntry PatternEntry;
struct PatternEntry {
    double at;
    Rgbft colour;
    const PigmentDesc *pigment;      // instead of the colour, or NULL
    const TextureDesc *texture;      // of a map of textures
    const NormalDesc *normal;        // of a map of normals
    double height, slope;            // of a slope map
};

struct PatternMap {
    const PatternEntry *entries; // NULL in the description of a map that has none yet
    size_t count;
};

// One object of a clipped_by or bounded_by, moved by the transforms that came after it.
typedef struct Clip Clip;
struct Clip {
    const Clip *next;
    const void *object; // the description of its kind
    SchemaKind kind;
    Transform transform;
};

// Common to everything that may be an object.
typedef struct ObjectPart {
    Transform transform;
    bool hollow, split_union;
    const InteriorDesc *interior; // of its own; NULL: taken over
    bool is_inverse;
    bool was_turned; // inside out, if only to be turned back
    bool no_shadow, no_image, no_reflection;
    bool is_double, says_double; // double_illuminate
    bool ignored; // what changes no picture
    const Clip *clips, *bounds; // in order
    const TextureDesc *texture; // of its own, as it is moved with the object; NULL: taken over
    const TextureDesc *inner;   // likewise: interior_texture
    Span span;
} ObjectPart;

typedef struct UnionMember UnionMember;

typedef struct LightDesc {
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
    bool lights_by_area; // area_illumination
} LightDesc;

typedef struct SphereDesc {
    ObjectPart part;
    Vec3 centre;
    double radius;          // below 0: the sphere has its box inside out
    const Transform *rigid; // the transform before the first that need not keep a sphere; NULL: there is none
} SphereDesc;

typedef struct PlaneDesc {
    ObjectPart part;
    Vec3 normal;
    double distance;
} PlaneDesc;

typedef struct BoxDesc {
    ObjectPart part;
    Vec3 corner, other_corner;
} BoxDesc;

typedef struct CylinderDesc {
    ObjectPart part;
    Vec3 base, cap;
    double radius;
    bool is_open;
} CylinderDesc;

typedef struct ConeDesc {
    ObjectPart part;
    Vec3 base;
    double base_radius;
    Vec3 cap;
    double cap_radius;
    bool is_open;
} ConeDesc;

typedef struct DiscDesc {
    ObjectPart part;
    Vec3 centre, normal;
    double radius, hole;
} DiscDesc;

typedef struct TorusDesc {
    ObjectPart part;
    double major, minor;
} TorusDesc;

// quadric, cubic, quartic and poly.
typedef struct PolynomialDesc {
    ObjectPart part;
    int order;
    Vec3 squares, products, linear; // of a quadric
    double constant;
    Numbers coefficients; // of the others
    Numbers list;         // all that a part wants of it (scene/polynomial.h)
} PolynomialDesc;

// One component, the last one first.
typedef struct BlobMember BlobMember;
struct BlobMember {
    const BlobMember *earlier;
    BlobComponent component;
    const TextureDesc *texture; // its own, in the blob's space; NULL: it has none
};

typedef struct BlobDesc {
    ObjectPart part;
    double threshold;
    const BlobMember *members;
    uint32_t count;
    uint32_t texture_count;
    const TextureDesc *const *textures; // of components, by number from 1 on
    Numbers list; // all that a part wants of it (scene/blob.h)
} BlobDesc;

// A shape's functions.
typedef struct ShapeFormula {
    Numbers list;                   // all that a part wants of the shape
    const FormulaHost *host;        // of the functions, if they ask for noise or patterns; else NULL
    struct Painted *const *painted; // what their steps ask by number, as a scene's have it by the place of a pattern
} ShapeFormula;

// What an isosurface, or a parametric surface, is contained by; of a ball `low` is the middle.
typedef struct ContainerDesc {
    Vec3 low, high;
    double radius;
    bool is_ball, is_given;
} ContainerDesc;

typedef struct IsosurfaceDesc {
    ObjectPart part;
    ContainerDesc container;
    double threshold, accuracy, max_gradient;
    double evaluate[3]; // the first is 0: not given
    int roots_most;
    bool is_open;
    const struct Function *function;
    ShapeFormula formula; // scene/isosurface.h
} IsosurfaceDesc;

typedef struct OvusDesc {
    ObjectPart part;
    double bottom, top; // radii
} OvusDesc;

typedef struct ParametricDesc {
    ObjectPart part;
    ContainerDesc container;
    const struct Function *functions[3];
    double from[2], to[2]; // of u and v
    double accuracy, max_gradient;
    ShapeFormula formula; // scene/parametric.h
} ParametricDesc;

// A component while it is read.
typedef struct BlobPartDesc {
    ObjectPart part;
    Vec3 base, cap;
    double radius, strength;
} BlobPartDesc;
typedef struct PrismDesc {
    ObjectPart part;
    Numbers outline; // scene/outline.h
    double heights[2]; // in order
    bool is_open;
    bool is_control_bound; // POV-Ray's box is that of all control points
} PrismDesc;

// Its outline has no piece where all its points are one.
typedef struct LatheDesc {
    ObjectPart part;
    Numbers outline;       // scene/outline.h, closed by pieces that are not seen
    bool is_control_bound; // as of a prism
} LatheDesc;

typedef struct SorDesc {
    ObjectPart part;
    Numbers list; // scene/sor.h
    bool is_open;
} SorDesc;

typedef struct SuperellipsoidDesc {
    ObjectPart part;
    double about, along; // e and n
} SuperellipsoidDesc;

typedef struct SweepDesc {
    ObjectPart part;
    Numbers list; // scene/sweep.h, in parts of `size`
    double size;  // a power of two
    double tolerance;
} SweepDesc;

typedef struct JuliaDesc {
    ObjectPart part;
    double p[4], slice[4], distance, precision;
    int power, step_count;
    Numbers list; // scene/julia.h
} JuliaDesc;

typedef struct PolygonDesc {
    ObjectPart part;
    Numbers outline; // within the frame
    Transform frame;
} PolygonDesc;

typedef struct TriangleDesc {
    ObjectPart part;
    Vec3 corners[3];
} TriangleDesc;

typedef struct SmoothTriangleDesc {
    ObjectPart part;
    Vec3 corners[3], normals[3];
} SmoothTriangleDesc;

// A face that has another texture at each corner.
typedef struct MeshCorners {
    uint32_t face, textures[3];
} MeshCorners;

typedef struct MeshDesc {
    ObjectPart part;
    Mesh *mesh; // of the scene; not changed any more when the description is complete
    const TextureDesc **textures; // all of them, in its own space
    const TextureDesc **singles;  // those that some face has alone; the mesh counts these, and behind them `corners`
    const MeshCorners *corners;
    uint32_t single_count, corner_count;
    Vec3 inside_vector;
    bool is_smooth; // of a height field, as is `water`
    double water;
} MeshDesc;

// A bicubic patch becomes a mesh where it is placed.
typedef struct PatchDesc {
    ObjectPart part;
    Vec3 points[4][4]; // four rows; u_steps halves from row to row, v_steps within the rows
    double flatness;
    double steps[2]; // u_steps, v_steps: whole numbers
    double uv[4][2]; // at the corners: first row and last row from its start, then their ends, round the patch
} PatchDesc;

struct UnionMember {
    UnionMember *next;
    const void *object; // the description of its kind
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
// POV-Ray's box of a shape in a space of its own, which the frame leads out of.
typedef struct OwnBox {
    Vec3 low, high;
    Transform frame;
} OwnBox;

typedef struct UnionDesc {
    ObjectPart part;
    const UnionStep *steps; // the last one first
    const OwnBox *box;      // before all steps; NULL: that of the members
    const UnionMember *members;
    uint32_t count;
    uint32_t depth;       // of the unions inside, this one included
    bool is_other_block;  // `clipped_by { bounded_by }` or the other way round
    bool is_light_group;
    bool global_lights; // of a light group: lights of no group count, too
} UnionDesc;

typedef struct BackgroundDesc {
    Rgbft colour;
} BackgroundDesc;

typedef struct SkyLayer SkyLayer;
struct SkyLayer {
    const SkyLayer *below;
    PigmentDesc pigment;
};

typedef struct SkySphereDesc {
    Transform transform; // of all layers, wherever it stands
    const SkyLayer *top;
    Rgb emission;
} SkySphereDesc;

typedef struct FogDesc {
    Transform transform; // moves what `up` is so far
    int type;
    double distance, offset, alt;
    Vec3 up;
    Rgbft colour;
    bool is_turbulent; // one of the words of turbulence was said, whatever its value
    Vec3 turbulence;
    double lambda, omega, turb_depth;
    int octaves;
} FogDesc;

typedef struct RainbowDesc {
    Vec3 direction, up;
    double angle, width, distance, jitter, arc_angle, falloff_angle;
    const PatternMap *map; // NULL: nothing is seen
    bool has_direction;
} RainbowDesc;

typedef struct SettingsDesc {
    Rgb ambient_light;
    double adc_bailout;
    int max_trace_level;
    int noise_generator;
    int number_of_waves;
    Rgb irid_wavelength;
    bool is_ignored;
    double ignored; // settings that change no picture here
} SettingsDesc;

typedef struct FinishDesc {
    Finish finish;
    double ior; // as in TextureDesc
    bool is_fresnel;
    // The share was given as an albedo; resolved and false again once the finish is complete.
    bool diffuse_is_albedo, phong_is_albedo, specular_is_albedo;
    bool conserve_energy;
} FinishDesc;

typedef struct TransformDesc {
    Transform transform;
    bool is_inverse;
} TransformDesc;

// A block that POV-Ray has and rtlang has not, declared but not used yet.
typedef struct UnsupportedDesc {
    Span span; // of the word
    const char *word;
    SchemaKind owner; // the kind it stands in; KIND_NONE when it is a kind itself
    const struct UnsupportedDesc *next; // of those that a declared block was read without
} UnsupportedDesc;

// Room for any of them.
typedef union Desc {
    Transform transform; // of any that has one
    ObjectPart part;     // of any that is an object
    CameraDesc camera;
    LightDesc light;
    SphereDesc sphere;
    PlaneDesc plane;
    BoxDesc box;
    CylinderDesc cylinder;
    ConeDesc cone;
    DiscDesc disc;
    TorusDesc torus;
    PolynomialDesc polynomial;
    BlobDesc blob;
    BlobPartDesc blob_part;
    IsosurfaceDesc isosurface;
    ParametricDesc parametric;
    OvusDesc ovus;
    ContainerDesc container;
    PrismDesc prism;
    PolygonDesc polygon;
    LatheDesc lathe;
    SorDesc sor;
    SuperellipsoidDesc superellipsoid;
    SweepDesc sweep;
    JuliaDesc julia;
    TriangleDesc triangle;
    SmoothTriangleDesc smooth_triangle;
    MeshDesc mesh;
    PatchDesc patch;
    UnionDesc group;
    BackgroundDesc background;
    SkySphereDesc sky;
    FogDesc fog;
    RainbowDesc rainbow;
    SettingsDesc settings;
    PigmentDesc pigment;
    FinishDesc finish;
    PatternPart patterned; // of a pigment, normal or texture
    NormalDesc normal;
    PatternMap map;
    ImageDesc image;
    TextureDesc texture;
    InteriorDesc interior;
    MaterialDesc material;
    TransformDesc transformation;
    WarpDesc warp;
    SlopeDesc slope;
    UnsupportedDesc unsupported;
} Desc;

#endif
