// Reading at once beside reading token by token: random texts of what scenes are made of, with and without mistakes,
// give the same trees, spans and all, and the same messages both ways.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/grammar.h"
#include "unit/random.h"
#include "unit/tap.h"

// What one way gives: each item as a digest of its tree, then the messages.
typedef struct Outcome {
    InternTable *names;
    TextBuffer text;
    bool is_clean;
} Outcome;

static void write_node(const AstNode *node, TextBuffer *out)
{
    for (; node != NULL; node = node->next) {
        text_printf(out, "(%s %u %u %u %llu-%llu %u", ast_kind_name((AstKind)node->kind), node->op, node->flags, node->symbol,
                    (unsigned long long)node->span.begin, (unsigned long long)node->span.end, node->depth);
        if (node->kind == AST_NUMBER) {
            text_printf(out, " %a)", node->number);
            continue;
        }
        write_node(node->a, out);
        text_append(out, " ");
        write_node(node->b, out);
        text_append(out, " ");
        write_node(node->c, out);
        text_append(out, ")");
    }
}

static bool take(void *client, const AstNode *item)
{
    Outcome *outcome = client;
    AstNode alone = *item;
    alone.next = NULL;
    write_node(&alone, &outcome->text);
    text_append_char(&outcome->text, '\n');
    return true;
}

static void read_text(const char *text, size_t length, bool token_by_token, Outcome *outcome)
{
    Limits limits = LIMITS_DEFAULT;
    Arena arena;
    DiagSink diags;
    SourceMap *sources = source_map_new();
    outcome->names = intern_new((size_t)64 << 20);
    text_init(&outcome->text);
    if (sources == NULL || outcome->names == NULL || !words_intern(outcome->names)) {
        abort();
    }
    diag_init(&diags, sources);
    arena_init(&arena, (size_t)1 << 30);
    GrammarContext context = {outcome->names, &arena, &diags, &limits, NULL, token_by_token, NULL};
    Source *source = source_open_text(sources, "test", text, length);
    if (source == NULL) {
        abort();
    }
    outcome->is_clean = grammar_parse(&context, source, take, outcome);
    source_close(source);
    for (size_t i = 0; i < diags.count; i++) {
        diag_print(&diags, &diags.items[i], false, &outcome->text);
    }
    arena_fini(&arena);
    diag_fini(&diags);
    source_map_free(sources);
    intern_free(outcome->names);
}

static bool are_equal(const char *text, size_t length, bool *is_clean)
{
    Outcome quick, slow;
    read_text(text, length, false, &quick);
    read_text(text, length, true, &slow);
    bool same = quick.is_clean == slow.is_clean && quick.text.length == slow.text.length &&
                memcmp(text_get(&quick.text), text_get(&slow.text), quick.text.length) == 0;
    *is_clean = slow.is_clean;
    if (!same && length < 2000) {
        printf("# %.*s\n--\n%s--\n%s", (int)length, text, text_get(&quick.text), text_get(&slow.text));
    }
    text_fini(&quick.text);
    text_fini(&slow.text);
    return same;
}

// ---- texts

static const char *const numbers[] = {
    "0", "1", "0.5", "12.25", "0.1234567", "0.12345678", "3.141592653589793", "123456789012345678901234567890", "1e5", "1e",
    "1.e-3", "5.", "1.5.2", "007", "99999999.5", "0.123456789012345678", "1e400", "2x", "1234567.12345678", "0.00000000000001",
};
static const char *const blanks[] = {" ", "", "\n", "\t", "  ", "\r\n", " // c\n", " /* d */ "};
static const char *const items[] = {
    "{ ambient 0.1 diffuse 0.7 }", "{ color rgb <1, 0.5, 0> }", "{rgb 1}", "{ pigment { rgb <1,0,0> } finish { phong 1 } }",
    "{}", "{ A }", "{ ambient abs(1) }", "{ phong -1, }", "{ [0 rgb 1] }", "{ ambient 0.1 diffuse 0.7 ]", "{ 1 }}",
};
static const char *const words[] = {
    "finish", "pigment", "texture", "sphere", "normal", "A", "Red", "a_very_long_name_of_many_letters", "rgb", "x", "internal",
    "sixteen_letters_", "seventeen_letters", "declare", "red", "union",
};
static const char *const marks[] = {
    ",", ".", "+", "-", "*", "/", "<", ">", "<=", ">=", "!=", "=", "(", ")", "{", "}", "[", "]", ";", "#", "!", "&", "\"s\"",
};

static void add(TextBuffer *out, Random *random, const char *const *table, size_t count)
{
    text_append(out, table[random_below(random, (unsigned)count)]);
}

#define ADD(table) add(out, random, table, RT_COUNT_OF(table))

static void add_vector(TextBuffer *out, Random *random, unsigned mischief)
{
    unsigned count = mischief > 0 ? 1 + random_below(random, 6) : 2 + random_below(random, 4);
    text_append(out, "<");
    for (unsigned i = 0; i < count; i++) {
        text_append(out, i == 0 ? "" : mischief > 0 && random_below(random, 9) == 0 ? " " : ",");
        ADD(blanks);
        text_append(out, random_below(random, 3) == 0 ? "-" : "");
        add(out, random, numbers, mischief > 0 ? RT_COUNT_OF(numbers) : 8);
        ADD(blanks);
    }
    text_append(out, mischief > 0 && random_below(random, 12) == 0 ? "" : ">");
}

// Blocks of a few forms, whose numbers, signs and blanks differ; `@` is a number, `~` a blank or none.
static void add_form(TextBuffer *out, Random *random)
{
    static const char *const forms[] = {
        "sphere { <@,~@,~@>,~@ pigment { rgb <@, @, @> } finish { ambient @ phong~@ } }\n",
        "sphere {~<@, @, @>,~@~texture { pigment { color rgb~<@,@,@> }~} }\n",
        "finish {~ambient @ diffuse @~}",
        "pigment { rgb @ }",
        "pigment { gradient <@, @, @> scale @ translate x }",
        "normal { @, @ }",
        "normal { @ @ }",
        "normal { x~@ }",
        "scale~{ <@ @ @> }",
        "matrix {~<@,@,@,\n@,@,@,~@,@,@,@,@,@>~}",
    };
    static const char *const plain[] = {" ", "", "", "  ", "\n", "\t"};
    for (const char *at = forms[random_below(random, RT_COUNT_OF(forms))]; *at != '\0'; at++) {
        if (*at == '@') {
            text_append(out, random_below(random, 3) == 0 ? "-" : random_below(random, 20) == 0 ? "- " : "");
            add(out, random, numbers, 10);
        } else if (*at == '~') {
            add(out, random, plain, RT_COUNT_OF(plain));
        } else {
            text_append_char(out, *at);
        }
    }
}

static void add_piece(TextBuffer *out, Random *random, unsigned mischief)
{
    switch (random_below(random, mischief > 0 ? 12 : 9)) {
    case 0:
        text_append(out, "sphere {");
        add_vector(out, random, mischief);
        text_append(out, ", 1 finish ");
        add(out, random, items, mischief > 0 ? RT_COUNT_OF(items) : 5);
        text_append(out, " }\n");
        break;
    case 1:
        text_append(out, "#declare A = ");
        add_vector(out, random, mischief);
        text_append(out, ";\n");
        break;
    case 2:
        add(out, random, words, 5);
        ADD(blanks);
        add(out, random, items, mischief > 0 ? RT_COUNT_OF(items) : 5);
        break;
    case 3:
        text_append(out, "#declare B = vlength(");
        add_vector(out, random, mischief);
        text_append(out, " - A) * 2; // c\n");
        break;
    case 4:
        text_append(out, "texture { pigment { rgb <0.1, 0.2, 0.3> } finish { ambient 0.1 diffuse 0.7 } }\n");
        break;
    case 5:
        text_append(out, "#if (A.red < 1) box { <0, 0, 0>, <1, 1, 1> pigment { rgb <1, 0, 0> } } #end\n");
        break;
    case 9:
        ADD(words);
        ADD(blanks);
        break;
    case 10:
        ADD(marks);
        break;
    case 11:
        ADD(numbers);
        ADD(blanks);
        break;
    default:
        add_form(out, random);
        break;
    }
}

static void make_text(TextBuffer *out, Random *random, unsigned pieces, unsigned mischief)
{
    text_clear(out);
    for (unsigned i = 0; i < pieces; i++) {
        add_piece(out, random, mischief > 0 ? random_below(random, mischief) == 0 : 0);
    }
}

static void test_texts(unsigned rounds, unsigned pieces, unsigned mischief, const char *what)
{
    TextBuffer text;
    unsigned good = 0, clean = 0;
    text_init(&text);
    for (unsigned round = 0; round < rounds; round++) {
        Random random = {(round + 1) * UINT64_C(0x9e3779b97f4a7c15) + mischief};
        bool is_clean;
        make_text(&text, &random, pieces, mischief);
        if (!are_equal(text_get(&text), text.length, &is_clean)) {
            break;
        }
        good++;
        clean += is_clean;
    }
    tap_ok(good == rounds, "%u of %u texts %s are read alike, %u without a fault", good, rounds, what, clean);
    text_fini(&text);
}

int main(void)
{
    test_texts(150, 40, 0, "without mistakes");
    test_texts(2000, 6, 3, "with mistakes");
    test_texts(300, 60, 60, "of many blocks");
    test_texts(1500, 12, 12, "with few mistakes");
    test_texts(3, 20000, 0, "longer than the scanner's buffer");
    return tap_done();
}
