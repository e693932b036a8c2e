// What a picture was drawn with, as text that its file keeps, and drawing it again by that.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_PROVENANCE_H
#define CLI_PROVENANCE_H

#include "cli/options.h"

// The options that the picture follows from, in the words of the command line with blanks between; a blank or a backslash
// in a word has a backslash before it. To be freed; NULL when out of memory.
// `samples` a pixel were taken, more than 0 once that is known: a run that had a goal, or was interrupted, is repeated by
// them.
char *provenance_options(const Options *options, double samples);

// One more word of such a text.
void provenance_put_word(FILE *out, const char *word);
// Splits one where it stands; `words` has room for all. Returns how many.
int provenance_split(char *text, char **words);

// --rerun: those of a picture, before the words that are given. Reads them anew into *options, which then holds the text
// in `rerun_words`. RT_OK, or what was reported.
rt_status provenance_recall(rt_session *session, int argc, char **argv, Options *options);

// Whether the file that was drawn has the bytes of the one it is to repeat: prints so, or reports what differs.
rt_status provenance_compare(rt_session *session, const char *picture, const char *again);

#endif
