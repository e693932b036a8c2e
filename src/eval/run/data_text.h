// A data file that is open for reading, and the values in its text.
//
// SPDX-License-Identifier: MIT
#ifndef EVAL_RUN_DATA_TEXT_H
#define EVAL_RUN_DATA_TEXT_H

#include "eval/run/run.h"

enum { DATA_BLOCK_BYTES = 64 << 10 };

struct DataFile {
    DataFile *next;
    Source *source;
    const char *at, *end; // what was read and not yet used; a zero follows
    uint64_t end_offset;  // global offset of `end`
    bool ended;           // nothing follows `end`
    TextBuffer text;      // of the string that was read last
    char block[DATA_BLOCK_BYTES + 1];
};

// The next value, VALUE_NONE at the end. False after a fault.
bool data_read_value(Eval *ev, DataFile *file, Value *value) RT_MUST_CHECK;
// What follows a value: a comma, or the end. False after a fault.
bool data_read_comma(Eval *ev, DataFile *file, bool *is_end) RT_MUST_CHECK;

// The next number, or the three of a vector, and the comma behind it, where they are written in the most usual way and
// at hand; of `value` all but the numbers and the kind stays as it is. False: nothing was done.
bool data_read_plainly(DataFile *file, Value *value) RT_MUST_CHECK;

#endif
