// Noise, from tables of hashes and gradients.
//
// Turns points into numbers. The tables are POV-Ray's, computed anew from its random sequence where they come from
// there, else as measured. Owns constant data only.
//
// SPDX-License-Identifier: MIT
#include "math/noise.h"

#include <string.h>

#include "base/attributes.h"
#include "base/isa.h"
#include "math/noise_cell.h"
#include "math/noise_kernel.h"

ISA_LIST(NoiseKernel, noise_kernel_, kernels);

// ---- tables

const double noise_numbers[NOISE_LATTICE + 8] = {
    -1.0, 0.604974, -0.937102, 0.414115, 0.576226, -0.0161593, 0.432334, 0.103685, 0.590539, 0.0286412, 0.46981,
    -0.84622, -0.0734112, -0.304097, -0.40206, -0.210132, -0.919127, 0.652033, -0.83151, -0.183948, -0.671107,
    0.852476, 0.043595, -0.404532, 0.75494, -0.335653, 0.618433, 0.605707, 0.708583, -0.477195, 0.899474, 0.490623,
    0.221729, -0.400381, -0.853727, -0.932586, 0.659113, 0.961303, 0.325948, -0.750851, 0.842466, 0.734401, -0.649866,
    0.394491, -0.466056, -0.434073, 0.109026, 0.0847028, -0.738857, 0.241505, 0.16228, -0.71426, -0.883665, -0.150408,
    -0.90396, -0.686549, -0.785214, 0.488548, 0.0246433, 0.142473, -0.602136, 0.375845, -0.00779736, 0.498955,
    -0.268147, 0.856382, -0.386007, -0.596094, -0.867735, -0.570977, -0.914366, 0.28896, 0.672206, -0.233783, 0.94815,
    0.895262, 0.343252, -0.173388, -0.767971, -0.314748, 0.824308, -0.342092, 0.721431, -0.24004, -0.63653, 0.553277,
    0.376272, 0.158984, -0.452659, 0.396323, -0.420676, -0.454154, 0.122179, 0.295857, 0.0664225, -0.202075,
    -0.724788, 0.453513, 0.224567, -0.908812, 0.176349, -0.320516, -0.697139, 0.742702, -0.900786, 0.471489,
    -0.133532, 0.119127, -0.889769, -0.23183, -0.669673, -0.046891, -0.803433, -0.966735, 0.475578, -0.652644,
    0.0112459, -0.730007, 0.128283, 0.145647, -0.619318, 0.272023, 0.392966, 0.646418, -0.0207675, -0.315908,
    0.480797, 0.535668, -0.250172, -0.83093, -0.653773, -0.443809, 0.119982, -0.897642, 0.89453, 0.165789, 0.633875,
    -0.886839, 0.930877, -0.537194, 0.587732, 0.722011, -0.209461, -0.0424659, -0.814267, -0.919432, 0.280262,
    -0.66302, -0.558099, -0.537469, -0.598779, 0.929656, -0.170794, -0.537163, 0.312581, 0.959442, 0.722652, 0.499931,
    0.175616, -0.534874, -0.685115, 0.444999, 0.17171, 0.108202, -0.768704, -0.463828, 0.254231, 0.546014, 0.869474,
    0.875212, -0.944427, 0.130724, -0.110185, 0.312184, -0.33138, -0.629206, 0.0606546, 0.722866, -0.0979477,
    0.821561, 0.0931258, -0.972808, 0.0318151, -0.867033, -0.387228, 0.280995, -0.218189, -0.539178, -0.427359,
    -0.602075, 0.311971, 0.277974, 0.773159, 0.592493, -0.0331884, -0.630854, -0.269947, 0.339132, 0.581079, 0.209461,
    -0.317433, -0.284993, 0.181323, 0.341634, 0.804959, -0.229572, -0.758907, -0.336721, 0.605463, -0.991272,
    -0.0188754, -0.300191, 0.368307, -0.176135, -0.3832, -0.749569, 0.62356, -0.573938, 0.278309, -0.971313, 0.839994,
    -0.830686, 0.439078, 0.66128, 0.694514, 0.0565042, 0.54342, -0.438804, -0.0228428, -0.687068, 0.857267, 0.301991,
    -0.494255, -0.941039, 0.775509, 0.410575, -0.362081, -0.671534, -0.348379, 0.932433, 0.886442, 0.868681,
    -0.225666, -0.062211, -0.0976425, -0.641444, -0.848112, 0.724697, 0.473503, 0.998749, 0.174701, 0.559625,
    -0.029099, -0.337392, -0.958129, -0.659785, 0.236042, -0.246937, 0.659449, -0.027512, 0.821897, -0.226215,
    0.0181735, 0.500481, -0.420127, -0.427878, 0.566186,
};

// The numbers that follow in POV-Ray's random sequence, of 16 bits.
static unsigned next_random(uint32_t *state)
{
    *state = *state * UINT32_C(1812433253) + UINT32_C(12345);
    return *state >> 16;
}

static void swap(uint16_t *list, unsigned i, unsigned j)
{
    uint16_t was = list[i];
    list[i] = list[j];
    list[j] = was;
}

static void shuffle_hash(uint16_t *hash)
{
    uint32_t state = 0;
    for (unsigned i = 0; i < NOISE_CELLS; i++) {
        hash[i] = (uint16_t)i;
    }
    for (unsigned i = NOISE_CELLS; i-- > 0;) {
        swap(hash, i, next_random(&state) % NOISE_CELLS);
    }
}

// Points of a cube, those outside of the ball left out, pushed to the sphere.
static Vec3 next_gradient(uint32_t *state)
{
    for (;;) {
        double v[3];
        for (int i = 0; i < 3; i++) {
            v[i] = (double)(next_random(state) % (2 * NOISE_GRADIENTS)) / NOISE_GRADIENTS - 1.0;
        }
        Vec3 point = vec3(v[0], v[1], v[2]);
        if (vec3_length_squared(point) <= 1.0) {
            return vec3_normalize(point);
        }
    }
}

// Only every second number is moved, and the first one is swapped with a 0 behind the list, so that it is lost.
static void shuffle_order(uint16_t *order, uint32_t *state)
{
    for (unsigned i = 0; i < NOISE_GRADIENTS; i++) {
        order[i] = (uint16_t)i;
    }
    order[next_random(state) % NOISE_GRADIENTS] = 0;
    for (unsigned i = NOISE_GRADIENTS - 2; i > 0; i -= 2) {
        swap(order, i, next_random(state) % NOISE_GRADIENTS);
    }
}

// The Mersenne twister MT19937 with the seed 5489 that its authors use where none is said (M. Matsumoto, T. Nishimura,
// "Mersenne Twister", ACM TOMACS 8, 1998); fills the list with its numbers over 2^32.
static void fill_sites(double *sites)
{
    enum { WORDS = 624, APART = 397 };
    uint32_t state[WORDS] = {5489};
    for (uint32_t i = 1; i < WORDS; i++) {
        state[i] = UINT32_C(1812433253) * (state[i - 1] ^ (state[i - 1] >> 30)) + i;
    }
    for (unsigned i = 0; i < NOISE_SITES; i++) {
        uint32_t *word = &state[i % WORDS];
        uint32_t both = (*word & UINT32_C(0x80000000)) | (state[(i + 1) % WORDS] & UINT32_C(0x7fffffff));
        *word = state[(i + APART) % WORDS] ^ (both >> 1) ^ (both & 1 ? UINT32_C(0x9908b0df) : 0);
        uint32_t number = *word ^ (*word >> 11);
        number ^= (number << 7) & UINT32_C(0x9d2c5680);
        number ^= (number << 15) & UINT32_C(0xefc60000);
        number ^= number >> 18;
        sites[i] = number * 0x1p-32;
    }
}

static void fill_lattice(Noise *noise)
{
    for (int i = 0; i < NOISE_LATTICE; i++) {
        for (int which = 0; which < 3; which++) {
            noise->lattice[i][which] = noise_numbers[i + 4 * which];
        }
        noise->lattice[i][3] = 0.0;
    }
}

static const NoiseKernel *kernel_choose(const char *isa)
{
    for (size_t i = RT_COUNT_OF(kernels); i-- > 0;) {
        if (isa ? strcmp(isa, kernels[i]->name) == 0 : kernels[i]->is_supported()) {
            return kernels[i];
        }
    }
    return kernels[0];
}

void noise_init(Noise *noise, const char *isa)
{
    noise->kernel = kernel_choose(isa);
    fill_lattice(noise);
    fill_sites(noise->sites);
    uint32_t state = 1;
    shuffle_hash(noise->hash);
    for (unsigned i = 0; i < NOISE_GRADIENTS; i++) {
        noise->gradients[i] = next_gradient(&state);
    }
    shuffle_order(noise->order, &state);
}

NoiseGenerator noise_generator(double number)
{
    return number >= NOISE_PERLIN ? NOISE_PERLIN : number >= NOISE_CORRECTED ? NOISE_CORRECTED : NOISE_ORIGINAL;
}

// ---- at a point

double noise_value(const Noise *noise, NoiseGenerator generator, Vec3 p)
{
    return noise->kernel->value(noise, generator, p);
}

void noise_values(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *values)
{
    noise->kernel->values(noise, generator, count, points, values);
}

double noise_spread(const Noise *noise, NoiseGenerator generator, Vec3 p)
{
    return noise->kernel->spread(noise, generator, p);
}

void noise_spreads(const Noise *noise, NoiseGenerator generator, unsigned count, const Vec3 *points, double *spreads)
{
    noise_values(noise, generator, count, points, spreads);
    for (unsigned i = 0; i < count; i++) {
        spreads[i] = noise_spread_of(generator, spreads[i]);
    }
}

void noise_vectors(const Noise *noise, unsigned count, const Vec3 *points, Vec3 *vectors)
{
    noise->kernel->vectors(noise, count, points, vectors);
}

Vec3 noise_vector(const Noise *noise, Vec3 p)
{
    return noise->kernel->vector(noise, p);
}

double noise_sum(const Noise *noise, NoiseGenerator generator, const Octaves *octaves, Vec3 p)
{
    return noise->kernel->sum(noise, generator, octaves, p);
}

Vec3 noise_vector_sum(const Noise *noise, const Octaves *octaves, Vec3 p)
{
    return noise->kernel->vector_sum(noise, octaves, p);
}

// ---- cells

static unsigned hash_of(const Noise *noise, unsigned x, unsigned y, unsigned z)
{
    return noise->hash[noise->hash[noise->hash[x] ^ y] ^ z];
}

// Here nothing is added to the coordinates.
static const double *site_numbers(const Noise *noise, Vec3 corner)
{
    return &noise->sites[hash_of(noise, cell_of(corner.x, 0.0, NOISE_CELLS).index[0],
                                 cell_of(corner.y, 0.0, NOISE_CELLS).index[0],
                                 cell_of(corner.z, 0.0, NOISE_CELLS).index[0])];
}

double noise_cell(const Noise *noise, Vec3 corner)
{
    return site_numbers(noise, corner)[0];
}

Vec3 noise_site(const Noise *noise, Vec3 corner)
{
    const double *numbers = site_numbers(noise, corner);
    return vec3_add(corner, vec3(numbers[0], numbers[1], numbers[2]));
}

// ---- waves

// Frequencies are numbers of 15 bits that follow one another in the random sequence from 1, after 7168 others.
void noise_wave_sources(const Noise *noise, unsigned count, WaveSource *sources)
{
    enum { NUMBERS_BEFORE = 7168, GREATEST = 0x7fff };
    uint32_t state = 1;
    for (unsigned i = 0; i < NUMBERS_BEFORE; i++) {
        next_random(&state);
    }
    for (unsigned i = 0; i < count; i++) {
        sources[i].place = vec3_normalize(noise_vector(noise, vec3(i, 0.0, 0.0)));
        sources[i].frequency = (next_random(&state) & GREATEST) / (double)GREATEST + 0.01;
    }
}
