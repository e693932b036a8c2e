// The page's requests: what comes under the token, and answers from the board. Everything else is not found.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_SERVE_H
#define WATCH_SERVE_H

#include "watch/board.h"
#include "watch/http_module.h"
#include "watch/painter.h"
#include "watch/pixel.h"
#include "watch/sentry.h"

enum { TOKEN_TEXT = 33 }; // 128 bits in hexadecimal digits

typedef struct Service {
    char token[TOKEN_TEXT];
    Board *board;
    Painter *painter;
    Pixel *pixel;
    Sentry *sentry;
} Service;

// An HttpHandler; its client is the Service.
HttpAnswer serve(void *client, const HttpRequest *request);

#endif
