// Versions, command and machine, asked of the system.
//
// SPDX-License-Identifier: MIT
#include "check/report_about.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include "peer/povray_run.h"
#include "rtlang/rtlang.h"

enum { ABOUT_TEXT = 256 };

static void term(FILE *out, const char *name, const char *text)
{
    fprintf(out, "<dt>%s</dt><dd>", name);
    html_text(out, text);
    fputs("</dd>\n", out);
}

void report_word(FILE *out, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_=+./,:@%";

    if (*word != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (const char *c = word; *c != '\0'; c++) {
        if (*c == '\'') {
            fputs("'\\''", out);
        } else {
            html_text(out, (char[]){*c, '\0'});
        }
    }
    fputc('\'', out);
}

// "model name : …" of Linux; other processors have no such line, and what uname says is all.
static void processor_find(char text[static ABOUT_TEXT])
{
    FILE *file = fopen("/proc/cpuinfo", "r");
    char line[ABOUT_TEXT];
    struct utsname system;

    *text = '\0';
    if (uname(&system) == 0) {
        snprintf(text, ABOUT_TEXT, "%.60s processor", system.machine);
    }
    while (file && fgets(line, sizeof line, file)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && colon) {
            snprintf(text, ABOUT_TEXT, "%s", colon + 1 + strspn(colon + 1, " "));
            text[strcspn(text, "\n")] = '\0';
            break;
        }
    }
    if (file) {
        fclose(file);
    }
}

static void machine_print(FILE *out)
{
    char processor[ABOUT_TEXT], text[2 * ABOUT_TEXT];
    struct utsname system;
    long count = sysconf(_SC_NPROCESSORS_ONLN);

    processor_find(processor);
    snprintf(text, sizeof text, "%s, %ld processor%s", processor, count, count == 1 ? "" : "s");
    term(out, "Machine", text);
    if (uname(&system) == 0) {
        snprintf(text, sizeof text, "%.60s %.60s %.60s", system.sysname, system.release, system.machine);
        term(out, "System", text);
    }
}

void report_about(ReportPage *page, const Options *options, const char *povray, const char *folder)
{
    FILE *out = report_page_section(page, "about", "About this run");
    char text[ABOUT_TEXT], log[PATH_MAX + 16];
    time_t now = time(NULL);
    struct tm utc;

    fputs("<dl>\n", out);
    term(out, "rtlang", rt_version());
    snprintf(log, sizeof log, "%s/version.log", folder);
    if (!povray) {
        snprintf(text, sizeof text, "not found");
    } else if (!povray_version(povray, log, text, sizeof text)) {
        snprintf(text, sizeof text, "of an unknown version");
    }
    term(out, "POV-Ray", text);
    fputs("<dt>Command</dt><dd><code>", out);
    for (int i = 0; i < options->word_count; i++) {
        fputs(i > 0 ? " " : "", out);
        report_word(out, options->words[i]);
    }
    fputs("</code></dd>\n", out);
    machine_print(out);
    if (gmtime_r(&now, &utc) && strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc) > 0) {
        term(out, "Date", text);
    }
    fputs("</dl>\n", out);
}
