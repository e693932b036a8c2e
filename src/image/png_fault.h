// libpng's errors and warnings as ours: what reading and writing hand to it.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PNG_FAULT_H
#define IMAGE_PNG_FAULT_H

#include <png.h>

// The error pointer is an ImageError. Sets it, unless a message stands there already (the system's own, say), and goes
// back to where setjmp was called.
void png_fault_error(png_structp png, png_const_charp message);

// Memory of libpng's; one that fails is noted in the same ImageError, because libpng continues without it where it can.
png_voidp png_fault_malloc(png_structp png, png_alloc_size_t size);
void png_fault_free(png_structp png, png_voidp memory);

// Says nothing: what is wrong beside the pixels is nobody's concern.
void png_fault_warning(png_structp png, png_const_charp message);

#endif
