// From the places of an installation to the table of functions of the first module there that fits.
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
#include <unistd.h>

#include "base/install.h"
#include "base/text.h"
#include "image/image_error.h"

typedef struct ModuleKind {
    const char *file, *symbol;
    unsigned version; // the first member of what the symbol names
} ModuleKind;

static const void *module_load_from(const char *folder, const ModuleKind *kind, ImageError *error)
{
    char path[PATH_MAX];
    const unsigned *version;
    void *handle;

    if (snprintf(path, sizeof path, "%s/%s", folder, kind->file) >= (int)sizeof path || access(path, R_OK) != 0) {
        return NULL;
    }
    // Not unloaded: OpenImageIO keeps threads, and a handle is counted, not copied.
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle == NULL) {
        image_error_set(error, "%s", dlerror());
        return NULL;
    }
    version = dlsym(handle, kind->symbol);
    if (version == NULL || *version != kind->version) {
        image_error_set(error, "%s: of another version of rtlang", path);
        version = NULL;
    }
    dlclose(handle);
    return version;
}

static const void *module_load(const ModuleKind *kind, ImageError *error)
{
    const void *module = NULL;
    char folder[PATH_MAX];
    TextBuffer places;

    text_init(&places);
    image_error_clear(error);
    for (unsigned i = 0; i < INSTALL_PLACES && module == NULL; i++) {
        if (install_place(INSTALL_MODULES, i, folder)) {
            module = module_load_from(folder, kind, error);
            text_printf(&places, "%s%s", places.length > 0 ? ", " : "", folder);
        }
    }
    if (module != NULL) {
        image_error_clear(error);
    } else if (error->detail[0] == '\0') {
        image_error_set(error, "no %s in %s", kind->file, text_get(&places));
    }
    text_fini(&places);
    return module;
}

const JpegModule *module_load_jpeg(ImageError *error)
{
    return module_load(&(ModuleKind){JPEG_MODULE_FILE, JPEG_MODULE_SYMBOL, JPEG_MODULE_VERSION}, error);
}

const OiioModule *module_load_oiio(ImageError *error)
{
#ifdef WITH_OPENIMAGEIO
    return module_load(&(ModuleKind){OIIO_MODULE_FILE, OIIO_MODULE_SYMBOL, OIIO_MODULE_VERSION}, error);
#else
    image_error_set(error, "this rtlang was built without it");
    return NULL;
#endif
}
