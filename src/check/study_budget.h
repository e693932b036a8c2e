// What a study may take of the clock, what it leaves out because of that, and how far it has come.
//
// Each stage gets a share of what is left, and a run begins only if it is expected to end within its stage: what one
// stage does not take the next ones have. Without a limit everything is run.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STUDY_BUDGET_H
#define CHECK_STUDY_BUDGET_H

#include <stdbool.h>

#include "cli/progress.h"

enum { BUDGET_TEXT = 256, BUDGET_NOTES = 32 };

typedef struct StudyBudget {
    double seconds;          // of a scene; 0: no limit
    double begin, stage_end; // by the clock
    char left_out[BUDGET_NOTES][BUDGET_TEXT]; // sentences without their full stop
    int left_out_count;
    Progress progress;
    char note[BUDGET_TEXT]; // what is being done
    double done;            // of it, from 0 to 1
} StudyBudget;

// A scene's study begins. `shows_progress`: a bar on standard error, if that is a terminal.
void budget_begin(StudyBudget *budget, double seconds, bool shows_progress);

// Ends the bar. What was left out stays.
void budget_end(StudyBudget *budget);

bool budget_is_limited(const StudyBudget *budget);

// The next runs are to end within so much of what is left, 0 to 1.
void budget_stage(StudyBudget *budget, double share);

// What is left of the stage, seconds; infinite without a limit.
double budget_left(const StudyBudget *budget);

// Keeps a sentence about something that is not run.
void budget_leave_out(StudyBudget *budget, const char *format, ...) __attribute__((format(printf, 2, 3)));

// Says what is being done. Together with budget_tick, by one thread only.
void budget_say(StudyBudget *budget, const char *scene, const char *what, int done, int all);

// Draws the bar again, in the middle of what was said.
void budget_tick(StudyBudget *budget);

#endif
