// Samplers and filters on their own: nets, cells, means; what area lights make of a sample.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/points/filter.h"
#include "render/points/sampler_many.h"
#include "render/shade/light.h"
#include "trace/geometry.h"
#include "unit/tap.h"

// The second dimension from the direction numbers of Joe and Kuo's table: s = 1, a = 0, m = 1.
static uint32_t sobol_by_table(uint32_t index)
{
    uint32_t direction = UINT32_C(1) << 31, value = 0;
    for (; index; index >>= 1, direction ^= direction >> 1) {
        value ^= index & 1 ? direction : 0;
    }
    return value;
}

static void test_sobol(void)
{
    int wrong = 0;
    for (uint32_t i = 0; i < 100000; i++) {
        uint32_t index = i * UINT32_C(2654435761);
        wrong += sobol_value(index, 1) != sobol_by_table(index);
    }
    tap_ok(wrong == 0, "the second dimension is that of the direction numbers");
}

// Every box of area 1/count with sides that are powers of 1/2 has one of the first `count` points.
static bool is_net(SampleStream stream, unsigned log_count, uint32_t first)
{
    uint32_t count = UINT32_C(1) << log_count;
    for (unsigned across = 0; across <= log_count; across++) {
        bool seen[1024] = {false};
        for (uint32_t i = 0; i < count; i++) {
            SampleStream one = stream;
            one.index = first + i;
            SamplePoint at = sample_next(&one);
            uint32_t x = (uint32_t)(at.x * (1u << across)), y = (uint32_t)(at.y * (1u << (log_count - across)));
            uint32_t box = y << across | x;
            if (seen[box]) {
                return false;
            }
            seen[box] = true;
        }
    }
    return true;
}

static void test_nets(void)
{
    int wrong = 0;
    for (uint32_t pixel = 0; pixel < 20; pixel++) {
        for (uint32_t pair = 0; pair < 3; pair++) {
            SampleStream stream = {.kind = SAMPLER_SOBOL, .seed = sampler_pixel_seed(5, pixel, 3), .pair = pair};
            for (unsigned log_count = 0; log_count <= 8; log_count++) {
                wrong += !is_net(stream, log_count, 0) || !is_net(stream, log_count, UINT32_C(1) << log_count);
            }
        }
    }
    tap_ok(wrong == 0, "scrambled points are nets, from the beginning and in the second half of twice as many");
}

// Of 2^m points of two pairs, each box of volume 2^(t-m) whose sides are powers of 1/2 has 2^t.
static bool is_net_of_four(const SampleStream *stream, unsigned m, unsigned t)
{
    unsigned free_bits = m - t;
    for (unsigned split = 0; split < 1u << (2 * 4); split++) {
        unsigned bits[4] = {split & 15, split >> 4 & 15, 0, 0};
        for (bits[2] = 0; bits[0] + bits[1] + bits[2] <= free_bits; bits[2]++) {
            unsigned count[256] = {0};
            bits[3] = free_bits - bits[0] - bits[1] - bits[2];
            for (uint32_t i = 0; i < 1u << m; i++) {
                SampleStream one = *stream;
                one.index = i;
                SamplePoint a = sample_next(&one), b = sample_next(&one);
                const double at[4] = {a.x, a.y, b.x, b.y};
                unsigned box = 0;
                for (int d = 0; d < 4; d++) {
                    box = box << bits[d] | (unsigned)(at[d] * (1u << bits[d]));
                }
                if (++count[box] > 1u << t) {
                    return false;
                }
            }
        }
    }
    return true;
}

static void test_nets_of_four(void)
{
    static const unsigned t_of[] = {0, 0, 1, 1, 1, 2, 2, 2, 3};
    int wrong = 0, tight = 0;
    for (uint32_t pixel = 0; pixel < 3; pixel++) {
        for (unsigned m = 2; m <= 8; m++) {
            SampleStream stream = {.kind = SAMPLER_SOBOL, .seed = sampler_pixel_seed(5, pixel, 8), .pair = 2 * pixel};
            wrong += !is_net_of_four(&stream, m, t_of[m]);
            stream.pair++;
            tight += m >= 5 && is_net_of_four(&stream, m, t_of[m]); // fewer points may be so by chance
        }
    }
    tap_ok(wrong == 0, "two pairs together are spread in four dimensions");
    tap_ok(tight == 0, "and pairs of different twos are not: they are independent");
}

static void test_cells(void)
{
    int wrong = 0;
    for (uint32_t pixel = 0; pixel < 50; pixel++) {
        for (uint32_t pair = 0; pair < 2; pair++) {
            bool seen[64] = {false};
            for (uint32_t i = 64; i < 128; i++) {
                SampleStream stream = {.kind = SAMPLER_JITTERED,
                                       .seed = sampler_pixel_seed(1, pixel, 9),
                                       .index = i,
                                       .first = 64,
                                       .count = 64,
                                       .pair = pair};
                SamplePoint at = sample_next(&stream);
                int cell = (int)(at.x * 8.0) + 8 * (int)(at.y * 8.0);
                wrong += seen[cell];
                seen[cell] = true;
            }
        }
    }
    tap_ok(wrong == 0, "jittered points are one to a cell");
}

// Moments of all samplers over pixels: unbiased, and dimensions and pixels do not hang together.
static void test_moments(void)
{
    enum { COUNT = 40000 };
    for (SamplerKind kind = 0; kind < SAMPLER_COUNT; kind++) {
        double x = 0.0, y = 0.0, xy = 0.0, pairs = 0.0, squares = 0.0;
        for (uint32_t pixel = 0; pixel < COUNT; pixel++) {
            SampleStream stream = {
                .kind = kind, .seed = sampler_pixel_seed(2, pixel % 200, pixel / 200), .index = 5, .count = 7};
            SamplePoint first = sample_next(&stream), second = sample_next(&stream);
            x += first.x - 0.5;
            y += first.y - 0.5;
            squares += first.x * first.x - 1.0 / 3.0;
            xy += (first.x - 0.5) * (first.y - 0.5);
            pairs += (first.x - 0.5) * (second.x - 0.5);
        }
        double mean = 4.5 * sqrt(COUNT / 12.0), product = 4.5 * sqrt(COUNT) / 12.0;
        tap_ok(fabs(x) < mean && fabs(y) < mean && fabs(squares) < 4.5 * sqrt(COUNT * 4.0 / 45.0) &&
                   fabs(xy) < product && fabs(pairs) < product,
               "%s: even in the mean, dimensions independent", sampler_name(kind));
    }
}

static void test_filters(void)
{
    enum { POINTS = 1 << 20 };
    for (FilterKind kind = 0; kind < FILTER_COUNT; kind++) {
        Filter filter;
        double weight = 0.0, second = 0.0, want = 0.0, sum = 0.0, least = HUGE_VAL;
        filter_init(&filter, kind);
        for (int i = 0; i < POINTS; i++) {
            SamplePoint at = {(i + 0.5) / POINTS, sobol_value((uint32_t)i, 0) * 0x1p-32};
            FilterSample sample = filter_sample(&filter, at);
            weight += sample.weight;
            least = fmin(least, sample.weight);
            second += sample.weight * sample.x * sample.x;
        }
        for (int i = 0; i < 100000; i++) {
            double x = (i + 0.5) / 100000.0 * 4.0 - 2.0;
            want += filter_value(kind, x) * x * x;
            sum += filter_value(kind, x);
        }
        weight /= POINTS;
        second /= POINTS;
        tap_ok((kind == FILTER_MITCHELL ? least < 0.0 : least == 1.0 && weight == 1.0), "%s: %s", filter_name(kind),
               kind == FILTER_MITCHELL ? "some weights are negative" : "each sample counts the same");
        tap_ok(fabs(weight - 1.0) < 1e-3 && fabs(second - want / sum) < 1e-3, "%s: weights have mean 1 and its breadth",
               filter_name(kind));
    }
}

// How often each light of a row counts in the grid: by halving it as the grid is halved.
static void row_weights(int low, int high, double weight, double *weights)
{
    if (high - low <= 1) {
        weights[low] += weight / 2.0;
        weights[high] += weight / 2.0;
        return;
    }
    row_weights(low, (low + high) / 2, weight / 2.0, weights);
    row_weights((low + high + 1) / 2, high, weight / 2.0, weights);
}

static void test_rows(void)
{
    enum { STEPS = 1 << 16 };
    int wrong = 0;
    for (int size = 1; size <= 17; size++) {
        double want[17] = {0.0}, found[17] = {0.0}, last = -1.0;
        row_weights(0, size - 1, 1.0, want);
        for (int i = 0; i < STEPS; i++) {
            double place = light_row_sample(size, false, (double)i / STEPS);
            found[size > 1 ? (int)lround((place + 0.5) * (size - 1)) : 0] += 1.0 / STEPS;
            wrong += place < last;
            last = place;
            double moved = light_row_sample(size, true, (double)i / STEPS);
            wrong += size > 1 && fabs(moved - place) * (size - 1) > 0.5 + 1e-9;
        }
        for (int i = 0; i < size; i++) {
            wrong += fabs(found[i] - want[i]) > 1e-9;
        }
    }
    tap_ok(wrong == 0, "each light of a row is drawn as often as it counts in the grid");
}

// The next points of some streams, in whatever pixel, sample and pair they are, are those of each by itself, with every
// instruction set.
static void test_streams(const char *isa)
{
    const SobolKernel *kernel = sobol_kernel_choose(isa);
    int wrong = kernel == NULL;
    for (SamplerKind kind = 0; kernel != NULL && kind < SAMPLER_COUNT; kind++) {
        for (uint32_t count = 0; count <= SAMPLE_STREAMS_MOST; count += count < 9 ? 1 : 11) {
            SampleStream streams[SAMPLE_STREAMS_MOST], before[SAMPLE_STREAMS_MOST];
            uint8_t which[SAMPLE_STREAMS_MOST];
            double x[SAMPLE_STREAMS_MOST + SAMPLE_WORDS_MOST], y[SAMPLE_STREAMS_MOST + SAMPLE_WORDS_MOST];
            for (uint32_t i = 0; i < SAMPLE_STREAMS_MOST; i++) {
                uint32_t index = i * i * i * 7919;
                streams[i] = (SampleStream){.kind = kind,
                                            .seed = sampler_pixel_seed(count, i, 5),
                                            .index = index,
                                            .first = index,
                                            .count = 3,
                                            .pair = (i ^ count) % 7};
                which[i] = (uint8_t)(SAMPLE_STREAMS_MOST - 1 - i);
            }
            memcpy(before, streams, sizeof streams);
            sample_next_of(kernel, streams, count % 2 ? which : NULL, count, x, y);
            for (uint32_t i = 0; i < SAMPLE_STREAMS_MOST; i++) {
                uint32_t at = count % 2 ? which[i] : i;
                SampleStream *own = &before[at];
                SamplePoint place = i < count ? sample_next(own) : (SamplePoint){0.0, 0.0};
                wrong += (i < count && (place.x != x[i] || place.y != y[i])) || own->pair != streams[at].pair;
            }
        }
    }
    tap_ok(wrong == 0, "%s: the next points of many streams are those of each: %d differ", isa, wrong);
}

int main(void)
{
    test_sobol();
    test_nets();
    test_nets_of_four();
    test_cells();
    test_moments();
    test_filters();
    test_rows();
    for (size_t i = 0; geometry_isa(i); i++) {
        test_streams(geometry_isa(i));
    }
    return tap_done();
}
