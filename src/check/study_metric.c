// Distances of pictures, and lines through what they say.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "check/study.h"

static double clamped(float value)
{
    return fmin(fmax((double)value, 0.0), 1.0);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;

    return x < y ? -1 : x > y;
}

bool study_compare(const Image *picture, const Image *reference, StudyMetric *metric)
{
    size_t pixels = (size_t)reference->width * (size_t)reference->height;
    size_t step = (size_t)picture->channels, reference_step = (size_t)reference->channels;
    double *greatest = malloc(pixels * sizeof *greatest);

    *metric = (StudyMetric){0};
    if (!greatest || picture->width != reference->width || picture->height != reference->height || step < 3 ||
        reference_step < 3) {
        free(greatest);
        return false;
    }
    for (size_t i = 0; i < pixels; i++) {
        greatest[i] = 0.0;
        for (size_t c = 0; c < 3; c++) {
            double want = clamped(reference->values[reference_step * i + c]);
            double off = clamped(picture->values[step * i + c]) - want;
            metric->rmse += off * off;
            metric->relmse += off * off / (want * want + 0.01);
            greatest[i] = fmax(greatest[i], fabs(off));
        }
    }
    metric->rmse = sqrt(metric->rmse / (double)(3 * pixels));
    metric->relmse /= (double)(3 * pixels);
    qsort(greatest, pixels, sizeof *greatest, by_size);
    metric->greatest = greatest[pixels - 1];
    metric->p999 = greatest[(size_t)(0.999 * (double)(pixels - 1))];
    free(greatest);
    return image_flip(picture, reference, &metric->flip);
}

// Student's t for a 95 % interval.
static double student(int freedom)
{
    static const double values[] = {0.0, 12.71, 4.30, 3.18, 2.78, 2.57, 2.45};

    return values[freedom];
}

// Whether the last step gained less than a quarter of what was asked for in addition, in logarithms, where independent
// samples would gain half of it. What is near the floor tells nothing.
static bool is_stuck(const StudyMethod *method, double floor)
{
    if (method->count < 3) {
        return false;
    }
    const StudyPoint *last = &method->points[method->count - 1], *before = last - 1;
    return last->rmse > 3.0 * floor && log(before->rmse / last->rmse) < 0.25 * log(last->effort / before->effort);
}

// The logarithms of points above the floor's reach lie on a line, or they do not.
void study_fit(StudyMethod *method, double floor)
{
    double x[STUDY_POINTS], y[STUDY_POINTS], mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0, rest = 0.0;
    int count = 0;

    for (int i = 0; i < method->count; i++) {
        // One ray a pixel asks all of an area light: it is on no line with the others.
        bool is_single = method->kind != STUDY_POVRAY && method->points[i].samples < 2.0;
        if (method->points[i].rmse > 1.5 * floor && method->points[i].seconds > 0.0 && !is_single) {
            x[count] = log(method->points[i].seconds);
            y[count++] = log(method->points[i].rmse);
        }
    }
    method->slope = method->slope_spread = (double)NAN;
    method->is_biased = is_stuck(method, floor);
    if (count < 2) {
        return;
    }
    for (int i = 0; i < count; i++) {
        mean_x += x[i] / count;
        mean_y += y[i] / count;
    }
    for (int i = 0; i < count; i++) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (!(xx > 0.0)) {
        return;
    }
    method->slope = xy / xx;
    for (int i = 0; i < count; i++) {
        double off = y[i] - mean_y - method->slope * (x[i] - mean_x);
        rest += off * off;
    }
    if (count > 2) {
        method->slope_spread = student(count - 2) * sqrt(rest / (count - 2) / xx);
    }
}
