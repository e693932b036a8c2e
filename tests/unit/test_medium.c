// What rays are inside of: the lists that rays of a stack share hold what a copy for each ray would, and never more nodes
// than there is room for.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "render/sample/scratch.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { TURNS = 200000, BODIES = 80, LINES = 6 };

static MediumList copies[RAY_STACK_MAX]; // what the list of each waiting ray is to hold

static void list_cross(MediumList *list, uint64_t body)
{
    uint32_t place = list->count;
    while (place > 0 && list->regions[place - 1].body != body) {
        place--;
    }
    if (place > 0) {
        memmove(&list->regions[place - 1], &list->regions[place], (list->count - place) * sizeof list->regions[0]);
        list->count--;
    } else if (list->count < MEDIUM_DEPTH_MAX) {
        list->regions[list->count++] = (MediumRegion){body, (uint32_t)body, body % 7 == 0};
    }
}

static MediumStack table_cross(MediumTable *table, MediumStack stack, uint64_t body)
{
    return medium_leave(table, &stack, body)
               ? stack
               : medium_enter(table, stack, (MediumRegion){body, (uint32_t)body, body % 7 == 0});
}

static bool is_same(const MediumTable *table, MediumStack stack, const MediumList *list)
{
    bool is_solid = false;
    bool same = table->nodes[stack].depth == list->count;
    for (uint32_t i = 0; i < list->count; i++) {
        is_solid |= list->regions[i].is_solid;
    }
    same &= table->nodes[stack].is_in_solid == is_solid;
    for (uint32_t i = list->count; same && i > 0; i--, stack = table->nodes[stack].below) {
        same = stack != MEDIUM_EMPTY && table->nodes[stack].region.body == list->regions[i - 1].body;
    }
    return same && stack == MEDIUM_EMPTY;
}

// A shadow ray through many bodies, which leaves nothing behind.
static void shadow(MediumTable *table, MediumStack stack, Random *random)
{
    uint32_t kept = table->count;
    for (unsigned i = random_below(random, 40); i > 0; i--) {
        stack = medium_keep(table, kept, table_cross(table, stack, random_below(random, BODIES)));
    }
    table->count = kept;
}

// Paths like those of rays in a scene of bodies in each other: each turn one ray continues as none, one or more.
static void test_paths(Random *random, unsigned bodies)
{
    RenderScratch *scratch = scratch_new();
    RayStack *stack = &scratch->rays;
    int different = 0, deepest = 0;
    uint32_t most = 0;
    stack->count = 0;
    for (int turn = 0; turn < TURNS; turn++) {
        if (stack->count == 0) {
            copies[0].count = 0;
            StackedRay first = {.inside = medium_load(&stack->media, &copies[0])};
            ray_stack_push(RENDER_INTERIORS, stack, &first);
        }
        StackedRay ray;
        ray_stack_pop(RENDER_INTERIORS, stack, &ray);
        MediumList before = copies[stack->count], behind = before;
        different += !is_same(&stack->media, ray.inside, &before);
        uint64_t body = random_below(random, bodies);
        list_cross(&behind, body);
        MediumStack through = table_cross(&stack->media, ray.inside, body);
        shadow(&stack->media, ray.inside, random);
        different += !is_same(&stack->media, through, &behind);
        most = stack->media.count > most ? stack->media.count : most;
        // Seldom none, so that paths are long; as often two as the stack has room for.
        unsigned rays = random_below(random, 500) == 0 ? 0 : stack->count < RAY_STACK_MAX - 3 && turn % 3 == 0 ? 2 : 1;
        for (unsigned i = 0; i < rays; i++) {
            bool goes_through = random_below(random, 4) > 0;
            copies[stack->count] = goes_through ? behind : before;
            ray_stack_push(RENDER_INTERIORS, stack, &(StackedRay){.inside = goes_through ? through : ray.inside});
        }
        deepest = stack->count > deepest ? stack->count : deepest;
    }
    tap_ok(different == 0, "%u bodies: %d of %d lists are not those of a copy for each ray", bodies, different, 2 * TURNS);
    tap_ok(most + MEDIUM_NODES_EACH <= RAY_STACK_NODES, "%u bodies, %d rays: %u of %d nodes", bodies, deepest, most,
           RAY_STACK_NODES);
    tap_ok(deepest > 20, "%u bodies: rays waited, %d of them", bodies, deepest);
    scratch_free(scratch);
}

// One ray through a chain of bodies that reach into each other, as through a string of glass beads.
static void test_chain(void)
{
    RenderScratch *scratch = scratch_new();
    MediumTable *table = &scratch->rays.media;
    MediumStack stack = MEDIUM_EMPTY;
    uint32_t most = 0;
    int lost = 0;
    for (uint64_t i = 0; i < 1000000; i++) {
        stack = medium_enter(table, stack, (MediumRegion){i, RECORD_NONE, false});
        lost += i >= LINES && !medium_leave(table, &stack, i - LINES);
        most = table->count > most ? table->count : most;
        stack = medium_keep(table, MEDIUM_EMPTY + 1, stack);
    }
    tap_ok(lost == 0 && most <= 1 + MEDIUM_NODES_EACH, "a million bodies, %d at a time: %u nodes", LINES + 1, most);
    scratch_free(scratch);
}

int main(void)
{
    Random random = {random_seed(NULL)};
    test_paths(&random, 3);
    test_paths(&random, BODIES);
    test_chain();
    return tap_done();
}
