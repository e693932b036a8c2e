#!/usr/bin/env python3
"""The certified sphere test costs at most 1.6 times the instructions of the textbook's in the same loop, and takes the way of
double-word arithmetic in no ordinary scene. Counted by callgrind, so that no clock decides.
SPDX-License-Identifier: MIT
"""
import os
import re
import subprocess
import sys
import tempfile

BAR = 1.6
PROGRAM = os.environ["COUNT_SPHERE_TESTS"]
VALGRIND = os.environ.get("VALGRIND", "")


def instructions(function, folder):
    """Instructions executed inside calls of a function."""
    command = [VALGRIND, "--tool=callgrind", f"--callgrind-out-file={folder}/out", f"--toggle-collect={function}", PROGRAM]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", run.stderr)
    return (int(found.group(1)) if found else 0), run.stdout.split()


def main():
    print("1..2")
    if not VALGRIND:
        print("ok 1 - instructions of the sphere test # SKIP valgrind is not installed")
        print("ok 2 - doubtful cases # SKIP valgrind is not installed")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        textbook, _ = instructions("count_textbook", folder)
        certified, counts = instructions("count_certified", folder)
    if not textbook or not certified:
        print("ok 1 - instructions of the sphere test # SKIP callgrind does not run this program")
        print("ok 2 - doubtful cases # SKIP callgrind does not run this program")
        return 0
    ratio = certified / textbook
    cheap = ratio <= BAR
    print(f"{'ok' if cheap else 'not ok'} 1 - the certified test takes {ratio:.2f} times the instructions of the textbook's")
    fine = counts[0] == counts[1] and int(counts[1]) > 100 and counts[2] == "0"
    print(f"{'ok' if fine else 'not ok'} 2 - {counts[1]} rays hit in an ordinary scene, {counts[2]} tests were doubtful")
    return 0 if cheap and fine else 1


if __name__ == "__main__":
    sys.exit(main())
