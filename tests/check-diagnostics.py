#!/usr/bin/env python3
"""Every code of src/base/diag_codes.def is reported somewhere, tested somewhere, and told truly in docs/diagnostics.md.

A row of the document must have the severity, the exit code and the meaning of the table in C; an example that is a
scene is given to the program RTLANG, which must report that code and end with that exit code. Prints TAP.
SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

TOP = os.environ.get("top_srcdir", ".")
EXITS = {"CLASS_NONE": 0, "CLASS_SCENE": 1, "CLASS_USAGE": 2, "CLASS_IO": 3, "CLASS_LIMIT": 4}
SEVERITIES = {"DIAG_ERROR": "error", "DIAG_WARNING": "warning"}
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


def documented():
    """code -> (severity, exit code, meaning, example), from the tables of the document."""
    rows = {}
    for line in read(f"{TOP}/docs/diagnostics.md").splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if re.match(r"[EW]\d{4}$", cells[0] if cells else ""):
            code, severity, exit_code, meaning, example, advice = cells
            rows[code] = (severity, int(exit_code), meaning, example) if advice else None
    return rows


def scene_of(example):
    """The scene in an example; None when it is told in words or is a command line."""
    found = re.fullmatch(r"`([^`]*)`", example)
    return found.group(1) if found and not found.group(1).startswith("-") else None


def example_fails(code, row, program):
    """What the program did otherwise than the row says; empty when it does as told."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "t.scn"), "w", encoding="utf-8") as file:
            file.write(scene_of(row[3]) + "\n")
        done = subprocess.run([program, "-q", "--check", "t.scn"], cwd=folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=60, check=False)
    said = done.stderr.decode("utf-8", "replace")
    first = re.search(r"error\[(\w+)\]|$", said).group(1) or code
    if f"{row[0]}[{code}]" in said and done.returncode == row[1] and first == code:
        return ""
    return f"exit code {done.returncode}\n{said}"


def cases():
    """Yields (name, what is wrong or nothing)."""
    table, rows = codes(), documented()
    reporters, tests = text_of(REPORTERS), text_of(TESTS)
    yield "the table in C can be read", "" if len(table) > 50 else f"{len(table)} codes"
    yield "no code is documented that is not there", " ".join(sorted(set(rows) - set(table)))
    program = os.path.abspath(os.environ["RTLANG"]) if os.environ.get("RTLANG") else None
    for code, expected in table.items():
        row = rows.get(code)
        reported = f"DIAG_{code}" in reporters or f"[{code}]" in reporters
        yield f"{code} is reported somewhere", "" if reported else "never"
        yield f"{code} stands in a test", "" if code in tests else "in none"
        yield f"{code} is documented", "" if row and row[:3] == expected else f"{row and row[:3]} for {expected}"
        if row and program and scene_of(row[3]) is not None:
            yield f"{code}: {scene_of(row[3])}", example_fails(code, row, program)


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
