// Tests of pictures as files: read back by other readers, written whole or not at all.
//
// The formats of the OpenImageIO module are tested where the module can be loaded.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/attributes.h"
#include "image/encode.h"
#include "image/image.h"
#include "unit/image_forms.h"
#include "unit/tap.h"

enum { WIDTH = 37, HEIGHT = 70 }; // more rows than the module fetches at once

static const ImageEncoding float_linear = {.depth = IMAGE_DEPTH_FLOAT, .transfer = IMAGE_TRANSFER_SRGB, .threads = 1};

enum { SMOOTH = 0 }; // in place of a seed

static bool picture_make(Image *image, int channels, uint32_t seed)
{
    if (!image_init(image, WIDTH, HEIGHT, channels)) {
        return false;
    }
    for (int i = 0; i < WIDTH * HEIGHT * channels; i++) {
        image->values[i] = seed != SMOOTH ? random_unit(&seed) : (float)i / (float)(WIDTH * HEIGHT * channels);
    }
    return true;
}

typedef struct PngRead {
    unsigned width, height;
    int bits, colour_type, gamma, srgb;
    unsigned char rows[HEIGHT][WIDTH * 4 * 2];
} PngRead;

static bool png_read_guarded(FILE *stream, PngRead *result, png_structp png, png_infop info)
{
    png_fixed_point gamma;

    if (setjmp(png_jmpbuf(png)) != 0) {
        return false;
    }
    png_init_io(png, stream);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    result->width = png_get_image_width(png, info);
    result->height = png_get_image_height(png, info);
    result->bits = png_get_bit_depth(png, info);
    result->colour_type = png_get_color_type(png, info);
    result->gamma = png_get_gAMA_fixed(png, info, &gamma) != 0 ? gamma : 0;
    result->srgb = png_get_valid(png, info, PNG_INFO_sRGB) != 0;
    for (unsigned y = 0; y < result->height && y < HEIGHT; y++) {
        memcpy(result->rows[y], png_get_rows(png, info)[y], png_get_rowbytes(png, info));
    }
    return true;
}

static bool png_read_back(const char *path, PngRead *result)
{
    FILE *stream = fopen(path, "rb");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    bool fine = stream != NULL && png_read_guarded(stream, result, png, info);

    png_destroy_read_struct(&png, &info, NULL);
    if (stream != NULL) {
        fclose(stream);
    }
    return fine;
}

// Samples that are not the code of the picture's value; alpha has no transfer.
static int png_wrong_samples(const PngRead *png, const Image *image, const ImageEncoding *encoding)
{
    ImageEncoding plain = *encoding;
    int wrong = 0, bytes = png->bits / 8;

    plain.already_encoded = true;
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH * image->channels; x++) {
            bool is_alpha = image->channels % 2 == 0 && x % image->channels == image->channels - 1;
            const unsigned char *at = &png->rows[y][x * bytes];
            unsigned stored = bytes == 1 ? at[0] : (unsigned)at[0] << 8 | at[1];
            unsigned wanted = encode_code(is_alpha ? &plain : encoding,
                                          image->values[y * WIDTH * image->channels + x]);
            wrong += stored != wanted;
        }
    }
    return wrong;
}

static void test_png(void)
{
    static const struct {
        const char *name;
        const ImageEncoding *encoding;
        int channels, colour_type, gamma, srgb;
    } cases[] = {
        {"8 bit sRGB", &srgb_8, 3, PNG_COLOR_TYPE_RGB, 45455, 1},
        {"16 bit sRGB", &srgb_16, 3, PNG_COLOR_TYPE_RGB, 45455, 1},
        {"16 bit linear", &linear_16, 3, PNG_COLOR_TYPE_RGB, 100000, 0},
        {"8 bit power", &power_8, 3, PNG_COLOR_TYPE_RGB, 45455, 0},
        {"8 bit as it is", &as_is_8, 3, PNG_COLOR_TYPE_RGB, 45455, 1},
        {"8 bit with alpha", &srgb_8, 4, PNG_COLOR_TYPE_RGB_ALPHA, 45455, 1},
        {"16 bit with alpha", &power_16, 4, PNG_COLOR_TYPE_RGB_ALPHA, 45455, 0},
        {"8 bit grey", &srgb_8, 1, PNG_COLOR_TYPE_GRAY, 45455, 1},
        {"16 bit grey with alpha", &srgb_16, 2, PNG_COLOR_TYPE_GRAY_ALPHA, 45455, 1},
    };
    static PngRead png;

    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        Image image;
        ImageError error;

        if (!tap_ok(picture_make(&image, cases[i].channels, 1) &&
                        image_write(&image, cases[i].encoding, "a.PNG", &error) == IMAGE_OK &&
                        png_read_back("a.PNG", &png),
                    "png %s: written and read", cases[i].name)) {
            image_fini(&image);
            continue;
        }
        tap_ok(png.width == WIDTH && png.height == HEIGHT && png.colour_type == cases[i].colour_type,
               "png %s: size and colour type", cases[i].name);
        tap_ok(png.gamma == cases[i].gamma && png.srgb == cases[i].srgb, "png %s: gAMA %d, sRGB %d", cases[i].name,
               png.gamma, png.srgb);
        tap_ok(png_wrong_samples(&png, &image, cases[i].encoding) == 0, "png %s: samples", cases[i].name);
        image_fini(&image);
    }
}

static size_t file_load(const char *path, char *bytes, size_t room)
{
    FILE *stream = fopen(path, "rb");
    size_t length = 0;

    if (stream != NULL) {
        length = fread(bytes, 1, room, stream);
        fclose(stream);
    }
    return length;
}

static bool file_save(const char *path, const char *text)
{
    FILE *stream = fopen(path, "wb");

    return stream != NULL && fputs(text, stream) >= 0 && fclose(stream) == 0;
}

static bool file_holds(const char *path, const char *text)
{
    char bytes[64] = "";

    return file_load(path, bytes, sizeof bytes - 1) == strlen(text) && strcmp(bytes, text) == 0;
}

static bool files_equal(const char *a, const char *b)
{
    static char bytes_a[1 << 17], bytes_b[1 << 17];
    size_t length = file_load(a, bytes_a, sizeof bytes_a);

    return length > 0 && length == file_load(b, bytes_b, sizeof bytes_b) && memcmp(bytes_a, bytes_b, length) == 0;
}

static int files_in_folder(void)
{
    int count = -1;
    FILE *listing = popen("ls -A | wc -l", "r");

    if (listing != NULL) {
        if (fscanf(listing, "%d", &count) != 1) {
            count = -1;
        }
        pclose(listing);
    }
    return count;
}

static void test_paths(void)
{
    static const struct {
        const char *path;
        ImageDepth depth;
        ImageStatus status;
    } cases[] = {
        {"a.png", IMAGE_DEPTH_8, IMAGE_OK},
        {"a.PnG", IMAGE_DEPTH_16, IMAGE_OK},
        {"-", IMAGE_DEPTH_8, IMAGE_OK},
        {"a.png", IMAGE_DEPTH_FLOAT, IMAGE_BAD_DEPTH},
        {"-", IMAGE_DEPTH_FLOAT, IMAGE_BAD_DEPTH},
        {"a", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {"", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {"a.", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {".png", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {"a.png/b", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {"a.averylongending", IMAGE_DEPTH_8, IMAGE_UNKNOWN_FORMAT},
        {"missing/a.png", IMAGE_DEPTH_8, IMAGE_IO},
        {"folder.png", IMAGE_DEPTH_8, IMAGE_IO},
    };
    Image image;
    int before;

    tap_ok(mkdir("folder.png", 0777) == 0 && file_save("a.png", "old") && picture_make(&image, 3, 1), "paths: set up");
    before = files_in_folder();
    for (size_t i = 0; i < RT_COUNT_OF(cases); i++) {
        ImageEncoding encoding = {.depth = cases[i].depth, .threads = 1};
        ImageError error;
        ImageStatus status = image_check_path(cases[i].path, cases[i].depth, &error);

        tap_ok(status == cases[i].status, "check of `%s`: %d, want %d", cases[i].path, (int)status,
               (int)cases[i].status);
        if (status != IMAGE_OK) {
            tap_ok(image_write(&image, &encoding, cases[i].path, &error) == status, "write to `%s`: %s",
                   cases[i].path, error.detail);
        }
    }
    tap_ok(file_holds("a.png", "old") && files_in_folder() == before, "a check leaves no trace");
    tap_ok(image_path_depth("x/a.EXR") == IMAGE_DEPTH_FLOAT && image_path_depth("a.png") == IMAGE_DEPTH_8 &&
               image_path_depth("-") == IMAGE_DEPTH_8,
           "the depth that a path has by itself");
    image_fini(&image);
}

static void test_atomic_replace(const Image *image)
{
    struct stat status;
    ImageError error;
    mode_t mask = umask(027);

    tap_ok(file_save("target.png", "old") && symlink("target.png", "link.png") == 0, "atomic: set up");
    tap_ok(image_write(image, &srgb_8, "one.png", &error) == IMAGE_OK &&
               image_write(image, &srgb_8, "target.png", &error) == IMAGE_OK && files_equal("one.png", "target.png"),
           "an old file is replaced, and the same picture gives the same bytes");
    tap_ok(stat("one.png", &status) == 0 && (status.st_mode & 0777) == 0640, "the mode obeys the mask: %o",
           (unsigned)status.st_mode);
    umask(mask);
    tap_ok(file_save("target.png", "old") && image_write(image, &srgb_8, "link.png", &error) == IMAGE_OK &&
               lstat("link.png", &status) == 0 && S_ISLNK(status.st_mode) && files_equal("one.png", "target.png"),
           "a symbolic link stays one, what it names is replaced");
    tap_ok(chmod("target.png", 0604) == 0 && image_write(image, &srgb_8, "target.png", &error) == IMAGE_OK &&
               stat("target.png", &status) == 0 && (status.st_mode & 07777) == 0604,
           "the permissions of the old file stay: %o", (unsigned)status.st_mode);
    tap_ok(symlink("new.png", "dangling.png") == 0 &&
               image_write(image, &srgb_8, "dangling.png", &error) == IMAGE_OK && files_equal("one.png", "new.png"),
           "a link to nothing makes what it names");
}

static void test_full_device(const Image *image)
{
    ImageError error;
    struct stat status;

    if (stat("/dev/full", &status) != 0 || symlink("/dev/full", "full.png") != 0) {
        tap_skip("full device", "no /dev/full");
        return;
    }
    tap_ok(image_write(image, &srgb_8, "full.png", &error) == IMAGE_IO && strstr(error.detail, "space") != NULL,
           "a full device is reported: %s", error.detail);
    tap_ok(lstat("full.png", &status) == 0 && S_ISLNK(status.st_mode) && stat("/dev/full", &status) == 0 &&
               S_ISCHR(status.st_mode),
           "the device stays in place");
}

static void test_size_limit(const Image *image, const char *path, const ImageEncoding *encoding)
{
    struct rlimit old, small;
    ImageError error;
    ImageStatus status;
    int before;

    if (!tap_ok(file_save(path, "old") && getrlimit(RLIMIT_FSIZE, &old) == 0, "size limit %s: set up", path)) {
        return;
    }
    before = files_in_folder();
    small = (struct rlimit){1000, old.rlim_max};
    signal(SIGXFSZ, SIG_IGN);
    fflush(stdout); // which may be a file, and longer
    setrlimit(RLIMIT_FSIZE, &small);
    status = image_write(image, encoding, path, &error);
    setrlimit(RLIMIT_FSIZE, &old);
    tap_ok(status == IMAGE_IO && strstr(error.detail, "large") != NULL, "size limit %s: reported: %s", path,
           error.detail);
    tap_ok(file_holds(path, "old") && files_in_folder() == before, "size limit %s: the old file is kept, nothing else",
           path);
}

// Not even root's right to write anything may hide what is tested here.
static void test_no_permission(const Image *image)
{
    uid_t user = geteuid();
    ImageError error;
    bool ready = mkdir("sealed", 0755) == 0 && file_save("sealed/a.png", "old") && file_save("sealed.png", "old") &&
                 chmod("sealed", 0555) == 0 && chmod("sealed.png", 0444) == 0;

    if (user == 0 && seteuid(65534) != 0) {
        tap_skip("no permission", "root cannot step down");
        return;
    }
    tap_ok(ready && image_write(image, &srgb_8, "sealed/b.png", &error) == IMAGE_IO, "a read-only folder: %s",
           error.detail);
    tap_ok(image_check_path("sealed/b.png", IMAGE_DEPTH_8, &error) == IMAGE_IO, "a read-only folder, checked");
    tap_ok(image_write(image, &srgb_8, "sealed/a.png", &error) == IMAGE_IO && file_holds("sealed/a.png", "old"),
           "a file in a read-only folder");
    tap_ok(image_write(image, &srgb_8, "sealed.png", &error) == IMAGE_IO && file_holds("sealed.png", "old"),
           "a read-only file is kept");
    if (user == 0 && seteuid(0) != 0) {
        abort();
    }
    chmod("sealed", 0755);
}

static void test_standard_output(const Image *image)
{
    ImageError error;
    int saved = dup(STDOUT_FILENO);
    int fd = open("stdout.png", O_WRONLY | O_CREAT | O_TRUNC, 0666);
    ImageStatus status;

    fflush(stdout);
    dup2(fd, STDOUT_FILENO);
    status = image_write(image, &srgb_8, "-", &error);
    dup2(saved, STDOUT_FILENO);
    close(fd);
    close(saved);
    tap_ok(status == IMAGE_OK && files_equal("one.png", "stdout.png"), "`-` is PNG on standard output");
}

static void test_atomic(void)
{
    Image image;
    ImageError error;

    if (!tap_ok(picture_make(&image, 3, 7), "atomic: picture")) {
        return;
    }
    test_atomic_replace(&image);
    test_standard_output(&image);
    test_full_device(&image);
    test_size_limit(&image, "limited.png", &srgb_8);
    test_size_limit(&image, "limited.exr", &float_linear);
    if (image_check_path("a.tif", IMAGE_DEPTH_FLOAT, &error) == IMAGE_OK) {
        test_size_limit(&image, "limited.tif", &srgb_16);
        test_size_limit(&image, "limited.hdr", &float_linear);
        test_size_limit(&image, "limited.jpg", &srgb_8);
        test_size_limit(&image, "limited.bmp", &srgb_8);
    }
    test_no_permission(&image);
    image_fini(&image);
}

// The picture that a lossless file holds: codes over their greatest one, or the values.
static bool picture_expected(const Image *image, const ImageEncoding *encoding, Image *expected)
{
    if (!image_init(expected, image->width, image->height, image->channels)) {
        return false;
    }
    for (size_t i = 0; i < (size_t)(WIDTH * HEIGHT * image->channels); i++) {
        float value = image->values[i];
        float max = encoding->depth == IMAGE_DEPTH_8 ? 255.0f : 65535.0f;
        bool is_float = encoding->depth == IMAGE_DEPTH_FLOAT;
        expected->values[i] = is_float ? value : (float)encode_code(encoding, value) / max;
    }
    return true;
}

static void test_format(const char *path, const ImageEncoding *encoding, uint32_t seed, double bound)
{
    Image image = {0}, expected = {0}, back = {0};
    static const double thresholds[IMAGE_THRESHOLDS] = {0.0};
    ImageDifference difference = {.max = HUGE_VAL};
    ImageError error = {.no_memory = false};
    bool made = picture_make(&image, 3, seed);
    ImageStatus status;

    if (encoding->depth == IMAGE_DEPTH_FLOAT) {
        image.values[0] = 1000.0f; // beyond what integers hold
    }
    made = made && picture_expected(&image, encoding, &expected);
    status = made ? image_write(&image, encoding, path, &error) : IMAGE_NO_MEMORY;
    tap_ok(status == IMAGE_OK, "module writes %s: %s", path, error.detail);
    status = image_read(path, WIDTH * HEIGHT, &back, &error);
    tap_ok(status == IMAGE_OK && back.channels == 3, "module reads %s: %s", path, error.detail);
    status = status == IMAGE_OK && image_compare(&back, &expected, thresholds, &difference) ? IMAGE_OK : IMAGE_IO;
    tap_ok(status == IMAGE_OK && difference.max <= bound,
           "module keeps %s to %g: %g", path, bound, difference.max);
    image_fini(&image);
    image_fini(&expected);
    image_fini(&back);
}

// The second may pass between the two files: no writer may put the time into them.
static void test_same_bytes(const char *path, const char *again, const ImageEncoding *encoding)
{
    Image image;
    ImageError error;

    if (tap_ok(picture_make(&image, 3, 5), "same bytes: picture")) {
        bool written = image_write(&image, encoding, path, &error) == IMAGE_OK;
        usleep(1100000);
        written = written && image_write(&image, encoding, again, &error) == IMAGE_OK;
        tap_ok(written && files_equal(path, again), "%s and %s are the same bytes", path, again);
        image_fini(&image);
    }
}

static void test_bad_files(void)
{
    static char bytes[1 << 17];
    static const char *const truncated[] = {"t.png", "t.tif", "t.exr", "t.hdr", "t.bmp"};
    const ImageEncoding *encodings[] = {&srgb_16, &srgb_16, &float_linear, &float_linear, &srgb_8};
    Image image, made;
    ImageError error;

    tap_ok(image_read("nowhere.png", 100, &image, &error) == IMAGE_IO, "a missing file: %s", error.detail);
    tap_ok(image_read(".", 100, &image, &error) == IMAGE_IO, "a folder: %s", error.detail);
    tap_ok(file_save("text.png", "not a picture") && image_read("text.png", 100, &image, &error) == IMAGE_NOT_A_PICTURE,
           "a text: %s", error.detail);
    tap_ok(file_save("empty.png", "") && image_read("empty.png", 100, &image, &error) == IMAGE_NOT_A_PICTURE,
           "an empty file: %s", error.detail);
    if (!tap_ok(picture_make(&made, 3, 9), "bad files: picture")) {
        return;
    }
    for (size_t i = 0; i < RT_COUNT_OF(truncated); i++) {
        bool written = image_write(&made, encodings[i], truncated[i], &error) == IMAGE_OK;
        size_t length = file_load(truncated[i], bytes, sizeof bytes);

        tap_ok(written && image_read(truncated[i], WIDTH * HEIGHT - 1, &image, &error) == IMAGE_TOO_LARGE,
               "%s: the limit of pixels is obeyed", truncated[i]);
        tap_ok(truncate(truncated[i], (off_t)(length / 2)) == 0 &&
                   image_read(truncated[i], WIDTH * HEIGHT, &image, &error) == IMAGE_NOT_A_PICTURE &&
                   image.values == NULL,
               "%s: half a file is none: %s", truncated[i], error.detail);
    }
    image_fini(&made);
}

static void test_module(void)
{
    const double last_bit = 0x1p-24; // OpenImageIO multiplies codes by a reciprocal in single precision
    ImageError error;

    if (image_check_path("a.tif", IMAGE_DEPTH_FLOAT, &error) == IMAGE_NO_MODULE) {
        tap_skip("module", error.detail);
        return;
    }
    test_format("m.exr", &float_linear, 3, 0.0);
    test_format("mf.tif", &float_linear, 3, 0.0);
    test_format("m8.tif", &srgb_8, 3, last_bit);
    test_format("m16.tif", &linear_16, 3, last_bit);
    test_format("m16.png", &srgb_16, 3, last_bit);
    test_format("m.bmp", &srgb_8, 3, last_bit);
    test_format("m.ppm", &power_8, 3, last_bit);
    // RGBE has 8 bits below the greatest channel's exponent, here that of 1000 (Ward, Graphics Gems II, II.5).
    test_format("m.hdr", &float_linear, 3, 4.0);
    test_format("m.jpg", &linear_8, SMOOTH, 3.0 / 255.0);
    tap_ok(image_check_path("a.exr", IMAGE_DEPTH_8, &error) == IMAGE_BAD_DEPTH, "exr has no 8 bit");
    tap_ok(image_check_path("a.exr", IMAGE_DEPTH_16, &error) == IMAGE_BAD_DEPTH, "exr has no 16 bit");
    tap_ok(image_check_path("a.jpg", IMAGE_DEPTH_16, &error) == IMAGE_BAD_DEPTH, "jpeg has no 16 bit");
    tap_ok(image_check_path("a.hdr", IMAGE_DEPTH_8, &error) == IMAGE_BAD_DEPTH, "hdr has no 8 bit");
    tap_ok(image_check_path("a.bogus", IMAGE_DEPTH_8, &error) == IMAGE_UNKNOWN_FORMAT, "unknown ending: %s",
           error.detail);
    tap_ok(image_check_path("a.null", IMAGE_DEPTH_8, &error) == IMAGE_UNKNOWN_FORMAT, "no pictures into nothing");
    tap_ok(image_check_path("a.term", IMAGE_DEPTH_8, &error) == IMAGE_UNKNOWN_FORMAT, "no pictures to the terminal");
    test_same_bytes("s1.exr", "s2.exr", &float_linear);
    test_same_bytes("s1.tif", "s2.tif", &srgb_8);
    test_bad_files();
}

int main(void)
{
    char folder[] = "/tmp/test_image.XXXXXX";
    char command[64];

    if (mkdtemp(folder) == NULL || chmod(folder, 0777) != 0 || chdir(folder) != 0) {
        return 99;
    }
    test_png();
    test_paths();
    test_atomic();
    test_module();
    snprintf(command, sizeof command, "rm -r %s", folder);
    tap_ok(chdir("/") == 0 && system(command) == 0, "cleared away");
    return tap_done();
}
