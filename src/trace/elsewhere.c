// Spheres of which this process has a part: see elsewhere.h.
//
// A thread's questions and their answers are its own, in a table by hash, as are the slots in which the spheres that it
// has met stand: so shading finds them as it finds any. A question is put to the own spheres when it comes up; only
// what these leave open is asked of others.
//
// SPDX-License-Identifier: MIT
#include "trace/elsewhere.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "base/pages.h"
#include "trace/geometry.h"

enum {
    ASKER_SLOTS = 1 << 17, // spheres that the rays of one tile may have met
    ASKERS_BESIDE = 2,     // threads that ask and trace nothing
    TABLE_LEAST = 1 << 12,
};

// A limit is wider than the root that it is made of, which may be rounded.
#define LIMIT_SLACK 0x1p-30

typedef struct Asked {
    SphereQuestion question;
    SphereAnswer answer; // of the own spheres, until it is known
    uint32_t slot;       // where the sphere stands; SLOT_NONE: nowhere yet
    bool is_known;
} Asked;

// What a thread has asked.
typedef struct Asker {
    ARRAY(Asked) asked;
    ARRAY(uint32_t) open;            // those that are not known, …
    ARRAY(SphereQuestion) questions; // … as others are asked
    uint32_t *table;                 // numbers of `asked` + 1; 0: empty
    uint32_t mask;
    uint32_t number, first, slots; // its own, the first of its slots, and how many hold something
    bool failed;
    atomic_bool is_taken; // by a thread
} Asker;

struct Elsewhere {
    SphereTable own;
    const SphereKernels *real;
    SphereKernels kernels;         // that ask
    const Material *own_materials; // the scene's
    Material *materials;           // of planes, then of the slots
    Pages material_pages;
    uint32_t plane_count;
    pthread_key_t key; // of a thread's Asker
    bool has_key;
    uint32_t askers_most;
    Asker *askers;
};

// When its thread ends.
static void asker_release(void *asker)
{
    atomic_store(&((Asker *)asker)->is_taken, false);
}

static Asker *asker_get(Elsewhere *e)
{
    Asker *asker = pthread_getspecific(e->key);
    if (asker) {
        return asker;
    }
    for (uint32_t i = 0; i < e->askers_most; i++) {
        bool is_free = false;
        if (atomic_compare_exchange_strong(&e->askers[i].is_taken, &is_free, true)) {
            asker = &e->askers[i];
            break;
        }
    }
    return asker && pthread_setspecific(e->key, asker) == 0 ? asker : NULL;
}

// ---- what has been asked

static uint32_t question_hash(const SphereQuestion *question)
{
    uint64_t words[sizeof *question / sizeof(uint64_t)], hash = 0;
    memcpy(words, question, sizeof words);
    for (size_t i = 0; i < RT_COUNT_OF(words); i++) {
        hash = (hash ^ words[i]) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 29;
    }
    return (uint32_t)(hash >> 16);
}

static bool asker_grow(Asker *asker)
{
    uint32_t size = asker->table ? 2 * (asker->mask + 1) : TABLE_LEAST;
    uint32_t *table = calloc(size, sizeof *table);
    if (!table) {
        return false;
    }
    free(asker->table);
    asker->table = table;
    asker->mask = size - 1;
    for (size_t i = 0; i < asker->asked.count; i++) {
        uint32_t at = question_hash(&asker->asked.items[i].question) & asker->mask;
        while (table[at] != 0) {
            at = (at + 1) & asker->mask;
        }
        table[at] = (uint32_t)i + 1;
    }
    return true;
}

// The same question, asked before or now; NULL when out of memory.
static Asked *asker_find(Asker *asker, const SphereQuestion *question, bool *is_new)
{
    if ((!asker->table || 2 * asker->asked.count >= asker->mask) && !asker_grow(asker)) {
        return NULL;
    }
    uint32_t at = question_hash(question) & asker->mask;
    for (; asker->table[at] != 0; at = (at + 1) & asker->mask) {
        Asked *asked = &asker->asked.items[asker->table[at] - 1];
        if (memcmp(&asked->question, question, sizeof *question) == 0) {
            *is_new = false;
            return asked;
        }
    }
    Asked asked = {.question = *question, .slot = SLOT_NONE};
    if (!ARRAY_PUSH(&asker->asked, asked)) {
        return NULL;
    }
    asker->table[at] = (uint32_t)asker->asked.count;
    *is_new = true;
    return &asker->asked.items[asker->asked.count - 1];
}

// ---- answers of the own spheres

// The asker of the calling thread, which has a place of its own for the sphere that a ray starts on.
static void answer_one(const Elsewhere *e, const Asker *asker, const SphereQuestion *question, SphereAnswer *answer)
{
    SphereRay ray = sphere_ray_make(question->origin, question->direction);
    uint32_t start = SLOT_NONE;
    memset(answer, 0, sizeof *answer);
    answer->order = ANSWER_NOTHING;
    if (!e->own.blocks || !sphere_ray_is_usable(&ray)) {
        return;
    }
    if (!isnan(question->start.radius_squared)) {
        start = e->own.block_count * SPHERE_BLOCK + asker->number;
        SphereBlock *block = &e->own.blocks[start / SPHERE_BLOCK];
        block->x[start % SPHERE_BLOCK] = question->start.centre.x;
        block->y[start % SPHERE_BLOCK] = question->start.centre.y;
        block->z[start % SPHERE_BLOCK] = question->start.centre.z;
        block->radius_squared[start % SPHERE_BLOCK] = question->start.radius_squared;
    }
    if (question->is_shadow) {
        answer->order = e->real->occluded(&e->own, &ray, start, question->limit) ? 0 : ANSWER_NOTHING;
        return;
    }
    Nearest nearest = {{question->limit, SHAPE_NONE, false}, 0, false};
    e->real->closest(&e->own, &ray, start, &nearest);
    if (nearest.hit.shape != SHAPE_NONE) {
        uint32_t slot = shape_index(nearest.hit.shape);
        *answer = (SphereAnswer){.t = nearest.hit.t,
                                 .ball = sphere_table_ball(&e->own, slot),
                                 .material = e->own_materials[e->own.info[slot].material],
                                 .order = e->own.info[slot].order,
                                 .inside = nearest.hit.inside};
    }
}

bool geometry_answer(const Geometry *geometry, const SphereQuestion *questions, size_t count, SphereAnswer *answers)
{
    const Asker *asker = asker_get(geometry->elsewhere);
    for (size_t i = 0; asker && i < count; i++) {
        answer_one(geometry->elsewhere, asker, &questions[i], &answers[i]);
    }
    return asker != NULL;
}

// Both roots are refined: as nearest_offer_tie has it.
static bool answer_is_before(const SphereQuestion *question, const SphereAnswer *a, const SphereAnswer *b)
{
    if (a->order == ANSWER_NOTHING || b->order == ANSWER_NOTHING) {
        return b->order == ANSWER_NOTHING && a->order != ANSWER_NOTHING;
    }
    bool is_before = a->t < b->t;
    if (fabs(a->t - b->t) <= SPHERE_TIE * b->t || vec3_equal(a->ball.centre, b->ball.centre)) {
        SphereRay ray = sphere_ray_make(question->origin, question->direction);
        int order = sphere_roots_compare(&ray, &a->ball, a->inside, &b->ball, b->inside, a->t);
        is_before = order < 0 || (order == 0 && a->order < b->order);
    }
    return is_before;
}

// ---- the kernels that ask

// Puts a question to the own spheres, and on the list of what others are asked. NULL: out of memory.
static Asked *ask(Elsewhere *e, Asker *asker, const SphereQuestion *question)
{
    bool is_new;
    Asked *asked = asker_find(asker, question, &is_new);
    if (!asked || !is_new) {
        return asked;
    }
    SphereQuestion wider = *question;
    uint32_t number = (uint32_t)(asked - asker->asked.items);
    answer_one(e, asker, question, &asked->answer);
    if (question->is_shadow && asked->answer.order != ANSWER_NOTHING) {
        asked->is_known = true;
        return asked;
    }
    if (asked->answer.order != ANSWER_NOTHING) {
        wider.limit = fmin(wider.limit, asked->answer.t + LIMIT_SLACK * asked->answer.t);
    }
    return ARRAY_PUSH(&asker->open, number) && ARRAY_PUSH(&asker->questions, wider) ? asked : NULL;
}

// Where shading finds the sphere of an answer. False: no more have room.
static bool asked_place(Elsewhere *e, SphereTable *table, Asker *asker, Asked *asked)
{
    if (asked->slot != SLOT_NONE) {
        return true;
    }
    if (asker->slots == ASKER_SLOTS) {
        return false;
    }
    uint32_t slot = asker->first + asker->slots++, material = e->plane_count + slot;
    SphereBlock *block = &table->blocks[slot / SPHERE_BLOCK];
    block->x[slot % SPHERE_BLOCK] = asked->answer.ball.centre.x;
    block->y[slot % SPHERE_BLOCK] = asked->answer.ball.centre.y;
    block->z[slot % SPHERE_BLOCK] = asked->answer.ball.centre.z;
    block->radius_squared[slot % SPHERE_BLOCK] = asked->answer.ball.radius_squared;
    table->info[slot] = (ShapeInfo){material, asked->answer.order};
    e->materials[material] = asked->answer.material;
    asked->slot = slot;
    return true;
}

// The tables of a shared geometry are its threads' own where they change.
static Geometry *geometry_of(const SphereTable *table)
{
    return (Geometry *)((uintptr_t)table - offsetof(Geometry, spheres));
}

static SphereQuestion question_make(const SphereTable *table, const SphereRay *ray, uint32_t start, double limit)
{
    SphereQuestion question = {.origin = ray->origin, .direction = ray->direction, .limit = limit};
    question.start.radius_squared = (double)NAN;
    if (start != SLOT_NONE) {
        question.start = sphere_table_ball(table, start);
    }
    return question;
}

static void ask_closest(const SphereTable *table, const SphereRay *ray, uint32_t start, Nearest *nearest)
{
    Geometry *g = geometry_of(table);
    Asker *asker = asker_get(g->elsewhere);
    nearest_refine(table, ray, nearest);
    double limit = nearest->hit.shape == SHAPE_NONE ? nearest->hit.t : nearest->hit.t + LIMIT_SLACK * nearest->hit.t;
    SphereQuestion question = question_make(table, ray, start, limit);
    Asked *asked = asker ? ask(g->elsewhere, asker, &question) : NULL;
    bool is_met = asked && asked->is_known && asked->answer.order != ANSWER_NOTHING;
    if (asker && (!asked || (is_met && !asked_place(g->elsewhere, &g->spheres, asker, asked)))) {
        asker->failed = true;
        return;
    }
    if (is_met) {
        const SphereAnswer *answer = &asked->answer;
        const SphereRoot root = {asked->slot, answer->ball, answer->t, answer->inside, false};
        nearest_offer_tie(table, ray, &root, nearest);
    }
}

static bool ask_occluded(const SphereTable *table, const SphereRay *ray, uint32_t start, double t_max)
{
    Geometry *g = geometry_of(table);
    Asker *asker = asker_get(g->elsewhere);
    SphereQuestion question = question_make(table, ray, start, t_max);
    question.is_shadow = 1;
    Asked *asked = asker ? ask(g->elsewhere, asker, &question) : NULL;
    if (asker && !asked) {
        asker->failed = true;
    }
    return !asked || !asked->is_known || asked->answer.order != ANSWER_NOTHING;
}

static bool ask_closest_tile(const SphereTable *table, const SphereTile *tile, TileHits *hits)
{
    (void)table, (void)tile, (void)hits;
    return false;
}

static uint64_t ask_occluded_surfaces(const SphereTable *table, const TileSurfaces *from, const SurfaceRays *rays,
                                      uint64_t asked, uint64_t *left)
{
    (void)table, (void)from, (void)rays;
    *left = asked;
    return 0;
}

static bool ask_view_passes(const SphereTable *table, const TileView *view, const double u[TILE_RAYS],
                            const double v[TILE_RAYS])
{
    (void)table, (void)view, (void)u, (void)v;
    return false;
}

// ---- what a thread asks others

size_t geometry_questions(const Geometry *geometry, const SphereQuestion **questions)
{
    const Asker *asker = asker_get(geometry->elsewhere);
    *questions = asker ? asker->questions.items : NULL;
    return asker ? asker->questions.count : 0;
}

void geometry_learn(const Geometry *geometry, const SphereAnswer *answers, size_t lists)
{
    Asker *asker = asker_get(geometry->elsewhere);
    for (size_t i = 0; i < asker->open.count; i++) {
        Asked *asked = &asker->asked.items[asker->open.items[i]];
        for (size_t list = 0; list < lists; list++) {
            const SphereAnswer *answer = &answers[list * asker->open.count + i];
            bool is_one = asked->question.is_shadow ? answer->order != ANSWER_NOTHING
                                                    : answer_is_before(&asked->question, answer, &asked->answer);
            asked->answer = is_one ? *answer : asked->answer;
        }
        asked->is_known = true;
    }
    asker->open.count = asker->questions.count = 0;
}

bool geometry_forget(const Geometry *geometry)
{
    Asker *asker = asker_get(geometry->elsewhere);
    bool was_fine = asker && !asker->failed;
    if (asker) {
        asker->asked.count = asker->open.count = asker->questions.count = 0;
        asker->slots = 0;
        asker->failed = false;
        if (asker->table) {
            memset(asker->table, 0, ((size_t)asker->mask + 1) * sizeof *asker->table);
        }
    }
    return was_fine;
}

// ---- the whole

const Material *geometry_materials(const Geometry *geometry)
{
    return geometry->elsewhere ? geometry->elsewhere->materials : NULL;
}

static void kernels_ask(Elsewhere *e)
{
    e->kernels = *e->real;
    e->kernels.closest = ask_closest;
    e->kernels.occluded = ask_occluded;
    e->kernels.closest_tile = ask_closest_tile;
    e->kernels.occluded_surfaces = ask_occluded_surfaces;
    e->kernels.view_passes = ask_view_passes;
}

// The table that rays meet: slots for each thread, more than are few, and loose ones so many that none is tested here.
static bool table_share(Geometry *geometry, Elsewhere *e)
{
    SphereTable *table = &geometry->spheres;
    size_t slots = (size_t)e->askers_most * ASKER_SLOTS;
    e->own = *table;
    *table = (SphereTable){.block_count = (uint32_t)(slots / SPHERE_BLOCK),
                           .loose_count = SPHERES_FEW_MOST,
                           .count = SPHERES_FEW_MOST + 1};
    if (!pages_take(&table->block_pages, slots * sizeof(SphereBlock) / SPHERE_BLOCK) ||
        !pages_take(&table->info_pages, slots * sizeof *table->info) ||
        !pages_take(&e->material_pages, (slots + e->plane_count) * sizeof *e->materials)) {
        return false;
    }
    table->blocks = table->block_pages.memory;
    table->info = table->info_pages.memory;
    e->materials = e->material_pages.memory;
    return true;
}

size_t geometry_share_blocks(int threads)
{
    return ((size_t)threads + ASKERS_BESIDE + SPHERE_BLOCK - 1) / SPHERE_BLOCK;
}

size_t geometry_share_bytes(int threads)
{
    return ((size_t)threads + ASKERS_BESIDE) * ASKER_SLOTS *
           (sizeof(SphereBlock) / SPHERE_BLOCK + sizeof(ShapeInfo) + sizeof(Material));
}

bool geometry_share(Geometry *geometry, const Scene *scene, int threads)
{
    Elsewhere *e = calloc(1, sizeof *e);
    if (!e) {
        return false;
    }
    geometry->elsewhere = e;
    e->has_key = pthread_key_create(&e->key, asker_release) == 0;
    e->askers_most = (uint32_t)threads + ASKERS_BESIDE;
    e->askers = calloc(e->askers_most, sizeof *e->askers);
    e->plane_count = geometry->plane_count;
    e->own_materials = scene->materials.items;
    if (!e->has_key || !e->askers || !table_share(geometry, e)) {
        return false;
    }
    for (uint32_t i = 0; i < e->askers_most; i++) {
        e->askers[i].number = i;
        e->askers[i].first = i * ASKER_SLOTS;
    }
    for (uint32_t i = 0; i < e->plane_count; i++) {
        e->materials[i] = e->own_materials[geometry->planes[i].info.material];
        geometry->planes[i].info.material = i;
    }
    e->real = geometry->kernels;
    kernels_ask(e);
    geometry->kernels = &e->kernels;
    geometry->features = (geometry->features & ~(unsigned)TRACE_SPHERES) | TRACE_SPHERE_BVH;
    return true;
}

void elsewhere_free(Elsewhere *e)
{
    if (!e) {
        return;
    }
    for (uint32_t i = 0; e->askers && i < e->askers_most; i++) {
        ARRAY_FREE(&e->askers[i].asked);
        ARRAY_FREE(&e->askers[i].open);
        ARRAY_FREE(&e->askers[i].questions);
        free(e->askers[i].table);
    }
    free(e->askers);
    pages_give(&e->material_pages);
    sphere_table_fini(&e->own);
    if (e->has_key) {
        pthread_key_delete(e->key);
    }
    free(e);
}
