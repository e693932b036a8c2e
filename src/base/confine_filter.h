// The filter of system calls that seccomp takes: what of a program's confinement is no question of folders.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_CONFINE_FILTER_H
#define BASE_CONFINE_FILTER_H

#include <stdbool.h>

// Whether this kernel and processor have it.
bool confine_filter_exists(void);

// From now on calls for other programs, processes and sockets fail with EPERM; process_copy() works. By what else is
// said of it:
typedef enum ConfineFilter {
    CONFINE_IS_STRICT = 1, // no memory can be made that can be run, which loading a library needs
    CONFINE_SERVES = 2,    // connections of a socket that listens may be taken and answered
    CONFINE_READS = 4,     // no copies, no file is opened to be written, made, renamed or removed
} ConfineFilter;

// Holds for the calling thread and those that it starts; with CONFINE_READS for all that there are. Filters add up.
void confine_filter(unsigned what);

#endif
