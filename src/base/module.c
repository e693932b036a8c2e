// From the places of an installation to the table of functions of the first module there that fits.
//
// The loader itself remembers what is loaded, so that nothing has to be kept here.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "base/module.h"

#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/install.h"
#include "base/text.h"

static void *do_nothing(void *argument)
{
    return argument;
}

// Whether there is room for libraries and a thread of theirs. Some start one as they are loaded, and abort the program
// where they cannot: log4cplus does, which OpenImageIO 2.4 loads (450 MB of address space; 400 MB: SIGABRT).
static bool has_room(size_t bytes)
{
    pthread_t thread;
    void *room = mmap(NULL, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (room == MAP_FAILED) {
        return false;
    }
    munmap(room, bytes);
    return pthread_create(&thread, NULL, do_nothing, NULL) == 0 && pthread_join(thread, NULL) == 0;
}

static bool is_loaded(const char *path)
{
    void *handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NOLOAD);
    return handle && dlclose(handle) == 0;
}

// Whether it was memory that the loader wanted, in its own words or the system's.
static bool is_memory(int reason, const char *text)
{
    return reason == ENOMEM || !text || strstr(text, strerror(ENOMEM)) || strstr(text, "cannot allocate") ||
           strstr(text, "out of memory");
}

static ModuleResult load_from(const char *folder, const ModuleKind *kind, const void **module, char *why, size_t size)
{
    char path[PATH_MAX];
    const unsigned *version;
    void *handle;

    if (snprintf(path, sizeof path, "%s/%s", folder, kind->file) >= (int)sizeof path || access(path, R_OK) != 0) {
        return MODULE_NONE;
    }
    if (!is_loaded(path) && !has_room(kind->room)) {
        return MODULE_NO_MEMORY;
    }
    // Not unloaded: OpenImageIO keeps threads, and a handle is counted, not copied.
    errno = 0;
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) {
        int reason = errno;
        const char *text = dlerror();
        snprintf(why, size, "%s", text ? text : "");
        return is_memory(reason, text) ? MODULE_NO_MEMORY : MODULE_NONE;
    }
    version = dlsym(handle, kind->symbol);
    if (!version || *version != kind->version) {
        snprintf(why, size, "%s: of another version of rtlang", path);
        version = NULL;
    }
    dlclose(handle);
    *module = version;
    return version ? MODULE_OK : MODULE_NONE;
}

ModuleResult module_load(const ModuleKind *kind, const void **module, char *why, size_t size)
{
    ModuleResult result = MODULE_NONE;
    char folder[PATH_MAX];
    TextBuffer places;

    text_init(&places);
    *module = NULL;
    why[0] = '\0';
    for (unsigned i = 0; i < INSTALL_PLACES && result == MODULE_NONE; i++) {
        if (install_place(INSTALL_MODULES, i, folder)) {
            result = load_from(folder, kind, module, why, size);
            text_printf(&places, "%s%s", places.length > 0 ? ", " : "", folder);
        }
    }
    if (result != MODULE_NONE) {
        why[0] = '\0';
    } else if (why[0] == '\0') {
        snprintf(why, size, "no %s in %s", kind->file, text_get(&places));
    }
    text_fini(&places);
    return result;
}
