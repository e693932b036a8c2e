// See overlay.h.
//
// SPDX-License-Identifier: MIT
#include "render/inspect/overlay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "math/extreme.h"
#include "render/records/camera.h"
#include "render/sample/scratch.h"
#include "render/sample/tiles.h"
#include "scene/scene_extent.h"
#include "trace/query_surface.h"

enum { PARTS = OVERLAY_PARTS, PARTS_ALL = PARTS * PARTS, ROWS = TILE_SIZE * PARTS, WORD = 64, ROW_WORDS = ROWS / WORD };

// What is seen at a place of the picture.
typedef struct Seen {
    uint32_t object;         // as of FILM_OBJECT; 0: nothing
    Vec3 ray, point, normal; // normal: on the side that is seen
    double depth;            // along the camera's direction, in the scene's lengths
} Seen;

typedef struct Overlay {
    const Prepared *prepared;
    const OverlayOptions *options;
    Film *film;
    int margin; // pixels around a tile that have a say in it
    atomic_bool has_no_memory;
} Overlay;

// A tile and its margin, as far as that lies in the whole picture: pixels of the film, which may be outside of it.
typedef struct Area {
    Tile own;
    int left, top, width, height;
    Seen *middles;                // of pixels
    uint32_t *finer;              // of pixels: which of `parts` they have, from 1; 0: none
    Seen *parts;                  // PARTS_ALL each, in rows
    uint32_t count;               // of pixels that have parts
    uint64_t (*lines)[ROW_WORDS]; // places of the tile's own pixels on a line, a bit each
} Area;

// ---- what is seen

static Seen seen_of(const Prepared *p, Ray ray, Hit hit)
{
    Surface surface = geometry_surface(p->geometry, TRACE_ALL_FEATURES, ray, hit);
    Vec3 ahead = vec3_normalize(p->camera.direction), normal = surface.normal;
    (void)geometry_flat_normal(p->geometry, hit.shape, &normal); // that of smooth triangles is not their own
    normal = vec3_dot(normal, ray.direction) > 0.0 ? vec3_neg(normal) : normal;
    return (Seen){surface.order + 1, ray.direction, surface.point, normal,
                  vec3_dot(vec3_sub(surface.point, p->camera.location), ahead) * p->textures.scale};
}

// What is seen at those of some places that are wanted, a bit each; the others are places, too.
static void look(const Prepared *p, const KernelPlaces *places, uint64_t wanted, Seen *seen, RenderScratch *scratch)
{
    const PreparedCamera *camera = &p->camera;
    TileView view = {camera->location, camera->direction, camera->right, camera->up};
    SphereTile *tile = &scratch->tile.rays;
    bool is_view = camera->type == CAMERA_PERSPECTIVE;
    TileHits found;
    if (is_view) {
        geometry_closest_view(p->geometry, TRACE_ALL_FEATURES, &view, places->u, places->v, tile, &found);
    }
    for (; wanted; wanted &= wanted - 1) {
        unsigned i = (unsigned)__builtin_ctzll(wanted);
        Ray ray;
        Hit hit = {.shape = SHAPE_NONE};
        bool is_met;
        if (is_view) {
            SphereRay own = sphere_tile_ray(tile, i);
            ray = (Ray){own.origin, own.direction};
            hit = (Hit){found.t[i], found.shape[i], found.inside >> i & 1};
            is_met = found.met >> i & 1;
        } else {
            is_met = camera_ray(camera, places->u[i], places->v[i], &ray) &&
                     geometry_closest(p->geometry, TRACE_ALL_FEATURES, ray, RAY_START_CAMERA, (double)INFINITY, &hit);
        }
        seen[i] = is_met ? seen_of(p, ray, hit) : (Seen){.object = 0};
    }
}

static size_t at(const Area *area, int x, int y)
{
    return (size_t)(y - area->top) * (size_t)area->width + (size_t)(x - area->left);
}

static void look_at_middles(const Overlay *overlay, Area *area, RenderScratch *scratch)
{
    Tile whole = {area->left, area->top, area->left + area->width, area->top + area->height};
    Seen seen[KERNEL_RAYS];
    KernelPlaces places = {.lens = NULL};
    for (int top = whole.top; top < whole.bottom; top += KERNEL_ROW) {
        for (int left = whole.left; left < whole.right; left += KERNEL_ROW) {
            Tile block = tile_block(whole, left, top);
            uint64_t wanted = block_places(overlay->film, block, 0.0, &places);
            look(overlay->prepared, &places, wanted, seen, scratch);
            for (int y = top; y < block.bottom; y++) {
                memcpy(&area->middles[at(area, left, y)], &seen[(y - top) * KERNEL_ROW],
                       (size_t)(block.right - left) * sizeof *seen);
            }
        }
    }
}

// How far one surface, were it even, would be from the other one along the other's ray, over what is between the two.
static double misses(const Seen *from, const Seen *to, Vec3 way, double length)
{
    double off = fabs(vec3_dot(way, from->normal)), slope = fabs(vec3_dot(to->ray, from->normal));
    return off / greater_of(slope * length, 0x1p-1000);
}

// Whether a line goes between two places: where something ends; where two objects meet at an angle, so not between the
// triangles of a mesh and the halves of a bond; and where what is seen is before something else, an object before
// itself, too. Then one place is above the other's tangent plane, which is above its own. At an edge or a bend both are
// below, or both above.
static bool differ(const Seen *a, const Seen *b)
{
    const double even = 0.2, apart = 0.5, alike = 0.9;
    if (a->object == 0 || b->object == 0) {
        return a->object != b->object;
    }
    Vec3 way = vec3_sub(b->point, a->point);
    double length = vec3_length(way), above = vec3_dot(way, a->normal), below = -vec3_dot(way, b->normal);
    bool is_one = a->object == b->object, is_before = above * below < 0.0;
    if (is_one) {
        return is_before && greater_of(fabs(above), fabs(below)) > even * length;
    }
    return vec3_dot(a->normal, b->normal) < alike ||
           (is_before && greater_of(misses(a, b, way, length), misses(b, a, way, length)) > apart);
}

static bool differs_around(const Area *area, int x, int y)
{
    const Seen *own = &area->middles[at(area, x, y)];
    return (x > area->left && differ(own, &area->middles[at(area, x - 1, y)])) ||
           (x + 1 < area->left + area->width && differ(own, &area->middles[at(area, x + 1, y)])) ||
           (y > area->top && differ(own, &area->middles[at(area, x, y - 1)])) ||
           (y + 1 < area->top + area->height && differ(own, &area->middles[at(area, x, y + 1)]));
}

// Numbers the pixels that differ from a neighbour. Those at the margin's end are not: not all of theirs are known.
static void find_finer(const Overlay *overlay, Area *area)
{
    const Tile *own = &area->own;
    int margin = overlay->margin - 1;
    for (int y = area->top; y < area->top + area->height; y++) {
        for (int x = area->left; x < area->left + area->width; x++) {
            bool is_inner = x >= own->left - margin && x < own->right + margin && y >= own->top - margin &&
                            y < own->bottom + margin;
            area->finer[at(area, x, y)] = is_inner && differs_around(area, x, y) ? ++area->count : 0;
        }
    }
}

// The parts of a pixel, as the places of a call from its number on.
static void put_parts(const Film *film, int x, int y, int first, KernelPlaces *places)
{
    for (int k = 0; k < PARTS_ALL; k++) {
        places->u[first + k] = film_u(film, x, (k % PARTS + 0.5) / PARTS - 0.5);
        places->v[first + k] = film_v(film, y, (k / PARTS + 0.5) / PARTS - 0.5);
    }
}

// Numbers are in the order in which pixels are gone through, so those of one call follow each other.
static void look_finer(const Overlay *overlay, Area *area, RenderScratch *scratch)
{
    KernelPlaces places = {.lens = NULL};
    uint32_t looked = 0;
    for (int y = area->top; y < area->top + area->height; y++) {
        for (int x = area->left; x < area->left + area->width; x++) {
            uint32_t number = area->finer[at(area, x, y)];
            if (number == 0) {
                continue;
            }
            int first = (int)(number - 1 - looked) * PARTS_ALL;
            for (int i = first; i < KERNEL_RAYS; i += PARTS_ALL) { // what follows may overwrite it
                put_parts(overlay->film, x, y, i, &places);
            }
            if (first + PARTS_ALL == KERNEL_RAYS || number == area->count) {
                uint64_t wanted = UINT64_MAX >> (KERNEL_RAYS - first - PARTS_ALL);
                look(overlay->prepared, &places, wanted, &area->parts[(size_t)looked * PARTS_ALL], scratch);
                looked = number;
            }
        }
    }
}

// ---- lines

// The part of a pixel, from the area's own first one on; NULL where it has none.
static const Seen *part_at(const Area *area, int column, int row)
{
    int x = area->own.left + (column >= 0 ? column / PARTS : -((PARTS - 1 - column) / PARTS));
    int y = area->own.top + (row >= 0 ? row / PARTS : -((PARTS - 1 - row) / PARTS));
    if (x < area->left || y < area->top || x >= area->left + area->width || y >= area->top + area->height) {
        return NULL;
    }
    uint32_t number = area->finer[at(area, x, y)];
    int inner = column - (x - area->own.left) * PARTS + (row - (y - area->own.top) * PARTS) * PARTS;
    return number > 0 ? &area->parts[(size_t)(number - 1) * PARTS_ALL + (size_t)inner] : NULL;
}

// Sets the bits of a row from one column to another.
static void line_run(uint64_t row[ROW_WORDS], int from, int to)
{
    for (int i = 0; i < ROW_WORDS; i++) {
        int low = from > i * WORD ? from - i * WORD : 0, high = to < i * WORD + WORD - 1 ? to - i * WORD : WORD - 1;
        if (low <= high && low < WORD && high >= 0) {
            row[i] |= (~UINT64_C(0) >> (WORD - 1 - (high - low))) << low;
        }
    }
}

// A disc of a line's width.
static void line_dot(const Overlay *overlay, Area *area, double x, double y)
{
    double radius = 0.5 * overlay->options->outline_width * PARTS;
    int first = (int)greater_of(ceil(y - radius), 0.0), last = (int)less_of(floor(y + radius), ROWS - 1);
    for (int row = first; row <= last; row++) {
        double half = sqrt(greater_of(radius * radius - (row - y) * (row - y), 0.0));
        line_run(area->lines[row], (int)greater_of(ceil(x - half), 0.0), (int)less_of(floor(x + half), ROWS - 1));
    }
}

// A dot between all parts and those at the right of them and below that differ.
static void draw_lines(const Overlay *overlay, Area *area)
{
    int first_column = (area->left - area->own.left) * PARTS, end_column = first_column + area->width * PARTS;
    int first_row = (area->top - area->own.top) * PARTS, end_row = first_row + area->height * PARTS;
    for (int row = first_row; row < end_row; row++) {
        for (int column = first_column; column < end_column; column++) {
            const Seen *own = part_at(area, column, row);
            const Seen *right = own ? part_at(area, column + 1, row) : NULL;
            const Seen *below = own ? part_at(area, column, row + 1) : NULL;
            if (right && differ(own, right)) {
                line_dot(overlay, area, column + 0.5, row);
            }
            if (below && differ(own, below)) {
                line_dot(overlay, area, column, row + 0.5);
            }
        }
    }
}

// The share of a pixel that lines cover.
static double line_share(const Area *area, int x, int y)
{
    int count = 0, column = (x - area->own.left) * PARTS;
    for (int row = (y - area->own.top) * PARTS; row < (y - area->own.top + 1) * PARTS; row++) {
        count += __builtin_popcountll(area->lines[row][column / WORD] >> column % WORD & ((1u << PARTS) - 1));
    }
    return (double)count / PARTS_ALL;
}

// ---- the depth cue

static double cue_of(const Overlay *overlay, const Seen *seen)
{
    double far = overlay->options->cue_far, near = overlay->options->cue_near;
    if (seen->object == 0 || !(far > near)) {
        return 0.0;
    }
    return overlay->options->cue_strength * less_of(greater_of((seen->depth - near) / (far - near), 0.0), 1.0);
}

static double cue_share(const Overlay *overlay, const Area *area, int x, int y)
{
    uint32_t number = area->finer[at(area, x, y)];
    double sum = 0.0;
    if (number == 0) {
        return cue_of(overlay, &area->middles[at(area, x, y)]);
    }
    for (size_t k = 0; k < PARTS_ALL; k++) {
        sum += cue_of(overlay, &area->parts[(size_t)(number - 1) * PARTS_ALL + k]);
    }
    return sum / PARTS_ALL;
}

// ---- tiles

static void cover(float *values, Rgb colour, double share, double part)
{
    const double own[] = {colour.red, colour.green, colour.blue};
    for (int i = 0; i < 3; i++) {
        values[i] = (float)((1.0 - share) * (double)values[i] + share * part * own[i]);
    }
}

static void draw_pixels(const Overlay *overlay, const Area *area)
{
    Film *film = overlay->film;
    const OverlayOptions *options = overlay->options;
    float *background = film_background(film);
    for (int y = area->own.top; y < area->own.bottom; y++) {
        for (int x = area->own.left; x < area->own.right; x++) {
            size_t pixel = (size_t)y * (size_t)film->width + (size_t)x;
            double line = options->outline_width > 0.0 ? line_share(area, x, y) : 0.0;
            if (options->cue_strength > 0.0) {
                double part = background ? 1.0 - (double)background[pixel] : 1.0;
                cover(&film->rgb[3 * pixel], options->cue_color, cue_share(overlay, area, x, y), part);
            }
            if (line > 0.0) {
                cover(&film->rgb[3 * pixel], options->outline_color, line, 1.0);
            }
            if (line > 0.0 && background) {
                background[pixel] = (float)((1.0 - line) * (double)background[pixel]);
            }
        }
    }
}

static bool draw_area(const Overlay *overlay, Area *area, RenderScratch *scratch)
{
    look_at_middles(overlay, area, scratch);
    find_finer(overlay, area);
    area->parts = malloc(((size_t)area->count * PARTS_ALL + 1) * sizeof *area->parts);
    if (!area->parts) {
        return false;
    }
    look_finer(overlay, area, scratch);
    if (overlay->options->outline_width > 0.0) {
        draw_lines(overlay, area);
    }
    draw_pixels(overlay, area);
    return true;
}

static void overlay_tile(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    (void)counted;
    Overlay *overlay = client;
    const Film *film = overlay->film;
    int left = tile.left - overlay->margin, top = tile.top - overlay->margin;
    int right = tile.right + overlay->margin, bottom = tile.bottom + overlay->margin;
    left = left > -film->left ? left : -film->left;
    top = top > -film->top ? top : -film->top;
    right = right < film->whole_width - film->left ? right : film->whole_width - film->left;
    bottom = bottom < film->whole_height - film->top ? bottom : film->whole_height - film->top;
    Area area = {.own = tile, .left = left, .top = top, .width = right - left, .height = bottom - top};
    size_t pixels = (size_t)area.width * (size_t)area.height;
    area.middles = malloc(pixels * sizeof *area.middles);
    area.finer = malloc(pixels * sizeof *area.finer);
    area.lines = calloc(ROWS, sizeof *area.lines);
    if (!area.middles || !area.finer || !area.lines || !draw_area(overlay, &area, scratch)) {
        atomic_store(&overlay->has_no_memory, true);
    }
    free(area.middles);
    free(area.finer);
    free(area.lines);
    free(area.parts);
}

void overlay_find_reach(OverlayOptions *options, const Scene *scene)
{
    double low, high, length = vec3_length(scene->camera.direction);
    Vec3 ahead = vec3_scale(length > 0.0 ? 1.0 / length : 0.0, scene->camera.direction);
    if (options->cue_strength > 0.0 && options->cue_near == 0.0 && options->cue_far == 0.0 &&
        scene_span(scene, ahead, &low, &high)) {
        double eye = vec3_dot(scene->camera.location, ahead);
        options->cue_near = greater_of(low - eye, 0.0);
        options->cue_far = high - eye;
    }
}

RenderResult render_overlay(const Prepared *prepared, int threads, const OverlayOptions *options, Film *film)
{
    Overlay overlay = {.prepared = prepared, .options = options, .film = film};
    overlay.margin = options->outline_width > 0.0 ? (int)ceil(0.5 * options->outline_width) + 2 : 1;
    prepared->abandon->cancel = NULL;
    TileWork work = {
        .client = &overlay, .prepared = prepared, .width = film->width, .height = film->height, .trace = overlay_tile};
    RenderStatistics unused = {0};
    RenderResult result = tiles_run(&work, &(RenderOptions){.threads = threads}, &unused);
    return atomic_load(&overlay.has_no_memory) ? RENDER_NO_MEMORY : result;
}
