// What the file of a picture keeps beside its pixels: one line of text by its name, of PNG and EXR.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_NOTE_READ_H
#define IMAGE_NOTE_READ_H

#include <stdbool.h>

#include "base/attributes.h"
#include "base/text.h"

typedef enum NoteResult { NOTE_FOUND, NOTE_NONE, NOTE_NO_FILE, NOTE_NO_PICTURE } NoteResult;

// Appends the text to `out`. NOTE_NO_FILE: errno says why; NOTE_NO_PICTURE: the file is neither, or broken before it.
NoteResult note_read(const char *path, const char *name, TextBuffer *out) RT_MUST_CHECK;

#endif
