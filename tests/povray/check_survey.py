#!/usr/bin/env python3
"""The survey itself, over three scenes: one accepted, one refused, and one packed that lacks two things.

Prints TAP. SPDX-License-Identifier: MIT
"""
import gzip
import json
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder is distributed as it is
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import chance  # noqa: E402
import pictures  # noqa: E402
import survey  # noqa: E402
import survey_times  # noqa: E402

SURVEY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "survey.py")
SCENES = {
    "accepted.pov": '#version 3.7; global_settings { assumed_gamma 1 }\n#include "part.inc"\n',
    "refused.pov": '#version 3.7;\n/* prism */ #declare Word = "lathe"; // blob\nradiosity { }\n',
    "packed.pov.gz": '#version 3.7;\nsphere { 0, 1 }\nradiosity { }\nmedia { }\n',
    "part.inc": "sphere { 0, 1 pigment { rgb 1 } finish { ambient 1 } }\n",
}
RADIOSITY, MEDIA = "E0252 radiosity", "E0252 media"
EXPECTED = [
    ("accepted.pov", "accepted", [], None),
    ("packed.pov.gz", "refused", [RADIOSITY, MEDIA], "packed.pov:3"),
    ("refused.pov", "refused", [RADIOSITY], "refused.pov:3"),
]
PLAN = [["radiosity", 1, 2], ["media", 1, 1]]


def write_scenes(folder):
    for name, text in SCENES.items():
        with (gzip.open if name.endswith(".gz") else open)(os.path.join(folder, name), "wt") as file:
            file.write(text)
    return [os.path.join(folder, name) for name, *_ in EXPECTED]


def check_times(tell, folder):
    """Of a scene that both draw, and of one that the first program never ends within its second."""
    done = subprocess.run([sys.executable, SURVEY, "--times", "--size", "32x24", "--turns", "2", os.path.join(folder, "accepted.pov")],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False, text=True)
    tell("1 scenes timed, 0 of them not finished by both" in done.stdout and " of 1 slower than POV-Ray; geometric mean " in done.stdout,
         "the times of one scene are compared")
    tell(survey_times.seconds_of([sys.executable, "-c", "while True: pass"], folder, 1) is None, "a run is stopped at its limit")
    tell(survey_times.seconds_of(["false"], folder, 1) is None, "a run that fails has no time")
    tell(survey_times.ratio({"rtlang": [3.0, 1.0], "povray": [2.0, 4.0]}) == 0.5, "the least seconds count")
    tell(survey_times.ratio({"rtlang": [3.0], "povray": [None]}) is None, "what one program does not finish has no ratio")


def check_verdicts(tell):
    """What is said of a comparison: by what rtcheck counts, and by chance."""
    record = {"picture": {"agrees": True, "not_elsewhere": 0, "pixels": 19200}}
    tell(survey.verdict(record) == survey.MEETS, "equal pictures meet the bar")
    record["picture"]["not_elsewhere"] = 3
    tell(survey.verdict(record) == survey.BUT_FOR, "so do those that differ where POV-Ray differs from itself")
    record["chance"] = {"like": False}
    tell(survey.verdict(record) == survey.MISSES, "but not with means that differ")
    record["picture"]["agrees"] = False
    tell(survey.verdict(record) == survey.MISSES, "nor others")
    record["picture"]["larger"] = 2
    tell(survey.verdict(record) == survey.MISSES, "nor where more than 0.01 % of the pixels differ in larger scenes")
    record["picture"]["larger"] = 1
    tell(survey.verdict(record) == survey.LARGER, "what is equal where it is larger is told from them")
    tell(chance.without("rainbow { jitter 0.01 arc_angle 9 }").split() == "rainbow { arc_angle 9 }".split() and
         chance.without("light_source { 0, 1 jitter }").split() == "light_source { 0, 1 }".split(),
         "chance is left out of lights and of rainbows")


def main():
    number = failed = 0

    def tell(fine, words):
        nonlocal number, failed
        number += 1
        failed += not fine
        print(f"{'ok' if fine else 'not ok'} {number} - {words}")

    check_verdicts(tell)
    with tempfile.TemporaryDirectory() as folder:
        results = os.path.join(folder, "survey.json")
        done = subprocess.run([sys.executable, SURVEY, "--json", results, *write_scenes(folder)],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120, check=False, text=True)
        tell(done.returncode == 0, f"it ends with {done.returncode}")
        if done.returncode:
            print("# " + done.stdout.replace("\n", "\n# "))
            return 1
        with open(results, encoding="utf-8") as file:
            found = json.load(file)
        for (name, outcome, blockers, where), record in zip(EXPECTED, found["scenes"]):
            got = (os.path.basename(record["scene"]), record["outcome"], record["blockers"], record["where"])
            tell(got == (name, outcome, blockers, where), f"{name} is {outcome}, blockers {blockers}")
            if got != (name, outcome, blockers, where):
                print(f"# {got}")
        tell(found["plan"] == PLAN, f"the plan is {found['plan']}")
        tell("3 scenes: 2 refused, 1 accepted" in done.stdout, "the totals are printed")
        if pictures.povray():
            check_times(tell, folder)
    print(f"1..{number}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
