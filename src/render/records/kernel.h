// Kernels: the inner loop, instantiated for sets of features; the smallest that covers a scene traces it.
//
// A feature that a scene lacks is not tested for at run time, it is not there: the loop is one always-inline function
// that takes its features as a constant (render/shade/shade.h).
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_KERNEL_H
#define RENDER_RECORDS_KERNEL_H

#include "math/vec3.h"
#include "render/points/sampler.h"
#include "render/records/options.h"
#include "trace/trace.h"

// Beside the TraceFeature bits, which stand below.
typedef enum RenderFeature {
    RENDER_SHADOWS = 1 << 8,       // some light casts shadows
    RENDER_HIGHLIGHTS = 1 << 9,    // phong or specular
    RENDER_BRILLIANCE = 1 << 10,   // brilliance other than 1, or light from behind
    RENDER_REFLECTION = 1 << 11,
    RENDER_TRANSPARENCY = 1 << 12, // filter or transmit, in shadows too
    RENDER_EXPONENT = 1 << 13,     // reflected light raised to a power
    RENDER_TEXTURES = 1 << 14,     // layers, patterns of textures, what lets light through; asks for RENDER_PIGMENTS
    RENDER_INTERIORS = 1 << 15,    // refraction, fading, Fresnel's mirror
    RENDER_LIGHTS = 1 << 16,       // lights of one place, direction or distance: spotlight, fading, area
    RENDER_SKY = 1 << 17,          // layers before the background
    RENDER_FOG = 1 << 18,          // asks for RENDER_INTERIORS too: there is none inside of what is not hollow
    RENDER_NORMALS = 1 << 19,      // bumps
    RENDER_PIGMENTS = 1 << 20,     // patterns
    RENDER_ALL_FEATURES = 0x1fff << 8,
} RenderFeature;

// Pixels left <= x < right, top <= y < bottom.
typedef struct Tile {
    int left, top, right, bottom;
} Tile;

enum { KERNEL_RAYS = 64, KERNEL_ROW = 8 }; // fastest for eight neighbours a row

// Where the camera rays of one call go through the picture, as camera_ray wants to know it.
typedef struct KernelPlaces {
    _Alignas(64) double u[KERNEL_RAYS];
    double v[KERNEL_RAYS];
    const Vec3 *lens; // where they start, KERNEL_RAYS of them; NULL: at the camera's location
} KernelPlaces;

// What a thread works in (render/sample/scratch.h).
typedef struct RenderScratch RenderScratch;

// KERNEL_RAYS camera rays, of which those are wanted whose bit is set; the others have places, too.
typedef struct KernelCall {
    const KernelPlaces *places;
    uint64_t wanted;
    SampleStream *streams; // what each draws numbers from; NULL: then area lights are the scene's grids
    Rgb *light;            // of each ray that is wanted
    RenderScratch *scratch;
    RenderStatistics *statistics; // counts are added
} KernelCall;

typedef struct Kernel {
    const char *name;
    unsigned features;
    void (*trace)(const Prepared *prepared, const KernelCall *call);
} Kernel;

#endif
