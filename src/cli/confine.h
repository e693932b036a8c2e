// Confinement: what the kernel forbids the program once it knows what a run is to read and to write.
//
// Landlock (Linux 5.13) leaves it the folders of the scene, of its include files and of the output; seccomp leaves it
// no other programs, processes, sockets, or ways into the kernel that a ray tracer has no use for. Both are asked for
// before the first thread, and what a kernel does not have is left out. A picture does not depend on it.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_CONFINE_H
#define CLI_CONFINE_H

#include <stdbool.h>
#include <stddef.h>

typedef struct Confinement {
    const char *const *reads; // folders, and files, that may be read with all below them
    size_t read_count;
    const char *const *writes; // files that may be made or replaced; streams ("-", "-.ppm") and NULL are none
    size_t write_count;
    const char *const *folders; // in which files may be made, replaced and read, with all below them
    size_t folder_count;
    bool serves;    // an open socket's connections are taken and answered
    bool is_strict; // for strangers' scenes: no libraries are loaded any more, either
} Confinement;

// Asks the kernel for it; it holds to the program's end.
void confine(const Confinement *confinement);

// What of it can be had here: "Landlock 7, seccomp", or why there is none.
enum { CONFINE_TEXT = 80 };
void confine_describe(char text[CONFINE_TEXT]);

#endif
