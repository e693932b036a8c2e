#!/usr/bin/env python3
"""Pixels of a lens that end where they have enough: fewer rays, the same picture in the mean, the same bytes anyhow.

What a lens spreads here is small and bright, so that a pixel that ended by its own samples would be too dark in the mean.
Prints TAP. SPDX-License-Identifier: MIT
"""
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True  # the folder is distributed as it is
HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
sys.path.insert(0, os.path.join(HERE, "..", "povray"))
import pictures  # noqa: E402
from picture_bytes import png_without_texts  # noqa: E402
from tap import Tap  # noqa: E402


SCENE = """#version 3.7; global_settings { assumed_gamma 1 }
camera { location <0, 0, -10> right x * 4/3 angle 30 look_at 0 aperture 1 focal_point <0, 0, 6> blur_samples %s }
#declare I = 0;
#while (I < 40)
  sphere { <mod(I * 0.618, 1) * 5 - 2.5, mod(I * 0.414, 1) * 4 - 2, 0>, 0.06 pigment { rgb 1 } finish { ambient 1 diffuse 0 } }
  #declare I = I + 1;
#end
plane { z, 5 pigment { rgb 0.05 } finish { ambient 1 diffuse 0 } }
"""
TAP = Tap()
WIDTH, HEIGHT, SEEDS = 40, 30, 48
RULE = "160 confidence 0.9 variance 0.002"


def draw(scene, picture, *options):
    """(values from 0 to 1, samples a pixel, the interval of the error)."""
    done = subprocess.run([os.environ["RTLANG"], f"-W{WIDTH}", f"-H{HEIGHT}", "--depth=16", "--file-gamma=1", "-o", picture,
                           *options, scene], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=300, check=True, text=True)
    told = re.search(r"confidence ([-+.\de]+) to ([-+.\de]+), at ([\d.]+) samples a pixel", done.stderr)
    low, high, samples = map(float, told.groups()) if told else (0.0, 0.0, 0.0)
    return [value / 65535 for value in pictures.read_png(picture)[2][::3]], samples, (low, high)


def write(folder, name, rule):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(SCENE % rule)
    return path


def data(path):
    with open(path, "rb") as file:
        return file.read()


def pixels(path):
    """A PNG's bytes without what it says of its scene and options."""
    return png_without_texts(data(path))


def check_means(folder, scene):
    picture = os.path.join(folder, "mean.png")
    runs = [draw(scene, picture, f"--seed={seed}") for seed in range(SEEDS)]
    reference = draw(scene, picture, "--samples=16384", "--no-estimate")[0]
    samples = statistics.fmean(count for _, count, _ in runs)
    TAP.ok(10 < samples < 80, f"{samples:.1f} samples a pixel in the mean, of 160")
    apart = [statistics.fmean(values) - statistics.fmean(reference) for values, _, _ in runs]
    z = statistics.fmean(apart) / (statistics.stdev(apart) / math.sqrt(SEEDS))
    TAP.ok(abs(z) < 4.0, f"over {SEEDS} seeds the mean is off by {statistics.fmean(apart):.2e}, z = {z:.2f}")
    told = 0
    for values, _, (low, high) in runs:
        rmse = math.sqrt(statistics.fmean((value - exact) ** 2 for value, exact in zip(values, reference)))
        told += low <= rmse <= high
    TAP.ok(told >= 0.8 * SEEDS, f"in {told} of {SEEDS} runs the error is within the interval that is told")
    near = [abs(value - exact) <= math.sqrt(0.002) for values, _, _ in runs for value, exact in zip(values, reference)]
    TAP.ok(statistics.fmean(near) >= 0.9, f"{100 * statistics.fmean(near):.1f} % of pixels are as near as they are to be")


def check_bytes(folder, scene):
    one, other = os.path.join(folder, "one.png"), os.path.join(folder, "other.png")
    whole = draw(scene, one, "-t1")[0]
    for name, options in (("threads", ["-t5"]), ("instruction sets", ["--isa=plain"])):
        draw(scene, other, *options)
        TAP.ok(data(one) == data(other), f"{name}: the same bytes")
    TAP.ok(draw(scene, other, "--no-estimate")[0] == whole, "without the estimate, which a file tells of: the same pixels")
    part = draw(scene, other, "--crop=7,5,20,11")[0]
    rows = [whole[(5 + y) * WIDTH + 7:(5 + y) * WIDTH + 27] for y in range(11)]
    TAP.ok(part == [value for row in rows for value in row], "a crop has the whole picture's pixels")
    draw(write(folder, "all.scn", "64 variance 0"), one)
    draw(scene, other, "--samples=64")
    TAP.ok(pixels(one) == pixels(other), "variance 0 takes all samples")
    draw(write(folder, "few.scn", "12"), one)
    draw(scene, other, "--samples=12")
    TAP.ok(pixels(one) == pixels(other), "of so few all are taken")
    least = draw(write(folder, "least.scn", "100, 160 confidence 0.9 variance 0.5"), one)[1]
    TAP.ok(least == 100.0, f"the least is kept: {least} samples a pixel")
    said = subprocess.run([os.environ["RTLANG"], "--dump=scene", scene], stdout=subprocess.PIPE, timeout=60, check=True).stdout
    dumped = os.path.join(folder, "dumped.scn")
    with open(dumped, "wb") as file:
        file.write(said)
    draw(scene, one)
    draw(dumped, other)
    TAP.ok(pixels(one) == pixels(other), "the dumped scene has the same picture")


def main():
    with tempfile.TemporaryDirectory() as folder:
        scene = write(folder, "spots.scn", RULE)
        check_means(folder, scene)
        check_bytes(folder, scene)
    return TAP.done()


if __name__ == "__main__":
    sys.exit(main())
