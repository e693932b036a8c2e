// What must hold of a picture file that was read, for the targets that read some.
//
// SPDX-License-Identifier: MIT
#ifndef FUZZ_FUZZ_SAMPLES_H
#define FUZZ_FUZZ_SAMPLES_H

#include "fuzz/fuzz.h"
#include "image/picture_file.h"

// Reads every sample, so that a missing one is seen by a sanitizer.
static void fuzz_look_at(const PictureFile *file)
{
    size_t bytes = file->depth == IMAGE_DEPTH_8 ? 1 : file->depth == IMAGE_DEPTH_16 ? 2 : 4;
    size_t count = (size_t)file->width * (size_t)file->height * (size_t)file->channels * bytes;
    const unsigned char *samples = file->samples;
    unsigned sum = 0;
    FUZZ_HOLDS(file->width > 0 && file->height > 0 && file->channels >= 1 && file->channels <= 4);
    FUZZ_HOLDS(file->palette_count >= 0 && file->palette_count <= PICTURE_PALETTE_MAX);
    FUZZ_HOLDS(file->palette_count == 0 || file->channels == 1);
    for (size_t i = 0; i < count; i++) {
        sum += samples[i];
    }
    *(volatile unsigned *)&sum = sum;
}

#endif
