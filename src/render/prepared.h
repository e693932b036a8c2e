// What a scene is to the kernels: scaled, reduced and constant; private to src/render.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_PREPARED_H
#define RENDER_PREPARED_H

#include <stdbool.h>
#include <stdint.h>

#include "math/colour.h"
#include "math/vec3.h"
#include "render/kernel.h"
#include "render/render.h"
#include "scene/scene.h"
#include "trace/trace.h"

typedef struct PreparedCamera {
    CameraType type;
    Vec3 location, direction, right, up; // orthographic: direction is of unit length
} PreparedCamera;

typedef struct PreparedLight {
    bool parallel, shadowless;
    Vec3 position;
    Vec3 towards; // parallel: unit vector to the light
    Rgb colour;
} PreparedLight;

// A material with everything multiplied out that does not depend on the ray. "Opaque share" is 1 - filter - transmit.
typedef struct PreparedMaterial {
    Rgb glow;         // opaque share × pigment × (ambient × ambient light + emission)
    Rgb diffuse;      // opaque share × pigment × diffuse; black when diffuse is not positive
    Rgb diffuse_back; // the same for light from behind
    Rgb through;      // filter × pigment + transmit: what a ray that goes through is multiplied with
    Rgb pigment;
    double brilliance;
    double phong, phong_size;
    double specular, shininess; // shininess = 1 / roughness
    double metallic;
    Rgb reflection_min, reflection_max;
    double reflection_falloff, reflection_exponent, reflection_metallic;
    double reflection_weight; // the greatest component of both
    bool scatters, scatters_back, shines, reflects, lets_through, conserves_energy;
} PreparedMaterial;

struct Prepared {
    Geometry *geometry;
    PreparedCamera camera;
    Rgb background;
    PreparedLight *lights;
    size_t light_count;
    PreparedMaterial *materials;
    size_t material_count;
    int max_trace_level;
    double adc_bailout;
    uint64_t crossings_max; // no line meets more surfaces
    unsigned features; // TraceFeature and RenderFeature bits that the scene needs
    const Kernel *kernel;
};

#endif
