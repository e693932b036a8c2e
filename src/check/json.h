// Values of JSON, for all that rtcheck prints.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_JSON_H
#define CHECK_JSON_H

#include <stdio.h>

// A string in quotes.
void json_print_text(FILE *out, const char *text);

// `, "name": value`, a member that is not the first of its object. JSON has no infinity: null stands for it.
void json_print_number(FILE *out, const char *name, double value);

#endif
