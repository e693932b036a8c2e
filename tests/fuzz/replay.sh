#!/bin/sh
# Replays every example and every cross-check scene through the fuzz target, changed and cut in a fixed way. Prints TAP.
# SPDX-License-Identifier: MIT
exec ./tests/fuzz/fuzz_scene "$top_srcdir"/examples/*.scn "$top_srcdir"/tests/povray/*.scn \
    "$top_srcdir"/tests/fuzz/*.scn
