// Save by save: read the scene, draw it small, then better and better, until the next save.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "watch/watch.h"

#include <arpa/inet.h>
#include <errno.h>
#include <math.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include "base/module.h"
#include "watch/draw.h"
#include "watch/serve.h"

enum { ROOM = 64 << 20, WAITING_MOST = 16 };

struct Watch {
    const WatchJob *job;
    const HttpModule *module;
    int socket;
    char address[WATCH_ADDRESS];
    Board board;
    Painter painter;
    Pixel pixel;
    Sentry sentry;
    Service service;
};

static bool make_token(char token[TOKEN_TEXT])
{
    unsigned char bytes[(TOKEN_TEXT - 1) / 2];
    if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes) {
        return false;
    }
    for (size_t i = 0; i < sizeof bytes; i++) {
        snprintf(token + 2 * i, 3, "%02x", bytes[i]);
    }
    return true;
}

// On the loopback address only, at any free port. -1: it cannot be, and errno says why.
static int open_socket(unsigned *port)
{
    struct sockaddr_in place = {.sin_family = AF_INET, .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    socklen_t length = sizeof place;
    int made = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (made >= 0 && bind(made, (struct sockaddr *)&place, sizeof place) == 0 && listen(made, WAITING_MOST) == 0 &&
        getsockname(made, (struct sockaddr *)&place, &length) == 0) {
        *port = ntohs(place.sin_port);
        return made;
    }
    int code = errno;
    if (made >= 0) {
        close(made);
    }
    errno = code;
    return -1;
}

static bool load_module(Watch *watch, char *why, size_t size)
{
#ifdef WITH_WATCH
    const void *module;
    ModuleResult result =
        module_load(&(ModuleKind){HTTP_MODULE_FILE, HTTP_MODULE_SYMBOL, HTTP_MODULE_VERSION, ROOM}, &module, why, size);
    if (result == MODULE_NO_MEMORY) {
        snprintf(why, size, "there is no memory for it");
    }
    watch->module = module;
    return result == MODULE_OK;
#else
    (void)watch;
    snprintf(why, size, "this rtlang was built without it");
    return false;
#endif
}

static void open_painter(Watch *watch)
{
    const WatchJob *job = watch->job;
    if (!job->has_no_peer) {
        painter_open(&watch->painter,
                     &(PainterJob){job->scene, job->width, job->height, job->include_paths, job->include_path_count,
                                   job->declarations, job->declaration_count, job->clock});
    }
}

Watch *watch_open(const WatchJob *job, char *why, size_t size)
{
    unsigned port = 0;
    Watch *watch = calloc(1, sizeof *watch);
    snprintf(why, size, "out of memory");
    if (!watch || !board_init(&watch->board)) {
        free(watch);
        return NULL;
    }
    watch->job = job;
    watch->socket = -1;
    painter_init(&watch->painter, &watch->board);
    pixel_init(&watch->pixel, job);
    watch->board.scene = job->scene;
    watch->board.width = job->width;
    watch->board.height = job->height;
    if (load_module(watch, why, size)) {
        open_painter(watch); // before there is a socket, which is no business of its
        watch->socket = make_token(watch->service.token) ? open_socket(&port) : -1;
        snprintf(why, size, "%s", strerror(errno));
    }
    if (watch->socket < 0) {
        watch_close(watch);
        return NULL;
    }
    snprintf(watch->address, sizeof watch->address, "http://127.0.0.1:%u/%s/", port, watch->service.token);
    return watch;
}

const char *watch_address(const Watch *watch)
{
    return watch->address;
}

bool watch_run(Watch *watch)
{
    watch->service.board = &watch->board;
    watch->service.painter = &watch->painter;
    watch->service.pixel = &watch->pixel;
    watch->service.sentry = &watch->sentry;
    painter_start(&watch->painter);
    bool is_on_guard = sentry_start(&watch->sentry, watch->job->scene, watch->job->interrupted_by);
    void *server = is_on_guard ? watch->module->start(watch->socket, serve, &watch->service) : NULL;
    watch->socket = -1; // the server's
    if (server) {
        draw_until_end(watch->job, &watch->board, &watch->sentry);
        board_lock(&watch->board);
        watch->board.is_over = true;
        board_change(&watch->board);
        pixel_cancel(&watch->pixel);
        watch->module->stop(server);
    }
    sentry_stop(&watch->sentry);
    return server != NULL;
}

void watch_close(Watch *watch)
{
    if (!watch) {
        return;
    }
    if (watch->socket >= 0) {
        close(watch->socket);
    }
    painter_close(&watch->painter);
    pixel_fini(&watch->pixel);
    board_fini(&watch->board);
    free(watch);
}
