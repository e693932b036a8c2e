// Follows one camera ray with the kernels' own steps and keeps what each found.
//
// SPDX-License-Identifier: MIT
#include "render/inspect/ray_log.h"

#include <float.h>

#include "render/records/camera.h"
#include "render/sample/scratch.h"
#include "render/shade/surface_uv.h"
#include "scene/primitive_reach.h"

enum {
    RAYS_MOST = 1000,   // that are listed
    SPHERES_FEW = 16,   // a scene with no more than these tells of each, also of those that are missed
    SPHERES_MOST = 100, // that are listed for a ray
    FEATURES = SHADE_ALL_FEATURES,
};

static const double U = DBL_EPSILON / 2;

typedef struct Follower {
    RayLog *ray_log;
    const Prepared *p;
    double scale; // from prepared lengths to the scene's
    bool failed;
    const ShadingPoint *at; // while layers are collected
    uint32_t layer;         // of them
} Follower;

static Vec3 in_scene(const Follower *follower, Vec3 a)
{
    return vec3_scale(follower->scale, a);
}

static double spacing(double t)
{
    return nextafter(fabs(t), (double)INFINITY) - fabs(t);
}

// ---- spheres

static uint64_t sphere_source(const Scene *scene, uint32_t order)
{
    uint32_t sphere = scene_sphere_at(scene, order);
    return sphere != RECORD_NONE ? scene_sphere_source(scene, sphere) : 0;
}

// The quadratic and its roots as a textbook has them. `unit`: what a distance in the ball's space is in the scene's
// lengths.
static void textbook(LoggedSphere *out, Ray ray, const SphereData *ball, double scale, double unit)
{
    Vec3 f = vec3_sub(ray.origin, ball->centre);
    double a = vec3_dot(ray.direction, ray.direction);
    double b = 2.0 * vec3_dot(ray.direction, f);
    double c = vec3_dot(f, f) - ball->radius_squared;
    double h = b * b - 4.0 * a * c;
    double rate = unit / scale; // of lengths by t
    out->a = a * rate * rate;
    out->b = b * rate * unit;
    out->c = c * unit * unit;
    out->h = h * rate * unit * rate * unit;
    if (h >= 0.0) {
        out->t1 = (-b - sqrt(h)) / (2.0 * a) * scale;
        out->t2 = (-b + sqrt(h)) / (2.0 * a) * scale;
    }
}

static LoggedRoot textbook_choice(const LoggedSphere *sphere)
{
    return !(sphere->h >= 0.0) ? LOGGED_MISSES
           : sphere->t1 > 0.0  ? LOGGED_NEAR
           : sphere->t2 > 0.0  ? LOGGED_FAR
                               : LOGGED_BEHIND;
}

// By the rules of query_spheres_closest.
static void certify(LoggedSphere *out, Ray ray, const SphereData *ball, const StartSphere *on, double scale)
{
    SphereRay sphere_ray = sphere_ray_make(ray.origin, ray.direction);
    double approximate;
    bool inside = false;
    if (sphere_data_equal(ball, &on->ball)) {
        out->choice = on->inward ? LOGGED_GOES_THROUGH : LOGGED_LEFT;
        double t = on->inward ? sphere_root_inward(&sphere_ray, ball) : 0.0;
        Vec3 f = vec3_sub(ray.origin, ball->centre);
        double cosine = fabs(vec3_dot(f, ray.direction)) / (vec3_length(f) * vec3_length(ray.direction));
        out->t = t * scale;
        out->bound = (3.0 / cosine + 3.0) * U * fabs(t) * scale;
        return;
    }
    out->is_uncertain = sphere_test(&sphere_ray, ball, &approximate, &inside) == SPHERE_UNCERTAIN;
    double t = sphere_hit(&sphere_ray, ball, &inside);
    bool is_behind = !(t > 0.0) && out->h >= 0.0 && out->t2 <= 0.0;
    out->choice = t > 0.0 ? (inside ? LOGGED_FAR : LOGGED_NEAR) : is_behind ? LOGGED_BEHIND : LOGGED_MISSES;
    LoggedRoot plain = textbook_choice(out);
    out->is_misjudged = (t > 0.0 || plain == LOGGED_NEAR || plain == LOGGED_FAR) && plain != out->choice;
    out->t = t * scale;
    out->bound = t > 0.0 ? spacing(t) * scale : 0.0;
}

// Keeps one that the line meets, or any of a few.
static void keep_sphere(Follower *follower, LoggedRay *ray, const LoggedSphere *sphere, bool is_of_few)
{
    bool is_told = is_of_few || sphere->h >= 0.0 || sphere->t > 0.0;
    if (!is_told || follower->ray_log->spheres.count - ray->first_sphere >= SPHERES_MOST) {
        ray->missed++;
    } else {
        follower->failed |= !ARRAY_PUSH(&follower->ray_log->spheres, *sphere);
    }
}

// A ball under a map, in its own space.
static LoggedSphere stretched(const Follower *follower, Ray object, const StartSphere *on, uint64_t source)
{
    LoggedSphere sphere = {.source = source,
                           .is_stretched = true,
                           .own_origin = object.origin,
                           .own_direction = vec3_scale(1.0 / follower->scale, object.direction),
                           .radius = 1.0};
    SphereData ball = UNIT_SPHERE;
    textbook(&sphere, object, &ball, follower->scale, 1.0);
    certify(&sphere, object, &ball, on, follower->scale);
    return sphere;
}

// Balls among the parts. Of one that is cut, what its roots lead to is decided with the rest of the composite.
static void follow_primitive(Follower *follower, LoggedRay *ray, const StackedRay *now, uint32_t index, bool is_of_few)
{
    const PreparedPrimitive *primitive = &follower->p->geometry->shapes.primitives[index];
    uint64_t source = follower->p->scene->primitives.items[index].source;
    bool is_cut = primitive->node != NODE_NONE, is_round = primitive_map_is_round(primitive->to_world.m);
    bool is_start = !is_cut && starts_on_primitive(now->start) &&
                    table_primitive_index(&follower->p->geometry->shapes, now->start.shape) == index;
    double radius = fabs(primitive->to_world.m[0][0]);
    SphereData ball = is_round ? (SphereData){primitive->centre, radius * radius} : UNIT_SPHERE;
    StartSphere on = {0, now->start.inward != primitive->flips,
                      is_start ? ball : (SphereData){{0.0, 0.0, 0.0}, (double)NAN}};
    Ray object = primitive_ray(primitive, &now->ray);
    LoggedSphere sphere;
    if (is_round) {
        sphere = (LoggedSphere){
            .source = source, .centre = in_scene(follower, primitive->centre), .radius = radius * follower->scale};
        textbook(&sphere, now->ray, &ball, follower->scale, follower->scale);
        certify(&sphere, now->ray, &ball, &on, follower->scale);
    } else {
        sphere = stretched(follower, object, &on, source);
    }
    if (is_cut) {
        sphere.choice = sphere.t > 0.0 ? LOGGED_CUT : sphere.choice;
        sphere.is_misjudged = false;
        sphere.t = sphere.bound = 0.0;
    } else if (sphere.t > 0.0) {
        sphere.bound =
            primitive_ball_error(primitive, &now->ray, &object, sphere.t / follower->scale) * follower->scale;
    }
    keep_sphere(follower, ray, &sphere, is_of_few);
}

// Spheres that the line meets, or all of a few.
static void follow_spheres(Follower *follower, LoggedRay *ray, const StackedRay *now)
{
    const Geometry *g = follower->p->geometry;
    const SphereTable *table = &g->spheres;
    StartSphere on = query_start_sphere(g, TRACE_ALL_FEATURES, now->start);
    bool is_of_few = table->count + g->shapes.primitive_count <= SPHERES_FEW;
    ray->first_sphere = follower->ray_log->spheres.count;
    for (uint32_t slot = 0; slot < table->block_count * SPHERE_BLOCK; slot++) {
        SphereData ball = sphere_table_ball(table, slot);
        if (isnan(ball.radius_squared)) {
            continue;
        }
        LoggedSphere sphere = {.centre = in_scene(follower, ball.centre),
                               .radius = sqrt(ball.radius_squared) * follower->scale};
        textbook(&sphere, now->ray, &ball, follower->scale, follower->scale);
        certify(&sphere, now->ray, &ball, &on, follower->scale);
        if (is_of_few || sphere.h >= 0.0 || sphere.t > 0.0) {
            sphere.source = sphere_source(follower->p->scene, table->info[slot].order);
        }
        keep_sphere(follower, ray, &sphere, is_of_few);
    }
    for (uint32_t i = 0; i < g->shapes.primitive_count; i++) {
        if (g->shapes.primitives[i].kind == PRIMITIVE_SPHERE && !(g->shapes.primitives[i].hidden & now->start.use)) {
            follow_primitive(follower, ray, now, i, is_of_few);
        }
    }
    ray->sphere_count = follower->ray_log->spheres.count - ray->first_sphere;
}

// ---- the hit

#define SOURCE_BY_ORDER(list, wanted, out)                                                                             \
    for (size_t i = 0; i < (list).count; i++) {                                                                        \
        if ((list).items[i].order == (wanted)) {                                                                       \
            (out) = (list).items[i].source;                                                                            \
        }                                                                                                              \
    }

// 4 u for n·e and the difference, 3 u for n·d, 1 u for the quotient.
static double plane_error(const PlaneShape *plane, const Ray *ray, double t)
{
    Vec3 n = plane->normal, e = ray->origin, d = ray->direction;
    double above = fabs(plane->distance) + fabs(n.x * e.x) + fabs(n.y * e.y) + fabs(n.z * e.z);
    double below = fabs(n.x * d.x) + fabs(n.y * d.y) + fabs(n.z * d.z);
    return U * ((4.0 * above + 3.0 * t * below) / fabs(vec3_dot(n, d)) + t);
}

static void name_shape(const Follower *follower, const ShadingPoint *at, const Ray *ray, LoggedRay *out)
{
    const Geometry *g = follower->p->geometry;
    const Scene *scene = follower->p->scene;
    uint32_t index = shape_index(at->shape);
    double t = out->t / follower->scale, error = spacing(t);
    switch (shape_kind(at->shape)) {
    case SHAPE_SPHERE:
        out->shape = "sphere";
        out->source = sphere_source(scene, at->order);
        break;
    case SHAPE_PLANE:
        out->shape = "plane";
        SOURCE_BY_ORDER(scene->planes, at->order, out->source);
        error = plane_error(&g->planes[index].shape, ray, t);
        break;
    case SHAPE_FACE:
    case SHAPE_PRIMITIVE: {
        const PreparedPrimitive *prepared = table_primitive(&g->shapes, at->shape);
        Ray object = primitive_ray(prepared, ray);
        const Primitive *primitive = &scene->primitives.items[table_primitive_index(&g->shapes, at->shape)];
        out->shape = primitive_name(primitive);
        out->source = primitive->source;
        error = primitive_is_mesh(prepared) ? shapes_error(&g->shapes, ray, &object, t, at->shape)
                : prepared->kind == PRIMITIVE_SPHERE
                    ? primitive_ball_error(prepared, ray, &object, t)
                    : primitive_crossing_error(prepared, ray, &object, t, primitive_side(at->shape));
        break;
    }
    }
    out->bound = error * follower->scale;
}

// ---- what is seen there

// The same surface with only some of its terms.
static Rgb light_of(const Follower *follower, const ShadeMaterial *material, const PreparedLight *light,
                    bool is_diffuse)
{
    PreparedFinish finish = *material->finish;
    ShadeMaterial part = *material;
    RenderStatistics unused = {0};
    part.finish = &finish;
    finish.shines = !is_diffuse && finish.shines;
    finish.diffuse = is_diffuse ? finish.diffuse : 0.0;
    finish.diffuse_back = is_diffuse ? finish.diffuse_back : 0.0;
    return shade_light(follower->p, FEATURES, &part, light, follower->at, &unused);
}

static void follow_light(Follower *follower, const ShadeMaterial *material, const PreparedLight *light)
{
    const ShadingPoint *at = follower->at;
    RenderStatistics unused = {0};
    LightAim aim = light_aim(light, at->point, at->normal);
    LoggedLight out = {
        .number = light->number,
        .position = in_scene(follower, light->position),
        .distance = aim.distance * follower->scale,
        .cosine = aim.cosine,
        .sends = light->is_plain ? light->colour
                                 : rgb_scale(light_strength(light, aim.offset, aim.distance), light->colour),
        .visible = rgb_grey(1.0),
        .diffuse = light_of(follower, material, light, true),
        .highlights = light_of(follower, material, light, false),
        .adds = shade_light(follower->p, FEATURES, material, light, at, &unused),
    };
    if (!light->shadowless && aim.distance > 0.0) {
        uint32_t blocker = NO_BLOCKER;
        const ShadeWay way = shade_way(light, &aim);
        out.visible = light->area.size1 > 0 ? shade_area(follower->p, FEATURES, at, light, out.sends, &unused)
                                            : shade_visibility(follower->p, FEATURES, at, &way, &blocker, &unused);
    }
    follower->failed |= !ARRAY_PUSH(&follower->ray_log->lights, out);
}

static Rgb follow_layer(void *client, const TextureLayer *layer)
{
    Follower *follower = client;
    const Prepared *p = follower->p;
    const ShadingPoint *whole = follower->at;
    ShadingPoint at = *whole; // its normal may be another layer's
    at.normal = at.inside ? vec3_neg(at.outward) : at.outward;
    if (layer->normal != RECORD_NONE) {
        at.normal = texture_normal(layer, at.normal);
    }
    follower->at = &at;
    ShadeMaterial material = shade_material(p, FEATURES, layer->pigment, layer->finish);
    material.layer = follower->layer++;
    LoggedLayer out = {
        .pigment = layer->pigment,
        .part = layer->part,
        .above = layer->above,
        .normal = at.normal,
        .glow = rgb_mul(material.opaque, material.finish->glow),
        .first_light = follower->ray_log->lights.count,
    };
    for (size_t i = 0; i < p->light_count; i++) {
        if (shade_reaches(p, FEATURES, follower->at, &p->lights[i])) {
            follow_light(follower, &material, &p->lights[i]);
        }
    }
    if (p->has_dome && shade_takes_light(material.finish, material.opaque)) {
        RenderStatistics unused = {0};
        out.dome = dome_light(p, &material, &at, &unused);
    }
    follower->at = whole;
    out.light_count = follower->ray_log->lights.count - out.first_light;
    follower->failed |= !ARRAY_PUSH(&follower->ray_log->layers, out);
    return shade_left_below(p, FEATURES, &material, follower->at);
}

static void follow_surface(Follower *follower, const ShadingPoint *at)
{
    const Prepared *p = follower->p;
    follower->at = at;
    follower->layer = 0;
    if (at->material & MATERIAL_COMPOUND) {
        uint32_t texture = p->compounds[at->material & ~MATERIAL_COMPOUND].texture;
        Vec3 room;
        TextureSight sight = shade_sight(p, texture, at, &room);
        texture_walk(&p->textures, texture, sight, p->adc_bailout, follow_layer, follower);
    } else {
        const Material *plain = &p->materials[at->material];
        TextureLayer layer = {material_pigment(plain), plain->finish, RECORD_NONE, true, NULL, 1.0, rgb_grey(1.0), NULL};
        (void)follow_layer(follower, &layer);
    }
}

// ---- the way

// What a ray is that a step put on the list.
static LoggedKind child_kind(const ShadeStep *step, const StackedRay *child)
{
    Vec3 bent;
    bool has_bend = step->at.ior_ratio != 1.0;
    if (child->start.inward != step->at.inside) {
        return has_bend ? LOGGED_BENT : LOGGED_THROUGH;
    }
    bool is_total = has_bend && !inside_bend(step->at.direction, step->at.normal, step->at.ior_ratio, &bent);
    return is_total ? LOGGED_TOTAL : LOGGED_MIRRORED;
}

static void follow_hit(Follower *follower, const ShadeStep *step, LoggedRay *ray)
{
    const ShadingPoint *at = &step->at;
    const StackedRay *now = &step->ray;
    Hit hit = {.t = 0.0};
    ray->is_hit =
        geometry_closest(follower->p->geometry, TRACE_ALL_FEATURES, now->ray, now->start, (double)INFINITY, &hit);
    ray->t = hit.t * follower->scale;
    ray->is_inside = at->inside;
    ray->point = in_scene(follower, at->point);
    ray->normal = at->normal;
    ray->ior_ratio = at->ior_ratio;
    ray->through = shade_sent_through(&step->scatter);
    ray->reflectance = step->scatter.reflectance;
    name_shape(follower, at, &now->ray, ray);
    follow_surface(follower, at);
}

static void follow_step(Follower *follower, const ShadeStep *step, int parent, LoggedKind kind)
{
    RayLog *ray_log = follower->ray_log;
    const StackedRay *now = &step->ray;
    if (ray_log->rays.count >= RAYS_MOST) {
        ray_log->more_rays++;
        return;
    }
    LoggedRay ray = {
        .parent = parent,
        .kind = kind,
        .level = now->level,
        .origin = in_scene(follower, now->ray.origin),
        .direction = now->ray.direction,
        .share = now->share,
        .weight = now->weight,
        .first_layer = ray_log->layers.count,
        .light = step->light,
        .adds = rgb_mul(now->share, step->light),
        .fog = step->fog,
    };
    follow_spheres(follower, &ray, now);
    if (step->is_hit) {
        follow_hit(follower, step, &ray);
    }
    ray.layer_count = ray_log->layers.count - ray.first_layer;
    follower->failed |= !ARRAY_PUSH(&ray_log->rays, ray);
}

bool ray_log_trace(RayLog *ray_log, const Prepared *prepared, int width, int height, int x, int y)
{
    *ray_log = (RayLog){.more_rays = 0};
    Follower follower = {.ray_log = ray_log, .p = prepared, .scale = prepared->textures.scale};
    double u = (x + 0.5) / width - 0.5, v = (y + 0.5) / height - 0.5;
    StackedRay first = {.start = RAY_START_CAMERA, .share = rgb_grey(1.0), .weight = 1.0, .level = 1};
    if (!camera_ray(&prepared->camera, u, v, &first.ray)) {
        return true;
    }
    const Camera *camera = &prepared->scene->camera;
    ray_log->eye = in_scene(&follower, first.ray.origin);
    Vec3 across = vec3_sub(vec3_scale(u, camera->right), vec3_scale(v, camera->up));
    CameraType type = prepared->camera.type;
    Vec3 ahead = type == CAMERA_PERSPECTIVE    ? vec3_add(camera->direction, across)
                 : type == CAMERA_ORTHOGRAPHIC ? camera->direction
                                               : first.ray.direction;
    ray_log->screen = vec3_add(ray_log->eye, ahead);
    RenderScratch *scratch = scratch_new();
    if (!scratch) {
        return false;
    }
    RayStack *stack = &scratch->rays;
    RenderStatistics unused = {0};
    int parents[RAY_STACK_MAX] = {LOGGED_NONE};
    LoggedKind kinds[RAY_STACK_MAX] = {LOGGED_CAMERA};
    shade_path_begin(prepared, FEATURES, &first, stack);
    while (stack->count > 0 && !follower.failed) {
        ShadeStep step;
        int place = stack->count - 1;
        int parent = parents[place];
        LoggedKind kind = kinds[place];
        shade_step_all(prepared, stack, NULL, &unused, &step);
        if (step.ray.closes) {
            continue;
        }
        int number = (int)ray_log->rays.count;
        follow_step(&follower, &step, parent, kind);
        for (int i = place; i < stack->count; i++) {
            parents[i] = number;
            kinds[i] = child_kind(&step, &stack->rays[i]);
        }
    }
    ray_log->colour = stack->sums[0];
    scratch_free(scratch);
    return !follower.failed;
}

void ray_log_fini(RayLog *ray_log)
{
    ARRAY_FREE(&ray_log->rays);
    ARRAY_FREE(&ray_log->spheres);
    ARRAY_FREE(&ray_log->layers);
    ARRAY_FREE(&ray_log->lights);
}
