// The filter of system calls that seccomp takes: what of confine() is no question of folders.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_CONFINE_FILTER_H
#define CLI_CONFINE_FILTER_H

#include <stdbool.h>

// Whether this kernel and processor have it.
bool confine_filter_exists(void);

// From now on calls for other programs, processes and sockets fail with EPERM; `is_strict`: and so does making memory
// that can be run, which loading a library needs; `serves`: connections of a socket that listens may be taken and
// answered.
void confine_filter(bool is_strict, bool serves);

#endif
