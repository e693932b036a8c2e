// A stack that bears what scenes may nest.
//
// The language, a scene's composites and its maps of textures are walked by recursion, which the limits of
// base/limits.h bound. What they allow takes up to 2.4 MB (docs/architecture.md has how that was measured): more than
// some programs give their threads.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_STACK_H
#define BASE_STACK_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"

enum {
    STACK_BYTES = 32 << 20,      // of a thread that is started: the largest composite; touched only as it is used
    STACK_BYTES_LEAST = 4 << 20, // what the work of a session needs of the thread that asks for it
};

// Starts a thread that calls work(argument), with a stack of STACK_BYTES; false when that cannot be done.
bool stack_thread(pthread_t *thread, void *(*work)(void *argument), void *argument) RT_MUST_CHECK;

// Calls work(client): on this thread, or, where its stack has less than `least` bytes left, on one that is started for that
// while this one waits; signals to the process are then taken there. False when that thread cannot be started:
// nothing was called.
bool stack_run(size_t least, void (*work)(void *client), void *client) RT_MUST_CHECK;

#endif
