// The table of POV-Ray 3.7's options: a row has a key of .ini files, its switch, and what rtlang does with it.
//
// All that the manual lists ("Command-Line and INI-File Options") and the few that the program knows besides. What is
// read lands in a PovraySettings; reading is povray_read.c's, following povray.c's.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_POVRAY_TABLE_H
#define CLI_POVRAY_TABLE_H

#include <stdbool.h>
#include <stddef.h>

// The streams of text, in the order of the manual.
enum { POVRAY_DEBUG, POVRAY_FATAL, POVRAY_RENDER, POVRAY_STATISTICS, POVRAY_WARNING, POVRAY_ALL, POVRAY_STREAMS };

typedef enum PovrayKind {
    POVRAY_BOOL,      // true, yes, on, 1; all else is off
    POVRAY_INTEGER,   // a number, cut to a whole one
    POVRAY_BITS,      // 8 or 16
    POVRAY_NUMBER,
    POVRAY_GAMMA,     // a number above 0, or sRGB, which is 0
    POVRAY_TEXT,
    POVRAY_FILE,      // a name, or true for the stream's own, or false for none
    POVRAY_TYPE,      // one of the letters of picture formats
    POVRAY_ALL_ON,    // turns all streams on or off
    POVRAY_LIBRARY,   // one more folder
    POVRAY_DECLARE,   // NAME=NUMBER
    POVRAY_INI,       // a file of options, read here
} PovrayKind;

// Bytes of a text that was read.
typedef struct PovrayPlace {
    const char *name, *text; // of the settings' own texts
    size_t begin, end;
} PovrayPlace;

// Pointers are to texts that the settings own.
typedef struct PovraySettings {
    int width, height;
    double start_column, end_column, start_row, end_row; // pixels from 1, or a share; below 0, or for starts 0: not
                                                         // said
    bool has_output;
    char type; // letter of the format
    bool is_grey;
    int bits;
    bool has_alpha;
    double file_gamma;
    const char *input, *output, *header, *create_ini; // NULL: not said
    PovrayPlace input_place;
    bool antialias;
    int method, depth;
    double threshold, antialias_gamma;
    int quality, threads;
    double clock; // NAN: not said
    int initial_frame, final_frame, frame_step;
    double initial_clock, final_clock, subset_start, subset_end; // subset_*: frames, or a share; 0: not said
    bool is_cyclic;
    bool verbose;
    int warning_level;
    bool consoles[POVRAY_STREAMS];
    const char *files[POVRAY_STREAMS]; // NULL: none
    bool appends;
    const char **libraries; // owned list
    size_t library_count, usual_count; // the first ones are the usual povray.ini's, which the session knows
    const char **declarations; // owned list
    size_t declaration_count;
    char **texts; // owned list of all of these
    size_t text_count;
} PovraySettings;

typedef struct PovrayRow {
    const char *key;
    const char *letters;   // of the switch; NULL: none
    const char *value_key; // what follows the letters is for this key, and the sign turns `key` on or off; NULL: it is
                           // for `key`
    PovrayKind kind;
    bool is_followed;      // else it is read, checked, and does nothing
    size_t field;          // offset in PovraySettings
    double low, high;      // of numbers
    const char *refusal;   // what rtlang lacks; NULL: nothing. Of what is on or off, on is refused, or where `low` is 1
                           // off
    const char *help;
} PovrayRow;

// The rows in the order of the manual; NULL past the end.
const PovrayRow *povray_row(size_t i);
const PovrayRow *povray_row_of_key(const char *key, size_t length); // NULL: there is none

enum { POVRAY_ROWS_MOST = 160 };

#endif
