// Noise at points: compiled once for each instruction set, with ISA_NAME the name of the table.
//
// What lies at the lattice points around a point is computed for four coordinates, points or components at once;
// octaves and rows of points go four at a time. Sums run in the order of the lattice points, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#include "math/noise_kernel.h"

#include <math.h>
#include <string.h>

#include "base/attributes.h"
#include "base/isa.h"
#include "math/noise_cell.h"

typedef double Four __attribute__((vector_size(32), aligned(16)));
typedef double FourAnywhere __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t FourMask __attribute__((vector_size(32), aligned(16)));
typedef int32_t FourInts __attribute__((vector_size(16)));

// A point among its eight lattice points: per coordinate, and for the lattice point before it and that after it.
typedef struct Lattice {
    Four way[2], weight[2];
    unsigned hash[2][2][2]; // of the corners, below 256
} Lattice;

// The fraction is that of the coordinate itself; the offset only chooses the hash.
static const unsigned hash_offset = 10000;

// What cell_of says of each coordinate, for those below a limit: floor without a branch, three at once.
RT_ALWAYS_INLINE void find_cells(Vec3 p, Lattice *at, FourInts *before)
{
    Four moved = {p.x, p.y, p.z, 0.0};
    moved += (Four){0.0}; // as cell_of has it: -0 becomes 0
    FourInts number = __builtin_convertvector(moved, FourInts);
    Four below = __builtin_convertvector(number, Four);
    FourMask is_above = below > moved;
    below -= (Four)(is_above & (FourMask)(Four){1.0, 1.0, 1.0, 1.0});
    *before = __builtin_convertvector(below, FourInts);
    Four t = moved - below, weight = t * t * (3.0 - 2.0 * t);
    at->way[0] = t;
    at->way[1] = t - 1.0;
    at->weight[0] = 1.0 - weight;
    at->weight[1] = weight;
}

static void find_far_cells(Vec3 p, Lattice *at, FourInts *before)
{
    const double coordinates[3] = {p.x, p.y, p.z};
    for (int axis = 0; axis < 3; axis++) {
        Cell cell = cell_of(coordinates[axis], 0.0, NOISE_CELLS);
        (*before)[axis] = (int32_t)cell.index[0];
#pragma GCC unroll 2
        for (int i = 0; i < 2; i++) {
            at->way[i][axis] = cell.way[i];
            at->weight[i][axis] = cell.weight[i];
        }
    }
}

RT_ALWAYS_INLINE void find_lattice(const Noise *noise, Vec3 p, Lattice *at)
{
    static const double most = 0x1p30; // below it floors are numbers of 32 bits
    FourInts before = {0};
    if (fabs(p.x) < most && fabs(p.y) < most && fabs(p.z) < most) {
        find_cells(p, at, &before);
    } else {
        find_far_cells(p, at, &before);
    }
    const unsigned x = (unsigned)before[0] + hash_offset, y = (unsigned)before[1] + hash_offset,
                   z = (unsigned)before[2] + hash_offset;
    const unsigned last = NOISE_CELLS - 1;
#pragma GCC unroll 2
    for (unsigned i = 0; i < 2; i++) {
        unsigned of_x = noise->hash[(x + i) & last];
#pragma GCC unroll 2
        for (unsigned j = 0; j < 2; j++) {
            unsigned of_y = noise->hash[of_x ^ ((y + j) & last)];
#pragma GCC unroll 2
            for (unsigned k = 0; k < 2; k++) {
                at->hash[i][j][k] = noise->hash[of_y ^ ((z + k) & last)] & 255;
            }
        }
    }
}

// The four lattice points that share x, in the order of y and z.
typedef struct Side {
    Four way_y, way_z, weight_y, weight_z;
} Side;

RT_ALWAYS_INLINE const FourAnywhere *numbers_at(unsigned hash)
{
    return (const FourAnywhere *)&noise_numbers[hash];
}

// The weighted values of the lattice points of one side.
RT_ALWAYS_INLINE void side_parts(const unsigned hash[2][2], const Side *side, double way_x, double weight_x,
                                 Four *parts)
{
    const Four a = *numbers_at(hash[0][0]), b = *numbers_at(hash[0][1]);
    const Four c = *numbers_at(hash[1][0]), d = *numbers_at(hash[1][1]);
    Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
    Four cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    Four value = 0.5 * __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5) +
                 __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5) * way_x +
                 __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7) * side->way_y +
                 __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7) * side->way_z;
    *parts = weight_x * side->weight_y * side->weight_z * value;
}

// The first component.
RT_ALWAYS_INLINE double component(const Lattice *at)
{
    const Side side = {__builtin_shufflevector(at->way[0], at->way[1], 1, 1, 5, 5),
                       __builtin_shufflevector(at->way[0], at->way[1], 2, 6, 2, 6),
                       __builtin_shufflevector(at->weight[0], at->weight[1], 1, 1, 5, 5),
                       __builtin_shufflevector(at->weight[0], at->weight[1], 2, 6, 2, 6)};
    double sum = 0.0;
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        Four parts;
        side_parts(at->hash[i], &side, at->way[i][0], at->weight[i][0], &parts);
#pragma GCC unroll 4
        for (int k = 0; k < 4; k++) {
            sum += parts[k];
        }
    }
    return sum;
}

// All three components at once, each by the operations of component in their order.
RT_ALWAYS_INLINE Vec3 components(const Noise *noise, const Lattice *at)
{
    Four sum = {0.0};
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++) {
            double weight = at->weight[i][0] * at->weight[j][1];
#pragma GCC unroll 2
            for (int k = 0; k < 2; k++) {
                const Four *row = (const Four *)noise->lattice[at->hash[i][j][k]];
                Four value = 0.5 * row[0] + row[1] * at->way[i][0] + row[2] * at->way[j][1] + row[3] * at->way[k][2];
                sum += weight * at->weight[k][2] * value;
            }
        }
    }
    return vec3(sum[0], sum[1], sum[2]);
}

static double original(const Noise *noise, Vec3 p)
{
    Lattice at;
    find_lattice(noise, p, &at);
    return component(&at);
}

// Perlin's lattice: gradients follow one another along z.
static double perlin(const Noise *noise, Vec3 p)
{
    static const double offset = 10000000.023157213; // as measured, to the last bit
    Cell x = cell_of(p.x, offset, NOISE_GRADIENTS), y = cell_of(p.y, offset, NOISE_GRADIENTS),
         z = cell_of(p.z, offset, NOISE_GRADIENTS);
    double sum = 0.0;
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++) {
            unsigned row = noise->order[(noise->order[x.index[i]] + y.index[j]) % NOISE_GRADIENTS];
#pragma GCC unroll 2
            for (int k = 0; k < 2; k++) {
                Vec3 way = vec3(x.way[i], y.way[j], z.way[k]);
                sum += x.weight[i] * y.weight[j] * z.weight[k] *
                       vec3_dot(noise->gradients[(row + z.index[k]) % NOISE_GRADIENTS], way);
            }
        }
    }
    return sum;
}

static double value_at(const Noise *noise, NoiseGenerator generator, Vec3 p)
{
    switch (generator) {
    case NOISE_PERLIN:
        return noise_cut(0.4925 + 0.795 * perlin(noise, p));
    case NOISE_CORRECTED:
        return noise_cut(0.48985582 * (original(noise, p) + 1.05242));
    default:
        return noise_cut(original(noise, p) + 0.5);
    }
}

static double spread_at(const Noise *noise, NoiseGenerator generator, Vec3 p)
{
    return noise_spread_of(generator, value_at(noise, generator, p));
}

static Vec3 vector_at(const Noise *noise, Vec3 p)
{
    Lattice at;
    find_lattice(noise, p, &at);
    return components(noise, &at);
}

// ---- four points at once

enum { SIDE = 4 };

typedef struct FourPoints {
    Four axis[3];
} FourPoints;

// As Lattice, of each of four points; corners are counted in the order of x, y and z.
typedef struct Lattices {
    Four way[3][2];
    Four weight[8];
    uint8_t hash[SIDE][8];
} Lattices;

RT_ALWAYS_INLINE bool all_are_near(const FourPoints *p)
{
    const Four most = (Four){0.0} + 0x1p30; // as in find_lattice
    FourMask is_near = (p->axis[0] < most) & (p->axis[0] > -most);
#pragma GCC unroll 2
    for (int axis = 1; axis < 3; axis++) {
        is_near &= (p->axis[axis] < most) & (p->axis[axis] > -most);
    }
    return (is_near[0] & is_near[1] & is_near[2] & is_near[3]) != 0;
}

// Of the first `count` points; the others' are set so that something is there.
RT_ALWAYS_INLINE void hash_corners(const Noise *noise, const uint32_t index[3][2][SIDE], unsigned count, Lattices *at)
{
    for (unsigned n = 0; n < count; n++) {
#pragma GCC unroll 2
        for (int i = 0; i < 2; i++) {
            uint32_t of_x = noise->hash[index[0][i][n]];
#pragma GCC unroll 2
            for (int j = 0; j < 2; j++) {
                uint32_t of_y = noise->hash[of_x ^ index[1][j][n]];
#pragma GCC unroll 2
                for (int k = 0; k < 2; k++) {
                    at->hash[n][4 * i + 2 * j + k] = (uint8_t)noise->hash[of_y ^ index[2][k][n]];
                }
            }
        }
    }
    for (unsigned n = count; n < SIDE; n++) {
        memset(at->hash[n], 0, sizeof at->hash[n]);
    }
}

// The operations of find_cells and of the weights of component, a lane a point.
RT_ALWAYS_INLINE void find_lattices(const Noise *noise, const FourPoints *p, unsigned count, Lattices *at)
{
    const FourInts last = (FourInts){0} + (int32_t)(NOISE_CELLS - 1);
    uint32_t index[3][2][SIDE];
    Four weight[3][2];
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
        Four moved = p->axis[axis] + (Four){0.0};
        Four below = __builtin_convertvector(__builtin_convertvector(moved, FourInts), Four);
        FourMask is_above = below > moved;
        below -= (Four)(is_above & (FourMask)(Four){1.0, 1.0, 1.0, 1.0});
        FourInts before = __builtin_convertvector(below, FourInts) + (int32_t)hash_offset;
        FourInts of_before = before & last, of_after = (before + 1) & last;
        memcpy(index[axis][0], &of_before, sizeof of_before);
        memcpy(index[axis][1], &of_after, sizeof of_after);
        Four t = moved - below, after = t * t * (3.0 - 2.0 * t);
        at->way[axis][0] = t;
        at->way[axis][1] = t - 1.0;
        weight[axis][0] = 1.0 - after;
        weight[axis][1] = after;
    }
#pragma GCC unroll 8
    for (int corner = 0; corner < 8; corner++) {
        at->weight[corner] = weight[0][corner >> 2] * weight[1][corner >> 1 & 1] * weight[2][corner & 1];
    }
    hash_corners(noise, index, count, at);
}

// The first component of each.
RT_ALWAYS_INLINE void four_originals(const Lattices *at, Four *values)
{
    Four sum = {0.0};
#pragma GCC unroll 8
    for (int corner = 0; corner < 8; corner++) {
        Four a = *numbers_at(at->hash[0][corner]), b = *numbers_at(at->hash[1][corner]);
        Four c = *numbers_at(at->hash[2][corner]), d = *numbers_at(at->hash[3][corner]);
        Four ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7);
        Four cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
        Four value = 0.5 * __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5) +
                     __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5) * at->way[0][corner >> 2] +
                     __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7) * at->way[1][corner >> 1 & 1] +
                     __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7) * at->way[2][corner & 1];
        sum += at->weight[corner] * value;
    }
    *values = sum;
}

// All components of the point in one lane.
RT_ALWAYS_INLINE void components_of(const Noise *noise, const Lattices *at, unsigned lane, Four *vector)
{
    Four sum = {0.0};
#pragma GCC unroll 8
    for (int corner = 0; corner < 8; corner++) {
        const Four *row = (const Four *)noise->lattice[at->hash[lane][corner]];
        Four value = 0.5 * row[0] + row[1] * at->way[0][corner >> 2][lane] +
                     row[2] * at->way[1][corner >> 1 & 1][lane] + row[3] * at->way[2][corner & 1][lane];
        sum += at->weight[corner][lane] * value;
    }
    *vector = sum;
}

RT_ALWAYS_INLINE void four_cut(Four *values)
{
    const Four x = *values;
    const Four one = {1.0, 1.0, 1.0, 1.0};
    FourMask is_less = x<one, is_some = x>(Four){0.0};
    *values = (Four)(is_some & ((is_less & (FourMask)x) | (~is_less & (FourMask)one)));
}

static Vec3 point_of(const FourPoints *p, unsigned lane)
{
    return vec3(p->axis[0][lane], p->axis[1][lane], p->axis[2][lane]);
}

// As value_at. Lanes from `count` on mean nothing.
RT_ALWAYS_INLINE void four_values(const Noise *noise, NoiseGenerator generator, const FourPoints *p, unsigned count,
                                  Four *values)
{
    if (RT_UNLIKELY(generator == NOISE_PERLIN || !all_are_near(p))) {
        *values = (Four){0.0};
        for (unsigned n = 0; n < count; n++) {
            (*values)[n] = value_at(noise, generator, point_of(p, n));
        }
        return;
    }
    Lattices at;
    Four original;
    find_lattices(noise, p, count, &at);
    four_originals(&at, &original);
    *values = generator == NOISE_CORRECTED ? 0.48985582 * (original + 1.05242) : original + 0.5;
    four_cut(values);
}

// As vector_at, of the first `count`.
RT_ALWAYS_INLINE void four_vectors(const Noise *noise, const FourPoints *p, unsigned count, Four *vectors)
{
    if (RT_UNLIKELY(!all_are_near(p))) {
        for (unsigned n = 0; n < count; n++) {
            Vec3 vector = vector_at(noise, point_of(p, n));
            vectors[n] = (Four){vector.x, vector.y, vector.z, 0.0};
        }
        return;
    }
    Lattices at;
    find_lattices(noise, p, count, &at);
    for (unsigned n = 0; n < count; n++) {
        components_of(noise, &at, n, &vectors[n]);
    }
}

// The next points of a row, as many as there are; lanes behind the last are 0.
static unsigned next_points(const Vec3 *points, unsigned from, unsigned count, FourPoints *p)
{
    unsigned left = count - from < SIDE ? count - from : SIDE;
    *p = (FourPoints){{{0.0}, {0.0}, {0.0}}};
    for (unsigned n = 0; n < left; n++) {
        p->axis[0][n] = points[from + n].x;
        p->axis[1][n] = points[from + n].y;
        p->axis[2][n] = points[from + n].z;
    }
    return left;
}

static void values_at(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *values)
{
    for (unsigned from = 0; from < count; from += SIDE) {
        FourPoints p;
        Four four;
        unsigned left = next_points(points, from, count, &p);
        four_values(noise, generator, &p, left, &four);
        for (unsigned n = 0; n < left; n++) {
            values[from + n] = four[n];
        }
    }
}

static void vectors_at(const Noise *noise, unsigned count, const Vec3 *points, Vec3 *vectors)
{
    for (unsigned from = 0; from < count; from += SIDE) {
        FourPoints p;
        Four four[SIDE];
        unsigned left = next_points(points, from, count, &p);
        four_vectors(noise, &p, left, four);
        for (unsigned n = 0; n < left; n++) {
            vectors[from + n] = vec3(four[n][0], four[n][1], four[n][2]);
        }
    }
}

// ---- sums

// The next four octaves: where they are evaluated and how much they count. Lanes behind the last ones are of no use.
typedef struct OctaveWalk {
    double scale, weight;
} OctaveWalk;

RT_ALWAYS_INLINE void next_octaves(const Octaves *octaves, Vec3 p, OctaveWalk *walk, FourPoints *points, Four *weights)
{
    Four scales;
#pragma GCC unroll 4
    for (int i = 0; i < SIDE; i++) {
        scales[i] = walk->scale;
        (*weights)[i] = walk->weight;
        walk->scale *= octaves->lambda;
        walk->weight *= octaves->omega;
    }
    points->axis[0] = scales * p.x;
    points->axis[1] = scales * p.y;
    points->axis[2] = scales * p.z;
}

RT_ALWAYS_INLINE unsigned octaves_left(const Octaves *octaves, unsigned from)
{
    return octaves->count - from < SIDE ? octaves->count - from : SIDE;
}

// Only the first octave of the spread generators is cut.
static double sum_at(const Noise *noise, NoiseGenerator generator, const Octaves *octaves, Vec3 p)
{
    if (octaves->count == 1) {
        return spread_at(noise, generator, p);
    }
    OctaveWalk walk = {1.0, 1.0};
    double sum = 0.0;
    for (unsigned from = 0; from < octaves->count; from += SIDE) {
        FourPoints points;
        Four weights;
        unsigned count = octaves_left(octaves, from);
        next_octaves(octaves, p, &walk, &points, &weights);
        Four values;
        four_values(noise, generator, &points, count, &values);
        Four spread = generator == NOISE_ORIGINAL ? values : 2.0 * values - 0.5;
        Four parts = weights * spread;
        sum = from == 0 ? (generator == NOISE_ORIGINAL ? spread[0] : noise_cut(spread[0])) : sum + parts[0];
        for (unsigned n = 1; n < count; n++) {
            sum += parts[n];
        }
    }
    return sum;
}

static Vec3 vector_sum_at(const Noise *noise, const Octaves *octaves, Vec3 p)
{
    if (octaves->count == 1) {
        return vector_at(noise, p);
    }
    OctaveWalk walk = {1.0, 1.0};
    Four sum = {0.0};
    for (unsigned from = 0; from < octaves->count; from += SIDE) {
        FourPoints points;
        Four weights, vectors[SIDE] = {{0.0}};
        unsigned count = octaves_left(octaves, from);
        next_octaves(octaves, p, &walk, &points, &weights);
        four_vectors(noise, &points, count, vectors);
        sum = from == 0 ? vectors[0] : sum + weights[0] * vectors[0];
        for (unsigned n = 1; n < count; n++) {
            sum += weights[n] * vectors[n];
        }
    }
    return vec3(sum[0], sum[1], sum[2]);
}

extern const NoiseKernel ISA_NAMED(noise_kernel_);
const NoiseKernel ISA_NAMED(noise_kernel_) = {
    ISA_TEXT, isa_is_supported, value_at, spread_at, vector_at, values_at, vectors_at, sum_at, vector_sum_at,
};
