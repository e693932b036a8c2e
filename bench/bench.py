#!/usr/bin/env python3
"""Speed beside the peers: the same scenes given to rtlang and POV-Ray in turn, in one run, so that only ratios count.

Whole processes from the scene file to the PNG at 800x600, wall time and peak memory, medians of several runs. Writes JSON to
--json FILE and a Markdown table to standard output. A peer that is not installed is left out with a word. Never part of
`make check`: the machines are shared.
SPDX-License-Identifier: MIT
"""
import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
SIZE = ("800", "600")


def programs():
    """Name -> command line for a scene and a picture."""
    found = {"rtlang": lambda scene, picture: [os.path.abspath(os.environ.get("RTLANG", "./rtlang")), "-q", "-W", SIZE[0], "-H", SIZE[1],
                                               "-o", picture, scene]}
    povray = os.environ.get("POVRAY") or shutil.which("povray")
    if povray:
        found["povray"] = lambda scene, picture: [povray, "+I" + scene, "+O" + picture, "+W" + SIZE[0], "+H" + SIZE[1],
                                                  "-D", "-A", "+FN8"]
    else:
        print("povray is not installed (apt-get install povray): measured alone", file=sys.stderr)
    return found


def run_once(command, folder):
    """Wall seconds and peak megabytes of one process."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                               cwd=folder)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"bench: {' '.join(command)} ended with {process.returncode}")
    return seconds, usage.ru_maxrss / 1000


def measure(count, runs, folder):
    scene = os.path.join(folder, f"{count}.pov")
    with open(scene, "w", encoding="ascii") as file:
        subprocess.run([sys.executable, os.path.join(HERE, "generate.py"), str(count)], stdout=file, check=True)
    samples = {name: [] for name in programs()}
    for turn in range(runs + 1):
        for name, command in programs().items():
            sample = run_once(command(scene, os.path.join(folder, name + ".png")), folder)
            if turn > 0:  # the first turn warms up
                samples[name].append(sample)
    os.remove(scene)
    return {name: {"seconds": statistics.median(s for s, _ in taken), "spread": max(s for s, _ in taken) - min(s for s, _ in taken),
                   "megabytes": max(m for _, m in taken)} for name, taken in samples.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--json", default="bench.json")
    parser.add_argument("counts", type=int, nargs="*", default=[1, 1000, 100000])
    options = parser.parse_args()
    results = {}
    print("| spheres | rtlang | POV-Ray | ratio | rtlang, peak memory | POV-Ray, peak memory |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="rtlang-bench-") as folder:
        for count in options.counts:
            results[count] = found = measure(count, options.runs, folder)
            ours, theirs = found["rtlang"], found.get("povray")
            cells = [f"{count}", f"{ours['seconds']:.3f} s"]
            cells += [f"{theirs['seconds']:.3f} s", f"{theirs['seconds'] / ours['seconds']:.1f}"] if theirs else ["-", "-"]
            cells += [f"{ours['megabytes']:.0f} MB", f"{theirs['megabytes']:.0f} MB" if theirs else "-"]
            print("| " + " | ".join(cells) + " |", flush=True)
    with open(options.json, "w", encoding="ascii") as file:
        json.dump(results, file, indent=2)


if __name__ == "__main__":
    main()
