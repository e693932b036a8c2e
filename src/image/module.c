// Which modules there are, and what image_error says where one is not.
//
// SPDX-License-Identifier: MIT
#include "image/module.h"

#include "base/module.h"
#include "image/image_error.h"

static ImageStatus load(const ModuleKind *kind, const void **module, ImageError *error)
{
    static const ImageStatus statuses[] = {
        [MODULE_OK] = IMAGE_OK, [MODULE_NONE] = IMAGE_NO_MODULE, [MODULE_NO_MEMORY] = IMAGE_NO_MEMORY};
    char why[sizeof error->detail];

    image_error_clear(error);
    ModuleResult result = module_load(kind, module, why, sizeof why);
    if (result == MODULE_NONE) {
        image_error_set(error, "%s", why);
    }
    return statuses[result];
}

ImageStatus module_load_jpeg(const JpegModule **module, ImageError *error)
{
    enum { ROOM = 16 << 20 };
    const void *found;
    ImageStatus status =
        load(&(ModuleKind){JPEG_MODULE_FILE, JPEG_MODULE_SYMBOL, JPEG_MODULE_VERSION, ROOM}, &found, error);

    *module = found;
    return status;
}

ImageStatus module_load_oiio(const OiioModule **module, ImageError *error)
{
    *module = NULL;
#ifdef WITH_OPENIMAGEIO
    enum { ROOM = 512 << 20 };
    const void *found;
    ImageStatus status =
        load(&(ModuleKind){OIIO_MODULE_FILE, OIIO_MODULE_SYMBOL, OIIO_MODULE_VERSION, ROOM}, &found, error);

    *module = found;
    return status;
#else
    image_error_set(error, "this rtlang was built without it");
    return IMAGE_NO_MODULE;
#endif
}
