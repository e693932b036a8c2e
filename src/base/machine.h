// How much memory a run may take where it runs: the machine's, its container's or its shell's.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

#include <stddef.h>

// The least of the machine's memory, the limits of the control groups (cgroup v1 and v2) and the process's own
// (RLIMIT_AS, RLIMIT_DATA), in bytes, less an eighth of a limit for what is not counted: code, stacks, libraries.
// SIZE_MAX where nothing of it is known.
size_t machine_memory(void);

#endif
