// Any bytes are read into the same items and messages at once as token by token; the canonical layout of a text without
// faults is one already, of the same tokens.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "grammar/grammar.h"
#include "rtlang/rtlang.h"

typedef struct Outcome {
    InternTable *names;
    TextBuffer text;
    bool is_clean;
} Outcome;

static bool print(void *client, const AstNode *item)
{
    Outcome *outcome = client;
    text_printf(&outcome->text, "%u %llu-%llu ", item->kind, (unsigned long long)item->span.begin,
                (unsigned long long)item->span.end);
    ast_print(item, outcome->names, 0, &outcome->text);
    return true;
}

static void read_text(const char *text, size_t size, bool token_by_token, Outcome *outcome)
{
    Limits limits = LIMITS_DEFAULT;
    Arena arena;
    DiagSink diags;
    SourceMap *sources = source_map_new();
    InternTable *names = intern_new((size_t)64 << 20);
    FUZZ_HOLDS(sources && names && words_intern(names));
    outcome->names = names;
    text_init(&outcome->text);
    diag_init(&diags, sources);
    arena_init(&arena, (size_t)64 << 20);
    GrammarContext context = {names, &arena, &diags, &limits, NULL, token_by_token, NULL};
    Source *source = source_open_text(sources, "fuzz", text, size);
    FUZZ_HOLDS(source != NULL);
    outcome->is_clean = grammar_parse(&context, source, print, outcome);
    source_close(source);
    for (size_t i = 0; i < diags.count; i++) {
        diag_print(&diags, &diags.items[i], false, &outcome->text);
    }
    arena_fini(&arena);
    diag_fini(&diags);
    source_map_free(sources);
    intern_free(names);
}

// The canonical layout, to be freed; NULL when the text has faults.
static char *format(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH], *copy = NULL;
    const char *text = NULL;
    rt_session *session = rt_session_new(NULL);
    int fd = fuzz_file(data, size, path);
    if (session && fd >= 0 && rt_format_file(session, path, &text) == RT_OK && text) {
        copy = strdup(text);
    }
    rt_session_free(session);
    if (fd >= 0) {
        close(fd);
    }
    return copy;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    Outcome quick, slow;
    read_text((const char *)data, size, false, &quick);
    read_text((const char *)data, size, true, &slow);
    FUZZ_HOLDS(quick.is_clean == slow.is_clean && strcmp(text_get(&quick.text), text_get(&slow.text)) == 0);
    text_fini(&quick.text);
    text_fini(&slow.text);
    char *once = format(data, size);
    if (once) {
        char *twice = format((const uint8_t *)once, strlen(once));
        FUZZ_HOLDS(twice && strcmp(once, twice) == 0);
        free(twice);
    }
    free(once);
    return 0;
}
