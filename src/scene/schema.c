// The schema's tables.
//
// Turns nothing into anything by itself: constant data that the evaluator walks. Knows nothing of tokens or values.
// Long, since it is one table: a row a word, and what rows share (transforms, patterns, modifiers) is static here.
//
// SPDX-License-Identifier: MIT
#include "scene/schema.h"

#include <math.h>

#include "base/attributes.h"
#include "scene/description.h"

#define AT(type, field) .at = (uint16_t)offsetof(type, field)
#define GIVEN(type, field) .given = (uint16_t)offsetof(type, field)
#define LIST(array) {array, RT_COUNT_OF(array)}
#define POSITIVE {RANGE_FAULT, true, 0.0, INFINITY}

#define IDENTITY {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}}
#define OBJECT_PART {.transform = IDENTITY}
// Colours are kept in single precision.
#define GREY(level) {(double)(level), (double)(level), (double)(level)}

// ---- shared groups

static const SchemaProperty transforms[] = {
    {"translate", TYPE_ACTION, ACTION_TRANSLATE, .doc = "moves by a vector"},
    {"rotate", TYPE_ACTION, ACTION_ROTATE, .doc = "turns about x, then y, then z, by a vector of degrees, left-handed"},
    {"scale", TYPE_ACTION, ACTION_SCALE, .doc = "stretches by a vector; a component of 0 is reported and taken as 1"},
    {"matrix", TYPE_ACTION, ACTION_MATRIX, .doc = "`<…>` of twelve numbers: the images of x, y, z and of the origin"},
    {"transform", TYPE_ACTION, ACTION_TRANSFORM, .doc = "`{ transforms }`, or the name of a declared transform"},
};

#define PATTERN_AT(field) .at = (uint16_t)offsetof(PatternPart, pattern.field)

static const SchemaProperty pattern_modifiers[] = {
    {"checker", TYPE_ACTION, ACTION_PATTERN, .doc = "unit cubes of two kinds"},
    {"image_pattern", TYPE_BLOCK, ACTION_PICTURE, .doc = "how bright a picture is"},
    {"hexagon", TYPE_ACTION, ACTION_PATTERN, .doc = "six-sided prisms of three kinds along y, each side of length 1"},
    {"brick", TYPE_ACTION, ACTION_PATTERN, .doc = "mortar and bricks in courses along y"},
    {"gradient", TYPE_ACTION, ACTION_PATTERN, .doc = "from 0 to 1 along a vector, again and again"},
    {"radial", TYPE_ACTION, ACTION_PATTERN, .doc = "once around the y axis, from +x by -z"},
    {"onion", TYPE_ACTION, ACTION_PATTERN, .doc = "shells of thickness 1 around the origin"},
    {"leopard", TYPE_ACTION, ACTION_PATTERN, .doc = "spots from sines of x, y and z"},
    {"spherical", TYPE_ACTION, ACTION_PATTERN, .doc = "1 at the origin, 0 at distance 1 and beyond"},
    {"planar", TYPE_ACTION, ACTION_PATTERN, .doc = "1 at y = 0, 0 at distance 1 and beyond"},
    {"boxed", TYPE_ACTION, ACTION_PATTERN, .doc = "1 at the origin, 0 on the cube from <-1, -1, -1> to <1, 1, 1>"},
    {"cylindrical", TYPE_ACTION, ACTION_PATTERN, .doc = "1 on the y axis, 0 at distance 1 and beyond"},
    {"bozo", TYPE_ACTION, ACTION_PATTERN, .doc = "noise"},
    {"bumps", TYPE_ACTION, ACTION_PATTERN, .doc = "the same noise"},
    {"spotted", TYPE_ACTION, ACTION_PATTERN, .doc = "the same noise"},
    {"granite", TYPE_ACTION, ACTION_PATTERN, .doc = "six octaves of noise, each folded at its middle"},
    {"agate", TYPE_ACTION, ACTION_PATTERN, .doc = "bands along z, made uneven by noise of its own"},
    {"marble", TYPE_ACTION, ACTION_PATTERN, .doc = "bands along x, made uneven by `turbulence`"},
    {"wood", TYPE_ACTION, ACTION_PATTERN, .doc = "rings around z, made uneven by `turbulence`"},
    {"wrinkles", TYPE_ACTION, ACTION_PATTERN, .doc = "ten octaves of noise"},
    {"dents", TYPE_ACTION, ACTION_PATTERN, .doc = "the cube of noise"},
    {"ripples", TYPE_ACTION, ACTION_PATTERN, .doc = "waves from `number_of_waves` points near the origin"},
    {"waves", TYPE_ACTION, ACTION_PATTERN, .doc = "the same, each of another length"},
    {"cells", TYPE_ACTION, ACTION_PATTERN, .doc = "unit cubes, each with a value of its own"},
    {"crackle", TYPE_ACTION, ACTION_PATTERN, .doc = "cells around one point in each unit cube"},
    {"spiral1", TYPE_ACTION, ACTION_PATTERN, .doc = "so many arms that wind around z"},
    {"spiral2", TYPE_ACTION, ACTION_PATTERN, .doc = "so many arms that wind around z, to both sides"},
    {"function", TYPE_ACTION, ACTION_FUNCTION, .doc = "`{ … }` of x, y and z: what it gives there"},
    {"pigment_pattern", TYPE_BLOCK, ACTION_PATTERN, .doc = "`{ pigment }`: how bright its colour is"},
    {"object", TYPE_BLOCK, ACTION_INSIDE,
     .doc = "`{ object }`, with two kinds behind the object: of what is outside of it, and of what is inside"},
    {"slope", TYPE_ACTION, ACTION_SLOPE,
     .doc = "a direction, or `{ … }`: from 0, where the surface faces away from it, to 1"},
    {"aoi", TYPE_ACTION, ACTION_PATTERN,
     .doc = "from 0.5, where the ray grazes the surface, to 1, where it is upright"},
    {"warp", TYPE_BLOCK, ACTION_WARP, .doc = "`{ … }`: bends space, as transforms do in the order in which they stand"},
    {"mandel", TYPE_ACTION, ACTION_PATTERN, .doc = "the Mandelbrot set in x and y, after so many steps"},
    {"julia", TYPE_ACTION, ACTION_PATTERN, .doc = "the Julia set of a complex number, after so many steps"},
    {"magnet", TYPE_ACTION, ACTION_FRACTAL, .doc = "1 or 2, then `mandel` or `julia`: of another step"},
    {"exponent", TYPE_INTEGER, PATTERN_AT(power), .range = {RANGE_FAULT, false, 2.0, 33.0},
     .doc = "of `mandel` and `julia`: the power of z in each step, 2 unless said"},
    {"exterior", TYPE_ACTION, ACTION_FRACTAL,
     .doc = "of these: 0 to 6, what is returned for points that leave, and times what"},
    {"interior", TYPE_ACTION, ACTION_FRACTAL, .doc = "of these: the same of points that stay"},
    {"quilted", TYPE_ACTION, ACTION_PATTERN, .doc = "a cushion in each unit cube"},
    {"control0", TYPE_NUMBER, PATTERN_AT(vector.x), .doc = "of `quilted`: how steep in the middle; 1 unless said"},
    {"control1", TYPE_NUMBER, PATTERN_AT(vector.y), .doc = "of `quilted`: how steep at the seams; 1 unless said"},
    {"form", TYPE_VECTOR, PATTERN_AT(form),
     .doc = "of `crackle`: what the distances to the nearest three points count"},
    {"metric", TYPE_NUMBER, PATTERN_AT(metric), .range = {RANGE_FAULT, true, 0.0, INFINITY},
     .doc = "of `crackle`: exponent of the distance"},
    {"offset", TYPE_NUMBER, PATTERN_AT(offset), .doc = "of `crackle`: distance from space in a fourth dimension"},
    {"solid", TYPE_ACTION, ACTION_PATTERN_SOLID, .doc = "of `crackle`: each cell has one value"},
    {"turbulence", TYPE_VECTOR, PATTERN_AT(turbulence), .doc = "moves each point by noise, so much in x, y and z"},
    {"octaves", TYPE_INTEGER, PATTERN_AT(octaves), .range = {RANGE_CLAMP, false, 1.0, 10.0},
     .doc = "of turbulence: noises added up"},
    {"lambda", TYPE_NUMBER, PATTERN_AT(lambda), .doc = "of turbulence: how much finer each octave is"},
    {"omega", TYPE_NUMBER, PATTERN_AT(omega), .doc = "of turbulence: how much weaker each octave is"},
    {"agate_turb", TYPE_NUMBER, PATTERN_AT(agate_turb), .doc = "of `agate`: how uneven its bands are"},
    {"noise_generator", TYPE_INTEGER, PATTERN_AT(generator), .range = {RANGE_FAULT, false, 0.0, 3.0},
     .doc = "1, 2 or 3; 0 is that of the scene"},
    {"frequency", TYPE_NUMBER, PATTERN_AT(frequency), .doc = "how often the map is run through"},
    {"phase", TYPE_NUMBER, PATTERN_AT(phase), .doc = "where in the map it begins"},
    {"ramp_wave", TYPE_ACTION, ACTION_WAVE, .doc = "rises evenly, then starts again"},
    {"triangle_wave", TYPE_ACTION, ACTION_WAVE, .doc = "rises and falls evenly"},
    {"sine_wave", TYPE_ACTION, ACTION_WAVE, .doc = "rises and falls as a sine does"},
    {"scallop_wave", TYPE_ACTION, ACTION_WAVE, .doc = "the size of a sine"},
    {"cubic_wave", TYPE_ACTION, ACTION_WAVE, .doc = "rises and falls as a cubic does"},
    {"poly_wave", TYPE_ACTION, ACTION_WAVE, PATTERN_AT(exponent), .doc = "a power; its exponent may follow"},
    {"brick_size", TYPE_VECTOR, PATTERN_AT(vector), .doc = "of `brick`, with the mortar"},
    {"mortar", TYPE_NUMBER, PATTERN_AT(mortar), .doc = "of `brick`: its width"},
};

static const SchemaProperty object_modifiers[] = {
    {"texture", TYPE_BLOCK, ACTION_TEXTURE, .doc = "the surface; a second one is laid over the first"},
    {"interior_texture", TYPE_BLOCK, ACTION_INNER_TEXTURE,
     .doc = "the surface as it is seen from inside; a second one is laid over the first"},
    {"pigment", TYPE_BLOCK, ACTION_PIGMENT, .doc = "the texture's pigment"},
    {"normal", TYPE_BLOCK, ACTION_NORMAL, .doc = "the texture's bumps"},
    {"finish", TYPE_BLOCK, ACTION_FINISH, .doc = "the texture's finish; what is not said stays as it was"},
    {"uv_mapping", TYPE_ACTION, ACTION_SURFACE,
     .doc = "alone: the texture, which follows, is laid out by the shape's surface coordinates"},
    {"interior", TYPE_BLOCK, ACTION_INTERIOR, .doc = "what it is filled with"},
    {"material", TYPE_BLOCK, ACTION_MATERIAL, .doc = "a texture and an interior"},
    {"clipped_by", TYPE_BLOCK, ACTION_CLIP, .doc = "`{ objects }`: only what is inside of all of them is seen"},
    {"bounded_by", TYPE_BLOCK, ACTION_CLIP,
     .doc = "`{ objects }`: of groups, polynomials, text and members: only rays that meet each of them see it"},
    {"inverse", TYPE_ACTION, ACTION_INVERSE, .doc = "alone: inside and outside change places"},
    {"no_shadow", TYPE_FLAG, AT(ObjectPart, no_shadow), .doc = "takes no light from others"},
    {"no_image", TYPE_FLAG, AT(ObjectPart, no_image), .doc = "is not seen by the camera, nor through others"},
    {"no_reflection", TYPE_FLAG, AT(ObjectPart, no_reflection), .doc = "is not seen in mirrors"},
    {"hollow", TYPE_SWITCH, AT(ObjectPart, hollow), .doc = "what is inside of it is not free of fog"},
    {"double_illuminate", TYPE_SWITCH, AT(ObjectPart, is_double), GIVEN(ObjectPart, says_double),
     .doc = "lights on the far side light it as those on the near side do; that of a union counts"},
    {"no_radiosity", TYPE_FLAG, AT(ObjectPart, ignored), .doc = "accepted; changes no picture"},
};

// ---- kinds

static const SchemaProperty camera_properties[] = {
    {"perspective", TYPE_FLAG, AT(CameraDesc, types[CAMERA_PERSPECTIVE]), .is_first = true, .doc = "the default type"},
    {"orthographic", TYPE_FLAG, AT(CameraDesc, types[CAMERA_ORTHOGRAPHIC]), .is_first = true,
     .doc = "all rays are parallel"},
    {"fisheye", TYPE_FLAG, AT(CameraDesc, types[CAMERA_FISHEYE]), .is_first = true,
     .doc = "a disc of directions, `angle` across, 90; black outside of it"},
    {"ultra_wide_angle", TYPE_FLAG, AT(CameraDesc, types[CAMERA_ULTRA_WIDE_ANGLE]), .is_first = true,
     .doc = "angles grow evenly from the middle, to `angle` across, 90"},
    {"panoramic", TYPE_FLAG, AT(CameraDesc, types[CAMERA_PANORAMIC]), .is_first = true,
     .doc = "half a turn from left to right; heights as on a cylinder"},
    {"spherical", TYPE_FLAG, AT(CameraDesc, types[CAMERA_SPHERICAL]), .is_first = true,
     .doc = "longitude, latitude; `angle` across, then upright: 360 and half of it"},
    {"omnimax", TYPE_FLAG, AT(CameraDesc, types[CAMERA_OMNIMAX]), .is_first = true,
     .doc = "of a dome: half a turn across, cut below; black outside of it"},
    {"cylinder", TYPE_ACTION, ACTION_CYLINDER, .is_first = true,
     .doc = "1, 3: an upright one; 2, 4: a lying one; `angle` around, 90"},
    {"normal", TYPE_BLOCK, ACTION_CAMERA_NORMAL,
     .doc = "bumps that turn rays; the picture's corners are <-0.5, -0.5, 0> and <0.5, 0.5, 0>"},
    {"location", TYPE_VECTOR, AT(CameraDesc, location), .doc = "where the eye is"},
    {"direction", TYPE_VECTOR, AT(CameraDesc, direction), .doc = "from the eye to the middle of the picture"},
    {"right", TYPE_VECTOR, AT(CameraDesc, right), GIVEN(CameraDesc, has_right),
     .doc = "the width of the picture at the distance of `direction`"},
    {"up", TYPE_VECTOR, AT(CameraDesc, up), GIVEN(CameraDesc, has_up), .doc = "the height likewise"},
    {"sky", TYPE_VECTOR, AT(CameraDesc, sky), .doc = "what `look_at` turns upward"},
    {"look_at", TYPE_ACTION, ACTION_LOOK_AT, AT(CameraDesc, look_at), GIVEN(CameraDesc, has_look_at),
     .doc = "a vector: the middle of the picture; `direction`, `right` and `up` keep their lengths"},
    {"angle", TYPE_ACTION, ACTION_ANGLE, AT(CameraDesc, angle_deg), GIVEN(CameraDesc, has_angle),
     .doc = "degrees from left to right; of a perspective camera 0 to 180: then it sets `direction`"},
    {"aperture", TYPE_NUMBER, AT(CameraDesc, aperture), .doc = "of the lens: four times its radius; 0 is a point"},
    {"blur_samples", TYPE_ACTION, ACTION_BLUR_SAMPLES,
     .doc = "`[least,] most`: rays a pixel through the lens; `--samples` wins; 0: no blur"},
    {"focal_point", TYPE_VECTOR, AT(CameraDesc, focal_point), GIVEN(CameraDesc, has_focal_point),
     .doc = "a point as far from the location as what is sharp; without it that is 1 away"},
    {"variance", TYPE_NUMBER, AT(CameraDesc, variance), .range = {RANGE_CLAMP, false, 0.0, 1.0},
     .doc = "enough rays where off by less than its root"},
    {"confidence", TYPE_NUMBER, AT(CameraDesc, confidence), .range = {RANGE_CLAMP, true, 0.0, 0.999999},
     .doc = "how sure that is"},
};

static const CameraDesc camera_defaults = {
    .transform = IDENTITY,
    .direction = {0, 0, 1},
    .right = {1.33, 0, 0},
    .up = {0, 1, 0},
    .sky = {0, 1, 0},
    .look_at = {0, 0, 1},
    .confidence = 0.9, // as POV-Ray 3.7 has it: `confidence 0.9 variance 1/10000` changes no ray of its own
    .variance = 1e-4,
};

static const SchemaProperty light_arguments[] = {
    {"position", TYPE_VECTOR, AT(LightDesc, position), .doc = "where the light is"},
    {"colour", TYPE_RGB, AT(LightDesc, colour), .is_optional = true, .doc = "its light, black if left out"},
};

static const SchemaProperty light_properties[] = {
    {"parallel", TYPE_FLAG, AT(LightDesc, parallel), .doc = "all its rays have the direction to `point_at`"},
    {"spotlight", TYPE_ACTION, ACTION_LIGHT_TYPE, .doc = "a cone of light"},
    {"cylinder", TYPE_ACTION, ACTION_LIGHT_TYPE, .doc = "a cylinder of light; all its rays have one direction"},
    {"point_at", TYPE_ACTION, ACTION_POINT_AT, AT(LightDesc, point_at),
     .doc = "where a `parallel` light, a `spotlight` or a `cylinder` shines"},
    {"radius", TYPE_ACTION, ACTION_CONE, AT(LightDesc, radius),
     .doc = "of full light: of a `spotlight` half an angle, 30; of a `cylinder` a length, 0.75"},
    {"falloff", TYPE_ACTION, ACTION_CONE, AT(LightDesc, falloff), .doc = "of any light, likewise: 45 and 1"},
    {"tightness", TYPE_ACTION, ACTION_CONE, AT(LightDesc, tightness),
     .doc = "how the light falls from the axis on: 0 not at all"},
    {"fade_distance", TYPE_NUMBER, AT(LightDesc, fade_distance), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "of its own colour; nearer it is brighter; 0: no fading"},
    {"fade_power", TYPE_NUMBER, AT(LightDesc, fade_power), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "the light falls with this power of the distance; 0: not"},
    {"area_light", TYPE_ACTION, ACTION_AREA_LIGHT,
     .doc = "two vectors, two numbers: so many rows of so many lights, for soft shadows"},
    {"circular", TYPE_FLAG, AT(LightDesc, area.circular), .doc = "the lights of `area_light` lie in a disc"},
    {"orient", TYPE_FLAG, AT(LightDesc, area.is_oriented),
     .doc = "the disc of a `circular` light faces each point that it lights; axes give lengths"},
    {"area_illumination", TYPE_SWITCH, AT(LightDesc, lights_by_area), .doc = "off; on only without `area_light`"},
    {"jitter", TYPE_FLAG, AT(LightDesc, area.jitter), .doc = "each of them is moved at random"},
    {"adaptive", TYPE_INTEGER, AT(LightDesc, area.adaptive), GIVEN(LightDesc, area.is_adaptive),
     .range = {RANGE_FAULT, false, 0.0, 20.0}, .doc = "halvings after which equal corners give what is between"},
    {"looks_like", TYPE_BLOCK, ACTION_LOOKS_LIKE,
     .doc = "an object seen in the light's place, without a shadow; moved by what stands before it"},
    {"media_interaction", TYPE_SWITCH, AT(LightDesc, is_ignored), .doc = "accepted; changes no picture"},
    {"media_attenuation", TYPE_SWITCH, AT(LightDesc, is_attenuated), .doc = "not in fog; changes no picture elsewhere"},
    {"shadowless", TYPE_ACTION, ACTION_SHADOWLESS,
     .doc = "no shadows, no highlights; takes back `spotlight` and `cylinder`, and they it"},
};

static const LightDesc light_defaults = {.part = OBJECT_PART, .point_at = {0, 0, 1}, .look_transform = IDENTITY};

static const SchemaProperty sphere_arguments[] = {
    {"centre", TYPE_VECTOR, AT(SphereDesc, centre), .doc = "its middle"},
    {"radius", TYPE_NUMBER, AT(SphereDesc, radius),
     .doc = "0: not drawn; below 0: only where it is stretched or cut with others"},
};

static const SphereDesc sphere_defaults = {.part = OBJECT_PART, .radius = 1.0};

static const SchemaProperty plane_arguments[] = {
    {"normal", TYPE_VECTOR, AT(PlaneDesc, normal), .doc = "at right angles to it; any length but 0"},
    {"distance", TYPE_NUMBER, AT(PlaneDesc, distance), .doc = "from the origin along the normal"},
};

static const PlaneDesc plane_defaults = {.part = OBJECT_PART, .normal = {0, 1, 0}};

static const SchemaProperty box_arguments[] = {
    {"corner", TYPE_VECTOR, AT(BoxDesc, corner), .doc = "one of its corners"},
    {"other corner", TYPE_VECTOR, AT(BoxDesc, other_corner), .doc = "the one opposite"},
};

static const BoxDesc box_defaults = {.part = OBJECT_PART};

// POV-Ray takes the absolute value of a negative radius of a cylinder or disc, and so do we. Of a sphere see place.c. It
// draws a cone of one as two that meet in their apex, with wrong surfaces. Measured.
#define RADIUS {RANGE_FAULT, false, 0.0, INFINITY}

static const SchemaProperty cylinder_arguments[] = {
    {"base", TYPE_VECTOR, AT(CylinderDesc, base), .doc = "the middle of one end"},
    {"cap", TYPE_VECTOR, AT(CylinderDesc, cap), .doc = "the middle of the other end"},
    {"radius", TYPE_NUMBER, AT(CylinderDesc, radius), .doc = "0: not drawn; its sign is not looked at"},
};

static const SchemaProperty cylinder_properties[] = {
    {"open", TYPE_FLAG, AT(CylinderDesc, is_open), .is_first = true, .doc = "without the discs at its ends"},
};

static const CylinderDesc cylinder_defaults = {.part = OBJECT_PART};

static const SchemaProperty cone_arguments[] = {
    {"base", TYPE_VECTOR, AT(ConeDesc, base), .doc = "the middle of one end"},
    {"base radius", TYPE_NUMBER, AT(ConeDesc, base_radius), .range = RADIUS, .doc = "there"},
    {"cap", TYPE_VECTOR, AT(ConeDesc, cap), .doc = "the middle of the other end"},
    {"cap radius", TYPE_NUMBER, AT(ConeDesc, cap_radius), .range = RADIUS, .doc = "there; both 0: not drawn"},
};

static const SchemaProperty cone_properties[] = {
    {"open", TYPE_FLAG, AT(ConeDesc, is_open), .is_first = true, .doc = "without the discs at its ends"},
};

static const ConeDesc cone_defaults = {.part = OBJECT_PART};

static const SchemaProperty disc_arguments[] = {
    {"centre", TYPE_VECTOR, AT(DiscDesc, centre), .doc = "its middle"},
    {"normal", TYPE_VECTOR, AT(DiscDesc, normal), .doc = "at right angles to it; any length, 0: not drawn"},
    {"radius", TYPE_NUMBER, AT(DiscDesc, radius), .doc = "0: not drawn; its sign is not looked at"},
    {"hole", TYPE_NUMBER, AT(DiscDesc, hole), .is_optional = true,
     .doc = "radius of a hole; not less than the radius: not drawn"},
};

static const DiscDesc disc_defaults = {.part = OBJECT_PART};

// POV-Ray draws a torus of a negative radius in a box that is too small for it, and one with a ring of radius 0, each
// of whose points is a double root, with holes. Measured.
static const SchemaProperty torus_arguments[] = {
    {"major radius", TYPE_NUMBER, AT(TorusDesc, major), .range = POSITIVE, .doc = "of the ring, in y = 0"},
    {"minor radius", TYPE_NUMBER, AT(TorusDesc, minor), .range = RADIUS,
     .doc = "of the tube; 0: not drawn; it may be the greater one"},
};

static const SchemaProperty torus_properties[] = {
    {"sturm", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: roots are always as good"},
};

static const SchemaProperty ovus_arguments[] = {
    {"bottom radius", TYPE_NUMBER, AT(OvusDesc, bottom), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "of a ball about the origin"},
    {"top radius", TYPE_NUMBER, AT(OvusDesc, top), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "of a ball about a point of that one's surface, on the y axis"},
};

static const OvusDesc ovus_defaults = {.part = OBJECT_PART, .bottom = 1.0};
static const TorusDesc torus_defaults = {.part = OBJECT_PART, .major = 1.0};

// ---- polynomials

static const SchemaProperty quadric_arguments[] = {
    {"squares", TYPE_VECTOR, AT(PolynomialDesc, squares), .doc = "A, B, C of A x² + B y² + C z²"},
    {"products", TYPE_VECTOR, AT(PolynomialDesc, products), .doc = "D, E, F of D xy + E xz + F yz"},
    {"linear terms", TYPE_VECTOR, AT(PolynomialDesc, linear), .doc = "G, H, I of G x + H y + I z"},
    {"constant", TYPE_NUMBER, AT(PolynomialDesc, constant), .doc = "J; the sum of all is 0 on the surface"},
};

#define COEFFICIENTS "by falling powers of x, then of y, then of z: x³, x²y, x²z, x², xy², …"

static const SchemaProperty cubic_arguments[] = {
    {"coefficients", TYPE_NUMBERS, AT(PolynomialDesc, coefficients), .doc = COEFFICIENTS},
};

static const SchemaProperty poly_arguments[] = {
    {"order", TYPE_INTEGER, AT(PolynomialDesc, order), .range = {RANGE_FAULT, false, 2.0, 35.0},
     .doc = "the greatest sum of powers"},
    {"coefficients", TYPE_NUMBERS, AT(PolynomialDesc, coefficients), .doc = COEFFICIENTS},
};

static const SchemaProperty polynomial_arguments[] = {
    {"order", TYPE_INTEGER, AT(PolynomialDesc, order), .range = {RANGE_FAULT, false, 2.0, 35.0},
     .doc = "the greatest sum of powers; then its terms"},
};

// ---- isosurface

static const SchemaProperty isosurface_properties[] = {
    {"function", TYPE_ACTION, ACTION_SHAPE_FUNCTION, .is_first = true,
     .doc = "`{ … }` of x, y and z: at the threshold on the surface, below it inside"},
    {"contained_by", TYPE_BLOCK, ACTION_CONTAINED_BY, .doc = "`{ sphere { … } }` or `{ box { … } }`"},
    {"threshold", TYPE_NUMBER, AT(IsosurfaceDesc, threshold), .doc = "what the function is on the surface"},
    {"accuracy", TYPE_NUMBER, AT(IsosurfaceDesc, accuracy), .range = POSITIVE,
     .doc = "no piece of a ray is halved that is shorter"},
    {"max_gradient", TYPE_NUMBER, AT(IsosurfaceDesc, max_gradient), .range = POSITIVE,
     .doc = "how much the function changes over a length of 1 at most"},
    {"evaluate", TYPE_ACTION, ACTION_EVALUATE,
     .doc = "three numbers; `max_gradient` is then the first times the square of the second"},
    {"max_trace", TYPE_INTEGER, AT(IsosurfaceDesc, roots_most), .range = {RANGE_FAULT, false, 1.0, INFINITY},
     .doc = "how many surfaces a ray meets, at most 10"},
    {"all_intersections", TYPE_ACTION, ACTION_EVALUATE, .doc = "the same as `max_trace 10`"},
    {"open", TYPE_FLAG, AT(IsosurfaceDesc, is_open), .doc = "nothing is seen where the container cuts the inside"},
};

static const SchemaProperty parametric_properties[] = {
    {"contained_by", TYPE_BLOCK, ACTION_CONTAINED_BY, .is_leading = true,
     .doc = "`{ sphere { … } }` or `{ box { … } }`"},
    {"accuracy", TYPE_NUMBER, AT(ParametricDesc, accuracy), .range = POSITIVE, .is_leading = true,
     .doc = "the rectangle of u and v is halved until its pieces are shorter"},
    {"max_gradient", TYPE_NUMBER, AT(ParametricDesc, max_gradient), .range = POSITIVE, .is_leading = true,
     .doc = "how much a function changes with u or v over 1 at most"},
    {"precompute", TYPE_ACTION, ACTION_PRECOMPUTE, .is_leading = true,
     .doc = "a number from 1 to 20, then x, y and z or some of them: changes nothing"},
};

static const ParametricDesc parametric_defaults = {.part = OBJECT_PART,
                                                   .container = {.low = {-1.0, -1.0, -1.0}, .high = {1.0, 1.0, 1.0}},
                                                   .accuracy = 0.001,
                                                   .max_gradient = 1.0};

static const SchemaProperty contained_by_properties[] = {
    {"sphere", TYPE_BLOCK, ACTION_CONTAINER, .doc = "`{ centre, radius }`"},
    {"box", TYPE_BLOCK, ACTION_CONTAINER, .doc = "`{ corner, opposite corner }`"},
};

static const SchemaProperty container_ball_arguments[] = {
    {"centre", TYPE_VECTOR, AT(ContainerDesc, low), .doc = "its middle"},
    {"radius", TYPE_NUMBER, AT(ContainerDesc, radius), .range = POSITIVE, .doc = "its radius"},
};

static const SchemaProperty container_box_arguments[] = {
    {"corner", TYPE_VECTOR, AT(ContainerDesc, low), .doc = "one corner"},
    {"opposite corner", TYPE_VECTOR, AT(ContainerDesc, high), .doc = "the other"},
};

static const ContainerDesc container_defaults = {.low = {-1.0, -1.0, -1.0}, .high = {1.0, 1.0, 1.0}, .radius = 1.0};
static const IsosurfaceDesc isosurface_defaults = {.part = OBJECT_PART,
                                                   .container = {.low = {-1.0, -1.0, -1.0}, .high = {1.0, 1.0, 1.0}},
                                                   .accuracy = 0.001,
                                                   .max_gradient = 1.1,
                                                   .roots_most = 1};

// ---- blob

static const SchemaProperty blob_properties[] = {
    {"threshold", TYPE_NUMBER, AT(BlobDesc, threshold), .range = POSITIVE,
     .doc = "how strong all fields together are on the surface"},
    {"sphere", TYPE_BLOCK, ACTION_BLOB_PART,
     .doc = "`{ centre, radius, strength transforms }`: strength × (1 - (distance / radius)²)²"},
    {"cylinder", TYPE_BLOCK, ACTION_BLOB_PART,
     .doc = "`{ base, cap, radius, strength transforms }`: the same around a stretch"},
    {"component", TYPE_ACTION, ACTION_BLOB_PART, .doc = "strength, radius, centre: an older form of `sphere`"},
    {"hierarchy", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: there is a tree of many components"},
    {"sturm", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: roots are always as good"},
};

static const SchemaProperty blob_part_properties[] = {
    {"texture", TYPE_BLOCK, ACTION_TEXTURE, .doc = "of the component; where fields overlap each weighs as much as it is"},
    {"pigment", TYPE_BLOCK, ACTION_PIGMENT, .doc = "pigment of that texture"},
    {"normal", TYPE_BLOCK, ACTION_NORMAL, .doc = "normal of that texture"},
    {"finish", TYPE_BLOCK, ACTION_FINISH, .doc = "finish of that texture"},
};

static const SchemaProperty blob_ball_arguments[] = {
    {"centre", TYPE_VECTOR, AT(BlobPartDesc, base), .doc = "its middle"},
    {"radius", TYPE_NUMBER, AT(BlobPartDesc, radius), .range = POSITIVE, .doc = "where its field ends"},
    {"strength", TYPE_NUMBER, AT(BlobPartDesc, strength), .doc = "of the field in its middle; it may be negative"},
};

static const SchemaProperty blob_rod_arguments[] = {
    {"base", TYPE_VECTOR, AT(BlobPartDesc, base), .doc = "one end"},
    {"cap", TYPE_VECTOR, AT(BlobPartDesc, cap), .doc = "the other"},
    {"radius", TYPE_NUMBER, AT(BlobPartDesc, radius), .range = POSITIVE, .doc = "where its field ends"},
    {"strength", TYPE_NUMBER, AT(BlobPartDesc, strength), .doc = "of the field in its middle; it may be negative"},
};

static const BlobDesc blob_defaults = {.part = OBJECT_PART, .threshold = 1.0};
static const BlobPartDesc blob_part_defaults = {.part = OBJECT_PART, .radius = 1.0, .strength = 1.0};

static const PolynomialDesc quadric_defaults = {.part = OBJECT_PART, .order = 2};
static const PolynomialDesc cubic_defaults = {.part = OBJECT_PART, .order = 3};
static const PolynomialDesc quartic_defaults = {.part = OBJECT_PART, .order = 4};
static const PolynomialDesc poly_defaults = {.part = OBJECT_PART, .order = 2};

static const SchemaProperty prism_properties[] = {
    {"open", TYPE_FLAG, AT(PrismDesc, is_open), .is_first = true, .doc = "without the faces at its ends"},
    {"sturm", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: roots are always as good"},
};

static const PrismDesc prism_defaults = {.part = OBJECT_PART};

static const SuperellipsoidDesc superellipsoid_defaults = {.part = OBJECT_PART, .about = 1.0, .along = 1.0};

static const SchemaProperty sweep_properties[] = {
    {"tolerance", TYPE_NUMBER, AT(SweepDesc, tolerance), .is_first = true,
     .doc = "changes nothing: no ray meets again what it leaves"},
};

static const SchemaProperty julia_properties[] = {
    {"quaternion", TYPE_ACTION, ACTION_JULIA, .is_leading = true, .doc = "the algebra that there is here"},
    {"sqr", TYPE_ACTION, ACTION_JULIA, .is_leading = true, .doc = "f(h) = h²"},
    {"cube", TYPE_ACTION, ACTION_JULIA, .is_leading = true, .doc = "f(h) = h³"},
    {"max_iteration", TYPE_INTEGER, AT(JuliaDesc, step_count), .range = {RANGE_FAULT, false, 1.0, 1e6}, .is_leading = true,
     .doc = "how many points of an orbit lie in the ball"},
    {"precision", TYPE_NUMBER, AT(JuliaDesc, precision), .is_leading = true,
     .doc = "rays go by steps of 1 / precision, at most 1"},
    {"slice", TYPE_ACTION, ACTION_JULIA, .is_leading = true,
     .doc = "normal of 4 numbers, distance; at first `<0, 0, 0, 1>, 0`"},
};

static const JuliaDesc julia_defaults = {
    .part = OBJECT_PART, .slice = {0.0, 0.0, 0.0, 1.0}, .precision = 20.0, .power = 2, .step_count = 20};
static const SweepDesc sweep_defaults = {.part = OBJECT_PART, .size = 1.0};
static const LatheDesc lathe_defaults = {.part = OBJECT_PART};
static const SorDesc sor_defaults = {.part = OBJECT_PART};

static const SchemaProperty sor_properties[] = {
    {"open", TYPE_FLAG, AT(SorDesc, is_open), .is_first = true, .doc = "without the discs at its ends"},
    {"sturm", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: roots are always as good"},
};

static const PolygonDesc polygon_defaults = {.part = OBJECT_PART, .frame = IDENTITY};

static const SchemaProperty triangle_arguments[] = {
    {"first corner", TYPE_VECTOR, AT(TriangleDesc, corners[0]), .doc = "in any order"},
    {"second corner", TYPE_VECTOR, AT(TriangleDesc, corners[1]), .doc = "likewise"},
    {"third corner", TYPE_VECTOR, AT(TriangleDesc, corners[2]), .doc = "on one line with the others: not drawn"},
};

static const TriangleDesc triangle_defaults = {.part = OBJECT_PART};

static const SchemaProperty mesh_properties[] = {
    {"inside_vector", TYPE_VECTOR, AT(MeshDesc, inside_vector), .is_first = true,
     .doc = "inside is what an odd number of faces lies along; 0: none"},
    {"hierarchy", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: there is always a tree"},
};

static const MeshDesc mesh_defaults = {.part = OBJECT_PART};

static const PatchDesc patch_defaults = {.part = OBJECT_PART};

static const SchemaProperty height_field_properties[] = {
    {"smooth", TYPE_FLAG, AT(MeshDesc, is_smooth), .is_leading = true,
     .doc = "it is lit as if its normal went over from height to height"},
    {"water_level", TYPE_NUMBER, AT(MeshDesc, water), .is_leading = true,
     .doc = "nothing is seen of it below this height"},
    {"hierarchy", TYPE_SWITCH, AT(ObjectPart, ignored), .doc = "changes nothing: there is always a tree"},
};

static const SchemaProperty smooth_triangle_arguments[] = {
    {"first corner", TYPE_VECTOR, AT(SmoothTriangleDesc, corners[0]), .doc = "in any order"},
    {"first normal", TYPE_VECTOR, AT(SmoothTriangleDesc, normals[0]), .doc = "there; 0: not drawn"},
    {"second corner", TYPE_VECTOR, AT(SmoothTriangleDesc, corners[1]), .doc = "likewise"},
    {"second normal", TYPE_VECTOR, AT(SmoothTriangleDesc, normals[1]), .doc = "likewise"},
    {"third corner", TYPE_VECTOR, AT(SmoothTriangleDesc, corners[2]), .doc = "on one line with the others: not drawn"},
    {"third normal", TYPE_VECTOR, AT(SmoothTriangleDesc, normals[2]), .doc = "likewise"},
};

static const SmoothTriangleDesc smooth_triangle_defaults = {.part = OBJECT_PART};

static const SchemaProperty union_properties[] = {
    {"split_union", TYPE_SWITCH, AT(ObjectPart, split_union),
     .doc = "off: `no_image` and the like hold for the union, not its members"},
};

static const SchemaProperty light_group_properties[] = {
    {"global_lights", TYPE_SWITCH, AT(UnionDesc, global_lights), .doc = "lights of no group light its objects, too"},
};

static const UnionDesc light_group_defaults = {.part = {.transform = IDENTITY, .split_union = true},
                                               .is_light_group = true};
static const UnionDesc union_defaults = {.part = {.transform = IDENTITY, .split_union = true}};

static const SchemaProperty background_arguments[] = {
    {"colour", TYPE_COLOUR, AT(BackgroundDesc, colour), .is_optional = true, .doc = "seen where nothing is hit"},
};

static const BackgroundDesc background_defaults = {.colour = {0, 0, 0, 0, 0}};

static const SchemaProperty sky_sphere_properties[] = {
    {"pigment", TYPE_BLOCK, ACTION_SKY_LAYER,
     .doc = "a layer over those before it; the ray's direction, of length 1, is its point"},
    {"emission", TYPE_RGB, AT(SkySphereDesc, emission), .doc = "multiplies the light of the layers"},
};

static const SkySphereDesc sky_sphere_defaults = {.transform = IDENTITY, .emission = GREY(1.0)};

static const SchemaProperty fog_arguments[] = {
    {"colour", TYPE_COLOUR, AT(FogDesc, colour), .is_optional = true, .is_anywhere = true,
     .doc = "begins with a colour word or a colour's name; stands anywhere; else black"},
};

static const SchemaProperty fog_properties[] = {
    {"fog_type", TYPE_INTEGER, AT(FogDesc, type), .doc = "2: it lies on the ground; else it is everywhere"},
    {"distance", TYPE_NUMBER, AT(FogDesc, distance), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "the way on which all but 1/e of the light is lost; 0: no fog"},
    {"fog_offset", TYPE_NUMBER, AT(FogDesc, offset),
     .doc = "type 2: the height up to which it is as dense as anywhere"},
    {"fog_alt", TYPE_NUMBER, AT(FogDesc, alt), .doc = "type 2: how far above that it is half as dense; more than 0"},
    {"up", TYPE_VECTOR, AT(FogDesc, up), .doc = "type 2: the direction of height, of any length but 0"},
    {"turb_depth", TYPE_NUMBER, AT(FogDesc, turb_depth), .doc = "how much thinner turbulence makes the fog; 0: not"},
    {"turbulence", TYPE_VECTOR, AT(FogDesc, turbulence), GIVEN(FogDesc, is_turbulent),
     .doc = "makes the fog uneven: how fine, in x, y and z; 0 makes it thinner evenly"},
    {"omega", TYPE_NUMBER, AT(FogDesc, omega), GIVEN(FogDesc, is_turbulent),
     .doc = "of turbulence: how much weaker each octave is"},
    {"lambda", TYPE_NUMBER, AT(FogDesc, lambda), GIVEN(FogDesc, is_turbulent),
     .doc = "of turbulence: how much finer each octave is"},
    {"octaves", TYPE_INTEGER, AT(FogDesc, octaves), GIVEN(FogDesc, is_turbulent),
     .range = {RANGE_CLAMP, false, 1.0, 10.0}, .doc = "of turbulence: noises added up"},
};

static const FogDesc fog_defaults = {
    .transform = IDENTITY, .type = 1, .up = {0, 1, 0}, .turb_depth = 0.5, .lambda = 2.0, .omega = 0.5, .octaves = 6};

static const SchemaProperty rainbow_properties[] = {
    {"direction", TYPE_VECTOR, AT(RainbowDesc, direction), GIVEN(RainbowDesc, has_direction),
     .doc = "of the sun's light; any length but 0; must be there"},
    {"angle", TYPE_NUMBER, AT(RainbowDesc, angle), .doc = "degrees from it to the middle of the bow"},
    {"width", TYPE_NUMBER, AT(RainbowDesc, width), .doc = "of the bow in degrees; 0: no rainbow"},
    {"distance", TYPE_NUMBER, AT(RainbowDesc, distance), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "as of fog; 0: no rainbow"},
    {"color_map", TYPE_BLOCK, ACTION_RAINBOW_MAP, .doc = "colours from inside to outside; without it no rainbow"},
    {"colour_map", TYPE_BLOCK, ACTION_RAINBOW_MAP, .doc = "the same"},
    {"jitter", TYPE_NUMBER, AT(RainbowDesc, jitter), .doc = "how far rays see other colours by chance"},
    {"up", TYPE_VECTOR, AT(RainbowDesc, up), .doc = "where the middle of an arc is"},
    {"arc_angle", TYPE_NUMBER, AT(RainbowDesc, arc_angle), .range = {RANGE_FAULT, false, 0.0, 360.0},
     .doc = "of the arc"},
    {"falloff_angle", TYPE_NUMBER, AT(RainbowDesc, falloff_angle), .range = {RANGE_FAULT, false, 0.0, 360.0},
     .doc = "of what of it does not fade out; not above `arc_angle`"},
};

static const RainbowDesc rainbow_defaults = {
    .up = {0, 1, 0}, .distance = 1e7, .arc_angle = 360.0, .falloff_angle = 360.0};

static const SchemaProperty settings_properties[] = {
    {"assumed_gamma", TYPE_ACTION, ACTION_ASSUMED_GAMMA,
     .doc = "what colour values mean: a number above 0, or `srgb`; the first counts"},
    {"ambient_light", TYPE_RGB, AT(SettingsDesc, ambient_light), .doc = "multiplies every `ambient`"},
    {"max_trace_level", TYPE_INTEGER, AT(SettingsDesc, max_trace_level), .range = {RANGE_CLAMP, false, 1.0, 256.0},
     .doc = "generations of rays, the camera's too"},
    {"adc_bailout", TYPE_NUMBER, AT(SettingsDesc, adc_bailout), .range = {RANGE_FAULT, false, -INFINITY, 1.0},
     .doc = "the least weight of a ray; the camera's is 1"},
    {"noise_generator", TYPE_ACTION, ACTION_NOISE_GENERATOR,
     .doc = "of patterns that name none: 1, 2 or 3; by default 2, before version 3.5 1"},
    {"number_of_waves", TYPE_INTEGER, AT(SettingsDesc, number_of_waves),
     .range = {RANGE_RAISE, false, 1.0, SETTINGS_WAVES_MAX}, .doc = "of waves"},
    {"charset", TYPE_ACTION, ACTION_CHARSET, .doc = "how the bytes of strings are read: `ascii`, `utf8` or `sys`"},
    {"irid_wavelength", TYPE_RGB, AT(SettingsDesc, irid_wavelength),
     .doc = "of light, in the unit of the thickness of `irid`"},
    {"hf_gray_16", TYPE_SWITCH, AT(SettingsDesc, is_ignored), .doc = "accepted; changes no picture"},
    {"max_intersections", TYPE_NUMBER, AT(SettingsDesc, ignored), .doc = "accepted; changes no picture"},
    {"mm_per_unit", TYPE_NUMBER, AT(SettingsDesc, ignored), .doc = "accepted; changes no picture"},
};

static const SettingsDesc settings_defaults = {
    .ambient_light = GREY(1.0),
    .adc_bailout = 1.0 / 255.0,
    .max_trace_level = 5,
    .number_of_waves = SETTINGS_WAVES,
    .irid_wavelength = {(double)0.70f, (double)0.52f, (double)0.48f},
};

#define AVERAGE {"average", TYPE_ACTION, ACTION_PATTERN, .doc = "all entries of the map at once, by their weights"}
#define SURFACE                                                                                                        \
    {                                                                                                                  \
        "uv_mapping", TYPE_ACTION, ACTION_SURFACE, .doc = "stands first, alone: laid out by surface coordinates"       \
    }

static const SchemaProperty texture_properties[] = {
    SURFACE,
    AVERAGE,
    {"pigment", TYPE_BLOCK, ACTION_PIGMENT, .doc = "its colour"},
    {"normal", TYPE_BLOCK, ACTION_NORMAL, .doc = "its bumps"},
    {"finish", TYPE_BLOCK, ACTION_FINISH, .doc = "how it shines; what is not said stays as it was"},
    {"material_map", TYPE_BLOCK, ACTION_PICTURE, .doc = "textures by the numbers of a picture"},
    {"texture_map", TYPE_BLOCK, ACTION_MAP, .doc = "textures along a pattern of values"},
    {"tiles", TYPE_BLOCK, ACTION_TILES,
     .doc = "old: `{ textures tile2 textures }`, `checker` of the second and the first"},
    {"no_bump_scale", TYPE_FLAG, AT(TextureDesc, keeps_length),
     .doc = "the depth of its bumps is not scaled with it; not for a pattern of textures"},
};

static const SchemaProperty normal_arguments[] = {
    {"amount", TYPE_NUMBER, AT(NormalDesc, amount), .is_optional = true, .doc = "how deep: stands after the pattern"},
};

static const SchemaProperty normal_properties[] = {
    SURFACE,
    AVERAGE,
    {"bump_map", TYPE_BLOCK, ACTION_PICTURE, .doc = "a picture of heights"},
    {"bump_size", TYPE_NUMBER, AT(NormalDesc, amount), .doc = "how deep"},
    {"accuracy", TYPE_NUMBER, AT(NormalDesc, accuracy), .range = POSITIVE,
     .doc = "how far from the point the pattern is looked at"},
    {"slope_map", TYPE_BLOCK, ACTION_MAP, .doc = "heights along a pattern of values"},
    {"normal_map", TYPE_BLOCK, ACTION_MAP, .doc = "normals along a pattern of values"},
    {"no_bump_scale", TYPE_FLAG, AT(NormalDesc, keeps_length), .doc = "the depth is not scaled with the pattern"},
};

static const SchemaProperty pigment_arguments[] = {
    {"colour", TYPE_COLOUR, AT(PigmentDesc, colour), .is_optional = true,
     .doc = "begins with a colour word or the name of a colour"},
};

static const SchemaProperty pigment_properties[] = {
    SURFACE,
    AVERAGE,
    {"color_map", TYPE_BLOCK, ACTION_MAP, .doc = "colours along a pattern of values"},
    {"colour_map", TYPE_BLOCK, ACTION_MAP, .doc = "the same"},
    {"pigment_map", TYPE_BLOCK, ACTION_MAP, .doc = "pigments along a pattern of values"},
    {"image_map", TYPE_BLOCK, ACTION_IMAGE_MAP, .doc = "the colours of a picture"},
    {"no_bump_scale", TYPE_FLAG, AT(PigmentDesc, ignored), .doc = "accepted; changes no picture"},
    {"quick_color", TYPE_COLOUR, AT(PigmentDesc, quick_colour), .doc = "accepted; changes no picture"},
    {"quick_colour", TYPE_COLOUR, AT(PigmentDesc, quick_colour), .doc = "accepted; changes no picture"},
};

#define SLOPE_AT(field) .at = (uint16_t)offsetof(SlopeDesc, field)

static const SchemaProperty slope_arguments[] = {
    {"direction", TYPE_VECTOR, SLOPE_AT(direction), .is_optional = true,
     .doc = "what the surface may face"},
    {"low slope", TYPE_NUMBER, SLOPE_AT(low), .is_optional = true, .doc = "the slope, from 0 to 1, that becomes 0 …"},
    {"high slope", TYPE_NUMBER, SLOPE_AT(high), .is_optional = true, .doc = "… and 1"},
};

static const SchemaProperty slope_properties[] = {
    {"point_at", TYPE_ACTION, ACTION_SLOPE_ITEM, .doc = "instead: a point, and then such slopes"},
    {"altitude", TYPE_ACTION, ACTION_SLOPE_ITEM,
     .doc = "a vector along which heights count, too; then those that become 0 and 1"},
};

static const SlopeDesc slope_defaults = {.high_altitude = 0.0};

#define WARP_AT(field) .at = (uint16_t)offsetof(WarpDesc, warp.field)

static const SchemaProperty warp_properties[] = {
    {"turbulence", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "then a vector: moves each point by noise, so much; of `black_hole`: its places"},
    {"octaves", TYPE_INTEGER, WARP_AT(octaves), .range = {RANGE_CLAMP, false, 1.0, 10.0},
     .doc = "of turbulence: noises added up"},
    {"lambda", TYPE_NUMBER, WARP_AT(lambda), .doc = "of turbulence: how much finer each octave is"},
    {"omega", TYPE_NUMBER, WARP_AT(omega), .doc = "of turbulence: how much weaker each octave is"},
    {"repeat", TYPE_ACTION, ACTION_WARP_TYPE,
     .doc = "then a vector along x, y or z: the slice so wide, again and again; or boxes of holes"},
    {"offset", TYPE_VECTOR, WARP_AT(offset), .doc = "of `repeat`: each slice from the one before"},
    {"flip", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "of `repeat`: every other slice is turned where this is not 0"},
    {"black_hole", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "then its middle and its radius: draws points to its middle"},
    {"strength", TYPE_NUMBER, WARP_AT(strength), .doc = "of `black_hole`"},
    {"falloff", TYPE_NUMBER, WARP_AT(power), .doc = "of `black_hole`: exponent of the nearness to its middle"},
    {"inverse", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "of `black_hole`: throws points out of it instead"},
    {"planar", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "x and y are laid on a plane: its normal and distance may follow"},
    {"cylindrical", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "x and y are laid around a cylinder"},
    {"spherical", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "x and y are laid around a sphere"},
    {"toroidal", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "x and y are laid around a torus"},
    {"orientation", TYPE_VECTOR, WARP_AT(vector), .doc = "of these: the axis"},
    {"dist_exp", TYPE_NUMBER, WARP_AT(exponent), .doc = "of these: exponent of the distance, 0"},
    {"major_radius", TYPE_NUMBER, WARP_AT(radius), .doc = "of `toroidal`: of its ring"},
    {"cubic", TYPE_ACTION, ACTION_WARP_TYPE, .doc = "x and y are laid on an unfolded cube; it stands alone"},
};

static const WarpDesc warp_defaults = {
    .warp = {.to_outside = IDENTITY,
             .vector = {0, 0, 1},
             .radius = 1.0,
             .strength = 1.0,
             .power = 2.0,
             .lambda = 2.0,
             .omega = 0.5,
             .octaves = 6,
             .next = RECORD_NONE},
};

#define FILE_TYPE(word, text) {word, TYPE_ACTION, ACTION_IMAGE, .is_first = true, .doc = text}

static const SchemaProperty picture_properties[] = {
    FILE_TYPE("png", "then the name of a PNG file, with or without its ending"),
    FILE_TYPE("jpeg", "of a JPEG file"),
    FILE_TYPE("tga", "of a Targa file"),
    FILE_TYPE("ppm", "of a PPM file"),
    FILE_TYPE("pgm", "of a PGM file"),
    FILE_TYPE("tiff", "of a TIFF file of 8 bits without alpha"),
    FILE_TYPE("exr", "of an OpenEXR file"),
    FILE_TYPE("hdr", "of a Radiance file"),
    {"gamma", TYPE_ACTION, ACTION_IMAGE,
     .doc = "right after the name: how the values are encoded, a number above 0 or `srgb`"},
    {"premultiplied", TYPE_ACTION, ACTION_IMAGE,
     .doc = "right after the name: whether colours are multiplied with alpha"},
    {"map_type", TYPE_ACTION, ACTION_IMAGE, .doc = "0 plane, 1 sphere, 2 cylinder, 5 torus"},
    {"interpolate", TYPE_ACTION, ACTION_IMAGE, .doc = "2 bilinear, 3 bicubic, 4 by distance"},
    {"once", TYPE_FLAG, AT(ImageDesc, is_once), .doc = "nothing is beyond the picture, which is else repeated"},
};

#define USE_COLOUR                                                                                                     \
    {"use_color", TYPE_FLAG, AT(ImageDesc, ignored), .doc = "accepted; changes no picture"},                           \
    {                                                                                                                  \
        "use_colour", TYPE_FLAG, AT(ImageDesc, ignored), .doc = "accepted; changes no picture"                         \
    }

static const SchemaProperty image_properties[] = {
    {"filter", TYPE_ACTION, ACTION_IMAGE, .doc = "`all` or a place in the palette, then how much"},
    {"transmit", TYPE_ACTION, ACTION_IMAGE, .doc = "`all` or a place in the palette, then how much"},
    USE_COLOUR,
};

static const SchemaProperty image_pattern_properties[] = {
    {"use_alpha", TYPE_FLAG, AT(ImageDesc, uses_alpha), .doc = "how much comes through, not how bright it is"},
    {"use_index", TYPE_FLAG, AT(ImageDesc, ignored), .doc = "accepted; changes no picture"},
    USE_COLOUR,
};

static const SchemaProperty bump_map_properties[] = {
    {"bump_size", TYPE_NUMBER, AT(ImageDesc, bump_size), .doc = "how deep, as in the normal around it"},
    {"use_index", TYPE_FLAG, AT(ImageDesc, uses_index), .doc = "the place in the palette is the height"},
    USE_COLOUR,
};

static const SchemaProperty material_map_properties[] = {
    {"texture", TYPE_BLOCK, ACTION_MAP_MATERIAL, .doc = "the next one of the textures, from 0 on"},
};

static const ImageDesc image_defaults = {.map = {.picture = 0}, .bump_size = NAN};

#define FINISH_AT(field) .at = (uint16_t)offsetof(FinishDesc, finish.field)

static const SchemaProperty finish_properties[] = {
    {"ambient", TYPE_RGB, FINISH_AT(ambient), .doc = "share of the ambient light given back"},
    {"emission", TYPE_RGB, FINISH_AT(emission), .doc = "light given off"},
    {"diffuse", TYPE_SHARE_PAIR, FINISH_AT(diffuse), GIVEN(FinishDesc, diffuse_is_albedo),
     .doc = "light scattered to this and the other side; `albedo`: in all"},
    {"brilliance", TYPE_NUMBER, FINISH_AT(brilliance), .doc = "exponent of the cosine in `diffuse`"},
    {"phong", TYPE_SHARE, FINISH_AT(phong), GIVEN(FinishDesc, phong_is_albedo), .doc = "a highlight after Phong"},
    {"phong_size", TYPE_NUMBER, FINISH_AT(phong_size), .doc = "its exponent: greater is smaller"},
    {"specular", TYPE_SHARE, FINISH_AT(specular), GIVEN(FinishDesc, specular_is_albedo),
     .doc = "a highlight after Blinn"},
    {"roughness", TYPE_NUMBER, FINISH_AT(roughness), .range = {RANGE_WARN, true, 0.0, INFINITY},
     .doc = "1 / its exponent; 0: a constant highlight"},
    {"metallic", TYPE_OPTIONAL_NUMBER, FINISH_AT(metallic), .bare = 1.0, .doc = "highlights take the pigment's colour"},
    {"reflection", TYPE_ACTION, ACTION_REFLECTION, .doc = "a colour, or `{ [min,] max … }`, see below"},
    {"reflection_exponent", TYPE_NUMBER, FINISH_AT(reflection_exponent), .range = POSITIVE,
     .doc = "the same as `exponent` in `reflection { }`"},
    {"refraction", TYPE_NUMBER, FINISH_AT(refraction), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "old: share of the light let through that continues"},
    {"ior", TYPE_NUMBER, AT(FinishDesc, ior), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "old: the `ior` of the interior; 0: as the interior says"},
    {"crand", TYPE_NUMBER, FINISH_AT(crand),
     .doc = "scattered light is less by chance, by up to so much, from place to place"},
    {"irid", TYPE_BLOCK, ACTION_IRID, .doc = "`{ amount … }`: colours of a thin layer, which change with the angle"},
    {"conserve_energy", TYPE_FLAG, AT(FinishDesc, conserve_energy),
     .doc = "what is let through loses what is reflected"},
};

static const SchemaProperty irid_arguments[] = {
    {"amount", TYPE_NUMBER, FINISH_AT(irid), .doc = "how much they count; 0: not at all"},
};

static const SchemaProperty irid_properties[] = {
    {"thickness", TYPE_NUMBER, FINISH_AT(irid_thickness), .doc = "of the layer"},
    {"turbulence", TYPE_NUMBER, FINISH_AT(irid_turbulence), .doc = "how uneven it is"},
};

static const SchemaProperty reflection_arguments[] = {
    {"min", TYPE_RGB, FINISH_AT(reflection_min), .is_optional = true, .doc = "seen head on"},
    {"max", TYPE_RGB, FINISH_AT(reflection_max), .is_optional = true, .doc = "seen edge on; alone it is `min` too"},
};

static const SchemaProperty reflection_properties[] = {
    {"falloff", TYPE_NUMBER, FINISH_AT(reflection_falloff), .doc = "exponent of the way from `min` to `max`"},
    {"exponent", TYPE_NUMBER, FINISH_AT(reflection_exponent), .range = POSITIVE,
     .doc = "the reflected light is raised to 1 / exponent"},
    {"fresnel", TYPE_SWITCH, AT(FinishDesc, is_fresnel),
     .doc = "from `min` to `max` as a surface with the interior's `ior` reflects"},
    {"metallic", TYPE_OPTIONAL_NUMBER, FINISH_AT(reflection_metallic), .bare = 1.0,
     .doc = "the mirror image takes the pigment's colour"},
};

#define FINISH_DEFAULTS                                                                                                \
    {                                                                                                                  \
        .ambient = GREY(0.1f), .diffuse = 0.6, .brilliance = 1.0, .phong_size = 40.0, .roughness = 0.05,               \
        .reflection_falloff = 1.0, .reflection_exponent = 1.0, .refraction = 1.0                                       \
    }

static const FinishDesc finish_defaults = {.finish = FINISH_DEFAULTS};

#define PATTERN_PART                                                                                                   \
    {                                                                                                                  \
        .transform = IDENTITY, .pattern = {.frequency = 1.0, .exponent = 1.0, .agate_turb = 1.0, .octaves = 6,        \
                                            .form = {-1.0, 1.0, 0.0}, .metric = 2.0, .power = 2,                       \
                                            .lambda = 2.0, .omega = 0.5}                                               \
    }

static const PatternPart pattern_defaults = PATTERN_PART;
static const PigmentDesc pigment_defaults = {.part = PATTERN_PART};
#define NORMAL_DEFAULTS                                                                                                \
    {                                                                                                                  \
        .part = PATTERN_PART, .amount = 0.5, .accuracy = 0.02                                                          \
    }

static const NormalDesc normal_defaults = NORMAL_DEFAULTS;
static const TextureDesc texture_defaults = {
    .part = PATTERN_PART, .pigment = {.part = PATTERN_PART}, .normal = NORMAL_DEFAULTS, .finish = FINISH_DEFAULTS};
static const SchemaProperty interior_properties[] = {
    {"ior", TYPE_NUMBER, AT(InteriorDesc, interior.ior), .range = {RANGE_FAULT, false, 0.0, INFINITY},
     .doc = "index of refraction; 0 is 1"},
    {"fade_distance", TYPE_NUMBER, AT(InteriorDesc, interior.fade_distance),
     .doc = "the way that halves the light; 0: none is lost"},
    {"fade_power", TYPE_NUMBER, AT(InteriorDesc, interior.fade_power),
     .doc = "1 / (1 + (way / distance) ^ power); from 1000 on exp(-way / distance)"},
    {"fade_color", TYPE_RGB, AT(InteriorDesc, interior.fade_colour), .doc = "what the light fades to"},
    {"fade_colour", TYPE_RGB, AT(InteriorDesc, interior.fade_colour), .doc = "the same"},
    {"caustics", TYPE_NUMBER, AT(InteriorDesc, interior.caustics),
     .doc = "how narrowly light that passes straight through the surface is gathered; 0: none"},
};

static const InteriorDesc interior_defaults = {.interior = {.ior = 1.0}};

static const SchemaProperty material_properties[] = {
    {"texture", TYPE_BLOCK, ACTION_TEXTURE, .doc = "the surface; a second one is laid over the first"},
    {"interior_texture", TYPE_BLOCK, ACTION_INNER_TEXTURE, .doc = "the surface as it is seen from inside, likewise"},
    {"interior", TYPE_BLOCK, ACTION_INTERIOR, .doc = "what is inside"},
};

static const MaterialDesc material_defaults = {.transform = IDENTITY};
static const PatternMap map_defaults = {NULL, 0};

static const SchemaProperty transform_properties[] = {
    {"inverse", TYPE_FLAG, AT(TransformDesc, is_inverse), .doc = "the way back, wherever it stands"},
};

static const TransformDesc transform_defaults = {.transform = IDENTITY};
static const UnsupportedDesc unsupported_defaults;

#define TRANSFORMS LIST(transforms)
#define PATTERNS LIST(pattern_modifiers)
#define OBJECT_GROUPS LIST(object_modifiers), TRANSFORMS

static const SchemaBlock kinds[KIND_COUNT] = {
    [KIND_NONE] = {.word = "", .what = "nothing", .doc = ""},
    [KIND_CAMERA] = {.word = "camera",
                     .what = "a camera",
                     .size = sizeof(CameraDesc),
                     .defaults = &camera_defaults,
                     .is_declarable = true,
                     .is_fixed = true,
                     .groups = {LIST(camera_properties), TRANSFORMS},
                     .doc = "The order of its words does not matter; transforms come last. The last camera counts."},
    [KIND_LIGHT_SOURCE] =
        {.word = "light_source",
         .what = "a light source",
         .size = sizeof(LightDesc),
         .defaults = &light_defaults,
         .is_object = true,
         .is_declarable = true,
         .is_fixed = true,
         .arguments = LIST(light_arguments),
         .groups = {LIST(light_properties), TRANSFORMS},
         .doc = "A point light, if nothing else is said. Transforms move what stands before them, but not `radius` and "
                "`falloff`."},
    [KIND_SPHERE] = {.word = "sphere",
                     .what = "a sphere",
                     .size = sizeof(SphereDesc),
                     .defaults = &sphere_defaults,
                     .is_object = true,
                     .is_declarable = true,
                     .arguments = LIST(sphere_arguments),
                     .groups = {OBJECT_GROUPS},
                     .doc = "All points at one distance from a centre; stretched by transforms."},
    [KIND_PLANE] = {.word = "plane",
                    .what = "a plane",
                    .size = sizeof(PlaneDesc),
                    .defaults = &plane_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .arguments = LIST(plane_arguments),
                    .groups = {OBJECT_GROUPS},
                    .doc = "An endless plane."},
    [KIND_BOX] = {.word = "box",
                  .what = "a box",
                  .size = sizeof(BoxDesc),
                  .defaults = &box_defaults,
                  .is_object = true,
                  .is_declarable = true,
                  .arguments = LIST(box_arguments),
                  .groups = {OBJECT_GROUPS},
                  .doc = "Six faces, along the axes until it is transformed. It may be flat."},
    [KIND_CYLINDER] = {.word = "cylinder",
                       .what = "a cylinder",
                       .size = sizeof(CylinderDesc),
                       .defaults = &cylinder_defaults,
                       .is_object = true,
                       .is_declarable = true,
                       .arguments = LIST(cylinder_arguments),
                       .groups = {LIST(cylinder_properties), OBJECT_GROUPS},
                       .doc = "Round, of one radius, between two points that differ."},
    [KIND_CONE] = {.word = "cone",
                   .what = "a cone",
                   .size = sizeof(ConeDesc),
                   .defaults = &cone_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .arguments = LIST(cone_arguments),
                   .groups = {LIST(cone_properties), OBJECT_GROUPS},
                   .doc = "Round, with a radius at each of two points that differ."},
    [KIND_DISC] = {.word = "disc",
                   .what = "a disc",
                   .size = sizeof(DiscDesc),
                   .defaults = &disc_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .arguments = LIST(disc_arguments),
                   .groups = {OBJECT_GROUPS},
                   .doc =
                       "Round and flat, without an inside: not for merge, intersection, difference and `clipped_by`."},
    [KIND_TORUS] = {.word = "torus",
                    .what = "a torus",
                    .size = sizeof(TorusDesc),
                    .defaults = &torus_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .arguments = LIST(torus_arguments),
                    .groups = {LIST(torus_properties), OBJECT_GROUPS},
                    .doc = "A ring with a round tube, about y."},
    [KIND_OVUS] = {.word = "ovus",
                   .what = "an ovus",
                   .size = sizeof(OvusDesc),
                   .defaults = &ovus_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .arguments = LIST(ovus_arguments),
                   .groups = {LIST(torus_properties), OBJECT_GROUPS},
                   .doc = "An egg: two balls and the arc about y that touches both; a top of twice the bottom radius is a ball."},
    [KIND_QUADRIC] = {.word = "quadric",
                      .what = "a quadric",
                      .size = sizeof(PolynomialDesc),
                      .defaults = &quadric_defaults,
                      .is_object = true,
                      .is_declarable = true,
                      .arguments = LIST(quadric_arguments),
                      .groups = {OBJECT_GROUPS},
                      .doc = "Where a polynomial of order 2 is 0: ellipsoids, cones, paraboloids; inside where it is "
                             "less."},
    [KIND_CUBIC] = {.word = "cubic",
                    .what = "a cubic",
                    .size = sizeof(PolynomialDesc),
                    .defaults = &cubic_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .arguments = LIST(cubic_arguments),
                    .groups = {LIST(torus_properties), OBJECT_GROUPS},
                    .doc = "The same of order 3, which has 20 coefficients."},
    [KIND_QUARTIC] = {.word = "quartic",
                      .what = "a quartic",
                      .size = sizeof(PolynomialDesc),
                      .defaults = &quartic_defaults,
                      .is_object = true,
                      .is_declarable = true,
                      .arguments = LIST(cubic_arguments),
                      .groups = {LIST(torus_properties), OBJECT_GROUPS},
                      .doc = "The same of order 4, which has 35 coefficients."},
    [KIND_POLY] = {.word = "poly",
                   .what = "a poly",
                   .size = sizeof(PolynomialDesc),
                   .defaults = &poly_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .arguments = LIST(poly_arguments),
                   .groups = {LIST(torus_properties), OBJECT_GROUPS},
                   .doc = "The same of order n, which has (n + 1)(n + 2)(n + 3) / 6 coefficients."},
    [KIND_POLYNOMIAL] = {.word = "polynomial",
                         .what = "a polynomial",
                         .size = sizeof(PolynomialDesc),
                         .defaults = &poly_defaults,
                         .is_object = true,
                         .is_declarable = true,
                         .arguments = LIST(polynomial_arguments),
                         .groups = {LIST(torus_properties), OBJECT_GROUPS},
                         .doc = "The same, term by term in any order: `xyz(I, J, K): F` is F xⁱ yʲ zᵏ."},
    [KIND_BLOB] = {.word = "blob",
                   .what = "a blob",
                   .size = sizeof(BlobDesc),
                   .defaults = &blob_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .groups = {LIST(blob_properties), OBJECT_GROUPS},
                   .doc = "Where the fields of balls and rods together are as strong as a threshold; inside where they "
                          "are stronger."},
    [KIND_BLOB_BALL] = {.word = "sphere",
                        .inside = "blob",
                        .size = sizeof(BlobPartDesc),
                        .defaults = &blob_part_defaults,
                        .arguments = LIST(blob_ball_arguments),
                        .groups = {LIST(blob_part_properties), LIST(transforms)},
                        .doc = "A component of a blob."},
    [KIND_BLOB_ROD] = {.word = "cylinder",
                       .inside = "blob",
                       .size = sizeof(BlobPartDesc),
                       .defaults = &blob_part_defaults,
                       .arguments = LIST(blob_rod_arguments),
                       .groups = {LIST(blob_part_properties), LIST(transforms)},
                       .doc = "A component of a blob."},
    [KIND_ISOSURFACE] = {.word = "isosurface",
                         .what = "an isosurface",
                         .size = sizeof(IsosurfaceDesc),
                         .defaults = &isosurface_defaults,
                         .is_object = true,
                         .is_declarable = true,
                         .groups = {LIST(isosurface_properties), OBJECT_GROUPS},
                         .doc = "Where a function is at a threshold, within a sphere or box; inside where it is below."},
    [KIND_PARAMETRIC] = {.word = "parametric",
                         .what = "a parametric surface",
                         .size = sizeof(ParametricDesc),
                         .defaults = &parametric_defaults,
                         .is_object = true,
                         .is_declarable = true,
                         .groups = {LIST(parametric_properties), OBJECT_GROUPS},
                         .doc = "Points that three functions of u and v give for x, y and z, over a rectangle; without an inside."},
    [KIND_CONTAINED_BY] = {.word = "contained_by",
                           .size = sizeof(ContainerDesc),
                           .defaults = &container_defaults,
                           .groups = {LIST(contained_by_properties)},
                           .doc = "What an isosurface or a parametric surface lies in."},
    [KIND_CONTAINER_BALL] = {.word = "sphere",
                             .inside = "contained_by",
                             .size = sizeof(ContainerDesc),
                             .defaults = &container_defaults,
                             .arguments = LIST(container_ball_arguments),
                             .doc = "A ball that contains an isosurface or a parametric surface."},
    [KIND_CONTAINER_BOX] = {.word = "box",
                            .inside = "contained_by",
                            .size = sizeof(ContainerDesc),
                            .defaults = &container_defaults,
                            .arguments = LIST(container_box_arguments),
                            .doc = "A box that contains an isosurface or a parametric surface."},
    [KIND_PRISM] = {.word = "prism",
                    .what = "a prism",
                    .size = sizeof(PrismDesc),
                    .defaults = &prism_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .groups = {LIST(prism_properties), OBJECT_GROUPS},
                    .doc = "Words for curve and sweep, two heights, the number of points, the points: outlines in x "
                           "and z."},
    [KIND_POLYGON] = {.word = "polygon",
                      .what = "a polygon",
                      .size = sizeof(PolygonDesc),
                      .defaults = &polygon_defaults,
                      .is_object = true,
                      .is_declarable = true,
                      .groups = {OBJECT_GROUPS},
                      .doc = "The number of points, the points: outlines in one plane."},
    [KIND_LATHE] = {.word = "lathe",
                    .what = "a lathe",
                    .size = sizeof(LatheDesc),
                    .defaults = &lathe_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .groups = {LIST(torus_properties), OBJECT_GROUPS},
                    .doc =
                        "A word for the curve, the number of points, the points: a curve in x and y, turned about y."},
    [KIND_SOR] = {.word = "sor",
                  .what = "a sor",
                  .size = sizeof(SorDesc),
                  .defaults = &sor_defaults,
                  .is_object = true,
                  .is_declarable = true,
                  .groups = {LIST(sor_properties), OBJECT_GROUPS},
                  .doc = "The number of points, the points, of radius and height: a radius for each height, turned "
                         "about y."},
    [KIND_SUPERELLIPSOID] = {.word = "superellipsoid",
                             .what = "a superellipsoid",
                             .size = sizeof(SuperellipsoidDesc),
                             .defaults = &superellipsoid_defaults,
                             .is_object = true,
                             .is_declarable = true,
                             .groups = {OBJECT_GROUPS},
                             .doc = "`<e, n>`: where (|x|^(2/e) + |y|^(2/e))^(e/n) + |z|^(2/n) is less than 1."},
    [KIND_SPHERE_SWEEP] =
        {.word = "sphere_sweep",
         .what = "a sphere sweep",
         .size = sizeof(SweepDesc),
         .defaults = &sweep_defaults,
         .is_object = true,
         .is_declarable = true,
         .groups = {LIST(sweep_properties), OBJECT_GROUPS},
         .doc = "A word for the curve, the number of balls, the middle and radius of each: all that a ball "
                "covers."},
    [KIND_JULIA_FRACTAL] = {.word = "julia_fractal",
                            .what = "a Julia fractal",
                            .size = sizeof(JuliaDesc),
                            .defaults = &julia_defaults,
                            .is_object = true,
                            .is_declarable = true,
                            .groups = {LIST(julia_properties), OBJECT_GROUPS},
                            .doc = "A parameter p of 4 numbers: points whose orbit h, f(h) + p, … stays in a ball."},
    [KIND_TEXT] = {.word = "text",
                   .what = "a text",
                   .size = sizeof(UnionDesc),
                   .defaults = &union_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .groups = {OBJECT_GROUPS},
                   .doc = "`ttf` and the name of a font, a string, how thick it is, how much farther apart letters "
                          "stand: a union of prisms."},
    [KIND_TRIANGLE] = {.word = "triangle",
                       .what = "a triangle",
                       .size = sizeof(TriangleDesc),
                       .defaults = &triangle_defaults,
                       .is_object = true,
                       .is_declarable = true,
                       .arguments = LIST(triangle_arguments),
                       .groups = {OBJECT_GROUPS},
                       .doc = "Flat, without an inside: not for merge, intersection, difference and `clipped_by`."},
    [KIND_SMOOTH_TRIANGLE] = {.word = "smooth_triangle",
                              .what = "a smooth triangle",
                              .size = sizeof(SmoothTriangleDesc),
                              .defaults = &smooth_triangle_defaults,
                              .is_object = true,
                              .is_declarable = true,
                              .arguments = LIST(smooth_triangle_arguments),
                              .groups = {OBJECT_GROUPS},
                              .doc = "A triangle that is lit as if its normal went over from corner to corner."},
    [KIND_MESH] = {.word = "mesh",
                   .what = "a mesh",
                   .size = sizeof(MeshDesc),
                   .defaults = &mesh_defaults,
                   .is_object = true,
                   .is_declarable = true,
                   .groups = {LIST(mesh_properties), OBJECT_GROUPS},
                   .doc = "Triangles and smooth triangles, which stand first, as one object: see \"Meshes\"."},
    [KIND_MESH2] = {.word = "mesh2",
                    .what = "a mesh",
                    .size = sizeof(MeshDesc),
                    .defaults = &mesh_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .groups = {LIST(mesh_properties), OBJECT_GROUPS},
                    .doc = "The same by lists of corners and faces, which stand first: see \"Meshes\"."},
    [KIND_HEIGHT_FIELD] = {.word = "height_field",
                           .what = "a height field",
                           .size = sizeof(MeshDesc),
                           .defaults = &mesh_defaults,
                           .is_object = true,
                           .is_declarable = true,
                           .groups = {LIST(height_field_properties), OBJECT_GROUPS},
                           .doc = "A picture, or `function` with two numbers and `{ … }`: heights over x "
                                  "and z from 0 to 1; see \"Height fields\"."},
    [KIND_BICUBIC_PATCH] = {.word = "bicubic_patch",
                            .what = "a bicubic patch",
                            .size = sizeof(PatchDesc),
                            .defaults = &patch_defaults,
                            .is_object = true,
                            .is_declarable = true,
                            .groups = {OBJECT_GROUPS},
                            .doc = "`type`, `flatness`, `u_steps` and `v_steps` with numbers, then four rows of four "
                                   "points; see \"Meshes\"."},
    [KIND_UNION] = {.word = "union",
                    .what = "a union",
                    .size = sizeof(UnionDesc),
                    .defaults = &union_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .groups = {LIST(union_properties), OBJECT_GROUPS},
                    .doc = "Objects first, then what holds for all of them. Its texture is for those that have none."},
    [KIND_MERGE] = {.word = "merge",
                    .what = "a merge",
                    .size = sizeof(UnionDesc),
                    .defaults = &union_defaults,
                    .is_object = true,
                    .is_declarable = true,
                    .groups = {LIST(union_properties), OBJECT_GROUPS},
                    .doc = "A union without the surfaces inside of it."},
    [KIND_INTERSECTION] = {.word = "intersection",
                           .what = "an intersection",
                           .size = sizeof(UnionDesc),
                           .defaults = &union_defaults,
                           .is_object = true,
                           .is_declarable = true,
                           .groups = {OBJECT_GROUPS},
                           .doc = "What is inside of all its objects."},
    [KIND_DIFFERENCE] = {.word = "difference",
                         .what = "a difference",
                         .size = sizeof(UnionDesc),
                         .defaults = &union_defaults,
                         .is_object = true,
                         .is_declarable = true,
                         .groups = {OBJECT_GROUPS},
                         .doc = "What is inside of the first object and of none of the others."},
    [KIND_LIGHT_GROUP] = {.word = "light_group",
                          .what = "a light group",
                          .size = sizeof(UnionDesc),
                          .defaults = &light_group_defaults,
                          .is_object = true,
                          .is_declarable = true,
                          .groups = {LIST(light_group_properties), TRANSFORMS},
                          .doc = "Lights and objects, which these light, and no others."},
    [KIND_OBJECT] = {.word = "object",
                     .what = "an object",
                     .size = sizeof(UnionDesc),
                     .defaults = &union_defaults,
                     .is_object = true,
                     .is_declarable = true,
                     .groups = {OBJECT_GROUPS},
                     .doc = "One object, or the name of one, and how this copy differs."},
    [KIND_BACKGROUND] = {.word = "background",
                         .what = "a background",
                         .size = sizeof(BackgroundDesc),
                         .defaults = &background_defaults,
                         .arguments = LIST(background_arguments),
                         .doc = "The last one counts."},
    [KIND_SKY_SPHERE] = {.word = "sky_sphere",
                         .size = sizeof(SkySphereDesc),
                         .defaults = &sky_sphere_defaults,
                         .is_declarable = true,
                         .groups = {LIST(sky_sphere_properties), TRANSFORMS},
                         .doc = "Seen where nothing is hit, before the background. The last one counts."},
    [KIND_FOG] = {.word = "fog",
                  .size = sizeof(FogDesc),
                  .defaults = &fog_defaults,
                  .is_declarable = true,
                  .arguments = LIST(fog_arguments),
                  .groups = {LIST(fog_properties), TRANSFORMS},
                  .doc = "There may be several. Transforms turn `up`."},
    [KIND_RAINBOW] = {.word = "rainbow",
                      .size = sizeof(RainbowDesc),
                      .defaults = &rainbow_defaults,
                      .groups = {LIST(rainbow_properties)},
                      .doc = "There may be several; fog lies before them."},
    [KIND_GLOBAL_SETTINGS] = {.word = "global_settings",
                              .what = "global settings",
                              .size = sizeof(SettingsDesc),
                              .defaults = &settings_defaults,
                              .groups = {LIST(settings_properties)},
                              .doc = "Holds for the whole scene, wherever it stands."},
    [KIND_TEXTURE] = {.word = "texture",
                      .what = "a texture",
                      .size = sizeof(TextureDesc),
                      .defaults = &texture_defaults,
                      .is_declarable = true,
                      .groups = {LIST(texture_properties), PATTERNS, TRANSFORMS},
                      .doc = "A pigment, bumps and a finish, or textures by a pattern."},
    [KIND_PIGMENT] = {.word = "pigment",
                      .what = "a pigment",
                      .size = sizeof(PigmentDesc),
                      .defaults = &pigment_defaults,
                      .is_declarable = true,
                      .arguments = LIST(pigment_arguments),
                      .groups = {LIST(pigment_properties), PATTERNS, TRANSFORMS},
                      .doc = "The colour of a surface and how much light it lets through."},
    [KIND_NORMAL] = {.word = "normal",
                     .what = "a normal",
                     .size = sizeof(NormalDesc),
                     .defaults = &normal_defaults,
                     .is_declarable = true,
                     .arguments = LIST(normal_arguments),
                     .groups = {LIST(normal_properties), PATTERNS, TRANSFORMS},
                     .doc = "Bumps: a pattern turns the surface's normal, not the surface."},
    [KIND_FINISH] = {.word = "finish",
                     .what = "a finish",
                     .size = sizeof(FinishDesc),
                     .defaults = &finish_defaults,
                     .is_declarable = true,
                     .groups = {LIST(finish_properties)},
                     .doc = "What a surface does with light."},
    [KIND_COLOUR_MAP] =
        {.word = "color_map",
         .what = "a map of colours",
         .size = sizeof(PatternMap),
         .defaults = &map_defaults,
         .is_declarable = true,
         .doc = "`[value colour]` or `[value value colour colour]`, values rising from 0 to 1. Also written "
                "`colour_map`."},
    [KIND_PIGMENT_MAP] = {.word = "pigment_map",
                          .what = "a map of pigments",
                          .size = sizeof(PatternMap),
                          .defaults = &map_defaults,
                          .is_declarable = true,
                          .doc = "`[value pigment]`, the pigment being what may stand in `pigment { }`."},
    [KIND_TEXTURE_MAP] = {.word = "texture_map",
                          .what = "a map of textures",
                          .size = sizeof(PatternMap),
                          .defaults = &map_defaults,
                          .is_declarable = true,
                          .doc = "`[value texture]`, the texture being what may stand in `texture { }`."},
    [KIND_IMAGE_MAP] =
        {.word = "image_map",
         .size = sizeof(ImageDesc),
         .defaults = &image_defaults,
         .groups = {LIST(picture_properties), LIST(image_properties)},
         .doc = "In a pigment: a picture from a file. Its type may be left out where the ending of its name says it."},
    [KIND_IMAGE_PATTERN] = {.word = "image_pattern",
                            .what = "an image_pattern",
                            .size = sizeof(ImageDesc),
                            .defaults = &image_defaults,
                            .groups = {LIST(picture_properties), LIST(image_pattern_properties)},
                            .doc =
                                "In what has a pattern: how bright a picture is, whose values are taken as they are."},
    [KIND_BUMP_MAP] = {.word = "bump_map",
                       .what = "a bump_map",
                       .size = sizeof(ImageDesc),
                       .defaults = &image_defaults,
                       .groups = {LIST(picture_properties), LIST(bump_map_properties)},
                       .doc = "In a normal: how bright a picture is, as heights."},
    [KIND_MATERIAL_MAP] = {.word = "material_map",
                           .what = "a material_map",
                           .size = sizeof(ImageDesc),
                           .defaults = &image_defaults,
                           .groups = {LIST(picture_properties), LIST(material_map_properties)},
                           .doc = "In a texture: a picture that numbers textures, by its palette or its red."},
    [KIND_NORMAL_MAP] = {.word = "normal_map",
                         .what = "a map of normals",
                         .size = sizeof(PatternMap),
                         .defaults = &map_defaults,
                         .is_declarable = true,
                         .doc = "`[value normal]`, the normal being what may stand in `normal { }`."},
    [KIND_SLOPE_MAP] = {.word = "slope_map",
                        .what = "a slope map",
                        .size = sizeof(PatternMap),
                        .defaults = &map_defaults,
                        .is_declarable = true,
                        .doc = "`[value <height, slope>]`, values rising from 0 to 1."},
    [KIND_INTERIOR] = {.word = "interior",
                       .what = "an interior",
                       .size = sizeof(InteriorDesc),
                       .defaults = &interior_defaults,
                       .is_declarable = true,
                       .groups = {LIST(interior_properties)},
                       .doc = "What a shape is filled with: rays are bent at its surface and fade inside."},
    [KIND_MATERIAL] = {.word = "material",
                       .what = "a material",
                       .size = sizeof(MaterialDesc),
                       .defaults = &material_defaults,
                       .is_declarable = true,
                       .groups = {LIST(material_properties), TRANSFORMS},
                       .doc = "A texture and an interior in one."},
    [KIND_CLIPPED_BY] = {.word = "clipped_by",
                         .what = "a clipped_by",
                         .size = sizeof(UnionDesc),
                         .defaults = &union_defaults,
                         .groups = {TRANSFORMS},
                         .doc =
                             "In an object: solids without textures, or their names, and transforms of all of them; or "
                             "the word `bounded_by`."},
    [KIND_BOUNDED_BY] = {.word = "bounded_by",
                         .what = "a bounded_by",
                         .size = sizeof(UnionDesc),
                         .defaults = &union_defaults,
                         .groups = {TRANSFORMS},
                         .doc = "In an object: likewise, or the word `clipped_by`."},
    [KIND_LOOKS_LIKE] =
        {.word = "looks_like",
         .what = "a looks_like",
         .size = sizeof(UnionDesc),
         .defaults = &union_defaults,
         .groups = {OBJECT_GROUPS},
         .doc = "In a light: one object, or the name of one, put where the light is, and then how this copy differs."},
    [KIND_REFLECTION] = {.word = "reflection",
                         .what = "a reflection",
                         .size = sizeof(FinishDesc),
                         .defaults = &finish_defaults,
                         .arguments = LIST(reflection_arguments),
                         .groups = {LIST(reflection_properties)},
                         .doc = "In a finish: the mirror."},
    [KIND_IRID] = {.word = "irid",
                   .what = "an irid",
                   .size = sizeof(FinishDesc),
                   .defaults = &finish_defaults,
                   .arguments = LIST(irid_arguments),
                   .groups = {LIST(irid_properties)},
                   .doc = "In a finish: the colours of a thin layer."},
    [KIND_TRANSFORM] = {.word = "transform",
                        .what = "a transform",
                        .size = sizeof(TransformDesc),
                        .defaults = &transform_defaults,
                        .is_declarable = true,
                        .groups = {LIST(transform_properties), TRANSFORMS},
                        .doc = "Transforms in the order in which they are written."},
    [KIND_WARP] = {.word = "warp",
                   .what = "a warp",
                   .size = sizeof(WarpDesc),
                   .defaults = &warp_defaults,
                   .groups = {LIST(warp_properties)},
                   .doc = "In what has a pattern: one of `turbulence`, `repeat`, `black_hole` and the mappings."},
    [KIND_SLOPE] = {.word = "slope",
                    .what = "a slope",
                    .size = sizeof(SlopeDesc),
                    .defaults = &slope_defaults,
                    .arguments = LIST(slope_arguments),
                    .groups = {LIST(slope_properties)},
                    .doc = "In what has a pattern: how a surface lies."},
    [KIND_PATTERN] = {.word = "pattern",
                      .what = "a pattern",
                      .size = sizeof(PatternPart),
                      .defaults = &pattern_defaults,
                      .groups = {PATTERNS, TRANSFORMS},
                      .doc = "In a function: one of the patterns, without what lies along it."},
    [KIND_UNSUPPORTED] = {.word = "",
                          .what = "something that is not supported",
                          .size = sizeof(UnsupportedDesc),
                          .defaults = &unsupported_defaults,
                          .doc = ""},
};

static const SchemaUnsupported unsupported[] = {
    {"media", true, NULL, "smoke, dust and fire, and their light"},
    {"normal", false, NULL, NULL},
    {"gif", false, "save the picture as PNG", NULL},
    {"iff", false, "save the picture as PNG", NULL},
    {"sys", false, "POV-Ray does not read it here either: save the picture as PNG", NULL},
    {"use_index", false, NULL, NULL},
    {"dispersion", false, NULL, "the colours into which glass parts light"},
    {"photons", false, NULL, "light that mirrors and lenses gather"},
    {"radiosity", false, NULL, "light that surfaces throw on one another"},
    {"subsurface", false, NULL, "light that comes back from below a surface"},
};

const SchemaBlock *schema_kind(SchemaKind kind)
{
    return &kinds[kind];
}

const SchemaProperty *schema_property(SchemaKind kind, size_t index)
{
    for (size_t group = 0; group < SCHEMA_GROUPS; group++) {
        const SchemaList *list = &kinds[kind].groups[group];
        if (index < list->count) {
            return &list->items[index];
        }
        index -= list->count;
    }
    return NULL;
}

bool schema_is_transform(const SchemaProperty *property)
{
    return property >= transforms && property < transforms + RT_COUNT_OF(transforms);
}

const SchemaUnsupported *schema_unsupported(size_t index)
{
    return index < RT_COUNT_OF(unsupported) ? &unsupported[index] : NULL;
}

const char *schema_type_need(SchemaType type)
{
    static const char *const needs[] = {
        [TYPE_FLAG] = "nothing",
        [TYPE_SWITCH] = "a truth value",
        [TYPE_NUMBER] = "a number",
        [TYPE_OPTIONAL_NUMBER] = "a number",
        [TYPE_SHARE] = "a number",
        [TYPE_SHARE_PAIR] = "a number",
        [TYPE_INTEGER] = "a number",
        [TYPE_VECTOR] = "a vector",
        [TYPE_NUMBERS] = "numbers in <>",
        [TYPE_COLOUR] = "a colour",
        [TYPE_RGB] = "a colour",
        [TYPE_BLOCK] = "braces",
        [TYPE_ACTION] = "a value",
    };
    return needs[type];
}
