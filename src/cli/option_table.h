// The table of rtlang's options.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_OPTION_TABLE_H
#define CLI_OPTION_TABLE_H

#include "cli/option_reader.h"
#include "cli/options.h"

// In the order of the help.
extern const OptionTable option_table;

// The words of --planes.
typedef struct OptionPlane {
    const char *name;
    rt_plane plane;
} OptionPlane;
extern const OptionPlane option_planes[];
extern const size_t option_plane_count;

// Whether a word is the code of a message, as E0201, in which case --explain tells of it and not of a scene.
bool option_is_code(const char *text);

#endif
