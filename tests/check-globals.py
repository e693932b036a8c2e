#!/usr/bin/env python3
"""Checks the built objects of the library: no data that changes at file scope, nothing that prints or exits.

Reads `nm` of the convenience archives. Prints TAP, one line a rule.
SPDX-License-Identifier: MIT
"""
import glob
import os
import re
import subprocess
import sys

# Calls that a library must leave to its client.
FORBIDDEN = r"^(printf|puts|putchar|vprintf|exit|_exit|abort|perror|stdout|stderr|__printf_chk)$"
# The picture writer may name standard output, because `-` means it. The generated scanner names it as the place of an
# echo that it never makes (%option nodefault). The copy of the process that reads pictures ends by itself.
ALLOWED = {("image", "stdout"), ("grammar", "stdout"), ("image", "_exit")}


def symbols(archive):
    """Member, name, class and section of each symbol."""
    run = subprocess.run(["nm", "--format=sysv", archive], capture_output=True, text=True, check=True)
    member = ""
    for line in run.stdout.splitlines():
        head = re.match(r"(?:Symbols|Undefined symbols) from .*\[(.+)\]:", line)
        member = head.group(1) if head else member
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) == 7 and cells[0] != "Name":
            yield member, cells[0], cells[2], cells[6]


def is_mutable(name, kind, section):
    """Constant tables that hold addresses lie in .data.rel.ro, which is read-only once the program runs."""
    is_sanitizer = re.search(r"asan|ubsan|tsan|Lubsan|Lasan", name)
    return kind in "bBdDC" and not section.startswith(".data.rel.ro") and not is_sanitizer


def main():
    archives = [a for a in sorted(glob.glob(".libs/lib*.a")) if os.path.basename(a) != "libapi.a"]
    if not archives:
        print("1..0 # SKIP no archives of the library here")
        return 0
    mutable, printing = [], []
    for archive in archives:
        module = re.match(r"lib(\w+)\.a", os.path.basename(archive)).group(1)
        for member, name, kind, section in symbols(archive):
            if is_mutable(name, kind, section):
                mutable.append(f"{module}: {member}: {name}")
            if kind == "U" and re.match(FORBIDDEN, name) and (module, name) not in ALLOWED:
                printing.append(f"{module}: {member}: {name}")
    print("1..2")
    for number, (what, found) in enumerate([("no mutable data at file scope", mutable),
                                            ("nothing prints or exits", printing)], 1):
        print(f"{'not ' if found else ''}ok {number} - {what}")
        for fault in sorted(set(found)):
            print("# " + fault)
    return 1 if mutable or printing else 0


if __name__ == "__main__":
    sys.exit(main())
