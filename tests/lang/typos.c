// Measures did-you-mean: every word of the schema, every directive and every built-in name is mistyped in every way of
// four kinds (a letter dropped, doubled, swapped with the next, replaced by each key beside it), and the message must
// suggest the right word in at least 90 of 100 cases of each kind of typo, and of each group of words.
//
// A mistyped word that is another reserved word is no typo that a message could tell, and does not count.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "ast/words.h"
#include "eval/eval.h"
#include "scene/schema.h"
#include "unit/tap.h"

enum { PERCENT_WANTED = 90, WORD_SIZE = 64 };

typedef enum TypoKind { DROPPED, DOUBLED, SWAPPED, BESIDE, TYPO_KINDS } TypoKind;

static const char *const kind_names[] = {"dropped", "doubled", "swapped", "replaced by a key beside it"};

typedef struct Tally {
    unsigned right[TYPO_KINDS], all[TYPO_KINDS];
    TextBuffer missed;
} Tally;

// ---- one typo

static const char *keys_beside(char key)
{
    static const struct {
        char key;
        const char *beside;
    } keys[] = {
        {'q', "wa"},     {'w', "qeas"},   {'e', "wrsd"},   {'r', "etdf"},   {'t', "ryfg"},   {'y', "tugh"},
        {'u', "yihj"},   {'i', "uojk"},   {'o', "ipkl"},   {'p', "ol"},     {'a', "qwsz"},   {'s', "adwezx"},
        {'d', "sferxc"}, {'f', "dgrtcv"}, {'g', "fhtyvb"}, {'h', "gjyubn"}, {'j', "hkuinm"}, {'k', "jliom"},
        {'l', "kop"},    {'z', "xas"},    {'x', "zcsd"},   {'c', "xvdf"},   {'v', "cbfg"},   {'b', "vngh"},
        {'n', "bmhj"},   {'m', "njk"},
    };
    for (size_t i = 0; i < RT_COUNT_OF(keys); i++) {
        if (keys[i].key == key) {
            return keys[i].beside;
        }
    }
    return "";
}

// The replacement that the first error suggests for `before``wrong``after` is the word.
static bool is_suggested(const char *before, const char *wrong, const char *after, const char *word)
{
    Limits limits = LIMITS_DEFAULT;
    SourceMap *sources = source_map_new();
    InternTable *names = intern_new(limits.memory_bytes);
    DiagSink diags;
    Scene scene;
    TextBuffer text;
    diag_init(&diags, sources);
    scene_init(&scene);
    text_init(&text);
    text_printf(&text, "%s%s%s\n", before, wrong, after);
    bool is_right = false;
    if (sources != NULL && names != NULL && words_intern(names)) {
        Source *source = source_open_text(sources, "typo.scn", text_get(&text), text.length);
        EvalOptions options = {.sources = sources, .names = names, .diags = &diags, .limits = &limits};
        if (source != NULL && !eval_source(&options, source, &scene) && diags.count > 0) {
            const Diag *first = &diags.items[0];
            is_right = first->replacement != NULL && strcmp(first->replacement, word) == 0;
        }
    }
    text_fini(&text);
    scene_fini(&scene);
    diag_fini(&diags);
    intern_free(names);
    source_map_free(sources);
    return is_right;
}

static bool is_typo(const InternTable *names, const char *wrong, const char *word)
{
    bool is_name = strspn(wrong, "abcdefghijklmnopqrstuvwxyz_0123456789") == strlen(wrong) && wrong[0] > '9';
    Symbol known = intern_find(names, wrong, strlen(wrong));
    return is_name && strcmp(wrong, word) != 0 && word_class(known) == WORD_IDENTIFIER;
}

typedef struct Place {
    const char *before, *mark, *after; // the mark stands before the word and in the suggestion: "#"
} Place;

static void count(const InternTable *names, Tally *tally, TypoKind kind, const Place *place, const char *wrong,
                  const char *word)
{
    if (!is_typo(names, wrong, word)) {
        return;
    }
    char before[320], wanted[WORD_SIZE + 1];
    snprintf(before, sizeof before, "%s%s", place->before, place->mark);
    snprintf(wanted, sizeof wanted, "%s%s", place->mark, word);
    tally->all[kind]++;
    if (is_suggested(before, wrong, place->after, wanted)) {
        tally->right[kind]++;
    } else {
        text_printf(&tally->missed, " %s:%s", word, wrong);
    }
}

static void try_word(const InternTable *names, Tally *tally, const Place *place, const char *word)
{
    char wrong[WORD_SIZE];
    size_t length = strlen(word);
    for (size_t i = 0; i < length; i++) {
        snprintf(wrong, sizeof wrong, "%.*s%s", (int)i, word, word + i + 1);
        count(names, tally, DROPPED, place, wrong, word);
        snprintf(wrong, sizeof wrong, "%.*s%s", (int)i + 1, word, word + i);
        count(names, tally, DOUBLED, place, wrong, word);
        if (i + 1 < length) {
            snprintf(wrong, sizeof wrong, "%.*s%c%c%s", (int)i, word, word[i + 1], word[i], word + i + 2);
            count(names, tally, SWAPPED, place, wrong, word);
        }
        for (const char *key = keys_beside(word[i]); *key != '\0'; key++) {
            snprintf(wrong, sizeof wrong, "%.*s%c%s", (int)i, word, *key, word + i + 1);
            count(names, tally, BESIDE, place, wrong, word);
        }
    }
}

static bool is_enough(unsigned right, unsigned all)
{
    return all > 0 && 100 * right >= PERCENT_WANTED * all;
}

// What a group came to; it is added to the sums of all.
static void tell(Tally *tally, Tally *sums, const char *group)
{
    unsigned right = 0, all = 0;
    for (int kind = 0; kind < TYPO_KINDS; kind++) {
        right += tally->right[kind];
        all += tally->all[kind];
        sums->right[kind] += tally->right[kind];
        sums->all[kind] += tally->all[kind];
    }
    tap_ok(is_enough(right, all), "%s: %u of %u typos have the right suggestion", group, right, all);
    printf("# missed:%s\n", text_get(&tally->missed));
    text_fini(&tally->missed);
}

static void tell_kinds(const Tally *sums)
{
    for (int kind = 0; kind < TYPO_KINDS; kind++) {
        tap_ok(is_enough(sums->right[kind], sums->all[kind]), "a letter %s: %u of %u typos have the right suggestion",
               kind_names[kind], sums->right[kind], sums->all[kind]);
    }
}

// ---- the groups of words

static void try_class(const InternTable *names, Tally *sums, WordClass class, const Place *place, const char *group)
{
    Tally tally = {0};
    for (Symbol word = 1; word < WORD_COUNT; word++) {
        // A single letter has no neighbours that are not names of their own.
        if (word_class(word) == class && intern_length(names, word) > 1) {
            try_word(names, &tally, place, intern_get(names, word));
        }
    }
    tell(&tally, sums, group);
}

static void try_kinds(const InternTable *names, Tally *sums)
{
    Tally tally = {0};
    for (int kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        const SchemaBlock *schema = schema_kind((SchemaKind)kind);
        if (kind == KIND_REFLECTION || kind == KIND_CLIPPED_BY || kind == KIND_BOUNDED_BY || kind == KIND_WARP ||
            kind == KIND_IRID || kind == KIND_BLOB_BALL || kind == KIND_BLOB_ROD || kind == KIND_CONTAINED_BY ||
            kind == KIND_CONTAINER_BALL || kind == KIND_CONTAINER_BOX || kind == KIND_IMAGE_PATTERN ||
            kind == KIND_BUMP_MAP || kind == KIND_MATERIAL_MAP) {
            continue; // properties of other blocks
        }
        Place place = {schema->is_declarable ? "#declare A = " : "", "", " { }"};
        try_word(names, &tally, &place, schema->word);
    }
    tell(&tally, sums, "kinds of blocks");
}

// What a block of the kind wants before its properties.
static const char *const arguments[KIND_COUNT] = {
    [KIND_SPHERE] = "0, 1",
    [KIND_PLANE] = "y, 1",
    [KIND_LIGHT_SOURCE] = "0, 1",
    [KIND_OBJECT] = "sphere { 0, 1 }",
    [KIND_BACKGROUND] = "rgb 1",
    [KIND_REFLECTION] = "1",
    [KIND_UNION] = "sphere { 0, 1 } sphere { 0, 1 }",
    [KIND_MERGE] = "sphere { 0, 1 } sphere { 0, 1 }",
    [KIND_INTERSECTION] = "sphere { 0, 1 } sphere { 0, 1 }",
    [KIND_DIFFERENCE] = "sphere { 0, 1 } sphere { 0, 1 }",
    [KIND_BOX] = "0, 1",
    [KIND_CYLINDER] = "0, y, 1",
    [KIND_CONE] = "0, 1, y, 0",
    [KIND_DISC] = "0, y, 1",
    [KIND_TRIANGLE] = "0, x, y",
    [KIND_SMOOTH_TRIANGLE] = "0, z, x, z, y, z",
    [KIND_TORUS] = "2, 1",
    [KIND_QUADRIC] = "1, 0, 0, -1",
    [KIND_BLOB] = "threshold 0.5 sphere { 0, 1, 1 }",
    [KIND_ISOSURFACE] = "function { x }",
    [KIND_CUBIC] = "<1, 0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,-1>",
    [KIND_QUARTIC] = "<1, 0,0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,0,0,0, 0,0,0,0,0,0,0,0,0,0,0,-1>",
    [KIND_POLY] = "2, <1, 0, 0, 0, 1, 0, 0, 1, 0, -1>",
    [KIND_POLYNOMIAL] = "2, xyz(2, 0, 0): 1, xyz(0, 0, 0): -1",
    [KIND_PRISM] = "linear_spline 0, 1, 4, <0, 0>, <1, 0>, <0, 1>, <0, 0>",
    [KIND_LATHE] = "linear_spline 2, <0, 0>, <1, 1>",
    [KIND_SUPERELLIPSOID] = "<1, 1>",
    [KIND_SPHERE_SWEEP] = "linear_spline 2, 0, 1, x, 1",
    [KIND_JULIA_FRACTAL] = "<0, 0, 0.5, 0>",
    [KIND_PARAMETRIC] = "function { u } function { v } function { 0 } <0, 0>, <1, 1>",
    [KIND_OVUS] = "1, 0.5",
    [KIND_SOR] = "4, <0, 0>, <1, 0>, <1, 1>, <0, 1>",
    [KIND_POLYGON] = "4, <0, 0>, <1, 0>, <0, 1>, <0, 0>",
    [KIND_MESH] = "triangle { 0, x, y }",
    [KIND_BICUBIC_PATCH] = "type 0 0, x, 2*x, 3*x, y, x+y, 2*x+y, 3*x+y, 2*y, x+2*y, 2*x+2*y, 3*x+2*y, 3*y, x+3*y, "
                           "2*x+3*y, 3*x+3*y",
    [KIND_HEIGHT_FIELD] = "function 2, 2 { x }",
    [KIND_MESH2] = "vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> }",
    [KIND_BLOB_BALL] = "0, 1, 1",
    [KIND_BLOB_ROD] = "0, x, 1, 1",
};

// What blocks stand in that do so in others only.
static const char *const arounds[KIND_COUNT] = {
    [KIND_REFLECTION] = "finish {", [KIND_PATTERN] = "function {", [KIND_IRID] = "finish {",
    [KIND_WARP] = "pigment { bozo", [KIND_BLOB_BALL] = "blob {",   [KIND_BLOB_ROD] = "blob {",
    [KIND_IMAGE_PATTERN] = "pigment {", [KIND_BUMP_MAP] = "normal {", [KIND_MATERIAL_MAP] = "texture {",
};

static void try_properties(const InternTable *names, Tally *sums)
{
    Tally tally = {0};
    for (int kind = KIND_NONE + 1; kind < KIND_UNSUPPORTED; kind++) {
        const SchemaBlock *schema = schema_kind((SchemaKind)kind);
        const SchemaProperty *property;
        const char *around = arounds[kind] != NULL ? arounds[kind] : "";
        bool is_inner = around[0] != '\0';
        char before[256];
        if (kind == KIND_TEXT || kind == KIND_CONTAINED_BY) {
            continue; // one wants a font, and has no properties but those of all objects; the other stands too deep
        }
        snprintf(before, sizeof before, "%s%s %s { %s ", is_inner || schema->is_declarable ? "#declare A = " : "",
                 around, schema->word, arguments[kind] != NULL ? arguments[kind] : "");
        for (size_t i = 0; (property = schema_property((SchemaKind)kind, i)) != NULL; i++) {
            Place place = {before, "", property->type == TYPE_BLOCK ? " { } }" : is_inner ? " 1 } }" : " 1 }"};
            try_word(names, &tally, &place, property->word);
        }
    }
    tell(&tally, sums, "properties");
}

int main(void)
{
    InternTable *names = intern_new(LIMITS_DEFAULT.memory_bytes);
    if (names == NULL || !words_intern(names)) {
        return 1;
    }
    Tally sums = {0};
    try_class(names, &sums, WORD_DIRECTIVE, &(Place){"", "#", " (1)"}, "directives");
    try_class(names, &sums, WORD_BUILTIN, &(Place){"#declare A = ", "", "(1);"}, "functions");
    try_class(names, &sums, WORD_CONSTANT, &(Place){"#declare A = 1 + ", "", ";"}, "constants");
    try_class(names, &sums, WORD_COLOUR, &(Place){"background { color ", "", " 1 }"}, "words of colours");
    try_kinds(names, &sums);
    try_properties(names, &sums);
    tell_kinds(&sums);
    intern_free(names);
    return tap_done();
}
