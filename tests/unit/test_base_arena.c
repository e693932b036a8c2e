// Tests of base/arena.h and base/array.h: alignment, marks, budgets, growth, overflow.
//
// SPDX-License-Identifier: MIT
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/array.h"
#include "base/hidden.h"
#include "base/pages.h"
#include "unit/tap.h"

enum { KIB = 1024, PIECES = 2000 };

static void test_pieces_are_apart(void)
{
    static unsigned char *pieces[PIECES];
    Arena arena;
    bool is_aligned = true, is_intact = true;
    arena_init(&arena, SIZE_MAX);
    for (size_t i = 0; i < PIECES; i++) {
        pieces[i] = arena_alloc(&arena, i);
        is_aligned = is_aligned && pieces[i] && (uintptr_t)pieces[i] % 16 == 0;
        if (pieces[i]) {
            memset(pieces[i], (int)(i % 251), i);
        }
    }
    for (size_t i = 0; i < PIECES; i++) {
        for (size_t k = 0; k < i; k++) {
            is_intact = is_intact && pieces[i][k] == i % 251;
        }
    }
    tap_ok(is_aligned, "every piece is aligned to 16, even an empty one");
    tap_ok(is_intact, "pieces do not overlap");
    tap_ok(arena.bytes_reserved >= (size_t)PIECES * (PIECES - 1) / 2, "reserved bytes cover what was handed out");
    arena_fini(&arena);
    tap_ok(arena.bytes_reserved == 0 && !arena.chunk, "fini gives all back");
    tap_ok(arena_alloc(&arena, 1) != NULL, "the arena is usable after fini");
    arena_fini(&arena);
}

static void test_growth(void)
{
    Arena arena;
    size_t chunks = 0, last = 0;
    bool is_bounded = true;
    arena_init(&arena, SIZE_MAX);
    for (size_t i = 0; i < 400 * 1000; i++) { // 400 MB, never touched
        if (!arena_alloc(&arena, 1000)) {
            break;
        }
        if (arena.bytes_reserved != last) {
            size_t chunk = arena.bytes_reserved - last;
            is_bounded = is_bounded && chunk >= (size_t)64 * KIB && chunk <= (size_t)64 * KIB * KIB;
            last = arena.bytes_reserved;
            chunks++;
        }
    }
    tap_ok(is_bounded, "chunks are of 64 KiB to 64 MiB");
    tap_ok(chunks > 5 && chunks < 25, "chunks grow geometrically: %zu for 400 MB", chunks);
    void *large = arena_alloc(&arena, (size_t)100 * KIB * KIB);
    tap_ok(large && arena.bytes_reserved - last < (size_t)101 * KIB * KIB, "a piece beyond 64 MiB has its own chunk");
    arena_fini(&arena);
}

static void test_budget(void)
{
    Arena arena;
    size_t budget = (size_t)300 * KIB, handed = 0;
    arena_init(&arena, budget);
    tap_ok(!arena_alloc(&arena, budget), "a piece as great as the budget leaves no room for the header");
    tap_ok(!arena_alloc(&arena, SIZE_MAX) && !arena_alloc(&arena, SIZE_MAX - 40), "absurd sizes are refused");
    tap_ok(!arena_alloc_array(&arena, SIZE_MAX / 4, 8), "a product that overflows is refused");
    tap_ok(!arena_copy_text(&arena, "", SIZE_MAX), "a text without room for its zero is refused");
    while (arena_alloc(&arena, 1000)) {
        handed += 1008;
    }
    tap_ok(arena.bytes_reserved <= budget, "the budget is never exceeded");
    tap_ok(handed > budget * 9 / 10, "nearly all of the budget can be used: %zu of %zu", handed, budget);
    arena_rewind(&arena, (ArenaMark){0});
    tap_ok(arena_alloc(&arena, 1000) != NULL, "after a failure and a rewind it works again");
    arena_fini(&arena);
    arena_init(&arena, 0);
    tap_ok(!arena_alloc(&arena, 1), "a budget of 0 gives nothing");
    arena_fini(&arena);
}

static void test_shared_budget(void)
{
    MemoryBudget budget = {.limit = (size_t)300 * KIB};
    Arena first, second;
    arena_init_shared(&first, &budget);
    arena_init_shared(&second, &budget);
    tap_ok(arena_alloc(&first, (size_t)150 * KIB) && budget.used == first.bytes_reserved, "a shared budget counts");
    tap_ok(!arena_alloc(&second, (size_t)200 * KIB) && budget.refused, "what the other arena took is not there");
    arena_fini(&first);
    tap_ok(budget.used == 0 && arena_alloc(&second, (size_t)200 * KIB), "what it gives back is");
    arena_fini(&second);
    tap_ok(budget.used == 0 && second.shared == &budget, "a finished arena keeps its share");
}

static void test_copies(void)
{
    Arena arena;
    arena_init(&arena, SIZE_MAX);
    char *text = arena_copy_text(&arena, "sphere", 3);
    int *numbers = arena_copy(&arena, (int[]){1, 2, 3}, sizeof(int[3]));
    tap_ok(text && strcmp(text, "sph") == 0, "copy_text ends with a zero");
    tap_ok(numbers && numbers[0] == 1 && numbers[2] == 3, "copy copies");
    tap_ok(arena_copy(&arena, NULL, 0) != NULL, "a copy of nothing is not a failure");
    arena_fini(&arena);
}

// A loop of mark and rewind must reach a state in which it takes nothing from the system and moves no more.
static void test_mark_and_rewind(size_t before, size_t inside)
{
    Arena arena;
    arena_init(&arena, SIZE_MAX);
    char *kept = before ? arena_alloc(&arena, before) : NULL;
    if (kept) {
        memset(kept, 'k', before);
    }
    ArenaMark mark = arena_mark(&arena);
    size_t settled = 0;
    bool is_steady = true;
    for (int turn = 0; turn < 30; turn++) {
        for (size_t i = 0; i < 10; i++) {
            void *piece = arena_alloc(&arena, inside);
            is_steady = is_steady && piece;
            if (piece) {
                memset(piece, 'x', inside);
            }
        }
        arena_rewind(&arena, mark);
        if (turn == 10) {
            settled = arena.bytes_reserved;
        }
        is_steady = is_steady && (turn < 10 || arena.bytes_reserved == settled);
    }
    bool is_intact = true;
    for (size_t i = 0; i < before; i++) {
        is_intact = is_intact && kept[i] == 'k';
    }
    tap_ok(is_steady, "a loop of mark and rewind settles (%zu before, %zu inside)", before, inside);
    tap_ok(is_intact, "what stood before the mark is untouched");
    arena_fini(&arena);
}

static void test_nested_marks(void)
{
    Arena arena;
    arena_init(&arena, SIZE_MAX);
    ArenaMark outer = arena_mark(&arena);
    char *first = arena_copy_text(&arena, "first", 5);
    ArenaMark inner = arena_mark(&arena);
    for (int i = 0; i < 100; i++) {
        if (!arena_alloc(&arena, (size_t)50 * KIB)) {
            tap_ok(false, "out of memory");
        }
    }
    arena_rewind(&arena, inner);
    size_t kept = arena.bytes_reserved;
    tap_ok(kept > (size_t)128 * KIB && arena_alloc(&arena, (size_t)512 * KIB) && arena.bytes_reserved == kept,
           "the greatest chunk is kept behind the mark");
    arena_rewind(&arena, inner);
    char *second = arena_copy_text(&arena, "second", 6);
    tap_ok(first && second && strcmp(first, "first") == 0 && second == first + 16,
           "an inner rewind keeps the outer part");
    arena_rewind(&arena, outer);
    size_t reserved = arena.bytes_reserved;
    tap_ok(reserved > 0 && arena_alloc(&arena, 100) && arena.bytes_reserved == reserved, "one chunk is kept for reuse");
    arena_fini(&arena);
}

static void test_array(void)
{
    ARRAY(double) numbers = {0};
    bool is_pushed = true, is_intact = true;
    for (int i = 0; i < 100000; i++) {
        is_pushed = is_pushed && ARRAY_PUSH(&numbers, i * 0.5);
    }
    for (size_t i = 0; i < numbers.count; i++) {
        is_intact = is_intact && numbers.items[i] == (double)i * 0.5;
    }
    tap_ok(is_pushed && is_intact && numbers.count == 100000, "pushed elements stand in order");
    double *items = numbers.items;
    size_t capacity = numbers.capacity;
    tap_ok(!ARRAY_RESERVE(&numbers, SIZE_MAX) && !ARRAY_RESERVE(&numbers, SIZE_MAX / 8 + 1), "overflow is refused");
    tap_ok(numbers.items == items && numbers.capacity == capacity, "a failure leaves the array unchanged");
    tap_ok(ARRAY_RESERVE(&numbers, 10) && numbers.capacity == capacity, "reserving less does nothing");
    ARRAY_FREE(&numbers);
    tap_ok(!numbers.items && numbers.count == 0 && numbers.capacity == 0, "free leaves an empty array");
    ARRAY(struct { char bytes[24]; }) records = {0};
    tap_ok(ARRAY_RESERVE(&records, 1) && records.capacity >= 1, "elements may be structs");
    ARRAY_FREE(&records);
}

// What is grown keeps what is in it, wherever it is moved to.
static void test_grow(size_t first)
{
    size_t count = first / sizeof(uint32_t), wrong = 0;
    uint32_t *numbers = pages_grow(NULL, 0, count * sizeof *numbers);
    for (size_t i = 0; numbers && i < count; i++) {
        numbers[i] = (uint32_t)i;
    }
    for (int turn = 0; numbers && turn < 3; turn++) {
        numbers = pages_grow(numbers, count * sizeof *numbers, 2 * count * sizeof *numbers);
        for (size_t i = 0; numbers && i < 2 * count; i++) {
            wrong += i < count && numbers[i] != (uint32_t)i;
            numbers[i] = (uint32_t)i;
        }
        count *= 2;
    }
    tap_ok(numbers && wrong == 0, "%zu bytes grow to %zu", first, count * sizeof *numbers);
    free(numbers);
}

static void test_pages(size_t bytes, size_t kept)
{
    Pages pages = {0};
    bool is_intact = true, is_taken = pages_take(&pages, bytes);
    tap_ok(is_taken && (uintptr_t)pages.memory % 64 == 0, "%zu bytes on a line of cache", bytes);
    if (is_taken) {
        memset(pages.memory, 7, bytes);
        pages_trim(&pages, kept);
    }
    for (size_t i = 0; is_taken && i < kept; i++) {
        is_intact = is_intact && ((unsigned char *)pages.memory)[i] == 7;
    }
    tap_ok(is_intact && pages.mapped <= kept + ((size_t)2 << 20) && (pages.mapped == 0 || pages.mapped >= kept),
           "%zu of them are kept", kept);
    pages_give(&pages);
    tap_ok(!pages.memory && pages.mapped == 0, "and given back");
    pages_give(&pages);
    tap_ok(!pages_take(&pages, SIZE_MAX) && !pages_take(&pages, SIZE_MAX / 2), "too many are refused");
}

#if HIDDEN_IS_ON
static bool is_hidden(const char *byte)
{
    return __asan_address_is_poisoned(byte);
}

static void test_hidden(void)
{
    Arena arena;
    arena_init(&arena, SIZE_MAX);
    char *first = arena_alloc(&arena, 24);
    ArenaMark mark = arena_mark(&arena);
    char *second = arena_alloc(&arena, 3), *third = arena_alloc(&arena, (size_t)300 * KIB);
    tap_ok(first && second && third && !is_hidden(first) && !is_hidden(first + 23) && !is_hidden(second) &&
               !is_hidden(second + 2) && !is_hidden(third + (size_t)300 * KIB - 1),
           "what is handed out is not hidden");
    tap_ok(is_hidden(first + 24) && is_hidden(second + 3), "what is between is");
    arena_rewind(&arena, mark);
    tap_ok(!is_hidden(first + 23) && is_hidden(second), "what is given back is");
    char *again = arena_alloc(&arena, 2);
    tap_ok(again == second && !is_hidden(again + 1) && is_hidden(again + 2), "until it is handed out again");
    arena_fini(&arena);
}
#endif

int main(void)
{
#if HIDDEN_IS_ON
    test_hidden();
#endif
    test_pieces_are_apart();
    test_growth();
    test_budget();
    test_shared_budget();
    test_copies();
    for (size_t before = 0; before <= (size_t)200 * KIB; before += (size_t)100 * KIB) {
        test_mark_and_rewind(before, 100);
        test_mark_and_rewind(before, (size_t)40 * KIB);
        test_mark_and_rewind(before, (size_t)700 * KIB);
    }
    test_nested_marks();
    test_array();
    static const size_t sizes[][2] = {{1, 1}, {100000, 100}, {5000001, 5000000}, {9000000, 4500000}, {20000000, 3}};
    for (size_t i = 0; i < RT_COUNT_OF(sizes); i++) {
        test_pages(sizes[i][0], sizes[i][1]);
    }
    test_grow(1000);
    test_grow(700000);
    test_grow(3000004);
    return tap_done();
}
