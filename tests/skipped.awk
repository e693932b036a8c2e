# What a run of the tests left out, by cause, out of its test-suite.log.
#
# A line of it is `SKIP: PROGRAM NUMBER - CASE # SKIP CAUSE`, or `SKIP: PROGRAM - CAUSE` of a whole program.
# SPDX-License-Identifier: MIT
/^SKIP: / && NF > 2 { # not the heading of a log
    program = $2
    cause = $0
    if (sub(/^.* # SKIP */, "", cause)) {
        name = $0
        sub(/^SKIP: [^ ]+ [0-9]+ -? */, "", name)
        sub(/ *# SKIP.*/, "", name)
        name = program ": " name
    } else {
        sub(/^SKIP: [^ ]+ -? */, "", cause)
        name = program
    }
    if (!(cause in cases)) {
        order[++causes] = cause
    }
    cases[cause]++
    names[cause] = names[cause] "\n    " name
    count++
}
END {
    if (count > 0) {
        print "skipped: " count
    }
    for (i = 1; i <= causes; i++) {
        print cases[order[i]] " for: " order[i] names[order[i]]
    }
}
