#!/usr/bin/env python3
# How much of --time-limit a run takes, and whether --adaptive --samples with the number that it tells makes the same
# picture. Over bench/race/*.scn and limits of 0.5, 2 and 5 s; with arguments: limits. On a quiet machine only.
#
# Wants RTLANG, the program.
#
# SPDX-License-Identifier: MIT
import glob
import os
import re
import subprocess
import sys
import tempfile

RTLANG = os.path.abspath(os.environ.get("RTLANG", "rtlang"))
HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "race")


def run(scene, picture, *options):
    done = subprocess.run([RTLANG, "-W320", "-H240", "-o", picture, *options, scene], stderr=subprocess.PIPE, text=True, check=True)
    return float(re.search(r"trace ([0-9.]+)", done.stderr)[1]), re.search(r"at (\S+) samples a pixel", done.stderr)[1]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def main():
    limits = [float(word) for word in sys.argv[1:]] or [0.5, 2.0, 5.0]
    shares, differ = [], 0
    with tempfile.TemporaryDirectory() as folder:
        first, again = os.path.join(folder, "first.png"), os.path.join(folder, "again.png")
        print("| scene |", " | ".join(f"{limit:g} s" for limit in limits), "|")
        print("|---" * (len(limits) + 1) + "|")
        for scene in sorted(glob.glob(os.path.join(HERE, "*.scn"))):
            row = []
            for limit in limits:
                seconds, samples = run(scene, first, f"--time-limit={limit}")
                run(scene, again, "--adaptive", f"--samples={samples}", "-t1")
                differ += read(first) != read(again)
                row.append(seconds / limit)
            shares += row
            print(f"| {os.path.splitext(os.path.basename(scene))[0].replace('_', ' ')} |", " | ".join(f"{share:.3f}" for share in row), "|", flush=True)
    print(f"{min(shares):.3f} to {max(shares):.3f}; {differ} of {len(shares)} runs were not made again byte for byte")


if __name__ == "__main__":
    main()
