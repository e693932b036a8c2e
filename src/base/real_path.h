// Opening a file whose path was judged before, so that what is opened is what was judged.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_REAL_PATH_H
#define BASE_REAL_PATH_H

#include "base/attributes.h"

// Opens a path that realpath gave for reading, part by part: a link that stands in it by now is an error (ELOOP,
// ENOTDIR). A pipe is opened without waiting for its writer. Returns a descriptor, or below 0 with errno.
int real_path_open(const char *real) RT_MUST_CHECK;

#endif
