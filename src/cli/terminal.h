// What the programs share: whether messages are coloured, and help for mistyped options and their values.
//
// SPDX-License-Identifier: MIT
#ifndef CLI_TERMINAL_H
#define CLI_TERMINAL_H

#include <stdbool.h>
#include <stddef.h>

typedef enum ColorChoice { COLOR_AUTO, COLOR_ALWAYS, COLOR_NEVER } ColorChoice;

// The names of ColorChoice in their order, then NULL.
extern const char *const color_choices[];

// Whether messages on stderr are coloured: by themselves when it is a terminal that is not dumb, unless the environment
// has a NO_COLOR that is not empty.
bool color_is_on(ColorChoice choice);

// The word of the command line that getopt found fault with, for a letter that it does not know or 0: it continues to
// the next word behind the last letter of one.
const char *option_word(int argc, char **argv, int letter);

// The place of a word among names of which the last is NULL; -1: it is none of them.
int choice_find(const char *word, const char *const *names);
// Writes "did you mean `--name`?" for a word that no option is, `-name` or `--name=value`, when one of the options is
// near; else an empty text. `names` are the long ones, of which the last is NULL.
void advise_option(const char *word, const char *const *names, char *advice, size_t size);
// The same for the value of an option, "did you mean `v3`?"
void advise_value(const char *value, const char *const *names, char *advice, size_t size);

#endif
