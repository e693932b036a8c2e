// The table of rtlang's options.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTION_TABLE_H
#define CLI_OPTION_TABLE_H

#include "cli/option_reader.h"
#include "cli/options.h"

// In the order of the help.
extern const OptionTable option_table;

// Whether a word is the code of a message, as E0201, in which case --explain tells of it and not of a scene.
bool option_is_code(const char *text);

#endif
