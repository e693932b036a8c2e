// Any bytes are the choices of one who writes a scene: the program is valid, so that it is taken, and it is the same
// scene as it stands, in the canonical layout, and read without the quick ways.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "base/text.h"
#include "fuzz/fuzz.h"
#include "rtlang/rtlang.h"

enum { STATEMENTS_MOST = 40, DEPTH_MOST = 3, NAMES_MOST = 20 };

// Names are N0, V0, F0, M0, counted by kind.
typedef struct Writer {
    const uint8_t *at, *end;
    TextBuffer text;
    unsigned numbers, vectors, functions, macros, loops;
    unsigned depth; // of directives around the present statement
    bool is_in_macro;
} Writer;

static unsigned take(Writer *writer)
{
    return writer->at < writer->end ? *writer->at++ : 0;
}

static unsigned choose(Writer *writer, unsigned count)
{
    return take(writer) % count;
}

#define ADD(...) text_printf(&writer->text, __VA_ARGS__)

// ---- values

static void add_vector(Writer *writer, unsigned depth);

static void add_literal(Writer *writer)
{
    static const char *const literals[] = {"0", "1", "2", "-1", ".5", "0.25", "3e-3", "-2.75", "7", "10", "1e3", "pi"};
    ADD("%s", literals[choose(writer, sizeof literals / sizeof *literals)]);
}

static void add_number(Writer *writer, unsigned depth)
{
    static const char *const between[] = {"+", "-", "*", "<", ">=", "=", "&", "|"};
    static const char *const functions[] = {"abs", "sin", "floor", "int", "exp", "atan2", "min", "max"};
    unsigned choice = depth == 0 ? choose(writer, 2) : choose(writer, 8);
    if (choice == 1 && writer->numbers > 0) {
        ADD("N%u", choose(writer, writer->numbers));
    } else if (choice < 3) {
        add_literal(writer);
    } else if (choice < 5) {
        const char *operation = between[choose(writer, 8)];
        ADD("(");
        add_number(writer, depth - 1);
        ADD(" %s ", operation);
        add_number(writer, depth - 1);
        ADD(")");
    } else if (choice == 5) {
        unsigned which = choose(writer, 8);
        ADD("%s(mod(", functions[which]);
        add_number(writer, depth - 1);
        ADD(", 5)%s)", which > 4 ? ", 0.5" : "");
    } else if (choice == 6) {
        add_vector(writer, depth - 1);
        ADD(".%c", "xyz"[choose(writer, 3)]);
    } else {
        ADD(writer->functions > 0 ? "F%u(" : "abs(", writer->functions > 0 ? choose(writer, writer->functions) : 0);
        add_number(writer, depth - 1);
        ADD(")");
    }
}

static void add_vector(Writer *writer, unsigned depth)
{
    unsigned choice = depth == 0 ? choose(writer, 2) : choose(writer, 5);
    if (choice == 1 && writer->vectors > 0) {
        ADD("V%u", choose(writer, writer->vectors));
    } else if (choice < 2) {
        ADD("<%d, %d, %d>", (int)choose(writer, 9) - 4, (int)choose(writer, 9) - 4, (int)choose(writer, 9) - 4);
    } else if (choice == 2) {
        ADD("(");
        add_vector(writer, depth - 1);
        ADD(choose(writer, 2) ? " + " : " * ");
        add_vector(writer, depth - 1);
        ADD(")");
    } else if (choice == 3) {
        ADD("vrotate(x, ");
        add_vector(writer, depth - 1);
        ADD(")");
    } else {
        ADD("<");
        add_number(writer, depth - 1);
        ADD(", 1, ");
        add_number(writer, depth - 1);
        ADD(">");
    }
}

// What is not more than 5, and what is more than 0.
static void add_small(Writer *writer)
{
    ADD("mod(");
    add_number(writer, 2);
    ADD(", 5)");
}

static void add_size(Writer *writer)
{
    ADD("(0.1 + abs(");
    add_small(writer);
    ADD("))");
}

static void add_place(Writer *writer)
{
    ADD("<");
    for (int i = 0; i < 3; i++) {
        add_small(writer);
        ADD(i < 2 ? ", " : ">");
    }
}

// ---- objects

static void add_look(Writer *writer)
{
    static const char *const patterns[] = {"bozo", "gradient y", "granite", "checker rgb 1, rgb 0", "wood"};
    static const char *const finishes[] = {"ambient 0.3", "phong 0.5", "reflection 0.2", "specular 1 roughness 0.1"};
    static const char *const transforms[] = {"translate", "rotate"};
    if (choose(writer, 2)) {
        ADD(" pigment { rgb <");
        add_small(writer);
        ADD(", 1, 0.5> }");
    } else if (choose(writer, 2)) {
        ADD(" texture { pigment { %s scale ", patterns[choose(writer, 5)]);
        add_size(writer);
        ADD(" } finish { %s } }", finishes[choose(writer, 4)]);
    }
    if (choose(writer, 2)) {
        ADD(" %s ", transforms[choose(writer, 2)]);
        add_place(writer);
    }
    ADD(" }\n");
}

static void add_object(Writer *writer, unsigned depth)
{
    static const char *const groups[] = {"union", "merge", "intersection", "difference"};
    switch (depth > 0 ? choose(writer, 8) : choose(writer, 5)) {
    case 1:
        ADD("box { -1, <1, 2, ");
        add_size(writer);
        ADD(">");
        break;
    case 2:
        ADD("cylinder { 0, 2*y, ");
        add_size(writer);
        break;
    case 3:
        ADD("torus { 1, ");
        add_size(writer);
        break;
    case 4:
        ADD("blob { threshold 0.5 sphere { 0, ");
        add_size(writer);
        ADD(", 1 } cylinder { 0, y, 1, 0.7 }");
        break;
    case 5:
    case 6:
        ADD("%s { ", groups[choose(writer, 4)]);
        add_object(writer, depth - 1);
        add_object(writer, depth - 1);
        break;
    default:
        ADD("sphere { ");
        add_place(writer);
        ADD(", ");
        add_size(writer);
    }
    add_look(writer);
}

// ---- statements

static void add_statement(Writer *writer);

static void add_block(Writer *writer)
{
    writer->depth++;
    for (unsigned i = choose(writer, 3) + 1; i > 0; i--) {
        add_statement(writer);
    }
    writer->depth--;
}

// Names that a branch declares may not be there behind it.
static void add_branches(Writer *writer)
{
    unsigned numbers = writer->numbers, vectors = writer->vectors;
    ADD("#if (");
    add_number(writer, 2);
    ADD(")\n");
    add_block(writer);
    writer->numbers = numbers;
    writer->vectors = vectors;
    if (choose(writer, 2)) {
        ADD("#else\n");
        add_block(writer);
        writer->numbers = numbers;
        writer->vectors = vectors;
    }
    ADD("#end\n");
}

static void add_loop(Writer *writer)
{
    unsigned numbers = writer->numbers, vectors = writer->vectors;
    ADD("#for (L%u, 1, %u)\n", writer->loops++, choose(writer, 6));
    add_block(writer);
    ADD("#end\n");
    writer->numbers = numbers;
    writer->vectors = vectors;
}

// A macro is defined where nothing is around it.
static void add_macro(Writer *writer)
{
    unsigned numbers = writer->numbers, vectors = writer->vectors;
    ADD("#macro M%u(P, Q)\n#local N%u = P*0.5 + mod(Q, 3);\n", writer->macros, writer->numbers++);
    writer->is_in_macro = true;
    add_block(writer);
    writer->is_in_macro = false;
    ADD("#end\n");
    writer->numbers = numbers;
    writer->vectors = vectors;
    writer->macros++;
}

static void add_statement(Writer *writer)
{
    const char *declare = writer->is_in_macro || choose(writer, 4) == 0 ? "local" : "declare";
    bool is_free = writer->depth == 0;
    switch (choose(writer, is_free ? 10 : writer->depth < DEPTH_MOST ? 8 : 6)) {
    case 0:
        ADD("#%s N%u = ", declare, writer->numbers % NAMES_MOST);
        add_number(writer, 3);
        ADD(";\n");
        writer->numbers += writer->numbers < NAMES_MOST;
        break;
    case 1:
        ADD("#%s V%u = ", declare, writer->vectors % NAMES_MOST);
        add_vector(writer, 3);
        ADD(";\n");
        writer->vectors += writer->vectors < NAMES_MOST;
        break;
    case 2:
        if (writer->macros > 0 && !writer->is_in_macro) {
            ADD("M%u(", choose(writer, writer->macros));
            add_small(writer);
            ADD(", 2)\n");
            break;
        }
        add_object(writer, 1);
        break;
    case 6:
        add_branches(writer);
        break;
    case 7:
        add_loop(writer);
        break;
    case 8:
        add_macro(writer);
        break;
    case 9:
        ADD("#declare F%u = function (x) { ", writer->functions);
        ADD("x*%u + sin(x)%s }\n", choose(writer, 5), choose(writer, 2) ? " - abs(x - 1)" : "");
        writer->functions++;
        break;
    default:
        add_object(writer, 2);
        break;
    }
}

// ---- what must hold

// What is printed of a scene, to be freed; NULL: there is a limit, or no memory.
static char *dump(const char *text, size_t size, bool has_literals)
{
    const char *printed = NULL;
    char *copy = NULL;
    rt_session *session = rt_session_new(NULL);
    if (session) {
        rt_set_untrusted(session);
        rt_set_limit(session, RT_LIMIT_OBJECTS, 2000);
        rt_set_literals(session, has_literals);
        rt_status status = rt_load_text(session, "program", text, size);
        FUZZ_HOLDS(status == RT_OK || status == RT_FAULT_LIMIT);
        if (status == RT_OK && rt_dump_scene(session, &printed) == RT_OK) {
            copy = strdup(printed);
        }
    }
    rt_session_free(session);
    return copy;
}

static char *format(const char *text, size_t size)
{
    char path[FUZZ_PATH], *copy = NULL;
    const char *laid_out = NULL;
    rt_session *session = rt_session_new(NULL);
    int fd = fuzz_file((const uint8_t *)text, size, path);
    if (session && fd >= 0) {
        FUZZ_HOLDS(rt_format_file(session, path, &laid_out) == RT_OK && laid_out);
        copy = strdup(laid_out);
    }
    rt_session_free(session);
    if (fd >= 0) {
        close(fd);
    }
    return copy;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    Writer program = {.at = data, .end = data + size}, *writer = &program;
    text_init(&program.text);
    ADD("#version 3.7;\nglobal_settings { assumed_gamma 1 }\ncamera { location -9*z }\nlight_source { 9, 1 }\n");
    for (int i = 0; program.at < program.end && i < STATEMENTS_MOST; i++) {
        add_statement(writer);
    }
    const char *text = text_get(&program.text);
    if (getenv("FUZZ_SHOW")) {
        fputs(text, stderr);
    }
    char *once = dump(text, program.text.length, true), *slow = dump(text, program.text.length, false);
    char *laid_out = format(text, program.text.length);
    char *again = laid_out ? dump(laid_out, strlen(laid_out), true) : NULL;
    FUZZ_HOLDS(!once || !slow || strcmp(once, slow) == 0);
    FUZZ_HOLDS(!once || !again || strcmp(once, again) == 0);
    free(once);
    free(slow);
    free(laid_out);
    free(again);
    text_fini(&program.text);
    return 0;
}
