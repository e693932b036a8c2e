// The options that are in force, as a file that says them again.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/povray_read.h"

static void put_list(FILE *out, const char *key, const char *const *items, size_t count, bool is_quoted)
{
    for (size_t i = 0; i < count; i++) {
        fprintf(out, is_quoted ? "%s=\"%s\"\n" : "%s=%s\n", key, items[i]);
    }
}

// What was not said is left out.
static void put_row(FILE *out, const PovraySettings *settings, const PovrayRow *row)
{
    const void *field = (const char *)settings + row->field;
    const char *text;
    double number;
    switch (row->kind) {
    case POVRAY_BOOL:
        fprintf(out, "%s=%s\n", row->key, *(const bool *)field ? "On" : "Off");
        break;
    case POVRAY_INTEGER:
    case POVRAY_BITS:
        if (*(const int *)field >= row->low) {
            fprintf(out, "%s=%d\n", row->key, *(const int *)field);
        }
        break;
    case POVRAY_NUMBER:
        number = *(const double *)field;
        if (!isnan(number) && number >= row->low && (row->low < 0.0 || number > 0.0)) {
            fprintf(out, "%s=%.17g\n", row->key, number);
        }
        break;
    case POVRAY_GAMMA:
        number = *(const double *)field;
        fprintf(out, number > 0.0 ? "%s=%.17g\n" : "%s=sRGB\n", row->key, number);
        break;
    case POVRAY_TEXT:
    case POVRAY_FILE:
        text = *(const char *const *)field;
        if (text && text[0]) {
            fprintf(out, "%s=\"%s\"\n", row->key, text);
        }
        break;
    case POVRAY_TYPE:
        fprintf(out, "%s=%c\n", row->key, settings->type);
        break;
    case POVRAY_LIBRARY:
        put_list(out, row->key, settings->libraries, settings->library_count, true);
        break;
    case POVRAY_DECLARE:
        put_list(out, row->key, settings->declarations, settings->declaration_count, false);
        break;
    case POVRAY_ALL_ON: // each stream says it
    case POVRAY_INI:
        break;
    }
}

bool povray_write_ini(const PovraySettings *settings, const char *path)
{
    FILE *out = fopen(path, "we");
    const PovrayRow *row;
    for (size_t i = 0; out && (row = povray_row(i)); i++) {
        bool is_again = i > 0 && povray_row(i - 1)->field == row->field && povray_row(i - 1)->is_followed;
        if (row->is_followed && !is_again) {
            put_row(out, settings, row);
        }
    }
    bool fine = out && !ferror(out);
    return out && fclose(out) == 0 && fine;
}
