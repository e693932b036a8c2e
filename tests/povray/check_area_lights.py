#!/usr/bin/env python3
"""Area lights drawn anew each run, given to both programs: the pictures agree, and rtlang casts no more shadow rays.

Usage: check_area_lights.py [COUNT [SEED]]   Each light of a grid is asked for at most once a point, by both programs; a
pixel that differs, on a silhouette, may ask all of its lights. Cups cut from spheres are among the scenes. Lengths are
thousands, so that what POV-Ray passes over next to a surface is small. Prints TAP; with $KEEP set, scenes that fail are
written into that folder. SPDX-License-Identifier: MIT
"""
import concurrent.futures
import os
import random
import re
import subprocess
import sys
import tempfile
import time

TOP = os.environ.get("top_srcdir", ".")
sys.path.insert(0, os.path.join(TOP, "tests", "system"))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True  # the folder is distributed as it is
import pictures  # noqa: E402
from tap import Tap  # noqa: E402

COUNT = 40
WIDTH, HEIGHT = 64, 48
TIES = 3  # pixels of one picture that may fall to either side of a silhouette or of a shadow's edge
SHARE = 1e-4  # of all pixels
ADAPTIVE = ["", "adaptive 0", "adaptive 1", "adaptive 2", "adaptive 3"]
HEAD = """#version 3.7; global_settings { assumed_gamma 1 } #declare S = 1000;
camera { location <0, 3, -7>*S look_at <0, 0.4, 0>*S angle 50 }
plane { y, 0 pigment { rgb <0.8, 0.8, 0.85> } finish { ambient 0.05 diffuse 0.6 } }
"""


def draw_light(draw, number):
    size1, size2 = draw.randint(2, 17), draw.randint(2, 9)
    kind = ["", "circular", "circular orient", ""][number % 4]
    if number % 9 == 8:
        size1, kind = 1, ""
    place = f"<{draw.uniform(-5, 5):.3f}, {draw.uniform(1, 7):.3f}, {draw.uniform(-6, 2):.3f}>*S"
    colour = ", ".join(str(draw.choice([0.05, 0.3, 0.6, 1])) for _ in range(3))
    cone = draw.choice(["", "", "spotlight radius 12 falloff 25 point_at 0"])
    axes = f"<{draw.uniform(0.2, 3):.3f}, 0, 0>*S, <0, {draw.uniform(-1, 1):.3f}, {draw.uniform(0.2, 3):.3f}>*S"
    return (f"light_source {{ {place}, rgb <{colour}> area_light {axes}, {size1}, {size2}"
            f" {ADAPTIVE[number % 5]} {kind} {cone} }}\n")


def draw_look(draw, glass):
    colour = ", ".join(f"{draw.random():.3f}" for _ in range(3))
    clear = f" filter {draw.uniform(0.3, 0.9):.3f}" if glass and draw.random() < 0.6 else ""
    mirror = draw.choice(["", "reflection 0.3"])
    return f"pigment {{ rgb <{colour}>{clear} }} finish {{ ambient 0.2 diffuse {draw.choice(['0', '0.6'])} {mirror} }}"


def draw_object(draw, number, glass):
    place = f"<{draw.uniform(-2, 2):.3f}, {draw.uniform(0.5, 1.2):.3f}, {draw.uniform(-1, 1):.3f}>*S"
    radius = draw.uniform(0.3, 0.8)
    ball = f"sphere {{ {place}, {radius:.3f}*S "
    look = draw_look(draw, glass)
    if number % 2:
        return f"{ball} {look} }}\n"
    return f"difference {{ {ball} }} sphere {{ {place} + 0.4*S*y, {0.9 * radius:.3f}*S }} {look} }}\n"


def draw_scene(seed, number):
    """The scene, and how many lights its grids have."""
    draw = random.Random(seed * 100003 + number)
    glass = number % 3 == 2
    lights = "".join(draw_light(draw, number + 7 * k) for k in range(draw.randint(1, 2)))
    # Every second scene without cups: rtlang then has another kernel.
    objects = "".join(draw_object(draw, 1 if number % 4 < 2 else k, glass) for k in range(draw.randint(1, 4)))
    grids = re.findall(r"\*S, (\d+), (\d+) ", lights)
    return HEAD + lights + objects, sum(int(size1) * int(size2) for size1, size2 in grids)


def count_povray(scene, picture):
    done = pictures.call([pictures.povray(), f"+I{scene}", f"+O{picture}", f"+W{WIDTH}", f"+H{HEIGHT}", "+FN16",
                          "File_Gamma=1.0", "-A", "-D", "-P", "+WT1"], stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, timeout=300)
    text = done.stdout.decode("utf-8", "replace")
    if done.returncode:
        raise pictures.RunFailed("povray", done.returncode, text)
    found = re.search(r"Shadow Ray Tests:\s+(\d+)", text)
    return int(found.group(1)) if found else 0


def count_rtlang(scene, picture):
    done = subprocess.run([os.environ["RTLANG"], f"-W{WIDTH}", f"-H{HEIGHT}", "-t1", "--depth=16", "--file-gamma=1",
                           "-o", picture, scene], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=300, check=False)
    found = re.search(r"(\d+) shadow", done.stdout)
    if done.returncode or not found:
        raise pictures.RunFailed("rtlang", done.returncode, done.stdout)
    return int(found.group(1))


def compare(folder, seed, number):
    """(rtlang's shadow rays, POV-Ray's, greatest difference, pixels beyond the bar, pixels)."""
    scene, ours, theirs = (os.path.join(folder, f"{number}{end}") for end in (".scn", ".png", "_povray.png"))
    with open(scene, "w", encoding="ascii") as out:
        out.write(draw_scene(seed, number)[0])
    rays = count_rtlang(scene, ours), count_povray(scene, theirs)
    return (*rays, *pictures.compare(ours, theirs))


def main():
    tap = Tap()
    if not pictures.povray():
        print("1..0 # SKIP povray is not installed")
        return
    count, seed = (int(argument) for argument in (sys.argv[1:] + [COUNT, time.time()][len(sys.argv) - 1:])[:2])
    print(f"# check_area_lights.py {count} {seed} repeats this run", flush=True)
    beyond_all = pixels_all = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for number, found in enumerate(pool.map(lambda number: compare(folder, seed, number), range(count))):
            ours, theirs, greatest, beyond, pixels = found
            text, lights = draw_scene(seed, number)
            beyond_all, pixels_all = beyond_all + beyond, pixels_all + pixels
            fine = tap.ok(ours <= theirs + beyond * lights and beyond <= TIES,
                          f"{ours} shadow rays, POV-Ray {theirs}; {beyond} pixels beyond 2/65535, max {greatest}", text)
            if not fine and "KEEP" in os.environ:
                with open(os.path.join(os.environ["KEEP"], f"area_{seed}_{number}.scn"), "w", encoding="ascii") as out:
                    out.write(text)
    tap.ok(beyond_all <= max(TIES, SHARE * pixels_all),
           f"{beyond_all} of {pixels_all} pixels of all scenes are beyond the bar")
    tap.done()


if __name__ == "__main__":
    main()
