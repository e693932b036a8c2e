// A table of what can be asked, each row a function that makes the answer's body.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "watch/serve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json.h"

enum { OK = 200, BAD_REQUEST = 400, NOT_FOUND = 404, NO_MEMORY = 503, WAIT_SECONDS = 20 };

static const char *const page_lines[] = {
#include "watch/page.inc"
};

static HttpAnswer answer_bytes(unsigned status, const char *type, const void *bytes, size_t length)
{
    void *body = malloc(length + 1);
    if (!body) {
        return (HttpAnswer){NO_MEMORY, "text/plain", NULL, 0};
    }
    memcpy(body, bytes, length);
    return (HttpAnswer){status, type, body, length};
}

static HttpAnswer answer_fault(unsigned status, const char *text)
{
    return answer_bytes(status, "text/plain; charset=utf-8", text, strlen(text));
}

static HttpAnswer not_found(void)
{
    return answer_fault(NOT_FOUND, "not found\n");
}

// Releases the text.
static HttpAnswer answer_text(const char *type, TextBuffer *text)
{
    HttpAnswer answer = text->failed ? answer_fault(NO_MEMORY, "out of memory\n")
                                     : answer_bytes(OK, type, text_get(text), text->length);
    text_fini(text);
    return answer;
}

// A whole number of the query; -1: there is none.
static long long number_of(const HttpRequest *request, const char *name)
{
    const char *text = request->argument(request, name);
    char *end;
    long long value = text && text[0] >= '0' && text[0] <= '9' ? strtoll(text, &end, 10) : -1;
    return value >= 0 && !*end ? value : -1;
}

// ---- what can be asked

static HttpAnswer answer_page(Service *service, const HttpRequest *request)
{
    TextBuffer page;
    (void)service, (void)request;
    text_init(&page);
    for (size_t i = 0; i < RT_COUNT_OF(page_lines); i++) {
        text_append(&page, page_lines[i]);
    }
    return answer_text("text/html; charset=utf-8", &page);
}

// Waits for a change after the one that the page knows.
static HttpAnswer answer_state(Service *service, const HttpRequest *request)
{
    Board *board = service->board;
    TextBuffer text;
    long long after = number_of(request, "after");
    text_init(&text);
    board_lock(board);
    if (after >= 0) {
        board_wait(board, (uint64_t)after, WAIT_SECONDS);
    }
    board_write(board, &text);
    board_unlock(board);
    return answer_text("application/json", &text);
}

static HttpAnswer answer_picture_of(Board *board, const BoardPicture *picture)
{
    board_lock(board);
    HttpAnswer answer = picture->bytes ? answer_bytes(OK, "image/png", picture->bytes, picture->length) : not_found();
    board_unlock(board);
    return answer;
}

static HttpAnswer answer_picture(Service *service, const HttpRequest *request)
{
    (void)request;
    return answer_picture_of(service->board, &service->board->picture);
}

static HttpAnswer answer_peer(Service *service, const HttpRequest *request)
{
    if (!request->is_post) {
        return answer_picture_of(service->board, &service->board->peer);
    }
    board_lock(service->board);
    painter_ask(service->painter);
    board_change(service->board);
    return answer_bytes(OK, "application/json", "{}", 2);
}

static HttpAnswer answer_pixel(Service *service, const HttpRequest *request)
{
    Board *board = service->board;
    TextBuffer text;
    board_lock(board);
    long long x = number_of(request, "x"), y = number_of(request, "y");
    bool is_inside = x >= 0 && x < board->width && y >= 0 && y < board->height;
    uint64_t save = board->save;
    board_unlock(board);
    if (!is_inside) {
        return answer_fault(BAD_REQUEST, "no such pixel\n");
    }
    text_init(&text);
    if (!pixel_trace(service->pixel, save, (int)x, (int)y, &text)) {
        text_fini(&text);
        return answer_fault(NOT_FOUND, "the scene has a fault\n");
    }
    return answer_text("application/json", &text);
}

// A line of one of the scene's files.
static HttpAnswer answer_line(Service *service, const HttpRequest *request)
{
    const char *path = request->argument(request, "file");
    long long number = number_of(request, "line");
    FILE *file = path && number > 0 && sentry_has_file(service->sentry, path) ? fopen(path, "re") : NULL;
    char *line = NULL;
    size_t size = 0;
    ssize_t length = 0;
    for (long long i = 0; file && length >= 0 && i < number; i++) {
        length = getline(&line, &size, file);
    }
    HttpAnswer answer =
        !file || length < 0 ? not_found() : answer_bytes(OK, "text/plain; charset=utf-8", line, (size_t)length);
    free(line);
    if (file) {
        fclose(file);
    }
    return answer;
}

// What follows the slash in a path of a slash and the token; NULL where it is another. The time that it takes
// does not depend on how much of the token was right.
static const char *name_of(const Service *service, const char *path)
{
    size_t length = strlen(service->token);
    if (strlen(path) < length + 2) {
        return NULL;
    }
    unsigned differ = path[0] != '/' || path[length + 1] != '/';
    for (size_t i = 0; i < length; i++) {
        differ |= (unsigned)(path[i + 1] ^ service->token[i]);
    }
    return differ ? NULL : path + length + 2;
}

HttpAnswer serve(void *client, const HttpRequest *request)
{
    static const struct {
        const char *name;
        bool takes_post;
        HttpAnswer (*answer)(Service *service, const HttpRequest *request);
    } rows[] = {
        {"", false, answer_page},      {"state", false, answer_state}, {"picture", false, answer_picture},
        {"povray", true, answer_peer}, {"pixel", false, answer_pixel}, {"line", false, answer_line},
    };
    Service *service = client;
    const char *name = name_of(service, request->path);
    for (size_t i = 0; name && i < RT_COUNT_OF(rows); i++) {
        if (strcmp(name, rows[i].name) == 0 && (rows[i].takes_post || !request->is_post)) {
            return rows[i].answer(service, request);
        }
    }
    return not_found();
}
