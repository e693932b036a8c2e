// Files whose stamps are compared, and the session that a change ends.
//
// SPDX-License-Identifier: MIT
#include "watch/sentry.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "base/clock.h"

// A look at each file costs a microsecond. Editors that put a new file in the old one's place leave a moment without
// either; one that stays away was deleted.
enum { LOOK_MILLISECONDS = 50, AGAIN_MILLISECONDS = 8, SETTLING_LOOKS = 60, MISSING_LOOKS = 25 };

int64_t sentry_wall_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * 1000000000 + now.tv_nsec;
}

static SentryStamp stamp_of(const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        return (SentryStamp){.exists = false};
    }
    int64_t modified = (int64_t)status.st_mtim.tv_sec * 1000000000 + status.st_mtim.tv_nsec;
    return (SentryStamp){true, status.st_ino, status.st_size, modified};
}

static bool stamps_are_equal(const SentryStamp *a, const SentryStamp *b)
{
    return a->exists == b->exists && a->number == b->number && a->size == b->size && a->modified == b->modified;
}

// ---- the thread

typedef struct Look {
    bool is_changed, is_missing; // a file that was there has gone
} Look;

// Compares all files with what they were at the last look.
static Look look(Sentry *sentry)
{
    Look found = {false, false};
    for (size_t i = 0; i < sentry->file_count; i++) {
        SentryFile *file = &sentry->files[i];
        SentryStamp stamp = stamp_of(file->path);
        found.is_missing = found.is_missing || (file->stamp.exists && !stamp.exists);
        if (stamp.exists || !file->stamp.exists) {
            found.is_changed = found.is_changed || !stamps_are_equal(&file->stamp, &stamp);
            file->stamp = stamp;
        }
    }
    return found;
}

// A file that stays away is taken for gone.
static void accept_missing(Sentry *sentry)
{
    for (size_t i = 0; i < sentry->file_count; i++) {
        sentry->files[i].stamp = stamp_of(sentry->files[i].path);
    }
}

static void sleep_milliseconds(long milliseconds)
{
    nanosleep(&(struct timespec){0, milliseconds * 1000000}, NULL);
}

// Waits, without the lock in between, until a save is whole.
static void settle(Sentry *sentry, Look found)
{
    for (int i = 0, missing = 0; i < SETTLING_LOOKS && (found.is_changed || found.is_missing); i++) {
        missing = found.is_missing ? missing + 1 : 0;
        if (missing == MISSING_LOOKS) {
            accept_missing(sentry);
            return;
        }
        pthread_mutex_unlock(&sentry->lock);
        sleep_milliseconds(AGAIN_MILLISECONDS);
        pthread_mutex_lock(&sentry->lock);
        found = look(sentry);
    }
}

static void *run_sentry(void *client)
{
    Sentry *sentry = client;
    pthread_mutex_lock(&sentry->lock);
    while (!sentry->is_over) {
        double now = clock_seconds();
        Look found = look(sentry);
        if (found.is_changed || found.is_missing) {
            settle(sentry, found);
            sentry->is_changed = true;
            sentry->changed_at = now;
        }
        sentry->is_over = sentry->is_over || *sentry->interrupted_by != 0;
        if ((sentry->is_changed || sentry->is_over) && sentry->session) {
            rt_cancel(sentry->session);
        }
        if (sentry->is_changed || sentry->is_over) {
            pthread_cond_broadcast(&sentry->woken);
        }
        pthread_mutex_unlock(&sentry->lock);
        sleep_milliseconds(LOOK_MILLISECONDS);
        pthread_mutex_lock(&sentry->lock);
    }
    pthread_mutex_unlock(&sentry->lock);
    return NULL;
}

bool sentry_start(Sentry *sentry, const char *path, const volatile sig_atomic_t *interrupted_by)
{
    *sentry = (Sentry){.interrupted_by = interrupted_by, .changed_at = clock_seconds()};
    pthread_mutex_init(&sentry->lock, NULL);
    pthread_cond_init(&sentry->woken, NULL);
    sentry->has_thread =
        sentry_set_files(sentry, &path, 1, INT64_MAX) && pthread_create(&sentry->thread, NULL, run_sentry, sentry) == 0;
    return sentry->has_thread;
}

static void free_files(SentryFile *files, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free(files[i].path);
    }
    free(files);
}

void sentry_stop(Sentry *sentry)
{
    pthread_mutex_lock(&sentry->lock);
    sentry->is_over = true;
    pthread_mutex_unlock(&sentry->lock);
    if (sentry->has_thread) {
        pthread_join(sentry->thread, NULL);
    }
    free_files(sentry->files, sentry->file_count);
    pthread_mutex_destroy(&sentry->lock);
    pthread_cond_destroy(&sentry->woken);
}

// ---- for the one that draws

double sentry_begin(Sentry *sentry, rt_session *session)
{
    pthread_mutex_lock(&sentry->lock);
    sentry->is_changed = false;
    sentry->session = session;
    if (session && sentry->is_over) {
        rt_cancel(session);
    }
    double at = sentry->changed_at;
    pthread_mutex_unlock(&sentry->lock);
    return at;
}

void sentry_end(Sentry *sentry)
{
    pthread_mutex_lock(&sentry->lock);
    sentry->session = NULL;
    pthread_mutex_unlock(&sentry->lock);
}

static int compare(const void *path, const void *file)
{
    return strcmp(path, ((const SentryFile *)file)->path);
}

static const SentryFile *find_file(const Sentry *sentry, const char *path)
{
    return sentry->file_count == 0 ? NULL
                                   : bsearch(path, sentry->files, sentry->file_count, sizeof *sentry->files, compare);
}

bool sentry_set_files(Sentry *sentry, const char *const *paths, size_t count, int64_t begun)
{
    SentryFile *files = calloc(count + 1, sizeof *files);
    bool fine = files != NULL;
    pthread_mutex_lock(&sentry->lock);
    for (size_t i = 0; fine && i < count; i++) {
        const SentryFile *known = find_file(sentry, paths[i]);
        files[i] = (SentryFile){strdup(paths[i]), known ? known->stamp : stamp_of(paths[i])};
        if (!known && files[i].stamp.modified > begun) {
            files[i].stamp.modified = begun; // so that the next look finds a change
        }
        fine = files[i].path != NULL;
    }
    if (fine) {
        free_files(sentry->files, sentry->file_count);
        sentry->files = files;
        sentry->file_count = count;
    }
    pthread_mutex_unlock(&sentry->lock);
    if (!fine && files) {
        free_files(files, count);
    }
    return fine;
}

bool sentry_has_file(Sentry *sentry, const char *path)
{
    pthread_mutex_lock(&sentry->lock);
    bool is_there = find_file(sentry, path) != NULL;
    pthread_mutex_unlock(&sentry->lock);
    return is_there;
}

bool sentry_wait(Sentry *sentry)
{
    pthread_mutex_lock(&sentry->lock);
    while (!sentry->is_changed && !sentry->is_over) {
        pthread_cond_wait(&sentry->woken, &sentry->lock);
    }
    bool is_over = sentry->is_over;
    pthread_mutex_unlock(&sentry->lock);
    return !is_over;
}
