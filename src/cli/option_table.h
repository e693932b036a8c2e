// The table of rtlang's options: a line has an option's names, its argument, its help and what it does.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTION_TABLE_H
#define CLI_OPTION_TABLE_H

#include <stddef.h>

#include "cli/options.h"

// Takes the argument of an option; false when it is not acceptable, after saying why in *expected.
typedef bool (*OptionApply)(Options *options, const char *argument, const char **expected);

typedef struct OptionRow {
    char letter; // 0: no short form
    const char *name;
    const char *argument; // NULL: takes none; may be left out when it begins with `[`
    OptionApply apply;    // NULL: handled by options_parse itself
    const char *help;
} OptionRow;

enum { OPTIONS_MOST = 96 };

// The options in the order of the help; NULL from their number on, which is below OPTIONS_MOST.
const OptionRow *option_row(size_t i);

// Whether a word is the code of a message, as E0201, in which case --explain tells of it and not of a scene.
bool option_is_code(const char *text);

#endif
