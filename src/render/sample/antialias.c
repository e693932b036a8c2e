// Anti-aliasing of a tile: rays are asked for, traced by the kernel in full batches, and the rule is tried again until
// it asks for no more.
//
// Both rules look at what rays have brought before they ask for others, so tracing one ray at a time would be natural;
// a batch costs as much as eight of those. Colours are compared after a power, and averaged before it. Owns what a tile
// needs while it is made.
//
// SPDX-License-Identifier: MIT
#include "render/sample/antialias.h"

#include <math.h>
#include <stdlib.h>

#include "render/records/linear.h"
#include "render/records/prepared.h"
#include "render/sample/alpha.h"
#include "render/sample/tiles.h"

enum { EDGE = TILE_SIZE + 1, GRID_MOST = 256 };

// Light, and the share of what is behind the scene; or both as they are compared.
typedef struct Seen {
    Rgb light;
    double clear;
} Seen;

static Seen seen_add_scaled(Seen a, double share, Seen b)
{
    return (Seen){rgb_add_scaled(a.light, share, b.light), a.clear + share * b.clear};
}

static const Seen seen_nothing = {{0.0, 0.0, 0.0}, 0.0};

// ---- rays in batches

typedef struct Batch {
    const Prepared *prepared;
    RenderScratch *scratch;
    RenderStatistics *counted;
    KernelPlaces places;
    Seen *targets[KERNEL_RAYS]; // to which they are added
    int count;
} Batch;

static void batch_flush(Batch *batch)
{
    Rgb light[KERNEL_RAYS];
    double clear[KERNEL_RAYS] = {0.0};
    uint64_t wanted = batch->count == KERNEL_RAYS ? UINT64_MAX : (UINT64_C(1) << batch->count) - 1;
    if (batch->count == 0) {
        return;
    }
    for (int i = batch->count; i < KERNEL_RAYS; i++) {
        batch->places.u[i] = batch->places.u[batch->count - 1];
        batch->places.v[i] = batch->places.v[batch->count - 1];
    }
    const KernelCall call = {&batch->places, wanted, NULL, light, batch->scratch, batch->counted};
    alpha_trace(batch->prepared, &call, clear);
    for (int i = 0; i < batch->count; i++) {
        *batch->targets[i] = seen_add_scaled(*batch->targets[i], 1.0, (Seen){light[i], clear[i]});
    }
    batch->count = 0;
}

// A ray through a point of the picture in pixels, (0, 0) being its upper left corner.
static void batch_add(Batch *batch, const Film *film, double x, double y, Seen *target)
{
    batch->places.u[batch->count] = x / film->width - 0.5;
    batch->places.v[batch->count] = y / film->height - 0.5;
    batch->targets[batch->count++] = target;
    if (batch->count == KERNEL_RAYS) {
        batch_flush(batch);
    }
}

static void film_set(Film *film, int x, int y, Seen seen)
{
    size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
    float *rgb = &film->rgb[3 * pixel];
    rgb[0] = (float)seen.light.red;
    rgb[1] = (float)seen.light.green;
    rgb[2] = (float)seen.light.blue;
    if (film_background(film)) {
        film_background(film)[pixel] = (float)seen.clear;
    }
}

// ---- colours compared

// As it is compared: in linear light after a power, so that what is darker counts for more; the share as it is.
static Seen seen_as(const Batch *batch, const AntialiasOptions *options, Seen seen)
{
    Rgb light = seen.light;
    const Settings *settings = &batch->prepared->scene->settings;
    double power = 1.0 / options->gamma;
    return (Seen){rgb(pow(linear_value(settings, light.red), power), pow(linear_value(settings, light.green), power),
                      pow(linear_value(settings, light.blue), power)),
                  seen.clear};
}

static bool differ(const AntialiasOptions *options, Seen one, Seen other)
{
    Rgb a = one.light, b = other.light;
    return fabs(a.red - b.red) + fabs(a.green - b.green) + fabs(a.blue - b.blue) + fabs(one.clear - other.clear) >=
           options->threshold;
}

// ---- method 1: pixels that differ from a neighbour

typedef struct Spot {
    Seen centre, mean, centre_seen, mean_seen;
    bool is_known;    // the mean
    bool is_averaged; // the pixel is its mean
} Spot;

// A tile with the pixels above and to the left of it, beyond the picture, too.
typedef struct Spots {
    const AntialiasOptions *options;
    Tile tile;
    Film *film;
    Spot spots[EDGE][EDGE];
} Spots;

static void trace_centres(Spots *spots, Batch *batch)
{
    for (int y = spots->tile.top - 1; y < spots->tile.bottom; y++) {
        for (int x = spots->tile.left - 1; x < spots->tile.right; x++) {
            Spot *spot = &spots->spots[y - spots->tile.top + 1][x - spots->tile.left + 1];
            *spot = (Spot){.centre = seen_nothing};
            batch_add(batch, spots->film, x + 0.5, y + 0.5, &spot->centre);
        }
    }
    batch_flush(batch);
    for (int i = 0; i < EDGE * EDGE; i++) {
        Spot *spot = &spots->spots[i / EDGE][i % EDGE];
        spot->centre_seen = seen_as(batch, spots->options, spot->centre);
    }
}

// A neighbour is compared as it is by now, the pixel by its middle. Both are averaged.
static void compare(const AntialiasOptions *options, Spot *spot, Spot *neighbour)
{
    bool is_mean = neighbour->is_averaged && neighbour->is_known;
    if (differ(options, spot->centre_seen, is_mean ? neighbour->mean_seen : neighbour->centre_seen)) {
        spot->is_averaged = neighbour->is_averaged = true;
    }
}

// Marks pixels in the order of the text, as far as means are known. The mark of a pixel is set after both comparisons.
static void mark(Spots *spots, int rows, int columns)
{
    for (int i = 0; i < EDGE * EDGE; i++) {
        spots->spots[i / EDGE][i % EDGE].is_averaged = false;
    }
    for (int y = 0; y < rows; y++) {
        for (int x = 0; x < columns; x++) {
            if (x > 0) {
                compare(spots->options, &spots->spots[y][x], &spots->spots[y][x - 1]);
            }
            if (y > 0) {
                compare(spots->options, &spots->spots[y][x], &spots->spots[y - 1][x]);
            }
        }
    }
}

static void want_mean(const Spots *spots, Batch *batch, int row, int column, Spot *spot)
{
    int n = spots->options->depth;
    double left = spots->tile.left + column - 1, top = spots->tile.top + row - 1;
    spot->mean = spot->centre;
    for (int i = 0; i < n * n; i++) {
        batch_add(batch, spots->film, left + (i % n + 0.5) / n, top + ((double)(i / n) + 0.5) / n, &spot->mean);
    }
}

// Traces the means that marks ask for; false when all are known.
static bool trace_means(Spots *spots, Batch *batch)
{
    int n = spots->options->depth;
    Spot *asked[EDGE * EDGE];
    int count = 0;
    for (int i = 0; i < EDGE * EDGE; i++) {
        Spot *spot = &spots->spots[i / EDGE][i % EDGE];
        if (spot->is_averaged && !spot->is_known) {
            want_mean(spots, batch, i / EDGE, i % EDGE, spot);
            asked[count++] = spot;
        }
    }
    batch_flush(batch);
    for (int i = 0; i < count; i++) {
        asked[i]->mean = seen_add_scaled(seen_nothing, 1.0 / (n * n + 1), asked[i]->mean);
        asked[i]->mean_seen = seen_as(batch, spots->options, asked[i]->mean);
        asked[i]->is_known = true;
    }
    return count > 0;
}

static bool tile_by_neighbours(const AntialiasOptions *options, Tile tile, Film *film, Batch *batch)
{
    Spots *spots = calloc(1, sizeof *spots);
    int rows = tile.bottom - tile.top + 1, columns = tile.right - tile.left + 1;
    if (!spots) {
        return false;
    }
    spots->options = options;
    spots->tile = tile;
    spots->film = film;
    trace_centres(spots, batch);
    do {
        mark(spots, rows, columns);
    } while (trace_means(spots, batch));
    for (int y = 1; y < rows; y++) {
        for (int x = 1; x < columns; x++) {
            const Spot *spot = &spots->spots[y][x];
            film_set(film, tile.left + x - 1, tile.top + y - 1, spot->is_averaged ? spot->mean : spot->centre);
        }
    }
    free(spots);
    return true;
}

// ---- method 2: squares whose corners differ

typedef enum PointState { POINT_UNKNOWN, POINT_WANTED, POINT_KNOWN } PointState;

typedef struct Point {
    Seen light, seen;
    PointState state;
} Point;

// The points of some pixels that rays may go through: `steps` to a pixel, and their right and lower ends.
typedef struct Grid {
    const AntialiasOptions *options;
    Film *film;
    Tile pixels;
    int steps, row; // points in a row
    Point *points;
} Grid;

static Point *grid_at(const Grid *grid, int x, int y)
{
    return &grid->points[(size_t)y * (size_t)grid->row + (size_t)x];
}

static void trace_points(const Grid *grid, Batch *batch)
{
    int rows = (grid->pixels.bottom - grid->pixels.top) * grid->steps + 1;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < rows * grid->row; i++) {
            Point *point = &grid->points[i];
            if (point->state == POINT_WANTED && pass == 0) {
                point->light = seen_nothing;
                batch_add(batch, grid->film, grid->pixels.left + (double)(i % grid->row) / grid->steps,
                          grid->pixels.top + (double)(i / grid->row) / grid->steps, &point->light);
            } else if (point->state == POINT_WANTED) {
                point->seen = seen_as(batch, grid->options, point->light);
                point->state = POINT_KNOWN;
            }
        }
        batch_flush(batch);
    }
}

static bool corners_differ(const Grid *grid, Point *const corners[static 4])
{
    for (int i = 0; i < 4; i++) {
        for (int j = i + 1; j < 4; j++) {
            if (differ(grid->options, corners[i]->seen, corners[j]->seen)) {
                return true;
            }
        }
    }
    return false;
}

// The mean over a square, or false, and what it still needs is wanted. As deep as the options say.
static bool square_mean(const Grid *grid, int x, int y, int size, Seen *mean)
{
    Point *corners[] = {grid_at(grid, x, y), grid_at(grid, x + size, y), grid_at(grid, x, y + size),
                        grid_at(grid, x + size, y + size)};
    bool is_known = true;
    *mean = seen_nothing;
    for (int i = 0; i < 4; i++) {
        corners[i]->state = corners[i]->state == POINT_UNKNOWN ? POINT_WANTED : corners[i]->state;
        is_known = is_known && corners[i]->state == POINT_KNOWN;
        *mean = seen_add_scaled(*mean, 0.25, corners[i]->light);
    }
    if (!is_known || size == 1 || !corners_differ(grid, corners)) {
        return is_known;
    }
    *mean = seen_nothing;
    for (int i = 0; i < 4; i++) {
        Seen part;
        int half = size / 2;
        is_known = square_mean(grid, x + i % 2 * half, y + i / 2 * half, half, &part) && is_known;
        *mean = seen_add_scaled(*mean, 0.25, part);
    }
    return is_known;
}

static void pixels_by_corners(const Grid *grid, Batch *batch)
{
    const Tile *pixels = &grid->pixels;
    bool is_done;
    do {
        is_done = true;
        for (int y = pixels->top; y < pixels->bottom; y++) {
            for (int x = pixels->left; x < pixels->right; x++) {
                Seen mean;
                bool is_known = square_mean(grid, (x - pixels->left) * grid->steps, (y - pixels->top) * grid->steps,
                                            grid->steps, &mean);
                film_set(grid->film, x, y, mean);
                is_done = is_done && is_known;
            }
        }
        trace_points(grid, batch);
    } while (!is_done);
}

static bool tile_by_corners(const AntialiasOptions *options, Tile tile, Film *film, Batch *batch)
{
    int steps = 1 << (options->depth - 1);
    int side = GRID_MOST / steps < TILE_SIZE ? GRID_MOST / steps : TILE_SIZE; // pixels at a time
    size_t count = (size_t)(side * steps + 1) * (size_t)(side * steps + 1);
    Grid grid = {.options = options, .film = film, .steps = steps, .points = malloc(count * sizeof *grid.points)};
    for (int top = tile.top; grid.points && top < tile.bottom; top += side) {
        for (int left = tile.left; left < tile.right; left += side) {
            grid.pixels = (Tile){left, top, left + side < tile.right ? left + side : tile.right,
                                 top + side < tile.bottom ? top + side : tile.bottom};
            grid.row = (grid.pixels.right - left) * steps + 1;
            for (size_t i = 0; i < count; i++) {
                grid.points[i] = (Point){.state = POINT_UNKNOWN};
            }
            pixels_by_corners(&grid, batch);
        }
    }
    bool fine = grid.points != NULL;
    free(grid.points);
    return fine;
}

bool antialias_tile(const Prepared *prepared, const AntialiasOptions *options, Tile tile, Film *film,
                    RenderScratch *scratch, RenderStatistics *counted)
{
    Batch batch = {.prepared = prepared, .scratch = scratch, .counted = counted};
    return options->method == 1 ? tile_by_neighbours(options, tile, film, &batch)
                                : tile_by_corners(options, tile, film, &batch);
}
