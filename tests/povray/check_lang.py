#!/usr/bin/env python3
"""Gives every `-- debug` case of the language's tests to POV-Ray and compares its debug stream with the expectation.

Usage: check_lang.py FILE.test...   Prints TAP; skips where there is no POV-Ray.
"""
# SPDX-License-Identifier: MIT

import concurrent.futures
import glob
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402

# Keeps POV-Ray from warning about an empty scene; in one line, so that nothing else moves.
PREFACE = "#version 3.7; global_settings { assumed_gamma 1 } sphere { 0, 1 }\n"


def read_cases(path):
    """Yields (name, program, {file: text}, [declaration], expected debug text or None)."""
    cases, sections = [], None
    with open(path, encoding="latin-1", newline="") as file:
        for line in file:
            if line.startswith("== "):
                sections = []
                cases.append(sections)
            if sections is not None and line[:3] in ("== ", "-- "):
                sections.append([line[3:].strip(), ""])
            elif sections:
                sections[-1][1] += line
    for (name, program), *rest in cases:
        files = {header[5:]: text for header, text in rest if header.startswith("file ")}
        debug = [text for header, text in rest if header == "debug"]
        if any(header == "diagnostics" and ": error[" in text for header, text in rest):
            debug = []  # POV-Ray stops at the first fault
        declared = ["Declare=" + "=".join(header.split()[1:]) for header, _ in rest if header.startswith("declare ")]
        yield name, program, files, declared, debug[0].rstrip("\n") if debug else None


def run_povray(program, files, declared):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in dict(files, **{"test.pov": PREFACE + program}).items():
            path = os.path.join(folder, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="latin-1", newline="") as file:
                file.write(text)
        result = pictures.call(
            [pictures.povray(), "+Itest.pov", "+Llib", "-D", "+W320", "+H240", "+SR1", "+ER1", "+SC1", "+EC1", "-F",
             "+GDdebug.txt"] + declared,
            cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=120)
        try:
            with open(os.path.join(folder, "debug.txt"), encoding="latin-1", newline="") as file:
                debug = file.read()
        except FileNotFoundError:
            debug = ""
        return debug, result.returncode, result.stderr.decode("latin-1")


def comment(title, text):
    print("# " + title + ":")
    for line in text.splitlines():
        print("#   " + line)


def main():
    if pictures.povray() is None:
        print("1..0 # SKIP povray is not installed")
        return 0
    number = failed = 0
    top = os.environ.get("top_srcdir", ".")
    cases = [(path, *case) for path in sys.argv[1:] or sorted(glob.glob(f"{top}/tests/lang/*.test"))
             for case in read_cases(path) if case[-1] is not None]
    with concurrent.futures.ThreadPoolExecutor(pictures.POVRAY_AT_ONCE) as pool:
        answers = pool.map(lambda case: run_povray(*case[2:5]), cases)
        for (path, name, _, _, _, expected), (got, code, errors) in zip(cases, answers):
            number += 1
            fine = code == 0 and got.rstrip("\n") == expected
            print(f"{'ok' if fine else 'not ok'} {number} - {os.path.basename(path)}: {name}", flush=True)
            if not fine:
                failed += 1
                comment("expected", expected)
                comment("POV-Ray", got)
                if code:
                    comment("its messages", errors[-700:])
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
