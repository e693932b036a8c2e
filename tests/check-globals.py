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
# The picture writer may name standard output, because `-` means it; sanitizers bring data of their own.
ALLOWED = {("image", "stdout")}


def symbols(archive):
    run = subprocess.run(["nm", "-A", "--format=posix", archive], capture_output=True, text=True, check=True)
    for line in run.stdout.splitlines():
        match = re.match(r"\S*?\[?([\w.-]+\.o)\]?:\s+(\S+)\s+(\S)", line)
        if match:
            yield match.groups()


def main():
    archives = [a for a in sorted(glob.glob(".libs/lib*.a")) if os.path.basename(a) != "libapi.a"]
    if not archives:
        print("1..0 # SKIP no archives of the library here")
        return 0
    mutable, printing = [], []
    for archive in archives:
        module = re.match(r"lib(\w+)\.a", os.path.basename(archive)).group(1)
        for member, name, kind in symbols(archive):
            generated = module == "grammar" and name.startswith("yy")
            if kind in "bBdDC" and not generated and not re.search(r"asan|ubsan|tsan|\.str|Lubsan|Lasan", name):
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
