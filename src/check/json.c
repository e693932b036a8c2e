// SPDX-License-Identifier: MIT
#include "check/json.h"

#include <math.h>
#include <string.h>

#include "base/json.h"

void json_print_text(FILE *out, const char *text)
{
    TextBuffer buffer;

    text_init(&buffer);
    json_string(&buffer, text, strlen(text));
    fputs(text_get(&buffer), out);
    text_fini(&buffer);
}

void json_print_number(FILE *out, const char *name, double value)
{
    if (isfinite(value)) {
        fprintf(out, ", \"%s\": %.9g", name, value);
    } else {
        fprintf(out, ", \"%s\": null", name);
    }
}
