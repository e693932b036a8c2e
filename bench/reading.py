#!/usr/bin/env python3
"""How long reading takes beside POV-Ray: CPU time of `rtlang --check` and of POV-Ray's whole run for a picture of 1x1.

Usage: reading.py [-n WORST] [FILE.pov FILE.inc]...; by default all of Debian's povray-examples and povray-includes.
Each file is read in a copy of its folder, accepted or not, twice by each program, and the shorter time counts. Printed
are the worst ratios, the geometric mean and how many are above the bar. Not a test: timings depend on the machine.
SPDX-License-Identifier: MIT
"""
import argparse
import glob
import math
import os
import resource
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "povray"))
sys.dont_write_bytecode = True  # the folder is distributed as it is
from survey import EXAMPLES, unpacked  # noqa: E402

FOLDERS = (EXAMPLES, "/usr/share/povray-3.7/include")
BAR = 0.5
SECONDS = 120


def cpu_seconds(command, folder):
    """The shorter of two runs; None: it took too long."""
    best = math.inf
    for _ in range(2):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        try:
            subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL, timeout=SECONDS, check=False)
        except subprocess.TimeoutExpired:
            return None
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        best = min(best, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return best


def installed():
    paths = [path for folder in FOLDERS for path in glob.glob(os.path.join(folder, "**"), recursive=True)]
    return sorted(path for path in paths if path.removesuffix(".gz").endswith((".pov", ".inc")))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-n", type=int, default=10, help="print so many of the worst (default 10)")
    parser.add_argument("files", nargs="*")
    options = parser.parse_args()
    rtlang = os.path.abspath(os.environ.get("RTLANG", "./rtlang"))
    rows = []
    with tempfile.TemporaryDirectory() as top:
        copies = {"top": top}
        for path in options.files or installed():
            folder = unpacked(os.path.dirname(os.path.abspath(path)), copies)
            name = os.path.basename(path).removesuffix(".gz")
            ours = cpu_seconds([rtlang, "--check", "-q", f"-I{FOLDERS[1]}", name], folder)
            theirs = cpu_seconds(["povray", "-D", "-F", "+W1", "+H1", f"+I{name}"], folder)
            if ours is not None and theirs:
                rows.append((ours / theirs, ours, theirs, path))
    rows.sort(reverse=True)
    for ratio, ours, theirs, path in rows[:options.n]:
        print(f"{ratio:7.2f}  rtlang {ours:6.3f} s  povray {theirs:6.3f} s  {path}")
    mean = math.exp(sum(math.log(max(row[0], 1e-4)) for row in rows) / max(len(rows), 1))
    above = sum(row[0] > BAR for row in rows)
    print(f"{len(rows)} files, geometric mean {mean:.3f}, {above} above {BAR}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
