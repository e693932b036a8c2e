// From a list of folders to the table of functions of the first module there that fits.
//
// The loader itself remembers what is loaded, so that nothing has to be kept here.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "image/image_error.h"

#ifndef PKGLIBDIR
#error "the build names the folder of modules: -DPKGLIBDIR=\"...\""
#endif

// The folder of the running program; false where it cannot be known.
static bool program_folder(char folder[static PATH_MAX])
{
    ssize_t length = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    char *slash;

    if (length <= 0) {
        return false;
    }
    folder[length] = '\0';
    slash = strrchr(folder, '/');
    if (slash == NULL) {
        return false;
    }
    *slash = '\0';
    return true;
}

static const OiioModule *module_load_from(const char *folder, const char *below, ImageError *error)
{
    char path[PATH_MAX + sizeof "/.libs/" OIIO_MODULE_FILE];
    int length = snprintf(path, sizeof path, "%s%s/%s", folder, below, OIIO_MODULE_FILE);
    const OiioModule *module;
    void *handle;

    if (length < 0 || (size_t)length >= sizeof path || access(path, R_OK) != 0) {
        return NULL;
    }
    // Not unloaded: OpenImageIO keeps threads, and a handle is counted, not copied.
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle == NULL) {
        image_error_set(error, "%s", dlerror());
        return NULL;
    }
    module = dlsym(handle, OIIO_MODULE_SYMBOL);
    if (module == NULL || module->version != OIIO_MODULE_VERSION) {
        image_error_set(error, "%s: of another version of rtlang", path);
        module = NULL;
    }
    dlclose(handle);
    return module;
}

const OiioModule *module_load(ImageError *error)
{
    const char *chosen = secure_getenv("RTLANG_MODULE_DIR");
    char program[PATH_MAX];
    const OiioModule *module = NULL;

    image_error_set(error, "no %s found", OIIO_MODULE_FILE);
    if (chosen != NULL && chosen[0] != '\0') {
        module = module_load_from(chosen, "", error);
    }
    if (module == NULL) {
        module = module_load_from(PKGLIBDIR, "", error);
    }
    if (module == NULL && program_folder(program)) {
        module = module_load_from(program, "", error);
        if (module == NULL) {
            module = module_load_from(program, "/.libs", error);
        }
    }
    if (module != NULL) {
        image_error_clear(error);
    }
    return module;
}
