#!/usr/bin/env python3
# The race to equal error over bench/race/*.scn as docs/sampling.md has it: runs rtcheck --race on each scene, and prints a table.
# With arguments: options of rtcheck (--budget=30), then scenes, if not all.
#
# Wants RTCHECK, the program.
#
# SPDX-License-Identifier: MIT
import glob
import json
import math
import os
import subprocess
import sys

RTCHECK = os.path.abspath(os.environ.get("RTCHECK", "rtcheck"))
HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "race")
HEADINGS = {"cpu": "processor", "wall": "clock", "whole": "whole run", "cpu_all": "processor, all threads",
            "wall_all": "clock, all threads", "cpu_by_povray": "by POV-Ray's reference", "cpu_by_other": "by the other's"}


def number(value):
    return "-" if value is None else f"{value:.1f}"


def main():
    options = [word for word in sys.argv[1:] if word.startswith("-")] or ["--budget=30"]
    scenes = [word for word in sys.argv[1:] if not word.startswith("-")] or sorted(glob.glob(os.path.join(HERE, "*.scn")))
    found = {}
    print("| scene | size |", " | ".join(HEADINGS.values()), "| least | settings: tried, run, front |")
    print("|---" * (len(HEADINGS) + 4) + "|", flush=True)
    for scene in scenes:
        run = subprocess.run([RTCHECK, "--race", "--json", *options, scene], stdout=subprocess.PIPE, text=True, check=True)
        race = json.loads(run.stdout)["race"]
        name = os.path.splitext(os.path.basename(scene))[0].replace("_", " ")
        found[name] = {ratio["name"]: ratio["ratio"] for ratio in race["ratios"]}
        tried = sum(entry["small_rays"] is not None for entry in race["povray"])
        ran = sum(entry["run"] for entry in race["povray"])
        front = sum(entry["front"] in ("both", "processor") for entry in race["povray"])
        print(f"| {name} | {race['width']} x {race['height']} |", " | ".join(number(found[name][key]) for key in HEADINGS),
              f"| {number(race['ratios'][0]['least'])} | {tried}, {ran}, {front} |", flush=True)
    means = []
    for key in HEADINGS:
        known = [math.log(row[key]) for row in found.values() if row[key]]
        means.append(number(math.exp(sum(known) / len(known)) if known else None))
    print("| geometric mean | |", " | ".join(means), "| | |")


if __name__ == "__main__":
    main()
