// The sentry: a thread that sees when a file of the scene is saved, and then cancels what is being drawn.
//
// It looks at times and sizes twenty times a second, which works on every file system, and reports a save when two
// looks in a row find the same, so that no half of a file is read. Owns the list of files.
//
// SPDX-License-Identifier: MIT
#ifndef WATCH_SENTRY_H
#define WATCH_SENTRY_H

#include <pthread.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#include "base/attributes.h"
#include "rtlang/rtlang.h"

typedef struct SentryStamp {
    bool exists;
    ino_t number;
    off_t size;
    int64_t modified; // nanoseconds
} SentryStamp;

typedef struct SentryFile {
    char *path;
    SentryStamp stamp;
} SentryFile;

typedef struct Sentry {
    pthread_t thread;
    bool has_thread;
    pthread_mutex_t lock;
    pthread_cond_t woken;
    const volatile sig_atomic_t *interrupted_by;
    rt_session *session; // that is to be cancelled; NULL: none
    SentryFile *files;
    size_t file_count;
    bool is_changed, is_over;
    double changed_at; // by the clock
} Sentry;

// Watches one file at first. The signal's flag, once set, is the end.
bool sentry_start(Sentry *sentry, const char *path, const volatile sig_atomic_t *interrupted_by) RT_MUST_CHECK;
void sentry_stop(Sentry *sentry);

// What is read from now on is what was saved until now; a session is cancelled by the next save or by the end. Returns
// when the save was seen.
double sentry_begin(Sentry *sentry, rt_session *session);
// There is no session any more.
void sentry_end(Sentry *sentry);

// The scene's files, sorted, each once, and read since `begun`, by the wall's clock: one that is new here and younger
// than that was saved meanwhile. False when out of memory, which leaves the old ones.
bool sentry_set_files(Sentry *sentry, const char *const *paths, size_t count, int64_t begun) RT_MUST_CHECK;
bool sentry_has_file(Sentry *sentry, const char *path);

// Nanoseconds by the wall's clock, as files have them.
int64_t sentry_wall_clock(void);

// Waits for the next save; false when it is over.
bool sentry_wait(Sentry *sentry) RT_MUST_CHECK;

#endif
