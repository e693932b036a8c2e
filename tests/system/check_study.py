#!/usr/bin/env python3
# rtcheck --study on small pictures: the methods, the three kinds of error, what is biased and why, the ratios, and that text,
# CSV, JSON, the plot and the page say the same. Prints TAP. What needs POV-Ray is skipped without it.
#
# Wants RTLANG and RTCHECK, the programs.
#
# SPDX-License-Identifier: MIT
import csv
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from tap import Tap

RTLANG = os.path.abspath(os.environ["RTLANG"])
RTCHECK = os.path.abspath(os.environ["RTCHECK"])
POVRAY = os.environ.get("POVRAY") or shutil.which("povray")
HEAD = "#version 3.7; global_settings { assumed_gamma 1 }\n"
# Dull spheres under a lens: all methods draw it.
LENS = HEAD + """camera { location <0,2,-7> look_at 0 right x*image_width/image_height angle 50 aperture 4 blur_samples 100
  focal_point 0 }
light_source { <-4,7,-6> rgb <1,0.9,0.8> spotlight point_at 0 radius 20 falloff 20 }
sphere { <-1,0,0>, 1 pigment { rgb <1,0.4,0.2> } finish { ambient 0 diffuse 0.7 } }
"""
LENS_PLAIN = LENS.replace("spotlight point_at 0 radius 20 falloff 20 ", "")
# Two mirrors that face each other.
MIRRORS = HEAD + """global_settings { max_trace_level 3 } camera { location <0,0,-0.5> direction z }
light_source { <0,2,0> rgb 1 }
plane { z, 1 pigment { checker rgb 1 rgb 0.3 } finish { ambient 0.2 diffuse 0.2 reflection 0.8 } }
plane { -z, 1 pigment { rgb 1 } finish { ambient 0.2 diffuse 0.2 reflection 0.8 } }
"""
BALLS = HEAD + """camera { location <0,2,-9> look_at 0 right x*image_width/image_height angle 50 }
light_source { <-8,12,-10> rgb 1 } background { rgb <0.1,0.2,0.4> }
#declare S = seed(7);
#for (I, 1, 40) sphere { <rand(S)*8-4, rand(S)*6-3, rand(S)*8-4>, 0.1+0.25*rand(S)
pigment { rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8 } } #end
"""
# Edges that are too faint for POV-Ray's default threshold.
FAINT = BALLS.replace("rgb <rand(S),rand(S),rand(S)> } finish { ambient 0.1 diffuse 0.8", "rgb 0.4+0.1*rand(S) } finish { ambient 1 diffuse 0")
FAINT = FAINT.replace("rgb <0.1,0.2,0.4>", "rgb 0.4")
FIELDS = ["samples", "seconds", "rmse", "relmse", "max", "p999", "flip", "efficiency", "estimate"]
SAMPLERS = ["rtlang sobol", "rtlang adaptive", "rtlang halton", "rtlang jittered", "rtlang grid", "rtlang random"]
REFERENCES = ["reference float", "reference double", "reference quad"]
tap = Tap()


def study(*options, scenes, povray="/nonexistent/povray"):
    """(exit code, what was printed, what was complained)."""
    for name, text in scenes.items():
        with open(name, "w", encoding="ascii") as out:
            out.write(text)
    command = [RTCHECK, "--study", f"--povray={povray}", "-W40", "-H30", "--most=64", *options, *scenes]
    run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600, check=False)
    return run.returncode, run.stdout, run.stderr


def by_name(found):
    return {method["name"]: method for method in found["methods"]}


def is_without_study():
    done = subprocess.run([RTLANG, "--precision=quad", "-W4", "-H3", "-onone.png", "lens.scn"], capture_output=True, text=True, check=False)
    return "--disable-study" in done.stderr


def test_methods():
    """One scene that all of rtlang's methods draw, with everything that is written of it."""
    code, printed, said = study("--report=report", scenes={"lens.scn": LENS_PLAIN.replace("aperture 4 ", "")})
    if not tap.ok(code == 0, "a study without POV-Ray", said):
        return
    with open("report/study.json", encoding="utf-8") as file:
        found, = json.load(file)
    methods = by_name(found)
    if is_without_study():
        tap.equal(list(methods), SAMPLERS + ["rtlang forward-connect"], "its methods without the references")
        tap.skip("what the references tell", "built with --disable-study")
        return
    tap.equal(list(methods), SAMPLERS + REFERENCES + ["rtlang forward-connect"], "its methods")
    points = [point for method in methods.values() for point in method["points"]]
    tap.ok(all(point["seconds"] > 0 and point["rmse"] > 0 and point["max"] >= point["p999"] > 0 and 0 <= point["flip"] <= 1
               for point in points), "every run has its time and its errors", points)
    tap.ok(all(math.isclose(point["efficiency"], 1 / (point["rmse"] ** 2 * point["seconds"]), rel_tol=1e-6)
               for point in points), "efficiency is one over mean square and time")
    tap.ok(0 < found["floor"] < 0.5 * min(point["rmse"] for point in methods["rtlang sobol"]["points"]),
           "the reference's own error is known and small", found["floor"])
    exact, single = found["arithmetic"], found["arithmetic_float"]
    tap.ok(exact < 1e-6 and exact <= single < 0.01 and found["model"] is None, "arithmetic apart: double and float against quad",
           (exact, single))
    same = [methods[name]["points"][0] for name in ("reference double", "reference quad")]
    tap.ok(math.isclose(same[0]["rmse"], same[1]["rmse"], rel_tol=1e-4) and same[0]["seconds"] < same[1]["seconds"],
           "the reference kernels sample as one: equal error, other times", same)
    estimates = [point for point in methods["rtlang sobol"]["points"] if point["samples"] >= 16]
    tap.ok(all(0.6 < point["estimate"] / point["rmse"] < 1.7 for point in estimates),
           "what runs say of their error is what it is", estimates)
    slopes = [methods[name]["slope"] for name in ("rtlang sobol", "rtlang random")]
    tap.ok(slopes[0] is not None and slopes[1] is not None, "slopes with intervals", slopes)
    test_writings(printed, methods)


def test_writings(printed, methods):
    with open("report/study.csv", encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    pairs = [(row, name, point) for row, (name, point) in
             zip(rows, [(name, point) for name, method in methods.items() for point in method["points"]])]
    fine = len(rows) == len(pairs) == sum(len(method["points"]) for method in methods.values())
    tap.ok(fine and all(row["method"] == name and row["setting"] == point["setting"] and
                        all(math.isclose(float(row[field]), point[field], rel_tol=1e-5) for field in FIELDS)
                        for row, name, point in pairs), "CSV and JSON say the same", rows[:2])
    plot = xml.etree.ElementTree.parse("report/study-1.svg").getroot()
    texts = ["".join(text.itertext()) for text in plot.iter("{http://www.w3.org/2000/svg}text")]
    tap.ok(all(name in texts for name in methods) and "-0.5" in texts and "-0.75" in texts and
           "the reference's own error" in texts, "the plot names its methods, guides and floor", texts)
    width = float(plot.get("viewBox").split()[2])
    places = {"".join(text.itertext()): float(text.get("x")) for text in plot.iter("{http://www.w3.org/2000/svg}text") if text.get("x")}
    longest = len("POV-Ray +AM2 +A0.03 (biased)")
    tap.ok(all(places["-0.5"] + 26 <= places[name] - 30 and places[name] + 7 * longest <= width for name in methods),
           "and has room for the longest name, beside the guides' slopes", (places, width))
    with open("report/index.html", encoding="utf-8") as file:
        page = file.read()
    tap.ok(page.count("<svg class=\"plot\"") == 1 and all(name in page for name in methods) and "http://" not in
           page.replace("http://www.w3.org/2000/svg", ""), "the page has plot and table and asks for nothing")
    tap.ok(all(name in printed for name in methods), "the text names the methods", printed)
    tap.ok(re.search(r"arithmetic: rmse \S+ in double, \S+ in float", printed) and "model: not known" in printed and
           re.search(r"sampling: .* floor \S+", printed), "and tells the three kinds of error", printed)


def test_forward():
    """The lecture's numbers."""
    code, printed, said = study(scenes={"photons.scn": LENS})
    tap.ok(code == 0, "a study of photons", said)
    for name in "rtlang forward-connect", "rtlang forward":
        found = re.search(re.escape(name) + r": a photon counts with probability (\S+), .* about (\S+) photons and (\S+) seconds, (\S+) times as long",
                          printed)
        numbers = [float(text) for text in found.groups()] if found else []
        tap.ok(found and 0 < numbers[0] < 1 and numbers[1] > 1e5 and numbers[3] > 1,
               f"{name}: the chance to count, photons and time to equal error", printed[:1500])


def test_bias():
    code, printed, said = study(scenes={"mirrors.scn": MIRRORS})
    tap.ok(code == 0 and re.search(r"biased by max_trace_level: with 64 levels the picture changes by rmse 0\.", printed),
           "a study of a scene that is cut says that it is biased", printed[:1500] + said)
    code, printed, said = study("--json", scenes={"balls.scn": BALLS})
    found = json.loads(printed)
    tap.ok(code == 0 and found["cut_bias"] == 0 and not any(method["biased"] for name, method in by_name(found).items() if name in SAMPLERS + REFERENCES),
           "and no other", printed[:500])


def test_povray():
    if not POVRAY or not os.environ.get("CHECK_LONG"):
        tap.skip("POV-Ray's ladders", "it takes minutes: make check-long" if POVRAY else "povray is not installed")
        return
    code, printed, said = study("--json", scenes={"faint.scn": FAINT}, povray=POVRAY)
    found = json.loads(printed) if code == 0 else {"methods": [], "equal": []}
    theirs = {name: method for name, method in by_name(found).items() if name.startswith("POV-Ray")}
    tap.ok(list(theirs) == [f"POV-Ray +AM{method} +A{threshold}" for method in (1, 2) for threshold in ("0.3", "0.03", "0.0")],
           "POV-Ray's ladders", said)
    tap.ok(all(theirs[name]["biased"] for name in ("POV-Ray +AM1 +A0.3", "POV-Ray +AM2 +A0.3")) and
           not theirs["POV-Ray +AM1 +A0.0"]["biased"], "an adaptive threshold is biased, no threshold is not",
           {name: method["biased"] for name, method in theirs.items()})
    best = [row for row in found["equal"] if row["best"]]
    tap.ok(found["model"] < 1e-4 and best and all(row["rtlang_seconds"] > 0 for row in best) and found["best_ratio"] > 0,
           "the model's error, and times to equal error", found["equal"])


def test_faults():
    code, _, said = study(scenes={"wrong.scn": "nonsense"})
    tap.ok(code == 1 and "wrong.scn" in said, "a scene that cannot be read", said)
    code, _, said = study("--report=/dev/null/out", scenes={"balls.scn": BALLS})
    tap.ok(code == 2 and "cannot write the report" in said, "a report that cannot be written", said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in (test_methods, test_forward, test_bias, test_povray, test_faults):
            test()
        os.chdir("/")
    tap.done()


if __name__ == "__main__":
    main()
