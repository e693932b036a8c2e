// What a page says of the run that made it: versions, command, machine, date.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_ABOUT_H
#define CHECK_REPORT_ABOUT_H

#include "check/options.h"
#include "check/report_html.h"

// The section. `povray`: its program, NULL where there is none; `folder` is one for a temporary file.
void report_about(ReportPage *page, const Options *options, const char *povray, const char *folder);

// The command as a shell reads it, as HTML text: words that are not plain stand in single quotes.
void report_word(FILE *out, const char *word);

#endif
