#!/usr/bin/env python3
"""Gives every tests/povray/lang/*.scn to rtlang and to POV-Ray and compares what they print with #debug, line by line.

A line that begins with `== ` names the group of the lines after it; each group is one test.
Usage: check_debug.py [FILE.scn...]   Prints TAP; skips where there is no POV-Ray. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import glob
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402

LINES_LEAST = 600  # what the whole folder must print at least


def run(arguments, folder, seconds=120):
    done = pictures.call(arguments, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=seconds)
    return done.returncode, done.stderr.decode("latin-1")


def of_povray(name, folder, seconds=120):
    """(lines of #debug, what went wrong or None)."""
    stream = name + ".txt"  # must stand in the current folder
    status, text = run([pictures.povray(), "+I" + name, "-D", "+W4", "+H4", "-F", "+GD" + stream], folder,
                       seconds)
    path = os.path.join(folder, stream)
    lines = open(path, encoding="latin-1", newline="").read().split("\n") if os.path.exists(path) else []
    error = re.search(r"^File .*(?:Parse Error|Fatal)(?:.|\n .*\n)*", text, re.MULTILINE)
    return lines, None if status == 0 else f"POV-Ray ended with {status}: {error.group(0) if error else text[-400:]}"


def of_rtlang(name, folder):
    # POV-Ray's stream holds what #render and #statistics say, too.
    status, text = run([os.environ["RTLANG"], "--check", "-q", "--diagnostics=json", "-W4", "-H4", name], folder)
    records = [json.loads(line) for line in text.splitlines()]
    lines = [record["text"] for record in records if record["type"] == "message"]
    faults = [f"line {record['line']}: {record['code']} {record['message']}" for record in records if record.get("severity") == "error"]
    return lines + [""], None if status == 0 else f"rtlang ended with {status}: " + "; ".join(faults[:3])


def groups(lines):
    """[(name, lines)], the name in front of each being the first of its lines."""
    found = [("", [])]
    for line in lines:
        if line.startswith("== "):
            found.append((line[3:], []))
        found[-1][1].append(line)
    return found if found[0][1] else found[1:]


def compare(path):
    """[(name, how many lines, what differs)] of one file."""
    name = os.path.basename(path)
    with tempfile.TemporaryDirectory() as top:
        folder = os.path.join(top, "lang")
        shutil.copytree(os.path.dirname(os.path.abspath(path)), folder)
        (theirs, wrong), (ours, wrong_too) = of_povray(name, folder), of_rtlang(name, folder)
    results = [(name, 0, [words]) for words in (wrong, wrong_too) if words]
    for theirs_group, ours_group in itertools.zip_longest(groups(theirs), groups(ours), fillvalue=("", [])):
        pairs = list(itertools.zip_longest(theirs_group[1], ours_group[1]))
        differs = [f"POV-Ray: {their!r}   rtlang: {our!r}" for their, our in pairs if their != our]
        results.append((f"{name}: {theirs_group[0] or ours_group[0]}", len(theirs_group[1]), differs))
    return results


def main():
    if not pictures.povray():
        print("1..0 # SKIP povray is not installed")
        return 0
    whole = sorted(glob.glob(os.path.join(os.environ.get("top_srcdir", "."), "tests/povray/lang/*.scn")))
    paths = sys.argv[1:] or whole
    number = failed = lines = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for results in pool.map(compare, paths):
            for name, count, differs in results:
                number += 1
                lines += count
                failed += bool(differs)
                # A bare `#` would begin a directive of TAP.
                title = f"{name} ({count} lines)".replace("#", "\\#")
                print(f"{'not ok' if differs else 'ok'} {number} - {title}", flush=True)
                for line in differs[:20]:
                    print("#   " + line)
    if paths == whole:
        number += 1
        failed += lines < LINES_LEAST
        print(f"{'ok' if lines >= LINES_LEAST else 'not ok'} {number} - {lines} lines in all, at least {LINES_LEAST}")
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
