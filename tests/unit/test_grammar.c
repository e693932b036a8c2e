// The grammar: programs against their printed trees, faults against their exact messages, and properties over generated
// programs: printing and parsing are inverse, no truncation or garbage does harm, no nesting overflows the stack.
//
// SPDX-License-Identifier: MIT
#include <stdlib.h>
#include <string.h>

#include "grammar/grammar.h"
#include "tap.h"

typedef struct Parse {
    InternTable *names;
    SourceMap *sources;
    DiagSink diags;
    Arena arena;
    AstList items;
    bool clean;
    TextBuffer printed; // the items
    TextBuffer faults;  // line:column: code: message [notes], one a line
} Parse;

static void print_faults(Parse *parse)
{
    for (size_t i = 0; i < parse->diags.count; i++) {
        const Diag *diag = &parse->diags.items[i];
        SourceLocation at = {0};
        if (!source_locate(parse->sources, diag->span, &at)) {
            text_append(&parse->faults, "nowhere ");
        }
        text_printf(&parse->faults, "%llu:%llu %s %s\n", (unsigned long long)at.line, (unsigned long long)at.column,
                    diag_code_name(diag->code), diag->message);
        for (size_t n = 0; n < diag->note_count; n++) {
            text_printf(&parse->faults, "note %s\n", diag->notes[n].message);
        }
        if (diag->suggestion != NULL) {
            text_printf(&parse->faults, "help %s\n", diag->suggestion);
        }
    }
}

static void parse_init(Parse *parse, const char *text, size_t length)
{
    memset(parse, 0, sizeof *parse);
    parse->names = intern_new((size_t)64 << 20);
    parse->sources = source_map_new();
    if (parse->names == NULL || parse->sources == NULL || !words_intern(parse->names)) {
        abort();
    }
    diag_init(&parse->diags, parse->sources);
    arena_init(&parse->arena, (size_t)1 << 30);
    text_init(&parse->printed);
    text_init(&parse->faults);
    Limits limits = LIMITS_DEFAULT;
    GrammarContext context = {parse->names, &parse->arena, &parse->diags, &limits, NULL, false, NULL};
    Source *source = source_open_text(parse->sources, "test", text, length);
    bool torn;
    parse->clean = grammar_parse_all(&context, source, &parse->items, &torn);
    if (parse->diags.error_count == 0) {
        for (const AstNode *item = parse->items.first; item != NULL; item = item->next) {
            ast_print(item, parse->names, 0, &parse->printed);
        }
    }
    print_faults(parse);
}

static void parse_fini(Parse *parse)
{
    text_fini(&parse->printed);
    text_fini(&parse->faults);
    arena_fini(&parse->arena);
    diag_fini(&parse->diags);
    source_map_free(parse->sources);
    intern_free(parse->names);
}

static const struct {
    const char *text, *printed;
} programs[] = {
    {"", ""},
    {"// nothing\r\n/* /* nested */ */ \xef", NULL},
    {"\xef\xbb\xbf sphere{<0,-1 2>,1}", "sphere {\n  <0, -1, 2>, 1\n}\n"},
    {"sphere { <0 -1 2>, .5 pigment { color rgb <1,0,0> filter 1. } }",
     "sphere {\n  <0 - 1, 2>, 0.5\n  pigment {\n    color\n    rgb <1, 0, 0>\n    filter 1\n  }\n}\n"},
    {"finish { ambient 0.1 phong 1 -2 phong_size 18angle 1e 1e+ 2.x }",
     "finish {\n  ambient 0.1\n  phong 1 - 2\n  phong_size 18\n  angle 1 1 2 x\n}\n"},
    {"camera { location A (1) look_at B[1][C].x*2 }", "camera {\n  location A(1)\n  look_at B[1][C].x*2\n}\n"},
    {"#declare A = 1; #local B=A+1;; # declare C = \"a\\u00e9\\n\" #/**/declare D = rgb 1 filter 2;",
     "#declare A = 1;\n#local B = A + 1;\n#declare C = \"a\\u00e9\\n\";\n#declare D = rgb 1 filter 2;\n"},
    {"#declare T = texture{P} texture{Q} #declare A=array[2][2]{{1,2}{3,4,}} #undef A",
     "#declare T = texture {\n  P\n} texture {\n  Q\n};\n#declare A = array[2][2] { { 1, 2 }, { 3, 4 } };\n#undef A\n"},
    {"#declare F=function(x,a){x>a&1}; #declare G = function { pattern { bozo } }",
     "#declare F = function(x, a) { x > a & 1 };\n#declare G = function { pattern {\n  bozo\n} };\n"},
    {"#if(1<2&!(A=3)|(1?2:0?3:4)>1) sphere{0,1} #elseif(2) A #else B #end",
     "#if (1 < 2 & !(A = 3) | (1 ? 2 : 0 ? 3 : 4) > 1)\n  sphere {\n    0, 1\n  }\n#elseif (2)\n  A\n#else\n  "
     "B\n#end\n"},
    {"#ifdef(A[1]) #end #ifndef(x) 1, #else ,2 #end", "#ifdef (A[1])\n#end\n#ifndef (x)\n  1,\n#else\n  , 2\n#end\n"},
    {"#switch(A) #debug \"a\" #case(1) #break #range(1 2) B #else C #end",
     "#switch (A)\n  #debug \"a\"\n#case (1)\n  #break\n#range (1, 2)\n  B\n#else\n  C\n#end\n"},
    {"#while(A<1) #for(I 0 10) M(I) #end #for(J,0,1,.5) #end #end",
     "#while (A < 1)\n  #for (I, 0, 10)\n    M(I)\n  #end\n  #for (J, 0, 1, 0.5)\n  #end\n#end\n"},
    {"#macro M(a b,c,) rgb a*2 #end #macro N() 5; #end M(1 x, rgb 1,) N()",
     "#macro M (a, b, c)\n  rgb a*2\n#end\n#macro N ()\n  5;\n#end\nM(1, x, rgb 1,)\nN()\n"},
    {"#version 3.7; #include \"a\\b.inc\" #default{finish{F}} #warning concat(\"a\" str(1<2,0,0)) #error A",
     "#version 3.7;\n#include \"a\\b.inc\"\n#default {\n  finish {\n    F\n  }\n}\n#warning concat(\"a\", str(1 < 2, "
     "0, 0))\n"
     "#error A\n"},
    {"#fopen F \"a\" read #read(F,A,B[1]) #write(F, uint8 A, 2) #fclose F",
     "#fopen F \"a\" read\n#read (F, A, B[1])\n#write (F, uint8 A, 2)\n#fclose F\n"},
    {"color_map { [0 rgb 1] [.5, Red] }", "color_map {\n  [\n    0\n    rgb 1\n  ]\n  [\n    0.5, Red\n  ]\n}\n"},
    {"union { A B } box { A (B) C }", "union {\n  A B\n}\nbox {\n  A(B) C\n}\n"},
    {"#declare A = <1, #if (B) 2 #else 3 #end>*(#include N);",
     "#declare A = <1, (#if (B)\n  2\n#else\n  3\n#end)>*(#include N);\n"},
    {"#declare deprecated once \"why\" A = 1;", "#declare A = 1;\n"},
    {"-A.red*!B/+2-(1-2)*3", "-A.red*!B/+2 - (1 - 2)*3\n"},
    {"sphre { 0, 1 }", "sphre {\n  0, 1\n}\n"},
};

static void test_programs(void)
{
    for (size_t i = 0; i < RT_COUNT_OF(programs); i++) {
        Parse parse;
        parse_init(&parse, programs[i].text, strlen(programs[i].text));
        const char *printed = programs[i].printed;
        bool good = printed == NULL ? !parse.clean : parse.clean && strcmp(text_get(&parse.printed), printed) == 0;
        if (!tap_ok(good, "program %zu", i)) {
            printf("# got %s# %s\n", text_get(&parse.printed), text_get(&parse.faults));
        }
        parse_fini(&parse);
    }
}

static const struct {
    const char *text, *faults;
} faults[] = {
    {"sphere { <0,0,0> 1", "1:19 E0107 the file ends before the `}` of `sphere {`\n"
                           "note `sphere {` opened here\n"},
    {"#if (1) sphere { 0, 1 }", "1:24 E0107 the file ends before the `#end` of `#if`\n"
                                "note `#if` opened here\n"},
    {"#macro M(a", "1:11 E0107 the file ends before the `)` of `(`\n"
                   "note `(` opened here\n"},
    {"sphere { 1 + }", "1:14 E0106 expected a number or vector after `+`, found `}`\n"},
    {"sphere { <0, 1 }", "1:16 E0106 expected `,` or `>` after `1`, found `}`\n"},
    {"#declare A 3", "1:12 E0106 expected `=` after `A`, found `3`\n"},
    {"#declare x = 3;", "1:10 E0106 `x` is a reserved word and cannot be declared\n"},
    {"#declare = 3;", "1:10 E0106 expected a name after `#declare`, found `=`\n"},
    {"#macro sphere() #end", "1:8 E0106 `sphere` is a reserved word and cannot be declared\n"},
    {"#macro M(a box) #end", "1:12 E0106 `box` is a reserved word and cannot be declared\n"},
    {"#for (x, 1, 2) #end", "1:7 E0106 `x` is a reserved word and cannot be declared\n"},
    {"#if (1) sphere { #else box { #end 0, 1 }",
     "1:18 E0109 `#else` stands inside `sphere {`: each branch or body of a directive must hold whole items\n"
     "note `sphere {` opened here\n"
     "note `#if` opened here\n"},
    {"sphere { #if (1) } #end",
     "1:18 E0109 `}` stands inside `#if`: each branch or body of a directive must hold whole items\n"
     "note `#if` opened here\n"
     "note `sphere {` opened here\n"},
    {"#esle", "1:1 E0105 `#esle` is not a directive\n"
              "help did you mean `#else`?\n"},
    {"#dclare A = 1;", "1:1 E0105 `#dclare` is not a directive\n"
                       "help did you mean `#declare`?\n"},
    {"#iff (1) sphere { 0, 1 } #end", "1:1 E0105 `#iff` is not a directive\n"
                                      "help did you mean `#if`?\n"},
    {"# ; sphere { 0, 1 }", "1:1 E0105 the name of a directive must follow `#`\n"},
    {"#zzzzzzzz 1", "1:1 E0105 `#zzzzzzzz` is not a directive\n"},
    {"#end sphere { 0, 1 }", "1:1 E0106 `#end` without the directive that it belongs to\n"},
    {"#while (1) #else #end", "1:12 E0106 `#else` does not belong to `#while` here\n"},
    {"#if sphere { 0, 1 } #end", "1:5 E0106 expected `(` after `#if`, found `sphere`\n"},
    {"#if (1 sphere { 0, 1 } #end", "1:8 E0106 expected `)` after `1`, found `sphere`\n"},
    {"#if () sphere { 0, 1 } #end", "1:6 E0106 expected a number or vector after `(`, found `)`\n"},
    {"#switch (1) #case (1 ) ) #range 1 #end", "1:24 E0106 no `(` is open here\n"
                                               "1:33 E0106 expected `(` after `#range`, found `1`\n"},
    {"sphere { 0, 1 ) } sphere { radius = 3 } sphere { 0 1 ] pigment { } }",
     "1:15 E0106 no `(` is open here\n"
     "1:35 E0106 unexpected `=` after `radius`\n"
     "1:54 E0106 no `[` is open here\n"},
    {"#macro M() { #end", "1:12 E0106 unexpected `{` after `)`\n"},
    {"sphere { 0, 1 }}", "1:16 E0106 no `{` is open here\n"},
    {"sphere { <1,,2>, 1 } box { <1,2>> }", "1:13 E0106 expected a number or vector or `>` after `,`, found `,`\n"
                                            "1:33 E0106 unexpected `>` after `>`\n"},
    {"#declare A = <0, #declare B = 2; B>; sphere { 0, 1 }",
     "1:18 E0109 `#declare` stands inside an expression or a list of values; a directive stands between whole items\n"},
    {"#declare A = array[2] { 1 ] 2 }; sphere { 0, 1 }", "1:27 E0106 expected `,` or `}` after `1`, found `]`\n"},
    {"color_map { [ 0 ) rgb 1 ] [ 1 rgb 2 ] }", "1:17 E0106 no `(` is open here\n"},
    {"#declare F = function { x + }; sphere { 0, 1 }", "1:29 E0106 expected a number or vector after `+`, found `}`\n"},
    {"finish { ambient 0.1, , diffuse 1 }", "1:23 E0106 unexpected `,` after `,`\n"},
    {"sphere { 0, 1 }; 1 = 2", "1:16 E0106 unexpected `;` after `}`\n"
                               "1:20 E0106 unexpected `=` after `1`\n"},
    {"#include \"a\";", "1:13 E0106 unexpected `;` after the string\n"},
    {"\"abc", "1:1 E0102 this string has no closing `\"`\n"},
    {"/* /* abc */", "1:1 E0103 this comment has no end `*/`\n"},
    {"#declare A = 1e999;", "1:14 E0104 `1e999` is beyond the greatest number, about 1.8e308\n"},
    {"a $ b \xc3\xa9 c", "1:3 E0101 `$` has no meaning here\n"
                         "1:7 E0101 letters outside ASCII stand in comments and strings only\n"},
    {"#declare A = \"a\\q\";", "1:16 E0101 `\\q` means nothing in a string; a backslash is written `\\\\`\n"},
    {"#declare A = 1.5.5;", "1:14 E0101 `1.5.5` has more than one decimal point\n"},
    {"a \x01"
     " b",
     "nowhere 0:0 E0108 byte 3 is 0x01: this is not the text of a scene\n"},
    {"default { } declare A = 1;", "1:1 W0101 `default` should have a `#` before it\n"
                                   "1:13 W0101 `declare` should have a `#` before it\n"},
    {"#declare A = array[2 {1,2}", "1:22 E0106 expected `]` after `2`, found `{`\n"},
    {"camera { location <1,2,3 look_at 0 }", "1:26 E0106 expected `,` or `>` after `3`, found `look_at`\n"},
    {"A[1", "1:4 E0107 the file ends before the `]` of `[`\n"
            "note `[` opened here\n"},
    {"rgb (1 }", "1:8 E0106 expected `)` after `1`, found `}`\n"},
};

static void test_faults(void)
{
    for (size_t i = 0; i < RT_COUNT_OF(faults); i++) {
        Parse parse;
        parse_init(&parse, faults[i].text, strlen(faults[i].text));
        bool told = strcmp(text_get(&parse.faults), faults[i].faults) == 0;
        if (!tap_ok(told && parse.clean == (parse.diags.error_count == 0), "fault %zu: %s", i, faults[i].text)) {
            printf("# got %s\n", text_get(&parse.faults));
        }
        parse_fini(&parse);
    }
}

// ---- Nesting and size.

// `count` times `open`, then `middle`, then `count` times `close`.
static char *nested(const char *open, const char *middle, const char *close, size_t count)
{
    size_t opens = strlen(open), closes = strlen(close), middles = strlen(middle);
    char *text = malloc(count * (opens + closes) + middles + 1);
    if (text == NULL) {
        abort();
    }
    char *at = text;
    for (size_t i = 0; i < count; i++, at += opens) {
        memcpy(at, open, opens);
    }
    memcpy(at, middle, middles);
    at += middles;
    for (size_t i = 0; i < count; i++, at += closes) {
        memcpy(at, close, closes);
    }
    *at = '\0';
    return text;
}

static void test_depths(void)
{
    static const struct {
        const char *open, *middle, *close;
        size_t count;
        DiagCode code;
        bool clean;
    } cases[] = {
        {"1+", "1", "", 1000000, DIAG_E0601, false},
        {"1 ", "1", "", 1000000, DIAG_E0601, true},
        {"(", "1", ")", 100000, DIAG_E0601, false},
        {"(", "1", ")", 1000, DIAG_E0601, true},
        {"union {", "", "}", 100000, DIAG_E0601, false},
        {"[", "", "]", 100000, DIAG_E0601, false},
        {"/*", "", "*/", 100000, DIAG_E0601, true},
        {"-", "1", "", 100000, DIAG_E0601, false},
        {"#if(1)", "", "#end ", 100000, DIAG_E0601, false},
        {"<", "1", ">", 100000, DIAG_E0601, false},
        {"A(", "1", ")", 100000, DIAG_E0601, false},
        {"A[", "1", "]", 100000, DIAG_E0601, false},
        {"#if(1)#elseif(1)", "", "#end ", 100000, DIAG_E0601, false},
        {"  ", "", "//x\n", 1000000, DIAG_E0601, true},
        {"/", "", "\n", 1000000, DIAG_E0601, true},
        {"1", "", "", 100000, DIAG_E0101, false},
        {"a", "", "", 1000000, DIAG_E0101, false},
        {"(", "", "", 100000, DIAG_E0601, false},
        {"{", "", "", 1000, DIAG_E0106, false},
        {"0?", "1", ":1", 10000, DIAG_E0106, false},
    };
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        char *text = nested(cases[i].open, cases[i].middle, cases[i].close, cases[i].count);
        Parse parse;
        parse_init(&parse, text, strlen(text));
        bool good = parse.clean == cases[i].clean;
        good = good && (parse.clean ? parse.diags.count == 0
                                    : parse.diags.count > 0 && parse.diags.items[0].code == cases[i].code);
        if (!tap_ok(good, "%zu times `%.8s`", cases[i].count,
                    *cases[i].open == '#' ? cases[i].open + 1 : cases[i].open)) {
            printf("# got %.200s\n", text_get(&parse.faults));
        }
        parse_fini(&parse);
        free(text);
    }
}

typedef struct Client {
    const GrammarContext *context;
    SourceMap *sources;
    size_t count, stop_at, nested;
} Client;

static bool count_item(void *data, const AstNode *item)
{
    Client *client = data;
    client->count++;
    if (client->nested > 0 && item->kind == AST_INCLUDE) {
        Client inner = {.context = client->context, .sources = client->sources, .nested = client->nested - 1};
        static const char text[] = "A B #include \"x\" sphere { <0,0,0>, 1 } C";
        Source *source = source_open_text(client->sources, "inner", text, sizeof text - 1);
        return source != NULL && grammar_parse(client->context, source, count_item, &inner) && inner.count == 5 &&
               item->a->kind == AST_STRING;
    }
    return client->count != client->stop_at;
}

static void test_streaming(void)
{
    Parse parse;
    parse_init(&parse, "", 0);
    Limits limits = LIMITS_DEFAULT;
    GrammarContext context = {parse.names, &parse.arena, &parse.diags, &limits, NULL, false, NULL};
    char *text = nested("sphere { <1,2,3>, 4 pigment { rgb <1,2,3> } }\n", "", "#include \"x\"", 2000);
    static const size_t stops[] = {0, 1, 100};
    for (size_t i = 0; i < RT_COUNT_OF(stops); i++) {
        Source *source = source_open_text(parse.sources, "test", text, strlen(text));
        Client client = {&context, parse.sources, 0, stops[i], 3};
        bool clean = grammar_parse(&context, source, count_item, &client);
        size_t wanted = stops[i] == 0 ? 4000 : stops[i];
        tap_ok(clean == (stops[i] == 0) && client.count == wanted && parse.diags.count == 0,
               "%zu items are handed over", wanted);
    }
    tap_ok(parse.arena.bytes_reserved <= (size_t)1 << 20, "the arena does not grow with the text");
    free(text);
    parse_fini(&parse);
}

static void test_tokens(void)
{
    Parse parse;
    parse_init(&parse, "", 0);
    Limits limits = LIMITS_DEFAULT;
    GrammarContext context = {parse.names, &parse.arena, &parse.diags, &limits, NULL, false, NULL};
    static const char text[] = "#declare A=.5;\nsphere \"x\" <= // end";
    Source *source = source_open_text(parse.sources, "test", text, sizeof text - 1);
    TextBuffer out;
    text_init(&out);
    bool clean = grammar_dump_tokens(&context, source, parse.sources, &out);
    tap_ok(clean && strcmp(text_get(&out), "1:1 directive `#declare`\n1:10 name `A`\n1:11 mark `=`\n1:12 number `0.5`\n"
                                           "1:14 mark `;`\n2:1 word `sphere`\n2:8 string \"x\"\n2:12 mark `<=`\n"
                                           "2:21 end the end of the file\n") == 0,
           "tokens are dumped");
    if (tap_failed > 0) {
        printf("# %s\n", text_get(&out));
    }
    text_fini(&out);
    parse_fini(&parse);
}

int main(void)
{
    test_programs();
    test_faults();
    test_depths();
    test_streaming();
    test_tokens();
    return tap_done();
}
