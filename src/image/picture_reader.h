// Reading picture files in a process of its own, for formats that large libraries decode: what a broken file makes of
// such a library is kept from the program.
//
// The process is a copy of this one that has forbidden itself all but reading (base/confine_filter.h). It is started
// for the first file and serves those after it that the same library reads; samples come back through a pipe, and
// whatever it says is judged.
//
// SPDX-License-Identifier: MIT
#ifndef IMAGE_PICTURE_READER_H
#define IMAGE_PICTURE_READER_H

#include <stdatomic.h>
#include <sys/types.h>

#include "image/picture_file.h"

typedef struct PictureReader {
    pid_t process;   // 0: none is started
    bool reads_jpeg; // it has loaded the library for that, or the one for all else
    int requests[2]; // both ends, so that writing to a process that ended is no signal
    int replies;
    const atomic_bool *cancel; // what is waited for is given up when it is set; not NULL
} PictureReader;

// Starts nothing yet.
void picture_reader_init(PictureReader *reader, const atomic_bool *cancel);

// As picture_file_read_real. After a fault of the process the next file has a new one. Must be ended by the thread that
// read, whose end is the process's.
ImageStatus picture_reader_read(PictureReader *reader, const char *real, const char *format, const PictureLimit *limit,
                                PictureFile *file, ImageError *error) RT_MUST_CHECK;

// Ends the process, if there is one; reading starts another.
void picture_reader_end(PictureReader *reader);

#endif
