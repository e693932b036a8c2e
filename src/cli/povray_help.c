// The table of POV-Ray's options as text.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "cli/povray.h"

// "+A[n], -A" of an option that is on or off; "+W n" of others.
static void print_switch(const PovrayRow *row, char *text, size_t size)
{
    bool has_sign = row->kind == POVRAY_BOOL || row->kind == POVRAY_ALL_ON;
    const char *value = row->value_key ? (strstr(row->value_key, "File") && row->letters[0] == 'G' ? "[file]" : "[x]")
                        : has_sign     ? ""
                                       : "x";
    text[0] = '\0';
    if (row->letters) {
        snprintf(text, size, "%s%s%s", has_sign ? "+-" : "+", row->letters, value);
    }
}

void povray_print_help(FILE *out)
{
    fprintf(out, "Usage: povray [SWITCH | KEY=VALUE | FILE.ini | FILE.ini[SECTION] | SCENE]...\n"
                 "or the same words behind `rtlang --povray`. Options of rtlang may be among them, as --name=value.\n\n"
                 "What becomes of POV-Ray 3.7's options:\n\n");
    const PovrayRow *row;
    for (size_t i = 0; (row = povray_row(i)); i++) {
        char letters[32];
        const char *line = row->help;
        print_switch(row, letters, sizeof letters);
        fprintf(out, "  %-24s %-10s %s", row->key, letters,
                row->is_followed          ? ""
                : !row->refusal    ? "no effect: "
                : row->low > 0.0          ? "off is refused: "
                : row->kind == POVRAY_BOOL ? "on is refused: "
                                           : "refused: ");
        for (const char *c = row->refusal && !row->is_followed ? row->refusal : line; *c; c++) {
            *c == '\n' ? fprintf(out, "\n%38s", "") : fputc(*c, out);
        }
        fputc('\n', out);
    }
    fprintf(out, "\nExit status: 0 fine, 1 an error, 2 interrupted.\n");
}
