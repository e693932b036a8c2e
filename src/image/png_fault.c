// Errors by longjmp, warnings not at all.
//
// SPDX-License-Identifier: MIT
#include "image/png_fault.h"

#include <setjmp.h>
#include <stdlib.h>

#include "image/image_error.h"

void png_fault_error(png_structp png, png_const_charp message)
{
    ImageError *error = png_get_error_ptr(png);
    if (error->detail[0] == '\0') {
        image_error_set(error, "%s", message);
    }
    png_longjmp(png, 1);
}

png_voidp png_fault_malloc(png_structp png, png_alloc_size_t size)
{
    void *memory = malloc(size);
    ImageError *error = png_get_mem_ptr(png);
    error->no_memory = error->no_memory || !memory;
    return memory;
}

void png_fault_free(png_structp png, png_voidp memory)
{
    (void)png;
    free(memory);
}

void png_fault_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}
