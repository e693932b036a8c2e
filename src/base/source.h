// SourceMap: the texts of a run, under one numbering of bytes, and where a byte stands as file, line and column.
//
// Every text that is opened gets a range of global offsets of its own, so a Span is just two numbers, in any file.
// Texts in files are read in blocks and not kept; a line is read again, and lines are counted, only when a message is
// printed. Texts that cannot be read twice (pipes, strings) are kept.
//
// SPDX-License-Identifier: MIT
#ifndef BASE_SOURCE_H
#define BASE_SOURCE_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/attributes.h"
#include "base/digest.h"

// Global byte offsets, begin included and end not. Offset 0 belongs to no text.
typedef struct Span {
    uint64_t begin, end;
} Span;

#define SPAN_NONE ((Span){0, 0})

// The text in which an offset lies, as a whole: a message about it has a file and no line.
#define SPAN_WHOLE(offset) ((Span){(offset), 0})

static inline bool span_exists(Span span)
{
    return span.begin != 0;
}

// From the beginning of the first to the end of the last.
static inline Span span_join(Span first, Span last)
{
    return (Span){first.begin ? first.begin : last.begin, last.end ? last.end : first.end};
}

typedef struct SourceMap SourceMap;
typedef struct Source Source; // one opened text; owned by the map

typedef enum SourceResult {
    SOURCE_OK,
    SOURCE_NOT_FOUND,
    SOURCE_NOT_READABLE, // exists, may not be opened or read
    SOURCE_IS_DIRECTORY,
    SOURCE_NOT_A_FILE, // a pipe or a device, where a file is wanted
    SOURCE_TOO_LARGE,  // over the limit of bytes that was given
    SOURCE_TOO_MUCH,   // more would have to be kept than source_map_set_memory allows
    SOURCE_NO_MEMORY,
    SOURCE_CANCELLED, // see source_map_set_cancel
} SourceResult;

// Where a span begins. Of a line longer than 200 bytes, some 200 around the span are kept, "..." where it was cut.
typedef struct SourceLocation {
    const char *name;   // as it was opened
    uint64_t line;      // from 1
    uint64_t column;    // from 1, in characters (UTF-8 code points; a stray byte counts as one)
    uint64_t offset;    // of the span's first byte in its text
    const char *text;   // the line without its end (LF or CRLF), valid until the next call on the map
    size_t text_length; // in bytes
    size_t caret_begin; // byte offsets of the span in `text`, clipped to this line
    size_t caret_end;
} SourceLocation;

SourceMap *source_map_new(void) RT_MUST_CHECK; // NULL when out of memory
void source_map_free(SourceMap *map);          // closes everything

// When the flag turns true, opening and reading stop soon. It must outlive the map; NULL, as at first: never.
void source_map_set_cancel(SourceMap *map, const atomic_bool *cancel);

// Bytes of all texts that were opened; a file that was opened several times counts once.
uint64_t source_map_bytes(const SourceMap *map);

// How many bytes may be kept of one pipe or device; at first any number.
void source_map_set_memory(SourceMap *map, size_t bytes);

// From now on the files that source_open_real opens are read once more when they are closed, for source_map_digest.
void source_map_keep_digests(SourceMap *map);
// How many there were, and the digest of their digests in the order of closing; of 0 files it is not set.
size_t source_map_digest(const SourceMap *map, unsigned char digest[DIGEST_BYTES]);
// That of all bytes of a text that is open or kept. False when it cannot be read.
bool source_digest(const Source *source, unsigned char digest[DIGEST_BYTES]) RT_MUST_CHECK;

// Opens a file, a pipe or a device for reading from its start. On success *source is set; on failure *error_number is
// an errno value or 0.
SourceResult source_open_file(SourceMap *map, const char *path, uint64_t limit_bytes, Source **source,
                              int *error_number) RT_MUST_CHECK;

// The same for a regular file at a path that begins with / and in which nothing is a link (any more): what was checked
// is what is read, whoever changes the folders meanwhile. Messages call it by the name.
SourceResult source_open_real(SourceMap *map, const char *real, const char *name, uint64_t limit_bytes, Source **source,
                              int *error_number) RT_MUST_CHECK;

// Makes such a file, or empties or prolongs one that is there, and opens it for writing. -1 and errno on failure;
// EINVAL for what is no regular file.
int source_create_real(const char *real, bool appends) RT_MUST_CHECK;

// The same for a stream that is open already, which is read to its end at once and stays the caller's.
SourceResult source_open_stream(SourceMap *map, const char *name, int file, uint64_t limit_bytes, Source **source,
                                int *error_number) RT_MUST_CHECK;

// Makes a source of a text in memory, which is copied. NULL when out of memory.
Source *source_open_text(SourceMap *map, const char *name, const char *text, size_t length) RT_MUST_CHECK;

// How many sources there are; those that were dropped have gone. Of one of them its name and its extent, SPAN_NONE for a
// list.
size_t source_map_count(const SourceMap *map);
const char *source_map_name(const SourceMap *map, size_t i);
Span source_map_extent(const SourceMap *map, size_t i);

// Makes a source of things that have numbers and no text: byte i stands for the i-th, from 0, of `count`, and messages
// name it "name[i]". NULL when out of memory.
Source *source_open_list(SourceMap *map, const char *name, uint64_t count) RT_MUST_CHECK;

// Forgets the source that was opened last, of which nothing is kept: what it numbered is numbered anew.
void source_drop(Source *source);

// Reads the next bytes: their number, 0 at the end, -1 on an error (errno is set; ECANCELED: cancelled).
ptrdiff_t source_read(Source *source, char *buffer, size_t size) RT_MUST_CHECK;

// Closes the stream; the name and the means to find a line again stay with the map.
// Bytes at a position, counted from the text's first, whatever was read before: fills the buffer, or is false. May be
// called from several threads at once.
bool source_read_at(const Source *source, uint64_t position, char *buffer, size_t size) RT_MUST_CHECK;
// source_read continues at a position, which is not beyond the end.
void source_seek(Source *source, uint64_t position);

void source_close(Source *source);

bool source_is_again(const Source *source); // its file was opened before, by this name or another
Span source_extent(const Source *source); // of the whole text, as far as it was read or is a file
uint64_t source_base(const Source *source); // the global offset of its first byte
const char *source_name(const Source *source);

// Finds file, line, column and the text of the line in which the span begins. False when the span is in no text or its
// file cannot be read any more, or when it is a text as a whole (name is then still set if it is known, and line is 0).
bool source_locate(SourceMap *map, Span span, SourceLocation *location) RT_MUST_CHECK;

// Reads the text of a span, which lies in one text, once more: span.end - span.begin bytes. False when it cannot be
// read.
bool source_read_span(SourceMap *map, Span span, char *buffer) RT_MUST_CHECK;

// Bytes read from all sources so far.
uint64_t source_bytes_read(const SourceMap *map);

#endif
