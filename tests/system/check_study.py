#!/usr/bin/env python3
# rtcheck --study on small pictures: the methods, the three kinds of error, what is biased and why, the ratios, and that text,
# CSV, JSON, the plot and the page say the same. A stand-in for POV-Ray writes down what it is asked for, so that a race that
# leaves a setting out is found. Prints TAP. What needs POV-Ray is skipped without it.
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
import chromium  # noqa: E402
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
    command = [RTCHECK, "--study", f"--povray={povray}", "-W40", "-H30", "--most=64", "--budget=0", *options, *scenes]
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
    tap.equal(found["reference_samples"], 16 * 64, "the reference has 16 times the samples of a ladder's top")
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
    tap.ok(found["left_out"] == [] and found["budget"] == 0, "without a limit nothing is left out", found["left_out"])
    test_writings(printed, methods, found)


def luminance(colour):
    """WCAG 2.1's relative luminance of #rrggbb."""
    values = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in values]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def verdict_by_hand(methods):
    """The verdict of a study without a race, told anew: the rung of random samples nearest to 0.01, and the others' time to it."""
    best = None
    for point in methods["rtlang random"]["points"]:
        times = []
        for name in ("rtlang sobol", "rtlang adaptive"):
            rungs = methods[name]["points"]
            for a, b in zip(rungs, rungs[1:]):
                share = math.log(point["rmse"] / a["rmse"]) / math.log(b["rmse"] / a["rmse"])
                if 0 <= share <= 1:
                    times.append(a["seconds"] * (b["seconds"] / a["seconds"]) ** share)
        off = abs(math.log(point["rmse"] / 0.01))
        if times and (best is None or off < best[0]):
            best = (off, point["rmse"], min(times), point["seconds"])
    return best[1:] if best else None


def test_page(page, found, methods):
    want = verdict_by_hand(methods)
    said = re.fullmatch(r"To an error of (\S+), rtlang takes (\S+) s, with plain random samples (\S+) s: (\S+) times\.", found["verdict"])
    tap.ok(want and said and all(math.isclose(float(a), b, rel_tol=0.06) for a, b in zip(said.groups()[:3], want)),
           "the verdict in one sentence: the error, the times to it", (found["verdict"], want))
    top = page.index('<p class="verdict">' + found["verdict"] + "</p>")
    places = [page.index(text, top) for text in ('<figure class="scene"><img alt="', '<svg class="plot"', '<fieldset class="curves">',
                                                 "What the columns mean", '<table class="sortable">')]
    tap.ok(top < page.index('<svg class="plot"') and places == sorted(places), "on the page: verdict, picture, plot, its boxes, what the columns mean, table",
           places)
    tap.ok('src="data:image/png;base64,' in page, "the picture is in the page")
    ticked = re.findall(r'<label><input type="checkbox" data-curve="(\d+)"( checked)?>', page)
    hidden = set(re.findall(r'<g data-curve="(\d+)" class="off">', page))
    tap.ok(len([number for number, is_shown in ticked if is_shown]) == 4 and
           {number for number, is_shown in ticked if not is_shown} == hidden and len(ticked) == len(methods), "four curves first, a box for each", ticked)
    explained = re.findall(r"<dt>([^<]+)</dt><dd>([^<]+)</dd>", page[:page.index('id="about"')])
    headings = re.findall(r'<th scope="col" title="[^"]+">([^<]+)</th>', page)
    tap.ok(headings == [name for name, _ in explained] and all(text.endswith(".") for _, text in explained), "each column said in a sentence", headings)
    colours = set(re.findall(r"stroke: (#[0-9a-f]{6}); stroke-width: 2", page))
    poor = {colour for colour in colours if contrast(colour, "#fbfaf8") < 3 or contrast(colour, "#1f2124") < 3}
    tap.ok(len(colours) >= 6 and not poor, "curves stand out from a light page and a dark one", poor)


def test_budget():
    """However little there is, there is a study, and it says what it has not."""
    code, printed, said = study("--json", "--budget=0.05", scenes={"balls.scn": BALLS})
    found = json.loads(printed) if code == 0 else {"left_out": [], "methods": []}
    most = max((point["samples"] for method in found["methods"] for point in method["points"]), default=0)
    tap.ok(code == 0 and any(text.startswith("the reference has ") for text in found["left_out"]) and
           any(re.match(r"runs of (more than )?\d+ samples", text) for text in found["left_out"]) and most < 64,
           "a budget that is too small leaves out what is dear, and says so", (found["left_out"], most, said))
    code, printed, said = study("--budget=0.05", scenes={"balls.scn": BALLS})
    tap.ok(code == 0 and re.search(r"the study took \d+ s of 0\.05 that --budget gives; left out:\n    the reference has", printed),
           "as text, too", printed[:500])


def test_progress():
    """On a terminal a bar says what is being done and how long that takes; it is gone at the end."""
    with open("balls.scn", "w", encoding="ascii") as out:
        out.write(BALLS)
    main, side = os.openpty()
    run = subprocess.run([RTCHECK, "--study", "--povray=/nonexistent/povray", "-W160", "-H120", "--budget=6", "balls.scn"], stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, stderr=side, timeout=120, check=False)
    os.close(side)
    said = b""
    try:
        while more := os.read(main, 65536):
            said += more
    except OSError:
        pass # the other side is closed
    os.close(main)
    bars = re.findall(rb"\r\[#* *\] +\d+ %  (\d+) s left  balls.scn: ([a-z ]+), \d+ of \d+", said)
    tap.ok(run.returncode == 0 and bars and int(bars[0][0]) >= int(bars[-1][0]),
           "the bar says what is done and the time left", said[-300:])
    tap.ok(re.search(rb"\r +\r$", said) is not None and b"balls.scn, 160 x 120" in run.stdout, "and is wiped", said[-100:])


def test_writings(printed, methods, found):
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
    test_page(page, found, methods)
    test_narrow(page)
    tap.ok(all(name in printed for name in methods), "the text names the methods", printed)
    tap.ok(re.search(r"arithmetic: rmse \S+ in double, \S+ in float", printed) and "model: not known" in printed and
           re.search(r"sampling: .* floor \S+", printed), "and tells the three kinds of error", printed)


def test_narrow(page):
    """A scene in a far folder, on a telephone."""
    if not chromium.PROGRAM:
        tap.skip("the page on a narrow screen", "chromium is not installed")
        return
    with open("narrow.html", "w", encoding="utf-8") as out:
        out.write(page.replace("lens.scn", "/home/somebody/very/far/below/in_a_folder/" + "lens" * 12 + ".scn"))
    browser = chromium.Chromium()
    browser.set_view(400, 800, "dark")
    browser.open("file://" + os.path.abspath("narrow.html"))
    browser.wait_for("document.readyState === 'complete' && document.querySelector('nav a')")
    tap.ok(browser.value("document.documentElement.scrollWidth <= innerWidth"), "nothing stands out of the page on a narrow screen",
           browser.value("document.documentElement.scrollWidth"))
    browser.close()


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


# Draws with rtlang what it is asked for, notes its arguments, and says how long a ray takes. Depth R of +AM1 is R * R
# rays a pixel, of +AM2 4 ^ (R - 1), which is the same picture at all thresholds where R is 1.
STAND_IN = """#!%(python)s
import os, subprocess, sys
options = {}
for word in sys.argv[1:]:
    for name in ("+AM", "+A", "+R", "+W", "+H", "+WT", "+SR", "+ER", "+I", "+O"):
        if word.startswith(name) and (name in ("+I", "+O") or word[len(name):].replace(".", "").isdigit()):
            options[name] = word[len(name):].strip('"')
jitter = "+J" in sys.argv
with open(%(log)r, "a") as log:
    log.write(" ".join(sys.argv[1:]) + chr(10))
depth, width, height = int(options.get("+R", 1)), int(options["+W"]), int(options["+H"])
rays = depth * depth if options.get("+AM") == "1" else 4 ** (depth - 1)
unique = "" if options.get("+AM") == "2" and depth == 1 else options.get("+A", "")
seed = 1 + int(float(unique or 9) * 1000) + (100000 if jitter else 0) + 7 * rays + 1000003 * int(options.get("+AM", 0))
rays = min(rays, 300)
subprocess.run([%(rtlang)r, "-t1", f"-W{width}", f"-H{height}", f"--samples={rays + 1}", f"--seed={seed}", "--sampler=random",
                "--no-estimate", "--depth=16", "--file-gamma=1", "-o" + options["+O"], options["+I"]], check=True)
seconds = %(seconds)s * rays * width * height
print(f"Pixels: {width * height} Samples: {(rays - 1) * width * height} Smpls/Pxl: {rays - 1}.00")
print(f"  Trace Time:       0 hours  0 minutes  0 seconds ({1.5 * seconds:.3f} seconds)")
print(f"              using 1 thread(s) with {seconds:.3f} CPU-seconds total")
"""


def race(*options, seconds=1e-6):
    """(what was found, the calls of the stand-in, what was said)."""
    with open("stand-in", "w", encoding="ascii") as out:
        out.write(STAND_IN % {"python": sys.executable, "rtlang": RTLANG, "seconds": repr(seconds), "log": os.path.abspath("calls")})
    os.chmod("stand-in", 0o755)
    open("calls", "w", encoding="ascii").close()
    code, printed, said = study("--race", "--json", *options, scenes={"balls.scn": BALLS}, povray=os.path.abspath("stand-in"))
    with open("calls", encoding="ascii") as calls:
        asked = [line.split() for line in calls]
    return (json.loads(printed)["race"] if code == 0 else {}), asked, said


def test_race():
    # A ray takes so long that the dear settings have no room in the budget, though none takes what it says.
    found, asked, said = race("--size=96x72", "--budget=200", "--reference=128", seconds=2e-4)
    if not tap.ok(found, "a race", said):
        return
    tried = {(word[:4], a, r, j) for call in asked for word in call if word.startswith("+AM")
             for a in call if re.fullmatch(r"\+A[0-9.]+", a) for r in call if re.fullmatch(r"\+R\d", r) for j in call if j in ("+J", "-J")}
    want = {(f"+AM{method}", f"+A{threshold}", f"+R{depth}", jitter) for method, most in ((1, 9), (2, 5)) for jitter in ("+J", "-J")
            for threshold in ("0.3", "0.1", "0.03", "0.01", "0.003", "0.0") for depth in range(1, most + 1)}
    tap.equal(sorted(tried ^ want), [], "POV-Ray is asked for each threshold, method, depth up to 100 rays a pixel, with jitter and without")
    tap.equal(found["reference_samples"], 128, "the reference has the samples that were asked for")
    tap.ok(any({"+SR28", "+ER45", "+AM2", "+A0.0", "+R2", "-J"} <= set(call) for call in asked) and
           found["povray_reference"] == "+AM2 +A0.0 +R2 -J", "POV-Ray makes a reference of the middle rows, as deep as the budget lets it",
           found["povray_reference"])
    same = {entry["setting"]: entry["same_as"] for entry in found["povray"] if entry["same_as"]}
    tap.equal(same, {f"+AM2 +A{threshold} +R1 {jitter}": f"+AM2 +A0.3 +R1 {jitter}" for jitter in ("-J", "+J")
                     for threshold in ("0.1", "0.03", "0.01", "0.003", "0.0")}, "a picture counts once")
    run = [entry for entry in found["povray"] if entry["run"]]
    tap.ok(run and all(math.isclose(entry["cpu"], 2e-4 * entry["rays"] * 96 * 72, abs_tol=2e-3) and
                       math.isclose(entry["wall"], 1.5 * entry["cpu"], abs_tol=2e-3) for entry in run),
           "times by the processor and by the clock are those of tracing", run[:2])
    tap.ok(found["left_out"] == len([entry for entry in found["povray"] if not entry["run"] and not entry["same_as"] and
                                     entry["small_rays"] is not None]) > 0, "what the budget leaves out is counted", found["left_out"])
    names = [ratio["name"] for ratio in found["ratios"]]
    tap.equal(names, ["cpu", "wall", "whole", "cpu_all", "wall_all", "cpu_by_povray", "cpu_by_other"], "the ratios that are said")
    tap.ok(found["ratios"][0]["ratio"] == mean_by_hand(found), "the ratio is the mean over the front", found["ratios"][0])


def mean_by_hand(found):
    """The ratio by processor time, told anew from the runs."""
    run = [entry for entry in found["povray"] if entry["run"] and entry["rmse"]]
    front = [a for a in run if not any(b["cpu"] < a["cpu"] and b["rmse"] < a["rmse"] for b in run)]
    logs = []
    for entry in front:
        times = [rung["cpu"] for rung in found["rtlang"] if rung["rmse"] and rung["rmse"] <= entry["rmse"]]
        for kind in (True, False):
            ladder = [rung for rung in found["rtlang"] if rung["setting"].startswith("--adaptive") == kind and rung["rmse"]]
            for a, b in zip(ladder, ladder[1:]):
                share = math.log(entry["rmse"] / a["rmse"]) / math.log(b["rmse"] / a["rmse"])
                if 0 <= share <= 1:
                    times.append(a["cpu"] * (b["cpu"] / a["cpu"]) ** share)
        if times:
            logs.append(math.log(entry["cpu"] / min(times)))
    ratio = math.exp(sum(logs) / len(logs)) if logs else 0
    return found["ratios"][0]["ratio"] if math.isclose(found["ratios"][0]["ratio"], ratio, rel_tol=1e-4) else ratio


def test_race_size():
    # The first picture is too small for the budget's least time, so it grows; a slow machine has less left, and stops there.
    found, asked, said = race("--budget=20", "--reference=64", seconds=3e-7)
    least = found.get("width", 0) * found.get("height", 0)
    tap.ok(found and 20 / 400 >= found["shortest"] / 1.5 >= 0.3 * 20 / 400 / 1.5 and 1e4 < least < 2e5,
           "the pictures are as large as the budget lets them be",
           (found.get("width"), found.get("height"), found.get("shortest"), said))
    tap.ok(asked, "and POV-Ray was asked for them")


def test_povray():
    if not POVRAY or not os.environ.get("CHECK_LONG"):
        tap.skip("POV-Ray's race", "it takes minutes: make check-long" if POVRAY else "povray is not installed")
        return
    code, printed, said = study("--race", "--json", "--size=160x120", "--budget=20", scenes={"faint.scn": FAINT}, povray=POVRAY)
    found = json.loads(printed)["race"] if code == 0 else {"povray": [], "ratios": [{"ratio": None}]}
    tap.ok(code == 0 and found["references_apart"] < 0.01, "the references of both agree", said)
    same = {entry["setting"] for entry in found["povray"] if entry["same_as"]}
    tap.ok({f"+AM2 +A{threshold} +R1 -J" for threshold in ("0.1", "0.03", "0.01", "0.003", "0.0")} <= same,
           "POV-Ray's squares of depth 1 are one setting", same)
    rays = {entry["setting"]: entry["small_rays"] for entry in found["povray"]}
    tap.ok(rays["+AM1 +A0.3 +R5 -J"] < 1.5 < 25 < rays["+AM1 +A0.0 +R5 -J"], "no threshold is a threshold of none", rays)
    tap.ok(found["ratios"][0]["ratio"] and found["ratios"][0]["ratio"] > 0, "a ratio", found["ratios"])


def test_faults():
    code, _, said = study(scenes={"wrong.scn": "nonsense"})
    tap.ok(code == 1 and "wrong.scn" in said, "a scene that cannot be read", said)
    code, _, said = study("--report=/dev/null/out", scenes={"balls.scn": BALLS})
    tap.ok(code == 2 and "cannot write the report" in said, "a report that cannot be written", said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for test in (test_methods, test_budget, test_progress, test_forward, test_bias, test_race, test_race_size, test_povray, test_faults):
            test()
        os.chdir("/")
    tap.done()


if __name__ == "__main__":
    main()
