// The printable form of primitives and composites: each primitive as its fixed shape under a matrix, each node as the
// block that makes it.
//
// SPDX-License-Identifier: MIT
#include <math.h>

#include "scene/blob.h"
#include "scene/corners.h"
#include "scene/dump.h"
#include "scene/mesh_field.h"
#include "scene/primitive.h"

const Texture *dump_fields_of(const Scene *scene, MaterialIndex material)
{
    const Texture *texture = material & MATERIAL_COMPOUND
                                 ? &scene->textures.items[scene->compounds.items[material & ~MATERIAL_COMPOUND].texture]
                                 : NULL;
    return texture && texture_is_of_fields(texture) ? texture : NULL;
}

// All of a blob but its head; `texture` is NULL or that of its components.
static void dump_blob(const Scene *scene, const Primitive *primitive, const Texture *texture, TextBuffer *out)
{
    Blob blob = blob_of(primitive->list.items);
    uint32_t entry = texture ? texture->entries : RECORD_NONE;
    dump_number(out, "threshold ", blob.threshold);
    for (uint32_t i = 0; i < blob.component_count; i++) {
        const BlobComponent *component = &blob.components[i];
        if (component->is_rod != 0.0) {
            dump_number(out, " cylinder { 0, ", component->height);
            dump_number(out, "*z, 1, ", component->strength);
        } else {
            dump_number(out, " sphere { 0, 1, ", component->strength);
        }
        text_append(out, " matrix ");
        dump_numbers(out, &component->to_world[0][0], 12);
        if (texture && component->texture > 0.0) {
            entry = scene->texture_entries.items[entry].next;
            text_printf(out, " texture { T%lu }", (unsigned long)scene->texture_entries.items[entry].texture + 1);
        }
        text_append(out, " }");
    }
}

static void dump_form(const Scene *scene, const Primitive *primitive, TextBuffer *out)
{
    if (primitive_class(primitive->kind)->is_mesh) {
        dump_mesh_part(scene, primitive, out);
        return;
    }
    const PrimitiveClass *class = primitive_class(primitive->kind);
    text_append(out, class->head);
    if (primitive->kind == PRIMITIVE_PARAMETRIC) {
        dump_parametric(scene, primitive, out);
    } else if (primitive->kind == PRIMITIVE_ISOSURFACE) {
        dump_isosurface(scene, primitive, out);
    } else if (primitive->kind == PRIMITIVE_BLOB) {
        dump_blob(scene, primitive,
                  primitive->flags & PRIMITIVE_UNSEEN ? NULL : dump_fields_of(scene, primitive->material), out);
    }
    if (class->dump) {
        class->dump(primitive, out);
    }
}

// The number that times a factor is the one given: of those that are about it, one that was made so is found.
static double before_factor(double value, double factor)
{
    double about = value / factor, low = about, high = about;
    for (int i = 0; i < 2; i++) {
        if (low * factor == value) {
            return low;
        }
        if (high * factor == value) {
            return high;
        }
        low = nextafter(low, -(double)INFINITY);
        high = nextafter(high, (double)INFINITY);
    }
    return about;
}

// A field of heights is written in the unit cube.
static Transform written_place(const Primitive *primitive)
{
    Transform place = primitive->to_world;
    if (primitive_class(primitive->kind)->is_mesh && primitive->mesh.mesh->field) {
        Vec3 size = mesh_field_size(primitive->mesh.mesh->field);
        for (int i = 0; i < 3; i++) {
            place.m[0][i] = before_factor(place.m[0][i], 1.0 / size.x);
            place.m[2][i] = before_factor(place.m[2][i], 1.0 / size.z);
        }
    }
    return place;
}

// Each word with a blank before or behind it.
static void dump_words(bool is_inverse, uint8_t hidden, const char *before, const char *behind, TextBuffer *out)
{
    static const char *const words[] = {"no_image", "no_shadow", "no_reflection"}; // in the order of HiddenFrom
    if (is_inverse) {
        text_printf(out, "%sinverse%s", before, behind);
    }
    for (unsigned i = 0; i < 3; i++) {
        if (hidden & 1u << i) {
            text_printf(out, "%s%s%s", before, words[i], behind);
        }
    }
}

void dump_primitive(const Scene *scene, const Primitive *primitive, const uint32_t *around, TextBuffer *out)
{
    dump_form(scene, primitive, out);
    text_append(out, primitive->flags & PRIMITIVE_OPEN ? " open" : "");
    if (primitive->kind != PRIMITIVE_PLANE) {
        text_append(out, " matrix ");
        Transform place = written_place(primitive);
        dump_numbers(out, &place.m[0][0], 12);
    }
    dump_words(primitive->flags & PRIMITIVE_INVERSE, primitive->hidden, " ", "", out);
    if (primitive->flags & PRIMITIVE_UNSEEN) {
        text_append(out, " }\n");
    } else {
        dump_texture(scene, primitive->material, around, out);
    }
}

// Where the dump stands in a composite.
typedef struct Walk {
    const Scene *scene;
    const Composite *composite;
    uint32_t node, node_end;
    uint32_t part;
    bool is_inside; // of a body
} Walk;

// What fills the group around: Primitive.body and its interior.
typedef struct Fill {
    uint32_t body, interior;
} Fill;

enum { FILL_NONE = UINT32_MAX }; // no Primitive.body: nothing is around

// What the first primitive of a body within a composite is filled with.
static uint32_t body_interior(const Walk *walk, uint32_t body)
{
    for (uint32_t i = 0; i < walk->composite->primitive_count; i++) {
        const Primitive *primitive = &walk->scene->primitives.items[walk->composite->first_primitive + i];
        if (primitive->body == body && !(primitive->flags & PRIMITIVE_UNSEEN)) {
            return dump_interior_of(walk->scene, primitive->material);
        }
    }
    return RECORD_NONE;
}

static void dump_node(Walk *walk, const Fill *around, uint8_t hidden, const char *hollow, TextBuffer *out);

// Whether the next child is a node that bounds the one around it.
static bool next_is_bound(const Walk *walk)
{
    const Node *node = walk->node < walk->node_end ? &walk->scene->nodes.items[walk->node] : NULL;
    return node && node->op == NODE_BOUND && node->first_primitive <= walk->part;
}

// The next child of a node: the next node of all, or the next primitive, whichever was declared first.
static void dump_child(Walk *walk, uint32_t parent, const Fill *around, TextBuffer *out)
{
    const Node *node = walk->node < walk->node_end ? &walk->scene->nodes.items[walk->node] : NULL;
    if (node && node->parent == parent && node->first_primitive <= walk->part) {
        dump_node(walk, around, 0, "", out);
    } else {
        const Primitive *primitive = &walk->scene->primitives.items[walk->part++];
        dump_primitive(walk->scene, primitive, primitive->body == around->body ? &around->interior : NULL, out);
    }
}

// Recursive, as deep as the language lets objects nest. The object that is clipped comes first, then each of its clips.
static void dump_node(Walk *walk, const Fill *around, uint8_t hidden, const char *hollow, TextBuffer *out)
{
    static const char *const heads[] = {
        [NODE_UNION] = "union {\n", [NODE_MERGE] = "merge {\n",      [NODE_INTERSECTION] = "intersection {\n",
        [NODE_CLIP] = "object {\n", [NODE_BOUND] = "bounded_by {\n",
    };
    uint32_t at = walk->node++;
    const Node *node = &walk->scene->nodes.items[at];
    bool is_body = node->body != around->body;
    Fill fill = is_body ? (Fill){node->body, body_interior(walk, node->body)} : *around;
    text_append(out, heads[node->op]);
    for (uint32_t i = 0; i < node->child_count; i++) {
        bool is_clip = node->op == NODE_CLIP && i > 0 && !next_is_bound(walk);
        text_append(out, is_clip ? "clipped_by { " : "");
        dump_child(walk, at, &fill, out);
        text_append(out, is_clip ? "}\n" : "");
    }
    dump_words(node->is_inverse, hidden, "", " ", out);
    text_append(out, hollow);
    if (is_body && (fill.interior != RECORD_NONE || around->body != FILL_NONE || walk->is_inside)) {
        dump_interior_word(fill.interior, out);
    }
    text_append(out, "}\n");
}

// All primitives that are seen are hollow, or none is; members without surfaces have no say.
static const char *hollow_word(const Scene *scene, const Composite *composite)
{
    for (uint32_t i = 0; i < composite->primitive_count; i++) {
        const Primitive *primitive = &scene->primitives.items[composite->first_primitive + i];
        if (!(primitive->flags & PRIMITIVE_UNSEEN) && scene_is_hollow(scene, primitive->material)) {
            return "hollow ";
        }
    }
    return "";
}

void dump_composite(const Scene *scene, const Composite *composite, const uint32_t *around, bool is_inside,
                    TextBuffer *out)
{
    Walk walk = {scene,
                 composite,
                 composite->first_node,
                 composite->first_node + composite->node_count,
                 composite->first_primitive,
                 is_inside};
    Fill fill = around && is_inside ? (Fill){0, *around} : (Fill){FILL_NONE, RECORD_NONE};
    dump_node(&walk, &fill, composite->hidden, hollow_word(scene, composite), out);
}

// The root is a union of one object, which is what is said.
void dump_inside(const Scene *inside, TextBuffer *out)
{
    const Composite *composite = inside->composites.items;
    Walk walk = {inside, composite, 1, composite->node_count, 0, false};
    Fill fill = {0, RECORD_NONE};
    dump_child(&walk, 0, &fill, out);
}
