// A picture's true mean over each pixel, or over a filter, by brute force: the middle rule on a square grid of single
// rays, k x k of them in a pixel, as many as that pixel needs. Nothing of what is judged takes part in it: no sampler,
// no filter table, no outline, no estimate. A scene is rendered k times as large with one ray a pixel, a part of it at
// a time. So it has no lens and no area light, of which one ray would know nothing.
//
// SPDX-License-Identifier: MIT
#ifndef SAMPLING_GRID_H
#define SAMPLING_GRID_H

#include "sampling/scenes.h"

// Rays along a side of a pixel, multiples of 3; they are doubled where these are too few. A filter reaches into the
// pixels around, so a picture is seen with a border, of a quarter of its sides, in which the ratio of these stays.
enum { GRID_LEAST = 48, GRID_MOST = 1536, GRID_REACH = 1, GRID_TEXT = 4096, SIDE_MOST = 65535 };

typedef struct Grid {
    rt_session *session;
    int width, height, left, top; // with the border; this
    bool is_gaussian;
    float *rgb;     // of the picture within
    double *means;  // of pixels with the border, by what each brings to the 3 x 3 around it, three colours each
    double *errors; // of each of these, expected and squared
    double rays;
} Grid;

// Whether single rays know the scene's mean.
__attribute__((unused)) static bool grid_knows(const SamplingScene *scene)
{
    return !strstr(scene->text, "aperture") && !strstr(scene->text, "area_light");
}

static void grid_text_swap(char text[GRID_TEXT], const char *old, const char *with)
{
    char *at = strstr(text, old);
    if (at) {
        size_t rest = strlen(at + strlen(old)) + 1;
        if ((size_t)(at - text) + strlen(with) + rest > GRID_TEXT) {
            abort();
        }
        memmove(at + strlen(with), at + strlen(old), rest);
        memcpy(at, with, strlen(with));
    }
}

// The scene seen with the border: all of the cameras here have an angle of 50 degrees or are orthographic.
static void grid_load(Grid *grid, const SamplingScene *scene, double wider)
{
    static const rt_callbacks callbacks = {NULL, NULL, NULL, NULL};
    char text[GRID_TEXT], angle[64], right[64];
    snprintf(angle, sizeof angle, "angle %.17g", 360.0 / M_PI * atan(tan(25.0 * M_PI / 180.0) * wider));
    snprintf(right, sizeof right, "right %.17g*x up %.17g*y", 8.0 * wider, 6.0 * wider);
    if (strlen(scene->text) >= GRID_TEXT) {
        abort();
    }
    strcpy(text, scene->text);
    grid_text_swap(text, "angle 50", angle);
    grid_text_swap(text, "right 8*x up 6*y", right);
    grid->session = rt_session_new(&callbacks);
    if (!grid->session || rt_set_size(grid->session, grid->width, grid->height) ||
        rt_load_text(grid->session, scene->name, text, strlen(text))) {
        abort();
    }
}

// The gaussian filter as docs/sampling.md and `filter.h` define it; its integral over -1.5 to 1.5 is 1.
static double grid_gaussian(double x)
{
    const double edge = exp(-2.0 * 1.5 * 1.5);
    return fabs(x) < 1.5 ? (exp(-2.0 * x * x) - edge) / (sqrt(0.5 * M_PI) * erf(sqrt(2.0) * 1.5) - 3.0 * edge) : 0.0;
}

// Every third ray of every third row is a grid of its own, too. Eight of the nine lie to one side; two that lie to
// opposite sides are a part, so that parts differ by what the middle rule leaves and not by a slope.
enum { GRID_PARTS = 5 };
static const int part_of[9] = {0, 1, 2, 3, 4, 3, 2, 1, 0};

// What the mean of so many rays is off by, expected and squared, as though the nine grids were independent: being parts
// of a finer one they are further off together than it is.
static double grid_square(const double parts[GRID_PARTS][3], double rays)
{
    double square = 0.0;
    for (int c = 0; c < 3; c++) {
        double mean = 0.0;
        for (int i = 0; i < GRID_PARTS; i++) {
            mean += parts[i][c] / rays;
        }
        for (int i = 0; i < GRID_PARTS; i++) {
            double grids = i == 4 ? 1.0 : 2.0, apart = 9.0 / grids * parts[i][c] / rays - mean;
            square += grids * apart * apart / (3.0 * 9.0 * (GRID_PARTS - 1));
        }
    }
    return square;
}

// Where an edge lies along rows, all nine grids may agree and be off by half a ray. Then the means of rows jump at a
// few of them, and each jump is somewhere within a ray: what that brings, expected and squared. Jumps of many rows are
// of edges that lie askew, or of smooth light, for which the nine grids speak.
static double grid_jumps(const double means[GRID_MOST][3], int side)
{
    enum { FEW = 6 };
    double square = 0.0;
    for (int c = 0; c < 3; c++) {
        double squares = 0.0, fourths = 0.0;
        for (int i = 1; i < side; i++) {
            double jump = means[i][c] - means[i - 1][c];
            squares += jump * jump;
            fourths += jump * jump * jump * jump;
        }
        square += squares * squares < FEW * fourths ? squares / (3.0 * 12.0 * side * side) : 0.0;
    }
    return square;
}

// What one pixel brings to itself and to those around, from side x side rays that are pitch floats a row apart.
static void grid_pixel(Grid *grid, size_t pixel, const float *rays, size_t pitch, int side)
{
    static double weights[3][GRID_MOST], rows[GRID_MOST][3], columns[GRID_MOST][3];
    double *means = grid->means + 27 * pixel, parts[GRID_PARTS][3] = {{0.0}};
    memset(means, 0, 27 * sizeof *means);
    memset(rows, 0, sizeof rows);
    memset(columns, 0, sizeof columns);
    for (int i = 0; i < side; i++) {
        for (int to = -1; to <= 1; to++) {
            double x = (i + 0.5) / side - 0.5 - to; // from the middle of the pixel that gets it
            weights[to + 1][i] = grid->is_gaussian ? grid_gaussian(x) / side : to == 0 ? 1.0 / side : 0.0;
        }
    }
    for (int y = 0; y < side; y++) {
        double row[3][3] = {{0.0}};
        for (int x = 0; x < side; x++) {
            for (int c = 0; c < 3; c++) {
                double value = (double)rays[(size_t)y * pitch + 3 * (size_t)x + (size_t)c];
                parts[part_of[3 * (y % 3) + x % 3]][c] += value;
                rows[y][c] += value / side;
                columns[x][c] += value / side;
                for (int to = 0; to < 3; to++) {
                    row[to][c] += weights[to][x] * value;
                }
            }
        }
        for (int i = 0; i < 27; i++) {
            means[i] += weights[i / 9][y] * row[i / 3 % 3][i % 3];
        }
    }
    grid->errors[pixel] = grid_square(parts, (double)side * side) + grid_jumps(rows, side) + grid_jumps(columns, side);
}

// Renders pixels left to right of row y, side x side rays each.
static void grid_render(Grid *grid, int left, int right, int y, int side)
{
    int width, height;
    if (rt_set_size(grid->session, side * grid->width, side * grid->height) ||
        rt_set_crop(grid->session, side * left, side * y, side * (right - left), side) || rt_render(grid->session, 1)) {
        abort();
    }
    const float *rays = rt_pixels(grid->session, &width, &height);
    for (int x = left; x < right; x++) {
        grid_pixel(grid, (size_t)y * (size_t)grid->width + (size_t)x, rays + 3 * (size_t)(side * (x - left)),
                   3 * (size_t)width, side);
    }
    grid->rays += (double)width * height;
}

// The root of the mean square of what pixels are expected to be off by.
static double grid_error(const Grid *grid)
{
    double sum = 0.0;
    for (int y = grid->top; y < grid->height - grid->top; y++) {
        for (int x = grid->left; x < grid->width - grid->left; x++) {
            sum += grid->errors[(size_t)y * (size_t)grid->width + (size_t)x];
        }
    }
    return sqrt(sum / ((double)(grid->width - 2 * grid->left) * (grid->height - 2 * grid->top)));
}

static bool grid_reaches(const Grid *grid, int x, int y)
{
    int reach = grid->is_gaussian ? GRID_REACH : 0;
    return x >= grid->left - reach && x < grid->width - grid->left + reach && y >= grid->top - reach &&
           y < grid->height - grid->top + reach;
}

// Pixels that are off by more than `most` get twice as many rays along a side, until the mean is not.
static void grid_trace(Grid *grid, double most)
{
    for (int y = 0; y < grid->height; y++) {
        int reach = grid->is_gaussian ? GRID_REACH : 0;
        if (y >= grid->top - reach && y < grid->height - grid->top + reach) {
            grid_render(grid, grid->left - reach, grid->width - grid->left + reach, y, GRID_LEAST);
        }
    }
    for (int side = 2 * GRID_LEAST; side <= GRID_MOST && side * grid->width <= SIDE_MOST && grid_error(grid) > most;
         side *= 2) {
        for (int y = 0; y < grid->height; y++) {
            for (int x = 0; x < grid->width; x++) {
                bool is_off = grid->errors[(size_t)y * (size_t)grid->width + (size_t)x] > most * most;
                if (is_off && grid_reaches(grid, x, y)) {
                    grid_render(grid, x, x + 1, y, side);
                }
            }
        }
    }
}

static void grid_gather(Grid *grid)
{
    int width = grid->width - 2 * grid->left, height = grid->height - 2 * grid->top;
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            double sums[3] = {0.0};
            for (int i = grid->is_gaussian ? 0 : 4; i < (grid->is_gaussian ? 9 : 5); i++) {
                // From the pixel at (dx, dy), which brings this to the one at the other side of it.
                int dx = i % 3 - 1, dy = i / 3 - 1;
                size_t from = (size_t)(y + grid->top + dy) * (size_t)grid->width + (size_t)(x + grid->left + dx);
                for (int c = 0; c < 3; c++) {
                    sums[c] += grid->means[27 * from + (size_t)(9 * (1 - dy) + 3 * (1 - dx) + c)];
                }
            }
            for (int c = 0; c < 3; c++) {
                grid->rgb[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] = (float)sums[c];
            }
        }
    }
}

// The mean picture, `error.rmse` of it off at the most, or as near as GRID_MOST allows; both sides a multiple of 8.
__attribute__((unused)) static Picture *grid_picture(const SamplingScene *scene, int width, int height,
                                                     const char *filter, double most)
{
    bool is_gaussian = filter && strcmp(filter, "gaussian") == 0;
    int left = is_gaussian ? width / 8 : 0, top = is_gaussian ? height / 8 : 0;
    Grid grid = {
        .width = width + 2 * left, .height = height + 2 * top, .left = left, .top = top, .is_gaussian = is_gaussian};
    size_t pixels = (size_t)grid.width * (size_t)grid.height;
    Picture *picture = calloc(1, sizeof *picture);
    grid.means = calloc(pixels, 27 * sizeof *grid.means);
    grid.errors = calloc(pixels, sizeof *grid.errors);
    grid.rgb = picture->rgb = calloc((size_t)width * (size_t)height, 3 * sizeof *picture->rgb);
    grid_load(&grid, scene, is_gaussian ? 1.25 : 1.0);
    grid_trace(&grid, most);
    grid_gather(&grid);
    picture->width = width;
    picture->height = height;
    picture->error = (rt_error){.rmse = grid_error(&grid), .samples = grid.rays / (width * height)};
    rt_session_free(grid.session);
    free(grid.means);
    free(grid.errors);
    return picture;
}

#endif
