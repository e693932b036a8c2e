// Outlines of spheres in the picture: a point is within one where the camera's ray meets the sphere, and the shares
// that outlines have of a pixel are those that many narrow rows have.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "render/records/camera.h"
#include "render/sample/sampling_outline.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { SPHERES = 4000, POINTS = 50, PIXELS = 3000, ROWS = 20000 };

static Random drawn_by;

static double unit(void)
{
    return random_below(&drawn_by, 1u << 30) * 0x1p-30;
}

static double between(double low, double high)
{
    return low + (high - low) * unit();
}

static Vec3 anywhere(double size)
{
    return vec3(between(-size, size), between(-size, size), between(-size, size));
}

// ---- where outlines are

// By how much a ray meets a sphere: the square of the sphere's radius less that of the line's distance, over the first.
static long double depth_within(Ray ray, Vec3 centre, double radius)
{
    long double f[3] = {(long double)centre.x - ray.origin.x, (long double)centre.y - ray.origin.y,
                        (long double)centre.z - ray.origin.z};
    long double d[3] = {ray.direction.x, ray.direction.y, ray.direction.z}, square = 0.0L, length = 0.0L;
    for (int i = 0; i < 3; i++) {
        long double c = d[(i + 1) % 3] * f[(i + 2) % 3] - d[(i + 2) % 3] * f[(i + 1) % 3];
        square += c * c;
        length += d[i] * d[i];
    }
    return 1.0L - square / length / ((long double)radius * radius);
}

static PreparedCamera any_camera(CameraType type)
{
    Vec3 right = anywhere(1.0), up = anywhere(1.0), direction = anywhere(1.0);
    if (type == CAMERA_ORTHOGRAPHIC) {
        direction = vec3_normalize(direction);
    }
    return (PreparedCamera){.type = type, .location = anywhere(3.0), .direction = direction, .right = right, .up = up};
}

static void test_outlines(CameraType type)
{
    const int width = 160, height = 120;
    int ellipses = 0, wrong = 0, near = 0, inside = 0;
    for (int i = 0; i < SPHERES; i++) {
        PreparedCamera camera = any_camera(type);
        OutlineView view;
        Outline outline;
        double distance, radius = exp(between(-6.0, 1.0)), x = between(-0.5, 0.5), y = between(-0.5, 0.5);
        Ray ray;
        (void)camera_ray(&camera, x, y, &ray);
        Vec3 centre = vec3_add_scaled(ray.origin, between(0.0, 20.0), ray.direction);
        if (!outline_view_init(&view, &camera, width, height) ||
            !outline_of(&view, centre, radius * radius, &outline, &distance)) {
            continue;
        }
        ellipses++;
        for (int j = 0; j < POINTS; j++) { // some within, some without
            double turn = between(0.0, 6.2831853), far = between(0.5, 1.5), down = far * outline_half_height(&outline);
            double at_y = outline.y + down * sin(turn);
            double at_x = outline.x + outline.slope * down * sin(turn) + far * outline.half_row * cos(turn);
            (void)camera_ray(&camera, (at_x + 0.5) / width - 0.5, (at_y + 0.5) / height - 0.5, &ray);
            long double depth = depth_within(ray, centre, radius);
            bool is_before = type == CAMERA_ORTHOGRAPHIC || vec3_dot(vec3_sub(centre, ray.origin), ray.direction) > 0.0;
            bool is_far = vec3_length(vec3_sub(centre, camera.location)) > 1e4 * radius;
            near += fabsl(depth) < (is_far ? 1e-4L : 1e-8L);
            if (fabsl(depth) >= (is_far ? 1e-4L : 1e-8L)) {
                bool has = outline_has(&outline, at_x, at_y);
                wrong += has != (depth > 0.0L && is_before);
                inside += has;
            }
        }
    }
    tap_ok(ellipses > SPHERES / 2 && wrong == 0,
           "%s: of %d points at %d outlines, of which %d are within and %d too near an edge to tell, %d are wrong",
           type == CAMERA_ORTHOGRAPHIC ? "orthographic" : "perspective", ellipses * POINTS, ellipses, inside, near,
           wrong);
}

// ---- shares

static Outline any_outline(void)
{
    double size = exp(between(-1.5, unit() < 0.3 ? 14.0 : 4.0)), height = size * exp(between(-0.7, 0.7));
    double turn = between(0.0, 6.2831853), far = unit() < 0.3 ? between(0.0, 1.0) : 1.0;
    double slope = between(-1.0, 1.0) * size / height;
    Outline outline = {.slope = slope, .half_row = size, .narrowing = 1.0 / (height * height)};
    outline.x = between(-0.5, 0.5) - far * (slope * height * sin(turn) + size * cos(turn)); // an edge in the pixel
    outline.y = between(-0.5, 0.5) - far * height * sin(turn);
    return outline;
}

static double piece(double from, double to, double low, double high)
{
    return fmax(fmin(to, high) - fmax(from, low), 0.0);
}

// The part of a row of which the first outline that has it is number i, by its ends in order.
static void narrow_row(const Outline *outlines, int count, double y, double *areas)
{
    double ends[2 * OUTLINES_MOST + 2], left, right;
    int n = 0;
    ends[n++] = -0.5;
    ends[n++] = 0.5;
    for (int i = 0; i < count; i++) {
        if (outline_row(&outlines[i], y, &left, &right)) {
            ends[n++] = fmin(fmax(left, -0.5), 0.5);
            ends[n++] = fmin(fmax(right, -0.5), 0.5);
        }
    }
    for (int i = 1; i < n; i++) {
        for (int j = i; j > 0 && ends[j - 1] > ends[j]; j--) {
            double other = ends[j];
            ends[j] = ends[j - 1];
            ends[j - 1] = other;
        }
    }
    for (int i = 0; i + 1 < n; i++) {
        double middle = 0.5 * (ends[i] + ends[i + 1]);
        int first = 0;
        while (first < count && !(outline_row(&outlines[first], y, &left, &right) &&
                                  piece(left, right, middle, middle) == 0.0 && left <= middle && middle <= right)) {
            first++;
        }
        areas[first] += ends[i + 1] - ends[i];
    }
}

static void test_areas(int count, double most_mean, double most)
{
    double worst = 0.0, squares = 0.0, whole = 0.0, rough_worst = 0.0;
    for (int i = 0; i < PIXELS / 10; i++) {
        Outline outlines[OUTLINES_MOST];
        double areas[OUTLINES_MOST + 1], approximate[OUTLINES_MOST + 1], wanted[OUTLINES_MOST + 1] = {0.0}, sum = 0.0;
        for (int j = 0; j < count; j++) {
            outlines[j] = any_outline();
        }
        outline_areas(outlines, count, areas);
        outline_areas_roughly(outlines, count, approximate);
        for (int row = 0; row < ROWS; row++) {
            narrow_row(outlines, count, (row + 0.5) / ROWS - 0.5, wanted);
        }
        for (int j = 0; j <= count; j++) {
            double off = fabs(areas[j] - wanted[j] / ROWS);
            worst = fmax(worst, off);
            rough_worst = fmax(rough_worst, fabs(approximate[j] - wanted[j] / ROWS));
            squares += off * off;
            sum += areas[j];
        }
        whole = fmax(whole, fabs(sum - 1.0));
    }
    double mean = sqrt(squares / (PIXELS / 10 * (count + 1)));
    tap_ok(mean <= most_mean && worst <= most && whole < 1e-12,
           "%d outlines: shares are off by %.2g (root mean square), %.2g at most, their sum by %.2g", count, mean,
           worst, whole);
    tap_ok(rough_worst <= 0.1, "%d outlines: approximate shares are off by %.2g at most", count, rough_worst);
}

// Edges that cross twice within few rows, near an end of both.
static void test_near_ends(void)
{
    static const Outline pairs[][2] = {
        {{-1.6504741891018859, 0.48022302980037368, -1.1542332476373289, 1.6136573402025578, 0.94230640197094873},
         {-1.6802525866418119, -0.44176498937339059, 1.8131043490651939, 1.5126038728990845, 1.5146704678915173}},
        {{-0.036031102062629605, 0.57726442317686188, -0.29007818567085714, 0.45803722907714778, 1.3966493946754295},
         {0.66311153283149527, -0.062086507056122626, -1.7851485192115235, 0.80212522998901359, 6.2575369630494233}},
        {{1.6438608689141323, -0.30045129128583731, -1.3805484806770976, 1.378477748946028, 1.1996495164856797},
         {0.15199598160016103, 0.42063025961923806, 0.74746090296149514, 0.27946004576602856, 7.6744998927734676}}};
    enum { PAIRS = RT_COUNT_OF(pairs) };
    double worst = 0.0;
    for (int i = 0; i < PAIRS; i++) {
        double areas[3], wanted[3] = {0.0};
        outline_areas(pairs[i], 2, areas);
        for (int row = 0; row < ROWS; row++) {
            narrow_row(pairs[i], 2, (row + 0.5) / ROWS - 0.5, wanted);
        }
        for (int j = 0; j < 3; j++) {
            worst = fmax(worst, fabs(areas[j] - wanted[j] / ROWS));
        }
    }
    tap_ok(worst < 1e-6, "two crossings near an end of both edges: shares are off by %.2g at most", worst);
}

int main(void)
{
    drawn_by = (Random){random_seed(NULL)};
    test_outlines(CAMERA_PERSPECTIVE);
    test_outlines(CAMERA_ORTHOGRAPHIC);
    test_areas(1, 1e-6, 1e-5);
    test_areas(2, 1e-6, 1e-5);
    test_areas(4, 1e-6, 1e-5);
    test_near_ends();
    return tap_done();
}
