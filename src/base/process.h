// A copy of this process that continues where it stands, for work that is not to be done in this one.
//
// A program that has forbidden itself to start processes (base/confine_filter.h) may make copies still, by a number
// that is another one in each run: what a scene could make of the program would have to know it. Such a copy holds to
// all that was forbidden.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_PROCESS_H
#define BASE_PROCESS_H

#include <stdint.h>
#include <sys/types.h>

#include "base/attributes.h"

// The number: the upper half of the flags that the call `clone` takes, which the kernel does not read.
uint32_t process_key(void);

// As fork does: 0 in the copy, below 0 with errno when there is none. Where the program has forbidden fork, it must
// have one thread that runs: locks of the C library that others hold would stay so in the copy.
pid_t process_copy(void) RT_MUST_CHECK;

#endif
