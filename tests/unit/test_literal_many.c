// Long runs of literal spheres read piece by piece, on one thread or several, give the scene and the messages of reading
// them one by one.
//
// Random texts of thousands of spheres, torn by what is no literal or nearly one, are read one by one, and in pieces of
// text so short that their ends fall anywhere; a new seed each run. Half of them begin with so many
// colours that materials are no longer looked up, and spheres become records side by side. What is compared is the dump
// and all messages, the checks of the whole scene among them. Usage: test_literal_many [texts].
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "ast/words.h"
#include "eval/eval.h"
#include "unit/random.h"
#include "unit/tap.h"

enum { SPHERES_FEW = 6000, SPHERES_MANY = 70000, TEXTS = 8 };

typedef struct Outcome {
    TextBuffer scene, messages;
    size_t spheres, materials;
    bool is_fine;
} Outcome;

static void must(bool condition)
{
    if (!condition) {
        fputs("test_literal_many: out of memory\n", stderr);
        exit(99);
    }
}

static Outcome read_text(const TextBuffer *text, int threads, size_t piece, uint64_t objects)
{
    Limits limits = LIMITS_DEFAULT;
    SourceMap *sources = source_map_new();
    InternTable *names = intern_new(limits.memory_bytes);
    DiagSink diags;
    Scene scene;
    Outcome outcome = {0};
    limits.objects = objects;
    diag_init(&diags, sources);
    scene_init(&scene);
    must(sources != NULL && names != NULL && words_intern(names));
    Source *source = source_open_text(sources, "many.scn", text_get(text), text->length);
    must(source != NULL);
    EvalOptions options = {
        .sources = sources,
        .names = names,
        .diags = &diags,
        .limits = &limits,
        .image_width = 320,
        .image_height = 240,
        .threads = threads,
        .literal_piece = piece,
    };
    outcome.is_fine = eval_source(&options, source, &scene);
    outcome.is_fine = scene_validate(&scene, &diags, threads) && outcome.is_fine;
    diag_finish(&diags);
    for (size_t i = 0; i < diags.count; i++) {
        diag_print(&diags, &diags.items[i], false, &outcome.messages);
    }
    scene_dump(&scene, &outcome.scene);
    outcome.spheres = scene.spheres.count;
    outcome.materials = scene.materials.count;
    source_close(source);
    scene_fini(&scene);
    diag_fini(&diags);
    intern_free(names);
    source_map_free(sources);
    return outcome;
}

// ---- texts

typedef enum Colour { COLOUR_NONE, COLOUR_NEW, COLOUR_ONE_OF_TWO } Colour;

// Statements of the same kind are mostly written alike. Each form takes seven numbers, or eight or nine.
static const char *const forms[] = {
    "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgb <%.4f, %.4f, %.4f> } }\n",
    "sphere{<%.2f,%.3f,%.9f>,%.3f pigment{rgb<%.1f,%.7f,%.2f>}}\n",
    "sphere { <%9.4f, %9.4f, %9.4f>, %9.4f pigment { rgb <%.4f, %.4f, %.4f> } }\n",
    "sphere { <%g, %g, %g>, %g pigment { rgb <%g, %g, %g> } }\n",
    "sphere { <%.0f, %.10f, %.17g>, %.3e pigment { rgb <%.0f, %.8f, %.12f> } }\n",
    "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgb < %.4f, %.4f, %.4f > } }\n",
    "sphere { <%.5f, %.5f, %.5f> , %.4f\npigment { rgb <%.4f, %.4f,           %.4f> } }\n",
    "sphere  {\n  < %.6f, %.6f, %.6f >, %.6f\n  pigment { color rgb <%.6f,%.6f,%.6f> }\n}\n",
    "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgbt <%.4f, %.4f, %.4f, %.4f> } }\n",
    "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgbf <%.4f, %.4f, %.4f, %.2f> } finish { phong 0.5 } }\n",
    "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgbft <%.4f, %.4f, %.4f, %.4f, %.1f> } }\n",
};

// The first one is that of what runs are torn by.
static unsigned pick_form(Random *random)
{
    return random_below(random, 2) == 0 ? 0 : random_below(random, RT_COUNT_OF(forms));
}

static void write_sphere(TextBuffer *text, Random *random, Colour colour, unsigned form)
{
    double n[9];
    for (int i = 0; i < 9; i++) {
        n[i] = i < 3 ? random_between(random, -5, 5) : random_between(random, 0, 1);
    }
    n[3] = 0.01 + 0.09 * n[3];
    if (colour == COLOUR_ONE_OF_TWO) {
        n[4] = 0.5, n[5] = 0.25, n[6] = (double)random_below(random, 2), n[7] = n[8] = 0.25;
    }
    if (colour == COLOUR_NONE) {
        text_printf(text, "sphere { <%.5f, %.5f, %.5f>, %.4f pigment { rgb 1 } finish { phong 0.5 } }\n", n[0], n[1], n[2], n[3]);
        return;
    }
    char line[300];
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
#pragma GCC diagnostic ignored "-Wformat-extra-args"
    snprintf(line, sizeof line, forms[form], n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]);
#pragma GCC diagnostic pop
    text_append(text, line);
}

// What a run of literals is torn by.
static const char *const odd[] = {
    "// sphere { <1, 2, 3>, 1 pigment { rgb <1, 1, 1> } }\n",
    "/* sphere { <1, 2, 3>, 1 */",
    "box { 0, 1 }\n",
    "sphere { <1, 2, 3>, -1 pigment { rgb <1, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1 pigment { rgb <1e31, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1 pigment { rgb <1e39, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1 pigment { rgb <0.5, 0, 1> } }\nsphere { <1, 2, 3>, 1 pigment { rgb <0.5, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1e-30 pigment { rgb <0.5, 0.25, 1> } }\n",
    "sphere { <1e200, 2, 3>, 1 pigment { rgb <0.5, 0.25, 1> } }\n",
    "sphere { x, 1 pigment { rgb <1, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1 pigment { rgb <1, 0, 1> } finish { diffuse 0.25 } }\n",
    "#default { finish { ambient 0.25 } }\n",
    "#declare A = 5;\n",
    "sphere { <1, 2, 3>, 1 pigmnt { rgb <1, 0, 1> } }\n",
    "sphere { <1, 2, 3>, 1 pigment { rgb <1, 0, 1> }\n",
    "union { sphere { <1, 2, 3>, 1 pigment { rgb <1, 0, 1> } } sphere { <1, 2, 3>, 2 } }\n",
    "sky_sphere { pigment { rgb <0.5, 0.5, 1> } }\n",
    "}\n",
};

static void write_text(TextBuffer *text, Random *random, bool has_many_colours)
{
    int count = has_many_colours ? SPHERES_MANY + 6000 : SPHERES_FEW, quiet = has_many_colours ? SPHERES_MANY - 4000 : 4500;
    int sane = quiet + (has_many_colours ? 6000 : 0); // as it is with repeated colours, but torn by nothing yet
    unsigned oddity = 20 + random_below(random, 1500), form = pick_form(random);
    unsigned variety = 2 + random_below(random, 500);
    for (int i = 0; i < count; i++) {
        bool is_plain = i < sane || random_below(random, oddity) > 0;
        if (!is_plain) {
            text_append(text, odd[random_below(random, RT_COUNT_OF(odd))]);
        }
        for (unsigned blanks = random_below(random, 64) == 0 ? random_below(random, 300) : 0; blanks > 0; blanks--) {
            text_append_char(text, " \n\t"[random_below(random, 3)]);
        }
        form = random_below(random, variety) == 0 ? pick_form(random) : form;
        // Where materials are not looked up any more, some are those of the sphere before.
        bool is_repeated = has_many_colours ? i > quiet : random_below(random, 3) > 0;
        write_sphere(text, random, !is_repeated ? (has_many_colours ? COLOUR_NEW : COLOUR_NONE) : COLOUR_ONE_OF_TWO, form);
        if (i > quiet && random_below(random, 40) == 0) {
            write_sphere(text, random, random_below(random, 2) == 0 ? COLOUR_NEW : COLOUR_NONE, form);
        }
    }
}

static bool is_same(const TextBuffer *a, const TextBuffer *b)
{
    return a->length == b->length && memcmp(text_get(a), text_get(b), a->length) == 0;
}

static void outcome_fini(Outcome *outcome)
{
    text_fini(&outcome->scene);
    text_fini(&outcome->messages);
}

static void compare(const TextBuffer *text, int threads, size_t piece, uint64_t objects, const char *name)
{
    Outcome one = read_text(text, 1, SIZE_MAX, objects), many = read_text(text, threads, piece, objects);
    tap_ok(one.is_fine == many.is_fine && one.materials == many.materials && is_same(&one.scene, &many.scene) && is_same(&one.messages, &many.messages),
           "%zu spheres%s, pieces of %zu bytes on %d threads, %zu bytes of messages", one.spheres, name, piece, threads,
           one.messages.length);
    outcome_fini(&one);
    outcome_fini(&many);
}

static void test_text(Random *random, bool has_many_colours)
{
    TextBuffer text;
    text_init(&text);
    write_text(&text, random, has_many_colours);
    must(!text.failed);
    uint64_t objects = random_below(random, 4) == 0 ? 65600 + random_below(random, 4000) : 1000000;
    int threads = 1 + (int)random_below(random, 7);
    size_t piece = 700 + random_below(random, 20000);
    compare(&text, threads, piece, objects, has_many_colours ? " of as many colours" : "");
    text_fini(&text);
}

// A literal that is left to the usual way, the first of a round: nothing moves then, the source neither.
static void test_left(Random *random)
{
    TextBuffer text;
    text_init(&text);
    for (int i = 1; i <= 6000; i++) {
        write_sphere(&text, random, COLOUR_NEW, 0);
        if (i % 130 == 0) {
            text_printf(&text, "sphere { <1, 2, 3>, 1 pigment { rgb <1e%d, 0, 1> } }\n", i % 780 ? 31 : 39);
        }
    }
    must(!text.failed);
    compare(&text, 2, 1000, 1000000, ", some of them left");
    compare(&text, 1, 1000, 1000000, ", some of them left");
    text_fini(&text);
}

// One character of a number is another one: what is nearly a number is told, or read, as the scanner has it.
static void test_slip(Random *random)
{
    static const char slips[] = "/:,.;-+eE 0x\t97<>{}'";
    TextBuffer text;
    unsigned form = random_below(random, RT_COUNT_OF(forms)), at = 4000 + random_below(random, 900);
    text_init(&text);
    for (unsigned i = 0; i < 5000; i++) { // of more bytes than the scanner reads at once
        size_t begin = text.length;
        write_sphere(&text, random, COLOUR_NEW, form);
        if (i == at) {
            char *line = (char *)text_get(&text) + begin;
            size_t place;
            do {
                place = random_below(random, (unsigned)(text.length - begin));
            } while (strchr("0123456789.", line[place]) == NULL);
            line[place] = slips[random_below(random, sizeof slips - 1)];
        }
    }
    must(!text.failed);
    compare(&text, 1 + (int)random_below(random, 3), 4000, 1000000, ", with a slip");
    text_fini(&text);
}

// Colours that repeat often enough to be looked up for ever, though never but in the next sphere; then some come again.
static void test_pairs(Random *random)
{
    TextBuffer text;
    text_init(&text);
    for (int i = 0; i < 2 * SPHERES_MANY; i++) {
        text_printf(&text, "sphere { <%d, 2, 3>, 0.25 pigment { rgb <0.%05d, 0.5, 1> } }\n", i, i / 2 % (SPHERES_MANY - 1000));
    }
    must(!text.failed);
    compare(&text, 1 + (int)random_below(random, 3), 20000, 1000000, ", two of each colour");
    text_fini(&text);
}

int main(int argc, char **argv)
{
    Random random = {random_seed(NULL)};
    int texts = argc > 1 ? atoi(argv[1]) : TEXTS;
    for (int i = 0; i < texts; i++) {
        test_text(&random, i % 2 == 1);
    }
    for (int i = 0; i < 10 * texts; i++) {
        test_slip(&random);
    }
    test_left(&random);
    test_pairs(&random);
    return tap_done();
}
