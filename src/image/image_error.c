// Messages of the system and of the libraries as one line of text.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "image/image_error.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void image_error_clear(ImageError *error)
{
    error->detail[0] = '\0';
    error->no_memory = false;
}

void image_error_set(ImageError *error, const char *format, ...)
{
    va_list arguments;

    va_start(arguments, format);
    if (vsnprintf(error->detail, sizeof error->detail, format, arguments) < 0) {
        error->detail[0] = '\0';
    }
    va_end(arguments);
    error->detail[strcspn(error->detail, "\r\n")] = '\0';
    for (char *c = error->detail; *c != '\0'; c++) {
        if ((unsigned char)*c < ' ' || *c == 127) {
            *c = '?';
        }
    }
}

void image_error_system(ImageError *error, const char *path, int code)
{
    const char *text = strerrordesc_np(code); // unlike strerror: safe in threads, and no locale

    error->no_memory = error->no_memory || code == ENOMEM;
    image_error_set(error, "%s: %s", path, text ? text : "unknown error");
}
