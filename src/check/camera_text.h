// The text of a scene with all of its cameras turned a little, by words of the language and without an understanding of
// it.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_CAMERA_TEXT_H
#define CHECK_CAMERA_TEXT_H

#include <stdbool.h>

// Copies the file `scene` to `copy` with `words` before the closing brace of each `camera { … }` that is neither in a
// comment nor in a string. False, and no file to rely on, when there is none, or a file cannot be read or written.
bool camera_text_write(const char *scene, const char *words, const char *copy);

#endif
