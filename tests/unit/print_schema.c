// Prints the schema's tables as Markdown: what docs/language.md holds between its `schema` marks.
//
// SPDX-License-Identifier: MIT
#include <stdio.h>

#include "scene/schema.h"

int main(void)
{
    TextBuffer reference;
    text_init(&reference);
    schema_write_reference(&reference);
    bool failed = reference.failed || fputs(text_get(&reference), stdout) == EOF;
    text_fini(&reference);
    return failed || fflush(stdout) != 0 ? 1 : 0;
}
