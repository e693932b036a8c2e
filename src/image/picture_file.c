// From a path to the reader that knows the file's format, by its first bytes: PNG, JPEG, df3, or
// the module for everything else.
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

#include "base/real_path.h"
#include "image/df3_read.h"
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
    return file->samples ? IMAGE_OK : IMAGE_NO_MEMORY;
}

void picture_file_fini(PictureFile *file)
{
    free(file->samples);
    file->samples = NULL;
}

// The stream of a descriptor, which it takes; NULL: the error says why. Only regular files are read: a pipe would
// block, and the readers seek.
static FILE *open_readable(const char *path, int fd, ImageError *error)
{
    struct stat status;
    FILE *stream = NULL;

    if (fd < 0 || fstat(fd, &status) != 0) {
        image_error_system(error, path, errno);
    } else if (!S_ISREG(status.st_mode)) {
        image_error_set(error, "%s: not a regular file", path);
    } else {
        stream = fdopen(fd, "rb");
        if (!stream) {
            image_error_system(error, path, errno);
        }
    }
    if (!stream && fd >= 0) {
        close(fd);
    }
    return stream;
}

static ImageStatus read_jpeg(FILE *stream, const PictureLimit *limit, PictureFile *file, ImageError *error)
{
    const JpegModule *module;
    ImageStatus status = module_load_jpeg(&module, error);

    return status != IMAGE_OK ? status : module->read(stream, limit, picture_file_allocate, file, error);
}

typedef ImageStatus (*StreamRead)(FILE *, const PictureLimit *, PictureFile *, ImageError *);

// How files of a format begin, and who reads it: a function of ours, or OpenImageIO under its name for it.
static const struct {
    const char *format;
    const char *beginnings[2]; // none: its kind cannot be recognised
    size_t length;
    StreamRead read;
    const char *module_name;
} formats[] = {
    {"png", {"\x89PNG\r\n\x1a\n"}, 8, png_read, NULL},
    {"jpeg", {"\xff\xd8\xff"}, 3, read_jpeg, NULL},
    {"tga", {NULL}, 0, NULL, "targa"},
    {"ppm", {"P6", "P3"}, 2, NULL, "pnm"},
    {"pgm", {"P5", "P2"}, 2, NULL, "pnm"},
    {"tiff", {"II*\0", "MM\0*"}, 4, NULL, "tiff"},
    {"exr", {"\x76\x2f\x31\x01"}, 4, NULL, "openexr"},
    {"hdr", {"#?"}, 2, NULL, "hdr"},
    {"df3", {NULL}, 0, df3_read, NULL},
};

enum { BEGINNING_MOST = 8 };

// The place of a format in the table.
static size_t format_place(const char *format)
{
    size_t place = 0;

    while (place < RT_COUNT_OF(formats) && strcmp(formats[place].format, format) != 0) {
        place++;
    }
    return place;
}

bool picture_file_is_own(const char *format)
{
    size_t place = format_place(format);

    return place < RT_COUNT_OF(formats) && formats[place].read && formats[place].read != read_jpeg;
}

// Whether the stream begins as files of that format do; false for a format that does not tell. The stream stands at its
// beginning before and after.
static bool begins_as(FILE *stream, size_t place)
{
    char bytes[BEGINNING_MOST];
    size_t length = formats[place].length;
    bool is_whole = fread(bytes, 1, length, stream) == length, fits = false;

    rewind(stream);
    for (int i = 0; i < 2 && formats[place].beginnings[i]; i++) {
        fits = fits || (is_whole && memcmp(bytes, formats[place].beginnings[i], length) == 0);
    }
    return fits;
}

// The format that the stream begins as, of those that tell.
static size_t place_found(FILE *stream)
{
    size_t place = 0;

    while (place < RT_COUNT_OF(formats) && !begins_as(stream, place)) {
        place++;
    }
    return place;
}

// Puts the file's own name where a library's message has the one that it was given.
static void restore_name(ImageError *error, const char *given, const char *path)
{
    const char *at = strstr(error->detail, given);
    const char *slash = strrchr(path, '/');
    ImageError named = *error;

    if (at) {
        image_error_set(&named, "%.*s%s%s", (int)(at - error->detail), error->detail, slash ? slash + 1 : path,
                        at + strlen(given));
        *error = named;
    }
}

// The file that was judged is the one that is read: by its descriptor, unless its name is to tell the format.
static ImageStatus read_by_module(const char *path, int fd, const char *name, const PictureLimit *limit,
                                  PictureFile *file, ImageError *error)
{
    const OiioModule *module;
    ImageStatus status = module_load_oiio(&module, error);
    char opened[32];

    if (status != IMAGE_OK) {
        return status;
    }
    snprintf(opened, sizeof opened, "/proc/self/fd/%d", fd);
    status = module->read(name ? opened : path, name, limit, picture_file_allocate, file, error);
    restore_name(error, opened, path);
    return status;
}

// The place of what reads a stream of the format asked for, NULL for any, in the table, whose length stands for any
// format; IMAGE_NOT_A_PICTURE when the stream is of another one.
static ImageStatus place_asked(FILE *stream, const char *format, size_t *asked, ImageError *error)
{
    size_t found = place_found(stream);

    *asked = format ? format_place(format) : found;
    if (*asked != RT_COUNT_OF(formats) && *asked != found &&
        (formats[*asked].beginnings[0] || found != RT_COUNT_OF(formats))) {
        image_error_set(error, "it does not begin as files of type %s do", format);
        return IMAGE_NOT_A_PICTURE;
    }
    return IMAGE_OK;
}

static ImageStatus read_opened(const char *path, int fd, const char *format, const PictureLimit *limit,
                               PictureFile *file, ImageError *error)
{
    FILE *stream = open_readable(path, fd, error);
    size_t asked;

    if (!stream) {
        return IMAGE_IO;
    }
    ImageStatus status = place_asked(stream, format, &asked, error);
    bool is_any = asked == RT_COUNT_OF(formats);
    if (status == IMAGE_OK && !is_any && formats[asked].read) {
        status = formats[asked].read(stream, limit, file, error);
    } else if (status == IMAGE_OK) {
        const char *name = is_any ? NULL : formats[asked].module_name;
        status = read_by_module(path, fileno(stream), name, limit, file, error);
    }
    fclose(stream);
    if (status != IMAGE_OK) {
        picture_file_fini(file);
    }
    return status;
}

ImageStatus picture_file_begins(const char *real, const char *format, ImageError *error)
{
    image_error_clear(error);
    FILE *stream = open_readable(real, real_path_open(real, O_RDONLY), error);
    size_t asked;

    if (!stream) {
        return IMAGE_IO;
    }
    ImageStatus status = place_asked(stream, format, &asked, error);
    fclose(stream);
    return status;
}

ImageStatus picture_file_read(const char *path, const char *format, const PictureLimit *limit, PictureFile *file,
                              ImageError *error)
{
    *file = (PictureFile){0};
    image_error_clear(error);
    return read_opened(path, open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK), format, limit, file, error);
}

ImageStatus picture_file_read_real(const char *real, const char *format, const PictureLimit *limit, PictureFile *file,
                                   ImageError *error)
{
    *file = (PictureFile){0};
    image_error_clear(error);
    return read_opened(real, real_path_open(real, O_RDONLY), format, limit, file, error);
}
