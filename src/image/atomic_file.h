// A file that appears whole or not at all: written unseen in its folder, then renamed over the destination.
//
// Where the kernel can, the file has no name until it is complete, so that even a killed run leaves nothing behind.
// Symbolic links are followed. What is not a regular file (a device, a pipe) is written in place.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_ATOMIC_FILE_H
#define IMAGE_ATOMIC_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/attributes.h"
#include "image/image.h"

typedef struct AtomicFile {
    int fd;           // open for writing
    const char *name; // as it was given, for messages; the caller's
    char *path;       // the destination, NULL for standard output; owned
    char *temporary;  // the name it has meanwhile, "" if none yet; NULL: written in place; owned
} AtomicFile;

// `path` `-` is standard output. All functions fill `error` on failure; a failed open needs no abandon.
bool atomic_file_open(AtomicFile *file, const char *path, ImageError *error) RT_MUST_CHECK;

// Appends all bytes.
bool atomic_file_write(const AtomicFile *file, const void *data, size_t length, ImageError *error) RT_MUST_CHECK;

// Closes the file and puts it in place. On failure the destination is as it was, and everything is released.
bool atomic_file_commit(AtomicFile *file, ImageError *error) RT_MUST_CHECK;

// Closes and removes what was written; the destination is as it was, unless it is no regular file.
void atomic_file_abandon(AtomicFile *file);

// Whether atomic_file_open and atomic_file_commit can be expected to work.
bool atomic_file_check(const char *path, ImageError *error) RT_MUST_CHECK;

#endif
