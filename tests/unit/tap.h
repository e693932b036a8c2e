// TAP (Test Anything Protocol) for the unit tests: one line a case, a plan at the end.
//
// SPDX-License-Identifier: MIT
#ifndef UNIT_TAP_H
#define UNIT_TAP_H

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

// A test has the stack of a whole process: the bound on frames is for the library and its programs.
#pragma GCC diagnostic ignored "-Wframe-larger-than="

static int tap_run, tap_failed;

// Prints `ok N - name` or `not ok N - name` and returns the condition.
__attribute__((format(printf, 4, 5), unused)) static bool tap_report(bool condition, const char *file, int line,
                                                                    const char *format, ...)
{
    va_list arguments;
    tap_run++;
    printf("%s %d - ", condition ? "ok" : "not ok", tap_run);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    putchar('\n');
    if (!condition) {
        tap_failed++;
        printf("# failed at %s:%d\n", file, line);
    }
    fflush(stdout);
    return condition;
}

#define tap_ok(condition, ...) tap_report((condition), __FILE__, __LINE__, __VA_ARGS__)

// Says what cannot be tested here, and why.
__attribute__((unused)) static void tap_skip(const char *name, const char *reason)
{
    printf("ok %d - %s # SKIP %s\n", ++tap_run, name, reason);
}

// Prints the plan; the value to return from main.
__attribute__((unused)) static int tap_done(void)
{
    printf("1..%d\n", tap_run);
    return tap_failed == 0 ? 0 : 1;
}

#endif
