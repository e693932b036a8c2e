// Files of partial results: the tiles of a picture that some process has traced, as its passes left them.
//
// A head says what the tiles are of, so that those of another scene, version or option are known for that; records
// follow, one a tile and pass, each with a check of its own. A file that was not written to its end is good up to its
// last whole record. Parts of a job, checkpoints, and what ranks send each other are all of this form. Numbers are
// little endian.
//
// SPDX-License-Identifier: MIT
#ifndef SHARE_PARTIAL_H
#define SHARE_PARTIAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/array.h"
#include "base/attributes.h"
#include "base/text.h"

// What the head says, each a text.
typedef enum PartialField {
    PARTIAL_VERSION,                   // of the program
    PARTIAL_SCENE,                     // the digest of its text
    PARTIAL_FILES,                     // of the files that it includes
    PARTIAL_PICTURES,                  // of those that it shows
    PARTIAL_OPTIONS,                   // from which the picture follows
    PARTIAL_RESULTS,                   // up to here two files are compared
    PARTIAL_COMMAND = PARTIAL_RESULTS, // the words of the command line, as --rerun has them
    PARTIAL_PART,                      // "2/8"; "": all tiles
    PARTIAL_FIELDS,
} PartialField;

typedef struct PartialHead {
    char *fields[PARTIAL_FIELDS]; // owned
} PartialHead;

bool partial_head_set(PartialHead *head, PartialField field, const char *value) RT_MUST_CHECK; // a copy
void partial_head_fini(PartialHead *head);

// What differs first, up to PARTIAL_RESULTS, which says that nothing does; and that as a sentence.
PartialField partial_head_differs(const PartialHead *a, const PartialHead *b);
const char *partial_difference(PartialField field);

// Whether the head is that of a part, and which.
bool partial_head_part(const PartialHead *head, int *part, int *parts);

typedef struct PartialRecord {
    uint32_t pass, tile;
    const unsigned char *bytes;
    size_t length;
} PartialRecord;

// Records that are no tiles of a pass.
enum { PARTIAL_TILES_MOST = 1 << 30, PARTIAL_CLOCK = PARTIAL_TILES_MOST, PARTIAL_END = PARTIAL_TILES_MOST + 1 };

typedef ARRAY(PartialRecord) PartialRecords;

typedef struct Partial {
    PartialHead head;
    PartialRecords records; // in the order of the file
    bool is_complete;       // PARTIAL_END was written: nothing is missing
    bool is_broken;         // bytes follow the last whole record
    unsigned char *bytes;   // of the file, which the records refer to; owned
} Partial;

typedef enum PartialResult {
    PARTIAL_OK,
    PARTIAL_NONE,       // no such file
    PARTIAL_NOT_READ,   // errno says why
    PARTIAL_NO_PARTIAL, // a file of another kind, or of another version of this one
    PARTIAL_NO_MEMORY,
} PartialResult;

// On any result but PARTIAL_OK nothing has to be released.
PartialResult partial_read(Partial *partial, const char *path) RT_MUST_CHECK;
// The same of a file's bytes, which must have been allocated and are then the partial's, or freed.
PartialResult partial_take(Partial *partial, unsigned char *bytes, size_t size) RT_MUST_CHECK;
void partial_fini(Partial *partial);

// Append what a file has; they remember when memory runs out.
void partial_append_head(TextBuffer *file, const PartialHead *head);
void partial_append(TextBuffer *file, const PartialRecord *record);

// Goes by pass and tile.
int partial_record_compare(const void *a, const void *b);

#endif
