// Equal shapes: a hash table of all that stand alone, and of composites, finds those that coincide; what is cut in a
// composite is looked up among those that stand alone.
//
// A shape becomes a key, equal for equal surfaces, whichever list of the scene it stands in. The table holds hashes
// beside shape numbers, so that the scene's records are read in order but for those that are alike; its slots are read
// for some shapes ahead, because waiting for memory is nearly all that this would do.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/cleared.h"
#include "base/pages.h"
#include "base/parallel.h"
#include "scene/opaque.h"
#include "scene/primitive_reach.h"
#include "scene/primitive.h"
#include "scene/range.h"

// A key has room for a transform and all that a primitive's data[] may hold.
enum {
    AHEAD = 32,
    KEY_NUMBERS = (sizeof(Transform) + sizeof((Primitive){0}.data)) / sizeof(double),
    KIND_SPHERE_KEY = PRIMITIVE_KINDS
};

__extension__ typedef unsigned __int128 Wide;

// What makes a surface, -0 and 0 being one number.
typedef struct Key {
    uint32_t kind, count; // numbers that count
    double numbers[KEY_NUMBERS];
    uint64_t source;
    uint32_t order;
    MaterialIndex material;
    uint8_t hidden;
    bool is_turned; // inside and outside have changed places
    bool is_smooth; // its light is not that of its surface
} Key;

typedef struct Slot {
    uint32_t hash;
    uint32_t item; // number of the shape, or after all shapes of the composite, + 1; 0: empty
} Slot;

typedef struct Coincidences {
    const Scene *scene;
    size_t planes, parts, end; // numbers of the first ones; spheres begin at 0
    Slot *slots;
    uint32_t mask;
} Coincidences;

static void key_add(Key *key, Vec3 a)
{
    double *numbers = key->numbers + key->count;
    numbers[0] = a.x + 0.0;
    numbers[1] = a.y + 0.0;
    numbers[2] = a.z + 0.0;
    key->count += 3;
}

static void key_sphere(Key *key, Vec3 centre, double radius)
{
    key->kind = KIND_SPHERE_KEY;
    key_add(key, centre);
    key->numbers[key->count++] = radius;
}

// Of opposite normals one is taken: the first number that is not 0 is positive.
static void key_plane(Key *key, Vec3 normal, double distance)
{
    double first = normal.x != 0.0 ? normal.x : normal.y != 0.0 ? normal.y : normal.z;
    key->kind = PRIMITIVE_PLANE;
    key_add(key, first < 0.0 ? vec3_neg(normal) : normal);
    key->is_turned = first < 0.0;
    key->numbers[key->count++] = (first < 0.0 ? -distance : distance) + 0.0;
}

static void key_transform(Key *key, const Transform *m)
{
    for (int row = 0; row < 4; row++) {
        key_add(key, vec3(m->m[row][0], m->m[row][1], m->m[row][2]));
    }
}

// A ball that is round is a sphere.
static void key_ball(Key *key, const Transform *m)
{
    if (primitive_map_is_round(m->m)) {
        key_sphere(key, vec3(m->m[3][0], m->m[3][1], m->m[3][2]), fabs(m->m[0][0]));
    } else {
        key->kind = PRIMITIVE_SPHERE;
        key_transform(key, m);
    }
}

static void key_primitive(Key *key, const Primitive *primitive)
{
    switch (primitive->kind) {
    case PRIMITIVE_PLANE:
        key_plane(key, primitive->data[0], primitive->data[1].x);
        break;
    case PRIMITIVE_SPHERE:
        key_ball(key, &primitive->to_world);
        break;
    default:
        key->kind = primitive_class(primitive->kind)->surface;
        key_transform(key, &primitive->to_world);
        for (unsigned i = 0; i < primitive_class(primitive->kind)->key_count; i++) {
            key_add(key, primitive->data[i]);
        }
        if (primitive_class(primitive->kind)->is_mesh) { // two that have the same triangles, but by chance, are two
            const Mesh *mesh = primitive->mesh.mesh;
            key_add(key, vec3(mesh->number, mesh->face_textures ? 1.0 : 0.0, (double)mesh->source));
        }
    }
}

static Key item_key(const Coincidences *search, size_t item)
{
    const Scene *scene = search->scene;
    Key key;
    key.count = 0;
    key.hidden = 0;
    key.is_turned = key.is_smooth = false;
    if (item < search->planes) {
        const Sphere *sphere = &scene->spheres.items[item];
        key.source = scene_sphere_source(scene, item);
        key.order = scene_sphere_order(scene, item);
        key.material = sphere->material;
        key_sphere(&key, sphere->centre, sphere->radius);
    } else if (item < search->parts) {
        const Plane *plane = &scene->planes.items[item - search->planes];
        key.source = plane->source;
        key.order = plane->order;
        key.material = plane->material;
        key_plane(&key, plane->normal, plane->distance);
    } else {
        const Primitive *primitive = &scene->primitives.items[item - search->parts];
        key.source = primitive->source;
        key.order = primitive->order;
        key.material = primitive->material;
        key.hidden = primitive->hidden;
        key_primitive(&key, primitive);
        key.is_turned ^= (primitive->flags & PRIMITIVE_INVERSE) != 0;
        key.is_smooth = primitive->kind == PRIMITIVE_SMOOTH_TRIANGLE;
    }
    return key;
}

static bool item_is_alone(const Coincidences *search, size_t item)
{
    return item < search->parts || search->scene->primitives.items[item - search->parts].node == NODE_NONE;
}

static inline uint64_t word_of(double number)
{
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    return word;
}

// As in scene/unique.c.
static inline uint64_t hash_add(uint64_t hash, double number)
{
    hash = (hash ^ word_of(number)) * UINT64_C(0xff51afd7ed558ccd);
    return hash ^ hash >> 33;
}

// Both halves of the product, one upon the other, as wyhash has it (W. Yi, public domain).
static inline uint64_t folded(uint64_t a, uint64_t b)
{
    return a * b ^ (uint64_t)((Wide)a * b >> 64);
}

// Of a sphere's key, which is what nearly all keys are. All bits count, for numbers of grids differ in few.
static inline uint32_t sphere_hash(Vec3 centre, double radius)
{
    uint64_t hash = folded(word_of(centre.x + 0.0) ^ UINT64_C(0xa0761d6478bd642f),
                           word_of(centre.y + 0.0) ^ UINT64_C(0xe7037ed1a0b428db));
    return (uint32_t)folded(hash ^ word_of(centre.z + 0.0), word_of(radius) ^ UINT64_C(0x8ebc6af09c88c6e3));
}

static uint32_t key_hash(const Key *key)
{
    if (key->kind == KIND_SPHERE_KEY) {
        return sphere_hash(vec3(key->numbers[0], key->numbers[1], key->numbers[2]), key->numbers[3]);
    }
    uint64_t hash = key->kind;
    for (uint32_t i = 0; i < key->count; i++) {
        hash = hash_add(hash, key->numbers[i]);
    }
    return (uint32_t)hash;
}

static uint32_t item_hash(const Coincidences *search, size_t item)
{
    if (item < search->planes) {
        const Sphere *sphere = &search->scene->spheres.items[item];
        return sphere_hash(sphere->centre, sphere->radius);
    }
    Key key = item_key(search, item);
    return key_hash(&key);
}

static bool keys_are_equal(const Key *a, const Key *b)
{
    return a->kind == b->kind && a->count == b->count &&
           memcmp(a->numbers, b->numbers, a->count * sizeof a->numbers[0]) == 0;
}

bool scene_primitives_coincide(const Primitive *a, const Primitive *b)
{
    Key one, other;
    one.count = other.count = 0;
    key_primitive(&one, a);
    key_primitive(&other, b);
    return keys_are_equal(&one, &other);
}

static void tell(const Key *one, const Key *other, DiagSink *diags)
{
    const Key *first = one->order < other->order ? one : other, *second = first == one ? other : one;
    const char *word = one->kind == KIND_SPHERE_KEY    ? "sphere"
                       : one->kind == PRIMITIVE_SPHERE ? "stretched sphere"
                                                       : primitive_class((PrimitiveKind)one->kind)->word;
    if (diag_report(diags, DIAG_W0444, scene_source_span(second->source),
                    "this %s coincides with one that was declared before it", word) &&
        first->source) {
        diag_note(diags, scene_source_span(first->source), "this one is seen, the other is not");
    }
}

// Whether the picture is the same whichever of them is seen. What lets light through changes what lies behind it, too:
// two of those are not one.
static bool look_alike(const Scene *scene, const Key *one, const Key *other)
{
    return one->is_turned == other->is_turned && !one->is_smooth && !other->is_smooth &&
           scene_materials_are_alike(scene, one->material, other->material) &&
           scene_material_is_opaque(scene, one->material);
}

// Whether they are one surface to some rays; reports it where that can be seen.
static bool are_twins(const Scene *scene, const Key *one, const Key *other, DiagSink *diags)
{
    if (!hidden_meet(one->hidden, other->hidden) || !keys_are_equal(one, other)) {
        return false;
    }
    if (!look_alike(scene, one, other)) {
        tell(one, other, diags);
    }
    return true;
}

// ---- composites: equal when their trees are, leaf by leaf

static uint32_t composite_hash(const Coincidences *search, const Composite *composite)
{
    uint32_t hash = composite->node_count;
    for (uint32_t i = 0; i < composite->primitive_count; i++) {
        Key key = item_key(search, search->parts + composite->first_primitive + i);
        hash = (hash ^ key_hash(&key)) * UINT32_C(0x9e3779b1);
    }
    return hash;
}

// A place in the tree, counted from its root.
static uint32_t below(uint32_t node, const Composite *composite)
{
    return node == NODE_NONE ? NODE_NONE : node - composite->first_node;
}

static bool composites_are_equal(const Coincidences *search, const Composite *a, const Composite *b)
{
    const Scene *scene = search->scene;
    bool equal = a->node_count == b->node_count && a->primitive_count == b->primitive_count;
    for (uint32_t i = 0; equal && i < a->node_count; i++) {
        const Node *one = &scene->nodes.items[a->first_node + i], *other = &scene->nodes.items[b->first_node + i];
        equal = one->op == other->op && one->is_inverse == other->is_inverse &&
                one->child_count == other->child_count && below(one->parent, a) == below(other->parent, b);
    }
    for (uint32_t i = 0; equal && i < a->primitive_count; i++) {
        const Primitive *one = &scene->primitives.items[a->first_primitive + i],
                        *other = &scene->primitives.items[b->first_primitive + i];
        Key key = item_key(search, search->parts + a->first_primitive + i);
        Key known = item_key(search, search->parts + b->first_primitive + i);
        bool is_same_side = one->kind != PRIMITIVE_PLANE || vec3_equal(one->data[0], other->data[0]);
        equal = keys_are_equal(&key, &known) && is_same_side && one->flags == other->flags &&
                below(one->node, a) == below(other->node, b);
    }
    return equal;
}

// Leaf by leaf, of two whose trees are equal.
static bool composites_look_alike(const Scene *scene, const Composite *a, const Composite *b)
{
    bool are_alike = true;
    for (uint32_t i = 0; are_alike && i < a->primitive_count; i++) {
        const Primitive *one = &scene->primitives.items[a->first_primitive + i],
                        *other = &scene->primitives.items[b->first_primitive + i];
        are_alike =
            (one->flags & PRIMITIVE_UNSEEN) || (scene_materials_are_alike(scene, one->material, other->material) &&
                                                scene_material_is_opaque(scene, one->material));
    }
    return are_alike;
}

static void tell_composite(const Composite *one, const Composite *other, DiagSink *diags)
{
    const Composite *first = one->order < other->order ? one : other, *second = first == one ? other : one;
    if (hidden_meet(one->hidden, other->hidden) &&
        diag_report(diags, DIAG_W0444, scene_source_span(second->source),
                    "this coincides with the same shapes, cut alike, that were declared before it") &&
        first->source) {
        diag_note(diags, scene_source_span(first->source), "this one is seen, the other is not");
    }
}

static void visit_composite(const Coincidences *search, uint32_t number, DiagSink *diags)
{
    const Composite *composites = search->scene->composites.items;
    uint32_t hash = composite_hash(search, &composites[number]);
    for (uint32_t at = hash & search->mask;; at = (at + 1) & search->mask) {
        Slot *slot = &search->slots[at];
        if (slot->item == 0) {
            *slot = (Slot){hash, (uint32_t)search->end + number + 1};
            return;
        }
        if (slot->hash == hash && slot->item > search->end) {
            const Composite *known = &composites[slot->item - 1 - search->end];
            if (composites_are_equal(search, &composites[number], known)) {
                if (!composites_look_alike(search->scene, &composites[number], known)) {
                    tell_composite(&composites[number], known, diags);
                }
                return;
            }
        }
    }
}

// ---- shapes that stand alone beside the same ones in composites

// Whether the outside of a leaf is outside of its composite, too, so that where it is not cut away both are seen.
static bool is_outer(const Scene *scene, const Primitive *primitive)
{
    bool flips = (primitive->flags & PRIMITIVE_INVERSE) != 0;
    for (uint32_t node = primitive->node; node != NODE_NONE; node = scene->nodes.items[node].parent) {
        flips ^= scene->nodes.items[node].is_inverse;
    }
    return !flips && !(primitive->flags & PRIMITIVE_UNSEEN);
}

// Leaves are not compared with each other: two halves of a sphere have it in common, and no surface.
static void visit_leaf(const Coincidences *search, const Composite *composite, uint32_t number, DiagSink *diags)
{
    const Primitive *primitive = &search->scene->primitives.items[number];
    if (primitive->kind == PRIMITIVE_PLANE || !is_outer(search->scene, primitive)) {
        return;
    }
    Key key = item_key(search, search->parts + number);
    uint32_t hash = key_hash(&key);
    key.hidden = composite->hidden;
    for (uint32_t at = hash & search->mask; search->slots[at].item != 0; at = (at + 1) & search->mask) {
        const Slot *slot = &search->slots[at];
        if (slot->hash == hash && slot->item <= search->end) {
            Key known = item_key(search, slot->item - 1);
            if (are_twins(search->scene, &key, &known, diags)) {
                return;
            }
        }
    }
}

// ---- all of them

// Looks one shape up, and puts it in where its equal was not.
static void visit(const Coincidences *search, size_t item, uint32_t hash, DiagSink *diags)
{
    for (uint32_t at = hash & search->mask;; at = (at + 1) & search->mask) {
        Slot *slot = &search->slots[at];
        if (slot->item == 0) {
            *slot = (Slot){hash, (uint32_t)item + 1};
            return;
        }
        if (slot->hash != hash || slot->item > search->end) {
            continue;
        }
        Key key = item_key(search, item), known = item_key(search, slot->item - 1);
        if (are_twins(search->scene, &key, &known, diags)) {
            return;
        }
    }
}

// ---- many spheres: most have a hash of their own, which a map of bits tells, and are not looked up

enum {
    BITS_PER_SPHERE = 16, // at least: one sphere in 16 is looked up in vain
    BLOOM_AHEAD = 64,     // spheres whose bits memory is prefetched at once
};

typedef struct BloomFilter {
    const Coincidences *search;
    uint32_t *places;       // of bits, of all spheres; then, run by run, the numbers of those to be looked up
    uint32_t *counts;       // of these, for each run
    uint64_t *once, *twice; // bits of hashes that were met, and met again
    Pages pages;            // that places and bits are in: malloc would keep them while the tree is built
    uint32_t mask;          // what of a hash is its place
    bool is_shared;         // by threads
} BloomFilter;

// Whether it was set. Places are below the number of bits.
static inline bool bit_set(uint64_t *bits, uint32_t place, bool is_shared)
{
    uint64_t *word = &bits[place / 64], bit = UINT64_C(1) << place % 64;
    if (is_shared) {
        return __atomic_fetch_or(word, bit, __ATOMIC_RELAXED) & bit;
    }
    uint64_t before = *word;
    *word = before | bit;
    return before & bit;
}

static inline bool bit_get(const uint64_t *bits, uint32_t place)
{
    return bits[place / 64] >> place % 64 & 1;
}

// Places are computed, and memory is prefetched for them, some spheres ahead.
RT_ALWAYS_INLINE void bloom_some(const BloomFilter *bloom, size_t begin, size_t end, bool is_shared)
{
    const Sphere *spheres = bloom->search->scene->spheres.items;
    uint64_t *once = bloom->once;
    uint32_t *places = bloom->places, mask = bloom->mask;
    for (size_t i = begin; i < end; i++) {
        uint32_t place = sphere_hash(spheres[i].centre, spheres[i].radius) & mask;
        places[i] = place;
        __builtin_prefetch(&once[place / 64], 1);
    }
    for (size_t i = begin; i < end; i++) {
        if (bit_set(once, places[i], is_shared)) {
            bit_set(bloom->twice, places[i], is_shared);
        }
    }
}

static void bloom_run(void *client, size_t begin, size_t end)
{
    const BloomFilter *bloom = client;
    for (size_t some = begin, stop; some < end; some = stop) {
        stop = end - some < BLOOM_AHEAD ? end : some + BLOOM_AHEAD;
        if (bloom->is_shared) {
            bloom_some(bloom, some, stop, true);
        } else {
            bloom_some(bloom, some, stop, false);
        }
    }
}

static void gather_run(void *client, size_t begin, size_t end)
{
    const BloomFilter *bloom = client;
    const uint64_t *twice = bloom->twice;
    uint32_t *places = bloom->places, *kept = &places[begin];
    for (size_t some = begin, stop; some < end; some = stop) {
        stop = end - some < BLOOM_AHEAD ? end : some + BLOOM_AHEAD;
        for (size_t i = some; i < stop; i++) {
            __builtin_prefetch(&twice[places[i] / 64]);
        }
        for (size_t i = some; i < stop; i++) {
            bool is_kept = bit_get(twice, places[i]);
            *kept = (uint32_t)i; // whose place is not needed again
            kept += is_kept;
        }
    }
    bloom->counts[begin / SPHERE_RUN] = (uint32_t)(kept - &places[begin]);
}

static size_t bloom_runs(const Coincidences *search)
{
    return (search->planes + SPHERE_RUN - 1) / SPHERE_RUN;
}

// Shapes that are round in another way are looked up, so that their equals must be in the table.
static void bloom_others(const BloomFilter *bloom)
{
    const Coincidences *search = bloom->search;
    for (size_t item = search->planes; item < search->end; item++) {
        Key key = item_key(search, item);
        if (key.kind == KIND_SPHERE_KEY) {
            bit_set(bloom->twice, key_hash(&key) & bloom->mask, false);
        }
    }
}

static void bloom_fini(BloomFilter *bloom)
{
    pages_give(&bloom->pages);
    free(bloom->counts);
}

// False when out of memory; fini is to be called anyway. *count: the spheres that are to be looked up.
static bool bloom_init(BloomFilter *bloom, const Coincidences *search, int threads, size_t *count)
{
    size_t spheres = search->planes, bits = 64;
    while (bits < BITS_PER_SPHERE * spheres && bits < (size_t)UINT32_MAX + 1) {
        bits *= 2;
    }
    *bloom = (BloomFilter){.search = search, .mask = (uint32_t)(bits - 1), .is_shared = threads > 1};
    bloom->counts = malloc(bloom_runs(search) * sizeof *bloom->counts);
    if (!bloom->counts || !pages_take(&bloom->pages, bits / 4 + spheres * sizeof *bloom->places)) {
        return false;
    }
    bloom->once = bloom->pages.memory;
    bloom->twice = bloom->once + bits / 64;
    bloom->places = (uint32_t *)(bloom->twice + bits / 64);
    memset(bloom->once, 0, bits / 4);
    parallel_share(threads, spheres, SPHERE_RUN, bloom_run, bloom);
    bloom_others(bloom);
    parallel_share(threads, spheres, SPHERE_RUN, gather_run, bloom);
    *count = 0;
    for (size_t run = 0; run < bloom_runs(search); run++) {
        *count += bloom->counts[run];
    }
    return true;
}

// ---- the whole

static bool table_init(Coincidences *search, size_t items)
{
    size_t slots = 4;
    while (slots < 2 * items) {
        slots *= 2;
    }
    search->mask = (uint32_t)(slots - 1);
    search->slots = cleared_new(slots, sizeof *search->slots);
    return search->slots != NULL;
}

// `items`: numbers of shapes in their order; NULL: those from `begin` on.
static void visit_some(const Coincidences *search, const uint32_t *items, size_t begin, size_t count, DiagSink *diags)
{
    for (size_t done = 0; done < count; done += AHEAD) {
        uint32_t hashes[AHEAD];
        size_t some = count - done < AHEAD ? count - done : AHEAD;
        for (size_t i = 0; i < some; i++) {
            hashes[i] = item_hash(search, items ? items[done + i] : begin + done + i);
            __builtin_prefetch(&search->slots[hashes[i] & search->mask], 1);
        }
        for (size_t i = 0; i < some; i++) {
            size_t item = items ? items[done + i] : begin + done + i;
            if (item_is_alone(search, item)) {
                visit(search, item, hashes[i], diags);
            }
        }
    }
}

// False when out of memory.
static bool visit_many_spheres(Coincidences *search, DiagSink *diags, int threads)
{
    BloomFilter bloom;
    size_t count, others = search->end - search->planes + search->scene->composites.count;
    bool done = bloom_init(&bloom, search, threads, &count) && table_init(search, count + others);
    for (size_t run = 0; done && run < bloom_runs(search); run++) {
        visit_some(search, &bloom.places[run * SPHERE_RUN], 0, bloom.counts[run], diags);
    }
    bloom_fini(&bloom);
    return done;
}

bool scene_warn_of_coincident(const Scene *scene, DiagSink *diags, int threads)
{
    Coincidences search = {.scene = scene, .planes = scene->spheres.count};
    search.parts = search.planes + scene->planes.count;
    search.end = search.parts + scene->primitives.count;
    if (search.end < 2 || search.end >= UINT32_MAX / 4 || !diag_is_on(diags, DIAG_W0444)) {
        return true;
    }
    bool are_many = search.planes > SPHERE_RUN;
    if (!(are_many ? visit_many_spheres(&search, diags, threads)
                   : table_init(&search, search.end + scene->composites.count))) {
        free(search.slots);
        return false;
    }
    size_t begin = are_many ? search.planes : 0;
    visit_some(&search, NULL, begin, search.end - begin, diags);
    for (uint32_t i = 0; i < scene->composites.count; i++) {
        const Composite *composite = &scene->composites.items[i];
        visit_composite(&search, i, diags);
        for (uint32_t k = 0; k < composite->primitive_count; k++) {
            visit_leaf(&search, composite, composite->first_primitive + k, diags);
        }
    }
    free(search.slots);
    return true;
}
