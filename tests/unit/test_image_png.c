// Tests of reading PNG: every form that the format has, against values known beforehand; and broken files, about which
// libpng must not print.
//
// SPDX-License-Identifier: MIT
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/attributes.h"
#include "image/image.h"
#include "unit/tap.h"

enum { WIDTH = 13, HEIGHT = 9, PALETTE = 4, LIMIT = WIDTH * HEIGHT };

typedef struct Form {
    const char *name;
    int colour_type, bits, interlace;
    int channels; // of the picture that is read
} Form;

static const png_color palette[PALETTE] = {{0, 0, 0}, {255, 0, 51}, {1, 2, 3}, {102, 204, 255}};
static const png_byte palette_alpha[PALETTE] = {0, 51, 255, 255};

// What stands in a channel of a pixel, in as many bits.
static unsigned code_at(const Form *form, int x, int y, int channel)
{
    unsigned code = (unsigned)(x * 7919 + y * 104729 + channel * 1299709) * 2654435761u >> 8;

    return form->colour_type == PNG_COLOR_TYPE_PALETTE ? code % PALETTE : code & ((1u << form->bits) - 1);
}

static float value_at(const Form *form, int x, int y, int channel)
{
    if (form->colour_type == PNG_COLOR_TYPE_PALETTE) {
        const png_color *entry = &palette[code_at(form, x, y, 0)];
        const png_byte bytes[] = {entry->red, entry->green, entry->blue, palette_alpha[code_at(form, x, y, 0)]};
        return (float)(bytes[channel] / 255.0);
    }
    return (float)(code_at(form, x, y, channel) / (double)((1u << form->bits) - 1));
}

static int stored_channels(const Form *form)
{
    return form->colour_type == PNG_COLOR_TYPE_PALETTE ? 1 : form->channels;
}

static void row_pack(const Form *form, int y, unsigned char *row)
{
    int bit = 0;

    memset(row, 0, (size_t)WIDTH * 8);
    for (int x = 0; x < WIDTH; x++) {
        for (int channel = 0; channel < stored_channels(form); channel++) {
            unsigned code = code_at(form, x, y, channel);
            for (int i = form->bits - 1; i >= 0; i--, bit++) {
                row[bit / 8] = (unsigned char)(row[bit / 8] | (code >> i & 1) << (7 - bit % 8));
            }
        }
    }
}

static bool form_write(const Form *form, const char *path)
{
    static unsigned char rows[HEIGHT][WIDTH * 8];
    png_bytep pointers[HEIGHT];
    FILE *stream = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png != NULL ? png_create_info_struct(png) : NULL;
    bool fine = stream != NULL && info != NULL;

    if (fine) {
        png_init_io(png, stream);
        png_set_IHDR(png, info, WIDTH, HEIGHT, form->bits, form->colour_type, form->interlace,
                     PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        if (form->colour_type == PNG_COLOR_TYPE_PALETTE) {
            png_set_PLTE(png, info, palette, PALETTE);
            png_set_tRNS(png, info, palette_alpha, PALETTE, NULL);
        }
        for (int y = 0; y < HEIGHT; y++) {
            row_pack(form, y, rows[y]);
            pointers[y] = rows[y];
        }
        png_write_info(png, info);
        png_write_image(png, pointers);
        png_write_end(png, NULL);
    }
    png_destroy_write_struct(&png, &info);
    return stream != NULL && fclose(stream) == 0 && fine;
}

static int count_differences(const Form *form, const Image *image)
{
    int wrong = 0;

    for (int i = 0; i < WIDTH * HEIGHT * form->channels; i++) {
        int channel = i % form->channels, x = i / form->channels % WIDTH, y = i / form->channels / WIDTH;
        wrong += fabsf(image->values[i] - value_at(form, x, y, channel)) > 0x1p-24f;
    }
    return wrong;
}

static void test_forms(void)
{
    static const Form forms[] = {
        {"grey 1", PNG_COLOR_TYPE_GRAY, 1, PNG_INTERLACE_NONE, 1},
        {"grey 2", PNG_COLOR_TYPE_GRAY, 2, PNG_INTERLACE_NONE, 1},
        {"grey 4, interlaced", PNG_COLOR_TYPE_GRAY, 4, PNG_INTERLACE_ADAM7, 1},
        {"grey 8", PNG_COLOR_TYPE_GRAY, 8, PNG_INTERLACE_NONE, 1},
        {"grey 16", PNG_COLOR_TYPE_GRAY, 16, PNG_INTERLACE_NONE, 1},
        {"grey and alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8, PNG_INTERLACE_ADAM7, 2},
        {"grey and alpha 16", PNG_COLOR_TYPE_GRAY_ALPHA, 16, PNG_INTERLACE_NONE, 2},
        {"colour 8", PNG_COLOR_TYPE_RGB, 8, PNG_INTERLACE_NONE, 3},
        {"colour 16, interlaced", PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_ADAM7, 3},
        {"colour and alpha 8", PNG_COLOR_TYPE_RGB_ALPHA, 8, PNG_INTERLACE_NONE, 4},
        {"colour and alpha 16", PNG_COLOR_TYPE_RGB_ALPHA, 16, PNG_INTERLACE_NONE, 4},
        {"palette 2", PNG_COLOR_TYPE_PALETTE, 2, PNG_INTERLACE_NONE, 4},
        {"palette 8, interlaced", PNG_COLOR_TYPE_PALETTE, 8, PNG_INTERLACE_ADAM7, 4},
    };

    for (size_t i = 0; i < RT_COUNT_OF(forms); i++) {
        const Form *form = &forms[i];
        Image image;
        ImageError error = {.no_memory = false};
        bool fine = form_write(form, "form.png") && image_read("form.png", LIMIT, &image, &error) == IMAGE_OK;

        if (tap_ok(fine && image.width == WIDTH && image.height == HEIGHT && image.channels == form->channels,
                   "%s: size and channels %s", form->name, error.detail)) {
            int wrong = count_differences(form, &image);
            tap_ok(wrong == 0, "%s: values (%d wrong)", form->name, wrong);
            image_fini(&image);
        }
        tap_ok(image_read("form.png", LIMIT - 1, &image, &error) == IMAGE_TOO_LARGE && image.values == NULL,
               "%s: the limit of pixels is obeyed", form->name);
    }
}

// Reads the file cut off after each length, and with each byte changed, while standard error goes to a file.
static void test_broken(void)
{
    static const Form form = {"", PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_ADAM7, 3};
    static unsigned char bytes[1 << 14];
    struct stat status;
    Image image;
    ImageError error;
    int kept = dup(STDERR_FILENO), accepted = 0;
    FILE *stream = form_write(&form, "whole.png") ? fopen("whole.png", "rb") : NULL;
    size_t length = stream != NULL ? fread(bytes, 1, sizeof bytes, stream) : 0;

    fclose(stream);
    tap_ok(length > 100 && freopen("said.txt", "w", stderr) != NULL, "broken files: set up");
    for (size_t i = 8; i < 2 * length; i++) {
        stream = fopen("broken.png", "wb");
        bytes[i % length] ^= i < length ? 0 : 0x55;
        fwrite(bytes, 1, i < length ? i : length, stream);
        bytes[i % length] ^= i < length ? 0 : 0x55;
        fclose(stream);
        if (i - length < 8) {
            continue; // the signature: no PNG, and nothing for this reader
        }
        if (image_read("broken.png", LIMIT, &image, &error) == IMAGE_OK) {
            accepted++;
            image_fini(&image);
        }
    }
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    tap_ok(accepted == 0, "a file that is cut off or changed is no picture (%d were)", accepted);
    tap_ok(stat("said.txt", &status) == 0 && status.st_size == 0, "nothing is printed about it");
}

int main(void)
{
    char folder[] = "/tmp/test_image_png.XXXXXX", command[64];

    if (mkdtemp(folder) == NULL || chdir(folder) != 0) {
        return 99;
    }
    test_forms();
    test_broken();
    snprintf(command, sizeof command, "rm -r %s", folder);
    tap_ok(chdir("/") == 0 && system(command) == 0, "cleared away");
    return tap_done();
}
