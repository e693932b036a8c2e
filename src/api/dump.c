// Printable forms of the stages: tokens and AST of a text, records of a scene.
//
// SPDX-License-Identifier: MIT
#include "api/session.h"
#include "ast/ast.h"
#include "grammar/grammar.h"

typedef struct AstDump {
    const InternTable *names;
    TextBuffer *out;
} AstDump;

static bool print_item(void *client, const AstNode *item)
{
    AstDump *dump = client;
    ast_print(item, dump->names, 0, dump->out);
    return !dump->out->failed;
}

typedef struct SyntaxJob {
    rt_syntax stage;
    const char *path;
} SyntaxJob;

static rt_status dump_syntax(rt_session *session, void *argument)
{
    const SyntaxJob *job = argument;
    Source *source;
    if (!session_open(session, job->path, &source)) {
        return session_status(session, false);
    }
    Arena arena;
    MemoryBudget memory = {.limit = session->limits.memory_most};
    arena_init_shared(&arena, &memory);
    GrammarContext context = {session->names, &arena, &session->diags, &session->limits, NULL,
                              session->no_literals, NULL};
    AstDump dump = {session->names, &session->dump};
    bool fine = job->stage == RT_SYNTAX_TOKENS ? grammar_dump_tokens(&context, source, session->sources, &session->dump)
                                               : grammar_parse(&context, source, print_item, &dump);
    source_close(source);
    arena_fini(&arena);
    diag_finish(&session->diags);
    return session_status(session, fine && !session->dump.failed);
}

rt_status rt_dump_syntax(rt_session *session, rt_syntax stage, const char *path, const char **text)
{
    SyntaxJob job = {stage, path};
    text_clear(&session->dump);
    rt_status status = session_run_deep(session, dump_syntax, &job);
    *text = text_get(&session->dump);
    return status;
}

static rt_status dump_scene(rt_session *session, void *argument)
{
    (void)argument;
    scene_dump(&session->scene, &session->dump);
    return session->dump.failed ? session_no_memory(session) : RT_OK;
}

rt_status rt_dump_scene(rt_session *session, const char **text)
{
    text_clear(&session->dump);
    *text = text_get(&session->dump);
    if (!session->loaded || !session_is_whole(session)) {
        return RT_FAULT_USAGE;
    }
    rt_status status = session_run_deep(session, dump_scene, NULL);
    *text = text_get(&session->dump);
    return status;
}
