// Tests of base/diag.h: counting, keeping, and the exact text form.
//
// SPDX-License-Identifier: MIT
#include <stdint.h>
#include <string.h>

#include "base/diag.h"
#include "unit/tap.h"

static const char scene[] = "Atom(<0,0,0>)\n"                      // 1
                            "sphere {\n"                           // 2
                            "    raduis 2\n"                       // 3
                            "\t\tpigment\t{ }\r\n"                 // 4
                            "// \xC3\xA4\xC3\xB6 \xE2\x82\xAC x\n" // 5: two of 2 bytes, one of 3
                            "a\x1B[31m\x80 b\n"                    // 6
                            "last";                                // 7

typedef struct Fixture {
    SourceMap *map;
    uint64_t base;
    DiagSink sink;
    TextBuffer out;
} Fixture;

static void fixture_init(Fixture *fixture)
{
    fixture->map = source_map_new();
    Source *source = source_open_text(fixture->map, "scene.scn", scene, sizeof(scene) - 1);
    fixture->base = source_base(source);
    diag_init(&fixture->sink, fixture->map);
    text_init(&fixture->out);
}

static void fixture_fini(Fixture *fixture)
{
    text_fini(&fixture->out);
    diag_fini(&fixture->sink);
    source_map_free(fixture->map);
}

// The span of a piece of the scene.
static Span span_of(const Fixture *fixture, const char *piece)
{
    uint64_t begin = fixture->base + (uint64_t)(strstr(scene, piece) - scene);
    return (Span){begin, begin + strlen(piece)};
}

static void expect_printed(Fixture *fixture, const char *expected, const char *name)
{
    text_clear(&fixture->out);
    diag_print(&fixture->sink, &fixture->sink.items[fixture->sink.count - 1], false, &fixture->out);
    if (!tap_ok(strcmp(text_get(&fixture->out), expected) == 0, "%s", name)) {
        printf("# got:\n%s# expected:\n%s", text_get(&fixture->out), expected);
    }
}

static void test_whole_form(void)
{
    Fixture fixture;
    fixture_init(&fixture);
    DiagFrame frame = {.what = "in macro", .name = "Atom", .span = span_of(&fixture, "Atom")};
    fixture.sink.frame = &frame;
    tap_ok(diag_report(&fixture.sink, DIAG_E0106, span_of(&fixture, "raduis"), "unknown property `%s` in sphere",
                       "raduis"),
           "the first report is kept");
    diag_suggest(&fixture.sink, "did you mean `%s`?", "sphere");
    diag_suggest(&fixture.sink, "did you mean `%s`?", "radius");
    expect_printed(&fixture,
                   "scene.scn:3:5: error[E0106]: unknown property `raduis` in sphere\n"
                   "   3 |     raduis 2\n"
                   "     |     ^~~~~~\n"
                   "     = help: did you mean `radius`?\n"
                   "scene.scn:1:1: note: in macro `Atom`, called here\n"
                   "   1 | Atom(<0,0,0>)\n"
                   "     | ^~~~\n",
                   "message, line, caret, help, call stack");
    diag_note(&fixture.sink, span_of(&fixture, "sphere"), "the block begins here");
    diag_note(&fixture.sink, SPAN_NONE, "a fact without a place");
    const Diag *diag = &fixture.sink.items[0];
    tap_ok(diag->note_count == 3 && strcmp(diag->notes[0].message, "the block begins here") == 0 &&
               strcmp(diag->notes[1].message, "a fact without a place") == 0 &&
               strcmp(diag->notes[2].message, "in macro `Atom`, called here") == 0,
           "notes stand before the call stack, in order");
    expect_printed(&fixture,
                   "scene.scn:3:5: error[E0106]: unknown property `raduis` in sphere\n"
                   "   3 |     raduis 2\n"
                   "     |     ^~~~~~\n"
                   "     = help: did you mean `radius`?\n"
                   "scene.scn:2:1: note: the block begins here\n"
                   "   2 | sphere {\n"
                   "     | ^~~~~~\n"
                   "     = note: a fact without a place\n"
                   "scene.scn:1:1: note: in macro `Atom`, called here\n"
                   "   1 | Atom(<0,0,0>)\n"
                   "     | ^~~~\n",
                   "notes with and without a place");
    fixture_fini(&fixture);
}

static void test_lines(void)
{
    static const struct {
        const char *piece, *expected, *name;
    } cases[] = {
        {"pigment", "scene.scn:4:3: error[E0101]: m\n   4 | \t\tpigment\t{ }\n     | \t\t^~~~~~~\n", "tabs are kept"},
        {"{ }\r\n//", "scene.scn:4:11: error[E0101]: m\n   4 | \t\tpigment\t{ }\n     | \t\t       \t^~~\n",
         "a span over a line's end stops there, CRLF is dropped"},
        {"\xE2\x82\xAC x",
         "scene.scn:5:7: error[E0101]: m\n   5 | // \xC3\xA4\xC3\xB6 \xE2\x82\xAC x\n     |       ^~~\n",
         "columns and carets count characters"},
        {"b\nlast", "scene.scn:6:9: error[E0101]: m\n   6 | a?[31m? b\n     |         ^\n",
         "control characters and stray bytes are not printed"},
        {"last", "scene.scn:7:1: error[E0101]: m\n   7 | last\n     | ^~~~\n", "a last line without its end"},
    };
    Fixture fixture;
    fixture_init(&fixture);
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        if (!diag_report(&fixture.sink, DIAG_E0101, span_of(&fixture, cases[i].piece), "m")) {
            tap_ok(false, "kept");
        }
        expect_printed(&fixture, cases[i].expected, cases[i].name);
    }
    uint64_t end = fixture.base + sizeof(scene) - 1;
    tap_ok(diag_report(&fixture.sink, DIAG_E0107, (Span){end, end}, "unexpected end"), "kept");
    expect_printed(&fixture, "scene.scn:7:5: error[E0107]: unexpected end\n   7 | last\n     |     ^\n",
                   "the end of the text has a place");
    fixture_fini(&fixture);
}

static void test_without_place(void)
{
    Fixture fixture;
    fixture_init(&fixture);
    DiagSink *sink = &fixture.sink;
    tap_ok(diag_report(sink, DIAG_E0501, SPAN_NONE, "cannot find `a\nb\x1B.scn`"), "kept");
    expect_printed(&fixture, "rtlang: error[E0501]: cannot find `a?b?.scn`\n",
                   "no place, and one line whatever is in it");
    tap_ok(diag_report(sink, DIAG_E0501, (Span){1u << 20, 1u << 20}, "far"), "kept");
    expect_printed(&fixture, "rtlang: error[E0501]: far\n", "a place in no text");
    fixture_fini(&fixture);
    diag_init(sink, NULL);
    text_init(&fixture.out);
    tap_ok(diag_report(sink, DIAG_E0602, (Span){1, 2}, "no sources"), "kept");
    expect_printed(&fixture, "rtlang: error[E0602]: no sources\n", "a sink without sources");
    diag_fini(sink);
    text_fini(&fixture.out);
}

static void test_frames(void)
{
    Fixture fixture;
    DiagFrame frames[11];
    fixture_init(&fixture);
    for (size_t i = 0; i < RT_COUNT_OF(frames); i++) {
        frames[i] = (DiagFrame){i > 0 ? &frames[i - 1] : NULL, "in macro", "M", span_of(&fixture, "Atom")};
    }
    frames[9] = (DiagFrame){&frames[8], "included", "colors.inc", span_of(&fixture, "sphere")};
    frames[10] = (DiagFrame){&frames[9], "in #while", NULL, SPAN_NONE};
    fixture.sink.frame = &frames[10];
    tap_ok(diag_report(&fixture.sink, DIAG_E0106, SPAN_NONE, "deep"), "kept");
    const Diag *diag = &fixture.sink.items[0];
    tap_ok(diag->note_count == 9, "eight frames and one note for the rest");
    tap_ok(strcmp(diag->notes[0].message, "in #while here") == 0, "innermost first, without a name");
    tap_ok(strcmp(diag->notes[1].message, "included `colors.inc` here") == 0, "an include");
    tap_ok(strcmp(diag->notes[2].message, "in macro `M`, called here") == 0, "a macro");
    tap_ok(strcmp(diag->notes[8].message, "and 3 more") == 0 && !span_exists(diag->notes[8].span), "and 3 more");
    fixture.sink.frame = NULL;
    tap_ok(diag_report(&fixture.sink, DIAG_E0106, SPAN_NONE, "flat") && fixture.sink.items[1].note_count == 0,
           "no frames, no notes");
    diag_note(&fixture.sink, SPAN_NONE, "one");
    tap_ok(fixture.sink.items[1].note_count == 1 && fixture.sink.items[0].note_count == 9,
           "notes go to the last record");
    fixture_fini(&fixture);
}

static void test_counting(void)
{
    DiagSink sink;
    diag_init(&sink, NULL);
    tap_ok(sink.class == CLASS_NONE && !diag_is_full(&sink), "an empty sink");
    sink.keep_errors = 3;
    int kept = 0;
    for (int i = 0; i < 10; i++) {
        kept += diag_report(&sink, i == 0 ? DIAG_E0501 : DIAG_E0250, SPAN_NONE, "error %d", i);
        if (i == 2) {
            tap_ok(!diag_is_full(&sink), "as many errors as are kept do not stop the work");
        }
    }
    tap_ok(kept == 3 && sink.count == 3 && sink.error_count == 10, "errors beyond keep_errors are only counted");
    tap_ok(diag_is_full(&sink) && sink.class == CLASS_IO, "full; the class is that of the first error");
    (void)diag_report(&sink, DIAG_E0601, SPAN_NONE, "a limit");
    (void)diag_report(&sink, DIAG_E0501, SPAN_NONE, "a file");
    tap_ok(sink.class == CLASS_LIMIT, "or that of a limit");
    diag_fini(&sink);
    tap_ok(sink.count == 0 && sink.error_count == 0 && sink.class == CLASS_NONE, "fini empties");
    sink.keep_errors = 0;
    tap_ok(!diag_report(&sink, DIAG_E0601, SPAN_NONE, "x") && sink.class == CLASS_LIMIT,
           "the first error need not be kept");
    diag_fini(&sink);
}

static void test_codes(void)
{
    bool is_sound = true;
    for (int i = 0; i < DIAG_CODE_COUNT; i++) {
        const char *name = diag_code_name((DiagCode)i);
        is_sound = is_sound && strlen(name) == 5 && (name[0] == 'E' || name[0] == 'W') &&
                   strlen(diag_code_summary((DiagCode)i)) > 0;
        for (int k = 0; k < i; k++) {
            is_sound = is_sound && strcmp(name, diag_code_name((DiagCode)k)) != 0;
        }
    }
    tap_ok(is_sound, "every code has its own name and a summary");
    tap_ok(strcmp(diag_code_name(DIAG_E0102), "E0102") == 0, "a name");
    tap_ok(strcmp(diag_code_summary(DIAG_E0102), "unterminated string") == 0, "a summary");
    for (int i = 0; i < DIAG_CODE_COUNT; i++) {
        DiagSink sink;
        diag_init(&sink, NULL);
        bool is_error = diag_code_name((DiagCode)i)[0] == 'E';
        bool is_on = diag_report(&sink, (DiagCode)i, SPAN_NONE, "m");
        is_sound = is_sound && is_on == !diag_code_is_extra((DiagCode)i) && diag_set_warning(&sink, "all") &&
                   (is_on || diag_report(&sink, (DiagCode)i, SPAN_NONE, "m"));
        is_sound = is_sound && sink.error_count == (is_error ? 1 : 0) &&
                   sink.warning_count == (is_error ? 0 : 1) && (sink.class == CLASS_NONE) == !is_error;
        diag_fini(&sink);
    }
    tap_ok(is_sound, "E is an error with a class, W a warning without");
}

int main(void)
{
    test_whole_form();
    test_lines();
    test_without_place();
    test_frames();
    test_counting();
    test_codes();
    return tap_done();
}
