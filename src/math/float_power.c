// The power of a float by tables and the binomial series about the middle of a 128th of an octave.
//
// With c that middle and v = 2^k c (1 + t), |t| <= 2^-8, v^e is 2^(k e) c^e (1 + t)^e. Six terms of the series leave
// less than 2^-48 for exponents up to 4, all roundings together less than 2^-50. Where both ends of that doubt, taken
// wider, round to the same float, so does pow's result, which is right to one unit of double precision; elsewhere, once
// in some 2^17 values, pow is called.
//
// SPDX-License-Identifier: MIT
#include "math/float_power.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/attributes.h"

enum { MANTISSA_BITS = 23, PRIMITIVE_BITS = 7, PARTS = 1 << PRIMITIVE_BITS, ONE = 127, TERMS = 5 };
// The octaves that have a place in the tables: what a picture shows.
enum { LEAST_SCALE = -24, SCALES = 30 };

static const double MOST_EXPONENT = 4.0;
static const double DOUBT = 0x1p-43;

typedef struct FloatPower {
    double exponent;
    double parts[PARTS];   // the power of each part's middle, from 1 to 2
    double scales[SCALES]; // the power of each power of two
    double terms[TERMS];   // binomial coefficients of the exponent, from the first
} FloatPower;

static double primitive_middle(unsigned part)
{
    return 1.0 + ((double)part + 0.5) / PARTS;
}

static void power_init(FloatPower *power, double exponent)
{
    double term = 1.0;
    power->exponent = exponent;
    for (unsigned i = 0; i < PARTS; i++) {
        power->parts[i] = pow(primitive_middle(i), exponent);
    }
    for (int i = 0; i < SCALES; i++) {
        power->scales[i] = exp2((double)(i + LEAST_SCALE) * exponent);
    }
    for (int i = 0; i < TERMS; i++) {
        term *= (exponent - (double)i) / (double)(i + 1);
        power->terms[i] = term;
    }
}

static float power_by_pow(double exponent, float value)
{
    return (float)pow(fmax((double)value, 0.0), exponent);
}

RT_ALWAYS_INLINE float power_by_tables(const FloatPower *power, float value)
{
    uint32_t bits, fraction;
    float mantissa;
    memcpy(&bits, &value, sizeof bits);
    uint32_t scale = (bits >> MANTISSA_BITS) - (uint32_t)(ONE + LEAST_SCALE);
    if (scale >= SCALES) {
        return value > 0.0F ? power_by_pow(power->exponent, value) : 0.0F;
    }
    fraction = (bits & ((1U << MANTISSA_BITS) - 1)) | (uint32_t)ONE << MANTISSA_BITS;
    memcpy(&mantissa, &fraction, sizeof mantissa);
    unsigned part = (bits >> (MANTISSA_BITS - PRIMITIVE_BITS)) & (PARTS - 1);
    const double *c = power->terms, middle = primitive_middle(part), t = ((double)mantissa - middle) / middle,
                 t2 = t * t;
    double series = 1.0 + t * (c[0] + t * c[1]) + t2 * t * (c[2] + t * c[3] + t2 * c[4]);
    double result = power->parts[part] * power->scales[scale] * series, doubt = result * DOUBT;
    float low = (float)(result - doubt), high = (float)(result + doubt);
    return low == high ? low : power_by_pow(power->exponent, value);
}

void float_power_all(double exponent, float *values, size_t count)
{
    FloatPower power;
    bool has_tables = exponent > 0.0 && exponent <= MOST_EXPONENT && count > PARTS;
    if (has_tables) {
        power_init(&power, exponent);
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = has_tables ? power_by_tables(&power, values[i]) : power_by_pow(exponent, values[i]);
    }
}
