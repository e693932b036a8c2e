// Scene records: the treaty between the language and the renderer. Plain structs, no function pointers, no strings.
//
// The evaluator adds records in order of declaration; the renderer reads them and changes nothing. All transforms are
// applied, all identifiers resolved, all defaults filled in. Lengths are in scene units, angles do not occur, colours
// are in the working space of `assumed_gamma`. Each record keeps where it was written, as a global source offset.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_SCENE_H
#define SCENE_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"
#include "base/diag.h"
#include "base/text.h"
#include "math/colour.h"
#include "math/transform.h"
#include "math/vec3.h"
#include "scene/unique.h"

typedef enum CameraType { CAMERA_PERSPECTIVE, CAMERA_ORTHOGRAPHIC } CameraType;

// A pixel at (u, v), each from -1/2 (left, top) to 1/2 (right, bottom), looks
//   perspective:   from location along direction + u right - v up
//   orthographic:  from location + u right - v up along direction
typedef struct Camera {
    CameraType type;
    Vec3 location, direction, right, up;
    Span span;
} Camera;

typedef enum LightType { LIGHT_POINT, LIGHT_PARALLEL } LightType;

typedef struct Light {
    LightType type;
    bool shadowless;
    Vec3 position;
    Vec3 point_at; // LIGHT_PARALLEL: the light shines along point_at - position
    Rgb colour;
    Span span;
} Light;

enum { FINISH_CONSERVE_ENERGY = 1 }; // what is let through loses what is reflected

// As resolved: no albedo forms are left, and nothing is clamped (negative shares are for the shading to ignore or use).
typedef struct Finish {
    Rgb ambient;       // reflected share of the global ambient light
    Rgb emission;      // light given off
    double diffuse;    // share of light scattered on the lit side
    double diffuse_back; // and through to the other side
    double brilliance; // exponent of the cosine
    double phong, phong_size;
    double specular, roughness;
    double metallic;   // 0: highlights have the light's colour, 1: the pigment's
    Rgb reflection_min, reflection_max; // at normal and at grazing incidence
    double reflection_falloff;          // exponent of the way from min to max, 1 if nothing was said
    double reflection_exponent;         // of the reflected light, 1 if nothing was said
    double reflection_metallic;
    uint64_t flags; // FINISH_CONSERVE_ENERGY
} Finish;

// Index into Scene.finishes.
typedef uint32_t FinishIndex;

// Without padding: materials are compared and hashed bit by bit. A scene may have as many as shapes, so it is small: the
// language's colours are of single precision anyhow, and one finish serves many pigments.
typedef struct Material {
    float red, green, blue, filter, transmit; // the pigment
    FinishIndex finish;
} Material;

// Index into Scene.materials.
typedef uint32_t MaterialIndex;

typedef struct Sphere {
    Vec3 centre;
    double radius; // > 0
    MaterialIndex material;
    uint32_t order; // place in the order of declaration over all shapes
    uint64_t source;
} Sphere;

// The unit sphere at the origin under an affine transform that is not a similarity.
typedef struct Ellipsoid {
    Transform to_world;
    Transform to_object; // its inverse
    MaterialIndex material;
    uint32_t order;
    uint64_t source;
} Ellipsoid;

// All points p with p·normal = distance.
typedef struct Plane {
    Vec3 normal; // unit length
    double distance;
    MaterialIndex material;
    uint32_t order;
    uint64_t source;
} Plane;

// How the values of the picture relate to light, see docs/language.md, "Gamma".
typedef enum GammaModel {
    GAMMA_LINEAR, // the working space is linear light
    GAMMA_POWER,  // linear light = value ^ assumed_gamma
    GAMMA_SRGB,   // linear light = sRGB decoding of value
    GAMMA_NONE,   // an old file that says nothing: values are written as they are
} GammaModel;

typedef struct Settings {
    GammaModel gamma_model;
    double assumed_gamma; // GAMMA_POWER only, else 1
    Rgb ambient_light;
    int max_trace_level; // >= 1
    double adc_bailout;
    double version; // the language version in force at the end, 3.7 if none was given
} Settings;

typedef struct Scene {
    Span whole; // the text it was made from, for messages about the scene as a whole
    Settings settings;
    Rgbft background;
    bool has_camera; // the scene said so; else camera is the language's default
    Camera camera;
    ARRAY(Light) lights;
    ARRAY(Finish) finishes;    // each different one once
    ARRAY(Material) materials; // each different one once
    ARRAY(Sphere) spheres;
    ARRAY(Ellipsoid) ellipsoids;
    ARRAY(Plane) planes;
    uint32_t shape_count;                 // spheres, ellipsoids and planes
    UniqueIndex finish_index, material_index;
} Scene;

// An empty scene with the language's defaults. Nothing is allocated.
void scene_init(Scene *scene);
void scene_fini(Scene *scene);

// The index of an equal material, added if there is none; the pigment is rounded to single precision. False when out of
// memory.
bool scene_add_material(Scene *scene, Rgbft pigment, const Finish *finish, MaterialIndex *index) RT_MUST_CHECK;

// The pigment of a material.
Rgbft material_pigment(const Material *material);

// Add a record; `order` and shape_count are set here. False when out of memory.
bool scene_add_light(Scene *scene, const Light *light) RT_MUST_CHECK;
bool scene_add_sphere(Scene *scene, Vec3 centre, double radius, MaterialIndex material, uint64_t source) RT_MUST_CHECK;
bool scene_add_ellipsoid(Scene *scene, const Transform *to_world, const Transform *to_object, MaterialIndex material,
                         uint64_t source) RT_MUST_CHECK;
bool scene_add_plane(Scene *scene, Vec3 unit_normal, double distance, MaterialIndex material,
                     uint64_t source) RT_MUST_CHECK;

// Checks what only the whole scene can tell (a camera is missing, …) and what the renderer relies on. False when a
// fault was reported; the renderer may then not be called.
bool scene_validate(const Scene *scene, DiagSink *diags) RT_MUST_CHECK;

// The scene as `.scn` text that evaluates to the same records, bit for bit, in the same order.
void scene_dump(const Scene *scene, TextBuffer *out);

#endif
