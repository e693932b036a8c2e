// SPDX-License-Identifier: MIT
#include "check/say.h"

#include <stdarg.h>
#include <stdio.h>

void say(const Options *options, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs(color_is_on(options->color) ? "\033[1;31mrtcheck:\033[0m " : "rtcheck: ", stderr);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}
