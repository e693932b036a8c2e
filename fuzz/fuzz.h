// What fuzz targets share: the function that a fuzzer calls with any bytes, and files of such bytes.
//
// A target holds to be right what a scene's author would; where it does not, it aborts.
//
// SPDX-License-Identifier: MIT
#ifndef FUZZ_FUZZ_H
#define FUZZ_FUZZ_H

#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { FUZZ_PATH = 64 };

// A regular file in memory: its descriptor, the caller's to close, and a path to it. Below 0: there is none.
__attribute__((unused)) static int fuzz_file(const uint8_t *data, size_t size, char path[FUZZ_PATH])
{
    int fd = memfd_create("fuzz", MFD_CLOEXEC);
    while (fd >= 0 && size > 0) {
        ssize_t written = write(fd, data, size);
        if (written <= 0) {
            close(fd);
            return -1;
        }
        data += written;
        size -= (size_t)written;
    }
    snprintf(path, FUZZ_PATH, "/proc/self/fd/%d", fd);
    return fd;
}

// What must hold for any bytes.
#define FUZZ_HOLDS(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition); \
            abort(); \
        } \
    } while (0)

#endif
