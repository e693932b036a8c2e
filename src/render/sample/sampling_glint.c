// Narrow highlights of bumpy surfaces, and of others than spheres and planes: searched for from the pixels.
//
// Such a highlight has no formula for its place, but what it goes by is known at each point of the surface: the mirrored
// direction less that to the light. From a pixel's middle Newton's method (Gauss's for three components of two unknowns)
// goes to where that is least, with differences for derivatives; there they also give the ellipse in which it is small.
// Only first hits and their normals are computed for it, no light. Bumps much finer than pixels have many highlights in
// each, of which some are found; of those the samples meet enough. docs/sampling.md, "What no sample met".
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>

#include "render/records/camera.h"
#include "render/sample/sampling_small.h"
#include "render/sample/tiles.h"
#include "render/shade/light.h"
#include "render/shade/surface_uv.h"

// Where a highlight falls to e^-4 when the mirrored direction is turned by more, it is no narrow one.
static const double TURNED_MOST = 0.2;

// A search begins where the mirrored direction is nearer to the light than this, and has found a highlight within this
// part of where it falls to e^-4, no more than so many pixels off. Of two that are nearer than this part one is left out.
static const double APART_MOST = 1.0, REACHED = 0.75, REACH = 1.0, SAME = 0.5;

// Of pixels: for differences; the longest step, and one that ends a search.
static const double DELTA = 0.125, STEP_MOST = 0.5, STEP_LEAST = 0.01;

enum { STEPS = 6, KINDS = 2 };

// What is seen at a place of the film, turned to the viewer.
typedef struct Facet {
    Hit hit;
    Surface surface; // as it is without bumps
    Vec3 direction, normal;
    const PreparedFinish *finish; // NULL: no narrow highlight that is to be searched for
} Facet;

// How one kind of a light's highlight changes around a place.
typedef struct Slope {
    Facet facet;
    Vec3 apart, by_x, by_y; // mirrored direction less that to the light, and by pixels
    Vec3 point_x, point_y;  // the point, by pixels
} Slope;

typedef struct Search {
    const Prepared *prepared;
    const Film *film;
    const PreparedLight *light;
    bool is_specular;
} Search;

// The highlight that was found from a pixel.
typedef struct Glint {
    float x, y;    // of the film
    int32_t which; // twice the light's number, one more of `specular`; < 0: none
} Glint;

typedef struct Glints {
    const Prepared *prepared;
    const Film *film;
    Glint *of_pixel;
} Glints;

// How far the mirrored direction is turned where the highlight falls to e^-4; of `specular`, by twice what the middle of
// both directions is.
static double turned_of(const PreparedFinish *finish, bool is_specular)
{
    if (is_specular) {
        return finish->specular > 0.0 ? 2.0 * sqrt(8.0 / finish->shininess) : HUGE_VAL;
    }
    return finish->phong > 0.0 ? sqrt(8.0 / finish->phong_size) : HUGE_VAL;
}

static bool is_sharp(const PreparedFinish *finish)
{
    return finish->shines && fmin(turned_of(finish, false), turned_of(finish, true)) <= TURNED_MOST;
}

// Takes the first layer that has a sharp finish.
typedef struct LayerSearch {
    const Prepared *prepared;
    Facet *facet;
} LayerSearch;

static Rgb visit_layer(void *client, const TextureLayer *layer)
{
    LayerSearch *search = client;
    const PreparedFinish *finish = &search->prepared->finishes[layer->finish];
    if (!search->facet->finish && is_sharp(finish)) {
        search->facet->finish = finish;
        if (layer->normal != RECORD_NONE) {
            search->facet->normal = texture_normal(layer, search->facet->normal);
        }
    }
    return rgb_grey(1.0);
}

// False where nothing is seen.
static bool facet_at(const Prepared *p, const Film *film, double x, double y, Facet *facet)
{
    Ray ray;
    if (!camera_ray(&p->camera, film_u(film, 0, x), film_v(film, 0, y), &ray) ||
        !extent_first(p->geometry, ray, &facet->hit, &facet->surface)) {
        return false;
    }
    MaterialIndex material = shade_side(p, facet->surface.material, facet->surface.normal, ray.direction);
    ShapeKind kind = shape_kind(facet->hit.shape);
    facet->direction = ray.direction;
    facet->normal = facet->hit.inside ? vec3_neg(facet->surface.normal) : facet->surface.normal;
    facet->finish = NULL;
    if ((kind == SHAPE_SPHERE || kind == SHAPE_PLANE) && spot_finish(p, material)) {
        return true; // sampling_spot.c knows those
    }
    if (material & MATERIAL_COMPOUND) {
        LayerSearch search = {p, facet};
        uint32_t texture = p->compounds[material & ~MATERIAL_COMPOUND].texture;
        Vec3 room;
        const Vec3 *uv = shade_uv(p, texture, facet->hit.shape, facet->surface.point, facet->direction, &room);
        TextureSight sight = {facet->surface.point, uv, &facet->normal, &facet->direction, false};
        (void)texture_walk(&p->textures, texture, sight, p->adc_bailout, visit_layer, &search);
    } else if (is_sharp(&p->finishes[p->materials[material].finish])) {
        facet->finish = &p->finishes[p->materials[material].finish];
    }
    return true;
}

// The mirrored direction less that to the light; of `specular`, twice the middle of both less the normal, which is as
// much.
static Vec3 apart_of(const Search *search, const Facet *facet)
{
    double unused;
    Vec3 towards = spot_to_light(search->light, facet->surface.point, &unused);
    if (search->is_specular) {
        Vec3 middle = vec3_normalize(vec3_sub(towards, facet->direction));
        return vec3_scale(2.0, vec3_sub(facet->normal, middle));
    }
    return vec3_sub(vec3_reflect(facet->direction, facet->normal), towards);
}

// False where a place beside shows another shape.
static bool slope_at(const Search *search, double x, double y, Slope *slope)
{
    Vec3 aparts[2], points[2];
    if (!facet_at(search->prepared, search->film, x, y, &slope->facet) || !slope->facet.finish) {
        return false;
    }
    for (int axis = 0; axis < 2; axis++) {
        Facet next;
        if (!facet_at(search->prepared, search->film, x + (axis == 0 ? DELTA : 0.0), y + (axis == 1 ? DELTA : 0.0),
                      &next) ||
            next.hit.shape != slope->facet.hit.shape || next.finish != slope->facet.finish) {
            return false;
        }
        aparts[axis] = apart_of(search, &next);
        points[axis] = next.surface.point;
    }
    slope->apart = apart_of(search, &slope->facet);
    slope->by_x = vec3_scale(1.0 / DELTA, vec3_sub(aparts[0], slope->apart));
    slope->by_y = vec3_scale(1.0 / DELTA, vec3_sub(aparts[1], slope->apart));
    slope->point_x = vec3_scale(1.0 / DELTA, vec3_sub(points[0], slope->facet.surface.point));
    slope->point_y = vec3_scale(1.0 / DELTA, vec3_sub(points[1], slope->facet.surface.point));
    return true;
}

// The step to where the highlight is brightest, were it as the slope says.
static bool step_of(const Slope *slope, double *x, double *y)
{
    double xx = vec3_length_squared(slope->by_x), yy = vec3_length_squared(slope->by_y);
    double xy = vec3_dot(slope->by_x, slope->by_y), size = xx * yy - xy * xy;
    double at_x = vec3_dot(slope->by_x, slope->apart), at_y = vec3_dot(slope->by_y, slope->apart);
    *x = -(yy * at_x - xy * at_y) / size;
    *y = -(xx * at_y - xy * at_x) / size;
    return size > 0.0 && isfinite(*x) && isfinite(*y);
}

// Goes from a pixel's middle to the highlight near it; how far from the light it is there, HUGE_VAL if there is none.
static double search_run(const Search *search, const double middle[2], Glint *glint)
{
    double x = middle[0], y = middle[1], best = HUGE_VAL;
    for (int i = 0; i < STEPS; i++) {
        Slope slope;
        double step_x, step_y;
        if (!slope_at(search, x, y, &slope)) {
            break;
        }
        double apart = vec3_length(slope.apart);
        if (apart < best && fabs(x - middle[0]) <= REACH && fabs(y - middle[1]) <= REACH) {
            best = apart;
            glint->x = (float)x;
            glint->y = (float)y;
        }
        if (!step_of(&slope, &step_x, &step_y)) {
            break;
        }
        double length = hypot(step_x, step_y), scale = length > STEP_MOST ? STEP_MOST / length : 1.0;
        x += scale * step_x;
        y += scale * step_y;
        if (length < STEP_LEAST || fabs(x - middle[0]) > 2.0 * REACH || fabs(y - middle[1]) > 2.0 * REACH) {
            break;
        }
    }
    return best;
}

static void pixel_search(const Glints *glints, int column, int row, Glint *found)
{
    const Prepared *p = glints->prepared;
    Facet facet;
    double nearest = REACHED;
    *found = (Glint){.which = -1};
    if (!facet_at(p, glints->film, column, row, &facet) || !facet.finish) {
        return;
    }
    for (size_t i = 0; i < p->light_count; i++) {
        for (int kind = 0; kind < KINDS && spot_has_light(&p->lights[i]); kind++) {
            Search search = {p, glints->film, &p->lights[i], kind == 1};
            double turned = turned_of(facet.finish, search.is_specular);
            if (turned > TURNED_MOST || vec3_length(apart_of(&search, &facet)) > APART_MOST) {
                continue;
            }
            Glint glint = {.which = -1};
            double apart = search_run(&search, (double[2]){column, row}, &glint) / turned;
            if (apart < nearest) {
                nearest = apart;
                *found = (Glint){glint.x, glint.y, (int32_t)(KINDS * i) + kind};
            }
        }
    }
}

static void tile_search(void *client, Tile tile, RenderScratch *scratch, RenderStatistics *counted)
{
    Glints *glints = client;
    (void)scratch;
    (void)counted;
    for (int y = tile.top; y < tile.bottom; y++) {
        for (int x = tile.left; x < tile.right; x++) {
            pixel_search(glints, x, y, &glints->of_pixel[(size_t)y * (size_t)glints->film->width + (size_t)x]);
        }
    }
}

// The ellipse on the surface where the slope says that the mirrored direction is turned by less than `turned`.
static bool spot_of(const Slope *slope, double turned, SmallSpot *spot)
{
    double xx = vec3_length_squared(slope->by_x), yy = vec3_length_squared(slope->by_y);
    double xy = vec3_dot(slope->by_x, slope->by_y), root = sqrt(xx), lean = xy / root, rest = sqrt(yy - lean * lean);
    // The image of a circle under the inverse of a root of that form, and then its axes.
    Vec3 first = vec3_scale(turned / root, slope->point_x);
    Vec3 second = vec3_scale(turned / rest, vec3_add_scaled(slope->point_y, -lean / root, slope->point_x));
    double turn = 0.5 * atan2(2.0 * vec3_dot(first, second),
                              vec3_length_squared(first) - vec3_length_squared(second));
    *spot = (SmallSpot){.owner = slope->facet.hit.shape, .centre = slope->facet.surface.point};
    spot->axes[0] = vec3_add_scaled(vec3_scale(cos(turn), first), sin(turn), second);
    spot->axes[1] = vec3_add_scaled(vec3_scale(cos(turn), second), -sin(turn), first);
    return rest > 0.0 && vec3_is_finite(spot->axes[0]) && vec3_is_finite(spot->axes[1]) &&
           vec3_length_squared(spot->axes[0]) > 0.0 && vec3_length_squared(spot->axes[1]) > 0.0;
}

// Whether the highlight has been listed already, from another pixel. `at`: from which one that in a pixel was found.
static bool is_listed(const Glints *glints, const uint32_t *at, const Slope *slope, double turned, const Glint *glint)
{
    int column = (int)lround((double)glint->x), row = (int)lround((double)glint->y);
    for (int y = row - 1; y <= row + 1; y++) {
        for (int x = column - 1; x <= column + 1; x++) {
            bool is_inside = x >= 0 && x < glints->film->width && y >= 0 && y < glints->film->height;
            uint32_t from = is_inside ? at[(size_t)y * (size_t)glints->film->width + (size_t)x] : UINT32_MAX;
            if (from == UINT32_MAX || glints->of_pixel[from].which != glint->which) {
                continue;
            }
            const Glint *other = &glints->of_pixel[from];
            Vec3 apart = vec3_add_scaled(vec3_scale((double)(other->x - glint->x), slope->by_x),
                                         (double)(other->y - glint->y), slope->by_y);
            if (vec3_length(apart) < SAME * turned) {
                return true;
            }
        }
    }
    return false;
}

// Lists what was found, in the order of the pixels. False when out of memory.
static bool glints_list(const Glints *glints, Small *small, SpotIsNarrow *is_narrow, const void *view)
{
    const Film *film = glints->film;
    const Prepared *p = glints->prepared;
    size_t pixels = (size_t)film->width * (size_t)film->height;
    uint32_t *at = malloc(pixels * sizeof *at);
    bool has_memory = at != NULL;
    for (size_t i = 0; has_memory && i < pixels; i++) {
        at[i] = UINT32_MAX;
    }
    for (size_t i = 0; has_memory && i < pixels; i++) {
        const Glint *glint = &glints->of_pixel[i];
        if (glint->which < 0) {
            continue;
        }
        Search search = {p, film, &p->lights[glint->which / KINDS], glint->which % KINDS == 1};
        Slope slope;
        SmallSpot spot;
        if (!slope_at(&search, (double)glint->x, (double)glint->y, &slope)) {
            continue;
        }
        double turned = turned_of(slope.facet.finish, search.is_specular);
        int column = (int)lround((double)glint->x), row = (int)lround((double)glint->y);
        ShapeId owner = slope.facet.hit.shape;
        const Vec3 *plane = shape_kind(owner) == SHAPE_PLANE ? &slope.facet.surface.normal : NULL;
        if (spot_of(&slope, turned, &spot) && is_narrow(view, &spot) &&
            !is_listed(glints, at, &slope, turned, glint) &&
            spot_is_lit(p, search.light, owner, plane, spot.centre, slope.facet.normal)) {
            has_memory = spot_add(small, &spot);
            if (column >= 0 && column < film->width && row >= 0 && row < film->height) {
                at[(size_t)row * (size_t)film->width + (size_t)column] = (uint32_t)i;
            }
        }
    }
    free(at);
    return has_memory;
}

bool glints_find(Small *small, const RenderOptions *options, SpotIsNarrow *is_narrow, const void *view)
{
    const Prepared *p = small->prepared;
    const Film *film = small->film;
    bool any_sharp = false;
    for (size_t i = 0; i < p->finish_count; i++) {
        any_sharp = any_sharp || is_sharp(&p->finishes[i]);
    }
    if (!any_sharp || !(p->features & (RENDER_NORMALS | TRACE_PRIMITIVES))) {
        return true;
    }
    size_t pixels = (size_t)film->width * (size_t)film->height;
    Glints glints = {p, film, calloc(pixels, sizeof *glints.of_pixel)};
    if (!glints.of_pixel) {
        return false;
    }
    TileWork work = {
        .client = &glints, .prepared = p, .width = film->width, .height = film->height, .trace = tile_search};
    RenderStatistics unused = {0};
    RenderResult result = tiles_run(&work, options, &unused);
    uint32_t before = small->spot_count;
    bool has_memory = result == RENDER_OK ? glints_list(&glints, small, is_narrow, view) : result != RENDER_NO_MEMORY;
    small->glint_count = small->spot_count - before;
    free(glints.of_pixel);
    return has_memory;
}
