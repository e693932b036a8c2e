// A loop over messages. Documents are kept as their clients have them; each question is answered by evaluating the text anew,
// which takes a few milliseconds, so that nothing can be out of date.
//
// SPDX-License-Identifier: MIT
#include "cli/lsp.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/json.h"
#include "cli/lsp_json.h"
#include "cli/lsp_text.h"
#include "cli/run.h"

enum { MESSAGE_MOST = 1 << 28, STEPS_MOST = 3000000, OBJECTS_MOST = 2000000, FILE_MOST = 1 << 26 };

typedef struct Document {
    char *uri, *path, *text; // owned
    struct Document *next;
} Document;

typedef struct Server {
    const Options *options;
    Document *documents;
    bool is_shut, is_over;
} Server;

// ---- messages out

static void send(const char *text, size_t length)
{
    printf("Content-Length: %zu\r\n\r\n", length);
    fwrite(text, 1, length, stdout);
    fflush(stdout);
}

typedef struct Message {
    FILE *out; // NULL: there is no memory
    char *text;
    size_t length;
} Message;

static bool message_begin(Message *message, Json id)
{
    *message = (Message){NULL, NULL, 0};
    message->out = open_memstream(&message->text, &message->length);
    if (message->out && id.begin) {
        fprintf(message->out, "{\"jsonrpc\":\"2.0\",\"id\":%.*s,", (int)(id.end - id.begin), id.begin);
    }
    return message->out != NULL;
}

static void message_end(Message *message)
{
    if (fclose(message->out) == 0) {
        send(message->text, message->length);
    }
    free(message->text);
}

static void answer(Json id, const char *members)
{
    Message message;
    if (message_begin(&message, id)) {
        fprintf(message.out, "%s}", members);
        message_end(&message);
    }
}

// ---- documents

static Document *find_document(const Server *server, Json params)
{
    char *uri = json_take_text(json_at(params, "textDocument.uri"));
    Document *document = server->documents;
    while (uri && document && strcmp(document->uri, uri) != 0) {
        document = document->next;
    }
    free(uri);
    return uri ? document : NULL;
}

static void free_document(Document *document)
{
    free(document->uri);
    free(document->path);
    free(document->text);
    free(document);
}

// ---- evaluation

typedef struct Evaluation {
    FILE *out; // where diagnostics go; NULL: nowhere
    const Document *document;
    bool has_one; // so that a comma stands before the next one
    char value[256]; // that a probe gave; "": none
} Evaluation;

static const char mark[] = "rtlang-lsp-value ";

static void on_diagnostic(void *client, const rt_diagnostic *diagnostic)
{
    Evaluation *evaluation = client;
    FILE *out = evaluation->out;
    if (!out || diagnostic->severity == RT_NOTE) {
        return;
    }
    const Document *document = evaluation->document;
    const char *ending = strrchr(document->path, '.');
    bool is_part = ending && strcasecmp(ending, ".inc") == 0; // of a scene, which has what it lacks
    bool is_here = diagnostic->line > 0 && diagnostic->file && strcmp(diagnostic->file, document->path) == 0;
    if (diagnostic->line == 0 && is_part) {
        return;
    }
    const char *begin = is_here ? text_of_column(document->text, diagnostic->line, diagnostic->column) : document->text;
    Word word = is_here ? text_word(document->text, begin) : (Word){begin, 0};
    const char *end = word.length > 0 && word.begin == begin ? begin + word.length : begin + (is_here && *begin > ' ');
    char message[1024];
    bool is_elsewhere = !is_here && diagnostic->line > 0;
    if (is_elsewhere) {
        snprintf(message, sizeof message, "%s, in %s:%llu", diagnostic->message, diagnostic->file,
                 (unsigned long long)diagnostic->line);
    } else {
        snprintf(message, sizeof message, "%s", diagnostic->message);
    }
    fprintf(out, "%s{\"range\":", evaluation->has_one ? "," : "");
    text_write_range(out, document->text, begin, end);
    fprintf(out, ",\"severity\":%d,\"code\":\"%s\",\"source\":\"rtlang\",\"message\":",
            diagnostic->severity == RT_ERROR ? 1 : 2, diagnostic->code);
    json_write_text(out, message, strlen(message));
    putc('}', out);
    evaluation->has_one = true;
}

static void on_message(void *client, rt_stream stream, const char *text, size_t length)
{
    Evaluation *evaluation = client;
    size_t prefix = sizeof mark - 1;
    if (stream == RT_STREAM_DEBUG && length > prefix && memcmp(text, mark, prefix) == 0) {
        length -= prefix + (text[length - 1] == '\n');
        length = length < sizeof evaluation->value ? length : sizeof evaluation->value - 1;
        memcpy(evaluation->value, text + prefix, length);
        evaluation->value[length] = '\0';
    }
}

// A session with the server's options; NULL: there is none.
static rt_session *open_session(const Server *server, Evaluation *evaluation)
{
    rt_callbacks callbacks = {evaluation, on_diagnostic, on_message, NULL};
    rt_session *session = rt_session_new(&callbacks);
    if (session && run_configure(session, server->options)) {
        rt_session_free(session);
        session = NULL;
    }
    if (session) {
        (void)rt_set_limit(session, RT_LIMIT_STEPS, STEPS_MOST);
        (void)rt_set_limit(session, RT_LIMIT_OBJECTS, OBJECTS_MOST);
    }
    return session;
}

static void evaluate(const Server *server, Evaluation *evaluation, const char *text, size_t length)
{
    rt_session *session = open_session(server, evaluation);
    if (session) {
        (void)rt_load_text(session, evaluation->document->path, text, length);
    }
    rt_session_free(session);
}

static void publish(const Server *server, const Document *document)
{
    Message message;
    if (!message_begin(&message, (Json){NULL, NULL})) {
        return;
    }
    Evaluation evaluation = {.out = message.out, .document = document};
    fputs("{\"jsonrpc\":\"2.0\",\"method\":\"textDocument/publishDiagnostics\",\"params\":{\"uri\":", message.out);
    json_write_text(message.out, document->uri, strlen(document->uri));
    fputs(",\"diagnostics\":[", message.out);
    evaluate(server, &evaluation, document->text, strlen(document->text));
    fputs("]}}", message.out);
    message_end(&message);
}

// ---- notifications

static void on_open(Server *server, Json params)
{
    Document *document = calloc(1, sizeof *document), *old = find_document(server, params);
    if (!document) {
        return;
    }
    document->uri = json_take_text(json_at(params, "textDocument.uri"));
    document->text = json_take_text(json_at(params, "textDocument.text"));
    document->path = document->uri ? text_path_of_uri(document->uri) : NULL;
    if (!document->path && document->uri) {
        document->path = strdup(document->uri); // of another scheme: it includes nothing
    }
    if (!document->uri || !document->text || !document->path || old) {
        free_document(document);
        return;
    }
    document->next = server->documents;
    server->documents = document;
    publish(server, document);
}

static void on_change(Server *server, Json params)
{
    Document *document = find_document(server, params);
    char *text = document ? json_take_text(json_at(params, "contentChanges.$.text")) : NULL;
    if (text) {
        free(document->text);
        document->text = text;
        publish(server, document);
    }
}

static void on_close(Server *server, Json params)
{
    Document *document = find_document(server, params), **at = &server->documents;
    while (document && *at != document) {
        at = &(*at)->next;
    }
    if (document) {
        *at = document->next;
        free_document(document);
    }
}

static void on_exit_now(Server *server, Json params)
{
    (void)params;
    server->is_over = true;
}

// ---- questions

static void on_initialize(Server *server, Json id, Json params)
{
    (void)server, (void)params;
    char members[512];
    snprintf(members, sizeof members,
             "\"result\":{\"capabilities\":{\"textDocumentSync\":1,\"hoverProvider\":true,\"definitionProvider\":true,"
             "\"completionProvider\":{},\"documentFormattingProvider\":true},"
             "\"serverInfo\":{\"name\":\"rtlang\",\"version\":\"%s\"}}",
             rt_version());
    answer(id, members);
}

static void on_shutdown(Server *server, Json id, Json params)
{
    (void)params;
    server->is_shut = true;
    answer(id, "\"result\":null");
}

// The value that a name has at the end of a line, as far as it is a number, a vector or a string.
static void find_value(const Server *server, Evaluation *evaluation, Word name, const char *line_end)
{
    static const struct {
        const char *before, *behind;
    } forms[] = {{"str(", ", 0, -1)"}, {"\"<\", vstr(3, ", ", \", \", 0, -1), \">\""}, {"\"\\\"\", ", ", \"\\\"\""}};
    const char *text = evaluation->document->text, *places[] = {line_end, text + strlen(text)};
    for (size_t i = 0; i < RT_COUNT_OF(places) && !evaluation->value[0]; i++) {
        for (size_t k = 0; k < RT_COUNT_OF(forms) && !evaluation->value[0]; k++) {
            Message probe;
            if (!message_begin(&probe, (Json){NULL, NULL})) {
                return;
            }
            fwrite(text, 1, (size_t)(places[i] - text), probe.out);
            fprintf(probe.out, "\n#debug concat(\"\\n%s\", ", mark);
            fprintf(probe.out, "%s%.*s%s", forms[k].before, (int)name.length, name.begin, forms[k].behind);
            fprintf(probe.out, ", \"\\n\")\n%s", places[i]);
            if (fclose(probe.out) == 0) {
                evaluate(server, evaluation, probe.text, probe.length);
            }
            free(probe.text);
        }
    }
}

static void write_docs(FILE *out, Word word)
{
    rt_word one;
    const char *before = "";
    for (size_t i = 0; rt_get_word(i, &one); i++) {
        if (strlen(one.word) == word.length && memcmp(one.word, word.begin, word.length) == 0) {
            fprintf(out, "%s**%s**%s%s: %s", before, one.word, one.place[0] ? " in " : "", one.place, one.doc);
            before = "\n\n";
        }
    }
}

static void write_hover(const Server *server, const Document *document, Word word, FILE *out)
{
    Word declared = text_find_declared(document->text, word, word.begin);
    if (!declared.begin) {
        write_docs(out, word);
        return;
    }
    const char *line = declared.begin;
    while (line > document->text && line[-1] != '\n') {
        line--;
    }
    fprintf(out, "```\n%.*s\n```", (int)strcspn(line, "\r\n"), line);
    Evaluation evaluation = {.document = document};
    find_value(server, &evaluation, word, word.begin + strcspn(word.begin, "\n"));
    if (evaluation.value[0]) {
        fprintf(out, "\n\n%.*s = %s", (int)word.length, word.begin, evaluation.value);
    }
}

// The word that a request points to.
static Word word_of(const Document *document, Json params, const char **at)
{
    Position position = {json_take_count(json_at(params, "position.line")),
                         json_take_count(json_at(params, "position.character"))};
    if (!document || position.line < 0 || position.character < 0) {
        return (Word){NULL, 0};
    }
    *at = text_at(document->text, position);
    return text_word(document->text, *at);
}

static void on_hover(Server *server, Json id, Json params)
{
    const Document *document = find_document(server, params);
    const char *at;
    Word word = word_of(document, params, &at);
    char *text = NULL;
    size_t length = 0;
    FILE *out = word.length > 0 ? open_memstream(&text, &length) : NULL;
    if (out) {
        write_hover(server, document, word, out);
        fclose(out);
    }
    Message message;
    if (length > 0 && message_begin(&message, id)) {
        fputs("\"result\":{\"contents\":{\"kind\":\"markdown\",\"value\":", message.out);
        json_write_text(message.out, text, length);
        fputs("}}}", message.out);
        message_end(&message);
    } else {
        answer(id, "\"result\":null");
    }
    free(text);
}

// A file's whole text; NULL: it cannot be read.
static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rbe");
    char *text = NULL;
    size_t length = 0;
    FILE *out = file ? open_memstream(&text, &length) : NULL;
    for (int c; out && length < FILE_MOST && (c = getc(file)) != EOF;) {
        putc(c ? c : ' ', out);
    }
    if (out) {
        fclose(out);
    }
    if (file) {
        fclose(file);
    }
    return text;
}

// Answers with the place of a name in a text.
static void answer_place(Json id, const char *path, const char *text, Word found)
{
    Message message;
    if (message_begin(&message, id)) {
        fputs("\"result\":{\"uri\":", message.out);
        text_write_uri(message.out, path);
        fputs(",\"range\":", message.out);
        text_write_range(message.out, text, found.begin, found.begin + found.length);
        fputs("}}", message.out);
        message_end(&message);
    }
}

// Looks for a name in a file that the document includes, in the folder of the document or one that is searched.
static bool answer_from_file(const Server *server, const Document *document, Json id, Word name, Word file)
{
    Evaluation evaluation = {.document = document};
    rt_session *session = open_session(server, &evaluation);
    const char *slash = strrchr(document->path, '/'), *folder = "";
    bool is_found = false;
    for (size_t i = 0; session && !is_found && folder; i++) {
        char path[PATH_MAX];
        int folder_length = i == 0 ? (int)(slash ? slash - document->path : 0) : (int)strlen(folder);
        snprintf(path, sizeof path, "%.*s/%.*s", folder_length, i == 0 ? document->path : folder, (int)file.length, file.begin);
        char *text = read_file(path);
        Word found = text ? text_find_declared(text, name, text) : (Word){NULL, 0};
        if (found.begin) {
            answer_place(id, path, text, found);
            is_found = true;
        }
        free(text);
        folder = rt_include_path(session, i);
    }
    rt_session_free(session);
    return is_found;
}

static void on_definition(Server *server, Json id, Json params)
{
    const Document *document = find_document(server, params);
    const char *at;
    Word word = word_of(document, params, &at), found = {NULL, 0};
    bool is_answered = false;
    if (word.length > 0) {
        found = text_find_declared(document->text, word, word.begin);
    }
    if (found.begin) {
        answer_place(id, document->path, document->text, found);
        return;
    }
    for (Word file = word.length > 0 ? text_next_include(document->text) : word; file.length > 0 && !is_answered;
         file = text_next_include(file.begin)) {
        is_answered = answer_from_file(server, document, id, word, file);
    }
    if (!is_answered) {
        answer(id, "\"result\":null");
    }
}

static void write_item(FILE *out, bool *has_one, Word label, int kind, const char *detail)
{
    fprintf(out, "%s{\"label\":", *has_one ? "," : "");
    json_write_text(out, label.begin, label.length);
    fprintf(out, ",\"kind\":%d,\"detail\":", kind);
    json_write_text(out, detail, strlen(detail));
    putc('}', out);
    *has_one = true;
}

// Words of the language and names of the document that begin as the word does, up to the cursor.
static void on_completion(Server *server, Json id, Json params)
{
    enum { KIND_VARIABLE = 6, KIND_KEYWORD = 14 };
    const Document *document = find_document(server, params);
    const char *at = NULL;
    Word word = word_of(document, params, &at);
    Message message;
    if (!at || !message_begin(&message, id)) {
        answer(id, "\"result\":null");
        return;
    }
    size_t typed = word.length > 0 ? (size_t)(at - word.begin) : 0;
    bool has_one = false;
    rt_word one;
    fputs("\"result\":{\"isIncomplete\":false,\"items\":[", message.out);
    for (size_t i = 0; rt_get_word(i, &one); i++) {
        char detail[256];
        snprintf(detail, sizeof detail, "%s%s%s", one.place, one.place[0] ? ": " : "", one.doc);
        if (strncmp(one.word, word.begin, typed) == 0) {
            write_item(message.out, &has_one, (Word){one.word, strlen(one.word)}, KIND_KEYWORD, detail);
        }
    }
    for (Word next = text_next_declared(document->text); next.length > 0; next = text_next_declared(next.begin)) {
        Word first = text_find_declared(document->text, next, document->text);
        bool is_first = first.begin == next.begin && next.begin != word.begin;
        if (is_first && next.length >= typed && strncmp(next.begin, word.begin, typed) == 0) {
            write_item(message.out, &has_one, next, KIND_VARIABLE, "declared");
        }
    }
    fputs("]}}", message.out);
    message_end(&message);
}

static void on_formatting(Server *server, Json id, Json params)
{
    const Document *document = find_document(server, params);
    Evaluation evaluation = {.document = document};
    rt_session *session = document ? open_session(server, &evaluation) : NULL;
    const char *text = "";
    Message message;
    bool fine = session && rt_format_text(session, document->path, document->text, strlen(document->text), &text) == RT_OK;
    if (fine && message_begin(&message, id)) {
        fputs("\"result\":[{\"range\":", message.out);
        text_write_range(message.out, document->text, document->text, document->text + strlen(document->text));
        fputs(",\"newText\":", message.out);
        json_write_text(message.out, text, strlen(text));
        fputs("}]}", message.out);
        message_end(&message);
    } else {
        answer(id, "\"result\":null");
    }
    rt_session_free(session);
}

// ---- the loop

static void dispatch(Server *server, Json whole)
{
    static const struct {
        const char *method;
        void (*run)(Server *server, Json params);
    } notifications[] = {{"textDocument/didOpen", on_open},
                         {"textDocument/didChange", on_change},
                         {"textDocument/didClose", on_close},
                         {"exit", on_exit_now}};
    static const struct {
        const char *method;
        void (*run)(Server *server, Json id, Json params);
    } requests[] = {{"initialize", on_initialize},
                    {"shutdown", on_shutdown},
                    {"textDocument/hover", on_hover},
                    {"textDocument/definition", on_definition},
                    {"textDocument/completion", on_completion},
                    {"textDocument/formatting", on_formatting}};
    char *method = json_take_text(json_at(whole, "method"));
    Json id = json_at(whole, "id"), params = json_at(whole, "params");
    bool is_known = !method; // an answer to nothing that was asked
    for (size_t i = 0; method && !id.begin && i < RT_COUNT_OF(notifications); i++) {
        if (strcmp(method, notifications[i].method) == 0) {
            notifications[i].run(server, params);
        }
    }
    for (size_t i = 0; method && id.begin && !is_known && i < RT_COUNT_OF(requests); i++) {
        is_known = strcmp(method, requests[i].method) == 0;
        if (is_known) {
            requests[i].run(server, id, params);
        }
    }
    if (!is_known && id.begin) {
        answer(id, "\"error\":{\"code\":-32601,\"message\":\"rtlang does not know this method\"}");
    }
    free(method);
}

// The length that the header of the next message says; -1: there is none any more, or it says none.
static long read_header(void)
{
    char line[256];
    long length = -1;
    while (fgets(line, sizeof line, stdin)) {
        if (line[0] == '\r' || line[0] == '\n') {
            return length;
        }
        if (strncasecmp(line, "Content-Length:", 15) == 0) {
            length = strtol(line + 15, NULL, 10);
        }
    }
    return -1;
}

int lsp_run(const Options *options)
{
    Server server = {.options = options};
    while (!server.is_over) {
        long length = read_header();
        char *text = length >= 0 && length <= MESSAGE_MOST ? malloc((size_t)length + 1) : NULL;
        if (!text || fread(text, 1, (size_t)length, stdin) != (size_t)length) {
            free(text);
            break;
        }
        text[length] = '\0';
        Json whole = json_whole(text, (size_t)length);
        if (whole.begin) {
            dispatch(&server, whole);
        } else {
            static const char none[] = "null";
            answer((Json){none, none + 4}, "\"error\":{\"code\":-32700,\"message\":\"this is not JSON\"}");
        }
        free(text);
    }
    while (server.documents) {
        Document *next = server.documents->next;
        free_document(server.documents);
        server.documents = next;
    }
    return server.is_shut ? 0 : 1;
}
