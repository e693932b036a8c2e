// Reading a command line with getopt_long by a table: each row has an option's names, its argument, its help and what it
// does. Both programs read theirs so.
//
// Fills a program's own `struct Options`, of which it knows nothing. Prints nothing but the help.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTION_READER_H
#define CLI_OPTION_READER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct Options Options;

enum { COMPLAINT_SIZE = 512, ADVICE_SIZE = 128, RANGE_SIZE = 64 };

// What is known of the option that is being read, and what is wrong with a command line.
typedef struct OptionReading {
    bool is_letter;             // it was given by its letter
    const char *expected;       // of its argument; to be set by what takes it
    char range[RANGE_SIZE];     // where that is a whole number of a range, its words
    const char *const *choices; // its argument is one of these, of which the last is NULL; NULL: it is none of a few
    char complaint[COMPLAINT_SIZE];
    char advice[ADVICE_SIZE]; // what may have been meant; empty: nothing near
} OptionReading;

// Takes the argument of an option, NULL where it has none; false when it is not what is expected.
typedef bool (*OptionApply)(Options *options, const char *argument, OptionReading *reading);

typedef struct OptionRow {
    char letter; // 0: no short form
    const char *name;
    const char *argument; // NULL: takes none; may be left out when it begins with `[`
    OptionApply apply;    // NULL: it prints something and ends the program
    const char *help;     // one sentence or more, which the printer wraps
} OptionRow;

// A heading of the help.
typedef struct OptionGroup {
    const char *heading;
    const char *first; // the name of the option that it stands before
} OptionGroup;

typedef struct OptionTable {
    const OptionRow *rows;
    size_t count; // at most OPTIONS_MOST
    const OptionGroup *groups;
    size_t group_count;
} OptionTable;

enum { OPTIONS_MOST = 96 };

typedef enum OptionsResult {
    OPTIONS_GO,    // run
    OPTIONS_DONE,  // what was asked for stands in the buffer of stdout
    OPTIONS_WRONG, // see OptionReading.complaint
    OPTIONS_NO_MEMORY,
} OptionsResult;

// Takes all options; getopt's `optind` is then that of the first word that is none. *stops is the row that ends the
// program, with getopt's `optarg`, and NULL where none does.
OptionsResult option_reader_run(const OptionTable *table, int argc, char **argv, Options *options,
                                OptionReading *reading, const OptionRow **stops);

// Sets the complaint; returns OPTIONS_WRONG.
OptionsResult option_complain(OptionReading *reading, const char *format, ...) __attribute__((format(printf, 2, 3)));

// The rows of a help under their headings, in lines of at most 80 columns.
void option_print_rows(const OptionTable *table, FILE *out);

// A whole number of that range, and nothing else.
bool option_parse_integer(const char *text, long low, long high, int *value);

// The same of a whole argument; sets what is expected of it.
bool option_take_integer(OptionReading *reading, const char *argument, int low, int high, int *value);

// A finite number, and nothing else.
bool option_parse_number(const char *text, double *value);

// The place of the argument among names of which the last is NULL.
bool option_parse_choice(OptionReading *reading, const char *argument, const char *const *names, int *place);

#endif
