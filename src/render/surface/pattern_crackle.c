// Crackle: how far the nearest of the sites are, of which each unit cube has one.
//
// Turns a point into a number; owns constant data only. The formulas are POV-Ray's, found by experiment;
// docs/language.md, "Noise".
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/surface/pattern_noise.h"

enum { REACH = 2, AXIS = 2 * REACH + 1 }; // cubes up to two away may hold one of the three nearest

// Those beside come before those that are farther, which are seldom looked into.
static const int order[AXIS] = {0, -1, 1, -2, 2};

// The nearest sites, nearest first.
typedef struct Nearest {
    double way[3];
    Vec3 site; // the nearest of all
} Nearest;

static inline void keep_nearest(Nearest *nearest, double way, Vec3 site)
{
    if (!(way < nearest->way[2])) {
        return;
    }
    if (way < nearest->way[0]) {
        nearest->site = site;
        nearest->way[2] = nearest->way[1];
        nearest->way[1] = nearest->way[0];
        nearest->way[0] = way;
    } else if (way < nearest->way[1]) {
        nearest->way[2] = nearest->way[1];
        nearest->way[1] = way;
    } else {
        nearest->way[2] = way;
    }
}

// How far p is from the unit cube that begins at `corner` by one coordinate.
static inline double gap(double p, double corner)
{
    double before = corner - p, behind = p - corner - 1.0;
    return before > 0.0 ? before : behind > 0.0 ? behind : 0.0;
}

// ---- any metric

// For a metric m (|x|^m + |y|^m + |z|^m + |offset|^m)^(1/m).
static double length_of(const Pattern *pattern, Vec3 way)
{
    double m = pattern->metric, x = fabs(way.x), y = fabs(way.y), z = fabs(way.z), w = fabs(pattern->offset);
    if (m == 2.0) {
        return sqrt(x * x + y * y + z * z + w * w);
    }
    return m == 1.0 ? x + y + z + w : pow(pow(x, m) + pow(y, m) + pow(z, m) + pow(w, m), 1.0 / m);
}

static Nearest find_nearest(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    Nearest nearest = {.way = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .site = p};
    Vec3 centre = vec3(floor(p.x), floor(p.y), floor(p.z));
    for (int i = 0; i < AXIS * AXIS * AXIS; i++) {
        Vec3 corner = vec3_add(centre, vec3(order[i / (AXIS * AXIS)], order[i / AXIS % AXIS], order[i % AXIS]));
        Vec3 least = vec3(gap(p.x, corner.x), gap(p.y, corner.y), gap(p.z, corner.z));
        if (length_of(pattern, least) < nearest.way[2]) {
            Vec3 site = noise_site(source->noise, corner);
            keep_nearest(&nearest, length_of(pattern, vec3_sub(p, site)), site);
        }
    }
    return nearest;
}

// ---- the usual metric, by squares, and nothing computed twice

// What cubes that share a coordinate have in common.
typedef struct Slice {
    double corner, gap; // the square of the gap
    unsigned index;     // of the cube in the table of hashes
} Slice;

static inline void slices_of(double p, double centre, Slice slices[AXIS])
{
    long long number = (long long)centre;
    for (int i = 0; i < AXIS; i++) {
        double corner = centre + order[i], apart = gap(p, corner);
        slices[i] = (Slice){corner, apart * apart, (unsigned)(number + order[i]) & (NOISE_CELLS - 1)};
    }
}

// The cubes about a point, and the square that all ways are longer by.
typedef struct Cubes {
    const Noise *noise;
    Vec3 p;
    Slice x[AXIS], y[AXIS], z[AXIS];
    double offset;
} Cubes;

// The cubes of column i, j from number `begin`.
static inline void look_into(const Cubes *cubes, int i, int j, int begin, int end, Nearest *nearest)
{
    const Noise *noise = cubes->noise;
    const Slice *x = &cubes->x[i], *y = &cubes->y[j], *z = cubes->z;
    unsigned hash = noise->hash[noise->hash[x->index] ^ y->index];
    for (int k = begin; k < end; k++) {
        if (x->gap + y->gap + z[k].gap + cubes->offset < nearest->way[2]) {
            const double *numbers = &noise->sites[noise->hash[hash ^ z[k].index]];
            Vec3 site = vec3_add(vec3(x->corner, y->corner, z[k].corner), vec3(numbers[0], numbers[1], numbers[2]));
            Vec3 way = vec3_sub(cubes->p, site);
            keep_nearest(nearest, way.x * way.x + way.y * way.y + way.z * way.z + cubes->offset, site);
        }
    }
}

static Nearest find_nearest_by_squares(const Noise *noise, Vec3 p, double offset)
{
    Nearest nearest = {.way = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .site = p};
    Cubes cubes = {.noise = noise, .p = p, .offset = offset};
    slices_of(p.x, floor(p.x), cubes.x);
    slices_of(p.y, floor(p.y), cubes.y);
    slices_of(p.z, floor(p.z), cubes.z);
    enum { BESIDE = 3 };
    for (int pass = 0; pass < 2; pass++) {
        int most = pass == 0 ? BESIDE : AXIS;
        for (int i = 0; i < most; i++) {
            for (int j = 0; j < most; j++) {
                bool was_seen = pass == 1 && i < BESIDE && j < BESIDE;
                if (cubes.x[i].gap + cubes.y[j].gap + offset < nearest.way[2]) {
                    look_into(&cubes, i, j, was_seen ? BESIDE : 0, most, &nearest);
                }
            }
        }
        if (nearest.way[2] <= 1.0 + offset) {
            break; // what is farther than beside is farther than 1
        }
    }
    for (int i = 0; i < 3; i++) {
        nearest.way[i] = sqrt(nearest.way[i]);
    }
    return nearest;
}

double pattern_crackle(const Pattern *pattern, const NoiseSource *source, Vec3 p)
{
    static const double largest = 1e15; // cubes beyond have no whole numbers to speak of
    bool is_usual = pattern->metric == 2.0 && vec3_max_abs(p) < largest;
    Nearest nearest = is_usual ? find_nearest_by_squares(source->noise, p, pattern->offset * pattern->offset)
                               : find_nearest(pattern, source, p);
    if (pattern->flags & PATTERN_SOLID) {
        return noise_value(source->noise, pattern_generator(pattern, source), nearest.site);
    }
    double sum = pattern->form.x * nearest.way[0] + pattern->form.y * nearest.way[1] + pattern->form.z * nearest.way[2];
    return fmin(fmax(sum, 0.0), 1.0);
}
