// Scene records of how surfaces look and what is within: finishes, pigments, normals, textures, interiors.
//
// A record of a list says which one is next by its index, RECORD_NONE after the last.
//
// SPDX-License-Identifier: MIT
#ifndef SCENE_MATERIAL_H
#define SCENE_MATERIAL_H

#include <stdint.h>

#include "math/colour.h"
#include "math/transform.h"
#include "scene/pattern.h"

enum {
    FINISH_CONSERVE_ENERGY = 1, // what is let through loses what is reflected
    FINISH_FRESNEL = 2,         // the way from reflection_min to reflection_max is that of the interior's surface
    FINISH_HOLLOW = 4,          // of a plain material: the shape is hollow, see Compound
};

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
    double refraction; // share of what is let through that continues, 1 if nothing was said
    double crand;      // how far the light of a surface is less by chance, from place to place; <= 0: not
    double irid, irid_thickness, irid_turbulence; // how much colours of a thin layer count, <= 0: not at all
    uint64_t flags;    // FINISH_…
} Finish;

// Index into Scene.finishes.
typedef uint32_t FinishIndex;

// Without padding: materials are compared and hashed bit by bit. A scene may have as many as shapes, so it is small:
// the language's colours are of single precision anyhow, and one finish serves many pigments.
typedef struct Material {
    float red, green, blue, filter, transmit; // the pigment
    FinishIndex finish;
} Material;

enum { RECORD_NONE = UINT32_MAX }; // an index that stands for nothing

// The colour at each point of a surface: one of Scene.patterns, or the same everywhere.
typedef struct Pigment {
    float red, green, blue, filter, transmit; // pattern == RECORD_NONE
    uint32_t pattern;
} Pigment;

// What lies along a pattern, as a list that ends with RECORD_NONE: colours or pigments, each with the value at which it
// is seen alone, rising from 0 to 1; for blocks, one for each kind of block.
typedef struct PigmentEntry {
    double at;
    Pigment pigment;
    uint32_t next, unused;
} PigmentEntry;

typedef struct PatternedPigment {
    Transform to_world; // from the pattern's space; of an entry: to the space of the pattern it lies along
    Pattern pattern;
    uint32_t entries; // the first of Scene.pigment_entries
    uint32_t unused;
} PatternedPigment;

enum {
    NORMAL_KEEPS_LENGTH = 1, // the depth of the bumps is not scaled along: no normal is made of length 1 on the way
    NORMAL_IS_TURNED = 2,    // the only entry lies on a surface, and this turns it in space
};

// Bumps: what turns a surface's normal from place to place. Alone, amount × the pattern's height; or what other normals
// in the pattern's space make of it.
typedef struct Normal {
    Transform to_world; // from the pattern's space; of an entry: to the space of the pattern it lies along
    Pattern pattern;
    double amount;
    double accuracy;  // > 0: how far from the point the height is evaluated
    uint32_t slopes;  // the first of Scene.slope_entries, or RECORD_NONE: the pattern's value is the height
    uint32_t entries; // the first of Scene.normal_entries, or RECORD_NONE
    uint32_t flags;   // NORMAL_...
    uint32_t unused;
} Normal;

// Layers with bumps or exponents that may mirror or bend rays at one point of a texture.
enum { SCENE_NORMALS_MOST = 7 };

// Patterns that one point of a texture may take: between two entries of a map both are looked at, so that maps of maps
// double them. A thousandth of a second a point; no scene that was seen takes a hundred.
enum { SCENE_PATTERNS_MOST = 10000 };

// Heights and slopes along a pattern, as a list that ends with RECORD_NONE.
typedef struct SlopeEntry {
    double at, height, slope;
    uint32_t next, unused;
} SlopeEntry;

// Normals along a pattern; of PATTERN_AVERAGE each with its weight.
typedef struct NormalEntry {
    double at;
    uint32_t normal, next;
} NormalEntry;

// A texture: a pigment and a finish over what lies below, or textures by a pattern.
typedef struct Texture {
    Pigment pigment;
    FinishIndex finish;
    uint32_t below;     // Scene.textures, seen where this one lets light through
    Transform to_world; // of the pattern
    Pattern pattern;    // PATTERN_NONE: pigment and finish
    uint32_t entries;   // the first of Scene.texture_entries
    uint32_t normal;    // Scene.normals, or RECORD_NONE
} Texture;

typedef struct TextureEntry {
    double at;
    uint32_t texture, next;
} TextureEntry;

// What a shape is filled with.
typedef struct Interior {
    double ior;           // index of refraction, 1 for none
    double fade_distance; // light is halved on this way; 0: none is lost
    double fade_power;    // 1 / (1 + (way / distance)^power), from 1000 on exp(-way / distance)
    Rgb fade_colour;      // what is left in the end
    double caustics;      // exponent of the light that is gathered behind a surface, see docs/language.md; 0: none is
} Interior;

// Index into Scene.materials, or into Scene.compounds when MATERIAL_COMPOUND is set.
typedef uint32_t MaterialIndex;

// What is more than a plain material.
typedef struct Compound {
    uint32_t texture;   // Scene.textures
    uint32_t interior;  // Scene.interiors, or RECORD_NONE
    uint32_t is_hollow; // fog continues inside of it
    MaterialIndex inner; // what it looks like where a ray meets it from inside: of the same interior; or RECORD_NONE
    uint32_t light_group; // 1 + one of Scene.light_groups, whose lights it is lit by; 0: by those of none
    uint32_t is_double;   // lights on its far side light it as those on its near side do
} Compound;

#define MATERIAL_COMPOUND (UINT32_C(1) << 31)

#endif
