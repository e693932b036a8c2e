// Unnamed files as in open(2), O_TMPFILE, with named ones where the file system has no such thing.
// It knows nothing of what is written.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "image/image_error.h"

enum { NAME_TRIES = 100, NAME_BYTES = 32 };

static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');

    return !slash ? 0 : (size_t)(slash - path) + 1;
}

static uint64_t random_number(void)
{
    uint64_t number;
    struct timespec now;

    if (getrandom(&number, sizeof number, GRND_NONBLOCK) == (ssize_t)sizeof number) {
        return number;
    }
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)getpid() * 0x9e3779b97f4a7c15u ^ (uint64_t)now.tv_nsec ^ (uint64_t)now.tv_sec << 32;
}

// A fresh name in the folder of `path`, to be freed; NULL: out of memory. Short, so that it fits where `path` fits.
static char *temporary_name(const char *path)
{
    size_t folder = folder_length(path);
    char *name = malloc(folder + NAME_BYTES);

    if (name) {
        memcpy(name, path, folder);
        snprintf(name + folder, NAME_BYTES, ".rtlang-%016" PRIx64, random_number());
    }
    return name;
}

// An unnamed file in the folder of `path`, or -1 where that cannot be had.
static int open_unnamed(const char *path)
{
    size_t length = folder_length(path);
    char *folder;
    int fd;

    if (access("/proc/self/fd", X_OK) != 0) { // it could not be given a name later
        return -1;
    }
    folder = length == 0 ? strdup(".") : strndup(path, length);
    if (!folder) {
        return -1;
    }
    fd = open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    free(folder);
    return fd;
}

// Opens a file of a fresh name; *name is its name, to be freed.
static int open_named(const char *path, char **name)
{
    for (int i = 0; i < NAME_TRIES; i++) {
        int fd, code;

        *name = temporary_name(path);
        if (!*name) {
            errno = ENOMEM;
            return -1;
        }
        fd = open(*name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0) {
            return fd;
        }
        code = errno;
        free(*name);
        *name = NULL;
        errno = code;
        if (code != EEXIST) {
            return -1;
        }
    }
    return -1;
}

// The new file has the permissions of the one that it replaces, from its first byte on. Where the file system has no
// permissions this fails, and then nothing was to be kept.
static void permissions_keep(const AtomicFile *file)
{
    struct stat status;
    bool is_kept = stat(file->path, &status) != 0 || fchmod(file->fd, status.st_mode & 0777) == 0;

    (void)is_kept;
}

static bool open_beside(AtomicFile *file)
{
    file->fd = open_unnamed(file->path);
    if (file->fd < 0) {
        file->fd = open_named(file->path, &file->temporary); // NOLINT(clang-analyzer-unix.Malloc): the path stays
    } else {
        file->temporary = strdup("");
        if (!file->temporary) {
            close(file->fd);
            errno = ENOMEM;
            return false;
        }
    }
    if (file->fd >= 0) {
        permissions_keep(file);
    }
    return file->fd >= 0;
}

// Fills file->path and says whether the destination is replaced or written in place. False: errno says why.
static bool destination_resolve(AtomicFile *file, const char *path, bool *in_place)
{
    struct stat status;
    bool exists = stat(path, &status) == 0;

    if (!exists && errno != ENOENT) {
        return false;
    }
    *in_place = exists && !S_ISREG(status.st_mode);
    if (exists && S_ISDIR(status.st_mode)) {
        errno = EISDIR;
        return false;
    }
    // A picture that its owner made read-only is not to be replaced, though renaming would do it.
    if (exists && faccessat(AT_FDCWD, path, W_OK, AT_EACCESS) != 0) {
        return false;
    }
    if (!exists && lstat(path, &status) == 0) { // a link to nothing: the file it names is made in place
        *in_place = true;
    }
    file->path = exists && !*in_place ? realpath(path, NULL) : strdup(path);
    return file->path != NULL;
}

bool atomic_file_open(AtomicFile *file, const char *path, ImageError *error)
{
    bool in_place = true, opened;
    int code;

    *file = (AtomicFile){.fd = -1, .name = path};
    if (strcmp(path, "-") == 0) {
        file->fd = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
        opened = file->fd >= 0;
    } else if (!destination_resolve(file, path, &in_place)) {
        opened = false;
    } else if (in_place) {
        file->fd = open(file->path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        opened = file->fd >= 0;
    } else {
        opened = open_beside(file);
    }
    if (!opened) {
        code = errno;
        free(file->path);
        image_error_system(error, path, code);
    }
    return opened;
}

static const char *file_label(const AtomicFile *file)
{
    return file->path ? file->name : "standard output";
}

bool atomic_file_write(const AtomicFile *file, const void *data, size_t length, ImageError *error)
{
    const char *next = data;

    while (length > 0) {
        ssize_t done = write(file->fd, next, length);

        if (done > 0) {
            next += done;
            length -= (size_t)done;
        } else if (done == 0 || errno != EINTR) {
            image_error_system(error, file_label(file), done == 0 ? EIO : errno);
            return false;
        }
    }
    return true;
}

static void file_release(AtomicFile *file)
{
    if (file->temporary && file->temporary[0] != '\0') {
        unlink(file->temporary);
    }
    free(file->temporary);
    free(file->path);
    *file = (AtomicFile){.fd = -1};
}

void atomic_file_abandon(AtomicFile *file)
{
    close(file->fd);
    file_release(file);
}

// Gives the unnamed file a name. False: errno says why.
static bool file_name(AtomicFile *file)
{
    char from[64];

    snprintf(from, sizeof from, "/proc/self/fd/%d", file->fd);
    for (int i = 0; i < NAME_TRIES; i++) {
        char *name = temporary_name(file->path);

        if (!name) {
            errno = ENOMEM;
            return false;
        }
        if (linkat(AT_FDCWD, from, AT_FDCWD, name, AT_SYMLINK_FOLLOW) == 0) {
            free(file->temporary);
            file->temporary = name;
            return true;
        }
        free(name);
        if (errno != EEXIST) {
            return false;
        }
    }
    return false;
}

bool atomic_file_commit(AtomicFile *file, ImageError *error)
{
    bool replaces = file->temporary != NULL;
    int code = 0;

    if (replaces && file->temporary[0] == '\0' && !file_name(file)) {
        code = errno;
    }
    // Some file systems report a full disk only here. Standard output is a copy of the descriptor: nothing is lost.
    if (close(file->fd) != 0 && code == 0 && errno != EINTR) {
        code = errno;
    }
    if (code == 0 && replaces && rename(file->temporary, file->path) != 0) {
        code = errno;
    }
    if (code != 0) {
        image_error_system(error, file_label(file), code);
    } else if (replaces) {
        file->temporary[0] = '\0'; // it is the destination now
    }
    file_release(file);
    return code == 0;
}

bool atomic_file_check(const char *path, ImageError *error)
{
    AtomicFile file = {.fd = -1};
    bool in_place = true;
    bool found = strcmp(path, "-") == 0 || destination_resolve(&file, path, &in_place);
    int code = errno;

    free(file.path);
    if (!found) {
        image_error_system(error, path, code);
        return false;
    }
    if (in_place) { // opening a pipe would block, and opening a link's target would make it
        return true;
    }
    if (!atomic_file_open(&file, path, error)) {
        return false;
    }
    atomic_file_abandon(&file);
    return true;
}
