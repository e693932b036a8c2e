// The life of one camera ray, step by step, for people who want to see how a pixel comes about.
//
// Follows the very functions of the kernels with all features on (render/shade/shade.h), so that its colour is the
// picture's, and keeps what each step found. Lengths are the scene's own. Has no part in rendering a picture.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_INSPECT_RAY_LOG_H
#define RENDER_INSPECT_RAY_LOG_H

#include "base/array.h"
#include "math/colour.h"
#include "math/ray.h"
#include "render/records/film.h"
#include "render/records/options.h"

// Where a ray comes from.
typedef enum LoggedKind {
    LOGGED_CAMERA,
    LOGGED_MIRRORED,
    LOGGED_TOTAL,   // mirrored because nothing gets through
    LOGGED_THROUGH, // goes straight on
    LOGGED_BENT,
} LoggedKind;

// Which root of the quadratic is a sphere's, and why.
typedef enum LoggedRoot {
    LOGGED_MISSES,       // h < 0: there is none
    LOGGED_BEHIND,       // both are at t < 0
    LOGGED_NEAR,         // the first: the ray comes from outside
    LOGGED_FAR,          // the second: the ray starts inside, so that the first is behind it
    LOGGED_LEFT,         // none: the ray leaves this sphere outward, and a sphere is convex
    LOGGED_GOES_THROUGH, // the one that is not 0: the ray starts on this sphere and goes in
    LOGGED_CUT,          // both: it is a part of a composite, of which the first crossing that shows is seen
} LoggedRoot;

// A sphere that the ray was tested against: a t² + b t + c = 0 with a = d·d, b = 2 d·(e - centre),
// c = (e - centre)·(e - centre) - radius², and h = b² - 4 a c, all as plain double arithmetic gives them. Of a
// stretched sphere e and d are the ray in the space in which it has its centre at 0 and the radius 1; t is the same
// there.
typedef struct LoggedSphere {
    uint64_t source;
    bool is_stretched;
    Vec3 own_origin, own_direction; // is_stretched: e and d in its own space
    Vec3 centre;
    double radius;
    double a, b, c, h;
    double t1, t2;     // roots as the textbook gives them; h >= 0
    LoggedRoot choice; // by the certified test
    bool is_uncertain; // rounding could have decided, so double words did
    bool is_misjudged; // the textbook would choose otherwise
    double t;          // the root that is used, refined; 0: none
    double bound;      // |error of t| is below
} LoggedSphere;

// What one light does to one layer of a surface.
typedef struct LoggedLight {
    size_t number; // of the scene's lights
    Vec3 position;
    double distance, cosine; // to it; of the angle between its direction and the normal
    Rgb sends;               // its colour at that distance and angle, were nothing in its way
    Rgb visible;             // the share that arrives, by colour; white where the light throws no shadow
    Rgb diffuse, highlights; // what the surface makes of it
    Rgb adds;                // both
} LoggedLight;

// One of the materials that are seen at a hit: one, but for layers and maps.
typedef struct LoggedLayer {
    Rgbft pigment;
    double part; // of the texture in a map
    Rgb above;   // what the layers above let through
    Vec3 normal; // with the layer's bumps
    Rgb glow;    // ambient and emission
    Rgb dome;    // what light from all sides adds
    size_t first_light, light_count;
} LoggedLayer;

enum { LOGGED_NONE = -1 };

typedef struct LoggedRay {
    int parent; // number of the ray that it comes from; LOGGED_NONE: the camera's
    LoggedKind kind;
    int level;
    Vec3 origin, direction;
    Rgb share;                         // what its light is multiplied with
    double weight;                     // what decides whether it is traced
    size_t first_sphere, sphere_count; // those listed
    size_t missed;                     // spheres that it misses and that are not listed
    bool is_hit;
    const char *shape; // word for what is hit
    uint64_t source;   // of the shape
    double t, bound;
    bool is_inside;     // the shape was met from its inside
    Vec3 point, normal; // the normal is turned to where the ray comes from
    double ior_ratio;   // index of refraction behind the surface over the one before it
    size_t first_layer, layer_count;
    Rgb through, reflectance;
    Rgb light; // that of the hit, or of the background
    Rgb adds;  // share × light
    Rgb fog;   // what fog on its way adds beside that
} LoggedRay;

typedef struct RayLog {
    Vec3 eye, screen; // the camera's ray goes from the one through the other
    ARRAY(LoggedRay) rays;
    ARRAY(LoggedSphere) spheres;
    ARRAY(LoggedLayer) layers;
    ARRAY(LoggedLight) lights;
    size_t more_rays; // not listed
    Rgb colour;       // of the pixel, in the scene's working space
} RayLog;

// Follows the ray of the middle of a pixel of a picture of that size. False when out of memory; ray_log_fini is to be
// called anyway.
bool ray_log_trace(RayLog *ray_log, const Prepared *prepared, int width, int height, int x, int y) RT_MUST_CHECK;
void ray_log_fini(RayLog *ray_log);

#endif
