// Pixels of two pictures that differ, in which POV-Ray differs as much from itself where the scene is all but the same.
//
// A picture stays the same when its camera is turned by a billionth of a pixel, and when all lengths are multiplied:
// what then comes out otherwise hangs on the last bits of numbers, or on lengths built into POV-Ray. The turn is
// written into the scene's own text, so that no reading of rtlang's takes part; other sizes are those of rtlang's text,
// which counts only where POV-Ray draws it as it draws the scene. Reads no list of scenes.
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
    double threshold; // of a channel's difference
} ElsewhereJob;

// Of the pixels in which `ours` and `theirs`, of the options' size, are farther apart than the threshold, in how many
// POV-Ray does not agree with itself, by options->elsewhere more of its pictures. At most one of a thousand pixels is
// excused; when that cannot be enough, none is, and nothing is drawn.
uint64_t elsewhere_count(const ElsewhereJob *job, const Image *ours, const Image *theirs);

// What POV-Ray draws otherwise when a scene is larger hangs on lengths built into it. In how many pixels that is not
// so: those in which `ours` is apart from POV-Ray's picture of what rtlang wrote of the scene, larger, and those that
// differ and in which it does not draw that text, as it is, as it draws the scene. The least of three sizes; -1 where
// more than one of a thousand pixels of that text as it is are not the scene's.
int64_t elsewhere_larger(const ElsewhereJob *job, const Image *ours, const Image *theirs);

#endif
