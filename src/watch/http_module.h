// The C boundary between the program and the module that wraps libmicrohttpd, which only --watch loads.
//
// The module knows requests and answers and nothing of what they mean. It opens no socket: it is given one that listens.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_HTTP_MODULE_H
#define WATCH_HTTP_MODULE_H

#include <stdbool.h>
#include <stddef.h>

// Raised with each change of the structures below; a module of another version is passed over.
#define HTTP_MODULE_VERSION 1u
#define HTTP_MODULE_FILE    "rtlang_http.so"
#define HTTP_MODULE_SYMBOL  "rtlang_http_module"

typedef struct HttpRequest {
    bool is_post; // else GET
    const char *path;
    const char *(*argument)(const struct HttpRequest *request, const char *name); // of the query; NULL: there is none
    void *connection;
} HttpRequest;

typedef struct HttpAnswer {
    unsigned status;
    const char *type; // of the body's media
    void *body;       // of malloc; the module frees it
    size_t length;
} HttpAnswer;

// Called on a thread of each connection's own, and may wait there.
typedef HttpAnswer (*HttpHandler)(void *client, const HttpRequest *request);

typedef struct HttpModule {
    unsigned version;
    // Takes the socket over. NULL: it cannot be served.
    void *(*start)(int socket, HttpHandler handler, void *client);
    // Returns when no handler runs any more: those that wait must be ended before.
    void (*stop)(void *server);
} HttpModule;

// The module's one symbol.
extern __attribute__((visibility("default"))) const HttpModule rtlang_http_module;

#endif
