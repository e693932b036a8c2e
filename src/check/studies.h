// All studies of a run: prints each, and writes the report's page, its tables and plots.
//
// SPDX-License-Identifier: MIT
#ifndef CHECK_STUDIES_H
#define CHECK_STUDIES_H

#include "check/options.h"
#include "check/study.h"

typedef enum StudiesResult {
    STUDIES_FINE,
    STUDIES_FAILED,    // of a scene there is no study; it was said why
    STUDIES_UNWRITTEN, // errno says why
} StudiesResult;

StudiesResult studies_run(const Options *options, const StudySettings *settings);

#endif
