// Prints the explanations of all codes as Markdown: what docs/diagnostics.md holds between its `codes` marks.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "base/explain.h"

int main(void)
{
    TextBuffer reference;
    text_init(&reference);
    explain_write_reference(&reference);
    bool failed = reference.failed || fputs(text_get(&reference), stdout) == EOF;
    text_fini(&reference);
    return failed || fflush(stdout) != 0 ? 1 : 0;
}
