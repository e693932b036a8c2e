// Any bytes are a format and a file of it, which OpenImageIO reads, or refuses. Without its module nothing happens.
//
// The library itself is as it was installed: a fuzzer sees what its results do to rtlang, and where it crashes.
//
// SPDX-License-Identifier: MIT
#include <string.h>

#include "fuzz/fuzz.h"
#include "fuzz/fuzz_samples.h"
#include "image/module.h"
#include "image/picture_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    enum { PIXELS = 1 << 15 };
    static const char *const formats[] = {"tga", "ppm", "pgm", "tiff", "exr", "hdr"};
    char path[FUZZ_PATH];
    const OiioModule *module;
    PictureFile file = {0};
    ImageError error = {{0}, false};
    PictureLimit limit = {PIXELS, PIXELS * 8, NULL};
    int fd = size > 0 && module_load_oiio(&module, &error) == IMAGE_OK ? fuzz_file(data + 1, size - 1, path) : -1;
    if (fd < 0) {
        return 0;
    }
    const char *format = formats[data[0] % (sizeof formats / sizeof *formats)];
    if (picture_file_read(path, format, &limit, &file, &error) == IMAGE_OK) {
        fuzz_look_at(&file);
        picture_file_fini(&file);
    } else {
        FUZZ_HOLDS(file.samples == NULL);
    }
    close(fd);
    return 0;
}
