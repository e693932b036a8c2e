// How much stack a thread has left, and a thread that has enough.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/stack.h"

#include <signal.h>
#include <stdint.h>
#include <sys/auxv.h>
#include <sys/resource.h>
#include <unistd.h>

typedef struct Errand {
    void (*work)(void *client);
    void *client;
} Errand;

static void *errand_run(void *argument)
{
    const Errand *errand = argument;
    errand->work(errand->client);
    return NULL;
}

// What is left of the first thread's stack, which grows from the program's name downwards to the limit. 0 on another
// stack, or where there is no limit.
static size_t first_stack_left(void)
{
    struct rlimit limit;
    uintptr_t here = (uintptr_t)__builtin_frame_address(0), top = (uintptr_t)getauxval(AT_EXECFN);
    bool is_known = getpid() == gettid() && getrlimit(RLIMIT_STACK, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
    return is_known && top > here && top - here < limit.rlim_cur ? (size_t)limit.rlim_cur - (top - here) : 0;
}

// 0 where the system does not say.
static size_t stack_left(void)
{
    pthread_attr_t attributes;
    void *lowest;
    size_t size, left = first_stack_left();
    if (left > 0) {
        return left; // the general way reads a file of the system's for it, a tenth of a small scene's instructions
    }
    if (pthread_getattr_np(pthread_self(), &attributes) != 0) {
        return 0;
    }
    bool is_known = pthread_attr_getstack(&attributes, &lowest, &size) == 0;
    pthread_attr_destroy(&attributes);
    uintptr_t here = (uintptr_t)__builtin_frame_address(0), low = (uintptr_t)lowest;
    return is_known && here > low && here - low <= size ? here - low : 0;
}

bool stack_thread(pthread_t *thread, void *(*work)(void *argument), void *argument)
{
    pthread_attr_t attributes;
    if (pthread_attr_init(&attributes) != 0) {
        return false;
    }
    bool is_started = pthread_attr_setstacksize(&attributes, STACK_BYTES) == 0 &&
                      pthread_create(thread, &attributes, work, argument) == 0;
    pthread_attr_destroy(&attributes);
    return is_started;
}

bool stack_run(size_t least, void (*work)(void *client), void *client)
{
    Errand errand = {work, client};
    pthread_t thread;
    if (stack_left() >= least) {
        work(client);
        return true;
    }
    if (!stack_thread(&thread, errand_run, &errand)) {
        return false;
    }
    // A signal is to end the call that waits for something, which is made there.
    sigset_t all, old;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &old);
    pthread_join(thread, NULL);
    pthread_sigmask(SIG_SETMASK, &old, NULL);
    return true;
}
