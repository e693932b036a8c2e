// Runs the language's tests: each case of the files named on the command line is one program and what it must give.
//
//     == name of the case
//     the program
//     -- file lib/x.inc        a file beside it, before the expectations; lib/ is on the include path
//     -- limit steps 1000      a limit of its own: steps, call_depth, include_depth, ast_depth, objects,
//                              text_bytes, message_bytes or string_bytes
//     -- declare N 5           a number declared before the scene begins, as with -D
//     -- writes                files may be written, as with --allow-write=.
//     -- written x.txt         a file that the program has written
//     -- lenient               what rtlang has not is left out, as with --lenient
//     -- warning all           which warnings are told, as after -W; may repeat
//     -- validate              the scene as a whole is looked at, too, as before it is traced
//     -- debug                 the lines that #debug gives, as POV-Ray shows them
//     -- scene                 the scene's dump
//     -- diagnostics           all messages
//     -- faults                place and code of each message, `line:column code`, without what stands in notes
//
// `run_lang --update FILE` writes the file to standard output with the expectations replaced by what came out.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "api/painter.h"
#include "api/probe.h"
#include "ast/words.h"
#include "eval/eval.h"
#include "unit/tap.h"

enum { SECTIONS_MAX = 16 };

typedef struct Section {
    char *header; // after "-- ", or the case's name
    char *text;   // owned by the file's text
    size_t length;
} Section;

typedef struct Case {
    Section sections[SECTIONS_MAX]; // 0: the program
    size_t count;
} Case;

typedef struct Outcome {
    TextBuffer debug, scene, diagnostics, faults, written;
} Outcome;

static void must(bool condition, const char *what)
{
    if (!condition) {
        printf("Bail out! %s: %s\n", what, strerror(errno));
        exit(1);
    }
}

// ---- reading test files

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    must(file != NULL, path);
    TextBuffer text;
    text_init(&text);
    char block[4096];
    for (size_t count; (count = fread(block, 1, sizeof block, file)) > 0;) {
        text_append_n(&text, block, count);
    }
    fclose(file);
    must(!text.failed, path);
    text_append(&text, "");
    char *copy = strdup(text_get(&text));
    text_fini(&text);
    must(copy != NULL, path);
    return copy;
}

static bool is_marker(const char *line, const char *marker)
{
    return strncmp(line, marker, 3) == 0;
}

static char *next_line(char *line)
{
    char *end = strchr(line, '\n');
    return end != NULL ? end + 1 : line + strlen(line);
}

// Takes the section that begins at `line`, a marker; the next marker's line is returned.
static char *read_section(char *line, Section *section)
{
    section->header = line + 3;
    char *text = next_line(line);
    char *end = text;
    while (*end != '\0' && !is_marker(end, "== ") && !is_marker(end, "-- ")) {
        end = next_line(end);
    }
    section->header[strcspn(section->header, "\n")] = '\0';
    section->text = text;
    section->length = (size_t)(end - text);
    return end;
}

static char *read_case(char *line, Case *test)
{
    test->count = 0;
    do {
        must(test->count < SECTIONS_MAX, "too many sections");
        line = read_section(line, &test->sections[test->count++]);
    } while (is_marker(line, "-- "));
    return line;
}

// The blank line before the next case belongs to neither.
static size_t trimmed(const Section *section)
{
    size_t length = section->length;
    while (length > 1 && section->text[length - 1] == '\n' && section->text[length - 2] == '\n') {
        length--;
    }
    return length == 1 && section->text[0] == '\n' ? 0 : length;
}

// ---- running a case

static void take_message(void *client, EvalStream stream, const char *text, size_t length)
{
    Outcome *outcome = client;
    if (stream != EVAL_STREAM_WARNING && stream != EVAL_STREAM_ERROR) {
        text_append_n(&outcome->debug, text, length);
    }
}

static void set_limit(Limits *limits, const char *setting)
{
    char name[32];
    unsigned value;
    must(sscanf(setting, "%31s %u", name, &value) == 2, setting);
    if (strcmp(name, "steps") == 0) {
        limits->steps = value;
    } else if (strcmp(name, "call_depth") == 0) {
        limits->call_depth = value;
    } else if (strcmp(name, "include_depth") == 0) {
        limits->include_depth = value;
    } else if (strcmp(name, "message_bytes") == 0) {
        limits->message_bytes = value;
    } else if (strcmp(name, "string_bytes") == 0) {
        limits->string_bytes = value;
    } else if (strcmp(name, "text_bytes") == 0) {
        limits->text_bytes = value;
    } else if (strcmp(name, "objects") == 0) {
        limits->objects = value;
    } else {
        must(strcmp(name, "ast_depth") == 0, setting);
        limits->ast_depth = value;
    }
}

static void write_file(const char *path, const char *text, size_t length)
{
    const char *slash = strchr(path, '/');
    if (slash != NULL) {
        char folder[64];
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        must(mkdir(folder, 0777) == 0 || errno == EEXIST, folder);
    }
    FILE *file = fopen(path, "wb");
    must(file != NULL && fwrite(text, 1, length, file) == length && fclose(file) == 0, path);
}

static void prepare(const Case *test, Limits *limits, bool removes)
{
    for (size_t i = 1; i < test->count; i++) {
        const Section *section = &test->sections[i];
        if (strncmp(section->header, "file ", 5) == 0) {
            const char *path = section->header + 5;
            if (removes) {
                must(remove(path) == 0, path);
            } else {
                write_file(path, section->text, section->length);
            }
        } else if (strncmp(section->header, "limit ", 6) == 0 && !removes) {
            set_limit(limits, section->header + 6);
        }
    }
}

// The names are written into `names`, the declarations into `declarations`, one for each section at most.
static size_t read_declarations(const Case *test, char names[][32], EvalDeclaration *declarations)
{
    size_t count = 0;
    for (size_t i = 1; i < test->count; i++) {
        const char *header = test->sections[i].header;
        if (strncmp(header, "declare ", 8) == 0) {
            must(sscanf(header, "declare %31s %lf", names[count], &declarations[count].number) == 2, header);
            declarations[count].name = names[count];
            count++;
        }
    }
    return count;
}

static void list_fault(DiagSink *diags, const Diag *diag, TextBuffer *out)
{
    SourceLocation at;
    if (source_locate(diags->sources, diag->span, &at)) {
        text_printf(out, "%s%s%llu:%llu ", strcmp(at.name, "test.scn") == 0 ? "" : at.name,
                    strcmp(at.name, "test.scn") == 0 ? "" : ":", (unsigned long long)at.line,
                    (unsigned long long)at.column);
    }
    text_printf(out, "%s\n", diag->code < DIAG_CODE_COUNT ? diag_code_name(diag->code) : diag->message);
}

static void set_warnings(const Case *test, DiagSink *diags)
{
    for (size_t i = 1; i < test->count; i++) {
        const char *header = test->sections[i].header;
        if (strncmp(header, "warning ", 8) == 0) {
            must(diag_set_warning(diags, header + 8), header);
        }
    }
}

static bool wants(const Case *test, const char *header)
{
    for (size_t i = 1; i < test->count; i++) {
        if (strcmp(test->sections[i].header, header) == 0) {
            return true;
        }
    }
    return false;
}

static void evaluate(const Case *test, const Limits *limits, Outcome *outcome)
{
    char declared_names[SECTIONS_MAX][32];
    EvalDeclaration declarations[SECTIONS_MAX] = {{0}};
    static const char *const folders[] = {"lib"};
    SourceMap *sources = source_map_new();
    InternTable *names = intern_new(limits->memory_bytes);
    DiagSink diags;
    Scene scene;
    diag_init(&diags, sources);
    set_warnings(test, &diags);
    scene_init(&scene);
    must(sources != NULL && names != NULL && words_intern(names), "no memory");
    Source *source = source_open_text(sources, "test.scn", test->sections[0].text, trimmed(&test->sections[0]));
    must(source != NULL, "no memory");
    EvalOptions options = {
        .sources = sources,
        .names = names,
        .diags = &diags,
        .limits = limits,
        .include_paths = folders,
        .include_path_count = 1,
        .declarations = declarations,
        .declaration_count = read_declarations(test, declared_names, declarations),
        .image_width = 320,
        .image_height = 240,
        .write_folders = (const char *const[]){"."},
        .write_folder_count = wants(test, "writes"),
        .is_lenient = wants(test, "lenient"),
        .tracer = &probe_tracer,
        .painter = &painter,
        .message = take_message,
        .client = outcome,
    };
    if (!eval_source(&options, source, &scene) && diags.error_count == 0) {
        text_append(&outcome->diagnostics, "evaluation failed without a message\n");
    }
    scene.whole = SPAN_WHOLE(source_base(source));
    if (wants(test, "validate") && !scene_validate(&scene, &diags, 2) && diags.error_count == 0) {
        text_append(&outcome->diagnostics, "validation failed without a message\n");
    }
    diag_finish(&diags);
    for (size_t i = 0; i < diags.count; i++) {
        diag_print(&diags, &diags.items[i], false, &outcome->diagnostics);
        list_fault(&diags, &diags.items[i], &outcome->faults);
    }
    scene_dump(&scene, &outcome->scene);
    source_close(source);
    scene_fini(&scene);
    diag_fini(&diags);
    intern_free(names);
    source_map_free(sources);
}

static void take_written(const Case *test, Outcome *outcome)
{
    for (size_t i = 1; i < test->count; i++) {
        const char *header = test->sections[i].header;
        if (strncmp(header, "written ", 8) == 0) {
            char *text = read_file(header + 8);
            text_append(&outcome->written, text);
            free(text);
            must(remove(header + 8) == 0, header);
        }
    }
}

static void run(const Case *test, Outcome *outcome)
{
    Limits limits = LIMITS_DEFAULT;
    text_init(&outcome->debug);
    text_init(&outcome->scene);
    text_init(&outcome->diagnostics);
    text_init(&outcome->faults);
    text_init(&outcome->written);
    prepare(test, &limits, false);
    evaluate(test, &limits, outcome);
    take_written(test, outcome);
    prepare(test, &limits, true);
}

static void outcome_fini(Outcome *outcome)
{
    text_fini(&outcome->debug);
    text_fini(&outcome->scene);
    text_fini(&outcome->diagnostics);
    text_fini(&outcome->faults);
    text_fini(&outcome->written);
}

static const TextBuffer *outcome_of(const Outcome *outcome, const char *header)
{
    return strcmp(header, "debug") == 0         ? &outcome->debug
           : strcmp(header, "scene") == 0       ? &outcome->scene
           : strcmp(header, "diagnostics") == 0 ? &outcome->diagnostics
           : strcmp(header, "faults") == 0      ? &outcome->faults
           : strncmp(header, "written ", 8) == 0 ? &outcome->written
                                                : NULL;
}

// ---- the two ways to use it

static void print_as_comment(const char *title, const char *text, size_t length)
{
    printf("# %s:\n", title);
    for (const char *end = text + length; text < end;) {
        size_t line = strcspn(text, "\n");
        line = line < (size_t)(end - text) ? line : (size_t)(end - text);
        printf("#   %.*s\n", (int)line, text);
        text += line + 1;
    }
}

static void check_section(const Section *section, const TextBuffer *got, const char *file, const char *name)
{
    size_t length = trimmed(section);
    bool is_same = length == got->length && memcmp(section->text, text_get(got), length) == 0;
    if (!tap_ok(is_same, "%s: %s: %s", file, name, section->header)) {
        print_as_comment("expected", section->text, length);
        print_as_comment("got", text_get(got), got->length);
    }
}

// A case that expects no messages must have none.
static void check_case(const Case *test, const char *file)
{
    Outcome outcome;
    bool expects_messages = false;
    run(test, &outcome);
    for (size_t i = 1; i < test->count; i++) {
        const TextBuffer *got = outcome_of(&outcome, test->sections[i].header);
        expects_messages = expects_messages || got == &outcome.diagnostics || got == &outcome.faults;
        if (got != NULL) {
            check_section(&test->sections[i], got, file, test->sections[0].header);
        }
    }
    if (!expects_messages && outcome.diagnostics.length > 0) {
        tap_ok(false, "%s: %s: no messages", file, test->sections[0].header);
        print_as_comment("got", text_get(&outcome.diagnostics), outcome.diagnostics.length);
    }
    outcome_fini(&outcome);
}

static void update_case(const Case *test)
{
    Outcome outcome;
    run(test, &outcome);
    for (size_t i = 0; i < test->count; i++) {
        const Section *section = &test->sections[i];
        const TextBuffer *got = i > 0 ? outcome_of(&outcome, section->header) : NULL;
        printf("%s %s\n", i > 0 ? "--" : "==", section->header);
        if (got != NULL) {
            fwrite(text_get(got), 1, got->length, stdout);
        } else {
            fwrite(section->text, 1, trimmed(section), stdout);
        }
    }
    putchar('\n');
    outcome_fini(&outcome);
}

static void run_file(const char *path, char *text, bool updates)
{
    const char *slash = strrchr(path, '/');
    char *line = text;
    while (*line != '\0' && !is_marker(line, "== ")) {
        char *next = next_line(line);
        if (updates) {
            fwrite(line, 1, (size_t)(next - line), stdout);
        }
        line = next;
    }
    while (*line != '\0') {
        Case test;
        line = read_case(line, &test);
        if (updates) {
            update_case(&test);
        } else {
            check_case(&test, slash != NULL ? slash + 1 : path);
        }
    }
}

int main(int count, char **arguments)
{
    char folder[] = "/tmp/run_lang.XXXXXX";
    bool updates = count > 1 && strcmp(arguments[1], "--update") == 0;
    int first = updates ? 2 : 1;
    char **texts = calloc((size_t)count, sizeof *texts);
    must(texts != NULL, "no memory");
    for (int i = first; i < count; i++) {
        texts[i] = read_file(arguments[i]);
    }
    // Included files are looked for in the current folder.
    must(mkdtemp(folder) != NULL && chdir(folder) == 0, folder);
    for (int i = first; i < count; i++) {
        run_file(arguments[i], texts[i], updates);
        free(texts[i]);
    }
    free(texts);
    rmdir("lib");
    must(chdir("/") == 0 && rmdir(folder) == 0, folder);
    return updates ? 0 : tap_done();
}
