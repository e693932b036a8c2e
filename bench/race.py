#!/usr/bin/env python3
# The race to equal error over bench/race/*.scn as docs/sampling.md has it: runs rtcheck --race on each scene, and prints a table.
# With arguments: options of rtcheck (--budget=120), then scenes, if not all. With --update first the table goes into the
# document.
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
HEADINGS = {"cpu": "cpu", "wall": "wall", "whole": "whole", "cpu_all": "cpu, all", "wall_all": "wall, all",
            "cpu_by_povray": "by POV-Ray", "cpu_by_other": "by the other"}
DOCUMENT = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "docs", "sampling.md")
lines = []


def say(*words):
    lines.append(" ".join(words))
    print(lines[-1], flush=True)


def number(value):
    return "-" if value is None else f"{value:.1f}"


def update():
    with open(DOCUMENT, encoding="utf-8") as file:
        before, rest = file.read().split("<!-- race -->\n", 1)
    after = rest.split("<!-- /race -->", 1)[1]
    with open(DOCUMENT, "w", encoding="utf-8") as file:
        file.write(before + "<!-- race -->\n" + "\n".join(lines) + "\n<!-- /race -->" + after)


def main():
    words = [word for word in sys.argv[1:] if word != "--update"]
    options = [word for word in words if word.startswith("-")] or ["--budget=120"]
    scenes = [word for word in words if not word.startswith("-")] or sorted(glob.glob(os.path.join(HERE, "*.scn")))
    found = {}
    say("| scene | size |", " | ".join(HEADINGS.values()), "| least | tried, run, front |")
    say("|---" * (len(HEADINGS) + 4) + "|")
    for scene in scenes:
        run = subprocess.run([RTCHECK, "--race", "--json", *options, scene], stdout=subprocess.PIPE, text=True, check=True)
        race = json.loads(run.stdout)["race"]
        name = os.path.splitext(os.path.basename(scene))[0].replace("_", " ")
        found[name] = {ratio["name"]: ratio["ratio"] for ratio in race["ratios"]}
        tried = sum(entry["small_rays"] is not None for entry in race["povray"])
        ran = sum(entry["run"] for entry in race["povray"])
        front = sum(entry["front"] in ("both", "processor") for entry in race["povray"])
        say(f"| {name} | {race['width']} x {race['height']} |", " | ".join(number(found[name][key]) for key in HEADINGS),
            f"| {number(race['ratios'][0]['least'])} | {tried}, {ran}, {front} |")
    means = []
    for key in HEADINGS:
        known = [math.log(row[key]) for row in found.values() if row[key]]
        means.append(number(math.exp(sum(known) / len(known)) if known else None))
    say("| geometric mean | |", " | ".join(means), "| | |")
    if "--update" in sys.argv:
        update()


if __name__ == "__main__":
    main()
