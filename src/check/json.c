// SPDX-License-Identifier: MIT
#include "check/json.h"

#include <math.h>
#include <string.h>

#include "base/json.h"

void json_print_text(FILE *out, const char *text)
{
    json_write_text(out, text, strlen(text));
}

void json_print_number(FILE *out, const char *name, double value)
{
    if (isfinite(value)) {
        fprintf(out, ", \"%s\": %.9g", name, value);
    } else {
        fprintf(out, ", \"%s\": null", name);
    }
}
