#!/bin/sh
# Runs every case of tests/lang through the evaluator. Prints TAP, one line a case.
# SPDX-License-Identifier: MIT
exec ./tests/lang/run_lang "$top_srcdir"/tests/lang/*.test
