// The top level: a scene's text, item by item, becomes scene records.
//
// Sets up the state of an evaluation, declares what stands declared before the first item, and decides in the end what
// the scene's version means for its gamma. Knows nothing of single directives or kinds of blocks.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "eval/build/blocks.h"
#include "eval/build/painted.h"
#include "eval/build/plan.h"
#include "eval/build/probe.h"
#include "eval/eval.h"
#include "eval/values/kept.h"

// Levels of native recursion for each level that a text may nest: room for calls within calls.
enum { DEEPENING_PER_AST_LEVEL = 6 };

// Identifiers that POV-Ray declares; a scene may change them. There is no animation, so its variables are zero.
static const char *const zeros[] = {
    "clock_delta", "initial_clock", "final_clock", "initial_frame", "final_frame", "frame_number",
};

static bool take_item(void *client, const AstNode *item)
{
    Eval *ev = client;
    eval_tell_statement(ev, item->span);
    ev->tells_plan = true;
    lint_items(ev, item);
    eval_item(ev, item);
    return !eval_cancelled(ev);
}

// ---- before the first item

// Of two declarations of a name the first counts, and none may be a reserved word, as in POV-Ray.
static bool declare(Eval *ev, const EvalDeclaration *declaration)
{
    Symbol name = intern_text(ev->options.names, declaration->name, strlen(declaration->name));
    if (name == SYMBOL_NONE) {
        return false;
    }
    if (word_class(name) != WORD_IDENTIFIER || scope_find(ev, name) != NULL) {
        return true;
    }
    Value value = value_of_number(declaration->number);
    if (declaration->text != NULL) {
        value.kind = VALUE_STRING;
        value.text = declaration->text;
        value.length = strlen(declaration->text);
    }
    return scope_declare(ev, name, false, &value, SPAN_NONE);
}

static bool declare_all(Eval *ev, const Source *source)
{
    const EvalOptions *options = &ev->options;
    // As in POV-Ray: the name without its folder.
    const char *slash = strrchr(source_name(source), '/');
    const EvalDeclaration own[] = {
        {.name = "image_width", .number = options->image_width},
        {.name = "image_height", .number = options->image_height},
        {.name = "input_file_name", .text = slash != NULL ? slash + 1 : source_name(source)},
    };
    bool fine = true;
    for (size_t i = 0; i < options->declaration_count; i++) {
        fine = fine && declare(ev, &options->declarations[i]);
    }
    for (size_t i = 0; i < RT_COUNT_OF(own); i++) {
        fine = fine && declare(ev, &own[i]);
    }
    for (size_t i = 0; i < RT_COUNT_OF(zeros); i++) {
        fine = fine && declare(ev, &(EvalDeclaration){.name = zeros[i]});
    }
    return fine;
}

// ---- the whole

static void init(Eval *ev, const EvalOptions *options, Scene *scene)
{
    *ev = (Eval){.options = *options,
                 .text = &text_of_scene,
                 .builder = &builder_of_scene,
                 .scene = scene,
                 .version = 3.7,
                 .inner = 1,
                 .errors_before = options->diags->error_count};
    if (options->version > 0.0) {
        ev->version = options->version;
        ev->version_given = true;
    }
    ev->expression_depth_limit = options->limits->ast_depth * DEEPENING_PER_AST_LEVEL;
    ev->memory.limit = limits_memory(options->limits, source_map_bytes(options->sources));
    arena_init_shared(&ev->parse, &ev->memory);
    arena_init_shared(&ev->program, &ev->memory);
    arena_init_shared(&ev->scratch, &ev->memory);
    text_init(&ev->line);
    kept_init(ev);
}

static void fini(Eval *ev)
{
    lint_fini(ev);
    origins_fini(ev);
    plans_fini(ev);
    objects_fini(ev);
    data_files_fini(ev);
    written_files_close(ev); // those that are left after a fault
    files_fini(ev);
    probes_fini(ev);
    painted_fini(ev);
    scope_fini(ev);
    text_fini(&ev->line);
    ARRAY_FREE(&ev->streams);
    ARRAY_FREE(&ev->pasted);
    ARRAY_FREE(&ev->reported);
    kept_fini(ev);
    arena_fini(&ev->scratch);
    arena_fini(&ev->program);
    arena_fini(&ev->parse);
}

// A scene that names no gamma is linear when a #version says that it knows 3.7, and is not converted at all otherwise,
// as in POV-Ray. One without #version is drawn as of before 3.7, too. In old scenes all of the background is behind the
// scene, whatever it says.
static void settle_version(const Eval *ev)
{
    Settings *settings = &ev->scene->settings;
    Rgbft *background = &ev->scene->background;
    settings->version = ev->version_given ? ev->version : SCENE_VERSION_UNSAID;
    if (!eval_knows_37(ev)) {
        double opaque = 1.0 - background->transmit;
        *background = (Rgbft){opaque * background->red, opaque * background->green, opaque * background->blue, 0.0, 0.0};
    }
    if (settings->gamma_model == GAMMA_NONE && eval_knows_37(ev)) {
        settings->gamma_model = GAMMA_LINEAR;
        settings->assumed_gamma = 1.0;
    }
}

static void read_items(Eval *ev, Source *source)
{
    bool is_whole = grammar_parse(ev->grammar, source, take_item, ev);
    ev->faulty = ev->faulty || !is_whole;
}

// The header is included as by the scene's first line; that line is a text of its own, so that lines keep their numbers.
static void read_header(Eval *ev)
{
    TextBuffer text;
    text_init(&text);
    text_printf(&text, "#include \"%s\"\n", ev->options.header);
    Source *source = text.failed ? NULL
                                 : source_open_text(ev->options.sources, "header", text_get(&text), text.length);
    if (source == NULL) {
        eval_no_memory(ev, SPAN_NONE);
    } else {
        read_items(ev, source);
        source_close(source);
    }
    text_fini(&text);
}

bool eval_source(const EvalOptions *options, Source *source, Scene *scene)
{
    Eval ev;
    const DiagFrame *frame = options->diags->frame;
    init(&ev, options, scene);
    options->diags->frame = NULL;
    if (!scene->has_camera && options->world) {
        Transform world = world_transform(&ev);
        scene->camera.location = transform_point(&world, scene->camera.location);
    }
    if (!scope_init(&ev) || !objects_init(&ev) || !files_init(&ev, source) || !lint_init(&ev) || !reading_init(&ev) ||
        !declare_all(&ev, source)) {
        eval_no_memory(&ev, SPAN_NONE);
    } else {
        if (options->header != NULL) {
            read_header(&ev);
        }
        read_items(&ev, source);
        settle_version(&ev);
        ev.faulty = !box_left_out_rightly(&ev) || ev.faulty;
        ev.faulty = !objects_finish(&ev) || ev.faulty;
        lint_finish(&ev);
    }
    if (options->declared != NULL) {
        *options->declared = scope_count(&ev);
    }
    bool is_whole = eval_leaves_out(&ev) || (!ev.faulty && !ev.stop && options->diags->error_count == ev.errors_before);
    fini(&ev);
    options->diags->frame = frame;
    return is_whole;
}
