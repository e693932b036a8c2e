// The options that are in force, as a file that says them again.
//
// SPDX-License-Identifier: MIT
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/povray_read.h"

// A text in quotes of the kind that it does not hold. One that no file can say, as a word of a command line may be,
// makes the file a failed one.
static void put_text(FILE *out, bool *fine, const char *key, const char *text)
{
    char quote = strchr(text, '"') ? '\'' : '"';
    if (strpbrk(text, "\r\n") || strchr(text, quote)) {
        errno = EINVAL;
        *fine = false;
    } else {
        fprintf(out, "%s=%c%s%c\n", key, quote, text, quote);
    }
}

// NAME=NUMBER, without quotes.
static void put_declaration(FILE *out, bool *fine, const char *key, const char *text)
{
    if (strpbrk(text, "\r\n;\"'")) {
        errno = EINVAL;
        *fine = false;
    } else {
        fprintf(out, "%s=%s\n", key, text);
    }
}

typedef void (*Put)(FILE *out, bool *fine, const char *key, const char *text);

static void put_list(FILE *out, bool *fine, const char *key, const char *const *items, size_t count, Put put)
{
    for (size_t i = 0; i < count; i++) {
        put(out, fine, key, items[i]);
    }
}

// A number that was not said is below the row's least one, or it is 0, where that is what it is then.
static bool is_said(const PovrayRow *row, double number, double usual)
{
    return !isnan(number) && number >= row->low && (row->low < 0.0 || number > 0.0 || usual != 0.0);
}

// What was not said is left out.
static void put_row(FILE *out, bool *fine, const PovraySettings *settings, const PovraySettings *usual,
                    const PovrayRow *row)
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
        if (is_said(row, number, *(const double *)((const char *)usual + row->field))) {
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
            put_text(out, fine, row->key, text);
        }
        break;
    case POVRAY_TYPE:
        fprintf(out, "%s=%c\n", row->key, settings->type);
        break;
    case POVRAY_LIBRARY:
        put_list(out, fine, row->key, settings->libraries, settings->library_count, put_text);
        break;
    case POVRAY_DECLARE:
        put_list(out, fine, row->key, settings->declarations, settings->declaration_count, put_declaration);
        break;
    case POVRAY_ALL_ON: // each stream says it
    case POVRAY_INI:
        break;
    }
}

bool povray_write_ini(const PovraySettings *settings, const char *path)
{
    FILE *out = fopen(path, "we");
    bool fine = true;
    const PovrayRow *row;
    PovraySettings usual;
    povray_settings_init(&usual);
    for (size_t i = 0; out && (row = povray_row(i)); i++) {
        bool is_again = i > 0 && povray_row(i - 1)->field == row->field && povray_row(i - 1)->is_followed;
        if (row->is_followed && !is_again) {
            put_row(out, &fine, settings, &usual, row);
        }
    }
    povray_settings_fini(&usual);
    int error_number = errno;
    fine = out && !ferror(out) && fine;
    bool is_closed = out && fclose(out) == 0;
    errno = is_closed ? error_number : errno;
    return is_closed && fine;
}
