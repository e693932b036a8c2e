#!/usr/bin/env python3
# The measurements of docs/sampling.md that take too long for a test: how often the intervals hold (test_intervals long),
# how much longer than needed runs to a goal are, and what strata at edges bring (measure goals, measure edges).
#
#     bench/sampling.py [--update] [--runs=N] [FILE…]
#
# With --update what is found goes into the document. With files: what these programs wrote before is taken in place of
# running them. Wants TEST_INTERVALS and MEASURE, the programs.
#
# SPDX-License-Identifier: MIT
import os
import subprocess
import sys

DOCUMENT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "sampling.md")
HEADS = {"intervals": ["| | 4 | 16 | 64 | 256 | 4 a | 16 a | 64 a | 256 a | goal | near goal |", "|---" * 11 + "|"],
         "edges": ["| | without | with | time | time to equal error |", "|---" * 5 + "|"], "goals": []}


def programs(runs):
    intervals, measure = os.environ["TEST_INTERVALS"], os.environ["MEASURE"]
    return [[intervals, "long", runs], [measure, "goals"], [measure, "edges"]]


def lines_of(command):
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as run:
        for line in run.stdout:
            print(line, end="", flush=True)
            yield line.rstrip("\n")


def sort(lines):
    """What belongs into which place: rows by the number of their cells."""
    found = {name: [] for name in HEADS}
    for line in lines:
        cells = line.split(" | ")
        if line.startswith("median "):
            found["goals"].append(line)
        elif line.startswith("| ") and not line.startswith(("| |", "| all,")):
            if line.endswith("|") and len(cells) in (5, 11):
                found["edges" if len(cells) == 5 else "intervals"].append(line)
    return found


def update(found):
    with open(DOCUMENT, encoding="utf-8") as file:
        text = file.read()
    for name, rows in found.items():
        if rows:
            before, rest = text.split(f"<!-- {name} -->\n", 1)
            after = rest.split(f"<!-- /{name} -->", 1)[1]
            text = f"{before}<!-- {name} -->\n" + "\n".join(HEADS[name] + rows) + f"\n<!-- /{name} -->{after}"
    with open(DOCUMENT, "w", encoding="utf-8") as file:
        file.write(text)


def main():
    words = sys.argv[1:]
    files = [word for word in words if not word.startswith("-")]
    runs = next((word[len("--runs="):] for word in words if word.startswith("--runs=")), "100")
    lines = []
    for path in files:
        with open(path, encoding="utf-8") as file:
            lines += file.read().splitlines()
    for command in [] if files else programs(runs):
        lines += lines_of(command)
    found = sort(lines)
    if "--update" in words:
        update(found)


if __name__ == "__main__":
    main()
