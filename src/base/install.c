// From the file that holds this code to the folders of what was installed with it.
//
// The code may be part of a program or of librtlang in a process of somebody else, so the file is found by an address
// of this code. A moved installation keeps its inner distances: the way from the configured folder of programs (or of
// libraries) to that of the data is walked from where the file is now. Owns nothing; knows nothing of the files.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/install.h"

#include <dlfcn.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#if !defined(BINDIR) || !defined(LIBDIR) || !defined(PKGDATADIR) || !defined(PKGLIBDIR)
#error "the build names the folders of an installation: -DBINDIR=\"...\" and so on"
#endif

// How deep below the top of a build tree programs stand: tests/unit.
enum { BUILD_DEPTH = 2 };

static const struct {
    const char *installed; // where it is installed
    const char *built;     // below the top of a build tree
} kinds[] = {
    [INSTALL_DATA] = {PKGDATADIR, "share/rtlang"},
    [INSTALL_MODULES] = {PKGLIBDIR, ".libs"},
};

// ---- the file

// By what the kernel mapped: right also when the process has changed its folder or its name since.
static bool file_by_maps(uintptr_t address, char path[static PATH_MAX])
{
    FILE *maps = fopen("/proc/self/maps", "re");
    char line[PATH_MAX + 128];
    const char *name = NULL;
    bool is_found = false;
    while (maps && !is_found && fgets(line, sizeof line, maps)) {
        uintptr_t low, high;
        line[strcspn(line, "\n")] = '\0';
        name = strchr(line, '/');
        is_found = sscanf(line, "%" SCNxPTR "-%" SCNxPTR, &low, &high) == 2 && low <= address && address < high;
    }
    if (maps) {
        (void)fclose(maps);
    }
    return is_found && name && realpath(name, path);
}

static bool file_of_code(char path[static PATH_MAX])
{
    const void *address = (const void *)(uintptr_t)file_of_code;
    Dl_info info;
    return file_by_maps((uintptr_t)address, path) ||
           (dladdr(address, &info) != 0 && info.dli_fname && realpath(info.dli_fname, path));
}

// Cuts the last name off a path, which then is that of its folder. False at the root.
static bool cut_name(char *path)
{
    char *slash = strrchr(path, '/');
    bool has_more = slash && slash[1] != '\0';
    if (has_more) {
        slash[slash == path] = '\0';
    }
    return has_more;
}

// ---- the folders

static bool append(char folder[static PATH_MAX], const char *below)
{
    size_t length = strlen(folder);
    length -= length > 0 && folder[length - 1] == '/';
    int added = snprintf(folder + length, PATH_MAX - length, "/%s", below);
    return added > 0 && (size_t)added < PATH_MAX - length;
}

// Goes from `folder` as one goes from the folder `from` to `to`, both absolute.
static bool walk(char folder[static PATH_MAX], const char *from, const char *to)
{
    size_t common = 0, slash = 0;
    for (; from[common] == to[common] && from[common] != '\0'; common++) {
        slash = from[common] == '/' ? common : slash;
    }
    bool is_whole = (from[common] == '\0' || from[common] == '/') && (to[common] == '\0' || to[common] == '/');
    common = is_whole ? common : slash;
    bool fine = true;
    for (const char *up = from + common; fine && (up = strchr(up, '/')); up++) {
        fine = cut_name(folder);
    }
    to += common;
    return fine && (to[0] == '\0' || append(folder, to + 1));
}

// The top of the build tree that a folder is part of.
static bool find_build_tree(const char *folder, char top[static PATH_MAX])
{
    char status[PATH_MAX];
    strcpy(top, folder);
    for (int i = 0; i <= BUILD_DEPTH; i++) {
        strcpy(status, top);
        if (append(status, "config.status") && access(status, F_OK) == 0) {
            return true;
        }
        if (!cut_name(top)) {
            break;
        }
    }
    return false;
}

static bool place_beside_code(InstallKind kind, char folder[static PATH_MAX])
{
    char file[PATH_MAX];
    if (!file_of_code(file)) {
        return false;
    }
    bool is_library = strncmp(strrchr(file, '/') + 1, "librtlang.", strlen("librtlang.")) == 0;
    if (!cut_name(file)) {
        return false;
    }
    if (find_build_tree(file, folder)) {
        return append(folder, kinds[kind].built);
    }
    strcpy(folder, file);
    return walk(folder, is_library ? LIBDIR : BINDIR, kinds[kind].installed);
}

bool install_place(InstallKind kind, unsigned i, char folder[static PATH_MAX])
{
    if (i == 0) {
        return place_beside_code(kind, folder);
    }
    char first[PATH_MAX];
    bool is_there = i < INSTALL_PLACES && strlen(kinds[kind].installed) < PATH_MAX;
    if (is_there) {
        strcpy(folder, kinds[kind].installed);
    }
    return is_there && !(place_beside_code(kind, first) && strcmp(first, folder) == 0);
}
