// The AST: builders and their limits, copies, equality, the reserved words, and the printed form of each kind of node.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "ast/ast.h"
#include "ast/words.h"
#include "tap.h"

typedef struct Bench {
    InternTable *names;
    Arena arena;
    SourceMap *sources;
    DiagSink diags;
    AstBuilder builder;
} Bench;

static void bench_init(Bench *bench, unsigned depth_limit, size_t bytes)
{
    bench->names = intern_new((size_t)1 << 20);
    tap_ok(bench->names != NULL && words_intern(bench->names), "reserved words are interned");
    bench->sources = source_map_new();
    diag_init(&bench->diags, bench->sources);
    arena_init(&bench->arena, bytes);
    bench->builder = (AstBuilder){.arena = &bench->arena, .diags = &bench->diags, .depth_limit = depth_limit};
}

static void bench_fini(Bench *bench)
{
    arena_fini(&bench->arena);
    diag_fini(&bench->diags);
    source_map_free(bench->sources);
    intern_free(bench->names);
}

static Symbol symbol(Bench *bench, const char *text)
{
    return intern_text(bench->names, text, strlen(text));
}

static AstNode *leaf(Bench *bench, AstKind kind, const char *text)
{
    return ast_node(&bench->builder, (AstHead){kind, AST_OP_NONE, symbol(bench, text), SPAN_NONE}, NULL, NULL, NULL);
}

static AstNode *binary(Bench *bench, AstOp op, AstNode *left, AstNode *right)
{
    return ast_node(&bench->builder, (AstHead){AST_BINARY, op, SYMBOL_NONE, SPAN_NONE}, left, right, NULL);
}

static AstNode *number(Bench *bench, double value)
{
    return ast_number(&bench->builder, value, SPAN_NONE);
}

static void check_print(Bench *bench, const AstNode *item, const char *wanted)
{
    TextBuffer out;
    text_init(&out);
    ast_print(item, bench->names, 0, &out);
    if (!tap_ok(strcmp(text_get(&out), wanted) == 0, "prints %.*s", (int)strcspn(wanted, "\n"), wanted)) {
        printf("# got %s\n", text_get(&out));
    }
    text_fini(&out);
}

static void test_words(void)
{
    Bench bench;
    bench_init(&bench, 10, 1 << 20);
    static const struct {
        Word word;
        const char *text;
        WordClass class;
    } cases[] = {
        {W_sphere, "sphere", WORD_PLAIN},
        {W_rgb, "rgb", WORD_COLOUR},
        {W_texture, "texture", WORD_TEXTURE},
        {W_array, "array", WORD_ARRAY},
        {W_function, "function", WORD_FUNCTION},
        {W_sin, "sin", WORD_BUILTIN},
        {W_pi, "pi", WORD_CONSTANT},
        {W_declare, "declare", WORD_DIRECTIVE},
        {W_x, "x", WORD_CONSTANT},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        tap_ok(symbol(&bench, cases[i].text) == (Symbol)cases[i].word &&
                   word_class((Symbol)cases[i].word) == cases[i].class,
               "%s has its symbol and class", cases[i].text);
    }
    tap_ok(word_class(symbol(&bench, "Sphere")) == WORD_IDENTIFIER, "case matters");
    tap_ok(word_class(symbol(&bench, "image_width")) == WORD_IDENTIFIER, "image_width is an identifier");
    InternTable *used = intern_new(1000);
    tap_ok(intern_text(used, "early", 5) != SYMBOL_NONE && !words_intern(used), "only a fresh table will do");
    intern_free(used);
    bench_fini(&bench);
}

static void test_lists(void)
{
    Bench bench;
    bench_init(&bench, 10, 1 << 20);
    AstList list = ast_append((AstList){0}, number(&bench, 1));
    list = ast_append_after_comma(list, binary(&bench, AST_OP_ADD, number(&bench, 2), number(&bench, 3)));
    tap_ok(list.count == 2 && list.depth == 2 && list.first->next == list.last, "a list knows its length and depth");
    tap_ok(list.first->flags == 0 && list.last->flags == AST_AFTER_COMMA, "a comma belongs to the item after it");
    list = ast_flag_first(ast_flag_last(list, AST_BEFORE_COMMA), AST_AFTER_COMMA);
    tap_ok(list.first->flags == AST_AFTER_COMMA && (list.last->flags & AST_BEFORE_COMMA), "commas at both ends");
    tap_ok(ast_flag_last((AstList){0}, AST_BEFORE_COMMA).first == NULL, "no comma in an empty list");
    AstNode *block =
        ast_node_list(&bench.builder, (AstHead){AST_BLOCK, AST_OP_NONE, W_sphere, SPAN_NONE}, list, (AstList){0}, (AstList){0});
    tap_ok(block->depth == 3 && block->count == 2 && block->a == list.first, "a node counts list a and the height");

    Arena other;
    arena_init(&other, 1 << 20);
    AstNode *copy = ast_clone(block, &other);
    tap_ok(copy != NULL && copy != block && copy->a != block->a && ast_equal(copy, block), "a clone is equal");
    copy->a->flags = 0;
    tap_ok(!ast_equal(copy, block), "a missing comma is seen");
    copy->a->flags = AST_AFTER_COMMA | AST_ENDED;
    tap_ok(ast_equal(copy, block), "a semicolon is not looked at");
    copy->a->number = 1.5;
    tap_ok(!ast_equal(copy, block), "another number is seen");
    copy->a->number = 1;
    copy->a->next->next = number(&bench, 4);
    tap_ok(!ast_equal(copy, block) && !ast_equal(block, copy), "a longer list is seen");
    arena_fini(&other);
    arena_init(&other, 0);
    tap_ok(ast_clone(block, &other) == NULL, "a clone without memory is NULL");
    arena_fini(&other);
    bench_fini(&bench);
}

static void test_limits(void)
{
    Bench bench;
    bench_init(&bench, 3, 1 << 20);
    AstNode *tree = number(&bench, 1);
    for (int i = 0; i < 100; i++) {
        tree = ast_node(&bench.builder, (AstHead){AST_UNARY, AST_OP_NEG, SYMBOL_NONE, SPAN_NONE}, tree, NULL, NULL);
    }
    tap_ok(bench.builder.failed && tree != NULL && tree->depth <= 3, "too deep: the dummy");
    tap_ok(bench.diags.count == 1 && bench.diags.items[0].code == DIAG_E0601, "too deep: one E0601");
    bench_fini(&bench);

    bench_init(&bench, 3, 0);
    tap_ok(number(&bench, 1) == &bench.builder.dummy && number(&bench, 1) == &bench.builder.dummy,
           "no memory: the dummy");
    tap_ok(bench.diags.count == 1 && bench.diags.items[0].code == DIAG_E0602, "no memory: one E0602");
    bench_fini(&bench);
}

static void test_print(void)
{
    Bench bench;
    bench_init(&bench, 10, 1 << 20);
    AstNode *one = number(&bench, 1), *name = leaf(&bench, AST_NAME, "A");
    check_print(&bench, one, "1\n");
    check_print(&bench, leaf(&bench, AST_STRING, "a\"\\\n\tb\x01"), "\"a\\\"\\\\\\n\\tb\\u0001\"\n");
    check_print(&bench, binary(&bench, AST_OP_MUL, binary(&bench, AST_OP_ADD, one, name), name), "(1 + A)*A\n");
    check_print(&bench, binary(&bench, AST_OP_SUB, one, binary(&bench, AST_OP_SUB, one, name)), "1 - (1 - A)\n");
    check_print(&bench, binary(&bench, AST_OP_LT, one, name), "(1 < A)\n");
    check_print(&bench, ast_node(&bench.builder, (AstHead){AST_MEMBER, AST_OP_NONE, W_x, SPAN_NONE}, one, NULL, NULL), "(1).x\n");
    AstNode *negative = ast_node(&bench.builder, (AstHead){AST_UNARY, AST_OP_NEG, SYMBOL_NONE, SPAN_NONE}, one, NULL, NULL);
    AstList items = ast_append(ast_append((AstList){0}, name), negative);
    check_print(
        &bench,
        ast_node_list(&bench.builder, (AstHead){AST_BLOCK, AST_OP_NONE, W_box, SPAN_NONE}, items, (AstList){0}, (AstList){0}),
        "box {\n  (A) (-1)\n}\n");
    tap_ok(strcmp(ast_kind_name(AST_IF), "#if") == 0 && strcmp(ast_op_spelling(AST_OP_NE), "!=") == 0, "names");
    bench_fini(&bench);
}

int main(void)
{
    test_words();
    test_lists();
    test_limits();
    test_print();
    return tap_done();
}
