// Knows the environment and the standard streams; prints nothing.
//
// SPDX-License-Identifier: MIT
#include "cli/terminal.h"

#include <getopt.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "rtlang/rtlang.h"

const char *const color_choices[] = {
    [COLOR_AUTO] = "auto", [COLOR_ALWAYS] = "always", [COLOR_NEVER] = "never", NULL};

bool color_is_on(ColorChoice choice)
{
    const char *no_color = getenv("NO_COLOR"), *term = getenv("TERM");
    if (choice != COLOR_AUTO) {
        return choice == COLOR_ALWAYS;
    }
    return isatty(STDERR_FILENO) && !(no_color && no_color[0]) && term && term[0] && strcmp(term, "dumb") != 0;
}

const char *option_word(int argc, char **argv, int letter)
{
    const char *next = optind < argc ? argv[optind] : "";
    bool is_next = letter > 0 && letter <= UCHAR_MAX && next[0] == '-' && next[1] != '-' && strchr(next + 1, letter);
    return is_next ? next : argv[optind - 1];
}

int choice_find(const char *word, const char *const *names)
{
    for (int i = 0; names[i]; i++) {
        if (strcmp(word, names[i]) == 0) {
            return i;
        }
    }
    return -1;
}

void advise_option(const char *word, const char *const *names, char *advice, size_t size)
{
    char name[64];
    const char *begin = word + strspn(word, "-");
    size_t length = strcspn(begin, "=");
    advice[0] = '\0';
    if (begin == word || length < 2 || length >= sizeof name) {
        return;
    }
    memcpy(name, begin, length);
    name[length] = '\0';
    const char *nearest = choice_find(name, names) >= 0 ? names[choice_find(name, names)] : rt_nearest(name, names);
    if (nearest) {
        snprintf(advice, size, "did you mean `--%s`?", nearest);
    }
}

void advise_value(const char *value, const char *const *names, char *advice, size_t size)
{
    const char *nearest = rt_nearest(value, names);
    advice[0] = '\0';
    if (nearest) {
        snprintf(advice, size, "did you mean `%s`?", nearest);
    }
}
