#!/usr/bin/env python3
"""Every code of src/base/diag_codes.def is reported somewhere, tested somewhere, and explained truly.

Each code has an entry in src/base/diag_texts.def, from which `--explain` and docs/diagnostics.md are made (check-docs.py holds
the two together). RTLANG must report the code for the wrong scene, with the exit code of the table, and nothing at all of that
kind for the right one. Prints TAP. SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
EXITS = {"CLASS_NONE": 0, "CLASS_SCENE": 1, "CLASS_USAGE": 2, "CLASS_IO": 3, "CLASS_LIMIT": 4}
SEVERITIES = {"DIAG_ERROR": "error", "DIAG_WARNING": "warning", "DIAG_EXTRA": "warning"}
REPORTERS = ("src/**/*.c", "src/**/*.h", "grammar/*.[chly]")
TESTS = ("tests/lang/*.test", "tests/system/expected/*", "tests/system/*.py", "tests/system/*.sh", "tests/unit/*.c")


def read(path):
    with open(path, encoding="utf-8", errors="replace") as file:
        return file.read()


def text_of(patterns):
    paths = [path for pattern in patterns for path in sorted(glob.glob(f"{TOP}/{pattern}", recursive=True))]
    return "\n".join(read(path) for path in paths if os.path.isfile(path))


def codes():
    """code -> (severity, exit code, meaning), from the table in C."""
    table = read(f"{TOP}/src/base/diag_codes.def")
    rows = re.findall(r'^DIAG\((\w+), (\w+), (\w+), "([^"]*)"\)', table, re.M)
    return {code: (SEVERITIES[severity], EXITS[kind], meaning) for code, severity, kind, meaning in rows}


def texts():
    """code -> number of strings in its entry: 3 with scenes, 2 without."""
    entries = re.findall(r"^(TEXT|SITUATION)\((\w+),", read(f"{TOP}/src/base/diag_texts.def"), re.M)
    return {code: kind for kind, code in entries}


def explained(code, program):
    """What --explain prints: (first line, wrong scene, right scene, the paragraph)."""
    done = subprocess.run([program, "--explain", code], stdout=subprocess.PIPE, check=True, text=True, encoding="utf-8")
    scenes = re.search(r"    wrong: (.*)\n    right: (.*)\n", done.stdout)
    first, rest = done.stdout.split("\n", 1)
    wrong, right = scenes.groups() if scenes else (None, None)
    return first, wrong, right, rest.strip().split("\n\n")[-1]


def run(scene, program, *options):
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "t.scn"), "w", encoding="utf-8") as file:
            file.write(scene + "\n")
        done = subprocess.run([program, "-q", "-I", f"{os.path.abspath(TOP)}/share/rtlang", *options, "--check", "t.scn"], cwd=folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)
    return done.returncode, done.stderr.decode("utf-8", "replace")


def wrong_fails(code, row, scene, program):
    """What the program did otherwise than told; empty when it does as told."""
    status, said = run(scene, program, f"-W{code}") if code[0] == "W" else run(scene, program)
    first = re.search(r"error\[(\w+)\]|$", said).group(1) or code
    if f"{row[0]}[{code}]" in said and status == row[1] and first == code:
        return ""
    return f"exit code {status}\n{said}"


def right_fails(code, scene, program):
    status, said = run(scene, program, "-Wall")
    return f"exit code {status}\n{said}" if status or f"[{code}]" in said else ""


def cases():
    """Yields (name, what is wrong or nothing)."""
    table, entries = codes(), texts()
    reporters, tests = text_of(REPORTERS), text_of(TESTS)
    program = os.path.abspath(os.environ["RTLANG"])
    yield "the table in C can be read", "" if len(table) > 50 else f"{len(table)} codes"
    yield "no code is explained that is not there", " ".join(sorted(set(entries) - set(table)))
    for code, row in table.items():
        reported = f"DIAG_{code}" in reporters or f'"{code}"' in reporters
        yield f"{code} is reported somewhere", "" if reported else "never"
        yield f"{code} stands in a test", "" if code in tests else "in none"
        if code not in entries:
            yield f"{code} is explained", "add it to src/base/diag_texts.def and run `make update-docs`"
            continue
        first, wrong, right, paragraph = explained(code, program)
        head = f"{code}: {row[2]} ({row[0]}, exit code {row[1]}"
        yield f"{code} is explained", "" if first.startswith(head) and len(paragraph) > 40 else f"{first}\n{paragraph}"
        if entries[code] == "TEXT":
            yield f"{code} wrong: {wrong}", wrong_fails(code, row, wrong, program)
            yield f"{code} right: {right}", right_fails(code, right, program)


def main():
    number = failed = 0
    for name, wrong in cases():
        number += 1
        failed += bool(wrong)
        told = name.replace("#", "\\#")  # a bare one would begin a TAP directive
        print(f"{'not ok' if wrong else 'ok'} {number} - {told}")
        print("".join(f"# {line}\n" for line in wrong.splitlines()), end="", flush=True)
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
