// The life of a pixel's ray as text, the tree of its rays first, or as one JSON object on one line.
//
// Turns the records of render/inspect/ray_log.h into what a reader or a program reads; docs/diagnostics.md lists the
// members. Works nothing out.
//
// SPDX-License-Identifier: MIT
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "api/ray_log_draw.h"
#include "api/session.h"
#include "base/json.h"
#include "render/inspect/ray_log.h"
#include "scene/recentre.h"

typedef struct Printer {
    TextBuffer *out;
    DiagSink *diags; // for places in the text
    const RayLog *ray_log;
    Vec3 origin; // to be added to places
    int digits;  // of numbers; 0: as many as tell them apart
} Printer;

enum { TREE_DIGITS = 4 };

static const char *const kind_words[] = {
    [LOGGED_CAMERA] = "camera",   [LOGGED_MIRRORED] = "mirrored", [LOGGED_TOTAL] = "totally reflected",
    [LOGGED_THROUGH] = "through", [LOGGED_BENT] = "bent",
};

static const char *const choice_words[] = {
    [LOGGED_MISSES] = "none", [LOGGED_BEHIND] = "behind", [LOGGED_NEAR] = "near",
    [LOGGED_FAR] = "far",     [LOGGED_LEFT] = "left",     [LOGGED_GOES_THROUGH] = "goes through",
    [LOGGED_CUT] = "cut",
};

static const char *const choice_reasons[] = {
    [LOGGED_MISSES] = "none: the line passes the sphere",
    [LOGGED_BEHIND] = "none: both points lie behind the ray's start",
    [LOGGED_NEAR] = "t1: the ray comes from outside, and the first point is the nearer one",
    [LOGGED_FAR] = "t2: the ray starts inside, so the first point lies behind it",
    [LOGGED_LEFT] = "none: the ray starts on this sphere and leaves it; a sphere is convex, so it is not asked again",
    [LOGGED_GOES_THROUGH] = "the one that is not 0: the ray starts on this sphere and goes in, so c = 0 and t = -b / a",
    [LOGGED_CUT] = "both: the sphere is cut with other shapes, and what they leave of it decides which point is seen",
};

static const char *case_of(double h)
{
    return h > 0.0 ? "h > 0" : h < 0.0 ? "h < 0" : "h = 0";
}

static void put(const Printer *p, const char *text)
{
    text_append(p->out, text);
}

static void put_digits(const Printer *p, double x, int digits)
{
    char text[40];

    if (digits > 0) {
        snprintf(text, sizeof text, "%.*e", digits - 1, x);
        x = strtod(text, NULL); // whose shortest form has no more digits
    }
    json_number(p->out, x);
}

static void put_number(const Printer *p, double x)
{
    put_digits(p, x, p->digits);
}

static void put_three(const Printer *p, const char *open, const char *close, double a, double b, double c)
{
    put(p, open);
    put_number(p, a);
    put(p, ", ");
    put_number(p, b);
    put(p, ", ");
    put_number(p, c);
    put(p, close);
}

// ---- text

static void tell(const Printer *p, const char *what, double x)
{
    put(p, what);
    put_number(p, x);
}

static void tell_vector(const Printer *p, const char *what, Vec3 a)
{
    put(p, what);
    put_three(p, "<", ">", a.x, a.y, a.z);
}

static void tell_place_of(const Printer *p, const char *what, Vec3 place)
{
    tell_vector(p, what, vec3_add(place, p->origin));
}

static void tell_colour(const Printer *p, const char *what, Rgb a)
{
    put(p, what);
    put_three(p, "rgb <", ">", a.red, a.green, a.blue);
}

static void tell_place(const Printer *p, uint64_t source)
{
    SourceLocation at;
    if (source && source_locate(p->diags->sources, scene_source_span(source), &at)) {
        text_printf(p->out, " (%s:%" PRIu64 ":%" PRIu64 ")", at.name, (uint64_t)at.line, (uint64_t)at.column);
    }
}

static void tell_sphere(const Printer *p, const LoggedSphere *s)
{
    put(p, s->is_stretched ? "  stretched sphere" : "  sphere");
    tell_place(p, s->source);
    if (s->is_stretched) {
        tell_vector(p, ": in the space where it has its centre at 0 and the radius 1\n    e = ", s->own_origin);
        tell_vector(p, ", d = ", s->own_direction);
    } else {
        tell_place_of(p, ": centre ", s->centre);
        tell(p, ", radius ", s->radius);
    }
    tell(p, "\n    a = d·d = ", s->a);
    tell(p, ", b = 2 d·(e - centre) = ", s->b);
    tell(p, ", c = (e - centre)·(e - centre) - radius² = ", s->c);
    tell(p, "\n    h = b² - 4 a c = ", s->h);
    text_printf(p->out, ": %s",
                s->h > 0.0   ? "h > 0, the line meets it in two points"
                : s->h < 0.0 ? "h < 0, the line does not meet it"
                             : "h = 0, the line touches it");
    if (s->h >= 0.0) {
        tell(p, "\n    t1 = (-b - √h) / 2a = ", s->t1);
        tell(p, ", t2 = (-b + √h) / 2a = ", s->t2);
    }
    text_printf(p->out, "\n    used: %s", choice_reasons[s->choice]);
    if (s->t > 0.0) {
        tell(p, "\n    t = ", s->t);
        tell(p, ", off by less than ", s->bound);
    }
    if (s->is_uncertain) {
        put(p, "\n    near enough to a tangent, or to the surface, that rounding could decide: computed in double "
               "words");
    }
    if (s->is_misjudged) {
        put(p, "\n    by the plain formulas above another root would be used");
    }
    put(p, "\n");
}

static void tell_layer(const Printer *p, const LoggedLayer *layer, Vec3 normal)
{
    int digits = p->digits > 0 && p->digits < 9 ? p->digits : 9; // single precision
    const double pigment[] = {layer->pigment.red, layer->pigment.green, layer->pigment.blue, layer->pigment.filter,
                             layer->pigment.transmit};
    put(p, "    pigment rgbft <");
    for (int i = 0; i < 5; i++) {
        put(p, i > 0 ? ", " : "");
        put_digits(p, pigment[i], digits);
    }
    put(p, ">");
    if (layer->part != 1.0) {
        tell(p, ", as a part of ", layer->part);
    }
    if (layer->above.red != 1.0 || layer->above.green != 1.0 || layer->above.blue != 1.0) {
        tell_colour(p, ", seen through layers that leave ", layer->above);
    }
    if (!vec3_equal(layer->normal, normal)) {
        tell_vector(p, "\n    its bumps turn the normal to N = ", layer->normal);
    }
    tell_colour(p, "\n    ambient and emission: ", layer->glow);
    put(p, "\n");
    for (size_t i = layer->first_light; i < layer->first_light + layer->light_count; i++) {
        const LoggedLight *light = &p->ray_log->lights.items[i];
        text_printf(p->out, "    light %zu", light->number + 1);
        tell_place_of(p, " at ", light->position);
        tell(p, ": distance ", light->distance);
        tell(p, ", N·L = ", light->cosine);
        tell_colour(p, ", sends ", light->sends);
        tell_colour(p, ", visible ", light->visible);
        tell_colour(p, "\n      diffuse ", light->diffuse);
        tell_colour(p, ", highlights ", light->highlights);
        tell_colour(p, ", adds ", light->adds);
        put(p, "\n");
    }
    if (!rgb_is_black(layer->dome)) {
        tell_colour(p, "    sky light adds ", layer->dome);
        put(p, "\n");
    }
}

static void tell_hit(const Printer *p, const LoggedRay *ray)
{
    text_printf(p->out, "  hit: %s", ray->shape);
    tell_place(p, ray->source);
    text_printf(p->out, " from the %s", ray->is_inside ? "inside" : "outside");
    tell(p, " at t = ", ray->t);
    tell(p, ", off by less than ", ray->bound);
    tell_place_of(p, "\n    point ", ray->point);
    tell_vector(p, ", normal N = ", ray->normal);
    put(p, "\n");
    for (size_t i = ray->first_layer; i < ray->first_layer + ray->layer_count; i++) {
        tell_layer(p, &p->ray_log->layers.items[i], ray->normal);
    }
    if (!rgb_is_black(ray->reflectance)) {
        tell_colour(p, "    mirrors ", ray->reflectance);
        put(p, "\n");
    }
    if (!rgb_is_black(ray->through)) {
        tell_colour(p, "    lets through ", ray->through);
        if (ray->ior_ratio != 1.0) {
            tell(p, ", bent by an index of refraction that becomes times ", ray->ior_ratio);
        }
        put(p, "\n");
    }
}

// How far beside the sphere the line passes, in its radii; h < 0.
static double gap_of(const LoggedSphere *sphere)
{
    return sqrt(1.0 - sphere->h / (4.0 * sphere->a * sphere->radius * sphere->radius)) - 1.0;
}

// The spheres that the line meets, of the others that which it passes nearest, and how many more there are.
static void tell_spheres(const Printer *p, const LoggedRay *ray)
{
    const LoggedSphere *spheres = ray->sphere_count > 0 ? p->ray_log->spheres.items + ray->first_sphere : NULL;
    size_t nearest = ray->sphere_count, missed = ray->missed;

    for (size_t i = 0; i < ray->sphere_count; i++) {
        bool is_missed = spheres[i].h < 0.0 && !(spheres[i].t > 0.0);
        missed += is_missed;
        if (is_missed && (nearest == ray->sphere_count || gap_of(&spheres[i]) < gap_of(&spheres[nearest]))) {
            nearest = i;
        }
    }
    for (size_t i = 0; i < ray->sphere_count; i++) {
        if (i == nearest || !(spheres[i].h < 0.0) || spheres[i].t > 0.0) {
            tell_sphere(p, &spheres[i]);
        }
    }
    missed -= nearest < ray->sphere_count;
    if (missed > 0) {
        text_printf(p->out, "  and %zu more sphere%s missed\n", missed, missed == 1 ? " is" : "s are");
    }
}

static void tell_ray(const Printer *p, size_t number)
{
    const LoggedRay *ray = &p->ray_log->rays.items[number];
    text_printf(p->out, "ray %zu: %s", number + 1, kind_words[ray->kind]);
    if (ray->parent != LOGGED_NONE) {
        text_printf(p->out, " where ray %d hits, level %d", ray->parent + 1, ray->level);
        tell_colour(p, ", its light counts times ", ray->share);
    }
    tell_place_of(p, "\n  e = ", ray->origin);
    if (ray->kind == LOGGED_CAMERA) {
        tell_place_of(p, ", through the screen at ", p->ray_log->screen);
    }
    tell_vector(p, "\n  d = ", ray->direction);
    put(p, ", of length 1\n");
    tell_spheres(p, ray);
    if (ray->is_hit) {
        tell_hit(p, ray);
        tell_colour(p, "  its light: ", ray->light);
    } else {
        tell_colour(p, "  meets nothing: the background, ", ray->light);
    }
    tell_colour(p, "; adds ", ray->adds);
    if (!rgb_is_black(ray->fog)) {
        tell_colour(p, "\n  fog on its way adds ", ray->fog);
    }
    put(p, "\n");
}

// One line for each ray, below the one that it comes from and further in.
static void tell_branch(const Printer *p, size_t number, int depth)
{
    const LoggedRay *ray = &p->ray_log->rays.items[number];
    Printer few = *p;

    few.digits = p->digits > 0 && p->digits < TREE_DIGITS ? p->digits : TREE_DIGITS;
    text_printf(p->out, "%*s%zu %s: ", 2 + 2 * depth, "", number + 1, kind_words[ray->kind]);
    if (ray->is_hit) {
        put(p, ray->shape);
        tell_place(p, ray->source);
        tell(&few, " at t = ", ray->t);
    } else {
        put(p, "the background");
    }
    tell_colour(&few, ", adds ", ray->adds);
    put(p, "\n");
    for (size_t i = number + 1; i < p->ray_log->rays.count; i++) {
        if (p->ray_log->rays.items[i].parent == (int)number) {
            tell_branch(p, i, depth + 1);
        }
    }
}

static void print_text(const Printer *p, int x, int y, Rgb linear)
{
    text_printf(p->out, "pixel %d, %d\n", x, y);
    if (p->ray_log->rays.count > 1) {
        text_printf(p->out, "the tree of its %zu rays:\n", p->ray_log->rays.count);
        tell_branch(p, 0, 0);
    }
    for (size_t i = 0; i < p->ray_log->rays.count; i++) {
        tell_ray(p, i);
    }
    if (p->ray_log->more_rays > 0) {
        text_printf(p->out, "%zu more rays are omitted\n", p->ray_log->more_rays);
    }
    tell_colour(p, "colour ", p->ray_log->colour);
    tell_colour(p, ", as linear light ", linear);
    put(p, "\n");
}

// ---- JSON

static void member(const Printer *p, const char *name)
{
    char last = p->out->length > 0 ? text_get(p->out)[p->out->length - 1] : '{';
    text_printf(p->out, "%s\"%s\": ", last == '{' ? "" : ", ", name);
}

static void put_member(const Printer *p, const char *name, double x)
{
    member(p, name);
    put_number(p, x);
}

static void json_vector(const Printer *p, const char *name, Vec3 a)
{
    member(p, name);
    put_three(p, "[", "]", a.x, a.y, a.z);
}

static void json_place_of(const Printer *p, const char *name, Vec3 place)
{
    json_vector(p, name, vec3_add(place, p->origin));
}

static void json_colour(const Printer *p, const char *name, Rgb a)
{
    member(p, name);
    put_three(p, "[", "]", a.red, a.green, a.blue);
}

static void json_word(const Printer *p, const char *name, const char *word)
{
    member(p, name);
    text_printf(p->out, "\"%s\"", word);
}

static void json_truth(const Printer *p, const char *name, bool truth)
{
    member(p, name);
    put(p, truth ? "true" : "false");
}

static void json_place(const Printer *p, uint64_t source)
{
    SourceLocation at;
    if (source && source_locate(p->diags->sources, scene_source_span(source), &at)) {
        member(p, "file");
        json_string(p->out, at.name, strlen(at.name));
        put_member(p, "line", (double)at.line);
        put_member(p, "column", (double)at.column);
    }
}

static void json_spheres(const Printer *p, const LoggedRay *ray)
{
    member(p, "spheres");
    put(p, "[");
    for (size_t i = 0; i < ray->sphere_count; i++) {
        const LoggedSphere *s = &p->ray_log->spheres.items[ray->first_sphere + i];
        put(p, i > 0 ? ", {" : "{");
        json_place(p, s->source);
        json_truth(p, "stretched", s->is_stretched);
        if (s->is_stretched) {
            json_vector(p, "own_e", s->own_origin);
            json_vector(p, "own_d", s->own_direction);
            json_vector(p, "centre", s->centre);
        } else {
            json_place_of(p, "centre", s->centre);
        }
        put_member(p, "radius", s->radius);
        put_member(p, "a", s->a);
        put_member(p, "b", s->b);
        put_member(p, "c", s->c);
        put_member(p, "h", s->h);
        json_word(p, "case", case_of(s->h));
        if (s->h >= 0.0) {
            put_member(p, "t1", s->t1);
            put_member(p, "t2", s->t2);
        }
        json_word(p, "used", choice_words[s->choice]);
        json_word(p, "why", choice_reasons[s->choice]);
        if (s->t > 0.0) {
            put_member(p, "t", s->t);
            put_member(p, "t_error", s->bound);
        }
        json_truth(p, "doubtful", s->is_uncertain);
        json_truth(p, "plain_formulas_differ", s->is_misjudged);
        put(p, "}");
    }
    put(p, "]");
    put_member(p, "spheres_omitted", (double)ray->missed);
}

static void json_lights(const Printer *p, const LoggedLayer *layer)
{
    member(p, "lights");
    put(p, "[");
    for (size_t i = 0; i < layer->light_count; i++) {
        const LoggedLight *light = &p->ray_log->lights.items[layer->first_light + i];
        put(p, i > 0 ? ", {" : "{");
        put_member(p, "light", (double)light->number + 1);
        json_place_of(p, "position", light->position);
        put_member(p, "distance", light->distance);
        put_member(p, "cosine", light->cosine);
        json_colour(p, "sends", light->sends);
        json_colour(p, "visible", light->visible);
        json_colour(p, "diffuse", light->diffuse);
        json_colour(p, "highlights", light->highlights);
        json_colour(p, "adds", light->adds);
        put(p, "}");
    }
    put(p, "]");
}

static void json_hit(const Printer *p, const LoggedRay *ray)
{
    member(p, "hit");
    put(p, "{");
    json_word(p, "shape", ray->shape);
    json_place(p, ray->source);
    put_member(p, "t", ray->t);
    put_member(p, "t_error", ray->bound);
    json_truth(p, "inside", ray->is_inside);
    json_place_of(p, "point", ray->point);
    json_vector(p, "normal", ray->normal);
    put_member(p, "ior_ratio", ray->ior_ratio);
    json_colour(p, "reflectance", ray->reflectance);
    json_colour(p, "through", ray->through);
    member(p, "layers");
    put(p, "[");
    for (size_t i = 0; i < ray->layer_count; i++) {
        const LoggedLayer *layer = &p->ray_log->layers.items[ray->first_layer + i];
        const Rgbft *pigment = &layer->pigment;
        put(p, i > 0 ? ", {" : "{");
        json_colour(p, "pigment", rgbft_rgb(*pigment));
        put_member(p, "filter", pigment->filter);
        put_member(p, "transmit", pigment->transmit);
        put_member(p, "part", layer->part);
        json_colour(p, "above", layer->above);
        json_vector(p, "normal", layer->normal);
        json_colour(p, "glow", layer->glow);
        json_lights(p, layer);
        if (!rgb_is_black(layer->dome)) {
            json_colour(p, "sky_light", layer->dome);
        }
        put(p, "}");
    }
    put(p, "]}");
}

static void json_ray(const Printer *p, size_t number)
{
    const LoggedRay *ray = &p->ray_log->rays.items[number];
    put(p, number > 0 ? ", {" : "{");
    put_member(p, "ray", (double)number + 1);
    json_word(p, "kind", kind_words[ray->kind]);
    if (ray->parent != LOGGED_NONE) {
        put_member(p, "from", ray->parent + 1);
    } else {
        json_place_of(p, "screen", p->ray_log->screen);
    }
    put_member(p, "level", ray->level);
    json_place_of(p, "e", ray->origin);
    json_vector(p, "d", ray->direction);
    json_colour(p, "share", ray->share);
    put_member(p, "weight", ray->weight);
    json_spheres(p, ray);
    if (ray->is_hit) {
        json_hit(p, ray);
    }
    json_colour(p, "light", ray->light);
    json_colour(p, "adds", ray->adds);
    json_colour(p, "fog", ray->fog);
    put(p, "}");
}

static void print_json(const Printer *p, int x, int y, Rgb linear)
{
    put(p, "{");
    json_word(p, "type", "pixel");
    put_member(p, "x", x);
    put_member(p, "y", y);
    member(p, "rays");
    put(p, "[");
    for (size_t i = 0; i < p->ray_log->rays.count; i++) {
        json_ray(p, i);
    }
    put(p, "]");
    put_member(p, "rays_omitted", (double)p->ray_log->more_rays);
    json_colour(p, "colour", p->ray_log->colour);
    json_colour(p, "linear", linear);
    put(p, "}\n");
}

// ---- the call

typedef struct Pixel {
    int x, y;
} Pixel;

static rt_status trace_pixel(rt_session *session, void *argument)
{
    int x = ((const Pixel *)argument)->x, y = ((const Pixel *)argument)->y;
    RayLog ray_log = {.more_rays = 0};
    GeometryOptions geometry = {.threads = render_default_threads(), .isa = session->isa};
    Vec3 origin = scene_recentre(&session->scene);
    Prepared *prepared = prepared_new(&session->scene, &geometry);
    if (prepared) {
        prepared_seed(prepared, session->sampling.seed);
    }
    bool is_traced = prepared && ray_log_trace(&ray_log, prepared, session->width, session->height, x, y);
    prepared_free(prepared);
    scene_move_back(&session->scene, origin);
    if (is_traced) {
        Printer printer = {&session->dump, &session->diags, &ray_log, origin, session->trace_digits};
        // As the film has it: in single precision first.
        float values[] = {(float)ray_log.colour.red, (float)ray_log.colour.green, (float)ray_log.colour.blue};
        Film pixel = {.width = 1, .height = 1, .rgb = values};
        session_film_to_linear(&session->scene.settings, &pixel);
        Rgb linear = rgb(pixel.rgb[0], pixel.rgb[1], pixel.rgb[2]);
        if (session->trace_form == RT_TRACE_SVG) {
            ray_log_draw(&ray_log, x, y, &session->dump);
        } else {
            (session->is_json ? print_json : print_text)(&printer, x, y, linear);
        }
    }
    ray_log_fini(&ray_log);
    if (!is_traced || session->dump.failed) {
        diag_report(&session->diags, DIAG_E0602, SPAN_NONE, "out of memory following a ray");
    }
    return session_status(session, is_traced && !session->dump.failed);
}

rt_status rt_set_trace_form(rt_session *session, rt_trace_form form, int digits)
{
    if ((form != RT_TRACE_LOG && form != RT_TRACE_SVG) || digits < 0 || digits > 17) {
        return RT_FAULT_USAGE;
    }
    session->trace_form = form;
    session->trace_digits = digits;
    return RT_OK;
}

rt_status rt_trace_pixel(rt_session *session, int x, int y, const char **text)
{
    text_clear(&session->dump);
    *text = text_get(&session->dump);
    if (!session->loaded || x < 0 || y < 0 || x >= session->width || y >= session->height ||
        !session_is_whole(session)) {
        return RT_FAULT_USAGE;
    }
    if (!session_memory_suffices(session)) {
        return session_status(session, false);
    }
    rt_status status = session_run_deep(session, trace_pixel, &(Pixel){x, y});
    *text = text_get(&session->dump);
    return status;
}
