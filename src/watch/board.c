// What is known of a scene that is drawn, under one lock, and as JSON.
//
// SPDX-License-Identifier: MIT
#include "watch/board.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/clock.h"
#include "base/json.h"

bool board_init(Board *board)
{
    pthread_condattr_t attributes;
    *board = (Board){.seconds_left = -1.0};
    text_init(&board->messages);
    text_init(&board->said);
    text_init(&board->peer_fault);
    if (pthread_condattr_init(&attributes) != 0) {
        return false;
    }
    bool fine = pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) == 0 &&
                pthread_cond_init(&board->changed, &attributes) == 0 && pthread_mutex_init(&board->lock, NULL) == 0;
    pthread_condattr_destroy(&attributes);
    return fine;
}

void board_fini(Board *board)
{
    text_fini(&board->messages);
    text_fini(&board->said);
    text_fini(&board->peer_fault);
    free(board->picture.bytes);
    free(board->peer.bytes);
    pthread_mutex_destroy(&board->lock);
    pthread_cond_destroy(&board->changed);
}

void board_lock(Board *board)
{
    pthread_mutex_lock(&board->lock);
}

void board_unlock(Board *board)
{
    pthread_mutex_unlock(&board->lock);
}

void board_change(Board *board)
{
    board->change++;
    pthread_cond_broadcast(&board->changed);
    pthread_mutex_unlock(&board->lock);
}

bool board_set_picture(BoardPicture *picture, const unsigned char *bytes, size_t length, uint64_t save)
{
    unsigned char *copy = malloc(length);
    if (!copy) {
        return false;
    }
    memcpy(copy, bytes, length);
    free(picture->bytes);
    *picture = (BoardPicture){copy, length, picture->id + 1, save};
    return true;
}

void board_wait(Board *board, uint64_t after, double seconds)
{
    struct timespec until;
    int result = 0;
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_sec += (time_t)seconds;
    while (board->change <= after && !board->is_over && result != ETIMEDOUT) {
        result = pthread_cond_timedwait(&board->changed, &board->lock, &until);
    }
}

// ---- JSON

static void put_number(TextBuffer *out, const char *name, double value)
{
    text_printf(out, ",\"%s\":", name);
    json_number(out, value);
}

static void put_count(TextBuffer *out, const char *name, uint64_t value)
{
    text_printf(out, ",\"%s\":%llu", name, (unsigned long long)value);
}

static void put_text(TextBuffer *out, const char *name, const TextBuffer *text)
{
    text_printf(out, ",\"%s\":", name);
    json_string(out, text_get(text), text->length);
}

static void put_error(TextBuffer *out, const Board *board)
{
    static const char *const ends[] = {[RT_END_DONE] = "samples",
                                       [RT_END_TARGET] = "target",
                                       [RT_END_TIME] = "time",
                                       [RT_END_INTERRUPTED] = "interrupted"};
    const rt_error *error = &board->error;
    if (!error->known || board->point_count == 0) {
        return;
    }
    put_number(out, "error", error->rmse);
    put_number(out, "low", error->low);
    put_number(out, "high", error->high);
    put_number(out, "samples", error->samples);
    put_number(out, "bias", error->bias);
    text_printf(out, ",\"end\":\"%s\",\"curve\":[", ends[error->end]);
    for (size_t i = 0; i < board->point_count; i++) {
        const BoardPoint *point = &board->points[i];
        text_append(out, i > 0 ? ",[" : "[");
        json_number(out, point->seconds);
        text_append(out, ",");
        json_number(out, point->error);
        text_append(out, ",");
        json_number(out, point->samples);
        text_append(out, "]");
    }
    text_append(out, "]");
}

static void put_peer(TextBuffer *out, const Board *board)
{
    static const char *const states[] = {[PEER_MISSING] = "missing",
                                         [PEER_IDLE] = "idle",
                                         [PEER_DRAWING] = "drawing",
                                         [PEER_DONE] = "done",
                                         [PEER_FAULT] = "fault"};
    text_printf(out, ",\"povray\":{\"state\":\"%s\"", states[board->peer_state]);
    put_count(out, "picture", board->peer.id);
    put_count(out, "save", board->peer.save);
    put_number(out, "seconds", board->peer_seconds);
    put_text(out, "fault", &board->peer_fault);
    text_append(out, "}");
}

void board_write(const Board *board, TextBuffer *out)
{
    static const char *const states[] = {
        [BOARD_READING] = "reading", [BOARD_DRAWING] = "drawing", [BOARD_DONE] = "done", [BOARD_FAULT] = "fault"};
    text_printf(out, "{\"change\":%llu,\"state\":\"%s\",\"scene\":", (unsigned long long)board->change,
                states[board->state]);
    json_string(out, board->scene, strlen(board->scene));
    put_count(out, "width", (uint64_t)board->width);
    put_count(out, "height", (uint64_t)board->height);
    put_count(out, "save", board->save);
    put_count(out, "picture", board->picture.id);
    put_count(out, "picture_save", board->picture.save);
    text_printf(out, ",\"coarse\":%s", board->is_coarse ? "true" : "false");
    put_number(out, "target", board->target);
    put_number(out, "first_seconds", board->first_seconds);
    put_number(out, "seconds", clock_seconds() - board->begun);
    put_number(out, "done", board->done);
    put_number(out, "seconds_left", board->seconds_left);
    put_error(out, board);
    text_printf(out, ",\"messages\":[%s]", text_get(&board->messages));
    put_text(out, "said", &board->said);
    put_peer(out, board);
    text_append(out, "}");
}
