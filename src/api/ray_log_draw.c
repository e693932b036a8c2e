// Lays the log's points into the plane of its first ray and prints them as SVG.
//
// SPDX-License-Identifier: MIT
#include "api/ray_log_draw.h"

#include <math.h>

enum { WIDTH = 640, LEAST_HEIGHT = 200, GREATEST_HEIGHT = 640, BODIES_MOST = 60, MARGIN = 36 };

static const double FAR = 3.0; // spheres are drawn up to so many times as far as the rays reach

typedef struct Drawing {
    TextBuffer *out;
    const RayLog *log;
    Vec3 origin, across, up, towards; // of the plane; the first ray goes across, to the right
    double left, right, bottom, top;  // what is shown, in the scene's lengths
    double scale;                     // from those to the drawing's
    double height;
} Drawing;

typedef struct Place {
    double x, y;
} Place;

static const char style[] =
    "<style>.rays{color-scheme:light dark;--ink:#1d1c1a;--faint:#6b6760;--body:#3b6ea8;--ray:#b3261e;--on:#8a5a00;"
    "--mirror:#1a7340;--light:#946200}@media(prefers-color-scheme:dark){.rays{--ink:#e8e6e2;--faint:#a09c95;"
    "--body:#7aa7dd;--ray:#ff8a80;--on:#e0a860;--mirror:#6fcf97;--light:#f0c850}}"
    ".rays text{font:13px system-ui,sans-serif;fill:var(--ink)}.rays line,.rays circle{fill:none;stroke-width:1.5}"
    ".rays .body{stroke:var(--body)}.rays .aside{stroke:var(--body);stroke-dasharray:2 4}"
    ".rays .surface{stroke:var(--body);stroke-width:3}.rays .normal{stroke:var(--faint)}"
    ".rays .camera{stroke:var(--ray);stroke-width:2}.rays .mirrored{stroke:var(--mirror);stroke-width:2}"
    ".rays .through{stroke:var(--on);stroke-width:2}.rays .light{stroke:var(--light);stroke-dasharray:6 4}"
    ".rays .shadow{stroke:var(--faint);stroke-dasharray:2 3}.rays .point{fill:var(--ink);stroke:none}</style>";

static void number(const Drawing *d, const char *name, double value)
{
    text_append(d->out, name);
    text_append_double(d->out, round(10.0 * value) / 10.0 + 0.0);
    text_append(d->out, "\"");
}

static Place lay(const Drawing *d, Vec3 point)
{
    Vec3 from = vec3_sub(point, d->origin);
    return (Place){vec3_dot(from, d->across), vec3_dot(from, d->up)};
}

static double to_x(const Drawing *d, double x)
{
    return (x - d->left) * d->scale;
}

static double to_y(const Drawing *d, double y)
{
    return (d->top - y) * d->scale;
}

static void line(const Drawing *d, const char *kind, Place a, Place b)
{
    text_printf(d->out, "<line class=\"%s\"", kind);
    number(d, " x1=\"", to_x(d, a.x));
    number(d, " y1=\"", to_y(d, a.y));
    number(d, " x2=\"", to_x(d, b.x));
    number(d, " y2=\"", to_y(d, b.y));
    text_append(d->out, "/>\n");
}

static void label(const Drawing *d, Place at, double right, double down, const char *text)
{
    text_append(d->out, "<text");
    number(d, " x=\"", to_x(d, at.x) + right);
    number(d, " y=\"", to_y(d, at.y) + down);
    text_printf(d->out, ">%s</text>\n", text);
}

static void circle(const Drawing *d, const char *kind, Place at, double radius)
{
    text_printf(d->out, "<circle class=\"%s\"", kind);
    number(d, " cx=\"", to_x(d, at.x));
    number(d, " cy=\"", to_y(d, at.y));
    number(d, " r=\"", radius);
    text_append(d->out, "/>\n");
}

// ---- the plane and what is shown of it

// What of a vector lies across a direction, of length 1; 0 where nothing does. Twice, because rounding leaves the first
// of vectors that are nearly parallel.
static Vec3 across_only(Vec3 a, Vec3 direction)
{
    for (int i = 0; i < 2 && vec3_max_abs(a) > 0.0; i++) {
        a = vec3_normalize(a);
        a = vec3_sub(a, vec3_scale(vec3_dot(a, direction), direction));
    }
    return vec3_max_abs(a) > 0.0 ? vec3_normalize(a) : a;
}

static void plane_find(Drawing *d)
{
    const LoggedRay *first = &d->log->rays.items[0];
    Vec3 direction = first->direction, up = {0.0, 0.0, 0.0};
    const Vec3 others[] = {{0.0, 1.0, 0.0}, {1.0, 0.0, 0.0}};

    d->origin = first->origin;
    d->across = direction;
    if (first->is_hit) {
        up = across_only(first->normal, direction);
    }
    for (size_t i = 0; i < first->sphere_count && !(vec3_max_abs(up) > 0.0); i++) {
        const LoggedSphere *sphere = &d->log->spheres.items[first->first_sphere + i];
        up = across_only(vec3_sub(sphere->centre, first->origin), direction);
    }
    for (int i = 0; i < 2 && !(vec3_max_abs(up) > 0.0); i++) {
        up = across_only(others[i], direction);
    }
    d->up = up.y < 0.0 ? vec3_neg(up) : up; // mostly what is above in the picture
    d->towards = vec3_cross(d->across, d->up);
}

static void include(Drawing *d, Place at, double radius)
{
    d->left = fmin(d->left, at.x - radius);
    d->right = fmax(d->right, at.x + radius);
    d->bottom = fmin(d->bottom, at.y - radius);
    d->top = fmax(d->top, at.y + radius);
}

// Whether a sphere lies ahead and the line passes its centre within two radii: h = 4 a (radius² - distance²).
static bool is_passed(const LoggedSphere *sphere)
{
    return sphere->h < 0.0 && sphere->b < 0.0 && -sphere->h < 12.0 * sphere->a * sphere->radius * sphere->radius;
}

// How far a ray that meets nothing is followed: to the nearest sphere that it passes.
static double passed_reach(const Drawing *d)
{
    const LoggedRay *first = &d->log->rays.items[0];
    double reach = INFINITY;

    for (size_t i = 0; i < first->sphere_count; i++) {
        const LoggedSphere *sphere = &d->log->spheres.items[first->first_sphere + i];
        if (!sphere->is_stretched && is_passed(sphere)) {
            reach = fmin(reach, lay(d, sphere->centre).x);
        }
    }
    return reach < INFINITY ? reach : 1.0;
}

// Whether a sphere is worth drawing beside rays that reach so far.
static bool is_drawn(const LoggedSphere *sphere, double reach)
{
    return !sphere->is_stretched && sphere->radius < FAR * reach &&
           (sphere->h >= 0.0 || sphere->t > 0.0 || is_passed(sphere));
}

static void shown_find(Drawing *d)
{
    const RayLog *log = d->log;

    d->left = d->right = d->bottom = d->top = 0.0;
    for (size_t i = 0; i < log->rays.count; i++) {
        include(d, lay(d, log->rays.items[i].origin), 0.0);
        if (log->rays.items[i].is_hit) {
            include(d, lay(d, log->rays.items[i].point), 0.0);
        }
    }
    double reach = fmax(d->right - d->left, d->top - d->bottom);
    reach = reach > 0.0 ? reach : passed_reach(d);
    for (size_t i = 0; i < log->rays.items[0].sphere_count; i++) {
        const LoggedSphere *sphere = &log->spheres.items[log->rays.items[0].first_sphere + i];
        Place at = lay(d, sphere->centre);
        if (is_drawn(sphere, reach) && fabs(at.x) < FAR * reach && at.x + sphere->radius > 0.0) {
            include(d, at, sphere->radius);
        }
    }
    reach = fmax(d->right - d->left, d->top - d->bottom);
    reach = reach > 0.0 ? reach : 1.0;
    include(d, (Place){d->right + 0.1 * reach, 0.0}, 0.0);
    d->scale = (WIDTH - 2 * MARGIN) / (d->right - d->left);
    double lacking = LEAST_HEIGHT / d->scale - (d->top - d->bottom);
    if (lacking > 0.0) {
        d->top += 0.5 * lacking;
        d->bottom -= 0.5 * lacking;
    }
    d->scale = fmin((WIDTH - 2 * MARGIN) / (d->right - d->left), (GREATEST_HEIGHT - 2 * MARGIN) / (d->top - d->bottom));
    d->left -= MARGIN / d->scale;
    d->top += MARGIN / d->scale;
    d->height = (d->top - d->bottom) * d->scale + MARGIN;
}

// ---- what is drawn

static bool is_told_before(const RayLog *log, size_t number)
{
    const LoggedSphere *sphere = &log->spheres.items[number];
    for (size_t i = 0; i < number; i++) {
        if (vec3_equal(log->spheres.items[i].centre, sphere->centre) &&
            log->spheres.items[i].radius == sphere->radius && log->spheres.items[i].h >= 0.0) {
            return true;
        }
    }
    return false;
}

static void draw_bodies(const Drawing *d)
{
    double reach = fmax(d->right - d->left, d->top - d->bottom);
    int count = 0;

    for (size_t i = 0; i < d->log->spheres.count && count < BODIES_MOST; i++) {
        const LoggedSphere *sphere = &d->log->spheres.items[i];
        if (!is_drawn(sphere, reach) || is_told_before(d->log, i)) {
            continue;
        }
        double off = vec3_dot(vec3_sub(sphere->centre, d->origin), d->towards);
        double cut = sphere->radius * sphere->radius - off * off;
        circle(d, cut > 0.0 ? "body" : "aside", lay(d, sphere->centre),
               (cut > 0.0 ? sqrt(cut) : sphere->radius) * d->scale);
        count++;
    }
}

static const char *ray_class(LoggedKind kind)
{
    return kind == LOGGED_CAMERA ? "camera" : kind == LOGGED_MIRRORED || kind == LOGGED_TOTAL ? "mirrored" : "through";
}

static void draw_lights(const Drawing *d, const LoggedRay *ray)
{
    Place at = lay(d, ray->point);

    if (ray->layer_count > 0) {
        const LoggedLayer *layer = &d->log->layers.items[ray->first_layer];
        for (size_t i = 0; i < layer->light_count; i++) {
            const LoggedLight *light = &d->log->lights.items[layer->first_light + i];
            bool is_seen = light->cosine > 0.0 && !rgb_is_black(light->visible) && !rgb_is_black(light->sends);
            line(d, is_seen ? "light" : "shadow", at, lay(d, light->position));
        }
    }
}

// The normal, and the surface where it is no sphere's circle.
static void draw_hit(const Drawing *d, const LoggedRay *ray)
{
    double size = 34.0 / d->scale;
    Place at = lay(d, ray->point), tip = lay(d, vec3_add_scaled(ray->point, size, ray->normal));
    double x = tip.x - at.x, y = tip.y - at.y;

    line(d, "normal", at, tip);
    line(d, "surface", (Place){at.x - 0.5 * y, at.y + 0.5 * x}, (Place){at.x + 0.5 * y, at.y - 0.5 * x});
    circle(d, "point", at, 3.0);
}

static void draw_ray(const Drawing *d, size_t i)
{
    const LoggedRay *ray = &d->log->rays.items[i];
    double far = 4.0 * (d->right - d->left);
    Vec3 end = ray->is_hit ? ray->point : vec3_add_scaled(ray->origin, far, ray->direction);

    line(d, ray_class(ray->kind), lay(d, ray->origin), lay(d, end));
    if (ray->is_hit) {
        draw_lights(d, ray);
        draw_hit(d, ray);
    }
}

// e, and both roots of the sphere that the first ray sees, or of the first that its line meets.
static void draw_labels(const Drawing *d)
{
    const LoggedRay *first = &d->log->rays.items[0];
    const LoggedSphere *shown = NULL;

    for (size_t i = 0; i < first->sphere_count; i++) {
        const LoggedSphere *sphere = &d->log->spheres.items[first->first_sphere + i];
        bool is_seen = first->is_hit && sphere->source == first->source && sphere->h >= 0.0;
        shown = is_seen || (!shown && sphere->h >= 0.0) ? sphere : shown;
    }
    circle(d, "point", (Place){0.0, 0.0}, 3.0);
    label(d, (Place){0.0, 0.0}, -4.0, 20.0, "e");
    for (int root = 0; shown && root < 2; root++) {
        Place at = {root == 0 ? shown->t1 : shown->t2, 0.0};
        bool is_near = (shown->t2 - shown->t1) * d->scale < 24.0; // the labels would lie on each other
        circle(d, "point", at, 3.0);
        if (!is_near) {
            label(d, at, 6.0, 18.0, root == 0 ? "t1" : "t2");
        } else if (root == 0) {
            label(d, at, 6.0, 18.0, shown->t1 < shown->t2 ? "t1, t2" : "t1 = t2");
        }
    }
    if (first->is_hit) {
        label(d, lay(d, vec3_add_scaled(first->point, 34.0 / d->scale, first->normal)), 4.0, -4.0, "N");
    }
}

void ray_log_draw(const RayLog *log, int x, int y, TextBuffer *out)
{
    Drawing d = {.out = out, .log = log};

    if (log->rays.count == 0) {
        text_append(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\"/>\n");
        return;
    }
    plane_find(&d);
    shown_find(&d);
    text_printf(out, "<svg class=\"rays\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\">\n", WIDTH,
                (int)ceil(d.height));
    text_printf(out, "<title>The ray of pixel %d, %d in its plane</title>\n%s\n", x, y, style);
    text_append(out, "<desc>e is where it starts, t1 and t2 are the roots, N is the normal. Red: the camera's ray; green: "
                     "mirrored; brown: what goes through; dashed: to lights, grey where nothing of them arrives.</desc>\n");
    draw_bodies(&d);
    for (size_t i = log->rays.count; i > 0; i--) { // the camera's above the others
        draw_ray(&d, i - 1);
    }
    draw_labels(&d);
    text_append(out, "</svg>\n");
}
