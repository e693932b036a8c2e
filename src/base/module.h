// Finding and loading the modules that wrap a library which only some runs need.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_MODULE_H
#define BASE_MODULE_H

#include <stddef.h>

#include "base/attributes.h"

typedef struct ModuleKind {
    const char *file, *symbol;
    unsigned version; // the first member of what the symbol names
    size_t room;      // address space that its libraries want
} ModuleKind;

typedef enum ModuleResult {
    MODULE_OK,
    MODULE_NONE,     // there is none
    MODULE_NO_MEMORY // no room for the libraries that it loads
} ModuleResult;

// Sets *module to what the symbol names. Without one, `why` has the loader's message, or where it was looked for: one
// line, cut to fit. It is looked for in the places of base/install.h. Once loaded it stays in the process; another call
// then costs little. May be called from any thread.
ModuleResult module_load(const ModuleKind *kind, const void **module, char *why, size_t size) RT_MUST_CHECK;

#endif
