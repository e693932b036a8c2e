#!/usr/bin/env python3
"""Checks that each header compiles alone, and the public one as C99 and C++ too. Prints TAP, one line a header.

SPDX-License-Identifier: MIT
"""
import glob
import os
import shlex
import subprocess
import sys

TOP = os.environ.get("top_srcdir", ".")
COMPILER = shlex.split(os.environ.get("CC", "cc"))
INCLUDES = ["-I" + os.path.join(TOP, folder) for folder in ("src", ".", "include")]
WARNINGS = ["-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-fsyntax-only"]


def compiles(header, language):
    text = f'#include "{header}"\n'
    command = COMPILER + language + INCLUDES + WARNINGS + ["-D_GNU_SOURCE", "-"]
    run = subprocess.run(command, input=text, capture_output=True, text=True)
    return run.returncode == 0, run.stderr


def main():
    headers = sorted(glob.glob(TOP + "/src/**/*.h", recursive=True) + glob.glob(TOP + "/grammar/grammar.h"))
    gnu17 = ["-std=gnu17", "-x", "c"]
    public = sorted(glob.glob(TOP + "/include/rtlang/*.h"))
    cases = [(header, gnu17) for header in headers]
    cases += [(header, language) for header in public for language in (["-std=c99", "-pedantic", "-x", "c"], ["-x", "c++"])]
    failed = 0
    print(f"1..{len(cases)}")
    for number, (header, language) in enumerate(cases, 1):
        fine, message = compiles(header, language)
        failed += not fine
        print(f"{'' if fine else 'not '}ok {number} - {os.path.relpath(header, TOP)} {language[-1]}")
        for line in [] if fine else message.splitlines()[:10]:
            print("# " + line)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
