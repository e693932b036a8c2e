// The renderer: a scene becomes a film of linear light.
//
// prepared_new turns scene records into everything that rays need, once: lengths scaled by an exact power of two,
// geometry built, materials and lights reduced to what shading uses, and the smallest kernel chosen that covers the
// scene's features. render_film then traces tiles on all threads. Same scene and size, same bits: for any number of
// threads and any order of tiles. Knows nothing of the language or of files.
//
// SPDX-License-Identifier: MIT
#ifndef RENDER_RENDER_H
#define RENDER_RENDER_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "render/filter.h"
#include "render/sampler.h"
#include "render/tile_share.h"
#include "scene/scene.h"
#include "trace/trace.h"

typedef struct Prepared Prepared;

// What is left of a valid scene for rendering; refers to the scene, which must outlive it. The options say how geometry
// is prepared and traced. NULL when out of memory.
Prepared *prepared_new(const Scene *scene, const GeometryOptions *options) RT_MUST_CHECK;
void prepared_free(Prepared *prepared);
// Other numbers for the `jitter` of area lights, 0 being those of the beginning.
void prepared_seed(Prepared *prepared, uint64_t seed);
// Films get FILM_BACKGROUND from here on.
void prepared_want_alpha(Prepared *prepared);

// Name of the kernel that was chosen, for example "spheres+shadows".
const char *prepared_kernel_name(const Prepared *prepared);
// The TraceFeature and RenderFeature bits (trace/trace.h, render/kernel.h) that the scene needs.
unsigned prepared_features(const Prepared *prepared);
size_t prepared_geometry_bytes(const Prepared *prepared);

// What a pixel's samples say of its error, in linear light, as mean squares over its three values. Each is the square
// of how far two sets of samples are apart, times the product of their shares: if sets were independent, the variance
// of the mean of both.
typedef struct PixelRecord {
    uint32_t count; // samples taken; 0: nothing is known
    float outer;    // the two halves of all samples
    float inner;    // the mean over the halves of each: of its own halves
    float fresh;    // the halves of the half that was taken last
    float spread;   // the samples themselves, from their mean
} PixelRecord;

// What a film may keep of each pixel beside its light. The first belongs to the light, over all rays of the pixel; the
// others are of the first surface that the ray through the pixel's middle meets (without a lens and samples: a mean of
// depths or of numbers of objects is none), in the scene's lengths.
typedef enum FilmPlane {
    FILM_BACKGROUND, // the share of what is behind the scene, which is not in the light: 1 - alpha
    FILM_DEPTH,      // distance from the ray's start; infinity where it meets nothing
    FILM_NORMAL,     // x, y, z: unit normal without bumps, on the side that is seen; 0 where nothing is
    FILM_OBJECT,     // a uint32_t: the object's place in the order of declaration, from 1; 0: nothing
    FILM_ALBEDO,     // red, green, blue: the colour of the pigment as far as it is opaque, through the layers above
    FILM_PLANES,
} FilmPlane;
enum { FILM_SURFACE_PLANES = 1u << FILM_DEPTH | 1u << FILM_NORMAL | 1u << FILM_OBJECT | 1u << FILM_ALBEDO };

// The numbers of a pixel in a plane, of 4 bytes each.
static inline int film_plane_channels(FilmPlane plane)
{
    return plane == FILM_NORMAL || plane == FILM_ALBEDO ? 3 : 1;
}

// A picture in the scene's working space, or a part of one: rows from the top, pixels from the left, red green blue
// each.
typedef struct Film {
    int width, height;
    int left, top, whole_width, whole_height; // where it lies in the whole picture, and how large that is
    float *rgb;                               // width * height * 3; owned
    void *planes[FILM_PLANES];                // width * height of each that is wanted, else NULL; owned
    PixelRecord *records;                     // width * height, after sampling; else NULL; owned
} Film;

// With planes of the bits 1 << FilmPlane. False when out of memory; cleared to 0.
bool film_init(Film *film, int width, int height, unsigned planes) RT_MUST_CHECK;
void film_fini(Film *film);

// NULL where that plane is not wanted.
static inline float *film_background(const Film *film)
{
    return film->planes[FILM_BACKGROUND];
}

// Makes the film a part of a greater picture; it is the same pixels then as there. The part lies within.
void film_put(Film *film, int left, int top, int whole_width, int whole_height);

// Where in the whole picture a place beside the middle of a column or row of the film is: u and v of render/camera.h.
static inline double film_u(const Film *film, int x, double aside)
{
    return (film->left + x + 0.5 + aside) / film->whole_width - 0.5;
}

static inline double film_v(const Film *film, int y, double aside)
{
    return (film->top + y + 0.5 + aside) / film->whole_height - 0.5;
}

// The bytes of a film and of what is needed beside it.
uint64_t film_bytes(int width, int height, bool is_sampled, unsigned planes);

// The bytes of the lists of small shapes that a sampled film may need, of so many shapes in all.
uint64_t small_bytes(int width, int height, uint64_t shapes);

// Those of the strata of pixels that edges of spheres cross, of so many shapes in all.
uint64_t share_bytes(int width, int height, uint64_t shapes);

typedef struct RenderStatistics {
    uint64_t camera_rays, shadow_rays, reflected_rays, transmitted_rays;
    // Shares of camera rays, in units of 2^-32, that were not followed: beyond max_trace_level, below adc_bailout.
    uint64_t cut_by_level, cut_by_weight;
} RenderStatistics;

// Where a pixel has enough: its mean is taken to be no farther off than the root of `variance`, with a probability of
// `confidence`. Then `samples` is the most that a pixel gets.
typedef struct SamplingStop {
    double variance;   // in the scene's working space; 0: all samples are taken
    double confidence; // between 0 and 1
    int least;         // samples of a pixel
} SamplingStop;

static inline bool stop_is_wanted(const SamplingStop *stop)
{
    return stop->variance > 0.0;
}

// Several rays a pixel; docs/sampling.md tells of the method.
typedef struct SamplingOptions {
    SamplerKind sampler;
    FilterKind filter;
    uint64_t seed;
    double samples;      // a pixel, >= 2, a whole number unless adaptive; or 0: as many as the goals want
    bool is_adaptive;    // more where the error is; `samples` is then the mean. Goals need it
    double target_error; // root mean square, in linear light; 0: none
    double time_limit;   // seconds; 0: none
    bool has_no_estimate; // the same picture without its error
    SamplingStop stop;    // of pixels; not with is_adaptive
    bool no_pixel_errors; // render_pixel_error is not asked for: of a large picture some pixels tell of the error
} SamplingOptions;

// POV-Ray's ways to take more rays where colours differ; see render/antialias.h.
typedef struct AntialiasOptions {
    int method;       // 1: more rays in pixels that differ from a neighbour, 2: squares whose corners differ, parted
    int depth;        // 1 to 9. Method 1: its square is how many more rays; 2: squares are parted one time less
    double threshold; // >= 0, of the sum of the differences of red, green and blue
    double gamma;     // > 0; colours are compared after their 1/gamma-th power
} AntialiasOptions;

// Why a sampled run ended.
typedef enum SamplingEnd { SAMPLING_DONE, SAMPLING_TARGET, SAMPLING_TIME, SAMPLING_INTERRUPTED } SamplingEnd;

// Of what is no more than a few pixels wide and can be seen, what no sample of any pixel met.
enum { SMALL_SHAPE, SMALL_HIGHLIGHT, SMALL_KINDS };
typedef struct UnmetShapes {
    double count, area; // the second in pixels
} UnmetShapes;

// The error of a picture: what sampling leaves, not what its model or its arithmetic do.
typedef struct SamplingError {
    bool is_known;
    double rmse, low, high; // root mean square, linear light, and the ends of its 95 % interval
    double samples;         // a pixel, in the mean
    double slope;           // of the logarithm of rmse in that of samples, as it is taken to continue; < 0
    double pixel_scale;     // of render_pixel_error, so that its mean square is that of rmse
    UnmetShapes unmet[SMALL_KINDS]; // what they would bring is in the error
    bool unmet_is_all;      // they were counted; else there are about so many
    // A detail of whatever kind that samples may have missed in a pixel: its area in pixels at the most, with 95 %, and the
    // rmse that it would bring, were it the picture's whole range from what is around it.
    double missed_area, missed_error;
    double bias;            // what rays that were not followed would add at the least; more samples do not help
    double bias_by_level;   // of it: beyond max_trace_level; the rest is below adc_bailout
    SamplingEnd end;
} SamplingError;

typedef struct RenderProgress {
    double done;                // 0 to 1, of the run, or of what is predicted of it
    const SamplingError *error; // NULL: one ray a pixel
    double seconds_left;        // predicted; < 0: not known
} RenderProgress;

typedef struct RenderOptions {
    int threads; // >= 1; as many are used as there are tiles to share
    // Called now and then by one thread at a time. May be NULL.
    void (*progress)(void *client, const RenderProgress *progress);
    void *client;
    const atomic_bool *cancel;       // when it turns true, work stops soon; may be NULL
    const SamplingOptions *sampling; // NULL: one ray through the middle of each pixel, area lights as grids
    const AntialiasOptions *antialias; // without `sampling`: more rays where needed; NULL: none
    const TileShare *share;            // NULL: all tiles are traced here
} RenderOptions;

typedef enum RenderResult {
    RENDER_OK,
    RENDER_CANCELLED,
    RENDER_NO_MEMORY,
    RENDER_NOT_SHARED, // TILE_SHARE_BROKEN
} RenderResult;

// `error` is set when options->sampling is, and a cancelled run then leaves a picture, if each pixel has a sample
// (error->samples > 0).
RenderResult render_film(const Prepared *prepared, const RenderOptions *options, Film *film,
                         RenderStatistics *statistics, SamplingError *error) RT_MUST_CHECK;

// Fills those of FILM_SURFACE_PLANES that the film has. Its rays are not counted.
RenderResult render_surface_planes(const Prepared *prepared, const RenderOptions *options, Film *film) RT_MUST_CHECK;

// What a pixel of a sampled film is off by, root mean square in linear light, by its own samples.
double render_pixel_error(const Film *film, const SamplingError *error, size_t pixel);

// How many processors this process may use.
int render_default_threads(void);

#endif
