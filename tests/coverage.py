#!/usr/bin/env python3
"""Adds up what gcov says of all objects in the current folder, and prints the share of lines reached for each room.

Usage: coverage.py TOP, in the folder of a build with --coverage whose tests have run. Writes the lines that were not
reached to missed.txt. Exits with 1 when a share is below the bar. SPDX-License-Identifier: MIT
"""
import collections
import json
import os
import subprocess
import sys

ROOMS = {"grammar": ("grammar/",), "ast": ("src/ast/",), "eval": ("src/eval/",), "scene": ("src/scene/",)}
MADE = ("grammar/parser.c", "grammar/lexer.c", "grammar/parser.h", "grammar/lexer_tables.h")  # by bison and flex
BAR = 95.0


def room_of(path):
    if path.startswith(MADE):
        return None
    return next((room for room, folders in ROOMS.items() if path.startswith(folders)), None)


def main():
    top = os.path.abspath(sys.argv[1])
    lines = collections.defaultdict(lambda: collections.defaultdict(int))
    # libtool puts objects into hidden folders, which glob passes over.
    objects = [os.path.join(folder, name) for room in ("grammar", "src/ast", "src/eval", "src/scene")
               for folder, _, names in os.walk(room) for name in names if name.endswith(".gcda")]
    for path in objects:
        out = subprocess.run(["gcov", "--json-format", "--stdout", path], capture_output=True, check=True).stdout
        for text in out.decode().splitlines():
            for file in json.loads(text)["files"]:
                name = os.path.relpath(os.path.join(os.getcwd(), file["file"]), top)
                name = file["file"] if name.startswith("..") else name
                if room_of(name):
                    for line in file["lines"]:
                        lines[name][line["line_number"]] += line["count"]
    fine = bool(lines)
    with open("missed.txt", "w", encoding="utf-8") as missed:
        for room in ROOMS:
            files = {name: counts for name, counts in lines.items() if room_of(name) == room}
            all_lines = sum(len(counts) for counts in files.values())
            reached = sum(count > 0 for counts in files.values() for count in counts.values())
            for name, counts in sorted(files.items()):
                none = sorted(number for number, count in counts.items() if count == 0)
                if none:
                    missed.write("%s: %s\n" % (name, " ".join(map(str, none))))
            share = 100.0 * reached / max(all_lines, 1)
            fine = fine and share >= BAR
            print("%-8s %6d of %6d lines, %5.1f %%" % (room, reached, all_lines, share))
    return 0 if fine else 1


sys.exit(main())
