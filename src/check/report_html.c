// Pages, text and pictures as HTML. The page itself is a file of its own, made a table of lines by the build.
//
// SPDX-License-Identifier: MIT
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include "check/report_html.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const template_lines[] = {
#include "check/report_page.inc"
};

enum { TEMPLATE_LINES = RT_COUNT_OF(template_lines) };

// The line of the template where the sections stand.
static const char *const sections_line = "<!-- sections -->\n";

struct ReportPage {
    FILE *out;
    char *path, *temporary;
    int line; // of the template, not yet printed
    bool in_section;
};

static void page_free(ReportPage *page)
{
    free(page->path);
    free(page->temporary);
    free(page);
}

// Prints the lines of the template that are next, up to that of the sections, which is passed over.
static void template_print(ReportPage *page)
{
    while (page->line < TEMPLATE_LINES && strcmp(template_lines[page->line], sections_line) != 0) {
        fputs(template_lines[page->line++], page->out);
    }
    page->line++;
}

ReportPage *report_page_open(const char *path)
{
    ReportPage *page = calloc(1, sizeof *page);

    if (!page) {
        return NULL;
    }
    page->path = strdup(path);
    if (asprintf(&page->temporary, "%s.part", path) < 0) {
        page->temporary = NULL;
    }
    page->out = page->path && page->temporary ? fopen(page->temporary, "wb") : NULL;
    if (!page->out) {
        page_free(page);
        return NULL;
    }
    template_print(page);
    return page;
}

static void section_end(ReportPage *page)
{
    if (page->in_section) {
        fputs("</section>\n", page->out);
    }
    page->in_section = false;
}

FILE *report_page_section(ReportPage *page, const char *id, const char *title)
{
    section_end(page);
    page->in_section = true;
    fputs("<section id=\"", page->out);
    html_text(page->out, id);
    fputs("\">\n<h2>", page->out);
    html_text(page->out, title);
    fputs("</h2>\n", page->out);
    return page->out;
}

bool report_page_close(ReportPage *page)
{
    bool fine;
    int error;

    section_end(page);
    template_print(page);
    fine = ferror(page->out) == 0;
    fine = fclose(page->out) == 0 && fine;
    fine = fine && rename(page->temporary, page->path) == 0;
    error = errno;
    if (!fine) {
        unlink(page->temporary);
    }
    page_free(page);
    errno = error;
    return fine;
}

void report_table_open(FILE *out, const char *name, const ReportColumn *columns, size_t count)
{
    fputs("<details class=\"columns\" open><summary>What the columns mean</summary><dl>\n", out);
    for (size_t i = 0; i < count; i++) {
        fputs("<dt>", out);
        html_text(out, columns[i].heading);
        fputs("</dt><dd>", out);
        html_text(out, columns[i].meaning);
        fputs("</dd>\n", out);
    }
    fputs("</dl></details>\n", out);
    report_table_heading(out, name);
    for (size_t i = 0; i < count; i++) {
        fputs("<th scope=\"col\" title=\"", out);
        html_text(out, columns[i].meaning);
        fputs("\">", out);
        html_text(out, columns[i].heading);
        fputs("</th>", out);
    }
    report_table_rows(out);
}

void report_table_heading(FILE *out, const char *name)
{
    fputs("<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"", out);
    html_text(out, name);
    fputs("\"><table class=\"sortable\"><thead><tr>", out);
}

void report_table_rows(FILE *out)
{
    fputs("</tr></thead><tbody>\n", out);
}

void report_table_close(FILE *out)
{
    fputs("</tbody></table></div>\n", out);
}

void html_text(FILE *out, const char *text)
{
    for (const char *c = text; *c != '\0'; c++) {
        switch (*c) {
        case '&': fputs("&amp;", out); break;
        case '<': fputs("&lt;", out); break;
        case '>': fputs("&gt;", out); break;
        case '"': fputs("&quot;", out); break;
        default: fputc(*c, out); break;
        }
    }
}

// RFC 4648, section 4.
static void base64_print(FILE *out, const unsigned char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

    for (size_t at = 0; at < size; at += 3) {
        size_t count = size - at < 3 ? size - at : 3;
        char text[5] = "====";
        unsigned bits = 0;

        for (size_t i = 0; i < 3; i++) {
            bits = bits << 8 | (i < count ? bytes[at + i] : 0U);
        }
        for (size_t i = 0; i <= count; i++) {
            text[i] = digits[bits >> (18 - 6 * i) & 63];
        }
        fputs(text, out);
    }
}

bool html_picture(FILE *out, const Image *image, const ImageEncoding *encoding)
{
    ImageError error = {.no_memory = false};
    unsigned char *bytes;
    size_t size;

    if (image_encode_png(image, encoding, &bytes, &size, &error) != IMAGE_OK) {
        return false;
    }
    fputs("data:image/png;base64,", out);
    base64_print(out, bytes, size);
    free(bytes);
    return ferror(out) == 0;
}
