// Tiles dealt over ranks: see ranks.h.
//
// A rank asks for tiles before those that it has are done, so that a thread seldom waits; the fewer are left, the fewer
// it gets at once. A pass ends when rank 0 has all tiles: it says so, hears from each rank that nothing more comes of
// it, and then, unless the pass is the picture's last, gives all what all have left.
//
// SPDX-License-Identifier: MIT
#include "share/ranks.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

// The first byte of a message. From rank 0: TILES, END and OVER; to it: ASK, RESULT, STOP and BYE. Between any two,
// where each has a part of the scene: QUESTION and ANSWER.
typedef enum Word {
    WORD_ASK,
    WORD_TILES,
    WORD_RESULT,
    WORD_STOP,
    WORD_END,
    WORD_BYE,
    WORD_OVER,
    WORD_QUESTION,
    WORD_ANSWER
} Word;

enum {
    TILES_AT_ONCE = 32,
    ROUNDS = 8,               // in about so many askings of each rank a pass is dealt
    IDLE_NANOSECONDS = 50000, // between looks for messages; twice as long after each in vain, …
    IDLE_DOUBLINGS = 4,       // … so often
    NUMBER = sizeof(int32_t),
};

bool ranks_init(Ranks *ranks, const MpiModule *module, int rank, int count)
{
    *ranks = (Ranks){.module = module, .rank = rank, .ranks = count};
    return asking_init(&ranks->asking, module, rank, count, WORD_QUESTION, WORD_ANSWER) &&
           pthread_mutex_init(&ranks->lock, NULL) == 0;
}

static void results_clear(RankTiles *results)
{
    for (size_t i = 0; i < results->count; i++) {
        text_fini(&results->items[i].bytes);
    }
    results->count = 0;
}

void ranks_fini(Ranks *ranks)
{
    results_clear(&ranks->results);
    ARRAY_FREE(&ranks->results);
    free(ranks->is_here);
    free(ranks->queue);
    asking_fini(&ranks->asking);
    pthread_mutex_destroy(&ranks->lock);
}

// ---- messages

static void send_numbers(Ranks *ranks, int to, Word word, const int32_t *numbers, int count)
{
    unsigned char message[1 + NUMBER * TILES_AT_ONCE];
    message[0] = (unsigned char)word;
    memcpy(message + 1, numbers, (size_t)count * NUMBER);
    ranks->module->send(to, message, 1 + (size_t)count * NUMBER);
}

static int32_t number_at(const unsigned char *bytes, size_t index)
{
    int32_t number;
    memcpy(&number, bytes + index * NUMBER, NUMBER);
    return number;
}

static bool result_set(RankTile *result, int tile, const unsigned char *bytes, size_t length)
{
    result->tile = tile;
    text_init(&result->bytes);
    text_append_n(&result->bytes, (const char *)bytes, length);
    return !result->bytes.failed;
}

// Of a tile that is done, at rank 0. With the lock.
static void keep_result(Ranks *ranks, int tile, const unsigned char *bytes, size_t length)
{
    RankTile result;
    bool is_needed = !ranks->is_last || !ranks->is_here[tile]; // by others, or by this rank itself
    ranks->done++;
    if (is_needed && (!result_set(&result, tile, bytes, length) || !ARRAY_PUSH(&ranks->results, result))) {
        ranks->has_failed = true;
    }
}

// ---- rank 0

// The next tile that is not known, or -1. With the lock.
static int deal(Ranks *ranks)
{
    while (ranks->next_tile < ranks->tiles && store_knows(ranks->store, ranks->next_tile)) {
        ranks->next_tile++;
    }
    return ranks->next_tile < ranks->tiles && !ranks->is_stopped ? ranks->next_tile++ : -1;
}

static void answer(Ranks *ranks, int to)
{
    int32_t tiles[TILES_AT_ONCE];
    int count = 0, most;
    pthread_mutex_lock(&ranks->lock);
    most = 1 + (ranks->tiles - ranks->next_tile) / (ROUNDS * ranks->ranks);
    most = most < TILES_AT_ONCE ? most : TILES_AT_ONCE;
    for (int tile; count < most && (tile = deal(ranks)) >= 0;) {
        tiles[count++] = tile;
    }
    pthread_mutex_unlock(&ranks->lock);
    send_numbers(ranks, to, WORD_TILES, tiles, count);
}

// Returns whether the rank said goodbye.
static bool hear(Ranks *ranks, int from, const unsigned char *bytes, size_t length)
{
    int tile = length >= 1 + NUMBER ? number_at(bytes + 1, 0) : -1;
    switch ((Word)bytes[0]) {
    case WORD_ASK:
        answer(ranks, from);
        break;
    case WORD_RESULT:
        if (tile >= 0 && tile < ranks->tiles) {
            store_add(ranks->store, tile, bytes + 1 + NUMBER, length - 1 - NUMBER);
            pthread_mutex_lock(&ranks->lock);
            keep_result(ranks, tile, bytes + 1 + NUMBER, length - 1 - NUMBER);
            pthread_mutex_unlock(&ranks->lock);
        }
        break;
    case WORD_STOP:
        pthread_mutex_lock(&ranks->lock);
        ranks->is_stopped = true;
        pthread_mutex_unlock(&ranks->lock);
        break;
    default:
        break;
    }
    return bytes[0] == WORD_BYE;
}

// After so many looks in vain, which it counts.
static void idle(int *looks)
{
    nanosleep(&(struct timespec){.tv_nsec = (long)IDLE_NANOSECONDS << *looks}, NULL);
    *looks += *looks < IDLE_DOUBLINGS;
}

// Hears all that has come; returns how many goodbyes.
static int hear_all(Ranks *ranks, bool *heard)
{
    int from, goodbyes = 0;
    unsigned char *bytes;
    size_t length;
    bool failed = false;
    *heard = asking_send(&ranks->asking) || *heard;
    while (ranks->module->receive(&from, &bytes, &length, &failed)) {
        *heard = true;
        if (asking_take(&ranks->asking, from, bytes, length)) {
            continue;
        }
        goodbyes += hear(ranks, from, bytes, length);
        free(bytes);
    }
    pthread_mutex_lock(&ranks->lock);
    ranks->has_failed = ranks->has_failed || failed;
    pthread_mutex_unlock(&ranks->lock);
    return goodbyes;
}

static void end_pass(Ranks *ranks)
{
    int goodbyes = 0, looks = 0;
    int32_t is_stopped = ranks->is_stopped;
    for (int to = 1; to < ranks->ranks; to++) {
        send_numbers(ranks, to, WORD_END, &is_stopped, 1);
    }
    while (goodbyes < ranks->ranks - 1 || !asking_is_quiet(&ranks->asking)) {
        bool heard = false;
        goodbyes += hear_all(ranks, &heard);
        looks = heard ? 0 : looks;
        if (!heard) {
            idle(&looks);
        }
    }
    for (int to = 1; ranks->asking.table && to < ranks->ranks; to++) {
        send_numbers(ranks, to, WORD_OVER, NULL, 0);
    }
}

static void serve_first(Ranks *ranks, void (*done)(void *run, int tiles), bool (*stops)(void *run), void *run)
{
    int reported = 0, looks = 0;
    bool is_whole = false, is_stopped = false;
    while (!is_whole && !is_stopped) {
        bool heard = false, is_to_stop = stops(run);
        (void)hear_all(ranks, &heard);
        pthread_mutex_lock(&ranks->lock);
        int now = ranks->done;
        is_stopped = ranks->is_stopped || ranks->has_failed || ranks->store->fault || is_to_stop;
        ranks->is_stopped = is_stopped;
        pthread_mutex_unlock(&ranks->lock);
        is_whole = now == ranks->tiles;
        looks = heard ? 0 : looks;
        if (now > reported) {
            done(run, reported = now);
        }
        if (!heard && !is_whole) {
            idle(&looks);
        }
    }
    pthread_mutex_lock(&ranks->lock);
    ranks->is_over = true; // threads that answer others need not wait for more
    pthread_mutex_unlock(&ranks->lock);
    end_pass(ranks);
}

// ---- the others

// Returns whether something could not be kept to be sent.
static bool send_results(Ranks *ranks, int *looks)
{
    pthread_mutex_lock(&ranks->lock);
    bool failed = ranks->has_failed;
    RankTiles ready = ranks->results;
    ranks->results = (RankTiles){0};
    pthread_mutex_unlock(&ranks->lock);
    *looks = ready.count > 0 ? 0 : *looks;
    for (size_t i = 0; i < ready.count; i++) { // each begins as a message does
        asking_post(&ranks->asking, 0, (unsigned char *)ready.items[i].bytes.text, ready.items[i].bytes.length);
    }
    ARRAY_FREE(&ready);
    return failed;
}

static bool wants_more(Ranks *ranks)
{
    pthread_mutex_lock(&ranks->lock);
    bool wants = !ranks->is_asking && ranks->queue_begin == ranks->queue_end;
    ranks->is_asking = ranks->is_asking || wants;
    pthread_mutex_unlock(&ranks->lock);
    return wants;
}

// Nothing more is dealt once an answer is empty: then the rank asks no more.
static void take_tiles(Ranks *ranks, const unsigned char *bytes, size_t length)
{
    size_t count = (length - 1) / NUMBER;
    pthread_mutex_lock(&ranks->lock);
    ranks->queue_begin = ranks->queue_end = 0;
    for (size_t i = 0; i < count && i < TILES_AT_ONCE; i++) {
        int tile = number_at(bytes + 1, i);
        if (tile >= 0 && tile < ranks->tiles) {
            ranks->queue[ranks->queue_end++] = tile;
        }
    }
    ranks->is_asking = count == 0;
    pthread_mutex_unlock(&ranks->lock);
}

// Hears what others may still ask.
static bool hear_questions(Ranks *ranks, int *looks)
{
    int from;
    unsigned char *bytes;
    size_t length;
    bool failed = false, is_over = false;
    if (!ranks->module->receive(&from, &bytes, &length, &failed)) {
        idle(looks);
    } else if (!asking_take(&ranks->asking, from, bytes, length)) {
        is_over = bytes[0] == WORD_OVER;
        free(bytes);
    }
    return is_over;
}

// All that is on its way arrives before this rank says goodbye.
static void end_sending(Ranks *ranks)
{
    for (int looks = 0; !asking_is_quiet(&ranks->asking);) {
        (void)asking_send(&ranks->asking);
        (void)hear_questions(ranks, &looks);
    }
}

// Where ranks ask each other, none may stop listening before nothing is on its way to it, which rank 0 says.
static void wait_for_all(Ranks *ranks)
{
    for (int looks = 0; ranks->asking.table && !hear_questions(ranks, &looks);) {
    }
}

static void serve_other(Ranks *ranks, bool (*stops)(void *run), void *run)
{
    bool has_said = false, failed = false;
    int looks = 0;
    while (!ranks->is_over) {
        int from;
        unsigned char *bytes;
        size_t length;
        failed = send_results(ranks, &looks) || failed;
        if (!has_said && (failed || stops(run))) {
            send_numbers(ranks, 0, WORD_STOP, NULL, 0);
            has_said = true;
        } else if (wants_more(ranks)) {
            send_numbers(ranks, 0, WORD_ASK, NULL, 0);
            looks = 0;
        }
        looks = asking_send(&ranks->asking) ? 0 : looks;
        if (!ranks->module->receive(&from, &bytes, &length, &failed)) {
            idle(&looks);
            continue;
        }
        looks = 0;
        if (asking_take(&ranks->asking, from, bytes, length)) {
            continue;
        }
        if (bytes[0] == WORD_TILES) {
            take_tiles(ranks, bytes, length);
        } else if (bytes[0] == WORD_END) {
            pthread_mutex_lock(&ranks->lock);
            ranks->is_over = true;
            ranks->is_stopped = number_at(bytes + 1, 0) != 0;
            pthread_mutex_unlock(&ranks->lock);
        }
        free(bytes);
    }
    end_sending(ranks);
    send_numbers(ranks, 0, WORD_BYE, NULL, 0);
    wait_for_all(ranks);
}

// ---- the table

static int begin(void *client, int tiles, bool is_last)
{
    Ranks *ranks = client;
    int known = ranks->rank == 0 ? store_begin_pass(ranks->store, tiles) : 0;
    free(ranks->is_here);
    ranks->is_here = calloc((size_t)tiles, 1);
    ranks->queue = ranks->queue ? ranks->queue : malloc(TILES_AT_ONCE * sizeof *ranks->queue);
    ranks->tiles = tiles;
    ranks->is_last = is_last;
    ranks->next_tile = ranks->queue_begin = ranks->queue_end = 0;
    ranks->done = known;
    ranks->is_asking = ranks->is_over = ranks->is_stopped = false;
    ranks->has_failed = !ranks->is_here || !ranks->queue;
    return known;
}

// Threads of others wait for tiles that were asked for; rank 0 has them at hand. Where ranks ask each other, all stay
// until the pass is over, and answer.
static int next(void *client)
{
    Ranks *ranks = client;
    for (int looks = 0;;) {
        int tile = -1;
        pthread_mutex_lock(&ranks->lock);
        bool is_over = ranks->is_over || ranks->is_stopped || ranks->has_failed;
        if (!is_over && ranks->rank == 0) {
            tile = deal(ranks);
        } else if (!is_over && ranks->queue_begin < ranks->queue_end) {
            tile = ranks->queue[ranks->queue_begin++];
        }
        pthread_mutex_unlock(&ranks->lock);
        if (tile >= 0 || is_over || (ranks->rank == 0 && (!ranks->asking.table || ranks->ranks == 1))) {
            return tile;
        }
        if (!ranks->asking.table || !asking_help(&ranks->asking)) {
            idle(&looks);
        }
    }
}

static bool is_over(void *client)
{
    Ranks *ranks = client;
    pthread_mutex_lock(&ranks->lock);
    bool over = ranks->is_over || ranks->is_stopped || ranks->has_failed;
    pthread_mutex_unlock(&ranks->lock);
    return over;
}

static TileSettled settle(void *client)
{
    Ranks *ranks = client;
    TileSettled settled = asking_settle(&ranks->asking, is_over, ranks);
    if (settled == TILE_GIVEN_UP && !is_over(ranks)) {
        pthread_mutex_lock(&ranks->lock);
        ranks->has_failed = true; // else all would wait for the tile
        pthread_mutex_unlock(&ranks->lock);
    }
    return settled;
}

void ranks_ask(Ranks *ranks, const TileAsking *asking)
{
    ranks->asking.table = asking;
    ranks->table.settle = asking ? settle : NULL;
}

static void give(void *client, int tile, const unsigned char *bytes, size_t length)
{
    Ranks *ranks = client;
    if (ranks->rank == 0) {
        store_add(ranks->store, tile, bytes, length);
    }
    pthread_mutex_lock(&ranks->lock);
    ranks->is_here[tile] = 1;
    if (ranks->rank == 0) {
        keep_result(ranks, tile, bytes, length);
    } else {
        RankTile result = {.tile = tile};
        int32_t number = tile;
        text_init(&result.bytes);
        text_append_char(&result.bytes, (char)WORD_RESULT);
        text_append_n(&result.bytes, (const char *)&number, NUMBER);
        text_append_n(&result.bytes, (const char *)bytes, length);
        if (result.bytes.failed || !ARRAY_PUSH(&ranks->results, result)) {
            ranks->has_failed = true;
        }
    }
    pthread_mutex_unlock(&ranks->lock);
}

static void serve(void *client, void (*done)(void *run, int tiles), bool (*stops)(void *run), void *run)
{
    Ranks *ranks = client;
    if (ranks->rank == 0) {
        serve_first(ranks, done, stops, run);
    } else {
        serve_other(ranks, stops, run);
    }
}

// ---- what all have left

// Results on end, each with its tile and its length, as rank 0 sends them.
static void pack(const Ranks *ranks, TextBuffer *all)
{
    const Store *store = ranks->store;
    for (size_t i = store->first; i < store->end; i++) {
        const PartialRecord *record = &store->records.items[i];
        const int32_t numbers[] = {(int32_t)record->tile, (int32_t)record->length};
        text_append_n(all, (const char *)numbers, sizeof numbers);
        text_append_n(all, (const char *)record->bytes, record->length);
    }
    for (size_t i = 0; i < ranks->results.count; i++) {
        const RankTile *result = &ranks->results.items[i];
        const int32_t numbers[] = {result->tile, (int32_t)result->bytes.length};
        text_append_n(all, (const char *)numbers, sizeof numbers);
        text_append_n(all, result->bytes.text, result->bytes.length);
    }
}

// Takes those that were not traced here.
static bool unpack(const Ranks *ranks, const unsigned char *bytes, size_t size, TileTake *take, void *run)
{
    for (size_t at = 0; at + 2 * NUMBER <= size;) {
        int tile = number_at(bytes + at, 0);
        size_t length = (size_t)(uint32_t)number_at(bytes + at, 1);
        at += 2 * NUMBER;
        if (tile < 0 || tile >= ranks->tiles || length > size - at ||
            (!ranks->is_here[tile] && !take(run, tile, bytes + at, length))) {
            return false;
        }
        at += length;
    }
    return true;
}

// Rank 0 says whether it has them, then sends them.
static bool exchange(Ranks *ranks, TextBuffer *all)
{
    long long size = ranks->rank > 0 ? 0 : all->failed || ranks->store->fault ? -1 : (long long)all->length;
    ranks->module->broadcast(&size, sizeof size);
    if (size < 0) {
        return false;
    }
    if (ranks->rank > 0) {
        unsigned char *room = malloc((size_t)size + 1);
        all->text = (char *)room;
        all->length = room ? (size_t)size : 0;
        all->capacity = room ? (size_t)size + 1 : 0;
        if (!room) { // the others would wait for ever
            ranks->module->stop(4);
        }
    }
    ranks->module->broadcast(all->text, all->length);
    return true;
}

static TileShareResult end(void *client, bool is_stopped, TileTake *take, void *run)
{
    Ranks *ranks = client;
    TextBuffer all;
    bool is_whole = true;
    bool is_alone = ranks->ranks == 1; // else rank 0 has said so while it served
    ranks->is_stopped = ranks->is_stopped || (is_alone && (is_stopped || ranks->has_failed || ranks->store->fault));
    if (ranks->is_stopped) {
        if (ranks->rank == 0) {
            store_flush(ranks->store);
        }
        results_clear(&ranks->results);
        return ranks->has_failed || (ranks->rank == 0 && ranks->store->fault) ? TILE_SHARE_BROKEN : TILE_SHARE_STOPPED;
    }
    if (ranks->is_last && ranks->rank > 0) {
        return TILE_SHARE_ELSEWHERE;
    }
    text_init(&all);
    if (ranks->rank == 0) {
        pack(ranks, &all);
        results_clear(&ranks->results);
    }
    is_whole = ranks->is_last ? !all.failed : exchange(ranks, &all);
    bool fits = is_whole && unpack(ranks, (const unsigned char *)text_get(&all), all.length, take, run);
    text_fini(&all);
    if (is_whole && !fits && ranks->rank > 0) {
        ranks->module->stop(3); // the others would continue
    }
    if (ranks->rank == 0 && is_whole && !fits && !ranks->store->fault) {
        ranks->store->fault = STORE_MISFIT;
    }
    return fits ? TILE_SHARE_HERE : TILE_SHARE_BROKEN;
}

static double seconds(void *client, double own)
{
    Ranks *ranks = client;
    double now = ranks->rank == 0 ? store_seconds(ranks->store, own) : 0.0;
    ranks->module->broadcast(&now, sizeof now);
    return now;
}

void ranks_use(Ranks *ranks, Store *store)
{
    ranks->store = store;
    ranks->table = (TileShare){.client = ranks,
                               .serves = ranks->ranks > 1, // nobody is to be heard else
                               .begin = begin,
                               .next = next,
                               .give = give,
                               .serve = serve,
                               .end = end,
                               .seconds = seconds};
}

// ---- before a picture

int ranks_agree(Ranks *ranks, bool ready, const PartialHead *head, PartialField *differs)
{
    long long own = PARTIAL_FIELDS, *all = calloc((size_t)ranks->ranks, sizeof *all);
    int first = -1;
    for (int field = 0; field < PARTIAL_RESULTS; field++) {
        const char *text = ready ? head->fields[field] : "";
        long long length = (long long)strlen(text);
        ranks->module->broadcast(&length, sizeof length);
        char *theirs = malloc((size_t)length + 1);
        if (!theirs || !all) {
            free(theirs);
            free(all);
            ranks->module->stop(4);
            return 0;
        }
        memcpy(theirs, text, ranks->rank == 0 ? (size_t)length : 0);
        ranks->module->broadcast(theirs, (size_t)length);
        theirs[length] = '\0';
        own = own == PARTIAL_FIELDS && strcmp(theirs, text) != 0 ? field : own;
        free(theirs);
    }
    own = ready ? own : PARTIAL_RESULTS;
    ranks->module->gather(&own, all, sizeof own);
    for (int i = 0; i < ranks->ranks && first < 0; i++) {
        if (all[i] != PARTIAL_FIELDS) {
            first = i;
            *differs = (PartialField)all[i];
        }
    }
    free(all);
    return first;
}
