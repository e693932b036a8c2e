// Equal shapes: a hash table of all that stand alone, and of composites, finds those that coincide; what is cut in a
// composite is looked up among those that stand alone.
//
// A shape becomes a key, equal for equal surfaces, whichever list of the scene it stands in. The table holds hashes
// beside shape numbers, so that the scene's records are read in order but for those that are alike; its slots are asked
// for some shapes ahead, because waiting for memory is nearly all that this would do.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "base/parallel.h"
#include "scene/part.h"
#include "scene/range.h"

enum { AHEAD = 32, KEY_NUMBERS = 18, KIND_SPHERE_KEY = PART_SMOOTH_TRIANGLE + 1 };

// What makes a surface, -0 and 0 being one number.
typedef struct Key {
    uint32_t kind, count; // numbers that count
    double numbers[KEY_NUMBERS];
    uint64_t source;
    uint32_t order;
    uint8_t hidden;
} Key;

typedef struct Slot {
    _Alignas(8) uint32_t hash;
    uint32_t item; // number of the shape, or after all shapes of the composite, + 1; 0: empty
} Slot;

typedef struct Twins {
    const Scene *scene;
    size_t ellipsoids, planes, parts, end; // numbers of the first ones; spheres begin at 0
    Slot *slots;
    uint32_t mask;
} Twins;

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
    key->kind = PART_PLANE;
    key_add(key, first < 0.0 ? vec3_neg(normal) : normal);
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
    const double(*r)[3] = m->m;
    bool is_round = r[0][1] == 0.0 && r[0][2] == 0.0 && r[1][0] == 0.0 && r[1][2] == 0.0 && r[2][0] == 0.0 &&
                    r[2][1] == 0.0 && fabs(r[0][0]) == fabs(r[1][1]) && fabs(r[1][1]) == fabs(r[2][2]);
    if (is_round) {
        key_sphere(key, vec3(r[3][0], r[3][1], r[3][2]), fabs(r[0][0]));
    } else {
        key->kind = PART_BALL;
        key_transform(key, m);
    }
}

static void key_part(Key *key, const Part *part)
{
    switch (part->kind) {
    case PART_PLANE:
        key_plane(key, part->data[0], part->data[1].x);
        break;
    case PART_BALL:
        key_ball(key, &part->to_world);
        break;
    default:
        key->kind = part->kind == PART_SMOOTH_TRIANGLE ? PART_TRIANGLE : part->kind;
        key_transform(key, &part->to_world);
        if (key->kind != PART_TRIANGLE) {
            key_add(key, part->data[0]);
            key_add(key, part->data[1]);
        }
    }
}

static Key item_key(const Twins *twins, size_t item)
{
    const Scene *scene = twins->scene;
    Key key;
    key.count = 0;
    key.hidden = 0;
    if (item < twins->ellipsoids) {
        const Sphere *sphere = &scene->spheres.items[item];
        key.source = scene_sphere_source(scene, item);
        key.order = scene_sphere_order(scene, item);
        key_sphere(&key, sphere->centre, sphere->radius);
    } else if (item < twins->planes) {
        const Ellipsoid *ellipsoid = &scene->ellipsoids.items[item - twins->ellipsoids];
        key.source = ellipsoid->source;
        key.order = ellipsoid->order;
        key_ball(&key, &ellipsoid->to_world);
    } else if (item < twins->parts) {
        const Plane *plane = &scene->planes.items[item - twins->planes];
        key.source = plane->source;
        key.order = plane->order;
        key_plane(&key, plane->normal, plane->distance);
    } else {
        const Part *part = &scene->parts.items[item - twins->parts];
        key.source = part->source;
        key.order = part->order;
        key.hidden = part->hidden;
        key_part(&key, part);
    }
    return key;
}

static bool item_is_alone(const Twins *twins, size_t item)
{
    return item < twins->parts || twins->scene->parts.items[item - twins->parts].node == NODE_NONE;
}

// As in scene/unique.c, eight bytes at a time.
static inline uint64_t hash_add(uint64_t hash, double number)
{
    uint64_t word;
    memcpy(&word, &number, sizeof word);
    hash = (hash ^ word) * UINT64_C(0xff51afd7ed558ccd);
    return hash ^ hash >> 33;
}

static uint32_t key_hash(const Key *key)
{
    uint64_t hash = key->kind;
    for (uint32_t i = 0; i < key->count; i++) {
        hash = hash_add(hash, key->numbers[i]);
    }
    return (uint32_t)hash;
}

// The same of a sphere's key, which is what nearly all keys are.
static inline uint32_t sphere_hash(const Sphere *sphere)
{
    uint64_t hash = hash_add(KIND_SPHERE_KEY, sphere->centre.x + 0.0);
    hash = hash_add(hash, sphere->centre.y + 0.0);
    hash = hash_add(hash, sphere->centre.z + 0.0);
    return (uint32_t)hash_add(hash, sphere->radius);
}

// Of the shapes from begin to end, whose slots are asked for.
static void hash_some(const Twins *twins, size_t begin, size_t end, uint32_t *hashes)
{
    for (size_t item = begin; item < end; item++) {
        if (item < twins->ellipsoids) {
            hashes[item - begin] = sphere_hash(&twins->scene->spheres.items[item]);
        } else {
            Key key = item_key(twins, item);
            hashes[item - begin] = key_hash(&key);
        }
        __builtin_prefetch(&twins->slots[hashes[item - begin] & twins->mask], 1);
    }
}

static bool keys_are_equal(const Key *a, const Key *b)
{
    return a->kind == b->kind && a->count == b->count &&
           memcmp(a->numbers, b->numbers, a->count * sizeof a->numbers[0]) == 0;
}

bool scene_parts_are_twins(const Part *a, const Part *b)
{
    Key one, other;
    one.count = other.count = 0;
    key_part(&one, a);
    key_part(&other, b);
    return keys_are_equal(&one, &other);
}

static void tell(const Key *one, const Key *other, DiagSink *diags)
{
    const Key *first = one->order < other->order ? one : other, *second = first == one ? other : one;
    const char *word = one->kind == KIND_SPHERE_KEY ? "sphere"
                       : one->kind == PART_BALL     ? "stretched sphere"
                                                    : part_word((PartKind)one->kind);
    if (diag_report(diags, DIAG_W0444, scene_source_span(second->source),
                    "this %s coincides with one that was declared before it", word) &&
        first->source) {
        diag_note(diags, scene_source_span(first->source), "this one is seen, the other is not");
    }
}

// Whether they are one surface to some rays; tells of it.
static bool are_twins(const Key *one, const Key *other, DiagSink *diags)
{
    if (!hidden_meet(one->hidden, other->hidden) || !keys_are_equal(one, other)) {
        return false;
    }
    tell(one, other, diags);
    return true;
}

// ---- composites: equal when their trees are, leaf by leaf

static uint32_t composite_hash(const Twins *twins, const Composite *composite)
{
    uint32_t hash = composite->node_count;
    for (uint32_t i = 0; i < composite->part_count; i++) {
        Key key = item_key(twins, twins->parts + composite->first_part + i);
        hash = (hash ^ key_hash(&key)) * UINT32_C(0x9e3779b1);
    }
    return hash;
}

// A place in the tree, counted from its root.
static uint32_t below(uint32_t node, const Composite *composite)
{
    return node == NODE_NONE ? NODE_NONE : node - composite->first_node;
}

static bool composites_are_equal(const Twins *twins, const Composite *a, const Composite *b)
{
    const Scene *scene = twins->scene;
    bool equal = a->node_count == b->node_count && a->part_count == b->part_count;
    for (uint32_t i = 0; equal && i < a->node_count; i++) {
        const Node *one = &scene->nodes.items[a->first_node + i], *other = &scene->nodes.items[b->first_node + i];
        equal = one->op == other->op && one->is_inverse == other->is_inverse &&
                one->child_count == other->child_count && below(one->parent, a) == below(other->parent, b);
    }
    for (uint32_t i = 0; equal && i < a->part_count; i++) {
        const Part *one = &scene->parts.items[a->first_part + i], *other = &scene->parts.items[b->first_part + i];
        Key key = item_key(twins, twins->parts + a->first_part + i);
        Key known = item_key(twins, twins->parts + b->first_part + i);
        bool is_same_side = one->kind != PART_PLANE || vec3_equal(one->data[0], other->data[0]);
        equal = keys_are_equal(&key, &known) && is_same_side && one->flags == other->flags &&
                below(one->node, a) == below(other->node, b);
    }
    return equal;
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

static void visit_composite(const Twins *twins, uint32_t number, DiagSink *diags)
{
    const Composite *composites = twins->scene->composites.items;
    uint32_t hash = composite_hash(twins, &composites[number]);
    for (uint32_t at = hash & twins->mask;; at = (at + 1) & twins->mask) {
        Slot *slot = &twins->slots[at];
        if (slot->item == 0) {
            *slot = (Slot){hash, (uint32_t)twins->end + number + 1};
            return;
        }
        if (slot->hash == hash && slot->item > twins->end) {
            const Composite *known = &composites[slot->item - 1 - twins->end];
            if (composites_are_equal(twins, &composites[number], known)) {
                tell_composite(&composites[number], known, diags);
                return;
            }
        }
    }
}

// ---- shapes that stand alone beside the same ones in composites

// Whether the outside of a leaf is outside of its composite, too, so that where it is not cut away both are seen.
static bool is_outer(const Scene *scene, const Part *part)
{
    bool flips = (part->flags & PART_INVERSE) != 0;
    for (uint32_t node = part->node; node != NODE_NONE; node = scene->nodes.items[node].parent) {
        flips ^= scene->nodes.items[node].is_inverse;
    }
    return !flips && !(part->flags & PART_UNSEEN);
}

// Leaves are not compared with each other: two halves of a sphere have it in common, and no surface.
static void visit_leaf(const Twins *twins, const Composite *composite, uint32_t number, DiagSink *diags)
{
    const Part *part = &twins->scene->parts.items[number];
    if (part->kind == PART_PLANE || !is_outer(twins->scene, part)) {
        return;
    }
    Key key = item_key(twins, twins->parts + number);
    uint32_t hash = key_hash(&key);
    key.hidden = composite->hidden;
    for (uint32_t at = hash & twins->mask; twins->slots[at].item != 0; at = (at + 1) & twins->mask) {
        const Slot *slot = &twins->slots[at];
        if (slot->hash == hash && slot->item <= twins->end) {
            Key known = item_key(twins, slot->item - 1);
            if (are_twins(&key, &known, diags)) {
                return;
            }
        }
    }
}

// ---- all of them

// Looks one shape up, and puts it in where its equal was not.
static void visit(const Twins *twins, size_t item, uint32_t hash, DiagSink *diags)
{
    for (uint32_t at = hash & twins->mask;; at = (at + 1) & twins->mask) {
        Slot *slot = &twins->slots[at];
        if (slot->item == 0) {
            *slot = (Slot){hash, (uint32_t)item + 1};
            return;
        }
        if (slot->hash != hash || slot->item > twins->end) {
            continue;
        }
        Key key = item_key(twins, item), known = item_key(twins, slot->item - 1);
        if (are_twins(&key, &known, diags)) {
            return;
        }
    }
}

// Many spheres on several threads: all are put in, in any order, for it hardly ever happens that two are equal.
typedef struct Crowd {
    const Twins *twins;
    atomic_bool has_twins;
} Crowd;

// False when its equal is there.
static bool put_in(const Twins *twins, size_t item, uint32_t hash)
{
    Slot wanted = {hash, (uint32_t)item + 1};
    for (uint32_t at = hash & twins->mask;; at = (at + 1) & twins->mask) {
        Slot known = {0};
        if (__atomic_compare_exchange(&twins->slots[at], &known, &wanted, false, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
            return true;
        }
        if (known.hash == hash) {
            Key key = item_key(twins, item), other = item_key(twins, known.item - 1);
            if (keys_are_equal(&key, &other)) {
                return false;
            }
        }
    }
}

static void put_in_run(void *client, size_t begin, size_t end)
{
    Crowd *crowd = client;
    for (; begin < end && !atomic_load(&crowd->has_twins); begin += AHEAD) {
        uint32_t hashes[AHEAD];
        size_t stop = begin + AHEAD < end ? begin + AHEAD : end;
        hash_some(crowd->twins, begin, stop, hashes);
        for (size_t item = begin; item < stop; item++) {
            if (!put_in(crowd->twins, item, hashes[item - begin])) {
                atomic_store(&crowd->has_twins, true);
                return;
            }
        }
    }
}

// How many of the first shapes are in the table, without an equal: none or all of the spheres.
static size_t put_in_spheres(const Twins *twins, int threads)
{
    Crowd crowd = {.twins = twins};
    if (threads < 2 || twins->ellipsoids <= SPHERE_RUN) {
        return 0;
    }
    parallel_share(threads, twins->ellipsoids, SPHERE_RUN, put_in_run, &crowd);
    if (atomic_load(&crowd.has_twins)) {
        memset(twins->slots, 0, ((size_t)twins->mask + 1) * sizeof *twins->slots);
        return 0;
    }
    return twins->ellipsoids;
}

bool scene_warn_of_twins(const Scene *scene, DiagSink *diags, int threads)
{
    Twins twins = {.scene = scene, .ellipsoids = scene->spheres.count};
    twins.planes = twins.ellipsoids + scene->ellipsoids.count;
    twins.parts = twins.planes + scene->planes.count;
    twins.end = twins.parts + scene->parts.count;
    if (twins.end < 2 || twins.end >= UINT32_MAX / 4 || !diag_is_on(diags, DIAG_W0444)) {
        return true;
    }
    uint32_t slots = 4;
    while (slots < 2 * (twins.end + scene->composites.count)) {
        slots *= 2;
    }
    twins.mask = slots - 1;
    twins.slots = calloc(slots, sizeof *twins.slots);
    pages_prefer_huge(twins.slots, slots * sizeof *twins.slots);
    if (!twins.slots) {
        return false;
    }
    for (size_t begin = put_in_spheres(&twins, threads); begin < twins.end; begin += AHEAD) {
        uint32_t hashes[AHEAD];
        size_t end = begin + AHEAD < twins.end ? begin + AHEAD : twins.end;
        hash_some(&twins, begin, end, hashes);
        for (size_t item = begin; item < end; item++) {
            if (item_is_alone(&twins, item)) {
                visit(&twins, item, hashes[item - begin], diags);
            }
        }
    }
    for (uint32_t i = 0; i < scene->composites.count; i++) {
        const Composite *composite = &scene->composites.items[i];
        visit_composite(&twins, i, diags);
        for (uint32_t k = 0; k < composite->part_count; k++) {
            visit_leaf(&twins, composite, composite->first_part + k, diags);
        }
    }
    free(twins.slots);
    return true;
}
