// What a scene is to the kernels: scaled, reduced and constant; private to src/render and src/forward.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RECORDS_PREPARED_H
#define RENDER_RECORDS_PREPARED_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "math/colour.h"
#include "math/vec3.h"
#include "render/records/kernel.h"
#include "render/records/medium.h"
#include "render/records/options.h"
#include "render/surface/texture.h"
#include "scene/scene.h"
#include "trace/trace.h"

typedef struct PreparedCamera {
    CameraType type, through; // they differ where bumps turn the rays of the second
    const TextureTable *textures; // whose bumps these are
    uint32_t bumps;
    Vec3 location, direction, right, up; // orthographic: direction is of unit length
    // Of wider ones: unit vectors along right, up and direction, the lengths of the first two, angles in radians.
    Vec3 across, upright, ahead;
    double width, height, angle, angle_vertical;
    double lens_radius;                  // 0: a point
    double focal_distance, focal_scale;  // the second: over the length of direction
    Vec3 lens_right, lens_up;            // of length lens_radius
} PreparedCamera;

typedef struct PreparedLight {
    bool parallel, shadowless;
    bool is_plain; // neither of what stands below `colour`
    Vec3 position;
    Vec3 towards; // parallel: unit vector to the light; of a spotlight: against its axis, of unit length
    Rgb colour;
    LightType type;
    double radius, falloff; // of a spotlight: cosines
    double tightness;
    double fade_distance, fade_power; // 0: no fading
    LightArea area;
    double area_radius; // no place of the area is farther from its middle
    uint64_t number; // among the scene's lights, for `jitter`
    uint64_t seed;   // of `jitter`
} PreparedLight;

// A finish with everything computed that does not depend on pigment and ray.
typedef struct PreparedFinish {
    Rgb glow;                     // ambient × ambient light + emission
    double diffuse, diffuse_back; // >= 0
    double brilliance;
    double phong, phong_size;
    double specular, shininess; // shininess = 1 / roughness
    double metallic;
    Rgb reflection_min, reflection_max;
    double reflection_falloff, reflection_exponent, reflection_metallic;
    double reflection_weight; // the greatest component of both
    double refraction;        // share of what is let through that continues
    double crand;             // 0: not
    double irid, irid_thickness, irid_turbulence; // 0: not
    Rgb irid_waves;           // turns of a unit of thickness, in radians
    bool is_special;          // crand or irid: shaded ray by ray
    bool shines, reflects, conserves_energy, is_fresnel;
    bool reflects_evenly; // the same at all angles, and not metallic
} PreparedFinish;

// Distances of points from lights, in sizes of the least shape, up to which a shadow ray's rounded direction does no
// harm: it misses the light by no more than 2^-24 sizes.
#define SHADOW_NEAR 0x1p26

struct Prepared {
    Abandon *abandon; // its own; a copy of this record shares it
    Geometry *geometry;
    bool is_kept; // it lives on
    PreparedCamera camera;
    Rgb background; // with has_alpha as mirrors see it
    bool has_alpha; // pictures tell what is behind the scene (render/sample/alpha.h)
    bool is_old;    // the scene's version is below 3.7
    bool is_by_rays; // for tests: no surface is shaded together with others where a kernel traces ray by ray
    PreparedLight *lights;
    size_t light_count;
    bool has_dome;
    Rgb dome;      // has_dome: of light from all sides (render/shade/dome.h)
    uint64_t seed; // of what is drawn by places: `jitter`, and light from all sides of single rays
    const Material *materials; // the scene's
    const Compound *compounds; // the scene's
    const Interior *interiors; // the scene's
    TextureTable textures;
    PreparedFinish *finishes;
    size_t finish_count;
    const Scene *scene;
    double length;    // of 1 here in the scene, a power of two
    MediumList start; // what the eye is inside of; orthographic: of no use
    int max_trace_level;
    double adc_bailout;
    uint64_t crossings_max; // no line meets more surfaces
    // Beyond this distance from a light, it may be the light that is asked (render/shade/far_light.c).
    double near_light;
    unsigned features; // TraceFeature and RenderFeature bits that the scene needs
    const Kernel *kernel;
    const struct TileLights *tile_lights; // of the geometry's instruction set
    const struct SobolKernel *points;     // likewise
};

// Asked for each ray that continues: one camera ray's tree may take longer than anybody waits.
static inline bool prepared_is_abandoned(const Prepared *p)
{
    return trace_is_abandoned(p->abandon);
}

#endif
