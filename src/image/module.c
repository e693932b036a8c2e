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
#include <pthread.h>
#include <stdio.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/install.h"
#include "base/text.h"
#include "image/image_error.h"

typedef struct ModuleKind {
    const char *file, *symbol;
    unsigned version; // the first member of what the symbol names
    size_t room;      // address space that its libraries want
} ModuleKind;

enum { ROOM_JPEG = 16 << 20, ROOM_OIIO = 512 << 20 };

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

static ImageStatus module_load_from(const char *folder, const ModuleKind *kind, const void **module, ImageError *error)
{
    char path[PATH_MAX];
    const unsigned *version;
    void *handle;

    if (snprintf(path, sizeof path, "%s/%s", folder, kind->file) >= (int)sizeof path || access(path, R_OK) != 0) {
        return IMAGE_NO_MODULE;
    }
    if (!is_loaded(path) && !has_room(kind->room)) {
        return IMAGE_NO_MEMORY;
    }
    // Not unloaded: OpenImageIO keeps threads, and a handle is counted, not copied.
    handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!handle) {
        image_error_set(error, "%s", dlerror());
        return IMAGE_NO_MODULE;
    }
    version = dlsym(handle, kind->symbol);
    if (!version || *version != kind->version) {
        image_error_set(error, "%s: of another version of rtlang", path);
        version = NULL;
    }
    dlclose(handle);
    *module = version;
    return version ? IMAGE_OK : IMAGE_NO_MODULE;
}

static ImageStatus module_load(const ModuleKind *kind, const void **module, ImageError *error)
{
    ImageStatus status = IMAGE_NO_MODULE;
    char folder[PATH_MAX];
    TextBuffer places;

    text_init(&places);
    image_error_clear(error);
    for (unsigned i = 0; i < INSTALL_PLACES && status == IMAGE_NO_MODULE; i++) {
        if (install_place(INSTALL_MODULES, i, folder)) {
            status = module_load_from(folder, kind, module, error);
            text_printf(&places, "%s%s", places.length > 0 ? ", " : "", folder);
        }
    }
    if (status != IMAGE_NO_MODULE) {
        image_error_clear(error);
    } else if (error->detail[0] == '\0') {
        image_error_set(error, "no %s in %s", kind->file, text_get(&places));
    }
    text_fini(&places);
    return status;
}

ImageStatus module_load_jpeg(const JpegModule **module, ImageError *error)
{
    const void *found = NULL;
    ImageStatus status = module_load(&(ModuleKind){JPEG_MODULE_FILE, JPEG_MODULE_SYMBOL, JPEG_MODULE_VERSION, ROOM_JPEG},
                                     &found, error);

    *module = found;
    return status;
}

ImageStatus module_load_oiio(const OiioModule **module, ImageError *error)
{
    *module = NULL;
#ifdef WITH_OPENIMAGEIO
    const void *found = NULL;
    ImageStatus status = module_load(&(ModuleKind){OIIO_MODULE_FILE, OIIO_MODULE_SYMBOL, OIIO_MODULE_VERSION, ROOM_OIIO},
                                     &found, error);

    *module = found;
    return status;
#else
    image_error_set(error, "this rtlang was built without it");
    return IMAGE_NO_MODULE;
#endif
}
