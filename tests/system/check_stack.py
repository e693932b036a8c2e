#!/usr/bin/env python3
"""A stack of 256 kB is enough: every example is drawn with the same bytes, what nests deep is drawn, too, and what nests
too deep ends in a located message.

Clients' threads of 128 kB are tested by tests/unit/test_stack.c; that no function takes more than 16 kB is a warning
of the build. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import resource
import subprocess
import tempfile

from tap import Tap

PROGRAM = os.path.abspath(os.environ["RTLANG"])
EXAMPLES = os.path.join(os.environ["top_srcdir"], "examples")
SMALL = 256 * 1024
HEAD = "camera { location -5*z }\n"
OPTIONS = ((), ("--samples=2",), ("--antialias=2",), ("--alpha",), ("--check",), ("--dump=scene",))


def small_stack():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_STACK, (SMALL, SMALL))


def run(folder, arguments, is_small):
    done = subprocess.run([PROGRAM, "-q", *arguments], cwd=folder, capture_output=True,
                          preexec_fn=small_stack if is_small else None, check=False)
    return done.returncode, done.stdout, done.stderr.decode("utf-8", "replace")


def check_examples(tap):
    for path in sorted(glob.glob(os.path.join(EXAMPLES, "*.scn"))):
        for options in OPTIONS:
            arguments = ["-W", "96", "-H", "72", *options, path]
            if not any(option in ("--check", "--dump=scene") for option in options):
                arguments += ["-o", "-"]
            usual, small = (run(EXAMPLES, arguments, is_small) for is_small in (False, True))
            tap.ok(small == usual and small[0] == 0, " ".join([os.path.basename(path), *options]), (small[0], small[2]))


def check_deep(tap):
    """Depths that the limits allow, drawn with little stack, and with all there usually is."""
    ball = "sphere { 0, 1 pigment { rgb 1 } }"
    other = "sphere { 9, 1 }"
    with tempfile.TemporaryDirectory() as folder:
        for kind in "union", "merge", "difference", "intersection":
            inner = ball if kind == "intersection" else other
            text = ("%s { " % kind) * 300 + ball + (" %s }" % inner) * 300
            with open(os.path.join(folder, "deep.scn"), "w", encoding="ascii") as file:
                file.write(HEAD + text)
            arguments = ["-W", "16", "-H", "12", "-o", "-", "deep.scn"]
            usual, small = (run(folder, arguments, is_small) for is_small in (False, True))
            tap.ok(small == usual and small[0] == 0, "300 times %s" % kind, (small[0], small[2][:400]))


def check_too_deep(tap):
    cases = {
        "union { " * 5000 + "sphere { 0, 1 }" + " }" * 5000:
            "deep.scn:2:32009: error[E0601]: expressions and blocks nest deeper than 1000 levels here",
        "#declare A = " + "(1+" * 5000 + "1" + ")" * 5000 + ";":
            "deep.scn:2:12015: error[E0601]: expressions and blocks nest deeper than 1000 levels here",
        "#macro M(N) union { M(N) } #end M(1)": "deep.scn:2:21: error[E0604]: macro calls nest deeper than 98 levels",
    }
    with tempfile.TemporaryDirectory() as folder:
        for text, expected in cases.items():
            with open(os.path.join(folder, "deep.scn"), "w", encoding="ascii") as file:
                file.write(HEAD + text)
            code, _, said = run(folder, ["--check", "deep.scn"], True)
            tap.equal((code, said.split("\n")[0]), (4, expected), text[:20])


def main():
    tap = Tap()
    check_examples(tap)
    check_deep(tap)
    check_too_deep(tap)
    tap.done()


if __name__ == "__main__":
    main()
