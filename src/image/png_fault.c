// Errors by longjmp, warnings not at all.
//
// SPDX-License-Identifier: MIT
#include "image/png_fault.h"

#include <setjmp.h>

#include "image/image_error.h"

void png_fault_error(png_structp png, png_const_charp message)
{
    ImageError *error = png_get_error_ptr(png);
    if (error->detail[0] == '\0') {
        image_error_set(error, "%s", message);
    }
    png_longjmp(png, 1);
}

void png_fault_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}
