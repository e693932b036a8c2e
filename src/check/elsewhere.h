// Pixels of two pictures that differ, in which POV-Ray differs as much from itself where the scene is put elsewhere.
//
// A picture stays the same when all lengths are multiplied, and all but the same when it is moved by a millionth of a
// pixel: what then comes out otherwise hangs on lengths built into POV-Ray, or on the last bits of numbers. Reads no
// list of scenes.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_ELSEWHERE_H
#define CHECK_ELSEWHERE_H

#include <stdint.h>

#include "check/options.h"
#include "image/image.h"

typedef struct ElsewhereJob {
    const Options *options;
    const char *scene, *povray, *folder; // the last for temporary files, absolute
    char **include_paths;                // absolute; of them options->include_path_count were given
    int include_path_count;
    double threshold;                    // of a channel's difference
} ElsewhereJob;

// Of the pixels in which `ours` and `theirs`, of the options' size, are farther apart than the threshold, how many are
// not so far from ours in one of options->elsewhere more of POV-Ray's pictures, or are half as far from its own when
// the picture is moved.
uint64_t elsewhere_count(const ElsewhereJob *job, const Image *ours, const Image *theirs);

#endif
