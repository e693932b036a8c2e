// One function on several threads at once; the caller's thread is one of them.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_PARALLEL_H
#define BASE_PARALLEL_H

#include <stddef.h>

enum { PARALLEL_THREADS_MAX = 1024 };

// Calls work(client, number) on up to `threads` threads, numbered from 0, which is the caller's, and returns when all
// have returned. Those started have a stack of STACK_BYTES (base/stack.h). A thread that cannot be started is done
// without, so `work` must share what there is to do by what is left, not by number. Returns how many there were.
int parallel_run(int threads, void (*work)(void *client, int number), void *client);

// Calls work(client, begin, end) for all of 0 <= i < count in runs of `run`, in any order; on the caller's thread alone
// when there is but one run.
void parallel_share(int threads, size_t count, size_t run, void (*work)(void *client, size_t begin, size_t end),
                    void *client);

#endif
