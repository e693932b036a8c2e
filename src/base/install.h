// Where an installed rtlang keeps its files, wherever it was moved to.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_INSTALL_H
#define BASE_INSTALL_H

#include <limits.h>
#include <stdbool.h>

typedef enum InstallKind {
    INSTALL_DATA,    // include files
    INSTALL_MODULES, // what is loaded at run time
} InstallKind;

enum { INSTALL_PLACES = 2 };

// The place number `i`, from 0, where files of a kind may lie: as far from the program or library that this code is
// part of as when it was installed, or in its build tree; then the prefix that was configured. It need not exist. False
// when there is no such place, or the first one says the same. May be called from any thread.
bool install_place(InstallKind kind, unsigned i, char folder[static PATH_MAX]);

#endif
