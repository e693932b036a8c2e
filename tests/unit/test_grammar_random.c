// The grammar by generated input: what is printed parses to an equal tree; no truncation, garbage or soup of tokens
// does harm, and a parse is clean exactly when nothing was reported.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "grammar/grammar.h"
#include "unit/random.h"
#include "unit/tap.h"

typedef struct Bench {
    InternTable *names;
    SourceMap *sources;
    DiagSink diags;
    Arena arena;
    AstBuilder builder;
    Random random;
} Bench;

static void bench_init(Bench *bench, uint64_t seed)
{
    memset(bench, 0, sizeof *bench);
    bench->names = intern_new((size_t)64 << 20);
    bench->sources = source_map_new();
    if (bench->names == NULL || bench->sources == NULL || !words_intern(bench->names)) {
        abort();
    }
    diag_init(&bench->diags, bench->sources);
    arena_init(&bench->arena, (size_t)1 << 30);
    bench->builder = (AstBuilder){.arena = &bench->arena, .diags = &bench->diags, .depth_limit = 1000};
    bench->random.state = seed;
}

static void bench_fini(Bench *bench)
{
    arena_fini(&bench->arena);
    diag_fini(&bench->diags);
    source_map_free(bench->sources);
    intern_free(bench->names);
}

static bool parse_text(Bench *bench, const char *text, size_t length, AstList *items)
{
    Limits limits = LIMITS_DEFAULT;
    GrammarContext context = {bench->names, &bench->arena, &bench->diags, &limits, NULL, false, NULL};
    Source *source = source_open_text(bench->sources, "test", text, length);
    if (source == NULL) {
        abort();
    }
    bool torn;
    bool clean = grammar_parse_all(&context, source, items, &torn);
    source_close(source);
    return clean;
}

// ---- A random tree of what the grammar can say.

static AstNode *make_expression(Bench *bench, unsigned depth);
static AstNode *make_value(Bench *bench, unsigned depth);
static AstList make_items(Bench *bench, unsigned depth, bool is_body);
static AstNode *make_if(Bench *bench, unsigned depth);

static AstNode *make(Bench *bench, AstKind kind, AstOp op, Symbol symbol, AstNode *a, AstNode *b, AstNode *c)
{
    return ast_node(&bench->builder, (AstHead){kind, op, symbol, SPAN_NONE}, a, b, c);
}

static AstNode *make_list(Bench *bench, AstKind kind, AstOp op, Symbol symbol, AstList a, AstList b, AstList c)
{
    return ast_node_list(&bench->builder, (AstHead){kind, op, symbol, SPAN_NONE}, a, b, c);
}

static AstList one(AstNode *node)
{
    return ast_append((AstList){0}, node);
}

static Symbol make_symbol(Bench *bench)
{
    static const char *const names[] = {"A", "b1", "_", "Red", "e5", "image_width"};
    const char *name = names[random_below(&bench->random, RT_COUNT_OF(names))];
    return intern_text(bench->names, name, strlen(name));
}

static AstNode *make_name(Bench *bench)
{
    return make(bench, AST_NAME, AST_OP_NONE, make_symbol(bench), NULL, NULL, NULL);
}

static AstNode *make_word(Bench *bench)
{
    static const Word words[] = {W_ambient, W_rgb, W_color, W_texture, W_no_shadow, W_filter};
    return make(bench, AST_WORD, AST_OP_NONE, words[random_below(&bench->random, RT_COUNT_OF(words))], NULL, NULL, NULL);
}

// As the lexer makes them: bytes, of which a mark is doubled, and characters of escapes behind a mark.
static AstNode *make_string(Bench *bench)
{
    TextBuffer text;
    text_init(&text);
    for (unsigned left = random_below(&bench->random, 8); left > 0; left--) {
        char escape[7], byte = (char)(1 + random_below(&bench->random, 255)); // a character 0 would end it
        if (random_below(&bench->random, 4) == 0) {
            snprintf(escape, sizeof escape, "\\u%04x", 1 + random_below(&bench->random, 0xffff));
            text_append_escape(&text, escape, 6);
        } else {
            text_append_n(&text, (char[]){byte, byte}, byte == TEXT_MARK ? 2 : 1);
        }
    }
    AstNode *node = make(bench, AST_STRING, AST_OP_NONE, intern_text(bench->names, text_get(&text), text.length), NULL,
                         NULL, NULL);
    text_fini(&text);
    return node;
}

static AstNode *make_number(Bench *bench)
{
    static const double numbers[] = {0, 1, 0.1, 1e300, 5e-324, 123456789, 1.0 / 3, 2.5e-7};
    return ast_number(&bench->builder, numbers[random_below(&bench->random, RT_COUNT_OF(numbers))], SPAN_NONE);
}

static AstList make_values(Bench *bench, unsigned depth, unsigned least, unsigned more)
{
    AstList list = {0};
    for (unsigned count = least + random_below(&bench->random, more); count > 0; count--) {
        list = ast_append(list, make_value(bench, depth));
    }
    return list;
}

static AstList make_expressions(Bench *bench, unsigned depth, unsigned least, unsigned more)
{
    AstList list = {0};
    for (unsigned count = least + random_below(&bench->random, more); count > 0; count--) {
        list = ast_append(list, make_expression(bench, depth));
    }
    return list;
}

static AstNode *make_target(Bench *bench, unsigned depth)
{
    AstNode *name = make_name(bench);
    return random_below(&bench->random, 2) ? name
                                    : make(bench, AST_INDEX, AST_OP_NONE, 0, name, make_expression(bench, depth), NULL);
}

static AstNode *make_inline(Bench *bench, unsigned depth)
{
    AstNode *directive = random_below(&bench->random, 2)
                             ? make_if(bench, depth)
                             : make(bench, AST_INCLUDE, AST_OP_NONE, 0, make_name(bench), NULL, NULL);
    return make(bench, AST_INLINE, AST_OP_NONE, 0, directive, NULL, NULL);
}

static AstNode *make_operation(Bench *bench, unsigned depth)
{
    static const AstOp unaries[] = {AST_OP_NEG, AST_OP_PLUS, AST_OP_NOT};
    AstNode *a = make_expression(bench, depth), *b = make_expression(bench, depth);
    switch (random_below(&bench->random, 4)) {
    case 0:
        return make(bench, AST_UNARY, unaries[random_below(&bench->random, 3)], 0, a, NULL, NULL);
    case 1:
        return make(bench, AST_CONDITIONAL, AST_OP_CONDITIONAL, 0, a, b, make_expression(bench, depth));
    default:
        return make(bench, AST_BINARY, (AstOp)(AST_OP_OR + random_below(&bench->random, AST_OP_DIV - AST_OP_OR + 1)), 0, a, b,
                    NULL);
    }
}

static AstNode *make_expression(Bench *bench, unsigned depth)
{
    switch (depth == 0 ? random_below(&bench->random, 4) : random_below(&bench->random, 13)) {
    case 0:
        return make_number(bench);
    case 1:
        return make_string(bench);
    case 2:
        return make_name(bench);
    case 3:
        return make(bench, AST_CONSTANT, AST_OP_NONE, W_x, NULL, NULL, NULL);
    case 4:
        return make_list(bench, AST_VECTOR, AST_OP_NONE, 0, make_expressions(bench, depth - 1, 1, 3), (AstList){0},
                         (AstList){0});
    case 5:
        return make_list(bench, AST_CALL, AST_OP_NONE, make_symbol(bench), make_values(bench, depth - 1, 0, 3),
                         (AstList){0}, (AstList){0});
    case 6:
        return make_list(bench, AST_BUILTIN, AST_OP_NONE, W_max, make_expressions(bench, depth - 1, 0, 3), (AstList){0},
                         (AstList){0});
    case 7:
        return make(bench, AST_INDEX, AST_OP_NONE, 0, make_target(bench, depth - 1), make_expression(bench, depth - 1),
                    NULL);
    case 8:
        return make(bench, AST_MEMBER, AST_OP_NONE, random_below(&bench->random, 2) ? W_x : W_filter,
                    make_expression(bench, depth - 1), NULL, NULL);
    case 9:
        return make_inline(bench, depth - 1);
    default:
        return make_operation(bench, depth - 1);
    }
}

static AstNode *make_block(Bench *bench, unsigned depth)
{
    static const Word words[] = {W_sphere, W_texture, W_union};
    return make_list(bench, AST_BLOCK, AST_OP_NONE, words[random_below(&bench->random, 3)], make_items(bench, depth, false),
                     (AstList){0}, (AstList){0});
}

static AstNode *make_sequence(Bench *bench, unsigned depth)
{
    AstList list = {0};
    for (unsigned count = 1 + random_below(&bench->random, 3); count > 0; count--) {
        list = ast_append(list, make(bench, AST_WORD, AST_OP_NONE, W_rgb, NULL, NULL, NULL));
        list = ast_append(list, make_expression(bench, depth));
    }
    return make_list(bench, AST_SEQUENCE, AST_OP_NONE, 0, list, (AstList){0}, (AstList){0});
}

static AstNode *make_array(Bench *bench, unsigned depth)
{
    AstNode *values =
        make_list(bench, AST_INITIALISER, AST_OP_NONE, 0, make_values(bench, depth, 0, 3), (AstList){0}, (AstList){0});
    return make_list(bench, AST_ARRAY, AST_OP_NONE, 0, make_expressions(bench, depth, 1, 2), one(values), (AstList){0});
}

static AstNode *make_function(Bench *bench, unsigned depth)
{
    AstList parameters = {0};
    for (unsigned count = random_below(&bench->random, 3); count > 0; count--) {
        parameters = ast_append(parameters, make_name(bench));
    }
    return make_list(bench, AST_FUNCTION, AST_OP_NONE, 0, parameters, one(make_expression(bench, depth)), (AstList){0});
}

static AstNode *make_value(Bench *bench, unsigned depth)
{
    switch (depth == 0 ? 9 : random_below(&bench->random, 10)) {
    case 0:
        return make_block(bench, depth - 1);
    case 1:
        return make_sequence(bench, depth - 1);
    case 2:
        return make_array(bench, depth - 1);
    case 3:
        return make_function(bench, depth - 1);
    default:
        return make_expression(bench, depth);
    }
}

static AstNode *make_if(Bench *bench, unsigned depth)
{
    AstList rest =
        random_below(&bench->random, 3) == 0 && depth > 0 ? one(make_if(bench, depth - 1)) : make_items(bench, depth, true);
    AstList body = make_items(bench, depth, true);
    switch (random_below(&bench->random, 3)) {
    case 0:
        return make_list(bench, AST_IF, AST_OP_NONE, 0, one(make_expression(bench, depth)), body, rest);
    case 1:
        return make_list(bench, AST_IFDEF, AST_OP_IFNDEF, 0, one(make_target(bench, depth)), body, rest);
    default: {
        AstNode *low = make_expression(bench, depth), *high = make_expression(bench, depth);
        AstList cases = one(make_list(bench, AST_CASE, AST_OP_NONE, 0, one(low), body, (AstList){0}));
        low = make_expression(bench, depth);
        cases = ast_append(
            cases, make_list(bench, AST_RANGE, AST_OP_NONE, 0, one(low), one(high), make_items(bench, depth, true)));
        cases = ast_append(cases, make_list(bench, AST_ELSE, AST_OP_NONE, 0, rest, (AstList){0}, (AstList){0}));
        return make_list(bench, AST_SWITCH, AST_OP_NONE, 0, one(make_expression(bench, depth)), cases,
                         make_items(bench, depth, true));
    }
    }
}

static AstNode *make_directive(Bench *bench, unsigned depth)
{
    AstNode *name = make_name(bench);
    switch (random_below(&bench->random, 14)) {
    case 0:
        return make(bench, AST_DECLARE, random_below(&bench->random, 2) ? AST_OP_DECLARE : AST_OP_LOCAL, 0,
                    make_target(bench, depth), make_value(bench, depth), NULL);
    case 1:
        return make_list(bench, AST_WHILE, AST_OP_NONE, 0, one(make_expression(bench, depth)),
                         make_items(bench, depth, true), (AstList){0});
    case 2:
        return make_list(bench, AST_FOR, AST_OP_NONE, 0, one(name), make_expressions(bench, depth, 2, 2),
                         make_items(bench, depth, true));
    case 3:
        return make_list(bench, AST_MACRO, AST_OP_NONE, make_symbol(bench), one(name), make_items(bench, depth, true),
                         (AstList){0});
    case 4:
        return make(bench, AST_INCLUDE, AST_OP_NONE, 0, name, NULL, NULL);
    case 5:
        return make(bench, AST_MESSAGE, (AstOp)(AST_OP_DEBUG + random_below(&bench->random, 5)), 0,
                    make_expression(bench, depth), NULL, NULL);
    case 6:
        return make_list(bench, AST_DEFAULT, AST_OP_NONE, 0, make_items(bench, depth, false), (AstList){0},
                         (AstList){0});
    case 7:
        return make(bench, AST_FOPEN, AST_OP_NONE, W_write, name, make_expression(bench, depth), NULL);
    case 8:
        return make_list(bench, AST_WRITE, AST_OP_NONE, 0, one(name), make_values(bench, depth, 1, 2), (AstList){0});
    case 9:
        return make(bench, AST_VERSION, AST_OP_NONE, 0, make_expression(bench, depth), NULL, NULL);
    case 10: // not AST_UNDEF: an entry behind it would be an index
        return make(bench, AST_BREAK, AST_OP_NONE, 0, NULL, NULL, NULL);
    case 11:
        return make(bench, AST_FCLOSE, AST_OP_NONE, 0, name, NULL, NULL);
    case 12:
        return make_list(bench, AST_READ, AST_OP_NONE, 0, one(name), one(make_target(bench, depth)), (AstList){0});
    default:
        return make_if(bench, depth);
    }
}

static AstNode *make_item(Bench *bench, unsigned depth)
{
    switch (depth == 0 ? random_below(&bench->random, 5) : random_below(&bench->random, 12)) {
    case 0:
    case 1:
        return make_word(bench);
    case 5:
    case 6:
        return make_block(bench, depth - 1);
    case 7:
        return make_list(bench, AST_ENTRY, AST_OP_NONE, 0, make_items(bench, depth - 1, false), (AstList){0},
                         (AstList){0});
    case 8:
    case 9:
        return make_directive(bench, depth - 1);
    case 10:
        return make_function(bench, depth - 1);
    case 11:
        return make_list(bench, AST_TERM, AST_OP_NONE, W_xyz, make_expressions(bench, depth - 1, 3, 1),
                         one(make_expression(bench, depth - 1)), (AstList){0});
    default:
        return make_expression(bench, depth);
    }
}

// An inline directive is an item by itself, and items have commas only between them or around a directive's body.
static AstList make_items(Bench *bench, unsigned depth, bool is_body)
{
    AstList list = {0};
    for (unsigned count = random_below(&bench->random, 4); count > 0; count--) {
        AstNode *item = make_item(bench, depth);
        bool comma = random_below(&bench->random, 4) == 0 && (list.count > 0 || is_body);
        list = comma ? ast_append_after_comma(list, item) : ast_append(list, item);
    }
    return is_body && random_below(&bench->random, 4) == 0 ? ast_flag_last(list, AST_BEFORE_COMMA) : list;
}

static bool check_round(uint64_t seed)
{
    Bench bench;
    bench_init(&bench, seed);
    AstNode *item = make_block(&bench, 4);
    TextBuffer once, again;
    text_init(&once);
    text_init(&again);
    ast_print(item, bench.names, 0, &once);
    AstList items;
    bool clean = parse_text(&bench, text_get(&once), once.length, &items);
    bool equal = clean && items.count == 1 && ast_equal(items.first, item);
    if (equal) {
        ast_print(items.first, bench.names, 0, &again);
    }
    bool same = equal && strcmp(text_get(&once), text_get(&again)) == 0;
    if (!same) {
        printf("# seed %llu clean %d equal %d\n%s\n--\n%s", (unsigned long long)seed, clean, equal, text_get(&once),
               text_get(&again));
        for (size_t i = 0; i < bench.diags.count; i++) {
            printf("# %s\n", bench.diags.items[i].message);
        }
    }
    text_fini(&once);
    text_fini(&again);
    bench_fini(&bench);
    return same;
}

static void test_rounds(void)
{
    enum { ROUNDS = 3000 };
    unsigned good = 0;
    for (uint64_t seed = 1; seed <= ROUNDS; seed++) {
        if (!check_round(seed * 0x9e3779b97f4a7c15u)) {
            break;
        }
        good++;
    }
    tap_ok(good == ROUNDS, "%d generated programs are the same after printing and parsing", (int)ROUNDS);
}

// Clean means: nothing reported. Anything else would let a fault pass or refuse a good scene without a word.
static bool survives(const char *text, size_t length)
{
    Bench bench;
    bench_init(&bench, 1);
    AstList items;
    bool clean = parse_text(&bench, text, length, &items);
    bool good = clean == (bench.diags.error_count == 0);
    if (!good) {
        printf("# %.*s\n", (int)length, text);
    }
    bench_fini(&bench);
    return good;
}

static void test_truncations(void)
{
    static const char text[] =
        "#version 3.7; #include \"a.inc\" /* c /* d */ */ #declare A = array[2] { <1, 2 -3>, rgb .5 }; // e\n"
        "#macro M(a, b) #local F = function(x) { x > 2 }; sphere { a, abs(b<1) texture { T } } #end M(1e-5, "
        "\"x\\ty\")\n"
        "#if (A[0].x >= 1 & !(B = 2)) #while (1) #for (I, 0, 10, 2) color_map { [0 rgb 1] } #break #end #end\n"
        "#elseif (1 ? 2 : 3) #switch (1) #case (1) #range (2, 3) #else #end #else #fopen F \"f\" read #read(F, A)\n"
        "#write(F, 1) #fclose F #end #default { finish { ambient 0.1, phong (#ifdef (A) 1 #end) } } #undef A #debug "
        "S\n";
    bool good = true;
    for (size_t length = 0; length < sizeof text && good; length++) {
        good = survives(text, length);
    }
    tap_ok(good && survives(text, sizeof text - 1), "a program cut at each byte does no harm");
}

static void test_garbage(void)
{
    Random random = {42};
    bool good = true;
    for (unsigned turn = 0; turn < 500 && good; turn++) {
        char bytes[300];
        for (size_t i = 0; i < sizeof bytes; i++) {
            bytes[i] = (char)(turn % 2 ? random_below(&random, 256) : 32 + random_below(&random, 95));
        }
        good = survives(bytes, sizeof bytes);
    }
    tap_ok(good, "random bytes do no harm");
}

static void test_soup(void)
{
    static const char *const pieces[] = {
        "{",    "}",      "(",        ")",        "[",        "]",      "<",       ">",        ",",       ";",
        "=",    "+",      "-",        "*",        ".",        "?",      ":",       "&",        "!",       "1",
        "A",    "x",      "\"s\"",    "sphere",   "texture",  "rgb",    "array",   "function", "sin",     "deprecated",
        "read", "#if",    "#ifdef",   "#else",    "#elseif",  "#end",   "#switch", "#case",    "#range",  "#while",
        "#for", "#macro", "#declare", "#include", "#default", "#break", "#esle",   "#",        "sphere{", "#if(1)",
        "(1)",  "{1}",    "A(",       "default",  "@",
    };
    Random random = {7};
    bool good = true;
    for (unsigned turn = 0; turn < 5000 && good; turn++) {
        char text[600];
        size_t length = 0;
        for (unsigned i = random_below(&random, 40); i > 0; i--) {
            const char *piece = pieces[random_below(&random, RT_COUNT_OF(pieces))];
            length += (size_t)snprintf(text + length, sizeof text - length, "%s ", piece);
        }
        good = survives(text, length);
    }
    tap_ok(good, "a soup of tokens does no harm");
}

int main(void)
{
    test_rounds();
    test_truncations();
    test_garbage();
    test_soup();
    return tap_done();
}
