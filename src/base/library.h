// The library path: folders of include files that every scene may use, searched after those that the client names.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_LIBRARY_H
#define BASE_LIBRARY_H

#include <stdbool.h>

#include "base/array.h"
#include "base/attributes.h"

// All zero: not looked for yet, with POV-Ray's folders.
typedef struct Library {
    bool has_no_povray;     // only rtlang's own folder
    bool is_filled, failed; // by library_fill; when out of memory
    ARRAY(char *) folders;  // real paths of folders that are there, in the order of searching; owned
} Library;

// Finds the folders at the first call: rtlang's own (base/install.h), then those of an installed POV-Ray. False when
// out of memory.
bool library_fill(Library *library) RT_MUST_CHECK;
void library_fini(Library *library);

// Whether a file is one of the standard include files of POV-Ray, with or without its ending.
bool library_is_standard(const char *name);

#endif
