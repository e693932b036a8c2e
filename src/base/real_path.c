// A real path to what is there now, without following links.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/real_path.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

int real_path_open(const char *real, int how)
{
    char part[NAME_MAX + 1];
    int folder = open("/", O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (real++; folder >= 0 && *real != '\0'; real++) {
        size_t length = strcspn(real, "/");
        bool is_last = real[length] == '\0';
        if (length >= sizeof part) {
            close(folder);
            errno = ENAMETOOLONG;
            return -1;
        }
        memcpy(part, real, length);
        part[length] = '\0';
        int flags = is_last ? how | O_NONBLOCK | O_NOCTTY : O_PATH | O_DIRECTORY;
        int next = openat(folder, part, flags | O_NOFOLLOW | O_CLOEXEC, 0666);
        int error_number = errno;
        close(folder);
        errno = error_number;
        folder = next;
        if (is_last) {
            break;
        }
        real += length;
    }
    return folder;
}
