// The clock of a study, its notes, and its bar.
//
// SPDX-License-Identifier: MIT
#include "check/study_budget.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/clock.h"

void budget_begin(StudyBudget *budget, double seconds, bool shows_progress)
{
    *budget = (StudyBudget){.seconds = seconds, .begin = clock_seconds()};
    budget->stage_end = seconds > 0.0 ? budget->begin + seconds : (double)INFINITY;
    progress_begin(&budget->progress, shows_progress);
}

void budget_end(StudyBudget *budget)
{
    progress_end(&budget->progress);
}

bool budget_is_limited(const StudyBudget *budget)
{
    return budget->seconds > 0.0;
}

void budget_stage(StudyBudget *budget, double share)
{
    double now = clock_seconds();

    if (budget_is_limited(budget)) {
        budget->stage_end = now + share * fmax(budget->begin + budget->seconds - now, 0.0);
    } else {
        budget->progress.start = now; // the time left is the stage's
    }
}

double budget_left(const StudyBudget *budget)
{
    return budget->stage_end - clock_seconds();
}

void budget_leave_out(StudyBudget *budget, const char *format, ...)
{
    va_list arguments;

    if (budget->left_out_count < BUDGET_NOTES) {
        va_start(arguments, format);
        vsnprintf(budget->left_out[budget->left_out_count++], BUDGET_TEXT, format, arguments);
        va_end(arguments);
    }
}

void budget_say(StudyBudget *budget, const char *scene, const char *what, int done, int all)
{
    snprintf(budget->note, sizeof budget->note, "%s: %s, %d of %d", scene, what, done, all);
    budget->done = (double)done / all;
    budget_tick(budget);
}

void budget_tick(StudyBudget *budget)
{
    double past = clock_seconds() - budget->begin;

    if (budget_is_limited(budget)) {
        progress_update(&budget->progress, fmin(past / budget->seconds, 1.0), fmax(budget->seconds - past, 0.0),
                        budget->note);
    } else {
        progress_update(&budget->progress, budget->done, -1.0, budget->note);
    }
}
