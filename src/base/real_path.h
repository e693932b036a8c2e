// Opening a file whose path was judged before, so that what is opened is what was judged.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_REAL_PATH_H
#define BASE_REAL_PATH_H

#include "base/attributes.h"

// Opens a path that realpath gave, part by part, `how` being O_RDONLY, or how it is written: a link that stands in it
// by now is an error (ELOOP, ENOTDIR). A pipe is opened without waiting for its other end. Returns a descriptor, or
// below 0 with errno.
int real_path_open(const char *real, int how) RT_MUST_CHECK;

#endif
