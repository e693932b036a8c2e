// Filling an ImageError: one line of text, cut to fit.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_IMAGE_ERROR_H
#define IMAGE_IMAGE_ERROR_H

#include "base/attributes.h"
#include "image/image.h"

void image_error_clear(ImageError *error);

// Keeps the first line and prints no control characters.
void image_error_set(ImageError *error, const char *format, ...) RT_PRINTF(2, 3);

// The system's message for an errno value, after the name of what it happened to.
void image_error_system(ImageError *error, const char *path, int code);

#endif
