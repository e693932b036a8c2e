// The report as one HTML page that needs nothing but itself: no file beside it, no network.
//
// A page is a row of sections, each opened by whoever has something to show and written to the stream that comes back:
//
//     FILE *out = report_page_section(page, "stability", "Numerical stability");
//     fprintf(out, "<table class=\"sortable\">…</table>");
//
// Style and behaviour come with the page (src/check/report_page.html): the list of sections at the top is made from the
// sections; a `table.sortable` is sorted by its headings, cells being compared by their `data-sort` or else by their
// text, numbers as numbers; cells of class `number` are aligned and `good` or `bad` are coloured; `svg.plot` takes the
// colours of the page; a `figure` holds a picture and its caption.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_REPORT_HTML_H
#define CHECK_REPORT_HTML_H

#include <stdbool.h>
#include <stdio.h>

#include "image/image.h"

typedef struct ReportPage ReportPage;

// Begins the page that is to become the file `path`. NULL when it cannot be written; errno says why.
ReportPage *report_page_open(const char *path);

// Ends the section before and begins one; `id` is its anchor, both are plain text.
FILE *report_page_section(ReportPage *page, const char *id, const char *title);

// Ends the page and puts it in its place, whole or not at all. Releases everything. False when something could not be
// written; errno says why.
bool report_page_close(ReportPage *page);

// A table that can be sorted, and in front of it what its columns mean, one below the other. `name` says what it holds.
typedef struct ReportColumn {
    const char *heading, *meaning; // plain text
} ReportColumn;
void report_table_open(FILE *out, const char *name, const ReportColumn *columns, size_t count);

// The same without the meanings: up to the cells of its heading, which the caller writes before report_table_rows.
void report_table_heading(FILE *out, const char *name);
void report_table_rows(FILE *out);
void report_table_close(FILE *out);

// Text as HTML, also within a quoted attribute.
void html_text(FILE *out, const char *text);

// The address of a picture that holds the picture itself, as PNG: what belongs into src="". False when it could not be
// made.
bool html_picture(FILE *out, const Image *image, const ImageEncoding *encoding);

#endif
