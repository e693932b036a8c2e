// What rtcheck says of itself on stderr.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_SAY_H
#define CHECK_SAY_H

#include "check/options.h"

// One line, after the program's name, which is coloured where the options want that.
__attribute__((format(printf, 2, 3))) void say(const Options *options, const char *format, ...);

#endif
