// The printable form of scene records: `.scn` text that evaluates to the same records again.
//
// Turns numbers into their shortest decimal forms, which read back as the same bits, and colours into phrases that keep
// all components. Shapes that are not plain ones are in dump_primitive.c, textures in dump_texture.c. Knows only what
// it writes of the language.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "scene/dump.h"

void dump_numbers(TextBuffer *out, const double *numbers, size_t count)
{
    text_append_char(out, '<');
    for (size_t i = 0; i < count; i++) {
        text_append(out, i ? ", " : "");
        text_append_double(out, numbers[i]);
    }
    text_append_char(out, '>');
}

void dump_vector(TextBuffer *out, const char *before, Vec3 vector)
{
    text_append(out, before);
    dump_numbers(out, (double[]){vector.x, vector.y, vector.z}, 3);
}

void dump_rgb(TextBuffer *out, const char *before, Rgb colour)
{
    text_printf(out, "%srgb ", before);
    dump_numbers(out, (double[]){colour.red, colour.green, colour.blue}, 3);
}

void dump_rgbft(TextBuffer *out, const char *before, Rgbft c)
{
    text_printf(out, "%srgbft ", before);
    dump_numbers(out, (double[]){c.red, c.green, c.blue, c.filter, c.transmit}, 5);
}

void dump_number(TextBuffer *out, const char *before, double number)
{
    text_append(out, before);
    text_append_double(out, number);
}

// A scene without assumed_gamma has no gamma model, unless it names the version 3.7.
static void dump_settings(const Settings *settings, TextBuffer *out)
{
    if (settings->gamma_model != GAMMA_NONE || settings->version != SCENE_VERSION_UNSAID) {
        dump_number(out, "#version ", settings->version);
        text_append(out, ";\n");
    }
    text_append(out, "global_settings {\n");
    switch (settings->gamma_model) {
    case GAMMA_NONE: break;
    case GAMMA_LINEAR: text_append(out, "  assumed_gamma 1\n"); break;
    case GAMMA_SRGB: text_append(out, "  assumed_gamma srgb\n"); break;
    case GAMMA_POWER:
        dump_number(out, "  assumed_gamma ", settings->assumed_gamma);
        text_append(out, "\n");
        break;
    }
    dump_rgb(out, "  ambient_light ", settings->ambient_light);
    text_printf(out, "\n  max_trace_level %d", settings->max_trace_level);
    if (settings->noise_generator != 0) {
        text_printf(out, "\n  noise_generator %d", settings->noise_generator);
    }
    if (settings->number_of_waves != SETTINGS_WAVES) {
        text_printf(out, "\n  number_of_waves %d", settings->number_of_waves);
    }
    if (settings->irid_wavelength.red != (double)0.70F || settings->irid_wavelength.green != (double)0.52F ||
        settings->irid_wavelength.blue != (double)0.48F) {
        dump_rgb(out, "\n  irid_wavelength ", settings->irid_wavelength);
    }
    dump_number(out, "\n  adc_bailout ", settings->adc_bailout);
    text_append(out, "\n}\n");
}

static void dump_camera(const Camera *camera, TextBuffer *out)
{
    static const char *const types[CAMERA_TYPES] = {
        [CAMERA_PERSPECTIVE] = "",           [CAMERA_ORTHOGRAPHIC] = "  orthographic\n",
        [CAMERA_FISHEYE] = "  fisheye\n",    [CAMERA_ULTRA_WIDE_ANGLE] = "  ultra_wide_angle\n",
        [CAMERA_PANORAMIC] = "  panoramic\n", [CAMERA_SPHERICAL] = "  spherical\n",
        [CAMERA_OMNIMAX] = "  omnimax\n",   [CAMERA_CYLINDER_1] = "  cylinder 1\n",
        [CAMERA_CYLINDER_2] = "  cylinder 2\n", [CAMERA_CYLINDER_3] = "  cylinder 3\n",
        [CAMERA_CYLINDER_4] = "  cylinder 4\n"};
    text_printf(out, "camera {\n%s", types[camera->type]);
    dump_vector(out, "  location ", camera->location);
    dump_vector(out, "\n  right ", camera->right);
    dump_vector(out, "\n  up ", camera->up);
    dump_vector(out, "\n  direction ", camera->direction);
    if (camera->type > CAMERA_ORTHOGRAPHIC && camera->type != CAMERA_PANORAMIC &&
        camera->type != CAMERA_OMNIMAX) {
        dump_number(out, "\n  angle ", camera->angle);
    }
    if (camera->type == CAMERA_SPHERICAL) {
        dump_number(out, ", ", camera->angle_vertical);
    }
    if (camera->lens_radius > 0.0) {
        Vec3 ahead = vec3_scale(camera->focal_distance / vec3_length(camera->direction), camera->direction);
        dump_number(out, "\n  aperture ", 4.0 * camera->lens_radius);
        int least = camera->blur_least > 0 ? camera->blur_least : 1;
        text_printf(out, "\n  blur_samples %d, %d", least, camera->blur_samples);
        dump_number(out, "\n  confidence ", camera->blur_confidence);
        dump_number(out, "\n  variance ", camera->blur_variance);
        dump_vector(out, "\n  focal_point ", vec3_add(camera->location, ahead));
    }
    if (camera->bumps) {
        text_printf(out, "\n  normal { N%lu }", (unsigned long)camera->bumps);
    }
    text_append(out, "\n}\n");
}

static void dump_area(const LightArea *area, TextBuffer *out)
{
    if (area->size1 == 0) {
        return;
    }
    dump_vector(out, " area_light ", area->axis1);
    dump_vector(out, ", ", area->axis2);
    text_printf(out, ", %d, %d", area->size1, area->size2);
    if (area->is_adaptive) {
        text_printf(out, " adaptive %d", area->adaptive);
    }
    text_append(out, area->circular ? " circular" : "");
    text_append(out, area->is_oriented ? " orient" : "");
    text_append(out, area->jitter ? " jitter" : "");
}

static void dump_light(const Light *light, TextBuffer *out)
{
    dump_vector(out, "light_source { ", light->position);
    dump_rgb(out, ", ", light->colour);
    static const char *const types[] = {[LIGHT_PARALLEL] = "parallel", [LIGHT_SPOT] = "spotlight",
                                        [LIGHT_CYLINDER] = "cylinder"};
    if (light->type != LIGHT_POINT) {
        text_printf(out, " %s", types[light->type]);
        dump_vector(out, " point_at ", light->point_at);
    }
    if (light->type == LIGHT_SPOT || light->type == LIGHT_CYLINDER) {
        dump_number(out, " radius ", light->radius);
        dump_number(out, " falloff ", light->falloff);
        dump_number(out, " tightness ", light->tightness);
    }
    if (light->fade_power != 0.0) {
        dump_number(out, " fade_distance ", light->fade_distance);
        dump_number(out, " fade_power ", light->fade_power);
    }
    dump_area(&light->area, out);
    text_append(out, light->is_attenuated ? " media_attenuation on" : "");
    text_append(out, light->shadowless ? " shadowless }\n" : " }\n");
}

static void dump_finish(const Finish *finish, size_t number, TextBuffer *out)
{
    text_printf(out, "#declare F%zu = finish {\n", number);
    dump_rgb(out, "  ambient ", finish->ambient);
    dump_rgb(out, " emission ", finish->emission);
    dump_number(out, "\n  diffuse ", finish->diffuse);
    // Only where it is used: POV-Ray has a note about the second number.
    if (finish->diffuse_back != 0.0 || signbit(finish->diffuse_back)) {
        dump_number(out, ", ", finish->diffuse_back);
    }
    dump_number(out, " brilliance ", finish->brilliance);
    dump_number(out, "\n  phong ", finish->phong);
    dump_number(out, " phong_size ", finish->phong_size);
    dump_number(out, " specular ", finish->specular);
    dump_number(out, " roughness ", finish->roughness);
    dump_number(out, " metallic ", finish->metallic);
    dump_rgb(out, "\n  reflection { ", finish->reflection_min);
    dump_rgb(out, ", ", finish->reflection_max);
    dump_number(out, " falloff ", finish->reflection_falloff);
    dump_number(out, " exponent ", finish->reflection_exponent);
    dump_number(out, " metallic ", finish->reflection_metallic);
    text_append(out, finish->flags & FINISH_FRESNEL ? " fresnel" : "");
    if (finish->refraction != 1.0) {
        dump_number(out, " }\n  refraction ", finish->refraction);
    } else {
        text_append(out, " }");
    }
    if (finish->crand != 0.0) {
        dump_number(out, "\n  crand ", finish->crand);
    }
    if (finish->irid != 0.0) {
        dump_number(out, "\n  irid { ", finish->irid);
        dump_number(out, " thickness ", finish->irid_thickness);
        dump_number(out, " turbulence ", finish->irid_turbulence);
        text_append(out, " }");
    }
    text_append(out, finish->flags & FINISH_CONSERVE_ENERGY ? "\n  conserve_energy\n}\n" : "\n}\n");
}

static void dump_material(const Material *material, size_t number, TextBuffer *out)
{
    text_printf(out, "#declare M%zu = texture { ", number);
    dump_rgbft(out, "pigment { ", material_pigment(material));
    text_printf(out, " } finish { F%lu } }\n", (unsigned long)material->finish + 1);
}

uint32_t dump_interior_of(const Scene *scene, MaterialIndex material)
{
    return material & MATERIAL_COMPOUND ? scene->compounds.items[material & ~MATERIAL_COMPOUND].interior : RECORD_NONE;
}

void dump_interior_word(uint32_t interior, TextBuffer *out)
{
    if (interior == RECORD_NONE) {
        text_append(out, " interior { ior 1 }");
    } else {
        text_printf(out, " interior { I%lu }", (unsigned long)interior + 1);
    }
}

static void dump_inner_texture(const Scene *scene, MaterialIndex material, TextBuffer *out)
{
    uint32_t inner =
        material & MATERIAL_COMPOUND ? scene->compounds.items[material & ~MATERIAL_COMPOUND].inner : RECORD_NONE;
    if (inner != RECORD_NONE) {
        text_append(out, " interior_texture { ");
        dump_texture_name(inner, scene, out);
        text_append(out, " }");
    }
}

void dump_texture(const Scene *scene, MaterialIndex material, const uint32_t *around, TextBuffer *out)
{
    const char *hollow = scene_is_hollow(scene, material) ? " hollow" : "";
    uint32_t interior = dump_interior_of(scene, material);
    if (material & MATERIAL_COMPOUND) {
        const Compound *compound = &scene->compounds.items[material & ~MATERIAL_COMPOUND];
        const Texture *fields = dump_fields_of(scene, material);
        uint32_t texture = fields ? scene->texture_entries.items[fields->entries].texture : compound->texture;
        text_printf(out, "%s texture { T%lu }", hollow, (unsigned long)texture + 1);
    } else {
        text_printf(out, "%s texture { M%lu }", hollow, (unsigned long)material + 1);
    }
    dump_inner_texture(scene, material, out);
    if ((material & MATERIAL_COMPOUND) && scene->compounds.items[material & ~MATERIAL_COMPOUND].is_double) {
        text_append(out, " double_illuminate");
    }
    if (!around || *around != interior) {
        dump_interior_word(interior, out);
    }
    text_append(out, " }\n");
}

static void dump_sphere(const Scene *scene, const Sphere *sphere, const uint32_t *around, TextBuffer *out)
{
    dump_vector(out, "sphere { ", sphere->centre);
    dump_number(out, ", ", sphere->radius);
    dump_texture(scene, sphere->material, around, out);
}

static void dump_plane(const Scene *scene, const Plane *plane, const uint32_t *around, TextBuffer *out)
{
    dump_vector(out, "plane { ", plane->normal);
    dump_number(out, ", ", plane->distance);
    dump_texture(scene, plane->material, around, out);
}

// The bodies of several shapes, and the group of lights, that are open while shapes are written: each body as a union.
typedef struct OpenBodies {
    const Scene *scene;
    uint32_t innermost, next; // Scene.bodies; the first may be RECORD_NONE
    uint32_t group_end;       // of the open group's shapes; 0: none is open
    uint32_t group_in;        // the innermost body around it
    uint32_t next_group;      // Scene.light_groups
} OpenBodies;

static bool has_group_inside(const OpenBodies *open)
{
    return open->group_end != 0 && open->innermost == open->group_in;
}

static void close_group(OpenBodies *open, TextBuffer *out)
{
    const LightGroup *group = &open->scene->light_groups.items[open->next_group - 1];
    text_append(out, group->has_others ? " global_lights on }\n" : " }\n");
    open->group_end = 0;
}

static void close_bodies(OpenBodies *open, uint32_t order, TextBuffer *out)
{
    for (;;) {
        if (has_group_inside(open)) {
            if (open->group_end > order) {
                return;
            }
            close_group(open, out);
        }
        if (open->innermost == RECORD_NONE || open->scene->bodies.items[open->innermost].end > order) {
            return;
        }
        const Body *body = &open->scene->bodies.items[open->innermost];
        if (body->interior != RECORD_NONE || body->around != RECORD_NONE) {
            dump_interior_word(body->interior, out);
        }
        text_append(out, " }\n");
        open->innermost = body->around;
    }
}

static void open_group(OpenBodies *open, TextBuffer *out)
{
    const Scene *scene = open->scene;
    const LightGroup *group = &scene->light_groups.items[open->next_group++];
    text_append(out, "light_group {\n");
    for (size_t i = 0; i < scene->lights.count; i++) {
        if (scene->lights.items[i].group == open->next_group) {
            dump_light(&scene->lights.items[i], out);
        }
    }
    open->group_end = group->end;
    open->group_in = open->innermost;
    if (group->end == group->first) {
        close_group(open, out);
    }
}

// Of what begins at a shape, what ends last comes first.
static void open_bodies(OpenBodies *open, uint32_t order, TextBuffer *out)
{
    const Scene *scene = open->scene;
    for (;;) {
        bool has_body = open->next < scene->bodies.count && scene->bodies.items[open->next].first <= order;
        bool has_group =
            open->next_group < scene->light_groups.count && scene->light_groups.items[open->next_group].first <= order;
        if (!has_body && !has_group) {
            return;
        }
        uint32_t end = has_body ? scene->bodies.items[open->next].end : 0;
        if (!has_body || (has_group && scene->light_groups.items[open->next_group].end > end) ||
            (has_group && end <= order + 1)) {
            open_group(open, out);
        } else {
            open->innermost = end > order + 1 ? open->next : open->innermost;
            text_append(out, end > order + 1 ? "union {\n" : "");
            open->next++;
        }
    }
}

// What is said around a shape of its interior: NULL where it is a body of its own in another one.
static const uint32_t *interior_around(const OpenBodies *open, uint32_t order)
{
    static const uint32_t nothing = RECORD_NONE;
    if (open->innermost == RECORD_NONE) {
        return &nothing;
    }
    return open->innermost == scene_body(open->scene, order) ? &open->scene->bodies.items[open->innermost].interior
                                                             : NULL;
}

// Each array is in the order of declaration, so they are merged.
static void dump_shapes(const Scene *scene, TextBuffer *out)
{
    size_t sphere = 0, plane = 0, part = 0, composite = 0;
    OpenBodies open = {scene, RECORD_NONE, 0, 0, RECORD_NONE, 0};
    for (uint32_t order = 0; order < scene->shape_count; order++) {
        close_bodies(&open, order, out);
        open_bodies(&open, order, out);
        const uint32_t *around = interior_around(&open, order);
        if (sphere < scene->spheres.count && scene_sphere_order(scene, sphere) == order) {
            dump_sphere(scene, &scene->spheres.items[sphere++], around, out);
        } else if (plane < scene->planes.count && scene->planes.items[plane].order == order) {
            dump_plane(scene, &scene->planes.items[plane++], around, out);
        } else if (composite < scene->composites.count && scene->composites.items[composite].order == order) {
            part += scene->composites.items[composite].primitive_count;
            dump_composite(scene, &scene->composites.items[composite++], around, open.innermost != RECORD_NONE, out);
        } else {
            dump_primitive(scene, &scene->primitives.items[part++], around, out);
        }
    }
    close_bodies(&open, scene->shape_count, out);
    open_bodies(&open, scene->shape_count, out); // groups without shapes
}

static void dump_fog(const Fog *fog, TextBuffer *out)
{
    text_append(out, fog->is_ground ? "fog { fog_type 2" : "fog {");
    dump_number(out, " distance ", fog->distance);
    if (fog->is_ground) {
        dump_number(out, " fog_offset ", fog->offset);
        dump_number(out, " fog_alt ", fog->alt);
        dump_vector(out, " up ", fog->up);
    }
    if (fog->is_turbulent) {
        dump_vector(out, " turbulence ", fog->turbulence);
        dump_number(out, " turb_depth ", fog->turb_depth);
        dump_number(out, " lambda ", fog->lambda);
        dump_number(out, " omega ", fog->omega);
        text_printf(out, " octaves %d", fog->octaves);
    }
    dump_rgbft(out, " ", fog->colour);
    text_append(out, " }\n");
}

static void dump_rainbow(const Scene *scene, const Rainbow *rainbow, TextBuffer *out)
{
    dump_vector(out, "rainbow { direction ", rainbow->direction);
    dump_vector(out, " up ", rainbow->up);
    dump_number(out, " angle ", rainbow->angle);
    dump_number(out, " width ", rainbow->width);
    dump_number(out, " distance ", rainbow->distance);
    dump_number(out, " jitter ", rainbow->jitter);
    dump_number(out, " arc_angle ", 2.0 * rainbow->arc);
    dump_number(out, " falloff_angle ", 2.0 * rainbow->falloff);
    text_append(out, "\n  color_map {");
    uint32_t entry = scene->patterns.items[rainbow->pattern].entries;
    for (; entry != RECORD_NONE; entry = scene->pigment_entries.items[entry].next) {
        dump_number(out, " [", scene->pigment_entries.items[entry].at);
        dump_rgbft(out, " ", pigment_colour(&scene->pigment_entries.items[entry].pigment));
        text_append(out, "]");
    }
    text_append(out, " } }\n");
}

void scene_dump(const Scene *scene, TextBuffer *out)
{
    dump_settings(&scene->settings, out);
    if (scene->has_camera && !scene->camera.bumps) {
        dump_camera(&scene->camera, out);
    }
    dump_rgbft(out, "background { ", scene->background);
    text_append(out, " }\n");
    for (size_t i = 0; i < scene->fogs.count; i++) {
        dump_fog(&scene->fogs.items[i], out);
    }
    for (size_t i = 0; i < scene->lights.count && scene->lights.items[i].group == 0; i++) {
        dump_light(&scene->lights.items[i], out);
    }
    for (size_t i = 0; i < scene->finishes.count; i++) {
        dump_finish(&scene->finishes.items[i], i + 1, out);
    }
    for (size_t i = 0; i < scene->materials.count; i++) {
        dump_material(&scene->materials.items[i], i + 1, out);
    }
    bool has_insides = scene->insides.count > 0; // which are made of meshes, too
    (has_insides ? dump_meshes : dump_textures)(scene, out);
    (has_insides ? dump_textures : dump_meshes)(scene, out);
    dump_shapes(scene, out);
    dump_sky(scene, out);
    for (size_t i = 0; i < scene->rainbows.count; i++) {
        dump_rainbow(scene, &scene->rainbows.items[i], out);
    }
    if (scene->camera.bumps) { // which come last, behind those of all textures
        dump_camera(&scene->camera, out);
    }
}
