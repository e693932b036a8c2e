// Requests of a socket to calls of a handler, by libmicrohttpd: one thread for each connection, so that one may wait.
//
// SPDX-License-Identifier: MIT
#include "watch/http_module.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <microhttpd.h>

#include "base/attributes.h"

enum { CONNECTIONS_MOST = 32, IDLE_SECONDS = 60 };

typedef struct Server {
    struct MHD_Daemon *daemon;
    HttpHandler handler;
    void *client;
} Server;

static const char *find_argument(const HttpRequest *request, const char *name)
{
    return MHD_lookup_connection_value(request->connection, MHD_GET_ARGUMENT_KIND, name);
}

// What is served is this page's alone: no cache keeps it, no other page embeds it, and no other site gets its address.
static void add_headers(struct MHD_Response *response, const HttpAnswer *answer)
{
    static const char *const headers[][2] = {
        {"Cache-Control", "no-store"},
        {"Referrer-Policy", "no-referrer"},
        {"X-Content-Type-Options", "nosniff"},
        {"X-Frame-Options", "DENY"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
    };
    (void)MHD_add_response_header(response, "Content-Type", answer->type);
    for (size_t i = 0; i < RT_COUNT_OF(headers); i++) {
        (void)MHD_add_response_header(response, headers[i][0], headers[i][1]);
    }
}

// Called once with the head of a request, then for each piece of what comes with it, then without any.
static enum MHD_Result on_request(void *client, struct MHD_Connection *connection, const char *url, const char *method,
                                  const char *version, const char *upload, size_t *upload_size, void **state)
{
    Server *server = client;
    (void)version, (void)upload;
    if (!*state) {
        *state = server;
        return MHD_YES;
    }
    if (*upload_size > 0) {
        *upload_size = 0; // nothing of it is wanted
        return MHD_YES;
    }
    bool is_post = strcmp(method, MHD_HTTP_METHOD_POST) == 0, is_get = strcmp(method, MHD_HTTP_METHOD_GET) == 0;
    HttpRequest request = {is_post, url, find_argument, connection};
    HttpAnswer answer = {MHD_HTTP_METHOD_NOT_ALLOWED, "text/plain", NULL, 0};
    if (is_get || is_post) {
        answer = server->handler(server->client, &request);
    }
    struct MHD_Response *response = MHD_create_response_from_buffer(answer.length, answer.body, MHD_RESPMEM_MUST_FREE);
    if (!response) {
        free(answer.body);
        return MHD_NO;
    }
    add_headers(response, &answer);
    enum MHD_Result result = MHD_queue_response(connection, answer.status, response);
    MHD_destroy_response(response);
    return result;
}

// The library's own messages, of connections that broke off, are of no use to anybody.
static void say_nothing(void *client, const char *format, va_list arguments)
{
    (void)client, (void)format, (void)arguments;
}

static void *start(int socket, HttpHandler handler, void *client)
{
    Server *server = calloc(1, sizeof *server);
    if (!server) {
        close(socket);
        return NULL;
    }
    server->handler = handler;
    server->client = client;
    server->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_THREAD_PER_CONNECTION | MHD_USE_POLL | MHD_USE_ERROR_LOG, 0, NULL,
        NULL, on_request, server, MHD_OPTION_EXTERNAL_LOGGER, say_nothing, NULL, MHD_OPTION_LISTEN_SOCKET, socket,
        MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS_MOST, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)IDLE_SECONDS,
        MHD_OPTION_END);
    if (!server->daemon) {
        close(socket);
        free(server);
        return NULL;
    }
    return server;
}

static void stop(void *handle)
{
    Server *server = handle;
    MHD_stop_daemon(server->daemon);
    free(server);
}

const HttpModule rtlang_http_module = {HTTP_MODULE_VERSION, start, stop};
