// Noise at points: compiled once for each instruction set, with SPHERE_KERNELS the name of the table.
//
// What lies at the lattice points around a point is worked out for four coordinates, points or components at once; sums
// run in the order of the points, so the bits are the same.
//
// SPDX-License-Identifier: MIT
#include "math/noise_kernel.h"

#include <math.h>

#include "base/attributes.h"
#include "base/isa.h"
#include "math/noise_cell.h"

typedef double Four __attribute__((vector_size(32), aligned(16)));
typedef double FourAnywhere __attribute__((vector_size(32), aligned(8), may_alias));
typedef int64_t FourMask __attribute__((vector_size(32), aligned(16)));
typedef int32_t FourInts __attribute__((vector_size(16)));

RT_ALWAYS_INLINE double cut(double x)
{
    return x > 0.0 ? x < 1.0 ? x : 1.0 : 0.0;
}

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
                Four value =
                    0.5 * row[0] + row[1] * at->way[i][0] + row[2] * at->way[j][1] + row[3] * at->way[k][2];
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
    case NOISE_PERLIN: return cut(0.4925 + 0.795 * perlin(noise, p));
    case NOISE_CORRECTED: return cut(0.48985582 * (original(noise, p) + 1.05242));
    default: return cut(original(noise, p) + 0.5);
    }
}

static double spread_at(const Noise *noise, NoiseGenerator generator, Vec3 p)
{
    double value = value_at(noise, generator, p);
    return generator == NOISE_ORIGINAL ? value : cut(2.0 * value - 0.5);
}

static Vec3 vector_at(const Noise *noise, Vec3 p)
{
    Lattice at;
    find_lattice(noise, p, &at);
    return components(noise, &at);
}

// ---- sums

// Only the first octave of the spread generators is cut.
static double sum_at(const Noise *noise, NoiseGenerator generator, const Octaves *octaves, Vec3 p)
{
    double sum = spread_at(noise, generator, p), scale = octaves->lambda, weight = octaves->omega;
    for (unsigned i = 1; i < octaves->count; i++) {
        double value = value_at(noise, generator, vec3_scale(scale, p));
        sum += weight * (generator == NOISE_ORIGINAL ? value : 2.0 * value - 0.5);
        scale *= octaves->lambda;
        weight *= octaves->omega;
    }
    return sum;
}

static Vec3 vector_sum_at(const Noise *noise, const Octaves *octaves, Vec3 p)
{
    Vec3 sum = vector_at(noise, p);
    double scale = octaves->lambda, weight = octaves->omega;
    for (unsigned i = 1; i < octaves->count; i++) {
        sum = vec3_add_scaled(sum, weight, vector_at(noise, vec3_scale(scale, p)));
        scale *= octaves->lambda;
        weight *= octaves->omega;
    }
    return sum;
}

extern const NoiseKernel ISA_NAMED(noise_kernel_);
const NoiseKernel ISA_NAMED(noise_kernel_) = {ISA_TEXT, value_at, spread_at, vector_at, sum_at, vector_sum_at};
