// Stiff paths: mirrors that face each other, in three precisions, and total reflection at its threshold.
//
// SPDX-License-Identifier: MIT
#include <float.h>
#include <math.h>

#include "math/quad.h"
#include "math/random.h"
#include "study/spheres.h"

enum { BOUNCES_MOST = 10000 };

// A ray between two unit mirrors along their common axis, which stays on it in exact arithmetic; counts bounces until
// it is off by 1e-3. The axis is along nothing, so that each bounce rounds.
#define DEFINE_BOUNCES(name, Real, SQRT)                                                                               \
    static int bounces_##name(double gap)                                                                              \
    {                                                                                                                  \
        const Real axis[3] = {(Real)2 / 7, (Real)3 / 7, (Real)6 / 7}, half = 1 + (Real)gap / 2;                        \
        Real centre[2][3], p[3], d[3];                                                                                 \
        for (int i = 0; i < 3; i++) {                                                                                  \
            centre[0][i] = (Real)(1 + i) - half * axis[i];                                                             \
            centre[1][i] = (Real)(1 + i) + half * axis[i];                                                             \
            p[i] = centre[0][i] + axis[i];                                                                             \
            d[i] = axis[i];                                                                                            \
        }                                                                                                              \
        for (int count = 0; count < BOUNCES_MOST; count++) {                                                           \
            const Real *c = centre[1 - count % 2];                                                                     \
            Real f[3], n[3], along = 0, off = 0, length = 0, dot = 0, rest = 0, away = 0;                              \
            for (int i = 0; i < 3; i++) {                                                                              \
                f[i] = p[i] - c[i];                                                                                    \
                along += f[i] * d[i];                                                                                  \
            }                                                                                                          \
            for (int i = 0; i < 3; i++) {                                                                              \
                off += (f[i] - along * d[i]) * (f[i] - along * d[i]);                                                  \
            }                                                                                                          \
            if (!(off < 1)) {                                                                                          \
                return count;                                                                                          \
            }                                                                                                          \
            Real t = -along - SQRT(1 - off);                                                                           \
            for (int i = 0; i < 3; i++) {                                                                              \
                n[i] = f[i] + t * d[i];                                                                                \
                length += n[i] * n[i];                                                                                 \
            }                                                                                                          \
            length = SQRT(length);                                                                                     \
            for (int i = 0; i < 3; i++) {                                                                              \
                n[i] /= length;                                                                                        \
                p[i] = c[i] + n[i];                                                                                    \
                dot += n[i] * d[i];                                                                                    \
            }                                                                                                          \
            length = along = 0;                                                                                        \
            for (int i = 0; i < 3; i++) {                                                                              \
                d[i] -= 2 * dot * n[i];                                                                                \
                length += d[i] * d[i];                                                                                 \
                along += n[i] * axis[i];                                                                               \
            }                                                                                                          \
            length = SQRT(length);                                                                                     \
            for (int i = 0; i < 3; i++) {                                                                              \
                d[i] /= length;                                                                                        \
                rest = n[i] - along * axis[i];                                                                         \
                away += rest * rest;                                                                                   \
            }                                                                                                          \
            if (!(away < (Real)1e-6)) {                                                                                \
                return count;                                                                                          \
            }                                                                                                          \
        }                                                                                                              \
        return BOUNCES_MOST;                                                                                           \
    }

DEFINE_BOUNCES(float, float, sqrtf)
DEFINE_BOUNCES(double, double, sqrt)
DEFINE_BOUNCES(quad, Quad, quad_sqrt)

// An error grows by 1 + L + sqrt((1 + L)² - 1) at each bounce, so u becomes 1e-3 after ln(1e-3 / u) / ln growth.
void study_mirrors(double gap, MirrorRow *row)
{
    const double u[3] = {0x1p-24, 0x1p-53, 0x1p-113};
    row->gap = gap;
    row->growth = 1.0 + gap + sqrt((1.0 + gap) * (1.0 + gap) - 1.0);
    row->bounces[0] = bounces_float(gap);
    row->bounces[1] = bounces_double(gap);
    row->bounces[2] = bounces_quad(gap);
    for (int i = 0; i < 3; i++) {
        row->theory[i] = log(1e-3 / u[i]) / log(row->growth);
    }
}

// Angles within 1e-12 of the critical one, and the same in quadruple precision.
void study_total_reflection(uint64_t cases, uint64_t seed, TotalRow *row)
{
    const double u = DBL_EPSILON / 2;
    Random random = {seed};
    *row = (TotalRow){.cases = cases};
    for (uint64_t i = 0; i < cases; i++) {
        double ratio = random_between(&random, 0.3, 0.95), eta = 1.0 / ratio;
        double width = pow(10.0, random_between(&random, -16.0, -3.0));
        width = random_bits(&random) % 2 ? width : -width;
        double cosine = sqrt(1.0 - ratio * ratio) + width;
        double k = 1.0 - eta * eta * (1.0 - cosine * cosine);
        Quad exact_eta = 1 / (Quad)ratio;
        Quad exact = 1 - exact_eta * exact_eta * (1 - (Quad)cosine * (Quad)cosine);
        if ((k >= 0.0) != (exact >= 0)) {
            row->wrong++;
            row->greatest_wrong = fmax(row->greatest_wrong, fabs((double)exact) / u);
        } else if (k > 0.0) {
            double bent = (double)quad_sqrt(exact);
            row->cosine_error = fmax(row->cosine_error, fabs(sqrt(k) / bent - 1.0) * bent * bent / u);
        }
    }
}
