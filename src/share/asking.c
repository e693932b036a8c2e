// Questions and answers between ranks: see asking.h.
//
// A message is its first byte, the number of the wait, and the questions or answers.
//
// SPDX-License-Identifier: MIT
#include "share/asking.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

enum {
    HEAD = 1 + sizeof(int32_t),
    IDLE_NANOSECONDS = 20000, // between looks for answers
};

bool asking_init(Asking *asking, const MpiModule *module, int rank, int ranks, unsigned char question,
                 unsigned char answer)
{
    *asking = (Asking){.module = module, .rank = rank, .ranks = ranks, .question = question, .answer = answer};
    return pthread_mutex_init(&asking->lock, NULL) == 0;
}

static void messages_fini(AskingMessages *messages)
{
    for (size_t i = 0; i < messages->count; i++) {
        free(messages->items[i].bytes);
    }
    ARRAY_FREE(messages);
}

void asking_fini(Asking *asking)
{
    messages_fini(&asking->to_send);
    messages_fini(&asking->on_their_way);
    messages_fini(&asking->questions);
    pthread_mutex_destroy(&asking->lock);
}

// With the lock. The bytes are taken over.
static void put(Asking *asking, AskingMessages *messages, int rank, unsigned char *bytes, size_t length)
{
    AskingMessage message = {.rank = rank, .bytes = bytes, .length = length};
    if (!bytes || !ARRAY_PUSH(messages, message)) {
        free(bytes);
        asking->has_failed = true;
    }
}

static unsigned char *message_new(unsigned char word, int32_t number, size_t length)
{
    unsigned char *bytes = malloc(HEAD + length);
    if (bytes) {
        bytes[0] = word;
        memcpy(bytes + 1, &number, sizeof number);
    }
    return bytes;
}

// ---- answering

bool asking_help(Asking *asking)
{
    pthread_mutex_lock(&asking->lock);
    if (asking->questions.count == 0) {
        pthread_mutex_unlock(&asking->lock);
        return false;
    }
    AskingMessage message = asking->questions.items[--asking->questions.count];
    pthread_mutex_unlock(&asking->lock);
    size_t count = (message.length - HEAD) / asking->table->question_bytes;
    size_t length = count * asking->table->answer_bytes;
    int32_t number;
    memcpy(&number, message.bytes + 1, sizeof number);
    // Behind the head they would not be aligned.
    void *questions = malloc(message.length), *answers = malloc(length + 1);
    unsigned char *bytes = message_new(asking->answer, number, length);
    bool is_answered = false;
    if (questions && answers && bytes) {
        memcpy(questions, message.bytes + HEAD, message.length - HEAD);
        is_answered = asking->table->answer(asking->table->client, questions, count, answers);
        memcpy(bytes + HEAD, answers, length);
    }
    if (!is_answered) {
        free(bytes);
        bytes = NULL;
    }
    free(questions);
    free(answers);
    free(message.bytes);
    pthread_mutex_lock(&asking->lock);
    put(asking, &asking->to_send, message.rank, bytes, HEAD + length);
    pthread_mutex_unlock(&asking->lock);
    return true;
}

// ---- asking

static void send_questions(Asking *asking, AskingWait *wait, const void *questions, size_t count)
{
    size_t length = count * asking->table->question_bytes;
    pthread_mutex_lock(&asking->lock);
    wait->number = ++asking->last;
    wait->next = asking->waits;
    asking->waits = wait;
    for (int to = 0; to < asking->ranks; to++) {
        if (to != asking->rank) {
            unsigned char *bytes = message_new(asking->question, wait->number, length);
            if (bytes) {
                memcpy(bytes + HEAD, questions, length);
            }
            put(asking, &asking->to_send, to, bytes, HEAD + length);
        }
    }
    pthread_mutex_unlock(&asking->lock);
}

// Whether all answers came; helps others until then.
static bool wait_for(Asking *asking, AskingWait *wait, bool (*is_over)(void *client), void *client)
{
    bool is_done = false, has_failed = false;
    while (!is_done && !has_failed) {
        pthread_mutex_lock(&asking->lock);
        is_done = wait->left == 0;
        has_failed = asking->has_failed;
        pthread_mutex_unlock(&asking->lock);
        has_failed = has_failed || is_over(client);
        if (!is_done && !has_failed && !asking_help(asking)) {
            nanosleep(&(struct timespec){.tv_nsec = IDLE_NANOSECONDS}, NULL);
        }
    }
    pthread_mutex_lock(&asking->lock);
    for (AskingWait **at = &asking->waits; *at; at = &(*at)->next) {
        if (*at == wait) {
            *at = wait->next;
            break;
        }
    }
    pthread_mutex_unlock(&asking->lock);
    return is_done;
}

TileSettled asking_settle(Asking *asking, bool (*is_over)(void *client), void *client)
{
    const TileAsking *table = asking->table;
    const void *questions;
    size_t count = table->questions(table->client, &questions), others = (size_t)asking->ranks - 1;
    if (count == 0) {
        return table->forget(table->client) ? TILE_SETTLED : TILE_GIVEN_UP;
    }
    AskingWait wait = {.left = (int)others, .length = count * table->answer_bytes};
    wait.lists = malloc(others * wait.length + 1);
    bool is_done = wait.lists != NULL;
    if (is_done && others > 0) {
        send_questions(asking, &wait, questions, count);
        is_done = wait_for(asking, &wait, is_over, client);
    }
    if (is_done) {
        table->learn(table->client, wait.lists, others);
    }
    free(wait.lists);
    return is_done ? TILE_AGAIN : TILE_GIVEN_UP;
}

// ---- the thread that talks

// With the lock. Lists stand by rank, this one's left out.
static void take_answer(Asking *asking, int from, const unsigned char *bytes, size_t length)
{
    int32_t number;
    memcpy(&number, bytes + 1, sizeof number);
    AskingWait *wait = asking->waits;
    while (wait && wait->number != number) {
        wait = wait->next;
    }
    if (wait && length - HEAD == wait->length && wait->left > 0) {
        memcpy(wait->lists + (size_t)(from - (from > asking->rank)) * wait->length, bytes + HEAD, wait->length);
        wait->left--;
    }
}

bool asking_take(Asking *asking, int from, unsigned char *bytes, size_t length)
{
    if (!asking->table || length < HEAD || (bytes[0] != asking->question && bytes[0] != asking->answer)) {
        return false;
    }
    pthread_mutex_lock(&asking->lock);
    if (bytes[0] == asking->question) {
        put(asking, &asking->questions, from, bytes, length);
    } else {
        take_answer(asking, from, bytes, length);
        free(bytes);
    }
    pthread_mutex_unlock(&asking->lock);
    return true;
}

void asking_post(Asking *asking, int to, unsigned char *bytes, size_t length)
{
    pthread_mutex_lock(&asking->lock);
    put(asking, &asking->to_send, to, bytes, length);
    pthread_mutex_unlock(&asking->lock);
}

bool asking_send(Asking *asking)
{
    pthread_mutex_lock(&asking->lock);
    AskingMessages ready = asking->to_send;
    asking->to_send = (AskingMessages){0};
    pthread_mutex_unlock(&asking->lock);
    bool sends = ready.count > 0;
    for (size_t i = 0; i < ready.count; i++) {
        AskingMessage *message = &ready.items[i];
        message->handle = asking->module->post(message->rank, message->bytes, message->length);
        if (!message->handle || !ARRAY_PUSH(&asking->on_their_way, *message)) {
            asking->module->stop(4); // the other rank would wait for ever
        }
    }
    ARRAY_FREE(&ready);
    size_t kept = 0;
    for (size_t i = 0; i < asking->on_their_way.count; i++) {
        AskingMessage *message = &asking->on_their_way.items[i];
        if (asking->module->is_sent(message->handle)) {
            free(message->bytes);
            sends = true;
        } else {
            asking->on_their_way.items[kept++] = *message;
        }
    }
    asking->on_their_way.count = kept;
    return sends;
}

bool asking_is_quiet(Asking *asking)
{
    pthread_mutex_lock(&asking->lock);
    bool is_quiet = asking->to_send.count == 0;
    pthread_mutex_unlock(&asking->lock);
    return is_quiet && asking->on_their_way.count == 0;
}
