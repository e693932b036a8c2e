// Scene records: the treaty between the language and the renderer. Plain structs, no function pointers, no strings.
//
// The evaluator adds records in order of declaration; the renderer reads them and changes nothing. All transforms are
// applied, all identifiers resolved, all defaults filled in. Lengths are in scene units, angles in degrees, colours
// are in the working space of `assumed_gamma`. Each record keeps where it was written, as a global source offset.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"
#include "base/diag.h"
#include "base/text.h"
#include "math/colour.h"
#include "math/transform.h"
#include "math/vec3.h"
#include "scene/formula.h"
#include "scene/material.h"
#include "scene/mesh.h"
#include "scene/numbers.h"
#include "scene/picture.h"
#include "scene/shape.h"
#include "scene/unique.h"
#include "scene/warp.h"

typedef enum CameraType {
    CAMERA_PERSPECTIVE,
    CAMERA_ORTHOGRAPHIC,
    CAMERA_FISHEYE,
    CAMERA_ULTRA_WIDE_ANGLE,
    CAMERA_PANORAMIC,
    CAMERA_SPHERICAL,
    CAMERA_OMNIMAX,
    CAMERA_CYLINDER_1, // a cylinder upright or lying, seen from its axis: from one point …
    CAMERA_CYLINDER_2,
    CAMERA_CYLINDER_3, // … or from one that moves along it
    CAMERA_CYLINDER_4,
    CAMERA_BUMPY, // as prepared: one whose rays bumps turn
    CAMERA_TYPES
} CameraType;

// Whether rays start elsewhere than at one place.
static inline bool camera_type_moves(CameraType type)
{
    return type == CAMERA_ORTHOGRAPHIC || type == CAMERA_CYLINDER_3 || type == CAMERA_CYLINDER_4;
}

// A pixel at (u, v), each from -1/2 (left, top) to 1/2 (right, bottom), looks
//   perspective:   from location along direction + u right - v up
//   orthographic:  from location + u right - v up along direction
//   else:          from location, as render/records/camera.h has it
// Bumps turn the direction as they turn a normal, at the point <u, -v, 0>.
typedef struct Camera {
    CameraType type;
    Vec3 location, direction, right, up;
    double angle,
        angle_vertical;    // in degrees; of a fisheye, an ultra wide angle, a spherical camera and a cylinder; the
                           // second of a spherical one
    double lens_radius;    // 0: a point; else rays start on a disc around the location, across the direction …
    double focal_distance; // … and meet those of the same (u, v) at this distance, > 0
    int blur_samples;      // rays a pixel where nothing else is said; with a lens >= 1
    int blur_least;        // of a pixel that has enough sooner; at most that many
    uint32_t bumps; // 1 + one of Scene.normals; 0: none
    double blur_confidence, blur_variance; // which it has where its mean is so likely so near; variance 0: never
    Span span;
} Camera;

typedef enum LightType { LIGHT_POINT, LIGHT_PARALLEL, LIGHT_SPOT, LIGHT_CYLINDER } LightType;

// The point lights of an area light: rows and columns, in all axis1 by axis2, its middle at the light's position.
typedef struct LightArea {
    Vec3 axis1, axis2;
    int size1, size2; // 0, 0: no area light
    int adaptive; // how often it is halved before parts whose corners look alike are taken as a whole
    bool circular, jitter, is_adaptive;
    bool is_oriented; // it faces the point that is lit: circular, axes of one length, which alone counts
} LightArea;

// Lights that light the shapes of a group alone, and those shapes.
typedef struct LightGroup {
    uint32_t first, end; // its shapes in the order of declaration
    bool has_others;     // lights of no group light them, too
} LightGroup;

typedef struct Light {
    LightType type;
    uint32_t group; // 1 + one of Scene.light_groups; 0: of none. Those of groups stand behind all others
    bool shadowless;
    bool is_attenuated; // by fog, which is not supported: a fault where there is some
    Vec3 position;
    Vec3 point_at; // but LIGHT_POINT: the light shines along point_at - position
    Rgb colour;
    double radius, falloff; // LIGHT_SPOT: half angles in degrees; LIGHT_CYLINDER: lengths; of full light, and of any
    double tightness;
    double fade_distance, fade_power; // 2 / (1 + (distance / fade_distance)^fade_power), unless one of them is 0
    LightArea area;
    Span span;
} Light;

// Light that is lost on the way of a ray, and the fog's own that comes in its place.
typedef struct Fog {
    bool is_ground; // below `offset` as everywhere, above it ever thinner
    double distance; // > 0: exp(-1) is left after it
    double offset, alt; // is_ground: heights along `up`; the density is halved at offset + alt; alt > 0
    Vec3 up;            // of unit length
    Rgbft colour;
    bool is_turbulent;
    double turb_depth;
    Vec3 turbulence; // of places from …
    Vec3 origin;     // … there
    double lambda, omega;
    int octaves;
    Span span;
} Fog;

// Colours by the angle between a ray and the sun's light.
typedef struct Rainbow {
    Vec3 direction, up;      // as written: of that light, and where the middle of an arc is
    Vec3 ahead, top, across; // unit vectors: `direction`, of `up` what is at right angles to it, and to both
    double angle, width;        // of the bow's middle and the bow, degrees; width is not 0
    double arc, falloff;        // to each side of `up`, degrees: where the arc ends, and where it begins to fade out
    double distance;            // > 0: exp(-1) of the light is left after it
    double jitter;
    uint32_t pattern; // one of Scene.patterns: the colours from x = 0 to x = 1
    Span span;
} Rainbow;

// How the values of the picture relate to light, see docs/language.md, "Gamma".
typedef enum GammaModel {
    GAMMA_LINEAR, // the working space is linear light
    GAMMA_POWER,  // linear light = value ^ assumed_gamma
    GAMMA_SRGB,   // linear light = sRGB decoding of value
    GAMMA_NONE,   // an old file that says nothing: values are written as they are
} GammaModel;

#define SCENE_VERSION_UNSAID 3.62 // of a scene without #version: drawn as those of before 3.7 are

enum {
    SETTINGS_WAVES = 10,            // number_of_waves of a scene that says nothing of it
    SETTINGS_WAVES_MAX = 1000 * 1000, // 32 MB of them
};

typedef struct Settings {
    GammaModel gamma_model;
    double assumed_gamma; // GAMMA_POWER only, else 1
    Rgb ambient_light;
    int max_trace_level; // >= 1
    double adc_bailout;
    int noise_generator; // 1 to 3, 0: that of the version
    int number_of_waves; // of the patterns `ripples` and `waves`, >= 1
    Rgb irid_wavelength; // of red, green and blue, in the thickness's unit
    Rgb sky_light; // from all sides; black: none. Of the run, not of the language
    double version; // the language version in force at the end, SCENE_VERSION_UNSAID if none was given
} Settings;

// Totals over all spheres.
typedef struct SphereSurvey {
    double least_radius, greatest_radius, greatest_place;
    bool is_valid; // all numbers are finite, all radii > 0, all materials there; else the rest means nothing
} SphereSurvey;

#define SURVEY_OF_NOTHING ((SphereSurvey){INFINITY, 0.0, 0.0, true})

static inline void sphere_survey_add(SphereSurvey *survey, const SphereSurvey *more)
{
    survey->least_radius = fmin(survey->least_radius, more->least_radius);
    survey->greatest_radius = fmax(survey->greatest_radius, more->greatest_radius);
    survey->greatest_place = fmax(survey->greatest_place, more->greatest_place);
    survey->is_valid = survey->is_valid && more->is_valid;
}

// Which spheres of a scene that is larger than one machine are kept here: of `parts` processes, this is number `part`.
typedef struct SceneShare {
    uint32_t part, parts; // 0 or 1 parts: all are
    bool has_other;       // the last one is another's: it stays until the next shape, for who has added it
} SceneShare;

typedef struct Scene {
    Span whole; // the text it was made from, for messages about the scene as a whole
    Settings settings;
    Rgbft background;
    ARRAY(Pigment) sky; // layers before the background, the topmost first; a pattern's point is the ray's direction
    Rgb sky_emission;   // what their light is multiplied with
    Span sky_span;
    ARRAY(Fog) fogs;
    ARRAY(Rainbow) rainbows;
    bool has_camera; // the scene said so; else camera is the language's default
    Camera camera;
    ARRAY(Light) lights;
    ARRAY(LightGroup) light_groups; // in the order of shapes; none is within another
    ARRAY(Finish) finishes;    // each different one once
    ARRAY(Material) materials; // each different one once, or nearly so, see scene_add_material_record
    ARRAY(PigmentEntry) pigment_entries; // of these nine, too, each different one once
    ARRAY(PatternedPigment) patterns;
    ARRAY(FormulaStep) formula_steps; // likewise
    ARRAY(Warp) warps;                // likewise
    ARRAY(PictureSource) picture_sources; // and these three
    ARRAY(PictureShade) picture_shades;
    ARRAY(ImageMap) image_maps;
    ARRAY(Picture) pictures; // beside picture_sources: what was read
    ARRAY(SlopeEntry) slope_entries;
    ARRAY(NormalEntry) normal_entries;
    ARRAY(Normal) normals;
    ARRAY(TextureEntry) texture_entries;
    ARRAY(Texture) textures;
    ARRAY(Interior) interiors;
    ARRAY(Compound) compounds;
    ARRAY(Sphere) spheres;
    SceneShare share; // of the spheres; shape_count and orders are those of the whole
    size_t surveyed;     // of them, the first so many are in the survey; who changes one says scene_spheres_change
    SphereSurvey survey;
    ARRAY(SphereRun) sphere_runs; // in their order; the first begins with the first sphere
    ARRAY(Plane) planes;
    ARRAY(Primitive) primitives;
    NumberPool numbers;        // the lists of primitives
    FormulaHost *formula_host; // of isosurfaces that want one, its own; NULL: none does
    double text_unit;          // a length of 1 of the scene's text, by which isosurfaces measure; not 1 at another scale
    Vec3 text_origin;          // where its origin is, which surfaces without coordinates of their own ask for
    ARRAY(Mesh *) meshes;      // owned; primitives may share one
    size_t mesh_bytes;    // of all of them
    uint32_t plain_mesh_count; // of them, without textures of their own
    ARRAY(MaterialIndex) face_materials;
    ARRAY(Numbers) blobs; // lists that textures are weighed by
    ARRAY(Node) nodes;
    ARRAY(Composite) composites;
    ARRAY(struct Scene *) insides;  // owned; of objects that are patterns: each one composite, its root a union of it
    size_t inside_bytes; // of all of them
    ARRAY(StartShape) start_shapes; // in the order of shapes
    ARRAY(Body) bodies;
    uint32_t inner_body_count; // bodies within composites
    uint32_t shape_count;      // spheres, planes, composites and primitives that stand alone
    UniqueIndex finish_index, material_index, pigment_entry_index, pattern_index, slope_entry_index, normal_entry_index,
        normal_index, texture_entry_index, texture_index, interior_index, compound_index, picture_source_index,
        picture_shade_index, image_map_index, formula_step_index, warp_index;
} Scene;

// An empty scene with the language's defaults. Nothing is allocated.
void scene_init(Scene *scene);
void scene_fini(Scene *scene);

// Bytes that its records and pictures take, records counted as if each list that is full had grown already for one
// more.
size_t scene_bytes(const Scene *scene);
// Of that, what was read of pictures.
size_t scene_picture_bytes(const Scene *scene);

// The index of an equal material, added if there is none; the pigment is rounded to single precision. False when out of
// memory.
bool scene_add_material(Scene *scene, Rgbft pigment, const Finish *finish, MaterialIndex *index) RT_MUST_CHECK;
// Of many that next to never repeat, some are kept more than once.
bool scene_add_material_record(Scene *scene, const Material *material, MaterialIndex *index) RT_MUST_CHECK;
// Whether two materials look alike. Those of what has none may be asked for.
bool scene_materials_are_equal(const Scene *scene, MaterialIndex one, MaterialIndex other);

// The pigment of a material.
static inline Rgbft material_pigment(const Material *material)
{
    return (Rgbft){material->red, material->green, material->blue, material->filter, material->transmit};
}

// The place in the text of a record that keeps its offset alone; SPAN_NONE for one that was not written.
static inline Span scene_source_span(uint64_t source)
{
    return source ? (Span){source, source + 1} : SPAN_NONE;
}

// Whether a shape of this material is hollow.
static inline bool scene_is_hollow(const Scene *scene, MaterialIndex material)
{
    return material & MATERIAL_COMPOUND
               ? scene->compounds.items[material & ~MATERIAL_COMPOUND].is_hollow
               : scene->finishes.items[scene->materials.items[material].finish].flags & FINISH_HOLLOW;
}

// Takes over a scene of one composite, and forgets it where there is an equal one. False when out of memory.
bool scene_add_inside(Scene *scene, Scene *inside, uint32_t *index) RT_MUST_CHECK;

// The same for the parts of textures. Lists are made from their ends.
bool scene_add_finish(Scene *scene, const Finish *finish, FinishIndex *index) RT_MUST_CHECK;
bool scene_add_pigment_entry(Scene *scene, const PigmentEntry *entry, uint32_t *index) RT_MUST_CHECK;
bool scene_add_pattern(Scene *scene, const PatternedPigment *pattern, uint32_t *index) RT_MUST_CHECK;
bool scene_add_formula_step(Scene *scene, const FormulaStep *step, uint32_t *index) RT_MUST_CHECK;
bool scene_add_warp(Scene *scene, const Warp *warp, uint32_t *index) RT_MUST_CHECK;
bool scene_add_picture_shade(Scene *scene, const PictureShade *shade, uint32_t *index) RT_MUST_CHECK;
bool scene_add_image_map(Scene *scene, const ImageMap *map, uint32_t *index) RT_MUST_CHECK;
// A picture that is not loaded yet.
bool scene_add_picture(Scene *scene, const PictureSource *source, Span span, uint32_t *index) RT_MUST_CHECK;
bool scene_add_slope_entry(Scene *scene, const SlopeEntry *entry, uint32_t *index) RT_MUST_CHECK;
bool scene_add_normal_entry(Scene *scene, const NormalEntry *entry, uint32_t *index) RT_MUST_CHECK;
bool scene_add_normal(Scene *scene, const Normal *normal, uint32_t *index) RT_MUST_CHECK;
bool scene_add_texture_entry(Scene *scene, const TextureEntry *entry, uint32_t *index) RT_MUST_CHECK;
bool scene_add_texture(Scene *scene, const Texture *texture, uint32_t *index) RT_MUST_CHECK;
bool scene_add_interior(Scene *scene, const Interior *interior, uint32_t *index) RT_MUST_CHECK;
bool scene_add_compound(Scene *scene, const Compound *compound, MaterialIndex *index) RT_MUST_CHECK;

// A colour that is the same everywhere, and back.
Pigment pigment_of(Rgbft colour);
static inline Rgbft pigment_colour(const Pigment *pigment)
{
    return (Rgbft){pigment->red, pigment->green, pigment->blue, pigment->filter, pigment->transmit};
}

// Each shape once, be it alone or in a composite.
static inline uint64_t scene_shapes_in_all(const Scene *scene)
{
    return (uint64_t)scene->spheres.count + scene->planes.count + scene->primitives.count;
}

// Add a record; `order` and shape_count are set here. False when out of memory.
bool scene_add_light(Scene *scene, const Light *light) RT_MUST_CHECK;
bool scene_add_fog(Scene *scene, const Fog *fog) RT_MUST_CHECK;
bool scene_add_rainbow(Scene *scene, const Rainbow *rainbow) RT_MUST_CHECK;
// Whether light is lost on the way of rays outside of solid shapes.
static inline bool scene_has_haze(const Scene *scene)
{
    return scene->fogs.count > 0 || scene->rainbows.count > 0;
}
bool scene_add_sky_layer(Scene *scene, const Pigment *layer) RT_MUST_CHECK; // below the others
bool scene_add_sphere(Scene *scene, Vec3 centre, double radius, MaterialIndex material, uint64_t source) RT_MUST_CHECK;
// A sphere's place in the order of declaration and where it was written; the one at a place, or RECORD_NONE.
uint32_t scene_sphere_order(const Scene *scene, size_t sphere);
uint64_t scene_sphere_source(const Scene *scene, size_t sphere);
uint32_t scene_sphere_at(const Scene *scene, uint32_t order);
// Many plain spheres at once: they are written behind the list's end, after `scene_reserve_spheres`, until
// scene_commit_spheres says that they are there. Their sources have one upper half, which is that of `source`.
// scene_materials_add_up: it no longer pays to look for equal materials, each that differs from the one before is added.
bool scene_materials_add_up(const Scene *scene);
bool scene_reserve_spheres(Scene *scene, size_t spheres, size_t materials) RT_MUST_CHECK;
void scene_commit_spheres(Scene *scene, size_t spheres, uint64_t source);
// So many materials are there behind the list's end, each unlike the one before, once materials add up.
void scene_commit_materials(Scene *scene, size_t materials);
// So many follow that another process keeps.
bool scene_pass_spheres(Scene *scene, size_t spheres) RT_MUST_CHECK;
// Once all shapes are there: none of another process is.
void scene_end_share(Scene *scene);
// Numbers of some spheres have changed.
void scene_spheres_change(Scene *scene);
// Room for materials of one's own, one after the other, from *first on: they may change later, so no other shape shares
// them, and from now on equal materials are looked for next to each other only. False when out of memory.
bool scene_add_own_materials(Scene *scene, size_t count, MaterialIndex *first) RT_MUST_CHECK;

bool scene_add_plane(Scene *scene, Vec3 unit_normal, double distance, MaterialIndex material,
                     uint64_t source) RT_MUST_CHECK;

// Takes over a mesh, whose number is set.
bool scene_add_mesh(Scene *scene, Mesh *mesh) RT_MUST_CHECK;

// Adds a primitive that stands alone; its list of numbers, if it has one, is copied.
bool scene_add_primitive(Scene *scene, const Primitive *primitive) RT_MUST_CHECK;

// A composite begins, then come its nodes and leaves in their order, each with its parent; scene_end_composite sets
// what is counted. A leaf's `node` and a node's `parent` are indices into Scene.nodes.
bool scene_begin_composite(Scene *scene, uint8_t hidden, uint64_t source) RT_MUST_CHECK;
bool scene_add_node(Scene *scene, NodeOp op, bool is_inverse, uint32_t parent, uint64_t source,
                    uint32_t *index) RT_MUST_CHECK;
// What formulas of shapes ask; NULL when out of memory.
const FormulaHost *scene_formula_host(Scene *scene) RT_MUST_CHECK;
bool scene_add_leaf(Scene *scene, const Primitive *primitive) RT_MUST_CHECK;
void scene_end_composite(Scene *scene);
// Bytes of stack that a ray takes in the largest of them.
size_t scene_composite_stack(const Scene *scene);

// A body within `around` (or RECORD_NONE) begins, then come its shapes and the bodies in it. It must be ended, and is
// forgotten then if it is the last one and not to be kept.
bool scene_begin_body(Scene *scene, uint32_t around, uint32_t *index) RT_MUST_CHECK;
void scene_end_body(Scene *scene, uint32_t index, bool is_kept);

// The innermost body that holds the shape at a place in the order of declaration; RECORD_NONE for none.
uint32_t scene_body(const Scene *scene, uint32_t order);

// A number that is the same for surfaces of one body and no others. `inner` is a leaf's Primitive.body, else 0.
uint64_t scene_body_key(const Scene *scene, uint32_t order, uint32_t inner);

// The same as if each shape were a body, and whether a key is that of a shape, whose order is its lower half.
uint64_t scene_shape_key(uint32_t order, uint32_t inner);
bool scene_shape_is_key(uint64_t key);

// Checks what only the whole scene can tell (a camera is missing, …) and what the renderer relies on. False when a
// fault was reported; the renderer may then not be called. Many spheres are looked through on several threads.
bool scene_validate(const Scene *scene, DiagSink *diags, int threads) RT_MUST_CHECK;

// The same without what only all spheres together can tell.
bool scene_validate_share(const Scene *scene, DiagSink *diags, int threads) RT_MUST_CHECK;

// The same of a scene that was found valid, of which only camera and lights are others now.
bool scene_validate_view(const Scene *scene, DiagSink *diags, int threads) RT_MUST_CHECK;

// The scene as `.scn` text that evaluates to the same records, bit for bit, in the same order.
void scene_dump(const Scene *scene, TextBuffer *out);

#endif
