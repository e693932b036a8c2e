// From the places of an installation to the table of functions of the first module there that fits.
//
// The loader itself remembers what is loaded, so that nothing has to be kept here.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/module.h"

#include "image/image_error.h"

#ifdef WITH_OPENIMAGEIO

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <unistd.h>

#include "base/install.h"
#include "base/text.h"

static const OiioModule *module_load_from(const char *folder, ImageError *error)
{
    char path[PATH_MAX + sizeof "/" OIIO_MODULE_FILE];
    const OiioModule *module;
    void *handle;

    snprintf(path, sizeof path, "%s/%s", folder, OIIO_MODULE_FILE);
    if (access(path, R_OK) != 0) {
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
    const OiioModule *module = NULL;
    char folder[PATH_MAX];
    TextBuffer places;

    text_init(&places);
    image_error_clear(error);
    for (unsigned i = 0; i < INSTALL_PLACES && module == NULL; i++) {
        if (install_place(INSTALL_MODULES, i, folder)) {
            module = module_load_from(folder, error);
            text_printf(&places, "%s%s", places.length > 0 ? ", " : "", folder);
        }
    }
    if (module != NULL) {
        image_error_clear(error);
    } else if (error->detail[0] == '\0') {
        image_error_set(error, "no %s in %s", OIIO_MODULE_FILE, text_get(&places));
    }
    text_fini(&places);
    return module;
}

#else

const OiioModule *module_load(ImageError *error)
{
    image_error_set(error, "this rtlang was built without it");
    return NULL;
}

#endif
