#!/usr/bin/env python3
"""A build with --disable-study: it compiles, draws the same picture, refuses what is for study, and has no code for it.

Configures and builds in a folder of its own, without optimization; for `make check-long`, and alone:
`make check TESTS=...` runs nothing else of it. Wants CC, RTLANG (the usual build's) and top_srcdir. Prints TAP.

SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap

TOP = os.path.abspath(os.environ.get("top_srcdir", "."))
SCENE = f"{TOP}/examples/01_one_sphere.scn"
# Arithmetic of float128 in gcc's and clang's libraries, and the names that a kernel of the study has.
STUDY_CODE = re.compile(r"\b(__\w+tf[23]?|__trunctfdf2|__extenddftf2|\w*quad\w*|study_(?:film|covers|name|colour\w*)|oracle_\w+)\b")


def run(*command, cwd=None):
    done = subprocess.run(command, cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, check=False,
                          timeout=3000)
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def study_code(program):
    code, out, _ = run("nm", program)
    return sorted(set(STUDY_CODE.findall(out))) if code == 0 else ["nm failed"]


def build(tap, folder):
    """True when both programs are there."""
    if not os.path.exists(f"{TOP}/configure"):
        tap.skip("a build with --disable-study", "the source tree has no configure")
        return False
    steps = ([f"{TOP}/configure", "--disable-study", "--disable-shared", "--disable-dependency-tracking", "CFLAGS=-O0",
              f"CC={os.environ.get('CC', 'cc')}"], ["make", "-j2", "rtlang", "rtcheck"])
    for step in steps:
        code, out, err = run(*step, cwd=folder)
        if code != 0:
            return tap.ok(False, "it compiles", (out + err)[-2000:])
    return tap.ok(True, "it compiles")


def check_programs(tap, folder):
    rtlang, rtcheck = f"{folder}/rtlang", f"{folder}/rtcheck"
    pictures = []
    for program in (os.environ["RTLANG"], rtlang):
        name = f"{folder}/picture{len(pictures)}.png"
        code, _, err = run(program, "-W32", "-H24", "-o", name, SCENE)
        pictures.append(open(name, "rb").read() if code == 0 else err)
    tap.ok(isinstance(pictures[1], bytes) and pictures[0] == pictures[1], "it draws the same picture, bit for bit", pictures[1][:300])
    for what in "float", "quad", "reference":
        code, _, err = run(rtlang, f"--precision={what}", "-W8", "-H6", "-o", f"{folder}/none.png", SCENE)
        tap.ok(code == 2 and "--precision" in err and "--disable-study" in err and not os.path.exists(f"{folder}/none.png"),
               f"--precision={what} is refused, and why is said", (code, err))
    code, _, err = run(rtlang, "--precision=double", "-W8", "-H6", "-o", f"{folder}/double.png", SCENE)
    tap.ok(code == 0, "--precision=double is what it has", err)
    code, _, err = run(rtcheck, "--stability")
    tap.ok(code == 2 and "--disable-study" in err, "rtcheck --stability is refused, and why is said", (code, err))
    for program in rtlang, rtcheck:
        found = study_code(program)
        tap.ok(not found, f"{os.path.basename(program)} has no code of float128 and no study kernel", found[:10])
    usual = study_code(os.environ["RTLANG"])
    tap.ok("study_covers" in usual and any(name.endswith("tf3") for name in usual), "which the usual build has", usual[:10])


def main():
    tap = Tap()
    if not os.environ.get("CHECK_LONG"):
        tap.skip("a build with --disable-study", "it takes minutes: make check-long")
        return tap.done()
    with tempfile.TemporaryDirectory() as folder:
        if build(tap, folder):
            check_programs(tap, folder)
    return tap.done()


if __name__ == "__main__":
    sys.exit(main())
