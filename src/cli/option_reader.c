// SPDX-License-Identifier: MIT
#include "cli/option_reader.h"

#include <ctype.h>
#include <getopt.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"
#include "cli/terminal.h"

static bool is_optional(const OptionRow *row)
{
    return row->argument && row->argument[0] == '[';
}

enum { HELP_COLUMNS = 80, HELP_INDENT = 29 };

static void append_heading(const OptionTable *table, const OptionRow *row, TextBuffer *out)
{
    for (size_t i = 0; i < table->group_count; i++) {
        if (strcmp(table->groups[i].first, row->name) == 0) {
            text_printf(out, "%s%s:\n", i > 0 ? "\n" : "", table->groups[i].heading);
        }
    }
}

static void append_row(const OptionRow *row, TextBuffer *out)
{
    size_t start = out->length;
    bool may_lack = is_optional(row);
    text_printf(out, row->letter ? "  -%c, --%s" : "  %c   --%s", row->letter ? row->letter : ' ', row->name);
    if (row->argument) {
        text_printf(out, "%s%s", may_lack ? "[=" : "=", row->argument + may_lack);
    }
    size_t width = out->length - start;
    if (width + 2 > HELP_INDENT) {
        text_append_char(out, '\n');
        width = 0;
    }
    text_printf(out, "%*s", HELP_INDENT - (int)width, "");
    text_append_wrapped(out, row->help, HELP_INDENT, HELP_INDENT, HELP_COLUMNS);
}

static void append_rows(const OptionTable *table, TextBuffer *out)
{
    for (const OptionRow *row = table->rows; row < table->rows + table->count; row++) {
        append_heading(table, row, out);
        append_row(row, out);
    }
}

void option_print_rows(const OptionTable *table, FILE *out)
{
    TextBuffer text;
    text_init(&text);
    append_rows(table, &text);
    fputs(text_get(&text), out);
    text_fini(&text);
}

// The table in getopt's two forms. An option's `val` is its row's number above all characters.
enum { FIRST_VAL = 256 };

static void make_getopt_tables(const OptionTable *table, struct option *long_options, char *short_options)
{
    *short_options++ = ':';
    for (size_t i = 0; i < table->count; i++) {
        const OptionRow *row = &table->rows[i];
        int kind = is_optional(row) ? optional_argument : row->argument ? required_argument : no_argument;
        long_options[i] = (struct option){row->name, kind, NULL, FIRST_VAL + (int)i};
        if (row->letter) {
            *short_options++ = row->letter;
        }
        for (int colons = 0; row->letter && row->argument && colons < kind; colons++) {
            *short_options++ = ':'; // two of an argument that may lack
        }
    }
    long_options[table->count] = (struct option){0};
    *short_options = '\0';
}

static const OptionRow *find_row(const OptionTable *table, int val)
{
    for (size_t i = 0; i < table->count; i++) {
        const OptionRow *row = &table->rows[i];
        if (val == FIRST_VAL + (int)i || (row->letter && val == row->letter)) {
            return row;
        }
    }
    return NULL;
}

OptionsResult option_complain(OptionReading *reading, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(reading->complaint, sizeof reading->complaint, format, arguments);
    va_end(arguments);
    return OPTIONS_WRONG;
}

// The long options that a word, `--name` or `--name=value`, may be short for, as text; false when there are fewer than
// two.
static bool list_candidates(const OptionTable *table, const char *word, char *list, size_t size)
{
    size_t length = strcspn(word, "="), used = 0;
    unsigned count = 0;
    for (size_t i = 0; length > 2 && i < table->count && used < size; i++) {
        const char *name = table->rows[i].name;
        if (strncmp(word, "--", 2) == 0 && strncmp(word + 2, name, length - 2) == 0) {
            used += (size_t)snprintf(list + used, size - used, "%s`--%s`", count > 0 ? ", " : "", name);
            count++;
        }
    }
    return count > 1;
}

static void advise(const OptionTable *table, OptionReading *reading, const char *word)
{
    const char *names[OPTIONS_MOST + 1];
    for (size_t i = 0; i < table->count; i++) {
        names[i] = table->rows[i].name;
    }
    names[table->count] = NULL;
    advise_option(word, names, reading->advice, sizeof reading->advice);
}

// What getopt could not make sense of.
static OptionsResult complain_getopt(const OptionTable *table, OptionReading *reading, int val, int argc, char **argv)
{
    const OptionRow *row = find_row(table, optopt);
    bool is_letter = optopt && optopt < FIRST_VAL;
    const char *word = option_word(argc, argv, is_letter ? optopt : 0);
    char letter[3] = {'-', (char)optopt, '\0'};
    char candidates[512];
    if (val == ':') {
        snprintf(candidates, sizeof candidates, "--%s=%s", row ? row->name : "", row ? row->argument : "");
        return option_complain(reading, "option `--%s` wants an argument: `%s`", row ? row->name : word, candidates);
    }
    if (!row && !optopt && list_candidates(table, word, candidates, sizeof candidates)) {
        return option_complain(reading, "option `%s` may be short for %s", word, candidates);
    }
    if (row) {
        return option_complain(reading, "option `--%s` takes no argument", row->name);
    }
    int other = is_letter ? (islower(optopt) ? toupper(optopt) : tolower(optopt)) : 0;
    advise(table, reading, word);
    if (!reading->advice[0] && other != optopt && find_row(table, other)) {
        snprintf(reading->advice, sizeof reading->advice, "did you mean `-%c`?", other);
    }
    return option_complain(reading, "unknown option `%s`", is_letter ? letter : word);
}

static OptionsResult complain_argument(OptionReading *reading, const OptionRow *row)
{
    if (reading->choices) {
        advise_value(optarg, reading->choices, reading->advice, sizeof reading->advice);
    }
    return option_complain(reading, "option `--%s` wants %s, found `%.40s`", row->name, reading->expected,
                           optarg ? optarg : "");
}

OptionsResult option_reader_run(const OptionTable *table, int argc, char **argv, Options *options,
                                OptionReading *reading, const OptionRow **stops)
{
    struct option long_options[OPTIONS_MOST + 1];
    char short_options[3 * OPTIONS_MOST + 2];
    make_getopt_tables(table, long_options, short_options);
    *stops = NULL;
    opterr = 0;
    optind = 0; // from the first word, whatever was read before
    for (int val; (val = getopt_long(argc, argv, short_options, long_options, NULL)) != -1;) {
        const OptionRow *row = val == '?' || val == ':' ? NULL : find_row(table, val);
        if (!row) {
            return complain_getopt(table, reading, val, argc, argv);
        }
        if (!row->apply) {
            *stops = row;
            return OPTIONS_DONE;
        }
        reading->is_letter = val < FIRST_VAL;
        reading->choices = NULL;
        reading->expected = "";
        if (!row->apply(options, optarg, reading)) {
            return complain_argument(reading, row);
        }
    }
    return OPTIONS_GO;
}

bool option_parse_integer(const char *text, long low, long high, int *value)
{
    char *end;
    long number = strtol(text, &end, 10);
    if (end == text || *end || number < low || number > high) {
        return false;
    }
    *value = (int)number;
    return true;
}

bool option_take_integer(OptionReading *reading, const char *argument, int low, int high, int *value)
{
    snprintf(reading->range, sizeof reading->range, "a whole number from %d to %d", low, high);
    reading->expected = reading->range;
    return option_parse_integer(argument, low, high, value);
}

bool option_parse_number(const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && isfinite(*value);
}

bool option_parse_choice(OptionReading *reading, const char *argument, const char *const *names, int *place)
{
    reading->choices = names;
    *place = choice_find(argument, names);
    return *place >= 0;
}
