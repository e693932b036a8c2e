// From a path to the reader that knows the file's format: PNG by its first bytes, everything else by the module.
//
// It owns the samples until they are handed over; it must not know what any format looks like.
//
// SPDX-License-Identifier: MIT
#include "image/picture_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/encode.h"
#include "image/image_error.h"
#include "image/module.h"
#include "image/png_read.h"

ImageStatus picture_file_allocate(PictureFile *file, const PictureLimit *limit)
{
    uint64_t pixels = (uint64_t)file->width * (uint64_t)file->height; // below 2^62
    uint64_t pixel_bytes = (uint64_t)file->channels * encode_sample_bytes(file->depth);

    if (pixels > limit->pixels || pixels > limit->bytes / pixel_bytes) {
        return IMAGE_TOO_LARGE;
    }
    file->samples = malloc((size_t)(pixels * pixel_bytes));
    return file->samples != NULL ? IMAGE_OK : IMAGE_NO_MEMORY;
}

void picture_file_fini(PictureFile *file)
{
    free(file->samples);
    file->samples = NULL;
}

// Only regular files are read: a pipe would block, and the readers seek. NULL: the error says why.
static FILE *open_readable(const char *path, ImageError *error)
{
    struct stat status;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    FILE *stream = NULL;

    if (fd < 0 || fstat(fd, &status) != 0) {
        image_error_system(error, path, errno);
    } else if (!S_ISREG(status.st_mode)) {
        image_error_set(error, "%s: not a regular file", path);
    } else {
        stream = fdopen(fd, "rb");
        if (stream == NULL) {
            image_error_system(error, path, errno);
        }
    }
    if (stream == NULL && fd >= 0) {
        close(fd);
    }
    return stream;
}

// How files of a format begin, and what OpenImageIO calls it.
static const struct {
    const char *format, *module_name;
    const char *beginnings[2]; // none: it cannot be told
    size_t length;
} formats[] = {
    {"png", "png", {"\x89PNG"}, 4},
    {"jpeg", "jpeg", {"\xff\xd8\xff"}, 3},
    {"tga", "targa", {NULL}, 0},
    {"ppm", "pnm", {"P6", "P3"}, 2},
    {"pgm", "pnm", {"P5", "P2"}, 2},
    {"tiff", "tiff", {"II*\0", "MM\0*"}, 4},
    {"exr", "openexr", {"\x76\x2f\x31\x01"}, 4},
    {"hdr", "hdr", {"#?"}, 2},
};

// The place of a format in the table; NULL has none.
static size_t format_place(const char *format)
{
    size_t place = 0;

    while (place < RT_COUNT_OF(formats) && (format == NULL || strcmp(formats[place].format, format) != 0)) {
        place++;
    }
    return place;
}

// The stream stands at its beginning before and after.
static bool begins_as(FILE *stream, size_t place)
{
    char bytes[4] = {0};
    size_t length = formats[place].length;
    bool is_whole = fread(bytes, 1, length, stream) == length;
    bool fits = formats[place].beginnings[0] == NULL;

    rewind(stream);
    for (int i = 0; i < 2 && formats[place].beginnings[i] != NULL; i++) {
        fits = fits || (is_whole && memcmp(bytes, formats[place].beginnings[i], length) == 0);
    }
    return fits;
}

static ImageStatus read_by_module(const char *path, const char *name, const PictureLimit *limit, PictureFile *file,
                                  ImageError *error)
{
    const OiioModule *module = module_load(error);

    return module == NULL ? IMAGE_NO_MODULE : module->read(path, name, limit, picture_file_allocate, file, error);
}

ImageStatus picture_file_read(const char *path, const char *format, const PictureLimit *limit, PictureFile *file,
                              ImageError *error)
{
    size_t place = format_place(format);
    bool may_be_any = place == RT_COUNT_OF(formats);
    FILE *stream;
    ImageStatus status;

    *file = (PictureFile){0};
    image_error_clear(error);
    stream = open_readable(path, error);
    if (stream == NULL) {
        return IMAGE_IO;
    }
    bool is_png = png_is_there(stream);
    bool fits = may_be_any || (begins_as(stream, place) && is_png == (strcmp(format, "png") == 0));
    status = !fits || !is_png ? IMAGE_NOT_A_PICTURE : png_read(stream, limit, file, error);
    fclose(stream);
    if (!fits) {
        image_error_set(error, "it does not begin as files of type %s do", format);
    } else if (!is_png) {
        status = read_by_module(path, may_be_any ? NULL : formats[place].module_name, limit, file, error);
    }
    if (status != IMAGE_OK) {
        picture_file_fini(file);
    }
    return status;
}
